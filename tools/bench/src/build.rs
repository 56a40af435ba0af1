//! `build`: faces to a mesh, and a walk round each of its vertices, beside lox and CGAL.
//!
//! All get the same triangles in memory and build connectivity alone. Ours checks every face, and that faces at a
//! vertex hang together as they should; what a check of the whole mesh costs besides is said in builds.

mod cgal;
mod lox;
mod triangles;

use std::hint::black_box;

use tearmesh::{Mesh, shapes};
use tearmesh_lab::statistics::median;

use self::cgal::Cgal;
use self::triangles::{Triangles, counted};
use crate::cut::facts::sheet;
use crate::measure::timed_on_cpu;
use crate::options::Options;
use crate::process::Program;
use crate::sheet::cells;
use crate::table::{line, table};

/// How many faces the small grid has: it fits into the second cache.
const SMALL: usize = 20_000;

/// The seconds of each round.
#[derive(Default)]
struct Times {
    build: Vec<f64>,
    walk: Vec<f64>,
}

/// A table for each mesh.
pub(crate) fn run(options: &Options) -> String {
    let program = cgal::compile();
    let tables = meshes(options.faces)
        .into_iter()
        .filter(|triangles| options.picks(triangles.name, &NAMES))
        .map(|triangles| contest(&triangles, &program, options));
    tables.collect::<Vec<_>>().join("\n")
}

const NAMES: [&str; 4] = ["small grid", "grid", "irregular", "shuffled"];

fn meshes(faces: usize) -> [Triangles; 4] {
    let grid = |name, faces| {
        let cells = cells(faces, 2) as u32;
        Triangles::of(name, &shapes::grid(cells, cells).0)
    };
    let irregular = Triangles::of(NAMES[2], &sheet(faces).0);
    let shuffled = irregular.shuffled(NAMES[3]);
    [
        grid(NAMES[0], SMALL),
        grid(NAMES[1], 2 * faces),
        irregular,
        shuffled,
    ]
}

fn contest(triangles: &Triangles, program: &Result<Program, String>, options: &Options) -> String {
    let start = |program| Cgal::start(program, triangles).ok_or("does not start");
    let cgal = program.as_ref().map_err(String::as_str).and_then(start);
    let [mut ours, mut fan, mut lox, mut theirs] = [(); 4].map(|()| Times::default());
    let mut checks = Vec::new();
    for _ in 0..options.rounds {
        // A program that has them in a list of its own gives that away.
        let corners = triangles.corners.clone();
        let (mesh, build) = timed_on_cpu(|| Mesh::build(triangles.vertices, corners));
        let mesh = mesh.expect("a mesh");
        ours.build.push(build);
        ours.walk.push(walked(triangles, || walk(&mesh)));
        fan.walk.push(walked(triangles, || walk_fans(&mesh)));
        let (violations, check) = timed_on_cpu(|| mesh.check());
        assert_eq!(violations, []);
        checks.push(check / build);
        drop(mesh);
        let (mesh, build) = timed_on_cpu(|| lox::build(triangles));
        lox.build.push(build);
        lox.walk.push(walked(triangles, || lox::walk(&mesh)));
        if let Ok(cgal) = &cgal {
            for (what, times) in [("build", &mut theirs.build), ("walk", &mut theirs.walk)] {
                let (seconds, faces) = cgal.ask(what);
                let visits = triangles.corners.len() * if what == "walk" { 3 } else { 1 };
                assert_eq!(faces, visits, "all faces are there");
                times.push(seconds);
            }
        }
    }
    let check = median(checks).expect("there is a round");
    let check = format!("a check of the whole takes {check:.2} builds");
    let version = cgal.as_ref().map_or_else(|why| *why, Cgal::version);
    let rows = [
        ("tearmesh", ours, &*check),
        ("fan", fan, "the walk that ends at torn links"),
        ("lox", lox, "0.1, checks nothing"),
        ("CGAL", theirs, version),
    ];
    let faces = triangles.corners.len();
    let heading = format!(
        "{}: {} vertices, {faces} faces",
        triangles.name, triangles.vertices
    );
    format!("{heading}\n{}", report(faces as f64, rows))
}

/// A row for each, beside the better of the last two.
fn report(faces: f64, rows: [(&str, Times, &str); 4]) -> String {
    let head = ["", "build Mf/s", "x best", "walk ns a visit", "x best", ""];
    let mut lines = vec![line(head)];
    let rows =
        rows.map(|(name, times, note)| (name, [median(times.build), median(times.walk)], note));
    let best = [0, 1].map(|i| rows[2..].iter().filter_map(|row| row.1[i]).reduce(f64::min));
    for (name, seconds, note) in rows {
        let cell = |i: usize, text: &dyn Fn(f64) -> String| seconds[i].map_or(String::new(), text);
        let ratio = |i: usize| {
            let ratio = best[i].zip(seconds[i]).map(|(best, own)| best / own);
            ratio.map_or(String::new(), |ratio| format!("{ratio:.2}"))
        };
        lines.push(line([
            name,
            &cell(0, &|seconds| format!("{:.1}", faces / 1e6 / seconds)),
            &ratio(0),
            &cell(1, &|seconds| {
                format!("{:.2}", seconds * 1e9 / (3.0 * faces))
            }),
            &ratio(1),
            note,
        ]));
    }
    table(&lines)
}

/// The seconds of a walk that says how many corners it came to.
fn walked(triangles: &Triangles, walk: impl FnOnce() -> (usize, usize)) -> f64 {
    let ((visits, sum), seconds) = timed_on_cpu(walk);
    black_box(sum);
    assert_eq!(visits, 3 * triangles.corners.len(), "all faces are found");
    seconds
}

/// How many faces there are round all vertices, and the sum of their numbers.
fn walk(mesh: &Mesh) -> (usize, usize) {
    counted(
        mesh.vertices()
            .flat_map(|v| mesh.corners_of(v))
            .map(|h| h.face().index()),
    )
}

fn walk_fans(mesh: &Mesh) -> (usize, usize) {
    let fans = mesh.vertices().filter_map(|v| mesh.half_edge_of(v));
    counted(fans.flat_map(|h| mesh.fan(h)).map(|h| h.face().index()))
}

//! `growth`: what each stage of a cut costs a face as meshes grow, on sheets and on fans of one vertex.

use tearmesh::{
    CutMethod, Edits, Mesh, Plane, Point, Positions, Scissor, Vector, gap, mend, shapes,
};
use tearmesh_obj::{Document, TornDocument};

use crate::measure::{median_of, timed_on_cpu};
use crate::options::Options;
use crate::sheet::{Dialect, Sheet};
use crate::table::table;

/// About how many faces a sheet has, up to `--faces`, and how many a fan has.
const SIZES: [usize; 4] = [10_000, 100_000, 1_000_000, 10_000_000];

const STAGES: [&str; 7] = ["read", "build", "check", "cut", "report", "mend", "write"];

/// What is done to a fan beside the stages of a sheet, by one plane near its hub.
const OPTIONS: [&str; 6] = [
    "partition",
    "uniform",
    "alternating",
    "snap-move",
    "gap",
    "pieces",
];

/// Both tables: nanoseconds a face of CPU time, each a median, and how they grow.
pub(crate) fn run(options: &Options) -> String {
    let sizes = || {
        SIZES
            .into_iter()
            .filter(|&faces| faces <= options.faces.max(SIZES[1]))
    };
    let sheet = |faces| stages(&Sheet::new(Dialect::Plain, faces).text);
    let fan = |faces| {
        let mut times = stages(&fan_text(faces));
        times.extend(OPTIONS.iter().map(|name| option(name, faces)));
        times
    };
    let names = [&STAGES[..], &OPTIONS].concat();
    format!(
        "a waving sheet: CPU time a face, ns\n{}\na fan, all faces at one vertex: CPU time a face, ns\n{}",
        grown(&STAGES, sizes(), sheet, options.rounds),
        grown(
            &names,
            sizes().filter(|&n| n <= SIZES[2]),
            fan,
            options.rounds
        )
    )
}

/// A row for each name: the cost a face at each size, and the exponent of the last tenfold.
fn grown(
    names: &[&str],
    sizes: impl Iterator<Item = usize>,
    times: impl Fn(usize) -> Vec<f64>,
    rounds: usize,
) -> String {
    let mut rows = vec![vec![String::new()]];
    rows.extend(names.iter().map(|name| vec![(*name).to_owned()]));
    let mut costs: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    for faces in sizes {
        rows[0].push(faces.to_string());
        // A small mesh is over in no time: as many rounds as take as long as one of a large mesh.
        let rounds = (SIZES[2] / faces).clamp(1, 20) * rounds.min(3);
        let all: Vec<Vec<f64>> = (0..rounds).map(|_| times(faces)).collect();
        for (i, row) in rows[1..].iter_mut().enumerate() {
            let cost = median_of(&all, |times| times[i] * 1e9 / faces as f64);
            row.push(format!("{cost:.1}"));
            costs[i].push(cost);
        }
    }
    rows[0].push("exponent".to_owned());
    for (row, costs) in rows[1..].iter_mut().zip(&costs) {
        let [.., before, last] = costs[..] else {
            continue;
        };
        row.push(format!("{:.2}", 1.0 + (last / before).log10()));
    }
    table(&rows)
}

/// How many seconds each stage of the command takes that cuts this file by a plane, and mends the cut.
fn stages(text: &str) -> Vec<f64> {
    let (document, read) = timed_on_cpu(|| Document::read(text.as_bytes()).expect("readable"));
    let (mesh, build) = timed_on_cpu(|| document.mesh().expect("a mesh"));
    let (violations, check) = timed_on_cpu(|| mesh.check());
    assert_eq!(violations, []);
    let positions = Positions::new(document.positions().iter().copied()).expect("finite");
    let copy = (mesh.clone(), positions.clone());
    let (_, cut) = timed_on_cpu(|| cut_by(CutMethod::Exact, false, copy));
    let (mut mesh, mut positions, mut edits) = (mesh, positions, Edits::new());
    let (_, report) = timed_on_cpu(|| {
        let made = scissor().cut_measured(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
        made.expect("a cut")
    });
    let mut torn = TornDocument::new(&document);
    edits.replay(&mut torn);
    let write = || {
        torn.write(&mesh, &positions, &mut Vec::new())
            .expect("memory takes all")
    };
    let (_, write) = timed_on_cpu(write);
    let (_, mend) = timed_on_cpu(|| {
        let stitches = mend::stitches(&mesh, |_| true);
        let far = f64::INFINITY;
        mend::sew(&mut mesh, &positions, &stitches, |_| 1.0, far, &mut edits).expect("one root");
    });
    vec![read, build, check, cut, report, mend, write]
}

/// How many seconds one option takes at a fan.
fn option(name: &str, faces: usize) -> f64 {
    let fan = shapes::fan(faces as u32, true);
    let by = |method, slides| {
        let copy = fan.clone();
        timed_on_cpu(|| cut_by(method, slides, copy)).1
    };
    let (torn, at) = cut_by(CutMethod::Exact, false, fan.clone());
    match name {
        "partition" => by(CutMethod::Partition, false),
        "uniform" => by(CutMethod::Uniform, false),
        "alternating" => by(CutMethod::Alternating, false),
        "snap-move" => by(CutMethod::Exact, true),
        "gap" => timed_on_cpu(|| gap::gapped(&torn, &at, 0.01)).1,
        _ => timed_on_cpu(|| torn.components().count()).1,
    }
}

fn scissor() -> Scissor {
    let normal = Vector::new(1.0, 0.2, 0.0);
    Scissor::by_plane(Plane::new(Point::new(0.003, 0.0, 0.0), normal).expect("a normal"))
}

fn cut_by(
    method: CutMethod,
    slides: bool,
    (mut mesh, mut positions): (Mesh, Positions),
) -> (Mesh, Positions) {
    let scissor = scissor().with_snap_move(slides);
    let cut = scissor.cut(method, &mut mesh, &mut positions, &mut Edits::new());
    cut.expect("a cut");
    (mesh, positions)
}

/// A fan as an OBJ file.
fn fan_text(faces: usize) -> String {
    let (mesh, positions) = shapes::fan(faces as u32, true);
    let at = positions.as_slice().iter();
    let mut text: String = at.map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect();
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f).map(|v| v.index() + 1);
        text.push_str(&format!("f {a} {b} {c}\n"));
    }
    text
}

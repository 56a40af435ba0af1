//! Cut methods: what a cut takes, and how far its seam is from where it should be.
//!
//! Sheets of random triangles that wave are cut through along lines at random, by every method and with
//! several snaps, each time the same lines on a mesh as it was at first. What is measured of each is a
//! [`CutReport`], and what the slivers of a cut leave of the step of an explicit
//! solver. Times are those of cuts alone, for each face of the mesh, so that meshes of several sizes and
//! records from elsewhere can stand in one chart: see [`Rival`].

mod csv;
mod rival;
mod svg;
#[cfg(test)]
mod tests;
mod words;

pub use self::csv::csv;
pub use self::rival::{NoRecord, Rival, rivals};
pub use self::svg::svg;
pub use self::words::summary;

use std::f64::consts::PI;
use std::num::NonZero;
use std::time::Duration;

use serde::Serialize;
use tearmesh::{
    Cut, CutMethod, CutReport, Edits, Masses, Mesh, Point, Positions, Ray, Scissor, Vector,
};
use tearmesh_cloth::{Cloth, Fabric, stable_step_s};

use crate::pareto::{SEED, delaunay};
use crate::pool::side_by_side;
use crate::provenance::Provenance;
use crate::random::Random;
use crate::sample::median;

/// A method with its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// As it stands in tables.
    pub name: &'static str,
    /// The method.
    pub method: CutMethod,
    /// The snap of `exact`.
    pub snap: f64,
    /// Whether what snaps is moved onto the plane.
    pub is_moved: bool,
}

const fn way(name: &'static str, method: CutMethod, snap: f64, is_moved: bool) -> Way {
    Way {
        name,
        method,
        snap,
        is_moved,
    }
}

/// All that is tried.
pub const WAYS: [Way; 10] = [
    way("uniform", CutMethod::Uniform, 0.0, false),
    way("alternating", CutMethod::Alternating, 0.0, false),
    way("partition", CutMethod::Partition, 0.0, false),
    way("exact 0", CutMethod::Exact, 0.0, false),
    way("exact .02", CutMethod::Exact, 0.02, false),
    way("exact .05", CutMethod::Exact, 0.05, false),
    way("exact .1", CutMethod::Exact, 0.1, false),
    way("exact .2", CutMethod::Exact, 0.2, false),
    way("exact .05 moved", CutMethod::Exact, 0.05, true),
    way("exact .2 moved", CutMethod::Exact, 0.2, true),
];

/// What to chart, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// Cells a side of the sheets.
    pub cells: Vec<u32>,
    /// Lines that each is cut along.
    pub cuts: u32,
    /// How many cuts are made at a time; times are best taken alone.
    pub threads: NonZero<usize>,
}

/// The experiment, made.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// How to read the file.
    pub schema: &'static str,
    /// Where it comes from.
    pub provenance: Provenance,
    /// What lines begin with.
    pub seed: u64,
    /// Lines that each sheet was cut along.
    pub cuts: u32,
    /// By size and way.
    pub rows: Vec<Row>,
    /// From elsewhere.
    pub rivals: Vec<Rival>,
}

/// A way on a sheet: numbers are medians over all lines, unless they say otherwise.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The way.
    pub way: &'static str,
    /// The faces of the sheet.
    pub faces: usize,
    /// CPU time of a cut for each face of the sheet in ns; `None` without a clock.
    pub ns_per_face: Option<f64>,
    /// What the log of a cut has: vertices inserted and split.
    pub edits: f64,
    /// The largest distance of the seam from the plane, in mean edges.
    pub deviation_edges: f64,
    /// The same, the largest of all lines.
    pub deviation_edges_most: f64,
    /// The length of the seam over that of the slit.
    pub length_ratio: f64,
    /// The same, the largest of all lines.
    pub length_ratio_most: f64,
    /// Lines along which the sheet was divided into the pieces that were expected.
    pub divided: u32,
    /// Pieces beyond those expected, as a mean.
    pub crumbs: f64,
    /// Pieces short of them, as a mean.
    pub lost: f64,
    /// Vertices that were inserted.
    pub inserted: f64,
    /// The smallest angle of any face, in degrees: the least of all lines.
    pub angle_min_deg: f64,
    /// The smallest altitude over that before the cut: the least of all lines.
    pub altitude_ratio: f64,
    /// The stable step of springs after the cut over that before it.
    pub step_ratio: f64,
    /// The same, the least of all lines.
    pub step_ratio_least: f64,
}

/// A sheet, waving, with what is known of it before any cut.
struct Subject {
    mesh: Mesh,
    positions: Positions,
    altitude_m: f64,
    step_s: f64,
}

/// What came of one cut.
struct Done {
    report: CutReport,
    cpu: Option<Duration>,
    step_s: f64,
}

/// How many cuts that will be.
#[must_use]
pub fn cuts(options: &Options) -> usize {
    options.cells.len() * WAYS.len() * options.cuts as usize
}

/// Makes the experiment. `clock` tells the CPU time of the thread that asks; without it there are no times,
/// and the same options give the same study. All ends with the cut under way, without a study, where `stop`
/// says so; `watch` hears of each cut.
///
/// # Panics
///
/// Never: the sheets are data of our own.
#[must_use]
pub fn study(
    options: &Options,
    provenance: Provenance,
    rivals: Vec<Rival>,
    clock: Option<&(dyn Fn() -> Duration + Sync)>,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(&str),
) -> Option<Study> {
    let mut rows = Vec::new();
    for &cells in &options.cells {
        let subject = Subject::new(cells);
        for way in &WAYS {
            let lines: Vec<u64> = (0..u64::from(options.cuts)).collect();
            let done = side_by_side(
                &lines,
                options.threads,
                |_| 1.0,
                |&line| (!stop()).then(|| subject.cut(way, line, clock)),
                |_| {
                    watch(way.name);
                    !stop()
                },
            )?;
            let done: Vec<Done> = done.into_iter().collect::<Option<_>>()?;
            rows.push(subject.row(way, &done));
        }
    }
    Some(Study {
        schema: "tearmesh.chart.cut/1",
        provenance,
        seed: SEED,
        cuts: options.cuts,
        rows,
        rivals,
    })
}

impl Subject {
    fn new(cells: u32) -> Subject {
        let (mesh, positions) = sheet(cells);
        let altitude_m = altitude_m(&mesh, &positions);
        let step_s = step_s(&mesh, &positions);
        Subject {
            mesh,
            positions,
            altitude_m,
            step_s,
        }
    }

    fn cut(&self, way: &Way, line: u64, clock: Option<&(dyn Fn() -> Duration + Sync)>) -> Done {
        let scissor = through(line).snap(way.snap).snap_move(way.is_moved);
        let fresh = || (self.mesh.clone(), self.positions.clone(), Edits::new());
        let cpu = clock.map(|clock| {
            let (mut mesh, mut positions, mut edits) = fresh();
            let mut cut = Cut::default();
            let began = clock();
            let made =
                scissor.cut_into(way.method, &mut mesh, &mut positions, &mut edits, &mut cut);
            let took = clock().saturating_sub(began);
            made.expect("positions of their own are in step");
            took
        });
        let (mut mesh, mut positions, mut edits) = fresh();
        let made = scissor.cut_measured(way.method, &mut mesh, &mut positions, &mut edits);
        let (_, report) = made.expect("positions of their own are in step");
        edits.replay(&mut positions);
        Done {
            report,
            cpu,
            step_s: step_s(&mesh, &positions),
        }
    }

    fn row(&self, way: &Way, done: &[Done]) -> Row {
        let middle = |of: &dyn Fn(&Done) -> f64| {
            median(done.iter().map(of).collect()).expect("a cut at least")
        };
        let most = |of: &dyn Fn(&Done) -> f64| done.iter().map(of).fold(f64::MIN, f64::max);
        let mean = |of: &dyn Fn(&Done) -> usize| {
            done.iter().map(of).sum::<usize>() as f64 / done.len() as f64
        };
        let faces = self.mesh.face_count();
        let times = done.iter().filter_map(|one| one.cpu);
        let times: Vec<f64> = times.map(|cpu| 1e9 * cpu.as_secs_f64()).collect();
        let step = |one: &Done| one.step_s / self.step_s;
        let deviation = |one: &Done| one.report.seam_deviation_max_edges;
        let length = |one: &Done| one.report.seam_length_ratio;
        let is_divided = |one: &&Done| one.report.crumbs + one.report.lost == 0;
        Row {
            way: way.name,
            faces,
            ns_per_face: median(times).map(|ns| ns / faces as f64),
            edits: middle(&|one| (one.report.splits + one.report.vertices_inserted) as f64),
            deviation_edges: middle(&deviation),
            deviation_edges_most: most(&deviation),
            length_ratio: middle(&length),
            length_ratio_most: most(&length),
            divided: done.iter().filter(is_divided).count() as u32,
            crumbs: mean(&|one| one.report.crumbs),
            lost: mean(&|one| one.report.lost),
            inserted: middle(&|one| one.report.vertices_inserted as f64),
            angle_min_deg: -most(&|one| -one.report.angle_min_deg),
            altitude_ratio: -most(&|one| -one.report.altitude_min / self.altitude_m),
            step_ratio: middle(&step),
            step_ratio_least: -most(&|one| -step(one)),
        }
    }
}

/// The Delaunay triangles of a grid whose inner points are off their places at random, waving.
fn sheet(cells: u32) -> (Mesh, Positions) {
    let mut random = Random(SEED);
    let width = cells + 1;
    let points: Vec<[f64; 2]> = (0..width * width)
        .map(|i| {
            let place = [i % width, i / width];
            let is_rim = place.iter().any(|i| [0, cells].contains(i));
            place.map(|i| {
                let off = if is_rim {
                    0.0
                } else {
                    0.8 * random.next() - 0.4
                };
                (f64::from(i) + off) / f64::from(cells)
            })
        })
        .collect();
    let cell = 1.0 / f64::from(cells);
    let mesh = delaunay(&points, 1e-9 * cell * cell);
    let waving = points.iter();
    let waving = waving.map(|&[x, y]| Point::new(x, y, 0.1 * (9.0 * x + 4.0 * y).sin()));
    let positions = Positions::new(waving).expect("a sheet's coordinates are finite");
    (mesh, positions)
}

/// From above right through the sheet, along a line at random.
fn through(line: u64) -> Scissor {
    let mut random = Random(SEED + 1000 * line);
    let [x, y] = [0, 1].map(|_| 0.25 + 0.5 * random.next());
    let (sin, cos) = (PI * random.next()).sin_cos();
    let ray = |along: f64| {
        let origin = Point::new(x + along * cos, y + along * sin, 5.0);
        Ray::new(origin, -Vector::z()).expect("a direction")
    };
    let scissor = Scissor::new(ray(-2.0), ray(2.0)).expect("two lines");
    scissor.through(true)
}

/// The longest stable step by velocity Verlet of springs along the edges, in seconds.
fn step_s(mesh: &Mesh, positions: &Positions) -> f64 {
    let masses = Masses::area(mesh, positions, 0.15).expect("each face has an area");
    let cloth = Cloth::new(mesh, positions, masses, Fabric::new(1e3));
    let mut cloth = cloth.expect("each edge has a length");
    stable_step_s(cloth.system_mut(), 2.0)
}

/// The smallest altitude of all faces.
fn altitude_m(mesh: &Mesh, positions: &Positions) -> f64 {
    let each = mesh.faces().map(|f| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| positions.at(v));
        let longest = [b - a, c - b, a - c]
            .iter()
            .map(|side| side.norm())
            .fold(0.0, f64::max);
        (b - a).cross(&(c - a)).norm() / longest
    });
    each.fold(f64::INFINITY, f64::min)
}

//! Cut methods: the time of a cut, and the distance of its seam from the plane.
//!
//! Wavy sheets of random triangles are cut through along random lines, by every method and with several
//! snaps. Every method cuts the same lines, each on a fresh copy of the sheet. The results are those of
//! [`CutReport`], and the stable step of an explicit solver after the cut, which thin faces shorten. Times
//! are those of cuts alone, per face of the sheet. So meshes of several sizes and records of other programs
//! fit in one chart: see [`Rival`].

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
use tearmesh_cloth::statistics::{Random, median};
use tearmesh_cloth::{Cloth, Fabric, stable_step_s};

use crate::pareto::{SEED, delaunay};
use crate::parts::Missing;
use crate::pool::side_by_side;
use crate::provenance::Provenance;

/// A cut method with its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// The name in tables.
    pub name: &'static str,
    /// The cut method, without its settings.
    pub method: CutMethod,
    /// The argument of [`Scissor::snap`], as a fraction of an edge; 0 for methods other than `exact`.
    pub snap: f64,
    /// The argument of [`Scissor::snap_move`]: whether a snapped vertex is moved onto the plane.
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

/// All methods and settings that are compared, in the order of tables.
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

/// The options of the experiment on cut methods.
#[derive(Clone, Debug)]
pub struct Options {
    /// The number of cells along each side of a sheet, one sheet per entry. None may be 0.
    pub cells: Vec<u32>,
    /// The number of lines along which each sheet is cut, at least 1.
    pub cuts: u32,
    /// The number of cuts to run at a time. Times are most accurate with 1.
    pub threads: NonZero<usize>,
}

/// The results of the experiment on cut methods.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// The name and version of the file format.
    pub schema: &'static str,
    /// The origin of the results.
    pub provenance: Provenance,
    /// The seed of the random sheets and lines.
    pub seed: u64,
    /// The number of lines along which each sheet was cut.
    pub cuts: u32,
    /// The results, ordered by sheet and then by method, as in [`WAYS`].
    pub rows: Vec<Row>,
    /// The results of other programs, read from a record.
    pub rivals: Vec<Rival>,
    /// The sheets and methods whose results are not there; empty for an experiment that was run to its end.
    pub missing: Vec<Missing>,
}

/// The results of one method on one sheet, over all lines.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The name of the method, as in [`Way::name`].
    pub way: &'static str,
    /// The number of faces of the sheet before a cut.
    pub faces: usize,
    /// The median CPU time of a cut in ns, divided by `faces`; `None` without a clock.
    pub ns_per_face: Option<f64>,
    /// The median number of edits in the log of a cut: vertices inserted and vertices split.
    pub edits: f64,
    /// The median over all lines of the largest distance of the seam from the plane, in mean edge lengths.
    pub deviation_edges: f64,
    /// The largest distance of any seam from its plane, in mean edge lengths.
    pub deviation_edges_most: f64,
    /// The median of the length of the seam divided by that of the slit.
    pub length_ratio: f64,
    /// The largest ratio of the length of a seam to that of its slit.
    pub length_ratio_most: f64,
    /// The number of lines along which the cut left the expected number of pieces.
    pub divided: u32,
    /// The mean number of pieces per cut beyond those expected.
    pub crumbs: f64,
    /// The mean number of pieces per cut that were expected and are missing.
    pub lost: f64,
    /// The median number of inserted vertices.
    pub inserted: f64,
    /// The smallest angle of any face after any of the cuts, in degrees.
    pub angle_min_deg: f64,
    /// The smallest altitude of any face after any of the cuts, divided by the smallest before them.
    pub altitude_ratio: f64,
    /// The median of the stable step of springs after a cut, divided by that before it.
    pub step_ratio: f64,
    /// The smallest ratio of the stable step after a cut to that before it.
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

/// Returns the number of cuts of the experiment.
#[must_use]
pub fn cuts(options: &Options) -> usize {
    options.cells.len() * WAYS.len() * options.cuts as usize
}

/// Runs the experiment.
///
/// `clock` returns the CPU time of the calling thread. Without it there are no times, and the same options
/// give the same study. `watch` is called after each cut with the name of its method. When `stop` returns true,
/// no other cut is begun, and methods that have not cut a sheet along every line are missing for that sheet.
/// Returns `None` if that leaves no row.
///
/// # Panics
///
/// If `options.cuts` is 0, or a number of `options.cells` is 0 or more than a mesh can have.
#[must_use]
pub fn study(
    options: &Options,
    provenance: Provenance,
    rivals: Vec<Rival>,
    clock: Option<&(dyn Fn() -> Duration + Sync)>,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(&str),
) -> Option<Study> {
    let lines: Vec<u64> = (0..u64::from(options.cuts)).collect();
    let (mut rows, mut missing) = (Vec::new(), Vec::new());
    for &cells in &options.cells {
        let subject = (!stop()).then(|| Subject::new(cells));
        for way in &WAYS {
            let made = subject.as_ref().and_then(|subject| {
                let done = side_by_side(
                    &lines,
                    options.threads,
                    |_| 1.0,
                    |&line| (!stop()).then(|| subject.cut(way, line, clock)),
                    |_| {
                        watch(way.name);
                    },
                );
                let done: Option<Vec<Done>> = done.into_iter().collect();
                Some(subject.row(way, &done?))
            });
            match made {
                Some(row) => rows.push(row),
                None => {
                    let name = format!("{} on {cells} cells", way.name);
                    missing.push(Missing::interrupted(name));
                }
            }
        }
    }
    if rows.is_empty() && !missing.is_empty() {
        return None;
    }
    Some(Study {
        schema: "tearmesh.chart.cut/1",
        provenance,
        seed: SEED,
        cuts: options.cuts,
        rows,
        rivals,
        missing,
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
    let mut random = Random::new(SEED);
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
    let mut random = Random::new(SEED + 1000 * line);
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

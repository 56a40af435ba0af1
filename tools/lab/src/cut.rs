//! Cut methods: the time of a cut, and the distance of its seam from the plane.
//!
//! Wavy sheets of random triangles are cut through along random lines, by every method and with several
//! snaps. Every method cuts the same lines, each on a fresh copy of the sheet. The results are those of
//! [`CutReport`], and the stable step of an explicit solver after the cut, which thin faces shorten. Times
//! are those of cuts alone, per face of the sheet, so sheets of several sizes fit in one figure.

mod chart;

use std::f64::consts::PI;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tearmesh::{CutMethod, CutReport, Edits, Masses, Mesh, Positions, Scissor};
use tearmesh_cloth::{Cloth, Fabric, stable_step_s};

use crate::experiment::{Bounds, Experiment, Status};
use crate::sheet::{DENSITY_KG_PER_M2, SEED, through, wavy};
use crate::statistics::{Random, median};

/// The experiment on cut methods.
#[derive(Clone, Debug)]
pub struct Cuts {
    cuts: u32,
    sheets: Vec<WavySheet>,
}

/// A method on a sheet, over all lines. Without measurements it is the key of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    /// The name of the method with its settings.
    pub(crate) method: String,
    /// The number of faces of the sheet before a cut.
    pub(crate) faces: usize,
    /// Whether the sheet was cut along every line. If not, there are no measurements.
    pub(crate) status: Status,
    /// The number of lines.
    pub(crate) cuts: Option<usize>,
    /// The median CPU time of a cut in ns, divided by `faces`; 0 without a clock.
    pub(crate) ns_per_face: Option<f64>,
    /// The median over all lines of the largest distance of the seam from the plane, in mean edge lengths.
    pub(crate) deviation_edges: Option<f64>,
    /// The largest distance of any seam from its plane, in mean edge lengths.
    pub(crate) deviation_edges_most: Option<f64>,
    /// The number of lines along which the cut left the expected number of pieces.
    pub(crate) divided: Option<usize>,
    /// The median of the stable step of springs after a cut, divided by that before it.
    pub(crate) step_ratio: Option<f64>,
    /// The smallest ratio of the stable step after a cut to that before it.
    pub(crate) step_ratio_least: Option<f64>,
}

/// All methods and settings that are compared, in the order of tables: the name, the method, and the arguments
/// of [`Scissor::with_snap`] and [`Scissor::with_snap_move`].
const METHODS: [(&str, CutMethod, f64, bool); 10] = [
    ("uniform", CutMethod::Uniform, 0.0, false),
    ("alternating", CutMethod::Alternating, 0.0, false),
    ("partition", CutMethod::Partition, 0.0, false),
    ("exact 0", CutMethod::Exact, 0.0, false),
    ("exact .02", CutMethod::Exact, 0.02, false),
    ("exact .05", CutMethod::Exact, 0.05, false),
    ("exact .1", CutMethod::Exact, 0.1, false),
    ("exact .2", CutMethod::Exact, 0.2, false),
    ("exact .05 moved", CutMethod::Exact, 0.05, true),
    ("exact .2 moved", CutMethod::Exact, 0.2, true),
];

/// The CPU time of a cut with all that is measured of it, in seconds per face, on the machine on which charts
/// were first made.
const FACE_S: f64 = 2e-6;

impl Cuts {
    /// Creates the experiment with a sheet for each number of cells along its sides, each of which is cut along
    /// `cuts` lines.
    ///
    /// # Panics
    ///
    /// If `cuts` is 0, or a number of cells is 0 or more than a mesh can have.
    #[must_use]
    pub fn new(cells: &[u32], cuts: u32) -> Cuts {
        assert!(cuts > 0, "a sheet is cut along one line at least");
        Cuts {
            sheets: cells.iter().map(|&cells| WavySheet::new(cells)).collect(),
            cuts,
        }
    }
}

impl Experiment for Cuts {
    type Row = Row;

    const IS_ALONE: bool = true;
    const IS_TIMED: bool = true;

    fn plan(&self) -> Vec<Vec<Row>> {
        let keys = self.sheets.iter().flat_map(|sheet| {
            METHODS.map(|(method, ..)| Row {
                method: method.to_owned(),
                faces: sheet.mesh.face_count(),
                ..Row::default()
            })
        });
        vec![keys.collect()]
    }

    fn guess_s(&self, key: &Row) -> f64 {
        FACE_S * f64::from(self.cuts) * key.faces as f64
    }

    fn run(&self, key: &Row, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        let mut sheets = self.sheets.iter();
        let sheet = sheets.find(|sheet| sheet.mesh.face_count() == key.faces)?;
        let cut = |line| {
            let goes_on = !(bounds.stop)();
            goes_on.then(|| sheet.cut(&key.method, line, bounds))?
        };
        let cuts = (0..self.cuts).map(cut).collect::<Option<Vec<Measured>>>()?;
        let all = |of: fn(&Measured) -> f64| cuts.iter().map(of);
        let middle = |of| median(all(of).collect());
        let is_divided = |cut: &&Measured| cut.report.crumbs + cut.report.lost == 0;
        let ns = middle(|cut| 1e9 * cut.cpu.as_secs_f64());
        Some(vec![Row {
            status: Status::Ok,
            cuts: Some(cuts.len()),
            ns_per_face: ns.map(|ns| ns / key.faces as f64),
            deviation_edges: middle(|cut| cut.report.seam_deviation_max_edges),
            deviation_edges_most: all(|cut| cut.report.seam_deviation_max_edges).reduce(f64::max),
            divided: Some(cuts.iter().filter(is_divided).count()),
            step_ratio: middle(|cut| cut.step_ratio),
            step_ratio_least: all(|cut| cut.step_ratio).reduce(f64::min),
            ..key.clone()
        }])
    }
}

/// The measurements of a cut.
struct Measured {
    report: CutReport,
    cpu: Duration,
    step_ratio: f64,
}

/// A wavy sheet, with its stable step before any cut.
#[derive(Clone, Debug)]
struct WavySheet {
    mesh: Mesh,
    positions: Positions,
    step_s: f64,
}

impl WavySheet {
    fn new(cells: u32) -> WavySheet {
        let (mesh, positions) = wavy(cells);
        WavySheet {
            step_s: step_s(&mesh, &positions),
            mesh,
            positions,
        }
    }

    /// Cuts a copy of the sheet twice: to time the cut alone, and to measure its result. `None` if there is no
    /// method of this name.
    fn cut(&self, method: &str, line: u32, bounds: &Bounds<'_>) -> Option<Measured> {
        let (_, method, snap, is_moved) = METHODS.into_iter().find(|(name, ..)| *name == method)?;
        let scissor = scissor(line).with_snap(snap).with_snap_move(is_moved);
        let copy = || (self.mesh.clone(), self.positions.clone(), Edits::new());
        let (mut mesh, mut positions, mut edits) = copy();
        let began = bounds.now();
        let made = scissor.cut(method, &mut mesh, &mut positions, &mut edits);
        let cpu = bounds.now().saturating_sub(began);
        made.expect("a sheet has a position for each vertex");
        let (mut mesh, mut positions, mut edits) = copy();
        let made = scissor.cut_measured(method, &mut mesh, &mut positions, &mut edits);
        let (_, report) = made.expect("a sheet has a position for each vertex");
        edits.replay(&mut positions);
        Some(Measured {
            step_ratio: step_s(&mesh, &positions) / self.step_s,
            report,
            cpu,
        })
    }
}

/// The scissor that cuts a sheet through along a random line.
fn scissor(line: u32) -> Scissor {
    let mut random = Random::new(SEED + 1000 * u64::from(line));
    let at = [0, 1].map(|_| 0.25 + 0.5 * random.next());
    through(at, PI * random.next())
}

/// The longest stable step by velocity Verlet of springs along the edges, in seconds.
fn step_s(mesh: &Mesh, positions: &Positions) -> f64 {
    let masses = Masses::area(mesh, positions, DENSITY_KG_PER_M2);
    let masses = masses.expect("each face has an area");
    let cloth = Cloth::new(mesh, positions, masses, Fabric::new(1e3));
    let mut cloth = cloth.expect("each edge has a length");
    stable_step_s(cloth.system_mut(), 2.0)
}

#[cfg(test)]
mod tests;

//! The JSON report. Others rely on these names: add more, rename none.

use serde::Serialize;
use tearmesh::gap::Gapped;
use tearmesh::{CutMethod, CutReport, Mesh, Point, Ray, Scissor, Vector};
use tearmesh_cloth::Quality;
use tearmesh_cloth::scene::TearEvent;
use tearmesh_obj::Location;

use crate::choice::Choice as _;
use crate::say::Fault;

#[derive(Debug, Default, Serialize)]
pub(crate) struct Report {
    pub(crate) schema: &'static str,
    pub(crate) version: &'static str,
    pub(crate) command: &'static str,
    pub(crate) ok: bool,
    pub(crate) exit: u8,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) input: Option<File>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) output: Option<File>,
    pub(crate) cuts: Vec<Cut>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) gap: Option<Gapped>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) mend: Option<Mend>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) pieces: Option<Pieces>,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub(crate) tear: Option<Tear>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) mass: Option<Mass>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) area: Option<Area>,
    pub(crate) invariants: Invariants,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) timing_ms: Option<Timing>,
    pub(crate) diagnostics: Vec<Entry>,
}

impl Report {
    pub(crate) fn new(command: &'static str) -> Report {
        Report {
            schema: "tearmesh.report/1",
            version: env!("CARGO_PKG_VERSION"),
            command,
            ..Report::default()
        }
    }
}

/// A mesh, and the file that it came from or went to.
#[derive(Debug, Serialize)]
pub(crate) struct File {
    /// `-` for a standard stream; none where nothing was written.
    pub(crate) path: Option<String>,
    pub(crate) vertices: usize,
    pub(crate) faces: usize,
    pub(crate) components: usize,
    pub(crate) boundary_loops: usize,
}

impl File {
    pub(crate) fn of(path: Option<String>, mesh: &Mesh) -> File {
        File {
            path,
            vertices: mesh.vertex_count(),
            faces: mesh.face_count(),
            components: mesh.components().count(),
            boundary_loops: mesh.boundary_loops().len(),
        }
    }
}

#[derive(Debug, Serialize)]
pub(crate) struct Cut {
    /// Of a cut between rays.
    #[serde(skip_serializing_if = "Option::is_none")]
    rays: Option<[RayEntry; 2]>,
    /// Of a cut between two pixels: what to type for the same with rays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) equivalent: Option<String>,
    pub(crate) method: &'static str,
    pub(crate) through: bool,
    plane: PlaneEntry,
    /// Where each ray hit the layer that was cut, of a cut through the first layers alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    layers: Option<[Option<LayerEntry>; 2]>,
    #[serde(flatten)]
    pub(crate) report: CutReport,
}

/// The point cache of a simulation.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Cache {
    pub(crate) path: String,
    pub(crate) samples: usize,
    /// As many as the mesh that was written has `v`.
    pub(crate) points: usize,
    /// What was subtracted from each.
    pub(crate) origin: [f64; 3],
}

/// What was mended.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Mend {
    pub(crate) merged: usize,
    /// The cuts that still keep something apart.
    pub(crate) cuts_left: usize,
    pub(crate) vertices_removed: usize,
    /// Inserted ones that stay because they were edited since.
    pub(crate) vertices_edited: usize,
    /// Vertices that cuts moved and that are where they were before.
    pub(crate) vertices_slid_back: usize,
    /// Those that stay because they were edited since.
    pub(crate) vertices_slid_edited: usize,
    pub(crate) faces_removed: usize,
    pub(crate) pieces_before: usize,
    pub(crate) pieces: usize,
}

/// What a simulation did.
#[derive(Debug, Serialize)]
pub(crate) struct Tear {
    pub(crate) scene: String,
    pub(crate) solver: &'static str,
    /// `done`, `interrupted`, `unstable`, `unsolved` (an implicit step missed its tolerance),
    /// `gained energy` (E-SIM-ENERGY) or `blown up`.
    pub(crate) status: &'static str,
    pub(crate) steps: u64,
    pub(crate) dt_s: f64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) bodies: Vec<BodyGrid>,
    pub(crate) ripple_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) seams: Option<Seams>,
    pub(crate) time_simulated_s: f64,
    pub(crate) time_planned_s: f64,
    pub(crate) splits: u64,
    pub(crate) cap_hit: bool,
    pub(crate) steps_at_cap: u64,
    pub(crate) pieces_before: usize,
    #[serde(skip)]
    pub(crate) crumbs_before: usize,
    pub(crate) pieces: usize,
    pub(crate) crumbs: usize,
    pub(crate) tear_length_m: f64,
    pub(crate) max_stretch: f64,
    pub(crate) momentum_drift: f64,
    pub(crate) energy_j: Energy,
    pub(crate) quality: Quality,
    pub(crate) counters: Counters,
    /// The largest force at a hold that is led about, or at any where none is: mean over 1/60 s.
    /// Not said by Provot's method.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) largest_force_n: Option<f64>,
    /// The same in a single step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) peak_force_n: Option<f64>,
    /// The largest force at a hold as the first of `tears` began: mean over the 1/60 s before it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) first_force_n: Option<f64>,
    /// The steps in which something tore.
    pub(crate) tears: Vec<TearEvent>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) frames: Option<Frames>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) cache: Option<Cache>,
}

/// What became of the pairs of vertices of the seams.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Seams {
    pub(crate) pairs: usize,
    pub(crate) sewn: usize,
    /// How many a load, a hold or a body kept apart, or a step failed at.
    pub(crate) left: usize,
    /// How many were unpicked, sewn or not.
    pub(crate) unpicked: usize,
    pub(crate) open: usize,
}

/// How closely a body of the scene is met: lengths in metres.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct BodyGrid {
    pub(crate) thickness_m: f64,
    pub(crate) cell_m: f64,
    pub(crate) error_rms_m: f64,
    pub(crate) error_worst_m: f64,
    /// How far the nearest vertex is from the skin at the end, negative inside.
    pub(crate) nearest_vertex_m: f64,
    /// The same of the middle of an edge.
    pub(crate) nearest_middle_m: f64,
}

/// Energy in joules: what edges held as they tore, and the balance of all: what was
/// there when the simulation began, what is there, and the work of everything on the way.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Energy {
    pub(crate) torn_edges: f64,
    pub(crate) began: f64,
    pub(crate) kinetic: f64,
    pub(crate) elastic: f64,
    pub(crate) gravity: f64,
    /// As `numerical_dissipation`, not said where Provot's limiter has worked: that grows without bound as steps
    /// get shorter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) held: Option<f64>,
    pub(crate) wind: f64,
    pub(crate) drag: f64,
    pub(crate) damping: f64,
    pub(crate) colliders: f64,
    pub(crate) edits: f64,
    /// The remainder, which the method lost, or made where negative.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) numerical_dissipation: Option<f64>,
}

/// What was computed.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Counters {
    #[serde(flatten)]
    pub(crate) counters: tearmesh_cloth::Counters,
    pub(crate) features: Vec<FeatureCost>,
}

/// What a scene paid for a feature: visits of springs, triangles, faces or particles, and which part of
/// all visits that is.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct FeatureCost {
    pub(crate) name: &'static str,
    pub(crate) visits: u64,
    pub(crate) share: f64,
}

/// Pieces that were written, each into a file of its own.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Pieces {
    pub(crate) folder: String,
    pub(crate) count: usize,
}

/// Frames that were written.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Frames {
    pub(crate) folder: String,
    pub(crate) count: usize,
    pub(crate) topology: &'static str,
    /// Corners of frames that were found where they are in the frame's own mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) corners_checked: Option<u64>,
}

impl Cut {
    /// `rays` are those of a cut between two, and `cut` is given if it was to go through the first
    /// layers alone.
    pub(crate) fn new(
        rays: Option<&[Ray; 2]>,
        scissor: &Scissor,
        (method, through): (CutMethod, bool),
        report: &CutReport,
        cut: Option<&tearmesh::Cut>,
    ) -> Cut {
        let plane = scissor.plane();
        // Adding zero turns −0 into 0.
        let zero = Vector::zeros();
        let ray = |ray: Ray| RayEntry {
            origin: ray.origin() + zero,
            direction: ray.direction() + zero,
        };
        let layer = |hit: tearmesh::LayerHit| LayerEntry {
            at: hit.at + zero,
            chain: hit.chain.index(),
        };
        Cut {
            rays: rays.map(|rays| rays.map(ray)),
            equivalent: None,
            method: method.word(),
            through,
            plane: PlaneEntry {
                point: plane.point() + zero,
                normal: plane.normal() + zero,
            },
            layers: cut.map(|cut| cut.layers().map(|hit| hit.map(layer))),
            report: report.clone(),
        }
    }
}

#[derive(Debug, Serialize)]
struct RayEntry {
    origin: Point,
    direction: Vector,
}

/// The place of a hit, and the smallest triangle of what hangs together there, from 0.
#[derive(Debug, Serialize)]
struct LayerEntry {
    at: Point,
    chain: usize,
}

#[derive(Debug, Serialize)]
struct PlaneEntry {
    point: Point,
    normal: Vector,
}

/// The sum over all vertices.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Mass {
    pub(crate) before: f64,
    pub(crate) after: f64,
    pub(crate) unit: &'static str,
}

/// The sum of the areas of all triangles, with every vertex where the `v` of the file puts it: of the file that
/// was read, and of the one that was written.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Area {
    pub(crate) before: f64,
    pub(crate) after: f64,
}

/// The unit where no density was given: a vertex weighs what the faces of the input have of area there, in
/// squares of the file's unit of length.
pub(crate) const AREA: &str = "area";
pub(crate) const KILOGRAM: &str = "kg";

#[derive(Debug, Default, Serialize)]
pub(crate) struct Invariants {
    pub(crate) checked: bool,
    pub(crate) violations: Vec<String>,
}

/// Milliseconds of each stage.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(crate) struct Timing {
    pub(crate) read: f64,
    pub(crate) build: f64,
    pub(crate) cut: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) simulate: Option<f64>,
    pub(crate) check: f64,
    pub(crate) write: f64,
}

#[derive(Debug, Serialize)]
pub(crate) struct Entry {
    level: String,
    code: &'static str,
    path: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
    message: String,
    /// Other lines that have to do with it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    related: Vec<Place>,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<String>,
}

#[derive(Debug, Serialize)]
struct Place {
    line: usize,
    column: usize,
}

impl Entry {
    pub(crate) fn new(fault: &Fault) -> Entry {
        let column = fault.location.zip(fault.excerpt.as_ref());
        let place = |(at, _): &(Location, _)| Place {
            line: at.line,
            column: at.column,
        };
        Entry {
            level: fault.level.to_string(),
            code: fault.code,
            path: fault.location.map(|_| fault.path.clone()),
            line: fault.location.map(|at| at.line),
            column: column.map(|(at, _)| at.column),
            message: fault.message.clone(),
            related: fault.related.iter().map(place).collect(),
            help: fault.help.clone(),
        }
    }
}

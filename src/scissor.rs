//! The scissor: two rays, a plane between them, and a cut along it.
//!
//! A user picks two points on the screen; each gives a ray. The rays span a plane and a strip of it
//! (Souza et al. 2014 §V, with two errata of the paper mended: see `scissor/strip.rs`).
//!
//! Methods differ in what they split: see [`CutMethod`]. Each returns a [`CutReport`] that says
//! what was done and what was not.

mod exact;
mod measure;
mod offsets;
mod outcome;
mod paper;
mod partition;
mod pieces;
mod strip;
mod unshare;

use std::fmt;

pub use measure::CutReport;
pub use partition::CutTips;

use crate::edit::{Cursor, Edits};
use crate::geometry::{Plane, Ray, max_abs};
use crate::id::VertexId;
use crate::mesh::Mesh;
use crate::place::Positions;
use exact::Trace;
use measure::Survey;
use offsets::Offsets;
use outcome::Outcome;
use paper::Form;
use strip::Strip;

/// A cut to be made: a plane, and two planes that bound it at the sides.
///
/// ```
/// use tearmesh::{shapes, CutMethod, Edits, Point, Positions, Ray, Scissor, Vector};
///
/// let (mut mesh, mut positions) = shapes::grid(8, 8);
/// let down = Vector::new(0.0, 0.0, -1.0);
/// let a = Ray::new(Point::new(0.4, -1.0, 5.0), down)?;
/// let b = Ray::new(Point::new(0.4, 2.0, 5.0), down)?;
/// let mut edits = Edits::new();
/// let report = Scissor::new(&a, &b)?.cut(CutMethod::Partition, &mut mesh, &mut positions, &mut edits)?;
/// assert_eq!((report.splits, report.pieces, report.separated), (9, 2, true));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scissor {
    strip: Strip,
    rays: [Ray; 2],
    tips: CutTips,
    exact: exact::Settings,
}

/// How a cut is made. All methods share the rays, the report and the log.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CutMethod {
    /// Insert vertices where the plane crosses edges, so that the seam is straight. Adds faces,
    /// always divides; with a snap ([`Scissor::snap`]) no face gets thin, and the seam is as far
    /// from the plane as that allows.
    #[default]
    Exact,
    /// Label every face by its side of the plane, smooth the labels, and give
    /// each side its own vertices along the seam. Adds no face, always divides, and the seam
    /// runs along edges: on irregular meshes 1.04 to 1.15 times as long as the plane's line,
    /// and up to 0.9 edges away from it.
    Partition,
    /// The paper's first form (Souza et al. 2014 §V): split the vertices on the positive side by
    /// the normal of the plane. Irregular meshes stay in one piece.
    Uniform,
    /// The paper's better form: where two vertices of a face are on the positive side, split
    /// along the edge between them. Mostly divides, and leaves crumbs and a seam up to twice as
    /// long as it need be.
    Alternating,
}

impl Scissor {
    /// The scissor that two rays span.
    ///
    /// The plane passes through both origins and holds the direction of `a`. If the rays
    /// are skew, `b` leaves the plane; [`Scissor::skew`] says how far.
    ///
    /// # Errors
    ///
    /// [`ScissorError::OneLine`] if both rays lie on one line, up to rounding.
    pub fn new(a: &Ray, b: &Ray) -> Result<Scissor, ScissorError> {
        let strip = Strip::between(a, b).ok_or(ScissorError::OneLine)?;
        Ok(Scissor {
            strip,
            rays: [*a, *b],
            tips: CutTips::default(),
            exact: exact::Settings {
                snap: Scissor::SNAP,
                snap_move: false,
                joints: Default::default(),
            },
        })
    }

    /// The default of [`Scissor::snap`].
    pub const SNAP: f64 = 0.05;

    /// How near an end of its edge, as a part of it, a crossing may be before the method `exact`
    /// takes the end for the crossing. Brought into 0 … 0.49; NaN counts as 0.
    ///
    /// With 0 the seam is straight to the last digits, and thin faces are what they are. With
    /// r, no new face has an altitude below r (1 − r) of that of the face it was part of. An end of
    /// the slit that would leave a thinner one moves, as little as it has to and by less than the way
    /// through one face: along the slit, or away from an edge that it is too near. It never goes on to
    /// a boundary. On sheets of some hundred triangles slits are .008 of an edge longer or shorter
    /// than asked for in the mean, and .13 at most; on two triangles alone an end is .06 of an edge off
    /// in one of ten cuts, and .7 at most. [`CutReport::tip_overshoots`] says how far.
    #[must_use]
    pub fn snap(mut self, snap: f64) -> Scissor {
        self.exact.snap = if snap.is_nan() {
            0.0
        } else {
            snap.clamp(0.0, 0.49)
        };
        self
    }

    /// Whether the method `exact` moves a vertex that was taken for a crossing onto the plane,
    /// along the edge of that crossing: the seam is straight then, and faces do not get thin
    /// either, but the surface changes a little where it is curved.
    ///
    /// A vertex stays where it is if a face would turn over or lose 70 % of its altitude, if it
    /// is torn already, or if it is on the boundary and the edge is not.
    #[must_use]
    pub fn snap_move(mut self, snap_move: bool) -> Scissor {
        self.exact.snap_move = snap_move;
        self
    }

    /// The scissor that goes on from where a cut by this one ended, at its second ray, to
    /// another ray.
    ///
    /// After a cut by the method `exact` the two cuts meet in one vertex (on each sheet of
    /// the mesh that both rays meet): the new plane passes through its actual position, and the
    /// vertex counts as lying on it. (Where tips on several sheets moved, to leave no thin face, the
    /// plane may pass too far from some.) After another method, and where the cut had no end at the
    /// second ray, this is the scissor of the two rays. Whether it cuts through, its tips and
    /// its snap are those of this one.
    ///
    /// # Errors
    ///
    /// [`ScissorError::OneLine`] if both rays lie on one line, up to rounding.
    ///
    /// # Panics
    ///
    /// If the report is of another mesh than the positions.
    pub fn continued(
        &self,
        report: &CutReport,
        positions: &Positions,
        to: &Ray,
    ) -> Result<Scissor, ScissorError> {
        self.joined(to, [report.ends_at_second_ray(), &[]], positions)
    }

    /// The scissor that goes on from where a cut by this one ended, back to where the first cut of
    /// a polyline began, and closes it.
    ///
    /// As [`Scissor::continued`] finds the vertex where the cut goes on, so this finds that where it
    /// ends: the first cut's end at its first ray. Going back to the same *place* would leave
    /// the slit open wherever the first tip is not exactly on its ray.
    ///
    /// # Errors
    ///
    /// [`ScissorError::OneLine`] if both ends lie on one line with their rays, up to rounding.
    ///
    /// # Panics
    ///
    /// If a report is of another mesh than the positions.
    pub fn closed(
        &self,
        report: &CutReport,
        first: (&Scissor, &CutReport),
        positions: &Positions,
    ) -> Result<Scissor, ScissorError> {
        let (first, first_report) = first;
        let joints = [
            report.ends_at_second_ray(),
            first_report.ends_at_first_ray(),
        ];
        self.joined(&first.rays[0], joints, positions)
    }

    /// The scissor from the second ray of this one to another, through the nearest of the joints at
    /// each.
    fn joined(
        &self,
        to: &Ray,
        joints: [&[VertexId]; 2],
        positions: &Positions,
    ) -> Result<Scissor, ScissorError> {
        let rays = [self.rays[1], *to];
        let [begin, end] = [0, 1].map(|side| {
            let distance = |&&v: &&VertexId| max_abs(positions.at(v) - rays[side].origin());
            let joints = joints[side].iter();
            let nearest = joints.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            let at_joint = Ray::new(positions.at(*nearest), rays[side].direction());
            Some(at_joint.expect("a position and a direction that were accepted"))
        });
        let mut scissor = match begin {
            None => Scissor::new(&rays[0], end.as_ref().unwrap_or(to))?,
            Some(begin) => {
                // The plane holds all of the first ray given, and the origin of the second.
                let mut joined = Scissor::new(end.as_ref().unwrap_or(to), &begin)?;
                joined.strip.sides.reverse();
                joined
            }
        };
        scissor.exact.joints = joints.map(<[VertexId]>::to_vec);
        scissor.rays = rays;
        scissor.strip.through = self.strip.through;
        scissor.tips = self.tips;
        scissor.exact.snap = self.exact.snap;
        scissor.exact.snap_move = self.exact.snap_move;
        Ok(scissor)
    }

    /// Whether to ignore the side planes, and cut wherever the plane goes.
    #[must_use]
    pub fn through(mut self, through: bool) -> Scissor {
        self.strip.through = through;
        self
    }

    /// Where a finite cut of the method `partition` ends; the paper's methods know one rule.
    #[must_use]
    pub fn tips(self, tips: CutTips) -> Scissor {
        Scissor { tips, ..self }
    }

    /// The cutting plane.
    #[must_use]
    pub fn plane(&self) -> Plane {
        self.strip.plane
    }

    /// The side planes, through the origins of the first and second ray. What lies
    /// in front of both is between the rays.
    #[must_use]
    pub fn sides(&self) -> [Plane; 2] {
        self.strip.sides
    }

    /// How far the second ray leaves the cutting plane for each unit of its length: the
    /// sine of the angle between them, 0 unless the rays are skew.
    #[must_use]
    pub fn skew(&self) -> f64 {
        self.strip.skew
    }

    /// Cuts a mesh.
    ///
    /// Positions follow at once, because later cuts read points that earlier ones
    /// made; everything else beside the mesh replays the log. Linear in the mesh (expected
    /// and actual pieces are counted over all of it).
    ///
    /// # Errors
    ///
    /// [`CutError`]; then nothing has changed.
    ///
    /// # Panics
    ///
    /// If `edits` was cleared before `positions` replayed it.
    pub fn cut(
        &self,
        method: CutMethod,
        mesh: &mut Mesh,
        positions: &mut Positions,
        edits: &mut Edits,
    ) -> Result<CutReport, CutError> {
        in_step(mesh, positions, edits)?;
        let offsets = self.offsets(method, positions);
        let ready = self.ready(method, mesh, positions, &offsets);
        let strip = &self.strip;
        let expected = match &ready {
            Ready::Exact(trace) => Some(exact::pieces_expected(
                strip,
                &self.exact,
                trace,
                mesh,
                positions,
                &offsets,
            )),
            Ready::Partition | Ready::Paper(_) => None,
        };
        let survey = Survey::new(strip, mesh, positions, &offsets, expected);
        let first_edit = edits.cursor();
        let outcome = self.make(ready, mesh, positions, &offsets, true, edits);
        Ok(survey.report(strip, mesh, positions, outcome, edits, first_edit))
    }

    /// Cuts a mesh like [`Scissor::cut`], and measures nothing: what takes most of the time there
    /// is to look at the whole mesh before and after. The log tells what was done.
    ///
    /// # Errors
    ///
    /// [`CutError`]; then nothing has changed.
    ///
    /// # Panics
    ///
    /// If `edits` was cleared before `positions` replayed it.
    pub fn cut_only(
        &self,
        method: CutMethod,
        mesh: &mut Mesh,
        positions: &mut Positions,
        edits: &mut Edits,
    ) -> Result<(), CutError> {
        in_step(mesh, positions, edits)?;
        let offsets = self.offsets(method, positions);
        let ready = self.ready(method, mesh, positions, &offsets);
        self.make(ready, mesh, positions, &offsets, false, edits);
        Ok(())
    }

    fn offsets(&self, method: CutMethod, positions: &Positions) -> Offsets {
        let offsets = Offsets::new(&self.strip.plane, positions);
        match method {
            CutMethod::Exact => offsets.rounded(),
            _ => offsets,
        }
    }

    /// Decides what can be decided before anything is changed.
    fn ready(
        &self,
        method: CutMethod,
        mesh: &Mesh,
        positions: &Positions,
        offsets: &Offsets,
    ) -> Ready {
        match method {
            CutMethod::Exact => {
                let trace = exact::trace(&self.strip, &self.exact, mesh, positions, offsets);
                Ready::Exact(trace)
            }
            CutMethod::Partition => Ready::Partition,
            CutMethod::Uniform => Ready::Paper(Form::Uniform),
            CutMethod::Alternating => Ready::Paper(Form::Alternating),
        }
    }

    /// Cuts. `label` asks for the side of every face.
    fn make(
        &self,
        ready: Ready,
        mesh: &mut Mesh,
        positions: &mut Positions,
        offsets: &Offsets,
        label: bool,
        edits: &mut Edits,
    ) -> Outcome {
        let strip = &self.strip;
        let outcome = match ready {
            Ready::Exact(trace) => {
                let (snap_move, labels) = (self.exact.snap_move, label.then_some(offsets));
                exact::cut(strip, trace, snap_move, mesh, positions, labels, edits)
            }
            Ready::Partition => partition::cut(strip, self.tips, mesh, positions, offsets, edits),
            Ready::Paper(form) => paper::cut(strip, form, mesh, positions, edits),
        };
        edits.replay(positions);
        outcome
    }
}

/// A method, with what it has found out before it cuts.
enum Ready {
    Exact(Trace),
    Partition,
    Paper(Form),
}

/// Whether positions have seen every edit, and are those of this mesh.
fn in_step(mesh: &Mesh, positions: &Positions, edits: &Edits) -> Result<(), CutError> {
    if positions.seen() != edits.cursor() {
        return Err(CutError::Unreplayed {
            seen: positions.seen(),
            made: edits.cursor(),
        });
    }
    if positions.len() != mesh.vertex_count() {
        let (vertices, positions) = (mesh.vertex_count(), positions.len());
        return Err(CutError::Positions {
            vertices,
            positions,
        });
    }
    Ok(())
}

/// Why two rays make no scissor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ScissorError {
    /// Both rays lie on one line, so they span no plane.
    OneLine,
}

impl fmt::Display for ScissorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the two rays are the same line, so they span no cutting plane")
    }
}

impl std::error::Error for ScissorError {}

/// Why a cut was refused. Nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CutError {
    /// The positions are of another number of vertices.
    Positions {
        /// The vertices of the mesh.
        vertices: usize,
        /// The positions given.
        positions: usize,
    },
    /// The positions have not seen all edits.
    Unreplayed {
        /// Up to where they have seen a log.
        seen: Cursor,
        /// The end of this one.
        made: Cursor,
    },
}

impl fmt::Display for CutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CutError::Positions {
                vertices,
                positions,
            } => {
                write!(f, "{positions} positions for a mesh of {vertices} vertices")
            }
            CutError::Unreplayed { seen, made } => {
                let (seen, made) = (seen.number(), made.number());
                if seen == made {
                    write!(
                        f,
                        "the positions have followed another log, of {seen} edits too"
                    )
                } else {
                    write!(
                        f,
                        "the positions have seen {seen} edits, and the log has {made}: replay first"
                    )
                }
            }
        }
    }
}

impl std::error::Error for CutError {}

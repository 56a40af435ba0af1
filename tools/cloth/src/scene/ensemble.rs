//! Ensembles: one scene played many times, each time with a tiny disturbance.
//!
//! Tearing is chaotic: a nanometre decides which edge tears first, and two runs soon have little in
//! common. So a single run says nothing about a step or a method, but the distribution over many
//! disturbed runs does. The members of an ensemble differ by a [`Disturbance`] and by nothing else.
//! Two ensembles are compared by [`compare`](crate::statistics::compare), for each [`Quantity`].
//!
//! [`member`] plays one of them. Its caller decides which, in which order and on which threads.

use std::error::Error;
use std::num::NonZero;

use tearmesh::geometry::Vector;
use tearmesh::{Mesh, Positions, VertexId};

use super::Scene;
use super::frame::Frame;
use super::run::Run;
use super::tear_log::TearLog;
use crate::statistics::Random;

/// The largest random displacement of a vertex from its starting position along each axis, in
/// metres. Larger displacements spread the results of an ensemble no further.
pub const NOISE_M: f64 = 1e-9;

/// The cloth and the scene that an ensemble plays.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The mesh of the cloth.
    pub mesh: &'a Mesh,
    /// The positions of the vertices of `mesh` at rest, in metres.
    pub positions: &'a Positions,
    /// The frame for which the scene was created.
    pub frame: &'a Frame,
    /// The scene to play.
    pub scene: &'a Scene,
}

/// All runs of a subject with one step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ensemble {
    /// The number by which the step of the scene was divided.
    #[cfg_attr(feature = "serde", serde(rename = "parts"))]
    pub step_divisor: NonZero<u32>,
    /// The divided step, in seconds.
    pub step_s: f64,
    /// The runs, in ascending order of their seeds. Those that failed are included.
    pub members: Vec<Member>,
}

/// One run of an ensemble.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Member {
    /// The seed of the disturbance.
    pub seed: u64,
    /// The way in which the run ended.
    pub status: MemberStatus,
    /// The reason for a failure; empty if the run did not fail.
    pub why: String,
    /// The measured quantities; `None` if the run did not reach its end.
    pub observed: Option<Observed>,
}

/// The ways in which a run of an ensemble ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum MemberStatus {
    /// The run reached its end.
    Done,
    /// The run could not be begun, or a step failed.
    Failed,
    /// The run was interrupted.
    Interrupted,
}

/// The measured quantities of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Observed {
    /// The time of the first tear, in seconds; `None` if nothing tore.
    pub first_tear_s: Option<f64>,
    /// The force at the first tear in newtons, as in [`TearLog::first_tear`]. `None` if nothing tore, or
    /// if the method does not know its forces, as Provot's does not.
    pub first_force_n: Option<f64>,
    /// The rest length of the edges that tore, in metres.
    pub torn_m: f64,
    /// The number of components of the mesh at the end.
    pub pieces: usize,
    /// The largest force at a hold in newtons, as in [`TearLog::largest_force_n`]; `None` if unknown.
    pub largest_force_n: Option<f64>,
    /// The work of all holds, led ones included, in joules. `None` if the method does not know its forces:
    /// the work of Provot's limiter grows without bound as steps get shorter.
    pub work_j: Option<f64>,
    /// The cost of the run: the number of visits to single constraints, whatever for.
    pub(crate) visits: u64,
}

/// A measured quantity of a run: its names, and how it is read.
#[derive(Clone, Copy, Debug)]
pub struct Quantity {
    /// The key of the quantity in reports, which is the name of a field of [`Observed`].
    pub key: &'static str,
    /// The name of the quantity in words, and its unit; the unit is empty for a number.
    pub name: [&'static str; 2],
    /// The value of the quantity in a run; `None` if the method does not know it.
    of: fn(&Observed) -> Option<f64>,
}

impl Quantity {
    /// All quantities, in the order of the fields of [`Observed`]. In a run without a tear the first
    /// tear is infinitely late, at a force that was never reached, unless forces are unknown.
    pub const ALL: [Quantity; 6] = [
        Quantity::new("first_tear_s", ["first tear", "s"], |run| {
            Some(run.first_tear_s.unwrap_or(f64::INFINITY))
        }),
        Quantity::new("first_force_n", ["force then", "N"], |run| {
            match run.first_tear_s {
                Some(_) => run.first_force_n,
                None => run.largest_force_n.map(|_| f64::INFINITY),
            }
        }),
        Quantity::new("torn_m", ["torn length", "m"], |run| Some(run.torn_m)),
        Quantity::new("pieces", ["pieces", ""], |run| Some(run.pieces as f64)),
        Quantity::new("largest_force_n", ["largest force", "N"], |run| {
            run.largest_force_n
        }),
        Quantity::new("work_j", ["work of holds", "J"], |run| run.work_j),
    ];

    const fn new(
        key: &'static str,
        name: [&'static str; 2],
        of: fn(&Observed) -> Option<f64>,
    ) -> Quantity {
        Quantity { key, name, of }
    }
}

impl Ensemble {
    /// Returns the values of a quantity of all members that have it, and whether every member has
    /// it.
    #[must_use]
    pub fn numbers(&self, quantity: Quantity) -> (Vec<f64>, bool) {
        let observed = self.members.iter().filter_map(|member| member.observed);
        let numbers: Vec<f64> = observed.filter_map(|one| (quantity.of)(&one)).collect();
        let is_whole = numbers.len() == self.members.len();
        (numbers, is_whole)
    }
}

/// Plays a subject once, with its step divided by `step_divisor` and the [`Disturbance`] of `seed`.
/// When `stop` returns true, the run ends before its next step and is marked as interrupted.
///
/// ```
/// use std::num::NonZero;
/// use tearmesh::shapes;
/// use tearmesh_cloth::scene::ensemble::{self, Ensemble, Quantity, Subject};
/// use tearmesh_cloth::scene::{Axis, Frame, Scene};
/// use tearmesh_cloth::statistics::{Verdict, compare};
///
/// let (mesh, positions) = shapes::grid(4, 4);
/// let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
/// let scene = &Scene { step_s: Some(1e-3), duration_s: 0.1, ..Scene::hang(&frame) };
/// let subject = Subject { mesh: &mesh, positions: &positions, frame: &frame, scene };
/// let [whole, half] = [1, 2].map(|divisor| {
///     let step_divisor = NonZero::new(divisor).unwrap();
///     let member = |seed| ensemble::member(subject, step_divisor, seed, &|| false);
///     let members = (1..=3).map(member).collect();
///     Ensemble { step_divisor, step_s: 1e-3 / f64::from(divisor), members }
/// });
/// let [_, _, torn_m, ..] = Quantity::ALL;
/// let [(whole, _), (half, _)] = [whole, half].map(|of| of.numbers(torn_m));
/// assert_eq!(compare(&whole, &half).verdict, Verdict::Same); // Nothing tears at either step.
/// ```
///
/// # Panics
///
/// If the divided step leads to more than 2⁴⁰ steps.
#[must_use]
pub fn member(
    subject: Subject<'_>,
    step_divisor: NonZero<u32>,
    seed: u64,
    stop: &dyn Fn() -> bool,
) -> Member {
    let (status, why, observed) = match observe(subject, step_divisor, seed, stop) {
        Ok(Some(observed)) => (MemberStatus::Done, String::new(), Some(observed)),
        Ok(None) => (MemberStatus::Interrupted, String::new(), None),
        Err(error) => (MemberStatus::Failed, error.to_string(), None),
    };
    Member {
        seed,
        status,
        why,
        observed,
    }
}

/// Plays a subject once; `None` if it was stopped, or the reason for a failure.
fn observe(
    subject: Subject<'_>,
    step_divisor: NonZero<u32>,
    seed: u64,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Observed>, Box<dyn Error>> {
    if stop() {
        return Ok(None);
    }
    let Disturbance { mesh, offsets_m } = Disturbance::new(subject.mesh, seed);
    let scene = subject.scene.clone();
    // A rest shape is that of corners as they were.
    let mesh = match scene.rest.is_empty() {
        true => mesh,
        false => subject.mesh.clone(),
    };
    let run = Run::new(mesh, subject.positions, scene, subject.frame)?;
    let run = run.in_smaller_steps(step_divisor);
    let mut run = run.displaced(|v| offsets_m[v.index()])?;
    let torn_before_m = run.torn_length_m();
    let mut tear_log = TearLog::new(&run);
    while !run.is_over() {
        if stop() {
            return Ok(None);
        }
        let tear = run.step()?;
        tear_log.note(&run, &tear);
    }
    let first_tear = tear_log.first_tear();
    let largest_force_n = tear_log.largest_force_n();
    let visits = run.cloth().system().counters().visits;
    Ok(Some(Observed {
        first_tear_s: first_tear.map(|first| first.event.time_s),
        first_force_n: first_tear.and_then(|first| first.force_n),
        torn_m: run.torn_length_m() - torn_before_m,
        pieces: run.mesh().components().count(),
        largest_force_n,
        work_j: largest_force_n.map(|_| run.energy_balance().held_j),
        visits: visits.project + visits.force + visits.detect,
    }))
}

/// The difference of one member of an ensemble from the subject. It is public so that a program can
/// repeat a single run and look at its steps.
#[derive(Clone, Debug)]
pub struct Disturbance {
    /// The mesh with its faces in another order, each beginning with another corner. A torn mesh,
    /// which cannot be built from its faces, stays as it is.
    pub mesh: Mesh,
    /// The displacement of each vertex for [`Run::displaced`], in metres: at most [`NOISE_M`] along
    /// each axis.
    pub offsets_m: Vec<Vector>,
}

impl Disturbance {
    /// Creates the disturbance of a mesh by a seed.
    #[must_use]
    pub fn new(mesh: &Mesh, seed: u64) -> Disturbance {
        let mut random = Random::new(seed);
        let mesh = shuffled(mesh, &mut random);
        let mut offset_m = || NOISE_M * (2.0 * random.next() - 1.0);
        let offset = |_: VertexId| Vector::from_fn(|_, _| offset_m());
        let offsets_m = mesh.vertices().map(offset).collect();
        Disturbance { mesh, offsets_m }
    }
}

fn shuffled(mesh: &Mesh, random: &mut Random) -> Mesh {
    if mesh.half_edges().any(|h| mesh.ghost_pair(h).is_some()) {
        return mesh.clone();
    }
    let mut faces = mesh.indices().as_chunks::<3>().0.to_vec();
    for i in (1..faces.len()).rev() {
        faces.swap(i, random.below(i + 1));
    }
    for face in &mut faces {
        face.rotate_left(random.below(3));
    }
    Mesh::build(mesh.vertex_count(), &faces).unwrap_or_else(|_| mesh.clone())
}

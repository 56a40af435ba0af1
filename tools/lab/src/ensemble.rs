//! Runs that differ by a tiny disturbance.
//!
//! Tearing is chaotic: a nanometre decides which edge tears first, and two runs soon have little in
//! common. So a single run says nothing about a step or a method, but the distribution over many
//! disturbed runs does. The members of an ensemble differ by a [`Disturbance`] and by nothing else.
//! [`observe`] plays one of them. Two ensembles are compared by [`compared`].

use std::num::NonZero;

use tearmesh::geometry::Vector;
use tearmesh::{Mesh, Positions, VertexId};
use tearmesh_cloth::scene::{Frame, Run, Scene, TearLog};

use crate::statistics::{Comparison, Random, Verdict, compare};

/// The largest random displacement of a vertex from its starting position along each axis, in
/// metres. Larger displacements spread the results of an ensemble no further.
pub(crate) const NOISE_M: f64 = 1e-9;

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

/// The measured quantities of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Observed {
    /// The time of the first tear, in seconds; `None` if nothing tore.
    pub(crate) first_tear_s: Option<f64>,
    /// The force at the first tear in newtons, as in [`TearLog::first_force_n`]. `None` if nothing tore, or
    /// if the method does not know its forces, as Provot's does not.
    pub(crate) first_force_n: Option<f64>,
    /// The rest length of the edges that tore, in metres.
    pub(crate) torn_m: f64,
    /// The number of components of the mesh at the end.
    pub(crate) pieces: usize,
    /// The largest force at a hold in newtons, as in [`TearLog::largest_force_n`]; `None` if unknown.
    pub(crate) largest_force_n: Option<f64>,
    /// The work of all holds, led ones included, in joules. `None` if the method does not know its forces:
    /// the work of Provot's limiter grows without bound as steps get shorter.
    pub(crate) work_j: Option<f64>,
}

/// Plays a subject once, with its step divided by `step_divisor` and the [`Disturbance`] of `seed`. Returns the
/// reason if the run could not be begun or a step failed, and `None` if `stop` returned true before a step.
///
/// # Panics
///
/// If the divided step leads to more than 2⁴⁰ steps.
pub(crate) fn observe(
    subject: Subject<'_>,
    step_divisor: NonZero<u32>,
    seed: u64,
    stop: &dyn Fn() -> bool,
) -> Option<Result<Observed, String>> {
    played(subject, step_divisor, seed, stop)
        .map_err(|error| error.to_string())
        .transpose()
}

/// Plays a subject once; `None` if it was stopped.
fn played(
    subject: Subject<'_>,
    step_divisor: NonZero<u32>,
    seed: u64,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Observed>, Box<dyn std::error::Error>> {
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
    let largest_force_n = tear_log.largest_force_n();
    Ok(Some(Observed {
        first_tear_s: tear_log.events().first().map(|first| first.time_s),
        first_force_n: tear_log.first_force_n(),
        torn_m: run.torn_length_m() - torn_before_m,
        pieces: run.mesh().components().count(),
        largest_force_n,
        work_j: largest_force_n.map(|_| run.energy_balance().held_j),
    }))
}

/// The difference of one member of an ensemble from the subject.
#[derive(Clone, Debug)]
pub(crate) struct Disturbance {
    /// The mesh with its faces in another order, each beginning with another corner. A torn mesh,
    /// which cannot be built from its faces, stays as it is.
    pub(crate) mesh: Mesh,
    /// The displacement of each vertex for [`Run::displaced`], in metres: at most [`NOISE_M`] along
    /// each axis.
    pub(crate) offsets_m: Vec<Vector>,
}

impl Disturbance {
    /// Creates the disturbance of a mesh by a seed.
    #[must_use]
    pub(crate) fn new(mesh: &Mesh, seed: u64) -> Disturbance {
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

/// The values of an ensemble, and whether every run has one.
pub(crate) type Sample = (Vec<f64>, bool);

/// Compares two samples; `None` if either is empty. If some runs failed, no verdict is possible: those that are
/// left are not a random choice.
pub(crate) fn compared(first: &Sample, second: &Sample) -> Option<Comparison> {
    let is_known = !first.0.is_empty() && !second.0.is_empty();
    let mut comparison = is_known.then(|| compare(&first.0, &second.0))?;
    if !(first.1 && second.1) {
        comparison.verdict = Verdict::CannotTell;
    }
    Some(comparison)
}

#[cfg(test)]
mod tests;

//! Ensembles: one scene played many times, each time with a tiny disturbance.
//!
//! Tearing is chaotic: a nanometre decides which edge tears first, and two runs soon have little in common.
//! So a single run says nothing about a step or a method, but the distribution over many disturbed runs
//! does. In each member of an ensemble, the free vertices start off by up to [`NOISE_M`] along each axis.
//! Its faces are in another order, if the mesh can be built from its faces. Nothing else differs.
//!
//! Two ensembles are compared by the ratio of their medians, with a 95 % interval by bootstrap (resampling
//! each with replacement): see [`Verdict`].

mod compare;
#[cfg(test)]
mod tests;

pub use self::compare::{Comparison, Verdict, compare, spread};

use std::num::NonZero;
use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};
use tearmesh::{Mesh, Positions, Vector};
use tearmesh_cloth::scene::{Chronicle, Frame, Run, RunError, Scene};

use crate::pool::side_by_side;
use crate::random::Random;

/// The largest random displacement of a free vertex from its starting position along each axis, in metres.
/// Larger displacements spread the results of an ensemble no further.
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
    /// The strength of each vertex, as in [`Run::with_strengths`]; `None` for the strengths of the scene.
    pub strengths: Option<&'a [f64]>,
}

/// All runs of a subject with one step.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Ensemble {
    /// The number by which the step of the scene was divided.
    pub parts: u32,
    /// The divided step, in seconds.
    pub step_s: f64,
    /// The runs, in ascending order of their seeds. Those that failed are included.
    pub members: Vec<Member>,
}

/// One run of an ensemble.
#[derive(Clone, Debug, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MemberStatus {
    /// The run reached its end.
    Done,
    /// The run could not be begun, or a step failed.
    Failed,
    /// The run was interrupted.
    Interrupted,
}

impl MemberStatus {
    /// Returns the name of the status in tables and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            MemberStatus::Done => "done",
            MemberStatus::Failed => "failed",
            MemberStatus::Interrupted => "interrupted",
        }
    }
}

/// The measured quantities of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Observed {
    /// The time of the first tear, in seconds; `None` if nothing tore.
    pub first_tear_s: Option<f64>,
    /// The force at the first tear in newtons, as in [`Chronicle::first_tear`]. `None` if nothing tore, or
    /// if the method does not know its forces, as Provot's does not.
    pub first_force_n: Option<f64>,
    /// The rest length of the edges that tore, in metres.
    pub torn_m: f64,
    /// The number of components of the mesh at the end.
    pub pieces: usize,
    /// The largest force at a hold in newtons, as in [`Chronicle::largest_force_n`]; `None` if unknown.
    pub largest_force_n: Option<f64>,
    /// The work of all holds, led ones included, in joules. `None` if the method does not know its forces:
    /// the work of Provot's limiter grows without bound as steps get shorter.
    pub work_j: Option<f64>,
    /// The cost of the run: the number of visits to single constraints, whatever for.
    pub visits: u64,
}

/// A measured quantity of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The time of the first tear, [`Observed::first_tear_s`]; infinite if nothing tore.
    FirstTear,
    /// The force at the first tear, [`Observed::first_force_n`]; infinite if nothing tore, unless it is
    /// unknown.
    FirstForce,
    /// The torn length, [`Observed::torn_m`].
    Torn,
    /// The number of pieces, [`Observed::pieces`].
    Pieces,
    /// The largest force at a hold, [`Observed::largest_force_n`].
    LargestForce,
    /// The work of all holds, [`Observed::work_j`].
    Work,
}

impl Quantity {
    /// All quantities, in the order of the fields of [`Observed`].
    pub const ALL: [Quantity; 6] = [
        Quantity::FirstTear,
        Quantity::FirstForce,
        Quantity::Torn,
        Quantity::Pieces,
        Quantity::LargestForce,
        Quantity::Work,
    ];

    /// Returns the name of the quantity in words, and its unit; the unit is empty for a number.
    #[must_use]
    pub fn name(self) -> [&'static str; 2] {
        match self {
            Quantity::FirstTear => ["first tear", "s"],
            Quantity::FirstForce => ["force then", "N"],
            Quantity::Torn => ["torn length", "m"],
            Quantity::Pieces => ["pieces", ""],
            Quantity::LargestForce => ["largest force", "N"],
            Quantity::Work => ["work of holds", "J"],
        }
    }

    /// Returns the key of the quantity in reports.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Quantity::FirstTear => "first_tear_s",
            Quantity::FirstForce => "first_force_n",
            Quantity::Torn => "torn_m",
            Quantity::Pieces => "pieces",
            Quantity::LargestForce => "largest_force_n",
            Quantity::Work => "work_j",
        }
    }

    /// What a run had of it. Of what never tore the first tear is infinitely late, at no force that was
    /// reached. `None` where it is not said.
    fn of(self, seen: &Observed) -> Option<f64> {
        match self {
            Quantity::FirstTear => Some(seen.first_tear_s.unwrap_or(f64::INFINITY)),
            Quantity::FirstForce => match seen.first_tear_s {
                Some(_) => seen.first_force_n,
                None => seen.largest_force_n.map(|_| f64::INFINITY),
            },
            Quantity::Torn => Some(seen.torn_m),
            Quantity::Pieces => Some(seen.pieces as f64),
            Quantity::LargestForce => seen.largest_force_n,
            Quantity::Work => seen.work_j,
        }
    }
}

impl Ensemble {
    /// Returns the values of a quantity of all members that have it, and whether every member has it.
    #[must_use]
    pub fn numbers(&self, quantity: Quantity) -> (Vec<f64>, bool) {
        let seen = self.members.iter().filter_map(|member| member.observed);
        let numbers: Vec<f64> = seen.filter_map(|seen| quantity.of(&seen)).collect();
        let is_whole = numbers.len() == self.members.len();
        (numbers, is_whole)
    }
}

/// Plays a subject once for each of `parts` and each of `seeds`.
///
/// The step of the scene is divided by the part. The result has one ensemble per part, in the order of
/// `parts`. At most `threads` runs go on at a time. When `stop` returns true, every run ends before its next
/// step, and those not done are marked as interrupted. `watch` is called after each run with the fraction of
/// all work that is done.
///
/// # Errors
///
/// [`RunError`] if the scene cannot be played.
///
/// # Panics
///
/// If a divided step leads to more than [`Run::STEPS_MAX`] steps.
pub fn play(
    subject: Subject<'_>,
    seeds: RangeInclusive<u64>,
    parts: &[NonZero<u32>],
    threads: NonZero<usize>,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(f64),
) -> Result<Vec<Ensemble>, RunError> {
    let whole = begun(subject, subject.mesh.clone(), NonZero::<u32>::MIN)?;
    let jobs = parts
        .iter()
        .flat_map(|&parts| seeds.clone().map(move |seed| (parts, seed)));
    let jobs: Vec<(NonZero<u32>, u64)> = jobs.collect();
    let cost = |&(parts, _): &(NonZero<u32>, u64)| f64::from(parts.get());
    let all: f64 = jobs.iter().map(cost).sum();
    let mut done = 0.0;
    let members = side_by_side(
        &jobs,
        threads,
        cost,
        |&(parts, seed)| member(subject, parts, seed, stop),
        |i| {
            done += cost(&jobs[i]);
            watch(done / all);
        },
    );
    let mut members = members.into_iter();
    let ensemble = |&parts: &NonZero<u32>| Ensemble {
        parts: parts.get(),
        step_s: whole.step_s() / f64::from(parts.get()),
        members: members.by_ref().take(seeds.clone().count()).collect(),
    };
    Ok(parts.iter().map(ensemble).collect())
}

fn member(subject: Subject<'_>, parts: NonZero<u32>, seed: u64, stop: &dyn Fn() -> bool) -> Member {
    let ended = |status, why: String, observed| Member {
        seed,
        status,
        why,
        observed,
    };
    if stop() {
        return ended(MemberStatus::Interrupted, String::new(), None);
    }
    let mut random = Random(seed);
    let mesh = shuffled(subject.mesh, &mut random);
    let run = begun(subject, mesh, parts).map_err(|error| error.to_string());
    let mut off = || NOISE_M * (2.0 * random.next() - 1.0);
    let run = run.and_then(|run| {
        let displaced = run.displaced(|_| Vector::from_fn(|_, _| off()));
        displaced.map_err(|error| error.to_string())
    });
    let mut run = match run {
        Ok(run) => run,
        Err(why) => return ended(MemberStatus::Failed, why, None),
    };
    let before_m = run.torn_length_m();
    let mut chronicle = Chronicle::new(&run);
    while !run.is_over() {
        if stop() {
            return ended(MemberStatus::Interrupted, String::new(), None);
        }
        match run.step() {
            Ok(step) => chronicle.note(&run, &step),
            Err(error) => return ended(MemberStatus::Failed, error.to_string(), None),
        }
    }
    let first = chronicle.first_tear();
    let largest_force_n = chronicle.largest_force_n();
    let seen = Observed {
        first_tear_s: first.map(|first| first.event.time_s),
        first_force_n: first.and_then(|first| first.force_n),
        torn_m: run.torn_length_m() - before_m,
        pieces: run.mesh().components().count(),
        largest_force_n,
        work_j: largest_force_n.map(|_| run.energy_balance().held_j),
        visits: visits(&run),
    };
    ended(MemberStatus::Done, String::new(), Some(seen))
}

fn visits(run: &Run) -> u64 {
    let visits = run.cloth().system().counters().visits;
    visits.project + visits.force + visits.detect + visits.meter
}

/// A run with the step that the scene has, divided.
fn begun(subject: Subject<'_>, mesh: Mesh, parts: NonZero<u32>) -> Result<Run, RunError> {
    let scene = subject.scene.clone();
    let mut run = Run::new(mesh, subject.positions, scene, subject.frame)?;
    if let Some(strengths) = subject.strengths {
        run = run.with_strengths(strengths.to_vec())?;
    }
    Ok(run.in_smaller_steps(parts))
}

/// The mesh with its faces in another order, each beginning with another corner. A torn mesh, which cannot
/// be built of its faces, stays as it is.
fn shuffled(mesh: &Mesh, random: &mut Random) -> Mesh {
    if mesh.half_edges().any(|h| mesh.ghost_pair(h).is_some()) {
        return mesh.clone();
    }
    let mut faces = mesh.indices().as_chunks::<3>().0.to_vec();
    for i in (1..faces.len()).rev() {
        faces.swap(i, random.below(i + 1));
    }
    faces
        .iter_mut()
        .for_each(|face| face.rotate_left(random.below(3)));
    Mesh::build(mesh.vertex_count(), &faces).unwrap_or_else(|_| mesh.clone())
}

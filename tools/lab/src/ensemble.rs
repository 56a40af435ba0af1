//! Ensembles: a scene played many times, each time disturbed by next to nothing.
//!
//! What tears is chaotic: a nanometre decides which edge goes first, and from there on two runs have
//! little in common. So single runs say nothing of a step or a method; what they have in common over many
//! such disturbances does. Each member of an ensemble begins with its free vertices off by up to
//! [`NOISE_M`] in each direction, and with its faces in another order, as far as the mesh can be built
//! anew; nothing else differs.
//!
//! Two ensembles are compared by the ratio of their medians, with an interval of 95 % by bootstrap
//! (resampling each with replacement): see [`Verdict`].

mod compare;
#[cfg(test)]
mod tests;

pub use self::compare::{Comparison, Verdict, compare, spread};

use std::num::NonZero;
use std::ops::RangeInclusive;

use serde::Serialize;
use tearmesh::{Mesh, Positions, Vector};
use tearmesh_cloth::scene::{Chronicle, Frame, Run, RunError, Scene};

use crate::pool::side_by_side;
use crate::random::Random;

/// How far a vertex is off at most in each direction, in metres. Larger noise gives the same spread.
pub const NOISE_M: f64 = 1e-9;

/// What is played.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The cloth at rest.
    pub mesh: &'a Mesh,
    /// Where its vertices are.
    pub positions: &'a Positions,
    /// The frame that the scene was made for.
    pub frame: &'a Frame,
    /// The scene.
    pub scene: &'a Scene,
    /// The strengths of vertices, where they are not the scene's.
    pub strengths: Option<&'a [f64]>,
}

/// All that was played with one step.
#[derive(Clone, Debug, Serialize)]
pub struct Ensemble {
    /// Into how many the step of the scene was divided.
    pub parts: u32,
    /// The step, in seconds.
    pub step_s: f64,
    /// By seed.
    pub members: Vec<Member>,
}

/// One run of an ensemble: never a gap where it failed.
#[derive(Clone, Debug, Serialize)]
pub struct Member {
    /// What its noise begins with.
    pub seed: u64,
    /// `done`, `failed` or `interrupted`.
    pub status: &'static str,
    /// Why it failed; empty if it did not.
    pub why: String,
    /// What was seen of it; `None` where it was not played to its end.
    pub observed: Option<Observed>,
}

/// What is seen of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Observed {
    /// When something tore first, in seconds; `None` if nothing did.
    pub first_tear_s: Option<f64>,
    /// The force then in newtons, as [`Chronicle::first_tear`] says; `None` if there was none, or forces
    /// are not known, as by Provot's method.
    pub first_force_n: Option<f64>,
    /// The rest length of the edges that came apart, in metres.
    pub torn_m: f64,
    /// The pieces at the end.
    pub pieces: usize,
    /// The largest force at a hold, in newtons, as [`Chronicle::largest_force_n`] says.
    pub largest_force_n: Option<f64>,
    /// The work of those who hold and lead, in joules; `None` where forces are not known: Provot's limiter
    /// works without bound as steps get shorter.
    pub work_j: Option<f64>,
}

/// A number that is seen of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// [`Observed::first_tear_s`].
    FirstTear,
    /// [`Observed::first_force_n`].
    FirstForce,
    /// [`Observed::torn_m`].
    Torn,
    /// [`Observed::pieces`].
    Pieces,
    /// [`Observed::largest_force_n`].
    LargestForce,
    /// [`Observed::work_j`].
    Work,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Quantity; 6] = [
        Quantity::FirstTear,
        Quantity::FirstForce,
        Quantity::Torn,
        Quantity::Pieces,
        Quantity::LargestForce,
        Quantity::Work,
    ];

    /// Its name in words, and its unit.
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

    /// Its key in reports.
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
    /// A number of all members that have it, and whether those are all.
    #[must_use]
    pub fn numbers(&self, quantity: Quantity) -> (Vec<f64>, bool) {
        let seen = self.members.iter().filter_map(|member| member.observed);
        let numbers: Vec<f64> = seen.filter_map(|seen| quantity.of(&seen)).collect();
        let is_whole = numbers.len() == self.members.len();
        (numbers, is_whole)
    }
}

/// Plays a subject with these seeds for each of these parts of its step, on so many threads at a time.
/// All ends at the next step where `stop` says so, and what was not done stands as interrupted. `watch`
/// hears the part of all work that has been done.
///
/// # Errors
///
/// [`RunError`]: what is wrong with the scene.
///
/// # Panics
///
/// If a divided step would make more steps than [`Run::STEPS_MAX`].
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
            true
        },
    );
    let mut members = members.expect("nobody stops the list itself").into_iter();
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
        Err(why) => return ended("failed", why, None),
    };
    let before_m = run.torn_length_m();
    let mut chronicle = Chronicle::new(&run);
    while !run.is_over() {
        if stop() {
            return ended("interrupted", String::new(), None);
        }
        match run.step() {
            Ok(step) => chronicle.note(&run, &step),
            Err(error) => return ended("failed", error.to_string(), None),
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
    };
    ended("done", String::new(), Some(seen))
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

//! Tearing after the first tear: ensembles by every method, at its step and at a half and a quarter of it.
//!
//! A cascade is chaotic, and two single runs of one scene differ by a fifth in half of all pairs. So every
//! method plays each scene with many seeds ([`ensemble`]). The results are medians with the 10 % and 90 %
//! points, and whether medians differ.
//!
//! A method has *converged* in a number if its ensembles at half and at a quarter of its step have the same
//! median. If the finest ensembles of two methods that converged have the same median, they are the reference
//! with which all methods are compared. If no two of them agree, there is no reference.

mod csv;
mod finer;
mod svg;
#[cfg(test)]
mod tests;
mod words;

pub use self::csv::csv;
pub use self::finer::{Finer, Move, finer};
pub use self::words::summary;

pub(super) use self::svg::{draw, height};

use std::num::NonZero;

use serde::{Deserialize, Serialize};
use tearmesh::{Mesh, Positions, shapes};
use tearmesh_cloth::Tearing;
use tearmesh_cloth::scene::ensemble::{
    self, Ensemble, Job, Member, MemberStatus, Quantity, Subject,
};
use tearmesh_cloth::scene::{Axis, Frame, RunError, Scene};
use tearmesh_cloth::statistics::{Comparison, Verdict, compare, spread};

use super::strip::{TIP, strip};
use crate::pareto::Named;
use crate::parts::Missing;
use crate::pool::side_by_side;

/// The scenes in which cascades are played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CascadeScene {
    /// The trouser test of a strip, with tips of half the strength.
    Trouser,
    /// A patch that a hand rips in its middle.
    Rip,
}

impl CascadeScene {
    /// All scenes.
    pub const ALL: [CascadeScene; 2] = [CascadeScene::Trouser, CascadeScene::Rip];

    /// Returns the name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            CascadeScene::Trouser => "trouser",
            CascadeScene::Rip => "rip",
        }
    }

    /// Returns the default number of cells across.
    #[must_use]
    pub fn cells(self) -> u32 {
        match self {
            CascadeScene::Trouser => 16,
            CascadeScene::Rip => 32,
        }
    }

    /// A strip or a patch of so many cells.
    fn mesh(self, cells: u32) -> Option<(Mesh, Positions)> {
        match self {
            CascadeScene::Trouser => strip(cells),
            CascadeScene::Rip => Some(shapes::grid_with_diagonals(cells, cells, |i, j| {
                (i + j) % 2 == 0
            })),
        }
    }

    fn scene(self, frame: &Frame) -> Scene {
        match self {
            CascadeScene::Rip => Scene::rip(frame),
            CascadeScene::Trouser => {
                let scene = Scene::trouser(frame);
                let weakening = Some(TIP);
                let weak = |tearing: Tearing| Tearing {
                    weakening,
                    ..tearing
                };
                Scene {
                    tearing: scene.tearing.map(weak),
                    ..scene
                }
            }
        }
    }
}

/// The names of the methods, as in [`Named::all`].
pub const METHODS: [&str; 5] = ["verlet", "xpbd", "implicit", "pbd", "provot"];

/// The quantities that are reported. The first tear is reported for single runs only.
pub const TOLD: [Quantity; 4] = [
    Quantity::Torn,
    Quantity::Pieces,
    Quantity::Work,
    Quantity::LargestForce,
];

/// The options of the experiment on cascades.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes to play.
    pub scenes: Vec<CascadeScene>,
    /// The numbers of cells across, none of them 0, in ascending order; empty for the default of each scene.
    pub cells: Vec<u32>,
    /// The names of the methods to play, from [`METHODS`]. Other names are ignored.
    pub methods: Vec<String>,
    /// The number of seeds of each ensemble.
    pub seeds: u64,
    /// The number of runs to execute at a time.
    pub threads: NonZero<usize>,
}

impl Options {
    /// Returns the numbers of cells across with which a scene is played.
    #[must_use]
    pub fn sizes(&self, scene: CascadeScene) -> Vec<u32> {
        match self.cells.is_empty() {
            true => vec![scene.cells()],
            false => self.cells.clone(),
        }
    }

    /// Returns whether a method is one of those to play.
    #[must_use]
    pub fn plays(&self, method: &str) -> bool {
        self.methods.iter().any(|name| name == method)
    }
}

/// The default number of seeds of an ensemble.
pub const SEEDS: u64 = 16;

/// A step's parts.
const PARTS: [NonZero<u32>; 3] = [
    NonZero::<u32>::MIN,
    NonZero::<u32>::MIN.saturating_add(1),
    NonZero::<u32>::MIN.saturating_add(3),
];

/// The results of one scene by one method.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Cascade {
    /// The name of the scene.
    pub scene: String,
    /// The number of cells across.
    pub cells: u32,
    /// The name of the method.
    pub method: String,
    /// The results for each quantity, in the order of [`TOLD`]. They follow from the ensembles of all methods,
    /// so they are computed, not read.
    #[serde(skip_deserializing)]
    pub numbers: Vec<Number>,
    /// The ensembles at the step, at half of it and at a quarter of it.
    pub ensembles: Vec<Ensemble>,
}

impl Cascade {
    /// Returns the name of the scene, and the number of cells across.
    #[must_use]
    pub fn mesh(&self) -> (&str, u32) {
        (&self.scene, self.cells)
    }
}

/// The results of a cascade for one quantity.
#[derive(Clone, Debug, Serialize)]
pub struct Number {
    /// The key of the quantity, as in [`Quantity::key`].
    pub name: &'static str,
    /// The 10 %, 50 % and 90 % points of each ensemble; `None` if no run has a value.
    pub spreads: Vec<Option<[f64; 3]>>,
    /// The comparisons of the step with half of it, and of half with a quarter; `None` without values.
    pub halvings: Vec<Option<Comparison>>,
    /// The names of the two methods whose finest ensembles are the reference; empty if no two methods that
    /// converged agree.
    pub reference: Vec<String>,
    /// The comparison of the reference with the ensemble at the step. In its ratio, the median of the
    /// ensemble is the numerator. `None` if there is no reference or no value.
    pub against_reference: Option<Comparison>,
}

impl Number {
    /// Returns the verdict on whether halving the step changes the median; `None` if either ensemble has no
    /// value.
    #[must_use]
    pub fn verdict(&self) -> Option<Verdict> {
        Some((*self.halvings.first()?)?.verdict)
    }

    /// Returns whether halving the step once more leaves the median of the finest ensembles the same.
    #[must_use]
    pub fn has_converged(&self) -> bool {
        let last = self.halvings.last().copied().flatten();
        last.is_some_and(|found| found.verdict == Verdict::Same)
    }
}

/// Returns the name of the ensembles of a scene on a mesh by a method in lists of missing parts and in the
/// names of files, such as `rip-32-verlet`.
#[must_use]
pub fn part_name(scene: CascadeScene, cells: u32, method: &str) -> String {
    format!("{}-{cells}-{method}", scene.name())
}

/// Plays all scenes by all methods. The results are ordered by scene and then by method, as in [`METHODS`].
///
/// `watch` is called with the name of the current scene and method, and the fraction of all work that is
/// done. When `stop` returns true, all runs end as soon as possible and are marked as interrupted. Ensembles
/// with such runs are among the missing parts. Those without any finished run are not among the results.
///
/// # Errors
///
/// [`RunError`] if a scene cannot be played, which would be a bug.
pub fn play(
    options: &Options,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(&str, f64),
) -> Result<(Vec<Cascade>, Vec<Missing>), RunError> {
    let (mut cascades, mut missing) = (Vec::new(), Vec::new());
    let scenes = options.scenes.iter();
    let meshes =
        scenes.flat_map(|&scene| options.sizes(scene).into_iter().map(move |n| (scene, n)));
    let meshes: Vec<(CascadeScene, u32)> = meshes.collect();
    let all = meshes.len() * options.methods.len();
    for (scene, cells) in meshes {
        for named in methods(options) {
            let part = part_name(scene, cells, named.name);
            if stop() {
                missing.push(Missing::interrupted(part));
                continue;
            }
            let begun = cascades.len();
            let name = format!("{} of {cells} cells by {}", scene.name(), named.name);
            let watch = |part: f64| watch(&name, (begun as f64 + part) / all as f64);
            let ensembles = ensembles(scene, cells, &named, options, stop, watch)?;
            let members = ensembles.iter().flat_map(|ensemble| &ensemble.members);
            let runs = members.clone().count();
            let is_done = |member: &&Member| member.status != MemberStatus::Interrupted;
            let done = members.filter(is_done).count();
            if done < runs {
                let why = format!("interrupted after {done} of {runs} runs");
                missing.push(Missing { part, why });
            }
            if done > 0 {
                cascades.push(Cascade {
                    scene: scene.name().to_owned(),
                    cells,
                    method: named.name.to_owned(),
                    numbers: Vec::new(),
                    ensembles,
                });
            }
        }
    }
    conclude(&mut cascades);
    Ok((cascades, missing))
}

/// Computes what follows from the ensembles of all methods. Those of a scene on a mesh must be next to each
/// other.
pub(super) fn conclude(cascades: &mut [Cascade]) {
    for cascade in &mut *cascades {
        let of = |quantity| number(&cascade.ensembles, quantity);
        cascade.numbers = TOLD.map(of).to_vec();
    }
    for of_mesh in cascades.chunk_by_mut(|one, next| one.mesh() == next.mesh()) {
        refer(of_mesh);
    }
}

fn methods(options: &Options) -> Vec<Named> {
    let all = Named::all().into_iter();
    all.filter(|named| options.plays(named.name)).collect()
}

/// Returns the number of runs of the experiment.
#[must_use]
pub fn runs(options: &Options) -> u64 {
    let each = options.seeds * PARTS.len() as u64;
    let meshes: usize = options
        .scenes
        .iter()
        .map(|&scene| options.sizes(scene).len())
        .sum();
    (meshes * options.methods.len()) as u64 * each
}

fn ensembles(
    scene: CascadeScene,
    cells: u32,
    named: &Named,
    options: &Options,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(f64),
) -> Result<Vec<Ensemble>, RunError> {
    let (mesh, positions) = scene.mesh(cells).expect("a strip of our own is a mesh");
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let scene = Scene {
        solver: named.settings(),
        ..scene.scene(&frame)
    };
    let subject = Subject {
        mesh: &mesh,
        positions: &positions,
        frame: &frame,
        scene: &scene,
        strengths: None,
    };
    let seeds = 1..=options.seeds;
    ensemble::play(subject, seeds, &PARTS, stop, |jobs, member| {
        let whole: f64 = jobs.iter().map(Job::cost).sum();
        let mut done = 0.0;
        side_by_side(jobs, options.threads, Job::cost, member, |i| {
            done += jobs[i].cost();
            watch(done / whole);
        })
    })
}

/// A number of some ensembles, from coarse to fine, without a reference. Where some runs of an ensemble
/// failed nobody can tell, as those that are left are not drawn at random.
fn number(ensembles: &[Ensemble], quantity: Quantity) -> Number {
    let samples: Vec<(Vec<f64>, bool)> =
        ensembles.iter().map(|one| one.numbers(quantity)).collect();
    let halvings = samples.windows(2);
    Number {
        name: quantity.key(),
        spreads: samples
            .iter()
            .map(|(sample, _)| (!sample.is_empty()).then(|| spread(sample)))
            .collect(),
        halvings: halvings.map(|pair| compared(&pair[0], &pair[1])).collect(),
        reference: Vec::new(),
        against_reference: None,
    }
}

fn compared(first: &(Vec<f64>, bool), second: &(Vec<f64>, bool)) -> Option<Comparison> {
    if first.0.is_empty() || second.0.is_empty() {
        return None;
    }
    let mut comparison = compare(&first.0, &second.0);
    if !(first.1 && second.1) {
        comparison.verdict = Verdict::CannotTell;
    }
    Some(comparison)
}

/// Finds the references of a scene, and compares all methods with them. Two methods that agree and have both
/// converged are one; of several pairs the one whose medians are nearest to each other. Two that still change
/// with their step agree by chance.
fn refer(cascades: &mut [Cascade]) {
    for (place, quantity) in TOLD.into_iter().enumerate() {
        let finest = |cascade: &Cascade| {
            let last = cascade.ensembles.last()?;
            let has_converged = cascade.numbers[place].has_converged();
            has_converged.then(|| last.numbers(quantity))
        };
        let finest: Vec<(Vec<f64>, bool)> = cascades
            .iter()
            .map(|cascade| finest(cascade).unwrap_or((Vec::new(), false)))
            .collect();
        let mut best: Option<(f64, [usize; 2])> = None;
        for i in 0..finest.len() {
            for j in i + 1..finest.len() {
                let Some(found) = compared(&finest[i], &finest[j]) else {
                    continue;
                };
                let apart = found.ratio.ln().abs();
                let is_nearer = best.is_none_or(|(least, _)| apart < least);
                if found.verdict == Verdict::Same && is_nearer {
                    best = Some((apart, [i, j]));
                }
            }
        }
        let Some((_, pair)) = best else {
            continue;
        };
        let sample = pair.iter().flat_map(|&i| finest[i].0.clone()).collect();
        let sample = (sample, true);
        let names = pair.map(|i| cascades[i].method.clone());
        for cascade in &mut *cascades {
            let own = cascade.ensembles.first().map(|one| one.numbers(quantity));
            let number = &mut cascade.numbers[place];
            number.reference = names.to_vec();
            number.against_reference = own.and_then(|own| compared(&sample, &own));
        }
    }
}

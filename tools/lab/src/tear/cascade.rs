//! What tears after the first tear: ensembles by every method, at its step and at a half and a quarter of it.
//!
//! A cascade is chaotic, and two single runs of one scene differ by a fifth in half of all pairs. So
//! every method plays each scene with many seeds ([`ensemble`]), and what is told are medians with the 10 and
//! 90 % points, and whether medians differ. Where nobody can tell, four times as many seeds are played, once.
//! A method has *converged* in a number where its step and half of it have the same. Where the
//! finest ensembles of two methods have the same, theirs are the reference, and the others are compared with
//! it; where those of no two have, there is none, and nobody is right or wrong.

mod csv;
mod svg;
#[cfg(test)]
mod tests;
mod words;

pub use self::csv::csv;
pub use self::words::summary;

pub(super) use self::svg::{draw, height};

use std::num::NonZero;

use serde::Serialize;
use tearmesh::{Mesh, Positions, shapes};
use tearmesh_cloth::Tearing;
use tearmesh_cloth::scene::{Axis, Frame, RunError, Scene};

use super::strip::{TIP, strip};
use crate::ensemble::{self, Comparison, Ensemble, Quantity, Subject, Verdict};
use crate::pareto::Named;

/// A scene in which something tears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CascadeScene {
    /// The trouser test of a strip, with tips of half the strength.
    Trouser,
    /// A patch that is ripped by a hand in its middle.
    Rip,
}

impl CascadeScene {
    /// Both.
    pub const ALL: [CascadeScene; 2] = [CascadeScene::Trouser, CascadeScene::Rip];

    /// As it is typed.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            CascadeScene::Trouser => "trouser",
            CascadeScene::Rip => "rip",
        }
    }

    /// Cells across, unless one says otherwise.
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

/// The methods that are played, by their names among [`Named::all`].
pub const METHODS: [&str; 5] = ["verlet", "xpbd", "implicit", "pbd", "provot"];

/// What is told; what tore first is told of single runs.
pub const TOLD: [Quantity; 4] = [
    Quantity::Torn,
    Quantity::Pieces,
    Quantity::Work,
    Quantity::LargestForce,
];

/// What to play, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes.
    pub scenes: Vec<CascadeScene>,
    /// Cells across; of each scene its own where there is none.
    pub cells: Option<u32>,
    /// Names of [`METHODS`].
    pub methods: Vec<String>,
    /// How many seeds.
    pub seeds: u64,
    /// How many runs go on at a time.
    pub threads: NonZero<usize>,
}

/// The seeds of an ensemble, unless one says otherwise.
pub const SEEDS: u64 = 16;

/// So many times as many are played where nobody can tell.
pub const MORE: u64 = 4;

/// A step's parts.
const PARTS: [NonZero<u32>; 3] = [
    NonZero::<u32>::MIN,
    NonZero::<u32>::MIN.saturating_add(1),
    NonZero::<u32>::MIN.saturating_add(3),
];

/// A scene by a method.
#[derive(Clone, Debug, Serialize)]
pub struct Cascade {
    /// The scene.
    pub scene: &'static str,
    /// Cells across.
    pub cells: u32,
    /// The method.
    pub method: &'static str,
    /// What came of each of [`TOLD`].
    pub numbers: Vec<Number>,
    /// At the step, and a half and a quarter of it.
    pub ensembles: Vec<Ensemble>,
}

/// A number of a cascade.
#[derive(Clone, Debug, Serialize)]
pub struct Number {
    /// Which, as [`Quantity::key`] has it.
    pub name: &'static str,
    /// The 10, 50 and 90 % points by ensemble; `None` where nobody says it.
    pub spreads: Vec<Option<[f64; 3]>>,
    /// The step compared with half of it, and that with a quarter.
    pub halvings: Vec<Option<Comparison>>,
    /// The methods whose finest ensembles are the reference, this one among them or not; empty where
    /// there is none.
    pub reference: Vec<&'static str>,
    /// The ensemble at the step compared with the reference; `None` where there is none.
    pub against_reference: Option<Comparison>,
}

impl Number {
    /// Whether the step and half of it have the same; `None` where that is not known.
    #[must_use]
    pub fn verdict(&self) -> Option<Verdict> {
        Some((*self.halvings.first()?)?.verdict)
    }
}

/// Plays all of it. `watch` hears of what is being played, with the part of all work that has been done.
/// `None` where `stop` says so: all ends at once.
///
/// # Errors
///
/// [`RunError`]: a scene that cannot be played, which would be our bug.
pub fn play(
    options: &Options,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(&str, f64),
) -> Result<Option<Vec<Cascade>>, RunError> {
    let mut cascades = Vec::new();
    let all = options.scenes.len() * options.methods.len();
    for &scene in &options.scenes {
        let cells = options.cells.unwrap_or(scene.cells());
        let mut of_scene = Vec::new();
        for named in methods(options) {
            let begun = cascades.len() + of_scene.len();
            let name = format!("{} by {}", scene.name(), named.name);
            let watch = |part: f64| watch(&name, (begun as f64 + part) / all as f64);
            let ensembles = ensembles(scene, cells, &named, options, stop, watch)?;
            if stop() {
                return Ok(None);
            }
            of_scene.push(Cascade {
                scene: scene.name(),
                cells,
                method: named.name,
                numbers: TOLD.map(|quantity| number(&ensembles, quantity)).to_vec(),
                ensembles,
            });
        }
        refer(&mut of_scene);
        cascades.extend(of_scene);
    }
    Ok(Some(cascades))
}

fn methods(options: &Options) -> Vec<Named> {
    let is_wanted = |named: &Named| options.methods.iter().any(|name| name == named.name);
    Named::all().into_iter().filter(is_wanted).collect()
}

/// How many runs that will be at least.
#[must_use]
pub fn runs(options: &Options) -> u64 {
    let each = options.seeds * PARTS.len() as u64;
    (options.scenes.len() * options.methods.len()) as u64 * each
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
    let mut play =
        |seeds| ensemble::play(subject, seeds, &PARTS, options.threads, stop, &mut watch);
    let mut ensembles = play(1..=options.seeds)?;
    let is_open = |quantity| {
        let verdict = number(&ensembles, quantity).verdict();
        verdict == Some(Verdict::CannotTell)
    };
    if !stop() && TOLD.into_iter().any(is_open) {
        let more = play(options.seeds + 1..=MORE * options.seeds)?;
        for (ensemble, more) in ensembles.iter_mut().zip(more) {
            ensemble.members.extend(more.members);
        }
    }
    Ok(ensembles)
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
            .map(|(sample, _)| (!sample.is_empty()).then(|| ensemble::spread(sample)))
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
    let mut comparison = ensemble::compare(&first.0, &second.0);
    if !(first.1 && second.1) {
        comparison.verdict = Verdict::CannotTell;
    }
    Some(comparison)
}

/// Finds the references of a scene, and compares all methods with them. Two methods that agree are one; of
/// several pairs the one whose medians are nearest to each other.
fn refer(cascades: &mut [Cascade]) {
    for (place, quantity) in TOLD.into_iter().enumerate() {
        let finest: Vec<(Vec<f64>, bool)> = cascades
            .iter()
            .map(|cascade| cascade.ensembles.last().map(|one| one.numbers(quantity)))
            .map(|sample| sample.unwrap_or((Vec::new(), false)))
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
        let names = pair.map(|i| cascades[i].method);
        for cascade in &mut *cascades {
            let own = cascade.ensembles.first().map(|one| one.numbers(quantity));
            let number = &mut cascade.numbers[place];
            number.reference = names.to_vec();
            number.against_reference = own.and_then(|own| compared(&sample, &own));
        }
    }
}

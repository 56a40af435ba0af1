//! Tearing: the forces that tear strips, by two rules and on meshes of several sizes, and what follows after the
//! first tear.
//!
//! Strips are torn in a trouser test ([`Scene::trouser`]): a strip is slit to its middle, and its two legs are
//! pulled apart. The paper's rule tears an edge at a stretch ratio (Souza et al. 2014 §III-A), whatever its length.
//! So the force at which an edge tears is proportional to that length, and a cloth on a mesh twice as fine is half
//! as strong. A threshold of toughness, an energy per metre of tear, does not have that fault. Both rules are set
//! to agree on the middle mesh. In a laboratory the tear runs from the slit. To get that here, tips are half as
//! strong ([`Tearing::weakening`]).
//!
//! After the first tear a scene is chaotic, and two single runs of it differ by a fifth in half of all pairs. So
//! every method plays it with many seeds (an ensemble), at its step and at a half and a quarter of it. A method
//! has *converged* in a quantity if its ensembles at half and at a quarter of its step have the same median. If
//! the finest ensembles of two methods that converged have the same median, they are the reference with which all
//! methods are compared. If no two of them agree, there is no reference.

mod chart;

use std::num::NonZero;

use serde::{Deserialize, Serialize};
use tearmesh_cloth::scene::{Axis, Frame, Scene};
use tearmesh_cloth::{Fabric, Tearing, Threshold};

use crate::ensemble::{self, Subject};
use crate::experiment::{Bounds, Experiment, Status};
use crate::method::{DEFAULT, DEFAULTS, Method};
use crate::sheet::grid;

/// The experiment on tearing, and its options.
#[derive(Clone, Debug)]
pub struct Tear {
    /// The numbers of cells across the strips, none or at least two, all of them even: the slit runs along edges.
    pub strips: Vec<u32>,
    /// The scenes that are played with many seeds.
    pub scenes: Vec<EnsembleScene>,
    /// The numbers of cells across of those scenes; empty for the default of each.
    pub cells: Vec<u32>,
    /// The names of the methods that play them, of [`default_names`](crate::default_names).
    pub methods: Vec<String>,
    /// The number of seeds of each ensemble.
    pub seeds: u64,
}

/// The default numbers of cells across the strips.
pub const CELLS: [u32; 5] = [8, 12, 16, 24, 32];

/// The default number of seeds of an ensemble.
pub const SEEDS: u64 = 16;

/// The numbers by which the steps of ensembles are divided.
const STEP_DIVISORS: [u32; 3] = [1, 2, 4];

/// The width and the height of the strip, in metres.
pub(crate) const STRIP_M: [f64; 2] = [0.1, 0.2];

/// The factor on the strength of the tips of a tear in a strip, as in [`Tearing::weakening`].
const TIP: f64 = 0.5;

/// The scenes that are played with many seeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EnsembleScene {
    /// The trouser test of a strip, with tips of half the strength.
    #[default]
    Trouser,
    /// A patch that a hand rips in its middle.
    Rip,
}

impl EnsembleScene {
    /// All scenes.
    pub const ALL: [EnsembleScene; 2] = [EnsembleScene::Trouser, EnsembleScene::Rip];

    /// The name on the command line, the default number of cells across, and the CPU time of a run with those in
    /// seconds, on the machine on which charts were first made.
    fn defaults(self) -> (&'static str, u32, f64) {
        match self {
            EnsembleScene::Trouser => ("trouser", 16, 7.0),
            EnsembleScene::Rip => ("rip", 32, 2.0),
        }
    }

    /// Returns the name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.defaults().0
    }
}

/// The rules by which the edges of a strip tear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Rule {
    /// The ratio of length to rest length.
    Stretch,
    /// The energy per length of tear.
    Toughness,
}

/// A run: of a strip if it has a rule, and else of an ensemble. Without results it is the key of the run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    /// The scene; the trouser test for strips.
    pub(crate) scene: EnsembleScene,
    /// The number of cells across.
    pub(crate) cells: u32,
    /// The way in which the run ended.
    pub(crate) status: Status,
    /// The rule by which a strip tears.
    pub(crate) rule: Option<Rule>,
    /// The threshold of the rule: a stretch ratio, or a toughness in J/m.
    pub(crate) threshold: Option<f64>,
    /// The method.
    pub(crate) method: String,
    /// The number by which the step was divided.
    pub(crate) step_divisor: u32,
    /// The seed.
    pub(crate) seed: u64,
    /// The rest length of the edges that tore, in metres.
    pub(crate) torn_m: Option<f64>,
    /// The number of components of the mesh at the end.
    pub(crate) pieces: Option<usize>,
    /// The largest force at a hold in newtons, as a mean over 1/60 s.
    pub(crate) largest_force_n: Option<f64>,
    /// The work of all holds, in joules.
    pub(crate) work_j: Option<f64>,
    /// The reason of a failure.
    pub(crate) why: String,
}

impl Tear {
    /// The keys of strips, whose rules agree on the middle mesh.
    fn strips(&self) -> Vec<Row> {
        let middle = self.strips.get(self.strips.len() / 2);
        let edge_m = STRIP_M[0] / middle.map_or(1.0, |&cells| f64::from(cells));
        let strain = Scene::STRETCH_RATIO - 1.0;
        // ½ k ε² h: the energy of an edge at the ratio.
        let toughness = 0.5 * Fabric::default().stretch_n_per_m() * strain * strain * edge_m;
        let stretch = (Rule::Stretch, Scene::STRETCH_RATIO);
        let rules = [stretch, (Rule::Toughness, toughness)].into_iter();
        let keys = rules.flat_map(|(rule, threshold)| {
            self.strips.iter().map(move |&cells| Row {
                cells,
                rule: Some(rule),
                threshold: Some(threshold),
                method: DEFAULT.to_owned(),
                step_divisor: 1,
                seed: 1,
                ..Row::default()
            })
        });
        keys.collect()
    }

    /// The keys of the ensembles of a scene on a mesh.
    fn runs(&self, scene: EnsembleScene, cells: u32) -> Vec<Row> {
        let mut keys = Vec::new();
        let is_wanted = |method: &Method| self.methods.iter().any(|name| name == method.name);
        for method in DEFAULTS.iter().filter(|method| is_wanted(method)) {
            for step_divisor in STEP_DIVISORS {
                keys.extend((1..=self.seeds).map(|seed| Row {
                    scene,
                    cells,
                    method: method.name.to_owned(),
                    step_divisor,
                    seed,
                    ..Row::default()
                }));
            }
        }
        keys
    }
}

impl Experiment for Tear {
    type Row = Row;

    fn plan(&self) -> Vec<Vec<Row>> {
        let mut plan = vec![self.strips()];
        for &scene in &self.scenes {
            let sizes = match &self.cells[..] {
                [] => &[scene.defaults().1],
                sizes => sizes,
            };
            plan.extend(sizes.iter().map(|&cells| self.runs(scene, cells)));
        }
        plan.retain(|keys| !keys.is_empty());
        plan
    }

    /// A mesh twice as fine has four times as many edges, and steps that are half as long if the method is explicit.
    fn guess_s(&self, key: &Row) -> f64 {
        let (_, cells, at_default_s) = key.scene.defaults();
        let finer = f64::from(key.cells) / f64::from(cells);
        at_default_s * finer.powf(2.5) * f64::from(key.step_divisor)
    }

    fn run(&self, key: &Row, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        let (rows, size_m, weakening, ready): (_, _, _, fn(&Frame) -> Scene) = match key.scene {
            EnsembleScene::Trouser => (2 * key.cells, STRIP_M, Some(TIP), Scene::trouser),
            EnsembleScene::Rip => (key.cells, [1.0; 2], None, Scene::rip),
        };
        let (mesh, positions) = grid([key.cells, rows], size_m, |i, j| (i + j) % 2 == 0);
        let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
        let threshold = match (key.rule, key.threshold) {
            (Some(Rule::Toughness), Some(toughness)) => Threshold::Toughness(toughness),
            (_, ratio) => Threshold::Stretch(ratio.unwrap_or(Scene::STRETCH_RATIO)),
        };
        let mut tearing = Tearing::new(threshold);
        tearing.weakening = weakening;
        let mut scene = ready(&frame);
        scene.solver = Method::named(&key.method)?.settings()?;
        scene.tearing = Some(tearing);
        let subject = Subject {
            mesh: &mesh,
            positions: &positions,
            frame: &frame,
            scene: &scene,
        };
        let step_divisor = NonZero::new(key.step_divisor)?;
        let observed = ensemble::observe(subject, step_divisor, key.seed, bounds.stop)?;
        let why = observed.as_ref().err().cloned().unwrap_or_default();
        let observed = observed.ok();
        Some(vec![Row {
            status: observed.map_or(Status::Failed, |_| Status::Ok),
            torn_m: observed.map(|one| one.torn_m),
            pieces: observed.map(|one| one.pieces),
            largest_force_n: observed.and_then(|one| one.largest_force_n),
            work_j: observed.and_then(|one| one.work_j),
            why,
            ..key.clone()
        }])
    }
}

#[cfg(test)]
mod tests;

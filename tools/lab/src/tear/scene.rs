//! The scenes that are torn, and the pull of a strip.

use serde::{Deserialize, Serialize};
use tearmesh::{Mesh, Point, Positions, shapes};
use tearmesh_cloth::scene::{Axis, FRAME_S, Frame, Method, Run, Scene};
use tearmesh_cloth::{Tearing, Threshold, force};

use crate::experiment::Status;

/// The width and the height of the strip, in metres.
pub(crate) const STRIP_M: [f64; 2] = [0.1, 0.2];

/// The factor on the strength of the tips of a tear in a strip, as in [`Tearing::weakening`].
const TIP: f64 = 0.5;

/// The number of points of the curve of a strip, each a mean over 1/60 s.
const SAMPLES: usize = 240;

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

    /// Returns the name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            EnsembleScene::Trouser => "trouser",
            EnsembleScene::Rip => "rip",
        }
    }

    /// Returns the default number of cells across.
    #[must_use]
    pub fn cells(self) -> u32 {
        match self {
            EnsembleScene::Trouser => 16,
            EnsembleScene::Rip => 32,
        }
    }
}

/// A grid of square cells, whose diagonals rise where `rising(column, row)` returns true.
pub(crate) fn grid(
    cells: [u32; 2],
    [width_m, height_m]: [f64; 2],
    rising: impl FnMut(u32, u32) -> bool,
) -> (Mesh, Positions) {
    let (mesh, unit) = shapes::grid_with_diagonals(cells[0], cells[1], rising);
    let points = unit.as_slice().iter();
    let points = points.map(|p| Point::new(width_m * p.x, height_m * p.y, 0.0));
    let positions = Positions::new(points).expect("a sheet's coordinates are finite");
    (mesh, positions)
}

/// A scene on a mesh with alternating diagonals.
pub(super) struct Stage {
    pub(super) mesh: Mesh,
    pub(super) positions: Positions,
    pub(super) frame: Frame,
    pub(super) scene: Scene,
}

impl Stage {
    /// Sets a scene with so many cells across.
    pub(super) fn new(scene: EnsembleScene, cells: u32, threshold: Threshold) -> Stage {
        let (rows, size_m, weakening) = match scene {
            EnsembleScene::Trouser => (2 * cells, STRIP_M, Some(TIP)),
            EnsembleScene::Rip => (cells, [1.0; 2], None),
        };
        let (mesh, positions) = grid([cells, rows], size_m, |i, j| (i + j) % 2 == 0);
        let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
        let ready = match scene {
            EnsembleScene::Trouser => Scene::trouser(&frame),
            EnsembleScene::Rip => Scene::rip(&frame),
        };
        let tearing = Some(Tearing {
            weakening,
            ..Tearing::new(threshold)
        });
        Stage {
            mesh,
            positions,
            frame,
            scene: Scene { tearing, ..ready },
        }
    }

    /// Pulls the legs of a strip apart, to the first tear or to the end. Without a step the run chooses its own.
    /// Returns [`Status::Interrupted`] if `stop` returns true, and else the reason of a failure.
    pub(super) fn pull(
        &self,
        solver: Method,
        step_s: Option<f64>,
        is_whole: bool,
        stop: &dyn Fn() -> bool,
    ) -> Result<Pull, (Status, String)> {
        let scene = Scene {
            solver,
            step_s,
            ..self.scene.clone()
        };
        let run = Run::new(self.mesh.clone(), &self.positions, scene, &self.frame);
        let mut run = run.expect("the trouser scene fits a strip");
        let depth = self.frame.depth.vector();
        let mut pull = Pull {
            step_s: run.step_s(),
            clamps: Vec::new(),
            torn: None,
        };
        while !run.is_over() && (is_whole || pull.torn.is_none()) {
            if stop() {
                return Err((Status::Interrupted, String::new()));
            }
            let step = run.step();
            let step = step.map_err(|error| (Status::Failed, error.to_string()))?;
            let system = run.cloth().system();
            let [left, right] = [0, 1].map(|leg| {
                let held = run.held(leg);
                let first = system.positions()[held[0].index()];
                let forces = held.iter().map(|v| force::reaction_n(system, v.index()));
                let force_n: f64 = forces.map(|force| force.dot(&depth)).sum();
                [first.coords.dot(&depth), force_n]
            });
            if step.tear.is_some_and(|tear| tear.splits > 0) {
                let last = pull.clamps.len();
                pull.torn = Some([pull.torn.map_or(last, |[first, _]| first), last]);
            }
            // Half the difference: the part that both clamps agree on.
            let force_n = (left[1] - right[1]) / 2.0;
            pull.clamps.push([left[0] - right[0], force_n]);
        }
        Ok(pull)
    }
}

/// A strip whose legs were pulled apart.
pub(super) struct Pull {
    pub(super) step_s: f64,
    /// After each step, the distance between the clamps in metres and the force between them in newtons.
    clamps: Vec<[f64; 2]>,
    /// The indices of the first step in which the strip tore and of the last.
    torn: Option<[usize; 2]>,
}

impl Pull {
    /// The distances between the clamps and the forces, each a mean over 1/60 s of a whole pull.
    pub(super) fn curve(&self) -> impl Iterator<Item = [f64; 2]> {
        let parts = self
            .clamps
            .chunks_exact((self.clamps.len() / SAMPLES).max(1));
        parts.map(|part| [part[part.len() - 1][0], mean_n(part)])
    }

    /// The largest force of the curve, in newtons.
    pub(super) fn largest_n(&self) -> f64 {
        self.curve().map(|[_, force_n]| force_n).fold(0.0, f64::max)
    }

    /// The mean force from the first tear to the last, in newtons; 0 if nothing tore.
    pub(super) fn tearing_n(&self) -> f64 {
        let torn = self.torn.map(|[first, last]| &self.clamps[first..=last]);
        mean_n(torn.unwrap_or_default())
    }

    /// The distance between the clamps at the first tear, and the mean force in the 1/60 s before it.
    pub(super) fn first_tear(&self) -> Option<[f64; 2]> {
        let [first, _] = self.torn?;
        let count = (FRAME_S / self.step_s) as usize;
        let recent = &self.clamps[first.saturating_sub(count)..first];
        Some([self.clamps[first][0], mean_n(recent)])
    }
}

/// The mean force, in newtons; 0 of none.
fn mean_n(clamps: &[[f64; 2]]) -> f64 {
    clamps.iter().map(|[_, force_n]| force_n).sum::<f64>() / clamps.len().max(1) as f64
}

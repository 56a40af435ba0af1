//! Trials: scenes in which some method fails, each played by all methods.

use std::num::NonZero;

use tearmesh::{Mesh, Point, Positions, Ray, Vector, shapes};
use tearmesh_cloth::implicit::Jacobian;
use tearmesh_cloth::scene::{
    Axis, FRAME_S, Frame, HeldVertices, Method, Region, Run, Scene, SwayingWind, TimedCut,
};
use tearmesh_cloth::{StepError, Wind, energy};

use super::outcome::Class::{self, Fine, Refused, Wrong};
use super::outcome::{Messages, Row, RowKind};
use crate::experiment::Status;
use crate::method::DefaultMethod;

/// A scene, with the expected outcome of each method.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// The name of the scene in tables.
    pub name: &'static str,
    /// A short description of the scene and of the failure that it provokes.
    pub about: &'static str,
    judge: Judge,
    set: fn(&mut Stage),
    /// The expected outcomes, in the order of [`DefaultMethod::all`].
    pub expected: [Class; 5],
}

/// The criteria of a right result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Judge {
    /// No edge is strained by more than [`STRAIN_MAX`].
    Unstrained,
    /// Positions differ from those of a reference by at most [`POSITION_ERROR_MAX`].
    Place,
    /// Energy grows by at most [`ENERGY_GAIN_MAX`].
    Energy,
    /// The run reaches its end.
    Ends,
}

/// The largest position error that counts as right, as a fraction of the displacement; both are rms values.
pub const POSITION_ERROR_MAX: f64 = 0.1;

/// The largest gain of energy that counts as right, as a fraction of the energy at the start.
pub const ENERGY_GAIN_MAX: f64 = 0.25;

/// The largest strain of an unstrained edge: rounding, and the tolerance of implicit steps.
const STRAIN_MAX: f64 = 1e-5;

/// The number of cells along each side of the sheet, which measures a metre.
const CELLS: u32 = 8;

/// The number of moments at which positions are compared.
const MOMENTS: u64 = 10;

/// The number by which references divide the recommended step of Verlet.
const FINER: NonZero<u32> = NonZero::<u32>::MIN.saturating_add(3);

/// All scenes, in the order of tables.
pub static TRIALS: [Trial; 12] = [
    Trial {
        name: "free fall",
        about: "a flat sheet falls freely for half a second; nothing may strain it",
        judge: Judge::Unstrained,
        set: |stage| {
            stage.scene.duration_s = 0.5;
            stage.scene.drag_per_s = 0.0;
        },
        expected: [Fine; 5],
    },
    Trial {
        name: "hang",
        about: "a sheet hangs at rest at four times its weight; the number of sweeps is no stiffness",
        judge: Judge::Place,
        set: hang,
        expected: [Fine, Wrong, Fine, Wrong, Fine],
    },
    Trial {
        name: "long steps",
        about: "the hanging sheet at steps of 1/60 s",
        judge: Judge::Place,
        set: |stage| {
            hang(stage);
            stage.scene.step_s = Some(FRAME_S);
        },
        expected: [Refused, Wrong, Fine, Wrong, Refused],
    },
    Trial {
        name: "short steps",
        about: "the hanging sheet at steps of 1/15360 s; PBD does not converge, and becomes rigid",
        judge: Judge::Place,
        set: |stage| {
            hang(stage);
            stage.scene.step_s = Some(FRAME_S / 256.0);
            stage.scene.duration_s = 0.2;
        },
        expected: [Fine, Fine, Fine, Wrong, Fine],
    },
    Trial {
        name: "pretension",
        about: "a frame with 2 % of pretension sags; errors that sweeps leave exceed the load",
        judge: Judge::Place,
        set: |stage| {
            taut(stage);
            stage.scene.gravity_m_per_s2 = Vector::z() * -Scene::GRAVITY_M_PER_S2;
            stage.scene.drag_per_s = 2.0;
        },
        expected: [Fine, Wrong, Wrong, Wrong, Fine],
    },
    Trial {
        name: "ringing",
        about: "the same frame rings without drag; only the method damps it",
        judge: Judge::Place,
        set: |stage| {
            taut(stage);
            stage.start = |p| bulged(p, 1.02, 0.01);
        },
        expected: [Fine, Wrong, Wrong, Wrong, Fine],
    },
    Trial {
        name: "crushed",
        about: "a sheet is let go at half its size; Provot without its limiter makes energy",
        judge: Judge::Energy,
        set: |stage| {
            crushed(stage);
            if let Method::Provot(limiter) = &mut stage.scene.solver {
                limiter.stretch_ratio_max = 1e6;
            }
        },
        expected: [Fine, Fine, Fine, Fine, Wrong],
    },
    Trial {
        name: "compression",
        about: "the same with the limiter; the exact matrix of implicit steps is indefinite",
        judge: Judge::Energy,
        set: |stage| {
            crushed(stage);
            if let Method::Implicit(settings) = &mut stage.scene.solver {
                settings.jacobian = Jacobian::Exact;
            }
        },
        expected: [Fine, Fine, Refused, Fine, Fine],
    },
    Trial {
        name: "wind",
        about: "a gale at a light cloth at steps of 1/240 s; all methods take wind explicitly",
        judge: Judge::Ends,
        set: |stage| {
            hang(stage);
            stage.scene.step_s = Some(FRAME_S / 4.0);
            stage.scene.fabric.stretch_n_per_m = 1.0;
            stage.scene.wind = Some(SwayingWind {
                steady: Wind {
                    velocity_m_per_s: Vector::z() * 20.0,
                    coefficient: 500.0,
                },
                sway_m_per_s: Vector::zeros(),
                period_s: 1.0,
            });
        },
        expected: [Refused; 5],
    },
    Trial {
        name: "sliver",
        about: "the hanging sheet with a vertex of a 600th of the mass, at the step without it",
        judge: Judge::Place,
        set: |stage| {
            hang(stage);
            stage.scene.step_s = Some(stage.run().step_s());
            (stage.mesh, stage.positions) = eared();
        },
        expected: [Fine, Wrong, Fine, Wrong, Refused],
    },
    Trial {
        name: "cut",
        about: "the hanging sheet is cut at the step it had before, which makes slivers",
        judge: Judge::Ends,
        set: |stage| {
            hang(stage);
            stage.scene.step_s = Some(stage.run().step_s());
            let ray = |along: f64| Ray::new(Point::new(0.437, along, 1.0), -Vector::z());
            let rays = [ray(-0.5), ray(0.62)].map(|ray| ray.expect("a direction"));
            stage.scene.cuts = vec![TimedCut {
                at_s: 0.1,
                rays,
                through: false,
                method: tearmesh::CutMethod::Exact,
            }];
        },
        expected: [Fine, Fine, Fine, Fine, Refused],
    },
    Trial {
        name: "too far apart",
        about: "a frame a third larger than its sheet sags; no limiter can keep edges within a tenth",
        judge: Judge::Place,
        set: |stage| {
            taut(stage);
            stage.start = |p| bulged(p, 1.33, 0.0);
            stage.unloaded = stage.start;
            stage.scene.gravity_m_per_s2 = Vector::z() * -Scene::GRAVITY_M_PER_S2;
            stage.scene.drag_per_s = 40.0;
        },
        expected: [Fine, Wrong, Wrong, Wrong, Wrong],
    },
];

/// Holds the upper edge, at four times the weight, with drag that brings the sheet to rest in a second.
fn hang(stage: &mut Stage) {
    stage.hold(&[[0.0, 1.0, 0.99, 1.0]]);
    stage.scene.gravity_m_per_s2 *= 4.0;
    stage.scene.drag_per_s = 60.0;
    stage.scene.duration_s = 0.5;
}

/// Holds the whole border, 2 % larger than at rest, without loads.
fn taut(stage: &mut Stage) {
    stage.hold(&[
        [0.0, 1.0, 0.0, 0.01],
        [0.0, 1.0, 0.99, 1.0],
        [0.0, 0.01, 0.0, 1.0],
        [0.99, 1.0, 0.0, 1.0],
    ]);
    free(stage);
    stage.start = |p| bulged(p, 1.02, 0.0);
    stage.unloaded = stage.start;
}

/// Starts at half the size, held by nothing and without loads.
fn crushed(stage: &mut Stage) {
    free(stage);
    stage.start = |p| bulged(p, 0.5, 0.01);
}

/// Removes all loads.
fn free(stage: &mut Stage) {
    stage.scene.gravity_m_per_s2 = Vector::zeros();
    stage.scene.drag_per_s = 0.0;
    stage.scene.duration_s = 0.5;
}

/// A point of the sheet scaled by a factor, and moved out of its plane by up to so many metres.
fn bulged(p: Point, factor: f64, height_m: f64) -> Point {
    let [x, y] = [p.x, p.y].map(|x| 4.0 * x * (1.0 - x));
    Point::new(p.x * factor, p.y * factor, height_m * x * y)
}

/// The sheet. Its diagonals alternate, so that tension balances at each vertex.
fn square() -> (Mesh, Positions) {
    shapes::grid_with_diagonals(CELLS, CELLS, |i, j| (i + j) % 2 == 0)
}

/// The sheet with one more triangle at its lower edge, which is a hundredth of a cell high.
fn eared() -> (Mesh, Positions) {
    let (mesh, positions) = square();
    let mut faces = mesh.indices().as_chunks::<3>().0.to_vec();
    let mut points = positions.as_slice().to_vec();
    let cell_m = 1.0 / f64::from(CELLS);
    points.push(Point::new(3.5 * cell_m, -0.01 * cell_m, 0.0));
    let ear = points.len() as u32 - 1;
    faces.push([4, 3, ear]);
    let mesh = Mesh::build(points.len(), &faces).expect("a triangle more at the border");
    (mesh, Positions::new(points).expect("finite coordinates"))
}

/// A scene that is being set.
struct Stage {
    mesh: Mesh,
    positions: Positions,
    frame: Frame,
    scene: Scene,
    /// The position at the start of a vertex that is at this point at rest.
    start: fn(Point) -> Point,
    /// Its position without loads.
    unloaded: fn(Point) -> Point,
}

impl Stage {
    fn new(method: Method) -> Stage {
        let (mesh, positions) = square();
        let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
        let scene = Scene {
            duration_s: 1.0,
            solver: method,
            tearing: None,
            ..Scene::fall(frame.up)
        };
        Stage {
            mesh,
            positions,
            frame,
            scene,
            start: |p| p,
            unloaded: |p| p,
        }
    }

    /// Holds patches, given from left to right and from bottom to top.
    fn hold(&mut self, patches: &[[f64; 4]]) {
        let held = patches.iter().map(|&[left, right, bottom, top]| {
            HeldVertices::still(Region::Patch {
                across: [left, right],
                along: [bottom, top],
            })
        });
        self.scene.holds = held.collect();
    }

    fn run(&self) -> Run {
        let scene = self.scene.clone();
        let run = Run::new(self.mesh.clone(), &self.positions, scene, &self.frame);
        let points = self.positions.as_slice();
        let run = run.expect("a trial is a scene that can be played");
        let run = run.displaced(|v| (self.start)(points[v.index()]) - points[v.index()]);
        run.expect("a trial starts at finite positions")
    }
}

/// A scene that was played.
struct Played {
    stage: Stage,
    run: Run,
    /// The error that ended the run; `None` if it reached its end.
    error: Option<StepError>,
    /// The positions of vertices at [`MOMENTS`] moments; fewer if the run failed.
    positions: Vec<Vec<Point>>,
    /// The largest energy as a multiple of that at the start.
    energy: f64,
}

impl Trial {
    /// Plays the scene by each method, and returns a row for each. `None` if it was interrupted.
    pub(super) fn rows(
        &self,
        messages: &dyn Messages,
        stop: &dyn Fn() -> bool,
    ) -> Option<Vec<Row>> {
        let reference = match self.judge {
            Judge::Place => Some(self.play(Method::Verlet, Some(FINER), stop)?),
            _ => None,
        };
        let methods = DefaultMethod::all().into_iter().zip(self.expected);
        let rows = methods.map(|(method, expected)| {
            let played = self.play(method.settings, None, stop)?;
            let Played { run, error, .. } = &played;
            let (measure, measure_max) = self.judge.measure(&played, reference.as_ref());
            let measure = measure.filter(|_| error.is_none());
            let measured = match error {
                Some(error) => Class::of(error),
                // Written so that NaN is wrong.
                None if measure.is_none_or(|measure| measure <= measure_max) => Fine,
                None => Wrong,
            };
            let said = messages.of_run(run, &played.stage.frame, error.as_ref());
            let row = Row {
                dt_s: Some(run.step_s()),
                expected: Some(expected),
                measured: Some(measured),
                measure,
                agrees: Some(measured == expected),
                is_silent: Some(measured != Fine && said.is_empty()),
                status: Status::Ok,
                ..Row::new(RowKind::Scene, self.name, method.name)
            };
            Some(row.with_messages(&said))
        });
        rows.collect()
    }

    /// Plays the scene by a method, at the step of the scene or at a fraction of the recommended step. `None`
    /// is an interruption.
    fn play(
        &self,
        method: Method,
        finer: Option<NonZero<u32>>,
        stop: &dyn Fn() -> bool,
    ) -> Option<Played> {
        let mut stage = Stage::new(method);
        (self.set)(&mut stage);
        let mut run = match finer {
            None => stage.run(),
            Some(finer) => {
                stage.scene.step_s = None;
                stage.run().in_smaller_steps(finer)
            }
        };
        let start_j = mechanical_j(&run);
        let (mut error, mut positions, mut energy) = (None, Vec::new(), 1.0_f64);
        while error.is_none() && !run.is_over() {
            if stop() {
                return None;
            }
            if let Err(failed) = run.step() {
                error = Some(failed);
                continue;
            }
            let (steps, planned) = (run.tally().steps, run.steps_planned());
            if steps * MOMENTS / planned > (steps - 1) * MOMENTS / planned {
                positions.push(run.cloth().positions().to_vec());
            }
            energy = energy.max(mechanical_j(&run) / start_j);
        }
        Some(Played {
            stage,
            run,
            error,
            positions,
            energy,
        })
    }
}

impl Judge {
    /// The measure of a run, and the largest value that is right.
    fn measure(self, played: &Played, reference: Option<&Played>) -> (Option<f64>, f64) {
        match self {
            Judge::Ends => (None, f64::INFINITY),
            Judge::Unstrained => (Some(strain(&played.run)), STRAIN_MAX),
            Judge::Energy => (Some(played.energy), 1.0 + ENERGY_GAIN_MAX),
            Judge::Place => {
                let error = reference.map(|reference| position_error(played, reference));
                (error, POSITION_ERROR_MAX)
            }
        }
    }
}

/// The kinetic and elastic energy in joules. It is the kinetic energy alone for methods that sweep, since the
/// lengths that sweeps leave belong to no force.
fn mechanical_j(run: &Run) -> f64 {
    let system = run.cloth().system();
    let is_swept = matches!(run.scene().solver, Method::Xpbd(_) | Method::Pbd(_));
    let has_begun = run.tally().steps > 0;
    let elastic_j = match is_swept && has_begun {
        true => 0.0,
        false => energy::elastic_j(system),
    };
    elastic_j + energy::kinetic_j(system)
}

/// The largest strain of an edge.
fn strain(run: &Run) -> f64 {
    let system = run.cloth().system();
    let (springs, x) = (system.stretches(), system.positions());
    let strains = springs.iter().map(|id| {
        let spring = springs.get(id);
        let [a, b] = spring.ends.map(|end| x[end]);
        ((b - a).norm() / spring.rest_length_m - 1.0).abs()
    });
    strains.fold(0.0, f64::max)
}

/// The rms distance of vertices from the reference, divided by that of the reference from the positions without
/// loads.
fn position_error(played: &Played, reference: &Played) -> f64 {
    let points = played.stage.positions.as_slice().iter();
    let unloaded: Vec<Point> = points.map(|&p| (played.stage.unloaded)(p)).collect();
    let square = |ps: &[Point], qs: &[Point]| {
        let pairs = ps.iter().zip(qs);
        pairs.map(|(p, q)| (p - q).norm_squared()).sum::<f64>()
    };
    let moments = played.positions.iter().zip(&reference.positions);
    let [error, displacement] = moments.fold([0.0; 2], |[error, displacement], (own, known)| {
        [
            error + square(own, known),
            displacement + square(known, &unloaded),
        ]
    });
    (error / displacement).sqrt()
}

#[cfg(test)]
mod tests {
    use tearmesh_cloth::implicit::{self, Settings, Tolerance};

    use super::*;

    /// References are Verlet's, so the scenes are played again by Newton's method of second order.
    #[test]
    fn references_agree_with_another_method() {
        let newton = Method::Implicit(Settings {
            method: implicit::Method::Bdf2,
            tolerance: Tolerance::Tied(1.0),
            newton_iterations_max: 20,
            ..Settings::default()
        });
        for (name, error_max) in [("hang", 0.01), ("pretension", 0.03), ("ringing", 0.03)] {
            let trial = TRIALS.iter().find(|trial| trial.name == name);
            let play = |method: &Method, finer: u32| {
                let played = trial?.play(method.clone(), NonZero::new(finer), &|| false);
                played.filter(|played| played.error.is_none())
            };
            let [verlet, newton] = [(&Method::Verlet, FINER.get()), (&newton, 16)]
                .map(|(method, finer)| play(method, finer).expect("it reaches its end"));
            let error = position_error(&newton, &verlet);
            assert!(error < error_max, "{name}: {error}");
        }
    }
}

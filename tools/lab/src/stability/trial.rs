//! Scenes in which some method fails, each played by all: what should come of it, what does, and what a
//! user is told.

use std::num::NonZero;

use serde::Serialize;
use tearmesh::{Mesh, Point, Positions, Ray, Vector, shapes};
use tearmesh_cloth::implicit::Jacobian;
use tearmesh_cloth::scene::{
    Axis, FRAME_S, Frame, HeldVertices, Method, Region, Run, Scene, SwayingWind, TimedCut,
};
use tearmesh_cloth::{Wind, energy};

use super::limit;
use super::told::{Class, Teller, Told};
use crate::pareto::Named;

/// A scene, with the expected outcome of each method.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// The name of the scene in tables.
    pub name: &'static str,
    /// A short description of the scene and of the failure that it provokes.
    pub about: &'static str,
    judge: Judge,
    set: fn(&mut Stage),
    /// The expected outcomes, in the order of [`METHODS`].
    pub expected: [Class; 5],
}

/// The names of the methods, in the order of [`Named::all`].
pub const METHODS: [&str; 5] = ["verlet", "xpbd", "implicit", "pbd", "provot"];

/// What tells right from wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Judge {
    /// No edge is strained by more than [`NEXT_TO_NOTHING`].
    Unstrained,
    /// Vertices are where a reference has them, by [`OFF_MAX`].
    Place,
    /// There is no more energy than [`MADE_MAX`] beyond what there was.
    Energy,
    /// It comes to its end.
    Ends,
}

/// The largest position error that counts as right, as a fraction of the displacement; both are rms values.
pub const OFF_MAX: f64 = 0.1;

/// The largest gain of energy that counts as right, as a fraction of the energy at the start.
pub const MADE_MAX: f64 = 0.25;

/// The strain of what is not strained: rounding, and what the tolerance of implicit steps leaves.
const NEXT_TO_NOTHING: f64 = 1e-5;

/// A scene that is being set.
struct Stage {
    mesh: Mesh,
    positions: Positions,
    frame: Frame,
    scene: Scene,
    /// Where a vertex starts that is at this point at rest.
    start: fn(Point) -> Point,
    /// Where it lies without loads.
    unloaded: fn(Point) -> Point,
}

/// The cells a side of the sheet, which measures a metre.
const CELLS: u32 = 8;

use Class::{Fine, Refused, Wrong};

/// All scenes, in the order of tables.
pub const TRIALS: [Trial; 12] = [
    Trial {
        name: "free fall",
        about: "a flat sheet falls freely for half a second: its strain stays nothing",
        judge: Judge::Unstrained,
        set: |stage| {
            stage.scene.duration_s = 0.5;
            stage.scene.drag_per_s = 0.0;
        },
        expected: [Fine; 5],
    },
    Trial {
        name: "hang",
        about: "hangs at rest at four times its weight: sweeps are no stiffness",
        judge: Judge::Place,
        set: hang,
        expected: [Fine, Wrong, Fine, Wrong, Fine],
    },
    Trial {
        name: "long steps",
        about: "the same at steps of 1/60 s",
        judge: Judge::Place,
        set: |stage| {
            hang(stage);
            stage.scene.step_s = Some(FRAME_S);
        },
        expected: [Refused, Wrong, Fine, Wrong, Refused],
    },
    Trial {
        name: "short steps",
        about: "the same at steps of 1/15360 s: PBD has no limit, and gets rigid",
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
        about: "a frame with 2 % of pretension sags: what sweeps leave is more than the load",
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
        about: "the same frame rings without drag: what damps it is the method",
        judge: Judge::Place,
        set: |stage| {
            taut(stage);
            stage.start = |p| bulged(p, 1.02, 0.01);
        },
        expected: [Fine, Wrong, Wrong, Wrong, Fine],
    },
    Trial {
        name: "crushed",
        about: "let go at half its size, without a limiter: energy that nobody put in",
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
        about: "the same with a limiter, and by implicit steps that take no indefinite matrix",
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
        about: "a gale at a light cloth, at steps of 1/240 s: all take wind in by velocities before",
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
        about: "hangs with a vertex of a 600th of the mass, at the step of the sheet without it",
        judge: Judge::Place,
        set: |stage| {
            hang(stage);
            let run = stage.run().expect("a scene of our own");
            stage.scene.step_s = Some(run.step_s());
            (stage.mesh, stage.positions) = eared();
        },
        expected: [Fine, Wrong, Fine, Wrong, Refused],
    },
    Trial {
        name: "cut",
        about: "cut as it hangs, at the longest step it has before: slivers are made",
        judge: Judge::Ends,
        set: |stage| {
            hang(stage);
            let run = stage.run().expect("a scene of our own");
            stage.scene.step_s = Some(run.step_s());
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
        about: "a frame a third larger than its sheet sags: no limiter can hold a tenth",
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

/// By the upper edge, at four times the weight, with drag that brings it to rest in a second.
fn hang(stage: &mut Stage) {
    let upper = Region::Patch {
        across: [0.0, 1.0],
        along: [0.99, 1.0],
    };
    stage.scene.holds = vec![HeldVertices::still(upper)];
    stage.scene.gravity_m_per_s2 *= 4.0;
    stage.scene.drag_per_s = 60.0;
    stage.scene.duration_s = 0.5;
}

/// Held all round, 2 % longer than at rest, without loads.
fn taut(stage: &mut Stage) {
    let patch = |across, along| HeldVertices::still(Region::Patch { across, along });
    stage.scene.holds = vec![
        patch([0.0, 1.0], [0.0, 0.01]),
        patch([0.0, 1.0], [0.99, 1.0]),
        patch([0.0, 0.01], [0.0, 1.0]),
        patch([0.99, 1.0], [0.0, 1.0]),
    ];
    stage.scene.gravity_m_per_s2 = Vector::zeros();
    stage.scene.drag_per_s = 0.0;
    stage.scene.duration_s = 0.5;
    stage.start = |p| bulged(p, 1.02, 0.0);
    stage.unloaded = stage.start;
}

/// Free, at half its size, without loads.
fn crushed(stage: &mut Stage) {
    stage.scene.gravity_m_per_s2 = Vector::zeros();
    stage.scene.drag_per_s = 0.0;
    stage.scene.duration_s = 0.5;
    stage.start = |p| bulged(p, 0.5, 0.01);
}

/// So many times as large, and out of its plane by up to so many metres.
fn bulged(p: Point, times: f64, by_m: f64) -> Point {
    let [x, y] = [p.x, p.y].map(|x| 4.0 * x * (1.0 - x));
    Point::new(p.x * times, p.y * times, by_m * x * y)
}

/// The sheet: diagonals in turn, so that tension balances at each vertex.
fn square() -> (Mesh, Positions) {
    shapes::grid_with_diagonals(CELLS, CELLS, |i, j| (i + j) % 2 == 0)
}

/// The same with a triangle at its lower edge that is a hundredth of a cell high.
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

    /// The scene, about to begin; `None` where it is none, which would be our bug.
    fn run(&self) -> Option<Run> {
        let scene = self.scene.clone();
        let run = Run::new(self.mesh.clone(), &self.positions, scene, &self.frame).ok()?;
        let points = self.positions.as_slice();
        let by_m = |v: tearmesh::VertexId| {
            let p = points[v.index()];
            (self.start)(p) - p
        };
        run.displaced(by_m).ok()
    }
}

/// The outcome of a scene by one method.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// The name of the scene.
    pub trial: &'static str,
    /// The name of the method, as in [`METHODS`].
    pub method: &'static str,
    /// The step, in seconds.
    pub dt_s: f64,
    /// The expected outcome.
    pub expected: Class,
    /// The measured outcome.
    pub measured: Class,
    /// The largest strain, the relative position error, or the largest energy divided by that at the start,
    /// depending on the scene. Smaller is better. `None` if the run failed, or if the scene only has to end.
    pub measure: Option<f64>,
    /// The messages about the run.
    pub told: Vec<Told>,
}

impl Verdict {
    /// Returns whether the method failed without a message.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        self.measured != Fine && self.told.is_empty()
    }
}

/// How a run went.
struct Trace {
    /// Where vertices were at ten moments; fewer where it failed.
    places: Vec<Vec<Point>>,
    /// The most energy as a part of that at the start.
    energy: f64,
    failed: Option<Class>,
}

/// The moments at which places are compared.
const MOMENTS: u64 = 10;

/// References divide the step that suits Verlet by so much.
const FINER: u32 = 4;

impl Trial {
    /// Plays it by each method, and its reference. `None` if `stop` says so.
    pub(super) fn judge(
        &self,
        teller: &dyn Teller,
        stop: &dyn Fn() -> bool,
    ) -> Option<Vec<Verdict>> {
        let reference = match self.judge {
            Judge::Place => Some(self.reference(stop)?),
            _ => None,
        };
        let each = Named::all().into_iter().zip(self.expected);
        let each = each.map(|(named, expected)| {
            let mut stage = Stage::new(named.settings());
            (self.set)(&mut stage);
            let mut run = stage.run().expect("a scene of our own");
            let (trace, told) = trace(&mut run, &stage.frame, Some(teller), stop)?;
            let measure = match (trace.failed, self.judge) {
                (Some(_), _) => None,
                (None, judge) => judge.measure(&stage, &run, &trace, reference.as_ref()),
            };
            // Written so that what is no number is wrong.
            let is_right = measure.is_none_or(|measure| measure <= self.judge.most());
            let ended = if is_right { Fine } else { Wrong };
            Some(Verdict {
                trial: self.name,
                method: named.name,
                dt_s: run.step_s(),
                expected,
                measured: trace.failed.unwrap_or(ended),
                measure,
                told,
            })
        });
        each.collect()
    }

    /// The same scene by Verlet's method, at a part of the step that suits it.
    fn reference(&self, stop: &dyn Fn() -> bool) -> Option<Trace> {
        self.again(Method::Verlet, FINER, stop)
    }

    /// What Newton's method of second order is off by from that.
    #[cfg(test)]
    pub(super) fn off_by_newton(&self, stop: &dyn Fn() -> bool) -> Option<f64> {
        use tearmesh_cloth::implicit;

        let settings = implicit::Settings {
            method: implicit::Method::Bdf2,
            tolerance: implicit::Tolerance::Tied(1.0),
            newton_iterations_max: 20,
            ..implicit::Settings::default()
        };
        let trace = self.again(Method::Implicit(settings), 16, stop)?;
        let mut stage = Stage::new(Method::Verlet);
        (self.set)(&mut stage);
        let run = stage.run().expect("a scene of our own");
        self.judge
            .measure(&stage, &run, &trace, Some(&self.reference(stop)?))
    }

    fn again(&self, method: Method, finer: u32, stop: &dyn Fn() -> bool) -> Option<Trace> {
        let mut stage = Stage::new(method);
        (self.set)(&mut stage);
        stage.scene.step_s = None;
        let finer = NonZero::new(finer).expect("a part");
        let run = stage.run().expect("a scene of our own");
        let (trace, _) = trace(&mut run.in_smaller_steps(finer), &stage.frame, None, stop)?;
        Some(trace)
    }
}

impl Judge {
    /// What is measured of a run that came to its end.
    fn measure(
        self,
        stage: &Stage,
        run: &Run,
        trace: &Trace,
        reference: Option<&Trace>,
    ) -> Option<f64> {
        match self {
            Judge::Ends => None,
            Judge::Unstrained => Some(strain(run)),
            Judge::Energy => Some(trace.energy),
            Judge::Place => {
                let points = stage.positions.as_slice().iter();
                let unloaded: Vec<Point> = points.map(|&p| (stage.unloaded)(p)).collect();
                Some(off(trace, reference?, &unloaded))
            }
        }
    }

    /// The most of it that is right.
    fn most(self) -> f64 {
        match self {
            Judge::Unstrained => NEXT_TO_NOTHING,
            Judge::Energy => 1.0 + MADE_MAX,
            Judge::Place | Judge::Ends => OFF_MAX,
        }
    }
}

/// A run to its end, and what is said of it. `None` is an interruption.
fn trace(
    run: &mut Run,
    frame: &Frame,
    teller: Option<&dyn Teller>,
    stop: &dyn Fn() -> bool,
) -> Option<(Trace, Vec<Told>)> {
    let began_j = mechanical_j(run);
    let mut trace = Trace {
        places: Vec::new(),
        energy: 1.0,
        failed: None,
    };
    let mut error = None;
    while !run.is_over() {
        if stop() {
            return None;
        }
        if let Err(failed) = run.step() {
            trace.failed = Some(limit::class(&failed));
            error = Some(failed);
            break;
        }
        let (steps, planned) = (run.tally().steps, run.steps_planned());
        if steps * MOMENTS / planned > (steps - 1) * MOMENTS / planned {
            trace.places.push(run.cloth().positions().to_vec());
        }
        trace.energy = trace.energy.max(mechanical_j(run) / began_j);
    }
    let told = teller.map(|teller| teller.run(run, frame, error.as_ref()));
    Some((trace, told.unwrap_or_default()))
}

/// Energy of motion and strain, in joules; of motion alone by methods that leave lengths for which they
/// have no force.
fn mechanical_j(run: &Run) -> f64 {
    let system = run.cloth().system();
    let is_swept = matches!(run.scene().solver, Method::Xpbd(_) | Method::Pbd(_));
    let has_begun = run.tally().steps > 0;
    let strain_j = match is_swept && has_begun {
        true => 0.0,
        false => energy::elastic_j(system),
    };
    strain_j + energy::kinetic_j(system)
}

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

/// The rms of what vertices are off by, over that of how far the reference has them from where they lie
/// without loads.
fn off(trace: &Trace, reference: &Trace, unloaded: &[Point]) -> f64 {
    let square = |ps: &[Point], qs: &[Point]| {
        let pairs = ps.iter().zip(qs);
        pairs.map(|(p, q)| (p - q).norm_squared()).sum::<f64>()
    };
    let moments = trace.places.iter().zip(&reference.places);
    let sum = moments.fold([0.0; 2], |[off, way], (places, known)| {
        [off + square(places, known), way + square(known, unloaded)]
    });
    (sum[0] / sum[1]).sqrt()
}

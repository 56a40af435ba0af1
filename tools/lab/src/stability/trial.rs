//! Trials: scenes in which some method fails, each played by all methods.

use tearmesh::{CutMethod, Point, Ray, Vector, shapes};
use tearmesh_cloth::scene::{
    Axis, Frame, HeldVertices, Region, Run, Scene, SwayingWind, TimedCut, Warning, Wording,
};
use tearmesh_cloth::{FRAME_S, Fabric, Method, StepError, Wind, energy};

use super::row::Row;
use crate::experiment::Status::{self, Dissipated, Ok as Fine, Refused, Wrong};
use crate::method::DEFAULTS;
use crate::pareto::status_of;
use crate::reference::Reference;

/// A scene, with the expected outcome of each method.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trial {
    /// The name of the scene in tables.
    pub(crate) name: &'static str,
    /// A short description of the scene and of the failure that it provokes.
    pub(crate) about: &'static str,
    /// The measure of a run beside its reference, and the largest that is right; `None` if the run only has to
    /// end.
    judge: Option<(Measure, f64)>,
    /// The patches that are held, as fractions of the sheet from left to right and from bottom to top.
    held: &'static [[f64; 4]],
    /// Gravity, as a multiple of the usual one.
    gravity: [f64; 3],
    drag_per_s: f64,
    duration_s: f64,
    /// The step; `None` for the recommended one.
    step_s: Option<f64>,
    /// The size at the start and without loads, as a multiple of that at rest.
    size: f64,
    /// How far the middle is out of the plane at the start, in metres.
    bulge_m: f64,
    /// Sets what else is particular to the scene, of which this is the recommended step in seconds.
    adjust: fn(&mut Scene, f64),
    /// The expected outcomes, in the order of [`DEFAULTS`].
    pub(crate) expected: [Status; 5],
}

type Measure = fn(&Played, &Played) -> f64;

/// The largest strain of an edge at the end. What is right is rounding, and the tolerance of implicit steps.
const UNSTRAINED: Option<(Measure, f64)> = Some((|played, _| played.strain, 1e-5));

/// The error of positions. A tenth of the displacement is right.
const IN_PLACE: Option<(Measure, f64)> = Some((position_error, 0.1));

/// The largest energy as a multiple of that at the start. A quarter more is right.
const LOSSY: Option<(Measure, f64)> = Some((|played, _| played.energy, 1.25));

/// The number of cells along each side of the sheet, which measures a metre. Its diagonals alternate, so that
/// tension balances at each vertex.
const CELLS: u32 = 8;

/// The number of moments at which positions are compared.
const MOMENTS: u64 = 10;

/// The number by which references divide the recommended step of Verlet's method.
const FINER: f64 = 4.0;

const FREE_FALL: Trial = Trial {
    name: "free fall",
    about: "a flat sheet falls freely for half a second; nothing may strain it",
    judge: UNSTRAINED,
    held: &[],
    gravity: [0.0, -1.0, 0.0],
    drag_per_s: 0.0,
    duration_s: 0.5,
    step_s: None,
    size: 1.0,
    bulge_m: 0.0,
    adjust: |_, _| {},
    expected: [Fine; 5],
};

/// Held by the upper edge, with drag that brings the sheet to rest.
const HANG: Trial = Trial {
    name: "hang",
    about: "a sheet hangs at rest at four times its weight; the number of sweeps is no stiffness",
    judge: IN_PLACE,
    held: &[[0.0, 1.0, 0.99, 1.0]],
    gravity: [0.0, -4.0, 0.0],
    drag_per_s: 60.0,
    expected: [Fine, Wrong, Dissipated, Wrong, Fine],
    ..FREE_FALL
};

const RINGING: Trial = Trial {
    name: "ringing",
    about: "a frame with 2 % of pretension rings without drag; only the method damps it",
    judge: IN_PLACE,
    held: &[
        [0.0, 1.0, 0.0, 0.01],
        [0.0, 1.0, 0.99, 1.0],
        [0.0, 0.01, 0.0, 1.0],
        [0.99, 1.0, 0.0, 1.0],
    ],
    gravity: [0.0; 3],
    size: 1.02,
    bulge_m: 0.01,
    expected: [Fine, Wrong, Wrong, Wrong, Fine],
    ..FREE_FALL
};

const CRUSHED: Trial = Trial {
    name: "crushed",
    about: "a sheet is let go at half its size; Provot without its limiter makes energy",
    judge: LOSSY,
    gravity: [0.0; 3],
    size: 0.5,
    bulge_m: 0.01,
    adjust: |scene, _| {
        if let Method::Provot(limiter) = &mut scene.solver {
            limiter.stretch_ratio_max = 1e6;
        }
    },
    expected: [Fine, Dissipated, Dissipated, Dissipated, Wrong],
    ..FREE_FALL
};

/// All scenes, in the order of tables.
pub(crate) static TRIALS: [Trial; 9] = [
    FREE_FALL,
    HANG,
    Trial {
        name: "long steps",
        about: "the hanging sheet at steps of 1/60 s",
        step_s: Some(FRAME_S),
        expected: [Refused, Wrong, Dissipated, Wrong, Refused],
        ..HANG
    },
    Trial {
        name: "short steps",
        about: "the hanging sheet at steps of 1/15360 s; PBD does not converge, and becomes rigid",
        step_s: Some(FRAME_S / 256.0),
        duration_s: 0.2,
        expected: [Fine, Fine, Fine, Wrong, Fine],
        ..HANG
    },
    RINGING,
    CRUSHED,
    Trial {
        name: "wind",
        about: "a gale at a light cloth at steps of 1/240 s; all methods take wind explicitly",
        judge: None,
        step_s: Some(FRAME_S / 4.0),
        adjust: |scene, _| {
            scene.fabric = Fabric::new(1.0);
            scene.wind = Some(SwayingWind::steady(Wind {
                velocity_m_per_s: Vector::z() * 20.0,
                coefficient: 500.0,
            }));
        },
        expected: [Refused; 5],
        ..HANG
    },
    Trial {
        name: "cut",
        about: "the hanging sheet is cut at the step it had before, which makes slivers",
        judge: None,
        adjust: |scene, step_s| {
            let ray = |along: f64| Ray::new(Point::new(0.437, along, 1.0), -Vector::z());
            scene.step_s = Some(step_s);
            scene.cuts = vec![TimedCut {
                at_s: 0.1,
                rays: [-0.5, 0.62].map(|along| ray(along).expect("a direction")),
                through: false,
                method: CutMethod::Exact,
            }];
        },
        expected: [Fine, Dissipated, Dissipated, Dissipated, Refused],
        ..HANG
    },
    Trial {
        name: "too far apart",
        about: "a frame a third larger than its sheet sags; no limiter can keep edges within a tenth",
        gravity: [0.0, 0.0, -1.0],
        drag_per_s: 40.0,
        size: 1.33,
        bulge_m: 0.0,
        expected: [Fine, Wrong, Dissipated, Wrong, Wrong],
        ..RINGING
    },
];

/// A scene that was played.
struct Played {
    dt_s: f64,
    /// The status of the step that failed; `None` if the run reached its end.
    failure: Option<Status>,
    /// The codes of the messages that a user gets who plays this scene.
    codes: Vec<&'static str>,
    /// The positions of vertices without loads, and at [`MOMENTS`] moments; fewer if the run failed.
    positions: Vec<Vec<Point>>,
    /// The largest strain of an edge at the end.
    strain: f64,
    /// The largest energy as a multiple of that at the start.
    energy: f64,
}

/// Whether a run failed without a message.
pub(super) fn is_silent(measured: Status, codes: &[&str]) -> bool {
    measured != Fine && codes.is_empty()
}

impl Trial {
    /// Plays the scene by each method, and returns a row for each. `None` if it was interrupted.
    pub(super) fn rows(&self, stop: &dyn Fn() -> bool) -> Option<Vec<Row>> {
        let reference = self.play(None, stop)?;
        let methods = DEFAULTS.iter().zip(self.expected);
        let rows = methods.map(|(method, expected)| {
            let played = self.play(Some(method.settings()?), stop)?;
            let judge = self.judge.filter(|_| played.failure.is_none());
            let judged = judge.map(|(measure, most)| (measure(&played, &reference), most));
            // Written so that NaN is wrong.
            let is_right = judged.is_none_or(|(measure, most)| measure <= most);
            let judgement = match is_right {
                true if played.codes.contains(&"W-SIM-DAMPED") => Dissipated,
                true => Fine,
                false => Wrong,
            };
            let measured = played.failure.unwrap_or(judgement);
            Some(Row {
                place: self.name.to_owned(),
                method: method.name.to_owned(),
                dt_s: Some(played.dt_s),
                expected: Some(expected),
                measured: Some(measured),
                measure: judged.map(|(measure, _)| measure),
                agrees: Some(measured == expected),
                is_silent: Some(is_silent(measured, &played.codes)),
                codes: played.codes.join(" | "),
                status: Fine,
                ..Row::default()
            })
        });
        rows.collect()
    }

    /// Plays the scene by a method; without one, by [`Reference`] at a fraction of the recommended step. `None`
    /// is an interruption.
    fn play(&self, method: Option<Method>, stop: &dyn Fn() -> bool) -> Option<Played> {
        let (mesh, rest) = shapes::grid_with_diagonals(CELLS, CELLS, |i, j| (i + j) % 2 == 0);
        let frame = Frame::new(&mesh, rest.as_slice(), Axis::Y);
        let ready = |scene: Scene| {
            let run = Run::new(mesh.clone(), &rest, scene, &frame);
            let run = run.expect("a trial is a scene that can be played");
            let start = self.bulged(rest.as_slice(), self.bulge_m);
            let run = run.displaced(|v| start[v.index()] - rest.at(v));
            run.expect("a trial starts at finite positions")
        };
        let is_reference = method.is_none();
        let mut scene = self.scene(method.unwrap_or(Method::Verlet), &frame);
        let step_s = ready(scene.clone()).step_s();
        (self.adjust)(&mut scene, step_s);
        // The lengths that sweeps leave belong to no force.
        let is_swept = matches!(scene.solver, Method::Xpbd(_) | Method::Pbd(_));
        let mut run = match is_reference {
            false => ready(scene),
            true => {
                scene.step_s = Some(step_s / FINER);
                ready(scene).with_solver(Reference::new(mesh.indices()))
            }
        };
        let energies_j = |run: &Run| {
            let system = run.cloth().system();
            [energy::kinetic_j(system), energy::elastic_j(system)]
        };
        let start_j: f64 = energies_j(&run).iter().sum();
        let (mut error, mut energy) = (None, 1.0_f64);
        let mut positions = vec![self.bulged(rest.as_slice(), 0.0)];
        while error.is_none() && !run.is_over() {
            if stop() {
                return None;
            }
            error = run.step().err();
            let (steps, planned) = (run.tally().steps, run.steps_planned());
            if steps * MOMENTS / planned > positions.len() as u64 - 1 {
                positions.push(run.cloth().positions().to_vec());
            }
            let [kinetic_j, elastic_j] = energies_j(&run);
            let now_j = kinetic_j + if is_swept { 0.0 } else { elastic_j };
            energy = energy.max(now_j / start_j);
        }
        let wording = Wording::default();
        let known = Warning::before(&run, &frame, &wording);
        let warnings = [known, Warning::after(&run, &wording)].concat();
        let codes = warnings.iter().map(Warning::code);
        let system = run.cloth().system();
        let ratios = system.stretches().iter();
        let strains = ratios.map(|id| (system.stretch_ratio(id) - 1.0).abs());
        Some(Played {
            dt_s: run.step_s(),
            failure: error.as_ref().map(status_of),
            codes: codes.chain(error.as_ref().map(StepError::code)).collect(),
            positions,
            strain: strains.fold(0.0, f64::max),
            energy,
        })
    }

    /// The scene before it is adjusted.
    fn scene(&self, solver: Method, frame: &Frame) -> Scene {
        let holds = self.held.iter().map(|&[left, right, bottom, top]| {
            HeldVertices::still(Region::Patch {
                across: [left, right],
                along: [bottom, top],
            })
        });
        Scene {
            duration_s: self.duration_s,
            solver,
            step_s: self.step_s,
            gravity_m_per_s2: Vector::from(self.gravity) * Scene::GRAVITY_M_PER_S2,
            drag_per_s: self.drag_per_s,
            holds: holds.collect(),
            tearing: None,
            ..Scene::fall(frame.up)
        }
    }

    /// Points of the sheet at rest in their places without loads, but with the middle so many metres out of the
    /// plane.
    fn bulged(&self, rest: &[Point], height_m: f64) -> Vec<Point> {
        let bulged = rest.iter().map(|p| {
            let [x, y] = [p.x, p.y].map(|x| 4.0 * x * (1.0 - x));
            Point::new(p.x * self.size, p.y * self.size, height_m * x * y)
        });
        bulged.collect()
    }
}

/// The rms distance of vertices from the reference, divided by that of the reference from the positions without
/// loads.
fn position_error(played: &Played, reference: &Played) -> f64 {
    let square = |ps: &[Point], qs: &[Point]| {
        let pairs = ps.iter().zip(qs);
        pairs.map(|(p, q)| (p - q).norm_squared()).sum::<f64>()
    };
    let (mut error, mut displacement) = (0.0, 0.0);
    for (own, known) in played.positions.iter().zip(&reference.positions) {
        error += square(own, known);
        displacement += square(known, &reference.positions[0]);
    }
    (error / displacement).sqrt()
}

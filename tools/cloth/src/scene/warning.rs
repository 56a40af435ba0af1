//! Reasons to doubt a run: what is known before its first step, and what showed in the steps that it took.

use super::frame::Frame;
use super::run::Run;
use super::run::gain::EnergyGain;
use crate::method::solver::{LimiterStats, Quality};
use crate::method::stability::frequency_bound;
use crate::method::{Method, Softness};
use crate::system::guard::Frequency;
use crate::system::load::ColliderShape;

/// A reason to doubt what a run shows of its cloth.
///
/// ```
/// use tearmesh_cloth::Method;
/// use tearmesh_cloth::scene::{Axis, Frame, Run, Scene, Warning};
/// use tearmesh::shapes;
///
/// let (mesh, positions) = shapes::grid(6, 6);
/// let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
/// let scene = Scene { solver: Method::pbd(), ..Scene::hang(&frame) };
/// let run = Run::new(mesh, &positions, scene, &frame)?;
/// let warnings = Warning::before(&run, &frame);
/// assert!(warnings.contains(&Warning::Rigid));
/// assert!(warnings.iter().any(|warning| warning.code() == "W-SIM-RIGID"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Warning {
    /// The mesh is far smaller or larger than the garments and flags for which the default fabric is made.
    /// Its diagonal is given, in metres.
    Size(f64),
    /// An explicit method needs so many steps that the run will hardly end.
    /// The frequency is the one that asks for such short steps.
    Endless(Frequency),
    /// A cut comes after the last step.
    /// Its time is given, in seconds.
    LateCut(f64),
    /// A seam would be unpicked after the last step.
    /// Its time is given, in seconds.
    LateUnpick(f64),
    /// A hold begins after the last step.
    LateHold {
        /// The index of the hold, from 0.
        hold: usize,
        /// The time at which it begins, in seconds.
        from_s: f64,
    },
    /// XPBD leaves the cloth softer than its fabric by more than [`Softness::TOLERABLE`].
    Soft(Softness),
    /// PBD takes steps that are too long for the mesh, so that cloth is stretched by its own weight.
    /// The longest suitable step is given, in seconds.
    Coarse(f64),
    /// PBD treats edges as rigid, whatever the fabric.
    Rigid,
    /// A hold pins single vertices, whose strain grows as the mesh gets finer.
    Pinned {
        /// The index of the hold, from 0.
        hold: usize,
        /// The number of vertices.
        pins: usize,
    },
    /// A ball is smaller than the longest edge, and may slip through the cloth between vertices.
    SmallBall {
        /// The index of the collider, from 0.
        collider: usize,
        /// The radius of the ball, in metres.
        radius_m: f64,
        /// The rest length of the longest edge, in metres.
        longest_m: f64,
    },
    /// Vertices begin inside a body.
    InsideBody {
        /// The index of the collider, from 0.
        collider: usize,
        /// The number of such vertices.
        vertices: usize,
        /// The first of them.
        first: usize,
    },
    /// All vertices are stronger than the cloth.
    /// The least strength of a vertex is given.
    Strong(f64),
    /// Provot's limiter could not hold its limit, since held vertices were too far apart.
    Limiter(LimiterStats),
    /// A vertex moved so far in one step that it may have passed through a ball.
    PassedBall {
        /// The index of the collider, from 0.
        collider: usize,
        /// The radius of the ball, in metres.
        radius_m: f64,
        /// The distance that the vertex moved, in metres.
        farthest_m: f64,
    },
    /// The method made energy out of nothing.
    Energy(EnergyGain),
    /// The method lost more than a tenth of the energy that went into motion.
    Damped {
        /// The numerical dissipation, in joules.
        lost_j: f64,
        /// The energy that was put in ([`EnergyBalance::put_in_j`](crate::EnergyBalance::put_in_j)) and
        /// is not stored as strain, in joules.
        moving_j: f64,
    },
}

impl Warning {
    /// Returns the code of this warning, such as `W-SIM-SOFT`.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Warning::Size(_) => "W-SIM-SIZE",
            Warning::Endless(_) => "W-SIM-ENDLESS",
            Warning::LateCut(_) | Warning::LateUnpick(_) | Warning::LateHold { .. } => {
                "W-SCENE-LATE"
            }
            Warning::Soft(_) => "W-SIM-SOFT",
            Warning::Coarse(_) => "W-SIM-COARSE",
            Warning::Rigid => "W-SIM-RIGID",
            Warning::Pinned { .. } => "W-SIM-PIN",
            Warning::SmallBall { .. } | Warning::PassedBall { .. } => "W-SIM-COLLIDER",
            Warning::InsideBody { .. } => "W-SIM-INSIDE",
            Warning::Strong(_) => "W-SIM-STRONG",
            Warning::Limiter(_) => "W-SIM-LIMIT",
            Warning::Energy(_) => "W-SIM-ENERGY",
            Warning::Damped { .. } => "W-SIM-DAMPED",
        }
    }

    /// Returns the warnings about a run that has not begun. `frame` is that of its scene. Takes linear time.
    #[must_use]
    pub fn before(run: &Run, frame: &Frame) -> Vec<Warning> {
        let scene = run.scene();
        let size_m = frame.size_m();
        let is_usual = (0.01..=8.0).contains(&size_m);
        let mut warnings = Vec::new();
        warnings.extend((!is_usual).then_some(Warning::Size(size_m)));
        warnings.extend(endless(run));
        warnings.extend(late(run));
        let softness = run.softness();
        let softness = softness.filter(|softness| softness.extra > Softness::TOLERABLE);
        warnings.extend(softness.map(Warning::Soft));
        if matches!(scene.solver, Method::Pbd(_)) {
            let speed_m_per_s = scene.fabric.speed_m_per_s(scene.areal_density_kg_per_m2);
            let system = run.cloth().system();
            let wanted_s = scene.solver.wanted_step_s(system, speed_m_per_s);
            let wanted_s = wanted_s.filter(|&wanted_s| run.step_s() > wanted_s);
            warnings.extend(wanted_s.map(Warning::Coarse));
            warnings.push(Warning::Rigid);
        }
        if scene.tearing.is_some() {
            let still = (0..scene.holds.len()).filter(|&hold| scene.holds[hold].moves.is_empty());
            let pins = still.map(|hold| (hold, run.held[hold].pins(run.mesh())));
            let pins = pins.filter(|&(_, pins)| pins > 0);
            warnings.extend(pins.map(|(hold, pins)| Warning::Pinned { hold, pins }));
        }
        let edges = run.cloth().system().stretches().springs();
        let longest_m = edges.map(|(_, rest, _)| rest).fold(0.0, f64::max);
        let small = balls(run).filter(|(_, radius_m)| 2.0 * radius_m < longest_m);
        warnings.extend(small.map(|(collider, radius_m)| Warning::SmallBall {
            collider,
            radius_m,
            longest_m,
        }));
        warnings.extend(inside(run));
        warnings.extend(strong(run));
        warnings
    }

    /// Returns the warnings about the steps that a run has taken.
    #[must_use]
    pub fn after(run: &Run) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if let Quality::Limiter(stats) = run.quality()
            && stats.steps_infeasible > 0
        {
            warnings.push(Warning::Limiter(stats));
        }
        let farthest_m = run.tally().farthest_m;
        let passed = balls(run).filter(|&(_, radius_m)| farthest_m > radius_m);
        warnings.extend(passed.map(|(collider, radius_m)| Warning::PassedBall {
            collider,
            radius_m,
            farthest_m,
        }));
        warnings.extend(run.energy_gain().map(Warning::Energy));
        warnings.extend(damped(run));
        warnings
    }
}

/// An explicit method takes steps as short as the stiffest edge between the lightest vertices
/// asks for, and one face without area is enough for years of them.
fn endless(run: &Run) -> Option<Warning> {
    let is_explicit = matches!(run.scene().solver, Method::Verlet | Method::Provot(_));
    let frequency = || frequency_bound(&mut run.cloth().system().clone());
    let is_endless = is_explicit && run.steps_planned() >= STEPS_MANY;
    is_endless.then(|| Warning::Endless(frequency()))
}

/// Hours of a mesh of a few thousand vertices.
const STEPS_MANY: u64 = 10_000_000;

/// Events after the last step. Where no step is taken at all, nothing has to be held.
fn late(run: &Run) -> impl Iterator<Item = Warning> {
    let scene = run.scene();
    let cuts = scene.cuts.iter().map(|cut| cut.at_s);
    let cuts = cuts.filter(|&at_s| !run.reaches(at_s));
    let holds = scene.holds.iter().map(|hold| hold.from_s).enumerate();
    let holds = holds.filter(|&(_, from_s)| run.steps_planned() > 0 && !run.reaches(from_s));
    let holds = holds.map(|(hold, from_s)| Warning::LateHold { hold, from_s });
    let unpicks = scene.unpicks.iter().map(|(at_s, _)| *at_s);
    let unpicks = unpicks.filter(|&at_s| !run.reaches(at_s));
    let cuts = cuts.map(Warning::LateCut);
    cuts.chain(unpicks.map(Warning::LateUnpick)).chain(holds)
}

/// The balls of a scene, by the indices of colliders, and their radii in metres.
fn balls(run: &Run) -> impl Iterator<Item = (usize, f64)> {
    let colliders = run.scene().colliders.iter().enumerate();
    colliders.filter_map(|(index, collider)| match collider.shape {
        ColliderShape::Sphere { radius_m, .. } => Some((index, radius_m)),
        _ => None,
    })
}

/// The vertices that begin in bodies.
fn inside(run: &Run) -> impl Iterator<Item = Warning> {
    let colliders = run.scene().colliders.iter().enumerate();
    colliders.filter_map(|(collider, one)| {
        let ColliderShape::Body { body, motion, .. } = &one.shape else {
            return None;
        };
        let pose = motion.at(0.0);
        let points = run.cloth().positions().iter().enumerate();
        let mut within = points.filter(|(_, x)| body.distance_m(pose.to_body(**x)) < 0.0);
        let (first, _) = within.next()?;
        Some(Warning::InsideBody {
            collider,
            vertices: 1 + within.count(),
            first,
        })
    })
}

/// Strengths are those of vertices, and on a coarse mesh a small region may hold all that could tear.
fn strong(run: &Run) -> Option<Warning> {
    let tear = run.sim.tear.as_ref()?;
    let strengths = run.mesh().vertices().map(|v| tear.strength(v));
    let least = strengths.fold(f64::INFINITY, f64::min);
    (least > 1.0 && least.is_finite()).then_some(Warning::Strong(least))
}

/// Of what Provot's limiter takes nothing is known.
fn damped(run: &Run) -> Option<Warning> {
    if matches!(run.quality(), Quality::Limiter(stats) if stats.steps_limited > 0) {
        return None;
    }
    let balance = run.energy_balance();
    let (lost_j, put_in_j) = (-balance.made_j(), balance.put_in_j());
    // A sheet in its frame holds most of what was put in, and rings with the rest.
    let moving_j = put_in_j - balance.elastic_j;
    let shows = put_in_j >= LEAST_J && lost_j > DISSIPATED * moving_j;
    shows.then_some(Warning::Damped { lost_j, moving_j })
}

/// The part of that energy that a method may lose unsaid, and the energy in joules below which nothing is
/// said of it.
const DISSIPATED: f64 = 0.1;
const LEAST_J: f64 = 1e-6;

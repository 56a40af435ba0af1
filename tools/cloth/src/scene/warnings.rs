//! The reasons to doubt a run: what is known before its first step, and what showed in the steps that it took.

mod methods;

use super::frame::Frame;
use super::run::Run;
use super::warning::{Warning, Wording};
use crate::method::Method;
use crate::method::stability::frequency_bound;
use crate::system::load::ColliderShape;
use crate::text::{count, short, two_digits};

impl Warning {
    /// Returns the warnings about a run that has not begun. `frame` is that of its scene. Takes linear time.
    #[must_use]
    pub fn before(run: &Run, frame: &Frame, wording: &Wording<'_>) -> Vec<Warning> {
        let mut warnings = Vec::new();
        warnings.extend(size(frame));
        warnings.extend(endless(run, wording));
        warnings.extend(late(run, wording));
        warnings.extend(methods::before(run, wording));
        warnings.extend(pinned(run));
        warnings.extend(small_balls(run));
        warnings.extend(inside(run, wording));
        warnings.extend(strong(run));
        warnings
    }

    /// Returns the warnings about the steps that a run has taken.
    #[must_use]
    pub fn after(run: &Run, wording: &Wording<'_>) -> Vec<Warning> {
        let mut warnings = Vec::new();
        warnings.extend(passed_balls(run, wording));
        warnings.extend(unsewn(run, wording));
        warnings.extend(methods::after(run, wording));
        warnings
    }
}

/// The mesh is far smaller or larger than the garments and flags for which the default fabric is made.
fn size(frame: &Frame) -> Option<Warning> {
    let size_m = frame.size_m();
    let is_usual = (0.01..=8.0).contains(&size_m);
    let size = short(size_m);
    let sentence = format!("the mesh is {size} m across, and the fabric suits garments and flags");
    let help = "units are metres: scale the mesh, or set [fabric] in a scene file";
    (!is_usual).then(|| Warning::new("W-SIM-SIZE", sentence, help))
}

/// An explicit method needs so many steps that the run will hardly end: it takes steps as short as the stiffest
/// edge between the lightest vertices asks for, and one face without area is enough for years of them.
fn endless(run: &Run, wording: &Wording<'_>) -> Option<Warning> {
    let is_explicit = matches!(run.scene().solver, Method::Verlet | Method::Provot(_));
    if !is_explicit || run.steps_planned() < STEPS_MANY {
        return None;
    }
    let frequency = frequency_bound(&mut run.cloth().system().clone());
    let at = frequency.ends.map(|ends| {
        let [a, b] = ends.map(wording.vertex);
        let omega = frequency.omega_rad_per_s;
        format!(
            ": the edge {a}-{b} may swing at {omega:.1e} rad/s, because it is stiff and its ends are light"
        )
    });
    let (steps, at) = (run.steps_planned() as f64, at.unwrap_or_default());
    let step = two_digits(run.step_s());
    let sentence = format!("{steps:.1e} steps of {step} s are planned{at}");
    let solver = wording.solver;
    let help = format!("take a face without area out of the mesh, or use {solver} implicit");
    Some(Warning::new("W-SIM-ENDLESS", sentence, help))
}

/// Hours of a mesh of a few thousand vertices.
const STEPS_MANY: u64 = 10_000_000;

/// Cuts, seams to be unpicked and holds that are due after the last step. Where no step is taken at all, nothing
/// has to be held.
fn late(run: &Run, wording: &Wording<'_>) -> impl Iterator<Item = Warning> {
    let scene = run.scene();
    let over = short(run.steps_planned() as f64 * run.step_s());
    let cuts = scene.cuts.iter().map(|cut| cut.at_s);
    let cuts = cuts.map(|at_s| (at_s, format!("the cut at {} s is never made", short(at_s))));
    let unpicks = scene.unpicks.iter().map(|(at_s, _)| *at_s);
    let unpicks = unpicks.map(|at_s| (at_s, format!("no seam is unpicked at {} s", short(at_s))));
    let holds = scene
        .holds
        .iter()
        .zip(1..)
        .filter(|_| run.steps_planned() > 0);
    let holds = holds.map(|(hold, n)| (hold.from_s, format!("hold {n} is never taken")));
    let events = cuts.chain(unpicks).chain(holds);
    let late = events.filter(|&(at_s, _)| !run.reaches(at_s));
    late.map(move |(at_s, lack)| {
        let sentence = format!("{lack}: the scene is over after {over} s");
        let help = format!(
            "{} above {}, or an earlier time",
            wording.duration,
            short(at_s)
        );
        Warning::new("W-SCENE-LATE", sentence, help)
    })
}

/// In a scene that tears, a hold pins single vertices, whose strain grows as the mesh gets finer.
fn pinned(run: &Run) -> impl Iterator<Item = Warning> {
    let scene = run.scene();
    let still = (0..scene.holds.len()).filter(|&hold| !scene.holds[hold].leads());
    let pins = still.filter(|_| scene.tearing.is_some());
    let pins = pins.map(|hold| (hold + 1, run.held[hold].pins(run.mesh())));
    pins.filter(|&(_, pins)| pins > 0).map(|(number, pins)| {
        let (vertices, they) = match pins {
            1 => ("a single vertex".to_owned(), "it"),
            _ => (format!("{pins} single vertices"), "they"),
        };
        let sentence = format!(
            "hold {number} pins {vertices}, whose strain grows as the mesh gets finer: {they} may tear \
             where a clamp would not"
        );
        Warning::new("W-SIM-PIN", sentence, "give it a `radius`, such as 0.1")
    })
}

/// The balls of a scene, by the numbers of colliders from 1, and their radii in metres.
fn balls(run: &Run) -> impl Iterator<Item = (usize, f64)> {
    let colliders = (1..).zip(&run.scene().colliders);
    colliders.filter_map(|(number, collider)| match collider.shape {
        ColliderShape::Sphere { radius_m, .. } => Some((number, radius_m)),
        _ => None,
    })
}

/// A ball is smaller than the longest edge, and may slip through the cloth between vertices.
fn small_balls(run: &Run) -> impl Iterator<Item = Warning> {
    let edges = run.cloth().system().stretches().springs();
    let longest_m = edges.map(|(_, rest, _)| rest).fold(0.0, f64::max);
    let small = balls(run).filter(move |(_, radius_m)| 2.0 * radius_m < longest_m);
    small.map(move |(number, radius_m)| {
        let (across, long) = (short(2.0 * radius_m), two_digits(longest_m));
        let sentence = format!(
            "collider {number} is a ball {across} m across, and edges are up to {long} m long: only \
             vertices collide, so the ball may pass between them"
        );
        Warning::new("W-SIM-COLLIDER", sentence, "a finer mesh, or a larger ball")
    })
}

/// A vertex moved so far in one step that it may have passed through a ball.
fn passed_balls(run: &Run, wording: &Wording<'_>) -> impl Iterator<Item = Warning> {
    let farthest_m = run.tally().farthest_m;
    let passed = balls(run).filter(move |&(_, radius_m)| farthest_m > radius_m);
    passed.map(move |(number, radius_m)| {
        let (far, radius) = (two_digits(farthest_m), short(radius_m));
        let sentence = format!(
            "a vertex moved {far} m in a step, and collider {number} is a ball of radius {radius} m: the \
             vertex may have passed through it"
        );
        let suited = two_digits(run.step_s() * radius_m / farthest_m / 2.0);
        Warning::new("W-SIM-COLLIDER", sentence, format!("{} {suited}", wording.step))
    })
}

/// Seams are open at the end.
fn unsewn(run: &Run, wording: &Wording<'_>) -> Option<Warning> {
    let pairs = run.pairs();
    let unsewn = pairs.left + pairs.open;
    let all = count(pairs.opened, "pair", "pairs");
    let sentence = format!(
        "{unsewn} of {all} of the seams are not sewn: {} were kept apart, and {} are still drawn together",
        pairs.left, pairs.open
    );
    let help = format!(
        "a larger {}, or free what a body, a hold or a load keeps apart",
        wording.duration
    );
    (unsewn > 0).then(|| Warning::new("W-SIM-UNSEWN", sentence, help))
}

/// Vertices begin inside a body.
fn inside(run: &Run, wording: &Wording<'_>) -> impl Iterator<Item = Warning> {
    let colliders = (1..).zip(&run.scene().colliders);
    colliders.filter_map(|(number, collider)| {
        let ColliderShape::Body { body, motion, .. } = &collider.shape else {
            return None;
        };
        let pose = motion.at(0.0);
        let points = run.cloth().positions().iter().enumerate();
        let mut within = points.filter(|(_, x)| body.distance_m(pose.to_body(**x)) < 0.0);
        let first = (wording.vertex)(within.next()?.0);
        let vertices = count(1 + within.count(), "vertex begins", "vertices begin");
        let sentence = format!(
            "{vertices} inside of {}, such as {first}: from deep inside there is no way out",
            collider.text(number)
        );
        let help = "move the mesh or the body in its file";
        Some(Warning::new("W-SIM-INSIDE", sentence, help))
    })
}

/// All vertices are stronger than the cloth: strengths are those of vertices, and on a coarse mesh a small region
/// may hold all that could tear.
fn strong(run: &Run) -> Option<Warning> {
    let tear = run.sim.tear.as_ref()?;
    let strengths = run.mesh().vertices().map(|v| tear.strength(v));
    let least = strengths.fold(f64::INFINITY, f64::min);
    let vertices = count(run.mesh().vertex_count(), "vertex", "vertices");
    let times = short(least);
    let sentence = format!(
        "all {vertices} are stronger than the cloth: nothing tears below {times} times the threshold"
    );
    let help = "a finer mesh, or smaller regions of strength";
    (least > 1.0 && least.is_finite()).then(|| Warning::note("W-SIM-STRONG", sentence, help))
}

//! The warnings about a method: what it does to a cloth that its fabric does not.
//!
//! One rule serves all methods: there is a warning before a run where the method's own formula has it off by more than
//! [`TOLERABLE_ERROR`] or no formula says how far, and after it where the balance of energy shows it. No error is foretold
//! in numbers but by such a formula, and tests compare each number with what Verlet's method gives at a quarter of its
//! step.

use tearmesh::geometry::{Point, Vector, length};

use crate::method::solver::Quality;
use crate::method::xpbd::Pbd;
use crate::method::{Method, TOLERABLE_ERROR, implicit};
use crate::scene::run::Run;
use crate::scene::run::gain::EnergyGain;
use crate::scene::warning::{Warning, Wording};
use crate::text::{count, short, three_digits, two_digits};

impl Warning {
    /// Returns whether the method has made so much energy that a run shows nothing of the cloth: more than
    /// three times what was put in, and more than a millijoule. Where Provot's limiter has worked, its energy
    /// is not known, and the result is `false`.
    #[must_use]
    pub fn has_exploded(run: &Run) -> bool {
        let is_absurd = |gain: EnergyGain| gain.made_j > f64::max(3.0 * gain.put_in_j, 1e-3);
        run.energy_gain().is_some_and(is_absurd) && !run.quality().has_limited()
    }
}

/// The warnings about the method of a run that has not begun.
pub(super) fn before(run: &Run, wording: &Wording<'_>) -> Vec<Warning> {
    let mut warnings = Vec::new();
    warnings.extend(soft(run, wording));
    warnings.extend(fading(run, wording));
    if let Method::Pbd(pbd) = &run.scene().solver {
        warnings.extend(coarse(run, pbd, wording));
        warnings.push(rigid(run, wording));
    }
    warnings
}

/// The warnings about the method of a run, by the steps that it has taken.
pub(super) fn after(run: &Run, wording: &Wording<'_>) -> Vec<Warning> {
    let mut warnings = Vec::new();
    warnings.extend(limiter(run, wording).or_else(|| limited(run, wording)));
    warnings.extend(energy(run, wording));
    warnings.extend(damped(run, wording));
    warnings
}

/// XPBD leaves the cloth softer than its fabric by more than is tolerable.
fn soft(run: &Run, wording: &Wording<'_>) -> Option<Warning> {
    let (system, solver) = (run.cloth().system(), &run.scene().solver);
    let softness = solver
        .softness(system, run.step_s())
        .filter(|softness| softness.extra > TOLERABLE_ERROR)?;
    let step = short(run.step_s());
    let extra = short((softness.extra * 100.0).round());
    let (suited, most) = (two_digits(softness.step_s), short(TOLERABLE_ERROR * 100.0));
    let sentence = format!(
        "xpbd with a step of {step} s leaves the cloth too soft: hanging cloth stretches {extra} % \
         too far, and some edges far more"
    );
    let (dt, solver) = (wording.step, wording.solver);
    let help = format!("{dt} {suited} for {most} %, or {solver} verlet, which is exact at rest");
    Some(Warning::new("W-SIM-SOFT", sentence, help))
}

/// Backward Euler takes so much of a slow swing of the whole cloth that it shows before the scene is over: of one
/// with the frequency ω, a step of Δt keeps 1/√(1 + (ω Δt)²). (BDF2 keeps all of that, and loses what is faster: no
/// formula knows how much of that there will be, and [`damped`] says what it was.)
fn fading(run: &Run, wording: &Wording<'_>) -> Option<Warning> {
    let Method::Implicit(implicit::Settings {
        method: implicit::Method::BackwardEuler,
        ..
    }) = run.scene().solver
    else {
        return None;
    };
    let (step_s, steps) = (run.step_s(), run.steps_planned() as f64);
    let z = slowest_rad_per_s(run)? * step_s;
    let lost = 1.0 - (1.0 + z * z).powf(-steps / 2.0);
    if lost <= TOLERABLE_ERROR {
        return None;
    }
    let [step, over] = [step_s, steps * step_s].map(short);
    let lost = two_digits(lost * 100.0);
    let sentence = format!(
        "implicit with a step of {step} s damps what swings: in {over} s the cloth as a whole loses {lost} % of \
         its swing"
    );
    let (dt, half, solver) = (wording.step, two_digits(step_s / 2.0), wording.solver);
    let help = format!(
        "`order = \"2\"` in [solver] of a scene file, {solver} verlet, or {dt} {half} for half of that"
    );
    Some(Warning::note("W-SIM-FADE", sentence, help))
}

/// The frequency of the slowest swing: that of a chain that hangs from the middle of what is held and is as long as
/// cloth reaches from there, j₀ √(g/L) / 2 with the first zero j₀ of J₀. Nothing swings unless it is held and has a
/// weight.
fn slowest_rad_per_s(run: &Run) -> Option<f64> {
    let g_m_per_s2 = length(run.scene().gravity_m_per_s2);
    let positions = run.cloth().positions();
    let first = run.held.iter().filter(|held| held.is_first());
    let vertices = first.flat_map(|held| held.vertices());
    let held = vertices.map(|v| positions[v.index()].coords);
    let (count, sum) = held.fold((0.0, Vector::zeros()), |(n, sum), x| (n + 1.0, sum + x));
    let middle = Point::from(sum / count);
    let ways = positions.iter().map(|x| length(x - middle));
    let reach_m = ways.fold(0.0, f64::max);
    let swings = count > 0.0 && g_m_per_s2 > 0.0 && reach_m > 0.0;
    swings.then(|| FIRST_ZERO_OF_J0 / 2.0 * (g_m_per_s2 / reach_m).sqrt())
}

const FIRST_ZERO_OF_J0: f64 = 2.404_825_557_695_773;

/// PBD takes steps that are too long for the mesh, so that cloth is stretched by its own weight.
fn coarse(run: &Run, pbd: &Pbd, wording: &Wording<'_>) -> Option<Warning> {
    let scene = run.scene();
    let speed_m_per_s = scene.fabric.speed_m_per_s(scene.areal_density_kg_per_m2);
    let system = run.cloth().system();
    let wanted_s = scene
        .solver
        .wanted_step_s(system, speed_m_per_s)
        .filter(|&wanted_s| run.step_s() > wanted_s)?;
    let step = short(run.step_s());
    let sweeps = count(pbd.sweeps as usize, "sweep", "sweeps");
    let and = scene.tearing.map_or("", |_| ", and may tear");
    let sentence = format!(
        "a step of {step} s with {sweeps} is too long for so fine a mesh: hanging cloth stretches too \
         far{and}"
    );
    let (dt, wanted, solver) = (wording.step, two_digits(wanted_s), wording.solver);
    let help = format!("{dt} {wanted}, or {solver} verlet");
    Some(Warning::new("W-SIM-COARSE", sentence, help))
}

/// PBD treats edges as rigid, whatever the fabric.
fn rigid(run: &Run, wording: &Wording<'_>) -> Warning {
    let stiffness = short(run.scene().fabric.stretch_n_per_m());
    let sentence = format!(
        "pbd treats edges as rigid: their stretch depends on the step and the number of sweeps, not \
         on the {stiffness} N/m of the fabric"
    );
    let solver = wording.solver;
    let help = format!(
        "{solver} verlet, or xpbd, whose edges are as stiff as the fabric's at short steps"
    );
    Warning::note("W-SIM-RIGID", sentence, help)
}

/// Provot's limiter could not hold its limit, since held vertices were too far apart.
fn limiter(run: &Run, wording: &Wording<'_>) -> Option<Warning> {
    let Quality::Limiter {
        steps_infeasible: some @ 1..,
        excess_max,
        ..
    } = run.quality()
    else {
        return None;
    };
    let limit = match &run.scene().solver {
        Method::Provot(limiter) => limiter.stretch_ratio_max,
        _ => 1.0,
    };
    let (all, most) = (of_steps(run), short(limit + excess_max));
    let sentence = format!(
        "in {some} of {all}, the holds were too far apart for the limiter: edges stayed up to {most} \
         times their rest length, above its limit of {limit}"
    );
    let solver = wording.solver;
    let help = format!("a larger limit_ratio in [solver] of a scene file, or {solver} verlet");
    Some(Warning::new("W-SIM-LIMIT", sentence, help))
}

/// Provot's limiter has shortened edges, whose forces are not those of the fabric then.
fn limited(run: &Run, wording: &Wording<'_>) -> Option<Warning> {
    let Quality::Limiter {
        steps_limited: some @ 1..,
        ..
    } = run.quality()
    else {
        return None;
    };
    let all = of_steps(run);
    let sentence = format!(
        "in {some} of {all}, provot's limiter shortened edges: they pull as it needs, not as the fabric does"
    );
    let help = format!("{} verlet", wording.solver);
    Some(Warning::note("W-SIM-LIMITED", sentence, help))
}

/// How many steps were taken; where they were divided, and the method had each part, how many parts.
fn of_steps(run: &Run) -> String {
    let substeps = run.cloth().system().counters().substeps;
    match substeps == run.tally().steps {
        true => count(substeps as usize, "step", "steps"),
        false => count(substeps as usize, "substep", "substeps"),
    }
}

/// The method made energy out of nothing. What a run that has exploded shows of tears is not worth a word.
fn energy(run: &Run, wording: &Wording<'_>) -> Option<Warning> {
    let gain = run.energy_gain()?;
    let since = short(gain.since_s);
    let much = if run.quality().has_limited() {
        format!("energy out of nothing, from {since} s on")
    } else {
        let [made, put_in] = [gain.made_j, gain.put_in_j].map(three_digits);
        format!("{made} J out of nothing, from {since} s on, where {put_in} J were put in")
    };
    let so = match Warning::has_exploded(run) {
        true => "",
        false => ": what tore since then tore partly because of it",
    };
    let others = match run.scene().solver {
        Method::Verlet => "implicit",
        Method::Implicit(_) => "verlet",
        _ => "verlet or implicit",
    };
    let (solver, dt, half) = (wording.solver, wording.step, two_digits(run.step_s() / 2.0));
    let help = format!("{solver} {others}, {dt} {half}, or a larger drag_per_s in a scene file");
    Some(Warning::new(
        "W-SIM-ENERGY",
        format!("the method made {much}{so}"),
        help,
    ))
}

/// The method lost more than a tenth of the energy that went into motion. Of what Provot's limiter takes
/// nothing is known.
fn damped(run: &Run, wording: &Wording<'_>) -> Option<Warning> {
    if run.quality().has_limited() {
        return None;
    }
    let balance = run.energy_balance();
    let (lost_j, put_in_j) = (-balance.made_j(), balance.put_in_j());
    // A sheet in its frame holds most of what was put in, and rings with the rest.
    let moving_j = put_in_j - balance.elastic_j;
    let shows = put_in_j >= LEAST_J && lost_j > DISSIPATED * moving_j;
    let (method, [lost, moving]) = (
        run.scene().solver.name(),
        [lost_j, moving_j].map(three_digits),
    );
    let sentence = format!(
        "{method} lost {lost} J of the {moving} J that went into motion, which fades too soon"
    );
    let solver = wording.solver;
    let or = match run.scene().solver {
        Method::Verlet => String::new(),
        // Order two changes nothing in when and how cloth tears.
        Method::Implicit(_) if run.tally().splits == 0 => {
            format!(", `order = \"2\"` in [solver] of a scene file, or {solver} verlet")
        }
        _ => format!(", or {solver} verlet"),
    };
    let (dt, half) = (wording.step, two_digits(run.step_s() / 2.0));
    shows.then(|| Warning::note("W-SIM-DAMPED", sentence, format!("{dt} {half}{or}")))
}

/// The part of that energy that a method may lose unsaid, and the energy in joules below which nothing is
/// said of it.
const DISSIPATED: f64 = 0.1;
const LEAST_J: f64 = 1e-6;

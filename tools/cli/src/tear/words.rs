//! What is said of a simulation.

use tearmesh_cloth::implicit;
use tearmesh_cloth::scene::Run;
use tearmesh_cloth::{BlowUpSite, Method, Quality, StepError};

use crate::report;
use crate::say::{Fault, count, short};
use crate::scene::method_name;

/// The line of the summary.
pub(super) fn simulation(tear: &report::Tear) -> String {
    let cap = match tear.steps_at_cap {
        0 => String::new(),
        steps => format!(" (cap hit in {})", count(steps as usize, "step", "steps")),
    };
    let ended = match tear.status {
        "done" => String::new(),
        status => format!(", {status} before {} s", short(tear.time_planned_s)),
    };
    format!(
        "tear: {} s in {} ({}){ended}, {} split{cap}, {} m torn, {} -> {}, stretched up to {}",
        short(tear.time_simulated_s),
        count(tear.steps as usize, "step", "steps"),
        tear.solver,
        count(tear.splits as usize, "vertex", "vertices"),
        short(tear.tear_length_m),
        count(tear.pieces_before, "piece", "pieces"),
        count(tear.pieces, "piece", "pieces"),
        short(tear.max_stretch),
    )
}

/// Whether Provot's limiter has worked. Its work grows without bound as steps get shorter, on what is
/// held as well: joules that it has a part in say nothing of the cloth.
fn has_limited(run: &Run) -> bool {
    matches!(run.quality(), Quality::Limiter(limited) if limited.steps_limited > 0)
}

/// The line of the summary that says where the energy went. What neither loads nor hands took is the
/// method's.
pub(super) fn balance(run: &Run) -> String {
    let balance = run.energy_balance();
    if has_limited(run) {
        return format!(
            "energy: {} J stored; what was put in and lost is not known, because the limiter's work grows without bound as steps get shorter",
            three_digits(balance.kinetic_j + balance.elastic_j)
        );
    }
    let made_j = balance.made_j();
    let how = if made_j > 0.0 {
        "made by the method"
    } else {
        "of numerical dissipation"
    };
    format!(
        "energy: {} J put in, {} J stored, {} J lost to drag, {} J {how}",
        three_digits(balance.put_in_j()),
        three_digits(balance.kinetic_j + balance.elastic_j),
        three_digits(-balance.drag_j),
        three_digits(made_j.abs()),
    )
}

/// Says that the method made energy out of nothing.
pub(super) fn gain(run: &Run) -> Option<Fault> {
    let gain = run.energy_gain()?;
    let since = short(gain.since_s);
    let much = if has_limited(run) {
        format!("energy out of nothing, from {since} s on")
    } else {
        let [made, put_in] = [gain.made_j, gain.put_in_j].map(three_digits);
        format!("{made} J out of nothing, from {since} s on, where {put_in} J were put in")
    };
    let message = format!("the method made {much}: what tore since then tore partly because of it");
    let others = match run.scene().solver {
        Method::Verlet => "--solver implicit",
        Method::Implicit(_) => "--solver verlet",
        _ => "--solver verlet or implicit",
    };
    let help = format!(
        "{others}, --dt {}, or a larger drag_per_s in a scene file",
        two_digits(run.step_s() / 2.0)
    );
    Some(Fault::warning("W-SIM-ENERGY", message).help(help))
}

/// Says that the method damps motion more than the scene's own drag does, so much that it shows in the time
/// there was. What Verlet takes is from what is crushed alone, and nothing from what swings; nor do Provot's
/// springs, and of what the limiter takes nothing is known.
pub(super) fn damped(run: &Run) -> Option<Fault> {
    if matches!(run.scene().solver, Method::Verlet | Method::Provot(_)) {
        return None;
    }
    let rate_per_s = run.damping_per_s()?;
    let drag_per_s = run.scene().drag_per_s;
    if rate_per_s <= drag_per_s || rate_per_s * run.elapsed_s() <= FADED {
        return None;
    }
    let rate = match rate_per_s {
        rate if rate > 1000.0 => "more than 1000".to_owned(),
        rate => three_digits(rate),
    };
    let beside = match drag_per_s {
        0.0 => "although the scene has none".to_owned(),
        drag => format!("on top of the {} /s of the scene", short(drag)),
    };
    let name = method_name(&run.scene().solver);
    let message = format!(
        "{name} damped motion as much as a drag of {rate} /s would, {beside}: what swings comes to rest too soon"
    );
    let half = two_digits(run.step_s() / 2.0);
    let help = match run.scene().solver {
        Method::Implicit(_) => {
            format!("--dt {half}, `order = \"2\"` in [solver] of a scene file, or --solver verlet")
        }
        _ => format!("--dt {half}, or --solver verlet"),
    };
    Some(Fault::note("W-SIM-DAMPED", message).help(help))
}

/// By how much motion has to fade to be told: energy by two fifths.
const FADED: f64 = 0.25;

/// Momentum that edits made or lost beyond rounding: our bug.
pub(super) fn momentum_broken(run: &Run) -> Option<String> {
    let drift = run.tally().momentum_drift;
    // Each of some millions of terms is rounded; a lost particle is far more.
    (drift > 1e-6).then(|| format!("edits changed the momentum by the fraction {drift:e}"))
}

pub(super) fn energy(run: &Run) -> report::Energy {
    let balance = run.energy_balance();
    let said = |joules: f64| Some(joules).filter(|_| !has_limited(run));
    report::Energy {
        torn_edges: run.tally().edge_energy_j,
        began: balance.began_j,
        kinetic: balance.kinetic_j,
        elastic: balance.elastic_j,
        gravity: balance.gravity_j,
        held: said(balance.held_j),
        wind: balance.wind_j,
        drag: balance.drag_j,
        colliders: balance.colliders_j,
        edits: balance.edits_j,
        numerical_dissipation: said(-balance.made_j()),
        gain: run.energy_gain().map(|gain| report::EnergyGain {
            since_s: gain.since_s,
            made_j: said(gain.made_j),
            put_in_j: said(gain.put_in_j),
        }),
    }
}

pub(super) fn quality(run: &Run) -> Option<report::Quality> {
    match run.quality() {
        Quality::Carried(carried) => Some(report::Quality::Guarded { carried }),
        Quality::Limiter(limited) => Some(report::Quality::Limiter {
            passes: limited.passes,
            steps_short: limited.steps_short,
            steps_infeasible: limited.steps_infeasible,
            excess_max: limited.excess_max,
            steps_limited: limited.steps_limited,
        }),
        Quality::Strain(rms) => Some(report::Quality::StrainRms(rms)),
        Quality::Residual(newtons) => Some(report::Quality::ResidualN(newtons)),
        Quality::Implicit(solved) => Some(report::Quality::Implicit {
            indefinite: solved.indefinite,
            clamped: solved.clamped,
            residual_max_m_per_s: solved.residual_max_m_per_s,
        }),
        _ => None,
    }
}

/// What Provot's limiter could not hold.
pub(super) fn infeasible(run: &Run) -> Option<Fault> {
    let (Quality::Limiter(limited), Method::Provot(limiter)) = (run.quality(), &run.scene().solver)
    else {
        return None;
    };
    if limited.steps_infeasible == 0 {
        return None;
    }
    let message = format!(
        "in {} of {} what is held was too far apart for the limiter, and edges stayed up to {} \
         times as long as at rest, above its limit of {}",
        limited.steps_infeasible,
        of_steps(run),
        short(limiter.stretch_ratio_max + limited.excess_max),
        limiter.stretch_ratio_max,
    );
    let help = "a larger limit_ratio in [solver] of a scene file, or --solver verlet";
    Some(Fault::warning("W-SIM-LIMIT", message).help(help))
}

/// How many steps were taken; where they were divided, and the method had each part, how many parts.
fn of_steps(run: &Run) -> String {
    let substeps = run.cloth().system().counters().substeps;
    let (one, many) = if substeps == run.tally().steps {
        ("step", "steps")
    } else {
        ("substep", "substeps")
    };
    count(substeps as usize, one, many)
}

pub(super) fn counters(run: &Run) -> report::Counters {
    let counters = run.cloth().system().counters();
    report::Counters {
        force_evaluations: counters.force_evaluations,
        matrix_products: counters.matrix_products,
        wind_evaluations: counters.wind_evaluations,
        collider_passes: counters.collider_passes,
        substeps: counters.substeps,
        overshoots: counters.overshoots,
        visits: report::Visits {
            project: counters.visits.project,
            force: counters.visits.force,
            detect: counters.visits.detect,
        },
        features: features(run),
    }
}

/// The features that a scene uses, and which part of the work each is.
fn features(run: &Run) -> Vec<report::FeatureCost> {
    let (system, scene) = (run.cloth().system(), run.scene());
    let counters = system.counters();
    let cost = counters.features;
    let features = [
        ("springs", true, cost.stretch),
        ("bending", !system.bends().is_empty(), cost.bend),
        ("triangles", cost.triangle > 0, cost.triangle),
        ("wind", scene.wind.is_some(), cost.wind),
        ("colliders", !scene.colliders.is_empty(), cost.collider),
        ("tearing", scene.tearing.is_some(), counters.visits.detect),
    ];
    let all: u64 = features.iter().map(|&(_, _, visits)| visits).sum();
    let used = features.into_iter().filter(|&(_, is_used, _)| is_used);
    used.map(|(name, _, visits)| report::FeatureCost {
        name,
        visits,
        share: visits as f64 / all.max(1) as f64,
    })
    .collect()
}

/// The line of `--verbose` that says what the work was for.
pub(super) fn cost(features: &[report::FeatureCost]) -> String {
    let shares = features
        .iter()
        .map(|feature| format!("{} {:.0} %", feature.name, 100.0 * feature.share));
    let visits: u64 = features.iter().map(|feature| feature.visits).sum();
    let visits = match visits {
        0..1_000_000 => visits.to_string(),
        _ => format!("{:.1} million", visits as f64 / 1e6),
    };
    let shares = shares.collect::<Vec<_>>().join(", ");
    format!("cost: {visits} element visits: {shares}")
}

/// The code of a step that was not taken.
pub(super) fn code(error: &StepError) -> &'static str {
    match error {
        StepError::Unstable { .. } | StepError::Air { .. } | StepError::Substeps { .. } => {
            "E-SIM-UNSTABLE"
        }
        StepError::Implicit { .. } => "E-SIM-UNSOLVED",
        StepError::Setting(_) => "E-SCENE-RANGE",
        _ => "E-SIM-BLOWUP",
    }
}

/// Why the simulation failed, with vertices counted as in OBJ, and what would help.
pub(super) fn failure(error: &StepError, run: &Run) -> Fault {
    let code = code(error);
    let after = match run.elapsed_s() {
        0.0 => String::new(),
        elapsed => format!("; the state after {} s is kept", short(elapsed)),
    };
    let message = match *error {
        StepError::Unstable {
            given_s,
            limit_s,
            frequency,
        } => {
            let at = frequency.ends.map(edge).unwrap_or_default();
            let omega = short(frequency.omega_rad_per_s.round());
            let limit = two_digits(limit_s);
            format!(
                "dt {given_s} s exceeds the stability limit {limit} s (bound of frequencies {omega} \
                 rad/s{at}){after}"
            )
        }
        StepError::Air {
            given_s,
            limit_s,
            rate,
        } => {
            let vertex = rate.particle + 1;
            let per_s = short(rate.rate_per_s.round());
            let limit = two_digits(limit_s);
            format!(
                "dt {given_s} s exceeds the stability limit {limit} s (the air slows vertex \
                 {vertex} at a rate of {per_s} /s){after}"
            )
        }
        StepError::Implicit { ref error, .. } => format!("{}{after}", unsolved(error, run)),
        StepError::BlowUp { at, .. } => match at {
            BlowUpSite::Constraint {
                ends,
                stretch_ratio,
            } => format!(
                "the simulation blew up{}, which is {} times its rest length{after}",
                edge(ends),
                short(stretch_ratio)
            ),
            BlowUpSite::Bend {
                ends: [a, b],
                stretch_ratio,
            } => format!(
                "the simulation blew up at the bend between the vertices {} and {}, which is {} times its rest length{after}",
                a + 1,
                b + 1,
                short(stretch_ratio)
            ),
            BlowUpSite::Particle(particle) | BlowUpSite::Beyond(particle) => {
                let vertex = particle + 1;
                format!("the simulation blew up: vertex {vertex} has no finite position{after}")
            }
            _ => format!("the simulation blew up{after}"),
        },
        ref other => format!("{other}{after}"),
    };
    let help = match *error {
        StepError::Unstable { limit_s, .. } => {
            // What is torn later may need still shorter steps.
            let part = if run.elapsed_s() > 0.0 { 0.5 } else { 1.0 };
            let shorter = two_digits(limit_s * part);
            match run.scene().solver {
                Method::Verlet => format!("--dt {shorter}"),
                _ => format!("--dt {shorter}, or --solver verlet"),
            }
        }
        StepError::Air { limit_s, .. } => {
            let part = if run.elapsed_s() > 0.0 { 0.5 } else { 1.0 };
            format!("--dt {}", two_digits(limit_s * part))
        }
        StepError::Implicit { error, .. } => {
            let shorter = two_digits(run.step_s() / 2.0);
            format!(
                "--dt {shorter}, --solver verlet{}",
                settings_that_help(&error)
            )
        }
        _ if run.scene().step_s.is_some() => {
            let shorter = two_digits(run.step_s() / 2.0);
            format!("--dt {shorter}, or --solver implicit")
        }
        _ => "--solver implicit".to_owned(),
    };
    Fault::error(code, message).help(help)
}

/// What an implicit step left undone.
fn unsolved(error: &implicit::StepError, run: &Run) -> String {
    let dt = short(run.step_s());
    match error {
        implicit::StepError::NotConverged {
            residual,
            limit,
            solver_iterations,
        } => format!(
            "an implicit step of {dt} s leaves an error of {} m/s after {solver_iterations} iterations \
             of the linear solver, and the tolerance allows {} m/s",
            short(*residual),
            short(*limit)
        ),
        _ => format!("an implicit step of {dt} s failed: {error}"),
    }
}

/// The keys of a scene file that can help beside a shorter step.
fn settings_that_help(error: &implicit::StepError) -> &'static str {
    match error {
        implicit::StepError::NotConverged { .. } => {
            ", or a larger `tolerance` in [solver] of a scene file"
        }
        _ => "",
    }
}

fn edge([a, b]: [usize; 2]) -> String {
    format!(" at edge {}-{}", a + 1, b + 1)
}

/// Three digits or all of those before the point; nothing below a billionth.
pub(super) fn three_digits(x: f64) -> String {
    if x.abs() < 1e-9 {
        return "0".to_owned();
    }
    let mut scale = 1.0;
    while (x * scale).abs() < 100.0 {
        scale *= 10.0;
    }
    short((x * scale).round() / scale)
}

/// Two digits, rounded down: a step that is typed like this stays below its limit.
pub(super) fn two_digits(x: f64) -> String {
    let mut scale = 1.0;
    while x * scale < 10.0 && scale < 1e15 {
        scale *= 10.0;
    }
    let rounded = (x * scale).floor() / scale;
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_rounded_down() {
        for (x, text) in [
            (0.005_39, "0.0053"),
            (0.0333, "0.033"),
            (0.001_01, "0.001"),
            (1.29e-5, "0.000012"),
        ] {
            assert_eq!(two_digits(x), text);
            assert!(two_digits(x).parse::<f64>().expect("a number") <= x);
        }
    }
}

//! What is said of a simulation.

use tearmesh::cloth::implicit;
use tearmesh::cloth::{Culprit, Method, Run, StepError};

use crate::report;
use crate::say::{Fault, count, short};

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

/// Momentum that edits made or lost beyond rounding: our bug.
pub(super) fn momentum_broken(run: &Run) -> Option<String> {
    let drift = run.tally().momentum_drift;
    // Each of some millions of terms is rounded; a lost particle is far more.
    (drift > 1e-6).then(|| format!("edits changed the momentum by {drift:e} of itself"))
}

pub(super) fn energy(run: &Run) -> report::Energy {
    let ledger = run.cloth().ledger();
    report::Energy {
        split_elastic: ledger.split_elastic_j,
        insert_elastic: ledger.insert_elastic_j,
        insert_kinetic: ledger.insert_kinetic_j,
        torn_edges: run.tally().edge_energy_j,
    }
}

pub(super) fn counters(run: &Run) -> report::Counters {
    let counters = run.cloth().system().counters();
    report::Counters {
        force_evaluations: counters.force_evaluations,
        projections: counters.projections,
        matrix_products: counters.matrix_products,
        wind_evaluations: counters.wind_evaluations,
        collider_passes: counters.collider_passes,
        substeps: counters.substeps,
        overshoots: counters.overshoots,
    }
}

/// The method of a cut, as it is typed.
pub(super) fn method(method: tearmesh::Method) -> &'static str {
    match method {
        tearmesh::Method::Partition => "partition",
        tearmesh::Method::Uniform => "uniform",
        tearmesh::Method::Alternating => "alternating",
        _ => "exact",
    }
}

/// Why the simulation failed, with vertices counted as in OBJ, and what would help.
pub(super) fn failure(error: &StepError, run: &Run, is_step_chosen: bool) -> Fault {
    let code = match error {
        StepError::Unstable { .. } | StepError::Substeps { .. } => "E-SIM-UNSTABLE",
        StepError::Implicit { .. } => "E-SIM-UNSOLVED",
        _ => "E-SIM-BLOWUP",
    };
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
                "dt {given_s} s exceeds the stability limit {limit} s (largest frequency {omega} \
                 rad/s{at}){after}"
            )
        }
        StepError::Implicit { ref error, .. } => format!("{}{after}", unsolved(error, run)),
        StepError::BlowUp { at, .. } => match at {
            Culprit::Constraint {
                ends,
                stretch_ratio,
            } => format!(
                "the simulation blew up{}, which has {} times its rest length{after}",
                edge(ends),
                short(stretch_ratio)
            ),
            Culprit::Particle(particle) => {
                let vertex = particle + 1;
                format!("the simulation blew up: vertex {vertex} is nowhere{after}")
            }
            _ => format!("the simulation blew up{after}"),
        },
        ref other => format!("{other}{after}"),
    };
    let help = match *error {
        StepError::Unstable { limit_s, .. } => {
            // What is torn later may need still shorter steps.
            let part = if run.elapsed_s() > 0.0 { 0.5 } else { 1.0 };
            format!("--dt {}, or --solver xpbd", two_digits(limit_s * part))
        }
        StepError::Implicit { error, .. } => {
            let shorter = two_digits(run.step_s() / 2.0);
            format!(
                "--dt {shorter}, --solver xpbd{}",
                settings_that_help(&error)
            )
        }
        _ if is_step_chosen => {
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
    match (error, &run.scene().solver) {
        (
            implicit::StepError::NotConverged {
                residual,
                limit,
                newton_iterations,
                solver_iterations,
            },
            Method::Implicit(settings),
        ) => {
            let newton = match *newton_iterations {
                1 => "linearised".to_owned(),
                n => format!(
                    "after {n} of {} Newton iterations",
                    settings.newton_iterations_max
                ),
            };
            format!(
                "an implicit step of {dt} s, {newton}, leaves an error of {} m/s after \
                 {solver_iterations} iterations of the linear solver, and the tolerance allows \
                 {} m/s",
                short(*residual),
                short(*limit)
            )
        }
        _ => format!("an implicit step of {dt} s failed: {error}"),
    }
}

/// The keys of a scene file that can help beside a shorter step.
fn settings_that_help(error: &implicit::StepError) -> &'static str {
    match error {
        implicit::StepError::NotConverged {
            newton_iterations: 0..=1,
            ..
        } => ", or a larger `tolerance` in [solver] of a scene file",
        implicit::StepError::NotConverged { .. } => {
            ", or more `newton_iterations` or a larger `tolerance` in [solver] of the scene file"
        }
        _ => "",
    }
}

fn edge([a, b]: [usize; 2]) -> String {
    format!(" at edge {}-{}", a + 1, b + 1)
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

//! Limits: small motions of nets at steps below and above the limit in theory.

use tearmesh_cloth::{Unstable, energy, recommended_step_s};

use super::net::{NETS, omega_rad_per_s};
use super::row::Row;
use crate::experiment::Status;
use crate::method::Method;
use crate::pareto::status_of;
use crate::sheet::random_vectors;

/// The theoretical stability of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Theory {
    /// Small motions are stable if and only if ω Δt is at most this number.
    UpTo(f64),
    /// Stable up to twice the recommended step of the method. Longer steps may be stable or not, and are
    /// refused.
    Promised,
    /// Stable at any step.
    Always,
}

/// The methods whose limits are measured, as in [`METHODS`](crate::method::METHODS), each with its theory.
pub(crate) static LIMITS: [(&str, Theory); 9] = [
    ("verlet-plain", Theory::UpTo(2.0)),
    ("euler", Theory::UpTo(2.0)),
    ("provot", Theory::UpTo(2.0)),
    ("rk4", Theory::UpTo(2.0 * std::f64::consts::SQRT_2)),
    ("verlet", Theory::Promised),
    ("pbd-10", Theory::Always),
    ("xpbd-1", Theory::Always),
    ("euler-back-10", Theory::Always),
    ("bdf2-10", Theory::Always),
];

/// The default stiffness values of the springs, in N/m.
pub const STIFFNESS_N_PER_M: [f64; 5] = [1e2, 1e3, 1e4, 1e5, 1e6];

/// The steps that are tried, as multiples of the limit in theory, or of 2/ω if there is none. The two next to
/// the limit bound the measured one.
const STEP_RATIOS: [f64; 8] = [0.9, 0.998, 1.002, 1.1, 2.0, 10.0, 100.0, 1000.0];

impl Theory {
    /// Tries all steps of a method of this theory on all nets, at each stiffness in N/m, and returns a row for each.
    /// `None` if it was interrupted.
    pub(super) fn rows(
        self,
        name: &str,
        stiffness: &[f64],
        stop: &dyn Fn() -> bool,
    ) -> Option<Vec<Row>> {
        let method = Method::named(name).expect("a method of the list");
        let mut rows = Vec::new();
        for (net, build) in NETS {
            let unit_omega_rad_per_s = omega_rad_per_s(&build(1.0));
            for &stiffness_n_per_m in stiffness {
                let mut system = build(stiffness_n_per_m);
                let omega_rad_per_s = unit_omega_rad_per_s * stiffness_n_per_m.sqrt();
                let theory_s = match self {
                    Theory::UpTo(limit) => Some(limit / omega_rad_per_s),
                    Theory::Promised => Some(2.0 * recommended_step_s(&mut system)),
                    Theory::Always => None,
                };
                // Near a limit, motions must stay small even when they have grown.
                let push_m = if self == Theory::Always { 1e-4 } else { 1e-10 };
                for (i, velocity) in random_vectors(&system, push_m * omega_rad_per_s) {
                    system.state_mut().1[i] = velocity;
                }
                let kinetic_j = energy::kinetic_j(&system);
                let (steps, kinetic_max_j) = match self {
                    // Errors that sweeps leave in a taut net set it in motion.
                    Theory::Always => (300, 4.0 * (kinetic_j + energy::elastic_j(&system))),
                    // Just below a limit motions grow a hundredfold, just above it without bound but slowly.
                    _ => (3000, 1e6 * kinetic_j),
                };
                // Takes steps until one fails or the motion has grown too much.
                let play = |dt_s: f64, unstable| {
                    let (mut system, mut solver) = (system.clone(), method.solver());
                    system.when_unstable(unstable);
                    for _ in 0..steps {
                        if stop() {
                            return None;
                        }
                        if let Err(error) = system.step(&mut *solver, dt_s) {
                            return Some((status_of(&error), error.code()));
                        }
                        let is_bounded = energy::kinetic_j(&system) <= kinetic_max_j;
                        // Written so that NaN has blown up.
                        if !is_bounded {
                            return Some((Status::BlownUp, ""));
                        }
                    }
                    Some((Status::Ok, ""))
                };
                for step_ratio in STEP_RATIOS {
                    let dt_s = step_ratio * theory_s.unwrap_or(2.0 / omega_rad_per_s);
                    let (measured, _) = play(dt_s, Unstable::Allow)?;
                    let (watched, code) = play(dt_s, Unstable::Refuse)?;
                    rows.push(self.assessed(Row {
                        place: net.to_owned(),
                        stiffness_n_per_m: Some(stiffness_n_per_m),
                        method: method.family.name().to_owned(),
                        step_ratio: Some(step_ratio),
                        dt_s: Some(dt_s),
                        measured: Some(measured),
                        watched: Some(watched),
                        codes: code.to_owned(),
                        status: Status::Ok,
                        ..Row::default()
                    }));
                }
            }
        }
        Some(rows)
    }

    /// Compares the row of a step with theory.
    ///
    /// The guard must refuse all steps above the limit. Some below it are refused too, as the bound of
    /// frequencies holds in every configuration and is up to half above that of the present one.
    fn assessed(self, step: Row) -> Row {
        let (has_limit, ratio) = (self != Theory::Always, step.step_ratio);
        let is_long = has_limit && ratio > Some(1.0);
        let expected = match self {
            Theory::Promised if is_long => None,
            _ if is_long => Some(Status::BlownUp),
            _ => Some(Status::Ok),
        };
        let is_guarded = match step.watched {
            Some(Status::Ok) => !is_long,
            Some(Status::Refused) => has_limit && ratio >= Some(0.65),
            _ => false,
        };
        let is_admitted = step.watched == Some(Status::Ok);
        let has_failed = step.measured != Some(Status::Ok) || !is_admitted;
        Row {
            expected,
            agrees: Some(is_guarded && (expected.is_none() || expected == step.measured)),
            is_silent: Some(has_failed && (is_admitted || step.codes.is_empty())),
            ..step
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::trial::is_silent;
    use super::*;

    #[test]
    fn a_failed_step_past_the_guard_is_silent_and_differs() {
        let (method, theory) = LIMITS[0];
        let steps = theory.rows(method, &[1e3], &|| false).expect("its steps");
        // 2√(k/m) sin(31π/66) is the largest frequency of sixteen links of 10 g.
        let omega = 2.0 * 1e5_f64.sqrt() * (31.0 * std::f64::consts::PI / 66.0).sin();
        for step in steps.iter().filter(|step| step.place == "chain") {
            let is_stable = step.measured == Some(Status::Ok);
            let phase = step.dt_s.expect("a step has a length") * omega;
            assert_eq!(is_stable, phase < 2.0, "{step:?}");
            assert_eq!((step.agrees, step.is_silent), (Some(true), Some(false)));
        }
        let last = steps.last().expect("steps");
        assert_eq!(
            (last.watched, &*last.codes),
            (Some(Status::Refused), "E-SIM-UNSTABLE")
        );
        let again = |watched, codes: &str| {
            let row = theory.assessed(Row {
                watched: Some(watched),
                codes: codes.to_owned(),
                ..last.clone()
            });
            (row.agrees, row.is_silent)
        };
        assert_eq!(again(Status::Refused, ""), (Some(true), Some(true)));
        assert_eq!(again(Status::Ok, "E"), (Some(false), Some(true)));
        // Of a scene nothing but a message tells that it failed.
        assert!(is_silent(Status::Wrong, &[]));
        assert!(!is_silent(Status::Wrong, &["W"]) && !is_silent(Status::Ok, &[]));
    }
}

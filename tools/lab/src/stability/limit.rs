//! Limits: the step from which a method blows up on a net, found by bisection, and its limit in theory.

use tearmesh_cloth::statistics::Random;
use tearmesh_cloth::{StepError, System, Unstable, energy};

use super::net::{NETS, Net, NetKind};
use super::outcome::{Class, Messages, Row, RowKind};
use crate::experiment::Status;
use crate::method::Method;

/// The theoretical stability of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Theory {
    /// Small motions are stable if and only if ω Δt is at most this number.
    UpTo(f64),
    /// Stable up to twice the recommended step of the method. Longer steps may be stable or not, and are
    /// refused.
    Promised,
    /// Stable at any step.
    Always,
}

/// The methods whose limits are measured, as in [`METHODS`](crate::method::METHODS), each with its theory.
pub(super) const LIMITED: [(&str, Theory); 9] = [
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

/// The largest relative difference between a measured and a theoretical limit that agree.
pub const AGREEMENT: f64 = 2e-3;

impl Theory {
    /// The steps that are tried, as multiples of the limit, or of 2/ω if there is none.
    pub(super) fn step_ratios(self) -> &'static [f64] {
        match self {
            Theory::Always => &[1.0, 10.0, 100.0, 1000.0],
            _ => &[0.5, 0.9, 0.99, 1.01, 1.1, 2.0, 10.0],
        }
    }
}

/// A method on a net of one stiffness.
#[derive(Clone, Copy, Debug)]
pub struct LimitKey {
    net: &'static NetKind,
    stiffness_n_per_m: f64,
    method: &'static Method,
    theory: Theory,
}

/// Returns all limits, ordered by method, then by net, then by stiffness.
pub(super) fn keys(stiffness_n_per_m: &[f64]) -> Vec<LimitKey> {
    let mut keys = Vec::new();
    for (name, theory) in LIMITED {
        let method = Method::named(name).expect("a method of the list");
        for net in &NETS {
            keys.extend(stiffness_n_per_m.iter().map(|&stiffness_n_per_m| LimitKey {
                net,
                stiffness_n_per_m,
                method,
                theory,
            }));
        }
    }
    keys
}

impl LimitKey {
    pub(super) fn name(&self) -> String {
        let (net, method) = (self.net.0, self.method.family.name());
        format!("{net} at {:e} N/m by {method}", self.stiffness_n_per_m)
    }

    /// Returns the row of the limit before it is measured.
    pub(super) fn row(&self) -> Row {
        Row {
            stiffness_n_per_m: Some(self.stiffness_n_per_m),
            ..Row::new(RowKind::Limit, self.net.0, self.method.family.name())
        }
    }

    /// Measures the limit, and returns its row and one for each single step, in ascending order of the step.
    /// `None` if it was interrupted.
    pub(super) fn rows(
        &self,
        messages: &dyn Messages,
        stop: &dyn Fn() -> bool,
    ) -> Option<Vec<Row>> {
        let net = (self.net.1)();
        let omega_rad_per_s = net.omega_rad_per_s() * self.stiffness_n_per_m.sqrt();
        let theory_s = match self.theory {
            Theory::UpTo(limit) => Some(limit / omega_rad_per_s),
            Theory::Promised => Some(2.0 * net.recommended_step_s(self.stiffness_n_per_m)),
            Theory::Always => None,
        };
        let pushed = self.pushed(&net, omega_rad_per_s);
        let play = |dt_s, unstable| self.play(pushed.clone(), dt_s, unstable, stop);
        let mut limit = Row {
            omega_rad_per_s: Some(omega_rad_per_s),
            theory_s,
            status: Status::Ok,
            ..self.row()
        };
        let unit_s = theory_s.unwrap_or(2.0 / omega_rad_per_s);
        let mut steps = Vec::new();
        for &step_ratio in self.theory.step_ratios() {
            let dt_s = step_ratio * unit_s;
            let (measured, _) = play(dt_s, Unstable::Allow)?;
            let (watched, error) = play(dt_s, Unstable::Refuse)?;
            let row = Row {
                what: RowKind::Step,
                step_ratio: Some(step_ratio),
                dt_s: Some(dt_s),
                measured: Some(measured),
                watched: Some(watched),
                ..limit.clone()
            };
            let message = error.map(|error| messages.of_step(&error));
            steps.push(assessed(row.with_messages(message.as_slice()), self.theory));
        }
        limit.dt_s = limit_s(&steps, &play)?;
        let is_at_limit = match (self.theory, limit.dt_s.zip(theory_s)) {
            (Theory::UpTo(_), Some((measured, theory))) => {
                (measured / theory - 1.0).abs() < AGREEMENT
            }
            (Theory::UpTo(_), None) => false,
            (Theory::Promised, both) => both.is_none_or(|(measured, theory)| measured > theory),
            (Theory::Always, _) => limit.dt_s.is_none(),
        };
        limit.agrees = Some(is_at_limit && steps.iter().all(|step| step.agrees == Some(true)));
        Some([vec![limit], steps].concat())
    }

    /// The net at rest, with velocities at random.
    fn pushed(&self, net: &Net, omega_rad_per_s: f64) -> System {
        let mut system = net.system(self.stiffness_n_per_m);
        // In a search for a limit, motions must stay small even when they have grown.
        let amplitude_m = match self.theory {
            Theory::Always => 1e-3 * net.edge_m(),
            _ => 1e-9 * net.edge_m(),
        };
        let mut random = Random::new(1);
        for i in net.free() {
            for v in &mut system.state_mut().1[i] {
                *v = amplitude_m * omega_rad_per_s * (2.0 * random.next() - 1.0);
            }
        }
        system
    }

    /// Takes steps until one fails or the motion has grown too much. `None` is an interruption.
    fn play(
        &self,
        mut system: System,
        dt_s: f64,
        unstable: Unstable,
        stop: &dyn Fn() -> bool,
    ) -> Option<(Class, Option<StepError>)> {
        system.when_unstable(unstable);
        let kinetic_j = energy::kinetic_j(&system);
        let (steps, kinetic_max_j) = match self.theory {
            Theory::Always => {
                let all_j = kinetic_j + energy::elastic_j(&system);
                (STEPS_ALWAYS, GROWN_ALWAYS * all_j)
            }
            _ => (STEPS, GROWN * kinetic_j),
        };
        let mut solver = self.method.solver();
        for _ in 0..steps {
            if stop() {
                return None;
            }
            if let Err(error) = system.step(&mut *solver, dt_s) {
                return Some((Class::of(&error), Some(error)));
            }
            let is_bounded = energy::kinetic_j(&system) <= kinetic_max_j;
            // Written so that NaN has blown up.
            if !is_bounded {
                return Some((Class::BlowsUp, None));
            }
        }
        Some((Class::Fine, None))
    }
}

/// A search for a limit takes this many steps. A motion has blown up if its kinetic energy is this many times
/// that of the push: at a millionth beyond the limit of Verlet it is.
const STEPS: u32 = 3000;
const GROWN: f64 = 1e6;

/// A method without a limit takes this many steps, and its kinetic energy must stay below this multiple of all
/// energy at the start: errors that sweeps leave in a taut net set it in motion.
const STEPS_ALWAYS: u32 = 300;
const GROWN_ALWAYS: f64 = 4.0;

/// Compares the row of a step with theory.
///
/// The guard must refuse all steps above the limit, and none that is well below it: its margin is a twentieth.
fn assessed(step: Row, theory: Theory) -> Row {
    let ratio = step.step_ratio.unwrap_or(0.0);
    let has_limit = theory != Theory::Always;
    let is_long = has_limit && ratio > 1.0;
    let expected = match theory {
        _ if !is_long => Some(Class::Fine),
        Theory::Promised => None,
        _ => Some(Class::BlowsUp),
    };
    let is_refused = step.watched == Some(Class::Refused);
    let is_admitted = step.watched == Some(Class::Fine);
    let is_guarded = match has_limit && (0.95..=1.0).contains(&ratio) {
        true => is_refused || is_admitted,
        false if is_long => is_refused,
        false => is_admitted,
    };
    let has_failed = step.measured != Some(Class::Fine) || !is_admitted;
    Row {
        expected,
        agrees: Some(is_guarded && (expected.is_none() || expected == step.measured)),
        is_silent: Some(has_failed && (is_admitted || step.codes.is_empty())),
        ..step
    }
}

/// The shortest step that blows up, between two steps of which one does. The outer `None` is an interruption.
fn limit_s(
    steps: &[Row],
    play: &dyn Fn(f64, Unstable) -> Option<(Class, Option<StepError>)>,
) -> Option<Option<f64>> {
    let has_failed = |step: &Row| step.measured != Some(Class::Fine);
    let Some(first) = steps.iter().position(has_failed) else {
        return Some(None);
    };
    let dt_s = |i: usize| steps[i].dt_s.expect("a step has a length");
    let mut above = dt_s(first);
    if first == 0 {
        return Some(Some(above));
    }
    let mut below = dt_s(first - 1);
    while above / below > 1.0 + 0.1 * AGREEMENT {
        let middle = (above * below).sqrt();
        match play(middle, Unstable::Allow)?.0 {
            Class::Fine => below = middle,
            _ => above = middle,
        }
    }
    Some(Some(above))
}

#[cfg(test)]
mod tests {
    use super::super::tests::Terse;
    use super::*;

    #[test]
    fn a_failed_step_that_the_guard_lets_pass_is_silent_and_differs() {
        let keys = keys(&[1e3]);
        let named = |key: &&LimitKey| key.name() == "chain at 1e3 N/m by plain Verlet";
        let key = keys.iter().find(named).expect("it is measured");
        let rows = key
            .rows(&Terse { is_mute: false }, &|| false)
            .expect("it is not interrupted");
        let [limit, steps @ ..] = &rows[..] else {
            panic!("{rows:?}");
        };
        // 2√(k/m) sin(31π/66) is the largest frequency of sixteen links of 10 g.
        let omega = 2.0 * 1e5_f64.sqrt() * (31.0 * std::f64::consts::PI / 66.0).sin();
        let measured = limit.dt_s.expect("it blows up");
        assert!(
            (measured * omega / 2.0 - 1.0).abs() < AGREEMENT,
            "{measured}"
        );
        assert_eq!(limit.agrees, Some(true));
        assert!(steps.iter().all(|step| step.is_silent == Some(false)));
        let last = steps.last().expect("steps");
        assert_eq!((last.watched, &*last.codes), (Some(Class::Refused), "E"));
        let again = |watched, codes: &str| {
            let row = Row {
                watched: Some(watched),
                codes: codes.to_owned(),
                ..last.clone()
            };
            let row = assessed(row, key.theory);
            (row.agrees, row.is_silent)
        };
        assert_eq!(again(Class::Refused, ""), (Some(true), Some(true)));
        assert_eq!(again(Class::Fine, "E"), (Some(false), Some(true)));
    }
}

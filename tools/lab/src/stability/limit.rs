//! From which step on a method blows up, found by bisection, and what theory says of it.

use serde::Serialize;
use tearmesh_cloth::statistics::Random;
use tearmesh_cloth::{Solver, StepError, System, Unstable, energy};

use super::net::{Net, NetKind};
use super::told::{Class, Teller, Told};
use crate::pareto::{Family, METHODS, Method};

/// The theoretical stability of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Theory {
    /// Small motions are stable if and only if ω Δt is at most this number.
    UpTo(f64),
    /// Stable up to twice the step that suits the method. Theory is silent on longer steps, which are
    /// refused.
    Suited,
    /// Stable at any step.
    Always,
}

/// The names of the methods whose limits are measured, as in [`METHODS`], each with its theory.
pub const ASKED: [(&str, Theory); 9] = [
    ("verlet-plain", Theory::UpTo(2.0)),
    ("euler", Theory::UpTo(2.0)),
    ("provot", Theory::UpTo(2.0)),
    ("rk4", Theory::UpTo(2.0 * std::f64::consts::SQRT_2)),
    ("verlet", Theory::Suited),
    ("pbd-10", Theory::Always),
    ("xpbd-1", Theory::Always),
    ("euler-back-10", Theory::Always),
    ("bdf2-10", Theory::Always),
];

/// The default stiffness values of the springs, in N/m.
pub const STIFFNESS_N_PER_M: [f64; 5] = [1e2, 1e3, 1e4, 1e5, 1e6];

/// Parts of the limit that are tried where there is one.
const PARTS: [f64; 7] = [0.5, 0.9, 0.99, 1.01, 1.1, 2.0, 10.0];

/// Multiples of 2/ω that are tried where there is none.
const MULTIPLES: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];

/// The largest relative difference between a measured and a theoretical limit that agree.
pub const AGREEMENT: f64 = 2e-3;

/// A method on a net of one stiffness.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    net: NetKind,
    stiffness_n_per_m: f64,
    method: &'static Method,
    theory: Theory,
}

/// The stability limit of a method on a net of one stiffness, in theory and as measured.
#[derive(Clone, Debug, Serialize)]
pub struct Limit {
    /// The name of the net, as in [`NetKind::name`].
    pub net: &'static str,
    /// The stiffness of the springs, in N/m.
    pub stiffness_n_per_m: f64,
    /// The name of the method, as in [`Family::name`].
    pub method: &'static str,
    /// The largest frequency of the net in rad/s, from its dense matrix.
    pub omega_rad_per_s: f64,
    /// The longest stable step in theory, in seconds; `None` if every step is stable.
    pub theory_s: Option<f64>,
    /// Whether `theory_s` is a lower bound and the true limit is unknown.
    pub is_promise: bool,
    /// The shortest step in seconds at which the method failed with the watch off; `None` if it never did.
    pub measured_s: Option<f64>,
    /// The longest step that was tried, in seconds.
    pub longest_s: f64,
    /// The results at single steps, in ascending order of the step.
    pub cells: Vec<Cell>,
    /// Whether the measured limit and all cells agree with theory.
    pub agrees: bool,
}

/// The results of a method on a net at one step.
#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    /// The step as a multiple of the theoretical limit, or of 2/ω if there is no limit.
    pub part: f64,
    /// The step, in seconds.
    pub dt_s: f64,
    /// The expected outcome with the watch off; `None` if theory makes no statement.
    pub expected: Option<Class>,
    /// The measured outcome with the watch over stability off.
    pub unwatched: Class,
    /// The measured outcome with the watch on, which is the default.
    pub watched: Class,
    /// The messages about the run with the watch on: at most one.
    pub told: Vec<Told>,
}

impl Cell {
    /// Returns whether the method failed, with the watch on or off.
    #[must_use]
    pub fn has_failed(&self) -> bool {
        self.unwatched != Class::Fine || self.watched != Class::Fine
    }

    /// Returns whether the method failed, with the watch on or off, and there was no message.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        self.has_failed() && (self.watched == Class::Fine || self.told.is_empty())
    }

    /// Whether theory is right, and the watch stops what it says will blow up and nothing that is well
    /// below the limit.
    pub(super) fn agrees(&self, theory: Theory) -> bool {
        let is_expected = self.expected.is_none_or(|class| class == self.unwatched);
        let is_admitted = self.watched == Class::Fine;
        let is_refused = self.watched == Class::Refused;
        let has_limit = theory != Theory::Always;
        is_expected
            && match self.part {
                // The watch has a margin of a twentieth.
                part if has_limit && (0.95..=1.0).contains(&part) => is_admitted || is_refused,
                part if has_limit && part > 1.0 => is_refused,
                _ => is_admitted,
            }
    }
}

/// All that is asked, of springs that are so stiff.
pub(super) fn asked(stiffness_n_per_m: &[f64]) -> Vec<Asked> {
    let mut all = Vec::new();
    for (name, theory) in ASKED {
        let named = METHODS.iter().find(|method| method.name == name);
        for net in NetKind::ALL {
            for &stiffness_n_per_m in stiffness_n_per_m {
                all.push(Asked {
                    net,
                    stiffness_n_per_m,
                    method: named.expect("a method of the list"),
                    theory,
                });
            }
        }
    }
    all
}

impl Asked {
    fn family(&self) -> Family {
        self.method.family
    }

    pub(super) fn name(&self) -> String {
        let (net, stiffness) = (self.net.name(), self.stiffness_n_per_m);
        format!("{net} at {stiffness:e} N/m by {}", self.family().name())
    }

    /// A guess at the work, for what is begun first.
    pub(super) fn guess(&self) -> f64 {
        let net = match self.net {
            NetKind::Chain | NetKind::String => 1.0,
            _ => 6.0,
        };
        match self.theory {
            Theory::Always => 0.3 * net,
            _ => net,
        }
    }

    /// Finds the limit. `None` if `stop` says so.
    pub(super) fn find(&self, teller: &dyn Teller, stop: &dyn Fn() -> bool) -> Option<Limit> {
        let net = Net::new(self.net);
        let omega_rad_per_s = net.omega_rad_per_s() * self.stiffness_n_per_m.sqrt();
        let theory_s = match self.theory {
            Theory::UpTo(limit) => Some(limit / omega_rad_per_s),
            Theory::Suited => Some(2.0 * net.suited_s(self.stiffness_n_per_m)),
            Theory::Always => None,
        };
        let unit_s = theory_s.unwrap_or(2.0 / omega_rad_per_s);
        let scene = Pushed {
            asked: self,
            net: &net,
            omega_rad_per_s,
            stop,
        };
        let parts = match self.theory {
            Theory::Always => &MULTIPLES[..],
            _ => &PARTS,
        };
        let cells = parts.iter().map(|&part| scene.cell(part, unit_s, teller));
        let cells: Vec<Cell> = cells.collect::<Option<_>>()?;
        let longest_s = parts.last().map_or(0.0, |part| part * unit_s);
        let measured_s = scene.limit_s(&cells)?;
        let is_at = match (self.theory, measured_s, theory_s) {
            (Theory::UpTo(_), Some(measured), Some(theory)) => {
                (measured / theory - 1.0).abs() < AGREEMENT
            }
            (Theory::Suited, Some(measured), Some(theory)) => measured > theory,
            (Theory::UpTo(_), ..) => false,
            (Theory::Suited, ..) => true,
            (Theory::Always, measured, _) => measured.is_none(),
        };
        Some(Limit {
            net: self.net.name(),
            stiffness_n_per_m: self.stiffness_n_per_m,
            method: self.family().name(),
            omega_rad_per_s,
            theory_s,
            is_promise: self.theory == Theory::Suited,
            measured_s,
            longest_s,
            agrees: is_at && cells.iter().all(|cell| cell.agrees(self.theory)),
            cells,
        })
    }
}

/// A net that is given a push.
struct Pushed<'a> {
    asked: &'a Asked,
    net: &'a Net,
    omega_rad_per_s: f64,
    stop: &'a dyn Fn() -> bool,
}

/// Where a limit is looked for steps are so many, and what has this many times the energy of motion that
/// it was given has blown up: at a millionth beyond the limit of Verlet it has.
const STEPS: u32 = 3000;
const GROWN: f64 = 1e6;

/// Where no step is too long, so many are taken, and no more energy may be there than so many times
/// what was: what sweeps leave in a taut net moves it.
const STEPS_ALWAYS: u32 = 300;
const GROWN_ALWAYS: f64 = 4.0;

impl Pushed<'_> {
    fn cell(&self, part: f64, unit_s: f64, teller: &dyn Teller) -> Option<Cell> {
        let dt_s = part * unit_s;
        let expected = match self.asked.theory {
            Theory::Suited if part > 1.0 => None,
            Theory::UpTo(_) if part > 1.0 => Some(Class::BlowsUp),
            _ => Some(Class::Fine),
        };
        let (unwatched, _) = self.play(dt_s, Unstable::Allow)?;
        let (watched, error) = self.play(dt_s, Unstable::Refuse)?;
        let told = error.map(|error| teller.step(&error));
        Some(Cell {
            part,
            dt_s,
            expected,
            unwatched,
            watched,
            told: told.into_iter().collect(),
        })
    }

    /// The shortest step that blows up, between two cells of which one does. The outer `None` is an
    /// interruption.
    fn limit_s(&self, cells: &[Cell]) -> Option<Option<f64>> {
        let first = cells.iter().position(|cell| cell.unwatched != Class::Fine);
        let Some(first) = first else {
            return Some(None);
        };
        let mut above = cells[first].dt_s;
        let mut below = match first {
            0 => return Some(Some(above)),
            _ => cells[first - 1].dt_s,
        };
        while above / below > 1.0 + 0.1 * AGREEMENT {
            let middle = (above * below).sqrt();
            match self.play(middle, Unstable::Allow)?.0 {
                Class::Fine => below = middle,
                _ => above = middle,
            }
        }
        Some(Some(above))
    }

    /// Takes steps, and says what came of them. `None` is an interruption.
    fn play(&self, dt_s: f64, unstable: Unstable) -> Option<(Class, Option<StepError>)> {
        let mut system = self.net.system(self.asked.stiffness_n_per_m);
        system.when_unstable(unstable);
        let is_always = self.asked.theory == Theory::Always;
        // Where a limit is looked for, motions are to stay small even when they have grown.
        let amplitude_m = self.net.edge_m() * if is_always { 1e-3 } else { 1e-9 };
        let mut random = Random::new(1);
        let mut push = || amplitude_m * self.omega_rad_per_s * (2.0 * random.next() - 1.0);
        for i in self.net.free() {
            let velocity = &mut system.state_mut().1[i];
            velocity.iter_mut().for_each(|v| *v = push());
        }
        let moving_j = energy::kinetic_j(&system);
        let (steps, most_j) = if is_always {
            let all_j = moving_j + energy::elastic_j(&system);
            (STEPS_ALWAYS, GROWN_ALWAYS * all_j)
        } else {
            (STEPS, GROWN * moving_j)
        };
        let mut solver = self.asked.method.solver();
        for _ in 0..steps {
            if (self.stop)() {
                return None;
            }
            if let Err(error) = system.step(&mut *solver as &mut dyn Solver, dt_s) {
                return Some((class(&error), Some(error)));
            }
            if !is_within(&system, most_j) {
                return Some((Class::BlowsUp, None));
            }
        }
        Some((Class::Fine, None))
    }
}

/// Written so that what is no number is beyond.
fn is_within(system: &System, most_j: f64) -> bool {
    energy::kinetic_j(system) <= most_j
}

/// How a step failed.
pub(super) fn class(error: &StepError) -> Class {
    match error {
        StepError::BlowUp { .. } => Class::BlowsUp,
        _ => Class::Refused,
    }
}

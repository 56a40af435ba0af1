//! The runs of a case: references, the gate, and every method at every step, each with an estimate of its cost.

use tearmesh_cloth::implicit::{self, Tolerance};
use tearmesh_cloth::scene::ensemble::NOISE_M;
use tearmesh_cloth::scene::{self, suggested_step_s};
use tearmesh_cloth::{Implicit, Solver, Unstable};

use super::observable::Observable;
use super::run::{Outcome, Settings, fitted_step_s, run};
use super::scene::{Case, REST_M_PER_S, Until};
use crate::experiment::Bounds;
use crate::method::{DefaultMethod, METHODS, Method, STEP_FRACTIONS, StoredEnergy};

/// A planned run of a case.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The name of the run, without the name of the case.
    pub name: String,
    /// The purpose of the run.
    pub role: Role,
    base_s: f64,
    /// The fraction of the base step that is taken.
    fraction: f64,
    /// An estimate of its visits of edges.
    pub(super) visits: f64,
}

/// The purpose of a run.
#[derive(Clone, Debug)]
pub enum Role {
    /// A reference by Verlet's method: two runs, the second with half the step, or one if the scene ends at
    /// rest.
    Verlet,
    /// A reference by Newton's method: two runs, the second with half the step, or one if the scene ends at
    /// rest.
    Newton,
    /// A run that ends at [`REST_M_PER_S`], where references go on. Its error is a lower bound of the floor.
    Rest,
    /// One of the two runs of the gate, which differ by noise.
    Gate {
        /// Whether its start has noise.
        is_disturbed: bool,
    },
    /// A method at a fraction of its base step.
    Budget {
        /// The index of the method in [`METHODS`].
        method: usize,
        /// The index of the fraction of the base step in [`STEP_FRACTIONS`].
        fraction: usize,
    },
    /// A method at its default settings.
    Default(Box<DefaultMethod>),
}

/// The speed at which references are at rest, as a fraction of [`REST_M_PER_S`].
const REST_OF_REFERENCES: f64 = 1e-1;

/// The fractions of the longest stable step that references by Verlet's method take.
const REFERENCE_FRACTIONS: [f64; 2] = [0.125, 0.0625];

/// The largest number of steps of the coarser reference by Newton's method. Up to it, those references take the
/// steps of Verlet's.
const NEWTON_STEPS: f64 = 20_000.0;

/// The step of references at rest by Newton's method, in seconds.
const REST_STEP_S: f64 = 0.02;

/// The mass ratio of the middle particle below which references are by Verlet's method with guards. Without
/// them, the light particle would make all steps ten times as short.
const LIGHT: f64 = 0.01;

/// The method of references by Verlet's method, and of the gate.
fn reference(case: &Case) -> &'static Method {
    let wanted = match case.scene.middle_mass_ratio < LIGHT {
        true => "verlet",
        false => "verlet-plain",
    };
    Method::named(wanted).expect("the methods of references are of the list")
}

/// Returns all runs of a case: the references, the gate, the budget by method and step, and the runs at
/// default settings.
///
/// # Panics
///
/// If the numbers of the scene are not usable; those of [`SCENES`](super::SCENES) are.
#[must_use]
pub fn plan(case: &Case) -> Vec<Planned> {
    let edges = case.edges.len() as f64;
    let seconds = case.scene.until.seconds();
    // Most runs come to rest, or tear, before the last moment.
    let expected_s = match case.scene.until {
        Until::Time(_) => seconds,
        Until::Rest(_) => 0.3 * seconds,
        Until::Tears(_) => 0.6 * seconds,
    };
    let planned = |name: String, role: Role, base_s: f64, fraction: f64, visits_a_step: f64| {
        let (dt_s, _) = fitted_step_s(case.scene.until, base_s, fraction);
        Planned {
            name,
            role,
            base_s,
            fraction,
            visits: expected_s / dt_s * edges * visits_a_step,
        }
    };
    let products = |dt_s: f64| {
        let reach = dt_s / case.edge_s();
        8.0 + 6.0 * reach.min(2.0 * f64::from(case.cells))
    };
    let base_s = |method: &Method| method.base_s(&mut case.system(), case.edge_s());
    let plain_s = base_s(reference(case));
    let mut runs = Vec::new();
    let is_compared = !case.scene.observables.contains(&Observable::EnergyMade);
    if is_compared {
        if let Until::Rest(_) = case.scene.until {
            let name = "reference-verlet".to_owned();
            runs.push(planned(name, Role::Verlet, plain_s, 0.5, 1.0));
            let name = "reference-newton".to_owned();
            let visits = 3.0 * products(REST_STEP_S);
            runs.push(planned(name, Role::Newton, REST_STEP_S, 1.0, visits));
            let name = "rest".to_owned();
            runs.push(planned(name, Role::Rest, plain_s, 0.5, 1.0));
        } else {
            for fraction in REFERENCE_FRACTIONS {
                let name = format!("reference-verlet@{fraction}");
                runs.push(planned(name, Role::Verlet, plain_s, fraction, 1.0));
            }
            let base_s = plain_s.max(seconds / NEWTON_STEPS / REFERENCE_FRACTIONS[0]);
            for fraction in REFERENCE_FRACTIONS {
                let name = format!("reference-newton@{fraction}");
                runs.push(planned(name, Role::Newton, base_s, fraction, 14.0));
            }
        }
        if case.scene.is_gated {
            for is_disturbed in [false, true] {
                let name = ["gate", "gate-disturbed"][usize::from(is_disturbed)].to_owned();
                let role = Role::Gate { is_disturbed };
                runs.push(planned(name, role, plain_s, 0.5, 1.0));
            }
        }
    }
    for (index, method) in METHODS.iter().enumerate() {
        let base_s = base_s(method);
        for (fraction, &of_base) in STEP_FRACTIONS.iter().enumerate() {
            let name = format!("{}@{of_base}", method.name);
            let role = Role::Budget {
                method: index,
                fraction,
            };
            let visits = match method.name {
                "rk4" | "provot" => 4.0,
                name if name.starts_with("euler-back") || name.starts_with("bdf2") => {
                    products(base_s * of_base)
                }
                _ => f64::from(method.sweeps().unwrap_or(1)),
            };
            runs.push(planned(name, role, base_s, of_base, visits));
        }
    }
    for method in DefaultMethod::all() {
        let name = format!("{}@default", method.name);
        let (mut system, speed) = (case.system(), case.speed_m_per_s());
        let base_s = suggested_step_s(&method.settings, &mut system, speed);
        let visits = match method.settings {
            scene::Method::Implicit(_) => products(base_s),
            scene::Method::Pbd(_) => 10.0,
            _ => 1.0,
        };
        let role = Role::Default(Box::new(method));
        runs.push(planned(name, role, base_s, 1.0, visits));
    }
    runs
}

impl Planned {
    /// Carries out the run, which ends where it exceeds `visits_max` visits of edges unless it is a reference.
    /// Returns `None` if it was interrupted.
    #[must_use]
    pub fn run(&self, case: &Case, visits_max: u64, bounds: &Bounds<'_>) -> Option<Outcome> {
        let mut system = case.system();
        let mut settings = Settings {
            base_s: self.base_s,
            fraction: self.fraction,
            rest_m_per_s: REST_M_PER_S,
            stored: StoredEnergy::ByLength,
            visits_max,
        };
        let mut solver: Box<dyn Solver> = match &self.role {
            Role::Verlet | Role::Newton => {
                settings.rest_m_per_s *= REST_OF_REFERENCES;
                settings.visits_max = u64::MAX;
                match self.role {
                    Role::Verlet => reference(case).solver(),
                    _ => Box::new(Implicit::new(newton(case.scene.until))),
                }
            }
            Role::Gate { is_disturbed } => {
                if *is_disturbed {
                    system = case.disturbed(NOISE_M);
                }
                reference(case).solver()
            }
            Role::Rest => reference(case).solver(),
            Role::Budget { method, .. } => {
                let method = &METHODS[*method];
                settings.stored = method.family.stored_energy();
                method.solver()
            }
            Role::Default(method) => {
                // A step that the program chose is divided where it gets too long, and not refused.
                system.when_unstable(Unstable::Substep);
                settings.stored = method.family.stored_energy();
                method.solver()
            }
        };
        run(case, system, &mut *solver, settings, bounds)
    }
}

/// Newton's method with each step solved to convergence: of second order, but at rest of the first, which comes
/// to rest.
fn newton(until: Until) -> implicit::Settings {
    let (method, tolerance) = match until {
        Until::Rest(_) => (implicit::Method::BackwardEuler, Tolerance::Fixed(1e-8)),
        Until::Time(_) => (implicit::Method::Bdf2, Tolerance::Tied(0.1)),
        // With led particles, rounding leaves less of the potential for the line search to compare.
        Until::Tears(_) => (implicit::Method::Bdf2, Tolerance::Fixed(1e-8)),
    };
    implicit::Settings {
        method,
        tolerance,
        newton_iterations_max: 40,
        ..implicit::Settings::default()
    }
}

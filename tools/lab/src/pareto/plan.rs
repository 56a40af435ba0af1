//! The runs of a case: references, the gate, and the budget, each with a name and a guess at its cost.

use tearmesh_cloth::implicit::{self, Tolerance};
use tearmesh_cloth::scene::ensemble::NOISE_M;
use tearmesh_cloth::{Implicit, Solver, Unstable};

use super::method::{METHODS, Method, Named, PARTS, Store};
use super::observable::Observable;
use super::run::{Bounds, Outcome, Settings, fitted_step_s, run};
use super::scene::{Case, REST_M_PER_S, Until};

/// A planned run of a case.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The name of the run, without the name of the case.
    pub name: String,
    /// The purpose of the run.
    pub role: Role,
    /// What a part is of, in seconds.
    base_s: f64,
    part: f64,
    /// An estimate of its visits of edges.
    pub guess: f64,
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
    /// A row of the budget.
    Budget {
        /// The index of the method in [`METHODS`].
        method: usize,
        /// The index of the fraction of the base step in [`PARTS`].
        part: usize,
    },
    /// A row at the default settings of a method.
    Named(Box<Named>),
}

/// References come to rest so much more nearly than rows, as a part.
const REST_OF_REFERENCES: f64 = 1e-1;

/// The parts of the longest stable step that references by Verlet's method take.
const VERLET_PARTS: [f64; 2] = [0.125, 0.0625];

/// References by Newton's method take the same, or where those are more than about so many steps, so
/// many and twice as many.
const NEWTON_STEPS: f64 = 20_000.0;

/// The step of references at rest by Newton's method, in seconds.
const REST_STEP_S: f64 = 0.02;

/// The lightest middle particle, as a part of its mass, with which references divide the steps of all. They
/// are a tenth as long then. Where it is lighter, they divide the steps around it alone.
const LIGHT: f64 = 0.01;

/// The method of references by Verlet's method, of the gate, and of what comes to rest beside them.
fn reference(case: &Case) -> &'static Method {
    let wanted = match case.scene.middle_mass_ratio < LIGHT {
        true => "verlet",
        false => "verlet-plain",
    };
    let found = METHODS.iter().find(|method| method.name == wanted);
    found.expect("the methods of references are of the list")
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
    // Most come to rest, or tear, before the last moment.
    let expected_s = match case.scene.until {
        Until::Time(_) => seconds,
        Until::Rest(_) => 0.3 * seconds,
        Until::Tears(_) => 0.6 * seconds,
    };
    let planned = |name: String, role: Role, base_s: f64, part: f64, a_step: f64| {
        let (dt_s, _) = fitted_step_s(case.scene.until, base_s, part);
        Planned {
            name,
            role,
            base_s,
            part,
            guess: expected_s / dt_s * edges * a_step,
        }
    };
    let products = |dt_s: f64| {
        let reach = dt_s / case.edge_s();
        8.0 + 6.0 * reach.min(2.0 * f64::from(case.cells))
    };
    let plain_s = reference(case).base_s(case);
    let mut runs = Vec::new();
    let is_compared = !case.scene.observables.contains(&Observable::EnergyMade);
    if is_compared {
        if let Until::Rest(_) = case.scene.until {
            let name = "reference-verlet".to_owned();
            runs.push(planned(name, Role::Verlet, plain_s, 0.5, 1.0));
            let name = "reference-newton".to_owned();
            let a_step = 3.0 * products(REST_STEP_S);
            runs.push(planned(name, Role::Newton, REST_STEP_S, 1.0, a_step));
            let name = "rest".to_owned();
            runs.push(planned(name, Role::Rest, plain_s, 0.5, 1.0));
        } else {
            for part in VERLET_PARTS {
                let name = format!("reference-verlet@{part}");
                runs.push(planned(name, Role::Verlet, plain_s, part, 1.0));
            }
            let base_s = plain_s.max(seconds / NEWTON_STEPS / VERLET_PARTS[0]);
            for part in VERLET_PARTS {
                let name = format!("reference-newton@{part}");
                runs.push(planned(name, Role::Newton, base_s, part, 14.0));
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
        let base_s = method.base_s(case);
        for (part, &of_base) in PARTS.iter().enumerate() {
            let name = format!("{}@{of_base}", method.name);
            let role = Role::Budget {
                method: index,
                part,
            };
            let a_step = visits_of(method, &products, base_s * of_base);
            runs.push(planned(name, role, base_s, of_base, a_step));
        }
    }
    for named in Named::all() {
        let name = format!("{}@default", named.name);
        let base_s = named.step_s(case);
        let a_step = match named.name {
            "implicit" => products(base_s),
            "pbd" => 10.0,
            _ => 1.0,
        };
        runs.push(planned(
            name,
            Role::Named(Box::new(named)),
            base_s,
            1.0,
            a_step,
        ));
    }
    runs
}

/// The steps of Newton's method on a mesh with which coarser ones are compared, as a multiple of the longest
/// stable step. What is left of them is told by the distance to Verlet's method.
const FINEST_NEWTON: f64 = 8.0;

/// The runs of a case with which those on coarser meshes are compared. By Verlet's method there is one at half
/// of its limit, which is the gate's; by Newton's there is one in longer steps.
#[must_use]
pub(crate) fn finest(case: &Case) -> Vec<Planned> {
    let mut runs = plan(case);
    if let Until::Rest(_) = case.scene.until {
        runs.retain(|run| matches!(run.role, Role::Verlet | Role::Newton | Role::Rest));
        return runs;
    }
    let base_s = FINEST_NEWTON * reference(case).base_s(case);
    let newton = runs.iter().find(|run| matches!(run.role, Role::Newton));
    let newton = newton.map(|run| Planned {
        name: "reference-newton".to_owned(),
        base_s,
        part: 1.0,
        guess: run.guess * run.part * run.base_s / base_s * 3.0,
        ..run.clone()
    });
    let is_compared = case.scene.observables.contains(&Observable::Displacement);
    runs.retain(|run| match run.role {
        Role::Gate { is_disturbed } => is_compared || !is_disturbed,
        _ => false,
    });
    runs.extend(newton);
    runs
}

/// A guess at how often a step visits each edge.
fn visits_of(method: &Method, products: &dyn Fn(f64) -> f64, dt_s: f64) -> f64 {
    let sweeps = method.name.rsplit('-').next();
    match method.name {
        "rk4" => 4.0,
        "provot" => 4.0,
        name if name.contains("pbd") => sweeps.and_then(|n| n.parse().ok()).unwrap_or(1.0),
        name if name.starts_with("euler-back") || name.starts_with("bdf2") => products(dt_s),
        _ => 1.0,
    }
}

impl Planned {
    /// Executes the run.
    #[must_use]
    pub fn carry_out(&self, case: &Case, bounds: &Bounds<'_>) -> Outcome {
        let mut system = case.system();
        let mut rest_m_per_s = REST_M_PER_S;
        let mut bounds = *bounds;
        let mut solver: Box<dyn Solver> = match &self.role {
            Role::Verlet | Role::Newton => {
                rest_m_per_s *= REST_OF_REFERENCES;
                bounds.visits_max = u64::MAX;
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
            Role::Budget { method, .. } => METHODS[*method].solver(),
            Role::Named(named) => {
                // A step of the program's own choice is not refused on the way, but divided.
                system.when_unstable(Unstable::Substep);
                named.solver()
            }
        };
        let settings = Settings {
            base_s: self.base_s,
            part: self.part,
            rest_m_per_s,
            store: match &self.role {
                Role::Budget { method, .. } => METHODS[*method].family.store(),
                Role::Named(named) => named.family.store(),
                _ => Store::Lengths,
            },
        };
        run(case, system, &mut *solver, settings, &bounds)
    }
}

/// Each step solved to the end: of second order, or at rest of the first, which comes to rest.
fn newton(until: Until) -> implicit::Settings {
    let (method, tolerance) = match until {
        Until::Rest(_) => (implicit::Method::BackwardEuler, Tolerance::Fixed(1e-8)),
        Until::Time(_) => (implicit::Method::Bdf2, Tolerance::Tied(0.1)),
        // Led particles leave less to be told in the potential that is searched along a line.
        Until::Tears(_) => (implicit::Method::Bdf2, Tolerance::Fixed(1e-8)),
    };
    implicit::Settings {
        method,
        tolerance,
        newton_iterations_max: 40,
        ..implicit::Settings::default()
    }
}

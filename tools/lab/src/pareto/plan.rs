//! The runs of a case: references, the gate, and every method at every step, each with an estimate of its cost.

use tearmesh_cloth::scene::ensemble::NOISE_M;
use tearmesh_cloth::{Solver, System, Unstable};

use super::scene::{Case, Until};
use crate::method::{DEFAULTS, Family, METHODS, Method, STEP_FRACTIONS};
use crate::reference::Reference;

/// A planned run of a case.
#[derive(Clone, Debug)]
pub(super) struct Planned {
    /// The name of the run, without the name of the case.
    pub(super) name: String,
    pub(super) role: Role,
    pub(super) dt_s: f64,
    /// The number of steps to each checkpoint; `None` if the scene has no time of its own.
    pub(super) steps_to_checkpoint: Option<u64>,
    /// An estimate of its visits of edges.
    pub(super) visits: f64,
}

/// The purpose of a run. References are two runs, the second with half the step, or one if the scene ends at
/// rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// A reference by Verlet's method.
    Verlet,
    /// A reference by Newton's method.
    Newton,
    /// A run that ends at [`REST_M_PER_S`](super::REST_M_PER_S), where references go on. Its error is a lower
    /// bound of the floor.
    Rest,
    /// The run of the gate that starts as all others do.
    Calm,
    /// The run of the gate that starts with noise.
    Noisy,
    /// A method at a fraction of its base step, or with its default step.
    Method(&'static Method, Option<f64>),
}

/// The number of checkpoints at which positions and strains are compared, evenly spaced over the time of the
/// scene. A scene that ends at rest has one, at its end.
pub(super) const CHECKPOINTS: u64 = 10;

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

/// All runs of a case: the references, the gate, the budget by method and step, and the runs at default
/// settings.
pub(super) fn plan(case: &Case) -> Vec<Planned> {
    let until = case.scene.until;
    let base_s = |method: &Method| method.base_s(&mut case.system(), case.edge_s());
    let mut runs = Vec::new();
    let mut add = |name: &str, role, base_s, fraction| {
        runs.push(Planned::new(case, name.to_owned(), role, base_s, fraction));
    };
    let plain_s = base_s(reference(case));
    match until {
        _ if case.is_of_energy() => {}
        Until::Rest(_) => {
            add("reference-verlet", Role::Verlet, plain_s, 0.5);
            add("reference-newton", Role::Newton, REST_STEP_S, 1.0);
            add("rest", Role::Rest, plain_s, 0.5);
        }
        Until::Time(seconds) | Until::Tears(seconds) => {
            let newton_s = plain_s.max(seconds / NEWTON_STEPS / REFERENCE_FRACTIONS[0]);
            for (role, base_s, name) in [
                (Role::Verlet, plain_s, "reference-verlet"),
                (Role::Newton, newton_s, "reference-newton"),
            ] {
                for fraction in REFERENCE_FRACTIONS {
                    let name = format!("{name}@{fraction}");
                    add(&name, role, base_s, fraction);
                }
            }
        }
    }
    if case.is_gated() {
        add("gate", Role::Calm, plain_s, 0.5);
        add("gate-disturbed", Role::Noisy, plain_s, 0.5);
    }
    for method in &METHODS {
        let base_s = base_s(method);
        for fraction in STEP_FRACTIONS {
            let name = format!("{}@{fraction}", method.name);
            add(
                &name,
                Role::Method(method, Some(fraction)),
                base_s,
                fraction,
            );
        }
    }
    for method in &DEFAULTS {
        let name = format!("{}@default", method.name);
        let settings = method.settings().expect("defaults are methods of scenes");
        let step_s = settings.default_step_s(&mut case.system(), case.speed_m_per_s());
        add(&name, Role::Method(method, None), step_s, 1.0);
    }
    runs
}

impl Planned {
    /// The step is the longest that is at most `fraction` of `base_s` and has a whole number to each checkpoint.
    fn new(case: &Case, name: String, role: Role, base_s: f64, fraction: f64) -> Planned {
        let (mut dt_s, mut steps_to_checkpoint) = (base_s * fraction, None);
        let mut expected_s = case.scene.until.seconds();
        match case.scene.until {
            Until::Time(seconds) => {
                let span_s = seconds / CHECKPOINTS as f64;
                let whole = |wanted: f64| (wanted - 1e-9).ceil().max(1.0);
                // From the whole number of base steps, so that half of a fraction is half of the step.
                let count = whole(whole(span_s / base_s) / fraction);
                (dt_s, steps_to_checkpoint) = (span_s / count, Some(count as u64));
            }
            // Most runs come to rest, or tear, before the last moment.
            Until::Rest(_) => expected_s *= 0.3,
            Until::Tears(_) => expected_s *= 0.6,
        }
        let products = || 8.0 + 6.0 * (dt_s / case.edge_s()).min(2.0 * f64::from(case.cells));
        let visits_a_step = match role {
            Role::Newton => products(),
            Role::Method(method, _) => match method.family {
                Family::Rk4 | Family::Provot => 4.0,
                Family::BackwardEuler | Family::Bdf2 => products(),
                _ => f64::from(method.sweeps()),
            },
            _ => 1.0,
        };
        Planned {
            name,
            role,
            dt_s,
            steps_to_checkpoint,
            visits: expected_s / dt_s * case.edges.len() as f64 * visits_a_step,
        }
    }

    /// The system at its start, and the method.
    pub(super) fn begin(&self, case: &Case) -> (System, Box<dyn Solver>) {
        let mut system = match self.role {
            Role::Noisy => case.disturbed(NOISE_M),
            _ => case.system(),
        };
        if let Role::Method(_, None) = self.role {
            // A step that the program chose is divided where it gets too long, and not refused.
            system.when_unstable(Unstable::Substep);
        }
        let solver = match self.role {
            Role::Newton => match case.scene.until {
                Until::Rest(_) => Box::new(Reference::to_rest()),
                Until::Time(_) | Until::Tears(_) => Box::new(Reference::new(&[])),
            },
            Role::Method(method, _) => method.solver(),
            _ => reference(case).solver(),
        };
        (system, solver)
    }

    /// The method that is measured; `None` for references and the gate.
    pub(super) fn method(&self) -> Option<&'static Method> {
        match self.role {
            Role::Method(method, _) => Some(method),
            _ => None,
        }
    }

    /// Whether the run is a reference, which has no limit of visits and comes nearer to rest.
    pub(super) fn is_reference(&self) -> bool {
        matches!(self.role, Role::Verlet | Role::Newton)
    }
}

//! What is run at a place: the swing, as far as it is planned for a few methods, and how much each run may
//! cost.

use super::place::QUESTIONS;
use crate::pareto::{
    Bounds, Case, Family, METHODS, MeshKind, Method, Observable, Outcome, PARTS, Planned, Role,
    SCENES, Scene, Status, plan,
};

/// The observables that are compared, which are those of the questions.
const ASKED: &[Observable] = &[QUESTIONS[0].observable, QUESTIONS[1].observable];

/// All that is run at a place of the plane.
pub(super) struct Job {
    /// The stiffness in N/m, and the mass ratio.
    pub(super) place: (f64, f64),
    pub(super) case: Case,
    pub(super) plan: Vec<Planned>,
    pub(super) visits_max: u64,
}

impl Job {
    pub(super) fn new(
        (stiffness_n_per_m, mass_ratio): (f64, f64),
        cells: u32,
        methods: &[&str],
        cost_max: f64,
    ) -> Job {
        let scene = Scene {
            stiffness_n_per_m,
            middle_mass_ratio: mass_ratio,
            observables: ASKED,
            ..swing()
        };
        let case = Case::new(&scene, MeshKind::Grid, cells);
        let all = plan(&case);
        let unit = all.iter().find(|planned| is_unit(&planned.role));
        let unit = unit.expect("each method has its base step in the budget");
        let visits_max = (cost_max * unit.guess) as u64;
        let families: Vec<Family> = METHODS
            .iter()
            .filter(|method| methods.contains(&method.name))
            .map(|method| method.family)
            .collect();
        let is_wanted = |planned: &Planned| match &planned.role {
            Role::Verlet | Role::Newton | Role::Rest | Role::Gate { .. } => true,
            Role::Budget { method, .. } => methods.contains(&METHODS[*method].name),
            Role::Named(named) => families.contains(&named.family),
        };
        Job {
            place: (stiffness_n_per_m, mass_ratio),
            plan: all.into_iter().filter(is_wanted).collect(),
            case,
            visits_max,
        }
    }

    /// An estimate of all visits of edges.
    pub(super) fn guess(&self) -> f64 {
        self.plan.iter().map(|planned| self.guess_of(planned)).sum()
    }

    /// An estimate of the visits of a run, which is nothing if it is not begun.
    pub(super) fn guess_of(&self, planned: &Planned) -> f64 {
        match planned.role {
            Role::Verlet | Role::Newton | Role::Gate { .. } => planned.guess,
            _ if self.is_too_dear(planned) => 0.0,
            _ => planned.guess.min(self.visits_max as f64),
        }
    }

    pub(super) fn name_of(&self, planned: &Planned) -> String {
        let (stiffness, ratio) = self.place;
        format!("{stiffness:e} N/m, ratio {ratio:e}: {}", planned.name)
    }

    /// Executes a run, unless its steps and sweeps alone cost more than it may.
    pub(super) fn carry_out(&self, planned: &Planned, bounds: &Bounds<'_>) -> Outcome {
        if (bounds.stop)() {
            return Outcome::interrupted();
        }
        if self.is_too_dear(planned) {
            let visits = planned.guess;
            return Outcome {
                status: Status::TooDear,
                why: format!("not begun: it takes at least {visits:.0} visits of edges"),
                ..Outcome::interrupted()
            };
        }
        let mut bounds = *bounds;
        if let Role::Gate { .. } = planned.role {
            // Without it nothing would be known of displacements where one light particle shortens its steps.
            bounds.visits_max = u64::MAX;
        }
        planned.carry_out(&self.case, &bounds)
    }

    /// Whether what is planned is a row that costs more than it may, as far as that can be known before: the
    /// visits of implicit methods cannot.
    fn is_too_dear(&self, planned: &Planned) -> bool {
        let Role::Budget { method, .. } = planned.role else {
            return false;
        };
        let family = METHODS[method].family;
        let is_known = !matches!(family, Family::BackwardEuler | Family::Bdf2);
        is_known && planned.guess > self.visits_max as f64
    }
}

fn swing() -> Scene {
    let found = SCENES.into_iter().find(|scene| scene.name == "swing");
    found.expect("the swing is a scene of the list")
}

/// Whether it is the run whose cost is the unit of the largest cost.
fn is_unit(role: &Role) -> bool {
    match role {
        Role::Budget { method, part } => {
            let Method { name, .. } = METHODS[*method];
            name == "verlet" && PARTS[*part] == 1.0
        }
        _ => false,
    }
}

//! The runs of a case: references, the gate, and every method at every step. A method takes a scene to its end, and
//! the observables are recorded on the way.
//!
//! A run that does not get there has a status, the reason, and its cost up to then.

use tearmesh_cloth::{StepError, Unstable};

use super::observe::Probe;
use super::row::{Planned, Role, Row};
use super::scene::{Case, REST_M_PER_S, Until, fastest_m_per_s};
use crate::ensemble::NOISE_M;
use crate::experiment::{Bounds, Status};
use crate::method::{DEFAULTS, Family, METHODS, Method, STEP_FRACTIONS};
use crate::reference::Reference;

/// The number of checkpoints at which positions and strains are compared, evenly spaced over the time of the
/// scene. A scene that ends at rest has one, at its end.
const CHECKPOINTS: u64 = 10;

/// The fractions of the longest stable step that references by Verlet's method take.
const REFERENCE_FRACTIONS: [f64; 2] = [0.125, 0.0625];

/// The largest number of steps of the coarser reference by Newton's method. Up to it, those references take the
/// steps of Verlet's.
const NEWTON_STEPS: f64 = 20_000.0;

/// The longest step of references at rest by Newton's method, in seconds.
const REST_STEP_S: f64 = 0.02;

/// The number of edges that a pull travels in such a step at most. A flat sheet has no stiffness out of its plane, so
/// a step that takes it far from there is not solved for.
const REST_STEP_EDGES: f64 = 100.0;

/// The mass ratio of the middle particle below which references are by Verlet's method with guards. Without
/// them, the light particle would make all steps ten times as short.
const LIGHT: f64 = 0.01;

/// The method of references by Verlet's method, and of the gate.
fn reference(case: &Case) -> &'static Method {
    let is_light = case.scene.middle_mass_ratio < LIGHT;
    let wanted = if is_light { "verlet" } else { "verlet-plain" };
    Method::named(wanted).expect("the methods of references are of the list")
}

/// The keys of all runs of a case with its index: the references, the gate, the budget by method and step, and the
/// runs at default settings.
pub(super) fn plan(case: &Case, index: usize) -> Vec<Row> {
    let base_s = |method: &Method| method.base_s(&mut case.system(), case.edge_s());
    let plain_s = base_s(reference(case));
    let mut keys = Vec::new();
    let mut add = |run: &str, role, base_s, fraction| {
        let mut key = key(case, role, None, base_s, fraction);
        run.clone_into(&mut key.run);
        keys.push(key);
    };
    match case.scene.until {
        _ if case.is_of_energy() => {}
        Until::Rest(_) => {
            add("reference-verlet", Role::Verlet, plain_s, 0.5);
            let newton_s = REST_STEP_S.min(REST_STEP_EDGES * case.edge_s());
            add("reference-newton", Role::Newton, newton_s, 1.0);
            add("rest", Role::Rest, plain_s, 0.5);
        }
        Until::Time(seconds) | Until::Tears(seconds) => {
            let newton_s = plain_s.max(seconds / NEWTON_STEPS / REFERENCE_FRACTIONS[0]);
            for (role, base_s, name) in [
                (Role::Verlet, plain_s, "reference-verlet"),
                (Role::Newton, newton_s, "reference-newton"),
            ] {
                for fraction in REFERENCE_FRACTIONS {
                    add(&format!("{name}@{fraction}"), role, base_s, fraction);
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
        keys.extend(STEP_FRACTIONS.map(|fraction| Row {
            run: format!("{}@{fraction}", method.name),
            step_fraction: Some(fraction),
            ..key(case, Role::Method, Some(method), base_s, fraction)
        }));
    }
    keys.extend(DEFAULTS.iter().map(|method| {
        let settings = method.settings().expect("defaults are methods of scenes");
        let step_s = settings.default_step_s(&mut case.system(), case.speed_m_per_s());
        Row {
            run: format!("{}@default", method.name),
            ..key(case, Role::Method, Some(method), step_s, 1.0)
        }
    }));
    for key in &mut keys {
        key.planned.case = index;
    }
    keys
}

/// A key without the name of the run. The step is the longest that is at most `fraction` of `base_s` and has a whole
/// number to each checkpoint.
fn key(case: &Case, role: Role, method: Option<&Method>, base_s: f64, fraction: f64) -> Row {
    let Case {
        scene, mesh, cells, ..
    } = *case;
    let (mut dt_s, mut steps_to_checkpoint) = (base_s * fraction, None);
    let mut expected_s = scene.until.seconds();
    match scene.until {
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
    let products = 8.0 + 6.0 * (dt_s / case.edge_s()).min(2.0 * f64::from(cells));
    let visits_a_step = match (role, method.map(|method| method.family)) {
        (Role::Newton, _) | (_, Some(Family::BackwardEuler | Family::Bdf2)) => products,
        (_, Some(Family::Rk4 | Family::Provot)) => 4.0,
        _ => method.map_or(1.0, |method| method.sweeps().into()),
    };
    Row {
        scene: scene.name.to_owned(),
        mesh,
        cells,
        stiffness_n_per_m: scene.stiffness_n_per_m,
        mass_ratio: scene.middle_mass_ratio,
        family: method.map(|method| method.family),
        method: method.map_or("reference", |method| method.name).to_owned(),
        dt_s,
        planned: Planned {
            role,
            steps_to_checkpoint,
            visits: expected_s / dt_s * case.edges.len() as f64 * visits_a_step,
            ..Planned::default()
        },
        ..Row::default()
    }
}

/// The speed at which references are at rest, as a fraction of [`REST_M_PER_S`].
const REST_OF_REFERENCES: f64 = 1e-1;

/// Carries out the run of a key, which ends where it exceeds `visits_max` visits of edges unless it is a reference.
/// Returns `None` if it was interrupted.
pub(super) fn run(case: &Case, key: &Row, visits_max: u64, bounds: &Bounds<'_>) -> Option<Row> {
    let (until, dt_s, planned) = (case.scene.until, key.dt_s, key.planned);
    let (rest_m_per_s, visits_max) = match planned.role.is_reference() {
        true => (REST_M_PER_S * REST_OF_REFERENCES, u64::MAX),
        false => (REST_M_PER_S, visits_max),
    };
    let steps_max = match planned.steps_to_checkpoint {
        Some(count) => count * CHECKPOINTS,
        None => ((until.seconds() / dt_s) - 1e-9).ceil().max(1.0) as u64,
    };
    // Energy is checked 400 times, and rest every hundredth of a second.
    let every = (steps_max / 400).max(1);
    let rest_every = ((0.01 / dt_s) as u64).max(1);
    let method = Method::named(&key.method);
    let mut system = match planned.role {
        Role::Noisy => case.disturbed(NOISE_M),
        _ => case.system(),
    };
    if method.is_some() && key.step_fraction.is_none() {
        // A step that the program chose is divided where it gets too long, and not refused.
        system.when_unstable(Unstable::Substep);
    }
    let mut solver = match (planned.role, until) {
        (Role::Newton, Until::Rest(_)) => Box::new(Reference::to_rest()),
        (Role::Newton, _) => Box::new(Reference::new(&[])),
        _ => method.unwrap_or_else(|| reference(case)).solver(),
    };
    let mut probe = Probe::new(case, &system, key.family);
    let (mut status, mut why, mut visits) = (Status::Restless, String::new(), 0);
    for number in 1..=steps_max {
        if (bounds.stop)() {
            return None;
        }
        let step = system.step(&mut *solver, dt_s);
        let counted = system.counters().visits;
        visits = counted.project + counted.force + counted.detect;
        if let Err(error) = step {
            (status, why) = (status_of(&error), error.to_string());
            break;
        }
        probe.step(&system, dt_s);
        let is_nth = |count: u64| number.is_multiple_of(count);
        if planned.steps_to_checkpoint.is_some_and(is_nth) {
            probe.checkpoint(&system);
        }
        let is_last = number == steps_max;
        let has_ended = match until {
            Until::Time(_) => is_last,
            Until::Rest(_) => is_nth(rest_every) && fastest_m_per_s(&system) < rest_m_per_s,
            Until::Tears(_) => probe.has_torn(),
        };
        let mut ended = has_ended.then_some(Status::Ok);
        if visits > visits_max && !is_last {
            ended = Some(Status::TooDear);
        }
        if (is_nth(every) || is_last)
            && let Some(grown) = probe.energy(&system)
        {
            ended = Some(Status::BlownUp);
            why = format!("{grown:.2} times the energy that was put in");
        }
        if let Some(ended) = ended {
            status = ended;
            break;
        }
    }
    if matches!(until, Until::Rest(_)) && status == Status::Ok {
        probe.checkpoint(&system);
    }
    Some(Row {
        status,
        why,
        visits: Some(visits),
        records: probe.records(&system),
        ..key.clone()
    })
}

/// The status of a run in which a step failed.
pub(crate) fn status_of(error: &StepError) -> Status {
    match error {
        StepError::BlowUp { .. } => Status::BlownUp,
        StepError::Implicit { .. } => Status::Unsolved,
        _ => Status::Refused,
    }
}

//! What the runs of a scene say: their errors against the finest mesh.

use super::measure::{Measure, Places, Reading};
use super::row::{Error, Floor, ReferenceRun, Row, SceneStudy};
use super::scene::SpaceScene;
use crate::pareto::{self, Case, METHODS, Outcome, PARTS, Planned, Role, Status};

/// A run and what came of it.
pub(super) struct Ran<'a> {
    pub(super) case: &'a Case,
    pub(super) planned: &'a Planned,
    pub(super) outcome: &'a Outcome,
}

/// A run that was read, where it came to its end.
struct Told<'a> {
    ran: &'a Ran<'a>,
    reading: Option<Reading>,
}

/// Computes the results of a scene from its runs, which are read on a lattice of so many cells.
pub(super) fn assess(scene: SpaceScene, lattice: u32, ran: &[Ran<'_>]) -> SceneStudy {
    let mut told: Vec<Told<'_>> = Vec::new();
    for runs in ran.chunk_by(|a, b| a.case.cells == b.case.cells) {
        let case = runs[0].case;
        let places = Places::new(case, lattice);
        told.extend(runs.iter().map(|ran| {
            Told {
                ran,
                reading: (ran.outcome.status == Status::Ok)
                    .then(|| Reading::of(case, &places, &ran.outcome.records)),
            }
        }));
    }
    let (rows, finest): (Vec<Told<'_>>, Vec<Told<'_>>) = told
        .into_iter()
        .partition(|told| matches!(told.ran.planned.role, Role::Budget { .. }));
    let (amplification, is_barred) = gate(&finest);
    let measures: Vec<Measure> = scene
        .measures()
        .iter()
        .copied()
        .filter(|&measure| !(is_barred && measure == Measure::Displacement))
        .collect();
    let reference = verlet(&finest);
    let floors: Vec<Floor> = measures
        .iter()
        .map(|&measure| Floor {
            measure,
            value: reference.and_then(|reading| reading.number(measure)),
            floor: floor(&finest, measure),
        })
        .collect();
    let errors = |told: &Told<'_>| errors(told, &rows, &floors, reference);
    let mut study = SceneStudy {
        scene: scene.name().to_owned(),
        about: scene.about().to_owned(),
        amplification,
        is_barred,
        references: finest.iter().map(of_reference).collect(),
        rows: rows.iter().map(|told| row(told, errors(told))).collect(),
        floors,
    };
    study.rank();
    study
}

/// How much noise grows on the finest mesh, and whether that bars displacements.
fn gate(finest: &[Told<'_>]) -> (Option<f64>, bool) {
    let is_gate = |told: &&Told<'_>| matches!(told.ran.planned.role, Role::Gate { .. });
    let gate = finest.iter().filter(is_gate).map(|told| told.ran);
    let (plan, outcomes): (Vec<Planned>, Vec<Outcome>) = gate
        .map(|ran| (ran.planned.clone(), ran.outcome.clone()))
        .unzip();
    let Some(case) = finest.first().map(|told| told.ran.case) else {
        return (None, false);
    };
    let assessed = pareto::assess(case, &plan, &outcomes);
    (assessed.amplification, assessed.is_barred)
}

/// The first of the finest mesh's runs of a role, where it came to its end.
fn of_role<'a>(finest: &'a [Told<'_>], wanted: fn(&Role) -> bool) -> Option<&'a Reading> {
    let found = finest.iter().find(|told| wanted(&told.ran.planned.role))?;
    found.reading.as_ref()
}

/// The run that stands for the truth.
fn verlet<'a>(finest: &'a [Told<'_>]) -> Option<&'a Reading> {
    of_role(finest, |role| {
        let is_calm = matches!(
            role,
            Role::Gate {
                is_disturbed: false
            }
        );
        is_calm || matches!(role, Role::Verlet)
    })
}

/// How well the finest mesh's value is known.
fn floor(finest: &[Told<'_>], measure: Measure) -> Option<f64> {
    let verlet = verlet(finest)?;
    let newton = of_role(finest, |role| matches!(role, Role::Newton))?;
    let apart = newton.apart(verlet, verlet, measure)?;
    let is_rest = |told: &Told<'_>| matches!(told.ran.planned.role, Role::Rest);
    // And what is left where rows end at rest.
    let rest = match finest.iter().find(|told| is_rest(told)) {
        Some(told) => told.reading.as_ref()?.apart(verlet, verlet, measure)?,
        None => 0.0,
    };
    Some(apart.max(rest))
}

fn errors(
    told: &Told<'_>,
    rows: &[Told<'_>],
    floors: &[Floor],
    reference: Option<&Reading>,
) -> Vec<Error> {
    let (Some(reading), Some(reference)) = (&told.reading, reference) else {
        return Vec::new();
    };
    let shortest = shortest(told, rows);
    let known = floors.iter().filter(|known| known.floor.is_some());
    let each = known.filter_map(|known| {
        let measure = known.measure;
        let total = reading.apart(reference, reference, measure)?;
        Some(Error {
            measure,
            value: reading.number(measure),
            total,
            of_step: shortest.and_then(|limit| reading.apart(limit, reference, measure)),
            of_mesh: shortest.and_then(|limit| limit.apart(reference, reference, measure)),
            vouched: total,
            is_at_floor: false,
            is_on_front: false,
            buy: None,
        })
    });
    each.collect()
}

/// The shortest step of the same method on the same mesh, where it came to its end.
fn shortest<'a>(told: &Told<'_>, rows: &'a [Told<'_>]) -> Option<&'a Reading> {
    let (method, _) = budget(&told.ran.planned.role);
    let own = rows.iter().filter(|other| {
        let is_same_mesh = other.ran.case.cells == told.ran.case.cells;
        is_same_mesh && budget(&other.ran.planned.role).0 == method
    });
    let last = own.max_by_key(|other| budget(&other.ran.planned.role).1)?;
    last.reading.as_ref()
}

/// The places of the method and of the part of a row.
fn budget(role: &Role) -> (usize, usize) {
    match *role {
        Role::Budget { method, part } => (method, part),
        _ => unreachable!("rows are of the budget"),
    }
}

fn row(told: &Told<'_>, errors: Vec<Error>) -> Row {
    let (method, part) = budget(&told.ran.planned.role);
    let outcome = told.ran.outcome;
    Row {
        method: METHODS[method].name.to_owned(),
        family: METHODS[method].family,
        cells: told.ran.case.cells,
        part: PARTS[part],
        dt_s: Some(outcome.dt_s).filter(|dt_s| dt_s.is_finite()),
        status: outcome.status,
        why: outcome.why.clone(),
        steps: outcome.cost.steps,
        visits: outcome.cost.visits(),
        errors,
    }
}

fn of_reference(told: &Told<'_>) -> ReferenceRun {
    let outcome = told.ran.outcome;
    ReferenceRun {
        name: told.ran.planned.name.clone(),
        status: outcome.status,
        why: outcome.why.clone(),
        dt_s: Some(outcome.dt_s).filter(|dt_s| dt_s.is_finite()),
        visits: outcome.cost.visits(),
    }
}

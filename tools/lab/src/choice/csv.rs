//! The figures of a study as a table.

use std::fmt::Write as _;

use super::policy::POLICIES;
use super::task::{Motion, Task};
use super::{Study, Trial};
use crate::parts::{Missing, cell};

/// Returns the study as CSV: one line per task, one per run, and one per demand, task and policy.
///
/// The first column is `task`, `run`, `policy` or `missing`. The columns named after observables are the floors of a task
/// or the errors of a run. In a line of a policy, `series` is the name of the policy.
#[must_use]
pub fn csv(study: &Study) -> String {
    let mut text = String::from(
        "what,number,motion,pretension,stiffness_n_per_m,cells,mesh,drag_per_s,middle_mass_ratio,\
         tolerance,series,part,dt_s,status,visits,displacement,edge_force_rms,reaction_largest,\
         demand,over_cheapest,why\n",
    );
    for trial in &study.trials {
        tell(trial, &mut text);
    }
    for ranking in &study.rankings {
        let demand = ranking.demand.name();
        for standing in &ranking.standings {
            let each = POLICIES
                .iter()
                .zip(&standing.ratios)
                .zip(&standing.is_missed);
            for ((policy, ratio), is_missed) in each {
                let status = if *is_missed { "missed" } else { "met" };
                writeln!(
                    text,
                    "policy,{},,,,,,,,,\"{}\",,,{status},,,,,{demand},{ratio:.4},",
                    standing.number, policy.name
                )
                .expect("a string grows");
            }
        }
        for unknown in &ranking.unknown {
            let (number, why) = (unknown.number, unknown.why.name());
            writeln!(text, "policy,{number},,,,,,,,,,,,{why},,,,,{demand},,")
                .expect("a string grows");
        }
    }
    for Missing { part, why } in &study.missing {
        let [before, behind] = [11, 7].map(|count| ",".repeat(count));
        writeln!(text, "missing,{part}{before},missing{behind}{}", cell(why))
            .expect("a string grows");
    }
    text
}

fn tell(trial: &Trial, text: &mut String) {
    let number = trial.task.number;
    let status = match trial.unsolved.is_empty() {
        true => "ok",
        false => "no reference",
    };
    writeln!(
        text,
        "task,{},,,,{status},{},{},,,",
        of(&trial.task),
        trial.reference_visits,
        three(trial.floors)
    )
    .expect("a string grows");
    for run in &trial.runs {
        writeln!(
            text,
            "run,{number},,,,,,,,,{},{},{},{},{},{},,,",
            run.series,
            run.part
                .map_or("default".to_owned(), |part| part.to_string()),
            short(run.dt_s),
            run.status.name(),
            run.visits,
            three(run.errors)
        )
        .expect("a string grows");
    }
}

/// The numbers of a task.
fn of(task: &Task) -> String {
    let pretension = match task.motion {
        Motion::Taut(part) => Some(part),
        Motion::Swing | Motion::Fall => None,
    };
    format!(
        "{},{},{},{:.4e},{},{},{:.4e},{:.4e},{:.4}",
        task.number,
        task.motion.name(),
        short(pretension),
        task.stiffness_n_per_m,
        task.cells,
        if task.is_delaunay { "delaunay" } else { "grid" },
        task.drag_per_s,
        task.middle_mass_ratio,
        task.tolerance
    )
}

fn three(numbers: [Option<f64>; 3]) -> String {
    numbers.map(short).join(",")
}

fn short(number: Option<f64>) -> String {
    number.map_or(String::new(), |x| format!("{x:.4e}"))
}

//! The figures of a study as a table.

use std::fmt::Write as _;

use super::{CaseStudy, Error, Row, Study};
use crate::parts::{Missing, cell};

/// Returns the study as CSV: one line per row and observable, and one for a row without errors.
///
/// A cell is empty if there is no value. A missing part has one line, with the status `missing`. The runs of references and of the gate have the series `reference`.
#[must_use]
pub fn csv(study: &Study) -> String {
    let mut text = String::from(
        "run,method,series,part,default,status,dt_s,simulated_s,steps,visits_project,visits_force,\
         visits_other,cpu_s,cpu_least_s,cpu_median_s,observable,floor,error_total,error_model,\
         error_discretisation,error_vouched,rising,at_floor,front,front_by_time,why\n",
    );
    for case in &study.cases {
        for row in &case.rows {
            let mut errors = row.errors.iter().peekable();
            if errors.peek().is_none() {
                line(&mut text, case, row, None);
            }
            errors.for_each(|error| line(&mut text, case, row, Some(error)));
        }
        for run in &case.references {
            let cost = run.cost;
            writeln!(
                text,
                "{}/{},,reference,,false,{},{},,{},{},{},{},{},,,,,,,,,,,,,{}",
                case.name,
                run.name,
                run.status.name(),
                short(run.dt_s),
                cost.steps,
                cost.project,
                cost.force,
                cost.other,
                short(cost.cpu_s),
                run.why.replace(',', ";"),
            )
            .expect("a string grows");
        }
    }
    for Missing { part, why } in &study.missing {
        let empty = ",".repeat(20);
        writeln!(text, "{part},,,,false,missing{empty}{}", cell(why)).expect("a string grows");
    }
    text
}

fn line(text: &mut String, case: &CaseStudy, row: &Row, error: Option<&Error>) {
    let cost = row.cost;
    let part = row.part.map_or(String::new(), |part| part.to_string());
    let [least, median] = row.repeated_s.map_or([None; 2], |both| both.map(Some));
    write!(
        text,
        "{},{},{},{part},{},{},{},{},{},{},{},{},{},{},{}",
        row.run,
        row.family.name().replace(',', ""),
        row.series,
        row.is_default,
        row.status.name(),
        short(row.dt_s),
        short(Some(row.simulated_s)),
        cost.steps,
        cost.project,
        cost.force,
        cost.other,
        short(cost.cpu_s),
        short(least),
        short(median),
    )
    .expect("a string grows");
    match error {
        None => text.push_str(",,,,,,,,,,"),
        Some(error) => {
            let floors = case.floors.iter();
            let known = floors.filter(|known| known.observable == error.observable);
            write!(
                text,
                ",{},{},{},{},{},{},{},{},{},{}",
                error.observable.name(),
                short(known.filter_map(|known| known.floor).next()),
                short(Some(error.total)),
                short(error.model),
                short(error.discretisation),
                short(Some(error.vouched)),
                error.is_rising,
                error.is_at_floor,
                error.is_on_front,
                error.is_on_front_by_time,
            )
            .expect("a string grows");
        }
    }
    writeln!(text, ",{}", row.why.replace(',', ";")).expect("a string grows");
}

/// Four digits: what a run is known to. Empty for nothing, and for what is not a number.
fn short(number: Option<f64>) -> String {
    match number {
        Some(number) if number.is_finite() => format!("{number:.3e}"),
        _ => String::new(),
    }
}

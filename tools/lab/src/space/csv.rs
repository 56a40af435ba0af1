//! The figures of a study as a table.

use std::fmt::Write as _;

use super::{Buy, Error, Floor, Row, SceneStudy, Study};
use crate::parts::{Missing, cell};

/// Returns the study as CSV: one line per row and measure, and one for a row without errors.
///
/// A cell is empty if there is no value. The runs on the finest mesh have no method and no part.
#[must_use]
pub fn csv(study: &Study) -> String {
    let mut text = String::from(
        "scene,method,cells,part,status,dt_s,steps,visits,measure,value,finest_value,floor,error_total,\
         error_of_step,error_of_mesh,error_vouched,at_floor,front,fall_by_step,fall_by_mesh,\
         rate_of_step,rate_of_mesh,better,why\n",
    );
    for scene in &study.scenes {
        for row in &scene.rows {
            if row.errors.is_empty() {
                line(&mut text, scene, row, None);
            }
            for error in &row.errors {
                line(&mut text, scene, row, Some(error));
            }
        }
        for run in &scene.references {
            writeln!(
                text,
                "{}/{},,{},,{},{},,{},,,,,,,,,,,,,,,,{}",
                scene.scene,
                run.name,
                study.finest,
                run.status.name(),
                short(run.dt_s),
                run.visits,
                run.why.replace(',', ";"),
            )
            .expect("a string grows");
        }
    }
    for Missing { part, why } in &study.missing {
        let empty = ",".repeat(19);
        writeln!(text, "{part},,,,missing{empty}{}", cell(why)).expect("a string grows");
    }
    text
}

fn line(text: &mut String, scene: &SceneStudy, row: &Row, error: Option<&Error>) {
    write!(
        text,
        "{},{},{},{},{},{},{},{}",
        scene.scene,
        row.method,
        row.cells,
        row.part,
        row.status.name(),
        short(row.dt_s),
        row.steps,
        row.visits,
    )
    .expect("a string grows");
    match error {
        None => text.push_str(&",".repeat(15)),
        Some(error) => {
            let mut floors = scene.floors.iter();
            let known = floors.find(|known| known.measure == error.measure);
            cells(text, error, known);
        }
    }
    writeln!(text, ",{}", row.why.replace(',', ";")).expect("a string grows");
}

fn cells(text: &mut String, error: &Error, known: Option<&Floor>) {
    let of_buy = |of: fn(&Buy) -> Option<f64>| short(error.buy.as_ref().and_then(of));
    write!(
        text,
        ",{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
        error.measure.name(),
        short(error.value),
        short(known.and_then(|known| known.value)),
        short(known.and_then(|known| known.floor)),
        short(Some(error.total)),
        short(error.of_step),
        short(error.of_mesh),
        short(Some(error.vouched)),
        error.is_at_floor,
        error.is_on_front,
        of_buy(|buy| buy.by_step),
        of_buy(|buy| buy.by_mesh),
        of_buy(|buy| buy.rate_of_step),
        of_buy(|buy| buy.rate_of_mesh),
        error.buy.map_or("", |buy| buy.better.name()),
    )
    .expect("a string grows");
}

/// Four digits: what a run is known to. Empty for nothing.
fn short(number: Option<f64>) -> String {
    number.map_or(String::new(), |number| format!("{number:.3e}"))
}

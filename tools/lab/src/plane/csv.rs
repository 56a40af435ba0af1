//! The figures of a study as a table.

use std::fmt::Write as _;

use super::{Answer, Place, Study};
use crate::parts::{Missing, cell};

/// Returns the study as CSV: one line per place, tolerance and family, then one per run.
///
/// The first column is `answer`, `line`, `reference` or `run`. A cell is empty if there is no value.
#[must_use]
pub fn csv(study: &Study) -> String {
    let mut text = String::from(
        "what,stiffness_n_per_m,mass_ratio,method,run,status,dt_s,steps,visits,observable,tolerance,\
         floor,error_total,error_vouched,known,at_most,cut_short,cheapest,why\n",
    );
    for place in &study.places {
        for answer in &place.answers {
            answer_lines(&mut text, place, answer);
        }
    }
    line_lines(&mut text, study);
    for place in &study.places {
        reference_lines(&mut text, place);
        run_lines(&mut text, place);
    }
    for Missing { part, why } in &study.missing {
        let empty = ",".repeat(13);
        writeln!(text, "missing,,,,{part},missing{empty}{}", cell(why)).expect("a string grows");
    }
    text
}

fn answer_lines(text: &mut String, place: &Place, answer: &Answer) {
    let winner = answer.winner().map(|winner| winner.family);
    for cost in &answer.costs {
        writeln!(
            text,
            "answer,{},{},{},,,,{},{},{},{},,,{},{},{},{},{}",
            at(place),
            quoted(cost.family.name()),
            cost.run.as_deref().unwrap_or_default(),
            cost.visits
                .map_or(String::new(), |visits| visits.to_string()),
            answer.asked.observable.name(),
            answer.asked.tolerance,
            short(answer.floor),
            answer.is_known,
            cost.is_at_most,
            cost.is_cut_short,
            winner == Some(cost.family),
            if answer.is_barred {
                "barred: noise grows"
            } else {
                ""
            },
        )
        .expect("a string grows");
    }
}

/// A change of who is cheaper, at its stiffness, with the cheaper one above it.
fn line_lines(text: &mut String, study: &Study) {
    for line in &study.lines {
        for crossing in &line.crossings {
            let above = if crossing.is_to_xpbd {
                "XPBD"
            } else {
                line.opponent.name()
            };
            writeln!(
                text,
                "line,{},{:e},{},,,,,,{},{},,,,,,,,cheaper from {:e} to {:e} on: {}",
                short(crossing.at_n_per_m),
                line.mass_ratio,
                quoted(line.opponent.name()),
                line.asked.observable.name(),
                line.asked.tolerance,
                crossing.from_n_per_m,
                crossing.to_n_per_m,
                above.replace(',', ""),
            )
            .expect("a string grows");
        }
    }
}

fn reference_lines(text: &mut String, place: &Place) {
    for of in &place.references {
        writeln!(
            text,
            "reference,{},,{},{},,{},{},,,,,,,,,,{}",
            at(place),
            of.run,
            of.status.name(),
            of.steps,
            of.visits,
            quoted(&of.why),
        )
        .expect("a string grows");
    }
}

fn run_lines(text: &mut String, place: &Place) {
    for run in &place.runs {
        let head = format!(
            "run,{},{},{},{},{},{},{}",
            at(place),
            quoted(run.family.name()),
            run.run,
            run.status.name(),
            short(run.dt_s),
            run.steps,
            run.visits,
        );
        if run.errors.is_empty() {
            writeln!(text, "{head},,,,,,,,,,{}", quoted(&run.why)).expect("a string grows");
        }
        for error in &run.errors {
            writeln!(
                text,
                "{head},{},,,{},{},,,,,",
                error.observable.name(),
                short(Some(error.total)),
                short(Some(error.vouched)),
            )
            .expect("a string grows");
        }
    }
}

fn at(place: &Place) -> String {
    format!("{:e},{:e}", place.stiffness_n_per_m, place.mass_ratio)
}

/// In quotes if there is a comma.
fn quoted(words: &str) -> String {
    match words.contains([',', '"']) {
        true => format!("\"{}\"", words.replace('"', "\"\"")),
        false => words.to_owned(),
    }
}

fn short(number: Option<f64>) -> String {
    number.map_or(String::new(), |x| format!("{x:.4e}"))
}

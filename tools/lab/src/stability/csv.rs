//! The figures of a study as a table.

use std::fmt::Write as _;

use super::{Study, Told};
use crate::parts::{Missing, cell};

/// Returns the study as CSV: one line per limit, one per step of a limit, and one per scene and method.
///
/// The first column is `limit`, `step` or `scene`. In a line of a limit, `dt_s` is the measured limit. A missing
/// limit or scene has a line `missing` with its name, and the reason in the last column.
#[must_use]
pub fn csv(study: &Study) -> String {
    let mut text = String::from(
        "what,where,stiffness_n_per_m,method,part,dt_s,theory_s,expected,measured,watched,measure,\
         agrees,silent,codes,words\n",
    );
    let short = |number: Option<f64>| number.map_or(String::new(), |x| format!("{x:.4e}"));
    for limit in &study.limits {
        let name = format!(
            "{},{:e},{}",
            limit.net, limit.stiffness_n_per_m, limit.method
        );
        writeln!(
            text,
            "limit,{name},,{},{},,,,,{},,,",
            short(limit.measured_s),
            short(limit.theory_s),
            limit.agrees
        )
        .expect("a string grows");
        for cell in &limit.cells {
            let expected = cell.expected.map_or("", |class| class.name());
            writeln!(
                text,
                "step,{name},{},{},{},{expected},{},{},,,{},{}",
                cell.part,
                short(Some(cell.dt_s)),
                short(limit.theory_s),
                cell.unwatched.name(),
                cell.watched.name(),
                cell.is_silent(),
                said(&cell.told),
            )
            .expect("a string grows");
        }
    }
    for verdict in &study.verdicts {
        writeln!(
            text,
            "scene,{},,{},,{},,{},{},,{},{},{},{}",
            verdict.trial,
            verdict.method,
            short(Some(verdict.dt_s)),
            verdict.expected.name(),
            verdict.measured.name(),
            short(verdict.measure),
            verdict.expected == verdict.measured,
            verdict.is_silent(),
            said(&verdict.told),
        )
        .expect("a string grows");
    }
    for Missing { part, why } in &study.missing {
        writeln!(text, "missing,{part},,,,,,,,,,,,,{}", cell(why)).expect("a string grows");
    }
    text
}

/// Codes and words, each in a column.
fn said(told: &[Told]) -> String {
    let joined = |of: fn(&Told) -> &str| {
        let all: Vec<&str> = told.iter().map(of).collect();
        all.join(" | ")
    };
    let words = joined(|told| &told.words).replace('"', "\"\"");
    format!("{},\"{words}\"", joined(|told| &told.code))
}

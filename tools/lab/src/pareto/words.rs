//! What a study says, in words.

use std::fmt::Write as _;

use super::method::{Claim, Family};
use super::observable::{Observable, TOLD};
use super::run::Status;
use super::{CaseStudy, Cheapest, Row, Study};

/// Returns a summary in words: by case, the cheapest method for each tolerance and what each method does at its
/// default settings; and which claims hold.
#[must_use]
pub fn summary(study: &Study) -> String {
    let mut text = String::from(
        "the cheapest for each tolerance, by visits of edges (and how much more the next method and \
         the default cost)\n",
    );
    for case in &study.cases {
        writeln!(text, "{} ({})", case.name, case.about).expect("a string grows");
        for observable in TOLD {
            let all = case.cheapest.iter();
            let told: Vec<String> = all
                .filter(|cheapest| cheapest.observable == observable)
                .map(told)
                .collect();
            if !told.is_empty() {
                writeln!(
                    text,
                    "  {:<16} {}",
                    observable.name(),
                    grouped(&told).join(" · ")
                )
                .expect("a string grows");
            }
        }
        if case.is_barred {
            writeln!(text, "  displacement     barred: noise grows too much")
                .expect("a string grows");
        }
        text += &defaults(case);
    }
    text.push_str(&claims(study));
    text
}

/// A line for each method at its default settings: what it costs as a share of what the default costs, and how
/// far it is off.
fn defaults(case: &CaseStudy) -> String {
    let mut text = String::new();
    let visits = |row: &Row| row.cost.visits() as f64;
    let Some(unit) = case.rows.iter().find(|row| row.is_default).map(visits) else {
        return text;
    };
    for row in case.rows.iter().filter(|row| row.part.is_none()) {
        let errors = TOLD
            .into_iter()
            .filter_map(|observable| row.error(observable));
        let errors = errors.map(|error| {
            let percent = 100.0 * error.total;
            format!("{} {percent:.2} %", error.observable.name())
        });
        let errors: Vec<String> = errors.collect();
        let how = match row.status {
            Status::Ok => errors.join(", "),
            status => status.name().to_owned(),
        };
        let cost = visits(row) / unit;
        let name = row.series.as_str();
        writeln!(
            text,
            "  {name:<9} at its defaults: cost {cost:.2}, off by {how}"
        )
        .expect("a string grows");
    }
    text
}

fn told(cheapest: &Cheapest) -> String {
    let tolerance = if cheapest.observable == Observable::Displacement {
        format!("{:.0e}", cheapest.tolerance)
    } else {
        format!("{} %", (1e3 * cheapest.tolerance).round() / 10.0)
    };
    let Some(winner) = &cheapest.winner else {
        let why = if cheapest.is_known {
            "nobody"
        } else {
            "below the floor"
        };
        return format!("{tolerance}: {why}");
    };
    let next = cheapest.runner_up.as_ref().map(|next| {
        let ratio = next.cost / winner.cost;
        format!("{} ×{ratio:.1}", next.run)
    });
    let default = match cheapest.default_ratio {
        Some(ratio) => format!("default ×{ratio:.1}"),
        None => "default misses it".to_owned(),
    };
    let rest = next
        .into_iter()
        .chain([default])
        .collect::<Vec<_>>()
        .join(", ");
    format!("{tolerance}: {} ({rest})", winner.run)
}

/// Tolerances with the same answer as one.
fn grouped(told: &[String]) -> Vec<String> {
    let mut groups: Vec<(Vec<&str>, &str)> = Vec::new();
    for line in told {
        let (tolerance, answer) = line.split_once(": ").unwrap_or(("", line));
        match groups.last_mut() {
            Some((tolerances, same)) if *same == answer => tolerances.push(tolerance),
            _ => groups.push((vec![tolerance], answer)),
        }
    }
    let groups = groups.iter();
    groups
        .map(|(tolerances, answer)| format!("{}: {answer}", tolerances.join(", ")))
        .collect()
}

/// Whether each method is the cheapest at some tolerance in the scene where it should be.
fn claims(study: &Study) -> String {
    let mut text = String::new();
    for family in Family::ALL {
        let Claim::Wins(scene) = family.claim() else {
            continue;
        };
        let is_of = |case: &&CaseStudy| case.name.split('/').next() == Some(scene);
        let mut cases = study.cases.iter().filter(is_of).peekable();
        if cases.peek().is_none() {
            continue;
        }
        let wins = cases.any(|case| {
            let mut winners = case.cheapest.iter().filter_map(|c| c.winner.as_ref());
            winners.any(|winner| winner.family == family)
        });
        let answer = if wins { "it does" } else { "it does not" };
        writeln!(text, "{} should win in {scene}: {answer}", family.name())
            .expect("a string grows");
    }
    text
}

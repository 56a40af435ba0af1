//! What a study says, in words.

use std::fmt::Write as _;

use super::method::{Claim, Family};
use super::observable::{Observable, TOLD};
use super::{CaseStudy, Cheapest, Study};

/// Returns a summary in words: the cheapest method for each tolerance, by case, and which claims hold.
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
    }
    text.push_str(&claims(study));
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

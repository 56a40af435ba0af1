//! What a study says, in words.

use std::fmt::Write as _;

use super::place::QUESTIONS;
use super::{Answer, Asked, Crossing, Line, Study};
use crate::pareto::{Family, Observable};

/// Returns a summary in words. For each tolerance: how often each family is the cheapest, how the costs of XPBD
/// and of Verlet's method compare, and at each mass ratio the stiffness at which the cheaper one changes.
#[must_use]
pub fn summary(study: &Study) -> String {
    let mut text = String::from("the cheapest at a fixed error, by visits of edges\n");
    for asked in QUESTIONS {
        writeln!(text, "{}", question(asked)).expect("a string grows");
        let answers: Vec<&Answer> = answers(study, asked.observable).collect();
        writeln!(text, "  {}", winners(&answers)).expect("a string grows");
        for of in [Family::Xpbd, Family::Plain] {
            if let Some(words) = ratios(&answers, of) {
                writeln!(text, "  {words}").expect("a string grows");
            }
        }
        for line in study.lines.iter().filter(|line| line.asked == asked) {
            writeln!(text, "  {}", told(line)).expect("a string grows");
        }
    }
    text
}

fn answers(study: &Study, observable: Observable) -> impl Iterator<Item = &Answer> {
    let places = study.places.iter();
    places.filter_map(move |place| place.answer(observable))
}

/// A tolerance, as it heads what is said of it.
pub(super) fn question(asked: Asked) -> String {
    let what = match asked.observable {
        Observable::ReactionLargest => "the largest mean force at the holds",
        Observable::Displacement => "displacements",
        other => other.name(),
    };
    format!("{what} within {} %", 100.0 * asked.tolerance)
}

/// How often each family is the cheapest.
fn winners(answers: &[&Answer]) -> String {
    let count = |is_it: &dyn Fn(&Answer) -> bool| answers.iter().filter(|a| is_it(a)).count();
    let mut told: Vec<String> = Vec::new();
    for family in Family::ALL {
        let won = count(&|a| a.winner().is_some_and(|winner| winner.family == family));
        if won > 0 {
            told.push(format!("{} in {won}", family.name()));
        }
    }
    let others = [
        ("nobody", count(&|a| a.is_known && a.winner().is_none())),
        ("barred, as noise grows,", count(&|a| a.is_barred)),
        ("not known", count(&|a| !a.is_barred && !a.is_known)),
    ];
    for (words, found) in others {
        if found > 0 {
            told.push(format!("{words} in {found}"));
        }
    }
    format!("of {} places: {}", answers.len(), told.join(", "))
}

/// How many times as much a family costs as Verlet's method, at least and at most.
fn ratios(answers: &[&Answer], of: Family) -> Option<String> {
    let all: Vec<f64> = answers
        .iter()
        .filter_map(|answer| answer.ratio(of, Family::Verlet))
        .collect();
    let least = all.iter().copied().reduce(f64::min)?;
    let most = all.iter().copied().reduce(f64::max)?;
    let missed = answers
        .iter()
        .filter(|a| a.visits(of).is_none() && a.visits(Family::Verlet).is_some())
        .count();
    let missed = match missed {
        0 => String::new(),
        n => format!("; misses it in {n} where Verlet meets it"),
    };
    Some(format!(
        "{} costs {least:.2} to {most:.2} times as much as Verlet{missed}",
        of.name()
    ))
}

/// Who is cheaper along a line.
fn told(line: &Line) -> String {
    let opponent = line.opponent.name();
    let begin = format!("at ratio {:e}, against {opponent}:", line.mass_ratio);
    let name = |is_xpbd: bool| if is_xpbd { "XPBD" } else { opponent };
    let (Some(first), [.., last]) = (line.begins_with_xpbd, &line.known_n_per_m[..]) else {
        return format!("{begin} not known");
    };
    let range = format!("{:e} to {last:e} N/m", line.known_n_per_m[0]);
    if line.crossings.is_empty() {
        return format!(
            "{begin} {} is cheaper wherever it is known, {range}",
            name(first)
        );
    }
    let changes = line.crossings.iter().map(|crossing| {
        format!(
            "{} above k = {}",
            name(crossing.is_to_xpbd),
            stiffness(crossing)
        )
    });
    let changes = changes.collect::<Vec<_>>().join(", ");
    format!(
        "{begin} {} is cheaper at {:e} N/m, {changes}",
        name(first),
        line.known_n_per_m[0]
    )
}

/// Where the cheaper one changes.
pub(super) fn stiffness(crossing: &Crossing) -> String {
    match crossing.at_n_per_m {
        Some(at) => format!("{at:.1e} N/m"),
        None => format!(
            "some {:e} to {:e} N/m",
            crossing.from_n_per_m, crossing.to_n_per_m
        ),
    }
}

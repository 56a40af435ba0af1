//! What a study says, in words.

use std::fmt::Write as _;

use super::policy::{Ranking, Standing, Why};
use super::task::Task;
use super::{Study, Trial};

/// Returns a summary in words: the verdict, the regret of each policy by demand, the cheapest families, the
/// tasks whose answer is unknown, and the regret of the two rivals by kind of task.
#[must_use]
pub fn summary(study: &Study) -> String {
    let mut text = String::new();
    for (place, ranking) in study.rankings.iter().enumerate() {
        writeln!(
            text,
            "{}: {} of {} tasks known{}",
            ranking.demand.name(),
            ranking.standings.len(),
            study.trials.len(),
            reasons(ranking)
        )
        .expect("a string grows");
        if ranking.regrets.is_empty() {
            continue;
        }
        writeln!(text, "  {}", verdict(ranking)).expect("a string grows");
        for regret in &ranking.regrets {
            let [low, high] = regret.interval;
            writeln!(
                text,
                "  {}: regret {:.2} (95 %: {low:.2} to {high:.2}), misses {}",
                regret.policy, regret.regret, regret.missed
            )
            .expect("a string grows");
        }
        writeln!(text, "  cheapest: {}", wins(ranking)).expect("a string grows");
        if place == 0 {
            text += &regions(study, ranking);
        }
    }
    text
}

/// Returns whether a planner could be worth having, with the numbers.
#[must_use]
pub(super) fn verdict(ranking: &Ranking) -> String {
    match ranking.planner_max {
        None => "no answer is known".to_owned(),
        Some(most) if most < 1.0 => format!(
            "no planner is worth having: it would need a regret of {most:.2}, and nobody has less than 1"
        ),
        Some(most) => format!("a planner is worth having if its regret is at most {most:.2}"),
    }
}

/// How many answers are unknown for each reason.
fn reasons(ranking: &Ranking) -> String {
    let count = |why: Why| ranking.unknown.iter().filter(|one| one.why == why).count();
    let all = [Why::NoReference, Why::BelowFloor, Why::NobodyMeetsIt];
    let told = all.into_iter().filter(|why| count(*why) > 0);
    let told = told.map(|why| format!("; {} {}", count(why), why.name()));
    told.collect()
}

/// The series of the cheapest runs, by how often.
fn wins(ranking: &Ranking) -> String {
    let mut series: Vec<&str> = ranking
        .standings
        .iter()
        .map(|s| s.series.as_str())
        .collect();
    series.sort_unstable();
    let mut counted: Vec<(usize, &str)> = Vec::new();
    for group in series.chunk_by(|a, b| a == b) {
        counted.push((group.len(), group[0]));
    }
    counted.sort_by_key(|&(count, _)| std::cmp::Reverse(count));
    let told: Vec<String> = counted
        .iter()
        .map(|(n, name)| format!("{name} {n}"))
        .collect();
    told.join(", ")
}

/// A kind of tasks.
type Kind = (&'static str, fn(&Task) -> bool);

const KINDS: [Kind; 11] = [
    ("k below 1e3 N/m", |t| t.stiffness_n_per_m < 1e3),
    ("k 1e3 to 1e4 N/m", |t| {
        (1e3..1e4).contains(&t.stiffness_n_per_m)
    }),
    ("k 1e4 to 1e5 N/m", |t| {
        (1e4..1e5).contains(&t.stiffness_n_per_m)
    }),
    ("k from 1e5 N/m", |t| t.stiffness_n_per_m >= 1e5),
    ("no light particle", |t| t.middle_mass_ratio == 1.0),
    ("mass ratio 0.01 to 1", |t| {
        (0.01..1.0).contains(&t.middle_mass_ratio)
    }),
    ("mass ratio below 0.01", |t| t.middle_mass_ratio < 0.01),
    ("no drag", |t| t.drag_per_s == 0.0),
    ("drag below 3 /s", |t| {
        t.drag_per_s > 0.0 && t.drag_per_s < 3.0
    }),
    ("drag 3 to 30 /s", |t| (3.0..30.0).contains(&t.drag_per_s)),
    ("drag from 30 /s", |t| t.drag_per_s >= 30.0),
];

/// The regret of the two rivals by kind of task.
fn regions(study: &Study, ranking: &Ranking) -> String {
    let mut text = String::new();
    for (name, is_of) in KINDS {
        let task = |standing: &&Standing| {
            let is_it = |trial: &&Trial| trial.task.number == standing.number;
            let trial = study.trials.iter().find(is_it);
            trial.is_some_and(|trial| is_of(&trial.task))
        };
        let of: Vec<&Standing> = ranking.standings.iter().filter(task).collect();
        if of.is_empty() {
            continue;
        }
        let mean = |place: usize| {
            let logs = of.iter().map(|standing| standing.ratios[place].ln());
            (logs.sum::<f64>() / of.len() as f64).exp()
        };
        writeln!(
            text,
            "  {name}, {} known: always-Verlet {:.2}, always-XPBD {:.2}",
            of.len(),
            mean(0),
            mean(1)
        )
        .expect("a string grows");
    }
    text
}

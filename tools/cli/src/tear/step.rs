//! `--check-step`: whether the result depends on the step.

use std::num::NonZero;

use indicatif::ProgressBar;
use tearmesh_cloth::scene::ensemble::{self, Ensemble, MemberStatus, NOISE_M, Quantity, Subject};
use tearmesh_cloth::statistics::{self, Verdict, compare};
use tearmesh_lab::experiment::{side_by_side, workers};

use crate::interrupt::Guard;
use crate::report;
use crate::say::{Fault, count, short, three_digits, two_digits};

/// Runs at each of the two steps.
const SEEDS: u64 = 8;

/// The numbers by which the step is divided.
const DIVISORS: [NonZero<u32>; 2] = [NonZero::<u32>::MIN, NonZero::<u32>::MIN.saturating_add(1)];

/// Plays a subject with this step again and again; what was not done when it was interrupted stands as such.
pub(super) fn check(
    subject: Subject<'_>,
    step_s: f64,
    guard: &Guard,
    bar: &ProgressBar,
) -> report::StepCheck {
    let jobs = DIVISORS.map(|divisor| (1..=SEEDS).map(move |seed| (divisor, seed)));
    let jobs: Vec<_> = jobs.into_iter().flatten().collect();
    let cost = |(divisor, _): (NonZero<u32>, u64)| f64::from(divisor.get());
    let whole: f64 = jobs.iter().map(|&job| cost(job)).sum();
    let mut done = 0.0;
    let play = |&(step_divisor, seed): &_| {
        ensemble::member(subject, step_divisor, seed, &|| guard.is_interrupted())
    };
    let members = side_by_side(&jobs, workers(), play, |i| {
        done += cost(jobs[i]);
        bar.set_position((done / whole * bar.length().unwrap_or(0) as f64) as u64);
    });
    bar.finish_and_clear();
    let ensembles = DIVISORS.into_iter().zip(members.chunks(SEEDS as usize));
    let ensembles = ensembles.map(|(step_divisor, members)| Ensemble {
        step_divisor,
        step_s: step_s / f64::from(step_divisor.get()),
        members: members.to_vec(),
    });
    let ensembles: Vec<_> = ensembles.collect();
    let quantities = Quantity::ALL.into_iter();
    let quantities = quantities.filter_map(|quantity| compared(&ensembles, quantity));
    report::StepCheck {
        noise_m: NOISE_M,
        quantities: quantities.collect(),
        ensembles,
    }
}

/// None where the method does not say it, or all runs of an ensemble failed. Where some did, nobody can tell:
/// those that are left are not drawn at random.
fn compared(ensembles: &[Ensemble], quantity: Quantity) -> Option<report::StepQuantity> {
    let [whole, half] = ensembles else {
        return None;
    };
    let ((whole, all), (half, all_of_half)) = (whole.numbers(quantity), half.numbers(quantity));
    if whole.is_empty() || half.is_empty() {
        return None;
    }
    let mut comparison = compare(&whole, &half);
    if !(all && all_of_half) {
        comparison.verdict = Verdict::CannotTell;
    }
    Some(report::StepQuantity {
        quantity,
        name: quantity.key,
        spread: [statistics::spread(&whole), statistics::spread(&half)],
        comparison,
    })
}

/// The lines of the summary: a head, and one for each number.
pub(super) fn summary(check: &report::StepCheck) -> Vec<String> {
    let [whole, half] = &check.ensembles[..] else {
        return Vec::new();
    };
    let mut lines = vec![format!(
        "step: {SEEDS} seeds at {} s and {SEEDS} at {} s; medians, and 10 to 90 % of the runs",
        short(whole.step_s),
        short(half.step_s),
    )];
    for told in &check.quantities {
        let [name, unit] = told.quantity.name;
        let [whole, half] = told.spread.map(|points| spread(points, unit));
        let verdict = told.comparison.verdict.name();
        lines.push(format!("  {name:<14} {whole:<30} {half:<30} {verdict}"));
    }
    lines
}

fn spread([low, middle, high]: [f64; 3], unit: &str) -> String {
    if middle == f64::INFINITY {
        return "none".to_owned();
    }
    let number = |x: f64| match x {
        f64::INFINITY => "never".to_owned(),
        x => three_digits(x),
    };
    let text = format!(
        "{} ({} to {}) {unit}",
        number(middle),
        number(low),
        number(high)
    );
    text.trim_end().to_owned()
}

/// Warns where the step decides, and where runs failed.
pub(super) fn warnings(check: &report::StepCheck) -> Vec<Fault> {
    let mut faults = Vec::new();
    let differs = |one: &&report::StepQuantity| one.comparison.verdict == Verdict::Differ;
    let differing = check.quantities.iter().filter(differs);
    let names: Vec<&str> = differing.map(|one| one.quantity.name[0]).collect();
    let half_s = check.ensembles.last().map_or(0.0, |half| half.step_s);
    if !names.is_empty() {
        let message = format!(
            "the result depends on the time step: at half the step, these differ by more than chance: {}",
            names.join(", ")
        );
        let help = format!("--dt {} --check-step", two_digits(half_s));
        faults.push(Fault::warning("W-SIM-STEP", message).help(help));
    }
    let members = check
        .ensembles
        .iter()
        .flat_map(|ensemble| &ensemble.members);
    let failed: Vec<_> = members
        .filter(|member| member.status == MemberStatus::Failed)
        .collect();
    if let Some(first) = failed.first() {
        let message = format!(
            "{} of the step check failed: {}",
            count(failed.len(), "run", "runs"),
            first.why
        );
        faults.push(Fault::warning("W-SIM-STEP", message));
    }
    faults
}

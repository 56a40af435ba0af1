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
    let mut members = members.chunks(SEEDS as usize);
    let ensembles = DIVISORS.map(|step_divisor| Ensemble {
        step_divisor,
        step_s: step_s / f64::from(step_divisor.get()),
        members: members.next().unwrap_or_default().to_vec(),
    });
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
fn compared(ensembles: &[Ensemble; 2], quantity: Quantity) -> Option<report::StepQuantity> {
    let [(whole, all), (half, all_of_half)] = ensembles.each_ref().map(|one| one.numbers(quantity));
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
    let [whole, half] = check.ensembles.each_ref().map(|one| short(one.step_s));
    let mut lines = vec![format!(
        "step: {SEEDS} seeds at {whole} s and {SEEDS} at {half} s; medians, and 10 to 90 % of the runs"
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
    let [low, middle, high] = [low, middle, high].map(number);
    let text = format!("{middle} ({low} to {high}) {unit}");
    text.trim_end().to_owned()
}

/// Warns where the step decides, and where runs failed.
pub(super) fn warnings(check: &report::StepCheck) -> Vec<Fault> {
    let mut faults = Vec::new();
    let differs = |one: &&report::StepQuantity| one.comparison.verdict == Verdict::Differ;
    let differing = check.quantities.iter().filter(differs);
    let names: Vec<&str> = differing.map(|one| one.quantity.name[0]).collect();
    if !names.is_empty() {
        let names = names.join(", ");
        let message = format!(
            "the result depends on the time step: at half the step, these differ by more than chance: {names}"
        );
        let half = two_digits(check.ensembles[1].step_s);
        let help = format!("--dt {half} --check-step");
        faults.push(Fault::warning("W-SIM-STEP", message).help(help));
    }
    let members = check.ensembles.iter().flat_map(|one| &one.members);
    let failed = members.filter(|member| member.status == MemberStatus::Failed);
    let failed: Vec<_> = failed.collect();
    if let Some(first) = failed.first() {
        let runs = count(failed.len(), "run", "runs");
        let message = format!("{runs} of the step check failed: {}", first.why);
        faults.push(Fault::warning("W-SIM-STEP", message));
    }
    faults
}

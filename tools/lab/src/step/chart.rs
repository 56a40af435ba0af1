//! The figure and the summary of a table: a panel and a line for each quantity.

use super::{Row, Step};
use crate::ensemble::{Sample, compared};
use crate::experiment::{Draw, Status};
use crate::plot::{Axis, COLOURS, Figure, Layer, Mark, Panel, Shape, short};
use crate::statistics::{Comparison, Verdict, spread};

/// A quantity of runs: its name and its unit, and its value in a run that reached its end.
type Quantity = ([&'static str; 2], fn(&Row) -> Option<f64>);

/// In a run without a tear the first tear is infinitely late, at a force that was never reached.
const QUANTITIES: [Quantity; 6] = [
    (["first tear", "s"], |row| {
        Some(row.first_tear_s.unwrap_or(f64::INFINITY))
    }),
    (["force then", "N"], |row| match row.first_tear_s {
        Some(_) => row.first_force_n,
        None => row.largest_force_n.map(|_| f64::INFINITY),
    }),
    (["torn length", "m"], |row| row.torn_m),
    (["pieces", ""], |row| row.pieces.map(|pieces| pieces as f64)),
    (["largest force", "N"], |row| row.largest_force_n),
    (["work of holds", "J"], |row| row.work_j),
];

const READING: &str = "Medians with 10 to 90 % of the runs, at the step and at half of it. Under each title: the ratio \
     of the medians with its 95 % interval by bootstrap. They differ if that is outside 0.9 … 1.1, and are the same if \
     it is within 0.8 … 1.25.";

impl Draw for Step<'_> {
    fn figure(&self, rows: &[Row]) -> Figure {
        Figure {
            title: title(rows),
            about: "One scene, played with many seeds at its time step and at half of it."
                .to_owned(),
            layout: (3, [300.0, 260.0]),
            panels: measured(rows).iter().map(Measured::panel).collect(),
            footer: vec![READING.to_owned()],
            ..Figure::default()
        }
    }

    fn summary(&self, rows: &[Row]) -> String {
        let [whole, half] = [1, 2].map(|divisor| runs(rows, divisor));
        let [at_whole, at_half] = [&whole, &half].map(|of| {
            let step = of.first().map(|row| short(row.step_s, 3));
            format!("{} runs at {} s", of.len(), step.unwrap_or_default())
        });
        let mut text = title(rows) + "\n";
        text += &format!("{at_whole} and {at_half}; medians, and 10 to 90 % of the runs\n");
        for one in measured(rows) {
            text += &one.words();
        }
        text
    }
}

/// The runs with the step divided by a number.
fn runs(rows: &[Row], step_divisor: u32) -> Vec<&Row> {
    let of = rows.iter().filter(|row| row.step_divisor == step_divisor);
    of.collect()
}

/// A quantity at the step and at half of it, compared.
struct Measured {
    name: [&'static str; 2],
    steps_s: [f64; 2],
    samples: [Sample; 2],
    found: Comparison,
}

/// The quantities that runs at both steps have.
fn measured(rows: &[Row]) -> Vec<Measured> {
    let sides = [1, 2].map(|divisor| runs(rows, divisor));
    let all = QUANTITIES.into_iter().filter_map(|(name, value)| {
        let samples = sides.each_ref().map(|of| {
            let ended = of.iter().filter(|row| row.status == Status::Ok);
            let values: Vec<f64> = ended.filter_map(|row| value(row)).collect();
            let is_whole = values.len() == of.len();
            (values, is_whole)
        });
        let found = compared(&samples[0], &samples[1])?;
        let steps_s = sides.each_ref().map(|of| of[0].step_s);
        Some(Measured {
            name,
            steps_s,
            samples,
            found,
        })
    });
    all.collect()
}

/// The finding.
fn title(rows: &[Row]) -> String {
    let measured = measured(rows);
    let names = |verdict: Verdict| {
        let of = measured.iter().filter(|one| one.found.verdict == verdict);
        let names: Vec<&str> = of.map(|one| one.name[0]).collect();
        names.join(", ")
    };
    let failed = rows.iter().filter(|row| row.status == Status::Failed);
    let failed: Vec<&Row> = failed.collect();
    let finding = match [names(Verdict::Differ), names(Verdict::CannotTell)] {
        _ if measured.is_empty() => "No run reached its end at both steps".to_owned(),
        [differ, _] if !differ.is_empty() => {
            format!(
                "The result depends on the time step: at half of it, these differ by more than chance: {differ}"
            )
        }
        [_, unknown] if !unknown.is_empty() => {
            format!(
                "Half the step changes nothing that these runs show; they cannot tell: {unknown}"
            )
        }
        _ => "Half the step changes no median".to_owned(),
    };
    match failed.first() {
        Some(first) => {
            let (count, all) = (failed.len(), rows.len());
            format!("{finding}; {count} of {all} runs failed: {}", first.why)
        }
        None => finding,
    }
}

impl Measured {
    fn panel(&self) -> Panel {
        let mut layers = Vec::new();
        for (i, (values, _)) in self.samples.iter().enumerate() {
            let ends = spread(values);
            // What never came has no place.
            if ends.iter().all(|end| end.is_finite()) {
                let mark = Mark::new(Shape::DISC, COLOURS[i]);
                layers.extend(Layer::interval(i as f64 + 0.5, ends, mark, String::new()));
            }
        }
        let Comparison {
            ratio,
            interval: [low, high],
            verdict,
        } = self.found;
        let [ratio, low, high] = [ratio, low, high].map(|x| short(x, 3));
        let about = format!("ratio {ratio} ({low} to {high}): {}", verdict.name());
        let steps = self.steps_s.map(|step_s| format!("{} s", short(step_s, 3)));
        let [name, unit] = self.name;
        let label = [name, unit].join(", ");
        let axes = [
            Axis::named(steps.to_vec()),
            Axis::linear(label.trim_end_matches(", ")),
        ];
        Panel::new(name, &about, axes, layers)
    }

    fn words(&self) -> String {
        let [name, unit] = self.name;
        let [whole, half] = self.samples.each_ref().map(|(values, _)| {
            let [low, middle, high] = spread(values);
            let number = |x: f64| match x {
                f64::INFINITY => "never".to_owned(),
                x => short(x, 3),
            };
            match middle {
                f64::INFINITY => "none".to_owned(),
                _ => format!(
                    "{} ({} to {}) {unit}",
                    number(middle),
                    number(low),
                    number(high)
                ),
            }
        });
        let verdict = self.found.verdict.name();
        format!("  {name:<14} {whole:<30} {half:<30} {verdict}\n")
    }
}

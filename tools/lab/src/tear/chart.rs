//! The figure and the summary of a table: forces of strips with their slopes, and ensembles with verdicts.

use std::fmt::Write as _;

use tearmesh_cloth::statistics::{Comparison, Verdict, compare, spread};

use super::{Row, Tear, What};
use crate::experiment::{Chart, Provenance, Status};
use crate::method::{DefaultMethod, Family};
use crate::plot::{Axis, COLOURS, Colour, Figure, Layer, Mark, PALE, Panel, Shape, short};

/// The largest relative difference at which the forces of a first tear agree.
pub(super) const AGREEMENT: f64 = 0.05;

/// A quantity of runs: its name with its unit, and its value in a row.
type Quantity = (&'static str, fn(&Row) -> Option<f64>);

/// The quantities of ensembles.
const QUANTITIES: [Quantity; 4] = [
    ("torn length, m", |row| row.torn_m),
    ("pieces", |row| row.pieces.map(|pieces| pieces as f64)),
    ("work of holds, J", |row| row.work_j),
    ("largest force, N", |row| row.largest_force_n),
];

const RULES: [(&str, &str); 2] = [("stretch", "stretch ratio"), ("toughness", "toughness")];

impl Chart for Tear {
    fn figure(&self, rows: &[Row], provenance: &Provenance) -> Figure {
        figure(rows, provenance)
    }

    fn summary(&self, rows: &[Row]) -> String {
        summary(rows)
    }
}

fn figure(rows: &[Row], provenance: &Provenance) -> Figure {
    let mut panels = Vec::new();
    if rows.iter().any(|row| row.what == What::Largest) {
        panels.extend(RULES.map(|(rule, name)| curves(rows, rule, name)));
        panels.push(sizes(rows));
    }
    for ensembles in ensembles(rows) {
        panels.extend(QUANTITIES.map(|quantity| ensemble_panel(&ensembles, quantity)));
    }
    let mut footer = vec![
        "Bars: medians with 10 to 90 % over seeds, for each method at its step, at half and at a quarter of it (from \
         left to right). Below the name: does halving the step change the median? = the same, ≠ different, \
         ? cannot tell. Grey band: the reference, 10 to 90 %."
            .to_owned(),
        provenance.footer(),
    ];
    if rows.iter().any(|row| row.status == Status::Interrupted) {
        footer.insert(
            0,
            "INTERRUPTED: runs that were not done are missing.".to_owned(),
        );
    }
    Figure {
        title: title(rows),
        about: "Trouser tests of strips on several meshes, and ensembles of whole tears."
            .to_owned(),
        legend: Vec::new(),
        columns: 3,
        panel_size: [390.0, 330.0],
        panels,
        footer,
    }
}

fn title(rows: &[Row]) -> String {
    let slopes = RULES.map(|(rule, _)| slope(rows, rule, What::Largest));
    match slopes {
        [Some(stretch), Some(toughness)] => format!(
            "By stretch ratio the force to tear depends on the mesh (slope {stretch:+.2}), by toughness much less \
             ({toughness:+.2})"
        ),
        _ => "After the first tear, only distributions over many seeds compare".to_owned(),
    }
}

/// The rows of strips by a rule.
fn strips<'a>(rows: &'a [Row], rule: &str, what: What) -> Vec<&'a Row> {
    let of = rows
        .iter()
        .filter(|row| row.what == what && row.rule.as_deref() == Some(rule));
    of.collect()
}

/// The slope of force against the length of edges, both as logarithms, by least squares; `None` with fewer than
/// two strips that tore.
pub(super) fn slope(rows: &[Row], rule: &str, what: What) -> Option<f64> {
    let strips = strips(rows, rule, what).into_iter();
    let points = strips.filter_map(|row| Some((row.edge_m?.ln(), row.force_n?.ln())));
    let points: Vec<(f64, f64)> = points.collect();
    if points.len() < 2 {
        return None;
    }
    let count = points.len() as f64;
    let mean_x = points.iter().map(|(x, _)| x).sum::<f64>() / count;
    let mean_y = points.iter().map(|(_, y)| y).sum::<f64>() / count;
    let above: f64 = points
        .iter()
        .map(|(x, y)| (x - mean_x) * (y - mean_y))
        .sum();
    let below: f64 = points
        .iter()
        .map(|(x, _)| (x - mean_x) * (x - mean_x))
        .sum();
    Some(above / below)
}

/// Force against distance, a curve for each mesh.
fn curves(rows: &[Row], rule: &str, name: &str) -> Panel {
    let mut panel = Panel {
        title: format!("Force to tear by {name}"),
        about: "labels: length of edges; crosses: first tear by Verlet, rings by XPBD, each at Δt and Δt/2"
            .to_owned(),
        x: Axis::linear("distance of the clamps, m"),
        y: Axis::linear("force, N"),
        ..Panel::default()
    };
    let all = strips(rows, rule, What::Curve);
    for (i, of) in all.chunk_by(|a, b| a.cells == b.cells).enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        let at = |row: &&Row| Some([row.displacement_m?, row.force_n?.max(0.0)]);
        let points: Vec<[f64; 2]> = of.iter().filter_map(at).collect();
        let top = points.iter().copied().max_by(|a, b| a[1].total_cmp(&b[1]));
        panel.layers.push(Layer::Line {
            points,
            colour,
            width: 1.0,
        });
        for first in strips(rows, rule, What::First) {
            let is_it = first.cells == of[0].cells;
            if let Some(at) = at(&first).filter(|_| is_it) {
                let shape = match first.method.as_deref() {
                    Some("verlet") => Shape::Cross,
                    _ => Shape::Disc,
                };
                panel.layers.push(Layer::Mark {
                    at,
                    mark: Mark::new(shape, colour).hollow(),
                    hover: String::new(),
                });
            }
        }
        if let (Some(at), Some(edge_m)) = (top, of[0].edge_m) {
            let text = format!("{} mm", short(1e3 * edge_m, 3));
            panel.layers.push(Layer::Label { at, text, colour });
        }
    }
    fit_if_empty(panel)
}

/// Largest and mean force against the length of edges.
fn sizes(rows: &[Row]) -> Panel {
    let mut panel = Panel {
        title: "Force against the length of edges".to_owned(),
        about: "slopes of the logarithms: 1 is proportional, 0 is independent of the mesh"
            .to_owned(),
        x: Axis::log("length of edges, mm"),
        y: Axis::log("force, N"),
        ..Panel::default()
    };
    for (i, (rule, name)) in RULES.into_iter().enumerate() {
        for (what, width) in [(What::Largest, 2.0), (What::Mean, 0.8)] {
            let colour: Colour = COLOURS[i];
            let of = strips(rows, rule, what).into_iter();
            let points = of.filter_map(|row| Some([1e3 * row.edge_m?, row.force_n?]));
            let mut points: Vec<[f64; 2]> = points.filter(|[_, force]| *force > 0.0).collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let kind = if what == What::Largest {
                "largest"
            } else {
                "mean"
            };
            if let (Some(&at), Some(slope)) = (points.first(), slope(rows, rule, what)) {
                let text = format!("{name}, {kind}: {slope:+.2}");
                panel.layers.push(Layer::Label { at, text, colour });
            }
            let mark = Mark::new(Shape::Disc, colour);
            let mark = if what == What::Largest {
                mark
            } else {
                mark.hollow()
            };
            panel.layers.extend(points.iter().map(|&at| Layer::Mark {
                at,
                mark,
                hover: String::new(),
            }));
            panel.layers.push(Layer::Line {
                points,
                colour,
                width,
            });
        }
    }
    fit_if_empty(panel)
}

fn fit_if_empty(panel: Panel) -> Panel {
    match panel.layers.is_empty() {
        true => Panel {
            about: "no strip reached its end".to_owned(),
            x: panel.x.from_to(1.0, 10.0),
            y: panel.y.from_to(1.0, 10.0),
            ..panel
        },
        false => panel,
    }
}

/// The runs of a scene on a mesh.
pub(super) struct Ensembles<'a> {
    name: String,
    rows: Vec<&'a Row>,
}

/// The values of an ensemble, and whether every run has one.
type Sample = (Vec<f64>, bool);

/// The reference of a quantity: the names of two methods, and the values of their finest ensembles.
pub(super) struct Reference {
    pub(super) methods: [&'static str; 2],
    pub(super) values: Vec<f64>,
}

pub(super) fn ensembles(rows: &[Row]) -> Vec<Ensembles<'_>> {
    let runs: Vec<&Row> = rows.iter().filter(|row| row.what == What::Run).collect();
    let of = runs.chunk_by(|a, b| (a.scene, a.cells) == (b.scene, b.cells));
    of.map(|rows| Ensembles {
        name: format!("{} of {} cells", rows[0].scene.name(), rows[0].cells),
        rows: rows.to_vec(),
    })
    .collect()
}

impl Ensembles<'_> {
    fn methods(&self) -> Vec<&'static str> {
        let is_there = |name: &&str| {
            self.rows
                .iter()
                .any(|row| row.method.as_deref() == Some(*name))
        };
        DefaultMethod::NAMES.into_iter().filter(is_there).collect()
    }

    /// The samples of a method at its step, at half and at a quarter of it.
    fn samples(&self, method: &str, (_, value): Quantity) -> [Sample; 3] {
        [1, 2, 4].map(|divisor| {
            let of = self.rows.iter().filter(|row| {
                row.method.as_deref() == Some(method) && row.step_divisor == Some(divisor)
            });
            let values: Vec<f64> = of.clone().filter_map(|row| value(row)).collect();
            let is_whole = values.len() == of.count();
            (values, is_whole)
        })
    }

    /// The two methods that converged and whose finest ensembles have the same median, the closest pair if there
    /// are several. Two methods that still change with their step agree by chance.
    pub(super) fn reference(&self, quantity: Quantity) -> Option<Reference> {
        let converged = self.methods().into_iter().filter_map(|method| {
            let [_, half, quarter] = self.samples(method, quantity);
            let is_same = compared(&half, &quarter)?.verdict == Verdict::Same;
            is_same.then_some((method, quarter))
        });
        let converged: Vec<(&'static str, Sample)> = converged.collect();
        let mut best: Option<(f64, Reference)> = None;
        for (i, (name, one)) in converged.iter().enumerate() {
            for (other_name, other) in &converged[i + 1..] {
                let Some(found) = compared(one, other) else {
                    continue;
                };
                let apart = found.ratio.ln().abs();
                let is_closer = best.as_ref().is_none_or(|(least, _)| apart < *least);
                if found.verdict == Verdict::Same && is_closer {
                    let values = one.0.iter().chain(&other.0).copied().collect();
                    let methods = [*name, *other_name];
                    best = Some((apart, Reference { methods, values }));
                }
            }
        }
        best.map(|(_, reference)| reference)
    }
}

/// Compares two samples; `None` if either is empty. If some runs failed, no verdict is possible: those that are
/// left are not a random choice.
pub(super) fn compared(first: &Sample, second: &Sample) -> Option<Comparison> {
    if first.0.is_empty() || second.0.is_empty() {
        return None;
    }
    let mut comparison = compare(&first.0, &second.0);
    if !(first.1 && second.1) {
        comparison.verdict = Verdict::CannotTell;
    }
    Some(comparison)
}

fn family(method: &str) -> Family {
    let all = DefaultMethod::all().into_iter();
    let mut named = all.filter(|one| one.name == method).map(|one| one.family);
    named.next().unwrap_or(Family::Verlet)
}

fn ensemble_panel(ensembles: &Ensembles<'_>, quantity: Quantity) -> Panel {
    let methods = ensembles.methods();
    let reference = ensembles.reference(quantity);
    let mut panel = Panel {
        title: format!("{}: {}", ensembles.name, quantity.0),
        about: match &reference {
            Some(one) => format!("reference: the finest of {}", one.methods.join(" and ")),
            None => "no reference: no two methods that converged agree".to_owned(),
        },
        y: Axis::linear(quantity.0),
        ..Panel::default()
    };
    if let Some(reference) = &reference {
        let [low, _, high] = spread(&reference.values);
        panel.layers.push(Layer::Band {
            y: low..high,
            colour: PALE,
        });
    }
    let mut names = Vec::new();
    let mut all: Vec<f64> = Vec::new();
    for (i, method) in methods.iter().enumerate() {
        let samples = ensembles.samples(method, quantity);
        let verdict = compared(&samples[0], &samples[1]).map(|found| found.verdict);
        let sign = match verdict {
            Some(Verdict::Same) => " =",
            Some(Verdict::Differ) => " ≠",
            Some(Verdict::CannotTell) => " ?",
            None => "",
        };
        names.push(format!("{method}{sign}"));
        for (j, (values, _)) in samples
            .iter()
            .enumerate()
            .filter(|(_, one)| !one.0.is_empty())
        {
            let y = spread(values);
            all.extend(y);
            panel.layers.push(Layer::Interval {
                x: i as f64 + 0.3 + 0.2 * j as f64,
                y,
                colour: family(method).mark().colour,
            });
        }
    }
    panel.x = Axis::named(names);
    let (least, most) = all
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(least, most), &x| {
            (least.min(x), most.max(x))
        });
    if least > 0.0 && most > 20.0 * least && most.is_finite() {
        panel.y = Axis::log(quantity.0);
    }
    if all.is_empty() {
        panel.y = panel.y.from_to(0.0, 1.0);
    }
    panel
}

fn summary(rows: &[Row]) -> String {
    let mut text = conclusion(rows);
    for ensembles in ensembles(rows) {
        for quantity in QUANTITIES {
            let reference = ensembles.reference(quantity);
            let referred = match &reference {
                Some(one) => format!("reference: the finest of {}", one.methods.join(" and ")),
                None => "no reference, as no two methods that converged agree".to_owned(),
            };
            writeln!(text, "{}, {}; {referred}", ensembles.name, quantity.0)
                .expect("a string grows");
            for method in ensembles.methods() {
                let samples = ensembles.samples(method, quantity);
                let spreads = samples.each_ref().map(|(values, _)| match values[..] {
                    [] => "unknown".to_owned(),
                    _ => {
                        let [low, middle, high] = spread(values).map(|x| short(x, 3));
                        format!("{middle} ({low} to {high})")
                    }
                });
                let [whole, half, quarter] = spreads;
                let verdict = compared(&samples[0], &samples[1]);
                let verdict = verdict.map_or("unknown", |found| found.verdict.name());
                let against = reference.as_ref().and_then(|one| {
                    let found = compared(&(one.values.clone(), true), &samples[0])?;
                    Some(format!("; against the reference: {}", found.verdict.name()))
                });
                writeln!(
                    text,
                    "  {method:<9} {whole:<26} {half:<26} {quarter:<26} half the step: {verdict}{}",
                    against.unwrap_or_default()
                )
                .expect("a string grows");
            }
        }
    }
    text
}

/// What the strips show; empty without strips.
fn conclusion(rows: &[Row]) -> String {
    let slopes = RULES.map(|(rule, _)| slope(rows, rule, What::Largest));
    let [Some(stretch), Some(toughness)] = slopes else {
        return String::new();
    };
    let [by_stretch, by_toughness] = RULES.map(|(rule, _)| {
        let forces = strips(rows, rule, What::Largest).into_iter();
        let forces = forces.filter_map(|row| Some(short(row.force_n?, 3)));
        forces.collect::<Vec<_>>().join(" / ")
    });
    let mut text = format!(
        "By the paper's stretch ratio a finer mesh tears more easily: the largest force is {by_stretch} N, slope \
         {stretch:+.2} over the edge length. By toughness it is {by_toughness} N, slope {toughness:+.2}: where \
         forces matter, use --toughness.\n"
    );
    let spreads: Vec<f64> = RULES
        .iter()
        .flat_map(|(rule, _)| first_tear_spreads(rows, rule))
        .collect();
    let agree = spreads
        .iter()
        .filter(|spread| **spread <= AGREEMENT)
        .count();
    writeln!(
        text,
        "At the first tear, forces by Verlet and by XPBD, each at Δt and Δt/2, are within {:.0} % of each other in \
         {agree} of {} tests, and {:.1} % apart at most.",
        100.0 * AGREEMENT,
        spreads.len(),
        100.0 * spreads.iter().copied().fold(0.0, f64::max),
    )
    .expect("a string grows");
    text
}

/// For each strip, largest/smallest − 1 of the forces of its first tear.
pub(super) fn first_tear_spreads(rows: &[Row], rule: &str) -> Vec<f64> {
    let first = strips(rows, rule, What::First);
    let of = first.chunk_by(|a, b| a.cells == b.cells);
    of.map(|rows| {
        let forces = || rows.iter().filter_map(|row| row.force_n);
        let least = forces().fold(f64::INFINITY, f64::min);
        forces().fold(0.0, f64::max) / least - 1.0
    })
    .collect()
}

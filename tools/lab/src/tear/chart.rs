//! The figure and the summary of a table: forces of strips with their slopes, and ensembles with verdicts.

use super::{Row, Rule, STEP_DIVISORS, STRIP_M, Tear};
use crate::ensemble::{Sample, compared};
use crate::experiment::Draw;
use crate::method::Method;
use crate::plot::{Axis, COLOURS, Figure, Layer, Mark, Panel, Shape, short};
use crate::statistics::{Comparison, Verdict, spread};

/// The rules of strips, with their names.
const RULES: [(Rule, &str); 2] = [
    (Rule::Stretch, "stretch ratio"),
    (Rule::Toughness, "toughness"),
];

/// A quantity of runs: its name with its unit, and its value in a row.
type Quantity = (&'static str, fn(&Row) -> Option<f64>);

/// The quantities of ensembles.
const QUANTITIES: [Quantity; 4] = [
    ("torn length, m", |row| row.torn_m),
    ("pieces", |row| row.pieces.map(|pieces| pieces as f64)),
    ("work of holds, J", |row| row.work_j),
    ("largest force, N", |row| row.largest_force_n),
];

/// How to read the figure.
const READING: &str = "Bars: medians with 10 to 90 % over seeds, for each method at its step, at half and at a \
     quarter of it (from left to right). Below the name: does halving the step change the median? = the same, ≠ \
     different, ? cannot tell. Grey band: the reference, 10 to 90 %.";

impl Draw for Tear {
    fn figure(&self, rows: &[Row]) -> Figure {
        let mut panels = Vec::new();
        if rows.iter().any(|row| row.rule.is_some()) {
            panels.push(strips(rows));
        }
        panels.extend(ensembles(rows).iter().map(Ensembles::panel));
        Figure {
            title: title(rows),
            about: "Trouser tests of strips on several meshes, and ensembles of whole tears."
                .to_owned(),
            layout: (3, [390.0, 330.0]),
            panels,
            footer: vec![READING.to_owned()],
            ..Figure::default()
        }
    }

    fn summary(&self, rows: &[Row]) -> String {
        let ensembles = ensembles(rows);
        let words = ensembles.iter().map(Ensembles::words);
        title(rows) + "\n" + &words.collect::<String>()
    }
}

/// For each strip that tore by a rule, the length of its edges in millimetres and its largest force in newtons.
fn forces(rows: &[Row], rule: Rule) -> Vec<[f64; 2]> {
    let strips = rows.iter().filter(|row| row.rule == Some(rule));
    let edge_mm = |row: &Row| 1e3 * STRIP_M[0] / f64::from(row.cells);
    let forces = strips.filter_map(|row| Some([edge_mm(row), row.largest_force_n?]));
    forces.collect()
}

/// The slope of the logarithms of some points by least squares; `None` with fewer than two points.
fn slope(points: &[[f64; 2]]) -> Option<f64> {
    let logs = || points.iter().map(|point| point.map(f64::ln));
    let mean = |of: usize| logs().map(|log| log[of]).sum::<f64>() / points.len() as f64;
    let means = [mean(0), mean(1)];
    let moment = |of: usize| -> f64 {
        let products = logs().map(|log| (log[0] - means[0]) * (log[of] - means[of]));
        products.sum()
    };
    (points.len() > 1).then(|| moment(1) / moment(0))
}

/// Largest force against the length of edges.
fn strips(rows: &[Row]) -> Panel {
    let mut layers = Vec::new();
    for ((rule, name), colour) in RULES.into_iter().zip(COLOURS) {
        let points = forces(rows, rule);
        if let Some(slope) = slope(&points) {
            let text = format!("{name}: {slope:+.2}");
            layers.push(Layer::Label(points[0], text, colour));
        }
        let mark = Mark::new(Shape::DISC, colour);
        let marks = points.iter();
        layers.extend(marks.map(|&at| Layer::Mark(at, mark, String::new())));
        layers.push(Layer::Line(points, colour, 2.0));
    }
    let about = "slopes of the logarithms: 1 is proportional, 0 is independent of the mesh";
    let axes = ["length of edges, mm", "largest force, N"].map(Axis::log);
    Panel::new("Force to tear a strip", about, axes, layers)
}

/// What the strips show.
pub(super) fn title(rows: &[Row]) -> String {
    match RULES.map(|(rule, _)| slope(&forces(rows, rule))) {
        [Some(stretch), Some(toughness)] if toughness.abs() < 0.5 * stretch => format!(
            "By stretch ratio the force to tear depends on the mesh (slope {stretch:+.2}), by toughness much less \
             ({toughness:+.2}): where forces matter, use --toughness"
        ),
        [Some(stretch), Some(toughness)] => format!(
            "By both rules the force to tear depends on the mesh (slope {stretch:+.2} by stretch ratio, \
             {toughness:+.2} by toughness)"
        ),
        _ => "After the first tear, only distributions over many seeds compare".to_owned(),
    }
}

/// A method, and its samples at its step, at half and at a quarter of it.
type Samples = (&'static Method, [Sample; 3]);

/// The two methods that agree, and the values of their finest ensembles.
type Reference = ([&'static str; 2], Vec<f64>);

/// The ensembles of a scene on a mesh by one quantity.
pub(super) struct Ensembles {
    /// The scene and the mesh.
    name: String,
    /// The name of the quantity, with its unit.
    quantity: &'static str,
    methods: Vec<Samples>,
    pub(super) reference: Option<Reference>,
}

/// The ensembles of a table, for each scene on a mesh by each quantity.
pub(super) fn ensembles(rows: &[Row]) -> Vec<Ensembles> {
    let runs: Vec<&Row> = rows.iter().filter(|row| row.rule.is_none()).collect();
    let groups = runs.chunk_by(|a, b| (a.scene, a.cells) == (b.scene, b.cells));
    let all = groups.flat_map(|of| {
        QUANTITIES.map(|(quantity, value)| {
            let methods = of.chunk_by(|a, b| a.method == b.method).filter_map(|of| {
                let samples = STEP_DIVISORS.map(|divisor| {
                    let of = of.iter().filter(|row| row.step_divisor == divisor);
                    let values: Vec<f64> = of.clone().filter_map(|row| value(row)).collect();
                    let is_whole = values.len() == of.count();
                    (values, is_whole)
                });
                Some((Method::named(&of[0].method)?, samples))
            });
            let methods: Vec<Samples> = methods.collect();
            Ensembles {
                name: format!("{} of {} cells", of[0].scene.name(), of[0].cells),
                quantity,
                reference: reference(&methods),
                methods,
            }
        })
    });
    all.collect()
}

/// The reference: the two methods that converged and whose finest ensembles have the same median, the closest
/// pair if there are several, and the values of those. Two methods that still change with their step agree by
/// chance.
fn reference(methods: &[Samples]) -> Option<Reference> {
    let same = |first, second| -> Option<Comparison> {
        compared(first, second).filter(|found| found.verdict == Verdict::Same)
    };
    let converged = methods.iter().filter(|(_, [_, a, b])| same(a, b).is_some());
    let converged: Vec<&Samples> = converged.collect();
    let pairs = converged.iter().enumerate().flat_map(|(i, one)| {
        let others = converged[i + 1..].iter();
        others.filter_map(move |other| {
            let found = same(&one.1[2], &other.1[2])?;
            Some((found.ratio.ln().abs(), [one, other]))
        })
    });
    let (_, pair) = pairs.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let finest = pair.map(|(_, [.., (values, _)])| &values[..]);
    Some((pair.map(|(method, _)| method.name), finest.concat()))
}

impl Ensembles {
    fn about(&self) -> String {
        match &self.reference {
            Some((methods, _)) => format!("reference: the finest of {}", methods.join(" and ")),
            None => "no reference: no two methods that converged agree".to_owned(),
        }
    }

    fn panel(&self) -> Panel {
        let range = self.reference.iter().map(|(_, values)| spread(values));
        let band = range.map(|[low, _, high]| Layer::Band(low..high));
        let (mut layers, mut names): (Vec<Layer>, _) = (band.collect(), Vec::new());
        let [mut least, mut most] = [f64::INFINITY, 0.0];
        for (i, (method, samples)) in self.methods.iter().enumerate() {
            let found = compared(&samples[0], &samples[1]);
            let sign = match found.map(|found| found.verdict) {
                Some(Verdict::Same) => " =",
                Some(Verdict::Differ) => " ≠",
                Some(Verdict::CannotTell) => " ?",
                None => "",
            };
            names.push(format!("{}{sign}", method.name));
            let known = samples.iter().enumerate();
            for (j, (values, _)) in known.filter(|(_, (values, _))| !values.is_empty()) {
                let y @ [low, _, high] = spread(values);
                (least, most) = (low.min(least), high.max(most));
                let mark = Mark::new(Shape::DISC, method.family.mark().colour);
                let x = i as f64 + 0.3 + 0.2 * j as f64;
                layers.extend(Layer::interval(x, y, mark, String::new()));
            }
        }
        let is_log = least > 0.0 && most > 20.0 * least && most.is_finite();
        let title = format!("{}: {}", self.name, self.quantity);
        let y = [Axis::linear, Axis::log][usize::from(is_log)];
        let axes = [Axis::named(names), y(self.quantity)];
        Panel::new(&title, &self.about(), axes, layers)
    }

    fn words(&self) -> String {
        let mut text = format!("{}, {}; {}\n", self.name, self.quantity, self.about());
        let verdict = |first: &Sample, second: &Sample| {
            compared(first, second).map_or("unknown", |found| found.verdict.name())
        };
        for (method, samples) in &self.methods {
            let (values, _) = &samples[0];
            let known = (!values.is_empty()).then(|| spread(values).map(|x| short(x, 3)));
            let range = known.map(|[low, middle, high]| format!("{middle} ({low} to {high})"));
            let range = range.unwrap_or("unknown".to_owned());
            let of_half = verdict(&samples[0], &samples[1]);
            text += &format!("  {:<9} {range:<26} half the step: {of_half}", method.name);
            if let Some((_, values)) = &self.reference {
                let against = verdict(&(values.clone(), true), &samples[0]);
                text += &format!("; against the reference: {against}");
            }
            text.push('\n');
        }
        text
    }
}

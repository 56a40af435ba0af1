//! The figure and the summary of a table: maps of the steps and of the scenes.

use super::trial::TRIALS;
use super::{Row, Stability};
use crate::experiment::{Draw, Status};
use crate::plot::{Axis, Colour, Figure, Layer, Panel, short};

impl Draw for Stability {
    fn figure(&self, rows: &[Row]) -> Figure {
        Figure {
            title: title(rows),
            about: "Red border: a failure without a message, or an outcome that is not the expected one."
                .to_owned(),
            layout: (2, [760.0, 660.0]),
            panels: vec![steps(rows), scenes(rows)],
            ..Figure::default()
        }
    }

    fn summary(&self, rows: &[Row]) -> String {
        let mut lines = vec![title(rows)];
        let has_failed = |row: &Row| row.measured.is_some_and(|status| status != Status::Ok);
        let is_told = |row: &&Row| is_marked(row) || is_scene(row) && has_failed(row);
        for row in rows.iter().filter(is_told) {
            let step = row.stiffness_n_per_m.zip(row.step_ratio);
            let step = step.map(|(k, ratio)| format!(" at {k:e} N/m, step ratio {ratio}"));
            let codes = match &*row.codes {
                "" => "no message".to_owned(),
                codes => codes.replace(" | ", ", "),
            };
            let (place, method, outcome) = (&row.place, &row.method, outcome_in_words(row));
            let step = step.unwrap_or_default();
            lines.push(format!("{place}, {method}{step}: {outcome}; {codes}"));
        }
        lines.join("\n  ") + "\n"
    }
}

fn is_scene(row: &Row) -> bool {
    row.step_ratio.is_none()
}

fn is_marked(row: &Row) -> bool {
    row.agrees == Some(false) || row.is_silent == Some(true)
}

/// The number of failures without a message, and of steps and scenes that differ.
fn title(rows: &[Row]) -> String {
    let count = |is: fn(&Row) -> bool| rows.iter().filter(|row| is(row)).count();
    let silent = match count(|row| row.is_silent == Some(true)) {
        0 => "No method failed silently".to_owned(),
        count => format!("{count} failures without a message"),
    };
    let differ = count(|row| row.agrees == Some(false));
    let done = count(|row| row.agrees.is_some());
    format!("{silent}: {differ} of {done} steps and scenes differ from what is expected")
}

/// The outcome of a row, and the expected one if it is another.
fn outcome_in_words(row: &Row) -> String {
    let measured = row.measured.map(Status::name).unwrap_or_default();
    match row.expected.filter(|status| Some(*status) != row.measured) {
        Some(expected) => format!("{measured}, expected {}", expected.name()),
        None => measured,
    }
}

const STEP_LABEL: &str = "step, as a multiple of the limit in theory, or of 2/ω if there is none";

/// The map of single steps over all nets.
fn steps(rows: &[Row]) -> Panel {
    let key = |row: &Row| Some([short(row.step_ratio?, 4), row.method.clone()]);
    let (axes, layers) = map(rows, key, |of| {
        let count = |is: fn(&Row) -> bool| of.iter().filter(|row| is(row)).count();
        let stable = count(|row| row.measured == Some(Status::Ok));
        let refused = count(|row| row.watched == Some(Status::Refused));
        let outcome = match stable {
            0 => Status::BlownUp,
            all if all == of.len() => Status::Ok,
            _ => Status::Wrong,
        };
        let stable = format!("{stable} of {}", of.len());
        let refused = format!("{refused} refused");
        (outcome, vec![stable, "stable".to_owned(), refused])
    });
    let about = "Small motions of four nets at each stiffness: the nets on which they stay bounded without the \
                 guard, and those on which the guard refuses the step.";
    let mut panel = Panel::new("Steps on nets", about, axes, layers);
    panel.x.label = STEP_LABEL.to_owned();
    panel
}

/// The map of scenes: the outcome with its measure, and the codes of the messages.
fn scenes(rows: &[Row]) -> Panel {
    let key = |row: &Row| {
        let scene = row.measured.filter(|_| is_scene(row));
        scene.map(|_| [row.method.clone(), row.place.clone()])
    };
    let (axes, layers) = map(rows, key, |of| {
        let measure = of[0].measure.map(|x| format!(" · {}", short(x, 2)));
        let outcome = outcome_in_words(of[0]) + &measure.unwrap_or_default();
        let codes = of[0].codes.split(" | ").map(str::to_owned);
        let lines = [outcome].into_iter().chain(codes);
        let lines = lines.filter(|line| !line.is_empty()).collect();
        (of[0].measured.unwrap_or_default(), lines)
    });
    let abouts = TRIALS.iter();
    let abouts = abouts.map(|trial| format!("{}: {}.", trial.name, trial.about));
    let about = "The outcome; the largest strain, the error of positions or the largest energy as a multiple of \
                 that at the start; and the codes of all messages. Dissipated: right, but the method lost more than a tenth of the \
                 energy that went into motion.";
    let mut panel = Panel::new("Scenes as a user plays them", about, axes, layers);
    panel.words = abouts.collect();
    panel
}

/// A map with a cell for all rows of the same key, which is the names along both axes, in their order in the
/// table.
fn map(
    rows: &[Row],
    key: impl Fn(&Row) -> Option<[String; 2]>,
    cell: impl Fn(&[&Row]) -> (Status, Vec<String>),
) -> ([Axis; 2], Vec<Layer>) {
    let [mut xs, mut ys] = [Vec::new(), Vec::new()];
    for [x, y] in rows.iter().filter_map(&key) {
        for (name, names) in [(x, &mut xs), (y, &mut ys)] {
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    ys.reverse();
    let mut layers = Vec::new();
    for (i, x) in xs.iter().enumerate() {
        for (j, y) in ys.iter().enumerate() {
            let of = rows.iter();
            let of = of.filter(|row| key(row).is_some_and(|key| [x, y] == key.each_ref()));
            let of: Vec<&Row> = of.collect();
            if of.is_empty() {
                continue;
            }
            let (outcome, lines) = cell(&of);
            let is_marked = of.iter().any(|row| is_marked(row));
            let at = [i as f64, j as f64];
            layers.push(Layer::Cell(at, colour(outcome), lines, is_marked));
        }
    }
    ([xs, ys].map(Axis::named), layers)
}

fn colour(outcome: Status) -> Colour {
    match outcome {
        Status::Ok => [0xa6, 0xd8, 0xf0],
        Status::Dissipated => [0xd6, 0xe8, 0xb0],
        Status::Wrong => [0xf5, 0xcf, 0x6b],
        Status::BlownUp => [0xee, 0x9b, 0x5e],
        _ => [0xd2, 0xd2, 0xde],
    }
}

//! The figure and the summary of a table: maps of the steps and of the scenes.

use std::fmt::Write as _;

use super::limit::{LIMITED, Theory};
use super::trial::TRIALS;
use super::{Class, Messages, Row, RowKind, Stability};
use crate::experiment::{Chart, Provenance, Status};
use crate::method::{DefaultMethod, Method};
use crate::plot::{Axis, Colour, Figure, Layer, Panel, short};

impl<M: Messages> Chart for Stability<M> {
    fn figure(&self, rows: &[Row], provenance: &Provenance) -> Figure {
        figure(rows, provenance)
    }

    fn summary(&self, rows: &[Row]) -> String {
        summary(rows)
    }
}

fn figure(rows: &[Row], provenance: &Provenance) -> Figure {
    let mut footer = vec![provenance.footer()];
    let missing = rows.iter().filter(|row| row.status == Status::Interrupted);
    let missing = missing.count();
    if missing > 0 {
        footer.push(format!(
            "INTERRUPTED: {missing} limits and scenes were not done."
        ));
    }
    Figure {
        title: title(rows),
        about:
            "Red border: a failure without a message, or an outcome that is not the expected one."
                .to_owned(),
        columns: 3,
        panel_size: [600.0, 660.0],
        panels: vec![steps(rows, false), steps(rows, true), scenes(rows)],
        footer,
        ..Figure::default()
    }
}

/// The number of failures without a message, and of limits and scenes that differ.
fn title(rows: &[Row]) -> String {
    let silent = rows.iter().filter(|row| row.is_silent == Some(true));
    let silent = match silent.count() {
        0 => "No method failed silently".to_owned(),
        count => format!("{count} failures without a message"),
    };
    let [limits, scenes] = [RowKind::Limit, RowKind::Scene].map(|what| {
        let done = rows
            .iter()
            .filter(|row| row.what == what && row.agrees.is_some());
        let differ = done.clone().filter(|row| row.agrees == Some(false));
        format!("{} of {}", differ.count(), done.count())
    });
    format!(
        "{silent}: {limits} limits differ from theory, {scenes} runs of scenes from what is expected"
    )
}

fn colour(class: Class) -> Colour {
    match class {
        Class::Fine => [0xa6, 0xd8, 0xf0],
        Class::Wrong => [0xf5, 0xcf, 0x6b],
        Class::BlowsUp => [0xee, 0x9b, 0x5e],
        Class::Refused => [0xd2, 0xd2, 0xde],
    }
}

fn is_marked(row: &Row) -> bool {
    row.agrees == Some(false) || row.is_silent == Some(true)
}

/// The map of single steps over all nets, of methods with a limit or of those without one.
fn steps(rows: &[Row], is_always: bool) -> Panel {
    let of = LIMITED
        .iter()
        .filter(|(_, theory)| (*theory == Theory::Always) == is_always);
    let methods: Vec<(&str, Theory)> = of.map(|&(name, theory)| (family(name), theory)).collect();
    let ratios = methods[0].1.step_ratios();
    let mut layers = Vec::new();
    for (i, (method, _)) in methods.iter().rev().enumerate() {
        for (j, ratio) in ratios.iter().enumerate() {
            let is_it = |row: &&Row| row.method == *method && row.step_ratio == Some(*ratio);
            let of: Vec<&Row> = rows.iter().filter(is_it).collect();
            layers.extend(step_cell(&of, [j as f64, i as f64]));
        }
    }
    let (title, label) = match is_always {
        true => ("Methods without a limit", "step, as a multiple of 2/ω"),
        false => (
            "Methods with a limit",
            "step, as a multiple of the limit in theory",
        ),
    };
    let names = methods.iter().rev().map(|(method, _)| (*method).to_owned());
    Panel {
        title: title.to_owned(),
        about: "Small motions of six nets at each stiffness: the nets on which they stay bounded without the \
                guard, and those on which the guard refuses the step."
            .to_owned(),
        x: Axis {
            label: label.to_owned(),
            ..Axis::named(ratios.iter().map(|ratio| short(*ratio, 3)).collect())
        },
        y: Axis::named(names.collect()),
        layers,
        words: methods.iter().filter_map(|method| limits_in_words(rows, *method)).collect(),
        ..Panel::default()
    }
}

fn family(method: &str) -> &'static str {
    Method::named(method).map_or("", |method| method.family.name())
}

/// A method at one step, over all nets; `None` if it was not tried.
fn step_cell(of: &[&Row], at: [f64; 2]) -> Option<Layer> {
    let stable = of
        .iter()
        .filter(|row| row.measured == Some(Class::Fine))
        .count();
    let refused = of
        .iter()
        .filter(|row| row.watched == Some(Class::Refused))
        .count();
    let class = match stable {
        _ if of.is_empty() => return None,
        0 => Class::BlowsUp,
        all if all == of.len() => Class::Fine,
        _ => Class::Wrong,
    };
    Some(Layer::Cell {
        at,
        colour: colour(class),
        lines: vec![
            format!("{stable} of {}", of.len()),
            "stable".to_owned(),
            format!("{refused} refused"),
        ],
        is_marked: of.iter().any(|row| is_marked(row)),
    })
}

/// A sentence on the limits of a method; `None` if none was measured.
fn limits_in_words(rows: &[Row], (method, theory): (&str, Theory)) -> Option<String> {
    let is_it =
        |row: &&Row| row.what == RowKind::Limit && row.method == method && row.agrees.is_some();
    let limits: Vec<&Row> = rows.iter().filter(is_it).collect();
    let ratios = limits
        .iter()
        .filter_map(|row| Some(row.dt_s? / row.theory_s?));
    let least = ratios.clone().reduce(f64::min);
    let most = ratios.reduce(f64::max);
    let failed = limits.iter().filter(|row| row.dt_s.is_some()).count();
    let nets = limits.len();
    Some(match (theory, least, most) {
        _ if nets == 0 => return None,
        _ if failed == 0 => format!("{method}: stable at all steps on {nets} of {nets} nets."),
        (Theory::UpTo(_), Some(least), Some(most)) => {
            format!("{method}: blows up at {least:.4} to {most:.4} of its limit in theory.")
        }
        (Theory::Promised, Some(least), _) => format!(
            "{method}: promised up to twice its recommended step; blows up from {least:.2} times that on."
        ),
        _ => format!("{method}: blows up on {failed} of {nets} nets."),
    })
}

/// The map of scenes: the outcome with its measure, and the codes of the messages.
fn scenes(rows: &[Row]) -> Panel {
    let (trials, methods) = (TRIALS.iter().rev(), DefaultMethod::NAMES);
    let cells = rows.iter().filter_map(|row| {
        let x = methods.iter().position(|name| *name == row.method)?;
        let y = trials.clone().position(|trial| trial.name == row.place)?;
        let measured = row.measured?;
        let measure = row
            .measure
            .map_or(String::new(), |x| format!(" · {}", short(x, 2)));
        let expected = row.expected.filter(|class| *class != measured);
        let expected = expected.map_or(String::new(), |class| format!(", not {}", class.name()));
        let outcome = format!("{}{expected}{measure}", measured.name());
        let codes = row.codes.split(" | ").filter(|code| !code.is_empty());
        Some(Layer::Cell {
            at: [x as f64, y as f64],
            colour: colour(measured),
            lines: [outcome]
                .into_iter()
                .chain(codes.map(str::to_owned))
                .collect(),
            is_marked: is_marked(row),
        })
    });
    let abouts = TRIALS
        .iter()
        .map(|trial| format!("{}: {}.", trial.name, trial.about));
    Panel {
        title: "Scenes as a user plays them".to_owned(),
        about: "The outcome; the largest strain, the error of positions or the largest energy as a multiple of \
                that at the start; and the codes of all messages."
            .to_owned(),
        x: Axis::named(methods.map(str::to_owned).to_vec()),
        y: Axis::named(trials.clone().map(|trial| trial.name.to_owned()).collect()),
        layers: cells.collect(),
        words: abouts.collect(),
        ..Panel::default()
    }
}

fn summary(rows: &[Row]) -> String {
    let mut text = title(rows) + "\n";
    for (name, theory) in LIMITED {
        if let Some(words) = limits_in_words(rows, (family(name), theory)) {
            writeln!(text, "  {words}").expect("a string grows");
        }
    }
    for row in rows {
        let is_scene = row.what == RowKind::Scene;
        if !(is_marked(row) || is_scene && row.measured.is_some_and(|class| class != Class::Fine)) {
            continue;
        }
        let stiffness = row
            .stiffness_n_per_m
            .map_or(String::new(), |k| format!(" at {k:e} N/m"));
        let step = row
            .step_ratio
            .map_or(String::new(), |ratio| format!(", step ratio {ratio}"));
        let measured = row.measured.map_or("the limit differs", Class::name);
        let expected = row.expected.filter(|class| Some(*class) != row.measured);
        let expected = expected.map_or(String::new(), |class| {
            format!(", expected {}", class.name())
        });
        let codes = row.codes.replace(" | ", ", ");
        writeln!(
            text,
            "  {}{stiffness}, {}{step}: {measured}{expected}; {}",
            row.place,
            row.method,
            if codes.is_empty() {
                "no message"
            } else {
                &codes
            },
        )
        .expect("a string grows");
    }
    text
}

//! The page: a panel per topic, and under each what to type.

use std::fmt::Write as _;

use tearmesh_cloth::statistics::{median, spread};

use super::{Guide, Role, Row, Topic};
use crate::experiment::{Chart, Provenance, Status};
use crate::front::FLOORS;
use crate::method::{DEFAULT, DefaultMethod};
use crate::plot::{Axis, Figure, Layer, Mark, PALE, Panel, Strip, short};

/// The errors that are good enough for a look, and for forces.
const LOOK: f64 = 0.2;
const FORCES: f64 = 0.05;

/// A method at one step: all runs of it.
struct Point<'a> {
    method: &'a DefaultMethod,
    row: &'a Row,
    /// CPU seconds per simulated second.
    cost: Option<f64>,
}

impl Point<'_> {
    fn is_default(&self) -> bool {
        self.row.step_multiple.is_none()
    }
}

impl Chart for Guide {
    fn figure(&self, rows: &[Row], provenance: &Provenance) -> Figure {
        figure(rows, provenance)
    }

    fn summary(&self, rows: &[Row]) -> String {
        summary(rows)
    }
}

fn figure(rows: &[Row], provenance: &Provenance) -> Figure {
    let methods = DefaultMethod::all();
    let cells = rows.iter().map(|row| row.cells).max().unwrap_or(0);
    let of = |topic: Topic, cells: u32| -> Vec<&Row> {
        let of = rows
            .iter()
            .filter(|row| row.topic == topic && row.cells == cells);
        of.collect()
    };
    let mut panels = Vec::new();
    for topic in [Topic::Hang, Topic::Flag, Topic::Rip, Topic::Trouser] {
        let [fine, coarse] = [cells, cells / 2].map(|cells| points(&of(topic, cells), &methods));
        panels.push(error_panel(topic, &fine, &coarse));
    }
    let aftermath = points(&of(Topic::Aftermath, cells), &methods);
    let mesh: Vec<&Row> = of(Topic::Aftermath, cells);
    panels.push(value_panel("torn length, m", &aftermath, &mesh, |row| {
        row.torn_m
    }));
    panels.push(value_panel(
        "work of the hand, J",
        &aftermath,
        &mesh,
        |row| row.work_j,
    ));
    Figure {
        title: title(rows, &methods, cells),
        about: format!(
            "CPU seconds per simulated second on meshes of {cells} cells a side (thin lines: {}), against the \
             error of what the scene is about. Down and to the left is better.",
            cells / 2
        ),
        legend: Vec::new(),
        columns: 2,
        panel_size: [600.0, 400.0],
        panels,
        footer: vec![
            "Large marks: a method at its default. Small marks: its default step four times and twice as long and \
             half as long; in the pink strip those that were refused, blew up or did not end. Grey band: below the \
             error that other diagonals of the mesh make; nothing in it is worth paying for. Hollow: below ten \
             times the distance of two references, known no better. Bars: 10 to 90 % over seeds."
                .to_owned(),
            provenance.footer(),
        ],
    }
}

/// A point per method and step, with the median cost of all its runs.
fn points<'a>(rows: &[&'a Row], methods: &'a [DefaultMethod]) -> Vec<Point<'a>> {
    let mut points: Vec<Point<'a>> = Vec::new();
    for &row in rows.iter().filter(|row| row.role == Role::Method) {
        let is_it =
            |other: &Row| other.method == row.method && other.step_multiple == row.step_multiple;
        if points.iter().any(|point| is_it(point.row)) {
            continue;
        }
        let Some(method) = methods.iter().find(|method| method.name == row.method) else {
            continue;
        };
        let of = rows
            .iter()
            .filter(|other| other.role == Role::Method && is_it(other));
        points.push(Point {
            method,
            row,
            cost: median(of.filter_map(|row| row.cpu_s_per_s).collect()),
        });
    }
    points
}

fn cost_axis() -> Axis {
    Axis::log("CPU seconds per simulated second")
}

fn real_time() -> Layer {
    Layer::Rule {
        x: 1.0,
        label: "real time".to_owned(),
    }
}

fn error_panel(topic: Topic, fine: &[Point<'_>], coarse: &[Point<'_>]) -> Panel {
    let first = fine.first().map(|point| point.row);
    let mut panel = Panel {
        title: heading(topic).to_owned(),
        about: first.map_or(String::new(), about),
        x: cost_axis(),
        y: Axis::log("error, %"),
        words: words(topic, fine),
        ..Panel::default()
    };
    let at = |point: &Point<'_>| Some([point.cost?, 100.0 * point.row.error?.max(1e-8)]);
    if !fine.iter().any(|point| at(point).is_some()) {
        panel.about =
            "no reference: the two references have no value, or noise grows too much".to_owned();
        (panel.x, panel.y) = (panel.x.from_to(0.1, 10.0), panel.y.from_to(0.1, 100.0));
        return panel;
    }
    if let Some(mesh) = first.and_then(|row| row.error_mesh) {
        panel.layers.push(Layer::Band {
            y: 0.0..100.0 * mesh,
            colour: PALE,
        });
    }
    panel.layers.push(real_time());
    for (points, width) in [(coarse, 0.7), (fine, 1.6)] {
        for of in points.chunk_by(|a, b| a.method.name == b.method.name) {
            let mut line: Vec<[f64; 2]> = of.iter().filter_map(at).collect();
            line.sort_by(|a, b| a[0].total_cmp(&b[0]));
            panel.layers.push(Layer::Line {
                points: line,
                colour: of[0].method.family.mark().colour,
                width,
            });
        }
    }
    for (point, at) in fine.iter().filter_map(|point| Some((point, at(point)?))) {
        let mark = point.method.family.mark();
        let size = if point.is_default() { 6.5 } else { 3.0 };
        let is_known = error_is_known(point.row);
        let mark = if is_known { mark } else { mark.hollow() };
        let [low, high] =
            [point.row.error_low, point.row.error_high].map(|end| 100.0 * end.unwrap_or(0.0));
        if low < high {
            panel.layers.push(Layer::Line {
                points: vec![[at[0], low], [at[0], high]],
                colour: mark.colour,
                width: 1.0,
            });
        }
        panel.layers.push(Layer::Mark {
            at,
            mark: mark.sized(size),
            hover: format!("{}: error {} %", step(point), short(at[1], 3)),
        });
    }
    for (point, at) in fine.iter().filter_map(|point| Some((point, at(point)?))) {
        if point.is_default() {
            panel.layers.push(Layer::Label {
                at,
                text: point.method.name.to_owned(),
                colour: point.method.family.mark().colour,
            });
        }
    }
    panel.above = failures(fine);
    panel
}

/// Whether the error of a row is above ten times the distance of the references.
fn error_is_known(row: &Row) -> bool {
    let known = row.error.zip(row.error_floor);
    known.is_some_and(|(error, floor)| error >= FLOORS * floor)
}

/// The runs that failed, at the cost that their step would have.
fn failures(points: &[Point<'_>]) -> Option<Strip> {
    let default_cost = |name: &str| {
        let mut of = points.iter().filter(|point| point.method.name == name);
        of.find(|point| point.is_default())?.cost
    };
    let failed = points.iter().filter(|point| point.row.status != Status::Ok);
    let marks = failed.filter_map(|point| {
        let cost = default_cost(point.method.name)? / point.row.step_multiple?;
        let hover = format!(
            "{}: {} {}",
            step(point),
            point.row.status.name(),
            point.row.why
        );
        Some((cost, point.method.family.mark(), hover))
    });
    let marks: Vec<(f64, Mark, String)> = marks.collect();
    (!marks.is_empty()).then(|| Strip {
        label: "refused, blown up or without an end".to_owned(),
        marks,
    })
}

fn step(point: &Point<'_>) -> String {
    let multiple = point.row.step_multiple;
    let multiple = multiple.map_or("at its default".to_owned(), |x| {
        format!("at {x} times its step")
    });
    let dt = point
        .row
        .dt_s
        .map_or(String::new(), |dt| format!(", {} s", short(dt, 3)));
    format!("{} {multiple}{dt}", point.method.name)
}

fn value_panel(
    label: &str,
    points: &[Point<'_>],
    rows: &[&Row],
    value: fn(&Row) -> Option<f64>,
) -> Panel {
    let mut panel = Panel {
        title: format!("After the first tear of rip: {label}"),
        about: "medians and 10 to 90 % over seeds; one run says little".to_owned(),
        x: cost_axis(),
        y: Axis::linear(label),
        ..Panel::default()
    };
    let on_meshes: Vec<f64> = rows
        .iter()
        .filter(|row| row.role == Role::Mesh)
        .filter_map(|row| value(row))
        .collect();
    if !on_meshes.is_empty() {
        let [low, _, high] = spread(&on_meshes);
        panel.layers.push(Layer::Band {
            y: low..high,
            colour: PALE,
        });
    }
    panel.layers.push(real_time());
    let mut medians: Vec<(&str, [f64; 3])> = Vec::new();
    for point in points {
        let of = rows
            .iter()
            .filter(|row| row.role == Role::Method && row.method == point.method.name);
        let values: Vec<f64> = of.filter_map(|row| value(row)).collect();
        let Some(cost) = point.cost.filter(|_| !values.is_empty()) else {
            continue;
        };
        let y = spread(&values);
        let colour = point.method.family.mark().colour;
        panel.layers.push(Layer::Interval { x: cost, y, colour });
        panel.layers.push(Layer::Label {
            at: [cost, y[1]],
            text: point.method.name.to_owned(),
            colour,
        });
        medians.push((point.method.name, y));
    }
    panel.words = value_words(label, &medians, &on_meshes);
    if medians.is_empty() {
        (panel.x, panel.y) = (panel.x.from_to(0.1, 10.0), panel.y.from_to(0.0, 1.0));
    }
    panel
}

fn value_words(label: &str, medians: &[(&str, [f64; 3])], on_meshes: &[f64]) -> Vec<String> {
    let quantity = label.split(',').next().unwrap_or(label);
    let mut words = Vec::new();
    let Some((_, [low, middle, high])) = medians.iter().find(|(name, _)| *name == DEFAULT) else {
        return words;
    };
    words.push(format!(
        "By {DEFAULT}, eight runs in ten have a {quantity} of {} to {}, and the median is {}. Two runs that differ \
         by a nanometre differ as much.",
        short(*low, 2),
        short(*high, 2),
        short(*middle, 2)
    ));
    let others: Vec<String> = medians
        .iter()
        .filter(|(name, _)| *name != DEFAULT)
        .map(|(name, [_, other, _])| format!("{name} {}", short(*other, 2)))
        .collect();
    if !others.is_empty() {
        words.push(format!("Medians by other methods: {}.", others.join(", ")));
    }
    if !on_meshes.is_empty() {
        words.push(
            "Grey band: 10 to 90 % of runs by the default on meshes with other diagonals."
                .to_owned(),
        );
    }
    words
}

fn heading(topic: Topic) -> &'static str {
    match topic {
        Topic::Hang => "hang: the shape at rest",
        Topic::Flag => "flag: where the free corner is, and how far it swings",
        Topic::Rip => "rip: time and force of the first tear",
        Topic::Trouser => "trouser: time and force of the first tear",
        Topic::Aftermath => "rip: after the first tear",
    }
}

fn about(row: &Row) -> String {
    let percent = |error: Option<f64>| {
        error.map_or("unknown".to_owned(), |error| {
            format!("{} %", short(100.0 * error, 2))
        })
    };
    let noise = row.noise_amplification;
    let noise = noise.map_or("unknown".to_owned(), |grown| {
        format!("×{}", short(grown, 2))
    });
    format!(
        "two references {} apart; other diagonals of the mesh: {}; a nanometre of noise: {}, and displacements grow \
         {noise}",
        percent(row.error_floor),
        percent(row.error_mesh),
        percent(row.error_noise)
    )
}

/// What to type for a look and for forces, and when it fails.
fn words(topic: Topic, points: &[Point<'_>]) -> Vec<String> {
    let advice = |error_max: f64| -> String {
        let meets = |point: &&Point<'_>| point.row.error.is_some_and(|error| error <= error_max);
        let meets = points
            .iter()
            .filter(meets)
            .filter_map(|point| Some((point.cost?, point)));
        let Some((cost, point)) = meets.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return "no method at any of these steps".to_owned();
        };
        let error = short(100.0 * point.row.error.unwrap_or(0.0), 2);
        format!(
            "`{}` ({} CPU s a second, {error} % off)",
            command(topic, point),
            short(cost, 2)
        )
    };
    let mut failing: Vec<String> = Vec::new();
    for of in points.chunk_by(|a, b| a.method.name == b.method.name) {
        let name = of[0].method.name;
        let failed = of.iter().filter(|point| point.row.status != Status::Ok);
        let shortest = failed
            .filter_map(|point| point.row.dt_s)
            .fold(f64::INFINITY, f64::min);
        if shortest.is_finite() {
            failing.push(format!(
                "{name} takes no step of {} ms",
                short(1e3 * shortest, 2)
            ));
        }
        let default = of.iter().find(|point| point.is_default());
        let error = default.and_then(|point| point.row.error);
        if let Some(error) = error.filter(|error| *error > LOOK) {
            failing.push(format!(
                "{name} at its default is {} % off",
                short(100.0 * error, 2)
            ));
        }
    }
    let what = match topic {
        Topic::Rip | Topic::Trouser => "forces within 5 %",
        Topic::Hang | Topic::Flag | Topic::Aftermath => "an error below 5 %",
    };
    let fails = match failing.is_empty() {
        true => "nothing failed".to_owned(),
        false => failing.join("; "),
    };
    vec![
        format!("For a look (20 %): {}.", advice(LOOK)),
        format!("For {what}: {}.", advice(FORCES)),
        format!("It fails when: {fails}."),
    ]
}

fn command(topic: Topic, point: &Point<'_>) -> String {
    let mut command = format!("tearmesh tear in.obj --scene {}", topic.name());
    if point.method.name != DEFAULT {
        write!(command, " --solver {}", point.method.name).expect("a string grows");
    }
    if let (Some(_), Some(dt)) = (point.row.step_multiple, point.row.dt_s) {
        write!(command, " --dt {}", short(dt, 3)).expect("a string grows");
    }
    command + " -o out.obj"
}

/// In how many scenes the default method is within 5 %, and the other methods.
fn title(rows: &[Row], methods: &[DefaultMethod], cells: u32) -> String {
    let topics = [Topic::Hang, Topic::Flag, Topic::Rip, Topic::Trouser];
    let default = |name: &str, topic: Topic| {
        rows.iter().find(|row| {
            let is_it = row.topic == topic && row.cells == cells && row.role == Role::Method;
            is_it && row.method == name && row.step_multiple.is_none()
        })
    };
    let known = topics
        .iter()
        .filter(|topic| default(DEFAULT, **topic).is_some_and(|row| row.error.is_some()));
    let known: Vec<Topic> = known.copied().collect();
    let within = |name: &str| {
        let errors = known
            .iter()
            .filter_map(|topic| default(name, *topic)?.error);
        errors.filter(|error| *error <= FORCES).count()
    };
    let others: Vec<String> = methods
        .iter()
        .filter(|method| method.name != DEFAULT)
        .map(|method| format!("{} {}", method.name, within(method.name)))
        .collect();
    format!(
        "Which method for my scene? {DEFAULT}, the default, is within 5 % in {} of {} scenes ({})",
        within(DEFAULT),
        known.len(),
        others.join(", ")
    )
}

fn summary(rows: &[Row]) -> String {
    let methods = DefaultMethod::all();
    let cells = rows.iter().map(|row| row.cells).max().unwrap_or(0);
    let mut text = title(rows, &methods, cells) + "\n";
    for topic in [Topic::Hang, Topic::Flag, Topic::Rip, Topic::Trouser] {
        let of: Vec<&Row> = rows
            .iter()
            .filter(|row| row.topic == topic && row.cells == cells)
            .collect();
        let points = points(&of, &methods);
        let about = points
            .first()
            .map_or(String::new(), |point| about(point.row));
        writeln!(text, "{} ({about})", heading(topic)).expect("a string grows");
        for line in words(topic, &points) {
            writeln!(text, "  {line}").expect("a string grows");
        }
    }
    text
}

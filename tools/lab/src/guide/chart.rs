//! The page: a panel per topic or quantity, and under each what to type.

use std::ops::Range;

use super::{Guide, Role, Row, Topic};
use crate::experiment::{Draw, Status};
use crate::method::{DEFAULT, DEFAULTS, Method};
use crate::pareto::FLOORS;
use crate::plot::{Axis, Figure, Layer, Mark, Panel, Strip, percent, short};
use crate::statistics::{median, spread};

/// The errors that are good enough for a look, and for forces.
const LOOK: f64 = 0.2;
const FORCES: f64 = 0.05;

/// What is drawn along the vertical axis: its label, and its value in a run.
type Quantity = (&'static str, fn(&Row) -> Option<f64>);

const ERROR: Quantity = ("error, %", |row| Some(100.0 * row.error?.max(1e-8)));
const TORN: Quantity = ("torn length, m", |row| row.torn_m);
const WORK: Quantity = ("work of the hand, J", |row| row.work_j);

const FLAG: &str = "flag: where the free corner is, and how far it swings";
const TROUSER: &str = "trouser: time and force of the first tear";
const TORN_AFTER: &str = "After the first tear of rip: torn length";
const WORK_AFTER: &str = "After the first tear of rip: work of the hand";

/// The panels: the topic, the title, and what is drawn.
const PANELS: [(Topic, &str, Quantity); 6] = [
    (Topic::Hang, "hang: the shape at rest", ERROR),
    (Topic::Flag, FLAG, ERROR),
    (Topic::Rip, "rip: time and force of the first tear", ERROR),
    (Topic::Trouser, TROUSER, ERROR),
    (Topic::Aftermath, TORN_AFTER, TORN),
    (Topic::Aftermath, WORK_AFTER, WORK),
];

/// A method at one step: all runs of it.
struct Point<'a> {
    /// Its first run.
    row: &'a Row,
    /// CPU seconds per simulated second, as the median of the runs.
    cost: Option<f64>,
    /// The 10 %, 50 % and 90 % points of the error in per cent or of the quantity.
    y: Option<[f64; 3]>,
}

/// A method at all steps, at its default first.
type Curve<'a> = (&'static Method, Vec<Point<'a>>);

/// A panel's curves on the finest mesh, and on one of half as many cells.
struct Section<'a> {
    topic: Topic,
    title: &'static str,
    /// The label of the vertical axis.
    label: &'static str,
    fine: Vec<Curve<'a>>,
    coarse: Vec<Curve<'a>>,
    /// What other diagonals of the mesh leave.
    band: Option<Range<f64>>,
}

/// How to read the figure.
const READING: &str = "Large marks: a method at its default. Small marks: its default step four times and twice as \
     long and half as long; in the pink strip those that were refused, blew up or did not end. Grey band: below the \
     error that other diagonals of the mesh make; nothing in it is worth paying for. Hollow: below ten times the \
     distance of two references, known no better.";

impl Draw for Guide {
    fn figure(&self, rows: &[Row]) -> Figure {
        let sections = sections(rows);
        let cells = finest(rows);
        Figure {
            title: title(&sections),
            about: format!(
                "CPU seconds per simulated second on meshes of {cells} cells a side (thin lines: {}), against the \
                 error of the scene's main results. Down and to the left is better.",
                cells / 2
            ),
            layout: (2, [600.0, 400.0]),
            panels: sections.iter().map(Section::panel).collect(),
            footer: vec![READING.to_owned()],
            ..Figure::default()
        }
    }

    fn summary(&self, rows: &[Row]) -> String {
        let sections = sections(rows);
        let mut text = title(&sections) + "\n";
        for section in sections.iter().filter(|section| section.is_error()) {
            text += &format!("{} ({})\n", section.title, section.about());
            text.extend(section.words().iter().map(|line| format!("  {line}\n")));
        }
        text
    }
}

fn finest(rows: &[Row]) -> u32 {
    rows.iter().map(|row| row.cells).max().unwrap_or(0)
}

fn sections(rows: &[Row]) -> Vec<Section<'_>> {
    let cells = finest(rows);
    let sections = PANELS.map(|(topic, title, (label, value))| {
        let of = |role: Role, cells: u32| -> Vec<&Row> {
            let is_it = |row: &&Row| (row.topic, row.role, row.cells) == (topic, role, cells);
            rows.iter().filter(is_it).collect()
        };
        let [fine, coarse] = [cells, cells / 2].map(|cells| of(Role::Method, cells));
        let error_mesh = fine.first().and_then(|row| row.error_mesh);
        let others = spread_of(&of(Role::Mesh, cells), value);
        Section {
            topic,
            title,
            label,
            fine: curves(&fine, value),
            coarse: curves(&coarse, value),
            band: match others {
                Some([low, _, high]) => Some(low..high),
                None => error_mesh.map(|error| 0.0..100.0 * error),
            },
        }
    });
    sections.into()
}

fn curves<'a>(rows: &[&'a Row], value: fn(&Row) -> Option<f64>) -> Vec<Curve<'a>> {
    let point = |of: &[&'a Row]| Point {
        row: of[0],
        cost: median(of.iter().filter_map(|row| row.cpu_s_per_s).collect()),
        y: spread_of(of, value),
    };
    let methods = rows.chunk_by(|a, b| a.method == b.method);
    let curves = methods.filter_map(|of| {
        let steps = of.chunk_by(|a, b| a.step_multiple == b.step_multiple);
        Some((Method::named(&of[0].method)?, steps.map(point).collect()))
    });
    curves.collect()
}

fn spread_of(rows: &[&Row], value: fn(&Row) -> Option<f64>) -> Option<[f64; 3]> {
    let values: Vec<f64> = rows.iter().filter_map(|row| value(row)).collect();
    (!values.is_empty()).then(|| spread(&values))
}

impl Point<'_> {
    fn at(&self) -> Option<[f64; 2]> {
        Some([self.cost?, self.y?[1]])
    }

    /// What to type for this method and step.
    fn command(&self) -> String {
        let mut command = format!("tearmesh tear in.obj --scene {}", self.row.topic.name());
        if self.row.method != DEFAULT {
            command += &format!(" --solver {}", self.row.method);
        }
        if let (Some(_), Some(dt)) = (self.row.step_multiple, self.row.dt_s) {
            command += &format!(" --dt {}", short(dt, 3));
        }
        command + " -o out.obj"
    }
}

impl Section<'_> {
    fn is_error(&self) -> bool {
        self.topic != Topic::Aftermath
    }

    /// All points on the finest mesh.
    fn points(&self) -> impl Iterator<Item = &Point<'_>> {
        self.fine.iter().flat_map(|(_, points)| points)
    }

    fn panel(&self) -> Panel {
        let y = [Axis::linear, Axis::log][usize::from(self.is_error())];
        let axes = [Axis::log("CPU seconds per simulated second"), y(self.label)];
        let mut panel = Panel::new(self.title, &self.about(), axes, Vec::new());
        panel.words = self.words();
        if !self.points().any(|point| point.at().is_some()) {
            return panel;
        }
        let layers = &mut panel.layers;
        layers.extend(self.band.clone().map(Layer::Band));
        layers.push(Layer::Rule(1.0, "real time"));
        for (curves, width) in [(&self.coarse, 0.7), (&self.fine, 1.6)] {
            for (method, points) in curves {
                let line = points.iter().filter_map(Point::at);
                layers.push(Layer::curve(line, method.family.mark().colour, width));
            }
        }
        for (method, points) in &self.fine {
            for point in points {
                let (Some(cost), Some(y), row) = (point.cost, point.y, point.row) else {
                    continue;
                };
                let is_default = row.step_multiple.is_none();
                let size = if is_default { 6.5 } else { 3.0 };
                let mut mark = method.family.mark().sized(size);
                // Hollow below ten times the distance of the references.
                let both = row.error.zip(row.error_floor);
                mark.is_hollow = both.is_some_and(|(error, floor)| error < FLOORS * floor);
                let (at, what, cost_s) = (short(y[1], 3), self.label, short(cost, 3));
                let hover = format!("{}: {what} {at}, {cost_s} CPU s a second", point.command());
                layers.extend(Layer::interval(cost, y, mark, hover));
                if is_default {
                    let name = method.name.to_owned();
                    layers.push(Layer::Label([cost, y[1]], name, mark.colour));
                }
            }
        }
        panel.above = self.failures();
        panel
    }

    /// The runs that failed, at the cost that their step would have.
    fn failures(&self) -> Option<Strip> {
        let marks = self.fine.iter().flat_map(|(method, points)| {
            let failed = points.iter().filter(|point| point.row.status != Status::Ok);
            failed.filter_map(|point| {
                let cost = points[0].cost? / point.row.step_multiple?;
                let (status, why) = (point.row.status.name(), &point.row.why);
                let hover = format!("{}: {status} {why}", point.command());
                Some((cost, method.family.mark(), hover))
            })
        });
        let marks: Vec<(f64, Mark, String)> = marks.collect();
        (!marks.is_empty()).then(|| Strip {
            label: "refused, blown up or without an end".to_owned(),
            marks,
        })
    }

    fn about(&self) -> String {
        if !self.is_error() {
            return "medians and 10 to 90 % over seeds; one run says little".to_owned();
        }
        let Some(Point { row, .. }) = self.points().find(|point| point.y.is_some()) else {
            let why = "the two references have no value, or noise grows too much";
            return format!("no reference: {why}");
        };
        let percent = |error: Option<f64>| error.map_or("unknown".to_owned(), percent);
        format!(
            "two references {} apart; other diagonals of the mesh: {}; a nanometre of noise: {}, and displacements \
             grow ×{}",
            percent(row.error_floor),
            percent(row.error_mesh),
            percent(row.error_noise),
            short(row.noise_amplification.unwrap_or(f64::NAN), 2)
        )
    }

    /// What to type for a look and for forces, and when it fails; of a quantity its distributions.
    fn words(&self) -> Vec<String> {
        if !self.is_error() {
            let each = self.points().filter_map(|point| {
                let [low, middle, high] = point.y?.map(|x| short(x, 2));
                Some(format!("{} {middle} ({low} to {high})", point.row.method))
            });
            let each: Vec<String> = each.collect();
            return vec![format!(
                "Medians, and what eight runs in ten have: {}. Two runs that differ by a nanometre differ as much. \
                 Grey band: runs by {DEFAULT} on meshes with other diagonals.",
                each.join(", ")
            )];
        }
        let mut failing = Vec::new();
        for (Method { name, .. }, points) in &self.fine {
            let failed = points.iter().filter(|point| point.row.status != Status::Ok);
            if let Some(dt_s) = failed.filter_map(|point| point.row.dt_s).reduce(f64::min) {
                failing.push(format!(
                    "{name} takes no step of {} ms",
                    short(1e3 * dt_s, 2)
                ));
            }
            let default = points[0].row;
            let is_off = |error: &f64| *error > default.error_floor.unwrap_or(0.0).max(LOOK);
            if let Some(error) = default.error.filter(is_off) {
                failing.push(format!("{name} at its default is {} off", percent(error)));
            }
        }
        if failing.is_empty() {
            failing.push("nothing failed".to_owned());
        }
        let what = match self.topic {
            Topic::Rip | Topic::Trouser => "forces within 5 %",
            _ => "an error below 5 %",
        };
        vec![
            format!("For a look (20 %): {}.", self.cheapest(LOOK)),
            format!("For {what}: {}.", self.cheapest(FORCES)),
            format!("It fails when: {}.", failing.join("; ")),
        ]
    }

    /// The command with the least cost among those that have no larger error; none where the references
    /// themselves are further apart.
    fn cheapest(&self, error_max: f64) -> String {
        let floor = self.points().find_map(|point| point.row.error_floor);
        if floor.is_some_and(|floor| floor > error_max) {
            return "not known, as the references are further apart".to_owned();
        }
        let meets = self.points().filter_map(|point| {
            let error = point.row.error.filter(|error| *error <= error_max)?;
            Some((point.cost?, error, point.command()))
        });
        match meets.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((cost, error, command)) => {
                let (cost, error) = (short(cost, 2), percent(error));
                format!("`{command}` ({cost} CPU s a second, {error} off)")
            }
            None => "no method at any of these steps".to_owned(),
        }
    }
}

/// In how many scenes the default method is within 5 %, and the other methods.
fn title(sections: &[Section<'_>]) -> String {
    let errors = |name: &'static str| {
        let curves = sections.iter().flat_map(|section| &section.fine);
        let of = curves.filter(move |(method, _)| method.name == name);
        let known =
            of.filter(|(_, points)| points[0].row.error_floor.is_some_and(|at| at <= FORCES));
        known.filter_map(|(_, points)| points[0].row.error)
    };
    let within = |name| errors(name).filter(|error| *error <= FORCES).count();
    let others = DEFAULTS[1..].iter();
    let others = others.map(|method| format!("{} {}", method.name, within(method.name)));
    let others: Vec<String> = others.collect();
    format!(
        "Which method for my scene? {DEFAULT}, the default, is within 5 % in {} of {} scenes whose answer is known ({})",
        within(DEFAULT),
        errors(DEFAULT).count(),
        others.join(", ")
    )
}

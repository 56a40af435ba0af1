//! The page: a panel per topic or quantity, and under each what to type.

use std::ops::Range;

use tearmesh_cloth::statistics::{median, spread};

use super::{Guide, Role, Row, Topic};
use crate::experiment::{Chart, Provenance, Status};
use crate::front::FLOORS;
use crate::method::{DEFAULT, DefaultMethod};
use crate::plot::{Axis, Figure, Layer, Mark, PALE, Panel, Strip, short};

/// The errors that are good enough for a look, and for forces.
const LOOK: f64 = 0.2;
const FORCES: f64 = 0.05;

/// The topics of panels of errors, and their titles.
const ERRORS: [(Topic, &str); 4] = [
    (Topic::Hang, "hang: the shape at rest"),
    (
        Topic::Flag,
        "flag: where the free corner is, and how far it swings",
    ),
    (Topic::Rip, "rip: time and force of the first tear"),
    (Topic::Trouser, "trouser: time and force of the first tear"),
];

/// A quantity of a run.
type Quantity = fn(&Row) -> Option<f64>;

/// The quantities of [`Topic::Aftermath`], each with a panel of its own.
const QUANTITIES: [(&str, Quantity); 2] = [
    ("torn length, m", |row| row.torn_m),
    ("work of the hand, J", |row| row.work_j),
];

/// A method at one step: all runs of it.
struct Point<'a> {
    /// Its first run.
    row: &'a Row,
    method: DefaultMethod,
    /// CPU seconds per simulated second, as the median of the runs.
    cost: Option<f64>,
    /// The 10 %, 50 % and 90 % points of the error in per cent or of the quantity.
    y: Option<[f64; 3]>,
}

/// A panel's points on the finest mesh, and on one of half as many cells.
struct Section<'a> {
    title: String,
    /// The label of the vertical axis.
    label: &'static str,
    is_error: bool,
    fine: Vec<Point<'a>>,
    coarse: Vec<Point<'a>>,
    /// What other diagonals of the mesh leave.
    band: Option<Range<f64>>,
}

impl Chart for Guide {
    fn figure(&self, rows: &[Row], provenance: &Provenance) -> Figure {
        let sections = sections(rows);
        let cells = finest(rows);
        Figure {
            title: title(&sections),
            about: format!(
                "CPU seconds per simulated second on meshes of {cells} cells a side (thin lines: {}), against the \
                 error of what the scene is about. Down and to the left is better.",
                cells / 2
            ),
            columns: 2,
            panel_size: [600.0, 400.0],
            panels: sections.iter().map(Section::panel).collect(),
            footer: vec![
                "Large marks: a method at its default. Small marks: its default step four times and twice as long \
                 and half as long; in the pink strip those that were refused, blew up or did not end. Grey band: \
                 below the error that other diagonals of the mesh make; nothing in it is worth paying for. Hollow: \
                 below ten times the distance of two references, known no better. Bars: 10 to 90 % over seeds."
                    .to_owned(),
                provenance.footer(),
            ],
            ..Figure::default()
        }
    }

    fn summary(&self, rows: &[Row]) -> String {
        let sections = sections(rows);
        let mut text = title(&sections) + "\n";
        for section in sections.iter().filter(|section| section.is_error) {
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
    let of = |topic: Topic, role: Role, cells: u32| -> Vec<&Row> {
        let is_it = |row: &&Row| (row.topic, row.role, row.cells) == (topic, role, cells);
        rows.iter().filter(is_it).collect()
    };
    let cells = finest(rows);
    let errors = ERRORS.map(|(topic, title)| {
        let percent = |of: &[&Row]| {
            let [low, error, high] = [of[0].error_low?, of[0].error?, of[0].error_high?];
            Some([low, error.max(1e-8), high].map(|error| 100.0 * error))
        };
        let [fine, coarse] = [cells, cells / 2].map(|cells| of(topic, Role::Method, cells));
        let mesh = fine.first().and_then(|row| row.error_mesh);
        Section {
            title: title.to_owned(),
            label: "error, %",
            is_error: true,
            fine: points(&fine, percent),
            coarse: points(&coarse, percent),
            band: mesh.map(|error| 0.0..100.0 * error),
        }
    });
    let values = QUANTITIES.map(|(label, value)| {
        let range = |of: &[&Row]| {
            let values: Vec<f64> = of.iter().filter_map(|row| value(row)).collect();
            (!values.is_empty()).then(|| spread(&values))
        };
        let [fine, mesh] = [Role::Method, Role::Mesh].map(|role| of(Topic::Aftermath, role, cells));
        Section {
            title: format!("After the first tear of rip: {label}"),
            label,
            is_error: false,
            fine: points(&fine, range),
            coarse: Vec::new(),
            band: range(&mesh).map(|[low, _, high]| low..high),
        }
    });
    errors.into_iter().chain(values).collect()
}

/// A point per method and step.
fn points<'a>(rows: &[&'a Row], y: impl Fn(&[&Row]) -> Option<[f64; 3]>) -> Vec<Point<'a>> {
    let ensembles = rows.chunk_by(|a, b| a.ensemble() == b.ensemble());
    let points = ensembles.filter_map(|of| {
        Some(Point {
            row: of[0],
            method: DefaultMethod::named(&of[0].method)?,
            cost: median(of.iter().filter_map(|row| row.cpu_s_per_s).collect()),
            y: y(of),
        })
    });
    points.collect()
}

impl Point<'_> {
    fn is_default(&self) -> bool {
        self.row.step_multiple.is_none()
    }

    fn at(&self) -> Option<[f64; 2]> {
        Some([self.cost?, self.y?[1]])
    }

    /// The mark; hollow for an error below ten times the distance of the references.
    fn mark(&self) -> Mark {
        let size = if self.is_default() { 6.5 } else { 3.0 };
        let mark = self.method.family.mark().sized(size);
        match self.row.error.zip(self.row.error_floor) {
            Some((error, floor)) if error < FLOORS * floor => mark.hollow(),
            _ => mark,
        }
    }

    /// The method and the step.
    fn name(&self) -> String {
        let step = match self.row.step_multiple {
            None => "at its default".to_owned(),
            Some(multiple) => format!("at {multiple} times its step"),
        };
        let dt = self.row.dt_s.map(|dt| format!(", {} s", short(dt, 3)));
        format!("{} {step}{}", self.method.name, dt.unwrap_or_default())
    }

    /// What to type for this method and step.
    fn command(&self) -> String {
        let mut command = format!("tearmesh tear in.obj --scene {}", self.row.topic.name());
        if self.method.name != DEFAULT {
            command += &format!(" --solver {}", self.method.name);
        }
        if let (Some(_), Some(dt)) = (self.row.step_multiple, self.row.dt_s) {
            command += &format!(" --dt {}", short(dt, 3));
        }
        command + " -o out.obj"
    }
}

impl Section<'_> {
    fn panel(&self) -> Panel {
        let axis = [Axis::linear, Axis::log][usize::from(self.is_error)];
        let mut panel = Panel {
            title: self.title.clone(),
            about: self.about(),
            x: Axis::log("CPU seconds per simulated second"),
            y: axis(self.label),
            words: self.words(),
            ..Panel::default()
        };
        let points = self.fine.iter();
        let known = points.filter_map(|point| Some((point, point.at()?)));
        let known: Vec<(&Point<'_>, [f64; 2])> = known.collect();
        if known.is_empty() {
            return panel;
        }
        let layers = &mut panel.layers;
        let (band, colour) = (self.band.clone(), PALE);
        layers.extend(band.map(|y| Layer::Band { y, colour }));
        let label = "real time".to_owned();
        layers.push(Layer::Rule { x: 1.0, label });
        let line = |points, mark: Mark, width| Layer::Line {
            points,
            colour: mark.colour,
            width,
        };
        for (points, width) in [(&self.coarse, 0.7), (&self.fine, 1.6)] {
            for of in points.chunk_by(|a, b| a.method.name == b.method.name) {
                let mut points: Vec<[f64; 2]> = of.iter().filter_map(Point::at).collect();
                points.sort_by(|a, b| a[0].total_cmp(&b[0]));
                layers.push(line(points, of[0].mark(), width));
            }
        }
        for &(point, at) in &known {
            let mark = point.mark();
            if let Some([low, _, high]) = point.y.filter(|[low, _, high]| low < high) {
                layers.push(line(vec![[at[0], low], [at[0], high]], mark, 1.0));
            }
            let hover = format!("{}: {} {}", point.name(), self.label, short(at[1], 3));
            layers.push(Layer::Mark { at, mark, hover });
        }
        let defaults = known.iter().filter(|(point, _)| point.is_default());
        layers.extend(defaults.map(|&(point, at)| Layer::Label {
            at,
            text: point.method.name.to_owned(),
            colour: point.mark().colour,
        }));
        panel.above = self.failures();
        panel
    }

    /// The points of each method.
    fn methods(&self) -> impl Iterator<Item = &[Point<'_>]> {
        self.fine.chunk_by(|a, b| a.method.name == b.method.name)
    }

    /// The runs that failed, at the cost that their step would have.
    fn failures(&self) -> Option<Strip> {
        let marks = self.methods().flat_map(|of| {
            let default = of.iter().find(|point| point.is_default());
            let failed = of.iter().filter(|point| point.row.status != Status::Ok);
            failed.filter_map(move |point| {
                let cost = default?.cost? / point.row.step_multiple?;
                let (status, why) = (point.row.status.name(), &point.row.why);
                let hover = format!("{}: {status} {why}", point.name());
                Some((cost, point.method.family.mark(), hover))
            })
        });
        let marks: Vec<(f64, Mark, String)> = marks.collect();
        (!marks.is_empty()).then(|| Strip {
            label: "refused, blown up or without an end".to_owned(),
            marks,
        })
    }

    fn about(&self) -> String {
        if !self.is_error {
            return "medians and 10 to 90 % over seeds; one run says little".to_owned();
        }
        let Some(Point { row, .. }) = self.fine.iter().find(|point| point.y.is_some()) else {
            return "no reference: the two references have no value, or noise grows too much"
                .to_owned();
        };
        let percent = |error: Option<f64>| match error {
            None => "unknown".to_owned(),
            Some(error) => format!("{} %", short(100.0 * error, 2)),
        };
        let grown = row.noise_amplification;
        let grown = grown.map_or("unknown".to_owned(), |grown| {
            format!("×{}", short(grown, 2))
        });
        format!(
            "two references {} apart; other diagonals of the mesh: {}; a nanometre of noise: {}, and displacements \
             grow {grown}",
            percent(row.error_floor),
            percent(row.error_mesh),
            percent(row.error_noise)
        )
    }

    /// What to type for a look and for forces, and when it fails; of a quantity its distributions.
    fn words(&self) -> Vec<String> {
        if !self.is_error {
            let known = self.fine.iter().filter_map(|point| Some((point, point.y?)));
            let each = known.map(|(point, y)| {
                let [low, middle, high] = y.map(|x| short(x, 2));
                format!("{} {middle} ({low} to {high})", point.method.name)
            });
            let each: Vec<String> = each.collect();
            return vec![format!(
                "Medians, and what eight runs in ten have: {}. Two runs that differ by a nanometre differ as much. \
                 Grey band: runs by {DEFAULT} on meshes with other diagonals.",
                each.join(", ")
            )];
        }
        let mut failing: Vec<String> = Vec::new();
        for of in self.methods() {
            let name = of[0].method.name;
            let failed = of.iter().filter(|point| point.row.status != Status::Ok);
            let shortest_s = failed
                .filter_map(|point| point.row.dt_s)
                .min_by(f64::total_cmp);
            let refused = shortest_s.map(|dt| short(1e3 * dt, 2));
            failing.extend(refused.map(|ms| format!("{name} takes no step of {ms} ms")));
            let default = of.iter().find(|point| point.is_default());
            let error = default.and_then(|point| point.row.error);
            let off = error.filter(|error| *error > LOOK);
            let off = off.map(|error| short(100.0 * error, 2));
            failing.extend(off.map(|error| format!("{name} at its default is {error} % off")));
        }
        if failing.is_empty() {
            failing.push("nothing failed".to_owned());
        }
        let what = match self.fine.first().map(|point| point.row.topic) {
            Some(Topic::Rip | Topic::Trouser) => "forces within 5 %",
            _ => "an error below 5 %",
        };
        vec![
            format!("For a look (20 %): {}.", self.cheapest(LOOK)),
            format!("For {what}: {}.", self.cheapest(FORCES)),
            format!("It fails when: {}.", failing.join("; ")),
        ]
    }

    /// The command with the least cost among those that have no larger error.
    fn cheapest(&self, error_max: f64) -> String {
        let meets = self.fine.iter().filter_map(|point| {
            let error = point.row.error.filter(|error| *error <= error_max)?;
            Some((point.cost?, error, point))
        });
        let Some((cost, error, point)) = meets.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return "no method at any of these steps".to_owned();
        };
        let (cost, error) = (short(cost, 2), short(100.0 * error, 2));
        format!(
            "`{}` ({cost} CPU s a second, {error} % off)",
            point.command()
        )
    }
}

/// In how many scenes the default method is within 5 %, and the other methods.
fn title(sections: &[Section<'_>]) -> String {
    let errors = |name: &'static str| {
        let points = sections.iter().flat_map(|section| &section.fine);
        let of = points.filter(move |point| point.is_default() && point.method.name == name);
        of.filter_map(|point| point.row.error)
    };
    let within = |name| errors(name).filter(|error| *error <= FORCES).count();
    let others = DefaultMethod::NAMES
        .into_iter()
        .filter(|name| *name != DEFAULT);
    let others: Vec<String> = others
        .map(|name| format!("{name} {}", within(name)))
        .collect();
    format!(
        "Which method for my scene? {DEFAULT}, the default, is within 5 % in {} of {} scenes ({})",
        within(DEFAULT),
        errors(DEFAULT).count(),
        others.join(", ")
    )
}

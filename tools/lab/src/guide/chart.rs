//! The page: a panel per question, and under each what to type.

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

/// What a panel is about.
struct Question {
    topic: Topic,
    title: &'static str,
    /// The label of the vertical axis.
    label: &'static str,
    /// The quantity along the vertical axis; `None` for the error.
    value: Option<fn(&Row) -> Option<f64>>,
}

const QUESTIONS: [Question; 6] = [
    Question {
        topic: Topic::Hang,
        title: "hang: the shape at rest",
        label: "error, %",
        value: None,
    },
    Question {
        topic: Topic::Flag,
        title: "flag: where the free corner is, and how far it swings",
        label: "error, %",
        value: None,
    },
    Question {
        topic: Topic::Rip,
        title: "rip: time and force of the first tear",
        label: "error, %",
        value: None,
    },
    Question {
        topic: Topic::Trouser,
        title: "trouser: time and force of the first tear",
        label: "error, %",
        value: None,
    },
    Question {
        topic: Topic::Aftermath,
        title: "After the first tear of rip: torn length, m",
        label: "torn length, m",
        value: Some(|row| row.torn_m),
    },
    Question {
        topic: Topic::Aftermath,
        title: "After the first tear of rip: work of the hand, J",
        label: "work of the hand, J",
        value: Some(|row| row.work_j),
    },
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

/// A panel's points on the finest mesh and on one of half as many cells, and the values on other diagonals.
struct Section<'a> {
    question: &'static Question,
    fine: Vec<Point<'a>>,
    coarse: Vec<Point<'a>>,
    on_meshes: Vec<f64>,
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
        for section in sections.iter().filter(|one| one.question.value.is_none()) {
            writeln!(text, "{} ({})", section.question.title, section.about())
                .expect("a string grows");
            for line in section.words() {
                writeln!(text, "  {line}").expect("a string grows");
            }
        }
        text
    }
}

fn finest(rows: &[Row]) -> u32 {
    rows.iter().map(|row| row.cells).max().unwrap_or(0)
}

fn sections(rows: &[Row]) -> Vec<Section<'_>> {
    let cells = finest(rows);
    let section = |question: &'static Question| {
        let of = |role: Role, cells: u32| -> Vec<&Row> {
            let key = (question.topic, role, cells);
            let of = rows
                .iter()
                .filter(|row| (row.topic, row.role, row.cells) == key);
            of.collect()
        };
        let points = |cells: u32| points(&of(Role::Method, cells), question.value);
        Section {
            question,
            fine: points(cells),
            coarse: points(cells / 2),
            on_meshes: of(Role::Mesh, cells)
                .into_iter()
                .filter_map(question.value.unwrap_or(|_| None))
                .collect(),
        }
    };
    QUESTIONS.iter().map(section).collect()
}

/// A point per method and step.
fn points<'a>(rows: &[&'a Row], value: Option<fn(&Row) -> Option<f64>>) -> Vec<Point<'a>> {
    let points = rows
        .chunk_by(|a, b| a.ensemble() == b.ensemble())
        .filter_map(|of| {
            let y = match value {
                None => of[0].error_low.zip(of[0].error).zip(of[0].error_high).map(
                    |((low, error), high)| [low, error.max(1e-8), high].map(|error| 100.0 * error),
                ),
                Some(value) => {
                    let values: Vec<f64> = of.iter().filter_map(|row| value(row)).collect();
                    (!values.is_empty()).then(|| spread(&values))
                }
            };
            Some(Point {
                row: of[0],
                method: DefaultMethod::named(&of[0].method)?,
                cost: median(of.iter().filter_map(|row| row.cpu_s_per_s).collect()),
                y,
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
        let mark = self.method.family.mark();
        let mark = mark.sized(if self.is_default() { 6.5 } else { 3.0 });
        match self.row.error.zip(self.row.error_floor) {
            Some((error, floor)) if error < FLOORS * floor => mark.hollow(),
            _ => mark,
        }
    }

    /// The method and the step.
    fn name(&self) -> String {
        let multiple = self.row.step_multiple;
        let multiple = multiple.map_or("at its default".to_owned(), |x| {
            format!("at {x} times its step")
        });
        let dt = self.row.dt_s;
        let dt = dt.map_or(String::new(), |dt| format!(", {} s", short(dt, 3)));
        format!("{} {multiple}{dt}", self.method.name)
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
        let Question {
            title,
            label,
            value,
            ..
        } = *self.question;
        let mut panel = Panel {
            title: title.to_owned(),
            about: self.about(),
            x: Axis::log("CPU seconds per simulated second"),
            y: if value.is_some() {
                Axis::linear(label)
            } else {
                Axis::log(label)
            },
            words: self.words(),
            ..Panel::default()
        };
        let known = || {
            self.fine
                .iter()
                .filter_map(|point| Some((point, point.at()?)))
        };
        if known().next().is_none() {
            return panel;
        }
        let band = match self.on_meshes[..] {
            [] => self.fine[0].row.error_mesh.map(|mesh| 0.0..100.0 * mesh),
            _ => {
                let [low, _, high] = spread(&self.on_meshes);
                Some(low..high)
            }
        };
        panel
            .layers
            .extend(band.map(|y| Layer::Band { y, colour: PALE }));
        panel.layers.push(Layer::Rule {
            x: 1.0,
            label: "real time".to_owned(),
        });
        for (points, width) in [(&self.coarse, 0.7), (&self.fine, 1.6)] {
            for of in points.chunk_by(|a, b| a.method.name == b.method.name) {
                let mut points: Vec<[f64; 2]> = of.iter().filter_map(Point::at).collect();
                points.sort_by(|a, b| a[0].total_cmp(&b[0]));
                let colour = of[0].method.family.mark().colour;
                panel.layers.push(Layer::Line {
                    points,
                    colour,
                    width,
                });
            }
        }
        for (point, at) in known() {
            let mark = point.mark();
            if let Some([low, _, high]) = point.y.filter(|[low, _, high]| low < high) {
                panel.layers.push(Layer::Line {
                    points: vec![[at[0], low], [at[0], high]],
                    colour: mark.colour,
                    width: 1.0,
                });
            }
            let hover = match value {
                None => format!("{}: error {} %", point.name(), short(at[1], 3)),
                Some(_) => format!("{}: {label} {}", point.name(), short(at[1], 3)),
            };
            panel.layers.push(Layer::Mark { at, mark, hover });
        }
        panel.layers.extend(
            known()
                .filter(|(point, _)| point.is_default())
                .map(|(point, at)| Layer::Label {
                    at,
                    text: point.method.name.to_owned(),
                    colour: point.mark().colour,
                }),
        );
        panel.above = self.failures();
        panel
    }

    /// The runs that failed, at the cost that their step would have.
    fn failures(&self) -> Option<Strip> {
        let failed = self
            .fine
            .iter()
            .filter(|point| point.row.status != Status::Ok);
        let marks = failed.filter_map(|point| {
            let mut of = self
                .fine
                .iter()
                .filter(|other| other.method.name == point.method.name);
            let default = of.find(|other| other.is_default())?;
            let cost = default.cost? / point.row.step_multiple?;
            let (status, why) = (point.row.status.name(), &point.row.why);
            let hover = format!("{}: {status} {why}", point.name());
            Some((cost, point.method.family.mark(), hover))
        });
        let marks: Vec<(f64, Mark, String)> = marks.collect();
        (!marks.is_empty()).then(|| Strip {
            label: "refused, blown up or without an end".to_owned(),
            marks,
        })
    }

    fn about(&self) -> String {
        let is_known = self.fine.iter().any(|point| point.y.is_some());
        match self.fine.first() {
            Some(_) if self.question.value.is_some() => {
                "medians and 10 to 90 % over seeds; one run says little".to_owned()
            }
            Some(Point { row, .. }) if is_known => {
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
                    "two references {} apart; other diagonals of the mesh: {}; a nanometre of noise: {}, and \
                     displacements grow {noise}",
                    percent(row.error_floor),
                    percent(row.error_mesh),
                    percent(row.error_noise)
                )
            }
            _ => {
                "no reference: the two references have no value, or noise grows too much".to_owned()
            }
        }
    }

    fn words(&self) -> Vec<String> {
        match self.question.value {
            None => self.advice(),
            Some(_) => self.distributions(),
        }
    }

    /// What to type for a look and for forces, and when it fails.
    fn advice(&self) -> Vec<String> {
        let cheapest = |error_max: f64| {
            let meets = self.fine.iter().filter_map(|point| {
                let error = point.row.error.filter(|error| *error <= error_max)?;
                Some((point.cost?, error, point))
            });
            match meets.min_by(|a, b| a.0.total_cmp(&b.0)) {
                None => "no method at any of these steps".to_owned(),
                Some((cost, error, point)) => format!(
                    "`{}` ({} CPU s a second, {} % off)",
                    point.command(),
                    short(cost, 2),
                    short(100.0 * error, 2)
                ),
            }
        };
        let mut failing: Vec<String> = Vec::new();
        for of in self.fine.chunk_by(|a, b| a.method.name == b.method.name) {
            let name = of[0].method.name;
            let failed = of.iter().filter(|point| point.row.status != Status::Ok);
            let shortest = failed
                .filter_map(|point| point.row.dt_s)
                .min_by(f64::total_cmp);
            failing.extend(
                shortest.map(|dt| format!("{name} takes no step of {} ms", short(1e3 * dt, 2))),
            );
            let default = of.iter().find(|point| point.is_default());
            let error = default
                .and_then(|point| point.row.error)
                .filter(|error| *error > LOOK);
            failing.extend(error.map(|error| {
                format!("{name} at its default is {} % off", short(100.0 * error, 2))
            }));
        }
        if failing.is_empty() {
            failing.push("nothing failed".to_owned());
        }
        let what = match self.question.topic {
            Topic::Rip | Topic::Trouser => "forces within 5 %",
            Topic::Hang | Topic::Flag | Topic::Aftermath => "an error below 5 %",
        };
        vec![
            format!("For a look (20 %): {}.", cheapest(LOOK)),
            format!("For {what}: {}.", cheapest(FORCES)),
            format!("It fails when: {}.", failing.join("; ")),
        ]
    }

    /// How the quantity is distributed by each method.
    fn distributions(&self) -> Vec<String> {
        let label = self.question.label;
        let quantity = label.split(',').next().unwrap_or(label);
        let known = self
            .fine
            .iter()
            .filter_map(|point| Some((point.method.name, point.y?)));
        let (default, others): (Vec<_>, Vec<_>) = known.partition(|(name, _)| *name == DEFAULT);
        let Some((_, range)) = default.first() else {
            return Vec::new();
        };
        let [low, middle, high] = range.map(|x| short(x, 2));
        let mut words = vec![format!(
            "By {DEFAULT}, eight runs in ten have a {quantity} of {low} to {high}, and the median is {middle}. Two \
             runs that differ by a nanometre differ as much."
        )];
        if !others.is_empty() {
            let others = others
                .iter()
                .map(|(name, [_, other, _])| format!("{name} {}", short(*other, 2)));
            let others: Vec<String> = others.collect();
            words.push(format!("Medians by other methods: {}.", others.join(", ")));
        }
        if !self.on_meshes.is_empty() {
            words.push(
                "Grey band: 10 to 90 % of runs by the default on meshes with other diagonals."
                    .to_owned(),
            );
        }
        words
    }
}

/// In how many scenes the default method is within 5 %, and the other methods.
fn title(sections: &[Section<'_>]) -> String {
    let errors = |name: &'static str| {
        let points = sections.iter().flat_map(|section| &section.fine);
        let defaults = points.filter(move |point| point.is_default() && point.method.name == name);
        defaults.filter_map(|point| point.row.error)
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

//! The figures of a scene: rows, floors, fronts, and what is the better buy.

use serde::{Deserialize, Serialize};

use super::measure::Measure;
use crate::pareto::{FLOORS, Family, MARGIN, Point, Status, front, vouched};

/// The results of a scene on all meshes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SceneStudy {
    /// The name of the scene.
    pub scene: String,
    /// A short description of the scene.
    pub about: String,
    /// The distance of two runs on the finest mesh that differ by noise, divided by the noise; `None` if they
    /// failed or did not run.
    pub amplification: Option<f64>,
    /// Whether displacements are not compared, because noise grows too much or its growth is unknown.
    pub is_barred: bool,
    /// The runs on the finest mesh.
    pub references: Vec<ReferenceRun>,
    /// The floor of each measure that is compared.
    pub floors: Vec<Floor>,
    /// The runs on the other meshes, ordered by mesh from coarse to fine, then by method, then by step from
    /// long to short.
    pub rows: Vec<Row>,
}

/// A run on the finest mesh.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ReferenceRun {
    /// The name of the run.
    pub name: String,
    /// The way in which the run ended.
    pub status: Status,
    /// The reason if a step failed or the energy grew too much; otherwise empty.
    pub why: String,
    /// The step in seconds; `None` if the run was not begun.
    pub dt_s: Option<f64>,
    /// The number of visits of edges.
    pub visits: u64,
}

/// The accuracy to which the value of a measure on the finest mesh is known.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Floor {
    /// The measure.
    pub measure: Measure,
    /// The value on the finest mesh, in the unit of the measure; `None` for displacements, which have many,
    /// and if it is unknown.
    pub value: Option<f64>,
    /// The relative distance between the runs on the finest mesh by two methods, or the error that remains
    /// where rows end at rest, if that is larger. `None` if a run has no value; then rows have no error.
    pub floor: Option<f64>,
}

/// A run on a mesh at a step.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// The name of the method with its settings.
    pub method: String,
    /// The family of methods.
    pub family: Family,
    /// The number of cells along each side of the mesh.
    pub cells: u32,
    /// The fraction of the base step.
    pub part: f64,
    /// The step in seconds; `None` if the run was not begun.
    pub dt_s: Option<f64>,
    /// The way in which the run ended.
    pub status: Status,
    /// The reason if a step failed or the energy grew too much; otherwise empty.
    pub why: String,
    /// The number of steps that succeeded.
    pub steps: u64,
    /// The number of visits of edges.
    pub visits: u64,
    /// The errors of a run that succeeded, one per measure whose error is known.
    pub errors: Vec<Error>,
}

/// The error of a run by one measure. Errors are relative to the finest mesh; smaller is better.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Error {
    /// The measure.
    pub measure: Measure,
    /// The value, in the unit of the measure; `None` for displacements, which have many.
    pub value: Option<f64>,
    /// The distance of the run from the finest mesh.
    pub total: f64,
    /// The distance of the run from the shortest step of its method on its mesh; `None` if that failed.
    pub of_step: Option<f64>,
    /// The distance of the shortest step of its method on its mesh from the finest mesh; `None` if that
    /// failed.
    pub of_mesh: Option<f64>,
    /// The largest `total` of this and all shorter steps of its method on its mesh. So no error of the step
    /// that happens to cancel one of the mesh makes a run look better than it is.
    pub vouched: f64,
    /// Whether `vouched` is below ten times the floor, and so known no better than that.
    pub is_at_floor: bool,
    /// Whether the run is on the front of error against visits of edges of its method, over meshes and steps.
    pub is_on_front: bool,
    /// Whether halving the step or halving the edge is the better buy; `None` if either was not tried.
    pub buy: Option<Buy>,
}

/// Two ways to buy precision, and the better of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Buy {
    /// The part by which the error falls when the step is halved; negative if it grows, `None` if that run
    /// failed.
    pub by_step: Option<f64>,
    /// The part by which the error falls when the edge is halved; negative if it grows, `None` if that run
    /// failed.
    pub by_mesh: Option<f64>,
    /// The logarithm of the ratio of errors divided by that of the ratio of costs, when the step is halved;
    /// `None` if that run failed. A ratio of costs below 1/0.9 counts as that.
    pub rate_of_step: Option<f64>,
    /// The logarithm of the ratio of errors divided by that of the ratio of costs, when the edge is halved;
    /// `None` if that run failed. A ratio of costs below 1/0.9 counts as that.
    pub rate_of_mesh: Option<f64>,
    /// The better of the two.
    pub better: Better,
}

/// The better buy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Better {
    /// Halving the step lowers the error more per factor of cost.
    Step,
    /// Halving the edge lowers the error more per factor of cost.
    Mesh,
    /// Neither lowers the error by a tenth.
    Neither,
}

impl Better {
    /// Returns the name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Better::Step => "step",
            Better::Mesh => "mesh",
            Better::Neither => "neither",
        }
    }
}

impl Row {
    /// Returns the error of the row by a measure; `None` if it is not known.
    #[must_use]
    pub fn error(&self, measure: Measure) -> Option<&Error> {
        self.errors.iter().find(|error| error.measure == measure)
    }

    fn error_mut(&mut self, measure: Measure) -> Option<&mut Error> {
        let mut errors = self.errors.iter_mut();
        errors.find(|error| error.measure == measure)
    }
}

impl SceneStudy {
    /// Returns the names of the methods, in the order of the rows.
    #[must_use]
    pub fn methods(&self) -> Vec<&str> {
        let mut methods: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !methods.contains(&row.method.as_str()) {
                methods.push(&row.method);
            }
        }
        methods
    }

    /// Computes all that compares rows with each other: what their steps vouch for, fronts and buys. A change
    /// of rows needs a new call.
    pub fn rank(&mut self) {
        let methods: Vec<String> = self.methods().into_iter().map(str::to_owned).collect();
        for Floor { measure, floor, .. } in self.floors.clone() {
            let Some(floor) = floor else {
                continue;
            };
            self.vouch(measure, floor);
            for method in &methods {
                self.mark_front(measure, floor, method);
            }
            self.find_buys(measure, floor);
        }
    }

    fn vouch(&mut self, measure: Measure, floor: f64) {
        let series: Vec<(String, u32)> = self
            .rows
            .iter()
            .map(|row| (row.method.clone(), row.cells))
            .collect();
        for (i, of) in series.iter().enumerate() {
            if series[..i].contains(of) {
                continue;
            }
            let own = self
                .rows
                .iter_mut()
                .zip(&series)
                .filter(|(_, other)| *other == of);
            let own = own.filter_map(|(row, _)| Some((row.part, row.error_mut(measure)?)));
            let mut own: Vec<(f64, &mut Error)> = own.collect();
            own.sort_by(|a, b| b.0.total_cmp(&a.0));
            let totals: Vec<f64> = own.iter().map(|(_, error)| error.total).collect();
            for ((_, error), vouched) in own.into_iter().zip(vouched(&totals)) {
                error.vouched = vouched;
                error.is_at_floor = vouched < FLOORS * floor;
            }
        }
    }

    fn mark_front(&mut self, measure: Measure, floor: f64, method: &str) {
        let own = self.rows.iter_mut().filter(|row| row.method == method);
        let own = own.filter_map(|row| Some((row.visits as f64, row.error_mut(measure)?)));
        let own: Vec<(f64, &mut Error)> = own.collect();
        let point = |(cost, error): &(f64, &mut Error)| Point {
            cost: *cost,
            error: known(error, floor),
        };
        let points: Vec<Point> = own.iter().map(point).collect();
        for ((_, error), is_on) in own.into_iter().zip(front(&points)) {
            error.is_on_front = is_on;
        }
    }

    fn find_buys(&mut self, measure: Measure, floor: f64) {
        let buys: Vec<Option<Buy>> = self
            .rows
            .iter()
            .map(|row| self.buy(row, measure, floor))
            .collect();
        for (row, buy) in self.rows.iter_mut().zip(buys) {
            if let Some(error) = row.error_mut(measure) {
                error.buy = buy;
            }
        }
    }

    /// `None` where the row has no error, or where one of the two was not tried.
    fn buy(&self, row: &Row, measure: Measure, floor: f64) -> Option<Buy> {
        let from = point(row, measure, floor)?;
        let at = |cells: u32, part: f64| {
            let mut rows = self.rows.iter();
            rows.find(|other| {
                other.method == row.method && other.cells == cells && other.part == part
            })
        };
        let step = point(at(row.cells, row.part / 2.0)?, measure, floor);
        let mesh = point(at(2 * row.cells, row.part)?, measure, floor);
        let falls = |to: Option<Point>| to.map(|to| 1.0 - to.error / from.error);
        let rates = [step, mesh].map(|to| to.map(|to| rate(from, to)));
        Some(Buy {
            by_step: falls(step),
            by_mesh: falls(mesh),
            rate_of_step: rates[0],
            rate_of_mesh: rates[1],
            better: better([falls(step), falls(mesh)], rates),
        })
    }
}

/// An error as far as it is known: below the floor nobody is better than another.
fn known(error: &Error, floor: f64) -> f64 {
    error.vouched.max(FLOORS * floor)
}

fn point(row: &Row, measure: Measure, floor: f64) -> Option<Point> {
    let error = known(row.error(measure)?, floor);
    Some(Point {
        cost: row.visits as f64,
        error,
    })
}

/// How far the error falls per factor of cost. What costs next to nothing would otherwise have any rate.
fn rate(from: Point, to: Point) -> f64 {
    let dearer = (to.cost / from.cost).max(1.0 / (1.0 - MARGIN));
    (from.error / to.error).ln() / dearer.ln()
}

/// Of the two ways those count that lower the error by a tenth.
fn better(falls: [Option<f64>; 2], rates: [Option<f64>; 2]) -> Better {
    let of = |i: usize| {
        let is_buy = falls[i].is_some_and(|fall| fall >= MARGIN);
        rates[i].filter(|_| is_buy)
    };
    match (of(0), of(1)) {
        (None, None) => Better::Neither,
        (step, mesh) if step > mesh => Better::Step,
        _ => Better::Mesh,
    }
}

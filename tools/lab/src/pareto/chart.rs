//! The figure and the summary of a table: a panel per case and observable, and the cheapest run for each
//! tolerance.

use super::front::{Ranked, ranked};
use super::{AMPLIFICATION_MAX, FLOORS, Observable, Pareto, Row, SCENES};
use crate::experiment::{Draw, Status};
use crate::method::{DEFAULT, Family};
use crate::plot::{Axis, Figure, INK, Layer, Mark, Panel, Shape, Strip, percent, short};

/// The error at which the title counts the cheapest methods.
const TITLE_ERROR: f64 = 0.01;

/// The tolerances for [`Observable::Displacement`], as relative errors.
const FINE: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// The tolerances for all other observables, as relative errors.
const COARSE: [f64; 4] = [0.2, 0.1, 0.05, 0.02];

/// How to read the figure.
const READING: &str = "A line joins the runs of a method that none of its other settings beats in both; dots are its \
     other runs. Grey line: the front, where no run is a tenth better in one and no worse in the other. Ring: default \
     settings, black for the default method. Hollow, in the shaded band: below ten times the error floor, known no \
     better. Pink strip: runs that failed, at the cost they had reached.";

impl Draw for Pareto {
    fn figure(&self, rows: &[Row]) -> Figure {
        let groups = groups(rows);
        let is_there = |family: &Family| rows.iter().any(|row| row.family == Some(*family));
        let families = Family::all().filter(is_there);
        let entry = |family: Family| (family.mark(), family.name().to_owned());
        Figure {
            title: title(&groups),
            about: "Relative error against edge visits, one panel per scene and observable. Down and to the left is \
                    better."
                .to_owned(),
            legend: families.map(entry).collect(),
            layout: (3, [390.0, 330.0]),
            panels: groups.iter().map(|group| group.panel()).collect(),
            footer: vec![READING.to_owned()],
        }
    }

    fn summary(&self, rows: &[Row]) -> String {
        let mut text = String::from("the cheapest run for each tolerance, by edge visits\n");
        for case in cases(rows) {
            text += &format!("{} {}\n", case[0].scene, about(&case[0]));
            for group in groups(case) {
                let (name, line) = (group.observable.name(), group.tolerances());
                text += &format!("  {name:<33} {line}\n");
            }
        }
        text
    }
}

fn cases(rows: &[Row]) -> impl Iterator<Item = &[Row]> {
    rows.chunk_by(|a, b| a.case() == b.case())
}

/// The runs of a case by an observable.
pub(super) struct Group<'a> {
    case: &'a [Row],
    pub(super) observable: Observable,
    pub(super) floor: Option<f64>,
    /// The runs that have an error.
    pub(super) runs: Vec<Ranked<'a>>,
}

/// The cases with each observable that they have.
pub(super) fn groups(rows: &[Row]) -> Vec<Group<'_>> {
    let mut groups = Vec::new();
    for case in cases(rows) {
        let known = case.iter().filter(|row| row.observable.is_some());
        let mut known: Vec<&Row> = known.collect();
        known.sort_by_key(|row| row.observable);
        for of in known.chunk_by(|a, b| a.observable == b.observable) {
            groups.extend(of[0].observable.map(|observable| Group {
                case,
                observable,
                floor: of[0].error_floor,
                runs: ranked(of),
            }));
        }
    }
    groups
}

/// The methods that are the cheapest at an error of 1 % most often.
fn title(groups: &[Group<'_>]) -> String {
    let compared = groups.iter().filter(|group| !group.observable.is_energy());
    let winners = compared.filter_map(|group| group.cheapest(TITLE_ERROR)?.row.family);
    let winners: Vec<Family> = winners.collect();
    let wins = |family: &Family| winners.iter().filter(|one| *one == family).count();
    let most = Family::all().map(|family| wins(&family)).max().unwrap_or(0);
    if most == 0 {
        return "No method reached an error below 1 %".to_owned();
    }
    let best = Family::all().filter(|family| wins(family) == most);
    let best: Vec<&str> = best.map(Family::name).collect();
    let how = match best.len() {
        1 => "is the cheapest way",
        _ => "are each the cheapest way",
    };
    format!(
        "{} {how} to an error below 1 % in {most} of {} panels, by edge visits",
        best.join(" and "),
        winners.len(),
    )
}

impl Group<'_> {
    fn panel(&self) -> Panel {
        let (first, floor) = (&self.case[0], self.floor);
        let title = format!("{}: {}", first.scene, self.observable.name());
        let axes = ["edge visits", "relative error"].map(Axis::log);
        let mut panel = Panel::new(&title, &about(first), axes, Vec::new());
        if self.runs.is_empty() {
            panel.about = match (floor, first.noise_amplification) {
                (Some(_), _) => "no run reached its end".to_owned(),
                (None, Some(grown)) if grown > AMPLIFICATION_MAX => format!(
                    "not comparable: noise grows {}-fold, and {AMPLIFICATION_MAX} is the limit",
                    short(grown, 2)
                ),
                _ => "no reference".to_owned(),
            };
            return panel;
        }
        let layers = &mut panel.layers;
        layers.extend(floor.map(|floor| Layer::Band(0.0..FLOORS * floor)));
        // The front over all methods.
        let front = self.runs.iter().filter(|run| run.is_on_front);
        layers.push(Layer::curve(front.map(|run| run.at), [0xcc; 3], 3.0));
        for family in Family::all() {
            let own = self.runs.iter();
            let own = own.filter(|run| run.row.family == Some(family));
            draw_family(layers, family.mark(), &own.collect::<Vec<_>>());
        }
        let runs = self.runs.iter();
        for run in runs.filter(|run| run.row.step_fraction.is_none()) {
            let own = run.row.family.map_or(INK, |family| family.mark().colour);
            let is_default = run.row.is_default();
            let colour = if is_default { INK } else { own };
            layers.push(mark(run, Mark::new(Shape::RING, colour).sized(7.5)));
            if is_default {
                layers.push(Layer::Label(run.at, "default".to_owned(), INK));
            }
        }
        panel.above = self.failures();
        panel
    }

    /// The runs that failed, at the cost that they had reached.
    fn failures(&self) -> Option<Strip> {
        let failed = self.case.iter().filter(|row| row.family.is_some());
        let failed: Vec<&Row> = failed.filter(|row| row.status != Status::Ok).collect();
        let marks = failed.iter().filter_map(|row| {
            let hover = format!("{}: {} {}", row.run, row.status.name(), row.why);
            Some((row.cost()?, row.family?.mark(), hover))
        });
        (!failed.is_empty()).then(|| Strip {
            label: format!("{} failed", failed.len()),
            marks: marks.collect(),
        })
    }

    /// The cheapest run of the budget that meets a tolerance; `None` if none does, or if the tolerance is below ten
    /// times the floor.
    fn cheapest(&self, tolerance: f64) -> Option<&Ranked<'_>> {
        self.floor.filter(|floor| tolerance >= FLOORS * floor)?;
        let meets = self
            .runs
            .iter()
            .filter(|run| run.row.step_fraction.is_some() && run.error_converged <= tolerance);
        meets.min_by(|a, b| a.at[0].total_cmp(&b.at[0]))
    }

    /// The cheapest run for each tolerance.
    fn tolerances(&self) -> String {
        let Some(floor) = self.floor else {
            return "no reference, or noise grows too much".to_owned();
        };
        let is_fine = self.observable == Observable::Displacement;
        let tolerances = if is_fine { &FINE[..] } else { &COARSE };
        let default = self.runs.iter().find(|one| one.row.is_default());
        let answer = |tolerance: f64| match self.cheapest(tolerance) {
            None if tolerance < FLOORS * floor => "below the error floor".to_owned(),
            None => "no run".to_owned(),
            Some(Ranked { row, at, .. }) => {
                let meets = default.filter(|one| one.row.error_total <= Some(tolerance));
                match meets.map(|one| one.at[0] / at[0]) {
                    Some(ratio) => format!("{} (the default costs ×{ratio:.1})", row.run),
                    None => format!("{} ({DEFAULT} misses it)", row.run),
                }
            }
        };
        let answers = tolerances.iter();
        let answers = answers.map(|&most| format!("{}: {}", percent(most), answer(most)));
        answers.collect::<Vec<_>>().join(" · ")
    }
}

fn about(row: &Row) -> String {
    let scene = SCENES.iter().find(|scene| scene.name == row.scene);
    let grown = row.noise_amplification;
    let grown = grown.map_or(String::new(), |grown| {
        format!(", noise ×{}", short(grown, 2))
    });
    format!(
        "{}; {} N/m, mass ratio {} ({} {}{grown})",
        scene.map_or("", |scene| scene.about),
        short(row.stiffness_n_per_m, 3),
        short(row.mass_ratio, 3),
        row.mesh.name(),
        row.cells,
    )
}

/// The runs of a family: those that none of its others beats as marks on a line, the others as dots.
fn draw_family(layers: &mut Vec<Layer>, of_family: Mark, own: &[&Ranked<'_>]) {
    let beats = |a: [f64; 2], b: [f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    let is_best = |run: &Ranked<'_>| !own.iter().any(|other| beats(other.at, run.at));
    let best = own.iter().filter(|run| is_best(run)).map(|run| run.at);
    layers.push(Layer::curve(best, of_family.colour, 1.0));
    layers.extend(own.iter().map(|run| {
        let is_best = is_best(run);
        let mut shown = of_family.sized(if is_best { of_family.size } else { 1.6 });
        shown.is_hollow = is_best && run.row.is_at_floor();
        mark(run, shown)
    }));
}

fn mark(run: &Ranked<'_>, mark: Mark) -> Layer {
    let error = short(run.row.error_total.unwrap_or(0.0), 3);
    Layer::Mark(run.at, mark, format!("{}: error {error}", run.row.run))
}

//! The figure and the summary of a table: a panel per case and observable, and the cheapest run for each
//! tolerance.

use std::collections::BTreeMap;

use super::{AMPLIFICATION_MAX, Observable, Pareto, Row, SCENES};
use crate::experiment::{Chart, Provenance, Status};
use crate::front::FLOORS;
use crate::method::{DEFAULT, Family};
use crate::plot::{Axis, Figure, INK, Layer, Mark, PALE, Panel, Shape, Strip, short};

/// The error at which the title counts the cheapest methods.
const TITLE_ERROR: f64 = 0.01;

/// The tolerances for [`Observable::Displacement`], as relative errors.
const FINE: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// The tolerances for all other observables, as relative errors.
const COARSE: [f64; 4] = [0.2, 0.1, 0.05, 0.02];

/// Errors below this multiple of the floor are drawn there.
const LEAST: f64 = 0.01;

impl Chart for Pareto {
    fn figure(&self, rows: &[Row], provenance: &Provenance) -> Figure {
        let by_time = rows.iter().any(|row| row.cpu_median_s.is_some());
        let unit = match by_time {
            true => "CPU time",
            false => "visits of edges",
        };
        let mut footer = vec![provenance.footer()];
        if rows.iter().any(|row| row.status == Status::Interrupted) {
            let note = "INTERRUPTED: runs that were not done stand among those that failed.";
            footer.push(note.to_owned());
        }
        footer.push(
            "A line joins the runs of a method that none of its other settings beats in both; dots are its \
             other runs. Grey line: the front, where no run is a tenth better in one and no worse in the \
             other. Ring: default settings, black for the default method. Hollow, in the shaded band: below \
             ten times the error floor, known no better. Pink strip: runs that failed, at the cost they had \
             reached."
                .to_owned(),
        );
        let is_there = |family: &Family| rows.iter().any(|row| row.family == Some(*family));
        let families = Family::ALL.into_iter().filter(is_there);
        Figure {
            title: title(rows, by_time, unit),
            about: format!(
                "Relative error against {unit}, one panel per scene and observable. Down and to the left is \
                 better."
            ),
            legend: families
                .map(|family| (family.mark(), family.name().to_owned()))
                .collect(),
            columns: 3,
            panel_size: [390.0, 330.0],
            panels: groups(rows)
                .map(|(case, observable, of)| panel(case, observable, &of, by_time))
                .collect(),
            footer,
        }
    }

    fn summary(&self, rows: &[Row]) -> String {
        let mut text = String::from("the cheapest run for each tolerance, by visits of edges\n");
        for case in cases(rows) {
            text += &format!("{} {}\n", case[0].scene, about(&case[0]));
            for (_, observable, of) in groups(case) {
                let line = tolerances(observable, &of);
                text += &format!("  {:<33} {line}\n", observable.name());
            }
            text += &defaults(case);
        }
        text
    }
}

fn cases(rows: &[Row]) -> impl Iterator<Item = &[Row]> {
    rows.chunk_by(|a, b| a.case() == b.case())
}

/// The cases with each observable that they have, and its rows.
pub(super) fn groups(rows: &[Row]) -> impl Iterator<Item = (&[Row], Observable, Vec<&Row>)> {
    cases(rows).flat_map(|case| {
        let mut groups: BTreeMap<Observable, Vec<&Row>> = BTreeMap::new();
        for (row, observable) in case.iter().filter_map(|row| Some((row, row.observable?))) {
            groups.entry(observable).or_default().push(row);
        }
        groups
            .into_iter()
            .map(move |(observable, of)| (case, observable, of))
    })
}

/// The method that is the cheapest at an error of 1 % most often.
fn title(rows: &[Row], by_time: bool, unit: &str) -> String {
    let compared = groups(rows).filter(|(_, observable, _)| !observable.is_energy());
    let winners = compared.filter_map(|(.., of)| cheapest(&of, TITLE_ERROR, by_time)?.family);
    let winners: Vec<Family> = winners.collect();
    let wins = |family: &Family| winners.iter().filter(|one| *one == family).count();
    match Family::ALL.into_iter().rev().max_by_key(wins) {
        Some(best) if wins(&best) > 0 => format!(
            "{} is the cheapest way to an error below 1 % in {} of {} panels, by {unit}",
            best.name(),
            wins(&best),
            winners.len(),
        ),
        _ => "No method reached an error below 1 %".to_owned(),
    }
}

/// A run that is drawn, and where.
type Drawn<'a> = (&'a Row, [f64; 2]);

fn panel(case: &[Row], observable: Observable, rows: &[&Row], by_time: bool) -> Panel {
    let first = &case[0];
    let floor = rows[0].error_floor;
    let mut panel = Panel {
        title: format!("{}: {}", first.scene, observable.name()),
        about: about(first),
        x: Axis::log(match by_time {
            true => "CPU time, s",
            false => "visits of edges",
        }),
        y: Axis::log("relative error"),
        ..Panel::default()
    };
    let shown = rows.iter().filter_map(|&row| {
        let cost = row.cost(by_time).filter(|cost| *cost > 0.0)?;
        // An error of zero is drawn at the floor.
        let error = row.error_total?.max(floor.unwrap_or(0.0) * LEAST);
        Some((row, [cost, error]))
    });
    let shown: Vec<Drawn<'_>> = shown.collect();
    if shown.is_empty() {
        panel.about = match (floor, first.noise_amplification) {
            (Some(_), _) => "no run reached its end".to_owned(),
            (None, Some(grown)) if grown > AMPLIFICATION_MAX => format!(
                "not comparable: noise grows {}-fold, and {AMPLIFICATION_MAX} is the limit",
                short(grown, 2)
            ),
            _ => "no reference".to_owned(),
        };
        (panel.x, panel.y) = (panel.x.from_to(1.0, 10.0), panel.y.from_to(0.1, 1.0));
        return panel;
    }
    panel.layers.extend(floor.map(|floor| Layer::Band {
        y: 0.0..FLOORS * floor,
        colour: PALE,
    }));
    panel.layers.push(front_line(&shown, by_time));
    for family in Family::ALL {
        let own = shown.iter().filter(|(row, _)| row.family == Some(family));
        draw_family(&mut panel.layers, family, &own.copied().collect::<Vec<_>>());
    }
    for &(row, at) in shown.iter().filter(|(row, _)| row.step_fraction.is_none()) {
        let own = row.family.map_or(INK, |family| family.mark().colour);
        let colour = if row.is_default() { INK } else { own };
        panel.layers.push(Layer::Mark {
            at,
            mark: Mark::new(Shape::Ring, colour).sized(7.5),
            hover: hover(row),
        });
        if row.is_default() {
            panel.layers.push(Layer::Label {
                at,
                text: "default".to_owned(),
                colour: INK,
            });
        }
    }
    panel.above = failures(case, by_time);
    panel
}

fn hover(row: &Row) -> String {
    let error = short(row.error_total.unwrap_or(0.0), 3);
    format!("{}: error {error}", row.run)
}

fn about(row: &Row) -> String {
    let scene = SCENES.iter().find(|scene| scene.name == row.scene);
    let mut about = scene.map_or("", |scene| scene.about).to_owned();
    let own = scene.map(|scene| (scene.stiffness_n_per_m, scene.middle_mass_ratio));
    if own != Some((row.stiffness_n_per_m, row.mass_ratio)) {
        let [stiffness, ratio] = [row.stiffness_n_per_m, row.mass_ratio].map(|x| short(x, 3));
        about += &format!("; {stiffness} N/m, mass ratio {ratio}");
    }
    about += &format!(" ({} {}", row.mesh.name(), row.cells);
    if let Some(grown) = row.noise_amplification {
        about += &format!(", noise ×{}", short(grown, 2));
    }
    about + ")"
}

/// The runs that failed, at the cost that they had reached.
fn failures(case: &[Row], by_time: bool) -> Option<Strip> {
    let failed = case.iter().filter(|row| row.family.is_some());
    let failed: Vec<&Row> = failed.filter(|row| row.status != Status::Ok).collect();
    let mut counts: Vec<(&str, usize)> = Vec::new();
    for status in failed.iter().map(|row| row.status.name()) {
        match counts.iter_mut().find(|(name, _)| *name == status) {
            Some((_, count)) => *count += 1,
            None => counts.push((status, 1)),
        }
    }
    let label = counts
        .iter()
        .map(|(status, count)| format!("{count} {status}"));
    let marks = failed.iter().filter_map(|row| {
        let cost = row.cost(by_time).filter(|cost| *cost > 0.0)?;
        let hover = format!("{}: {}", row.run, row.why);
        Some((cost, row.family?.mark(), hover))
    });
    (!failed.is_empty()).then(|| Strip {
        label: label.collect::<Vec<_>>().join(", "),
        marks: marks.collect(),
    })
}

/// The front over all methods, as stairs.
fn front_line(shown: &[Drawn<'_>], by_time: bool) -> Layer {
    let is_on = |row: &Row| match by_time {
        true => row.is_on_front_by_time,
        false => row.is_on_front,
    };
    let on = shown.iter().filter(|(row, _)| is_on(row));
    let mut points: Vec<[f64; 2]> = Vec::new();
    for [cost, error] in ascending(on.map(|(_, at)| *at)) {
        if let Some(&[_, least]) = points.last() {
            if error >= least {
                continue;
            }
            points.push([cost, least]);
        }
        points.push([cost, error]);
    }
    let end = shown.iter().map(|(_, at)| at[0]).fold(0.0, f64::max);
    points.extend(points.last().map(|&[_, least]| [end, least]));
    Layer::Line {
        points,
        colour: [0xcc; 3],
        width: 3.0,
    }
}

/// The runs of a family: those that none of its others beats as marks on a line, the others as dots.
fn draw_family(layers: &mut Vec<Layer>, family: Family, own: &[Drawn<'_>]) {
    let beats = |a: [f64; 2], b: [f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    let is_best = |at: [f64; 2]| !own.iter().any(|(_, other)| beats(*other, at));
    let best = own.iter().filter(|(_, at)| is_best(*at));
    let mark = family.mark();
    layers.push(Layer::Line {
        points: ascending(best.map(|(_, at)| *at)),
        colour: mark.colour,
        width: 1.0,
    });
    layers.extend(own.iter().map(|&(row, at)| Layer::Mark {
        at,
        mark: match is_best(at) {
            true if row.is_at_floor() => mark.hollow(),
            true => mark,
            false => mark.sized(1.6),
        },
        hover: hover(row),
    }));
}

/// Points from the cheapest on.
fn ascending(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = points.collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// The cheapest run of the budget that meets a tolerance; `None` if none does, or if the tolerance is below ten
/// times the floor.
fn cheapest<'a>(rows: &[&'a Row], tolerance: f64, by_time: bool) -> Option<&'a Row> {
    let meets = |row: &&&Row| {
        let is_known = row
            .error_floor
            .is_some_and(|floor| tolerance >= FLOORS * floor);
        let is_met = row.error_converged.is_some_and(|error| error <= tolerance);
        row.step_fraction.is_some() && is_known && is_met
    };
    let costs = rows.iter().filter(meets);
    let costs = costs.filter_map(|row| Some((row.cost(by_time)?, *row)));
    let best = costs.min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, row)| row)
}

/// The cheapest run for each tolerance, tolerances with the same answer together.
fn tolerances(observable: Observable, rows: &[&Row]) -> String {
    let Some(floor) = rows[0].error_floor else {
        return "no reference, or noise grows too much".to_owned();
    };
    let tolerances = match observable {
        Observable::Displacement => &FINE[..],
        _ => &COARSE,
    };
    let default = rows.iter().find(|row| row.is_default());
    let answers = tolerances.iter().map(|&tolerance| {
        let answer = match cheapest(rows, tolerance, false) {
            None if tolerance < FLOORS * floor => "below the error floor".to_owned(),
            None => "no run".to_owned(),
            Some(row) => {
                let meets = |row: &&&Row| row.error_total.is_some_and(|error| error <= tolerance);
                let default = default.filter(meets).and_then(|row| row.cost(false));
                let ratio = match default.zip(row.cost(false)) {
                    Some((a, b)) => format!("the default costs ×{:.1}", a / b),
                    None => format!("{DEFAULT} misses it"),
                };
                format!("{} ({ratio})", row.run)
            }
        };
        (format!("{} %", short(100.0 * tolerance, 2)), answer)
    });
    let answers: Vec<(String, String)> = answers.collect();
    let lines = answers.chunk_by(|a, b| a.1 == b.1).map(|same| {
        let percents: Vec<&str> = same.iter().map(|(percent, _)| percent.as_str()).collect();
        format!("{}: {}", percents.join(", "), same[0].1)
    });
    lines.collect::<Vec<_>>().join(" · ")
}

/// A line for each method at its default settings: its cost as a multiple of that of the default, and its
/// errors.
fn defaults(case: &[Row]) -> String {
    let mut text = String::new();
    let unit = case.iter().find(|row| row.is_default());
    let unit = unit.and_then(|row| row.cost(false));
    let named = |row: &&Row| row.family.is_some() && row.step_fraction.is_none();
    let rows: Vec<&Row> = case.iter().filter(named).collect();
    for of in rows.chunk_by(|a, b| a.method == b.method) {
        let errors = of.iter().filter_map(|row| {
            let percent = short(100.0 * row.error_total?, 2);
            Some(format!("{} {percent} %", row.observable?.name()))
        });
        let errors = match of[0].status {
            Status::Ok => errors.collect::<Vec<_>>().join(", "),
            status => status.name().to_owned(),
        };
        let cost = of[0].cost(false).zip(unit);
        let cost = cost.map_or(f64::NAN, |(cost, unit)| cost / unit);
        let method = &of[0].method;
        text += &format!("  {method:<9} at its defaults: cost {cost:.2}, error {errors}\n");
    }
    text
}

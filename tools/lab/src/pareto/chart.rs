//! The figure and the summary of a table: a panel per case and observable, and the cheapest run for each
//! tolerance.

use std::fmt::Write as _;

use super::{AMPLIFICATION_MAX, COARSE, FINE, Observable, Pareto, Row};
use crate::experiment::{Chart, Provenance, Status};
use crate::front::FLOORS;
use crate::method::{DEFAULT, Family};
use crate::plot::{Axis, Figure, INK, Layer, Mark, PALE, Panel, Shape, Strip, short};

/// The error at which the title counts the cheapest methods.
const TITLE_ERROR: f64 = 0.01;

/// Errors below this multiple of the floor are drawn there.
const LEAST: f64 = 0.01;

impl Chart for Pareto {
    fn figure(&self, rows: &[Row], provenance: &Provenance) -> Figure {
        figure(rows, provenance)
    }

    fn summary(&self, rows: &[Row]) -> String {
        summary(rows)
    }
}

fn figure(rows: &[Row], provenance: &Provenance) -> Figure {
    let by_time = rows.iter().any(|row| row.cpu_median_s.is_some());
    let unit = if by_time {
        "CPU time"
    } else {
        "visits of edges"
    };
    let cases: Vec<&[Row]> = rows.chunk_by(|a, b| a.case() == b.case()).collect();
    let mut panels = Vec::new();
    for case in &cases {
        for observable in Observable::DRAWN {
            if case.iter().any(|row| row.observable == Some(observable)) {
                panels.push(panel(case, observable, by_time));
            }
        }
    }
    let mut footer = vec![provenance.footer()];
    if rows.iter().any(|row| row.status == Status::Interrupted) {
        footer
            .push("INTERRUPTED: runs that were not done stand among those that failed.".to_owned());
    }
    footer.push(
        "A line joins the runs of a method that none of its other settings beats in both; dots are its other \
         runs. Grey line: the front, where no run is a tenth better in one and no worse in the other. Ring: \
         default settings, black for the default method. Hollow, in the shaded band: below ten times the \
         error floor, known no better. Pink strip: runs that failed, at the cost they had reached."
            .to_owned(),
    );
    Figure {
        title: title(&cases, by_time, unit),
        about: format!(
            "Relative error against {unit}, one panel per scene and observable. Down and to the left is better."
        ),
        legend: legend(rows),
        columns: 3,
        panel_size: [390.0, 330.0],
        panels,
        footer,
    }
}

/// The families that have a row, with their marks.
fn legend(rows: &[Row]) -> Vec<(Mark, String)> {
    let is_there = |family: &Family| rows.iter().any(|row| row.family == Some(*family));
    let families = Family::ALL.into_iter().filter(is_there);
    families
        .map(|family| (family.mark(), family.name().to_owned()))
        .collect()
}

/// The method that is the cheapest at an error of 1 % most often.
fn title(cases: &[&[Row]], by_time: bool, unit: &str) -> String {
    let mut winners: Vec<Family> = Vec::new();
    for case in cases {
        for observable in Observable::DRAWN.into_iter().filter(|one| !one.is_energy()) {
            let winner = cheapest(case, observable, TITLE_ERROR, by_time);
            winners.extend(winner.and_then(|row| row.family));
        }
    }
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

fn panel(case: &[Row], observable: Observable, by_time: bool) -> Panel {
    let first = &case[0];
    let of = |row: &&Row| row.observable == Some(observable);
    let rows = || case.iter().filter(of);
    let floor = rows().find_map(|row| row.error_floor);
    let mut panel = Panel {
        title: format!("{}: {}", first.scene, observable.name()),
        about: about(first),
        x: Axis::log(if by_time {
            "CPU time, s"
        } else {
            "visits of edges"
        }),
        y: Axis::log("relative error"),
        ..Panel::default()
    };
    // An error of zero is drawn at the floor.
    let point = |row: &Row| {
        let cost = row.cost(by_time).filter(|cost| *cost > 0.0)?;
        Some([cost, row.error_total?.max(floor.unwrap_or(0.0) * LEAST)])
    };
    let shown: Vec<(&Row, [f64; 2])> = rows().filter_map(|row| Some((row, point(row)?))).collect();
    if shown.is_empty() {
        let grown = first.noise_amplification;
        panel.about = match (floor, grown) {
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
    if let Some(floor) = floor {
        panel.layers.push(Layer::Band {
            y: 0.0..FLOORS * floor,
            colour: PALE,
        });
    }
    panel.layers.push(front_line(&shown, by_time));
    for family in Family::ALL {
        let own: Vec<(&Row, [f64; 2])> = shown
            .iter()
            .copied()
            .filter(|(row, _)| row.family == Some(family))
            .collect();
        draw_family(&mut panel.layers, family, &own);
    }
    for (row, at) in shown.iter().filter(|(row, _)| row.step_fraction.is_none()) {
        let own = row.family.map_or(INK, |family| family.mark().colour);
        let colour = if row.is_default { INK } else { own };
        panel.layers.push(Layer::Mark {
            at: *at,
            mark: Mark::new(Shape::Ring, colour).sized(7.5),
            hover: format!("{}: error {}", row.run, short(at[1], 3)),
        });
        if row.is_default {
            panel.layers.push(Layer::Label {
                at: *at,
                text: "default".to_owned(),
                colour: INK,
            });
        }
    }
    panel.above = failures(case, by_time);
    panel
}

fn about(row: &Row) -> String {
    let scene = super::SCENES.iter().find(|scene| scene.name == row.scene);
    let mut about = scene.map_or(String::new(), |scene| scene.about.to_owned());
    let own = scene.map(|scene| (scene.stiffness_n_per_m, scene.middle_mass_ratio));
    if own != Some((row.stiffness_n_per_m, row.mass_ratio)) {
        about += &format!(
            "; {} N/m, mass ratio {}",
            short(row.stiffness_n_per_m, 3),
            short(row.mass_ratio, 3)
        );
    }
    let noise = row.noise_amplification;
    let noise = noise.map_or(String::new(), |grown| {
        format!(", noise ×{}", short(grown, 2))
    });
    format!("{about} ({} {}{noise})", row.mesh.name(), row.cells)
}

/// The runs that failed, at the cost that they had reached.
fn failures(case: &[Row], by_time: bool) -> Option<Strip> {
    let failed = || {
        case.iter()
            .filter(|row| row.family.is_some() && row.status != Status::Ok)
    };
    let mut counts: Vec<(Status, usize)> = Vec::new();
    for row in failed() {
        match counts.iter_mut().find(|(status, _)| *status == row.status) {
            Some((_, count)) => *count += 1,
            None => counts.push((row.status, 1)),
        }
    }
    let told = counts
        .iter()
        .map(|(status, count)| format!("{count} {}", status.name()));
    let label = told.collect::<Vec<_>>().join(", ");
    let marks = failed().filter_map(|row| {
        let cost = row.cost(by_time).filter(|cost| *cost > 0.0)?;
        Some((
            cost,
            row.family?.mark(),
            format!("{}: {}", row.run, row.why),
        ))
    });
    (!label.is_empty()).then(|| Strip {
        label,
        marks: marks.collect(),
    })
}

/// The front over all methods, as stairs.
fn front_line(shown: &[(&Row, [f64; 2])], by_time: bool) -> Layer {
    let is_on = |row: &Row| {
        if by_time {
            row.is_on_front_by_time
        } else {
            row.is_on_front
        }
    };
    let on = shown.iter().filter(|(row, _)| is_on(row));
    let mut on: Vec<[f64; 2]> = on.map(|(_, at)| *at).collect();
    on.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let end = shown.iter().map(|(_, at)| at[0]).fold(0.0, f64::max);
    let mut points: Vec<[f64; 2]> = Vec::new();
    for [cost, error] in on {
        if let Some(&[_, least]) = points.last() {
            if error >= least {
                continue;
            }
            points.push([cost, least]);
        }
        points.push([cost, error]);
    }
    points.extend(points.last().map(|&[_, least]| [end, least]));
    Layer::Line {
        points,
        colour: [0xcc; 3],
        width: 3.0,
    }
}

/// The runs of a family: those that none of its others beats as marks on a line, the others as dots.
fn draw_family(layers: &mut Vec<Layer>, family: Family, own: &[(&Row, [f64; 2])]) {
    let beats = |a: [f64; 2], b: [f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    let is_beaten = |at: [f64; 2]| own.iter().any(|(_, other)| beats(*other, at));
    type Runs<'a> = Vec<&'a (&'a Row, [f64; 2])>;
    let (others, mut best): (Runs<'_>, Runs<'_>) = own.iter().partition(|(_, at)| is_beaten(*at));
    best.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
    let mark = family.mark();
    let hover = |row: &Row| {
        format!(
            "{}: error {}",
            row.run,
            short(row.error_total.unwrap_or(0.0), 3)
        )
    };
    layers.push(Layer::Line {
        points: best.iter().map(|(_, at)| *at).collect(),
        colour: mark.colour,
        width: 1.0,
    });
    let dots = others.iter().map(|(row, at)| (row, at, mark.sized(1.6)));
    let marks = best.iter().map(|(row, at)| {
        let mark = if row.is_at_floor { mark.hollow() } else { mark };
        (row, at, mark)
    });
    layers.extend(dots.chain(marks).map(|(row, at, mark)| Layer::Mark {
        at: *at,
        mark,
        hover: hover(row),
    }));
}

/// The cheapest run of the budget that meets a tolerance; `None` if none does, or if the tolerance is below ten
/// times the floor.
fn cheapest(case: &[Row], observable: Observable, tolerance: f64, by_time: bool) -> Option<&Row> {
    let meets = |row: &&Row| {
        let is_known = row
            .error_floor
            .is_some_and(|floor| tolerance >= FLOORS * floor);
        let is_met = row.error_converged.is_some_and(|error| error <= tolerance);
        row.observable == Some(observable) && row.step_fraction.is_some() && is_known && is_met
    };
    let costs = case.iter().filter(meets);
    let costs = costs.filter_map(|row| Some((row.cost(by_time)?, row)));
    let best = costs.min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, row)| row)
}

fn summary(rows: &[Row]) -> String {
    let mut text = String::from("the cheapest run for each tolerance, by visits of edges\n");
    for case in rows.chunk_by(|a, b| a.case() == b.case()) {
        let Some(first) = case.first() else { continue };
        let name = format!("{} {}", first.scene, about(first));
        writeln!(text, "{name}").expect("a string grows");
        for observable in Observable::DRAWN {
            if let Some(line) = tolerances(case, observable) {
                writeln!(text, "  {:<33} {line}", observable.name()).expect("a string grows");
            }
        }
        text += &defaults(case);
    }
    text
}

/// The cheapest run for each tolerance, tolerances with the same answer together; `None` if the case does not
/// have the observable.
fn tolerances(case: &[Row], observable: Observable) -> Option<String> {
    let row = case.iter().find(|row| row.observable == Some(observable))?;
    let Some(floor) = row.error_floor else {
        return Some("no reference, or noise grows too much".to_owned());
    };
    let (all, default) = (
        if observable == Observable::Displacement {
            &FINE[..]
        } else {
            &COARSE
        },
        case.iter()
            .find(|row| row.is_default && row.observable == Some(observable)),
    );
    let mut answers: Vec<(Vec<String>, String)> = Vec::new();
    for &tolerance in all {
        let percent = format!("{} %", short(100.0 * tolerance, 2));
        let answer = match cheapest(case, observable, tolerance, false) {
            None if tolerance < FLOORS * floor => "below the error floor".to_owned(),
            None => "no run".to_owned(),
            Some(row) => {
                let meets = |row: &&Row| row.error_total.is_some_and(|error| error <= tolerance);
                let ratio = default.filter(meets).and_then(|row| row.cost(false));
                let ratio = ratio.zip(row.cost(false)).map(|(a, b)| a / b);
                let ratio = ratio.map_or(format!("{DEFAULT} misses it"), |ratio| {
                    format!("the default costs ×{ratio:.1}")
                });
                format!("{} ({ratio})", row.run)
            }
        };
        match answers.last_mut() {
            Some((percents, same)) if *same == answer => percents.push(percent),
            _ => answers.push((vec![percent], answer)),
        }
    }
    let answers = answers.iter();
    let answers = answers.map(|(percents, answer)| format!("{}: {answer}", percents.join(", ")));
    Some(answers.collect::<Vec<_>>().join(" · "))
}

/// A line for each method at its default settings: its cost as a multiple of that of the default, and its
/// errors.
fn defaults(case: &[Row]) -> String {
    let mut text = String::new();
    let unit = case
        .iter()
        .find(|row| row.is_default)
        .and_then(|row| row.cost(false));
    let named = |row: &&Row| row.family.is_some() && row.step_fraction.is_none();
    let rows: Vec<&Row> = case.iter().filter(named).collect();
    for of in rows.chunk_by(|a, b| a.method == b.method) {
        let drawn = of.iter().filter(|row| {
            row.observable
                .is_some_and(|one| Observable::DRAWN.contains(&one))
        });
        let errors: Vec<String> = drawn
            .filter_map(|row| {
                let percent = short(100.0 * row.error_total?, 2);
                Some(format!("{} {percent} %", row.observable?.name()))
            })
            .collect();
        let errors = match of[0].status {
            Status::Ok => errors.join(", "),
            status => status.name().to_owned(),
        };
        let cost = of[0]
            .cost(false)
            .zip(unit)
            .map_or(f64::NAN, |(cost, unit)| cost / unit);
        writeln!(
            text,
            "  {:<9} at its defaults: cost {cost:.2}, error {errors}",
            of[0].method
        )
        .expect("a string grows");
    }
    text
}

//! The chart: a panel for each scene and measure, and below each what is the better buy.

use std::ops::Range;

use plotters::coord::combinators::{LogCoord, WithKeyPoints};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::measure::Measure;
use super::{Better, Error, Floor, Row, SceneStudy, Study};
use crate::draw::{Area, Drawn, axis_number, drawn, of_decades, round_numbers, spread, wrapped};
use crate::pareto::{FLOORS, Family, Look, Status, colour, draw_mark};
use crate::parts;

const COLUMNS: usize = 2;
const PANEL: (i32, i32) = (640, 330);
const LEGEND: i32 = 112;
const HEAD: i32 = 136;

/// The table of buys below a panel: a line for each method, a cell for each mesh and step.
const LINE: i32 = 15;
const CELL: i32 = 30;
const NAME: i32 = 104;

/// Errors below so many times the floor are drawn as being there.
const LEAST: f64 = 0.1;

/// Errors above this are drawn as being there: they are wrong, whatever the number.
const MOST: f64 = 3.0;

/// An axis of logarithms has no zero.
const LEAST_OF_ALL: f64 = 1e-12;

const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// Draws a study as SVG. Returns `None` if the drawing library fails, which does not happen in memory.
#[must_use]
pub fn svg(study: &Study) -> Option<String> {
    let panels: Vec<(&SceneStudy, &Floor)> = study
        .scenes
        .iter()
        .flat_map(|scene| scene.floors.iter().map(move |known| (scene, known)))
        .collect();
    let methods = study.scenes.iter().map(|scene| scene.methods().len());
    let table = 44 + LINE * methods.max().unwrap_or(0) as i32;
    let high = PANEL.1 + table;
    let rows = panels.len().div_ceil(COLUMNS) as i32;
    let foot = wrapped(&footer(study), 200);
    let width = PANEL.0 * COLUMNS as i32 + 20;
    let height = HEAD + rows * high + 16 * foot.len() as i32 + 24;
    drawn((width as u32, height as u32), |root| {
        head(root, study)?;
        for (i, (scene, known)) in panels.iter().enumerate() {
            let (column, row) = ((i % COLUMNS) as i32, (i / COLUMNS) as i32);
            let corner = (10 + column * PANEL.0, HEAD + row * high);
            panel(root, corner, study, scene, known)?;
            let corner = (corner.0, corner.1 + PANEL.1);
            buys(root, corner, study, scene, known.measure)?;
        }
        for (i, line) in foot.iter().enumerate() {
            grey(root, line, (14, HEAD + rows * high + 8 + 16 * i as i32), 12)?;
        }
        Ok(())
    })
}

fn grey(root: &Area<'_>, words: &str, at: (i32, i32), size: i32) -> Drawn {
    let style = ("sans-serif", size).into_font().color(&GREY);
    root.draw(&Text::new(words.to_owned(), at, style))
}

/// The size of the marks of a mesh in pixels: the finer, the larger.
fn size(study: &Study, cells: u32) -> f64 {
    let place = study.cells.iter().position(|other| *other == cells);
    2.2 + 1.9 * place.unwrap_or(0) as f64
}

/// The title, how to read the chart, and the marks with their names.
fn head(root: &Area<'_>, study: &Study) -> Drawn {
    let title = "Space against time: a finer mesh or a shorter step";
    root.draw(&Text::new(title, (14, 12), ("sans-serif", 21)))?;
    let words = format!(
        "Errors against {} cells, by work; down and to the left is better. A line joins the steps of a method \
         on one mesh: along it steps are halved, and to the next larger marks edges are. A ring: on the \
         front of its method. Shaded: below ten times the distance of the two runs on the finest mesh, known \
         no better. What is off by 300 % or more stands at 3. Tables: which halving lowers the error more per factor of cost, from each mesh (above) and \
         step (part of the base step); bold on the front, – neither lowers it by a tenth, × the run failed.",
        study.finest
    );
    for (i, line) in wrapped(&words, 190).iter().enumerate() {
        grey(root, line, (14, 40 + 17 * i as i32), 13)?;
    }
    let mut x = 22;
    for family in families(study) {
        draw_mark(root, family, (x, LEGEND), 5.0, Look::Filled)?;
        let style = ("sans-serif", 14).into_font().color(&BLACK);
        root.draw(&Text::new(family.name(), (x + 10, LEGEND - 7), style))?;
        x += 38 + 8 * family.name().len() as i32;
    }
    x += 20;
    for &cells in &study.cells {
        let size = size(study, cells).round() as i32;
        root.draw(&Circle::new((x, LEGEND), size, GREY.filled()))?;
        let words = format!("{cells} cells");
        root.draw(&Text::new(words, (x + 12, LEGEND - 7), ("sans-serif", 14)))?;
        x += 92;
    }
    for (better, words) in [
        (Better::Mesh, "mesh: halve the edge"),
        (Better::Step, "step: halve the step"),
    ] {
        let at = [(x, LEGEND - 6), (x + 16, LEGEND + 6)];
        root.draw(&Rectangle::new(at, shade(better).filled()))?;
        root.draw(&Text::new(words, (x + 22, LEGEND - 7), ("sans-serif", 14)))?;
        x += 172;
    }
    Ok(())
}

fn families(study: &Study) -> Vec<Family> {
    let rows = || study.scenes.iter().flat_map(|scene| &scene.rows);
    let is_there = |family: &Family| rows().any(|row| row.family == *family);
    Family::ALL.into_iter().filter(is_there).collect()
}

fn footer(study: &Study) -> String {
    let runs = study.scenes.iter().map(|scene| {
        let barred = match scene.is_barred {
            true => ", displacement barred: noise grows too much",
            false => "",
        };
        format!("{}: {}{barred}", scene.scene, scene.about)
    });
    let interrupted = match study.is_interrupted {
        true => " · INTERRUPTED: what was not done stands as failed",
        false => "",
    };
    let missing = parts::told(&study.missing).map_or(String::new(), |told| format!(" · {told}"));
    format!(
        "{} · runs end at {} visits{interrupted}{missing} · {}",
        study.provenance.line(),
        study.visits_max,
        runs.collect::<Vec<_>>().join(" · ")
    )
}

type Axis = WithKeyPoints<LogCoord<f64>>;
type Panel<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

fn panel(
    root: &Area<'_>,
    (left, top): (i32, i32),
    study: &Study,
    scene: &SceneStudy,
    known: &Floor,
) -> Drawn {
    let title = format!("{} · {}", scene.scene, known.measure.name());
    root.draw(&Text::new(title, (left + 50, top + 2), ("sans-serif", 16)))?;
    let value = known.value.map_or(String::new(), |value| {
        format!("{value:.4} {} on the finest mesh", known.measure.unit())
    });
    grey(root, &value, (left + 330, top + 5), 12)?;
    let spots: Vec<(&Row, &Error)> = scene
        .rows
        .iter()
        .filter_map(|row| Some((row, row.error(known.measure)?)))
        .filter(|(row, _)| row.visits > 0)
        .collect();
    let Some(floor) = known.floor.filter(|_| !spots.is_empty()) else {
        let words = "nothing to compare: a run on the finest mesh, or every other, has no answer";
        return grey(root, words, (left + 54, top + 120), 12);
    };
    // What is nothing is drawn near the floor.
    let height = |error: &Error| error.total.clamp((floor * LEAST).max(LEAST_OF_ALL), MOST);
    let x = spread(spots.iter().map(|(row, _)| row.visits as f64), 1.4);
    let y = spread(spots.iter().map(|(_, error)| height(error)), 1.5);
    let area = root
        .clone()
        .shrink((left, top + 24), (PANEL.0 - 14, PANEL.1 - 30));
    let mut chart = ChartBuilder::on(&area)
        .x_label_area_size(36)
        .y_label_area_size(56)
        .build_cartesian_2d(
            x.clone().log_scale().with_key_points(ticks(&x)),
            y.clone().log_scale().with_key_points(ticks(&y)),
        )?;
    let shaded = (FLOORS * floor).min(y.end);
    if shaded > y.start {
        let shade = RGBColor(0xec, 0xec, 0xe6).filled();
        chart.draw_series([Rectangle::new([(x.start, y.start), (x.end, shaded)], shade)])?;
    }
    chart
        .configure_mesh()
        .x_desc("visits of edges")
        .y_desc("error against the finest mesh")
        .x_label_formatter(&|x| axis_number(*x, 0.001))
        .y_label_formatter(&|y| axis_number(*y, 0.001))
        .label_style(("sans-serif", 12))
        .axis_desc_style(("sans-serif", 12))
        .bold_line_style(RGBColor(0xe4, 0xe4, 0xe4))
        .light_line_style(TRANSPARENT)
        .draw()?;
    for method in scene.methods() {
        for &cells in &study.cells {
            let own = spots.iter().copied();
            let own = own.filter(|(row, _)| row.method == method && row.cells == cells);
            let own: Vec<(&Row, &Error)> = own.collect();
            series(root, &mut chart, &own, size(study, cells), &height)?;
        }
    }
    Ok(())
}

/// The steps of a method on a mesh.
fn series(
    root: &Area<'_>,
    chart: &mut Panel<'_, '_>,
    own: &[(&Row, &Error)],
    size: f64,
    height: &dyn Fn(&Error) -> f64,
) -> Drawn {
    let Some(family) = own.first().map(|(row, _)| row.family) else {
        return Ok(());
    };
    let points = own.iter();
    let points = points.map(|(row, error)| (row.visits as f64, height(error)));
    chart.draw_series(LineSeries::new(points, colour(family).stroke_width(1)))?;
    for (row, error) in own {
        let at = chart.backend_coord(&(row.visits as f64, height(error)));
        draw_mark(root, family, at, size, Look::Filled)?;
        if error.is_on_front {
            let rim = (1.3 * size).round() as i32 + 1;
            root.draw(&Circle::new(at, rim, BLACK.stroke_width(1)))?;
        }
    }
    Ok(())
}

fn shade(better: Better) -> RGBColor {
    match better {
        Better::Mesh => RGBColor(0xa6, 0xd8, 0xf0),
        Better::Step => RGBColor(0xf5, 0xcf, 0x6b),
        Better::Neither => RGBColor(0xf0, 0xf0, 0xf0),
    }
}

/// The table of buys.
fn buys(
    root: &Area<'_>,
    (left, top): (i32, i32),
    study: &Study,
    scene: &SceneStudy,
    measure: Measure,
) -> Drawn {
    let parts = study.parts.len() as i32;
    let block = CELL * parts + 10;
    let at = |mesh: usize, part: usize| left + NAME + 12 + block * mesh as i32 + CELL * part as i32;
    let middle = |size: i32| {
        let font = ("sans-serif", size).into_font();
        font.color(&GREY).pos(Pos::new(HPos::Center, VPos::Top))
    };
    for (i, cells) in study.cells.iter().enumerate() {
        let x = at(i, 0) + CELL * parts / 2;
        root.draw(&Text::new(format!("{cells} cells"), (x, top), middle(12)))?;
        for (j, part) in study.parts.iter().enumerate() {
            let x = at(i, j) + CELL / 2;
            root.draw(&Text::new(format!("{part}"), (x, top + 13), middle(11)))?;
        }
    }
    for (line, method) in scene.methods().into_iter().enumerate() {
        let y = top + 27 + LINE * line as i32;
        root.draw(&Text::new(
            method.to_owned(),
            (left + 14, y),
            ("sans-serif", 12),
        ))?;
        for row in scene.rows.iter().filter(|row| row.method == method) {
            let mesh = study.cells.iter().position(|cells| *cells == row.cells);
            let part = study.parts.iter().position(|part| *part == row.part);
            if let (Some(mesh), Some(part)) = (mesh, part) {
                cell(root, (at(mesh, part), y), row, measure)?;
            }
        }
    }
    Ok(())
}

fn cell(root: &Area<'_>, (x, y): (i32, i32), row: &Row, measure: Measure) -> Drawn {
    let error = row.error(measure);
    let buy = error.and_then(|error| error.buy);
    let words = match buy.map(|buy| buy.better) {
        _ if row.status != Status::Ok => "×",
        Some(Better::Neither) => "–",
        Some(better) => better.name(),
        None => return Ok(()),
    };
    if let Some(buy) = buy {
        let corners = [(x, y - 1), (x + CELL - 2, y + LINE - 3)];
        root.draw(&Rectangle::new(corners, shade(buy.better).filled()))?;
    }
    let is_bold = error.is_some_and(|error| error.is_on_front);
    let font = ("sans-serif", 11).into_font();
    let font = font.style(if is_bold {
        FontStyle::Bold
    } else {
        FontStyle::Normal
    });
    let style = font.color(if is_bold { &BLACK } else { &GREY });
    let style = style.pos(Pos::new(HPos::Center, VPos::Top));
    root.draw(&Text::new(words, (x + CELL / 2 - 1, y), style))
}

/// Numbers to write along an axis.
fn ticks(range: &Range<f64>) -> Vec<f64> {
    let tens = of_decades(range, &[1.0]);
    match tens.len() {
        0..=2 => round_numbers(range),
        _ => tens,
    }
}

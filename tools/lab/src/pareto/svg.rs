//! The chart: a panel for each scene and observable, work to the right and error upward, both logarithmic.

use std::ops::Range;

use plotters::coord::combinators::{LogCoord, WithKeyPoints};
use plotters::prelude::*;

use super::assess::{CaseStudy, FLOORS, Row};
use super::mark::{self, Look, colour};
use super::method::Family;
use super::observable::{Observable, TOLD};
use super::run::Status;
use super::{AMPLIFICATION_MAX, Study};
use crate::draw::{Area, Drawn, axis_number, drawn, of_decades, round_numbers, spread, wrapped};
use crate::parts;

/// The units of cost in a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// The cost in visits of edges, which is the same on every machine.
    Visits,
    /// The cost in CPU time. Rows without a time are not drawn.
    Time,
}

const COLUMNS: usize = 4;
const PANEL: (i32, i32) = (330, 270);
const HEAD: i32 = 112;

/// Errors below so many times the floor are drawn as being there.
const LEAST: f64 = 0.01;

const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// Draws a study as SVG. Returns `None` if the drawing library fails, which does not happen in memory.
#[must_use]
pub fn svg(study: &Study, by: By) -> Option<String> {
    let panels: Vec<(&CaseStudy, Observable)> = study
        .cases
        .iter()
        .flat_map(|case| {
            let asked = |o: &Observable| case.floors.iter().any(|known| known.observable == *o);
            // One that is barred has a panel that says so.
            let is_shown = move |o: &Observable| {
                asked(o) || (case.is_barred && *o == Observable::Displacement)
            };
            TOLD.into_iter().filter(is_shown).map(move |o| (case, o))
        })
        .collect();
    let rows = panels.len().div_ceil(COLUMNS) as i32;
    let foot = footer(study, by);
    let width = PANEL.0 * COLUMNS as i32 + 20;
    let height = HEAD + rows * PANEL.1 + 16 * foot.len() as i32 + 24;
    drawn((width as u32, height as u32), |root| {
        head(root, by)?;
        for (i, (case, observable)) in panels.iter().enumerate() {
            let (column, row) = ((i % COLUMNS) as i32, (i / COLUMNS) as i32);
            let corner = (10 + column * PANEL.0, HEAD + row * PANEL.1);
            panel(root, corner, case, *observable, by)?;
        }
        for (i, line) in foot.iter().enumerate() {
            let at = (14, HEAD + rows * PANEL.1 + 8 + 16 * i as i32);
            let style = ("sans-serif", 12).into_font().color(&GREY);
            root.draw(&Text::new(line.clone(), at, style))?;
        }
        Ok(())
    })
}

/// The title, and the marks with their names.
fn head(root: &Area<'_>, by: By) -> Drawn {
    let title = match by {
        By::Visits => "Work against precision, by visits of edges",
        By::Time => "Work against precision, by CPU time",
    };
    root.draw(&Text::new(title, (14, 12), ("sans-serif", 21)))?;
    let words = "Down and to the left is better. A line joins the best of a method whatever its settings; dots \
                 are its other runs. The grey line is the front: nothing is a tenth better in one and no worse in the other. Ring: what \
                 a method does by default; black: the default. Hollow, in the shade: below ten times the \
                 floor, known no better. Above: runs that failed, where they ended.";
    for (i, line) in wrapped(words, 200).iter().enumerate() {
        let style = ("sans-serif", 13).into_font().color(&GREY);
        root.draw(&Text::new(line.clone(), (14, 40 + 17 * i as i32), style))?;
    }
    let mut x = 22;
    for family in Family::ALL {
        mark::draw(root, family, (x, 92), 5.0, Look::Filled)?;
        let style = ("sans-serif", 14).into_font().color(&BLACK);
        root.draw(&Text::new(family.name(), (x + 12, 85), style))?;
        x += 40 + 8 * family.name().len() as i32;
    }
    root.draw(&Circle::new((x, 92), 7, BLACK.stroke_width(2)))?;
    root.draw(&Text::new("the default", (x + 12, 85), ("sans-serif", 14)))
}

/// What is below the panels.
fn footer(study: &Study, by: By) -> Vec<String> {
    let from = &study.provenance;
    let mut lines = vec![format!(
        "{} · seed {} · runs end at {} visits{}",
        from.line(),
        study.seed,
        study.visits_max,
        if study.is_interrupted {
            " · INTERRUPTED: what was not done stands as failed"
        } else {
            ""
        },
    )];
    if by == By::Time {
        let times = match study.repeats {
            0 => "CPU time of the one run, beside others".to_owned(),
            n => format!("median CPU time of {n} runs after one to warm up, one after the other"),
        };
        lines.push(format!("{times} · {}", from.processor()));
    }
    lines.extend(parts::told(&study.missing));
    let sizes = study.cases.iter().map(|case| {
        let noise = match case.amplification {
            Some(a) => format!(", noise ×{a:.0}"),
            None => String::new(),
        };
        format!(
            "{}: {} particles, {} edges{noise}",
            case.name, case.particles, case.edges
        )
    });
    let sizes = sizes.collect::<Vec<_>>().join(" · ");
    lines
        .iter()
        .chain([&sizes])
        .flat_map(|line| wrapped(line, 220))
        .collect()
}

/// A row that stands in a panel: where, and how.
struct Spot<'a> {
    row: &'a Row,
    family: Family,
    cost: f64,
    error: f64,
    is_at_floor: bool,
    is_on_front: bool,
}

fn panel(
    root: &Area<'_>,
    (left, top): (i32, i32),
    case: &CaseStudy,
    observable: Observable,
    by: By,
) -> Drawn {
    let title = format!("{} · {}", case.name, observable.name());
    root.draw(&Text::new(title, (left + 46, top + 2), ("sans-serif", 15)))?;
    let about = ("sans-serif", 10).into_font().color(&GREY);
    root.draw(&Text::new(case.about.clone(), (left + 46, top + 20), about))?;
    let floors = case.floors.iter();
    let known = floors.filter(|known| known.observable == observable);
    let floor = known.filter_map(|known| known.floor).next();
    let mut spots: Vec<Spot<'_>> = Vec::new();
    for row in &case.rows {
        let cost = row.cost_by(by == By::Time).filter(|cost| *cost > 0.0);
        let error = row.error(observable);
        if let (Some(cost), Some(error)) = (cost, error) {
            spots.push(Spot {
                row,
                family: row.family,
                cost,
                // What is nothing is drawn at the floor.
                error: error.total.max(floor.unwrap_or(0.0) * LEAST),
                is_at_floor: error.is_at_floor,
                is_on_front: match by {
                    By::Visits => error.is_on_front,
                    By::Time => error.is_on_front_by_time,
                },
            });
        }
    }
    if spots.is_empty() {
        let why = match floor {
            None if case.is_barred && observable == Observable::Displacement => {
                let grown = case
                    .amplification
                    .map_or("without measure".to_owned(), |a| format!("{a:.0}-fold"));
                format!("barred: noise grows {grown}, above {AMPLIFICATION_MAX}")
            }
            None => "no reference: nothing to compare with".to_owned(),
            Some(_) => "no run came to its end".to_owned(),
        };
        let style = ("sans-serif", 12).into_font().color(&GREY);
        return root.draw(&Text::new(why, (left + 50, top + 120), style));
    }
    let failed: Vec<&Row> = case
        .rows
        .iter()
        .filter(|row| row.status != Status::Ok)
        .collect();
    let failed_costs = failed.iter().filter_map(|row| row.cost_by(by == By::Time));
    let costs = spots
        .iter()
        .map(|spot| spot.cost)
        .chain(failed_costs.filter(|cost| *cost > 0.0));
    let x = spread(costs, 1.3);
    // What failed early does not decide how wide the chart is.
    let least = spots
        .iter()
        .map(|spot| spot.cost)
        .fold(f64::INFINITY, f64::min);
    let x = x.start.max(least / 4.0)..x.end;
    let y = spread(spots.iter().map(|spot| spot.error), 1.4);
    // The band of failures takes the upper eighth.
    let band = y.end;
    let y = y.start..band * (band / y.start).powf(0.14);
    let area = root
        .clone()
        .margin(0, 0, 0, 0)
        .shrink((left, top + 32), (PANEL.0 - 12, PANEL.1 - 34));
    let mut chart = ChartBuilder::on(&area)
        .x_label_area_size(34)
        .y_label_area_size(46)
        .build_cartesian_2d(
            x.clone().log_scale().with_key_points(ticks(&x)),
            y.clone()
                .log_scale()
                .with_key_points(ticks(&(y.start..band))),
        )?;
    let (low, high) = (y.start, y.end);
    if let Some(floor) = floor
        .map(|floor| (FLOORS * floor).min(band))
        .filter(|f| *f > low)
    {
        let shade = RGBColor(0xec, 0xec, 0xe6).filled();
        chart.draw_series([Rectangle::new([(x.start, low), (x.end, floor)], shade)])?;
    }
    let shade = RGBColor(0xfb, 0xee, 0xea).filled();
    chart.draw_series([Rectangle::new([(x.start, band), (x.end, high)], shade)])?;
    chart
        .configure_mesh()
        .x_desc(match by {
            By::Visits => "visits of edges",
            By::Time => "CPU time, s",
        })
        .x_label_formatter(&|x| axis_number(*x, 0.01))
        .y_label_formatter(&|y| axis_number(*y, 0.01))
        .label_style(("sans-serif", 11))
        .axis_desc_style(("sans-serif", 11))
        .bold_line_style(RGBColor(0xe4, 0xe4, 0xe4))
        .light_line_style(TRANSPARENT)
        .draw()?;
    front_line(&mut chart, &spots, x.end)?;
    for family in Family::ALL {
        family_marks(root, &mut chart, &spots, family)?;
    }
    for spot in spots.iter().filter(|spot| spot.row.part.is_none()) {
        let at = chart.backend_coord(&(spot.cost, spot.error));
        if spot.row.is_default {
            root.draw(&Circle::new(at, 7, BLACK.stroke_width(2)))?;
            root.draw(&Text::new(
                "default",
                (at.0 + 9, at.1 - 12),
                ("sans-serif", 11),
            ))?;
        } else {
            root.draw(&Circle::new(at, 6, colour(spot.family).stroke_width(1)))?;
        }
    }
    let middle = (band * high).sqrt();
    let mut ends: Vec<(i32, Family)> = failed
        .iter()
        .map(|row| {
            let cost = row
                .cost_by(by == By::Time)
                .unwrap_or(0.0)
                .clamp(x.start, x.end);
            (chart.backend_coord(&(cost, middle)).0, row.family)
        })
        .collect();
    ends.sort_by_key(|(at, _)| *at);
    let y = chart.backend_coord(&(x.start, middle)).1 + 5;
    let right = chart.backend_coord(&(x.end, middle)).0;
    let places: Vec<i32> = ends.iter().map(|(at, _)| *at).collect();
    for (at, (_, family)) in beside(&places, right).into_iter().zip(ends) {
        mark::draw(root, family, (at, y), 3.0, Look::Filled)?;
    }
    if !failed.is_empty() {
        let at = chart.backend_coord(&(x.start, high));
        let style = ("sans-serif", 10)
            .into_font()
            .color(&RGBColor(0xa0, 0x40, 0x30));
        root.draw(&Text::new(told(&failed), (at.0 + 3, at.1 + 1), style))?;
    }
    Ok(())
}

/// How far apart two marks of the same kind are at least, in pixels.
const APART: i32 = 5;

/// Ascending places, moved apart where many are at one, and none beyond the right end: from there they are
/// moved to the left.
fn beside(places: &[i32], right: i32) -> Vec<i32> {
    let mut next = i32::MIN;
    let mut moved: Vec<i32> = places
        .iter()
        .map(|&at| {
            let at = at.max(next);
            next = at + APART;
            at
        })
        .collect();
    let mut limit = right;
    for at in moved.iter_mut().rev() {
        *at = (*at).min(limit);
        limit = *at - APART;
    }
    moved
}

type Axis = WithKeyPoints<LogCoord<f64>>;
type Panel<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

/// The front over all methods, as a staircase behind the marks.
fn front_line(chart: &mut Panel<'_, '_>, spots: &[Spot<'_>], end: f64) -> Drawn {
    let mut on: Vec<(f64, f64)> = spots
        .iter()
        .filter(|spot| spot.is_on_front)
        .map(|spot| (spot.cost, spot.error))
        .collect();
    on.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut stairs: Vec<(f64, f64)> = Vec::new();
    for (cost, error) in on {
        if let Some(&(_, least)) = stairs.last() {
            if error >= least {
                continue;
            }
            stairs.push((cost, least));
        }
        stairs.push((cost, error));
    }
    if let Some(&(_, least)) = stairs.last() {
        stairs.push((end, least));
    }
    let pale = RGBColor(0xcc, 0xcc, 0xcc).stroke_width(3);
    chart.draw_series(LineSeries::new(stairs, pale))?;
    Ok(())
}

/// The runs of a method: those that none of its others beats as marks on a line, the others as dots.
fn family_marks(
    root: &Area<'_>,
    chart: &mut Panel<'_, '_>,
    spots: &[Spot<'_>],
    family: Family,
) -> Drawn {
    let own: Vec<&Spot<'_>> = spots.iter().filter(|spot| spot.family == family).collect();
    let beaten = |spot: &Spot<'_>| {
        let beats = |other: &&&Spot<'_>| {
            other.cost <= spot.cost
                && other.error <= spot.error
                && (other.cost, other.error) != (spot.cost, spot.error)
        };
        own.iter().any(|other| beats(&other))
    };
    let (mut best, others): (Vec<&Spot<'_>>, Vec<&Spot<'_>>) =
        own.iter().copied().partition(|spot| !beaten(spot));
    best.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let colour = colour(family);
    for spot in others {
        let at = chart.backend_coord(&(spot.cost, spot.error));
        root.draw(&Circle::new(at, 1, colour.mix(0.7).filled()))?;
    }
    let line = best.iter().map(|spot| (spot.cost, spot.error));
    chart.draw_series(LineSeries::new(line, colour.stroke_width(1)))?;
    for spot in best {
        let at = chart.backend_coord(&(spot.cost, spot.error));
        let look = if spot.is_at_floor {
            Look::Hollow
        } else {
            Look::Filled
        };
        mark::draw(root, family, at, 4.0, look)?;
    }
    Ok(())
}

/// How many failed, and how.
fn told(failed: &[&Row]) -> String {
    let all = [
        Status::Refused,
        Status::BlownUp,
        Status::Unsolved,
        Status::Restless,
        Status::TooDear,
        Status::Interrupted,
    ];
    let counts = all.into_iter().filter_map(|status| {
        let count = failed.iter().filter(|row| row.status == status).count();
        (count > 0).then(|| format!("{count} {}", status.name()))
    });
    counts.collect::<Vec<_>>().join(", ")
}

/// Numbers to write along an axis.
fn ticks(range: &Range<f64>) -> Vec<f64> {
    let tens = of_decades(range, &[1.0]);
    match tens.len() {
        0..=1 => round_numbers(range),
        2..=7 => tens,
        _ => tens.into_iter().step_by(2).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_stand_apart_and_none_beyond_the_end() {
        assert_eq!(beside(&[0, 2, 50], 100), [0, 5, 50]);
        assert_eq!(beside(&[90, 98, 99, 100], 100), [85, 90, 95, 100]);
        assert_eq!(beside(&[], 100), [0; 0]);
    }
}

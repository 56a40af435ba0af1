//! The chart of a study: force against displacement, and forces against the size of the mesh.

use plotters::prelude::*;

use super::{Chart, Study, Test, cascade};
use crate::draw::{Area, Drawn, drawn, round_numbers, wrapped};
use crate::parts;

/// Of the trouser tests.
const SIZE: (u32, u32) = (1100, 500);

/// Above the first title.
const MARGIN: u32 = 14;

/// A line of what stands below all.
const LINE: u32 = 16;
const COLOURS: [RGBColor; 5] = [
    RGBColor(0xd9, 0x5f, 0x02),
    RGBColor(0x1b, 0x9e, 0x77),
    RGBColor(0x4c, 0x4f, 0xa8),
    RGBColor(0xc2, 0x1e, 0x7a),
    RGBColor(0x55, 0x55, 0x55),
];

/// Draws a chart as SVG. Returns `None` if the drawing library fails, which does not happen in memory.
#[must_use]
pub fn svg(chart: &Chart) -> Option<String> {
    let has_strips = !chart.study.tests.is_empty();
    let above = if has_strips { SIZE.1 } else { MARGIN };
    let below = cascade::height(&chart.cascades);
    let lines = [Some(chart.provenance.line()), parts::told(&chart.missing)];
    let footer = lines.iter().flatten().flat_map(|line| wrapped(line, 170));
    let footer: Vec<String> = footer.collect();
    let foot = above + below;
    let height = foot + LINE * footer.len() as u32 + 12;
    drawn((SIZE.0, height), |root| {
        if has_strips {
            let (tests, _) = root.split_vertically(above);
            draw(&chart.study, &tests)?;
        }
        cascade::draw(root, &chart.cascades, above as i32)?;
        for (i, line) in footer.iter().enumerate() {
            let at = (20, (foot + LINE * i as u32) as i32 + 4);
            let style = ("sans-serif", 12).into_font().color(&BLACK.mix(0.6));
            root.draw(&Text::new(line.clone(), at, style))?;
        }
        Ok(())
    })
}

fn draw(study: &Study, root: &Area<'_>) -> Drawn {
    let title = "Trouser test: force to tear, by two thresholds";
    root.draw(&Text::new(title, (20, 14), ("sans-serif", 20)))?;
    let (top, words) = root.margin(44, 4, 8, 8).split_vertically(380);
    let panels = top.split_evenly((1, 3));
    let rules = [("stretch", "stretch ratio"), ("toughness", "toughness")];
    let largest = study.tests.iter().map(|test| test.force_largest_n);
    let highest = 1.4 * largest.fold(f64::MIN_POSITIVE, f64::max);
    for (panel, (rule, name)) in panels.iter().zip(rules) {
        curves(study, panel, rule, name, highest)?;
    }
    sizes(study, &panels[2])?;
    for (i, line) in wrapped(&study.conclusion, 150).iter().enumerate() {
        let at = (12, 8 + 20 * i as i32);
        words.draw(&Text::new(line.clone(), at, ("sans-serif", 15)))?;
    }
    Ok(())
}

/// Force against displacement, a curve for each mesh.
fn curves(study: &Study, panel: &Area<'_>, rule: &str, name: &str, highest: f64) -> Drawn {
    let tests = || study.tests.iter().filter(|test| test.rule == rule);
    let ends = tests().filter_map(|test| test.curve.last());
    let farthest = ends.map(|[x, _]| *x).fold(f64::MIN_POSITIVE, f64::max);
    let mut chart = ChartBuilder::on(panel)
        .caption(
            format!("by {name}; first tear: × Verlet, ○ XPBD, at Δt and Δt/2"),
            ("sans-serif", 14),
        )
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..farthest, 0.0..highest)?;
    chart
        .configure_mesh()
        .x_desc("distance of the clamps, m")
        .y_desc("force, N")
        .x_labels(5)
        .y_labels(6)
        .light_line_style(TRANSPARENT)
        .draw()?;
    for (test, colour) in tests().zip(COLOURS.iter().cycle()) {
        let of = |method| {
            let tears = test.first.iter().filter(move |tear| tear.method == method);
            tears.map(|tear| (tear.displacement_m, tear.force_n))
        };
        chart.draw_series(of("verlet").map(|at| Cross::new(at, 4, colour.stroke_width(2))))?;
        chart.draw_series(of("xpbd").map(|at| Circle::new(at, 5, colour)))?;
        let points = test.curve.iter().map(|[x, force]| (*x, force.max(0.0)));
        chart
            .draw_series(LineSeries::new(points, colour.stroke_width(1)))?
            .label(format!("edges of {:.2} mm", 1e3 * test.edge_m))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], *colour));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()
}

/// Largest and mean force against the length of edges, both logarithmic.
fn sizes(study: &Study, panel: &Area<'_>) -> Drawn {
    let edges = || study.tests.iter().map(|test| 1e3 * test.edge_m);
    let forces = || {
        let both = |test: &Test| [test.force_largest_n, test.force_mean_n];
        let all = study.tests.iter().flat_map(both);
        all.filter(|force| *force > 0.0)
    };
    let mut lengths: Vec<f64> = edges().collect();
    lengths.sort_unstable_by(f64::total_cmp);
    lengths.dedup();
    let x = 0.8 * edges().fold(f64::INFINITY, f64::min)..1.25 * edges().fold(0.0, f64::max);
    let y = 0.7 * forces().fold(f64::INFINITY, f64::min)..3.5 * forces().fold(0.0, f64::max);
    let mut chart = ChartBuilder::on(panel)
        .caption("against the size of the mesh", ("sans-serif", 16))
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(48)
        .build_cartesian_2d(
            x.log_scale().with_key_points(lengths),
            y.clone().log_scale().with_key_points(round_numbers(&y)),
        )?;
    chart
        .configure_mesh()
        .x_desc("length of edges, mm")
        .x_label_formatter(&|edge| format!("{edge:.2}"))
        .y_desc("force, N")
        .light_line_style(TRANSPARENT)
        .draw()?;
    for (i, rule) in ["stretch", "toughness"].into_iter().enumerate() {
        let colour = COLOURS[2 * i];
        let tests = || study.tests.iter().filter(move |test| test.rule == rule);
        let largest = || tests().map(|test| (1e3 * test.edge_m, test.force_largest_n));
        let mean = || {
            let all = tests().map(|test| (1e3 * test.edge_m, test.force_mean_n));
            all.filter(|(_, force)| *force > 0.0)
        };
        let (thick, faint) = (colour.stroke_width(2), colour.mix(0.5));
        chart
            .draw_series(LineSeries::new(largest(), thick))?
            .label(format!(
                "{rule}: largest, slope {:+.2}",
                study.slopes_largest[i]
            ))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], thick));
        chart.draw_series(largest().map(|at| Circle::new(at, 4, colour.filled())))?;
        chart
            .draw_series(LineSeries::new(mean(), faint))?
            .label(format!("{rule}: mean, slope {:+.2}", study.slopes_mean[i]))
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], faint));
        chart.draw_series(mean().map(|at| Circle::new(at, 3, colour)))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()
}

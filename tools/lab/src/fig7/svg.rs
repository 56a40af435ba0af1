//! The chart of a study: the time of all splits against the size of the mesh, and what the worst frame
//! gives to them.

use std::ops::Range;

use plotters::prelude::*;

use super::{Study, Test, Timed};
use crate::draw::{Area, Drawn, drawn, round_numbers, wrapped};
use crate::parts;

const SIZE: (u32, u32) = (1100, 570);

/// Those of Okabe and Ito, which also who sees few colours tells apart.
const COLOURS: [RGBColor; 3] = [
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0xc9, 0x8a, 0x00),
    RGBColor(0x00, 0x72, 0xb2),
];

/// A number of a way.
type Of = fn(&Timed) -> f64;

/// Draws a study as SVG. Returns `None` if the drawing library fails, which does not happen in memory.
#[must_use]
pub fn svg(study: &Study) -> Option<String> {
    drawn(SIZE, |root| draw(study, root))
}

fn draw(study: &Study, root: &Area<'_>) -> Drawn {
    let title =
        "A hanging patch is ripped: what splitting its vertices takes (figure 7 of the paper)";
    root.draw(&Text::new(title, (20, 14), ("sans-serif", 20)))?;
    let (top, words) = root.margin(44, 4, 8, 8).split_vertically(430);
    let panels = top.split_evenly((1, 2));
    let sums = Panel {
        caption: format!(
            "all splits of the scene: mean of {} rounds, bars from least to most",
            study.rounds
        ),
        axis: "CPU time, ms",
        of: |timed| 1e3 * timed.mean_s,
        range: Some(|timed| timed.range_s.map(|seconds| 1e3 * seconds)),
    };
    let frames = Panel {
        caption: "the frame with most of it: median, as a part of 1/60 s".to_owned(),
        axis: "% of a frame",
        of: |timed| 100.0 * timed.part_of_frame(),
        range: None,
    };
    for (panel, area) in [sums, frames].iter().zip(&panels) {
        panel.draw(study, area)?;
    }
    let from = &study.provenance;
    let foot = [
        Some(study.conclusion.clone()),
        Some(format!("{} · {}", from.line(), from.processor())),
        parts::told(&study.missing),
    ];
    let lines = foot.iter().flatten().flat_map(|text| wrapped(text, 165));
    for (i, line) in lines.enumerate() {
        let at = (12, 6 + 18 * i as i32);
        words.draw(&Text::new(line, at, ("sans-serif", 14)))?;
    }
    Ok(())
}

/// One number of all ways against the faces of the mesh, both logarithmic.
struct Panel {
    caption: String,
    axis: &'static str,
    of: Of,
    range: Option<fn(&Timed) -> [f64; 2]>,
}

impl Panel {
    fn draw(&self, study: &Study, area: &Area<'_>) -> Drawn {
        let faces: Vec<f64> = study.tests.iter().map(|test| test.faces as f64).collect();
        let x = 0.6 * faces.iter().copied().fold(f64::INFINITY, f64::min)
            ..1.7 * faces.iter().copied().fold(1.0, f64::max);
        let y = self.heights(study);
        let mut chart = ChartBuilder::on(area)
            .caption(&self.caption, ("sans-serif", 14))
            .margin(8)
            .x_label_area_size(36)
            .y_label_area_size(60)
            .build_cartesian_2d(
                x.log_scale().with_key_points(faces),
                y.clone().log_scale().with_key_points(round_numbers(&y)),
            )?;
        chart
            .configure_mesh()
            .x_desc("faces")
            .x_label_formatter(&|faces| format!("{faces:.0}"))
            .y_desc(self.axis)
            .light_line_style(TRANSPARENT)
            .draw()?;
        let ways = study.tests.first().map_or(0, |test| test.ways.len());
        for way in 0..ways {
            let colour = COLOURS[way % COLOURS.len()];
            let timed = || study.tests.iter().map(move |test| (test, &test.ways[way]));
            let at = |(test, timed): (&Test, &Timed)| (test.faces as f64, (self.of)(timed));
            let seen = |(_, height): &(f64, f64)| *height > 0.0;
            let points: Vec<(f64, f64)> = timed().map(at).filter(seen).collect();
            let name = timed().next().map_or("", |(_, timed)| timed.way);
            chart
                .draw_series(LineSeries::new(
                    points.iter().copied(),
                    colour.stroke_width(2),
                ))?
                .label(name)
                .legend(move |(x, y)| {
                    PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2))
                });
            match way {
                0 => chart.draw_series(
                    points
                        .iter()
                        .map(|&at| Cross::new(at, 5, colour.stroke_width(2))),
                )?,
                1 => chart.draw_series(
                    points
                        .iter()
                        .map(|&at| TriangleMarker::new(at, 6, colour.filled())),
                )?,
                _ => chart
                    .draw_series(points.iter().map(|&at| Circle::new(at, 4, colour.filled())))?,
            };
            let Some(range) = self.range else {
                continue;
            };
            let bars = timed().map(|(test, timed)| {
                let faces = test.faces as f64;
                let ends = range(timed).map(|end| (faces, end.max(y.start)));
                PathElement::new(ends.to_vec(), colour.stroke_width(1))
            });
            chart.draw_series(bars)?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.3))
            .draw()
    }

    /// The heights that are drawn.
    fn heights(&self, study: &Study) -> Range<f64> {
        let timed = study.tests.iter().flat_map(|test| &test.ways);
        let ends = timed.flat_map(|timed| {
            let range = self
                .range
                .map_or([(self.of)(timed); 2], |range| range(timed));
            [(self.of)(timed), range[0], range[1]]
        });
        let seen: Vec<f64> = ends.filter(|height| *height > 0.0).collect();
        let least = seen.iter().copied().fold(f64::INFINITY, f64::min);
        let most = seen.iter().copied().fold(0.0, f64::max);
        if least <= most {
            0.6 * least..2.5 * most
        } else {
            0.1..1.0
        }
    }
}

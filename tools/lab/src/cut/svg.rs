//! The chart: time to the right and deviation upward, both logarithmic, and the other measures as a table.

use std::ops::Range;

use plotters::prelude::*;

use super::{Row, Study, WAYS};
use crate::draw::{Area, Drawn, drawn, of_decades, round_numbers, wrapped};
use crate::parts;

const WIDTH: u32 = 1180;
const CHART: (u32, u32) = (WIDTH, 520);
const LINE: i32 = 19;

/// Deviations below are those of rounding, and drawn here.
const LEAST: f64 = 1e-14;

const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// Of ways, in their order: those of Okabe and Ito, and darker where there are more.
const COLOURS: [RGBColor; 10] = [
    RGBColor(0x8a, 0x8a, 0x8a),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xc9, 0x8a, 0x00),
    RGBColor(0x7b, 0x3f, 0xa0),
    RGBColor(0x22, 0x55, 0x44),
    RGBColor(0x44, 0x22, 0x66),
];

/// Draws a study as SVG. Returns `None` if the drawing library fails, which does not happen in memory.
#[must_use]
pub fn svg(study: &Study) -> Option<String> {
    let footer = wrapped(&footer(study), 180);
    let rows = study.rows.len() as i32 + 2;
    let height = CHART.1 as i32 + LINE * rows + 16 * footer.len() as i32 + 24;
    drawn((WIDTH, height as u32), |root| {
        let (top, _) = root.split_vertically(CHART.1);
        chart(study, &top)?;
        table(study, root, CHART.1 as i32 + 8)?;
        for (i, line) in footer.iter().enumerate() {
            let at = (20, CHART.1 as i32 + LINE * rows + 12 + 16 * i as i32);
            let style = ("sans-serif", 12).into_font().color(&GREY);
            root.draw(&Text::new(line.clone(), at, style))?;
        }
        Ok(())
    })
}

fn footer(study: &Study) -> String {
    let from = &study.provenance;
    let missing = parts::told(&study.missing).map_or(String::new(), |told| format!(" · {told}"));
    let record = study
        .rivals
        .first()
        .map(|rival| format!(" · record: {}", rival.processor));
    format!(
        "{} · {} · seed {} · {} cuts each, along the same lines{}{missing}",
        from.line(),
        from.processor(),
        study.seed,
        study.cuts,
        record.unwrap_or_default(),
    )
}

/// A point: where, with which name and colour, and of how many faces.
struct Spot {
    at: (f64, f64),
    name: String,
    colour: RGBColor,
    is_rival: bool,
}

fn spots(study: &Study) -> Vec<Spot> {
    let own = study.rows.iter().filter_map(|row| {
        Some(Spot {
            at: (row.ns_per_face?, row.deviation_edges.max(LEAST)),
            name: String::new(),
            colour: colour(row),
            is_rival: false,
        })
    });
    let rivals = study.rivals.iter().map(|rival| Spot {
        at: (rival.ns_per_face, rival.deviation_edges.max(LEAST)),
        name: format!("{} ({}k)", rival.name, rival.faces / 1000),
        colour: GREY,
        is_rival: true,
    });
    own.chain(rivals).collect()
}

fn colour(row: &Row) -> RGBColor {
    let place = WAYS.iter().position(|way| way.name == row.way);
    COLOURS[place.unwrap_or(0)]
}

fn chart(study: &Study, area: &Area<'_>) -> Drawn {
    let title = "Cuts: time against how far the seam is from the plane";
    area.draw(&Text::new(title, (20, 12), ("sans-serif", 21)))?;
    let words = "Down and to the left is better. Discs: ways of the table below, larger for larger sheets. What is \
                 no further than 1e-14 edges off stands there.";
    let rings = match study.rivals.is_empty() {
        true => "",
        false => " Grey rings: a record of tearmesh-bench, ours and others'.",
    };
    for (i, line) in wrapped(&format!("{words}{rings}"), 170).iter().enumerate() {
        let style = ("sans-serif", 12).into_font().color(&GREY);
        area.draw(&Text::new(line.clone(), (20, 38 + 15 * i as i32), style))?;
    }
    let spots = spots(study);
    if spots.is_empty() {
        let words = "no times were taken";
        return area.draw(&Text::new(words, (40, 120), ("sans-serif", 14)));
    }
    let range = |of: fn(&Spot) -> f64, beyond: f64| -> Range<f64> {
        let least = spots.iter().map(of).fold(f64::INFINITY, f64::min);
        let most = spots.iter().map(of).fold(0.0, f64::max);
        least / beyond..most * beyond
    };
    let (x, y) = (range(|spot| spot.at.0, 1.4), range(|spot| spot.at.1, 4.0));
    let tens: Vec<f64> = of_decades(&y, &[1.0]).into_iter().step_by(2).collect();
    let inner = area.margin(76, 4, 12, 20);
    let mut chart = ChartBuilder::on(&inner)
        .x_label_area_size(38)
        .y_label_area_size(60)
        .build_cartesian_2d(
            x.clone().log_scale().with_key_points(round_numbers(&x)),
            y.log_scale().with_key_points(tens),
        )?;
    chart
        .configure_mesh()
        .x_desc("CPU time of a cut for each face of the mesh, ns")
        .y_desc("deviation of the seam, edges")
        .x_label_formatter(&|x| format!("{x}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .bold_line_style(RGBColor(0xe4, 0xe4, 0xe4))
        .light_line_style(TRANSPARENT)
        .draw()?;
    let mut sizes: Vec<usize> = study.rows.iter().map(|row| row.faces).collect();
    sizes.dedup();
    let rows = study.rows.iter().filter(|row| row.ns_per_face.is_some());
    for (spot, row) in spots.iter().filter(|spot| !spot.is_rival).zip(rows) {
        let place = sizes.iter().position(|faces| *faces == row.faces);
        let size = 4 + 2 * place.unwrap_or(0) as i32;
        chart.draw_series([Circle::new(spot.at, size, spot.colour.filled())])?;
    }
    // Words that would stand on each other go below the ones before.
    let mut taken: Vec<(i32, i32)> = Vec::new();
    for spot in spots.iter().filter(|spot| spot.is_rival) {
        chart.draw_series([Circle::new(spot.at, 5, GREY.stroke_width(1))])?;
        let (left, middle) = chart.backend_coord(&spot.at);
        let mut at = (left + 8, middle - 6);
        let hits = |at: (i32, i32), other: &(i32, i32)| {
            (at.0 - other.0).abs() < 150 && (at.1 - other.1).abs() < 11
        };
        while taken.iter().any(|other| hits(at, other)) {
            at.1 -= 11;
        }
        taken.push(at);
        let style = ("sans-serif", 10).into_font().color(&GREY);
        area.draw(&Text::new(spot.name.clone(), at, style))?;
    }
    Ok(())
}

/// The columns of the table, each with where it begins.
const HEAD: [(&str, i32); 12] = [
    ("way", 40),
    ("faces", 190),
    ("ns/face", 262),
    ("deviation", 336),
    ("(most)", 424),
    ("length", 500),
    ("divided", 590),
    ("crumbs", 668),
    ("inserted", 744),
    ("angle °", 832),
    ("altitude", 914),
    ("stable step (least)", 1006),
];

fn table(study: &Study, root: &Area<'_>, top: i32) -> Drawn {
    let size = ("sans-serif", 13);
    for (name, x) in HEAD {
        root.draw(&Text::new(name, (x, top), size.into_font().color(&GREY)))?;
    }
    for (i, row) in study.rows.iter().enumerate() {
        let y = top + LINE * (i as i32 + 1);
        root.draw(&Circle::new((26, y + 7), 5, colour(row).filled()))?;
        let time = row
            .ns_per_face
            .map_or("–".to_owned(), |ns| format!("{ns:.2}"));
        let cells = [
            row.way.to_owned(),
            row.faces.to_string(),
            time,
            format!("{:.1e}", row.deviation_edges),
            format!("{:.1e}", row.deviation_edges_most),
            format!("{:.4}", row.length_ratio),
            format!("{} of {}", row.divided, study.cuts),
            format!("{:.1}", row.crumbs),
            format!("{}", row.inserted),
            format!("{:.2}", row.angle_min_deg),
            format!("{:.1e}", row.altitude_ratio),
            format!("{:.2} ({:.2})", row.step_ratio, row.step_ratio_least),
        ];
        for (cell, (_, x)) in cells.into_iter().zip(HEAD) {
            root.draw(&Text::new(cell, (x, y), size))?;
        }
    }
    Ok(())
}

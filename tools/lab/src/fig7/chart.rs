//! The figure and the summary of a table: the time of splits against the size of the mesh.

use tearmesh_cloth::scene::FRAME_S;

use super::implementations::{GHOST_PAIRS, IMPLEMENTATIONS, SCAN};
use super::{Fig7, ROUNDS, Row};
use crate::experiment::{Chart, Provenance, Status};
use crate::plot::{Axis, COLOURS, Figure, Layer, Panel, short};

/// A number of an implementation on a patch: from its smallest over its middle to its largest value.
type Measure = fn(&[&Row]) -> Option<[f64; 3]>;

impl Chart for Fig7 {
    fn figure(&self, rows: &[Row], provenance: &Provenance) -> Figure {
        figure(rows, provenance)
    }

    fn summary(&self, rows: &[Row]) -> String {
        summary(rows)
    }
}

fn figure(rows: &[Row], provenance: &Provenance) -> Figure {
    let mut footer = vec![provenance.footer()];
    if rows.iter().any(|row| row.status == Status::Interrupted) {
        footer.push("INTERRUPTED: some patches are missing.".to_owned());
    }
    let sums: Measure = |rounds| {
        let sums = rounds.iter().filter_map(|row| Some(1e3 * row.sum_s?));
        let (least, most) = (sums.clone().reduce(f64::min)?, sums.reduce(f64::max)?);
        Some([least, 1e3 * rounds[0].mean_s?, most])
    };
    let worst: Measure = |rounds| Some([100.0 * rounds[0].worst_frame_s? / FRAME_S; 3]);
    let title_of_sums = format!("All splits: mean and range of {ROUNDS} rounds");
    let title_of_worst = "The frame in which splits take longest: median";
    Figure {
        title: title(rows).unwrap_or("The time to split vertices".to_owned()),
        about: "The time to split vertices while a hanging cloth is ripped, as in Figure 7 of the paper."
            .to_owned(),
        columns: 2,
        panel_size: [520.0, 400.0],
        panels: vec![
            panel(rows, &title_of_sums, "CPU time, ms", sums),
            panel(rows, title_of_worst, "% of a frame of 1/60 s", worst),
        ],
        footer,
        ..Figure::default()
    }
}

/// The finding on the largest patch; `None` if it was not measured.
fn title(rows: &[Row]) -> Option<String> {
    let largest = rows.iter().filter_map(|row| row.faces).max()?;
    let of = |name: &str| {
        let is_it = |row: &&Row| row.implementation == name && row.faces == Some(largest);
        rows.iter().find(is_it)
    };
    let (ours, scan) = (of(GHOST_PAIRS)?, of(SCAN)?);
    let times = scan.mean_s? / ours.mean_s?;
    let percent = short(100.0 * ours.worst_frame_s? / FRAME_S, 2);
    let times = times.is_finite().then(|| short(times, 2))?;
    Some(format!(
        "With ghost pairs, splits are {times} times as fast as with a scan at {largest} faces, and take \
         {percent} % of the worst frame"
    ))
}

/// A measure of all implementations against the faces of the patch.
fn panel(rows: &[Row], title: &str, y: &str, of: Measure) -> Panel {
    let (mut layers, mut labels) = (Vec::new(), Vec::new());
    let colours = [COLOURS[1], COLOURS[4], COLOURS[0]];
    for ((name, _), colour) in IMPLEMENTATIONS[1..].iter().zip(colours) {
        let own: Vec<&Row> = rows
            .iter()
            .filter(|row| row.implementation == *name)
            .collect();
        let points = own.chunk_by(|a, b| a.cells == b.cells);
        let points = points.filter_map(|rounds| Some((rounds[0].faces? as f64, of(rounds)?)));
        let points: Vec<(f64, [f64; 3])> = points.collect();
        let middles = points.iter().map(|&(x, [_, middle, _])| [x, middle]);
        labels.extend(middles.clone().next_back().map(|at| Layer::Label {
            at,
            text: (*name).to_owned(),
            colour,
        }));
        layers.push(Layer::Line {
            points: middles.collect(),
            colour,
            width: 1.5,
        });
        let intervals = points.into_iter();
        layers.extend(intervals.map(|(x, y)| Layer::Interval { x, y, colour }));
    }
    layers.extend(labels);
    let faces = rows
        .iter()
        .filter_map(|row| row.faces)
        .map(|faces| faces as f64);
    let least = faces.clone().reduce(f64::min).unwrap_or(1.0);
    let most = faces.reduce(f64::max).unwrap_or(1.0);
    // Labels stand to the right of the last points.
    let end = most * (most / least).max(4.0).powf(0.8);
    Panel {
        title: title.to_owned(),
        x: Axis::log("faces").from_to(0.8 * least, end),
        y: Axis::log(y),
        layers,
        ..Panel::default()
    }
}

fn summary(rows: &[Row]) -> String {
    let is_first = |row: &&Row| row.round.unwrap_or(0) == 0;
    let lines = rows.iter().filter(is_first).map(|row| {
        let times = || {
            Some(format!(
                "{}: {} splits in {} of {} frames take {} ms, {} % of the worst frame; the simulation \
                 takes {:.0} ms",
                row.implementation,
                row.splits?,
                row.frames_with_splits?,
                row.frames?,
                short(1e3 * row.mean_s?, 3),
                short(100.0 * row.worst_frame_s? / FRAME_S, 2),
                1e3 * row.simulation_s?,
            ))
        };
        let times = times().unwrap_or_else(|| row.why.clone());
        format!("{n} × {n} cells, {times}\n", n = row.cells)
    });
    lines.collect()
}

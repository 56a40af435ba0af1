//! The figure and the summary of a table: the time of splits against the size of the mesh.

use super::implementations::{GHOST_PAIRS, IMPLEMENTATIONS, SCAN};
use super::{Fig7, ROUNDS, Row};
use crate::experiment::Draw;
use crate::plot::{Axis, COLOURS, Figure, Layer, Mark, Panel, Shape, short};

/// The rows of each implementation on each patch.
fn groups(rows: &[Row]) -> impl Iterator<Item = &[Row]> + Clone {
    rows.chunk_by(|a, b| a.cells == b.cells && a.implementation == b.implementation)
}

/// The time of all splits in ms: the shortest of all rounds, the mean and the longest; `None` without times.
fn sum_ms(rounds: &[Row]) -> Option<[f64; 3]> {
    let sums = rounds.iter().filter_map(|row| Some(1e3 * row.sum_s?));
    let least = sums.clone().reduce(f64::min)?;
    let most = sums.clone().reduce(f64::max)?;
    Some([least, sums.sum::<f64>() / rounds.len() as f64, most])
}

impl Draw for Fig7 {
    fn figure(&self, rows: &[Row]) -> Figure {
        let names = IMPLEMENTATIONS[1..].iter().map(|(name, _)| *name);
        let (mut legend, mut layers) = (Vec::new(), Vec::new());
        let axes = ["faces", "CPU time, ms"].map(Axis::log);
        for (name, colour) in names.zip([COLOURS[1], COLOURS[4], COLOURS[0]]) {
            let mark = Mark::new(Shape::DISC, colour);
            legend.push((mark, name.to_owned()));
            let own = groups(rows).filter(|rounds| rounds[0].implementation == name);
            let points = own.filter_map(|rounds| Some((rounds[0].faces? as f64, sum_ms(rounds)?)));
            let line = points.clone().map(|(x, [_, mean, _])| [x, mean]);
            layers.push(Layer::Line(line.collect(), colour, 1.5));
            layers.extend(points.flat_map(|(x, y)| Layer::interval(x, y, mark, name.to_owned())));
        }
        Figure {
            title: title(rows).unwrap_or("The time to split vertices".to_owned()),
            about: format!(
                "The time of all splits while a hanging cloth is ripped, as in Figure 7 of the paper: mean and range \
                 of {ROUNDS} rounds."
            ),
            legend,
            layout: (1, [720.0, 460.0]),
            panels: vec![Panel::new("", "", axes, layers)],
            footer: Vec::new(),
        }
    }

    fn summary(&self, rows: &[Row]) -> String {
        let lines = groups(rows).map(|rounds| {
            let first = &rounds[0];
            let times = || {
                Some(format!(
                    "{}: {} splits take {} ms, and the simulation takes {:.0} ms",
                    first.implementation,
                    first.splits?,
                    short(sum_ms(rounds)?[1], 3),
                    1e3 * first.simulation_s?,
                ))
            };
            let times = times().unwrap_or_else(|| first.status.name().to_owned());
            format!("{n} × {n} cells, {times}\n", n = first.cells)
        });
        lines.collect()
    }
}

/// The finding on the largest patch; `None` if it was not measured.
fn title(rows: &[Row]) -> Option<String> {
    let largest = rows.iter().filter_map(|row| row.faces).max()?;
    let mut on_largest = groups(rows).filter(|rounds| rounds[0].faces == Some(largest));
    let scan = on_largest.find(|rounds| rounds[0].implementation == SCAN)?;
    let ours = on_largest.find(|rounds| rounds[0].implementation == GHOST_PAIRS)?;
    let ours_ms = sum_ms(ours)?[1];
    let times = sum_ms(scan)?[1] / ours_ms;
    let share = ours_ms / (1e3 * ours[0].simulation_s?);
    times.is_finite().then(|| {
        format!(
            "With ghost pairs, splits are {} times as fast as with a scan at {largest} faces, and take {} % of the \
             time of the simulation",
            short(times, 2),
            short(100.0 * share, 2)
        )
    })
}

//! The figure and the summary of a table: time against deviation, and the measures by which to choose a snap.

use std::cmp::Reverse;
use std::fmt::Write as _;

use super::{Cuts, METHODS, Row};
use crate::experiment::{Chart, Provenance, Status};
use crate::plot::{Axis, COLOURS, Figure, GREY, Layer, Mark, PALE, Panel, Shape, Strip, short};

/// The largest deviation that counts as rounding, in mean edge lengths.
const ROUNDING_EDGES: f64 = 1e-9;

/// A number of a row: its median over all cuts, and that of the worst cut.
type Measure = fn(&Row) -> Option<[f64; 2]>;

impl Chart for Cuts {
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
        footer.push("INTERRUPTED: some methods are missing.".to_owned());
    }
    footer.push(
        "The number of a method is its snap: a crossing moves to the end of its edge if it is closer than this \
         fraction of the edge. “Moved” then moves that vertex onto the plane. Marks are larger for larger \
         sheets. Lines lead from the median over all cuts to the worst cut."
            .to_owned(),
    );
    let record = rows.iter().find_map(|row| row.processor.as_ref());
    footer.extend(record.map(|processor| {
        format!("Hollow marks: a record of tearmesh-bench on {processor}. Those without a label are ours.")
    }));
    let (log, linear) = (Axis::log(""), Axis::linear(""));
    let measures: [(&str, &Axis, Measure); 5] = [
        ("Stable step of springs, after / before", &log, |row| {
            Some([row.step_ratio?, row.step_ratio_least?])
        }),
        ("Smallest angle of all faces, degrees", &log, |row| {
            Some([row.angle_min_deg?; 2])
        }),
        (
            "Smallest altitude of all faces, after / before",
            &log,
            |row| Some([row.altitude_ratio?; 2]),
        ),
        ("Length, seam / straight line", &linear, |row| {
            Some([row.length_ratio?, row.length_ratio_most?])
        }),
        ("Cuts into the expected pieces, %", &linear, |row| {
            Some([100.0 * row.divided? as f64 / row.cuts? as f64; 2])
        }),
    ];
    let mut panels = vec![time_panel(rows)];
    panels.extend(measures.map(|(title, x, of)| measure_panel(rows, title, x, of)));
    Figure {
        title: title(rows)
            .unwrap_or("The time of cuts, and their distance from the plane".to_owned()),
        about: "Cuts through wavy sheets along random lines, the same for all methods.".to_owned(),
        columns: 2,
        panel_size: [580.0, 460.0],
        panels,
        footer,
        ..Figure::default()
    }
}

/// The finding on the largest sheet; `None` if rows are missing.
fn title(rows: &[Row]) -> Option<String> {
    let own = || rows.iter().filter(|row| row.processor.is_none());
    let largest = own().map(|row| row.faces).max()?;
    let of = |name: &str| own().find(|row| row.method == name && row.faces == largest);
    let (partition, exact, snapped) = (of("partition")?, of("exact 0")?, of("exact .05")?);
    let times = exact.ns_per_face? / partition.ns_per_face?;
    let steps = snapped.step_ratio? / exact.step_ratio?;
    let is_on_plane = exact.deviation_edges_most? <= ROUNDING_EDGES;
    (is_on_plane && times.is_finite() && steps.is_finite()).then(|| {
        format!(
            "An exact cut lies on its plane and takes {} times as long as a partition. A snap of .05 makes the \
             stable step {} times as long",
            short(times, 2),
            short(steps, 2)
        )
    })
}

/// The mark of a row, larger for more faces. Snaps share a mark.
fn mark(row: &Row) -> Mark {
    let is_moved = row.method.ends_with("moved");
    let mark = match row.method.as_str() {
        _ if row.processor.is_some() => Mark::new(Shape::Disc, GREY).hollow(),
        "uniform" => Mark::new(Shape::Up, COLOURS[3]),
        "alternating" => Mark::new(Shape::Down, COLOURS[4]),
        "partition" => Mark::new(Shape::Square, COLOURS[1]),
        _ if is_moved => Mark::new(Shape::Diamond, COLOURS[2]),
        _ => Mark::new(Shape::Disc, COLOURS[0]),
    };
    mark.sized((row.faces as f64).log10())
}

fn hover(row: &Row, number: f64) -> String {
    format!("{}, {} faces: {}", row.method, row.faces, short(number, 3))
}

/// Time against deviation, with a strip for cuts on the plane.
fn time_panel(rows: &[Row]) -> Panel {
    let points = rows
        .iter()
        .filter_map(|row| Some((row, [row.ns_per_face?, row.deviation_edges?])));
    let (mut points, on_plane): (Vec<(&Row, [f64; 2])>, Vec<_>) =
        points.partition(|(_, at)| at[1] > ROUNDING_EDGES);
    let name = |row: &Row| (row.processor.clone(), row.method.clone());
    // A record is drawn behind our rows, which would have the same labels.
    points.sort_by_key(|(row, _)| Reverse(name(row)));
    let is_labelled = |row: &Row| {
        let is_ours = row.method == "partition" || row.method.starts_with("exact");
        row.processor.is_none() || !is_ours
    };
    let (mut layers, mut labels) = (Vec::new(), Vec::new());
    for sizes in points.chunk_by(|(a, _), (b, _)| name(a) == name(b)) {
        let colour = mark(sizes[0].0).colour;
        layers.push(Layer::Line {
            points: sizes.iter().map(|(_, at)| *at).collect(),
            colour,
            width: 1.0,
        });
        layers.extend(sizes.iter().map(|&(row, at)| Layer::Mark {
            at,
            mark: mark(row),
            hover: hover(row, at[1]),
        }));
        let slowest = sizes.iter().max_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]));
        let slowest = slowest.filter(|(row, _)| is_labelled(row));
        labels.extend(slowest.map(|&(row, at)| Layer::Label {
            at,
            text: row.method.clone(),
            colour,
        }));
    }
    layers.extend(labels.into_iter().rev());
    let mut names: Vec<&str> = on_plane.iter().map(|(row, _)| &*row.method).collect();
    names.sort_unstable();
    names.dedup();
    let marks = on_plane
        .iter()
        .map(|(row, at)| (at[0], mark(row), hover(row, at[1])));
    Panel {
        title: "Time against distance from the plane".to_owned(),
        about: format!("On the plane: {}.", names.join("; ")),
        x: Axis::log("CPU time of a cut per face of the sheet, ns"),
        y: Axis::log("largest distance of the seam, edges"),
        below: Some(Strip {
            label: "on the plane, to rounding".to_owned(),
            marks: marks.collect(),
        }),
        layers,
        ..Panel::default()
    }
}

/// A measure of all methods, one below the other.
fn measure_panel(rows: &[Row], title: &str, x: &Axis, of: Measure) -> Panel {
    let names = METHODS.iter().rev().map(|(name, ..)| (*name).to_owned());
    let names: Vec<String> = names.collect();
    let bands = (0..names.len()).step_by(2).map(|i| Layer::Band {
        y: i as f64..(i + 1) as f64,
        colour: PALE,
    });
    let mut layers: Vec<Layer> = bands.collect();
    let own: Vec<&Row> = rows.iter().filter(|row| row.processor.is_none()).collect();
    let sheets = own.chunk_by(|a, b| a.faces == b.faces);
    let count = sheets.clone().count();
    for (i, row) in sheets
        .enumerate()
        .flat_map(|(i, sheet)| sheet.iter().map(move |row| (i, row)))
    {
        let place = names.iter().position(|name| *name == row.method);
        let (Some(place), Some(numbers)) = (place, of(row)) else {
            continue;
        };
        let y = (place + 1) as f64 - (i + 1) as f64 / (count + 1) as f64;
        layers.push(Layer::Line {
            points: numbers.map(|number| [number, y]).to_vec(),
            colour: mark(row).colour,
            width: 1.5,
        });
        layers.push(Layer::Mark {
            at: [numbers[0], y],
            mark: mark(row),
            hover: hover(row, numbers[0]),
        });
    }
    Panel {
        title: title.to_owned(),
        x: x.clone(),
        y: Axis::named(names),
        layers,
        ..Panel::default()
    }
}

fn summary(rows: &[Row]) -> String {
    let mut text = String::from(
        "   faces  method           ns/face  deviation   length  divided  crumbs  inserted   angle  altitude    \
         step\n",
    );
    for row in rows.iter().filter(|row| row.processor.is_none()) {
        let numbers = || {
            let time = row
                .ns_per_face
                .map_or("–".to_owned(), |ns| format!("{ns:.2}"));
            Some(format!(
                "{time:>8} {:>10.1e} {:>8.4} {:>8} {:>7.2} {:>9} {:>7.2} {:>9.1e} {:>7.3}",
                row.deviation_edges?,
                row.length_ratio?,
                row.divided?,
                row.crumbs?,
                row.inserted?,
                row.angle_min_deg?,
                row.altitude_ratio?,
                row.step_ratio?,
            ))
        };
        let numbers = numbers().unwrap_or_else(|| row.why.clone());
        writeln!(text, "{:>8}  {:<15} {numbers}", row.faces, row.method).expect("a string grows");
    }
    text
}

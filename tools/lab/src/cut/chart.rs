//! The figure and the summary of a table: a panel and a column for each measure by which to choose a method.

use std::fmt::Write as _;

use super::{Cuts, METHODS, Row};
use crate::experiment::{Draw, Status};
use crate::plot::{Axis, COLOURS, Figure, Layer, Mark, Panel, Shape, short};

/// The largest deviation that counts as rounding, in mean edge lengths. Smaller ones are drawn there.
const ROUNDING_EDGES: f64 = 1e-9;

/// A measure of a method on a sheet: the heading in the summary, the title of the panel with the unit, the kind of
/// axis, and the median over all cuts with the worst cut.
type Measure = (
    &'static str,
    &'static str,
    fn(&str) -> Axis,
    fn(&Row) -> Option<[f64; 2]>,
);

const MEASURES: [Measure; 4] = [
    (
        "ns/face",
        "CPU time of a cut per face of the sheet, ns",
        Axis::log,
        |row| Some([row.ns_per_face?; 2]),
    ),
    (
        "distance",
        "Distance of the seam from the plane, edges; 1e-9 is rounding",
        Axis::log,
        |row| {
            let both = [row.deviation_edges?, row.deviation_edges_most?];
            Some(both.map(|edges| edges.max(ROUNDING_EDGES)))
        },
    ),
    (
        "divided",
        "Cuts into the expected pieces, %",
        Axis::linear,
        |row| Some([100.0 * row.divided? as f64 / row.cuts? as f64; 2]),
    ),
    (
        "step",
        "Stable step of springs, after / before",
        Axis::log,
        |row| Some([row.step_ratio?, row.step_ratio_least?]),
    ),
];

/// How to read the figure.
const READING: &str = "The number of a method is its snap: a crossing moves to the end of its edge if it is closer \
     than this fraction of the edge. “Moved” then moves that vertex onto the plane. Marks are larger for larger \
     sheets. Lines lead from the median over all cuts to the worst cut.";

impl Draw for Cuts {
    fn figure(&self, rows: &[Row]) -> Figure {
        Figure {
            title: title(rows)
                .unwrap_or("The time of cuts, and their distance from the plane".to_owned()),
            about: "Cuts through wavy sheets along random lines, the same for all methods."
                .to_owned(),
            layout: (2, [580.0, 460.0]),
            panels: MEASURES.map(|measure| panel(rows, &measure)).into(),
            footer: vec![READING.to_owned()],
            ..Figure::default()
        }
    }

    fn summary(&self, rows: &[Row]) -> String {
        let mut text = format!("{:<16} {:>7}", "method", "faces");
        text.extend(MEASURES.map(|(head, ..)| format!(" {head:>9}")));
        for row in rows {
            write!(text, "\n{:<16} {:>7}", row.method, row.faces).expect("a string grows");
            let medians = MEASURES
                .iter()
                .map(|(.., of)| of(row).map_or("–".to_owned(), |[median, _]| short(median, 3)));
            text.extend(medians.map(|median| format!(" {median:>9}")));
            if row.status != Status::Ok {
                text += &format!("  {}", row.status.name());
            }
        }
        text
    }
}

/// The finding on the largest sheet; `None` if rows are missing.
fn title(rows: &[Row]) -> Option<String> {
    let largest = rows.iter().map(|row| row.faces).max()?;
    let is_it = |row: &&Row, name: &str| row.method == name && row.faces == largest;
    let of = |name: &str| rows.iter().find(|row| is_it(row, name));
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
    let mark = match row.method.as_str() {
        "uniform" => Mark::new(Shape::UP, COLOURS[3]),
        "alternating" => Mark::new(Shape::DOWN, COLOURS[4]),
        "partition" => Mark::new(Shape::SQUARE, COLOURS[1]),
        name if name.ends_with("moved") => Mark::new(Shape::DIAMOND, COLOURS[2]),
        _ => Mark::new(Shape::DISC, COLOURS[0]),
    };
    mark.sized((row.faces as f64).log10())
}

/// A measure of all methods that have it, one below the other.
fn panel(rows: &[Row], (_, title, axis, of): &Measure) -> Panel {
    let names = METHODS.iter().rev().map(|(name, ..)| (*name).to_owned());
    let names: Vec<String> = names.collect();
    let mut layers = Vec::new();
    for (i, name) in names.iter().enumerate() {
        if i % 2 == 0 {
            layers.push(Layer::Band(i as f64..(i + 1) as f64));
        }
        let own = rows.iter().filter(|row| row.method == *name);
        let own = own.filter_map(|row| Some((row, of(row)?)));
        let count = own.clone().count();
        for (j, (row, [median, worst])) in own.enumerate() {
            let y = (i + 1) as f64 - (j + 1) as f64 / (count + 1) as f64;
            let mark = mark(row);
            layers.push(Layer::Line(vec![[median, y], [worst, y]], mark.colour, 1.5));
            let hover = format!("{name}, {} faces: {}", row.faces, short(median, 3));
            layers.push(Layer::Mark([median, y], mark, hover));
        }
    }
    Panel::new(title, "", [axis(""), Axis::named(names)], layers)
}

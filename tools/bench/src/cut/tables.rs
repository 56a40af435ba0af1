//! Snap against quality, and method against method: random through cuts of one sheet.
//!
//! Beside our figures stand those of the experiments that the rules of the scissor come from.

use tearmesh::CutMethod;
use tearmesh_lab::sheet::through;
use tearmesh_lab::statistics::{Random, median};

use super::facts::{Facts, Sheet, sheet};
use super::ways::{Form, time};
use crate::measure::median_of;
use crate::options::Options;
use crate::table::{line, table};

const FACES: usize = 20_000;
const CUTS: usize = 40;

/// Both tables.
pub(super) fn run(options: &Options) -> String {
    let sheet = sheet(FACES);
    let head = format!(
        "{CUTS} random through cuts of {} faces, with room; in brackets what was found elsewhere",
        sheet.0.face_count()
    );
    format!(
        "{head}\n{}\n{}",
        snaps(&sheet, options),
        methods(&sheet, options)
    )
}

/// The cuts of one method, all of them.
struct Series {
    facts: Vec<Facts>,
    /// The median, in ms.
    time: f64,
}

impl Series {
    fn new(method: CutMethod, snap: f64, sheet: &Sheet, options: &Options) -> Series {
        let mut random = Random::new(7);
        let mut times = Vec::new();
        let mut facts = Vec::new();
        for _ in 0..CUTS {
            let at = [0.3 + 0.4 * random.next(), 0.3 + 0.4 * random.next()];
            let scissor = through(at, std::f64::consts::PI * random.next()).with_snap(snap);
            facts.push(Facts::new(&scissor, method, sheet));
            for _ in 0..options.rounds {
                times.push(time(&scissor, method, Form::Room, sheet) * 1e3);
            }
        }
        Series {
            facts,
            time: median(times).expect("there is a cut"),
        }
    }

    fn median(&self, of: impl Fn(&Facts) -> f64) -> f64 {
        median_of(&self.facts, of)
    }

    fn mean(&self, of: impl Fn(&Facts) -> usize) -> f64 {
        self.facts.iter().map(of).sum::<usize>() as f64 / self.facts.len() as f64
    }
}

const SNAPS: [(f64, &str, &str, &str); 5] = [
    (0.0, "1e-15", "7e-5", "3.6-6.1"),
    (0.02, ".007-.011", ".020", "0"),
    (0.05, ".039-.044", ".050", "0"),
    (0.1, ".10", ".099", "0"),
    (0.2, ".22", ".18", "0"),
];

/// Median deviation in edges, smallest altitude of a child as a part of its parent's, and how
/// many children a cut has with less than 2 %.
fn snaps(sheet: &Sheet, options: &Options) -> String {
    let mut lines = vec![line([
        "snap",
        "deviation",
        "",
        "altitude",
        "",
        "slivers",
        "",
        "length",
        "inserted",
        "ms",
    ])];
    for (snap, deviation, altitude, slivers) in SNAPS {
        let series = Series::new(CutMethod::Exact, snap, sheet, options);
        let least = series.facts.iter().map(|facts| facts.child_altitude);
        lines.push(line([
            &snap.to_string(),
            &format!(
                "{:.1e}",
                series.median(|facts| facts.report.seam_deviation_max_edges)
            ),
            &format!("({deviation})"),
            &format!("{:.1e}", least.fold(1.0, f64::min)),
            &format!("({altitude})"),
            &format!("{:.1}", series.mean(|facts| facts.slivers)),
            &format!("({slivers})"),
            &format!(
                "{:.6}",
                series.median(|facts| facts.report.seam_length_ratio)
            ),
            &format!("{:.0}", series.mean(|facts| facts.report.vertices_inserted)),
            &format!("{:.3}", series.time),
        ]));
    }
    table(&lines)
}

const METHODS: [(CutMethod, f64, &str, &str, &str); 5] = [
    (CutMethod::Uniform, 0.0, "uniform", "0", ""),
    (CutMethod::Alternating, 0.0, "alternating", "29", "to 2.1"),
    (CutMethod::Partition, 0.0, "partition", "40", "1.04-1.15"),
    (CutMethod::Exact, 0.0, "exact, snap 0", "40", "1"),
    (CutMethod::Exact, 0.05, "exact, snap 0.05", "40", ""),
];

/// How many cuts divide, into as many pieces as there should be, and what that takes.
fn methods(sheet: &Sheet, options: &Options) -> String {
    let mut lines = vec![line([
        "method",
        "divided",
        "",
        "crumbs",
        "length",
        "",
        "longest",
        "deviation",
        "splits",
        "inserted",
        "ms",
    ])];
    for (method, snap, name, divided_elsewhere, ratio) in METHODS {
        let series = Series::new(method, snap, sheet, options);
        let divided = series.facts.iter().filter(|facts| facts.divided).count();
        let longest = series
            .facts
            .iter()
            .map(|facts| facts.report.seam_length_ratio);
        let quoted = |quoted: &str| match quoted {
            "" => String::new(),
            quoted => format!("({quoted})"),
        };
        lines.push(line([
            name,
            &divided.to_string(),
            &quoted(divided_elsewhere),
            &format!("{:.2}", series.mean(|facts| facts.report.crumbs)),
            &format!(
                "{:.3}",
                series.median(|facts| facts.report.seam_length_ratio)
            ),
            &quoted(ratio),
            &format!("{:.3}", longest.fold(0.0, f64::max)),
            &format!(
                "{:.1e}",
                series.median(|facts| facts.report.seam_deviation_max_edges)
            ),
            &format!("{:.1}", series.mean(|facts| facts.report.splits)),
            &format!("{:.1}", series.mean(|facts| facts.report.vertices_inserted)),
            &format!("{:.3}", series.time),
        ]));
    }
    table(&lines)
}

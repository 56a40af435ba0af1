//! The figures of a study as a table.

use std::fmt::Write as _;

use super::Chart;
use crate::parts::{Missing, cell};

/// Returns the strips as CSV: for each test a line `largest`, a line `mean`, a line `curve` per point of its
/// curve, and a line per first tear, such as `first xpbd @0.001` with its step in seconds.
/// A missing part has a line `missing` with its name, and the reason in the last column.
#[must_use]
pub fn csv(chart: &Chart) -> String {
    let mut text = String::from("rule,threshold,cells,edge_m,what,displacement_m,force_n\n");
    for test in &chart.study.tests {
        let name = format!(
            "{},{},{},{}",
            test.rule, test.threshold, test.cells, test.edge_m
        );
        let mut line = |what: &str, displacement: String, force: f64| {
            writeln!(text, "{name},{what},{displacement},{force}").expect("a string grows");
        };
        line("largest", String::new(), test.force_largest_n);
        line("mean", String::new(), test.force_mean_n);
        for first in &test.first {
            let what = format!("first {} @{}", first.method, first.dt_s);
            line(&what, first.displacement_m.to_string(), first.force_n);
        }
        for [displacement, force] in &test.curve {
            line("curve", displacement.to_string(), *force);
        }
    }
    for Missing { part, why } in &chart.missing {
        writeln!(text, ",,,,missing {part},,{}", cell(why)).expect("a string grows");
    }
    text
}

//! Bounds of the deviation of cuts, and times by a clock of our own.

use std::sync::atomic::{AtomicU64, Ordering};

use super::*;
use crate::experiment::{conduct, workers};

/// The rows by a clock that is a microsecond later whenever it is read.
fn measured(cuts: &Cuts) -> Vec<Row> {
    let calls = AtomicU64::new(0);
    let clock = || Duration::from_micros(calls.fetch_add(1, Ordering::Relaxed));
    let bounds = Bounds {
        clock: Some(&clock),
        stop: &|| false,
    };
    conduct(cuts, workers(), &bounds, |_| {}).0
}

#[test]
fn snap_bounds_deviation_and_pieces_are_those_expected() {
    let rows = measured(&Cuts::new(&[24], 6));
    assert_eq!(rows.len(), METHODS.len());
    let of = |name: &str, number: fn(&Row) -> Option<f64>| {
        let row = rows.iter().find(|row| row.method == name);
        number(row.expect("a row for each method")).expect("a number for each row")
    };
    for (name, snap) in [("exact .02", 0.02), ("exact .05", 0.05), ("exact .1", 0.1)] {
        // At most the snap times the longest edge, which is some two and a half of the mean.
        let most = of(name, |row| row.deviation_edges_most);
        assert!(most > 0.3 * snap && most < 2.5 * snap, "{name}: {most}");
    }
    assert!(of("exact 0", |row| row.deviation_edges_most) < 1e-11);
    // A vertex stays off the plane if the move would spoil a face.
    assert!(of("exact .05 moved", |row| row.deviation_edges) < 1e-11);
    let [moved, unmoved] =
        ["exact .05 moved", "exact .05"].map(|name| of(name, |row| row.deviation_edges_most));
    assert!(moved <= unmoved);
    for row in &rows {
        let is_proved = row.method == "partition" || row.method.starts_with("exact");
        assert_eq!(row.divided == row.cuts, is_proved, "{}", row.method);
        // One microsecond, by 2 · 24² faces.
        let ns = row.ns_per_face.expect("a time for each row");
        assert!((ns - 1000.0 / 1152.0).abs() < 1e-9, "{}: {ns}", row.method);
    }
    // A smaller snap leaves thinner faces.
    let steps = ["partition", "exact .2", "exact .05", "exact 0"];
    let steps = steps.map(|name| of(name, |row| row.step_ratio));
    assert!(steps.is_sorted_by(|a, b| a > b), "{steps:?}");
    assert!(steps[0] > 0.5 && steps[0] <= 1.0 + 1e-6);
}

//! Errors against answers worked out by hand, and a page that has a row for every run.

use super::*;
use crate::experiment::workers;
use crate::experiment::{Chart, Provenance, conduct};

fn guide() -> Guide {
    Guide::new(8, 2, 2)
}

#[test]
fn page_has_all_topics_and_errors_by_hand() {
    let bounds = Bounds {
        clock: None,
        stop: &|| false,
    };
    let guide = guide();
    let (rows, done) = conduct(&guide, workers(), &bounds, |_| {});
    let planned = guide.plan().concat().len();
    assert_eq!((done, rows.len()), (planned, planned));
    let figure = guide.figure(&rows, &Provenance::default());
    assert_eq!(figure.panels.len(), 6);
    // What the references do not know recommends nothing.
    let unknown = |summary: String| summary.matches("not known, as the references").count();
    let mut apart = rows.clone();
    for row in apart.iter_mut().filter(|row| row.topic == Topic::Hang) {
        row.error_floor = row.error_floor.and(Some(0.1));
    }
    let [before, after] = [&rows, &apart].map(|rows| unknown(guide.summary(rows)));
    assert_eq!(after, before + 1);
    // At rest there is one shape, whatever finds it, but for methods whose sweeps are soft.
    let error = |method: &str| {
        let is_it = |row: &&Row| {
            row.topic == Topic::Hang
                && row.role == Role::Method
                && row.cells == 8
                && row.method == method
        };
        let row = rows
            .iter()
            .filter(is_it)
            .find(|row| row.step_multiple.is_none());
        row.and_then(|row| row.error).expect("it is known")
    };
    for method in ["verlet", "implicit", "provot"] {
        assert!(error(method) < 1e-3, "{method}: {}", error(method));
    }
    assert!(error("xpbd") > 0.1, "{}", error("xpbd"));
}

#[test]
fn error_is_the_largest_of_the_quantities_that_both_know() {
    let run = |answer: &[&[f64]]| Row {
        answer: Some(answer.iter().map(|numbers| numbers.to_vec()).collect()),
        ..Row::default()
    };
    let of = |runs: &[Row], known: &Row| error(&runs.iter().collect::<Vec<_>>(), &[known]);
    let known = run(&[&[3.0, 4.0], &[2.0]]);
    // The means are [3.0, 4.5] and 1.9.
    let runs = [run(&[&[3.0, 4.0], &[1.6]]), run(&[&[3.0, 5.0], &[2.2]])];
    let found = of(&runs, &known).expect("both are known");
    assert!((found - 0.1).abs() < 1e-15, "{found}");
    assert_eq!(of(&[run(&[&[3.0, 4.0]])], &known), Some(0.0));
    assert_eq!(of(&[Row::default()], &known), None);
}

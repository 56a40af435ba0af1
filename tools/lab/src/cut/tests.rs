//! What is known of cut methods holds, records are read, and the same options give the same study.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;

fn options() -> Options {
    Options {
        cells: vec![24],
        cuts: 6,
        threads: NonZero::<usize>::MIN.saturating_add(1),
    }
}

fn made() -> Study {
    let study = study(
        &options(),
        Provenance::default(),
        Vec::new(),
        None,
        &|| false,
        |_| {},
    );
    study.expect("nobody stops it")
}

#[test]
fn ways_are_as_far_off_as_their_snaps_allow_and_divide_where_that_is_proved() {
    let study = made();
    assert_eq!(study.rows.len(), WAYS.len());
    let row = |name: &str| {
        let found = study.rows.iter().find(|row| row.way == name);
        found.unwrap_or_else(|| panic!("no {name}"))
    };
    for (name, snap) in [("exact .02", 0.02), ("exact .05", 0.05), ("exact .1", 0.1)] {
        let row = row(name);
        // At most the snap times the longest edge, which is some two and a half of the mean.
        let most = row.deviation_edges_most;
        assert!(most > 0.3 * snap && most < 2.5 * snap, "{name}: {most}");
        // The theorem: r (1 − r) of its parent's altitude at least.
        assert!(row.altitude_ratio >= snap * (1.0 - snap) * 0.999, "{name}");
    }
    assert!(row("exact 0").deviation_edges_most < 1e-11);
    // What would lose its shape where it is moved stays where it was.
    let [moved, stayed] = ["exact .05 moved", "exact .05"].map(row);
    assert!(moved.deviation_edges < 1e-11, "{}", moved.deviation_edges);
    assert!(moved.deviation_edges_most <= stayed.deviation_edges_most);
    assert!((row("exact 0").length_ratio - 1.0).abs() < 1e-9);
    for name in [
        "partition",
        "exact 0",
        "exact .05",
        "exact .2",
        "exact .05 moved",
    ] {
        assert_eq!(row(name).divided, study.cuts, "{name}");
    }
    let uniform = row("uniform");
    assert!(uniform.divided < study.cuts && uniform.inserted == 0.0 && uniform.length_ratio > 1.1);
    // A cut that inserts nothing leaves the faces as they were, and one that snaps less leaves thinner ones.
    assert_eq!(row("partition").altitude_ratio, 1.0);
    let steps = ["exact .2", "exact .05", "exact 0"].map(|name| row(name).step_ratio);
    assert!(steps.is_sorted_by(|a, b| a > b), "{steps:?}");
    assert!(row("partition").step_ratio > 0.5 && row("partition").step_ratio <= 1.0 + 1e-6);
}

#[test]
fn the_same_options_give_the_same_study() {
    let studies = [made(), made()];
    let [table, again] = studies.each_ref().map(csv);
    assert_eq!(table, again);
    assert_eq!(table.lines().count(), 1 + WAYS.len());
    let columns = |line: &str| line.split(',').count();
    assert!(table.lines().all(|line| columns(line) == 17), "{table}");
    let chart = svg(&studies[0]).expect("a chart");
    assert!(chart.contains("no times were taken") && chart.contains("exact .05 moved"));
    assert!(summary(&studies[0]).contains("6 cuts of 1152 faces"));
}

#[test]
fn times_are_of_each_face_by_the_clock_that_is_given() {
    let calls = AtomicUsize::new(0);
    // Each look at it is a microsecond later.
    let clock = || Duration::from_micros(calls.fetch_add(1, Ordering::Relaxed) as u64);
    let one = Options {
        threads: NonZero::<usize>::MIN,
        ..options()
    };
    let study = study(
        &one,
        Provenance::default(),
        Vec::new(),
        Some(&clock),
        &|| false,
        |_| {},
    );
    for row in study.expect("nobody stops it").rows {
        assert!((row.ns_per_face.expect("a time") - 1000.0 / 1152.0).abs() < 1e-9);
    }
}

#[test]
fn it_ends_where_it_is_told_to() {
    let asked = AtomicUsize::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) > 4;
    let made = study(
        &options(),
        Provenance::default(),
        Vec::new(),
        None,
        &stop,
        |_| {},
    );
    assert!(made.is_none());
    // Once for the sheet, and once for each cut.
    assert_eq!(asked.load(Ordering::Relaxed), 1 + 6 * WAYS.len());
}

#[test]
fn an_interrupted_study_has_the_ways_that_were_done_and_names_the_others() {
    let two = Options {
        cells: vec![24, 6],
        ..options()
    };
    let heard = AtomicUsize::new(0);
    // In the middle of the third way.
    let stop = || heard.load(Ordering::SeqCst) > 12;
    let watch = |_: &str| {
        heard.fetch_add(1, Ordering::SeqCst);
    };
    let some = study(&two, Provenance::default(), Vec::new(), None, &stop, watch);
    let (some, whole) = (some.expect("two ways"), made());
    assert_eq!(
        format!("{:?}", some.rows),
        format!("{:?}", &whole.rows[..2])
    );
    let ways = |cells: u32| {
        let name = move |way: &Way| format!("{} on {cells} cells", way.name);
        WAYS.iter().map(name)
    };
    let others = ways(24).skip(2).chain(ways(6)).map(Missing::interrupted);
    assert_eq!(some.missing, others.collect::<Vec<_>>());
    let table = csv(&some);
    assert_eq!(table.lines().count(), 1 + 2 * WAYS.len());
    assert!(table.ends_with("exact .2 moved on 6 cells,,,,,,,,,,,,,,,,\"missing: interrupted\"\n"));
    let columns = |line: &str| line.split(',').count();
    assert!(table.lines().all(|line| columns(line) == 17), "{table}");
    assert!(svg(&some).is_some_and(|chart| chart.contains("MISSING: partition on 24 cells")));
}

const RECORD: &str = "tearmesh-bench cut\n\
commit    abc\n\
CPU       A Processor (R) of two words\n\
\n\
through cut of 50 vertices, 2000 faces; CPU time of 3 rounds\n\
\x20                   ms  least ms  x best rival\n\
\x20 exact, snap 0   4.00      3.00          2.27  in place\n\
\x20 other           8.00      7.00          1.00  5.2.0: slice\n\
\x20 untold          9.00      8.00          0.90  no measures\n\
\n\
\x20                faces  seam  cracks  deviation  in edges    length\n\
\x20 exact, snap 0   2100   543       0    4.4e-16   8.0e-14  1.000000\n\
\x20 other           2100   547       4    2.0e-06    3.6e-4\n\
\n\
40 random through cuts of 20000 faces\n\
\x20 snap  deviation\n\
\x20 0       1.8e-14  (1e-15)\n";

#[test]
fn records_are_read() {
    let found = rivals(RECORD).expect("a record");
    let told = found
        .iter()
        .map(|one| (&*one.name, one.faces, one.ns_per_face, one.deviation_edges));
    assert_eq!(
        told.collect::<Vec<_>>(),
        [
            ("exact, snap 0", 2000, 2000.0, 8.0e-14),
            ("other", 2000, 4000.0, 3.6e-4)
        ]
    );
    assert_eq!(found[0].processor, "A Processor (R) of two words");
    for text in ["", "through cut of 5 faces", "CPU x\n  a  1\n"] {
        assert_eq!(rivals(text), Err(NoRecord));
    }
}

//! Implementations against each other and against splits by hand, and times by a clock of our own.

use std::sync::atomic::{AtomicU64, Ordering};

use tearmesh::VertexId;
use tearmesh::geometry::{Plane, Vector};
use tearmesh_cloth::statistics::Random;

use super::implementations::SCAN;
use super::*;
use crate::experiment::{Chart, Provenance, conduct, read_table, table, workers};
use crate::plot::Layer;

/// The rows of a rip, by a clock that goes on by a microsecond more each time it is read.
fn measured(fig7: &Fig7) -> Vec<Row> {
    let calls = AtomicU64::new(0);
    let clock = || {
        let calls = calls.fetch_add(1, Ordering::Relaxed);
        Duration::from_micros(calls * calls)
    };
    let bounds = Bounds {
        clock: Some(&clock),
        stop: &|| false,
    };
    conduct(fig7, workers(), &bounds, |_| {}).0
}

#[test]
fn figure_has_an_interval_for_each_patch_and_survives_a_file() {
    let fig7 = Fig7 { cells: vec![4, 6] };
    let rows = measured(&fig7);
    assert_eq!(rows.len(), 2 * 3 * ROUNDS);
    for row in &rows {
        assert!(row.splits > Some(0), "{row:?}");
        assert_eq!(row.faces, Some(2 * (row.cells * row.cells) as usize));
    }
    let text = table(&rows).expect("a table");
    let read: Vec<Row> = read_table(&text).expect("the same table");
    assert_eq!(read, rows);
    let [figure, again] = [&rows, &read].map(|rows| fig7.figure(rows, &Provenance::default()));
    assert_eq!(crate::plot::svg(&figure), crate::plot::svg(&again));
    assert!(!crate::plot::svg(&figure).contains("NaN"));
    // Of one patch, a row of two implementations.
    let two = [ROUNDS - 1, 3 * ROUNDS - 1].map(|i| rows[i].clone());
    let two = fig7.figure(&two, &Provenance::default());
    let is_mark = |layer: &&Layer| matches!(layer, Layer::Mark(..));
    let marks =
        |figure: &crate::plot::Figure| figure.panels[0].layers.iter().filter(is_mark).count();
    assert_eq!([&two, &figure].map(marks), [2, 6]);
    assert!(two.title.contains("at 32 faces"), "{}", two.title);
}

#[test]
fn an_interrupted_table_has_a_row_for_each_patch() {
    let steps = AtomicU64::new(0);
    let stop = || steps.fetch_add(1, Ordering::SeqCst) >= 20;
    let bounds = Bounds {
        clock: None,
        stop: &stop,
    };
    let fig7 = Fig7 { cells: vec![4, 5] };
    let (rows, done) = conduct(&fig7, workers(), &bounds, |_| {});
    assert_eq!(done, 0);
    let undone = |cells: u32| Row {
        cells,
        ..Row::default()
    };
    assert_eq!(rows, [4, 5].map(undone));
    assert!(rows.iter().all(|row| row.status == Status::Interrupted));
    let figure = fig7.figure(&rows, &Provenance::default());
    assert!(!crate::plot::svg(&figure).contains("NaN"));
}

/// An implementation that moves its clock on by some microseconds.
struct Slow {
    clock: &'static AtomicU64,
    micros: u64,
}

impl Implementation for Slow {
    fn split(&mut self, _: &Split, _: &[Point]) {
        self.clock.fetch_add(self.micros, Ordering::Relaxed);
    }

    fn indices(&self) -> &[u32] {
        &[]
    }
}

/// Sums by hand: two rounds, in which a split takes 3 and 5 µs beside a reading of the clock of 1 µs.
#[test]
fn times_are_those_beyond_the_overhead_of_the_clock() {
    static CLOCK: AtomicU64 = AtomicU64::new(0);
    let clock = || Duration::from_micros(CLOCK.fetch_add(1, Ordering::Relaxed));
    let bounds = Bounds {
        clock: Some(&clock),
        stop: &|| false,
    };
    let trial = |(name, micros)| Trial {
        name,
        implementation: Box::new(Slow {
            clock: &CLOCK,
            micros,
        }),
        time: Duration::ZERO,
    };
    let mut trials = [(IDLE, 0), (SCAN, 3), (IDLE, 0), (SCAN, 5)].map(trial);
    let split = Split {
        vertex: VertexId::new(0).expect("a number"),
        plane: Plane::new(Point::origin(), Vector::x()).expect("a plane"),
    };
    for splits in [2, 1, 0, 2] {
        measure(&mut trials, &vec![split; splits], &[], &bounds);
    }
    let rows = rows(&trials, &Row::default());
    let micros = rows
        .iter()
        .map(|row| (row.round, (1e6 * row.sum_s.expect("a time")).round()));
    assert_eq!(
        micros.collect::<Vec<_>>(),
        [(Some(0), 15.0), (Some(1), 25.0)]
    );
}

/// Splits at random places by random planes, until most vertices have one face: after each, all
/// implementations have the same triangles.
#[test]
fn all_implementations_agree_on_random_splits() {
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let (mesh, positions) = shapes::grid(5, 5);
        let mut places = positions.as_slice().to_vec();
        let mut all = IMPLEMENTATIONS[1..].iter().map(|(_, new)| new(&mesh));
        let mut all: [Box<dyn Implementation>; 3] =
            std::array::from_fn(|_| all.next().expect("three of them"));
        for _ in 0..600 {
            let v = random.below(places.len());
            let normal = Vector::from_fn(|_, _| random.next() - 0.5);
            let split = Split {
                vertex: VertexId::new(v).expect("a number"),
                plane: Plane::new(places[v], normal).expect("a plane"),
            };
            for one in &mut all {
                one.split(&split, &places);
            }
            let [first, second, third] = all.each_ref().map(|one| one.indices());
            assert_eq!(first, second, "seed {seed}");
            assert_eq!(first, third, "seed {seed}");
            if first.iter().any(|v| *v as usize == places.len()) {
                places.push(places[v]);
            }
        }
        assert!(places.len() > 36 + 50, "seed {seed}: {}", places.len());
    }
}

/// A vertex all of whose faces are on one side, or that has one face, is not split.
#[test]
fn no_implementation_splits_what_has_no_face_on_one_side() {
    let mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]]).expect("a mesh");
    let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let places = places.map(|[x, y]| Point::new(x, y, 0.0));
    let cases = [
        (0, Vector::new(1.0, 1.0, 0.0), 3),
        (1, Vector::new(0.0, -1.0, 0.0), 3),
        (1, Vector::new(-1.0, -1.0, 0.0), 4),
    ];
    for (v, normal, last) in cases {
        let split = Split {
            vertex: VertexId::new(v).expect("a number"),
            plane: Plane::new(places[v], normal).expect("a plane"),
        };
        for (name, new) in &IMPLEMENTATIONS[1..] {
            let mut implementation = new(&mesh);
            implementation.split(&split, &places);
            let most = implementation.indices().iter().max().copied();
            assert_eq!(most, Some(last), "{name} at {v}");
        }
    }
}

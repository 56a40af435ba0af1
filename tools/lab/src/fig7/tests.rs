//! Implementations against each other and against splits by hand, and times by a clock of our own.

use std::sync::atomic::{AtomicU64, Ordering};

use tearmesh::VertexId;
use tearmesh::geometry::{Plane, Vector};

use super::implementations::SCAN;
use super::*;
use crate::statistics::Random;

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

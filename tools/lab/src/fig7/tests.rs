//! Times by a clock of our own. (Each run of the experiment holds all implementations against the simulation.)

use std::sync::atomic::{AtomicU64, Ordering};

use tearmesh::geometry::Vector;

use super::implementations::SCAN;
use super::*;

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

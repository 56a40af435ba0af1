//! The ways to split against each other and against what was planted in them, and the times that are made
//! of a clock.

use std::cell::Cell;
use std::rc::Rc;
use std::time::Duration;

use tearmesh::geometry::{Plane, Vector};
use tearmesh::{Mesh, Point, VertexId, shapes};
use tearmesh_cloth::statistics::Random;

use super::way::Way;
use super::*;

/// A clock that goes a microsecond ahead each time it is looked at.
fn ticking() -> impl Fn() -> Duration {
    let ticks = Cell::new(0);
    move || {
        ticks.set(ticks.get() + 1);
        Duration::from_micros(ticks.get())
    }
}

#[test]
fn all_ways_split_as_the_simulation_does() {
    let study = study(&[6, 8], 2, Provenance::default(), &ticking(), |_, _| true);
    let study = study
        .expect("all have the same triangles")
        .expect("nobody stops it");
    for test in &study.tests {
        assert!(test.splits > 0, "{}", test.cells);
        assert!((1..=test.frames).contains(&test.frames_with_splits));
        assert_eq!(test.frames, 180);
        let names: Vec<&str> = test.ways.iter().map(|timed| timed.way).collect();
        assert_eq!(
            names,
            [
                "scan of all triangles",
                "face lists of vertices",
                "half-edge with ghost pairs"
            ]
        );
        for timed in &test.ways {
            // Each looks at the clock as often as who does nothing.
            assert_eq!(timed.sums_s, [0.0; 2]);
            assert_eq!(
                [timed.mean_s, timed.median_s, timed.worst_frame_s],
                [0.0; 3]
            );
        }
    }
    // A scene is played once, and gives the same chart each time.
    let text = csv(&study);
    assert_eq!(text.lines().count(), 1 + 2 * 3 * 2);
    assert!(svg(&study).is_some());
}

#[test]
fn an_interrupted_study_has_the_patches_that_were_done_and_names_the_others() {
    let made = |last: usize| {
        let watch = |patch, part| patch < last || part < 0.5;
        let study = study(&[4, 5, 6], 1, Provenance::default(), &ticking(), watch);
        study.expect("all have the same triangles")
    };
    assert!(made(0).is_none());
    let [some, whole] = [1, 3].map(|last| made(last).expect("a patch"));
    assert_eq!(
        format!("{:?}", some.tests),
        format!("{:?}", &whole.tests[..1])
    );
    let missing = ["5 cells", "6 cells"].map(|name| Missing::interrupted(name.to_owned()));
    assert_eq!(some.missing, missing);
    let table = csv(&some);
    assert!(table.ends_with("6 cells,,,,,,,missing,,,,,,\"interrupted\"\n"));
    let columns = |line: &str| line.split(',').count();
    assert!(table.lines().all(|line| columns(line) == 14), "{table}");
    assert!(svg(&some).is_some_and(|chart| chart.contains("MISSING: 5 cells, 6 cells")));
}

/// A way with a clock of its own: it takes as many microseconds as it is told to.
struct Slow {
    clock: Rc<Cell<u64>>,
    takes: u64,
}

impl Way for Slow {
    fn name(&self) -> &'static str {
        "slow"
    }

    fn split(&mut self, _: VertexId, _: &Plane, _: &[Point]) {
        self.clock.set(self.clock.get() + self.takes);
    }

    fn indices(&self) -> Option<&[u32]> {
        None
    }
}

/// Sums, means, medians and the worst frame, by hand: two rounds, in which a split takes 3 and 5 µs
/// beside a look at the clock of 1 µs.
#[test]
fn times_are_those_of_the_clock_beyond_what_it_takes_to_look_at_it() {
    let now = Rc::new(Cell::new(0));
    let clock = || {
        now.set(now.get() + 1);
        Duration::from_micros(now.get())
    };
    let lane = |takes| Lane {
        way: Box::new(Slow {
            clock: now.clone(),
            takes,
        }),
        sum: Duration::ZERO,
        now: Duration::ZERO,
        most: Duration::ZERO,
    };
    let mut stopwatch = Stopwatch {
        clock: &clock,
        lanes: vec![vec![lane(0), lane(0)], vec![lane(3), lane(5)]],
        frame: None,
        frames_with_splits: 0,
    };
    let plane = Plane::new(Point::origin(), Vector::x()).expect("a plane");
    let vertex = VertexId::new(0).expect("a number");
    let split = wanted::Split { vertex, plane };
    // Two splits in a step of frame 0, one in another step of it, and two in frame 7.
    for (splits, frame) in [(2, 0), (1, 0), (0, 3), (2, 7)] {
        stopwatch.play(&vec![split; splits], &[], frame);
    }
    assert_eq!(stopwatch.frames_with_splits, 2);
    let [slow] = &stopwatch.times()[..] else {
        panic!("one way beside nothing");
    };
    let micros = |seconds: f64| (1e6 * seconds).round();
    assert_eq!(
        slow.sums_s.iter().map(|s| micros(*s)).collect::<Vec<_>>(),
        [15.0, 25.0]
    );
    assert_eq!(micros(slow.mean_s), 20.0);
    assert_eq!(micros(slow.median_s), 20.0);
    assert_eq!(slow.range_s.map(micros), [15.0, 25.0]);
    // Three splits in frame 0, by 3 and 5 µs.
    assert_eq!(micros(slow.worst_frame_s), 12.0);
}

#[test]
fn a_way_that_splits_otherwise_is_noticed() {
    let (mesh, _) = shapes::grid(2, 2);
    let clock = ticking();
    let mut stopwatch = Stopwatch::new(&mesh, 1, &clock);
    assert_eq!(stopwatch.differs_from(mesh.indices()), None);
    let mut other = mesh.indices().to_vec();
    other.swap(0, 1);
    assert_eq!(
        stopwatch.differs_from(&other),
        Some("scan of all triangles")
    );
}

/// Splits at random places by random planes, until most vertices have one face: after each, all ways
/// have the same triangles.
#[test]
fn all_ways_agree_wherever_a_mesh_is_split() {
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let (mesh, positions) = shapes::grid(5, 5);
        let mut places = positions.as_slice().to_vec();
        let makers = way::all();
        let mut ways: Vec<_> = makers[1..].iter().map(|make| make(&mesh)).collect();
        let mut splits = 0;
        for _ in 0..600 {
            let v = (random.next() * places.len() as f64) as usize;
            let normal = Vector::from_fn(|_, _| random.next() - 0.5);
            let plane = Plane::new(places[v], normal).expect("a plane");
            for way in &mut ways {
                way.begin();
                way.split(VertexId::new(v).expect("a number"), &plane, &places);
            }
            let of = |way: &dyn Way| way.indices().map(<[u32]>::to_vec);
            let expected = of(&*ways[0]);
            for way in &ways[1..] {
                assert_eq!(of(&**way), expected, "{}, seed {seed}", way.name());
            }
            let most = expected.iter().flatten().max().copied().unwrap_or(0) as usize;
            if most == places.len() {
                places.push(places[v]);
                splits += 1;
            }
        }
        assert!(splits > 50, "seed {seed}: {splits}");
    }
}

/// A vertex all of whose faces are on one side, or that has one face, is not split by any way.
#[test]
fn no_way_splits_what_has_no_face_on_one_side() {
    let mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]]).expect("a mesh");
    let places =
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| Point::new(x, y, 0.0));
    let vertex = |v: usize| VertexId::new(v).expect("a number");
    let cases = [
        (0, Vector::new(1.0, 1.0, 0.0), 4),
        (1, Vector::new(0.0, -1.0, 0.0), 4),
        (1, Vector::new(-1.0, -1.0, 0.0), 5),
    ];
    for (v, normal, expected) in cases {
        let plane = Plane::new(places[v], normal).expect("a plane");
        for make in way::all().into_iter().skip(1) {
            let mut way = make(&mesh);
            way.begin();
            way.split(vertex(v), &plane, &places);
            let indices = way.indices().expect("triangles");
            let most = indices.iter().max().copied();
            assert_eq!(most, Some(expected - 1), "{} at {v}", way.name());
        }
    }
}

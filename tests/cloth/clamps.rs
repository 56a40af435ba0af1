//! Vertices that a cut inserts between those of one hold: they are held as well, and go where those go.

use std::collections::BTreeSet;

use tearmesh::{CutMethod, Edit, Mix, Point, Vector, VertexId, shapes};
use tearmesh_cloth::scene::{Axis, Frame, HeldVertices, Region, Run, Scene, TimedCut};
use tearmesh_cloth::{Method, Tearing, Threshold};

use crate::parts::scenes::{play, square, staged, top};
use crate::parts::{near, ray, v};
use crate::random::Random;
use crate::support::cases::cases;

/// The upper edge moves off, slit from above between two of its vertices or at one: what is inserted on it goes
/// along, and does not tear out.
#[test]
fn regression_a_slit_leaves_nothing_free_in_a_moving_clamp() {
    let foot = Region::Patch {
        across: [0.0, 1.0],
        along: [0.0, 0.0],
    };
    let (ahead, seconds) = (Vector::new(0.0, 0.4, 0.0), 1.0);
    let led = HeldVertices {
        moves: vec![(0.0, Vector::zeros()), (seconds, ahead)],
        ..HeldVertices::still(top())
    };
    for across in [0.53, 0.5] {
        let mut run = staged(8, |frame| Scene {
            duration_s: 1.2 * seconds,
            holds: vec![led.clone(), HeldVertices::still(foot.clone())],
            cuts: vec![TimedCut {
                at_s: 0.0,
                rays: [ray(across, 2.0), ray(across, 0.5)],
                through: false,
                method: CutMethod::Exact,
            }],
            tearing: Some(Tearing::new(Threshold::Stretch(1.6))),
            ..Scene::hang(frame)
        });
        run.step().expect("a step");
        let points = run.cloth().positions();
        let upper: Vec<VertexId> = run.mesh().vertices().collect();
        let upper = upper.iter().filter(|v| points[v.index()].y > 0.99);
        let upper: Vec<VertexId> = upper.copied().collect();
        // Nine, and the two halves of what was inserted between two of them, or of one of them.
        let expected = if across == 0.5 { 10 } else { 11 };
        assert_eq!(upper.len(), expected);
        let run = play(run);
        for v in upper {
            let is_held = run.cloth().system().is_held(v.index());
            assert!(is_held && run.held(0).contains(&v), "{v} at {across}");
            near(run.cloth().positions()[v.index()].y, 1.0 + ahead.y, 1e-12);
        }
    }
}

/// A hold as this test sees it: by steps, and by the log alone.
struct Expected {
    steps: std::ops::Range<u64>,
    vertices: BTreeSet<VertexId>,
    /// What was inserted between vertices of the hold, and the weights of these.
    inserted: Vec<(VertexId, Vec<(VertexId, f64)>)>,
}

impl Expected {
    fn follow(&mut self, edit: &Edit<'_>, step: u64) {
        match edit {
            Edit::Split(split) if self.vertices.contains(&split.old) => {
                self.vertices.insert(split.new);
                let of_old = |(v, _): &&(VertexId, _)| *v == split.old;
                let copied = self.inserted.iter().find(of_old).cloned();
                let copied = copied.map(|(_, weights)| (split.new, weights));
                self.inserted.extend(copied);
            }
            Edit::Insert(insert) if self.steps.contains(&step) => {
                for point in insert.points {
                    let weights = weights(point.at);
                    if weights.iter().all(|(v, _)| self.vertices.contains(v)) {
                        self.vertices.insert(point.vertex);
                        self.inserted.push((point.vertex, weights));
                    }
                }
            }
            _ => {}
        }
    }
}

/// The vertices that another is between, with their weights.
fn weights(at: Mix<VertexId>) -> Vec<(VertexId, f64)> {
    match at {
        Mix::Copy(v) => vec![(v, 1.0)],
        Mix::Between { ends: [a, b], t } => vec![(a, 1.0 - t), (b, t)],
        Mix::Weighted { of, weights } => of.into_iter().zip(weights).collect(),
        _ => unreachable!("there is no other mix"),
    }
}

/// The length of a step, in seconds: a fraction that divides no time but its own multiples.
const STEP_S: f64 = 1.0 / 128.0;

/// A time of a whole number of steps.
fn some_step(random: &mut Random, most: usize) -> u64 {
    random.below(most) as u64
}

/// Some vertices of a grid of 6 × 5: a row, a column, a corner of it, or any.
fn some_vertices(random: &mut Random) -> BTreeSet<VertexId> {
    let (kind, row, column) = (random.below(4), random.below(5), random.below(6));
    let is_in = |i: usize, random: &mut Random| match kind {
        0 => i / 6 == row,
        1 => i % 6 == column,
        2 => i / 6 >= row && i % 6 >= column,
        _ => random.below(2) == 0,
    };
    let mut all: BTreeSet<_> = (0..30).filter(|&i| is_in(i, random)).map(v).collect();
    all.insert(v(6 * row + column));
    all
}

fn some_hold(random: &mut Random) -> (HeldVertices, Expected) {
    let begins = some_step(random, 10) * some_step(random, 2);
    let ends = begins + 1 + some_step(random, 30);
    let is_for_ever = random.below(2) == 0;
    let vertices = some_vertices(random);
    let mut some = || Vector::from_fn(|_, _| 0.4 * (random.next() - 0.5));
    let way = [some(), some(), some()];
    let times = [0, 5, 20].map(|later| (begins + later) as f64 * STEP_S);
    let moves: Vec<_> = times.into_iter().zip(way).collect();
    let turn = [some(), some(), some()].map(|axis| axis * 10.0);
    let turns: Vec<_> = times.into_iter().zip(turn).collect();
    let about = Point::from(some());
    let named = Region::Vertices(vertices.iter().copied().collect());
    let hold = HeldVertices {
        from_s: begins as f64 * STEP_S,
        until_s: (!is_for_ever).then_some(ends as f64 * STEP_S),
        moves: moves[..3 * random.below(2)].to_vec(),
        turns: turns[..3 * (random.below(3) / 2)].to_vec(),
        about,
        ..HeldVertices::still(named)
    };
    let expected = Expected {
        steps: begins..if is_for_ever { u64::MAX } else { ends },
        vertices,
        inserted: Vec::new(),
    };
    (hold, expected)
}

/// A scene with one to three holds and cuts, and what to expect of its holds.
fn some_run(random: &mut Random) -> (Run, Vec<Expected>) {
    let (mesh, positions) = shapes::grid(5, 4);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let holds = (0..1 + random.below(3)).map(|_| some_hold(random));
    let (holds, expected): (Vec<_>, Vec<_>) = holds.unzip();
    let mut steps: Vec<u64> = (0..1 + random.below(3))
        .map(|_| some_step(random, 25))
        .collect();
    steps.sort_unstable();
    let cuts = steps.into_iter().map(|step| {
        let [a, b, c, d] = [(); 4].map(|()| 1.4 * random.next() - 0.2);
        TimedCut {
            at_s: step as f64 * STEP_S,
            rays: [ray(a, b), ray(c, d)],
            through: random.below(3) == 0,
            method: CutMethod::Exact,
        }
    });
    let cuts = cuts.collect();
    let ratio = 1.2 + random.next();
    let scene = Scene {
        cuts,
        duration_s: 40.0 * STEP_S,
        solver: Method::xpbd(),
        step_s: Some(STEP_S),
        holds,
        tearing: (random.below(2) == 0).then(|| Tearing::new(Threshold::Stretch(ratio))),
        ..Scene::fall(Axis::Y)
    };
    let run = Run::new(mesh, &positions, scene, &frame).expect("a scene");
    (run, expected)
}

/// Whatever holds hold and whenever they begin and end: after each step just what they have is held, and what
/// was inserted is between the vertices that it was inserted between, wherever their hold, or another one that
/// took some of them later, leads them.
#[test]
fn what_is_inserted_within_a_hold_is_held_and_stays_between_its_ends() {
    let mut compared = 0;
    for seed in 0..cases() / 10 {
        let (mut run, mut expected) = some_run(&mut Random(seed));
        for step in 0..40 {
            let is_done = run.step().is_ok();
            for edit in run.edits() {
                expected
                    .iter_mut()
                    .for_each(|hold| hold.follow(&edit, step));
            }
            if !is_done {
                break;
            }
            let (mut held, points) = (BTreeSet::new(), run.cloth().positions());
            for (number, hold) in (0..).zip(&expected) {
                let is_now = hold.steps.contains(&step);
                let own: BTreeSet<_> = run.held(number).iter().copied().collect();
                let none = BTreeSet::new();
                let vertices = if is_now { &hold.vertices } else { &none };
                assert_eq!(&own, vertices, "{seed}, step {step}, hold {number}");
                held.extend(own);
                for (vertex, weights) in hold.inserted.iter().filter(|_| is_now) {
                    let ends = weights
                        .iter()
                        .map(|&(v, part)| points[v.index()].coords * part);
                    let off = points[vertex.index()] - Point::from(ends.sum::<Vector>());
                    assert!(off.norm() < 1e-12, "{seed}, step {step}: {vertex} by {off}");
                    compared += 1;
                }
            }
            let system = run.cloth().system();
            let all = run.mesh().vertices();
            let found: BTreeSet<_> = all.filter(|v| system.is_held(v.index())).collect();
            assert_eq!(found, held, "{seed}, step {step}");
        }
    }
    assert!(compared > 100 * cases() / 10, "{compared}");
}

/// Between a vertex of one hold and one of another nothing is held.
#[test]
fn what_is_inserted_between_two_holds_is_free() {
    let (mesh, _) = square(1);
    let [one, other] = [[0, 2], [1, 3]].map(|of: [usize; 2]| {
        let vertices = of.map(v).to_vec();
        HeldVertices::still(Region::Vertices(vertices))
    });
    let mut run = staged(1, |frame| Scene {
        duration_s: 0.1,
        holds: vec![one.clone(), other.clone()],
        cuts: vec![TimedCut {
            at_s: 0.0,
            rays: [ray(0.4, 2.0), ray(0.4, -1.0)],
            through: true,
            method: CutMethod::Exact,
        }],
        tearing: None,
        ..Scene::fall(frame.up)
    });
    run.step().expect("a step");
    let inserted = mesh.vertex_count()..run.mesh().vertex_count();
    assert_eq!(inserted.len(), 6, "two halves of three");
    let system = run.cloth().system();
    assert!(inserted.into_iter().all(|v| !system.is_held(v)));
}

//! The oracle of the straight cut, put to the test: it accepts what a second, naive
//! implementation makes of every kind of surface, and finds every bug that is put into it.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;
use std::sync::LazyLock;

use tearmesh::{Point, Scissor, shapes};

use crate::oracle::naive_cut;
use crate::oracle::spoil::{BUGS, Bug, spoil};
use crate::oracle::straight::{Check, Cut, Facts, Fault, Surface, is_generic, judge};
use crate::random::Random;
use crate::surfaces::{built, surface, surfaces};
use crate::work::{Rays, down, scissor};

/// Generic cuts that each surface gets.
const CUTS: usize = 57;

/// Two rays that pass a random vertex at a random distance: parallel ones, anti-parallel ones,
/// or two from one eye.
fn random_rays(before: &Surface, random: &mut Random) -> Rays {
    let mut random = || random.next();
    let pick = before.points[(random() * before.points.len() as f64) as usize];
    let edge = before.mean_edge();
    let turn = TAU * random();
    let half = edge * [0.1, 0.8, 2.5, 6.0][(4.0 * random()) as usize];
    let (x, y) = (turn.cos(), turn.sin());
    let mut target = |side: f64| {
        let along = side * half * (0.5 + random());
        let [mut a, mut b, mut c] = [0.0; 3].map(|_| 0.1 * edge * (random() - 0.5));
        [a, b, c] = [a + along * x, b + along * y, c + 0.3 * along];
        [pick[0] + a, pick[1] + b, pick[2] + c]
    };
    let (p, q) = (target(-1.0), target(1.0));
    let way = [random() - 0.5, random() - 0.5, -1.0];
    let origin = |p: [f64; 3], far: f64| [0, 1, 2].map(|i| p[i] - far * way[i]);
    match (4.0 * random()) as usize {
        0 => {
            let eye = origin(pick, 3.0);
            [p, q].map(|p| (eye, [0, 1, 2].map(|i| p[i] - eye[i])))
        }
        1 => [
            (origin(p, 4.0), way),
            (origin(q, -3.0), way.map(|x: f64| -x)),
        ],
        _ => [(origin(p, 3.0), way), (origin(q, 4.0), way)],
    }
}

/// A surface before and after a cut.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) before: Surface,
    rays: Rays,
    pub(crate) cut: Cut,
    after: Surface,
    /// What the oracle says of it.
    pub(crate) facts: Facts,
}

impl Case {
    pub(crate) fn scissor(&self) -> Scissor {
        scissor(self.rays).with_through(self.cut.sides.is_empty())
    }
}

/// Rays of a generic cut that meets a surface, what the naive implementation makes of it; one cut in
/// four goes through.
fn random_case(before: &Surface, random: &mut Random) -> (Rays, Cut, Surface) {
    loop {
        let rays = random_rays(before, random);
        let mut cut = Cut::between(rays);
        if random.next() < 0.25 {
            cut = cut.through();
        }
        if is_generic(before, &cut) {
            let after = naive_cut::cut(before, &cut);
            if after != *before {
                return (rays, cut, after);
            }
        }
    }
}

/// The scissor of a generic cut that meets a surface, without a snap, and the same for the oracle.
pub(crate) fn random_generic_cut(before: &Surface, random: &mut Random) -> (Scissor, Cut) {
    let (rays, cut, _) = random_case(before, random);
    let scissor = scissor(rays).with_through(cut.sides.is_empty());
    (scissor.with_snap(0.0), cut)
}

/// A number of generic cuts of each surface, made by the naive implementation.
pub(crate) fn cases() -> &'static [Case] {
    static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
        let mut random = Random(5);
        let mut cases = Vec::new();
        for (name, before) in surfaces() {
            for _ in 0..CUTS {
                let (rays, cut, after) = random_case(&before, &mut random);
                cases.push(Case {
                    facts: judged(&before, &cut, &after, name),
                    before: before.clone(),
                    name,
                    rays,
                    cut,
                    after,
                });
            }
        }
        cases
    });
    &CASES
}

/// What the oracle says of a cut, which is right.
pub(crate) fn judged(before: &Surface, cut: &Cut, after: &Surface, what: &str) -> Facts {
    let facts = judge(before, cut, after);
    facts.unwrap_or_else(|faults| panic!("{what}: {}", said(&faults)))
}

pub(crate) fn said(faults: &[Fault]) -> String {
    let faults: Vec<_> = faults.iter().take(5).map(Fault::to_string).collect();
    faults.join("; ")
}

#[test]
fn naive_cuts_of_all_kinds_are_accepted_and_are_meshes() {
    let some = |what: fn(&Facts) -> bool| cases().iter().any(|case| what(&case.facts));
    assert!(some(|facts| facts.tips == 0 && facts.boundary_ends == 0));
    assert!(some(|facts| facts.tips == 1 && facts.boundary_ends == 1));
    assert!(some(|facts| facts.tips == 2 && facts.boundary_ends == 0));
    assert!(some(|facts| facts.boundary_ends > 2));
    assert!(some(|facts| facts.chains > 1));
    assert!(some(|facts| facts.pieces > 2));
    for case in cases() {
        let (mesh, _) = built(&case.after);
        assert_eq!(mesh.check(), []);
        assert_eq!(mesh.components().count(), case.facts.pieces);
    }
}

#[test]
fn every_bug_of_a_straight_cut_is_found() {
    let mut random = Random(3);
    let mut random = || random.next();
    let mut tries = BTreeMap::<Bug, usize>::new();
    let mut checks = BTreeSet::<Check>::new();
    for case in cases().iter().step_by(2) {
        for bug in BUGS {
            let spoilt = spoil(&case.before, &case.cut, &case.after, bug, &mut random);
            let Some(spoilt) = spoilt else { continue };
            *tries.entry(bug).or_default() += 1;
            match judge(&case.before, &case.cut, &spoilt) {
                Ok(facts) => panic!("{bug:?} in {} is not found: {facts:?}", case.name),
                Err(faults) => checks.extend(faults.iter().map(|fault| fault.check)),
            }
        }
    }
    let is_tried = |bug| tries.get(bug) >= Some(&80);
    assert!(BUGS.iter().all(is_tried), "{tries:?}");
    // A check that never fails is none.
    assert_eq!(checks.len(), 14, "only {checks:?} found anything");
}

#[test]
fn only_cuts_away_from_every_special_case_are_generic() {
    let grid = surface(&shapes::grid(4, 4));
    let is_generic = |cut| is_generic(&grid, &cut);
    let between = |a, b| Cut::between([down(a), down(b)]);
    assert!(is_generic(between([0.3, 0.2], [0.4, 0.85])));
    for (why, a, b) in [
        ("a vertex on the plane", [0.25, 0.2], [0.25, 0.9]),
        ("almost", [0.25, 0.2], [0.25 + 1e-8, 0.9]),
        ("a tip on an edge", [0.3, 0.25], [0.3, 0.9]),
        ("both tips in one place", [0.3, 0.2], [0.3, 0.2 + 1e-8]),
    ] {
        assert!(!is_generic(between(a, b)), "{why}");
    }
    // Vertices on the plane that no face joins with the strip are no obstacle.
    let diagonal = between([-0.6, -0.6], [-0.7, -0.7]);
    assert!(is_generic(diagonal.clone()));
    assert!(!is_generic(diagonal.through()));
}

#[test]
fn oracle_and_scissor_read_rays_alike() {
    for case in cases() {
        let (scissor, cut) = (case.scissor(), Cut::between(case.rays));
        let [one, other] = scissor.sides().expect("there are rays");
        let planes = [scissor.plane(), one, other];
        for (flat, plane) in [cut.plane, cut.sides[0], cut.sides[1]].iter().zip(planes) {
            for p in &case.before.points {
                let apart = flat.distance(*p) - plane.distance(Point::from(*p));
                assert!(apart.abs() < 1e-13, "{:?}: {apart}", case.rays);
            }
        }
    }
}

//! What BDF2 remembers of the last step, and when it begins anew.

use super::matrix::crumpled;
use super::{G, Scene, step};
use crate::parts::cloths::loaded;
use crate::parts::nets::row;
use crate::parts::{gravity, implicit_by_default, near, plane, solved, state, v};
use tearmesh::{Edits, Point, Vector, mend, split};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{
    Abilities, Fabric, Failure, Implicit, Solver, StepError, System, Unstable, Verlet,
};

fn bdf2() -> Implicit {
    implicit_by_default(Method::Bdf2)
}

/// A sheet in motion, with drag and gravity.
fn scene(seed: u64) -> Scene {
    let mut scene = crumpled(3, seed);
    scene.held[0] = true;
    scene.v[0] = Vector::zeros();
    scene.gravity = Vector::new(0.0, 0.0, -G);
    scene.drag = 1.0;
    scene
}

/// Takes a step, and returns whether it went on from the last.
fn goes_on(system: &mut System, solver: &mut Implicit, dt_s: f64) -> bool {
    let report = step(system, solver, dt_s).expect("a step");
    report.first_order_parts == 0
}

/// The state after some steps by a solver of its own, each of a given length in seconds.
fn alone(system: &System, steps: &[f64]) -> (Vec<Point>, Vec<Vector>) {
    let (mut system, mut solver) = (system.clone(), bdf2());
    for &dt_s in steps {
        step(&mut system, &mut solver, dt_s).expect("a step");
    }
    state(&system)
}

/// A state that the last step did not lead to, of another system or of this one at another time.
#[test]
fn a_system_not_left_by_the_last_step_has_no_history() {
    let mut solver = bdf2();
    let mut systems = [scene(1).system(), scene(2).system()];
    for system in &mut systems {
        let expected = alone(system, &[0.01, 0.008]);
        assert!(!goes_on(system, &mut solver, 0.01));
        assert!(goes_on(system, &mut solver, 0.008));
        assert_eq!(state(system), expected);
    }
    // A clone in the same state goes on as the system would have.
    let mut clone = systems[1].clone();
    let mut other = solver.clone();
    assert!(goes_on(&mut systems[1], &mut solver, 0.01));
    step(&mut clone, &mut other, 0.01).expect("a step");
    assert_eq!(state(&clone), state(&systems[1]));
    // One that stands where the system stood a step ago does not.
    let expected = alone(&systems[0], &[0.01]);
    assert!(!goes_on(&mut systems[0], &mut solver, 0.01));
    assert_eq!(state(&systems[0]), expected);
}

/// Steps that grow too fast would make the method unstable.
#[test]
fn a_step_that_is_far_longer_than_the_last_begins_again() {
    let mut system = scene(6).system();
    let mut solver = bdf2();
    let steps = [0.002, 0.0048, 0.0117, 0.001];
    let found = steps.map(|dt_s| goes_on(&mut system, &mut solver, dt_s));
    assert_eq!(found, [false, true, false, true]);
    assert_eq!(solved(&solver, &system).parts, 4);
}

/// BDF2 in two parts a step, of which the second can be made to fail.
#[derive(Debug)]
struct Halves {
    bdf2: Implicit,
    calls: u32,
    fails_at: u32,
}

impl Solver for Halves {
    fn abilities(&self) -> Abilities {
        // So little that each step is divided.
        Abilities::of_forces(Some(1e-6), 1.0)
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        self.calls += 1;
        self.bdf2.advance(system, dt_s)?;
        if self.calls == self.fails_at {
            return Err(Failure::BlowUp);
        }
        Ok(())
    }
}

/// What was undone is no history, whichever part of a step failed, and whoever steps next.
#[test]
fn substeps_of_a_step_that_was_refused_are_no_history() {
    let mut system = row(1, 1.0, 1.0, 1.0, Vector::z() * -1.2);
    system.when_unstable(Unstable::Substep);
    // ω is 1.
    let dt_s = 1.9e-6;
    for fails_at in [3, 4] {
        for verlet_between in [false, true] {
            let mut system = system.clone();
            let mut halves = Halves {
                bdf2: bdf2(),
                calls: 0,
                fails_at,
            };
            assert_eq!(system.step(&mut halves, dt_s), Ok(2));
            let refused = system.step(&mut halves, dt_s);
            assert!(matches!(refused, Err(StepError::BlowUp { .. })));
            if verlet_between {
                system.step(&mut Verlet, dt_s).expect("a step");
            }
            system.when_unstable(Unstable::Allow);
            let expected = alone(&system, &[0.1, 0.1]);
            for _ in 0..2 {
                step(&mut system, &mut halves.bdf2, 0.1).expect("a step");
            }
            assert_eq!(state(&system), expected, "{fails_at} {verlet_between}");
        }
    }
}

/// What pushes some particles between two steps leaves the others' history, and theirs is that of
/// their accelerations: each flies on as it would have with the push from the start.
#[test]
fn pushed_particles_go_on_with_their_acceleration() {
    let mut scene = Scene::particles([[0.0; 3], [1.0, 0.0, 0.0]], 1.0);
    scene.gravity = Vector::new(0.0, 0.0, -G);
    let (mut system, mut solver) = (scene.system(), bdf2());
    let push = Vector::new(-1.0, 0.5, 2.0);
    for turn in 0..8 {
        if turn == 4 {
            let (x, v) = system.state_mut();
            x[1] += Vector::y();
            v[1] += push;
        }
        assert_eq!(goes_on(&mut system, &mut solver, 0.01), turn > 0);
    }
    let (x, v) = (system.positions(), system.velocities());
    let flown = x[1] - x[0] - Vector::x() - Vector::y() - push * 0.04;
    near(flown.norm(), 0.0, 1e-14);
    near((v[1] - v[0] - push).norm(), 0.0, 1e-14);
}

#[test]
fn particles_that_came_and_went_have_no_history() {
    let (mut mesh, mut cloth) = loaded(3, Fabric::new(50.0), gravity(0.0));
    cloth.system_mut().hold(0);
    let (mut solver, mut edits) = (bdf2(), Edits::new());
    let vertex = v(5);
    let mut copy = None;
    for turn in 0..8 {
        if turn == 3 {
            let across = plane(cloth.positions()[5], Vector::x());
            let split = split::by_plane(&mut mesh, vertex, &across, cloth.positions(), &mut edits);
            copy = Some(split.expect("faces on both sides").new);
        } else if turn == 6 {
            let copy = copy.expect("a split");
            mend::merge(&mut mesh, vertex, copy, [1.0, 1.0], &mut edits).expect("a merge");
        }
        edits.replay(&mut cloth);
        let goes_on = goes_on(cloth.system_mut(), &mut solver, 0.01);
        assert_eq!(goes_on, ![0, 3, 6].contains(&turn), "{turn}");
    }
}

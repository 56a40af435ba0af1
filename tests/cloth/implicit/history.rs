//! What BDF2 remembers of the last step goes with the system and the moment that it is of.

use super::matrix::crumpled;
use super::{G, Scene, norm, step};
use tearmesh::{Edits, Masses, Plane, Point, Vector, VertexId, mend, shapes, split};
use tearmesh_cloth::implicit::{Method, Settings, Tolerance};
use tearmesh_cloth::{
    Abilities, Cloth, Fabric, Failure, Implicit, Loads, Solver, StepError, System, Unstable, Verlet,
};

fn bdf2() -> Implicit {
    Implicit::new(Settings {
        method: Method::Bdf2,
        ..Settings::default()
    })
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

fn state(system: &System) -> (Vec<Point>, Vec<Vector>) {
    (system.positions().to_vec(), system.velocities().to_vec())
}

/// The state after some steps by a solver of its own, each of a given length in seconds.
fn alone(system: &System, steps: &[f64]) -> (Vec<Point>, Vec<Vector>) {
    let (mut system, mut solver) = (system.clone(), bdf2());
    for &dt_s in steps {
        step(&mut system, &mut solver, dt_s).expect("a step");
    }
    state(&system)
}

#[test]
fn systems_of_one_size_stepped_in_turn_by_one_solver_equal_those_with_solvers_of_their_own() {
    let steps = [0.01, 0.008, 0.012, 0.01, 0.01, 0.01];
    let mut systems = [scene(1).system(), scene(2).system(), scene(1).system()];
    let expected = systems.each_ref().map(|system| alone(system, &steps));
    let mut solver = bdf2();
    for &dt_s in &steps {
        for system in &mut systems {
            step(system, &mut solver, dt_s).expect("a step");
        }
    }
    assert_eq!(systems.each_ref().map(state), expected);
    // One after the other.
    let mut solver = bdf2();
    for (seed, expected) in [1, 2].into_iter().zip(&expected) {
        let mut system = scene(seed).system();
        for &dt_s in &steps {
            step(&mut system, &mut solver, dt_s).expect("a step");
        }
        assert_eq!(state(&system), *expected, "{seed}");
    }
}

/// Also where one of them is torn: sums are in the order that it would have alone.
#[test]
fn clones_stepped_in_turn_by_one_solver_equal_those_with_solvers_of_their_own() {
    let steps = [0.01; 8];
    let mut made = scene(3).system();
    for &dt_s in &steps[..3] {
        step(&mut made, &mut bdf2(), dt_s).expect("a step");
    }
    let run = |solvers: &mut [Implicit]| {
        let last = solvers.len() - 1;
        let mut systems = [made.clone(), made.clone()];
        for (turn, &dt_s) in steps.iter().enumerate() {
            if turn % 3 == 2 {
                let id = systems[1].stretches().iter().nth(turn).expect("a spring");
                systems[1].cut(id);
                systems[1].stretch([turn, 15], 0.4, 3.0).expect("a spring");
            }
            for (i, system) in systems.iter_mut().enumerate() {
                let report = step(system, &mut solvers[i.min(last)], dt_s).expect("a step");
                assert_eq!(report.method == Method::Bdf2, turn > 0);
            }
        }
        systems.map(|system| state(&system))
    };
    let expected = run(&mut [bdf2(), bdf2()]);
    assert_ne!(expected[0], expected[1]);
    assert_eq!(run(&mut [bdf2()]), expected);
}

/// A solver that comes back to a system that has been elsewhere meanwhile.
#[test]
fn what_another_solver_has_stepped_since_is_no_history() {
    let mut system = scene(4).system();
    system.when_unstable(Unstable::Allow);
    let mut solver = bdf2();
    for _ in 0..3 {
        step(&mut system, &mut solver, 0.01).expect("a step");
    }
    system.step(&mut Verlet::new(), 1e-3).expect("a step");
    let expected = alone(&system, &[0.01, 0.01]);
    let report = step(&mut system, &mut solver, 0.01).expect("a step");
    assert_eq!(report.method, Method::BackwardEuler);
    let report = step(&mut system, &mut solver, 0.01).expect("a step");
    assert_eq!(report.method, Method::Bdf2);
    assert_eq!(state(&system), expected);
}

/// BDF2 in two parts a step, of which the second can be made to fail.
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
    let points = [Point::origin(), Point::new(0.0, 0.0, -1.2)];
    let mut system = System::new(points, vec![1.0; 2]).expect("two particles");
    system.stretch([0, 1], 1.0, 1.0).expect("a spring");
    system.hold(0);
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
            let report = system.step(&mut halves, dt_s).expect("two substeps");
            assert_eq!(report.substeps, 2);
            let refused = system.step(&mut halves, dt_s);
            assert!(matches!(refused, Err(StepError::BlowUp { .. })));
            if verlet_between {
                system.step(&mut Verlet::new(), dt_s).expect("a step");
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

/// What moves all particles alike between two steps moves what is remembered with them.
#[test]
fn a_system_that_is_moved_from_outside_goes_on_as_it_would_have() {
    let exact = Settings {
        tolerance: Tolerance::Fixed(1e-12),
        ..bdf2().settings
    };
    let mut scene = scene(5);
    scene.held[0] = false;
    scene.drag = 0.0;
    let mut systems = [scene.system(), scene.system()];
    let mut solvers = [exact; 2].map(Implicit::new);
    let (by, push) = (Vector::new(0.3, -2.0, 1.0), Vector::new(-1.0, 0.5, 2.0));
    for turn in 0..8 {
        if turn == 4 {
            let (x, v) = systems[1].state_mut();
            x.iter_mut().for_each(|x| *x += by);
            v.iter_mut().for_each(|v| *v += push);
        }
        for (system, solver) in systems.iter_mut().zip(&mut solvers) {
            let report = step(system, solver, 0.01).expect("a step");
            assert_eq!(report.method == Method::Bdf2, turn > 0);
        }
    }
    let [left, moved] = systems.each_ref().map(System::positions);
    let apart: Vec<Vector> = left
        .iter()
        .zip(moved)
        .map(|(x, y)| y - x - by - push * 0.04)
        .collect();
    assert!(norm(&apart) < 1e-9, "{}", norm(&apart));
}

/// Numbers of particles mean others after an edit, even where there are as many.
#[test]
fn particles_that_came_and_went_have_no_history() {
    let (mut mesh, positions) = shapes::grid(3, 3);
    let masses = Masses::area(&mesh, &positions, 0.15).expect("an area");
    let mut cloth = Cloth::new(&mesh, &positions, masses, Fabric::new(50.0)).expect("a cloth");
    let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -G));
    let loads = Loads {
        gravity_m_per_s2,
        ..Loads::default()
    };
    cloth.system_mut().set_loads(loads).expect("loads");
    cloth.system_mut().hold(0);
    let (mut solver, mut edits) = (bdf2(), Edits::new());
    for turn in 0..6 {
        let before = cloth.positions().len();
        if turn == 3 {
            let vertex = VertexId::new(5).expect("an id");
            let plane = Plane::new(cloth.positions()[5], Vector::x()).expect("a plane");
            let split = split::by_plane(&mut mesh, vertex, &plane, cloth.positions(), &mut edits);
            let copy = split.expect("faces on both sides").new;
            edits.replay(&mut cloth);
            mend::merge(&mut mesh, vertex, copy, [1.0, 1.0], &mut edits).expect("a merge");
            edits.replay(&mut cloth);
        }
        assert_eq!(cloth.positions().len(), before);
        cloth.step(&mut solver, 0.01).expect("a step");
        let method = solver.report().expect("a step").method;
        assert_eq!(method == Method::Bdf2, turn != 0 && turn != 3, "{turn}");
    }
}

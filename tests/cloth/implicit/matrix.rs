//! The matrix, its layout, and held particles.

use super::dense::{clamped, jacobian, solve};
use super::{Scene, forces, step};
use crate::parts::cloths::{loaded, split_off};
use crate::parts::woven::weave;
use crate::parts::{implicit, implicit_to, near, run, shake, v};
use crate::random::Random;
use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{Bending, Buckling, Fabric, Implicit, Loads};

/// A sheet with triangles, springs along its rows and bends two apart, crumpled.
pub(super) fn crumpled(n: u32, seed: u64) -> Scene {
    let mut random = Random(seed);
    let mut scene = Scene::sheet(n, 0.01, [20.0, 15.0, 3.0]);
    let l = 1.0 / f64::from(n);
    scene.law = Buckling::new(0.9);
    for row in 0..=n {
        for i in 0..n {
            let a = (row * (n + 1) + i) as usize;
            scene.springs.push(([a, a + 1], l, 5.0));
            if i + 1 < n {
                scene.bends.push(([a, a + 2], 2.0 * l, 2.0));
            }
        }
    }
    for p in &mut scene.x {
        *p += Vector::from_fn(|_, _| 0.3 * l * (random.next() - 0.5));
    }
    for v in &mut scene.v {
        *v = Vector::from_fn(|_, _| random.next() - 0.5);
    }
    scene
}

/// The change of all velocities in a step of backward Euler, by a matrix H of second derivatives:
/// (M (1 + hc) + h² H) Δv = h (f − h H v − c M v) for the free particles. A penalty would be inexact,
/// so each held coordinate adds the row Δv = 0 with a multiplier.
pub(super) fn dense_step(scene: &Scene, hessian: &[Vec<f64>], h: f64) -> Vec<Vector> {
    let forces = forces(&mut scene.system());
    let v: Vec<f64> = scene.v.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
    let n = scene.x.len();
    let held: Vec<usize> = (0..3 * n).filter(|c| scene.held[c / 3]).collect();
    let size = 3 * n + held.len();
    let mut a = vec![vec![0.0; size]; size];
    let mut b = vec![0.0; size];
    for r in 0..3 * n {
        let m = scene.masses[r / 3];
        a[r][r] += m * (1.0 + h * scene.drag);
        b[r] += h * (forces[r / 3][r % 3] - scene.drag * m * v[r]);
        for c in 0..3 * n {
            a[r][c] += h * h * hessian[r][c];
            b[r] -= h * h * hessian[r][c] * v[c];
        }
    }
    for (k, coordinate) in held.into_iter().enumerate() {
        a[3 * n + k][coordinate] = 1.0;
        a[coordinate][3 * n + k] = 1.0;
    }
    let change = solve(&a, b);
    let vectors = change[..3 * n].chunks_exact(3);
    vectors.map(|c| Vector::new(c[0], c[1], c[2])).collect()
}

/// In short steps the matrix is that of all derivatives of the forces, here by differences; where that
/// is indefinite, what is negative is left out, and counted.
#[test]
fn a_step_is_the_dense_solution_where_some_are_held() {
    let mut seen = [0; 2];
    for seed in 0..16 {
        let mut scene = crumpled(3, seed);
        scene.law = scene.law.filter(|_| seed % 4 == 0);
        (scene.held[0], scene.held[5]) = (true, true);
        scene.gravity = Vector::new(0.3, 0.0, -9.81);
        scene.drag = 2.0;
        for h in [0.004, 0.03] {
            let mut system = scene.system();
            let mut solver = implicit(Method::BackwardEuler);
            let report = step(&mut system, &mut solver, h).expect("a step");
            let is_indefinite = report.indefinite > 0;
            if report.parts > 1 || is_indefinite && scene.law.is_some() {
                continue;
            }
            assert_eq!(report.clamped > 0, is_indefinite);
            assert_eq!(report.indefinite, u64::from(is_indefinite));
            seen[usize::from(is_indefinite)] += 1;
            let matrix = match is_indefinite {
                false => jacobian(&scene.system()),
                true => clamped(&scene),
            };
            let change = dense_step(&scene, &matrix, h);
            let (x, moved) = (system.positions(), system.velocities());
            for i in 0..scene.x.len() {
                near((moved[i] - scene.v[i] - change[i]).norm(), 0.0, 1e-7);
                near((x[i] - (scene.x[i] + moved[i] * h)).norm(), 0.0, 1e-15);
            }
            // What is held keeps its velocity, to the bit.
            assert_eq!(moved[0], scene.v[0]);
        }
    }
    assert!(seen[0] >= 6 && seen[1] >= 2, "{seen:?}");
}

/// The order of sums depends on the constraints alone: a solver that has followed tears gives what a
/// new one gives, to the bit.
#[test]
fn a_solver_that_has_followed_tears_steps_as_a_new_one() {
    let fabric = Fabric {
        orthotropic: Some(weave()),
        bend: Some(Bending::Buckling {
            rigidity_n_m: 1e-3,
            law: Buckling::new(0.9).expect("a law"),
        }),
        ..Fabric::new(5.0)
    };
    let (mut mesh, mut cloth) = loaded(6, fabric, Loads::default());
    shake(cloth.system_mut(), 0.05, 0.0, &mut Random(3));
    let mut solver = Implicit::default();
    for turn in 0..6 {
        if turn % 2 == 1 {
            split_off(&mut mesh, &mut cloth, v(10 + 3 * turn), 2);
        }
        let mut other = cloth.clone();
        cloth.step(&mut solver, 0.005).expect("a step");
        other.step(&mut Implicit::default(), 0.005).expect("a step");
        assert_eq!(cloth.positions(), other.positions(), "{turn}");
    }
    // As many springs as before, of which one has other ends.
    let mut system = crumpled(4, 3).system();
    for turn in 0..6 {
        let cut = system.stretches().iter().nth(turn).expect("a spring");
        system.cut(cut);
        let added = system.stretch([turn, 13 + turn], 0.5, 5.0);
        added.expect("a spring");
        let mut other = system.clone();
        step(&mut system, &mut solver, 0.005).expect("a step");
        step(&mut other, &mut Implicit::default(), 0.005).expect("a step");
        assert_eq!(system.positions(), other.positions(), "{turn}");
    }
}

#[test]
fn a_free_piece_keeps_its_momentum_at_any_tolerance() {
    for method in [Method::BackwardEuler, Method::Bdf2] {
        // Three pieces: a sheet that moves, another that is held at one corner, and a particle.
        let mut scene = crumpled(3, 21);
        let mut other = crumpled(2, 22);
        let n = scene.x.len();
        other.x.iter_mut().for_each(|x| x.x += 5.0);
        scene
            .x
            .extend(other.x.into_iter().chain([Point::new(9.0, 0.0, 0.0)]));
        scene.v.extend(other.v.into_iter().chain([Vector::x()]));
        let all = 0..scene.x.len();
        scene.masses = all.clone().map(|i| 0.01 + 0.001 * (i % 7) as f64).collect();
        scene.held = all.map(|i| i == n).collect();
        let triangles = other.triangles.into_iter();
        let moved = triangles.map(|(corners, material, k)| (corners.map(|v| v + n), material, k));
        scene.triangles.extend(moved);
        let momentum = |v: &[Vector]| -> Vector { (0..n).map(|i| v[i] * scene.masses[i]).sum() };
        let mut system = scene.system();
        let start = momentum(system.velocities());
        run(&mut system, implicit_to(method, 1e3), 0.01, 100);
        let (x, v) = (system.positions(), system.velocities());
        near((momentum(v) - start).norm(), 0.0, 1e-15);
        near((v[x.len() - 1] - Vector::x()).norm(), 0.0, 1e-13);
        assert_ne!(x[1], scene.x[1], "something moved");
    }
}

//! The matrix, its layout, held particles, and bytes.

use super::dense::{dense, solve};
use super::{Scene, forces, spring, step};
use crate::random::Random;
use tearmesh::{Edits, Masses, Point, Vector, shapes, split};
use tearmesh_cloth::implicit::{Hessian, Layout, Method, Settings, Tolerance};
use tearmesh_cloth::{Bending, Buckling, Cloth, Fabric, Implicit, System, Weave};

/// A sheet with triangles, springs along its rows and bends two apart, crumpled.
pub(super) fn crumpled(n: u32, seed: u64) -> Scene {
    let mut random = Random(seed);
    let mut scene = Scene::sheet(n, 0.01, [20.0, 15.0, 3.0]);
    let l = 1.0 / f64::from(n);
    scene.law = Buckling::new(0.9);
    for row in 0..=n {
        for i in 0..n {
            let a = (row * (n + 1) + i) as usize;
            scene.springs.push(spring(a, a + 1, l, 5.0));
            if i + 1 < n {
                scene.bends.push(spring(a, a + 2, 2.0 * l, 2.0));
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

/// A layout gives the matrix that a new one gives, and has no more slots in use.
fn is_that_of_a_new_one(layout: &Layout, system: &System) {
    let mut new = Layout::default();
    new.follow(system);
    assert_eq!(layout.pieces(), new.pieces());
    let mut random = Random(9);
    let mut next = || random.next() - 0.5;
    let v: Vec<Vector> = system
        .positions()
        .iter()
        .map(|_| Vector::from_fn(|_, _| next()))
        .collect();
    let [a, b] = [layout, &new].map(|layout| {
        let (mut hessian, mut product) = (Hessian::default(), Vec::new());
        layout.hessian(system, false, &mut hessian);
        hessian.product(layout.pairs(), &v, &mut product);
        product
    });
    let apart: Vec<Vector> = a.iter().zip(&b).map(|(a, b)| a - b).collect();
    assert!(super::norm(&apart) < 1e-14 * super::norm(&a));
    let live = layout.pairs().iter().filter(|p| p[0] != p[1]).count();
    assert_eq!(live, new.pairs().len());
}

#[test]
fn a_layout_that_follows_a_tear_gives_the_matrix_of_a_new_one() {
    let (mut mesh, positions) = shapes::grid(6, 6);
    let masses = Masses::area(&mesh, &positions, 0.2).expect("masses");
    let weave = Weave {
        warp_n_per_m: 20.0,
        weft_n_per_m: 15.0,
        shear_n_per_m: 3.0,
        warp: Vector::x(),
    };
    let fabric = Fabric {
        weave: Some(weave),
        bend: Some(Bending::Buckling {
            flexural_n_m2: 1e-4,
            law: Buckling::new(0.9).expect("a law"),
        }),
        ..Fabric::new(5.0)
    };
    let mut cloth = Cloth::new(&mesh, &positions, masses, fabric).expect("a cloth");
    let mut random = Random(3);
    for x in cloth.system_mut().state_mut().0 {
        *x += Vector::from_fn(|_, _| 0.05 * (random.next() - 0.5));
    }
    let mut layout = Layout::default();
    assert!(layout.follow(cloth.system()) > 0);
    assert_eq!(layout.follow(cloth.system()), 0);
    let mut edits = Edits::new();
    for v in [24, 17, 31] {
        let bends = cloth.system().bends().len();
        let v = mesh.vertices().nth(v).expect("a vertex");
        let faces: Vec<_> = mesh.faces_of(v).take(2).collect();
        split::vertex(&mut mesh, v, &faces, &mut edits).expect("more than two faces");
        edits.replay(&mut cloth);
        edits.clear();
        let system = cloth.system();
        let copy = system.positions().len() - 1;
        let moved = system.stretches().of(copy).count() + system.bends().of(copy).count();
        // Two edges of each face that went to the copy have another end.
        let gone = bends - system.bends().len();
        let expected = moved + gone + 2 * faces.len();
        assert_eq!(
            layout.follow(system),
            expected,
            "only what was torn is touched"
        );
        is_that_of_a_new_one(&layout, system);
    }
}

#[test]
fn a_slot_that_was_freed_is_used_again() {
    let mut system = crumpled(4, 3).system();
    let mut layout = Layout::default();
    layout.follow(&system);
    let cut = system.stretches().iter().nth(3).expect("a spring");
    system.cut(cut);
    assert_eq!(layout.follow(&system), 1);
    is_that_of_a_new_one(&layout, &system);
    let slots = layout.pairs().len();
    for turn in 0..20 {
        let ends = [[0, 13], [1, 17]][turn % 2];
        let id = system.stretch(ends, 1.0, 1.0).expect("a spring");
        assert_eq!(layout.follow(&system), 1);
        is_that_of_a_new_one(&layout, &system);
        system.cut(id);
        assert_eq!(layout.follow(&system), 1);
    }
    assert!(layout.pairs().len() <= slots + 1);
}

#[test]
fn pieces_are_what_constraints_join() {
    let mut scene = Scene::particles((0..7).map(|i| [f64::from(i), 0.0, 0.0]), 1.0);
    scene.springs = vec![
        spring(5, 1, 1.0, 1.0),
        spring(3, 2, 1.0, 1.0),
        spring(6, 5, 1.0, 1.0),
    ];
    let mut layout = Layout::default();
    layout.follow(&scene.system());
    assert_eq!(layout.pieces(), [0, 1, 2, 2, 4, 1, 1]);
}

#[test]
fn a_step_is_the_dense_solution_where_some_are_held() {
    let mut scene = crumpled(3, 8);
    (scene.held[0], scene.held[5]) = (true, true);
    scene.gravity = Vector::new(0.3, 0.0, -9.81);
    scene.drag = 2.0;
    let mut system = scene.system();
    let (h, n) = (0.004, scene.x.len());
    // (M (1 + hc) + h² H) Δv = h (f − h H v − c M v) for the free particles: a penalty would be
    // inexact, so each held coordinate adds the row Δv = 0 with a multiplier.
    let (hessian, _) = dense(&system, false);
    let forces = forces(&mut system);
    let v: Vec<f64> = scene.v.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
    let held = [0, 1, 2, 15, 16, 17];
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
    let change = solve(a, b);
    let mut solver = Implicit::new(Settings {
        tolerance: Tolerance::Fixed(1e-14),
        ..Settings::default()
    });
    let report = step(&mut system, &mut solver, h).expect("a step");
    assert_eq!(
        (report.indefinite, report.clamped),
        (0, 0),
        "the case is to be definite"
    );
    let (x, moved) = (system.positions(), system.velocities());
    for i in 0..n {
        let truth = scene.v[i] + Vector::new(change[3 * i], change[3 * i + 1], change[3 * i + 2]);
        assert!(
            (moved[i] - truth).norm() < 1e-11,
            "{i}: {} {truth}",
            moved[i]
        );
        assert!((x[i] - (scene.x[i] + truth * h)).norm() < 1e-13);
    }
    assert_eq!(
        moved[0], scene.v[0],
        "what is held keeps its velocity, to the bit"
    );
}

#[test]
fn what_is_held_and_stands_still_does_so_to_the_last_bit() {
    let mut scene = crumpled(3, 4);
    scene.gravity = Vector::new(0.0, 0.0, -9.81);
    scene.v.fill(Vector::zeros());
    for (i, x) in scene.x.iter_mut().enumerate().filter(|(i, _)| i % 5 == 0) {
        scene.held[i] = true;
        *x += Vector::new(0.1, 0.7, 1.0 / 3.0);
    }
    let mut system = scene.system();
    let mut solver = Implicit::new(Settings {
        method: Method::Bdf2,
        ..Settings::default()
    });
    for turn in 0..50 {
        let h = if turn % 3 == 0 { 0.003 } else { 0.002 };
        step(&mut system, &mut solver, h).expect("a step");
    }
    let (x, v) = (system.positions(), system.velocities());
    for i in (0..x.len()).step_by(5) {
        assert_eq!((x[i], v[i]), (scene.x[i], Vector::zeros()), "{i}");
    }
    assert_ne!(x[1], scene.x[1]);
}

#[test]
fn each_free_piece_keeps_its_momentum_to_rounding_at_any_tolerance() {
    for (method, newton) in [
        (Method::BackwardEuler, 1),
        (Method::Bdf2, 1),
        (Method::Bdf2, 20),
    ] {
        // Three pieces: a sheet that moves, another that is held at one corner, and a particle.
        let mut scene = crumpled(3, 21);
        let other = crumpled(2, 22);
        let n = scene.x.len();
        scene
            .x
            .extend(other.x.iter().map(|x| x + Vector::new(5.0, 0.0, 0.0)));
        scene.x.push(Point::new(9.0, 0.0, 0.0));
        scene.v.extend(other.v.iter().copied().chain([Vector::x()]));
        scene.masses = (0..scene.x.len())
            .map(|i| 0.01 + 0.001 * (i % 7) as f64)
            .collect();
        scene.held = vec![false; scene.x.len()];
        for mut t in other.triangles {
            t.corners = t.corners.map(|v| v + n);
            scene.triangles.push(t);
        }
        scene.held[n] = true;
        let mut solver = Implicit::new(Settings {
            method,
            newton_iterations_max: newton,
            tolerance: Tolerance::Fixed(1e-3),
            ..Settings::default()
        });
        let momentum = |v: &[Vector]| -> Vector { (0..n).map(|i| v[i] * scene.masses[i]).sum() };
        let mut system = scene.system();
        let start = momentum(system.velocities());
        for _ in 0..100 {
            step(&mut system, &mut solver, 0.01).expect("a step");
        }
        let (x, v) = (system.positions(), system.velocities());
        let change = (momentum(v) - start).norm();
        println!(
            "{method:?}: momentum changed by {change:.1e} of {:.1e}",
            start.norm()
        );
        assert!(change < 1e-15, "{method:?}: {change}");
        assert!((v[x.len() - 1] - Vector::x()).norm() < 1e-13);
        assert_ne!(x[1], scene.x[1], "something moved");
    }
}

#[test]
fn the_same_input_gives_the_same_bytes_on_every_machine() {
    let mut scene = crumpled(5, 77);
    scene.gravity = Vector::new(0.0, 0.0, -9.81);
    scene.held[0] = true;
    let run = || {
        let mut system = scene.system();
        let mut solver = Implicit::new(Settings {
            method: Method::Bdf2,
            ..Settings::default()
        });
        for _ in 0..30 {
            step(&mut system, &mut solver, 1.0 / 120.0).expect("a step");
        }
        let x = system.positions().iter();
        let bits = x.flat_map(|p| [p.x, p.y, p.z]).map(f64::to_bits);
        bits.fold(0xcbf2_9ce4_8422_2325_u64, |hash, bits| {
            (hash ^ bits).wrapping_mul(0x0000_0100_0000_01b3)
        })
    };
    let hash = run();
    assert_eq!(hash, run());
    assert_eq!(
        hash, 0xd6e5_ecd9_643f_dd2c,
        "the bytes changed: 0x{hash:016x}"
    );
}

#[test]
fn a_step_after_the_first_allocates_nothing() {
    let mut scene = crumpled(4, 30);
    scene.gravity = Vector::new(0.0, 0.0, -9.81);
    let mut system = scene.system();
    for newton_iterations_max in [1, 30] {
        let mut solver = Implicit::new(Settings {
            method: Method::Bdf2,
            newton_iterations_max,
            ..Settings::default()
        });
        let mut take = || {
            step(&mut system, &mut solver, 0.004).expect("a step");
        };
        take();
        let count = allocation_counter::measure(take).count_total;
        assert_eq!(count, 0, "{newton_iterations_max}");
    }
}

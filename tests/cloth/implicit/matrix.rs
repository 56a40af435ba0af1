//! The matrix, its layout, held directions, and bytes.

use super::dense::{dense, solve};
use super::{Scene, spring};
use crate::random::Random;
use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit::{
    Bend, Filter, Hessian, Implicit, Layout, Method, ModelError, Part, Settings, Tolerance,
};

/// A sheet with triangles, springs along its rows and bends two apart, crumpled.
pub(super) fn crumpled(n: u32, seed: u64) -> Scene {
    let mut random = Random(seed);
    let mut scene = Scene::sheet(n, 0.01, [20.0, 15.0, 3.0]);
    let l = 1.0 / f64::from(n);
    for row in 0..=n {
        for i in 0..n {
            let a = row * (n + 1) + i;
            scene.springs.push(spring(a, a + 1, l, 5.0));
            if i + 1 < n {
                let bend = Bend::new([a, a + 2], 2.0 * l, 1e-4, 2.0).expect("stiff enough");
                scene.bends.push(bend);
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

#[test]
fn a_layout_that_follows_gives_the_matrix_of_a_new_one() {
    let mut scene = crumpled(4, 3);
    let mut layout = Layout::default();
    assert!(layout.follow(&scene.model()) > 0);
    assert_eq!(layout.follow(&scene.model()), 0);
    // A vertex split by hand: vertex 12 gives two triangles, a spring and a bend to a copy.
    let copy = u32::try_from(scene.x.len()).expect("small");
    scene.x.push(scene.x[12]);
    scene.masses.push(0.01);
    scene.filters.push(Filter::Free);
    scene.accelerations.push(Vector::zeros());
    let renamed = |v: u32| if v == 12 { copy } else { v };
    let mut changed = 0;
    let at12 = scene
        .triangles
        .iter_mut()
        .filter(|t| t.vertices.contains(&12));
    for t in at12.take(2) {
        t.vertices = t.vertices.map(renamed);
        changed += 2;
    }
    let at12 = scene.springs.iter_mut().find(|s| s.ends.contains(&12));
    let s = at12.expect("a spring");
    s.ends = s.ends.map(renamed);
    let at12 = scene.bends.iter_mut().find(|b| b.ends().contains(&12));
    let b = at12.expect("a bend");
    *b = b.between(b.ends().map(renamed));
    assert_eq!(
        layout.follow(&scene.model()),
        changed + 2,
        "only what was torn is touched"
    );
    // And some that go, from the middle.
    scene.springs.swap_remove(3);
    scene.bends.swap_remove(0);
    scene.triangles.swap_remove(5);
    layout.follow(&scene.model());
    let mut new = Layout::default();
    new.follow(&scene.model());
    assert_eq!(layout.pieces(), new.pieces());
    let (mut hessian, mut other) = (Hessian::default(), Hessian::default());
    scene
        .model()
        .hessian(&scene.x, &layout, false, &mut hessian);
    scene.model().hessian(&scene.x, &new, false, &mut other);
    let mut random = Random(9);
    let v: Vec<Vector> = scene
        .x
        .iter()
        .map(|_| Vector::from_fn(|_, _| random.next() - 0.5))
        .collect();
    let (mut a, mut b) = (Vec::new(), Vec::new());
    hessian.product(layout.pairs(), &v, &mut a);
    other.product(new.pairs(), &v, &mut b);
    let apart: Vec<Vector> = a.iter().zip(&b).map(|(a, b)| a - b).collect();
    assert!(super::norm(&apart) < 1e-14 * super::norm(&a));
    // A slot freed is a slot used again.
    let live = layout.pairs().iter().filter(|p| p[0] != p[1]).count();
    assert_eq!(live, new.pairs().len());
    let slots = layout.pairs().len();
    for turn in 0..20 {
        scene.springs[0].ends = [[0, 13], [1, 17]][turn % 2];
        assert_eq!(layout.follow(&scene.model()), 1);
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
    layout.follow(&scene.model());
    assert_eq!(layout.pieces(), [0, 1, 2, 2, 4, 1, 1]);
}

#[test]
fn a_step_is_the_dense_solution_with_held_directions() {
    let mut scene = crumpled(3, 8);
    let oblique = Vector::new(1.0, 2.0, -2.0) / 3.0;
    scene.filters[0] = Filter::Fixed;
    scene.filters[3] = Filter::Plane(oblique);
    scene.filters[5] = Filter::Line(oblique);
    scene.accelerations.fill(Vector::new(0.3, 0.0, -9.81));
    scene.drag = 2.0;
    let (h, n) = (0.004, scene.x.len());
    // (M (1 + hc) + h² H) Δv = h (f − h H v − c M v) in the free directions: a penalty would be
    // inexact, so each held direction n adds the row n·Δv = 0 with a multiplier.
    let (hessian, _) = dense(&scene.model(), &scene.x, false);
    let mut forces = Vec::new();
    scene.model().forces(&scene.x, &mut forces);
    let v: Vec<f64> = scene.v.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
    let axes = [Vector::x(), Vector::y(), Vector::z()];
    let p = Vector::new(2.0, -2.0, -1.0) / 3.0;
    let held = axes
        .iter()
        .map(|a| (0, *a))
        .chain([(3, oblique), (5, p), (5, oblique.cross(&p))]);
    let held: Vec<(usize, Vector)> = held.collect();
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
    for (k, (particle, direction)) in held.iter().enumerate() {
        for c in 0..3 {
            a[3 * n + k][3 * particle + c] = direction[c];
            a[3 * particle + c][3 * n + k] = direction[c];
        }
    }
    let change = solve(a, b);
    let settings = Settings {
        tolerance: Tolerance::Fixed(1e-14),
        ..Settings::default()
    };
    let mut solver = Implicit::new(&scene.model()).expect("a good model");
    let (mut x, mut moved) = (scene.x.clone(), scene.v.clone());
    let report = solver
        .step(&scene.model(), &mut x, &mut moved, h, &settings)
        .expect("a step");
    assert_eq!(
        (report.indefinite, report.clamped),
        (0, 0),
        "the case is to be definite"
    );
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
    scene.accelerations.fill(Vector::new(0.0, 0.0, -9.81));
    scene.v.fill(Vector::zeros());
    for (i, x) in scene.x.iter_mut().enumerate().filter(|(i, _)| i % 5 == 0) {
        scene.filters[i] = Filter::Fixed;
        *x += Vector::new(0.1, 0.7, 1.0 / 3.0);
    }
    let (mut x, mut v) = (scene.x.clone(), scene.v.clone());
    let mut solver = Implicit::new(&scene.model()).expect("a good model");
    let settings = Settings {
        method: Method::Bdf2,
        ..Settings::default()
    };
    for step in 0..50 {
        let h = if step % 3 == 0 { 0.003 } else { 0.002 };
        solver
            .step(&scene.model(), &mut x, &mut v, h, &settings)
            .expect("a step");
    }
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
        let n = u32::try_from(scene.x.len()).expect("small");
        scene
            .x
            .extend(other.x.iter().map(|x| x + Vector::new(5.0, 0.0, 0.0)));
        scene.x.push(Point::new(9.0, 0.0, 0.0));
        scene.v.extend(other.v.iter().copied().chain([Vector::x()]));
        scene.masses = (0..scene.x.len())
            .map(|i| 0.01 + 0.001 * (i % 7) as f64)
            .collect();
        scene.filters = vec![Filter::Free; scene.x.len()];
        scene.accelerations = vec![Vector::zeros(); scene.x.len()];
        for mut t in other.triangles {
            t.vertices = t.vertices.map(|v| v + n);
            scene.triangles.push(t);
        }
        scene.filters[n as usize] = Filter::Fixed;
        let settings = Settings {
            method,
            newton_iterations_max: newton,
            tolerance: Tolerance::Fixed(1e-3),
            ..Settings::default()
        };
        let momentum =
            |v: &[Vector]| -> Vector { (0..n as usize).map(|i| v[i] * scene.masses[i]).sum() };
        let (mut x, mut v) = (scene.x.clone(), scene.v.clone());
        let start = momentum(&v);
        let mut solver = Implicit::new(&scene.model()).expect("a good model");
        for _ in 0..100 {
            solver
                .step(&scene.model(), &mut x, &mut v, 0.01, &settings)
                .expect("a step");
        }
        let change = (momentum(&v) - start).norm();
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
    scene.accelerations.fill(Vector::new(0.0, 0.0, -9.81));
    scene.filters[0] = Filter::Fixed;
    scene.filters[5] = Filter::Line(Vector::x());
    let run = || {
        let (mut x, mut v) = (scene.x.clone(), scene.v.clone());
        let mut solver = Implicit::new(&scene.model()).expect("a good model");
        let settings = Settings {
            method: Method::Bdf2,
            ..Settings::default()
        };
        for _ in 0..30 {
            solver
                .step(&scene.model(), &mut x, &mut v, 1.0 / 120.0, &settings)
                .expect("a step");
        }
        let bits = x.iter().flat_map(|p| [p.x, p.y, p.z]).map(f64::to_bits);
        bits.fold(0xcbf2_9ce4_8422_2325_u64, |hash, bits| {
            (hash ^ bits).wrapping_mul(0x0000_0100_0000_01b3)
        })
    };
    let hash = run();
    assert_eq!(hash, run());
    assert_eq!(
        hash, 0x812c_68b4_326a_a043,
        "the bytes changed: 0x{hash:016x}"
    );
}

#[test]
fn a_step_after_the_first_allocates_nothing() {
    let mut scene = crumpled(4, 30);
    scene.accelerations.fill(Vector::new(0.0, 0.0, -9.81));
    let mut solver = Implicit::new(&scene.model()).expect("a good model");
    let (mut x, mut v) = (scene.x.clone(), scene.v.clone());
    for newton_iterations_max in [1, 30] {
        let settings = Settings {
            method: Method::Bdf2,
            newton_iterations_max,
            ..Settings::default()
        };
        let mut step = || {
            solver
                .step(&scene.model(), &mut x, &mut v, 0.004, &settings)
                .expect("a step");
        };
        step();
        let count = allocation_counter::measure(step).count_total;
        assert_eq!(count, 0, "{newton_iterations_max}");
    }
}

#[test]
fn unusable_models_are_refused_with_the_index() {
    let good = crumpled(2, 1);
    assert_eq!(good.model().check(), Ok(()));
    let refused = |part, index, breakage: &dyn Fn(&mut Scene)| {
        let mut scene = good.clone();
        breakage(&mut scene);
        let error = Implicit::new(&scene.model()).err();
        assert_eq!(error, Some(ModelError::Unusable { part, index }));
    };
    refused(Part::Mass, 3, &|s| s.masses[3] = 0.0);
    refused(Part::Mass, 2, &|s| s.masses[2] = f64::NAN);
    refused(Part::Filter, 1, &|s| {
        s.filters[1] = Filter::Plane(Vector::x() * 2.0);
    });
    refused(Part::Filter, 1, &|s| {
        s.filters[1] = Filter::Line(Vector::x() * f64::NAN);
    });
    refused(Part::Acceleration, 4, &|s| {
        s.accelerations[4].y = f64::INFINITY;
    });
    refused(Part::Spring, 0, &|s| s.springs[0].ends = [1, 1]);
    refused(Part::Spring, 1, &|s| s.springs[1].ends = [1, 9]);
    refused(Part::Spring, 2, &|s| s.springs[2].stiffness = -1.0);
    refused(Part::Spring, 2, &|s| s.springs[2].rest_length = f64::NAN);
    refused(Part::Triangle, 7, &|s| s.triangles[7].vertices = [0, 1, 0]);
    refused(Part::Triangle, 6, &|s| s.triangles[6].area = 0.0);
    refused(Part::Triangle, 6, &|s| {
        s.triangles[6].stiffness[2] = f64::NAN;
    });
    refused(Part::Bend, 1, &|s| s.bends[1] = s.bends[1].between([2, 2]));
    let mut short = good.clone();
    short.filters.pop();
    let length = ModelError::Length {
        part: Part::Filter,
        given: 8,
        particles: 9,
    };
    assert_eq!(short.model().check(), Err(length));
    let drag = Scene {
        drag: -1.0,
        ..good.clone()
    };
    assert_eq!(drag.model().check(), Err(ModelError::Drag { given: -1.0 }));
    let mut bare = good.clone();
    bare.filters.clear();
    bare.accelerations.clear();
    assert_eq!(bare.model().check(), Ok(()));
}

//! Cloth of triangles: what its limits are, what is refused, and what it costs.

use tearmesh::insert::Plan;
use tearmesh::{Edits, Masses, Point, Vector, shapes, slide, split};
use tearmesh_cloth::{
    BlowUpSite, Cloth, ClothError, Fabric, Implicit, Pbd, Provot, Solver, StepError, System,
    SystemError, Unstable, Verlet, Weave, Xpbd, energy, frequency_bound,
};

use crate::parts::cloths::cloth;
use crate::parts::mechanical_j;
use crate::parts::vibration::{largest_frequency, rayleigh_quotient};
use crate::parts::woven::{sheet, strip, weave};
use crate::plain_verlet::PlainVerlet;
use crate::rk4::Rk4;

#[test]
fn explicit_methods_are_held_to_the_limit_of_triangles() {
    let omega = |cloth: &mut Cloth| {
        let exact = largest_frequency(cloth.system());
        let bound = frequency_bound(cloth.system_mut()).omega_rad_per_s;
        println!("measured {exact}, bound {bound}");
        assert!(
            exact <= bound * (1.0 + 1e-12) && exact > 0.4 * bound,
            "{exact} {bound}"
        );
        exact
    };
    let (_, _, mut cloth) = sheet(6, weave());
    let rest = omega(&mut cloth);
    let error = cloth
        .step(&mut PlainVerlet::new(), 2.05 / rest)
        .expect_err("too long");
    assert!(matches!(error, StepError::Unstable { frequency, .. } if frequency.ends.is_some()));
    let dt = 1.0 / rest;
    cloth.step(&mut PlainVerlet::new(), dt).expect("a step");

    // Stretched eight times its shear is stiffer by far: the same step is refused.
    for p in cloth.system_mut().state_mut().0 {
        p.x *= 8.0;
        p.y *= 8.0;
    }
    let stretched = omega(&mut cloth);
    assert!(stretched > 3.0 * rest, "{stretched} {rest}");
    let error = cloth
        .step(&mut PlainVerlet::new(), dt)
        .expect_err("too long now");
    assert!(matches!(error, StepError::Unstable { .. }), "{error}");
    cloth.system_mut().when_unstable(Unstable::Substep);
    let report = cloth.step(&mut PlainVerlet::new(), dt).expect("divided");
    assert!(report.substeps > 1);
}

/// Rows F1 and F2 for triangles: the class of every cell.
#[test]
fn the_blow_up_map_of_triangles() {
    let methods: [&mut dyn Solver; 3] = [
        &mut PlainVerlet::new(),
        &mut Provot::unlimited(),
        &mut Rk4::new(),
    ];
    for method in methods {
        for stiffness in [1e2, 1e3, 1e4, 1e5] {
            let scale = |x: f64| x * stiffness / 100.0;
            let run = |method: &mut dyn Solver, part: f64| {
                let stiff = Weave {
                    warp_n_per_m: scale(120.0),
                    weft_n_per_m: scale(80.0),
                    shear_n_per_m: scale(15.0),
                    ..weave()
                };
                let (_, _, mut cloth) = sheet(3, stiff);
                let system = cloth.system_mut();
                let omega = largest_frequency(system);
                system.when_unstable(Unstable::Allow);
                system.state_mut().1[5] = Vector::new(1e-6, 0.3e-6, 0.2e-6);
                let push = energy::kinetic_j(system);
                let dt = part * method.abilities().frequency_limit.expect("explicit") / omega;
                let mut most = 0.0_f64;
                for _ in 0..600 {
                    if system.step(&mut *method, dt).is_err() {
                        return false;
                    }
                    most = most.max(mechanical_j(system));
                }
                most < 400.0 * push
            };
            let cells = [0.9, 0.99, 1.01, 1.1].map(|part| run(&mut *method, part));
            assert_eq!(cells, [true, true, false, false], "{stiffness}");
        }
    }
}

#[test]
fn a_blow_up_of_triangles_is_noticed_and_the_last_good_state_kept() {
    let (_, _, mut cloth) = sheet(3, weave());
    cloth.system_mut().when_unstable(Unstable::Allow);
    cloth.system_mut().state_mut().1[5] = Vector::new(1e-3, 0.0, 1e-3);
    let error = (0..1000).find_map(|_| {
        let good = cloth.positions().to_vec();
        let error = cloth.step(&mut PlainVerlet::new(), 0.3).err()?;
        assert_eq!(cloth.positions(), good);
        Some(error)
    });
    let Some(StepError::BlowUp { at, .. }) = error else {
        panic!("{error:?}");
    };
    assert!(!matches!(at, BlowUpSite::Particle(_)), "{at:?}");

    // Without edges to measure the triangle is blamed.
    let mut strip = strip(2, 0.01, 50.0, 0.1, Vector::x() * 0.1);
    strip.when_unstable(Unstable::Allow);
    strip.state_mut().0[4].x = 90.0;
    let error = strip.step(&mut Rk4::new(), 1e-3).expect_err("a tear");
    assert!(error.to_string().contains("triangle 2-"), "{error}");
}

#[test]
fn what_cannot_be_woven_or_stepped_is_refused() {
    let (mesh, positions) = shapes::grid(2, 2);
    let masses = Masses::area(&mesh, &positions, 0.2).expect("masses");
    let made = |fabric: Fabric| Cloth::new(&mesh, &positions, masses.clone(), fabric);
    for (warp, weft, shear, named) in [
        (0.0, 1.0, 1.0, "weave.warp_n_per_m is 0,"),
        (1.0, -1.0, 1.0, "weave.weft_n_per_m is -1,"),
        (1.0, 1.0, -1.0, "weave.shear_n_per_m is -1,"),
        (f64::NAN, 1.0, 1.0, "weave.warp_n_per_m is NaN,"),
        (1.0, 1.0, f64::INFINITY, "weave.shear_n_per_m is inf,"),
    ] {
        let weave = Weave {
            warp_n_per_m: warp,
            weft_n_per_m: weft,
            shear_n_per_m: shear,
            ..weave()
        };
        let error = made(Fabric::woven(weave)).expect_err("no modulus");
        assert!(error.to_string().starts_with(named), "{error}");
    }
    let nothing = made(Fabric::new(0.0)).expect_err("nothing at all");
    let (field, given) = ("modulus_n_per_m", 0.0);
    assert_eq!(nothing, ClothError::Stiffness { field, given });
    for warp in [
        Vector::z(),
        Vector::zeros(),
        Vector::new(f64::NAN, 0.0, 0.0),
    ] {
        let error = made(Fabric::woven(Weave { warp, ..weave() })).expect_err("no warp");
        assert!(
            error
                .to_string()
                .starts_with("the face f0 has no area at rest, or"),
            "{error}"
        );
    }
    let mut cloth = made(Fabric::woven(weave())).expect("a cloth");
    let methods: [&mut dyn Solver; 2] = [&mut Pbd::default(), &mut Xpbd::default()];
    for method in methods {
        let error = cloth.step(method, 0.01).expect_err("springs alone");
        assert_eq!(error, StepError::Triangles { count: 8 });
        assert_eq!(
            error.to_string(),
            "the method supports springs only, and 8 triangles resist stretch"
        );
    }
    let points = (0..3).map(|i| Point::new(f64::from(i), f64::from(i * i), 0.0));
    let mut system = System::new(points, vec![1.0; 3]).expect("particles");
    let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    for (corners, places, stiffness) in [
        ([0, 1, 1], places, [1.0; 3]),
        ([0, 1, 3], places, [1.0; 3]),
        ([0, 1, 2], [[0.0; 2]; 3], [1.0; 3]),
        ([0, 1, 2], places, [-1.0, 1.0, 1.0]),
    ] {
        let error = system
            .triangle(corners, places, stiffness)
            .expect_err("none");
        assert_eq!(error, SystemError::Triangle { corners });
    }
    assert_eq!(system.triangle([0, 1, 2], places, [1.0; 3]), Ok(0));
}

#[test]
fn a_scene_without_triangles_pays_nothing_for_them_and_one_with_them_is_counted() {
    let (mesh, positions) = shapes::grid(3, 3);
    let mut springs = cloth(&mesh, &positions, Fabric::new(50.0));
    let (_, _, mut woven) = sheet(3, weave());
    for cloth in [&mut springs, &mut woven] {
        let dt = 1.0 / frequency_bound(cloth.system_mut()).omega_rad_per_s;
        for _ in 0..10 {
            cloth.step(&mut Verlet::new(), dt).expect("a step");
        }
        cloth.step(&mut Implicit::default(), dt).expect("a step");
    }
    let [springs, woven] = [&springs, &woven].map(|cloth| cloth.system().counters());
    assert_eq!(springs.features.triangle, 0);
    // Eleven sums of forces for ten steps; and for the implicit one, one of forces and one of the matrix,
    // products with it, and two each for lengths and energy at the end.
    let solved = 2 + woven.matrix_products + 4;
    assert_eq!(woven.features.triangle, 18 * (11 + solved));
    assert_eq!(woven.force_evaluations, springs.force_evaluations);
    assert_eq!((woven.matrix_products > 0, woven.visits.project), (true, 0));
}

/// An edit looks at the triangles that it touches and at no others.
#[test]
fn edits_take_no_sum_over_all_triangles() {
    let (mut mesh, _, mut cloth) = sheet(12, weave());
    let counted = cloth.system().counters();
    let mut edits = Edits::new();
    for v in mesh.vertices().skip(20).step_by(7).take(15) {
        let face = mesh.faces_of(v).next().expect("a face");
        split::vertex(&mut mesh, v, &[face], &mut edits).expect("a split");
        let h = mesh.half_edge_of(v).expect("an edge");
        slide::toward(&mesh, v, mesh.target(h), 0.1, &mut edits).expect("a slide");
        let mut plan = Plan::new();
        plan.on_edge(h, 0.4);
        plan.apply(&mut mesh, &mut edits).expect("an insertion");
    }
    edits.replay(&mut cloth);
    assert_eq!(cloth.system().counters(), counted);
    let known = frequency_bound(cloth.system_mut()).omega_rad_per_s;
    let shape = |i: usize| Vector::new(1.0, -1.0, 0.3) * [1.0, -1.0, 0.5][i % 3];
    let shapes: Vec<Vector> = (0..mesh.vertex_count()).map(shape).collect();
    assert!(rayleigh_quotient(cloth.system(), &shapes) <= known * known);
}

//! Cloth of triangles: its moduli, its limits, and what is refused.

use tearmesh::{Masses, Point, Vector, shapes};
use tearmesh_cloth::{Cloth, Fabric, StepError, Unstable, energy, frequency_bound};

use crate::parts::cloths::{cloth, deform};
use crate::parts::vibration::largest_frequency;
use crate::parts::woven::{moduli, of_moduli, sheet, weave};
use crate::parts::{near, particles};
use crate::plain_verlet::PlainVerlet;
use crate::random::Random;

/// R8: moduli are those that were asked for, on a net with one diagonal a cell that leans, on a fan,
/// and after the sheet was torn at random.
#[test]
fn r8_moduli_are_those_asked_for_whatever_the_mesh() {
    let mut random = Random(3);
    for (mesh, positions) in [
        shapes::grid(5, 4),
        shapes::fan(7, true),
        shapes::fan(5, false),
    ] {
        for _ in 0..4 {
            let angle: f64 = 6.0 * random.next();
            let axes = [
                Vector::new(angle.cos(), angle.sin(), 0.0),
                Vector::new(-angle.sin(), angle.cos(), 0.0),
            ];
            let weave = of_moduli([1000.0, 300.0, 70.0], axes[0] + Vector::z());
            let mut cloth = cloth(&mesh, &positions, Fabric::orthotropic(weave));
            let area: f64 = cloth.system().triangles().iter().map(|t| t.area).sum();
            let c = moduli(cloth.system(), area, axes);
            let truth = [[1000.0, 0.0, 0.0], [0.0, 300.0, 0.0], [0.0, 0.0, 70.0]];
            let pairs = c.as_flattened().iter().zip(truth.as_flattened());
            pairs.for_each(|(found, asked)| near(*found, *asked, 1e-5));
            // In large strain too: energy and stretch are those of the definition.
            let [s, t, gamma] = [1.3, 0.9, 0.2];
            let [e, f] = axes;
            for p in cloth.system_mut().state_mut().0 {
                let (u, v) = (e.dot(&p.coords), f.dot(&p.coords));
                *p = Point::from(e * (s * u + gamma * v) + f * (t * v));
            }
            let w_v = f64::hypot(gamma, t);
            let [along, across] = [s, w_v].map(|w: f64| (w - 1.0).powi(2));
            let energy = 500.0 * along + 150.0 * across + 35.0 * (s * gamma).powi(2);
            near(energy::elastic_j(cloth.system()), energy * area, 1e-10);
        }
    }
}

#[test]
fn explicit_methods_are_held_to_the_limit_of_triangles() {
    let omega = |cloth: &mut Cloth| {
        let exact = largest_frequency(cloth.system());
        let bound = frequency_bound(cloth.system_mut()).omega_rad_per_s;
        assert!((0.4..1.0 + 1e-12).contains(&(exact / bound)));
        exact
    };
    let (_, _, mut cloth) = sheet(6, weave());
    let rest = omega(&mut cloth);
    let mut verlet = PlainVerlet::new();
    let error = cloth.step(&mut verlet, 2.05 / rest).expect_err("too long");
    assert!(error.to_string().contains(" at edge "), "{error}");
    let dt = 1.0 / rest;
    cloth.step(&mut verlet, dt).expect("a step");

    // Stretched eight times its shear is stiffer by far: the same step is refused.
    deform(&mut cloth, |p| p * 8.0);
    assert!(omega(&mut cloth) > 3.0 * rest);
    let error = cloth.step(&mut verlet, dt).expect_err("too long now");
    assert!(matches!(error, StepError::Unstable { .. }), "{error}");
    cloth.system_mut().when_unstable(Unstable::Substep);
    assert!(cloth.step(&mut verlet, dt).expect("divided") > 1);
}

#[test]
fn what_cannot_be_woven_is_refused() {
    let (mesh, positions) = shapes::grid(2, 2);
    let masses = Masses::area(&mesh, &positions, 0.2).expect("masses");
    let made = |fabric: Fabric| Cloth::new(&mesh, &positions, masses.clone(), fabric);
    // Others are in `refused.rs`.
    let (mut none, mut endless) = (weave(), weave());
    (none.warp_n_per_m, endless.warp.x) = (f64::NAN, f64::INFINITY);
    for (weave, named) in [
        (none, "orthotropic.warp_n_per_m is NaN,"),
        (endless, "the face f0 has no area"),
    ] {
        let error = made(Fabric::orthotropic(weave))
            .expect_err(named)
            .to_string();
        assert!(error.starts_with(named), "{error}");
    }
    let mut system = particles([[0.0; 3], [1.0, 1.0, 0.0], [2.0, 4.0, 0.0]], 1.0);
    let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    for (corners, places, stiffness) in [
        ([0, 1, 1], places, [1.0; 3]),
        ([0, 1, 3], places, [1.0; 3]),
        ([0, 1, 2], [[0.0; 2]; 3], [1.0; 3]),
        ([0, 1, 2], places, [-1.0, 1.0, 1.0]),
    ] {
        assert_eq!(system.triangle(corners, places, stiffness), None);
    }
    assert_eq!(system.triangle([0, 1, 2], places, [1.0; 3]), Some(0));
}

//! Cloth of triangles: what its limits are, what is refused, and what it costs.

use tearmesh::{Masses, Point, Vector, shapes};
use tearmesh_cloth::{
    Cloth, ClothError, Fabric, Pbd, Solver, StepError, System, SystemError, Unstable, Weave, Xpbd,
    frequency_bound,
};

use crate::parts::vibration::largest_frequency;
use crate::parts::woven::{sheet, weave};
use crate::plain_verlet::PlainVerlet;

#[test]
fn explicit_methods_are_held_to_the_limit_of_triangles() {
    let omega = |cloth: &mut Cloth| {
        let exact = largest_frequency(cloth.system());
        let bound = frequency_bound(cloth.system_mut()).omega_rad_per_s;
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

//! Cloth of triangles against the reference answers: a strip that moves like a chain is one,
//! because triangles have no Poisson's ratio.

use tearmesh::{Point, Vector, shapes};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{Fabric, Weave, energy};

use crate::parts::cloths::cloth;
use crate::parts::woven::{moduli, sheet, weave};
use crate::parts::{G, gravity_along_y, implicit, near};
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
            let weave = Weave {
                warp_n_per_m: 1000.0,
                weft_n_per_m: 300.0,
                shear_n_per_m: 70.0,
                warp: axes[0] + Vector::z(),
            };
            let mut cloth = cloth(&mesh, &positions, Fabric::woven(weave));
            let area: f64 = cloth.system().triangles().iter().map(|t| t.area).sum();
            let c = moduli(&mut cloth, area, axes);
            let truth = [[1000.0, 0.0, 0.0], [0.0, 300.0, 0.0], [0.0, 0.0, 70.0]];
            for (found, asked) in c.as_flattened().iter().zip(truth.as_flattened()) {
                near(*found, *asked, 1e-5);
            }
            // In large strain too: energy and stretch are those of the definition.
            let [s, t, gamma] = [1.3, 0.9, 0.2];
            let [e, f] = axes;
            for p in cloth.system_mut().state_mut().0 {
                let (u, v) = (e.dot(&p.coords), f.dot(&p.coords));
                *p = Point::from(e * (s * u + gamma * v) + f * (t * v));
            }
            let w_v = f64::hypot(gamma, t);
            let energy = 500.0 * (s - 1.0) * (s - 1.0)
                + 150.0 * (w_v - 1.0) * (w_v - 1.0)
                + 35.0 * (s * gamma) * (s * gamma);
            near(energy::elastic_j(cloth.system()), energy * area, 1e-10);
        }
    }
}

/// A hanging sheet is as long as the sheet of the continuum: ρ g L² / (2 E) longer.
#[test]
fn a_hanging_sheet_comes_to_the_length_of_the_continuum() {
    let hang = |n: u32| {
        let along = Weave {
            warp: Vector::x(),
            ..weave()
        };
        let (_, _, mut cloth) = sheet(n, along);
        let row = (n + 1) as usize;
        (row * (row - 1)..row * row).for_each(|top| cloth.system_mut().hold(top));
        let loads = gravity_along_y(8.0);
        cloth.system_mut().set_loads(loads).expect("loads");
        let mut solver = implicit(Method::BackwardEuler);
        for _ in 0..150 {
            cloth.step(&mut solver, 0.2).expect("a step");
        }
        let bottom = &cloth.positions()[..row];
        -bottom.iter().map(|p| p.y).sum::<f64>() / f64::from(n + 1)
    };
    let answer = 0.2 * G / (2.0 * 80.0);
    let errors = [4, 8, 16].map(|n| (hang(n) / answer - 1.0).abs());
    assert!(
        errors[1] < 0.6 * errors[0] && errors[2] < 0.6 * errors[1],
        "{errors:?}"
    );
    assert!(errors[2] < 0.01, "{errors:?}");
}

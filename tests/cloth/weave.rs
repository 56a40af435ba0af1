//! Cloth of triangles against the reference answers: a strip that moves like a chain is one,
//! because triangles have no Poisson's ratio.

use tearmesh::{Point, Vector, shapes};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{Fabric, Loads, Provot, Solver, System, Verlet, Weave, energy, force};

use crate::parts::cloths::cloth;
use crate::parts::vibration::stiffness_times;
use crate::parts::woven::{framed, moduli, sheet, strip, weave};
use crate::parts::{G, gravity, gravity_along_y, implicit, mechanical_j, near, run};
use crate::plain_verlet::PlainVerlet;
use crate::random::Random;
use crate::rk4::Rk4;

const DOWN: Vector = Vector::new(0.0, 0.0, -1.0);

#[test]
fn r1_a_row_oscillates_as_a_mass_on_a_spring() {
    let oscillator = || {
        let mut system = strip(1, 0.01, 40.0, 1.0, Vector::x());
        system.state_mut().0[2].x = 1.1;
        system.state_mut().0[3].x = 1.1;
        system
    };
    let omega = 4000.0_f64.sqrt();
    let (dt, mut system) = (0.01, oscillator());
    let z = omega * dt;
    let discrete = (1.0 - z * z / 2.0).acos();
    for i in 1..=100 {
        run(&mut system, PlainVerlet::new(), dt, 1);
        for p in &system.positions()[2..] {
            near(p.x - 1.0, 0.1 * (discrete * f64::from(i)).cos(), 1e-11);
        }
    }
    let mut system = oscillator();
    let mut solver = implicit(Method::BackwardEuler);
    let size = |system: &System| {
        let (x, v) = (system.positions()[2].x - 1.0, system.velocities()[2].x);
        (x * x + v * v / (omega * omega)).sqrt()
    };
    for _ in 0..20 {
        let before = size(&system);
        run(&mut system, &mut solver, dt, 1);
        near(size(&system) / before, 0.845_154_254_728_517, 1e-9);
    }
}

#[test]
fn r2_a_strip_hangs_as_long_as_a_chain() {
    let hang = |solver: &mut dyn Solver, dt: f64, drag: f64| {
        let mut strip = strip(10, 0.01, 50.0, 0.1, DOWN * 0.1);
        strip.set_loads(gravity(drag)).expect("loads");
        run(&mut strip, solver, dt, (30.0 / dt).max(300.0) as usize);
        for p in &strip.positions()[20..] {
            near(p.z, -1.107_91, 1e-9);
        }
    };
    for dt in [0.004, 0.008] {
        hang(&mut Verlet::new(), dt, 4.0);
        hang(&mut Provot::unlimited(), dt, 4.0);
        hang(&mut Rk4::new(), dt, 4.0);
    }
    for dt in [1.0 / 60.0, 0.1, 1.0] {
        hang(&mut implicit(Method::BackwardEuler), dt, 5.0);
        hang(&mut implicit(Method::Bdf2), dt, 5.0);
    }
}

#[test]
fn r3_r4_modes_of_a_strip_are_those_of_a_chain_and_of_a_string() {
    let pi = std::f64::consts::PI;
    let omega = |strip: &mut System, direction: Vector, j: f64| {
        let shape = |v: usize| direction * (j * pi * (v / 2) as f64 / 32.0).sin();
        let shapes: Vec<Vector> = (0..66).map(shape).collect();
        let product = stiffness_times(strip, &shapes);
        let square = product[14].dot(&direction) / (0.01 * shapes[14].dot(&direction));
        // It is a mode: the same at every particle that is not held.
        for v in 2..64 {
            assert!(
                (product[v] - shapes[v] * (0.01 * square)).norm() < 1e-4,
                "{j} at {v}"
            );
        }
        square.sqrt()
    };
    let mut along = strip(32, 0.02, 1000.0, 0.03, Vector::x() * 0.03);
    for j in 1..32 {
        let mode = 2.0 * 50_000.0_f64.sqrt() * (f64::from(j) * pi / 64.0).sin();
        near(omega(&mut along, Vector::x(), f64::from(j)), mode, 1e-5);
    }
    near(
        omega(&mut along, Vector::x(), 1.0),
        21.943_731_058_786,
        1e-5,
    );
    near(
        omega(&mut along, Vector::x(), 31.0),
        446.674_907_138_54,
        1e-5,
    );
    let mut across = strip(32, 0.02, 1000.0, 0.03, Vector::x() / 32.0);
    for (j, answer) in [(1.0, 4.388_746_211_757_1), (2.0, 8.766_919_549_481_3)] {
        near(omega(&mut across, Vector::z(), j), answer, 1e-5);
    }
}

#[test]
fn r6c_a_strip_between_two_bars_sags_as_elastic_links() {
    let sag = |solver: &mut dyn Solver, dt: f64| {
        let mut net = strip(16, 0.01, 200.0, 0.08, Vector::x() / 16.0);
        net.hold(32);
        net.hold(33);
        net.set_loads(gravity(5.0)).expect("loads");
        for v in 2..32 {
            let x = net.positions()[v].x;
            net.state_mut().0[v].z = -2.0 * x * (1.0 - x);
        }
        run(&mut net, solver, dt, (20.0 / dt).max(200.0) as usize);
        let mut forces = Vec::new();
        net.release(0);
        net.release(1);
        net.set_loads(Loads::default()).expect("loads");
        force::accelerations(&mut net, &mut forces);
        for v in [0, 1] {
            near(net.positions()[16 + v].z, -0.390_722_835_980_581_3, 1e-9);
            near(2.0 * forces[v].x * 0.005, 0.441_288_464_343_035_3, 1e-9);
        }
    };
    sag(&mut Verlet::new(), 0.002);
    sag(&mut Rk4::new(), 0.002);
    sag(&mut Provot::unlimited(), 0.002);
    sag(&mut implicit(Method::BackwardEuler), 0.1);
    sag(&mut implicit(Method::Bdf2), 0.1);
}

#[test]
fn r7_a_row_at_its_threshold_holds_the_energy_of_its_link() {
    let mut row = strip(1, 0.01, 50.0, 0.1, Vector::x() * 0.15);
    near(energy::elastic_j(&row), 0.0625, 1e-15);
    let mut forces = Vec::new();
    force::accelerations(&mut row, &mut forces);
    near(-(forces[2].x + forces[3].x) * 0.005, 2.5, 1e-13);
}

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

#[test]
fn r9_free_fall_strains_nothing() {
    let check = |solver: &mut dyn Solver, answer: f64| {
        // So soft that no method needs substeps.
        let soft = Weave {
            warp_n_per_m: 1.2,
            weft_n_per_m: 0.8,
            shear_n_per_m: 0.15,
            ..weave()
        };
        let (mesh, _, mut cloth) = sheet(4, soft);
        cloth.system_mut().set_loads(gravity(0.0)).expect("loads");
        for _ in 0..60 {
            cloth.step(&mut *solver, 1.0 / 60.0).expect("a step");
        }
        for p in cloth.positions() {
            near(p.z, answer, 1e-12);
        }
        for f in mesh.faces() {
            near(cloth.principal_stretch(f), 1.0, 1e-12);
        }
    };
    check(&mut Verlet::new(), -4.905);
    check(&mut Rk4::new(), -4.905);
    check(&mut Provot::unlimited(), -4.986_75);
    check(&mut implicit(Method::BackwardEuler), -4.986_75);
}

#[test]
fn r10_a_rotating_strip_keeps_its_radius_and_energy() {
    let r = 100.0 / 190.0;
    let pair = || {
        let mut pair = strip(1, 0.1, 100.0, 1.0, Vector::x() * (2.0 * r));
        pair.release(0);
        pair.release(1);
        let (points, velocities) = pair.state_mut();
        for (v, (p, speed)) in points.iter_mut().zip(velocities).enumerate() {
            p.x -= r;
            // Across the strip is y; it turns about that.
            speed.z = if v < 2 { -10.0 * r } else { 10.0 * r };
        }
        pair
    };
    let check = |solver: &mut dyn Solver, dt: f64, drift: f64| {
        let mut pair = pair();
        run(&mut pair, solver, dt, (5.0 / dt).round() as usize);
        let d = pair.positions()[2] - pair.positions()[0];
        near(d.norm() / 2.0, r, drift);
        near(mechanical_j(&pair), 2.908_587_257_617_729, 10.0 * drift);
    };
    check(&mut Verlet::new(), 2e-4, 2e-6);
    check(&mut Rk4::new(), 1e-3, 1e-9);
}

#[test]
fn r11_a_static_drape_is_the_same_by_independent_methods() {
    let drape = |solver: &mut dyn Solver, dt: f64, steps: usize| {
        let mut cloth = framed(6, weave());
        for _ in 0..steps {
            cloth.step(&mut *solver, dt).expect("a step");
        }
        cloth.positions().to_vec()
    };
    let verlet = drape(&mut Verlet::new(), 0.004, 4000);
    let euler = drape(&mut implicit(Method::BackwardEuler), 0.1, 200);
    let bdf2 = drape(&mut implicit(Method::Bdf2), 0.1, 200);
    assert!(verlet[24].z < -0.02, "it sags: {}", verlet[24]);
    for (a, (b, c)) in verlet.iter().zip(euler.iter().zip(&bdf2)) {
        assert!(
            (a - b).norm() < 1e-9 && (a - c).norm() < 1e-9,
            "{a} {b} {c}"
        );
    }
}

/// The sag of a sheet in a frame with finer meshes.
#[test]
fn a_finer_mesh_sags_more_and_more_alike() {
    let isotropic = Weave {
        warp_n_per_m: 100.0,
        weft_n_per_m: 100.0,
        shear_n_per_m: 20.0,
        warp: Vector::x(),
    };
    let sags = [4, 8, 16].map(|n| {
        let mut cloth = framed(n, isotropic);
        let mut solver = implicit(Method::BackwardEuler);
        for _ in 0..150 {
            cloth.step(&mut solver, 0.2).expect("a step");
        }
        -cloth.positions()[((n + 1) * (n + 1) / 2) as usize].z
    });
    println!("sag of a frame with 4, 8 and 16 cells a side: {sags:?} m");
    let steps = [sags[1] - sags[0], sags[2] - sags[1]];
    assert!(steps[1].abs() < 0.5 * steps[0].abs(), "{sags:?}");
    assert!(steps[1].abs() < 0.02 * sags[2], "{sags:?}");
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
    println!("a hanging sheet with 4, 8 and 16 cells is off by {errors:?} of its extension");
    assert!(
        errors[1] < 0.6 * errors[0] && errors[2] < 0.6 * errors[1],
        "{errors:?}"
    );
    assert!(errors[2] < 0.01, "{errors:?}");
}

#[test]
fn turning_the_whole_turns_the_forces_and_changes_no_energy() {
    let mut random = Random(8);
    let (_, _, mut cloth) = sheet(4, weave());
    let mut next = || random.next() - 0.5;
    for p in cloth.system_mut().state_mut().0 {
        *p += Vector::new(next(), next(), next()) * 0.1;
    }
    let energy = energy::elastic_j(cloth.system());
    let mut before = Vec::new();
    force::accelerations(cloth.system_mut(), &mut before);
    let axis = Vector::new(1.0, -2.0, 0.5).normalize();
    let turned = |v: Vector| {
        let (s, c) = 0.9_f64.sin_cos();
        v * c + axis.cross(&v) * s + axis * (axis.dot(&v) * (1.0 - c))
    };
    for p in cloth.system_mut().state_mut().0 {
        *p = Point::from(turned(p.coords)) + Vector::new(0.3, 0.2, -0.7);
    }
    near(energy::elastic_j(cloth.system()), energy, 1e-12 * energy);
    let mut after = Vec::new();
    force::accelerations(cloth.system_mut(), &mut after);
    let largest = before.iter().map(|a| a.norm()).fold(0.0, f64::max);
    for (a, b) in before.iter().zip(&after) {
        assert!((turned(*a) - b).norm() < 1e-12 * largest);
    }
    // And the forces of all sum to nothing.
    let masses = cloth.system().masses();
    let sum = after
        .iter()
        .zip(masses)
        .fold(Vector::zeros(), |sum, (a, m)| sum + a * *m);
    assert!(sum.norm() < 1e-13 * largest);
}

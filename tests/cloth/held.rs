//! Pins, paths and bodies by every method, in steps of two lengths by turns.

use tearmesh::{Mesh, Point, Positions, Vector};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{Collider, Fabric, Path, Solver, System};

use crate::parts::cloths::cloth;
use crate::parts::nets::row;
use crate::parts::woven::weave;
use crate::parts::{
    METHODS, gravity, implicit, method, near, on_a_line, onto, order, plane, run, run_with,
};

/// Takes a number of steps, and tells of each.
fn take(system: &mut System, solver: &mut dyn Solver, steps: usize, mut then: impl FnMut(&System)) {
    for step in 0..steps {
        system
            .step(&mut *solver, [0.01, 0.006][step % 2])
            .expect("a step");
        then(system);
    }
}

#[test]
fn a_pin_stays_and_a_led_particle_is_on_its_path() {
    let corners = [[0.0, 0.0], [0.5, 0.0], [0.5, -0.2], [0.1, 0.3]];
    let points = corners.map(|[y, z]| Point::new(0.0, y, z));
    let path = Path::new([0.05, 0.1, 0.13, 0.2].into_iter().zip(points)).expect("a path");
    for name in METHODS {
        let mut solver = method(name, 10);
        // Led where the path turns, and let go.
        let mut pair = row(1, 0.1, 10.0, 1.0, Vector::x());
        pair.grab(0, path.clone());
        take(&mut pair, &mut *solver, 40, |pair| {
            let off = pair.positions()[0] - path.at(pair.elapsed_s());
            near(off.norm(), 0.0, 1e-14);
        });
        assert_eq!(pair.positions()[0], points[3], "{name}: the end");
        pair.release(0);
        take(&mut pair, &mut *solver, 10, |_| {});
        assert_ne!(pair.positions()[0], points[3], "{name}");
        // Pinned where it is while it moves; the other moves on.
        pair.state_mut().1.fill(Vector::y() * 2.0);
        take(&mut pair, &mut *solver, 5, |_| {});
        pair.hold(0);
        let pinned = pair.positions().to_vec();
        take(&mut pair, &mut *solver, 15, |pair| {
            assert_eq!(pair.positions()[0], pinned[0], "{name}");
        });
        assert_ne!(pair.positions()[1], pinned[1], "{name}");
    }
}

/// Contact takes the velocity into the body; what that was a step before is no reason to bounce.
#[test]
fn what_falls_on_a_plane_or_a_ball_stays_on_it() {
    let ground = Collider::plane(plane([0.0, 0.0, -0.3], Vector::z()));
    let ball = Collider::sphere(Point::new(0.0, 0.0, -1.0), 0.75);
    for (body, height) in [(ground, -0.3), (ball, -0.25)] {
        for name in METHODS {
            let mut weight = on_a_line([0.0], 1.0);
            weight
                .set_loads(onto(body.clone(), &gravity(0.0)))
                .expect("loads");
            let mut landed = false;
            take(&mut weight, &mut *method(name, 10), 200, |weight| {
                let z = weight.positions()[0].z;
                assert!(z > height - 1e-12, "{name}");
                assert!(!landed || z < height + 1e-12, "{name}");
                landed |= z < height + 1e-12;
            });
            assert!(landed && weight.velocities()[0].norm() < 1e-12, "{name}");
            assert!(weight.counters().collider_passes >= 200);
        }
    }
}

/// Led from rest by a steady acceleration a, a particle on a spring lags a/ω² (1 − cos ωt) behind.
#[test]
fn bdf2_with_a_led_particle_is_of_order_two() {
    let (a, k, end_s) = (4.0, 40.0, 0.5);
    let led = |t_s: f64| Point::new(0.5 * a * t_s * t_s, 0.0, 0.0);
    let errors = [256_u32, 512, 1024].map(|steps| {
        let dt_s = end_s / f64::from(steps);
        let times = (0..=steps).map(|step| f64::from(step) * dt_s);
        let path = Path::new(times.map(|t_s| (t_s, led(t_s)))).expect("a path");
        let mut pair = row(1, 0.1, k, 1.0, Vector::x());
        pair.grab(0, path);
        run(&mut pair, implicit(Method::Bdf2), dt_s, steps as usize);
        let omega2 = k / 0.1;
        let lag = a / omega2 * (1.0 - (omega2.sqrt() * end_s).cos());
        (pair.positions()[1].x - (1.0 + led(end_s).x - lag)).abs()
    });
    for i in 0..2 {
        near(order([errors[i], errors[i + 1]]), 2.0, 0.1);
    }
}

/// A vertex without a face has no mass, and stays where it is.
#[test]
fn a_vertex_without_a_face_stays_and_the_others_move() {
    let mesh = Mesh::build(4, &[[0, 1, 2]]).expect("a mesh");
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [5.0, 5.0, 5.0]];
    let positions = Positions::new(points.map(Point::from)).expect("positions");
    // The same without that vertex: what has no mass has no say in the tolerance.
    let alone = Mesh::build(3, &[[0, 1, 2]]).expect("a mesh");
    let three = Positions::new(positions.as_slice()[..3].iter().copied()).expect("positions");
    for fabric in [Fabric::new(10.0), Fabric::orthotropic(weave())] {
        for name in ["Euler", "BDF2"] {
            let fallen = |mesh: &Mesh, positions: &Positions| {
                let mut cloth = cloth(mesh, positions, fabric);
                cloth.system_mut().set_loads(gravity(0.0)).expect("loads");
                run_with(cloth.system_mut(), &mut *method(name, 1), 0.01, 10);
                cloth.positions().to_vec()
            };
            let four = fallen(&mesh, &positions);
            assert_eq!(four[3], Point::from([5.0; 3]), "{name}");
            assert_eq!(four[..3], fallen(&alone, &three), "{name}");
            assert!(four[1].z < -0.04, "{name}: it falls");
        }
    }
}

#[test]
fn a_step_of_nothing_does_nothing() {
    let mut empty = System::new([], vec![]).expect("no particles");
    for name in METHODS {
        run_with(&mut empty, &mut *method(name, 1), 0.01, 1);
    }
}

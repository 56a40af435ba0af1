//! What is held under the implicit solver: pins and paths, particles without mass, and changes from
//! outside, none of which the history of BDF2 may move.

use tearmesh::{Mesh, Point, Positions, Vector};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{Collider, Fabric, Loads, Path, System, Verlet};

use crate::parts::cloths::cloth;
use crate::parts::woven::weave;
use crate::parts::{gravity, implicit, on_a_line, particles, plane, run};

const METHODS: [Method; 2] = [Method::BackwardEuler, Method::Bdf2];

fn pair(stiffness_n_per_m: f64) -> System {
    let mut pair = on_a_line([0.0, 1.0], 0.1);
    let spring = pair.stretch([0, 1], 1.0, stiffness_n_per_m);
    spring.expect("a spring");
    pair
}

/// Steps of two lengths by turns.
fn uneven_s(step: u32) -> f64 {
    [0.01, 0.006][step as usize % 2]
}

#[test]
fn a_particle_that_moved_is_pinned_where_it_is() {
    for method in METHODS {
        let mut pair = pair(10.0);
        pair.state_mut().1.fill(Vector::new(0.0, 2.0, 0.0));
        let mut solver = implicit(method);
        for step in 0..5 {
            pair.step(&mut solver, uneven_s(step)).expect("a step");
        }
        pair.hold(0);
        let pinned = pair.positions()[0];
        for step in 5..20 {
            pair.step(&mut solver, uneven_s(step)).expect("a step");
            assert_eq!(pair.positions()[0], pinned, "{method:?}");
        }
        assert_ne!(pair.positions()[1].y, pinned.y, "the other moves on");
    }
}

#[test]
fn a_led_particle_is_on_its_path_also_where_that_turns() {
    let corners = [[0.0, 0.0], [0.5, 0.0], [0.5, -0.2], [0.1, 0.3]];
    let points = corners.map(|[y, z]| Point::new(0.0, y, z));
    let path = Path::new([0.05, 0.1, 0.13, 0.2].into_iter().zip(points)).expect("a path");
    for method in METHODS {
        let mut pair = pair(10.0);
        pair.grab(0, path.clone());
        let mut solver = implicit(method);
        let mut farthest = 0.0_f64;
        for step in 0..40 {
            pair.step(&mut solver, uneven_s(step)).expect("a step");
            let off = pair.positions()[0] - path.at(pair.elapsed_s());
            farthest = farthest.max(off.norm());
        }
        assert!(farthest < 1e-14, "{method:?}: {farthest} m");
        assert_eq!(pair.positions()[0], points[3], "{method:?}: the end");
    }
}

/// Led from rest by a steady acceleration a, a particle on a spring lags a/ω² (1 − cos ωt) behind.
#[test]
fn bdf2_with_a_led_particle_is_of_order_two() {
    let (a, k, end_s) = (4.0, 40.0, 0.5);
    let led = |t_s: f64| Point::new(0.5 * a * t_s * t_s, 0.0, 0.0);
    let errors = [128_u32, 256, 512, 1024].map(|steps| {
        let dt_s = end_s / f64::from(steps);
        let times = (0..=steps).map(|step| f64::from(step) * dt_s);
        let path = Path::new(times.map(|t_s| (t_s, led(t_s)))).expect("a path");
        let mut pair = pair(k);
        pair.grab(0, path);
        let mut solver = implicit(Method::Bdf2);
        for _ in 0..steps {
            pair.step(&mut solver, dt_s).expect("a step");
        }
        let omega2 = k / 0.1;
        let lag = a / omega2 * (1.0 - (omega2.sqrt() * end_s).cos());
        (pair.positions()[1].x - (1.0 + led(end_s).x - lag)).abs()
    });
    let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
    assert!(orders[1..].iter().all(|order| (order - 2.0).abs() < 0.1));
}

/// Contact takes the velocity into the floor; what that was a step before is no reason to bounce.
#[test]
fn what_lands_stays_on_the_floor() {
    for method in METHODS {
        let mut ball = particles([[0.0, 0.0, 0.1]], 1.0);
        let loads = Loads {
            colliders: vec![Collider::Plane(plane([0.0; 3], Vector::z()))],
            ..gravity(0.0)
        };
        ball.set_loads(loads).expect("loads");
        let mut solver = implicit(method);
        let (mut landed, mut highest) = (false, 0.0_f64);
        for step in 0..100 {
            ball.step(&mut solver, uneven_s(step)).expect("a step");
            let z = ball.positions()[0].z;
            landed |= z < 1e-12;
            highest = highest.max(if landed { z } else { 0.0 });
        }
        assert!(landed && highest < 1e-12, "{method:?}: {highest}");
        assert!(ball.velocities()[0].norm() < 1e-12, "{method:?}");
    }
}

/// A velocity from outside counts from then on, whatever it was before.
#[test]
fn what_is_stopped_or_thrown_goes_on_from_there() {
    for method in METHODS {
        let mut free = particles([[0.0; 3]], 0.1);
        free.state_mut().1[0] = Vector::new(0.0, 2.0, 0.0);
        let mut solver = implicit(method);
        for step in 0..5 {
            free.step(&mut solver, uneven_s(step)).expect("a step");
        }
        free.hold(0);
        free.release(0);
        let stopped = free.positions()[0];
        for step in 5..10 {
            free.step(&mut solver, uneven_s(step)).expect("a step");
        }
        let crept = (free.positions()[0] - stopped).norm();
        assert!(crept < 1e-15, "{method:?}: {crept}");

        let from = Point::new(3.0, 4.0, 5.0);
        let (x, v) = free.state_mut();
        (x[0], v[0]) = (from, Vector::new(1.0, 0.0, -1.0));
        free.step(&mut solver, 0.01).expect("a step");
        let flown = free.positions()[0] - from;
        let off = (flown - Vector::new(0.01, 0.0, -0.01)).norm();
        assert!(off < 1e-15, "{method:?}: {flown}");
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
    for fabric in [Fabric::new(10.0), Fabric::woven(weave())] {
        for method in METHODS {
            let fallen = |mesh: &Mesh, positions: &Positions| {
                let mut cloth = cloth(mesh, positions, fabric);
                cloth.system_mut().set_loads(gravity(0.0)).expect("loads");
                run(cloth.system_mut(), implicit(method), 0.01, 10);
                cloth.positions().to_vec()
            };
            let four = fallen(&mesh, &positions);
            assert_eq!(four[3], Point::from([5.0; 3]), "{method:?}");
            assert_eq!(four[..3], fallen(&alone, &three), "{method:?}");
            assert!(four[1].z < -0.04, "{method:?}: it falls");
        }
    }
}

#[test]
fn a_step_of_nothing_does_nothing() {
    let mut empty = System::new([], vec![]).expect("no particles");
    empty.step(&mut Verlet::new(), 0.01).expect("a step");
    for method in METHODS {
        let step = empty.step(&mut implicit(method), 0.01);
        step.unwrap_or_else(|error| panic!("{method:?}: {error}"));
    }
}

//! What is held under the implicit solver: pins and paths, particles without mass, and changes from
//! outside, none of which the history of BDF2 may move.

use tearmesh::{Masses, Mesh, Plane, Point, Positions, Vector};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{Cloth, Collider, Fabric, Loads, Path, System, Verlet, Weave};

use crate::parts::{gravity, implicit};

const METHODS: [Method; 2] = [Method::BackwardEuler, Method::Bdf2];

fn pair(stiffness_n_per_m: f64) -> System {
    let points = [Point::origin(), Point::new(1.0, 0.0, 0.0)];
    let mut pair = System::new(points, vec![0.1; 2]).expect("two particles");
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
        let mut farthest = 0.0_f64;
        for step in 5..20 {
            pair.step(&mut solver, uneven_s(step)).expect("a step");
            farthest = farthest.max((pair.positions()[0] - pinned).norm());
        }
        println!("{method:?}: the pin moves by up to {farthest} m");
        assert_eq!(pair.positions()[0], pinned, "{method:?}");
        assert_eq!(farthest, 0.0, "{method:?}");
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
        println!("{method:?}: off its path by up to {farthest:e} m");
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
    println!("errors {errors:?} m, orders {orders:.3?}");
    assert!(orders[1..].iter().all(|order| (order - 2.0).abs() < 0.1));
}

/// Contact takes the velocity into the floor; what that was a step before is no reason to bounce.
#[test]
fn what_lands_stays_on_the_floor() {
    for method in METHODS {
        let mut ball = System::new([Point::new(0.0, 0.0, 0.1)], vec![1.0]).expect("a particle");
        let floor = Plane::new(Point::origin(), Vector::z()).expect("a plane");
        let loads = Loads {
            colliders: vec![Collider::Plane(floor)],
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
        println!("{method:?}: it bounces by {highest} m");
        assert!(landed && highest < 1e-12, "{method:?}: {highest}");
        assert!(ball.velocities()[0].norm() < 1e-12, "{method:?}");
    }
}

/// A velocity from outside counts from then on, whatever it was before.
#[test]
fn what_is_stopped_or_thrown_goes_on_from_there() {
    for method in METHODS {
        let mut free = System::new([Point::origin()], vec![0.1]).expect("a particle");
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
        println!("{method:?}: stopped, it creeps by {crept} m");
        assert!(crept < 1e-15, "{method:?}: {crept}");

        let from = Point::new(3.0, 4.0, 5.0);
        let (x, v) = free.state_mut();
        (x[0], v[0]) = (from, Vector::new(1.0, 0.0, -1.0));
        free.step(&mut solver, 0.01).expect("a step");
        let flown = free.positions()[0] - from;
        let off = (flown - Vector::new(0.01, 0.0, -0.01)).norm();
        println!("{method:?}: thrown, it is off by {off} m");
        assert!(off < 1e-15, "{method:?}: {flown}");
    }
}

/// A vertex without a face has no mass, and stays where it is.
#[test]
fn a_vertex_without_a_face_stays_and_the_others_move() {
    let mesh = Mesh::build(4, &[[0, 1, 2]]).expect("a mesh");
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [5.0, 5.0, 5.0]];
    let positions = Positions::new(points.map(Point::from)).expect("positions");
    let masses = Masses::area(&mesh, &positions, 0.15).expect("an area");
    let weave = Weave {
        warp_n_per_m: 100.0,
        weft_n_per_m: 80.0,
        shear_n_per_m: 10.0,
        warp: Vector::x(),
    };
    for fabric in [Fabric::new(10.0), Fabric::woven(weave)] {
        for method in METHODS {
            let cloth = Cloth::new(&mesh, &positions, masses.clone(), fabric);
            let mut cloth = cloth.expect("a cloth");
            cloth.system_mut().set_loads(gravity(0.0)).expect("loads");
            let mut solver = implicit(method);
            for _ in 0..10 {
                let step = cloth.step(&mut solver, 0.01);
                step.unwrap_or_else(|error| panic!("{method:?}: {error}"));
            }
            assert_eq!(cloth.positions()[3], Point::from([5.0; 3]), "{method:?}");
            // The same without that vertex: what has no mass has no say in the tolerance.
            let alone = Mesh::build(3, &[[0, 1, 2]]).expect("a mesh");
            let three = Positions::new(positions.as_slice()[..3].iter().copied());
            let three = three.expect("positions");
            let masses = Masses::area(&alone, &three, 0.15).expect("an area");
            let mut other = Cloth::new(&alone, &three, masses, fabric).expect("a cloth");
            other.system_mut().set_loads(gravity(0.0)).expect("loads");
            let mut solver = implicit(method);
            for _ in 0..10 {
                other.step(&mut solver, 0.01).expect("a step");
            }
            assert_eq!(cloth.positions()[..3], *other.positions(), "{method:?}");
            assert!(cloth.positions()[1].z < -0.04, "{method:?}: it falls");
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

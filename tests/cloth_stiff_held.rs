//! What is held under the implicit solver: pins and paths, which the history of BDF2 may not move.

use tearmesh::cloth::implicit::{Method, Settings, Tolerance};
use tearmesh::cloth::{ImplicitCloth, Path, System};
use tearmesh::{Point, Vector};

const METHODS: [Method; 2] = [Method::BackwardEuler, Method::Bdf2];

fn implicit(method: Method, limit_m_per_s: f64) -> ImplicitCloth {
    ImplicitCloth::new(Settings {
        method,
        tolerance: Tolerance::Fixed(limit_m_per_s),
        ..Settings::default()
    })
}

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
        let mut solver = implicit(method, 1e-9);
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
        let mut solver = implicit(method, 1e-9);
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
        let mut solver = implicit(Method::Bdf2, 1e-12);
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

//! Solvers against answers that are known: closed forms, and statics by bisection.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use tearmesh::{Point, Vector};
use tearmesh_cloth::{
    Limiter, Pbd, Provot, Solver, System, Unstable, Verlet, Xpbd, force, frequency_bound,
};

use crate::parts::nets::{catenary, chain, framed, modulus, relaxed, row};
use crate::parts::vibration::{largest_frequency, stiffness_times};
use crate::parts::{G, gravity, mechanical_j, near, residual_n, run, strain_max, tension_n};
use crate::plain_verlet::PlainVerlet;
use crate::rk4::Rk4;

/// R1 in motion: one mass on a spring, released at 0.1 m from rest length.
fn oscillator() -> System {
    let mut system = row(1, 0.01, 40.0, 1.0, Vector::new(1.0, 0.0, 0.0));
    system.state_mut().0[1].x = 1.1;
    system
}

#[test]
fn r1_an_oscillator_has_the_discrete_frequency_of_its_method() {
    let omega = (40.0_f64 / 0.01).sqrt();
    near(omega, 63.245_553_203_367_6, 1e-12);
    let mut system = oscillator();
    near(frequency_bound(&mut system).omega_rad_per_s, omega, 1e-12);
    near(2.0 / omega, 0.031_622_776_601_683_8, 1e-16);

    let dt = 0.01;
    let z: f64 = omega * dt;
    let discrete = (1.0 - z * z / 2.0).acos() / dt;
    near(discrete / omega, 1.017_464_590_315_29, 1e-13);
    for i in 1..=200 {
        run(&mut system, Verlet::new(), dt, 1);
        let x = 0.1 * (discrete * dt * f64::from(i)).cos();
        near(system.positions()[1].x - 1.0, x, 1e-12);
    }

    // XPBD with one constraint is backward Euler: |x, v/ω| shrinks by 1/√(1 + z²) a step.
    let factor = 1.0 / (1.0 + z * z).sqrt();
    near(factor, 0.845_154_254_728_517, 1e-14);
    let mut system = oscillator();
    let mut size = 0.1;
    for _ in 0..30 {
        run(&mut system, Xpbd::new(1, 1), dt, 1);
        let (x, v) = (system.positions()[1].x - 1.0, system.velocities()[1].x);
        let now = (x * x + v * v / (omega * omega)).sqrt();
        near(now / size, factor, 1e-10);
        size = now;
    }
}

/// The relative error in state after 0.25 s.
fn oscillator_error(solver: impl Solver, dt: f64) -> f64 {
    let omega = 4000.0_f64.sqrt();
    let mut system = oscillator();
    run(&mut system, solver, dt, (0.25 / dt).round() as usize);
    let x = system.positions()[1].x - 1.0 - 0.1 * (omega * 0.25).cos();
    let v = system.velocities()[1].x / omega + 0.1 * (omega * 0.25).sin();
    (x * x + v * v).sqrt() / 0.1
}

#[test]
fn orders_of_convergence_are_those_of_theory() {
    let order = |solver: &mut dyn Solver, dt: f64| {
        let coarse = oscillator_error(&mut *solver, dt);
        let fine = oscillator_error(&mut *solver, dt / 2.0);
        (coarse / fine).log2()
    };
    let cases: [(&str, &mut dyn Solver, f64, f64); 4] = [
        ("Verlet", &mut Verlet::new(), 1.0 / 4096.0, 2.0),
        ("RK4", &mut Rk4::new(), 1.0 / 1024.0, 4.0),
        ("Provot", &mut Provot::unlimited(), 1.0 / 16384.0, 1.0),
        ("XPBD", &mut Xpbd::new(1, 1), 1.0 / 65536.0, 1.0),
    ];
    for (name, solver, dt, expected) in cases {
        let order = order(solver, dt);
        println!("{name}: order {order:.3}");
        near(order, expected, 0.2);
    }
}

#[test]
fn r2_a_chain_hangs_as_long_as_it_must() {
    let length = |n: f64, l: f64, m: f64, k: f64| n * l + m * G * n * (n + 1.0) / (2.0 * k);
    let answer = length(10.0, 0.1, 0.01, 50.0);
    near(answer, 1.107_91, 1e-15);
    let hang = |solver: &mut dyn Solver, dt: f64, drag: f64| {
        let mut chain = chain(drag);
        run(&mut chain, solver, dt, (30.0 / dt) as usize);
        -chain.positions()[10].z
    };
    for dt in [0.004, 0.008, 0.013] {
        near(hang(&mut Verlet::new(), dt, 4.0), answer, 1e-10);
        near(hang(&mut Provot::unlimited(), dt, 4.0), answer, 1e-10);
        near(hang(&mut Rk4::new(), dt, 4.0), answer, 1e-10);
    }
    for dt in [0.01, 1.0 / 60.0, 0.1] {
        near(hang(&mut Xpbd::new(1, 400), dt, 4.0), answer, 1e-9);
    }
    // The multipliers are the forces.
    let mut chain = chain(4.0);
    run(&mut chain, Xpbd::new(1, 400), 0.1, 300);
    for (i, id) in (0..10).map(|i| (i, chain.stretches().between(i, i + 1).expect("a spring"))) {
        let below = (10 - i) as f64;
        near(force::force_n(&chain, id), below * 0.01 * G, 1e-8);
        near(tension_n(&chain, id), below * 0.01 * G, 1e-8);
    }
    assert!(residual_n(Xpbd::default(), &chain) < 1e-8);
}

#[test]
fn r3_modes_of_a_chain() {
    let (n, m, k) = (31, 0.02, 1000.0_f64);
    let mode = |j: f64| 2.0 * (k / m).sqrt() * (j * PI / (2.0 * f64::from(n + 1))).sin();
    near(mode(1.0), 21.943_731_058_786, 1e-11);
    near(mode(31.0), 446.674_907_138_54, 1e-11);

    let mut system = row(32, m, k, 0.03, Vector::new(0.03, 0.0, 0.0));
    system.hold(32);
    near(largest_frequency(&system), mode(31.0), 1e-4);
    let bound = frequency_bound(&mut system).omega_rad_per_s;
    assert!(bound >= mode(31.0));
    near(bound, 447.213_595_499_958, 1e-9);

    // The first mode swings with the discrete frequency of Verlet.
    let dt = 0.9 * 2.0 / mode(31.0);
    for j in [1.0, 5.0] {
        let mut system = row(32, m, k, 0.03, Vector::new(0.03, 0.0, 0.0));
        system.hold(32);
        let shape = |i: usize| 1e-3 * (j * PI * i as f64 / 32.0).sin();
        for i in 1..32 {
            system.state_mut().0[i].x += shape(i);
        }
        let z = mode(j) * dt;
        let turn = (1.0 - z * z / 2.0).acos();
        for step in 1..=100 {
            run(&mut system, PlainVerlet::new(), dt, 1);
            let x = system.positions()[7].x - 0.21;
            near(x, shape(7) * (turn * f64::from(step)).cos(), 1e-12);
        }
    }

    // With one end free, the limit of the step.
    let free = row(31, m, k, 0.03, Vector::new(0.03, 0.0, 0.0));
    let omega = 2.0 * (k / m).sqrt() * ((2.0 * 31.0 - 1.0) * PI / (2.0 * 63.0)).sin();
    let limit = 2.0 / largest_frequency(&free);
    near(limit, 2.0 / omega, 1e-9);
    near(limit, 4.477_702_091_457_5e-3, 1e-9);
}

#[test]
fn r4_transverse_modes_of_a_string() {
    let (m, k, a, rest) = (0.02, 1000.0, 1.0 / 32.0_f64, 0.03);
    let mode = |j: f64| 2.0 * f64::sqrt(k * (a - rest) / (a * m)) * (j * PI / 64.0).sin();
    near(mode(1.0), 4.388_746_211_757_1, 1e-12);
    near(mode(2.0), 8.766_919_549_481_3, 1e-12);
    for j in [1.0, 2.0] {
        let mut string = row(32, m, k, rest, Vector::new(a, 0.0, 0.0));
        string.hold(32);
        let shape: Vec<Vector> = (0..=32)
            .map(|i| Vector::new(0.0, 0.0, (j * PI * f64::from(i) / 32.0).sin()))
            .collect();
        let product = stiffness_times(&string, &shape);
        let energy: f64 = shape.iter().zip(&product).map(|(u, p)| u.dot(p)).sum();
        let mass: f64 = shape.iter().map(|u| m * u.dot(u)).sum();
        near((energy / mass).sqrt(), mode(j), 1e-5);

        // In motion, with an amplitude that leaves the tension as it is.
        for (p, u) in string.state_mut().0.iter_mut().zip(&shape).take(32) {
            p.z = 1e-7 * u.z;
        }
        let dt = 0.002;
        run(&mut string, Rk4::new(), dt, 500);
        near(
            string.positions()[5].z / 1e-7,
            shape[5].z * mode(j).cos(),
            1e-6,
        );
    }
}

/// The period by the arithmetic–geometric mean.
fn period(angle: f64) -> f64 {
    let (mut a, mut b) = (1.0, (angle / 2.0).cos());
    for _ in 0..10 {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
    }
    2.0 * PI / (G.sqrt() * a)
}

#[test]
fn r5_a_pendulum_keeps_its_period() {
    near(period(FRAC_PI_4), 2.086_255_872_614_367, 1e-14);
    near(period(FRAC_PI_2), 2.367_841_947_576_237, 1e-14);
    // How long until the pendulum is at its turning point again.
    let measured = |solver: &mut dyn Solver, stiffness: f64, dt: f64, angle: f64| {
        let start = Vector::new(angle.sin(), 0.0, -angle.cos());
        let mut system = row(1, 1.0, stiffness, 1.0, start);
        system.set_loads(gravity(0.0)).expect("loads");
        let mut crossings = Vec::new();
        let mut last = system.positions()[1].x;
        while crossings.len() < 3 {
            run(&mut system, &mut *solver, dt, 1);
            let now = system.positions()[1].x;
            if (last < 0.0) != (now < 0.0) {
                crossings.push(system.elapsed_s() - dt * now / (now - last));
            }
            last = now;
        }
        crossings[2] - crossings[0]
    };
    // The rod is a spring: what its stiffness leaves is linear in 1/k, so two give the limit.
    for angle in [FRAC_PI_4, FRAC_PI_2] {
        let soft = measured(&mut Verlet::new(), 1e5, 5e-5, angle);
        let stiff = measured(&mut Verlet::new(), 2e5, 5e-5, angle);
        near(2.0 * stiff - soft, period(angle), 2e-6);
        near(
            measured(&mut Rk4::new(), 2e5, 1e-3, angle),
            period(angle),
            4e-4,
        );
        near(
            measured(&mut Pbd::new(1), 1.0, 1e-4, angle),
            period(angle),
            4e-3,
        );
        near(
            measured(&mut Xpbd::new(1, 1), 1e6, 1e-4, angle),
            period(angle),
            4e-3,
        );
    }
}

/// The smallest root of a growing function between two numbers.
fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// The sag of a symmetrical net of `n` links with the horizontal force `h`, and its span: link by
/// link from the middle, each as long as `length` says for its tension.
fn half_net(n: usize, mass: f64, h: f64, length: impl Fn(f64) -> f64) -> [f64; 2] {
    let (mut span, mut sag) = (0.0, 0.0);
    for i in 0..n / 2 {
        let v = mass * G * (i as f64 + 0.5);
        let tension = h.hypot(v);
        span += 2.0 * length(tension) * h / tension;
        sag += length(tension) * v / tension;
    }
    [span, sag]
}

#[test]
fn r6_a_chain_between_two_nails_hangs_in_a_catenary() {
    // R6a: 2 a sinh(1 / 2a) is the length, a (cosh(1 / 2a) − 1) the sag.
    for (length, answer) in [
        (1.5, 0.502_633_261_648_315_2),
        (1.2, 0.292_343_797_600_928_8),
    ] {
        let a = 1.0 / bisect(1e-3, 20.0, |b| 2.0 / b * (b / 2.0).sinh() - length);
        near(a * ((0.5 / a).cosh() - 1.0), answer, 1e-13);
    }
    // R6b: rigid links. PBD gets there.
    for (n, answer) in [(16, 0.503_908_189_207_115_7), (64, 0.502_712_302_986_202_4)] {
        let link = 1.5 / n as f64;
        let h = bisect(1e-6, 10.0, |h| half_net(n, 0.01, h, |_| link)[0] - 1.0);
        near(half_net(n, 0.01, h, |_| link)[1], answer, 1e-13);
    }
    let errors = [60.0, 240.0, 960.0].map(|rate| {
        let mut net = catenary(16, 0.01, 1.0, 1.5 / 16.0, 5.0);
        run(&mut net, Pbd::new(300), 1.0 / rate, (10.0 * rate) as usize);
        (-net.positions()[8].z - 0.503_908_189_207_115_7).abs()
    });
    println!("PBD at 60, 240 and 960 Hz: off by {errors:?} m");
    assert!(
        errors[0] > 4.0 * errors[1] && errors[1] > 4.0 * errors[2],
        "{errors:?}"
    );
    assert!(errors[2] < 2e-6, "{errors:?}");

    // R6c: elastic links, by every method with a physical stiffness.
    let stretched = |tension: f64| 0.08 + tension / 200.0;
    let h = bisect(1e-6, 10.0, |h| half_net(16, 0.01, h, stretched)[0] - 1.0);
    let sag = half_net(16, 0.01, h, stretched)[1];
    near(h, 0.441_288_464_343_035_3, 1e-12);
    near(sag, 0.390_722_835_980_581_3, 1e-12);
    let check = |solver: &mut dyn Solver, dt: f64| {
        let mut net = catenary(16, 0.01, 200.0, 0.08, 5.0);
        run(&mut net, solver, dt, (20.0 / dt) as usize);
        near(-net.positions()[8].z, sag, 1e-9);
        let first = net.stretches().between(0, 1).expect("a link");
        let d = net.positions()[1] - net.positions()[0];
        near(tension_n(&net, first) * d.x / d.norm(), h, 1e-9);
    };
    check(&mut Verlet::new(), 0.005);
    check(&mut Provot::unlimited(), 0.005);
    check(&mut Rk4::new(), 0.005);
    // XPBD gets there with small steps alone.
    let errors = [4, 16, 64].map(|substeps| {
        let mut net = catenary(16, 0.01, 200.0, 0.08, 5.0);
        run(&mut net, Xpbd::new(substeps, 10), 1.0 / 60.0, 1200);
        (-net.positions()[8].z - sag).abs()
    });
    println!("XPBD, 4, 16 and 64 substeps: off by {errors:?} m");
    assert!(
        errors[0] > 4.0 * errors[1] && errors[1] > 4.0 * errors[2],
        "{errors:?}"
    );
    assert!(errors[2] < 2e-6, "{errors:?}");
    // With ever more sweeps it does not: they converge, and to something else.
    let [some, more] = [500, 2000].map(|sweeps| {
        let mut net = catenary(16, 0.01, 200.0, 0.08, 5.0);
        let solver = Xpbd::new(1, sweeps);
        run(&mut net, solver, 1.0 / 60.0, 1200);
        (
            residual_n(solver, &net),
            (-net.positions()[8].z - sag).abs(),
        )
    });
    println!("XPBD, 500 and 2000 sweeps: residual and error {some:?}, {more:?}");
    assert!(more.0 < 1e-12 && (more.1 / some.1 - 1.0).abs() < 1e-6);
    assert!(more.1 > 1e-5, "{more:?}");
}

#[test]
fn r7_the_top_link_reaches_its_threshold_first_and_at_the_right_force() {
    let (n, m, rest, strain) = (10.0, 0.01, 0.1, 0.5);
    for (j, answer) in [(1.0, 1.519), (2.0, 1.8671), (3.0, 2.2152)] {
        let k = |j: f64| 50.0 * (1.0 + 0.1 * (j - 1.0));
        let force = k(j) * rest * strain - (n - j + 1.0) * m * G;
        near(force, answer, 1e-12);
        let mut masses = vec![m; 11];
        masses[10] += force / G;
        let points = (0..11).map(|i| Point::new(0.0, 0.0, -0.1 * f64::from(i)));
        let mut chain = System::new(points, masses).expect("particles");
        for i in 0..10 {
            let stiffness = if answer == 1.519 {
                50.0
            } else {
                k(i as f64 + 1.0)
            };
            chain
                .stretch([i, i + 1], rest, stiffness)
                .expect("a spring");
        }
        chain.hold(0);
        chain.set_loads(gravity(3.0)).expect("loads");
        run(&mut chain, Verlet::new(), 0.01, 8000);
        let link = j as usize - 1;
        let id = chain.stretches().between(link, link + 1).expect("a link");
        near(chain.stretch_ratio(id), 1.0 + strain, 1e-9);
        let other = |i: usize| chain.stretches().between(i, i + 1).expect("a link");
        assert!((1..10).all(|i| chain.stretch_ratio(other(i)) < chain.stretch_ratio(other(i - 1))));
        if link == 0 {
            let released = 0.5 * tension_n(&chain, id) * strain * rest;
            near(released, 0.0625, 1e-9);
        }
    }
}

#[test]
fn r8_the_modulus_of_a_net() {
    let k = 1000.0;
    let height = 0.75_f64.sqrt();
    let [xx, yy, xy, ..] = modulus(height, &[[1.0, 0.0], [0.5, height], [-0.5, height]], k);
    near(xx, yy, 1e-5);
    near((xx * xx - xy * xy) / xx, 1_154.700_538_379_25, 1e-5);
    near(xy / xx, 1.0 / 3.0, 1e-8);

    // One diagonal: pulling shears, by as much; across nothing happens.
    let [xx, yy, xy, ss, xs] = modulus(1.0, &[[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]], k);
    near(xx, yy, 1e-5);
    // Free of stress but σ_x = 1: solve for the strains by Cramer's rule.
    let ys = xs;
    let det = xx * (yy * ss - ys * ys) - xy * (xy * ss - ys * xs) + xs * (xy * ys - yy * xs);
    let ex = (yy * ss - ys * ys) / det;
    let ey = (ys * xs - xy * ss) / det;
    let es = (xy * ys - yy * xs) / det;
    near(1.0 / ex, k, 1e-5);
    near(ey / ex, 0.0, 1e-8);
    near(es / ex, -1.0, 1e-8);
}

/// Two triangles, flat, falling.
fn falling() -> System {
    let points = [[0.0, 0.0], [0.25, 0.0], [0.25, 0.5], [0.0, 0.5]];
    let points = points.map(|[x, y]| Point::new(x, y, 0.0));
    let mut sheet = System::new(points, vec![0.1, 0.2, 0.3, 0.4]).expect("particles");
    for [a, b] in [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]] {
        let rest = (points[b] - points[a]).norm();
        sheet.stretch([a, b], rest, 100.0).expect("a spring");
    }
    sheet.set_loads(gravity(0.0)).expect("loads");
    sheet
}

#[test]
fn r9_free_fall_is_that_of_the_method_and_strains_nothing() {
    let check = |solver: &mut dyn Solver, answer: f64| {
        let mut sheet = falling();
        run(&mut sheet, solver, 1.0 / 60.0, 60);
        for p in sheet.positions() {
            near(p.z, answer, 1e-12);
        }
        assert!(strain_max(&sheet) < 1e-12, "{}", strain_max(&sheet));
    };
    check(&mut Verlet::new(), -4.905);
    check(&mut Rk4::new(), -4.905);
    check(&mut Provot::default(), -4.986_75);
    check(&mut Pbd::new(3), -4.986_75);
    check(&mut Xpbd::new(1, 3), -4.986_75);
}

#[test]
fn r10_a_rotating_pair_keeps_its_radius_and_energy() {
    let r = 100.0 / 190.0;
    let energy = 0.1 * (10.0_f64 * r).powi(2) + 50.0 * (2.0_f64 * r - 1.0).powi(2);
    near(r, 0.526_315_789_473_684_2, 1e-15);
    near(energy, 2.908_587_257_617_729, 1e-14);
    let check = |solver: &mut dyn Solver, dt: f64, drift: f64| {
        let points = [Point::new(-r, 0.0, 0.0), Point::new(r, 0.0, 0.0)];
        let mut pair = System::new(points, vec![0.1; 2]).expect("particles");
        pair.stretch([0, 1], 1.0, 100.0).expect("a spring");
        let speeds = pair.state_mut().1;
        speeds[0].y = -10.0 * r;
        speeds[1].y = 10.0 * r;
        run(&mut pair, solver, dt, (5.0 / dt).round() as usize);
        let d = pair.positions()[1] - pair.positions()[0];
        near(d.norm() / 2.0, r, drift);
        near(mechanical_j(&pair), energy, 10.0 * drift);
        assert!((pair.velocities()[0] + pair.velocities()[1]).norm() < 1e-12);
    };
    check(&mut Verlet::new(), 2e-4, 2e-6);
    check(&mut Rk4::new(), 1e-3, 1e-9);
    check(&mut Provot::unlimited(), 1e-4, 1e-3);
    check(&mut Xpbd::new(1, 1), 1e-6, 1e-2);
}

#[test]
fn r11_a_static_drape_is_the_same_by_independent_methods() {
    let drape = |solver: &mut dyn Solver, dt: f64| {
        let mut net = framed(6, 100.0, 8.0);
        run(&mut net, solver, dt, (15.0 / dt) as usize);
        net.positions().to_vec()
    };
    let verlet = drape(&mut Verlet::new(), 0.005);
    let rk4 = drape(&mut Rk4::new(), 0.01);
    let relaxed = relaxed(&framed(6, 100.0, 8.0));
    for (a, (b, c)) in verlet.iter().zip(relaxed.iter().zip(&rk4)) {
        assert!(
            (a - b).norm() < 1e-9 && (a - c).norm() < 1e-9,
            "{a} {b} {c}"
        );
    }
    // XPBD gets there with small steps alone.
    let off = |xpbd: Vec<Point>| {
        let distances = verlet.iter().zip(&xpbd).map(|(a, b)| (a - b).norm());
        distances.fold(0.0, f64::max)
    };
    let errors = [1, 4, 16].map(|substeps| off(drape(&mut Xpbd::new(substeps, 20), 0.02)));
    println!("XPBD, 1, 4 and 16 substeps: off by {errors:?} m");
    assert!(
        errors[0] > 4.0 * errors[1] && errors[1] > 4.0 * errors[2],
        "{errors:?}"
    );
    assert!(errors[2] < 1e-4, "{errors:?}");
    assert!(verlet[24].z < -0.005, "it sags: {}", verlet[24]);
}

#[test]
fn what_is_not_named_costs_nothing() {
    let mut chain = chain(0.0);
    chain.when_unstable(Unstable::Allow);
    run(&mut chain, Verlet::new(), 0.001, 10);
    let counted = chain.counters();
    assert_eq!((counted.force_evaluations, counted.substeps), (11, 10));
    assert_eq!((counted.wind_evaluations, counted.collider_passes), (0, 0));
    assert_eq!((counted.visits.project, counted.matrix_products), (0, 0));
    run(&mut chain, Rk4::new(), 0.001, 10);
    assert_eq!(chain.counters().force_evaluations, 11 + 40);
    run(&mut chain, Pbd::new(7), 0.001, 10);
    run(&mut chain, Xpbd::new(2, 3), 0.001, 10);
    assert_eq!(chain.counters().visits.project, 10 * 10 * (7 + 6));
    assert_eq!(chain.counters().force_evaluations, 11 + 40);
    run(&mut chain, Provot::new(Limiter::default()), 0.001, 10);
    assert_eq!(chain.counters().force_evaluations, 11 + 40 + 10);
    assert_eq!(chain.counters().matrix_products, 0);
}

//! Where an answer is known, it is met: R1 to R4, R6c, R8 to R10 of the reference answers.

use super::dense::{jacobian, solve};
use super::{Scene, Triangle, damping, forces, rest, spring, step};
use crate::parts::{G, implicit, mechanical_j};
use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{System, force};

/// R1: m = .01 kg on k = 40 N/m, along its axis.
fn oscillator() -> Scene {
    let mut scene = Scene::chain(1, 0.01, 40.0, 1.0);
    scene.gravity = Vector::zeros();
    scene.x[1].z -= 0.125;
    scene
}

/// √(v² + ω² u²) of the oscillator.
fn amplitude(system: &System) -> f64 {
    let (v, u) = (system.velocities()[1].z, system.positions()[1].z + 1.0);
    (v * v + 40.0 / 0.01 * u * u).sqrt()
}

#[test]
fn r1_backward_euler_damps_an_oscillator_by_the_closed_form() {
    // For this linear system the amplitude falls by 1/√(1 + z²) in every step.
    let mut system = oscillator().system();
    let mut solver = implicit(Method::BackwardEuler);
    for turn in 0..60 {
        let before = amplitude(&system);
        step(&mut system, &mut solver, 0.01).expect("a step");
        let factor = amplitude(&system) / before;
        let exact = 0.845_154_254_728_517;
        assert!((factor - exact).abs() < 1e-11, "step {turn}: {factor}");
    }
    let factor = damping(Method::BackwardEuler, 63.245_553_203_367_6 * 0.01);
    assert!((factor - 0.845_154_254_728_517).abs() < 1e-15, "{factor}");
}

#[test]
fn r1_bdf2_damps_an_oscillator_by_the_root_of_its_polynomial() {
    let omega = 63.245_553_203_367_6;
    let mut system = oscillator().system();
    let mut solver = implicit(Method::Bdf2);
    let mut sizes = Vec::new();
    for _ in 0..80 {
        sizes.push(amplitude(&system));
        step(&mut system, &mut solver, 0.005).expect("a step");
    }
    // The other root dies out at once (its modulus is about 1/3).
    let factor = (sizes[79] / sizes[49]).powf(1.0 / 30.0);
    let closed = damping(Method::Bdf2, omega * 0.005);
    println!("BDF2 factor {factor}, closed form {closed}");
    assert!((factor - closed).abs() < 1e-12, "{factor} {closed}");
}

#[test]
fn r2_a_hanging_chain_has_its_length_at_every_time_step() {
    let mut scene = Scene::chain(10, 0.01, 50.0, 0.1);
    let length = |system: &System| -system.positions()[10].z;
    for method in [Method::BackwardEuler, Method::Bdf2] {
        for (time_step, steps) in [(1.0, 60), (0.1, 200), (1.0 / 60.0, 600), (1e-3, 5000)] {
            let hanging = Scene {
                drag: 20.0,
                ..scene.clone()
            };
            let mut system = hanging.system();
            let mut solver = implicit(method);
            for _ in 0..steps {
                step(&mut system, &mut solver, time_step).expect("a step");
            }
            let length = length(&system);
            assert!(
                (length - 1.10791).abs() < 1e-10,
                "{method:?} {time_step}: {length}"
            );
        }
    }
    let mut system = scene.system();
    rest(&mut system, 1e-11);
    assert!(
        (length(&system) - 1.10791).abs() < 1e-11,
        "{}",
        length(&system)
    );
    // And from far off: folded up sideways.
    for (i, x) in scene.x.iter_mut().enumerate().skip(1) {
        *x = Point::new(0.03 * i as f64, if i % 2 == 0 { 0.05 } else { 0.0 }, 0.01);
    }
    let mut system = scene.system();
    rest(&mut system, 1e-11);
    assert!(
        (length(&system) - 1.10791).abs() < 1e-11,
        "{}",
        length(&system)
    );
}

/// 31 particles between two pins, pitch a, springs of rest length l0.
fn strung(pitch: f64, rest_length: f64) -> Scene {
    let points = (0..33).map(|i| [pitch * f64::from(i), 0.0, 0.0]);
    let mut scene = Scene::particles(points, 0.02);
    scene.springs = (0..32)
        .map(|i| spring(i, i + 1, rest_length, 1000.0))
        .collect();
    scene.held[0] = true;
    scene.held[32] = true;
    scene
}

/// ω of the mode sin(j π i / 32), from the product of the matrix and the mode.
fn frequency(scene: &Scene, axis: Vector, j: u32) -> f64 {
    let hessian = jacobian(&scene.system());
    let shape = |i: usize| (f64::from(j) * std::f64::consts::PI * i as f64 / 32.0).sin();
    let c = if axis == Vector::x() { 0 } else { 2 };
    let (mut above, mut below) = (0.0, 0.0);
    for i in 1..32 {
        let force: f64 = (1..32)
            .map(|k| hessian[3 * k + c][3 * i + c] * shape(k))
            .sum();
        above += shape(i) * force;
        below += 0.02 * shape(i) * shape(i);
    }
    // Rayleigh's quotient alone would also be right for what is no mode.
    let omega2: f64 = above / below;
    for i in 1..32 {
        let force: f64 = (1..32)
            .map(|k| hessian[3 * k + c][3 * i + c] * shape(k))
            .sum();
        assert!(
            (force - omega2 * 0.02 * shape(i)).abs() < 1e-5,
            "mode {j} at {i}"
        );
    }
    omega2.sqrt()
}

#[test]
fn r3_and_r4_modes_of_a_chain_and_of_a_string() {
    let pitch = 1.0 / 32.0;
    let along = strung(pitch, pitch);
    for j in 1..32 {
        let closed = 2.0 * 50_000.0_f64.sqrt() * (f64::from(j) * std::f64::consts::PI / 64.0).sin();
        let omega = frequency(&along, Vector::x(), j);
        assert!((omega / closed - 1.0).abs() < 1e-7, "{j}: {omega} {closed}");
    }
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-7;
    assert!(near(frequency(&along, Vector::x(), 1), 21.943_731_058_786));
    assert!(near(frequency(&along, Vector::x(), 31), 446.674_907_138_54));
    let across = strung(pitch, 0.03);
    assert!(near(
        frequency(&across, Vector::z(), 1),
        4.388_746_211_757_1
    ));
    assert!(near(
        frequency(&across, Vector::z(), 2),
        8.766_919_549_481_3
    ));
}

#[test]
fn r6c_elastic_links_between_two_pins() {
    let points = (0..17).map(|i| [f64::from(i) / 16.0, 0.0, 0.0]);
    let mut scene = Scene::particles(points, 0.01);
    scene.springs = (0..16).map(|i| spring(i, i + 1, 0.08, 200.0)).collect();
    scene.gravity = Vector::new(0.0, 0.0, -G);
    scene.held[0] = true;
    scene.held[16] = true;
    let mut system = scene.system();
    rest(&mut system, 1e-11);
    let sag = system.positions()[8].z;
    assert!((sag + 0.390_722_835_980_581_3).abs() < 1e-10, "sag {sag}");
    let pull = -force::reaction_n(&system, 0).x;
    assert!(
        (pull - 0.441_288_464_343_035_3).abs() < 1e-10,
        "pull {pull}"
    );
}

/// The stiffness per area of a patch against strain (εx, εy, γ), from the matrix and affine
/// displacements: [C11, C12, C13; C21, …].
fn moduli(scene: &Scene, area: f64) -> [[f64; 3]; 3] {
    let hessian = jacobian(&scene.system());
    let strain = |mode: usize| -> Vec<f64> {
        let of = |p: &Point| match mode {
            0 => [p.x, 0.0, 0.0],
            1 => [0.0, p.y, 0.0],
            _ => [0.5 * p.y, 0.5 * p.x, 0.0],
        };
        scene.x.iter().flat_map(of).collect()
    };
    [0, 1, 2].map(|a| {
        [0, 1, 2].map(|b| {
            let (a, b) = (strain(a), strain(b));
            let rows = hessian.iter().zip(&a);
            let sum = rows.map(|(row, a)| a * row.iter().zip(&b).map(|(h, b)| h * b).sum::<f64>());
            sum.sum::<f64>() / area
        })
    })
}

/// `E_x`, ν and γ / εx under tension along x.
fn under_tension(c: [[f64; 3]; 3]) -> [f64; 3] {
    let strain = solve(c.map(Vec::from).to_vec(), vec![1.0, 0.0, 0.0]);
    [
        1.0 / strain[0],
        -strain[1] / strain[0],
        strain[2] / strain[0],
    ]
}

#[test]
fn r8_moduli_of_nets_and_of_the_triangle() {
    // One triangle carries half of each spring at its edges.
    let height = 0.75f64.sqrt();
    let mut net = Scene::particles([[0.0; 3], [1.0, 0.0, 0.0], [0.5, height, 0.0]], 1.0);
    net.springs = [[0, 1], [1, 2], [2, 0]]
        .map(|[a, b]| spring(a, b, 1.0, 500.0))
        .to_vec();
    let [e, nu, coupling] = under_tension(moduli(&net, 0.5 * height));
    println!("equilateral net: E {e}, nu {nu}, coupling {coupling}");
    assert!((e - 1_154.700_538_379_25).abs() < 1e-5, "{e}");
    assert!((nu - 1.0 / 3.0).abs() < 1e-8 && coupling.abs() < 1e-8);

    // A cell with one diagonal; its sides are shared with the neighbours.
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let mut net = Scene::particles(corners, 1.0);
    net.springs = [[0, 1], [2, 3], [0, 2], [1, 3]]
        .map(|[a, b]| spring(a, b, 1.0, 500.0))
        .to_vec();
    net.springs.push(spring(0, 3, 2.0f64.sqrt(), 1000.0));
    let [e, nu, coupling] = under_tension(moduli(&net, 1.0));
    println!("right-triangle net: E {e}, nu {nu}, coupling {coupling}");
    assert!((e - 1000.0).abs() < 1e-5 && nu.abs() < 1e-8 && (coupling + 1.0).abs() < 1e-8);

    // The triangle's own: k_u, k_v and k_s, whatever its shape and size.
    let material = [[0.3, 0.1], [0.9, -0.2], [0.5, 0.7]];
    let mut one = Scene::particles(material.map(|[u, v]| [u, v, 0.0]), 1.0);
    one.triangles.push(Triangle {
        corners: [0, 1, 2],
        material,
        stiffness: [1000.0, 300.0, 70.0],
    });
    let [_, b, c] = [0, 1, 2].map(|i| [0, 1].map(|j| material[i][j] - material[0][j]));
    let c = moduli(&one, 0.5 * (b[0] * c[1] - b[1] * c[0]));
    let truth = [[1000.0, 0.0, 0.0], [0.0, 300.0, 0.0], [0.0, 0.0, 70.0]];
    for (c, truth) in c.iter().flatten().zip(truth.iter().flatten()) {
        assert!((c - truth).abs() < 1e-6, "{c} {truth}");
    }
    // And at any strain: pulled to λ, a width of one carries k_u (λ − 1).
    let mut sheet = Scene::sheet(3, 1.0, [1000.0, 300.0, 70.0]);
    for p in &mut sheet.x {
        p.x *= 1.7;
    }
    let forces = forces(&mut sheet.system());
    let pull: f64 = (0..16).filter(|i| i % 4 == 0).map(|i| forces[i].x).sum();
    assert!((pull - 700.0).abs() < 1e-10, "{pull}");
}

#[test]
fn r9_free_fall_is_the_sum_of_the_steps_and_strains_nothing() {
    for method in [Method::BackwardEuler, Method::Bdf2] {
        let mut scene = Scene::sheet(4, 0.01, [1000.0, 1000.0, 100.0]);
        scene.springs.push(spring(0, 1, 0.25, 500.0));
        scene.gravity = Vector::new(0.0, 0.0, -G);
        let mut system = scene.system();
        let mut solver = implicit(method);
        for _ in 0..60 {
            step(&mut system, &mut solver, 1.0 / 60.0).expect("a step");
        }
        let x = system.positions();
        for (now, then) in x.iter().zip(&scene.x) {
            assert!((now.x - then.x).abs() < 1e-12 && (now.y - then.y).abs() < 1e-12);
            assert!((now.z - x[0].z).abs() < 1e-12, "strain");
            // BDF2 is exact for a parabola but for its first step, which is Euler's.
            match method {
                Method::BackwardEuler => assert!((now.z + 4.986_75).abs() < 1e-11, "{}", now.z),
                Method::Bdf2 => assert!((now.z + 4.905).abs() < 0.003, "{}", now.z),
            }
        }
        println!("R9 {method:?}: {}", x[0].z);
    }
}

#[test]
fn r10_a_rotating_pair_keeps_its_distance() {
    // Both particles circle at radius r where the spring balances: k (2r − 1) = m ω² r.
    let r = 0.526_315_789_473_684_2;
    let run = |steps: u32| {
        let mut scene = Scene::particles([[-r, 0.0, 0.0], [r, 0.0, 0.0]], 0.1);
        scene.springs.push(spring(0, 1, 1.0, 100.0));
        scene.v = vec![
            Vector::new(0.0, -10.0 * r, 0.0),
            Vector::new(0.0, 10.0 * r, 0.0),
        ];
        let mut system = scene.system();
        assert!((forces(&mut system)[0].x - 0.1 * 100.0 * r).abs() < 1e-13);
        let start = mechanical_j(&system);
        assert!((start - 2.908_587_257_617_729).abs() < 1e-14, "{start}");
        let mut solver = implicit(Method::Bdf2);
        for _ in 0..steps {
            step(&mut system, &mut solver, 0.5 / f64::from(steps)).expect("a step");
        }
        let x = system.positions();
        let distance = ((x[1] - x[0]).norm() / 2.0 - r).abs();
        [distance, (mechanical_j(&system) - start).abs()]
    };
    let (coarse, fine) = (run(2000), run(4000));
    println!("R10: {coarse:?} {fine:?}");
    assert!(fine[0] < 1e-5 && fine[1] < 1e-4);
    assert!(
        fine[0] < 0.3 * coarse[0] && fine[1] < 0.3 * coarse[1],
        "order two at least"
    );
}

//! What is stored, put in and lost, method by method, against answers on paper.

use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit::{self, Settings, Tolerance};
use tearmesh_cloth::scene::{Frame, HeldVertices, Method, Region, Scene};
use tearmesh_cloth::{
    Balance, Implicit, Loads, Path, Pbd, Provot, Solver, System, Verlet, Xpbd, carried_count,
};

use crate::parts::scenes::{play, staged};

/// Methods whose springs have the stiffness that they were given, and PBD, whose have not.
fn methods() -> [(&'static str, Box<dyn Solver>); 6] {
    let by = |method| {
        Implicit::new(Settings {
            method,
            tolerance: Tolerance::Fixed(1e-9),
            ..Settings::default()
        })
    };
    [
        ("verlet", Box::new(Verlet::new())),
        ("provot", Box::new(Provot::unlimited())),
        ("xpbd", Box::new(Xpbd::new(1, 1))),
        (
            "backward Euler",
            Box::new(by(implicit::Method::BackwardEuler)),
        ),
        ("bdf2", Box::new(by(implicit::Method::Bdf2))),
        ("pbd", Box::new(Pbd::default())),
    ]
}

/// Links of 100 N/m and a metre in a row, a kilogram at each joint; held at one end, and led away
/// by `by_m` metres at the other within `within_s` seconds.
fn drawn(links: usize, by_m: f64, within_s: f64) -> System {
    weighted(vec![1.0; links + 1], by_m, within_s)
}

/// Links of 100 N/m and a metre in a row, with these kilograms at the joints; held at one end, and
/// led away at the other.
fn weighted(masses: Vec<f64>, by_m: f64, within_s: f64) -> System {
    let links = masses.len() - 1;
    let points = (0..=links).map(|i| Point::new(i as f64, 0.0, 0.0));
    let mut chain = System::new(points, masses).expect("a chain");
    for i in 0..links {
        chain.stretch([i, i + 1], 1.0, 100.0).expect("a link");
    }
    chain.hold(0);
    let end = links as f64;
    let way = [
        (0.0, Point::new(end, 0.0, 0.0)),
        (within_s, Point::new(end + by_m, 0.0, 0.0)),
    ];
    chain.grab(links, Path::new(way).expect("a path"));
    chain
}

/// N springs in a row are one of k/N.
#[test]
fn a_chain_drawn_slowly_stores_half_k_x_squared_over_n() {
    for (name, mut solver) in methods() {
        if name == "pbd" {
            continue; // Its springs have no stiffness of their own.
        }
        let (links, by_m, dt_s) = (10, 1.5, 0.01);
        let mut chain = drawn(links, by_m, 60.0);
        let drag_per_s = Some(0.5);
        let loads = Loads {
            drag_per_s,
            ..Loads::default()
        };
        chain.set_loads(loads).expect("drag");
        let mut kept = Balance::new(&mut chain);
        for _ in 0..9000 {
            chain
                .step_observed(&mut *solver, dt_s, &mut kept)
                .expect("a step");
        }
        let balance = kept.now(&chain, 0.0);
        let stored_j = 0.5 * 100.0 * by_m * by_m / links as f64;
        println!("{name}: {stored_j} J, {balance:?}");
        let part = balance.elastic_j / stored_j;
        assert!((part - 1.0).abs() < 0.005, "{name}: {part} is stored");
        // The hand gave that, and what drag took.
        let given = (balance.held_j + balance.drag_j) / stored_j;
        // One sweep of XPBD pulls less than the springs are long.
        let margin = if name == "xpbd" { 0.02 } else { 0.005 };
        assert!((given - 1.0).abs() < margin, "{name}: {given} was given");
    }
}

/// What nobody but hands moves costs them what it stores, by every method.
#[test]
fn an_edge_between_two_who_are_held_takes_from_the_hand_what_it_stores() {
    for (name, mut solver) in methods() {
        let mut pair = drawn(1, 1.2, 0.5);
        let mut kept = Balance::new(&mut pair);
        for _ in 0..1000 {
            pair.step_observed(&mut *solver, 0.001, &mut kept)
                .expect("a step");
        }
        let balance = kept.now(&pair, 0.0);
        assert!(
            (balance.elastic_j - 72.0).abs() < 1e-9,
            "{name}: {balance:?}"
        );
        // Those who move by the force at the end take a step's share more.
        let given = balance.held_j / 72.0;
        assert!((given - 1.0).abs() < 0.005, "{name}: {given} was given");
        // And that share is what the method says it took, where it says.
        let left_j = balance.method_j.map_or(0.0, |_| balance.remainder_j());
        assert!(left_j.abs() < 1e-6, "{name}: {left_j} J of {balance:?}");
    }
}

/// A kilogram on a spring of 100 N/m that is drawn out by a tenth of a metre, and its steps by hand: what
/// a method makes of the energy ½ v² + 50 x² of a state (x, v), as its identity says.
#[test]
fn each_method_says_what_it_makes_of_a_swing() {
    type Step = fn(&mut [[f64; 2]; 2], f64) -> f64;
    let k = 100.0;
    let energy = |[x, v]: [f64; 2]| 0.5 * (v * v + k * x * x);
    // Each takes the last two states on, and says what was made.
    let verlet: Step = |states, dt| {
        let [x, v] = states[1];
        let half = v - 50.0 * dt * x;
        let next = x + dt * half;
        *states = [states[1], [next, half - 50.0 * dt * next]];
        // Δt²/8 m a²
        dt * dt / 8.0 * 1e4 * (next * next - x * x)
    };
    let euler: Step = |states, dt| {
        let [x, v] = states[1];
        let faster = (v - 100.0 * dt * x) / (1.0 + 100.0 * dt * dt);
        let next = [x + dt * faster, faster];
        *states = [states[1], next];
        -0.5 * (faster - v).powi(2) - 50.0 * (next[0] - x).powi(2)
    };
    // (3 y₂ − 4 y₁ + y₀)/2 = Δt y₂′; the G-norm ¼ (y₁² + (2y₁ − y₀)²) loses ¼ (y₂ − 2y₁ + y₀)².
    let bdf2: Step = |states, dt| {
        let [[x0, v0], [x1, v1]] = *states;
        let (h, x, v) = (2.0 * dt / 3.0, (4.0 * x1 - x0) / 3.0, (4.0 * v1 - v0) / 3.0);
        let v2 = (v - 100.0 * h * x) / (1.0 + 100.0 * h * h);
        let x2 = x + h * v2;
        *states = [[x1, v1], [x2, v2]];
        let norm = |b: f64, a: f64| 0.25 * (b * b + (2.0 * b - a).powi(2));
        let kept = |b: f64, a: f64| norm(b, a) - 0.5 * b * b;
        let lost =
            |c: f64, b: f64, a: f64| -0.25 * (c - 2.0 * b + a).powi(2) - kept(c, b) + kept(b, a);
        lost(v2, v1, v0) + 100.0 * lost(x2, x1, x0)
    };
    // Rigid: at rest length after any step.
    let pbd: Step = |states, dt| {
        let [x, v] = states[1];
        *states = [states[1], [0.0, -x / dt]];
        0.5 * (x / dt).powi(2) - 0.5 * v * v - 50.0 * x * x
    };
    for (name, mut solver) in methods() {
        let by_hand = match name {
            "verlet" => verlet,
            "backward Euler" | "xpbd" => euler,
            "bdf2" => bdf2,
            "pbd" => pbd,
            _ => continue,
        };
        let mut swing = System::new([Point::origin(), Point::new(1.1, 0.0, 0.0)], vec![1.0; 2])
            .expect("two particles");
        swing.stretch([0, 1], 1.0, k).expect("a spring");
        swing.hold(0);
        let mut kept = Balance::new(&mut swing);
        let (mut states, mut made) = ([[0.1, 0.0]; 2], 0.0);
        for step in 0..60 {
            let by_hand = if name == "bdf2" && step == 0 {
                euler
            } else {
                by_hand
            };
            made += by_hand(&mut states, 0.02);
            swing
                .step_observed(&mut *solver, 0.02, &mut kept)
                .expect("a step");
            let balance = kept.now(&swing, 0.0);
            let said = balance.method_j.expect("joules");
            let scale = 1.0 + made.abs();
            assert!(
                (said - made).abs() < 1e-7 * scale,
                "{name} {step}: {said} {made}"
            );
            let there = energy(states[1]);
            let is_there = balance.kinetic_j + balance.elastic_j;
            assert!((is_there - there).abs() < 1e-7 * scale, "{name} {step}");
            assert!(balance.remainder_j().abs() < 1e-7 * scale, "{name} {step}");
        }
        println!("{name}: {made} J");
    }
}

#[test]
fn provot_says_nothing_and_a_silent_step_is_not_taken_for_none() {
    let mut chain = drawn(3, 0.2, 1.0);
    let mut kept = Balance::new(&mut chain);
    for (solver, is_said) in [
        (&mut Verlet::new() as &mut dyn Solver, true),
        (&mut Provot::default(), false),
        (&mut Verlet::new(), false),
    ] {
        chain
            .step_observed(solver, 0.01, &mut kept)
            .expect("a step");
        let balance = kept.now(&chain, 0.0);
        assert_eq!(balance.method_j.is_some(), is_said);
        let rest = balance.made_j() - balance.method_j.unwrap_or(0.0);
        assert_eq!(balance.remainder_j(), rest);
    }
}

/// What is left at steps as users get them, and at half of those, in parts of what was put in.
fn left(cells: u32, scene: fn(&Frame) -> Scene, solver: &Method) -> [f64; 2] {
    let with = |frame: &Frame, step_s| Scene {
        solver: solver.clone(),
        step_s,
        ..scene(frame)
    };
    let own = staged(cells, |frame| with(frame, None));
    [1.0, 0.5].map(|part| {
        let step_s = Some(own.step_s() * part);
        let balance = play(staged(cells, |frame| with(frame, step_s))).energy_balance();
        assert!(balance.method_j.is_some());
        balance.remainder_j() / balance.put_in_j()
    })
}

#[test]
fn next_to_nothing_is_left_in_the_scenes_that_stand_ready() {
    let bdf2 = Settings {
        method: implicit::Method::Bdf2,
        ..Settings::default()
    };
    for (name, solver, most) in [
        ("verlet", Method::Verlet, 0.01),
        ("bdf2", Method::Implicit(bdf2), 0.01),
        ("implicit", Method::Implicit(Settings::default()), 0.03),
        ("xpbd", Method::Xpbd(Xpbd::new(1, 1)), 0.03),
        ("pbd", Method::Pbd(Pbd::default()), 0.03),
    ] {
        for (scene, what) in [
            (Scene::hang as fn(&Frame) -> Scene, "hang"),
            (Scene::flag, "flag"),
            (Scene::rip, "rip"),
            (Scene::trouser, "trouser"),
        ] {
            let [left, half] = left(16, scene, &solver);
            println!("{name} {what}: {left:.1e}, {half:.1e}");
            for left in [left, half] {
                assert!(left.abs() <= most, "{name} {what}: {left}");
            }
        }
    }
}

/// Drag acts on velocities, so it takes more from one that is carried than from its mass. That is the
/// method's, and once the swing is over nothing of it is left beside.
#[test]
fn nothing_is_left_beside_drag_where_one_is_carried() {
    let left = |light_kg: f64| {
        let mut masses = vec![1.0; 13];
        masses[6] = light_kg;
        let mut chain = weighted(masses, 0.0, 1.0);
        let loads = Loads {
            drag_per_s: Some(2.0),
            ..Loads::default()
        };
        chain.set_loads(loads).expect("drag");
        chain.state_mut().0[6].x += 0.2;
        let mut kept = Balance::new(&mut chain);
        for _ in 0..2000 {
            let taken = chain.step_observed(&mut Verlet::new(), 0.01, &mut kept);
            taken.expect("a step");
        }
        let balance = kept.now(&chain, 0.0);
        let part = balance.remainder_j().abs() / balance.began_j;
        (carried_count(&chain), part)
    };
    let [(none, even), (one, light)] = [1.0, 0.002].map(left);
    println!("{none} carried: {even:e}, {one} carried: {light:e} of what was there");
    assert_eq!([none, one], [0, 1]);
    assert!(even.max(light) < 1e-6, "{even} {light}");
}

/// By Verlet the work of drag is a trapezoid to the meter, and that of the middle to the method: they
/// differ by O(Δt²). The others say what drag took by their own steps, and leave rounding.
#[test]
fn what_is_left_beside_drag_falls_at_the_order_of_the_method() {
    for (name, mut solver) in methods() {
        if name == "provot" {
            continue;
        }
        let [large, small] = [0.01, 0.005].map(|dt_s| {
            let mut chain = drawn(4, 1.0, 0.7);
            let loads = Loads {
                drag_per_s: Some(2.0),
                ..Loads::default()
            };
            chain.set_loads(loads).expect("drag");
            let mut kept = Balance::new(&mut chain);
            let mut most = 0.0_f64;
            for _ in 0..(1.4 / dt_s) as usize {
                chain
                    .step_observed(&mut *solver, dt_s, &mut kept)
                    .expect("a step");
                most = most.max(kept.now(&chain, 0.0).remainder_j().abs());
            }
            most
        });
        println!("{name}: {large:e} J, {small:e} J");
        if name == "verlet" {
            assert!((3.5..4.5).contains(&(large / small)), "{large} {small}");
        } else {
            assert!(large.max(small) < 1e-9, "{name}: {large} {small}");
        }
    }
}

/// A sheet in its frame that rings: what a method took of it is told as the rate of a drag, and Verlet with
/// such a drag, which itself takes next to nothing, loses as much.
#[test]
fn damping_is_told_as_the_drag_that_takes_as_much() {
    let ring = |method: Method, drag_per_s: f64| {
        let rim = |across, along| HeldVertices::still(Region::Patch { across, along });
        let run = staged(8, |frame| Scene {
            duration_s: 0.5,
            solver: method.clone(),
            tearing: None,
            gravity_m_per_s2: Vector::zeros(),
            drag_per_s,
            holds: vec![
                rim([0.0, 1.0], [0.0, 0.01]),
                rim([0.0, 1.0], [0.99, 1.0]),
                rim([0.0, 0.01], [0.0, 1.0]),
                rim([0.99, 1.0], [0.0, 1.0]),
            ],
            ..Scene::fall(frame.up)
        });
        let points = run.cloth().positions().to_vec();
        let bulged = run.displaced(|v| {
            let p = points[v.index()];
            let [x, y] = [p.x, p.y].map(|x| x * (1.0 - x));
            Vector::new(0.02 * p.x, 0.02 * p.y, 0.16 * x * y)
        });
        play(bulged.expect("places that can be used"))
    };
    let implicit = ring(Method::implicit(), 0.0);
    let rate_per_s = implicit.damping_per_s().expect("it damps");
    let took_j = -implicit.energy_balance().method_j.expect("it says");
    let verlet = ring(Method::Verlet, rate_per_s);
    let dragged_j = -verlet.energy_balance().drag_j;
    println!("{rate_per_s} /s: {took_j} J, and by drag {dragged_j} J");
    assert!(
        (dragged_j / took_j - 1.0).abs() < 0.1,
        "{took_j} {dragged_j}"
    );
    let own_per_s = verlet.damping_per_s().unwrap_or(0.0);
    assert!(own_per_s < 1e-2 * rate_per_s, "{own_per_s}");
}

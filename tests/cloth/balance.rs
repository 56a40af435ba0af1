//! The balance of energy, against answers on paper; and the watch over what a method makes.

use tearmesh::{Edits, Point, Vector, mend, shapes, split};
use tearmesh_cloth::implicit;
use tearmesh_cloth::scene::{Frame, Scene};
use tearmesh_cloth::{
    Balance, Collider, EnergyBalance, Fabric, Limiter, Loads, Method, Solver, System, Tearing,
    Threshold, TornStiffness, Unstable, Verlet, Xpbd,
};

use crate::parts::cloths::{cloth, loaded, of_edges};
use crate::parts::scenes::{energy_warning, methods, play, played, staged};
use crate::parts::{
    METHODS, blown, implicit, mechanical_j, method, near, on_a_line, onto, path, plane, pulled,
    take_observed,
};

const DOWN: Vector = Vector::new(0.0, 0.0, -10.0);

/// A system that a balance observes.
struct Observed {
    system: System,
    balance: Balance,
}

impl Observed {
    fn new(system: System) -> Observed {
        let balance = Balance::new(&system);
        Observed { system, balance }
    }

    fn take(&mut self, solver: &mut dyn Solver, dt_s: f64, steps: usize) {
        let observed = (&mut self.system, &mut self.balance);
        take_observed(observed, solver, dt_s, steps);
    }

    /// Changes how a particle is held.
    fn handle(&mut self, particle: usize, change: impl FnOnce(&mut System)) {
        self.balance.handle(&mut self.system, particle, change);
    }

    fn now(&self) -> EnergyBalance {
        self.balance.now(&self.system)
    }
}

/// A mass of 1 kg at each of these places along x, and springs of a metre and 100 N/m between neighbours.
fn row<const N: usize>(places: [f64; N], loads: Loads) -> System {
    let mut row = on_a_line(places, 1.0);
    for i in 1..N {
        row.stretch([i - 1, i], 1.0, 100.0).expect("a spring");
    }
    row.set_loads(loads).expect("loads");
    row
}

/// v = g/c (1 − e^−ct): gravity has worked m g x, and drag the rest. The error is of second order.
#[test]
fn drag_takes_what_a_fall_does_not_keep() {
    let (g, c) = (10.0_f64, 2.0);
    let v = g / c * (1.0 - (-c).exp());
    let way = g / c * (1.0 - (1.0 - (-c).exp()) / c);
    let errors = [(0.02, 50), (0.01, 100)].map(|(dt_s, steps)| {
        let mut stone = Observed::new(row([0.0], pulled(DOWN, c)));
        stone.take(&mut Verlet, dt_s, steps);
        let balance = stone.now();
        near(balance.kinetic_j, v * v / 2.0, 5e-3);
        near(balance.gravity_j, g * way, 5e-3);
        near(balance.drag_j, v * v / 2.0 - g * way, 5e-3);
        assert_eq!(balance.held_j + balance.wind_j + balance.colliders_j, 0.0);
        balance.made_j()
    });
    near(errors[1], 0.0, 2e-3);
    near(errors[0] / errors[1], 4.0, 0.05);
}

/// One link that is led by its end at half a metre a second.
fn led(loads: Loads) -> Observed {
    let mut chain = row([0.0, 1.0], loads);
    chain.grab(1, path([(0.0, [1.0, 0.0, 0.0]), (10.0, [6.0, 0.0, 0.0])]));
    Observed::new(chain)
}

/// The mass swings about its end, led at speed u, at ω = √(k/m), and the hand has worked m u² (1 − cos ωt).
#[test]
fn a_hand_works_its_force_times_its_way() {
    let errors = [(0.01, 70), (0.005, 140)].map(|(dt_s, steps)| {
        let mut chain = led(Loads::default());
        let mut largest = 0.0_f64;
        for step in 1..=steps {
            chain.take(&mut Verlet, dt_s, 1);
            let balance = chain.now();
            let answer = 0.25 * (1.0 - (10.0 * f64::from(step) * dt_s).cos());
            largest = largest.max((balance.held_j - answer).abs());
            near(balance.made_j(), 0.0, 0.0025);
        }
        largest
    });
    near(errors[1], 0.0, 1e-3);
    near(errors[0] / errors[1], 4.0, 0.2);
    // By XPBD it works by the force that the link has where a step ends: alone it pulls by its length.
    let mut chain = led(pulled(DOWN, 1.0));
    let mut worked = 0.0;
    for _ in 0..30 {
        chain.take(&mut Xpbd::new(1, 1), 0.02, 1);
        let line = chain.system.positions()[1] - chain.system.positions()[0];
        let pull = line * (100.0 * (1.0 - 1.0 / line.norm()));
        worked += pull.dot(&chain.system.velocities()[1]) * 0.02;
        near(chain.now().held_j, worked, 1e-9);
    }
}

/// Backward Euler takes ½ m |Δv|² + ½ k |Δl|² in every step, and so makes nothing however the hand
/// shakes, if the hand works by the force that the method moves particles by.
#[test]
fn a_hand_that_shakes_gives_what_the_implicit_method_takes() {
    let state = |chain: &System| {
        let (x, v) = (chain.positions(), chain.velocities());
        ([x[1] - x[0], x[2] - x[1]].map(|d| d.norm()), [v[1], v[2]])
    };
    let mut chain = row([0.0, 1.0, 2.0], Loads::default());
    let way = [0.0, -0.3, 0.0, -0.3, 0.0];
    let mut times = (0..).map(|turn| 0.1 * f64::from(turn));
    let way = way.map(|x| (times.next().expect("a time"), [x, 0.0, 0.0]));
    chain.grab(0, path(way));
    let mut chain = Observed::new(chain);
    let mut solver = implicit(implicit::Method::BackwardEuler);
    let mut method = 0.0;
    for _ in 0..100 {
        let (before, speeds) = state(&chain.system);
        chain.take(&mut solver, 0.004, 1);
        let (after, now) = state(&chain.system);
        for i in 0..2 {
            method -= 0.5 * (now[i] - speeds[i]).norm_squared();
            method -= 50.0 * (after[i] - before[i]).powi(2);
        }
        near(chain.now().made_j(), method, 1e-9);
    }
    assert!(method < -0.1, "{method}");
}

/// Lifted by the hand, a weight costs m g h; its own weight counts although it is held.
#[test]
fn lifting_works_against_gravity() {
    let mut stone = row([0.0], pulled(DOWN, 0.0));
    stone.grab(0, path([(0.0, [0.0; 3]), (1.0, [0.0, 0.0, 0.3])]));
    let mut stone = Observed::new(stone);
    stone.take(&mut Verlet, 0.01, 200);
    near(stone.now().held_j, 3.0, 1e-12);
    near(stone.now().gravity_j, -3.0, 1e-12);
    near(stone.now().made_j(), 0.0, 1e-12);
}

#[test]
fn who_takes_hold_takes_motion_and_who_lets_go_gives_it() {
    let mut pair = row([0.0, 1.5], pulled(DOWN, 0.0));
    pair.state_mut().1[1] = Vector::new(0.0, 3.0, 0.0);
    let mut pair = Observed::new(pair);
    pair.handle(1, |pair| pair.hold(1));
    near(pair.now().held_j, -4.5, 1e-15);
    // Grabbed elsewhere: the spring is as long as at rest there, and half a metre higher.
    let way = path([(0.0, [0.8, 0.0, 0.6]), (1.0, [0.8, 2.0, 0.6])]);
    pair.handle(1, |pair| pair.grab(1, way));
    near(pair.now().held_j, -4.5 - 12.5 + 6.0, 1e-12);
    near(pair.now().made_j(), 0.0, 1e-12);
    pair.handle(0, |pair| pair.hold(0));
    pair.take(&mut Verlet, 0.01, 10);
    let before = pair.now();
    pair.handle(1, |pair| pair.release(1));
    near(pair.now().held_j - before.held_j, 2.0, 1e-12);
    near(pair.now().made_j(), before.made_j(), 1e-12);
}

/// A triangle that wind blows at squarely: v = u (1 − e^(−c A t/m)), and the wind has worked ½ m v².
#[test]
fn wind_works_on_who_is_free() {
    let (mesh, positions) = shapes::triangle();
    let mut cloth = cloth(&mesh, &positions, Fabric::new(10.0));
    let loads = blown(Vector::z() * 4.0, 0.4, Loads::default());
    cloth.system_mut().set_loads(loads).expect("loads");
    let mut blown = Observed::new(cloth.system().clone());
    // Samples lie 1 ms apart; the last two steps are after the last of them.
    blown.take(&mut Verlet, 4e-4, 1250);
    let v = 4.0 * (1.0 - (-1.0_f64).exp());
    let balance = blown.now();
    near(balance.kinetic_j, 0.05 * v * v, 4e-4);
    near(balance.wind_j, 0.05 * v * v, 4e-4);
    near(balance.made_j(), 0.0, 4e-4);
    (0..3).for_each(|v| blown.handle(v, |system| system.hold(v)));
    blown.take(&mut Verlet, 4e-4, 3);
    let before = blown.now();
    blown.take(&mut Verlet, 4e-4, 50);
    assert_eq!(blown.now(), before);
}

/// Three masses in a row fall flat onto the ground: the impact takes all their motion.
#[test]
fn an_impact_takes_motion() {
    for substeps in [1, 4] {
        let ground = Collider::plane(plane([0.0, 0.0, -1.0], -DOWN));
        let mut row = Observed::new(row([0.0, 1.0, 2.0], onto(ground, &pulled(DOWN, 0.0))));
        row.take(&mut Xpbd::new(substeps, 1), 0.01, 100);
        let balance = row.now();
        near(balance.gravity_j, 30.0, 1e-9);
        // Half a step's fall more or less.
        near(balance.colliders_j, -30.0, 3.0);
        near(balance.kinetic_j, 0.0, 1e-9);
        assert!(balance.put_in_j() >= 30.0 - 1e-9);
    }
    // By Verlet a fall is exact, and so is what a push out of the ground gives back. What is left is what
    // damping took from the spring between them, which the ball crushes.
    let ball = Collider::sphere(Point::new(0.65, 0.2, -2.0), 1.5);
    let mut stones = Observed::new(row([0.0, 1.3], onto(ball, &pulled(DOWN, 0.0))));
    stones.take(&mut Verlet, 1e-4, 10_000);
    let balance = stones.now();
    assert!(balance.colliders_j < -1.0, "{balance:?}");
    let lost = -balance.made_j() / balance.gravity_j;
    assert!((1e-6..0.05).contains(&lost), "{lost}");
}

/// A strained sheet in free fall: what is there before and after an edit, summed over everything.
#[test]
fn edits_make_what_is_there_after_and_was_not_before() {
    let loads = pulled(Vector::y() * -10.0, 0.0);
    let (mut mesh, mut cloth) = loaded(4, of_edges(50.0, TornStiffness::Whole), loads);
    let system = cloth.system_mut();
    let (x, v) = system.state_mut();
    for (i, (x, v)) in x.iter_mut().zip(v).enumerate() {
        x.x *= 1.3;
        x.y *= 1.2;
        *v = Vector::new(0.1 * i as f64, 0.3, -0.02 * (i * i) as f64);
    }
    let mut kept = Balance::new(system);
    let mut edits = Edits::new();
    let middle = mesh.vertices().nth(12).expect("a vertex");
    let mut gained = [(0.0, 0.0); 2];
    for (turn, gained) in gained.iter_mut().enumerate() {
        if turn == 0 {
            let across = plane(cloth.positions()[12], Vector::x());
            split::by_plane(&mut mesh, middle, &across, cloth.positions(), &mut edits);
        } else {
            let copy = mesh.vertices().last().expect("a copy");
            mend::merge(&mut mesh, middle, copy, [1.0, 1.0], &mut edits).expect("a merge");
        }
        let (before, before_j) = (kept.now(cloth.system()), mechanical_j(cloth.system()));
        edits.replay(&mut cloth);
        let made = mechanical_j(cloth.system()) - before_j;
        kept.add_edits(made);
        let after = kept.now(cloth.system());
        near(after.edits_j - before.edits_j, made, 1e-12);
        near(after.made_j(), before.made_j(), 1e-12);
        let state_j = |b: &EnergyBalance| b.kinetic_j + b.elastic_j - b.gravity_j;
        near(state_j(&after) - state_j(&before), made, 1e-12);
        *gained = (made, after.kinetic_j - before.kinetic_j);
        take_observed((cloth.system_mut(), &mut kept), &mut Verlet, 1e-3, 20);
    }
    assert!(gained[0].0 > 0.0, "copies make energy: {gained:?}");
    assert!(gained[1].1 < 0.0, "an inelastic impact: {gained:?}");
}

#[test]
fn substeps_are_summed_one_by_one() {
    let play = |dt_s: f64, steps: usize| {
        let mut chain = drawn::<3>(3.0, 5.0, pulled(DOWN, 1.0));
        chain.system.when_unstable(Unstable::Substep);
        chain.take(&mut Verlet, dt_s, steps);
        (chain.system.counters().substeps, chain.now())
    };
    let (substeps, whole) = play(0.5, 2);
    assert!(substeps >= 4, "{substeps}");
    let (_, single) = play(1.0 / substeps as f64, substeps as usize);
    near(whole.drag_j, single.drag_j, 1e-9);
    near(whole.held_j, single.held_j, 1e-9);
    near(whole.made_j(), single.made_j(), 1e-9);
}

/// Links in a row that is held at one end, and led away at the other by so many metres in so many seconds.
fn drawn<const N: usize>(by_m: f64, within_s: f64, loads: Loads) -> Observed {
    let mut chain = row(std::array::from_fn::<f64, N, _>(|i| i as f64), loads);
    chain.hold(0);
    let end = (N - 1) as f64;
    let way = [(0.0, [end, 0.0, 0.0]), (within_s, [end + by_m, 0.0, 0.0])];
    chain.grab(N - 1, path(way));
    Observed::new(chain)
}

/// N springs in a row are one of k/N. PBD's have no stiffness of their own.
#[test]
fn a_chain_drawn_slowly_stores_half_k_x_squared_over_n() {
    for name in &METHODS[..7] {
        let mut chain = drawn::<11>(1.5, 60.0, pulled(Vector::zeros(), 0.5));
        chain.take(&mut *method(name, 1), 0.01, 9000);
        let balance = chain.now();
        // The hand gave what is stored, and what drag took. One sweep of XPBD pulls less than the springs
        // are long.
        let margin = if *name == "XPBD" { 0.02 } else { 0.005 };
        for part_j in [balance.elastic_j, balance.held_j + balance.drag_j] {
            let part = part_j / (0.5 * 100.0 * 1.5 * 1.5 / 10.0);
            assert!((part - 1.0).abs() < margin, "{name}: {part}");
        }
    }
}

/// What nobody but hands moves costs them what it stores, by every method; PBD says nothing of what it stores.
#[test]
fn an_edge_between_held_ends_takes_what_it_stores() {
    for name in &METHODS[..8] {
        let mut pair = drawn::<2>(1.2, 0.5, Loads::default());
        pair.take(&mut *method(name, 1), 0.001, 1000);
        let balance = pair.now();
        // Those who move by the force at the end take a step's share more.
        near(balance.held_j / 72.0, 1.0, 0.005);
        let is_pbd = *name == "PBD";
        near(balance.elastic_j, if is_pbd { 0.0 } else { 72.0 }, 1e-9);
        // And that share is what the method took.
        let made = balance.made_j() / 72.0;
        assert!(is_pbd || (-0.005..1e-3).contains(&made), "{name}: {made}");
    }
}

#[test]
fn no_method_makes_energy_in_the_scenes_that_stand_ready() {
    let coarse = Scene::PRESETS.map(|(scene, _)| Method::NAMES.map(|method| (16, scene, method)));
    let fine = ["hang", "rip"].map(|scene| (32, scene, "verlet"));
    let finer = ["hang", "flag", "rip"].map(|scene| (32, scene, "xpbd"));
    for &(cells, scene, method) in coarse.as_flattened().iter().chain(&fine).chain(&finer) {
        let run = &played(cells, scene, method).run;
        assert_eq!(energy_warning(run), None, "{scene} by {method} at {cells}");
    }
}

/// A grip that bears eightfold and edges that bear two and a half: much energy at once.
fn violent(frame: &Frame, solver: Method, step_s: Option<f64>) -> Scene {
    Scene {
        duration_s: 1.6,
        solver,
        step_s,
        tearing: Some(Tearing::new(Threshold::Stretch(2.5))),
        ..Scene::rip(frame)
    }
}

/// Each step is below its limit, no number is large, and the cloth shatters: the balance alone tells.
#[test]
fn a_cloth_that_tears_by_energy_out_of_nothing_says_so() {
    // Springs without a guard, and a step that no one divides, 0.7 of the limit.
    let springs = Method::Provot(Limiter {
        stretch_ratio_max: 1e6,
        ..Limiter::default()
    });
    let own = play(staged(16, |frame| violent(frame, springs.clone(), None)));
    let step_s = Some(own.step_s());
    let run = play(staged(16, |frame| violent(frame, springs.clone(), step_s)));
    let said = energy_warning(&run).expect("it is said");
    let numbers: Vec<f64> = said
        .split(' ')
        .filter_map(|word| word.parse().ok())
        .collect();
    let [made_j, since_s, put_in_j] = numbers[..] else {
        panic!("{said}");
    };
    let pieces = run.mesh().components().count();
    assert!((1.0..1.6).contains(&since_s));
    assert!(made_j > put_in_j);
    assert!(made_j >= 0.99 * run.energy_balance().made_j()); // It has three digits.
    assert!(pieces > 20);
    // A step that may be divided is, as soon as the cloth is torn; and the guards of Verlet show what
    // nature would do at the same step.
    let half = play(staged(16, |frame| violent(frame, Method::Verlet, step_s)));
    assert_eq!(energy_warning(&half), None);
    assert!(half.mesh().components().count() < pieces / 2);
    for (name, solver) in methods() {
        let run = play(staged(16, |frame| violent(frame, solver.clone(), None)));
        assert_eq!(energy_warning(&run), None, "{name}");
    }
}

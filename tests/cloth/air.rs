//! Wind and drag that a method takes in by the velocities before: how long a step may be with them,
//! and of which order they are.

use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit::Method as Formula;
use tearmesh_cloth::{
    Cloth, Fabric, Loads, Provot, Solver, StepError, Unstable, Verlet, Xpbd, air, frequency_bound,
};

use crate::parts::cloths::loaded;
use crate::parts::nets::row;
use crate::parts::{G, blown, fastest, implicit_to, method, near, order, pulled, shake, take};
use crate::random::Random;
use crate::rk4::Rk4;

/// Where the polynomial of the Runge–Kutta method is 1 on the negative axis: 1 − z + z²/2 − z³/6 +
/// z⁴/24.
const RK4: f64 = 2.785_293_563_405_28;

/// Methods, and the largest rate of the air times the step at which each is stable.
const LIMITS: [(&str, f64); 8] = [
    ("guarded", 1.0),
    ("Verlet", 1.0),
    ("limited", 2.0),
    ("RK4", RK4),
    ("PBD", 2.0),
    ("ten substeps", 20.0),
    ("Euler", 2.0),
    ("BDF2", 4.0 / 3.0),
];

fn by(name: &str) -> Box<dyn Solver> {
    match name {
        "ten substeps" => Box::new(Xpbd::new(10, 1)),
        name => method(name, 10),
    }
}

/// A free sheet of n × n cells under these loads.
fn sheet(n: u32, stiffness: f64, loads: Loads) -> Cloth {
    loaded(n, Fabric::new(stiffness), loads).1
}

/// Still air, with this coefficient, and drag.
fn still(coefficient: f64, drag_per_s: f64) -> Loads {
    blown(
        Vector::zeros(),
        coefficient,
        pulled(Vector::zeros(), drag_per_s),
    )
}

/// How a sheet with a push across goes on in still air, at this part of the limit: how many times
/// as fast it is after 400 steps, if it takes them.
fn grown((name, limit): (&str, f64), part: f64, unstable: Unstable) -> Result<f64, StepError> {
    let coefficient = 60.0;
    let dt_s = part * limit / (coefficient / 0.2);
    let mut cloth = sheet(4, 1e-9, still(coefficient, 0.0));
    let system = cloth.system_mut();
    system.when_unstable(unstable);
    for v in system.state_mut().1 {
        *v = Vector::new(0.0, 0.0, 1e-6);
    }
    let mut solver = by(name);
    for _ in 0..400 {
        system.step(&mut *solver, dt_s)?;
    }
    Ok(fastest(system) / 1e-6)
}

#[test]
fn still_air_slows_a_sheet_up_to_a_limit_of_the_step() {
    for (name, limit) in LIMITS {
        let grown = |part, unstable| grown((name, limit), part, unstable);
        let [below, beyond] = [0.99, 1.02].map(|part| grown(part, Unstable::Allow));
        assert!(!beyond.is_ok_and(|grown| grown <= 10.0), "{name}");
        let below_watched = grown(0.99, Unstable::Refuse);
        let divided = grown(1.02, Unstable::Substep);
        for grown in [below, below_watched, divided] {
            assert!(grown.is_ok_and(|grown| grown < 0.1), "{name}");
        }
        let refused = grown(1.02, Unstable::Refuse).expect_err(name).to_string();
        let why = "(the air slows particle 0 at a rate of 300 /s)";
        assert!(refused.contains(why), "{name}: {refused}");
    }
}

/// The Runge–Kutta method takes drag by the velocities of its stages, and the others divide by it.
#[test]
fn drag_limits_only_the_method_that_takes_it_explicitly() {
    for (name, _) in LIMITS {
        let mut pair = row(1, 0.1, 10.0, 1.0, Vector::x());
        pair.set_loads(pulled(Vector::zeros(), 1000.0))
            .expect("loads");
        pair.state_mut().1[1] = Vector::y();
        let mut solver = by(name);
        let taken = pair.step(&mut *solver, 0.01);
        if name == "RK4" {
            let error = taken.expect_err("the drag is too strong").to_string();
            let text = "dt 0.01 s exceeds the stability limit 0.00276 s \
                        (the air slows particle 1 at a rate of 1000 /s)";
            assert_eq!(error, text);
            pair.when_unstable(Unstable::Substep);
            assert_eq!(pair.step(&mut *solver, 0.01).expect("four"), 4);
        } else {
            taken.expect(name);
        }
        assert!(fastest(&pair) < 1.0, "{name}");
    }
}

/// Springs and air at once: a step at the limit of the watch is stable, whichever has the larger
/// part in it.
#[test]
fn springs_and_air_are_stable_at_the_limit_of_the_watch() {
    for (name, _) in &LIMITS[..4] {
        for air in [1e-3, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0] {
            for drag_per_s in [0.0, 20.0, 1e3] {
                let omega = frequency_bound(sheet(4, 50.0, Loads::default()).system_mut());
                let coefficient = air * 0.2 * omega.omega_rad_per_s;
                let mut cloth = sheet(4, 50.0, still(coefficient, drag_per_s));
                let system = cloth.system_mut();
                shake(system, 0.0, 1e-6, &mut Random(11));
                let began = fastest(system);
                let mut solver = by(name);
                // What refuses a long step says how long one may be.
                let dt_s = match system.step(&mut *solver, 1.0) {
                    Err(StepError::Unstable { limit_s, .. }) => limit_s,
                    other => panic!("{other:?}"),
                };
                take(system, &mut *solver, 0.999 * dt_s, 2000);
                let grown = fastest(system) / began;
                assert!(grown < 10.0, "{name} {air} {drag_per_s}: {grown}");
            }
        }
    }
}

/// The bound against the largest rate itself, found by letting a sheet of uneven masses that is
/// crumpled and partly held slow down in still air by steps so short that the air alone acts.
#[test]
fn no_mode_is_slowed_faster_than_the_rate_says() {
    let coefficient = 0.5;
    let mut cloth = sheet(4, 1e-9, still(coefficient, 0.0));
    let flat = cloth.positions().to_vec();
    let indices = cloth.indices().to_vec();
    let mut random = Random(5);
    for round in 0..20 {
        let system = cloth.system_mut();
        let crumpled = f64::from(round) * 0.02;
        system.state_mut().0.copy_from_slice(&flat);
        shake(system, crumpled, 0.0, &mut random);
        system.state_mut().1.fill(Vector::z());
        if round == 10 {
            system.hold(0);
        }
        let (rate_per_s, particle) = air::air_rate(system, false).expect("there is wind");
        let areas = indices.chunks_exact(3).map(|face| {
            let [a, b, c] = [0, 1, 2].map(|i| system.positions()[face[i] as usize]);
            let is_at = face.iter().any(|&v| v as usize == particle);
            f64::from(u8::from(is_at)) * (b - a).cross(&(c - a)).norm() / 2.0
        });
        let by_hand = coefficient * areas.sum::<f64>() / 3.0 / system.masses()[particle];
        near(rate_per_s / by_hand, 1.0, 1e-12);
        // The power iteration: M⁻¹ D v is minus what the air makes of v in a second.
        system.when_unstable(Unstable::Allow);
        let at = system.positions().to_vec();
        let dt_s = 1e-6;
        let mut largest = 0.0_f64;
        for _ in 0..60 {
            let before = system.velocities().to_vec();
            system.step(&mut Provot::unlimited(), dt_s).expect("a step");
            let (x, v) = system.state_mut();
            x.copy_from_slice(&at);
            let pairs = v.iter_mut().zip(&before);
            pairs.for_each(|(v, before)| *v = (before - *v) / dt_s);
            // In the norm by mass this is from below; masses differ by a factor of six here.
            let norm = |v: &[Vector]| v.iter().map(|v| v.norm_squared()).sum::<f64>().sqrt();
            largest = norm(v) / norm(&before);
            v.iter_mut().for_each(|v| *v /= largest);
        }
        assert!((0.3..1.0 + 1e-6).contains(&(largest / rate_per_s)));
        if round == 0 {
            near(largest / (coefficient / 0.2), 1.0, 1e-6);
            near(rate_per_s / (coefficient / 0.2), 1.0, 1e-12);
        }
    }
}

/// Where a hanging sheet in slanting wind is after 0.2 s, by steps whose lengths alternate in the
/// given proportions, and the number of force evaluations.
fn hung_in_wind(
    solver: &mut dyn Solver,
    steps: u32,
    lengths: [f64; 2],
    drag_per_s: f64,
) -> (Vec<Point>, u64) {
    let slanting = Vector::new(1.0, 2.0, 5.0);
    let loads = blown(slanting, 0.5, pulled(Vector::z() * -G, drag_per_s));
    let mut cloth = sheet(6, 20.0, loads);
    let system = cloth.system_mut();
    (42..49).for_each(|top| system.hold(top));
    for step in 0..steps {
        let dt_s = 0.2 / f64::from(steps) * lengths[step as usize % 2];
        system.step(&mut *solver, dt_s).expect("a step");
    }
    let evaluations = system.counters().force_evaluations;
    (system.positions().to_vec(), evaluations)
}

/// BDF2 at the tolerance of the library and at that of the command, with steps as different as 1.4 and 0.6
/// too.
#[test]
fn velocity_verlet_and_bdf2_are_of_second_order_in_wind() {
    let bdf2 = |tolerance| Box::new(implicit_to(Formula::Bdf2, tolerance));
    for drag_per_s in [0.0, 3.0] {
        let (truth, _) = hung_in_wind(&mut Rk4::new(), 1600, [1.0; 2], drag_per_s);
        let cases: [(Box<dyn Solver>, _, _); 4] = [
            (Box::new(Verlet), [1.0; 2], 1),
            (bdf2(1.0), [1.0; 2], 0),
            (bdf2(10.0), [1.0; 2], 0),
            (bdf2(1.0), [1.4, 0.6], 0),
        ];
        for (mut solver, lengths, more) in cases {
            let errors = [200, 400, 800].map(|steps| {
                let (at, evaluations) = hung_in_wind(&mut *solver, steps, lengths, drag_per_s);
                assert_eq!(evaluations, u64::from(steps) + more);
                let apart = at.iter().zip(&truth).map(|(a, b)| (a - b).norm_squared());
                apart.sum::<f64>().sqrt()
            });
            for i in 0..2 {
                near(order([errors[i], errors[i + 1]]), 2.0, 0.2);
            }
        }
    }
}

//! Wind and drag that a method takes in by the velocities before: how long a step may be with them,
//! and of which order they are.

use tearmesh::{Point, Vector, shapes};
use tearmesh_cloth::implicit;
use tearmesh_cloth::{
    Cloth, Fabric, Implicit, Loads, Pbd, Provot, Solver, StepError, System, Unstable, Verlet, Wind,
    Xpbd, air, frequency_bound,
};

use crate::parts::cloths::cloth;
use crate::parts::{G, implicit_to};
use crate::plain_verlet::PlainVerlet;
use crate::random::Random;
use crate::rk4::Rk4;

/// A method by name, and the largest rate of the air times the step at which it is stable.
type Method = (&'static str, f64, fn() -> Box<dyn Solver>);

/// Where the polynomial of the Runge–Kutta method is 1 on the negative axis: 1 − z + z²/2 − z³/6 +
/// z⁴/24.
const RK4: f64 = 2.785_293_563_405_28;

const METHODS: [Method; 8] = [
    ("guarded Verlet", 1.0, || Box::new(Verlet::new())),
    ("Verlet", 1.0, || Box::new(PlainVerlet::new())),
    ("Provot", 2.0, || Box::new(Provot::default())),
    ("RK4", RK4, || Box::new(Rk4::new())),
    ("PBD", 2.0, || Box::new(Pbd::default())),
    ("XPBD", 20.0, || Box::new(Xpbd::new(10, 1))),
    ("implicit", 2.0, || Box::new(Implicit::default())),
    ("BDF2", 4.0 / 3.0, || {
        Box::new(implicit_to(implicit::Method::Bdf2, 1.0))
    }),
];

/// Wind across a sheet.
fn wind(speed_m_per_s: f64, coefficient: f64) -> Wind {
    Wind {
        velocity_m_per_s: Vector::new(0.0, 0.0, speed_m_per_s),
        coefficient,
    }
}

/// A free sheet of n × n cells at rest in this wind, and with this drag.
fn sheet(n: u32, stiffness: f64, wind: Wind, drag_per_s: Option<f64>) -> Cloth {
    let (mesh, positions) = shapes::grid(n, n);
    let mut cloth = cloth(&mesh, &positions, Fabric::new(stiffness));
    let loads = Loads {
        wind: Some(wind),
        drag_per_s,
        ..Loads::default()
    };
    cloth.system_mut().set_loads(loads).expect("loads");
    cloth
}

fn fastest(system: &System) -> f64 {
    let speeds = system.velocities().iter().map(|v| v.norm());
    speeds.fold(0.0, f64::max)
}

/// How a sheet with a push across goes on in still air, at this part of the limit: how many times
/// as fast it is after 400 steps, if it takes them.
fn grown(method: &Method, part: f64, unstable: Unstable) -> Result<f64, StepError> {
    let (_, limit, make) = method;
    let coefficient = 60.0;
    let dt_s = part * limit / (coefficient / 0.2);
    let mut cloth = sheet(4, 1e-9, wind(0.0, coefficient), None);
    let system = cloth.system_mut();
    system.when_unstable(unstable);
    for v in system.state_mut().1 {
        *v = Vector::new(0.0, 0.0, 1e-6);
    }
    let mut solver = make();
    for _ in 0..400 {
        system.step(&mut *solver, dt_s)?;
    }
    Ok(fastest(system) / 1e-6)
}

#[test]
fn still_air_brings_a_sheet_to_rest_up_to_a_limit_beyond_which_a_step_is_refused_or_divided() {
    for method in &METHODS {
        let name = method.0;
        let grown = |part, unstable| grown(method, part, unstable);
        let [below, beyond] = [0.99, 1.02].map(|part| grown(part, Unstable::Allow));
        assert!(!beyond.is_ok_and(|grown| grown <= 10.0), "{name}");
        let below_watched = grown(0.99, Unstable::Refuse);
        let divided = grown(1.02, Unstable::Substep);
        for grown in [below, below_watched, divided] {
            assert!(
                grown.as_ref().is_ok_and(|&grown| grown < 0.1),
                "{name}: {grown:?}"
            );
        }
        let refused = grown(1.02, Unstable::Refuse).expect_err(name).to_string();
        let why = "(the air slows particle 0 at a rate of 300 /s)";
        assert!(refused.contains(why), "{name}: {refused}");
    }
}

/// The Runge–Kutta method takes drag by the velocities of its stages, and the others divide by it.
#[test]
fn drag_limits_the_method_that_takes_it_explicitly_and_no_other() {
    for (name, _, make) in &METHODS {
        let mut pair = System::new([Point::origin(), Point::new(1.0, 0.0, 0.0)], vec![0.1; 2])
            .expect("two particles");
        pair.stretch([0, 1], 1.0, 10.0).expect("a spring");
        let drag_per_s = Some(1000.0);
        let loads = Loads {
            drag_per_s,
            ..Loads::default()
        };
        pair.set_loads(loads).expect("loads");
        for v in pair.state_mut().1 {
            *v = Vector::new(0.0, 1.0, 0.0);
        }
        let mut solver = make();
        let taken = pair.step(&mut *solver, 0.01);
        if *name == "RK4" {
            let error = taken.expect_err("the drag is too strong").to_string();
            assert_eq!(
                error,
                "dt 0.01 s exceeds the stability limit 0.00275 s \
                 (the air slows particle 0 at a rate of 1000 /s)"
            );
            pair.when_unstable(Unstable::Substep);
            assert_eq!(pair.step(&mut *solver, 0.01).expect("four"), 4);
        } else {
            taken.expect(name);
        }
        assert!(fastest(&pair) < 1.0, "{name}: {}", fastest(&pair));
    }
}

/// Springs and air at once: a step at the limit of the watch is stable, whichever has the larger
/// part in it.
#[test]
fn springs_and_air_together_are_stable_at_the_limit_of_the_watch() {
    for (name, limit, make) in &METHODS[..4] {
        for air in [1e-3, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0] {
            for drag_per_s in [None, Some(20.0), Some(1e3)] {
                let omega = frequency_bound(sheet(4, 50.0, wind(0.0, 0.0), None).system_mut());
                let coefficient = air * 0.2 * omega.omega_rad_per_s;
                let mut cloth = sheet(4, 50.0, wind(0.0, coefficient), drag_per_s);
                let system = cloth.system_mut();
                let mut random = Random(11);
                for v in system.state_mut().1 {
                    *v = Vector::new(0.0, 0.0, 0.0).map(|_: f64| 1e-6 * random.next());
                }
                let began = fastest(system);
                let mut solver = make();
                // What refuses a long step says how long one may be.
                let dt_s = match system.step(&mut *solver, 1.0) {
                    Err(StepError::Unstable { limit_s, .. }) => limit_s,
                    other => panic!("{other:?}"),
                };
                for _ in 0..2000 {
                    system.step(&mut *solver, 0.999 * dt_s).expect("a step");
                }
                let grown = fastest(system) / began;
                assert!(grown < 10.0, "{name} {limit} {air} {drag_per_s:?}: {grown}");
            }
        }
    }
}

/// The bound against the largest rate itself, found by letting a sheet of uneven masses that is
/// crumpled and partly held slow down in still air by steps so short that the air alone acts.
#[test]
fn no_mode_is_slowed_faster_than_the_rate_says() {
    let coefficient = 0.5;
    let mut cloth = sheet(4, 1e-9, wind(0.0, coefficient), None);
    let flat = cloth.positions().to_vec();
    let indices = cloth.indices().to_vec();
    let mut random = Random(5);
    for round in 0..20 {
        let system = cloth.system_mut();
        let crumpled = f64::from(round) * 0.02;
        let (x, v) = system.state_mut();
        for ((x, v), &flat) in x.iter_mut().zip(v).zip(&flat) {
            *x = flat + Vector::zeros().map(|_: f64| crumpled * (random.next() - 0.5));
            *v = Vector::new(0.0, 0.0, 1.0);
        }
        if round == 10 {
            system.hold(0);
        }
        let rate = air::wind_rate(system).expect("there is wind");
        let areas = indices.chunks_exact(3).map(|face| {
            let [a, b, c] = [0, 1, 2].map(|i| system.positions()[face[i] as usize]);
            (b - a).cross(&(c - a)).norm() / 2.0
        });
        let areas: Vec<f64> = areas.collect();
        let around = indices.chunks_exact(3).zip(&areas);
        let at = around.filter(|(face, _)| face.iter().any(|&v| v as usize == rate.particle));
        let area: f64 = at.map(|(_, area)| area).sum();
        let by_hand = coefficient * area / 3.0 / system.masses()[rate.particle];
        assert!((by_hand - rate.rate_per_s).abs() < 1e-12 * by_hand);
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
            let mut square = [0.0; 2];
            for (v, before) in v.iter_mut().zip(&before) {
                *v = (before - *v) / dt_s;
                square = [
                    square[0] + before.norm_squared(),
                    square[1] + v.norm_squared(),
                ];
            }
            // In the norm by mass this is from below; masses differ by a factor of six here.
            let scale = (square[0] / square[1]).sqrt();
            largest = 1.0 / scale;
            v.iter_mut().for_each(|v| *v *= scale);
        }
        assert!(largest < rate.rate_per_s * (1.0 + 1e-6));
        assert!(largest > 0.3 * rate.rate_per_s);
        if round == 0 {
            let exact = coefficient / 0.2;
            assert!(
                (largest / exact - 1.0).abs() < 1e-6
                    && (rate.rate_per_s / exact - 1.0).abs() < 1e-12
            );
        }
    }
}

/// Where a hanging sheet in slanting wind is after 0.2 s, by steps whose lengths alternate in the
/// given proportions, and the number of force evaluations.
fn blown(
    solver: &mut dyn Solver,
    steps: u32,
    lengths: [f64; 2],
    drag_per_s: Option<f64>,
) -> (Vec<Point>, u64) {
    let slanting = Wind {
        velocity_m_per_s: Vector::new(1.0, 2.0, 5.0),
        coefficient: 0.5,
    };
    let mut cloth = sheet(6, 20.0, slanting, drag_per_s);
    let system = cloth.system_mut();
    let mut loads = system.loads().clone();
    loads.gravity_m_per_s2 = Some(Vector::z() * -G);
    system.set_loads(loads).expect("loads");
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
    let bdf2 = |tolerance| Box::new(implicit_to(implicit::Method::Bdf2, tolerance));
    for drag_per_s in [None, Some(3.0)] {
        let (truth, _) = blown(&mut Rk4::new(), 1600, [1.0; 2], drag_per_s);
        let cases: [(Box<dyn Solver>, _, _); 4] = [
            (Box::new(Verlet::new()), [1.0; 2], 1),
            (bdf2(1.0), [1.0; 2], 0),
            (bdf2(10.0), [1.0; 2], 0),
            (bdf2(1.0), [1.4, 0.6], 0),
        ];
        for (number, (mut solver, lengths, more)) in cases.into_iter().enumerate() {
            let errors = [200, 400, 800].map(|steps| {
                let (at, evaluations) = blown(&mut *solver, steps, lengths, drag_per_s);
                assert_eq!(evaluations, u64::from(steps) + more);
                let apart = at.iter().zip(&truth).map(|(a, b)| (a - b).norm_squared());
                apart.sum::<f64>().sqrt()
            });
            let orders = [0, 1].map(|i| (errors[i] / errors[i + 1]).log2());
            for order in orders {
                assert!((order - 2.0).abs() < 0.2, "{number}: {orders:?}");
            }
        }
    }
}

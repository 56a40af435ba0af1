//! Where methods fail: each failure is reported, with numbers, and the last good state is kept.

use tearmesh::{Point, Vector};
use tearmesh_cloth::{
    BlowUpSite, Loads, Path, Pbd, Quality, Solver as _, StepError, System, SystemError, Unstable,
    Verlet, Xpbd, frequency_bound,
};

use crate::parts::nets::{chain, framed, link, row};
use crate::parts::vibration::largest_frequency;
use crate::parts::{blown, gravity, near, on_a_line, run, run_with, shake};
use crate::plain_verlet::PlainVerlet;
use crate::random::Random;

#[test]
fn f1_growth_beyond_the_limit_is_of_theory_and_refused() {
    // λ + 1/λ = z² − 2 at ω Δt = z.
    let z: f64 = 2.002;
    let half = (z * z - 2.0) / 2.0;
    let growth = half + (half * half - 1.0).sqrt();
    near(growth, 1.0936, 5e-5);
    let mut system = row(1, 0.01, 40.0, 1.0, Vector::new(1.0, 0.0, 0.0));
    system.state_mut().0[1].x = 1.0 + 1e-9;
    let dt = z / 4000.0_f64.sqrt();
    let mut verlet = PlainVerlet::new();
    let error = system.step(&mut verlet, dt).expect_err("too long");
    let text = "dt 0.03165439937828547 s exceeds the stability limit 0.0316 s \
                (bound of frequencies 63.2 rad/s at edge 0-1)";
    assert_eq!(error.to_string(), text);
    assert_eq!(system.elapsed_s(), 0.0);
    system.when_unstable(Unstable::Substep);
    assert_eq!(system.clone().step(&mut verlet, dt), Ok(2));

    system.when_unstable(Unstable::Allow);
    run_with(&mut system, &mut verlet, dt, 60);
    let before = system.positions()[1].x - 1.0;
    run_with(&mut system, &mut verlet, dt, 1);
    near(-(system.positions()[1].x - 1.0) / before, growth, 1e-4);
    let error = (0..1000).find_map(|_| {
        let good = system.positions().to_vec();
        let error = system.step(&mut verlet, dt).err()?;
        assert_eq!(system.positions(), good, "the last good state is kept");
        Some(error)
    });
    let Some(StepError::BlowUp { at, .. }) = error else {
        panic!("{error:?}");
    };
    assert!(matches!(at, BlowUpSite::Constraint([0, 1], ratio) if ratio > 100.0));
}

#[test]
fn f4_the_bound_holds_is_near_and_names_its_spring() {
    for stiffness in [1e2, 1e5] {
        let mut net = framed(6, stiffness, 0.0);
        let bound = frequency_bound(&mut net).omega_rad_per_s;
        // It holds wherever particles are, also where springs have turned to pull side by side.
        for seed in 0..6 {
            let omega = largest_frequency(&net);
            assert!(omega < bound && omega > 0.5 * bound);
            shake(&mut net, 0.1 * seed as f64, 0.0, &mut Random(seed));
        }
        let id = link(&net, 24, 25).expect("a spring");
        let spring = net.cut(id);
        let stiffer = net.stretch(spring.ends, spring.rest_length_m, 9.0 * stiffness);
        let id = stiffer.expect("a spring");
        let stiffer = frequency_bound(&mut net);
        assert!(stiffer.omega_rad_per_s > largest_frequency(&net));
        let [a, b] = stiffer.ends.expect("a spring");
        assert_eq!(link(&net, a, b), Some(id));
    }
}

#[test]
fn f6_f7_pbd_depends_on_iterations_and_has_no_limit() {
    let hang = |sweeps: u32, dt: f64, seconds: f64| {
        let mut chain = chain(2.0);
        run(&mut chain, Pbd::new(sweeps), dt, (seconds / dt) as usize);
        -chain.positions()[10].z
    };
    let lengths = [1, 5, 20, 200].map(|sweeps| hang(sweeps, 1.0 / 60.0, 20.0));
    assert!(lengths.is_sorted_by(|long, short| long > short && *short > 1.0));
    assert!(lengths[0] > 1.05 && lengths[1] < 1.05 && lengths[3] < 1.001);

    // However soft, it gets stiff as the step falls: x = g Δt² (1 − k) / (k (1 + c Δt)).
    for dt in [1.0 / 60.0, 1.0 / 240.0, 1.0 / 960.0] {
        let mut weight = row(1, 0.01, 1.0, 1.0, Vector::new(0.0, 0.0, -1.0));
        weight.set_loads(gravity(5.0)).expect("loads");
        let soft = Pbd {
            sweeps: 4,
            stiffness: 0.01,
            ..Pbd::default()
        };
        run(&mut weight, soft, dt, (20.0 / dt) as usize);
        let extension = 9.81 * dt * dt * 99.0 / (1.0 + 5.0 * dt);
        near(-weight.positions()[1].z - 1.0, extension, 1e-12);
    }
}

#[test]
fn f8_xpbd_says_that_it_is_wrong_under_pretension() {
    // A stiff net in a frame, 2 % pretension, one sweep: the forces do not balance.
    let (dt, steps) = (1.0 / 60.0, 60);
    let mut net = framed(8, 1e4, 10.0);
    net.when_unstable(Unstable::Substep);
    run(&mut net, Verlet, dt, steps);
    let verlet = net.positions()[40].z;
    let wrong = |solver: Xpbd| {
        let mut net = framed(8, 1e4, 10.0);
        run(&mut net, solver, dt, steps);
        let off = (net.positions()[40].z / verlet - 1.0).abs();
        match solver.quality(&net) {
            Quality::Residual(newtons) => (newtons, off),
            other => panic!("{other:?}"),
        }
    };
    let [few, many] = [16, 1024].map(|substeps| wrong(Xpbd::new(substeps, 1)));
    assert!(few.0 > 1.0 && few.1 > 0.5, "{few:?}");
    assert!(many.0 < 0.01 * few.0 && many.1 < 0.1 * few.1, "{many:?}");
}

#[test]
fn f15_what_cannot_be_simulated_is_refused_with_its_index() {
    let text = "particle 1: mass_kg is 0, and has to be finite and above 0";
    let nowhere = "particle 1: point is NaN, and has to be finite and not too far away";
    for (y, mass, text) in [(0.0, 0.0, text), (f64::NAN, 1.0, nowhere)] {
        let points = [Point::origin(), Point::new(0.0, y, 0.0)];
        let error = System::new(points, vec![1.0, mass]).expect_err("no system");
        assert_eq!(error.to_string(), text);
    }
    let mut system = on_a_line([0.0, 1.0, 2.0], 1.0);
    let (none, endless) = (f64::NAN, f64::INFINITY);
    for (ends, rest_length_m, stiffness_n_per_m, setting, given) in [
        ([0, 1], 0.0, 1.0, "rest_length_m", 0.0),
        ([0, 1], 1.0, 0.0, "stiffness_n_per_m", 0.0),
        ([0, 1], none, 1.0, "rest_length_m", none),
        ([0, 1], 1.0, endless, "stiffness_n_per_m", endless),
        ([0, 0], 1.0, 1.0, "ends", 0.0),
        ([0, 3], 1.0, 1.0, "ends", 3.0),
    ] {
        let refused = system.stretch(ends, rest_length_m, stiffness_n_per_m);
        let SystemError { particles, number } = refused.expect_err("no constraint");
        assert_eq!((particles, number.setting), (ends, setting));
        assert_eq!(number.given.to_bits(), given.to_bits());
        assert!(system.bend(ends, rest_length_m, stiffness_n_per_m).is_err());
    }
    assert!(system.stretches().is_empty());
    let loads = blown(Vector::x(), f64::NAN, Loads::default());
    let error = system.set_loads(loads).expect_err("no wind").to_string();
    let text = "wind.coefficient is NaN, and has to be finite and at least 0";
    assert_eq!(error, text);
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = system.step(&mut Verlet, dt).expect_err("no step");
        assert!(matches!(error, StepError::Step { .. }), "{error}");
    }
    assert!(Path::new([(1.0, Point::origin()), (1.0, Point::origin())]).is_none());
}

//! The watch over stability after something went wrong: a state that was no number, one that was
//! set, a step that failed.

use tearmesh::{Mesh, Vector};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{
    Balance, Buckling, Cloth, EnergyBalance, Fabric, Failure, Implicit, Limiter, Pbd, Provot,
    Solver, StepError, System, Threshold, Verlet, Xpbd, force,
};

use crate::parts::cloths::{loaded, split_off};
use crate::parts::nets::row;
use crate::parts::{
    METHODS, blown, gravity_along_y, implicit_to, method, on_a_line, particles, path, state,
    take_observed, tension_n, v,
};
use crate::plain_verlet::PlainVerlet;

/// Ten springs of 1000 N/m between particles of 10 g: a step of 0.02 s is six times too long.
fn stiff() -> System {
    row(10, 0.01, 1000.0, 0.1, Vector::x() * 0.1)
}

const TOO_LONG_S: f64 = 0.02;

/// How long a step may be that is refused.
fn refused(system: &mut System) -> Result<f64, StepError> {
    match system.step(&mut PlainVerlet::new(), TOO_LONG_S) {
        Err(StepError::Unstable { limit_s, .. }) => Ok(limit_s),
        other => Err(other.expect_err("a step that is refused")),
    }
}

#[test]
fn a_state_that_was_no_number_leaves_the_watch_on() {
    let limit_s = refused(&mut stiff()).expect("a limit");
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let mut system = stiff();
        let good = system.positions()[3];
        system.state_mut().0[3].x = bad;
        let broken = refused(&mut system);
        let is_blow_up = matches!(broken, Err(StepError::BlowUp { .. }));
        assert_eq!(is_blow_up, !bad.is_finite(), "{broken:?}");
        system.state_mut().0[3] = good;
        assert_eq!(refused(&mut system), Ok(limit_s));
        system.hold(10);
        refused(&mut system).expect("a limit");
    }
}

/// What a blow-up names.
fn named(system: &mut System, method: &mut dyn Solver, dt_s: f64) -> String {
    let error = system.step(method, dt_s).expect_err("a blow-up");
    let words = error.to_string();
    let named = words.strip_prefix("the system blew up after 0 s: ");
    let named = named.and_then(|words| words.strip_suffix("; the last good state is kept"));
    named.unwrap_or(&words).to_owned()
}

/// Whether it is projected, limited or solved; and the system is as it was.
#[test]
fn a_blow_up_names_what_is_too_long() {
    let mut edge = on_a_line([0.0, 1.0, 5000.0], 0.1);
    edge.stretch([0, 1], 1.0, 10.0).expect("a spring");
    edge.stretch([1, 2], 1.0, 10.0).expect("a spring");
    let mut bend = on_a_line([0.0, 1.0, 300.0], 0.1);
    bend.stretch([0, 1], 1.0, 1.0).expect("a spring");
    bend.bend([1, 2], 1.0, 1.0).expect("a bend");
    let mut folded = bend.clone();
    folded.set_buckling(Buckling::new(0.95));
    let mut woven = particles([[0.0; 3], [300.0, 0.0, 0.0], [0.0, 1.0, 0.0]], 0.1);
    let flat = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    woven.triangle([0, 1, 2], flat, [10.0; 3]).expect("area");
    for (system, named) in [
        (edge, "edge 1-2 is 499"),
        (bend, "the bend 1-2 is 29"),
        (folded, "the bend 1-2 is 29"),
        (woven, "triangle 0-1-2 is "),
    ] {
        for name in METHODS {
            let (mut tried, mut solver) = (system.clone(), method(name, 10));
            let words = self::named(&mut tried, &mut *solver, 1e-4);
            let takes_springs = words.starts_with("the method supports springs only");
            assert!(takes_springs || words.starts_with(named), "{name}: {words}");
            assert_eq!(state(&tried), state(&system), "{name}");
            tried.set_stretch_ratio_max(1e4);
            let goes_on = tried.step(&mut *solver, 1e-4).is_ok();
            assert!(takes_springs || goes_on, "{name}");
        }
    }
    // What a step throws too far by itself; Provot's forces see that in the next step, or never.
    for name in ["guarded", "Verlet", "RK4", "PBD", "XPBD"] {
        let mut thrown = on_a_line([0.0, 1.0, 2.0], 0.1);
        thrown.stretch([1, 2], 1.0, 1e-3).expect("a spring");
        thrown.state_mut().1[2].x = 2e4;
        let words = named(&mut thrown, &mut *method(name, 10), 0.1);
        assert!(words.starts_with("edge 1-2 is "), "{name}: {words}");
    }
}

#[test]
fn a_blow_up_names_the_particle_that_is_too_far_away() {
    for name in METHODS {
        let mut method = method(name, 10);
        let mut pair = on_a_line([0.0, 1.0, 2.0], 0.1);
        for v in &mut pair.state_mut().1[1..] {
            v.x = 1.2e308;
        }
        let particle = "particle 1 is too far away or too fast";
        assert_eq!(named(&mut pair, &mut *method, 1e-308), particle, "{name}");
        // And where it was none when the step began, that one; not those that it drags along.
        let mut chain = on_a_line([0.0, 1.0, 2.0, 3.0], 0.1);
        for a in 0..3 {
            chain.stretch([a, a + 1], 1.0, 1.0).expect("a spring");
        }
        chain.state_mut().0[2].z = f64::NAN;
        let particle = "particle 2 is not finite";
        assert_eq!(named(&mut chain, &mut *method, 0.01), particle, "{name}");
    }
}

#[test]
fn a_method_that_gives_up_blames_nothing_that_is_not_there() {
    let mut alone = on_a_line([0.0], 0.1);
    let never = &mut Rash(|_, _| {});
    assert_eq!(named(&mut alone, never, 0.01), "the method gave up");
}

/// A sheet in a wind, held at a corner, with all that a step leaves behind.
fn in_wind() -> (Mesh, Cloth, Balance) {
    let loads = blown(Vector::z() * 5.0, 0.5, gravity_along_y(1.0));
    let (mesh, mut cloth) = loaded(4, Fabric::new(10.0), loads);
    let system = cloth.system_mut();
    let x = system.positions()[0];
    system.grab(0, path([(0.0, x.into()), (1.0, [x.x - 5.0, x.y, x.z])]));
    let balance = Balance::new(system);
    (mesh, cloth, balance)
}

/// All of a cloth and its balance that a step that is refused puts back.
fn left_behind(cloth: &Cloth, balance: &Balance) -> String {
    let system = cloth.system();
    let state = (system.positions(), system.velocities(), system.elapsed_s());
    // A step that failed leaves no forces behind, and so what is stored is that of lengths.
    let balance = EnergyBalance {
        elastic_j: 0.0,
        ..balance.now(system)
    };
    format!("{state:?} {balance:?}")
}

#[test]
fn a_refused_step_leaves_state_and_balance_as_they_were() {
    // The balance is asked for between two samples of the wind, 1 ms apart.
    let dt_s = 3e-4;
    for name in METHODS {
        let mut method = method(name, 10);
        let (mut mesh, mut cloth, mut balance) = in_wind();
        let mut take = |cloth: &mut Cloth, balance: &mut Balance, dt_s| {
            let system = cloth.system_mut();
            system.step_observed(&mut *method, dt_s, Some(&mut *balance))
        };
        for _ in 0..8 {
            take(&mut cloth, &mut balance, dt_s).expect("a step");
        }
        split_off(&mut mesh, &mut cloth, v(12), 1);
        let before = left_behind(&cloth, &balance);
        let mut untried = (cloth.clone(), balance.clone());

        for dt_s in [-1.0, f64::NAN] {
            take(&mut cloth, &mut balance, dt_s).expect_err("no step");
            assert_eq!(left_behind(&cloth, &balance), before, "{name}, {dt_s} s");
        }
        cloth.system_mut().set_stretch_ratio_max(0.5);
        let others: [Box<dyn Solver>; 3] = [
            Box::new(Xpbd::default()),
            Box::new(Pbd::default()),
            Box::new(Late),
        ];
        for mut other in others {
            let system = cloth.system_mut();
            let refused = system.step_observed(&mut *other, dt_s, Some(&mut balance));
            refused.expect_err("a blow-up");
            assert_eq!(left_behind(&cloth, &balance), before, "{name}");
            // What it left behind in constraints counts for nothing.
            let system = cloth.system();
            for id in system.stretches().iter() {
                assert_eq!(force::force_n(system, id), tension_n(system, id));
                let load = Threshold::Stretch(2.0).load(system, id);
                assert_eq!(load, Some(system.stretch_ratio(id) - 1.0));
            }
        }
        cloth.system_mut().set_stretch_ratio_max(100.0);
        for (number, way) in RASH.into_iter().enumerate() {
            let mut tried = cloth.clone();
            let system = tried.system_mut();
            // As if the one who is led had been pushed.
            system.state_mut().1[0].z = 0.25;
            let left = state(system);
            let refused = system.step(&mut Rash(way), dt_s);
            refused.expect_err("a blow-up");
            assert!(state(system) == left, "{name}, way {number}");
        }
        // And the balance goes on as if nothing had been, from forces by lengths.
        let _ = untried.0.system_mut().state_mut();
        let mut both = [(cloth, balance), untried];
        for (cloth, balance) in &mut both {
            let observed = (cloth.system_mut(), balance);
            take_observed(observed, &mut Xpbd::new(1, 1), dt_s, 8);
        }
        let [tried, untried] = both.map(|(cloth, balance)| left_behind(&cloth, &balance));
        assert_eq!(tried, untried, "{name}");
    }
}

/// Provot's limiter, by way of a step that is taken, and then a failure.
#[derive(Debug)]
struct Late;

impl Solver for Late {
    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        let _ = Pbd::default().advance(system, dt_s);
        system.set_stretch_ratio_max(1e9);
        for _ in 0..2 {
            Xpbd::default().advance(system, dt_s)?;
            Provot::default().advance(system, dt_s)?;
        }
        system.set_stretch_ratio_max(0.5);
        Err(Failure::BlowUp)
    }
}

/// A method of the caller's, which changes something and gives up.
#[derive(Debug)]
struct Rash(fn(&mut System, f64));

impl Solver for Rash {
    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        (self.0)(system, dt_s);
        Err(Failure::BlowUp)
    }
}

/// What one may change before it gives up.
const RASH: [fn(&mut System, f64); 9] = [
    |_, _| {},
    |system, _| system.state_mut().0[7].x += 1.0,
    |system, _| system.state_mut().1[7].x += 1.0,
    |system, _| system.hold(7),
    |system, _| system.release(0),
    |system, _| system.grab(7, path([(0.0, [0.0; 3])])),
    |system, dt_s| {
        // Once beside where the step began, and once more.
        Verlet.advance(system, dt_s).expect("a step");
        Verlet.advance(system, dt_s).expect("a step");
    },
    |system, dt_s| Xpbd::default().advance(system, dt_s).expect("a step"),
    |system, dt_s| Implicit::default().advance(system, dt_s).expect("a step"),
];

#[test]
fn unusable_settings_are_refused_by_name_and_number() {
    let pbd = |stiffness, bend_stiffness| {
        Box::new(Pbd {
            sweeps: 1,
            stiffness,
            bend_stiffness,
        })
    };
    let provot = |stretch_ratio_max| {
        Box::new(Provot::new(Limiter {
            stretch_ratio_max,
            ..Limiter::default()
        }))
    };
    let implicit = |tolerance| Box::new(implicit_to(Method::BackwardEuler, tolerance));
    let cases: [(Box<dyn Solver>, &str, f64); 8] = [
        (pbd(f64::NAN, 0.1), "stiffness", f64::NAN),
        (pbd(2.0, 0.1), "stiffness", 2.0),
        (pbd(1.0, -1.0), "bend_stiffness", -1.0),
        (pbd(1.0, 2.0), "bend_stiffness", 2.0),
        (provot(f64::NAN), "stretch_ratio_max", f64::NAN),
        (provot(0.0), "stretch_ratio_max", 0.0),
        (implicit(f64::NAN), "tolerance", f64::NAN),
        (implicit(-1.0), "tolerance", -1.0),
    ];
    for (mut solver, name, given) in cases {
        let mut system = stiff();
        let before = system.positions().to_vec();
        let named = match system.step(&mut *solver, 0.001) {
            Err(StepError::Setting(error)) => (error.setting, error.given.to_bits()),
            other => panic!("{name} {given}: {other:?}"),
        };
        assert_eq!(named, (name, given.to_bits()));
        assert_eq!(system.positions(), before);
    }
    let mut system = stiff();
    system.set_stretch_ratio_max(f64::NAN);
    let error = system.step(&mut Xpbd::default(), 0.001).expect_err("NaN");
    let text = "stretch_ratio_max is NaN, and has to be finite and above 0";
    assert_eq!(error.to_string(), text);
}

#[test]
fn no_sweep_counts_as_one() {
    let moved = |sweeps| {
        let mut system = stiff();
        system.state_mut().0[3].x += 0.01;
        system.step(&mut Pbd::new(sweeps), 0.01).expect("a step");
        system.positions().to_vec()
    };
    assert_eq!(moved(0), moved(1));
    assert_ne!(moved(1), moved(2));
}

//! A system's springs under the implicit solver: the reference answers that apply to it, and
//! edits of a running cloth.

use std::error::Error as _;

use tearmesh::cloth::implicit::{self, Method, Settings, Tolerance};
use tearmesh::cloth::{Cloth, Culprit, Fabric, ImplicitCloth, Loads, Path, StepError, System};
use tearmesh::{Edits, Masses, Point, Vector, shapes, split};

const G: f64 = 9.81;

fn falling() -> Loads {
    Loads {
        gravity_m_per_s2: Some(Vector::new(0.0, 0.0, -G)),
        ..Loads::default()
    }
}

fn exact(method: Method) -> ImplicitCloth {
    ImplicitCloth::new(Settings {
        method,
        tolerance: Tolerance::Fixed(1e-11),
        newton_iterations_max: 30,
        ..Settings::default()
    })
}

/// R1: k = 40 N/m, m = 0.01 kg, Δt = 0.01 s. Backward Euler keeps this part of the amplitude.
#[test]
fn an_oscillator_fades_by_the_factor_of_backward_euler() {
    let points = [Point::origin(), Point::new(1.1, 0.0, 0.0)];
    let mut system = System::new(points, vec![0.01; 2]).expect("two particles");
    system.stretch([0, 1], 1.0, 40.0).expect("a spring");
    system.hold(0);
    let mut solver = exact(Method::BackwardEuler);
    let energy = |system: &System| {
        let (x, v) = (system.positions()[1].x - 1.0, system.velocities()[1].x);
        40.0 * x * x + 0.01 * v * v
    };
    for _ in 0..20 {
        let before = energy(&system);
        system.step(&mut solver, 0.01).expect("a step");
        let factor = (energy(&system) / before).sqrt();
        assert!((factor - 0.845_154_254_728_517).abs() < 1e-9, "{factor}");
    }
}

/// R2: the hanging chain, N L + m g N (N + 1) / (2 k) long, at every step.
#[test]
fn a_hanging_chain_is_as_long_as_it_should_be_at_every_step() {
    for method in [Method::BackwardEuler, Method::Bdf2] {
        for dt_s in [1.0, 0.1, 1.0 / 60.0] {
            let points = (0..11).map(|i| Point::new(0.0, 0.0, -0.1 * f64::from(i)));
            let mut chain = System::new(points, vec![0.01; 11]).expect("eleven particles");
            for i in 0..10 {
                chain.stretch([i, i + 1], 0.1, 50.0).expect("a spring");
            }
            chain.hold(0);
            let drag_per_s = Some(5.0);
            chain
                .set_loads(Loads {
                    drag_per_s,
                    ..falling()
                })
                .expect("loads");
            let mut solver = exact(method);
            for _ in 0..3000 {
                chain.step(&mut solver, dt_s).expect("a step");
            }
            let length = -chain.positions()[10].z;
            assert!(
                (length - 1.107_91).abs() < 1e-8,
                "{method:?} at {dt_s}: {length}"
            );
        }
    }
}

/// A grabbed particle is where its path says, and drags the other along.
#[test]
fn a_grabbed_particle_keeps_to_its_path() {
    let points = [Point::origin(), Point::new(0.0, 0.0, -1.0)];
    let mut system = System::new(points, vec![0.1; 2]).expect("two particles");
    system.stretch([0, 1], 1.0, 500.0).expect("a spring");
    let path = Path::new([(0.0, Point::origin()), (1.0, Point::new(2.0, 0.0, 0.0))]);
    system.grab(0, path.expect("a path"));
    system
        .set_loads(Loads {
            drag_per_s: Some(3.0),
            ..falling()
        })
        .expect("loads");
    let mut solver = ImplicitCloth::default();
    for step in 1..=300 {
        system.step(&mut solver, 0.01).expect("a step");
        let x = (f64::from(step) * 0.02).min(2.0);
        assert!((system.positions()[0] - Point::new(x, 0.0, 0.0)).norm() < 1e-9);
    }
    let dragged = system.positions()[1];
    assert!(
        (dragged - Point::new(2.0, 0.0, -1.0)).norm() < 0.1,
        "{dragged}"
    );
}

/// R9: a sheet in free fall keeps strain 0; after one second in 60 steps it is 4.98675 lower.
#[test]
fn a_falling_cloth_keeps_its_shape_while_it_is_torn() {
    let (mut mesh, positions) = shapes::grid(6, 6);
    let masses = Masses::area(&mesh, &positions, 0.2).expect("an area");
    let mut cloth = Cloth::new(&mesh, &positions, masses, Fabric::new(1000.0)).expect("a cloth");
    cloth.system_mut().set_loads(falling()).expect("loads");
    let mut edits = Edits::new();
    let mut solver = exact(Method::BackwardEuler);
    for step in 0..60 {
        cloth.step(&mut solver, 1.0 / 60.0).expect("a step");
        if step % 10 == 5 {
            let v = mesh.vertices().nth(10 + step / 3).expect("a vertex");
            let face = mesh.faces_of(v).next().expect("a face");
            split::faces(&mut mesh, v, &[face], &mut edits).expect("more than one face");
            edits.replay(&mut cloth);
        }
    }
    let fallen = |p: &Point| (p.z + 4.986_75).abs();
    let worst = cloth
        .system()
        .positions()
        .iter()
        .map(fallen)
        .fold(0.0, f64::max);
    assert!(worst < 1e-9, "{worst}");
    assert!(cloth.system().strain_rms() < 1e-10);
    assert_eq!(cloth.system().positions().len(), mesh.vertex_count());
}

/// A tolerance that is missed is said, with the residual; the system is as it was, and goes on
/// with a step that is short enough.
#[test]
fn a_step_that_misses_its_tolerance_is_no_blow_up() {
    let points = [Point::origin(), Point::new(0.0, 0.0, -1.0)];
    let mut system = System::new(points, vec![0.1; 2]).expect("two particles");
    system.stretch([0, 1], 1.0, 500.0).expect("a spring");
    system.hold(0);
    system.set_loads(falling()).expect("loads");
    system.state_mut().1[1] = Vector::new(20.0, 0.0, 0.0);
    let settings = Settings {
        tolerance: Tolerance::Fixed(1e-6),
        newton_iterations_max: 2,
        ..Settings::default()
    };
    let mut solver = ImplicitCloth::new(settings);
    system.step(&mut solver, 1e-4).expect("a short step");
    let before = (system.positions().to_vec(), system.velocities().to_vec());
    let elapsed = system.elapsed_s();
    let error = system.step(&mut solver, 0.1).expect_err("a long step");
    let StepError::Implicit {
        elapsed_s,
        error: why,
    } = error
    else {
        panic!("{error}");
    };
    let implicit::StepError::NotConverged {
        residual,
        limit,
        newton_iterations,
        ..
    } = why
    else {
        panic!("{why}");
    };
    assert!(residual > limit, "{residual} {limit}");
    assert_eq!((limit, newton_iterations), (1e-6, 2));
    assert_eq!((elapsed_s, system.elapsed_s()), (elapsed, elapsed));
    assert_eq!(
        before,
        (system.positions().to_vec(), system.velocities().to_vec())
    );
    let source = error.source().expect("the reason");
    assert_eq!(source.to_string(), why.to_string());
    assert!(error.to_string().contains(&why.to_string()), "{error}");
    system.step(&mut solver, 1e-4).expect("a short step");

    // What is nowhere before the step is a blow-up for every method.
    system.state_mut().0[1].y = f64::NAN;
    let error = system.step(&mut solver, 1e-4).expect_err("not a number");
    let nowhere = Culprit::Particle(1);
    assert!(
        matches!(error, StepError::BlowUp { at, .. } if at == nowhere),
        "{error}"
    );
}

//! A system's springs under the implicit solver: the reference answers that apply to it, and
//! edits of a running cloth.

use std::error::Error as _;

use tearmesh::{Edits, Masses, Point, Vector, shapes, split};
use tearmesh_cloth::implicit::{self, Method, Settings};
use tearmesh_cloth::statistics::Random;
use tearmesh_cloth::{
    BlowUpSite, Cloth, Fabric, Implicit, Path, StepError, System, Verlet, energy,
};

use crate::parts::cloths::cloth;
use crate::parts::nets::{chain, row};
use crate::parts::{
    gravity, implicit, implicit_by_default, implicit_to, mechanical_j, solved, strain_max,
};

/// R1: k = 40 N/m, m = 0.01 kg, Δt = 0.01 s. Backward Euler keeps this part of the amplitude.
#[test]
fn an_oscillator_fades_by_the_factor_of_backward_euler() {
    let mut system = row(1, 0.01, 40.0, 1.0, Vector::new(1.1, 0.0, 0.0));
    let mut solver = implicit(Method::BackwardEuler);
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
            let mut chain = chain(5.0);
            let mut solver = implicit(method);
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
    system.set_loads(gravity(3.0)).expect("loads");
    let mut solver = Implicit::default();
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
    let mut cloth = cloth(&mesh, &positions, Fabric::new(1000.0));
    cloth.system_mut().set_loads(gravity(0.0)).expect("loads");
    let mut edits = Edits::new();
    let mut solver = implicit(Method::BackwardEuler);
    for step in 0..60 {
        cloth.step(&mut solver, 1.0 / 60.0).expect("a step");
        if step % 10 == 5 {
            let v = mesh.vertices().nth(10 + step / 3).expect("a vertex");
            let face = mesh.faces_of(v).next().expect("a face");
            split::vertex(&mut mesh, v, &[face], &mut edits).expect("more than one face");
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
    assert!(strain_max(cloth.system()) < 1e-10);
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
    system.set_loads(gravity(0.0)).expect("loads");
    system.state_mut().1[1] = Vector::new(20.0, 0.0, 0.0);
    let mut solver = Implicit::default();
    system.step(&mut solver, 1e-4).expect("a short step");
    solver.settings.solver_iterations_max = 0;
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
        solver_iterations,
    } = why
    else {
        panic!("{why}");
    };
    assert!(residual > limit, "{residual} {limit}");
    assert_eq!(solver_iterations, 0);
    assert_eq!((elapsed_s, system.elapsed_s()), (elapsed, elapsed));
    assert_eq!(
        before,
        (system.positions().to_vec(), system.velocities().to_vec())
    );
    let source = error.source().expect("the reason");
    assert_eq!(source.to_string(), why.to_string());
    assert!(error.to_string().contains(&why.to_string()), "{error}");
    solver.settings = Settings::default();
    system.step(&mut solver, 1e-4).expect("a short step");

    // What is nowhere before the step is a blow-up for every method.
    system.state_mut().0[1].y = f64::NAN;
    let error = system.step(&mut solver, 1e-4).expect_err("not a number");
    let nowhere = BlowUpSite::Particle(1);
    assert!(
        matches!(error, StepError::BlowUp { at, .. } if at == nowhere),
        "{error}"
    );
}

/// A crumb: a triangle of springs that nothing holds, spinning by ω about its centre.
fn crumb(omega_rad_per_s: f64) -> System {
    let (mesh, positions) = shapes::grid(1, 1);
    let corners = mesh.face_vertices(mesh.faces().next().expect("a face"));
    let size = 1.0 / 64.0;
    let points = corners.map(|v| Point::from(positions.at(v).coords * size));
    let mut crumb = System::new(points, vec![4e-5; 3]).expect("three particles");
    for ends in [[0, 1], [1, 2], [2, 0]] {
        let length_m = (points[ends[1]] - points[ends[0]]).norm();
        crumb.stretch(ends, length_m, 1000.0).expect("a spring");
    }
    let centre = (points[0].coords + points[1].coords + points[2].coords) / 3.0;
    for (x, v) in points.iter().zip(crumb.state_mut().1) {
        *v = Vector::z().cross(&(x.coords - centre)) * omega_rad_per_s;
    }
    crumb
}

fn stretched(system: &System) -> f64 {
    let ids = system.stretches().iter();
    ids.map(|id| system.stretch_ratio(id)).fold(0.0, f64::max)
}

/// The tangent of a step is √(1 + (ω Δt)²) times as long as the radius, and linearised forces do
/// not feel it. A step that would stretch it by more than 15 %, or make .3 % of the energy that is in motion
/// and that it stores, is divided, and counted.
#[test]
fn a_crumb_that_spins_fast_keeps_its_size_and_makes_no_energy() {
    let dt_s = 1.0 / 240.0;
    for turn in [0.01, 0.1, 0.5, 1.0, 3.0, 10.0] {
        let mut crumb = crumb(turn / dt_s);
        let mut solver = Implicit::default();
        let energy = energy::kinetic_j(&crumb);
        let tangent = (1.0 + turn * turn).sqrt();
        let flown_j = {
            let mut flown = crumb.clone();
            let (points, velocities) = flown.state_mut();
            let particles = points.iter_mut().zip(velocities);
            particles.for_each(|(x, v)| *x += *v * dt_s);
            energy::elastic_j(&flown)
        };
        let is_far = tangent > 1.15 || flown_j > 0.003 * (energy + flown_j);
        let mut most = 0.0_f64;
        for step in 0..50 {
            crumb.step(&mut solver, dt_s).expect("a step");
            most = most.max(stretched(&crumb));
            if step == 0 {
                let overshot = crumb.counters().overshoots == 1;
                let parts = solved(&solver, &crumb).parts;
                assert_eq!((overshot, parts > 1), (is_far, is_far), "{turn}");
            }
        }
        let left = mechanical_j(&crumb) / energy;
        println!(
            "{turn} rad a step: {most:.4} of its size, {left:.1e} of its energy is left; {} overshoots",
            crumb.counters().overshoots
        );
        assert!(
            most <= tangent.min(1.2) * 1.001 && left < 1.0,
            "{turn}: {most} {left}"
        );
    }
}

/// A crumb that spins so fast that no part of the step that is tried would do.
#[test]
fn a_step_that_no_division_helps_is_refused() {
    let dt_s = 1.0 / 240.0;
    let mut crumb = crumb(1e3 / dt_s);
    let before = crumb.velocities().to_vec();
    let refused = crumb.step(&mut Implicit::default(), dt_s);
    let error = implicit::StepError::Overshot;
    assert_eq!(
        refused,
        Err(StepError::Implicit {
            elapsed_s: 0.0,
            error
        })
    );
    assert_eq!(crumb.velocities(), before);
}

/// Between two springs, nearly straight and compressed: at the step where the matrix is all but
/// singular, 9.75 ms (F12), linearised forces throw the middle as far as one likes. A step that
/// stretches the springs by more than 15 % by turning them, or makes energy, is divided.
#[test]
fn a_matrix_that_is_all_but_singular_throws_nothing_away() {
    let (k, m, l, rest, speed) = (1e3, 0.01, 0.095, 0.1, 0.1);
    let (mut thrown, mut farthest) = (0, 0.0_f64);
    for i in 0..200 {
        let dt_s = 9.746_794_344_808_97e-3 * (1.0 - 1e-6 - 4.9e-3 * f64::from(i));
        let points = [-l, 0.0, l].map(|x| Point::new(x, 0.0, 0.0));
        let mut row = System::new(points, vec![m; 3]).expect("three particles");
        row.stretch([0, 1], rest, k).expect("a spring");
        row.stretch([1, 2], rest, k).expect("a spring");
        row.hold(0);
        row.hold(2);
        row.state_mut().1[1] = Vector::new(0.0, speed, 0.0);
        row.step(&mut implicit(Method::BackwardEuler), dt_s)
            .expect("a step");
        let y = row.positions()[1].y;
        // The linearised answer, by hand; and how long it would make the springs.
        let inertia = m / (dt_s * dt_s);
        let linear = m * speed / dt_s / (inertia - 2.0 * k * (rest / l - 1.0));
        let overshot = row.counters().overshoots == 1;
        let long = (l * l + linear * linear).sqrt();
        let elastic_j = |length: f64| k * (length - rest) * (length - rest);
        let kinetic_j = |speed: f64| 0.5 * m * speed * speed;
        let changed_j = elastic_j(long) - elastic_j(l);
        let made_j = changed_j + kinetic_j(linear / dt_s) - kinetic_j(speed);
        let makes = made_j > 0.003 * (kinetic_j(speed) + changed_j.abs());
        assert_eq!(overshot, long > 1.15 * rest || makes, "{i}: {linear}");
        if overshot {
            assert!(y.abs() < 0.07, "{i}: {y}");
        } else {
            assert!((y - linear).abs() < 1e-8, "{i}: {y} {linear}");
        }
        thrown += u32::from(overshot);
        farthest = farthest.max(linear);
    }
    println!("{thrown} of 200 steps were divided, of up to {farthest} m");
    assert!(thrown > 0 && thrown < 200 && farthest > 100.0);
}

/// What is beyond the limit of stretch after a step is a blow-up, of a spring and of a triangle,
/// with its place; the system is as it was, and what was within it goes on.
#[test]
fn stretch_beyond_the_limit_is_a_blow_up() {
    let row = || {
        let points = [0.0, 1.0, 5000.0].map(|x| Point::new(x, 0.0, 0.0));
        let mut row = System::new(points, vec![0.1; 3]).expect("three particles");
        row.stretch([0, 1], 1.0, 10.0).expect("a spring");
        row.stretch([1, 2], 1.0, 10.0).expect("a spring");
        row
    };
    let folded = || {
        let mut bend = row();
        bend.bend([0, 2], 2.0, 10.0).expect("a bend");
        bend.set_buckling(Some(tearmesh_cloth::Buckling::new(0.95).expect("a law")));
        bend
    };
    let woven = || {
        let points = [[0.0; 3], [300.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
        let mut woven = System::new(points, vec![0.1; 3]).expect("three particles");
        let flat = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        woven.triangle([0, 1, 2], flat, [10.0; 3]).expect("area");
        woven
    };
    for (name, mut system) in [("row", row()), ("folded", folded()), ("woven", woven())] {
        for method in [Method::BackwardEuler, Method::Bdf2] {
            let before = (system.positions().to_vec(), system.velocities().to_vec());
            let mut explicit = system.clone();
            let verlet = explicit.step(&mut Verlet::new(), 1e-4).map(|_| ());
            let mut solver = implicit_by_default(method);
            let step = system.step(&mut solver, 1e-4).map(|_| ());
            println!("{name}, {method:?}: {step:?}, Verlet {verlet:?}");
            let (Err(StepError::BlowUp { at, .. }), Err(StepError::BlowUp { at: other, .. })) =
                (step, verlet)
            else {
                panic!("{name}: {step:?} {verlet:?}");
            };
            let place = |at| match at {
                BlowUpSite::Constraint { ends, .. } => ends.to_vec(),
                BlowUpSite::Triangle { corners, .. } => corners.to_vec(),
                _ => vec![],
            };
            assert_eq!(place(at), place(other), "{name}");
            let after = (system.positions().to_vec(), system.velocities().to_vec());
            assert_eq!(before, after, "{name}");
            assert_eq!(
                solved(&solver, &system).parts,
                0,
                "{name}: no step was taken"
            );
            system.set_stretch_ratio_max(1e4);
            system.step(&mut solver, 1e-4).expect("within the limit");
            system.set_stretch_ratio_max(100.0);
        }
    }
}

/// A step that was refused is no step before the next: BDF2 starts anew.
#[test]
fn a_refused_step_is_no_history() {
    let points = [Point::origin(), Point::new(1.0, 0.0, 0.0)];
    let mut system = System::new(points, vec![0.1; 2]).expect("two particles");
    system.stretch([0, 1], 1.0, 10.0).expect("a spring");
    system.state_mut().1[1] = Vector::new(3.0, 1.0, 0.0);
    let mut solver = implicit(Method::Bdf2);
    for _ in 0..3 {
        system.step(&mut solver, 0.01).expect("a step");
    }
    system.set_stretch_ratio_max(1.0);
    let refused = system.step(&mut solver, 0.01);
    assert!(
        matches!(refused, Err(StepError::BlowUp { .. })),
        "{refused:?}"
    );
    system.set_stretch_ratio_max(100.0);
    let mut twin = system.clone();
    system.step(&mut solver, 0.01).expect("a step");
    twin.step(&mut implicit(Method::Bdf2), 0.01)
        .expect("a step");
    assert_eq!(system.positions(), twin.positions());
    assert_eq!(system.velocities(), twin.velocities());
}

/// What a step cost is counted, whether it is taken or not.
#[test]
fn the_work_of_a_refused_step_is_counted() {
    let (mesh, positions) = shapes::grid(8, 8);
    let masses = Masses::area(&mesh, &positions, 0.15).expect("an area");
    let mut cloth = Cloth::new(&mesh, &positions, masses, Fabric::new(1000.0)).expect("a cloth");
    cloth.system_mut().hold(0);
    cloth.system_mut().set_loads(gravity(0.0)).expect("loads");
    for x in cloth.system_mut().state_mut().0 {
        x.coords *= 1.01;
    }
    let mut solver = Implicit::new(Settings {
        solver_iterations_max: 5,
        tolerance: 1e-9,
        ..Settings::default()
    });
    let before = cloth.system().counters();
    let error = cloth.step(&mut solver, 0.02).expect_err("five iterations");
    let StepError::Implicit {
        error: implicit::StepError::NotConverged {
            solver_iterations, ..
        },
        ..
    } = error
    else {
        panic!("{error}");
    };
    let after = cloth.system().counters();
    println!("{error}: {after:?}");
    assert_eq!(after.force_evaluations - before.force_evaluations, 1);
    // One product for the right-hand side, and one an iteration.
    let products = after.matrix_products - before.matrix_products;
    assert_eq!(products, u64::from(solver_iterations) + 1);

    // A step that is taken counts what its report says, once.
    solver.settings = Settings::default();
    cloth.step(&mut solver, 0.02).expect("a step");
    let iterations = solved(&solver, cloth.system()).solver_iterations;
    let taken = cloth.system().counters();
    assert_eq!(
        taken.matrix_products - after.matrix_products,
        iterations + 1
    );
    assert_eq!(taken.force_evaluations - after.force_evaluations, 1);
}

/// Implicit steps are stable at any length: chains of springs that are pushed at random and then left alone
/// have less energy than they were given ever after, whatever the step.
#[test]
fn pushed_chains_never_have_more_energy_than_they_were_given() {
    let (k, m) = (100.0, 0.01);
    let omega = 2.0 * f64::sqrt(k / m);
    // Of all with 2 to 39 links and three seeds, those that come to more if a step may make .5 %; and some
    // others.
    let nearest = [(12, 1), (15, 2), (18, 1), (22, 2), (26, 1), (27, 3)];
    let others = (2..40).step_by(6).map(|links| (links, 1));
    for (links, seed) in others.chain(nearest) {
        let mut pushed = row(links, m, k, 0.1, Vector::x() * 0.1);
        let mut random = Random::new(100 * links as u64 + seed);
        for i in 1..=links {
            let mut push = || 1e-4 * omega * (2.0 * random.next() - 1.0);
            pushed.state_mut().1[i] = Vector::new(push(), push(), push());
        }
        let given_j = mechanical_j(&pushed);
        for (method, times) in [Method::BackwardEuler, Method::Bdf2]
            .into_iter()
            .flat_map(|method| [10.0, 100.0, 1000.0].map(|times| (method, times)))
        {
            let mut chain = pushed.clone();
            let tolerance = 10.0;
            let mut solver = implicit_to(method, tolerance);
            for step in 0..300 {
                let name = || format!("{links} links, {seed}, {method:?}, {times}, step {step}");
                let done = chain.step(&mut solver, times * 2.0 / omega);
                done.unwrap_or_else(|error| panic!("{}: {error}", name()));
                let part = mechanical_j(&chain) / given_j;
                assert!(part < 1.0, "{}: {part} of the energy", name());
            }
        }
    }
}

/// The elastic energy that a step left is that of the next one's beginning, unless something has changed.
#[test]
fn a_step_begins_with_the_energy_that_is_there() {
    let stiffen = |row: &mut System| {
        let ids: Vec<_> = row.stretches().iter().collect();
        for id in ids {
            row.set_stiffness(id, 1e5).expect("a stiffness");
        }
    };
    let go_on = |row: &mut System| {
        for _ in 0..20 {
            row.step(&mut Verlet::new(), 1e-3).expect("a step");
        }
    };
    for (name, change) in [
        ("stiffer", stiffen as fn(&mut System)),
        ("moved by another method", go_on),
    ] {
        let mut row = row(4, 0.01, 100.0, 0.1, Vector::x() * 0.11);
        row.state_mut().1[4] = Vector::x() * 5.0;
        let mut solver = Implicit::default();
        row.step(&mut solver, 1e-3).expect("a step");
        change(&mut row);
        let mut anew = row.clone();
        row.step(&mut solver, 1e-3).expect("a step");
        anew.step(&mut Implicit::default(), 1e-3).expect("a step");
        assert_eq!(row.positions(), anew.positions(), "{name}");
        assert_eq!(row.counters().overshoots, anew.counters().overshoots);
    }
}

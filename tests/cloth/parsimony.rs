//! A scene pays for what it uses, and for nothing else: by counts, at the defaults of each method. By a clock:
//! `tools/bench`, subcommand `cloth`.

use tearmesh::{CutMethod, Edits, Follower as _, Positions, Scissor, Vector};
use tearmesh_cloth::implicit;
use tearmesh_cloth::scene::{Run, Scene};
use tearmesh_cloth::{
    Collider, Counters, Fabric, FeatureVisits, Limiter, Method, Pbd, Provot, Tearing, Threshold,
    Unstable, Verlet, Xpbd,
};

use crate::parts::cloths::{bent, loaded};
use crate::parts::nets::chain;
use crate::parts::scenes::{methods, play, staged, swaying};
use crate::parts::woven::weave;
use crate::parts::{gravity_along_y, implicit, onto, plane, run, run_with, solved, state};
use crate::rk4::Rk4;

/// A quarter of a second of hanging, with no more than is added.
fn cost(method: usize, add: impl Fn(&mut Scene)) -> (Run, Counters) {
    let run = play(staged(12, |frame| {
        let mut scene = Scene {
            solver: methods()[method].1.clone(),
            duration_s: 0.25,
            tearing: None,
            ..Scene::hang(frame)
        };
        add(&mut scene);
        scene
    }));
    let counters = run.cloth().system().counters();
    let (features, visits) = (counters.features, counters.visits);
    let elements = features.stretch + features.bend + features.triangle;
    assert_eq!(elements, visits.project + visits.force);
    (run, counters)
}

#[test]
fn a_scene_pays_for_what_it_uses_and_for_nothing_else() {
    for (method, name) in Method::NAMES.into_iter().enumerate() {
        let (run, bare) = cost(method, |_| {});
        let springs = run.cloth().system().stretches().len() as u64;
        let stretch = bare.features.stretch;
        assert!(stretch >= bare.substeps * springs && stretch % springs == 0);
        let alone = FeatureVisits {
            stretch,
            ..FeatureVisits::default()
        };
        assert_eq!((bare.features, bare.visits.detect), (alone, 0), "{name}");
        let passes = (bare.wind_evaluations, bare.collider_passes);
        assert_eq!(passes, (0, 0), "{name}");

        let (_, windy) = cost(method, |scene| {
            scene.wind = Some(swaying(1.0, 0.0, 1.0));
        });
        let faces = run.mesh().face_count() as u64;
        let wind = windy.features.wind;
        assert!(windy.wind_evaluations >= windy.substeps, "{name}");
        let each = windy.wind_evaluations * faces;
        assert!(wind >= each && wind % faces == 0, "{name}");

        let floor = Collider::plane(plane([0.0, -1e3, 0.0], Vector::y()));
        let (_, above) = cost(method, |scene| scene.colliders.push(floor.clone()));
        let visits = above.features;
        let each = above.substeps * run.mesh().vertex_count() as u64;
        assert_eq!(visits.collider, each, "{name}");
        assert_eq!(visits.wind + visits.bend + above.visits.detect, 0, "{name}");

        let (run, bending) = cost(method, |scene| scene.fabric = bent(scene.fabric, 1.0));
        let bends = run.cloth().system().bends().len() as u64;
        let visits = bending.features.bend;
        let each = bending.substeps * bends;
        assert!(visits >= each && visits % bends == 0, "{name}");

        // One pass over edges finds what may tear.
        let never = Some(Tearing::new(Threshold::Stretch(100.0)));
        let (torn, tearing) = cost(method, |scene| scene.tearing = never);
        let each = torn.tally().steps * springs;
        assert_eq!(tearing.visits.detect, each, "{name}");
        assert_eq!(tearing.features, bare.features, "{name}");
    }
}

/// The log of a cut changes what is there to be visited, and visits nothing.
#[test]
fn a_cut_through_a_cloth_visits_no_element() {
    for fabric in [Fabric::default(), Fabric::orthotropic(weave())] {
        let (run, counters) = cost(2, |scene| scene.fabric = fabric);
        let triangles = counters.features.triangle;
        assert_eq!(triangles > 0, fabric.orthotropic.is_some());
        assert_eq!(triangles % run.mesh().face_count() as u64, 0);
        let (mut mesh, mut cloth) = (run.mesh().clone(), run.cloth().clone());
        let now = cloth.positions().iter().map(|p| [p.x, p.y, p.z]);
        let mut now = Positions::new(now)
            .expect("finite")
            .starting_at(cloth.seen());
        let before = cloth.system().counters();
        let across = plane([0.41, 0.0, 0.0], Vector::x());
        let mut edits = Edits::starting_at(cloth.seen());
        Scissor::by_plane(across)
            .cut(CutMethod::Exact, &mut mesh, &mut now, &mut edits)
            .expect("in step");
        edits.replay(&mut cloth);
        assert_eq!(mesh.components().count(), 2);
        assert_eq!(cloth.system().counters(), before);
    }
}

/// How often forces are summed and springs projected, method by method.
#[test]
fn each_method_counts_what_it_evaluates() {
    let mut chain = chain(0.0);
    chain.when_unstable(Unstable::Allow);
    run(&mut chain, Verlet, 0.001, 10);
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
    // One product for the right-hand side, and one an iteration, whether the step is taken or refused.
    let mut solver = implicit(implicit::Method::BackwardEuler);
    let settings = solver.settings;
    solver.settings.solver_iterations_max = 5;
    let refused = chain.step(&mut solver, 0.02).expect_err("five iterations");
    assert!(refused.to_string().contains("5 iterations"), "{refused}");
    assert_eq!(chain.counters().matrix_products, 6);
    solver.settings = settings;
    run_with(&mut chain, &mut solver, 0.02, 1);
    let iterations = solved(&solver, &chain).solver_iterations;
    assert_eq!(chain.counters().matrix_products, 6 + iterations + 1);
    assert_eq!(chain.counters().force_evaluations, 11 + 40 + 10 + 2);
}

/// Contact moves particles before forces are summed, so these serve the next step too: with and without friction.
#[test]
fn contact_costs_no_second_sum_of_forces() {
    for friction in [0.0, 0.3] {
        let (_, mut lying) = loaded(6, Fabric::new(1e3), gravity_along_y(1.0));
        let floor = Collider::plane(plane([0.0, 0.3, 0.0], Vector::y())).with_friction(friction);
        let loads = onto(floor, &gravity_along_y(1.0));
        lying.system_mut().set_loads(loads).expect("loads");
        run(lying.system_mut(), Verlet, 1e-4, 10);
        assert_eq!(lying.system().counters().force_evaluations, 11);
        let lowest = lying.positions().iter().map(|x| x.y);
        assert_eq!(lowest.fold(f64::INFINITY, f64::min), 0.3, "it lies there");
    }
}

/// Without colliders, the end of a substep and the begin of the next are one pass.
#[test]
fn a_collider_that_nothing_meets_changes_no_bit_of_a_step() {
    let (_, mut free) = loaded(12, Fabric::new(1e4), gravity_along_y(1.0));
    (156..169).for_each(|top| free.system_mut().hold(top));
    let mut above = free.clone();
    let floor = Collider::plane(plane([0.0, -1e3, 0.0], Vector::y()));
    let loads = onto(floor, &gravity_along_y(1.0));
    above.system_mut().set_loads(loads).expect("loads");
    for _ in 0..20 {
        for cloth in [&mut free, &mut above] {
            run(cloth.system_mut(), Xpbd::new(5, 2), 1.0 / 60.0, 1);
        }
        assert_eq!(state(free.system()), state(above.system()));
    }
    assert_eq!(above.system().counters().collider_passes, 20 * 5);
}

//! A scene pays for what it uses, and for nothing else: by counts, at the defaults of each method.

use tearmesh::{CutMethod, Edits, Plane, Point, Positions, Scissor, Vector};
use tearmesh_cloth::scene::{Frame, Run, Scene, SwayingWind};
use tearmesh_cloth::{
    Bending, Collider, Counters, FeatureVisits, Limiter, Pbd, Provot, Tearing, Threshold, Unstable,
    Verlet, Wind, Xpbd,
};

use crate::parts::nets::chain;
use crate::parts::run;
use crate::parts::scenes::{methods, play, staged};
use crate::rk4::Rk4;

/// A quarter of a second of hanging, with no more than is added.
fn cost(method: usize, add: impl Fn(&mut Scene, &Frame)) -> (Run, Counters) {
    let run = play(staged(12, |frame| {
        let (_, solver) = methods()[method].clone();
        let mut scene = Scene {
            solver,
            duration_s: 0.25,
            tearing: None,
            ..Scene::hang(frame)
        };
        add(&mut scene, frame);
        scene
    }));
    let counters = run.cloth().system().counters();
    let FeatureVisits {
        stretch,
        bend,
        triangle,
        ..
    } = counters.features;
    let visits = counters.visits;
    assert_eq!(stretch + bend + triangle, visits.project + visits.force);
    (run, counters)
}

#[test]
fn a_scene_pays_for_what_it_uses_and_for_nothing_else() {
    for (method, (name, _)) in methods().iter().enumerate() {
        let (run, bare) = cost(method, |_, _| {});
        let springs = run.cloth().system().stretches().len() as u64;
        let passes = bare.features.stretch / springs;
        assert!(passes >= bare.substeps, "each step looks at each spring");
        let alone = FeatureVisits {
            stretch: passes * springs,
            ..FeatureVisits::default()
        };
        assert_eq!(bare.features, alone, "{name}");
        assert_eq!(bare.visits.detect, 0, "{name}");
        let passes = (bare.wind_evaluations, bare.collider_passes);
        assert_eq!(passes, (0, 0), "{name}");

        let (_, windy) = cost(method, |scene, _| {
            scene.wind = Some(SwayingWind {
                steady: Wind {
                    velocity_m_per_s: Vector::z(),
                    coefficient: 1.0,
                },
                sway_m_per_s: Vector::zeros(),
                period_s: 1.0,
            });
        });
        let faces = run.mesh().face_count() as u64;
        assert!(windy.wind_evaluations >= windy.substeps, "{name}");
        assert!(
            windy.features.wind >= windy.wind_evaluations * faces,
            "{name}"
        );
        assert_eq!(windy.features.wind % faces, 0, "{name}");

        let (_, above) = cost(method, |scene, _| {
            let floor = Plane::new(Point::new(0.0, -1e3, 0.0), Vector::y()).expect("a plane");
            scene.colliders.push(Collider::Plane(floor));
        });
        let vertices = run.mesh().vertex_count() as u64;
        assert_eq!(above.features.collider, above.substeps * vertices, "{name}");
        assert_eq!(
            above.features.wind + above.features.bend + above.visits.detect,
            0,
            "{name}"
        );

        let (bent, bending) = cost(method, |scene, _| {
            scene.fabric.bend = Some(Bending::Spring {
                stiffness_n_per_m: 1.0,
            });
        });
        let bends = bent.cloth().system().bends().len() as u64;
        assert_eq!(bending.features.bend % bends, 0, "{name}");
        assert!(bending.features.bend >= bending.substeps * bends, "{name}");

        // One pass over edges finds what may tear.
        let (torn, tearing) = cost(method, |scene, _| {
            scene.tearing = Some(Tearing::new(Threshold::Stretch(100.0)));
        });
        assert_eq!(
            tearing.visits.detect,
            torn.tally().steps * springs,
            "{name}"
        );
        assert_eq!(tearing.features, bare.features, "{name}");
    }
}

/// The log of a cut changes what is there to be visited, and visits nothing.
#[test]
fn a_cut_through_a_cloth_visits_no_element() {
    for method in 0..methods().len() {
        let (run, _) = cost(method, |_, _| {});
        let (mut mesh, mut cloth) = (run.mesh().clone(), run.cloth().clone());
        let now = cloth.positions().iter().map(|p| [p.x, p.y, p.z]);
        let mut now = Positions::new(now)
            .expect("finite")
            .starting_at(cloth.seen());
        let before = cloth.system().counters();
        let plane = Plane::new(Point::new(0.41, 0.0, 0.0), Vector::x()).expect("a plane");
        let mut edits = Edits::starting_at(cloth.seen());
        Scissor::by_plane(plane)
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
    run(&mut chain, Verlet::new(), 0.001, 10);
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
}

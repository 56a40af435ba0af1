//! Scenes that play: what is held stays, what is led goes where it should, what hangs does not
//! tear, what is ripped comes apart, and nothing is lost on the way.

use tearmesh::{Plane, Point, Ray, Vector, VertexId, shapes};
use tearmesh_cloth::implicit::Settings;
use tearmesh_cloth::scene::{
    Axis, Frame, HeldVertices, Region, Run, RunError, Scene, SwayingWind, TimedCut,
};
use tearmesh_cloth::{
    Collider, Limiter, Method, Path, Pbd, Quality, SimulationError, StepError, Tearing, Threshold,
    Wind, Xpbd, energy, force,
};

use crate::parts::scenes::{methods, play, played, square, staged};

/// Nothing is lost: mass to the last bit, momentum and energy to rounding.
fn check_ledgers(run: &Run) {
    assert!(run.mesh().check().is_empty());
    assert!(run.cloth().masses().ledger().is_balanced());
    assert!(run.tally().momentum_drift < 1e-12, "{:?}", run.tally());
    if run.scene().cuts.is_empty() {
        let made_j = run.energy_balance().edits_j;
        assert!(made_j.abs() < 1e-9, "tears made {made_j} J");
    }
}

fn hanging(cells: u32, solver: &Method) -> Run {
    play(staged(cells, |frame| Scene {
        solver: solver.clone(),
        duration_s: 0.75,
        ..Scene::hang(frame)
    }))
}

fn check_hanging(cells: u32, name: &str, run: &Run) {
    let ratio = run.tally().stretch_ratio_max;
    println!(
        "{name} {cells}: {} steps, stretched up to {ratio}",
        run.tally().steps
    );
    assert_eq!(run.tally().splits, 0, "{name} at {cells}");
    assert!(
        ratio < 1.3,
        "{name} at {cells}: near its threshold, {ratio}"
    );
}

#[test]
fn what_merely_hangs_does_not_tear() {
    for (name, solver) in methods() {
        check_hanging(16, name, played(16, "hang", name));
        if ["verlet", "xpbd"].contains(&name) {
            check_hanging(32, name, played(32, "hang", name));
        } else {
            check_hanging(32, name, &hanging(32, &solver));
        }
    }
    let xpbd = Method::Xpbd(Xpbd::new(1, 1));
    check_hanging(64, "xpbd", &hanging(64, &xpbd));
    let soft = Pbd {
        stiffness: 0.02,
        ..Pbd::default()
    };
    check_hanging(32, "soft pbd", &hanging(32, &Method::Pbd(soft)));
}

#[test]
#[ignore = "minutes: 256 cells a side, by the default method; 128 by all"]
fn what_merely_hangs_does_not_tear_however_fine() {
    let xpbd = Method::Xpbd(Xpbd::new(1, 1));
    check_hanging(256, "xpbd", &hanging(256, &xpbd));
    for (name, solver) in methods() {
        check_hanging(128, name, &hanging(128, &solver));
    }
}

#[test]
fn what_is_ripped_falls_in_pieces_and_nothing_is_lost() {
    for (name, _) in methods() {
        let run = played(16, "rip", name);
        let tally = run.tally();
        println!("{name}: {tally:?}");
        assert!(tally.splits > 10, "{name}");
        assert!(run.mesh().components().count() >= 2, "{name}");
        assert!(run.torn_length_m() > 0.9, "{name} tears across");
        assert!(tally.edge_energy_j > 0.0, "{name}");
        check_ledgers(run);
    }
}

/// A hand rips the cloth about its grip, and does not come off with the few edges that it holds.
#[test]
#[ignore = "a minute: 160 cells a side"]
fn what_is_ripped_tears_on_however_fine() {
    for cells in [64, 160] {
        let mut run = staged(cells, |frame| Scene {
            solver: Method::Implicit(Settings::default()),
            ..Scene::rip(frame)
        });
        while !run.is_over() && run.tally().splits < 2 * u64::from(cells) {
            run.step().expect("a step");
        }
        println!("{cells}: {:?} after {} s", run.tally(), run.elapsed_s());
        assert!(run.torn_length_m() > 0.5, "{cells}");
    }
}

#[test]
fn a_flag_is_cut_in_two_and_goes_on_waving() {
    let mut run = staged(16, Scene::flag);
    let mut after = None;
    while !run.is_over() {
        let before = run.elapsed_s();
        run.step().expect("a step");
        if let [cut] = run.cuts_made() {
            let report = &cut.report;
            assert_eq!(cut.number, 0);
            assert!((before - 1.5).abs() <= run.step_s() / 2.0);
            assert!(report.separated);
            assert_eq!(run.mesh().components().count(), 2);
            after = Some(run.cloth().positions().to_vec());
        }
    }
    let after = after.expect("a cut");
    let system = run.cloth().system();
    let moved = |v: &usize| (system.positions()[*v] - after[*v]).norm() > 0.05;
    let vertices = 0..after.len();
    assert!(vertices.filter(moved).count() > after.len() / 2);
    assert!(energy::kinetic_j(system) > 0.01);
    assert_eq!(run.mesh().components().count(), 2);
    check_ledgers(&run);
}

/// The slivers of a cut have few springs, which turn to pull side by side: a regression.
#[test]
fn a_flag_that_is_cut_goes_on_waving_by_an_explicit_method() {
    for solver in [Method::Verlet, Method::Provot(Limiter::default())] {
        let mut run = staged(32, |frame| Scene {
            solver: solver.clone(),
            duration_s: 1.57,
            ..Scene::flag(frame)
        });
        while !run.is_over() {
            run.step().expect("a step");
        }
        // The slivers are carried: no step is divided for them.
        let substeps = run.cloth().system().counters().substeps;
        assert_eq!(
            substeps == run.tally().steps,
            matches!(solver, Method::Verlet)
        );
        assert!(run.tally().stretch_ratio_max < 1.2);
        check_ledgers(&run);
    }
}

/// A step that is too long for the slivers of a cut fails, but the cut has been made.
#[test]
fn a_cut_is_told_of_though_its_step_fails() {
    let ray = |[x, y]: [f64; 2]| {
        let ray = Ray::new(Point::new(x, y, 5.0), Vector::new(0.0, 0.0, -1.0));
        ray.expect("a ray")
    };
    let mut run = staged(16, |frame| Scene {
        solver: Method::Provot(Limiter::default()),
        step_s: Some(0.0003),
        holds: vec![HeldVertices::still(Region::Patch {
            across: [0.0, 1.0],
            along: [1.0, 1.0],
        })],
        cuts: vec![TimedCut {
            at_s: 0.01,
            rays: [ray([0.524, -1.0]), ray([0.488, 2.0])],
            through: true,
            method: tearmesh::CutMethod::Exact,
        }],
        tearing: None,
        ..Scene::fall(frame.up)
    });
    let error = loop {
        match run.step() {
            Ok(_) => assert!(run.cuts_made().is_empty() && !run.is_over()),
            Err(error) => break error,
        }
    };
    assert!(matches!(error, StepError::Unstable { .. }), "{error}");
    let [cut] = run.cuts_made() else {
        panic!("{:?}", run.cuts_made());
    };
    assert!(cut.report.splits > 0);
    // What is held is what was held, and its copies.
    let system = run.cloth().system();
    let held: Vec<usize> = (0..system.positions().len())
        .filter(|&v| system.is_held(v))
        .collect();
    let mut led: Vec<usize> = run.held(0).iter().map(|v| v.index()).collect();
    led.sort_unstable();
    assert!(held.len() > 17);
    assert_eq!(led, held);
    // The next step does not say it again.
    assert!(run.step().is_err() && run.cuts_made().is_empty());
}

#[test]
fn the_legs_of_trousers_pull_against_each_other() {
    let mut run = staged(12, |frame| Scene {
        tearing: Some(Tearing::new(Threshold::Toughness(20.0))),
        ..Scene::trouser(frame)
    });
    let mut largest = [0.0_f64; 2];
    while !run.is_over() {
        run.step().expect("a step");
        let force = [0, 1].map(|leg| {
            let system = run.cloth().system();
            let vertices = run.held(leg).iter();
            vertices
                .map(|v| force::reaction_n(system, v.index()).z)
                .sum::<f64>()
        });
        largest = [largest[0].max(force[0]), largest[1].max(-force[1])];
    }
    assert!(run.tally().splits > 4, "{:?}", run.tally());
    assert!(largest[0] > 1.0 && largest[1] > 1.0, "{largest:?}");
    assert!(largest[0] < 1.5 * largest[1] && largest[1] < 1.5 * largest[0]);
    check_ledgers(&run);
}

#[test]
fn the_same_scene_gives_the_same_bits() {
    let bits = |run: &Run| -> Vec<[u64; 3]> {
        let points = run.cloth().positions().iter();
        points.map(|p| [p.x, p.y, p.z].map(f64::to_bits)).collect()
    };
    for (name, solver) in methods() {
        let short = |frame: &Frame| Scene {
            solver: solver.clone(),
            duration_s: 1.2,
            ..Scene::rip(frame)
        };
        let [one, other] = [play(staged(8, short)), play(staged(8, short))];
        assert_eq!(bits(&one), bits(&other), "{name}");
        assert_eq!(one.mesh().indices(), other.mesh().indices());
        assert_eq!(one.tally(), other.tally());
    }
}

#[test]
fn what_is_held_is_taken_led_and_let_go_in_time() {
    let hold = HeldVertices {
        region: Region::Vertices(vec![VertexId::new(40).expect("an id")]),
        from_s: 0.2,
        until_s: Some(0.6),
        moves: vec![(0.2, Vector::zeros()), (0.4, Vector::new(0.1, 0.2, 0.3))],
    };
    let mut run = staged(8, |frame| Scene {
        gravity_m_per_s2: Vector::zeros(),
        duration_s: 1.0,
        holds: vec![hold.clone()],
        tearing: None,
        ..Scene::fall(frame.up)
    });
    let begun = run.cloth().positions()[40];
    let (mut led, mut free) = (0, 0);
    while !run.is_over() {
        run.step().expect("a step");
        let (now, at) = (run.elapsed_s(), run.cloth().positions()[40]);
        let dt = run.step_s();
        if now < 0.2 - dt {
            assert_eq!(at, begun);
            assert!(run.held(0).is_empty());
        } else if now > 0.2 + 2.0 * dt && now < 0.6 - dt {
            let part = ((now - 0.2) / 0.2).min(1.0);
            let wanted = begun + Vector::new(0.1, 0.2, 0.3) * part;
            assert!((at - wanted).norm() < 1e-9, "{now}: {at} {wanted}");
            led += 1;
        } else if now > 0.6 + 2.0 * dt {
            assert!(run.held(0).is_empty());
            free += 1;
        }
    }
    assert!(led > 10 && free > 10);
    assert!((run.cloth().positions()[40] - begun).norm() > 0.01);
}

#[test]
fn copies_of_what_is_held_are_held_and_let_go_with_it() {
    let ray = |y: f64| {
        let ray = Ray::new(Point::new(0.5, y, 5.0), Vector::new(0.0, 0.0, -1.0));
        ray.expect("a ray")
    };
    let mut run = staged(8, |frame| Scene {
        duration_s: 0.5,
        holds: vec![HeldVertices {
            until_s: Some(0.3),
            ..HeldVertices::still(Region::Patch {
                across: [0.0, 1.0],
                along: [1.0, 1.0],
            })
        }],
        cuts: vec![TimedCut {
            at_s: 0.1,
            rays: [ray(-1.0), ray(2.0)],
            through: true,
            method: tearmesh::CutMethod::Partition,
        }],
        tearing: None,
        ..Scene::fall(frame.up)
    });
    let mut most = 0;
    while !run.is_over() {
        run.step().expect("a step");
        let system = run.cloth().system();
        let held = (0..system.positions().len()).filter(|&v| system.is_held(v));
        let count = held.count();
        assert_eq!(count, run.held(0).len());
        most = most.max(count);
    }
    assert_eq!((most, run.held(0).len()), (10, 0));
    assert_eq!(run.mesh().components().count(), 2);
}

/// Two holds on one edge: while both hold, the one that took last leads, and when it ends the other
/// holds on, in whatever order the scene has them.
#[test]
fn what_one_hold_lets_go_another_still_holds() {
    let edge = || Region::Patch {
        across: [0.0, 1.0],
        along: [1.0, 1.0],
    };
    let for_ever = HeldVertices::still(edge());
    let led_for_ever = HeldVertices {
        moves: vec![(0.0, Vector::zeros()), (0.5, Vector::new(0.0, 0.0, 0.5))],
        ..for_ever.clone()
    };
    let for_a_while = HeldVertices {
        from_s: 0.1,
        until_s: Some(0.3),
        ..for_ever.clone()
    };
    let led_for_a_while = HeldVertices {
        moves: vec![(0.1, Vector::zeros()), (0.2, Vector::new(0.25, 0.0, 0.0))],
        ..for_a_while.clone()
    };
    let moved = |holds: Vec<HeldVertices>| {
        let mut run = staged(6, |frame| Scene {
            duration_s: 0.6,
            holds: holds.clone(),
            tearing: None,
            ..Scene::fall(frame.up)
        });
        let corner = 6 * 7;
        let begun = run.cloth().positions()[corner];
        while !run.is_over() {
            run.step().expect("a step");
        }
        assert!(run.cloth().system().is_held(corner));
        run.cloth().positions()[corner] - begun
    };
    for (one, other, wanted) in [
        (&for_ever, &for_a_while, [0.0, 0.0, 0.0]),
        (&for_ever, &led_for_a_while, [0.25, 0.0, 0.0]),
        // It goes on from where it is, as the path does: 0.1 s to 0.3 s are not made up for.
        (&led_for_ever, &for_a_while, [0.0, 0.0, 0.3]),
        (&led_for_ever, &led_for_a_while, [0.25, 0.0, 0.3]),
    ] {
        for holds in [[one, other], [other, one]] {
            let moved = moved(holds.map(HeldVertices::clone).to_vec());
            let off = (moved - Vector::from(wanted)).norm();
            assert!(off < 0.02, "{moved:?}, {wanted:?}: {holds:?}");
        }
    }
    // What ends first is no grip of the other's.
    let soon_over = HeldVertices {
        until_s: Some(0.2),
        ..for_ever
    };
    let later = HeldVertices {
        until_s: None,
        ..led_for_a_while
    };
    let moved = moved(vec![soon_over, later]);
    assert!(
        (moved - Vector::new(0.25, 0.0, 0.0)).norm() < 1e-9,
        "{moved:?}"
    );
}

#[test]
fn regions_hold_what_lies_in_them() {
    let (mesh, positions) = square(4);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let within = |region: Region| -> Vec<usize> {
        let vertices = region.vertices(&mesh, positions.as_slice(), &frame);
        vertices.into_iter().map(VertexId::index).collect()
    };
    let near = |at, radius| within(Region::Near { at, radius });
    assert_eq!(near([0.0, 1.0], 0.0), [20]);
    assert_eq!(near([0.6, 0.4], 0.0), [12]);
    assert_eq!(near([1.0, 0.0], 0.25), [3, 4, 9]);
    let top = Region::Patch {
        across: [0.0, 1.0],
        along: [0.97, 1.0],
    };
    assert_eq!(within(top), [20, 21, 22, 23, 24]);
    let corner = Region::Box {
        from: Point::new(0.5, 0.75, -1.0),
        to: Point::new(0.75, 2.0, 1.0),
    };
    assert_eq!(within(corner), [17, 18, 22, 23]);
    let ball = Region::Ball {
        centre: Point::new(0.0, 0.0, 0.0),
        radius_m: 0.3,
    };
    assert_eq!(within(ball), [0, 1, 5]);
    let named = [7, 3, 99].map(|v| VertexId::new(v).expect("an id"));
    assert_eq!(within(Region::Vertices(named.to_vec())), [7, 3]);
}

#[test]
fn a_ball_under_a_falling_cloth_is_not_entered() {
    let (mesh, positions) = square(12);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Z);
    let centre = Point::new(0.5, 0.5, -0.5);
    let floor = Plane::new(Point::new(0.0, 0.0, -0.9), Vector::z()).expect("a plane");
    let scene = Scene {
        duration_s: 1.0,
        colliders: vec![
            Collider::Sphere {
                centre,
                radius_m: 0.3,
            },
            Collider::Plane(floor),
        ],
        tearing: None,
        ..Scene::fall(Axis::Z)
    };
    let run = Run::new(mesh, &positions, scene, &frame).expect("a scene");
    let run = play(run);
    let mut touching = 0;
    for p in run.cloth().positions() {
        let distance = (p - centre).norm();
        assert!(distance > 0.299 && p.z > -0.9001);
        touching += usize::from(distance < 0.301);
    }
    assert!(touching > 5);
}

/// Two edges that are led to one and a half times the distance leave no way to a limit of 1.1, and
/// every method says what that did to its steps.
#[test]
fn methods_say_where_their_steps_fall_short() {
    let led = |across: [f64; 2], x: f64| HeldVertices {
        moves: vec![(0.0, Vector::zeros()), (0.5, Vector::new(x, 0.0, 0.0))],
        ..HeldVertices::still(Region::Patch {
            across,
            along: [0.0, 1.0],
        })
    };
    for (name, solver) in methods() {
        let run = play(staged(8, |frame| Scene {
            solver: solver.clone(),
            duration_s: 1.0,
            holds: vec![led([0.0, 0.0], 0.0), led([1.0, 1.0], 0.5)],
            tearing: None,
            ..Scene::hang(frame)
        }));
        let system = run.cloth().system();
        let substeps = system.counters().substeps;
        match (name, run.quality()) {
            ("provot", Quality::Limiter(limited)) => {
                // From a tenth of a second on each row is 1.1 times as long or longer.
                let short = limited.steps_short;
                assert!(
                    short > substeps * 89 / 100 && short < substeps,
                    "{limited:?}"
                );
                assert!(limited.steps_infeasible > substeps / 2);
                assert!(limited.steps_infeasible <= limited.steps_short);
                assert!((0.39..2.0).contains(&limited.excess_max), "{limited:?}");
                assert!(limited.passes >= 20 * short && limited.passes <= 20 * substeps);
            }
            ("pbd", Quality::Strain(rms)) => {
                let squares = run.mesh().edges().map(|h| {
                    let at = |v: VertexId| run.cloth().positions()[v.index()];
                    let rest = |v: VertexId| run.cloth().rest_positions().at(v);
                    let [a, b] = [run.mesh().origin(h), run.mesh().target(h)];
                    ((at(b) - at(a)).norm() / (rest(b) - rest(a)).norm() - 1.0).powi(2)
                });
                let mean = squares.clone().sum::<f64>() / squares.count() as f64;
                assert!((rms - mean.sqrt()).abs() < 1e-12 && rms > 0.2, "{rms}");
            }
            ("xpbd", Quality::Residual(newtons)) => {
                assert!(newtons > 1.0, "one sweep does not converge: {newtons}");
            }
            ("implicit", Quality::Implicit(solved)) => {
                assert!(solved.residual_max_m_per_s > 0.0 && solved.residual_max_m_per_s < 1e-3);
            }
            ("verlet", Quality::Carried { carried }) => {
                let free = system.inverse_masses().iter().filter(|w| **w > 0.0).count();
                assert!(10 * carried <= free, "{carried} of {free}");
            }
            (name, other) => panic!("{name}: {other:?}"),
        }
    }
}

#[test]
fn scenes_that_make_no_sense_are_refused() {
    let refused = |change: &dyn Fn(&mut Scene)| {
        let (mesh, positions) = square(4);
        let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
        let mut scene = Scene::hang(&frame);
        change(&mut scene);
        Run::new(mesh, &positions, scene, &frame).expect_err("no scene")
    };
    for step_s in [0.0, 1e-30] {
        let duration_s = 2.0;
        let refused = refused(&|scene| scene.step_s = Some(step_s));
        assert_eq!(refused, RunError::Times { step_s, duration_s });
    }
    let timeless = refused(&|scene| scene.duration_s = f64::NAN).to_string();
    assert!(
        timeless.starts_with("NaN s cannot be taken in steps of 0.00"),
        "{timeless}"
    );
    let drag = refused(&|scene| scene.drag_per_s = -1.0);
    assert_eq!(
        drag.to_string(),
        "drag_per_s is -1, which is not finite, or negative"
    );
    let nowhere = refused(&|scene| scene.holds[1].region = Region::Vertices(Vec::new()));
    assert_eq!(
        nowhere,
        RunError::NoVertices {
            named_by: "hold",
            number: 1
        }
    );
    let region = || Region::Vertices([3, 25].map(|v| VertexId::new(v).expect("an id")).to_vec());
    for (names, refused) in [
        ("hold", refused(&|scene| scene.holds[0].region = region())),
        (
            "strength",
            refused(&|scene| scene.strengths = vec![(region(), 2.0)]),
        ),
    ] {
        let named = RunError::NoVertex {
            named_by: names,
            number: 0,
            vertex: VertexId::new(25).expect("an id"),
            vertices: 25,
        };
        assert_eq!(refused, named);
    }
    let nowhere = Region::Vertices(Vec::new());
    let weak = refused(&|scene| scene.strengths = vec![(nowhere.clone(), 0.5)]);
    assert_eq!(
        weak,
        RunError::NoVertices {
            named_by: "strength",
            number: 0
        }
    );
    let moves = refused(&|scene| scene.holds[0].moves = vec![(1.0, Vector::zeros()); 2]);
    assert_eq!(moves, RunError::Moves { number: 0 });
    let early = refused(&|scene| scene.holds[0].until_s = Some(0.0));
    assert_eq!(early, RunError::Moves { number: 0 });
    let threshold = refused(&|scene| {
        scene.tearing = Some(Tearing::new(Threshold::Stretch(0.5)));
    });
    assert!(matches!(
        threshold,
        RunError::Simulation(SimulationError::Tearing(_))
    ));
    let massless = refused(&|scene| scene.areal_density_kg_per_m2 = 0.0);
    assert!(matches!(
        massless,
        RunError::Simulation(SimulationError::Cloth(_))
    ));
}

#[test]
fn a_step_of_ones_own_is_refused_where_it_is_unstable() {
    let mut run = staged(8, |frame| Scene {
        solver: Method::Verlet,
        step_s: Some(1.0 / 60.0),
        ..Scene::hang(frame)
    });
    let before = run.cloth().positions().to_vec();
    let refused = run.step().expect_err("too long a step");
    assert!(matches!(refused, StepError::Unstable { .. }));
    assert_eq!(run.cloth().positions(), before);
    assert_eq!(run.tally().steps, 0);
}

/// Wind that is not usable at some time is refused before the first step, and not met in it.
#[test]
fn a_wind_that_is_unusable_later_is_refused_at_once() {
    let (mesh, positions) = shapes::grid(2, 2);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let run = |steady: f64, sway: f64, period_s: f64| {
        let wind = SwayingWind {
            steady: Wind {
                velocity_m_per_s: Vector::new(0.0, 0.0, steady),
                coefficient: 1.0,
            },
            sway_m_per_s: Vector::new(0.0, 0.0, sway),
            period_s,
        };
        let scene = Scene {
            wind: Some(wind),
            ..Scene::hang(&frame)
        };
        let mut run = Run::new(mesh.clone(), &positions, scene, &frame)?;
        for _ in 0..3 {
            let _ = run.step();
        }
        Ok::<(), RunError>(())
    };
    let huge = 1.5e308;
    let cases = [
        (huge, huge, 1.0, "wind.sway_m_per_s", huge),
        (-huge, huge, 1.0, "wind.sway_m_per_s", huge),
        (1.0, f64::NAN, 1.0, "wind.sway_m_per_s", f64::NAN),
        (1.0, 1.0, 1e-320, "wind.period_s", 1e-320),
        (1.0, 1.0, 0.0, "wind.period_s", 0.0),
        (1.0, 1.0, -1.0, "wind.period_s", -1.0),
        (1.0, 0.0, -1.0, "wind.period_s", -1.0),
        (1.0, 1.0, f64::INFINITY, "wind.period_s", f64::INFINITY),
        (1.0, 1.0, f64::NAN, "wind.period_s", f64::NAN),
    ];
    for (steady, sway, period_s, field, given) in cases {
        let error = run(steady, sway, period_s).expect_err("it is refused");
        let text = error.to_string();
        assert!(
            text.contains(&format!("{field} is {given}")),
            "{steady} {sway} {period_s}: {text}"
        );
    }
    run(1.0, 1.0, 1e-9).expect("any period that is a number of seconds");
}

/// A time that is none would be now.
#[test]
fn a_cut_at_a_time_that_is_none_is_refused() {
    let (mesh, positions) = shapes::grid(2, 2);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    for at_s in [f64::NAN, -1.0, f64::INFINITY] {
        let mut scene = Scene::flag(&frame);
        assert!(!scene.cuts.is_empty());
        scene.cuts[0].at_s = at_s;
        let error = Run::new(mesh.clone(), &positions, scene, &frame).expect_err("no time");
        assert_eq!(
            error.to_string(),
            format!("cut 1 is at {at_s} s, which is not finite, or negative")
        );
    }
}

/// What is between two points of a path is a number, as the points are.
#[test]
fn a_path_that_overflows_between_its_points_is_refused() {
    let x = |x: f64| Point::new(x, 0.0, 0.0);
    let huge = 1e308;
    let wide = Path::new([(-1.0, x(-huge)), (1.0, x(huge))]);
    assert_eq!(wide.map(|path| path.at(0.0)), None);
    let long = Path::new([(-huge, x(0.0)), (huge, x(1.0))]);
    assert_eq!(long.map(|path| path.at(0.0)), None);
    let most = tearmesh::COORDINATE_MAX;
    let widest = Path::new([(-huge / 2.0, x(-most)), (huge / 2.0, x(most))]);
    let middle = widest.expect("coordinates that can be used").at(0.0);
    assert_eq!(middle, x(0.0));
    assert_eq!(Path::new([(0.0, x(most * 1.01))]), None);
}

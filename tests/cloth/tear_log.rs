//! When and where a cloth tears first, and what a log tells of a run, against what the run itself says and the
//! balance of energy.

use std::num::NonZero;

use tearmesh::Vector;
use tearmesh_cloth::implicit::Settings;
use tearmesh_cloth::scene::{HeldVertices, Region, Run, Scene, TearLog};
use tearmesh_cloth::{Method, Tearing, Threshold, Xpbd};

use crate::parts::scenes::{Played, methods, noted, play, played, staged, torn_first};
use crate::parts::{near, order};

/// How far a hold has been led by then: straight between the points of its way.
fn led(hold: &HeldVertices, time_s: f64) -> Vector {
    let mut from = (hold.from_s, Vector::zeros());
    for &(at_s, by) in &hold.moves {
        if time_s < at_s {
            let part = ((time_s - from.0) / (at_s - from.0)).clamp(0.0, 1.0);
            return from.1 + (by - from.1) * part;
        }
        from = (at_s, by);
    }
    from.1
}

/// Force times way, frame by frame, is what the balance of energy says that hands have worked: it takes
/// forces and ways substep by substep, and knows nothing of frames.
#[test]
fn force_times_way_is_the_work_of_hands() {
    // Provot's limiter works on what is held as well.
    for name in Method::NAMES.into_iter().filter(|name| *name != "provot") {
        let Played { run, log, .. } = played(16, "trouser", name);
        let (mut worked_j, mut since_s) = (0.0, 0.0);
        for frame in log.hold_forces() {
            for (hold, force) in run.scene().holds.iter().zip(&frame.forces_n) {
                worked_j += force.dot(&(led(hold, frame.end_s) - led(hold, since_s)));
            }
            since_s = frame.end_s;
        }
        let part = worked_j / run.energy_balance().held_j;
        assert!((part - 1.0).abs() < 0.02, "{name}: {part}");
        assert!(run.tally().splits > 0, "{name}");
    }
}

/// What one hold of all that is held exerts is the change of the momentum of the rest, less gravity and drag:
/// no spring is looked at.
#[test]
fn peak_and_mean_forces_are_what_changes_the_momentum() {
    let all_held = |frame: &_| Scene {
        holds: vec![HeldVertices {
            moves: vec![(0.2, Vector::zeros()), (0.5, Vector::new(0.0, 0.3, 0.1))],
            ..HeldVertices::still(Region::Near {
                at: [0.5, 1.0],
                radius: 0.3,
            })
        }],
        duration_s: 0.6,
        ..Scene::hang(frame)
    };
    for (name, solver) in methods().into_iter().filter(|(name, _)| *name != "provot") {
        let mut run = staged(8, |frame| Scene {
            solver: solver.clone(),
            ..all_held(frame)
        });
        let mut log = TearLog::new(&run);
        let (gravity, drag) = (run.scene().gravity_m_per_s2, run.scene().drag_per_s);
        let momentum = |run: &Run| -> (Vector, Vector) {
            let system = run.cloth().system();
            let free = (0..system.masses().len()).filter(|&i| !system.is_held(i));
            let of_free = free.map(|i| system.velocities()[i] * system.masses()[i]);
            let weight = system.masses().iter().map(|&m| gravity * m).sum();
            (of_free.sum(), weight)
        };
        let (mut peak_n, mut largest_n) = (0.0_f64, 0.0_f64);
        let (mut sum, mut since_s) = (Vector::zeros(), 0.0);
        while !run.is_over() {
            let (before, weight) = momentum(&run);
            let (start_s, frames) = (run.elapsed_s(), log.hold_forces().len());
            let step = run.step().expect("a step");
            log.note(&run, &step);
            let (after, _) = momentum(&run);
            let dt_s = run.elapsed_s() - start_s;
            let force = (after - before) / dt_s + (before + after) * (0.5 * drag) - weight;
            peak_n = peak_n.max(force.norm());
            sum += force * dt_s;
            if log.hold_forces().len() > frames {
                let end_s = run.elapsed_s();
                largest_n = largest_n.max((sum / (end_s - since_s)).norm());
                (sum, since_s) = (Vector::zeros(), end_s);
            }
        }
        let known = [log.peak_force_n(), log.largest_force_n()].map(|force| force.expect(name));
        for (known, own) in known.into_iter().zip([peak_n, largest_n]) {
            assert!((known / own - 1.0).abs() < 0.01, "{name}: {known} {own}");
        }
        assert!(peak_n > 1.05 * largest_n, "{name}: {peak_n} {largest_n}");
    }
}

#[test]
fn events_are_the_steps_in_which_something_tore() {
    for name in Method::NAMES {
        let Played { run, log, torn, .. } = played(16, "rip", name);
        assert_eq!(log.events().len(), torn.len(), "{name}");
        let (mut splits_before, mut before_m) = (0, 0.0);
        for (event, &(time_s, splits, torn_m)) in log.events().iter().zip(torn) {
            assert!(event.time_s <= time_s, "{name}");
            assert!(event.time_s >= time_s - run.step_s(), "{name}");
            assert_eq!(event.splits as u64, splits - splits_before, "{name}");
            near(event.torn_m, torn_m - before_m, 1e-12);
            assert!(event.load >= 1.0);
            (splits_before, before_m) = (splits, torn_m);
        }
        let first = log.events()[0];
        // The grip is dragged down, so what tears first is not far above it.
        let (now, rest) = (first.place, first.place_at_rest);
        assert!(now.y < rest.y + 0.01, "{name}: {now} {rest}");
        let (first_n, largest_n) = (log.first_force_n(), log.largest_force_n());
        let knows_forces = name != "provot";
        assert_eq!([first_n.is_some(), largest_n.is_some()], [knows_forces; 2]);
        assert!(first_n <= largest_n && first_n.is_none_or(|newtons| newtons > 0.0));
    }
}

/// Drawn out slowly and evenly, cloth tears when and at the force that a sixtieth of the step says, and not when the step
/// ends in which it does.
#[test]
fn the_first_tear_is_timed_between_steps() {
    let first = |method: &str, divisor: u32| {
        let run = staged(4, |frame| Scene {
            solver: Method::named(method).expect("a method"),
            gravity_m_per_s2: Vector::zeros(),
            drag_per_s: 5.0,
            duration_s: 1.0,
            tearing: Some(Tearing::new(Threshold::Stretch(1.3))),
            holds: [(0.0, -1.0), (1.0, 1.0)]
                .map(|(y, way)| HeldVertices {
                    moves: vec![(0.0, Vector::zeros()), (1.0, Vector::y() * (0.2 * way))],
                    ..HeldVertices::still(Region::Patch {
                        across: [0.0, 1.0],
                        along: [y, y],
                    })
                })
                .to_vec(),
            ..Scene::hang(frame)
        });
        let run = run.in_smaller_steps(NonZero::new(divisor).expect("a divisor"));
        let step_s = run.step_s();
        let log = noted(run).log;
        (
            log.events()[0].time_s,
            log.first_force_n().expect("a tear"),
            step_s,
        )
    };
    for method in ["verlet", "implicit"] {
        let (right_s, right_n, _) = first(method, 60);
        for divisor in 1..=5 {
            let (time_s, force_n, step_s) = first(method, divisor);
            near((time_s - right_s) / step_s, 0.0, 0.01);
            near(force_n / right_n, 1.0, 0.004);
        }
    }
}

/// What it takes to tear a coarse and a fine mesh.
#[test]
fn a_strain_tears_a_finer_mesh_more_easily_toughness_not() {
    let slope = |threshold| {
        let forces = [8, 16].map(|cells| {
            let played = noted(staged(cells, |frame| Scene {
                tearing: Some(Tearing::new(threshold)),
                ..Scene::trouser(frame)
            }));
            played.log.largest_force_n().expect("springs have forces")
        });
        order(forces)
    };
    let slopes = [Threshold::Stretch(1.3), Threshold::Toughness(4.0)].map(slope);
    assert!(slopes[0] > 0.5 && slopes[1].abs() < 0.3, "{slopes:?}");
}

#[test]
fn smaller_steps_are_those_of_a_scene_that_names_them() {
    let scene = |step_s| {
        move |frame: &_| Scene {
            step_s,
            duration_s: 0.5,
            ..Scene::hang(frame)
        }
    };
    let whole = staged(6, scene(None));
    let third = whole.step_s() / 3.0;
    let named = play(staged(6, scene(Some(third))));
    let divided = play(whole.in_smaller_steps(NonZero::new(3).expect("not zero")));
    assert_eq!(divided.cloth().positions(), named.cloth().positions());
    assert_eq!(divided.tally().steps, named.tally().steps);
}

/// What is moved aside before it begins is elsewhere at once, at rest as before, and no energy comes from
/// nowhere.
#[test]
fn what_is_displaced_has_its_rest_as_before() {
    let still = |frame: &_| Scene {
        gravity_m_per_s2: Vector::zeros(),
        drag_per_s: 0.0,
        duration_s: 0.5,
        ..Scene::hang(frame)
    };
    let whole = staged(6, still);
    let before = whole.cloth().positions().to_vec();
    let by = |i: usize| Vector::new(0.01 * (i % 3) as f64, 0.0, 0.02);
    let moved = whole.displaced(|v| by(v.index())).expect("usable places");
    let now = moved.cloth().positions();
    assert!((0..now.len()).all(|i| now[i] == before[i] + by(i)));
    assert_eq!(moved.cloth().rest_positions(), before);
    let began_j = moved.energy_balance().began_j;
    assert!(began_j > 0.0);
    let balance = play(moved).energy_balance();
    assert!(balance.made_j() < 1e-3 * began_j, "{balance:?}");
}

/// `rip` on a sheet of 10 × 10 cells, with the number of the step, and the edge with the largest load. All
/// that would move them is a change of the fabric, of a step's length, or of what decides.
const EXPECTED: &str = include_str!("first_tears.txt");

const TWO: NonZero<u32> = NonZero::<u32>::MIN.saturating_add(1);

/// Methods that do not depend on the step tear at the same time at half of it.
#[test]
fn first_tears_of_all_methods_by_all_thresholds() {
    let mut found = String::new();
    let [explicit @ .., _] = methods();
    let others = [
        ("implicit", Method::Implicit(Settings::default())),
        ("xpbd by tens", Method::Xpbd(Xpbd::default())),
    ];
    for (name, solver) in explicit.into_iter().chain(others) {
        for (kind, threshold) in [
            ("stretch", Threshold::Stretch(1.5)),
            ("toughness", Threshold::Toughness(12.5)),
            ("force", Threshold::Force(50.0)),
        ] {
            let rip = || {
                staged(10, |frame| Scene {
                    solver: solver.clone(),
                    tearing: Some(Tearing::new(threshold)),
                    ..Scene::rip(frame)
                })
            };
            let (run, edge) = torn_first(rip());
            if ["verlet", "implicit"].contains(&name) {
                let (halved, _) = torn_first(rip().in_smaller_steps(TWO));
                near(halved.elapsed_s() / run.elapsed_s(), 1.0, 0.02);
            }
            let [a, b] = [run.mesh().origin(edge), run.mesh().target(edge)];
            let (step, per_s) = (run.tally().steps, 1.0 / run.step_s());
            found += &format!("{name} {kind}: step {step} of 1/{per_s:.0} s, {a}-{b}\n");
        }
    }
    assert_eq!(found, EXPECTED);
}

//! Ensembles of small scenes: disturbances are tiny, and members are plain runs.

use std::cell::Cell;
use std::num::NonZero;

use tearmesh::shapes;
use tearmesh_cloth::scene::Axis;

use super::*;

const ONE: NonZero<u32> = NonZero::<u32>::MIN;
const TWO: NonZero<u32> = ONE.saturating_add(1);

/// A square of one metre with `cells` cells per side and alternating diagonals.
fn square(cells: u32) -> (Mesh, Positions) {
    shapes::grid_with_diagonals(cells, cells, |i, j| (i + j) % 2 == 0)
}

/// Does something with a scene on a [`square`].
fn staged(cells: u32, scene: impl Fn(&Frame) -> Scene, act: impl FnOnce(Subject<'_>)) {
    let (mesh, positions) = &square(cells);
    let frame = &Frame::new(mesh, positions.as_slice(), Axis::Y);
    let scene = &scene(frame);
    act(Subject {
        mesh,
        positions,
        frame,
        scene,
    });
}

/// A face that begins with its smallest corner.
fn from_smallest(face: &[u32; 3]) -> [u32; 3] {
    let [a, b, c] = *face;
    let rotations = [[a, b, c], [b, c, a], [c, a, b]];
    rotations.into_iter().min().expect("three rotations")
}

#[test]
fn a_disturbance_shuffles_faces_and_moves_by_the_noise() {
    let (mesh, _) = square(8);
    let disturbance = Disturbance::new(&mesh, 5);
    let faces = |mesh: &Mesh| mesh.indices().as_chunks::<3>().0.to_vec();
    let (before, after) = (faces(&mesh), faces(&disturbance.mesh));
    let sorted = |faces: &[[u32; 3]]| {
        let mut faces: Vec<_> = faces.iter().map(from_smallest).collect();
        faces.sort_unstable();
        faces
    };
    assert_eq!(sorted(&before), sorted(&after));
    let moved = before.iter().zip(&after);
    let moved = moved.filter(|(a, b)| from_smallest(a) != from_smallest(b));
    let turned = after.iter().filter(|face| !before.contains(*face));
    assert!(2 * moved.count().min(turned.count()) > before.len());
    assert_eq!(disturbance.offsets_m.len(), mesh.vertex_count());
    let parts: Vec<f64> = disturbance.offsets_m.iter().flatten().copied().collect();
    let largest = parts.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    assert!((0.9 * NOISE_M..=NOISE_M).contains(&largest), "{largest}");
    let mean = parts.iter().sum::<f64>() / parts.len() as f64;
    assert!(mean.abs() < 0.2 * NOISE_M, "{mean}");
    let other = Disturbance::new(&mesh, 6);
    assert!(other.offsets_m != disturbance.offsets_m && other.mesh != disturbance.mesh);
}

/// The oracle of a member is a run that is disturbed and played here.
#[test]
fn a_member_is_a_run_that_was_disturbed() {
    staged(8, Scene::rip, |subject| {
        let observed = observe(subject, TWO, 5, &|| false).expect("a run that is done");
        let observed = observed.expect("steps that are stable");
        let Disturbance { mesh, offsets_m } = Disturbance::new(subject.mesh, 5);
        let run = Run::new(
            mesh,
            subject.positions,
            subject.scene.clone(),
            subject.frame,
        );
        let run = run.expect("a scene").in_smaller_steps(TWO);
        let mut run = run.displaced(|v| offsets_m[v.index()]).expect("a metre");
        let mut log = TearLog::new(&run);
        while !run.is_over() {
            let step = run.step().expect("a step");
            log.note(&run, &step);
        }
        let first_tear = log.events().first().expect("a rip");
        assert_eq!(observed.first_tear_s, Some(first_tear.time_s));
        assert_eq!(observed.first_force_n, log.first_force_n());
        assert_eq!(observed.torn_m, run.torn_length_m());
        assert_eq!(observed.pieces, run.mesh().components().count());
        assert_eq!(observed.largest_force_n, log.largest_force_n());
        assert_eq!(observed.work_j, Some(run.energy_balance().held_j));
        assert!(observed.torn_m > 0.0);
    });
}

#[test]
fn a_run_ends_before_the_step_at_which_it_is_stopped() {
    let short = |frame: &_| Scene {
        duration_s: 0.05,
        ..Scene::hang(frame)
    };
    staged(4, short, |subject| {
        let checks = Cell::new(0_u32);
        let stopped_at = |allowed: u32| {
            checks.set(0);
            let stop = || checks.replace(checks.get() + 1) >= allowed;
            observe(subject, ONE, 1, &stop).is_none()
        };
        assert!(!stopped_at(u32::MAX));
        let checks_of_a_run = checks.get();
        assert!(checks_of_a_run > 10, "{checks_of_a_run}");
        assert!(stopped_at(0) && stopped_at(checks_of_a_run - 1) && !stopped_at(checks_of_a_run));
    });
}

#[test]
fn failed_runs_and_refused_scenes_say_why() {
    // Such a step is far beyond what is stable, and is not divided since the scene names it.
    for (step_s, duration_s, why) in [
        (Some(0.1), 1.0, "exceeds the stability limit"),
        (None, -1.0, "-1 s cannot be"),
    ] {
        let scene = |frame: &_| Scene {
            step_s,
            duration_s,
            ..Scene::hang(frame)
        };
        staged(4, scene, |subject| {
            let failed = observe(subject, ONE, 1, &|| false).expect("nothing stops it");
            let reason = failed.expect_err("a failure");
            assert!(reason.contains(why), "{reason}");
        });
    }
}

/// Runs that failed leave a sample that is not a random choice.
#[test]
fn samples_with_failures_allow_no_verdict() {
    let verdict = |first: &Sample, second: &Sample| {
        compared(first, second).map(|comparison| comparison.verdict)
    };
    let whole = (vec![1.0; 8], true);
    assert_eq!(verdict(&whole, &whole), Some(Verdict::Same));
    let (partial, empty) = ((vec![2.0; 4], false), (Vec::new(), false));
    assert_eq!(verdict(&whole, &partial), Some(Verdict::CannotTell));
    assert_eq!(verdict(&empty, &whole), None);
}

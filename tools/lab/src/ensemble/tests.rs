//! Verdicts on samples whose medians are known, and ensembles of a scene that is not chaotic, of one
//! that is, and of one that fails.

use std::num::NonZero;

use tearmesh::shapes;
use tearmesh_cloth::scene::Axis;

use super::*;

const ONE: NonZero<u32> = NonZero::<u32>::MIN;
const TWO: NonZero<u32> = ONE.saturating_add(1);

/// A sample of numbers about a middle, from a part below to a part above.
fn about(middle: f64, part: f64, count: usize, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    let mut number = || middle * (1.0 + part * (2.0 * random.next() - 1.0));
    (0..count).map(|_| number()).collect()
}

#[test]
fn verdicts_are_right_far_more_often_than_not() {
    let mut counts = [[0; 3]; 3];
    let cases = [(1.0, 0.1), (2.0, 0.1), (1.15, 0.9)];
    for (case, (ratio, part)) in cases.into_iter().enumerate() {
        for seed in 0..200 {
            let first = about(3.0, part, 8, 2 * seed);
            let second = about(3.0 * ratio, part, 8, 2 * seed + 1);
            let found = compare(&first, &second);
            assert!(found.interval[0] <= found.interval[1]);
            counts[case][found.verdict as usize] += 1;
        }
    }
    let [same, other, vague] = counts;
    assert!(
        same[Verdict::Same as usize] > 190 && same[Verdict::Differ as usize] == 0,
        "{same:?}"
    );
    assert!(other[Verdict::Differ as usize] > 195, "{other:?}");
    // A spread of nine tenths hides a ratio of 1.15 in eight runs.
    assert!(vague[Verdict::CannotTell as usize] > 150, "{vague:?}");
}

#[test]
fn what_never_happens_in_both_is_the_same() {
    for never in [0.0, f64::INFINITY] {
        let found = compare(&[never; 4], &[never; 4]);
        assert_eq!((found.ratio, found.verdict), (1.0, Verdict::Same));
        let found = compare(&[never; 4], &[2.0; 4]);
        assert_eq!(found.verdict, Verdict::Differ, "{found:?}");
    }
    assert_eq!(spread(&[f64::INFINITY; 3])[1], f64::INFINITY);
    assert_eq!(spread(&[1.0, 2.0, 3.0]), [1.2, 2.0, 2.8]);
    assert_eq!(spread(&[7.0]), [7.0; 3]);
}

fn ensembles(scene: impl Fn(&Frame) -> Scene, seeds: u64) -> Vec<Ensemble> {
    let (mesh, positions) = shapes::grid(8, 8);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let subject = Subject {
        mesh: &mesh,
        positions: &positions,
        frame: &frame,
        scene: &scene(&frame),
        strengths: None,
    };
    let threads = NonZero::new(2).expect("not zero");
    play(subject, 1..=seeds, &[ONE, TWO], threads, &|| false, |_| {}).expect("a scene")
}

fn verdict(of: &[Ensemble], quantity: Quantity) -> Comparison {
    let [first, second] = [&of[0], &of[1]].map(|ensemble| ensemble.numbers(quantity).0);
    compare(&first, &second)
}

#[test]
fn what_does_not_tear_is_the_same_at_half_the_step() {
    let of = ensembles(
        |frame| Scene {
            duration_s: 1.0,
            ..Scene::hang(frame)
        },
        3,
    );
    assert_eq!(of[1].step_s, of[0].step_s / 2.0);
    for quantity in Quantity::ALL {
        assert_eq!(
            verdict(&of, quantity).verdict,
            Verdict::Same,
            "{}",
            quantity.key()
        );
    }
    let seen = of[0].members[0].observed.expect("done");
    assert_eq!(
        (seen.first_tear_s, seen.pieces, seen.torn_m),
        (None, 1, 0.0)
    );
}

/// What a nanometre and an order of storage make of a rip: members differ, though the first tear,
/// before which there is no chaos, does not.
#[test]
fn a_rip_is_chaotic_after_its_first_tear() {
    let of = ensembles(Scene::rip, 6);
    for ensemble in &of {
        assert!(
            ensemble
                .members
                .iter()
                .all(|member| member.status == MemberStatus::Done)
        );
        let first = ensemble.numbers(Quantity::FirstTear).0;
        let [least, _, most] = spread(&first);
        assert!(most - least < 0.01 * least, "{first:?}");
        let mut torn = ensemble.numbers(Quantity::Torn).0;
        torn.dedup();
        assert!(torn.len() > 1, "{torn:?}");
    }
    assert_eq!(verdict(&of, Quantity::FirstTear).verdict, Verdict::Same);
    // The same ensembles again, whoever plays them.
    let again = ensembles(Scene::rip, 6);
    for (one, other) in of.iter().zip(&again) {
        for (one, other) in one.members.iter().zip(&other.members) {
            assert_eq!(one.observed, other.observed);
        }
    }
}

#[test]
fn a_run_that_fails_or_is_stopped_is_a_member_all_the_same() {
    // Far beyond what is stable, and taken since it was asked for.
    let refused = ensembles(
        |frame| Scene {
            step_s: Some(0.1),
            ..Scene::hang(frame)
        },
        2,
    );
    for member in refused.iter().flat_map(|ensemble| &ensemble.members) {
        assert_eq!(member.status, MemberStatus::Failed);
        assert!(member.why.contains("stab"), "{}", member.why);
    }
    assert_eq!(refused[0].numbers(Quantity::Torn), (Vec::new(), false));
    let (mesh, positions) = shapes::grid(4, 4);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let subject = Subject {
        mesh: &mesh,
        positions: &positions,
        frame: &frame,
        scene: &Scene::rip(&frame),
        strengths: None,
    };
    let threads = NonZero::<usize>::MIN;
    let stopped = play(subject, 1..=2, &[ONE], threads, &|| true, |_| {}).expect("a scene");
    assert!(
        stopped[0]
            .members
            .iter()
            .all(|member| member.status == MemberStatus::Interrupted)
    );
}

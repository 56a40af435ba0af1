//! References are found where methods agree, and only there; more seeds are played where nobody can tell.

use plotters::prelude::*;

use super::*;
use crate::ensemble::{Member, MemberStatus, Observed};

/// An ensemble whose torn lengths are about a middle, and of which nobody says the forces.
fn torn(parts: u32, middle_m: f64) -> Ensemble {
    let member = |seed: u64| Member {
        seed,
        status: MemberStatus::Done,
        why: String::new(),
        observed: Some(Observed {
            first_tear_s: Some(1.0),
            first_force_n: None,
            torn_m: middle_m * (0.99 + 0.002 * (seed % 11) as f64),
            pieces: 2,
            largest_force_n: None,
            work_j: None,
        }),
    };
    Ensemble {
        parts,
        step_s: 1e-3 / f64::from(parts),
        members: (1..=16).map(member).collect(),
    }
}

fn cascade(method: &'static str, middles_m: [f64; 3]) -> Cascade {
    let ensembles: Vec<Ensemble> = PARTS
        .iter()
        .zip(middles_m)
        .map(|(parts, middle_m)| torn(parts.get(), middle_m))
        .collect();
    Cascade {
        scene: "rip".to_owned(),
        cells: 4,
        method: method.to_owned(),
        numbers: Vec::new(),
        ensembles,
    }
}

#[test]
fn two_methods_that_agree_at_their_finest_are_the_reference() {
    let mut cascades = vec![
        cascade("verlet", [2.0, 2.0, 2.0]),
        cascade("pbd", [4.0, 8.0, 16.0]),
        cascade("implicit", [3.0, 2.2, 2.1]),
    ];
    conclude(&mut cascades);
    let verdicts = |i: usize| {
        let number = &cascades[i].numbers[0];
        assert_eq!(number.reference, ["verlet", "implicit"]);
        let against = number.against_reference.map(|found| found.verdict);
        [number.verdict(), against].map(|verdict| verdict.expect("it is known"))
    };
    assert_eq!(verdicts(0), [Verdict::Same, Verdict::Same]);
    assert_eq!(verdicts(1), [Verdict::Differ, Verdict::Differ]);
    assert_eq!(verdicts(2), [Verdict::Differ, Verdict::Differ]);
    // Of forces nobody says anything.
    let force = &cascades[0].numbers[3];
    assert!(force.reference.is_empty() && force.against_reference.is_none());
    assert_eq!(force.verdict(), None);
    // Medians from 2 to 16 are not far apart, and with one of 60 they are.
    let caption = |cascades: &[Cascade]| {
        let mut text = String::new();
        let high = height(cascades);
        {
            let root = SVGBackend::with_string(&mut text, (1100, high)).into_drawing_area();
            draw(&root, cascades, 0).expect("it is drawn");
        }
        text.contains("rip · torn length, m, logarithmic")
    };
    assert!(!caption(&cascades));
    let mut far = cascades.clone();
    far.push(cascade("provot", [60.0; 3]));
    conclude(&mut far);
    assert!(caption(&far));
    let said = summary(&cascades);
    assert!(said.contains("rip, torn length in m; reference: the finest of verlet and implicit"));
    assert!(
        said.contains("largest force in N; no two methods that converged agree"),
        "{said}"
    );
}

#[test]
fn two_that_agree_but_still_change_with_their_step_are_no_reference() {
    let mut cascades = vec![
        cascade("xpbd", [4.0, 3.0, 2.0]),
        cascade("pbd", [0.5, 1.0, 2.0]),
    ];
    conclude(&mut cascades);
    for cascade in &cascades {
        assert_eq!(cascade.numbers[0].reference, [""; 0]);
    }
    cascades.push(cascade("verlet", [2.0; 3]));
    cascades.push(cascade("implicit", [2.1; 3]));
    conclude(&mut cascades);
    assert_eq!(cascades[0].numbers[0].reference, ["verlet", "implicit"]);
}

#[test]
fn where_no_two_agree_there_is_no_reference() {
    let mut cascades = vec![cascade("verlet", [1.0; 3]), cascade("xpbd", [2.0; 3])];
    conclude(&mut cascades);
    for cascade in &cascades {
        assert!(cascade.numbers[0].reference.is_empty());
        assert!(cascade.numbers[0].against_reference.is_none());
        // Both have two pieces.
        assert_eq!(cascade.numbers[1].reference, ["verlet", "xpbd"]);
    }
    // A run that failed leaves nobody able to tell.
    let mut failed = cascade("verlet", [1.0; 3]);
    failed.ensembles[0].members[0].observed = None;
    let number = number(&failed.ensembles, Quantity::Torn);
    assert_eq!(number.verdict(), Some(Verdict::CannotTell));
}

fn options(seeds: u64) -> Options {
    Options {
        scenes: vec![CascadeScene::Rip],
        cells: Some(6),
        methods: vec!["implicit".to_owned(), "provot".to_owned()],
        seeds,
        threads: NonZero::<usize>::MIN.saturating_add(1),
    }
}

#[test]
fn more_seeds_are_played_where_nobody_can_tell() {
    let mut parts = Vec::new();
    let cascades = play(&options(2), &|| false, |_, part| parts.push(part));
    let cascades = cascades.expect("no bug").expect("nobody stops it");
    assert!(parts.iter().all(|part| (0.0..=1.0).contains(part)));
    for cascade in &cascades {
        let seeds = cascade.ensembles[0]
            .members
            .iter()
            .map(|member| member.seed);
        let seeds: Vec<u64> = seeds.collect();
        let played = seeds.len() as u64;
        assert!(played == 2 || played == 2 * MORE, "{played}");
        assert_eq!(seeds, (1..=played).collect::<Vec<_>>());
        let verdicts: Vec<_> = cascade.numbers.iter().map(Number::verdict).collect();
        if played == 2 {
            assert!(!verdicts.contains(&Some(Verdict::CannotTell)));
        }
        let steps = cascade.ensembles.iter().map(|one| one.parts);
        assert_eq!(steps.collect::<Vec<_>>(), [1, 2, 4]);
    }
    let all: usize = cascades
        .iter()
        .map(|one| one.ensembles[0].members.len())
        .sum();
    assert!(all > 4, "two seeds are too few for any of it");
    let table = csv(&cascades, &[]);
    assert_eq!(table.lines().count(), 1 + 3 * all);
    // Provot's forces are nobody's.
    let forces = &cascades[1].numbers[3];
    assert_eq!(
        (cascades[1].method.as_str(), &forces.spreads[0]),
        ("provot", &None)
    );
}

#[test]
fn it_ends_at_once_and_without_a_result() {
    let played = play(&options(1000), &|| true, |_, _| {});
    assert!(played.expect("no bug").is_none());
}

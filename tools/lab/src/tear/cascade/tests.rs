//! References are found where methods agree, and only there; every seed is played at every step.

use std::sync::atomic::{AtomicUsize, Ordering};

use plotters::prelude::*;
use tearmesh_cloth::scene::ensemble::Observed;

use super::*;

/// An ensemble whose torn lengths are about a middle, and of which nobody says the forces.
fn torn(step_divisor: NonZero<u32>, middle_m: f64) -> Ensemble {
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
            visits: 100 * u64::from(step_divisor.get()),
        }),
    };
    Ensemble {
        step_divisor,
        step_s: 1e-3 / f64::from(step_divisor.get()),
        members: (1..=16).map(member).collect(),
    }
}

fn cascade(method: &str, middles_m: [f64; 3]) -> Cascade {
    let ensembles: Vec<Ensemble> = PARTS
        .iter()
        .zip(middles_m)
        .map(|(&step_divisor, middle_m)| torn(step_divisor, middle_m))
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
        text.contains("rip of 4 · torn length, m, logarithmic")
    };
    assert!(!caption(&cascades));
    let mut far = cascades.clone();
    far.push(cascade("provot", [60.0; 3]));
    conclude(&mut far);
    assert!(caption(&far));
    let said = summary(&cascades);
    assert!(said.contains(
        "rip of 4 cells, torn length in m; reference: the finest of verlet and implicit"
    ));
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

/// A cascade of so many cells, whose runs cost so much at the step.
fn on(cells: u32, method: &str, middles_m: [f64; 3], visits: u64) -> Cascade {
    let mut cascade = cascade(method, middles_m);
    cascade.cells = cells;
    for ensemble in &mut cascade.ensembles {
        for member in &mut ensemble.members {
            let seen = member.observed.as_mut().expect("it is done");
            seen.visits = visits * u64::from(ensemble.step_divisor.get());
        }
    }
    cascade
}

#[test]
fn the_better_buy_is_what_changes_more_per_factor_of_cost() {
    let cascades = [
        // The mesh alone changes it.
        on(8, "verlet", [1.0, 1.0, 1.0], 100),
        on(16, "verlet", [2.0, 2.0, 2.0], 800),
        on(32, "verlet", [2.02, 2.0, 2.0], 6400),
        // Each changes it twofold, but the mesh costs eight times as much, and the step twice.
        on(8, "xpbd", [1.0, 2.0, 4.0], 100),
        on(16, "xpbd", [2.0, 4.0, 8.0], 800),
        // Alone of its mesh.
        on(16, "pbd", [1.0, 2.0, 4.0], 100),
    ];
    let found = finer(&cascades);
    let torn = found.iter().filter(|one| one.quantity == "torn_m");
    let told: Vec<(&str, [u32; 2], Option<&str>)> = torn
        .map(|one| {
            (
                one.method.as_str(),
                [one.cells, one.finer_cells],
                one.better,
            )
        })
        .collect();
    assert_eq!(
        told,
        [
            ("verlet", [8, 16], Some("mesh")),
            ("verlet", [16, 32], None),
            ("xpbd", [8, 16], Some("step")),
        ]
    );
    let of_mesh = found[0].by_mesh.expect("both tore");
    assert_eq!((of_mesh.change.ratio, of_mesh.cost_ratio), (2.0, 8.0));
    assert_eq!(found[0].by_step.map(|way| way.cost_ratio), Some(2.0));
    // Of forces nobody says anything.
    let force = found.iter().find(|one| one.quantity == "largest_force_n");
    assert!(force.is_some_and(|one| one.by_mesh.is_none() && one.better.is_none()));
    let said = summary(&conclusions(cascades.to_vec()));
    assert!(
        said.contains("rip of 8 cells by verlet, torn_m: half the step ×1 (same) for ×2.0 the cost, 16 cells ×2 (differ) for ×8.0 the cost: the mesh is the better buy"),
        "{said}"
    );
}

fn conclusions(mut cascades: Vec<Cascade>) -> Vec<Cascade> {
    conclude(&mut cascades);
    cascades
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
        cells: vec![6],
        methods: vec!["implicit".to_owned(), "provot".to_owned()],
        seeds,
        threads: NonZero::<usize>::MIN.saturating_add(1),
    }
}

#[test]
fn every_seed_is_played_at_every_step() {
    let mut parts = Vec::new();
    let played = play(&options(2), &|| false, |_, part| parts.push(part));
    let (cascades, missing) = played.expect("no bug");
    assert!(missing.is_empty());
    assert!(parts.iter().all(|part| (0.0..=1.0).contains(part)));
    assert_eq!(parts.len() as u64, runs(&options(2)));
    for cascade in &cascades {
        let steps = cascade.ensembles.iter().map(|one| one.step_divisor.get());
        assert_eq!(steps.collect::<Vec<_>>(), [1, 2, 4]);
        for ensemble in &cascade.ensembles {
            let seeds = ensemble.members.iter().map(|member| member.seed);
            assert_eq!(seeds.collect::<Vec<_>>(), [1, 2]);
        }
    }
    let table = csv(&cascades, &[]);
    assert_eq!(table.lines().count(), 1 + 2 * 3 * 2);
    // Two seeds are too few for any of it, and of Provot's forces nobody knows.
    let said = summary(&cascades);
    assert!(said.contains(" of 6 halvings cannot tell; "), "{said}");
    // Provot's forces are nobody's.
    let forces = &cascades[1].numbers[3];
    assert_eq!(
        (cascades[1].method.as_str(), &forces.spreads[0]),
        ("provot", &None)
    );
}

#[test]
fn interrupted_ensembles_have_the_runs_that_were_done_and_are_named() {
    let names = ["rip-6-implicit", "rip-6-provot"];
    let played = play(&options(1000), &|| true, |_, _| {});
    let (cascades, missing) = played.expect("no bug");
    assert!(cascades.is_empty());
    let none = names.map(|name| Missing::interrupted(name.to_owned()));
    assert_eq!(missing, none);
    // After two runs of six; each of two threads may do one more before it hears of them.
    let heard = AtomicUsize::new(0);
    let stop = || heard.load(Ordering::SeqCst) >= 2;
    let watch = |_: &str, _| {
        heard.fetch_add(1, Ordering::SeqCst);
    };
    let (cascades, missing) = play(&options(2), &stop, watch).expect("no bug");
    let [implicit] = &cascades[..] else {
        panic!("{cascades:?}");
    };
    let members = implicit.ensembles.iter().flat_map(|one| &one.members);
    let runs = members.clone().count();
    let done = members
        .filter(|one| one.status == MemberStatus::Done)
        .count();
    assert!((2..=4).contains(&done) && runs == 6, "{done} of {runs}");
    let why = format!("interrupted after {done} of {runs} runs");
    let part = names[0].to_owned();
    assert_eq!(missing, [Missing { part, why }, none[1].clone()]);
    // Those that are left are not drawn at random. Which run was the last differs.
    let whole = |one: &Ensemble| one.members.iter().all(|m| m.status == MemberStatus::Done);
    for number in &implicit.numbers {
        for (pair, halving) in implicit.ensembles.windows(2).zip(&number.halvings) {
            let is_same = halving.is_some_and(|found| found.verdict == Verdict::Same);
            assert!(!is_same || pair.iter().all(whole), "{number:?}");
        }
    }
    let table = csv(&cascades, &missing);
    let stopped = table.lines().filter(|line| line.contains(",interrupted,"));
    assert_eq!(stopped.count(), runs - done);
}

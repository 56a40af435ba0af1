//! Lines through costs that are known, answers by hand, the same study from its parts, and an end at once.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::place::QUESTIONS;
use super::*;
use crate::pareto::{Family, PARTS, Status};

fn options(stiffness_n_per_m: &[f64], mass_ratios: &[f64]) -> Options {
    Options {
        stiffness_n_per_m: stiffness_n_per_m.to_vec(),
        mass_ratios: mass_ratios.to_vec(),
        cells: 4,
        methods: ["verlet", "verlet-plain", "xpbd-1", "bdf2-100"]
            .map(str::to_owned)
            .into(),
        cost_max: COST_MAX,
        threads: NonZero::<usize>::MIN.saturating_add(1),
    }
}

fn made(options: &Options) -> Study {
    let study = study(options, Provenance::default(), &|| false, |_, _| {});
    study.expect("nobody stops it")
}

/// A place with such costs of XPBD and of Verlet's method, which does not ask for displacements.
fn planted(stiffness_n_per_m: f64, xpbd: Option<u64>, verlet: Option<u64>) -> Place {
    let cost = |(family, visits): (Family, Option<u64>)| FamilyCost {
        family,
        visits,
        run: None,
        is_at_most: false,
        is_cut_short: false,
    };
    let costs = [(Family::Verlet, verlet), (Family::Xpbd, xpbd)];
    Place {
        stiffness_n_per_m,
        mass_ratio: 1.0,
        visits_max: 0,
        amplification: None,
        references: Vec::new(),
        runs: Vec::new(),
        answers: vec![Answer {
            asked: QUESTIONS[0],
            floor: Some(0.0),
            is_barred: false,
            is_known: true,
            costs: costs.map(cost).into(),
        }],
    }
}

/// The line of these places against Verlet's method.
fn line_of(places: Vec<Place>) -> Line {
    let mut study = Study {
        places,
        ..made(&options(&[], &[]))
    };
    study.conclude();
    let mut lines = study.lines.into_iter();
    let found = lines.find(|line| line.asked == QUESTIONS[0] && line.opponent == Family::Verlet);
    found.expect("a line for each ratio")
}

#[test]
fn a_line_of_powers_crosses_where_the_powers_are_equal() {
    // 3e6 = 1e4 k^½ at k = 9e4; of a power law linear interpolation of logarithms is exact.
    let verlet = |k: f64| Some((1e4 * k.sqrt()).round() as u64);
    let places = [1e6, 1e2, 1e5, 1e4, 1e3].map(|k| planted(k, Some(3_000_000), verlet(k)));
    let line = line_of(places.into());
    assert_eq!(line.begins_with_xpbd, Some(false));
    let [crossing] = line.crossings[..] else {
        panic!("one change: {line:?}");
    };
    assert_eq!((crossing.from_n_per_m, crossing.to_n_per_m), (1e4, 1e5));
    assert!(crossing.is_to_xpbd);
    let at = crossing.at_n_per_m.expect("both costs are known");
    assert!((at / 9e4 - 1.0).abs() < 1e-3, "{at}");
}

#[test]
fn who_misses_the_tolerance_is_dearer_and_who_costs_the_same_is_not_cheaper() {
    let line = line_of(vec![
        planted(1e2, None, Some(5)),
        planted(1e3, Some(7), None),
        // Nobody meets it: skipped.
        planted(1e4, None, None),
        planted(1e5, Some(6), Some(6)),
        planted(1e6, Some(5), Some(6)),
    ]);
    assert_eq!(line.known_n_per_m, [1e2, 1e3, 1e5, 1e6]);
    assert_eq!(line.begins_with_xpbd, Some(false));
    let changes = line
        .crossings
        .iter()
        .map(|c| (c.from_n_per_m, c.to_n_per_m, c.is_to_xpbd));
    let expected = [(1e2, 1e3, true), (1e3, 1e5, false), (1e5, 1e6, true)];
    assert_eq!(changes.collect::<Vec<_>>(), expected);
    assert_eq!(line.crossings[0].at_n_per_m, None);
    assert_eq!(line.crossings[1].at_n_per_m, None);
    let at = line.crossings[2].at_n_per_m.expect("both costs are known");
    assert!((at - 1e5).abs() < 1.0, "equal there: {at}");
}

/// The least cost of the runs of a family whose error, and that of each shorter step of the same series, is
/// within a tolerance.
fn least(place: &Place, family: Family, asked: Asked) -> Option<u64> {
    let error = |run: &Run| {
        let mut errors = run.errors.iter();
        let found = errors.find(|error| error.observable == asked.observable);
        found.map(|error| error.total)
    };
    let mut least = None;
    for run in &place.runs {
        let Some(part) = run
            .part
            .filter(|_| run.family == family && error(run).is_some())
        else {
            continue;
        };
        let is_shorter =
            |other: &&Run| other.series == run.series && other.part.is_some_and(|p| p <= part);
        let mut shorter = place.runs.iter().filter(is_shorter).filter_map(error);
        if shorter.all(|error| error <= asked.tolerance) {
            least = Some(run.visits.min(least.unwrap_or(u64::MAX)));
        }
    }
    least
}

#[test]
fn the_cost_of_a_family_is_the_least_of_the_runs_that_all_shorter_steps_confirm() {
    let study = made(&options(&[1e2, 1e4], &[1.0, 1e-3]));
    let (mut met, mut missed) = (0, 0);
    for place in &study.places {
        let of_budget = place.runs.iter().filter(|run| run.part.is_some());
        assert_eq!(of_budget.count(), 4 * PARTS.len());
        for answer in &place.answers {
            let floor = answer.floor.unwrap_or(f64::INFINITY);
            let is_known = 10.0 * floor <= answer.asked.tolerance;
            assert_eq!(answer.is_known, is_known);
            for cost in &answer.costs {
                let expected = least(place, cost.family, answer.asked);
                assert_eq!(cost.visits, expected.filter(|_| is_known), "{cost:?}");
                met += u32::from(cost.visits.is_some());
                missed += u32::from(is_known && cost.visits.is_none());
            }
        }
    }
    assert!(met >= 12 && missed >= 1, "{met} met, {missed} missed");
}

#[test]
fn an_error_that_passes_through_zero_meets_no_tolerance() {
    let run = |part: f64, visits: u64, total: f64, vouched: f64| Run {
        run: format!("xpbd-1@{part}"),
        series: "xpbd-1".to_owned(),
        family: Family::Xpbd,
        part: Some(part),
        dt_s: Some(part),
        status: Status::Ok,
        why: String::new(),
        steps: visits,
        visits,
        errors: vec![RunError {
            observable: QUESTIONS[0].observable,
            total,
            vouched,
        }],
    };
    let runs = [
        run(2.0, 10, 1e-3, 0.2),
        run(1.0, 20, 0.2, 0.2),
        run(0.5, 40, 0.04, 0.04),
        run(0.25, 80, 0.01, 0.01),
    ];
    let cost = |is_known| FamilyCost::new(Family::Xpbd, QUESTIONS[0], is_known, &runs);
    assert_eq!(cost(true).visits, Some(40));
    assert!(!cost(true).is_at_most && !cost(true).is_cut_short);
    assert_eq!(cost(false).visits, None);
    let longest = FamilyCost::new(
        Family::Xpbd,
        QUESTIONS[0],
        true,
        &[run(2.0, 10, 0.01, 0.01)],
    );
    assert!(longest.is_at_most && longest.visits == Some(10));
}

#[test]
fn a_light_particle_shortens_the_steps_of_plain_verlet_alone() {
    let methods = ["verlet", "verlet-plain"].map(str::to_owned).into();
    let study = made(&Options {
        methods,
        cost_max: 200.0,
        ..options(&[1e3], &[1e-2, 1e-4])
    });
    let [light, lighter] = &study.places[..] else {
        panic!("two places");
    };
    let shortened = |name: &str| {
        let step_s = |place: &Place| {
            let found = place.runs.iter().find(|run| run.run == name);
            found.and_then(|run| run.dt_s).expect("it ran")
        };
        step_s(light) / step_s(lighter)
    };
    // A particle that is much lighter than its neighbours has the frequency √(k/m); steps are whole fractions
    // of a tenth of a second.
    let plain = shortened("verlet-plain@0.5");
    assert!((plain - 10.0).abs() < 0.3, "{plain}");
    let guarded = shortened("verlet@0.5");
    assert!((guarded - 1.0).abs() < 0.1, "{guarded}");
}

#[test]
fn runs_that_cost_too_much_are_rows_that_say_so() {
    let few = Options {
        cost_max: 3.0,
        ..options(&[1e3], &[1.0])
    };
    let many = Options {
        cost_max: 1e3,
        ..few.clone()
    };
    let [few, many] = [few, many].map(|options| made(&options));
    let unit = many.places[0]
        .runs
        .iter()
        .find(|run| run.run == "verlet@1")
        .expect("a run")
        .visits;
    assert_eq!(few.places[0].runs.len(), many.places[0].runs.len());
    let mut cut = 0;
    for (short, whole) in few.places[0].runs.iter().zip(&many.places[0].runs) {
        assert_eq!(short.run, whole.run);
        assert_ne!(whole.status, Status::TooDear, "{whole:?}");
        if short.status == Status::TooDear {
            cut += 1;
            assert!(short.errors.is_empty() && short.visits < 4 * unit);
            // To the accuracy of estimates, which know no visits to detect and to measure.
            assert!(whole.visits as f64 > 2.5 * unit as f64, "{whole:?}");
        } else {
            assert_eq!(short.visits, whole.visits);
        }
    }
    assert!(cut >= 4, "{cut} runs");
    let xpbd = |study: &Study| {
        study.places[0].answers[1]
            .cost(Family::Xpbd)
            .expect("runs")
            .is_cut_short
    };
    assert!(xpbd(&few) && !xpbd(&many));
}

#[test]
fn references_and_the_gate_have_no_limit() {
    let study = made(&Options {
        cost_max: 1.0,
        ..options(&[1e2], &[1e-2])
    });
    let place = &study.places[0];
    assert_eq!(place.references.len(), 6);
    for of in &place.references {
        assert_eq!(of.status, Status::Ok, "{}", of.run);
        assert!(of.visits > place.visits_max, "{}", of.run);
    }
    assert!(place.amplification.is_some());
}

#[test]
fn a_study_is_its_parts_one_after_the_other_however_many_work_on_it() {
    let whole = made(&options(&[1e2, 1e3], &[1.0, 1e-3]));
    let mut parts = Vec::new();
    for place in [(1e3, 1e-3), (1e2, 1e-3), (1e3, 1.0), (1e2, 1.0)] {
        let alone = Options {
            threads: NonZero::<usize>::MIN,
            ..options(&[place.0], &[place.1])
        };
        parts.extend(made(&alone).places);
    }
    let mut gathered = Study {
        places: parts,
        lines: Vec::new(),
        ..whole.clone()
    };
    gathered.conclude();
    assert_eq!(csv(&gathered), csv(&whole));
    assert_eq!(svg(&gathered), svg(&whole));
    assert_eq!(summary(&gathered), summary(&whole));
    let columns = csv(&whole);
    let mut counts = columns.lines().map(|line| {
        line.split('"')
            .step_by(2)
            .collect::<String>()
            .matches(',')
            .count()
    });
    let head = counts.next().expect("a head");
    assert!(counts.all(|count| count == head));
}

#[test]
fn a_place_without_an_answer_says_why() {
    let study = made(&options(&[1e3], &[1.0]));
    let told = |change: &dyn Fn(&mut Answer)| {
        let mut study = study.clone();
        let places = study.places.iter_mut();
        places
            .flat_map(|place| &mut place.answers)
            .for_each(|answer| {
                answer.costs.iter_mut().for_each(|cost| cost.visits = None);
                change(answer);
            });
        study.conclude();
        assert!(summary(&study).contains("not known"));
        svg(&study).expect("a chart")
    };
    let below = told(&|answer| (answer.is_known, answer.floor) = (false, Some(0.05)));
    assert!(below.contains("not known: floor"));
    assert!(
        told(&|answer| (answer.is_known, answer.floor) = (false, None)).contains("no reference")
    );
    assert!(told(&|answer| answer.is_barred = true).contains("barred: noise"));
    assert!(told(&|answer| answer.is_known = true).contains("nobody meets it"));
}

#[test]
fn an_interrupted_study_has_the_places_that_were_done_and_names_the_others() {
    let options = options(&[1e3, 1e4], &[1.0, 0.1]);
    let whole = made(&options);
    let of_place = expected(&options).0 / 4;
    // In the middle of the third place, and before the first.
    let heard = AtomicUsize::new(0);
    let stop = || heard.load(Ordering::SeqCst) > 2 * of_place;
    let watch = |_: &str, _| {
        heard.fetch_add(1, Ordering::SeqCst);
    };
    let some = study(&options, Provenance::default(), &stop, watch).expect("two places");
    assert_eq!(
        format!("{:?}", some.places),
        format!("{:?}", &whole.places[..2])
    );
    let missing = ["1e4-1e0", "1e4-1e-1"].map(|name| Missing::interrupted(name.to_owned()));
    assert_eq!(some.missing, missing);
    assert!(svg(&some).is_some_and(|chart| chart.contains("MISSING: 1e4-1e0, 1e4-1e-1")));
    assert!(study(&options, Provenance::default(), &|| true, |_, _| {}).is_none());
}

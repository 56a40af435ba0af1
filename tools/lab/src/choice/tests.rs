//! Tasks lie in their ranges and do not depend on each other; rankings of tables made by hand.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use super::*;
use crate::pareto::Status;

fn task(number: u32, tolerance: f64) -> Task {
    let mut task = tasks(SEED, 1..=1, SECONDS).remove(0);
    (task.number, task.tolerance) = (number, tolerance);
    task
}

/// A run that is off by as much in all that is asked.
fn run(series: &str, part: Option<f64>, visits: u64, error: f64) -> Run {
    Run {
        series: series.to_owned(),
        part,
        dt_s: Some(1e-3),
        status: Status::Ok,
        visits,
        errors: [Some(error); 3],
    }
}

fn trial(task: Task, runs: Vec<Run>) -> Trial {
    Trial {
        task,
        edges: 1,
        edge_s: 1e-3,
        amplification: Some(1.0),
        floors: [Some(1e-6); 3],
        unsolved: Vec::new(),
        reference_visits: 0,
        runs,
    }
}

fn of(ranking: &Ranking, name: &str) -> Regret {
    let mut all = ranking.regrets.iter();
    all.find(|regret| regret.policy == name)
        .expect("a policy")
        .clone()
}

#[test]
fn tasks_are_the_same_whichever_of_them_are_asked_for_and_lie_in_their_ranges() {
    let all = tasks(SEED, 1..=TASKS, SECONDS);
    assert_eq!(all.len(), 60);
    assert_eq!(tasks(SEED, 21..=40, SECONDS), all[20..40]);
    assert_ne!(tasks(2014, 1..=TASKS, SECONDS)[0], all[0]);
    for (i, task) in all.iter().enumerate() {
        assert_eq!(task.number as usize, i + 1);
        assert!((1e2..=1e6).contains(&task.stiffness_n_per_m), "{task:?}");
        assert!((6..=20).contains(&task.cells), "{task:?}");
        assert!((0.01..=0.2).contains(&task.tolerance), "{task:?}");
        let drag = task.drag_per_s;
        assert!(drag == 0.0 || (0.1..=100.0).contains(&drag), "{task:?}");
        assert!((1e-4..=1.0).contains(&task.middle_mass_ratio), "{task:?}");
        if let Motion::Taut(part) = task.motion {
            assert!((0.002..=0.05).contains(&part), "{task:?}");
        }
    }
    // One in four, one in two, one in three; of sixty, within four standard deviations.
    let count = |is: fn(&Task) -> bool| all.iter().filter(|task| is(task)).count();
    assert!((2..=28).contains(&count(|task| task.drag_per_s == 0.0)));
    assert!((15..=45).contains(&count(|task| task.middle_mass_ratio == 1.0)));
    assert!((6..=34).contains(&count(|task| task.motion == Motion::Swing)));
    assert!((15..=45).contains(&count(|task| task.is_delaunay)));
}

#[test]
fn regret_is_the_geometric_mean_of_cost_over_the_cheapest() {
    // Verlet pays 2 and 8 times the cheapest: 4. XPBD pays 1 and 1.
    let trials = [
        trial(
            task(1, 0.1),
            vec![
                run("verlet", Some(1.0), 100, 0.2),
                run("verlet", Some(0.5), 200, 0.1),
                run("xpbd-1", Some(1.0), 100, 0.05),
            ],
        ),
        trial(
            task(2, 0.1),
            vec![
                run("verlet", Some(0.5), 800, 0.01),
                run("xpbd-4", Some(1.0), 100, 0.1),
                run("xpbd-4", Some(0.5), 200, 0.01),
            ],
        ),
    ];
    let ranking = rank(&trials, Demand::All);
    let verlet = of(&ranking, "Verlet, best step");
    assert!(
        (verlet.regret - 4.0).abs() < 1e-12 && verlet.missed == 0,
        "{verlet:?}"
    );
    // The logarithms of 2 and 8 have a mean of ln 4 and a standard error of ln 2.
    let [low, high] = verlet.interval;
    let apart = 2_f64.powf(1.96);
    assert!(
        (low * apart - 4.0).abs() < 1e-9 && (high / apart - 4.0).abs() < 1e-9,
        "{low} {high}"
    );
    let xpbd = of(&ranking, "XPBD, best step");
    assert!((xpbd.regret - 1.0).abs() < 1e-12, "{xpbd:?}");
    // The better rival is XPBD, and a planner would need less than the least there is.
    assert_eq!(ranking.planner_max, Some(PLANNER_SHARE * xpbd.regret));
    let series: Vec<&str> = ranking
        .standings
        .iter()
        .map(|s| s.series.as_str())
        .collect();
    assert_eq!(series, ["xpbd-1", "xpbd-4"]);
}

#[test]
fn a_missed_tolerance_costs_ten_times_verlet_or_the_cheapest() {
    let met = trial(
        task(1, 0.1),
        vec![
            run("verlet", Some(0.5), 300, 0.1),
            run("euler", Some(0.5), 100, 0.1),
            run("xpbd-1", Some(1.0), 10, 0.3),
        ],
    );
    let ranking = rank(&[met], Demand::All);
    let xpbd = of(&ranking, "XPBD, best step");
    assert!(
        (xpbd.regret - 30.0).abs() < 1e-9 && xpbd.missed == 1,
        "{xpbd:?}"
    );
    let mut refused = run("verlet", Some(0.5), 0, 0.0);
    (refused.status, refused.errors) = (Status::Refused, [None; 3]);
    let missed = trial(
        task(2, 0.1),
        vec![refused, run("euler", Some(0.5), 100, 0.1)],
    );
    let ranking = rank(&[missed], Demand::All);
    for name in ["Verlet, best step", "XPBD, best step", "Verlet, default"] {
        let regret = of(&ranking, name);
        assert!(
            (regret.regret - 10.0).abs() < 1e-9 && regret.missed == 1,
            "{regret:?}"
        );
    }
}

#[test]
fn a_default_is_no_foresight_and_a_fixed_step_is_its_own() {
    let trial = trial(
        task(1, 0.1),
        vec![
            run("verlet", Some(1.0), 100, 0.1),
            run("verlet", Some(0.5), 200, 0.1),
            run("verlet", None, 50, 0.1),
        ],
    );
    let ranking = rank(&[trial], Demand::All);
    for (name, ratio) in [
        ("Verlet, best step", 1.0),
        ("Verlet, the step that suits it", 2.0),
        ("Verlet, default", 0.5),
    ] {
        let regret = of(&ranking, name).regret;
        assert!((regret - ratio).abs() < 1e-12, "{name}: {regret}");
    }
}

#[test]
fn what_is_not_known_is_told_and_each_demand_counts_its_own() {
    let good = || vec![run("verlet", Some(0.5), 100, 0.01)];
    let mut blurred = trial(task(1, 0.1), good());
    blurred.floors[1] = Some(0.011);
    let mut lost = trial(task(2, 0.1), good());
    lost.floors[2] = None;
    let none = trial(task(3, 0.1), vec![run("verlet", Some(0.5), 100, 0.2)]);
    let mut barred = trial(task(4, 0.1), good());
    (barred.amplification, barred.floors[0]) = (Some(1e4), None);
    barred.runs[0].errors[0] = None;
    let trials = [blurred, lost, none, barred];
    let told = |demand| {
        let ranking = rank(&trials, demand);
        let unknown = ranking.unknown.iter();
        unknown.map(|one| (one.number, one.why)).collect::<Vec<_>>()
    };
    let (blurred, lost) = ((1, Why::BelowFloor), (2, Why::NoReference));
    let none = (3, Why::NobodyMeetsIt);
    assert_eq!(told(Demand::All), [blurred, lost, none]);
    assert_eq!(told(Demand::Outside), [lost, none]);
    assert_eq!(told(Demand::Force), [blurred, none]);
    assert_eq!(told(Demand::Reaction), [lost, none]);
}

/// The cheapest run is found again by plain loops.
#[test]
fn a_small_study_has_a_row_for_each_candidate_and_step_and_is_the_same_twice() {
    let options = |scenes| Options {
        seed: SEED,
        scenes,
        seconds: 0.03,
        threads: NonZero::<usize>::MIN,
    };
    let make = |scenes| {
        let made = study(
            &options(scenes),
            Provenance::default(),
            &|| false,
            |_, _| {},
        );
        made.expect("nobody stops it")
    };
    let whole = make(1..=3);
    for trial in &whole.trials {
        let budget = trial.runs.iter().filter(|run| run.part.is_some());
        assert_eq!(
            budget.count(),
            CANDIDATES.len() * crate::pareto::PARTS.len()
        );
        let defaults = trial.runs.iter().filter(|run| run.part.is_none());
        let names: Vec<&str> = defaults.map(|run| run.series.as_str()).collect();
        assert_eq!(names, ["verlet", "xpbd", "implicit"]);
    }
    let ranking = &whole.rankings[0];
    assert!(!ranking.standings.is_empty(), "{:?}", ranking.unknown);
    for standing in &ranking.standings {
        let mut trials = whole.trials.iter();
        let trial = trials.find(|trial| trial.task.number == standing.number);
        let mut least = u64::MAX;
        for run in &trial.expect("a trial").runs {
            let worst = run.errors.iter().flatten().fold(0.0_f64, |a, b| a.max(*b));
            let is_known = run.errors.iter().all(Option::is_some);
            if run.part.is_some() && is_known && worst <= trial.expect("a trial").task.tolerance {
                least = least.min(run.visits);
            }
        }
        assert_eq!(standing.visits, least);
    }
    // Parts, gathered in any order, are the whole.
    let mut gathered = make(3..=3);
    gathered.trials.extend(make(1..=2).trials);
    gathered.conclude();
    assert_eq!(format!("{gathered:?}"), format!("{whole:?}"));
    assert_eq!(csv(&gathered), csv(&whole));
    let lines = 1 + 3 * (1 + 99) + ranking_lines(&whole);
    assert_eq!(csv(&whole).lines().count(), lines);
    assert!(svg(&whole).is_some_and(|chart| chart.contains("Cost over that of the cheapest")));
    assert!(summary(&whole).starts_with("all three: "));
}

fn ranking_lines(study: &Study) -> usize {
    let of = |ranking: &Ranking| 9 * ranking.standings.len() + ranking.unknown.len();
    study.rankings.iter().map(of).sum()
}

#[test]
fn it_ends_at_once() {
    let options = Options {
        seed: SEED,
        scenes: 1..=TASKS,
        seconds: SECONDS,
        threads: NonZero::<usize>::MIN,
    };
    let asked = AtomicUsize::new(0);
    let begun = Instant::now();
    let stop = || asked.fetch_add(1, Ordering::Relaxed) > 10;
    assert!(study(&options, Provenance::default(), &stop, |_, _| {}).is_none());
    assert!(asked.load(Ordering::Relaxed) < 200 && begun.elapsed().as_secs() < 20);
}

#[test]
fn an_interrupted_study_has_the_scenes_that_were_done_and_names_the_others() {
    let options = Options {
        seed: SEED,
        scenes: 1..=3,
        seconds: 0.02,
        threads: NonZero::<usize>::MIN,
    };
    let made = |last: usize| {
        let heard = AtomicUsize::new(0);
        let stop = || heard.load(Ordering::SeqCst) >= last;
        let watch = |_, _| {
            heard.fetch_add(1, Ordering::SeqCst);
        };
        study(&options, Provenance::default(), &stop, watch).expect("a scene at least")
    };
    let [some, whole] = [1, 4].map(made);
    // The costliest is the first, and another one may have been begun before it was heard of.
    let done: Vec<u32> = some.trials.iter().map(|trial| trial.task.number).collect();
    assert!((1..=2).contains(&done.len()), "{done:?}");
    for trial in &some.trials {
        let mut all = whole.trials.iter();
        let same = all.find(|other| other.task.number == trial.task.number);
        assert_eq!(format!("{:?}", Some(trial)), format!("{same:?}"));
    }
    let others = (1..=3).filter(|number| !done.contains(number));
    let others = others.map(|number| Missing::interrupted(format!("scene {number}")));
    assert_eq!(some.missing, others.collect::<Vec<_>>());
    assert!(whole.missing.is_empty() && svg(&some).is_some_and(|chart| chart.contains("MISSING")));
}

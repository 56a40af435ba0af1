//! What differs is counted, what is silent is counted, and references are those of another method as well.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use tearmesh_cloth::StepError;
use tearmesh_cloth::scene::{Frame, Run};

use super::*;

/// Says one word of what failed, or none.
struct Terse {
    is_mute: bool,
}

impl Teller for Terse {
    fn step(&self, _: &StepError) -> Told {
        Told {
            code: "E".to_owned(),
            words: "\"no\", and that is that".to_owned(),
        }
    }

    fn run(&self, _: &Run, _: &Frame, error: Option<&StepError>) -> Vec<Told> {
        let said = error
            .filter(|_| !self.is_mute)
            .map(|error| self.step(error));
        said.into_iter().collect()
    }
}

fn trial(name: &str) -> &'static Trial {
    let mut all = TRIALS.iter();
    all.find(|trial| trial.name == name).expect("a trial")
}

fn judged(name: &str, is_mute: bool) -> Vec<Verdict> {
    let verdicts = trial(name).judge(&Terse { is_mute }, &|| false);
    verdicts.expect("nobody stops it")
}

#[test]
fn methods_stand_in_one_order() {
    assert_eq!(crate::pareto::Named::all().map(|named| named.name), METHODS);
}

#[test]
fn what_fails_with_nothing_said_is_silent() {
    let silent = |is_mute| {
        let of = |one: &Verdict| (one.method, one.is_silent());
        judged("wind", is_mute).iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!(silent(false), METHODS.map(|method| (method, false)));
    assert_eq!(silent(true), METHODS.map(|method| (method, true)));
    let fine = judged("free fall", true);
    assert!(
        fine.iter()
            .all(|one| one.measured == Class::Fine && !one.is_silent())
    );
}

#[test]
fn a_cell_that_the_watch_lets_pass_is_silent_and_differs() {
    let asked = limit::asked(&[1e3]);
    let first = asked
        .iter()
        .find(|asked| asked.name() == "chain at 1e3 N/m by Verlet, plain");
    let teller = Terse { is_mute: false };
    let limit = first.expect("it is asked").find(&teller, &|| false);
    let mut limit = limit.expect("nobody stops it");
    // 2√(k/m) sin(31π/66) is the largest frequency of sixteen links of 10 g.
    let omega = 2.0 * 1e5_f64.sqrt() * (31.0 * std::f64::consts::PI / 66.0).sin();
    let measured = limit.measured_s.expect("it blows up");
    assert!(
        (measured * omega / 2.0 - 1.0).abs() < AGREEMENT,
        "{measured}"
    );
    assert!(limit.agrees && limit.cells.iter().all(|cell| !cell.is_silent()));
    let last = limit.cells.last_mut().expect("cells");
    assert!(last.has_failed() && last.told.len() == 1);
    last.told.clear();
    assert!(last.is_silent());
    last.watched = Class::Fine;
    assert!(last.is_silent() && !last.agrees(Theory::UpTo(2.0)));
}

/// The references of places are Verlet's, so they are played again by Newton's method of second order.
#[test]
fn another_method_is_where_references_are() {
    for (name, off_max) in [("hang", 0.01), ("pretension", 0.03), ("ringing", 0.03)] {
        let off = trial(name).off_by_newton(&|| false);
        let off = off.expect("nobody stops it");
        assert!(off < off_max, "{name}: {off}");
    }
}

#[test]
fn tables_have_a_line_for_all_and_quotes_are_doubled() {
    let study = Study {
        schema: "",
        provenance: Provenance::default(),
        limits: Vec::new(),
        verdicts: judged("wind", false),
        differing: 0,
        silent: 0,
        missing: Vec::new(),
    };
    let table = csv(&study);
    assert_eq!(table.lines().count(), 1 + METHODS.len());
    assert!(
        table.contains(",\"\"\"no\"\", and that is that\"\n"),
        "{table}"
    );
    let said = summary(&study);
    assert!(said.contains("wind, provot: refused; E\n"), "{said}");
    assert!(svg(&study).is_some_and(|chart| chart.contains("a gale")));
}

#[test]
fn it_ends_at_once() {
    let options = Options {
        stiffness_n_per_m: vec![1e3],
        threads: NonZero::<usize>::MIN,
    };
    let teller = Terse { is_mute: true };
    let asked = AtomicUsize::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) > 10;
    let begun = Instant::now();
    let made = study(&options, Provenance::default(), &teller, &stop, |_| {});
    assert!(made.is_none() && begun.elapsed().as_secs() < 20);
    assert!(asked.load(Ordering::Relaxed) < 1000);
}

#[test]
fn an_interrupted_study_has_what_was_done_and_names_the_others() {
    let options = Options {
        stiffness_n_per_m: vec![1e3],
        threads: NonZero::<usize>::MIN,
    };
    let teller = Terse { is_mute: false };
    let heard = AtomicUsize::new(0);
    let stop = || heard.load(Ordering::SeqCst) >= TRIALS.len();
    let watch = |_: &str| {
        heard.fetch_add(1, Ordering::SeqCst);
    };
    let some = study(&options, Provenance::default(), &teller, &stop, watch).expect("scenes");
    // Scenes go first, as they take longest; one limit may have been begun before the last was heard of.
    assert_eq!(some.verdicts.len(), METHODS.len() * TRIALS.len());
    assert!(some.limits.len() <= 1);
    let all = pieces(&options) - TRIALS.len();
    assert_eq!(some.limits.len() + some.missing.len(), all);
    let table = csv(&some);
    let missing = table.lines().filter(|line| line.starts_with("missing,"));
    assert_eq!(missing.clone().count(), some.missing.len());
    for line in missing {
        assert!(line.ends_with(",,,,,,,,,,,,,\"interrupted\""), "{line}");
    }
    assert!(svg(&some).is_some_and(|chart| chart.contains("MISSING: ")));
    assert!(summary(&some).starts_with(&format!("{} limits", some.limits.len())));
}

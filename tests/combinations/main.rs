//! Combinations of features, by a table of factors: every three levels of different factors meet in some
//! sequence of verbs, which is judged whole.
//!
//! `TEARMESH_SEED` is another seed of the table, to repeat a run.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod aims;
mod array;
mod counts;
#[path = "../cli/in_process.rs"]
#[allow(dead_code, reason = "the tests of the command use the rest")]
mod in_process;
mod judge;
mod library;
mod meshes;
mod naive_array;
mod options;
#[path = "../oracle/mod.rs"]
#[allow(
    dead_code,
    unused_imports,
    reason = "the tests of the kernel use the rest"
)]
mod oracle;
#[path = "../cli/read_back.rs"]
mod read_back;
mod sequence;
#[path = "../support/mod.rs"]
#[allow(dead_code, reason = "each has its users in some of the crates")]
mod support;
#[path = "../surfaces.rs"]
#[allow(dead_code, reason = "the tests of the kernel use the rest")]
mod surfaces;
mod table;
mod tear;
mod verb;
#[path = "../work.rs"]
#[allow(dead_code, reason = "the tests of the kernel use the rest")]
mod work;

use std::any::Any;
use std::ops::RangeInclusive;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::thread;

use counts::Counts;
use random::Random;
use sequence::Sequence;
use support::cases::{cases, planted};
use support::{delaunay, plain, random};
use table::Levels;
use verb::{Verb, script};

/// An oracle that was applied in fewer sequences counts as absent.
const LEAST: usize = 50;

/// So many sequences that fail end a run.
const FAILED_MAX: usize = 5;

/// The rows of a run that looks for a planted bug.
const PLANTED_ROWS: usize = 320;

/// Runs all rows of the table by a seed.
fn run(seed: u64) {
    let table = table::table();
    let cover = table.rows(3, &mut Random(seed));
    let (mut counts, mut untorn, mut verbs) = (Counts::default(), 0, 0);
    let mut failed = Vec::new();
    let most = planted().map_or(usize::MAX, |_| PLANTED_ROWS);
    for (i, row) in cover.rows.iter().enumerate().take(most) {
        let levels = Levels::new(&table, row);
        let mut sequence = Sequence::new(levels, 1_000_003 * seed + i as u64);
        let ran = catch_unwind(AssertUnwindSafe(|| sequence.run(&mut counts)));
        if let Err(panic) = ran {
            println!("row {i}: {}: {}", sequence.levels.words(), message(&*panic));
            failed.push(i);
            if failed.len() == FAILED_MAX || planted().is_some() {
                break;
            }
            if failed.len() == 1 {
                println!("{}", told(i, &sequence));
            }
        }
        untorn += usize::from(!sequence.has_torn);
        verbs += sequence.verbs.len();
    }
    let (rows, visited) = (cover.rows.len(), cover.visited);
    println!(
        "seed {seed}: {visited} triples in {rows} sequences of {verbs} verbs; {untorn} tore nothing"
    );
    let (lines, absent) = counts.lines(LEAST);
    lines.iter().for_each(|line| println!("  {line}"));
    assert!(
        failed.is_empty(),
        "{} sequences failed: {failed:?}",
        failed.len()
    );
    if planted().is_some() {
        return; // Fewer rows say less.
    }
    assert!(
        absent.is_empty(),
        "applied in fewer than {LEAST}: {absent:?}"
    );
    assert!(20 * untorn < rows, "{untorn} tore nothing");
}

/// What a panic says.
fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or_default()
}

/// What failed, and how to repeat it: with as few verbs as fail.
fn told(row: usize, sequence: &Sequence) -> String {
    let mut verbs: Vec<Verb> = sequence.verbs.clone();
    let fails = |verbs: &[Verb]| {
        let again = || sequence.run_again(verbs);
        catch_unwind(AssertUnwindSafe(again)).is_err()
    };
    let mut i = 0;
    while fails(&verbs) && i < verbs.len() {
        let mut fewer = verbs.clone();
        fewer.remove(i);
        match fails(&fewer) {
            true => verbs = fewer,
            false => i += 1,
        }
    }
    let levels = sequence.levels.words();
    format!(
        "row {row}: {levels}\n{}",
        script(&sequence.start.file, &verbs)
    )
}

/// Runs seeds in as many threads as there are processors.
fn run_all(seeds: RangeInclusive<u64>) {
    let seeds = Mutex::new(seeds);
    let next = || seeds.lock().expect("no thread panics here").next();
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(seed) = next() {
                    run(seed);
                }
            });
        }
    });
}

#[test]
fn every_three_levels_of_a_cut_meet_and_are_judged_whole() {
    let seed = std::env::var("TEARMESH_SEED").ok();
    match seed {
        Some(seed) => run(seed.parse().expect("a number")),
        None => run_all(1..=if cases() > 1_500 { 10 } else { 1 }),
    }
}

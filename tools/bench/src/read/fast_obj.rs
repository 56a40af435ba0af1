//! `fast_obj`, a reader in C, and ours beside it: in a fresh process and in a loop, small and large files.

use std::fs;
use std::io::stdin;
use std::process::Command;

use tearmesh_lab::statistics::median;
use tearmesh_obj::Document;

use crate::measure::timed_on_cpu;
use crate::options::Options;
use crate::process::{Process, Program};
use crate::sheet::{Dialect, Sheet};
use crate::table::{line, table};

/// The subcommand of our own process.
pub(crate) const OURS: &str = "read-for-fast-obj";

/// How many faces the small files have: half a megabyte or so.
const SMALL: usize = 12_000;

/// How often a process reads once it has.
const LOOP: usize = 10;

/// Answers as `rivals/fast_obj.cpp` does.
pub(crate) fn answer(path: &str) {
    let file = fs::read(path).expect("the parent wrote it");
    println!("ready tearmesh-obj");
    for _ in stdin().lines() {
        let (document, time) = timed_on_cpu(|| Document::read(&file[..]).expect("readable"));
        let counts = [document.positions().len(), document.polygon_count()];
        println!("{time:.9} {} {}", counts[0], counts[1]);
    }
}

/// Both on every file, as a table; or why there is none.
pub(super) fn tables(options: &Options) -> String {
    let compiled = match &options.fast_obj {
        Some(folder) => Program::compile("fast_obj", &["-march=native", "-I", folder]),
        None => Err("not compared (--fast-obj DIR, a folder with fast_obj.h)".to_owned()),
    };
    let program = match compiled {
        Ok(program) => program,
        Err(why) => return format!("fast_obj: {why}\n"),
    };
    let head = [
        "",
        "MB",
        "fresh ms",
        "x fast_obj",
        "in a loop ms",
        "x fast_obj",
        "",
    ];
    let mut lines = vec![line(head)];
    for faces in [SMALL, options.faces] {
        for dialect in [Dialect::Plain, Dialect::Texture, Dialect::FullDigits] {
            lines.push(compared(&program, &Sheet::new(dialect, faces), options));
        }
    }
    format!(
        "tearmesh-obj beside fast_obj (f32), each in processes of its own\n{}",
        table(&lines)
    )
}

fn compared(program: &Program, sheet: &Sheet, options: &Options) -> Vec<String> {
    let path = program.path().with_extension("obj");
    fs::write(&path, &sheet.text).expect("a temporary file");
    let mut times = [(); 4].map(|()| Vec::new());
    for _ in 0..options.rounds {
        let mut ours = Command::new(std::env::current_exe().expect("this program"));
        let theirs = Command::new(program.path());
        ours.arg(OURS);
        for (mut command, times) in [ours, theirs].into_iter().zip(times.chunks_mut(2)) {
            let process = Process::start(command.arg(&path), "").expect("a reader starts");
            times[0].push(seconds(&process, sheet));
            times[1].extend((0..LOOP).map(|_| seconds(&process, sheet)));
        }
    }
    let [fresh, warm, their_fresh, their_warm] =
        times.map(|times| median(times).expect("there is a round"));
    line([
        sheet.dialect.name(),
        &format!("{:.1}", sheet.text.len() as f64 / 1e6),
        &format!("{:.2}", fresh * 1e3),
        &format!("{:.2}", their_fresh / fresh),
        &format!("{:.2}", warm * 1e3),
        &format!("{:.2}", their_warm / warm),
        "",
    ])
}

/// How many seconds a process takes to read a sheet, whole.
fn seconds(process: &Process, sheet: &Sheet) -> f64 {
    let answer = process.ask("");
    let words: Vec<&str> = answer.split(' ').collect();
    let counts = [sheet.vertices, sheet.faces].map(|count| count.to_string());
    assert_eq!(words[1..], counts, "all of it is read");
    words[0].parse().expect("a number of seconds")
}

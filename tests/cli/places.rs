//! Places: what is never written over, and what is found out before the work.

use std::fs;
use std::time::{Duration, Instant};

use crate::harness::{Folder, seen};

#[test]
fn no_output_replaces_an_input_of_any_kind() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"hang\"\nseconds = 0.1\n");
    folder.write("r.txt", "0.31,2,5:0,0,-1 0.31,-2,5:0,0,-1\n");
    fs::create_dir(folder.path("f")).expect("a folder");
    folder.write("f/frame_00009.obj", "base = \"hang\"\nseconds = 0.1\n");
    let kept = ["s.toml", "r.txt", "f/frame_00009.obj"];
    let before = kept.map(|name| folder.read(name));
    let tear = "tearmesh tear flag.obj --seconds 0.1 --scene";
    for line in [
        format!("{tear} s.toml -o s.toml"),
        format!("{tear} s.toml -o ./s.toml --in-place"),
        format!("{tear} s.toml -q -o x.obj --report s.toml"),
        format!("{tear} f/frame_00009.obj --frames f -o x.obj"),
        format!("{tear} hang --frames f --report f/frame_00000.obj -o x.obj"),
        format!("{tear} hang -o new.obj --report ./new.obj"),
        "tearmesh cut flag.obj --rays-file r.txt -o r.txt".to_owned(),
        "tearmesh cut flag.obj --rays-file r.txt --report r.txt -o x.obj".to_owned(),
    ] {
        let said = seen(&folder.run(&line));
        assert!(
            said.contains("error[E-USAGE]") && said.ends_with("(exit 2)\n"),
            "{line}\n{said}"
        );
        assert_eq!(kept.map(|name| folder.read(name)), before, "{line}");
        assert!(!folder.path("x.obj").exists(), "{line}");
    }
    // A name of a scene is no file.
    let output = folder.run(&format!("{tear} hang -o hang"));
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
}

#[test]
fn a_folder_that_is_made_for_frames_takes_the_other_files_too() {
    let folder = Folder::new();
    let line = "tearmesh tear flag.obj --scene hang --seconds 0.1 --frames g -o g/x.obj";
    let output = folder.run(&format!("{line} --report g/r.json"));
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    assert!(folder.path("g/x.obj").exists() && folder.path("g/r.json").exists());
}

/// A report of a simulation says its steps, so one without was written before the first.
#[test]
fn a_place_that_cannot_be_written_is_found_before_the_first_step() {
    let folder = Folder::new();
    let line = "tearmesh tear flag.obj --scene hang --seconds 0.1 --format json";
    for (options, message) in [
        ("-o no/x.obj", "`no/x.obj`: there is no folder `no`"),
        ("-o tests", "`tests`: it is a directory"),
        ("--report no/r.json", "`no/r.json`: there is no folder `no`"),
        ("--dry-run --report tests", "`tests`: it is a directory"),
    ] {
        let output = folder.run(&format!("{line} {options}"));
        assert_eq!(output.status.code(), Some(7), "{}", seen(&output));
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert!(
            report["steps"].is_null(),
            "{options}: {} steps",
            report["steps"]
        );
        let said = report["diagnostics"].as_array().expect("a list");
        assert_eq!(said.len(), 1, "{said:?}");
        assert_eq!(said[0]["code"], "E-IO-WRITE");
        assert_eq!(said[0]["message"], format!("cannot write {message}"));
    }
}

#[test]
fn a_chart_that_cannot_be_written_is_not_begun() {
    let folder = Folder::new();
    for options in [
        "-o no/x.svg",
        "-o x.svg --csv no/x.csv",
        "-o x.svg --json no/x.json",
    ] {
        let mut command = folder.command();
        command.args(["chart", "tear"]).args(options.split(' '));
        let child = command.stderr(std::process::Stdio::piped()).spawn();
        let mut child = child.expect("a run");
        let begun = Instant::now();
        while child.try_wait().expect("a status").is_none() {
            if begun.elapsed() > Duration::from_secs(8) {
                child.kill().expect("it is still there");
                child.wait().expect("an end");
                panic!("chart tear {options} has begun");
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        let output = child.wait_with_output().expect("an end");
        let said = seen(&output);
        assert!(said.contains("there is no folder `no`"), "{said}");
        assert_eq!(output.status.code(), Some(7));
    }
    assert!(!folder.path("x.svg").exists());
}

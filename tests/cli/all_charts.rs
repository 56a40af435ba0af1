//! `chart all`: every chart into one folder, and the commands that make them.

use crate::harness::{Folder, seen};

const NAMES: [&str; 8] = [
    "stability",
    "cut",
    "fig7",
    "choice",
    "pareto",
    "plane",
    "space",
    "tear",
];

#[test]
fn all_charts_are_made_into_one_folder() {
    let folder = Folder::new();
    let output = folder.run("tearmesh chart all --small -o a/charts");
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("8 charts in a/charts, in "), "{said}");
    let times = folder.read("a/charts/pareto-time.svg");
    assert!(times.contains("CPU time of the one run"));
    for name in NAMES {
        assert!(
            folder
                .read(&format!("a/charts/{name}.svg"))
                .starts_with("<svg "),
            "{name}"
        );
        assert!(
            folder.read(&format!("a/charts/{name}.csv")).lines().count() > 1,
            "{name}"
        );
        let report = folder.read(&format!("a/charts/{name}.json"));
        let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
        let command = report["provenance"]["command"].as_str().expect("a command");
        assert!(
            command.starts_with(&format!("tearmesh chart {name} ")),
            "{command}"
        );
    }
}

/// A plan is made of commands that can be typed as they stand, and makes nothing itself but folders.
#[test]
fn a_plan_prints_the_commands_of_all_charts_and_they_are_gathered() {
    let folder = Folder::new();
    let output = folder.run("tearmesh chart all --small --plan -o charts");
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    let plan = String::from_utf8(output.stdout).expect("text");
    let begins = plan
        .lines()
        .map(|line| line.split(' ').nth(2).expect("a name"));
    let mut names = begins.collect::<Vec<_>>();
    names.dedup();
    // The longest first, for those who share them.
    names.reverse();
    assert_eq!(names, NAMES);
    // All but the cuts.
    for line in plan.lines().filter(|line| !line.contains("chart cut")) {
        let made = folder.run(line);
        assert_eq!(made.status.code(), Some(0), "{line}\n{}", seen(&made));
    }
    let gathered = folder.run("tearmesh chart all --small --gather -o charts");
    let said = seen(&gathered);
    assert!(
        said.contains("charts/cut.json is missing") && said.contains("; not cut"),
        "{said}"
    );
    assert_eq!(gathered.status.code(), Some(5), "{said}");
    for name in NAMES.iter().filter(|name| **name != "cut") {
        assert!(
            folder.path(&format!("charts/{name}.csv")).exists(),
            "{name}"
        );
    }
}

#[test]
fn a_folder_that_cannot_be_made_is_said() {
    let folder = Folder::new();
    folder.write("taken", "a file");
    let said = seen(&folder.run("tearmesh chart all --small -o taken/charts"));
    assert!(
        said.contains("E-IO-WRITE") && said.ends_with("(exit 7)\n"),
        "{said}"
    );
}

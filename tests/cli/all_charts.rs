//! `chart all`: every chart into one folder, and the commands that make them.

use crate::harness::{Folder, seen};

const NAMES: [&str; 6] = ["stability", "cut", "fig7", "choice", "tear", "pareto"];

#[test]
fn all_charts_are_made_into_one_folder() {
    let folder = Folder::new();
    let output = folder.run("tearmesh chart all --small -o a/charts");
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("6 charts in a/charts, in "), "{said}");
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

/// A plan is made of commands that can be typed as they stand, and makes nothing itself.
#[test]
fn a_plan_prints_a_command_for_each_chart() {
    let folder = Folder::new();
    let output = folder.run("tearmesh chart all --small --plan -o charts");
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    let plan = String::from_utf8(output.stdout).expect("text");
    assert!(!folder.path("charts").exists());
    let begins = plan
        .lines()
        .map(|line| line.split(' ').nth(2).expect("a name"));
    assert_eq!(begins.collect::<Vec<_>>(), NAMES);
    std::fs::create_dir(folder.path("charts")).expect("a folder");
    let cut = plan.lines().nth(1).expect("a line");
    let made = folder.run(cut);
    assert_eq!(made.status.code(), Some(0), "{}", seen(&made));
    assert!(folder.path("charts/cut.json").exists());
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

//! Replay of the seeds of the command's fuzz target, and of its finds.

use std::fs;

use tearmesh_cli::Exit;

use crate::harness::{Folder, root};
use crate::in_process::{Case, PATHS};
use crate::inputs::inputs;

/// How runs end, and the seeds that do.
const SEEDS: [(Exit, &str); 5] = [
    (
        Exit::Done,
        "mesh json dry_run one_eye twice allow_miss help",
    ),
    (Exit::NothingCut, "missed missed_json"),
    (Exit::Usage, "one_ray wants_both unknown"),
    (Exit::Input, "comma three_faces"),
    (Exit::NoPlane, "one_line"),
];

#[test]
fn seeds_end_as_they_should() {
    let seeds = root().join("fuzz/corpus/cut_cli");
    let mut listed = 0;
    for (exit, names) in SEEDS {
        for name in names.split(' ') {
            let case = Case::from_bytes(&fs::read(seeds.join(name)).expect("a seed"));
            assert_eq!(case.check(), exit, "{name}: {case:?}");
            listed += 1;
        }
    }
    assert_eq!(
        inputs("corpus", "cut_cli").len(),
        listed,
        "every seed is listed"
    );
}

#[test]
fn finds_of_fuzzing_are_replayed() {
    for bytes in inputs("regressions", "cut_cli") {
        Case::from_bytes(&bytes).check();
    }
}

/// So that fuzzing never opens a file: an option with a value is on one of two lists.
#[test]
fn every_option_that_names_a_file_is_known() {
    let others = "--rays --camera --up --fov --viewport --points --plane --layers --gap --snap --method --tips --mass --format --color";
    let help = Folder::new().done("cut --help");
    let mut names = Vec::new();
    for line in help.lines().map(str::trim) {
        let is_option = line.starts_with('-') && line.contains(" <");
        if let Some((name, _)) = line.split_once(" <").filter(|_| is_option) {
            names.extend(name.split(", ").map(str::to_owned));
        }
    }
    assert!(names.len() >= 8, "{names:?} in {help}");
    for name in names {
        let known = PATHS.contains(&&*name) || others.split(' ').any(|other| other == name);
        assert!(known, "`{name}`: add it to PATHS if it takes a path");
    }
}

//! What fuzzing the command found, and the seeds it started from, replayed.

use std::fs;

use tearmesh_cli::Exit;

use crate::harness::{Folder, root};
use crate::in_process::{Case, PATHS};
use crate::inputs::inputs;

/// The seeds, and how each ends.
const SEEDS: [(&str, Exit); 15] = [
    ("mesh", Exit::Done),
    ("json", Exit::Done),
    ("dry_run", Exit::Done),
    ("one_eye", Exit::Done),
    ("twice", Exit::Done),
    ("allow_miss", Exit::Done),
    ("help", Exit::Done),
    ("missed", Exit::NothingCut),
    ("missed_json", Exit::NothingCut),
    ("one_ray", Exit::Usage),
    ("wants_both", Exit::Usage),
    ("unknown", Exit::Usage),
    ("comma", Exit::Input),
    ("three_faces", Exit::Input),
    ("one_line", Exit::NoPlane),
];

#[test]
fn seeds_end_as_they_should() {
    let seeds = root().join("fuzz/seeds/cut_cli");
    for (name, exit) in SEEDS {
        let case = Case::from_bytes(&fs::read(seeds.join(name)).expect("a seed"));
        assert_eq!(case.check(), exit, "{name}: {case:?}");
    }
    let files = fs::read_dir(seeds).expect("a folder of seeds");
    assert_eq!(files.count(), SEEDS.len(), "every seed is listed");
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

//! What fuzzing the command found, and the seeds it started from, replayed.

use std::fs;

use tearmesh_cli::Exit;

use crate::harness::{Folder, root, seen};
use crate::in_process::{Case, PATHS};

#[test]
fn seeds_and_regressions_end_as_they_should() {
    let mut ends = Vec::new();
    for folder in ["seeds/cut_cli", "regressions/cut_cli"] {
        let Ok(entries) = fs::read_dir(root().join("fuzz").join(folder)) else {
            continue; // Nothing was found so far.
        };
        for entry in entries {
            let path = entry.expect("an entry").path();
            println!("{}", path.display());
            ends.push(Case::from_bytes(&fs::read(path).expect("an input")).check());
        }
    }
    for exit in [
        Exit::Done,
        Exit::NothingCut,
        Exit::Usage,
        Exit::Input,
        Exit::NoPlane,
    ] {
        assert!(ends.contains(&exit), "{exit:?} is not in {ends:?}");
    }
}

/// So that fuzzing never opens a file: an option with a value is on one of two lists.
#[test]
fn every_option_that_names_a_file_is_known() {
    let others = [
        "--rays", "--method", "--tips", "--mass", "--format", "--color",
    ];
    let help = seen(&Folder::new().run("tearmesh cut --help"));
    let mut names = Vec::new();
    for line in help.lines().map(str::trim) {
        let is_option = line.starts_with('-') && line.contains(" <");
        if let Some((name, _)) = line.split_once(" <").filter(|_| is_option) {
            names.extend(name.split(", ").map(str::to_owned));
        }
    }
    assert!(names.len() >= 8, "{names:?} in {help}");
    for name in names {
        let known = PATHS.contains(&&*name) || others.contains(&&*name);
        assert!(known, "`{name}`: add it to PATHS if it takes a path");
    }
}

//! Answers, as rows of texts: what is typed, how it ends, and parts of what is seen.
//!
//! A row begins with the exit status. Below it, indented, stand parts of what is seen, and after `!` what
//! is not. A file stands between `@ name` and `@`, and is written when the row below it is run. What does
//! not end with 0 leaves every file as it was, and no other. Behind `=` stand files that have the same bytes, and
//! behind `#` files of which no two have.

use std::collections::BTreeSet;
use std::fs;

use crate::digest;
use crate::harness::{Folder, root};

/// The files of a line that compares them, and whether they are to be the same.
fn compared(line: &str) -> Option<(bool, &str)> {
    let same = line.strip_prefix("= ").map(|names| (true, names));
    same.or(line.strip_prefix("# ").map(|names| (false, names)))
}

/// A folder in which all rows of a text were run.
fn judged(name: &str) -> Folder {
    let text = fs::read_to_string(root().join("tests/cli/answers").join(name)).expect("answers");
    let folder = Folder::new();
    let mut lines = text.lines().peekable();
    let mut rows = 0;
    while let Some(line) = lines.next() {
        if let Some(file) = line.strip_prefix("@ ") {
            folder.add_file(file, &mut lines);
        } else if let Some((is_same, names)) = compared(line) {
            let files: Vec<_> = names.split(' ').map(|name| folder.bytes(name)).collect();
            let kinds = files.iter().collect::<BTreeSet<_>>().len();
            assert_eq!(kinds, if is_same { 1 } else { files.len() }, "{line}");
        } else if line.starts_with(|c: char| c.is_ascii_digit()) {
            let (exit, typed) = line.split_once(' ').expect("an exit status");
            let before = (exit != "0").then(|| folder.digest(digest::EMPTY));
            let seen = folder.ends(typed, exit.parse().expect("a number"));
            while let Some(part) = lines.next_if(|line| line.starts_with("  ")) {
                let absent = part.strip_prefix("  ! ");
                let part = absent.unwrap_or(&part[2..]);
                assert_eq!(
                    seen.contains(part),
                    absent.is_none(),
                    "{typed}\n{part}\n{seen}"
                );
            }
            let is_same = before.is_none_or(|before| folder.digest(digest::EMPTY) == before);
            assert!(is_same, "{typed}: files are new or other ones\n{seen}");
            rows += 1;
        }
    }
    println!("{name}: {rows} answers");
    assert!(rows > 15, "{rows}");
    folder
}

#[test]
fn charts() {
    judged("charts.txt");
}

#[test]
fn cuts() {
    judged("cut.txt");
}

#[test]
fn files() {
    let folder = judged("files.txt");
    assert!(!folder.path("x.html").exists() && !folder.path("x.png").exists());
    assert!(folder.read("dry.csv") == folder.read("wet.csv"));
}

#[test]
fn scenes() {
    judged("scenes.txt");
}

#[test]
fn tears() {
    let folder = judged("tear.txt");
    assert_eq!(["few", "all"].map(|name| folder.list(name).len()), [11, 31]);
}

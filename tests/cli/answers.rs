//! Answers, as rows of texts: what is typed, how it ends, and parts of what is seen.
//!
//! A row begins with the exit status. Below it, indented, stand parts of what is seen, and after `!` what
//! is not; `{FILE: path}` in a part stands for what a report has there. A file stands between `@ name` and `@`,
//! and is written when the row below it is run. What does not end with 0 leaves every file as it was, and no
//! other. Behind `=` stand files that have the same bytes, behind `#` files of which no two have, behind `[` a folder
//! with all that is in it (`-` where there is none), and behind `.` a report and what holds of it.

use std::collections::BTreeSet;
use std::fs;

use serde_json::Value;

use crate::digest;
use crate::harness::{Folder, root};

/// The files of a line that compares them, and whether they are to be the same.
fn compared(line: &str) -> Option<(bool, &str)> {
    let same = line.strip_prefix("= ").map(|names| (true, names));
    same.or(line.strip_prefix("# ").map(|names| (false, names)))
}

/// The value at a path such as `cuts.0.pieces`, or `quantities.name=torn_m.verdict` in a list.
fn at<'v>(mut value: &'v Value, path: &str) -> &'v Value {
    for key in path.split('.') {
        value = match (value, key.split_once('=')) {
            (Value::Array(all), Some((name, wanted))) => {
                let found = all.iter().find(|one| one[name] == wanted);
                found.unwrap_or(&Value::Null)
            }
            (Value::Array(_), None) => &value[key.parse::<usize>().expect("an index")],
            _ => &value[key],
        }
    }
    value
}

/// The value of sums and products such as `kinetic - began + 3 * wind`.
fn number(report: &Value, text: &str) -> f64 {
    let factor = |word: &str| word.parse().ok().or(at(report, word).as_f64());
    let factor = |word: &str| factor(word).unwrap_or_else(|| panic!("{word} is no number"));
    let product = |term: &str| term.split(" * ").map(factor).product::<f64>();
    let difference = |part: &str| {
        let mut terms = part.split(" - ").map(product);
        let first = terms.next().expect("a term");
        terms.fold(first, |sum, term| sum - term)
    };
    text.split(" + ").map(difference).sum()
}

/// Whether what a row says of a report is so: two sums with `<` between them, or a value as it is written
/// behind ` = `.
fn holds(report: &Value, said: &str) -> bool {
    if let Some((path, text)) = said.split_once(" = ") {
        return at(report, path).to_string().trim_matches('"') == text;
    }
    let (less, more) = said.split_once(" < ").expect("a comparison");
    number(report, less) < number(report, more)
}

/// A part of an answer with the values of reports in their places.
fn filled(part: &str, folder: &Folder) -> String {
    let mut filled = String::new();
    for (i, text) in part.split(['{', '}']).enumerate() {
        match text.split_once(": ") {
            Some((file, path)) if i % 2 == 1 => filled += &at(&folder.json(file), path).to_string(),
            _ => filled += text,
        }
    }
    filled
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
        } else if let Some((name, files)) = line.strip_prefix("[ ").and_then(|l| l.split_once(": "))
        {
            match files {
                "-" => assert!(!folder.path(name).exists(), "{line}"),
                files => assert_eq!(folder.list(name).join(" "), files),
            }
        } else if let Some((file, said)) = line.strip_prefix(". ").and_then(|l| l.split_once(": "))
        {
            assert!(
                holds(&folder.json(file), said),
                "{line}\n{}",
                folder.read(file)
            );
        } else if line.starts_with(|c: char| c.is_ascii_digit()) {
            let (exit, typed) = line.split_once(' ').expect("an exit status");
            let before = (exit != "0").then(|| folder.digest(digest::EMPTY));
            let seen = folder.ends(typed, exit.parse().expect("a number"));
            while let Some(part) = lines.next_if(|line| line.starts_with("  ")) {
                let absent = part.strip_prefix("  ! ");
                let part = filled(absent.unwrap_or(&part[2..]), &folder);
                assert_eq!(
                    seen.contains(&part),
                    absent.is_none(),
                    "{typed}\n{part}\n{seen}"
                );
            }
            let is_same = before.is_none_or(|before| folder.digest(digest::EMPTY) == before);
            assert!(is_same, "{typed}: files are new or other ones\n{seen}");
            rows += 1;
        }
    }
    assert!(rows > 10, "{rows}");
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
    // A page grants nothing to a module that it has not.
    let [played, viewed] = ["played", "page"].map(|name| folder.read(&format!("{name}.html")));
    let granted = [&played, &viewed].map(|page| page.contains("'wasm-unsafe-eval'"));
    assert!(granted == [true, false] && viewed.len() < 100_000);
}

#[test]
fn pieces() {
    judged("pieces.txt");
}

#[test]
fn reports() {
    judged("reports.txt");
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

//! Transcripts: what is typed, and what is answered, to the letter.
//!
//! A line that begins with `$ ` is typed; the lines behind it, up to the next one or an
//! empty line, are the answer: standard error, then standard output, then `(exit N)` unless N
//! is 0. The files that commands leave behind stay for the commands after them.
//! `TEARMESH_BLESS=1` writes the answers anew; read the difference before you keep it.
//!
//! What a cloth does once it tears is chaotic: each change to a solver gives other digits, which tell a
//! reader nothing. There `…` stands for a number, or alone for lines, and one digest a file is kept of
//! all that it stands for.

use std::fs;
use std::path::Path;

use crate::digest;
use crate::harness::{Folder, files_in, root};

/// Of the lines in which `…` stands for numbers, as the commands answer them, by file.
const CHAOTIC: [(&str, u64); 2] = [
    ("README.md", 0xde26_c2a1_232a_4bd4),
    ("tear.txt", 0xb8a1_1248_0aec_992e),
];

/// Of all files that the transcripts' commands leave behind: meshes, reports, frames, charts. A
/// commit that changes it says which bytes moved, and why.
const DIGEST: u64 = 0xbfbc_8afa_3e74_69e8;

#[test]
fn transcripts_are_answered_to_the_letter() {
    let mut commands = 0;
    let mut digest = digest::EMPTY;
    for path in files_in(&root().join("tests/cli/transcripts")) {
        let folder = Folder::new();
        folder.add_files("tests/cli/inputs.txt");
        commands += play(&path, &folder, true);
        digest = folder.digest(digest);
    }
    assert!(commands >= 30);
    assert_eq!(digest, DIGEST, "{digest:#018x}");
}

#[test]
fn the_commands_of_the_readme_answer_as_it_says() {
    let folder = Folder::new();
    folder.add_files("tests/cli/inputs.txt");
    assert!(play(&root().join("README.md"), &folder, false) >= 5);
    for picture in ["cut.png", "strip.png"] {
        let shown = root().join("tests/data").join(picture);
        let made = folder.path(picture);
        if std::env::var_os("TEARMESH_BLESS").is_some() {
            fs::copy(&made, &shown).expect("a blessed picture");
        }
        let [made, shown] = [made, shown].map(|path| fs::read(path).expect("a picture"));
        assert!(made == shown, "the README's {picture} looks otherwise");
    }
}

#[test]
fn the_commands_of_the_guide_answer_as_it_says() {
    let mut commands = 0;
    for page in ["cut", "batches", "blender", "codes", "report", "scenes"] {
        let path = root().join(format!("tools/cli/src/guide/{page}.md"));
        commands += play(&path, &Folder::new(), false);
    }
    assert!(commands >= 9);
}

/// Plays the commands of a file, and counts them. In Markdown only `console` blocks count.
fn play(path: &Path, folder: &Folder, plain: bool) -> usize {
    let name = path.file_name().expect("a name").display().to_string();
    let text = fs::read_to_string(path).expect("a transcript");
    let mut lines = text.lines().peekable();
    let mut played = String::new();
    let mut in_block = plain;
    let mut commands = 0;
    let mut chaotic = digest::EMPTY;
    while let Some(line) = lines.next() {
        played.push_str(line);
        played.push('\n');
        if !plain && line.starts_with("```") {
            in_block = line == "```console";
        }
        let Some(typed) = line.strip_prefix("$ ").filter(|_| in_block) else {
            continue;
        };
        if let Some(names) = typed.strip_prefix("cmp ") {
            let files: Vec<_> = names.split(' ').map(|name| folder.read(name)).collect();
            assert!(files[0] == files[1], "{names} differ, in {name}");
            continue;
        }
        if !typed.starts_with("tearmesh ") && !typed.starts_with("cargo run ") {
            continue; // A command of the shell, which is not ours to test.
        }
        let is_answer = |line: &str| !line.is_empty() && !line.starts_with("$ ") && line != "```";
        let expected: Vec<&str> =
            std::iter::from_fn(|| lines.next_if(|line| is_answer(line))).collect();
        let answer = folder.run(typed).seen();
        for line in as_expected(&expected, &answer, &mut chaotic) {
            played.push_str(line);
            played.push('\n');
        }
        commands += 1;
    }
    if std::env::var_os("TEARMESH_BLESS").is_some() {
        fs::write(path, &played).expect("a blessed transcript");
    }
    assert!(
        played == text,
        "{name} reads otherwise; the answers are now:\n{played}"
    );
    let known = CHAOTIC.iter().find(|(file, _)| *file == name);
    let known = known.map_or(digest::EMPTY, |(_, digest)| *digest);
    assert_eq!(chaotic, known, "{name}: {chaotic:#018x}");
    commands
}

/// What an answer is written down as: with `…` where it stands in what is expected.
fn as_expected<'a>(expected: &[&'a str], answer: &'a str, chaotic: &mut u64) -> Vec<&'a str> {
    let mut written = Vec::new();
    let mut expected = expected.iter().copied().peekable();
    // An empty line would end the answer.
    let answer = answer.lines().map(str::trim_end);
    for line in answer.map(|line| if line.is_empty() { "." } else { line }) {
        let is = |expected: &str| expected == line || stands_for(expected, line);
        if expected.peek() == Some(&LINES) {
            if !expected.clone().nth(1).is_some_and(is) {
                *chaotic = digest::after(*chaotic, line.bytes());
                continue;
            }
            written.extend(expected.next());
        }
        let masked = expected.next().filter(|masked| stands_for(masked, line));
        if masked.is_some() {
            *chaotic = digest::after(*chaotic, line.bytes());
        }
        written.push(masked.unwrap_or(line));
    }
    written.extend(expected.next_if_eq(&LINES));
    written
}

/// Stands for all lines up to the one behind it.
const LINES: &str = "…";

/// Whether a line with `…` in it is this one but for the numbers that stand in their places.
fn stands_for(masked: &str, line: &str) -> bool {
    let mut parts = masked.split('…');
    let mut rest = parts.next().and_then(|part| line.strip_prefix(part));
    for part in parts {
        rest = rest.and_then(|rest| {
            let after = rest.trim_start_matches(|c: char| c.is_ascii_digit() || "-.e".contains(c));
            let is_number = after.len() < rest.len();
            after.strip_prefix(part).filter(|_| is_number)
        });
    }
    masked.contains('…') && rest == Some("")
}

#[test]
fn a_mask_stands_for_numbers_alone() {
    for (masked, line, is) in [
        ("… m torn", "8.4088 m torn", true),
        ("… J, … J", "-1.5e-5 J, 0 J", true),
        ("at …", "at 7", true),
        ("at …", "at ", false),
        ("at …", "at once", false),
        ("… m", "8 km", false),
        ("8 m", "8 m", false),
    ] {
        assert_eq!(stands_for(masked, line), is, "{masked} {line}");
    }
    let expected = ["…", "… m torn", "…"];
    for (answer, is) in [
        ("note\n\n3 m torn\n1 J\n2 J\n", &expected[..]),
        ("3 m torn\n", &expected),
        ("3 m torn\n4 m torn\n", &expected),
        ("3 km torn\n", &expected[..1]),
    ] {
        assert_eq!(as_expected(&expected, answer, &mut 0), is, "{answer}");
    }
}

//! Refusals: code, place, length, and words; most are in `files.txt`.

use tearmesh_obj::{Document, Level, ReadError};

use super::read;

/// Three vertices, so that a face can be right.
const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// Reads and gives the diagnostic in one line: `CODE line:column+length message | label | help`.
pub(crate) fn refusal(bytes: &[u8]) -> String {
    let error = Document::read(bytes).err();
    let Some(ReadError::Refused(diagnostic)) = error else {
        panic!("not refused: {}", String::from_utf8_lossy(bytes));
    };
    assert_eq!(diagnostic.level, Level::Error);
    let place = diagnostic.location.expect("every refusal has a place");
    let (length, label) = match &diagnostic.excerpt {
        Some(excerpt) => {
            let end = place.column + excerpt.length - excerpt.first_column;
            let shown = excerpt.text.chars().count();
            assert!(
                end <= shown.max(place.column - excerpt.first_column + 1),
                "{diagnostic:?}"
            );
            (excerpt.length, &excerpt.label[..])
        }
        None => (0, ""),
    };
    let help = diagnostic.help.as_deref().unwrap_or("");
    let (line, column) = (place.line, place.column);
    format!(
        "{} {line}:{column}+{length} {} | {label} | {help}",
        diagnostic.code, diagnostic.message
    )
}

/// The refusal of these bytes begins as expected.
fn check(bytes: &[u8], expected: &str) {
    let refusal = refusal(bytes);
    let shown = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
    assert!(
        refusal.starts_with(expected),
        "{shown:?}\n  is  {refusal}\n  not {expected}"
    );
}

fn with_vertices(rest: &[u8]) -> Vec<u8> {
    [VERTICES.as_bytes(), rest].concat()
}

#[test]
fn the_place_of_a_forward_reference_outlives_its_text() {
    // So many long lines that their texts are not all kept.
    let padding = " ".repeat(150);
    let mut file = String::new();
    for i in 3..20_000 {
        file += &format!("f {} {} {i}{padding}\n", i - 2, i - 1);
    }
    file += &"v 0 0 0\n".repeat(15_000);
    let refused = refusal(file.as_bytes());
    let expected =
        "E-OBJ-RANGE 14999:15+0 vertex 15001 does not exist: the file has 15000 vertices";
    assert!(refused.starts_with(expected), "{refused}");
}

#[test]
fn twenty_megabytes_on_one_line() {
    let million = |start: &str| start.to_owned() + &" 1".repeat(10 << 20);
    let too_many = "E-OBJ-COUNT 1:35+1 a vertex has at most 16 numbers | one too many";
    check(million("v").as_bytes(), too_many);
    // One corner too many, and far too many.
    for count in [4097, 2_500_000] {
        let corners: String = (1..=count).map(|i| format!(" {i}")).collect();
        check(
            &with_vertices(format!("f{corners}").as_bytes()),
            "E-OBJ-ARITY 4:19376+4 this face has more than 4096 corners",
        );
    }
    check(
        million("v 0 0 0 v").as_bytes(),
        "E-OBJ-FLOAT 1:9+1 cannot read number `v`",
    );
}

#[test]
fn a_line_without_end() {
    let mut file = with_vertices(b"# ");
    file.resize(70 << 20, b'x');
    check(&file, "E-OBJ-LINE 4:1+1 this line is longer than 64 MiB");
}

#[test]
fn a_message_holds_nothing_that_a_terminal_would_obey() {
    let error = Document::read(&b"v 0 x 0 \x1b[31m \xc2\x9b"[..]).expect_err("no number");
    let excerpt = error
        .diagnostic()
        .and_then(|diagnostic| diagnostic.excerpt.clone());
    assert_eq!(
        excerpt.map(|excerpt| excerpt.text),
        Some("v 0 x 0 \u{fffd}[31m \u{fffd}".to_owned())
    );
}

#[test]
fn a_long_line_is_shown_in_a_window() {
    let file = format!(
        "v{}0,5 {}",
        " 1".repeat(10).as_str().to_owned() + &" ".repeat(5000),
        "x".repeat(5000)
    );
    let error = Document::read(file.as_bytes()).expect_err("a comma");
    let diagnostic = error.diagnostic().expect("refused");
    let place = diagnostic.location.expect("placed");
    let excerpt = diagnostic.excerpt.as_ref().expect("has text");
    assert_eq!(place.column, 5022);
    assert_eq!(excerpt.text.chars().count(), 160);
    let at = place.column - excerpt.first_column;
    assert_eq!(&excerpt.text[at..at + excerpt.length], "0,5");
    assert_eq!(
        error.to_string(),
        "line 1, column 5022: cannot read number `0,5`"
    );
}

#[test]
fn an_input_that_fails_is_no_fault_of_the_file() {
    struct Broken;
    impl std::io::Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::Error::other("the disk is gone"))
        }
    }
    let error = Document::read(std::io::BufReader::new(Broken)).expect_err("broken");
    assert!(matches!(error, ReadError::Input(_)));
    assert_eq!(error.to_string(), "cannot read: the disk is gone");
}

#[test]
fn all_defects_are_in_the_value_and_twenty_in_the_message() {
    let mut file = String::new();
    for i in 0..30 {
        file += &"v 0 0 0\n".repeat(3);
        let face = format!("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3);
        file += &face.repeat(2);
    }
    let document = read(file.as_bytes());
    let error = document.mesh().expect_err("duplicates");
    assert_eq!((error.error().count(), error.shown().len()), (30, 20));
    let message = error.to_string();
    assert_eq!(message.lines().count(), 21);
    assert!(message.ends_with("and 10 more"), "{message}");
    let last = error.error().defects().last().expect("thirty");
    let last = document.describe(last);
    assert_eq!(
        last.to_string(),
        "line 150: 2 faces have the same vertices 88, 89, 90 (lines 149, 150)"
    );
}

//! Every refusal: code, place, length, and words.

use tearmesh_obj::{Document, Level, ReadError};

/// Three vertices, so that a face can be right.
const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// Reads and gives the diagnostic in one line: `CODE line:column+length message | label | help`.
fn refusal(bytes: &[u8]) -> String {
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

/// Each case: the bytes, and how the refusal begins.
fn check(cases: &[(&[u8], &str)]) {
    for (bytes, expected) in cases {
        let refusal = refusal(bytes);
        let shown = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
        assert!(
            refusal.starts_with(expected),
            "{shown:?}\n  is  {refusal}\n  not {expected}"
        );
    }
}

fn with_vertices(rest: &str) -> Vec<u8> {
    format!("{VERTICES}{rest}").into_bytes()
}

/// Cases that follow [`VERTICES`], so that their first line is 4.
fn check_after_vertices(cases: &[(&str, &str)]) {
    for (rest, expected) in cases {
        check(&[(&with_vertices(rest), expected)]);
    }
}

#[test]
fn numbers_that_cannot_be_read() {
    check(&[
        (
            b"# a\n\nv 1 0,5 0\n",
            "E-OBJ-FLOAT 3:5+3 cannot read number `0,5` | expected a finite decimal number such as \
             `0.5` | OBJ uses `.` as the decimal mark; re-export with the C locale",
        ),
        (
            b"v 1 -12,25 0",
            "E-OBJ-FLOAT 1:5+6 cannot read number `-12,25` | expected a finite decimal number such \
             as `-12.25` |",
        ),
        (b"v 1 0x10 0", "E-OBJ-FLOAT 1:5+4 cannot read number `0x10`"),
        (b"v 1 . 0", "E-OBJ-FLOAT 1:5+1 cannot read number `.`"),
        (b"v 1 - 0", "E-OBJ-FLOAT 1:5+1 cannot read number `-`"),
        (b"v 1 1e 0", "E-OBJ-FLOAT 1:5+2 cannot read number `1e`"),
        (b"v 1 1e+ 0", "E-OBJ-FLOAT 1:5+3 cannot read number `1e+`"),
        (
            b"v 1 3.1+e2 0",
            "E-OBJ-FLOAT 1:5+6 cannot read number `3.1+e2`",
        ),
        (
            b"v 1 1.2.3 0",
            "E-OBJ-FLOAT 1:5+5 cannot read number `1.2.3`",
        ),
        (b"v 1 --1 0", "E-OBJ-FLOAT 1:5+3 cannot read number `--1`"),
        (
            b"v 1 1_000 0",
            "E-OBJ-FLOAT 1:5+5 cannot read number `1_000`",
        ),
        (b"v\ta b c", "E-OBJ-FLOAT 1:3+1 cannot read number `a`"),
        (b"vt 0 abc", "E-OBJ-FLOAT 1:6+3 cannot read number `abc`"),
        (b"vn 0 0 x", "E-OBJ-FLOAT 1:8+1 cannot read number `x`"),
        (b"v 0 0 0 red", "E-OBJ-FLOAT 1:9+3 cannot read number `red`"),
        (
            b"v 1 \\\n  2 q\n",
            "E-OBJ-FLOAT 2:5+1 cannot read number `q`",
        ),
        (
            b"v 1 \\ \r\n\\\r  2 q\n",
            "E-OBJ-FLOAT 3:5+1 cannot read number `q`",
        ),
        (
            b"v 0 \xff\xc3\xa9 1",
            "E-OBJ-FLOAT 1:5+2 cannot read number `\u{fffd}\u{e9}`",
        ),
        (b"#\r#\r\nv 0 z 1", "E-OBJ-FLOAT 3:5+1"),
        (b"\xef\xbb\xbfv 0 z 1", "E-OBJ-FLOAT 1:5+1"),
        (b"v 1\\2 0 0", "E-OBJ-FLOAT 1:3+3 cannot read number `1\\2`"),
    ]);
}

#[test]
fn numbers_that_are_not_finite_or_too_large() {
    check(&[
        (
            b"v 0 nan 0",
            "E-OBJ-FINITE 1:5+3 `nan` is not a finite number | expected a finite number",
        ),
        (b"v 0 -NaN 0", "E-OBJ-FINITE 1:5+4 `-NaN` is"),
        (b"v inf 0 0", "E-OBJ-FINITE 1:3+3 `inf` is"),
        (b"v +Infinity 0 0", "E-OBJ-FINITE 1:3+9 `+Infinity` is"),
        (b"v 0 0 -1.#IND", "E-OBJ-FINITE 1:7+7 `-1.#IND` is"),
        (b"v 1.#QNAN00 0 0", "E-OBJ-FINITE 1:3+9 `1.#QNAN00` is"),
        (b"v 1.#INF 0 0", "E-OBJ-FINITE 1:3+6 `1.#INF` is"),
        (
            b"v 1e999 0 0",
            "E-OBJ-FINITE 1:3+5 `1e999` is beyond the range of 64-bit numbers",
        ),
        (
            b"v 1e99999999999 0 0",
            "E-OBJ-FINITE 1:3+13 `1e99999999999` is beyond",
        ),
        (b"vt nan 0", "E-OBJ-FINITE 1:4+3"),
        (b"vn 0 inf 0", "E-OBJ-FINITE 1:6+3"),
        (b"v 0 0 0 nan", "E-OBJ-FINITE 1:9+3"),
        (
            b"v 0 -1e76 0",
            "E-OBJ-COORDINATE 1:5+5 the coordinate `-1e76` is too large | expected at most 1.8",
        ),
    ]);
}

#[test]
fn wrong_counts_of_numbers() {
    let many = format!("v {}", "1 ".repeat(17));
    check(&[
        (
            b"v",
            "E-OBJ-COUNT 1:2+1 a vertex needs 3 numbers, this one has 0 | expected another number",
        ),
        (
            b"v 1",
            "E-OBJ-COUNT 1:4+1 a vertex needs 3 numbers, this one has 1",
        ),
        (
            b"v 1 2  # 3",
            "E-OBJ-COUNT 1:6+1 a vertex needs 3 numbers, this one has 2",
        ),
        (
            b"v 1 \\\n2\\\n",
            "E-OBJ-COUNT 2:2+1 a vertex needs 3 numbers, this one has 2",
        ),
        (
            many.as_bytes(),
            "E-OBJ-COUNT 1:35+1 a vertex has at most 16 numbers | one too many",
        ),
        (
            b"vt",
            "E-OBJ-COUNT 1:3+1 a texture coordinate needs 1 number, this one has 0",
        ),
        (
            b"vt 1 2 3 44",
            "E-OBJ-COUNT 1:10+2 a texture coordinate has at most 3 numbers",
        ),
        (
            b"vn 1 2",
            "E-OBJ-COUNT 1:7+1 a normal needs 3 numbers, this one has 2",
        ),
        (
            b"vn 1 2 3 4",
            "E-OBJ-COUNT 1:10+1 a normal has at most 3 numbers",
        ),
    ]);
}

#[test]
fn indices_that_cannot_be_read() {
    let label = "expected `v`, `v/vt`, `v//vn` or `v/vt/vn`";
    check_after_vertices(&[
        (
            "f 1 2 3.0",
            "E-OBJ-INDEX 4:7+3 an index is a whole number, not `3.0`",
        ),
        (
            "f 1 2 3/1.5",
            "E-OBJ-INDEX 4:7+5 an index is a whole number, not `3/1.5`",
        ),
        (
            "f 1 2 1/2/3/4",
            "E-OBJ-INDEX 4:7+7 the corner `1/2/3/4` has 4 indices, not up to 3",
        ),
        (
            "f 1 2 1///",
            "E-OBJ-INDEX 4:7+4 the corner `1///` has 4 indices",
        ),
        (
            "f 1 2 /3",
            "E-OBJ-INDEX 4:7+2 the corner `/3` has no vertex",
        ),
        (
            "f 1 2 //3",
            "E-OBJ-INDEX 4:7+3 the corner `//3` has no vertex",
        ),
        (
            "f 1 2 x",
            &format!("E-OBJ-INDEX 4:7+1 cannot read the corner `x` | {label}"),
        ),
        ("f 1 2 3x", "E-OBJ-INDEX 4:7+2 cannot read the corner `3x`"),
        ("f 1 2 9x", "E-OBJ-INDEX 4:7+2 cannot read the corner `9x`"),
        ("f 1 2 -", "E-OBJ-INDEX 4:7+1 cannot read the corner `-`"),
        ("f 1, 2, 3", "E-OBJ-INDEX 4:3+2 cannot read the corner `1,`"),
        (
            "f 1 / 2 3",
            "E-OBJ-INDEX 4:5+1 the corner `/` has no vertex",
        ),
    ]);
}

#[test]
fn indices_out_of_range() {
    check_after_vertices(&[
        (
            "f 0 1 2",
            "E-OBJ-ZERO 4:3+1 vertex 0 does not exist: OBJ counts from 1",
        ),
        ("f -0 1 2", "E-OBJ-ZERO 4:3+2 vertex 0"),
        (
            "vt 0\nf 1/1 2/0 3/1",
            "E-OBJ-ZERO 5:9+1 texture coordinate 0 does",
        ),
        (
            "vn 0 0 1\nf 1//1 2//0 3//1",
            "E-OBJ-ZERO 5:11+1 normal 0 does",
        ),
        (
            "f 1 2 3\nf 1 2 9\n",
            "E-OBJ-RANGE 5:7+1 vertex 9 does not exist: the file has 3 vertices | expected 1 to 3 | \
             indices count from 1 through the whole file",
        ),
        (
            "f 1 2 -4",
            "E-OBJ-RANGE 4:7+2 vertex -4 does not exist: there are 3 before this line | expected -3 to -1",
        ),
        (
            "f 1/1 2/1 3/1",
            "E-OBJ-RANGE 4:5+1 texture coordinate 1 does not exist: the file has no texture coordinates | expected no index here",
        ),
        (
            "vn 0 0 1\nf 1//1 2//1 3//22",
            "E-OBJ-RANGE 5:16+2 normal 22 does not exist: the file has 1 normal |",
        ),
        (
            "f 1/-1 2 3",
            "E-OBJ-RANGE 4:5+2 texture coordinate -1 does not exist: there are none before",
        ),
        (
            "f 1 2 2147483649",
            "E-OBJ-RANGE 4:7+10 vertex index beyond the limit of 2147483648",
        ),
        (
            "f 1 2 99999999999999999999999",
            "E-OBJ-RANGE 4:7+23 vertex index beyond",
        ),
        (
            "f 1 2 -99999999999999999999999",
            "E-OBJ-RANGE 4:7+24 vertex -9",
        ),
        (
            "f 1 2 2147483648",
            "E-OBJ-RANGE 4:7+10 vertex 2147483648 does not exist: the file has 3",
        ),
    ]);
    check(&[(
        b"f -4 -3 -2",
        "E-OBJ-RANGE 1:3+2 vertex -4 does not exist: there are none before this line",
    )]);
}

#[test]
fn the_first_of_several_forward_references_is_named() {
    // Lines 1 and 2 are right in the end, line 3 is the first that is not, line 4 worse.
    check(&[(
        b"f 1 2 4\nf 3 2 1\nf 1 2 5\nf 1 2 99\nv 0 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 1\n",
        "E-OBJ-RANGE 3:7+1 vertex 5 does not exist: the file has 4 vertices",
    )]);
    // Of two kinds of elements, the earlier place.
    check_after_vertices(&[
        (
            "f 1 2 3//2\nf 1 2 4\nvn 0 0 1",
            "E-OBJ-RANGE 4:10+1 normal 2 does",
        ),
        (
            "f 1 2 4\nf 1 2 3//2\nvn 0 0 1",
            "E-OBJ-RANGE 4:7+1 vertex 4 does",
        ),
    ]);
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
fn faces_of_a_wrong_shape() {
    let corners: String = (0..4097).map(|i| format!(" {}", i + 1)).collect();
    check_after_vertices(&[
        (
            "f",
            "E-OBJ-CORNERS 4:2+1 a face needs 3 corners, this one has none | expected another vertex",
        ),
        (
            "f 1",
            "E-OBJ-CORNERS 4:4+1 a face needs 3 corners, this one has 1",
        ),
        (
            "f 1 2 # 3",
            "E-OBJ-CORNERS 4:6+1 a face needs 3 corners, this one has 2 | expected another vertex | a line is",
        ),
        (
            "fo 1 2",
            "E-OBJ-CORNERS 4:7+1 a face needs 3 corners, this one has 2",
        ),
        (
            "f 1 1 2",
            "E-OBJ-REPEAT 4:5+1 this face has vertex 1 twice | already its corner 1 | a triangle with",
        ),
        (
            "f 1 2 -3",
            "E-OBJ-REPEAT 4:7+2 this face has vertex 1 twice",
        ),
        (
            "v 1 1 1\nf 1 2 3 1",
            "E-OBJ-REPEAT 5:9+1 this face has vertex 1 twice | already its corner 1 | a face closes by itself",
        ),
        (
            "v 1 1 1\nv 2 2 2\nf 1/ 2/ 3/ 4/ 5/ 3/",
            "E-OBJ-REPEAT 6:18+2 this face has vertex 3 twice | already its corner 3 | if this is a face with a hole",
        ),
        (
            &format!("f{corners}"),
            "E-OBJ-ARITY 4:19376+4 this face has more than 4096 corners",
        ),
    ]);
}

#[test]
fn files_that_are_no_obj_files() {
    let solid = b"solid a\nfacet normal 0 0 1\nendsolid a\n";
    let utf16: Vec<u8> = "v 0 0 0\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let utf16_marked: Vec<u8> = "\u{feff}v 0 0 0\n"
        .encode_utf16()
        .flat_map(u16::to_be_bytes)
        .collect();
    let mut binary_stl = vec![b' '; 80];
    binary_stl[..3].copy_from_slice(b"abc");
    binary_stl.extend([12, 0, 0, 0]);
    check(&[
        (
            b"",
            "E-OBJ-EMPTY 1:1+0 this file has no face |  | a cut needs faces",
        ),
        (b"\n\n", "E-OBJ-EMPTY 2:1+0 this file has no face"),
        (b"# nothing", "E-OBJ-EMPTY 1:1+0 this file has no face"),
        (
            b"v 0 0 0\nv 1 1 1\nl 1 2\n",
            "E-OBJ-EMPTY 3:1+0 this file has no face, only 2 vertices",
        ),
        (
            b"v 0 0 0\np 1",
            "E-OBJ-EMPTY 2:1+0 this file has no face, only 1 vertex",
        ),
        (
            solid,
            "E-OBJ-EMPTY 3:1+0 this file has no face |  | this looks like an STL file",
        ),
        (
            b"ply\nformat ascii 1.0\n",
            "E-OBJ-EMPTY 2:1+0 this file has no face |  | this looks like a PLY",
        ),
        (
            b"newmtl a\n",
            "E-OBJ-EMPTY 1:1+0 this file has no face |  | this is a material library",
        ),
        (
            &utf16,
            "E-OBJ-UTF16 1:1+1 this is a UTF-16 file | expected UTF-8 or ASCII | save it as UTF-8",
        ),
        (&utf16_marked, "E-OBJ-UTF16 1:1+1 this is a UTF-16 file"),
        (b"\xff\xfe", "E-OBJ-UTF16 1:1+1"),
        (
            b"glTF\x02\0\0\0",
            "E-OBJ-BINARY 1:1+1 this is binary data, not an OBJ file",
        ),
        (&binary_stl, "E-OBJ-BINARY 1:82+1 this is binary data"),
        (
            b"# comment\n# a\0b\n",
            "E-OBJ-BINARY 2:4+1 this is binary data",
        ),
        (
            b"v 0 0 0 # a\0b\n",
            "E-OBJ-BINARY 1:12+1 this is binary data",
        ),
        (
            b"v 0 \0 0\n",
            "E-OBJ-BINARY 1:5+1 this is binary data, not an OBJ file (byte 0x00)",
        ),
        (
            b"v 0 0 0\n\x1b\x01x 4",
            "E-OBJ-BINARY 2:1+1 this is binary data, not an OBJ file (byte 0x1b)",
        ),
    ]);
}

#[test]
fn twenty_megabytes_on_one_line() {
    let million = |start: &str| start.to_owned() + &" 1".repeat(10 << 20);
    let numbers: String = (1..2_500_000).map(|i| format!(" {i}")).collect();
    check(&[
        (
            million("v").as_bytes(),
            "E-OBJ-COUNT 1:35+1 a vertex has at most 16 numbers",
        ),
        (
            &with_vertices(&format!("f{numbers}")),
            "E-OBJ-ARITY 4:19376+4 this face has more than 4096",
        ),
        (
            million("v 0 0 0 v").as_bytes(),
            "E-OBJ-FLOAT 1:9+1 cannot read number `v`",
        ),
    ]);
}

#[test]
fn a_line_without_end() {
    let mut file = with_vertices("# ");
    file.resize(70 << 20, b'x');
    check(&[(&file, "E-OBJ-LINE 4:1+1 this line is longer than 64 MiB")]);
}

#[test]
fn relative_indices_of_lines_and_curves_that_count_back_too_far() {
    check_after_vertices(&[
        (
            "l 1 -4",
            "E-OBJ-RANGE 4:5+2 vertex -4 does not exist: there are 3 before this line",
        ),
        ("curv 0 -9 1 -4", "E-OBJ-RANGE 4:13+2 vertex -4 does"),
    ]);
}

#[test]
fn a_message_holds_nothing_that_a_terminal_would_obey() {
    check(&[(
        b"v 0 \x1b[31m 0",
        "E-OBJ-FLOAT 1:5+5 cannot read number `\u{fffd}[31m`",
    )]);
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
    let error = Document::read(Broken).expect_err("broken");
    assert!(matches!(error, ReadError::Input(_)));
    assert_eq!(error.to_string(), "cannot read: the disk is gone");
}

//! What a lenient reader of layout accepts, and what is kept of it.

use tearmesh_obj::{Corner, Document, Level};

use super::{read, rewritten, text};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn codes(document: &Document) -> Vec<&'static str> {
    document
        .diagnostics()
        .iter()
        .map(|diagnostic| diagnostic.code)
        .collect()
}

/// Each file is read as the plain triangle, and written as the text beside it.
fn check(cases: &[(&[u8], &str)]) {
    for (bytes, expected) in cases {
        let document = read(bytes);
        assert_eq!(document.triangles(), [[0, 1, 2]], "{}", text(bytes));
        assert_eq!(text(&rewritten(bytes)), *expected, "{}", text(bytes));
    }
}

#[test]
fn line_ends_blanks_and_continuations() {
    let again = |separator: &str| TRIANGLE.replace('\n', separator).into_bytes();
    check(&[
        (&again("\n"), TRIANGLE),
        (&again("\r\n"), TRIANGLE),
        (&again("\r"), TRIANGLE),
        (TRIANGLE.trim_end().as_bytes(), TRIANGLE),
        (&again(" \t \n"), TRIANGLE),
        (b"\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", TRIANGLE),
        (
            b"v\t0  0\x0b0\n  v 1 0 0\n\tv 0 1 0\nf   1\t2 3   ",
            TRIANGLE,
        ),
        (
            b"v 0 \\\n0 0\nv 1 0\\\r\n 0\nv 0 1 0\nf 1 2 \\  \n3",
            TRIANGLE,
        ),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 \\\n", TRIANGLE),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\\", TRIANGLE),
        (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\\\n3", TRIANGLE),
        (
            b"\n\n v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n \n",
            &format!("\n\n{TRIANGLE} \n"),
        ),
    ]);
}

#[test]
fn forms_of_numbers() {
    let document = read(b"v +1 1. .5\nv 1e-5 1E5 -0\nv 1e+2 +2.e1 -.5e0\nf 1 2 3\n");
    let numbers: Vec<f64> = document
        .positions()
        .iter()
        .flat_map(|p| [p.x, p.y, p.z])
        .collect();
    assert_eq!(numbers, [1.0, 1.0, 0.5, 1e-5, 1e5, 0.0, 100.0, 20.0, -0.5]);
    assert!(numbers[5].is_sign_negative());
    // More digits than fit, in front, behind, and as zeros.
    let long = format!(
        "v {0}1{1} 0.{1}1 0.1{0}1\nv 0 0 1e-400\nv 0 1 0\nf 1 2 3",
        "0".repeat(400),
        "0".repeat(70)
    );
    let [p, q, _] = *read(long.as_bytes()).positions() else {
        panic!("three vertices")
    };
    assert_eq!([p.x, p.y, p.z, q.z], [1e70, 1e-71, 0.1, 0.0]);
}

#[test]
fn forms_of_corners() {
    let file = |face: &str| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0\nvt 1 1\nvn 0 0 1\n{face}\n");
    let corner = |vertex, texture, normal| Corner {
        vertex,
        texture,
        normal,
    };
    let none = [
        corner(0, None, None),
        corner(1, None, None),
        corner(2, None, None),
    ];
    for (face, expected, written) in [
        ("f 1 2 3", none, "f 1 2 3"),
        ("f 1/ 2/ 3/", none, "f 1 2 3"),
        ("f 1// 2// 3//", none, "f 1 2 3"),
        ("f -3 -2 -1", none, "f 1 2 3"),
        ("f +1 02 3", none, "f 1 2 3"),
        ("f 1 2 3#4", none, "f 1 2 3\n#4"),
        (
            "f 1/2/1 2//-1 3/-2",
            [
                corner(0, Some(1), Some(0)),
                corner(1, None, Some(0)),
                corner(2, Some(0), None),
            ],
            "f 1/2/1 2//1 3/1",
        ),
        (
            "f 1 2/1 3/",
            [
                corner(0, None, None),
                corner(1, Some(0), None),
                corner(2, None, None),
            ],
            "f 1 2/1 3",
        ),
    ] {
        let document = read(file(face).as_bytes());
        assert_eq!([0, 1, 2].map(|i| document.corner(0, i)), expected, "{face}");
        assert_eq!(
            text(&rewritten(file(face).as_bytes())),
            file(written),
            "{face}"
        );
    }
}

/// "References to fo in existing .obj files will still be read, however, they will be written out
/// as f when the file is saved": the specification of version 3.0, under `f`.
#[test]
fn face_outlines_are_faces() {
    let file = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0\nfo 1/1 2/1 3/1 # old\nf 3 2 4\n";
    let document = read(file.as_bytes());
    assert_eq!(document.triangles(), [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(codes(&document), [""; 0]);
    let expected = file.replace("fo ", "f ").replace(" # old", "\n# old");
    assert_eq!(text(&rewritten(file.as_bytes())), expected);
}

#[test]
fn numbers_beyond_the_coordinates_are_kept() {
    let file = "v 0 0 0 0.5\nv 1 0 0 1 0.25 0\nv 0 1 0\nv 1 1 1 1 2 3 4 5 6 7 8 9 10 11 12 13\n\
                vt 0.5\nvt 0 1\nvt 1 2 3\nf 1 2 3\n";
    let document = read(file.as_bytes());
    assert_eq!(document.extra_numbers(0), [0.5]);
    assert_eq!(document.extra_numbers(1), [1.0, 0.25, 0.0]);
    assert_eq!(document.extra_numbers(2), [0.0; 0]);
    assert_eq!(document.extra_numbers(3).len(), 13);
    assert_eq!(
        (document.texture_count(), document.texture(1)),
        (3, &[0.0, 1.0][..])
    );
    assert_eq!(text(&rewritten(file.as_bytes())), file);
    assert_eq!(codes(&document), [""; 0]);
}

#[test]
fn everything_else_is_kept_byte_for_byte() {
    let file = b"# caf\xe9 \xff\n\no two words\ng a b\ng\nmtllib a.mtl b.mtl\nusemtl my #1 mat \n\
        usemtl\ns on\ns 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nmg 1 0.5\n  # indented\nf 1 2 3\n\t\n";
    assert_eq!(text(&rewritten(file)), text(file));
    assert_eq!(codes(&read(file)), [""; 0]);
}

#[test]
fn names_that_are_no_utf_8_are_kept() {
    let file = b"o caf\xe9\ng \xff\xfe a#b\nmtllib stra\xdfe.mtl\nusemtl \x80 \xc3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(rewritten(file), file);
    assert_eq!(codes(&read(file)), [""; 0]);
}

#[test]
fn comments_behind_statements_become_lines() {
    let file = b"v 0 0 0 # tip\nv 1 0 0# b\r\nv 0 1 0\nf 1 2 3 # f\\\nf 3 2 1#";
    let document = read(&file[..file.len() - 8]);
    assert_eq!(document.triangles().len(), 1);
    let written = rewritten(&file[..file.len() - 9]);
    assert_eq!(
        text(&written),
        "v 0 0 0\n# tip\nv 1 0 0\n# b\nv 0 1 0\nf 1 2 3\n# f\\\n"
    );
}

#[test]
fn foreign_statements_are_kept_and_reported_once_a_keyword() {
    let file =
        "v 0 0 0\nnl 1\nv 1 0 0\nnl 2\nv 0 1 0\nvp 0.5\ncurv 0 1 \\\n1 2\nl 1 2\nf 1 2 3\nnl 3\n";
    let document = read(file.as_bytes());
    let said: Vec<String> = document
        .diagnostics()
        .iter()
        .map(|d| format!("{}[{}] {d}", d.level, d.code))
        .collect();
    assert_eq!(
        said,
        [
            "warning[W-OBJ-FOREIGN] line 2, column 1: `nl` is not interpreted, and is kept as it is, but for no copy of its vertex (3 statements, the first here)",
            "warning[W-OBJ-FOREIGN] line 6, column 1: `vp` is not interpreted, and is kept as it is (1 statement)",
            "warning[W-OBJ-FOREIGN] line 7, column 1: `curv` is not interpreted, and is kept as it is (1 statement)",
            "warning[W-OBJ-ELEMENT] line 9, column 1: `l` elements are kept, but never cut (1 statement)",
        ]
    );
    assert_eq!(text(&rewritten(file.as_bytes())), file);
}

#[test]
fn so_many_foreign_keywords_are_counted_together() {
    let mut file = TRIANGLE.to_owned();
    for i in 0..50 {
        file += &format!("x{i}\n");
    }
    let document = read(file.as_bytes());
    assert_eq!(document.diagnostics().len(), 33);
    let last = document.diagnostics().last().expect("there are some");
    assert_eq!(
        last.to_string(),
        "and 18 more statements that are not interpreted"
    );
    assert_eq!(text(&rewritten(file.as_bytes())), file);
}

#[test]
fn relative_indices_of_lines_are_made_absolute() {
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    let end = "f 1 2 3\n";
    for (given, kept) in [
        ("l -3 -2", "l 1 2"),
        ("l 1/-1  -1/1 # -2", "l 1/1  3/1 # -2"),
        ("p -1 \\\n -2", "p 3 \\\n 2"),
        ("curv -1 -2.5 -1 2", "curv -1 -2.5 3 2"),
        ("surf -1 -1 -1 -1 -1/-1/1", "surf -1 -1 -1 -1 3/1/1"),
        ("l -1x 1", "l -1x 1"),
        ("con 1 -1", "con 1 -1"),
    ] {
        let written = rewritten(format!("{start}{given}\n{end}").as_bytes());
        assert_eq!(text(&written), format!("{start}{kept}\n{end}"));
    }
    let document = read(format!("{start}l -3 -2\nl -1 -2\n{end}").as_bytes());
    assert_eq!(codes(&document), ["W-OBJ-ELEMENT", "W-OBJ-RELATIVE"]);
    assert_eq!(
        document.diagnostics()[1].to_string(),
        "line 5, column 1: negative indices of `l` were made absolute (2 statements, the first here)"
    );
}

#[test]
fn a_byte_order_mark_is_dropped_and_noted() {
    let document = read(format!("\u{feff}{TRIANGLE}").as_bytes());
    let [note] = document.diagnostics() else {
        panic!("one note")
    };
    assert_eq!((note.level, note.code), (Level::Note, "W-OBJ-BOM"));
    assert_eq!(
        text(&rewritten(format!("\u{feff}\u{feff}{TRIANGLE}").as_bytes())),
        TRIANGLE
    );
}

#[test]
fn faces_may_come_before_their_vertices() {
    let file = "g first\nf 1/2 2/1/1 3/2\nvt 0\nv 0 0 0\nv 1 0 0\n# between\nv 0 1 0\nvt 1\n\
                vn 0 0 1\nvn 1 0 0\nv 2 2 2\n";
    let expected = "g first\nvt 0\nvt 1\nvn 0 0 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\n\
                    f 1/2 2/1/1 3/2\n# between\nvn 1 0 0\nv 2 2 2\n";
    assert_eq!(text(&rewritten(file.as_bytes())), expected);
}

#[test]
fn vertices_without_faces_are_kept() {
    let file = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\nv 8 8 8\n";
    assert_eq!(text(&rewritten(file.as_bytes())), file);
}

#[test]
fn polygons_are_cut_into_triangles_and_one_warning_says_so() {
    let file = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0\nvn 0 0 1\n\
                # two\nf 1//1 2/1/1 3 4\nf 2 5 6 3 # last\n";
    let document = read(file.as_bytes());
    assert_eq!(
        document.triangles(),
        [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]]
    );
    let [warning] = document.diagnostics() else {
        panic!("one warning")
    };
    assert_eq!(warning.code, "W-OBJ-QUAD");
    assert_eq!(
        warning.to_string(),
        "line 10: 2 faces with more than 3 corners are cut into 4 triangles (the first here)"
    );
    assert_eq!(
        (0..4).map(|t| document.polygon_of(t)).collect::<Vec<_>>(),
        [0, 0, 1, 1]
    );
    assert_eq!(
        (0..4)
            .map(|t| document.line_of_triangle(t))
            .collect::<Vec<_>>(),
        [10, 10, 11, 11]
    );
    assert_eq!(
        document
            .polygon(0)
            .map(|corner| corner.vertex)
            .collect::<Vec<_>>(),
        [0, 1, 2, 3]
    );
    let written = text(&rewritten(file.as_bytes()));
    assert!(
        written.ends_with("f 1//1 2/1/1 3\nf 1//1 3 4\nf 2 5 6\nf 2 6 3\n# last\n"),
        "{written}"
    );
}

#[test]
fn a_line_of_twenty_megabytes_is_read() {
    let file = format!("# {}\n{TRIANGLE}", "x".repeat(20 << 20));
    assert_eq!(rewritten(file.as_bytes()), file.as_bytes());
    let blanks = " ".repeat(20 << 20);
    let file = format!("v 0 0 0\nv 1 0 0\nv{blanks}0 1 0\nf 1 2{blanks}3");
    assert_eq!(text(&rewritten(file.as_bytes())), TRIANGLE);
}

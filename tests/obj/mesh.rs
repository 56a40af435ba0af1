//! What is wrong with a mesh, in the terms of its file.

use super::read;

const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nv 2 2 2\n";

fn check(faces: &str, expected: &[&str]) {
    let document = read(format!("{VERTICES}{faces}").as_bytes());
    let error = document.mesh().expect_err("not a manifold");
    assert_eq!(
        error.to_string().lines().collect::<Vec<_>>(),
        expected,
        "{faces}"
    );
    for diagnostic in error.shown() {
        assert!(diagnostic.help.is_some(), "{diagnostic}");
    }
}

#[test]
fn every_defect_names_vertices_from_one_and_lines() {
    check(
        "f 1 2 3\nf 2 1 4\n\nf 1 2 5\n",
        &["line 10: edge 1-2 has 3 faces (lines 7, 8, 10)  [E-MESH-EDGE]"],
    );
    check(
        "f 1 2 3\nf 1 2 4\n",
        &[
            "line 8: two faces run from vertex 1 to vertex 2 (lines 7, 8): one of them is flipped  [E-MESH-FLIP]",
        ],
    );
    check(
        "f 1 2 3\nf 1 4 5\n",
        &[
            "line 8: vertex 1 (line 1) joins 2 fans of faces that share no edge (line 7 | line 8)  [E-MESH-BOWTIE]",
        ],
    );
    check(
        "f 1 2 3\nf 2 3 1\n",
        &["line 8: 2 faces have the same vertices 1, 2, 3 (lines 7, 8)  [E-MESH-DUPLICATE]"],
    );
    check(
        "f 1 2 3\nf 3 2 1\n",
        &[
            "line 8: two faces lie back to back on the vertices 1, 2, 3 (lines 7, 8)  [E-MESH-PILLOW]",
        ],
    );
}

#[test]
fn triangles_of_one_polygon_name_their_line_once() {
    check(
        "f 1 2 3 4\nf 5 3 1\nf 6 1 3\n",
        &["line 9: edge 1-3 has 4 faces (lines 7, 8, 9)  [E-MESH-EDGE]"],
    );
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

//! What a lenient reader of layout accepts; most is in `files.txt`.

use tearmesh_obj::{Corner, Level};

use super::{read, rewritten, text};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn numbers_with_more_digits_than_fit_are_rounded() {
    let long = format!(
        "v {0}1{1} 0.{1}1 0.1{0}1\nv 0 0 -0\nv 0 1 0\nf 1 2 3",
        "0".repeat(400),
        "0".repeat(70)
    );
    let [p, q, _] = *read(long.as_bytes()).positions() else {
        panic!("three vertices")
    };
    assert_eq!([p.x, p.y, p.z, q.z], [1e70, 1e-71, 0.1, 0.0]);
    assert!(q.z.is_sign_negative());
}

#[test]
fn documents_tell_polygons_lines_and_corners() {
    let file = "\u{feff}v 0 0 0 0.5\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 1\nvn 0 0 1\n\
                # two\nf 1//1 2/1/1 3 4\nf 2 5 6 3 # last\n";
    let document = read(file.as_bytes());
    let triangles = [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]];
    assert_eq!(document.triangles(), triangles);
    assert_eq!([0, 1, 2, 3].map(|t| document.polygon_of(t)), [0, 0, 1, 1]);
    let lines = [0, 1, 2, 3].map(|t| document.line_of_triangle(t));
    assert_eq!(lines, [10, 10, 11, 11]);
    assert!(document.polygon(0).map(|corner| corner.vertex).eq(0..4));
    let corner = Corner {
        vertex: 1,
        texture: Some(0),
        normal: Some(0),
    };
    assert_eq!(document.corner(0, 1), corner);
    assert_eq!([0, 1].map(|v| document.extra_numbers(v)), [&[0.5][..], &[]]);
    let texture = (document.texture_count(), document.texture(0));
    assert_eq!(texture, (1, &[0.0, 1.0][..]));
    let levels = document.diagnostics().iter().map(|one| one.level);
    assert!(levels.eq([Level::Note, Level::Warning]));
}

#[test]
fn so_many_foreign_keywords_are_counted_together() {
    let file = (0..50).fold(TRIANGLE.to_owned(), |file, i| format!("{file}x{i}\n"));
    let document = read(file.as_bytes());
    assert_eq!(document.diagnostics().len(), 33);
    let last = document.diagnostics()[32].to_string();
    assert_eq!(last, "and 18 more statements that are not interpreted");
    assert_eq!(text(&rewritten(file.as_bytes())), file);
}

#[test]
fn a_line_of_twenty_megabytes_is_read() {
    let file = format!("# {}\n{TRIANGLE}", "x".repeat(20 << 20));
    assert_eq!(rewritten(file.as_bytes()), file.as_bytes());
    let blanks = " ".repeat(20 << 20);
    let file = format!("v 0 0 0\nv 1 0 0\nv{blanks}0 1 0\nf 1 2{blanks}3");
    assert_eq!(text(&rewritten(file.as_bytes())), TRIANGLE);
}

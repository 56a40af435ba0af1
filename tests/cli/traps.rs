//! What a first hour trips over: advice, refusals that say why, and one number for one thing.

use crate::harness::{Folder, seen};

/// Runs a command, which ends with this status, and gives what is said.
fn said(folder: &Folder, line: &str, exit: i32) -> String {
    let output = folder.run(line);
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(exit), "{line}\n{said}");
    said
}

/// The edges of the sheet lie on the plane x = 0, so that a cut there crosses no face.
#[test]
fn regression_advice_to_cut_through_counts_splits_where_edges_lie_on_the_plane() {
    let folder = Folder::new();
    let mut mesh = String::new();
    for y in 0..4 {
        mesh += &format!("v -1 {y} 0\nv 0 {y} 0\nv 1 {y} 0\n");
    }
    for y in 0..3 {
        for x in 1..3 {
            let [a, b] = [3 * y + x, 3 * y + x + 3];
            mesh += &format!("f {a} {} {}\nf {a} {} {b}\n", a + 1, b + 1, b + 1);
        }
    }
    folder.write("strip.obj", mesh);
    let line = "tearmesh cut strip.obj --rays 0,9,5:0,0,-1 0,5,5:0,0,-1 -o x.obj";
    let advice = said(&folder, line, 1);
    let through = said(&folder, &format!("{line} --through"), 0);
    assert!(
        through.contains("0 faces crossed, 4 vertices split"),
        "{through}"
    );
    assert!(
        advice.contains("along edges elsewhere: --through splits 4 vertices there"),
        "{advice}"
    );
}

#[test]
fn a_picture_is_png_and_a_page_is_html() {
    let folder = Folder::new();
    let cut = "tearmesh cut sheet.obj --plane 0.3,0,0:1,0,0 -o x.obj";
    for (line, name, format) in [
        ("tearmesh render sheet.obj -o a.jpg", "a.jpg", "PNG"),
        ("tearmesh render sheet.obj -o a.obj", "a.obj", "PNG"),
        (&format!("{cut} --picture a.svg"), "a.svg", "PNG"),
        ("tearmesh view sheet.obj -o x.txt", "x.txt", "HTML"),
        ("tearmesh view sheet.obj -o x.obj", "x.obj", "HTML"),
        (&format!("{cut} --view x.pdf"), "x.pdf", "HTML"),
        (
            "tearmesh cut sheet.obj --plane 0.3,0,0:1,0,0 -o x.stl",
            "x.stl",
            "OBJ",
        ),
    ] {
        let before = folder.names();
        let why = said(&folder, line, 2);
        let expected = format!("cannot write `{name}`: only {format} output is supported");
        assert!(why.contains(&expected), "{line}\n{why}");
        assert_eq!(folder.names(), before, "{line}");
    }
    for line in [
        "render sheet.obj -o A.PNG",
        "view sheet.obj -o page.htm",
        "view sheet.obj -o page",
    ] {
        said(&folder, &format!("tearmesh {line}"), 0);
    }
}

#[test]
fn a_dry_run_writes_the_forces_and_no_mesh() {
    let folder = Folder::new();
    let line = "tearmesh tear sheet.obj --scene hang --seconds 0.1 --forces f.csv";
    let words = said(&folder, &format!("{line} --dry-run -o x.obj"), 0);
    assert!(words.contains("dry run, no mesh written"), "{words}");
    assert!(!folder.path("x.obj").exists());
    let dry = folder.read("f.csv");
    said(&folder, &format!("{line} -o x.obj"), 0);
    assert_eq!(dry, folder.read("f.csv"));
}

#[test]
fn layers_of_a_plane_are_refused_with_the_reason() {
    let folder = Folder::new();
    let line = "tearmesh cut sheet.obj --plane 0.3,0,0:1,0,0 -o x.obj --layers";
    let why = said(&folder, &format!("{line} first"), 2);
    assert!(why.contains("no ray hits a layer first"), "{why}");
    said(&folder, &format!("{line} all"), 0);
}

/// A note that nothing has to be done about is for those who ask, and for the report.
#[test]
fn duplicates_of_vertices_are_noted_for_those_who_ask() {
    let folder = Folder::new();
    let line = "tearmesh tear sheet.obj --scene rip --seconds 0.8 -o x.obj --report r.json";
    let quiet = said(&folder, line, 0);
    let report = folder.read("r.json");
    let loud = said(&folder, &format!("{line} -v"), 0);
    assert!(loud.contains("note[W-OBJ-FANS]"), "{loud}");
    assert!(!quiet.contains("W-OBJ-FANS"), "{quiet}");
    assert!(report.contains("W-OBJ-FANS"), "{report}");
}

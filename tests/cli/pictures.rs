//! Pictures: by `render`, and those that other verbs leave beside a mesh.

use std::fs;

use crate::harness::{Folder, seen};

const CUT: &str = "tearmesh cut sheet.obj --rays 0.3,0.2,5:0,0,-1 0.7,0.8,5:0,0,-1";

/// The width and height that a PNG file says it has.
fn size(folder: &Folder, name: &str) -> [u32; 2] {
    let bytes = fs::read(folder.path(name)).expect("a picture");
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n", "{name}");
    [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes")))
}

#[test]
fn every_verb_that_changes_a_mesh_draws_it() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"hang\"\nseconds = 0.1\n");
    for (line, name) in [
        (format!("{CUT} -o torn.obj --picture cut.png"), "cut.png"),
        (
            "tearmesh mend torn.obj -o m.obj --picture mend.png".to_owned(),
            "mend.png",
        ),
        (
            "tearmesh tear sheet.obj --scene s.toml -o t.obj --picture tear.png".to_owned(),
            "tear.png",
        ),
    ] {
        let output = folder.run(&line);
        assert_eq!(output.status.code(), Some(0), "{line}\n{}", seen(&output));
        assert_eq!(size(&folder, name), [960, 720]);
    }
    // It is the picture that `render` draws of the mesh that was written.
    let output = folder.run("tearmesh render torn.obj -o again.png");
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    let [cut, again] =
        ["cut.png", "again.png"].map(|name| fs::read(folder.path(name)).expect("a file"));
    assert!(cut == again);
    let output = folder.run("tearmesh render torn.obj --size 64x32 -o -");
    fs::write(folder.path("streamed.png"), output.stdout).expect("a file");
    assert_eq!(size(&folder, "streamed.png"), [64, 32]);
    assert!(output.stderr.is_empty());
}

#[test]
fn a_picture_replaces_nothing_and_is_not_begun_where_it_cannot_be_written() {
    let folder = Folder::new();
    folder.write("r.txt", "0.3,0.2,5:0,0,-1 0.7,0.8,5:0,0,-1\n");
    let from_file = "tearmesh cut sheet.obj --rays-file r.txt -o x.obj";
    for (line, exit) in [
        (format!("{CUT} -o x.obj --picture sheet.obj"), 2),
        (format!("{CUT} -o x.obj --picture ./x.obj"), 2),
        (
            format!("{CUT} -o x.obj --report r.json --picture r.json"),
            2,
        ),
        (format!("{CUT} -o x.obj --seam s.png --picture s.png"), 2),
        (format!("{CUT} -o x.obj --picture -"), 2),
        (format!("{from_file} --picture r.txt"), 2),
        ("tearmesh render sheet.obj -o ./sheet.obj".to_owned(), 2),
        (format!("{CUT} -o x.obj --picture no/x.png"), 7),
        ("tearmesh render sheet.obj -o no/x.png".to_owned(), 7),
    ] {
        let before = folder.names();
        let output = folder.run(&line);
        assert_eq!(
            output.status.code(),
            Some(exit),
            "{line}\n{}",
            seen(&output)
        );
        assert_eq!(folder.names(), before, "{line}");
    }
    assert_eq!(folder.read("r.txt").lines().count(), 1);
    let output = folder.run(&format!("{CUT} --dry-run --picture x.png"));
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    assert!(!folder.path("x.png").exists());
}

#[test]
fn a_strip_shows_moments_of_a_scene_beside_each_other() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"rip\"\nseconds = 1\n");
    let strip = "tearmesh render sheet.obj --scene s.toml --strip 3 --size 80x60";
    for line in [
        format!("{strip} -o one.png"),
        format!("{strip} --seconds 1 -o other.png"),
        format!("{strip} --finer 2 --fringe -o fine.png"),
    ] {
        let output = folder.run(&line);
        assert_eq!(output.status.code(), Some(0), "{line}\n{}", seen(&output));
    }
    let read = |name| fs::read(folder.path(name)).expect("a file");
    assert_eq!(size(&folder, "one.png"), [240, 60]);
    assert!(read("one.png") == read("other.png"));
    assert!(read("one.png") != read("fine.png"));
    for wrong in [
        "--scene rip",
        "--strip 3",
        "--scene none --strip 3",
        "--scene rip --strip 0",
        "--crease 200",
        "--crease 40 --flat",
        "--finer 9",
    ] {
        let output = folder.run(&format!("tearmesh render sheet.obj {wrong} -o x.png"));
        assert_eq!(output.status.code(), Some(2), "{wrong}\n{}", seen(&output));
    }
    folder.write("bad.toml", "base = \"rip\"\nsolver.dt = 0.1\n");
    let line = "tearmesh render sheet.obj --scene bad.toml --strip 2 -o x.png";
    assert_ne!(folder.run(line).status.code(), Some(0));
    assert!(!folder.path("x.png").exists());
}

#[test]
fn a_picture_of_a_run_shows_the_moment_when_most_was_torn_or_that_was_asked_for() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"rip\"\nseconds = 1\n");
    let tear = "tearmesh tear sheet.obj --scene s.toml";
    for (options, picture) in [
        ("", "most.png"),
        (" --picture-at 0", "first.png"),
        (" --picture-at 1", "last.png"),
    ] {
        let output = folder.run(&format!("{tear} -o t.obj --picture {picture}{options}"));
        assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    }
    let output = folder.run("tearmesh render t.obj -o again.png");
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    let read = |name| fs::read(folder.path(name)).expect("a file");
    assert!(read("last.png") == read("again.png"));
    assert!(read("most.png") != read("last.png") && read("first.png") != read("most.png"));
}

#[test]
fn a_file_whose_normals_differ_at_a_vertex_has_creases() {
    let folder = Folder::new();
    let faces = "f 1//1 2//1 3//1\nf 1//2 3//2 4//2\n";
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\n";
    folder.write("sharp.obj", format!("{corners}vn 0 0 1\nvn 0 1 0\n{faces}"));
    folder.write(
        "smooth.obj",
        format!("{corners}vn 0 0 1\nvn 0 0 1\n{faces}"),
    );
    for line in [
        "tearmesh render sharp.obj -o sharp.png",
        "tearmesh render sharp.obj --crease 40 -o crease.png",
        "tearmesh render smooth.obj -o smooth.png",
        "tearmesh render smooth.obj --flat -o flat.png",
    ] {
        let output = folder.run(line);
        assert_eq!(output.status.code(), Some(0), "{line}\n{}", seen(&output));
    }
    let read = |name| fs::read(folder.path(name)).expect("a file");
    assert!(read("sharp.png") == read("crease.png"));
    assert!(read("sharp.png") != read("smooth.png") && read("smooth.png") != read("flat.png"));
}

//! Pictures: by `render`, and those that other verbs leave beside a mesh.

use crate::harness::Folder;

/// The width and height that a PNG says it has.
fn size(bytes: &[u8]) -> [u32; 2] {
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes")))
}

#[test]
fn every_verb_that_changes_a_mesh_draws_it() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"hang\"\nseconds = 0.1\n");
    for line in [
        "cut sheet.obj --rays 0.3,0.2,5:0,0,-1 0.7,0.8,5:0,0,-1 -o torn.obj --picture cut.png",
        "mend torn.obj -o m.obj --picture mend.png",
        "tear sheet.obj --scene s.toml -o t.obj --picture tear.png",
        "cut flag.obj --plane 0.31,0,0:1,0.2,0 -o woven.obj --picture woven.png",
        "tear flag.obj --scene s.toml -o f.obj --picture flag.png --picture-at 0.1",
        "mend woven.obj -o m.obj --picture mended.png",
        // It is the picture that `render` draws of the mesh that was written, with the weave of its texture.
        "render torn.obj -o again.png",
        "render woven.obj -o cut-again.png",
        "render f.obj -o flag-again.png",
        "render m.obj -o mended-again.png",
    ] {
        folder.done(line);
    }
    for name in ["cut.png", "mend.png", "tear.png"] {
        assert_eq!(size(&folder.bytes(name)), [960, 720]);
    }
    for [one, other] in [
        ["cut.png", "again.png"],
        ["woven.png", "cut-again.png"],
        ["flag.png", "flag-again.png"],
        ["mended.png", "mended-again.png"],
    ] {
        assert!(folder.bytes(one) == folder.bytes(other), "{one}");
    }
    let streamed = folder.run("render torn.obj --size 64x32 -o -");
    assert_eq!(size(&streamed.output), [64, 32]);
    assert!(streamed.error.is_empty());
}

#[test]
fn a_strip_shows_moments_of_a_scene_beside_each_other() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"rip\"\nseconds = 1\n");
    for options in [
        "-o one.png",
        "--seconds 1 -o other.png",
        "--finer 2 --fringe -o fine.png",
    ] {
        let strip = "render sheet.obj --scene s.toml --strip 3 --size 80x60";
        folder.done(&format!("{strip} {options}"));
    }
    let [one, other, fine] = ["one.png", "other.png", "fine.png"].map(|name| folder.bytes(name));
    assert_eq!(size(&one), [240, 60]);
    assert!(one == other && one != fine);
}

#[test]
fn a_picture_of_a_run_shows_the_moment_when_most_was_torn_or_that_was_asked_for() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"rip\"\nseconds = 1\n");
    for options in [
        "most.png",
        "first.png --picture-at 0",
        "last.png --picture-at 1",
    ] {
        let tear = "tear sheet.obj --scene s.toml -o t.obj --picture";
        folder.done(&format!("{tear} {options}"));
    }
    folder.done("render t.obj -o again.png");
    let read = |name| folder.bytes(name);
    assert!(read("last.png") == read("again.png"));
    assert!(read("most.png") != read("last.png") && read("first.png") != read("most.png"));
}

#[test]
fn a_file_whose_normals_differ_at_a_vertex_has_creases() {
    let folder = Folder::new();
    let faces = "f 1//1 2//1 3//1\nf 1//2 3//2 4//2\n";
    for (name, normal) in [("sharp", "0 1 0"), ("smooth", "0 0 1")] {
        let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nvn 0 0 1\n";
        folder.write(
            &format!("{name}.obj"),
            format!("{corners}vn {normal}\n{faces}"),
        );
    }
    let drawn = |options: &str| {
        folder.done(&format!("render {options} -o x.png"));
        folder.bytes("x.png")
    };
    let [sharp, smooth] = [drawn("sharp.obj"), drawn("smooth.obj")];
    assert!(sharp == drawn("sharp.obj --crease 40"));
    assert!(sharp != smooth && smooth != drawn("smooth.obj --flat"));
}

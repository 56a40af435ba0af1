//! Pages that are played: what `play` writes, and what it refuses. (What is done on them is in `tests/browser`.)

use crate::harness::Folder;

#[test]
fn a_page_is_written_with_the_module_that_it_needs() {
    let folder = Folder::new();
    for (line, part) in [
        ("play", "play: a sheet of 1 m, scene rip · wrote play.html"),
        (
            "play flag.obj --scene flag --up -z",
            "1089 vertices, 2048 faces, scene flag",
        ),
    ] {
        let said = folder.done(line);
        assert!(said.contains(part), "{line}\n{said}");
    }
    assert!(folder.read("play.html").contains("'wasm-unsafe-eval'"));
    // `view` makes the same page, of a mesh that it is asked to play.
    folder.done("play flag.obj -o played.html");
    folder.done("view flag.obj --play -o viewed.html");
    assert!(folder.bytes("viewed.html") == folder.bytes("played.html"));
    let said = folder.ends("view flag.obj sheet.obj --play -o two.html", 2);
    assert!(said.contains("a page to play on has one mesh"), "{said}");
    // The page of `view` grants nothing to a module.
    folder.done("view flag.obj -o v.html");
    let page = folder.read("v.html");
    assert!(!page.contains("wasm-unsafe-eval") && page.len() < 100_000);
}

#[test]
fn a_mesh_that_is_too_large_is_refused_with_its_number() {
    let folder = Folder::new();
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("most.obj", [triangle, &"v 0 0 1\n".repeat(19_997)].concat());
    folder.write("many.obj", [triangle, &"v 0 0 1\n".repeat(19_998)].concat());
    folder.done("play most.obj -o most.html");
    let said = folder.ends("play many.obj -o many.html", 3);
    let refused = "the mesh has 20001 vertices, and a page plays with at most 20000";
    assert!(
        said.contains(&format!("E-PLAY-VERTICES]: {refused}")),
        "{said}"
    );
    assert!(!folder.path("many.html").exists());
    assert_eq!(tearmesh_play::VERTICES_MAX, 20_000);
}

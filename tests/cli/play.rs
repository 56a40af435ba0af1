//! Pages that are played: what `play` writes, and what it refuses. (What is done on them is in `tests/browser`.)

use std::fs;

use crate::harness::{Folder, seen};

#[test]
fn a_page_is_written_and_no_other_file_is_replaced() {
    let folder = Folder::new();
    for (line, exit, part) in [
        (
            "tearmesh play",
            0,
            "play: a sheet of 1 m, scene rip · wrote play.html",
        ),
        (
            "tearmesh play flag.obj --scene flag --up -z",
            0,
            "1089 vertices, 2048 faces, scene flag",
        ),
        ("tearmesh play flag.obj -o flag.obj", 2, ""),
        ("tearmesh play --scene waltz -o x.html", 2, "waltz"),
        ("tearmesh play no.obj -o x.html", 3, "E-IO-MISSING"),
    ] {
        let output = folder.run(line);
        let said = seen(&output);
        assert_eq!(output.status.code(), Some(exit), "{line}\n{said}");
        assert!(said.contains(part), "{line}\n{said}");
    }
    let page = fs::read_to_string(folder.path("play.html")).expect("a page");
    assert!(page.contains("'wasm-unsafe-eval'"));
    assert!(!folder.path("x.html").exists());
    folder.write("play.html", "mine");
    assert_eq!(folder.run("tearmesh play").status.code(), Some(2));
    // The page of `view` grants nothing to a module.
    assert_eq!(
        folder.run("tearmesh view flag.obj -o v.html").status.code(),
        Some(0)
    );
    let page = fs::read_to_string(folder.path("v.html")).expect("a page");
    assert!(!page.contains("wasm-unsafe-eval") && page.len() < 100_000);
}

#[test]
fn a_mesh_that_is_too_large_or_empty_is_refused_with_its_number() {
    let folder = Folder::new();
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("most.obj", [triangle, &"v 0 0 1\n".repeat(19_997)].concat());
    folder.write("many.obj", [triangle, &"v 0 0 1\n".repeat(19_998)].concat());
    folder.write("none.obj", "v 0 0 0\n");
    let most = folder.run("tearmesh play most.obj -o most.html");
    assert_eq!(most.status.code(), Some(0), "{}", seen(&most));
    for (name, part) in [
        (
            "many",
            "E-PLAY-VERTICES]: the mesh has 20001 vertices, and a page plays with at most 20000",
        ),
        ("none", "E-OBJ-EMPTY"),
    ] {
        let output = folder.run(&format!("tearmesh play {name}.obj -o {name}.html"));
        let said = seen(&output);
        assert_eq!(output.status.code(), Some(3), "{said}");
        assert!(said.contains(part), "{said}");
        assert!(!folder.path(&format!("{name}.html")).exists());
    }
    assert_eq!(tearmesh_play::VERTICES_MAX, 20_000);
}

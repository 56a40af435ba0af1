//! Pages that are played: how large their mesh may be. (What is done on them is in `tests/browser`.)

use crate::harness::Folder;

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

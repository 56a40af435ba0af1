//! Through cuts of real files, checked by a reader of OBJ that shares no code with ours.

use std::collections::HashMap;
use std::io::{Write as _, stderr};
use std::path::{Path, PathBuf};

use crate::harness::{Folder, root};
use crate::plain::{Plain, pieces};

/// The texture coordinate at each corner, with its bits.
fn textures(plain: &Plain) -> Vec<Option<Vec<u64>>> {
    let bits = |numbers: &Vec<f64>| numbers.iter().map(|x| x.to_bits()).collect();
    let corners = plain.face_textures.iter().flatten();
    let of = |index: &Option<usize>| index.map(|index| bits(&plain.texture[index]));
    corners.map(of).collect()
}

/// Fails unless faces keep count, order, corner positions and texture coordinates.
fn same_faces(before: &Plain, after: &Plain) {
    assert_eq!(before.faces.len(), after.faces.len());
    assert!(
        before
            .faces
            .iter()
            .chain(&after.faces)
            .all(|face| face.len() == 3)
    );
    assert!(before.corners().eq(after.corners()), "corners moved");
    assert!(
        textures(before) == textures(after),
        "other texture coordinates"
    );
}

/// Cuts a file straight, mends the cut, and takes out what it inserted: the faces are again those of
/// the file, corner by corner.
fn check_undone(folder: &Folder, input: &Path, rays: &str) {
    folder.done(&format!(
        "cut {} --rays {rays} -q -o torn.obj",
        input.display()
    ));
    folder.done("mend torn.obj --simplify -q -o whole.obj");
    let before = std::fs::read_to_string(input).expect("an input");
    let files = [before, folder.read("torn.obj"), folder.read("whole.obj")];
    let [before, torn, after] = files.map(|text| Plain::read(&text));
    assert!(torn.faces.len() > before.faces.len());
    assert_eq!(after.vertices.len(), before.vertices.len());
    same_faces(&before, &after);
    println!("{}: cut straight, mended, and as it was", input.display());
}

/// Cuts a file through and checks everything that the cut promises.
fn check(input: &Path, rays: &str, pieces_after: usize) {
    let folder = Folder::new();
    let line = format!("cut {} --rays {rays} --through", input.display());
    let report = folder.report(&format!("{line} --method partition -o torn.obj"));
    let before = Plain::read(&std::fs::read_to_string(input).expect("an input"));
    let after = Plain::read(&folder.read("torn.obj"));
    let cut = &report["cuts"][0];
    println!("{}: {cut}", input.display());
    same_faces(&before, &after);
    assert_eq!(before.texture, after.texture);

    // Vertices grew by exactly the reported splits.
    let grown = after.vertices.len() - before.vertices.len();
    assert_eq!(cut["splits"], grown);
    assert_eq!(before.vertices[..], after.vertices[..before.vertices.len()]);

    // The sides share no vertex: pieces joined by vertices are as many as those by edges, and no
    // piece has a face wholly before the plane and one wholly behind it.
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let triple = |name: &str| [0, 1, 2].map(|i| number(&cut["plane"][name][i]));
    let (point, normal) = (triple("point"), triple("normal"));
    let mut sides: HashMap<usize, [bool; 2]> = HashMap::new();
    for (face, piece) in after.faces.iter().zip(pieces(after.faces.iter().cloned())) {
        let distance = |&v: &usize| -> f64 {
            let place = after.at(v);
            (0..3).map(|i| (place[i] - point[i]) * normal[i]).sum()
        };
        let side = sides.entry(piece).or_default();
        side[0] |= face.iter().all(|v| distance(v) > 1e-9);
        side[1] |= face.iter().all(|v| distance(v) < -1e-9);
    }
    assert!(
        sides.values().all(|&side| side != [true, true]),
        "a piece is on both sides"
    );
    assert_eq!(sides.len(), pieces_after);
    assert_eq!(cut["pieces"], pieces_after);
    assert_eq!((&cut["crumbs"], &cut["lost"]), (&0.into(), &0.into()));
    assert_eq!(cut["separated"], true);

    // Mass, by the report and by the areas.
    assert_eq!(report["mass"]["before"], report["mass"]["after"]);
    let (area, mass) = (after.area(), number(&report["mass"]["after"]));
    assert!((area - mass).abs() <= 1e-12 * area, "{area} {mass}");
    assert_eq!(report["invariants"]["violations"], serde_json::json!([]));
    check_undone(&folder, input, rays);
}

#[test]
fn a_flag_a_sheet_and_a_sleeve_fall_in_two() {
    for (name, rays) in [
        ("flag", "0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1"),
        ("flag", "-2,0.3,5:0,0,-1 2,-0.4,5:0,0,-1"),
        ("sheet", "0.3,2,5:0,0,-1 0.7,-2,5:0,0,-1"),
        ("sheet", "-1,0.4,5:0,0,-1 2,0.61,5:0,0,-1"),
        ("sleeve", "-5,0.1,0.51:0,-1,0 5,0.2,0.53:0,-1,0"),
    ] {
        check(&root().join(format!("tests/data/{name}.obj")), rays, 2);
    }
}

#[test]
fn garments_of_the_corpus_fall_in_two() {
    let Some(corpus) = std::env::var_os("TEARMESH_CORPUS").map(PathBuf::from) else {
        // Past the test runner, which would keep it to itself.
        let said = writeln!(
            stderr(),
            "skipped: garments, since TEARMESH_CORPUS is not set"
        );
        said.expect("standard error is open");
        return;
    };
    for name in [
        "arcsim_tshirt",
        "arcsim_dress3",
        "assistive_hospitalgown",
        "snug_tshirt",
        "snug_tank",
    ] {
        let level = "-9,0.013,0.3:0,0,-1 9,0.013,0.3:0,0,-1";
        check(&corpus.join(name).with_extension("obj"), level, 2);
    }
}

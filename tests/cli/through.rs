//! Through cuts of real files, checked by a reader of OBJ that shares no code with ours.

use std::collections::HashMap;
use std::io::{Write as _, stderr};
use std::path::{Path, PathBuf};

use crate::harness::{Folder, root};

/// What a file says, read in the simplest way: every face a triangle, no frills.
struct Naive {
    vertices: Vec<[f64; 3]>,
    texture: Vec<String>,
    /// For each face its vertices and the texts of its texture coordinates.
    faces: Vec<[(usize, Option<String>); 3]>,
}

fn naive(text: &str) -> Naive {
    let mut read = Naive {
        vertices: Vec::new(),
        texture: Vec::new(),
        faces: Vec::new(),
    };
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let keyword = words.next();
        let words: Vec<&str> = words.collect();
        match keyword {
            Some("v") => {
                let number = |i: usize| words[i].parse::<f64>().expect("a number");
                read.vertices.push([number(0), number(1), number(2)]);
            }
            Some("vt") => {
                let numbers = words
                    .iter()
                    .map(|word| word.parse::<f64>().expect("a number"));
                read.texture
                    .push(format!("{:?}", numbers.collect::<Vec<_>>()));
            }
            Some("f") => {
                let corners: Vec<_> = words
                    .iter()
                    .map(|word| {
                        let mut indices = word.split('/').map(|i| i.parse::<usize>().ok());
                        let v = indices.next().flatten().expect("a vertex") - 1;
                        (
                            v,
                            indices
                                .next()
                                .flatten()
                                .map(|i| read.texture[i - 1].clone()),
                        )
                    })
                    .collect();
                read.faces.push(corners.try_into().expect("a triangle"));
            }
            _ => {}
        }
    }
    read
}

/// The number of sets of faces that are joined by shared vertices.
fn pieces(mesh: &Naive) -> Vec<usize> {
    let mut piece: Vec<usize> = (0..mesh.faces.len()).collect();
    loop {
        let mut least: HashMap<usize, usize> = HashMap::new();
        for (f, face) in mesh.faces.iter().enumerate() {
            for (v, _) in face {
                let least = least.entry(*v).or_insert(piece[f]);
                *least = piece[f].min(*least);
            }
        }
        let next: Vec<usize> = mesh
            .faces
            .iter()
            .map(|face| {
                face.iter()
                    .map(|(v, _)| least[v])
                    .min()
                    .expect("three vertices")
            })
            .collect();
        if next == piece {
            return piece;
        }
        piece = next;
    }
}

/// Cuts a file straight, mends the cut, and takes out what it inserted: the faces are again those of
/// the file, corner by corner.
fn check_undone(input: &Path, rays: [&str; 2]) {
    let folder = Folder::new();
    let run = |args: &[&str]| {
        let output = folder
            .command()
            .args(args)
            .output()
            .expect("the command runs");
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{error}");
    };
    let input_name = input.display().to_string();
    let [a, b] = rays;
    run(&["cut", &input_name, "--rays", a, b, "-q", "-o", "torn.obj"]);
    run(&["mend", "torn.obj", "--simplify", "-q", "-o", "whole.obj"]);
    let [before, torn, after] = [
        std::fs::read_to_string(input).expect("an input"),
        folder.read("torn.obj"),
        folder.read("whole.obj"),
    ]
    .map(|text| naive(&text));
    assert!(torn.faces.len() > before.faces.len());
    assert_eq!(after.faces.len(), before.faces.len());
    assert_eq!(after.vertices.len(), before.vertices.len());
    for (old, new) in before.faces.iter().zip(&after.faces) {
        for ((v, vt), (w, wt)) in old.iter().zip(new) {
            let bits = [before.vertices[*v], after.vertices[*w]].map(|p| p.map(f64::to_bits));
            assert_eq!((bits[0], vt), (bits[1], wt));
        }
    }
    println!("{}: cut straight, mended, and as it was", input.display());
}

/// Cuts a file through and checks everything that the cut promises.
fn check(input: &Path, rays: [&str; 2], pieces_after: usize) {
    let folder = Folder::new();
    let output = folder
        .command()
        .arg("cut")
        .arg(input)
        .args([
            "--rays",
            rays[0],
            rays[1],
            "--through",
            "--method",
            "partition",
            "--format",
            "json",
            "-o",
            "torn.obj",
        ])
        .output()
        .expect("the command runs");
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stdout)
    );
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let before = naive(&std::fs::read_to_string(input).expect("an input"));
    let after = naive(&folder.read("torn.obj"));
    let cut = &report["cuts"][0];
    let splits = cut["splits"].as_u64().expect("a number") as usize;
    println!(
        "{}: {} faces, {} pieces -> {}, {splits} splits, seam {:.3} of the slit, {:.2} edges away",
        input.file_name().expect("a name").display(),
        after.faces.len(),
        cut["pieces_before"],
        cut["pieces"],
        cut["seam_length_ratio"].as_f64().expect("a number"),
        cut["seam_deviation_max_edges"].as_f64().expect("a number"),
    );

    // Faces keep count, order, corner positions and texture coordinates.
    assert_eq!(before.faces.len(), after.faces.len());
    for (old, new) in before.faces.iter().zip(&after.faces) {
        for ((v, vt), (w, wt)) in old.iter().zip(new) {
            assert_eq!(
                before.vertices[*v].map(f64::to_bits),
                after.vertices[*w].map(f64::to_bits)
            );
            assert_eq!(vt, wt);
        }
    }
    assert_eq!(before.texture, after.texture);

    // Vertices grew by exactly the reported splits.
    assert_eq!(before.vertices.len() + splits, after.vertices.len());
    assert_eq!(before.vertices[..], after.vertices[..before.vertices.len()]);

    // The sides share no vertex: pieces joined by vertices are as many as those by edges, and no
    // piece has a face wholly before the plane and one wholly behind it.
    let piece = pieces(&after);
    let mut numbers = piece.clone();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), pieces_after);
    assert_eq!(cut["pieces"], pieces_after);
    assert_eq!((&cut["crumbs"], &cut["lost"]), (&0.into(), &0.into()));
    assert_eq!(cut["separated"], true);
    let triple = |value: &serde_json::Value| -> Vec<f64> {
        value
            .as_array()
            .expect("three")
            .iter()
            .map(|x| x.as_f64().expect("a number"))
            .collect()
    };
    let (point, normal) = (
        triple(&cut["plane"]["point"]),
        triple(&cut["plane"]["normal"]),
    );
    let mut sides: HashMap<usize, [bool; 2]> = HashMap::new();
    for (face, &piece) in after.faces.iter().zip(&piece) {
        let distance = |v: usize| -> f64 {
            (0..3)
                .map(|i| (after.vertices[v][i] - point[i]) * normal[i])
                .sum()
        };
        let side = sides.entry(piece).or_default();
        side[0] |= face.iter().all(|(v, _)| distance(*v) > 1e-9);
        side[1] |= face.iter().all(|(v, _)| distance(*v) < -1e-9);
    }
    assert!(
        sides.values().all(|&side| side != [true, true]),
        "a piece is on both sides"
    );

    // Mass, by the report and by the areas.
    assert_eq!(report["mass"]["before"], report["mass"]["after"]);
    let area: f64 = after
        .faces
        .iter()
        .map(|face| {
            let [a, b, c] = [0, 1, 2].map(|i| after.vertices[face[i].0]);
            let (u, v) = (
                [0, 1, 2].map(|i| b[i] - a[i]),
                [0, 1, 2].map(|i| c[i] - a[i]),
            );
            let n = [
                u[1] * v[2] - u[2] * v[1],
                u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0],
            ];
            n.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
        })
        .sum();
    let mass = report["mass"]["after"].as_f64().expect("a number");
    assert!((area - mass).abs() <= 1e-12 * area, "{area} {mass}");
    assert_eq!(report["invariants"]["violations"], serde_json::json!([]));
    check_undone(input, rays);
}

#[test]
fn a_flag_a_sheet_and_a_sleeve_fall_in_two() {
    let data = root().join("tests/data");
    check(
        &data.join("flag.obj"),
        ["0.31,2,5:0,0,-1", "0.25,-2,5:0,0,-1"],
        2,
    );
    check(
        &data.join("flag.obj"),
        ["-2,0.3,5:0,0,-1", "2,-0.4,5:0,0,-1"],
        2,
    );
    check(
        &data.join("sheet.obj"),
        ["0.3,2,5:0,0,-1", "0.7,-2,5:0,0,-1"],
        2,
    );
    check(
        &data.join("sheet.obj"),
        ["-1,0.4,5:0,0,-1", "2,0.61,5:0,0,-1"],
        2,
    );
    check(
        &data.join("sleeve.obj"),
        ["-5,0.1,0.51:0,-1,0", "5,0.2,0.53:0,-1,0"],
        2,
    );
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
    let level = ["-9,0.013,0.3:0,0,-1", "9,0.013,0.3:0,0,-1"];
    for (name, pieces) in [
        ("arcsim_tshirt", 2),
        ("arcsim_dress3", 2),
        ("assistive_hospitalgown", 2),
        ("snug_tshirt", 2),
        ("snug_tank", 2),
    ] {
        check(&corpus.join(name).with_extension("obj"), level, pieces);
    }
}

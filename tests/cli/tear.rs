//! Simulations: the table of forces, and the energy that is printed.

use std::collections::BTreeSet;
use std::fs;

use crate::harness::{Folder, root};
use crate::plain::Plain;
use crate::read_back::added_up;

/// A cloth that the wind lifts off a floor.
const LIFTED: &str = r#"
[wind]
velocity_m_per_s = [0, 8, 2]
[[collider]]
point = [0, -0.01, 0]
normal = [0, 1, 0]
"#;

/// A cloth that is let down: its hold takes what gravity gives.
const LOWERED: &str = r#"
base = "fall"
seconds = 0.5
[[hold]]
across = [0, 1]
along = [1, 1]
moves = [[0, 0, 0, 0], [0.5, 0, -0.4, 0]]
"#;

/// In the end what holds bear is what hangs on them.
#[test]
fn the_table_of_forces_ends_with_the_weight() {
    let folder = Folder::new();
    folder.write(
        "calm.toml",
        "base = \"hang\"\nseconds = 5\ndrag_per_s = 8\n",
    );
    let line = "tear flag.obj --scene calm.toml --forces f.csv -o t.obj";
    let report = folder.report(line);
    let table = folder.read("f.csv");
    let mut lines = table.lines();
    let head = lines.next().expect("a head");
    assert!(
        head.starts_with("end_s,hold_1_x_n,hold_1_y_n,hold_1_z_n"),
        "{head}"
    );
    let last = lines.next_back().expect("frames").split(',');
    let numbers: Vec<f64> = last.map(|n| n.parse().expect("a number")).collect();
    assert!((numbers[0] - 5.0).abs() < 1e-6);
    let up: f64 = numbers[1..].chunks(3).map(|force| force[1]).sum();
    let kilograms = report["mass"]["after"].as_f64().expect("a mass");
    let off = (up / (9.81 * kilograms) - 1.0).abs();
    assert!(off < 0.01, "{up} N, {kilograms} kg");
    assert_eq!(table.lines().count(), 1 + 300);
}

/// The scene files that the guide shows whole.
fn scenes_of_the_guide() -> Vec<String> {
    let page = root().join("tools/cli/src/guide/scenes.md");
    let page = fs::read_to_string(page).expect("a page");
    let blocks = page.split("```toml\n").skip(1);
    let scenes: Vec<_> = blocks
        .filter_map(|block| block.split("```").next().map(str::to_owned))
        .collect();
    assert!(scenes.len() >= 3);
    scenes
}

/// Scenes that stand ready, those of the data and of the guide, by the default and the other methods in turn. What is printed has
/// three digits.
#[test]
fn the_energy_that_is_printed_adds_up() {
    let scenes = [
        ("sheet.obj", "hang"),
        ("flag.obj", "flag"),
        ("sheet.obj", "rip"),
        ("sheet.obj", "trouser"),
        ("sheet.obj", "fall"),
        ("dress.obj", "tests/data/dress.toml"),
        ("sheet.obj", "tests/data/scarf.toml"),
        ("sheet.obj", "tests/data/woven.toml"),
        ("flag.obj", "tests/data/pull.toml"),
        ("sheet.obj", "tests/data/folds.toml"),
        ("sheet.obj", "lifted.toml"),
        ("sheet.obj", "lowered.toml"),
    ];
    let folder = Folder::new();
    folder.write("lifted.toml", LIFTED);
    folder.write("lowered.toml", LOWERED);
    let mut scenes: Vec<_> = scenes.map(|(mesh, scene)| (mesh, scene.to_owned())).into();
    for (number, scene) in scenes_of_the_guide().into_iter().enumerate() {
        let name = format!("guide-{number}.toml");
        folder.write(&name, scene);
        scenes.push(("sheet.obj", name));
    }
    let mut takers = BTreeSet::new();
    for (number, (mesh, scene)) in scenes.into_iter().enumerate() {
        for solver in ["verlet", ["implicit", "xpbd", "pbd"][number % 3]] {
            let line =
                format!("tear {mesh} --scene {scene} --solver {solver} --seconds 0.6 --dry-run");
            let said = folder.run(&line).seen();
            if said.contains("E-SCENE-CLASH") {
                continue; // These methods have no triangles.
            }
            let added_up = added_up(&said).unwrap_or_else(|| panic!("{line}:\n{said}"));
            assert_eq!(added_up.1, 0.0, "{line}: joules are missing\n{said}");
            takers.extend(added_up.0.into_iter().map(str::to_owned));
        }
    }
    for taker in ["to damping", "to gravity", "to colliders", "to hands"] {
        assert!(
            takers.contains(taker),
            "nothing was lost {taker}: {takers:?}"
        );
    }
}

/// A sheet falls on a block, over whose edges it hangs.
const HUNG: &str = r#"
base = "fall"
seconds = 0.6
up = "z"
[[collider]]
body = "block.obj"
cell_m = 0.02
thickness_m = 0.01
"#;

/// The distance of a point from that block, by the formula of a box.
fn from_block(p: [f64; 3]) -> f64 {
    let beyond = [0, 1, 2].map(|axis| {
        let [low, high] = [[0.2, 0.8], [0.2, 0.8], [-0.5, -0.1]][axis];
        f64::max(low - p[axis], p[axis] - high)
    });
    let outside = beyond.iter().map(|b| b.max(0.0).powi(2)).sum::<f64>();
    let inside = beyond.into_iter().fold(f64::NEG_INFINITY, f64::max);
    outside.sqrt() + inside.min(0.0)
}

/// How near a body the cloth ended is that of the file, but for the error of the grid.
#[test]
fn the_clearance_that_is_printed_is_that_of_the_cloth() {
    let folder = Folder::new();
    folder.write("hung.toml", HUNG);
    let corner = |i: usize| {
        let at = |axis: usize| [[0.2, 0.8], [0.2, 0.8], [-0.5, -0.1]][axis][i >> axis & 1];
        format!("v {} {} {}\n", at(0), at(1), at(2))
    };
    let mut block: String = (0..8).map(corner).collect();
    block += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    folder.write("block.obj", block);
    let report = folder.report("tear sheet.obj --scene hung.toml -o hung.obj");
    let plain = Plain::read(&folder.read("hung.obj"));
    let vertices = (0..plain.vertices.len()).map(|v| from_block(plain.at(v)));
    let edges = plain
        .triangles()
        .into_iter()
        .flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    let middles = edges.map(|ends| {
        let [from, to] = ends.map(|v| plain.at(v as usize));
        from_block([0, 1, 2].map(|axis| 0.5 * (from[axis] + to[axis])))
    });
    let [vertex, middle] = [
        vertices.fold(f64::INFINITY, f64::min),
        middles.fold(f64::INFINITY, f64::min),
    ];
    let body = &report["bodies"][0];
    let said = |key: &str| body[key].as_f64().expect("metres");
    let error = said("error_worst_m");
    assert!(
        (said("nearest_vertex_m") - vertex).abs() < error,
        "{vertex}, {body}"
    );
    assert!(
        (said("nearest_middle_m") - middle).abs() < error,
        "{middle}, {body}"
    );
    assert!(
        middle < vertex - 0.001,
        "{middle}, {vertex}: an edge of the block is a chord away"
    );
}

//! Simulations: the table of forces, and the energy that is printed.

use std::collections::BTreeSet;
use std::fs;

use crate::harness::{Folder, root};
use crate::read_back::added_up;

/// A cloth that the wind lifts off a floor.
const LIFTED: &str = r#"
[wind]
velocity_m_per_s = [0, 8, 2]
[[collider]]
point = [0, -0.01, 0]
normal = [0, 1, 0]
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
    ];
    let folder = Folder::new();
    folder.write("lifted.toml", LIFTED);
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
    for taker in ["to damping", "to gravity", "to colliders"] {
        assert!(
            takers.contains(taker),
            "nothing was lost {taker}: {takers:?}"
        );
    }
}

//! `chart space`: what is told, drawn and written of a finer mesh against a shorter step.

use crate::harness::{Folder, seen};

#[test]
fn errors_of_meshes_and_of_steps_are_told_apart() {
    let folder = Folder::new();
    let command = "tearmesh chart space --scene hang --size 2,4 --finest 8 --method verlet,xpbd-4 \
                   --part 2,1,0.5 --visits-max 1000000";
    let output = folder.run(&format!("{command} -o s.svg --csv s.csv --json s.json"));
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains("15 runs on ") && said.contains("wrote s.svg, s.csv, s.json"),
        "{said}"
    );
    assert!(
        said.contains("against 8 cells") && said.contains("failed: 2 verlet refused"),
        "{said}"
    );
    let report: serde_json::Value = serde_json::from_str(&folder.read("s.json")).expect("JSON");
    assert_eq!(report["schema"], "tearmesh.chart.space/1");
    assert_eq!(report["provenance"]["command"], command);
    let rows = report["scenes"][0]["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 12);
    // At rest a step of Verlet's has no error, so that all of it is of the mesh.
    let verlet = rows.iter().filter(|row| row["method"] == "verlet");
    let errors = verlet.flat_map(|row| row["errors"].as_array().expect("errors"));
    let number = |error: &serde_json::Value, key: &str| error[key].as_f64().expect("a number");
    let mut count = 0;
    for error in errors {
        assert!(
            number(error, "of_step") < 1e-4 * number(error, "total"),
            "{error}"
        );
        assert_ne!(error["buy"]["better"], "step", "{error}");
        count += 1;
    }
    // Two meshes, two steps that are not refused, two measures.
    assert_eq!(count, 8);
    // A row and measure a line, a refused row alone, and three runs on the finest mesh.
    assert_eq!(folder.read("s.csv").lines().count(), 1 + 20 + 2 + 3);
    let chart = folder.read("s.svg");
    assert!(chart.starts_with("<svg ") && chart.contains("hang · sag"));
}

#[test]
fn meshes_that_share_no_lattice_and_steps_that_are_not_halved_are_refused() {
    let folder = Folder::new();
    for given in [
        "--size 4,6 --finest 8",
        "--size 4,8 --finest 8",
        "--size 4,8 --finest 18",
        "--part 0.7,0.5",
        "--part 0.3",
        "--method euler-forward",
        "--scene hung",
    ] {
        let said = seen(&folder.run(&format!("tearmesh chart space {given} -o s.svg")));
        assert!(said.ends_with("(exit 2)\n"), "{given}\n{said}");
    }
    assert!(!folder.path("s.svg").exists());
}

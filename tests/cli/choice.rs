//! `chart choice`: scenes drawn from a seed, and what policies pay in them.

use crate::harness::{Folder, seen};

#[test]
fn a_chart_of_a_few_scenes_is_made_with_its_table_and_figures() {
    let folder = Folder::new();
    let options = "--scenes 1-3 --seconds 0.03";
    let line = format!("tearmesh chart choice {options} -o c.svg --csv c.csv --json c.json");
    let output = folder.run(&line);
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains("scenes 1 to 3, 3 in all, some ")
            && said.contains("Verlet, best step: regret ")
            && said.contains("wrote c.svg, c.csv, c.json"),
        "{said}"
    );
    let report: serde_json::Value = serde_json::from_str(&folder.read("c.json")).expect("JSON");
    assert_eq!(report["schema"], "tearmesh.chart.choice/1");
    let command = "tearmesh chart choice --seed 20261122 --scenes 1-3 --seconds 0.03";
    assert_eq!(report["provenance"]["command"], command);
    let trials = report["trials"].as_array().expect("trials");
    let numbers: Vec<u64> = trials
        .iter()
        .filter_map(|trial| trial["task"]["number"].as_u64())
        .collect();
    assert_eq!(numbers, [1, 2, 3]);
    assert!(folder.read("c.csv").contains("\nrun,1,"));
    let chart = folder.read("c.svg");
    assert!(chart.starts_with("<svg ") && chart.contains(command));
}

#[test]
fn scenes_and_times_that_are_none_are_refused() {
    let folder = Folder::new();
    for given in [
        "--scenes 0",
        "--scenes 3-1",
        "--scenes a-b",
        "--seconds 0.01",
        "--seconds nan",
    ] {
        let said = seen(&folder.run(&format!("tearmesh chart choice {given} -o c.svg")));
        assert!(said.ends_with("(exit 2)\n"), "{given}\n{said}");
    }
}

//! `chart fig7`: what splitting vertices takes, told, drawn and tabled.

use crate::harness::{Folder, seen};

#[test]
fn a_small_chart_of_splits_is_told_drawn_and_tabled() {
    let folder = Folder::new();
    let line = "tearmesh chart fig7 --size 4,8 -o f.svg --csv f.csv --json f.json";
    let output = folder.run(line);
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    // How long it will take comes first.
    assert!(said.contains("2 rips, some 1 s; Ctrl-C"), "{said}");
    assert!(said.contains("8 x 8 cells: "), "{said}");
    assert!(said.contains("wrote f.svg, f.csv, f.json"), "{said}");

    let chart = folder.read("f.svg");
    for part in ["chart fig7 --size 4,8", "commit ", "rustc ", "ghost pairs"] {
        assert!(chart.contains(part), "no {part}");
    }
    let report: serde_json::Value = serde_json::from_str(&folder.read("f.json")).expect("JSON");
    assert_eq!(report["schema"], "tearmesh.chart.fig7/1");
    let tests = report["tests"].as_array().expect("a list");
    assert_eq!(tests.len(), 2);
    for test in tests {
        assert!(
            test["splits"].as_u64().is_some_and(|splits| splits > 0),
            "{test}"
        );
        let ways = test["ways"].as_array().expect("a list");
        assert_eq!(ways.len(), 3);
        let rounds = |way: &serde_json::Value| way["sums_s"].as_array().map(Vec::len);
        assert!(ways.iter().all(|way| rounds(way) == Some(10)));
    }
    let table = folder.read("f.csv");
    let columns = table.lines().next().expect("a head").split(',').count();
    assert!(table.lines().all(|line| line.split(',').count() == columns));
    assert_eq!(table.lines().count(), 1 + 2 * 3 * 10);
}

#[test]
fn what_makes_no_chart_of_splits_is_refused() {
    let folder = Folder::new();
    for line in [
        "--size 1 -o f.svg",
        "--size 8 -o f.svg --csv f.svg",
        "--scene rip -o f.svg",
    ] {
        let said = seen(&folder.run(&format!("tearmesh chart fig7 {line}")));
        assert!(said.ends_with("(exit 2)\n"), "{line}\n{said}");
    }
    assert!(!folder.path("f.svg").exists());
}

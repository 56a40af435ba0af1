//! `chart cut`: time against deviation, beside a record.

use crate::harness::{Folder, root, seen};

#[test]
fn a_small_chart_of_cuts_is_told_drawn_and_tabled_beside_the_record_of_the_project() {
    let folder = Folder::new();
    let records = root().join("tools/bench/record");
    let records = std::fs::read_dir(records).expect("a folder of records");
    let record = records.map(|entry| entry.expect("an entry").path().join("cut.txt"));
    let record = record.filter(|path| path.exists()).min().expect("a record");
    let text = std::fs::read_to_string(record).expect("a record");
    folder.write("record.txt", &text);
    let line = "tearmesh chart cut --size 8,12 --cuts 3 --record record.txt";
    let output = folder.run(&format!("{line} -o c.svg --csv c.csv --json c.json"));
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("60 cuts, some 1 s; Ctrl-C"), "{said}");
    assert!(
        said.contains("3 cuts of 128 faces") && said.contains("3 cuts of 288 faces"),
        "{said}"
    );
    assert!(said.contains("wrote c.svg, c.csv, c.json"), "{said}");

    let report: serde_json::Value = serde_json::from_str(&folder.read("c.json")).expect("JSON");
    assert_eq!(report["schema"], "tearmesh.chart.cut/1");
    let rows = report["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 20);
    assert!(
        rows.iter()
            .all(|row| row["ns_per_face"].as_f64() > Some(0.0))
    );
    let rivals = report["rivals"].as_array().expect("rivals");
    for name in [
        "exact, snap 0",
        "partition",
        "meshlib",
        "trimesh",
        "vtk-plane",
        "vtk-clip",
    ] {
        assert!(
            rivals.iter().any(|rival| rival["name"] == name),
            "no {name}"
        );
    }
    let chart = folder.read("c.svg");
    for part in [
        "--size 8,12 --cuts 3",
        "commit ",
        "meshlib",
        "exact .05 moved",
        "3 of 3",
    ] {
        assert!(chart.contains(part), "no {part}");
    }
    let table = folder.read("c.csv");
    assert!(
        table.contains("\nvtk-plane,") && table.contains("\nuniform,128,"),
        "{table}"
    );
}

#[test]
fn what_is_no_record_is_refused_before_anything_is_cut() {
    let folder = Folder::new();
    folder.write("no.txt", "through cut of nothing\n");
    for (record, code) in [("no.txt", "E-CHART-RECORD"), ("nowhere.txt", "E-IO-READ")] {
        let line = format!("tearmesh chart cut --record {record} -o c.svg");
        let said = seen(&folder.run(&line));
        assert!(
            said.contains(code) && said.ends_with("(exit 3)\n"),
            "{said}"
        );
        assert!(!said.contains(" cuts, some "), "{said}");
    }
    for line in ["--cuts 0", "--size 3", "--record"] {
        let said = seen(&folder.run(&format!("tearmesh chart cut {line} -o c.svg")));
        assert!(said.ends_with("(exit 2)\n"), "{line}\n{said}");
    }
    assert!(!folder.path("c.svg").exists());
}

//! `tear --check-step` and `--forces`: whether the step decides what tears, and what holds bear.

use serde_json::Value;

use crate::harness::Folder;

fn verdict(report: &Value, name: &str) -> String {
    let quantities = &report["step_check"]["quantities"];
    let mut all = quantities.as_array().expect("a list").iter();
    let found = all.find(|one| one["name"] == name).expect("the quantity");
    found["verdict"].as_str().expect("a word").to_owned()
}

#[test]
fn a_suitable_step_is_told_the_same_each_time() {
    let folder = Folder::new();
    let line = "tear flag.obj --scene hang --solver xpbd --dt 0.004 --seconds 0.5 --check-step \
                --no-timing";
    let first = folder.report(line);
    let ensembles = &first["step_check"]["ensembles"];
    for (i, parts) in [(0, 1), (1, 2)] {
        assert_eq!(ensembles[i]["parts"], parts);
        let members = ensembles[i]["members"].as_array().expect("a list");
        assert_eq!(members.len(), 8);
        assert!(members.iter().all(|member| member["status"] == "done"));
    }
    // What does not tear has no first tear at either step, and one piece.
    for name in ["first_tear_s", "torn_m", "pieces"] {
        assert_eq!(verdict(&first, name), "same", "{name}");
    }
    assert!(first["first_tear"].is_null());
    assert_eq!(first["tears"].as_array().map(Vec::len), Some(0));
    assert_eq!(folder.report(line), first);
}

/// The longer a step of PBD, the softer its cloth: at such a step it tears long before what is dragged is
/// drawn tight.
#[test]
fn a_step_that_decides_the_result_is_warned_of() {
    let folder = Folder::new();
    let line = "tear flag.obj --scene rip --solver pbd --dt 0.0333 --seconds 1 --check-step";
    let report = folder.report(line);
    assert_eq!(verdict(&report, "largest_force_n"), "differ", "{report:#}");
    let mut diagnostics = report["diagnostics"].as_array().expect("a list").iter();
    let warning = diagnostics.find(|one| one["code"] == "W-SIM-STEP");
    let message = warning.expect("a warning")["message"].to_string();
    assert!(message.contains("largest force"), "{message}");
}

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

//! `tear --check-step` and `--forces`: whether the step decides what tears, and what holds bear.

use crate::harness::{Folder, seen};

fn report(folder: &Folder, line: &str) -> (serde_json::Value, Option<i32>) {
    let output = folder.run(&format!("tearmesh tear {line} --format json --no-timing"));
    let said = seen(&output);
    let text = String::from_utf8_lossy(&output.stdout);
    let json = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{said}"));
    (json, output.status.code())
}

fn verdict(report: &serde_json::Value, name: &str) -> String {
    let quantities = &report["step_check"]["quantities"];
    let all = quantities.as_array().expect("a list").iter();
    let mut found = all.filter(|one| one["name"] == name);
    let verdict = found.next().expect("the quantity")["verdict"].as_str();
    verdict.expect("a word").to_owned()
}

#[test]
fn a_step_that_suits_is_told_so_and_each_time_the_same() {
    let folder = Folder::new();
    let line = "flag.obj --scene hang --solver xpbd --dt 0.004 --seconds 0.5 --check-step";
    let (first, exit) = report(&folder, line);
    assert_eq!(exit, Some(0));
    let ensembles = &first["step_check"]["ensembles"];
    for (i, parts) in [(0, 1), (1, 2)] {
        let ensemble = &ensembles[i];
        assert_eq!(ensemble["parts"], parts);
        let members = ensemble["members"].as_array().expect("a list");
        assert_eq!(members.len(), 8);
        assert!(members.iter().all(|member| member["status"] == "done"));
    }
    // What does not tear has no first tear at either step, and one piece.
    for name in ["first_tear_s", "torn_m", "pieces"] {
        assert_eq!(verdict(&first, name), "same", "{name}");
    }
    assert!(first["first_tear"].is_null());
    assert_eq!(first["tears"].as_array().map(Vec::len), Some(0));
    assert_eq!(report(&folder, line).0, first);
}

/// The longer a step of PBD, the softer its cloth: at such a step it tears long before what is dragged is
/// drawn tight.
#[test]
fn a_step_that_decides_is_warned_of() {
    let folder = Folder::new();
    let line = "flag.obj --scene rip --solver pbd --dt 0.0333 --seconds 1 --check-step";
    let (json, exit) = report(&folder, line);
    assert_eq!(exit, Some(0));
    assert_eq!(verdict(&json, "largest_force_n"), "differ", "{json:#}");
    let diagnostics = json["diagnostics"].as_array().expect("a list");
    let warning = diagnostics.iter().find(|one| one["code"] == "W-SIM-STEP");
    let message = warning
        .and_then(|one| one["message"].as_str())
        .expect("a warning");
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
    let output = folder
        .run("tearmesh tear flag.obj --scene calm.toml --forces f.csv --report r.json -o t.obj");
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    let table = folder.read("f.csv");
    let mut lines = table.lines();
    let head = lines.next().expect("a head");
    assert!(
        head.starts_with("end_s,hold_1_x_n,hold_1_y_n,hold_1_z_n"),
        "{head}"
    );
    let last = lines.next_back().expect("frames");
    let numbers: Vec<f64> = last
        .split(',')
        .map(|n| n.parse().expect("a number"))
        .collect();
    assert!((numbers[0] - 5.0).abs() < 1e-6);
    let up: f64 = numbers[1..].chunks(3).map(|force| force[1]).sum();
    let json: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    let kilograms = json["mass"]["after"].as_f64().expect("a mass");
    assert!(
        (up / (9.81 * kilograms) - 1.0).abs() < 0.01,
        "{up} N, {kilograms} kg"
    );
    assert_eq!(table.lines().count(), 1 + 300);
}

#[test]
fn a_table_of_forces_replaces_nothing() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"hang\"\nseconds = 0.01\n");
    for line in [
        "--scene hang --forces flag.obj -o t.obj",
        "--scene hang --forces t.obj -o t.obj",
        "--scene hang --forces - -o t.obj",
        "--scene hang --solver provot --forces f.csv -o t.obj",
        "--scene s.toml --forces ./s.toml -o t.obj",
        "--scene hang --forces r.json --report r.json -o t.obj",
    ] {
        let said = seen(&folder.run(&format!("tearmesh tear flag.obj {line}")));
        assert!(said.ends_with("(exit 2)\n"), "{line}\n{said}");
    }
    let nowhere = folder.run("tearmesh tear flag.obj --scene hang --forces no/f.csv -o t.obj");
    assert_eq!(nowhere.status.code(), Some(7), "{}", seen(&nowhere));
    assert!(!folder.path("t.obj").exists());
}

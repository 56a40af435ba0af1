//! Simulations: the report and failures.

use serde_json::Value;

use crate::harness::Folder;
use crate::plain::Plain;

#[test]
fn the_report_lists_the_features_in_use_and_their_shares() {
    let folder = Folder::new();
    for (scene, features) in [
        ("hang", "springs tearing"),
        ("flag", "springs wind"),
        ("tests/data/woven.toml", "springs triangles tearing"),
        ("tests/data/folds.toml", "springs bending"),
    ] {
        let line = format!("tear sheet.obj --scene {scene} --seconds 0.1 --dry-run -v");
        let said = folder.done(&format!("{line} --report r.json"));
        let report = folder.json("r.json");
        let told = report["counters"]["features"].as_array().expect("a list");
        let visits = |one: &Value| one["visits"].as_f64().expect("a count");
        let all: f64 = told.iter().map(visits).sum();
        let (mut names, mut words) = (Vec::new(), Vec::new());
        for one in told {
            let (name, share) = (one["name"].as_str().expect("a name"), visits(one) / all);
            assert!((one["share"].as_f64().expect("a part") - share).abs() < 1e-12);
            names.push(name);
            words.push(format!("{name} {:.0} %", 100.0 * share));
        }
        assert_eq!(names.join(" "), features, "{scene}");
        let words = format!("element visits: {}", words.join(", "));
        assert!(said.contains(&words), "{said}");
    }
}

#[test]
fn a_simulation_that_fails_keeps_its_state_and_says_so() {
    let folder = Folder::new();
    folder.add_files("tests/cli/inputs.txt");
    let answer = folder.run("tear flag.obj --scene fast.toml --format json -o kept.obj");
    assert_eq!(answer.exit, 5);
    let report = answer.json();
    assert_eq!(report["status"], "blown up");
    assert_eq!(report["diagnostics"][0]["code"], "E-SIM-BLOWUP");
    let time = report["time_simulated_s"].as_f64().expect("a time");
    assert!((0.09..0.12).contains(&time), "{time}");
    assert_eq!(report["output"]["vertices"], 1089);
    assert_eq!(Plain::read(&folder.read("kept.obj")).vertices.len(), 1089);
}

/// The slivers of the cut are what the step fails of, so exactly this cut must be reported.
#[test]
fn a_cut_whose_step_fails_is_told_of() {
    let folder = Folder::new();
    let line = "tear flag.obj --scene hang --solver provot --dt 0.0002 --seconds 0.1 \
                --rays 0.51,2,5:0,0,-1 0.513,-2,5:0,0,-1 --cut-at 0.05 -o kept.obj --report r.json";
    let said = folder.ends(line, 5);
    assert!(said.contains("E-SIM-UNSTABLE"), "{said}");
    assert!(said.contains("1 piece -> 2 pieces · at 0.05 s"), "{said}");
    let report = folder.json("r.json");
    assert_eq!(report["pieces"], 2);
    assert_eq!(report["cuts"].as_array().map(Vec::len), Some(1));
}

//! Simulations: the report, failures, and the same bytes on every run.

use serde_json::Value;

use crate::harness::Folder;
use crate::plain::Plain;

#[test]
fn the_report_says_what_the_method_says_of_its_steps() {
    let folder = Folder::new();
    for (solver, quality) in [
        ("provot", "/limiter/steps_infeasible"),
        ("pbd", "/strain_rms"),
        ("xpbd", "/residual_n"),
        ("implicit", "/implicit/indefinite"),
        ("verlet", "/guarded/carried"),
    ] {
        let line = "tear sheet.obj --scene rip --seconds 0.8 --dry-run --report r.json";
        let said = folder.done(&format!("{line} --solver {solver}"));
        let told = &folder.json("r.json")["quality"];
        assert!(
            told.pointer(quality).is_some_and(Value::is_number),
            "{told}"
        );
        // The hand is faster than any cloth is long, which the limiter cannot mend.
        assert_eq!(said.contains("W-SIM-LIMIT"), solver == "provot", "{said}");
    }
}

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
fn two_runs_are_equal_and_what_was_split_is_in_the_output() {
    let folder = Folder::new();
    for name in ["a", "b"] {
        let line = "tear flag.obj --scene rip --seconds 1.5 --no-timing";
        folder.done(&format!(
            "{line} -o {name}.obj --report {name}.json --frames {name}"
        ));
    }
    assert_eq!(folder.read("a.obj"), folder.read("b.obj"));
    for frame in folder.list("a") {
        let [one, other] = ["a", "b"].map(|name| folder.read(&format!("{name}/{frame}")));
        assert_eq!(one, other, "{frame}");
    }
    let other = folder.read("b.json").replace("b.obj", "a.obj");
    let other = other.replace("\"folder\": \"b\"", "\"folder\": \"a\"");
    assert_eq!(folder.read("a.json"), other);
    let report = folder.json("a.json");
    assert!(report["energy_j"]["gain"].is_null());
    assert_eq!(report["status"], "done");
    assert_eq!(report["mass"]["before"], report["mass"]["after"]);
    let count = |value: &Value| value.as_u64().expect("a count");
    let [before, after] = ["input", "output"].map(|file| count(&report[file]["vertices"]));
    let splits = count(&report["splits"]);
    assert!(splits > 10 && before + splits == after);
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

/// Only a simulation knows a density.
#[test]
fn what_cut_and_mend_weigh_vertices_by_is_said_to_be_an_area() {
    let folder = Folder::new();
    for line in [
        "cut sheet.obj --rays 0.3,2,5:0,0,-1 0.3,0.5,5:0,0,-1 -o cut.obj",
        "mend cut.obj --last 1 -o mended.obj",
    ] {
        let words = folder.done(line);
        assert!(
            words.contains("\narea ") && !words.contains("mass"),
            "{words}"
        );
        let report = folder.report(&format!("{line} --in-place"));
        assert_eq!(report["mass"]["unit"], "area");
    }
}

/// A note that nothing has to be done about is for those who ask, and for the report.
#[test]
fn duplicates_of_vertices_are_noted_for_those_who_ask() {
    let folder = Folder::new();
    let line = "tear sheet.obj --scene rip --seconds 0.8 -o x.obj --report r.json";
    assert!(!folder.done(line).contains("W-OBJ-FANS"));
    assert!(folder.read("r.json").contains("W-OBJ-FANS"));
    assert!(
        folder
            .done(&format!("{line} -v"))
            .contains("note[W-OBJ-FANS]")
    );
}

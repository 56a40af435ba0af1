//! The energy that a method makes or loses, and the stiffness that it has instead of the fabric's, as the
//! command tells them.

use crate::harness::{Folder, seen};

/// A step that was divided is limited as often as it has parts.
#[test]
fn the_limiter_counts_in_the_unit_that_it_names() {
    let folder = Folder::new();
    // The cut makes slivers.
    let cut =
        "[[cut]]\nat_s = 1.3\nrays = [\"0.31,-1,5:0,0,-1\", \"0.33,2,5:0,0,-1\"]\nthrough = true\n";
    folder.write("cut.toml", format!("base = \"rip\"\n{cut}"));
    let line = "tearmesh tear flag.obj --scene cut.toml --solver provot --seconds 1.4 --dry-run";
    let output = folder.run(&format!("{line} --report r.json"));
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("a report");
    let [steps, substeps] = [&report["steps"], &report["counters"]["substeps"]];
    assert!(substeps.as_u64() > steps.as_u64(), "{substeps} {steps}");
    let said = seen(&output);
    let infeasible = &report["quality"]["limiter"]["steps_infeasible"];
    let expected = format!("W-SIM-LIMIT]: in {infeasible} of {substeps} substeps, the holds");
    assert!(said.contains(&expected), "{said}");
}

/// What damps, or has another stiffness than its fabric, is told, also where nothing can tear.
#[test]
fn damping_and_stiffness_of_the_method_are_told() {
    let folder = Folder::new();
    let scene =
        |drag: f64| format!("drag_per_s = {drag}\nseconds = 0.5\n[[hold]]\nalong = [0.99, 1]\n");
    folder.write("calm.toml", scene(0.5));
    folder.write("thick.toml", scene(1e4));
    let told = |line: &str| {
        let line = format!("tearmesh tear flag.obj --dry-run {line}");
        let output = folder.run(&line);
        assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
        seen(&output)
    };
    let said = told("--scene calm.toml --solver implicit");
    assert!(
        said.contains("note[W-SIM-DAMPED]: implicit lost "),
        "{said}"
    );
    // Where the scene's own drag takes it, and by a method that loses nothing, it is not.
    for quiet in [
        "--scene thick.toml --solver implicit",
        "--scene calm.toml --solver verlet",
    ] {
        let said = told(quiet);
        assert!(!said.contains("W-SIM-DAMPED"), "{said}");
    }
    let said = told("--scene flag --seconds 0.2 --solver pbd --dt 0.05");
    assert!(said.contains("not on the 1000 N/m of the fabric"), "{said}");
    let coarse = "times too long for so fine a mesh: hanging cloth stretches too far\n";
    assert!(
        said.contains("W-SIM-COARSE]") && said.contains(coarse),
        "{said}"
    );
    let said = told("--scene calm.toml --solver xpbd");
    assert!(
        !said.contains("W-SIM-RIGID") && !said.contains("W-SIM-COARSE"),
        "{said}"
    );
}

/// The rest is what is there, less what was there and what was put in and taken.
#[test]
fn the_report_says_what_the_method_made() {
    let folder = Folder::new();
    // Springs without a guard.
    folder.write(
        "springs.toml",
        "base = \"rip\"\n[fabric]\nstretch_n_per_m = 1000\n[solver]\nmethod = \"provot\"\nlimit_ratio = 1000\n[tear]\nthreshold = 2.5\n",
    );
    let output = folder.run(
        "tearmesh tear flag.obj --scene springs.toml --dt 0.00031 --seconds 1.6 --format json",
    );
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let energy = |name: &str| report["energy_j"][name].as_f64().expect("joules");
    let given = [
        "began",
        "gravity",
        "held",
        "wind",
        "drag",
        "colliders",
        "edits",
    ];
    let given: f64 = given.into_iter().map(energy).sum();
    let rest = energy("kinetic") + energy("elastic") - given;
    assert!((rest + energy("numerical_dissipation")).abs() < 1e-9 * given.abs());
    let gain = |name: &str| report["energy_j"]["gain"][name].as_f64().expect("a gain");
    assert!(gain("made_j") >= rest && rest > 0.25 * gain("put_in_j"));
    assert!((1.2..=1.5).contains(&gain("since_s")));
    let warned = report["diagnostics"].as_array().expect("a list").iter();
    let warned = warned.filter(|entry| entry["code"] == "W-SIM-ENERGY");
    assert_eq!(warned.count(), 1);
}

/// Each step is below its limit and no number is large, but the balance is absurd: such a run is not done.
#[test]
fn a_run_that_triples_its_energy_fails_and_keeps_its_state() {
    let folder = Folder::new();
    let springs = "base = \"rip\"\n[fabric]\nstretch_n_per_m = 1000\n[solver]\nmethod = \"provot\"\nlimit_ratio = 1000\n[tear]\n";
    folder.write("springs.toml", format!("{springs}threshold = 2.5\n"));
    let line = "tearmesh tear flag.obj --scene springs.toml --seconds 1.6";
    let output = folder.run(&format!("{line} --dt 0.00035 -o x.obj --report r.json"));
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(5), "{said}");
    assert!(
        said.contains("error[E-SIM-ENERGY]: the method made "),
        "{said}"
    );
    assert!(!said.contains("W-SIM-ENERGY"), "{said}");
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("a report");
    assert_eq!(report["status"], "gained energy");
    assert_eq!(report["ok"], false);
    let gain = |name: &str| report["energy_j"]["gain"][name].as_f64().expect("a gain");
    assert!(gain("made_j") > 3.0 * gain("put_in_j"), "{said}");
    // It ends with the frame in which that showed.
    let time_s = report["time_simulated_s"].as_f64().expect("a time");
    assert!((1.4..1.59).contains(&time_s), "{time_s}");
    assert!(
        said.contains(&format!("; the state after {time_s} s is kept")),
        "{said}"
    );
    assert_eq!(folder.run("tearmesh check x.obj").status.code(), Some(0));

    // A limiter does unbounded work, so its balance decides nothing.
    folder.write(
        "limited.toml",
        springs.replace("limit_ratio = 1000", "limit_ratio = 4") + "threshold = 2.5\n",
    );
    let line = line.replace("springs", "limited");
    let output = folder.run(&format!("{line} --dt 0.00035 --dry-run"));
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("warning[W-SIM-ENERGY]"), "{said}");
}

/// The limiter's work grows without bound as steps get shorter; without it Provot's springs are like
/// any others.
#[test]
fn joules_that_the_limiter_of_provot_has_a_part_in_are_not_said() {
    let folder = Folder::new();
    for (limit_ratio, is_said) in [("1.001", false), ("1000", true)] {
        let scene = format!(
            "base = \"hang\"\n[solver]\nmethod = \"provot\"\nlimit_ratio = {limit_ratio}\n"
        );
        folder.write("s.toml", &scene);
        let line = "tearmesh tear sheet.obj --scene s.toml --seconds 0.5 --dry-run";
        let words = seen(&folder.run(line));
        assert_eq!(words.contains("J put in"), is_said, "{words}");
        assert_eq!(
            words.contains("the limiter's work grows without bound"),
            !is_said,
            "{words}"
        );
        let output = folder.run(&format!("{line} --format json"));
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        for name in ["held", "numerical_dissipation"] {
            assert_eq!(report["energy_j"][name].is_number(), is_said, "{name}");
        }
        assert!(report["energy_j"]["elastic"].is_number());
        assert_eq!(report["mass"]["unit"], "kg");
    }
}

//! The energy that a method makes or loses, and the stiffness that it has instead of the fabric's, as the
//! command tells them.

use crate::harness::Folder;

/// Springs of Provot's method, which its limiter guards from this stretch on.
fn springs(limit_ratio: u32) -> String {
    format!(
        "base = \"rip\"\n[fabric]\nstretch_n_per_m = 1000\n\
         [solver]\nmethod = \"provot\"\nlimit_ratio = {limit_ratio}\n[tear]\nthreshold = 2.5\n"
    )
}

/// A step that was divided is limited as often as it has parts.
#[test]
fn the_limiter_counts_in_the_unit_that_it_names() {
    let folder = Folder::new();
    // The cut makes slivers.
    let cut =
        "[[cut]]\nat_s = 1.3\nrays = [\"0.31,-1,5:0,0,-1\", \"0.33,2,5:0,0,-1\"]\nthrough = true\n";
    folder.write("cut.toml", format!("base = \"rip\"\n{cut}"));
    let line = "tearmesh tear flag.obj --scene cut.toml --solver provot --seconds 1.4 --dry-run";
    let said = folder.done(&format!("{line} --report r.json"));
    let report = folder.json("r.json");
    let [steps, substeps] = [&report["steps"], &report["counters"]["substeps"]];
    assert!(substeps.as_u64() > steps.as_u64(), "{substeps} {steps}");
    let infeasible = &report["quality"]["limiter"]["steps_infeasible"];
    let expected = format!("W-SIM-LIMIT]: in {infeasible} of {substeps} substeps, the holds");
    assert!(said.contains(&expected), "{said}");
}

/// The rest is what is there, less what was there and what was put in and taken.
#[test]
fn the_report_says_what_the_method_made() {
    let folder = Folder::new();
    // Springs without a guard.
    folder.write("springs.toml", springs(1000));
    let line = "tear flag.obj --scene springs.toml --dt 0.00031 --seconds 1.6";
    let report = folder.report(line);
    let energy = |name: &str| report["energy_j"][name].as_f64().expect("joules");
    let given = "began gravity held wind drag colliders edits".split(' ');
    let given: f64 = given.map(energy).sum();
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
    folder.write("springs.toml", springs(1000));
    let line = "tearmesh tear flag.obj --scene springs.toml --seconds 1.6";
    let said = folder.ends(&format!("{line} --dt 0.00035 -o x.obj --report r.json"), 5);
    assert!(
        said.contains("error[E-SIM-ENERGY]: the method made "),
        "{said}"
    );
    assert!(!said.contains("W-SIM-ENERGY"), "{said}");
    let report = folder.json("r.json");
    assert_eq!(report["status"], "gained energy");
    assert_eq!(report["ok"], false);
    let gain = |name: &str| report["energy_j"]["gain"][name].as_f64().expect("a gain");
    assert!(gain("made_j") > 3.0 * gain("put_in_j"), "{said}");
    // It ends with the frame in which that showed.
    let time_s = report["time_simulated_s"].as_f64().expect("a time");
    assert!((1.4..1.59).contains(&time_s), "{time_s}");
    let kept = format!("; the state after {time_s} s is kept");
    assert!(said.contains(&kept), "{said}");
    folder.done("check x.obj");

    // A limiter does unbounded work, so its balance decides nothing.
    folder.write("limited.toml", springs(4));
    let line = line.replace("springs", "limited");
    let said = folder.done(&format!("{line} --dt 0.00035 --dry-run"));
    assert!(said.contains("warning[W-SIM-ENERGY]"), "{said}");
}

/// The limiter's work grows without bound as steps get shorter; without it Provot's springs are like
/// any others.
#[test]
fn joules_of_a_limited_run_are_not_told() {
    let folder = Folder::new();
    for (limit_ratio, is_said) in [("1.001", false), ("1000", true)] {
        let provot = "base = \"hang\"\n[solver]\nmethod = \"provot\"\nlimit_ratio =";
        folder.write("s.toml", format!("{provot} {limit_ratio}\n"));
        let line = "tearmesh tear sheet.obj --scene s.toml --seconds 0.5 --dry-run";
        let words = folder.done(line);
        assert_eq!(words.contains("J put in"), is_said, "{words}");
        let is_unsaid = words.contains("the limiter's work grows without bound");
        assert_eq!(is_unsaid, !is_said, "{words}");
        let report = folder.report(line);
        for name in ["held", "numerical_dissipation"] {
            assert_eq!(report["energy_j"][name].is_number(), is_said, "{name}");
        }
        assert!(report["energy_j"]["elastic"].is_number());
        assert_eq!(report["mass"]["unit"], "kg");
    }
}

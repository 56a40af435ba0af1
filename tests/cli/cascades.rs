//! `chart tear`: strips, and ensembles of what tears after the first tear.

use crate::harness::{Folder, seen};

const SMALL: &str = "tearmesh chart tear --strips 4,6 --scene rip --size 6 --method implicit,pbd \
                     --seeds 2 --threads 2";

#[test]
fn a_small_chart_has_medians_verdicts_and_each_run_and_each_time_the_same() {
    let folder = Folder::new();
    let output = folder.run(&format!(
        "{SMALL} -o t.svg --csv t.csv --json t.json --runs r.csv"
    ));
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains("4 strips and 12 runs of cascades, some "),
        "{said}"
    );
    assert!(
        said.contains("rip of 6 cells, torn length in m; "),
        "{said}"
    );
    assert!(said.contains(" halved: "), "{said}");
    assert!(said.contains("wrote t.svg, t.csv, t.json, r.csv"), "{said}");

    let report: serde_json::Value = serde_json::from_str(&folder.read("t.json")).expect("JSON");
    assert_eq!(report["schema"], "tearmesh.chart.tear/3");
    let command = report["provenance"]["command"].as_str().expect("a command");
    assert_eq!(
        command,
        "tearmesh chart tear --strips 4,6 --scene rip --method implicit,pbd --seeds 2 --size 6"
    );
    let cascades = report["cascades"].as_array().expect("cascades");
    assert_eq!(cascades.len(), 2);
    let runs = folder.read("r.csv");
    let members = cascades.iter().flat_map(|one| one["ensembles"].as_array());
    let members = members
        .flatten()
        .filter_map(|one| one["members"].as_array());
    let count: usize = members.map(Vec::len).sum();
    assert_eq!(count, 12);
    assert_eq!(runs.lines().count(), 1 + count);

    let chart = folder.read("t.svg");
    assert!(chart.contains("rip of 6 · torn length, m") && chart.contains("--seeds 2"));
    let again = folder.run(&format!("{SMALL} -q -o - --runs s.csv"));
    assert_eq!(String::from_utf8_lossy(&again.stdout), chart);
    assert_eq!(folder.read("s.csv"), runs);
}

#[test]
fn without_seeds_there_are_strips_alone() {
    let folder = Folder::new();
    let line = "tearmesh chart tear --strips 4,6 --seeds 0 -o t.svg --json t.json";
    let output = folder.run(line);
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    let report: serde_json::Value = serde_json::from_str(&folder.read("t.json")).expect("JSON");
    assert_eq!(report["cascades"].as_array().map(Vec::len), Some(0));
    assert_eq!(report["tests"].as_array().map(Vec::len), Some(4));
    assert!(!folder.read("t.svg").contains("Cascades"));
}

#[test]
fn what_makes_no_ensemble_is_refused() {
    let folder = Folder::new();
    for line in [
        "--scene hang",
        "--method rk4",
        "--seeds -1",
        "--size 3",
        "--strips 8",
        "--strips 4,5",
        "--runs t.svg",
    ] {
        let said = seen(&folder.run(&format!("tearmesh chart tear {line} -o t.svg")));
        assert!(said.ends_with("(exit 2)\n"), "{line}\n{said}");
    }
    assert!(!folder.path("t.svg").exists());
}

/// All of it would take a quarter of an hour, and each piece of the strips of the first some seconds.
#[cfg(unix)]
#[test]
fn an_interrupted_chart_ends_at_once_with_what_was_done() {
    use std::io::{BufRead as _, BufReader, Read as _};
    use std::process::{Command, Stdio};

    let folder = Folder::new();
    for line in [
        "chart tear --strips 128,130 --seeds 0 -o t.svg",
        "chart tear --strips 4,6 --seeds 999 --size 100 -o t.svg",
    ] {
        let mut command = folder.command();
        command.args(line.split(' '));
        let child = command
            .stderr(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn();
        let mut child = child.expect("a run");
        let mut words = BufReader::new(child.stderr.take().expect("words"));
        let mut said = String::new();
        words.read_line(&mut said).expect("how long it will take");
        assert!(said.contains(" min"), "{said}");
        std::thread::sleep(std::time::Duration::from_millis(1500));
        let killed = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status();
        assert!(killed.expect("kill runs").success());
        let status = child.wait().expect("an end");
        words.read_to_string(&mut said).expect("the rest");
        assert_eq!(status.code(), Some(130), "{said}");
        assert!(said.contains("W-CHART-INTERRUPTED"), "{said}");
        // It may be so early that the small strips of the second are not done either.
        if said.contains("nothing written") {
            assert!(!folder.path("t.svg").exists());
        } else {
            assert!(line.contains("--seeds 999"), "{said}");
            assert!(said.contains("missing: trouser-100-verlet, "), "{said}");
            assert!(
                folder
                    .read("t.svg")
                    .contains("MISSING: trouser-100-verlet, ")
            );
        }
    }
}

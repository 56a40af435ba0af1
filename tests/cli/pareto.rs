//! `chart pareto`: charts, tables and reports of work against precision.

use crate::harness::{Folder, seen};

const SMALL: &str = "tearmesh chart pareto --scene swing,crushed --size 3 --threads 1 \
                     --visits-max 100000";

#[test]
fn a_small_chart_is_told_drawn_and_tabled_and_each_time_the_same() {
    let folder = Folder::new();
    let output = folder.run(&format!("{SMALL} -o p.svg --csv p.csv --json p.json"));
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    // How long it will take comes first.
    assert!(said.contains(" runs on one thread, some "), "{said}");
    assert!(said.contains("wrote p.svg, p.csv, p.json"), "{said}");
    assert!(
        said.contains("swing/grid-3") && said.contains("crushed/grid-3"),
        "{said}"
    );

    let chart = folder.read("p.svg");
    assert!(chart.starts_with("<svg ") && chart.contains("default"));
    // Where it comes from, to make it again.
    for part in [
        "--scene swing,crushed",
        "--size 3",
        "commit ",
        "rustc ",
        "seed 1",
    ] {
        assert!(chart.contains(part), "no {part}");
    }
    let table = folder.read("p.csv");
    let columns = table.lines().next().expect("a head").split(',').count();
    let mut lines = table.lines().skip(1);
    assert!(lines.all(|line| line.split(',').count() == columns));
    for run in [
        "swing/grid-3/verlet@default",
        "crushed/grid-3/rk4@2",
        "swing/grid-3/gate",
    ] {
        let named = |line: &str| line.starts_with(&format!("{run},"));
        assert!(table.lines().any(named), "no {run}");
    }
    let report: serde_json::Value = serde_json::from_str(&folder.read("p.json")).expect("JSON");
    assert_eq!(report["schema"], "tearmesh.chart.pareto/2");
    assert_eq!(report["cases"].as_array().map(Vec::len), Some(2));
    assert_eq!(report["is_interrupted"], false);

    let again =
        folder.run(&format!("{SMALL} -q -o - --csv q.csv --threads 2").replace("--threads 1 ", ""));
    assert_eq!(String::from_utf8_lossy(&again.stdout), chart);
    assert_eq!(folder.read("q.csv"), table);
    assert_eq!(String::from_utf8_lossy(&again.stderr), "");
}

#[test]
fn times_are_taken_where_a_chart_of_them_is_wanted() {
    let folder = Folder::new();
    let line = "tearmesh chart pareto --scene swing --size 2 --visits-max 20000 --repeats 1 -q";
    let output = folder.run(&format!("{line} -o p.svg --csv p.csv --time-chart t.svg"));
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    let chart = folder.read("t.svg");
    assert!(chart.contains("by CPU time") && chart.contains("median CPU time of 1 runs"));
    let table = folder.read("p.csv");
    let default = table
        .lines()
        .find(|line| line.starts_with("swing/grid-2/verlet@default,"));
    let median = default
        .and_then(|line| line.split(',').nth(14))
        .expect("a time");
    assert!(
        median.parse::<f64>().is_ok_and(|seconds| seconds > 0.0),
        "{median}"
    );
}

#[test]
fn what_makes_no_chart_is_refused() {
    let folder = Folder::new();
    for line in [
        "pareto --scene nowhere -o p.svg",
        "pareto --size 1 -o p.svg",
        "pareto --threads 0 -o p.svg",
        "pareto --repeats 3 -o p.svg",
        "pareto --scene swing --time-chart ./p.svg -o p.svg",
        "tear --scene swing -o p.svg",
        "tear --time-chart t.svg -o p.svg",
    ] {
        let said = seen(&folder.run(&format!("tearmesh chart {line}")));
        assert!(said.ends_with("(exit 2)\n"), "{line}\n{said}");
    }
    assert!(!folder.path("p.svg").exists());
}

/// All of it would take hours.
#[cfg(unix)]
#[test]
fn an_interrupted_chart_ends_at_once_with_what_was_done() {
    use std::io::{BufRead as _, BufReader, Read as _};
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    let folder = Folder::new();
    let mut command = folder.command();
    let line =
        "chart pareto --scene undamped --size 32 --visits-max 100000000000 -o p.svg --csv p.csv";
    command.args(line.split(' '));
    let child = command
        .stderr(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn();
    let mut child = child.expect("a run");
    let mut words = BufReader::new(child.stderr.take().expect("words"));
    let mut said = String::new();
    words.read_line(&mut said).expect("how long it will take");
    std::thread::sleep(Duration::from_millis(300));
    let begun = Instant::now();
    let id = child.id().to_string();
    let killed = Command::new("kill").args(["-INT", &id]).status();
    assert!(killed.expect("kill runs").success());
    let status = child.wait().expect("an end");
    assert!(
        begun.elapsed() < Duration::from_secs(20),
        "{:?}",
        begun.elapsed()
    );
    words.read_to_string(&mut said).expect("the rest");
    assert_eq!(status.code(), Some(130), "{said}");
    assert!(said.contains("W-CHART-INTERRUPTED"), "{said}");
    let table = folder.read("p.csv");
    let stopped = table.lines().filter(|line| line.contains(",interrupted,"));
    assert!(stopped.count() > 100, "{table}");
    assert!(folder.read("p.svg").contains("INTERRUPTED"));
}

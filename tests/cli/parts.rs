//! Charts in parts: what is gathered is what one run makes, and what is not there is named.

use crate::harness::{Folder, seen};

/// A chart that can be made in parts: its name, options that make it small, and its parts.
type Chart = (&'static str, &'static str, &'static [&'static str]);

const PARETO: Chart = (
    "pareto",
    "--scene swing,strip --mesh grid,delaunay --size 3 --visits-max 30000",
    &[
        "swing-grid-3",
        "swing-delaunay-3",
        "strip-grid-3",
        "strip-delaunay-3",
    ],
);

const TEAR: Chart = (
    "tear",
    "--strips 4,6 --scene rip,trouser --size 4 --method implicit,pbd --seeds 2",
    &[
        "strips",
        "trouser-4-implicit",
        "trouser-4-pbd",
        "rip-4-implicit",
        "rip-4-pbd",
    ],
);

const SPACE: Chart = (
    "space",
    "--scene hang,swing,strip,slit --size 2,4 --finest 8 --method verlet,xpbd-4 --part 1,0.5",
    &["hang", "swing", "strip", "slit"],
);

const PLANE: Chart = (
    "plane",
    "--stiffness 1000,10000 --ratio 1,0.01 --size 4 --method verlet,xpbd-1",
    &["1e3-1e0", "1e3-1e-2", "1e4-1e0", "1e4-1e-2"],
);

const CHOICE: Chart = (
    "choice",
    "--scenes 16-31 --seconds 0.02",
    &["16-20", "21-25", "26-30", "31-31"],
);

/// Plans a chart, and types each line of the plan.
fn made(folder: &Folder, (chart, options, parts): Chart) {
    let output = folder.run(&format!("tearmesh chart {chart} {options} --plan -o a.svg"));
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    assert!(!folder.path("a.svg").exists());
    let plan = String::from_utf8(output.stdout).expect("text");
    assert_eq!(plan.lines().count(), parts.len(), "{plan}");
    for (line, part) in plan.lines().zip(parts) {
        let files = format!("-o a.parts/{part}.svg --json a.parts/{part}.json");
        assert!(line.ends_with(&files), "{line}");
        let made = folder.run(line);
        assert_eq!(made.status.code(), Some(0), "{}", seen(&made));
        assert_eq!(seen(&made), "");
    }
}

// A test for each chart, as two of them take as long as all the others.

#[test]
fn pareto_in_parts_is_what_one_run_makes_and_names_those_that_are_missing() {
    in_parts(PARETO);
}

#[test]
fn tear_in_parts_is_what_one_run_makes_and_names_those_that_are_missing() {
    in_parts(TEAR);
}

#[test]
fn space_in_parts_is_what_one_run_makes_and_names_those_that_are_missing() {
    in_parts(SPACE);
}

#[test]
fn plane_in_parts_is_what_one_run_makes_and_names_those_that_are_missing() {
    in_parts(PLANE);
}

#[test]
fn choice_in_parts_is_what_one_run_makes_and_names_those_that_are_missing() {
    in_parts(CHOICE);
}

fn in_parts(chart: Chart) {
    let folder = Folder::new();
    made(&folder, chart);
    what_is_gathered_is_what_one_run_makes(&folder, chart);
    a_part_that_is_missing_or_is_another_is_a_row_and_is_named(&folder, chart);
}

fn what_is_gathered_is_what_one_run_makes(folder: &Folder, (chart, options, _): Chart) {
    let files = |name: &str| format!("-o {name}.svg --csv {name}.csv --json {name}.json");
    for (name, how) in [("a", "--gather a.parts"), ("b", "--threads 2")] {
        let files = files(name);
        let output = folder.run(&format!("tearmesh chart {chart} {options} {how} {files}"));
        assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    }
    for ending in ["svg", "csv", "json"] {
        let [gathered, whole] = ["a", "b"].map(|name| folder.read(&format!("{name}.{ending}")));
        assert!(gathered == whole, "{chart}.{ending} differs");
    }
}

fn a_part_that_is_missing_or_is_another_is_a_row_and_is_named(
    folder: &Folder,
    (chart, options, parts): Chart,
) {
    // One is not there, one is of another command, and one is cut off, as by a full disk.
    let of = |part: &str| format!("a.parts/{part}.json");
    std::fs::remove_file(folder.path(&of(parts[1]))).expect("it was made");
    folder.write(&of(parts[2]), folder.read(&of(parts[0])));
    let text = folder.read(&of(parts[3]));
    folder.write(&of(parts[3]), &text[..text.len() / 2]);
    let line = format!(
        "tearmesh chart {chart} {options} --gather a.parts -o a.svg --csv a.csv --json a.json"
    );
    let output = folder.run(&line);
    assert_eq!(output.status.code(), Some(5), "{}", seen(&output));
    let said = seen(&output);
    let names = parts[1..4].join(", ");
    assert!(said.contains("W-CHART-PARTS"), "{said}");
    assert!(
        said.contains(&format!(
            "3 parts are missing: {names}; the first: a.parts/"
        )),
        "{said}"
    );
    assert!(folder.read("a.svg").contains("MISSING"));
    let table = folder.read("a.csv");
    let report: serde_json::Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    let reasons = [
        "No such file",
        "was made by another command: tearmesh chart",
        "is no tearmesh.chart.",
    ];
    for (i, (part, reason)) in parts[1..4].iter().zip(reasons).enumerate() {
        let row = table
            .lines()
            .find(|line| line.contains("missing") && line.contains(part));
        let row = row.unwrap_or_else(|| panic!("no {part} in {table}"));
        assert!(row.contains(reason), "{row}");
        let header = table.lines().next().expect("a header");
        let columns = |line: &str| {
            line.split('"')
                .step_by(2)
                .collect::<String>()
                .matches(',')
                .count()
        };
        assert_eq!(columns(row), columns(header), "{row}");
        assert_eq!(report["missing"][i]["part"], *part);
    }
}

/// A run that is told to end writes what it has, and names the rest.
#[test]
fn what_a_part_did_not_come_to_is_missing_from_the_whole() {
    let (chart, options, parts) = PLANE;
    let folder = Folder::new();
    made(&folder, PLANE);
    let file = format!("a.parts/{}.json", parts[2]);
    let mut part: serde_json::Value = serde_json::from_str(&folder.read(&file)).expect("JSON");
    let left = serde_json::json!({ "part": "the rest", "why": "interrupted" });
    part["missing"] = serde_json::json!([left]);
    folder.write(&file, part.to_string());
    let line = format!("tearmesh chart {chart} {options} --gather a.parts -o a.svg --json a.json");
    let output = folder.run(&line);
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(5), "{said}");
    assert!(
        said.contains("1 part is missing: the rest; the first: interrupted"),
        "{said}"
    );
    assert!(folder.read("a.svg").contains("MISSING: the rest"));
    let report: serde_json::Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    assert_eq!(report["missing"], serde_json::json!([left]));
}

#[test]
fn a_folder_without_any_part_is_refused() {
    let folder = Folder::new();
    let (chart, options, _) = PARETO;
    let output = folder.run(&format!(
        "tearmesh chart {chart} {options} --gather none -o a.svg"
    ));
    let said = seen(&output);
    assert!(
        said.contains("E-CHART-PARTS") && said.ends_with("(exit 3)\n"),
        "{said}"
    );
    assert!(!folder.path("a.svg").exists());
    for wrong in ["--plan -o -", "--plan --gather a.parts -o a.svg"] {
        let said = seen(&folder.run(&format!("tearmesh chart {chart} {options} {wrong}")));
        assert!(said.ends_with("(exit 2)\n"), "{said}");
    }
}

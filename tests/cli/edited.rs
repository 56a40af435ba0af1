//! Files that another program edited between a cut and its mending.

use crate::harness::Folder;

/// The area of all triangles of a file, by Heron's rule.
fn area(text: &str) -> f64 {
    let numbers = |line: &str| -> Vec<f64> {
        let words = line.split_whitespace().skip(1);
        let first = words.map(|word| word.split('/').next().expect("a number"));
        first.map(|word| word.parse().expect("a number")).collect()
    };
    let places = text.lines().filter(|line| line.starts_with("v "));
    let places: Vec<Vec<f64>> = places.map(numbers).collect();
    let distance = |a: f64, b: f64| {
        let [a, b] = [a, b].map(|v| &places[v as usize - 1]);
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
    };
    let faces = text.lines().filter(|line| line.starts_with("f "));
    let areas = faces.map(|line| {
        let corners = numbers(line);
        let [a, b, c] = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| distance(corners[i], corners[j]));
        let half = (a + b + c) / 2.0;
        (half * (half - a) * (half - b) * (half - c))
            .max(0.0)
            .sqrt()
    });
    areas.sum()
}

/// Where the `v` of a vertex begins and ends, counted from 1.
fn statement(text: &str, vertex: usize) -> std::ops::Range<usize> {
    let mut start = 0;
    let mut left = vertex;
    for line in text.lines() {
        left -= usize::from(line.starts_with("v "));
        if left == 0 {
            return start..start + line.len();
        }
        start += line.len() + 1;
    }
    panic!("the file has a vertex {vertex}")
}

/// A cut sheet, sewn but not simplified, and the vertices that are on record as inserted.
fn sewn(folder: &Folder) -> (String, Vec<usize>) {
    let run = |line: &str| {
        let output = folder.run(line);
        assert!(output.status.success(), "{line}");
    };
    run("tearmesh cut sheet.obj --rays 0.3,2,5:0,0,-1 0.7,0.4,5:0,0,-1 -q -o torn.obj");
    run("tearmesh mend torn.obj -q -o sewn.obj");
    let text = folder.read("sewn.obj");
    let items = text.lines().filter_map(|line| {
        let item = line
            .strip_prefix("#~ edge ")
            .or(line.strip_prefix("#~ face "))?;
        item.split(' ').next()?.parse().ok()
    });
    let inserted = items.collect();
    (text, inserted)
}

#[test]
fn regression_an_inserted_vertex_that_was_moved_since_is_kept_and_said() {
    let folder = Folder::new();
    let (mut text, inserted) = sewn(&folder);
    let vertex = inserted[inserted.len() / 2];
    text.replace_range(statement(&text, vertex), "v 0.5 0.5 0.25");
    folder.write("moved.obj", &text);
    let output = folder.run("tearmesh mend moved.obj --simplify --format json -o simple.obj");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let said = report["diagnostics"].as_array().expect("a list");
    assert!(
        said.iter().any(|one| one["code"] == "W-MEND-EDITED"),
        "it is said: {report:#}"
    );
    if output.status.success() {
        let simple = folder.read("simple.obj");
        assert!(simple.contains("v 0.5 0.5 0.25\n"), "the vertex is kept");
    }
}

#[test]
fn a_vertex_that_a_cut_moved_and_somebody_after_it_is_kept_and_said() {
    let folder = Folder::new();
    let run = |line: &str| {
        let output = folder.run(line);
        assert!(output.status.success(), "{line}");
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let cut = "tearmesh cut flag.obj --rays 0.31,0.5,5:0,0,-1 0.25,-0.5,5:0,0,-1 --snap 0.2";
    let _cut: serde_json::Value = run(&format!("{cut} --snap-move --format json -o torn.obj"));
    let _sewn: serde_json::Value = run("tearmesh mend torn.obj --format json -o sewn.obj");
    let mut text = folder.read("sewn.obj");
    let slides = text
        .lines()
        .filter_map(|line| line.strip_prefix("#~ slide "));
    let numbers = slides.filter_map(|item| item.split(' ').next()?.parse().ok());
    let slid: Vec<usize> = numbers.collect();
    let mend = "tearmesh mend sewn.obj --simplify --format json -o whole.obj";
    let report: serde_json::Value = run(mend);
    assert_eq!(report["mend"]["vertices_slid_back"], slid.len());
    assert_eq!(report["diagnostics"], serde_json::json!([]));
    let vertex = slid[slid.len() / 2];
    text.replace_range(statement(&text, vertex), "v 0.5 0.5 0.25");
    folder.write("sewn.obj", &text);
    let report: serde_json::Value = run(mend);
    assert_eq!(report["mend"]["vertices_slid_edited"], 1, "{report:#}");
    let said = report["diagnostics"].as_array().expect("a list").iter();
    let mut messages = said.filter_map(|one| one["message"].as_str());
    let message = "1 vertex that a cut moved was edited since and stays in place";
    assert!(messages.any(|said| said == message), "{report:#}");
    assert!(folder.read("whole.obj").contains("v 0.5 0.5 0.25\n"));
}

/// The two sides of a cut that stand apart meet halfway, and the sheet has another area then.
#[test]
fn regression_the_area_that_is_said_is_that_of_sides_that_met_halfway() {
    let folder = Folder::new();
    let _sewn = sewn(&folder);
    let mut text = folder.read("torn.obj");
    let item = text.lines().find_map(|line| line.strip_prefix("#~ split "));
    let copy = item.and_then(|item| item.split(' ').next()?.parse().ok());
    text.replace_range(statement(&text, copy.expect("a copy")), "v 0.4 0.6 0.5");
    folder.write("moved.obj", &text);
    for simplify in ["", "--simplify"] {
        let mend = format!("tearmesh mend moved.obj {simplify} --format json -o whole.obj");
        let output = folder.run(&mend);
        assert!(output.status.success(), "{output:?}");
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let said = report["mass"]["after"].as_f64().expect("an area");
        let is = area(&folder.read("whole.obj"));
        assert!((said - is).abs() < 1e-9 * is, "{said} for {is}");
    }
}

/// Nothing at all can go, or only what is away from the edit: in any case the mass that is said is
/// that of the file that is written.
#[test]
fn the_mass_that_is_said_is_the_mass_that_is_written() {
    let folder = Folder::new();
    let (_, inserted) = sewn(&folder);
    // Of a second cut, across the first, which still has to be sewn.
    let again = "tearmesh cut sewn.obj --rays 2,0.81,5:0,0,-1 -1,0.83,5:0,0,-1 -q -o twice.obj";
    assert!(folder.run(again).status.success());
    let torn = folder.read("twice.obj");
    for vertex in inserted.iter().step_by(inserted.len() / 5) {
        let mut text = torn.clone();
        text.replace_range(statement(&text, *vertex), "v 0.4 0.6 0.3");
        folder.write("moved.obj", &text);
        let output = folder.run("tearmesh mend moved.obj --simplify --format json -o simple.obj");
        assert!(output.status.success());
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let said = report["mass"]["after"].as_f64().expect("a mass");
        let written = area(&folder.read("simple.obj"));
        assert!(
            (said - written).abs() <= 1e-6 * written,
            "vertex {vertex}: {said} is said, {written} is written"
        );
    }
}

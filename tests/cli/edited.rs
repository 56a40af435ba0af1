//! Files that another program edited between a cut and its mending.

use serde_json::Value;

use crate::harness::Folder;
use crate::plain::Plain;

/// The text with this `v` for a vertex, which counts from 1.
fn moved(text: &str, vertex: usize, statement: &str) -> String {
    let is_v = |line: &&str| line.starts_with("v ");
    let old = text
        .lines()
        .filter(is_v)
        .nth(vertex - 1)
        .expect("the vertex");
    let start = old.as_ptr() as usize - text.as_ptr() as usize;
    [&text[..start], statement, &text[start + old.len()..]].concat()
}

/// The first numbers of the items of a record that begin so.
fn numbers(text: &str, begins: &[&str]) -> Vec<usize> {
    let of = |line: &str| {
        let item = begins.iter().find_map(|begin| line.strip_prefix(begin))?;
        item.split(' ').next()?.parse().ok()
    };
    text.lines().filter_map(of).collect()
}

/// A cut sheet, sewn but not simplified, and the vertices that are on record as inserted.
fn sewn(folder: &Folder) -> (String, Vec<usize>) {
    folder.done("cut sheet.obj --rays 0.3,2,5:0,0,-1 0.7,0.4,5:0,0,-1 -q -o torn.obj");
    folder.done("mend torn.obj -q -o sewn.obj");
    let text = folder.read("sewn.obj");
    let inserted = numbers(&text, &["#~ edge ", "#~ face "]);
    (text, inserted)
}

/// Fails unless the mass that a report says is the area of a file.
fn weighs(report: &Value, text: &str, tolerance: f64) {
    let said = report["mass"]["after"].as_f64().expect("an area");
    let is = Plain::read(text).area();
    assert!(
        (said - is).abs() <= tolerance * is,
        "{said} is said, {is} is written"
    );
}

#[test]
fn regression_an_inserted_vertex_moved_since_is_kept() {
    let folder = Folder::new();
    let (text, inserted) = sewn(&folder);
    folder.write(
        "moved.obj",
        moved(&text, inserted[inserted.len() / 2], "v 0.5 0.5 0.25"),
    );
    let answer = folder.run("mend moved.obj --simplify --format json -o simple.obj");
    let report = answer.json();
    let mut said = report["diagnostics"].as_array().expect("a list").iter();
    assert!(said.any(|one| one["code"] == "W-MEND-EDITED"), "{report:#}");
    if answer.exit == 0 {
        assert!(folder.read("simple.obj").contains("v 0.5 0.5 0.25\n"));
    }
}

/// The two sides of a cut that stand apart meet halfway, and the sheet has another area then.
#[test]
fn regression_the_area_told_is_of_sides_met_halfway() {
    let folder = Folder::new();
    let _sewn = sewn(&folder);
    let text = folder.read("torn.obj");
    let copy = numbers(&text, &["#~ split "])[0];
    folder.write("moved.obj", moved(&text, copy, "v 0.4 0.6 0.5"));
    for simplify in ["", "--simplify"] {
        let report = folder.report(&format!("mend moved.obj {simplify} -o whole.obj"));
        weighs(&report, &folder.read("whole.obj"), 1e-9);
    }
}

/// Nothing at all can go, or only what is away from the edit: in any case the mass that is said is
/// that of the file that is written.
#[test]
fn the_mass_that_is_said_is_the_mass_that_is_written() {
    let folder = Folder::new();
    let (_, inserted) = sewn(&folder);
    // Of a second cut, across the first, which still has to be sewn.
    folder.done("cut sewn.obj --rays 2,0.81,5:0,0,-1 -1,0.83,5:0,0,-1 -q -o twice.obj");
    let torn = folder.read("twice.obj");
    for vertex in inserted.iter().step_by(inserted.len() / 5) {
        folder.write("moved.obj", moved(&torn, *vertex, "v 0.4 0.6 0.3"));
        let report = folder.report("mend moved.obj --simplify -o simple.obj");
        weighs(&report, &folder.read("simple.obj"), 1e-6);
    }
}

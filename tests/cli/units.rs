//! Files in tiny and in huge units: `check` refuses what a cut refuses, in the same words.

use serde_json::Value;

use crate::harness::Folder;

/// The code and the words of the first error of a report on a square of two triangles in units of a power of ten.
fn first_error(folder: &Folder, exponent: i32, line: &str) -> Option<[String; 2]> {
    let places = [[0, 0], [1, 0], [1, 1], [0, 1]];
    let vertices = places.map(|[x, y]| format!("v {x}e{exponent} {y}e{exponent} 0\n"));
    folder.write("square.obj", vertices.concat() + "f 1 2 3\nf 1 3 4\n");
    let answer = folder.run(line);
    let report = answer.json();
    let mut all = report["diagnostics"].as_array().expect("a list").iter();
    let first = all.find(|one| one["level"] == "error");
    let is_done = answer.exit == 0 || report["cuts"][0].is_object();
    assert_eq!(first.is_none(), is_done, "{line}");
    let text = |one: &Value| one.as_str().expect("a text").to_owned();
    first.map(|one| ["code", "message"].map(|key| text(&one[key])))
}

const CHECK: &str = "check --format json square.obj";

#[test]
fn regression_check_refuses_the_units_that_a_cut_refuses() {
    let folder = Folder::new();
    let refused = first_error(&folder, -100, CHECK).expect("it cannot be cut");
    let words =
        "no face has an area (all of them together less than 1e-140), so there is no mass to lump";
    assert_eq!(refused, ["E-MASS", words]);
    let mut counts = [0, 0];
    for e in (-330..=160).step_by(10).chain(-84..=-66) {
        let check = first_error(&folder, e, CHECK);
        let rays = format!("0.5e{e},2e{e},1e{e}:0,0,-1 0.5e{e},-2e{e},1e{e}:0,0,-1");
        let cut = format!("cut square.obj --format json --allow-miss --rays {rays}");
        let cut = first_error(&folder, e, &cut);
        // Of units in which there are no rays, there is nothing to compare.
        if cut
            .as_ref()
            .is_some_and(|[code, _]| code.starts_with("E-RAY"))
        {
            continue;
        }
        assert_eq!(check, cut, "1e{e}");
        counts[usize::from(check.is_some())] += 1;
    }
    assert!(counts.iter().all(|&count| count > 10), "{counts:?}");
}

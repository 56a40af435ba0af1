//! Files in tiny and in huge units: `check` refuses what a cut refuses, in the same words.

use crate::harness::Folder;

/// A square of two triangles, in units of a power of ten.
fn square(exponent: i32) -> String {
    let places = [[0, 0], [1, 0], [1, 1], [0, 1]];
    let vertices = places.map(|[x, y]| format!("v {x}e{exponent} {y}e{exponent} 0\n"));
    vertices.concat() + "f 1 2 3\nf 1 3 4\n"
}

/// The code and the words of the first error of a report.
fn first_error(folder: &Folder, line: &str) -> Option<(String, String)> {
    let output = folder.run(line);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let all = report["diagnostics"].as_array().expect("a list").iter();
    let mut errors = all.filter(|one| one["level"] == "error");
    let text = |one: &serde_json::Value| one.as_str().expect("a text").to_owned();
    let first = errors.next();
    assert_eq!(
        first.is_none(),
        output.status.success() || report["cuts"][0].is_object(),
        "{line}"
    );
    first.map(|one| (text(&one["code"]), text(&one["message"])))
}

#[test]
fn regression_check_refuses_units_in_which_no_face_has_an_area() {
    let folder = Folder::new();
    folder.write("tiny.obj", square(-100));
    let refused = first_error(&folder, "tearmesh check --format json tiny.obj");
    let (code, words) = refused.expect("it cannot be cut");
    assert_eq!(code, "E-MASS");
    assert_eq!(
        words,
        "no face has an area (all of them together less than 1e-140), so there is no mass to lump"
    );
}

#[test]
fn check_refuses_exactly_the_units_that_a_cut_refuses() {
    let folder = Folder::new();
    let (mut accepted, mut refused) = (0, 0);
    for exponent in (-330..=160).step_by(10).chain(-84..=-66) {
        folder.write("square.obj", square(exponent));
        let check = first_error(&folder, "tearmesh check --format json square.obj");
        let cut = format!(
            "tearmesh cut square.obj --format json --allow-miss \
             --rays 0.5e{exponent},2e{exponent},1e{exponent}:0,0,-1 \
             0.5e{exponent},-2e{exponent},1e{exponent}:0,0,-1"
        );
        // Of units in which there are no rays, there is nothing to compare.
        if first_error(&folder, &cut).is_some_and(|(code, _)| code.starts_with("E-RAY")) {
            continue;
        }
        assert_eq!(check, first_error(&folder, &cut), "1e{exponent}");
        *(if check.is_none() {
            &mut accepted
        } else {
            &mut refused
        }) += 1;
    }
    println!("{accepted} units accepted, {refused} refused");
    assert!(accepted > 10 && refused > 10, "{accepted} {refused}");
}

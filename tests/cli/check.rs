//! What `check` says of a mesh, by plain sums over the lines of its file; and in tiny and huge units it refuses what a
//! cut refuses, in the same words.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::harness::Folder;
use crate::plain::Plain;

#[test]
fn sizes_are_those_of_the_file() {
    let folder = Folder::new();
    folder.done("cut flag.obj --plane 0.31,0,0:1,0.4,0 --plane 0,0.2,0:0,1,0 -q -o torn.obj");
    for (name, pieces) in [("flag.obj", 1), ("sleeve.obj", 1), ("torn.obj", 4)] {
        let mesh = &folder.run(&format!("check --format json {name}")).json()["mesh"];
        let plain = Plain::read(&folder.read(name));
        for axis in 0..3 {
            let all = plain.vertices.iter().map(|place| place[axis]);
            let [least, most] = ["min", "max"].map(|end| mesh["bounds"][end][axis].as_f64());
            assert_eq!(least, Some(all.clone().fold(f64::INFINITY, f64::min)));
            assert_eq!(most, Some(all.fold(f64::NEG_INFINITY, f64::max)));
        }
        let mut lengths = BTreeMap::new();
        for face in &plain.faces {
            for (i, length) in plain.sides(face).into_iter().enumerate() {
                let (a, b) = (face[i], face[(i + 1) % 3]);
                lengths.insert((a.min(b), a.max(b)), length);
            }
        }
        let all = lengths.values().copied();
        let told = mesh["pieces"].as_array().expect("pieces");
        assert_eq!(told.len(), pieces);
        let area = told
            .iter()
            .map(|piece| piece["area"].as_f64().expect("an area"));
        let edges = ["shortest", "longest", "mean"].map(|key| mesh["edges"][key].as_f64());
        let shortest = all.clone().fold(f64::INFINITY, f64::min);
        let longest = all.clone().fold(0.0, f64::max);
        let mean = all.sum::<f64>() / lengths.len() as f64;
        let sizes = [shortest, longest, mean, plain.area()];
        for (told, is) in edges.into_iter().chain([Some(area.sum())]).zip(sizes) {
            let told: f64 = told.expect("a number");
            assert!((told - is).abs() <= 1e-9 * is, "{name}: {told} {is}");
        }
        let counts = told
            .iter()
            .map(|piece| piece["faces"].as_u64().expect("a count"));
        assert_eq!(counts.sum::<u64>(), plain.faces.len() as u64);
    }
}

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

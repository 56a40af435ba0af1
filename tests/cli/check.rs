//! What `check` says of a mesh, by plain sums over the lines of its file.

use std::collections::BTreeMap;

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

//! `cut --map`: applied by hand to what the input has, it gives what the output has.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::harness::{Folder, seen};
use crate::random::Random;

/// A file as its lines have it: `v`, `vt`, and of each face the texture coordinates at its corners.
#[derive(Default)]
struct Plain {
    vertices: Vec<Vec<f64>>,
    texture: Vec<Vec<f64>>,
    faces: Vec<Vec<Option<usize>>>,
}

impl Plain {
    fn read(text: &str) -> Plain {
        let mut plain = Plain::default();
        for line in text.lines() {
            let (keyword, rest) = line.split_once(' ').unwrap_or((line, ""));
            let numbers = || -> Vec<f64> {
                let words = rest.split_whitespace();
                words.map(|x| x.parse().expect("a number")).collect()
            };
            match keyword {
                "v" => plain.vertices.push(numbers()),
                "vt" => plain.texture.push(numbers()),
                "f" => {
                    let texture = |corner: &str| {
                        let index = corner.split('/').nth(1)?;
                        index.parse().ok().map(|index: usize| index - 1)
                    };
                    plain
                        .faces
                        .push(rest.split_whitespace().map(texture).collect());
                }
                _ => {}
            }
        }
        plain
    }

    /// The texture coordinates at all corners, in order; of a file that has them everywhere.
    fn at_corners(&self) -> Vec<Vec<f64>> {
        let indices = self.faces.iter().flatten();
        indices
            .map(|i| self.texture[i.expect("one at each corner")].clone())
            .collect()
    }
}

/// The sum of rows by weights.
fn applied(sources: &Value, rows: &[Vec<f64>]) -> Vec<f64> {
    let mut sum = Vec::new();
    for pair in sources.as_array().expect("sources") {
        let row = &rows[pair[0].as_u64().expect("an index") as usize];
        let weight = pair[1].as_f64().expect("a weight");
        sum.resize(row.len(), 0.0);
        sum.iter_mut()
            .zip(row)
            .for_each(|(sum, x)| *sum += weight * x);
    }
    sum
}

/// The largest difference between what the map gives and what there is.
fn largest_error(map: &Value, before: &[Vec<f64>], after: &[Vec<f64>]) -> f64 {
    let map = map.as_array().expect("a list");
    assert_eq!(map.len(), after.len());
    let differences = map.iter().zip(after).flat_map(|(sources, is)| {
        let given = applied(sources, before);
        assert_eq!(given.len(), is.len());
        let off = given.iter().zip(is).map(|(x, y)| (x - y).abs());
        off.collect::<Vec<_>>()
    });
    differences.fold(0.0, f64::max)
}

/// The flag with two weights at each vertex, and at each corner a texture coordinate; where `seam`, the
/// faces of one half have others.
fn weighted_flag(folder: &Folder, seam: bool) -> String {
    let mut text = String::new();
    let (mut random, mut places) = (Random(7), Vec::new());
    let flag = folder.read("flag.obj");
    for line in flag.lines() {
        if let Some(place) = line.strip_prefix("v ") {
            let numbers: Vec<&str> = place.split_whitespace().collect();
            places.push(numbers[0].parse::<f64>().expect("x"));
            text += &format!(
                "v {} {} {}\n",
                numbers[..3].join(" "),
                random.next(),
                random.next()
            );
        }
    }
    for _ in 0..2 * places.len() {
        text += &format!("vt {} {}\n", random.next(), random.next());
    }
    for line in flag.lines().filter_map(|line| line.strip_prefix("f ")) {
        let corners = line
            .split_whitespace()
            .map(|corner| corner.split('/').next());
        let corners: Vec<usize> = corners
            .map(|corner| corner.expect("an index").parse().expect("a number"))
            .collect();
        let is_right = seam && corners.iter().map(|&v| places[v - 1]).sum::<f64>() > 0.9;
        let shift = if is_right { places.len() } else { 0 };
        let corners: Vec<String> = corners
            .iter()
            .map(|v| format!("{v}/{}", v + shift))
            .collect();
        text += &format!("f {}\n", corners.join(" "));
    }
    text
}

#[test]
fn the_map_applied_by_hand_gives_what_is_written() {
    let folder = Folder::new();
    let slit = "--rays 0.31,0.5,5:0,0,-1 0.25,-0.5,5:0,0,-1";
    let cross = "--rays 2,0.1,5:0,0,-1 -2,0.13,5:0,0,-1";
    let mut mixed = BTreeMap::new();
    for seam in [false, true] {
        folder.write("in.obj", weighted_flag(&folder, seam));
        let before = Plain::read(&folder.read("in.obj"));
        for options in [
            slit.to_owned(),
            format!("{slit} --snap 0 {cross}"),
            format!("{slit} --snap 0.2 --snap-move {cross}"),
            format!("{slit} --method partition"),
            format!("{cross} --method alternating"),
            format!("{slit} --through {cross}"),
        ] {
            let line = format!("tearmesh cut in.obj {options} --map map.json -q -o out.obj");
            let output = folder.run(&line);
            assert!(output.status.success(), "{}", seen(&output));
            let after = Plain::read(&folder.read("out.obj"));
            let map: Value = serde_json::from_str(&folder.read("map.json")).expect("JSON");
            assert_eq!(map["schema"], "tearmesh.map/1");
            assert_eq!(map["input"]["vertices"], before.vertices.len());
            assert_eq!(map["output"]["vertices"], after.vertices.len());
            let of_vertices = largest_error(&map["vertices"], &before.vertices, &after.vertices);
            let of_corners =
                largest_error(&map["corners"], &before.at_corners(), &after.at_corners());
            println!("{options}: {of_vertices:e} {of_corners:e}");
            assert!(of_vertices <= 1e-15 && of_corners <= 1e-15, "{options}");
            // A face is part of the one at whose corners its own come from.
            let faces = map["faces"].as_array().expect("a list");
            let corners = map["corners"].as_array().expect("a list");
            assert_eq!(
                (faces.len(), corners.len()),
                (after.faces.len(), 3 * faces.len())
            );
            for (face, corners) in faces.iter().zip(corners.chunks(3)) {
                let sources = corners
                    .iter()
                    .flat_map(|corner| corner.as_array().expect("a list"));
                for source in sources {
                    let of = source[0].as_u64().expect("an index") / 3;
                    let is_own = Some(of) == face.as_u64();
                    // A vertex that slid takes with it the corners that share its coordinate.
                    assert!(is_own || options.contains("snap-move"), "{options}");
                }
            }
            let several = corners
                .iter()
                .filter(|one| one.as_array().is_some_and(|l| l.len() > 1));
            mixed.insert((seam, options.clone()), several.count());
        }
    }
    assert!(mixed.values().any(|&several| several > 100), "{mixed:?}");
}

/// Faces of more than three corners count as one, and copies for fans have the sources of their vertex.
#[test]
fn a_map_names_the_polygons_of_the_file() {
    let folder = Folder::new();
    let line = "tearmesh cut quilt.obj --plane -0.4,0.2,0:1,0.3,0 --map map.json -q -o out.obj";
    assert!(folder.run(line).status.success());
    let (before, after) = (folder.read("quilt.obj"), folder.read("out.obj"));
    let map: Value = serde_json::from_str(&folder.read("map.json")).expect("JSON");
    let faces = |text: &str| text.lines().filter(|line| line.starts_with("f ")).count();
    assert_eq!(map["input"]["faces"], faces(&before));
    assert_eq!(map["output"]["faces"], faces(&after));
    let (before, after) = (Plain::read(&before), Plain::read(&after));
    let off = largest_error(&map["vertices"], &before.vertices, &after.vertices);
    assert!(off <= 1e-15, "{off:e}");
    let ends = before.faces.iter().scan(0, |end, face| {
        *end += face.len() as u64;
        Some(*end)
    });
    let ends: Vec<u64> = ends.collect();
    let corners = map["corners"].as_array().expect("a list").chunks(3);
    for (face, corners) in map["faces"].as_array().expect("a list").iter().zip(corners) {
        for source in corners
            .iter()
            .flat_map(|corner| corner.as_array().expect("a list"))
        {
            let corner = source[0].as_u64().expect("an index");
            let of = ends.partition_point(|&end| end <= corner);
            assert_eq!(Some(of as u64), face.as_u64());
        }
    }
}

#[test]
fn a_map_takes_a_file_of_its_own() {
    let folder = Folder::new();
    for (options, said) in [
        ("--map -", "`--map` takes the name of a file"),
        ("--map flag.obj", "is the input, and would be replaced"),
        (
            "--map s.obj --seam s.obj",
            "is the seam, and would be replaced",
        ),
        ("--map out.obj", "is the map, and would be replaced"),
        ("--map m.json --repair", "cannot be used with"),
    ] {
        let line = format!("tearmesh cut flag.obj --plane 0,0,0:1,0,0 {options} -o out.obj");
        let text = seen(&folder.run(&line));
        assert!(
            text.contains(said) && text.ends_with("(exit 2)\n"),
            "{text}"
        );
    }
}

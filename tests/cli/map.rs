//! `cut --map`: applied by hand to what the input has, it gives what the output has.

use serde_json::Value;

use crate::harness::Folder;
use crate::plain::Plain;
use crate::random::Random;

/// The texture coordinates at all corners, in order; of a file that has them everywhere.
fn at_corners(plain: &Plain) -> Vec<Vec<f64>> {
    let indices = plain.face_textures.iter().flatten();
    let at = |i: &Option<usize>| plain.texture[i.expect("one at each corner")].clone();
    indices.map(at).collect()
}

/// The elements that an element is made of, each with its weight.
fn sources(of: &Value) -> impl Iterator<Item = (usize, f64)> {
    let pairs = of.as_array().expect("sources").iter();
    pairs.map(|pair| {
        let index = pair[0].as_u64().expect("an index");
        (index as usize, pair[1].as_f64().expect("a weight"))
    })
}

/// The largest difference between what the map gives and what there is.
fn largest_error(map: &Value, before: &[Vec<f64>], after: &[Vec<f64>]) -> f64 {
    let map = map.as_array().expect("a list");
    assert_eq!(map.len(), after.len());
    let mut largest = 0.0_f64;
    for (of, is) in map.iter().zip(after) {
        let mut given = vec![0.0; is.len()];
        for (index, weight) in sources(of) {
            assert_eq!(before[index].len(), is.len());
            let sum = given.iter_mut().zip(&before[index]);
            sum.for_each(|(sum, x)| *sum += weight * x);
        }
        let off = given.iter().zip(is).map(|(x, y)| (x - y).abs());
        largest = off.fold(largest, f64::max);
    }
    largest
}

/// The flag with two weights at each vertex, and at each corner a texture coordinate; where `seam`, the
/// faces of one half have others.
fn weighted_flag(folder: &Folder, seam: bool) -> String {
    let flag = Plain::read(&folder.read("flag.obj"));
    let (count, mut random, mut text) = (flag.vertices.len(), Random(7), String::new());
    for [x, y, z] in (0..count).map(|v| flag.at(v)) {
        text += &format!("v {x} {y} {z} {} {}\n", random.next(), random.next());
    }
    for _ in 0..2 * count {
        text += &format!("vt {} {}\n", random.next(), random.next());
    }
    for face in &flag.faces {
        let is_right = seam && face.iter().map(|&v| flag.at(v)[0]).sum::<f64>() > 0.9;
        let shift = if is_right { count } else { 0 };
        let corners = face.iter().map(|v| format!(" {}/{}", v + 1, v + 1 + shift));
        text += &format!("f{}\n", corners.collect::<String>());
    }
    text
}

#[test]
fn the_map_applied_by_hand_gives_what_is_written() {
    let folder = Folder::new();
    let slit = "--rays 0.31,0.5,5:0,0,-1 0.25,-0.5,5:0,0,-1";
    let cross = "--rays 2,0.1,5:0,0,-1 -2,0.13,5:0,0,-1";
    let mut mixed = Vec::new();
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
            folder.done(&format!(
                "cut in.obj {options} --map map.json -q -o out.obj"
            ));
            let after = Plain::read(&folder.read("out.obj"));
            let map = folder.json("map.json");
            assert_eq!(map["schema"], "tearmesh.map/1");
            assert_eq!(map["input"]["vertices"], before.vertices.len());
            assert_eq!(map["output"]["vertices"], after.vertices.len());
            let of_vertices = largest_error(&map["vertices"], &before.vertices, &after.vertices);
            let [own, other] = [&before, &after].map(at_corners);
            let of_corners = largest_error(&map["corners"], &own, &other);
            assert!(of_vertices <= 1e-15 && of_corners <= 1e-15, "{options}");
            // A face is part of the one at whose corners its own come from.
            let [faces, corners] =
                ["faces", "corners"].map(|key| map[key].as_array().expect("a list"));
            assert_eq!(faces.len(), after.faces.len());
            for (face, corners) in faces.iter().zip(corners.chunks(3)) {
                // A vertex that slid takes with it the corners that share its coordinate.
                let is_own = |(of, _)| *face == of / 3 || options.contains("snap-move");
                assert!(corners.iter().flat_map(sources).all(is_own), "{options}");
            }
            mixed.push(corners.iter().filter(|of| sources(of).count() > 1).count());
        }
    }
    assert!(mixed.iter().any(|&several| several > 100), "{mixed:?}");
}

/// Faces of more than three corners count as one, and copies for fans have the sources of their vertex.
#[test]
fn a_map_names_the_polygons_of_the_file() {
    let folder = Folder::new();
    folder.done("cut quilt.obj --plane -0.4,0.2,0:1,0.3,0 --map map.json -q -o out.obj");
    let map = folder.json("map.json");
    let [before, after] = ["quilt.obj", "out.obj"].map(|name| Plain::read(&folder.read(name)));
    assert_eq!(map["input"]["faces"], before.faces.len());
    assert_eq!(map["output"]["faces"], after.faces.len());
    let off = largest_error(&map["vertices"], &before.vertices, &after.vertices);
    assert!(off <= 1e-15, "{off:e}");
    let owners = before.faces.iter().zip(0..);
    let owners: Vec<u64> = owners.flat_map(|(face, i)| vec![i; face.len()]).collect();
    let corners = map["corners"].as_array().expect("a list").chunks(3);
    for (face, corners) in map["faces"].as_array().expect("a list").iter().zip(corners) {
        let mut of = corners.iter().flat_map(sources);
        assert!(of.all(|(corner, _)| *face == owners[corner]));
    }
}

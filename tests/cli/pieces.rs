//! `cut --pieces`: every face of the whole is in one piece, as it is in the whole.
//!
//! The files are read by a few lines that share no code with the reader of the library.

use std::collections::{BTreeMap, BTreeSet};

use tearmesh_obj::Document;

use crate::harness::Folder;
use crate::plain::Plain;

/// A face: the object, group, material and smoothing group that it is in, and for each corner the
/// numbers of its vertex, texture coordinate and normal, to the letter.
type Face = ([String; 4], Vec<[String; 3]>);

/// The faces of a file, in order.
fn faces(text: &str) -> Vec<Face> {
    let keywords = ["o", "g", "usemtl", "s"];
    let mut numbers: [Vec<String>; 3] = Default::default();
    let mut state: [String; 4] = Default::default();
    let mut faces = Vec::new();
    for line in text.lines() {
        let (keyword, rest) = line.split_once(' ').unwrap_or((line, ""));
        if let Some(which) = ["v", "vt", "vn"].iter().position(|own| *own == keyword) {
            numbers[which].push(rest.to_owned());
        } else if let Some(which) = keywords.iter().position(|own| *own == keyword) {
            state[which] = rest.to_owned();
        } else if keyword == "f" {
            let corner = |word: &str| {
                let mut corner: [String; 3] = Default::default();
                for (which, index) in word.split('/').enumerate() {
                    if let Ok(index) = index.parse::<usize>() {
                        corner[which] = numbers[which][index - 1].clone();
                    }
                }
                corner
            };
            faces.push((state.clone(), rest.split(' ').map(corner).collect()));
        }
    }
    faces
}

/// Holds the pieces in a folder against the whole, and gives how many faces each has.
fn check(folder: &Folder, whole: &str, pieces: &str) -> Vec<usize> {
    let list = folder.json(&format!("{pieces}/pieces.json"));
    let entries = list["pieces"].as_array().expect("a list");
    let text = folder.read(whole);
    let of_whole = faces(&text);
    let rank: BTreeMap<&Face, usize> = of_whole.iter().zip(0..).collect();
    assert_eq!(rank.len(), of_whole.len(), "no two faces are the same");
    let mut all = 0;
    let (mut sizes, mut area) = (Vec::new(), 0.0);
    for (number, entry) in entries.iter().enumerate() {
        let name = format!("piece_{number:05}.obj");
        assert_eq!(entry["file"], name.as_str());
        let text = folder.read(&format!("{pieces}/{name}"));
        let own = faces(&text);
        let count = own.len();
        let ranks = own
            .iter()
            .map(|face| rank.get(face).expect("a face of the whole"));
        assert!(ranks.is_sorted_by(|a, b| a < b), "as they are in the whole");
        all += count;
        assert_eq!(entry["faces"], count);
        assert_eq!(entry["vertices"], Plain::read(&text).vertices.len());
        for (key, which) in [("objects", 0), ("groups", 1), ("materials", 2)] {
            // A face may be in several groups.
            let names = own.iter().flat_map(|(state, _)| match key {
                "groups" => state[which].split(' ').collect(),
                _ => vec![&*state[which]],
            });
            let names: BTreeSet<&str> = names.filter(|name| !name.is_empty()).collect();
            let told = entry[key].as_array().expect("names");
            assert_eq!(told.len(), names.len(), "{key} of {name}");
            let told = told.iter().map(|name| name.as_str().expect("a name"));
            assert_eq!(told.collect::<BTreeSet<_>>(), names, "{key} of {name}");
        }
        // It is a mesh, in one piece, for whoever reads it.
        let document = Document::read(text.as_bytes()).expect("what we wrote");
        let mesh = document.mesh().expect("a manifold");
        assert_eq!(mesh.components().count(), 1, "{name}");
        assert!(
            mesh.vertices().all(|v| mesh.half_edge_of(v).is_some()),
            "{name}"
        );
        sizes.push(count);
        area += entry["area"].as_f64().expect("an area");
    }
    assert!(sizes.is_sorted_by(|a, b| a >= b), "{sizes:?}");
    assert_eq!(all, of_whole.len(), "every face of the whole is in a piece");
    let of_whole = Plain::read(&text).area();
    assert!(
        (area - of_whole).abs() < 1e-9 * of_whole,
        "{area}, {of_whole}"
    );
    sizes
}

/// A box of quads with a name for each side, texture coordinates and normals, extra numbers and seams.
const BOX: &str = include_str!("box.obj");

#[test]
fn pieces_keep_names_texture_coordinates_and_normals() {
    let folder = Folder::new();
    folder.write("box.obj", BOX);
    let planes = "--plane 0.4,0,0:1,0.1,0 --plane 0,0.3,0.2:0,1,0.3";
    folder.done(&format!("cut box.obj {planes} --pieces p -o out.obj"));
    assert_eq!(check(&folder, "out.obj", "p").len(), 4);
    let first = folder.read("p/piece_00000.obj");
    assert!(first.starts_with("mtllib box.mtl\nv "), "{first}");
    // A slit leaves one piece, which is torn all the same.
    let slit = "--rays 0.5,0.5,9:0,0,-1 0.6,-0.2,9:0,0,-1";
    folder.done(&format!("cut box.obj {slit} --pieces q -o slit.obj"));
    assert_eq!(check(&folder, "slit.obj", "q").len(), 1);
}

/// What was torn in an earlier session too, and the paper's methods, which leave crumbs and bow-ties.
#[test]
fn pieces_of_what_was_torn_before_and_of_crumbs_are_meshes() {
    let folder = Folder::new();
    let mut fans = 0;
    for (file, rays) in [
        ("flag", "--rays 0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1"),
        ("sheet", "--rays 0.1,0.1,5:0,0,-1 0.8,0.7,5:0,0,-1"),
    ] {
        for method in ["uniform", "alternating", "partition", "exact"] {
            let name = format!("{file}_{method}");
            let line = format!("cut {file}.obj {rays} --method {method} -v");
            let said = folder.done(&format!("{line} --pieces {name} -o {name}.obj"));
            fans += usize::from(said.contains("[W-OBJ-FANS]"));
            check(&folder, &format!("{name}.obj"), &name);
            let again = "--plane 0,0.1,0:0.2,1,0 --allow-miss";
            folder.done(&format!(
                "cut {name}.obj {again} --pieces {name}2 -o again.obj"
            ));
            check(&folder, "again.obj", &format!("{name}2"));
        }
    }
    assert!(fans > 0, "a vertex of several fans");
}

/// A run into the same folder that failed, at whatever piece, blocks none after it: with more pieces than before, or
/// fewer.
#[test]
fn regression_pieces_that_failed_can_be_written_again() {
    let folder = Folder::new();
    let cut = |planes: &str| format!("cut flag.obj {planes} --pieces p -q -o x.obj");
    let four = cut("--plane 0.3,0,0:1,0,0 --plane 0,0.1,0:0,1,0");
    for before in ["", "--plane 0.3,0,0:1,0,0"] {
        for blocked in 0..4 {
            let name = format!("p/piece_{blocked:05}.obj");
            if before.is_empty() {
                // What lies there is a folder, of an earlier run by its list.
                let list = format!("{{\"file\": \"{}\"}}", &name[2..]);
                let list = format!("{{\"schema\": \"tearmesh.pieces/1\", \"pieces\": [{list}]}}");
                folder.write("p/pieces.json", list);
            } else {
                folder.done(&cut(before));
                let list = folder.read("p/pieces.json");
                let more = format!("\"pieces\": [{{\"file\": \"{}\"}},", &name[2..]);
                folder.write("p/pieces.json", list.replacen("\"pieces\": [", &more, 1));
            }
            let _none = std::fs::remove_file(folder.path(&name));
            std::fs::create_dir(folder.path(&name)).expect("a folder");
            let said = folder.ends(&four, 7);
            assert!(said.contains(&name), "{said}");
            std::fs::remove_dir(folder.path(&name)).expect("a folder");
            let again = if blocked % 2 == 0 {
                four.clone()
            } else {
                cut("--plane 0.3,0,0:1,0,0")
            };
            folder.done(&again);
            let pieces = check(&folder, "x.obj", "p").len();
            assert_eq!(pieces, if blocked % 2 == 0 { 4 } else { 2 });
            assert_eq!(folder.list("p").len(), pieces + 1);
            std::fs::remove_dir_all(folder.path("p")).expect("pieces");
        }
    }
}

//! Documents from what obj-rs has read.

use std::collections::HashMap;

use obj::raw::RawObj;
use obj::raw::object::{Group, Polygon, Range};
use tearmesh_obj::Document;

use super::differential::{self, Outcome};
use super::random::Random;
use super::{positions, read, text, write_as};

fn raw(file: &str) -> RawObj {
    obj::raw::parse_obj(file.as_bytes()).expect("obj-rs reads it")
}

/// What is written of a document whose triangles are a mesh.
fn written(document: &Document) -> String {
    let mesh = document.mesh().unwrap_or_else(|error| panic!("{error}"));
    text(&write_as(document, &mesh, &positions(document)))
}

/// A triangle by hand.
fn triangle() -> RawObj {
    raw("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n")
}

#[test]
fn everything_that_obj_rs_keeps_arrives() {
    let file = "mtllib a.mtl b.mtl\no two words\nv 0 0 0\nv 1 0 0 0.5\nv 1 1 0\nv 0 1 0\nv 2 0 0\n\
                vt 0.5\nvt 0 1\nvt 0 0 1\nvn 0 0 1\nvp 0.5 0.25\n\
                p 1 5\ng seam\nl 1 2\ns 1\nl 1/1 5/2\nusemtl red\nf 1/1/1 2/2/1 3/3/1 4/1/1\n\
                s off\ng default\nmg 2\nf 2//1 5//1 3//1\n";
    let document = Document::try_from(&raw(file)).expect("sound");
    assert_eq!(
        written(&document),
        "mtllib a.mtl b.mtl\no two words\nv 0 0 0\nv 1 0 0 0.5\nv 1 1 0\nv 0 1 0\nv 2 0 0\n\
         vt 0.5 0\nvt 0 1\nvt 0 0 1\nvn 0 0 1\nvp 0.5 0.25 1\n\
         p 1\np 5\ng seam\nl 1 2\ns 1\nl 1/1 5/2\nusemtl red\nf 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/1/1\n\
         g default\ns off\nmg 2\nf 2//1 5//1 3//1\n"
    );
    assert_eq!(document.line_of_triangle(2), 24);
}

fn group(start: usize, end: usize) -> Group {
    Group {
        polygons: vec![Range { start, end }],
        ..Group::default()
    }
}

#[test]
fn the_order_of_a_hash_map_does_not_show() {
    let groups = (0..40).map(|i| (format!("g{i}"), group(0, 1)));
    let [one, other] = [groups.clone().collect(), groups.rev().collect()].map(|groups| {
        let mut raw = triangle();
        raw.groups = groups;
        written(&Document::try_from(&raw).expect("sound"))
    });
    assert_eq!(one, other);
    assert!(one.contains("g g0 g1 g10 g11 "), "{one}");
}

/// What the reader would refuse is refused with its words; and what no text can hold. Each is said in a line of the
/// text beside this file.
#[test]
fn raw_files_are_refused_as_by_the_reader() {
    let smooth = HashMap::from([1, 2].map(|number| (number, group(0, 1))));
    let silk = HashMap::from([("silk".to_owned(), group(1, 0))]);
    let damages: [&dyn Fn(&mut RawObj); 7] = [
        &|raw| raw.polygons.clear(),
        &|raw| raw.meshes.clone_from(&silk),
        &|raw| raw.smoothing_groups.clone_from(&smooth),
        &|raw| raw.positions[1].1 = f32::NAN,
        &|raw| raw.polygons.push(Polygon::P(vec![0, 1, usize::MAX])),
        &|raw| raw.name = Some("a\nf 1 1 1".to_owned()),
        &|raw| raw.material_libraries.push("a\\".to_owned()),
    ];
    let refused = damages.map(|damage| {
        let mut raw = triangle();
        damage(&mut raw);
        let error = Document::try_from(&raw).expect_err("refused");
        format!("{error}\n")
    });
    assert_eq!(refused.concat(), include_str!("raw.txt"));
}

/// The reader's document, but for the losses that `raw.rs` lists.
fn agree(file: &str, raw: &RawObj) {
    let ours = read(file.as_bytes());
    let theirs = Document::try_from(raw).unwrap_or_else(|error| panic!("{error}:\n{file}"));
    let polygons = |document: &Document| {
        let all = (0..document.polygon_count()).map(|p| document.polygon(p).collect());
        all.collect::<Vec<Vec<_>>>()
    };
    assert_eq!(polygons(&ours), polygons(&theirs));
    // Numbers as `f32` are those that `differential` has compared.
    for (point, &(x, y, z, _)) in theirs.positions().iter().zip(&raw.positions) {
        assert_eq!(<[f64; 3]>::from(*point), [x, y, z].map(f64::from));
    }
    let counts = [&ours, &theirs].map(|one| (one.texture_count(), one.normals().len()));
    assert_eq!(counts[0], counts[1]);
    // The same groups, materials and smoothing, face by face, in what is written.
    let (Ok(our_mesh), Ok(their_mesh)) = (ours.mesh(), theirs.mesh()) else {
        return;
    };
    let [ours, theirs] = [(&ours, our_mesh), (&theirs, their_mesh)]
        .map(|(document, mesh)| write_as(document, &mesh, &positions(document)));
    if let (Ok(ours), Ok(theirs)) = (
        obj::raw::parse_obj(&ours[..]),
        obj::raw::parse_obj(&theirs[..]),
    ) {
        assert_eq!(ours.polygons.len(), theirs.polygons.len());
        let of_faces = |one: &RawObj| {
            let smooth = of_faces(&one.smoothing_groups);
            (of_faces(&one.groups), of_faces(&one.meshes), smooth)
        };
        assert_eq!(of_faces(&ours), of_faces(&theirs), "{file}");
        let names = |one: RawObj| (one.name, one.material_libraries, one.points, one.lines);
        assert_eq!(names(ours), names(theirs), "{file}");
    } else {
        // Lines come first, so a face without a material may follow a line that has one.
        let theirs = String::from_utf8_lossy(&theirs);
        assert!(
            theirs.contains("\nusemtl\n"),
            "obj-rs reads the input, so the output too:\n{theirs}"
        );
    }
}

/// The group of each face.
fn of_faces<K: Clone + Ord>(groups: &HashMap<K, Group>) -> Vec<(usize, K)> {
    let members = |(name, group): (&K, &Group)| {
        let faces = group
            .polygons
            .iter()
            .flat_map(|range| range.start..range.end);
        let name = name.clone();
        faces.map(|face| (face, name.clone())).collect::<Vec<_>>()
    };
    let mut all: Vec<_> = groups.iter().flat_map(members).collect();
    all.sort();
    all
}

/// What obj-rs reads without loss arrives as we read it; whether it does.
fn agrees(bytes: &[u8]) -> bool {
    let Some(text) = differential::lossless(bytes) else {
        return false;
    };
    match differential::check(bytes) {
        Outcome::Lossy => false,
        Outcome::Refused => {
            let refused = Document::try_from(&raw(&text));
            assert!(refused.is_err(), "the reader refuses it:\n{text}");
            true
        }
        Outcome::Same => {
            let theirs = raw(&text);
            // A name may end with a backslash that a blank follows; nothing can write that.
            if !text.contains('\\') {
                agree(&text, &theirs);
            }
            true
        }
    }
}

#[test]
fn documents_are_those_of_the_reader() {
    let head = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.1 1e-3 7\nvt 0 0\nvt 0.3 1\nvn 0 0 1\n";
    let faces = [
        "f 1 2 3\n",
        "f 1/1 3/2 4/1\n",
        "f 2//1 5//1 3//1\n",
        "fo 1/1/1 2/2/1 3/1/1 4/1/1\n",
    ];
    let between = ",g a,g b,g default,usemtl red,usemtl blue,s 1,s off,s 2,o x y,l 1 2,p 3,l 1/1 2/2,mtllib m.mtl";
    let between: Vec<&str> = between.split(',').collect();
    let mut random = Random(1);
    let mut same = 0;
    for _ in 0..3000 {
        let mut file = head.to_owned();
        for _ in 0..1 + random.below(6) {
            for _ in 0..random.below(4) {
                file += &format!("{}\n", between[random.below(between.len())]);
            }
            file += faces[random.below(faces.len())];
        }
        same += usize::from(agrees(file.as_bytes()));
    }
    assert!(same > 2500, "{same} of 3000");
}

#[test]
fn documents_of_real_files_are_those_of_the_reader() {
    let Some(folder) = std::env::var_os("TEARMESH_CORPUS") else {
        return; // `corpus.rs` says so.
    };
    let mut same = 0;
    for path in super::corpus::files(folder.as_ref()) {
        let bytes = std::fs::read(&path).expect("the file can be read");
        same += usize::from(agrees(&bytes));
    }
    assert!(same > 50, "{same}");
}

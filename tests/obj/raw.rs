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
    let said: Vec<String> = document
        .diagnostics()
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        said,
        [
            "line 20: 1 face with more than 3 corners is cut into 2 triangles",
            "line 12, column 1: `vp` is not interpreted, and is kept as it is (1 statement)",
            "line 13, column 1: `p` elements are kept, but never cut (2 statements, the first here)",
            "line 16, column 1: `l` elements are kept, but never cut (2 statements, the first here)",
        ]
    );
    assert_eq!(document.line_of_triangle(2), 24);
}

#[test]
fn the_order_of_a_hash_map_does_not_show() {
    let names: Vec<String> = (0..40).map(|i| format!("g{i}")).collect();
    let make = |names: &mut dyn Iterator<Item = &String>| {
        let mut raw = triangle();
        raw.groups = names
            .map(|name| {
                let polygons = vec![Range { start: 0, end: 1 }];
                (
                    name.clone(),
                    Group {
                        polygons,
                        ..Group::default()
                    },
                )
            })
            .collect();
        written(&Document::try_from(&raw).expect("sound"))
    };
    let one = make(&mut names.iter());
    assert_eq!(one, make(&mut names.iter().rev()));
    assert!(one.contains("g g0 g1 g10 g11 "), "{one}");
}

#[test]
fn it_is_as_strict_as_the_reader() {
    type Break = fn(&mut RawObj);
    let range = |start, end| Group {
        polygons: vec![Range { start, end }],
        ..Group::default()
    };
    let groups = |start, end| HashMap::from([("silk".to_owned(), range(start, end))]);
    let cases: [(Break, &str); 18] = [
        (
            |raw| raw.polygons.clear(),
            "cannot read: `g` \"default\" covers 0 up to 1, of 0",
        ),
        (
            |raw| raw.positions[1].1 = f32::NAN,
            "line 2, column 5: `NaN` is not a finite number",
        ),
        (
            |raw| raw.positions[1].3 = f32::INFINITY,
            "line 2, column 9: `inf` is not a finite number",
        ),
        (
            |raw| raw.tex_coords[0].2 = f32::NAN,
            "line 4, column 8: `NaN` is not a finite number",
        ),
        (
            |raw| raw.normals[0].0 = f32::NEG_INFINITY,
            "line 5, column 4: `-inf` is not a finite number",
        ),
        (
            |raw| raw.polygons.push(Polygon::P(vec![0, 1, 3])),
            "line 7, column 7: vertex 4 does not exist: the file has 3 vertices",
        ),
        (
            |raw| raw.polygons.push(Polygon::P(vec![0, 1, usize::MAX])),
            "line 7, column 7: vertex index beyond the limit of 2147483648",
        ),
        (
            |raw| raw.polygons.push(Polygon::PT(vec![(0, 0), (1, 1), (2, 0)])),
            "line 7, column 9: texture coordinate 2 does not exist: the file has 1 texture coordinate",
        ),
        (
            |raw| raw.polygons.push(Polygon::PN(vec![(0, 0), (1, 0), (2, 7)])),
            "line 7, column 16: normal 8 does not exist: the file has 1 normal",
        ),
        (
            |raw| raw.polygons.push(Polygon::P(vec![0, 1])),
            "line 7, column 6: a face needs 3 corners, this one has 2",
        ),
        (
            |raw| raw.polygons.push(Polygon::P((0..5000).collect())),
            "line 7, column 19376: this face has more than 4096 corners",
        ),
        (
            |raw| raw.polygons.push(Polygon::P(vec![2, 0, 2])),
            "line 7, column 7: this face has vertex 3 twice",
        ),
        (
            |raw| raw.name = Some("a\nf 1 1 1".to_owned()),
            "cannot read: no file has the name \"a\\nf_1_1_1\" after `o`",
        ),
        (
            |raw| raw.material_libraries.push("my cloth.mtl".to_owned()),
            "cannot read: no file has the name \"my cloth.mtl\" after `mtllib`",
        ),
        (
            |raw| raw.material_libraries.push("a\\".to_owned()),
            "cannot read: no file has the name \"a\\\\\" after `mtllib`",
        ),
        (
            |raw| raw.material_libraries.push(String::new()),
            "cannot read: no file has the name \"\" after `mtllib`",
        ),
        (
            |raw| {
                raw.groups.extend([(
                    "two words".to_owned(),
                    Group {
                        polygons: vec![Range { start: 0, end: 1 }],
                        ..Group::default()
                    },
                )]);
            },
            "cannot read: no file has the name \"two words\" after `g`",
        ),
        (|raw| raw.param_vertices.push((f32::NAN, 0.0, 0.0)), ""),
    ];
    for (damage, expected) in cases {
        let mut raw = triangle();
        damage(&mut raw);
        let error = Document::try_from(&raw).map(|_| ());
        let error = error.map_or_else(|error| error.to_string(), |()| String::new());
        assert_eq!(error, expected);
    }
    let refused = |change: &dyn Fn(&mut RawObj)| {
        let mut raw = triangle();
        change(&mut raw);
        Document::try_from(&raw).expect_err("refused").to_string()
    };
    assert_eq!(
        refused(&|raw| raw.groups = groups(0, 2)),
        "cannot read: `g` \"silk\" covers 0 up to 2, of 1"
    );
    assert_eq!(
        refused(&|raw| raw.meshes = groups(1, 0)),
        "cannot read: `usemtl` \"silk\" covers 1 up to 0, of 1"
    );
    assert_eq!(
        refused(&|raw| raw.meshes.extend(groups(0, 1))),
        "cannot read: `usemtl` of one element is [\"\", \"silk\"]"
    );
    assert_eq!(
        refused(&|raw| raw
            .smoothing_groups
            .extend([(1, range(0, 1)), (2, range(0, 1))])),
        "cannot read: `s` of one element is [\"1\", \"2\"]"
    );
}

/// The reader's document, but for the losses that `raw.rs` lists.
fn agree(file: &str, theirs: &RawObj) {
    let ours = read(file.as_bytes());
    let theirs = Document::try_from(theirs).unwrap_or_else(|error| panic!("{error}:\n{file}"));
    assert_eq!(ours.positions().len(), theirs.positions().len());
    for (p, q) in ours.positions().iter().zip(theirs.positions()) {
        for axis in 0..3 {
            let near = p[axis] as f32;
            assert!([near, near.next_up(), near.next_down()].contains(&(q[axis] as f32)));
        }
    }
    assert_eq!(ours.texture_count(), theirs.texture_count());
    assert_eq!(ours.normals().len(), theirs.normals().len());
    assert_eq!(ours.polygon_count(), theirs.polygon_count());
    for polygon in 0..ours.polygon_count() {
        assert!(
            ours.polygon(polygon).eq(theirs.polygon(polygon)),
            "face {polygon}"
        );
    }
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
        assert_eq!(of_faces(&ours.groups), of_faces(&theirs.groups), "{file}");
        assert_eq!(of_faces(&ours.meshes), of_faces(&theirs.meshes), "{file}");
        assert_eq!(
            of_faces(&ours.smoothing_groups),
            of_faces(&theirs.smoothing_groups),
            "{file}"
        );
        assert_eq!(ours.name, theirs.name);
        assert_eq!(ours.material_libraries, theirs.material_libraries);
        assert_eq!(ours.points, theirs.points);
        assert_eq!(ours.lines, theirs.lines);
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
    let between = [
        "",
        "g a\n",
        "g b\n",
        "g default\n",
        "usemtl red\n",
        "usemtl blue\n",
        "s 1\n",
        "s off\n",
        "s 2\n",
        "o x y\n",
        "l 1 2\n",
        "p 3\n",
        "l 1/1 2/2\n",
        "mtllib m.mtl\n",
    ];
    let mut random = Random(1);
    let mut same = 0;
    for _ in 0..3000 {
        let mut file = head.to_owned();
        for _ in 0..1 + random.below(6) {
            for _ in 0..random.below(4) {
                file += between[random.below(between.len())];
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
    for entry in std::fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "obj") {
            let bytes = std::fs::read(&path).expect("the file can be read");
            same += usize::from(agrees(&bytes));
        }
    }
    assert!(same > 50, "{same}");
}

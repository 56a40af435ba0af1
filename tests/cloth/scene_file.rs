//! Scene files as data: every fault of a file is found, and what is outside of it is asked for by name.
//!
//! That each key means something, and refuses what it does not mean, is tested where the guide to them is: by the
//! command.

use serde_json::{Value, json};
use tearmesh::{Point, Vector, VertexId};
use tearmesh_cloth::scene::file::{self, BodyMesh, PackedScene, SceneFault, SceneFile};
use tearmesh_cloth::scene::{Axis, Frame, Region, Run, Scene};
use tearmesh_cloth::{ColliderShape, Method};

use crate::digest;
use crate::parts::scenes::{play, square};

/// A tetrahedron.
fn body() -> BodyMesh {
    let places = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    (
        places
            .map(|place| Point::from(place) * 0.4 - Vector::z())
            .to_vec(),
        faces,
    )
}

/// A scene with something of everything.
const EVERYTHING: &str = r#"{
    "seconds": 0.2,
    "fabric": { "stretch_n_per_m": 300, "bend_law": "buckling", "rigidity_n_m": 1e-5, "buckles_below": 0.9 },
    "wind": { "velocity_m_per_s": [0, 0, 3], "coefficient": 1, "from_s": 0.01, "sway_m_per_s": [0, 0, 1], "period_s": 0.3 },
    "collider": [
        { "point": [0, -0.3, 0], "normal": [0, 1, 0] },
        { "centre": [0.5, 0.5, -0.2], "radius_m": 0.1, "friction": 0.3 },
        { "body": "rock.obj", "cell_m": 0.03, "moves": [[0, 0, 0, 0], [0.2, 0.1, 0, 0.3]], "friction": 0.4 }
    ],
    "hold": [
        { "across": [0, 1], "along": [1, 1] },
        {
            "near": [0.5, 0.1], "radius": 0.05, "from_s": 0.02, "until_s": 0.15,
            "moves": [[0.02, 0, 0, 0], [0.1, 0, -0.3, 0.1]]
        }
    ],
    "cut": [{ "at_s": 0.05, "rays": ["0.3,0.5,3:0,0.1,-0.7", "0.7,0.5,3:0,0.1,-0.7"] }],
    "tear": { "threshold": 1.5 },
    "strength": [{ "vertices": [8], "factor": 2.5 }]
}"#;

/// What [`EVERYTHING`] makes of a square of a metre.
pub(crate) fn everything(frame: &Frame) -> Scene {
    let file: SceneFile = serde_json::from_str(EVERYTHING).expect("a scene file");
    file.on(frame, None, &mut |_, _| Ok(body()))
        .expect("a scene")
}

fn on(data: Value, typed: Option<&Method>) -> (Result<Scene, Vec<SceneFault>>, Vec<String>) {
    let file: SceneFile = serde_json::from_value(data).expect("a scene file");
    let (mesh, positions) = square(4);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let mut asked = Vec::new();
    let made = file.on(&frame, typed, &mut |number, name| {
        asked.push(format!("{number}: {name}"));
        match name {
            "missing.obj" => Err(format!("there is no {name}")),
            _ => Ok(body()),
        }
    });
    (made, asked)
}

#[test]
fn tables_replace_those_of_the_base() {
    let (made, asked) = on(
        json!({
            "base": "flag",
            "gravity_m_per_s2": [0, 0, -1],
            "hold": [{ "vertices": [1, 5] }, { "along": [0.5, 1], "from_s": 0.5 }],
            "collider": [
                { "body": "rock.obj" },
                { "point": [0, 0, -1], "normal": [0, 0, 1] },
                { "centre": [0, 0, -1], "radius_m": 0.5, "friction": 0 },
            ],
            "cut": [{ "rays": ["0,0,1:0,0,-1 0,1,1:0,0,-1"], "at_s": 0.2 }],
        }),
        None,
    );
    let scene = made.expect("a scene");
    assert_eq!(asked, ["0: rock.obj"]);
    assert_eq!(scene.gravity_m_per_s2, Vector::new(0.0, 0.0, -1.0));
    let named = |ids: &[usize]| {
        let ids = ids.iter().filter_map(|&id| VertexId::new(id));
        Region::Vertices(ids.collect())
    };
    assert_eq!(scene.holds[0].region, named(&[0, 4]));
    assert_eq!((scene.holds.len(), scene.cuts.len()), (2, 1));
    assert!(matches!(
        scene.colliders[0].shape,
        ColliderShape::Body { .. }
    ));
    let frictions = scene.colliders.iter().map(|it| it.friction);
    assert!(frictions.eq([Scene::FRICTION, Scene::FRICTION, 0.0]));
    assert!(
        scene.wind.is_some() && scene.tearing.is_none(),
        "those of the flag"
    );
}

/// One fault does not hide another.
#[test]
fn all_faults_are_found_with_their_tables() {
    let (made, asked) = on(
        json!({
            "solver": { "method": "verlet", "sweeps": 3 },
            "wind": { "coefficient": 1 },
            "hold": [{ "near": [0, 0] }, {}, { "near": [0, 0], "vertices": [1] }],
            "collider": [{ "body": "missing.obj" }, { "centre": [0, 0, 0] }],
            "tear": { "never": true, "threshold_n": 5 },
            "strength": [{ "near": [0, 0] }],
        }),
        None,
    );
    let faults = made.expect_err("eight faults");
    let places = faults
        .iter()
        .map(|one| (one.table, one.number, one.key, one.code));
    let expected = [
        ("solver", 0, "sweeps", "E-SCENE-CLASH"),
        ("wind", 0, "", "E-SCENE-MISSING"),
        ("collider", 0, "body", "E-SCENE-BODY"),
        ("collider", 1, "", "E-SCENE-MISSING"),
        ("hold", 1, "", "E-SCENE-MISSING"),
        ("hold", 2, "vertices", "E-SCENE-CLASH"),
        ("strength", 0, "", "E-SCENE-MISSING"),
        ("tear", 0, "threshold_n", "E-SCENE-CLASH"),
    ];
    assert!(places.eq(expected), "{faults:?}");
    assert_eq!(asked, ["0: missing.obj"]);
    assert_eq!(
        faults[4].to_string(),
        "[hold] 2: a hold must have one of across, centre, from, near, vertices"
    );
}

/// A method that is typed reads the keys of its own, beside one of the file.
#[test]
fn a_typed_method_stands_for_that_of_the_file() {
    let data = json!({ "solver": { "method": "xpbd", "sweeps": 3, "dt_s": 0.01 } });
    let scene = on(data.clone(), Some(&Method::pbd())).0.expect("a scene");
    assert!(matches!(scene.solver, Method::Pbd(pbd) if pbd.sweeps == 3));
    assert_eq!(scene.step_s, Some(0.01));
    let refused = on(
        json!({ "solver": { "tolerance": 1 } }),
        Some(&Method::pbd()),
    )
    .0;
    assert_eq!(refused.expect_err("no such key")[0].key, "tolerance");
}

/// Rows of the table beside this file: a region, and the vertices in it of a sheet of 4 × 4 cells.
#[test]
fn regions_hold_what_lies_in_them() {
    let (mesh, positions) = square(4);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    for row in include_str!("regions.txt").lines() {
        let (region, expected) = row.split_once(" => ").expect("vertices");
        let hold: Value = serde_json::from_str(region).expect(row);
        let scene = on(json!({ "hold": [hold] }), None).0.expect(row);
        let found = scene.holds[0]
            .region
            .vertices(&mesh, positions.as_slice(), &frame);
        let found: Vec<String> = found.iter().map(|v| v.index().to_string()).collect();
        assert_eq!(found.join(" "), expected, "{row}");
    }
}

fn digest_of(run: Run) -> u64 {
    let run = play(run);
    let bits = run.cloth().positions().iter().flat_map(|x| [x.x, x.y, x.z]);
    let bytes = bits.flat_map(f64::to_le_bytes);
    let faces = run.mesh().indices().iter().flat_map(|v| v.to_le_bytes());
    digest::after(digest::EMPTY, bytes.chain(faces))
}

/// A program that opens no files plays the same as the one that packed the scene.
#[test]
fn a_scene_that_was_packed_plays_the_same() {
    let (mesh, positions) = square(16);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let run = |scene| Run::new(mesh.clone(), &positions, scene, &frame).expect("a scene");
    let [number, id] = [7, 20].map(|v| VertexId::new(v).expect("an id"));
    let mut scene = everything(&frame);
    scene.rename_vertices(|named| if named == number { id } else { named });
    scene.rest = mesh
        .indices()
        .iter()
        .map(|&v| positions.as_slice()[v as usize])
        .collect();
    let packed = PackedScene::new(EVERYTHING.to_owned(), &scene, vec![(number, id)]);
    let data = serde_json::to_string(&packed).expect("data");

    let packed: PackedScene = serde_json::from_str(&data).expect("it is read");
    let file = serde_json::from_str(&packed.text).expect("a scene file");
    let again = packed.on(&file, &frame).expect("a scene");
    assert_eq!(again.strengths, [(Region::Vertices(vec![id]), 2.5)]);
    assert_eq!(format!("{again:?}"), format!("{scene:?}"));
    assert_eq!(digest_of(run(again)), digest_of(run(scene)));
}

/// The format of scene files, and the digest of all names in them.
const FORMAT: (u32, u64) = (5, 0x45a6_b7b9_4b44_c3d3);

/// The names of the fields of a table, as it lists them where it is given another one.
fn fields<T: for<'de> serde::Deserialize<'de> + std::fmt::Debug>(table: &str) -> String {
    let refused = serde_json::from_str::<T>(r#"{ "unknown": 1 }"#);
    let said = refused.expect_err("no such field").to_string();
    let names = said.split('`').skip(3).step_by(2);
    names.map(|name| format!("{table}.{name} ")).collect()
}

/// The committed module of `play` reads scenes of one format.
#[test]
fn files_with_other_names_are_of_another_format() {
    let names = [
        fields::<SceneFile>(""),
        fields::<file::FabricTable>("fabric"),
        fields::<file::SolverTable>("solver"),
        fields::<file::WindTable>("wind"),
        fields::<file::ColliderTable>("collider"),
        fields::<file::HoldTable>("hold"),
        fields::<file::SeamTable>("seam"),
        fields::<file::CutTable>("cut"),
        fields::<file::TearTable>("tear"),
        fields::<file::StrengthTable>("strength"),
    ];
    let digest = digest::after(digest::EMPTY, names.concat().bytes());
    assert_eq!(
        FORMAT,
        (SceneFile::FORMAT, digest),
        "raise SceneFile::FORMAT, and write its digest here: {digest:#018x}"
    );
}

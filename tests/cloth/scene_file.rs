//! Scene files as data: every fault of a file is found, and what is outside of it is asked for by name.
//!
//! That each key means something, and refuses what it does not mean, is tested where the guide to them is: by the
//! command.

use serde_json::{Value, json};
use tearmesh::{Point, Ray, Vector};
use tearmesh_cloth::scene::file::{Outside, SceneFault, SceneFile};
use tearmesh_cloth::scene::{Axis, Frame, Region, Scene};
use tearmesh_cloth::{ColliderShape, Method};

use crate::parts::scenes::square;

/// A tetrahedron for each body, and rays down at two places; notes what it is asked for.
#[derive(Default)]
struct Asked(Vec<String>);

impl Outside for Asked {
    fn rays(&mut self, texts: &[String], number: usize) -> Option<[Ray; 2]> {
        self.0.push(format!("{number}: {}", texts.join(" ")));
        let down = |x| Ray::new(Point::new(x, 0.5, 1.0), Vector::new(0.0, 0.0, -1.0)).ok();
        Some([down(0.2)?, down(0.8)?])
    }

    fn body(&mut self, name: &str, number: usize) -> Option<(Vec<Point>, Vec<[u32; 3]>)> {
        self.0.push(format!("{number}: {name}"));
        let places = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        (name != "missing.obj").then(|| (places.map(Point::from).to_vec(), faces))
    }
}

fn on(data: Value, typed: Option<&Method>) -> (Result<Scene, Vec<SceneFault>>, Vec<String>) {
    let file: SceneFile = serde_json::from_value(data).expect("a scene file");
    let (mesh, positions) = square(4);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let mut asked = Asked::default();
    let made = file.on(&frame, typed, &mut asked);
    (made, asked.0)
}

#[test]
fn tables_replace_those_of_the_base() {
    let (made, asked) = on(
        json!({
            "base": "flag",
            "gravity_m_per_s2": [0, 0, -1],
            "hold": [{ "vertices": [1, 5] }, { "along": [0.5, 1], "from_s": 0.5 }],
            "collider": [{ "body": "rock.obj" }, { "point": [0, 0, -1], "normal": [0, 0, 1] }],
            "cut": [{ "rays": ["a", "b"], "at_s": 0.2 }],
        }),
        None,
    );
    let scene = made.expect("a scene");
    assert_eq!(asked, ["0: rock.obj", "0: a b"]);
    assert_eq!(scene.gravity_m_per_s2, Vector::new(0.0, 0.0, -1.0));
    let named = |ids: &[usize]| {
        let ids = ids.iter().filter_map(|&id| tearmesh::VertexId::new(id));
        Region::Vertices(ids.collect())
    };
    assert_eq!(scene.holds[0].region, named(&[0, 4]));
    assert_eq!((scene.holds.len(), scene.cuts.len()), (2, 1));
    assert!(matches!(
        scene.colliders[0].shape,
        ColliderShape::Body { .. }
    ));
    assert!(
        scene.wind.is_some() && scene.tearing.is_none(),
        "those of the flag"
    );
}

/// One fault does not hide another, and what is outside tells its own.
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
    let faults = made.expect_err("seven faults");
    let places = faults
        .iter()
        .map(|one| (one.table, one.number, one.key, one.code));
    let expected = [
        ("solver", 0, "sweeps", "E-SCENE-CLASH"),
        ("wind", 0, "", "E-SCENE-MISSING"),
        ("collider", 1, "", "E-SCENE-MISSING"),
        ("hold", 1, "", "E-SCENE-MISSING"),
        ("hold", 2, "vertices", "E-SCENE-CLASH"),
        ("strength", 0, "", "E-SCENE-MISSING"),
        ("tear", 0, "threshold_n", "E-SCENE-CLASH"),
    ];
    assert!(places.eq(expected), "{faults:?}");
    assert_eq!(asked, ["0: missing.obj"]);
    assert_eq!(
        faults[3].to_string(),
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

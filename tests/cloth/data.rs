//! Scenes and what they hold, as data: written and read they are the same to the bit, and what cannot be played is
//! not read.

use std::sync::Arc;

use serde_json::{Value, json};
use tearmesh::geometry::Ray;
use tearmesh::{CutMethod, Plane, Point, Vector, VertexId, shapes};
use tearmesh_cloth::scene::{HeldVertices, Region, Run, Scene, TimedCut};
use tearmesh_cloth::{
    Bending, Body, Buckling, Collider, ColliderShape, Fabric, Method, Path, Seam, Tearing,
    Threshold, Weave, implicit,
};

use crate::digest;
use crate::parts::scenes::{play, staged, swaying, top};

/// Everything that a scene can hold, for a sheet of a metre.
fn scene(up: &tearmesh_cloth::scene::Frame) -> Scene {
    let (ball, skin) = shapes::octahedron();
    let skin: Vec<Point> = skin.as_slice().iter().map(|x| x * 0.2).collect();
    let body = Body::new(&skin, ball.indices().as_chunks::<3>().0, Some(0.03)).expect("a body");
    let floor = Plane::new(Point::new(0.0, -0.3, 0.0), Vector::new(0.1, 3.0, 0.0));
    let ray = |x| Ray::new(Point::new(x, 0.5, 3.0), Vector::new(0.0, 0.1, -0.7)).expect("a ray");
    let buckles = Bending::Buckling {
        rigidity_n_m: 1e-5,
        law: Buckling::new(0.9).expect("a law"),
    };
    let pulled = HeldVertices {
        region: Region::Near {
            at: [0.5, 0.1],
            radius: 0.05,
        },
        from_s: 0.02,
        until_s: Some(0.15),
        moves: vec![(0.02, Vector::zeros()), (0.1, Vector::new(0.0, -0.3, 0.1))],
    };
    let mut moved = Collider::body(Arc::new(body)).with_friction(0.4);
    if let ColliderShape::Body { motion, .. } = &mut moved.shape {
        motion.moves = Path::new([(0.0, Point::origin()), (0.2, Point::new(0.1, 0.0, 0.3))]);
    }
    let cut = TimedCut {
        at_s: 0.05,
        rays: [ray(0.3), ray(0.7)],
        through: false,
        method: CutMethod::Exact,
    };
    Scene {
        duration_s: 0.2,
        fabric: Fabric {
            bend: Some(buckles),
            ..Fabric::new(300.0)
        },
        wind: Some(swaying(3.0, 1.0, 0.3)),
        colliders: vec![
            Collider::plane(floor.expect("a plane")),
            Collider::sphere(Point::new(0.5, 0.5, -0.2), 0.1).with_friction(0.3),
            moved,
        ],
        holds: vec![HeldVertices::still(top()), pulled],
        cuts: vec![cut],
        strengths: vec![(
            Region::Vertices(VertexId::new(7).into_iter().collect()),
            2.5,
        )],
        ..Scene::fall(up.up)
    }
}

fn read(data: &Value) -> Result<Scene, String> {
    serde_json::from_str(&data.to_string()).map_err(|error| error.to_string())
}

fn digest_of(run: Run) -> u64 {
    let run = play(run);
    let bits = run.cloth().positions().iter().flat_map(|x| [x.x, x.y, x.z]);
    let bytes = bits.flat_map(f64::to_le_bytes);
    let faces = run.mesh().indices().iter().flat_map(|v| v.to_le_bytes());
    digest::after(digest::EMPTY, bytes.chain(faces))
}

#[test]
fn a_scene_that_was_written_and_read_plays_the_same() {
    let written = staged(16, scene);
    let data = serde_json::to_value(written.scene()).expect("data");
    let again = staged(16, |_| read(&data).expect("a scene"));
    assert_eq!(
        format!("{:?}", again.scene()),
        format!("{:?}", written.scene())
    );
    assert!(
        again.scene().colliders == written.scene().colliders,
        "the grid is made again"
    );
    assert_eq!(digest_of(again), digest_of(written));
}

#[test]
fn methods_fabrics_thresholds_and_ready_scenes_are_read_as_they_were_written() {
    fn same<T>(written: T)
    where
        T: serde::Serialize + for<'de> serde::Deserialize<'de> + std::fmt::Debug,
    {
        let text = serde_json::to_string(&written).expect("data");
        let read: T = serde_json::from_str(&text).expect("it is read");
        assert_eq!(format!("{read:?}"), format!("{written:?}"));
    }
    Method::NAMES.map(Method::named).into_iter().for_each(same);
    same(Method::Implicit(implicit::Settings {
        method: implicit::Method::Bdf2,
        ..implicit::Settings::default()
    }));
    same(Fabric::woven(Weave {
        warp_n_per_m: 800.0,
        weft_n_per_m: 500.0,
        shear_n_per_m: 0.1 + 0.2,
        warp: Vector::new(0.1, 1.0, 0.0),
    }));
    same(Fabric::of_edges(1e-300));
    let axis = Vector::y();
    same(Tearing::new(Threshold::WarpWeft {
        warp: 1.2,
        weft: 1.3,
        axis,
    }));
    for (_, ready) in Scene::PRESETS {
        same(staged(4, ready).scene().clone());
    }
}

#[test]
fn what_cannot_be_played_is_not_read() {
    let good = serde_json::to_value(staged(8, scene).scene()).expect("data");
    let seam = |one: &[usize], other: &[usize]| {
        let side = |numbers: &[usize]| numbers.iter().copied().filter_map(VertexId::new).collect();
        let (name, one, other) = ("side".to_owned(), side(one), side(other));
        serde_json::to_value(Seam { name, one, other }).expect("data")
    };
    read(&good).map(drop).expect("the scene itself");
    for (place, bad, said) in [
        ("/duration_s", json!(-1), "duration_s is -1"),
        (
            "/areal_density_kg_per_m2",
            json!(0),
            "density, step or strength",
        ),
        ("/step_s", json!(0), "density, step"),
        ("/drag_per_s", json!(-0.5), "drag_per_s"),
        ("/fabric/damping_s", json!(-1), "damping_s"),
        (
            "/fabric/stretch/Membrane/modulus_n_per_m",
            json!(0),
            "modulus_n_per_m",
        ),
        ("/fabric/bend/Buckling/law", json!(0.5), "above 0.592"),
        (
            "/colliders/2/shape/Body/motion/moves",
            json!([[1, [0, 0, 0]], [0, [0, 0, 0]]]),
            "times that ascend",
        ),
        (
            "/solver",
            json!({"Pbd": {"sweeps": 1, "stiffness": 2, "bend_stiffness": 0}}),
            "stiffness",
        ),
        ("/wind/period_s", json!(0), "wind.period_s"),
        ("/wind/steady/coefficient", json!(-1), "wind.coefficient"),
        ("/colliders/0/shape/Plane/1", json!([0, 0, 0]), "normal"),
        (
            "/colliders/1/shape/Sphere/radius_m",
            json!(-0.1),
            "radius_m",
        ),
        ("/colliders/1/friction", json!(-0.1), "friction"),
        (
            "/colliders/2/shape/Body/thickness_m",
            json!(1e-9),
            "thickness_m",
        ),
        ("/colliders/2/shape/Body/body/2", json!(1e-9), "too small"),
        (
            "/colliders/2/shape/Body/body/1/0",
            json!([0, 1, 99]),
            "lacks a usable point",
        ),
        ("/holds/1/until_s", json!(0.01), "hold 2"),
        ("/holds/1/moves/1/0", json!(0), "hold 2"),
        ("/cuts/0/at_s", json!(-1), "cut 1"),
        ("/cuts/0/rays/0/1", json!([0, 0, 0]), "direction"),
        (
            "/cuts/0/rays/1",
            good["cuts"][0]["rays"][0].clone(),
            "cut 1",
        ),
        ("/cuts/0/method", json!("Freehand"), "unknown variant"),
        ("/tearing/threshold/Stretch", json!(1), "threshold is 1"),
        ("/tearing/weakening", json!(2), "weakening"),
        ("/strengths/0/1", json!(0), "strength"),
        (
            "/strengths/0/0/Vertices/0",
            json!(u32::MAX),
            "beyond all ids",
        ),
        ("/gravity_m_per_s2", json!([0, null, 0]), "null"),
        ("/seams", json!([seam(&[1, 2], &[3])]), "seam 1"),
    ] {
        let mut data = good.clone();
        *data.pointer_mut(place).expect(place) = bad;
        let why = read(&data).expect_err(place);
        assert!(why.contains(said), "{place}: {why}");
    }
}

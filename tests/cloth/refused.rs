//! Scenes that cannot be played, by their numbers.

use tearmesh::{Point, Vector, VertexId};
use tearmesh_cloth::scene::{Axis, Frame, Region, Run, Scene};
use tearmesh_cloth::{Collider, ColliderShape, Fabric, Orthotropic, Seam, Tearing, Threshold};

use crate::parts::scenes::{square, swaying};
use crate::scene_file::everything;

type Change = fn(&mut Scene);

/// A change of [`everything`], and how the reason begins for which it is then refused.
const REFUSED: [(Change, &str); 47] = [
    (|scene| scene.duration_s = f64::NAN, "NaN s cannot be"),
    (|scene| scene.duration_s = -1.0, "-1 s cannot be"),
    (
        |scene| scene.areal_density_kg_per_m2 = 0.0,
        "the density 0 is not",
    ),
    (
        |scene| scene.step_s = Some(0.0),
        "0.2 s cannot be taken in steps of 0 s",
    ),
    (
        |scene| scene.step_s = Some(1e-30),
        "0.2 s cannot be taken in steps of 0.000000000000000000000000000001 s",
    ),
    (|scene| scene.drag_per_s = -0.5, "drag_per_s is -0.5, and"),
    (|scene| scene.gravity_m_per_s2.y = f64::NAN, "gravity"),
    (|scene| scene.fabric.damping_s = -1.0, "damping_s"),
    (
        |scene| scene.fabric = Fabric::new(0.0),
        "modulus_n_per_m is 0, and has to be finite and above 0",
    ),
    (
        |scene| woven(scene, [0.0, 1.0, 1.0], Vector::x()),
        "orthotropic.warp_n_per_m is 0,",
    ),
    (
        |scene| woven(scene, [1.0, -1.0, 1.0], Vector::x()),
        "orthotropic.weft_n_per_m is -1,",
    ),
    (
        |scene| woven(scene, [1.0, 1.0, -1.0], Vector::x()),
        "orthotropic.shear_n_per_m is -1,",
    ),
    (
        |scene| woven(scene, [1.0; 3], Vector::z()),
        "the face f0 has no area",
    ),
    (
        |scene| woven(scene, [1.0; 3], Vector::zeros()),
        "the face f0 has no area",
    ),
    (|scene| blown(scene, 0.0, 1.0, 0.0), "wind.period_s is 0"),
    (|scene| blown(scene, 0.0, 1.0, -1.0), "wind.period_s is -1"),
    (
        |scene| blown(scene, 0.0, 1.0, f64::NAN),
        "wind.period_s is N",
    ),
    (
        |scene| blown(scene, 0.0, 1.0, f64::INFINITY),
        "wind.period_s is inf",
    ),
    (
        |scene| blown(scene, 1.0, 1.0, 1e-320),
        "wind.period_s is 0.0",
    ),
    (
        |scene| blown(scene, 1.0, f64::NAN, 1.0),
        "wind.sway_m_per_s",
    ),
    (
        |scene| blown(scene, 1.5e308, 1.5e308, 1.0),
        "wind.sway_m_per_s is 15",
    ),
    (
        |scene| blown(scene, -1.5e308, 1.5e308, 1.0),
        "wind.sway_m_per_s is 15",
    ),
    (
        |scene| scene.wind.as_mut().expect("a wind").from_s = -1.0,
        "wind.from_s is -1",
    ),
    (
        |scene| {
            let wind = scene.wind.as_mut().expect("a wind");
            wind.steady.coefficient = -1.0;
        },
        "wind.coefficient",
    ),
    (
        |scene| scene.colliders[0] = Collider::sphere(Point::origin(), -0.1),
        "colliders.radius_m is -0.1",
    ),
    (
        |scene| scene.colliders[1].friction = -0.1,
        "colliders.friction is -0.1",
    ),
    (
        |scene| match &mut scene.colliders[2].shape {
            ColliderShape::Body { thickness_m, .. } => *thickness_m = 1e-9,
            other => panic!("{other:?}"),
        },
        "colliders.thickness_m is 0.000000001",
    ),
    (
        |scene| scene.holds[0].until_s = Some(0.0),
        "the times of hold 1 do not ascend",
    ),
    (
        |scene| scene.holds[1].until_s = Some(0.01),
        "the times of hold 2",
    ),
    (
        |scene| scene.holds[1].moves[1].0 = 0.0,
        "the times of hold 2",
    ),
    (
        |scene| scene.holds[1].region = named(&[]),
        "hold 2 holds no vertex",
    ),
    (
        |scene| scene.holds[0].region = named(&[3, 81]),
        "hold 1 names v81, and the mesh has 81 vertices",
    ),
    (|scene| scene.cuts[0].at_s = -1.0, "cut 1 is at -1 s, "),
    (|scene| scene.cuts[0].at_s = f64::NAN, "cut 1 is at NaN"),
    (
        |scene| scene.cuts[0].at_s = f64::INFINITY,
        "cut 1 is at inf",
    ),
    (
        |scene| scene.cuts[0].rays[1] = scene.cuts[0].rays[0],
        "cut 1",
    ),
    (
        |scene| tears(scene, Threshold::Stretch(0.5)),
        "threshold is 0.5, and has to be finite and above 1",
    ),
    (
        |scene| tears(scene, Threshold::Stretch(1.0)),
        "threshold is 1, and has to be finite and above 1",
    ),
    (
        |scene| tears(scene, Threshold::Force(0.0)),
        "threshold is 0, and has to be finite and above 0",
    ),
    (
        |scene| {
            let (warp, weft, axis) = (1.1, 1.1, Vector::zeros());
            tears(scene, Threshold::WarpWeft { warp, weft, axis });
        },
        "the axis (0, 0, 0) of the warp has no direction",
    ),
    (
        |scene| {
            let tearing = scene.tearing.as_mut().expect("it tears");
            tearing.weakening = Some(1.5);
        },
        "weakening is 1.5, and has to be above 0 and at most 1",
    ),
    (|scene| scene.strengths[0].1 = 0.0, "the strength 0 of v7"),
    (
        |scene| scene.strengths[0].0 = named(&[]),
        "strength 1 contains no vertex",
    ),
    (
        |scene| scene.strengths[0].0 = named(&[3, 81]),
        "strength 1 names v81, and the mesh has 81 vertices",
    ),
    (
        |scene| scene.unpicks = vec![(0.0, "none".to_owned())],
        "unpick 1",
    ),
    (
        |scene| scene.unpicks = vec![(-1.0, "side".to_owned())],
        "unpick 1",
    ),
    (
        |scene| {
            let [one, other] = [&[1, 2][..], &[3]].map(ids);
            let name = "side".to_owned();
            scene.seams = vec![Seam { name, one, other }];
        },
        "seam 1",
    ),
];

fn ids(ids: &[usize]) -> Vec<VertexId> {
    ids.iter().filter_map(|&id| VertexId::new(id)).collect()
}

fn named(vertices: &[usize]) -> Region {
    Region::Vertices(ids(vertices))
}

fn woven(scene: &mut Scene, [warp_n_per_m, weft_n_per_m, shear_n_per_m]: [f64; 3], warp: Vector) {
    scene.fabric = Fabric::orthotropic(Orthotropic {
        warp_n_per_m,
        weft_n_per_m,
        shear_n_per_m,
        warp,
    });
}

fn blown(scene: &mut Scene, steady: f64, sway: f64, period_s: f64) {
    scene.wind = Some(swaying(steady, sway, period_s));
}

fn tears(scene: &mut Scene, threshold: Threshold) {
    scene.tearing = Some(Tearing::new(threshold));
}

#[test]
fn scenes_that_cannot_be_played_are_refused() {
    let (mesh, positions) = square(8);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let made = |change: Change| {
        let mut scene = everything(&frame);
        change(&mut scene);
        Run::new(mesh.clone(), &positions, scene, &frame)
    };
    made(|_| {}).map(drop).expect("the scene itself");
    let wrong = REFUSED.iter().filter_map(|(change, begins)| {
        let why = made(*change).map(drop).expect_err(begins).to_string();
        (!why.starts_with(begins)).then(|| format!("{begins}: {why}"))
    });
    assert_eq!(wrong.collect::<Vec<_>>(), [""; 0]);
}

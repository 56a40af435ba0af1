//! Meshes nobody chose, and cameras for them.

use proptest::prelude::*;
use tearmesh::{Mesh, Point, Positions, Vector};

/// Triangles that share no vertex, anywhere in a cube of side two.
pub(crate) fn soup() -> impl Strategy<Value = (Mesh, Positions)> {
    let corner = || prop::array::uniform3(-1.0..1.0);
    prop::collection::vec(prop::array::uniform3(corner()), 1..12).prop_map(|faces| {
        let triangles: Vec<[u32; 3]> = (0..faces.len() as u32)
            .map(|f| [3 * f, 3 * f + 1, 3 * f + 2])
            .collect();
        let mesh = Mesh::build(3 * faces.len(), &triangles).expect("they share no vertex");
        let points = faces.into_iter().flatten();
        (mesh, Positions::new(points).expect("they are small"))
    })
}

/// A sheet with all its vertices moved about.
pub(crate) fn crumpled() -> impl Strategy<Value = (Mesh, Positions)> {
    prop::collection::vec(prop::array::uniform3(-0.4..0.4), 25).prop_map(|moves| {
        let (mesh, positions) = tearmesh::shapes::grid(4, 4);
        let points = positions.as_slice().iter().zip(moves);
        let points = points.map(|(p, by)| (p - Point::new(0.5, 0.5, 0.0)) * 2.0 + Vector::from(by));
        (
            mesh,
            Positions::new(points.map(Point::from)).expect("they are small"),
        )
    })
}

/// An eye, what it looks at, the angle of view, and the scale and place of all of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eye {
    pub(crate) eye: Point,
    pub(crate) at: Point,
    pub(crate) degrees: f64,
}

/// Eyes outside the cube and within, where faces reach behind them.
pub(crate) fn eye() -> impl Strategy<Value = Eye> {
    let place = || prop::array::uniform3(-2.5..2.5);
    (place(), prop::array::uniform3(-0.5..0.5), 20.0..110.0).prop_map(|(eye, at, degrees)| Eye {
        eye: Point::from(eye),
        at: Point::from(at),
        degrees,
    })
}

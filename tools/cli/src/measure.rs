//! The size of a mesh, and its pieces.

use serde::Serialize;
use tearmesh::{Mesh, Point, Positions};

/// The box that holds all faces.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Bounds {
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
}

impl Bounds {
    /// Those of a mesh with a face; vertices without one do not count.
    pub(crate) fn of(mesh: &Mesh, positions: &Positions) -> Bounds {
        let mut bounds = Bounds {
            min: [f64::INFINITY; 3],
            max: [f64::NEG_INFINITY; 3],
        };
        let has_face = |&v: &_| mesh.half_edge_of(v).is_some();
        for v in mesh.vertices().filter(has_face) {
            let at: [f64; 3] = positions.at(v).into();
            for (axis, x) in at.into_iter().enumerate() {
                // Adding zero turns −0 into 0.
                bounds.min[axis] = bounds.min[axis].min(x) + 0.0;
                bounds.max[axis] = bounds.max[axis].max(x) + 0.0;
            }
        }
        bounds
    }
}

/// The lengths of the edges.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Edges {
    pub(crate) shortest: f64,
    pub(crate) mean: f64,
    pub(crate) longest: f64,
}

impl Edges {
    /// Those of a mesh with a face. The two sides of a torn edge are two.
    pub(crate) fn of(mesh: &Mesh, positions: &Positions) -> Edges {
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
        let (mut sum, mut count) = (0.0, 0.0);
        for h in mesh.edges() {
            let along = positions.at(mesh.target(h)) - positions.at(mesh.origin(h));
            let length = along.norm();
            (shortest, longest) = (shortest.min(length), longest.max(length));
            sum += length;
            count += 1.0;
        }
        Edges {
            shortest,
            mean: sum / count,
            longest,
        }
    }
}

/// A piece: faces joined by shared edges.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(crate) struct Piece {
    pub(crate) faces: usize,
    pub(crate) area: f64,
}

impl Piece {
    /// All pieces, by their smallest faces.
    pub(crate) fn all(mesh: &Mesh, positions: &Positions) -> Vec<Piece> {
        let components = mesh.components();
        let mut pieces = vec![Piece::default(); components.count()];
        for f in mesh.faces() {
            let piece = &mut pieces[components.of(f)];
            piece.faces += 1;
            piece.area += area(mesh.face_vertices(f).map(|v| positions.at(v)));
        }
        pieces
    }
}

/// The area of a triangle.
pub(crate) fn area([a, b, c]: [Point; 3]) -> f64 {
    (b - a).cross(&(c - a)).norm() / 2.0
}

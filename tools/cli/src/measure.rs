//! The size of a mesh, and its pieces.

use serde::Serialize;
use tearmesh::geometry::{cross, length};
use tearmesh::{Mesh, Place, Point, Positions};
use tearmesh_obj::TornDocument;

/// The box that holds all faces.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Bounds {
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
}

impl Bounds {
    /// Those of a mesh with a face; vertices without one do not count.
    pub(crate) fn of(mesh: &Mesh, positions: &Positions) -> Bounds {
        let has_face = |&v: &_| mesh.half_edge_of(v).is_some();
        let end = |start: f64, end: fn(f64, f64) -> f64, axis: usize| {
            let vertices = mesh.vertices().filter(has_face);
            // Adding zero turns −0 into 0.
            vertices.fold(start, |most, v| end(most, positions.at(v)[axis]) + 0.0)
        };
        Bounds {
            min: [0, 1, 2].map(|axis| end(f64::INFINITY, f64::min, axis)),
            max: [0, 1, 2].map(|axis| end(f64::NEG_INFINITY, f64::max, axis)),
        }
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
        let length = |h| (positions.at(mesh.target(h)) - positions.at(mesh.origin(h))).norm();
        let lengths = || mesh.edges().map(length);
        Edges {
            shortest: lengths().fold(f64::INFINITY, f64::min),
            mean: lengths().sum::<f64>() / lengths().count() as f64,
            longest: lengths().fold(0.0, f64::max),
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
    pub(crate) fn all(mesh: &Mesh, positions: &(impl Place + ?Sized)) -> Vec<Piece> {
        let components = mesh.components();
        let mut pieces = vec![Piece::default(); components.count()];
        for f in mesh.faces() {
            let piece = &mut pieces[components.of(f)];
            piece.faces += 1;
            piece.area += area(mesh.face_vertices(f).map(|v| positions.at(v)));
        }
        pieces
    }

    /// How many pieces are crumbs: those with less than a hundredth of the faces of the largest.
    pub(crate) fn crumbs(pieces: &[Piece]) -> usize {
        let largest = pieces.iter().map(|piece| piece.faces).max().unwrap_or(0);
        let is_crumb = |piece: &&Piece| 100 * piece.faces < largest;
        pieces.iter().filter(is_crumb).count()
    }
}

/// The area of a triangle.
pub(crate) fn area([a, b, c]: [Point; 3]) -> f64 {
    length(cross(b - a, c - a)) / 2.0
}

/// The area of a mesh as its file has it, with the gaps that it is written with: summed face by face.
pub(crate) fn written_area(torn: &TornDocument<'_>, mesh: &Mesh, positions: &Positions) -> f64 {
    let points = torn.written_points(positions);
    let faces = mesh.faces().map(|f| mesh.face_vertices(f));
    let areas = faces.map(|corners| area(corners.map(|v| points[v.index()])));
    areas.sum()
}

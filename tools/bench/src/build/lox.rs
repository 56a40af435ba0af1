//! lox's half-edge mesh, which checks nothing.

use ::lox::VertexHandle;
use ::lox::core::{HalfEdgeMesh, Mesh as _};
use ::lox::prelude::*;

use super::triangles::{Triangles, counted};

pub(super) fn build(triangles: &Triangles) -> HalfEdgeMesh {
    let mut mesh = HalfEdgeMesh::empty();
    for _ in 0..triangles.vertices {
        mesh.add_vertex();
    }
    for corners in &triangles.corners {
        mesh.add_triangle(corners.map(VertexHandle::new));
    }
    mesh
}

/// How many faces there are round all vertices, and the sum of their numbers.
pub(super) fn walk(mesh: &HalfEdgeMesh) -> (usize, usize) {
    let vertices = mesh.vertex_handles();
    let faces = vertices.flat_map(|v| mesh.faces_around_vertex(v));
    counted(faces.map(|f| f.idx() as usize))
}

//! The duties of a slide, and all that it has to leave as it was.

use tearmesh::script::World;
use tearmesh::slide::SlideRefusal;
use tearmesh::{HalfEdgeId, Mesh, Slide, VertexId};

use crate::oracle::Unslid;

/// A refusal, in the words of the oracle.
pub(super) fn plain(refusal: SlideRefusal) -> Unslid {
    match refusal {
        SlideRefusal::Parameter { .. } => Unslid::Parameter,
        SlideRefusal::Apart { .. } => Unslid::Apart,
        other => panic!("no slide of a script is {other}"),
    }
}

/// I16, I20: a slide changes no mesh and no mass.
pub(super) fn changes_nothing_else(before: &World, after: &World, slide: &Slide<'_>) {
    let mesh = &before.mesh;
    assert_eq!(after.mesh, *mesh, "the mesh");
    for v in mesh.vertices() {
        assert_eq!(after.area.at(v), before.area.at(v), "the mass of {v}");
        let halves = [before, after].map(|world| world.half.as_ref().map(|half| half.at(v)));
        assert_eq!(halves[0], halves[1], "the mass of {v}");
    }
    names_all_corners(mesh, slide);
}

/// The record names all corners of the vertex, and those of each face of the edge.
pub(super) fn names_all_corners(mesh: &Mesh, slide: &Slide<'_>) {
    let Slide {
        vertex,
        toward,
        along,
        corners,
        ..
    } = *slide;
    let walk = mesh.corners_of(vertex);
    assert!(walk.eq(corners.iter().copied()), "the corners of {vertex}");
    let corner = |f, v: VertexId| {
        mesh.half_edges()
            .find(|h| h.face() == f && mesh.origin(*h) == v)
    };
    let faces = mesh.faces();
    let both = faces.filter_map(|f| Some([corner(f, vertex)?, corner(f, toward)?]));
    let both: Vec<[HalfEdgeId; 2]> = both.collect();
    let mut told: Vec<[HalfEdgeId; 2]> = along.into_iter().flatten().collect();
    told.sort();
    assert_eq!(told, both, "the corners in the faces of the edge");
}

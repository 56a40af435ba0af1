//! The records of the log: what each split, insertion, merge and slide did.

use super::cursor::{Cursor, RunningHash};
use crate::id::{FaceId, HalfEdgeId, VertexId};

/// One change of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edit<'e> {
    /// A vertex was split.
    Split(Split<'e>),
    /// Vertices were inserted on edges and in faces.
    Insert(Insert<'e>),
    /// Two vertices were merged.
    Merge(Merge<'e>),
    /// A vertex slid along an edge.
    Slide(Slide<'e>),
}

impl Edit<'_> {
    /// The number of this record. Records are numbered from 0.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.before().number()
    }

    /// The place in the log before this record.
    #[must_use]
    pub fn before(&self) -> Cursor {
        match self {
            Edit::Split(split) => split.before,
            Edit::Insert(insert) => insert.before,
            Edit::Merge(merge) => merge.before,
            Edit::Slide(slide) => slide.before,
        }
    }

    /// The place in the log after this record. Linear in the record.
    #[must_use]
    pub fn after(&self) -> Cursor {
        let before = self.before();
        let mut hash = RunningHash::after(before);
        match self {
            Edit::Split(split) => split.add_to(&mut hash),
            Edit::Insert(insert) => insert.add_to(&mut hash),
            Edit::Merge(merge) => merge.add_to(&mut hash),
            Edit::Slide(slide) => slide.add_to(&mut hash),
        }
        Cursor::new(before.number() + 1, hash.get())
    }
}

// What records add to the hash of a log: what cannot be told from the rest, each list with its
// length.

impl Split<'_> {
    fn add_to(&self, hash: &mut RunningHash) {
        hash.add_pair([self.old.into(), self.new.into()]);
        add_corners(hash, self.corners);
    }
}

impl Insert<'_> {
    fn add_to(&self, hash: &mut RunningHash) {
        hash.add_pair([self.points.len() as u32, self.children.len() as u32]);
        for point in self.points {
            match point.at {
                InsertLocation::Edge { ends, t } => {
                    hash.add_pair(ends.map(u32::from));
                    hash.add(t.to_bits());
                }
                InsertLocation::Face { vertices, weights } => {
                    hash.add_pair([vertices[0].into(), vertices[1].into()]);
                    hash.add(weights[0].to_bits());
                    hash.add(weights[1].to_bits());
                }
            }
        }
        for child in self.children {
            let [a, b, c] = child.vertices.map(u32::from);
            hash.add_pair([child.parent.into(), a]);
            hash.add_pair([b, c]);
        }
    }
}

impl Merge<'_> {
    fn add_to(&self, hash: &mut RunningHash) {
        hash.add_pair([self.kept.into(), self.gone.into()]);
        hash.add(self.share.to_bits());
        add_corners(hash, self.corners);
    }
}

impl Slide<'_> {
    fn add_to(&self, hash: &mut RunningHash) {
        hash.add_pair([self.vertex.into(), self.toward.into()]);
        hash.add(self.t.to_bits());
    }
}

fn add_corners(hash: &mut RunningHash, corners: &[HalfEdgeId]) {
    hash.add(corners.len() as u64);
    corners.iter().for_each(|&h| hash.add(u32::from(h).into()));
}

/// The record of a split: some corners of a vertex now belong to a new vertex at the same place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Split<'e> {
    /// The place in the log before this record.
    pub before: Cursor,
    /// The vertex that was split. It keeps at least one face.
    pub old: VertexId,
    /// The new vertex, which has the highest id of the mesh.
    pub new: VertexId,
    /// The corners that moved to the new vertex: at least one, in the order of a walk around the
    /// old vertex.
    pub corners: &'e [HalfEdgeId],
    /// The links that this split tore.
    pub torn: &'e [TornLink],
}

/// A link between a face that stayed with a vertex and a face that went to its copy.
///
/// A split makes it a ghost pair, and a merge makes it a pair again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TornLink {
    /// The half-edge in the face that stayed.
    pub stayed: HalfEdgeId,
    /// The opposite half-edge, in the face that moved.
    pub moved: HalfEdgeId,
}

/// The record of an insertion: vertices were inserted, and each face that got any was divided into
/// *children*.
///
/// The record is complete: from it alone a follower can compute what a new vertex or corner
/// should have. Weights refer to what was there before the insertion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Insert<'e> {
    /// The place in the log before this record.
    pub before: Cursor,
    /// The new vertices, ascending. They have the highest ids of the mesh, without a gap. A point
    /// on a torn edge has two vertices, one after the other.
    pub points: &'e [InsertedPoint],
    /// The faces that replaced divided ones. Children of the same parent are neighbours in this
    /// list.
    pub children: &'e [ChildFace],
}

/// A new vertex and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InsertedPoint {
    /// The new vertex.
    pub vertex: VertexId,
    /// Where the new vertex is, relative to vertices that existed before.
    pub at: InsertLocation,
}

/// A place on an edge or in a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InsertLocation {
    /// At `ends[0] + t (ends[1] − ends[0])`.
    Edge {
        /// The ends of the edge.
        ends: [VertexId; 2],
        /// The parameter, strictly between 0 and 1.
        t: f64,
    },
    /// At the weighted mean of the corners of a face.
    Face {
        /// The corners of the face.
        vertices: [VertexId; 3],
        /// The weights of the corners: positive, and of sum one up to rounding.
        weights: [f64; 3],
    },
}

/// A face that replaced part of a divided face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChildFace {
    /// The face that was divided.
    pub parent: FaceId,
    /// The id of this child. The first child of a family has the id of the parent.
    pub face: FaceId,
    /// The vertices of the child.
    pub vertices: [VertexId; 3],
    /// Where each corner of the child lies in the parent.
    pub sources: [CornerSource; 3],
    /// The fraction of the parent's area that the child covers. The shares of all children of a
    /// parent add up to one, up to rounding.
    pub share: f64,
}

/// Where a corner of a child lies in its parent. The half-edges are corners of the parent, as they
/// were before the insertion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CornerSource {
    /// At a corner of the parent.
    Corner(HalfEdgeId),
    /// On an edge of the parent, at `ends[0] + t (ends[1] − ends[0])`. Both faces of the edge have
    /// the same `t` and the same direction.
    Edge {
        /// The corners at the ends of the edge.
        ends: [HalfEdgeId; 2],
        /// The parameter, strictly between 0 and 1.
        t: f64,
    },
    /// Inside the parent.
    Face {
        /// The weights of the corners of the parent, in their order.
        weights: [f64; 3],
    },
}

/// The record of a merge: two vertices of one root became one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Merge<'e> {
    /// The place in the log before this record.
    pub before: Cursor,
    /// The vertex that now has all corners: the one with the lower id.
    pub kept: VertexId,
    /// The vertex that disappeared.
    pub gone: VertexId,
    /// The weight of `kept` in the merged value, which is `kept + (1 − share) (gone − kept)`. Equal
    /// values stay as they are.
    pub share: f64,
    /// The corners that went from `gone` to `kept`: at least one, in the order of a walk around
    /// `gone`.
    pub corners: &'e [HalfEdgeId],
    /// The vertex that took the freed id, unless `gone` was the last one.
    pub renumbered: Option<Renumbered<'e>>,
    /// The links that became pairs again. `stayed` is in a face of `kept`, and `moved` in a face
    /// that came from `gone`.
    pub sewn: &'e [TornLink],
}

/// The last vertex of a mesh took the id of a vertex that disappeared in a merge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Renumbered<'e> {
    /// The id that the vertex had before.
    pub from: VertexId,
    /// The id that the vertex has now.
    pub to: VertexId,
    /// The corners of the renumbered vertex.
    pub corners: &'e [HalfEdgeId],
}

/// The record of a slide: a vertex moved along an edge of the surface. The mesh itself did not
/// change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slide<'e> {
    /// The place in the log before this record.
    pub before: Cursor,
    /// The vertex that slid.
    pub vertex: VertexId,
    /// The vertex towards which it slid, which did not move.
    pub toward: VertexId,
    /// The fraction of the way: the vertex is now at `vertex + t (toward − vertex)`, with t
    /// strictly between 0 and 1.
    pub t: f64,
    /// For each of the up to two faces of the edge, its corner at `vertex` and its corner at
    /// `toward`.
    pub along: [Option<[HalfEdgeId; 2]>; 2],
    /// All corners of `vertex`, in the order of a walk around it.
    pub corners: &'e [HalfEdgeId],
}

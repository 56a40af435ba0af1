//! The records of the log: what each split, insertion, merge and slide did.

use super::cursor::Cursor;
use super::mix::Mix;
use crate::id::{FaceId, HalfEdgeId, VertexId};

/// A record of one change of a mesh.
///
/// Later versions may have other records. A follower that does not know one is out of step with the mesh from there
/// on, so it must stop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Edit<'e> {
    /// A vertex was split into two.
    Split(Split<'e>),
    /// Vertices were inserted on edges and in faces.
    Insert(Insert<'e>),
    /// Two vertices were merged into one.
    Merge(Merge<'e>),
    /// A vertex was moved along an edge.
    Slide(Slide<'e>),
}

impl Edit<'_> {
    /// Returns the number of this record. Records are numbered from 0.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.before().number()
    }

    /// Returns the place in the log before this record.
    #[must_use]
    pub fn before(&self) -> Cursor {
        match self {
            Edit::Split(split) => split.before,
            Edit::Insert(insert) => insert.before,
            Edit::Merge(merge) => merge.before,
            Edit::Slide(slide) => slide.before,
        }
    }

    /// Returns the place in the log after this record. Linear in the size of the record.
    #[must_use]
    pub fn after(&self) -> Cursor {
        let mut after = self.before().advanced();
        // What cannot be told from the rest, each list with its length.
        match self {
            Edit::Split(split) => {
                after.add_pair([split.old.into(), split.new.into()]);
                add_corners(&mut after, split.corners);
            }
            Edit::Insert(insert) => add_insert(&mut after, insert),
            Edit::Merge(merge) => {
                after.add_pair([merge.kept.into(), merge.gone.into()]);
                after.add(merge.share.to_bits());
                add_corners(&mut after, merge.corners);
            }
            Edit::Slide(slide) => {
                after.add_pair([slide.vertex.into(), slide.toward.into()]);
                after.add(slide.t.to_bits());
                after.add(slide.slides_before.into());
            }
        }
        after
    }
}

fn add_insert(hash: &mut Cursor, insert: &Insert<'_>) {
    hash.add_pair([insert.points.len() as u32, insert.children.len() as u32]);
    for point in insert.points {
        match point.at {
            Mix::Copy(v) => hash.add(u32::from(v).into()),
            Mix::Between { ends, t } => {
                hash.add_pair(ends.map(u32::from));
                hash.add(t.to_bits());
            }
            Mix::Weighted { of, weights } => {
                hash.add_pair([of[0].into(), of[1].into()]);
                hash.add(weights[0].to_bits());
                hash.add(weights[1].to_bits());
            }
        }
    }
    for child in insert.children {
        let [a, b, c] = child.vertices.map(u32::from);
        hash.add_pair([child.parent.into(), a]);
        hash.add_pair([b, c]);
    }
}

fn add_corners(hash: &mut Cursor, corners: &[HalfEdgeId]) {
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
    /// The new vertex. It has the highest id of the mesh.
    pub new: VertexId,
    /// The corners that moved to the new vertex: at least one, in the order of a walk around the
    /// old vertex.
    pub corners: &'e [HalfEdgeId],
    /// The links that this split tore, if any.
    pub torn: &'e [TornLink],
}

/// A link between a face that stayed with a vertex and a face that moved to the copy of this vertex.
///
/// A split turns the link into a ghost pair, and a merge turns it back into a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TornLink {
    /// The half-edge of the face that stayed.
    pub stayed: HalfEdgeId,
    /// The opposite half-edge, which belongs to the face that moved.
    pub moved: HalfEdgeId,
}

/// The record of an insertion. Each face that got a new vertex was divided into *children*.
///
/// A follower can compute the values of all new vertices and corners from this record alone.
/// Weights refer to the vertices and corners from before the insertion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Insert<'e> {
    /// The place in the log before this record.
    pub before: Cursor,
    /// The new vertices, in ascending order. Their ids are the highest of the mesh, without a gap.
    /// A point on a torn edge has two vertices, one after the other.
    pub points: &'e [InsertedPoint],
    /// The children of all divided faces. Those of the same face are listed one after another.
    pub children: &'e [ChildFace],
}

/// A new vertex and its location.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InsertedPoint {
    /// The new vertex.
    pub vertex: VertexId,
    /// The location of the new vertex: between the ends of an edge, the parameter strictly between 0 and
    /// 1, or among the corners of a face, the weights positive and their sum one up to rounding. All
    /// are vertices that existed before the insertion.
    pub at: Mix<VertexId>,
}

/// A face that replaced part of a divided face, its *parent*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChildFace {
    /// The face that was divided.
    pub parent: FaceId,
    /// The id of this child. The first child of each parent has the parent's id.
    pub face: FaceId,
    /// The vertices of the child, in the order of its half-edges.
    pub vertices: [VertexId; 3],
    /// The corners of the parent that each corner of the child lies between, in the order of `vertices`,
    /// with their ids from before the insertion: a corner itself, the ends of an edge (both faces of which
    /// use the same fraction and the same direction), or all three.
    pub sources: [Mix<HalfEdgeId>; 3],
    /// The fraction of the parent's area that the child covers. The shares of all children of a
    /// parent add up to one, up to rounding.
    pub share: f64,
}

/// The record of a merge: two vertices that were split from the same one became one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Merge<'e> {
    /// The place in the log before this record.
    pub before: Cursor,
    /// The vertex that has the corners of both. It is the one with the lower id.
    pub kept: VertexId,
    /// The vertex that was removed.
    pub gone: VertexId,
    /// The weight of `kept`, from 0 to 1, in the merged value, which is `kept + (1 − share) (gone −
    /// kept)`. Equal values stay as they are.
    pub share: f64,
    /// The corners that moved from `gone` to `kept`, in the order of a walk around `gone`. There is
    /// at least one.
    pub corners: &'e [HalfEdgeId],
    /// The last vertex, which took the id of `gone`, or `None` if `gone` was the last vertex.
    pub renumbered: Option<Renumbered<'e>>,
    /// The links that became pairs again. In each of them, `stayed` belongs to a face of `kept`,
    /// and `moved` to a face that came from `gone`.
    pub sewn: &'e [TornLink],
}

/// The last vertex of a mesh, which took the id of a vertex that was removed by a merge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Renumbered<'e> {
    /// The id of the vertex before the merge.
    pub from: VertexId,
    /// The id of the vertex after the merge.
    pub to: VertexId,
    /// All corners of the renumbered vertex.
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
    /// The vertex toward which it slid. This vertex did not move.
    pub toward: VertexId,
    /// The fraction of the way to `toward`, strictly between 0 and 1. The vertex is now at
    /// `vertex + t (toward − vertex)`.
    pub t: f64,
    /// For each of the up to two faces of the edge, its corner at `vertex` and its corner at
    /// `toward`. `None` stands for a face that does not exist.
    pub along: [Option<[HalfEdgeId; 2]>; 2],
    /// All corners of `vertex`, in the order of a walk around it.
    pub corners: &'e [HalfEdgeId],
    /// How many times a vertex of the mesh had slid before. It tells a slide from an equal one, as a split
    /// is told by the number of its new vertex.
    pub slides_before: u32,
}

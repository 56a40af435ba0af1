//! The seam of a cut: the edges that it tore, in order.

use super::cut_result::side_of;
use crate::edit::{Cursor, Edit, Edits};
use crate::geometry::Side;
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;

/// Which vertices were one before they were split by a cut.
pub(super) struct Nodes {
    vertices_before: usize,
    /// Of the vertices that the cut made.
    of: Vec<VertexId>,
}

impl Nodes {
    pub(super) fn new(edits: &Edits, first_edit: Cursor, vertices_before: usize) -> Nodes {
        let of = Vec::new();
        let mut nodes = Nodes {
            vertices_before,
            of,
        };
        for edit in edits.since(first_edit) {
            match edit {
                Edit::Split(split) => nodes.of.push(nodes.node(split.old)),
                Edit::Insert(insert) => {
                    let points = insert.points.iter();
                    nodes.of.extend(points.map(|point| point.vertex));
                }
                Edit::Merge(_) | Edit::Slide(_) => {}
            }
        }
        nodes
    }

    fn node(&self, v: VertexId) -> VertexId {
        let made = v.index().checked_sub(self.vertices_before);
        made.map_or(v, |made| self.of[made])
    }

    /// The nodes at the ends of an edge.
    pub(super) fn of_edge(&self, mesh: &Mesh, h: HalfEdgeId) -> [VertexId; 2] {
        [mesh.origin(h), mesh.target(h)].map(|v| self.node(v))
    }
}

/// A line of the seam: a chain of edges that the cut tore.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeamLine {
    /// The edges of the line, in order. Each is given as the half-edge on the front lip, which runs along
    /// the line, and its ghost pair on the back lip, which runs against the line. For the two methods of
    /// the paper, either lip may come first in an edge that was torn on one side of the plane.
    pub lips: Vec<[HalfEdgeId; 2]>,
    /// The vertices at the start and the end of the line. Each is `None` if the two lips are separate there.
    pub tips: [Option<VertexId>; 2],
}

/// What a cut tore. `sides` are those of the faces along it.
pub(super) fn lines(
    edits: &Edits,
    first_edit: Cursor,
    mesh: &Mesh,
    vertices_before: usize,
    sides: &[(FaceId, Option<Side>)],
) -> Vec<SeamLine> {
    let nodes = Nodes::new(edits, first_edit, vertices_before);
    let splits = edits.since(first_edit).filter_map(|edit| match edit {
        Edit::Split(split) => Some(split),
        Edit::Insert(_) | Edit::Merge(_) | Edit::Slide(_) => None,
    });
    let torn = splits.flat_map(|split| split.torn);
    let mut edges: Vec<[HalfEdgeId; 2]> = torn.map(|link| [link.stayed, link.moved]).collect();
    edges.sort_unstable();
    let mut at: Vec<(VertexId, usize)> = Vec::new();
    for (i, &[h, _]) in edges.iter().enumerate() {
        at.extend(nodes.of_edge(mesh, h).map(|node| (node, i)));
    }
    at.sort_unstable();
    // Three are as good as all: only two go on.
    let edges_at = |node: VertexId| {
        let first = at.partition_point(|&(other, _)| other < node);
        let of_node = at[first..].iter().take_while(|&&(other, _)| other == node);
        &at[first..first + of_node.take(3).count()]
    };
    let mut done = vec![false; edges.len()];
    let mut follow = |mut node: VertexId, mut i: usize| {
        let mut lips = Vec::new();
        // The half-edges that run along a line are all on its left.
        while !std::mem::replace(&mut done[i], true) {
            let [one, other] = edges[i];
            let [from, to] = nodes.of_edge(mesh, one);
            let is_along = from == node;
            lips.push(if is_along { [one, other] } else { [other, one] });
            node = if is_along { to } else { from };
            match edges_at(node) {
                &[(_, a), (_, b)] => i = if a == i { b } else { a },
                _ => break,
            }
        }
        lips
    };
    let is_turned = |&[left, right]: &[HalfEdgeId; 2]| {
        let sides = [left, right].map(|h| side_of(sides, h.face()));
        let is_turned = sides[0] == Some(Side::Back) || sides[1] == Some(Side::Front);
        (sides[0] != sides[1]).then_some(is_turned)
    };
    let mut lines = Vec::new();
    // What is left when all lines with ends have been followed goes round.
    for goes_round in [false, true] {
        for (i, &[h, _]) in edges.iter().enumerate() {
            for node in nodes.of_edge(mesh, h) {
                if !goes_round && edges_at(node).len() == 2 {
                    continue;
                }
                let mut lips = follow(node, i);
                if lips.iter().find_map(is_turned) == Some(true) {
                    lips.reverse();
                    lips.iter_mut().for_each(|lips| lips.reverse());
                }
                if let (Some(begin), Some(end)) = (lips.first(), lips.last()) {
                    let ends = [
                        [mesh.origin(begin[0]), mesh.target(begin[1])],
                        [mesh.target(end[0]), mesh.origin(end[1])],
                    ];
                    let tips = ends.map(|[one, other]| (one == other).then_some(one));
                    lines.push(SeamLine { lips, tips });
                }
            }
        }
    }
    lines
}

//! Splits of a hub, a vertex with very many faces, by one plane after another.
//!
//! The paper's methods partition the faces of a vertex for each crossed face that has it. Where most
//! crossed faces share one vertex that is quadratic. Here the corners of a hub are the leaves of a
//! tree, in their order round it; each node knows a box round the centres of its faces, seen from the
//! hub. A plane through the hub has most boxes on one side as a whole, and only at the others does
//! the tree have to be looked into, and taken apart:
//!
//! ```text
//!        o                 o           o        front, and what moves to a new vertex: each keeps
//!      /   \             /   \        /         the subtrees that are its own as they are
//!     o     o    ->     o     o  +   o
//!    / \   / \         /     / \      \
//!   f   b f   f       f     f   f      b
//! ```
//!
//! The sides are those of [`classify::face`], to the bit: a box decides only as far as no rounding can
//! matter, and a face decides for itself. So is the log: corners are noted in the order of
//! [`Mesh::corners_of`]. A plane costs what it moves and, for each place where the sides change as one
//! goes round the hub, a logarithm.

use std::collections::BTreeMap;

use crate::classify;
use crate::edit::Edits;
use crate::exact::ROUNDING;
use crate::geometry::{Plane, Side, Vector, max_abs};
use crate::id::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::split;

/// A vertex whose orbit has more corners is a hub.
const FEW: usize = 64;

/// The hubs that were split so far, and their copies.
#[derive(Default)]
pub(super) struct Hubs {
    nodes: Vec<Node>,
    hubs: BTreeMap<VertexId, Hub>,
}

#[derive(Clone, Copy)]
struct Hub {
    root: usize,
    /// Whether the hub is on the boundary as it was built.
    is_open: bool,
    /// Whether all faces are on one side of the plane of the cut.
    is_divided: bool,
}

#[derive(Clone, Copy)]
struct Node {
    /// Both are in the order of corners round the hub; none for a leaf.
    children: Option<[usize; 2]>,
    /// The smallest corner.
    least: Corner,
    /// Twice the middle of the edge of a face that is opposite to the hub, as seen from there.
    low: Vector,
    high: Vector,
    /// No face reaches farther from the hub by more than twice that.
    reach: f64,
}

/// A corner of a hub, and its number among them.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Corner {
    h: HalfEdgeId,
    number: usize,
}

impl Hubs {
    /// Splits a vertex by the plane of a cut moved to it, or by another plane through it. Returns
    /// whether it has faces on both sides; otherwise nothing has changed.
    pub(super) fn split(
        &mut self,
        mesh: &mut Mesh,
        v: VertexId,
        (plane, is_of_cut): (&Plane, bool),
        positions: &Positions,
        edits: &mut Edits,
    ) -> bool {
        if !self.hubs.contains_key(&v) {
            let h = mesh.half_edge_of(v).expect("I9: a corner has a vertex");
            if mesh.orbit(h).nth(FEW).is_none() {
                return split::by_plane(mesh, v, plane, positions, edits).is_some();
            }
            self.add(mesh, h, positions);
        }
        let mut hub = self.hubs[&v];
        if is_of_cut && hub.is_divided {
            return false;
        }
        hub.is_divided |= is_of_cut;
        let start = self.nodes[hub.root].least.number;
        let side = |h: HalfEdgeId| classify::face(mesh, h.face(), plane, positions);
        let [front, back] = self.divide(hub.root, &side, plane);
        let (Some(front), Some(back)) = (front, back) else {
            self.hubs.insert(v, hub);
            return false;
        };
        let moving = self.corners_from(back, start, hub.is_open);
        let new = mesh.next_vertex();
        split::into(mesh, v, &moving, self.nodes[front].least.h, edits);
        self.hubs.insert(v, Hub { root: front, ..hub });
        self.hubs.insert(new, Hub { root: back, ..hub });
        true
    }

    /// Makes trees of all vertices of the orbit of a corner.
    fn add(&mut self, mesh: &Mesh, h: HalfEdgeId, positions: &Positions) {
        let mut first = h;
        let is_open = loop {
            match mesh.behind(first) {
                Some(behind) if behind == h => break false,
                Some(behind) => first = behind,
                None => break true,
            }
        };
        let mut corners: BTreeMap<VertexId, Vec<usize>> = BTreeMap::new();
        for (h, number) in mesh.orbit(first).zip(0..) {
            let center = positions.at(mesh.origin(h));
            let [b, c] = [h.next(), h.prev()].map(|h| positions.at(mesh.origin(h)) - center);
            let leaf = Node {
                children: None,
                least: Corner { h, number },
                low: b + c,
                high: b + c,
                reach: max_abs(b).max(max_abs(c)),
            };
            let leaf = self.push(leaf);
            corners.entry(mesh.origin(h)).or_default().push(leaf);
        }
        for (v, leaves) in corners {
            let hub = Hub {
                root: self.tree(&leaves),
                is_open,
                is_divided: false,
            };
            self.hubs.insert(v, hub);
        }
    }

    fn push(&mut self, node: Node) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    fn tree(&mut self, leaves: &[usize]) -> usize {
        if let &[leaf] = leaves {
            return leaf;
        }
        let (some, others) = leaves.split_at(leaves.len() / 2);
        let children = [some, others].map(|leaves| self.tree(leaves));
        self.above(children)
    }

    fn above(&mut self, children: [usize; 2]) -> usize {
        let [one, other] = children.map(|child| self.nodes[child]);
        self.push(Node {
            children: Some(children),
            least: one.least.min(other.least),
            low: one.low.inf(&other.low),
            high: one.high.sup(&other.high),
            reach: one.reach.max(other.reach),
        })
    }

    /// The tree of those in front and that of those behind, as far as there are any.
    fn divide(
        &mut self,
        node: usize,
        side: &impl Fn(HalfEdgeId) -> Side,
        plane: &Plane,
    ) -> [Option<usize>; 2] {
        let Node {
            children, least, ..
        } = self.nodes[node];
        let of_all = match children {
            None => Some(side(least.h)),
            Some(_) => self.nodes[node].side(plane),
        };
        match (of_all, children) {
            (Some(Side::Front), _) => [Some(node), None],
            (Some(Side::Back), _) => [None, Some(node)],
            (None, None) => unreachable!("a leaf has a side"),
            (None, Some(children)) => {
                let [one, other] = children.map(|child| self.divide(child, side, plane));
                [0, 1].map(|of| match (one[of], other[of]) {
                    (Some(one), Some(other)) if [one, other] == children => Some(node),
                    (Some(one), Some(other)) => Some(self.above([one, other])),
                    (one, other) => one.or(other),
                })
            }
        }
    }

    /// The corners of a tree in the order of a walk round the hub from one of its corners: ahead, and
    /// then on from the first or, where the hub is open, back from the start.
    fn corners_from(&self, root: usize, start: usize, is_open: bool) -> Vec<HalfEdgeId> {
        let (mut ahead, mut before) = (Vec::new(), Vec::new());
        let mut stack = vec![root];
        while let Some(node) = stack.pop() {
            let Node {
                children, least, ..
            } = self.nodes[node];
            match children {
                Some([one, other]) => stack.extend([other, one]),
                None if least.number < start => before.push(least.h),
                None => ahead.push(least.h),
            }
        }
        if is_open {
            before.reverse();
        }
        ahead.append(&mut before);
        ahead
    }
}

impl Node {
    /// The side of a plane through the hub on which all faces are, if no rounding can matter.
    fn side(&self, plane: &Plane) -> Option<Side> {
        let normal = plane.scaled_normal();
        let size = normal.x.abs() + normal.y.abs() + normal.z.abs();
        let margin = 4.0 * ROUNDING * size * self.reach + f64::MIN_POSITIVE;
        let (mut least, mut most) = (0.0, 0.0);
        for axis in 0..3 {
            let ends = [self.low, self.high].map(|end| normal[axis] * end[axis]);
            least += ends[0].min(ends[1]);
            most += ends[0].max(ends[1]);
        }
        if least > margin {
            Some(Side::Front)
        } else {
            (most < -margin).then_some(Side::Back)
        }
    }
}

//! What to insert: points on edges and in faces, and edges that are required between them.

use crate::id::{FaceId, HalfEdgeId};

/// A set of points, on edges and in faces, that are inserted all at once.
///
/// ```
/// use tearmesh::{shapes, insert::Plan, Edits, FaceId, HalfEdgeId};
///
/// let (mut mesh, mut positions) = shapes::grid(1, 1);
/// let diagonal = mesh.half_edges().find(|&h| mesh.pair(h).is_some()).unwrap();
/// let mut plan = Plan::new();
/// plan.on_edge(diagonal, 0.5);
/// let mut edits = Edits::new();
/// let insert = plan.apply(&mut mesh, &mut edits)?;
/// assert_eq!((insert.points.len(), insert.children.len()), (1, 4));
/// edits.replay(&mut positions);
/// assert_eq!((mesh.vertex_count(), mesh.face_count()), (5, 4));
/// assert_eq!(positions.as_slice()[4], [0.5, 0.5, 0.0].into());
/// assert!(mesh.check().is_empty());
/// # Ok::<(), tearmesh::InsertRefusal>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Plan {
    pub(super) points: Vec<Point>,
    pub(super) chords: Vec<Chord>,
}

impl Plan {
    /// An empty plan.
    #[must_use]
    pub fn new() -> Plan {
        Plan::default()
    }

    /// Forgets all points and keeps the memory.
    pub fn clear(&mut self) {
        self.points.clear();
        self.chords.clear();
    }

    /// The number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether the plan has no points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Adds a point on an edge, at the fraction `t` of the way from the origin of `h` to its
    /// target. On a torn edge a point is also added on the other side, at the same `t`.
    pub fn on_edge(&mut self, h: HalfEdgeId, t: f64) -> PointId {
        self.push(Point::Edge {
            h,
            t,
            forward: true,
        })
    }

    /// Adds a point on an edge, at the fraction `t` of the way from the target of `h` to its
    /// origin. On a torn edge a point is also added on the other side. [`Plan::on_edge`] with `1 −
    /// t` may differ in the last bit.
    pub fn on_edge_backward(&mut self, h: HalfEdgeId, t: f64) -> PointId {
        self.push(Point::Edge {
            h,
            t,
            forward: false,
        })
    }

    /// Adds a point in a face, at the weighted mean of its corners in their order. The
    /// weights are divided by their sum.
    ///
    /// The first point of a face is joined to all corners of the face and all points on its edges.
    /// Each further point is joined to the corners of the triangle in which it then lies.
    pub fn in_face(&mut self, f: FaceId, weights: [f64; 3]) -> PointId {
        self.push(Point::Face { f, weights })
    }

    fn push(&mut self, point: Point) -> PointId {
        self.points.push(point);
        PointId(self.points.len() as u32 - 1)
    }

    /// Requires that an edge of the result run straight across a face, which must not have points
    /// inside. This is needed only if the face has more than two points on its edges: two points on
    /// different edges are joined anyway, and a single point is joined to the opposite corner.
    pub fn chord(&mut self, f: FaceId, ends: [ChordEnd; 2]) {
        self.chords.push(Chord { f, ends });
    }
}

/// The number of a point in its plan, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PointId(pub(super) u32);

impl PointId {
    /// The index of the point in its plan, for use with slices.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// An end of a chord: a corner of the face, or a point on one of its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChordEnd {
    /// A corner of the face.
    Corner(HalfEdgeId),
    /// A point of the plan.
    Point(PointId),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    pub(super) f: FaceId,
    pub(super) ends: [ChordEnd; 2],
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Point {
    /// At `t` from the origin of the half-edge, or if not `forward`, from its target.
    Edge {
        h: HalfEdgeId,
        t: f64,
        forward: bool,
    },
    Face {
        f: FaceId,
        weights: [f64; 3],
    },
}

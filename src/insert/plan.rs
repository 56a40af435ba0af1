//! What to insert: points on edges and in faces, and edges that are required between them. And why
//! it is refused.

use std::fmt;

use crate::id::{FaceId, HalfEdgeId};
use crate::mesh::Mesh;

/// A set of points on edges and in faces that are inserted at once.
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
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    pub(super) points: Vec<Point>,
    pub(super) chords: Vec<Chord>,
}

impl Plan {
    /// Creates an empty plan.
    #[must_use]
    pub fn new() -> Plan {
        Plan::default()
    }

    /// Returns the points, in the order in which they were added. A point on a torn edge is listed once.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Returns the chords, in the order in which they were added.
    #[must_use]
    pub fn chords(&self) -> &[Chord] {
        &self.chords
    }

    /// Adds a point on an edge, at the fraction `t` of the way from the origin of `h` to its target. It
    /// must be strictly between 0 and 1. On a torn edge, the same point is also added on the other side.
    pub fn on_edge(&mut self, h: HalfEdgeId, t: f64) -> PointId {
        self.edge(h, t, true)
    }

    /// Adds a point on an edge, at the fraction `t` of the way from the target of `h` to its
    /// origin. On a torn edge, the same point is also added on the other side. The result may
    /// differ in the last bit from [`Plan::on_edge`] with `1 − t`.
    pub fn on_edge_backward(&mut self, h: HalfEdgeId, t: f64) -> PointId {
        self.edge(h, t, false)
    }

    /// Adds a point in a face, at the weighted mean of its corners. The weights are given in the
    /// order of the face's corners, must be positive, and are divided by their sum.
    ///
    /// The first point of a face is joined to all corners of the face and to all points on its
    /// edges. Each further point is joined to the corners of the triangle that then contains it.
    pub fn in_face(&mut self, f: FaceId, weights: [f64; 3]) -> PointId {
        self.push(Point::Face { f, weights })
    }

    pub(crate) fn edge(&mut self, h: HalfEdgeId, t: f64, forward: bool) -> PointId {
        self.push(Point::Edge { h, t, forward })
    }

    fn push(&mut self, point: Point) -> PointId {
        self.points.push(point);
        PointId(self.points.len() as u32 - 1)
    }

    /// Requires an edge of the result that crosses a face along a straight line. The face must not have
    /// points inside. A chord is needed only if the face has more than two points on its edges: two
    /// points on different edges are always joined, and a single point is joined to the opposite corner.
    pub fn chord(&mut self, f: FaceId, ends: [ChordEnd; 2]) {
        self.chords.push(Chord { f, ends });
    }
}

/// The number of a point in its plan, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PointId(pub(super) u32);

impl PointId {
    /// Returns the index of the point in its plan, counted from 0.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// An end of a chord: a corner of its face, or a point on an edge of the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChordEnd {
    /// The corner at which this half-edge starts. It must be a corner of the chord's face.
    Corner(HalfEdgeId),
    /// A point of the plan on an edge of the chord's face.
    Point(PointId),
}

/// An edge that a plan requires: see [`Plan::chord`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chord {
    /// The face that the edge crosses.
    pub f: FaceId,
    /// The ends of the edge.
    pub ends: [ChordEnd; 2],
}

/// A point of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Point {
    /// A point on an edge: see [`Plan::on_edge`] and [`Plan::on_edge_backward`].
    Edge {
        /// A half-edge of the edge.
        h: HalfEdgeId,
        /// The fraction of the way along the half-edge.
        t: f64,
        /// Whether `t` is counted from the origin of the half-edge, or from its target.
        forward: bool,
    },
    /// A point in a face: see [`Plan::in_face`].
    Face {
        /// The face.
        f: FaceId,
        /// The weights of the face's corners, in their order.
        weights: [f64; 3],
    },
}

/// The reason why an insertion was refused. Nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum InsertRefusal {
    /// A parameter on an edge is not strictly between 0 and 1.
    Parameter {
        /// The half-edge given for the edge.
        half_edge: HalfEdgeId,
        /// The parameter given.
        t: f64,
    },
    /// A weight of a point in a face is not positive, or the sum of the weights is not finite.
    Weights {
        /// The face in which the point was to be inserted.
        face: FaceId,
        /// The weights given, in the order of the face's corners.
        weights: [f64; 3],
    },
    /// Two points on an edge coincide.
    Repeated {
        /// The half-edge given for the second point.
        half_edge: HalfEdgeId,
        /// The parameter given for the second point.
        t: f64,
    },
    /// A chord does not divide its face, is the second in it, or lies in a face with points inside.
    /// Its ends must be two places on the outline of the face, with area on both sides.
    Chord {
        /// The face that the chord was to divide.
        face: FaceId,
    },
    /// Two points in a face coincide up to rounding, or a point lies on the outline of its face.
    Crowded {
        /// The face that contains the points.
        face: FaceId,
    },
    /// A child face would be so small that its share of the parent's area rounds to zero. This can
    /// happen between points that are very close to a corner.
    Share {
        /// The face that was to be divided.
        face: FaceId,
        /// The share of the parent's area, from 0 to 1, that the child would have.
        share: f64,
    },
    /// The mesh would have more than [`Mesh::MAX_FACES`] faces.
    Full {
        /// The number of faces that the mesh would have.
        faces: usize,
    },
}

impl fmt::Display for InsertRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("nothing was inserted: ")?;
        match self {
            InsertRefusal::Parameter { half_edge, t } => {
                write!(f, "the parameter {t} on {half_edge} is not between 0 and 1")
            }
            InsertRefusal::Weights {
                face,
                weights: [a, b, c],
            } => write!(
                f,
                "the weights {a}, {b}, {c} are not those of a point in {face}"
            ),
            InsertRefusal::Repeated { half_edge, t } => {
                write!(f, "two points are on {half_edge} at {t}")
            }
            InsertRefusal::Chord { face } => write!(f, "a chord does not cross {face}"),
            InsertRefusal::Crowded { face } => write!(f, "points in {face} cannot be told apart"),
            InsertRefusal::Share { face, share } => {
                write!(
                    f,
                    "a child of {face} would cover only the fraction {share} of it"
                )
            }
            InsertRefusal::Full { faces } => {
                write!(f, "{faces} faces are more than {}", Mesh::MAX_FACES)
            }
        }
    }
}

impl std::error::Error for InsertRefusal {}

//! The positions of the vertices.
//!
//! The mesh has no coordinates. Code that needs them reads a [`Place`], which any storage can
//! implement. Code that cuts also writes [`Positions`], the library's own storage, in step with the
//! mesh.

use std::fmt;

use crate::attribute::Blend;
use crate::edit::{Cursor, Edit, Follower};
use crate::geometry::{Point, check_point};
use crate::id::VertexId;

/// Read access to vertex positions in any storage.
///
/// The trait is implemented for [`Positions`] and for slices of points and of `[f64; 3]`. Coordinates
/// should be finite. A face with a NaN coordinate counts as lying in front of every plane.
pub trait Place {
    /// Returns the position of the vertex `v`.
    ///
    /// # Panics
    ///
    /// If the position of `v` is not stored.
    fn at(&self, v: VertexId) -> Point;
}

impl Place for [Point] {
    fn at(&self, v: VertexId) -> Point {
        *v.of(self)
    }
}

impl Place for [[f64; 3]] {
    fn at(&self, v: VertexId) -> Point {
        (*v.of(self)).into()
    }
}

/// The positions of the vertices of a mesh, updated from its log. All coordinates are finite.
///
/// ```
/// use tearmesh::{Positions, VertexId};
///
/// let positions = Positions::new([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])?;
/// assert_eq!(positions.at(VertexId::new(1).unwrap()).x, 1.0);
///
/// let error = Positions::new([[0.0, f64::NAN, 0.0]]).unwrap_err();
/// assert_eq!(error.to_string(), "1 vertex has a coordinate that is not usable: v0 (0, NaN, 0)");
/// # Ok::<(), tearmesh::PositionError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Positions {
    points: Vec<Point>,
    seen: Cursor,
}

impl Positions {
    /// Creates the list from the positions of all vertices, in the order of the ids. The list has
    /// seen no edit yet.
    ///
    /// # Errors
    ///
    /// [`PositionError`] lists every vertex with a coordinate that is not finite or exceeds
    /// [`COORDINATE_MAX`](crate::COORDINATE_MAX) in absolute value.
    pub fn new(
        points: impl IntoIterator<Item = impl Into<Point>>,
    ) -> Result<Positions, PositionError> {
        let points: Vec<Point> = points.into_iter().map(Into::into).collect();
        let vertices = (0..).map(VertexId::from_u32);
        let all = vertices.zip(points.iter().copied());
        let unusable: Vec<_> = all
            .filter(|&(_, point)| check_point(point).is_err())
            .collect();
        if unusable.is_empty() {
            let seen = Cursor::ASSUMED;
            Ok(Positions { points, seen })
        } else {
            Err(PositionError { unusable })
        }
    }

    /// Returns the place in the log up to which these positions have been replayed.
    #[must_use]
    pub fn seen(&self) -> Cursor {
        self.seen.known()
    }

    /// Reserves memory for `vertices` more vertices, so that replaying this many splits allocates
    /// nothing.
    pub fn reserve(&mut self, vertices: usize) {
        self.points.reserve(vertices);
    }

    /// Returns the position of the vertex `v`.
    ///
    /// # Panics
    ///
    /// If `v` is not a vertex of the list.
    #[inline]
    #[must_use]
    pub fn at(&self, v: VertexId) -> Point {
        *v.of(&self.points)
    }

    /// Returns the number of vertices.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Returns whether the list has no vertices.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Returns the positions of all vertices, indexed by vertex.
    #[must_use]
    pub fn as_slice(&self) -> &[Point] {
        &self.points
    }
}

impl Place for Positions {
    fn at(&self, v: VertexId) -> Point {
        self.at(v)
    }
}

/// A weighted mean of accepted coordinates is not larger than they are, so positions stay valid.
impl Follower for Positions {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        for op in edit.vertex_ops() {
            op.apply(&mut self.points, Blend::blend);
        }
    }
}

/// The reason why positions were refused: a list of the vertices with unusable coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct PositionError {
    unusable: Vec<(VertexId, Point)>,
}

impl PositionError {
    /// Returns every vertex with a coordinate that is not finite or is too large, with its
    /// position. The list is in ascending order of vertices, and never empty.
    #[must_use]
    pub fn unusable(&self) -> &[(VertexId, Point)] {
        &self.unusable
    }
}

/// How many vertices a message shows.
const SHOWN: usize = 20;

impl fmt::Display for PositionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.unusable.len();
        let (noun, verb) = if count == 1 {
            ("vertex", "has")
        } else {
            ("vertices", "have")
        };
        let shown = self.unusable.iter().take(SHOWN);
        let shown = shown.map(|(v, p)| format!("{v} ({}, {}, {})", p.x, p.y, p.z));
        let shown = shown.collect::<Vec<String>>().join(", ");
        write!(
            f,
            "{count} {noun} {verb} a coordinate that is not usable: {shown}"
        )?;
        if count > SHOWN {
            write!(f, " and {} more", count - SHOWN)?;
        }
        Ok(())
    }
}

impl std::error::Error for PositionError {}

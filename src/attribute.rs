//! Data kept beside the mesh: one value for each vertex or corner.
//!
//! A split duplicates a vertex and moves corners. What belongs to the vertex is copied to the new
//! one ([`PerVertex`]). What belongs to the corner, such as a texture coordinate, stays with it
//! ([`PerCorner`]): a split never makes a texture seam. Where a vertex is inserted, values are
//! interpolated corner by corner, so a texture seam stays a seam. Where two vertices are merged,
//! their values are averaged by weight ([`Blend`]).
//!
//! Each of these lists carries its place in the log. A list of any other type can follow a log too:
//! see [`Edits::replay_vertices`](crate::Edits::replay_vertices), and for values of faces, of which
//! children get copies, [`Edits::replay_faces`](crate::Edits::replay_faces).

use std::marker::PhantomData;

use crate::edit::{Cursor, Edit, Follower, Mix};
use crate::geometry::{Point, Vector, between};
use crate::id::{HalfEdgeId, VertexId};

/// A value that can be interpolated.
///
/// The trait is implemented for floats, [`Point`], [`Vector`], and arrays of values that implement
/// it. Corners of one vertex that hold equal values are treated as sharing one value.
pub trait Blend: Clone + PartialEq {
    /// Returns the value at the fraction `t` of the way from `self` to `other`: `self + t (other −
    /// self)`. If `self` and `other` are equal, the result must equal them.
    #[must_use]
    fn between(&self, other: &Self, t: f64) -> Self;

    /// Returns the weighted sum of three values. The weights are positive, and their sum is one up
    /// to rounding.
    #[must_use]
    fn weighted(values: [&Self; 3], weights: [f64; 3]) -> Self;

    /// Computes a value from the one, two or three values that it derives from.
    #[must_use]
    fn blend(mix: Mix<&Self>) -> Self {
        match mix {
            Mix::Copy(one) => one.clone(),
            Mix::Between { ends: [a, b], t } => a.between(b, t),
            Mix::Weighted { of, weights } => Self::weighted(of, weights),
        }
    }
}

impl Blend for f64 {
    fn between(&self, other: &f64, t: f64) -> f64 {
        self - (self - other) * t
    }

    fn weighted([a, b, c]: [&f64; 3], weights: [f64; 3]) -> f64 {
        a * weights[0] + b * weights[1] + c * weights[2]
    }
}

impl Blend for f32 {
    fn between(&self, other: &f32, t: f64) -> f32 {
        f64::from(*self).between(&f64::from(*other), t) as f32
    }

    fn weighted(values: [&f32; 3], weights: [f64; 3]) -> f32 {
        let [a, b, c] = values.map(|&x| f64::from(x));
        f64::weighted([&a, &b, &c], weights) as f32
    }
}

impl<T: Blend, const N: usize> Blend for [T; N] {
    fn between(&self, other: &[T; N], t: f64) -> [T; N] {
        std::array::from_fn(|i| self[i].between(&other[i], t))
    }

    fn weighted(values: [&[T; N]; 3], weights: [f64; 3]) -> [T; N] {
        std::array::from_fn(|i| T::weighted(values.map(|value| &value[i]), weights))
    }
}

impl Blend for Vector {
    fn between(&self, other: &Vector, t: f64) -> Vector {
        self - (self - other) * t
    }

    fn weighted([a, b, c]: [&Vector; 3], weights: [f64; 3]) -> Vector {
        a * weights[0] + b * weights[1] + c * weights[2]
    }
}

impl Blend for Point {
    fn between(&self, other: &Point, t: f64) -> Point {
        between(*self, *other, t)
    }

    fn weighted(values: [&Point; 3], weights: [f64; 3]) -> Point {
        Vector::weighted(values.map(|point| &point.coords), weights).into()
    }
}

/// One value for each vertex. A split copies the value of the old vertex to the new one.
///
/// ```
/// use tearmesh::{shapes, split, Edits, PerVertex};
///
/// let (mut mesh, _) = shapes::grid(1, 1);
/// let mut speeds = PerVertex::new(vec![0.5, 1.0, 1.5, 2.0]);
/// let mut edits = Edits::new();
/// let (v, face) = (mesh.vertex(0), mesh.face(0));
/// split::vertex(&mut mesh, v, &[face], &mut edits)?;
/// edits.replay(&mut speeds);
/// assert_eq!(speeds.at(mesh.vertex(4)), &0.5);
/// # Ok::<(), tearmesh::SplitRefusal>(())
/// ```
pub type PerVertex<T> = Values<VertexId, T>;

/// One value for each corner. A split or a merge does not change corner values. Where a face is
/// divided, the values of its children's corners are interpolated from the corners of that face
/// alone. Where a vertex slides along an edge, the values of its corners in the faces of that edge
/// are interpolated along it; its other corners with the same value change with them.
///
/// ```
/// use tearmesh::{shapes, insert::Plan, Edits, PerCorner};
///
/// let (mut mesh, positions) = shapes::grid(1, 1);
/// let uv = mesh.half_edges().map(|h| positions.at(mesh.origin(h)));
/// let mut uv = PerCorner::new(uv.map(|p| [p.x, p.y]).collect());
/// let mut plan = Plan::new();
/// plan.on_edge(mesh.half_edge(0), 0.25);
/// let mut edits = Edits::new();
/// plan.apply(&mut mesh, &mut edits)?;
/// edits.replay(&mut uv);
/// assert_eq!(uv.as_slice().iter().filter(|uv| **uv == [0.25, 0.0]).count(), 2);
/// # Ok::<(), tearmesh::InsertRefusal>(())
/// ```
pub type PerCorner<T> = Values<HalfEdgeId, T>;

/// One value for each id of a kind, and their place in the log: see [`PerVertex`] and [`PerCorner`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Values<I, T> {
    values: Vec<T>,
    seen: Cursor,
    of: PhantomData<I>,
}

impl<I, T> Values<I, T> {
    /// Creates the list from one value for each id, in the order of the ids. The list has seen no
    /// edit yet.
    #[must_use]
    pub fn new(values: Vec<T>) -> Self {
        Values {
            values,
            seen: Cursor::ASSUMED,
            of: PhantomData,
        }
    }

    /// Reserves memory for `more` values. With as many as splits make vertices, replaying these
    /// allocates nothing except for cloning values.
    pub fn reserve(&mut self, more: usize) {
        self.values.reserve(more);
    }

    /// Returns all values, indexed by id.
    #[must_use]
    pub fn as_slice(&self) -> &[T] {
        &self.values
    }
}

impl<T> Values<VertexId, T> {
    /// Returns the value of the vertex `v`.
    ///
    /// # Panics
    ///
    /// If `v` is not a vertex of the list.
    #[must_use]
    pub fn at(&self, v: VertexId) -> &T {
        v.of(&self.values)
    }

    /// Returns a mutable reference to the value of the vertex `v`.
    ///
    /// # Panics
    ///
    /// If `v` is not a vertex of the list.
    #[must_use]
    pub fn at_mut(&mut self, v: VertexId) -> &mut T {
        &mut self.values[v.index()]
    }
}

impl<T> Values<HalfEdgeId, T> {
    /// Returns the value of the corner at which the half-edge `h` starts.
    ///
    /// # Panics
    ///
    /// If `h` is not a corner of the list.
    #[must_use]
    pub fn at(&self, h: HalfEdgeId) -> &T {
        h.of(&self.values)
    }
}

impl<T: Blend> Follower for PerVertex<T> {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        for op in edit.vertex_ops() {
            op.apply(&mut self.values, T::blend);
        }
    }
}

impl<T: Blend> Follower for PerCorner<T> {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        edit.apply_to_corners(&mut self.values, T::blend);
    }
}

//! Data beside the mesh: values of vertices, of corners and of faces.
//!
//! A split duplicates a vertex and moves corners. What belongs to the vertex is copied
//! to the new one ([`PerVertex`]). What belongs to the corner, such as a texture
//! coordinate, stays with it ([`PerCorner`]): a split never makes a texture seam. Where a vertex
//! is inserted, values are interpolated, corner by corner, so a texture seam stays one; where two
//! are merged, those of the vertex are joined by weight. [`Blend`] says how. What belongs to a face
//! ([`PerFace`]) is copied to its children.
//!
//! Each is a list with its place in the log. A list of another type follows a log without these:
//! see [`Edits::replay_vertices`](crate::Edits::replay_vertices).

use crate::edit::{Cursor, Edit, Follower, Mix};
use crate::geometry::{Point, Vector, between};
use crate::id::{FaceId, HalfEdgeId, VertexId};

/// A value that can be interpolated.
///
/// Implemented for floats, arrays of what can be blended, [`Point`] and [`Vector`]. Equal
/// corners of a vertex are taken for one value.
pub trait Blend: Clone + PartialEq {
    /// The value at the part `t` of the way from `self` to `other`: `self + t (other − self)`.
    /// Equal values have to give that value.
    #[must_use]
    fn between(&self, other: &Self, t: f64) -> Self;

    /// The weighted sum of three values. The weights are positive and of sum one.
    #[must_use]
    fn weighted(values: [&Self; 3], weights: [f64; 3]) -> Self;

    /// The value that one, two or three others give.
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

/// One value for each vertex. The new vertex of a split has a copy of the old one's.
///
/// ```
/// use tearmesh::{shapes, split, Edits, FaceId, PerVertex, VertexId};
///
/// let (mut mesh, _) = shapes::grid(1, 1);
/// let mut speeds = PerVertex::new(vec![0.5, 1.0, 1.5, 2.0]);
/// let mut edits = Edits::new();
/// let v = VertexId::new(0).unwrap();
/// split::vertex(&mut mesh, v, &[FaceId::new(0).unwrap()], &mut edits)?;
/// edits.replay(&mut speeds);
/// assert_eq!(speeds.at(VertexId::new(4).unwrap()), &0.5);
/// # Ok::<(), tearmesh::SplitRefusal>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerVertex<T> {
    values: Vec<T>,
    seen: Cursor,
}

impl<T: Blend> PerVertex<T> {
    /// The values of vertices 0, 1, 2, …, which have seen no edit yet.
    #[must_use]
    pub fn new(values: Vec<T>) -> Self {
        let seen = Cursor::START;
        PerVertex { values, seen }
    }

    /// Takes the values for those of the mesh at this place in its log.
    #[must_use]
    pub fn starting_at(self, seen: Cursor) -> Self {
        PerVertex { seen, ..self }
    }

    /// Up to where the values have seen the log of the mesh.
    #[must_use]
    pub fn seen(&self) -> Cursor {
        self.seen
    }

    /// Makes room for this many more vertices, so that as many splits can be replayed without
    /// allocation but that of the clones.
    pub fn reserve(&mut self, vertices: usize) {
        self.values.reserve(vertices);
    }

    /// The value of a vertex.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn at(&self, v: VertexId) -> &T {
        v.of(&self.values)
    }

    /// The value of a vertex, to be changed.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn at_mut(&mut self, v: VertexId) -> &mut T {
        &mut self.values[v.index()]
    }

    /// The values of all vertices, by id.
    #[must_use]
    pub fn as_slice(&self) -> &[T] {
        &self.values
    }

    /// The values of all vertices, by id, to be changed.
    #[must_use]
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.values
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

/// One value for each corner. A split or a merge leaves them where they are; where a face is
/// divided, its children get theirs from the corners of that face alone. Where a vertex slides,
/// the corners in the faces of the edge are interpolated along it, and all others with the same
/// value go with them.
///
/// ```
/// use tearmesh::{shapes, insert::Plan, Edits, HalfEdgeId, PerCorner};
///
/// let (mut mesh, positions) = shapes::grid(1, 1);
/// let uv = mesh.half_edges().map(|h| positions.at(mesh.origin(h)));
/// let mut uv = PerCorner::new(uv.map(|p| [p.x, p.y]).collect());
/// let mut plan = Plan::new();
/// plan.on_edge(HalfEdgeId::new(0).unwrap(), 0.25);
/// let mut edits = Edits::new();
/// plan.apply(&mut mesh, &mut edits)?;
/// edits.replay(&mut uv);
/// assert_eq!(uv.as_slice().iter().filter(|uv| **uv == [0.25, 0.0]).count(), 2);
/// # Ok::<(), tearmesh::InsertRefusal>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerCorner<T> {
    values: Vec<T>,
    seen: Cursor,
}

impl<T: Blend> PerCorner<T> {
    /// The values of corners 0, 1, 2, … (three a face), which have seen no edit yet.
    #[must_use]
    pub fn new(values: Vec<T>) -> Self {
        let seen = Cursor::START;
        PerCorner { values, seen }
    }

    /// Takes the values for those of the mesh at this place in its log.
    #[must_use]
    pub fn starting_at(self, seen: Cursor) -> Self {
        PerCorner { seen, ..self }
    }

    /// The value of a corner.
    ///
    /// # Panics
    ///
    /// If there is no such corner.
    #[must_use]
    pub fn at(&self, h: HalfEdgeId) -> &T {
        h.of(&self.values)
    }

    /// The values of all corners, by half-edge.
    #[must_use]
    pub fn as_slice(&self) -> &[T] {
        &self.values
    }
}

impl<T: Blend> Follower for PerCorner<T> {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        for op in edit.corner_ops() {
            op.apply(&mut self.values, T::blend);
        }
    }
}

/// One value for each face, such as a material. Where a face is divided, each of its children has a
/// copy; nothing else changes a face.
///
/// ```
/// use tearmesh::{shapes, insert::Plan, Edits, HalfEdgeId, PerFace};
///
/// let (mut mesh, _) = shapes::grid(1, 1);
/// let mut materials = PerFace::new(vec!["silk", "wool"]);
/// let mut plan = Plan::new();
/// plan.on_edge(HalfEdgeId::new(0).unwrap(), 0.5);
/// let mut edits = Edits::new();
/// plan.apply(&mut mesh, &mut edits)?;
/// edits.replay(&mut materials);
/// assert_eq!(materials.as_slice(), ["silk", "wool", "silk"]);
/// # Ok::<(), tearmesh::InsertRefusal>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerFace<T> {
    values: Vec<T>,
    seen: Cursor,
}

impl<T: Clone> PerFace<T> {
    /// The values of faces 0, 1, 2, …, which have seen no edit yet.
    #[must_use]
    pub fn new(values: Vec<T>) -> Self {
        let seen = Cursor::START;
        PerFace { values, seen }
    }

    /// Takes the values for those of the mesh at this place in its log.
    #[must_use]
    pub fn starting_at(self, seen: Cursor) -> Self {
        PerFace { seen, ..self }
    }

    /// The value of a face.
    ///
    /// # Panics
    ///
    /// If there is no such face.
    #[must_use]
    pub fn at(&self, f: FaceId) -> &T {
        f.of(&self.values)
    }

    /// The values of all faces, by id.
    #[must_use]
    pub fn as_slice(&self) -> &[T] {
        &self.values
    }
}

impl<T: Clone> Follower for PerFace<T> {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        for family in edit.families() {
            family.apply_to_faces(&mut self.values);
        }
    }
}

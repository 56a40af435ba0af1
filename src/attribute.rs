//! Data beside the mesh: values of vertices, and values of corners.
//!
//! A split duplicates a vertex and moves corners. What belongs to the vertex is copied
//! to the new one ([`PerVertex`]). What belongs to the corner, such as a texture
//! coordinate, stays with it ([`PerCorner`]): a split never makes a texture seam. Where a vertex
//! is inserted, values are interpolated, corner by corner, so a texture seam stays one; where two
//! are merged, those of the vertex are joined by weight. [`Blend`] says how.

use crate::edit::{Edit, Follower, Location, Source};
use crate::geometry::{Point, Vector};
use crate::id::{HalfEdgeId, VertexId};

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
        self.coords.between(&other.coords, t).into()
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
/// assert_eq!(speeds[VertexId::new(4).unwrap()], 0.5);
/// # Ok::<(), tearmesh::split::Refusal>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerVertex<T> {
    values: Vec<T>,
    next_edit: u64,
}

impl<T: Blend> PerVertex<T> {
    /// The values of vertices 0, 1, 2, …, which have seen no edit yet.
    #[must_use]
    pub fn new(values: Vec<T>) -> Self {
        PerVertex {
            values,
            next_edit: 0,
        }
    }

    /// The same values, for a log whose next record has this number.
    #[must_use]
    pub fn starting_at(self, next_edit: u64) -> Self {
        PerVertex { next_edit, ..self }
    }

    /// Makes room for this many more vertices, so that as many splits can be replayed without
    /// allocation but that of the clones.
    pub fn reserve(&mut self, vertices: usize) {
        self.values.reserve(vertices);
    }

    /// The values of all vertices, by id.
    #[must_use]
    pub fn as_slice(&self) -> &[T] {
        &self.values
    }

    /// The same, to be changed.
    #[must_use]
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.values
    }
}

impl<T> std::ops::Index<VertexId> for PerVertex<T> {
    type Output = T;

    fn index(&self, v: VertexId) -> &T {
        v.of(&self.values)
    }
}

impl<T> std::ops::IndexMut<VertexId> for PerVertex<T> {
    fn index_mut(&mut self, v: VertexId) -> &mut T {
        &mut self.values[v.index()]
    }
}

impl<T: Blend> Follower for PerVertex<T> {
    fn next_edit(&self) -> u64 {
        self.next_edit
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        let in_step = |new: VertexId, count: usize| {
            assert_eq!(new.index(), count, "values are in step with the mesh");
        };
        match edit {
            Edit::Split(split) => {
                in_step(split.new, self.values.len());
                self.values.push(self[split.old].clone());
            }
            Edit::Insert(insert) => {
                for point in insert.points {
                    in_step(point.vertex, self.values.len());
                    let value = match point.at {
                        Location::Edge { ends: [a, b], t } => self[a].between(&self[b], t),
                        Location::Face { vertices, weights } => {
                            T::weighted(vertices.map(|v| &self[v]), weights)
                        }
                    };
                    self.values.push(value);
                }
            }
            Edit::Merge(merge) => {
                let gone = self.values.swap_remove(merge.gone.index());
                self[merge.kept] = self[merge.kept].between(&gone, 1.0 - merge.share);
            }
            Edit::Slide(slide) => {
                self[slide.vertex] = self[slide.vertex].between(&self[slide.toward], slide.t);
            }
        }
        self.next_edit = edit.number() + 1;
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
/// # Ok::<(), tearmesh::insert::Refusal>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerCorner<T> {
    values: Vec<T>,
    next_edit: u64,
}

impl<T: Blend> PerCorner<T> {
    /// The values of corners 0, 1, 2, … (three a face), which have seen no edit yet.
    #[must_use]
    pub fn new(values: Vec<T>) -> Self {
        PerCorner {
            values,
            next_edit: 0,
        }
    }

    /// The same values, for a log whose next record has this number.
    #[must_use]
    pub fn starting_at(self, next_edit: u64) -> Self {
        PerCorner { next_edit, ..self }
    }

    /// The values of all corners, by half-edge.
    #[must_use]
    pub fn as_slice(&self) -> &[T] {
        &self.values
    }
}

impl<T> std::ops::Index<HalfEdgeId> for PerCorner<T> {
    type Output = T;

    fn index(&self, h: HalfEdgeId) -> &T {
        h.of(&self.values)
    }
}

impl<T: Blend> Follower for PerCorner<T> {
    fn next_edit(&self) -> u64 {
        self.next_edit
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            // The corners move with their faces to another vertex, and keep their values.
            Edit::Split(_) | Edit::Merge(_) => {}
            Edit::Insert(insert) => {
                for family in insert.families() {
                    let parent = family[0].parent.half_edges();
                    let before = parent.map(|h| self[h].clone());
                    for child in family {
                        let values = child.sources.map(|source| from(&source, &before));
                        let start = 3 * child.face.index();
                        if child.face == child.parent {
                            self.values[start..start + 3].clone_from_slice(&values);
                        } else {
                            assert_eq!(
                                start,
                                self.values.len(),
                                "values are in step with the mesh"
                            );
                            self.values.extend(values);
                        }
                    }
                }
            }
            Edit::Slide(slide) => {
                let changes = slide.along.map(|corners| {
                    let [corner, toward] = corners?;
                    let before = self[corner].clone();
                    let after = before.between(&self[toward], slide.t);
                    Some((corner, before, after))
                });
                let changes: Vec<_> = changes.into_iter().flatten().collect();
                for &h in slide.corners {
                    // Where values differ round the vertex there is a seam, and the edge is
                    // none of the other side's.
                    let value = &mut self.values[h.index()];
                    let own = changes.iter().find(|(corner, ..)| *corner == h);
                    let same = || changes.iter().find(|(_, before, _)| before == value);
                    if let Some((.., after)) = own.or_else(same) {
                        *value = after.clone();
                    }
                }
            }
        }
        self.next_edit = edit.number() + 1;
    }
}

/// The value at a place in a face whose corners have these values.
fn from<T: Blend>(source: &Source, corners: &[T; 3]) -> T {
    let at = |h: HalfEdgeId| &corners[h.corner()];
    match *source {
        Source::Corner(h) => at(h).clone(),
        Source::Edge { ends: [a, b], t } => at(a).between(at(b), t),
        Source::Face { weights } => T::weighted(corners.each_ref(), weights),
    }
}

//! The normal form of records, for code that keeps plain *values* beside a mesh.
//!
//! There are four kinds of [`Edit`], and each says why something changed. Code that keeps one value
//! for each vertex, corner or face need not know why: a value is pushed, set or removed, and a new
//! value derives from up to three others. That is what [`VertexOp`], [`CornerOp`] and
//! [`FaceFamily`] express. They are derived from a record without allocation, and a new kind of
//! edit would be made of the same operations.
//!
//! | edit | vertices | corners | faces |
//! |---|---|---|---|
//! | split | push a copy of the old vertex | some become the new vertex's | |
//! | insertion | push each point between its sources | divide each family | divide each family |
//! | merge | set the one kept between both; take out the other, whose place the last one takes | those of both become others' | |
//! | slide | set the vertex between itself and its neighbour | slide them along | |
//!
//! A quantity that is *divided* rather than copied, such as mass, is not a value in this sense:
//! each half of a split vertex weighs less than the whole did. [`Masses`](crate::Masses) therefore
//! reads the records themselves.

use super::mix::Mix;
use super::record::{ChildFace, Edit, Insert, Slide};
use crate::id::{FaceId, HalfEdgeId, VertexId};

/// A change to a list that has one value for each vertex. The operations of one edit must be
/// applied in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VertexOp {
    /// Appends a value to the list.
    Push {
        /// The vertex that gets the value. Its index is the length of the list before the change.
        new: VertexId,
        /// The vertices whose values the new value derives from.
        from: Mix<VertexId>,
    },
    /// Replaces a value of the list.
    Set {
        /// The vertex whose value is replaced.
        at: VertexId,
        /// The vertices whose values the new value derives from. They may include `at`.
        from: Mix<VertexId>,
    },
    /// Removes a value; the last value of the list takes its place, as in [`Vec::swap_remove`].
    SwapRemove {
        /// The vertex whose value is removed.
        gone: VertexId,
    },
}

impl VertexOp {
    /// Applies this operation to a list of values. `mix` computes a new value from the values that
    /// it derives from.
    ///
    /// # Panics
    ///
    /// If the list does not have one value for each vertex.
    #[inline]
    pub fn apply<T>(self, values: &mut Vec<T>, mut mix: impl FnMut(Mix<&T>) -> T) {
        match self {
            VertexOp::Push { new, from } => {
                assert_eq!(
                    new.index(),
                    values.len(),
                    "values are in step with the mesh"
                );
                let value = mix(from.map(|v| v.of(values)));
                values.push(value);
            }
            VertexOp::Set { at, from } => {
                let value = mix(from.map(|v| v.of(values)));
                values[at.index()] = value;
            }
            VertexOp::SwapRemove { gone } => {
                values.swap_remove(gone.index());
            }
        }
    }
}

/// A divided face and the faces that replaced it, its *children*.
///
/// The first child keeps the id of the divided face. The other children are new faces, in ascending
/// order of their ids. So read the values of the divided face before writing any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceFamily<'e> {
    children: &'e [ChildFace],
}

impl<'e> FaceFamily<'e> {
    /// Returns the face that was divided. Its id is now that of the first child.
    #[must_use]
    pub fn parent(&self) -> FaceId {
        self.children[0].parent
    }

    /// Returns the children, of which there are at least two.
    #[must_use]
    pub fn children(&self) -> &'e [ChildFace] {
        self.children
    }

    /// Updates a list of face values: each child gets a copy of the value of the divided face.
    ///
    /// # Panics
    ///
    /// If the list does not have one value for each face.
    pub fn apply_to_faces<T: Clone>(&self, values: &mut Vec<T>) {
        for child in self.children {
            if child.face != child.parent {
                let value = child.parent.of(values).clone();
                push_at(child.face.index(), values, value);
            }
        }
    }

    /// Gives each corner of each child a value made of those that the corners of the parent had.
    fn apply_to_corners<T>(&self, values: &mut Vec<T>, mix: &mut impl FnMut(Mix<&T>) -> T) {
        let parent = self.parent().half_edges();
        let before = parent.map(|h| mix(Mix::Copy(h.of(values))));
        for child in self.children {
            for (corner, source) in child.face.half_edges().into_iter().zip(child.sources) {
                let value = mix(source.map(|h| &before[h.corner()]));
                if child.face == child.parent {
                    values[corner.index()] = value;
                } else {
                    push_at(corner.index(), values, value);
                }
            }
        }
    }
}

fn push_at<T>(place: usize, values: &mut Vec<T>, value: T) {
    assert_eq!(place, values.len(), "values are in step with the mesh");
    values.push(value);
}

/// A change to the vertices of corners and to a list that has one value for each corner. The
/// operations of one edit must be applied in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CornerOp<'e> {
    /// Assigns corners to another vertex. Their values do not change.
    Relabel {
        /// The corners that are assigned to the other vertex.
        corners: &'e [HalfEdgeId],
        /// The vertex that the corners belong to after the edit.
        to: VertexId,
    },
    /// Divides a face. See [`ChildFace::sources`] for the values of the new corners.
    Divide(FaceFamily<'e>),
    /// Slides a vertex along an edge. A corner in [`Slide::along`] gets the value at the fraction `t` of
    /// the way to that of the other corner. A corner of the vertex that is not in it, but has the same
    /// value as a corner in it, gets the same new value.
    Slide(Slide<'e>),
}

impl CornerOp<'_> {
    /// Applies this operation to a list of corner values. `mix` computes a new value from the
    /// values that it derives from.
    ///
    /// # Panics
    ///
    /// If the list does not have three values for each face.
    pub fn apply<T: PartialEq>(self, values: &mut Vec<T>, mut mix: impl FnMut(Mix<&T>) -> T) {
        match self {
            CornerOp::Relabel { .. } => {}
            CornerOp::Divide(family) => family.apply_to_corners(values, &mut mix),
            CornerOp::Slide(slide) => slide_values(slide, values, mix),
        }
    }

    /// Applies this operation to an index buffer, which holds the vertex of each corner.
    ///
    /// # Panics
    ///
    /// If the buffer does not have three indices for each face.
    pub fn apply_to_indices(self, indices: &mut Vec<u32>) {
        match self {
            CornerOp::Relabel { corners, to } => {
                for h in corners {
                    indices[h.index()] = to.into();
                }
            }
            CornerOp::Divide(family) => {
                for child in family.children() {
                    let start = 3 * child.face.index();
                    if child.face == child.parent {
                        indices[start..start + 3].copy_from_slice(&child.vertices.map(u32::from));
                    } else {
                        assert_eq!(start, indices.len(), "indices are in step with the mesh");
                        indices.extend(child.vertices.map(u32::from));
                    }
                }
            }
            CornerOp::Slide(_) => {}
        }
    }
}

/// Moves the values of corners along an edge.
fn slide_values<T: PartialEq>(
    slide: Slide<'_>,
    values: &mut [T],
    mut mix: impl FnMut(Mix<&T>) -> T,
) {
    let Slide {
        along, t, corners, ..
    } = slide;
    let changes = along.map(|ends| {
        let [corner, toward] = ends?;
        let before = mix(Mix::Copy(corner.of(values)));
        let ends = [corner.of(values), toward.of(values)];
        let after = mix(Mix::Between { ends, t });
        Some((corner, before, after))
    });
    let all = || changes.iter().flatten();
    for &h in corners {
        // Where values differ round the vertex there is a seam, and the edge is none of the other
        // side's.
        let value = &mut values[h.index()];
        let own = all().find(|(corner, ..)| *corner == h);
        let equal = || all().find(|(_, before, _)| before == value);
        if let Some((.., after)) = own.or_else(equal) {
            *value = mix(Mix::Copy(after));
        }
    }
}

impl<'e> Edit<'e> {
    /// Returns the operations that apply this edit to vertex values, in order.
    pub fn vertex_ops(&self) -> impl Iterator<Item = VertexOp> + use<'e> {
        let (mut points, mut changes) = (&[][..], [None; 2]);
        match self {
            Edit::Split(split) => {
                let (new, from) = (split.new, Mix::Copy(split.old));
                changes[0] = Some(VertexOp::Push { new, from });
            }
            Edit::Insert(insert) => points = insert.points,
            Edit::Merge(merge) => {
                let (at, gone) = (merge.kept, merge.gone);
                let (ends, t) = ([at, gone], 1.0 - merge.share);
                let from = Mix::Between { ends, t };
                changes = [
                    Some(VertexOp::Set { at, from }),
                    Some(VertexOp::SwapRemove { gone }),
                ];
            }
            Edit::Slide(slide) => {
                let (at, t) = (slide.vertex, slide.t);
                let ends = [at, slide.toward];
                let from = Mix::Between { ends, t };
                changes[0] = Some(VertexOp::Set { at, from });
            }
        }
        let pushes = points.iter().map(|point| VertexOp::Push {
            new: point.vertex,
            from: point.at,
        });
        pushes.chain(changes.into_iter().flatten())
    }

    /// Returns the operations that apply this edit to corners, in order.
    pub fn corner_ops(&self) -> impl Iterator<Item = CornerOp<'e>> + use<'e> {
        let mut changes = [None; 2];
        match *self {
            Edit::Split(split) => {
                let (corners, to) = (split.corners, split.new);
                changes[0] = Some(CornerOp::Relabel { corners, to });
            }
            Edit::Insert(_) => {}
            Edit::Merge(merge) => {
                let (corners, to) = (merge.corners, merge.kept);
                changes[0] = Some(CornerOp::Relabel { corners, to });
                changes[1] = merge.renumbered.map(|renumbered| CornerOp::Relabel {
                    corners: renumbered.corners,
                    to: renumbered.to,
                });
            }
            Edit::Slide(slide) => changes[0] = Some(CornerOp::Slide(slide)),
        }
        let divisions = self.families().map(CornerOp::Divide);
        divisions.chain(changes.into_iter().flatten())
    }

    /// Returns the faces that this edit divides, each with its children. The result is empty unless
    /// the edit is an insertion.
    pub fn families(&self) -> impl Iterator<Item = FaceFamily<'e>> + use<'e> {
        families(match self {
            Edit::Insert(insert) => insert.children,
            Edit::Split(_) | Edit::Merge(_) | Edit::Slide(_) => &[],
        })
    }
}

impl<'e> Insert<'e> {
    /// Returns the faces that this insertion divided, each with its children.
    pub fn families(&self) -> impl Iterator<Item = FaceFamily<'e>> + use<'e> {
        families(self.children)
    }
}

fn families(children: &[ChildFace]) -> impl Iterator<Item = FaceFamily<'_>> {
    let families = children.chunk_by(|one, next| one.parent == next.parent);
    families.map(|children| FaceFamily { children })
}

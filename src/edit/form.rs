//! The normal form of records, for code that keeps plain *values* beside a mesh.
//!
//! There are four kinds of [`Edit`], and each says why something changed. Code that keeps one value
//! for each vertex, corner or face need not know why: a value is pushed, set or removed, and a new
//! value derives from up to three others. That is what [`VertexOp`], [`Edit::apply_to_corners`] and
//! [`Edit::apply_to_faces`] express. They read a record without allocation, and a new kind of edit
//! would be made of the same operations.
//!
//! | edit | vertices | corners | faces |
//! |---|---|---|---|
//! | split | push a copy of the old vertex | | |
//! | insertion | push each point between its sources | divide each family | divide each family |
//! | merge | set the one kept between both; take out the other, whose place the last one takes | | |
//! | slide | set the vertex between itself and its neighbour | slide them along | |
//!
//! A quantity that is *divided* rather than copied, such as mass, is not a value in this sense:
//! each half of a split vertex weighs less than the whole did. [`Masses`](crate::Masses) therefore
//! reads the records themselves.

use super::mix::Mix;
use super::record::{ChildFace, Edit, Insert, Slide};
use crate::id::{HalfEdgeId, VertexId};

/// A change to a list that has one value for each vertex. The operations of one edit must be
/// applied in order.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
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
                assert_eq!(new.index(), values.len(), "{IN_STEP}");
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

    /// Applies this edit to a list of corner values. `mix` computes a new value from the values that it
    /// derives from.
    ///
    /// Where a face was divided, see [`ChildFace::sources`]. Where a vertex slid, a corner in
    /// [`Slide::along`] gets the value at the fraction `t` of the way to that of the other corner; a
    /// corner of the vertex that is not in it, but has the same value as one that is, gets the same new
    /// value.
    ///
    /// # Panics
    ///
    /// If the list does not have three values for each face.
    pub fn apply_to_corners<T: PartialEq>(
        &self,
        values: &mut Vec<T>,
        mut mix: impl FnMut(Mix<&T>) -> T,
    ) {
        match self {
            Edit::Insert(insert) => insert
                .families()
                .for_each(|family| divide_corners(family, values, &mut mix)),
            Edit::Slide(slide) => slide_values(*slide, values, mix),
            Edit::Split(_) | Edit::Merge(_) => {}
        }
    }

    /// Applies this edit to a list of face values: each child of a divided face gets a copy of its value.
    ///
    /// # Panics
    ///
    /// If the list does not have one value for each face.
    pub fn apply_to_faces<T: Clone>(&self, values: &mut Vec<T>) {
        let Edit::Insert(insert) = self else { return };
        for child in insert.children {
            if child.face != child.parent {
                let value = child.parent.of(values).clone();
                push_at(child.face.index(), values, value);
            }
        }
    }

    /// Applies this edit to an index buffer, which holds the vertex of each corner.
    ///
    /// # Panics
    ///
    /// If the buffer does not have three indices for each face.
    pub fn apply_to_indices(&self, indices: &mut Vec<u32>) {
        let relabel = |indices: &mut [u32], corners: &[HalfEdgeId], to: VertexId| {
            corners.iter().for_each(|h| indices[h.index()] = to.into());
        };
        match self {
            Edit::Split(split) => relabel(indices, split.corners, split.new),
            Edit::Insert(insert) => {
                for child in insert.children {
                    let corners = child.face.half_edges();
                    if child.face != child.parent {
                        let start = corners[0].index();
                        assert_eq!(start, indices.len(), "indices are in step with the mesh");
                        indices.resize(start + 3, 0);
                    }
                    for (h, v) in corners.into_iter().zip(child.vertices) {
                        indices[h.index()] = v.into();
                    }
                }
            }
            Edit::Merge(merge) => {
                relabel(indices, merge.corners, merge.kept);
                if let Some(last) = merge.renumbered {
                    relabel(indices, last.corners, last.to);
                }
            }
            Edit::Slide(_) => {}
        }
    }
}

impl<'e> Insert<'e> {
    /// Returns the faces that were divided, each as the children that replaced it, of which there are at
    /// least two.
    ///
    /// The first child keeps the id of the divided face. The other children are new faces, in ascending
    /// order of their ids. So read the values of the divided face before writing any.
    pub fn families(&self) -> impl Iterator<Item = &'e [ChildFace]> + use<'e> {
        self.children
            .chunk_by(|one, next| one.parent == next.parent)
    }
}

/// Gives each corner of each child a value made of those that the corners of the parent had.
pub(crate) fn divide_corners<T>(
    family: &[ChildFace],
    values: &mut Vec<T>,
    mut mix: impl FnMut(Mix<&T>) -> T,
) {
    let parent = family[0].parent.half_edges();
    let before = parent.map(|h| mix(Mix::Copy(h.of(values))));
    for child in family {
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

/// What values have to be that follow an edit.
pub(super) const IN_STEP: &str = "values are in step with the mesh from before the edit. Those of the mesh as it is \
                                  now begin with `starting_at(edits.cursor())`, where `edits` is its log";

fn push_at<T>(place: usize, values: &mut Vec<T>, value: T) {
    assert_eq!(place, values.len(), "{IN_STEP}");
    values.push(value);
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

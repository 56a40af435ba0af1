//! The sliding of a vertex along an edge.
//!
//! A straight cut may move a vertex that is almost on its plane onto it ([`Scissor::with_snap_move`]).
//! The mesh does not change but for a count of slides; its positions and other values do. Values at the vertex are
//! interpolated along the edge, so a texture on the surface stays in place, and the rest state of a
//! cloth still describes the same cloth. Masses do not change.
//!
//! [`Scissor::with_snap_move`]: crate::Scissor::with_snap_move

use std::fmt;

use crate::edit::{Edit, Edits, Slide};
use crate::id::VertexId;
use crate::mesh::Mesh;

/// Slides a vertex toward a neighbour by the fraction `t` of the distance between them, where `t`
/// is strictly between 0 and 1.
///
/// ```text
///   o-----o-----o            o-----o-----o
///   | \   |   / |            |\    |   / |
///   |   \ | /   |            | \  /  /   |    No face and no edge changes: the vertex and what
///   q-----v-----o     ->     q--v--------o    its corners have lie further along the edge v q.
///   |   / | \   |            | /  \  \   |
///   | /   |   \ |            |/    |   \ |
///   o-----o-----o            o-----o-----o
/// ```
///
/// # Errors
///
/// [`SlideRefusal`] gives the reason for a refusal. Nothing has changed then.
///
/// # Panics
///
/// If a vertex is not in this mesh (I2).
///
/// ```
/// use tearmesh::{shapes, slide, Edits};
///
/// let (mut mesh, mut positions) = shapes::grid(2, 1);
/// let [v, w] = [0, 1].map(|i| mesh.vertex(i));
/// let mut edits = Edits::new();
/// edits.replay(&mut positions); // They are those from before the slide.
/// slide::toward(&mut mesh, v, w, 0.25, &mut edits)?;
/// edits.replay(&mut positions);
/// assert_eq!(positions.at(v).x, 0.125);
/// # Ok::<(), slide::SlideRefusal>(())
/// ```
pub fn toward<'e>(
    mesh: &mut Mesh,
    vertex: VertexId,
    toward: VertexId,
    t: f64,
    edits: &'e mut Edits,
) -> Result<Slide<'e>, SlideRefusal> {
    let _known = [vertex, toward].map(|v| mesh.half_edge_of(v));
    if !(t > 0.0 && t < 1.0) {
        return Err(SlideRefusal::Parameter { t });
    }
    let mut along = [None; 2];
    for h in mesh.corners_of(vertex) {
        if mesh.target(h) == toward {
            along[0] = Some([h, h.next()]);
        }
        if mesh.origin(h.prev()) == toward {
            along[1] = Some([h, h.prev()]);
        }
    }
    if along == [None; 2] {
        return Err(SlideRefusal::Apart { vertex, toward });
    }
    for h in mesh.corners_of(vertex) {
        edits.note_corner(h);
    }
    let slide = Slide {
        before: edits.cursor(),
        vertex,
        toward,
        t,
        along,
        corners: &[],
        slides_before: mesh.count_slide(),
    };
    let Edit::Slide(slide) = edits.finish(Edit::Slide(slide), 0, mesh.size()) else {
        unreachable!("a slide was finished");
    };
    Ok(slide)
}

/// The reason why a slide was refused. Nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SlideRefusal {
    /// The parameter is not strictly between 0 and 1.
    Parameter {
        /// The parameter given.
        t: f64,
    },
    /// No edge joins the two vertices.
    Apart {
        /// The vertex that was to slide.
        vertex: VertexId,
        /// The vertex toward which it was to slide.
        toward: VertexId,
    },
}

impl fmt::Display for SlideRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SlideRefusal::Parameter { t } => {
                write!(f, "nothing slid: {t} is not between 0 and 1")
            }
            SlideRefusal::Apart { vertex, toward } => {
                write!(f, "{vertex} did not slide: no edge joins it to {toward}")
            }
        }
    }
}

impl std::error::Error for SlideRefusal {}

//! The result of a cut: its sides, seam, tips and pieces, and the ends from which another cut can
//! continue.

use super::cut_result::{Sides, side_of};
use super::exact::layers::LayerHit;
use super::seam::SeamLine;
use crate::edit::{Cursor, Edit, Follower};
use crate::geometry::{Ray, Side};
use crate::id::{FaceId, VertexId};
use crate::mesh::{Components, Mesh};

/// The result of a cut. The divided faces and new vertices are in the log.
///
/// ```
/// use tearmesh::{shapes, Cut, CutMethod, Edits, Plane, Point, Scissor, Side, Vector};
///
/// let (mut mesh, mut positions) = shapes::grid(8, 8);
/// let plane = Plane::new(Point::new(0.3, 0.0, 0.0), Vector::new(1.0, 0.2, 0.0))?;
/// let mut edits = Edits::new();
/// let cut = Scissor::by_plane(plane).cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)?;
///
/// let [line] = cut.seam().collect::<Vec<_>>()[..] else { panic!("one line across the sheet") };
/// for &[front, back] in &line.lips {
///     assert_eq!(mesh.ghost_pair(front), Some(back)); // they were a pair before
///     assert_eq!(cut.side(front.face()), Some(Side::Front));
/// }
/// assert_eq!(line.tips, [None, None]); // it goes from boundary to boundary
///
/// let pieces = cut.pieces(&mesh);
/// assert_eq!(pieces.sides, [Some(Side::Back), Some(Side::Front)]);
/// let front = mesh.faces().filter(|&f| pieces.components.of(f) == 1); // for a mesh of its own
/// assert!(front.count() > 80);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Cut {
    pub(super) touched: Sides,
    pub(super) lines: Vec<SeamLine>,
    pub(super) hits: [Option<LayerHit>; 2],
    pub(super) ends: Option<[CutEnd; 2]>,
}

impl Cut {
    /// Returns the faces that have a vertex on the seam, in ascending order, each with its side.
    /// The side is `None` for a face that extends to both sides, beyond an end of the slit or where
    /// nothing was cut. A face that lies in the plane has the side of the faces around it.
    #[must_use]
    pub fn sides(&self) -> &[(FaceId, Option<Side>)] {
        &self.touched
    }

    /// Returns the side of a face, or `None` if [`Cut::sides`] lists the face without a side or not at all.
    #[must_use]
    pub fn side(&self, f: FaceId) -> Option<Side> {
        side_of(&self.touched, f)
    }

    /// Returns the lines of the seam. A line consists of edges that the cut tore, and ends where
    /// the seam ends or branches. Closed lines come last.
    #[must_use]
    pub fn seam(&self) -> impl ExactSizeIterator<Item = &SeamLine> {
        self.lines.iter()
    }

    /// Returns the vertices at which the seam ends inside the mesh, in the order of the lines.
    pub fn tips(&self) -> impl Iterator<Item = VertexId> {
        self.lines.iter().flat_map(|line| line.tips).flatten()
    }

    /// Returns where each ray met a layer that was cut, or `None` for a ray that found no layer or a cut
    /// without [`CutLayers::First`]. If the two hits have different chains, both chains were cut.
    ///
    /// [`CutLayers::First`]: super::CutLayers::First
    #[must_use]
    pub fn layers(&self) -> [Option<LayerHit>; 2] {
        self.hits
    }

    /// Returns the two ends of a cut between rays, in the order of the rays, or `None` for a cut by
    /// a plane. Another cut can continue from an end.
    #[must_use]
    pub fn ends(&self) -> Option<&[CutEnd; 2]> {
        self.ends.as_ref()
    }

    /// Returns the pieces of the mesh, which must not have been edited since the cut. Linear.
    #[must_use]
    pub fn pieces(&self, mesh: &Mesh) -> CutPieces {
        let components = mesh.components();
        let mut has = vec![[false; 2]; components.count()];
        for [front, back] in self.lines.iter().flat_map(|line| line.lips.iter().copied()) {
            has[components.of(front.face())][0] = true;
            has[components.of(back.face())][1] = true;
        }
        let side = |has: &[bool; 2]| match has {
            [true, false] => Some(Side::Front),
            [false, true] => Some(Side::Back),
            _ => None,
        };
        CutPieces {
            sides: has.iter().map(side).collect(),
            components,
        }
    }
}

/// The pieces of a mesh after a cut. Piece `i` is component `i`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CutPieces {
    /// The component of each face.
    pub components: Components,
    /// The side of the seam on which each piece lies, indexed by piece. It is `None` if the
    /// piece has both lips of the seam, or no part of it.
    pub sides: Vec<Option<Side>>,
}

/// An end of a cut, from which another cut can continue: see
/// [`Scissor::continued`](super::Scissor::continued).
///
/// It stores vertex ids and is therefore a follower. If the mesh was edited since the cut, replay
/// the log on this end before using it.
#[derive(Clone, Debug, PartialEq)]
pub struct CutEnd {
    pub(super) ray: Ray,
    /// The vertices, one for each sheet that was cut up to the ray and copies of it.
    pub(super) vertices: Vec<VertexId>,
    pub(super) seen: Cursor,
}

impl CutEnd {
    /// Returns the ray at which the cut ended.
    #[must_use]
    pub fn ray(&self) -> Ray {
        self.ray
    }

    /// Returns the vertices at which a continuing cut begins. The result is empty unless a cut by
    /// the method `exact` ended at the ray.
    #[must_use]
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }
}

impl Follower for CutEnd {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Split(split) if self.vertices.contains(&split.old) => {
                self.vertices.push(split.new);
            }
            Edit::Merge(merge) => {
                let now = |v: VertexId| match merge.renumbered {
                    _ if v == merge.gone => merge.kept,
                    Some(renumbered) if v == renumbered.from => renumbered.to,
                    _ => v,
                };
                let mut vertices = Vec::new();
                for v in self.vertices.drain(..).map(now) {
                    if !vertices.contains(&v) {
                        vertices.push(v);
                    }
                }
                self.vertices = vertices;
            }
            Edit::Split(_) | Edit::Insert(_) | Edit::Slide(_) => {}
        }
    }
}

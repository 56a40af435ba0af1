//! Pieces as meshes of their own.
//!
//! A piece is what the mesh has on some of its faces: pairs, and ghost pairs between two of them, stay
//! what they are; a ghost link to another piece becomes boundary. Nothing is built anew, so a vertex with
//! several fans, which [`Mesh::build`] refuses, is as good as any other.
//!
//! The corners of a vertex lie in one orbit of ρ (I8), and where a part of that orbit is in another
//! piece, what is left may be several. Each gets a vertex of its own:
//!
//! ```text
//!     ╲ A ╱               v has the fans A and C, of one piece, and w, at the same place, B and D, each
//!      ╲ ╱                of another. The way from A to C round v leads through B or D. In the piece A
//!   B  v·w  D             and C have no way, and so no edge of theirs can ever have been one: they
//!      ╱ ╲                are two vertices there.
//!     ╱ C ╲
//! ```

use super::{Components, Link, Mesh, NO_HALF_EDGE};
use crate::id::{FaceId, HalfEdgeId, VertexId};

impl Mesh {
    /// Builds a separate mesh from each component, with maps back to this mesh. Piece `i` has the
    /// faces of component `i`, in the same order.
    ///
    /// A tear inside a piece can be sewn in that piece. A tear between two pieces cannot: its ghost
    /// links become boundary, so keep the whole mesh if you want to sew it. A vertex that two
    /// pieces share is copied to each of them. If the fans of a vertex in a piece were joined only
    /// through other pieces, each fan gets its own vertex. Vertices without faces are in no piece.
    ///
    /// O(n log n).
    ///
    /// ```
    /// use tearmesh::{shapes, CutMethod, Edits, PerVertex, Plane, Point, Positions, Scissor, Vector};
    ///
    /// let (mut mesh, mut positions) = shapes::grid(8, 8);
    /// let mut heat = PerVertex::new(vec![20.0; mesh.vertex_count()]);
    /// let plane = Plane::new(Point::new(0.3, 0.0, 0.0), Vector::new(1.0, 0.2, 0.0))?;
    /// let mut edits = Edits::new();
    /// Scissor::by_plane(plane).cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)?;
    /// edits.replay(&mut heat);
    ///
    /// let mut pieces = mesh.pieces(&mesh.components());
    /// pieces.sort_by_key(|piece| std::cmp::Reverse(piece.faces.len())); // the largest first
    /// let piece = &pieces[1];
    /// let vertices = piece.vertices.iter().copied();
    /// let own_positions = Positions::new(vertices.clone().map(|v| positions.at(v)))?;
    /// let own_heat = PerVertex::new(vertices.map(|v| *heat.at(v)).collect());
    /// assert_eq!(own_positions.len(), piece.mesh.vertex_count());
    /// assert_eq!(own_heat.as_slice().len(), piece.mesh.vertex_count());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If `components` belong to another mesh (I2).
    #[must_use]
    pub fn pieces(&self, components: &Components) -> Vec<DerivedMesh> {
        assert!(
            *components == self.components(),
            "I2: the components are those of this mesh"
        );
        let mut faces: Vec<Vec<FaceId>> = vec![Vec::new(); components.count()];
        let mut local = Vec::with_capacity(self.face_count());
        for f in self.faces() {
            let of_piece = &mut faces[components.of(f)];
            local.push(FaceId::from_u32(of_piece.len() as u32));
            of_piece.push(f);
        }
        let pieces = faces.into_iter().enumerate();
        let within = |f: FaceId, piece: usize| (components.of(f) == piece).then_some(*f.of(&local));
        pieces
            .map(|(piece, faces)| self.restricted(faces, |f| within(f, piece)))
            .collect()
    }

    /// What the mesh has on these faces, which are ascending. `local` is the number of a face among
    /// them.
    fn restricted(
        &self,
        faces: Vec<FaceId>,
        local: impl Fn(FaceId) -> Option<FaceId>,
    ) -> DerivedMesh {
        let corners: Vec<HalfEdgeId> = faces.iter().flat_map(|f| f.half_edges()).collect();
        let link = |h: &HalfEdgeId| {
            let link = *h.of(&self.link);
            let here = link
                .opposite()
                .and_then(|g| Some(local(g.face())?.half_edges()[g.corner()]));
            here.map_or(Link::BOUNDARY, |here| link.renumbered(here))
        };
        let mut mesh = Mesh {
            origin: vec![0; corners.len()],
            link: corners.iter().map(link).collect(),
            outgoing: Vec::new(),
            slides: 0,
        };
        // The smallest half-edge of the orbit of each.
        let mut orbit = vec![NO_HALF_EDGE; corners.len()];
        for h in mesh.half_edges() {
            if orbit[h.index()] == NO_HALF_EDGE {
                mesh.orbit(h).for_each(|g| orbit[g.index()] = h.to_u32());
            }
        }
        let label = |h: usize| (self.origin(corners[h]), orbit[h]);
        let mut labels: Vec<(VertexId, u32)> = (0..corners.len()).map(label).collect();
        labels.sort_unstable();
        labels.dedup();
        mesh.outgoing = vec![NO_HALF_EDGE; labels.len()];
        for h in (0..corners.len()).rev() {
            let v = labels
                .binary_search(&label(h))
                .expect("every corner has a label");
            mesh.origin[h] = v as u32;
            mesh.outgoing[v] = h as u32; // The last one written is the smallest.
        }
        let vertices = labels.into_iter().map(|(v, _)| v).collect();
        DerivedMesh {
            mesh,
            vertices,
            faces,
            corners,
        }
    }
}

/// A mesh that was derived from another one, its *source*. Each of its vertices, faces and corners
/// is mapped to the one in the source that it comes from. [`Mesh::pieces`] returns such meshes.
///
/// The derived mesh needs a new log. Its followers start at
/// [`Cursor::START`](crate::Cursor::START), with values that are copied from those of the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DerivedMesh {
    /// The derived mesh.
    pub mesh: Mesh,
    /// The vertex of the source that each vertex of the derived mesh comes from. The list is indexed by
    /// derived vertex and ascending; it may contain a vertex of the source more than once.
    pub vertices: Vec<VertexId>,
    /// The face of the source that each face of the derived mesh comes from. The list is indexed by
    /// derived face and ascending.
    pub faces: Vec<FaceId>,
    /// The corner of the source that each corner of the derived mesh comes from. The list is indexed by
    /// derived half-edge.
    pub corners: Vec<HalfEdgeId>,
}

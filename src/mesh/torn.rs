//! Builds a torn mesh from its triangles and the root of each vertex.
//!
//! A torn mesh is a manifold whose corners were relabelled (`invariants.md`), so its triangles
//! and the root of each vertex are all there is to know: the triangles with each vertex
//! replaced by its root build that manifold, and a link is torn where its ends differ.
//! This is how a torn mesh comes back from a file, and how a garment begins: its panels, not yet
//! sewn, are the torn mesh, and a vertex of a seam has the root of its counterpart.

use std::fmt;

use super::build::first_half_edges;
use super::{BuildError, Link, Mesh, NO_HALF_EDGE};
use crate::id::{HalfEdgeId, VertexId};

impl Mesh {
    /// Builds a torn mesh from its triangles and the root of each vertex. `roots[v]` is the
    /// smallest of the vertices that were split from the same one as `v`, as [`Mesh::root`] returns
    /// it. It is `v` itself if `v` was never split.
    ///
    /// If each vertex is its own root, the result is that of [`Mesh::build`].
    ///
    /// Panels of a garment become one mesh so: the vertices that a seam will join share a root, the
    /// seam is torn from the start, and [`mend::merge`](crate::mend::merge) sews it. Sewn whole, the
    /// panels must be a manifold. So a seam of three panels, or one whose ends would meet in a
    /// bow-tie, is refused, with the faces and the root vertices.
    ///
    /// # Errors
    ///
    /// [`TornError`] if the roots contradict each other, or if replacing each vertex by its root
    /// does not turn the triangles into an oriented 2-manifold.
    ///
    /// ```
    /// use tearmesh::Mesh;
    ///
    /// // Two triangles that shared the edge 1-2 until vertex 1 was split.
    /// let mesh = Mesh::build_torn(&[[0, 1, 2], [2, 4, 3]], &[0, 1, 2, 3, 1])?;
    /// let v = mesh.vertex(4);
    /// assert_eq!(mesh.root(v), mesh.vertex(1));
    /// assert_eq!(mesh.corners_of(mesh.vertex(2)).count(), 2);
    /// # Ok::<(), tearmesh::TornError>(())
    /// ```
    pub fn build_torn(triangles: &[[u32; 3]], roots: &[u32]) -> Result<Mesh, TornError> {
        let wrong = |&(v, &root): &(usize, &u32)| {
            root as usize > v || roots.get(root as usize).is_none_or(|&of| of != root)
        };
        let refusal = |(v, &root): (usize, &u32)| TornError::Root {
            vertex: VertexId::from_u32(v as u32),
            root,
        };
        if let Some(wrong) = roots.iter().enumerate().find(wrong) {
            return Err(refusal(wrong));
        }
        let whole: Vec<[u32; 3]> = triangles
            .iter()
            .map(|triangle| triangle.map(|v| roots.get(v as usize).copied().unwrap_or(v)))
            .collect();
        let mut mesh = Mesh::build(roots.len(), whole).map_err(TornError::Build)?;
        mesh.origin.copy_from_slice(triangles.as_flattened());
        mesh.outgoing = first_half_edges(roots.len(), &mesh.origin);
        for h in mesh.half_edges() {
            let Some(g) = mesh.pair(h) else { continue };
            if mesh.origin(h) != mesh.target(g) || mesh.target(h) != mesh.origin(g) {
                mesh.link[h.index()].0 |= Link::TORN;
                mesh.link[g.index()].0 |= Link::TORN;
            }
        }
        let lost = |&(v, &root): &(usize, &u32)| {
            let has_corner = |v: usize| mesh.outgoing[v] != NO_HALF_EDGE;
            v != root as usize && !(has_corner(v) && has_corner(root as usize))
        };
        let lost = roots.iter().enumerate().find(lost).map(refusal);
        lost.map_or(Ok(mesh), Err)
    }

    /// The half-edges on the boundary, ascending: those that have neither a pair nor a ghost pair.
    pub(crate) fn boundary(&self) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let links = (0..).map(HalfEdgeId::from_u32).zip(&self.link);
        let boundary = links.filter(|&(_, &link)| link == Link::BOUNDARY);
        boundary.map(|(h, _)| h)
    }

    /// Whether any edge is torn.
    pub(crate) fn is_torn(&self) -> bool {
        let is_torn = |&link: &Link| !link.is_pair() && link != Link::BOUNDARY;
        self.link.iter().any(is_torn)
    }

    /// Links boundary half-edges as ghost pairs: the two sides of a seam that is not sewn. The caller
    /// answers for the invariants. For `unsewn` alone.
    ///
    /// # Panics
    ///
    /// If a half-edge is not on the boundary.
    pub(crate) fn close_seams(&mut self, seams: &[[HalfEdgeId; 2]]) {
        for &[h, g] in seams {
            let links = [h, g].map(|h| self.pair_or_ghost(h));
            assert_eq!(links, [None, None], "I4: a seam is on the boundary");
            self.link(h, g, true);
        }
    }

    /// Removes the ghost pairs that are seams. For `unsewn` alone.
    pub(crate) fn open_seams(&mut self, is_seam: impl Fn(&Mesh, HalfEdgeId, HalfEdgeId) -> bool) {
        for h in self.half_edges() {
            if let Some(g) = self.ghost_pair(h)
                && is_seam(self, h, g)
            {
                self.unlink(h);
                self.unlink(g);
            }
        }
    }

    /// Returns the root of every vertex, indexed by vertex, in the form that [`Mesh::build_torn`]
    /// expects. Linear.
    #[must_use]
    pub fn roots(&self) -> Vec<u32> {
        self.all_roots().into_iter().map(VertexId::to_u32).collect()
    }
}

/// The reason why triangles and roots were refused.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TornError {
    /// A root is not the smallest of the vertices that have this root, or a vertex without faces
    /// shares its root with another vertex.
    Root {
        /// The vertex with the wrong root.
        vertex: VertexId,
        /// The root that was given for the vertex.
        root: u32,
    },
    /// The triangles do not form an oriented 2-manifold after each vertex is replaced by its root.
    Build(BuildError),
}

impl fmt::Display for TornError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TornError::Root { vertex, root } => {
                write!(f, "vertex {root} cannot be the root of {vertex}")
            }
            TornError::Build(error) => write!(f, "the mesh before it was torn is {error}"),
        }
    }
}

impl std::error::Error for TornError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            TornError::Root { .. } => None,
            TornError::Build(error) => Some(error),
        }
    }
}

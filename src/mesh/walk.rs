//! Walks around a vertex and along the boundary.
//!
//! **Round a vertex**, in two forms. Let ρ(h) = opposite(prev h) turn a corner to the
//! next one round the same vertex, through a pair or a ghost pair.
//!
//! * [`Mesh::fan`] goes through pairs only, and so lists the corners that are joined to
//!   one corner by shared edges.
//! * [`Mesh::corners_of`] goes through pairs and ghost pairs, both ways where the orbit is
//!   open, crosses faces that no longer have the vertex *without stopping*, and reports
//!   those that do. Every simpler reading of the paper misses faces (Souza et al. 2014 §IV-B
//!   leaves the reading open; `invariants.md`, I10, has the counter-examples).
//!
//! No walk allocates unless its documentation says so. A step costs a nanosecond or two in cache; a
//! walk round a vertex visits as many faces as the vertex had when the mesh was built.

use std::iter::{self, FusedIterator};

use super::Mesh;
use crate::id::{FaceId, HalfEdgeId, VertexId};

impl Mesh {
    /// Returns all corners of a vertex, as the half-edges that start there: one for each face that
    /// has the vertex, however torn the mesh is.
    ///
    /// The walk starts at [`Mesh::half_edge_of`] and turns counter-clockwise, seen from the side
    /// from which faces are counter-clockwise. Where it reaches the original boundary, it continues
    /// clockwise from the start.
    ///
    /// ```
    /// use tearmesh::Mesh;
    ///
    /// let mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]])?;
    /// let v = mesh.vertex(1);
    /// assert_eq!(mesh.corners_of(v).count(), 2);
    /// # Ok::<(), tearmesh::BuildError>(())
    /// ```
    #[inline]
    #[must_use]
    pub fn corners_of(&self, v: VertexId) -> Corners<'_> {
        let fan = self.half_edge_of(v);
        let mut orbit = Orbit::new(self, fan);
        orbit.at = None;
        Corners {
            vertex: v,
            fan,
            orbit,
        }
    }

    /// Returns the faces of a vertex, in the order of [`Mesh::corners_of`].
    pub fn faces_of(&self, v: VertexId) -> impl FusedIterator<Item = FaceId> + '_ {
        self.corners_of(v).map(HalfEdgeId::face)
    }

    /// Returns the fan of the corner `h`: the corners that are joined to `h` through pairs around
    /// its vertex. The first one is `h` itself.
    #[inline]
    #[must_use]
    pub fn fan(&self, h: HalfEdgeId) -> impl FusedIterator<Item = HalfEdgeId> + Clone + use<'_> {
        h.of(&self.link); // The first step asks for the one before, and would name that.
        Orbit::<'_, false>::new(self, Some(h))
    }

    /// Returns one corner of each fan of a vertex. It is the clockwise end of an open fan, and the
    /// smallest half-edge of a closed one.
    ///
    /// A vertex inside an untorn surface, or on its boundary, has one fan. A vertex with two or
    /// more fans is a bow-tie (Souza et al. 2014, Fig. 2).
    #[must_use]
    pub fn fans(&self, v: VertexId) -> impl FusedIterator<Item = HalfEdgeId> + '_ {
        // The first corner of an open fan has no pair behind it; a fan without such
        // a corner is closed, and then is the whole orbit.
        let first_corners = move || self.corners_of(v).filter(|&h| self.pair(h).is_none());
        let closed = self
            .half_edge_of(v)
            .filter(|_| first_corners().next().is_none());
        first_corners().chain(closed)
    }

    /// Returns the vertex that `v` was before any split: the smallest of the vertices that were
    /// split from the same one.
    #[must_use]
    pub fn root(&self, v: VertexId) -> VertexId {
        self.copies(v).min().unwrap_or(v)
    }

    /// [`Mesh::root`] of every vertex. Linear, however many copies a vertex has.
    pub(crate) fn all_roots(&self) -> Vec<VertexId> {
        let mut roots: Vec<VertexId> = self.vertices().collect();
        for v in self.vertices() {
            // The smallest comes first, and speaks for all copies.
            if let (true, Some(h)) = (roots[v.index()] == v, self.half_edge_of(v)) {
                self.orbit(h)
                    .for_each(|h| roots[self.origin(h).index()] = v);
            }
        }
        roots
    }

    /// The vertices that were split from the same one as `v`, and `v` itself, each as often as it
    /// has faces.
    pub(crate) fn copies(&self, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        let orbit: Orbit<'_> = Orbit::new(self, self.half_edge_of(v));
        orbit.map(|h| self.origin(h))
    }

    /// The corners of all vertices that were split from the vertex of `h`, and its own.
    pub(crate) fn orbit(&self, h: HalfEdgeId) -> Orbit<'_> {
        Orbit::new(self, Some(h))
    }

    /// The corner after `h` round its vertex: ρ(h) = opposite(prev h).
    #[inline]
    pub(crate) fn ahead(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.pair_or_ghost(h.prev())
    }

    /// The corner before `h` round its vertex: next(opposite h).
    #[inline]
    pub(crate) fn behind(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.pair_or_ghost(h).map(HalfEdgeId::next)
    }

    /// Returns the half-edges of the boundary loop that contains `h`, end to end, starting with
    /// `h`. The sides of a tear count as boundary. The result is empty if `h` has a pair.
    ///
    /// ```
    /// use tearmesh::Mesh;
    ///
    /// let mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]])?;
    /// let [start] = mesh.boundary_loops()[..] else { panic!("one loop") };
    /// assert_eq!(mesh.boundary_loop(start).count(), 4);
    /// # Ok::<(), tearmesh::BuildError>(())
    /// ```
    #[must_use]
    pub fn boundary_loop(
        &self,
        h: HalfEdgeId,
    ) -> impl FusedIterator<Item = HalfEdgeId> + Clone + use<'_> {
        let first = Some(h).filter(|&h| self.pair(h).is_none());
        iter::successors(first, move |on| {
            // The boundary leaves the fan at the end of `on` on its other side.
            let mut following = on.next();
            while let Some(pair) = self.pair(following) {
                following = pair.next();
            }
            (following != h).then_some(following)
        })
    }

    /// Returns the smallest half-edge of each boundary loop, in ascending order.
    ///
    /// Allocates one mark per half-edge; linear.
    #[must_use]
    pub fn boundary_loops(&self) -> Vec<HalfEdgeId> {
        let mut seen = vec![false; self.half_edge_count()];
        let mut loops = Vec::new();
        for h in self.half_edges() {
            if self.pair(h).is_none() && !seen[h.index()] {
                loops.push(h);
                for on in self.boundary_loop(h) {
                    seen[on.index()] = true;
                }
            }
        }
        loops
    }

    /// Returns the faces that share an untorn edge with a face: at most three.
    pub fn neighbours(&self, f: FaceId) -> impl FusedIterator<Item = FaceId> + '_ {
        self.half_edges_of(f)
            .into_iter()
            .filter_map(|h| self.pair(h))
            .map(HalfEdgeId::face)
    }
}

/// An iterator over the corners of a vertex: see [`Mesh::corners_of`].
#[derive(Clone, Debug)]
pub struct Corners<'m> {
    vertex: VertexId,
    /// The next corner, as long as pairs alone have led ahead from the first one: those corners are corners
    /// of the vertex.
    fan: Option<HalfEdgeId>,
    /// The walk beyond the first link that is torn or on the boundary; before that, a walk that is over.
    orbit: Orbit<'m>,
}

impl Iterator for Corners<'_> {
    type Item = HalfEdgeId;

    #[inline]
    fn next(&mut self) -> Option<HalfEdgeId> {
        if let Some(h) = self.fan {
            let link = *h.prev().of(&self.orbit.mesh.link);
            if link.is_pair() {
                let ahead = HalfEdgeId::from_u32(link.0);
                self.fan = (ahead != self.orbit.first).then_some(ahead);
                return Some(h);
            }
            self.fan = None;
            self.orbit.at = Some(h);
        }
        loop {
            let h = self.orbit.next()?;
            let is_here = self.orbit.mesh.origin(h) == self.vertex;
            if is_here {
                return Some(h);
            }
        }
    }
}

impl FusedIterator for Corners<'_> {}

/// The corners of one orbit of ρ, in order: ahead from the first one, and where
/// the orbit is open, then behind it. Without ghosts, ρ goes through pairs only.
#[derive(Clone, Debug)]
pub(crate) struct Orbit<'m, const GHOSTS: bool = true> {
    mesh: &'m Mesh,
    /// Any where there is none.
    first: HalfEdgeId,
    at: Option<HalfEdgeId>,
    backward: bool,
}

impl<'m, const GHOSTS: bool> Orbit<'m, GHOSTS> {
    fn new(mesh: &'m Mesh, first: Option<HalfEdgeId>) -> Self {
        Orbit {
            mesh,
            first: first.unwrap_or(HalfEdgeId::from_u32(0)),
            at: first,
            backward: false,
        }
    }

    #[inline]
    fn across(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        let link = h.of(&self.mesh.link);
        if GHOSTS || link.is_pair() {
            link.opposite()
        } else {
            None
        }
    }
}

impl<const GHOSTS: bool> Iterator for Orbit<'_, GHOSTS> {
    type Item = HalfEdgeId;

    #[inline]
    fn next(&mut self) -> Option<HalfEdgeId> {
        let h = self.at?;
        self.at = if self.backward {
            self.across(h).map(HalfEdgeId::next)
        } else {
            match self.across(h.prev()) {
                Some(ahead) if ahead == self.first => None,
                Some(ahead) => Some(ahead),
                None => {
                    self.backward = true;
                    self.across(self.first).map(HalfEdgeId::next)
                }
            }
        };
        Some(h)
    }
}

impl<const GHOSTS: bool> FusedIterator for Orbit<'_, GHOSTS> {}

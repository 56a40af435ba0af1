//! Seams whose two sides coincide and are not sewn.
//!
//! Exporters write one vertex for each combination of position, texture coordinate and normal, so along
//! a texture seam or a hard edge each side has vertices of its own. A mesh of such vertices falls into
//! loose parts, and a cut that decides on each side alone leaves cracks. A seam whose sides coincide is a
//! tear that has not opened: [`UnsewnSeams::close`] links the two sides as *ghost pairs*, so that a cut
//! crosses the seam as it crosses an older cut, and [`ClosedSeams::reopen`] removes these links again.
//! Nothing that was apart is joined. [`UnsewnSeams::welded`] does join the sides, for simulations. The two
//! sides of double-sided cloth are no seam: each is cut by itself, and where their triangles differ, a snap
//! may take the cut to different places.
//!
//! ```text
//!       c                   Two boundary half-edges are *partners* if they run between equal places in
//!      / \                  opposite directions, and their faces do not have the same three places (the
//!     /   \                 back of double-sided cloth is no partner). A *seam edge* is two half-edges
//!    a --> b                each of which is the only partner of the other.
//!    a'<-- b'
//!     \   /                 Vertices are joined by seam edges alone: a and a', b and b'. Parts that touch
//!      \ /                  at a point stay apart.
//!       d
//! ```
//!
//! Where the closed mesh would not be an oriented 2-manifold, because an edge would have a third face
//! (I11), the whole connected seam there is left apart, and counted. So are edges at which more than two
//! sides meet.
//!
//! The cost is linear in the mesh, plus the time to sort the seams. A mesh without a boundary is
//! only looked through.

mod classes;
mod closed;
mod groups;
mod sides;
mod spots;

use std::collections::BTreeSet;
use std::fmt;

use crate::attribute::Blend as _;
use crate::edit::Cursor;
use crate::geometry::{Point, max_abs};
use crate::id::{HalfEdgeId, VertexId};
use crate::mend::Stitch;
use crate::mesh::{BuildError, Mesh};
use crate::place::{Place, PositionError, Positions};
use crate::sets::DisjointSets;
use classes::Classes;
pub use closed::ClosedSeams;
use sides::{Sides, joined};
use spots::Spots;

/// The seams of a mesh whose two sides coincide and are not sewn: see the [module](self).
///
/// ```
/// use tearmesh::{Mesh, Positions, unsewn::UnsewnSeams};
///
/// // A square of two triangles with a texture seam along the diagonal.
/// let places = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
/// let mut mesh = Mesh::build(6, &[[0, 1, 2], [3, 4, 5]])?;
/// let positions = Positions::new(places)?;
/// let seams = UnsewnSeams::find(&mesh, &positions);
/// assert_eq!((seams.edges().len(), seams.boundary_edges()), (1, 6));
///
/// let closed = seams.close(&mut mesh); // cut it now, and replay the log on `closed`
/// assert_eq!(mesh.root(mesh.vertex(3)), mesh.vertex(0));
/// closed.reopen(&mut mesh);
/// assert_eq!(mesh.root(mesh.vertex(3)), mesh.vertex(3));
///
/// let welded = seams.welded(&mesh, &positions);
/// assert_eq!((welded.mesh.vertex_count(), welded.vertices[3].index()), (4, 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UnsewnSeams {
    edges: Vec<[HalfEdgeId; 2]>,
    boundary_edges: usize,
    left: LeftApart,
    near_misses: usize,
}

/// How many boundary edges coincide with others and are left apart all the same, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LeftApart {
    /// More than two sides meet at the edge, so that it is unclear which of them belong together.
    pub crowded: usize,
    /// All sides run in the same direction, as where a strip is closed with a twist.
    pub same_direction: usize,
    /// Sewn, the connected seam would not be part of an oriented 2-manifold.
    pub not_manifold: usize,
}

impl LeftApart {
    /// Returns the number of all edges that are left apart.
    #[must_use]
    pub fn count(&self) -> usize {
        self.crowded + self.same_direction + self.not_manifold
    }
}

/// A part of the size of the boundary. Sides that are apart by less are counted as near misses.
const NEAR: f64 = 1e-6;

impl UnsewnSeams {
    /// Finds the seams of a mesh whose sides are at equal places. Coordinates are compared as numbers, so
    /// −0 equals 0.
    ///
    /// # Panics
    ///
    /// If `place` does not store the position of a vertex of the mesh.
    #[must_use]
    pub fn find(mesh: &Mesh, place: &(impl Place + ?Sized)) -> UnsewnSeams {
        UnsewnSeams::within(mesh, place, 0.0)
    }

    /// Finds the seams of a mesh whose sides are at most `distance` apart. Vertices that are connected by
    /// steps of at most this distance are one place. If any two of them are farther apart than that, they
    /// are not: such places are left as they are.
    ///
    /// # Panics
    ///
    /// If `place` does not store the position of a vertex of the mesh, or `distance` is negative or NaN.
    #[must_use]
    pub fn within(mesh: &Mesh, place: &(impl Place + ?Sized), distance: f64) -> UnsewnSeams {
        assert!(distance >= 0.0, "a distance is not {distance}");
        let boundary: Vec<HalfEdgeId> = mesh.boundary().collect();
        let mut seams = UnsewnSeams {
            boundary_edges: boundary.len(),
            ..UnsewnSeams::default()
        };
        if boundary.is_empty() {
            return seams;
        }
        let spots = Spots::new(mesh, place, &boundary, distance);
        let sides = Sides::of(mesh, &spots, &boundary);
        seams.edges = sides.edges;
        let mut enclosed = BTreeSet::new();
        if let Some(classes) = seams.leave_apart(mesh) {
            let left = [&sides.crowded, &sides.same_direction, &sides.alone];
            enclosed = seams.add_enclosed(mesh, classes, left.into_iter().flatten());
        }
        let left = |half_edges: &[HalfEdgeId]| {
            let left = half_edges.iter().filter(|h| !enclosed.contains(h));
            left.count()
        };
        seams.left.crowded = left(&sides.crowded);
        seams.left.same_direction = left(&sides.same_direction);
        if distance == 0.0 {
            let reach = NEAR * size(mesh, place, &boundary);
            let near = Spots::new(mesh, place, &sides.alone, reach);
            seams.near_misses = Sides::of(mesh, &near, &sides.alone).edges.len();
        }
        seams
    }

    /// Returns the seam edges, each as its two half-edges, the smaller one first, in ascending order.
    #[must_use]
    pub fn edges(&self) -> &[[HalfEdgeId; 2]] {
        &self.edges
    }

    /// Returns whether there is no seam edge.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// Returns the number of edges of the mesh that have one face and are not torn.
    #[must_use]
    pub fn boundary_edges(&self) -> usize {
        self.boundary_edges
    }

    /// Returns how many boundary edges coincide with others and are left apart.
    #[must_use]
    pub fn left_apart(&self) -> LeftApart {
        self.left
    }

    /// Returns the number of pairs of boundary edges that nearly coincide: by a millionth of the size of
    /// the boundary. Always 0 for seams found by [`UnsewnSeams::within`] with a distance above 0.
    #[must_use]
    pub fn near_misses(&self) -> usize {
        self.near_misses
    }

    /// Links the two sides of every seam as ghost pairs. Vertices and faces stay as they are.
    ///
    /// # Panics
    ///
    /// If the mesh was edited since the seams were found.
    #[must_use = "the seams have to be reopened"]
    pub fn close(&self, mesh: &mut Mesh) -> ClosedSeams {
        let classes = match self.is_empty() {
            true => Vec::new(),
            false if mesh.is_torn() => mesh.roots(),
            false => (0..mesh.vertex_count() as u32).collect(),
        };
        mesh.close_seams(&self.edges);
        ClosedSeams {
            next: mesh.vertex_count() as u32,
            classes,
            seen: Cursor::START,
        }
    }

    /// Returns the stitches that sew the seams of a mesh in which they are closed.
    ///
    /// [`mend::sew`](crate::mend::sew) sews them. Linear in the mesh.
    #[must_use]
    pub fn stitches(&self, mesh: &Mesh) -> Vec<Stitch> {
        let kept = self.lowest(mesh);
        let sewn = kept.into_iter().zip(0..);
        sewn.filter_map(|(kept, v)| Stitch::new(VertexId::from_u32(kept), VertexId::from_u32(v)))
            .collect()
    }

    /// Returns for each vertex the lowest one that seams join with it. Linear.
    #[must_use]
    pub fn lowest(&self, mesh: &Mesh) -> Vec<u32> {
        let mut sets = DisjointSets::new(mesh.vertex_count() as u32);
        for [a, b] in self.edges.iter().flat_map(|&edge| joined(mesh, edge)) {
            sets.join(a.to_u32(), b.to_u32());
        }
        sets.representatives().to_vec()
    }

    /// Returns for each vertex the one that it becomes in the [welded](UnsewnSeams::welded) mesh. Linear.
    ///
    /// # Panics
    ///
    /// If the mesh was edited since the seams were found.
    #[must_use]
    pub fn welded_vertices(&self, mesh: &Mesh) -> Vec<VertexId> {
        let mut vertices: Vec<VertexId> = Vec::with_capacity(mesh.vertex_count());
        let mut count = 0;
        for (kept, v) in self.lowest(mesh).into_iter().zip(0..) {
            let is_first = kept == v;
            vertices.push(match is_first {
                true => VertexId::from_u32(count),
                false => vertices[kept as usize],
            });
            count += u32::from(is_first);
        }
        vertices
    }

    /// Returns the mesh with all seams sewn. Faces keep their ids. Vertices are numbered in the order in
    /// which their places first appear. A vertex that was several is at their mean.
    ///
    /// # Panics
    ///
    /// If the mesh was edited since the seams were found, or the positions are not those of the mesh.
    #[must_use]
    pub fn welded(&self, mesh: &Mesh, positions: &Positions) -> Welded {
        let vertices = self.welded_vertices(mesh);
        let count = vertices.iter().max().map_or(0, |last| last.index() + 1);
        let mut sums = vec![(Point::origin(), 0.0); count];
        let mut roots: Vec<u32> = (0..count as u32).collect();
        for ((v, &welded), root) in mesh.vertices().zip(&vertices).zip(mesh.roots()) {
            let (sum, times) = &mut sums[welded.index()];
            // The mean of equal points is that point to the bit.
            *times += 1.0;
            let weights = [1.0 - 1.0 / *times, 1.0 / *times];
            let at = positions.at(v);
            *sum = match *times {
                1.0 => at,
                _ if *sum == at => *sum,
                _ => Point::weighted([sum, &at, &at], [weights[0], weights[1], 0.0]),
            };
            let root = vertices[root as usize].to_u32();
            let known = &mut roots[welded.index()];
            *known = root.min(*known);
        }
        let triangles = mesh.indices().as_chunks::<3>().0.iter();
        let triangles: Vec<[u32; 3]> = triangles
            .map(|face| face.map(|v| vertices[v as usize].to_u32()))
            .collect();
        let roots = settled(roots);
        let mesh = Mesh::build_torn(&triangles, &roots);
        let positions = Positions::new(sums.into_iter().map(|(point, _)| point));
        Welded {
            mesh: mesh.expect("I11: seams that would not be manifold are left apart"),
            positions: positions.expect("means of usable points are usable"),
            vertices,
        }
    }

    /// Adds the edges that the seams leave with two sides between the same vertices: more than two sides meet
    /// at that place, but now it is clear which two belong together. Returns their half-edges.
    fn add_enclosed<'h>(
        &mut self,
        mesh: &Mesh,
        mut classes: Classes,
        left: impl Iterator<Item = &'h HalfEdgeId>,
    ) -> BTreeSet<HalfEdgeId> {
        let mut enclosed: Vec<([u32; 2], HalfEdgeId)> = Vec::new();
        for &h in left {
            let [a, b] = [mesh.origin(h), mesh.target(h)].map(|v| classes.root(v));
            if classes.is_joined(a) || classes.is_joined(b) {
                enclosed.push(([a.min(b), a.max(b)], h));
            }
        }
        enclosed.sort_unstable();
        let mut added = BTreeSet::new();
        for group in enclosed.chunk_by(|a, b| a.0 == b.0) {
            if let &[(_, h), (_, g)] = group {
                self.edges.push([h, g]);
                added.extend([h, g]);
            }
        }
        self.edges.sort_unstable();
        added
    }

    /// Leaves connected seams apart that would not be manifold. Returns the classes of vertices that the
    /// others make, if there are any.
    fn leave_apart(&mut self, mesh: &Mesh) -> Option<Classes> {
        while !self.edges.is_empty() {
            let mut classes = Classes::of(mesh, &self.edges);
            let bad = classes.defects(mesh);
            if bad.is_empty() {
                return Some(classes);
            }
            let mut connected = classes.connected(mesh, &self.edges);
            let mut is_bad = vec![false; mesh.vertex_count()];
            for class in bad {
                is_bad[connected.representative(class) as usize] = true;
            }
            let before = self.edges.len();
            self.edges.retain(|&[h, _]| {
                let seam = connected.representative(mesh.origin(h).to_u32());
                !is_bad[seam as usize]
            });
            let apart = before - self.edges.len();
            assert!(apart > 0, "I11: a defect is at a seam");
            self.left.not_manifold += 2 * apart;
        }
        None
    }
}

/// The longest side of the box round some half-edges.
fn size(mesh: &Mesh, place: &(impl Place + ?Sized), half_edges: &[HalfEdgeId]) -> f64 {
    let mut points = half_edges.iter().map(|&h| place.at(mesh.origin(h)));
    let Some(first) = points.next() else {
        return 0.0;
    };
    let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
    max_abs(high - low)
}

/// Roots that are roots of themselves, of numbers that name smaller ones.
fn settled(mut roots: Vec<u32>) -> Vec<u32> {
    for v in 0..roots.len() {
        roots[v] = roots[roots[v] as usize];
    }
    roots
}

/// Builds a mesh from an engine's vertex and index buffers, in which vertices are repeated along texture
/// seams and hard edges.
///
/// Faces and corners keep their order, so values that differ along a seam belong to corners, and
/// [`DrawBuffers`](crate::engine::DrawBuffers) turns them back into a vertex buffer. Vertices are one where
/// their faces share an edge by place; vertices that no triangle uses are left out. Edges at which more
/// than two triangles meet stay apart.
///
/// ```
/// use tearmesh::{engine::DrawBuffers, unsewn};
///
/// // A square of two triangles, with a texture seam along the diagonal.
/// let places = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
/// let uv = [[0.0_f32, 0.0], [0.5, 0.0], [0.5, 1.0], [0.5, 0.0], [1.0, 1.0], [0.5, 1.0]];
/// let triangles = [[0, 1, 2], [3, 4, 5]];
///
/// let (mesh, _positions) = unsewn::weld(&places, &triangles)?;
/// assert_eq!(mesh.vertex_count(), 4);
/// let uv = triangles.as_flattened().iter().map(|&i| uv[i as usize]);
/// let buffers = DrawBuffers::new(&mesh, uv.collect());
/// assert_eq!(buffers.len(), 6);
/// # Ok::<(), tearmesh::unsewn::WeldError>(())
/// ```
///
/// # Errors
///
/// [`WeldError`] if a triangle names a vertex that does not exist, or one whose place is not usable.
pub fn weld(places: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<(Mesh, Positions), WeldError> {
    let known = places.len();
    let indices = triangles.as_flattened();
    if let Some(&index) = indices.iter().find(|&&index| index as usize >= known) {
        return Err(WeldError::Index { index, known });
    }
    let point = |place: [f32; 3]| place.map(f64::from);
    // The error names the vertices of the buffer.
    Positions::new(places.iter().copied().map(point)).map_err(WeldError::Place)?;
    // Each triangle has vertices of its own, so that nothing but edges joins them.
    let corners = indices.iter().map(|&index| point(places[index as usize]));
    let positions = Positions::new(corners).map_err(WeldError::Place)?;
    let faces: Vec<[u32; 3]> = (0..triangles.len() as u32)
        .map(|f| [3 * f, 3 * f + 1, 3 * f + 2])
        .collect();
    let mesh = Mesh::build(positions.len(), faces).map_err(WeldError::Build)?;
    let welded = UnsewnSeams::find(&mesh, &positions).welded(&mesh, &positions);
    Ok((welded.mesh, welded.positions))
}

/// The reason why buffers were refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum WeldError {
    /// A triangle refers to a vertex that the buffer does not have.
    Index {
        /// The vertex index in the triangle.
        index: u32,
        /// The number of vertices in the buffer.
        known: usize,
    },
    /// Some vertices of the buffer have coordinates that are not finite. The error lists them.
    Place(PositionError),
    /// There are more triangles than a mesh can have.
    Build(BuildError),
}

impl fmt::Display for WeldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            WeldError::Index { index, known } => {
                write!(
                    f,
                    "a triangle names vertex {index}, but there are {known} vertices"
                )
            }
            WeldError::Place(error) => error.fmt(f),
            WeldError::Build(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for WeldError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            WeldError::Index { .. } => None,
            WeldError::Place(error) => Some(error),
            WeldError::Build(error) => Some(error),
        }
    }
}

/// The result of [`UnsewnSeams::welded`].
#[derive(Clone, Debug)]
pub struct Welded {
    /// The mesh. It has the faces of the given mesh, in the same order.
    pub mesh: Mesh,
    /// The positions of its vertices.
    pub positions: Positions,
    /// The vertex that each vertex of the given mesh became, indexed by the latter.
    pub vertices: Vec<VertexId>,
}

//! Seams whose two sides coincide and are not sewn.
//!
//! Exporters write one vertex for each combination of position, texture coordinate and normal, so along
//! a texture seam or a hard edge each side has vertices of its own. A mesh of such vertices falls into
//! loose parts, and a cut that decides on each side alone leaves cracks. A seam whose sides coincide is a
//! tear that has not opened: [`UnsewnSeams::close`] links the two sides as *ghost pairs*, so that a cut
//! crosses the seam as it crosses an older cut, and [`ClosedSeams::reopen`] removes these links again.
//! Nothing that was apart is joined. [`UnsewnSeams::welded`] does join the sides, for simulations.
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
//! Where the closed mesh would not be an oriented 2-manifold, because a face would have one vertex
//! twice (I3), an edge a third face (I11), or three vertices a second face (I13), the whole connected
//! seam there is left apart, and counted. So are edges at which more than two sides meet.
//!
//! The cost is linear in the mesh, plus the time to sort the boundary. A mesh without a boundary is
//! only looked through.

mod spots;

use std::fmt;

use crate::attribute::Blend as _;
use crate::edit::{Cursor, Edit, Follower, InsertedPoint, Mix};
use crate::geometry::{Point, max_abs};
use crate::id::{HalfEdgeId, VertexId};
use crate::mend::Stitch;
use crate::mesh::{BuildError, Mesh};
use crate::place::{Place, PositionError, Positions};
use crate::sets::DisjointSets;
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

/// The largest number of boundary edges at one place that are compared one by one. Where more meet, all
/// are left apart.
const CROWD: usize = 16;

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
        let reach = NEAR * size(mesh, place, &boundary);
        let sides = Sides::of(
            mesh,
            &Spots::new(mesh, place, &boundary, distance),
            boundary,
        );
        seams.edges = sides.edges;
        if let Some(classes) = seams.leave_apart(mesh) {
            let left = [&sides.crowded, &sides.same_direction, &sides.alone];
            seams.add_enclosed(mesh, classes, left.into_iter().flatten());
        }
        let mut sewn = seams.edges.as_flattened().to_vec();
        sewn.sort_unstable();
        let left = |half_edges: &[HalfEdgeId]| {
            let left = half_edges.iter().filter(|h| sewn.binary_search(h).is_err());
            left.count()
        };
        seams.left.crowded = left(&sides.crowded);
        seams.left.same_direction = left(&sides.same_direction);
        if distance == 0.0 {
            let near = Spots::new(mesh, place, &sides.alone, reach);
            seams.near_misses = Sides::of(mesh, &near, sides.alone).edges.len();
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
        sets.leaders().to_vec()
    }

    /// Returns the mesh with all seams sewn. Faces keep their ids. Vertices are numbered in the order in
    /// which their places first appear. A vertex that was several is at their mean.
    ///
    /// # Panics
    ///
    /// If the mesh was edited since the seams were found, or the positions are not those of the mesh.
    #[must_use]
    pub fn welded(&self, mesh: &Mesh, positions: &Positions) -> Welded {
        let kept = self.lowest(mesh);
        let mut vertices: Vec<VertexId> = Vec::with_capacity(kept.len());
        let mut count = 0;
        for (&kept, v) in kept.iter().zip(0..) {
            let is_first = kept == v;
            vertices.push(match is_first {
                true => VertexId::from_u32(count),
                false => vertices[kept as usize],
            });
            count += u32::from(is_first);
        }
        let mut sums = vec![(Point::origin(), 0.0); count as usize];
        let mut roots: Vec<u32> = (0..count).collect();
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
    /// at that place, but now it is clear which two belong together.
    fn add_enclosed<'h>(
        &mut self,
        mesh: &Mesh,
        mut classes: Classes,
        left: impl Iterator<Item = &'h HalfEdgeId>,
    ) {
        let roots = classes.of.leaders();
        let root = |v: VertexId| roots[v.index()];
        let mut enclosed: Vec<([u32; 2], HalfEdgeId)> = Vec::new();
        for &h in left {
            let [a, b] = [mesh.origin(h), mesh.target(h)].map(root);
            if [a, b].iter().any(|&root| classes.is_joined[root as usize]) {
                enclosed.push(([a.min(b), a.max(b)], h));
            }
        }
        enclosed.sort_unstable();
        for group in enclosed.chunk_by(|a, b| a.0 == b.0) {
            if let &[(_, h), (_, g)] = group {
                self.edges.push([h, g]);
            }
        }
        self.edges.sort_unstable();
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
            let mut is_bad = vec![false; mesh.vertex_count()];
            for class in bad {
                is_bad[classes.connected.leader(class) as usize] = true;
            }
            let before = self.edges.len();
            self.edges.retain(|&[h, _]| {
                let seam = classes.connected.leader(mesh.origin(h).to_u32());
                !is_bad[seam as usize]
            });
            let apart = before - self.edges.len();
            assert!(apart > 0, "I11: a defect is at a seam");
            self.left.not_manifold += 2 * apart;
        }
        None
    }
}

/// Boundary half-edges, sorted by what coincides with them.
#[derive(Default)]
struct Sides {
    /// Each other's only partners, the smaller half-edge first; ascending.
    edges: Vec<[HalfEdgeId; 2]>,
    crowded: Vec<HalfEdgeId>,
    same_direction: Vec<HalfEdgeId>,
    alone: Vec<HalfEdgeId>,
}

impl Sides {
    fn of<P: Place + ?Sized>(
        mesh: &Mesh,
        spots: &Spots<'_, P>,
        mut half_edges: Vec<HalfEdgeId>,
    ) -> Sides {
        let mut sides = Sides::default();
        let ends = |h: HalfEdgeId| [mesh.origin(h), mesh.target(h)].map(|v| spots.of_vertex(v));
        let lies_at = |h: HalfEdgeId| {
            let [from, to] = ends(h);
            [from.min(to), from.max(to)]
        };
        let is_ahead = |h: HalfEdgeId| ends(h)[0] < ends(h)[1];
        half_edges.sort_unstable_by_key(|&h| (lies_at(h), is_ahead(h), h));
        for at_one_place in half_edges.chunk_by(|&a, &b| lies_at(a) == lies_at(b)) {
            let [from, to] = ends(at_one_place[0]);
            if from == to || at_one_place.len() == 1 {
                sides.alone.extend(at_one_place);
            } else if at_one_place.len() > CROWD {
                sides.crowded.extend(at_one_place);
            } else {
                let back = at_one_place.partition_point(|&h| !is_ahead(h));
                let (back, ahead) = at_one_place.split_at(back);
                sides.compare(mesh, spots, back, ahead);
                sides.compare(mesh, spots, ahead, back);
            }
        }
        sides.edges.sort_unstable();
        sides
    }

    /// Sorts half-edges that run one way between two places by those that run the other way.
    fn compare<P: Place + ?Sized>(
        &mut self,
        mesh: &Mesh,
        spots: &Spots<'_, P>,
        one_way: &[HalfEdgeId],
        other_way: &[HalfEdgeId],
    ) {
        // A face with two corners at one place has no side to be sewn.
        let is_thin = |h: HalfEdgeId| {
            let ends = [mesh.origin(h), mesh.target(h)].map(|v| spots.of_vertex(v));
            ends.contains(&spots.of_opposite(mesh, h))
        };
        let partners = |h: HalfEdgeId, among: &[HalfEdgeId]| {
            let is_partner = |&g: &HalfEdgeId| {
                !is_thin(h) && !is_thin(g) && !spots.have_same_opposite(mesh, h, g)
            };
            among
                .iter()
                .copied()
                .filter(is_partner)
                .collect::<Vec<HalfEdgeId>>()
        };
        for &h in one_way {
            match partners(h, other_way)[..] {
                [g] if partners(g, one_way)[..] == [h] => {
                    if h < g {
                        self.edges.push([h, g]);
                    }
                }
                [] if partners(h, one_way).is_empty() => self.alone.push(h),
                [] => self.same_direction.push(h),
                _ => self.crowded.push(h),
            }
        }
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

/// The vertices that a seam edge joins.
fn joined(mesh: &Mesh, [h, g]: [HalfEdgeId; 2]) -> [[VertexId; 2]; 2] {
    [
        [mesh.origin(h), mesh.target(g)],
        [mesh.target(h), mesh.origin(g)],
    ]
}

/// Roots that are roots of themselves, of numbers that name smaller ones.
fn settled(mut roots: Vec<u32>) -> Vec<u32> {
    for v in 0..roots.len() {
        roots[v] = roots[roots[v] as usize];
    }
    roots
}

/// The vertices of a mesh as they would be one with all seams closed.
struct Classes {
    of: DisjointSets,
    /// By the smallest vertex of a class, whether a seam joins it.
    is_joined: Vec<bool>,
    /// Classes that seams connect, by their smallest vertices.
    connected: DisjointSets,
}

impl Classes {
    fn of(mesh: &Mesh, edges: &[[HalfEdgeId; 2]]) -> Classes {
        let count = mesh.vertex_count() as u32;
        let mut of = DisjointSets::new(count);
        if mesh.is_torn() {
            for (root, v) in mesh.roots().into_iter().zip(0..) {
                of.join(root, v);
            }
        }
        let pairs = edges.iter().flat_map(|&edge| joined(mesh, edge));
        pairs.for_each(|[a, b]| of.join(a.to_u32(), b.to_u32()));
        let mut connected = of.clone();
        let mut is_joined = vec![false; count as usize];
        for &[h, _] in edges {
            let ends = [mesh.origin(h), mesh.target(h)].map(VertexId::to_u32);
            connected.join(ends[0], ends[1]);
            for end in ends {
                is_joined[of.leader(end) as usize] = true;
            }
        }
        Classes {
            of,
            is_joined,
            connected,
        }
    }

    /// The classes at which the closed mesh would have a face with one vertex twice, a directed edge
    /// twice, or two faces with the same vertices.
    fn defects(&mut self, mesh: &Mesh) -> Vec<u32> {
        let roots = self.of.leaders();
        let mut bad = Vec::new();
        let (mut edges, mut faces) = (Vec::new(), Vec::new());
        for face in mesh.indices().as_chunks::<3>().0 {
            let [a, b, c] = face.map(|v| roots[v as usize]);
            if ![a, b, c].iter().any(|&root| self.is_joined[root as usize]) {
                continue;
            }
            if a == b || b == c || c == a {
                bad.extend([a, b, c]);
            }
            edges.extend([[a, b], [b, c], [c, a]]);
            let mut corners = [a, b, c];
            corners.sort_unstable();
            faces.push(corners);
        }
        edges.sort_unstable();
        faces.sort_unstable();
        let twice = edges.windows(2).filter(|two| two[0] == two[1]);
        bad.extend(twice.flat_map(|two| two[0]));
        let twice = faces.windows(2).filter(|two| two[0] == two[1]);
        bad.extend(twice.flat_map(|two| two[0]));
        bad.retain(|&root| self.is_joined[root as usize]);
        bad
    }
}

/// Seams that are closed for a while, so that a cut can cross them: see [`UnsewnSeams::close`].
///
/// It follows the log of the mesh. Replay every edit on it before the seams are reopened.
#[derive(Clone, Debug)]
pub struct ClosedSeams {
    /// By vertex: vertices that are one but for tears have the same. Seams do not matter. Empty if there
    /// are none.
    classes: Vec<u32>,
    next: u32,
    seen: Cursor,
}

impl ClosedSeams {
    /// Sets the place in the mesh's log at which the seams were closed. The default is [`Cursor::START`].
    #[must_use]
    pub fn starting_at(self, seen: Cursor) -> ClosedSeams {
        ClosedSeams { seen, ..self }
    }

    /// Removes the links that [`UnsewnSeams::close`] added, and those of the parts into which they
    /// were divided since. Linear.
    ///
    /// # Panics
    ///
    /// If this has not followed all edits of the mesh.
    pub fn reopen(self, mesh: &mut Mesh) {
        if self.classes.is_empty() {
            return;
        }
        let count = mesh.vertex_count();
        assert_eq!(
            self.classes.len(),
            count,
            "the seams have followed the mesh"
        );
        let class = |v: VertexId| self.classes[v.index()];
        mesh.open_seams(|mesh, h, g| {
            let pairs = joined(mesh, [h, g]);
            pairs.into_iter().any(|[a, b]| class(a) != class(b))
        });
    }

    fn push_class(&mut self) {
        self.classes.push(self.next);
        self.next += 1;
    }

    /// Whether two points are on the two sides of an edge that is torn without any seam closed.
    fn are_twins(&self, one: &InsertedPoint, other: &InsertedPoint) -> bool {
        let (Mix::Between { ends, t }, Mix::Between { ends: across, t: u }) = (one.at, other.at)
        else {
            return false;
        };
        let class = |v: VertexId| self.classes[v.index()];
        t == u && ends.map(class) == across.map(class)
    }
}

impl Follower for ClosedSeams {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        if self.classes.is_empty() {
            return;
        }
        match edit {
            Edit::Split(split) => self.classes.push(self.classes[split.old.index()]),
            Edit::Insert(insert) => {
                let mut before: Option<&InsertedPoint> = None;
                for point in insert.points {
                    match before.filter(|one| self.are_twins(one, point)) {
                        Some(one) => {
                            self.classes.push(self.classes[one.vertex.index()]);
                            before = None;
                        }
                        None => {
                            self.push_class();
                            before = Some(point);
                        }
                    }
                }
            }
            Edit::Merge(merge) => _ = self.classes.swap_remove(merge.gone.index()),
            Edit::Slide(_) => {}
        }
    }
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

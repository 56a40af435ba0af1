//! The insertion of vertices on edges and in faces.
//!
//! A straight cut needs vertices where the mesh has none. All points of a cut are inserted at once
//! ([`Plan`], [`Plan::apply`]), and each face that gets a point is retriangulated once. (If edges
//! were processed one by one, their order would decide the diagonals.) The surface keeps its shape,
//! and all tears remain: a paired edge becomes a chain of pairs, and a torn edge a chain of ghost
//! pairs. A point on a torn edge is inserted on *both* sides of the ghost link, as two vertices with
//! the same root. With a point on one side alone, the walk around a vertex could no longer cross the
//! link. Insertion tears and sews no link: only `split.rs` tears, and only `mend.rs` sews.
//!
//! The rule of retriangulation (`insert/face.rs`) needs no coordinates: it compares areas as
//! fractions of the area of the divided face, which no affine map changes.
//!
//! New vertices get the highest ids, in the order of the plan. The first child of a divided face
//! keeps the id of that face, and the other children get the highest face ids. The cost is linear
//! in the number of points and in the number of faces around the corners of divided faces, plus the
//! sorting of the plan.

mod face;
mod plan;

pub use plan::{Chord, ChordEnd, InsertRefusal, Plan, Point, PointId};

use crate::edit::{ChildFace, Edit, Edits, Insert, InsertedPoint, Mix};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use face::Retriangulation;

impl Plan {
    /// Inserts all points of this plan into a mesh, and retriangulates the faces.
    ///
    /// The new vertices are numbered in the order of the plan. A point on a torn edge becomes two
    /// vertices: first the one on the side of the given half-edge, then the one on the other side.
    ///
    /// ```text
    ///   on an edge                on a torn edge              in a face
    ///
    ///       c             c             c             c             c             c
    ///      / \           /|\           / \           /|\           / \           /|\
    ///     /   \         / | \         /   \         / | \         /   \         / | \
    ///    a-----b   ->  a--v--b       a-----b   ->  a--v--b       /     \   ->  /  v  \
    ///     \   /         \ | /        a'----b'      a'-w--b'     /       \     / ,' `. \
    ///      \ /           \|/          \   /         \ | /      a---------b   a'-------`b
    ///       d             d            \ /           \|/
    ///                                   d             d
    ///
    ///   One child of a divided face keeps its id. On a torn edge v and w are of one root.
    /// ```
    ///
    /// # Errors
    ///
    /// [`InsertRefusal`] gives the reason for a refusal. Nothing has changed then.
    ///
    /// # Panics
    ///
    /// If an id is not in this mesh (I2), or a point of a chord is not in this plan.
    pub fn apply<'e>(
        &self,
        mesh: &mut Mesh,
        edits: &'e mut Edits,
    ) -> Result<Insert<'e>, InsertRefusal> {
        Ok(self.prepare(mesh)?.carry_out(mesh, edits))
    }

    /// All that inserting the points takes, which changes nothing yet. Positions may change before
    /// it is carried out, and the mesh may not.
    pub(crate) fn prepare(&self, mesh: &Mesh) -> Result<Work, InsertRefusal> {
        for &Chord { f, ends } in &self.chords {
            mesh.half_edges_of(f);
            for end in ends {
                match end {
                    ChordEnd::Corner(h) => _ = mesh.origin(h),
                    ChordEnd::Point(p) => assert!(
                        p.index() < self.points.len(),
                        "I2: point {} is not one of this plan",
                        p.index()
                    ),
                }
            }
        }
        Work::new(self, mesh)
    }
}

/// A point on an edge, as both faces of the edge see it.
#[derive(Clone, Copy, Debug)]
struct OnEdge {
    /// The smaller half-edge of the edge, and how far along it the point is.
    edge: HalfEdgeId,
    along: f64,
    /// The half-edge that was given, and how far along that, or if not `forward`, from its
    /// target.
    given: HalfEdgeId,
    forward: bool,
    t: f64,
    /// The vertex on the side of the given half-edge, and that on the other.
    vertices: [VertexId; 2],
    point: PointId,
}

/// All that is to be done, worked out before anything is changed.
#[derive(Default)]
pub(crate) struct Work {
    placed: Vec<InsertedPoint>,
    /// The children of the faces that are to be divided.
    pub(crate) children: Vec<ChildFace>,
    segments: Vec<Segment>,
    /// Half-edges of children of one parent that become pairs.
    inner: Vec<[HalfEdgeId; 2]>,
}

/// A half-edge along the edge of a divided face that is not on the boundary.
struct Segment {
    /// The smaller half-edge of the whole edge, and which part of it, counted along that.
    part: (HalfEdgeId, usize),
    half_edge: HalfEdgeId,
    /// What the whole edge was linked to here, and whether the link is torn.
    opposite: HalfEdgeId,
    torn: bool,
}

impl Work {
    fn new(plan: &Plan, mesh: &Mesh) -> Result<Work, InsertRefusal> {
        let mut work = Work::default();
        let (on_edges, in_faces) = work.place(plan, mesh)?;
        let mut faces: Vec<FaceId> = in_faces.iter().map(|&(f, ..)| f).collect();
        for on in &on_edges {
            faces.push(on.edge.face());
            faces.extend(mesh.pair_or_ghost(on.edge).map(HalfEdgeId::face));
        }
        // A face without a point has no chord, and one that is demanded there is refused below.
        faces.extend(plan.chords.iter().map(|chord| chord.f));
        faces.sort_unstable();
        faces.dedup();
        let mut chords: Vec<&Chord> = plan.chords.iter().collect();
        chords.sort_by_key(|chord| chord.f);
        let mut next_face = mesh.face_count();
        let mut face = Retriangulation::default();
        for f in faces {
            face.clear();
            outline(mesh, f, &on_edges, &mut face);
            let of = f.half_edges();
            for &(_, vertex, weights) in equal_range(&in_faces, f, |&(f, ..)| f) {
                face.push(vertex, Mix::Weighted { of, weights }, None);
            }
            for chord in equal_range(&chords, f, |chord| chord.f) {
                let ends = chord.ends.map(|end| end_of(end, f, &face));
                let [Some(one), Some(other)] = ends else {
                    return Err(InsertRefusal::Chord { face: f });
                };
                face.chords.push([one.min(other), one.max(other)]);
            }
            face.run(f)?;
            work.divide(mesh, f, &face, &mut next_face);
        }
        if next_face > Mesh::MAX_FACES {
            return Err(InsertRefusal::Full { faces: next_face });
        }
        Ok(work)
    }

    /// Checks the points and gives them vertices. Returns those on edges by edge and along it,
    /// and those in faces by face.
    #[expect(clippy::type_complexity, reason = "two lists for one caller")]
    fn place(
        &mut self,
        plan: &Plan,
        mesh: &Mesh,
    ) -> Result<(Vec<OnEdge>, Vec<(FaceId, VertexId, [f64; 3])>), InsertRefusal> {
        let mut next = mesh.next_vertex().to_u32();
        let mut new_vertex = || {
            next += 1;
            VertexId::from_u32(next - 1)
        };
        let (mut on_edges, mut in_faces) = (Vec::new(), Vec::new());
        for (i, &point) in plan.points.iter().enumerate() {
            match point {
                Point::Edge { h, t, forward } => {
                    let ghost = mesh.ghost_pair(h);
                    if !(t > 0.0 && t < 1.0) {
                        return Err(InsertRefusal::Parameter { half_edge: h, t });
                    }
                    let place = |vertex: VertexId, ends: [HalfEdgeId; 2]| {
                        let ends = ends.map(|h| mesh.origin(h));
                        let at = Mix::Between { ends, t };
                        InsertedPoint { vertex, at }
                    };
                    let vertex = new_vertex();
                    self.placed.push(place(vertex, h.ends(forward)));
                    let mut vertices = [vertex; 2];
                    if let Some(ghost) = ghost {
                        let vertex = new_vertex();
                        vertices[1] = vertex;
                        self.placed.push(place(vertex, ghost.ends(!forward)));
                    }
                    let edge = mesh.pair_or_ghost(h).map_or(h, |g| g.min(h));
                    on_edges.push(OnEdge {
                        edge,
                        along: if (edge == h) == forward { t } else { 1.0 - t },
                        given: h,
                        forward,
                        t,
                        vertices,
                        point: PointId(i as u32),
                    });
                }
                Point::Face { f, weights } => {
                    let of = mesh.face_vertices(f);
                    let [a, b, c] = weights;
                    let sum = a + b + c;
                    if !(a > 0.0 && b > 0.0 && c > 0.0 && sum.is_finite()) {
                        return Err(InsertRefusal::Weights { face: f, weights });
                    }
                    let weights = weights.map(|w| w / sum);
                    let vertex = new_vertex();
                    let at = Mix::Weighted { of, weights };
                    self.placed.push(InsertedPoint { vertex, at });
                    in_faces.push((f, vertex, weights));
                }
            }
        }
        on_edges.sort_by(|a, b| {
            (a.edge, a.along)
                .partial_cmp(&(b.edge, b.along))
                .expect("0 < t < 1")
        });
        for two in on_edges.windows(2) {
            if two[0].edge == two[1].edge && two[0].along == two[1].along {
                let OnEdge { given, t, .. } = two[1];
                return Err(InsertRefusal::Repeated {
                    half_edge: given,
                    t,
                });
            }
        }
        in_faces.sort_by_key(|&(f, vertex, _)| (f, vertex));
        Ok((on_edges, in_faces))
    }

    /// Notes the children of a face, the half-edges that they have in common, and those along
    /// its edges.
    fn divide(&mut self, mesh: &Mesh, f: FaceId, face: &Retriangulation, next_face: &mut usize) {
        let ring = face.ring;
        let mut open: Vec<([usize; 2], HalfEdgeId)> = Vec::with_capacity(3 * face.triangles.len());
        for (i, &triangle) in face.triangles.iter().enumerate() {
            let id = if i == 0 {
                f
            } else {
                *next_face += 1;
                FaceId::from_u32((*next_face - 1) as u32)
            };
            let nodes = triangle.map(|n| &face.nodes[n]);
            self.children.push(ChildFace {
                parent: f,
                face: id,
                vertices: nodes.map(|node| node.vertex),
                sources: nodes.map(|node| node.source),
                share: face.share(triangle),
            });
            for (corner, h) in id.half_edges().into_iter().enumerate() {
                let (from, to) = (triangle[corner], triangle[(corner + 1) % 3]);
                if from < ring && to == (from + 1) % ring {
                    self.segments.extend(segment(mesh, f, face, from, h));
                } else if let Some(i) = open.iter().position(|&(ends, _)| ends == [to, from]) {
                    self.inner.push([open.swap_remove(i).1, h]);
                } else {
                    open.push(([from, to], h));
                }
            }
        }
        debug_assert!(
            open.is_empty(),
            "the children of a face cover it without a gap"
        );
    }

    /// Inserts the points.
    pub(crate) fn carry_out<'e>(mut self, mesh: &mut Mesh, edits: &'e mut Edits) -> Insert<'e> {
        let size = mesh.size();
        self.segments.sort_unstable_by_key(|segment| segment.part);
        self.change(mesh);
        edits.note_insertion(self.placed, self.children);
        let insert = Insert {
            before: edits.cursor(),
            points: &[],
            children: &[],
        };
        let Edit::Insert(insert) = edits.finish(Edit::Insert(insert), 0, size) else {
            unreachable!("an insertion was finished");
        };
        insert
    }

    fn change(&self, mesh: &mut Mesh) {
        for child in &self.children {
            if child.face == child.parent {
                for (h, v) in child.face.half_edges().into_iter().zip(child.vertices) {
                    mesh.set_origin(h, v);
                    mesh.unlink(h);
                }
            } else {
                debug_assert_eq!(child.face.index(), mesh.face_count());
                mesh.push_face(child.vertices);
            }
        }
        for &[h, g] in &self.inner {
            mesh.link(h, g, false);
        }
        for of_part in self.segments.chunk_by(|a, b| a.part == b.part) {
            let one = &of_part[0];
            // A face across that is not divided has the half-edge that it had.
            let across = of_part.get(1).map_or(one.opposite, |two| two.half_edge);
            mesh.link(one.half_edge, across, one.torn);
        }
        self.find_half_edges(mesh);
    }

    /// Gives every vertex of a divided face, and every new one, its smallest half-edge (I9).
    fn find_half_edges(&self, mesh: &mut Mesh) {
        let first_new = mesh.next_vertex().index();
        // The corners of a new vertex are all of children.
        let mut of_new: Vec<Option<HalfEdgeId>> = vec![None; self.placed.len()];
        let mut starts: Vec<(VertexId, HalfEdgeId)> = Vec::new();
        for child in &self.children {
            for (v, h) in child.vertices.into_iter().zip(child.face.half_edges()) {
                // Where the half-edge that a vertex had starts there still, it is the smallest: other
                // faces of the vertex, and their children, have higher ids.
                let moved = |first| mesh.origin(first) != v;
                if let Some(new) = v.index().checked_sub(first_new) {
                    of_new[new] = Some(of_new[new].map_or(h, |smallest| smallest.min(h)));
                } else if mesh.half_edge_of(v).is_some_and(moved) {
                    starts.push((v, h));
                }
            }
        }
        starts.sort_unstable();
        starts.dedup_by_key(|&mut (v, _)| v);
        // One walk tells of all copies of a vertex, each of which is among `starts` or has the
        // half-edge that it had.
        let mut known = vec![false; starts.len()];
        for i in 0..starts.len() {
            if known[i] {
                continue;
            }
            let (v, h) = starts[i];
            for g in mesh.orbit(h) {
                let at = match mesh.origin(g) {
                    u if u == v => Ok(i),
                    u => starts.binary_search_by_key(&u, |&(v, _)| v),
                };
                if let Ok(at) = at {
                    starts[at].1 = starts[at].1.min(g);
                    known[at] = true;
                }
            }
        }
        for (v, smallest) in starts {
            mesh.set_half_edge_of(v, smallest);
        }
        for smallest in of_new.into_iter().flatten() {
            mesh.push_vertex(smallest);
        }
    }
}

/// The half-edge that a child has along the outline of its parent, from this node on; none on the
/// boundary.
fn segment(
    mesh: &Mesh,
    f: FaceId,
    face: &Retriangulation,
    from: usize,
    half_edge: HalfEdgeId,
) -> Option<Segment> {
    let [a, b, c] = face.corners;
    let ends = [b, c, face.ring];
    let corner = ends.iter().position(|&end| from < end)?;
    let whole = f.half_edges()[corner];
    let opposite = mesh.pair_or_ghost(whole)?;
    let along = whole < opposite;
    let number = match along {
        true => from - [a, b, c][corner],
        false => ends[corner] - 1 - from,
    };
    Some(Segment {
        part: (whole.min(opposite), number),
        half_edge,
        opposite,
        torn: mesh.ghost_pair(whole).is_some(),
    })
}

/// The corners of a face, and between them the points on its edges.
fn outline(mesh: &Mesh, f: FaceId, on_edges: &[OnEdge], face: &mut Retriangulation) {
    for h in f.half_edges() {
        face.push(mesh.origin(h), Mix::Copy(h), None);
        let edge = mesh.pair_or_ghost(h).map_or(h, |g| g.min(h));
        let mut add = |on: &OnEdge| {
            let (given, t) = (on.given == h, on.t);
            let ends = h.ends(given == on.forward);
            let vertex = on.vertices[usize::from(!given)];
            face.push(vertex, Mix::Between { ends, t }, Some(on.point));
        };
        let here = equal_range(on_edges, edge, |on| on.edge);
        if edge == h {
            here.iter().for_each(&mut add);
        } else {
            here.iter().rev().for_each(&mut add);
        }
    }
}

/// The node at the end of a chord; `None` where it is not on the outline of the face.
fn end_of(end: ChordEnd, f: FaceId, face: &Retriangulation) -> Option<usize> {
    match end {
        ChordEnd::Corner(h) => (h.face() == f).then(|| face.corners[h.corner()]),
        ChordEnd::Point(point) => face.nodes.iter().position(|node| node.point == Some(point)),
    }
}

/// The part of a sorted list that has a key.
fn equal_range<T, K: Ord + Copy>(sorted: &[T], key: K, of: impl Fn(&T) -> K) -> &[T] {
    let start = sorted.partition_point(|one| of(one) < key);
    let count = sorted[start..]
        .iter()
        .take_while(|one| of(one) == key)
        .count();
    &sorted[start..start + count]
}

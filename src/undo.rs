//! Removes inserted vertices that no cut needs any more.
//!
//! A cut inserts vertices and divides faces. After it is sewn again ([`mend`](crate::mend)) they
//! are still there. [`Insertions`] remembers them from the log, and makes a mesh without those that
//! no longer separate anything.
//!
//! ```text
//!      c              c            v was put on an edge, and divided a face on each side: two families.
//!     ╱│╲            ╱ ╲           Each is taken back if its faces still agree on the corners a, b, c
//!    ╱ │ ╲    ->    ╱   ╲          of the parent, if they were not divided themselves (or that is taken
//!   a──v──b        a─────b         back first), if no tear ends on its sides or runs within it, and if v
//!    ╲ │ ╱          ╲   ╱          goes; and v goes if all families of its copies are taken back.
//!     ╲│╱            ╲ ╱
//!      d              d
//! ```
//!
//! So v goes where a–v and v–b are both whole, and where both are torn if a or b is torn there, too: a–b is
//! torn then as its parts were. Where one is torn, the tear would become longer, or heal.
//!
//! So everything stays that hangs together with something that has to: where a cut is still open, the
//! faces along it stay divided as far as points on their edges reach.
//!
//! The result is a mesh of its own, with maps back, and no edit of the old one: an edit would renumber
//! faces, and every follower would have to know of that. (`tearmesh-obj` carries out the same plan with a file, whose
//! record outlives the log, and has positions, texture and other programs to reckon with.)

use crate::edit::{CornerSource, Cursor, Edit, FaceFamily, Follower};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{DerivedMesh, Mesh};
use crate::sets::DisjointSets;

/// A [`Follower`] that records the insertions of a log so that they can be undone.
///
/// ```
/// use tearmesh::{mend, shapes, CutMethod, Edits, Insertions, Plane, Point, Scissor, Vector};
///
/// let (mut mesh, mut positions) = shapes::grid(8, 8);
/// let (before, mut insertions) = (mesh.clone(), Insertions::new(&mesh));
/// let mut edits = Edits::new();
/// let plane = Plane::new(Point::new(0.3, 0.0, 0.0), Vector::new(1.0, 0.2, 0.0))?;
/// Scissor::by_plane(plane).cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)?;
///
/// let stitches = mend::stitches(&mesh, |_| true);
/// mend::sew(&mut mesh, &positions, &stitches, |_| 1.0, 0.0, &mut edits)?;
/// edits.replay(&mut insertions);
/// let whole = insertions.undone(&mesh, |_| true, |_, _| true).expect("nothing is torn");
/// assert_eq!(whole.mesh(), &before);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Insertions {
    /// By vertex: the number of the point that was inserted, of which it may be a copy.
    points: Vec<u32>,
    /// Points that became one by a merge: the two sides of an edge that was torn.
    joined: DisjointSets,
    families: Vec<Family>,
    /// How many of these are not from the log: each comes before the one that it is within.
    given: usize,
    /// By face: the last family that it is a child of.
    families_of: Vec<u32>,
    seen: Cursor,
}

/// A divided face.
#[derive(Clone, Debug)]
struct Family {
    parent: FaceId,
    /// The family that the parent was a child of.
    above: u32,
    children: Vec<Child>,
    /// The points that are corners of children and not of the parent.
    points: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Child {
    part: FacePart,
    /// The family into which it was divided itself.
    divided: u32,
}

/// A face that is a part of a divided one, for [`Insertions::from_parts`].
#[derive(Clone, Copy, Debug)]
pub struct FacePart {
    /// The face. One that is part of a divided face itself stands for all of that.
    pub face: FaceId,
    /// For each corner of the face the number of the point that it is.
    pub points: [u32; 3],
    /// For each corner of the face the corner (0, 1 or 2) of the divided face that it is, if it is one.
    pub corners: [Option<usize>; 3],
    /// For each corner of the face, whether it is on each side of the divided face. Side `i` runs from
    /// corner `i` to the next.
    pub on_sides: [[bool; 3]; 3],
}

const NONE: u32 = u32::MAX;

impl Insertions {
    /// Creates the record for a mesh in which no vertex has been inserted yet. Linear in the size
    /// of the mesh.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Insertions {
        Insertions {
            points: vec![NONE; mesh.vertex_count()],
            joined: DisjointSets::default(),
            families: Vec::new(),
            given: 0,
            families_of: vec![NONE; mesh.face_count()],
            seen: Cursor::START,
        }
    }

    /// Sets the place in the log that the mesh was at when this record was created.
    #[must_use]
    pub fn starting_at(self, seen: Cursor) -> Insertions {
        Insertions { seen, ..self }
    }

    /// Returns the mesh without the inserted vertices that no longer separate anything, or `None`
    /// if there are no such vertices. The faces that they divided are restored, each in place of
    /// the divided face. Once all tears are sewn, the result is the mesh from before the cuts.
    ///
    /// * `may_go` returns whether an inserted vertex may be removed. Return false for a vertex that
    ///   has been moved and so carries shape.
    /// * `agree` returns whether two corners of one vertex have the same values. Each corner of a
    ///   restored face takes its values from one of several corners.
    ///
    /// A vertex that slid ([`slide`](crate::slide)) keeps its position. The vertices that remain
    /// are not recorded for the new mesh, so keep the old mesh if you want to remove more of them
    /// later. Linear, except around vertices with very many faces.
    ///
    /// # Panics
    ///
    /// If `mesh` is not the mesh of the log that was followed, or the log has not been replayed to its end.
    #[must_use]
    pub fn undone(
        &self,
        mesh: &Mesh,
        may_go: impl Fn(VertexId) -> bool,
        agree: impl Fn(HalfEdgeId, HalfEdgeId) -> bool,
    ) -> Option<DerivedMesh> {
        let going = self.plan(mesh, may_go, agree);
        let roots = mesh.roots();
        let is_point = |v: usize| going.goes(VertexId::new(v).expect("I1: ids fit"));
        if !(0..roots.len()).any(is_point) {
            return None;
        }
        let mut number = vec![NONE; roots.len()];
        let mut vertices = Vec::with_capacity(roots.len());
        for v in mesh.vertices().filter(|v| !is_point(v.index())) {
            number[v.index()] = vertices.len() as u32;
            vertices.push(v);
        }
        let (mut faces, mut corners) = (Vec::new(), Vec::new());
        for f in mesh.faces() {
            match self.restored(f, &going) {
                None => corners.extend(f.half_edges()),
                Some((parent, own)) if parent == f => corners.extend(own),
                Some(_) => continue,
            }
            faces.push(f);
        }
        let origins = corners.iter().map(|&h| number[mesh.origin(h).index()]);
        let triangles: Vec<u32> = origins.collect();
        let roots = vertices.iter().map(|v| number[roots[v.index()] as usize]);
        let made = Mesh::build_torn(triangles.as_chunks().0, &roots.collect::<Vec<_>>());
        let made = made.expect("the mesh before an insertion is a torn mesh");
        Some(DerivedMesh::new(made, vertices, faces, corners))
    }

    /// Creates the record from what is known of a mesh without its log: the number of the point that
    /// each vertex is, the same for all its copies, and the parts of each divided face. A face that is part
    /// of a divided one is given before that. Vertices that were never inserted have points, too, and
    /// must not go.
    #[must_use]
    pub fn from_parts(
        mesh: &Mesh,
        point: impl Fn(VertexId) -> u32,
        families: impl IntoIterator<Item = Vec<FacePart>>,
    ) -> Insertions {
        let mut insertions = Insertions::new(mesh);
        insertions.points = mesh.vertices().map(point).collect();
        let last = insertions.points.iter().max();
        insertions.joined = DisjointSets::new(last.map_or(0, |last| last + 1));
        for parts in families {
            let number = insertions.families.len() as u32;
            let children = parts.into_iter().map(|part| Child {
                divided: insertions.outermost(part.face),
                part,
            });
            let children: Vec<Child> = children.collect();
            let mut points = Vec::new();
            for &Child { part, divided } in &children {
                match divided {
                    NONE => insertions.families_of[part.face.index()] = number,
                    inner => insertions.families[inner as usize].above = number,
                }
                let inside = part.corners.iter().zip(part.points);
                points.extend(
                    inside
                        .filter(|(corner, _)| corner.is_none())
                        .map(|(_, point)| point),
                );
            }
            points.sort_unstable();
            points.dedup();
            insertions.families.push(Family {
                parent: children
                    .first()
                    .map_or_else(first_face, |child| child.part.face),
                above: NONE,
                children,
                points,
            });
        }
        insertions.given = insertions.families.len();
        insertions
    }

    /// The last family that a face is within.
    fn outermost(&self, face: FaceId) -> u32 {
        let mut family = self.families_of[face.index()];
        while family != NONE && self.families[family as usize].above != NONE {
            family = self.families[family as usize].above;
        }
        family
    }

    /// Returns which inserted vertices can be removed, and which divided faces are restored then.
    /// `may_go` and `agree` are as for [`Insertions::undone`], which carries out this plan.
    ///
    /// # Panics
    ///
    /// If `mesh` is not the mesh of the log that was followed, or the log has not been replayed to its end.
    #[must_use]
    pub fn plan(
        &self,
        mesh: &Mesh,
        may_go: impl Fn(VertexId) -> bool,
        agree: impl Fn(HalfEdgeId, HalfEdgeId) -> bool,
    ) -> RemovalPlan {
        assert_eq!(
            [mesh.vertex_count(), mesh.face_count()],
            [self.points.len(), self.families_of.len()],
            "the insertions have seen all edits of the mesh"
        );
        RemovalPlan::find(self, mesh, may_go, agree)
    }

    /// The face that is restored where this one is, if one is, and its corners.
    fn restored(&self, f: FaceId, going: &RemovalPlan) -> Option<(FaceId, [HalfEdgeId; 3])> {
        let mut found = None;
        let mut family = self.families_of[f.index()];
        while family != NONE {
            let Some(corners) = going.restored(family as usize) else {
                break;
            };
            let Family { parent, above, .. } = self.families[family as usize];
            found = Some((parent, corners));
            family = above;
        }
        found
    }

    fn divide(&mut self, family: FaceFamily<'_>) {
        let parent = family.parent();
        let number = self.families.len() as u32;
        let above = self.families_of[parent.index()];
        if above != NONE {
            let children = self.families[above as usize].children.iter_mut();
            let own = children.into_iter().find(|child| child.part.face == parent);
            own.expect("a face is a child of its family").divided = number;
        }
        let mut points = Vec::new();
        for child in family.children() {
            let made = child.vertices.iter().zip(child.sources);
            let made = made.filter(|(_, source)| !matches!(source, CornerSource::Corner(_)));
            points.extend(made.map(|(v, _)| self.points[v.index()]));
            if child.face == parent {
                self.families_of[parent.index()] = number;
            } else {
                self.families_of.push(number);
            }
        }
        points.sort_unstable();
        points.dedup();
        let children = family.children().iter().map(|child| Child {
            divided: NONE,
            part: FacePart {
                face: child.face,
                points: child.vertices.map(|v| self.points[v.index()]),
                corners: child.sources.map(|source| match source {
                    CornerSource::Corner(h) => Some(h.corner()),
                    CornerSource::Edge { .. } | CornerSource::Face { .. } => None,
                }),
                on_sides: child.sources.map(sides_at),
            },
        });
        self.families.push(Family {
            parent,
            above,
            children: children.collect(),
            points,
        });
    }
}

fn first_face() -> FaceId {
    FaceId::new(0).expect("small")
}

/// Which sides of a face a place is on.
fn sides_at(place: CornerSource) -> [bool; 3] {
    let of = |corner: usize| [0, 1, 2].map(|side| side == corner || (side + 1) % 3 == corner);
    match place {
        CornerSource::Corner(h) => of(h.corner()),
        CornerSource::Edge { ends, .. } => {
            let [one, other] = ends.map(|h| of(h.corner()));
            [0, 1, 2].map(|side| one[side] && other[side])
        }
        CornerSource::Face { .. } => [false; 3],
    }
}

impl Follower for Insertions {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Split(split) => self.points.push(self.points[split.old.index()]),
            Edit::Insert(insert) => {
                for _ in insert.points {
                    let point = self.joined.push();
                    self.points.push(point);
                }
                insert.families().for_each(|family| self.divide(family));
            }
            Edit::Merge(merge) => {
                let [kept, gone] = [merge.kept, merge.gone].map(|v| self.points[v.index()]);
                if kept != NONE && gone != NONE {
                    self.joined.join(kept, gone);
                }
                self.points.swap_remove(merge.gone.index());
            }
            Edit::Slide(_) => {} // It moves a vertex, and divides nothing.
        }
    }
}

/// Which inserted vertices can be removed, and which divided faces are restored then. Returned by
/// [`Insertions::plan`].
#[derive(Clone, Debug)]
pub struct RemovalPlan {
    /// By vertex, the point that was inserted.
    points: Vec<u32>,
    /// By point, the least of those that became one with it, or are on the other side of a tear.
    leaders: Vec<u32>,
    /// By point, the least of those that are one.
    goes: Vec<bool>,
    /// By family, the sides of the parent if it is restored.
    whole: Vec<Option<[Side; 3]>>,
}

/// A side of a face that is restored or was never divided: the first and the last half-edge along it.
/// All between are torn as the first one is.
#[derive(Clone, Copy, Debug)]
struct Side {
    first: HalfEdgeId,
    last: HalfEdgeId,
}

impl RemovalPlan {
    /// Returns whether a vertex is removed.
    ///
    /// # Panics
    ///
    /// If the mesh has no such vertex.
    #[must_use]
    pub fn goes(&self, v: VertexId) -> bool {
        let point = self.points[v.index()];
        point != NONE && self.goes[self.leader(point)]
    }

    /// Returns the half-edges whose corners a divided face has when it is restored, or `None` if it is
    /// not. Divided faces are counted in the order in which they were divided, or given.
    ///
    /// # Panics
    ///
    /// If there is no such divided face.
    #[must_use]
    pub fn restored(&self, divided: usize) -> Option<[HalfEdgeId; 3]> {
        self.whole[divided].map(|sides| sides.map(|side| side.first))
    }

    fn find(
        insertions: &Insertions,
        mesh: &Mesh,
        may_go: impl Fn(VertexId) -> bool,
        agree: impl Fn(HalfEdgeId, HalfEdgeId) -> bool,
    ) -> RemovalPlan {
        let families = &insertions.families;
        let roots = mesh.roots();
        let mut joined = insertions.joined.clone();
        let of_point = |v: &VertexId| insertions.points[v.index()] != NONE;
        for v in mesh.vertices().filter(of_point) {
            let [one, other] = [v.index(), roots[v.index()] as usize];
            joined.join(insertions.points[one], insertions.points[other]);
        }
        let leaders = joined.leaders().to_vec();
        let mut going = RemovalPlan {
            points: insertions.points.clone(),
            goes: vec![true; leaders.len()],
            leaders,
            whole: vec![None; families.len()],
        };
        for v in mesh.vertices().filter(of_point) {
            let leader = going.leader(insertions.points[v.index()]);
            going.goes[leader] &= may_go(v);
        }
        // What is inside is looked at first: in the log, a face is divided again later.
        let given = insertions.given;
        for number in (given..families.len()).rev().chain(0..given) {
            going.whole[number] = going.sides(&families[number], mesh, &agree);
        }
        going.take_back(insertions);
        going
    }

    fn leader(&self, point: u32) -> usize {
        self.leaders[point as usize] as usize
    }

    /// The sides of a divided face, if its children are whole and agree on its corners, and no tear
    /// runs between them or along a part of a side.
    fn sides(
        &self,
        family: &Family,
        mesh: &Mesh,
        agree: &impl Fn(HalfEdgeId, HalfEdgeId) -> bool,
    ) -> Option<[Side; 3]> {
        let mut corners: [Option<HalfEdgeId>; 3] = [None; 3];
        let mut parts = [const { Vec::new() }; 3];
        for child in &family.children {
            let own = match child.divided {
                NONE => child
                    .part
                    .face
                    .half_edges()
                    .map(|h| Side { first: h, last: h }),
                inner => self.whole[inner as usize]?,
            };
            let FacePart {
                corners: at,
                on_sides,
                ..
            } = child.part;
            for (i, side) in own.into_iter().enumerate() {
                if let Some(corner) = at[i] {
                    let h = side.first;
                    let first = *corners[corner].get_or_insert(h);
                    let is_one = mesh.origin(first) == mesh.origin(h);
                    if first != h && !(is_one && agree(first, h)) {
                        return None;
                    }
                }
                let next = (i + 1) % 3;
                match (0..3).find(|&of_parent| on_sides[i][of_parent] && on_sides[next][of_parent])
                {
                    Some(of_parent) => {
                        let begins = at[i] == Some(of_parent);
                        let ends = at[next] == Some((of_parent + 1) % 3);
                        parts[of_parent].push((side, begins, ends));
                    }
                    None if mesh.ghost_pair(side.first).is_some() => return None,
                    None => {}
                }
            }
        }
        let [a, b, c] = parts.map(|parts| joined(&parts, mesh));
        Some([a?, b?, c?])
    }

    /// Takes back what cannot go, and what follows from that.
    fn take_back(&mut self, insertions: &Insertions) {
        let families = &insertions.families;
        let mut families_at: Vec<Vec<u32>> = vec![Vec::new(); self.goes.len()];
        for (family, number) in families.iter().zip(0..) {
            for &point in &family.points {
                families_at[self.leader(point)].push(number);
            }
        }
        let mut stays: Vec<usize> = (0..self.goes.len()).filter(|&p| !self.goes[p]).collect();
        let mut divided: Vec<u32> = Vec::new();
        divided.extend((0..families.len() as u32).filter(|&f| self.whole[f as usize].is_none()));
        loop {
            if let Some(family) = divided.pop() {
                let Family { above, points, .. } = &families[family as usize];
                let above = *above;
                for &point in points {
                    let point = self.leader(point);
                    if std::mem::take(&mut self.goes[point]) {
                        stays.push(point);
                    }
                }
                if above != NONE && self.whole[above as usize].take().is_some() {
                    divided.push(above);
                }
            } else if let Some(point) = stays.pop() {
                for &family in &families_at[point] {
                    if self.whole[family as usize].take().is_some() {
                        divided.push(family);
                    }
                }
            } else {
                return;
            }
        }
    }
}

/// The parts of a side as one: the first begins at a corner of the face, and the last ends at one.
/// `None` if they are not all torn or all whole, or if the whole side would not be torn as they are.
fn joined(parts: &[(Side, bool, bool)], mesh: &Mesh) -> Option<Side> {
    let first = parts.iter().find(|(_, begins, _)| *begins);
    let last = parts.iter().find(|(.., ends)| *ends);
    let (first, last) = (first?.0.first, last?.0.last); // A record may be of no face.
    let ghost = mesh.ghost_pair(first);
    let is_torn = |h: HalfEdgeId| mesh.ghost_pair(h).is_some();
    if parts
        .iter()
        .any(|(part, ..)| is_torn(part.first) != ghost.is_some())
    {
        return None;
    }
    // Torn is what has different vertices on its two sides, at one end or both.
    let is_apart = |h: HalfEdgeId, ghost: HalfEdgeId| {
        [
            mesh.origin(h) != mesh.target(ghost),
            mesh.target(h) != mesh.origin(ghost),
        ]
    };
    let stays_torn = match (ghost, mesh.ghost_pair(last)) {
        (Some(one), Some(other)) => is_apart(first, one)[0] || is_apart(last, other)[1],
        _ => true,
    };
    stays_torn.then_some(Side { first, last })
}

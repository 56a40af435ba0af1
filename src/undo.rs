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
//!   a──v──b        a─────b         back first), and if v goes; and v goes if it has no copies, and both
//!    ╲ │ ╱          ╲   ╱          families are taken back.
//!     ╲│╱            ╲ ╱
//!      d              d
//! ```
//!
//! So everything stays that hangs together with something that has to: where a cut is still open, the
//! faces along it stay divided as far as points on their edges reach.
//!
//! The result is a mesh of its own, with maps back, and no edit of the old one: an edit would renumber
//! faces, and every follower would have to know of that. (`tearmesh-obj` does the same with a file, whose
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
    face: FaceId,
    /// The family into which it was divided itself.
    divided: u32,
    /// For each of its corners that of the parent that it is, if it is one.
    corners: [Option<usize>; 3],
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
        assert_eq!(
            [mesh.vertex_count(), mesh.face_count()],
            [self.points.len(), self.families_of.len()],
            "the insertions have seen all edits of the mesh"
        );
        let roots = mesh.roots();
        let going = Going::find(self, mesh, &roots, may_go, agree);
        let is_point =
            |v: usize| self.points[v] != NONE && going.goes[going.leader(self.points[v])];
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

    /// The face that is restored where this one is, if one is, and its corners.
    fn restored(&self, f: FaceId, going: &Going) -> Option<(FaceId, [HalfEdgeId; 3])> {
        let mut found = None;
        let mut family = self.families_of[f.index()];
        while family != NONE {
            let Some(corners) = going.whole[family as usize] else {
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
            let own = children.into_iter().find(|child| child.face == parent);
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
            face: child.face,
            divided: NONE,
            corners: child.sources.map(|source| match source {
                CornerSource::Corner(h) => Some(h.corner()),
                CornerSource::Edge { .. } | CornerSource::Face { .. } => None,
            }),
        });
        self.families.push(Family {
            parent,
            above,
            children: children.collect(),
            points,
        });
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

/// What goes.
struct Going {
    /// By point, the least of those that became one with it.
    leaders: Vec<u32>,
    /// By point, the least of those that are one.
    goes: Vec<bool>,
    /// By family, the corners of the parent if it is restored.
    whole: Vec<Option<[HalfEdgeId; 3]>>,
}

impl Going {
    fn find(
        insertions: &Insertions,
        mesh: &Mesh,
        roots: &[u32],
        may_go: impl Fn(VertexId) -> bool,
        agree: impl Fn(HalfEdgeId, HalfEdgeId) -> bool,
    ) -> Going {
        let families = &insertions.families;
        let mut copies = vec![0_u32; roots.len()];
        roots.iter().for_each(|&root| copies[root as usize] += 1);
        let leaders = insertions.joined.clone().leaders().to_vec();
        let mut going = Going {
            goes: vec![false; leaders.len()],
            leaders,
            whole: vec![None; families.len()],
        };
        for v in mesh.vertices() {
            let (point, root) = (insertions.points[v.index()], roots[v.index()]);
            if point != NONE {
                let leader = going.leader(point);
                going.goes[leader] = copies[root as usize] == 1 && may_go(v);
            }
        }
        // A face is divided again later, so what is inside is looked at first.
        for (number, family) in families.iter().enumerate().rev() {
            going.whole[number] = going.corners(family, mesh, &agree);
        }
        going.take_back(insertions);
        going
    }

    fn leader(&self, point: u32) -> usize {
        self.leaders[point as usize] as usize
    }

    /// The corners of a divided face, if its children are whole and agree on them.
    fn corners(
        &self,
        family: &Family,
        mesh: &Mesh,
        agree: &impl Fn(HalfEdgeId, HalfEdgeId) -> bool,
    ) -> Option<[HalfEdgeId; 3]> {
        let mut found: [Option<HalfEdgeId>; 3] = [None; 3];
        for child in &family.children {
            let own = match child.divided {
                NONE => child.face.half_edges(),
                inner => self.whole[inner as usize]?,
            };
            for (h, corner) in own.into_iter().zip(child.corners) {
                let Some(corner) = corner else { continue };
                let first = *found[corner].get_or_insert(h);
                let is_one = mesh.origin(first) == mesh.origin(h);
                if first != h && !(is_one && agree(first, h)) {
                    return None;
                }
            }
        }
        let [a, b, c] = found.map(|h| h.expect("the children of a face have its corners"));
        Some([a, b, c])
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

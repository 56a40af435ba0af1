//! Which inserted vertices no cut needs any more.
//!
//! A cut inserts vertices and divides faces. After it is sewn again ([`mend`](crate::mend)) they
//! are still there. [`Insertions`] holds what was divided, and plans which of that can be restored: what
//! no longer separates anything.
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
//! A plan is no edit: that would renumber faces, and every follower would have to know of it.
//! (`tearmesh-obj` carries a plan out with a file, whose record outlives the log.)

use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;

/// The divided faces of a mesh, from which the insertions can be undone.
///
/// ```
/// use tearmesh::{insert::Plan, shapes, Edits, FacePart, Insertions, Mix};
///
/// let (mut mesh, _) = shapes::triangle();
/// let (mut plan, mut edits) = (Plan::new(), Edits::new());
/// plan.in_face(mesh.faces().next().unwrap(), [1.0; 3]);
/// let insert = plan.apply(&mut mesh, &mut edits)?;
///
/// // One divided face. None of its parts' new corners is on a side of it.
/// let parts = insert.children.iter().map(|child| {
///     let corners = child.sources.map(|source| match source {
///         Mix::Copy(h) => Some(h.corner()),
///         _ => None,
///     });
///     let sides_at = |corner: usize| [0, 1, 2].map(|side| side == corner || (side + 1) % 3 == corner);
///     FacePart {
///         face: child.face,
///         roots: child.vertices.map(|v| u32::from(v)), // nothing is torn
///         corners,
///         on_sides: corners.map(|corner| corner.map_or([false; 3], sides_at)),
///     }
/// });
/// let inserted = insert.points[0].vertex;
/// let insertions = Insertions::new(&mesh, [parts.collect()]);
/// let plan = insertions.plan(&mesh, |v| v == inserted, |_, _| true);
/// assert!(plan.goes(inserted) && plan.restored(0).is_some());
/// # Ok::<(), tearmesh::InsertRefusal>(())
/// ```
#[derive(Clone, Debug)]
pub struct Insertions {
    /// By vertex.
    roots: Vec<u32>,
    /// Each before the one that it is within.
    families: Vec<Family>,
}

/// A divided face.
#[derive(Clone, Debug)]
struct Family {
    /// The family that the face was a part of itself.
    above: u32,
    children: Vec<Child>,
    /// The roots at corners of parts that are no corners of the face.
    points: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Child {
    part: FacePart,
    /// The family into which it was divided itself.
    divided: u32,
}

/// A face that is a part of a divided one.
#[derive(Clone, Copy, Debug)]
pub struct FacePart {
    /// The face. One that is part of a divided face itself stands for all of that.
    pub face: FaceId,
    /// The root of the vertex at each corner of the face, as in [`Mesh::roots`].
    pub roots: [u32; 3],
    /// For each corner of the face the corner (0, 1 or 2) of the divided face that it is, if it is one.
    pub corners: [Option<usize>; 3],
    /// For each corner of the face, whether it is on each side of the divided face. Side `i` runs from
    /// corner `i` to the next.
    pub on_sides: [[bool; 3]; 3],
}

const NONE: u32 = u32::MAX;

impl Insertions {
    /// Creates the record of the divided faces of a mesh, each as its parts. A face that is part of a
    /// divided one is given before that.
    ///
    /// # Panics
    ///
    /// If a face is not in this mesh.
    #[must_use]
    pub fn new(mesh: &Mesh, families: impl IntoIterator<Item = Vec<FacePart>>) -> Insertions {
        let mut insertions = Insertions {
            roots: mesh.roots(),
            families: Vec::new(),
        };
        // By face, the first family that it is within.
        let mut families_of = vec![NONE; mesh.face_count()];
        for parts in families {
            let number = insertions.families.len() as u32;
            let children = parts.into_iter().map(|part| Child {
                divided: insertions.outermost(families_of[part.face.index()]),
                part,
            });
            let children: Vec<Child> = children.collect();
            let mut points = Vec::new();
            for &Child { part, divided } in &children {
                match divided {
                    NONE => families_of[part.face.index()] = number,
                    inner => insertions.families[inner as usize].above = number,
                }
                let at = part.corners.iter().zip(part.roots);
                let inside = at.filter(|(corner, _)| corner.is_none());
                points.extend(inside.map(|(_, root)| root));
            }
            points.sort_unstable();
            points.dedup();
            insertions.families.push(Family {
                above: NONE,
                children,
                points,
            });
        }
        insertions
    }

    /// The last family around one.
    fn outermost(&self, mut family: u32) -> u32 {
        while family != NONE && self.families[family as usize].above != NONE {
            family = self.families[family as usize].above;
        }
        family
    }

    /// Returns which inserted vertices can be removed, and which divided faces are restored then.
    ///
    /// * `may_go` returns whether a vertex may be removed. It must return false for one that was never
    ///   inserted. Return false for one that has been moved and so carries shape.
    /// * `agree` returns whether two corners of one vertex have the same values. Each corner of a
    ///   restored face takes its values from one of several corners.
    ///
    /// # Panics
    ///
    /// If `mesh` is another one, or was edited since.
    #[must_use]
    pub fn plan(
        &self,
        mesh: &Mesh,
        may_go: impl Fn(VertexId) -> bool,
        agree: impl Fn(HalfEdgeId, HalfEdgeId) -> bool,
    ) -> RemovalPlan {
        assert_eq!(
            mesh.vertex_count(),
            self.roots.len(),
            "the insertions are those of the mesh"
        );
        let mut going = RemovalPlan {
            roots: self.roots.clone(),
            goes: vec![true; self.roots.len()],
            whole: vec![None; self.families.len()],
        };
        for (v, &root) in mesh.vertices().zip(&self.roots) {
            going.goes[root as usize] &= may_go(v);
        }
        for (number, family) in self.families.iter().enumerate() {
            going.whole[number] = going.sides(family, mesh, &agree);
        }
        going.take_back(&self.families);
        going
    }
}

/// Which inserted vertices can be removed, and which divided faces are restored then. Returned by
/// [`Insertions::plan`].
#[derive(Clone, Debug)]
pub struct RemovalPlan {
    /// By vertex.
    roots: Vec<u32>,
    /// By root.
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
        self.goes[self.roots[v.index()] as usize]
    }

    /// Returns the half-edges whose corners a divided face has when it is restored, or `None` if it is
    /// not. Divided faces are counted in the order in which they were given.
    ///
    /// # Panics
    ///
    /// If there is no such divided face.
    #[must_use]
    pub fn restored(&self, divided: usize) -> Option<[HalfEdgeId; 3]> {
        self.whole[divided].map(|sides| sides.map(|side| side.first))
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
            let part = &child.part;
            let own = match child.divided {
                NONE => part.face.half_edges().map(|h| Side { first: h, last: h }),
                inner => self.whole[inner as usize]?,
            };
            for (i, side) in own.into_iter().enumerate() {
                if let Some(corner) = part.corners[i] {
                    let h = side.first;
                    let first = *corners[corner].get_or_insert(h);
                    let is_one = mesh.origin(first) == mesh.origin(h);
                    if first != h && !(is_one && agree(first, h)) {
                        return None;
                    }
                }
                let next = (i + 1) % 3;
                let [from, to] = [part.on_sides[i], part.on_sides[next]];
                match (0..3).find(|&of_parent| from[of_parent] && to[of_parent]) {
                    Some(of_parent) => {
                        let begins = part.corners[i] == Some(of_parent);
                        let ends = part.corners[next] == Some((of_parent + 1) % 3);
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
    fn take_back(&mut self, families: &[Family]) {
        let mut families_at: Vec<Vec<u32>> = vec![Vec::new(); self.goes.len()];
        for (family, number) in families.iter().zip(0..) {
            for &point in &family.points {
                families_at[point as usize].push(number);
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
                    if std::mem::take(&mut self.goes[point as usize]) {
                        stays.push(point as usize);
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
    let is_torn = |h: HalfEdgeId| mesh.ghost_pair(h).is_some();
    if parts
        .iter()
        .any(|(part, ..)| is_torn(part.first) != is_torn(first))
    {
        return None;
    }
    // Torn is what has different vertices on its two sides, at one end or both.
    let stays_torn = match [first, last].map(|h| mesh.ghost_pair(h)) {
        [Some(ghost), Some(of_last)] => {
            mesh.origin(first) != mesh.target(ghost) || mesh.target(last) != mesh.origin(of_last)
        }
        _ => true,
    };
    stays_torn.then_some(Side { first, last })
}

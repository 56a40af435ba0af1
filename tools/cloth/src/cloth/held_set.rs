//! Vertices that are held together: those of one hold of a scene, of one call, or in one hand.
//!
//! The copies of a held vertex are held as well, and so is every vertex that a cut inserts between vertices of
//! the set. Otherwise a cut through a clamp would leave free vertices in it, and these tear out as it moves. A
//! vertex that was inserted leaves the set once nothing at it is torn any more.

use std::collections::BTreeSet;

use tearmesh::{Edit, InsertedPoint, Merge, Mesh, Mix, VertexId};

/// The vertices of a hold, and those among them that cuts inserted.
#[derive(Clone, Debug, Default)]
pub(crate) struct HeldSet {
    /// Ascending.
    vertices: Vec<VertexId>,
    inserted: Vec<Inserted>,
}

/// A vertex that a cut inserted between vertices of a set.
#[derive(Clone, Copy, Debug)]
struct Inserted {
    vertex: VertexId,
    between: Mix<VertexId>,
}

impl HeldSet {
    pub(crate) const EMPTY: HeldSet = HeldSet {
        vertices: Vec::new(),
        inserted: Vec::new(),
    };

    pub(crate) fn new(mut vertices: Vec<VertexId>) -> HeldSet {
        vertices.sort_unstable();
        vertices.dedup();
        HeldSet {
            vertices,
            ..HeldSet::EMPTY
        }
    }

    pub(crate) fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }

    pub(crate) fn contains(&self, v: VertexId) -> bool {
        self.vertices.binary_search(&v).is_ok()
    }

    /// Whether another set has all vertices of this one.
    pub(crate) fn is_within(&self, other: &HeldSet) -> bool {
        self.vertices.iter().all(|v| other.contains(*v))
    }

    /// Takes vertices out.
    pub(crate) fn remove(&mut self, gone: &HeldSet) {
        self.vertices.retain(|v| !gone.contains(*v));
        self.inserted.retain(|one| !gone.contains(one.vertex));
    }

    /// The vertices that cuts inserted, each with and after those that it is between.
    pub(crate) fn inserted(&self) -> impl Iterator<Item = (VertexId, Mix<VertexId>)> {
        let inserted = self.inserted.iter();
        inserted.map(|inserted| (inserted.vertex, inserted.between))
    }

    /// Adds the copies that a split makes of vertices, gives them the ids that they have after a merge, and, if
    /// the set `is_held` now, adds the vertices that are inserted between those of the set.
    pub(crate) fn follow(&mut self, edit: &Edit<'_>, is_held: bool) {
        match edit {
            Edit::Split(split) if self.contains(split.old) => {
                self.vertices.push(split.new); // The highest id of all.
                let of_old = |one: &&Inserted| one.vertex == split.old;
                let copied = self.inserted.iter().find(of_old);
                let copied = copied.map(|inserted| Inserted {
                    vertex: split.new,
                    ..*inserted
                });
                self.inserted.extend(copied);
            }
            Edit::Insert(insert) if is_held => {
                for &InsertedPoint { vertex, at } in insert.points {
                    let mut is_within = true;
                    let _ = at.map(|v| is_within &= self.contains(v));
                    if is_within {
                        self.vertices.push(vertex);
                        let between = at;
                        self.inserted.push(Inserted { vertex, between });
                    }
                }
            }
            Edit::Merge(merge) => self.merge(merge),
            Edit::Split(_) | Edit::Insert(_) | Edit::Slide(_) => {}
            _ => unreachable!("there is no other edit"),
        }
    }

    fn merge(&mut self, merge: &Merge<'_>) {
        self.vertices.iter_mut().for_each(|v| *v = now(*v, merge));
        self.vertices.sort_unstable();
        self.vertices.dedup();
        for inserted in &mut self.inserted {
            inserted.vertex = now(inserted.vertex, merge);
            inserted.between = inserted.between.map(|v| now(v, merge));
        }
        // Two copies became one; they were between the same vertices.
        let mut known = BTreeSet::new();
        self.inserted.retain(|one| known.insert(one.vertex));
    }

    /// Takes out the vertices that cuts inserted and at which nothing is torn any more, and returns them.
    pub(crate) fn take_healed(&mut self, mesh: &Mesh) -> HeldSet {
        let is_healed = |v: &VertexId| {
            let mut around = mesh.corners_of(*v).flat_map(|h| [h, h.prev()]);
            around.all(|h| mesh.ghost_pair(h).is_none())
        };
        let inserted = self.inserted().map(|(v, _)| v);
        let healed = HeldSet::new(inserted.filter(is_healed).collect());
        self.remove(&healed);
        healed
    }
}

/// The id that a vertex has after a merge.
pub(crate) fn now(v: VertexId, merge: &Merge<'_>) -> VertexId {
    match merge.renumbered {
        _ if v == merge.gone => merge.kept,
        Some(renumbered) if v == renumbered.from => renumbered.to,
        _ => v,
    }
}

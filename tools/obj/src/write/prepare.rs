//! What is written of a torn document: which faces in which order, under which numbers, and
//! what goes on record.

use tearmesh::{Mesh, VertexId};

use super::separate::Separated;
use crate::record::{Inserted, Parent, Record};
use crate::said::Said;
use crate::torn::{Removal, Slots, SplitOff, TornDocument};

/// What is written, worked out before the first byte.
#[derive(Debug)]
pub(crate) struct Prepared<'m> {
    pub(super) slots: Slots,
    pub(super) separated: Separated<'m>,
    removal: Option<&'m Removal>,
    /// The number of vertices of the mesh.
    pub(super) mesh_vertices: usize,
    /// The vertices, texture coordinates and normals of the file, by those before some were left out.
    pub(super) vertices: Numbers,
    pub(super) texture: Numbers,
    pub(super) normals: Numbers,
    /// `None` where there is nothing to record.
    pub(super) record: Option<Record>,
    /// What is said of vertices, for their copies.
    pub(super) said: Said,
    /// For each vertex that the document has not, and each copy, the vertex of the document that
    /// it was split from, if it was.
    origins: Vec<Option<usize>>,
    of_document: usize,
}

/// The indices of a file, from 0, by those before some were left out.
#[derive(Debug)]
pub(super) struct Numbers {
    /// `None` if nothing is left out. [`Numbers::LEFT_OUT`] for what is.
    map: Option<Vec<u32>>,
    count: usize,
}

impl Numbers {
    const LEFT_OUT: u32 = u32::MAX;

    fn all(count: usize) -> Numbers {
        Numbers { map: None, count }
    }

    fn without(left_out: impl Iterator<Item = bool>) -> Numbers {
        let mut count = 0;
        let map = left_out.map(|left_out| {
            if left_out {
                return Numbers::LEFT_OUT;
            }
            count += 1;
            count - 1
        });
        let map = Some(map.collect());
        let count = count as usize;
        Numbers { map, count }
    }

    /// How many there are in the file.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The index in the file.
    #[inline]
    pub(super) fn of(&self, index: u32) -> u32 {
        self.map.as_ref().map_or(index, |map| map[index as usize])
    }

    pub(super) fn has(&self, index: usize) -> bool {
        let map = self.map.as_ref();
        map.is_none_or(|map| map[index] != Numbers::LEFT_OUT)
    }
}

impl<'m> Prepared<'m> {
    /// Linear, but for what is torn.
    pub(crate) fn new(
        torn: &TornDocument<'_>,
        mesh: &'m Mesh,
        removal: Option<&'m Removal>,
    ) -> Prepared<'m> {
        let slots = torn.slots();
        let rank = (!torn.is_undivided()).then(|| ranks(&slots));
        let separated = Separated::new(mesh, rank.as_deref());
        Prepared::of(torn, mesh, slots, separated, removal)
    }

    /// The same, with one vertex for each of the mesh.
    pub(crate) fn unseparated(torn: &TornDocument<'_>, mesh: &'m Mesh) -> Prepared<'m> {
        Prepared::of(torn, mesh, torn.slots(), Separated::none(mesh), None)
    }

    fn of(
        torn: &TornDocument<'_>,
        mesh: &'m Mesh,
        slots: Slots,
        separated: Separated<'m>,
        removal: Option<&'m Removal>,
    ) -> Prepared<'m> {
        let mesh_vertices = mesh.vertex_count();
        let count = mesh_vertices + separated.copies.len();
        let document = torn.document();
        let texture = document.texture.len() + torn.new_texture().map_or(0, |rows| rows.len());
        let normals = document.normals.len() + torn.new_normals().len();
        let of_document = document.positions.len();
        let origin = |v: VertexId| match v.index() {
            known if known < of_document => Some(known),
            _ => Some(mesh.root(v).index()).filter(|&root| root < of_document),
        };
        let added = mesh.vertices().skip(of_document);
        let origins = added.chain(separated.copies.iter().copied()).map(origin);
        let origins: Vec<Option<usize>> = origins.collect();
        let mut copied: Vec<usize> = origins.iter().flatten().copied().collect();
        copied.sort_unstable();
        copied.dedup();
        let said = Said::in_document(document, &copied);
        let mut prepared = match removal {
            None => Prepared {
                slots,
                removal,
                mesh_vertices,
                vertices: Numbers::all(count),
                texture: Numbers::all(texture),
                normals: Numbers::all(normals),
                separated,
                record: None,
                said,
                origins,
                of_document,
            },
            Some(removed) => {
                let copies = separated.copies.iter().map(|v| v.index());
                let vertices = (0..mesh_vertices).chain(copies);
                Prepared {
                    slots: removed.slots(&slots),
                    removal,
                    mesh_vertices,
                    vertices: Numbers::without(vertices.map(|v| removed.vertices[v])),
                    texture: Numbers::without(removed.texture.iter().copied()),
                    normals: Numbers::without(removed.normals.iter().copied()),
                    separated,
                    record: None,
                    said,
                    origins,
                    of_document,
                }
            }
        };
        let record = prepared.record_of(torn);
        let says_nothing = record.is_empty() && prepared.fans().next().is_none();
        prepared.record = (!says_nothing).then_some(record);
        prepared
    }

    /// The vertex of the document that a new vertex, or a copy, was split from.
    pub(super) fn origin(&self, index: usize) -> Option<usize> {
        let first = self.of_document.min(self.mesh_vertices);
        self.origins[index - first]
    }

    pub(super) fn removes_nothing(&self) -> bool {
        self.removal.is_none()
    }

    pub(super) fn face_count(&self) -> usize {
        self.slots.faces.len()
    }

    /// The half-edges whose corners those of a face of the file are.
    #[inline]
    pub(super) fn half_edges(&self, face: u32) -> [u32; 3] {
        match self.removal.and_then(|removal| removal.restored(face)) {
            Some(corners) => corners,
            None => [3 * face, 3 * face + 1, 3 * face + 2],
        }
    }

    /// The copies that are written for fans, and the vertex that each is, as in the file.
    pub(super) fn fans(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let copies = self.separated.copies.iter().enumerate();
        let number = |v: usize| self.vertices.of(v as u32);
        copies
            .filter(|&(i, _)| self.vertices.has(self.mesh_vertices + i))
            .map(move |(i, of)| [number(self.mesh_vertices + i), number(of.index())])
    }

    fn record_of(&self, torn: &TornDocument<'_>) -> Record {
        let roots = torn.roots_of_classes();
        let number = |v: u32| self.vertices.of(v);
        let root = |class: u32| number(roots[class as usize]);
        let splits = torn.split_off_vertices().into_iter();
        let splits = splits.map(|split| SplitOff {
            vertex: number(split.vertex),
            from: number(split.from),
            ..split
        });
        let stays = |inserted: &&Inserted| {
            let vertex = roots[inserted.vertex as usize];
            self.vertices.has(vertex as usize)
        };
        let inserted = torn.inserted().iter().filter(stays);
        let mut inserted: Vec<Inserted> = inserted
            .map(|inserted| Inserted {
                vertex: root(inserted.vertex),
                cut: inserted.cut,
                at: inserted.at.map(root),
            })
            .collect();
        inserted.sort_unstable_by_key(|inserted| inserted.vertex);
        let is_restored = |parent: &Parent| {
            let restored = |removal: &Removal| removal.restores(parent.first);
            self.removal.is_some_and(restored)
        };
        let parents = torn.parents().into_iter().filter(|one| !is_restored(one));
        let parents = parents.map(|parent| {
            let faces = parent.first as usize..parent.end as usize;
            let faces = self.slots.of(faces);
            Parent {
                first: faces.start as u32,
                end: faces.end as u32,
                corners: parent.corners.map(root),
            }
        });
        let (texture_before, normals_before) = torn.counts_before();
        Record {
            splits: splits.collect(),
            inserted,
            parents: parents.collect(),
            texture_before,
            normals_before,
        }
    }

    /// The vertex of the mesh of which a vertex of the mesh or a copy is written.
    pub(super) fn vertex(&self, index: usize) -> usize {
        match index.checked_sub(self.mesh_vertices) {
            None => index,
            Some(copy) => self.separated.copies[copy].index(),
        }
    }
}

/// Where each face stands in the file.
fn ranks(slots: &Slots) -> Vec<u32> {
    let mut ranks = vec![0; slots.faces.len()];
    for (rank, &face) in slots.faces.iter().enumerate() {
        ranks[face as usize] = rank as u32;
    }
    ranks
}

//! What is written of a torn document: which faces in which order, under which numbers, and
//! what goes on record.

use std::collections::BTreeSet;

use tearmesh::{Mesh, Point};

use super::separate::Separated;
use crate::families::{Families, Family};
use crate::order::Order;
use crate::record::{Apart, Inserted, Parent, Record, runs};
use crate::sections::Of;
use crate::torn::{Removal, Slots, TornDocument, Turns};

/// What is written, worked out before the first byte.
#[derive(Debug)]
pub(crate) struct Prepared<'m> {
    pub(super) slots: Slots,
    pub(super) separated: Separated<'m>,
    removal: Option<&'m Removal>,
    /// The number of vertices of the mesh.
    mesh_vertices: usize,
    /// The vertices of the mesh that are written apart from where they are, ascending.
    apart: Vec<Apart>,
    /// The vertices of the mesh and behind them the copies for fans; texture coordinates; normals.
    pub(super) orders: [Order; 3],
    /// `None` where there is nothing to record.
    pub(super) record: Option<Record>,
}

impl<'m> Prepared<'m> {
    /// Linear, but for what is torn.
    pub(crate) fn new(
        torn: &TornDocument<'_>,
        mesh: &'m Mesh,
        removal: Option<&'m Removal>,
        apart: Vec<Apart>,
    ) -> Prepared<'m> {
        let slots = torn.slots();
        let rank = (!torn.is_undivided()).then(|| ranks(&slots));
        let separated = Separated::new(mesh, rank.as_deref());
        if torn.is_untouched() && separated.copies.is_empty() && removal.is_none() {
            return Prepared::in_turn(torn, mesh, (slots, separated), (removal, apart), None);
        }
        let turns = Turns::in_sections(torn);
        let added = (removal, apart);
        Prepared::in_turn(torn, mesh, (slots, separated), added, Some(&turns))
    }

    /// What is written with one vertex for each of the mesh, in the order of their ids.
    pub(crate) fn unseparated(torn: &TornDocument<'_>, mesh: &'m Mesh) -> Prepared<'m> {
        let turns = Turns::by_id(torn);
        let separated = Separated::none(mesh);
        let faces = (torn.slots(), separated);
        Prepared::in_turn(torn, mesh, faces, (None, Vec::new()), Some(&turns))
    }

    /// What is written in these turns; without any, the statements of the document.
    fn in_turn(
        torn: &TornDocument<'_>,
        mesh: &'m Mesh,
        (slots, separated): (Slots, Separated<'m>),
        (removal, apart): (Option<&'m Removal>, Vec<Apart>),
        turns: Option<&Turns<'_>>,
    ) -> Prepared<'m> {
        let document = torn.document();
        let mut prepared = Prepared {
            slots: match removal {
                None => slots,
                Some(removed) => removed.slots(&slots),
            },
            removal,
            mesh_vertices: mesh.vertex_count(),
            apart,
            orders: match turns {
                None => [Of::Vertices, Of::Texture, Of::Normals]
                    .map(|of| Order::of_document(of.count(document))),
                Some(turns) => orders(torn, turns, &separated, removal),
            },
            separated,
            record: None,
        };
        let record = prepared.record_of(torn);
        let says_nothing = record.is_empty() && prepared.fans().next().is_none();
        prepared.record = (!says_nothing).then_some(record);
        prepared
    }

    /// How many statements about a vertex are not repeated for its copies, or have new vertices before
    /// them.
    pub(super) fn unspoken(&self, torn: &TornDocument<'_>) -> usize {
        let added = self.orders[0].added().iter();
        let origins = added.filter_map(|added| torn.origin(self.vertex(added.element)));
        let copied: BTreeSet<usize> = origins.collect();
        if self.orders[0].added().is_empty() {
            return 0;
        }
        let about = torn.document().statements_about_vertices().into_iter();
        about
            .filter(|(vertex, is_behind)| !is_behind || copied.contains(vertex))
            .count()
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

    /// The copies that are written for fans, and the vertex that each is, as in the file; ascending.
    pub(super) fn fans(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let added = self.orders[0].added().iter();
        let copies = added.filter(|added| added.element as usize >= self.mesh_vertices);
        let number = |v: usize| self.orders[0].number(v as u32);
        copies.map(move |copy| [copy.element as usize, self.vertex(copy.element)].map(number))
    }

    fn record_of(&self, torn: &TornDocument<'_>) -> Record {
        let number = |v: u32| self.orders[0].number(v);
        let roots = torn.roots_of_classes(number);
        let root = |class: u32| number(roots[class as usize]);
        let stays = |inserted: &&Inserted| {
            let vertex = roots[inserted.vertex as usize];
            self.orders[0].has(vertex)
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
        let restored = self.removal.map(|removal| &removal.parents);
        let is_restored = |number: usize| restored.is_some_and(|restored| restored[number]);
        let parents = torn.parents().into_iter().enumerate();
        let parents = parents.filter(|&(number, _)| !is_restored(number));
        let parents = parents.map(|(_, parent)| parent);
        let parents = parents.map(|parent| {
            let faces = parent.first as usize..parent.end as usize;
            let faces = self.slots.of(faces);
            Parent {
                first: faces.start as u32,
                end: faces.end as u32,
                corners: parent.corners.map(root),
            }
        });
        let slides = torn.slides().filtered(
            |slide, vertex| {
                let is_back = self.removal.is_some_and(|removal| removal.is_back[slide]);
                (!is_back && self.orders[0].has(vertex)).then(|| number(vertex))
            },
            |which, index| self.orders[1 + which].number(index),
        );
        let [texture, normals] = [0, 1].map(|which| {
            let order = &self.orders[1 + which];
            let all = 0..torn.counts()[which];
            let inserted = all.filter(|&index| torn.is_index_inserted(which, index));
            let numbers = inserted.filter(|&index| order.has(index as u32));
            let mut numbers: Vec<u32> = numbers.map(|index| order.number(index as u32)).collect();
            numbers.sort_unstable();
            runs(numbers.into_iter())
        });
        Record {
            splits: torn.split_off(number),
            inserted,
            parents: parents.collect(),
            families: self.families_of(torn, root),
            texture,
            normals,
            slides,
            apart: self.recorded_apart(),
            copies: Vec::new(), // They are those of the fans.
        }
    }

    /// The parts that were divided again and stay so, as in the file.
    fn families_of(&self, torn: &TornDocument<'_>, root: impl Fn(u32) -> u32) -> Families {
        let all = torn.families();
        let mut faces = vec![Vec::new(); all.all().len()];
        for (number, &face) in self.slots.faces.iter().enumerate() {
            let family = match self.removal {
                Some(removal) => removal.family(all, face),
                None => all.of(face as usize),
            };
            family
                .into_iter()
                .for_each(|family| faces[family as usize].push(number));
        }
        let restored = self.removal.map(|removal| &removal.families);
        let mut families = Families::default();
        let mut numbers = Vec::new();
        for (number, family) in all.all().iter().enumerate() {
            numbers.push(families.all().len() as u32);
            if !restored.is_some_and(|restored| restored[number]) {
                families.add(Family {
                    corners: family.corners.map(&root),
                    above: family.above.map(|above| numbers[above as usize]),
                });
                faces[number].iter().for_each(|&face| families.give(face));
            }
        }
        families
    }

    /// The vertices that are written apart, as in the file. Those that are put back are not.
    fn recorded_apart(&self) -> Vec<Apart> {
        let is_written = |apart: &&Apart| {
            self.orders[0].has(apart.vertex) && self.put_back(apart.vertex as usize).is_none()
        };
        let written = self.apart.iter().filter(is_written);
        let mut written: Vec<Apart> = written
            .map(|apart| Apart {
                vertex: self.orders[0].number(apart.vertex),
                ..*apart
            })
            .collect();
        written.sort_unstable_by_key(|apart| apart.vertex);
        written
    }

    /// Where the `v` of a vertex of the mesh says that it is, if it stands apart from there.
    pub(super) fn shown(&self, vertex: usize) -> Option<Point> {
        let place = self
            .apart
            .binary_search_by_key(&(vertex as u32), |apart| apart.vertex);
        place.ok().map(|place| self.apart[place].shown)
    }

    /// What the `v` of a vertex of the mesh has that slid, where it is put back.
    pub(super) fn put_back(&self, vertex: usize) -> Option<&[f64]> {
        self.removal?.put_back(vertex as u32)
    }

    /// The texture coordinate and the normal of a corner, which has those.
    #[inline]
    pub(super) fn corner(&self, half_edge: u32, indices: [Option<u32>; 2]) -> [Option<u32>; 2] {
        match self.removal {
            None => indices,
            Some(removal) => {
                let element = self.separated.indices[half_edge as usize];
                removal.indices_before(self.vertex(element) as u32, indices)
            }
        }
    }

    /// The vertex of the mesh that is written as a vertex of the mesh or a copy.
    pub(super) fn vertex(&self, element: u32) -> usize {
        match (element as usize).checked_sub(self.mesh_vertices) {
            None => element as usize,
            Some(copy) => self.separated.copies[copy].index(),
        }
    }
}

/// The orders of vertices, texture coordinates and normals, without what is removed.
fn orders(
    torn: &TornDocument<'_>,
    turns: &Turns<'_>,
    separated: &Separated<'_>,
    removal: Option<&Removal>,
) -> [Order; 3] {
    let document = torn.document();
    let is_removed = |all: fn(&Removal) -> &[bool], index: usize| {
        removal.is_some_and(|removal| all(removal)[index])
    };
    let mesh_vertices = torn.vertex_count();
    let vertices = (0..mesh_vertices).map(|v| (v, turns.vertex(v)));
    let copies = separated.copies.iter();
    let copies = copies.map(|v| (v.index(), turns.copy(v.index())));
    let vertices = vertices.chain(copies);
    let vertices =
        vertices.map(|(v, turn)| (!is_removed(|removal| &removal.vertices, v)).then_some(turn));
    let [textures, normals] = torn.counts();
    let texture = (0..textures).map(|index| {
        let stays = !is_removed(|removal| &removal.texture, index);
        stays.then(|| turns.texture(index))
    });
    let normal = (0..normals).map(|index| {
        let stays = !is_removed(|removal| &removal.normals, index);
        stays.then(|| turns.normal(index))
    });
    [
        Order::new(
            document.positions.len(),
            mesh_vertices + separated.copies.len(),
            vertices,
        ),
        Order::new(document.texture.len(), textures, texture),
        Order::new(document.normals.len(), normals, normal),
    ]
}

/// Where each face stands in the file.
fn ranks(slots: &Slots) -> Vec<u32> {
    let mut ranks = vec![0; slots.faces.len()];
    for (rank, &face) in slots.faces.iter().enumerate() {
        ranks[face as usize] = rank as u32;
    }
    ranks
}

//! What is written of a torn document: which faces in which order, under which numbers, and
//! what goes on record.

use std::collections::BTreeSet;

use tearmesh::{Mesh, Point};

use super::separate::Separated;
use crate::order::{Added, Order};
use crate::record::{Apart, Inserted, Record, is_in, runs};
use crate::torn::{Slots, TornDocument};

/// What is written, worked out before the first byte.
#[derive(Debug)]
pub(crate) struct Prepared<'m> {
    pub(super) slots: Slots,
    pub(super) separated: Separated<'m>,
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
    /// What is written with a vertex for each fan, in sections; or with one vertex for each of the mesh, in
    /// the order of their ids. Linear, but for what is torn.
    pub(crate) fn new(
        torn: &TornDocument<'_>,
        mesh: &'m Mesh,
        apart: Vec<Apart>,
        is_separated: bool,
    ) -> Prepared<'m> {
        let slots = torn.corners.slots();
        let separated = match is_separated {
            true => {
                let ranks = slots.ranks();
                Separated::new(mesh, |face| ranks[face.index()])
            }
            false => Separated::none(mesh),
        };
        let mut prepared = Prepared {
            slots,
            mesh_vertices: mesh.vertex_count(),
            apart,
            orders: torn.orders(&separated.copies, !is_separated),
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
        let added = self.orders[0].added();
        if added.is_empty() {
            return 0;
        }
        let origin = |added: &Added| torn.origin(self.vertex(added.element));
        let copied: BTreeSet<usize> = added.iter().filter_map(origin).collect();
        let about = torn.document().statements_about_vertices().into_iter();
        about
            .filter(|(vertex, is_behind)| !is_behind || copied.contains(vertex))
            .count()
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
        let inserted = torn.inserted.iter();
        let mut inserted: Vec<Inserted> = inserted.map(|one| one.renumbered(root)).collect();
        inserted.sort_unstable_by_key(|inserted| inserted.vertex);
        let faces = self.slots.faces.iter();
        let of_faces = faces.map(|&face| torn.families.of(face as usize));
        let mut families = torn.families.of_faces(of_faces, |_| true);
        families.renumber(root);
        drop(roots); // What was split off takes as much memory again.
        let mut apart = self.apart.clone();
        for apart in &mut apart {
            apart.vertex = number(apart.vertex);
        }
        apart.sort_unstable_by_key(|apart| apart.vertex);
        let document = torn.document();
        let new_indices = [0, 1].map(|which| {
            let order = &self.orders[1 + which];
            let all = 0..torn.corners.counts()[which];
            let known = document.counts()[1 + which];
            let of_file = document.record.as_deref();
            let of_file = of_file.map(|record| &record.new_indices[which]);
            let is_of_file = |index| of_file.is_some_and(|runs| is_in(runs, index as u32));
            let inserted = all.filter(|&index| index >= known || is_of_file(index));
            let numbers = inserted.map(|index| order.number(index as u32));
            let mut numbers: Vec<u32> = numbers.collect();
            numbers.sort_unstable();
            runs(numbers.into_iter())
        });
        let mut slides = torn.slides();
        for slid in &mut slides {
            slid.vertex = number(slid.vertex);
            slid.renumber_indices(|which, index| self.orders[1 + which].number(index));
        }
        Record {
            splits: torn.split_off(number),
            inserted,
            families,
            new_indices,
            slides,
            apart,
            copies: Vec::new(), // They are those of the fans.
        }
    }

    /// Where the `v` of a vertex of the mesh says that it is, if it stands apart from there.
    pub(super) fn shown(&self, vertex: usize) -> Option<Point> {
        let place = self
            .apart
            .binary_search_by_key(&(vertex as u32), |apart| apart.vertex);
        place.ok().map(|place| self.apart[place].shown)
    }

    /// The vertex of the mesh that is written as a vertex of the mesh or a copy.
    pub(super) fn vertex(&self, element: u32) -> usize {
        match (element as usize).checked_sub(self.mesh_vertices) {
            None => element as usize,
            Some(copy) => self.separated.copies[copy].index(),
        }
    }
}

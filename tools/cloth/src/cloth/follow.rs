//! A cloth follows the log: splits, insertions and merges change particles, constraints, triangles
//! and the bound of frequencies where they are, and nowhere else.

use tearmesh::geometry::{Vector, between};
use tearmesh::{
    Blend, ChildFace, Cursor, Edit, Follower, HalfEdgeId, Insert, Merge, Mix, Slide, Split,
    VertexId, VertexOp,
};

use crate::cloth::fabric::{BendRemoval, Stretch};
use crate::cloth::{Cloth, NO_BEND, Piece, weight};
use crate::system::System;
use crate::system::constraint::Constraint;

impl Follower for Cloth {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Split(split) => self.split(split, edit),
            Edit::Insert(insert) => self.insert(insert, edit),
            Edit::Merge(merge) => self.merge(merge, edit),
            Edit::Slide(slide) => self.slide(slide, edit),
            _ => unreachable!("there is no other edit"),
        }
    }
}

impl Cloth {
    fn split(&mut self, split: &Split<'_>, edit: &Edit<'_>) {
        let (old, new) = (split.old.index(), split.new.index());
        self.pass_on(edit);
        self.reweigh(old);
        self.reweigh(new);
        for link in split.torn {
            let id = self.stretch(link.stayed);
            let stretch = &mut self.system.model.stretch;
            if self.fabric.halves_copies() {
                stretch.stiffen(id, 0.5 * stretch.get(id).stiffness_n_per_m);
            }
            let mut copy = stretch.get(id);
            copy.ends = copy.ends.map(|end| if end == old { new } else { end });
            let copied = stretch.add_with(copy, stretch.multiplier(id));
            self.stretch_of.join([link.stayed; 2], id);
            self.stretch_of.join([link.moved; 2], copied);
            let lengths = [link.stayed, link.moved].map(|h| self.side_length(h));
            if lengths[0] != lengths[1] {
                let stretch = &mut self.system.model.stretch;
                stretch.set_rest_length(id, lengths[0]);
                stretch.set_rest_length(copied, lengths[1]);
            }
            self.measure(id);
            self.measure(copied);
            self.unbend(link.stayed);
        }
        for &corner in split.corners {
            for h in [corner, corner.prev()] {
                let id = self.stretch(h);
                self.system.model.stretch.repoint(id, old, new);
            }
            let id = self.bend_of.get(corner.next());
            if id != NO_BEND {
                self.system.model.bend.repoint(id, old, new);
            }
        }
        if self.fabric.bend_removal == BendRemoval::Vertex {
            for particle in [old, new] {
                self.scratch.ids.clear();
                self.scratch.ids.extend(self.system.model.bend.of(particle));
                for i in 0..self.scratch.ids.len() {
                    self.unbend(self.bend_of.edges[self.scratch.ids[i].index()][0]);
                }
            }
        }
        self.relabel_triangles(split.corners, new);
        self.system.edited();
    }

    fn merge(&mut self, merge: &Merge<'_>, edit: &Edit<'_>) {
        let (kept, gone) = (merge.kept.index(), merge.gone.index());
        self.relabel_triangles(merge.corners, kept);
        for link in merge.sewn {
            let (id, copied) = (self.stretch(link.stayed), self.stretch(link.moved));
            let stretch = &mut self.system.model.stretch;
            let removed = stretch.remove(copied);
            if matches!(self.fabric.stretch, Stretch::Edges { .. }) {
                let sum = stretch.get(id).stiffness_n_per_m + removed.stiffness_n_per_m;
                let is_halved = self.fabric.halves_copies();
                stretch.set_stiffness(id, if is_halved { sum } else { 0.5 * sum });
            }
            self.stretch_of.join([link.stayed, link.moved], id);
        }
        let model = &mut self.system.model;
        for family in [&mut model.stretch, &mut model.bend] {
            self.scratch.ids.clear();
            self.scratch.ids.extend(family.of(gone));
            for &id in &self.scratch.ids {
                family.repoint(id, gone, kept);
            }
        }
        join_particles(&mut self.system, kept, gone, merge.share);
        self.pass_on(edit);
        self.reweigh(kept);
        // Across a seam: between particles that are neither of the two.
        for link in merge.sewn {
            self.bend_across([link.stayed, link.moved]);
        }
        for link in merge.sewn {
            self.measure(self.stretch(link.stayed));
        }
    }

    fn slide(&mut self, slide: &Slide<'_>, edit: &Edit<'_>) {
        let (particle, toward) = (slide.vertex.index(), slide.toward.index());
        let x = &mut self.system.positions;
        x[particle] = between(x[particle], x[toward], slide.t);
        self.system.guard.changed.mark(particle);
        self.pass_on(edit);
        self.measure_again(particle);
    }

    /// Takes new rest lengths and triangles for a particle whose place at rest has changed. A membrane is
    /// measured anew; other stretch constraints keep k L, as the parts of a divided edge do.
    fn measure_again(&mut self, particle: usize) {
        let mut ids = std::mem::take(&mut self.scratch.ids);
        ids.clear();
        ids.extend(self.system.model.stretch.of(particle));
        for &id in &ids {
            let before = self.system.model.stretch.get(id);
            let shortest = before.rest_length_m * f64::EPSILON;
            let edge = self.stretch_of.edges[id.index()];
            let rest_length_m = self.rest_length(edge).max(shortest);
            let stretch = &mut self.system.model.stretch;
            if rest_length_m != before.rest_length_m {
                let k = before.stiffness_n_per_m * (before.rest_length_m / rest_length_m);
                stretch.set_stiffness(id, k);
                stretch.set_rest_length(id, rest_length_m);
            }
        }
        // The edges of all faces there, those across from it too.
        for id in ids.iter().map(|id| id.index()) {
            let around = self.stretch_of.edges[id].map(|h| [h, h.next(), h.prev()]);
            for &h in around.as_flattened() {
                self.measure(self.stretch(h));
                self.measure_bend(h);
            }
        }
        self.scratch.ids = ids;
        self.weave_again(particle);
        self.system.edited();
    }

    fn insert(&mut self, insert: &Insert<'_>, edit: &Edit<'_>) {
        let mut room = std::mem::take(&mut self.scratch);
        room.pieces.clear();
        for child in insert.children {
            let pieces = (0..3).map(|corner| self.piece(child, corner));
            room.pieces.extend(pieces);
        }
        room.pieces
            .sort_unstable_by_key(|piece| (piece.ends, piece.half_edge));
        self.pass_on(edit);
        for v in insert.children.iter().flat_map(|child| child.vertices) {
            self.reweigh(v.index());
        }
        for child in insert.children {
            for h in child.face.half_edges() {
                if let Some(bend) = self.bend_of.ids.get_mut(h.index()) {
                    *bend = NO_BEND;
                }
            }
        }
        // First what goes, then what comes: an id may be given again.
        let model = &mut self.system.model;
        let families = [&mut model.stretch, &mut model.bend].into_iter();
        for (i, family) in families.enumerate() {
            let divided = room.pieces.iter().filter(|piece| piece.divided);
            let ids = divided.map(|piece| piece.ids[i]);
            room.ids.clear();
            room.ids.extend(ids.filter(|id| *id != NO_BEND));
            room.ids.sort_unstable();
            room.ids.dedup();
            for &id in &room.ids {
                family.remove(id);
            }
        }
        for edge in room.pieces.chunk_by(|one, other| one.ends == other.ends) {
            if edge[0].is_kept {
                self.keep(edge);
            } else {
                self.put(edge);
            }
        }
        for child in insert.children {
            for h in child.face.half_edges() {
                self.measure(self.stretch(h));
            }
            self.weave_face(child.face);
        }
        self.system.edited();
        self.scratch = room;
    }

    /// Has particles come for new vertices, and masses, places at rest and the corners of faces follow.
    fn pass_on(&mut self, edit: &Edit<'_>) {
        for op in edit.vertex_ops() {
            if let VertexOp::Push { new, from } = op {
                let count = self.system.positions.len();
                assert_eq!(new.index(), count, "a cloth is in step with its mesh");
                push_particle(&mut self.system, from);
            }
        }
        edit.pass_on(&mut self.masses);
        edit.pass_on(&mut self.rest);
        edit.apply_to_indices(&mut self.system.model.faces);
    }

    /// An edge that was there stays; what is across it may be another vertex.
    fn keep(&mut self, edge: &[Piece]) {
        let [id, bend] = edge[0].ids;
        let renamed = self.stretch_of.edges[id.index()].map(|h| {
            let mut pieces = edge.iter();
            let piece = pieces.find(|piece| piece.half_edge_before == h);
            piece.map_or(h, |piece| piece.half_edge)
        });
        self.stretch_of.join(renamed, id);
        if bend != NO_BEND {
            for piece in edge.iter().filter(|piece| piece.apex_before != piece.apex) {
                let bends = &mut self.system.model.bend;
                bends.repoint(bend, piece.apex_before, piece.apex);
            }
            self.bend_of.join(renamed, bend);
            self.measure_bend(edge[0].half_edge);
        }
    }

    /// A part of a divided edge, or a new edge inside a face.
    fn put(&mut self, edge: &[Piece]) {
        let piece = &edge[0];
        // A part that rounding left no length for has next to none.
        let shortest = piece.length * f64::EPSILON;
        let sides = [edge[0].half_edge, edge[edge.len() - 1].half_edge];
        let rest_length_m = self.rest_length(sides).max(shortest);
        let constraint = Constraint {
            ends: piece.ends,
            rest_length_m,
            stiffness_n_per_m: piece.stiffness_by_length / rest_length_m,
        };
        let id = self.system.model.stretch.add(constraint);
        self.stretch_of.join(sides, id);
        if sides[0] != sides[1] {
            self.bend_across(sides);
        }
    }

    /// Takes away the bend constraint across an edge.
    fn unbend(&mut self, h: HalfEdgeId) {
        let id = self.bend_of.get(h);
        if id != NO_BEND {
            for h in self.bend_of.edges[id.index()] {
                self.bend_of.ids[h.index()] = NO_BEND;
            }
            self.system.model.bend.remove(id);
        }
    }

    /// The edge of a child that starts at this corner.
    fn piece(&self, child: &ChildFace, corner: usize) -> Piece {
        let [a, b, apex] = [0, 1, 2].map(|i| child.vertices[(corner + i) % 3].index());
        let sources = [corner, (corner + 1) % 3].map(|i| &child.sources[i]);
        let parent = child.parent.half_edges();
        let is_on = |&h: &HalfEdgeId| sources.into_iter().all(|source| lies_on(source, h));
        let on = parent.into_iter().find(is_on);
        let is_corner = |source: &Mix<HalfEdgeId>| matches!(source, Mix::Copy(_));
        let by_length = |h: HalfEdgeId| {
            let constraint = self.system.model.stretch.get(self.stretch(h));
            constraint.stiffness_n_per_m * constraint.rest_length_m
        };
        let h = on.unwrap_or(parent[0]);
        let stiffness_by_length = match on {
            Some(h) => by_length(h),
            None => parent.map(by_length).iter().sum::<f64>() / 3.0,
        };
        let is_kept = on.is_some() && sources.into_iter().all(is_corner);
        Piece {
            ends: [a.min(b), a.max(b)],
            half_edge: child.face.half_edges()[corner],
            half_edge_before: h,
            apex,
            apex_before: self.system.model.faces[h.prev().index()] as usize,
            is_kept,
            divided: on.is_some() && !is_kept,
            ids: [self.stretch(h), on.map_or(NO_BEND, |h| self.bend_of.get(h))],
            stiffness_by_length,
            length: self.system.model.stretch.get(self.stretch(h)).rest_length_m,
        }
    }

    /// Takes over the mass of a vertex, which has a face.
    fn reweigh(&mut self, particle: usize) {
        let mass = weight(&self.masses, VertexId::new(particle).expect("I1: ids fit"));
        self.system.model.masses[particle] = mass;
        self.system.weigh(particle);
    }
}

/// Whether a corner of a child lies on this edge of its parent.
pub(crate) fn lies_on(source: &Mix<HalfEdgeId>, h: HalfEdgeId) -> bool {
    match *source {
        Mix::Copy(corner) => corner == h || corner == h.next(),
        Mix::Between { ends, .. } => ends.contains(&h) && ends.contains(&h.next()),
        Mix::Weighted { .. } => false,
        _ => unreachable!("there is no other mix"),
    }
}

/// Appends a particle that is where others are, or between them, and as fast; a copy is also held and
/// led like the one that it is of.
fn push_particle(system: &mut System, from: Mix<VertexId>) {
    let new = system.positions.len() as u32;
    let x = Blend::blend(from.map(|v| &system.positions[v.index()]));
    let v = Blend::blend(from.map(|v| &system.velocities[v.index()]));
    let like = match from {
        Mix::Copy(v) => Some(v.index()),
        Mix::Between { .. } | Mix::Weighted { .. } => None,
        _ => unreachable!("there is no other mix"),
    };
    let unlimited = &mut system.scratch.unlimited;
    if unlimited.len() == system.positions.len() {
        unlimited.push(Blend::blend(from.map(|v| &unlimited[v.index()])));
    }
    let scratch = &mut system.scratch;
    for known in [&mut scratch.accelerations, &mut scratch.forces] {
        if known.len() == system.positions.len() {
            known.push(Blend::blend(from.map(|v| &known[v.index()])));
        }
    }
    system.positions.push(x);
    system.velocities.push(v);
    let model = &mut system.model;
    model.push_particle(0.0, like.is_some_and(|particle| model.held[particle]));
    let mut led = model.grabbed.iter();
    let path = led.find(|(particle, _)| Some(*particle as usize) == like);
    if let Some((_, path)) = path.cloned() {
        model.grabbed.push((new, path));
    }
}

/// Makes two particles one, where the held one is if only one is held; `gone` has no
/// constraints any more, and the last particle takes its index.
fn join_particles(system: &mut System, kept: usize, gone: usize, share: f64) {
    let model = &mut system.model;
    let (x, v) = (&mut system.positions, &mut system.velocities);
    x[kept] = match (model.held[kept], model.held[gone]) {
        (true, false) => x[kept],
        (false, true) => x[gone],
        _ => between(x[kept], x[gone], 1.0 - share),
    };
    model.held[kept] |= model.held[gone];
    let (mass, more) = (model.masses[kept], model.masses[gone]);
    let is_held = model.held[kept];
    let joined = |one: Vector, other: Vector| match is_held {
        true => Vector::zeros(),
        false if one == other => one,
        false => (one * mass + other * more) / (mass + more),
    };
    v[kept] = joined(v[kept], v[gone]);
    let scratch = &mut system.scratch;
    if scratch.unlimited.len() == x.len() {
        scratch.unlimited.swap_remove(gone);
    }
    for known in [&mut scratch.accelerations, &mut scratch.forces] {
        if known.len() == x.len() {
            known[kept] = joined(known[kept], known[gone]);
            known.swap_remove(gone);
        }
    }
    x.swap_remove(gone);
    v.swap_remove(gone);
    model.swap_remove_particle(gone);
    let mut led = system.model.grabbed.iter();
    if led.any(|(led, _)| *led as usize == kept) {
        system.model.unlead(gone);
    }
    let last = system.positions.len() as u32;
    for (particle, _) in &mut system.model.grabbed {
        if *particle as usize == gone {
            *particle = kept as u32;
        } else if *particle == last {
            *particle = gone as u32;
        }
    }
}

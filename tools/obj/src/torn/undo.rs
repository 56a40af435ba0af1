//! Which inserted vertices go, which divided faces are restored, and which slides are undone.
//!
//! What goes of the insertions is the kernel's [`RemovalPlan`], of the parents and places on record. Slides
//! are undone with them, as if in reverse order of the cuts:
//!
//! * An inserted vertex goes only if it is as it was inserted (`edited.rs`), and if the ends that it was
//!   put between are where they were then: a later slide of one of them has to be undone too.
//! * A slide is undone if nothing that its cut or a later one tore holds the vertex apart, if the vertex
//!   is as it was left, and if everything goes that was put beside it since. What holds a
//!   slide holds all earlier ones of its vertex.
//!
//! All begins with everything going that might, and is planned anew until no more has to stay.

use std::collections::BTreeMap;

use tearmesh::{FaceId, FacePart, HalfEdgeId, Insertions, Mesh, Positions, RemovalPlan, VertexId};

use super::TornDocument;
use super::past::{CornerAt, Moment, Past, before_slides, behind_slides};
use super::slots::Slots;
use crate::record::{At, Inserted};

/// A divided face.
#[derive(Clone, Debug, Default)]
pub(super) struct Divided {
    /// The classes at its corners.
    corners: [u32; 3],
    /// The faces that it was divided into, each with the classes at its corners. Of one that was divided
    /// again it is any face of it.
    parts: Vec<(FaceId, [u32; 3])>,
    /// The faces of the mesh that cover it, in the order of the file.
    pub(super) faces: Vec<FaceId>,
}

pub(super) struct Undo<'t> {
    pub(super) past: Past<'t>,
    pub(super) plan: RemovalPlan,
    /// The divided faces that the plan counts: parts that were divided again, the last one first, and then
    /// the parents.
    pub(super) divided: Vec<Divided>,
    /// Whether each slide is undone, and whether what its cut or a later one tore there is open.
    pub(super) is_back: Vec<bool>,
    is_open: Vec<bool>,
    slides_by_class: BTreeMap<u32, Vec<usize>>,
    /// By class, whether it was inserted and may go.
    may_go: Vec<bool>,
    /// When each inserted vertex was inserted, as the list of them has them.
    moments: Vec<Moment>,
    /// How many inserted vertices stay for what was done to them since.
    pub(super) edited: usize,
}

impl<'t> Undo<'t> {
    pub(super) fn find(
        torn: &'t TornDocument<'t>,
        mesh: &Mesh,
        positions: &'t Positions,
        slots: &Slots,
    ) -> Undo<'t> {
        let classes = torn.classes();
        let class = |v: VertexId| classes[v.index()];
        let past = Past::new(torn, positions);
        let divided = divided(torn, slots, |f| mesh.face_vertices(f).map(class));
        let families = divided
            .iter()
            .map(|divided| divided.parts_for_plan(torn.inserted()));
        let insertions = Insertions::from_parts(mesh, class, families);
        let mut may_go = vec![false; torn.ancestry.class_count()];
        for inserted in torn.inserted() {
            may_go[inserted.vertex as usize] = true;
        }
        // What no honest record has: a parent between inserted vertices, and undivided faces there.
        let mut is_divided = vec![false; mesh.face_count()];
        for parent in &divided[torn.families().all().len()..] {
            parent
                .faces
                .iter()
                .for_each(|f| is_divided[f.index()] = true);
            parent
                .corners
                .iter()
                .for_each(|&class| may_go[class as usize] = false);
        }
        for f in mesh.faces().filter(|f| !is_divided[f.index()]) {
            mesh.face_vertices(f)
                .into_iter()
                .for_each(|v| may_go[class(v) as usize] = false);
        }
        let inserted = torn.inserted().iter();
        let mut undo = Undo {
            plan: insertions.plan(mesh, |_| false, |_, _| true),
            is_back: Vec::new(),
            is_open: Vec::new(),
            slides_by_class: BTreeMap::new(),
            moments: inserted.map(|one| behind_slides(one.cut)).collect(),
            past,
            divided,
            may_go,
            edited: 0,
        };
        undo.look_at_slides(&classes);
        let plan = |undo: &Undo<'_>| {
            let agree = |one, other| undo.agree(mesh, one, other);
            insertions.plan(mesh, |v| undo.may_go[class(v) as usize], agree)
        };
        undo.plan = plan(&undo);
        let divided = undo.divided.iter().enumerate();
        let restored = divided.filter(|&(number, _)| undo.plan.restored(number).is_some());
        let unlike = restored.flat_map(|(_, divided)| {
            let half_edges = divided.faces.iter().flat_map(|f| f.half_edges());
            let corners = half_edges.map(|h| (class(mesh.origin(h)), corner_at(mesh, h)));
            undo.unlike_within(divided.corners, corners.collect())
        });
        let unlike = unlike.collect();
        undo.keep_edited(unlike);
        loop {
            undo.plan = plan(&undo);
            let mut goes = vec![false; undo.may_go.len()];
            for v in mesh.vertices().filter(|&v| undo.plan.goes(v)) {
                goes[class(v) as usize] = true;
            }
            if !undo.keep_more(&mut goes) {
                return undo;
            }
        }
    }
    /// Whether two corners of a vertex have the same texture coordinate and normal, once slides are undone.
    fn agree(&self, mesh: &Mesh, one: HalfEdgeId, other: HalfEdgeId) -> bool {
        let [one, other] = [one, other].map(|h| {
            let corner = corner_at(mesh, h);
            [0, 1].map(|which| {
                self.past
                    .index_without(corner, which, |slide| self.is_back[slide])
            })
        });
        one == other
    }

    /// The classes that might go, of those at the corners of the parts of one face and not at its own,
    /// but are not as they were inserted: behind the slides of their cut, or before these.
    fn unlike_within(
        &self,
        own: [u32; 3],
        mut corners: Vec<(u32, CornerAt)>,
    ) -> Vec<(u32, [bool; 2])> {
        corners.sort_by_key(|&(class, _)| class);
        corners.dedup_by_key(|&mut (class, _)| class);
        let first = |class: u32| {
            let found = corners.binary_search_by_key(&class, |&(class, _)| class);
            found.ok().map(|at| corners[at].1)
        };
        let inserted = self.past.torn.inserted();
        let might_go = |class: u32| self.may_go[class as usize] && !own.contains(&class);
        let going = corners.iter().filter(|&&(class, _)| might_go(class));
        let unlike = going.filter_map(|&(class, corner)| {
            let Inserted { cut, at, .. } = inserted[self.place(class)?];
            let is_unlike = |moment: Moment| !self.past.is_as_inserted(corner, &at, moment, first);
            let behind = is_unlike(behind_slides(cut));
            let before = match self.past.slides.is_empty() {
                true => behind,
                false => is_unlike(before_slides(cut)),
            };
            (behind || before).then_some((class, [behind, before]))
        });
        unlike.collect()
    }

    /// The place of a class in the list of what was inserted.
    fn place(&self, class: u32) -> Option<usize> {
        let inserted = self.past.torn.inserted();
        inserted.binary_search_by_key(&class, |one| one.vertex).ok()
    }

    /// Keeps what was edited, and finds out whether the rest was inserted before its cut slid
    /// vertices or behind that.
    fn keep_edited(&mut self, mut unlike: Vec<(u32, [bool; 2])>) {
        unlike.sort_unstable();
        for of_class in unlike.chunk_by(|a, b| a.0 == b.0) {
            let class = of_class[0].0;
            let [behind, before] = [0, 1].map(|i| of_class.iter().any(|(_, unlike)| unlike[i]));
            let place = self.place(class).expect("it was inserted");
            if behind && before {
                self.may_go[class as usize] = false;
                let waits = self.slides_of_ends(place).any(|slide| self.is_open[slide]);
                self.edited += usize::from(!waits);
            } else if behind {
                self.moments[place] = before_slides(self.past.torn.inserted()[place].cut);
            }
        }
    }

    /// The slides of the ends that an inserted vertex was put between.
    fn slides_of_ends(&self, place: usize) -> impl Iterator<Item = usize> + '_ {
        let ends = self.past.torn.inserted()[place].at.roots().iter();
        let slides = ends.filter_map(|class| self.slides_by_class.get(class));
        slides.flatten().copied()
    }

    /// Finds the slides that may be undone.
    fn look_at_slides(&mut self, classes: &[u32]) {
        let past = &self.past;
        if past.slides.is_empty() {
            return;
        }
        let mut torn_by = vec![0; classes.len()];
        for split in past.torn.split_off(|v| v) {
            for end in [split.vertex, split.from] {
                let cut: &mut u32 = &mut torn_by[end as usize];
                *cut = split.cut.max(*cut);
            }
        }
        for (slide, slid) in past.slides.iter().enumerate() {
            let vertex = slid.vertex as usize;
            let is_open = torn_by[vertex] >= slid.cut;
            self.is_open.push(is_open);
            self.is_back.push(past.is_intact(slide) && !is_open);
            let of_class = self.slides_by_class.entry(classes[vertex]);
            of_class.or_default().push(slide);
        }
    }

    /// How many vertices stay only because they were edited since they slid.
    pub(super) fn slid_edited(&self) -> usize {
        let is_edited = |&slide: &usize| {
            let vertex = self.past.slides.get(slide).vertex as usize;
            let later = self.past.of(vertex).find(|&later| later > slide);
            let is_first_found = later.is_none_or(|later| self.past.is_intact(later));
            let goes = self.plan.goes(VertexId::new(vertex).expect("I1: ids fit"));
            is_first_found && !self.is_open[slide] && !goes && !self.past.is_intact(slide)
        };
        (0..self.is_back.len()).filter(is_edited).count()
    }

    /// Keeps what depends on something that stays, where `goes` says by class what goes; whether
    /// there is any.
    fn keep_more(&mut self, goes: &mut [bool]) -> bool {
        let mut more = false;
        // From the last one: its ends were inserted before it.
        for (place, inserted) in self.past.torn.inserted().iter().enumerate().rev() {
            let class = inserted.vertex as usize;
            let of_ends: Vec<usize> = self.slides_of_ends(place).collect();
            let (earlier, later): (Vec<usize>, Vec<usize>) =
                of_ends.into_iter().partition(|&slide| {
                    behind_slides(self.past.slides.get(slide).cut) <= self.moments[place]
                });
            let stays = !goes[class] || later.iter().any(|&slide| !self.is_back[slide]);
            if !stays {
                continue;
            }
            if std::mem::take(&mut goes[class]) {
                self.may_go[class] = false;
                more = true;
            }
            // Where a slide stays, all earlier ones of its vertex do for the same reason.
            for slide in earlier {
                more |= std::mem::take(&mut self.is_back[slide]);
            }
            // What stays was put between vertices that stay, or the record would name none.
            for &end in inserted.at.roots() {
                if std::mem::take(&mut goes[end as usize]) {
                    self.may_go[end as usize] = false;
                    more = true;
                }
            }
        }
        more
    }
}

/// All divided faces of a mesh with these classes at the corners of its faces.
fn divided(
    torn: &TornDocument<'_>,
    slots: &Slots,
    classes: impl Fn(FaceId) -> [u32; 3],
) -> Vec<Divided> {
    let families = torn.families();
    let again = families.all().len();
    // Parts that were divided again count backwards: each comes before what it is a part of.
    let place = |family: u32| again - 1 - family as usize;
    let mut divided = vec![Divided::default(); again];
    for (family, number) in families.all().iter().zip(0..) {
        divided[place(number)].corners = family.corners;
    }
    for parent in torn.parents() {
        let mut of_parent = Divided {
            corners: parent.corners,
            ..Divided::default()
        };
        for &f in &slots.faces[slots.of(parent.first as usize..parent.end as usize)] {
            let face = FaceId::new(f as usize).expect("I1: ids fit");
            let mut part = (face, classes(face));
            let mut family = families.of(f as usize);
            let mut is_new = true;
            while let Some(number) = family {
                let within = &mut divided[place(number)];
                let first = within.faces.is_empty();
                within.faces.push(face);
                if is_new {
                    within.parts.push(part);
                }
                is_new &= first;
                part = (face, within.corners);
                family = families.all()[number as usize].above;
            }
            of_parent.faces.push(face);
            if is_new {
                of_parent.parts.push(part);
            }
        }
        divided.push(of_parent);
    }
    divided
}

impl Divided {
    /// The parts in the terms of the kernel.
    fn parts_for_plan(&self, inserted: &[Inserted]) -> Vec<FacePart> {
        let corner = |class: u32| self.corners.iter().position(|&own| own == class);
        let classes = self.parts.iter().flat_map(|(_, classes)| classes);
        let mut on_sides: BTreeMap<u32, [bool; 3]> =
            classes.map(|&class| (class, [false; 3])).collect();
        for (i, &own) in self.corners.iter().enumerate() {
            on_sides.insert(own, [0, 1, 2].map(|side| side == i || (side + 1) % 3 == i));
        }
        // A point on an edge is on the sides that both ends are on, which were there before it.
        for class in on_sides.keys().copied().collect::<Vec<u32>>() {
            let place = inserted.binary_search_by_key(&class, |one| one.vertex);
            if let (None, Ok(place)) = (corner(class), place)
                && let At::Edge { ends, .. } = inserted[place].at
            {
                let [one, other] = ends.map(|end| on_sides.get(&end).copied().unwrap_or_default());
                on_sides.insert(class, [0, 1, 2].map(|side| one[side] && other[side]));
            }
        }
        let part = |&(face, classes): &(FaceId, [u32; 3])| FacePart {
            face,
            points: classes,
            corners: classes.map(corner),
            on_sides: classes.map(|class| on_sides[&class]),
        };
        self.parts.iter().map(part).collect()
    }
}

fn corner_at(mesh: &Mesh, h: HalfEdgeId) -> CornerAt {
    CornerAt {
        half_edge: h.index(),
        vertex: mesh.origin(h).index(),
    }
}

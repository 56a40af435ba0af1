//! What goes when a torn document is simplified, and what has to stay.
//!
//! Cuts are undone as if in reverse order, all at once: begin with everything going that might, and
//! take back what cannot go until nothing more follows.
//!
//! * An inserted vertex goes if its copies are one, if it is as it was inserted, if every face that
//!   it divided is restored, and if the ends that it was put between are where they were then: a
//!   later slide of one of them has to be undone too.
//! * A slide is undone if nothing that its cut or a later one tore holds the vertex apart, if the vertex
//!   is as it was left, and if everything goes that was put beside it since. What holds a
//!   slide holds all earlier ones of its vertex.
//! * A divided face is restored if everything within it goes, and its parts agree on its corners.

use std::collections::BTreeMap;

use tearmesh::{Mesh, Positions};

use super::TornDocument;
use super::past::{CornerAt, Moment, Past, before_slides, behind_slides};
use super::slots::Slots;
use crate::record::{Inserted, Parent};

/// A face that takes the place of those that cover it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Restored {
    pub(super) parent: Parent,
    /// Half-edges of the mesh whose corners it has.
    pub(super) corners: [u32; 3],
}

/// Which inserted vertices go, which faces are restored, and which slides are undone.
pub(super) struct Going<'t> {
    pub(super) past: Past<'t>,
    classes: Vec<u32>,
    /// How many vertices each class has.
    copies: Vec<u32>,
    /// By class: whether it was inserted and may go.
    goes: Vec<bool>,
    /// When each inserted vertex was inserted, as the list of them has them.
    moments: Vec<Moment>,
    /// What becomes of each divided face.
    candidates: Vec<Option<Restored>>,
    /// Vertices whose slides must be undone if a divided face is restored.
    corners_slid: Vec<(usize, usize)>,
    /// What each divided face has inside, by class and by face.
    within: Vec<(u32, u32)>,
    by_parent: Vec<(u32, u32)>,
    /// Whether each slide is undone, and whether what its cut or a later one tore there is open.
    pub(super) is_back: Vec<bool>,
    is_open: Vec<bool>,
    slides_by_class: BTreeMap<u32, Vec<usize>>,
    /// How many inserted vertices stay for what was done to them since, and how many slid ones.
    pub(super) edited: usize,
    pub(super) slid_edited: usize,
}

impl<'t> Going<'t> {
    pub(super) fn find(
        torn: &'t TornDocument<'t>,
        mesh: &Mesh,
        positions: &'t Positions,
        slots: &Slots,
    ) -> Going<'t> {
        let classes = torn.classes();
        let mut copies = vec![0_u32; torn.ancestry.class_count()];
        for &class in &classes {
            copies[class as usize] += 1;
        }
        let mut goes = vec![false; copies.len()];
        for inserted in torn.inserted() {
            goes[inserted.vertex as usize] = copies[inserted.vertex as usize] == 1;
        }
        let inserted = torn.inserted().iter();
        let mut going = Going {
            past: Past::new(torn, positions),
            classes,
            copies,
            goes,
            moments: inserted.map(|one| behind_slides(one.cut)).collect(),
            candidates: Vec::new(),
            corners_slid: Vec::new(),
            within: Vec::new(),
            by_parent: Vec::new(),
            is_back: Vec::new(),
            is_open: Vec::new(),
            slides_by_class: BTreeMap::new(),
            edited: 0,
            slid_edited: 0,
        };
        going.look_at_slides();
        going.look_into_faces(mesh, slots);
        going.take_back();
        going.slid_edited = going.count_slid_edited();
        going
    }

    pub(super) fn goes(&self, class: u32) -> bool {
        self.goes[class as usize]
    }

    /// Whether a vertex of the mesh goes.
    pub(super) fn vertex_goes(&self, vertex: usize) -> bool {
        self.goes(self.classes[vertex])
    }

    pub(super) fn restored(&self) -> Vec<Restored> {
        self.candidates.iter().flatten().copied().collect()
    }

    /// Finds which divided faces are whole, what they have inside, and what was edited.
    fn look_into_faces(&mut self, mesh: &Mesh, slots: &Slots) {
        let torn = self.past.torn;
        let classes = std::mem::take(&mut self.classes);
        let class_at = |h: usize| classes[mesh.indices()[h] as usize];
        let parents = torn.parents();
        for &class in parents.iter().flat_map(|parent| &parent.corners) {
            self.goes[class as usize] = false; // Of a parent that no honest record has.
        }
        let mut unlike: Vec<(u32, [bool; 2])> = Vec::new();
        let mut covered = 0;
        for (number, &parent) in parents.iter().enumerate() {
            let faces = slots.of(parent.first as usize..parent.end as usize);
            keep(&mut self.goes, &slots.faces[covered..faces.start], class_at);
            covered = faces.end;
            let faces = slots.faces[faces].iter();
            let half_edges = faces.flat_map(|&f| 3 * f as usize..3 * f as usize + 3);
            let corners = half_edges.map(|half_edge| {
                let vertex = mesh.indices()[half_edge] as usize;
                (class_at(half_edge), CornerAt { half_edge, vertex })
            });
            let corners: Vec<(u32, CornerAt)> = corners.collect();
            // What a parent has inside stands and falls with it.
            let own = corners.iter().map(|&(class, _)| class);
            let own = own.filter(|class| !parent.corners.contains(class));
            self.within.extend(own.map(|class| (class, number as u32)));
            let whole = self.whole(number, parent, &corners);
            if whole.is_some() {
                unlike.extend(self.unlike_within(corners));
            }
            self.candidates.push(whole);
        }
        keep(&mut self.goes, &slots.faces[covered..], class_at);
        self.classes = classes;
        self.judge(unlike);
        self.within.sort_unstable();
        self.within.dedup();
        self.by_parent = self.within.iter().map(|&(c, p)| (p, c)).collect();
        self.by_parent.sort_unstable();
    }

    /// The face that these corners are those of the parts of, if the parts agree on its own; perhaps
    /// they did before a vertex there slid.
    fn whole(
        &mut self,
        number: usize,
        parent: Parent,
        corners: &[(u32, CornerAt)],
    ) -> Option<Restored> {
        let mut first: [Option<CornerAt>; 3] = [None; 3];
        let mut slid = Vec::new();
        for &(class, corner) in corners {
            let Some(of) = parent.corners.iter().position(|&of| of == class) else {
                continue;
            };
            let first = *first[of].get_or_insert(corner);
            let past = &self.past;
            let now = |corner: CornerAt| past.torn.corner_of(corner.half_edge);
            let long_ago = |corner: CornerAt| [0, 1].map(|which| past.index(corner, which, 0));
            if first.vertex != corner.vertex || long_ago(first) != long_ago(corner) {
                return None;
            }
            if now(first) != now(corner) {
                slid.push((number, corner.vertex));
            }
        }
        let [Some(a), Some(b), Some(c)] = first else {
            return None;
        };
        self.corners_slid.extend(slid);
        Some(Restored {
            parent,
            corners: [a, b, c].map(|corner| corner.half_edge as u32),
        })
    }

    /// The classes that might go, of those at the corners of the parts of one face, but are not as they
    /// were inserted: behind the slides of their cut, or before these.
    fn unlike_within(&self, mut corners: Vec<(u32, CornerAt)>) -> Vec<(u32, [bool; 2])> {
        corners.sort_by_key(|&(class, _)| class);
        let first = |class: u32| {
            let at = corners.partition_point(|&(other, _)| other < class);
            let found = corners.get(at).filter(|&&(other, _)| other == class);
            found.map(|&(_, corner)| corner)
        };
        let inserted = self.past.torn.inserted();
        let going = corners.iter().filter(|&&(class, _)| self.goes(class));
        let unlike = going.filter_map(|&(class, corner)| {
            let place = inserted.binary_search_by_key(&class, |one| one.vertex);
            let Ok(Inserted { cut, at, .. }) = place.map(|place| inserted[place]) else {
                return Some((class, [true; 2]));
            };
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

    /// Keeps what was edited, and finds out whether the rest was inserted before its cut slid
    /// vertices or behind that.
    fn judge(&mut self, mut unlike: Vec<(u32, [bool; 2])>) {
        unlike.sort_unstable();
        let inserted = self.past.torn.inserted();
        for of_class in unlike.chunk_by(|a, b| a.0 == b.0) {
            let class = of_class[0].0;
            let [behind, before] = [0, 1].map(|i| of_class.iter().any(|(_, unlike)| unlike[i]));
            let place = inserted.binary_search_by_key(&class, |one| one.vertex);
            match place {
                Ok(place) if behind && !before => {
                    self.moments[place] = before_slides(inserted[place].cut);
                }
                _ if !behind => {}
                _ => {
                    let went = std::mem::take(&mut self.goes[class as usize]);
                    let waits = place.is_ok_and(|place| self.waits_for_a_slide(place));
                    self.edited += usize::from(went && !waits);
                }
            }
        }
    }

    /// Whether an inserted vertex was put between others of which one has slid where a cut is open.
    fn waits_for_a_slide(&self, place: usize) -> bool {
        self.slides_of_ends(place).any(|slide| self.is_open[slide])
    }

    /// The slides of the ends that an inserted vertex was put between.
    fn slides_of_ends(&self, place: usize) -> impl Iterator<Item = usize> + '_ {
        let ends = self.past.torn.inserted()[place].at.roots().iter();
        let slides = ends.filter_map(|class| self.slides_by_class.get(class));
        slides.flatten().copied()
    }

    /// Finds the slides that may be undone.
    fn look_at_slides(&mut self) {
        let past = &self.past;
        if past.slides.is_empty() {
            return;
        }
        let mut torn_by = vec![0; self.classes.len()];
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
            let of_class = self.slides_by_class.entry(self.classes[vertex]);
            of_class.or_default().push(slide);
        }
    }

    /// How many vertices stay only because they were edited since they slid.
    fn count_slid_edited(&self) -> usize {
        let is_edited = |&slide: &usize| {
            let vertex = self.past.slides.get(slide).vertex as usize;
            let later = self.past.of(vertex).find(|&later| later > slide);
            let is_first_found = later.is_none_or(|later| self.past.is_intact(later));
            let stays = !self.is_open[slide] && !self.vertex_goes(vertex);
            is_first_found && stays && !self.past.is_intact(slide)
        };
        (0..self.is_back.len()).filter(is_edited).count()
    }

    /// Takes back what cannot go, and what follows from that.
    fn take_back(&mut self) {
        let stays = |class: &usize| self.copies[*class] > 0 && !self.goes[*class];
        let staying = (0..self.goes.len()).filter(stays);
        let mut staying: Vec<u32> = staying.map(|class| class as u32).collect();
        for parent in 0..self.candidates.len() {
            if self.candidates[parent].is_none() {
                self.keep_within(parent as u32, &mut staying);
            }
        }
        loop {
            while let Some(class) = staying.pop() {
                for i in range_of(&self.within, class) {
                    let parent = self.within[i].1;
                    if self.candidates[parent as usize].take().is_some() {
                        self.keep_within(parent, &mut staying);
                    }
                }
            }
            let mut more = self.keep_slides();
            for (place, inserted) in self.past.torn.inserted().iter().enumerate() {
                let class = inserted.vertex as usize;
                if self.goes[class] && self.has_an_end_elsewhere(place) {
                    self.goes[class] = false;
                    staying.push(inserted.vertex);
                }
                // What stays was put between vertices that stay, or the record would name none.
                if !self.goes[class] {
                    for &end in inserted.at.roots() {
                        staying.extend(std::mem::take(&mut self.goes[end as usize]).then_some(end));
                    }
                }
            }
            for i in 0..self.corners_slid.len() {
                let (parent, vertex) = self.corners_slid[i];
                let is_slid = self.past.of(vertex).any(|slide| !self.is_back[slide]);
                if is_slid && self.candidates[parent].take().is_some() {
                    self.keep_within(parent as u32, &mut staying);
                    more = true;
                }
            }
            if staying.is_empty() && !more {
                return;
            }
        }
    }

    /// What a face has inside stays with it.
    fn keep_within(&mut self, parent: u32, staying: &mut Vec<u32>) {
        for i in range_of(&self.by_parent, parent) {
            let class = self.by_parent[i].1;
            staying.extend(std::mem::take(&mut self.goes[class as usize]).then_some(class));
        }
    }

    /// Whether an inserted vertex was put between others of which one has slid since, and stays there.
    fn has_an_end_elsewhere(&self, place: usize) -> bool {
        self.slides_of_ends(place).any(|slide| {
            let cut = self.past.slides.get(slide).cut;
            behind_slides(cut) > self.moments[place] && !self.is_back[slide]
        })
    }

    /// Keeps slides beside whose vertex something stays that was put there later; whether there are
    /// any. Where a slide stays, all earlier ones of its vertex do for the same reason.
    fn keep_slides(&mut self) -> bool {
        let mut more = false;
        let inserted = self.past.torn.inserted();
        for (place, one) in inserted.iter().enumerate() {
            if self.goes(one.vertex) || self.copies[one.vertex as usize] == 0 {
                continue;
            }
            let slides: Vec<usize> = self.slides_of_ends(place).collect();
            for slide in slides {
                let is_earlier =
                    behind_slides(self.past.slides.get(slide).cut) <= self.moments[place];
                more |= is_earlier && std::mem::take(&mut self.is_back[slide]);
            }
        }
        more
    }
}

/// Where the pairs of a sorted list are that begin with this.
fn range_of(list: &[(u32, u32)], first: u32) -> std::ops::Range<usize> {
    let start = list.partition_point(|&(one, _)| one < first);
    start..list.partition_point(|&(one, _)| one <= first)
}

/// The vertices of faces that were not divided stay.
fn keep(goes: &mut [bool], faces: &[u32], class_at: impl Fn(usize) -> u32) {
    for &face in faces {
        for h in 3 * face as usize..3 * face as usize + 3 {
            goes[class_at(h) as usize] = false;
        }
    }
}

//! What can be undone: insertions, slides, divisions of faces.
//!
//! Which insertions go is the kernel's [`RemovalPlan`], of the record's divided faces. Slides are undone with
//! them, as if in reverse order of the cuts:
//!
//! * An inserted vertex goes only if it is as it was inserted (`history.rs`), and if the ends that it was
//!   put between are where they were then: a later slide of one of them has to be undone too. And only if
//!   no edge at the vertex is torn that its cut or a later one tore.
//! * What a cut inserted at one place goes together. These are the two sides of a seam that is not sewn, and
//!   without one of them the seam would not fit any more.
//! * A slide is undone if no edge at the vertex is torn that its cut or a later one tore, if the vertex
//!   is as it was left, and if everything goes that was put beside it since. What holds a
//!   slide holds all earlier ones of its vertex.
//!
//! All begins with everything going that might, and is planned anew until no more has to stay.

use std::collections::BTreeMap;

use tearmesh::{FaceId, FacePart, HalfEdgeId, Insertions, Mesh, RemovalPlan, VertexId};

use super::history::History;
use crate::document::Document;
use crate::families::Families;
use crate::record::{Inserted, Record};
use crate::torn::Distances;

/// A divided face.
#[derive(Clone, Debug, Default)]
pub(super) struct Divided {
    /// The roots at its corners.
    corners: [u32; 3],
    /// The faces that it was divided into, each with the roots at its corners. Of one that was divided
    /// again it is any face of it.
    parts: Vec<(FaceId, [u32; 3])>,
    /// The faces of the mesh that cover it, in order.
    pub(super) faces: Vec<FaceId>,
}

pub(super) struct Undo<'d> {
    pub(super) history: History<'d>,
    plan: RemovalPlan,
    /// The divided faces, by family.
    pub(super) divided: Vec<Divided>,
    inserted: &'d [Inserted],
    /// Whether each slide is undone, and whether an edge that its cut or a later one tore there is torn.
    pub(super) is_back: Vec<bool>,
    is_open: Vec<bool>,
    /// By root, whether it was inserted and may go.
    may_go: Vec<bool>,
    /// For each inserted vertex, the first cut whose slides came later.
    since: Vec<u32>,
    /// The inserted vertices that one cut put at one place.
    together: Vec<Vec<u32>>,
    /// How many inserted vertices stay for what was done to them since.
    pub(super) edited: usize,
}

impl<'d> Undo<'d> {
    pub(super) fn find(document: &'d Document, record: &'d Record, mesh: &Mesh) -> Undo<'d> {
        let history = History::new(document, record);
        let divided = divided(&record.families, &history, mesh);
        let inserted = &record.inserted[..];
        // The plan knows what is within before what is around.
        let families = divided
            .iter()
            .rev()
            .map(|face| face.parts_for_plan(inserted));
        let insertions = Insertions::new(mesh, families);
        let last_tears = last_tears(record, &history, mesh);
        let may_go = may_go(record, &history, &last_tears, mesh);
        let [is_open, is_back] = slides_to_undo(record, &history, &last_tears);
        let plan = |history: &History<'_>, may_go: &[bool], is_back: &[bool]| {
            let may_go = |v: VertexId| may_go[history.roots[v.index()] as usize];
            let indices = |h: HalfEdgeId| history.indices(h.index(), |slide| is_back[slide]);
            insertions.plan(mesh, may_go, |one, other| indices(one) == indices(other))
        };
        let mut undo = Undo {
            plan: plan(&history, &may_go, &is_back),
            is_back,
            is_open,
            may_go,
            since: inserted.iter().map(|one| one.cut + 1).collect(),
            together: together(document, inserted),
            inserted,
            history,
            divided,
            edited: 0,
        };
        let divided = undo.divided.iter().enumerate();
        let restored = divided.filter(|&(number, _)| undo.restored(number).is_some());
        let unlike = restored.flat_map(|(_, divided)| undo.unlike_within(divided));
        let unlike: Vec<_> = unlike.collect();
        let mut is_outdated = !unlike.is_empty();
        undo.keep_edited(unlike);
        loop {
            if is_outdated {
                undo.plan = plan(&undo.history, &undo.may_go, &undo.is_back);
            }
            let mut goes = vec![false; undo.may_go.len()];
            for v in mesh.vertices().filter(|&v| undo.plan.goes(v)) {
                goes[undo.history.roots[v.index()] as usize] = true;
            }
            if !undo.keep_more(&mut goes) {
                return undo;
            }
            is_outdated = true;
        }
    }

    /// The roots within a divided face that might go, but are not as they were inserted: behind the
    /// slides of their cut, or before these.
    fn unlike_within(&self, divided: &Divided) -> Vec<(u32, [bool; 2])> {
        let mut corners: BTreeMap<u32, usize> = BTreeMap::new();
        for h in divided.faces.iter().flat_map(|f| f.half_edges()) {
            let first = corners.entry(self.history.root(h.index()));
            first.or_insert(h.index());
        }
        let first = |root: u32| corners.get(&root).copied();
        let might_go = |root: u32| self.may_go[root as usize] && !divided.corners.contains(&root);
        let going = corners.iter().filter(|&(&root, _)| might_go(root));
        let unlike = going.filter_map(|(&root, &corner)| {
            let inserted = &self.inserted[self.place(root)?];
            let is_unlike =
                |since: u32| !self.history.is_as_inserted(corner, inserted, since, first);
            let unlike = [inserted.cut + 1, inserted.cut].map(is_unlike);
            unlike.contains(&true).then_some((root, unlike))
        });
        unlike.collect()
    }

    /// The place of a root in the list of what was inserted.
    fn place(&self, root: u32) -> Option<usize> {
        let place = self.inserted.binary_search_by_key(&root, |one| one.vertex);
        place.ok()
    }

    /// Keeps what was edited, and finds out whether the rest was inserted before its cut slid
    /// vertices or behind that.
    fn keep_edited(&mut self, mut unlike: Vec<(u32, [bool; 2])>) {
        unlike.sort_unstable();
        for of_root in unlike.chunk_by(|a, b| a.0 == b.0) {
            let root = of_root[0].0;
            let [behind, before] = [0, 1].map(|i| of_root.iter().any(|(_, unlike)| unlike[i]));
            let place = self.place(root).expect("it was inserted");
            if behind && before {
                self.may_go[root as usize] = false;
                let waits = self.slides_of_ends(place).any(|slide| self.is_open[slide]);
                self.edited += usize::from(!waits);
            } else if behind {
                self.since[place] = self.inserted[place].cut;
            }
        }
    }

    /// The slides of the ends that an inserted vertex was put between.
    fn slides_of_ends(&self, place: usize) -> impl Iterator<Item = usize> + '_ {
        let ends = self.inserted[place].between.iter();
        ends.flat_map(|&root| self.history.of_root(root))
    }

    /// How many vertices stay only because they were edited since they slid.
    pub(super) fn slid_edited(&self) -> usize {
        let is_edited = |&slide: &usize| {
            let vertex = self.history.slides[slide].vertex;
            let later = self.history.of(vertex).find(|&later| later > slide);
            let is_first_found = later.is_none_or(|later| self.history.is_intact[later]);
            let goes = self.goes(vertex);
            is_first_found && !self.is_open[slide] && !goes && !self.history.is_intact[slide]
        };
        (0..self.is_back.len()).filter(is_edited).count()
    }

    /// The half-edges whose corners a divided face has, if it is restored.
    pub(super) fn restored(&self, family: usize) -> Option<[HalfEdgeId; 3]> {
        self.plan.restored(self.divided.len() - 1 - family)
    }

    /// Whether a vertex is removed.
    pub(super) fn goes(&self, vertex: u32) -> bool {
        let vertex = VertexId::new(vertex as usize).expect("I1: ids fit");
        self.plan.goes(vertex)
    }

    /// Keeps what depends on something that stays, where `goes` says by root what goes; whether
    /// there is any.
    fn keep_more(&mut self, goes: &mut [bool]) -> bool {
        let mut more = false;
        for group in &self.together {
            if group.iter().all(|&root| goes[root as usize]) {
                continue;
            }
            for &root in group {
                if std::mem::take(&mut goes[root as usize]) {
                    self.may_go[root as usize] = false;
                    more = true;
                }
            }
        }
        // From the last one: its ends were inserted before it.
        for (place, inserted) in self.inserted.iter().enumerate().rev() {
            let of_ends: Vec<usize> = self.slides_of_ends(place).collect();
            let is_later = |slide: &usize| self.history.slides[*slide].cut >= self.since[place];
            let (later, earlier): (Vec<usize>, Vec<usize>) =
                of_ends.iter().partition(|s| is_later(s));
            if goes[inserted.vertex as usize] && later.iter().all(|&slide| self.is_back[slide]) {
                continue;
            }
            // Where a slide stays, all earlier ones of its vertex do for the same reason.
            for slide in earlier {
                more |= std::mem::take(&mut self.is_back[slide]);
            }
            // What stays was put between vertices that stay, or the record would name none.
            for &root in [inserted.vertex].iter().chain(&inserted.between) {
                if std::mem::take(&mut goes[root as usize]) {
                    self.may_go[root as usize] = false;
                    more = true;
                }
            }
        }
        more
    }
}

/// For each slide, whether an edge is torn there that its cut or a later one tore, and whether the slide may be
/// undone.
fn slides_to_undo(record: &Record, history: &History<'_>, last_tears: &[u32]) -> [Vec<bool>; 2] {
    let slides = record.slides.iter().zip(&history.is_intact);
    let slides = slides.map(|(slid, is_intact)| {
        let is_open = last_tears[history.roots[slid.vertex as usize] as usize] >= slid.cut;
        (is_open, *is_intact && !is_open)
    });
    let (is_open, is_back) = slides.unzip();
    [is_open, is_back]
}

/// By root, the last cut that tore an edge at one of its vertices, of edges that are still torn; 0 if none is.
/// An edge is torn by every cut that parted its two sides at one of its ends: at the tip of a cut, the edge is
/// torn and the vertex was never split.
fn last_tears(record: &Record, history: &History<'_>, mesh: &Mesh) -> Vec<u32> {
    let mut last = vec![0; history.roots.len()];
    let distances = Distances::of(history.roots.len(), &record.splits);
    for h in mesh.half_edges() {
        let Some(ghost) = mesh.ghost_pair(h).filter(|ghost| h < *ghost) else {
            continue;
        };
        let sides = [
            [mesh.origin(h), mesh.target(ghost)],
            [mesh.target(h), mesh.origin(ghost)],
        ];
        let parted = sides.into_iter().filter(|[one, other]| one != other);
        let cuts = parted.map(|[one, other]| distances.apart_since(one.into(), other.into()));
        let cut = cuts.fold(0, u32::max);
        for [vertex, _] in sides {
            let of_root = &mut last[history.roots[vertex.index()] as usize];
            *of_root = cut.max(*of_root);
        }
    }
    last
}

/// The inserted vertices that one cut put at one place, where there are several.
fn together(document: &Document, inserted: &[Inserted]) -> Vec<Vec<u32>> {
    let key = |one: &Inserted| {
        let at = document.positions()[one.vertex as usize];
        (one.cut, [at.x, at.y, at.z].map(|x| (x + 0.0).to_bits())) // −0 is 0.
    };
    let mut placed: Vec<_> = inserted.iter().map(|one| (key(one), one.vertex)).collect();
    placed.sort_unstable();
    placed
        .chunk_by(|one, other| one.0 == other.0)
        .filter(|group| group.len() > 1)
        .map(|group| group.iter().map(|&(_, vertex)| vertex).collect())
        .collect()
}

/// By root, whether it was inserted by a cut that is not open there; and what no honest record has: a parent
/// between inserted vertices, and undivided faces there.
fn may_go(record: &Record, history: &History<'_>, last_tears: &[u32], mesh: &Mesh) -> Vec<bool> {
    let mut may_go = vec![false; history.roots.len()];
    for inserted in &record.inserted {
        let root = inserted.vertex as usize;
        may_go[root] = last_tears[root] < inserted.cut;
    }
    let families = &record.families;
    for family in families
        .all()
        .iter()
        .filter(|family| family.above.is_none())
    {
        let corners = family.corners.iter();
        corners.for_each(|&root| may_go[root as usize] = false);
    }
    for f in mesh.faces().filter(|f| families.of(f.index()).is_none()) {
        let corners = f.half_edges().into_iter();
        corners.for_each(|h| may_go[history.root(h.index()) as usize] = false);
    }
    may_go
}

/// All divided faces of a mesh.
fn divided(families: &Families, history: &History<'_>, mesh: &Mesh) -> Vec<Divided> {
    let divided = families.all().iter().map(|family| Divided {
        corners: family.corners,
        ..Divided::default()
    });
    let mut divided: Vec<Divided> = divided.collect();
    for face in mesh.faces() {
        let mut part = (face, face.half_edges().map(|h| history.root(h.index())));
        let mut family = families.of(face.index());
        let mut is_new = true;
        while let Some(number) = family {
            let within = &mut divided[number as usize];
            let is_first = within.faces.is_empty();
            within.faces.push(face);
            if is_new {
                within.parts.push(part);
            }
            is_new &= is_first;
            part = (face, within.corners);
            family = families.all()[number as usize].above;
        }
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
                && inserted[place].is_on_edge()
            {
                let ends = inserted[place].between;
                let [one, other, _] =
                    ends.map(|end| on_sides.get(&end).copied().unwrap_or_default());
                on_sides.insert(class, [0, 1, 2].map(|side| one[side] && other[side]));
            }
        }
        let part = |&(face, classes): &(FaceId, [u32; 3])| FacePart {
            face,
            roots: classes,
            corners: classes.map(corner),
            on_sides: classes.map(|class| on_sides[&class]),
        };
        self.parts.iter().map(part).collect()
    }
}

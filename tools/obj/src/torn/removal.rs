//! What is left out and put back when a torn document is written simplified.

use std::collections::BTreeMap;

use tearmesh::{Mesh, Positions, VertexId};

use super::TornDocument;
use super::slots::Slots;
use super::undo::Undo;
use crate::families::Families;
use crate::slides::Exchange;

/// What is left out when a torn document is written simplified.
#[derive(Debug)]
pub(crate) struct Removal {
    /// Whether each vertex of the mesh is left out, each texture coordinate and each normal.
    pub(crate) vertices: Vec<bool>,
    pub(crate) texture: Vec<bool>,
    pub(crate) normals: Vec<bool>,
    /// Whether each slide is undone.
    pub(crate) is_back: Vec<bool>,
    restored: Vec<Restored>,
    /// By parent, and by part that was divided again, whether it is restored.
    pub(crate) parents: Vec<bool>,
    pub(crate) families: Vec<bool>,
    /// By face of the mesh what is written in its place: itself, a restored face, or nothing.
    instead: Vec<u32>,
    /// For each vertex of which a slide is undone, what its `v` has then, and which indices its
    /// corners exchange, in this order.
    put_back: BTreeMap<u32, (Vec<f64>, Vec<Exchange>)>,
}

/// A face that takes the place of those that cover it.
#[derive(Clone, Copy, Debug)]
struct Restored {
    /// Half-edges of the mesh whose corners it has.
    corners: [u32; 3],
    /// The part that was divided again in which it is.
    family: Option<u32>,
}

/// Marks a restored face among faces of the mesh, of which there are less.
const RESTORED: u32 = 1 << 31;

/// Marks that nothing is written in the place of a face.
const NOTHING: u32 = u32::MAX;

impl Removal {
    /// The part that was divided again to which a face that is written belongs.
    pub(crate) fn family(&self, families: &Families, face: u32) -> Option<u32> {
        match face.checked_sub(RESTORED) {
            Some(index) => self.restored[index as usize].family,
            None => families.of(face as usize),
        }
    }

    /// The corners of a restored face.
    #[inline]
    pub(crate) fn restored(&self, face: u32) -> Option<[u32; 3]> {
        let index = face.checked_sub(RESTORED)?;
        Some(self.restored[index as usize].corners)
    }

    /// What the `v` of a vertex has, if slides of it are undone.
    pub(crate) fn put_back(&self, vertex: u32) -> Option<&[f64]> {
        self.put_back.get(&vertex).map(|(numbers, _)| &numbers[..])
    }

    /// The indices that a corner of a vertex had before the slides that are undone.
    pub(crate) fn indices_before(
        &self,
        vertex: u32,
        mut indices: [Option<u32>; 2],
    ) -> [Option<u32>; 2] {
        if let Some((_, exchanges)) = self.put_back.get(&vertex) {
            for &Exchange { which, new, old } in exchanges {
                if indices[which] == Some(new) {
                    indices[which] = Some(old);
                }
            }
        }
        indices
    }

    /// The faces that are written.
    pub(crate) fn slots(&self, slots: &Slots) -> Slots {
        let mut written = Slots::with_capacity(slots.faces.len());
        for triangle in 0..slots.triangles() {
            let here = slots.faces[slots.of(triangle..triangle + 1)].iter();
            let here = here.map(|&face| self.instead[face as usize]);
            written.push(&here.filter(|&face| face != NOTHING).collect::<Vec<u32>>());
        }
        written
    }
}

/// What simplifying finds, beside what it removes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Found {
    /// Inserted vertices that stay because they were edited, and slid ones.
    pub(crate) edited: usize,
    pub(crate) slid_edited: usize,
    /// Vertices that are put back where they slid from.
    pub(crate) slid_back: usize,
}

impl TornDocument<'_> {
    /// What can go, `None` if nothing can; and what stays because it was edited.
    pub(crate) fn removal(&self, mesh: &Mesh, positions: &Positions) -> (Option<Removal>, Found) {
        let slots = self.slots();
        let undo = Undo::find(self, mesh, positions, &slots);
        let mut found = Found {
            edited: undo.edited,
            slid_edited: undo.slid_edited(),
            slid_back: 0,
        };
        let (mut restored, put_back) = (Vec::new(), put_back(&undo));
        let mut instead: Vec<u32> = (0..mesh.face_count() as u32).collect();
        let again = self.families().all();
        // What is around comes later, and takes the place of what is within.
        for (number, divided) in undo.divided.iter().enumerate() {
            if let Some(corners) = undo.plan.restored(number) {
                let family = (again.len().checked_sub(1 + number)).and_then(|own| again[own].above);
                let corners = corners.map(u32::from);
                let mut face = RESTORED + restored.len() as u32;
                restored.push(Restored { corners, family });
                for covering in &divided.faces {
                    instead[covering.index()] = std::mem::replace(&mut face, NOTHING);
                }
            }
        }
        let is_restored = |number: usize| undo.plan.restored(number).is_some();
        let (within, parents) = (0..again.len(), again.len()..undo.divided.len());
        if restored.is_empty() && put_back.is_empty() {
            return (None, found);
        }
        found.slid_back = put_back.len();
        let mut removal = Removal {
            vertices: mesh.vertices().map(|v| undo.plan.goes(v)).collect(),
            texture: Vec::new(),
            normals: Vec::new(),
            families: within.rev().map(is_restored).collect(),
            parents: parents.map(is_restored).collect(),
            is_back: undo.is_back,
            restored,
            instead,
            put_back,
        };
        [removal.texture, removal.normals] = self.unused(&removal, mesh, &slots);
        (Some(removal), found)
    }

    /// Of the texture coordinates and the normals that were inserted, those that nothing has any more.
    fn unused(&self, removal: &Removal, mesh: &Mesh, slots: &Slots) -> [Vec<bool>; 2] {
        let counts = self.counts();
        let mut unused = [0, 1].map(|which| {
            let all = 0..counts[which];
            let inserted = all.map(|index| self.is_index_inserted(which, index));
            inserted.collect::<Vec<_>>()
        });
        for &face in &removal.slots(slots).faces {
            let own = || [3 * face, 3 * face + 1, 3 * face + 2];
            for h in removal.restored(face).unwrap_or_else(own) {
                let vertex = mesh.indices()[h as usize];
                let indices = removal.indices_before(vertex, self.corner_of(h as usize));
                for (index, unused) in indices.into_iter().zip(&mut unused) {
                    if let Some(index) = index {
                        unused[index as usize] = false;
                    }
                }
            }
        }
        // Slides that stay name theirs.
        let slides = self.slides();
        for slide in (0..slides.len()).filter(|&slide| !removal.is_back[slide]) {
            if !removal.vertices[slides.get(slide).vertex as usize] {
                for (Exchange { which, new, old }, _) in slides.exchanges(slide) {
                    unused[which][new as usize] = false;
                    unused[which][old as usize] = false;
                }
            }
        }
        unused
    }
}

/// The vertices that stay and of which slides are undone, with what they had before these.
fn put_back(undo: &Undo<'_>) -> BTreeMap<u32, (Vec<f64>, Vec<Exchange>)> {
    let slides = &undo.past.slides;
    let mut put_back: BTreeMap<u32, (Vec<f64>, Vec<Exchange>)> = BTreeMap::new();
    for (slide, slid) in slides.iter().enumerate().rev() {
        let vertex = VertexId::new(slid.vertex as usize).expect("I1: ids fit");
        if undo.is_back[slide] && !undo.plan.goes(vertex) {
            let (numbers, exchanges) = put_back.entry(slid.vertex).or_default();
            *numbers = slides.before(slide).to_vec();
            exchanges.extend(slides.exchanges(slide).map(|(exchange, _)| exchange));
        }
    }
    put_back
}

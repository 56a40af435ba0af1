//! What is left out and put back when a torn document is written simplified.

use std::collections::BTreeMap;
use std::slice::from_ref;

use tearmesh::{Mesh, Positions, VertexId};

use super::TornDocument;
use super::slots::Slots;
use super::undo::Undo;
use crate::record::Parent;
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
    /// Ascending, by the triangles of the document where they stand.
    restored: Vec<Restored>,
    /// For each vertex of which a slide is undone, what its `v` has then, and which indices its
    /// corners exchange, in this order.
    put_back: BTreeMap<u32, (Vec<f64>, Vec<Exchange>)>,
}

/// A face that takes the place of those that cover it.
#[derive(Clone, Copy, Debug)]
struct Restored {
    parent: Parent,
    /// Half-edges of the mesh whose corners it has.
    corners: [u32; 3],
}

/// Marks a restored face among faces of the mesh, of which there are less.
const RESTORED: u32 = 1 << 31;

impl Removal {
    /// Whether the face that stood from this triangle of the document on is restored.
    pub(crate) fn restores(&self, first: u32) -> bool {
        let parent = |restored: &Restored| restored.parent.first;
        self.restored.binary_search_by_key(&first, parent).is_ok()
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
        let mut restored = (RESTORED..).zip(&self.restored).peekable();
        for triangle in 0..slots.triangles() {
            let here = restored
                .peek()
                .map(|&(face, restored)| (face, restored.parent));
            match here {
                Some((face, parent)) if triangle >= parent.first as usize => {
                    let begins = triangle == parent.first as usize;
                    written.push(if begins { from_ref(&face) } else { &[] });
                    if triangle + 1 == parent.end as usize {
                        restored.next();
                    }
                }
                _ => written.push(&slots.faces[slots.of(triangle..triangle + 1)]),
            }
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
        let parents = undo.parents.iter().enumerate();
        let restored = parents.filter_map(|(number, &parent)| {
            let corners = undo.plan.restored(number)?.map(u32::from);
            Some(Restored { parent, corners })
        });
        let (restored, put_back): (Vec<Restored>, _) = (restored.collect(), put_back(&undo));
        if restored.is_empty() && put_back.is_empty() {
            return (None, found);
        }
        found.slid_back = put_back.len();
        let mut removal = Removal {
            vertices: mesh.vertices().map(|v| undo.plan.goes(v)).collect(),
            texture: Vec::new(),
            normals: Vec::new(),
            is_back: undo.is_back,
            restored,
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

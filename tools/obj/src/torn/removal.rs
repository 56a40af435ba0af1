//! What can be taken out again of what cuts inserted.

use std::slice::from_ref;

use tearmesh::{Mesh, Positions};

use super::TornDocument;
use super::edited::CornerAt;
use super::slots::Slots;
use crate::record::Parent;

/// What is left out when a torn document is written simplified.
#[derive(Debug)]
pub(crate) struct Removal {
    /// Whether each vertex of the mesh is left out, each texture coordinate and each normal.
    pub(crate) vertices: Vec<bool>,
    pub(crate) texture: Vec<bool>,
    pub(crate) normals: Vec<bool>,
    /// Ascending, by the triangles of the document where they stand.
    restored: Vec<Restored>,
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

impl TornDocument<'_> {
    /// What can go, `None` if nothing can; and how many vertices stay because they were edited.
    pub(crate) fn removal(&self, mesh: &Mesh, positions: &Positions) -> (Option<Removal>, usize) {
        let slots = self.slots();
        let going = Going::find(self, mesh, positions, &slots);
        let edited = going.edited;
        let removal = (!going.restored.is_empty()).then(|| self.removal_of(going, &slots));
        (removal, edited)
    }

    fn removal_of(&self, going: Going, slots: &Slots) -> Removal {
        let classes = self.classes();
        let mut removal = Removal {
            vertices: classes.iter().map(|&class| going.goes(class)).collect(),
            texture: Vec::new(),
            normals: Vec::new(),
            restored: going.restored,
        };
        let counts = self.counts();
        let mut unused = [0, 1].map(|which| {
            let all = 0..counts[which];
            let inserted = all.map(|index| self.is_index_inserted(which, index));
            inserted.collect::<Vec<_>>()
        });
        for &face in &removal.slots(slots).faces {
            let own = [
                3 * face as usize,
                3 * face as usize + 1,
                3 * face as usize + 2,
            ];
            let corners = removal.restored(face);
            for h in corners.map_or(own, |corners| corners.map(|h| h as usize)) {
                for (index, unused) in self.corner_of(h).into_iter().zip(&mut unused) {
                    if let Some(index) = index {
                        unused[index as usize] = false;
                    }
                }
            }
        }
        [removal.texture, removal.normals] = unused;
        removal
    }
}

/// Which inserted vertices go, and which faces are restored.
struct Going {
    /// By class: whether it was inserted and may go.
    goes: Vec<bool>,
    restored: Vec<Restored>,
    /// How many might go but for what was done to them since.
    edited: usize,
}

impl Going {
    fn goes(&self, class: u32) -> bool {
        self.goes[class as usize]
    }

    /// Begins with everything inserted, and takes back what cannot go until nothing more follows.
    fn find(torn: &TornDocument<'_>, mesh: &Mesh, positions: &Positions, slots: &Slots) -> Going {
        let classes = torn.classes();
        let mut copies = vec![0_u32; torn.ancestry.class_count()];
        for &class in &classes {
            copies[class as usize] += 1;
        }
        let mut goes = vec![false; copies.len()];
        for inserted in torn.inserted() {
            goes[inserted.vertex as usize] = copies[inserted.vertex as usize] == 1;
        }
        let class_at = |h: usize| classes[mesh.indices()[h] as usize];
        let parents = torn.parents();
        for &class in parents.iter().flat_map(|parent| &parent.corners) {
            goes[class as usize] = false; // Of a parent that no honest record has.
        }
        // What a parent has inside stands and falls with it.
        let mut within: Vec<(u32, u32)> = Vec::new();
        let mut candidates: Vec<Option<Restored>> = Vec::with_capacity(parents.len());
        let mut edited: Vec<u32> = Vec::new();
        let mut covered = 0;
        for (number, &parent) in parents.iter().enumerate() {
            let faces = slots.of(parent.first as usize..parent.end as usize);
            keep(&mut goes, &slots.faces[covered..faces.start], class_at);
            covered = faces.end;
            let faces = &slots.faces[faces];
            let half_edges = || {
                faces
                    .iter()
                    .flat_map(|&f| 3 * f as usize..3 * f as usize + 3)
            };
            let own = |h: &usize| !parent.corners.contains(&class_at(*h));
            within.extend(
                half_edges()
                    .filter(own)
                    .map(|h| (class_at(h), number as u32)),
            );
            let whole = torn.whole(parent, half_edges(), mesh, class_at);
            if whole.is_some() {
                let corners = half_edges().map(|half_edge| {
                    let vertex = mesh.indices()[half_edge] as usize;
                    (class_at(half_edge), CornerAt { half_edge, vertex })
                });
                edited.extend(torn.edited_within(corners.collect(), &goes, positions));
            }
            candidates.push(whole);
        }
        keep(&mut goes, &slots.faces[covered..], class_at);
        edited.retain(|&class| std::mem::take(&mut goes[class as usize]));
        within.sort_unstable();
        within.dedup();
        let mut by_parent: Vec<(u32, u32)> = within.iter().map(|&(c, p)| (p, c)).collect();
        by_parent.sort_unstable();
        let of = |list: &[(u32, u32)], key: u32| {
            let start = list.partition_point(|&(k, _)| k < key);
            start..list.partition_point(|&(k, _)| k <= key)
        };

        let stays = |c: usize| copies[c] > 0 && !goes[c];
        let mut staying: Vec<u32> = (0..goes.len())
            .filter(|&c| stays(c))
            .map(|c| c as u32)
            .collect();
        for number in 0..candidates.len() {
            if candidates[number].is_none() {
                for &(_, class) in &by_parent[of(&by_parent, number as u32)] {
                    staying.extend(std::mem::take(&mut goes[class as usize]).then_some(class));
                }
            }
        }
        loop {
            while let Some(class) = staying.pop() {
                for &(_, parent) in &within[of(&within, class)] {
                    if candidates[parent as usize].take().is_none() {
                        continue;
                    }
                    for &(_, class) in &by_parent[of(&by_parent, parent)] {
                        staying.extend(std::mem::take(&mut goes[class as usize]).then_some(class));
                    }
                }
            }
            // What stays was put between vertices that stay, or the record would name none.
            for inserted in torn.inserted() {
                if !goes[inserted.vertex as usize] {
                    for &class in inserted.at.roots() {
                        staying.extend(std::mem::take(&mut goes[class as usize]).then_some(class));
                    }
                }
            }
            if staying.is_empty() {
                break;
            }
        }
        Going {
            goes,
            restored: candidates.into_iter().flatten().collect(),
            edited: edited.len(),
        }
    }
}

/// The vertices of faces that were not divided stay.
fn keep(goes: &mut [bool], faces: &[u32], class_at: impl Fn(usize) -> u32) {
    for &face in faces {
        for h in 3 * face as usize..3 * face as usize + 3 {
            goes[class_at(h) as usize] = false;
        }
    }
}

impl TornDocument<'_> {
    /// The classes that go, of those at the corners of the parts of one face, but are no longer as
    /// they were inserted.
    fn edited_within(
        &self,
        mut corners: Vec<(u32, CornerAt)>,
        goes: &[bool],
        positions: &Positions,
    ) -> Vec<u32> {
        corners.sort_by_key(|&(class, _)| class);
        let first = |class: u32| {
            let at = corners.partition_point(|&(other, _)| other < class);
            let found = corners.get(at).filter(|&&(other, _)| other == class);
            found.map(|&(_, corner)| corner)
        };
        let inserted = self.inserted();
        let is_edited = |&&(class, corner): &&(u32, CornerAt)| {
            let place = inserted.binary_search_by_key(&class, |one| one.vertex);
            let at = place.map(|place| inserted[place].at);
            goes[class as usize]
                && !at.is_ok_and(|at| self.is_as_inserted(corner, &at, first, positions))
        };
        let edited = corners.iter().filter(is_edited);
        edited.map(|&(class, _)| class).collect()
    }

    /// The face that these half-edges are those of the parts of, if the parts agree on its corners.
    fn whole(
        &self,
        parent: Parent,
        half_edges: impl Iterator<Item = usize>,
        mesh: &Mesh,
        class_at: impl Fn(usize) -> u32,
    ) -> Option<Restored> {
        let mut corners: [Option<usize>; 3] = [None; 3];
        for h in half_edges {
            let class = class_at(h);
            let Some(corner) = parent.corners.iter().position(|&of| of == class) else {
                continue;
            };
            let first = *corners[corner].get_or_insert(h);
            let vertex = |h: usize| mesh.indices()[h];
            if vertex(first) != vertex(h) || self.corner_of(first) != self.corner_of(h) {
                return None;
            }
        }
        let [Some(a), Some(b), Some(c)] = corners else {
            return None;
        };
        Some(Restored {
            parent,
            corners: [a, b, c].map(|h| h as u32),
        })
    }
}

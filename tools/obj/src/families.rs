//! Divided faces: which faces cover each, where parts were divided again.

use std::ops::Range;

use crate::store::push;

const NONE: u32 = u32::MAX;

/// Divided faces. Each is covered by its own faces and by the divided ones whose `above` it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Families {
    all: Vec<Family>,
    /// The innermost family of each face; [`NONE`], as for all faces that are missing, for one that is
    /// none's.
    of_face: Vec<u32>,
}

/// A divided face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Family {
    /// The classes at its corners, in its order.
    pub(crate) corners: [u32; 3],
    /// The family that it was part of, which has a lower number; `None` for one that was no part, the
    /// parent of all that is within.
    pub(crate) above: Option<u32>,
}

impl Families {
    pub(crate) fn all(&self) -> &[Family] {
        &self.all
    }

    /// The innermost family of a face.
    pub(crate) fn of(&self, face: usize) -> Option<u32> {
        let family = self.of_face.get(face).copied();
        family.filter(|&family| family != NONE)
    }

    /// The faces from this one on that are within the same parent; one that is no part stands alone.
    pub(crate) fn parts_from(&self, face: usize) -> Range<usize> {
        let parent = |face: usize| self.of(face).map(|family| self.outermost(family));
        let own = parent(face);
        let mut end = face + 1;
        while own.is_some() && parent(end) == own {
            end += 1;
        }
        face..end
    }

    /// Adds a family without faces.
    pub(crate) fn add(&mut self, family: Family) {
        push(&mut self.all, family);
    }

    /// Gives a face to a family.
    pub(crate) fn give(&mut self, face: usize, family: u32) {
        while self.of_face.len() <= face {
            push(&mut self.of_face, NONE);
        }
        self.of_face[face] = family;
    }

    /// The outermost of the families that contain this one, which may be itself.
    pub(crate) fn outermost(&self, mut family: u32) -> u32 {
        while let Some(above) = self.all[family as usize].above {
            family = above;
        }
        family
    }

    /// Makes a family without `above` a part of another one.
    pub(crate) fn put_within(&mut self, family: u32, above: u32) {
        self.all[family as usize].above = Some(above);
    }

    /// The parents and the faces that cover each, in the order of these.
    pub(crate) fn parents(&self) -> Vec<(u32, Range<u32>)> {
        let (mut parents, mut face) = (Vec::new(), 0);
        while face < self.of_face.len() {
            let faces = self.parts_from(face);
            if let Some(family) = self.of(face) {
                let range = faces.start as u32..faces.end as u32;
                parents.push((self.outermost(family), range));
            }
            face = faces.end;
        }
        parents
    }

    /// The families that stay, where the faces are others and belong to these.
    pub(crate) fn of_faces(
        &self,
        faces: impl Iterator<Item = Option<u32>>,
        stays: impl Fn(usize) -> bool,
    ) -> Families {
        let mut families = Families::default();
        let mut numbers = Vec::with_capacity(self.all.len());
        for (number, family) in self.all.iter().enumerate() {
            numbers.push(families.all.len() as u32);
            if stays(number) {
                let above = family.above.map(|above| numbers[above as usize]);
                families.add(Family { above, ..*family });
            }
        }
        for (face, family) in faces.enumerate() {
            if let Some(family) = family {
                families.give(face, numbers[family as usize]);
            }
        }
        families
    }

    /// Renames the classes at corners.
    pub(crate) fn renumber(&mut self, id: impl Fn(u32) -> u32) {
        for family in &mut self.all {
            family.corners = family.corners.map(&id);
        }
    }
}

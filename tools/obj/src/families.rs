//! Faces that were divided again: which faces cover each, where what covers a parent came about in
//! several steps.

use crate::store::push;

const NONE: u32 = u32::MAX;

/// Divided faces within parents. Each is covered by its own faces and by the divided ones whose `above`
/// it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Families {
    all: Vec<Family>,
    /// The innermost family of each face; [`NONE`], as for all faces that are missing, for one that is
    /// none's.
    of_face: Vec<u32>,
}

/// A face that was divided and was part of a divided one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Family {
    /// The classes at its corners, in its order.
    pub(crate) corners: [u32; 3],
    /// The family that it was part of, which has a lower number; `None` for a parent.
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

    /// Adds a family without faces.
    pub(crate) fn add(&mut self, family: Family) {
        push(&mut self.all, family);
    }

    /// Gives a face to the last family.
    pub(crate) fn give(&mut self, face: usize) {
        while self.of_face.len() <= face {
            push(&mut self.of_face, NONE);
        }
        self.of_face[face] = self.all.len() as u32 - 1;
    }

    /// Divides a face again, that has these corners, into others.
    pub(crate) fn divide(
        &mut self,
        face: usize,
        corners: [u32; 3],
        into: impl Iterator<Item = usize>,
    ) {
        let above = self.of(face);
        self.add(Family { corners, above });
        into.for_each(|face| self.give(face));
    }

    /// The outermost family of a face.
    pub(crate) fn outermost(&self, face: usize) -> Option<u32> {
        let mut family = self.of(face)?;
        while let Some(above) = self.all[family as usize].above {
            family = above;
        }
        Some(family)
    }

    /// Renames the classes at corners.
    pub(crate) fn renumber(&mut self, id: impl Fn(u32) -> u32) {
        for family in &mut self.all {
            family.corners = family.corners.map(&id);
        }
    }
}

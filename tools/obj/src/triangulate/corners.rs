//! Which corners of its polygon each triangle has.

use std::ops::Range;

use crate::polygons::Polygons;

/// For each corner of a triangle, which corner of its polygon it is: in a byte where no polygon
/// has more than 256, as is nearly always so.
#[derive(Clone, Debug, Default)]
pub(super) enum Corners {
    /// Nothing needs to be kept: the triangles of each polygon are a fan from its first corner.
    #[default]
    Fans,
    Narrow(Vec<[u8; 3]>),
    Wide(Vec<[u16; 3]>),
}

impl Corners {
    /// Keeps the corners of each triangle from now on, with room for `count` of them. The first
    /// polygons, as many as are `done`, are fans.
    #[cold]
    pub(super) fn keep_each(&mut self, count: usize, polygons: &Polygons, done: usize) {
        if !matches!(self, Corners::Fans) {
            return;
        }
        let arities = (0..polygons.len()).map(|polygon| polygons.corners(polygon).len());
        *self = if arities.max().unwrap_or(0) <= 1 << 8 {
            Corners::Narrow(Vec::with_capacity(count))
        } else {
            Corners::Wide(Vec::with_capacity(count))
        };
        for polygon in 0..done {
            self.push_fan(polygons.triangles(polygon).len());
        }
    }

    /// Appends the triangles of a polygon that is a fan.
    #[inline]
    pub(super) fn push_fan(&mut self, triangles: usize) {
        if !matches!(self, Corners::Fans) {
            (0..triangles).for_each(|nth| self.push(of_fan(nth)));
        }
    }

    /// Appends a triangle; those of each are kept.
    #[inline]
    pub(super) fn push(&mut self, triangle: [u16; 3]) {
        match self {
            Corners::Fans => debug_assert!(false, "the corners of each are kept"),
            Corners::Narrow(all) => all.push(triangle.map(narrow)),
            Corners::Wide(all) => all.push(triangle),
        }
    }

    /// The corners of a triangle, the `nth` of its polygon.
    #[inline]
    pub(super) fn get(&self, triangle: usize, nth: usize) -> [u16; 3] {
        match self {
            Corners::Fans => of_fan(nth),
            Corners::Narrow(all) => all[triangle].map(u16::from),
            Corners::Wide(all) => all[triangle],
        }
    }

    /// The corners of a polygon that its triangles have.
    #[inline]
    pub(super) fn of_polygon(&self, triangles: Range<usize>) -> impl Iterator<Item = [u16; 3]> {
        let nth_triangles = triangles.enumerate();
        nth_triangles.map(|(nth, triangle)| self.get(triangle, nth))
    }

    /// Gives a triangle other corners; where all are fans, it stays one of a fan.
    pub(super) fn set(&mut self, triangle: usize, corners: [u16; 3]) {
        match self {
            Corners::Fans => {}
            Corners::Narrow(all) => all[triangle] = corners.map(narrow),
            Corners::Wide(all) => all[triangle] = corners,
        }
    }

    pub(super) fn truncate(&mut self, count: usize) {
        match self {
            Corners::Fans => {}
            Corners::Narrow(all) => all.truncate(count),
            Corners::Wide(all) => all.truncate(count),
        }
    }
}

/// The corners of the `nth` triangle of a fan.
#[inline]
fn of_fan(nth: usize) -> [u16; 3] {
    [0, nth as u16 + 1, nth as u16 + 2]
}

fn narrow(corner: u16) -> u8 {
    debug_assert!(corner < 1 << 8, "no polygon has more corners");
    corner as u8
}

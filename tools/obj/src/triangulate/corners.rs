//! Which corners of its polygon each triangle has.

use crate::document::Polygons;

/// For each corner of a triangle, which corner of its polygon it is: in a byte where no polygon
/// has more than 256, as is nearly always so.
#[derive(Clone, Debug)]
pub(super) enum Corners {
    Narrow(Vec<[u8; 3]>),
    Wide(Vec<[u16; 3]>),
}

impl Default for Corners {
    fn default() -> Corners {
        Corners::Narrow(Vec::new())
    }
}

impl Corners {
    /// With room for that many triangles of these polygons.
    pub(super) fn with_capacity(count: usize, polygons: &Polygons) -> Corners {
        let arities = (0..polygons.len()).map(|polygon| polygons.corners(polygon).len());
        if arities.max().unwrap_or(0) <= 1 << 8 {
            Corners::Narrow(Vec::with_capacity(count))
        } else {
            Corners::Wide(Vec::with_capacity(count))
        }
    }

    #[inline]
    pub(super) fn push(&mut self, triangle: [u16; 3]) {
        match self {
            Corners::Narrow(all) => all.push(triangle.map(narrow)),
            Corners::Wide(all) => all.push(triangle),
        }
    }

    #[inline]
    pub(super) fn get(&self, triangle: usize) -> [u16; 3] {
        match self {
            Corners::Narrow(all) => all[triangle].map(u16::from),
            Corners::Wide(all) => all[triangle],
        }
    }

    pub(super) fn set(&mut self, triangle: usize, corners: [u16; 3]) {
        match self {
            Corners::Narrow(all) => all[triangle] = corners.map(narrow),
            Corners::Wide(all) => all[triangle] = corners,
        }
    }

    pub(super) fn truncate(&mut self, count: usize) {
        match self {
            Corners::Narrow(all) => all.truncate(count),
            Corners::Wide(all) => all.truncate(count),
        }
    }
}

fn narrow(corner: u16) -> u8 {
    debug_assert!(corner < 1 << 8, "no polygon has more corners");
    corner as u8
}

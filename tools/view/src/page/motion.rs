//! Where the vertices are, moment by moment.
//!
//! Those of the first moment are 32-bit floats, from 0 to 1 along the longest side of the box: all first
//! bytes, then all second ones, and so on, since bytes of one kind are alike and pack well. Those of the
//! moments after it are points of a lattice of 65,536 steps, and only how far each is off from where it would
//! be if it had moved as the one before it did is written: in a film, vertices of a mesh lie nearly in order. That is folded as in [`super::codec`], and of all moments
//! the lowest bytes come first, then the middle and the highest.

use tearmesh::Point;
use tearmesh::geometry::max_abs;

use super::codec::folded;
use crate::bounds::Bounds;

/// The steps of the lattice along the longest side of the box.
const STEPS: f64 = 65536.0;

/// The lattice of the places of a page.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    pub(super) origin: Point,
    pub(super) side: f64,
}

impl Lattice {
    /// The lattice of a box.
    pub(super) fn round(bounds: &Bounds) -> Lattice {
        let side = max_abs(bounds.most - bounds.least);
        Lattice {
            origin: bounds.least,
            // What is a point has no side, and any will do.
            side: if side > 0.0 { side } else { 1.0 },
        }
    }

    /// From 0 to 1 in the box.
    fn part(&self, p: Point) -> [f64; 3] {
        ((p - self.origin) / self.side).into()
    }
}

/// The nearest point of the lattice.
fn steps(part: [f64; 3]) -> [i32; 3] {
    part.map(|x| (x * STEPS).round() as i32)
}

/// Writes moments: the points of all vertices, and the corners of the faces.
pub(super) fn write<'m>(
    moments: impl Iterator<Item = (&'m [Point], &'m [u32])>,
    lattice: &Lattice,
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let (mut left, mut was) = (Vec::new(), Vec::new());
    for (number, (points, corners)) in moments.enumerate() {
        let is_shown = shown(corners, points.len());
        // Where a vertex is that no face has is told by nobody, and must not cost anything.
        let places = points.iter().zip(&is_shown);
        let places = places.map(|(&p, &is_shown)| if is_shown { p } else { lattice.origin });
        let parts: Vec<[f64; 3]> = places.map(|p| lattice.part(p)).collect();
        if number == 0 {
            let parts: Vec<[f32; 3]> = parts.iter().map(|part| part.map(|x| x as f32)).collect();
            bytes = floats(&parts);
            // Whoever reads them begins with what they were rounded to.
            let rounded = parts.iter().map(|part| steps(part.map(f64::from)));
            was = rounded.collect();
            continue;
        }
        let now: Vec<[i32; 3]> = parts.into_iter().map(steps).collect();
        left.extend((0..3).flat_map(|axis| unexpected(axis, &was, &now)));
        was = now;
    }
    for shift in [0, 8, 16] {
        bytes.extend(left.iter().map(|&x| (x >> shift) as u8));
    }
    bytes
}

/// How far each vertex moved along an axis, less how far the one before it did, folded.
fn unexpected(axis: usize, was: &[[i32; 3]], now: &[[i32; 3]]) -> Vec<u32> {
    // What is born now comes from the corner of the box.
    let was = was.iter().map(|was| was[axis]).chain(std::iter::repeat(0));
    let mut before = 0;
    let off = now.iter().zip(was).map(|(now, was)| {
        let moved = now[axis] - was;
        folded(i64::from(moved - std::mem::replace(&mut before, moved))) as u32
    });
    off.collect()
}

/// Numbers from 0 to 1 as 32-bit floats: their first bytes, each axis by itself, and so on.
fn floats(parts: &[[f32; 3]]) -> Vec<u8> {
    let axes = (0..3).flat_map(|axis| parts.iter().map(move |part| part[axis]));
    let all: Vec<[u8; 4]> = axes.map(f32::to_le_bytes).collect();
    let bytes = (0..4).flat_map(|byte| all.iter().map(move |float| float[byte]));
    bytes.collect()
}

/// Whether any face has each vertex.
fn shown(corners: &[u32], vertices: usize) -> Vec<bool> {
    let mut shown = vec![false; vertices];
    for &v in corners {
        shown[v as usize] = true;
    }
    shown
}

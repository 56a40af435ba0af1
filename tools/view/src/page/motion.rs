//! Where the vertices are, moment by moment.
//!
//! Those of the first moment are 32-bit floats, from 0 to 1 along the longest side of the box: all first
//! bytes, then all second ones, and so on, since bytes of one kind are alike and pack well. Those of the
//! moments after it are points of a lattice of 65,536 steps, and only how far each is off from where it would
//! be if it had moved as a neighbour did is written. That is folded as in [`super::codec`], and of all moments
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
        let neighbours = neighbours(corners, points.len());
        left.extend((0..3).flat_map(|axis| unexpected(axis, &was, &now, &neighbours)));
        was = now;
    }
    for shift in [0, 8, 16] {
        bytes.extend(left.iter().map(|&x| (x >> shift) as u8));
    }
    bytes
}

/// How far each vertex is along an axis from where it would be if it had moved as its neighbour did, folded.
fn unexpected(axis: usize, was: &[[i32; 3]], now: &[[i32; 3]], neighbours: &[u32]) -> Vec<u32> {
    let pairs = neighbours.iter().zip(0..);
    let off = pairs.map(|(&beside, v): (&u32, usize)| {
        // What is born now is hardly far from its neighbour.
        let start = |u: usize| if v < was.len() { was[u][axis] } else { 0 };
        let moved = |u: usize| now[u][axis] - start(u);
        let beside = beside as usize;
        moved(v) - if beside == v { 0 } else { moved(beside) }
    });
    off.map(|off| folded(i64::from(off)) as u32).collect()
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

/// Of each vertex, a vertex with a smaller number that shares an edge with it: the first that the faces
/// name. None has itself.
fn neighbours(corners: &[u32], vertices: usize) -> Vec<u32> {
    let mut neighbours: Vec<u32> = (0..vertices as u32).collect();
    for face in corners.as_chunks::<3>().0 {
        for i in 0..3 {
            for other in [face[(i + 1) % 3], face[(i + 2) % 3]] {
                let v = face[i];
                if other < v && neighbours[v as usize] == v {
                    neighbours[v as usize] = other;
                }
            }
        }
    }
    neighbours
}

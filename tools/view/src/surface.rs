//! Which face is seen where: a buffer of depths, a band of rows at a time.
//!
//! Faces are not clipped. A line of sight (x, y, 1) meets a face if it passes all three of its edges on
//! the same side, which three determinants tell, linear in x and y (Olano and Greer, "Triangle scan
//! conversion using 2D homogeneous coordinates", 1997); so do faces that reach behind the eye. The
//! determinant of an edge is that of the face beside it turned over, to the bit: no line of sight passes
//! between two faces.

use std::ops::Range;

use tearmesh::Vector;
use tearmesh::geometry::{cross, dot};

/// The lines of sight of a picture: a lattice of them in each pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    /// Lines across and down.
    pub(crate) columns: usize,
    pub(crate) rows: usize,
}

impl Lattice {
    /// `side` × `side` lines in each pixel.
    pub(crate) fn new(width: u32, height: u32, side: u32) -> Lattice {
        Lattice {
            columns: width as usize * side as usize,
            rows: height as usize * side as usize,
        }
    }

    /// The line of sight.
    pub(crate) fn sight(self, column: usize, row: usize) -> Vector {
        Vector::new(
            (2.0 * column as f64 + 1.0) / self.columns as f64 - 1.0,
            1.0 - (2.0 * row as f64 + 1.0) / self.rows as f64,
            1.0,
        )
    }

    /// Where a point in front of the eye is seen, in columns and rows; the middle of the first is at ½.
    pub(crate) fn place(self, seen: Vector) -> [f64; 2] {
        [
            (seen.x / seen.z + 1.0) / 2.0 * self.columns as f64,
            (1.0 - seen.y / seen.z) / 2.0 * self.rows as f64,
        ]
    }
}

/// A face in front of the eye, ready for lines of sight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facing {
    /// A line of sight is on this side of the edge opposite to each corner if the product is not
    /// negative.
    inward: [Vector; 3],
    /// The volume that the corners span with the eye; positive.
    volume: f64,
    pub(crate) is_front: bool,
}

impl Facing {
    /// The face with these corners; none if it is seen edge-on, or is behind the eye.
    pub(crate) fn new(corners: [Vector; 3]) -> Option<Facing> {
        let [a, b, c] = corners;
        if corners.iter().all(|corner| corner.z <= 0.0) {
            return None;
        }
        let across = [cross(b, c), cross(c, a), cross(a, b)];
        let volume = dot(a, across[0]);
        // Right, up and away from the eye are a left-handed system.
        let is_front = volume > 0.0;
        let is_seen = volume.is_finite() && volume != 0.0;
        is_seen.then(|| Facing {
            inward: across.map(|side| if is_front { side } else { -side }),
            volume: volume.abs(),
            is_front,
        })
    }

    /// How near a line of sight meets the face: one divided by how far in front of the eye it is. None if it
    /// does not.
    pub(crate) fn nearness(&self, sight: Vector) -> Option<f64> {
        let [a, b, c] = self.inward.map(|side| dot(side, sight));
        let sum = a + b + c;
        (a >= 0.0 && b >= 0.0 && c >= 0.0 && sum > 0.0).then(|| sum / self.volume)
    }

    /// The weights of the corners there, up to a common factor.
    pub(crate) fn weights(&self, sight: Vector) -> [f64; 3] {
        self.inward.map(|side| dot(side, sight).max(0.0))
    }
}

/// What is seen along the lines of sight of some rows.
#[derive(Debug)]
pub(crate) struct Surface {
    pub(crate) rows: Range<usize>,
    columns: usize,
    nearness: Vec<f64>,
    /// The face, or [`NOTHING`].
    faces: Vec<u32>,
}

const NOTHING: u32 = u32::MAX;

impl Surface {
    /// Looks at faces whose points are seen there ([`crate::Camera::seen`]). Of faces that are equally near, the
    /// first one is seen.
    pub(crate) fn of(
        faces: &[[u32; 3]],
        seen: &[Vector],
        lattice: Lattice,
        rows: Range<usize>,
    ) -> Surface {
        let count = lattice.columns * rows.len();
        let mut surface = Surface {
            rows,
            columns: lattice.columns,
            nearness: vec![0.0; count],
            faces: vec![NOTHING; count],
        };
        for (number, corners) in faces.iter().enumerate() {
            let corners = corners.map(|v| seen[v as usize]);
            surface.add(number as u32, corners, lattice);
        }
        surface
    }

    fn add(&mut self, number: u32, corners: [Vector; 3], lattice: Lattice) {
        let extent = extent(corners, lattice, &self.rows);
        let Some(([columns, rows], face)) = extent.zip(Facing::new(corners)) else {
            return;
        };
        for row in rows {
            let first = (row - self.rows.start) * self.columns;
            for column in columns.clone() {
                let nearness = face.nearness(lattice.sight(column, row));
                let at = first + column;
                if let Some(nearness) = nearness.filter(|&near| near > self.nearness[at]) {
                    (self.nearness[at], self.faces[at]) = (nearness, number);
                }
            }
        }
    }

    /// The index of the face that is seen.
    pub(crate) fn face(&self, column: usize, row: usize) -> Option<usize> {
        let face = self.faces[(row - self.rows.start) * self.columns + column];
        (face != NOTHING).then_some(face as usize)
    }

    /// How near the farthest surface is that is seen next to a place in columns and rows: zero where
    /// there is nothing, none outside.
    pub(crate) fn farthest_near(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let around = |at: f64, end: Range<usize>| {
            let at = at.floor();
            let from = (at - 1.0).max(end.start as f64) as usize;
            let to = (at + 2.0).clamp(0.0, end.end as f64) as usize;
            from..to
        };
        let columns = around(x, 0..self.columns);
        let near = around(y, self.rows.clone()).flat_map(|row| {
            let first = (row - self.rows.start) * self.columns;
            columns.clone().map(move |column| first + column)
        });
        near.map(|at| self.nearness[at]).reduce(f64::min)
    }
}

/// The columns and rows in which a face may be seen.
fn extent(
    corners: [Vector; 3],
    lattice: Lattice,
    rows: &Range<usize>,
) -> Option<[Range<usize>; 2]> {
    let all = [0..lattice.columns, rows.clone()];
    if corners.iter().any(|corner| corner.z <= 0.0) {
        return corners.iter().any(|corner| corner.z > 0.0).then_some(all);
    }
    let places = corners.map(|corner| lattice.place(corner));
    let [columns, rows] = [0, 1].map(|axis| {
        let [a, b, c] = places.map(|place| place[axis]);
        // A line more at each side, for rounding. Casts bring what is outside to the edge.
        let from = (a.min(b).min(c) - 1.0).floor().max(0.0) as usize;
        let to = (a.max(b).max(c) + 1.0).ceil().max(0.0) as usize;
        from.max(all[axis].start)..to.min(all[axis].end)
    });
    (!columns.is_empty() && !rows.is_empty()).then_some([columns, rows])
}

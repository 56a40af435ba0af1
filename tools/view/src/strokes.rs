//! Lines of one width on a surface.
//!
//! A line is seen where the surface next to it is not in front of it: compared is its own place, not that of
//! each line of sight across its width, and with the farthest of its neighbours. So an edge of a face
//! that is seen is seen at its full width, however slanted its faces are.

use tearmesh::Vector;

use crate::surface::{Lattice, Surface};

/// What a line is, in the order in which they are drawn: later ones cover those before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    Edge,
    Box,
    Boundary,
    /// A thread that hangs out of a tear.
    Thread,
    /// A torn edge whose two sides lie on each other.
    Slit,
    /// A side of a torn edge that gapes.
    Seam,
    Trace,
}

/// A line from one point to another, as they are seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    pub(crate) kind: Kind,
    pub(crate) ends: [Vector; 2],
}

/// The part by which a line may be behind the surface that it lies on, by rounding.
const OFFSET: f64 = 1e-6;

/// The lines that are seen along the lines of sight of some rows.
#[derive(Debug)]
pub(crate) struct Strokes {
    columns: usize,
    kinds: Vec<Option<Kind>>,
}

impl Strokes {
    pub(crate) fn new(surface: &Surface, lattice: Lattice) -> Strokes {
        Strokes {
            columns: lattice.columns,
            kinds: vec![None; lattice.columns * surface.rows.len()],
        }
    }

    /// Draws a line, so many lines of sight wide.
    pub(crate) fn add(&mut self, stroke: Stroke, width: f64, surface: &Surface, lattice: Lattice) {
        let Some(ends) = in_front(stroke.ends) else {
            return;
        };
        let ends = ends.map(|end| [lattice.place(end), [1.0 / end.z; 2]]);
        let Some([[from, [near_from, _]], [to, [near_to, _]]]) = within(ends, lattice, width)
        else {
            return;
        };
        let along = [to[0] - from[0], to[1] - from[1]];
        let square = along[0] * along[0] + along[1] * along[1];
        let radius = width / 2.0;
        let [columns, rows] = [0, 1].map(|axis| {
            span(
                from[axis].min(to[axis]) - radius,
                from[axis].max(to[axis]) + radius,
            )
        });
        for row in rows.start.max(surface.rows.start)..rows.end.min(surface.rows.end) {
            let y = row as f64 + 0.5;
            for column in columns.start..columns.end.min(self.columns) {
                let at = [column as f64 + 0.5, y];
                let off = [at[0] - from[0], at[1] - from[1]];
                // A line without length is a dot.
                let part = match square > 0.0 {
                    true => (off[0] * along[0] + off[1] * along[1]) / square,
                    false => 0.0,
                };
                let part = part.clamp(0.0, 1.0);
                let near = [off[0] - part * along[0], off[1] - part * along[1]];
                if near[0] * near[0] + near[1] * near[1] > radius * radius {
                    continue;
                }
                let nearest = [at[0] - near[0], at[1] - near[1]];
                let nearness = near_from + part * (near_to - near_from);
                let behind = surface.farthest_near(nearest);
                if behind.is_some_and(|surface| nearness >= surface * (1.0 - OFFSET)) {
                    let first = (row - surface.rows.start) * self.columns;
                    self.kinds[first + column] = Some(stroke.kind);
                }
            }
        }
    }

    /// The line that is seen; `index` counts lines of sight row by row.
    pub(crate) fn kind(&self, index: usize) -> Option<Kind> {
        self.kinds[index]
    }
}

/// A place in the lattice, and how near it is (twice, to be interpolated alike).
type Seen = [[f64; 2]; 2];

/// The part of a line in front of the eye. What is nearer than a millionth of the other end is cut off:
/// it would be seen beyond the edges of every picture but for its very direction.
fn in_front([a, b]: [Vector; 2]) -> Option<[Vector; 2]> {
    let least = a.z.max(b.z) * 1e-6;
    if !(least > 0.0 && least.is_finite()) {
        return None;
    }
    let brought = |p: Vector, other: Vector| match p.z < least {
        true => p + (other - p) * ((least - p.z) / (other.z - p.z)),
        false => p,
    };
    Some([brought(a, b), brought(b, a)])
}

/// The part of a line that is within the picture, or less than its width outside.
fn within([a, b]: [Seen; 2], lattice: Lattice, width: f64) -> Option<[Seen; 2]> {
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (axis, end) in [lattice.columns, lattice.rows].into_iter().enumerate() {
        let (start, way) = (a[0][axis], b[0][axis] - a[0][axis]);
        for (depth, change) in [(start + width, way), (end as f64 + width - start, -way)] {
            // Inside where depth + change · t is not negative.
            if change > 0.0 {
                from = from.max(-depth / change);
            } else if change < 0.0 {
                to = to.min(-depth / change);
            } else if depth < 0.0 || depth.is_nan() {
                return None;
            }
        }
    }
    let at = |t: f64| [0, 1].map(|i| [0, 1].map(|j| a[i][j] + t * (b[i][j] - a[i][j])));
    let is_finite = |seen: &Seen| seen.as_flattened().iter().all(|x| x.is_finite());
    let part = [
        if from > 0.0 { at(from) } else { a },
        if to < 1.0 { at(to) } else { b },
    ];
    (from <= to && part.iter().all(is_finite)).then_some(part)
}

/// The lattice lines between two places, and one more at each side for rounding.
fn span(from: f64, to: f64) -> std::ops::Range<usize> {
    (from - 1.5).floor().max(0.0) as usize..(to + 1.5).ceil().max(0.0) as usize
}

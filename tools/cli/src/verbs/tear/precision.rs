//! The precision of a point cache, whose coordinates have 24 bits.

use tearmesh::{Mesh, Point, Positions, Vector};

use crate::measure::Edges;
use crate::say::{Fault, short};

/// The farthest that rounding may move a point, as a part of the mean edge.
const PART: f64 = 1e-3;

/// The origin of a point cache, and how far rounding may move its points.
pub(super) struct Precision {
    pub(super) origin: Vector,
    mean_edge: f64,
}

impl Precision {
    /// That of a cache of this mesh at rest, with the origin that was given.
    pub(super) fn new(origin: Option<Point>, mesh: &Mesh, positions: &Positions) -> Precision {
        Precision {
            origin: origin.unwrap_or_default().coords,
            mean_edge: Edges::of(mesh, positions).mean,
        }
    }

    /// How far rounding moves a point.
    fn moved(&self, p: Point) -> f64 {
        let relative = p - self.origin;
        (relative.coords.map(|x| f64::from(x as f32)) - relative.coords).norm()
    }

    fn is_enough(&self, p: Point) -> bool {
        self.moved(p) <= PART * self.mean_edge
    }

    /// Refuses points that rounding moves too far. Names the worst of them, and an origin that helps.
    pub(super) fn check<I: Iterator<Item = Point>>(
        &self,
        points: impl Fn() -> I,
        name: impl Fn(usize) -> String,
    ) -> Result<(), Fault> {
        if points().all(|p| self.is_enough(p)) {
            return Ok(());
        }
        let numbered = points().map(|p| self.moved(p)).enumerate();
        let worst = numbered.max_by(|(_, one), (_, other)| one.total_cmp(other));
        let (worst, by) = worst.unwrap_or_default();
        let (worst, by, edge) = (name(worst), short(by), short(self.mean_edge));
        let message = format!(
            "the cache would move {worst} by {by}, more than a thousandth of the mean edge, {edge}: its numbers \
             have 32 bits"
        );
        let better = Precision {
            origin: near(&points),
            ..*self
        };
        let [x, y, z] = better.origin.into();
        let help = match points().all(|p| better.is_enough(p)) {
            true => format!("add --cache-origin {x},{y},{z}: points then count from there"),
            false => {
                "no --cache-origin helps, the points are too far apart: use --frames".to_owned()
            }
        };
        Err(Fault::error("E-CACHE-ORIGIN", message).help(help))
    }
}

/// A point near the middle of all, in whole steps of a power of ten that is as large as they extend, and at least 1.
fn near<I: Iterator<Item = Point>>(points: impl Fn() -> I) -> Vector {
    let bounds = [0, 1, 2].map(|axis| {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        points().fold(none, |[least, most], p| {
            [least.min(p[axis]), most.max(p[axis])]
        })
    });
    let extents = bounds.iter().map(|[least, most]| most - least);
    let extent = extents.fold(0.0, f64::max);
    let mut step = 1.0;
    while step < extent {
        step *= 10.0;
    }
    let middle = bounds.map(|[least, most]| least / 2.0 + most / 2.0);
    Vector::from(middle.map(|x| (x / step).round() * step + 0.0))
}

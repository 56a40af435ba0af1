//! The orientation and extent of a mesh as a viewer sees it: which way is up, which way is across,
//! and how large it is.

use tearmesh::Mesh;
use tearmesh::geometry::{Point, Vector, dot};

/// A direction along a coordinate axis, positive or negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// 0, 1 or 2: x, y or z.
    number: usize,
    /// Whether it points to smaller coordinates.
    is_negative: bool,
}

impl Axis {
    /// The positive x-axis.
    pub const X: Axis = Axis::new(0);
    /// The positive y-axis, which is the usual direction up.
    pub const Y: Axis = Axis::new(1);
    /// The positive z-axis, which is the direction up in many programs.
    pub const Z: Axis = Axis::new(2);

    /// The six directions, by their names.
    pub const NAMED: [(&str, Axis); 6] = [
        ("x", Axis::X),
        ("y", Axis::Y),
        ("z", Axis::Z),
        ("-x", Axis::X.opposite()),
        ("-y", Axis::Y.opposite()),
        ("-z", Axis::Z.opposite()),
    ];

    const fn new(number: usize) -> Axis {
        Axis {
            number,
            is_negative: false,
        }
    }

    /// Returns the opposite direction.
    #[must_use]
    pub const fn opposite(self) -> Axis {
        Axis {
            is_negative: !self.is_negative,
            ..self
        }
    }

    /// Returns the unit vector in this direction.
    #[must_use]
    pub fn vector(self) -> Vector {
        let mut vector = Vector::zeros();
        vector[self.number] = if self.is_negative { -1.0 } else { 1.0 };
        vector
    }
}

/// The bounding box of the faces of a mesh, oriented as a viewer sees it.
///
/// *Across* is the longer of the two horizontal axes, and x or y if both have the same length.
/// *Height* runs up. A mesh that lies flat (less than a hundredth as high as it is wide) is seen
/// from above instead, and its height runs along the third axis. A place is given by its fractions
/// of width and height: (0, 0) is the bottom left corner, and (1, 1) the top right one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The direction opposite to gravity.
    pub up: Axis,
    /// The axis from left to right, along which width is measured.
    pub(crate) across: Axis,
    /// The axis from bottom to top, along which height is measured.
    pub along: Axis,
    /// The remaining axis, perpendicular to width and height. It points toward the viewer or away.
    pub(crate) depth: Axis,
    /// The corner of the bounding box from which width, height and depth are measured.
    pub(crate) corner: Point,
    /// The extents of the box along `across`, `along` and `depth`, in metres.
    pub(crate) extents_m: [f64; 3],
}

impl Frame {
    /// Returns the frame of the faces of a mesh whose vertices are at these points. Takes linear
    /// time.
    #[must_use]
    pub fn new(mesh: &Mesh, points: &[Point], up: Axis) -> Frame {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for v in mesh.vertices().filter(|&v| mesh.half_edge_of(v).is_some()) {
            let point = points[v.index()];
            for i in 0..3 {
                low[i] = low[i].min(point[i]);
                high[i] = high[i].max(point[i]);
            }
        }
        let extent = |axis: Axis| (high[axis.number] - low[axis.number]).max(0.0);
        let level = [[Axis::Y, Axis::Z], [Axis::X, Axis::Z], [Axis::X, Axis::Y]];
        let [mut across, mut other] = level[up.number];
        if extent(other) > extent(across) {
            std::mem::swap(&mut across, &mut other);
        }
        let is_flat = extent(up) < 0.01 * extent(across);
        let (along, depth) = if is_flat { (other, up) } else { (up, other) };
        let mut corner = Point::origin();
        for axis in [across, along, depth] {
            let ends = if axis.is_negative { high } else { low };
            let end = ends[axis.number];
            corner[axis.number] = if end.is_finite() { end } else { 0.0 };
        }
        Frame {
            up,
            across,
            along,
            depth,
            corner,
            extents_m: [across, along, depth].map(extent),
        }
    }

    /// Returns the longer of width and height, in metres.
    #[must_use]
    pub fn size_m(&self) -> f64 {
        self.extents_m[0].max(self.extents_m[1])
    }

    /// Returns the place of a point, as fractions of width and height from the bottom left corner.
    /// A fraction is 0 along an axis without extent.
    pub(crate) fn parts(&self, point: Point) -> [f64; 2] {
        let d = point - self.corner;
        let part = |axis: Axis, extent: f64| {
            let distance = dot(axis.vector(), d);
            if extent > 0.0 { distance / extent } else { 0.0 }
        };
        let [width, height, _] = self.extents_m;
        [part(self.across, width), part(self.along, height)]
    }

    /// Returns the point at these fractions of width, height and depth.
    #[must_use]
    pub fn point(&self, parts: [f64; 3]) -> Point {
        let [across, along, depth] = [0, 1, 2].map(|i| parts[i] * self.extents_m[i]);
        self.corner
            + self.across.vector() * across
            + self.along.vector() * along
            + self.depth.vector() * depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tearmesh::shapes;

    fn frame(map: impl Fn(Point) -> [f64; 3], up: Axis) -> Frame {
        let (mesh, positions) = shapes::grid(4, 2);
        let points: Vec<Point> = positions
            .as_slice()
            .iter()
            .map(|&p| map(p).into())
            .collect();
        Frame::new(&mesh, &points, up)
    }

    #[test]
    fn a_sheet_is_seen_upright_however_it_lies() {
        let (_, positions) = shapes::grid(4, 2);
        let width = positions.as_slice()[4].x;
        let height = positions.as_slice()[14].y;
        for (frame, across, along) in [
            (frame(|p| [p.x, p.y, 0.0], Axis::Y), Axis::X, Axis::Y),
            (frame(|p| [p.x, 0.0, p.y], Axis::Z), Axis::X, Axis::Z),
            (frame(|p| [0.0, p.x, p.y], Axis::Z), Axis::Y, Axis::Z),
            // Lying flat: seen from above.
            (frame(|p| [p.x, 0.0, p.y], Axis::Y), Axis::X, Axis::Z),
            (frame(|p| [p.x, p.y, 0.0], Axis::Z), Axis::X, Axis::Y),
        ] {
            assert_eq!((frame.across, frame.along), (across, along));
            assert_eq!(frame.extents_m, [width, height, 0.0]);
            assert_eq!(frame.parts(frame.point([0.25, 0.75, 0.0])), [0.25, 0.75]);
        }
        let hanging_down = frame(|p| [p.x, p.y, 0.0], Axis::Y.opposite());
        assert_eq!(hanging_down.parts(Point::new(0.0, height, 0.0)), [0.0, 0.0]);
    }
}

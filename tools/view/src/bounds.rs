//! The box round all faces.

use tearmesh::geometry::{dot, length};
use tearmesh::{Mesh, Place, Point, Ray};

/// The smallest box around the faces of a mesh whose sides are parallel to the coordinate axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    /// The corner with the smallest coordinates.
    pub(crate) least: Point,
    /// The corner with the largest coordinates.
    pub(crate) most: Point,
}

impl Bounds {
    /// Returns the box around the faces of a mesh, or `None` if the mesh has no face. Vertices without a
    /// face do not count.
    pub(crate) fn of(mesh: &Mesh, place: &(impl Place + ?Sized)) -> Option<Bounds> {
        let with_face = mesh.vertices().filter(|&v| mesh.half_edge_of(v).is_some());
        Bounds::around(with_face.map(|v| place.at(v)))
    }

    /// Returns the box around points, or `None` if there are no points.
    pub(crate) fn around(points: impl IntoIterator<Item = Point>) -> Option<Bounds> {
        let boxes = points.into_iter().map(|p| Bounds { least: p, most: p });
        let of = |a: Point, b: Point, end: fn(f64, f64) -> f64| {
            // Adding zero turns −0 into 0.
            Point::from(a.coords.zip_map(&b.coords, |x, y| end(x, y) + 0.0))
        };
        boxes.reduce(|a, b| Bounds {
            least: of(a.least, b.least, f64::min),
            most: of(a.most, b.most, f64::max),
        })
    }

    /// Returns the end points of the twelve edges of the box.
    pub(crate) fn edges(&self) -> impl Iterator<Item = [Point; 2]> {
        let ends = [self.least, self.most];
        let corner =
            move |bits: usize| Point::from([0, 1, 2].map(|axis| ends[bits >> axis & 1][axis]));
        let pairs = (0..8).flat_map(|bits| [1, 2, 4].map(|axis| (bits, axis)));
        let upward = pairs.filter(|(bits, axis)| bits & axis == 0);
        upward.map(move |(bits, axis)| [corner(bits), corner(bits | axis)])
    }

    /// A point of a ray beyond the box; none if the whole box is behind its origin.
    pub(crate) fn beyond(&self, ray: &Ray) -> Option<Point> {
        let direction = ray.direction() / length(ray.direction());
        let middle = self.least + (self.most - self.least) / 2.0;
        let half = length(self.most - self.least) / 2.0;
        let far = dot(middle - ray.origin(), direction) + half;
        (far > 0.0).then(|| ray.origin() + direction * far)
    }
}

//! The aims of rays on a surface, and the places beyond them, in plain formulas.

use super::straight::{Surface, cross, dot, length, minus, on_the_way};

type Point = [f64; 3];

/// A ray: its origin and its direction.
pub(crate) type Line = (Point, Point);

/// The nearest point at which a ray meets a triangle of a surface (Möller and Trumbore 1997), by weights
/// of the corners that are no less than `least`: what is less than zero by rounding has met an edge.
pub(crate) fn aimed((origin, along): Line, mesh: &Surface, least: f64) -> Option<Point> {
    let mut nearest = f64::INFINITY;
    for face in &mesh.faces {
        let [a, b, c] = face.map(|v| mesh.points[v as usize]);
        let (ab, ac) = (minus(b, a), minus(c, a));
        let across = cross(along, ac);
        let whole = dot(ab, across);
        let from = minus(origin, a);
        let u = dot(from, across) / whole;
        let turned = cross(from, ab);
        let (v, t) = (dot(along, turned) / whole, dot(ac, turned) / whole);
        if u >= least && v >= least && 1.0 - u - v >= least && t > 0.0 {
            nearest = nearest.min(t);
        }
    }
    let at = on_the_way(origin, [0, 1, 2].map(|i| origin[i] + along[i]), nearest);
    nearest.is_finite().then_some(at)
}

/// The point of a line that is nearest to another point.
pub(crate) fn foot((origin, along): Line, p: Point) -> Point {
    let t = dot(minus(p, origin), along) / dot(along, along);
    [0, 1, 2].map(|i| origin[i] + t * along[i])
}

/// How far a point is beyond one of two rays: seen from the other, and along the line through the points
/// of both that are nearest to it.
pub(crate) fn beyond([a, b]: [Line; 2], p: Point) -> f64 {
    let feet = [foot(a, p), foot(b, p)];
    let way = minus(feet[1], feet[0]);
    let size = length(way);
    if size == 0.0 {
        return length(minus(p, feet[0]));
    }
    let along = dot(minus(p, feet[0]), way) / size;
    (-along).max(along - size).max(0.0)
}

/// The distance of a point from a segment.
pub(crate) fn distance([from, to]: [Point; 2], p: Point) -> f64 {
    let way = minus(to, from);
    let t = dot(minus(p, from), way) / dot(way, way);
    length(minus(p, on_the_way(from, to, t.clamp(0.0, 1.0))))
}

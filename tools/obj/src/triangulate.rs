//! Polygons to triangles.
//!
//! A polygon of n corners gives n − 2 triangles whatever its shape. If those from its first corner
//! face the viewer and none is thin, they are taken: so a convex quad becomes (0, 1, 2), (0, 2, 3),
//! as everywhere. Otherwise ears are cut off, and then diagonals are flipped where that makes the
//! smallest angle of their two triangles larger (Lawson 1977). Of all triangulations of a simple polygon
//! in a plane that gives the one with the largest smallest angle, so no face is without area where
//! another way has none.
//!
//! Last, quads whose diagonal is an edge elsewhere are cut the other way (`quads.rs`).

mod ears;
mod quads;

use tearmesh::{Point, Vector};

use self::ears::{Clipper, enlarge_angles, flatten, largest};
use self::quads::avoid_edges;
use crate::polygons::Polygons;

/// A triangle is thin if the sine of its smallest angle is less. Six digits leave a millionth of a
/// face as large as a unit, and a thousandth of one that is a thousandth of it.
const THIN: f64 = 1e-3;

/// The triangles of all polygons, where not all are triangles.
pub(crate) fn triangles(polygons: &Polygons, positions: &[Point]) -> Vec<[u32; 3]> {
    let count = polygons.vertices.len() - 2 * polygons.len();
    let mut triangles = Vec::with_capacity(count);
    let (mut places, mut cut) = (Vec::new(), Vec::new());
    let place = |triangle: [u32; 3]| triangle.map(|v| positions[v as usize]);
    for polygon in 0..polygons.len() {
        let vertices = &polygons.vertices[polygons.corners(polygon)];
        match *vertices {
            [a, b, c] => {
                triangles.push([a, b, c]);
                continue;
            }
            // Nearly all others; without this arm, a file of quads takes a third longer to read.
            [a, b, c, d] if is_good([[a, b, c], [a, c, d]].into_iter().map(place)) => {
                triangles.extend([[a, b, c], [a, c, d]]);
                continue;
            }
            _ => {}
        }
        places.clear();
        places.extend(vertices.iter().map(|&vertex| positions[vertex as usize]));
        cut.clear();
        cut.extend((2..places.len() as u16).map(|last| [0, last - 1, last]));
        let at = |triangle: [u16; 3]| triangle.map(|corner| places[usize::from(corner)]);
        if !is_good(cut.iter().copied().map(at)) {
            let flat = flatten(&places);
            Clipper::new(&flat).clip(&mut cut);
            enlarge_angles(&flat, |triangle| smallest_angle(at(triangle)), &mut cut);
        }
        let vertex = |corner: u16| vertices[usize::from(corner)];
        triangles.extend(cut.iter().map(|triangle| triangle.map(vertex)));
    }
    assert_eq!(
        triangles.len(),
        count,
        "a polygon of n corners has n − 2 triangles"
    );
    avoid_edges(&mut triangles, polygons, positions);
    triangles
}

/// Whether triangles of a polygon all face the viewer, and none is thin, so that the sign of an area is
/// sure.
#[inline(always)]
fn is_good(triangles: impl Iterator<Item = [Point; 3]> + Clone) -> bool {
    let normals = triangles.clone().map(|[a, b, c]| (b - a).cross(&(c - a)));
    let sum = normals
        .clone()
        .fold(Vector::zeros(), |sum, normal| sum + normal);
    let axis = largest(sum);
    let mut areas = normals.map(|normal| normal[axis]);
    let first = areas.clone().next().unwrap_or(0.0);
    areas.all(|area| area * first > 0.0) && { triangles }.all(|triangle| !is_thin(triangle))
}

/// The squares of twice the area of a triangle, and of the product of its two longer sides, between
/// which its smallest angle lies.
#[inline]
fn squares([a, b, c]: [Point; 3]) -> [f64; 2] {
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let [p, q, r] = [ab, ac, bc].map(|side| side.norm_squared());
    let sides = (p * q).max(q * r).max(r * p);
    [ab.cross(&ac).norm_squared(), sides]
}

#[inline]
fn is_thin(triangle: [Point; 3]) -> bool {
    let [doubled_area, sides] = squares(triangle);
    let is_wide = doubled_area > THIN * THIN * sides;
    !is_wide // So is one whose squares are no numbers.
}

/// The square of the sine of the smallest angle of a triangle.
fn smallest_angle(triangle: [Point; 3]) -> f64 {
    let [doubled_area, sides] = squares(triangle);
    let sine = doubled_area / sides;
    if sine.is_nan() { 0.0 } else { sine }
}

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

use tearmesh::Point;

use self::ears::{Clipper, enlarge_angles, faces_viewer, flatten, largest};
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
    for polygon in 0..polygons.len() {
        let vertices = &polygons.vertices[polygons.corners(polygon)];
        match *vertices {
            [a, b, c] => {
                triangles.push([a, b, c]);
                continue;
            }
            // Nearly all others; without this arm, a file of quads takes a third longer to read.
            [a, b, c, d] if quad_is_good([a, b, c, d].map(|v| positions[v as usize])) => {
                triangles.extend([[a, b, c], [a, c, d]]);
                continue;
            }
            _ => {}
        }
        places.clear();
        places.extend(vertices.iter().map(|&vertex| positions[vertex as usize]));
        cut.clear();
        cut.extend((2..places.len() as u16).map(|last| [0, last - 1, last]));
        if !is_good(&places, &cut) {
            let flat = flatten(&places);
            Clipper::new(&flat).clip(&mut cut);
            let angle = |triangle: [u16; 3]| smallest_angle(at(&places, triangle));
            enlarge_angles(&flat, angle, &mut cut);
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

fn at(places: &[Point], triangle: [u16; 3]) -> [Point; 3] {
    triangle.map(|corner| places[usize::from(corner)])
}

/// Whether the triangles of a quad from its first corner are good: what [`is_good`] says, with each
/// normal worked out once.
#[inline]
fn quad_is_good([a, b, c, d]: [Point; 4]) -> bool {
    let (ab, ac, ad) = (b - a, c - a, d - a);
    let normals @ [one, other] = [ab.cross(&ac), ac.cross(&ad)];
    let axis = largest(one + other);
    let [p, q, r] = [ab, ac, ad].map(|side| side.norm_squared());
    let [bc, cd] = [c - b, d - c].map(|side| side.norm_squared());
    let sides = [
        (p * q).max(q * bc).max(bc * p),
        (q * r).max(r * cd).max(cd * q),
    ];
    let is_wide = |i: usize| normals[i].norm_squared() > THIN * THIN * sides[i];
    one[axis] * other[axis] > 0.0 && is_wide(0) && is_wide(1)
}

/// Whether triangles of a polygon all face the viewer, and none is thin.
fn is_good(places: &[Point], triangles: &[[u16; 3]]) -> bool {
    let all = triangles.iter().map(|&triangle| at(places, triangle));
    faces_viewer(all.clone()) && { all }.all(|triangle| !is_thin(triangle))
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

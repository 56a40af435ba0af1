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

use self::ears::{cut_into_ears, enlarge_angles, faces_viewer, flatten};
use self::quads::avoid_edges;
use crate::polygons::Polygons;

/// A triangle is thin if the sine of its smallest angle is less. Six digits leave a millionth of a
/// face as large as a unit, and a thousandth of one that is a thousandth of it.
const THIN: f64 = 1e-3;

/// The triangles of all polygons, where not all are triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Triangulation {
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Which corners of its polygon each triangle has.
    pub(crate) corners: Vec<[u16; 3]>,
}

impl Triangulation {
    pub(crate) fn of(polygons: &Polygons, positions: &[Point]) -> Triangulation {
        let count = polygons.vertices.len() - 2 * polygons.len();
        let mut triangles = Vec::with_capacity(count);
        let mut corners = Vec::with_capacity(count);
        let (mut places, mut cut) = (Vec::new(), Vec::new());
        for polygon in 0..polygons.len() {
            let vertices = &polygons.vertices[polygons.corners(polygon)];
            places.clear();
            places.extend(vertices.iter().map(|&vertex| positions[vertex as usize]));
            cut.clear();
            cut.extend((2..places.len() as u16).map(|last| [0, last - 1, last]));
            if places.len() > 3 && !is_good(&places, &cut) {
                let flat = flatten(&places);
                cut_into_ears(&flat, &mut cut);
                let angle = |triangle: [u16; 3]| smallest_angle(at(&places, triangle));
                enlarge_angles(&flat, angle, &mut cut);
            }
            for &triangle in &cut {
                corners.push(triangle);
                triangles.push(triangle.map(|corner| vertices[usize::from(corner)]));
            }
        }
        assert_eq!(
            triangles.len(),
            count,
            "a polygon of n corners has n − 2 triangles"
        );
        let mut triangulation = Triangulation { triangles, corners };
        avoid_edges(&mut triangulation, polygons, positions);
        triangulation
    }
}

fn at(places: &[Point], triangle: [u16; 3]) -> [Point; 3] {
    triangle.map(|corner| places[usize::from(corner)])
}

/// Whether triangles of a polygon all face the viewer, and none is thin.
#[inline]
fn is_good(places: &[Point], triangles: &[[u16; 3]]) -> bool {
    let all = triangles.iter().map(|&triangle| at(places, triangle));
    faces_viewer(all.clone()) && { all }.all(|triangle| smallest_angle(triangle) > THIN * THIN)
}

/// The square of the sine of the smallest angle of a triangle.
#[inline]
fn smallest_angle([a, b, c]: [Point; 3]) -> f64 {
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let doubled_area = ab.cross(&ac).norm_squared();
    let [p, q, r] = [ab, ac, bc].map(|side| side.norm_squared());
    // It lies between the two longer sides.
    let sine = doubled_area / (p * q).max(q * r).max(r * p);
    if sine.is_nan() { 0.0 } else { sine }
}

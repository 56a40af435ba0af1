//! Polygons to triangles.
//!
//! A polygon of n corners gives n − 2 triangles whatever its shape. Each is cut by itself
//! (`ears.rs`); where that leaves a face without area to speak of, and another way does not, it is
//! cut that way (`thin.rs`). Then diagonals that collide with other edges are flipped (`flip.rs`).

mod corners;
mod ears;
mod flip;
mod thin;

use tearmesh::Point;

use self::corners::Corners;
use self::ears::{cut_into_triangles, flatten, quad_is_fan};
use self::flip::flip_colliding;
use self::thin::{is_thin, thicken};
use crate::polygons::Polygons;

/// Whether a quad is cut from its first corner without further thought.
#[inline]
fn quad_is_good_fan(quad: [Point; 4]) -> bool {
    let [a, b, c, d] = quad;
    quad_is_fan(quad) && !is_thin([a, b, c]) && !is_thin([a, c, d])
}

/// The triangles of all polygons, where not all are triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Triangulation {
    triangles: Vec<[u32; 3]>,
    corners: Corners,
}

impl Triangulation {
    pub(crate) fn of(polygons: &Polygons, positions: &[Point]) -> Triangulation {
        let count = polygons.vertices.len() - 2 * polygons.len();
        let mut corners = Corners::default();
        let mut triangles = Vec::with_capacity(count);
        let (mut flat, mut cut) = (Vec::new(), Vec::new());
        for polygon in 0..polygons.len() {
            let vertices = &polygons.vertices[polygons.corners(polygon)];
            match *vertices {
                [a, b, c] => {
                    corners.push_fan(1);
                    triangles.push([a, b, c]);
                    continue;
                }
                // Nearly all others.
                [a, b, c, d] if quad_is_good_fan([a, b, c, d].map(|v| positions[v as usize])) => {
                    corners.push_fan(2);
                    triangles.extend([[a, b, c], [a, c, d]]);
                    continue;
                }
                _ => {}
            }
            flatten(vertices, positions, &mut flat);
            cut.clear();
            cut_into_triangles(&flat, &mut cut);
            let place = |corner: u16| positions[vertices[usize::from(corner)] as usize];
            thicken(&flat, place, &mut cut);
            corners.keep_each(count, polygons, polygon);
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
        flip_colliding(&mut triangles, &mut corners, polygons, positions);
        Triangulation { triangles, corners }
    }

    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Moves a triangle, the `nth` of its polygon, to an earlier place, as a polygon of its own if
    /// it stands `alone`; the corners of its polygon that it had.
    pub(crate) fn keep(
        &mut self,
        [triangle, nth]: [usize; 2],
        place: usize,
        alone: bool,
    ) -> [u16; 3] {
        let corners = self.corners.get(triangle, nth);
        self.triangles[place] = self.triangles[triangle];
        let own = if alone { [0, 1, 2] } else { corners };
        self.corners.set(place, own);
        corners
    }

    /// Drops all triangles from a place on.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.triangles.truncate(count);
        self.corners.truncate(count);
    }

    /// Gives a corner of a triangle another vertex.
    pub(crate) fn replace(&mut self, triangle: usize, corner: usize, vertex: u32) {
        self.triangles[triangle][corner] = vertex;
    }

    /// The corners of its polygon that a triangle has, the `nth` of it.
    #[inline]
    pub(crate) fn corners(&self, triangle: usize, nth: usize) -> [u16; 3] {
        self.corners.get(triangle, nth)
    }
}

//! Small named meshes for documentation, tests and benchmarks.
//!
//! Each function returns a mesh and the positions of its vertices. Faces are oriented
//! counter-clockwise, seen from +z or from outside.

use crate::geometry::{Point, sine_and_cosine};
use crate::mesh::Mesh;
use crate::place::Positions;

fn made(points: Vec<[f64; 3]>, triangles: &[[u32; 3]]) -> (Mesh, Positions) {
    let mesh = Mesh::build(points.len(), triangles).expect("a named shape is a manifold");
    let positions = Positions::new(points).expect("a named shape has finite coordinates");
    (mesh, positions)
}

/// Creates one triangle in the plane z = 0.
#[must_use]
pub fn triangle() -> (Mesh, Positions) {
    made(
        vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        &[[0, 1, 2]],
    )
}

/// Creates the unit square in the plane z = 0, divided into `columns` × `rows` cells of two
/// triangles. Vertex `(column, row)` has the index `row * (columns + 1) + column`. Each diagonal
/// goes from the lower left corner of its cell to the upper right one.
///
/// # Panics
///
/// If `columns` or `rows` is zero, or there are more cells than a mesh can have.
#[must_use]
pub fn grid(columns: u32, rows: u32) -> (Mesh, Positions) {
    grid_with_diagonals(columns, rows, |_, _| true)
}

/// Creates a unit square in `columns` × `rows` cells of two triangles, numbered as in [`grid`].
/// `rising(column, row)` returns whether the diagonal of a cell rises from left to right.
///
/// # Panics
///
/// If `columns` or `rows` is zero, or there are more cells than a mesh can have.
#[must_use]
pub fn grid_with_diagonals(
    columns: u32,
    rows: u32,
    mut rising: impl FnMut(u32, u32) -> bool,
) -> (Mesh, Positions) {
    assert!(columns > 0 && rows > 0, "a grid has a cell");
    let vertex = |column: u32, row: u32| row * (columns + 1) + column;
    let mut points = Vec::new();
    for row in 0..=rows {
        for column in 0..=columns {
            let (x, y) = (f64::from(column), f64::from(row));
            points.push([x / f64::from(columns), y / f64::from(rows), 0.0]);
        }
    }
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let (a, b) = (vertex(column, row), vertex(column + 1, row));
            let (c, d) = (vertex(column + 1, row + 1), vertex(column, row + 1));
            if rising(column, row) {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    made(points, &triangles)
}

/// Creates a fan of `faces` triangles around the vertex 0: a full disc if `closed` is true, and
/// otherwise a half disc. The other vertices are 1, 2, … in counter-clockwise order, on the unit
/// circle in the plane z = 0.
///
/// # Panics
///
/// If `faces` is zero, or less than three for a closed fan.
#[must_use]
pub fn fan(faces: u32, closed: bool) -> (Mesh, Positions) {
    assert!(faces >= if closed { 3 } else { 1 }, "a fan has faces");
    let rim = if closed { faces } else { faces + 1 };
    let mut points = vec![[0.0; 3]];
    let turn = if closed {
        std::f64::consts::TAU
    } else {
        std::f64::consts::PI
    };
    for i in 0..rim {
        let (y, x) = sine_and_cosine(turn * f64::from(i) / f64::from(faces));
        points.push([x, y, 0.0]);
    }
    made(points, &spokes(faces, rim))
}

/// Creates the surface of a regular tetrahedron, with vertices at (±1, ±1, ±1).
#[must_use]
pub fn tetrahedron() -> (Mesh, Positions) {
    let points = vec![
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    made(points, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
}

/// Creates the surface of a regular octahedron, with vertices at distance 1 on the axes.
#[must_use]
pub fn octahedron() -> (Mesh, Positions) {
    let points = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let triangles = [
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    made(points, &triangles)
}

/// Creates a tube around the z-axis that is open at both ends, like a sleeve. It has `along` rings
/// of `around` cells each.
///
/// # Panics
///
/// If `around` is less than three, or `along` is zero.
#[must_use]
pub fn tube(around: u32, along: u32) -> (Mesh, Positions) {
    assert!(around >= 3 && along > 0, "a tube goes round and along");
    let mut points = Vec::new();
    for ring in 0..=along {
        for i in 0..around {
            let (y, x) = sine_and_cosine(std::f64::consts::TAU * f64::from(i) / f64::from(around));
            points.push([x, y, f64::from(ring) / f64::from(along)]);
        }
    }
    made(points, &ring_cells(around, along, along + 1))
}

/// Creates a torus around the z-axis, with `around` cells along the large circle and `across` cells
/// along the small one.
///
/// # Panics
///
/// If `around` or `across` is less than three.
#[must_use]
pub fn torus(around: u32, across: u32) -> (Mesh, Positions) {
    assert!(around >= 3 && across >= 3, "a torus goes round both ways");
    let mut points = Vec::new();
    for i in 0..across {
        let (height, depth) =
            sine_and_cosine(std::f64::consts::TAU * f64::from(i) / f64::from(across));
        let radius = 1.0 - 0.4 * depth;
        for j in 0..around {
            let (y, x) = sine_and_cosine(std::f64::consts::TAU * f64::from(j) / f64::from(around));
            points.push([radius * x, radius * y, 0.4 * height]);
        }
    }
    made(points, &ring_cells(around, across, across))
}

/// Cells of two triangles between rings of `around` vertices each. With as many rings as
/// rows of cells, the last row closes on the first ring.
fn ring_cells(around: u32, rows: u32, rings: u32) -> Vec<[u32; 3]> {
    let vertex = |i: u32, ring: u32| (ring % rings) * around + i % around;
    let mut triangles = Vec::new();
    for ring in 0..rows {
        for i in 0..around {
            let (a, b) = (vertex(i, ring), vertex(i + 1, ring));
            let (c, d) = (vertex(i + 1, ring + 1), vertex(i, ring + 1));
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

/// Creates a saddle of eight faces around the vertex 0, which the plane z = 0 cuts into four arcs.
/// The ring vertex at the angle 45° k has the height ½ cos(2 · 45° k). Splitting the centre by that
/// plane leaves two bow-ties.
#[must_use]
pub fn saddle() -> (Mesh, Positions) {
    let heights = [0.0, 0.5, 0.0, -0.5, 0.0, 0.5, 0.0, -0.5, 0.0];
    let flat = fan(8, true).1;
    let raised = |(p, z): (&Point, f64)| [p.x, p.y, z];
    let points = flat.as_slice().iter().zip(heights).map(raised).collect();
    made(points, &spokes(8, 8))
}

/// Triangles round the vertex 0, over a rim of vertices from 1 on.
fn spokes(faces: u32, rim: u32) -> Vec<[u32; 3]> {
    (0..faces).map(|i| [0, 1 + i, 1 + (i + 1) % rim]).collect()
}

//! An irregular open sheet in memory: the Delaunay triangles of a jittered grid, waving.

use tearmesh::{Mesh, Point, Positions, Ray, Scissor, Vector};
use tearmesh_cloth::statistics::Random;

/// A mesh, and where its vertices are.
pub(crate) type Sheet = (Mesh, Positions);

/// A square sheet over the unit square, of about so many faces, in the order of its rows. On
/// the border points are even; inside each is off its place by up to 0.4 cells.
pub(crate) fn sheet(faces: usize) -> Sheet {
    let cells = ((faces as f64 / 2.0).sqrt().round() as usize).max(1);
    let mut random = Random::new(1);
    let mut flat = Vec::new();
    for row in 0..=cells {
        for column in 0..=cells {
            let mut place = |i: usize| {
                let jitter = 0.8 * random.next() - 0.4;
                let inside = ![row, column].iter().any(|&i| i == 0 || i == cells);
                (i as f64 + if inside { jitter } else { 0.0 }) / cells as f64
            };
            let (x, y) = (place(column), place(row));
            flat.push(delaunator::Point { x, y });
        }
    }
    let found = delaunator::triangulate(&flat).triangles;
    let mut triangles: Vec<[u32; 3]> = found
        .as_chunks::<3>()
        .0
        .iter()
        .map(|&triangle| in_order(triangle.map(|i| i as u32), &flat))
        .collect();
    triangles.sort_unstable();
    let mesh = Mesh::build(flat.len(), &triangles).expect("Delaunay triangles are a mesh");
    let waving = flat
        .iter()
        .map(|p| [p.x, p.y, 0.1 * (9.0 * p.x + 4.0 * p.y).sin()]);
    (mesh, Positions::new(waving).expect("finite"))
}

/// Counter-clockwise, and from the smallest vertex.
fn in_order([a, b, c]: [u32; 3], flat: &[delaunator::Point]) -> [u32; 3] {
    let [p, q, r] = [a, b, c].map(|i| &flat[i as usize]);
    let area = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    let mut triangle = if area > 0.0 { [a, b, c] } else { [a, c, b] };
    while triangle[0] != a.min(b).min(c) {
        triangle.rotate_left(1);
    }
    triangle
}

/// A cut from above right through the sheet, along a line through a point of it.
pub(crate) fn through(at: [f64; 2], angle: f64) -> Scissor {
    let (sin, cos) = angle.sin_cos();
    let ray = |along: f64| {
        let origin = Point::new(at[0] + along * cos, at[1] + along * sin, 5.0);
        Ray::new(origin, Vector::new(0.0, 0.0, -1.0)).expect("a direction")
    };
    let scissor = Scissor::new(ray(-2.0), ray(2.0)).expect("two lines");
    scissor.through(true)
}

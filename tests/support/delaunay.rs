//! Random points and their Delaunay triangles, the same on every machine.

use super::random::Random;

/// `count` points in the unit square: `border` of them evenly along each side, the others
/// random and at least `apart` from each other. Not as even as a mesher would do it, but
/// without needles.
pub(crate) fn points(count: usize, border: u32, apart: f64, random: &mut Random) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for i in 0..border {
        let along = f64::from(i) / f64::from(border);
        points.extend([
            [along, 0.0],
            [1.0, along],
            [1.0 - along, 1.0],
            [0.0, 1.0 - along],
        ]);
    }
    while points.len() < count {
        let point = [0.01 + 0.98 * random.next(), 0.01 + 0.98 * random.next()];
        if points
            .iter()
            .all(|p| (p[0] - point[0]).hypot(p[1] - point[1]) > apart)
        {
            points.push(point);
        }
    }
    points
}

/// Delaunay triangles by Bowyer and Watson's insertion, counter-clockwise; O(n²).
pub(crate) fn triangles(points: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let n = points.len();
    let mut all = points.to_vec();
    all.extend([[-50.0, -40.0], [50.0, -40.0], [0.5, 60.0]]);
    let mut triangles = vec![[n, n + 1, n + 2]];
    for p in 0..n {
        let (hit, kept): (Vec<_>, Vec<_>) = triangles
            .into_iter()
            .partition(|&t| in_circle(t.map(|i| all[i]), all[p]));
        triangles = kept;
        let edges: Vec<[usize; 2]> = hit
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .collect();
        for &[a, b] in edges.iter().filter(|&&[a, b]| !edges.contains(&[b, a])) {
            triangles.push([a, b, p]);
        }
    }
    // Points in a row on the border leave triangles without area; those go too.
    triangles.retain(|t| t.iter().all(|&i| i < n) && double_area(t.map(|i| all[i])) > 1e-9);
    triangles
}

fn double_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn in_circle(triangle: [[f64; 2]; 3], p: [f64; 2]) -> bool {
    let [a, b, c] = triangle.map(|q| [q[0] - p[0], q[1] - p[1]]);
    let square = |q: [f64; 2]| q[0] * q[0] + q[1] * q[1];
    let minor = |q: [f64; 2], r: [f64; 2]| q[0] * r[1] - q[1] * r[0];
    square(a) * minor(b, c) + square(b) * minor(c, a) + square(c) * minor(a, b) > 0.0
}

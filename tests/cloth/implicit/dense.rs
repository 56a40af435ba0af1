//! Matrices as lists of rows, and naive code for them.

use super::kernels::moved;
use super::{Scene, forces};
use nalgebra::{DMatrix, DVector};
use tearmesh::Vector;
use tearmesh_cloth::System;

type Matrix = Vec<Vec<f64>>;

/// Minus the derivatives of the forces, by differences with Richardson's extrapolation: also of
/// what is held.
pub(super) fn jacobian(system: &System) -> Matrix {
    let mut system = system.clone();
    let n = system.positions().len();
    (0..n).for_each(|i| system.release(i));
    let column = |c: usize| -> Vec<f64> {
        let difference = |h: f64| -> Vec<f64> {
            let [plus, minus] = [h, -h].map(|by| forces(&mut moved(&system, c, by)));
            let pairs = plus.iter().flatten().zip(minus.iter().flatten());
            pairs.map(|(p, m)| (m - p) / (2.0 * h)).collect()
        };
        let pairs = difference(2e-5).into_iter().zip(difference(1e-5));
        pairs
            .map(|(coarse, fine)| (4.0 * fine - coarse) / 3.0)
            .collect()
    };
    (0..3 * n).map(column).collect()
}

/// The second derivatives of springs, bends that are springs, and triangles without what is negative:
/// across a compressed spring or direction of a triangle, and half of a shear (Baraff and Witkin 1998,
/// Choi and Ko 2002).
pub(super) fn clamped(scene: &Scene) -> Matrix {
    assert!(scene.law.is_none(), "bends are springs");
    let mut matrix = vec![vec![0.0; 3 * scene.x.len()]; 3 * scene.x.len()];
    let mut add = |[a, b]: [usize; 2], row: usize, column: usize, value: f64| {
        matrix[3 * a + row][3 * b + column] += value;
    };
    let identity = |row: usize, column: usize| f64::from(u8::from(row == column));
    for &([a, b], rest_m, stiffness) in scene.springs.iter().chain(&scene.bends) {
        let d = scene.x[b] - scene.x[a];
        let (t, across) = (d / d.norm(), (1.0 - rest_m / d.norm()).max(0.0));
        for (row, column) in (0..9).map(|i| (i / 3, i % 3)) {
            let along = t[row] * t[column];
            let part = along + across * (identity(row, column) - along);
            let value = stiffness * part;
            for (ends, sign) in [([a, a], 1.0), ([b, b], 1.0), ([a, b], -1.0), ([b, a], -1.0)] {
                add(ends, row, column, sign * value);
            }
        }
    }
    for &(corners, [p, q, r], [k_u, k_v, k_s]) in &scene.triangles {
        let (e, f) = ([q[0] - p[0], q[1] - p[1]], [r[0] - p[0], r[1] - p[1]]);
        let twice = e[0] * f[1] - e[1] * f[0];
        // How w_u and w_v change with each corner.
        let (g, h) = ([f[1] / twice, -e[1] / twice], [-f[0] / twice, e[0] / twice]);
        let weights = [g, h].map(|[x, y]| [-x - y, x, y]);
        let x = corners.map(|corner| scene.x[corner].coords);
        let [u, v] = weights.map(|w| x[0] * w[0] + x[1] * w[1] + x[2] * w[2]);
        let shear = u.dot(&v);
        let block = |row: usize, column: usize| -> [[f64; 2]; 2] {
            let unit = identity(row, column);
            let along = |w: Vector, k: f64, other: Vector| {
                let t = w / w.norm();
                let across = (1.0 - 1.0 / w.norm()).max(0.0);
                let part = t[row] * t[column] * (1.0 - across) + unit * across;
                k * part + k_s * (other[row] * other[column] + 0.5 * shear.abs() * unit)
            };
            let half = 0.5 * shear * unit;
            let mixed = [v[row] * u[column], u[row] * v[column]].map(|part| k_s * (part + half));
            [[along(u, k_u, v), mixed[0]], [mixed[1], along(v, k_v, u)]]
        };
        for (i, j, row, column) in (0..81).map(|n| (n / 27, n / 9 % 3, n / 3 % 3, n % 3)) {
            let block = block(row, column);
            let part = |m: usize, n: usize| weights[m][i] * weights[n][j] * block[m][n];
            let sum = part(0, 0) + part(0, 1) + part(1, 0) + part(1, 1);
            let ends = [corners[i], corners[j]];
            add(ends, row, column, 0.5 * twice.abs() * sum);
        }
    }
    matrix
}

/// The solution of a dense system of equations.
pub(super) fn solve(a: &[Vec<f64>], b: Vec<f64>) -> Vec<f64> {
    let matrix = DMatrix::from_fn(b.len(), b.len(), |row, column| a[row][column]);
    let solution = matrix.lu().solve(&DVector::from_vec(b));
    solution.expect("it is not singular").as_slice().to_vec()
}

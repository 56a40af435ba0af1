//! Matrices as lists of rows, and naive code for them.

use tearmesh::Vector;
use tearmesh_cloth::System;
use tearmesh_cloth::implicit::{Hessian, Layout};

/// The Hessian as a dense matrix.
pub(super) fn dense(system: &System, clamp: bool) -> (Vec<Vec<f64>>, u64) {
    let (mut layout, mut hessian) = (Layout::default(), Hessian::default());
    layout.follow(system);
    let clamped = layout.hessian(system, clamp, &mut hessian);
    let x = system.positions();
    let n = 3 * x.len();
    let columns = (0..n).map(|c| {
        let mut unit = vec![Vector::zeros(); x.len()];
        unit[c / 3][c % 3] = 1.0;
        let mut column = Vec::new();
        hessian.product(layout.pairs(), &unit, &mut column);
        column.iter().flat_map(|v| [v.x, v.y, v.z]).collect()
    });
    (columns.collect(), clamped)
}

/// Gaussian elimination with pivots: dense, naive.
pub(super) fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for c in 0..n {
        let best = (c..n).max_by(|&i, &j| a[i][c].abs().total_cmp(&a[j][c].abs()));
        let best = best.expect("a row");
        a.swap(c, best);
        b.swap(c, best);
        for r in c + 1..n {
            let factor = a[r][c] / a[c][c];
            subtract(&mut a, r, c, factor);
            b[r] -= factor * b[c];
        }
    }
    for c in (0..n).rev() {
        for k in c + 1..n {
            b[c] -= a[c][k] * b[k];
        }
        b[c] /= a[c][c];
    }
    b
}

/// Whether a Cholesky factor exists: dense, naive.
pub(super) fn is_definite(mut a: Vec<Vec<f64>>) -> bool {
    for c in 0..a.len() {
        if a[c][c] <= 0.0 {
            return false;
        }
        for r in c + 1..a.len() {
            let factor = a[r][c] / a[c][c];
            subtract(&mut a, r, c, factor);
        }
    }
    true
}

/// Row r of a dense matrix less `factor` times row c.
fn subtract(a: &mut [Vec<f64>], r: usize, c: usize, factor: f64) {
    let row = a[c].clone();
    for (x, y) in a[r].iter_mut().zip(row).skip(c) {
        *x -= factor * y;
    }
}

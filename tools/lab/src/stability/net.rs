//! Nets: small nets of springs, and their largest frequency from a dense matrix that shares no code with the
//! methods.

use tearmesh::Point;
use tearmesh_cloth::System;

use crate::pareto::middle;
use crate::sheet::{MeshKind, Sheet, system};

/// A kind of nets: its name in tables, and the function that builds it at rest, of springs of a stiffness in
/// N/m.
pub(super) type NetKind = (&'static str, fn(f64) -> System);

/// All kinds of nets, in the order of tables:
///
/// * a chain of 16 links, held at one end;
/// * the same between two nails, 5 % longer than at rest;
/// * a Delaunay mesh of a square, held by its upper edge;
/// * the same with the mass of its middle particle halved ten times.
pub(super) static NETS: [NetKind; 4] = [
    ("chain", |stiffness| links(1.0, stiffness)),
    ("string", |stiffness| links(1.05, stiffness)),
    ("sheet", |stiffness| sheet(1.0, stiffness)),
    ("halved", |stiffness| sheet(1024.0, stiffness)),
];

/// The number of cells along each side of two-dimensional nets.
const CELLS: u32 = 6;

/// The number of links of one-dimensional nets.
const LINKS: usize = 16;

/// Links in a row, `taut` times as long as at rest. The first particle is held, and the last too if they are
/// taut.
fn links(taut: f64, stiffness: f64) -> System {
    let points = (0..=LINKS).map(|i| Point::new(0.1 * i as f64, 0.0, 0.0));
    let points: Vec<Point> = points.collect();
    let springs = (0..LINKS).map(|i| ([i, i + 1], 0.1 / taut));
    let mut net = system(&points, vec![0.01; LINKS + 1], springs, stiffness);
    net.hold(0);
    if taut > 1.0 {
        net.hold(LINKS);
    }
    net
}

/// A sheet that is held by its upper edge, with the mass of its middle particle divided by a number.
fn sheet(divisor: f64, stiffness: f64) -> System {
    let sheet = Sheet::new(MeshKind::Delaunay, CELLS, 1.0);
    let mut masses = sheet.masses.clone();
    masses[middle(&sheet)] /= divisor;
    let springs = sheet.edges.iter().map(|&ends| (ends, sheet.length_m(ends)));
    let mut net = system(&sheet.points, masses, springs, stiffness);
    let held = (0..sheet.points.len()).filter(|&i| sheet.points[i].y == 1.0);
    held.for_each(|i| net.hold(i));
    net
}

/// Returns the largest frequency of a net with springs of 1 N/m in rad/s: the root of the largest eigenvalue of
/// A = M^-½ K M^-½.
///
/// A number λ is above all eigenvalues if and only if λ − A has a Cholesky factor. So the largest is found by
/// bisection to the last digits, without an iteration that might not converge. The cost is cubic in the number
/// of particles.
pub(super) fn omega_rad_per_s(net: &System) -> f64 {
    let matrix = matrix(net);
    let sums = matrix.iter().map(|row| row.iter().map(|x| x.abs()).sum());
    // Gershgorin's bound, and less than any eigenvalue that counts.
    let mut above: f64 = sums.fold(0.0, f64::max) * (1.0 + 1e-9);
    let mut below = 0.0;
    while above - below > 1e-12 * above {
        let middle = 0.5 * (above + below);
        match is_above(middle, &matrix) {
            true => above = middle,
            false => below = middle,
        }
    }
    above.sqrt()
}

/// M^-½ K M^-½, without the rows and columns of held particles, which are zero. K has the second derivatives
/// of ½ (l − L)², which are n nᵀ + (1 − L/l)(1 − n nᵀ) for a spring along n.
fn matrix(net: &System) -> Vec<Vec<f64>> {
    let (x, masses, springs) = (net.positions(), net.masses(), net.stretches());
    let mut matrix = vec![vec![0.0; 3 * x.len()]; 3 * x.len()];
    for spring in springs.iter().map(|id| springs.get(id)) {
        let [a, b] = spring.ends;
        let length = (x[b] - x[a]).norm();
        let (n, slack) = ((x[b] - x[a]) / length, 1.0 - spring.rest_length_m / length);
        for (p, q, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
            if net.is_held(p) || net.is_held(q) {
                continue;
            }
            let scale = sign / (masses[p] * masses[q]).sqrt();
            for (i, j) in (0..9).map(|at| (at / 3, at % 3)) {
                let unit = if i == j { slack } else { 0.0 };
                let block = unit + (1.0 - slack) * n[i] * n[j];
                matrix[3 * p + i][3 * q + j] += scale * block;
            }
        }
    }
    matrix
}

/// Whether a number is above all eigenvalues of a symmetric matrix.
fn is_above(number: f64, matrix: &[Vec<f64>]) -> bool {
    let mut factor = matrix.to_vec();
    for i in 0..matrix.len() {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| factor[i][k] * factor[j][k]).sum();
            let left = if i == j { number } else { 0.0 } - matrix[i][j] - sum;
            factor[i][j] = match i == j {
                true if left <= 0.0 => return false,
                true => left.sqrt(),
                false => left / factor[j][j],
            };
        }
    }
    true
}

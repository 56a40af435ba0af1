//! Nets: small nets of springs, and their largest frequency from a dense matrix that shares no code with the
//! methods.

use tearmesh::{Point, Vector};
use tearmesh_cloth::System;

use crate::pareto::middle;
use crate::sheet::{MeshKind, Sheet};

/// A net of springs that is at rest without loads.
#[derive(Clone, Debug)]
pub(super) struct Net {
    points: Vec<Point>,
    masses: Vec<f64>,
    /// The ends of each spring, and its rest length in metres.
    springs: Vec<([usize; 2], f64)>,
    held: Vec<bool>,
}

/// A kind of nets: its name in tables, and the function that builds it.
pub(super) type NetKind = (&'static str, fn() -> Net);

/// All kinds of nets, in the order of tables:
///
/// * a chain of 16 links, held at one end;
/// * the same between two nails, 5 % longer than at rest;
/// * a grid that is held along its whole border, 2 % longer than at rest;
/// * a Delaunay mesh of a square, held by its upper edge;
/// * the same with the mass of its middle particle divided by 100;
/// * the same with that mass halved ten times.
pub(super) static NETS: [NetKind; 6] = [
    ("chain", || row(1.0, false)),
    ("string", || row(1.05, true)),
    ("frame", || frame(1.02)),
    ("sheet", || sheet(1.0)),
    ("sliver", || sheet(100.0)),
    ("halved", || sheet(1024.0)),
];

/// The number of cells along each side of two-dimensional nets.
const CELLS: u32 = 6;

/// The number of links of one-dimensional nets.
const LINKS: usize = 16;

impl Net {
    /// Returns the net as a system, with springs of this stiffness in N/m.
    pub(super) fn system(&self, stiffness_n_per_m: f64) -> System {
        let system = System::new(self.points.iter().copied(), self.masses.clone());
        let mut system = system.expect("a net has usable points and masses");
        for &(ends, rest_m) in &self.springs {
            let made = system.stretch(ends, rest_m, stiffness_n_per_m);
            made.expect("a spring of a net has a length");
        }
        for (i, &is_held) in self.held.iter().enumerate() {
            if is_held {
                system.hold(i);
            }
        }
        system
    }

    /// Returns the free particles.
    pub(super) fn free(&self) -> impl Iterator<Item = usize> + '_ {
        let particles = self.held.iter().enumerate();
        particles.filter(|(_, held)| !**held).map(|(i, _)| i)
    }

    /// Returns the mean present length of the springs, in metres.
    pub(super) fn edge_m(&self) -> f64 {
        let lengths = self
            .springs
            .iter()
            .map(|(ends, _)| self.along(*ends).norm());
        lengths.sum::<f64>() / self.springs.len() as f64
    }

    /// Returns the recommended step of velocity Verlet with its guards in seconds, by its definition: √(2μ/r)
    /// with μ = 0.65. A particle's r is the sum of the stiffness of its springs over its mass, and the one that
    /// counts is that which no more than a tenth of the particles exceed.
    pub(super) fn recommended_step_s(&self, stiffness_n_per_m: f64) -> f64 {
        let touching = |i: usize| {
            self.springs
                .iter()
                .filter(move |(ends, _)| ends.contains(&i))
        };
        let rate = |i: usize| touching(i).count() as f64 * stiffness_n_per_m / self.masses[i];
        let mut rates: Vec<f64> = self.free().map(rate).collect();
        rates.sort_by(f64::total_cmp);
        let place = (0.9 * (rates.len() - 1) as f64).ceil() as usize;
        (2.0 * 0.65 / rates[place]).sqrt()
    }

    fn along(&self, [a, b]: [usize; 2]) -> Vector {
        self.points[b] - self.points[a]
    }

    /// Returns the largest frequency with springs of 1 N/m in rad/s: the root of the largest eigenvalue of
    /// A = M^-½ K M^-½.
    ///
    /// A number λ is above all eigenvalues if and only if λ − A has a Cholesky factor. So the largest is found
    /// by bisection to the last digits, without an iteration that might not converge. The cost is cubic in the
    /// number of particles.
    pub(super) fn omega_rad_per_s(&self) -> f64 {
        let matrix = self.matrix();
        let sums = matrix.iter().map(|row| row.iter().map(|x| x.abs()).sum());
        // Gershgorin's bound, and less than any eigenvalue that counts.
        let mut above: f64 = sums.fold(0.0, f64::max) * (1.0 + 1e-9);
        let mut below = 0.0;
        while above - below > 1e-12 * above {
            let middle = 0.5 * (above + below);
            if is_above(middle, &matrix) {
                above = middle;
            } else {
                below = middle;
            }
        }
        above.sqrt()
    }

    /// M^-½ K M^-½ over the free particles. K has the second derivatives of ½ (l − L)², which are
    /// n nᵀ + (1 − L/l)(1 − n nᵀ) for a spring along n.
    fn matrix(&self) -> Vec<Vec<f64>> {
        let mut place = vec![None; self.points.len()];
        for (at, particle) in self.free().enumerate() {
            place[particle] = Some(3 * at);
        }
        let count = 3 * self.free().count();
        let mut matrix = vec![vec![0.0; count]; count];
        for &([a, b], rest_m) in &self.springs {
            let d = self.along([a, b]);
            let length = d.norm();
            let (n, slack) = (d / length, 1.0 - rest_m / length);
            for (p, q, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                let (Some(row), Some(column)) = (place[p], place[q]) else {
                    continue;
                };
                let scale = sign / (self.masses[p] * self.masses[q]).sqrt();
                for i in 0..3 {
                    for j in 0..3 {
                        let unit = if i == j { slack } else { 0.0 };
                        let block = unit + (1.0 - slack) * n[i] * n[j];
                        matrix[row + i][column + j] += scale * block;
                    }
                }
            }
        }
        matrix
    }
}

/// Whether a number is above all eigenvalues of a symmetric matrix.
fn is_above(number: f64, matrix: &[Vec<f64>]) -> bool {
    let mut factor: Vec<Vec<f64>> = Vec::with_capacity(matrix.len());
    for (i, row) in matrix.iter().enumerate() {
        let mut new: Vec<f64> = Vec::with_capacity(i + 1);
        for j in 0..=i {
            let known = if j == i { &new } else { &factor[j] };
            let sum: f64 = new.iter().zip(&known[..j]).map(|(x, y)| x * y).sum();
            let left = if i == j { number } else { 0.0 } - row[j] - sum;
            if i == j {
                if left <= 0.0 {
                    return false;
                }
                new.push(left.sqrt());
            } else {
                new.push(left / factor[j][j]);
            }
        }
        factor.push(new);
    }
    true
}

/// Links in a row, `taut` times as long as at rest. The first particle is held, and the last too if asked.
fn row(taut: f64, is_last_held: bool) -> Net {
    let apart_m = 0.1;
    let points = (0..=LINKS).map(|i| Point::new(apart_m * i as f64, 0.0, 0.0));
    let mut held = vec![false; LINKS + 1];
    held[0] = true;
    held[LINKS] = is_last_held;
    Net {
        points: points.collect(),
        masses: vec![0.01; LINKS + 1],
        springs: (0..LINKS).map(|i| ([i, i + 1], apart_m / taut)).collect(),
        held,
    }
}

/// A grid, `taut` times as long as at rest. All diagonals lie in one direction, so that tension balances at
/// each particle.
fn frame(taut: f64) -> Net {
    let n = CELLS as usize;
    let at = |i: usize, j: usize| j * (n + 1) + i;
    let apart_m = 1.0 / n as f64;
    let place = |v: usize| {
        let [i, j] = [v % (n + 1), v / (n + 1)].map(|i| apart_m * i as f64);
        Point::new(i, j, 0.0)
    };
    let count = (n + 1) * (n + 1);
    let points: Vec<Point> = (0..count).map(place).collect();
    let mut springs = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            for (x, y) in [(1, 0), (0, 1), (1, 1)] {
                if i + x <= n && j + y <= n {
                    let ends = [at(i, j), at(i + x, j + y)];
                    let long_m = (points[ends[1]] - points[ends[0]]).norm();
                    springs.push((ends, long_m / taut));
                }
            }
        }
    }
    let is_rim = |v: usize| {
        [v % (n + 1), v / (n + 1)]
            .iter()
            .any(|i| [0, n].contains(i))
    };
    Net {
        points,
        masses: vec![0.01; count],
        springs,
        held: (0..count).map(is_rim).collect(),
    }
}

/// A sheet that is held by its upper edge, with the mass of its middle particle divided by a number.
fn sheet(divisor: f64) -> Net {
    let mut sheet = Sheet::new(MeshKind::Delaunay, CELLS, 1.0);
    let middle = middle(&sheet);
    sheet.masses[middle] /= divisor;
    let springs = sheet.edges.iter().map(|&ends| (ends, sheet.length_m(ends)));
    Net {
        springs: springs.collect(),
        held: sheet.points.iter().map(|p| p.y == 1.0).collect(),
        points: sheet.points,
        masses: sheet.masses,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of n links that is held at one end has the largest frequency 2√(k/m) sin((2n − 1)π/(2(2n + 1))).
    /// Between two nails, along which it swings as without tension, it has 2√(k/m) sin((n − 1)π/(2n)).
    #[test]
    fn chains_have_the_frequencies_of_books() {
        let n = LINKS as f64;
        let unit = 2.0 * 100.0_f64.sqrt();
        let chain = (2.0 * n - 1.0) / (2.0 * (2.0 * n + 1.0));
        let string = (n - 1.0) / (2.0 * n);
        for ((name, build), fraction) in [(NETS[0], chain), (NETS[1], string)] {
            let known = unit * (std::f64::consts::PI * fraction).sin();
            let found = build().omega_rad_per_s();
            assert!(
                (found / known - 1.0).abs() < 1e-10,
                "{name} {found} {known}"
            );
        }
    }

    /// Dividing a mass by 10.24 raises a frequency by at most √10.24, and a particle of a thousandth of the
    /// mass swings as between walls: its ω² is nearly 2^10 times what it was for that particle alone.
    #[test]
    fn halving_a_mass_raises_the_frequency_within_bounds() {
        let [sheet, sliver, halved] = [3, 4, 5].map(|i| (NETS[i].1)().omega_rad_per_s());
        assert!(sliver > sheet && sliver < 10.0 * sheet, "{sheet} {sliver}");
        assert!(halved > sliver && halved < sliver * 10.24_f64.sqrt() * (1.0 + 1e-9));
        assert!(
            halved < 32.0 * sheet && halved > 10.0 * sheet,
            "{sheet} {halved}"
        );
    }
}

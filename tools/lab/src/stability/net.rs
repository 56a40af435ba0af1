//! Small nets of springs at rest, and their largest frequency by a dense matrix that shares no code with
//! the methods.

use tearmesh::{Point, Vector};
use tearmesh_cloth::System;

use crate::pareto::{MeshKind, Sheet};

/// A net that rests without loads.
#[derive(Clone, Debug)]
pub(super) struct Net {
    points: Vec<Point>,
    masses: Vec<f64>,
    /// The ends of each spring, and its length at rest in metres.
    springs: Vec<([usize; 2], f64)>,
    held: Vec<bool>,
}

/// The kinds of nets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NetKind {
    /// A chain of 16 links, held at one end.
    Chain,
    /// A chain of 16 links between two nails, 5 % longer than at rest.
    String,
    /// A grid of 6 × 6 cells, held along its whole boundary, 2 % longer than at rest.
    Frame,
    /// A Delaunay mesh of a square, with as many particles as a grid of 6 × 6 cells, held by its upper edge.
    Sheet,
    /// The net of [`Sheet`](NetKind::Sheet), with the mass of its middle particle divided by 100.
    Sliver,
    /// The net of [`Sheet`](NetKind::Sheet), with the mass of its middle particle divided by 1024.
    Halved,
}

/// The cells a side of nets of two dimensions.
const CELLS: u32 = 6;

/// The links of those of one.
const LINKS: usize = 16;

impl NetKind {
    /// All kinds, in the order of charts.
    pub const ALL: [NetKind; 6] = [
        NetKind::Chain,
        NetKind::String,
        NetKind::Frame,
        NetKind::Sheet,
        NetKind::Sliver,
        NetKind::Halved,
    ];

    /// Returns the name of the net in tables and captions.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            NetKind::Chain => "chain",
            NetKind::String => "string",
            NetKind::Frame => "frame",
            NetKind::Sheet => "sheet",
            NetKind::Sliver => "sliver",
            NetKind::Halved => "halved",
        }
    }

    /// Returns a short description of the net.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            NetKind::Chain => "16 links held by one end",
            NetKind::String => "16 links between nails, 5 % taut",
            NetKind::Frame => "a grid held all round, 2 % taut",
            NetKind::Sheet => "a Delaunay sheet held by one edge",
            NetKind::Sliver => "the sheet with one mass divided by 100",
            NetKind::Halved => "the sheet with one mass halved ten times",
        }
    }
}

impl Net {
    /// Of a kind.
    pub(super) fn new(kind: NetKind) -> Net {
        match kind {
            NetKind::Chain => row(1.0, 1),
            NetKind::String => row(1.05, 2),
            NetKind::Frame => frame(1.02),
            NetKind::Sheet => sheet(1.0),
            NetKind::Sliver => sheet(100.0),
            NetKind::Halved => sheet(1024.0),
        }
    }

    /// It as a system, with springs of this stiffness in N/m.
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

    /// Which particles are free.
    pub(super) fn free(&self) -> impl Iterator<Item = usize> + '_ {
        let particles = self.held.iter().enumerate();
        particles.filter(|(_, held)| !**held).map(|(i, _)| i)
    }

    /// The mean length of springs as they lie, in metres.
    pub(super) fn edge_m(&self) -> f64 {
        let lengths = self
            .springs
            .iter()
            .map(|(ends, _)| self.along(*ends).norm());
        lengths.sum::<f64>() / self.springs.len() as f64
    }

    /// The step in seconds that suits velocity Verlet with its guards, by its definition: √(2μ/r), μ = .65,
    /// where r is the sum of stiffness at a particle over its mass, and no more than a tenth of the particles
    /// have a larger one.
    pub(super) fn suited_s(&self, stiffness_n_per_m: f64) -> f64 {
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

    /// The largest frequency with springs of 1 N/m, in rad/s: the root of the largest eigenvalue λ of
    /// M^-½ K M^-½. λ' is above all eigenvalues if and only if λ' − M^-½ K M^-½ has a Cholesky
    /// factor, and so λ is found by bisection to the last digits: as simple as can be, and nothing has to
    /// converge. Cubic in the particles.
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

    /// M^-½ K M^-½ over the free particles, with K the second derivatives of ½ (l − L)², which are
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

/// Links in a row between so many nails, so many times as long as at rest.
fn row(taut: f64, nails: usize) -> Net {
    let apart_m = 0.1;
    let points = (0..=LINKS).map(|i| Point::new(apart_m * i as f64, 0.0, 0.0));
    let mut held = vec![false; LINKS + 1];
    held[0] = true;
    held[LINKS] = nails > 1;
    Net {
        points: points.collect(),
        masses: vec![0.01; LINKS + 1],
        springs: (0..LINKS).map(|i| ([i, i + 1], apart_m / taut)).collect(),
        held,
    }
}

/// A grid with all diagonals in one direction, so that its tension balances at each particle.
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

/// A sheet that hangs by its upper edge, with the mass of the particle in its middle divided.
fn sheet(lighter: f64) -> Net {
    let sheet = Sheet::new(MeshKind::Delaunay, CELLS, 1.0);
    let centre = Point::new(0.5, 0.5, 0.0);
    let away = |i: &usize| (sheet.points[*i] - centre).norm_squared();
    let near = |i: &usize, j: &usize| away(i).total_cmp(&away(j));
    let middle = (0..sheet.points.len()).min_by(near);
    let mut masses = sheet.masses.clone();
    masses[middle.expect("a sheet has particles")] /= lighter;
    let springs = sheet.edges.iter().map(|&ends| (ends, sheet.length_m(ends)));
    Net {
        springs: springs.collect(),
        held: sheet.points.iter().map(|p| p.y == 1.0).collect(),
        points: sheet.points,
        masses,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of n links that is held by one end has 2√(k/m) sin((2n − 1)π/(2(2n + 1))) as its largest
    /// frequency, and one between nails with tension, along which it swings as without, 2√(k/m) sin((n −
    /// 1)π/(2n)).
    #[test]
    fn chains_have_the_frequencies_of_books() {
        let n = LINKS as f64;
        let unit = 2.0 * 100.0_f64.sqrt();
        let books = [
            (NetKind::Chain, (2.0 * n - 1.0) / (2.0 * (2.0 * n + 1.0))),
            (NetKind::String, (n - 1.0) / (2.0 * n)),
        ];
        for (kind, part) in books {
            let known = unit * (std::f64::consts::PI * part).sin();
            let found = Net::new(kind).omega_rad_per_s();
            assert!(
                (found / known - 1.0).abs() < 1e-10,
                "{kind:?} {found} {known}"
            );
        }
    }

    /// Halved once, a mass raises a frequency by no more than √2; and a thousandth of a mass in a net
    /// swings as it does between walls, so that ω² is next to 2^10 times what it was for that particle alone.
    #[test]
    fn halving_a_mass_raises_the_frequency_within_bounds() {
        let [sheet, sliver, halved] = [NetKind::Sheet, NetKind::Sliver, NetKind::Halved]
            .map(|kind| Net::new(kind).omega_rad_per_s());
        assert!(sliver > sheet && sliver < 10.0 * sheet, "{sheet} {sliver}");
        assert!(halved > sliver && halved < sliver * 10.24_f64.sqrt() * (1.0 + 1e-9));
        assert!(
            halved < 32.0 * sheet && halved > 10.0 * sheet,
            "{sheet} {halved}"
        );
    }
}

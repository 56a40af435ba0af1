//! The linear algebra of an implicit step: a symmetric matrix in 3 × 3 blocks, and conjugate
//! gradients.
//!
//! A [`Hessian`] holds the second derivatives of an energy: one block on the diagonal for each
//! particle, one off it for each *slot*, which is a pair of particles (i, j), i < j, that
//! something acts between. The block (j, i) is the transpose and is not stored. [`Pcg`] solves.
//!
//! Slots are in ascending order of their pairs, so a sum depends on the present constraints alone,
//! and not on what was torn before.
//!
//! Why not compressed rows? Symmetry halves the blocks, and a product reads each of them once.

use crate::system::contact::Corners;
use tearmesh::DisjointSets;
use tearmesh::geometry::{Vector, dot};
use tearmesh::nalgebra::Matrix3;

/// A 3 × 3 matrix. Products with vectors are those of this file, which sum in one order on every machine.
pub(crate) type Block = Matrix3<f64>;

/// The outer product a bᵀ.
#[inline]
pub(crate) fn outer(a: Vector, b: Vector) -> Block {
    Block::from_fn(|row, column| a[row] * b[column])
}

/// The product of a block with a vector.
#[inline]
fn times(m: &Block, v: Vector) -> Vector {
    Vector::from_fn(|row, _| m[(row, 0)] * v.x + m[(row, 1)] * v.y + m[(row, 2)] * v.z)
}

/// The inverse of a symmetric positive definite block by Cholesky factorisation; `None` if a pivot is
/// not positive, which shows that the block is not positive definite.
fn inverse_if_definite(m: &Block) -> Option<Block> {
    let d0 = m.m11;
    let l10 = m.m21 / d0;
    let l20 = m.m31 / d0;
    let d1 = m.m22 - l10 * m.m21;
    let t21 = m.m32 - l20 * m.m21;
    let l21 = t21 / d1;
    let d2 = m.m33 - l20 * m.m31 - l21 * t21;
    // Written so that a NaN is refused too.
    if !(d0 > 0.0 && d1 > 0.0 && d2 > 0.0) {
        return None;
    }
    // The rows of L⁻¹, L with ones on its diagonal; the inverse is L⁻ᵀ D⁻¹ L⁻¹.
    let r1 = Vector::new(-l10, 1.0, 0.0);
    let r2 = Vector::new(l10 * l21 - l20, -l21, 1.0);
    let first = Block::from_diagonal(&Vector::new(1.0 / d0, 0.0, 0.0));
    Some(first + outer(r1, r1) * (1.0 / d1) + outer(r2, r2) * (1.0 / d2))
}

/// The symmetric matrix of second derivatives of an energy, in 3 × 3 blocks by particle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hessian {
    diagonal: Vec<Block>,
    off: Vec<Block>,
    /// The pair (i, j), i < j, of each slot, in ascending order.
    pairs: Vec<[u32; 2]>,
    /// For each particle i, the first of its slots; and their number. (Without, a step on 24 × 24 cells takes
    /// 5 % more instructions to find them.)
    rows: Vec<usize>,
    /// For each particle, the lowest among those that constraints connect with it, itself included.
    pub(crate) pieces: Vec<u32>,
    /// The pairs of all constraints as they were visited.
    visited: Vec<[u32; 2]>,
    sets: DisjointSets,
}

impl Hessian {
    /// Sets the matrix to zero. Keeps the allocated memory.
    pub(crate) fn clear(&mut self) {
        self.diagonal.clear();
        self.diagonal.resize(self.pieces.len(), Block::zeros());
        self.off.clear();
        self.off.resize(self.pairs.len(), Block::zeros());
    }

    /// Adds a block at row `i`, column `j`: a place on the diagonal, or of a pair.
    #[inline]
    pub(crate) fn add(&mut self, [i, j]: [u32; 2], block: &Block) {
        if i == j {
            self.diagonal[i as usize] += block;
            return;
        }
        let [low, high] = sorted([i, j]);
        let row = self.rows[low as usize]..self.rows[low as usize + 1];
        let mut others = self.pairs[row.clone()].iter();
        let place = others.position(|pair| pair[1] == high);
        let sum = &mut self.off[row.start + place.expect("each pair has a slot")];
        *sum += if i < j { *block } else { block.transpose() };
    }

    /// Returns how stiff a particle is, in the sum of three directions.
    pub(crate) fn stiffness(&self, particle: usize) -> f64 {
        self.diagonal[particle].trace().max(0.0)
    }

    /// Makes the middle of particles stiffer along a direction, and across it.
    pub(crate) fn stiffen(&mut self, corners: Corners, along: Vector, [by, across]: [f64; 2]) {
        let block = outer(along, along) * (by - across) + Block::from_diagonal_element(across);
        let block = block * (corners.count as f64).powi(-2);
        for i in corners.each() {
            for j in corners.each().filter(|&j| i <= j) {
                self.add([i as u32, j as u32], &block);
            }
        }
    }

    /// Returns the sum of the diagonal, which is no less than the largest eigenvalue unless one is negative.
    pub(crate) fn trace(&self) -> f64 {
        self.diagonal.iter().map(Block::trace).sum()
    }

    /// Computes the product with a vector for each particle, into `out`.
    pub(crate) fn product(&self, x: &[Vector], out: &mut Vec<Vector>) {
        assert!(x.len() == self.diagonal.len(), "one vector a particle");
        assert!(self.pairs.len() == self.off.len(), "one block a slot");
        out.clear();
        out.extend(self.diagonal.iter().zip(x).map(|(b, &x)| times(b, x)));
        for (block, &[i, j]) in self.off.iter().zip(&self.pairs) {
            let (i, j) = (i as usize, j as usize);
            let (xi, xj) = (x[i], x[j]);
            out[i] += times(block, xj);
            out[j] += times(&block.transpose(), xi);
        }
    }

    /// Takes the pairs of the present constraints. Costs a comparison for each, and O(n log n) if
    /// one has come, gone or got other ends.
    pub(crate) fn follow(
        &mut self,
        particles: usize,
        visited: impl Iterator<Item = [u32; 2]> + Clone,
    ) {
        let before = self.visited.iter().copied();
        if self.pieces.len() == particles && visited.clone().eq(before) {
            return;
        }
        self.visited.clear();
        self.visited.extend(visited);
        self.pairs.clear();
        self.pairs.extend(self.visited.iter().copied().map(sorted));
        self.pairs.sort_unstable();
        self.pairs.dedup();
        let first = |i| self.pairs.partition_point(|pair| pair[0] < i);
        self.rows.clear();
        self.rows.extend((0..=particles as u32).map(first));
        self.sets.reset(particles as u32);
        self.pairs.iter().for_each(|&[i, j]| self.sets.join(i, j));
        let particles = 0..particles as u32;
        self.pieces.clear();
        self.pieces
            .extend(particles.map(|i| self.sets.representative(i)));
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// What each particle weighs, and whether it is held, which makes its inverse mass zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weights<'a> {
    pub(crate) masses: &'a [f64],
    pub(crate) inverse_masses: &'a [f64],
}

impl Weights<'_> {
    pub(crate) fn is_free(self, particle: usize) -> bool {
        self.inverse_masses[particle] > 0.0
    }

    /// A force on each particle as an rms acceleration over those that are free, √(rᵀ M⁻¹ r / Σm);
    /// zero where nothing has a mass.
    pub(crate) fn rms(self, force: impl Fn(usize) -> Vector) -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for (i, &m) in self.masses.iter().enumerate() {
            total += m;
            if self.is_free(i) {
                let force = force(i);
                sum += dot(force, force) / m;
            }
        }
        let mean = if total > 0.0 { sum / total } else { 0.0 };
        mean.sqrt()
    }
}

/// Conjugate gradients where some particles are held: Baraff and Witkin 1998 §5.2–5.3, in the
/// corrected form of Ascher and Boxerman 2003.
///
/// Solves S (s M + H) S δ = S b for δ = S δ, where S takes away the particles that are held. The
/// preconditioner is the inverse of each block on the diagonal. Vectors start and stay in the range
/// of S, so what is held is held exactly.
///
/// What is left is measured as an acceleration: of the residual r it is √(rᵀ M⁻¹ r / Σm), of the energy of the error
/// e = δ* − δ it is √(s eᵀAe / Σm) with A = s M + H. Where H is positive semidefinite, either divided by s bounds the rms error
/// of δ. The second is the nearer bound, by 7 to 23 times in cloth of 64 × 64 cells, whose residual is that of stiff modes.
/// Each iteration lowers eᵀAe by α rᵀz, so the last ones say what was left before them (Hestenes and Stiefel 1952 §6).
#[derive(Clone, Debug, Default)]
pub(crate) struct Pcg {
    /// The right-hand side; on return the residual.
    pub(crate) b: Vec<Vector>,
    /// The solution δ.
    pub(crate) delta: Vec<Vector>,
    preconditioned: Vec<Vector>,
    direction: Vec<Vector>,
    product: Vec<Vector>,
    inverses: Vec<Block>,
}

/// What a solve did.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solution {
    /// Whether the matrix showed that it is not positive definite, by a block on the diagonal
    /// without a Cholesky factor or by a direction p with pᵀAp ≤ 0. (One that does not show it in
    /// the directions visited is solved nonetheless.)
    pub(crate) is_indefinite: bool,
    /// The error that is left, as an rms acceleration in m/s².
    pub(crate) error: f64,
    /// What could be left, in m/s²: what was asked for, or rounding where that is more.
    pub(crate) limit: f64,
    pub(crate) iterations: u32,
}

/// When conjugate gradients may stop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    /// The error that may be left, as an rms acceleration in m/s².
    pub(crate) error_max: f64,
    /// And the part of δ that may be missing, by √(eᵀAe / δᵀAδ).
    pub(crate) missing_max: f64,
    pub(crate) iterations_max: u32,
}

/// The number of the last iterations that say what error was left before them.
const SAYING: usize = 4;

impl Pcg {
    /// Solves from the right-hand side in `b`, from δ = 0, until it may stop, or no more is left than
    /// rounding makes at coordinates of the size `size`.
    pub(crate) fn solve(
        &mut self,
        hessian: &Hessian,
        weights: Weights<'_>,
        inertia: f64,
        stop: Stop,
        size: impl Fn(usize) -> f64,
    ) -> Solution {
        let n = weights.masses.len();
        for (i, b) in self.b.iter_mut().enumerate() {
            if !weights.is_free(i) {
                *b = Vector::zeros();
            }
        }
        for vectors in [
            &mut self.delta,
            &mut self.preconditioned,
            &mut self.direction,
            &mut self.product,
        ] {
            vectors.clear();
            vectors.resize(n, Vector::zeros());
        }
        let start = weights.rms(|i| self.b[i]);
        // The forces that the rounding of coordinates alone makes: below them there is nothing to
        // solve, nor below the rounding of the right-hand side.
        let rounding =
            weights.rms(|i| Vector::x() * (hessian.diagonal[i].trace() * (f64::EPSILON * size(i))));
        let solved = rounding.max(1e-14 * start);
        let mut solution = Solution {
            is_indefinite: !self.precondition_by(hessian, weights, inertia),
            error: start,
            limit: solved,
            iterations: 0,
        };
        if solution.is_indefinite || start <= solved {
            return solution;
        }
        let per_mass = inertia / weights.masses.iter().sum::<f64>();
        // By what the last iterations and all lowered eᵀAe.
        let (mut lowered, mut lowered_by_all) = ([f64::INFINITY; SAYING], 0.0);
        let mut rz = self.advance(weights, 0.0);
        self.direction.clone_from(&self.preconditioned);
        while solution.iterations < stop.iterations_max {
            solution.iterations += 1;
            hessian.product(&self.direction, &mut self.product);
            let mut curvature = 0.0;
            for (i, (q, &p)) in self.product.iter_mut().zip(&self.direction).enumerate() {
                *q = if weights.is_free(i) {
                    *q + p * (inertia * weights.masses[i])
                } else {
                    Vector::zeros()
                };
                curvature += dot(p, *q);
            }
            if curvature.is_nan() || curvature <= 0.0 {
                solution.is_indefinite = true;
                break;
            }
            let (before, step) = (rz, rz / curvature);
            rz = self.advance(weights, step);
            lowered[solution.iterations as usize % SAYING] = step * before;
            lowered_by_all += step * before;
            let left = lowered.iter().sum::<f64>();
            solution.error = weights.rms(|i| self.b[i]).min((per_mass * left).sqrt());
            let missing_max = stop.missing_max * (per_mass * lowered_by_all).sqrt();
            solution.limit = stop.error_max.min(missing_max).max(solved);
            if solution.error <= solution.limit {
                break;
            }
            let turn = rz / before;
            for (p, z) in self.direction.iter_mut().zip(&self.preconditioned) {
                *p = z + *p * turn;
            }
        }
        solution
    }

    /// Goes `step` along the direction: new δ and r, and z = P⁻¹ r. Returns r · z.
    fn advance(&mut self, weights: Weights<'_>, step: f64) -> f64 {
        let mut rz = 0.0;
        for i in 0..weights.masses.len() {
            self.delta[i] += self.direction[i] * step;
            self.b[i] -= self.product[i] * step;
            let z = times(&self.inverses[i], self.b[i]);
            rz += dot(self.b[i], z);
            self.preconditioned[i] = z;
        }
        rz
    }

    /// Inverts the blocks on the diagonal; false if one is not definite.
    fn precondition_by(&mut self, hessian: &Hessian, weights: Weights<'_>, inertia: f64) -> bool {
        self.inverses.clear();
        for (i, block) in hessian.diagonal.iter().enumerate() {
            let mass = Block::from_diagonal_element(inertia * weights.masses[i]);
            let inverse = if weights.is_free(i) {
                inverse_if_definite(&(block + mass))
            } else {
                Some(Block::zeros())
            };
            let Some(inverse) = inverse else {
                return false;
            };
            self.inverses.push(inverse);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_times_its_block_is_the_identity() {
        let block = Block::new(4.0, 1.0, -2.0, 1.0, 3.0, 0.5, -2.0, 0.5, 5.0);
        let inverse = inverse_if_definite(&block).expect("it is definite");
        for axis in [Vector::x(), Vector::y(), Vector::z()] {
            let apart = times(&block, times(&inverse, axis)) - axis;
            assert!(apart.norm() < 2e-15, "{apart}");
        }
        let shifted = block - Block::from_diagonal_element(5.0);
        assert_eq!(inverse_if_definite(&shifted), None);
        let broken = Block::from_diagonal_element(f64::NAN);
        assert_eq!(inverse_if_definite(&broken), None);
    }
}

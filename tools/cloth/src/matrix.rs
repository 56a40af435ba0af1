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

use std::array::from_fn;

use tearmesh::DisjointSets;
use tearmesh::geometry::{Vector, dot};

/// A 3 × 3 matrix: three rows of three numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Block(pub(crate) [[f64; 3]; 3]);

impl Block {
    /// The matrix of zeros.
    pub(crate) const ZERO: Block = Block([[0.0; 3]; 3]);

    /// Returns the identity matrix, scaled by `s`.
    #[inline]
    pub(crate) fn identity_times(s: f64) -> Block {
        Block([[s, 0.0, 0.0], [0.0, s, 0.0], [0.0, 0.0, s]])
    }

    /// Returns the outer product a bᵀ.
    #[inline]
    pub(crate) fn outer(a: Vector, b: Vector) -> Block {
        let row = |s: f64| [s * b.x, s * b.y, s * b.z];
        Block([row(a.x), row(a.y), row(a.z)])
    }

    /// Returns the transpose of this matrix.
    #[inline]
    pub(crate) fn transposed(&self) -> Block {
        Block(from_fn(|row| from_fn(|column| self.0[column][row])))
    }

    /// Returns the sum of this matrix and `s` times another.
    #[inline]
    pub(crate) fn plus(&self, s: f64, other: &Block) -> Block {
        let [a, b] = [&self.0, &other.0];
        Block(from_fn(|i| from_fn(|j| a[i][j] + s * b[i][j])))
    }

    /// Returns the sum of the diagonal.
    pub(crate) fn trace(&self) -> f64 {
        self.0[0][0] + self.0[1][1] + self.0[2][2]
    }

    /// Returns the product of this matrix with a vector.
    #[inline]
    pub(crate) fn times(&self, v: Vector) -> Vector {
        let row = |r: &[f64; 3]| r[0] * v.x + r[1] * v.y + r[2] * v.z;
        Vector::new(row(&self.0[0]), row(&self.0[1]), row(&self.0[2]))
    }

    /// Returns the product of the transpose of this matrix with a vector.
    #[inline]
    pub(crate) fn transposed_times(&self, v: Vector) -> Vector {
        let m = &self.0;
        let column = |c: usize| m[0][c] * v.x + m[1][c] * v.y + m[2][c] * v.z;
        Vector::new(column(0), column(1), column(2))
    }

    /// Returns the inverse of a symmetric positive definite block, computed by Cholesky
    /// factorisation; `None` if a pivot is not positive, which shows that the block is not positive
    /// definite.
    pub(crate) fn inverse_if_definite(&self) -> Option<Block> {
        let m = &self.0;
        let d0 = m[0][0];
        let l10 = m[1][0] / d0;
        let l20 = m[2][0] / d0;
        let d1 = m[1][1] - l10 * m[1][0];
        let t21 = m[2][1] - l20 * m[1][0];
        let l21 = t21 / d1;
        let d2 = m[2][2] - l20 * m[2][0] - l21 * t21;
        // Written so that a NaN is refused too.
        if !(d0 > 0.0 && d1 > 0.0 && d2 > 0.0) {
            return None;
        }
        // The rows of L⁻¹, L with ones on its diagonal; the inverse is L⁻ᵀ D⁻¹ L⁻¹.
        let r1 = Vector::new(-l10, 1.0, 0.0);
        let r2 = Vector::new(l10 * l21 - l20, -l21, 1.0);
        let mut inverse = Block::ZERO;
        inverse.0[0][0] = 1.0 / d0;
        let inverse = inverse.plus(1.0 / d1, &Block::outer(r1, r1));
        Some(inverse.plus(1.0 / d2, &Block::outer(r2, r2)))
    }
}

const NO_SLOT: u32 = u32::MAX;

/// Visits the pairs of all constraints: kind, number and particles.
pub(crate) type EachPair<'a> = &'a dyn Fn(&mut dyn FnMut(usize, usize, [u32; 2]));

/// The symmetric matrix of second derivatives of an energy, in 3 × 3 blocks by particle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hessian {
    diagonal: Vec<Block>,
    off: Vec<Block>,
    /// The pair (i, j), i < j, of each slot, in ascending order.
    pairs: Vec<[u32; 2]>,
    /// For each particle, the lowest among those that constraints connect with it, itself included.
    pub(crate) pieces: Vec<u32>,
    /// By kind of constraint and by the number of a constraint's pair; [`NO_SLOT`] without a pair.
    slots: [Vec<u32>; 3],
    /// How many pairs the constraints have, where those of several coincide counted for each.
    count: usize,
    sets: DisjointSets,
}

impl Hessian {
    /// Sets the matrix to zero. Keeps the allocated memory.
    pub(crate) fn clear(&mut self) {
        self.diagonal.clear();
        self.diagonal.resize(self.pieces.len(), Block::ZERO);
        self.off.clear();
        self.off.resize(self.pairs.len(), Block::ZERO);
    }

    /// Adds a block at row `i`, column `j`, of the pair with this kind and number. If both are equal, it is added
    /// to the diagonal, and the pair is ignored.
    #[inline]
    pub(crate) fn add(&mut self, (kind, number): (usize, usize), [i, j]: [u32; 2], block: &Block) {
        let sum = match i == j {
            true => &mut self.diagonal[i as usize],
            false => &mut self.off[self.slots[kind][number] as usize],
        };
        *sum = match i <= j {
            true => sum.plus(1.0, block),
            false => sum.plus(1.0, &block.transposed()),
        };
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
        out.extend(self.diagonal.iter().zip(x).map(|(b, &x)| b.times(x)));
        for (block, &[i, j]) in self.off.iter().zip(&self.pairs) {
            let (i, j) = (i as usize, j as usize);
            let (xi, xj) = (x[i], x[j]);
            out[i] += block.times(xj);
            out[j] += block.transposed_times(xi);
        }
    }

    /// Takes the pairs of the present constraints. Costs a comparison for each, and O(n log n) if
    /// one has come, gone or got other ends.
    pub(crate) fn follow(&mut self, particles: usize, each_pair: EachPair<'_>) {
        let (mut count, mut is_same) = (0, self.pieces.len() == particles);
        each_pair(&mut |kind, number, ends| {
            count += 1;
            let slot = self.slots[kind].get(number);
            let pair = slot.and_then(|&slot| self.pairs.get(slot as usize));
            is_same &= pair == Some(&sorted(ends));
        });
        if is_same && count == self.count {
            return;
        }
        self.count = count;
        self.pairs.clear();
        each_pair(&mut |_, _, ends| self.pairs.push(sorted(ends)));
        self.pairs.sort_unstable();
        self.pairs.dedup();
        self.slots.iter_mut().for_each(|slots| slots.fill(NO_SLOT));
        each_pair(&mut |kind, number, ends| {
            let slot = self.pairs.binary_search(&sorted(ends));
            let slots = &mut self.slots[kind];
            if slots.len() <= number {
                slots.resize(number + 1, NO_SLOT);
            }
            slots[number] = slot.expect("each pair has a slot") as u32;
        });
        self.sets.reset(particles as u32);
        self.pairs.iter().for_each(|&[i, j]| self.sets.join(i, j));
        let particles = 0..particles as u32;
        self.pieces.clear();
        self.pieces.extend(particles.map(|i| self.sets.leader(i)));
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
/// The residual r is measured as an acceleration, √(rᵀ M⁻¹ r / Σm). Where H is positive
/// semidefinite, that divided by s bounds the rms error of δ.
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
    /// The rms acceleration that is left, in m/s².
    pub(crate) residual: f64,
    /// What could be left, in m/s²: what was asked for, or rounding where that is more.
    pub(crate) limit: f64,
    pub(crate) iterations: u32,
}

impl Pcg {
    /// Solves from the right-hand side in `b`, from δ = 0, until no more than `residual_max` is left
    /// or as much as rounding makes at coordinates of the size `size`.
    pub(crate) fn solve(
        &mut self,
        hessian: &Hessian,
        weights: Weights<'_>,
        inertia: f64,
        (residual_max, iterations_max): (f64, u32),
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
        let rounding = weights.rms(|i| {
            let [[a, _, _], [_, b, _], [_, _, c]] = hessian.diagonal[i].0;
            Vector::x() * ((a + b + c) * (f64::EPSILON * size(i)))
        });
        let mut solution = Solution {
            is_indefinite: !self.precondition_by(hessian, weights, inertia),
            residual: start,
            limit: residual_max.max(rounding).max(1e-14 * start),
            iterations: 0,
        };
        if solution.is_indefinite || start <= solution.limit {
            return solution;
        }
        let mut rz = self.advance(weights, 0.0);
        self.direction.clone_from(&self.preconditioned);
        while solution.iterations < iterations_max {
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
            let before = rz;
            rz = self.advance(weights, rz / curvature);
            solution.residual = weights.rms(|i| self.b[i]);
            if solution.residual <= solution.limit {
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
            let z = self.inverses[i].times(self.b[i]);
            rz += dot(self.b[i], z);
            self.preconditioned[i] = z;
        }
        rz
    }

    /// Inverts the blocks on the diagonal; false if one is not definite.
    fn precondition_by(&mut self, hessian: &Hessian, weights: Weights<'_>, inertia: f64) -> bool {
        self.inverses.clear();
        for (i, block) in hessian.diagonal.iter().enumerate() {
            let mass = Block::identity_times(inertia * weights.masses[i]);
            let inverse = if weights.is_free(i) {
                block.plus(1.0, &mass).inverse_if_definite()
            } else {
                Some(Block::ZERO)
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
        let block = Block([[4.0, 1.0, -2.0], [1.0, 3.0, 0.5], [-2.0, 0.5, 5.0]]);
        let inverse = block.inverse_if_definite().expect("it is definite");
        for axis in [Vector::x(), Vector::y(), Vector::z()] {
            let apart = block.times(inverse.times(axis)) - axis;
            assert!(apart.norm() < 2e-15, "{apart}");
        }
        assert_eq!(
            block
                .plus(-5.0, &Block::identity_times(1.0))
                .inverse_if_definite(),
            None
        );
        assert_eq!(Block::identity_times(f64::NAN).inverse_if_definite(), None);
    }
}

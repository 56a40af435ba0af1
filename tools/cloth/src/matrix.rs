//! Blocks of 3 × 3 numbers, and symmetric matrices made of them.
//!
//! A [`Hessian`] holds the second derivatives of an energy: one block on the diagonal for each
//! particle, one off it for each *slot*, which is a pair of particles (i, j), i < j, that
//! something acts between. The block (j, i) is the transpose and is not stored. Which pairs
//! have a slot is the business of [`Layout`](super::Layout).
//!
//! Slots are visited in the order of their numbers, so sums are formed in a fixed order. That
//! order is not sorted by particle once the layout was changed in place: the same changes give
//! the same bits, a rebuilt layout gives results that differ by rounding.
//!
//! Why not compressed rows? A tear would have to move every block behind the one that it
//! inserts. Here it takes a free slot, or a new one at the end.

use tearmesh::geometry::Vector;

/// A 3 × 3 matrix: three rows of three numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Block(pub [[f64; 3]; 3]);

impl Block {
    /// The matrix of zeros.
    pub const ZERO: Block = Block([[0.0; 3]; 3]);

    /// Returns the identity matrix, scaled by `s`.
    #[inline]
    #[must_use]
    pub fn identity_times(s: f64) -> Block {
        Block([[s, 0.0, 0.0], [0.0, s, 0.0], [0.0, 0.0, s]])
    }

    /// Returns the outer product a bᵀ.
    #[inline]
    #[must_use]
    pub fn outer(a: Vector, b: Vector) -> Block {
        let row = |s: f64| [s * b.x, s * b.y, s * b.z];
        Block([row(a.x), row(a.y), row(a.z)])
    }

    /// Returns the transpose of this matrix.
    #[inline]
    #[must_use]
    pub fn transposed(&self) -> Block {
        let m = &self.0;
        Block([
            [m[0][0], m[1][0], m[2][0]],
            [m[0][1], m[1][1], m[2][1]],
            [m[0][2], m[1][2], m[2][2]],
        ])
    }

    /// Returns the sum of this matrix and `s` times another.
    #[inline]
    #[must_use]
    pub fn plus(&self, s: f64, other: &Block) -> Block {
        let mut sum = *self;
        for (row, from) in sum.0.iter_mut().zip(&other.0) {
            for (x, y) in row.iter_mut().zip(from) {
                *x += s * y;
            }
        }
        sum
    }

    /// Returns the product of this matrix with a vector.
    #[inline]
    #[must_use]
    pub fn times(&self, v: Vector) -> Vector {
        let row = |r: &[f64; 3]| r[0] * v.x + r[1] * v.y + r[2] * v.z;
        Vector::new(row(&self.0[0]), row(&self.0[1]), row(&self.0[2]))
    }

    /// Returns the product of the transpose of this matrix with a vector.
    #[inline]
    #[must_use]
    pub fn transposed_times(&self, v: Vector) -> Vector {
        let m = &self.0;
        let column = |c: usize| m[0][c] * v.x + m[1][c] * v.y + m[2][c] * v.z;
        Vector::new(column(0), column(1), column(2))
    }

    /// Returns the inverse of a symmetric positive definite block, computed by Cholesky
    /// factorisation; `None` if a pivot is not positive, which shows that the block is not positive
    /// definite.
    #[must_use]
    pub fn inverse_if_definite(&self) -> Option<Block> {
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

/// The symmetric matrix of second derivatives of an energy, in 3 × 3 blocks by particle.
///
/// ```
/// use tearmesh::Vector;
/// use tearmesh_cloth::implicit::{Block, Hessian};
///
/// // Two particles and one slot between them.
/// let mut hessian = Hessian::default();
/// hessian.clear(2, 1);
/// let k = Block::identity_times(3.0);
/// hessian.add_pair(0, [0, 1], &k);
/// let mut product = Vec::new();
/// hessian.product(&[[0, 1]], &[Vector::x(), Vector::zeros()], &mut product);
/// assert_eq!(product, [Vector::x() * 3.0, Vector::x() * -3.0]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Hessian {
    pub(crate) diagonal: Vec<Block>,
    off: Vec<Block>,
}

impl Hessian {
    /// Sets the matrix to zero, with room for `particles` particles and `slots` slots. Keeps the
    /// allocated memory.
    pub fn clear(&mut self, particles: usize, slots: usize) {
        self.diagonal.clear();
        self.diagonal.resize(particles, Block::ZERO);
        self.off.clear();
        self.off.resize(slots, Block::ZERO);
    }

    /// Returns the block of a particle on the diagonal.
    ///
    /// # Panics
    ///
    /// If there is no such particle.
    #[must_use]
    pub fn diagonal(&self, particle: usize) -> &Block {
        &self.diagonal[particle]
    }

    /// Returns the block of a slot: row i, column j for the pair (i, j), i < j.
    ///
    /// # Panics
    ///
    /// If there is no such slot.
    #[must_use]
    pub fn slot(&self, slot: u32) -> &Block {
        &self.off[slot as usize]
    }

    /// Adds the second derivative of a force along the line between two particles: `k` to both
    /// diagonal blocks, and −`k` off the diagonal. `k` must be symmetric.
    ///
    /// # Panics
    ///
    /// If there is no such slot or particle.
    #[inline]
    pub fn add_pair(&mut self, slot: u32, ends: [u32; 2], k: &Block) {
        for end in ends {
            let sum = &mut self.diagonal[end as usize];
            *sum = sum.plus(1.0, k);
        }
        let sum = &mut self.off[slot as usize];
        *sum = sum.plus(-1.0, k);
    }

    /// Adds a block at row `i`, column `j`. If both are equal, it is added to the diagonal, and
    /// `slot` is ignored.
    ///
    /// # Panics
    ///
    /// If there is no such slot or particle.
    #[inline]
    pub fn add(&mut self, slot: u32, [i, j]: [u32; 2], block: &Block) {
        if i == j {
            let sum = &mut self.diagonal[i as usize];
            *sum = sum.plus(1.0, block);
        } else {
            let sum = &mut self.off[slot as usize];
            *sum = if i < j {
                sum.plus(1.0, block)
            } else {
                sum.plus(1.0, &block.transposed())
            };
        }
    }

    /// Computes the product with a vector for each particle, into `out`. `pairs` are the particles
    /// of each slot, as [`Layout::pairs`](crate::implicit::Layout::pairs) returns them.
    ///
    /// # Panics
    ///
    /// If the lengths of the slices do not match the matrix.
    pub fn product(&self, pairs: &[[u32; 2]], x: &[Vector], out: &mut Vec<Vector>) {
        assert!(x.len() == self.diagonal.len(), "one vector a particle");
        assert!(pairs.len() == self.off.len(), "one block a slot");
        out.clear();
        out.extend(self.diagonal.iter().zip(x).map(|(b, &x)| b.times(x)));
        for (block, &[i, j]) in self.off.iter().zip(pairs) {
            let (i, j) = (i as usize, j as usize);
            let (xi, xj) = (x[i], x[j]);
            out[i] += block.times(xj);
            out[j] += block.transposed_times(xi);
        }
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

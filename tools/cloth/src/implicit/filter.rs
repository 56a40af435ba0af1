//! In which directions a particle is held.

use tearmesh::geometry::{Vector, dot};

use super::matrix::Block;

/// In which directions a particle is free. What is held keeps the velocity that it was given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Filter {
    /// In all.
    #[default]
    Free,
    /// Not along this normal, of length one.
    Plane(Vector),
    /// Only along this direction, of length one.
    Line(Vector),
    /// In none.
    Fixed,
}

impl Filter {
    /// What of a vector lies in the free directions.
    #[inline]
    #[must_use]
    pub fn apply(&self, v: Vector) -> Vector {
        match *self {
            Filter::Free => v,
            Filter::Plane(n) => v - n * dot(n, v),
            Filter::Line(d) => d * dot(d, v),
            Filter::Fixed => Vector::zeros(),
        }
    }

    /// Whether the direction, if it has one, is of length one to 1e-9.
    pub(super) fn is_usable(&self) -> bool {
        match *self {
            Filter::Free | Filter::Fixed => true,
            // Written so that a NaN is refused too.
            Filter::Plane(n) | Filter::Line(n) => (dot(n, n) - 1.0).abs() < 2e-9,
        }
    }

    /// The inverse of a block within the free directions; `None` if it is not definite there.
    pub(super) fn inverse(&self, block: &Block) -> Option<Block> {
        match *self {
            Filter::Free => block.inverse_if_definite(),
            Filter::Fixed => Some(Block::ZERO),
            Filter::Line(d) => {
                let k = dot(d, block.times(d));
                (k > 0.0).then(|| Block::ZERO.plus(1.0 / k, &Block::outer(d, d)))
            }
            Filter::Plane(n) => {
                let nn = Block::outer(n, n);
                let s = Block::identity_times(1.0).plus(-1.0, &nn);
                let scale = (block.0[0][0].abs()).max(block.0[1][1].abs().max(block.0[2][2].abs()));
                let within = s.times_block(block).times_block(&s).plus(scale, &nn);
                let inverse = within.inverse_if_definite()?;
                Some(s.times_block(&inverse).times_block(&s))
            }
        }
    }
}

//! The mixture of old values that a new value is.

use crate::id::HalfEdgeId;

/// The one, two or three values that a new value derives from.
///
/// A copy has its own case because it must be exact to the bit, and interpolation because a value
/// between two equal values must equal them. A general weighted sum guarantees neither.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Mix<I> {
    /// A copy of one value.
    Copy(I),
    /// The interpolated value `ends[0] + t (ends[1] − ends[0])`.
    Between {
        /// The two values to interpolate between.
        ends: [I; 2],
        /// The fraction of the way from `ends[0]` to `ends[1]`, from 0 to 1.
        t: f64,
    },
    /// The weighted sum of three values.
    Weighted {
        /// The three values to be added.
        of: [I; 3],
        /// The weights of the values, in the same order. They are positive, and their sum is one up
        /// to rounding.
        weights: [f64; 3],
    },
}

impl<I> Mix<I> {
    /// Returns this mix with each source replaced by the result of `f`. It can, for example,
    /// replace ids by their values.
    #[must_use]
    pub fn map<J>(self, f: impl FnMut(I) -> J) -> Mix<J> {
        let mut f = f;
        match self {
            Mix::Copy(one) => Mix::Copy(f(one)),
            Mix::Between { ends, t } => Mix::Between {
                ends: ends.map(f),
                t,
            },
            Mix::Weighted { of, weights } => Mix::Weighted {
                of: of.map(f),
                weights,
            },
        }
    }

    /// Returns the source with the largest weight, or the first of several with equal weights. Use
    /// it for values that cannot be interpolated, such as the index of a bone or a material.
    ///
    /// ```
    /// use tearmesh::Mix;
    ///
    /// assert_eq!(Mix::Between { ends: ["hip", "knee"], t: 0.75 }.nearest(), "knee");
    /// assert_eq!(Mix::Weighted { of: [7, 8, 9], weights: [0.25, 0.5, 0.25] }.nearest(), 8);
    /// ```
    #[must_use]
    pub fn nearest(self) -> I {
        match self {
            Mix::Copy(one) => one,
            Mix::Between { ends: [_, b], t } if t > 0.5 => b,
            Mix::Between { ends: [a, _], .. } => a,
            Mix::Weighted {
                of: [a, b, c],
                weights: [wa, wb, wc],
            } => {
                if wa >= wb && wa >= wc {
                    a
                } else if wb >= wc {
                    b
                } else {
                    c
                }
            }
        }
    }
}

impl Mix<HalfEdgeId> {
    /// The weights of the corners of the face that these corners belong to, in its order.
    pub(crate) fn weights(self) -> [f64; 3] {
        let mut all = [0.0; 3];
        match self {
            Mix::Copy(h) => all[h.corner()] = 1.0,
            Mix::Between { ends: [a, b], t } => {
                all[a.corner()] = 1.0 - t;
                all[b.corner()] = t;
            }
            Mix::Weighted { weights, .. } => all = weights,
        }
        all
    }
}

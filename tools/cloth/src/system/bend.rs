//! Bending as buckling: Choi and Ko 2002 §4.2, between particles two apart.
//!
//! Pushed together from the rest distance L to d, the cloth between buckles into an arc of
//! length L and curvature κ = (2/L) sinc⁻¹(d/L). With t = κL/2, d = L sin t / t:
//!
//! ```text
//! energy  E(d) = ½ k κ² L = 2 k t² / L
//! force   f(d) = E′ = k κ² / (cos t − sinc t)          (negative: it pushes apart)
//! ```
//!
//! At d = L that force does not vanish: it is the buckling load 12 k / L². So near L a plain
//! spring acts instead, f = `max(f_b, c (d − L))`; beyond L nothing does. The energy is continued
//! across the change-over, so that forces are its exact gradient. For one change-over to exist the
//! spring has to be stiffer than the arc at d = 0: c > 4π² k / L³. The stiffness of a constraint is
//! c, and the [`Buckling`] of all says what k is to it.
//!
//! All force here is compression, so the stiffness across the line is always negative; Choi and Ko
//! drop it and keep the slope along the line, which is positive.
//!
//! **Correction.** The polynomial of degree four in d/L that is in common use for `f_b`,
//! −11.541 x⁴ + 34.193 x³ − 39.083 x² + 23.116 x − 9.713, has to be multiplied by 4 k / L². It is
//! not used here.
//!
//! **No sine and no root.** With u = t², sinc t, (sinc t − cos t) / t² and what the slope needs
//! are power series in u that converge at once for u up to π². So the inverse is found in u by
//! Newton's method on a convex falling function from its left, where each step is monotone,
//! and the force is −4 k / (L² p(u)) without cancellation at d = L, where the formula above
//! divides zero by zero. Only + − × ÷ in a fixed order: the same bits on every machine.

/// The law by which bend constraints yield under compression: like a spring at first, and then as a
/// buckled arc (Choi and Ko 2002 §4.2).
///
/// Relative to c L and c L², the force and energy of a bend of rest length L at length d depend on
/// d/L and on the number c L³ / k alone. That number follows from the d/L at which the arc takes
/// over from the spring.
///
/// ```
/// use tearmesh_cloth::Buckling;
///
/// let law = Buckling::new(0.95).unwrap();
/// // The resistance of a strip of 10 cm with a flexural stiffness of 1e-6 N m², until it buckles.
/// let stiffness_n_per_m = law.compression_n_per_m(1e-6, 0.1);
/// assert!((stiffness_n_per_m - 0.247).abs() < 1e-3);
/// assert!(Buckling::new(1.0).is_none() && Buckling::new(0.59).is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Buckling {
    /// d/L at the change-over.
    below: f64,
    /// c L³ / k.
    number: f64,
    /// What is added to the energy of the arc, by c L².
    shift: f64,
}

impl Buckling {
    /// Creates the law by which a bend acts as an arc below this fraction of its rest length, and
    /// as a spring above it. The nearer to 1, the stiffer the spring: c L³ / k is 4 / (p (1 −
    /// d/L)), which is 247 for 0.95.
    ///
    /// Returns `None` unless the fraction is below 1 and above 0.592, where c L³ / k is 4π². A
    /// softer spring would take over again where the ends are near each other.
    #[must_use]
    pub fn new(buckles_below: f64) -> Option<Buckling> {
        if !(buckles_below > 0.0 && buckles_below < 1.0) {
            return None;
        }
        let u = inverse_sinc_squared(buckles_below);
        let gap = 1.0 - buckles_below;
        let [_, p, _] = series(u);
        let number = 4.0 / (p * gap);
        let pi = std::f64::consts::PI;
        let buckles_once = number > 4.0 * (pi * pi) && number.is_finite();
        buckles_once.then_some(Buckling {
            below: buckles_below,
            number,
            shift: 0.5 * (gap * gap) - 2.0 * u / number,
        })
    }

    /// Returns the stiffness c against compression, in N/m, of a bend with the flexural stiffness k
    /// and the rest length L.
    #[must_use]
    pub fn compression_n_per_m(&self, flexural_n_m2: f64, rest_length_m: f64) -> f64 {
        self.number * flexural_n_m2 / (rest_length_m * rest_length_m * rest_length_m)
    }

    /// The largest stiffness at any length, as a multiple of c: that of the spring, or that of the arc where
    /// both ends meet, 12π² k / L³. The arc's force is concave in d, so it is nowhere stiffer.
    pub(crate) fn stiffest(self) -> f64 {
        let pi = std::f64::consts::PI;
        (12.0 * (pi * pi) / self.number).max(1.0)
    }

    /// Energy, force and slope of a bend of this rest length L and stiffness c against compression with
    /// the ends so far apart; nothing of one without stiffness.
    pub(crate) fn axial(self, rest: f64, compression: f64, distance: f64) -> Axial {
        let (l, c, gap) = (rest, compression, distance - rest);
        if gap >= 0.0 || c <= 0.0 {
            return Axial::default();
        }
        let [energy, force, slope] = if distance >= self.below * l {
            [0.5 * c * (gap * gap), c * gap, c]
        } else {
            let k = c * (l * l * l) / self.number;
            let u = inverse_sinc_squared(distance / l);
            let [_, p, r] = series(u);
            let energy = 2.0 * k * u / l + self.shift * (c * (l * l));
            let slope = 4.0 * k / (l * l * l) * (r / (p * p * p));
            [energy, -4.0 * k / (l * l * p), slope]
        };
        Axial {
            energy,
            force,
            slope,
        }
    }
}

/// An energy that depends on a distance, with its first two derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Axial {
    pub(crate) energy: f64,
    pub(crate) force: f64,
    pub(crate) slope: f64,
}

/// The terms of the power series; that of u^k has the divisor (2k + 1)! at least, so that the
/// first one left out is below 1e-17 for u up to π².
const TERMS: usize = 16;

/// The coefficients of (−u)^k, weight(k) / (2k + first)!: of sinc for `first` = 1, of p for 3,
/// of r for 5.
const fn coefficients(first: usize) -> [f64; TERMS] {
    let mut list = [0.0; TERMS];
    let mut k = 0;
    while k < TERMS {
        let even = 2.0 * k as f64;
        let weight = match first {
            1 => 1.0,
            3 => even + 2.0,
            _ => (even + 4.0) * (even + 2.0),
        };
        let (mut factorial, mut i) = (1.0, 1);
        while i <= 2 * k + first {
            factorial *= i as f64;
            i += 1;
        }
        list[k] = weight / factorial;
        k += 1;
    }
    list
}

const SERIES: [[f64; TERMS]; 3] = [coefficients(1), coefficients(3), coefficients(5)];

/// sin t / t of u = t², for t in 0 … π.
pub(crate) fn sinc_of_root(u: f64) -> f64 {
    series(u)[0]
}

/// Functions of u = t², for t in 0 … π, by Horner's rule: sin t / t; p = (sinc t − cos t) / t², which is −2
/// times the derivative of sinc by u; and r = (3 p − sinc) / t².
fn series(u: f64) -> [f64; 3] {
    let [mut sinc, mut p, mut r] = [0.0; 3];
    for k in (0..TERMS).rev() {
        sinc = SERIES[0][k] - u * sinc;
        p = SERIES[1][k] - u * p;
        r = SERIES[2][k] - u * r;
    }
    [sinc, p, r]
}

/// t² for which sin t / t is `x`, x in 0 … 1.
fn inverse_sinc_squared(x: f64) -> f64 {
    let y = 1.0 - x;
    // The inverse series, cut off: its terms are positive, so this lies to the left.
    let mut u = y * (6.0 + y * (1.8 + y * (144.0 / 175.0)));
    // From the worst start, x = 0, five steps reach the last bit; rounding ends the climb.
    for _ in 0..8 {
        let [sinc, p, _] = series(u);
        let next = u + 2.0 * (sinc - x) / p;
        if next <= u {
            break;
        }
        u = next;
    }
    u
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_agree_with_the_system() {
        for i in 1..=1000 {
            let t = std::f64::consts::PI * f64::from(i) / 1000.0;
            let [sinc, p, r] = series(t * t);
            let truth = t.sin() / t;
            assert!((sinc - truth).abs() < 4e-16, "sinc {t}: {sinc} {truth}");
            let truth = (truth - t.cos()) / (t * t);
            // The closed form cancels for small t, and both sides round at last.
            let rounding = 4e-16 / (t * t) + 1e-16;
            assert!((p - truth).abs() < rounding, "p {t}: {p} {truth}");
            let truth = (3.0 * truth - t.sin() / t) / (t * t);
            assert!((r - truth).abs() < 4.0 * rounding / (t * t), "r {t}: {r}");
        }
        assert_eq!(series(0.0), [1.0, 1.0 / 3.0, 1.0 / 15.0]);
    }

    #[test]
    fn the_inverse_finds_what_sinc_was_given() {
        for i in 0..=1000 {
            let t = std::f64::consts::PI * f64::from(i) / 1000.0;
            let x = if i == 0 { 1.0 } else { t.sin() / t };
            let u = inverse_sinc_squared(x);
            assert!((u - t * t).abs() < 2e-14, "{t}: {u}");
        }
    }
}

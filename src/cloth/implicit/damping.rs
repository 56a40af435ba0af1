//! How much of an oscillation a method swallows that physics does not.
//!
//! An undamped oscillation x″ = −ω² x, taken in steps Δt with z = ωΔt, is multiplied in each
//! step by a factor whose modulus is below one: backward Euler's is 1/√(1 + z²), so that 5 Hz at
//! 60 steps a second loses 99.9 % of its amplitude in a second. BDF2's is of order z⁴ below one.
//!
//! The slowest mode decides what is left of the motion that one sees:
//! [`Implicit::slowest_frequency`] finds it.

use super::pcg::{End, Stop};
use super::{Implicit, Method, Model, ModelError, Work};
use crate::geometry::{Point, Vector, dot};

/// By what the amplitude of an oscillation is multiplied in a step, z = ωΔt in radians.
///
/// ```
/// use tearmesh::cloth::implicit::{Method, damping};
///
/// assert_eq!(damping::factor(Method::BackwardEuler, 0.75), 0.8);
/// assert!(1.0 - damping::factor(Method::Bdf2, 0.1) < 3e-5);
/// ```
#[must_use]
pub fn factor(method: Method, z: f64) -> f64 {
    match method {
        Method::BackwardEuler => 1.0 / (1.0 + z * z).sqrt(),
        Method::Bdf2 => {
            // The larger root of (3/2 − iz) ζ² − 2ζ + ½ = 0: ζ = (2 + √(1 + 2iz)) / (3 − 2iz).
            let modulus = (1.0 + 4.0 * z * z).sqrt();
            let re = (0.5 * (modulus + 1.0)).sqrt();
            let im = z / re;
            let above = (2.0 + re) * (2.0 + re) + im * im;
            (above / (9.0 + 4.0 * z * z)).sqrt()
        }
    }
}

/// The slowest mode of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlowestMode {
    /// Its angular frequency, in rad/s.
    pub frequency: f64,
    /// Whether it no longer changed.
    pub converged: bool,
    /// What it cost.
    pub work: Work,
}

impl Implicit {
    /// The lowest angular frequency of small motions about these positions, by inverse
    /// iteration.
    ///
    /// `floor`, in rad/s, is added to the matrix as floor² M, so that motions without a
    /// restoring force do not make it singular, and taken off the answer; frequencies far
    /// below it are not told from zero. With a floor of zero, or where the state is
    /// unstable by more than the floor, a matrix that is not definite gives `None`.
    ///
    /// Cost: up to 200 solves to 1e-10; meant to be asked once for a scene.
    ///
    /// # Errors
    ///
    /// Where the model or a position cannot be used.
    pub fn slowest_frequency(
        &mut self,
        model: &Model<'_>,
        positions: &[Point],
        floor: f64,
    ) -> Result<Option<SlowestMode>, ModelError> {
        let n = positions.len();
        self.prepare(model, positions, &vec![Vector::zeros(); n])?;
        let before = self.work;
        model.hessian(positions, &self.layout, false, &mut self.hessian);
        self.work.hessian_evaluations += 1;
        let stop = Stop {
            residual: 0.0,
            relative: 1e-10,
            iterations: 10_000,
        };
        // Any start that is not orthogonal to the mode will do; this one has no symmetry.
        let mut x: Vec<Vector> = (1..).take(n).map(start).collect();
        let (mut lowest, mut converged) = (f64::INFINITY, false);
        for _ in 0..200 {
            let filtered = x.iter().enumerate().map(|(i, &x)| model.filter(i).apply(x));
            x = filtered.collect();
            let size = weighted(model, &x, &x).sqrt();
            if size.is_nan() || size <= 0.0 {
                return Ok(None);
            }
            self.pcg.b.clear();
            for (x, m) in x.iter_mut().zip(model.masses) {
                *x /= size;
                self.pcg.b.push(*x * *m);
            }
            let pairs = self.layout.pairs();
            let solved = self.pcg.solve(
                model,
                &self.hessian,
                pairs,
                floor * floor,
                stop,
                &mut self.work,
            );
            if solved.end == End::Indefinite {
                return Ok(None);
            }
            // Rayleigh's quotient of y = A⁻¹ M x: yᵀ A y / yᵀ M y, with A y = M x.
            let y = &self.pcg.delta;
            let quotient = weighted(model, &x, y) / weighted(model, y, y);
            converged = (lowest - quotient).abs() <= 1e-13 * quotient;
            lowest = quotient;
            x.clone_from(y);
            if converged {
                break;
            }
        }
        Ok(Some(SlowestMode {
            frequency: (lowest - floor * floor).max(0.0).sqrt(),
            converged,
            work: self.work.since(&before),
        }))
    }
}

/// xᵀ M y.
fn weighted(model: &Model<'_>, x: &[Vector], y: &[Vector]) -> f64 {
    let pairs = x.iter().zip(y).zip(model.masses);
    pairs.fold(0.0, |sum, ((x, y), m)| sum + m * dot(*x, *y))
}

fn start(i: u32) -> Vector {
    let x = 1.0 / f64::from(i);
    Vector::new(1.0 + x, 1.0 - 0.5 * x, 1.0 + 0.3 * x * x)
}

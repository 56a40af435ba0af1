//! How much of an oscillation a method swallows that physics does not.
//!
//! An undamped oscillation x″ = −ω² x, taken in steps Δt with z = ωΔt, is multiplied in each
//! step by a factor whose modulus is below one: backward Euler's is 1/√(1 + z²), so that 5 Hz at
//! 60 steps a second loses 99.9 % of its amplitude in a second. BDF2's is of order z⁴ below one.
//!
//! The slowest mode decides what is left of the motion that one sees:
//! [`Implicit::slowest_frequency`] finds it, about a state of rest. For a scene:
//!
//! ```
//! use tearmesh_cloth::implicit::{Filter, Implicit, Method, Model, RestSettings, Spring, damping};
//! use tearmesh_cloth::{Loads, System};
//! use tearmesh::{Point, Vector};
//!
//! // A chain of a metre that hangs from its upper end. (A cloth is a system too: `Cloth::system`.)
//! let points = (0..11).map(|i| Point::new(0.0, 0.0, -0.1 * f64::from(i)));
//! let mut chain = System::new(points, vec![0.01; 11])?;
//! for i in 0..10 {
//!     chain.stretch([i, i + 1], 0.1, 50.0)?;
//! }
//! chain.hold(0);
//! let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -9.81));
//! chain.set_loads(Loads { gravity_m_per_s2, ..Loads::default() })?;
//!
//! // What the solver has to know of it, without drag, which damps by itself.
//! let hold = |i| if chain.is_held(i) { Filter::Fixed } else { Filter::Free };
//! let filters: Vec<Filter> = (0..chain.positions().len()).map(hold).collect();
//! let gravity = vec![chain.loads().gravity_m_per_s2.unwrap_or_default(); filters.len()];
//! let constraints = chain.stretches().iter().map(|id| chain.stretches().get(id));
//! let springs = constraints.map(|constraint| Spring {
//!     ends: constraint.ends.map(|end| end as u32),
//!     rest_length: constraint.rest_length_m,
//!     stiffness: constraint.stiffness_n_per_m,
//!     tension_only: false,
//! });
//! let springs: Vec<Spring> = springs.collect();
//! let model = Model {
//!     masses: chain.masses(),
//!     filters: &filters,
//!     accelerations: &gravity,
//!     springs: &springs,
//!     ..Model::default()
//! };
//!
//! // Its state of rest, and the slowest mode about that.
//! let mut solver = Implicit::new(&model)?;
//! let mut rest = chain.positions().to_vec();
//! solver.rest(&model, &mut rest, &RestSettings::default())?;
//! let slowest = solver.slowest_frequency(&model, &rest, 0.0)?.expect("tension makes it stable");
//!
//! // How much of that mode's amplitude is left after a second at 60 steps a second.
//! let left = |method| damping::factor(method, slowest.frequency / 60.0).powi(60);
//! assert!((slowest.frequency - 3.478_604).abs() < 1e-6 && slowest.converged);
//! assert!((left(Method::BackwardEuler) - 0.904).abs() < 0.001);
//! assert!(left(Method::Bdf2) > 0.999);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use tearmesh::geometry::{Point, Vector, dot};

use super::pcg::{End, Stop};
use super::{Implicit, Method, Model, ModelError, Work};

/// By what the amplitude of an oscillation is multiplied in a step, z = ωΔt in radians. The
/// [module](self) has an example of how to get that for a scene.
///
/// ```
/// use tearmesh_cloth::implicit::{Method, damping};
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

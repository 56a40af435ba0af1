//! The methods that advance a cloth, as data with their settings.

use crate::implicit::{Implicit, Settings};
use crate::provot::{Limiter, Provot};
use crate::solver::Solver;
use crate::verlet::Verlet;
use crate::xpbd::{Pbd, Xpbd};

/// A method that advances a cloth, with its settings.
///
/// ```
/// use tearmesh_cloth::{Method, System};
/// use tearmesh::Point;
///
/// let mut stone = System::new([Point::origin()], vec![1.0])?;
/// stone.step(&mut *Method::implicit().solver(), 0.01)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub enum Method {
    /// Provot's mass-spring model with its limiter ([`Provot`]). The tearing rule
    /// uses lengths before the limiter changes them.
    Provot(Limiter),
    /// Position based dynamics ([`Pbd`]).
    Pbd(Pbd),
    /// Velocity Verlet with guards ([`Verlet`]). This is the default, and exact at
    /// rest at every step.
    Verlet,
    /// Extended position based dynamics ([`Xpbd`]).
    Xpbd(Xpbd),
    /// An implicit method ([`Implicit`]).
    Implicit(Settings),
}

impl Method {
    /// Returns Provot's model with the settings that scenes use by default.
    #[must_use]
    pub fn provot() -> Method {
        Method::Provot(Limiter::default())
    }

    /// Returns [`Pbd`] with the settings that scenes use by default.
    #[must_use]
    pub fn pbd() -> Method {
        Method::Pbd(Pbd::default())
    }

    /// Returns [`Xpbd`] with the settings that scenes use by default. A step is one sweep, so that
    /// the cloth can tear after each sweep.
    #[must_use]
    pub fn xpbd() -> Method {
        Method::Xpbd(Xpbd::new(1, 1))
    }

    /// Returns [`Implicit`] with the settings that scenes use by default: an error
    /// of at most 0.2 mm/s in a step of 1/240 s.
    #[must_use]
    pub fn implicit() -> Method {
        Method::Implicit(Settings {
            tolerance: 10.0,
            ..Settings::default()
        })
    }

    /// Returns a solver with these settings, before its first step.
    #[must_use]
    pub fn solver(&self) -> Box<dyn Solver + Send + Sync> {
        match *self {
            Method::Provot(limiter) => Box::new(Provot::new(limiter)),
            Method::Pbd(pbd) => Box::new(pbd),
            Method::Verlet => Box::new(Verlet::new()),
            Method::Xpbd(xpbd) => Box::new(xpbd),
            Method::Implicit(settings) => Box::new(Implicit::new(settings)),
        }
    }
}

//! The methods that advance a cloth, as data with their settings; the step that suits each, and how soft
//! those that sweep leave a cloth at a step.

pub(crate) mod draw;
pub mod implicit;
pub(crate) mod motion;
pub(crate) mod provot;
pub(crate) mod solver;
mod spring;
pub(crate) mod stability;
mod step;
pub(crate) mod verlet;
pub(crate) mod xpbd;

use self::implicit::Implicit;
use self::implicit::settings::Settings;
use self::provot::{Limiter, Provot};
use self::solver::Solver;
use self::stability::whole_step_s;
use self::verlet::Verlet;
use self::xpbd::{Pbd, Xpbd};
use crate::system::System;
use crate::system::guard::Guard;

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
#[must_use]
#[derive(Clone, Debug)]
#[non_exhaustive]
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
    /// The names of the methods, as scenes and reports have them.
    pub const NAMES: [&str; 5] = ["provot", "pbd", "verlet", "xpbd", "implicit"];

    /// Returns the name of this method, one of [`Method::NAMES`].
    #[must_use]
    pub fn name(&self) -> &'static str {
        let [provot, pbd, verlet, xpbd, implicit] = Method::NAMES;
        match self {
            Method::Provot(_) => provot,
            Method::Pbd(_) => pbd,
            Method::Verlet => verlet,
            Method::Xpbd(_) => xpbd,
            Method::Implicit(_) => implicit,
        }
    }

    /// Returns the method of this name, with the settings that scenes use by default; `None` if no
    /// method has it.
    #[must_use]
    pub fn named(name: &str) -> Option<Method> {
        let projecting = [Method::pbd(), Method::xpbd()];
        let by_forces = [Method::provot(), Method::Verlet, Method::implicit()];
        let mut methods = projecting.into_iter().chain(by_forces);
        methods.find(|method| method.name() == name)
    }

    /// Returns Provot's model with the settings that scenes use by default.
    pub fn provot() -> Method {
        Method::Provot(Limiter::default())
    }

    /// Returns [`Pbd`] with the settings that scenes use by default.
    pub fn pbd() -> Method {
        Method::Pbd(Pbd::default())
    }

    /// Returns [`Xpbd`] with the settings that scenes use by default. A step is one sweep, so that
    /// the cloth can tear after each sweep.
    pub fn xpbd() -> Method {
        Method::Xpbd(Xpbd::new(1, 1))
    }

    /// Returns [`Implicit`] with the settings that scenes use by default: an error
    /// of at most 17 mm/s in a step of 1/240 s.
    pub fn implicit() -> Method {
        Method::Implicit(Settings {
            tolerance: 1000.0,
            ..Settings::default()
        })
    }

    /// Returns a solver with these settings, before its first step.
    #[must_use]
    pub fn solver(&self) -> Box<dyn Solver + Send + Sync> {
        match *self {
            Method::Provot(limiter) => Box::new(Provot::new(limiter)),
            Method::Pbd(pbd) => Box::new(pbd),
            Method::Verlet => Box::new(Verlet),
            Method::Xpbd(xpbd) => Box::new(xpbd),
            Method::Implicit(settings) => Box::new(Implicit::new(settings)),
        }
    }

    /// Returns the step in seconds that is taken where a scene or a definition sets none, for a system
    /// through which a pull travels at the speed c = √(k/ρ), in m/s. It is 1/60 s divided by a whole
    /// number.
    pub fn default_step_s(&self, system: &mut System, speed_m_per_s: f64) -> f64 {
        let (springs_part, part) = match self {
            Method::Verlet => (1.0 / Guard::WHOLE, 1.0),
            Method::Provot(_) => (1.0, OF_SPRINGS),
            Method::Implicit(_) | Method::Pbd(_) | Method::Xpbd(_) => (1.0, OF_WIND),
        };
        let stable_s = part * whole_step_s(system, &*self.solver(), springs_part);
        let limit_s = match self {
            Method::Implicit(_) => Some(FRAME_S / 4.0),
            _ => self.wanted_step_s(system, speed_m_per_s),
        };
        let shortest_s = limit_s.unwrap_or(stable_s).min(stable_s).min(LONGEST_S);
        FRAME_S / (FRAME_S / shortest_s).ceil().max(1.0)
    }

    /// The longest step at which a method that sweeps is about as stiff as the fabric. In a sweep a pull
    /// travels an edge or two of length h, and in the fabric it travels at the speed c = √(k/ρ); so the
    /// time for a sweep must not be much longer than h/c.
    pub(crate) fn wanted_step_s(&self, system: &System, speed_m_per_s: f64) -> Option<f64> {
        let sweeps = match self {
            Method::Xpbd(xpbd) => f64::from(xpbd.substeps.max(1)) * reach(xpbd.sweeps, 1.0),
            Method::Pbd(pbd) => reach(pbd.sweeps, pbd.fractions()[0]),
            Method::Provot(_) | Method::Verlet | Method::Implicit(_) => return None,
        };
        let stretches = system.stretches();
        if stretches.is_empty() {
            return None;
        }
        let lengths = stretches.springs().map(|(_, rest, _)| rest);
        let edge_m = lengths.sum::<f64>() / stretches.len() as f64;
        Some(sweeps * edge_m / speed_m_per_s)
    }

    /// At rest a sweep leaves each edge to those that are swept after it: l − L is F/k and in the mean
    /// F s (w + w′)/2 more, with s = Δt²/(1 + cΔt), so that with τ = s k (w + w′) it is too long by
    /// τ/2 of what it should be. Of that each further sweep leaves half of τ/(1 + τ): measured, .35, .32,
    /// .21 and .1 at τ = 2.9, 2, 1 and .5.
    pub(crate) fn softness(&self, system: &System, step_s: f64) -> Option<Softness> {
        let Method::Xpbd(xpbd) = self else {
            return None;
        };
        let drag_per_s = system.model.drag_per_s();
        let (mut sum, mut count) = (0.0, 0.0);
        for (ends, _, stiffness) in system.stretches().springs() {
            let [a, b] = ends.map(|end| system.inverse_masses()[end]);
            let rate = stiffness * (a + b);
            if rate > 0.0 {
                (sum, count) = (sum + rate, count + 1.0);
            }
        }
        if count == 0.0 {
            return None;
        }
        let extra = |step_s: f64| {
            let dt_s = step_s / f64::from(xpbd.substeps.max(1));
            let tau = dt_s * dt_s / (1.0 + dt_s * drag_per_s) * sum / count;
            let left = tau / (1.0 + tau);
            (1..xpbd.sweeps).fold(tau / 2.0, |extra, _| extra * (left / 2.0))
        };
        let mut shorter_s = step_s;
        while extra(shorter_s) > TOLERABLE_ERROR {
            shorter_s *= 0.95;
        }
        Some(Softness {
            extra: extra(step_s),
            step_s: shorter_s,
        })
    }
}

/// The duration of a frame of film or screen, in seconds. Steps that a run chooses are whole
/// fractions of it, forces are means over it, and the energy balance is checked once per frame.
pub const FRAME_S: f64 = 1.0 / 60.0;

/// The longest step in seconds that is chosen for any scene.
const LONGEST_S: f64 = FRAME_S / 2.0;

/// The part of the longest admitted step that is chosen where springs limit a method, by a bound that
/// itself is 1.4 times below the limit of even sheets; and where wind alone does. In motion a step that is
/// all but unstable errs by half.
const OF_SPRINGS: f64 = 0.925;
const OF_WIND: f64 = 0.7;

/// How far a pull travels in `sweeps` sweeps without a step in between, as a multiple of a sweep
/// that corrects everything: each makes good but a part of what the one before left, as in
/// diffusion.
fn reach(sweeps: u32, fraction: f64) -> f64 {
    (f64::from(sweeps.max(1)) * fraction).sqrt()
}

/// The error that a method may have by its own formula and no warning, as a fraction.
pub(crate) const TOLERABLE_ERROR: f64 = 0.01;

/// How much softer a cloth is left than its fabric.
pub(crate) struct Softness {
    /// The mean excess stretch of the edges of a cloth that hangs at rest, as a fraction of the
    /// stretch that the fabric's stiffness gives.
    pub(crate) extra: f64,
    /// The longest step in seconds at which the excess is tolerable.
    pub(crate) step_s: f64,
}

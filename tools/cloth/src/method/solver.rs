//! The trait that every solver implements, the report of a step that was taken, and the error of
//! one that was not.

use std::fmt;

use tearmesh::CutError;

use crate::method::implicit::settings as implicit;
use crate::system::System;
use crate::system::blow_up::{BlowUpSite, Digits};
use crate::system::error::SettingError;
use crate::system::guard::Frequency;

/// A method that advances a system.
///
/// ```
/// use tearmesh_cloth::{Failure, Solver, System};
///
/// /// Particles that fly straight on.
/// #[derive(Debug)]
/// struct Inertia;
///
/// impl Solver for Inertia {
///     fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
///         let (positions, velocities) = system.state_mut();
///         for (x, v) in positions.iter_mut().zip(velocities) {
///             *x += *v * dt_s;
///         }
///         Ok(())
///     }
/// }
/// ```
pub trait Solver: fmt::Debug {
    /// Advances positions and velocities by `dt_s` seconds. Colliders act afterwards.
    ///
    /// # Errors
    ///
    /// [`Failure`]; positions and velocities may then have any values, and [`System::step`]
    /// restores them.
    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure>;

    /// Returns the forces that the method supports, and its stability limits. By default it
    /// supports springs only, and is stable at any step.
    fn abilities(&self) -> Abilities {
        Abilities::default()
    }

    /// Checks that the settings of the method can be used. [`System::step`] calls this first.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the first setting that cannot be used.
    fn check(&self) -> Result<(), SettingError> {
        Ok(())
    }

    /// Returns how far the steps so far fell short of the model. `system` is the one that the method
    /// has just advanced. By default nothing is known.
    fn quality(&self, system: &System) -> Quality {
        let _ = system;
        Quality::Unknown
    }
}

/// The forces that a method supports, and its stability limits. By default a method supports
/// springs only, and is stable at any step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Abilities {
    /// The largest ω Δt at which the method is stable; `None` if there is no limit.
    pub frequency_limit: Option<f64>,
    /// The largest λ Δt at which the method is stable without springs; `None` if there is no limit.
    /// The rate λ is that at which wind slows the system ([`air_rate`](crate::air::air_rate)),
    /// plus that of drag if the method [`takes_drag_explicitly`](Abilities::takes_drag_explicitly).
    pub air_limit: Option<f64>,
    /// Whether the method evaluates drag at the velocities before a step, so that the rate of drag
    /// counts towards [`air_limit`](Abilities::air_limit).
    pub takes_drag_explicitly: bool,
    /// Whether neighbours carry the particles that are too light for a step. The step is then
    /// limited by [`recommended_step_s`](crate::recommended_step_s) instead of a bound of frequencies.
    pub carries_light: bool,
    /// Whether the method takes in the damping of springs ([`System::set_damping`]).
    pub damps: bool,
    /// Whether the method supports the forces of [`System::triangles`] and bends that buckle
    /// ([`System::set_buckling`]). A method that does not is refused if the system has any.
    pub takes_all_forces: bool,
}

impl Abilities {
    /// Returns the abilities of a method that supports all forces and is stable up to these limits.
    #[must_use]
    pub fn of_forces(frequency_limit: Option<f64>, air_limit: f64) -> Abilities {
        Abilities {
            frequency_limit,
            air_limit: Some(air_limit),
            takes_all_forces: true,
            ..Abilities::default()
        }
    }
}

/// How far the steps of a method fell short of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Quality {
    /// For Verlet: what its guards and the damping do at present.
    #[cfg_attr(feature = "serde", serde(rename = "guarded"))]
    Carried {
        /// The number of particles that are too light for the step, and so are carried by their neighbours.
        carried: usize,
        /// The largest mass of one of them in a step, as a multiple of its own; 1 if there is none.
        mass_ratio_max: f64,
        /// The share of damped edges that are damped by less than the fabric asks for, because of the cap on
        /// the damping ratio.
        damping_capped: f64,
    },
    /// For Provot's model: what its limiter did in all steps so far. Where a step was divided, each
    /// substep counts as a step.
    Limiter {
        /// The number of passes over all constraints.
        passes: u64,
        /// The number of steps after which some edge was still longer than the limit.
        steps_short: u64,
        /// The number of steps in which further passes no longer helped, because held particles are
        /// too far apart: the passes ran out, and the last one removed less than a hundredth of the
        /// excess.
        steps_infeasible: u64,
        /// The largest excess of a stretch ratio over the limit after a step; 0 if the limit was
        /// always met.
        excess_max: f64,
        /// The number of steps in which some edge was longer than the limit and was shortened.
        steps_limited: u64,
    },
    /// For XPBD: the largest difference, in newtons, between the force on a particle that the last
    /// substep used and the one that the springs have now.
    #[cfg_attr(feature = "serde", serde(rename = "residual_n"))]
    Residual(f64),
    /// For an implicit method: what its linear solver did.
    Implicit(implicit::Stats),
    /// The method does not say.
    Unknown,
}

impl Quality {
    /// Returns whether Provot's limiter has worked. Its work grows without bound as steps get shorter, on
    /// particles that are held as well: joules that it has a part in say nothing of the cloth.
    #[must_use]
    pub fn has_limited(&self) -> bool {
        matches!(self, Quality::Limiter { steps_limited, .. } if *steps_limited > 0)
    }
}

/// The reason why a method did not advance a system.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Failure {
    /// A number is not finite, or a constraint or a velocity is far too large.
    BlowUp,
    /// An implicit method found no state that solves its equation within the tolerance.
    Implicit(implicit::StepError),
    /// A particle went so far that it may have passed through a body. The step is then divided.
    TooFar {
        /// The index of the particle.
        particle: usize,
    },
}

impl Failure {
    /// Blow-up, unless what a method saw was sane.
    pub(crate) fn unless(sane: bool) -> Result<(), Failure> {
        if sane { Ok(()) } else { Err(Failure::BlowUp) }
    }
}

/// The reason why a step was not taken. Positions and velocities are as they were before, and so is
/// the balance of energy; [`Counters`](crate::Counters) count the attempt. If the step failed after
/// it began, the forces and ratios that the last step recorded in constraints are discarded.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StepError {
    /// The step is not a positive finite number of seconds.
    Step {
        /// The step that was given, in seconds.
        given_s: f64,
    },
    /// The method or the system has a setting with an unusable value.
    Setting(SettingError),
    /// The method supports springs only, and would ignore other forces of the system.
    NotSprings {
        /// The number of triangles, or of bend constraints that buckle.
        count: usize,
        /// A description of what they do.
        what: &'static str,
    },
    /// An explicit method, or one that evaluates drag or wind at the velocities before the step, would be
    /// unstable.
    Unstable {
        /// The step that was given, in seconds.
        given_s: f64,
        /// The largest step that is admitted, in seconds.
        limit_s: f64,
        /// What sets the limit: springs or the air, whichever more.
        by: StepLimit,
    },
    /// The step would need more than 10 000 substeps.
    Substeps {
        /// The step that was given, in seconds.
        given_s: f64,
        /// The largest step that is admitted, in seconds.
        limit_s: f64,
    },
    /// A number is not finite, or a constraint or a velocity is far too large.
    BlowUp {
        /// The simulated time of the last good state, in seconds. The system is in that state.
        elapsed_s: f64,
        /// The first particle that is not finite, or else the constraint or triangle with the
        /// largest stretch ratio. The search covers the state where the step began and the one
        /// where it was given up, before overstretched constraints are projected or limited.
        at: BlowUpSite,
    },
    /// An implicit method found no state that solves its equation within the tolerance of its
    /// [`Settings`](implicit::Settings). This is not a blow-up. A shorter step helps, as does a
    /// larger tolerance.
    Implicit {
        /// The simulated time of the last good state, in seconds. The system is in that state.
        elapsed_s: f64,
        /// The error of the implicit method, which is also the
        /// [`source`](std::error::Error::source).
        error: implicit::StepError,
    },
    /// A particle may pass through a [body](crate::Body), even in a sixty-fourth of the step: it would go
    /// farther than the thickness and a cell of the grid.
    TooFar {
        /// The simulated time of the last good state, in seconds. The system is in that state.
        elapsed_s: f64,
        /// The index of the particle.
        particle: usize,
    },
    /// Two colliders leave no room for a particle between them.
    Pressed {
        /// The simulated time of the last good state, in seconds. The system is in that state.
        elapsed_s: f64,
        /// The index of the particle.
        particle: usize,
        /// The indices of the colliders in [`Loads::colliders`](crate::Loads::colliders).
        colliders: [usize; 2],
    },
    /// A cut of the scene is refused on the cloth as it is then. Nothing was cut.
    Cut {
        /// The simulated time of the cut, in seconds.
        elapsed_s: f64,
        /// The reason, which is also the [`source`](std::error::Error::source).
        error: CutError,
    },
}

/// What sets the stability limit of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StepLimit {
    /// The frequency of springs.
    Springs(Frequency),
    /// The rate at which the air slows a particle.
    Air {
        /// A bound of the rate ([`air_rate`](crate::air::air_rate)), in 1/s.
        rate_per_s: f64,
        /// The index of the particle that sets the bound.
        particle: usize,
    },
}

impl StepError {
    /// The particles at which a step failed; none of them where it failed as a whole, and `None` where it was
    /// refused.
    pub(crate) fn failed_at(&self) -> Option<Vec<usize>> {
        match self {
            StepError::BlowUp { at, .. } => Some(at.particles()),
            StepError::TooFar { particle, .. } | StepError::Pressed { particle, .. } => {
                Some(vec![*particle])
            }
            StepError::Implicit { .. } => Some(Vec::new()),
            _ => None,
        }
    }

    /// The largest number of substeps into which a step is divided.
    pub(crate) const SUBSTEPS_MAX: u32 = 10_000;

    /// Returns the code of this error, such as `E-SIM-UNSTABLE`.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            StepError::Unstable { .. } | StepError::Substeps { .. } | StepError::TooFar { .. } => {
                "E-SIM-UNSTABLE"
            }
            StepError::Pressed { .. } => "E-SIM-PRESSED",
            StepError::Implicit { .. } => "E-SIM-UNSOLVED",
            StepError::Setting(_) => "E-SCENE-RANGE",
            StepError::Cut { .. } => "E-RAY-CROSS",
            _ => "E-SIM-BLOWUP",
        }
    }
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = match self {
            StepError::Step { given_s } => format!("dt {given_s} s is not a positive finite step"),
            StepError::Setting(error) => error.to_string(),
            StepError::Cut { elapsed_s, error } => {
                format!("the cut at {} s is refused: {error}", Digits(*elapsed_s))
            }
            StepError::NotSprings { count, what } => {
                format!("the method supports springs only, and {count} {what}")
            }
            StepError::Unstable {
                given_s,
                limit_s,
                by,
            } => {
                let limit = Digits(*limit_s);
                let why = match by {
                    StepLimit::Springs(frequency) => {
                        let at = frequency.ends.map(|[a, b]| format!(" at edge {a}-{b}"));
                        let omega = Digits(frequency.omega_rad_per_s);
                        format!(
                            "bound of frequencies {omega} rad/s{}",
                            at.unwrap_or_default()
                        )
                    }
                    StepLimit::Air {
                        rate_per_s,
                        particle,
                    } => {
                        let per_s = Digits(*rate_per_s);
                        format!("the air slows particle {particle} at a rate of {per_s} /s")
                    }
                };
                format!("dt {given_s} s exceeds the stability limit {limit} s ({why})")
            }
            StepError::Substeps { given_s, limit_s } => {
                let (most, limit) = (StepError::SUBSTEPS_MAX, Digits(*limit_s));
                format!("dt {given_s} s would take more than {most} substeps of {limit} s")
            }
            StepError::BlowUp { elapsed_s, at } => {
                format!("the system blew up after {elapsed_s} s: {at}; the last good state is kept")
            }
            StepError::Implicit { elapsed_s, error } => format!(
                "an implicit step failed after {elapsed_s} s: {error}; the last good state is kept"
            ),
            StepError::TooFar {
                elapsed_s,
                particle,
            } => format!(
                "particle {particle} is too fast for a collider after {elapsed_s} s, and may pass through it; \
                 the last good state is kept"
            ),
            StepError::Pressed {
                elapsed_s,
                particle,
                colliders: [one, other],
            } => format!(
                "the colliders {one} and {other} leave no room for particle {particle} after {elapsed_s} s; \
                 the last good state is kept"
            ),
        };
        f.write_str(&text)
    }
}

impl std::error::Error for StepError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            StepError::Implicit { error, .. } => Some(error),
            StepError::Cut { error, .. } => Some(error),
            StepError::Setting(error) => Some(error),
            _ => None,
        }
    }
}

//! What every solver shares: the trait, the watch over stability, and the way back.
//!
//! [`System::step`] is the one way to advance. It asks the stability limit of an explicit method
//! before, looks for blow-up after, and leaves the last good state where something failed.

use std::fmt;

use crate::air::{AirRate, AirShare};
use crate::balance::Noted;
use crate::culprit::Culprit;
use crate::digits::Digits;
use crate::implicit;
use crate::stability::Frequency;
use crate::system::{Left, System, Unstable};

/// A method that advances a system.
///
/// ```
/// use tearmesh_cloth::{Failure, Solver, System};
///
/// /// Particles that fly straight on.
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
pub trait Solver {
    /// Advances positions and velocities by this many seconds.
    ///
    /// # Errors
    ///
    /// [`Failure`]: positions and velocities may be anything then, and [`System::step`] goes back.
    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure>;

    /// The largest ω Δt at which the method is stable; `None` where there is none.
    fn frequency_limit(&self) -> Option<f64> {
        None
    }

    /// The largest λ Δt at which the method is stable without springs, where λ is a rate at which
    /// air slows the system that the method takes in by the velocities before a step: that of
    /// wind ([`System::wind_rate`]), and of drag where it
    /// [`takes_drag_explicitly`](Solver::takes_drag_explicitly). `None` where there is none.
    fn air_limit(&self) -> Option<f64> {
        None
    }

    /// Whether the method takes in drag by the velocities before a step, so that its rate counts
    /// for [`Solver::air_limit`].
    fn takes_drag_explicitly(&self) -> bool {
        false
    }

    /// Whether the settings of the method can be used. A step asks first.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the first that cannot.
    fn check(&self) -> Result<(), SettingError> {
        Ok(())
    }

    /// Whether the method takes in the forces of [`System::triangles`]. One that does not is
    /// refused where there are any.
    fn takes_triangles(&self) -> bool {
        false
    }

    /// Whether the method takes in the forces of bends that buckle, where
    /// [`System::set_buckling`] says that they do. One that does not is refused then.
    fn takes_buckling(&self) -> bool {
        false
    }
}

impl<S: Solver + ?Sized> Solver for &mut S {
    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        (**self).advance(system, dt_s)
    }

    fn frequency_limit(&self) -> Option<f64> {
        (**self).frequency_limit()
    }

    fn air_limit(&self) -> Option<f64> {
        (**self).air_limit()
    }

    fn takes_drag_explicitly(&self) -> bool {
        (**self).takes_drag_explicitly()
    }

    fn check(&self) -> Result<(), SettingError> {
        (**self).check()
    }

    fn takes_triangles(&self) -> bool {
        (**self).takes_triangles()
    }

    fn takes_buckling(&self) -> bool {
        (**self).takes_buckling()
    }
}

/// A setting that a method cannot be used with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettingError {
    /// The name of the setting.
    pub setting: &'static str,
    /// The number as given.
    pub given: f64,
    /// The numbers that it may have.
    pub allowed: &'static str,
}

impl SettingError {
    pub(crate) fn unless(
        holds: bool,
        setting: &'static str,
        given: f64,
        allowed: &'static str,
    ) -> Result<(), SettingError> {
        let error = SettingError {
            setting,
            given,
            allowed,
        };
        if holds { Ok(()) } else { Err(error) }
    }
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let SettingError {
            setting,
            given,
            allowed,
        } = self;
        write!(f, "{setting} is {given}, and may be {allowed}")
    }
}

impl std::error::Error for SettingError {}

/// Why a method did not advance a system.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Failure {
    /// Something grew beyond all measure, or is not a number.
    BlowUp,
    /// An implicit method found no state that solves its equation as exactly as it is to.
    Implicit(implicit::StepError),
}

impl Failure {
    /// Blow-up, unless what a method saw was sane.
    pub(crate) fn unless(sane: bool) -> Result<(), Failure> {
        if sane { Ok(()) } else { Err(Failure::BlowUp) }
    }
}

/// A step that was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// The substeps that the watch over stability took it in: 1 unless [`Unstable::Substep`].
    pub substeps: u32,
    /// The largest step in seconds that would have been admitted whole, by the bound or by the
    /// measured frequency, whichever decided; `None` where nothing had to be asked.
    pub limit_s: Option<f64>,
}

/// What a step that fails goes back to, but for positions and velocities.
#[derive(Clone, Copy)]
struct Began {
    elapsed_s: f64,
    left: Left,
    noted: Option<Noted>,
}

/// Why a step was not taken. The system is as it was before, and so is what the last step left
/// behind in constraints and in the balance of energy; [`Counters`](crate::Counters) count what was
/// tried.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StepError {
    /// The step is not a positive finite number of seconds.
    Step {
        /// The step as given.
        given_s: f64,
    },
    /// The method, or the system, has a setting that cannot be used.
    Setting(SettingError),
    /// The method knows springs alone, and would leave the triangles without force.
    Triangles {
        /// How many there are.
        count: usize,
    },
    /// The method knows springs alone, and would take bends that buckle for such.
    Buckling {
        /// How many there are.
        count: usize,
    },
    /// An explicit method would be unstable, by its springs more than by the air.
    Unstable {
        /// The step as given.
        given_s: f64,
        /// The largest step that is admitted, the margin included.
        limit_s: f64,
        /// The frequency that sets it.
        frequency: Frequency,
    },
    /// The air would make a method unstable that takes it in by the velocities before: alone, or
    /// more so than the springs.
    Air {
        /// The step as given.
        given_s: f64,
        /// The largest step that is admitted.
        limit_s: f64,
        /// The rate that sets it.
        rate: AirRate,
    },
    /// It would take more substeps than [`StepError::SUBSTEPS_MAX`].
    Substeps {
        /// The step as given.
        given_s: f64,
        /// The largest step that is admitted, the margin included.
        limit_s: f64,
    },
    /// Something grew beyond all measure, or is not a number.
    BlowUp {
        /// The seconds simulated until the last good state, where the system still is.
        elapsed_s: f64,
        /// The first particle that is not finite, or the constraint or triangle that is
        /// longest for its rest length, where the step began or where it was given up: before
        /// constraints that are beyond all measure are projected or limited.
        at: Culprit,
    },
    /// An implicit method found no state that solves its equation as exactly as its
    /// [`Settings`](implicit::Settings) say: no blow-up. A shorter step helps, and so do more of
    /// Newton's iterations or another tolerance.
    Implicit {
        /// The seconds simulated until the last good state, where the system still is.
        elapsed_s: f64,
        /// What failed; also the [`source`](std::error::Error::source).
        error: implicit::StepError,
    },
}

impl StepError {
    /// The most substeps that a step is divided into.
    pub const SUBSTEPS_MAX: u32 = 10_000;
}

impl System {
    /// Advances the system by `dt_s` seconds.
    ///
    /// # Errors
    ///
    /// [`StepError`], and the system is as it was before.
    pub fn step(
        &mut self,
        solver: &mut (impl Solver + ?Sized),
        dt_s: f64,
    ) -> Result<StepReport, StepError> {
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return Err(StepError::Step { given_s: dt_s });
        }
        solver.check().map_err(StepError::Setting)?;
        let ratio = self.model.stretch_ratio_max;
        SettingError::unless(ratio > 0.0, "stretch_ratio_max", ratio, "any above 0")
            .map_err(StepError::Setting)?;
        let count = self.triangles().len();
        if count > 0 && !solver.takes_triangles() {
            return Err(StepError::Triangles { count });
        }
        let count = self.model.bend.len();
        if count > 0 && self.model.buckling.is_some() && !solver.takes_buckling() {
            return Err(StepError::Buckling { count });
        }
        let admitted = self.admit(solver, dt_s);
        let report = admitted.map_err(|error| self.unless_broken(error))?;
        self.scratch.positions.clone_from(&self.positions);
        self.scratch.velocities.clone_from(&self.velocities);
        let began = Began {
            elapsed_s: self.elapsed_s,
            left: self.model.begin(),
            noted: self.noted(),
        };
        let substep_s = dt_s / f64::from(report.substeps);
        let at_end = solver.frequency_limit().is_none();
        let had_jumped = self.spectrum.jumped(false);
        for _ in 0..report.substeps {
            self.counters.substeps += 1;
            self.drive(substep_s);
            self.note_before();
            let advanced = solver.advance(self, substep_s);
            if let Err(failure) = advanced.and_then(|()| Failure::unless(self.is_finite())) {
                return Err(self.go_back(failure, began));
            }
            self.note_after(substep_s, at_end);
            self.elapsed_s += substep_s;
        }
        self.elapsed_s = began.elapsed_s + dt_s;
        // A method may set the state, and still moves it by no more than a step.
        self.spectrum.jumped(had_jumped);
        Ok(report)
    }

    /// A step that is refused in a state that is not finite is so for that: there its limit means
    /// nothing.
    fn unless_broken(&self, error: StepError) -> StepError {
        if self.is_finite() {
            return error;
        }
        StepError::BlowUp {
            elapsed_s: self.elapsed_s,
            at: Culprit::of(&self.model, &[(&self.positions, &self.velocities)]),
        }
    }

    /// Makes the system what it was before the step, and says why the step was not taken.
    fn go_back(&mut self, failure: Failure, began: Began) -> StepError {
        let elapsed_s = began.elapsed_s;
        let error = match failure {
            Failure::BlowUp => StepError::BlowUp {
                elapsed_s,
                at: self.given_up(),
            },
            Failure::Implicit(error) => StepError::Implicit { elapsed_s, error },
        };
        std::mem::swap(&mut self.positions, &mut self.scratch.positions);
        std::mem::swap(&mut self.velocities, &mut self.scratch.velocities);
        self.scratch.is_fresh = false;
        self.spectrum.jumped(true);
        self.model.back_to(began.left);
        self.elapsed_s = elapsed_s;
        self.note_back(began.noted);
        error
    }

    /// What is wrong with a step that blew up, by where it began, and where it was given up.
    fn given_up(&self) -> Culprit {
        let began = (&self.scratch.positions[..], &self.scratch.velocities[..]);
        let now = (&self.positions[..], &self.velocities[..]);
        Culprit::of(&self.model, &[began, now])
    }

    /// How many substeps a step takes, by the springs of an explicit method, and by air that a
    /// method takes in by the velocities before.
    fn admit(
        &mut self,
        solver: &(impl Solver + ?Sized),
        dt_s: f64,
    ) -> Result<StepReport, StepError> {
        let whole = StepReport {
            substeps: 1,
            limit_s: None,
        };
        if self.unstable == Unstable::Allow {
            return Ok(whole);
        }
        match (solver.frequency_limit(), self.air_share(solver)) {
            (Some(limit), air) => self.admit_springs(limit, air, dt_s),
            (None, Some(air)) => self.admit_air(air, dt_s),
            (None, None) => Ok(whole),
        }
    }

    /// The same by the springs, the cheap answer first; the share of the air shortens either.
    ///
    /// The bound holds wherever the particles go. A measured frequency is that of one
    /// configuration: springs that turn toward each other at a light particle can raise it to the
    /// bound within a few steps. So a step is divided by the bound, and one that is longer than
    /// that and admitted whole is measured again and again.
    fn admit_springs(
        &mut self,
        limit: f64,
        air: Option<AirShare>,
        dt_s: f64,
    ) -> Result<StepReport, StepError> {
        let springs_s = limit / self.frequency_bound();
        let bound_s = with_air(springs_s, air);
        if dt_s <= bound_s || self.unstable == Unstable::Substep {
            return divided(dt_s, bound_s);
        }
        let frequency = self.recent_frequency();
        let springs_s = (self.margin * limit / frequency.omega_rad_per_s).max(springs_s);
        let limit_s = with_air(springs_s, air);
        if dt_s <= limit_s {
            return divided(dt_s, limit_s);
        }
        match air.filter(|air| air.per_s * springs_s > 1.0) {
            Some(air) => Err(air.refused(dt_s, limit_s)),
            None => Err(StepError::Unstable {
                given_s: dt_s,
                limit_s,
                frequency,
            }),
        }
    }

    /// The same by the air alone.
    fn admit_air(&mut self, air: AirShare, dt_s: f64) -> Result<StepReport, StepError> {
        let limit_s = with_air(f64::INFINITY, Some(air));
        if dt_s <= limit_s || self.unstable == Unstable::Substep {
            return divided(dt_s, limit_s);
        }
        Err(air.refused(dt_s, limit_s))
    }

    /// The largest step in seconds that the watch admits whole in the present configuration, for
    /// a method with this limit of ω Δt: 2 for [`Verlet`](crate::Verlet). Measures the frequency.
    /// Springs alone: what wind takes of it is [`Solver::air_limit`] by [`System::wind_rate`].
    pub fn stable_step_s(&mut self, frequency_limit: f64) -> f64 {
        let bound_s = frequency_limit / self.frequency_bound();
        (self.margin * frequency_limit / self.frequency().omega_rad_per_s).max(bound_s)
    }

    /// The same for this method with the air that blows now; `None` where nothing limits it.
    pub(crate) fn whole_step_s(&mut self, solver: &impl Solver) -> Option<f64> {
        let springs_s = solver
            .frequency_limit()
            .map(|limit| self.stable_step_s(limit));
        match self.air_share(solver) {
            None => springs_s,
            air => Some(with_air(springs_s.unwrap_or(f64::INFINITY), air)),
        }
    }

    fn is_finite(&self) -> bool {
        // Sums are finite where their parts are, and cheaper to look at.
        let positions: f64 = self.positions.iter().map(|p| p.x + p.y + p.z).sum();
        let velocities: f64 = self.velocities.iter().map(|v| v.x + v.y + v.z).sum();
        (positions + velocities).is_finite()
    }
}

impl AirShare {
    /// A step that the air makes too long.
    fn refused(self, given_s: f64, limit_s: f64) -> StepError {
        StepError::Air {
            given_s,
            limit_s,
            rate: self.rate,
        }
    }
}

/// The longest stable step of springs and air together, in seconds, by that of the springs.
fn with_air(springs_s: f64, air: Option<AirShare>) -> f64 {
    air.map_or(springs_s, |air| 1.0 / (1.0 / springs_s + air.per_s))
}

/// A step in as many parts as are admitted.
fn divided(dt_s: f64, limit_s: f64) -> Result<StepReport, StepError> {
    let substeps = (dt_s / limit_s).ceil();
    if substeps > f64::from(StepError::SUBSTEPS_MAX) {
        return Err(StepError::Substeps {
            given_s: dt_s,
            limit_s,
        });
    }
    Ok(StepReport {
        substeps: (substeps as u32).max(1),
        limit_s: Some(limit_s),
    })
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StepError::Step { given_s } => {
                write!(f, "dt {given_s} s is not a positive finite step")
            }
            StepError::Setting(error) => error.fmt(f),
            StepError::Triangles { count } => write!(
                f,
                "the method knows springs alone, and {count} triangles resist stretch"
            ),
            StepError::Buckling { count } => write!(
                f,
                "the method knows springs alone, and {count} bends buckle"
            ),
            StepError::Unstable {
                given_s,
                limit_s,
                frequency,
            } => {
                let omega = frequency.omega_rad_per_s;
                write!(
                    f,
                    "dt {given_s} s exceeds the stability limit {} s (largest frequency {} rad/s",
                    Digits(*limit_s),
                    Digits(omega)
                )?;
                if let Some([a, b]) = frequency.ends {
                    write!(f, " at edge {a}-{b}")?;
                }
                f.write_str(")")
            }
            StepError::Air {
                given_s,
                limit_s,
                rate,
            } => write!(
                f,
                "dt {given_s} s exceeds the stability limit {} s (the air slows particle {} at a \
                 rate of {} /s)",
                Digits(*limit_s),
                rate.particle,
                Digits(rate.rate_per_s)
            ),
            StepError::Substeps { given_s, limit_s } => write!(
                f,
                "dt {given_s} s would take more than {} substeps of {} s",
                StepError::SUBSTEPS_MAX,
                Digits(*limit_s)
            ),
            StepError::BlowUp { elapsed_s, at } => {
                write!(
                    f,
                    "the system blew up after {elapsed_s} s: {at}; the last good state is kept"
                )
            }
            StepError::Implicit { elapsed_s, error } => write!(
                f,
                "an implicit step failed after {elapsed_s} s: {error}; the last good state is kept"
            ),
        }
    }
}

impl std::error::Error for StepError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            StepError::Implicit { error, .. } => Some(error),
            StepError::Setting(error) => Some(error),
            _ => None,
        }
    }
}

//! One step of a system: the watch over stability, and the way back.
//!
//! [`System::step`] is the one way to advance. It asks the stability limit of an explicit method
//! before, looks for blow-up after, and leaves the last good state where something failed.

use tearmesh::geometry::{Point, Vector, check_point};

use crate::air::AirRate;
use crate::balance::Noted;
use crate::culprit::Culprit;
use crate::guard::Guard;
use crate::solver::{Failure, SettingError, Solver, StepError, StepReport};
use crate::system::{Left, Model, System, Unstable};

/// What a step that fails goes back to, but for positions and velocities.
#[derive(Clone, Copy)]
struct Began {
    elapsed_s: f64,
    left: Left,
    noted: Option<Noted>,
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
            at: culprit(&self.model, &[(&self.positions, &self.velocities)]),
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
        culprit(&self.model, &[began, now])
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
        if solver.carries_light() {
            let air = self.air_share(solver);
            return self.admit_carried(air, dt_s);
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
        Err(self.refused(dt_s, springs_s, limit_s, air))
    }

    /// A step that springs and air make too long.
    fn refused(
        &mut self,
        given_s: f64,
        springs_s: f64,
        limit_s: f64,
        air: Option<AirShare>,
    ) -> StepError {
        match air.filter(|air| air.per_s * springs_s > 1.0) {
            Some(air) => air.refused(given_s, limit_s),
            None => StepError::Unstable {
                given_s,
                limit_s,
                frequency: self.recent_frequency(),
            },
        }
    }

    /// How many substeps a step takes with light particles carried: none up to twice the one that
    /// suits, and those that suit beyond; and so many more as it takes where that is not stable.
    fn admit_carried(&mut self, air: Option<AirShare>, dt_s: f64) -> Result<StepReport, StepError> {
        let suited_s = self.suited_step_s();
        let longest_s = Guard::WHOLE * suited_s;
        let mut limit_s = with_air(longest_s, air);
        let is_whole = dt_s <= limit_s;
        if !is_whole && self.unstable == Unstable::Refuse {
            return Err(self.refused(dt_s, longest_s, limit_s, air));
        }
        let suited_s = with_air(suited_s, air);
        let mut report = divided(dt_s, if is_whole { limit_s } else { suited_s })?;
        let air_per_s = air.map_or(0.0, |air| air.per_s);
        self.scratch.air_per_s = air_per_s;
        while !self.is_sound(dt_s / f64::from(report.substeps)) {
            limit_s = dt_s / f64::from(2 * report.substeps);
            report = divided(dt_s, limit_s)?;
        }
        if report.substeps > 1 && self.unstable == Unstable::Refuse {
            return Err(self.refused(dt_s, limit_s, limit_s, air));
        }
        Ok(StepReport {
            limit_s: Some(limit_s),
            ..report
        })
    }

    /// The step in seconds that suits [`Verlet`](crate::Verlet): the longest at which no more than a
    /// tenth of the particles have to be carried by their neighbours. A step of up to twice that is
    /// admitted whole. Springs alone, with triangles as they are stretched now; infinite where there
    /// are none. While a mesh is cut and torn it gets no shorter: what is light then is carried. A
    /// pass over all constraints where something has changed.
    pub fn suited_step_s(&mut self) -> f64 {
        let (model, counters) = (&self.model, &mut self.counters);
        let reach = self.spectrum.reach(model, &self.positions, counters);
        self.guard.suited_s(model, reach)
    }

    /// Weighs particles for steps of this length.
    pub(crate) fn weigh_for(&mut self, dt_s: f64) {
        let (reach, air) = (self.spectrum.known_reach(), dt_s * self.scratch.air_per_s);
        if self.guard.weigh(&self.model, reach, dt_s, air) {
            self.scratch.is_fresh = false;
        }
    }

    /// Whether steps of this length are stable with particles carried for it.
    fn is_sound(&mut self, dt_s: f64) -> bool {
        self.weigh_for(dt_s);
        self.guard.is_sound(&self.model, &mut self.counters)
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
        if solver.carries_light() {
            let longest_s = Guard::WHOLE * self.suited_step_s();
            return Some(with_air(longest_s, self.air_share(solver)));
        }
        let springs_s = solver
            .frequency_limit()
            .map(|limit| self.stable_step_s(limit));
        match self.air_share(solver) {
            None => springs_s,
            air => Some(with_air(springs_s.unwrap_or(f64::INFINITY), air)),
        }
    }

    /// The step that suits this method with the air that blows now; `None` where it carries nothing.
    pub(crate) fn suited_s(&mut self, solver: &impl Solver) -> Option<f64> {
        if !solver.carries_light() {
            return None;
        }
        let springs_s = self.suited_step_s();
        Some(with_air(springs_s, self.air_share(solver)))
    }

    /// What the air takes of a step by this method.
    fn air_share(&mut self, solver: &(impl Solver + ?Sized)) -> Option<AirShare> {
        let limit = solver.air_limit()?;
        let drag = match solver.takes_drag_explicitly() {
            true => self.drag_rate(),
            false => None,
        };
        let rate = match (self.wind_rate(), drag) {
            (Some(wind), Some(drag)) => AirRate {
                rate_per_s: wind.rate_per_s + drag.rate_per_s,
                ..wind
            },
            (wind, drag) => wind.or(drag)?,
        };
        let per_s = rate.rate_per_s / limit;
        Some(AirShare { rate, per_s })
    }

    fn is_finite(&self) -> bool {
        // Sums are finite where their parts are, and cheaper to look at.
        let positions: f64 = self.positions.iter().map(|p| p.x + p.y + p.z).sum();
        let velocities: f64 = self.velocities.iter().map(|v| v.x + v.y + v.z).sum();
        (positions + velocities).is_finite()
    }
}

/// What the air takes of a step.
#[derive(Clone, Copy, Debug)]
struct AirShare {
    rate: AirRate,
    /// One over the longest step in seconds that is stable without springs.
    per_s: f64,
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

/// Positions and velocities.
type State<'a> = (&'a [Point], &'a [Vector]);

/// What is wrong with a step that was given up, by the states that are known of it, the oldest first:
/// the first particle that is not finite, or the longest constraint beyond all measure, or the first
/// particle that is, of the first state that has one.
fn culprit(model: &Model, states: &[State<'_>]) -> Culprit {
    let shown = states.iter().find_map(|&state| {
        let too_long = || model.longest(state.0).beyond(model.stretch_ratio_max);
        let named = broken(state).or_else(too_long);
        named.or_else(|| beyond(state))
    });
    let last = || model.longest(states.last()?.0).beyond(f64::NEG_INFINITY);
    shown.or_else(last).unwrap_or(Culprit::Unknown)
}

fn broken((positions, velocities): State<'_>) -> Option<Culprit> {
    let mut particles = positions.iter().zip(velocities);
    let bad = |(p, v): (&Point, &Vector)| !p.iter().chain(v.iter()).all(|x| x.is_finite());
    particles.position(bad).map(Culprit::Particle)
}

fn beyond((positions, velocities): State<'_>) -> Option<Culprit> {
    let mut particles = positions.iter().zip(velocities);
    let far =
        |(&p, &v): (&Point, &Vector)| [p, v.into()].map(check_point).iter().any(Result::is_err);
    particles.position(far).map(Culprit::Beyond)
}

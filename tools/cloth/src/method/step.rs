//! Advances a system by one step, or restores it if the step fails.
//!
//! [`System::step`] is the only way to advance a system. It checks the stability limit of an
//! explicit method before the step and looks for blow-up after it. If anything fails, the last good
//! state is kept. Nothing is copied for that as a step begins: explicit methods write where particles
//! go beside where they were ([`kick_and_drift`](crate::method::motion::kick_and_drift)), and for all others, whoever
//! changes the state first copies it ([`System::keep`]).

use tearmesh::geometry::{Point, Vector};

use crate::method::draw::Acts;
use crate::method::solver::{Failure, Solver, StepError};
use crate::method::stability::admit;
use crate::system::System;
use crate::system::balance::Balance;
use crate::system::blow_up::{BlowUpSite, first, is_beyond};
use crate::system::collide;
use crate::system::error::SettingError;
use crate::system::model::{Model, Recorded};

impl System {
    /// Advances the system by `dt_s` seconds, and returns the number of substeps into which the stability check
    /// divided the step, or into which it was divided because a particle might have passed through a
    /// [body](crate::Body) otherwise.
    ///
    /// # Errors
    ///
    /// [`StepError`]; positions and velocities are then as they were before. If the step failed
    /// after it began, nothing is left behind in constraints.
    pub fn step(&mut self, solver: &mut dyn Solver, dt_s: f64) -> Result<u32, StepError> {
        self.step_observed(solver, dt_s, None)
    }

    /// Advances the system by `dt_s` seconds, with a balance of its energy that sees each substep.
    ///
    /// # Errors
    ///
    /// The errors of [`System::step`].
    pub fn step_observed(
        &mut self,
        solver: &mut dyn Solver,
        dt_s: f64,
        mut balance: Option<&mut Balance>,
    ) -> Result<u32, StepError> {
        check(self, solver, dt_s)?;
        let admitted = admit(self, solver, dt_s);
        let substeps = admitted.map_err(|error| unless_broken(self, error))?;
        let mut parts = substeps;
        loop {
            let taken = self.take(solver, dt_s, parts, balance.as_deref_mut());
            match taken.map_err(|failure| (failure, go_back(self, failure))) {
                Err((Failure::TooFar { .. }, _)) if parts < PARTS_MAX * substeps => parts *= 2,
                taken => return taken.map(|()| parts).map_err(|(_, error)| error),
            }
        }
    }

    /// Takes a step in so many substeps.
    fn take(
        &mut self,
        solver: &mut dyn Solver,
        dt_s: f64,
        substeps: u32,
        mut balance: Option<&mut Balance>,
    ) -> Result<(), Failure> {
        // Positions and velocities are kept once the method changes them; those who are led are given new
        // velocities before that.
        self.scratch.is_beginning = true;
        self.scratch.led.clear();
        let led = self.model.grabbed.iter().map(|(particle, _)| *particle);
        let led = led.map(|particle| (particle, self.velocities[particle as usize]));
        self.scratch.led.extend(led);
        let (began_s, damped_j, drawn_j) = (self.elapsed_s, self.damped_j, self.drawn_j);
        let work = balance.as_ref().map(|balance| balance.work);
        self.model.recorded = Recorded::Nothing;
        self.model.is_damped = solver.abilities().damps;
        let substep_s = dt_s / f64::from(substeps);
        for _ in 0..substeps {
            if let Err(failure) = advance(self, solver, substep_s, balance.as_deref_mut()) {
                (self.elapsed_s, self.damped_j, self.drawn_j) = (began_s, damped_j, drawn_j);
                if let Some((balance, work)) = balance.zip(work) {
                    balance.work = work;
                }
                return Err(failure);
            }
        }
        self.elapsed_s = began_s + dt_s;
        Ok(())
    }
}

/// A step in which a particle may pass through a body is divided in two as often as makes this.
const PARTS_MAX: u32 = 64;

/// Whether a method can take such a step of such a system at all.
fn check(system: &System, solver: &dyn Solver, dt_s: f64) -> Result<(), StepError> {
    if !(dt_s > 0.0 && dt_s.is_finite()) {
        return Err(StepError::Step { given_s: dt_s });
    }
    solver.check().map_err(StepError::Setting)?;
    let (setting, given) = ("stretch_ratio_max", system.model.stretch_ratio_max);
    SettingError::unless(given > 0.0, setting, given, "finite and above 0")
        .map_err(StepError::Setting)?;
    if solver.abilities().takes_all_forces {
        return Ok(());
    }
    let bend = &system.model.bend;
    let bends = bend.law.map_or(0, |_| bend.len());
    let triangles = (system.triangles().len(), "triangles resist stretch");
    let mut others = [triangles, (bends, "bends buckle")].into_iter();
    if let Some((count, what)) = others.find(|(count, _)| *count > 0) {
        return Err(StepError::NotSprings { count, what });
    }
    Ok(())
}

fn advance(
    system: &mut System,
    solver: &mut dyn Solver,
    substep_s: f64,
    mut balance: Option<&mut Balance>,
) -> Result<(), Failure> {
    system.counters.substeps += 1;
    // Those who are led go along their paths.
    for (particle, path) in &system.model.grabbed {
        let to = path.at(system.elapsed_s + substep_s);
        let particle = *particle as usize;
        system.velocities[particle] = (to - system.positions[particle]) / substep_s;
    }
    if let Some(balance) = balance.as_deref_mut() {
        balance.before(system);
    }
    // A method that carries light particles does it by itself, and so does one that projects.
    let abilities = solver.abilities();
    if abilities.takes_all_forces && !abilities.carries_light {
        system.draw(substep_s, Acts::AtOnce);
    }
    collide::begin(system, substep_s, balance.is_some());
    solver.advance(system, substep_s)?;
    let contact = collide::push_out(system);
    if let Some(particle) = collide::too_far(system) {
        return Err(Failure::TooFar { particle });
    }
    Failure::unless(is_finite(system))?;
    if let Some(balance) = balance {
        // Methods without a stability limit move particles by the forces at the end of a substep.
        let moves_at_end = solver.abilities().frequency_limit.is_none();
        balance.after(system, substep_s, moves_at_end, contact);
    }
    system.elapsed_s += substep_s;
    Ok(())
}

fn is_finite(system: &System) -> bool {
    // Sums are finite where their parts are, and cheaper to look at.
    let particles = system.positions.iter().zip(&system.velocities);
    let sum = particles.fold(Vector::zeros(), |sum, (x, v)| sum + (x.coords + v));
    (sum.x + sum.y + sum.z).is_finite()
}

/// A step that is refused in a state that is not finite is so for that: there its limit means
/// nothing.
fn unless_broken(system: &System, error: StepError) -> StepError {
    if is_finite(system) {
        return error;
    }
    StepError::BlowUp {
        elapsed_s: system.elapsed_s,
        at: blow_up_site(&system.model, &[(&system.positions, &system.velocities)]),
    }
}

/// Puts the system back to the state in which the step began, and says why the step was not taken.
fn go_back(system: &mut System, failure: Failure) -> StepError {
    let elapsed_s = system.elapsed_s;
    system.keep();
    let scratch = &mut system.scratch;
    for &(particle, velocity) in &scratch.led {
        scratch.velocities[particle as usize] = velocity;
    }
    let began = (&scratch.positions[..], &scratch.velocities[..]);
    let now = (&system.positions[..], &system.velocities[..]);
    let error = match failure {
        Failure::BlowUp => StepError::BlowUp {
            elapsed_s,
            at: blow_up_site(&system.model, &[began, now]),
        },
        Failure::Implicit(error) => StepError::Implicit { elapsed_s, error },
        Failure::TooFar { particle } => match collide::pressing(system, particle) {
            Some(colliders) => StepError::Pressed {
                elapsed_s,
                particle,
                colliders,
            },
            None => StepError::TooFar {
                elapsed_s,
                particle,
            },
        },
    };
    std::mem::swap(&mut system.positions, &mut system.scratch.positions);
    std::mem::swap(&mut system.velocities, &mut system.scratch.velocities);
    system.scratch.is_fresh = false;
    system.scratch.lose_contact();
    system.model.recorded = Recorded::Nothing;
    error
}

/// Positions and velocities.
type State<'a> = (&'a [Point], &'a [Vector]);

/// What is wrong with a step that was given up, by the states that are known of it, the oldest
/// first: the first particle that is not finite, or else the longest constraint beyond the largest
/// stretch ratio, or else the first particle that is too far away or too fast. The first state that
/// shows any of these counts.
fn blow_up_site(model: &Model, states: &[State<'_>]) -> BlowUpSite {
    let is_broken = |point: Point| !point.iter().all(|x| x.is_finite());
    let shown = states.iter().find_map(|&(x, v)| {
        let broken = first(is_broken, x, v).map(BlowUpSite::Particle);
        let named = broken.or_else(|| model.longest_beyond(x, model.stretch_ratio_max));
        named.or_else(|| first(is_beyond, x, v).map(BlowUpSite::Beyond))
    });
    let last = || model.longest_beyond(states.last()?.0, f64::NEG_INFINITY);
    shown.or_else(last).unwrap_or(BlowUpSite::Unknown)
}

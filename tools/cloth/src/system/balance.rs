//! The energy balance: where a system's energy came from, where it went, and what the method made of it.
//!
//! Motion and strain hold energy; gravity, wind, drag, colliders, edits and the hands that hold and lead
//! particles give or take some. The rest is the method's: most lose some, which is *numerical
//! dissipation*. A method that makes energy out of nothing shatters what it should tear, and nothing else
//! shows it: lengths stay finite, and each step is below its stability limit.
//!
//! A [`Balance`] is kept outside of the system, by whoever wants one, and sees each step before and
//! after ([`System::step_observed`]):
//!
//! | part | how it is known | cost |
//! |---|---|---|
//! | kinetic, elastic, gravity | functions of the state | a pass over constraints, when asked |
//! | damping | the power of its forces, trapezoids of each step ([`System::set_damping`]) | nothing |
//! | wind, drag | ∫ power dt, trapezoids of [`AIR_S`] | a pass over particles each, with wind over faces |
//! | leading | −∫ (f + m g) · dx of each led particle | its valence a step while it moves |
//! | holding, letting go | the change of the particle's own energy ([`Balance::handle`]) | its valence |
//! | colliders | their impulses times the mean velocity of a substep ([`ContactWork`]) | a copy of velocities a substep |
//! | edits | the change of all energy by an edit ([`Balance::add_edits`]) | a pass over constraints |
//! | the method | the remainder | nothing |
//!
//! Trapezoids err by O(Δt²), as does velocity Verlet itself. The implicit methods and those that project
//! move particles by the forces at the end of a step, and so the work of leading is that force times the
//! way: backward Euler then takes energy in every step, and never makes any.
//!
//! Particles that are held have no kinetic energy, and wind and drag on them do no work: whoever
//! holds them bears that too. Another gravity, what is written through [`System::state_mut`], and
//! constraints that are added, cut or made stiffer, count as made by the method.

use tearmesh::geometry::{Vector, dot};

use crate::system::System;
use crate::system::contact::ContactWork;
use crate::system::energy;
use crate::system::force;

/// How far apart the work of wind and drag is sampled, in seconds of the simulation; a longer step is
/// one sample.
pub(crate) const AIR_S: f64 = 1e-3;

/// The sources and losses of the energy of a system, in joules, since [`Balance::new`]. A work is
/// positive if it adds energy to the system.
///
/// ```
/// use tearmesh_cloth::{Balance, Loads, System, Verlet};
/// use tearmesh::{Point, Vector};
///
/// // A kilogram falls for a second.
/// let mut stone = System::new([Point::origin()], vec![1.0])?;
/// let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -10.0));
/// stone.set_loads(Loads { gravity_m_per_s2, ..Loads::default() })?;
/// let mut balance = Balance::new(&mut stone);
/// for _ in 0..100 {
///     stone.step_observed(&mut Verlet, 0.01, Some(&mut balance))?;
/// }
/// let balance = balance.now(&stone);
/// assert!((balance.kinetic_j - 50.0).abs() < 1e-9);
/// assert!((balance.gravity_j - 50.0).abs() < 1e-9);
/// assert!(balance.made_j().abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBalance {
    /// The kinetic and elastic energy at the beginning of the balance.
    pub began_j: f64,
    /// The present kinetic energy of the particles that are not held.
    pub kinetic_j: f64,
    /// The present elastic energy of all constraints and triangles, as the method of the last step
    /// stores it: by the forces of [`Xpbd`](crate::Xpbd), which with few sweeps are not those of its
    /// lengths, and none of [`Pbd`](crate::Pbd), whose constraints are rigid.
    pub elastic_j: f64,
    /// The work of gravity on all particles.
    pub gravity_j: f64,
    /// The work of the hands that hold, lead and release particles.
    pub held_j: f64,
    /// The work of wind on the particles that are not held.
    pub wind_j: f64,
    /// The work of drag on the particles that are not held, which is never positive.
    pub drag_j: f64,
    /// The work of the damping of springs ([`System::set_damping`]), which is never positive.
    pub damping_j: f64,
    /// The work of colliders. It is negative, since impacts are inelastic and friction takes motion, except for what
    /// colliders that move give.
    pub colliders_j: f64,
    /// The energy that edits (tears, cuts and mends) added, and what draws together what is sewn.
    pub edits_j: f64,
}

impl EnergyBalance {
    /// Returns the energy that was put in, in joules: the energy at the beginning, plus each
    /// positive part among the work of gravity, hands, wind and colliders and the energy made by
    /// edits.
    #[must_use]
    pub fn put_in_j(&self) -> f64 {
        let outside = [self.gravity_j, self.held_j, self.wind_j];
        let parts = outside.into_iter().chain([self.colliders_j, self.edits_j]);
        parts.fold(self.began_j, |sum, part| sum + part.max(0.0))
    }

    /// Returns the energy that the method made, in joules: what is there and came from nothing
    /// outside. It is negative for numerical dissipation. With an explicit method it swings by a few
    /// per cent of the energy of the fastest vibrations. The limiter of [`Provot`](crate::Provot)
    /// does unbounded work as steps get shorter, so its share says nothing of the cloth.
    #[must_use]
    pub fn made_j(&self) -> f64 {
        let worked = self.gravity_j + self.held_j + self.wind_j + self.drag_j;
        let given = self.began_j + worked + self.damping_j + self.colliders_j + self.edits_j;
        self.kinetic_j + self.elastic_j - given
    }
}

/// A running energy balance of a system that is stepped. It costs a pass over particles a
/// millisecond while there is drag, and the valence of the particles that are led.
#[derive(Clone, Debug, Default)]
pub struct Balance {
    pub(crate) work: Work,
    /// The forces on those who are led, where the substep began.
    forces: Vec<Vector>,
    /// Room for the force of wind.
    gusts: Vec<Vector>,
}

/// The work that was summed up, in joules, and the power of air that was sampled last.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// What was summed up; of gravity and damping what there was at the beginning.
    sums: EnergyBalance,
    /// Of wind and drag, in watts.
    sampled: Option<[f64; 2]>,
    since_s: f64,
}

impl Work {
    /// Adds the work of wind and drag since the last sample, at this mean power.
    fn add_air(&mut self, [wind_w, drag_w]: [f64; 2]) {
        self.sums.wind_j += wind_w * self.since_s;
        self.sums.drag_j += drag_w * self.since_s;
        self.since_s = 0.0;
    }
}

impl Balance {
    /// Starts a balance at the present state.
    #[must_use]
    pub fn new(system: &System) -> Balance {
        let mut balance = Balance::default();
        balance.work.sums = EnergyBalance {
            began_j: energy::kinetic_j(system) + energy::stored_j(system),
            gravity_j: energy::potential_j(system),
            damping_j: system.damped_j,
            edits_j: -system.drawn_j,
            ..EnergyBalance::default()
        };
        balance
    }

    /// Adds the energy in joules that edits of the mesh made: what there is of it after them, and was not
    /// before. Without this call it counts as made by the method.
    pub fn add_edits(&mut self, made_j: f64) {
        self.work.sums.edits_j += made_j;
    }

    /// Returns the balance up to now. Costs a pass over all constraints.
    #[must_use]
    pub fn now(&self, system: &System) -> EnergyBalance {
        let mut work = self.work;
        work.add_air(work.sampled.unwrap_or_default());
        let sums = work.sums;
        EnergyBalance {
            kinetic_j: energy::kinetic_j(system),
            elastic_j: energy::stored_j(system),
            gravity_j: sums.gravity_j - energy::potential_j(system),
            damping_j: sums.damping_j - system.damped_j,
            edits_j: sums.edits_j + system.drawn_j,
            ..sums
        }
    }

    /// Calls `change`, which holds, grabs or releases one particle ([`System::hold`],
    /// [`System::grab`], [`System::release`]), and adds the work of this change to the balance.
    /// Without this call that work counts as made by the method.
    pub fn handle(
        &mut self,
        system: &mut System,
        particle: usize,
        change: impl FnOnce(&mut System),
    ) {
        let before_j = energy::at_j(system, particle);
        change(system);
        self.work.sums.held_j += energy::at_j(system, particle) - before_j;
    }

    /// Calls `change`, which displaces particles, and counts the state after it as the one at the beginning, if nothing
    /// has moved before.
    pub(crate) fn displace(&mut self, system: &mut System, change: impl FnOnce(&mut System)) {
        let energies = |system: &System| (energy::stored_j(system), energy::potential_j(system));
        let before = energies(system);
        change(system);
        let after = energies(system);
        self.work.sums.began_j += after.0 - before.0;
        self.work.sums.gravity_j += after.1 - before.1;
    }

    /// Reads the system before a substep. Particles that are led have the velocity for it already.
    pub(crate) fn before(&mut self, system: &System) {
        if is_leading(system) {
            self.forces.clear();
            self.forces.extend(led_forces(system));
        }
        let loads = &system.model.loads;
        if loads.wind.is_none() && loads.drag_per_s.is_none() {
            (self.work.sampled, self.work.since_s) = (None, 0.0);
        } else if self.work.sampled.is_none() {
            self.work.sampled = Some(air_w(system, &mut self.gusts));
        }
    }

    /// Reads the system after a substep of so many seconds, in which the method moved particles by the
    /// forces at its end, or by those at both.
    pub(crate) fn after(
        &mut self,
        system: &System,
        substep_s: f64,
        moves_at_end: bool,
        contact: ContactWork,
    ) {
        self.work.sums.colliders_j += contact.colliders_j;
        if is_leading(system) {
            let led = system.model.grabbed.iter().zip(&self.forces);
            for (((particle, _), &before), after) in led.zip(led_forces(system)) {
                let mean = if moves_at_end {
                    after
                } else {
                    (before + after) / 2.0
                };
                let way = system.velocities[*particle as usize] * substep_s;
                self.work.sums.held_j -= dot(mean, way);
            }
        }
        if let Some(before) = self.work.sampled {
            self.work.since_s += substep_s;
            if self.work.since_s >= AIR_S {
                let after = air_w(system, &mut self.gusts);
                self.work
                    .add_air([0, 1].map(|i| 0.5 * (before[i] + after[i])));
                self.work.sampled = Some(after);
            }
        }
    }
}

/// Whether someone is led, and not at rest.
fn is_leading(system: &System) -> bool {
    let mut led = system.model.grabbed.iter();
    led.any(|(particle, _)| system.velocities[*particle as usize] != Vector::zeros())
}

/// The forces of constraints and of gravity on those who are led, in the order of the list.
fn led_forces(system: &System) -> impl Iterator<Item = Vector> {
    let led = system.model.grabbed.iter();
    led.map(|(particle, _)| force::inner_n(system, *particle as usize))
}

/// The power of wind and of drag on free particles, in watts.
fn air_w(system: &System, gusts: &mut Vec<Vector>) -> [f64; 2] {
    let model = &system.model;
    let drag_w = -2.0 * model.drag_per_s() * energy::kinetic_j(system);
    let Some(wind) = model.loads.wind else {
        return [0.0, drag_w];
    };
    gusts.clear();
    gusts.resize(system.positions.len(), Vector::zeros());
    wind.press(&model.faces, &system.positions, &system.velocities, gusts);
    let particles = gusts.iter().zip(&system.velocities);
    let free = particles.zip(&model.inverse_masses);
    let wind_w = free.fold(0.0, |sum, ((&f, &v), &w)| {
        sum + if w > 0.0 { dot(f, v) } else { 0.0 }
    });
    [wind_w, drag_w]
}

//! The energy balance: where a system's energy came from, where it went, and what remains
//! unaccounted for.
//!
//! Motion and strain hold energy; gravity, wind, drag, colliders, edits and those who hold and lead
//! particles give or take some, and so does the *method*. One that damps loses some; one that makes
//! energy out of nothing shatters what it should tear, and nothing else shows it: lengths stay
//! finite, and each step is below its stability limit. Each method says itself what it made, by the
//! forces and ways of its steps ([`loss`](crate::loss)), and so what is left when all are counted is a
//! [remainder](EnergyBalance::remainder_j) that nobody is to blame for.
//!
//! A [`Balance`] is kept outside of the system, by whoever wants one, and sees each step before and
//! after ([`System::step_observed`]). Each part is exact or nearly so:
//!
//! | part | how it is known | cost |
//! |---|---|---|
//! | kinetic, elastic, gravity | functions of the state | a pass over constraints, when asked |
//! | drag | −2 c ∫ K dt, trapezoids over substeps | a pass over particles a substep, where there is drag |
//! | leading | −∫ (f + m g) · dx of each led particle: trapezoids, or as the method says it | its valence a substep while it moves |
//! | holding, letting go | the change of the particle's own energy ([`Balance::handle`]) | its valence |
//! | wind | ∫ Σ f · v over free particles, trapezoids of [`WIND_S`] | a sum over faces each |
//! | colliders | the change of each particle's energy as it is pushed out | its valence while in contact |
//! | edits | [`EnergyLedger`](crate::EnergyLedger) | nothing |
//! | the method | what its forces did on the way of particles, and what that stored | two passes over particles (Verlet); one over constraints and one over particles (others) |
//!
//! Trapezoids err by O(Δt²), as does velocity Verlet itself; so a rest that shrinks as Δt² is no
//! one's fault. The implicit methods and those that project move particles by the forces at the end
//! of the substep, and so the work of leading is that force times the way, in each substep of their own:
//! backward Euler then takes energy in every step, and never makes any.
//!
//! Particles that are held have no kinetic energy, and wind and drag on them do no work: whoever
//! holds them bears that too. What is written through [`System::state_mut`], and constraints that
//! are added, cut or made stiffer, stay in the remainder.

use tearmesh::geometry::{Vector, dot};

use crate::energy;
use crate::force;
use crate::meter::Energy;
use crate::moment::State;
use crate::step::{Observer, Substep};
use crate::system::System;

/// How far apart the work of wind is sampled, in seconds of the simulation; a longer substep is one
/// sample.
pub(crate) const WIND_S: f64 = 1e-3;

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
///     stone.step_observed(&mut Verlet::new(), 0.01, &mut balance)?;
/// }
/// let balance = balance.now(&stone, 0.0);
/// assert!((balance.kinetic_j - 50.0).abs() < 1e-9);
/// assert!((balance.gravity_j - 50.0).abs() < 1e-9);
/// assert!(balance.method_j.unwrap().abs() < 1e-9);
/// assert!(balance.remainder_j().abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBalance {
    /// The kinetic and elastic energy at the beginning of the balance.
    pub began_j: f64,
    /// The present kinetic energy of the particles that are not held.
    pub kinetic_j: f64,
    /// The present elastic energy of all constraints and triangles.
    pub elastic_j: f64,
    /// The work of gravity on all particles.
    pub gravity_j: f64,
    /// The work of the hands that hold, lead and release particles.
    pub held_j: f64,
    /// The work of wind on the particles that are not held.
    pub wind_j: f64,
    /// The work of drag on the particles that are not held, which is never positive.
    pub drag_j: f64,
    /// The work of colliders. It is negative, since impacts are inelastic, except for the energy it
    /// takes to push a particle out against springs or gravity.
    pub colliders_j: f64,
    /// The energy that edits (tears, cuts and mends) added.
    pub edits_j: f64,
    /// The energy that the method itself made; negative for numerical damping. Each method computes
    /// it from its own steps, rather than from the gap in this balance. `None` for methods that do
    /// not compute it: [`Provot`](crate::Provot), whose limiter does unbounded work as steps get
    /// shorter, and methods from outside this crate.
    pub method_j: Option<f64>,
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

    /// Returns the energy that no part of the balance accounts for, in joules; negative if energy
    /// is missing.
    #[must_use]
    pub fn remainder_j(&self) -> f64 {
        self.made_j() - self.method_j.unwrap_or(0.0)
    }

    /// Returns the energy that came from nothing outside, in joules: the energy that the method
    /// made by its own account, plus the remainder. With an explicit method it swings by a few per
    /// cent of the energy. A larger value is an error.
    #[must_use]
    pub fn made_j(&self) -> f64 {
        let worked = self.gravity_j + self.held_j + self.wind_j + self.drag_j;
        let given = self.began_j + worked + self.colliders_j + self.edits_j;
        self.kinetic_j + self.elastic_j - given
    }
}

/// A running energy balance of a system that is stepped. A substep costs two passes over particles
/// with [`Verlet`](crate::Verlet), and with other methods one over constraints and one over
/// particles.
#[derive(Clone, Debug, Default)]
pub struct Balance {
    began_j: f64,
    contact_began_j: f64,
    /// The potential of gravity when the sum of its work was taken last.
    potential_j: f64,
    /// Up to the last step that was taken, and up to now.
    taken: Account,
    account: Account,
    /// Kinetic energy, and the forces on those who are led, after the last substep; `None` where the
    /// state was changed since.
    kinetic_j: Option<f64>,
    forces: Option<Vec<Vector>>,
    /// The number of changes of the state that this is of.
    changes: u64,
    /// Room for forces.
    spare: Vec<Vector>,
    gusts: Vec<Vector>,
}

/// What was summed up.
#[derive(Clone, Copy, Debug, Default)]
struct Account {
    gravity_j: f64,
    held_j: f64,
    wind_j: f64,
    drag_j: f64,
    /// What methods said that they made, with what they took from wind.
    made_j: f64,
    /// Whether some step did not say what the method made.
    is_silent: bool,
    wind: Sampled,
}

/// The power of wind when it was sampled last, and the seconds since.
#[derive(Clone, Copy, Debug, Default)]
struct Sampled {
    watts: Option<f64>,
    since_s: f64,
}

impl Balance {
    /// Starts a balance at the present state. From now on the system also sums the work of its
    /// colliders, which cannot be observed from outside.
    #[must_use]
    pub fn new(system: &mut System) -> Balance {
        Balance {
            began_j: energy::kinetic_j(system) + energy::elastic_j(system),
            contact_began_j: *system.contact_j.get_or_insert(0.0),
            potential_j: energy::potential_j(system),
            ..Balance::default()
        }
    }

    /// Returns the balance up to now. `edits_j` is the energy that edits added since it began:
    /// [`EnergyLedger::made_j`](crate::EnergyLedger::made_j) of a cloth, and zero for a system
    /// without a mesh. Costs a pass over all constraints.
    #[must_use]
    pub fn now(&self, system: &System, edits_j: f64) -> EnergyBalance {
        let sums = self.account;
        let unsampled_j = sums.wind.watts.unwrap_or(0.0) * sums.wind.since_s;
        let gravity_j = sums.gravity_j + (self.potential_j - energy::potential_j(system));
        let wind_j = sums.wind_j + unsampled_j;
        EnergyBalance {
            began_j: self.began_j,
            kinetic_j: energy::kinetic_j(system),
            elastic_j: energy::elastic_j(system),
            gravity_j,
            held_j: sums.held_j,
            wind_j,
            drag_j: sums.drag_j,
            colliders_j: system.contact_j.unwrap_or(0.0) - self.contact_began_j,
            edits_j,
            method_j: (!sums.is_silent).then_some(sums.made_j - wind_j),
        }
    }

    /// Calls `change`, which holds, grabs or releases one particle ([`System::hold`],
    /// [`System::grab`], [`System::release`]), and adds the work of this change to the balance.
    /// Without this call that work ends up in the remainder.
    pub fn handle(
        &mut self,
        system: &mut System,
        particle: usize,
        change: impl FnOnce(&mut System),
    ) {
        let before_j = energy::at_j(system, particle);
        change(system);
        self.account.held_j += energy::at_j(system, particle) - before_j;
        self.taken = self.account;
    }

    /// Calls `change`, which may change gravity ([`System::set_loads`]), and adds the work of the
    /// new gravity from then on.
    pub fn reload<T>(&mut self, system: &mut System, change: impl FnOnce(&mut System) -> T) -> T {
        self.account.gravity_j += self.potential_j - energy::potential_j(system);
        let done = change(system);
        self.potential_j = energy::potential_j(system);
        self.taken = self.account;
        done
    }

    fn spare_forces(&mut self) {
        if let Some(forces) = self.forces.take() {
            self.spare = forces;
        }
    }
}

impl Observer for Balance {
    fn meters(&self) -> bool {
        true
    }

    fn before(&mut self, system: &System) {
        if self.changes != system.changes {
            self.kinetic_j = None;
            self.spare_forces();
        }
        if system.model.drag_per_s() > 0.0 && self.kinetic_j.is_none() {
            self.kinetic_j = Some(free_kinetic_j(system, system.state()));
        }
        if is_leading(system) && self.forces.is_none() {
            let mut forces = std::mem::take(&mut self.spare);
            led_forces(system, &mut forces);
            self.forces = Some(forces);
        }
        let wind = &mut self.account.wind;
        if system.model.loads.wind.is_none() {
            *wind = Sampled::default();
        } else if wind.watts.is_none() {
            wind.watts = Some(wind_watts(system, &mut self.gusts));
        }
    }

    fn after(&mut self, system: &System, substep: Substep) {
        let dt_s = substep.dt_s;
        self.account.made_j += substep.made_j.unwrap_or(0.0);
        self.account.is_silent |= substep.made_j.is_none();
        let drag_per_s = system.model.drag_per_s();
        if drag_per_s > 0.0 {
            let now_j = free_kinetic_j(system, system.next_state());
            let before_j = self.kinetic_j.unwrap_or(now_j);
            self.account.drag_j -= drag_per_s * dt_s * (before_j + now_j);
            self.kinetic_j = Some(now_j);
        }
        if is_leading(system) {
            let mut forces = std::mem::take(&mut self.spare);
            led_forces(system, &mut forces);
            let earlier = self.forces.take().unwrap_or_default();
            let before = if substep.moves_at_end {
                &forces
            } else {
                &earlier
            };
            self.account.held_j -= match system.meter.led_j() {
                Some(led_j) => led_j + led_weight_work_j(system, dt_s),
                None => led_work_j(system, before, &forces, dt_s),
            };
            self.forces = Some(forces);
            self.spare = earlier;
        } else {
            self.spare_forces();
        }
        let wind = &mut self.account.wind;
        if let Some(before_w) = wind.watts {
            wind.since_s += dt_s;
            if wind.since_s >= WIND_S {
                let now_w = wind_watts(system, &mut self.gusts);
                self.account.wind_j += wind.since_s * (before_w + now_w) / 2.0;
                *wind = Sampled {
                    watts: Some(now_w),
                    since_s: 0.0,
                };
            }
        }
        self.changes = system.changes;
    }

    fn ended(&mut self, is_taken: bool) {
        if is_taken {
            self.taken = self.account;
        } else {
            self.account = self.taken;
        }
    }
}

/// The kinetic energy of free particles in a state, which the system is in: as the method left it, where
/// it did.
fn free_kinetic_j(system: &System, state: State) -> f64 {
    let left = system.meter.left(state).and_then(Energy::kinetic_j);
    left.unwrap_or_else(|| energy::free_kinetic_j(system))
}

/// Whether someone is led, and not at rest.
fn is_leading(system: &System) -> bool {
    let mut led = system.model.grabbed.iter();
    led.any(|&(particle, _)| system.velocities[particle as usize] != Vector::zeros())
}

/// The forces of constraints and of gravity on those who are led, in the order of the list.
fn led_forces(system: &System, forces: &mut Vec<Vector>) {
    let led = system.model.grabbed.iter();
    forces.clear();
    forces.extend(led.map(|&(particle, _)| force::inner_n(system, particle as usize)));
}

/// The work of these forces on the way of a substep, before which and after which they are.
fn led_work_j(system: &System, before: &[Vector], after: &[Vector], dt_s: f64) -> f64 {
    let led = system.model.grabbed.iter().zip(before.iter().zip(after));
    led.fold(0.0, |sum, (&(particle, _), (&before, &after))| {
        let mean = (before + after) / 2.0;
        sum + dot(mean, system.velocities[particle as usize]) * dt_s
    })
}

/// The work of gravity on those who are led.
fn led_weight_work_j(system: &System, dt_s: f64) -> f64 {
    let model = &system.model;
    let led = model.grabbed.iter().map(|&(particle, _)| particle as usize);
    let ways = led.map(|led| system.velocities[led] * (model.masses[led] * dt_s));
    ways.map(|way| dot(model.gravity(), way)).sum()
}

/// The power of wind on free particles.
fn wind_watts(system: &System, gusts: &mut Vec<Vector>) -> f64 {
    let model = &system.model;
    let Some(wind) = model.loads.wind else {
        return 0.0;
    };
    gusts.clear();
    gusts.resize(system.positions.len(), Vector::zeros());
    wind.press(&model.faces, &system.positions, &system.velocities, gusts);
    let particles = gusts.iter().zip(&system.velocities);
    let free = particles.zip(&model.inverse_masses);
    free.fold(0.0, |sum, ((&f, &v), &w)| {
        sum + if w > 0.0 { dot(f, v) } else { 0.0 }
    })
}

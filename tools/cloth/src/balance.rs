//! The balance of energy: where a system's energy came from, where it went, and what is left over.
//!
//! Motion and strain hold energy; gravity, wind, drag, colliders, edits and those who hold and lead
//! particles give or take some. What remains when all of them are counted is what the *method* made
//! or lost. A method that damps loses some, and says so here; one that makes energy out of nothing
//! shatters what it should tear, and nothing else shows it: lengths stay finite, and each step is
//! below its stability limit.
//!
//! A system keeps a balance from [`System::keep_balance`] on. Each part is exact or nearly so:
//!
//! | part | how it is known | cost |
//! |---|---|---|
//! | kinetic, elastic, gravity | functions of the state | a pass over constraints, when asked |
//! | drag | −2 c ∫ K dt, trapezoids over substeps | a pass over particles a substep, where there is drag |
//! | leading | −∫ (f + m g) · dx of each led particle, trapezoids | its valence a substep while it moves |
//! | holding, letting go | the change of the particle's own energy | its valence |
//! | wind | ∫ Σ f · v over free particles, trapezoids of [`WIND_S`] | a sum over faces each |
//! | colliders | the change of each particle's energy as it is pushed out | its valence while in contact |
//! | edits | [`EnergyLedger`](crate::EnergyLedger), and the change of weight's place | nothing; merges and slides: a pass over particles |
//!
//! Trapezoids err by O(Δt²), as does velocity Verlet itself; so a rest that shrinks as Δt² is no
//! one's fault. The implicit methods and those that project move particles by the forces at the end
//! of the substep, and so the work of leading is that force times the way: backward Euler then
//! takes energy in every step, and never makes any.
//!
//! Particles that are held have no kinetic energy, and wind and drag on them do no work: whoever
//! holds them bears that too. What is written through [`System::state_mut`], and constraints that
//! are added, cut or made stiffer, count as the method's.

mod meter;

pub(crate) use meter::{Meter, Noted};

use tearmesh::geometry::{Vector, dot};

use self::meter::Sampled;
use crate::system::System;

/// How far apart the work of wind is sampled, in seconds of the simulation; a longer substep is one
/// sample.
pub(crate) const WIND_S: f64 = 1e-3;

/// Where the energy of a system came from and where it went, in joules, since
/// [`System::keep_balance`].
///
/// ```
/// use tearmesh_cloth::{Loads, System, Verlet};
/// use tearmesh::{Point, Vector};
///
/// // A kilogram falls for a second.
/// let mut stone = System::new([Point::origin()], vec![1.0])?;
/// let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -10.0));
/// stone.set_loads(Loads { gravity_m_per_s2, ..Loads::default() })?;
/// stone.keep_balance();
/// for _ in 0..100 {
///     stone.step(&mut Verlet::new(), 0.01)?;
/// }
/// let balance = stone.energy_balance().ok_or("it is kept")?;
/// assert!((balance.kinetic_j - 50.0).abs() < 1e-9);
/// assert!((balance.gravity_j - 50.0).abs() < 1e-9);
/// assert!(balance.method_j().abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBalance {
    /// Kinetic and elastic energy when the balance began.
    pub began_j: f64,
    /// The kinetic energy of the particles that are not held, now.
    pub kinetic_j: f64,
    /// The elastic energy of all constraints and triangles, now.
    pub elastic_j: f64,
    /// The work of gravity on all particles.
    pub gravity_j: f64,
    /// The work of those who hold, lead, and let go.
    pub held_j: f64,
    /// The work of wind on the particles that are not held.
    pub wind_j: f64,
    /// The work of drag on the particles that are not held: never positive.
    pub drag_j: f64,
    /// The work of colliders: negative, as an impact is inelastic, but for what pushing a particle
    /// out stretches or lifts.
    pub colliders_j: f64,
    /// What edits made: tears and cuts.
    pub edits_j: f64,
}

impl EnergyBalance {
    /// What was put in: what was there when the balance began, and each part above zero of the work
    /// of gravity, of those who hold, of wind and of colliders, and of what edits made, in joules.
    #[must_use]
    pub fn put_in_j(&self) -> f64 {
        let outside = [self.gravity_j, self.held_j, self.wind_j];
        let parts = outside.into_iter().chain([self.colliders_j, self.edits_j]);
        parts.fold(self.began_j, |sum, part| sum + part.max(0.0))
    }

    /// What the method made, or lost where negative: the rest, in joules. Lost is numerical
    /// damping; made is an error, beyond the few per cent by which the energy of an explicit method
    /// swings.
    #[must_use]
    pub fn method_j(&self) -> f64 {
        let worked = self.gravity_j + self.held_j + self.wind_j + self.drag_j;
        let given = self.began_j + worked + self.colliders_j + self.edits_j;
        self.kinetic_j + self.elastic_j - given
    }
}

impl System {
    /// Begins to keep a balance of energy, from nothing. Its cost stands above
    /// [`EnergyBalance`]; a system that keeps none pays nothing.
    pub fn keep_balance(&mut self) {
        let mut meter = Box::new(Meter::default());
        meter.sums.began_j = self.kinetic_energy_j() + self.elastic_energy_j();
        meter.potential_j = self.potential_j();
        self.meter = Some(meter);
    }

    /// The balance of energy until now; `None` unless it is kept. A pass over all constraints.
    #[must_use]
    pub fn energy_balance(&self) -> Option<EnergyBalance> {
        let meter = self.meter.as_ref()?;
        let sums = meter.sums;
        let unsampled_j = meter.wind.watts.unwrap_or(0.0) * meter.wind.since_s;
        Some(EnergyBalance {
            began_j: sums.began_j,
            kinetic_j: self.kinetic_energy_j(),
            elastic_j: self.elastic_energy_j(),
            gravity_j: sums.gravity_j + (meter.potential_j - self.potential_j()),
            held_j: sums.held_j,
            wind_j: sums.wind_j + unsampled_j,
            drag_j: sums.drag_j,
            colliders_j: sums.colliders_j,
            edits_j: sums.edits_j,
        })
    }

    /// The potential of gravity of all particles, in joules.
    fn potential_j(&self) -> f64 {
        let Some(gravity) = self.model.loads.gravity_m_per_s2 else {
            return 0.0;
        };
        let particles = self.positions.iter().zip(&self.model.masses);
        -particles.fold(0.0, |sum, (x, m)| sum + m * dot(gravity, x.coords))
    }

    /// What is known before a step.
    pub(crate) fn noted(&self) -> Option<Noted> {
        self.meter.as_ref().map(|meter| Noted {
            sums: meter.sums,
            wind: meter.wind,
            has_forces: meter.forces.is_some(),
        })
    }

    /// Goes back to what was known before a step that failed, once the state is that again.
    pub(crate) fn note_back(&mut self, noted: Option<Noted>) {
        let (Some(mut meter), Some(noted)) = (self.meter.take(), noted) else {
            return;
        };
        meter.sums = noted.sums;
        meter.wind = noted.wind;
        meter.changed();
        if noted.has_forces {
            let mut forces = std::mem::take(&mut meter.spare);
            self.led_forces(&mut forces);
            meter.forces = Some(forces);
        }
        self.meter = Some(meter);
    }

    /// Notes the state before a substep, after those who are led got their velocity.
    pub(crate) fn note_before(&mut self) {
        let Some(mut meter) = self.meter.take() else {
            return;
        };
        if self.model.drag_per_s() > 0.0 && meter.kinetic_j.is_none() {
            meter.kinetic_j = Some(self.free_kinetic_j());
        }
        if self.is_leading() && meter.forces.is_none() {
            let mut forces = std::mem::take(&mut meter.spare);
            self.led_forces(&mut forces);
            meter.forces = Some(forces);
        }
        if self.model.loads.wind.is_none() {
            meter.wind = Sampled::default();
        } else if meter.wind.watts.is_none() {
            meter.wind.watts = Some(self.wind_watts(&mut meter.gusts));
        }
        self.meter = Some(meter);
    }

    /// Sums up the work of a substep. `at_end` says that the method moved particles by the forces at
    /// its end, as those do that have no stability limit.
    pub(crate) fn note_after(&mut self, dt_s: f64, at_end: bool) {
        let Some(mut meter) = self.meter.take() else {
            return;
        };
        let drag_per_s = self.model.drag_per_s();
        if drag_per_s > 0.0 {
            let now_j = self.free_kinetic_j();
            let before_j = meter.kinetic_j.unwrap_or(now_j);
            meter.sums.drag_j -= drag_per_s * dt_s * (before_j + now_j);
            meter.kinetic_j = Some(now_j);
        }
        if self.is_leading() {
            let mut forces = std::mem::take(&mut meter.spare);
            self.led_forces(&mut forces);
            let earlier = meter.forces.take().unwrap_or_default();
            let before = if at_end { &forces } else { &earlier };
            meter.sums.held_j -= self.led_work_j(before, &forces, dt_s);
            meter.forces = Some(forces);
            meter.spare = earlier;
        } else if let Some(forces) = meter.forces.take() {
            meter.spare = forces;
        }
        if let Some(before_w) = meter.wind.watts {
            meter.wind.since_s += dt_s;
            if meter.wind.since_s >= WIND_S {
                let now_w = self.wind_watts(&mut meter.gusts);
                meter.sums.wind_j += meter.wind.since_s * (before_w + now_w) / 2.0;
                meter.wind = Sampled {
                    watts: Some(now_w),
                    since_s: 0.0,
                };
            }
        }
        self.meter = Some(meter);
    }

    /// [`System::kinetic_energy_j`] in one pass over slices.
    fn free_kinetic_j(&self) -> f64 {
        let model = &self.model;
        let particles = self.velocities.iter().zip(&model.masses);
        let particles = particles.zip(&model.inverse_masses);
        let twice = particles.fold(0.0, |sum, ((&v, m), &w)| {
            sum + if w > 0.0 { m * dot(v, v) } else { 0.0 }
        });
        0.5 * twice
    }

    /// Whether someone is led, and not at rest.
    fn is_leading(&self) -> bool {
        let mut led = self.model.grabbed.iter();
        led.any(|&(particle, _)| self.velocities[particle as usize] != Vector::zeros())
    }

    /// The forces of constraints and of gravity on those who are led, in the order of the list.
    fn led_forces(&self, forces: &mut Vec<Vector>) {
        let led = self.model.grabbed.iter();
        forces.clear();
        forces.extend(led.map(|&(particle, _)| self.inner_n(particle as usize)));
    }

    /// The work of these forces on the way of a substep, before which and after which they are.
    fn led_work_j(&self, before: &[Vector], after: &[Vector], dt_s: f64) -> f64 {
        let led = self.model.grabbed.iter().zip(before.iter().zip(after));
        led.fold(0.0, |sum, (&(particle, _), (&before, &after))| {
            let mean = (before + after) / 2.0;
            sum + dot(mean, self.velocities[particle as usize]) * dt_s
        })
    }

    /// The power of wind on free particles.
    fn wind_watts(&self, gusts: &mut Vec<Vector>) -> f64 {
        let Some(wind) = self.model.loads.wind else {
            return 0.0;
        };
        gusts.clear();
        gusts.resize(self.positions.len(), Vector::zeros());
        wind.press(&self.model.faces, &self.positions, &self.velocities, gusts);
        let particles = gusts.iter().zip(&self.velocities);
        let free = particles.zip(&self.model.inverse_masses);
        free.fold(0.0, |sum, ((&f, &v), &w)| {
            sum + if w > 0.0 { dot(f, v) } else { 0.0 }
        })
    }

    /// The energy that a particle has a part in: its motion, what it is joined by, and its weight.
    pub(crate) fn energy_at_j(&self, particle: usize) -> f64 {
        let model = &self.model;
        let weight = model.gravity() * model.masses[particle];
        let motion_j = self.kinetic_j(particle);
        self.elastic_at_j(particle) + motion_j - dot(weight, self.positions[particle].coords)
    }

    /// Does something to one particle on behalf of those who hold it, and notes what that took.
    pub(crate) fn handle(&mut self, particle: usize, change: impl FnOnce(&mut System)) {
        if self.meter.is_none() {
            return change(self);
        }
        let before_j = self.energy_at_j(particle);
        change(self);
        let made_j = self.energy_at_j(particle) - before_j;
        if let Some(meter) = &mut self.meter {
            meter.sums.held_j += made_j;
            meter.changed();
        }
    }

    /// Forgets what was known of the state.
    pub(crate) fn note_change(&mut self) {
        if let Some(meter) = &mut self.meter {
            meter.changed();
        }
    }

    /// [`System::collide`], particle by particle.
    pub(crate) fn collide_and_note(&mut self) {
        let mut made_j = 0.0;
        for i in 0..self.model.loads.colliders.len() {
            self.counters.collider_passes += 1;
            for particle in 0..self.positions.len() {
                if self.model.inverse_masses[particle] <= 0.0 {
                    continue;
                }
                let (x, v) = (self.positions[particle], self.velocities[particle]);
                if let Some((x, v)) = self.model.loads.colliders[i].pushed(x, v) {
                    made_j -= self.energy_at_j(particle);
                    self.positions[particle] = x;
                    self.velocities[particle] = v;
                    made_j += self.energy_at_j(particle);
                }
            }
        }
        if let Some(meter) = &mut self.meter {
            meter.sums.colliders_j += made_j;
        }
    }

    /// What an edit is to be compared with by [`System::edited`]: where it moves masses, the
    /// potential of gravity.
    pub(crate) fn before_edit_j(&self, moves_masses: bool) -> f64 {
        match self.meter {
            Some(_) if moves_masses => self.potential_j(),
            _ => 0.0,
        }
    }

    /// Notes what an edit made, in kinetic and elastic energy.
    pub(crate) fn edited(&mut self, made_j: f64, before_j: f64, moves_masses: bool) {
        let lifted_j = self.before_edit_j(moves_masses) - before_j;
        if let Some(meter) = &mut self.meter {
            meter.sums.edits_j += made_j + lifted_j;
            meter.changed();
        }
    }

    /// Takes the sum of the work of gravity before another gravity sets in.
    pub(crate) fn settle_gravity(&mut self) {
        let now_j = self.potential_j();
        if let Some(meter) = &mut self.meter {
            meter.sums.gravity_j += meter.potential_j - now_j;
            meter.changed();
        }
    }

    /// Counts potential from here.
    pub(crate) fn count_potential(&mut self) {
        let now_j = self.potential_j();
        if let Some(meter) = &mut self.meter {
            meter.potential_j = now_j;
        }
    }
}

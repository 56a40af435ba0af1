//! Contact within an implicit step.
//!
//! What touched an obstacle as a step began is kept out of it by a stiff spring: a particle, or the middle of a
//! face. (What is only pushed out after a long step is drawn in by all that hangs from it, and out again: a sheet on a body
//! never comes to rest, and a spike gives eighty times what was put in.)
//!
//! **Friction** of μN, whatever the slip, has no second derivatives. It is taken for a viscous force μN s/s′ of the slip s,
//! with N of the last step and s′ the slip to expect after it: what goes on as in the last step is rubbed by μN, and what
//! would stop is held as stiffly as it is kept out. (N is lagged by Li et al. 2020 too, "Incremental potential contact".)
//! So an obstacle at rest only takes energy. (Where the slip is taken back after a step instead, light corners at a cut are
//! drawn away from what they went along with, which presses them the more: halves of a sheet on the head of a dummy came to thirty
//! times the energy of halves without one.)

use tearmesh::geometry::{Vector, dot, length};

use crate::method::implicit::stage::Stage;
use crate::system::System;
use crate::system::collide;
use crate::system::contact::{Contact, Pressed};
use crate::system::matrix::{Hessian, Weights};

/// How many times as stiff something is towards an obstacle as otherwise.
const KEPT_OUT: f64 = 1e3;

/// The least part of its slip that something is expected to keep in a step. (What stops within one is held in the steps after
/// it.)
const KEPT_SLIP: f64 = 0.5;

/// A particle, or the middle of a face, that was in contact as a step began.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touching {
    contact: Contact,
    /// What keeps it out, and what keeps it from slipping, in N/m.
    stiffness: f64,
    grip: f64,
}

impl Touching {
    /// The contact with an obstacle that is where this step leads it. What landed in the last is pressed by its weight.
    pub(super) fn new(system: &System, contact: &Contact) -> Touching {
        let velocity = collide::velocity(system, contact);
        let pressed = match contact.pressed.depth_m > 0.0 {
            true => contact.pressed,
            false => landed(system, contact),
        };
        Touching {
            contact: Contact {
                velocity,
                pressed,
                ..*contact
            },
            stiffness: 0.0,
            grip: 0.0,
        }
    }

    pub(super) fn corners(&self) -> impl Iterator<Item = usize> + use<> {
        self.contact.corners.each()
    }

    /// Takes its stiffness from a matrix that holds no contact yet, since a particle may be a corner of many faces.
    pub(super) fn measure(
        &mut self,
        (system, hessian): (&System, &Hessian),
        weights: Weights<'_>,
        stage: Stage,
    ) {
        let inertia = stage.dragged / (stage.h * stage.h);
        let resists = |i: usize| inertia * weights.masses[i] + hessian.stiffness(i);
        self.stiffness = KEPT_OUT * self.corners().map(resists).sum::<f64>();
        self.grip = self.stiffness.min(self.viscous(system, stage));
    }

    /// How stiff friction is, so that it is μN for the slip to expect.
    fn viscous(&self, system: &System, stage: Stage) -> f64 {
        let (contact, pressed) = (&self.contact, self.contact.pressed);
        if pressed.friction_n <= 0.0 {
            return 0.0;
        }
        let slip = |v: Vector| length(contact.along(v - contact.velocity));
        let slowed = slip(pressed.free) - pressed.friction_n * self.sped_by(stage);
        let now = slip(contact.corners.mean(|i| system.velocities[i]));
        pressed.friction_n / (slowed.max(KEPT_SLIP * now) * stage.h)
    }

    /// The speed that a newton gives in a step where all around stays.
    fn sped_by(&self, stage: Stage) -> f64 {
        KEPT_OUT / (self.stiffness * stage.h)
    }

    /// Adds its stiffness.
    pub(super) fn stiffen(&self, hessian: &mut Hessian) {
        let Contact {
            corners, normal, ..
        } = self.contact;
        hessian.stiffen(corners, normal, [self.stiffness, self.grip]);
    }

    /// How far the obstacle goes in a step.
    fn carried(&self, stage: Stage) -> Vector {
        self.contact.velocity * stage.dt_s
    }

    /// The forces out and along, for a way that the obstacle sees.
    fn forces(&self, way: Vector) -> [Vector; 2] {
        let slip = self.contact.along(way);
        [(way - slip) * -self.stiffness, slip * -self.grip]
    }

    /// Adds the force on each corner as the obstacle goes its way.
    pub(super) fn carry(&self, stage: Stage, forces: &mut [Vector]) {
        let [out, along] = self.forces(-self.carried(stage));
        let share = (out + along) / self.contact.corners.count as f64;
        self.corners().for_each(|i| forces[i] += share);
    }

    /// The work of an obstacle that moves, in a step in which particles went so far.
    pub(super) fn work_j(&self, stage: Stage, moved: &[Vector]) -> f64 {
        let carried = self.carried(stage);
        let [out, along] = self.forces(self.contact.corners.mean(|i| moved[i]) - carried);
        dot(out + along, carried)
    }

    /// Notes how it was pressed in a step from where a system is, in which particles went so far and came to
    /// these velocities; and what is to be expected after it.
    pub(super) fn press(
        &mut self,
        system: &mut System,
        stage: Stage,
        (moved, velocities): (&[Vector], &[Vector]),
    ) {
        let (contact, masses) = (self.contact, &system.model.inverse_masses);
        let mean = |of: &[Vector]| contact.corners.mean(|i| of[i]);
        let [out, along] = self.forces(mean(moved) - self.carried(stage));
        let pressed_n = dot(contact.normal, out).max(0.0);
        let impulse_s = stage.h / stage.dragged;
        self.contact.pressed = Pressed {
            depth_m: pressed_n * impulse_s * stage.h / contact.mass(masses),
            friction_n: contact.friction * pressed_n,
            free: mean(velocities) * 2.0 - mean(&system.velocities) - along * self.sped_by(stage),
        };
        let impulse = (out + along) * (impulse_s / contact.corners.count as f64);
        for i in contact.corners.each() {
            let change = impulse * masses[i];
            system.scratch.impulses.note(i, change);
        }
        collide::press(system, &self.contact);
    }
}

/// How something is pressed by its weight.
fn landed(system: &System, contact: &Contact) -> Pressed {
    let (gravity, [from_s, to_s]) = (system.model.gravity(), system.scratch.span_s);
    let mass = contact.mass(&system.model.inverse_masses);
    let weight_n = -dot(gravity, contact.normal) * mass;
    let v = contact.corners.mean(|i| system.velocities[i]);
    Pressed {
        depth_m: 0.0,
        friction_n: contact.friction * weight_n.max(0.0),
        free: v + gravity * (to_s - from_s),
    }
}

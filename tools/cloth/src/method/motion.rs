//! The motion of particles between two looks at constraints: what explicit methods and those that project
//! have in common.

use tearmesh::geometry::{Point, Vector};

use crate::system::System;
use crate::system::collide::move_out;
use crate::system::model::Model;

/// Speeds the free particles up for `kick_s` seconds, with drag by the velocities afterwards, which
/// divides them; then all fly for `dt_s` seconds.
pub(crate) fn kick_and_drift(system: &mut System, kick_s: f64, dt_s: f64) {
    let (model, scratch) = (&system.model, &mut system.scratch);
    let (positions, velocities) = (&mut system.positions, &mut system.velocities);
    let fade = 1.0 + kick_s * model.drag_per_s();
    let moved = |x: Point, v: Vector, a: Vector, w: f64| {
        let v = if w > 0.0 { (v + a * kick_s) / fade } else { v };
        (x + v * dt_s, v)
    };
    let pulled = scratch.accelerations.iter().zip(&model.inverse_masses);
    if !std::mem::take(&mut scratch.is_beginning) {
        let particles = positions.iter_mut().zip(velocities);
        for ((x, v), (&a, &w)) in particles.zip(pulled) {
            (*x, *v) = moved(*x, *v, a, w);
        }
        return;
    }
    // Where the step began stays where it is: to copy it would be a tenth of a step.
    scratch.positions.resize(positions.len(), Point::origin());
    scratch.velocities.resize(positions.len(), Vector::zeros());
    std::mem::swap(positions, &mut scratch.positions);
    std::mem::swap(velocities, &mut scratch.velocities);
    let began = scratch.positions.iter().zip(&scratch.velocities);
    let particles = positions.iter_mut().zip(velocities);
    for (((x, v), (&began, &sped)), (&a, &w)) in particles.zip(began).zip(pulled) {
        (*x, *v) = moved(began, sped, a, w);
    }
}

/// Speeds free particles up for `kick_s` seconds, with drag by the velocities before.
pub(crate) fn kick(
    model: &Model,
    accelerations: &[Vector],
    kick_s: f64,
    velocities: &mut [Vector],
) {
    let keep = 1.0 - kick_s * model.drag_per_s();
    let particles = velocities.iter_mut().zip(accelerations);
    for ((v, a), &w) in particles.zip(&model.inverse_masses) {
        if w > 0.0 {
            *v = *v * keep + a * kick_s;
        }
    }
}

/// What makes a compliance one of a step of this length, and a multiplier a force.
pub(crate) fn force_scale(model: &Model, dt_s: f64) -> f64 {
    (1.0 + dt_s * model.drag_per_s()) / (dt_s * dt_s)
}

/// Moves all particles as if there were no constraint, and keeps where they were, for a method that
/// projects. Velocities stay those of before: [`finish`] takes new ones from the positions.
pub(crate) fn predict(system: &mut System, dt_s: f64) {
    system.keep();
    let (model, scratch) = (&system.model, &mut system.scratch);
    let (positions, velocities) = (&mut system.positions, &system.velocities);
    scratch.is_fresh = false;
    scratch.before.resize(positions.len(), Point::origin());
    let accelerations = &mut scratch.accelerations;
    if model.loads.wind.is_some() {
        accelerations.clear();
        accelerations.resize(positions.len(), Vector::zeros());
        model.blow(positions, velocities, accelerations, &mut system.counters);
        model.weigh(accelerations);
    }
    let (moved, gravity) = (free_step(model, dt_s), model.gravity());
    let particles = positions.iter_mut().zip(&mut scratch.before);
    let particles = particles.zip(velocities).zip(&model.inverse_masses);
    if model.loads.wind.is_some() {
        for ((((x, before), v), &w), &a) in particles.zip(&*accelerations) {
            *before = *x;
            *x += moved(*v, a, w);
        }
    } else {
        // Without wind, all accelerations are one. (One loop for both takes 5 % more of a step of XPBD.)
        for (((x, before), v), &w) in particles {
            *before = *x;
            *x += moved(*v, gravity, w);
        }
    }
}

/// Takes as velocity what was moved, also by contact.
pub(crate) fn finish(system: &mut System, dt_s: f64) {
    let per_s = 1.0 / dt_s;
    let moves = system.positions.iter().zip(&system.scratch.before);
    for (v, (x, before)) in system.velocities.iter_mut().zip(moves) {
        *v = (x - before) * per_s;
    }
    move_out(system, per_s);
}

/// How far a particle moves in a substep without constraints, by its velocity, acceleration and inverse mass.
fn free_step(model: &Model, dt_s: f64) -> impl Fn(Vector, Vector, f64) -> Vector + use<> {
    // The part of a velocity that drag leaves.
    let keep = 1.0 / (1.0 + dt_s * model.drag_per_s());
    move |v, acceleration, inverse_mass| {
        if inverse_mass > 0.0 {
            (v + acceleration * dt_s) * keep * dt_s
        } else {
            v * dt_s
        }
    }
}

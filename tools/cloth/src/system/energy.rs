//! The energy of a system: kinetic energy, elastic energy and the potential of gravity.

use tearmesh::geometry::dot;

use crate::system::System;
use crate::system::model::Recorded;
use crate::system::pair;

/// Returns the elastic energy of all constraints and triangles, in joules.
#[must_use]
pub fn elastic_j(system: &System) -> f64 {
    system.model.elastic_j(&system.positions)
}

/// The elastic energy that the method of the last step stores, in joules: that of the forces which it
/// recorded, none where it takes constraints for rigid, and that of lengths otherwise.
pub(crate) fn stored_j(system: &System) -> f64 {
    let families = [&system.model.stretch, &system.model.bend];
    match system.model.recorded {
        Recorded::Nothing | Recorded::Limiter => elastic_j(system),
        Recorded::RigidForces => 0.0,
        Recorded::SpringForces => {
            let colours = families.into_iter().flat_map(|family| &family.colours);
            0.5 * colours.fold(0.0, |sum, colour| {
                let forces = colour.multipliers.iter().zip(&colour.compliance);
                forces.fold(sum, |sum, (f, compliance)| sum + f * f * compliance)
            })
        }
    }
}

/// Returns the kinetic energy of the particles that are not held, in joules.
#[must_use]
pub fn kinetic_j(system: &System) -> f64 {
    let all = 0..system.positions.len();
    all.map(|particle| kinetic_at_j(system, particle)).sum()
}

/// The potential of gravity of all particles, in joules: zero at the origin.
pub(crate) fn potential_j(system: &System) -> f64 {
    let Some(gravity) = system.model.loads.gravity_m_per_s2 else {
        return 0.0;
    };
    let particles = system.positions.iter().zip(&system.model.masses);
    -particles.fold(0.0, |sum, (x, m)| sum + m * dot(gravity, x.coords))
}

/// The kinetic energy of a particle, in joules: none of one that is held.
fn kinetic_at_j(system: &System, particle: usize) -> f64 {
    if system.model.held[particle] {
        return 0.0;
    }
    let v = system.velocities[particle];
    0.5 * system.model.masses[particle] * dot(v, v)
}

/// The energy that a particle has a part in, in joules: what it is joined by, its motion, and its weight.
pub(crate) fn at_j(system: &System, particle: usize) -> f64 {
    let (model, x) = (&system.model, &system.positions);
    let families = [&model.stretch, &model.bend];
    let [stretch, bend] = families.map(|family| pair::energy_at(family, x, particle));
    let elastic_j = stretch + bend + model.triangles.energy_at(x, particle);
    let weight = model.gravity() * model.masses[particle];
    elastic_j + kinetic_at_j(system, particle) - dot(weight, x[particle].coords)
}

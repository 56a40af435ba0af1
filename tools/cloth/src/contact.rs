//! The push of colliders.

use crate::energy;
use crate::system::System;

/// Pushes the particles out of the colliders. Where someone keeps a balance of energy, what that
/// makes is summed up, which takes the valence of each particle in contact.
pub(crate) fn push_out(system: &mut System) {
    if system.model.loads.colliders.is_empty() {
        return;
    }
    if system.contact_j.is_some() {
        return push_out_and_sum(system);
    }
    let (model, x, v) = (&system.model, &mut system.positions, &mut system.velocities);
    for collider in &model.loads.colliders {
        system.counters.collider_passes += 1;
        system.counters.features.collider += x.len() as u64;
        collider.push_out(&model.inverse_masses, x, v);
    }
}

fn push_out_and_sum(system: &mut System) {
    let mut made_j = 0.0;
    for i in 0..system.model.loads.colliders.len() {
        system.counters.collider_passes += 1;
        system.counters.features.collider += system.positions.len() as u64;
        for particle in 0..system.positions.len() {
            if system.model.inverse_masses[particle] <= 0.0 {
                continue;
            }
            let (x, v) = (system.positions[particle], system.velocities[particle]);
            if let Some((x, v)) = system.model.loads.colliders[i].pushed(x, v) {
                made_j -= energy::at_j(system, particle);
                system.positions[particle] = x;
                system.velocities[particle] = v;
                made_j += energy::at_j(system, particle);
            }
        }
    }
    system.contact_j = system.contact_j.map(|sum| sum + made_j);
}

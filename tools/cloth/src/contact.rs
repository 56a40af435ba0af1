//! The push of colliders.

use crate::energy;
use crate::system::System;

/// Pushes the particles out of the colliders. Where someone keeps a balance of energy, what that
/// makes is summed up, which takes the valence of each particle in contact.
pub(crate) fn push_out(system: &mut System) {
    let mut made_j = 0.0;
    for i in 0..system.model.loads.colliders.len() {
        system.counters.collider_passes += 1;
        system.counters.features.collider += system.positions.len() as u64;
        for particle in 0..system.positions.len() {
            if system.model.inverse_masses[particle] <= 0.0 {
                continue;
            }
            let (x, v) = (system.positions[particle], system.velocities[particle]);
            let Some((x, v)) = system.model.loads.colliders[i].pushed(x, v) else {
                continue;
            };
            let energy_j = |system: &System| match system.contact_j {
                Some(_) => energy::at_j(system, particle),
                None => 0.0,
            };
            made_j -= energy_j(system);
            system.positions[particle] = x;
            system.velocities[particle] = v;
            made_j += energy_j(system);
        }
    }
    system.contact_j = system.contact_j.map(|sum| sum + made_j);
}

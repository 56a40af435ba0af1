//! The impulses that draw pairs of particles together ([`drawn`](crate::system::drawn)).
//!
//! A particle that neighbours carry in steps ([`mass_scaling`](crate::system::mass_scaling)) resists as if it weighed a
//! million times what it does, and takes its neighbours with it. So its impulse is one for the masses of the
//! step, M′⁻¹ J. By its own mass such a particle gave its neighbours, step by step, as much momentum as the carried mass has at
//! the speed of drawing, which is how a seam that was sewn through slivers got to 1280 m/s.

use tearmesh::geometry::{dot, length};

use crate::system::System;
use crate::system::mass_scaling::Response;

/// When an impulse acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Acts {
    /// As the substep begins, so that what pulls the two apart in it is made up for in the next one.
    AtOnce,
    /// As a force beside those that are known of the substep to come. Without jumps of the velocities of which damping
    /// takes its part: those made 3 % of the work of sewing a shirt by velocity Verlet.
    Evenly,
}

impl System {
    /// Gives each pair its speed for a substep, or less if it is nearer than its way. Particles are as heavy as a step makes
    /// them where the force acts evenly.
    pub(crate) fn draw(&mut self, substep_s: f64, acts: Acts) {
        self.scratch.owed.clear();
        if self.model.drawn.is_empty() {
            return;
        }
        let evenly_s = match acts {
            Acts::AtOnce => {
                self.keep();
                0.0
            }
            Acts::Evenly => substep_s,
        };
        let mut responses = std::mem::take(&mut self.scratch.responses);
        for i in 0..self.model.drawn.len() {
            let pair = self.model.drawn[i];
            let [a, b] = pair.ends.map(|end| end as usize);
            let way = self.positions[b] - self.positions[a];
            let gap_m = length(way);
            for (response, end) in responses.iter_mut().zip([a, b]) {
                response.clear(self.positions.len());
                self.respond(end, acts, response);
            }
            let [of_a, of_b] = &responses;
            let ease = of_a.of[a] - of_a.of[b] + of_b.of[b] - of_b.of[a];
            if gap_m == 0.0 || ease <= 0.0 {
                continue;
            }
            let along = way / gap_m;
            let apart = self.velocities[b] - self.velocities[a];
            let toward_m_per_s = pair.speed_m_per_s.min(gap_m / substep_s) + pair.more_m_per_s;
            let pulled = &self.scratch.accelerations;
            let by_itself = match acts {
                Acts::AtOnce => apart,
                Acts::Evenly => apart + (pulled[b] - pulled[a]) * evenly_s,
            };
            let round = by_itself - along * dot(along, by_itself);
            let slower = (toward_m_per_s / length(round)).min(1.0);
            let wanted = round * slower - along * toward_m_per_s;
            let impulse = (wanted - by_itself) / ease;
            for (response, impulse) in [(of_b, impulse), (of_a, -impulse)] {
                for particle in response.particles.iter().map(|&particle| particle as usize) {
                    let faster = impulse * response.of[particle];
                    let pulled = &mut self.scratch.accelerations;
                    let v = &mut self.velocities[particle];
                    let momentum = faster * self.model.masses[particle];
                    match acts {
                        Acts::AtOnce => {
                            self.drawn_j += dot(momentum, *v + faster / 2.0);
                            *v += faster;
                        }
                        Acts::Evenly => {
                            let all = pulled[particle] * evenly_s + faster;
                            self.drawn_j += dot(momentum, *v + all / 4.0) / 2.0;
                            let owed_j = dot(momentum, *v + all * 0.75) / 2.0;
                            self.scratch.owed.push((particle as u32, owed_j));
                            pulled[particle] += faster / evenly_s;
                        }
                    }
                }
            }
            if acts == Acts::Evenly {
                self.scratch.forces[b] += impulse / evenly_s;
                self.scratch.forces[a] -= impulse / evenly_s;
            }
        }
        self.scratch.responses = responses;
    }

    /// What a force of 1 N on a particle does.
    fn respond(&self, particle: usize, acts: Acts, response: &mut Response) {
        let carry = &self.guard.carry;
        match acts {
            Acts::Evenly if carry.len() > 0 => carry.add_accelerations(particle, 1.0, response),
            Acts::Evenly => response.add(particle, self.model.inverse_masses[particle]),
            Acts::AtOnce => self.respond_at_once(particle, response),
        }
    }

    /// What a force of 1 N on a particle does at once, with its neighbours as what carries it if it is lighter than these.
    fn respond_at_once(&self, particle: usize, response: &mut Response) {
        let (masses, inverse_masses) = (&self.model.masses, &self.model.inverse_masses);
        let (own, mut sum, mut heavier) = (masses[particle], 0.0, 0.0);
        self.model.springs_at(particle, 1.0, |_, other, [k, _]| {
            sum += k;
            heavier += k * masses[other];
        });
        let need = heavier / sum;
        if inverse_masses[particle] == 0.0 || need.is_nan() || need <= own {
            response.add(particle, inverse_masses[particle]);
            return;
        }
        let mut eased = 1.0 / need;
        self.model.springs_at(particle, 1.0, |_, other, [k, _]| {
            let share = (1.0 - own / need) * (k / sum);
            if inverse_masses[other] > 0.0 {
                let inverse = 1.0 / (masses[other] + share * own);
                response.add(other, share * inverse);
                eased += share * share * inverse;
            }
        });
        response.add(particle, eased);
    }
}

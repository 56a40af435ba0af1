//! Pairs of particles that are drawn together, as the two sides of a seam that is sewn.
//!
//! In each substep an impulse between the two, along the line from one to the other, gives them a speed
//! toward each other. All else is left to the substep, so whatever a method does about contact, loads and holds it does
//! about a pair too. (To move them instead, at the end of a step, sewed through bodies and over short edges. One of
//! 20 µm was drawn to seventy times its length in a step.) An impulse across the line makes angular momentum, so there is
//! one only where two would go faster round each other than toward each other, and never meet.
//!
//! A particle that neighbours carry in steps ([`mass_scaling`](crate::system::mass_scaling)) resists as if it weighed a
//! million times what it does, and takes its neighbours with it. So its impulse is one for the masses of the
//! step, M′⁻¹ J. By its own mass such a particle gave its neighbours, step by step, as much momentum as the carried mass has at
//! the speed of drawing, which is how a seam that was sewn through slivers got to 1280 m/s.

use tearmesh::geometry::{Point, dot, length};

use crate::system::System;
use crate::system::mass_scaling::Response;

/// Two particles, and the speed in m/s at which they are drawn together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawn {
    pub(crate) ends: [u32; 2],
    pub(crate) speed_m_per_s: f64,
    /// What is added to it since they are pulled apart while they go, in m/s.
    pub(crate) more_m_per_s: f64,
}

impl Drawn {
    /// Projects the pair onto the gap that it is to have at the end of a substep, if it is wider, as if it were a
    /// constraint, and returns the work in joules. By its start one of a method that projects moves nothing heavy.
    pub(crate) fn project(
        &self,
        began: &[Point],
        substep_s: f64,
        inverse_masses: &[f64],
        x: &mut [Point],
    ) -> f64 {
        let [a, b] = self.ends.map(|end| end as usize);
        let way_m = length(began[b] - began[a]).min(self.speed_m_per_s * substep_s);
        let wanted_m = length(began[b] - began[a]) - way_m;
        let apart = x[b] - x[a];
        let excess_m = length(apart) - wanted_m;
        let sum = inverse_masses[a] + inverse_masses[b];
        if excess_m <= 0.0 || sum == 0.0 {
            return 0.0;
        }
        let pull = apart * (excess_m / (length(apart) * sum));
        x[a] += pull * inverse_masses[a];
        x[b] -= pull * inverse_masses[b];
        length(pull) * way_m / (substep_s * substep_s)
    }
}

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

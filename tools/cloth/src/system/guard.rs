//! The steps that velocity Verlet takes whole, and the masses with which it does.
//!
//! A net with the sum S of stiffness at a particle of inverse mass w has r = w S there, and its own
//! stable step is √(2/r) or a little more. The step that *suits* a system is
//!
//! ```text
//! Δt₀ = √(2μ/r₉₀),   μ = .65
//! ```
//!
//! with r₉₀ such that no more than a tenth of the free particles have a larger one: those are
//! carried by their neighbours ([`mass_scaling`](crate::system::mass_scaling)). On even sheets that is .34 to .41 h/c, on
//! uneven ones .24. A step up to twice as long is admitted whole, with many more that are carried:
//! it is as stable, and exact at rest, but errs by some per cent in motion.
//!
//! Material damping counts as stiffness in a step ([`damping`]): with the sum C of the dampers
//! at a particle, Δt² S becomes Δt² S + 2Δt C/(1 + 2θ).
//!
//! μ leaves room for the damping of what is crushed ([`crush`](crate::system::crush)), 4μ(1 + 2θ) = 3.9 of
//! 4, and what wind slows takes its part of it: with λ the rate of wind μ(1 − λΔt), so that the sum
//! stays within the limit of springs and air together ([`air`](crate::air)).
//!
//! A method without masses of its own for a step, as Provot's, has the bound
//!
//! ```text
//! ω² ≤ w S + w′ S′    of some spring, with the sums S and S′ at its ends
//! ```
//!
//! which holds in every configuration: a spring is at most as stiff as k in each direction, and these
//! are Gershgorin's rows of √k Bᵀ M⁻¹ B √k, scaled by √k. On a regular net the largest frequency that a
//! configuration has is 0.72 of it. (It was measured once, by power iteration, so that longer steps
//! could be admitted. But at light particles it does not stay where it is: of two springs at right
//! angles each has its own mode, and when they have turned side by side one mode has both. After an
//! exact cut through a waving flag of 32 × 32 cells steps by the measure blew up within 0.06 s.)
//!
//! A bend that buckles counts as a spring with the largest stiffness that it has at any length. A
//! triangle's shear gets stiffer as it is stretched, so with shear all of this holds as long as no
//! triangle is stretched beyond a *reach* ([`triangle`](crate::system::triangle)); where a step finds that one
//! is, the reach is doubled and the sums are made anew.
//!
//! Where neighbours are both carried, stability is not proven, and λ is measured by power iteration
//! on M′⁻¹ L, with L the net's scalar matrix: the worst of all configurations. It was 1.4 to 2.3
//! of the limit 2.6 on all sheets at twice Δt₀ and less at Δt₀, and up to 7.6 at four times, which
//! is why that is divided. Where it is beyond, steps are divided too. After an edit what is near it is measured
//! alone ([`net`](crate::system::net)). (It would not be needed if the
//! heavier of two neighbours kept its mass and bounded the step. But a cut makes light neighbours: after an
//! exact cut through a waving flag of 16 × 16 cells the step would be .055 of the one that suits, and .076
//! with 32 × 32; before the cut .998 and .94. All other ready scenes would keep .94 or more.)

use tearmesh::geometry::Point;

use crate::system::counters::Counters;
use crate::system::damping;
use crate::system::incidence::{Dirty, room_for};
use crate::system::mass_scaling::MassScaling;
use crate::system::model::Model;
use crate::system::net::{Net, Part};

/// μ: a quarter of the largest Δt² λ.
const SHARE: f64 = 0.65;

/// At rest a triangle takes up 2 of the reach, at 1.4 times its size 4.
pub(crate) const REACH: f64 = 4.0;

/// Δt₀ is chosen for this part of the particles.
const PERCENTILE: f64 = 0.9;

/// Where fewer than one of so many particles are near an edit, what is near it is measured alone.
const FEW: usize = 8;

/// The fraction of the limit that wind takes is rounded up to a multiple of one over this number,
/// so that it seldom changes.
const PARTS: f64 = 32.0;

/// An upper bound of the frequencies of a system, and the constraint that sets it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frequency {
    /// The angular frequency ω, in rad/s: no motion of the system, in any configuration, has a larger
    /// one. It is 0 without springs between free particles.
    pub omega_rad_per_s: f64,
    /// The particles at the ends of the constraint, or of the side of a triangle, that sets the bound;
    /// `None` if it is 0.
    pub ends: Option<[usize; 2]>,
}

/// What is known of the masses and steps of a system.
#[derive(Clone, Debug, Default)]
pub(crate) struct Guard {
    /// The weights of particles in steps that they were weighed for.
    pub(crate) carry: MassScaling,
    /// How far triangles may be stretched for the sums to hold, if that is more than [`REACH`].
    pub(crate) reach: f64,
    /// Whether the sums, and what follows from them, are those of the present constraints. Where a mesh was
    /// edited particles are weighed anew, and the step that suits gets no shorter for it: slivers along a cut
    /// are to be carried.
    pub(crate) is_known: bool,
    /// The particles whose sums may not be those of the present constraints, beside those that the families of
    /// constraints list. (To damp all of a sheet of 64 × 64 cells and to sum it up would be 1.1 of a step.)
    pub(crate) changed: Dirty,
    /// Those that were summed up and whose forces may still be those of before.
    pub(crate) unheeded: Dirty,
    /// The sums of the stiffness and of the damping at each particle, and w S of one that has the same longest
    /// step without damping.
    sums: Vec<f64>,
    dampers: Vec<f64>,
    rates: Vec<f64>,
    /// `None` until it is asked for: steps of velocity Verlet do not need it.
    frequency: Option<Frequency>,
    /// r₉₀: `None` where it is not known, and without springs.
    pub(crate) suited_rate: Option<f64>,
    /// The step, and the wind's part of the limit, that particles were weighed for.
    weighed: Option<[f64; 2]>,
    /// Whether that step is stable.
    is_sound: bool,
    /// A step that was found unstable, the shortest so far.
    unsound_s: f64,
    pub(crate) net: Net,
    /// The step and the wind's part of the limit for which modes were measured last, and the largest eigenvalue as it was
    /// then; the particles that have changed since. `None` where no measurement was needed.
    measured: Option<([f64; 2], f64)>,
    pub(crate) unmeasured: Dirty,
    pub(crate) part: Part,
    /// Room for the springs of a particle by their places, and for the rates of all in some order.
    springs: Vec<([usize; 2], [f64; 2])>,
    ranked: Vec<f64>,
}

impl Guard {
    /// How many times the suited step is admitted whole.
    pub(crate) const WHOLE: f64 = 2.0;

    /// Makes room for so many particles, and springs between them.
    pub(crate) fn reserve(&mut self, particles: usize, springs: usize) {
        self.carry.reserve(particles, springs);
        room_for(&mut self.sums, particles);
        room_for(&mut self.dampers, particles);
        room_for(&mut self.rates, particles);
        room_for(&mut self.ranked, particles);
        self.changed.reserve(particles);
        self.unheeded.reserve(particles);
        self.unmeasured.reserve(particles);
        self.net.reserve(particles, springs);
        self.part.reserve(particles);
    }

    /// Takes in how far triangles are stretched now, and brings the frequency and the suited step up to date.
    pub(crate) fn reach_out(&mut self, model: &Model, x: &[Point]) {
        let growth = model.triangles.shear_growth(x);
        // A state that is not finite is for the step to find.
        if growth > self.reach.max(REACH) && growth.is_finite() {
            self.reach = 2.0 * growth;
            self.is_known = false;
            self.mark_all(x.len());
        }
        self.look(model);
    }

    /// Notes that something has changed at each of so many particles.
    pub(crate) fn mark_all(&mut self, particles: usize) {
        (0..particles).for_each(|particle| self.changed.mark(particle));
    }

    /// Takes over the particles whose constraints have changed, and computes the damping of these.
    pub(crate) fn damp(&mut self, model: &mut Model) {
        if self.is_known {
            return;
        }
        let families = [model.stretch.changed(), model.bend.changed()];
        let families = families.into_iter().chain([model.triangles.changed()]);
        families.for_each(|changed| self.changed.take_over(changed));
        self.changed.truncate(model.masses.len());
        model.damp(self.changed.list());
    }

    /// Brings what follows from the stiffness and the damping of constraints up to date, once they are damped.
    fn look(&mut self, model: &Model) {
        if self.is_known {
            return;
        }
        self.is_known = true;
        self.weighed = None;
        self.unsound_s = f64::INFINITY;
        self.frequency = None;
        self.sum_up(model);
        // To rank all would be a tenth of a step, and it is seldom that fewer than before are as stiff as the one known.
        let known = self.suited_rate.unwrap_or(f64::INFINITY);
        let moving = self.rates.iter().filter(|rate| **rate > 0.0);
        let last = moving.clone().count().saturating_sub(1);
        let place = (PERCENTILE * last as f64).ceil() as usize;
        if moving.clone().filter(|rate| **rate < known).count() > place {
            self.ranked.clear();
            self.ranked.extend(moving);
            let (_, rate, _) = self.ranked.select_nth_unstable_by(place, f64::total_cmp);
            self.suited_rate = Some(*rate);
        }
    }

    /// The step in seconds that suits most particles, once it is known.
    pub(crate) fn suited_s(&self) -> f64 {
        let suited_s = |rate: f64| (2.0 * SHARE / rate).sqrt();
        self.suited_rate.map_or(f64::INFINITY, suited_s)
    }

    /// Sums up the springs of the particles that have changed.
    fn sum_up(&mut self, model: &Model) {
        let reach = self.reach.max(REACH);
        for list in [&mut self.sums, &mut self.dampers, &mut self.rates] {
            list.resize(model.masses.len(), 0.0);
        }
        // The damping of a spring goes by the masses of both ends, and that of a triangle by those of all corners.
        for i in 0..self.changed.list().len() {
            let particle = self.changed.list()[i] as usize;
            model.springs_at(particle, reach, |_, other, _| self.changed.mark(other));
        }
        for i in 0..self.changed.list().len() {
            self.sum_at(self.changed.list()[i] as usize, model, reach);
        }
        for list in [&mut self.unheeded, &mut self.unmeasured] {
            list.truncate(model.masses.len());
            for &particle in self.changed.list() {
                list.mark(particle as usize);
            }
        }
        self.changed.clear();
    }

    /// Sums up the springs of a particle in the order of a pass over all springs, so that the sums are to the bit those
    /// of such a pass.
    fn sum_at(&mut self, particle: usize, model: &Model, reach: f64) {
        let springs = &mut self.springs;
        springs.clear();
        model.springs_at(particle, reach, |place, _, numbers| {
            springs.push((place, numbers));
        });
        springs.sort_unstable_by_key(|(place, _)| *place);
        let (mut sum, mut damper) = (0.0, 0.0);
        for (_, [stiffness, damping]) in springs {
            sum += *stiffness;
            damper += *damping;
        }
        let w = model.inverse_masses[particle];
        self.sums[particle] = sum;
        self.dampers[particle] = damper;
        self.rates[particle] = rate(w * sum, w * damper);
    }

    /// The bound of frequencies, once what it follows from is known. Costs a pass over all springs after a change.
    pub(crate) fn frequency(&mut self, model: &Model) -> Frequency {
        let (sums, w) = (&self.sums, &model.inverse_masses);
        *self.frequency.get_or_insert_with(|| {
            let mut most = (0.0, None);
            model.each_spring(self.reach.max(REACH), |[a, b], _| {
                let row = w[a] * sums[a] + w[b] * sums[b];
                if row > most.0 {
                    most = (row, Some([a, b]));
                }
            });
            let (square, ends): (f64, _) = most;
            Frequency {
                omega_rad_per_s: square.sqrt(),
                ends,
            }
        })
    }

    /// Weighs the particles for a step of which wind takes the part `air`, and says whether any
    /// weight may have changed.
    pub(crate) fn weigh(&mut self, model: &Model, dt_s: f64, air: f64) -> bool {
        self.look(model);
        let air = ((air * PARTS).ceil() / PARTS).min(1.0 - 1.0 / PARTS);
        if self.weighed == Some([dt_s, air]) {
            return false;
        }
        let had = self.carry.len();
        let damper = damping::stiffness_in(dt_s);
        let sums = self.sums.iter().zip(&self.dampers);
        let stiffness = sums.map(|(sum, dampers)| sum + damper * dampers);
        let masses = [&model.masses[..], &model.inverse_masses[..]];
        let reach = self.reach.max(REACH);
        let neighbours = |particle, visit: &mut dyn FnMut(usize, f64)| {
            model.springs_at(particle, reach, |_, other, [k, c]| {
                if k > 0.0 {
                    visit(other, k + damper * c);
                }
            });
        };
        let share = SHARE * (1.0 - air);
        self.carry.weigh(masses, stiffness, neighbours, share, dt_s);
        self.weighed = Some([dt_s, air]);
        self.is_sound = self.carry.is_proven;
        if self.is_sound {
            self.measured = None;
            self.unmeasured.clear();
        } else {
            let reweighed = self.carry.reweighed();
            reweighed.for_each(|particle| self.unmeasured.mark(particle));
        }
        had + self.carry.len() > 0
    }

    /// Whether a step is stable that particles were weighed for just now.
    pub(crate) fn is_sound(&mut self, model: &Model, counters: &mut Counters) -> bool {
        let Some([dt_s, air]) = self.weighed.filter(|_| !self.is_sound) else {
            return true;
        };
        if dt_s >= self.unsound_s {
            return false;
        }
        let limit = 4.0 * SHARE * (1.0 - air) / (dt_s * dt_s);
        let stiffness = (self.reach.max(REACH), damping::stiffness_in(dt_s));
        let (carry, near) = (&self.carry, &mut self.unmeasured);
        let known = self.measured.filter(|(step, _)| *step == [dt_s, air]);
        let is_small = near.list().len() < model.masses.len() / FEW;
        let mut largest = known
            .filter(|_| is_small)
            .map_or(f64::INFINITY, |(_, before)| {
                let near = self.part.near(near, model, stiffness, carry);
                Net::unless_faster(before, near)
            });
        if largest > limit {
            largest = self.net.whole(model, stiffness, carry, counters);
        }
        self.is_sound = largest <= limit;
        if self.is_sound {
            self.measured = Some(([dt_s, air], largest));
            self.unmeasured.clear();
        } else {
            self.unsound_s = dt_s;
        }
        self.is_sound
    }
}

/// w S of a particle for which an undamped one has the same longest step: Δt² w S + 2Δt w C/(1 + 2θ) = 2μ.
fn rate(stiffness: f64, damping: f64) -> f64 {
    if damping == 0.0 {
        return stiffness;
    }
    let half = 0.5 * damping * damping::stiffness_in(1.0);
    let step_s = ((half * half + 2.0 * SHARE * stiffness).sqrt() - half) / stiffness;
    2.0 * SHARE / (step_s * step_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::constraint::Constraint;
    use crate::system::triangle::Triangle;

    const PARTICLES: usize = 9;

    /// Numbers whose sum depends on their order.
    fn number(i: usize) -> f64 {
        1.0 + 1.0 / (3 + i * 7 % 31) as f64
    }

    fn spring(i: usize) -> Constraint {
        let a = i % PARTICLES;
        Constraint {
            ends: [a, (a + 1 + i / PARTICLES) % PARTICLES],
            rest_length_m: 1.0,
            stiffness_n_per_m: number(i),
        }
    }

    fn triangle(i: usize) -> Triangle {
        let corners = [0, 1, 3].map(|corner| ((i + corner) % PARTICLES) as u32);
        let material = [[0.0, 0.0], [number(i), 0.1], [0.3, number(i + 1)]];
        Triangle::new(corners, material, [0, 1, 2].map(|k| number(i + k))).expect("a triangle")
    }

    /// The sums by a pass over all springs.
    fn passed(model: &Model) -> [Vec<f64>; 2] {
        let mut sums = [vec![0.0; PARTICLES], vec![0.0; PARTICLES]];
        model.each_spring(REACH, |ends, numbers| {
            for end in ends {
                sums[0][end] += numbers[0];
                sums[1][end] += numbers[1];
            }
        });
        sums
    }

    #[test]
    fn sums_are_to_the_bit_those_of_a_pass() {
        let (mut model, mut guard) = (Model::default(), Guard::default());
        model.damping_s = 1.0; // At the cap, which goes by masses.
        (0..PARTICLES).for_each(|i| model.push_particle(number(i), false));
        let mut ids: Vec<_> = (0..18).map(|i| model.stretch.add(spring(i))).collect();
        for i in 18..27 {
            model.bend.add(spring(i));
        }
        (0..6).for_each(|i| model.triangles.put(i, triangle(i)));
        for round in 0..60 {
            guard.damp(&mut model);
            guard.look(&model);
            let [sums, dampers] = passed(&model);
            assert_eq!((&guard.sums, &guard.dampers), (&sums, &dampers), "{round}");
            // One goes, comes back elsewhere with other numbers, two others change, and a particle weighs less.
            model.stretch.remove(ids.swap_remove(round % 11));
            ids.push(model.stretch.add(spring(round % 18 + 2)));
            model.stretch.set_stiffness(ids[round % 7], number(round));
            model.triangles.put(round % 6, triangle(round));
            model.inverse_masses[round % PARTICLES] = number(round + 5);
            guard.changed.mark(round % PARTICLES);
            guard.is_known = false;
        }
    }
}

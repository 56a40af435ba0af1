//! Which steps velocity Verlet takes whole, and with which masses.
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
//! is why that is divided. Where it is beyond, steps are divided too. (It would not be needed if the
//! heavier of two neighbours kept its mass and bounded the step. But a cut makes light neighbours: after an
//! exact cut through a waving flag of 16 × 16 cells the step would be .055 of the one that suits, and .076
//! with 32 × 32; before the cut .998 and .94. All other ready scenes would keep .94 or more.)

use tearmesh::geometry::Point;

use crate::system::counters::Counters;
use crate::system::damping;
use crate::system::incidence::room_for;
use crate::system::mass_scaling::MassScaling;
use crate::system::model::Model;
use crate::system::pair;

/// μ: a quarter of the largest Δt² λ.
const SHARE: f64 = 0.65;

/// At rest a triangle takes up 2 of the reach, at 1.4 times its size 4.
const REACH: f64 = 4.0;

/// Δt₀ is chosen for this part of the particles.
const PERCENTILE: f64 = 0.9;

/// The fraction of the limit that wind takes is rounded up to a multiple of one over this number,
/// so that it seldom changes.
const PARTS: f64 = 32.0;

/// Power iteration: the most matrix–vector products, and the relative change at which it stops.
const PRODUCTS: u32 = 100;
const SETTLED: f64 = 1e-3;

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
    reach: f64,
    /// Whether the sums, and what follows from them, are those of the present constraints. Where a mesh was
    /// edited particles are weighed anew, and the step that suits gets no shorter for it: slivers along a cut
    /// are to be carried.
    pub(crate) is_known: bool,
    /// The sums of the stiffness and of the damping at each particle.
    sums: Vec<f64>,
    dampers: Vec<f64>,
    pub(crate) frequency: Frequency,
    /// `None` where it is not known, and without springs.
    pub(crate) suited_s: Option<f64>,
    /// The step, and the wind's part of the limit, that particles were weighed for.
    weighed: Option<[f64; 2]>,
    /// Whether that step is stable.
    is_sound: bool,
    /// A step that was found unstable, the shortest so far.
    unsound_s: f64,
    /// The vector that was found last, and room for a product.
    vector: Vec<f64>,
    product: Vec<f64>,
    rates: Vec<f64>,
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
        room_for(&mut self.vector, particles);
        room_for(&mut self.product, particles);
    }

    /// Takes in how far triangles are stretched now, and brings the frequency and the suited step up to date.
    pub(crate) fn reach_out(&mut self, model: &Model, x: &[Point]) {
        let growth = model.triangles.shear_growth(x);
        // A state that is not finite is for the step to find.
        if growth > self.reach.max(REACH) && growth.is_finite() {
            self.reach = 2.0 * growth;
            self.is_known = false;
        }
        self.look(model);
    }

    /// Sums up stiffness anew where it has changed.
    fn look(&mut self, model: &Model) {
        if self.is_known {
            return;
        }
        self.is_known = true;
        self.weighed = None;
        self.unsound_s = f64::INFINITY;
        let reach = self.reach.max(REACH);
        let (sums, dampers) = (&mut self.sums, &mut self.dampers);
        for list in [&mut *sums, &mut *dampers] {
            list.clear();
            list.resize(model.masses.len(), 0.0);
        }
        model.each_spring(reach, |ends, [stiffness, damping]| {
            for end in ends {
                sums[end] += stiffness;
                dampers[end] += damping;
            }
        });
        let (sums, w) = (&self.sums, &model.inverse_masses);
        let mut most = (0.0, None);
        model.each_spring(reach, |[a, b], _| {
            let row = w[a] * sums[a] + w[b] * sums[b];
            if row > most.0 {
                most = (row, Some([a, b]));
            }
        });
        let (square, ends) = most;
        self.frequency = Frequency {
            omega_rad_per_s: square.sqrt(),
            ends,
        };
        let rates = self.sums.iter().zip(&self.dampers);
        let rates = rates.zip(&model.inverse_masses);
        let rates = rates.map(|((sum, damper), w)| rate(w * sum, w * damper));
        let rates = rates.filter(|rate| *rate > 0.0);
        self.rates.clear();
        self.rates.extend(rates);
        let last = self.rates.len().saturating_sub(1);
        let place = (PERCENTILE * last as f64).ceil() as usize;
        if !self.rates.is_empty() {
            let (_, rate, _) = self.rates.select_nth_unstable_by(place, f64::total_cmp);
            let suited_s = (2.0 * SHARE / *rate).sqrt();
            self.suited_s = Some(self.suited_s.map_or(suited_s, |known| known.max(suited_s)));
        }
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
        let stiffness = |particle: usize| self.sums[particle] + damper * self.dampers[particle];
        let masses = [&model.masses[..], &model.inverse_masses[..]];
        let reach = self.reach.max(REACH);
        let neighbours = |particle, visit: &mut dyn FnMut(usize, f64)| {
            let mut visit = |other, [k, c]: [f64; 2]| visit(other, k + damper * c);
            pair::springs_at(&model.stretch, particle, &mut visit);
            pair::springs_at(&model.bend, particle, &mut visit);
            model.triangles.springs_at(particle, reach, visit);
        };
        let share = SHARE * (1.0 - air);
        self.carry.weigh(masses, stiffness, neighbours, share, dt_s);
        self.weighed = Some([dt_s, air]);
        self.is_sound = self.carry.is_proven;
        had + self.carry.len() > 0
    }

    /// Whether a step is stable that particles were weighed for just now.
    pub(crate) fn is_sound(&mut self, model: &Model, counters: &mut Counters) -> bool {
        let Some([dt_s, air]) = self.weighed.filter(|_| !self.is_sound) else {
            return true;
        };
        if dt_s < self.unsound_s {
            let limit = 4.0 * SHARE * (1.0 - air);
            self.is_sound = dt_s * dt_s * self.largest(model, dt_s, counters) <= limit;
        }
        if !self.is_sound {
            self.unsound_s = self.unsound_s.min(dt_s);
        }
        self.is_sound
    }

    /// The largest eigenvalue of M′⁻¹ L for a step, from below.
    fn largest(&mut self, model: &Model, dt_s: f64, counters: &mut Counters) -> f64 {
        let damper = damping::stiffness_in(dt_s);
        let count = model.masses.len();
        if self.vector.len() != count {
            // Signs that alternate as the fastest modes do.
            let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            let start = (0..count).map(|i| sign(i) + 0.1 * ((i % 7) as f64));
            self.vector.clear();
            self.vector.extend(start);
        }
        let mut largest = 0.0;
        for _ in 0..PRODUCTS {
            counters.matrix_products += 1;
            let (u, product) = (&mut self.vector, &mut self.product);
            for (u, w) in u.iter_mut().zip(&model.inverse_masses) {
                *u = if *w > 0.0 { *u } else { 0.0 };
            }
            product.clear();
            product.resize(count, 0.0);
            model.each_spring(self.reach.max(REACH), |[a, b], [k, c]| {
                let force = (k + damper * c) * (u[a] - u[b]);
                product[a] += force;
                product[b] -= force;
            });
            let energy = inner(u, product);
            std::mem::swap(u, product);
            // What was the product is made an acceleration, and its own product is needed with it.
            product.clone_from(u);
            self.carry.accelerate(u);
            let square = inner(u, product) / energy;
            let norm = inner(u, u).sqrt();
            if !(square.is_finite() && norm > 0.0 && norm.is_finite()) {
                self.vector.clear();
                return largest;
            }
            u.iter_mut().for_each(|u| *u /= norm);
            let grown = square - largest;
            largest = square.max(largest);
            if grown <= SETTLED * square {
                break;
            }
        }
        largest
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

fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

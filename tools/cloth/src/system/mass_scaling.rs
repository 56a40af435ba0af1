//! Light particles carried by their neighbours: selective mass scaling.
//!
//! The longest stable step of an explicit method is set by its lightest particle: one of a hundredth
//! of the mass shortens it six times, though nobody looks at how fast that particle swings about
//! its neighbours. So a particle that is too light for a step gets more inertia, but against a
//! weighted mean of its neighbours alone and not against the ground: it is *carried* by them.
//!
//! ```text
//! need = Δt² S / (2μ)         S the sum of the stiffness at the particle
//! s    = (need − m)/need      β = s k / Σ k, of each neighbour
//! M′   = Uᵀ D U,              (U u)ₐ = uₐ − Σ β u,   Dₐ = need,   m grows by β mₐ at each neighbour
//! ```
//!
//! The lightest for its need comes first, and those that were carried before count no more among the
//! neighbours of later ones.
//!
//! * M′ is symmetric and positive, so the step keeps what it kept with M. M′ 1 = M 1: where all
//!   particles have one velocity it is M, so free fall is exact, and momentum too.
//! * M′ ≥ M, as p|uₐ − s ū|² + s m Σ β/s |u|² ≥ m uₐ² + (p − m)|uₐ − ū|² by Jensen's inequality.
//! * With it Σ k |uₐ − uᵦ|² ≤ (4μ/Δt²) u M′u, which is stability up to Δt² λ = 4μ in every
//!   configuration: of a spring between two that are not carried since |uₐ − uᵦ|² ≤ 2 uₐ² + 2 uᵦ²,
//!   and of one that is carried by others since (1 − s)² ≤ 1 + 2s − s². Of two neighbours that are
//!   both carried it is not proven in general; there [`MassScaling::is_proven`] is false, and λ is measured.
//! * At rest it does nothing: M′⁻¹ 0 = 0. So strains at rest are those of the fabric.
//!
//! M′⁻¹ f costs one pass over the carried particles forward, one over all, and one back. Macek and
//! Aubert 1995 and Olovsson, Simonsson and Unosson 2005 scale masses of elements that way; theirs
//! need a solver.

use std::ops::{AddAssign, Mul};

use crate::system::incidence::room_for;

/// What particles weigh in a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct MassScaling {
    /// 1/D: zero for particles that are held.
    inverse: Vec<f64>,
    /// The same, before particles were weighed last.
    inverse_before: Vec<f64>,
    /// The particles that are carried by their neighbours, and where the legs of each end.
    stars: Vec<(u32, usize)>,
    /// The neighbours of all stars, with their β.
    legs: Vec<(u32, f64)>,
    is_carried: Vec<bool>,
    /// Whether no two that are carried are neighbours, so that stability is proven.
    pub(crate) is_proven: bool,
    /// The largest mass of one that is carried, as a multiple of its own when particles were weighed last: since then it may
    /// have become one with another. At most 1 if there is none.
    pub(crate) mass_ratio_max: f64,
    /// What each particle is to weigh at least, and those that weigh less: how many times less.
    needs: Vec<f64>,
    light: Vec<(f64, u32)>,
}

/// What a force on one particle does to all: numbers by particle, most of which are zero.
#[derive(Clone, Debug, Default)]
pub(crate) struct Response {
    pub(crate) of: Vec<f64>,
    /// Those whose number may not be zero.
    pub(crate) particles: Vec<u32>,
}

impl Response {
    /// Makes all numbers of so many particles zero.
    pub(crate) fn clear(&mut self, count: usize) {
        for particle in self.particles.drain(..) {
            self.of[particle as usize] = 0.0;
        }
        self.of.resize(count, 0.0);
    }

    /// Adds to the number of a particle.
    pub(crate) fn add(&mut self, particle: usize, more: f64) {
        let number = &mut self.of[particle];
        if *number == 0.0 {
            self.particles.push(particle as u32);
        }
        *number += more;
    }
}

impl MassScaling {
    /// Weighs particles of these masses for a net with the sum `stiffness` at each of them, so that
    /// Δt² λ is at most 4 `share`. An inverse mass of zero says that a particle is held. `neighbours` visits
    /// those of a particle with the stiffness between, in N/m.
    pub(crate) fn weigh(
        &mut self,
        masses: [&[f64]; 2],
        stiffness: impl Iterator<Item = f64>,
        neighbours: impl Fn(usize, &mut dyn FnMut(usize, f64)),
        share: f64,
        dt_s: f64,
    ) {
        let [masses, inverse_masses] = masses;
        self.stars.clear();
        self.legs.clear();
        self.light.clear();
        (self.is_proven, self.mass_ratio_max) = (true, 1.0);
        let needs = stiffness.map(|stiffness| dt_s * dt_s * stiffness / (2.0 * share));
        self.needs.clear();
        self.needs.extend(needs);
        let weights = masses.iter().zip(inverse_masses).zip(&self.needs);
        for (particle, ((&m, &w), &need)) in weights.enumerate() {
            if w > 0.0 && need > m {
                self.light.push((need / m, particle as u32));
            }
        }
        std::mem::swap(&mut self.inverse, &mut self.inverse_before);
        self.inverse.clear();
        if self.light.is_empty() {
            return;
        }
        // Until the end, what each particle weighs.
        self.inverse.extend_from_slice(masses);
        self.is_carried.clear();
        self.is_carried.resize(masses.len(), false);
        let by_weight = |a: &(f64, u32), b: &(f64, u32)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
        self.light.sort_unstable_by(by_weight);
        for i in 0..self.light.len() {
            let particle = self.light[i].1 as usize;
            self.carry(particle, self.needs[particle], &neighbours);
        }
        for (inverse, &w) in self.inverse.iter_mut().zip(inverse_masses) {
            *inverse = if w > 0.0 { 1.0 / *inverse } else { 0.0 };
        }
        let carried = self.stars.iter().map(|&(particle, _)| particle as usize);
        let ratios = carried.map(|particle| 1.0 / (self.inverse[particle] * masses[particle]));
        self.mass_ratio_max = ratios.fold(1.0, f64::max);
    }

    /// Makes room for so many particles, and springs between them.
    pub(crate) fn reserve(&mut self, particles: usize, springs: usize) {
        room_for(&mut self.inverse, particles);
        room_for(&mut self.inverse_before, particles);
        room_for(&mut self.stars, particles);
        room_for(&mut self.legs, 2 * springs);
        room_for(&mut self.is_carried, particles);
        room_for(&mut self.needs, particles);
        room_for(&mut self.light, particles);
    }

    /// Has a particle carried by its neighbours that are not, unless it weighs what it needs.
    fn carry(
        &mut self,
        particle: usize,
        need: f64,
        neighbours: &impl Fn(usize, &mut dyn FnMut(usize, f64)),
    ) {
        let own = self.inverse[particle];
        if need <= own {
            return;
        }
        let (first, mut sum) = (self.legs.len(), 0.0);
        neighbours(particle, &mut |other, stiffness| {
            if self.is_carried[other] {
                self.is_proven = false;
            } else {
                self.legs.push((other as u32, stiffness));
                sum += stiffness;
            }
        });
        if sum == 0.0 {
            self.is_proven = false;
            return;
        }
        let share = (need - own) / need;
        for (other, leg) in &mut self.legs[first..] {
            *leg *= share / sum;
            self.inverse[*other as usize] += *leg * own;
        }
        self.inverse[particle] = need;
        self.is_carried[particle] = true;
        self.stars.push((particle as u32, self.legs.len()));
    }

    /// The particles that weigh something else than before they were weighed last, and those that came since.
    pub(crate) fn reweighed(&self) -> impl Iterator<Item = usize> + '_ {
        let both = self.inverse.iter().zip(&self.inverse_before).enumerate();
        let others = both.filter(|(_, (now, before))| now != before);
        let came = self.inverse_before.len()..self.inverse.len();
        others.map(|(particle, _)| particle).chain(came)
    }

    /// Takes over what some particles of another scaling weigh, by their places in a list, and what carries
    /// them there; and one more, which is held.
    pub(crate) fn take_part(
        &mut self,
        whole: &MassScaling,
        particles: &[u32],
        place: impl Fn(u32) -> Option<u32>,
    ) {
        self.inverse.clear();
        let inverse = particles
            .iter()
            .map(|particle| whole.inverse[*particle as usize]);
        self.inverse.extend(inverse.chain([0.0]));
        self.stars.clear();
        self.legs.clear();
        let mut first = 0;
        for &(particle, end) in &whole.stars {
            if let Some(particle) = place(particle) {
                let legs = whole.legs[first..end].iter();
                let legs = legs.filter_map(|&(other, share)| Some((place(other)?, share)));
                self.legs.extend(legs);
                self.stars.push((particle, self.legs.len()));
            }
            first = end;
        }
    }

    /// Adds the accelerations by a force on one particle, in a list of them by particle and one of those that have any.
    /// Costs a pass over what is carried.
    pub(crate) fn add_accelerations(&self, particle: usize, force: f64, to: &mut Response) {
        to.add(particle, force);
        let mut first = 0;
        for &(carried, end) in &self.stars {
            let force = to.of[carried as usize];
            if force != 0.0 {
                for &(other, share) in &self.legs[first..end] {
                    to.add(other as usize, force * share);
                }
            }
            first = end;
        }
        for &particle in &to.particles {
            to.of[particle as usize] *= self.inverse[particle as usize];
        }
        for (i, &(carried, end)) in self.stars.iter().enumerate().rev() {
            let first = i.checked_sub(1).map_or(0, |i| self.stars[i].1);
            let legs = &self.legs[first..end];
            let by_legs = legs
                .iter()
                .map(|&(other, share)| to.of[other as usize] * share);
            let sum: f64 = by_legs.sum();
            if sum != 0.0 {
                to.add(carried as usize, sum);
            }
        }
    }

    /// One over what each particle weighs in a step; zero for those that are held.
    pub(crate) fn inverses(&self) -> &[f64] {
        &self.inverse
    }

    /// How many particles are carried.
    pub(crate) fn len(&self) -> usize {
        self.stars.len()
    }

    /// Makes accelerations of forces: M′⁻¹ f. Only where something is carried.
    pub(crate) fn accelerate<T>(&self, forces: &mut [T])
    where
        T: Copy + AddAssign + Mul<f64, Output = T>,
    {
        let mut first = 0;
        for &(particle, end) in &self.stars {
            let force = forces[particle as usize];
            for &(other, share) in &self.legs[first..end] {
                forces[other as usize] += force * share;
            }
            first = end;
        }
        for (force, &inverse) in forces.iter_mut().zip(&self.inverse) {
            *force = *force * inverse;
        }
        for (i, &(particle, end)) in self.stars.iter().enumerate().rev() {
            let first = i.checked_sub(1).map_or(0, |i| self.stars[i].1);
            let mut own = forces[particle as usize];
            for &(other, share) in &self.legs[first..end] {
                own += forces[other as usize] * share;
            }
            forces[particle as usize] = own;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ends of springs, and their stiffness.
    type Springs = Vec<([usize; 2], f64)>;

    /// The columns of M′⁻¹.
    fn columns(carry: &MassScaling, count: usize) -> Vec<Vec<f64>> {
        let column = |i| {
            let mut unit = vec![0.0; count];
            unit[i] = 1.0;
            carry.accelerate(&mut unit);
            unit
        };
        (0..count).map(column).collect()
    }

    fn free(masses: &[f64], springs: &Springs, dt_s: f64) -> MassScaling {
        let inverse: Vec<f64> = masses.iter().map(|m| 1.0 / m).collect();
        let at = |particle| {
            let is_at = move |spring: &&([usize; 2], f64)| spring.0.contains(&particle);
            springs.iter().filter(is_at)
        };
        let sum = |particle| at(particle).map(|spring| spring.1).sum::<f64>();
        let neighbours = |particle, visit: &mut dyn FnMut(usize, f64)| {
            at(particle).for_each(|&([a, b], stiffness)| visit(a + b - particle, stiffness));
        };
        let mut carry = MassScaling::default();
        let sums = (0..masses.len()).map(sum);
        carry.weigh([masses, &inverse], sums, neighbours, 0.65, dt_s);
        carry
    }

    /// A star with a light middle, and a chain whose ends are light.
    fn nets() -> [(Vec<f64>, Springs); 2] {
        let star = (1..5).map(|i| ([0, i], 10.0 * i as f64)).collect();
        let chain = (0..5).map(|i| ([i, i + 1], 50.0)).collect();
        let ends = vec![0.02, 0.05, 1.0, 1.0, 1.0, 0.1];
        [(vec![0.01, 1.0, 2.0, 1.0, 3.0], star), (ends, chain)]
    }

    #[test]
    fn the_matrix_is_symmetric_and_moves_all_as_the_masses_do() {
        for (masses, springs) in nets() {
            let carry = free(&masses, &springs, 0.1);
            assert!(carry.len() > 0);
            let columns = columns(&carry, masses.len());
            for (i, column) in columns.iter().enumerate() {
                for (j, value) in column.iter().enumerate() {
                    assert!((value - columns[j][i]).abs() < 1e-14 * (1.0 + value.abs()));
                }
            }
            // M′⁻¹ M 1 = 1.
            let mut weight = masses.clone();
            carry.accelerate(&mut weight);
            assert!(weight.iter().all(|a| (a - 1.0).abs() < 1e-14), "{weight:?}");
        }
    }

    /// The largest eigenvalue of M′⁻¹ L by power iteration.
    fn largest(carry: &MassScaling, springs: &Springs, count: usize) -> f64 {
        let mut u: Vec<f64> = (0..count).map(|i| ((i * i + 1) % 5) as f64 - 1.7).collect();
        let mut largest = 0.0;
        for _ in 0..3000 {
            let mut f = vec![0.0; count];
            for &([a, b], stiffness) in springs {
                f[a] += stiffness * (u[a] - u[b]);
                f[b] += stiffness * (u[b] - u[a]);
            }
            carry.accelerate(&mut f);
            largest = f.iter().map(|f| f * f).sum::<f64>().sqrt();
            u = f.iter().map(|f| f / largest).collect();
        }
        largest
    }

    #[test]
    fn every_mode_is_within_the_share_of_the_limit() {
        for (masses, springs) in nets() {
            for dt_s in [0.02, 0.1, 0.3] {
                let carry = free(&masses, &springs, dt_s);
                if carry.len() > 0 {
                    let square = dt_s * dt_s * largest(&carry, &springs, masses.len());
                    assert!(square <= 2.6 + 1e-9, "{square} at {dt_s}");
                }
            }
            // Nothing is carried that is heavy enough.
            let carry = free(&masses, &springs, 0.001);
            assert_eq!((carry.len(), carry.is_proven), (0, true));
        }
    }
}

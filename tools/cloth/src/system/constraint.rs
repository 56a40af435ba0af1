//! Distance constraints between particles, in colours.
//!
//! No two constraints of a colour share a particle, and the constraints of a colour are contiguous
//! in memory. So a sweep in colour order never waits for the previous write (3.2–3.7 ns per
//! projection, where the order of the mesh takes 16). A new constraint takes the first colour that
//! is free at both of its ends, so an edit costs the valence of its ends and never a rebuild. With
//! valence d no more than 2d − 1 colours are needed.
//!
//! All data of the constraints is stored here in columns, including what a step leaves behind in
//! them. It stays with its constraint when constraints are added or removed, or get another end.

use std::array::from_ref;

use crate::system::bend::Buckling;
use crate::system::damping;
use crate::system::incidence::{Dirty, Incidence, room_for};

/// The id of a constraint within its family. It is stable until the constraint is removed; a later
/// constraint may then reuse it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ConstraintId(pub(crate) u32);

impl ConstraintId {
    /// Returns the index of this id, from 0, for tables beside the constraints.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// A spring between two particles, or a distance constraint for the methods that project.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// The indices of the two particles.
    pub ends: [usize; 2],
    /// The length at rest, in metres; positive.
    pub rest_length_m: f64,
    /// The stiffness k, in newtons per metre; positive. The energy is ½ k (l − L)². For bends that
    /// buckle, k is the stiffness against compression before they do.
    pub stiffness_n_per_m: f64,
}

/// The colour of a free id.
const NONE: u32 = u32::MAX;

/// A family of distance constraints: the stretch constraints of a system, or its bend constraints.
#[derive(Clone, Debug, Default)]
pub struct Constraints {
    /// In the order of every sweep.
    pub(crate) colours: Vec<Colour>,
    /// The law by which all of them act; `None` where they are springs.
    pub(crate) law: Option<Buckling>,
    /// By id: the colour and the index in it; [`NONE`] for a free id.
    slots: Vec<[u32; 2]>,
    free: Vec<u32>,
    /// By id and side.
    lists: Incidence<2>,
    /// No rest length in metres, and no product of stiffness and rest length in newtons, was ever more.
    pub(crate) most: [f64; 2],
    /// Room for marking colours.
    taken: Vec<bool>,
}

/// The constraints of one colour, no two of which share a particle: columns of the same length. The last
/// one is left behind by a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Colour {
    pub(crate) ids: Vec<u32>,
    pub(crate) ends: Vec<[u32; 2]>,
    pub(crate) rest: Vec<f64>,
    pub(crate) stiffness: Vec<f64>,
    /// The inverse of the stiffness: a division less in each projection.
    pub(crate) compliance: Vec<f64>,
    /// The force by the rate at which the length changes, in N s/m: that of the last
    /// [`Constraints::damp`].
    pub(crate) damping: Vec<f64>,
    /// Minus the force of the method, in newtons: λ/Δt².
    pub(crate) multipliers: Vec<f64>,
}

impl Constraints {
    /// Makes room for so many particles and constraints in all. A colour that is first free has k others
    /// before it that are taken at either end, so that of C constraints few can have a late one: at a
    /// time no more than 2 C/(k + 2).
    pub(crate) fn reserve(&mut self, particles: usize, constraints: usize) {
        let valences = (0..=self.lists.last_particle()).map(|particle| self.of(particle).count());
        let colours = 2 * valences.max().unwrap_or(0);
        let colours = colours.max(self.colours.len());
        self.colours.resize_with(colours, Colour::default);
        room_for(&mut self.taken, self.colours.len() + 1);
        for (k, colour) in self.colours.iter_mut().enumerate() {
            colour.reserve((particles / 2).min(2 * constraints / (k + 2)));
        }
        room_for(&mut self.slots, constraints);
        room_for(&mut self.free, constraints);
        self.lists.reserve(particles, constraints);
    }

    /// Returns the number of constraints.
    #[must_use]
    pub fn len(&self) -> usize {
        self.slots.len() - self.free.len()
    }

    /// Returns whether there are no constraints.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the constraint with this id.
    ///
    /// # Panics
    ///
    /// If there is no such constraint.
    #[must_use]
    pub fn get(&self, id: ConstraintId) -> Constraint {
        let (colour, i) = self.slot(id);
        let colour = &self.colours[colour];
        Constraint {
            ends: colour.ends[i].map(|end| end as usize),
            rest_length_m: colour.rest[i],
            stiffness_n_per_m: colour.stiffness[i],
        }
    }

    /// Returns the ids of all constraints in colour order, which is the order of every sweep.
    pub fn iter(&self) -> impl Iterator<Item = ConstraintId> + '_ {
        let ids = self.colours.iter().flat_map(|colour| &colour.ids);
        ids.map(|&id| ConstraintId(id))
    }

    /// The ends, the rest length and the stiffness of each, in that order.
    pub(crate) fn springs(&self) -> impl Iterator<Item = ([usize; 2], f64, f64)> + '_ {
        self.colours.iter().flat_map(Colour::springs)
    }

    /// Returns the constraints that act on a particle.
    ///
    /// # Panics
    ///
    /// If there is no such particle.
    pub(crate) fn of(&self, particle: usize) -> impl Iterator<Item = ConstraintId> + '_ {
        let ids = self.lists.of(particle);
        ids.map(|(id, _)| ConstraintId(id as u32))
    }

    pub(crate) fn multiplier(&self, id: ConstraintId) -> f64 {
        let (colour, i) = self.slot(id);
        self.colours[colour].multipliers[i]
    }

    pub(crate) fn add(&mut self, constraint: Constraint) -> ConstraintId {
        self.add_with(constraint, 0.0)
    }

    /// Adds a constraint with the multiplier of another one.
    pub(crate) fn add_with(&mut self, constraint: Constraint, multiplier: f64) -> ConstraintId {
        let id = self.free.pop().unwrap_or_else(|| {
            self.slots.push([NONE; 2]);
            self.lists.push();
            self.slots.len() as u32 - 1
        });
        self.attach(id, constraint, multiplier);
        ConstraintId(id)
    }

    pub(crate) fn remove(&mut self, id: ConstraintId) -> Constraint {
        let (constraint, _) = self.detach(id);
        self.slots[id.index()] = [NONE; 2];
        self.free.push(id.0);
        constraint
    }

    /// Gives the end `from` of a constraint, if it has it, to another particle. The constraint keeps its
    /// colour if that is free there.
    pub(crate) fn repoint(&mut self, id: ConstraintId, from: usize, to: usize) {
        if self.get(id).ends.contains(&from) {
            let (mut constraint, multiplier) = self.detach(id);
            let moved = |end| if end == from { to } else { end };
            constraint.ends = constraint.ends.map(moved);
            self.attach(id.0, constraint, multiplier);
        }
    }

    pub(crate) fn set_stiffness(&mut self, id: ConstraintId, stiffness_n_per_m: f64) {
        let (colour, i) = self.slot(id);
        let colour = &mut self.colours[colour];
        colour.stiffness[i] = stiffness_n_per_m;
        colour.compliance[i] = 1.0 / stiffness_n_per_m;
        let (rest_length_m, ends) = (colour.rest[i], colour.ends[i]);
        self.note(rest_length_m, stiffness_n_per_m);
        for end in ends {
            self.lists.changed.mark(end as usize);
        }
    }

    /// Changes the stiffness of a constraint, and the force that it remembers in proportion.
    pub(crate) fn stiffen(&mut self, id: ConstraintId, stiffness_n_per_m: f64) {
        let (colour, i) = self.slot(id);
        let colour = &mut self.colours[colour];
        colour.multipliers[i] *= stiffness_n_per_m / colour.stiffness[i];
        self.set_stiffness(id, stiffness_n_per_m);
    }

    pub(crate) fn set_rest_length(&mut self, id: ConstraintId, rest_length_m: f64) {
        let (colour, i) = self.slot(id);
        let colour = &mut self.colours[colour];
        colour.rest[i] = rest_length_m;
        let (stiffness_n_per_m, ends) = (colour.stiffness[i], colour.ends[i]);
        self.note(rest_length_m, stiffness_n_per_m);
        for end in ends {
            self.lists.changed.mark(end as usize);
        }
    }

    pub(crate) fn damping(&self, id: ConstraintId) -> f64 {
        let (colour, i) = self.slot(id);
        self.colours[colour].damping[i]
    }

    /// Computes the damping of the constraints of a particle by the present masses.
    pub(crate) fn damp(&mut self, particle: usize, time_s: f64, inverse_masses: &[f64]) {
        for (id, _) in self.lists.of(particle) {
            let [colour, i] = self.slots[id].map(|index| index as usize);
            let colour = &mut self.colours[colour];
            let [a, b] = colour.ends[i].map(|end| inverse_masses[end as usize]);
            colour.damping[i] = damping::coefficient(time_s, colour.stiffness[i], a + b);
        }
    }

    /// The particles whose constraints changed since they were taken over.
    pub(crate) fn changed(&mut self) -> &mut Dirty {
        &mut self.lists.changed
    }

    /// The place of a constraint among those of its particles in every sweep: no two of one particle share it.
    pub(crate) fn colour(&self, id: ConstraintId) -> usize {
        self.slot(id).0
    }

    /// The share of those that are damped by less than their stiffness times `time_s`, of all that are damped.
    pub(crate) fn damping_capped(&self, time_s: f64) -> f64 {
        let colours = self.colours.iter();
        let springs = colours.flat_map(|colour| colour.stiffness.iter().zip(&colour.damping));
        let damped = springs.filter(|(_, damping)| **damping > 0.0);
        let capped = damped.clone().filter(|(k, c)| **c < time_s * **k);
        capped.count() as f64 / damped.count().max(1) as f64
    }

    pub(crate) fn push_particle(&mut self) {
        self.lists.push_particle();
    }

    /// Forgets a particle without constraints; the last one takes its index.
    pub(crate) fn swap_remove_particle(&mut self, particle: usize) {
        for (id, side) in self.lists.of(self.lists.last_particle()) {
            let [colour, i] = self.slots[id];
            self.colours[colour as usize].ends[i as usize][side] = particle as u32;
        }
        self.lists.swap_remove_particle(particle);
    }

    /// Takes note of a constraint for [`most`](Constraints::most).
    fn note(&mut self, rest_length_m: f64, stiffness_n_per_m: f64) {
        let [longest_m, strongest_n] = &mut self.most;
        *longest_m = longest_m.max(rest_length_m);
        *strongest_n = strongest_n.max(rest_length_m * stiffness_n_per_m);
    }

    fn slot(&self, id: ConstraintId) -> (usize, usize) {
        let [colour, i] = self.slots[id.index()];
        assert_ne!(colour, NONE, "{id:?} is a constraint");
        (colour as usize, i as usize)
    }

    /// The first colour that is free at both ends.
    fn free_colour(&mut self, ends: [usize; 2]) -> usize {
        let mut taken = std::mem::take(&mut self.taken);
        taken.clear();
        taken.resize(self.colours.len() + 1, false);
        for id in ends.into_iter().flat_map(|end| self.of(end)) {
            taken[self.slot(id).0] = true;
        }
        let free = taken.iter().position(|&taken| !taken);
        self.taken = taken;
        free.expect("one colour more than there are is free")
    }

    fn attach(&mut self, id: u32, constraint: Constraint, multiplier: f64) {
        let chosen = self.free_colour(constraint.ends);
        if chosen == self.colours.len() {
            self.colours.push(Colour::default());
        }
        self.note(constraint.rest_length_m, constraint.stiffness_n_per_m);
        let colour = &mut self.colours[chosen];
        self.slots[id as usize] = [chosen as u32, colour.ids.len() as u32];
        colour.push(id, constraint, multiplier);
        for (side, end) in constraint.ends.into_iter().enumerate() {
            self.lists.attach(id as usize, side, end);
        }
    }

    fn detach(&mut self, id: ConstraintId) -> (Constraint, f64) {
        let constraint = self.get(id);
        for (side, end) in constraint.ends.into_iter().enumerate() {
            self.lists.detach(id.index(), side, end);
        }
        let (colour, i) = self.slot(id);
        let colour = &mut self.colours[colour];
        let multiplier = colour.swap_remove(i);
        if let Some(&moved) = colour.ids.get(i) {
            self.slots[moved as usize][1] = i as u32;
        }
        (constraint, multiplier)
    }
}

/// Some springs of one colour, by columns.
#[derive(Clone, Copy)]
pub(crate) struct Springs<'a, const N: usize> {
    pub(crate) ends: &'a [[u32; 2]; N],
    pub(crate) rest: &'a [f64; N],
    pub(crate) stiffness: &'a [f64; N],
    pub(crate) damping: &'a [f64; N],
}

impl<'a, const N: usize> Springs<'a, N> {
    /// One by one.
    pub(crate) fn each(self) -> impl Iterator<Item = Springs<'a, 1>> {
        (0..N).map(move |i| Springs {
            ends: from_ref(&self.ends[i]),
            rest: from_ref(&self.rest[i]),
            stiffness: from_ref(&self.stiffness[i]),
            damping: from_ref(&self.damping[i]),
        })
    }
}

impl Colour {
    /// The springs, so many at a time, and the last ones one by one.
    pub(crate) fn groups<const N: usize>(
        &self,
    ) -> (
        impl Iterator<Item = Springs<'_, N>>,
        impl Iterator<Item = Springs<'_, 1>>,
    ) {
        let (ends, last_ends) = self.ends.as_chunks::<N>();
        let (rest, last_rest) = self.rest.as_chunks::<N>();
        let (stiffness, last_stiffness) = self.stiffness.as_chunks::<N>();
        let (damping, last_damping) = self.damping.as_chunks::<N>();
        (
            springs(ends, rest, stiffness, damping),
            springs(
                ones(last_ends),
                ones(last_rest),
                ones(last_stiffness),
                ones(last_damping),
            ),
        )
    }

    /// The ends, the rest length and the stiffness of each constraint.
    pub(crate) fn springs(&self) -> impl Iterator<Item = ([usize; 2], f64, f64)> + '_ {
        let numbers = self.rest.iter().zip(&self.stiffness);
        let springs = self.ends.iter().zip(numbers);
        springs.map(|(&[a, b], (&rest, &stiffness))| ([a as usize, b as usize], rest, stiffness))
    }

    fn reserve(&mut self, count: usize) {
        room_for(&mut self.ids, count);
        room_for(&mut self.ends, count);
        room_for(&mut self.rest, count);
        room_for(&mut self.stiffness, count);
        room_for(&mut self.compliance, count);
        room_for(&mut self.damping, count);
        room_for(&mut self.multipliers, count);
    }

    fn push(&mut self, id: u32, constraint: Constraint, multiplier: f64) {
        self.ids.push(id);
        self.ends.push(constraint.ends.map(|end| end as u32));
        self.rest.push(constraint.rest_length_m);
        self.stiffness.push(constraint.stiffness_n_per_m);
        self.compliance.push(1.0 / constraint.stiffness_n_per_m);
        self.damping.push(0.0);
        self.multipliers.push(multiplier);
    }

    /// Takes a constraint out, and returns its multiplier; the last one takes its place.
    fn swap_remove(&mut self, i: usize) -> f64 {
        self.ids.swap_remove(i);
        self.ends.swap_remove(i);
        self.rest.swap_remove(i);
        self.stiffness.swap_remove(i);
        self.compliance.swap_remove(i);
        self.damping.swap_remove(i);
        self.multipliers.swap_remove(i)
    }
}

/// Columns, one by one.
fn ones<T>(column: &[T]) -> &[[T; 1]] {
    column.as_chunks().0
}

fn springs<'a, const N: usize>(
    ends: &'a [[[u32; 2]; N]],
    rest: &'a [[f64; N]],
    stiffness: &'a [[f64; N]],
    damping: &'a [[f64; N]],
) -> impl Iterator<Item = Springs<'a, N>> {
    let numbers = rest.iter().zip(stiffness).zip(damping);
    let springs = ends.iter().zip(numbers);
    springs.map(|(ends, ((rest, stiffness), damping))| Springs {
        ends,
        rest,
        stiffness,
        damping,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spring(a: usize, b: usize) -> Constraint {
        Constraint {
            ends: [a, b],
            rest_length_m: (a + 10 * b) as f64,
            stiffness_n_per_m: (3 + a) as f64,
        }
    }

    /// No colour has a particle twice, each compliance is that of its stiffness, and the lists of
    /// particles hold their constraints.
    fn check(constraints: &Constraints, expected: &[(ConstraintId, [usize; 2])]) {
        assert_eq!(constraints.len(), expected.len());
        for &(id, ends) in expected {
            assert_eq!(constraints.get(id).ends, ends);
            for end in ends {
                assert!(constraints.of(end).any(|of| of == id), "{id:?} at {end}");
                let same = |&of: &ConstraintId| constraints.slot(of).0 == constraints.slot(id).0;
                assert_eq!(
                    constraints.of(end).filter(same).count(),
                    1,
                    "{id:?} at {end}"
                );
            }
        }
        let listed: usize = (0..=constraints.lists.last_particle())
            .map(|particle| constraints.of(particle).count())
            .sum();
        assert_eq!(listed, 2 * expected.len());
        assert_eq!(constraints.iter().count(), expected.len());
        for colour in &constraints.colours {
            let inverse = colour.stiffness.iter().map(|k| 1.0 / k);
            assert_eq!(colour.compliance, inverse.collect::<Vec<_>>());
        }
    }

    #[test]
    fn constraints_come_and_go_and_colours_stay_right() {
        let mut constraints = Constraints::default();
        (0..6).for_each(|_| constraints.push_particle());
        let mut expected = Vec::new();
        for a in 0..6 {
            for b in a + 1..6 {
                expected.push((constraints.add(spring(a, b)), [a, b]));
                check(&constraints, &expected);
            }
        }
        assert!(constraints.colours.len() <= 9);
        for (id, [a, b]) in &expected {
            constraints.set_stiffness(*id, (7 + a * b) as f64);
        }
        check(&constraints, &expected);
        // Every third goes, and comes back with another end.
        for i in (0..expected.len()).rev().step_by(3) {
            let (id, ends) = expected.swap_remove(i);
            assert_eq!(constraints.remove(id).ends, ends);
            check(&constraints, &expected);
        }
        constraints.push_particle();
        for (id, ends) in &mut expected {
            if ends[0] == 0 {
                constraints.repoint(*id, 0, 6);
                ends[0] = 6;
            }
        }
        check(&constraints, &expected);
        for id in constraints.of(0).collect::<Vec<_>>() {
            constraints.remove(id);
            expected.retain(|(other, _)| *other != id);
        }
        constraints.changed().clear();
        constraints.swap_remove_particle(0);
        assert_eq!(constraints.changed().list(), [0]);
        for end in expected.iter_mut().flat_map(|(_, ends)| ends) {
            *end %= 6;
        }
        check(&constraints, &expected);
    }
}

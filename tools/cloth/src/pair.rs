//! Constraints between two particles that act along the line between them: sums over all of one
//! law, whatever that is.

use tearmesh::geometry::{Point, Vector, dot};

use crate::blow_up::{BlowUpSite, Longest};
use crate::constraint::{Batch, Constraint, Constraints};
use crate::crush::Crush;
use crate::element::Element;
use crate::matrix::{Block, Hessian};

/// A law by which constraints act, all of them alike but for their rest length and stiffness.
pub(crate) trait Law: Copy {
    /// One of them.
    type Link: Link;

    /// The constraint of this rest length in metres and this stiffness in newtons per metre. `None`
    /// where it does nothing, and its length does not matter.
    fn link(self, rest_length_m: f64, stiffness_n_per_m: f64) -> Option<Self::Link>;

    /// The largest stiffness at any length, by that number.
    fn stiffest(self) -> f64;
}

/// What acts between two particles, by how far they are apart.
pub(crate) trait Link: Copy {
    /// Twice the energy, in joules: a sum is halved once.
    fn twice_energy(self, length: f64) -> f64;

    /// The pull, in newtons: the derivative of the energy. Negative where it pushes apart.
    fn force(self, length: f64) -> f64;

    /// The stiffness that is damped where it is crushed; zero where being short is being bent.
    fn damped_stiffness(self) -> f64;

    /// The derivative of that along the line, and that of the force across it for a turn, force
    /// over length, in newtons per metre.
    fn stiffness(self, length: f64) -> [f64; 2];
}

/// All constraints of one law.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pairs<'a, L> {
    constraints: &'a Constraints,
    law: L,
    /// What a blow-up calls one of these.
    site: fn([usize; 2], f64) -> BlowUpSite,
}

impl<'a, L: Law> Pairs<'a, L> {
    pub(crate) fn new(
        constraints: &'a Constraints,
        law: L,
        site: fn([usize; 2], f64) -> BlowUpSite,
    ) -> Pairs<'a, L> {
        Pairs {
            constraints,
            law,
            site,
        }
    }

    fn link(&self, constraint: &Constraint) -> Option<L::Link> {
        let (rest, stiffness) = (constraint.rest_length_m, constraint.stiffness_n_per_m);
        self.law.link(rest, stiffness)
    }
}

/// The links of a colour: their ends, rest lengths, and what acts.
fn links<L: Law>(batch: Batch<'_>, law: L) -> impl Iterator<Item = ([usize; 2], f64, L::Link)> {
    let numbers = batch.rest.iter().zip(batch.stiffness);
    let constraints = batch.ends.iter().zip(numbers);
    constraints.filter_map(move |(&[a, b], (&rest, &stiffness))| {
        let link = law.link(rest, stiffness)?;
        Some(([a as usize, b as usize], rest, link))
    })
}

/// The length of a constraint, in metres.
pub(crate) fn length(x: &[Point], [a, b]: [usize; 2]) -> f64 {
    let d = x[b] - x[a];
    dot(d, d).sqrt()
}

impl<L: Law> Element for Pairs<'_, L> {
    fn len(&self) -> usize {
        self.constraints.len()
    }

    fn energy(&self, x: &[Point], sum: f64) -> f64 {
        self.constraints.batches().fold(sum, |sum, batch| {
            let links = links(batch, self.law);
            let twice = links.map(|(ends, _, link)| link.twice_energy(length(x, ends)));
            sum + 0.5 * twice.fold(0.0, |sum, twice_j| sum + twice_j)
        })
    }

    fn energy_at(&self, x: &[Point], particle: usize) -> f64 {
        let constraints = self.constraints.of(particle);
        let constraints = constraints.map(|id| self.constraints.get(id));
        let energy = |constraint: Constraint| {
            let link = self.link(&constraint)?;
            Some(0.5 * link.twice_energy(length(x, constraint.ends)))
        };
        constraints.filter_map(energy).sum()
    }

    fn forces(
        &self,
        x: &[Point],
        ratio_max: f64,
        crush: Option<Crush<'_>>,
        forces: &mut [Vector],
    ) -> bool {
        let mut sane = true;
        for batch in self.constraints.batches() {
            for ([a, b], rest, link) in links(batch, self.law) {
                let d = x[b] - x[a];
                let length = dot(d, d).sqrt();
                sane &= length <= ratio_max * rest;
                let mut pull = link.force(length);
                if length > 0.0 {
                    if let Some(crush) = crush
                        && length < Crush::BELOW * rest
                    {
                        let speed = dot(d, crush.velocities[b] - crush.velocities[a]) / length;
                        pull += crush.pull(link.damped_stiffness(), length / rest, speed);
                    }
                    let force = d * (pull / length);
                    forces[a] += force;
                    forces[b] -= force;
                }
            }
        }
        sane
    }

    fn force_at(
        &self,
        x: &[Point],
        particle: usize,
        exerted: &dyn Fn([usize; 2], f64, f64) -> f64,
        sum: &mut Vector,
    ) {
        for id in self.constraints.of(particle) {
            let constraint = self.constraints.get(id);
            let [a, b] = constraint.ends;
            let d = x[a + b - particle] - x[particle];
            let length = dot(d, d).sqrt();
            if length > 0.0 {
                let link = self.link(&constraint);
                let by_length = link.map_or(0.0, |link| link.force(length));
                let multiplier = self.constraints.memory(id).multiplier;
                *sum += d * (exerted([a, b], by_length, multiplier) / length);
            }
        }
    }

    fn is_within(&self, x: &[Point], ratio_max: f64) -> bool {
        let mut batches = self.constraints.batches();
        batches.all(|batch| {
            links(batch, self.law).all(|(ends, rest, _)| length(x, ends) <= ratio_max * rest)
        })
    }

    fn find_longest(&self, x: &[Point], longest: &mut Longest) {
        for batch in self.constraints.batches() {
            for (ends, rest, _) in links(batch, self.law) {
                let ratio = length(x, ends) / rest;
                longest.weigh(ratio, || (self.site)(ends, ratio));
            }
        }
    }

    fn each_spring(&self, _reach: f64, visit: &mut dyn FnMut([usize; 2], f64)) {
        for batch in self.constraints.batches() {
            for (&[a, b], &k) in batch.ends.iter().zip(batch.stiffness) {
                if k > 0.0 {
                    visit([a as usize, b as usize], k * self.law.stiffest());
                }
            }
        }
    }

    fn springs_at(&self, particle: usize, _reach: f64, visit: &mut dyn FnMut(usize, f64)) {
        for id in self.constraints.of(particle) {
            let constraint = self.constraints.get(id);
            let [a, b] = constraint.ends;
            if constraint.stiffness_n_per_m > 0.0 {
                let stiffness = constraint.stiffness_n_per_m * self.law.stiffest();
                visit(a + b - particle, stiffness);
            }
        }
    }

    fn each_pair(&self, visit: &mut dyn FnMut(usize, [u32; 2])) {
        for batch in self.constraints.batches() {
            for (&id, &ends) in batch.ids.iter().zip(batch.ends) {
                visit(id as usize, ends);
            }
        }
    }

    fn hessian(&self, x: &[Point], clamp: bool, slots: &[u32], hessian: &mut Hessian) -> u64 {
        let mut clamped = 0;
        for batch in self.constraints.batches() {
            let numbers = batch.rest.iter().zip(batch.stiffness);
            let constraints = batch.ids.iter().zip(batch.ends).zip(numbers);
            for ((&id, &ends), (&rest, &stiffness)) in constraints {
                // Edges of a cloth of triangles alone are measured, and pull at nothing.
                let link = self.law.link(rest, stiffness).filter(|_| stiffness > 0.0);
                if let Some(link) = link {
                    let [p, q] = ends.map(|end| x[end as usize]);
                    let (block, dropped) = block(link, q - p, clamp);
                    clamped += u64::from(dropped);
                    hessian.add_pair(slots[id as usize], ends, &block);
                }
            }
        }
        clamped
    }
}

/// The second derivative of a link's energy by the position of either end (by both it is the
/// negative), and whether a part of it was dropped that is indefinite:
///
/// ```text
/// H = E″ t tᵀ + E′/l (I − t tᵀ),   t the direction, l the length
/// ```
///
/// Under compression the second term is negative; Choi and Ko 2002 §4 drop it there. Where both
/// ends are one point the derivative does not exist, and E″ I is given for it.
fn block(link: impl Link, d: Vector, clamp: bool) -> (Block, bool) {
    let length = dot(d, d).sqrt();
    let [along, across] = link.stiffness(length);
    if length == 0.0 {
        return (Block::identity_times(along), false);
    }
    let direction = d / length;
    let clamped = clamp && across < 0.0;
    let across = if clamped { 0.0 } else { across };
    let line = Block::outer(direction, direction);
    let block = Block::identity_times(across).plus(along - across, &line);
    (block, clamped)
}

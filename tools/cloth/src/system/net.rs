//! The net of springs of a step, and its fastest mode.
//!
//! The largest eigenvalue λ of M′⁻¹ L, with L the scalar matrix of the springs, is that of the worst of all
//! configurations. Power iteration finds it from below, by some products with all springs.
//!
//! After an edit the net near it is measured alone, with all beyond held ([`Part::near`]). A mode that is new, and faster
//! than all before, is there, and dies away with every ring of neighbours; the others are hardly faster than they were
//! ([`Net::unless_faster`]). So a step after splits costs at most 1.5 of one without, where products with all springs
//! would make it 3.

use crate::system::counters::Counters;
use crate::system::incidence::{Dirty, room_for};
use crate::system::mass_scaling::MassScaling;
use crate::system::model::Model;

/// The most matrix–vector products, and the relative change at which an iteration stops.
const PRODUCTS: u32 = 100;
const SETTLED: f64 = 1e-3;

/// How many rings of neighbours around an edit are measured with it.
const RINGS: u32 = 1;

/// By how much what is found near an edit, and what was found before, may be too low. (Of 34 000 edits of sheets that tear
/// everywhere 13 made the largest eigenvalue larger than both of these, and the worst by 9 %.)
const NEAR_TOO_LOW: f64 = 1.1;
const BEFORE_TOO_LOW: f64 = 1.005;

/// No place in a part.
const NOWHERE: u32 = u32::MAX;

/// Springs between particles, and room for power iteration. (Without a list of the springs a measurement of five
/// products would be 1.2 times as long.)
#[derive(Clone, Debug, Default)]
pub(crate) struct Net {
    springs: Vec<([u32; 2], f64)>,
    /// What was found last.
    vector: Vec<f64>,
    product: Vec<f64>,
}

/// Room for the net near an edit: its particles by their places, and the places by particle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Part {
    net: Net,
    carry: MassScaling,
    places: Vec<u32>,
}

/// What the stiffness of springs follows from: how far triangles may be stretched, and the stiffness that a damper counts
/// as.
pub(crate) type Stiffness = (f64, f64);

impl Net {
    /// Makes room for so many particles, and springs between them.
    pub(crate) fn reserve(&mut self, particles: usize, springs: usize) {
        room_for(&mut self.vector, particles);
        room_for(&mut self.product, particles);
        room_for(&mut self.springs, springs);
    }

    /// The largest eigenvalue of M′⁻¹ L, from below, of all springs of a model. Begins with what was found last.
    pub(crate) fn whole(
        &mut self,
        model: &Model,
        (reach, damper): Stiffness,
        carry: &MassScaling,
        counters: &mut Counters,
    ) -> f64 {
        self.springs.clear();
        model.each_spring(reach, |ends, [k, c]| {
            let ends = ends.map(|end| end as u32);
            self.springs.push((ends, k + damper * c));
        });
        if self.vector.len() != model.masses.len() {
            self.begin(model.masses.len());
        }
        self.largest(carry, &mut counters.matrix_products)
    }

    /// A bound of the largest eigenvalue after an edit, by that before and that near it.
    pub(crate) fn unless_faster(before: f64, near: f64) -> f64 {
        (BEFORE_TOO_LOW * before).max(NEAR_TOO_LOW * near)
    }

    /// Takes signs that alternate as the fastest modes do.
    fn begin(&mut self, count: usize) {
        let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let start = (0..count).map(|i| sign(i) + 0.1 * ((i % 7) as f64));
        self.vector.clear();
        self.vector.extend(start);
    }

    fn largest(&mut self, carry: &MassScaling, products: &mut u64) -> f64 {
        let mut largest = 0.0;
        for _ in 0..PRODUCTS {
            *products += 1;
            let (u, product) = (&mut self.vector, &mut self.product);
            for (u, inverse) in u.iter_mut().zip(carry.inverses()) {
                *u = if *inverse > 0.0 { *u } else { 0.0 };
            }
            product.clear();
            product.resize(u.len(), 0.0);
            let (from, to) = (&u[..], &mut product[..]);
            for &([a, b], stiffness) in &self.springs {
                let [a, b] = [a as usize, b as usize];
                let force = stiffness * (from[a] - from[b]);
                to[a] += force;
                to[b] -= force;
            }
            let energy = inner(u, product);
            std::mem::swap(u, product);
            // What was the product is made an acceleration, and its own product is needed with it.
            product.clone_from(u);
            carry.accelerate(u);
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

impl Part {
    /// Makes room for so many particles in all.
    pub(crate) fn reserve(&mut self, particles: usize) {
        room_for(&mut self.places, particles);
    }

    /// The largest eigenvalue of the net near these particles, to which their neighbours are added: with
    /// all beyond held, and what carries those beyond left out.
    pub(crate) fn near(
        &mut self,
        particles: &mut Dirty,
        model: &Model,
        (reach, damper): Stiffness,
        carry: &MassScaling,
    ) -> f64 {
        let mut reached = 0;
        for _ in 0..RINGS {
            let from = std::mem::replace(&mut reached, particles.list().len());
            for i in from..reached {
                let particle = particles.list()[i] as usize;
                model.springs_at(particle, reach, |_, other, _| particles.mark(other));
            }
        }
        let list = particles.list();
        self.places.resize(model.masses.len(), NOWHERE);
        for (place, particle) in list.iter().enumerate() {
            self.places[*particle as usize] = place as u32;
        }
        let beyond = list.len() as u32;
        let (springs, places) = (&mut self.net.springs, &self.places);
        springs.clear();
        for (place, particle) in list.iter().enumerate() {
            let place = place as u32;
            model.springs_at(*particle as usize, reach, |_, other, [k, c]| {
                let other = places[other].min(beyond);
                // Once, by the end that comes first.
                if other > place {
                    springs.push(([place, other], k + damper * c));
                }
            });
        }
        self.carry.take_part(carry, list, |particle| {
            let place = self.places[particle as usize];
            (place != NOWHERE).then_some(place)
        });
        for particle in list {
            self.places[*particle as usize] = NOWHERE;
        }
        self.net.begin(list.len() + 1);
        self.net.largest(&self.carry, &mut 0)
    }
}

fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

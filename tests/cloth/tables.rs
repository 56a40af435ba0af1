//! Every method against every reference answer, its order, and where it blows up: each cell asserted.

mod blow_up;
mod references;
mod theory;

use tearmesh::{Point, Vector};
use tearmesh_cloth::System;

use crate::parts::nets::row;
use crate::parts::woven::strip;

/// The methods of the tables: all but the limiter, which works against what is stretched.
const METHODS: &[&str] = crate::parts::METHODS.split_at(8).0;

/// What a row of springs is made of: springs, or strips of two triangles a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Links {
    Springs,
    Triangles,
}

impl Links {
    /// How many particles stand for one of the chain.
    fn columns(self) -> usize {
        match self {
            Links::Springs => 1,
            Links::Triangles => 2,
        }
    }

    /// Links in a row, the particles of the first held.
    fn row(self, links: usize, mass: f64, stiffness: f64, rest: f64, apart: Vector) -> System {
        match self {
            Links::Springs => row(links, mass, stiffness, rest, apart),
            Links::Triangles => strip(links, mass, stiffness, rest, apart),
        }
    }

    /// The particles that stand for one of the chain.
    fn at(self, i: usize) -> std::ops::Range<usize> {
        self.columns() * i..self.columns() * (i + 1)
    }

    fn hold(self, system: &mut System, i: usize) {
        self.at(i).for_each(|particle| system.hold(particle));
    }

    /// Changes the place and velocity of a particle of the chain.
    fn change(self, system: &mut System, i: usize, to: impl Fn(&mut Point, &mut Vector)) {
        let (points, velocities) = system.state_mut();
        self.at(i)
            .for_each(|particle| to(&mut points[particle], &mut velocities[particle]));
    }

    fn point(self, system: &System, i: usize) -> Point {
        system.positions()[self.columns() * i]
    }
}

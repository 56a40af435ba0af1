//! Every method against every reference answer, its order, and where it blows up: each cell asserted,
//! and all of it printed as tables by
//!
//! ```text
//! cargo test --test main -- --nocapture --test-threads 1 table_of
//! ```

mod blow_up;
mod numbers;
mod orders;
mod references;
mod theory;

use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{Pbd, Provot, Solver, System, Verlet, Xpbd};

use crate::parts::implicit;
use crate::parts::nets::row;
use crate::parts::woven::strip;
use crate::plain_verlet::PlainVerlet;
use crate::rk4::Rk4;

/// The methods, in the order of the tables' columns.
pub(crate) const METHODS: [&str; 8] = [
    "guarded", "Provot", "Verlet", "RK4", "Euler", "BDF2", "XPBD", "PBD",
];

/// A method by its name: Verlet with its guards and without, the limiter off, sweeps for those that
/// sweep, equations solved to rounding for those that are implicit.
pub(crate) fn method(name: &str, sweeps: u32) -> Box<dyn Solver> {
    match name {
        "guarded" => Box::new(Verlet::new()),
        "Provot" => Box::new(Provot::unlimited()),
        "Verlet" => Box::new(PlainVerlet::new()),
        "RK4" => Box::new(Rk4::new()),
        "Euler" => Box::new(implicit(Method::BackwardEuler)),
        "BDF2" => Box::new(implicit(Method::Bdf2)),
        "XPBD" => Box::new(Xpbd::new(1, sweeps)),
        "PBD" => Box::new(Pbd::new(sweeps)),
        other => panic!("no method is called {other}"),
    }
}

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

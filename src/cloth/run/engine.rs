//! The methods of scenes, behind one solver.

use crate::cloth::scene::Method;
use crate::cloth::{Failure, ImplicitCloth, Pbd, Provot, Solver, System, Verlet, Xpbd};

/// A method with its state.
#[derive(Clone, Debug)]
pub(super) enum Engine {
    /// The tearing rule sees lengths as they were before the limiter.
    Provot(Provot),
    Pbd(Pbd),
    Verlet(Verlet),
    Xpbd(Xpbd),
    Implicit(Box<ImplicitCloth>),
}

impl Engine {
    pub(super) fn new(method: &Method) -> Engine {
        match *method {
            Method::Provot(limiter) => Engine::Provot(Provot::new(limiter)),
            Method::Pbd(pbd) => Engine::Pbd(pbd),
            Method::Verlet => Engine::Verlet(Verlet::new()),
            Method::Xpbd(xpbd) => Engine::Xpbd(xpbd),
            Method::Implicit(settings) => Engine::Implicit(Box::new(ImplicitCloth::new(settings))),
        }
    }
}

impl Solver for Engine {
    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        match self {
            Engine::Provot(provot) => provot.advance(system, dt_s),
            Engine::Pbd(pbd) => pbd.advance(system, dt_s),
            Engine::Verlet(verlet) => verlet.advance(system, dt_s),
            Engine::Xpbd(xpbd) => xpbd.advance(system, dt_s),
            Engine::Implicit(implicit) => implicit.advance(system, dt_s),
        }
    }

    fn takes_triangles(&self) -> bool {
        match self {
            Engine::Provot(provot) => provot.takes_triangles(),
            Engine::Verlet(verlet) => verlet.takes_triangles(),
            Engine::Implicit(implicit) => implicit.takes_triangles(),
            Engine::Pbd(_) | Engine::Xpbd(_) => false,
        }
    }

    fn takes_buckling(&self) -> bool {
        match self {
            Engine::Provot(provot) => provot.takes_buckling(),
            Engine::Verlet(verlet) => verlet.takes_buckling(),
            Engine::Implicit(implicit) => implicit.takes_buckling(),
            Engine::Pbd(_) | Engine::Xpbd(_) => false,
        }
    }

    fn frequency_limit(&self) -> Option<f64> {
        match self {
            Engine::Provot(provot) => provot.frequency_limit(),
            Engine::Verlet(verlet) => verlet.frequency_limit(),
            Engine::Pbd(_) | Engine::Xpbd(_) | Engine::Implicit(_) => None,
        }
    }
}

//! The methods of scenes, behind one solver.

use super::quality::{ImplicitStats, LimiterStats, Quality};
use crate::scene::Method;
use crate::stability::carried_count;
use crate::{
    Abilities, Failure, Implicit, Pbd, Provot, SettingError, Solver, System, Verlet, Xpbd,
};

/// A method with its state.
#[derive(Clone, Debug)]
pub(super) enum Engine {
    /// The tearing rule sees lengths as they were before the limiter.
    Provot(Provot, LimiterStats),
    Pbd(Pbd),
    Verlet(Verlet),
    Xpbd(Xpbd),
    Implicit(Box<Implicit>, ImplicitStats),
}

impl Engine {
    pub(super) fn new(method: &Method) -> Engine {
        match *method {
            Method::Provot(limiter) => {
                Engine::Provot(Provot::new(limiter), LimiterStats::default())
            }
            Method::Pbd(pbd) => Engine::Pbd(pbd),
            Method::Verlet => Engine::Verlet(Verlet::new()),
            Method::Xpbd(xpbd) => Engine::Xpbd(xpbd),
            Method::Implicit(settings) => {
                Engine::Implicit(Box::new(Implicit::new(settings)), ImplicitStats::default())
            }
        }
    }

    fn solver(&self) -> &dyn Solver {
        match self {
            Engine::Provot(provot, _) => provot,
            Engine::Pbd(pbd) => pbd,
            Engine::Verlet(verlet) => verlet,
            Engine::Xpbd(xpbd) => xpbd,
            Engine::Implicit(implicit, _) => &**implicit,
        }
    }

    pub(super) fn quality(&self, system: &System) -> Quality {
        match self {
            Engine::Provot(_, limited) => Quality::Limiter(*limited),
            Engine::Pbd(_) => Quality::Strain(system.strain_rms()),
            Engine::Verlet(_) => Quality::Carried(carried_count(system)),
            Engine::Xpbd(xpbd) => Quality::Residual(xpbd.residual_n(system)),
            Engine::Implicit(_, solved) => Quality::Implicit(*solved),
        }
    }
}

impl Solver for Engine {
    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        match self {
            Engine::Provot(provot, limited) => {
                provot.advance(system, dt_s)?;
                limited.note(&provot.report());
                Ok(())
            }
            Engine::Pbd(pbd) => pbd.advance(system, dt_s),
            Engine::Verlet(verlet) => verlet.advance(system, dt_s),
            Engine::Xpbd(xpbd) => xpbd.advance(system, dt_s),
            Engine::Implicit(implicit, solved) => {
                implicit.advance(system, dt_s)?;
                implicit
                    .report()
                    .iter()
                    .for_each(|report| solved.note(report));
                Ok(())
            }
        }
    }

    fn abilities(&self) -> Abilities {
        self.solver().abilities()
    }

    fn check(&self) -> Result<(), SettingError> {
        self.solver().check()
    }
}

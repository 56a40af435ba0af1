//! The methods, their settings, and the budget of steps that each gets.

use tearmesh_cloth::implicit::{self, Settings, Tolerance};
use tearmesh_cloth::scene::{self, suggested_step_s};
use tearmesh_cloth::{
    Implicit, Limiter, Pbd, Provot, Solver, System, Verlet, Xpbd, stable_step_s, suited_step_s,
};

use super::scene::Case;
use crate::rk4::Rk4;

/// A method with its settings: a series of the chart.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// As it stands in names of runs.
    pub name: &'static str,
    /// The method whatever its settings.
    pub family: Family,
    kind: Kind,
}

/// What is drawn as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// [`Verlet::new`].
    Verlet,
    /// [`Verlet::plain`].
    Plain,
    /// [`Rk4`].
    Rk4,
    /// [`Provot::unlimited`]: symplectic Euler.
    Euler,
    /// [`Provot`] with its limiter at 10 %.
    Provot,
    /// [`Pbd`].
    Pbd,
    /// [`Xpbd`].
    Xpbd,
    /// [`Implicit`] by backward Euler, linearised.
    BackwardEuler,
    /// [`Implicit`] by BDF2, linearised.
    Bdf2,
}

impl Family {
    /// All, in the order of legends.
    pub const ALL: [Family; 9] = [
        Family::Verlet,
        Family::Plain,
        Family::Rk4,
        Family::Euler,
        Family::Provot,
        Family::Pbd,
        Family::Xpbd,
        Family::BackwardEuler,
        Family::Bdf2,
    ];

    /// As it stands in legends.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Family::Verlet => "Verlet",
            Family::Plain => "Verlet, plain",
            Family::Rk4 => "RK4",
            Family::Euler => "symplectic Euler",
            Family::Provot => "Provot",
            Family::Pbd => "PBD",
            Family::Xpbd => "XPBD",
            Family::BackwardEuler => "backward Euler",
            Family::Bdf2 => "BDF2",
        }
    }

    /// Where the method should win, or what it is there for if it should nowhere: said before the
    /// experiment was made.
    #[must_use]
    pub fn claim(self) -> Claim {
        match self {
            Family::Verlet => Claim::Wins("sliver"),
            Family::Plain => Claim::Wins("swing"),
            Family::Rk4 => Claim::Wins("taut"),
            Family::Euler => Claim::Wins("strip"),
            Family::Provot => Claim::Baseline,
            Family::Pbd => Claim::Wins("drape"),
            Family::Xpbd => Claim::Wins("stiff"),
            Family::BackwardEuler => Claim::Wins("drape"),
            Family::Bdf2 => Claim::Wins("sliver"),
        }
    }
}

/// By what the energy in springs is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Store {
    /// By their lengths.
    Lengths,
    /// By the forces of the method: sweeps leave lengths that are none of their forces'.
    Forces,
    /// Springs are rigid, and store nothing.
    Nothing,
}

impl Family {
    pub(super) fn store(self) -> Store {
        match self {
            Family::Pbd => Store::Nothing,
            Family::Xpbd => Store::Forces,
            _ => Store::Lengths,
        }
    }
}

/// What is claimed of a method before the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// It is the cheapest at some tolerance in this scene.
    Wins(&'static str),
    /// Nothing: it is what others are compared with.
    Baseline,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Verlet,
    Plain,
    Rk4,
    Euler,
    Provot,
    Pbd(u32),
    Xpbd(u32),
    Implicit(implicit::Method, f64),
}

const fn method(name: &'static str, family: Family, kind: Kind) -> Method {
    Method { name, family, kind }
}

const BE: implicit::Method = implicit::Method::BackwardEuler;
const BDF2: implicit::Method = implicit::Method::Bdf2;

/// All methods with all settings.
pub const METHODS: [Method; 19] = [
    method("verlet", Family::Verlet, Kind::Verlet),
    method("verlet-plain", Family::Plain, Kind::Plain),
    method("rk4", Family::Rk4, Kind::Rk4),
    method("euler", Family::Euler, Kind::Euler),
    method("provot", Family::Provot, Kind::Provot),
    method("pbd-1", Family::Pbd, Kind::Pbd(1)),
    method("pbd-2", Family::Pbd, Kind::Pbd(2)),
    method("pbd-4", Family::Pbd, Kind::Pbd(4)),
    method("pbd-10", Family::Pbd, Kind::Pbd(10)),
    method("xpbd-1", Family::Xpbd, Kind::Xpbd(1)),
    method("xpbd-2", Family::Xpbd, Kind::Xpbd(2)),
    method("xpbd-4", Family::Xpbd, Kind::Xpbd(4)),
    method("xpbd-10", Family::Xpbd, Kind::Xpbd(10)),
    method(
        "euler-back-10",
        Family::BackwardEuler,
        Kind::Implicit(BE, 10.0),
    ),
    method(
        "euler-back-100",
        Family::BackwardEuler,
        Kind::Implicit(BE, 100.0),
    ),
    method(
        "euler-back-1000",
        Family::BackwardEuler,
        Kind::Implicit(BE, 1000.0),
    ),
    method("bdf2-10", Family::Bdf2, Kind::Implicit(BDF2, 10.0)),
    method("bdf2-100", Family::Bdf2, Kind::Implicit(BDF2, 100.0)),
    method("bdf2-1000", Family::Bdf2, Kind::Implicit(BDF2, 1000.0)),
];

/// The parts of a method's base step that are tried; the last three are two halvings.
pub const PARTS: [f64; 8] = [2.0, 1.0, 0.7, 0.5, 0.35, 0.25, 0.125, 0.0625];

/// The margin of base steps to what the watch admits, which would otherwise refuse them on the way.
const MARGIN: f64 = 0.95;

impl Method {
    /// A solver that has seen nothing yet.
    #[must_use]
    pub fn solver(&self) -> Box<dyn Solver> {
        match self.kind {
            Kind::Verlet => Box::new(Verlet::new()),
            Kind::Plain => Box::new(Verlet::plain()),
            Kind::Rk4 => Box::new(Rk4::new()),
            Kind::Euler => Box::new(Provot::unlimited()),
            Kind::Provot => Box::new(Provot::new(Limiter::default())),
            Kind::Pbd(sweeps) => Box::new(Pbd::new(sweeps)),
            Kind::Xpbd(sweeps) => Box::new(Xpbd::new(1, sweeps)),
            Kind::Implicit(method, tolerance) => Box::new(Implicit::new(Settings {
                method,
                tolerance: Tolerance::Tied(tolerance),
                ..Settings::default()
            })),
        }
    }

    /// The step that parts are of, in seconds: of explicit methods .95 of what the watch over stability
    /// admits at the start, the time in which a pull travels an edge for those that sweep, and 1/60 s
    /// for implicit ones.
    #[must_use]
    pub fn base_s(&self, case: &Case) -> f64 {
        let mut system = case.system();
        match self.kind {
            // Whole up to twice the step that suits.
            Kind::Verlet => MARGIN * 2.0 * suited_step_s(&mut system),
            Kind::Plain | Kind::Rk4 | Kind::Euler | Kind::Provot => {
                MARGIN * limit_s(&mut system, &*self.solver())
            }
            Kind::Pbd(_) | Kind::Xpbd(_) => case.edge_s(),
            Kind::Implicit(..) => 1.0 / 60.0,
        }
    }
}

/// The longest step in seconds that the watch over stability admits now.
fn limit_s(system: &mut System, solver: &dyn Solver) -> f64 {
    let abilities = solver.abilities();
    let springs_s = abilities
        .frequency_limit
        .map_or(f64::INFINITY, |limit| stable_step_s(system, limit));
    let drag = system.loads().drag_per_s.unwrap_or(0.0);
    match abilities.air_limit {
        Some(limit) if abilities.takes_drag_explicitly => 1.0 / (1.0 / springs_s + drag / limit),
        _ => springs_s,
    }
}

/// The method that a user gets who names it and nothing else; of who names none it is Verlet.
#[derive(Clone, Debug)]
pub struct Named {
    /// As it is typed.
    pub name: &'static str,
    /// As which it is drawn.
    pub family: Family,
    settings: scene::Method,
}

/// The name of the method of scenes that name none.
pub(super) const DEFAULT: &str = "verlet";

impl Named {
    /// All that can be typed.
    #[must_use]
    pub fn all() -> [Named; 5] {
        let named = |name, family, settings| Named {
            name,
            family,
            settings,
        };
        [
            named("verlet", Family::Verlet, scene::Method::Verlet),
            named("xpbd", Family::Xpbd, scene::Method::xpbd()),
            named("implicit", Family::BackwardEuler, scene::Method::implicit()),
            named("pbd", Family::Pbd, scene::Method::pbd()),
            named("provot", Family::Provot, scene::Method::provot()),
        ]
    }

    /// It, with its settings.
    #[must_use]
    pub fn settings(&self) -> scene::Method {
        self.settings.clone()
    }

    /// The step that a scene without one chooses, in seconds.
    #[must_use]
    pub fn step_s(&self, case: &Case) -> f64 {
        suggested_step_s(&self.settings, &mut case.system(), case.speed_m_per_s())
    }

    /// A solver that has seen nothing yet.
    #[must_use]
    pub fn solver(&self) -> Box<dyn Solver> {
        match self.settings {
            scene::Method::Provot(limiter) => Box::new(Provot::new(limiter)),
            scene::Method::Pbd(pbd) => Box::new(pbd),
            scene::Method::Verlet => Box::new(Verlet::new()),
            scene::Method::Xpbd(xpbd) => Box::new(xpbd),
            scene::Method::Implicit(settings) => Box::new(Implicit::new(settings)),
        }
    }
}

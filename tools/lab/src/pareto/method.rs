//! The methods, their settings, and the budget of steps that each gets.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use tearmesh_cloth::implicit::{self, Settings, Tolerance};
use tearmesh_cloth::scene::{self, suggested_step_s};
use tearmesh_cloth::{
    Implicit, Limiter, Pbd, Provot, Solver, System, Verlet, Xpbd, stable_step_s, suited_step_s,
};

use super::scene::Case;
use crate::rk4::Rk4;

/// A method with its settings, which is a series of the chart.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// The name of the series, as part of the names of runs.
    pub name: &'static str,
    /// The family of methods to which it belongs.
    pub family: Family,
    kind: Kind,
}

/// The families of methods, which ignore settings. The chart draws each in one colour. In JSON a family is
/// its [name](Family::name).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// The family of [`Verlet::new`].
    Verlet,
    /// The family of [`Verlet::plain`].
    Plain,
    /// The family of [`Rk4`].
    Rk4,
    /// The family of [`Provot::unlimited`], which is symplectic Euler.
    Euler,
    /// The family of [`Provot`] with its limiter at 10 %.
    Provot,
    /// The family of [`Pbd`].
    Pbd,
    /// The family of [`Xpbd`].
    Xpbd,
    /// The family of [`Implicit`] with linearised backward Euler.
    BackwardEuler,
    /// The family of [`Implicit`] with linearised BDF2.
    Bdf2,
}

impl Family {
    /// All families, in the order of legends.
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

    /// Returns the name of the family in legends.
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

    /// Returns the scene in which the family should win, which was fixed before the experiment was run.
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

impl Serialize for Family {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Family {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Family, D::Error> {
        let given = String::deserialize(deserializer)?;
        let found = Family::ALL
            .into_iter()
            .find(|family| family.name() == given);
        found.ok_or_else(|| D::Error::custom(format!("`{given}` is no family of methods")))
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

/// A claim about a family of methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// The family is the cheapest at some tolerance in the scene of this name.
    Wins(&'static str),
    /// The family need not win anywhere: others are compared with it.
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

/// All methods with all settings, grouped by family.
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

/// The fractions of the base step that each method tries, in descending order. The last two are halvings.
pub const PARTS: [f64; 8] = [2.0, 1.0, 0.7, 0.5, 0.35, 0.25, 0.125, 0.0625];

/// The margin of base steps to what the watch admits, which would otherwise refuse them on the way.
const MARGIN: f64 = 0.95;

impl Method {
    /// Returns a new solver with these settings.
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

    /// Returns the base step in seconds, which [`PARTS`] multiply.
    ///
    /// For explicit methods it is 0.95 times the longest step that the watch over stability admits at the
    /// start. For methods that sweep it is the time in which a pull travels an edge. For implicit methods it
    /// is 1/60 s.
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

/// A method at its default settings. The default method is Verlet.
#[derive(Clone, Debug)]
pub struct Named {
    /// The name on the command line.
    pub name: &'static str,
    /// The family of methods to which it belongs.
    pub family: Family,
    settings: scene::Method,
}

/// The name of the method of scenes that name none.
pub(super) const DEFAULT: &str = "verlet";

impl Named {
    /// Returns all methods that have a name on the command line.
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

    /// Returns the method with its settings, as a scene has it.
    #[must_use]
    pub fn settings(&self) -> scene::Method {
        self.settings.clone()
    }

    /// Returns the default step for a case, in seconds.
    #[must_use]
    pub fn step_s(&self, case: &Case) -> f64 {
        suggested_step_s(&self.settings, &mut case.system(), case.speed_m_per_s())
    }

    /// Returns a new solver with the default settings.
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

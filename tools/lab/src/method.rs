//! Methods with their settings, and the steps that each is tried with.

use serde::{Deserialize, Serialize};
use tearmesh_cloth::implicit::{self, Settings, Tolerance};
use tearmesh_cloth::scene;
use tearmesh_cloth::{
    Implicit, Limiter, Pbd, Provot, Solver, System, Verlet, Xpbd, stable_step_s, suited_step_s,
};

use crate::plot::{COLOURS, Colour, Mark, Shape};
use crate::rk4::Rk4;

/// A method with its settings.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// The name in tables, such as `bdf2-100`: the family, and the sweeps per step or the tolerance.
    pub name: &'static str,
    /// The family of methods to which it belongs.
    pub family: Family,
    kind: Kind,
}

/// The families of methods, which ignore settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// The family of [`Verlet::new`].
    Verlet,
    /// The family of [`Verlet::plain`].
    PlainVerlet,
    /// The family of [`Rk4`].
    Rk4,
    /// The family of [`Provot::unlimited`], which is symplectic Euler.
    SymplecticEuler,
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
        Family::PlainVerlet,
        Family::Rk4,
        Family::SymplecticEuler,
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
            Family::PlainVerlet => "plain Verlet",
            Family::Rk4 => "RK4",
            Family::SymplecticEuler => "symplectic Euler",
            Family::Provot => "Provot",
            Family::Pbd => "PBD",
            Family::Xpbd => "XPBD",
            Family::BackwardEuler => "backward Euler",
            Family::Bdf2 => "BDF2",
        }
    }

    /// Returns the mark of the family in plots. Shape and colour each tell it from the others.
    #[must_use]
    pub fn mark(self) -> Mark {
        let (shape, colour): (Shape, Colour) = match self {
            Family::Verlet => (Shape::Disc, COLOURS[0]),
            Family::PlainVerlet => (Shape::Square, COLOURS[5]),
            Family::Rk4 => (Shape::Diamond, [0x22; 3]),
            Family::SymplecticEuler => (Shape::Up, COLOURS[4]),
            Family::Provot => (Shape::Down, [0x8a; 3]),
            Family::Pbd => (Shape::Cross, COLOURS[3]),
            Family::Xpbd => (Shape::Plus, COLOURS[1]),
            Family::BackwardEuler => (Shape::Left, COLOURS[2]),
            Family::Bdf2 => (Shape::Right, [0x7b, 0x3f, 0xa0]),
        };
        Mark::new(shape, colour)
    }

    /// Returns the way in which the energy stored in springs is computed.
    pub(crate) fn stored_energy(self) -> StoredEnergy {
        match self {
            Family::Pbd => StoredEnergy::None,
            Family::Xpbd => StoredEnergy::ByForce,
            _ => StoredEnergy::ByLength,
        }
    }
}

/// The ways in which the energy stored in springs is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StoredEnergy {
    /// From their lengths.
    ByLength,
    /// From the forces of the method. The lengths that its sweeps leave do not belong to them.
    ByForce,
    /// Springs are rigid, and store nothing.
    None,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Verlet,
    PlainVerlet,
    Rk4,
    SymplecticEuler,
    Provot,
    Pbd(u32),
    Xpbd(u32),
    Implicit(implicit::Method, f64),
}

const fn method(name: &'static str, family: Family, kind: Kind) -> Method {
    Method { name, family, kind }
}

const fn backward_euler(name: &'static str, tolerance: f64) -> Method {
    let kind = Kind::Implicit(implicit::Method::BackwardEuler, tolerance);
    method(name, Family::BackwardEuler, kind)
}

const fn bdf2(name: &'static str, tolerance: f64) -> Method {
    let kind = Kind::Implicit(implicit::Method::Bdf2, tolerance);
    method(name, Family::Bdf2, kind)
}

/// All methods with all settings, grouped by family.
pub const METHODS: [Method; 19] = [
    method("verlet", Family::Verlet, Kind::Verlet),
    method("verlet-plain", Family::PlainVerlet, Kind::PlainVerlet),
    method("rk4", Family::Rk4, Kind::Rk4),
    method("euler", Family::SymplecticEuler, Kind::SymplecticEuler),
    method("provot", Family::Provot, Kind::Provot),
    method("pbd-1", Family::Pbd, Kind::Pbd(1)),
    method("pbd-2", Family::Pbd, Kind::Pbd(2)),
    method("pbd-4", Family::Pbd, Kind::Pbd(4)),
    method("pbd-10", Family::Pbd, Kind::Pbd(10)),
    method("xpbd-1", Family::Xpbd, Kind::Xpbd(1)),
    method("xpbd-2", Family::Xpbd, Kind::Xpbd(2)),
    method("xpbd-4", Family::Xpbd, Kind::Xpbd(4)),
    method("xpbd-10", Family::Xpbd, Kind::Xpbd(10)),
    backward_euler("euler-back-10", 10.0),
    backward_euler("euler-back-100", 100.0),
    backward_euler("euler-back-1000", 1000.0),
    bdf2("bdf2-10", 10.0),
    bdf2("bdf2-100", 100.0),
    bdf2("bdf2-1000", 1000.0),
];

/// The fractions of its base step that each method is tried with, in descending order. The last two are
/// halvings.
pub const STEP_FRACTIONS: [f64; 8] = [2.0, 1.0, 0.7, 0.5, 0.35, 0.25, 0.125, 0.0625];

/// The fraction of the longest stable step that is a base step: at the limit itself, a step would be refused
/// as soon as an edge is stretched.
const MARGIN: f64 = 0.95;

impl Method {
    /// Returns the method of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Method> {
        METHODS.iter().find(|method| method.name == name)
    }

    /// Returns a new solver with these settings.
    #[must_use]
    pub fn solver(&self) -> Box<dyn Solver> {
        match self.kind {
            Kind::Verlet => Box::new(Verlet::new()),
            Kind::PlainVerlet => Box::new(Verlet::plain()),
            Kind::Rk4 => Box::new(Rk4::new()),
            Kind::SymplecticEuler => Box::new(Provot::unlimited()),
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

    /// Returns the number of sweeps per step; `None` for a method that does not sweep.
    pub(crate) fn sweeps(&self) -> Option<u32> {
        match self.kind {
            Kind::Pbd(sweeps) | Kind::Xpbd(sweeps) => Some(sweeps),
            _ => None,
        }
    }

    /// Returns the base step in seconds, which [`STEP_FRACTIONS`] multiply, for a system in which a pull
    /// travels an edge in `edge_s` seconds.
    ///
    /// For explicit methods it is 0.95 times the longest step that is admitted at the start. For methods that
    /// sweep it is `edge_s`. For implicit methods it is 1/60 s.
    #[must_use]
    pub fn base_s(&self, system: &mut System, edge_s: f64) -> f64 {
        match self.kind {
            // Admitted up to twice the recommended step.
            Kind::Verlet => MARGIN * 2.0 * suited_step_s(system),
            Kind::PlainVerlet | Kind::Rk4 | Kind::SymplecticEuler | Kind::Provot => {
                MARGIN * limit_s(system, &*self.solver())
            }
            Kind::Pbd(_) | Kind::Xpbd(_) => edge_s,
            Kind::Implicit(..) => 1.0 / 60.0,
        }
    }
}

/// The longest step in seconds that is admitted now.
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

/// A method at its default settings, by its name on the command line.
#[derive(Clone, Debug)]
pub struct DefaultMethod {
    /// The name on the command line.
    pub name: &'static str,
    /// The family of methods to which it belongs.
    pub family: Family,
    /// The settings.
    pub settings: scene::Method,
}

/// The name of the method that is used where none is named.
pub const DEFAULT: &str = "verlet";

impl DefaultMethod {
    /// The names of all methods, in the order of [`DefaultMethod::all`].
    pub const NAMES: [&str; 5] = ["verlet", "xpbd", "implicit", "pbd", "provot"];

    /// Returns all methods that have a name on the command line.
    #[must_use]
    pub fn all() -> [DefaultMethod; 5] {
        let [verlet, xpbd, implicit, pbd, provot] = DefaultMethod::NAMES;
        let method = |name, family, settings| DefaultMethod {
            name,
            family,
            settings,
        };
        [
            method(verlet, Family::Verlet, scene::Method::Verlet),
            method(xpbd, Family::Xpbd, scene::Method::xpbd()),
            method(implicit, Family::BackwardEuler, scene::Method::implicit()),
            method(pbd, Family::Pbd, scene::Method::pbd()),
            method(provot, Family::Provot, scene::Method::provot()),
        ]
    }

    /// Returns a new solver with the default settings.
    #[must_use]
    pub fn solver(&self) -> Box<dyn Solver> {
        match &self.settings {
            scene::Method::Provot(limiter) => Box::new(Provot::new(*limiter)),
            scene::Method::Pbd(pbd) => Box::new(*pbd),
            scene::Method::Verlet => Box::new(Verlet::new()),
            scene::Method::Xpbd(xpbd) => Box::new(*xpbd),
            scene::Method::Implicit(settings) => Box::new(Implicit::new(*settings)),
        }
    }
}

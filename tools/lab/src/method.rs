//! Methods with their settings, and the steps that each is tried with.

use serde::{Deserialize, Serialize};
use tearmesh_cloth::implicit::{self, Settings};
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
    /// The sweeps per step of a method that sweeps, or the tolerance of an implicit method.
    setting: u32,
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

    /// The name, and what tells the mark from others: shape and colour each do.
    fn style(self) -> (&'static str, Shape, Colour) {
        match self {
            Family::Verlet => ("Verlet", Shape::Disc, COLOURS[0]),
            Family::PlainVerlet => ("plain Verlet", Shape::Square, COLOURS[5]),
            Family::Rk4 => ("RK4", Shape::Diamond, [0x22; 3]),
            Family::SymplecticEuler => ("symplectic Euler", Shape::Up, COLOURS[4]),
            Family::Provot => ("Provot", Shape::Down, [0x8a; 3]),
            Family::Pbd => ("PBD", Shape::Cross, COLOURS[3]),
            Family::Xpbd => ("XPBD", Shape::Plus, COLOURS[1]),
            Family::BackwardEuler => ("backward Euler", Shape::Left, COLOURS[2]),
            Family::Bdf2 => ("BDF2", Shape::Right, [0x7b, 0x3f, 0xa0]),
        }
    }

    /// Returns the name of the family in legends.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.style().0
    }

    /// Returns the mark of the family in plots.
    #[must_use]
    pub fn mark(self) -> Mark {
        let (_, shape, colour) = self.style();
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

/// All methods with all settings, grouped by family.
pub const METHODS: [Method; 19] = [
    method("verlet", Family::Verlet, 0),
    method("verlet-plain", Family::PlainVerlet, 0),
    method("rk4", Family::Rk4, 0),
    method("euler", Family::SymplecticEuler, 0),
    method("provot", Family::Provot, 0),
    method("pbd-1", Family::Pbd, 1),
    method("pbd-2", Family::Pbd, 2),
    method("pbd-4", Family::Pbd, 4),
    method("pbd-10", Family::Pbd, 10),
    method("xpbd-1", Family::Xpbd, 1),
    method("xpbd-2", Family::Xpbd, 2),
    method("xpbd-4", Family::Xpbd, 4),
    method("xpbd-10", Family::Xpbd, 10),
    method("euler-back-10", Family::BackwardEuler, 10),
    method("euler-back-100", Family::BackwardEuler, 100),
    method("euler-back-1000", Family::BackwardEuler, 1000),
    method("bdf2-10", Family::Bdf2, 10),
    method("bdf2-100", Family::Bdf2, 100),
    method("bdf2-1000", Family::Bdf2, 1000),
];

const fn method(name: &'static str, family: Family, setting: u32) -> Method {
    Method {
        name,
        family,
        setting,
    }
}

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
        let implicit = |method| {
            Box::new(Implicit::new(Settings {
                method,
                tolerance: self.setting.into(),
                ..Settings::default()
            }))
        };
        match self.family {
            Family::Verlet => Box::new(Verlet::new()),
            Family::PlainVerlet => Box::new(Verlet::plain()),
            Family::Rk4 => Box::new(Rk4::new()),
            Family::SymplecticEuler => Box::new(Provot::unlimited()),
            Family::Provot => Box::new(Provot::new(Limiter::default())),
            Family::Pbd => Box::new(Pbd::new(self.setting)),
            Family::Xpbd => Box::new(Xpbd::new(1, self.setting)),
            Family::BackwardEuler => implicit(implicit::Method::BackwardEuler),
            Family::Bdf2 => implicit(implicit::Method::Bdf2),
        }
    }

    /// Returns the number of sweeps per step; `None` for a method that does not sweep.
    pub(crate) fn sweeps(&self) -> Option<u32> {
        matches!(self.family, Family::Pbd | Family::Xpbd).then_some(self.setting)
    }

    /// Returns the base step in seconds, which [`STEP_FRACTIONS`] multiply, for a system in which a pull
    /// travels an edge in `edge_s` seconds.
    ///
    /// For explicit methods it is 0.95 times the longest step that is admitted at the start. For methods that
    /// sweep it is `edge_s`. For implicit methods it is 1/60 s.
    #[must_use]
    pub fn base_s(&self, system: &mut System, edge_s: f64) -> f64 {
        match self.family {
            // Admitted up to twice the recommended step.
            Family::Verlet => MARGIN * 2.0 * suited_step_s(system),
            Family::Pbd | Family::Xpbd => edge_s,
            Family::BackwardEuler | Family::Bdf2 => 1.0 / 60.0,
            _ => MARGIN * limit_s(system, &*self.solver()),
        }
    }
}

/// The longest step in seconds that is admitted now.
fn limit_s(system: &mut System, solver: &dyn Solver) -> f64 {
    let abilities = solver.abilities();
    let springs_s = abilities.frequency_limit;
    let springs_s = springs_s.map_or(f64::INFINITY, |limit| stable_step_s(system, limit));
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

    /// Returns the method of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<DefaultMethod> {
        DefaultMethod::all()
            .into_iter()
            .find(|method| method.name == name)
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

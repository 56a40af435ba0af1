//! Methods with their settings, and the steps that each is tried with.

use serde::{Deserialize, Serialize};
use tearmesh_cloth::implicit::{self, Settings};
use tearmesh_cloth::{Pbd, Provot, Solver, System, Xpbd, recommended_step_s, stable_step_s};

use crate::plain_verlet::PlainVerlet;
use crate::plot::{COLOURS, Colour, INK, Mark, Shape};
use crate::rk4::Rk4;

/// A method with its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Method {
    /// The name: as on the command line for default settings, and else such as `bdf2-100`, with the sweeps per
    /// step or the tolerance.
    pub(crate) name: &'static str,
    /// The family of methods to which it belongs.
    pub(crate) family: Family,
    /// The sweeps per step of a method that sweeps, or the tolerance of an implicit method.
    setting: u32,
}

/// The families of methods, which ignore settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Family {
    /// The family of [`Verlet`](tearmesh_cloth::Verlet).
    Verlet,
    /// The family of [`PlainVerlet`].
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
    /// The family of [`Implicit`](tearmesh_cloth::Implicit) with linearised backward Euler.
    BackwardEuler,
    /// The family of [`Implicit`](tearmesh_cloth::Implicit) with linearised BDF2.
    Bdf2,
}

/// The names of the families in their order, and what tells their marks from others: shape and colour each do.
const STYLES: [(&str, Shape, Colour); 9] = [
    ("Verlet", Shape::DISC, COLOURS[0]),
    ("plain Verlet", Shape::SQUARE, COLOURS[5]),
    ("RK4", Shape::DIAMOND, INK),
    ("symplectic Euler", Shape::UP, COLOURS[4]),
    ("Provot", Shape::DOWN, [0x8a; 3]),
    ("PBD", Shape::CROSS, COLOURS[3]),
    ("XPBD", Shape::PLUS, COLOURS[1]),
    ("backward Euler", Shape::LEFT, COLOURS[2]),
    ("BDF2", Shape::RIGHT, [0x7b, 0x3f, 0xa0]),
];

impl Family {
    /// Returns all families, in the order of legends.
    #[must_use]
    pub(crate) fn all() -> impl DoubleEndedIterator<Item = Family> {
        let families = METHODS.chunk_by(|a, b| a.family == b.family);
        families.map(|methods| methods[0].family)
    }

    /// Returns the name of the family in legends.
    #[must_use]
    pub(crate) fn name(self) -> &'static str {
        STYLES[self as usize].0
    }

    /// Returns the mark of the family in plots.
    #[must_use]
    pub(crate) fn mark(self) -> Mark {
        let (_, shape, colour) = STYLES[self as usize];
        Mark::new(shape, colour)
    }
}

/// All methods with all settings, grouped by family.
pub(crate) const METHODS: [Method; 19] = [
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

/// The methods of the command with their default settings.
pub(crate) const DEFAULTS: [Method; 5] = [
    method(DEFAULT, Family::Verlet, 0),
    method("xpbd", Family::Xpbd, 1),
    method("implicit", Family::BackwardEuler, 1000),
    method("pbd", Family::Pbd, 10),
    method("provot", Family::Provot, 0),
];

/// Returns the names of the methods of the command, in the order of charts.
#[must_use]
pub fn default_names() -> [&'static str; DEFAULTS.len()] {
    DEFAULTS.map(|method| method.name)
}

/// The name of the method that is used where none is named.
pub(crate) const DEFAULT: &str = "verlet";

const fn method(name: &'static str, family: Family, setting: u32) -> Method {
    Method {
        name,
        family,
        setting,
    }
}

/// The fractions of its base step that each method is tried with, in descending order. The last two are
/// halvings.
pub(crate) const STEP_FRACTIONS: [f64; 8] = [2.0, 1.0, 0.7, 0.5, 0.35, 0.25, 0.125, 0.0625];

/// The fraction of the longest stable step that is a base step: at the limit itself, a step would be refused
/// as soon as an edge is stretched.
const MARGIN: f64 = 0.95;

impl Method {
    /// Returns the method of this name, of [`METHODS`] or [`DEFAULTS`].
    #[must_use]
    pub(crate) fn named(name: &str) -> Option<&'static Method> {
        let mut all = METHODS.iter().chain(&DEFAULTS);
        all.find(|method| method.name == name)
    }

    /// Returns the method as scenes have it; `None` for methods of the lab alone.
    #[must_use]
    pub(crate) fn settings(&self) -> Option<tearmesh_cloth::Method> {
        let implicit = |method| {
            tearmesh_cloth::Method::Implicit(Settings {
                method,
                tolerance: self.setting.into(),
                ..Settings::default()
            })
        };
        Some(match self.family {
            Family::Verlet => tearmesh_cloth::Method::Verlet,
            Family::Provot => tearmesh_cloth::Method::provot(),
            Family::Pbd => tearmesh_cloth::Method::Pbd(Pbd::new(self.setting)),
            Family::Xpbd => tearmesh_cloth::Method::Xpbd(Xpbd::new(1, self.setting)),
            Family::BackwardEuler => implicit(implicit::Method::BackwardEuler),
            Family::Bdf2 => implicit(implicit::Method::Bdf2),
            Family::PlainVerlet | Family::Rk4 | Family::SymplecticEuler => return None,
        })
    }

    /// Returns a new solver with these settings.
    #[must_use]
    pub(crate) fn solver(&self) -> Box<dyn Solver> {
        match self.settings() {
            Some(settings) => settings.solver(),
            None if self.family == Family::Rk4 => Box::new(Rk4::new()),
            None if self.family == Family::PlainVerlet => Box::new(PlainVerlet::new()),
            None => Box::new(Provot::unlimited()),
        }
    }

    /// Returns the number of sweeps per step; 1 for a method that does not sweep.
    pub(crate) fn sweeps(&self) -> u32 {
        match self.family {
            Family::Pbd | Family::Xpbd => self.setting,
            _ => 1,
        }
    }

    /// Returns the base step in seconds, which [`STEP_FRACTIONS`] multiply, for a system in which a pull
    /// travels an edge in `edge_s` seconds.
    ///
    /// For explicit methods it is 0.95 times the longest step that is admitted at the start. For methods that
    /// sweep it is `edge_s`. For implicit methods it is 1/60 s.
    #[must_use]
    pub(crate) fn base_s(&self, system: &mut System, edge_s: f64) -> f64 {
        match self.family {
            // Admitted up to twice the recommended step.
            Family::Verlet => MARGIN * 2.0 * recommended_step_s(system),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_those_of_scenes() {
        for method in &DEFAULTS {
            let settings = method.settings().expect("scenes have it");
            let known = tearmesh_cloth::Method::named(method.name).expect("a name of scenes");
            assert_eq!(format!("{settings:?}"), format!("{known:?}"));
        }
    }
}

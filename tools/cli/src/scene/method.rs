//! What `[solver]` says, and the methods with their defaults.

use clap::ValueEnum;
use tearmesh_cloth::Method;
use tearmesh_cloth::implicit::{self, Settings};
use tearmesh_cloth::scene::Scene;
use tearmesh_cloth::{Limiter, Pbd};

use super::file::{SceneFile, Table};
use crate::say::Fault;

impl SceneFile {
    /// The method: its keys are those of the file's or of the one that was typed in its place.
    pub(super) fn solver(
        &self,
        scene: &mut Scene,
        typed: Option<SolverName>,
        faults: &mut Vec<Fault>,
    ) {
        let table = self.first("solver");
        let word = table.and_then(|table| table.word("method"));
        let method = word.unwrap_or(method_name(&scene.solver));
        let named = word.and_then(typed_as);
        if let Some(name) = typed.or(named) {
            scene.solver = name.method();
        }
        let Some(table) = table else {
            return;
        };
        scene.step_s = table.number("dt_s").or(scene.step_s);
        for (key, readers) in OF_METHODS {
            let is_read = |reader: &&str| *reader == method || typed_as(reader) == typed;
            if table.values.contains_key(key) && !readers.iter().any(is_read) {
                let readers = readers.join(" or ");
                let message = format!("`{key}` goes with {readers}, and the method is {method}");
                faults.push(*self.fault(table, key, "E-SCENE-CLASH", message));
            }
        }
        match &mut scene.solver {
            Method::Provot(limiter) => provot(table, limiter),
            Method::Pbd(pbd) => set_pbd(table, pbd),
            Method::Verlet => {}
            Method::Xpbd(xpbd) => {
                xpbd.substeps = table.count("substeps").unwrap_or(xpbd.substeps);
                xpbd.sweeps = table.count("sweeps").unwrap_or(xpbd.sweeps);
            }
            Method::Implicit(settings) => set_implicit(table, settings),
        }
    }
}

/// The keys of [solver] that not all methods read, and which do.
const OF_METHODS: [(&str, &[&str]); 8] = [
    ("substeps", &["xpbd"]),
    ("sweeps", &["xpbd", "pbd"]),
    ("stiffness", &["pbd"]),
    ("bend_stiffness", &["pbd"]),
    ("limit_ratio", &["provot"]),
    ("limit_passes", &["provot"]),
    ("order", &["implicit"]),
    ("tolerance", &["implicit"]),
];

fn provot(table: &Table, limiter: &mut Limiter) {
    if let Some(ratio) = table.number("limit_ratio") {
        limiter.stretch_ratio_max = ratio;
    }
    if let Some(passes) = table.count("limit_passes") {
        limiter.passes_max = passes;
    }
}

fn set_pbd(table: &Table, pbd: &mut Pbd) {
    pbd.sweeps = table.count("sweeps").unwrap_or(pbd.sweeps);
    pbd.stiffness = table.number("stiffness").unwrap_or(pbd.stiffness);
    pbd.bend_stiffness = table.number("bend_stiffness").unwrap_or(pbd.bend_stiffness);
}

fn set_implicit(table: &Table, settings: &mut Settings) {
    settings.tolerance = table.number("tolerance").unwrap_or(settings.tolerance);
    match table.word("order") {
        Some("2") => settings.method = implicit::Method::Bdf2,
        Some(_) => settings.method = implicit::Method::BackwardEuler,
        None => {}
    }
}

/// A method of simulation, as it is typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SolverName {
    Provot,
    Pbd,
    Verlet,
    Xpbd,
    Implicit,
}

impl SolverName {
    /// The method with its default settings.
    pub(super) fn method(self) -> Method {
        match self {
            SolverName::Provot => Method::provot(),
            SolverName::Pbd => Method::pbd(),
            SolverName::Verlet => Method::Verlet,
            SolverName::Xpbd => Method::xpbd(),
            SolverName::Implicit => Method::implicit(),
        }
    }
}

fn typed_as(word: &str) -> Option<SolverName> {
    SolverName::from_str(word, false).ok()
}

/// As it is typed, and as it stands in the report.
pub(crate) fn method_name(method: &Method) -> &'static str {
    match method {
        Method::Provot(_) => "provot",
        Method::Pbd(_) => "pbd",
        Method::Verlet => "verlet",
        Method::Xpbd(_) => "xpbd",
        Method::Implicit(_) => "implicit",
    }
}

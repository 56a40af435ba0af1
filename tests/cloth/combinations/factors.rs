//! The factors of cloth: every option of the solver layer with its levels, what does not go together and why, and
//! the keys and verbs that are no factor and why.
//!
//! The first level of each factor is its plainest one, which shrinking and the baseline of costs go back to.

use std::collections::BTreeMap;

use crate::array::{Exclusion, Factor, Table};

pub(super) const FACTORS: &[Factor] = &[
    ("seams", &["none", "sewn"]),
    ("method", &["verlet", "implicit", "provot", "pbd", "xpbd"]),
    ("settings", &["default", "changed"]),
    (
        "mesh",
        &["flat", "folded", "uneven", "soup", "panels", "torn"],
    ),
    ("step", &["default", "short", "long"]),
    ("fabric", &["membrane", "edges", "whole", "woven"]),
    ("bending", &["none", "spring", "vertex", "buckling"]),
    ("damping", &["default", "none", "strong"]),
    ("gravity", &["down", "aslant", "none"]),
    ("ripple", &["default", "none", "large"]),
    ("drag", &["some", "none"]),
    (
        "threshold",
        &[
            "never",
            "stretch",
            "toughness",
            "force",
            "principal",
            "warp",
        ],
    ),
    ("strength", &["even", "uneven"]),
    ("collider", &["none", "plane", "ball", "body", "moving"]),
    ("friction", &["none", "some", "unset"]),
    ("wind", &["still", "steady", "swaying", "later"]),
    ("hold", &["none", "still", "released", "moving", "turning"]),
    ("unpick", &["none", "early", "late"]),
    ("cut", &["none", "default", "snap0", "through", "partition"]),
    ("heal", &["none", "cut", "all", "seam", "ended"]),
    ("hand", &["none", "led"]),
];

/// The factors in the order in which a failing sequence is made plainer: verbs first, and each before those
/// that it needs.
pub(super) const SHRINKING: &[&str] = &[
    "hand",
    "heal",
    "cut",
    "unpick",
    "seams",
    "hold",
    "wind",
    "friction",
    "collider",
    "strength",
    "threshold",
    "drag",
    "ripple",
    "gravity",
    "damping",
    "bending",
    "fabric",
    "step",
    "mesh",
    "settings",
    "method",
];

pub(super) const EXCLUSIONS: &[Exclusion] = &[
    Exclusion {
        levels: &[("fabric", "woven"), ("method", "pbd xpbd")],
        reason: "pbd and xpbd move springs, and refuse triangles",
    },
    Exclusion {
        levels: &[("bending", "buckling"), ("method", "pbd xpbd")],
        reason: "pbd and xpbd move springs, and refuse arcs",
    },
    Exclusion {
        levels: &[("settings", "changed"), ("method", "verlet")],
        reason: "verlet has no settings",
    },
    Exclusion {
        levels: &[("seams", "sewn"), ("mesh", "!panels")],
        reason: "only panels have sides to be sewn",
    },
    Exclusion {
        levels: &[("unpick", "!none"), ("seams", "none")],
        reason: "there is no seam to unpick",
    },
    Exclusion {
        // It follows from the two before it. Said, it spares the search for rows most of its ways back.
        levels: &[("unpick", "!none"), ("mesh", "!panels")],
        reason: "only panels have seams to unpick",
    },
    Exclusion {
        levels: &[("heal", "seam"), ("seams", "none")],
        reason: "there is no seam to sew",
    },
    Exclusion {
        // As for `unpick`.
        levels: &[("heal", "seam"), ("mesh", "!panels")],
        reason: "only panels have seams to sew",
    },
    Exclusion {
        levels: &[("heal", "cut"), ("cut", "none")],
        reason: "there is no cut to heal",
    },
    Exclusion {
        levels: &[("friction", "!none"), ("collider", "none")],
        reason: "friction is a number of a collider",
    },
    Exclusion {
        levels: &[("strength", "uneven"), ("threshold", "never")],
        reason: "what never tears asks for no strength",
    },
];

/// Keys of scene files that no factor writes.
pub(super) const OTHER_KEYS: &[(&str, &str)] = &[(
    "fabric.vt_m",
    "it needs texture coordinates, which a mesh of a test has none of",
)];

/// Public items of `Simulation` that are no input.
pub(super) const OTHER_VERBS: &[(&str, &str)] = &[
    ("new", "every sequence begins with it"),
    ("replayed", "every sequence that is recorded ends with it"),
    ("advance", "every sequence goes on by it"),
    ("mesh", "it is read by oracles"),
    ("cloth", "it is read by oracles"),
    ("edits", "it is read, and tests/followers follows it"),
    ("events", "it is read after every frame"),
    ("draw_buffers", "it is read after every frame"),
    ("in_hand", "it is read while a hand leads"),
    ("log", "it is read where a sequence is replayed"),
    ("open_pairs", "it is read by oracles"),
    ("time_s", "it is read"),
    ("steps", "it is read"),
    ("step_s", "it is read"),
    ("ripple_m", "it is read"),
    ("pick", "it changes nothing; a hand asks it for its vertex"),
    ("GRIP_RADIUS_M", "it is a number, which a hand is given"),
    (
        "advance_while",
        "`advance` is this with a condition that always holds",
    ),
];

/// A level of each factor, by its name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Case(pub(super) BTreeMap<&'static str, &'static str>);

impl Case {
    /// The plainest level of every factor.
    pub(super) fn plain() -> Case {
        Case(
            FACTORS
                .iter()
                .map(|(name, levels)| (*name, levels[0]))
                .collect(),
        )
    }

    /// The case of a row of a table of the factors.
    pub(super) fn of_row(table: &Table, row: &[usize]) -> Case {
        let level = |(name, _): &Factor| (*name, table.level(row, name));
        Case(FACTORS.iter().map(level).collect())
    }

    /// A case by the words of a [`Display`](std::fmt::Display); factors that it does not name are plain.
    pub(super) fn of(words: &str) -> Case {
        let mut case = Case::plain();
        for word in words.split_whitespace() {
            let (factor, level) = word.split_once('=').expect("factor=level");
            case = case.with(factor, level);
        }
        case
    }

    pub(super) fn get(&self, factor: &str) -> &'static str {
        self.0[factor]
    }

    pub(super) fn is(&self, factor: &str, levels: &str) -> bool {
        levels.split(' ').any(|level| level == self.get(factor))
    }

    /// The case with another level of one factor.
    pub(super) fn with(&self, factor: &str, level: &str) -> Case {
        let found = FACTORS.iter().find(|(name, _)| *name == factor);
        let (name, levels) = found.unwrap_or_else(|| panic!("no factor is called {factor}"));
        let found = levels.iter().find(|one| **one == level);
        let level = found.unwrap_or_else(|| panic!("{factor} has no level {level}"));
        let mut case = self.clone();
        case.0.insert(name, level);
        case
    }

    /// The case with the plainest level of one factor.
    pub(super) fn without(&self, factor: &str) -> Case {
        self.with(factor, Case::plain().get(factor))
    }

    /// Whether no exclusion forbids it.
    pub(super) fn is_allowed(&self) -> bool {
        let has = |&(factor, levels): &(&str, &str)| match levels.strip_prefix('!') {
            Some(others) => !self.is(factor, others),
            None => self.is(factor, levels),
        };
        !EXCLUSIONS
            .iter()
            .any(|exclusion| exclusion.levels.iter().all(has))
    }
}

/// The levels that are not the plainest.
impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let plain = Case::plain();
        let order = FACTORS.iter().map(|(name, _)| *name);
        let differs = order.filter(|name| self.get(name) != plain.get(name));
        let words: Vec<String> = differs
            .map(|name| format!("{name}={}", self.get(name)))
            .collect();
        f.write_str(&words.join(" "))
    }
}

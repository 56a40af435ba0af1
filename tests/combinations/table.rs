//! The factors of a cut, with their levels, and what of them does not go together.

use crate::array::{Exclusion, Factor, Table};

/// What a cut is made of. The first four words of `mesh` and those of `history` are drawn in `meshes.rs`,
/// those of `aim` and `rays` in `aims.rs`.
pub(crate) const FACTORS: [Factor; 13] = [
    (
        "mesh",
        &[
            "grid",
            "irregular",
            "closed",
            "tube",
            "parts",
            "soup",
            "seam",
            "double-sided",
            "hub",
            "slivers",
            "far",
            "tiny",
        ],
    ),
    (
        "rays",
        &[
            "none",
            "parallel",
            "one-eye",
            "nearly-one-eye",
            "converging",
            "skew",
            "far-eye",
        ],
    ),
    ("aim", &["plane", "two-rays", "polyline", "closed-polyline"]),
    ("snap", &["0", "0.01", "0.05", "0.2", "0.49"]),
    ("snap-move", &["no", "yes"]),
    ("layers", &["all", "first"]),
    ("through", &["no", "yes"]),
    ("gap", &["none", "tenth"]),
    ("method", &["exact", "partition", "uniform", "alternating"]),
    ("tips", &["vertex", "midpoint"]),
    ("mass", &["area", "half"]),
    ("history", &["fresh", "cut", "torn", "mended", "welded"]),
    ("attributes", &["none", "uv", "normals", "both"]),
];

/// What no row has, and why.
const EXCLUSIONS: [Exclusion; 10] = [
    Exclusion {
        levels: &[("aim", "plane"), ("rays", "!none")],
        reason: "a plane has no rays",
    },
    Exclusion {
        levels: &[("aim", "!plane"), ("rays", "none")],
        reason: "all but a plane is given by rays",
    },
    Exclusion {
        levels: &[("aim", "plane"), ("layers", "first")],
        reason: "no ray hits a layer first, and the command says so",
    },
    Exclusion {
        levels: &[("aim", "plane"), ("through", "yes")],
        reason: "a plane has no rays to cut beyond, and the command refuses it",
    },
    Exclusion {
        levels: &[("aim", "polyline closed-polyline"), ("through", "yes")],
        reason: "cuts along whole planes do not end where the next begins: they are cuts by planes",
    },
    Exclusion {
        levels: &[("method", "!exact"), ("snap", "!0.05")],
        reason: "methods along edges have no crossings to snap; 0.05 is the default",
    },
    Exclusion {
        levels: &[("method", "!exact"), ("snap-move", "yes")],
        reason: "methods along edges move no vertex, and the command says so",
    },
    Exclusion {
        levels: &[("method", "!partition"), ("tips", "midpoint")],
        reason: "only partition has a rule for tips, and the command says so",
    },
    Exclusion {
        levels: &[("method", "exact"), ("mass", "half")],
        reason: "halves cannot follow inserted vertices, and the command says so",
    },
    Exclusion {
        levels: &[("mesh", "soup"), ("history", "torn")],
        reason: "a face that has its vertices for itself has no edge to tear",
    },
];

pub(crate) fn table() -> Table {
    Table::new(&FACTORS, &EXCLUSIONS)
}

/// A row by the names of its levels.
#[derive(Clone, Debug)]
pub(crate) struct Levels {
    table: Table,
    row: Vec<usize>,
}

impl Levels {
    pub(crate) fn new(table: &Table, row: &[usize]) -> Levels {
        Levels {
            table: table.clone(),
            row: row.to_vec(),
        }
    }

    /// The level of a factor.
    pub(crate) fn of(&self, factor: &str) -> &'static str {
        self.table.level(&self.row, factor)
    }

    /// Whether the level of a factor is one of these words.
    pub(crate) fn is(&self, factor: &str, words: &str) -> bool {
        words.split(' ').any(|word| word == self.of(factor))
    }

    pub(crate) fn words(&self) -> String {
        self.table.words(self.row.iter().copied().enumerate())
    }
}

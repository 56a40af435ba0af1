//! Every key of a scene file. Meanings and defaults are in [the guide](crate::guide::scenes), from
//! which `--help` takes them.

use std::fmt::Write as _;

use serde::Deserialize;
use tearmesh::CutMethod;
use tearmesh_cloth::scene::Axis;
use tearmesh_cloth::{Copies, Unbend, implicit};

use super::kinds::{
    Count, Gravity, Interval, Moves, NotNegative, Numbers, Pair, Part, Positive, Ratio, Rays,
    Triple, Word,
};
use crate::choice::{BendLaw, Preset, Solver as Method};

/// Keys that scene files once had, by table, and what to do without them.
pub(super) const REMOVED: [(&str, &str, &str); 3] = [
    (
        "solver",
        "newton_iterations",
        "leave it out; a shorter `dt_s` makes implicit steps more exact",
    ),
    (
        "tear",
        "delay_s",
        "leave it out; an edge tears in the step in which it reaches its threshold",
    ),
    (
        "tear",
        "tears_held",
        "leave it out; held vertices do not tear",
    ),
];

#[derive(Clone, Debug, Deserialize)]
pub(super) struct Top {
    pub(super) base: Option<Word<Preset>>,
    pub(super) seconds: Option<NotNegative>,
    pub(super) up: Option<Word<Axis>>,
    pub(super) gravity_m_per_s2: Option<Gravity>,
    pub(super) drag_per_s: Option<NotNegative>,
}

#[derive(Clone, Debug, Deserialize)]
pub(super) struct Fabric {
    pub(super) density_kg_per_m2: Option<Positive>,
    pub(super) stretch_n_per_m: Option<Positive>,
    pub(super) warp_n_per_m: Option<Positive>,
    pub(super) weft_n_per_m: Option<Positive>,
    pub(super) shear_n_per_m: Option<NotNegative>,
    pub(super) warp: Option<Triple>,
    pub(super) bend_law: Option<Word<BendLaw>>,
    pub(super) bend_n_per_m: Option<NotNegative>,
    pub(super) flexural_n_m2: Option<Positive>,
    pub(super) buckles_below: Option<Part>,
    pub(super) copies: Option<Word<Copies>>,
    pub(super) unbend: Option<Word<Unbend>>,
}

#[derive(Clone, Debug, Deserialize)]
pub(super) struct Solver {
    pub(super) method: Option<Word<Method>>,
    pub(super) dt_s: Option<Positive>,
    pub(super) substeps: Option<Count>,
    pub(super) sweeps: Option<Count>,
    pub(super) stiffness: Option<Part>,
    pub(super) bend_stiffness: Option<Part>,
    pub(super) limit_ratio: Option<Ratio>,
    pub(super) limit_passes: Option<Count>,
    pub(super) order: Option<Word<implicit::Method>>,
    pub(super) tolerance: Option<Positive>,
}

#[derive(Clone, Debug, Deserialize)]
pub(super) struct Wind {
    pub(super) velocity_m_per_s: Option<Triple>,
    pub(super) coefficient: Option<NotNegative>,
    pub(super) sway_m_per_s: Option<Triple>,
    pub(super) period_s: Option<Positive>,
}

#[derive(Clone, Debug, Deserialize)]
pub(super) struct ColliderKeys {
    pub(super) point: Option<Triple>,
    pub(super) normal: Option<Triple>,
    pub(super) centre: Option<Triple>,
    pub(super) radius_m: Option<Positive>,
}

/// Vertices, and what is done with them: they are held, or have a strength.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Vertices {
    pub(super) factor: Option<Positive>,
    pub(super) near: Option<Pair>,
    pub(super) radius: Option<NotNegative>,
    pub(super) across: Option<Interval>,
    pub(super) along: Option<Interval>,
    pub(super) from: Option<Triple>,
    pub(super) to: Option<Triple>,
    pub(super) centre: Option<Triple>,
    pub(super) radius_m: Option<NotNegative>,
    pub(super) vertices: Option<Numbers>,
    pub(super) from_s: Option<NotNegative>,
    pub(super) until_s: Option<Positive>,
    pub(super) moves: Option<Moves>,
}

#[derive(Clone, Debug, Deserialize)]
pub(super) struct Cut {
    pub(super) at_s: Option<NotNegative>,
    pub(super) rays: Option<Rays>,
    pub(super) through: Option<bool>,
    pub(super) method: Option<Word<CutMethod>>,
}

#[derive(Clone, Debug, Deserialize)]
pub(super) struct Tear {
    pub(super) never: Option<bool>,
    pub(super) threshold: Option<Ratio>,
    pub(super) toughness_j_per_m: Option<Positive>,
    pub(super) threshold_n: Option<Positive>,
    pub(super) principal_stretch: Option<Ratio>,
    pub(super) threshold_warp: Option<Ratio>,
    pub(super) threshold_weft: Option<Ratio>,
    pub(super) warp: Option<Triple>,
    pub(super) splits_per_step: Option<Count>,
    pub(super) weakening: Option<Part>,
}

/// A table of a scene file, as the guide has it.
pub(super) struct Section {
    /// With brackets; two if it may stand more than once.
    pub(super) title: &'static str,
    /// Empty for the top.
    pub(super) table: &'static str,
    /// The name of each key, the default, and the meaning.
    pub(super) keys: Vec<[&'static str; 3]>,
}

impl Section {
    /// All of them.
    pub(super) fn all() -> Vec<Section> {
        let sections = include_str!("../guide/scenes.md").split("\n# ").skip(1);
        let section = |text: &'static str| {
            let title = text.lines().next().unwrap_or_default().trim_matches('`');
            let table = title.trim_matches(['[', ']']);
            let rows = text.lines().filter_map(|line| line.strip_prefix("| `"));
            let key = |row: &'static str| {
                let mut cells = row.split('|').map(str::trim);
                let mut cell = || cells.next().unwrap_or_default();
                [cell().trim_matches('`'), cell(), cell()]
            };
            Section {
                title,
                table: if table == title { "" } else { table },
                keys: rows.map(key).collect(),
            }
        };
        sections.map(section).collect()
    }

    pub(super) fn is_list(&self) -> bool {
        self.title.starts_with("[[")
    }
}

/// All keys in plain text, for `--help`.
pub(crate) fn schema() -> String {
    let mut text = String::from(
        "Scene files (TOML). Keys are optional unless marked as required. Any [[hold]], [[cut]],\n\
         [[strength]] or [[collider]] replaces all entries of its kind in the base. A [tear] section\n\
         enables tearing, even with base = \"flag\", unless it says never = true. Vertices count from 1,\n\
         as in OBJ, without duplicates (named in comments `#~ fan` of a torn file).",
    );
    for section in Section::all() {
        let many = if section.is_list() {
            " (any number)"
        } else {
            ""
        };
        write!(text, "\n  {}{many}", section.title).expect("a string grows");
        for [name, default, about] in section.keys {
            let default = match default {
                "" => String::new(),
                "required" => " (required)".to_owned(),
                default => format!(" (default: {default})"),
            };
            let about = format!("{about}{default}").replace('`', "");
            write!(text, "\n    {name:<18} {about}").expect("a string grows");
        }
    }
    text
}

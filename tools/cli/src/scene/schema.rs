//! The tables of scene files. Their keys, with the kinds of values, defaults and meanings, are those of
//! [the guide](crate::guide::scenes), which is read here, and which `--help` prints.

use std::fmt::Write as _;

/// Keys that scene files once had, with their tables, and what to do without them.
pub(super) const REMOVED: [(&str, &str); 5] = [
    (
        "fabric.flexural_n_m2",
        "give `rigidity_n_m`, which is per width of the cloth",
    ),
    (
        "solver.newton_iterations",
        "leave it out; a shorter `dt_s` makes implicit steps more exact",
    ),
    (
        "solver.substeps",
        "give a `dt_s` that is as many times shorter",
    ),
    (
        "tear.delay_s",
        "leave it out; an edge tears in the step in which it reaches its threshold",
    ),
    ("tear.tears_held", "leave it out; held vertices do not tear"),
];

/// A table of a scene file, as the guide has it.
pub(super) struct Section {
    /// With brackets; two if it may stand more than once.
    pub(super) title: &'static str,
    /// Empty for the top.
    pub(super) table: &'static str,
    pub(super) keys: Vec<Key>,
}

/// A key of a table.
pub(super) struct Key {
    pub(super) name: &'static str,
    /// The kind of its value, or the words that it may be.
    pub(super) kind: &'static str,
    default: &'static str,
    about: &'static str,
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
                Key {
                    name: cell().trim_matches('`'),
                    kind: cell(),
                    default: cell(),
                    about: cell(),
                }
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
        let many = match section.is_list() {
            true => " (any number)",
            false => "",
        };
        write!(text, "\n  {}{many}", section.title).expect("a string grows");
        for key in section.keys {
            let default = match key.default {
                "" => String::new(),
                "required" => " (required)".to_owned(),
                default => format!(" (default: {default})"),
            };
            let about = format!("{}{default}", key.about).replace('`', "");
            write!(text, "\n    {:<18} {about}", key.name).expect("a string grows");
        }
    }
    text
}

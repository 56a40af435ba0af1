//! Every key that a scene file can have. Reading, checking, help and tests all go by this list.

use std::fmt::Write as _;

use super::axes::AXES;
use super::ready::NAMES;

/// A key of a scene file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Key {
    /// The table it stands in; empty for the top.
    pub(crate) table: &'static str,
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    /// What holds without it, and what it means.
    pub(crate) about: &'static str,
}

/// What a value can be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    /// A number above zero.
    Positive,
    /// A number from zero up.
    NotNegative,
    /// A number above one.
    Ratio,
    /// A number from zero to one.
    Part,
    /// A whole number from one up.
    Count,
    Bool,
    /// One of these words.
    Word(&'static [&'static str]),
    /// Two numbers, the first not above the second.
    Range,
    /// Two numbers.
    Pair,
    /// Three numbers.
    Vector,
    /// A number from zero up, or a vector of three numbers.
    NumberOrVector,
    /// Two rays as in --rays.
    Rays,
    /// Whole numbers from one up.
    Numbers,
    /// Fours of numbers; the first ascend.
    Moves,
}

impl Kind {
    /// In words.
    pub(crate) fn name(self) -> String {
        let words = match self {
            Kind::Positive => "a number above 0",
            Kind::NotNegative => "a number from 0 up",
            Kind::Ratio => "a number above 1",
            Kind::Part => "a number from 0 to 1",
            Kind::Count => "a whole number from 1 up",
            Kind::Bool => "true or false",
            Kind::Word(words) => return format!("one of {}", words.join(", ")),
            Kind::Range => "two ascending numbers",
            Kind::Pair => "two numbers",
            Kind::Vector => "three numbers",
            Kind::NumberOrVector => "a number from 0 up, or three",
            Kind::Rays => "two rays",
            Kind::Numbers => "numbers of vertices from 1 up",
            Kind::Moves => "seconds and three metres each, seconds ascending",
        };
        match self.example() {
            Some(example) => format!("{words}, as in {example}"),
            None => words.to_owned(),
        }
    }

    /// How a value is written that is more than a number or a word.
    fn example(self) -> Option<&'static str> {
        match self {
            Kind::Range => Some("[0, 0.5]"),
            Kind::Pair => Some("[0.5, 1]"),
            Kind::Vector => Some("[0, 1.5, 0]"),
            Kind::Rays => Some(r#"["0,2,5:0,0,-1", "0,-2,5:0,0,-1"]"#),
            Kind::Numbers => Some("[1, 33]"),
            Kind::Moves => Some("[[0, 0, 0, 0], [1, 0, -0.5, 0]]"),
            _ => None,
        }
    }
}

const fn key(table: &'static str, name: &'static str, kind: Kind, about: &'static str) -> Key {
    Key {
        table,
        name,
        kind,
        about,
    }
}

/// The tables that may stand more than once, as in `[[hold]]`.
pub(crate) const LISTS: [&str; 4] = ["collider", "hold", "cut", "strength"];

const METHODS: &[&str] = &["provot", "pbd", "verlet", "xpbd", "implicit"];
const CUTS: &[&str] = &["exact", "partition", "uniform", "alternating"];

/// Keys that scene files once had, by table, and what to do without them.
pub(crate) const REMOVED: [(&str, &str, &str); 3] = [
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

/// All keys, table by table.
#[rustfmt::skip]
pub(crate) const KEYS: [Key; 71] = [
    key("", "base", Kind::Word(&NAMES), "the scene to start from; fall: nothing is held"),
    key("", "seconds", Kind::NotNegative, "how long; of the base, fall 2"),
    key("", "up", Kind::Word(&AXES), "which way is up; y"),
    key("", "gravity_m_per_s2", Kind::NumberOrVector, "downward, or a vector; 9.81, trouser 0"),
    key("", "drag_per_s", Kind::NotNegative, "the rate at which velocities fade; 0.5, trouser 5"),

    key("fabric", "density_kg_per_m2", Kind::Positive, "0.15"),
    key("fabric", "stretch_n_per_m", Kind::Positive, "the stiffness of an edge; 1000, woven none"),
    key("fabric", "warp_n_per_m", Kind::Positive, "woven, of triangles: the modulus along the warp"),
    key("fabric", "weft_n_per_m", Kind::Positive, "woven: the modulus along the weft"),
    key("fabric", "shear_n_per_m", Kind::NotNegative, "woven: the modulus of shear; 0"),
    key("fabric", "warp", Kind::Vector, "woven: the direction of the warp at rest; up"),
    key("fabric", "bend_law", Kind::Word(&["spring", "buckling"]), "across an edge: a spring, or an arc that buckles; spring"),
    key("fabric", "bend_n_per_m", Kind::NotNegative, "spring: its stiffness; 0, none"),
    key("fabric", "flexural_n_m2", Kind::Positive, "buckling, required: bending moment by curvature"),
    key("fabric", "buckles_below", Kind::Part, "buckling: at this part of its length, above 0.592; 0.95"),
    key("fabric", "copies", Kind::Word(&["halved", "whole"]), "what both copies of a torn edge have; halved; the paper: whole"),
    key("fabric", "unbend", Kind::Word(&["seam", "vertex"]), "which of these a split takes; seam; the paper: vertex"),

    key("solver", "method", Kind::Word(METHODS), "verlet"),
    key("solver", "dt_s", Kind::Positive, "the step; see --dt"),
    key("solver", "substeps", Kind::Count, "xpbd: substeps a step; 1"),
    key("solver", "sweeps", Kind::Count, "xpbd, pbd: sweeps a (sub)step; 1, pbd 10"),
    key("solver", "stiffness", Kind::Part, "pbd: the part of an error a step corrects; 1"),
    key("solver", "bend_stiffness", Kind::Part, "pbd: the part of a bend's error; 0.1"),
    key("solver", "limit_ratio", Kind::Ratio, "provot: the longest the limiter leaves; 1.1"),
    key("solver", "limit_passes", Kind::Count, "provot: passes of the limiter; 20"),
    key("solver", "order", Kind::Word(&["1", "2"]), "implicit: backward Euler, or BDF2; \"1\""),
    key("solver", "tolerance", Kind::Positive, "implicit: a step's error of velocity, by dt^(order + 1); 10"),

    key("wind", "velocity_m_per_s", Kind::Vector, "required"),
    key("wind", "coefficient", Kind::NotNegative, "the force is this times area and normal speed, kg/(m2 s); 1.5"),
    key("wind", "sway_m_per_s", Kind::Vector, "added to and fro; none"),
    key("wind", "period_s", Kind::Positive, "of the sway; 1"),

    key("collider", "point", Kind::Vector, "of a plane"),
    key("collider", "normal", Kind::Vector, "of a plane; the cloth stays on its side"),
    key("collider", "centre", Kind::Vector, "of a ball"),
    key("collider", "radius_m", Kind::Positive, "of a ball"),

    key("hold", "near", Kind::Pair, "a place in parts of width and height: the nearest vertex"),
    key("hold", "radius", Kind::NotNegative, "and all within this part of the larger extent; 0"),
    key("hold", "across", Kind::Range, "between these parts of the width"),
    key("hold", "along", Kind::Range, "and these of the height; [0, 1] each"),
    key("hold", "from", Kind::Vector, "in a box, from this corner"),
    key("hold", "to", Kind::Vector, "to this one"),
    key("hold", "centre", Kind::Vector, "in a ball"),
    key("hold", "radius_m", Kind::NotNegative, "of this radius"),
    key("hold", "vertices", Kind::Numbers, "these, counted from 1 as in OBJ"),
    key("hold", "from_s", Kind::NotNegative, "when they are taken; 0"),
    key("hold", "until_s", Kind::Positive, "when they are let go; never"),
    key("hold", "moves", Kind::Moves, "at these seconds, how far from where they were taken"),

    key("cut", "at_s", Kind::NotNegative, "when; 0"),
    key("cut", "rays", Kind::Rays, "required"),
    key("cut", "through", Kind::Bool, "wherever the plane goes; false"),
    key("cut", "method", Kind::Word(CUTS), "exact"),

    key("tear", "never", Kind::Bool, "true: only cuts; false"),
    key("tear", "threshold", Kind::Ratio, "length by rest length; 1.5"),
    key("tear", "toughness_j_per_m", Kind::Positive, "or energy for each metre of tear"),
    key("tear", "threshold_n", Kind::Positive, "or the pull of an edge"),
    key("tear", "principal_stretch", Kind::Ratio, "or the stretch of a face in any direction"),
    key("tear", "threshold_warp", Kind::Ratio, "or as threshold, along the warp"),
    key("tear", "threshold_weft", Kind::Ratio, "and along the weft"),
    key("tear", "warp", Kind::Vector, "the direction of the warp at rest; up"),
    key("tear", "splits_per_step", Kind::Count, "at most, worst first; no limit"),
    key("tear", "weakening", Kind::Part, "what is left of the strength at the tips of a tear, above 0; 1"),

    key("strength", "factor", Kind::Positive, "required: how many times the threshold vertices bear"),
    key("strength", "near", Kind::Pair, "a place in parts of width and height: the nearest vertex"),
    key("strength", "radius", Kind::NotNegative, "and all within this part of the larger extent; 0"),
    key("strength", "across", Kind::Range, "between these parts of the width"),
    key("strength", "along", Kind::Range, "and these of the height; [0, 1] each"),
    key("strength", "from", Kind::Vector, "in a box, from this corner"),
    key("strength", "to", Kind::Vector, "to this one"),
    key("strength", "centre", Kind::Vector, "in a ball"),
    key("strength", "radius_m", Kind::NotNegative, "of this radius"),
    key("strength", "vertices", Kind::Numbers, "these, counted from 1 as in OBJ"),
];

/// The keys of a table.
pub(crate) fn keys_of(table: &str) -> impl Iterator<Item = &'static Key> {
    KEYS.iter().filter(move |key| key.table == table)
}

/// The tables, in order.
pub(crate) fn tables() -> Vec<&'static str> {
    let mut tables: Vec<_> = KEYS.iter().map(|key| key.table).collect();
    tables.dedup();
    tables
}

/// The schema in words, for `--help`.
pub(crate) fn schema() -> String {
    let mut text = String::from(
        "Scene files (TOML): all keys are optional but those marked; what stands last is the default,\n\
         or after `as` how a value is written.\n\
         Any [[hold]], [[cut]], [[strength]] or [[collider]] replace all of that kind that the base\n\
         has, and any [tear] lets the scene tear, also base = \"flag\", but for never = true.\n\
         Vertices count from 1 as in OBJ, without the last ones that lines `#~ fan` of a torn file name.\n",
    );
    for table in tables() {
        let title = match table {
            "" => "  at the top\n".to_owned(),
            list if LISTS.contains(&list) => format!("  [[{list}]] (any number)\n"),
            table => format!("  [{table}]\n"),
        };
        text.push_str(&title);
        for key in keys_of(table) {
            let example = key.kind.example();
            let example = example.map(|example| format!(", as {example}"));
            let (name, about, example) = (key.name, key.about, example.unwrap_or_default());
            writeln!(text, "    {name:<18} {about}{example}").expect("a string grows");
        }
    }
    text.pop();
    text
}

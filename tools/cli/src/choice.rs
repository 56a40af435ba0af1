//! Words that stand for values: on the command line, in scene files and in reports.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use tearmesh::{CutLayers, CutMethod, CutTips};
use tearmesh_cloth::scene::{Axis, Frame, Scene};
use tearmesh_cloth::{Copies, Method, Unbend, implicit};

/// A type of which users choose a value by a word.
pub(crate) trait Choice: Copy + Send + Sync + 'static {
    /// Each word and its value, in the order in which they are listed.
    const ALL: &'static [(&'static str, Self)];

    /// The words on each value in `--help`, if there are any.
    const HELP: &'static [&'static str] = &[];

    /// The value of a word.
    fn of(word: &str) -> Option<Self> {
        let mut all = Self::ALL.iter();
        all.find(|(one, _)| *one == word).map(|&(_, value)| value)
    }

    /// The word for a value.
    fn word(&self) -> &'static str
    where
        Self: PartialEq,
    {
        let mut all = Self::ALL.iter();
        all.find(|(_, one)| one == self)
            .map_or("", |(word, _)| word)
    }

    /// All words, with commas between them.
    fn words() -> String {
        let words: Vec<_> = Self::ALL.iter().map(|(word, _)| *word).collect();
        words.join(", ")
    }

    /// Reads a word on the command line.
    fn parser() -> impl TypedValueParser<Value = Self> {
        let values = Self::ALL.iter().enumerate().map(|(i, (word, _))| {
            let value = PossibleValue::new(*word);
            match Self::HELP.get(i) {
                Some(help) => value.help(*help),
                None => value,
            }
        });
        let words = PossibleValuesParser::new(values);
        words.map(|word| Self::of(&word).expect("the parser knows no other word"))
    }
}

impl Choice for CutMethod {
    const ALL: &'static [(&'static str, CutMethod)] = &[
        ("exact", CutMethod::Exact),
        ("partition", CutMethod::Partition),
        ("uniform", CutMethod::Uniform),
        ("alternating", CutMethod::Alternating),
    ];
    const HELP: &'static [&'static str] = &[
        "Insert vertices where the plane crosses edges: a straight seam",
        "Split the edges between the faces of either side; adds no face",
        "The paper's first method: leaves irregular meshes undivided",
        "The paper's better method: leaves crumbs, and a long seam",
    ];
}

impl Choice for CutTips {
    const ALL: &'static [(&'static str, CutTips)] =
        &[("vertex", CutTips::Vertex), ("midpoint", CutTips::Midpoint)];
}

impl Choice for CutLayers {
    const ALL: &'static [(&'static str, CutLayers)] =
        &[("all", CutLayers::All), ("first", CutLayers::First)];
}

/// A method of simulation with its default settings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solver(pub(crate) fn() -> Method);

impl Choice for Solver {
    const ALL: &'static [(&'static str, Solver)] = &[
        (Method::NAMES[0], Solver(Method::provot)),
        (Method::NAMES[1], Solver(Method::pbd)),
        (Method::NAMES[2], Solver(|| Method::Verlet)),
        (Method::NAMES[3], Solver(Method::xpbd)),
        (Method::NAMES[4], Solver(Method::implicit)),
    ];
}

/// A scene that is built in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Preset(pub(crate) fn(&Frame) -> Scene);

impl Choice for Preset {
    const ALL: &'static [(&'static str, Preset)] = &[
        ("hang", Preset(Scene::hang)),
        ("flag", Preset(Scene::flag)),
        ("rip", Preset(Scene::rip)),
        ("trouser", Preset(Scene::trouser)),
        ("fall", Preset(|frame| Scene::fall(frame.up))),
    ];
}

impl Choice for Axis {
    const ALL: &'static [(&'static str, Axis)] = &[
        ("x", Axis::X),
        ("y", Axis::Y),
        ("z", Axis::Z),
        ("-x", Axis::X.opposite()),
        ("-y", Axis::Y.opposite()),
        ("-z", Axis::Z.opposite()),
    ];
}

/// Reads an axis, as it is typed.
pub(crate) fn axis(text: &str) -> Result<Axis, String> {
    Axis::of(text).ok_or_else(|| format!("expected one of {}", Axis::words()))
}

/// The law of bending: springs, or arcs that buckle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BendLaw {
    Spring,
    Buckling,
}

impl Choice for BendLaw {
    const ALL: &'static [(&'static str, BendLaw)] =
        &[("spring", BendLaw::Spring), ("buckling", BendLaw::Buckling)];
}

impl Choice for Copies {
    const ALL: &'static [(&'static str, Copies)] =
        &[("halved", Copies::Halved), ("whole", Copies::Whole)];
}

impl Choice for Unbend {
    const ALL: &'static [(&'static str, Unbend)] =
        &[("seam", Unbend::Seam), ("vertex", Unbend::Vertex)];
}

/// The order of an implicit method.
impl Choice for implicit::Method {
    const ALL: &'static [(&'static str, implicit::Method)] = &[
        ("1", implicit::Method::BackwardEuler),
        ("2", implicit::Method::Bdf2),
    ];
}

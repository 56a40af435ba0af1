//! Words that stand for values on the command line and in reports.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use tearmesh::{CutLayers, CutMethod, CutTips};
use tearmesh_cloth::Method;
use tearmesh_cloth::scene::file::Words;
use tearmesh_cloth::scene::{Axis, Preset};

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
        let found = all.find(|(_, one)| one == self);
        found.map_or("", |(word, _)| word)
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
    const ALL: &'static [(&'static str, CutMethod)] = <CutMethod as Words>::ALL;
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

impl Choice for Preset {
    const ALL: &'static [(&'static str, Preset)] = <Preset as Words>::ALL;
}

impl Choice for Axis {
    const ALL: &'static [(&'static str, Axis)] = <Axis as Words>::ALL;
}

/// Reads the name of a method on the command line.
pub(crate) fn method() -> impl TypedValueParser<Value = Method> {
    let names = PossibleValuesParser::new(Method::NAMES);
    names.map(|name| Method::named(&name).expect("the parser knows no other name"))
}

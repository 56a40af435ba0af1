//! The words of scene files.

use std::fmt;
use std::ops::Deref;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use tearmesh::CutMethod;

use super::number::OUT_OF_RANGE;
use crate::cloth::fabric::{BendRemoval, TornStiffness};
use crate::method::{Method, implicit};
use crate::scene::Scene;
use crate::scene::frame::Axis;
use crate::scene::presets::Preset;

/// A type of which people choose a value by a word.
pub trait Words: Copy + 'static {
    /// Each word and its value, in the order in which they are listed.
    const ALL: &'static [(&'static str, Self)];
}

/// A value that is written as a word.
#[derive(Clone, Copy, PartialEq)]
pub struct Word<T>(T);

impl<T> Deref for Word<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T> fmt::Debug for Word<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Word(..)")
    }
}

impl<'de, T: Words> Deserialize<'de> for Word<T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Word<T>, D::Error> {
        let word = String::deserialize(from)?;
        let found = T::ALL.iter().find(|(one, _)| *one == word);
        let known = found.map(|&(_, value)| Word(value));
        known.ok_or_else(|| {
            let words: Vec<&str> = T::ALL.iter().map(|(word, _)| *word).collect();
            D::Error::custom(format!(
                "{OUT_OF_RANGE}: it is none of {}",
                words.join(", ")
            ))
        })
    }
}

/// The resistance to bending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BendLaw {
    /// A spring across each edge.
    Spring,
    /// An arc across each edge, which buckles.
    Buckling,
}

impl Words for BendLaw {
    const ALL: &'static [(&'static str, BendLaw)] =
        &[("spring", BendLaw::Spring), ("buckling", BendLaw::Buckling)];
}

impl Words for Preset {
    const ALL: &'static [(&'static str, Preset)] = &Scene::PRESETS;
}

impl Words for Axis {
    const ALL: &'static [(&'static str, Axis)] = &Axis::NAMED;
}

/// Methods with their default settings.
impl Words for fn() -> Method {
    const ALL: &'static [(&'static str, fn() -> Method)] = &[
        ("provot", Method::provot),
        ("pbd", Method::pbd),
        ("verlet", || Method::Verlet),
        ("xpbd", Method::xpbd),
        ("implicit", Method::implicit),
    ];
}

impl Words for CutMethod {
    const ALL: &'static [(&'static str, CutMethod)] = &[
        ("exact", CutMethod::Exact),
        ("partition", CutMethod::Partition),
        ("uniform", CutMethod::Uniform),
        ("alternating", CutMethod::Alternating),
    ];
}

impl Words for TornStiffness {
    const ALL: &'static [(&'static str, TornStiffness)] = &[
        ("halved", TornStiffness::Halved),
        ("whole", TornStiffness::Whole),
    ];
}

impl Words for BendRemoval {
    const ALL: &'static [(&'static str, BendRemoval)] =
        &[("seam", BendRemoval::Seam), ("vertex", BendRemoval::Vertex)];
}

/// The order of an implicit method.
impl Words for implicit::Method {
    const ALL: &'static [(&'static str, implicit::Method)] = &[
        ("1", implicit::Method::BackwardEuler),
        ("2", implicit::Method::Bdf2),
    ];
}

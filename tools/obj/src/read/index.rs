//! Indices: what they count, and from where.

use std::ops::Range;

use super::fault::{Fault, Parsed};

/// The largest index: [`tearmesh::Mesh::MAX_VERTICES`].
const INDEX_MAX: i64 = 1 << 31;

/// What an index counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Element {
    Vertex,
    Texture,
    Normal,
}

impl Element {
    pub(super) const ALL: [Element; 3] = [Element::Vertex, Element::Texture, Element::Normal];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Element::Vertex => "vertex",
            Element::Texture => "texture coordinate",
            Element::Normal => "normal",
        }
    }

    pub(super) const fn plural(self) -> &'static str {
        match self {
            Element::Vertex => "vertices",
            Element::Texture => "texture coordinates",
            Element::Normal => "normals",
        }
    }
}

/// An index as counted from 1 from the start of the file, with `count` elements so far.
/// It may lie beyond them.
#[cold]
pub(super) fn absolute(
    given: i64,
    count: usize,
    element: Element,
    span: &Range<usize>,
) -> Parsed<u32> {
    let what = element.name();
    if given == 0 {
        return Err(Fault::new(
            "E-OBJ-ZERO",
            span.clone(),
            format!("{what} 0 does not exist: OBJ counts from 1"),
            "expected 1 or more, or a negative index to count back",
        )
        .help("if the program that wrote this counts from 0, add 1 to every index"));
    }
    if given > INDEX_MAX {
        return Err(Fault::new(
            "E-OBJ-RANGE",
            span.clone(),
            format!("{what} index beyond the limit of {INDEX_MAX}"),
            "too large",
        ));
    }
    let absolute = if given > 0 {
        given
    } else {
        given.saturating_add(count as i64 + 1)
    };
    if absolute > 0 {
        return Ok(absolute as u32);
    }
    let (message, label) = match count {
        0 => (
            format!("{what} {given} does not exist: there are none before this line"),
            "expected an index that does not count back".to_owned(),
        ),
        _ => (
            format!("{what} {given} does not exist: there are {count} before this line"),
            format!("expected -{count} to -1"),
        ),
    };
    Err(Fault::new("E-OBJ-RANGE", span.clone(), message, label)
        .help("a negative index counts back from its own statement"))
}

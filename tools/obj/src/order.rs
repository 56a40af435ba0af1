//! In which order the statements of a kind are written, and under which numbers.
//!
//! Elements are vertices, texture coordinates or normals, counted as the mesh or the lists of the
//! document count them. Some are statements of the document, and are written in their turn;
//! the others are added behind a section of the document (`sections.rs`).

/// Where an element is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turn {
    /// It is this statement of the document.
    Own(u32),
    /// It is added behind the first `behind` statements of the document. Among those added at the
    /// same place, the lowest rank comes first.
    Added { behind: u32, rank: u64 },
}

/// An element that is no statement of the document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Added {
    /// How many statements of the document come before it.
    pub(crate) behind: u32,
    rank: u64,
    pub(crate) element: u32,
}

/// The statements of a kind in the order of writing.
#[derive(Debug)]
pub(crate) struct Order {
    /// The number in the file of each element, from 0.
    numbers: Vec<u32>,
    /// The element that each statement of the document is, or [`NONE`].
    elements: Vec<u32>,
    /// In the order of writing.
    added: Vec<Added>,
}

const NONE: u32 = u32::MAX;

impl Order {
    /// The order of elements with these turns, in a document with a given number of statements.
    pub(crate) fn new(statements: usize, turns: impl Iterator<Item = Turn>) -> Order {
        let mut elements = vec![NONE; statements];
        let mut added = Vec::new();
        let mut count = 0;
        for (turn, element) in turns.zip(0..) {
            count += 1;
            match turn {
                Turn::Own(statement) => elements[statement as usize] = element,
                Turn::Added { behind, rank } => added.push(Added {
                    behind,
                    rank,
                    element,
                }),
            }
        }
        added.sort_unstable();
        let mut order = Order {
            numbers: vec![NONE; count],
            elements,
            added,
        };
        for (element, number) in order.in_order().into_iter().zip(0..) {
            order.numbers[element as usize] = number;
        }
        order
    }

    /// How many are written.
    pub(crate) fn count(&self) -> usize {
        self.numbers.len()
    }

    /// The number in the file of an element that is written, from 0.
    #[inline]
    pub(crate) fn number(&self, element: u32) -> u32 {
        self.numbers[element as usize]
    }

    /// The element that a statement of the document is, if it is written.
    #[inline]
    pub(crate) fn element(&self, statement: u32) -> Option<u32> {
        Some(self.elements[statement as usize]).filter(|&element| element != NONE)
    }

    /// What is added, in the order of writing.
    pub(crate) fn added(&self) -> &[Added] {
        &self.added
    }

    /// The elements, in the order of writing.
    pub(crate) fn in_order(&self) -> Vec<u32> {
        let mut order = Vec::with_capacity(self.count());
        let mut left = self.added.iter().peekable();
        for (&element, statement) in self.elements.iter().zip(0..) {
            while let Some(first) = left.next_if(|first| first.behind <= statement) {
                order.push(first.element);
            }
            order.extend(Some(element).filter(|&element| element != NONE));
        }
        order.extend(left.map(|last| last.element));
        order
    }
}

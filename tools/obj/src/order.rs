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
    /// The number in the file of each element, from 0, or [`NONE`] for what is left out. `None` if
    /// every statement of the document is written, nothing is added, and numbers stay.
    numbers: Option<Vec<u32>>,
    /// The element that each statement of the document is, or [`NONE`]; `None` if each is the element
    /// of its number.
    elements: Option<Vec<u32>>,
    /// In the order of writing.
    added: Vec<Added>,
    count: usize,
}

const NONE: u32 = u32::MAX;

impl Order {
    /// The order of `count` statements of a document, with nothing added or left out.
    pub(crate) fn of_document(count: usize) -> Order {
        Order {
            numbers: None,
            elements: None,
            added: Vec::new(),
            count,
        }
    }

    /// The order of elements, each of which has its turn or is left out, in a document with a given
    /// number of statements.
    pub(crate) fn new(
        statements: usize,
        elements: usize,
        turns: impl Iterator<Item = Option<Turn>>,
    ) -> Order {
        let mut numbers = vec![NONE; elements];
        let mut elements = vec![NONE; statements];
        let mut added = Vec::new();
        for (turn, element) in turns.zip(0..) {
            match turn {
                Some(Turn::Own(statement)) => elements[statement as usize] = element,
                Some(Turn::Added { behind, rank }) => added.push(Added {
                    behind,
                    rank,
                    element,
                }),
                None => {}
            }
        }
        added.sort_unstable();
        let mut count = 0;
        let mut number = |element: u32| {
            numbers[element as usize] = count;
            count += 1;
        };
        let mut left = added.iter().peekable();
        for (&element, statement) in elements.iter().zip(0..) {
            while let Some(first) = left.next_if(|first| first.behind <= statement) {
                number(first.element);
            }
            if element != NONE {
                number(element);
            }
        }
        left.for_each(|last| number(last.element));
        Order {
            count: count as usize,
            numbers: Some(numbers),
            elements: Some(elements),
            added,
        }
    }

    /// How many are written.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// The number in the file of an element that is written, from 0.
    #[inline]
    pub(crate) fn number(&self, element: u32) -> u32 {
        let numbers = self.numbers.as_ref();
        numbers.map_or(element, |numbers| numbers[element as usize])
    }

    pub(crate) fn has(&self, element: u32) -> bool {
        self.number(element) != NONE
    }

    /// The element that a statement of the document is, if it is written.
    #[inline]
    pub(crate) fn element(&self, statement: u32) -> Option<u32> {
        let Some(elements) = &self.elements else {
            return Some(statement);
        };
        Some(elements[statement as usize]).filter(|&element| element != NONE)
    }

    /// What is added, in the order of writing.
    pub(crate) fn added(&self) -> &[Added] {
        &self.added
    }

    /// The elements that are written, in order.
    pub(crate) fn in_order(&self) -> Vec<u32> {
        let Some(numbers) = &self.numbers else {
            return (0..self.count as u32).collect();
        };
        let mut order = vec![NONE; self.count];
        for (&number, element) in numbers.iter().zip(0..) {
            if number != NONE {
                order[number as usize] = element;
            }
        }
        order
    }
}

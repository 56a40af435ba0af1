//! Vertices that slid along an edge: what they were before, and what they were then.
//!
//! A slide moves a vertex and interpolates what it has: its extra numbers, and the texture
//! coordinates and normals of its corners, which get indices of their own. No arithmetic undoes that
//! to the last bit, so both are on record. Those after tell whether anybody edited the vertex
//! since.

use crate::store::{Rows, push};

/// Slides in the order in which they were made.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Slides {
    of: Vec<Slid>,
    /// For each, what its `v` had before, and behind that as many numbers that it had then.
    numbers: Rows,
    exchanges: Vec<Exchange>,
    /// What the new index of each exchange names.
    values: Rows,
}

/// A vertex that slid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Slid {
    pub(crate) vertex: u32,
    pub(crate) cut: u32,
    exchanges_end: u32,
}

/// A texture coordinate (0) or a normal (1) that corners of a vertex got for another when it slid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Exchange {
    pub(crate) which: usize,
    pub(crate) new: u32,
    pub(crate) old: u32,
}

impl Slides {
    pub(crate) fn len(&self) -> usize {
        self.of.len()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.of.is_empty()
    }

    /// Whether there may be no room for another.
    pub(crate) fn is_full(&self) -> bool {
        let most = Rows::LIMIT - 64;
        self.numbers.value_count() > most || self.values.value_count() > most
    }

    pub(crate) fn iter(&self) -> impl DoubleEndedIterator<Item = Slid> + ExactSizeIterator + '_ {
        self.of.iter().copied()
    }

    pub(crate) fn get(&self, slide: usize) -> Slid {
        self.of[slide]
    }

    /// Appends a slide of a vertex, with what its `v` had before and what it had then: as many
    /// numbers.
    pub(crate) fn push(&mut self, vertex: u32, cut: u32, numbers: &[f64]) {
        self.numbers.set(self.of.len(), numbers);
        let slid = Slid {
            vertex,
            cut,
            exchanges_end: self.exchanges.len() as u32,
        };
        push(&mut self.of, slid);
    }

    /// Appends an exchange to the last slide, if there is one.
    pub(crate) fn push_exchange(&mut self, exchange: Exchange, value: &[f64]) {
        if let Some(last) = self.of.last_mut() {
            self.values.set(self.exchanges.len(), value);
            push(&mut self.exchanges, exchange);
            last.exchanges_end = self.exchanges.len() as u32;
        }
    }

    /// Both halves: what a `v` had before, and what it had then.
    pub(crate) fn numbers(&self, slide: usize) -> &[f64] {
        self.numbers.row(slide)
    }

    /// What a `v` had before.
    pub(crate) fn before(&self, slide: usize) -> &[f64] {
        let numbers = self.numbers(slide);
        &numbers[..numbers.len() / 2]
    }

    /// What a `v` had when it had slid.
    pub(crate) fn after(&self, slide: usize) -> &[f64] {
        let numbers = self.numbers(slide);
        &numbers[numbers.len() / 2..]
    }

    /// What became of indices, each with what the new one names.
    pub(crate) fn exchanges(
        &self,
        slide: usize,
    ) -> impl DoubleEndedIterator<Item = (Exchange, &[f64])> {
        let before = slide.checked_sub(1).map(|before| self.of[before]);
        let first = before.map_or(0, |before| before.exchanges_end) as usize;
        let all = first..self.of[slide].exchanges_end as usize;
        all.map(|i| (self.exchanges[i], self.values.row(i)))
    }

    /// The slides that stay, with vertices and indices renamed; `None` for one that does not.
    pub(crate) fn filtered(
        &self,
        vertex: impl Fn(usize, u32) -> Option<u32>,
        index: impl Fn(usize, u32) -> u32,
    ) -> Slides {
        let mut slides = Slides::default();
        for (slide, slid) in self.iter().enumerate() {
            let Some(vertex) = vertex(slide, slid.vertex) else {
                continue;
            };
            slides.push(vertex, slid.cut, self.numbers(slide));
            for (exchange, value) in self.exchanges(slide) {
                let [new, old] = [exchange.new, exchange.old].map(|of| index(exchange.which, of));
                let which = exchange.which;
                slides.push_exchange(Exchange { which, new, old }, value);
            }
        }
        slides
    }
}

//! What vertices were before they slid.
//!
//! An inserted vertex was put between others as they were then, and is compared with that; so is a
//! vertex with what its last slide left it as. Where it has something else now, it was edited since,
//! and what it was before that nobody knows.

use tearmesh::Positions;

use super::TornDocument;
use crate::slides::Slides;

/// A corner of a face and the vertex there.
#[derive(Clone, Copy, Debug)]
pub(super) struct CornerAt {
    pub(super) half_edge: usize,
    pub(super) vertex: usize,
}

/// A moment in the order of cuts: before those of a cut that slide vertices, or behind them.
pub(super) type Moment = u64;

/// The moment before the slides of a cut.
pub(super) fn before_slides(cut: u32) -> Moment {
    2 * Moment::from(cut)
}

/// The moment behind the slides of a cut.
pub(super) fn behind_slides(cut: u32) -> Moment {
    before_slides(cut) + 1
}

/// A torn document and its vertices as they are, and as they were.
pub(super) struct Past<'t> {
    pub(super) torn: &'t TornDocument<'t>,
    positions: &'t Positions,
    pub(super) slides: Slides,
    /// The numbers of slides, by vertex and then as they were made.
    by_vertex: Vec<(u32, u32)>,
    /// Whether a vertex is, but for later slides, as each one left it.
    is_intact: Vec<bool>,
}

impl<'t> Past<'t> {
    pub(super) fn new(torn: &'t TornDocument<'t>, positions: &'t Positions) -> Past<'t> {
        let slides = torn.slides();
        let vertices = slides.iter().zip(0..).map(|(slid, i)| (slid.vertex, i));
        let mut by_vertex: Vec<(u32, u32)> = vertices.collect();
        by_vertex.sort_unstable();
        let mut past = Past {
            torn,
            positions,
            is_intact: vec![false; slides.len()],
            slides,
            by_vertex,
        };
        past.find_intact();
        past
    }

    fn find_intact(&mut self) {
        for of_vertex in self.by_vertex.chunk_by(|a, b| a.0 == b.0) {
            let vertex = of_vertex[0].0 as usize;
            let at = self.positions.as_slice()[vertex];
            let extras = self.torn.extra_numbers(vertex).iter().copied();
            let mut is: Vec<f64> = [at.x, at.y, at.z].into_iter().chain(extras).collect();
            for &(_, slide) in of_vertex.iter().rev() {
                let slide = slide as usize;
                let is_as_left = are_same(&is, self.slides.after(slide))
                    && self.slides.exchanges(slide).all(|(exchange, value)| {
                        are_same(&self.torn.value(exchange.which, exchange.new), value)
                    });
                if !is_as_left {
                    break; // What it was before, nobody knows.
                }
                self.is_intact[slide] = true;
                is = self.slides.before(slide).to_vec();
            }
        }
    }

    /// Whether a vertex is, but for later slides, as this one left it.
    pub(super) fn is_intact(&self, slide: usize) -> bool {
        self.is_intact[slide]
    }

    /// The slides of a vertex, by their numbers, as they were made.
    pub(super) fn of(&self, vertex: usize) -> impl DoubleEndedIterator<Item = usize> + '_ {
        let all = &self.by_vertex;
        let first = all.partition_point(|&(other, _)| (other as usize) < vertex);
        let end = all.partition_point(|&(other, _)| other as usize <= vertex);
        all[first..end].iter().map(|&(_, slide)| slide as usize)
    }

    /// The slides of a vertex after a moment.
    pub(super) fn after(
        &self,
        vertex: usize,
        moment: Moment,
    ) -> impl DoubleEndedIterator<Item = usize> + '_ {
        let is_later = move |&slide: &usize| behind_slides(self.slides.get(slide).cut) > moment;
        self.of(vertex).filter(is_later)
    }

    /// What a vertex was slid from first of all after a moment, as far as is known.
    fn before(&self, vertex: usize, moment: Moment) -> Option<&[f64]> {
        let mut known = self
            .after(vertex, moment)
            .filter(|&slide| self.is_intact[slide]);
        known.next().map(|slide| self.slides.before(slide))
    }

    pub(super) fn place(&self, corner: CornerAt, moment: Moment) -> [f64; 3] {
        match self.before(corner.vertex, moment) {
            Some(&[x, y, z, ..]) => [x, y, z],
            _ => self.positions.as_slice()[corner.vertex].into(),
        }
    }

    pub(super) fn extra_numbers(&self, corner: CornerAt, moment: Moment) -> &[f64] {
        match self.before(corner.vertex, moment) {
            Some([_, _, _, extras @ ..]) => extras,
            _ => self.torn.extra_numbers(corner.vertex),
        }
    }

    /// The texture coordinate (0) or the normal (1) of a corner at a moment.
    pub(super) fn index(&self, corner: CornerAt, which: usize, moment: Moment) -> Option<u32> {
        let undone = |slide: usize| behind_slides(self.slides.get(slide).cut) > moment;
        self.index_without(corner, which, undone)
    }

    /// The texture coordinate (0) or the normal (1) of a corner before some of the slides.
    pub(super) fn index_without(
        &self,
        corner: CornerAt,
        which: usize,
        undone: impl Fn(usize) -> bool,
    ) -> Option<u32> {
        let mut index = self.torn.corner_of(corner.half_edge)[which]?;
        for slide in self.of(corner.vertex).rev().filter(|&slide| undone(slide)) {
            for (exchange, _) in self.slides.exchanges(slide) {
                if exchange.which == which && exchange.new == index {
                    index = exchange.old;
                    break;
                }
            }
        }
        Some(index)
    }
}

/// Whether numbers are the same to the bit.
fn are_same(some: &[f64], others: &[f64]) -> bool {
    let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    bits(some) == bits(others)
}

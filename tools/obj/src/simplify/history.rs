//! What vertices had before they slid, and whether inserted ones are still as they were inserted.
//!
//! The record says where a vertex was inserted: between which vertices, and how far along. Its position
//! follows from the numbers that these had then, and so do its extra numbers, its texture coordinates
//! and its normals. A vertex that has others was edited since, by whichever program, and removing it
//! would lose that. If one of these vertices slid later, the record has what it had before, unless it
//! was edited since.
//!
//! The numbers of a file that we wrote read back as the same bits, so what nobody touched differs by
//! the rounding of a few operations at most. If another program rounded all numbers, to six digits say,
//! every vertex was edited in this sense: how much that program meant to round is unknown, and to keep a
//! vertex is no loss. The same holds if an end of the edge was moved.

use std::collections::BTreeMap;

use crate::document::Document;
use crate::record::{Exchange, Inserted, Record, Slid, are_same};
use crate::torn::{length, normal_between, numbers_between};

/// By how many units of the last place of the largest number concerned a number may differ: an
/// interpolation rounds three times, whichever end it begins at, and so does the mean of
/// two copies that are merged.
const ROUNDINGS: f64 = 8.0;

/// A document as it was before the slides of some cuts. Corners are those of all faces, by half-edge.
pub(super) struct History<'d> {
    document: &'d Document,
    pub(super) slides: &'d [Slid],
    /// The root of each vertex.
    pub(super) roots: Vec<u32>,
    /// The slides of the vertices of each root, as they were made.
    by_root: BTreeMap<u32, Vec<usize>>,
    /// Whether a vertex is, but for later slides, as each one left it.
    pub(super) is_intact: Vec<bool>,
}

impl<'d> History<'d> {
    pub(super) fn new(document: &'d Document, record: &'d Record) -> History<'d> {
        let slides = &record.slides;
        let roots = record.roots(document.positions.len());
        let mut by_root: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (slide, slid) in slides.iter().enumerate() {
            let of_root = by_root.entry(roots[slid.vertex as usize]).or_default();
            of_root.push(slide);
        }
        let mut history = History {
            document,
            slides,
            roots,
            by_root,
            is_intact: vec![false; slides.len()],
        };
        for slide in (0..slides.len()).rev() {
            history.is_intact[slide] = history.is_as_left(slide);
        }
        history
    }

    /// Whether a vertex is, but for later slides, as this one left it.
    fn is_as_left(&self, slide: usize) -> bool {
        let slid = &self.slides[slide];
        let later = self.of(slid.vertex).find(|&later| later > slide);
        let is = match later {
            Some(later) if !self.is_intact[later] => return false, // What it was before, nobody knows.
            Some(later) => self.slides[later].before().to_vec(),
            None => self.document.numbers(slid.vertex as usize),
        };
        let is_kept = |exchange: &Exchange| {
            let value = self.document.value(exchange.which, exchange.new);
            are_same(value, &exchange.value)
        };
        are_same(&is, slid.after()) && slid.exchanges.iter().all(is_kept)
    }

    /// The slides of the vertices of a root.
    pub(super) fn of_root(&self, root: u32) -> impl DoubleEndedIterator<Item = usize> + '_ {
        self.by_root.get(&root).into_iter().flatten().copied()
    }

    /// The slides of a vertex.
    pub(super) fn of(&self, vertex: u32) -> impl DoubleEndedIterator<Item = usize> + '_ {
        let slides = self.of_root(self.roots[vertex as usize]);
        slides.filter(move |&slide| self.slides[slide].vertex == vertex)
    }

    fn vertex(&self, corner: usize) -> u32 {
        self.document.polygons.vertices[corner]
    }

    /// The root at a corner.
    pub(super) fn root(&self, corner: usize) -> u32 {
        self.roots[self.vertex(corner) as usize]
    }

    /// The numbers of the `v` at a corner before the slides of a cut and later ones, as far as is known.
    fn numbers(&self, corner: usize, since: u32) -> Vec<f64> {
        let vertex = self.vertex(corner);
        let mut known = self.of(vertex).filter(|&slide| self.is_intact[slide]);
        match known.find(|&slide| self.slides[slide].cut >= since) {
            Some(first) => self.slides[first].before().to_vec(),
            None => self.document.numbers(vertex as usize),
        }
    }

    /// The texture coordinate and the normal of a corner before some of the slides.
    pub(super) fn indices(
        &self,
        corner: usize,
        is_undone: impl Fn(usize) -> bool,
    ) -> [Option<u32>; 2] {
        let mut indices = self.document.polygons.indices(corner);
        let slides = self.of(self.vertex(corner)).rev();
        for slide in slides.filter(|&slide| is_undone(slide)) {
            for exchange in &self.slides[slide].exchanges {
                let index = &mut indices[exchange.which];
                if *index == Some(exchange.new) {
                    *index = Some(exchange.old);
                }
            }
        }
        indices
    }

    /// Whether the vertex at a corner is as it was inserted before the slides of a cut, between corners of
    /// parts of one face. `None` of these is known if the record does not fit.
    pub(super) fn is_as_inserted(
        &self,
        corner: usize,
        inserted: &Inserted,
        since: u32,
        end: impl Fn(u32) -> Option<usize>,
    ) -> bool {
        let weights = inserted.weights;
        let [Some(a), Some(b), Some(c)] = inserted.between.map(end) else {
            return false;
        };

        let is = self.numbers(corner, since);
        let rows = [a, b, c].map(|source| self.numbers(source, since));
        // There are no extra numbers between rows of different lengths.
        let are_alike = rows.iter().all(|row| row.len() == rows[0].len());
        let count = if are_alike { rows[0].len() } else { 3 };
        let rows = rows.each_ref().map(|row| &row[..count]);
        if is.len() != count || !is_between(&is, rows, weights) {
            return false;
        }
        let is_undone = |slide: usize| self.slides[slide].cut >= since;
        [0, 1].into_iter().all(|which| {
            let index = |corner| self.indices(corner, is_undone)[which];
            let value = |index| self.document.value(which, index);
            let ([Some(a), Some(b), Some(c)], Some(is)) = ([a, b, c].map(index), index(corner))
            else {
                let has_none = [a, b, c].map(index).contains(&None);
                return has_none && index(corner).is_none();
            };
            let rows = [a, b, c].map(value);
            match which {
                0 => is_between(value(is), rows, weights),
                _ => is_normal_between(value(is), rows, weights),
            }
        })
    }
}

/// Whether each number is, but for rounding, the weighted sum of those of the sources; a number that
/// a row has not counts as 0, as it does for texture coordinates.
fn is_between(is: &[f64], rows: [&[f64]; 3], weights: [f64; 3]) -> bool {
    let between = numbers_between(rows, weights);
    (0..is.len().max(between.len())).all(|i| {
        let at = |row: &[f64]| row.get(i).copied().unwrap_or(0.0);
        let largest = rows.iter().map(|row| at(row).abs()).fold(0.0, f64::max);
        (at(is) - at(&between)).abs() <= ROUNDINGS * f64::EPSILON * largest
    })
}

/// Whether a normal is, but for rounding, in the direction between others, and as long as
/// between them. Where these cancel each other it is one of them.
fn is_normal_between(is: &[f64], normals: [&[f64]; 3], weights: [f64; 3]) -> bool {
    let (sum, wanted) = normal_between(normals, weights);
    let scale = wanted / length(&sum);
    if !scale.is_finite() {
        return normals.contains(&is);
    }
    // Where they nearly cancel, the direction of what is left is rounding, and says nothing.
    let largest = normals.map(length).into_iter().fold(0.0, f64::max);
    let allowed = ROUNDINGS * f64::EPSILON * largest * scale.max(1.0);
    let mut axes = is.iter().zip(&sum);
    allowed >= wanted || axes.all(|(is, sum)| (is - sum * scale).abs() <= allowed)
}

//! Whether an inserted vertex is still as it was inserted.
//!
//! The record says where a vertex was inserted: between which vertices, and how far along. That
//! place follows from the numbers that these had then, and so do the extra numbers, the
//! texture coordinates and the normals there. A vertex that has others was edited since, by
//! whichever program, and taking it out would lose that.
//!
//! The numbers of a file that we wrote read back as the same bits, so what nobody touched differs by
//! the rounding of a few operations at most, and by nothing else. Where another program rounded all
//! numbers, to six digits say, every vertex was edited in this sense: how much it meant to round
//! is not to be known, and to keep a vertex is no loss. The same holds where an end of the edge was
//! moved. Where a later cut slid one of them, or the vertex, what they were before is known
//! (`past.rs`).

use super::corners::{blend, length};
use super::past::{CornerAt, Moment, Past};
use crate::record::At;

/// By how many units of the last place of the largest number concerned a number may differ: an
/// interpolation rounds three times, whichever end it begins at, and so does the mean of
/// two copies that are merged.
const ROUNDINGS: f64 = 8.0;

/// Sources of an inserted value, with their weights.
type Sources<T> = [(T, f64); 3];

impl Past<'_> {
    /// Whether a corner is that of a vertex as it was inserted at a place and a moment, `None` of
    /// whose ends are known if the record does not fit; all of them are corners of parts of one
    /// face.
    pub(super) fn is_as_inserted(
        &self,
        corner: CornerAt,
        at: &At,
        moment: Moment,
        end: impl Fn(u32) -> Option<CornerAt>,
    ) -> bool {
        let sources = match *at {
            At::Edge { ends: [a, b], t } => [(a, 1.0 - t), (b, t), (b, 0.0)],
            At::Face {
                corners: [a, b, c],
                weights: [u, v, w],
            } => [(a, u), (b, v), (c, w)],
        };
        let [Some(a), Some(b), Some(c)] = sources.map(|(class, _)| end(class)) else {
            return false;
        };
        let weights = sources.map(|(_, weight)| weight);
        let with = |corners: [CornerAt; 3]| [0, 1, 2].map(|i| (corners[i], weights[i]));
        let sources = with([a, b, c]);
        self.is_in_place(corner, sources, moment)
            && self.has_its_extras(corner, sources, moment)
            && self.has_its_texture(corner, sources, moment)
            && self.has_its_normal(corner, sources, moment)
    }

    fn is_in_place(&self, corner: CornerAt, sources: Sources<CornerAt>, moment: Moment) -> bool {
        let sources = sources.map(|(corner, weight)| (self.place(corner, moment), weight));
        let rows = sources.each_ref().map(|(row, weight)| (&row[..], *weight));
        is_between(&self.place(corner, moment), rows)
    }

    fn has_its_extras(&self, corner: CornerAt, sources: Sources<CornerAt>, moment: Moment) -> bool {
        let rows = sources.map(|(corner, weight)| (self.extra_numbers(corner, moment), weight));
        let is = self.extra_numbers(corner, moment);
        let alike = rows.iter().all(|(row, _)| row.len() == rows[0].0.len());
        if alike {
            is.len() == rows[0].0.len() && is_between(is, rows)
        } else {
            is.is_empty()
        }
    }

    fn has_its_texture(
        &self,
        corner: CornerAt,
        sources: Sources<CornerAt>,
        moment: Moment,
    ) -> bool {
        let of = |corner: CornerAt| self.index(corner, 0, moment);
        let [a, b, c] = sources.map(|(corner, _)| of(corner));
        let (Some(a), Some(b), Some(c)) = (a, b, c) else {
            return of(corner).is_none();
        };
        let Some(is) = of(corner) else { return false };
        let rows = [a, b, c].map(|index| self.torn.texture_row(index));
        let weighted = [0, 1, 2].map(|i| (rows[i], sources[i].1));
        is_between(self.torn.texture_row(is), weighted)
    }

    fn has_its_normal(&self, corner: CornerAt, sources: Sources<CornerAt>, moment: Moment) -> bool {
        let of = |corner: CornerAt| self.index(corner, 1, moment);
        let [a, b, c] = sources.map(|(corner, _)| of(corner));
        let (Some(a), Some(b), Some(c)) = (a, b, c) else {
            return of(corner).is_none();
        };
        let Some(is) = of(corner) else { return false };
        let normals = [a, b, c].map(|index| self.torn.normal(index));
        is_normal_between(
            self.torn.normal(is),
            [0, 1, 2].map(|i| (normals[i], sources[i].1)),
        )
    }
}

/// Whether each number is, but for rounding, the weighted sum of those of the sources; a number that
/// a row has not counts as 0, as it does for texture coordinates.
fn is_between(is: &[f64], sources: Sources<&[f64]>) -> bool {
    let length = sources.iter().map(|(row, _)| row.len()).max();
    (0..is.len().max(length.unwrap_or(0))).all(|i| {
        let at = |row: &[f64]| row.get(i).copied().unwrap_or(0.0);
        let values = sources.map(|(row, _)| at(row));
        let weights = sources.map(|(_, weight)| weight);
        let wanted = blend(values, weights, is_on_edge(weights));
        let largest = values.map(f64::abs).into_iter().fold(0.0, f64::max);
        (at(is) - wanted).abs() <= ROUNDINGS * f64::EPSILON * largest
    })
}

/// Whether a normal is, but for rounding, in the direction between others, and as long as
/// between them. Where these cancel each other it is one of them.
fn is_normal_between(is: [f64; 3], sources: Sources<[f64; 3]>) -> bool {
    let weights = sources.map(|(_, weight)| weight);
    let normals = sources.map(|(normal, _)| normal);
    let blended = |values: [f64; 3]| blend(values, weights, is_on_edge(weights));
    let between = [0, 1, 2].map(|axis| blended(normals.map(|normal| normal[axis])));
    let lengths = normals.map(length);
    let wanted = blended(lengths);
    let scale = wanted / length(between);
    if !scale.is_finite() {
        return normals.contains(&is);
    }
    // Where they nearly cancel, the direction of what is left is rounding, and says nothing.
    let largest = lengths.into_iter().fold(0.0, f64::max);
    let allowed = ROUNDINGS * f64::EPSILON * largest * scale.max(1.0);
    let near = |axis: usize| (is[axis] - between[axis] * scale).abs() <= allowed;
    allowed >= wanted || (0..3).all(near)
}

/// Whether a point is between the first two of its sources alone.
fn is_on_edge(weights: [f64; 3]) -> bool {
    weights[2] == 0.0
}

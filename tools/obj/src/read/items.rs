//! The lines of a record between its first and its last.

use std::collections::BTreeMap;
use std::ops::Range;

use tearmesh::{COORDINATE_MAX, Point};

use super::fault::{Fault, Parsed, quoted};
use super::scan::Scan;
use super::words::{CODE, DAMAGED, damaged, index, nothing_more, numbers, out_of_range, whole};
use crate::families::Family;
use crate::record::{
    Apart, Exchange, Inserted, Record, Slid, SplitOff, are_last, is_same_point, runs,
};
use crate::store::{NUMBERS_MAX, push};

/// What a record says as far as it was read, by the numbers of the file.
#[derive(Debug, Default)]
pub(super) struct Items {
    pub(super) counts: Counts,
    pub(super) record: Record,
    /// Vertices of the file that are copies, each with the one that it is a copy of; ascending.
    pub(super) fans: Vec<[u32; 2]>,
    /// Faces that cover what was one face, and the roots at its corners; ascending.
    pub(super) parents: Vec<(Range<u32>, [u32; 3])>,
    /// Parts of these that were divided again, counted from 0, and the innermost of each face.
    pub(super) again: Vec<Family>,
    pub(super) again_of: BTreeMap<u32, u32>,
    /// The place of the last item in the order of kinds.
    kind: usize,
}

/// What the first line of a record says.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    pub(super) version: i64,
    pub(super) vertices: u32,
    pub(super) faces: u32,
    /// Of texture coordinates and of normals: how many there were before any was inserted, and all.
    pub(super) indices: [[u32; 2]; 2],
}

/// Reads an item from behind its word on.
type Read = fn(&mut Items, &mut Scan<'_>) -> Parsed<()>;

/// The items: the word, the place in their order (`edge` and `face` have one, and so have slides), the
/// version that has them first, and what reads them.
const KINDS: [(&[u8], usize, i64, Read); 12] = [
    (b"split", 0, 1, Items::split),
    (b"fan", 1, 1, Items::fan),
    (b"edge", 2, 1, |items, scan| items.inserted(2, scan)),
    (b"face", 2, 1, |items, scan| items.inserted(3, scan)),
    (b"parent", 3, 1, Items::parent),
    (b"vt", 4, 2, |items, scan| items.inserted_indices(0, scan)),
    (b"vn", 5, 2, |items, scan| items.inserted_indices(1, scan)),
    (b"slide", 6, 2, Items::slide),
    (b"slide-vt", 6, 2, |items, scan| items.exchange(0, scan)),
    (b"slide-vn", 6, 2, |items, scan| items.exchange(1, scan)),
    (b"apart", 7, 3, Items::apart),
    (b"again", 8, 4, Items::again),
];

impl Items {
    /// Whether a vertex of the file is a copy of another.
    pub(super) fn is_copy(&self, vertex: u32) -> bool {
        let copy = self.fans.binary_search_by_key(&vertex, |&[copy, _]| copy);
        copy.is_ok()
    }

    /// Takes the next line, from behind its mark on.
    pub(super) fn item(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let start = scan.token_start();
        let word = scan.token();
        scan.skip(word.len());
        let known = KINDS.iter().find(|(kind, ..)| *kind == word);
        match known {
            Some(&(_, place, since, read))
                if place >= self.kind && since <= self.counts.version =>
            {
                self.kind = place;
                read(self, scan)?;
                nothing_more(scan)
            }
            _ => {
                let message = format!("this record has no line {} here", quoted(word));
                damaged(scan, start, message)
            }
        }
    }

    fn split(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let last = self.record.splits.last().map_or(1, |last| last.vertex + 1);
        let vertex = index(scan, last, self.counts.vertices)?;
        let from = index(scan, 0, vertex)?;
        let cut = cut(scan, 1)?;
        push(&mut self.record.splits, SplitOff { vertex, from, cut });
        Ok(())
    }

    fn fan(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let last = self.fans.last().map_or(1, |&[copy, _]| copy + 1);
        let start = scan.token_start();
        let copy = index(scan, last, self.counts.vertices)?;
        if self.split_of(copy).is_some() {
            return damaged(scan, start, "a copy of this record was split off");
        }
        let start = scan.token_start();
        let of = index(scan, 0, copy)?;
        if self.is_copy(of) {
            return damaged(scan, start, "this record has a copy of a copy");
        }
        push(&mut self.fans, [copy, of]);
        Ok(())
    }

    /// A vertex that was inserted, by which cut, and between how many others: on an edge, or in a face.
    fn inserted(&mut self, sources: usize, scan: &mut Scan<'_>) -> Parsed<()> {
        let at = scan.token_start();
        let vertex = self.root(scan)?;
        let last = self.record.inserted.last();
        if last.is_some_and(|last| last.vertex >= vertex) {
            return damaged(scan, at, "vertices of this record are not in order");
        }
        let cut = cut(scan, 1)?;
        let (mut between, mut weights) = ([0; 3], [0.0; 3]);
        for root in &mut between[..sources] {
            *root = self.root(scan)?;
        }
        let is_on_edge = sources == 2;
        for weight in &mut weights[usize::from(is_on_edge)..][..2 * sources - 3] {
            let at = scan.token_start();
            *weight = scan.number()?;
            let is_point = is_on_edge && between[0] == between[1];
            if !(*weight > 0.0 && *weight < 1.0) || is_point {
                return Err(out_of_range(at..scan.at(), 0, 1));
            }
        }
        if is_on_edge {
            between[2] = between[1];
            weights[0] = 1.0 - weights[1];
        }
        let inserted = Inserted {
            vertex,
            cut,
            between,
            weights,
        };
        push(&mut self.record.inserted, inserted);
        Ok(())
    }

    fn parent(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let faces = self.counts.faces;
        let last = self.parents.last().map_or(0, |(faces, _)| faces.end);
        let first = index(scan, last, faces)?;
        let end = index(scan, first, faces)? + 1;
        let corners = self.corners(scan)?;
        push(&mut self.parents, (first..end, corners));
        Ok(())
    }

    /// The roots at the corners of a face.
    fn corners(&self, scan: &mut Scan<'_>) -> Parsed<[u32; 3]> {
        let at = scan.token_start();
        let corners @ [a, b, c] = [self.root(scan)?, self.root(scan)?, self.root(scan)?];
        if a == b || b == c || c == a {
            return damaged(scan, at, "a face of this record has a vertex twice");
        }
        Ok(corners)
    }

    /// A run of texture coordinates (0) or normals (1) that were inserted.
    fn inserted_indices(&mut self, which: usize, scan: &mut Scan<'_>) -> Parsed<()> {
        let [_, all] = self.counts.indices[which];
        let runs = &mut self.record.new_indices[which];
        let last = runs.last().map_or(0, |&[_, end]| i64::from(end) + 1);
        let first = index(scan, last, all)?;
        let end = index(scan, first, all)? + 1;
        push(runs, [first, end]);
        Ok(())
    }

    /// A vertex that slid, with all numbers of its `v` before and then: to the end of the line.
    fn slide(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let vertex = self.vertex(scan, 0, DAMAGED)?;
        let slides = &mut self.record.slides;
        let cut = cut(scan, slides.last().map_or(1, |last| last.cut))?;
        let mut row = [0.0; 2 * NUMBERS_MAX];
        let start = scan.at();
        let count = numbers(scan, &mut row)?;
        let half = count / 2;
        if count % 2 != 0 || half < 3 {
            let message =
                "this record has a slide with different counts of numbers before and after";
            return damaged(scan, start, message);
        }
        let mut places = [0, half].into_iter().flat_map(|at| at..at + 3);
        if places.any(|at| row[at].abs() > COORDINATE_MAX) {
            return damaged(
                scan,
                start,
                "this record has a coordinate that is too large",
            );
        }
        let slid = Slid {
            vertex,
            cut,
            numbers: row[..count].to_vec(),
            exchanges: Vec::new(),
        };
        push(slides, slid);
        Ok(())
    }

    /// A texture coordinate (0) or a normal (1) that corners of the vertex that slid last got for
    /// another, with what it names.
    fn exchange(&mut self, which: usize, scan: &mut Scan<'_>) -> Parsed<()> {
        let [_, all] = self.counts.indices[which];
        let start = scan.at();
        let [new, old] = [index(scan, 0, all)?, index(scan, 0, all)?];
        let mut value = [0.0; 3];
        let count = numbers(scan, &mut value)?;
        match self.record.slides.last_mut() {
            Some(slid) if count > 0 && new != old => {
                let value = value[..count].to_vec();
                let exchange = Exchange {
                    which,
                    new,
                    old,
                    value,
                };
                push(&mut slid.exchanges, exchange);
                Ok(())
            }
            _ => {
                let message = "this record has corners here without a vertex that slid";
                damaged(scan, start, message)
            }
        }
    }

    /// A vertex that stands apart: where it is, and where its `v` says.
    fn apart(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let last = self.record.apart.last().map_or(0, |last| last.vertex + 1);
        let vertex = self.vertex(scan, last, DAMAGED)?;
        let start = scan.at();
        let mut row = [0.0; 6];
        let count = numbers(scan, &mut row)?;
        if count < row.len() || row.iter().any(|x| x.abs() > COORDINATE_MAX) {
            let message = "this record has a vertex without two usable points";
            return damaged(scan, start, message);
        }
        let [is, shown] = [0, 3].map(|i| Point::new(row[i], row[i + 1], row[i + 2]));
        if is_same_point(is, shown) {
            let message = "this record writes a vertex apart at its own position";
            return damaged(scan, start, message);
        }
        push(&mut self.record.apart, Apart { vertex, is, shown });
        Ok(())
    }

    /// A part of a parent that was divided again, with the faces that cover it.
    fn again(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let above = whole(scan, 0, self.again.len() as i64)?.checked_sub(1);
        let corners = self.corners(scan)?;
        let number = self.again.len() as u32;
        push(&mut self.again, Family { corners, above });
        let mut last = 0;
        while scan.find_token() {
            let start = scan.at();
            let face = index(scan, last, self.counts.faces)?;
            last = face + 1;
            if self.again_of.insert(face, number).is_some() {
                let message = "this record has a face in two that were divided again";
                return damaged(scan, start, message);
            }
        }
        Ok(())
    }

    /// A vertex with a number above `last` that is no copy; `label` is said of one that is.
    fn vertex(&self, scan: &mut Scan<'_>, last: u32, label: &str) -> Parsed<u32> {
        let at = scan.token_start();
        let vertex = index(scan, last, self.counts.vertices)?;
        if self.is_copy(vertex) {
            let message = format!("vertex {} is a copy", u64::from(vertex) + 1);
            return Err(Fault::new(CODE, at..scan.at(), message, label));
        }
        Ok(vertex)
    }

    /// A vertex that was split from no other.
    fn root(&self, scan: &mut Scan<'_>) -> Parsed<u32> {
        const EXPECTED: &str = "expected a root";
        let at = scan.token_start();
        let vertex = self.vertex(scan, 0, EXPECTED)?;
        let Some(split) = self.split_of(vertex) else {
            return Ok(vertex);
        };
        let [vertex, from] = [split.vertex, split.from].map(|v| u64::from(v) + 1);
        let message = format!("vertex {vertex} was split from {from}");
        Err(Fault::new(CODE, at..scan.at(), message, EXPECTED))
    }

    /// How a vertex was split off, if it was.
    fn split_of(&self, vertex: u32) -> Option<SplitOff> {
        let splits = &self.record.splits;
        let place = splits.binary_search_by_key(&vertex, |split| split.vertex);
        place.ok().map(|place| splits[place])
    }

    /// What is wrong with the counts, now that all lines are there.
    pub(super) fn wrong_counts(&self) -> Option<&'static str> {
        let copies = runs(self.fans.iter().map(|&[copy, _]| copy));
        if self.counts.version == 1 && !are_last(&copies, self.counts.vertices) {
            return Some("the copies of this record are not the last vertices");
        }
        let mut all = self.counts.indices.iter().zip(&self.record.new_indices);
        let is_wrong = all.any(|(&[before, all], runs)| {
            let listed: u32 = runs.iter().map(|[first, end]| end - first).sum();
            !runs.is_empty() && before.checked_add(listed) != Some(all)
        });
        is_wrong.then_some("the counts of this record do not match its lines")
    }
}

/// The number of a cut.
fn cut(scan: &mut Scan<'_>, least: u32) -> Parsed<u32> {
    whole(scan, least, u32::MAX - 1)
}

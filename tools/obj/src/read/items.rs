//! The lines of a record between its first and its last.

use std::collections::BTreeMap;
use std::ops::Range;

use tearmesh::{COORDINATE_MAX, Point};

use super::fault::{Fault, Parsed, quoted};
use super::scan::Scan;
use super::words::{CODE, damaged, nothing_more, numbers, out_of_range, whole};
use crate::families::Family;
use crate::record::{Apart, At, Inserted, Record, SplitOff, are_last, is_same_point, runs};
use crate::slides::Exchange;
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

impl Items {
    /// Nothing, but for what the first line says.
    pub(super) fn new(counts: Counts) -> Items {
        Items {
            counts,
            ..Items::default()
        }
    }

    /// The number of vertices of the file.
    fn vertices(&self) -> i64 {
        i64::from(self.counts.vertices)
    }

    /// Whether a vertex of the file is a copy of another.
    pub(super) fn is_copy(&self, vertex: u32) -> bool {
        self.fans
            .binary_search_by_key(&vertex, |&[copy, _]| copy)
            .is_ok()
    }

    /// Takes the next line, from behind its mark on.
    pub(super) fn item(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        // `edge` and `face` are in one order, and so are slides. Version 1 has the first five,
        // version 2 all but the last two, and version 3 all but the last.
        const KINDS: [(&[u8], usize); 12] = [
            (b"split", 0),
            (b"fan", 1),
            (b"edge", 2),
            (b"face", 2),
            (b"parent", 4),
            (b"vt", 5),
            (b"vn", 6),
            (b"slide", 7),
            (b"slide-vt", 7),
            (b"slide-vn", 7),
            (b"apart", 8),
            (b"again", 9),
        ];
        scan.find_token();
        let (start, word) = (scan.at(), scan.token());
        scan.skip(word.len());
        let mut known = KINDS.iter().take(match self.counts.version {
            1 => 5,
            2 => 10,
            3 => 11,
            _ => KINDS.len(),
        });
        match known.find(|(kind, _)| *kind == word) {
            Some(&(_, rank)) if rank >= self.kind => self.kind = rank,
            _ => {
                return damaged(
                    start..scan.at(),
                    format!("this record has no line {} here", quoted(word)),
                );
            }
        }
        match word {
            b"split" => self.split(scan)?,
            b"fan" => self.fan(scan)?,
            b"edge" => self.edge(scan)?,
            b"face" => self.face(scan)?,
            b"parent" => self.parent(scan)?,
            b"slide" => return self.slide(scan),
            b"slide-vt" => return self.exchange(0, scan),
            b"slide-vn" => return self.exchange(1, scan),
            b"apart" => return self.apart(scan),
            b"again" => self.again(scan)?,
            _ => self.inserted_indices(usize::from(word == b"vn"), scan)?,
        }
        nothing_more(scan)
    }

    fn split(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let last = self.record.splits.last().map_or(1, |last| last.vertex + 1);
        let vertex = whole(scan, i64::from(last) + 1, self.vertices())? - 1;
        let from = whole(scan, 1, i64::from(vertex))? - 1;
        let cut = whole(scan, 1, i64::from(u32::MAX) - 1)?;
        push(&mut self.record.splits, SplitOff { vertex, from, cut });
        Ok(())
    }

    fn fan(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let least = self.fans.last().map_or(1, |&[copy, _]| i64::from(copy) + 1);
        let start = scan.token_start();
        let copy = whole(scan, least + 1, self.vertices())? - 1;
        let splits = &self.record.splits;
        if splits
            .binary_search_by_key(&copy, |split| split.vertex)
            .is_ok()
        {
            return damaged(start..scan.at(), "a copy of this record was split off");
        }
        let start = scan.token_start();
        let of = whole(scan, 1, i64::from(copy))? - 1;
        if self.is_copy(of) {
            return damaged(start..scan.at(), "this record has a copy of a copy");
        }
        push(&mut self.fans, [copy, of]);
        Ok(())
    }

    fn edge(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let (vertex, cut) = self.inserted(scan)?;
        let ends = [self.root(scan)?, self.root(scan)?];
        let at = scan.token_start();
        let t = scan.number()?;
        if !(t > 0.0 && t < 1.0) || ends[0] == ends[1] {
            return Err(out_of_range(at..scan.at(), 0, 1));
        }
        let at = At::Edge { ends, t };
        push(&mut self.record.inserted, Inserted { vertex, cut, at });
        Ok(())
    }

    fn face(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let (vertex, cut) = self.inserted(scan)?;
        let corners = [self.root(scan)?, self.root(scan)?, self.root(scan)?];
        let mut weights = [0.0; 3];
        for weight in &mut weights {
            let at = scan.token_start();
            *weight = scan.number()?;
            if !(*weight > 0.0 && *weight < 1.0) {
                return Err(out_of_range(at..scan.at(), 0, 1));
            }
        }
        let at = At::Face { corners, weights };
        push(&mut self.record.inserted, Inserted { vertex, cut, at });
        Ok(())
    }

    fn parent(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let faces = i64::from(self.counts.faces);
        let least = self.parents.last().map_or(0, |(faces, _)| faces.end);
        let first = whole(scan, i64::from(least) + 1, faces)? - 1;
        let end = whole(scan, i64::from(first) + 1, faces)?;
        let corners = self.corners(scan)?;
        push(&mut self.parents, (first..end, corners));
        Ok(())
    }

    /// The roots at the corners of a face.
    fn corners(&self, scan: &mut Scan<'_>) -> Parsed<[u32; 3]> {
        let at = scan.token_start();
        let corners @ [a, b, c] = [self.root(scan)?, self.root(scan)?, self.root(scan)?];
        if a == b || b == c || c == a {
            return damaged(at..scan.at(), "a face of this record has a vertex twice");
        }
        Ok(corners)
    }

    /// A run of texture coordinates (0) or normals (1) that were inserted.
    fn inserted_indices(&mut self, which: usize, scan: &mut Scan<'_>) -> Parsed<()> {
        let [_, all] = self.counts.indices[which];
        let runs = &mut self.record.new_indices[which];
        let least = runs.last().map_or(0, |&[_, end]| i64::from(end) + 1);
        let first = whole(scan, least + 1, i64::from(all))? - 1;
        let end = whole(scan, i64::from(first) + 1, i64::from(all))?;
        push(runs, [first, end]);
        Ok(())
    }

    /// A vertex that slid, with all numbers of its `v` before and then: to the end of the line.
    fn slide(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let at = scan.token_start();
        let vertex = whole(scan, 1, self.vertices())? - 1;
        if self.is_copy(vertex) {
            return damaged(
                at..scan.at(),
                format!("vertex {} is a copy", u64::from(vertex) + 1),
            );
        }
        let slides = &mut self.record.slides;
        let last = slides.len().checked_sub(1).map(|last| slides.get(last).cut);
        let cut = whole(scan, i64::from(last.unwrap_or(1)), i64::from(u32::MAX) - 1)?;
        let mut row = [0.0; 2 * NUMBERS_MAX];
        let start = scan.at();
        let count = numbers(scan, &mut row)?;
        let half = count / 2;
        let places = || [0, half].into_iter().flat_map(|at| at..at + 3);
        if count % 2 != 0 || half < 3 || slides.is_full() {
            return damaged(
                start..scan.at(),
                "this record has a slide with different counts of numbers before and after",
            );
        }
        if places().any(|at| row[at].abs() > COORDINATE_MAX) {
            return damaged(
                start..scan.at(),
                "this record has a coordinate that is too large",
            );
        }
        slides.push(vertex, cut, &row[..count]);
        Ok(())
    }

    /// A texture coordinate (0) or a normal (1) that corners of the vertex that slid last got for
    /// another, with what it names.
    fn exchange(&mut self, which: usize, scan: &mut Scan<'_>) -> Parsed<()> {
        let [_, all] = self.counts.indices[which];
        let start = scan.at();
        let new = whole(scan, 1, i64::from(all))? - 1;
        let old = whole(scan, 1, i64::from(all))? - 1;
        let mut value = [0.0; 3];
        let count = numbers(scan, &mut value)?;
        let slides = &mut self.record.slides;
        if slides.is_empty() || slides.is_full() || count == 0 || new == old {
            return damaged(
                start..scan.at(),
                "this record has corners here without a vertex that slid",
            );
        }
        slides.push_exchange(Exchange { which, new, old }, &value[..count]);
        Ok(())
    }

    /// A vertex that stands apart: where it is, and where its `v` says.
    fn apart(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let last = self.record.apart.last().map_or(0, |last| last.vertex + 1);
        let at = scan.token_start();
        let vertex = whole(scan, i64::from(last) + 1, self.vertices())? - 1;
        if self.is_copy(vertex) {
            return damaged(
                at..scan.at(),
                format!("vertex {} is a copy", u64::from(vertex) + 1),
            );
        }
        let start = scan.at();
        let mut row = [0.0; 6];
        let count = numbers(scan, &mut row)?;
        if count < row.len() || row.iter().any(|x| x.abs() > COORDINATE_MAX) {
            return damaged(
                start..scan.at(),
                "this record has a vertex without two usable points",
            );
        }
        let [is, shown] = [0, 3].map(|i| Point::new(row[i], row[i + 1], row[i + 2]));
        if is_same_point(is, shown) {
            return damaged(
                start..scan.at(),
                "this record writes a vertex apart at its own position",
            );
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
        let mut least = 1;
        while scan.find_token() {
            let start = scan.at();
            let face = whole(scan, least, i64::from(self.counts.faces))?;
            least = i64::from(face) + 1;
            if self.again_of.insert(face - 1, number).is_some() {
                return damaged(
                    start..scan.at(),
                    "this record has a face in two that were divided again",
                );
            }
        }
        Ok(())
    }

    /// A vertex that was inserted, and by which cut.
    fn inserted(&self, scan: &mut Scan<'_>) -> Parsed<(u32, u32)> {
        let at = scan.token_start();
        let vertex = self.root(scan)?;
        let last = self.record.inserted.last();
        if last.is_some_and(|last| last.vertex >= vertex) {
            return damaged(at..scan.at(), "vertices of this record are not in order");
        }
        Ok((vertex, whole(scan, 1, i64::from(u32::MAX) - 1)?))
    }

    /// A vertex that was split from no other.
    fn root(&self, scan: &mut Scan<'_>) -> Parsed<u32> {
        let at = scan.token_start();
        let vertex = whole(scan, 1, self.vertices())? - 1;
        if self.is_copy(vertex) {
            let message = format!("vertex {} is a copy", u64::from(vertex) + 1);
            return Err(Fault::new(CODE, at..scan.at(), message, "expected a root"));
        }
        let splits = &self.record.splits;
        let split = splits.binary_search_by_key(&vertex, |split| split.vertex);
        match split {
            Err(_) => Ok(vertex),
            Ok(split) => {
                let from = u64::from(splits[split].from) + 1;
                let message = format!("vertex {} was split from {from}", u64::from(vertex) + 1);
                Err(Fault::new(CODE, at..scan.at(), message, "expected a root"))
            }
        }
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

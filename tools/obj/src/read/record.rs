//! The record at the end of a torn file: its lines, and whether it fits the file.
//!
//! A record that is damaged, of a later version, or of other faces than the file has is left
//! out with a warning, and the file read as one without.

use super::copies::join;
use super::fault::{Fault, Parsed};
use super::line::{Line, locate, quoted};
use super::scan::Scan;
use crate::diagnostic::{Diagnostic, Excerpt, Level, Location, ReadError};
use crate::document::Document;
use crate::record::{
    At, END, HEADER, Hash, ITEM, Inserted, Parent, Record, SplitOff, VERSION, are_last, runs,
};
use crate::store::push;

const CODE: &str = "W-OBJ-RECORD";

/// A record as far as it was read.
#[derive(Debug, Default)]
pub(super) struct RecordReader {
    state: State,
    header: Option<Header>,
    items: usize,
    hash: Hash,
    /// The place of the last item in the order of kinds.
    kind: usize,
    /// By the numbers of the file.
    record: Record,
    /// Vertices of the file that are copies, each with the one that it is a copy of; ascending.
    fans: Vec<[u32; 2]>,
    /// Why there is no record.
    warning: Option<Diagnostic>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Outside,
    Within,
    /// Within one that is no use.
    Skipping,
}

#[derive(Debug)]
struct Header {
    version: i64,
    vertices: u32,
    faces: u32,
    texture: [u32; 2],
    normals: [u32; 2],
    hash: u64,
    place: (Location, Excerpt),
}

impl RecordReader {
    /// Takes a comment, from `offset` on in its line, if it belongs to a record.
    pub(super) fn takes(&mut self, line: &Line<'_>, offset: usize) -> bool {
        let text = &line.bytes[offset..];
        let begins = |mark: &[u8]| {
            let rest = text.strip_prefix(mark);
            rest.is_some_and(|rest| rest.first().is_none_or(|&next| next == b' '))
        };
        if !text.starts_with(b"#") || text.contains(&0) {
            return false;
        }
        let mut scan = Scan::new(line.bytes);
        let read = if begins(HEADER) {
            scan.at = offset + HEADER.len();
            self.header(line, &mut scan)
        } else if begins(END) {
            scan.at = offset + END.len();
            self.end(&mut scan)
        } else if begins(ITEM) && self.state != State::Outside {
            if self.state == State::Skipping {
                return true;
            }
            self.items += 1;
            self.hash.add(text);
            self.hash.add(b"\n");
            scan.at = offset + ITEM.len();
            self.item(&mut scan)
        } else {
            return false;
        };
        if let Err(fault) = read {
            self.give_up(fault, line);
        }
        true
    }

    #[cold]
    fn give_up(&mut self, fault: Box<Fault>, line: &Line<'_>) {
        if self.state == State::Within {
            self.state = State::Skipping;
        }
        self.record = Record::default();
        self.fans = Vec::new();
        if let (None, ReadError::Refused(diagnostic)) = (&self.warning, fault.at(line)) {
            self.warning = Some(Diagnostic {
                level: Level::Warning,
                code: CODE, // A number that cannot be read has another.
                help: Some(match diagnostic.help {
                    Some(help) => format!("{help}; {LEFT_OUT}"),
                    None => without_record(),
                }),
                ..*diagnostic
            });
        }
    }

    fn header(&mut self, line: &Line<'_>, scan: &mut Scan<'_>) -> Parsed<()> {
        let start = scan.at - HEADER.len();
        self.state = State::Skipping;
        if self.header.is_some() || self.warning.is_some() {
            let message = "this file has a second record: neither is used";
            let fault = Fault::new(CODE, start..scan.at, message, "begins here");
            return Err(fault.help("files that are joined have to be written anew"));
        }
        let version = version(scan)?;
        let largest = i64::from(u32::MAX);
        exactly(scan, "v")?;
        let vertices = whole(scan, 0, largest)?;
        exactly(scan, "f")?;
        let faces = whole(scan, 0, largest)?;
        exactly(scan, "vt")?;
        let texture = [whole(scan, 0, largest)?, whole(scan, 0, largest)?];
        exactly(scan, "vn")?;
        let normals = [whole(scan, 0, largest)?, whole(scan, 0, largest)?];
        exactly(scan, "faces")?;
        let hash = hexadecimal(scan)?;
        nothing_more(scan)?;
        self.header = Some(Header {
            version,
            vertices,
            faces,
            texture,
            normals,
            hash,
            place: locate(line, &(start..start + HEADER.len())),
        });
        self.state = State::Within;
        Ok(())
    }

    fn end(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let start = scan.at - END.len();
        match std::mem::take(&mut self.state) {
            State::Within => {}
            State::Skipping => return Ok(()),
            State::Outside => {
                let message = "here a record ends that has not begun";
                return Err(Fault::new(CODE, start..scan.at, message, "ends here"));
            }
        }
        let damaged = |span, message: &str| Err(Fault::new(CODE, span, message, DAMAGED));
        let Some(header) = &self.header else {
            return damaged(start..scan.at, "this record has no beginning");
        };
        let copies = runs(self.fans.iter().map(|&[copy, _]| copy));
        if header.version == 1 && !are_last(&copies, header.vertices) {
            return damaged(
                start..scan.at,
                "the copies of this record are not the last vertices",
            );
        }
        for ([before, all], runs) in [
            (header.texture, &self.record.texture),
            (header.normals, &self.record.normals),
        ] {
            let listed: u32 = runs.iter().map(|[first, end]| end - first).sum();
            if !runs.is_empty() && before.checked_add(listed) != Some(all) {
                return damaged(
                    start..scan.at,
                    "this record has other counts than its lines",
                );
            }
        }
        let largest = i64::from(u32::MAX);
        scan.find_token();
        let at = scan.at;
        if whole(scan, 0, largest)? as usize != self.items {
            return damaged(at..scan.at, "this record has not as many lines as it had");
        }
        scan.find_token();
        let at = scan.at;
        if hexadecimal(scan)? != self.hash.0 {
            return damaged(at..scan.at, "a line of this record was changed");
        }
        nothing_more(scan)
    }

    /// The number of vertices of the file.
    fn vertices(&self) -> i64 {
        self.header
            .as_ref()
            .map_or(0, |header| i64::from(header.vertices))
    }

    fn is_copy(&self, vertex: u32) -> bool {
        self.fans
            .binary_search_by_key(&vertex, |&[copy, _]| copy)
            .is_ok()
    }

    fn item(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        // `edge` and `face` are in one order. The last two are of version 2.
        const KINDS: [(&[u8], usize); 7] = [
            (b"split", 0),
            (b"fan", 1),
            (b"edge", 2),
            (b"face", 2),
            (b"parent", 4),
            (b"vt", 5),
            (b"vn", 6),
        ];
        scan.find_token();
        let (start, word) = (scan.at, scan.token());
        scan.at += word.len();
        let is_first = self
            .header
            .as_ref()
            .is_none_or(|header| header.version == 1);
        let known = KINDS.iter().take(if is_first { 5 } else { KINDS.len() });
        match known.clone().find(|(kind, _)| *kind == word) {
            Some(&(_, rank)) if rank >= self.kind => self.kind = rank,
            _ => {
                let message = format!("this record has no line {} here", quoted(word));
                return Err(Fault::new(CODE, start..scan.at, message, DAMAGED));
            }
        }
        match word {
            b"split" => self.split(scan)?,
            b"fan" => self.fan(scan)?,
            b"edge" => self.edge(scan)?,
            b"face" => self.face(scan)?,
            b"parent" => self.parent(scan)?,
            _ => self.inserted_indices(word == b"vt", scan)?,
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
        scan.find_token();
        let start = scan.at;
        let copy = whole(scan, least + 1, self.vertices())? - 1;
        let splits = &self.record.splits;
        if splits
            .binary_search_by_key(&copy, |split| split.vertex)
            .is_ok()
        {
            let message = "a copy of this record was split off";
            return Err(Fault::new(CODE, start..scan.at, message, DAMAGED));
        }
        scan.find_token();
        let start = scan.at;
        let of = whole(scan, 1, i64::from(copy))? - 1;
        if self.is_copy(of) {
            let message = "a copy of this record is one of a copy";
            return Err(Fault::new(CODE, start..scan.at, message, DAMAGED));
        }
        push(&mut self.fans, [copy, of]);
        Ok(())
    }

    fn edge(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let (vertex, cut) = self.inserted(scan)?;
        let ends = [self.root(scan)?, self.root(scan)?];
        scan.find_token();
        let at = scan.at;
        let t = scan.number()?;
        if !(t > 0.0 && t < 1.0) || ends[0] == ends[1] {
            return Err(out_of_range(at..scan.at, 0, 1));
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
            scan.find_token();
            let at = scan.at;
            *weight = scan.number()?;
            if !(*weight > 0.0 && *weight < 1.0) {
                return Err(out_of_range(at..scan.at, 0, 1));
            }
        }
        let at = At::Face { corners, weights };
        push(&mut self.record.inserted, Inserted { vertex, cut, at });
        Ok(())
    }

    fn parent(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let faces = i64::from(self.header.as_ref().map_or(0, |header| header.faces));
        let least = self.record.parents.last().map_or(0, |last| last.end);
        let first = whole(scan, i64::from(least) + 1, faces)? - 1;
        let end = whole(scan, i64::from(first) + 1, faces)?;
        scan.find_token();
        let at = scan.at;
        let corners @ [a, b, c] = [self.root(scan)?, self.root(scan)?, self.root(scan)?];
        if a == b || b == c || c == a {
            let message = "a face of this record has a vertex twice";
            return Err(Fault::new(CODE, at..scan.at, message, DAMAGED));
        }
        let parent = Parent {
            first,
            end,
            corners,
        };
        push(&mut self.record.parents, parent);
        Ok(())
    }

    /// A run of texture coordinates or normals that were inserted.
    fn inserted_indices(&mut self, is_texture: bool, scan: &mut Scan<'_>) -> Parsed<()> {
        let header = self.header.as_ref();
        let (runs, [_, all]) = if is_texture {
            (
                &mut self.record.texture,
                header.map_or([0; 2], |header| header.texture),
            )
        } else {
            (
                &mut self.record.normals,
                header.map_or([0; 2], |header| header.normals),
            )
        };
        let least = runs.last().map_or(0, |&[_, end]| i64::from(end) + 1);
        let first = whole(scan, least + 1, i64::from(all))? - 1;
        let end = whole(scan, i64::from(first) + 1, i64::from(all))?;
        push(runs, [first, end]);
        Ok(())
    }

    /// A vertex that was inserted, and by which cut.
    fn inserted(&self, scan: &mut Scan<'_>) -> Parsed<(u32, u32)> {
        scan.find_token();
        let at = scan.at;
        let vertex = self.root(scan)?;
        let last = self.record.inserted.last();
        if last.is_some_and(|last| last.vertex >= vertex) {
            let message = "vertices of this record are not in order";
            return Err(Fault::new(CODE, at..scan.at, message, DAMAGED));
        }
        Ok((vertex, whole(scan, 1, i64::from(u32::MAX) - 1)?))
    }

    /// A vertex that was split from no other.
    fn root(&self, scan: &mut Scan<'_>) -> Parsed<u32> {
        scan.find_token();
        let at = scan.at;
        let vertex = whole(scan, 1, self.vertices())? - 1;
        if self.is_copy(vertex) {
            let message = format!("vertex {} is a copy", u64::from(vertex) + 1);
            return Err(Fault::new(CODE, at..scan.at, message, "expected a root"));
        }
        let splits = &self.record.splits;
        let split = splits.binary_search_by_key(&vertex, |split| split.vertex);
        match split {
            Err(_) => Ok(vertex),
            Ok(split) => {
                let from = u64::from(splits[split].from) + 1;
                let message = format!("vertex {} was split from {from}", u64::from(vertex) + 1);
                Err(Fault::new(CODE, at..scan.at, message, "expected a root"))
            }
        }
    }

    /// Gives the document its record, if it has one that fits; or says why not.
    pub(super) fn finish(mut self, document: &mut Document) {
        let warning = self.warning.take();
        if let Some(warning) = warning {
            document.diagnostics.push(warning);
            return;
        }
        let Some(header) = self.header.take() else {
            return;
        };
        let misfit = match self.state {
            State::Outside => self.misfit(&header, document),
            _ => Some("this record has no end, and is not used".to_owned()),
        };
        if let Some(message) = misfit {
            let (location, excerpt) = header.place;
            document.diagnostics.push(Diagnostic {
                level: Level::Warning,
                code: CODE,
                location: Some(location),
                message,
                excerpt: Some(excerpt.labelled("begins here")),
                help: Some(without_record()),
            });
            return;
        }
        let mut record = self.record;
        settle(&mut record.texture, header.texture, document.texture.len());
        settle(&mut record.normals, header.normals, document.normals.len());
        join(document, &mut record, &self.fans);
        document.record = Some(Box::new(record));
    }

    /// Whether all that can be taken out again, or is a copy, comes behind all that cannot.
    fn what_may_go_is_last(&self, header: &Header) -> bool {
        let record = &self.record;
        let split = record.splits.iter().map(|split| split.vertex);
        let inserted = record.inserted.iter().map(|inserted| inserted.vertex);
        let copies = self.fans.iter().map(|&[copy, _]| copy);
        let mut may_go: Vec<u32> = split.chain(inserted).chain(copies).collect();
        may_go.sort_unstable();
        may_go.dedup();
        are_last(&runs(may_go.into_iter()), header.vertices)
            && are_last(&record.texture, header.texture[1])
            && are_last(&record.normals, header.normals[1])
    }

    /// Why the record is not one of this document.
    fn misfit(&self, header: &Header, document: &Document) -> Option<String> {
        let changed = |what: String| {
            Some(format!(
                "this record is not used, since another program changed the file: {what}"
            ))
        };
        let (vertices, faces) = (document.positions.len(), document.polygons.len());
        if vertices != header.vertices as usize {
            return changed(format!(
                "it had {} `v`, and has {vertices}",
                header.vertices
            ));
        }
        if faces != header.faces as usize {
            return changed(format!("it had {} `f`, and has {faces}", header.faces));
        }
        let mut hash = Hash::of_faces(vertices);
        for &vertex in &document.polygons.vertices {
            hash.add_corner(vertex);
        }
        if hash.0 != header.hash || !document.polygons.all_triangles() {
            return changed("its faces are others".to_owned());
        }
        if let Some(keyword) = document.statement_with_indices()
            && !self.what_may_go_is_last(header)
        {
            return changed(format!(
                "{} may name a vertex by its number, which would be another without the cuts",
                quoted(keyword)
            ));
        }
        // What a record says that was made by no one who knew the faces.
        let mut of: Vec<u32> = (0..header.vertices).collect();
        for &[copy, vertex] in &self.fans {
            of[copy as usize] = vertex;
        }
        let mut has_face = vec![false; vertices];
        let roots = self.record.roots(vertices);
        for corners in document.triangles() {
            let [a, b, c] = corners.map(|v| roots[of[v as usize] as usize]);
            if a == b || b == c || c == a {
                return Some("this record is not used: it joins corners of a face".to_owned());
            }
            for &vertex in corners {
                has_face[vertex as usize] = true;
            }
        }
        let splits = &self.record.splits;
        if splits.iter().any(|split| self.is_copy(split.from)) {
            return Some("this record is not used: it splits a copy".to_owned());
        }
        let mut split = splits.iter().flat_map(|split| [split.vertex, split.from]);
        if split.any(|vertex| !has_face[vertex as usize]) {
            return Some("this record is not used: it splits vertices without faces".to_owned());
        }
        None
    }
}

/// Where the record does not say which elements were inserted, they are the last ones. If the file
/// has not as many as it had, nobody knows.
fn settle(inserted: &mut Vec<[u32; 2]>, [before, all]: [u32; 2], count: usize) {
    if all as usize != count {
        inserted.clear();
    } else if inserted.is_empty() && before < all {
        push(inserted, [before, all]);
    }
}

/// What becomes of a file whose record is not used.
fn without_record() -> String {
    format!(
        "the file is read as one without a record: what is torn in it cannot be mended, and {LEFT_OUT}"
    )
}

const LEFT_OUT: &str = "the lines of the record are left out of what is written";

const DAMAGED: &str = "the record is damaged";

/// The version of a record, which must be one that is known.
fn version(scan: &mut Scan<'_>) -> Parsed<i64> {
    scan.find_token();
    let start = scan.at;
    match scan.integer().filter(|_| scan.at_token_end()) {
        Some(version @ 1..=VERSION) => Ok(version),
        Some(later) if later > VERSION => {
            let message = "this record is of a later version, and not used";
            let expected = format!("expected {VERSION} at most, not {later}");
            let fault = Fault::new(CODE, start..scan.at, message, expected);
            Err(fault.help("a later tearmesh reads it"))
        }
        _ => {
            scan.at = start;
            exactly(scan, "1").map(|()| 1)
        }
    }
}

fn out_of_range(span: std::ops::Range<usize>, least: i64, most: i64) -> Box<Fault> {
    let message = "a number of this record is out of its range";
    Fault::new(CODE, span, message, format!("expected {least} to {most}"))
}

/// A whole number.
fn whole(scan: &mut Scan<'_>, least: i64, most: i64) -> Parsed<u32> {
    scan.find_token();
    let start = scan.at;
    match scan.integer() {
        Some(number) if scan.at_token_end() && least <= number && number <= most => {
            Ok(number as u32)
        }
        _ => {
            scan.at = start;
            Err(out_of_range(start..start + scan.token().len(), least, most))
        }
    }
}

fn hexadecimal(scan: &mut Scan<'_>) -> Parsed<u64> {
    scan.find_token();
    let token = scan.token();
    let start = scan.at;
    scan.at += token.len();
    let digits = std::str::from_utf8(token)
        .ok()
        .filter(|text| text.len() == 16);
    let number = digits.and_then(|digits| u64::from_str_radix(digits, 16).ok());
    number.ok_or_else(|| {
        let message = format!("{} is no checksum", quoted(token));
        Fault::new(
            CODE,
            start..scan.at,
            message,
            "expected 16 hexadecimal digits",
        )
    })
}

fn exactly(scan: &mut Scan<'_>, word: &str) -> Parsed<()> {
    scan.find_token();
    let token = scan.token();
    let start = scan.at;
    scan.at += token.len();
    if token == word.as_bytes() {
        return Ok(());
    }
    let message = format!("this record has {} where `{word}` should be", quoted(token));
    Err(Fault::new(CODE, start..scan.at, message, DAMAGED))
}

fn nothing_more(scan: &mut Scan<'_>) -> Parsed<()> {
    if !scan.find_token() && scan.at == scan.bytes.len() {
        return Ok(());
    }
    let end = scan.bytes.len();
    let message = "this line of a record has more than belongs there";
    Err(Fault::new(CODE, scan.at..end, message, DAMAGED))
}

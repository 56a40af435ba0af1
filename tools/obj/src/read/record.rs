//! The record at the end of a torn file: its lines, and whether it fits the file.
//!
//! A record that is damaged, of a later version, or of other faces than the file has is left
//! out with a warning, and the file read as one without.

use super::fault::{Fault, Parsed};
use super::line::{Line, locate, quoted};
use super::scan::Scan;
use crate::diagnostic::{Diagnostic, Excerpt, Level, Location, ReadError};
use crate::document::Document;
use crate::record::{At, END, HEADER, Hash, ITEM, Inserted, Parent, Record, SplitOff, VERSION};
use crate::said;
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
    record: Record,
    /// The vertices that the last vertices of the file are copies of.
    fans: Vec<u32>,
    first_copy: Option<u32>,
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
        let version = scan.find_token().then_some(scan.at);
        if let Some(at) = version
            && scan.integer().is_some_and(|version| version > VERSION)
            && scan.at_token_end()
        {
            let message = "this record is of a later version, and not used";
            let fault = Fault::new(CODE, at..scan.at, message, format!("expected {VERSION}"));
            return Err(fault.help("a later tearmesh reads it"));
        }
        if let Some(at) = version {
            scan.at = at;
        }
        exactly(scan, "1")?;
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
        let copies_end = self.mesh_vertices() as usize + self.fans.len();
        if self
            .header
            .as_ref()
            .is_none_or(|header| copies_end != header.vertices as usize)
        {
            return damaged(
                start..scan.at,
                "the copies of this record are not the last vertices",
            );
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

    /// The number of vertices that are no copies, as far as is known.
    fn mesh_vertices(&self) -> u32 {
        let vertices = self.header.as_ref().map_or(0, |header| header.vertices);
        self.first_copy.unwrap_or(vertices)
    }

    fn item(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        const KINDS: [&[u8]; 5] = [b"split", b"fan", b"edge", b"face", b"parent"];
        scan.find_token();
        let (start, word) = (scan.at, scan.token());
        scan.at += word.len();
        let kind = KINDS.iter().position(|&kind| kind == word);
        // `edge` and `face` are in one order.
        match kind.map(|kind| if kind == 3 { 2 } else { kind }) {
            Some(kind) if kind >= self.kind => self.kind = kind,
            _ => {
                let message = format!("this record has no line {} here", quoted(word));
                return Err(Fault::new(CODE, start..scan.at, message, DAMAGED));
            }
        }
        match kind {
            Some(0) => self.split(scan)?,
            Some(1) => self.fan(scan)?,
            Some(2) => self.edge(scan)?,
            Some(3) => self.face(scan)?,
            _ => self.parent(scan)?,
        }
        nothing_more(scan)
    }

    fn split(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let vertices = i64::from(self.mesh_vertices());
        let last = self.record.splits.last().map_or(1, |last| last.vertex + 1);
        let vertex = whole(scan, i64::from(last) + 1, vertices)? - 1;
        let from = whole(scan, 1, i64::from(vertex))? - 1;
        let cut = whole(scan, 1, i64::from(u32::MAX) - 1)?;
        push(&mut self.record.splits, SplitOff { vertex, from, cut });
        Ok(())
    }

    fn fan(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let vertices = i64::from(self.header.as_ref().map_or(0, |header| header.vertices));
        let split = self.record.splits.last().map_or(0, |last| last.vertex + 1);
        // The first says where the copies begin; they go on from there to the last vertex.
        let (least, most) = match self.first_copy {
            None => (i64::from(split) + 1, vertices),
            Some(first) => (i64::from(first) + 1 + self.fans.len() as i64, vertices),
        };
        let most = if self.first_copy.is_some() {
            least.min(most)
        } else {
            most
        };
        let copy = whole(scan, least, most)? - 1;
        let first = *self.first_copy.get_or_insert(copy);
        let of = whole(scan, 1, i64::from(first))? - 1;
        push(&mut self.fans, of);
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
        let vertex = whole(scan, 1, i64::from(self.mesh_vertices()))? - 1;
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
        record.texture_before = before(header.texture, document.texture.len());
        record.normals_before = before(header.normals, document.normals.len());
        join(document, &mut record, &self.fans);
        document.record = Some(Box::new(record));
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
        // What a record says that was made by no one who knew the faces.
        let count = self.first_copy.unwrap_or(header.vertices);
        let roots = self.record.roots(count as usize);
        let root = |vertex: u32| {
            let copy = vertex.checked_sub(count);
            let vertex = copy.map_or(vertex, |copy| self.fans[copy as usize]);
            roots[vertex as usize]
        };
        let mut has_face = vec![false; count as usize];
        for corners in document.triangles() {
            let [a, b, c] = corners.map(root);
            if a == b || b == c || c == a {
                return Some("this record is not used: it joins corners of a face".to_owned());
            }
            for vertex in corners.iter().filter(|&&vertex| vertex < count) {
                has_face[*vertex as usize] = true;
            }
        }
        let split = self.record.splits.iter();
        let mut split = split.flat_map(|split| [split.vertex, split.from]);
        if split.any(|vertex| !has_face[vertex as usize]) {
            return Some("this record is not used: it splits vertices without faces".to_owned());
        }
        None
    }
}

/// How many elements there were before any was inserted, if the file has as many as it had.
fn before([before, all]: [u32; 2], count: usize) -> usize {
    if all as usize == count {
        count.min(before as usize)
    } else {
        count
    }
}

/// Makes each vertex and its copies one, but for copies that were moved away: these become
/// vertices that the last cut split off.
fn join(document: &mut Document, record: &mut Record, fans: &[u32]) {
    let count = document.positions.len() - fans.len();
    let cut = record.last_cut().max(1);
    let bits = |document: &Document, v: usize| -> Vec<u64> {
        let at = document.positions[v];
        let extras = document.extras.row(v).iter().copied();
        let numbers = [at.x, at.y, at.z].into_iter().chain(extras);
        numbers.map(f64::to_bits).collect()
    };
    let mut moved = Vec::new();
    let mut vertices = Vec::with_capacity(fans.len());
    for (copy, &of) in (count..).zip(fans) {
        if bits(document, copy) == bits(document, of as usize) {
            vertices.push(of);
        } else {
            vertices.push((count + moved.len()) as u32);
            moved.push((copy, of));
        }
    }
    let line = moved
        .first()
        .map(|&(copy, _)| document.line_of_vertex(copy));
    if !fans.is_empty() {
        for vertex in &mut document.polygons.vertices {
            if let Some(copy) = (*vertex as usize).checked_sub(count) {
                *vertex = vertices[copy];
            }
        }
    }
    let rows = moved
        .iter()
        .map(|&(copy, _)| document.extras.row(copy).to_vec());
    let rows: Vec<Vec<f64>> = rows.collect();
    document.extras.truncate(count);
    for (i, (&(copy, of), row)) in moved.iter().zip(&rows).enumerate() {
        let vertex = count + i;
        document.positions[vertex] = document.positions[copy];
        if !row.is_empty() {
            document.extras.set(vertex, row);
        }
        push(
            &mut record.splits,
            SplitOff {
                vertex: vertex as u32,
                from: of,
                cut,
            },
        );
    }
    document.positions.truncate(count + moved.len());
    let Document { layout, text, .. } = document;
    layout.drop_last_vertices(fans.len() - moved.len(), text, said::left_without_vertex);
    if let (Some(&(copy, of)), Some(line)) = (moved.first(), line) {
        let more = match moved.len() {
            1 => String::new(),
            many => format!(", and {} more such", many - 1),
        };
        document.diagnostics.push(Diagnostic {
            level: Level::Warning,
            code: "W-OBJ-RECORD-MOVED",
            location: Some(Location { line, column: 1 }),
            message: format!(
                "`v` {} was a copy of {} and is at another place now: it is a vertex of its own{more}",
                copy + 1,
                of + 1
            ),
            excerpt: None,
            help: None,
        });
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

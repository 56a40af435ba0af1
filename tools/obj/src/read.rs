//! Reading: bytes to a [`Document`], in one pass.
//!
//! Strict where a mistake would change the model (numbers, indices, faces), and lenient where
//! files merely differ (line ends, blanks, signs, trailing slashes). What is not
//! understood is kept as bytes, and reported.
//!
//! One pass over the input in blocks of whole lines, of 64 KiB or one line, which lie where the input
//! has them; nothing is allocated for a line, and where it ends is found as it is read. Several
//! hundred megabytes a second.

mod decimal;
mod face;
mod fault;
mod fits;
mod foreign;
mod forward;
mod items;
mod reader;
mod record;
mod restore;
mod sample;
mod scan;
mod source;
mod statements;
mod tally;
pub(crate) mod text;
mod words;

use std::io::BufRead;

use self::fault::{Fault, Line, Parsed};
use self::foreign::binary;
use self::forward::beyond;
use self::reader::Reader;
use self::scan::Scan;
use self::source::{Source, first_line};
use crate::diagnostic::{Diagnostic, Level, Location, ReadError};
use crate::document::Document;
use crate::opening::{MARK, Opening};
use crate::store::Kind;
use crate::triangulate::triangles;

impl Document {
    /// Reads an OBJ file. Bytes in memory are read in place; the buffer of a file should have some tens
    /// of kilobytes.
    ///
    /// # Errors
    ///
    /// [`ReadError::Refused`] describes the first error in the file, with line, column and text;
    /// [`ReadError::Input`] if the input fails.
    ///
    /// ```
    /// use tearmesh_obj::Document;
    ///
    /// let error = Document::read(&b"v 0 0 0\nv 1 0,5 0\n"[..]).unwrap_err();
    /// assert_eq!(error.to_string(), "line 2, column 5: cannot read number `0,5`");
    /// ```
    pub fn read(input: impl BufRead) -> Result<Document, ReadError> {
        let mut source = Source::new(input);
        let mut reader = Reader::default();
        reader.start(&mut source)?;
        reader.document.make_room(source.first()?);
        while let Some(block) = source.block(reader.number())? {
            reader.block(block)?;
        }
        drop(source); // Its memory is not within the bound for what comes.
        reader.document.give_back_room();
        reader.finish()
    }
}

impl Reader {
    /// Drops a byte order mark, and recognises what is no OBJ file from its first bytes.
    fn start(&mut self, source: &mut Source<impl BufRead>) -> Result<(), ReadError> {
        let fault = loop {
            match Opening::of(source.first()?) {
                Opening::Text => return Ok(()),
                Opening::Mark => source.skip(MARK.len()),
                Opening::Utf16 => break utf16(),
                Opening::Binary => break binary(0, b'g'),
            }
            if self.document.diagnostics.is_empty() {
                let message = "the byte order mark at the start is dropped".to_owned();
                self.document.diagnostics.push(Diagnostic {
                    level: Level::Note,
                    ..Diagnostic::warning("W-OBJ-BOM", 1, message)
                });
            }
        };
        let first = source.first()?;
        let bytes = &first[..first.len().min(Opening::LENGTH)];
        Err(fault.at(&Line { bytes, number: 1 }))
    }

    /// Reads whole lines.
    fn block(&mut self, bytes: &[u8]) -> Result<(), ReadError> {
        let number = self.number();
        let mut scan = Scan::new(Line { bytes, number });
        while !scan.line.bytes.is_empty() {
            if scan.line.number == u32::MAX {
                return Err(too_many_lines(scan.line));
            }
            if let Err(fault) = self.statement(&mut scan) {
                return Err(textual(fault, scan.line));
            }
            scan.start_next_line();
        }
        self.lines = scan.line.number - 1;
        Ok(())
    }

    /// Reads a statement and the line end behind it.
    #[inline(always)]
    fn statement(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        match scan.line.bytes {
            [b'f', b' ', ..] => self.face(scan.behind(2))?,
            [b'v', b' ', ..] => self.vertex(scan.behind(2))?,
            [b'v', b't', b' ', ..] => self.texture(scan.behind(3))?,
            [b'v', b'n', b' ', ..] => self.normal(scan.behind(3))?,
            _ => {
                *scan = self.unusual_statement(*scan)?;
                return Ok(());
            }
        }
        match scan.rest {
            [b'\n', rest @ ..] | [b'\r', b'\n', rest @ ..] => scan.rest = rest,
            _ => scan.rest = self.comment(*scan)?,
        }
        Ok(())
    }

    #[inline(never)]
    fn unusual_statement<'l>(&mut self, mut scan: Scan<'l>) -> Parsed<Scan<'l>> {
        if !scan.peek().is_some_and(|byte| byte.is_ascii_alphabetic()) {
            scan.find_token();
        }
        let keyword = scan.token();
        let start = scan.at();
        scan.skip(keyword.len());
        match keyword {
            b"v" => self.vertex(&mut scan)?,
            // `fo` (face outline) is older than version 2.11, of which the format says that it is
            // still read, gives the same results as `f`, and is written as `f`.
            b"f" | b"fo" => self.face(&mut scan)?,
            b"vt" => self.texture(&mut scan)?,
            b"vn" => self.normal(&mut scan)?,
            _ => {
                let (end, behind, lines) = first_line(scan.line.bytes);
                let line = Line {
                    bytes: &scan.line.bytes[..end],
                    ..scan.line
                };
                self.carry(&line, start, keyword)?;
                scan.go_to(behind);
                scan.continuations = lines - 1;
                return Ok(scan);
            }
        }
        scan.rest = self.comment(scan)?;
        Ok(scan)
    }

    /// Judges what can be judged only when the whole file is known.
    fn finish(mut self) -> Result<Document, ReadError> {
        let offenders = Kind::INDEXED.into_iter().filter_map(|kind| {
            let count = self.count(kind);
            let step = self.forward[kind as usize].first_beyond(count)?;
            Some((step, kind, count))
        });
        if let Some((step, kind, count)) = offenders.min_by_key(|(step, ..)| step.place) {
            return Err(beyond(kind, step, count));
        }
        if self.document.polygons.len() == 0 {
            return Err(self.no_face());
        }
        self.record.finish(&mut self.document);
        self.document.triangulate();
        self.tally.report(&mut self.document.diagnostics);
        Ok(self.document)
    }

    #[cold]
    fn no_face(&self) -> ReadError {
        let help = match self.tally.first_unknown() {
            Some(b"ply") => "this looks like a PLY file; convert it to OBJ first",
            Some(b"solid") => "this looks like an STL file; convert it to OBJ first",
            Some(b"OFF") => "this looks like an OFF file; convert it to OBJ first",
            Some(b"newmtl") => "this is a material library; read the OBJ file that names it",
            _ => "a mesh needs faces (`f`); lines, points and curves have none",
        };
        let message = match self.document.positions.len() {
            0 => "this file has no face".to_owned(),
            1 => "this file has no face, only 1 vertex".to_owned(),
            count => format!("this file has no face, only {count} vertices"),
        };
        let line = self.lines.max(1) as usize;
        Diagnostic::error(
            "E-OBJ-EMPTY",
            Some(Location { line, column: 1 }),
            message,
            help,
        )
        .into()
    }
}

impl Document {
    /// Cuts polygons into triangles, and says so.
    pub(crate) fn triangulate(&mut self) {
        if self.polygons.all_triangles() {
            return;
        }
        let all = triangles(&self.polygons, &self.positions);
        let larger = |&polygon: &usize| self.polygons.corners(polygon).len() > 3;
        let mut polygons = (0..self.polygons.len()).filter(larger);
        let first = polygons.next().expect("not all polygons are triangles");
        let count = 1 + polygons.count();
        let triangles = all.len() - (self.polygons.len() - count);
        let message = match count {
            1 => format!("1 face with more than 3 corners is cut into {triangles} triangles"),
            _ => format!(
                "{count} faces with more than 3 corners are cut into {triangles} triangles (the first here)"
            ),
        };
        let line = self.layout.line_of_polygon(first);
        self.diagnostics
            .push(Diagnostic::warning("W-OBJ-QUAD", line, message));
        self.triangulation = Some(all);
    }
}

#[cold]
fn utf16() -> Box<Fault> {
    Fault::new(
        "E-OBJ-UTF16",
        0..0,
        "this is a UTF-16 file",
        "expected UTF-8 or ASCII",
    )
    .help("save it as UTF-8")
}

/// Whatever is wrong with a line that holds a zero byte, is that it is no text.
#[cold]
fn textual(fault: Box<Fault>, line: Line<'_>) -> ReadError {
    let (end, ..) = first_line(line.bytes);
    match memchr::memchr(0, &line.bytes[..end]) {
        Some(at) => binary(at, 0).at(&line),
        None => fault.at(&line),
    }
}

#[cold]
fn too_many_lines(line: Line<'_>) -> ReadError {
    let message = format!("the file has more than {} lines", u32::MAX - 1);
    Fault::new("E-OBJ-LIMIT", 0..0, message, "").at(&Line { bytes: b"", ..line })
}

//! Reading: bytes to a [`Document`], in one pass.
//!
//! Strict where a mistake would change the model (numbers, indices, faces), and lenient where
//! files merely differ (line ends, blanks, signs, trailing slashes). What is not
//! understood is kept as bytes, and reported.
//!
//! One pass over the input in chunks of 64 KiB; nothing is allocated for a line. Several hundred
//! megabytes a second.

mod apart;
mod copies;
mod decimal;
mod face;
mod fault;
mod fits;
mod foreign;
mod forward;
mod index;
mod items;
mod line;
mod lines;
mod numbers;
mod reader;
mod record;
mod scan;
mod tally;
pub(crate) mod text;
mod usual;
mod words;

use std::io::Read;

use self::fault::{Fault, Parsed, refuse};
use self::foreign::binary;
use self::forward::beyond;
use self::index::Element;
use self::line::Line;
use self::lines::Lines;
use self::reader::Reader;
use self::scan::Scan;
use crate::diagnostic::{Diagnostic, Level, Location, ReadError};
use crate::document::Document;
use crate::opening::{MARK, Opening};
use crate::polygons::Polygons;
use crate::triangulate::Triangulation;

impl Document {
    /// Reads an OBJ file. The input need not be buffered.
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
    pub fn read(input: impl Read) -> Result<Document, ReadError> {
        let mut lines = Lines::new(input);
        let mut reader = Reader::default();
        reader.start(&mut lines)?;
        loop {
            let (count, bytes) = reader.usual_lines(lines.buffered(), lines.number());
            lines.skip_lines(count, bytes);
            let Some(line) = lines.next()? else { break };
            reader
                .statement(&line)
                .map_err(|fault| textual(fault, &line).at(&line))?;
        }
        let last_line = lines.number().saturating_sub(1).max(1);
        reader.finish(last_line as usize)
    }
}

impl Reader {
    /// Drops a byte order mark, and recognises what is no OBJ file from its first bytes.
    fn start(&mut self, lines: &mut Lines<impl Read>) -> Result<(), ReadError> {
        let mut opening = Opening::of(lines.peek(Opening::LENGTH)?);
        if opening == Opening::Mark {
            self.document.diagnostics.push(Diagnostic {
                level: Level::Note,
                code: "W-OBJ-BOM",
                location: Some(Location { line: 1, column: 1 }),
                message: "the byte order mark at the start is dropped".to_owned(),
                excerpt: None,
                help: None,
            });
        }
        while opening == Opening::Mark {
            lines.skip(MARK.len());
            opening = Opening::of(lines.peek(Opening::LENGTH)?);
        }
        let fault = match opening {
            Opening::Text | Opening::Mark => return Ok(()),
            Opening::Utf16 => utf16(),
            Opening::Binary => binary(0, b'g'),
        };
        let first = lines.peek(Opening::LENGTH)?;
        Err(fault.at(&Line {
            bytes: &first[..first.len().min(Opening::LENGTH)],
            number: 1,
        }))
    }

    #[inline]
    fn statement(&mut self, line: &Line<'_>) -> Parsed<()> {
        let mut scan = Scan::new(line.bytes);
        scan.find_token();
        let keyword = scan.token();
        let start = scan.at;
        scan.at += keyword.len();
        match keyword {
            b"v" => self.vertex(line, &mut scan)?,
            // `fo` (face outline) is older than version 2.11, of which the format says that it is
            // still read, gives the same results as `f`, and is written as `f`.
            b"f" | b"fo" => self.face(line, &mut scan)?,
            b"vt" => self.texture(line, &mut scan)?,
            b"vn" => self.normal(line, &mut scan)?,
            _ => return self.carry(line, &mut Scan { at: start, ..scan }),
        }
        self.carry_comment(line, &scan)
    }

    /// Judges what can be judged only when the whole file is known.
    fn finish(mut self, last_line: usize) -> Result<Document, ReadError> {
        let offenders = Element::ALL.iter().filter_map(|&element| {
            let count = self.count(element);
            Some((
                self.forward[element as usize].first_beyond(count)?,
                element,
                count,
            ))
        });
        if let Some((step, element, count)) = offenders.min_by_key(|&((location, ..), ..)| location)
        {
            return Err(beyond(element.name(), element.plural(), step, count));
        }
        if self.document.polygons.len() == 0 {
            return Err(self.no_face(last_line));
        }
        self.record.finish(&mut self.document);
        self.document.shrink();
        self.document.triangulate();
        self.tally.report(&mut self.document.diagnostics);
        Ok(self.document)
    }

    #[cold]
    fn no_face(&self, last_line: usize) -> ReadError {
        let help = match self.tally.first.as_deref() {
            Some(b"ply") => "this looks like a PLY file; convert it to OBJ first",
            Some(b"solid") => "this looks like an STL file; convert it to OBJ first",
            Some(b"OFF") => "this looks like an OFF file; convert it to OBJ first",
            Some(b"newmtl") => "this is a material library; read the OBJ file that names it",
            _ => "a cut needs faces (`f`); lines, points and curves have none",
        };
        let message = match self.document.positions.len() {
            0 => "this file has no face".to_owned(),
            1 => "this file has no face, only 1 vertex".to_owned(),
            count => format!("this file has no face, only {count} vertices"),
        };
        let location = Location {
            line: last_line,
            column: 1,
        };
        refuse(
            "E-OBJ-EMPTY",
            location,
            message,
            None,
            Some(help.to_owned()),
        )
    }
}

impl Document {
    /// Gives back memory that was reserved and is not needed.
    pub(crate) fn shrink(&mut self) {
        let Polygons {
            vertices,
            texture,
            normals,
            starts,
        } = &mut self.polygons;
        vertices.shrink_to_fit();
        texture.shrink();
        normals.shrink();
        starts.shrink_to_fit();
        self.positions.shrink_to_fit();
        self.extras.shrink();
        self.texture.shrink();
        self.normals.shrink_to_fit();
        self.layout.shrink();
        self.text.shrink_to_fit();
    }

    /// Cuts polygons into triangles, and says so.
    pub(crate) fn triangulate(&mut self) {
        if self.polygons.all_triangles() {
            return;
        }
        let triangulation = Triangulation::of(&self.polygons, &self.positions);
        let larger = |&polygon: &usize| self.polygons.corners(polygon).len() > 3;
        let mut polygons = (0..self.polygons.len()).filter(larger);
        let first = polygons.next().expect("not all polygons are triangles");
        let count = 1 + polygons.count();
        let triangles = triangulation.triangles.len() - (self.polygons.len() - count);
        let message = match count {
            1 => format!("1 face with more than 3 corners is cut into {triangles} triangles"),
            _ => format!(
                "{count} faces with more than 3 corners are cut into {triangles} triangles (the first here)"
            ),
        };
        self.diagnostics.push(Diagnostic {
            level: Level::Warning,
            code: "W-OBJ-QUAD",
            location: Some(Location {
                line: self.layout.line_of_polygon(first),
                column: 1,
            }),
            message,
            excerpt: None,
            help: None,
        });
        self.triangulation = Some(triangulation);
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
fn textual(fault: Box<Fault>, line: &Line<'_>) -> Box<Fault> {
    match line.bytes.iter().position(|&byte| byte == 0) {
        Some(at) => binary(at, 0),
        None => fault,
    }
}

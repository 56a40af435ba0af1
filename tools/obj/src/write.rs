//! Writing: a document and the mesh that was cut out of it, to bytes.
//!
//! **Order.** Statements come in the order of the document, and polygons as their triangles. The
//! vertices of the mesh keep their numbers: the document's own come first, then those that splits
//! added. The new ones follow the last `v` of the document and what is said of it, each with a copy
//! of what `ARCSim` says of the vertex that it was split from (`said.rs`). Where a face needs a
//! vertex before that (a file of several objects has `v` after `f`), the statements it needs are
//! moved up to just before it, each with the foreign statements attached to it. So no face precedes
//! its vertices, and no number changes. What `ARCSim` says of a vertex is written behind that
//! vertex, wherever it stood: no `v` comes between them.
//!
//! **Bow-ties.** A split may leave a vertex with several fans (the tip of a finite cut).
//! Other programs, and our own [`Document::mesh`], would take such a vertex for a
//! defect, so it is written as several `v`, one a fan: the fan with the smallest half-edge keeps
//! the number (by the order of the file), the others follow all vertices of the mesh.
//!
//! **The record** (`record.rs`) is the end of the file.
//!
//! **Bytes.** Line ends are `\n`; numbers have the shortest digits that read back
//! as the same bits; everything else keeps its bytes. A line which would say at the start of the
//! file what it does not elsewhere (`opening.rs`) has an empty one before it there. Reading what
//! was written, and writing it again, gives the same bytes.

mod number;
mod output;
mod prepare;
mod record;
mod separate;

use std::io::{self, Write};

use tearmesh::{Mesh, Positions};

use self::number::write_integer;
use self::output::Output;
pub(crate) use self::prepare::Prepared;
use self::record::write_record;
use crate::document::Document;
use crate::read::attached_length;
use crate::record::Hash;
use crate::said;
use crate::store::{Kind, Run};
use crate::torn::TornDocument;

/// What was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WriteSummary {
    /// The number of `v` statements.
    pub vertices: usize,
    /// The number of `f` statements, all of them triangles.
    pub faces: usize,
    /// How many of the vertices were added because a vertex of the mesh had
    /// several fans.
    pub separated: usize,
}

impl Document {
    /// Writes the document with the faces of `mesh`, its vertices at `positions`, and if it is
    /// torn with a record of that at the end.
    ///
    /// The mesh is that of [`Document::mesh`], after any number of splits, all of which go on
    /// record as one cut. Insertions, merges, and cuts that are to be undone one by one need a
    /// [`TornDocument`].
    ///
    /// # Errors
    ///
    /// Those of the output.
    ///
    /// # Panics
    ///
    /// If the mesh has not as many faces as the document has triangles, or fewer vertices; or
    /// if there is not a position for each vertex.
    pub fn write(
        &self,
        mesh: &Mesh,
        positions: &Positions,
        out: &mut impl Write,
    ) -> io::Result<WriteSummary> {
        assert_eq!(
            mesh.face_count(),
            self.triangles().len(),
            "a split neither adds nor drops a face"
        );
        assert!(
            mesh.vertex_count() >= self.positions.len(),
            "a split never drops a vertex"
        );
        TornDocument::after_splits(self, mesh).write(mesh, positions, out)
    }
}

impl TornDocument<'_> {
    /// Writes the document with the faces of `mesh`, its vertices at `positions`, and if it
    /// is torn or was divided, with a record of that at the end.
    ///
    /// # Errors
    ///
    /// Those of the output.
    ///
    /// # Panics
    ///
    /// If the mesh is not the one whose log was followed, to its end, or if there is not a
    /// position for each vertex.
    pub fn write(
        &self,
        mesh: &Mesh,
        positions: &Positions,
        out: &mut impl Write,
    ) -> io::Result<WriteSummary> {
        self.assert_in_step(mesh, positions);
        write(self, &Prepared::new(self, mesh, None), positions, out)
    }

    /// Writes the document like [`TornDocument::write`], but with one `v` for each vertex of the mesh.
    ///
    /// A vertex keeps its number in whatever is written later, and new ones get numbers that no
    /// file had before: for pictures of a mesh as it tears. A vertex with several fans is one here,
    /// which other programs may take for a defect; [`Document::mesh`] knows from the record that it
    /// was torn.
    ///
    /// # Errors
    ///
    /// Those of the output.
    ///
    /// # Panics
    ///
    /// As [`TornDocument::write`].
    pub fn write_unseparated(
        &self,
        mesh: &Mesh,
        positions: &Positions,
        out: &mut impl Write,
    ) -> io::Result<WriteSummary> {
        self.assert_in_step(mesh, positions);
        write(self, &Prepared::unseparated(self, mesh), positions, out)
    }
}

/// Writes what was prepared.
pub(crate) fn write(
    torn: &TornDocument<'_>,
    prepared: &Prepared<'_>,
    positions: &Positions,
    out: &mut impl Write,
) -> io::Result<WriteSummary> {
    let vertices = prepared.vertices.count();
    let writer = Writer {
        document: torn.document(),
        torn,
        prepared,
        positions,
        vertices: Stream::new(Kind::Vertex),
        texture: Stream::new(Kind::Texture),
        normals: Stream::new(Kind::Normal),
        added: [false; 3],
        hash: Hash::of_faces(vertices),
        out: Output::new(out),
    };
    writer.write()?;
    Ok(WriteSummary {
        vertices,
        faces: prepared.face_count(),
        separated: prepared.fans().count(),
    })
}

struct Writer<'d, W> {
    document: &'d Document,
    torn: &'d TornDocument<'d>,
    prepared: &'d Prepared<'d>,
    positions: &'d Positions,
    vertices: Stream,
    texture: Stream,
    normals: Stream,
    /// Whether the vertices, texture coordinates and normals that the document has not
    /// were written.
    added: [bool; 3],
    /// That of the faces written so far.
    hash: Hash,
    out: Output<'d, W>,
}

/// How far the statements of a kind have been written. They may be ahead of the rest.
#[derive(Clone, Copy)]
struct Stream {
    kind: Kind,
    /// The number of statements written.
    written: usize,
    /// The run to go on with, how many statements of this kind come before it, and
    /// how many bytes of text.
    run: usize,
    before: usize,
    text_before: usize,
}

impl Stream {
    fn new(kind: Kind) -> Stream {
        Stream {
            kind,
            written: 0,
            run: 0,
            before: 0,
            text_before: 0,
        }
    }

    /// The next statements to write so that `count` are written, and then the run that they
    /// complete, if they do.
    fn advance(&mut self, runs: &[Run], count: usize) -> Option<(std::ops::Range<usize>, bool)> {
        if self.written >= count {
            return None;
        }
        loop {
            let run = runs.get(self.run)?;
            let end = self.before + run.count as usize;
            if run.kind == self.kind && self.written < end {
                let first = self.written;
                self.written = end.min(count);
                return Some((first..self.written, self.written == end));
            }
            match run.kind {
                Kind::Text => self.text_before += run.count as usize,
                kind if kind == self.kind => self.before = end,
                _ => {}
            }
            self.run += 1;
        }
    }
}

impl<W: Write> Writer<'_, W> {
    fn write(mut self) -> io::Result<()> {
        let document = self.document;
        let runs = document.layout.runs();
        let (mut vertices, mut texture, mut normals, mut polygons) = (0, 0, 0, 0);
        let mut text = &document.text[..];
        // They say something of no vertex, and go on doing so.
        self.out.text(self.prepared.said.late(0))?;
        for (i, run) in runs.iter().enumerate() {
            let count = run.count as usize;
            match run.kind {
                Kind::Vertex => {
                    vertices += count;
                    self.write_vertices(vertices)?;
                }
                Kind::Texture => {
                    texture += count;
                    self.write_texture(texture)?;
                }
                Kind::Normal => {
                    normals += count;
                    self.write_normals(normals)?;
                }
                Kind::Polygon => {
                    for polygon in polygons..polygons + count {
                        self.write_polygon(polygon)?;
                    }
                    polygons += count;
                }
                Kind::Text => {
                    let (lines, rest) = text.split_at(count);
                    let written = i
                        .checked_sub(1)
                        .map_or(0, |before| attached_to(runs[before], lines));
                    text = rest;
                    let lines = &lines[written..];
                    if self.prepared.said.has_late() {
                        self.out.text(&said::left_without_vertex(lines))?;
                    } else {
                        self.out.text(lines)?;
                    }
                }
            }
        }
        write_record(self.prepared, self.hash, &mut self.out)?;
        self.out.flush()
    }

    /// Writes vertices of the document, with what is attached to them, so that `count`
    /// are written; after the last one, the vertices that the document has not.
    fn write_vertices(&mut self, count: usize) -> io::Result<()> {
        let (document, prepared) = (self.document, self.prepared);
        let runs = document.layout.runs();
        while let Some((range, completes_run)) = self.vertices.advance(runs, count) {
            // Of a mended mesh the last vertices of the document are gone.
            for vertex in range.start..range.end.min(prepared.mesh_vertices) {
                self.write_vertex(vertex)?;
            }
            if completes_run {
                let last = range.end - 1;
                let is_gone = last >= prepared.mesh_vertices || !prepared.vertices.has(last);
                self.write_attached(self.vertices, is_gone)?;
                if !is_gone {
                    self.out.text(prepared.said.late(range.end))?;
                }
            }
        }
        self.write_added()
    }

    /// Writes the vertices that the document has not, if all that it has are written.
    fn write_added(&mut self) -> io::Result<()> {
        let of_document = self.document.positions.len();
        let prepared = self.prepared;
        if self.vertices.written < of_document || self.added[0] {
            return Ok(());
        }
        self.added[0] = true;
        let all = prepared.mesh_vertices + prepared.separated.copies.len();
        for index in of_document.min(prepared.mesh_vertices)..all {
            self.write_vertex(index)?;
            if let Some(origin) = prepared
                .origin(index)
                .filter(|_| prepared.vertices.has(index))
            {
                self.out.text(prepared.said.of(origin))?;
            }
        }
        Ok(())
    }

    /// The same for texture coordinates.
    fn write_texture(&mut self, count: usize) -> io::Result<()> {
        let (document, prepared) = (self.document, self.prepared);
        while let Some((range, completes_run)) = self.texture.advance(document.layout.runs(), count)
        {
            for index in range.filter(|&index| prepared.texture.has(index)) {
                self.out
                    .statement(b"vt", document.texture.row(index), &[])?;
            }
            if completes_run {
                self.write_attached(self.texture, prepared.said.has_late())?;
            }
        }
        let of_document = document.texture.len();
        if self.texture.written == of_document && !self.added[1] {
            self.added[1] = true;
            if let Some(rows) = self.torn.new_texture() {
                for new in (0..rows.len()).filter(|new| prepared.texture.has(of_document + new)) {
                    self.out.statement(b"vt", rows.row(new), &[])?;
                }
            }
        }
        Ok(())
    }

    /// The same for normals.
    fn write_normals(&mut self, count: usize) -> io::Result<()> {
        let (document, prepared) = (self.document, self.prepared);
        while let Some((range, completes_run)) = self.normals.advance(document.layout.runs(), count)
        {
            for index in range.filter(|&index| prepared.normals.has(index)) {
                self.out.statement(b"vn", &document.normals[index], &[])?;
            }
            if completes_run {
                self.write_attached(self.normals, prepared.said.has_late())?;
            }
        }
        let of_document = document.normals.len();
        if self.normals.written == of_document && !self.added[2] {
            self.added[2] = true;
            for (new, normal) in self.torn.new_normals().iter().enumerate() {
                if prepared.normals.has(of_document + new) {
                    self.out.statement(b"vn", normal, &[])?;
                }
            }
        }
        Ok(())
    }

    /// Writes the foreign statements directly after the run that a stream has completed, and
    /// perhaps not what they say of a vertex, which is gone or has been told.
    fn write_attached(&mut self, stream: Stream, without_vertex: bool) -> io::Result<()> {
        let runs = self.document.layout.runs();
        let Some(&Run {
            kind: Kind::Text,
            count,
            ..
        }) = runs.get(stream.run + 1)
        else {
            return Ok(());
        };
        let lines = &self.document.text[stream.text_before..][..count as usize];
        let lines = &lines[..attached_to(runs[stream.run], lines)];
        if without_vertex {
            self.out.text(&said::left_without_vertex(lines))
        } else {
            self.out.text(lines)
        }
    }

    fn write_polygon(&mut self, polygon: usize) -> io::Result<()> {
        let (document, prepared, torn) = (self.document, self.prepared, self.torn);
        let faces = prepared.slots.of(document.polygons.triangles(polygon));
        let faces = &prepared.slots.faces[faces];
        if torn.is_undivided() && prepared.removes_nothing() {
            for corner in document.polygons.corners(polygon) {
                let corner = document.polygons.corner(corner);
                self.write_indices([corner.texture, corner.normal])?;
            }
        } else {
            for h in faces.iter().flat_map(|&face| prepared.half_edges(face)) {
                self.write_indices(torn.corner_of(h as usize))?;
            }
        }
        let of_document = document.positions.len();
        for h in faces.iter().flat_map(|&face| prepared.half_edges(face)) {
            let vertex = prepared.separated.indices[h as usize] as usize;
            let needed = if vertex < prepared.mesh_vertices {
                of_document.min(vertex + 1)
            } else {
                of_document
            };
            self.write_vertices(needed)?;
            if vertex >= of_document.min(prepared.mesh_vertices) {
                self.write_added()?;
            }
        }
        for &face in faces {
            self.write_triangle(prepared.half_edges(face), polygon)?;
        }
        Ok(())
    }

    /// Writes texture coordinates and normals as far as a corner needs them.
    fn write_indices(&mut self, [texture, normal]: [Option<u32>; 2]) -> io::Result<()> {
        if let Some(texture) = texture {
            self.write_texture(self.document.texture.len().min(texture as usize + 1))?;
        }
        if let Some(normal) = normal {
            self.write_normals(self.document.normals.len().min(normal as usize + 1))?;
        }
        Ok(())
    }

    fn write_triangle(&mut self, half_edges: [u32; 3], polygon: usize) -> io::Result<()> {
        let prepared = self.prepared;
        let out = &mut self.out.pending;
        out.push(b'f');
        for h in half_edges {
            let vertex = prepared.separated.indices[h as usize];
            let vertex = prepared.vertices.of(vertex);
            self.hash.add_corner(vertex);
            let [texture, normal] = self.torn.corner(h as usize, polygon);
            out.push(b' ');
            write_integer(out, u64::from(vertex) + 1);
            if texture.is_some() || normal.is_some() {
                out.push(b'/');
            }
            if let Some(texture) = texture {
                write_integer(out, u64::from(prepared.texture.of(texture)) + 1);
            }
            if let Some(normal) = normal {
                out.push(b'/');
                write_integer(out, u64::from(prepared.normals.of(normal)) + 1);
            }
        }
        out.push(b'\n');
        self.out.flush_if_full()
    }

    /// Writes a vertex of the mesh, or a copy of one, unless it is left out.
    fn write_vertex(&mut self, index: usize) -> io::Result<()> {
        if !self.prepared.vertices.has(index) {
            return Ok(());
        }
        let vertex = self.prepared.vertex(index);
        let at = self.positions.as_slice()[vertex];
        let extras = self.torn.extra_numbers(vertex);
        self.out.statement(b"v", &[at.x, at.y, at.z], extras)
    }
}

/// How many bytes of the text after a run belong to its last statement.
fn attached_to(run: Run, lines: &[u8]) -> usize {
    match run.kind {
        Kind::Vertex | Kind::Texture | Kind::Normal => attached_length(lines),
        Kind::Polygon | Kind::Text => 0,
    }
}

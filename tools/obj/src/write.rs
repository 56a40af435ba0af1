//! Writing: a document and the mesh that was cut out of it, to bytes.
//!
//! **Order.** Statements come in the order of the document, and polygons as their triangles.
//! The vertices of the mesh keep their numbers: the document's own come first, then those that
//! splits added. The new ones follow the last `v` of the document and what is said of it, each with
//! a copy of what `ARCSim` says of the vertex that it was split from (`said.rs`). Where a face needs a vertex
//! before that (a file of several objects has `v` after `f`), the statements it needs are moved
//! up to just before it, each with the foreign statements attached to it (`nv` of `ARCSim`). So no face
//! precedes its vertices, and no number changes.
//!
//! **Bow-ties.** A split may leave a vertex with several fans (the tip of a finite cut).
//! Other programs, and our own [`Document::mesh`], would take such a vertex for a
//! defect, so it is written as several `v`, one a fan: the fan with the smallest half-edge keeps
//! the number, the others follow all vertices of the mesh.
//!
//! **Bytes.** Line ends are `\n`; numbers have the shortest digits that read back
//! as the same bits; everything else keeps its bytes. Reading what was written, and
//! writing it again, gives the same bytes.

mod number;
mod separate;

use std::io::{self, Write};

use tearmesh::{Mesh, Positions, VertexId};

use self::number::{write_integer, write_number};
use self::separate::Separated;
use crate::document::Document;
use crate::read::attached_length;
use crate::said::Said;
use crate::store::{Kind, Run};

/// How many bytes are handed to the output at once.
const CHUNK: usize = 64 << 10;

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
    /// Writes the document with the faces of `mesh`, its vertices at `positions`.
    ///
    /// The mesh is that of [`Document::mesh`], after any number of splits.
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
        assert_eq!(
            positions.len(),
            mesh.vertex_count(),
            "every vertex has a position"
        );
        let separated = Separated::new(mesh);
        let copied = (self.positions.len()..mesh.vertex_count())
            .map(|vertex| VertexId::new(vertex).expect("I1: every vertex has an id"));
        let copied = copied.chain(separated.copies.iter().copied());
        let mut copied: Vec<usize> = copied.map(|vertex| mesh.root(vertex).index()).collect();
        copied.sort_unstable();
        copied.dedup();
        let said = Said::in_document(self, &copied);
        let summary = WriteSummary {
            vertices: mesh.vertex_count() + separated.copies.len(),
            faces: mesh.face_count(),
            separated: separated.copies.len(),
        };
        Writer {
            document: self,
            mesh,
            positions,
            separated,
            said,
            vertices: Stream::new(Kind::Vertex),
            texture: Stream::new(Kind::Texture),
            normals: Stream::new(Kind::Normal),
            added: false,
            out: Output {
                sink: out,
                pending: Vec::with_capacity(CHUNK + 4096),
            },
        }
        .write()?;
        Ok(summary)
    }
}

struct Writer<'d, W> {
    document: &'d Document,
    mesh: &'d Mesh,
    positions: &'d Positions,
    separated: Separated<'d>,
    said: Said,
    vertices: Stream,
    texture: Stream,
    normals: Stream,
    /// Whether the vertices that the document has not were written.
    added: bool,
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
                    self.out.text(&lines[written..])?;
                    text = rest;
                    if self.said.late == Some(i) {
                        self.write_added()?;
                    }
                }
            }
        }
        self.out.flush()
    }

    /// Writes vertices of the document, with what is attached to them, so that `count`
    /// are written; after the last one, the vertices that the document has not.
    fn write_vertices(&mut self, count: usize) -> io::Result<()> {
        let document = self.document;
        let runs = document.layout.runs();
        while let Some((range, completes_run)) = self.vertices.advance(runs, count) {
            for vertex in range {
                self.write_vertex(vertex)?;
            }
            if completes_run {
                self.write_attached(self.vertices)?;
            }
        }
        if self.said.late.is_none() {
            self.write_added()?;
        }
        Ok(())
    }

    /// Writes the vertices that the document has not, if all that it has are written.
    fn write_added(&mut self) -> io::Result<()> {
        let of_document = self.document.positions.len();
        if self.vertices.written < of_document || self.added {
            return Ok(());
        }
        self.added = true;
        for vertex in of_document..self.mesh.vertex_count() {
            self.write_copy(vertex)?;
        }
        for copy in 0..self.separated.copies.len() {
            let vertex = self.separated.copies[copy].index();
            self.write_copy(vertex)?;
        }
        Ok(())
    }

    fn write_texture(&mut self, count: usize) -> io::Result<()> {
        while let Some((range, completes_run)) =
            self.texture.advance(self.document.layout.runs(), count)
        {
            for index in range {
                self.out
                    .statement(b"vt", self.document.texture.row(index), &[])?;
            }
            if completes_run {
                self.write_attached(self.texture)?;
            }
        }
        Ok(())
    }

    fn write_normals(&mut self, count: usize) -> io::Result<()> {
        while let Some((range, completes_run)) =
            self.normals.advance(self.document.layout.runs(), count)
        {
            for index in range {
                self.out
                    .statement(b"vn", &self.document.normals[index], &[])?;
            }
            if completes_run {
                self.write_attached(self.normals)?;
            }
        }
        Ok(())
    }

    /// Writes the foreign statements directly after the run that a stream has completed.
    fn write_attached(&mut self, stream: Stream) -> io::Result<()> {
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
        let attached = attached_to(runs[stream.run], lines);
        self.out.text(&lines[..attached])
    }

    fn write_polygon(&mut self, polygon: usize) -> io::Result<()> {
        let document = self.document;
        for corner in document
            .polygons
            .corners(polygon)
            .map(|i| document.polygons.corner(i))
        {
            if let Some(texture) = corner.texture {
                self.write_texture(texture as usize + 1)?;
            }
            if let Some(normal) = corner.normal {
                self.write_normals(normal as usize + 1)?;
            }
        }
        for triangle in document.polygons.triangles(polygon) {
            for corner in 3 * triangle..3 * triangle + 3 {
                let needed = self.separated.indices[corner] as usize + 1;
                self.write_vertices(needed.min(document.positions.len()))?;
                if needed > document.positions.len() {
                    self.write_added()?;
                }
            }
        }
        for triangle in document.polygons.triangles(polygon) {
            self.write_triangle(triangle, polygon)?;
        }
        Ok(())
    }

    fn write_triangle(&mut self, triangle: usize, polygon: usize) -> io::Result<()> {
        let out = &mut self.out.pending;
        out.push(b'f');
        for corner in 0..3 {
            let vertex = self.separated.indices[3 * triangle + corner];
            let of_polygon = self.document.corner_of_polygon(triangle, corner, polygon);
            let from = self.document.polygons.corner(of_polygon);
            out.push(b' ');
            write_integer(out, u64::from(vertex) + 1);
            if from.texture.is_some() || from.normal.is_some() {
                out.push(b'/');
            }
            if let Some(texture) = from.texture {
                write_integer(out, u64::from(texture) + 1);
            }
            if let Some(normal) = from.normal {
                out.push(b'/');
                write_integer(out, u64::from(normal) + 1);
            }
        }
        out.push(b'\n');
        self.out.flush_if_full()
    }

    /// Writes a vertex that the document has not, with what is said of the one it was split from.
    fn write_copy(&mut self, vertex: usize) -> io::Result<()> {
        self.write_vertex(vertex)?;
        let root = self.root(vertex);
        self.out.text(self.said.of(root))
    }

    /// The vertex of the document that a vertex was split from.
    fn root(&self, vertex: usize) -> usize {
        let id = VertexId::new(vertex).expect("I1: every vertex has an id");
        self.mesh.root(id).index()
    }

    /// Writes a vertex of the mesh with the extra numbers of the one it was split from.
    fn write_vertex(&mut self, vertex: usize) -> io::Result<()> {
        let of_document = if vertex < self.document.positions.len() {
            vertex
        } else {
            self.root(vertex)
        };
        let at = self.positions.as_slice()[vertex];
        self.out.statement(
            b"v",
            &[at.x, at.y, at.z],
            self.document.extras.row(of_document),
        )
    }
}

/// How many bytes of the text after a run belong to its last statement.
fn attached_to(run: Run, lines: &[u8]) -> usize {
    match run.kind {
        Kind::Vertex | Kind::Texture | Kind::Normal => attached_length(lines),
        Kind::Polygon | Kind::Text => 0,
    }
}

/// Bytes on their way to the output.
struct Output<'o, W> {
    sink: &'o mut W,
    pending: Vec<u8>,
}

impl<W: Write> Output<'_, W> {
    fn statement(&mut self, keyword: &[u8], numbers: &[f64], more: &[f64]) -> io::Result<()> {
        self.pending.extend_from_slice(keyword);
        for &number in numbers.iter().chain(more) {
            self.pending.push(b' ');
            write_number(&mut self.pending, number);
        }
        self.pending.push(b'\n');
        self.flush_if_full()
    }

    fn text(&mut self, bytes: &[u8]) -> io::Result<()> {
        if bytes.len() > CHUNK {
            self.flush()?;
            return self.sink.write_all(bytes);
        }
        self.pending.extend_from_slice(bytes);
        self.flush_if_full()
    }

    #[inline]
    fn flush_if_full(&mut self) -> io::Result<()> {
        if self.pending.len() < CHUNK {
            Ok(())
        } else {
            self.flush()
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.sink.write_all(&self.pending)?;
        self.pending.clear();
        Ok(())
    }
}

//! Writing: a document and the mesh that was cut out of it, to bytes.
//!
//! **Order.** Statements come in the order of the document, and polygons as their triangles. What the
//! document has not is added behind the section that it comes from (`sections.rs`): a vertex that was
//! split off or inserted behind the last `v` of its object and the foreign statements attached
//! to that; new texture coordinates and normals likewise. So no line moves, and the numbers behind it
//! count on. Where a face comes before what it names, the statements that it and the other parts of a
//! divided face need are moved up to just before it, each with the foreign statements attached to it:
//! no face precedes its vertices. What `ARCSim` says of a vertex is kept like that, too, and not repeated for a copy of the vertex: what a
//! label or a velocity means for two halves, this crate does not know.
//!
//! Why not all new vertices at the end of the file, so that no number ever changes? Other programs drop
//! a face that comes before its vertices, so the `v` of all later objects would have to be written
//! before the first torn face: under another `o`, and away from their comments. Only where a
//! statement that is not understood may name a vertex by its number is that done.
//!
//! **Bow-ties.** A split may leave a vertex with several fans (the tip of a finite cut).
//! Other programs, and our own [`Document::mesh`], would take such a vertex for a
//! defect, so it is written as several `v`, one a fan: the fan with the smallest half-edge keeps
//! the number (by the order of the file), the others come last in its section.
//!
//! **The record** (`record.rs`) is the end of the file.
//!
//! **Bytes.** Line ends are `\n`; numbers have the shortest digits that read back
//! as the same bits; everything else keeps its bytes. A line which would say at the start of the
//! file what it does not elsewhere (`opening.rs`) has an empty one before it there. Reading what
//! was written, and writing it again, gives the same bytes.

mod number;
mod output;
mod piece;
mod prepare;
mod record;
mod separate;

use std::io::{self, Write};

use tearmesh::{Mesh, Positions, VertexId};

use self::output::Output;
pub use self::piece::{PieceNames, PieceWriter};
pub(crate) use self::prepare::Prepared;
use self::record::write_record;
use crate::document::Document;
use crate::read::text::{attached_length, without_statements_of_vertex};
use crate::record::Hash;
use crate::store::{Kind, Run};
use crate::torn::TornDocument;

/// The numbers of statements that were written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WriteSummary {
    /// The number of `v` statements.
    pub vertices: usize,
    /// The number of `f` statements, each of which is a triangle.
    pub faces: usize,
    /// The number of additional `v` statements, one for each further fan of a vertex of the mesh.
    /// `vertices` includes them.
    pub separated: usize,
    /// The number of `ARCSim` statements (`nl`, `ny`, `nv`, `vv`) about a vertex of which copies were
    /// written, or about one behind which new vertices were written before the statement. The copies
    /// have no such statement.
    pub unspoken: usize,
}

impl TornDocument<'_> {
    /// Writes the document with the faces of `mesh` and its vertices at `positions`. If the mesh is
    /// torn or has divided faces, a record of it is added at the end. Points set by
    /// [`TornDocument::set_apart`] are used only if every vertex is still where the log put it.
    ///
    /// # Errors
    ///
    /// Any I/O error of `out`.
    ///
    /// # Panics
    ///
    /// If `mesh` is not the mesh whose log was followed to its end, or if the number of positions is
    /// not its number of vertices.
    pub fn write(
        &self,
        mesh: &Mesh,
        positions: &Positions,
        out: &mut impl Write,
    ) -> io::Result<WriteSummary> {
        self.write_as(mesh, positions, out, true, true)
    }

    /// Returns the vertex of each `v` that [`TornDocument::write`] writes, in order. A vertex with several
    /// fans is listed once for each fan. Vertex `i` of a mesh that is read from the written file is the
    /// `i`-th of those that are listed, each counted once.
    ///
    /// The vertices of the document keep their order. A split-off vertex follows the last vertex of the
    /// object of its root. An inserted vertex follows the last vertex of the object of the vertices that
    /// it was inserted between. So if several objects have vertices of their own, the new vertices of the
    /// first object precede all vertices of the second. New vertices of the same object are in the order
    /// of their creation, and the further `v` of vertices with several fans follow them.
    ///
    /// # Panics
    ///
    /// If `mesh` is not the mesh whose log was followed to its end.
    #[must_use]
    pub fn statements_in_order(&self, mesh: &Mesh) -> Vec<VertexId> {
        let prepared = Prepared::new(self, mesh, Vec::new(), true);
        let elements = prepared.orders[0].in_order().into_iter();
        let vertices = elements.map(|element| prepared.vertex(element));
        vertices.filter_map(VertexId::new).collect()
    }

    /// Writes the document like [`TornDocument::write`], but with one `v` for each vertex of the mesh,
    /// in the order of their ids.
    ///
    /// This is for sequences of files that show a mesh as it tears: a vertex keeps its number in
    /// all later files, and a new vertex gets a number that no earlier file had. For this purpose all
    /// new vertices follow the last `v` of the file, and the `v` of objects after a torn object are
    /// moved up before its faces. A vertex with several fans is written once, which other programs may
    /// treat as a defect; [`Document::mesh`] accepts it because of the record.
    ///
    /// # Errors
    ///
    /// Any I/O error of `out`.
    ///
    /// # Panics
    ///
    /// If `mesh` is not the mesh whose log was followed to its end, or if the number of positions is
    /// not its number of vertices.
    pub fn write_unseparated(
        &self,
        mesh: &Mesh,
        positions: &Positions,
        out: &mut impl Write,
    ) -> io::Result<WriteSummary> {
        self.write_as(mesh, positions, out, false, true)
    }

    /// Writes the document, with a vertex for each fan or with one for each of the mesh. `moves_up` is false
    /// for our own reader, which takes a face that comes before its vertices: no statement leaves its place.
    pub(crate) fn write_as(
        &self,
        mesh: &Mesh,
        positions: &Positions,
        out: &mut impl Write,
        is_separated: bool,
        moves_up: bool,
    ) -> io::Result<WriteSummary> {
        assert_eq!(
            (mesh.vertex_count(), mesh.face_count()),
            (self.vertex_count(), self.face_count()),
            "the document has followed all edits of the mesh"
        );
        assert_eq!(
            positions.len(),
            mesh.vertex_count(),
            "every vertex has a position"
        );
        let apart = match is_separated {
            true => self.apart(positions),
            false => Vec::new(),
        };
        let prepared = Prepared::new(self, mesh, apart, is_separated);
        let vertices = prepared.orders[0].count();
        let writer = Writer {
            document: self.document(),
            torn: self,
            prepared: &prepared,
            positions,
            moves_up,
            ready: 0,
            streams: Default::default(),
            hash: Hash::of_faces(vertices),
            out: Output::new(out),
        };
        writer.write()?;
        Ok(WriteSummary {
            vertices,
            faces: self.face_count(),
            separated: prepared.fans().count(),
            unspoken: prepared.unspoken(self),
        })
    }
}

struct Writer<'d, W> {
    document: &'d Document,
    torn: &'d TornDocument<'d>,
    prepared: &'d Prepared<'d>,
    positions: &'d Positions,
    /// Whether what a face names is written before it.
    moves_up: bool,
    /// How many faces have all that they name before them, or were written.
    ready: usize,
    /// Of vertices, texture coordinates and normals.
    streams: [Stream; 3],
    /// That of the faces written so far.
    hash: Hash,
    out: Output<'d, W>,
}

const VERTICES: usize = 0;
const TEXTURE: usize = 1;
const NORMALS: usize = 2;

/// How far the statements of a kind have been written. They may be ahead of the rest.
#[derive(Clone, Copy, Default)]
struct Stream {
    /// The number of statements of the document that had their turn.
    done: u32,
    /// How many of those that are added were written, and how many statements in all.
    added: usize,
    written: u32,
    /// The run to go on with, how many statements of this kind come before it, and
    /// how many bytes of text.
    run: usize,
    before: u32,
    text_before: usize,
}

impl Stream {
    /// The next statements of its kind to write so that `count` had their turn, and whether they complete
    /// their run.
    fn advance(
        &mut self,
        which: usize,
        runs: &[Run],
        count: u32,
    ) -> Option<(std::ops::Range<u32>, bool)> {
        if self.done >= count {
            return None;
        }
        loop {
            let run = runs.get(self.run)?;
            let end = self.before + run.count;
            let is_own = run.kind as usize == which;
            if is_own && self.done < end {
                let first = self.done;
                self.done = end.min(count);
                return Some((first..self.done, self.done == end));
            }
            if is_own {
                self.before = end;
            } else if run.kind == Kind::Text {
                self.text_before += run.count as usize;
            }
            self.run += 1;
        }
    }
}

impl<W: Write> Writer<'_, W> {
    fn write(mut self) -> io::Result<()> {
        let document = self.document;
        let mut counts = [0; 3];
        let mut polygons = 0;
        let mut before = Kind::Text;
        for (run, lines) in document.runs() {
            let count = run.count as usize;
            let before = std::mem::replace(&mut before, run.kind);
            let which = match run.kind {
                Kind::Polygon => {
                    for polygon in polygons..polygons + count {
                        self.write_polygon(polygon)?;
                    }
                    polygons += count;
                    continue;
                }
                Kind::Text => {
                    // What is attached to the statements before it was written with these.
                    let attached = match Kind::INDEXED.contains(&before) {
                        true => attached_length(lines),
                        false => 0,
                    };
                    self.out.text(&lines[attached..])?;
                    continue;
                }
                kind => kind as usize,
            };
            counts[which] += run.count;
            self.write_statements(which, counts[which])?;
        }
        write_record(self.prepared, self.hash, &mut self.out)?;
        self.out.flush()
    }

    /// Writes statements of a kind, with what is attached to them, so that `count` of the document
    /// had their turn; and behind each section what is added to it.
    fn write_statements(&mut self, which: usize, count: u32) -> io::Result<()> {
        let (document, prepared) = (self.document, self.prepared);
        let order = &prepared.orders[which];
        loop {
            let stream = &mut self.streams[which];
            let next = order.added().get(stream.added);
            if let Some(added) = next.filter(|added| added.behind <= stream.done) {
                stream.added += 1;
                self.write_element(which, added.element)?;
                continue;
            }
            let count = next.map_or(count, |added| added.behind.min(count));
            let runs = document.layout.runs();
            let Some((range, completes_run)) = stream.advance(which, runs, count) else {
                return Ok(());
            };
            let end = range.end;
            for element in range.filter_map(|statement| order.element(statement)) {
                self.write_element(which, element)?;
            }
            if completes_run {
                self.write_attached(which, end)?;
            }
        }
    }

    /// Writes a vertex of the mesh or a copy of one, a texture coordinate or a normal.
    #[inline]
    fn write_element(&mut self, which: usize, element: u32) -> io::Result<()> {
        self.streams[which].written += 1;
        let torn = self.torn;
        match which {
            VERTICES => {
                let vertex = self.prepared.vertex(element);
                let at = self.prepared.shown(vertex);
                let at = at.unwrap_or(self.positions.as_slice()[vertex]);
                let extras = torn.extra_numbers(vertex);
                self.out.statement(b"v", &[at.x, at.y, at.z], extras)
            }
            _ => {
                let keyword = if which == TEXTURE { b"vt" } else { b"vn" };
                let numbers = torn.corners.value(which - 1, element);
                self.out.statement(keyword, numbers, &[])
            }
        }
    }

    /// Writes the foreign statements directly after the run that a stream has completed. What says
    /// something of a vertex that is gone is left out.
    fn write_attached(&mut self, which: usize, end: u32) -> io::Result<()> {
        let (prepared, stream) = (self.prepared, self.streams[which]);
        let is_gone = which == VERTICES && prepared.orders[VERTICES].element(end - 1).is_none();
        let next = self.document.layout.runs().get(stream.run + 1);
        if let Some(text) = next.filter(|next| next.kind == Kind::Text) {
            let lines = &self.document.text[stream.text_before..][..text.count as usize];
            let lines = &lines[..attached_length(lines)];
            if is_gone {
                self.out.text(&without_statements_of_vertex(lines))?;
            } else {
                self.out.text(lines)?;
            }
        }
        Ok(())
    }

    fn write_polygon(&mut self, polygon: usize) -> io::Result<()> {
        let (document, prepared) = (self.document, self.prepared);
        for place in prepared.slots.of(document.polygons.triangles(polygon)) {
            if place == self.ready {
                self.move_up()?;
            }
            self.write_triangle(half_edges(prepared.slots.faces[place]))?;
        }
        Ok(())
    }

    /// Writes, kind after kind, what the next face names, with all parts of the divided face that it is
    /// part of. So nothing depends on how that one is divided, nor on the rest of a polygon: read again,
    /// each face is a polygon of its own.
    fn move_up(&mut self) -> io::Result<()> {
        let (prepared, torn) = (self.prepared, self.torn);
        let orders = &prepared.orders;
        let record = prepared.record.as_ref();
        let places = record.map(|record| record.families.parts_from(self.ready));
        let places = places.unwrap_or(self.ready..self.ready + 1);
        self.ready = places.end;
        let is_written =
            |which: usize| self.streams[which].written as usize == orders[which].count();
        if !self.moves_up || (0..3).all(is_written) {
            return Ok(());
        }
        let mut needed = [0; 3];
        let faces = prepared.slots.faces[places].iter();
        for h in faces.flat_map(|&face| half_edges(face)) {
            let vertex = prepared.separated.indices[h as usize];
            let [texture, normal] = torn.corners.at(h as usize);
            for (which, index) in [Some(vertex), texture, normal].into_iter().enumerate() {
                let number = index.map_or(0, |index| orders[which].number(index) + 1);
                needed[which] = number.max(needed[which]);
            }
        }
        for which in [TEXTURE, NORMALS, VERTICES] {
            while self.streams[which].written < needed[which] {
                self.write_statements(which, self.streams[which].done + 1)?;
            }
        }
        Ok(())
    }

    fn write_triangle(&mut self, half_edges: [u32; 3]) -> io::Result<()> {
        let prepared = self.prepared;
        self.out.pending.push(b'f');
        for h in half_edges {
            let vertex = prepared.separated.indices[h as usize];
            let vertex = prepared.orders[VERTICES].number(vertex);
            self.hash.add_corner(vertex);
            let [texture, normal] = self.torn.corners.at(h as usize);
            let texture = texture.map(|index| prepared.orders[TEXTURE].number(index));
            let normal = normal.map(|index| prepared.orders[NORMALS].number(index));
            self.out.corner(vertex, [texture, normal]);
        }
        self.out.pending.push(b'\n');
        self.out.flush_if_full()
    }
}

fn half_edges(face: u32) -> [u32; 3] {
    [3 * face, 3 * face + 1, 3 * face + 2]
}

//! Strict and lossless OBJ import and export for triangle meshes that tear. Nothing is dropped
//! silently.
//!
//! A [`Document`] is a whole OBJ file in memory. It provides the triangles and positions from which
//! a [`tearmesh::Mesh`] is built. A [`TornDocument`] follows the log of the mesh, and writes the file
//! again, with the torn faces in place of the old ones and everything else unchanged. It records which
//! cut made each tear, so that another session can undo the cuts one by one.
//!
//! ```
//! use tearmesh::{Edits, Positions, split};
//! use tearmesh_obj::{Document, TornDocument};
//!
//! let file = b"o flag\nv 0 0 0\nv 1 0 0 # corner\nv 0 1 0\nv 1 1 0\nvt 0.5\nf 1/1 2/1 3/1\nf 3 2 4\n";
//! let document = Document::read(&file[..])?;
//! let mut mesh = document.mesh()?;
//! let mut positions = Positions::new(document.positions().iter().copied())?;
//! let mut torn = TornDocument::new(&document);
//!
//! // Tear the second face off the first, at both ends of their common edge.
//! let mut edits = Edits::new();
//! for v in [1, 2] {
//!     let (v, face) = (mesh.vertex(v), mesh.face(1));
//!     split::vertex(&mut mesh, v, &[face], &mut edits)?;
//! }
//! edits.replay(&mut (&mut positions, &mut torn));
//!
//! let mut out = Vec::new();
//! let summary = torn.write(&mesh, &positions, &mut out)?;
//! assert_eq!((summary.vertices, summary.faces), (6, 2));
//! assert_eq!(
//!     String::from_utf8(out.clone())?,
//!     "o flag\nv 0 0 0\nv 1 0 0\n# corner\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nvt 0.5\n\
//!      f 1/1 2/1 3/1\nf 6 5 4\n\
//!      #tearmesh record 1 v 6 f 2 vt 1 1 vn 0 0 faces 7008e53ea9bc7ad2\n\
//!      #~ split 5 2 1\n#~ split 6 3 1\n#tearmesh end 2 10c8189a8b417315\n"
//! );
//! assert_eq!(Document::read(&out[..])?.mesh()?, mesh); // With both tears.
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Promises
//!
//! * Coordinates, texture coordinates, normals and extra numbers (weights, colours) are `f64`, and
//!   survive a round trip bit for bit. Reading a written file and writing it again gives the
//!   same bytes.
//! * Lines keep their order, unless a face precedes its vertices. New vertices follow the last vertex
//!   of their object, so each object keeps its own vertices, and the numbers of later vertices
//!   increase ([`TornDocument::statements_in_order`]). If an uninterpreted statement may name a vertex
//!   by its number, all vertices keep their numbers, and the new ones follow the last vertex of the file.
//! * A split duplicates a position, never a texture coordinate or a normal; each corner keeps
//!   those it had.
//! * Tears survive a round trip: comments at the end of the file record which vertices were one
//!   vertex until which cut, and where vertices were inserted ([the record](#the-record)).
//! * Objects, groups, materials, smoothing groups, comments, and unknown statements are kept byte for
//!   byte and in order. Statements that are kept without being interpreted are reported. A written copy of a
//!   vertex does not repeat the `ARCSim` statements about it ([`WriteSummary::unspoken`] counts them).
//! * Every refusal has a code, a line, a column, the text, and the expected syntax. A mesh error
//!   names the lines of its faces.
//! * No input causes a panic. Reading a file, and describing and repairing the defects of its mesh,
//!   takes at most the larger of 64 MiB of memory and twelve times the size of the file. A line has at
//!   most 64 MiB, and a polygon at most 4096 corners.
//!
//! # Codes
//!
//! The code of a [`Diagnostic`] is stable: `E-OBJ-…` for invalid files, `E-MESH-…` for triangles that
//! do not form an oriented 2-manifold, and `W-OBJ-…` for warnings and notes. The guide of the crate
//! `tearmesh-cli` lists all codes, together with those of the command (`tearmesh_cli::guide::codes`).
//!
//! # The record
//!
//! A torn or divided mesh is written with a record in comments at the end of its file. Vertices
//! and faces are counted from 1, as everywhere in the file. Other programs ignore the record.
//! [`Document::read`] uses it to restore which vertices were split from which, and to join the several
//! `v` of a vertex into one. Cuts can then be undone ([`TornDocument::stitches_of_last`],
//! [`TornDocument::simplified`]).
//!
//! ```text
//! record  = header item* end
//! header  = "#tearmesh record" VERSION "v" V "f" F "vt" BEFORE ALL "vn" BEFORE ALL "faces" HASH
//! item    = "#~ split" VERTEX FROM CUT            VERTEX was one with FROM, which is lower, until CUT
//!         | "#~ fan" COPY VERTEX                  COPY is VERTEX, written again for another fan
//!         | "#~ edge" VERTEX CUT A B T            inserted by CUT at A + T (B - A)
//!         | "#~ face" VERTEX CUT A B C WA WB WC   inserted by CUT at WA A + WB B + WC C
//!         | "#~ parent" FIRST LAST A B C          the faces FIRST to LAST cover the former face A B C
//!         | "#~ vt" FIRST LAST                    the texture coordinates FIRST to LAST were inserted
//!         | "#~ vn" FIRST LAST                    the normals FIRST to LAST were inserted
//!         | "#~ slide" VERTEX CUT BEFORE AFTER    CUT slid VERTEX: the numbers of its `v` before and after
//!         | "#~ slide-vt" NEW OLD NUMBERS         ... whose corners have NEW, not OLD; NUMBERS are NEW's
//!         | "#~ slide-vn" NEW OLD X Y Z           ... and likewise for normals
//!         | "#~ apart" VERTEX X Y Z X Y Z         VERTEX is at the first point, and its `v` has the second
//!         | "#~ again" ABOVE A B C FACES           the FACES cover the former face A B C of a parent
//! end     = "#tearmesh end" ITEMS HASH
//! ```
//!
//! * Items come in that order (`edge` and `face` together), each kind in ascending order of its first
//!   number. A copy follows its vertex.
//! * In `A`, `B` and `C`, a vertex that was split is named by its root, which is the lowest of its
//!   parts. `edge` and `face` name the root of the inserted vertex.
//! * `V` and `F` count the `v` and `f` of the file. `BEFORE` counts the `vt` or `vn` before any
//!   was inserted, and `ALL` those of the file. If no items list the inserted ones, they are the last.
//! * Slides come in the order in which they were made, each followed by its `slide-vt` and `slide-vn`.
//!   A vertex is put back only if it has the numbers that its last slide gave it.
//! * `VERSION` is the lowest version that can express the record. Version 3 has no `again`, version 2 no `apart`. Version 1
//!   ends with `parent`, and its copies are the last `v` of the file. A program that does not know the
//!   version reports this, and reads the file as one without a record.
//! * A part of a parent that was divided again has an `again` item. Besides its FACES, the items whose
//!   ABOVE is its number (they are counted from 1) cover it. ABOVE is 0 directly below a parent.
//! * A vertex with an `apart` item is read at the first point if its `v` is bit-equal to the second
//!   point. Otherwise its `v` counts, and a warning is reported. Copies stand where their vertex does.
//! * Cuts are numbered from 1, and later cuts have higher numbers. After a merge, a `split` names the
//!   vertex with which VERTEX was last one, not the vertex from which it was first split.
//! * The hash of the header covers the number of `v` and the vertices of all faces; the hash of the end
//!   covers the lines between. Both are FNV-1a hashes of 64 bits, in hexadecimal.
//!
//! The record remains valid if another program changes positions, texture coordinates or groups;
//! [`TornDocument::simplified`] keeps the vertices whose data was changed. The record becomes invalid if
//! another program changes faces, the number of vertices, or the record itself, or adds statements that
//! may name a vertex by a number which mending would change. The file is then read as one without a
//! record, a warning says so, and the lines of the invalid record are not written again.
//!
//! # Why not obj-rs
//!
//! obj-rs 0.7.4 is a good reader for the needs of a renderer. Our tests compare our reading and writing
//! with it, and with the feature `obj-rs` a `RawObj` that a program already holds becomes a
//! [`Document`] by `TryFrom`. It is not sufficient for a file that has to survive a cut:
//!
//! * It keeps coordinates as `f32`: 11,755 of the 11,898 coordinates of a real gown would change. It
//!   drops comments, all but the last of several `o`, and the order of groups, which it keeps in a
//!   hash map. It has no writer.
//! * It panics on 22 keywords of the format (free-form curves and display attributes); the two
//!   bytes `sp` are enough.
//! * It refused 26 of 85 real files, without a line number: for vertex colours, for `g` with no
//!   name or two, `usemtl` with a blank, `s on`, `f 1/ 2/ 3/`, mixed corners, an unknown keyword, a
//!   byte order mark, a byte that is not UTF-8 even in a comment, CR line ends, a face before
//!   its vertices.
//! * It accepts nan, infinity, `f 1 1 2` and a face of a million corners without a warning.
//! * It takes three to five times as long to read the same file (`tools/bench/record/`).
//!
//! # Map
//!
//! | file | subject |
//! |---|---|
//! | `document.rs`, `polygons.rs`, `store.rs` | the document, its faces, and its compact lists |
//! | `read.rs`, `read/` | bytes to document: blocks of lines, one scanner, statements, faces, the record, faults |
//! | `triangulate.rs`, `triangulate/` | polygons to triangles: ears, and diagonals that make angles larger |
//! | `mesh.rs` | triangles to mesh, or defects in the terms of the file |
//! | `raw.rs` | a document from obj-rs (feature `obj-rs`), by way of a text |
//! | `repair.rs` | repair of defects, on request |
//! | `torn_from.rs` | vertices that are parts of others, without a record |
//! | `torn.rs`, `torn/` | edits of a document: corners, splits, order |
//! | `record.rs`, `families.rs` | the contents of the record, and its checksum; divided faces |
//! | `sections.rs`, `order.rs` | the ends of objects, and the order and numbers of written statements |
//! | `write.rs`, `write/` | document and torn mesh to bytes: layout, fans, the record, numbers, pieces |
//! | `simplify.rs`, `simplify/` | a document without what can be undone: the plan, and what was edited |
//! | `diagnostic.rs`, `keyword.rs` | diagnostics; the keywords of the format |
//!
//! This crate reads and writes streams of bytes. Opening files, replacing them as a whole, and
//! rendering diagnostics are left to the caller.

#![forbid(unsafe_code)]

mod diagnostic;
mod document;
mod families;
mod keyword;
mod mesh;
mod named_format;
mod opening;
mod order;
mod polygons;
#[cfg(feature = "obj-rs")]
mod raw;
mod read;
mod record;
mod repair;
mod sections;
mod simplify;
mod store;
mod torn;
mod torn_from;
mod triangulate;
mod write;

pub use diagnostic::{Diagnostic, Excerpt, Level, Location, ReadError};
pub use document::Document;
pub use mesh::MeshError;
pub use named_format::named_format;
pub use polygons::Corner;
pub use repair::Repair;
pub use simplify::Simplified;
pub use torn::TornDocument;
pub use torn_from::TornFromError;
pub use write::{PieceNames, PieceWriter, WriteSummary};

//! OBJ import and export for triangle meshes that tear: strict and lossless, and nothing is dropped
//! silently.
//!
//! A [`Document`] is a whole OBJ file in memory. It gives the triangles and positions from which
//! [`tearmesh::Mesh`] is built, and after any number of vertex splits it writes the file
//! again, with the torn faces in place of the old ones and everything else as it was. A
//! [`TornDocument`] follows the log of the mesh, and so also writes what has
//! new vertices and faces, keeps cuts apart, and undoes them in another session.
//!
//! ```
//! use tearmesh::{Edits, FaceId, Positions, VertexId, split};
//! use tearmesh_obj::Document;
//!
//! let file = b"o flag\nv 0 0 0\nv 1 0 0 # corner\nv 0 1 0\nv 1 1 0\nvt 0.5\nf 1/1 2/1 3/1\nf 3 2 4\n";
//! let document = Document::read(&file[..])?;
//! let mut mesh = document.mesh()?;
//! let mut positions = Positions::new(document.positions().iter().copied())?;
//!
//! // Tear the second face off the first, at both ends of their common edge.
//! let mut edits = Edits::new();
//! for v in [1, 2] {
//!     let v = VertexId::new(v).expect("small");
//!     split::vertex(&mut mesh, v, &[FaceId::new(1).expect("small")], &mut edits)?;
//! }
//! edits.replay(&mut positions);
//!
//! let mut out = Vec::new();
//! let summary = document.write(&mesh, &positions, &mut out)?;
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
//!   survive a round trip bit for bit. Reading what was written and writing it again gives the
//!   same bytes.
//! * No line moves, but where a face came before its vertices. New vertices stand behind those of
//!   their object, so each object keeps its own; those of the objects behind it count on
//!   ([`TornDocument::vertices_in_order`]). Where statements are kept that may name a vertex by its
//!   number, vertices keep their numbers, and the new ones follow the last of the file.
//! * A split duplicates a position, never a texture coordinate or a normal; each corner keeps
//!   those it had.
//! * A torn mesh survives a file: comments at its end say what was one vertex until which cut, and
//!   what was inserted where ([the record](#the-record)).
//! * Objects, groups, materials, smoothing groups, comments, and statements nobody has heard of are
//!   kept byte for byte and in order. What is kept without being understood is reported, by line.
//!   What `ARCSim` says of a vertex (`nl`, `ny`, `nv`, `vv`) is said of its copies, too.
//! * Every refusal has a code, line, column, the text, and what was expected. A mesh error names
//!   the lines of its faces.
//! * No input makes it panic, or take more memory than the larger of 64 MiB and twelve times the
//!   file, to name and repair all that is wrong with its mesh included. Lines have at most
//!   64 MiB, and polygons at most 4096 corners.
//!
//! # Codes
//!
//! The code of a [`Diagnostic`] is stable: `E-OBJ-…` for what a file says, `E-MESH-…` for triangles that
//! do not form an oriented 2-manifold, and `W-OBJ-…` for warnings and notes. The guide of the crate
//! `tearmesh-cli` lists them all, together with those of the command (`tearmesh_cli::guide::codes`).
//!
//! # The record
//!
//! A torn or divided mesh is written with a record in comments at the end of its file. Vertices
//! and faces are counted from 1, as everywhere in the file. Any program can read the file
//! without it; [`Document::read`] takes it in, and then split-off vertices have their root again,
//! several `v` of one vertex are one, and cuts can be undone ([`TornDocument::stitches_of_last`],
//! [`TornDocument::simplified`]).
//!
//! ```text
//! record  = header item* end
//! header  = "#tearmesh record" VERSION "v" V "f" F "vt" BEFORE ALL "vn" BEFORE ALL "faces" HASH
//! item    = "#~ split" VERTEX FROM CUT            VERTEX was one with FROM, which is lower, until CUT
//!         | "#~ fan" COPY VERTEX                  COPY is VERTEX, written again for another fan
//!         | "#~ edge" VERTEX CUT A B T            inserted by CUT at A + T (B - A)
//!         | "#~ face" VERTEX CUT A B C WA WB WC   inserted by CUT at WA A + WB B + WC C
//!         | "#~ parent" FIRST LAST A B C          the faces FIRST to LAST cover what was A B C
//!         | "#~ vt" FIRST LAST                    the texture coordinates FIRST to LAST were inserted
//!         | "#~ vn" FIRST LAST                    the normals FIRST to LAST were inserted
//!         | "#~ slide" VERTEX CUT BEFORE AFTER    CUT slid VERTEX: the numbers of its `v` before and then
//!         | "#~ slide-vt" NEW OLD NUMBERS         ... at whose corners NEW is for OLD; NUMBERS are those of NEW
//!         | "#~ slide-vn" NEW OLD X Y Z           ... and likewise for normals
//!         | "#~ apart" VERTEX X Y Z X Y Z         VERTEX is at the first point, and its `v` says the second
//! end     = "#tearmesh end" ITEMS HASH
//! ```
//!
//! * Items come in that order (`edge` and `face` together), each kind by its first number,
//!   ascending. A copy comes behind its vertex.
//! * A vertex of several copies is named by its root, the lowest of them, in `A`, `B` and `C`;
//!   `edge` and `face` name the root of what was inserted.
//! * `V` and `F` count the `v` and `f` of the file. `BEFORE` counts the `vt` or `vn` before any
//!   was inserted, and `ALL` those of the file. Without items that say which were inserted, these
//!   are the last.
//! * Slides come in the order in which they were made, each with its `slide-vt` and `slide-vn` behind
//!   it. A vertex is put back only if it has the numbers that its last slide left.
//! * `VERSION` is 2 or 3 where it has to be: version 2 has no `apart`, and version 1 ends with `parent`,
//!   and the copies are the last `v` of the file. Programs that know earlier versions alone say that
//!   it is later, and take the file for one without a record.
//! * A vertex is read where `apart` says that it is, if its `v` says to the bit what stands
//!   there: whoever moved it since is heeded, with a warning. Copies stand where their vertex does.
//! * A cut has a number from 1; a later one has a higher one. After a merge, a `split` names
//!   what VERTEX was last one with, not what it was first split from.
//! * The hash of the header is that of the number of `v` and of the vertices of all faces, that of
//!   the end is of the lines between: 64 bits, FNV-1a, in hexadecimal.
//!
//! What another program does to positions, texture or groups leaves the record in force, and
//! [`TornDocument::simplified`] keeps the vertices that it was done to.
//! Where it changed faces or the number of vertices, or the record itself, or added statements that may
//! name a vertex by a number which mending would change, a warning says so, the file is read as
//! one without a record, and the lines of what was one are left out of what is written, as the
//! warning says.
//!
//! # Why not obj-rs
//!
//! obj-rs 0.7.4 is a fine reader of what a renderer needs. Our tests hold what we read and write
//! against it, and with the feature `obj-rs` a `RawObj` that a program already holds becomes a
//! [`Document`] by `TryFrom`. For a file that has to survive a cut it would not do:
//!
//! * It keeps coordinates as `f32`: 11,755 of the 11,898 of a real gown would change. Comments are
//!   gone, of several `o` only the last is left, and the order of groups with them, for they
//!   live in a hash map. It has no writer.
//! * It panics on 22 keywords of the format (free-form curves and display attributes); the two
//!   bytes `sp` are enough.
//! * It refused 26 of 85 real files, without a line number: for vertex colours, for `g` with no
//!   name or two, `usemtl` with a blank, `s on`, `f 1/ 2/ 3/`, mixed corners, an unknown keyword, a
//!   byte order mark, a byte that is no UTF-8 even in a comment, CR line ends, a face before
//!   its vertices.
//! * It takes nan, infinity, `f 1 1 2` and a face of a million corners without a word.
//! * It takes three to five times as long to read the same file (`tools/bench/record/`).
//!
//! # Map
//!
//! | file | subject |
//! |---|---|
//! | `document.rs`, `polygons.rs`, `store.rs` | the document, its faces, and the compact lists it is made of |
//! | `read.rs`, `read/` | bytes to document: lines, the usual ones in one go, tokens, numbers, faces, indices, references ahead, what is carried through, the record and whether it fits, faults |
//! | `triangulate.rs`, `triangulate/` | polygons to triangles: ears that are cut off, thin faces that are avoided, diagonals that collide |
//! | `mesh.rs` | triangles to mesh, or defects in the terms of the file |
//! | `raw.rs` | a document from obj-rs (feature `obj-rs`): what is lost, and in which order the rest stands |
//! | `repair.rs` | defects mended, on request |
//! | `coincident.rs` | boundary edges that lie on each other, where no record says why |
//! | `said.rs` | what foreign statements say of the vertex before them, for its copies |
//! | `torn.rs`, `torn/` | what became of a document: corners, what was one vertex until which cut, when each vertex is written, what can be taken out again, and what was edited since |
//! | `record.rs` | what is on record, and the checksum |
//! | `sections.rs`, `order.rs` | where objects end, and in which order and under which numbers statements are written |
//! | `write.rs`, `write/` | document and torn mesh to bytes: layout, a vertex for each fan, the record, numbers; a piece by itself |
//! | `slides.rs` | vertices that slid, and what they were before |
//! | `simplify.rs` | a document without what can be taken out again |
//! | `diagnostic.rs`, `keyword.rs` | what there is to say; which keywords there are |
//!
//! Bytes come in and go out: opening files, replacing them as a whole, and rendering diagnostics
//! are the caller's.

mod coincident;
mod diagnostic;
mod document;
mod keyword;
mod mesh;
mod opening;
mod order;
mod polygons;
#[cfg(feature = "obj-rs")]
mod raw;
mod read;
mod record;
mod repair;
mod said;
mod sections;
mod simplify;
mod slides;
mod store;
mod torn;
mod triangulate;
mod write;

pub use coincident::{Coincident, CoincidentError};
pub use diagnostic::{Diagnostic, Excerpt, Level, Location, ReadError};
pub use document::Document;
pub use mesh::MeshError;
pub use polygons::Corner;
#[cfg(feature = "obj-rs")]
pub use raw::{Item, RawObjError};
pub use repair::Repair;
pub use simplify::Simplified;
pub use torn::TornDocument;
pub use write::{PieceNames, PieceWriter, WriteSummary};

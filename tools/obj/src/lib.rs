//! OBJ import and export for triangle meshes that tear: strict, lossless, and never in silence.
//!
//! A [`Document`] is a whole OBJ file in memory. It gives the triangles and positions from which
//! [`tearmesh::Mesh`] is built, and after any number of vertex splits it writes the file
//! again, with the torn faces in place of the old ones and everything else as it was.
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
//!     split::faces(&mut mesh, v, &[FaceId::new(1).expect("small")], &mut edits)?;
//! }
//! edits.replay(&mut positions);
//!
//! let mut out = Vec::new();
//! let summary = document.write(&mesh, &positions, &mut out)?;
//! assert_eq!((summary.vertices, summary.faces), (6, 2));
//! assert_eq!(
//!     String::from_utf8(out)?,
//!     "o flag\nv 0 0 0\nv 1 0 0\n# corner\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nvt 0.5\n\
//!      f 1/1 2/1 3/1\nf 6 5 4\n"
//! );
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Promises
//!
//! * Coordinates, texture coordinates, normals and extra numbers (weights, colours) are `f64`, and
//!   survive a round trip bit for bit. Reading what was written and writing it again gives the
//!   same bytes.
//! * Vertices keep their numbers: a split appends. It duplicates a position, never a texture
//!   coordinate or a normal; each corner keeps those it had.
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
//! | code | refuses |
//! |---|---|
//! | `E-OBJ-FLOAT`, `E-OBJ-FINITE`, `E-OBJ-COORDINATE` | what is no number; nan and infinity; a coordinate too large to compute with |
//! | `E-OBJ-COUNT` | too few or too many numbers in a statement |
//! | `E-OBJ-INDEX`, `E-OBJ-ZERO`, `E-OBJ-RANGE` | a corner that cannot be read; index 0; an index that nothing has |
//! | `E-OBJ-CORNERS`, `E-OBJ-REPEAT`, `E-OBJ-ARITY` | faces with less than three corners, a vertex twice, or too many corners |
//! | `E-OBJ-UTF16`, `E-OBJ-BINARY`, `E-OBJ-EMPTY` | UTF-16; data that is no text; a file without a face |
//! | `E-OBJ-LINE`, `E-OBJ-LIMIT` | a line too long; more elements than ids |
//! | `E-MESH-EDGE`, `E-MESH-FLIP`, `E-MESH-BOWTIE`, `E-MESH-DUPLICATE`, `E-MESH-PILLOW`, `E-MESH-REPEAT`, `E-MESH-RANGE`, `E-MESH-LIMIT`, `E-MESH-OTHER` | triangles that are no oriented 2-manifold: the defects of [`tearmesh::Defect`] |
//!
//! | code | warns |
//! |---|---|
//! | `W-OBJ-QUAD` | larger polygons were cut into triangles |
//! | `W-OBJ-ELEMENT` | there are `l` or `p` elements, which no cut divides |
//! | `W-OBJ-FOREIGN` | there are statements that are kept and not interpreted |
//! | `W-OBJ-RELATIVE` | (note) negative indices of such statements were made absolute |
//! | `W-OBJ-BOM` | (note) a byte order mark was dropped |
//! | `W-OBJ-REPAIR-BOWTIE` | fans of a vertex were given vertices of their own ([`Repair`]) |
//! | `W-OBJ-REPAIR-DUPLICATE`, `W-OBJ-REPAIR-PILLOW`, `W-OBJ-REPAIR-EDGE` | faces were dropped: on the vertices of another, or superfluous on an edge |
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
//! | `document.rs`, `store.rs` | the document, and the compact lists it is made of |
//! | `read.rs`, `read/` | bytes to document: lines, the usual ones in one go, tokens, numbers, faces, references ahead, what is carried through, faults |
//! | `triangulate.rs`, `triangulate/flip.rs` | polygons to triangles; diagonals that collide |
//! | `mesh.rs` | triangles to mesh, or defects in the terms of the file |
//! | `raw.rs` | a document from obj-rs (feature `obj-rs`): what is lost, and in which order the rest stands |
//! | `repair.rs` | defects mended, on request |
//! | `said.rs` | what foreign statements say of the vertex before them, for its copies |
//! | `write.rs`, `write/` | document and torn mesh to bytes: layout, a vertex for each fan, numbers |
//! | `diagnostic.rs`, `keyword.rs` | what there is to say; which keywords there are |
//!
//! Bytes come in and go out: opening files, replacing them as a whole, and rendering diagnostics
//! are the caller's.

mod diagnostic;
mod document;
mod keyword;
mod mesh;
#[cfg(feature = "obj-rs")]
mod raw;
mod read;
mod repair;
mod said;
mod store;
mod triangulate;
mod write;

pub use diagnostic::{Diagnostic, Excerpt, Level, Location, ReadError};
pub use document::{Corner, Document};
pub use mesh::MeshError;
#[cfg(feature = "obj-rs")]
pub use raw::{Item, RawObjError};
pub use repair::Repair;
pub use write::WriteSummary;

//! Scripts: a small mesh and operations on it, in the form of bytes or text.
//!
//! One driver serves property tests, fuzzing, exhaustive runs and reproducers. Every byte string is
//! a script of bounded size ([`Script::from_bytes`]), so a fuzzer can mutate bytes freely. Every
//! script prints as text with one operation per line, and the text can be parsed, so a failing case
//! can be pasted into a regression test. Nothing is random: the bytes alone determine the script.
//!
//! [`Script::run`] applies the operations to a [`World`] (a mesh and its followers) and shows each
//! step to an observer, which can update its own model in step. The tests of this library compare
//! the mesh with a plain list of triangles. A program that keeps other data beside a mesh can check
//! its own follower with the same meshes and operations.
//!
//! This module requires the feature `script`.
//!
//! ```
//! use tearmesh::script::{Script, Step};
//!
//! let script: Script = "
//!     grid 2 2 0b0110       # two by two cells; which diagonals rise
//!     split 4 0b11          # the first two faces of vertex 4 get a vertex of their own
//!     plane 1 1 0 0         # split vertex 1 by the plane through it with this normal
//!     insert 5 edge 0 32    # put a vertex in the middle of the edge of half-edge 5
//!     merge 0 1 1 1         # make the first torn vertex and its first copy one again
//!     slide 0 1 16          # slide vertex 0 a quarter of the way to its second neighbour
//! ".parse()?;
//!
//! let mut refused = 0;
//! let world = script.run(|world, step| {
//!     assert_eq!(world.mesh.check(), []);
//!     match step {
//!         Step::Split { outcome: Err(_), .. } | Step::Plane { outcome: None, .. } => refused += 1,
//!         _ => {}
//!     }
//! });
//! assert_eq!((world.mesh.vertex_count(), refused), (11, 0)); // 9 + 1 + 1 + 1 - 1
//!
//! assert_eq!(script.to_string().parse(), Ok(script));
//! # Ok::<(), tearmesh::script::ScriptError>(())
//! ```
//!
//! Cuts may go along a polyline, by any [method](crate::CutMethod), and across seams whose two sides
//! coincide:
//!
//! ```
//! use tearmesh::script::Script;
//!
//! let script: Script = "
//!     unsewn 0b110101 grid 3 2 0b10                   # some faces have vertices of their own
//!     cut exact seams eye 0 0 100 -30 -20 0 30 -20 0  # from an eye through two points
//!     cut exact seams continued 0 0 100 0 40 0        # go on to the ray through a third one
//!     cut exact seams closed                          # and back to where the polyline began
//!     cut plane 0 0 0 1 1 0                           # by the method `partition`
//! ".parse()?;
//! script.run(|world, _| assert_eq!(world.mesh.check(), []));
//! # Ok::<(), tearmesh::script::ScriptError>(())
//! ```
//!
//! # Fuzz a follower of your own
//!
//! Write the property as a function of bytes. A follower that replays after every step must always
//! hold the same values as a plain count over the whole mesh.
//!
//! ```
//! use tearmesh::script::Script;
//! use std::collections::BTreeSet;
//! use tearmesh::{Cursor, Edit, Follower, HalfEdgeId, Mix};
//!
//! /// How many faces each vertex has: what you keep beside the mesh.
//! struct Valences { of: Vec<usize>, seen: Cursor, divided: BTreeSet<HalfEdgeId> }
//!
//! impl Follower for Valences {
//!     fn cursor(&mut self) -> &mut Cursor {
//!         &mut self.seen
//!     }
//!     fn follow(&mut self, edit: &Edit<'_>) {
//!         match edit {
//!             Edit::Split(split) => {
//!                 self.of[split.old.index()] -= split.corners.len();
//!                 self.of.push(split.corners.len());
//!             }
//!             Edit::Merge(merge) => {
//!                 let gone = self.of.swap_remove(merge.gone.index());
//!                 self.of[merge.kept.index()] += gone;
//!             }
//!             Edit::Insert(insert) => {
//!                 self.of.resize(self.of.len() + insert.points.len(), 0);
//!                 for child in insert.children {
//!                     for (v, source) in child.vertices.iter().zip(child.sources) {
//!                         self.of[v.index()] += 1;
//!                         if let Mix::Copy(h) = source {
//!                             if self.divided.insert(h) {
//!                                 self.of[v.index()] -= 1; // that of the divided face
//!                             }
//!                         }
//!                     }
//!                 }
//!                 self.divided.clear();
//!             }
//!             Edit::Slide(_) => {} // It moves a vertex, and no corner.
//!             _ => unimplemented!("an edit of a later version"),
//!         }
//!     }
//! }
//!
//! pub fn check_valences(bytes: &[u8]) {
//!     let script = Script::from_bytes(bytes);
//!     let mut valences: Option<Valences> = None;
//!     script.run(|world, step| {
//!         let count = |v| world.mesh.faces_of(v).count();
//!         let truth: Vec<usize> = world.mesh.vertices().map(count).collect();
//!         let valences = valences.get_or_insert_with(|| Valences {
//!             of: truth.clone(),
//!             seen: Cursor::START,
//!             divided: BTreeSet::new(),
//!         });
//!         world.edits.replay(valences);
//!         assert_eq!(valences.of, truth, "after {step:?} of\n{script}");
//!     });
//! }
//!
//! // Any bytes will do. In `cargo test`, replay those that a fuzzer kept.
//! for seed in 0..200_u8 {
//!     let bytes: Vec<u8> = (0..100).map(|i: u8| seed.wrapping_mul(i).rotate_left(3) ^ i).collect();
//!     check_valences(&bytes);
//! }
//! ```
//!
//! The fuzz target is `fuzz_target!(|bytes: &[u8]| check_valences(bytes));` of `libfuzzer-sys`, in a
//! [copied fuzz folder](#copy-the-fuzz-folder). With the feature `proptest`, a property test may take
//! `any::<Script>()`. If it fails, [`Script::shrink`] reduces the script to the few lines that matter.
//! The message ends with the script as text, which a regression test can parse with
//! `text.parse::<Script>()`.
//!
//! # Drive a mesh kernel of your own
//!
//! A script needs no follower: each [`Step`] reports the request and its outcome, so another kernel
//! can be given the same requests and be compared. Leave out the operations that your kernel does
//! not support. Some splits name wrong faces on purpose: if your kernel does not refuse those, set the
//! `fault` of each split to [`Fault::None`].
//!
//! ```
//! use tearmesh::script::{Operation, Script, Step};
//!
//! /// Your kernel: here, triangles of which some can get a vertex of their own.
//! struct Triangles { corners: Vec<[u32; 3]>, vertices: u32 }
//!
//! impl Triangles {
//!     /// The new vertex; none if no face of the vertex would move, or none stay.
//!     fn split(&mut self, vertex: u32, moving: &[usize]) -> Option<u32> {
//!         let faces = (0..self.corners.len()).filter(|&f| self.corners[f].contains(&vertex));
//!         let (moves, stays): (Vec<_>, Vec<_>) = faces.partition(|f| moving.contains(f));
//!         if moves.is_empty() || stays.is_empty() {
//!             return None;
//!         }
//!         for f in moves {
//!             let new = self.vertices;
//!             self.corners[f] = self.corners[f].map(|v| if v == vertex { new } else { v });
//!         }
//!         self.vertices += 1;
//!         Some(self.vertices - 1)
//!     }
//! }
//!
//! pub fn check_splits(script: &Script) {
//!     let known = |operation: &Operation| matches!(operation, Operation::Split { .. });
//!     let mut script = script.clone();
//!     script.operations.retain(known);
//!     let mut mine: Option<Triangles> = None;
//!     script.run(|world, step| {
//!         let theirs = world.mesh.indices().as_chunks::<3>().0;
//!         let vertices = world.mesh.vertex_count() as u32;
//!         let mine = mine.get_or_insert_with(|| Triangles { corners: theirs.to_vec(), vertices });
//!         if let Step::Split { vertex, faces, outcome: Ok(_) } = step {
//!             let faces: Vec<usize> = faces.iter().map(|f| f.index()).collect();
//!             mine.split(vertex.index() as u32, &faces);
//!         }
//!         assert_eq!(mine.corners, theirs, "after {step:?} of\n{script}");
//!     });
//! }
//!
//! for seed in 0..200_u8 {
//!     let bytes: Vec<u8> = (0..100).map(|i: u8| seed.wrapping_mul(i).rotate_left(3) ^ i).collect();
//!     check_splits(&Script::from_bytes(&bytes));
//! }
//! ```
//!
//! # Copy the fuzz folder
//!
//! With a clone of this library's repository beside yours, this sets up fuzzing in yours:
//!
//! ```console
//! $ cp -r ../tearmesh/fuzz/template fuzz
//! $ cp ../tearmesh/fuzz/run ../tearmesh/fuzz/.gitignore fuzz
//! $ mkdir fuzz/corpus
//! $ cp -r ../tearmesh/fuzz/corpus/script fuzz/corpus/kernel
//! $ cp -r ../tearmesh/fuzz/clusterfuzzlite .clusterfuzzlite
//! ```
//!
//! Put the name of your package into `fuzz/Cargo.toml`, and the calls of your kernel into
//! `fuzz/fuzz_targets/kernel.rs`. Then `fuzz/run kernel 60` fuzzes for a minute on the stable toolchain,
//! and `cargo fuzz run kernel` does so until you stop it, on a nightly one. With `.clusterfuzzlite`,
//! `ClusterFuzzLite` can fuzz each change of your repository.

mod bytes;
mod cut;
mod encode;
mod grammar;
mod shape;
mod shrink;
mod text;
mod world;

pub use cut::{CutPath, CutSettings};
pub use shape::Shape;
pub use text::ScriptError;
pub use world::{Step, World};

/// An initial mesh and the operations to apply to it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Script {
    /// The mesh that the script starts with.
    pub shape: Shape,
    /// The operations, in the order in which they are applied.
    pub operations: Vec<Operation>,
}

impl Script {
    /// The largest number of operations of a script that [`Script::from_bytes`] returns.
    pub const OPERATIONS_MAX: usize = 60;
}

/// An operation on a [`World`]. Numbers of vertices, faces and so on are taken modulo their counts,
/// so every operation is valid for every mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Operation {
    /// Split a vertex by a set of its faces.
    Split {
        /// The number of the vertex to split, modulo the number of vertices.
        vertex: u16,
        /// The faces of the vertex that move to the new vertex: bit `i % 16` is set if face `i`
        /// moves, with the faces in ascending order. An empty set and a set of all faces are
        /// allowed, and are refused.
        mask: u16,
        /// A deliberate mistake in the set of faces.
        fault: Fault,
    },
    /// Split a vertex by a plane through it.
    Plane {
        /// The number of the vertex to split, modulo the number of vertices.
        vertex: u16,
        /// The normal of the plane. If it is zero, nothing is done.
        normal: [i8; 3],
    },
    /// Cut the mesh. If the path has no plane, as between two rays that are one line, if the rays cross within
    /// the mesh, or if there is no cut to go on from, nothing is done.
    ///
    /// In text, words that are left out have their default, and the method is then `partition`:
    ///
    /// ```text
    /// cut [exact | uniform | alternating] [through] [midpoint] [first] [snap NUMBER] [move] [seams] [far NUMBER] PATH
    /// ```
    ///
    /// [`CutPath`] shows the text of each path.
    Cut {
        /// Where the cut goes.
        path: CutPath,
        /// The power of two, from 0 to 40, by which the coordinates of origins are multiplied, and the
        /// direction of parallel rays. Rays from far away are nearly parallel.
        far: u8,
        /// How the cut is made.
        settings: CutSettings,
    },
    /// Insert vertices, all at once.
    Insert {
        /// The number of the half-edge to which the offsets of the spots are added.
        half_edge: u16,
        /// The places at which to insert: at most 4, or none.
        spots: Vec<Spot>,
        /// The ends of a required edge, which crosses the face of the first spot, or that of
        /// `half_edge` if there are no spots. Each end is a corner of that face or one of the spots,
        /// counted in this order and taken modulo their number. It is `None` if no edge is required.
        chord: Option<[u8; 2]>,
    },
    /// Merge two vertices, usually copies of the same vertex.
    Merge {
        /// The first vertex, as a number among the vertices that share their root with another
        /// vertex, or among all vertices if there are none.
        vertex: u16,
        /// The second vertex, as a number among the vertices that have the same root as the first,
        /// including the first.
        other: u16,
        /// Whether `other` is a number among all vertices instead.
        any: bool,
        /// The weights of the first and the second vertex. Negative weights are refused.
        weights: [i8; 2],
    },
    /// Slide a vertex, usually along an edge.
    Slide {
        /// The number of the vertex to slide, modulo the number of vertices.
        vertex: u16,
        /// The vertex to slide toward, as a number among the neighbours in ascending order, or
        /// among all vertices if the vertex has no neighbour.
        toward: u16,
        /// Whether `toward` is a number among all vertices instead.
        any: bool,
        /// The fraction of the edge, in units of 1/64 from 0 to 64. Both ends are refused.
        part: u8,
    },
    /// Sew together all chosen vertices that have the same root, weighted by their masses.
    Sew {
        /// The vertices that are chosen: bit `i % 16` is set if vertex `i` is chosen.
        mask: u16,
    },
    /// Tear the mesh apart completely, so that every face has its own vertices.
    Tear,
    /// Let all followers replay the log, and then clear it.
    Clear,
}

/// The largest number of spots of an insertion that scripts from bytes or text may have.
const SPOTS_MAX: usize = 4;

/// A place at which to insert a vertex. One invalid spot causes the whole insertion to be refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spot {
    /// A spot on an edge.
    Edge {
        /// The offset of the half-edge from that of the insertion: 0 to 11.
        offset: u8,
        /// The fraction of the edge, in units of 1/64 from 0 to 64. Both ends are refused.
        part: u8,
    },
    /// A spot in a face.
    Face {
        /// The offset of a half-edge of the face from the half-edge of the insertion: 0 to 11.
        offset: u8,
        /// The weights of the face's corners, in their order. Zero is refused.
        weights: [u8; 3],
    },
}

/// A deliberate mistake in the set of faces that a split moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The set has no mistake.
    None,
    /// The set contains one of its faces twice. The number selects the face, modulo the size of the set.
    Repeated(u8),
    /// The set also contains this face of the mesh, as its last entry. The face may happen to
    /// belong to the vertex.
    Foreign(u16),
}

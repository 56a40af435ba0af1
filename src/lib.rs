//! A strict, verification-first half-edge kernel for triangle meshes that tear.
//!
//! A [`Mesh`] is built from triangles and split at its vertices. A split that separates two faces
//! turns the pair between them into a *ghost pair*. Ghost pairs keep all faces of a vertex
//! reachable, even where the torn mesh is no longer a 2-manifold. A [`Scissor`] that cuts along two
//! rays or a plane, and exact [`Masses`], are built on this. The technique is that of M. S. Souza,
//! A. von Wangenheim and E. Comunello, "Fast Simulation of Cloth Tearing", SBC Journal on
//! Interactive Systems 5(1), 2014. [`guide::paper`] lists the differences from the paper, with
//! reasons. [`guide`] also has an introduction, a comparison with other software, and the version
//! policy.
//!
//! # Build, split, upload
//!
//! ```
//! use tearmesh::{split, Edits, Mesh, Plane, Point, Positions, Vector};
//!
//! // Four triangles round the vertex 4.
//! let triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
//! let points = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0.5, 0.5, 0.]];
//! let mut mesh = Mesh::build(points.len(), &triangles)?; // an error lists the offenders
//! let mut positions = Positions::new(points)?;
//! let mut edits = Edits::new();
//!
//! let (v, old) = (mesh.vertex(4), positions.len());
//! let plane = Plane::new(positions.at(v), Vector::new(1.0, -1.0, 0.0))?;
//! match split::by_plane(&mut mesh, v, &plane, &positions, &mut edits) {
//!     Some(split) => println!("{} took {} faces of {v}", split.new, split.corners.len()),
//!     None => println!("{v}: every face lies on one side, nothing changed"),
//! }
//! edits.replay(&mut positions);
//!
//! let (index_buffer, new_vertices) = (mesh.indices(), &positions.as_slice()[old..]);
//! assert_eq!((index_buffer.len(), new_vertices), (12, &[Point::new(0.5, 0.5, 0.0)][..]));
//! assert!(mesh.check().is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Cut by two rays; texture coordinates and masses follow
//!
//! ```
//! use tearmesh::{shapes, CutMethod, PerCorner, Point, Ray, Scissor, Sheet, Vector};
//!
//! let (mesh, positions) = shapes::grid(16, 16);
//! let uv = mesh.half_edges().map(|h| positions.at(mesh.origin(h)));
//! let uv = PerCorner::new(uv.map(|p| [p.x, p.y]).collect());
//! let mut sheet = Sheet::new(mesh, positions).with_masses(0.15)?.with(uv);
//!
//! let eye = Point::new(0.5, 0.5, 3.0);
//! let a = Ray::new(eye, Vector::new(-0.6, 0.1, -3.0))?;
//! let b = Ray::new(eye, Vector::new(0.6, -0.1, -3.0))?;
//! let (_, report) = sheet.cut_measured(CutMethod::Partition, &Scissor::new(a, b)?)?;
//!
//! assert_eq!((report.pieces, report.lost, report.crumbs), (2, 0, 0));
//! assert!(sheet.masses().unwrap().ledger().is_balanced());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Map of the code
//!
//! Imports run downward only, and no two files import each other, directly or indirectly:
//!
//! | floor | modules |
//! |---|---|
//! | kernel, 0 | `id` (ids), [`geometry`] (planes, rays, the tie rule), `exact` (sums without rounding), `sets` (disjoint ones) |
//! | kernel, 1 | `mesh` (topology alone: build, walk, check, pieces), `edit` (the log, and who follows it) |
//! | kernel, 2 | [`split`], [`mend`] (merges), [`insert`] (insertions), `undo` (which of these can be taken back), [`slide`], [`classify`], `place` (positions), `attribute`, [`engine`] (an engine's buffers, picking, normals), [`gap`], [`unshare`], [`unsewn`] (seams that coincide), `mass`, [`shapes`] |
//! | kernel, 3 | [`tear`] (the rule for an overstretched edge) |
//! | scissor | `scissor` (two rays or a plane to a cut; `exact`, `partition` and the paper's two methods) |
//! | sheet | `sheet` (mesh, positions, masses, log and what else follows, held together) |
//! | script | `script` (drives a kernel from bytes or text; behind a feature) |
//!
//! The solver layer is a separate crate, `tearmesh-cloth`, which builds on this one.
//! Nothing here depends on it: any simulation can follow the log.
//!
//! Architecture invariants: the library reads no file, prints nothing, uses no clock and no random numbers,
//! and has no unsafe code. `mesh` and `split` do no floating-point arithmetic. Only `split` tears a link,
//! and only `mend` sews one. Results are computed with `+ − × ÷ √` in a fixed order: the same input gives
//! the same bytes on every machine. `src/mesh/invariants.md` lists the numbered invariants of a mesh.
//!
//! # Errors
//!
//! Bad input returns an error that carries ids; each operation has its own error type. An operation
//! that has nothing to do returns `None` or a [`SplitRefusal`]. A panic means a bug in this library
//! or in the calling code, such as an id of another mesh. Its message names the invariant.

#![forbid(unsafe_code)]
#![cfg_attr(
    test,
    allow(
        clippy::unwrap_used,
        reason = "a test that unwraps an error has failed"
    )
)]

mod attribute;
pub mod classify;
mod edit;
pub mod engine;
mod exact;
pub mod gap;
pub mod geometry;
pub mod guide;
mod id;
pub mod insert;
mod mass;
pub mod mend;
mod mesh;
mod place;
mod scissor;
#[cfg(feature = "script")]
pub mod script;
mod sets;
pub mod shapes;
mod sheet;
pub mod slide;
pub mod split;
pub mod tear;
mod undo;
pub mod unsewn;
pub mod unshare;

pub use attribute::{Blend, PerCorner, PerVertex, Values};
pub use edit::{
    ChildFace, Cursor, Edit, Edits, EditsIter, Follower, Followers, Insert, InsertedPoint, Merge,
    Mix, Renumbered, Slide, Split, TornLink, VertexOp,
};
pub use exact::ExactSum;
pub use geometry::{COORDINATE_MAX, Plane, PlaneError, Point, Ray, RayError, Side, Vector};
pub use id::{FaceId, HalfEdgeId, IdError, VertexId};
pub use insert::InsertRefusal;
pub use mass::{MassError, MassLedger, Masses};
pub use mend::MergeRefusal;
pub use mesh::{
    BuildError, Components, Corners, Defect, DerivedMesh, Faces, Fans, Invariant, Listed, Mesh,
    TornError, Violation,
};
/// The linear algebra crate that defines [`Point`] and [`Vector`], in the version used by this
/// crate.
pub use nalgebra;
pub use place::{Place, PositionError, Positions};
pub use scissor::{
    Cut, CutAim, CutEnd, CutError, CutLayers, CutMethod, CutNeck, CutPieces, CutReport, CutTips,
    LayerHit, Scissor, ScissorError, SeamLine,
};
#[doc(hidden)]
pub use sets::DisjointSets;
pub use sheet::Sheet;
pub use slide::SlideRefusal;
pub use split::SplitRefusal;
#[doc(hidden)]
pub use undo::{FacePart, Insertions, RemovalPlan};

/// The example on the page of the crate is a test.
#[cfg(doctest)]
#[doc = include_str!("README.md")]
struct Readme;

//! A cloth: a system that is made from a mesh, and follows the mesh's log while the mesh tears.

pub(crate) mod fabric;
pub(crate) mod follow;
pub(crate) mod held_set;
mod orthotropic;
pub(crate) mod seam;
pub(crate) mod tearing;

use std::fmt;

use tearmesh::geometry::{Point, Vector, cross, dot, length};
use tearmesh::{
    Cursor, FaceId, Follower as _, HalfEdgeId, MassError, Masses, Mesh, PerCorner, Positions,
    VertexId,
};

use self::fabric::{Bending, Fabric, Stretch};
use crate::method::solver::{Solver, StepError};
use crate::system::System;
use crate::system::constraint::{Constraint, ConstraintId};
use crate::system::error::SettingError;
use crate::system::incidence::room_for;

/// A system with a particle for each vertex and a stretch constraint for each edge of a mesh, and
/// with a [`Orthotropic`](crate::Orthotropic) a triangle for each face.
///
/// The mesh stays with the caller; a cloth is one more [`Follower`](tearmesh::Follower) of its log.
/// A split, an insertion or a merge in a running simulation costs time proportional to the valence
/// of its vertices, without a rebuild.
///
/// * **Split**: the new particle has the position and velocity of the old one, and [`Masses`]
///   divides the mass between them, so mass and momentum are exact. Constraints of moved faces go
///   with them; a torn edge gets a copy. A pinned particle's copy is pinned.
/// * **Insertion**: the edges of a divided membrane are measured anew. Between springs of one
///   stiffness, each part of a divided edge has that of the edge divided by the part's share of its
///   length, and stiffness times length of a new edge inside a face is the mean of the face's edges.
/// * **Merge**: the inverse of a split; velocities are joined by mass. Each face keeps its own shape at
///   rest. Where the two faces of an edge disagree on its length, it is as long at rest as two springs
///   side by side are, one of each face: Σ k L / Σ k.
/// * **Slide**: the particle moves along its edge, at rest as well; it keeps its velocity, so
///   momentum is exact. A membrane is measured anew around it; other springs keep stiffness times
///   length.
///
/// The stiffness of a membrane's edge is always, to the bit, that of a new cloth with this mesh and
/// these places at rest ([`Stretch::Membrane`]).
///
/// ```
/// use tearmesh_cloth::{Cloth, Fabric, Loads, Unstable, Verlet};
/// use tearmesh::{shapes, split, Edits, Masses, Plane, Vector};
///
/// let (mut mesh, positions) = shapes::grid(8, 8);
/// let masses = Masses::area(&mesh, &positions, 0.15)?;
/// let mut cloth = Cloth::new(&mesh, &positions, masses, Fabric::new(200.0))?;
/// let system = cloth.system_mut();
/// system.set_loads(Loads {
///     gravity_m_per_s2: Some(Vector::new(0.0, -9.81, 0.0)),
///     ..Loads::default()
/// })?;
/// (72..81).for_each(|top| system.hold(top));
/// system.when_unstable(Unstable::Substep); // A step that is too long is divided.
/// let mut solver = Verlet;
/// for _ in 0..30 {
///     cloth.step(&mut solver, 1.0 / 60.0)?;
/// }
///
/// // Split a vertex while it hangs.
/// let mut edits = Edits::new();
/// let v = mesh.vertex(40);
/// let plane = Plane::new(cloth.positions()[40], Vector::y())?;
/// split::by_plane(&mut mesh, v, &plane, cloth.positions(), &mut edits);
/// edits.replay(&mut cloth);
/// assert_eq!(cloth.indices(), mesh.indices());
/// assert!(cloth.masses().ledger().is_balanced());
/// cloth.step(&mut solver, 1.0 / 60.0)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Cloth {
    pub(super) system: System,
    pub(super) masses: Masses,
    /// Where the corners of faces are at rest: those of one vertex apart where panels meet that were
    /// drawn apart.
    pub(super) rest: PerCorner<Point>,
    pub(super) fabric: Fabric,
    /// Of stretch constraints, one for each edge.
    pub(super) stretch_of: EdgeMap,
    /// Of bend constraints, each across an edge. Empty without bending.
    pub(super) bend_of: EdgeMap,
    pub(super) scratch: EditScratch,
    pub(super) seen: Cursor,
}

/// Across a boundary or a tear.
pub(super) const NO_BEND: ConstraintId = ConstraintId(u32::MAX);

/// Which constraint of a family each edge has, and which edge each constraint.
#[derive(Clone, Debug, Default)]
pub(super) struct EdgeMap {
    /// By half-edge: the constraint, or [`NO_BEND`].
    pub(super) ids: Vec<ConstraintId>,
    /// By constraint: the half-edges of its edge, the lower first; twice the same where there is one.
    pub(super) edges: Vec<[HalfEdgeId; 2]>,
}

impl EdgeMap {
    pub(super) fn get(&self, h: HalfEdgeId) -> ConstraintId {
        self.ids.get(h.index()).copied().unwrap_or(NO_BEND)
    }

    /// Notes the constraint of an edge, given by its two half-edges, or twice the same.
    pub(super) fn join(&mut self, [one, other]: [HalfEdgeId; 2], id: ConstraintId) {
        let edge = [one.min(other), one.max(other)];
        let count = self.ids.len().max(edge[1].index() + 1);
        self.ids.resize(count, NO_BEND);
        edge.iter().for_each(|h| self.ids[h.index()] = id);
        let count = self.edges.len().max(id.index() + 1);
        self.edges.resize(count, edge);
        self.edges[id.index()] = edge;
    }
}

impl Cloth {
    /// Creates a cloth whose rest state is the present mesh. Takes linear time.
    ///
    /// A vertex without a face stays where it is. If the faces of a vertex have no mass, as pieces
    /// of a face without area, its particle has the mass of one unit ([`Masses::unit`]).
    ///
    /// Both halves of a held vertex are held, and a held vertex stays where it is when a free one is
    /// sewn to it. An inserted vertex is free, between held ones too: an edge between two pins may
    /// be that of a clamp or one that hangs.
    ///
    /// # Errors
    ///
    /// [`ClothError`] if a stiffness is not positive and finite, an edge (or, with bending, the
    /// distance across one) has no length, or a face of triangles has no area or no warp.
    ///
    /// # Panics
    ///
    /// If there is not one mass and one position for each vertex.
    pub fn new(
        mesh: &Mesh,
        positions: &Positions,
        masses: Masses,
        fabric: Fabric,
    ) -> Result<Cloth, ClothError> {
        let at = |&v: &u32| positions.as_slice().get(v as usize).copied();
        let rest = mesh.indices().iter().filter_map(at).collect();
        Cloth::with_rest(mesh, positions, rest, masses, fabric)
    }

    /// Creates a cloth of which each corner has a position at rest of its own, by half-edge, such as panels
    /// that are sewn already and were drawn flat ([`rest_corners`](Cloth::rest_corners)).
    ///
    /// # Errors
    ///
    /// [`ClothError`], as of [`Cloth::new`].
    ///
    /// # Panics
    ///
    /// If there is not one mass and one position for each vertex, and one at rest for each corner.
    pub fn with_rest(
        mesh: &Mesh,
        positions: &Positions,
        rest: Vec<Point>,
        masses: Masses,
        fabric: Fabric,
    ) -> Result<Cloth, ClothError> {
        fabric.check().map_err(ClothError::Number)?;
        let count = mesh.vertex_count();
        assert_eq!(
            (masses.vertex_count(), positions.len(), rest.len()),
            (count, count, mesh.half_edge_count()),
            "masses and positions are those of the mesh"
        );
        let of_vertex = |v| mesh.half_edge_of(v).map_or(0.0, |_| weight(&masses, v));
        let weights = mesh.vertices().map(of_vertex).collect();
        let points = positions.as_slice().iter().copied();
        let mut system = System::with_massless(points, weights);
        system.model.faces = mesh.indices().to_vec();
        let seen = positions.seen();
        let mut cloth = Cloth {
            system,
            masses: masses.starting_at(seen),
            rest: PerCorner::new(rest).starting_at(seen),
            fabric,
            stretch_of: EdgeMap::default(),
            bend_of: EdgeMap::default(),
            scratch: EditScratch::default(),
            seen,
        };
        cloth.system.model.damping_s = fabric.damping_s;
        for h in mesh.edges() {
            let ends = [mesh.origin(h), mesh.target(h)];
            let edge = [h, mesh.pair(h).unwrap_or(h)];
            let rest_length_m = checked_length(ends, cloth.rest_length(edge))?;
            let id = cloth.system.model.stretch.add(Constraint {
                ends: ends.map(VertexId::index),
                rest_length_m,
                stiffness_n_per_m: fabric.stretch_n_per_m() * fabric.share(mesh, h),
            });
            cloth.stretch_of.join(edge, id);
            cloth.measure(id);
        }
        if let Some(bend) = fabric.bend {
            if let Bending::Buckling { law, .. } = bend {
                cloth.system.model.bend.law = Some(law);
            }
            for h in mesh.edges() {
                if let Some(pair) = mesh.pair(h) {
                    let apexes = [h, pair].map(|h| mesh.origin(h.prev()));
                    checked_length(apexes, cloth.rest_across([h, pair]))?;
                    let id = cloth.bend_across([h, pair]);
                    let (field, given) = bend.number();
                    let made = SettingError::unless(id.is_some(), field, given, "less");
                    made.map_err(ClothError::Number)?;
                }
            }
        }
        cloth.add_triangles()?;
        Ok(cloth)
    }

    /// Makes room for all splits that can follow, of which each leaves every vertex a face, so that
    /// neither they allocate nor a step by a method that keeps its room in the system: all but
    /// [`Implicit`](crate::Implicit). (Only a colour beyond those that the present valence of vertices
    /// needs would take room of its own.) Costs some hundred bytes per face.
    pub(crate) fn reserve(&mut self, splits: usize, corners: usize) {
        self.masses.reserve(splits);
        room_for(&mut self.stretch_of.edges, corners);
        room_for(&mut self.scratch.ids, self.bend_of.edges.len());
        self.system.reserve(corners, corners);
    }

    /// Returns the place in the mesh's log up to which edits have been replayed on this cloth.
    #[must_use]
    pub fn seen(&self) -> Cursor {
        self.seen
    }

    /// Advances the cloth by `dt_s` seconds: see [`System::step`].
    ///
    /// # Errors
    ///
    /// [`StepError`]; positions and velocities are then as they were before.
    pub fn step(&mut self, solver: &mut dyn Solver, dt_s: f64) -> Result<u32, StepError> {
        self.system.step(solver, dt_s)
    }

    /// Returns the particles and constraints; vertex v is particle `v.index()`.
    #[must_use]
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Returns mutable access to the particles and constraints, for setting loads, pins and
    /// velocities.
    #[must_use]
    pub fn system_mut(&mut self) -> &mut System {
        &mut self.system
    }

    /// Returns the positions of the vertices, in metres. The slice is a [`Place`](tearmesh::Place).
    #[must_use]
    pub fn positions(&self) -> &[Point] {
        self.system.positions()
    }

    /// Returns the position at rest of each corner of each face, by half-edge. Lengths and areas at rest are
    /// those of the faces. The corners of a vertex differ where panels are sewn that were drawn apart.
    #[must_use]
    pub fn rest_corners(&self) -> &[Point] {
        self.rest.as_slice()
    }

    /// Returns the positions of the vertices at rest. A vertex at which panels are sewn is where the one with
    /// the lowest face has it, and a vertex without a face where it is now. Linear.
    #[must_use]
    pub fn rest_positions(&self) -> Vec<Point> {
        let mut places = self.positions().to_vec();
        for (&v, &at) in self.indices().iter().zip(self.rest_corners()).rev() {
            places[v as usize] = at; // The one written last is that of the lowest corner.
        }
        places
    }

    /// Returns the exact masses of the vertices.
    #[must_use]
    pub fn masses(&self) -> &Masses {
        &self.masses
    }

    /// Returns the vertices of all faces, three per face: an index buffer, equal to that of the
    /// mesh.
    #[must_use]
    pub fn indices(&self) -> &[u32] {
        &self.system.model.faces
    }

    /// Returns the stretch constraint of an edge, given as either of its half-edges.
    ///
    /// # Panics
    ///
    /// If there is no such half-edge.
    #[must_use]
    pub fn stretch(&self, h: HalfEdgeId) -> ConstraintId {
        self.stretch_of.ids[h.index()]
    }

    /// Returns the lower half-edge of the edge that a stretch constraint belongs to.
    ///
    /// # Panics
    ///
    /// If the constraint does not belong to an edge.
    #[must_use]
    pub fn edge(&self, id: ConstraintId) -> HalfEdgeId {
        self.stretch_of.edges[id.index()][0]
    }

    /// The length of a half-edge in its own face.
    pub(crate) fn side_length(&self, h: HalfEdgeId) -> f64 {
        length(self.rest_along(h))
    }

    /// The way along a half-edge in its own face at rest.
    pub(super) fn rest_along(&self, h: HalfEdgeId) -> Vector {
        *self.rest.at(h.next()) - *self.rest.at(h)
    }

    /// The length of an edge, given by its two half-edges, or twice the same.
    pub(super) fn rest_length(&self, edge: [HalfEdgeId; 2]) -> f64 {
        let [one, other] = edge.map(|h| self.side_length(h));
        if one == other {
            return one;
        }
        let [a, b] = [self.share(edge[0], one), self.share(edge[1], other)];
        let balanced = (a * one + b * other) / (a + b);
        let is_usable = balanced > 0.0 && balanced.is_finite();
        if is_usable {
            balanced
        } else {
            0.5 * (one + other)
        }
    }

    /// The distance across an edge at rest. Where its faces rest apart, as panels do, they are laid side by
    /// side in a plane, the middles of their edges together.
    fn rest_across(&self, edge: [HalfEdgeId; 2]) -> f64 {
        let sides = edge.map(|h| [h, h.next(), h.prev()].map(|h| *self.rest.at(h)));
        let [[a, b, apex], [c, d, other]] = sides;
        if (a, b) == (d, c) {
            return length(other - apex);
        }
        let [one, two] = sides.map(|[a, b, apex]| {
            let (along, up) = (b - a, apex - a);
            let base = length(along);
            Vector::new(
                dot(up, along) / base - 0.5 * base,
                length(cross(along, up)) / base,
                0.0,
            )
        });
        length(one + two) // Both edges run forward, and so both x: once along, once against.
    }

    /// Gives an edge of a membrane the stiffness that its faces have at rest now, and the force that it
    /// remembers in proportion; and an edge on whose length its faces disagree its own between both.
    pub(super) fn measure(&mut self, id: ConstraintId) {
        let edge = self.stretch_of.edges[id.index()];
        let mut lengths = edge.map(|h| self.side_length(h));
        if lengths[0] == lengths[1] {
            lengths = [self.system.model.stretch.get(id).rest_length_m; 2];
        } else {
            let between = self.rest_length(edge);
            self.system.model.stretch.set_rest_length(id, between);
        }
        let Stretch::Membrane { modulus_n_per_m } = self.fabric.stretch else {
            return;
        };
        let mut stiffness = modulus_n_per_m * self.share(edge[0], lengths[0]);
        if edge[0] != edge[1] {
            stiffness += modulus_n_per_m * self.share(edge[1], lengths[1]);
        }
        // Faces without area have no stiffness, but a compliance must be finite.
        let stiffness = stiffness.max(modulus_n_per_m * f64::EPSILON);
        let stretch = &mut self.system.model.stretch;
        if stiffness != stretch.get(id).stiffness_n_per_m {
            stretch.stiffen(id, stiffness);
        }
    }

    /// What a face adds to the stiffness of its edge of this length, over the modulus: A / l².
    fn share(&self, h: HalfEdgeId, length: f64) -> f64 {
        self.rest_area(h) / length / length
    }

    /// The area at rest of a half-edge's face.
    fn rest_area(&self, h: HalfEdgeId) -> f64 {
        let [a, b, c] = self.rest_face(h.face());
        0.5 * length(cross(b - a, c - a))
    }

    /// The stiffness of a bend constraint of this length across an edge. `None` where it is beyond all
    /// numbers.
    fn bend_stiffness(&self, edge: [HalfEdgeId; 2], rest_length_m: f64) -> Option<f64> {
        let [one, other] = edge.map(|h| self.rest_area(h));
        let bend = self.fabric.bend?;
        bend.stiffness_n_per_m(rest_length_m, one + other)
    }

    /// Gives the bend constraint across an edge the length that the rest positions of its ends have
    /// now, and the stiffness that goes with it: none where rounding left no length for one. Does
    /// nothing without such a constraint.
    pub(super) fn measure_bend(&mut self, h: HalfEdgeId) {
        let id = self.bend_of.get(h);
        if id == NO_BEND {
            return;
        }
        let edge = self.bend_of.edges[id.index()];
        let rest_length_m = self.rest_across(edge).max(f64::MIN_POSITIVE);
        let stiffness = self.bend_stiffness(edge, rest_length_m);
        let bend = &mut self.system.model.bend;
        bend.set_rest_length(id, rest_length_m);
        bend.set_stiffness(id, stiffness.unwrap_or(0.0));
        self.system.edited();
    }

    /// Adds the bend constraint across an edge, unless there is no distance across it.
    pub(super) fn bend_across(&mut self, edge: [HalfEdgeId; 2]) -> Option<ConstraintId> {
        let apexes = edge.map(|h| self.system.model.faces[h.prev().index()] as usize);
        let rest_length_m = self.rest_across(edge);
        if rest_length_m.is_nan() || rest_length_m <= 0.0 {
            return None;
        }
        let stiffness_n_per_m = self.bend_stiffness(edge, rest_length_m)?;
        let id = self.system.model.bend.add(Constraint {
            ends: apexes,
            rest_length_m,
            stiffness_n_per_m,
        });
        self.bend_of.join(edge, id);
        self.system.edited();
        Some(id)
    }
}

/// The length of a constraint between two vertices, if it is one.
fn checked_length(ends: [VertexId; 2], given: f64) -> Result<f64, ClothError> {
    let is_usable = given > 0.0 && given.is_finite();
    let error = ClothError::Length { ends, given };
    is_usable.then_some(given).ok_or(error)
}

/// What the particle of a vertex with a face weighs: its exact mass, but a unit at least. What
/// comes off a face without area may weigh nothing, and a particle without mass would stay
/// where it is in the air.
pub(super) fn weight(masses: &Masses, v: VertexId) -> f64 {
    masses.at(v).max(masses.unit())
}

/// Room that edits reuse.
#[derive(Clone, Debug, Default)]
pub(crate) struct EditScratch {
    pub(crate) ids: Vec<ConstraintId>,
    pub(crate) pieces: Vec<Piece>,
}

/// An edge of a child, from one of its sides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// The lower particle first. They name the edge: no two edges have the same two.
    pub(crate) ends: [usize; 2],
    pub(crate) half_edge: HalfEdgeId,
    /// The half-edge of the parent that it lies on; any for one inside.
    pub(crate) half_edge_before: HalfEdgeId,
    pub(crate) apex: usize,
    pub(crate) apex_before: usize,
    /// Whether it is a whole edge of the parent.
    pub(crate) is_kept: bool,
    /// Whether it is a part of an edge of the parent.
    pub(crate) divided: bool,
    /// The stretch and the bend constraint of that edge.
    pub(crate) ids: [ConstraintId; 2],
    /// What k L shall be.
    pub(crate) stiffness_by_length: f64,
    pub(crate) length: f64,
}

/// The reason why a cloth was refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ClothError {
    /// The masses were refused.
    Mass(MassError),
    /// A number of the [`Fabric`] cannot be used, or would make a bend too stiff.
    Number(SettingError),
    /// Two vertices that a constraint joins are at the same place, or have coordinates that are not
    /// finite.
    Length {
        /// The two vertices.
        ends: [VertexId; 2],
        /// The rest length between them, in metres.
        given: f64,
    },
    /// A face of a cloth with a [`Orthotropic`](crate::Orthotropic) has no area at rest, or the direction of
    /// warp is perpendicular to it.
    Face {
        /// The face that cannot be used.
        face: FaceId,
        /// The direction of warp that was given, in space.
        warp: Vector,
    },
}

impl fmt::Display for ClothError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ClothError::Mass(error) => error.fmt(f),
            ClothError::Number(error) => error.fmt(f),
            ClothError::Length {
                ends: [a, b],
                given,
            } => write!(f, "the edge {a}-{b} has the rest length {given} m"),
            ClothError::Face { face, warp } => write!(
                f,
                "the face {face} has no area at rest, or the warp ({}, {}, {}) no direction in it",
                warp.x, warp.y, warp.z
            ),
        }
    }
}

impl std::error::Error for ClothError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            ClothError::Mass(error) => Some(error),
            ClothError::Number(error) => Some(error),
            _ => None,
        }
    }
}

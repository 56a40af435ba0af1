//! A mesh and everything that follows it, held together.
//!
//! The parts of a cut (mesh, positions, masses, texture coordinates and the log between them) can
//! each be held alone, as an engine does. Most programs hold them together: then nothing can be
//! forgotten or out of step.

use crate::edit::{Edits, Follower as _, Followers};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mass::{MassError, Masses};
use crate::mend;
use crate::mesh::{Mesh, Violation};
use crate::place::Positions;
use crate::scissor::{Cut, CutError, CutMethod, CutReport, Scissor};
use crate::split::{self, SplitRefusal};
use crate::tear;

/// A mesh with the positions of its vertices, their masses if wanted, and other values that follow
/// its edits: any [`Follower`](crate::Follower), or a tuple of them.
///
/// ```
/// use tearmesh::{shapes, CutMethod, PerCorner, Plane, Point, Scissor, Sheet, Vector};
///
/// let (mesh, positions) = shapes::grid(16, 16);
/// let uv = mesh.half_edges().map(|h| positions.at(mesh.origin(h)));
/// let uv = PerCorner::new(uv.map(|p| [p.x, p.y]).collect());
/// let mut sheet = Sheet::new(mesh, positions).with_masses(0.15)?.with(uv);
///
/// let plane = Plane::new(Point::new(0.3, 0.0, 0.0), Vector::new(1.0, 0.2, 0.0))?;
/// sheet.cut(CutMethod::Exact, &Scissor::by_plane(plane))?;
/// assert_eq!(sheet.mesh().components().count(), 2);
/// assert_eq!(sheet.values().as_slice().len(), sheet.mesh().half_edge_count());
///
/// sheet.mend(|_| true);
/// assert_eq!(sheet.mesh().components().count(), 1);
/// assert!(sheet.masses().unwrap().ledger().is_balanced());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sheet<V = ()> {
    mesh: Mesh,
    positions: Positions,
    masses: Option<Masses>,
    values: V,
    /// Of the last operation.
    edits: Edits,
}

impl Sheet {
    /// Creates the sheet of a mesh. Its log continues at the cursor of the positions.
    ///
    /// # Panics
    ///
    /// If there is not one position for each vertex.
    #[must_use]
    pub fn new(mesh: Mesh, positions: Positions) -> Sheet {
        assert_eq!(
            positions.len(),
            mesh.vertex_count(),
            "positions are those of the mesh"
        );
        Sheet {
            edits: Edits::starting_at(positions.seen()),
            mesh,
            positions,
            masses: None,
            values: (),
        }
    }
}

impl<V: Followers> Sheet<V> {
    /// Adds masses by area, of this density: see [`Masses::area`].
    ///
    /// # Errors
    ///
    /// [`MassError`] if the density, the area or a mass is out of range.
    pub fn with_masses(self, density: f64) -> Result<Sheet<V>, MassError> {
        let masses = Masses::area(&self.mesh, &self.positions, density)?;
        let masses = Some(masses.starting_at(self.edits.cursor()));
        Ok(Sheet { masses, ..self })
    }

    /// Sets the values that follow the edits of this sheet.
    ///
    /// New values are those of the mesh as it was when its positions were made, or before the first
    /// operation. Values of the mesh as it is now, after some operations, begin at the end of its log:
    ///
    /// ```
    /// use tearmesh::{shapes, Follower, PerVertex, Sheet};
    ///
    /// let (mesh, positions) = shapes::grid(2, 2);
    /// let (v, face) = (mesh.vertex(4), mesh.face(0));
    /// let mut sheet = Sheet::new(mesh, positions);
    /// sheet.split(v, &[face])?;
    /// let heat = PerVertex::new(vec![0.5; sheet.mesh().vertex_count()]);
    /// let now = sheet.edits().cursor();
    /// let sheet = sheet.with(heat.starting_at(now));
    /// assert_eq!(sheet.values().as_slice().len(), 10);
    /// # Ok::<(), tearmesh::SplitRefusal>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If a follower is not at a place in the log of the sheet: see [`Edits::replay`].
    #[must_use]
    pub fn with<W: Followers>(self, mut values: W) -> Sheet<W> {
        self.edits.replay(&mut values);
        Sheet {
            mesh: self.mesh,
            positions: self.positions,
            masses: self.masses,
            values,
            edits: self.edits,
        }
    }

    /// Returns the mesh.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Returns the positions of the vertices.
    #[must_use]
    pub fn positions(&self) -> &Positions {
        &self.positions
    }

    /// Returns the masses of the vertices, or `None` if the sheet was made without.
    #[must_use]
    pub fn masses(&self) -> Option<&Masses> {
        self.masses.as_ref()
    }

    /// Returns the values that follow the edits.
    #[must_use]
    pub fn values(&self) -> &V {
        &self.values
    }

    /// Returns mutable access to the values that follow the edits, for example to
    /// [take the changes](crate::engine::DrawBuffers::take_changes) of buffers.
    #[must_use]
    pub fn values_mut(&mut self) -> &mut V {
        &mut self.values
    }

    /// Returns the log, which has the edits of the last operation. A follower that is not held by the
    /// sheet, such as the end of a cut, must replay it after each operation.
    #[must_use]
    pub fn edits(&self) -> &Edits {
        &self.edits
    }

    /// Splits a vertex, and returns the new one: see [`split::vertex`].
    ///
    /// # Errors
    ///
    /// [`SplitRefusal`] gives the reason for a refusal. Nothing has changed then.
    ///
    /// # Panics
    ///
    /// If `v` or a face is not in this mesh (I2).
    pub fn split(&mut self, v: VertexId, moving: &[FaceId]) -> Result<VertexId, SplitRefusal> {
        self.edit(|sheet| {
            let split = split::vertex(&mut sheet.mesh, v, moving, &mut sheet.edits);
            split.map(|split| split.new)
        })
    }

    /// Tears an overstretched edge, and returns the new vertex, or `None` if no end can be split: see
    /// [`tear::edge`]. Without masses, both ends weigh the same. `is_free` returns whether a vertex
    /// may be split.
    ///
    /// # Panics
    ///
    /// If `edge` is not in this mesh (I2).
    pub fn tear(
        &mut self,
        edge: HalfEdgeId,
        is_free: impl Fn(VertexId) -> bool,
    ) -> Option<VertexId> {
        self.edit(|sheet| {
            let mass = |v: VertexId| is_free(v).then(|| weight(sheet.masses.as_ref(), v));
            let (mesh, edits) = (&mut sheet.mesh, &mut sheet.edits);
            let split = tear::edge(mesh, edge, &sheet.positions, mass, edits);
            split.map(|split| split.new)
        })
    }

    /// Cuts the sheet: see [`Scissor::cut`].
    ///
    /// # Errors
    ///
    /// [`CutError`] if the scissor continues a cut whose end has not replayed the log. Nothing has
    /// changed then.
    pub fn cut(&mut self, method: CutMethod, scissor: &Scissor) -> Result<Cut, CutError> {
        self.edit(|sheet| {
            let (mesh, positions) = (&mut sheet.mesh, &mut sheet.positions);
            scissor.cut(method, mesh, positions, &mut sheet.edits)
        })
    }

    /// Cuts the sheet, and measures the cut: see [`Scissor::cut_measured`].
    ///
    /// # Errors
    ///
    /// For the same reason as [`Sheet::cut`].
    pub fn cut_measured(
        &mut self,
        method: CutMethod,
        scissor: &Scissor,
    ) -> Result<(Cut, CutReport), CutError> {
        self.edit(|sheet| {
            let (mesh, positions) = (&mut sheet.mesh, &mut sheet.positions);
            scissor.cut_measured(method, mesh, positions, &mut sheet.edits)
        })
    }

    /// Sews all chosen vertices that were split from the same one, wherever they are now, and
    /// returns the number of merges: see [`mend::sew`].
    #[expect(
        clippy::missing_panics_doc,
        reason = "only a bug of ours can trip the expectation"
    )]
    pub fn mend(&mut self, chosen: impl Fn(VertexId) -> bool) -> usize {
        self.edit(|sheet| {
            let stitches = mend::stitches(&sheet.mesh, chosen);
            let (mesh, edits) = (&mut sheet.mesh, &mut sheet.edits);
            let (weight, far) = (|v| weight(sheet.masses.as_ref(), v), f64::INFINITY);
            let merges = mend::sew(mesh, &sheet.positions, &stitches, weight, far, edits);
            merges.expect("I8: copies have one root, and a mass is a weight")
        })
    }

    /// Checks every invariant of the mesh: see [`Mesh::check`].
    #[must_use]
    pub fn check(&self) -> Vec<Violation> {
        self.mesh.check()
    }

    /// Carries out an operation, and lets everything follow it.
    fn edit<T>(&mut self, operation: impl FnOnce(&mut Sheet<V>) -> T) -> T {
        self.edits.clear();
        let made = operation(self);
        self.edits.replay(&mut self.positions);
        if let Some(masses) = &mut self.masses {
            self.edits.replay(masses);
        }
        self.edits.replay(&mut self.values);
        made
    }
}

fn weight(masses: Option<&Masses>, v: VertexId) -> f64 {
    masses.map_or(1.0, |masses| masses.at(v))
}

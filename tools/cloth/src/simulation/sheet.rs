//! A mesh, the positions and exact masses of its vertices, and the log of its edits, which change
//! together. It knows no cloth.

use tearmesh::{
    Cut, CutError, CutMethod, CutReport, Edits, Followers, HalfEdgeId, MassError, Masses, Mesh,
    Point, PositionError, Positions, Scissor, VertexId, mend,
};

/// A mesh with what every follower of it needs.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub(crate) mesh: Mesh,
    /// Where the vertices were when the mesh was last cut, and since then by its edits alone: a
    /// cloth that moves says where they are by [`Sheet::move_to`].
    pub(super) positions: Positions,
    pub(super) masses: Masses,
    pub(crate) edits: Edits,
}

impl Sheet {
    /// A sheet of this mass per area, in kg/m². Its log continues at the cursor of the positions.
    pub(super) fn new(
        mesh: Mesh,
        positions: Positions,
        density_kg_per_m2: f64,
    ) -> Result<Sheet, MassError> {
        let seen = positions.seen();
        Ok(Sheet {
            masses: Masses::area(&mesh, &positions, density_kg_per_m2)?.starting_at(seen),
            mesh,
            positions,
            edits: Edits::starting_at(seen),
        })
    }

    /// Makes room for all splits that can follow: each leaves every vertex a face, so V ≤ 3F. Returns
    /// how many.
    pub(super) fn reserve(&mut self) -> usize {
        let corners = self.mesh.half_edge_count();
        let splits = corners.saturating_sub(self.mesh.vertex_count());
        self.mesh.reserve(splits);
        self.positions.reserve(splits);
        self.masses.reserve(splits);
        self.edits.reserve(splits, 2 * corners, corners);
        splits
    }

    /// Brings positions and masses up to date with the log, and all these followers.
    pub(super) fn follow(&mut self, others: &mut impl Followers) {
        let mut own = (&mut self.positions, &mut self.masses);
        self.edits.replay(&mut own);
        self.edits.replay(others);
    }

    /// Takes over where the vertices are now.
    pub(super) fn move_to(&mut self, points: &[Point]) -> Result<(), PositionError> {
        let positions = Positions::new(points.iter().copied())?;
        self.positions = positions.starting_at(self.edits.cursor());
        Ok(())
    }

    /// Cuts the sheet where it is.
    pub(super) fn cut(&mut self, scissor: &Scissor) -> Result<Cut, CutError> {
        let (mesh, positions) = (&mut self.mesh, &mut self.positions);
        scissor.cut(CutMethod::Exact, mesh, positions, &mut self.edits)
    }

    /// Cuts the sheet where it is, and measures the cut.
    pub(super) fn cut_measured(
        &mut self,
        scissor: &Scissor,
        method: CutMethod,
    ) -> Result<(Cut, CutReport), CutError> {
        let (mesh, positions) = (&mut self.mesh, &mut self.positions);
        scissor.cut_measured(method, mesh, positions, &mut self.edits)
    }

    /// Makes two copies of a vertex one again.
    ///
    /// # Panics
    ///
    /// If they are not copies of one vertex.
    pub(super) fn merge(&mut self, [one, other]: [VertexId; 2]) {
        let weights = [one, other].map(|v| self.masses.at(v));
        let merged = mend::merge(&mut self.mesh, one, other, weights, &mut self.edits);
        merged.expect("I8: both sides of a torn link have one root, and masses are weights");
    }

    /// The vertices at both ends of a torn link that are not yet one, as seen from one of its
    /// half-edges; none for an edge that is whole.
    pub(super) fn apart(&self, h: HalfEdgeId) -> impl Iterator<Item = [VertexId; 2]> + use<> {
        let mesh = &self.mesh;
        let sides = mesh.ghost_pair(h).map(|ghost| {
            [
                [mesh.origin(h), mesh.target(ghost)],
                [mesh.target(h), mesh.origin(ghost)],
            ]
        });
        let ends = sides.into_iter().flatten();
        ends.filter(|[one, other]| one != other)
            .map(|[one, other]| [one.min(other), one.max(other)])
    }
}

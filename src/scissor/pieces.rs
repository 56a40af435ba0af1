//! Into how many pieces a cut should divide a mesh, before it does.
//!
//! Each face has a part in front and a part behind, as far as it has either. The parts of a face are
//! one unless the slit crosses the face fully; parts of neighbours are one where they meet along an
//! edge. What remains apart is a piece.
//!
//! What is in front and where the slit runs is for the cut to say: whoever rounded a second time
//! would see a piece more or less than the cut where a ray passes a boundary exactly, or by less
//! than the snap.

use crate::geometry::Side;
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::sets::DisjointSets;

/// Counts the pieces. `sign` is zero for a vertex on the plane; `is_slit` says of a face with
/// vertices on both sides whether the slit crosses it from node to node, `is_slit_along` of an edge
/// on the plane, by either half-edge, whether it is slit from end to end.
pub(super) fn expected(
    mesh: &Mesh,
    sign: impl Fn(VertexId) -> f64,
    is_slit: impl Fn(FaceId) -> bool,
    is_slit_along: impl Fn(HalfEdgeId) -> bool,
) -> usize {
    let is_crossed = |f: FaceId| {
        let signs = mesh.face_vertices(f).map(&sign);
        signs.iter().any(|&d| d < 0.0) && signs.iter().any(|&d| d > 0.0)
    };
    // Of a face that is not crossed; one that lies on the plane is in front.
    let lone_side = |f: FaceId| {
        Side::of(
            mesh.face_vertices(f)
                .map(&sign)
                .into_iter()
                .fold(0.0, f64::min),
        )
    };
    let mut parts = Parts::new(mesh.face_count());
    for f in mesh.faces() {
        if is_crossed(f) && !is_slit(f) {
            parts.join((f, Side::Front), (f, Side::Back));
        }
    }
    for h in mesh.edges() {
        let Some(pair) = mesh.pair(h) else { continue };
        let (f, g) = (h.face(), pair.face());
        let signs = [mesh.origin(h), mesh.target(h)].map(&sign);
        if signs == [0.0; 2] && !is_slit_along(h) {
            parts.join((f, lone_side(f)), (g, lone_side(g)));
        }
        if signs.iter().any(|&d| d > 0.0) {
            parts.join((f, Side::Front), (g, Side::Front));
        }
        if signs.iter().any(|&d| d < 0.0) {
            parts.join((f, Side::Back), (g, Side::Back));
        }
    }
    parts.count(|f, side| is_crossed(f) || side == lone_side(f))
}

/// The two parts of each face, in sets.
struct Parts(DisjointSets);

impl Parts {
    fn new(faces: usize) -> Parts {
        Parts(DisjointSets::new(2 * faces as u32))
    }

    fn node((f, side): (FaceId, Side)) -> u32 {
        2 * f.index() as u32 + u32::from(side == Side::Back)
    }

    fn join(&mut self, a: (FaceId, Side), b: (FaceId, Side)) {
        self.0.join(Self::node(a), Self::node(b));
    }

    /// The number of sets with a part that exists.
    fn count(&mut self, exists: impl Fn(FaceId, Side) -> bool) -> usize {
        let mut seen = vec![false; self.0.len()];
        for f in (0..self.0.len() as u32 / 2).map(FaceId::from_u32) {
            for side in [Side::Front, Side::Back] {
                if exists(f, side) {
                    seen[self.0.leader(Self::node((f, side))) as usize] = true;
                }
            }
        }
        seen.into_iter().filter(|&seen| seen).count()
    }
}

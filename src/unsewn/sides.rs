//! Boundary half-edges and their partners.

use super::groups::for_each_group;
use super::spots::Spots;
use crate::id::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::place::Place;

/// The largest number of boundary edges at one place that are compared one by one. Where more meet, all
/// are left apart.
const CROWD: usize = 16;

/// Boundary half-edges, sorted by what coincides with them.
#[derive(Default)]
pub(super) struct Sides {
    /// Each other's only partners, the smaller half-edge first; ascending.
    pub(super) edges: Vec<[HalfEdgeId; 2]>,
    pub(super) crowded: Vec<HalfEdgeId>,
    pub(super) same_direction: Vec<HalfEdgeId>,
    pub(super) alone: Vec<HalfEdgeId>,
}

impl Sides {
    pub(super) fn of<P: Place + ?Sized>(
        mesh: &Mesh,
        spots: &Spots<'_, P>,
        half_edges: &[HalfEdgeId],
    ) -> Sides {
        let mut sides = Sides::default();
        let ends = |h: HalfEdgeId| [mesh.origin(h), mesh.target(h)].map(|v| spots.of_vertex(v));
        let with_higher = |&h: &HalfEdgeId| {
            let [from, to] = ends(h);
            (from.max(to), h)
        };
        let half_edges: Vec<(u32, HalfEdgeId)> = half_edges.iter().map(with_higher).collect();
        let lower = |(higher, h): (u32, HalfEdgeId)| {
            let [from, to] = ends(h);
            (if from == higher { to } else { from }) as usize
        };
        let (mut back, mut ahead) = (Vec::new(), Vec::new());
        for_each_group(&half_edges, spots.count(), lower, |at_lower| {
            at_lower.sort_unstable();
            for at_one_place in at_lower.chunk_by(|a, b| a.0 == b.0) {
                back.clear();
                ahead.clear();
                for &(higher, h) in at_one_place {
                    match ends(h) {
                        [from, to] if from == to => sides.alone.push(h),
                        [_, to] if to == higher => ahead.push(h),
                        _ => back.push(h),
                    }
                }
                sides.sort(mesh, spots, &back, &ahead);
            }
        });
        sides.edges.sort_unstable();
        sides
    }

    /// Sorts the half-edges at one place, those back and those ahead.
    fn sort<P: Place + ?Sized>(
        &mut self,
        mesh: &Mesh,
        spots: &Spots<'_, P>,
        back: &[HalfEdgeId],
        ahead: &[HalfEdgeId],
    ) {
        match (back, ahead) {
            ([], []) => {}
            ([h], []) | ([], [h]) => self.alone.push(*h),
            (&[h], &[g]) if spots.are_partners(mesh, h, g) => self.edges.push([h.min(g), h.max(g)]),
            _ if back.len() + ahead.len() > CROWD => {
                self.crowded.extend(back.iter().chain(ahead));
            }
            _ => {
                self.compare(mesh, spots, back, ahead);
                self.compare(mesh, spots, ahead, back);
            }
        }
    }

    /// Sorts half-edges that run one way between two places by those that run the other way.
    fn compare<P: Place + ?Sized>(
        &mut self,
        mesh: &Mesh,
        spots: &Spots<'_, P>,
        one_way: &[HalfEdgeId],
        other_way: &[HalfEdgeId],
    ) {
        let partners = |h: HalfEdgeId, among: &[HalfEdgeId]| {
            let mut partners = among
                .iter()
                .copied()
                .filter(|&g| spots.are_partners(mesh, h, g));
            (partners.next(), partners.next().is_some())
        };
        for &h in one_way {
            match partners(h, other_way) {
                (Some(g), false) if partners(g, one_way) == (Some(h), false) => {
                    if h < g {
                        self.edges.push([h, g]);
                    }
                }
                (Some(_), _) => self.crowded.push(h),
                (None, _) if partners(h, one_way).0.is_none() => self.alone.push(h),
                (None, _) => self.same_direction.push(h),
            }
        }
    }
}

/// The vertices that a seam edge joins.
pub(super) fn joined(mesh: &Mesh, [h, g]: [HalfEdgeId; 2]) -> [[VertexId; 2]; 2] {
    [
        [mesh.origin(h), mesh.target(g)],
        [mesh.target(h), mesh.origin(g)],
    ]
}

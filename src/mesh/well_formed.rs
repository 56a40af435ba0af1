//! Whether a mesh is well-formed: the yes or no of [`Mesh::check`], at a third of its cost.
//!
//! Three passes decide it, without sorting and without the walkers: links agree with labels (I3 to
//! I7), start half-edges are the smallest (I9), and the corners of each vertex lie in one orbit (I8)
//! of a root complex in which a directed edge occurs once, opposites are paired and faces differ.
//! What holds of the root complex holds of its relabelling (I11 to I13), and what the walkers list
//! follows (I10, I18, I19): `invariants.md` has the arguments, and `tests/proof` the theorems.

use super::Mesh;
use crate::id::{FaceId, HalfEdgeId};

const NONE: u32 = u32::MAX;

impl Mesh {
    /// Whether every invariant holds, in a mesh whose sizes and ids are right (I1, I2). Linear.
    pub(super) fn is_well_formed(&self) -> bool {
        self.links_agree() && self.starts_are_smallest() && self.has_a_root_complex()
    }

    fn links_agree(&self) -> bool {
        self.faces().all(|f| {
            let [a, b, c] = self.face_vertices(f);
            let agrees = |h: HalfEdgeId| {
                let Some(g) = self.pair_or_ghost(h) else {
                    return true;
                };
                let [torn, back_torn] = [h, g].map(|h| self.ghost_pair(h).is_some());
                let ends = [self.origin(h), self.origin(h.next())];
                let is_pair = ends == [self.origin(g.next()), self.origin(g)];
                self.pair_or_ghost(g) == Some(h) && back_torn == torn && is_pair != torn
            };
            let sides = f.half_edges();
            // Two faces that share two edges have the same three vertices. (One that is linked to itself too.)
            let [x, y, z] = sides.map(|h| self.pair_or_ghost(h).map(HalfEdgeId::face));
            let differ = |one: Option<FaceId>, other| one != other || one.is_none();
            let all_differ = differ(x, y) && differ(y, z) && differ(z, x);
            let is_own = [x, y, z].contains(&Some(f));
            a != b && b != c && c != a && all_differ && !is_own && sides.into_iter().all(agrees)
        })
    }

    fn starts_are_smallest(&self) -> bool {
        let mut starts = self.outgoing.iter().zip(0..);
        let mut corners = self.origin.iter().zip(0..);
        starts.all(|(&h, v)| h == NONE || self.origin[h as usize] == v)
            && corners.all(|(&v, h)| self.outgoing[v as usize] <= h)
    }

    /// Whether links and labels are those of a manifold whose corners were relabelled. Links must agree.
    fn has_a_root_complex(&self) -> bool {
        let mut roots = vec![NONE; self.half_edge_count()];
        let mut root_of = vec![NONE; self.vertex_count()];
        let mut orbits = Vec::with_capacity(self.half_edge_count());
        // Of an orbit that is open, the half-edge of the boundary that leaves it.
        let mut boundary: Vec<Option<HalfEdgeId>> = Vec::with_capacity(self.vertex_count());
        for first in self.half_edges() {
            if roots[first.index()] != NONE {
                continue;
            }
            let root = boundary.len() as u32;
            let mut is_one = true;
            let mut visit = |h: HalfEdgeId| {
                roots[h.index()] = root;
                orbits.push(h);
                let of = &mut root_of[self.origin[h.index()] as usize];
                is_one &= *of == NONE || *of == root;
                *of = root;
            };
            // Links are an involution, so a walk comes back to where it began or ends at the boundary.
            let mut at = first;
            let is_closed = loop {
                visit(at);
                match self.pair_or_ghost(at.prev()) {
                    Some(ahead) if ahead == first => break true,
                    Some(ahead) => at = ahead,
                    None => break false,
                }
            };
            at = first;
            while let Some(g) = self.pair_or_ghost(at).filter(|_| !is_closed) {
                at = g.next();
                visit(at);
            }
            if !is_one {
                return false;
            }
            boundary.push((!is_closed).then_some(at));
        }
        let target = |h: HalfEdgeId| roots[h.next().index()] as usize;
        let mut reached = vec![NONE; boundary.len()];
        let each_is_reached_once = orbits.into_iter().all(|h: HalfEdgeId| {
            let root = roots[h.index()];
            reached[root as usize] = root;
            std::mem::replace(&mut reached[target(h)], root) != root
        });
        // Two half-edges of the boundary between the same two roots are opposites without a link.
        each_is_reached_once
            && (0..).zip(&boundary).all(|(root, leaving)| {
                let next = leaving.map(&target);
                let back = next.and_then(|next| boundary[next]).map(&target);
                back != Some(root)
            })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Link, Mesh};
    use crate::{Edits, FaceId, HalfEdgeId, VertexId, insert::Plan, mend, shapes, split};

    /// A plain generator of numbers.
    struct Numbers(u64);

    impl Numbers {
        fn below(&mut self, bound: usize) -> usize {
            self.0 = self
                .0
                .wrapping_mul(0x5851_f42d_4c95_7f2d)
                .wrapping_add(0x1405_7b7e_f767_814f);
            (self.0 >> 33) as usize % bound
        }
    }

    /// A small mesh after some splits, merges and insertions.
    fn edited(numbers: &mut Numbers) -> Mesh {
        let mut mesh = match numbers.below(4) {
            0 => shapes::fan(3 + numbers.below(4) as u32, true).0,
            1 => shapes::tetrahedron().0,
            _ => shapes::grid(1 + numbers.below(3) as u32, 1 + numbers.below(2) as u32).0,
        };
        let edits = &mut Edits::new();
        for _ in 0..numbers.below(12) {
            let [v, other] =
                [(); 2].map(|()| VertexId::from_u32(numbers.below(mesh.vertex_count()) as u32));
            let _ = match numbers.below(6) {
                0 => {
                    let mut plan = Plan::new();
                    plan.on_edge(
                        HalfEdgeId::from_u32(numbers.below(mesh.half_edge_count()) as u32),
                        0.5,
                    );
                    plan.apply(&mut mesh, edits).is_ok()
                }
                1 => mend::merge(&mut mesh, v, other, [1.0, 1.0], edits).is_ok(),
                _ => {
                    let faces: Vec<FaceId> =
                        mesh.faces_of(v).filter(|_| numbers.below(2) == 0).collect();
                    split::vertex(&mut mesh, v, &faces, edits).is_ok()
                }
            };
        }
        mesh
    }

    #[test]
    fn a_mesh_is_well_formed_where_the_check_of_each_invariant_finds_nothing() {
        let mut numbers = Numbers(1);
        let (mut damaged, mut unharmed, mut strict) = (0, 0, 0);
        for _ in 0..40_000 {
            let mut mesh = edited(&mut numbers);
            assert!(mesh.is_well_formed(), "{mesh:?}");
            for _ in 0..1 + numbers.below(3) {
                let [h, g] = [(); 2].map(|()| numbers.below(mesh.half_edge_count()));
                match numbers.below(7) {
                    0 => mesh.origin[h] = numbers.below(mesh.vertex_count()) as u32,
                    1 => mesh.origin.swap(h, g),
                    2 => mesh.link[h].0 ^= Link::TORN,
                    3 => mesh.link.swap(h, g),
                    4 => mesh.link[h] = mesh.link[g],
                    5 => {
                        (mesh.link[h], mesh.link[g]) = (Link(g as u32), Link(h as u32));
                    }
                    _ => {
                        let v = numbers.below(mesh.vertex_count());
                        mesh.outgoing[v] = g as u32;
                    }
                }
                if numbers.below(2) == 0 {
                    mesh.outgoing.fill(super::NONE);
                    for (h, &v) in mesh.origin.iter().enumerate().rev() {
                        mesh.outgoing[v as usize] = h as u32;
                    }
                }
            }
            if mesh.link.iter().any(|link| {
                link.opposite()
                    .is_some_and(|g| g.index() >= mesh.link.len())
            }) {
                continue;
            }
            let found = mesh.violations();
            if mesh.is_well_formed() {
                assert_eq!(found, [], "{mesh:?}");
                unharmed += 1;
            } else if found.is_empty() {
                strict += 1;
            } else {
                damaged += 1;
            }
        }
        let counts = (damaged, unharmed, strict);
        assert!(
            damaged > 20_000 && unharmed > 500 && strict == 0,
            "{counts:?}"
        );
    }
}

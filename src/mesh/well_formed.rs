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
            let agrees = |h: HalfEdgeId| {
                let Some(g) = self.pair_or_ghost(h) else {
                    return true;
                };
                let ends = [self.origin(h), self.origin(h.next())];
                let is_pair = ends == [self.origin(g.next()), self.origin(g)];
                self.pair_or_ghost(g) == Some(h) && is_pair == self.pair(h).is_some()
            };
            let sides = f.half_edges();
            let [x, y, z] = sides.map(|h| self.pair_or_ghost(h).map(HalfEdgeId::face));
            let differ = |one: Option<FaceId>, other| one != other || one.is_none();
            // Two faces that share two edges have the same three vertices.
            differ(x, y) && differ(y, z) && differ(z, x) && sides.into_iter().all(agrees)
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
        let mut boundary = Vec::with_capacity(self.vertex_count());
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
            boundary.push(if is_closed { NONE } else { at.to_u32() });
        }
        let target = |h: HalfEdgeId| roots[h.next().index()];
        let mut reached = root_of;
        reached.fill(NONE);
        let each_is_reached_once = orbits.into_iter().all(|h: HalfEdgeId| {
            let root = roots[h.index()];
            std::mem::replace(&mut reached[target(h) as usize], root) != root
        });
        // An edge from a root to itself is one of two, or of the boundary, and then its own opposite.
        // Two half-edges of the boundary between the same two roots are opposites without a link.
        let along = |root: u32| match boundary[root as usize] {
            NONE => None,
            h => Some(target(HalfEdgeId::from_u32(h))),
        };
        each_is_reached_once
            && (0..boundary.len() as u32).all(|root| along(root).and_then(along) != Some(root))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Link, Mesh};
    use crate::sets::DisjointSets;
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

    /// Up to four faces whose sides are glued at random, and labels that part what is glued in some places.
    fn glued(numbers: &mut Numbers) -> Mesh {
        let count = 3 * (1 + numbers.below(4));
        let mut link = vec![Link::BOUNDARY; count];
        let mut corners = DisjointSets::new(count as u32);
        let next = |h: usize| HalfEdgeId::from_u32(h as u32).next().to_u32();
        for _ in 0..numbers.below(2 * count) {
            let [h, g] = [(); 2].map(|()| numbers.below(count));
            if h != g && [h, g].map(|h| link[h]) == [Link::BOUNDARY; 2] {
                (link[h], link[g]) = (Link(g as u32), Link(h as u32));
                corners.join(h as u32, next(g));
                corners.join(g as u32, next(h));
            }
        }
        let labels = (0..count as u32).map(|h| match numbers.below(8) {
            0 => count as u32 + h,
            _ => corners.representative(h),
        });
        let origin: Vec<u32> = labels.collect();
        let ends = |h: usize| [h, next(h) as usize].map(|h| origin[h]);
        for (h, link) in link.iter_mut().enumerate() {
            let opposite = link.opposite().map(HalfEdgeId::index);
            if opposite.is_some_and(|g| ends(g) != [ends(h)[1], ends(h)[0]]) {
                link.0 |= Link::TORN;
            }
        }
        let outgoing = vec![super::NONE; 2 * count];
        let mut mesh = Mesh {
            origin,
            link,
            outgoing,
            slides: 0,
        };
        find_starts(&mut mesh);
        mesh
    }

    fn find_starts(mesh: &mut Mesh) {
        mesh.outgoing.fill(super::NONE);
        for (h, &v) in mesh.origin.iter().enumerate().rev() {
            mesh.outgoing[v as usize] = h as u32;
        }
    }

    /// How often a mesh is held well-formed, broken, and broken though nothing is found in it.
    type Counts = [u32; 3];

    fn judge(mesh: &Mesh, counts: &mut Counts) {
        let found = mesh.violations();
        let is_well_formed = mesh.is_well_formed();
        assert!(!is_well_formed || found.is_empty(), "{found:?} in {mesh:?}");
        counts[if is_well_formed {
            0
        } else {
            1 + usize::from(found.is_empty())
        }] += 1;
    }

    #[test]
    fn gluings_are_well_formed_where_no_invariant_is_broken() {
        let (mut numbers, mut counts) = (Numbers(2), Counts::default());
        for _ in 0..40_000 {
            judge(&glued(&mut numbers), &mut counts);
        }
        // Of some only the root complex is no manifold.
        let [yes, no, strict] = counts;
        assert!(yes > 5_000 && no > 20_000 && strict < 2_000, "{counts:?}");
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
        if numbers.below(4) == 0 {
            for v in mesh.vertices() {
                for face in mesh.faces_of(v).skip(1).collect::<Vec<_>>() {
                    split::vertex(&mut mesh, v, &[face], edits).expect("one stays");
                }
            }
        }
        mesh
    }

    #[test]
    fn edited_meshes_are_well_formed_where_none_is_broken() {
        let (mut numbers, mut counts) = (Numbers(1), Counts::default());
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
                    find_starts(&mut mesh);
                }
            }
            if mesh.link.iter().any(|link| {
                link.opposite()
                    .is_some_and(|g| g.index() >= mesh.link.len())
            }) {
                continue;
            }
            judge(&mesh, &mut counts);
        }
        let [yes, no, strict] = counts;
        assert!(yes > 2_000 && no > 30_000 && strict == 0, "{counts:?}");
    }
}

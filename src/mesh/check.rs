//! Every invariant of a mesh, checked by plain loops.
//!
//! The walkers are among what is judged here, so nothing is computed with them: truth comes from
//! loops over all corners, from sorting, and from union-find. Where `well_formed.rs` says yes, which
//! takes one to two times as long as a build, none of this runs; it finds the names of what is broken, in
//! four times as long. Tests and fuzz targets call [`Mesh::check`] after every operation; a program may
//! call it after a cut, as the command does.
//!
//! `invariants.md` says why each invariant holds and what may break it. Those that speak of
//! an operation rather than of a mesh (I14 to I17, I20 to I22) are properties in the tests.

use std::fmt;

use super::{Mesh, NO_HALF_EDGE};
use crate::id::{FaceId, HalfEdgeId, VertexId};
use crate::sets::DisjointSets;

/// An invariant of a mesh, numbered as in `src/mesh/invariants.md`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Invariant {
    /// I1: each face has three origins and three links, and the number of faces and vertices fits
    /// the id types.
    Sizes = 1,
    /// I2: every stored id is smaller than the number of elements of its kind.
    Range = 2,
    /// I3: the three vertices of a face are distinct.
    DistinctVertices = 3,
    /// I4: if half-edge a is linked to b, then b is linked to a, and the two belong to different faces.
    Involution = 4,
    /// I5: if the link from half-edge a to b is torn, then the link from b to a is torn.
    TornSymmetric = 5,
    /// I6: if half-edges a and b are paired, then a starts where b ends, and b starts where a ends.
    PairAgrees = 6,
    /// I7: if half-edges a and b are a ghost pair, they have different vertices at one end or both.
    TornDiffers = 7,
    /// I8: all corners of a vertex lie in one orbit of the rotation through pairs and ghost pairs,
    /// so they were once the corners of one vertex.
    OneRoot = 8,
    /// I9: [`Mesh::half_edge_of`] returns the smallest half-edge that starts at the vertex.
    Outgoing = 9,
    /// I10: [`Mesh::corners_of`] lists exactly the corners of the vertex, each once.
    Walk = 10,
    /// I11: at most one half-edge runs from a vertex a to a vertex b.
    DirectedEdgeOnce = 11,
    /// I12: if one half-edge runs from a to b and another from b to a, the two are paired.
    OppositesPaired = 12,
    /// I13: no two faces have the same three vertices.
    FacesDiffer = 13,
    /// I18: the boundary loops visit each half-edge without a pair exactly once, and each half-edge
    /// of a loop starts where the previous one ends.
    BoundaryLoops = 18,
    /// I19: [`Mesh::fans`] lists one corner of each set of corners of a vertex that pairs join.
    Fans = 19,
}

/// A broken invariant, and the place in the mesh where it is broken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The invariant that is broken.
    pub invariant: Invariant,
    /// A description of the state that violates the invariant, with ids.
    pub found: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "I{} ({:?}): {}",
            self.invariant as u8, self.invariant, self.found
        )
    }
}

impl Mesh {
    /// Checks every invariant and returns all violations. The result is empty for every mesh that
    /// this library can create.
    ///
    /// If table sizes or id ranges are wrong, nothing else is checked. If faces or links are wrong,
    /// the vertices and boundary loops are not checked. The walks around a vertex are checked for
    /// at most 32 of the vertices that were split from the same one. Linear where nothing is broken, or
    /// else O(n log n).
    #[must_use]
    pub fn check(&self) -> Vec<Violation> {
        let mut report = Report {
            mesh: self,
            violations: Vec::new(),
        };
        report.sizes_and_ranges();
        if report.violations.is_empty() && !self.is_well_formed() {
            report.violations = self.violations();
        }
        report.violations
    }

    /// What is wrong with a mesh whose sizes and ids are right, found invariant by invariant.
    pub(super) fn violations(&self) -> Vec<Violation> {
        let mut report = Report {
            mesh: self,
            violations: Vec::new(),
        };
        report.faces();
        report.links();
        if report.violations.is_empty() {
            report.directed_edges();
            report.vertices();
            report.boundary();
        }
        report.violations
    }
}

/// The most copies of a vertex that are walked around: those with the lowest ids.
const WALKS: u8 = 32;

struct Report<'m> {
    mesh: &'m Mesh,
    violations: Vec<Violation>,
}

impl Report<'_> {
    fn broken(&mut self, invariant: Invariant, found: String) {
        self.violations.push(Violation { invariant, found });
    }

    fn sizes_and_ranges(&mut self) {
        let Mesh {
            origin,
            link,
            outgoing,
            ..
        } = self.mesh;
        let (corners, vertices) = (origin.len(), outgoing.len());
        if corners % 3 != 0 || link.len() != corners || corners > 3 * Mesh::MAX_FACES {
            let found = format!("{corners} origins, {} links", link.len());
            self.broken(Invariant::Sizes, found);
        }
        if vertices > VertexId::LIMIT {
            self.broken(Invariant::Sizes, format!("{vertices} vertices"));
        }
        let mut beyond = |found: String| self.broken(Invariant::Range, found);
        for (h, &v) in origin.iter().enumerate() {
            if v as usize >= vertices {
                beyond(format!("h{h} starts at v{v} of {vertices}"));
            }
        }
        for (h, link) in link.iter().enumerate() {
            if let Some(g) = link.opposite().filter(|g| g.index() >= corners) {
                beyond(format!("h{h} is linked to {g} of {corners}"));
            }
        }
        for (v, &h) in outgoing.iter().enumerate() {
            if h != NO_HALF_EDGE && h as usize >= corners {
                beyond(format!("v{v} has the half-edge h{h} of {corners}"));
            }
        }
    }

    fn faces(&mut self) {
        let mesh = self.mesh;
        let mut sorted = |f: FaceId| {
            let mut vertices = mesh.face_vertices(f);
            vertices.sort_unstable();
            if vertices[0] == vertices[1] || vertices[1] == vertices[2] {
                let found = format!("{f} has the vertices {vertices:?}");
                self.broken(Invariant::DistinctVertices, found);
            }
            vertices
        };
        let mut faces: Vec<_> = mesh.faces().map(|f| (sorted(f), f)).collect();
        faces.sort_unstable();
        for two in faces.windows(2) {
            let [(vertices, f), (others, g)] = [two[0], two[1]];
            if vertices == others {
                let found = format!("{f} and {g} both have {vertices:?}");
                self.broken(Invariant::FacesDiffer, found);
            }
        }
    }

    fn links(&mut self) {
        let mesh = self.mesh;
        for h in mesh.half_edges() {
            let Some(g) = mesh.pair_or_ghost(h) else {
                continue;
            };
            if mesh.pair_or_ghost(g) != Some(h) || g.face() == h.face() {
                let found = format!("{h} leads to {g}, {g} to {:?}", mesh.pair_or_ghost(g));
                self.broken(Invariant::Involution, found);
                continue;
            }
            let torn = mesh.ghost_pair(h).is_some();
            if torn != mesh.ghost_pair(g).is_some() {
                let found = format!("of {h} and {g} only one is torn");
                self.broken(Invariant::TornSymmetric, found);
            }
            let ends = |h: HalfEdgeId| (mesh.origin(h), mesh.origin(h.next()));
            let (from, to) = ends(h);
            let agree = ends(g) == (to, from);
            if agree == torn {
                let (invariant, is) = if torn {
                    (Invariant::TornDiffers, "is torn")
                } else {
                    (Invariant::PairAgrees, "is a pair")
                };
                let found = format!("{h} ({from}-{to}) and {g} {:?} {is}", ends(g));
                self.broken(invariant, found);
            }
        }
    }

    fn directed_edges(&mut self) {
        let mesh = self.mesh;
        let ends = |h: HalfEdgeId| (mesh.origin(h), mesh.origin(h.next()));
        let mut directed: Vec<HalfEdgeId> = mesh.half_edges().collect();
        directed.sort_unstable_by_key(|&h| (ends(h), h));
        for two in directed.windows(2) {
            let [h, g] = [two[0], two[1]];
            if ends(h) == ends(g) {
                let (from, to) = ends(h);
                let found = format!("{h} and {g} both run from {from} to {to}");
                self.broken(Invariant::DirectedEdgeOnce, found);
            }
        }
        for h in mesh.half_edges() {
            let (from, to) = ends(h);
            let Ok(at) = directed.binary_search_by_key(&(to, from), |&g| ends(g)) else {
                continue;
            };
            let opposite = directed[at];
            if mesh.pair(h) != Some(opposite) {
                let found = format!("{h} and {opposite} join {from} and {to}, and are no pair");
                self.broken(Invariant::OppositesPaired, found);
            }
        }
    }

    fn vertices(&mut self) {
        let mesh = self.mesh;
        let mut by_vertex: Vec<HalfEdgeId> = mesh.half_edges().collect();
        by_vertex.sort_unstable_by_key(|&h| (mesh.origin(h), h));
        let mut rest = &by_vertex[..];
        let mut orbits = corner_sets(mesh, Mesh::pair_or_ghost);
        let mut fans = corner_sets(mesh, Mesh::pair);
        let (mut walked, mut fans_walked, mut truth) = (Vec::new(), Vec::new(), Vec::new());
        let mut walks = vec![0u8; mesh.half_edge_count()];
        for v in mesh.vertices() {
            let corners;
            (corners, rest) = rest.split_at(rest.partition_point(|&h| mesh.origin(h) == v));
            let first = corners.first().copied();
            if mesh.half_edge_of(v) != first {
                let is = mesh.half_edge_of(v);
                let found = format!("{v} has the half-edge {is:?} instead of {first:?}");
                self.broken(Invariant::Outgoing, found);
                continue;
            }
            let Some(first) = first else {
                continue;
            };
            let root = orbits.representative(first.to_u32());
            let is_foreign = |h: &&HalfEdgeId| orbits.representative(h.to_u32()) != root;
            if let Some(h) = corners.iter().find(is_foreign) {
                let found = format!("{v} has the corners {first} and {h} of two roots");
                self.broken(Invariant::OneRoot, found);
            }

            // Every copy of a vertex walks round all of them: some of many are enough, since by
            // I4 and I8 the others have the same way to go.
            let walks = &mut walks[root as usize];
            if *walks == WALKS {
                continue;
            }
            *walks += 1;

            // A walk that is broken might not end, so it is followed only so far.
            let bound = corners.len() + 1;
            walked.clear();
            walked.extend(mesh.corners_of(v).take(bound));
            walked.sort_unstable();
            if walked != corners {
                let found =
                    format!("the walk round {v} gives {walked:?}, its corners are {corners:?}");
                self.broken(Invariant::Walk, found);
            }

            truth.clear();
            truth.extend(corners.iter().map(|&h| fans.representative(h.to_u32())));
            truth.sort_unstable();
            truth.dedup();
            fans_walked.clear();
            fans_walked.extend(
                mesh.fans(v)
                    .take(bound)
                    .map(|h| fans.representative(h.to_u32())),
            );
            fans_walked.sort_unstable();
            if fans_walked != truth {
                let (count, counted) = (truth.len(), fans_walked.len());
                let found = format!("{v} has {count} fans, counted {counted}");
                self.broken(Invariant::Fans, found);
            }
        }
    }

    fn boundary(&mut self) {
        let mesh = self.mesh;
        let mut visits = vec![0u32; mesh.half_edge_count()];
        for start in mesh.boundary_loops() {
            let all: Vec<_> = mesh
                .boundary_loop(start)
                .take(mesh.half_edge_count() + 1)
                .collect();
            for (i, &h) in all.iter().enumerate() {
                visits[h.index()] += 1;
                let following = all[(i + 1) % all.len()];
                if mesh.origin(h.next()) != mesh.origin(following) {
                    let found = format!("{following} does not start where {h} ends");
                    self.broken(Invariant::BoundaryLoops, found);
                }
            }
        }
        for h in mesh.half_edges() {
            let expected = u32::from(mesh.pair(h).is_none());
            if visits[h.index()] != expected {
                let found = format!("{h} is visited {} times, not {expected}", visits[h.index()]);
                self.broken(Invariant::BoundaryLoops, found);
            }
        }
    }
}

/// The sets of corners that meet across the edges for which `across` gives the other side.
fn corner_sets(
    mesh: &Mesh,
    across: impl Fn(&Mesh, HalfEdgeId) -> Option<HalfEdgeId>,
) -> DisjointSets {
    let mut sets = DisjointSets::new(mesh.half_edge_count() as u32);
    for h in mesh.half_edges() {
        if let Some(g) = across(mesh, h) {
            sets.join(h.to_u32(), g.next().to_u32());
        }
    }
    sets
}

#[cfg(test)]
mod tests {
    use super::super::Link;
    use super::*;
    use crate::id::FaceId;
    use crate::split;
    use crate::{Edits, shapes};

    /// What is broken in an open fan of three faces round v0, whose middle face was torn off
    /// and has v5 instead, after `damage`.
    fn broken_by(damage: impl FnOnce(&mut Mesh)) -> Vec<Invariant> {
        let (mut mesh, _) = shapes::fan(3, false);
        let middle = [FaceId::from_u32(1)];
        split::vertex(&mut mesh, VertexId::from_u32(0), &middle, &mut Edits::new())
            .expect("two faces stay");
        assert_eq!(mesh.check(), []);
        damage(&mut mesh);
        let mut broken: Vec<_> = mesh.check().into_iter().map(|v| v.invariant).collect();
        broken.dedup();
        broken
    }

    /// Marks the link h2-h3 as a pair, although v0 is at one side only.
    fn sewn(mesh: &mut Mesh) {
        mesh.link[2].0 &= !Link::TORN;
        mesh.link[3].0 &= !Link::TORN;
    }

    /// No mesh breaks I18 alone: where pairs agree (I4, I6), the way along the boundary is right.
    #[test]
    fn a_boundary_that_goes_through_a_tear_is_broken() {
        let broken = broken_by(|mesh| {
            sewn(mesh);
            let violations = Vec::new();
            let mut report = Report { mesh, violations };
            report.boundary();
            let named = report.violations.iter().map(|one| one.invariant);
            assert!(named.eq([Invariant::BoundaryLoops]));
        });
        assert_eq!(broken, [Invariant::PairAgrees]);
    }

    #[test]
    fn every_broken_invariant_is_named() {
        use Invariant::{
            Involution, OneRoot, Outgoing, PairAgrees, Range, Sizes, TornDiffers, TornSymmetric,
        };
        type Damage = fn(&mut Mesh);
        // The mesh is f0 = 0 1 2, f1 = 5 2 3, f2 = 0 3 4; h2-h3 and h5-h6 are torn.
        let two_roots: Damage = |mesh| {
            // v4 becomes v1, on the other side of the fan.
            mesh.origin[8] = 1;
            mesh.outgoing[4] = NO_HALF_EDGE;
        };
        let cases: [(Invariant, Damage); 13] = [
            (Sizes, |mesh| mesh.link.truncate(8)),
            (Range, |mesh| mesh.origin[4] = 6),
            (Range, |mesh| mesh.link[1] = Link(9)),
            (Range, |mesh| mesh.outgoing[1] = 9),
            (Involution, |mesh| mesh.link[1] = Link(7)),
            (TornSymmetric, |mesh| mesh.link[2].0 &= !Link::TORN),
            (TornDiffers, |mesh| mesh.origin[3] = 0),
            (Outgoing, |mesh| mesh.outgoing[0] = 6),
            (Outgoing, |mesh| mesh.outgoing[5] = NO_HALF_EDGE),
            (Invariant::DistinctVertices, |mesh| mesh.origin[1] = 0),
            (OneRoot, two_roots),
            (Invariant::Fans, two_roots),
            (PairAgrees, sewn),
        ];
        for (i, (invariant, damage)) in cases.into_iter().enumerate() {
            let broken = broken_by(damage);
            assert!(broken.contains(&invariant), "case {i}: {broken:?}");
        }
    }

    #[test]
    fn a_mesh_that_forgot_its_links_is_broken_in_many_ways() {
        // Two faces that share the edge 1-2 lose their link: opposite edges are not paired, and
        // the walk from the first corner finds one of two.
        let mut mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]]).expect("a manifold");
        mesh.link.fill(Link::BOUNDARY);
        let broken: Vec<_> = mesh.check().into_iter().map(|v| v.invariant).collect();
        use Invariant::{OneRoot, OppositesPaired, Walk};
        for invariant in [OppositesPaired, OneRoot, Walk] {
            assert!(broken.contains(&invariant), "{invariant:?} in {broken:?}");
        }
    }

    #[test]
    fn faces_that_no_builder_lets_through_are_broken() {
        let loose = |triangles: [[u32; 3]; 2], vertices: usize| {
            let origin = triangles.as_flattened().to_vec();
            let smallest = |v: usize| origin.iter().position(|&at| at as usize == v);
            Mesh {
                outgoing: (0..vertices)
                    .map(|v| smallest(v).map_or(NO_HALF_EDGE, |h| h as u32))
                    .collect(),
                link: vec![Link::BOUNDARY; 6],
                origin,
                slides: 0,
            }
        };
        for (second, invariant) in [
            ([0, 1, 3], Invariant::DirectedEdgeOnce),
            ([1, 2, 0], Invariant::FacesDiffer),
            ([2, 1, 0], Invariant::FacesDiffer),
            ([0, 3, 4], Invariant::OneRoot),
        ] {
            let mesh = loose([[0, 1, 2], second], 5);
            let broken: Vec<_> = mesh.check().into_iter().map(|v| v.invariant).collect();
            assert!(broken.contains(&invariant), "{invariant:?} in {broken:?}");
        }
    }
}

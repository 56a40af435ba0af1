//! Every invariant of a mesh, checked by plain loops.
//!
//! The walkers are among what is judged here, so nothing is computed with them: truth comes
//! from loops over all corners, from sorting, and from union-find. O(n log n). Tests and
//! fuzz targets call [`Mesh::check`] after every operation; a program may call it after
//! a cut, as the command does.
//!
//! `invariants.md` says why each invariant holds and what may break it. Those that speak of
//! an operation rather than of a mesh (I14 to I17, I20 to I22) are properties in the tests.

use std::fmt;

use super::{Mesh, NO_HALF_EDGE};
use crate::id::{HalfEdgeId, VertexId};

/// An invariant of a mesh, numbered as in `src/mesh/invariants.md`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Invariant {
    /// I1: the sizes of the tables agree and fit the id types.
    Sizes = 1,
    /// I2: every id is in range.
    Range = 2,
    /// I3: a face has three distinct vertices.
    DistinctVertices = 3,
    /// I4: the link of half-edges is an involution between different faces.
    Involution = 4,
    /// I5: the torn mark is symmetric.
    TornSymmetric = 5,
    /// I6: both ends of a pair agree.
    PairAgrees = 6,
    /// I7: at least one end of a torn link differs.
    TornDiffers = 7,
    /// I8: all corners of a vertex were corners of one vertex of the input.
    OneRoot = 8,
    /// I9: the half-edge of a vertex is the smallest one that starts there.
    Outgoing = 9,
    /// I10: the walk round a vertex lists exactly its corners, each once.
    Walk = 10,
    /// I11: a directed edge occurs once.
    DirectedEdgeOnce = 11,
    /// I12: opposite directed edges are paired.
    OppositesPaired = 12,
    /// I13: no two faces have the same three vertices.
    FacesDiffer = 13,
    /// I18: the boundary loops visit each boundary half-edge once, end to end.
    BoundaryLoops = 18,
    /// I19: the fans of a vertex are those that union-find sees.
    Fans = 19,
}

/// A broken invariant, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// Which invariant is broken.
    pub invariant: Invariant,
    /// What was found, with ids.
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
    /// Checks every invariant and lists what is broken: nothing, for every mesh that can be
    /// made with this library.
    ///
    /// Where sizes or ranges are broken, the rest is not looked at. O(n log n).
    #[must_use]
    pub fn check(&self) -> Vec<Violation> {
        let mut report = Report {
            mesh: self,
            violations: Vec::new(),
        };
        report.sizes_and_ranges();
        if report.violations.is_empty() {
            report.faces();
            report.links();
        }
        if report.violations.is_empty() {
            report.directed_edges();
            report.vertices();
            report.boundary();
        }
        report.violations
    }
}

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
        } = self.mesh;
        let (corners, vertices) = (origin.len(), outgoing.len());
        if corners % 3 != 0 || link.len() != corners || corners > 3 * Mesh::MAX_FACES {
            let found = format!("{corners} origins, {} links", link.len());
            self.broken(Invariant::Sizes, found);
        }
        if vertices > VertexId::LIMIT {
            self.broken(Invariant::Sizes, format!("{vertices} vertices"));
        }
        for (h, &v) in origin.iter().enumerate() {
            if v as usize >= vertices {
                self.broken(
                    Invariant::Range,
                    format!("h{h} starts at v{v} of {vertices}"),
                );
            }
        }
        for (h, link) in link.iter().enumerate() {
            if let Some(g) = link.opposite().filter(|g| g.index() >= corners) {
                self.broken(
                    Invariant::Range,
                    format!("h{h} is linked to {g} of {corners}"),
                );
            }
        }
        for (v, &h) in outgoing.iter().enumerate() {
            if h != NO_HALF_EDGE && h as usize >= corners {
                self.broken(
                    Invariant::Range,
                    format!("v{v} has the half-edge h{h} of {corners}"),
                );
            }
        }
    }

    fn faces(&mut self) {
        let mut sorted: Vec<_> = self
            .mesh
            .faces()
            .map(|f| {
                let mut vertices = self.mesh.corners(f);
                vertices.sort();
                (vertices, f)
            })
            .collect();
        for (vertices, f) in &sorted {
            if vertices[0] == vertices[1] || vertices[1] == vertices[2] {
                let found = format!("{f} has the vertices {vertices:?}");
                self.broken(Invariant::DistinctVertices, found);
            }
        }
        sorted.sort();
        for two in sorted.windows(2) {
            if let [(a, f), (b, g)] = two
                && a == b
            {
                self.broken(
                    Invariant::FacesDiffer,
                    format!("{f} and {g} both have {a:?}"),
                );
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
                let back = mesh.pair_or_ghost(g);
                self.broken(
                    Invariant::Involution,
                    format!("{h} leads to {g}, {g} to {back:?}"),
                );
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
        let mut edges: Vec<_> = mesh
            .half_edges()
            .map(|h| (mesh.origin(h), mesh.origin(h.next()), h))
            .collect();
        edges.sort();
        for two in edges.windows(2) {
            if let [(a, b, h), (c, d, g)] = two
                && (a, b) == (c, d)
            {
                let found = format!("{h} and {g} both run from {a} to {b}");
                self.broken(Invariant::DirectedEdgeOnce, found);
            }
        }
        for &(from, to, h) in &edges {
            let opposite = edges.binary_search_by_key(&(to, from), |&(a, b, _)| (a, b));
            if let Ok(at) = opposite
                && mesh.pair(h) != Some(edges[at].2)
            {
                let found = format!(
                    "{h} and {} join {from} and {to}, and are no pair",
                    edges[at].2
                );
                self.broken(Invariant::OppositesPaired, found);
            }
        }
    }

    fn vertices(&mut self) {
        let mesh = self.mesh;
        let mut corners_of = vec![Vec::new(); mesh.vertex_count()];
        for h in mesh.half_edges() {
            corners_of[mesh.origin(h).index()].push(h);
        }
        let mut orbits = corner_sets(mesh, Mesh::pair_or_ghost);
        let mut fans = corner_sets(mesh, Mesh::pair);
        for v in mesh.vertices() {
            let corners = &corners_of[v.index()];
            if mesh.half_edge_of(v) != corners.first().copied() {
                let (is, should) = (mesh.half_edge_of(v), corners.first());
                let found = format!("{v} has the half-edge {is:?} instead of {should:?}");
                self.broken(Invariant::Outgoing, found);
                continue;
            }
            if let Some(h) = corners
                .iter()
                .find(|h| orbits.leader(h.index()) != orbits.leader(corners[0].index()))
            {
                let found = format!("{v} has the corners {} and {h} of two roots", corners[0]);
                self.broken(Invariant::OneRoot, found);
            }
            let bound = mesh.half_edge_count() + 1;
            let mut walked: Vec<_> = mesh.corners_of(v).take(bound).collect();
            walked.sort();
            if walked != *corners {
                let found =
                    format!("the walk round {v} gives {walked:?}, its corners are {corners:?}");
                self.broken(Invariant::Walk, found);
            }
            let sets = |corners: &mut dyn Iterator<Item = HalfEdgeId>, fans: &mut Sets| {
                let mut leaders: Vec<_> = corners.map(|h| fans.leader(h.index())).collect();
                leaders.sort_unstable();
                leaders
            };
            let mut truth = sets(&mut corners.iter().copied(), &mut fans);
            truth.dedup();
            let counted = sets(&mut mesh.fans(v).take(bound), &mut fans);
            if counted != truth {
                let found = format!("{v} has {} fans, counted {}", truth.len(), counted.len());
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
fn corner_sets(mesh: &Mesh, across: impl Fn(&Mesh, HalfEdgeId) -> Option<HalfEdgeId>) -> Sets {
    let mut sets = Sets {
        parent: (0..mesh.half_edge_count()).collect(),
    };
    for h in mesh.half_edges() {
        if let Some(g) = across(mesh, h) {
            sets.join(h.index(), g.next().index());
        }
    }
    sets
}

/// Union-find with path halving.
struct Sets {
    parent: Vec<usize>,
}

impl Sets {
    fn leader(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.leader(a), self.leader(b));
        self.parent[a.max(b)] = a.min(b);
    }
}

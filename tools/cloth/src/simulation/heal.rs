//! Healing: both sides of a tear are drawn together, and sewn pair by pair where they meet.
//!
//! Sewing at once over sides that hang apart would stretch edges to several times their length, and
//! tear them anew (531 vertices in one trial). So the copies of each vertex move toward each other,
//! at a steady speed: one that falls with the gap comes to a halt under weight, an edge length
//! before the end. Of a pair the lighter moves more, so that its momentum stays; one that is held
//! does not move. Where the cloth is pulled so hard that it would soon tear elsewhere, a pair waits.

use std::collections::BTreeSet;

use tearmesh::geometry::length;
use tearmesh::{Edit, HalfEdgeId, Mesh, VertexId};

use super::hand::Hands;
use super::report::CutId;
use crate::cloth::Cloth;
use crate::cloth::held_set::now;
use crate::cloth::tearing::Threshold;
use crate::system::System;

/// The wounds that are to heal: see [`Simulation::heal`](super::Simulation::heal).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Wounds {
    /// All tears and cuts.
    All,
    /// What a cut tore, and nothing that tore beside it.
    Cut(CutId),
}

/// The speed at which copies are drawn together, in m/s.
pub(super) const SPEED_M_PER_S: f64 = 1.5;

/// A pair that needs this much longer than its way takes at the steady speed is left, in seconds.
const PATIENCE_S: f64 = 5.0;

/// A pair waits while an edge at it bears this part of what it takes to tear it.
const LOAD_MAX: f64 = 0.5;

/// For so long before it is left a pair is not drawn any more, in seconds: what was pulled while it
/// could not tear comes to rest first.
const REST_S: f64 = 0.5;

/// Two copies of a vertex that are drawn together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    ends: [VertexId; 2],
    /// How far they may be apart at the end of the step, in metres.
    gap_m: f64,
    /// Whether the cloth around them is pulled too hard to draw them nearer.
    waits: bool,
    /// The simulated time at which it is left, in seconds.
    until_s: f64,
}

/// The pairs that are still open.
#[derive(Clone, Debug, Default)]
pub(super) struct Healing {
    pub(super) open: Vec<Pair>,
    /// How many were sewn, and left, since no pair was open.
    pub(super) sewn: usize,
    pub(super) left: usize,
}

impl Healing {
    /// Opens the pairs on both sides of torn links, but for those that are open already; how many.
    pub(super) fn begin(
        &mut self,
        links: impl Iterator<Item = HalfEdgeId>,
        mesh: &Mesh,
        system: &System,
    ) -> usize {
        let mut pairs: Vec<_> = links.flat_map(|h| apart(mesh, h)).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs.retain(|pair| self.open.iter().all(|open| open.ends != *pair));
        for ends in &pairs {
            let [a, b] = ends.map(|v| system.positions()[v.index()]);
            let gap_m = length(b - a);
            self.open.push(Pair {
                ends: *ends,
                gap_m,
                waits: false,
                until_s: system.elapsed_s() + gap_m / SPEED_M_PER_S + PATIENCE_S,
            });
        }
        pairs.len()
    }

    /// An open pair whose copies have met. One of a hand and another that is held do not.
    pub(super) fn met(&self, system: &System, hands: &Hands) -> Option<[VertexId; 2]> {
        let may_join = |ends: [VertexId; 2]| {
            let [one, other] = ends.map(|v| hands.of(v));
            one == other || !ends.iter().all(|v| system.is_held(v.index()))
        };
        let meets = |pair: &&Pair| pair.gap_m == 0.0 && may_join(pair.ends);
        Some(self.open.iter().find(meets)?.ends)
    }

    /// Leaves the pairs whose time is over; whether there were any.
    pub(super) fn leave(&mut self, now_s: f64) -> bool {
        let before = self.open.len();
        self.open.retain(|pair| pair.until_s > now_s);
        self.left += before - self.open.len();
        before > self.open.len()
    }

    /// Moves the copies of each pair nearer to each other by the way of a step, and has them go on
    /// so. A pair waits, and gives way, while the cloth around it is pulled too hard.
    pub(super) fn draw(
        &mut self,
        mesh: &Mesh,
        cloth: &mut Cloth,
        threshold: Threshold,
        step_s: f64,
    ) {
        let now_s = cloth.system().elapsed_s();
        // First all loads, since moving anything makes a system forget forces.
        for pair in &mut self.open {
            let corners = pair.ends.into_iter().flat_map(|v| mesh.corners_of(v));
            let mut edges = corners.flat_map(|h| [h, h.prev()]);
            let load = |h| threshold.edge_load(mesh, cloth, h);
            pair.waits = now_s > pair.until_s - REST_S
                || edges.any(|h| load(h).is_some_and(|load| load > LOAD_MAX));
        }
        let system = cloth.system_mut();
        for pair in &mut self.open {
            let [a, b] = pair.ends.map(VertexId::index);
            let inverse = [a, b].map(|particle| system.inverse_masses()[particle]);
            let x = system.positions();
            let (way, sum) = (x[b] - x[a], inverse[0] + inverse[1]);
            let gap_m = length(way);
            if pair.waits || sum == 0.0 || gap_m == 0.0 {
                pair.gap_m = gap_m;
                continue;
            }
            pair.gap_m = (pair.gap_m.min(gap_m) - SPEED_M_PER_S * step_s).max(0.0);
            let (x, v) = system.state_mut();
            let closer = way * (1.0 - pair.gap_m / gap_m);
            let faster = way * (SPEED_M_PER_S / gap_m) + (v[b] - v[a]);
            for (end, share) in [(a, inverse[0] / sum), (b, -inverse[1] / sum)] {
                x[end] += closer * share;
                v[end] += faster * share;
            }
        }
    }

    /// Ends the sewing of the pairs on both sides of these links.
    pub(super) fn end(&mut self, links: &[HalfEdgeId], mesh: &Mesh) {
        let ended: BTreeSet<_> = links.iter().flat_map(|&h| apart(mesh, h)).collect();
        self.open.retain(|pair| !ended.contains(&pair.ends));
    }

    /// The vertices within two rings of an open pair, which do not tear.
    pub(super) fn guarded(&self, mesh: &Mesh) -> BTreeSet<VertexId> {
        let mut guarded: BTreeSet<_> = self.open.iter().flat_map(|pair| pair.ends).collect();
        for _ in 0..2 {
            let corners = guarded.iter().flat_map(|&v| mesh.corners_of(v));
            let ring = corners.flat_map(|h| [mesh.target(h), mesh.origin(h.prev())]);
            let ring: Vec<_> = ring.collect();
            guarded.extend(ring);
        }
        guarded
    }

    pub(super) fn follow(&mut self, edit: &Edit<'_>) {
        if let Edit::Merge(merge) = edit {
            for pair in &mut self.open {
                pair.ends = sorted(pair.ends.map(|v| now(v, merge)));
            }
            self.open.retain(|pair| pair.ends[0] != pair.ends[1]);
        }
    }
}

/// The vertices at both ends of a torn link that are not yet one, as seen from one of its half-edges; none
/// for an edge that is whole.
fn apart(mesh: &Mesh, h: HalfEdgeId) -> impl Iterator<Item = [VertexId; 2]> + use<> {
    let sides = mesh.ghost_pair(h).map(|ghost| {
        let [from, to] = [h, ghost].map(|h| [mesh.origin(h), mesh.target(h)]);
        [sorted([from[0], to[1]]), sorted([from[1], to[0]])]
    });
    let ends = sides.into_iter().flatten();
    ends.filter(|[one, other]| one != other)
}

fn sorted([one, other]: [VertexId; 2]) -> [VertexId; 2] {
    [one.min(other), one.max(other)]
}

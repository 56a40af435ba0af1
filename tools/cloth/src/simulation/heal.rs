//! Healing: both sides of a tear are drawn together, and sewn pair by pair where they meet.
//!
//! Sewing at once over sides that hang apart would stretch edges to several times their length, and
//! tear them anew (531 vertices in one trial). So the copies of each vertex are [drawn](crate::system::drawn) together,
//! at a steady speed: one that falls with the gap comes to a halt under weight, an edge length
//! before the end. Where the cloth is pulled so hard that it would soon tear elsewhere, a pair waits. Where a body is in the
//! way, a pair is drawn ever more slowly, so that it presses no harder than it has to.
//!
//! What heals is a property of torn links, each end by itself: a half-edge that [heals](Healing::heals) has its origin
//! drawn to the other copy of it, whatever vertices these are after a cut or a tear. So the pairs are found anew after
//! each edit.

use std::collections::BTreeSet;

use tearmesh::geometry::{Vector, dot, length};
use tearmesh::{Edit, HalfEdgeId, Mesh, VertexId};

use super::hand::Hands;
use super::report::{CutId, PairTally};
use super::seams::divided;
use crate::cloth::Cloth;
use crate::cloth::held_set::now;
use crate::cloth::tearing::Threshold;
use crate::method::solver::Abilities;
use crate::system::System;
use crate::system::drawn::Drawn;

/// The wounds that are to heal: see [`Simulation::heal`](super::Simulation::heal).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Wounds<'a> {
    /// All tears, cuts and open seams.
    All,
    /// What a cut tore, and nothing that tore beside it.
    Cut(CutId),
    /// The seams of this name, as far as they are open.
    Seam(&'a str),
}

/// The speed at which copies are drawn together, in m/s.
pub(super) const SPEED_M_PER_S: f64 = 1.5;

/// What is sewn from the beginning takes no longer than this, in seconds: panels that hang round a body would
/// else fall past its shoulders.
const BEGINNING_S: f64 = 0.05;

/// The most that is added to the speed against what pulls copies apart, in m/s.
const MORE_MAX_M_PER_S: f64 = 15.0;

/// Copies that a body touches are kept apart by it where they come nearer by less than this part of what they should: else they
/// slide over it, as the sides of a shoulder seam do.
const STALLED: f64 = 0.1;

/// What touches a body is drawn at no more than this part of its steady speed and so many times what it came in the last
/// step, so that it slides on where it can, and one that is stopped is not pushed at full speed in each step.
const LEANS: f64 = 0.2;
const SLIDES: f64 = 8.0;

/// The part of a step that counts in the next one, since cloth that is pulled taut round a body trembles.
const REMEMBERED: f64 = 0.9;

/// The speed of a pair that is no longer kept apart doubles in this time, in seconds.
const RECOVERS_S: f64 = 0.004;

/// The speed at which those are drawn that a body keeps apart, in m/s: the energy of a push at it is a millionth.
const SLOWEST_M_PER_S: f64 = 1.5e-3;

/// Copies meet that are as near as this part of the shortest edge at either.
const MEETS: f64 = 0.05;

/// The way of a step is at most this part of that edge: by explicit methods, since a short edge would fling what is behind it; by
/// implicit ones, which take more than a step to move that; and by those that project, which take a stretched edge for
/// a blow-up at a hundred times its length.
const WAYS_MAX: [f64; 3] = [0.25, 1.0, 20.0];

/// A pair that needs this much longer than its way takes at the steady speed is left, in seconds.
const PATIENCE_S: f64 = 5.0;

/// A pair waits while an edge at it bears this part of what it takes to tear it, and is slower the nearer one is to that.
const LOAD_MAX: f64 = 0.5;

/// For so long before it is left a pair is not drawn any more, in seconds: what was pulled while it
/// could not tear comes to rest first.
const REST_S: f64 = 0.5;

/// Two copies of a vertex that are drawn together.
#[derive(Clone, Copy, Debug)]
struct Pair {
    ends: [VertexId; 2],
    /// Their speed where nothing keeps them apart: half of it after each time that something did.
    steady_m_per_s: f64,
    speed_m_per_s: f64,
    /// What is added to it against what pulls them apart.
    more_m_per_s: f64,
    /// How far they were to come in the last steps, and how far they came.
    lately_m: [f64; 2],
    /// Whether a body keeps them apart.
    is_kept_apart: bool,
    /// The way from one to the other after the last step, in metres.
    way: Vector,
    /// Whether the cloth around them is pulled too hard to draw them nearer, or comes to rest.
    waits: bool,
    /// The part of its speed that the cloth around them leaves it: none where it waits.
    ease: f64,
    /// Whether they are near enough to be one.
    has_met: bool,
    /// The simulated time at which it is left, in seconds.
    until_s: f64,
}

impl Pair {
    /// Takes in what the way became in a step, and adapts the speed for the next one: what a body keeps apart is
    /// drawn half as fast, and all else as much faster as is missing.
    fn went(&mut self, way: Vector, touches: bool, most_m_per_s: f64, step_s: f64) {
        let before_m = self.gap_m();
        let drawn_m_per_s = if self.waits {
            0.0
        } else {
            self.ease * self.speed_m_per_s
        };
        let wanted_m = before_m.min(drawn_m_per_s * step_s);
        // Past each other is too much.
        let came_m = dot(self.way - way, self.way) / before_m.max(f64::MIN_POSITIVE);
        let missing_m = wanted_m - came_m;
        self.way = way;
        let [wanted_before_m, came_before_m] = self.lately_m.map(|m| REMEMBERED * m);
        self.lately_m = [wanted_before_m + wanted_m, came_before_m + came_m];
        let is_stalled = self.lately_m[1] < STALLED * self.lately_m[0];
        let was_kept_apart = self.is_kept_apart;
        self.is_kept_apart = is_stalled && (touches || was_kept_apart);
        if self.is_kept_apart && !was_kept_apart {
            // Else cloth that is taut round a body is tugged to and fro.
            self.steady_m_per_s = (0.5 * self.steady_m_per_s).max(SLOWEST_M_PER_S);
        }
        self.speed_m_per_s = if self.is_kept_apart {
            (0.5 * self.speed_m_per_s).max(SLOWEST_M_PER_S)
        } else {
            let faster_m_per_s = self.speed_m_per_s * (1.0 + step_s / RECOVERS_S);
            let slides_m_per_s = match touches {
                true => LEANS * self.steady_m_per_s + SLIDES * (came_m / step_s).max(0.0),
                false => f64::INFINITY,
            };
            let most_m_per_s = most_m_per_s.min(slides_m_per_s);
            faster_m_per_s.min(self.steady_m_per_s).min(most_m_per_s)
        };
        let most_m_per_s = (most_m_per_s - self.speed_m_per_s).clamp(0.0, MORE_MAX_M_PER_S);
        self.more_m_per_s = match (touches || self.is_kept_apart, self.waits) {
            (true, _) => 0.0,
            (false, true) => self.more_m_per_s,
            _ => (self.more_m_per_s + 0.5 * missing_m / step_s).clamp(0.0, most_m_per_s),
        };
    }

    fn gap_m(&self) -> f64 {
        length(self.way)
    }
}

/// How many pairs came to which end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Ends {
    pub(crate) sewn: usize,
    pub(crate) left: usize,
    pub(crate) ended: usize,
}

impl Ends {
    fn and(self, more: Ends) -> Ends {
        Ends {
            sewn: self.sewn + more.sewn,
            left: self.left + more.left,
            ended: self.ended + more.ended,
        }
    }
}

/// The pairs that are still open.
#[derive(Clone, Debug, Default)]
pub(super) struct Healing {
    /// The half-edges of torn links whose origin is to meet its other copy.
    heals: BTreeSet<HalfEdgeId>,
    open: Vec<Pair>,
    /// What became of those that were open, since none was, and of all before.
    ends: Ends,
    before: Ends,
    /// How many vertices were split by unpicking.
    pub(super) unpicked: usize,
    /// Whether strengths and holds are those of before pairs came or went.
    pub(super) has_changed: bool,
}

impl Healing {
    pub(super) fn open(&self) -> usize {
        self.open.len()
    }

    /// What became of the pairs that were open, of which there is none any more.
    pub(super) fn over(&mut self) -> Ends {
        let ends = std::mem::take(&mut self.ends);
        self.before = self.before.and(ends);
        ends
    }

    pub(super) fn tally(&self) -> PairTally {
        let ends = self.before.and(self.ends);
        PairTally {
            opened: ends.sewn + ends.left + ends.ended + self.open.len(),
            sewn: ends.sewn,
            left: ends.left,
            unpicked: ends.ended + self.unpicked,
            open: self.open.len(),
        }
    }

    /// Has the ends of torn links heal; how many pairs that opens.
    pub(super) fn begin(&mut self, links: &[HalfEdgeId], mesh: &Mesh, system: &System) -> usize {
        let before = self.open.len();
        self.heals.extend(links);
        self.renew(mesh, system);
        self.open.len() - before
    }

    /// Ends the healing of these links, and of the other sides of them.
    pub(super) fn end(&mut self, links: &[HalfEdgeId], mesh: &Mesh, system: &System) -> usize {
        let before = self.open.len();
        for h in links {
            self.heals.remove(h);
            mesh.ghost_pair(*h).map(|ghost| self.heals.remove(&ghost));
        }
        self.renew(mesh, system);
        before - self.open.len()
    }

    /// Finds the pairs anew: those that were open go on.
    pub(super) fn renew(&mut self, mesh: &Mesh, system: &System) {
        self.heals.retain(|&h| apart(mesh, h).is_some());
        let found = self.heals.iter().filter_map(|&h| apart(mesh, h));
        let mut found: BTreeSet<[VertexId; 2]> = found.collect();
        let before = self.open.len();
        self.open.retain(|pair| found.remove(&pair.ends));
        // What an edit makes others of has not ended.
        let gone = before - self.open.len();
        self.ends.ended += gone.saturating_sub(found.len());
        self.has_changed |= gone + found.len() > 0;
        for ends in found {
            let way = way(system, ends);
            let gap_m = length(way);
            let steady_m_per_s = match system.elapsed_s() {
                0.0 => SPEED_M_PER_S.max(gap_m / BEGINNING_S),
                _ => SPEED_M_PER_S,
            };
            self.open.push(Pair {
                ends,
                steady_m_per_s,
                speed_m_per_s: steady_m_per_s,
                more_m_per_s: 0.0,
                lately_m: [0.0; 2],
                is_kept_apart: false,
                way,
                waits: false,
                ease: 1.0,
                has_met: gap_m == 0.0,
                until_s: system.elapsed_s() + gap_m / steady_m_per_s + PATIENCE_S,
            });
        }
    }

    /// An open pair whose copies have met. One of a hand and another that is held do not.
    pub(super) fn met(&self, system: &System, hands: &Hands) -> Option<[VertexId; 2]> {
        let may_join = |ends: [VertexId; 2]| {
            let [one, other] = ends.map(|v| hands.of(v));
            one == other || !ends.iter().all(|v| system.is_held(v.index()))
        };
        let meets = |pair: &&Pair| pair.has_met && may_join(pair.ends);
        Some(self.open.iter().find(meets)?.ends)
    }

    /// Leaves the pairs that have waited too long.
    pub(super) fn leave(&mut self, mesh: &Mesh, now_s: f64) {
        self.leave_where(mesh, |pair| pair.until_s <= now_s);
    }

    /// Leaves the pairs of which one end is at one of these vertices, or beside one, or all if there are none; how many.
    pub(super) fn leave_at(&mut self, mesh: &Mesh, vertices: &[VertexId]) -> usize {
        let corners = vertices.iter().flat_map(|&v| mesh.corners_of(v));
        let around = corners.flat_map(|h| h.face().half_edges());
        let around: BTreeSet<VertexId> = around.map(|h| mesh.origin(h)).collect();
        let is_at = |pair: &Pair| pair.ends.iter().any(|v| around.contains(v));
        self.leave_where(mesh, |pair| vertices.is_empty() || is_at(pair))
    }

    fn leave_where(&mut self, mesh: &Mesh, is_left: impl Fn(&Pair) -> bool) -> usize {
        let left = self.open.iter().filter(|pair| is_left(pair));
        let left: BTreeSet<[VertexId; 2]> = left.map(|pair| pair.ends).collect();
        if left.is_empty() {
            return 0;
        }
        self.open.retain(|pair| !left.contains(&pair.ends));
        let stays = |&h: &HalfEdgeId| apart(mesh, h).is_none_or(|ends| !left.contains(&ends));
        self.heals.retain(stays);
        self.ends.left += left.len();
        self.has_changed = true;
        left.len()
    }

    /// Has the next step draw the pairs that do not wait.
    pub(super) fn draw(&self, system: &mut System) {
        let drawn = self.open.iter().filter(|pair| !pair.waits);
        let drawn = drawn.map(|pair| Drawn {
            ends: pair.ends.map(|v| v.index() as u32),
            speed_m_per_s: pair.speed_m_per_s * pair.ease,
            more_m_per_s: pair.more_m_per_s * pair.ease,
        });
        system.model.drawn.clear();
        system.model.drawn.extend(drawn);
    }

    /// Sees after a step which pairs have met, which wait, and which a body keeps apart.
    pub(super) fn look(
        &mut self,
        (mesh, cloth): (&Mesh, &Cloth),
        threshold: Threshold,
        step_s: f64,
        abilities: Abilities,
    ) {
        let [explicit, implicit, projecting] = WAYS_MAX;
        let way_max = match abilities.takes_all_forces {
            true if abilities.frequency_limit.is_some() => explicit,
            true => implicit,
            false => projecting,
        };
        let system = cloth.system();
        let now_s = system.elapsed_s();
        let touching = system.touching();
        for pair in &mut self.open {
            let corners = pair.ends.into_iter().flat_map(|v| mesh.corners_of(v));
            let edges = corners.flat_map(|h| [h, h.prev()]);
            let (mut load, mut shortest_m) = (0.0_f64, f64::INFINITY);
            for h in edges {
                load = load.max(threshold.edge_load(mesh, cloth, h).unwrap_or(0.0));
                let stretch = system.stretches().get(cloth.stretch(h));
                shortest_m = shortest_m.min(stretch.rest_length_m);
            }
            let way = way(system, pair.ends);
            let touches = pair.ends.iter().any(|v| touching.contains(&v.index()));
            let most_m_per_s = way_max * shortest_m / step_s;
            pair.went(way, touches, most_m_per_s, step_s);
            pair.waits = now_s > pair.until_s - REST_S || load > LOAD_MAX;
            pair.ease = (1.0 - load / LOAD_MAX).max(0.0);
            pair.has_met = pair.gap_m() <= MEETS * shortest_m;
        }
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

    /// Follows an edit, before [`renew`](Healing::renew).
    pub(super) fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Insert(insert) => divided(insert, |parent, children| {
                let healed = parent.map(|h| self.heals.remove(&h));
                let heals = |on: Option<usize>| on.is_some_and(|side| healed[side]);
                let pieces = children.iter().filter(|(_, on)| heals(*on));
                self.heals.extend(pieces.map(|(h, _)| *h));
            }),
            Edit::Merge(merge) => {
                for pair in &mut self.open {
                    let ends = pair.ends.map(|v| now(v, merge));
                    if ends[0] > ends[1] {
                        pair.way = -pair.way;
                    }
                    pair.ends = sorted(ends);
                }
                let before = self.open.len();
                self.open.retain(|pair| pair.ends[0] != pair.ends[1]);
                self.ends.sewn += before - self.open.len();
                self.has_changed = true;
            }
            _ => {}
        }
    }
}

/// The origin of a half-edge of a torn link and its other copy, unless they are one.
fn apart(mesh: &Mesh, h: HalfEdgeId) -> Option<[VertexId; 2]> {
    let other = mesh.target(mesh.ghost_pair(h)?);
    let ends = sorted([mesh.origin(h), other]);
    (ends[0] != ends[1]).then_some(ends)
}

fn way(system: &System, ends: [VertexId; 2]) -> Vector {
    let [a, b] = ends.map(|v| system.positions()[v.index()]);
    b - a
}

fn sorted([one, other]: [VertexId; 2]) -> [VertexId; 2] {
    [one.min(other), one.max(other)]
}

//! Hands that hold a vertex of a cloth, lead it about, and grip the cloth around it.
//!
//! Two things a hand needs were found by trying without. By the rule of the paper (Souza et al.
//! 2014 §III-A) a single vertex that is pulled tears out with the two cells around it, and the hand
//! holds a crumb; so the cloth within the grip is stronger, the nearer the stronger, as the tension
//! around a point that is pulled grows with 1/distance. And a hand that jumps where a pointer jumps
//! stretches edges in no time, and tears them falsely; so it has a largest speed.

use std::collections::{BTreeMap, BTreeSet};

use tearmesh::geometry::{Point, length};
use tearmesh::{Edit, HalfEdgeId, Mesh, VertexId};

use crate::cloth::held_set::HeldSet;
use crate::method::FRAME_S;
use crate::system::path::Path;

/// The id of a hand of a [`Simulation`](super::Simulation). No two hands of a simulation have the same, at
/// whatever times they hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct HandId(pub(super) u32);

/// The strength of the cloth at the radius of a grip, as a multiple of its own.
const GRIP_STRENGTH: f64 = 8.0;

/// The strength of a grip stops growing at this fraction of its radius, so that it is finite.
const GRIP_CORE: f64 = 1.0 / 16.0;

/// The largest speed of a hand, in m/s.
const SPEED_MAX_M_PER_S: f64 = 3.0;

/// A hand, the vertex that it grabbed, and the copies of that. No edge joins two of these, so nothing is inserted
/// between them.
#[derive(Clone, Debug)]
pub(super) struct Hand {
    pub(super) id: HandId,
    pub(super) set: HeldSet,
    radius_m: f64,
}

/// The hands that hold now.
#[derive(Clone, Debug, Default)]
pub(super) struct Hands {
    hands: Vec<Hand>,
    next: u32,
}

impl Hands {
    /// A new hand that grips around a vertex.
    pub(super) fn grab(&mut self, v: VertexId, radius_m: f64) -> HandId {
        let id = HandId(self.next);
        self.next += 1;
        self.hands.push(Hand {
            id,
            set: HeldSet::new(vec![v]),
            radius_m,
        });
        id
    }

    pub(super) fn get(&self, id: HandId) -> Option<&Hand> {
        self.hands.iter().find(|hand| hand.id == id)
    }

    pub(super) fn remove(&mut self, id: HandId) -> Option<Hand> {
        let place = self.hands.iter().position(|hand| hand.id == id)?;
        Some(self.hands.remove(place))
    }

    /// The hand that has a vertex.
    pub(super) fn of(&self, v: VertexId) -> Option<HandId> {
        let has = |hand: &&Hand| hand.set.contains(v);
        self.hands.iter().find(has).map(|hand| hand.id)
    }

    /// The vertices that are gripped, and how many times as strong as by itself the cloth is there.
    pub(super) fn grips(&self, mesh: &Mesh, rest: &[Point]) -> BTreeMap<VertexId, f64> {
        let length_m = |h: HalfEdgeId| length(rest[h.next().index()] - rest[h.index()]);
        let mut grips = BTreeMap::new();
        for hand in &self.hands {
            for (v, grip) in gripped(mesh, length_m, hand.set.vertices(), hand.radius_m) {
                let most = grips.entry(v).or_insert(1.0_f64);
                *most = most.max(grip);
            }
        }
        grips
    }

    pub(super) fn follow(&mut self, edit: &Edit<'_>) {
        let sets = self.hands.iter_mut().map(|hand| &mut hand.set);
        sets.for_each(|set| set.follow(edit, true));
    }
}

/// The vertices within this radius of some, and how many times as strong the cloth is there, the nearer the stronger. The
/// distance is that of the shortest way over the mesh, by the lengths of the edges at rest: two panels may rest in one
/// place. On a flat mesh it is exact.
pub(crate) fn gripped(
    mesh: &Mesh,
    length_m: impl Fn(HalfEdgeId) -> f64,
    from: &[VertexId],
    radius_m: f64,
) -> Vec<(VertexId, f64)> {
    // Lengths are not negative, so their bits ascend as they do.
    let mut next: BTreeSet<(u64, VertexId)> = from.iter().map(|v| (0, *v)).collect();
    let mut nearest: BTreeMap<VertexId, f64> = from.iter().map(|v| (*v, 0.0)).collect();
    while let Some((_, v)) = next.pop_first() {
        for corner in mesh.corners_of(v) {
            let sides = [corner, corner.next(), corner.prev()];
            let [to_one, across, to_other] = sides.map(&length_m);
            let [one, other] = [corner, corner.next()].map(|h| mesh.target(h));
            for (to, sides, beside) in [
                (one, [to_one, across, to_other], other),
                (other, [to_other, across, to_one], one),
            ] {
                let known = |v| nearest.get(&v).copied();
                let along_m = known(v).map(|at_m| at_m + sides[0]);
                let over_m = known(v).zip(known(beside));
                let over_m = over_m.and_then(|distances| over(distances.into(), sides));
                let nearer_m = [along_m, over_m].into_iter().flatten();
                let nearer_m = nearer_m.fold(f64::INFINITY, f64::min);
                let is_nearer = known(to).is_none_or(|known_m| nearer_m < known_m);
                if is_nearer && nearer_m <= radius_m {
                    nearest.insert(to, nearer_m);
                    next.insert((nearer_m.to_bits(), to));
                }
            }
        }
    }
    let grip = |distance_m: f64| GRIP_STRENGTH * (radius_m / distance_m.max(radius_m * GRIP_CORE));
    let gripped = nearest.into_iter().filter(|_| radius_m > 0.0);
    gripped
        .map(|(v, distance_m)| (v, grip(distance_m)))
        .collect()
}

/// The distance of a corner of a triangle from a place that is so far from its other two corners, straight over the side
/// between these; none if the straight way does not cross that side. The sides are those from the first of the two to
/// the corner, from there to the second, and between the two.
fn over([first_m, second_m]: [f64; 2], [to_m, from_m, between_m]: [f64; 3]) -> Option<f64> {
    // In the plane of the triangle, with the side between the two on the first axis.
    let flat = |one: f64, other: f64| {
        let x = (one * one - other * other + between_m * between_m) / (2.0 * between_m);
        (x, (one * one - x * x).max(0.0).sqrt())
    };
    let ((x, y), (place_x, place_y)) = (flat(to_m, from_m), flat(first_m, second_m));
    let crossing = place_x + (x - place_x) * place_y / (place_y + y);
    let is_over = (0.0..=between_m).contains(&crossing);
    is_over.then(|| (x - place_x).hypot(y + place_y))
}

/// The path of a hand to a point that was given now: it takes the time of a frame, as a pointer is
/// read once a frame, or longer where the hand would be too fast.
pub(super) fn path(from: Point, to: Point, now_s: f64) -> Path {
    let took_s = (length(to - from) / SPEED_MAX_M_PER_S).max(FRAME_S);
    Path::through(vec![(now_s, from), (now_s + took_s, to)])
}

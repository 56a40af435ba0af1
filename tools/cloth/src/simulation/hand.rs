//! Hands that hold a vertex of a cloth, lead it about, and grip the cloth around it.
//!
//! Two things a hand needs were found by trying without. By the rule of the paper (Souza et al.
//! 2014 §III-A) a single vertex that is pulled tears out with the two cells around it, and the hand
//! holds a crumb; so the cloth within the grip is stronger, the nearer the stronger, as the tension
//! around a point that is pulled grows with 1/distance. And a hand that jumps where a pointer jumps
//! stretches edges in no time, and tears them falsely; so it has a largest speed.

use tearmesh::geometry::{Point, length};
use tearmesh::{Edit, VertexId};

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
    /// The place of the vertex at rest when it was grabbed: the middle of the grip.
    centre: Point,
    radius_m: f64,
}

/// The hands that hold now.
#[derive(Clone, Debug, Default)]
pub(super) struct Hands {
    hands: Vec<Hand>,
    next: u32,
}

impl Hands {
    /// A new hand that grips around a place at rest.
    pub(super) fn grab(&mut self, v: VertexId, centre: Point, radius_m: f64) -> HandId {
        let id = HandId(self.next);
        self.next += 1;
        self.hands.push(Hand {
            id,
            set: HeldSet::new(vec![v]),
            centre,
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

    /// How many times as strong as by itself the cloth is at a place at rest.
    pub(super) fn grip(&self, at: Point) -> f64 {
        let grips = self.hands.iter();
        let grips = grips.filter_map(|hand| grip(length(at - hand.centre), hand.radius_m));
        grips.fold(1.0, f64::max)
    }

    pub(super) fn follow(&mut self, edit: &Edit<'_>) {
        let sets = self.hands.iter_mut().map(|hand| &mut hand.set);
        sets.for_each(|set| set.follow(edit, true));
    }
}

/// How many times as strong a grip of this radius makes the cloth at a distance at rest; `None` beyond its radius.
pub(crate) fn grip(distance_m: f64, radius_m: f64) -> Option<f64> {
    let is_gripped = distance_m <= radius_m && radius_m > 0.0;
    is_gripped.then(|| GRIP_STRENGTH * (radius_m / distance_m.max(radius_m * GRIP_CORE)))
}

/// The path of a hand to a point that was given now: it takes the time of a frame, as a pointer is
/// read once a frame, or longer where the hand would be too fast.
pub(super) fn path(from: Point, to: Point, now_s: f64) -> Path {
    let took_s = (length(to - from) / SPEED_MAX_M_PER_S).max(FRAME_S);
    Path::through(vec![(now_s, from), (now_s + took_s, to)])
}

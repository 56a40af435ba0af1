//! Contacts: who touches an obstacle, what friction takes, and who has to be looked at.

use tearmesh::geometry::{Point, Vector, dot, length};

/// A particle or a face in contact in the last substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    pub(crate) corners: Corners,
    pub(crate) normal: Vector,
    pub(crate) friction: f64,
    pub(crate) pressed: Pressed,
    /// The velocity of the obstacle there, in m/s.
    pub(crate) velocity: Vector,
}

/// How far and how fast a particle would have gone into an obstacle in this substep if its method had not kept
/// it out: zero for all methods but implicit ones.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pressed {
    pub(crate) depth_m: f64,
    pub(crate) speed_m_per_s: f64,
}

impl Contact {
    /// The way out of a depth for who went so far along the obstacle in this substep, with a part of the slip
    /// taken back; and the velocity that this adds in a method that takes velocities from ways, by as many as make a second.
    pub(crate) fn way_out(&self, went: Vector, depth: f64, per_s: f64) -> [Vector; 2] {
        let most = self.friction * (depth + self.pressed.depth_m);
        let slip = rubbed(went, self.normal, most);
        // What was inside before comes out without a velocity.
        let new = depth.min(-dot(self.normal, went)).max(0.0);
        let way = self.normal * depth.max(0.0) - slip;
        [way, (self.normal * new - slip) * per_s]
    }

    /// The velocity inward, and a part of that along the obstacle, as seen from it.
    pub(crate) fn taken(&self, v: Vector) -> Vector {
        let v = v - self.velocity;
        let into = dot(self.normal, v).min(0.0);
        let most = self.friction * (self.pressed.speed_m_per_s - into);
        self.normal * into + rubbed(v, self.normal, most)
    }
}

/// The part of a move along an obstacle that friction takes back: all of it, or so much.
fn rubbed(way: Vector, normal: Vector, most: f64) -> Vector {
    let slip = way - normal * dot(normal, way);
    let distance = length(slip);
    if distance > most {
        slip * (most / distance)
    } else {
        slip
    }
}

/// A particle, or the three corners of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners {
    list: [u32; 3],
    pub(crate) count: usize,
}

impl Corners {
    pub(crate) fn of_particle(particle: usize) -> Corners {
        Corners {
            list: [particle as u32; 3],
            count: 1,
        }
    }

    pub(crate) fn of_face(list: [u32; 3]) -> Corners {
        Corners { list, count: 3 }
    }

    /// The particle, if it is one.
    pub(crate) fn particle(&self) -> Option<usize> {
        (self.count == 1).then_some(self.list[0] as usize)
    }

    pub(crate) fn each(&self) -> impl Iterator<Item = usize> + use<> {
        let list = self.list.into_iter().take(self.count);
        list.map(|corner| corner as usize)
    }

    /// The mean of vectors.
    pub(crate) fn mean(&self, of: impl Fn(usize) -> Vector) -> Vector {
        match self.particle() {
            Some(particle) => of(particle),
            None => self.each().fold(Vector::zeros(), |sum, i| sum + of(i)) / 3.0,
        }
    }

    /// The middle of points.
    pub(crate) fn middle(&self, of: &[Point]) -> Point {
        Point::from(self.mean(|corner| of[corner].coords))
    }
}

/// What is known of how far particles are from bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactCache {
    /// How far any particle may have gone since the beginning.
    pub(crate) gone_m: f64,
    /// Of each collider that is a body.
    pub(crate) at: Vec<ColliderCache>,
    /// Whether particles were moved out in this substep.
    pub(crate) is_out: bool,
    /// A particle that went too far in the last substep, and may be at the wrong side of a body.
    pub(crate) too_far: Option<usize>,
}

/// How far particles may go before each of them, and after these each face, has its distance computed again: as
/// [`ContactCache::gone_m`] is then.
#[derive(Clone, Debug, Default)]
pub(crate) struct ColliderCache {
    pub(crate) until_m: Vec<f64>,
    pub(crate) least_m: f64,
}

impl ContactCache {
    /// Has every distance computed again.
    pub(crate) fn invalidate(&mut self) {
        self.at.clear();
    }
}

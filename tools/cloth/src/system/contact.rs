//! Contacts: who touches an obstacle, what friction takes, and who has to be looked at.

use tearmesh::geometry::{Point, Vector, dot, length};

/// A particle or a face in contact in the last substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contact {
    /// The number of the obstacle.
    pub(crate) collider: usize,
    pub(crate) corners: Corners,
    pub(crate) normal: Vector,
    pub(crate) friction: f64,
    pub(crate) pressed: Pressed,
    /// The velocity of the obstacle there, in m/s.
    pub(crate) velocity: Vector,
}

/// How a method itself kept a particle, or the middle of a face, out of an obstacle in this substep: not at all but for implicit
/// ones.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pressed {
    /// How far it would have gone in.
    pub(crate) depth_m: f64,
    /// The friction that it can be rubbed by for that, in N.
    pub(crate) friction_n: f64,
    /// The velocity that it would have after another substep like this one without friction.
    pub(crate) free: Vector,
}

impl Contact {
    /// The mass with which the particle, or the middle of the face, resists a force.
    pub(crate) fn mass(&self, inverse_masses: &[f64]) -> f64 {
        let inverse = self.corners.each().map(|i| inverse_masses[i]);
        (self.corners.count as f64).powi(2) / inverse.sum::<f64>()
    }

    /// The part of a way along the obstacle.
    pub(crate) fn along(&self, way: Vector) -> Vector {
        way - self.normal * dot(self.normal, way)
    }

    /// The way out of a depth for who went so far along the obstacle in this substep, with a part of the slip
    /// taken back; the part of it that was inside before; and the velocity that the rest adds in a method that takes velocities
    /// from ways, by as many as make a second.
    pub(crate) fn way_out(&self, went: Vector, depth: f64, per_s: f64) -> [Vector; 3] {
        // A method that keeps it out has rubbed it already, for all but what it let in.
        let let_in_m = match self.pressed.depth_m > 0.0 {
            true => -dot(self.normal, went),
            false => 0.0,
        };
        let most = self.friction * depth.max(let_in_m).max(0.0);
        let slip = rubbed(self.along(went), most);
        // What was inside before comes out without a velocity.
        let new = depth.min(-dot(self.normal, went)).max(0.0);
        let way = self.normal * depth.max(0.0) - slip;
        let came_in = self.normal * new - slip;
        [way, way - came_in, came_in * per_s]
    }

    /// The velocity inward, and a part of that along the obstacle, as seen from it.
    pub(crate) fn taken(&self, v: Vector) -> Vector {
        let v = v - self.velocity;
        let into = dot(self.normal, v).min(0.0);
        self.normal * into + rubbed(self.along(v), -into * self.friction)
    }
}

/// The part of a slip that friction takes back: all of it, or so much.
fn rubbed(slip: Vector, most: f64) -> Vector {
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
    /// The number of the particle; that of the face, with all particles counted before.
    pub(crate) number: usize,
    list: [u32; 3],
    pub(crate) count: usize,
}

impl Corners {
    pub(crate) fn of_particle(particle: usize) -> Corners {
        Corners {
            number: particle,
            list: [particle as u32; 3],
            count: 1,
        }
    }

    pub(crate) fn of_face(number: usize, list: [u32; 3]) -> Corners {
        Corners {
            number,
            list,
            count: 3,
        }
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

/// What contact did in a substep.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ContactWork {
    /// The work of all colliders, in joules.
    pub(crate) colliders_j: f64,
}

/// By how much contact changes velocities in a substep, where a balance of energy asks for it.
///
/// The work of an impulse J is the impulse times the mean of the velocities u and v before and after the substep, as
/// that of a force is. So what a particle loses on its way into an obstacle, and gets back as it is moved out, cancels
/// within the substep, and what rests on an obstacle that does not move does no work. (The change of all energy by
/// each move is of first order in the step: of a particle of mass m that rests under gravity g it is m g² Δt / 4 in a
/// second, and the method seems to lose as much.)
///
/// Velocity Verlet moves particles out between two half kicks, which change the velocity by v − u − J in all. Its
/// impulses H then and E at the end work J · (u + v) / 2 + (v − u − J) · (E − H) / 2 for a unit of mass: without the
/// second part, what slides off an edge keeps a velocity inward of half a kick, and seems to lose it in every step.
///
/// What was inside before the substep, as a face that is pushed out of a ridge by its middle, is lifted without a
/// velocity: what that changes is work too.
#[derive(Clone, Debug, Default)]
pub(crate) struct Impulses {
    is_kept: bool,
    /// Whether a method is between two half kicks.
    pub(crate) is_halfway: bool,
    /// The velocities before the substep.
    before: Vec<Vector>,
    /// Particles, and the changes of their velocities between half kicks and at the end.
    changes: Vec<(usize, [Vector; 2])>,
    /// The place of each particle in that list.
    place: Vec<Option<u32>>,
    /// What it took to lift, in joules.
    lifted_j: f64,
}

impl Impulses {
    pub(crate) fn begin(&mut self, velocities: &[Vector], is_kept: bool) {
        (self.lifted_j, self.is_kept) = (0.0, is_kept);
        for (particle, _) in self.changes.drain(..) {
            self.place[particle] = None;
        }
        if is_kept {
            velocities.clone_into(&mut self.before);
            self.place.resize(velocities.len(), None);
        }
    }

    /// Notes that the velocity of a particle changes.
    pub(crate) fn note(&mut self, particle: usize, change: Vector) {
        if !self.is_kept || change == Vector::zeros() {
            return;
        }
        let place = *self.place[particle].get_or_insert_with(|| {
            self.changes.push((particle, [Vector::zeros(); 2]));
            self.changes.len() as u32 - 1
        });
        let (_, changes) = &mut self.changes[place as usize];
        changes[usize::from(!self.is_halfway)] += change;
    }

    /// Whether work is asked for.
    pub(crate) fn is_kept(&self) -> bool {
        self.is_kept
    }

    /// Adds the energy of a particle that is moved without a velocity.
    pub(crate) fn lift(&mut self, by_j: f64) {
        self.lifted_j += by_j;
    }

    /// The work in the substep, by the velocities after it.
    pub(crate) fn work(&self, masses: &[f64], after: &[Vector]) -> ContactWork {
        let work_j = |&(particle, [halfway, at_end]): &(usize, [Vector; 2])| {
            let (u, v, all) = (self.before[particle], after[particle], halfway + at_end);
            let mut twice = dot(all, u + v);
            if halfway != Vector::zeros() {
                twice += dot(v - u - all, at_end - halfway);
            }
            0.5 * masses[particle] * twice
        };
        ContactWork {
            colliders_j: self.lifted_j + self.changes.iter().map(work_j).sum::<f64>(),
        }
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

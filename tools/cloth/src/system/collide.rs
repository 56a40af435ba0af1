//! Contact of particles with colliders, at the end of each substep.
//!
//! A particle inside an obstacle is moved out by the shortest way, and loses its velocity into it. Friction
//! then shortens the slip of the substep by up to μ times that way, and the velocity along the obstacle by
//! up to μ times the velocity that was lost. Both are needed: a step of Verlet from rest moves a particle in
//! by g Δt²/2 and gives it the velocity g Δt, one of symplectic Euler moves it by g Δt². So each method
//! slides by its own rule for a steady acceleration g (sin φ − μ cos φ), and what sticks does not creep.
//! (Implicit steps rub what they keep out themselves: [`Pressed`].)
//!
//! A body that moves takes along what it touches: ways and velocities are those that it sees. It is looked at
//! as if it stood where it was made.
//!
//! Cloth keeps a distance from a [body](crate::Body), its *thickness*, at vertices; and the error of the grid at
//! the middles of faces, so that no face is drawn through a ridge. A middle that is nearer moves its corners.
//!
//! A look at a body says how far a particle may go before it has to be looked at again. So what is far away,
//! or rests in a fold, costs a comparison. And a particle that goes farther in a substep than the thickness
//! and a cell may come out at the other side of a limb of two cells, which are the thinnest that a grid shows: if
//! its way leads in and out, or in to where the surface faces another way, the step is divided. What is light and stiff
//! may go far in the shortest part of an implicit step, but comes out where it went in.

use tearmesh::geometry::{Point, Vector, dot, length};

use crate::system::System;
use crate::system::body::Body;
use crate::system::contact::{ColliderCache, Contact, ContactCache, ContactWork, Corners, Pressed};
use crate::system::energy;
use crate::system::load::{Collider, ColliderShape};
use crate::system::path::Pose;

/// The contacts of the last substep.
pub(crate) fn contacts(system: &System) -> &[Contact] {
    &system.scratch.contacts
}

/// Notes where a substep begins, if there are colliders; and with which velocities, if the work of contact is to be
/// known.
pub(crate) fn begin(system: &mut System, substep_s: f64, is_observed: bool) {
    system.scratch.span_s = [system.elapsed_s, system.elapsed_s + substep_s];
    let cache = &mut system.scratch.contact;
    (cache.is_out, cache.too_far) = (false, None);
    system.scratch.pressed.clear();
    let is_observed = is_observed && !system.model.loads.colliders.is_empty();
    system
        .scratch
        .impulses
        .begin(&system.velocities, is_observed);
    if !system.model.loads.colliders.is_empty() {
        system.scratch.before.clone_from(&system.positions);
    }
}

/// A particle that went so far in the last substep that it may have passed through a body.
pub(crate) fn too_far(system: &System) -> Option<usize> {
    system.scratch.contact.too_far
}

/// Two colliders that leave no room for a particle where the last substep ended: their surfaces face each other there, and
/// overlap.
pub(crate) fn pressing(system: &System, particle: usize) -> Option<[usize; 2]> {
    let x = system.positions[particle];
    let ways_out = system.model.loads.colliders.iter().map(|collider| {
        let ColliderShape::Body { body, .. } = &collider.shape else {
            let (normal, depth) = collider.shape.way_out(x);
            return (Some(normal), depth);
        };
        let pose = collider.pose(system.scratch.span_s[1]);
        let seen = pose.to_body(x);
        let normal = body.outward(seen).map(|normal| pose.turned(normal));
        (normal, -body.distance_m(seen))
    });
    let ways_out: Vec<_> = ways_out.collect();
    let mut pairs = (0..ways_out.len()).flat_map(|other| (0..other).map(move |one| [one, other]));
    pairs.find(|pair| {
        let [(normal, depth), (other, other_depth)] = pair.map(|i| ways_out[i]);
        // Deep inside nobody knows the way.
        let faces = normal
            .zip(other)
            .is_none_or(|(n, other)| dot(n, other) < 0.0);
        faces && depth + other_depth > 0.0
    })
}

/// Moves the particles out of the colliders if that was not done yet in this substep, and takes their
/// velocity inward. Returns the work of contact in the substep.
pub(crate) fn push_out(system: &mut System) -> ContactWork {
    system.keep();
    if !system.scratch.contact.is_out {
        move_out(system, 0.0);
    }
    system.scratch.contact.is_out = false;
    let contacts = std::mem::take(&mut system.scratch.contacts);
    for contact in &contacts {
        let v = contact.corners.mean(|corner| system.velocities[corner]);
        let taken = contact.taken(v);
        change(system, contact.corners, |_, v, share| *v -= taken * share);
    }
    system.scratch.contacts = contacts;
    let (impulses, velocities) = (&system.scratch.impulses, &system.velocities);
    impulses.work(&system.model.masses, velocities)
}

/// The velocity of an obstacle in this substep where something touched it in the last.
pub(crate) fn velocity(system: &System, contact: &Contact) -> Vector {
    let collider = &system.model.loads.colliders[contact.collider];
    let ColliderShape::Body { motion, .. } = &collider.shape else {
        return Vector::zeros();
    };
    if motion.is_still() {
        return Vector::zeros();
    }
    let [from_s, to_s] = system.scratch.span_s;
    let x = contact.corners.middle(&system.positions);
    let seen = motion.at(from_s).to_body(x);
    (motion.at(to_s).to_world(seen) - x) / (to_s - from_s)
}

/// Moves the particles out of the colliders, in a method that goes on from where they are then, and adds what
/// they move in a second times `per_s` to their velocities. All else of velocities is done at the end of the
/// substep.
pub(crate) fn move_out(system: &mut System, per_s: f64) {
    let colliders = std::mem::take(&mut system.model.loads.colliders);
    let mut cache = std::mem::take(&mut system.scratch.contact);
    cache.is_out = true;
    system.scratch.contacts.clear();
    if colliders.iter().any(Collider::is_body) {
        cache.gone_m += farthest_m(system);
        cache
            .at
            .resize_with(colliders.len(), ColliderCache::default);
    }
    for (i, collider) in colliders.iter().enumerate() {
        system.counters.collider_passes += 1;
        if let ColliderShape::Body {
            body,
            thickness_m,
            motion,
        } = &collider.shape
        {
            let poses = system.scratch.span_s.map(|time_s| motion.at(time_s));
            let solid = Solid {
                collider: i,
                body,
                thickness_m: *thickness_m,
                friction: collider.friction,
                poses: Some(poses).filter(|_| !motion.is_still()),
                per_s,
            };
            solid.move_out(&mut cache, system);
            continue;
        }
        system.counters.features.collider += system.positions.len() as u64;
        for particle in 0..system.positions.len() {
            if system.model.inverse_masses[particle] <= 0.0 {
                continue;
            }
            let (normal, depth) = collider.shape.way_out(system.positions[particle]);
            let corners = Corners::of_particle(particle);
            let pressed = pressed(system, i, corners);
            if depth + pressed.depth_m > 0.0 {
                let contact = Contact {
                    collider: i,
                    corners,
                    normal,
                    friction: collider.friction,
                    pressed,
                    velocity: Vector::zeros(),
                };
                take_out(system, &contact, depth, per_s);
                system.scratch.contacts.push(contact);
            }
        }
    }
    (system.model.loads.colliders, system.scratch.contact) = (colliders, cache);
}

/// How far a particle went in this substep, at most.
fn farthest_m(system: &System) -> f64 {
    let ways = system.positions.iter().zip(&system.scratch.before);
    let squares = ways.map(|(x, before)| dot(x - before, x - before));
    let farthest = squares.fold(
        0.0,
        |most, square| if square > most { square } else { most },
    );
    farthest.sqrt()
}

/// The part of the error of a grid below which the depth of a particle is not looked at again. (What rests sinks
/// in by less, and that saves half of all looks.)
const SETTLED: f64 = 0.05;

/// A body that keeps cloth away.
struct Solid<'a> {
    collider: usize,
    body: &'a Body,
    thickness_m: f64,
    friction: f64,
    /// The places of one that moves at both ends of the substep.
    poses: Option<[Pose; 2]>,
    per_s: f64,
}

impl Solid<'_> {
    /// The looks at a point that is pushed out: one for each cell on its way, as a rule.
    const LOOKS: u32 = 4;

    /// The parts of a way that are looked at; a longer one may have led anywhere.
    const PARTS_MAX: f64 = 64.0;

    /// Tests particles, and then the middles of faces, where that is due.
    fn move_out(&self, cache: &mut ContactCache, system: &mut System) {
        let of = &mut cache.at[self.collider];
        let particles = system.positions.len();
        let all = particles + system.model.faces.len() / 3;
        if of.until_m.len() != all {
            of.until_m.clear();
            let room = system.positions.capacity() + system.model.faces.capacity() / 3;
            of.until_m.reserve(room);
            of.until_m.resize(all, f64::NEG_INFINITY);
            of.least_m = f64::NEG_INFINITY;
        }
        cache.gone_m += self.farthest_m();
        if cache.gone_m < of.least_m {
            return;
        }
        // Faces that share corners undo each other's way in part.
        let rounds = [0..particles, particles..all, particles..all, particles..all];
        for (round, range) in rounds.into_iter().enumerate() {
            let mut moved_m = 0.0_f64;
            for i in range {
                if cache.gone_m < of.until_m[i] {
                    continue;
                }
                let (corners, apart_m) = if i < particles {
                    if self.has_passed(system, i) {
                        cache.too_far = Some(i);
                    }
                    (Corners::of_particle(i), self.thickness_m)
                } else {
                    let face = system.model.faces.as_chunks::<3>().0[i - particles];
                    (Corners::of_face(i, face), self.body.error_worst_m())
                };
                // Once a substep.
                let pressed = match round {
                    0 | 1 => pressed(system, self.collider, corners),
                    _ => Pressed::default(),
                };
                let (clear_m, by_m) = self.clear(system, corners, apart_m, pressed);
                moved_m = moved_m.max(by_m);
                of.until_m[i] = cache.gone_m + clear_m;
            }
            cache.gone_m += moved_m;
            if round > 0 && moved_m < SETTLED * self.body.error_worst_m() {
                break;
            }
        }
        of.least_m = of.until_m.iter().copied().fold(f64::INFINITY, f64::min);
    }

    /// A point as the body sees it where it is at the beginning or the end of the substep.
    fn seen(&self, x: Point, end: usize) -> Point {
        self.poses.map_or(x, |poses| poses[end].to_body(x))
    }

    /// How far the body moved in this substep, at most.
    fn farthest_m(&self) -> f64 {
        self.poses.map_or(0.0, |[from, to]| {
            let corners = self.body.box_corners().into_iter();
            let ways = corners.map(|p| length(to.to_world(p) - from.to_world(p)));
            ways.fold(0.0, f64::max)
        })
    }

    /// The velocity of the body at a point of it.
    fn velocity(&self, p: Point, [from_s, to_s]: [f64; 2]) -> Vector {
        self.poses.map_or_else(Vector::zeros, |[from, to]| {
            (to.to_world(p) - from.to_world(p)) / (to_s - from_s)
        })
    }

    /// Whether a particle may have come to another side of the body in this substep than where it went in. Its way
    /// is looked at in parts of a thickness and a cell.
    fn has_passed(&self, system: &System, particle: usize) -> bool {
        let before = self.seen(system.scratch.before[particle], 0);
        let way = self.seen(system.positions[particle], 1) - before;
        let (way_m, part_m) = (length(way), self.thickness_m + self.body.cell_m());
        let is_free = system.model.inverse_masses[particle] > 0.0;
        let is_clear = self.body.distance_m(before) - self.thickness_m >= way_m;
        if !(is_free && way_m > part_m) || is_clear {
            return false;
        }
        let parts = (way_m / part_m).ceil().min(Self::PARTS_MAX);
        let mut entered = None;
        for part in 1..=parts as u32 {
            let x = before + way * (f64::from(part) / parts);
            if self.body.distance_m(x) < self.thickness_m {
                let Some(normal) = self.body.outward(x) else {
                    return true;
                };
                if dot(*entered.get_or_insert(normal), normal) <= 0.0 {
                    return true;
                }
            } else if entered.is_some() {
                return true;
            }
        }
        parts >= Self::PARTS_MAX
    }

    /// Moves a particle, or the corners of a face, until it is as far from the surface as it should be, or the
    /// middle of the face is. It was pressed so in this substep. Returns how much farther it is, and how far a particle
    /// was moved.
    fn clear(
        &self,
        system: &mut System,
        corners: Corners,
        apart_m: f64,
        pressed: Pressed,
    ) -> (f64, f64) {
        let mut moved_m = 0.0;
        for look in 0..=Self::LOOKS {
            system.counters.features.collider += 1;
            let x = self.seen(corners.middle(&system.positions), 1);
            let depth = apart_m - self.body.distance_m(x);
            let pressed = match look {
                0 => pressed,
                _ => Pressed::default(),
            };
            if depth + pressed.depth_m <= 0.0 {
                return (-depth, moved_m);
            }
            // Deep inside nobody knows the way.
            let outward = self.body.outward(x).filter(|_| look < Self::LOOKS);
            let Some(normal) = outward.filter(|_| is_free(system, corners)) else {
                break;
            };
            let contact = Contact {
                collider: self.collider,
                corners,
                normal: self.poses.map_or(normal, |poses| poses[1].turned(normal)),
                velocity: self.velocity(x, system.scratch.span_s),
                // What comes after the first look corrects for the curvature of the surface.
                friction: if look == 0 { self.friction } else { 0.0 },
                pressed,
            };
            // No corner is moved farther than to the end of its shortest edge, such as a cut leaves; and what corners
            // keep off is a face that touches.
            let least_m = corners.particle().map_or(0.0, |_| f64::NEG_INFINITY);
            let out_m = depth.max(least_m).min(shortest_edge_m(system, corners));
            moved_m += take_out(system, &contact, out_m, self.per_s);
            if look == 0 {
                system.scratch.contacts.push(contact);
            }
            if corners.count == 1 && out_m < SETTLED * self.body.error_worst_m() {
                break;
            }
        }
        (0.0, moved_m)
    }
}

/// Whether a corner can be moved.
fn is_free(system: &System, corners: Corners) -> bool {
    let mut all = corners.each();
    all.any(|corner| system.model.inverse_masses[corner] > 0.0)
}

/// The rest length of the shortest edge at the corners of a face.
fn shortest_edge_m(system: &System, corners: Corners) -> f64 {
    let stretch = &system.model.stretch;
    let of_face = corners.each().filter(|_| corners.count > 1);
    let edges = of_face.flat_map(|corner| stretch.of(corner));
    let lengths = edges.map(|id| stretch.get(id).rest_length_m);
    lengths.fold(f64::INFINITY, f64::min)
}

/// How a particle, or the middle of a face, was kept out of a collider by its method in this substep.
fn pressed(system: &System, collider: usize, corners: Corners) -> Pressed {
    let at = place(system, collider, corners);
    let pressed = system.scratch.pressed.get(at).copied();
    pressed.unwrap_or_default()
}

/// Notes how a method kept particles out of a collider, in this part of a substep.
pub(crate) fn press(system: &mut System, contact: &Contact) {
    let at = place(system, contact.collider, contact.corners);
    let pressed = &mut system.scratch.pressed;
    if pressed.len() <= at {
        pressed.resize(at + 1, Pressed::default());
    }
    let before_m = pressed[at].depth_m;
    pressed[at] = contact.pressed;
    pressed[at].depth_m += before_m;
}

/// The place of a particle, or of a face, at a collider in the list of what was pressed.
fn place(system: &System, collider: usize, corners: Corners) -> usize {
    let all = system.positions.len() + system.model.faces.len() / 3;
    collider * all + corners.number
}

/// Moves particles out by a depth. Returns how far one of them was moved, at most.
fn take_out(system: &mut System, contact: &Contact, depth: f64, per_s: f64) -> f64 {
    let corners = contact.corners;
    let [x, before] = [&system.positions, &system.scratch.before];
    let [from_s, to_s] = system.scratch.span_s;
    let carried = contact.velocity * (to_s - from_s);
    let went = corners.mean(|corner| x[corner] - before[corner]) - carried;
    let [way, lifted, speed] = contact.way_out(went, depth, per_s);
    let share = change(system, corners, |x, v, share| {
        *x += way * share;
        *v += speed * share;
    });
    if system.scratch.impulses.is_kept() && lifted != Vector::zeros() {
        note_lifting(system, corners, lifted);
    }
    share * length(way)
}

/// Notes the work of a move that ended where the corners are now, and gave them no velocity.
fn note_lifting(system: &mut System, corners: Corners, lifted: Vector) {
    // Back, and forth again to the same bits: a balance of energy moves nothing.
    let mut ends = [Point::origin(); 3];
    for (end, i) in ends.iter_mut().zip(corners.each()) {
        *end = system.positions[i];
    }
    change(system, corners, |x, _, share| *x -= lifted * share);
    for (i, end) in corners.each().zip(ends) {
        let before_j = energy::at_j(system, i);
        system.positions[i] = end;
        let after_j = energy::at_j(system, i);
        system.scratch.impulses.lift(after_j - before_j);
    }
}

/// Changes each corner by its inverse mass, so that the middle changes by one in all. Returns the largest change.
fn change(
    system: &mut System,
    corners: Corners,
    change: impl Fn(&mut Point, &mut Vector, f64),
) -> f64 {
    let weights = corners.each().map(|i| system.model.inverse_masses[i]);
    let sum: f64 = weights.sum();
    let mut most = 0.0_f64;
    for i in corners.each() {
        let share = corners.count as f64 * (system.model.inverse_masses[i] / sum);
        most = most.max(share);
        let before = system.velocities[i];
        change(&mut system.positions[i], &mut system.velocities[i], share);
        let impulses = &mut system.scratch.impulses;
        impulses.note(i, system.velocities[i] - before);
    }
    most
}

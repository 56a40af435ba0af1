//! The forces in constraints, the accelerations of particles, and the force that is needed to hold one.
//!
//! With a method that has physical stiffness, the force of a spring follows from its length.
//! [`Pbd`] and [`Xpbd`] move particles instead, and their force is the multiplier that they
//! accumulated. [`Provot`] has both: the force of the spring, and that of the limiter. A step
//! records which of these applies, so that thresholds in newtons and force probes need not know the
//! method.
//!
//! [`Pbd`]: crate::Pbd
//! [`Xpbd`]: crate::Xpbd
//! [`Provot`]: crate::Provot

use tearmesh::geometry::{Point, Vector};

use crate::system::System;
use crate::system::constraint::ConstraintId;
use crate::system::crush::Crush;
use crate::system::model::Model;
use crate::system::pair;

/// Returns the force in a stretch constraint as the method of the last step exerted it, in newtons.
/// Tension is positive. For methods with physical stiffness, and before any step, it is computed
/// from the length, as k (l − L). For methods that project it is the multiplier, −λ/Δt². Where a limiter helped the springs, it is the sum of both. Between
/// two held particles, which no method moves, the length is used.
///
/// # Panics
///
/// If there is no such constraint.
#[must_use]
pub fn force_n(system: &System, id: ConstraintId) -> f64 {
    let (model, stretch) = (&system.model, &system.model.stretch);
    let (one, multiplier) = (stretch.get(id), stretch.multiplier(id));
    let by_length = pair::axial_of(stretch, &one, &system.positions).force;
    model.exerted_n(one.ends, by_length, multiplier)
}

/// Returns the force, in newtons, that a hand must exert to hold or lead a particle: minus the sum
/// of the forces of constraints ([`force_n`]) and their damping, triangles, gravity, wind and drag. On a grabbed
/// particle it is a force probe. On a free one it is minus the force that accelerates it, which
/// vanishes at rest. It excludes colliders, and the inertia at the corners of a path. The cost is
/// proportional to the valence, and linear in the system if there is wind.
///
/// After a step of a method that projects, forces are means over the last substep. More sweeps make
/// them more exact.
///
/// # Panics
///
/// If there is no such particle.
///
/// ```
/// use tearmesh_cloth::{Loads, System, force};
/// use tearmesh::{Point, Vector};
///
/// let points = [Point::origin(), Point::new(0.0, 0.0, -1.1)];
/// let mut spring = System::new(points, vec![0.5; 2])?;
/// spring.stretch([0, 1], 1.0, 50.0)?;
/// spring.hold(0);
/// let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -10.0));
/// spring.set_loads(Loads { gravity_m_per_s2, ..Loads::default() })?;
/// let hand = force::reaction_n(&spring, 0);
/// assert!((hand.z - (50.0 * 0.1 + 0.5 * 10.0)).abs() < 1e-12); // The spring, and its own weight.
/// assert!(force::reaction_n(&spring, 1).norm() < 1e-12); // At rest.
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn reaction_n(system: &System, particle: usize) -> Vector {
    let (model, x, v) = (&system.model, &system.positions, &system.velocities);
    let drag_n = v[particle] * model.drag_per_s() * model.masses[particle];
    let mut wind_n = Vector::zeros();
    if let Some(wind) = model.loads.wind {
        let faces = model.faces.as_chunks::<3>().0.iter();
        for face in faces.filter(|face| face.contains(&(particle as u32))) {
            wind_n += wind.force_at_corners(*face, x, v);
        }
    }
    -(inner_n(system, particle) + wind_n - drag_n)
}

/// Computes the accelerations of all particles, in m/s², without drag; those of held particles are
/// zero. Counts as a force evaluation. Returns false if a constraint is stretched beyond
/// [`System::set_stretch_ratio_max`].
pub fn accelerations(system: &mut System, accelerations: &mut Vec<Vector>) -> bool {
    let is_sane = accelerate(system, false, None);
    system.scratch.accelerations.clone_into(accelerations);
    is_sane
}

/// Takes the accelerations now, with wind at the velocities of now or at those that were
/// predicted: in a step of `dt_s` seconds with the guards of
/// [`Verlet`](crate::Verlet), or without any. False where a constraint is longer than the system's
/// largest stretch ratio.
#[must_use]
pub(crate) fn accelerate(system: &mut System, is_predicted: bool, guarded_s: Option<f64>) -> bool {
    let (model, scratch) = (&system.model, &mut system.scratch);
    let (positions, velocities) = (&system.positions, &system.velocities);
    scratch.is_fresh = false;
    let forces = &mut scratch.forces;
    forces.resize(positions.len(), Vector::zeros());
    forces.fill(Vector::zeros());
    let crush = guarded_s.map(|dt_s| Crush { velocities, dt_s });
    let winds = match is_predicted {
        true => &scratch.predicted,
        false => velocities,
    };
    system.counters.force_evaluations += 1;
    model.count_visits(1, &mut system.counters);
    let pull = model.add_forces(positions, crush, forces);
    model.blow(positions, winds, forces, &mut system.counters);
    let carry = guarded_s.map(|_| &system.guard.carry);
    let accelerations = &mut scratch.accelerations;
    accelerations.resize(positions.len(), Vector::zeros());
    model.weigh_carried(carry, forces, accelerations);
    scratch.is_weighed = true;
    system.guard.unheeded.clear();
    scratch.guarded_s = guarded_s.unwrap_or(0.0);
    scratch.none_reaches = match pull.is_short {
        true => model.ratio_watched,
        false => f64::INFINITY,
    };
    scratch.damped_w = pull.damped_w;
    pull.is_sane
}

/// Brings the accelerations at the end of the last guarded step, of `dt_s` seconds as this one, up to date with edits
/// since: the forces on particles whose constraints have changed are taken anew, by the velocities in the middle of
/// that step, as the others have been, so that no force is without its counterforce. (All of them anew would
/// cost as much as a step. To let the old ones act for half a step made 5 % of what was put into a rip: a light
/// particle that a tear sets free begins half a step late, at ω Δt near 1.)
pub(crate) fn accelerate_edited(system: &mut System, dt_s: f64) {
    let (model, scratch) = (&system.model, &mut system.scratch);
    if scratch.is_weighed && system.guard.unheeded.list().is_empty() {
        return;
    }
    let half_s = 0.5 * dt_s;
    let keep = 1.0 - half_s * model.drag_per_s();
    let in_middle = |particle: usize| match model.inverse_masses[particle] > 0.0 {
        true => (system.velocities[particle] - scratch.accelerations[particle] * half_s) / keep,
        false => system.velocities[particle],
    };
    let middle = &mut scratch.predicted;
    middle.resize(system.positions.len(), Vector::zeros());
    let edited = system.guard.unheeded.list();
    for particle in edited.iter().map(|&particle| particle as usize) {
        middle[particle] = in_middle(particle);
        model.springs_at(particle, 0.0, |_, other, _| {
            middle[other] = in_middle(other);
        });
    }
    let crush = Some(Crush {
        velocities: middle,
        dt_s,
    });
    for &particle in edited {
        let force = &mut scratch.forces[particle as usize];
        *force = Vector::zeros();
        let exerted = |_, by_length, _| by_length;
        let at = (&system.positions[..], crush, particle as usize);
        add_force_at(model, at, exerted, force);
    }
    system.guard.unheeded.clear();
    let carry = Some(&system.guard.carry);
    model.weigh_carried(carry, &scratch.forces, &mut scratch.accelerations);
    scratch.is_weighed = true;
}

/// The force of constraints, their damping, triangles and gravity on a particle, in newtons.
pub(crate) fn inner_n(system: &System, particle: usize) -> Vector {
    let model = &system.model;
    let mut sum = model.gravity() * model.masses[particle];
    let exerted = |ends, by_length, multiplier| model.exerted_n(ends, by_length, multiplier);
    let crush = Crush {
        velocities: &system.velocities,
        dt_s: 0.0, // Without a step nothing is damped for being crushed.
    };
    let crush = model.is_damped.then_some(crush);
    let at = (&system.positions[..], crush, particle);
    add_force_at(model, at, exerted, &mut sum);
    sum
}

/// Adds the forces of constraints, as `exerted` has them, and of triangles on a particle.
fn add_force_at(
    model: &Model,
    (x, crush, particle): (&[Point], Option<Crush<'_>>, usize),
    exerted: impl Fn([usize; 2], f64, f64) -> f64,
    sum: &mut Vector,
) {
    for family in [&model.stretch, &model.bend] {
        pair::add_force_at(family, x, crush, particle, &exerted, sum);
    }
    model.triangles.add_force_at(x, crush, particle, sum);
}

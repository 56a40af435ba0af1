//! What a method itself makes of energy in a step, or takes where negative: computed from the forces that
//! it used and the way that particles went, and never as the rest of a sum.
//!
//! A method moves particles by forces of its own choice, at times of its own choice, and each has an
//! identity that says what this makes of energy. K is ½ Σ m|v|² over free particles, E the elastic
//! energy, c the drag, δ = x₁ − x₀ the way of a step.
//!
//! **Velocity Verlet** ([`Account`]). From v₁ + v₀ = 2δ/Δt − Δt/2 (a₀ − a₁) and v₁ − v₀ = Δt/2 (a₀ + a₁)
//!
//! ```text
//! K₁ − K₀ = ½ (f₀ + f₁)·δ + S₁ − S₀,   S = Δt²/8 Σ f·a
//! E₁ − E₀ = −½ (e₀ + e₁)·δ + T,        e the elastic forces
//! ```
//!
//! S is what energy swings by against that of the oscillators which the method follows exactly, its
//! *shadow* (Hairer, Lubich and Wanner 2003 §3, and 2006 §IX.3); it comes and goes. T, the error of a
//! trapezoid, is none in a spring that does not turn, and O(Δt³) in one that does. And f has the damping
//! of what is crushed in it, which takes. What is carried weighs M′ to the method: then a = M′⁻¹ f, and
//! it is ½ v M′v that gains by those forces, so ½ v M′v − K is a part of S.
//!
//! **Methods that move by the forces at the end** ([`Motion`]) solve M (v₁ − v*) = h (f − c M v₁). Of
//! backward Euler, PBD and XPBD v* = v₀ and h = Δt, so that δ = h v₁. With n = M (v₁ − v*)/h
//!
//! ```text
//! K₁ − K₀ = n·δ + [K₁ − K₀ − n·δ],      backward Euler: [ ] = −½ Σ m|v₁ − v₀|²
//! E₁ − E₀ = −f·δ + [E₁ − E₀ + f·δ],     f = −∇E(x₁):    [ ] ≤ 0 where E is convex
//! ```
//!
//! The first bracket is damping of motion; of BDF2 it is the end of a G-norm, small and mostly given
//! back (Dahlquist 1976; Hairer and Wanner 1996 §V.6). The second is minus the Bregman distance of E,
//! −½ k (l₁ − l₀)² in a spring that does not turn, where Newton's method has found its equation's root.
//! Where it has not, as in linearised steps, f is the force that it used nevertheless. That of a method
//! that projects is the impulse M (x₁ − x̃)/Δt² of its corrections to the predicted x̃ (Macklin, Müller and
//! Chentanez 2016 §4), and with few sweeps it is not the force which lengths stand for.
//!
//! What air does is in those forces, as the method feels it; the balance of energy takes away what air
//! does on the way as it was. So what drag and wind do wrong in a step is the method's too, but for
//! the drag of Verlet, of second order. Gravity is exact.
//!
//! What hands do is the force at them times their way, and is taken from the constraints of each, as a
//! method leaves them behind.

use tearmesh::geometry::{Point, Vector, dot};

use crate::carry::Carry;
use crate::constraint::Constraints;
use crate::flight::force_scale;
use crate::force;
use crate::meter::Energy;
use crate::system::{Model, System};

/// The account of a step of velocity Verlet, as far as it has got.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Account {
    dt_s: f64,
    made_j: f64,
}

impl Account {
    /// Opens it, where someone asks: accelerations are those of now, and of the end of the last step
    /// where they are fresh.
    pub(crate) fn open(system: &mut System, is_fresh: bool, dt_s: f64) -> Option<Account> {
        system.meter.is_asked().then(|| {
            let elastic_j = elastic_before_j(system, |system| &system.positions);
            let hand_j = half_of_hands_j(system, dt_s);
            let kept = system.meter.left(system.state());
            let kept = kept.and_then(|kept| kept.swing);
            let kept = kept.filter(|&(of_s, _)| is_fresh && of_s == dt_s);
            let swung_j = kept.map_or_else(|| swing_j(system, dt_s), |(_, swung_j)| swung_j);
            Account {
                dt_s,
                made_j: hand_j - elastic_j - swung_j,
            }
        })
    }

    /// Half of the work of the present accelerations at the velocities in the middle of the step.
    pub(crate) fn fly(&mut self, system: &System) {
        let (model, gravity) = (&system.model, system.model.gravity());
        let (a, v) = (&system.scratch.accelerations, &system.velocities);
        let power = match carried(system) {
            Some(carry) => {
                let particles = model.masses.iter().zip(&model.inverse_masses).zip(v);
                let weight = particles.fold(0.0, |sum, ((m, &w), &v)| {
                    sum + if w > 0.0 { m * dot(gravity, v) } else { 0.0 }
                });
                // Drag fades the velocities of M′.
                let faded = match model.drag_per_s() {
                    0.0 => 0.0,
                    drag_per_s => drag_per_s * (carry.product(v, v) - twice_kinetic(model, v)),
                };
                carry.product(a, v) - weight - faded
            }
            None => {
                let particles = model.masses.iter().zip(&model.inverse_masses);
                let particles = particles.zip(a.iter().zip(v));
                particles.fold(0.0, |sum, ((m, &w), (a, &v))| {
                    sum + if w > 0.0 {
                        m * dot(a - gravity, v)
                    } else {
                        0.0
                    }
                })
            }
        };
        self.made_j += 0.5 * self.dt_s * power;
    }

    /// Closes it, when the step is taken, and notes what was made.
    pub(crate) fn close(self, system: &mut System) {
        let swung_j = swing_j(system, self.dt_s);
        let elastic_j = elastic_after_j(system, Some((self.dt_s, swung_j)));
        let end_j = elastic_j + half_of_hands_j(system, self.dt_s) + swung_j;
        system.meter.note(self.made_j + end_j);
    }
}

/// The elastic energy where a step begins: as the last one left it, unless something has changed since.
fn elastic_before_j(system: &mut System, from: fn(&System) -> &[Point]) -> f64 {
    let left = system.meter.left(system.state());
    // Or an earlier part of this substep left it.
    if let Some(left) = left.or_else(|| system.meter.left(system.next_state())) {
        return left.elastic_j;
    }
    system.counters.visits.meter += system.model.constraint_count();
    system.model.elastic_j(from(system))
}

/// The elastic energy where a step ends, with the swing that is kept for the next.
fn elastic_after_j(system: &mut System, swing: Option<(f64, f64)>) -> f64 {
    system.counters.visits.meter += system.model.constraint_count();
    let elastic_j = system.model.elastic_j(&system.positions);
    let energy = Energy { elastic_j, swing };
    system.meter.leave(system.next_state(), energy);
    elastic_j
}

/// What is carried in the present accelerations.
fn carried(system: &System) -> Option<&Carry> {
    let carry = Some(system.guard.carry()).filter(|carry| carry.len() > 0);
    carry.filter(|_| system.scratch.guarded_s > 0.0)
}

/// S − (½ v M′v − K).
fn swing_j(system: &System, dt_s: f64) -> f64 {
    let (model, v) = (&system.model, &system.velocities[..]);
    let a = &system.scratch.accelerations[..];
    let share = dt_s * dt_s / 8.0;
    match carried(system) {
        Some(carry) => {
            let more = carry.product(v, v) - twice_kinetic(model, v);
            share * carry.product(a, a) - 0.5 * more
        }
        None => share * twice_kinetic(model, a),
    }
}

/// Σ m|u|² over free particles.
fn twice_kinetic(model: &Model, u: &[Vector]) -> f64 {
    let particles = u.iter().zip(&model.masses).zip(&model.inverse_masses);
    particles.fold(0.0, |sum, ((&u, m), &w)| {
        sum + if w > 0.0 { m * dot(u, u) } else { 0.0 }
    })
}

/// The work of constraints on those who are led, in half a step, by their present lengths.
fn half_of_hands_j(system: &System, dt_s: f64) -> f64 {
    let led = system.model.grabbed.iter().map(|&(led, _)| led as usize);
    let watts = led.map(|led| {
        let weight = system.model.gravity() * system.model.masses[led];
        dot(force::inner_n(system, led) - weight, system.velocities[led])
    });
    0.5 * dt_s * watts.sum::<f64>()
}

/// A step of a method that moves by the forces at its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    /// The length of the step, in seconds.
    pub(crate) dt_s: f64,
    /// h.
    pub(crate) h: f64,
    /// c.
    pub(crate) drag_per_s: f64,
    pub(crate) gravity: Vector,
}

impl Motion {
    /// What a free particle of this mass has to do with it: v*, the velocities before and after, and the
    /// way.
    #[inline]
    pub(crate) fn made_j(self, mass: f64, from: Vector, [v, u]: [Vector; 2], way: Vector) -> f64 {
        let used = (u - from) / self.h;
        let squares = [dot(v, v), dot(u, u)];
        let motion = 0.5 * (squares[1] - squares[0]) - dot(used, way);
        let drag = 0.5 * self.dt_s * (squares[0] + squares[1]);
        let beside_gravity = dot(used - self.gravity, way);
        mass * (motion + beside_gravity + self.drag_per_s * drag)
    }
}

/// Notes what a method that projects made in a substep, where someone asks: after its last sweep, and
/// before velocities are taken from what was moved.
pub(crate) fn note_projected(system: &mut System, dt_s: f64) {
    if !system.meter.is_asked() {
        return;
    }
    let elastic_j = elastic_before_j(system, |system| &system.scratch.before);
    let (model, x) = (&system.model, &system.positions[..]);
    let before = &system.scratch.before[..];
    let motion = Motion {
        dt_s,
        h: dt_s,
        drag_per_s: model.drag_per_s(),
        gravity: model.gravity(),
    };
    let per_s = 1.0 / dt_s;
    let mut made_j = -elastic_j;
    for (i, &v) in system.velocities.iter().enumerate() {
        if model.inverse_masses[i] > 0.0 {
            let way = x[i] - before[i];
            made_j += motion.made_j(model.masses[i], v, [v, way * per_s], way);
        }
    }
    let scale = force_scale(model, dt_s);
    for family in [&model.stretch, &model.bend] {
        for &(led, _) in &model.grabbed {
            let pull = pull_n(model, family, x, led as usize, scale);
            made_j += dot(pull, x[led as usize] - before[led as usize]);
        }
    }
    made_j += elastic_after_j(system, None);
    system.meter.note(made_j);
}

/// The pull of a family's springs at a particle by their multipliers, of which `scale` makes forces.
fn pull_n(model: &Model, family: &Constraints, x: &[Point], led: usize, scale: f64) -> Vector {
    family.of(led).fold(Vector::zeros(), |sum, id| {
        let spring = family.get(id);
        let [a, b] = spring.ends;
        let other = a + b - led;
        let line = x[other] - x[led];
        let length = dot(line, line).sqrt();
        if length == 0.0 {
            return sum;
        }
        // What nobody but hands moves has the force of its length.
        let tension = if model.inverse_masses[other] > 0.0 {
            -family.memory(id).multiplier * scale
        } else {
            spring.stiffness_n_per_m * (length - spring.rest_length_m)
        };
        sum + line * (tension / length)
    })
}

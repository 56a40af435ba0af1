//! What a method itself makes of energy in a step, or takes where negative: computed from the forces that
//! it used and the way that particles went, and not from what the balance of energy lacks.
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
//! it is ½ v M′v that gains by those forces, so ½ v M′v − K is a part of S. M′a is never multiplied out: it
//! is what the forces are. E is summed up with them, and costs no pass of its own.
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
//! In the sum of both brackets n·δ drops out, whichever f a method used, as n is f with drag and weight.
//! What is left is the change of K + E + P, with P the potential of gravity, and what drag took,
//! c Δt (K₀ + K₁), and what hands got. Sums over states are those that the last step left, and so the account
//! takes one look at lengths a step. It also means that of
//! these methods the remainder tells how meter and method differ about drag and hands, and no more.
//!
//! What air does is in those forces, as the method feels it; the balance of energy takes away what air
//! does on the way as it was. So what drag and wind do wrong in a step is the method's too, but for
//! the drag of Verlet. Gravity is exact.
//!
//! **Drag by Verlet** acts on velocities, and so takes c Δt v½·M′(v₀ + v₁)/2 in a step: of that the part of
//! M′ − M is the method's. (With v½·(M′ − M) v½ for it c Δt³/4 a·(M′ − M) a was left in each step, and
//! .04 % of a flag in slivers.) The part of M is the balance's trapezoid c Δt (K₀ + K₁) less
//! c Δt³/4 d(Σ m a·v)/dt: a sum of which c Δt²/4 Σ m a·v at its ends is left. That is of second order in one
//! motion, and measured so: a flag of 16 × 16 cells that is not cut yet leaves 1.69e-7, 4.29e-8, 1.08e-8 and
//! 2.71e-9 of what was put in at 1, ½, ¼ and ⅛ of its step. Once it has been cut each step leads to
//! another motion, and to other ends: 8e-8, 5e-8, 1.2e-8, 4e-9.
//!
//! What hands do is the force at them times their way, and is taken from the constraints of each, as a
//! method leaves them behind.

use tearmesh::geometry::{Point, Vector, dot};

use crate::carry::Carry;
use crate::constraint::Constraints;
use crate::contact;
use crate::flight::{Felt, force_scale};
use crate::force;
use crate::meter::{Energy, Free, FreeSum, More};
use crate::system::{Model, System};

/// The account of a step of velocity Verlet, as far as it has got.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Account {
    dt_s: f64,
    made_j: f64,
    /// Σ a M′a where the step ends.
    square: f64,
}

impl Account {
    /// Opens it, where someone asks. Accelerations are those of now: taken just so, or in the last step.
    pub(crate) fn open(system: &mut System, taken: Option<Felt>, dt_s: f64) -> Option<Account> {
        if !system.meter.is_asked() {
            return None;
        }
        let left = system.meter.left(system.state());
        let swung_j = left.and_then(|left| match left.more {
            More::Swing { of_s, joules } if of_s == dt_s && taken.is_none() => Some(joules),
            More::Swing { .. } | More::Free(_) => None,
        });
        let felt_j = taken.and_then(|felt| felt.elastic_j);
        let elastic_j = match left.map(|left| left.elastic_j).or(felt_j) {
            Some(elastic_j) => elastic_j,
            None => system.elastic_j(),
        };
        let hand_j = hands_j(system, 0.5 * dt_s);
        let swung_j = match swung_j {
            Some(swung_j) => swung_j,
            None => swing_j(system, dt_s, power_and_square(system)[1]),
        };
        Some(Account {
            dt_s,
            made_j: hand_j - elastic_j - swung_j,
            square: 0.0,
        })
    }

    /// Half of the work of the forces at the beginning, at the velocities in the middle of the step.
    pub(crate) fn fly(&mut self, system: &System) {
        let (forces, v) = (&system.scratch.forces, &system.velocities);
        let particles = forces.iter().zip(v).zip(&system.model.inverse_masses);
        let power = particles.fold(0.0, |sum, ((&f, &v), &w)| {
            sum + if w > 0.0 { dot(f, v) } else { 0.0 }
        });
        self.made_j += 0.5 * self.dt_s * power;
        self.fade(system, -0.5 * self.dt_s);
    }

    /// The other half, of the forces at the end at the same velocities.
    pub(crate) fn land(&mut self, system: &System) {
        let [power, square] = power_and_square(system);
        self.made_j += 0.5 * self.dt_s * power;
        self.square = square;
        self.fade(system, 0.5 * self.dt_s);
    }

    /// Takes away half of what drag takes from M′ beyond M. The velocity of one end of the step is
    /// that of the middle, accelerated for `kick_s` seconds.
    fn fade(&mut self, system: &System, kick_s: f64) {
        let drag_per_s = system.model.drag_per_s();
        if let Some(carry) = carried(system).filter(|_| drag_per_s > 0.0) {
            let (v, a) = (&system.velocities, &system.scratch.accelerations);
            let beyond = carry.beyond(v, |i| v[i] + a[i] * kick_s);
            self.made_j -= 0.5 * self.dt_s * drag_per_s * beyond;
        }
    }

    /// Closes it, when the step is taken, and notes what was made. The elastic energy was felt with the
    /// forces at the end.
    pub(crate) fn close(self, system: &mut System, felt: Felt) {
        let elastic_j = felt.elastic_j.unwrap_or(0.0);
        let swung_j = swing_j(system, self.dt_s, self.square);
        let more = More::Swing {
            of_s: self.dt_s,
            joules: swung_j,
        };
        let energy = Energy { elastic_j, more };
        system.meter.leave(system.next_state(), energy);
        let end_j = elastic_j + hands_j(system, 0.5 * self.dt_s) + swung_j;
        system.meter.note(self.made_j + end_j);
    }
}

/// Over free particles, Σ f v of the forces beside weight and of the velocities, and Σ a M′a: M′a is
/// what all forces are.
fn power_and_square(system: &System) -> [f64; 2] {
    let (model, scratch, gravity) = (&system.model, &system.scratch, system.model.gravity());
    let particles = scratch.forces.iter().zip(&scratch.accelerations);
    let particles = particles.zip(&system.velocities);
    let weights = model.masses.iter().zip(&model.inverse_masses);
    let mut sums = [0.0; 2];
    for (((&f, &a), &v), (&m, &w)) in particles.zip(weights) {
        if w > 0.0 {
            sums[0] += dot(f, v);
            sums[1] += dot(f + gravity * m, a);
        }
    }
    sums
}

/// What is carried in the present accelerations.
fn carried(system: &System) -> Option<&Carry> {
    let carry = Some(system.guard.carry()).filter(|carry| carry.len() > 0);
    carry.filter(|_| system.scratch.guarded_s > 0.0)
}

/// S − (½ v M′v − K), by Σ a M′a.
fn swing_j(system: &System, dt_s: f64, square: f64) -> f64 {
    let v = &system.velocities;
    let beyond = carried(system).map_or(0.0, |carry| carry.beyond(v, |i| v[i]));
    dt_s * dt_s / 8.0 * square - 0.5 * beyond
}

/// The work of constraints on led particles over `dt_s` seconds, at the present lengths.
fn hands_j(system: &System, dt_s: f64) -> f64 {
    let led = system.model.grabbed.iter().map(|&(led, _)| led as usize);
    let watts = led.map(|led| {
        let weight = system.model.gravity() * system.model.masses[led];
        dot(force::inner_n(system, led) - weight, system.velocities[led])
    });
    dt_s * watts.sum::<f64>()
}

/// The account of a step of a method that moves by the forces at the end, as far as it has got.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    made_j: f64,
    /// K where the present part of the step began.
    kinetic_j: f64,
    /// What constraints did on the way of those who are led.
    led_j: f64,
}

impl Motion {
    /// Opens it where the step begins, where someone asks.
    pub(crate) fn open(system: &mut System) -> Option<Motion> {
        if !system.meter.is_asked() {
            return None;
        }
        let left = system.meter.left(system.state());
        let elastic_j = match left {
            Some(left) => left.elastic_j,
            None => system.elastic_j(),
        };
        let free = match left.map(|left| left.more) {
            Some(More::Free(free)) => free,
            Some(More::Swing { .. }) | None => free_energy(system),
        };
        Some(Motion {
            made_j: -(elastic_j + free.total_j()),
            kinetic_j: free.kinetic_j,
            led_j: 0.0,
        })
    }

    /// Counts what hands get by the lengths where the step ends.
    pub(crate) fn lead(&mut self, system: &System, dt_s: f64) {
        self.led_j += hands_j(system, dt_s);
    }

    /// Counts what hands get from the springs of a method that projects, by their multipliers on the way
    /// of a substep: after its last sweep.
    pub(crate) fn project(&mut self, system: &System, dt_s: f64) {
        let (model, x) = (&system.model, &system.positions[..]);
        let scale = force_scale(model, dt_s);
        for family in [&model.stretch, &model.bend] {
            for &(led, _) in &model.grabbed {
                let led = led as usize;
                let pull = pull_n(model, family, x, led, scale);
                self.led_j += dot(pull, x[led] - system.scratch.before[led]);
            }
        }
    }

    /// Ends a substep with this energy of free particles, has colliders push, and begins the next.
    pub(crate) fn turn(&mut self, system: &mut System, dt_s: f64, free: Free) {
        self.made_j += system.model.drag_per_s() * dt_s * (self.kinetic_j + free.kinetic_j);
        self.kinetic_j = free.kinetic_j;
        if !system.model.loads.colliders.is_empty() {
            self.made_j += system.elastic_j() + free.total_j();
            contact::push_out(system);
            let free = free_energy(system);
            self.made_j -= system.elastic_j() + free.total_j();
            self.kinetic_j = free.kinetic_j;
        }
    }

    /// Closes the account when the step is taken, and notes the energy that was made. `dt_s` is the
    /// length of the last substep, and `free` the energy that it left in free particles.
    pub(crate) fn close(mut self, system: &mut System, dt_s: f64, free: Free) {
        let state = system.next_state();
        let elastic_j = system.elastic_j();
        self.made_j += system.model.drag_per_s() * dt_s * (self.kinetic_j + free.kinetic_j);
        let made_j = self.made_j + self.led_j;
        system.meter.note(made_j + elastic_j + free.total_j());
        system.meter.note_led(self.led_j);
        let more = More::Free(free);
        system.meter.leave(state, Energy { elastic_j, more });
    }
}

/// The energy of free particles.
pub(crate) fn free_energy(system: &System) -> Free {
    let model = &system.model;
    let particles = system.positions.iter().zip(&system.velocities);
    let weights = model.masses.iter().zip(&model.inverse_masses);
    let mut sum = FreeSum::default();
    for ((&x, &v), (&mass, &inverse_mass)) in particles.zip(weights) {
        sum.add([mass, inverse_mass], x, v);
    }
    sum.energy(model.gravity())
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

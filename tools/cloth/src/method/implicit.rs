//! Implicit time steps in the manner of Baraff and Witkin 1998 ("Large steps in cloth simulation"):
//! linearised backward Euler and BDF2, solved by conjugate gradients.
//!
//! **When to use it.** When Δt must be far above the explicit limit 2/ω, or to find a state of
//! rest. Backward Euler damps all motion: an oscillation of frequency ω by the factor 1/√(1 +
//! (ωΔt)²) per step. At 60 steps per second an oscillation of 5 Hz loses 99.9 % of its amplitude in
//! a second. BDF2 is of order two and damps far less, by a factor of about 1 − ¼ (ωΔt)⁴ per step.
//! For uniform cloth an explicit method at its limit is cheaper at the same accuracy.
//!
//! **The equation.** Both solve, for the new velocity v,
//!
//! ```text
//! M (v − v*) = h [ f(x* + h v) − c M v ]
//! backward Euler   x* = x₀,                     v* = v₀,                     h = Δt
//! BDF2             x* = x₀ + (x₀ − x₋₁)/3,      v* = v₀ + (v₀ − v₋₁)/3,      h = 2Δt/3
//! ```
//!
//! with forces linearised at x₀, as Baraff and Witkin §3 and Choi and Ko 2002 §5 do. This keeps the
//! order of both methods, as long as the derivatives are exact. BDF2 here also takes steps of
//! different length: with ω = Δt/Δt₋₁ the weight 1/3 becomes ω²/(1 + 2ω) and 2/3 becomes
//! (1 + ω)/(1 + 2ω). (Written as x₀ plus a difference, so that what stands still stands still to the
//! last bit.) Where a particle is held its velocity is given, and it goes on by Δt v:
//! x* = x₀ + (Δt − h) v and v* = v, whatever it did before.
//!
//! **Indefinite matrices.** M (1 + h c)/h² + H is indefinite where something is compressed and
//! Δt is long: between two springs from Δt > √(m / (2k (L₀/l − 1))). Where conjugate gradients find
//! that, the step is solved again without the terms that may be indefinite (Choi and Ko 2002);
//! always without them BDF2 would be of order one.
//!
//! **Overshoot.** A linearised step trusts its matrix however far it goes. A piece of one or two
//! triangles that spins by ω Δt > 1 flies apart along the tangent, to √(1 + (ω Δt)²) times its size;
//! where something is pushed together the matrix may be all but singular, and the step as long as
//! one likes. Both show in a length that no linearised force has felt: an edge ends longer than it
//! is at rest, was before, and would be if its ends had moved along it. And they make energy: there is
//! more at the end than there was and than loads and hands put in. A step in which an edge is longer by
//! 30 % of its rest length, or that makes .3 % of the energy in motion and exchange, is divided in two
//! halves, and these again. (Without the first, ready scenes make 2 to 3100 J where 1 to 17 J were put
//! in. Without the second, chains that were pushed once come to 300 times their energy by steps a
//! thousand times as long as the explicit limit. Newton's method from where such a step began takes 1.3
//! times as many matrix products in ready scenes, and stretches edges to twice their length where this,
//! at 15 %, stayed below 1.15.)
//!
//! **The solver's tolerance has to fall with Δt.** A step of a method of order p errs by
//! Δt^(p+1); a solver that leaves the same error at each step, however short, makes the sum
//! grow as Δt falls. So the rms velocity error that a step may leave is T Δt^(p+1). And it misses
//! no more than a tenth of its change, by energy: where T Δt^p is above g, what
//! hangs would hover.
//!
//! **Momentum.** Internal forces sum to zero, so the exact answer has a known momentum for each
//! piece that nothing holds. What the solver's residual misses of it is added as one
//! velocity of the whole piece: momentum is kept to rounding, at any tolerance. Angular
//! momentum is not kept by these methods.
//!
//! **Wind** depends on velocities and areas, and its derivatives are in no matrix. BDF2 takes it at
//! x₀ + ω (x₀ − x₋₁) and v₀ + ω (v₀ − v₋₁), which err by O(Δt²); taken where the step begins it
//! would make the method one of order one. In still air alone steps of one length obey
//! 3z² − 4z + 1 + 2μ (2z − 1) = 0 with μ = λΔt, which has the root −1 at μ = 4/3; one that is ω times
//! as long as the last has its limit at μ = 2 (1 + ω)/(1 + 2ω). Springs only raise it.

pub(crate) mod settings;
mod stage;
mod touching;

use tearmesh::geometry::{Point, Vector, dot, length};

pub use self::settings::{Method, Settings, Stats, StepError};
use self::stage::Stage;
use self::touching::Touching;
use crate::method::solver::{Abilities, Failure, Quality, Solver};
use crate::system::System;
use crate::system::blow_up::{first, is_beyond};
use crate::system::collide;
use crate::system::error::SettingError;
use crate::system::matrix::{Hessian, Pcg, Solution, Stop, Weights};
use crate::system::model::Model;

/// Linearised implicit steps of a system: backward Euler or BDF2. They are stable at any step for
/// springs, triangles, bends and drag. Backward Euler evaluates wind where a step begins, and is
/// stable up to λ Δt = 2 ([`air_rate`](crate::air::air_rate)). BDF2 extrapolates positions and
/// velocities for wind from the last step, which keeps its order, and is stable up to λ Δt = 4/3.
///
/// A solver steps one system. BDF2 remembers the last step, and goes on from it if at least one of
/// the particles that it moved is still, to the last bit, where it left it, and no particle came or
/// went. So it keeps its order if contact or a user changes other positions and velocities: BDF2
/// then continues with the accelerations of the last step, and what lands does not bounce. Otherwise
/// (another system, a step undone, a tear) it begins again with a step of backward Euler, and also if
/// the step is more than 1 + √2 times as long as the last, where it would not be stable.
///
/// ```
/// use tearmesh_cloth::implicit::{self, Settings};
/// use tearmesh_cloth::{Implicit, Loads, StepError, System};
/// use tearmesh::{Point, Vector};
///
/// let mut spring = System::new([Point::origin(), Point::new(0.0, 0.0, -1.0)], vec![0.1; 2])?;
/// spring.stretch([0, 1], 1.0, 50.0)?;
/// spring.hold(0);
/// let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -9.81));
/// spring.set_loads(Loads { gravity_m_per_s2, ..Loads::default() })?;
/// let mut solver = Implicit::new(Settings::default());
/// for _ in 0..200 {
///     spring.step(&mut solver, 0.5)?; // Far beyond the limit of an explicit method.
/// }
/// assert!((spring.positions()[1].z + 1.0 + 0.1 * 9.81 / 50.0).abs() < 1e-8);
///
/// // A step that misses its tolerance is not taken, and says by how much it misses.
/// let settings = Settings { solver_iterations_max: 0, ..Settings::default() };
/// spring.state_mut().1[1] = Vector::new(0.3, 0.0, 1.0);
/// let error = spring.step(&mut Implicit::new(settings), 0.5).unwrap_err();
/// let StepError::Implicit { error, .. } = error else { unreachable!() };
/// let implicit::StepError::NotConverged { residual, limit, .. } = error else { unreachable!() };
/// assert!(residual > limit);
/// assert_eq!(spring.velocities()[1], Vector::new(0.3, 0.0, 1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Implicit {
    /// The settings of this method.
    pub settings: Settings,
    stats: Stats,
    history: History,
    hessian: Hessian,
    pcg: Pcg,
    /// The accelerations by gravity and wind, which do not change in a step; and all forces at its
    /// start but drag.
    outside: Vec<Vector>,
    forces: Vec<Vector>,
    /// x* and v*.
    start: Vec<Point>,
    start_velocities: Vec<Vector>,
    /// What a step reaches: x* + h v and v.
    reached: Vec<Point>,
    velocities: Vec<Vector>,
    /// The momentum that each piece misses; what the positions of a guess of velocities differ by from
    /// x₀; and what those that a step reaches do.
    shift: Vec<Vector>,
    piece_masses: Vec<f64>,
    touching: Vec<Touching>,
}

/// The part of its change that a step misses, at most, by energy.
const MISSING_MAX: f64 = 0.1;

/// The part of both that may be left where something touches: what goes into a body is pushed out, which makes
/// energy (5 % of what was put in, where a sheet falls on a box).
const IN_CONTACT: f64 = 0.01;

/// The part of its rest length by which an edge may end longer than a linearised step knows of. (At
/// .15 a quarter of the solves of a rip are thrown away, for nothing that shows; at .6 no step of a drop onto a body is divided.)
const OVERSHOOT: f64 = 0.3;

/// The energy that a step may make, as a part of what moves and changes hands in it. (At .005 chains that
/// were pushed once come to twice their energy by steps of a thousand times the explicit limit; at .002
/// more of these are divided into the shortest parts.)
const MADE: f64 = 0.003;

impl Implicit {
    /// Returns an implicit method with these settings.
    #[must_use]
    pub fn new(settings: Settings) -> Implicit {
        Implicit {
            settings,
            ..Implicit::default()
        }
    }

    /// Takes a step, or its halves where it overshoots.
    fn divide(&mut self, system: &mut System, dt_s: f64, parts: u32) -> Result<(), Failure> {
        let is_last = parts >= StepError::PARTS_MAX;
        if self.part(system, dt_s, is_last)? {
            return Ok(());
        }
        if is_last {
            return Err(Failure::Implicit(StepError::Overshot));
        }
        self.divide(system, 0.5 * dt_s, 2 * parts)?;
        self.divide(system, 0.5 * dt_s, 2 * parts)
    }

    /// Takes a step, in place; false if it overshot and was not taken. The last that is tried may make
    /// energy. A particle that is held keeps its velocity.
    ///
    /// Cost: an evaluation of forces and second derivatives, and a product with the matrix an
    /// iteration of conjugate gradients.
    fn part(&mut self, system: &mut System, dt_s: f64, is_last: bool) -> Result<bool, Failure> {
        let is_bdf2 = self.settings.method == Method::Bdf2;
        let known = Some(&self.history).filter(|_| is_bdf2);
        let known = known.and_then(|history| history.ratio(&system.positions, dt_s));
        self.blow(system, known);
        let (count, model) = (system.positions.len(), &system.model);
        self.hessian.follow(count, model.pairs());
        let stage = self.begin(system, known, dt_s);
        let solution = self.solve(system, stage);
        let velocity = |acceleration: f64| acceleration * stage.h / stage.dragged;
        let error = velocity(solution.error);
        let is_solved = solution.error <= solution.limit;
        if !is_solved {
            return Err(Failure::Implicit(StepError::NotConverged {
                residual: error,
                limit: velocity(solution.limit),
                solver_iterations: solution.iterations,
            }));
        }
        self.keep_momentum(system.model.weights(), stage);
        let ends = self.start.iter().zip(&self.velocities);
        refill(&mut self.reached, ends.map(|(x, v)| x + v * stage.h));
        if let Some(particle) = first(is_beyond, &self.reached, &self.velocities) {
            return Err(Failure::Implicit(StepError::NotFinite { particle }));
        }
        if overstretches(&system.model, &system.positions, &self.reached) {
            return Ok(false);
        }
        let ways = self.reached.iter().zip(&system.positions);
        refill(&mut self.shift, ways.map(|(to, x)| to - x));
        // The shortest part is taken also if it makes energy: what is left then is the solver's error, which
        // no shorter one would lower.
        system.model.count_visits(1, &mut system.counters);
        let to_j = system.model.elastic_j(&self.reached);
        if !is_last && self.makes_energy(system, stage, to_j) {
            return Ok(false);
        }
        for at in &mut self.touching {
            at.press(system, stage, (&self.shift, &self.velocities));
        }
        self.history.note(system, &self.reached, &self.velocities);
        self.history.time_step_s = dt_s;
        system.positions.copy_from_slice(&self.reached);
        system.velocities.copy_from_slice(&self.velocities);
        self.stats.parts += 1;
        self.stats.first_order_parts += u64::from(known.is_none());
        self.stats.residual_max_m_per_s = self.stats.residual_max_m_per_s.max(error);
        Ok(true)
    }

    /// The accelerations by gravity and wind: where the step begins, or where going on as in the last
    /// step leads.
    fn blow(&mut self, system: &mut System, ratio: Option<f64>) {
        let (x, v) = (&system.positions, &system.velocities);
        let (model, counters) = (&system.model, &mut system.counters);
        self.outside.clear();
        self.outside.resize(x.len(), Vector::zeros());
        let Some(ratio) = ratio.filter(|_| model.loads.wind.is_some()) else {
            model.blow(x, v, &mut self.outside, counters);
            return model.weigh(&mut self.outside);
        };
        self.reached.clear();
        self.velocities.clear();
        for (i, (x, &v)) in x.iter().zip(v).enumerate() {
            let [moved, sped] = if model.inverse_masses[i] > 0.0 {
                self.history.changes(i, v)
            } else {
                [v * self.history.time_step_s, Vector::zeros()]
            };
            self.reached.push(x + moved * ratio);
            self.velocities.push(v + sped * ratio);
        }
        model.blow(&self.reached, &self.velocities, &mut self.outside, counters);
        model.weigh(&mut self.outside);
    }

    /// x* and v*; with the velocities now as the first guess, and the momentum of the answer.
    fn begin(&mut self, system: &System, ratio: Option<f64>, dt_s: f64) -> Stage {
        let (x, v) = (&system.positions, &system.velocities);
        let model = &system.model;
        x.clone_into(&mut self.start);
        v.clone_into(&mut self.start_velocities);
        v.clone_into(&mut self.velocities);
        let mut h = dt_s;
        if let Some(ratio) = ratio {
            let weight = ratio * ratio / (1.0 + 2.0 * ratio);
            h = dt_s * (1.0 + ratio) / (1.0 + 2.0 * ratio);
            for (i, &v) in v.iter().enumerate() {
                if model.inverse_masses[i] > 0.0 {
                    let [moved, sped] = self.history.changes(i, v);
                    self.start[i] += moved * weight;
                    self.start_velocities[i] += sped * weight;
                } else {
                    self.start[i] += v * (dt_s - h);
                }
            }
        }
        let dragged = 1.0 + h * model.drag_per_s();
        // The order is that of the method asked for, also where it starts.
        let by_order = match self.settings.method {
            Method::BackwardEuler => self.settings.tolerance * dt_s * dt_s,
            Method::Bdf2 => self.settings.tolerance * dt_s * dt_s * dt_s,
        };
        let stage = Stage {
            dt_s,
            h,
            dragged,
            error_max: by_order * dragged / h,
        };
        self.keep_momentum(model.weights(), stage);
        let guess = self.start.iter().zip(&self.velocities);
        let guess = guess.map(|(s, v)| s + v * h);
        refill(&mut self.shift, guess.zip(x).map(|(y, x)| y - x));
        stage
    }

    /// The velocities that solve the linearised equation.
    fn solve(&mut self, system: &mut System, stage: Stage) -> Solution {
        let (x, v) = (&system.positions, &self.velocities);
        let (model, weights) = (&system.model, system.model.weights());
        let loads = self.outside.iter().zip(weights.masses);
        refill(&mut self.forces, loads.map(|(g, m)| g * *m));
        // What is far too long is found in the state in which a step ends.
        let _unlimited = model.add_forces(x, None, &mut self.forces);
        let strictness = if self.touching.is_empty() {
            1.0
        } else {
            IN_CONTACT
        };
        let stop = Stop {
            error_max: strictness * stage.error_max,
            missing_max: strictness * MISSING_MAX,
            iterations_max: self.settings.solver_iterations_max,
        };
        let (mut sums, mut is_clamped) = (1, false);
        let solution = loop {
            self.hessian.clear();
            let clamped = model.add_hessian(x, is_clamped, &mut self.hessian);
            for at in &mut self.touching {
                at.measure((&*system, &self.hessian), weights, stage);
            }
            for at in &self.touching {
                at.stiffen(&mut self.hessian);
            }
            let pcg = &mut self.pcg;
            self.hessian.product(&self.shift, &mut pcg.b);
            for (i, b) in pcg.b.iter_mut().enumerate() {
                let change = v[i] * stage.dragged - self.start_velocities[i];
                *b = self.forces[i] - *b - change * (weights.masses[i] / stage.h);
            }
            for at in &self.touching {
                at.carry(stage, &mut pcg.b);
            }
            let solution = pcg.solve(
                &self.hessian,
                weights,
                stage.dragged / (stage.h * stage.h),
                stop,
                |i| x[i].coords.amax(),
            );
            sums += 2 + u64::from(solution.iterations);
            self.stats.solver_iterations += u64::from(solution.iterations);
            system.counters.matrix_products += 1 + u64::from(solution.iterations);
            if !solution.is_indefinite || is_clamped {
                self.stats.clamped += clamped;
                break solution;
            }
            self.stats.indefinite += 1;
            is_clamped = true;
        };
        system.counters.force_evaluations += 1;
        // And two for lengths at the end.
        model.count_visits(sums + 2, &mut system.counters);
        for (v, d) in self.velocities.iter_mut().zip(&self.pcg.delta) {
            *v += d / stage.h;
        }
        solution
    }

    /// Whether the step ends with more energy than there was and was put in, by gravity, by wind and by
    /// those that are held; by more than a part of what moves and changes hands, and than what rounding of
    /// positions makes. `to_j` is the elastic energy at its end.
    fn makes_energy(&mut self, system: &mut System, stage: Stage, to_j: f64) -> bool {
        let (x, v) = (&system.positions, &system.velocities);
        let (model, weights) = (&system.model, system.model.weights());
        model.count_visits(1, &mut system.counters);
        let from_j = model.elastic_j(x);
        let moved = &self.shift;
        let pulls = &mut self.pcg.b;
        // The forces that hold still do no work.
        let is_led = |i: usize| !weights.is_free(i) && moved[i] != Vector::zeros();
        if (0..moved.len()).any(is_led) {
            self.hessian.product(moved, pulls);
            system.counters.matrix_products += 1;
            model.count_visits(1, &mut system.counters);
        }
        let (mut moving_j, mut gained_j, mut work_j) = (0.0, 0.0, 0.0);
        for (i, &m) in weights.masses.iter().enumerate() {
            let kinetic_j = |v: Vector| 0.5 * m * dot(v, v);
            moving_j += kinetic_j(v[i]);
            let mut load = self.outside[i] * m;
            if weights.is_free(i) {
                gained_j += kinetic_j(self.velocities[i]) - kinetic_j(v[i]);
            } else {
                // With the force that holds it, as linearised forces have it in the middle of the step.
                load += pulls[i] * 0.5 - self.forces[i];
            }
            work_j += dot(load, moved[i]);
        }
        let carried = self.touching.iter().map(|at| at.work_j(stage, moved));
        work_j += carried.sum::<f64>();
        let grain_m = f64::EPSILON * x.iter().map(|p| p.coords.amax()).fold(0.0, f64::max);
        let stiffness = self.hessian.trace().max(0.0);
        let rounding_j =
            grain_m * ((from_j + to_j) * stiffness).sqrt() + stiffness * grain_m * grain_m;
        let changed_j = to_j - from_j;
        let made_j = changed_j + gained_j - work_j;
        made_j > MADE * (moving_j + work_j.abs() + changed_j.abs()) + rounding_j
    }

    /// Gives each piece that nothing holds the momentum that the exact answer has.
    fn keep_momentum(&mut self, weights: Weights<'_>, stage: Stage) {
        let pieces = &self.hessian.pieces;
        // By lowest particle: the momentum that is missing; the mass, or NaN where something is
        // held.
        let missing = &mut self.shift;
        missing.clear();
        missing.resize(pieces.len(), Vector::zeros());
        self.piece_masses.clear();
        self.piece_masses.resize(pieces.len(), 0.0);
        for (i, &piece) in pieces.iter().enumerate() {
            let (piece, m) = (piece as usize, weights.masses[i]);
            let target = self.start_velocities[i] + self.outside[i] * stage.h;
            missing[piece] += (target - self.velocities[i] * stage.dragged) * m;
            self.piece_masses[piece] += if weights.is_free(i) { m } else { f64::NAN };
        }
        for i in self.touching.iter().flat_map(Touching::corners) {
            self.piece_masses[pieces[i] as usize] = f64::NAN;
        }
        for (v, &piece) in self.velocities.iter_mut().zip(pieces) {
            let mass = self.piece_masses[piece as usize];
            if mass > 0.0 {
                *v += missing[piece as usize] / (mass * stage.dragged);
            }
        }
    }
}

impl Solver for Implicit {
    /// Returns the abilities of the method. The air limit of BDF2 is that of steps of equal length.
    /// It is below that of backward Euler, with which BDF2 begins.
    fn abilities(&self) -> Abilities {
        let air_limit = match self.settings.method {
            Method::BackwardEuler => 2.0,
            Method::Bdf2 => 4.0 / 3.0,
        };
        Abilities::of_forces(None, air_limit)
    }

    fn check(&self) -> Result<(), SettingError> {
        SettingError::unless_above_0("tolerance", self.settings.tolerance)
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        system.keep();
        system.scratch.is_fresh = false;
        // What BDF2 remembers of corners that were pushed out draws them in again, and nothing comes to rest.
        let is_bdf2 = self.settings.method == Method::Bdf2;
        let contacts = collide::contacts(system).iter();
        let known = contacts.filter(|contact| !is_bdf2 || contact.corners.count == 1);
        let known = known.map(|contact| Touching::new(system, contact));
        refill(&mut self.touching, known);
        // A state that is too far away or too fast already is no matter of the method.
        Failure::unless(first(is_beyond, &system.positions, &system.velocities).is_none())?;
        let before = self.stats;
        let done = self.divide(system, dt_s, 1).and_then(|()| {
            let ratio_max = system.model.stretch_ratio_max;
            let too_long = system.model.longest_beyond(&system.positions, ratio_max);
            Failure::unless(too_long.is_none())
        });
        match done {
            Ok(()) => system.counters.overshoots += u64::from(self.stats.parts > before.parts + 1),
            Err(_) => self.stats = before,
        }
        done
    }

    fn quality(&self, _system: &System) -> Quality {
        Quality::Implicit(self.stats)
    }
}

/// What BDF2 remembers of the last step.
#[derive(Clone, Debug, Default)]
struct History {
    /// x₀ − x₋₁ and v₀ − v₋₁ as the step left them.
    moved: Vec<Vector>,
    sped: Vec<Vector>,
    /// x₀ and v₀ as the step left them.
    positions: Vec<Point>,
    velocities: Vec<Vector>,
    time_step_s: f64,
}

impl History {
    /// The length of a step from here of `dt_s` seconds as a multiple of the last; `None` if the last
    /// step did not lead here, or the method would not be stable.
    fn ratio(&self, x: &[Point], dt_s: f64) -> Option<f64> {
        // What contact pushed is elsewhere; what did not move is here before and after the step.
        let mut moving = (0..self.moved.len()).filter(|&i| self.moved[i] != Vector::zeros());
        let is_known = self.positions.len() == x.len() && self.time_step_s > 0.0;
        let leads_here =
            is_known && (self.positions == x || moving.any(|i| self.positions[i] == x[i]));
        let ratio = dt_s / self.time_step_s;
        (leads_here && ratio <= 1.0 + std::f64::consts::SQRT_2).then_some(ratio)
    }

    /// Notes what a step reaches from where a system is.
    fn note(&mut self, system: &System, reached: &[Point], velocities: &[Vector]) {
        let ends = reached.iter().zip(&system.positions);
        refill(&mut self.moved, ends.map(|(to, x)| to - x));
        let ends = velocities.iter().zip(&system.velocities);
        refill(&mut self.sped, ends.map(|(to, v)| to - v));
        reached.clone_into(&mut self.positions);
        velocities.clone_into(&mut self.velocities);
    }

    /// x₀ − x₋₁ and v₀ − v₋₁ for a particle whose velocity is now `v`. What is remembered is
    /// acceleration, so that what lands does not bounce.
    fn changes(&self, i: usize, v: Vector) -> [Vector; 2] {
        let pushed = v - self.velocities[i];
        [self.moved[i] + pushed * self.time_step_s, self.sped[i]]
    }
}

/// Puts these items in the place of all that a list has, in the room that it has.
fn refill<T>(list: &mut Vec<T>, items: impl Iterator<Item = T>) {
    list.clear();
    list.extend(items);
}

/// Whether an edge, or a triangle along warp or weft, ends longer than a linearised step knows of, by more than
/// a part of its rest length.
fn overstretches(model: &Model, x: &[Point], reached: &[Point]) -> bool {
    let springs = model.stretch.springs();
    let edges = springs.map(|([a, b], rest, _)| (x[b] - x[a], reached[b] - reached[a], rest));
    let triangles = model.triangles.list.iter().flat_map(|triangle| {
        let [before, after] = [x, reached].map(|points| triangle.derivatives_at(points));
        [0, 1].map(|c| (before[c], after[c], 1.0))
    });
    edges.chain(triangles).any(|(before, after, rest)| {
        let (from, to) = (length(before), length(after));
        let is_direction = from > 0.0;
        let along = if is_direction {
            dot(before, after) / from
        } else {
            0.0
        };
        to - rest.max(from).max(along) > OVERSHOOT * rest
    })
}

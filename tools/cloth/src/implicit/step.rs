//! Steps in time: backward Euler and BDF2.
//!
//! Both solve, for the new velocity v,
//!
//! ```text
//! M (v − v*) = h [ f(x* + h v) − c M v ]
//! backward Euler   x* = x₀,                     v* = v₀,                     h = Δt
//! BDF2             x* = x₀ + (x₀ − x₋₁)/3,      v* = v₀ + (v₀ − v₋₁)/3,      h = 2Δt/3
//! ```
//!
//! BDF2 here also takes steps of different length: with ω = Δt/Δt₋₁ the weight 1/3 becomes
//! ω²/(1 + 2ω) and 2/3 becomes (1 + ω)/(1 + 2ω). (Written as x₀ plus a difference, so that what
//! stands still stands still to the last bit.)
//!
//! In the directions in which a particle is held its velocity is given, and it goes on by Δt v:
//! there x* = x₀ + (Δt − h) v and v* = v, whatever it did before. Where x₀ or v₀ is not what the last
//! step left, because contact or a user changed it, x₋₁ and v₋₁ change with it: what is
//! remembered is acceleration, so that what lands does not bounce.
//!
//! **Linearised** (one iteration, the default): forces are linearised at x₀, as Baraff and
//! Witkin 1998 §3 and Choi and Ko 2002 §5 do. This keeps the order of both methods, as long as
//! the Jacobian is exact; with terms dropped BDF2 falls back to order one.
//! **Newton** (`newton.rs`): iterated until the residual is small, with a line search on a potential
//! Φ; also where a linearised step has overshot.
//!
//! **Indefinite matrices.** M (1 + h c)/h² + H is indefinite where something is compressed and
//! Δt is long: between two springs from Δt > √(m / (2k (L₀/l − 1))). Then Newton's step is no
//! descent. Terms are dropped only where this shows itself ([`Jacobian::UnlessIndefinite`]).
//!
//! **The solver's tolerance has to fall with Δt.** A step of a method of order p errs by
//! Δt^(p+1); a solver that leaves the same error at each step, however short, makes the sum
//! grow as Δt falls. So the rms velocity error that a step may leave is T Δt^(p+1)
//! ([`Tolerance::Tied`]).
//!
//! **Momentum.** Internal forces sum to zero, so the exact answer has a known momentum for each
//! piece that nothing holds. What the solver's residual misses of it is added as one
//! velocity of the whole piece: momentum is kept to rounding, at any tolerance. Angular
//! momentum is not kept by these methods.

mod newton;

use tearmesh::geometry::{Point, Vector, dot};

use super::model::first_bad;
use super::pcg::{End, Pcg, Solved, Stop};
use super::settings::{Jacobian, Method, Settings, StepError, StepReport, Tolerance};
use super::{Filter, Hessian, Layout, Model, ModelError, Part, Work};

/// An implicit solver: the matrix and its layout, the vectors of conjugate gradients, and the
/// previous step for BDF2. It owns no cloth.
///
/// Nothing is allocated in a step after the first, unless constraints were added.
#[derive(Clone, Debug, Default)]
pub struct Implicit {
    pub(super) layout: Layout,
    pub(super) hessian: Hessian,
    pub(super) pcg: Pcg,
    pub(super) forces: Vec<Vector>,
    pub(super) trial: Vec<Point>,
    pub(super) work: Work,
    shift: Vec<Vector>,
    product: Vec<Vector>,
    start: Vec<Point>,
    start_velocities: Vec<Vector>,
    velocities: Vec<Vector>,
    trial_velocities: Vec<Vector>,
    piece_masses: Vec<f64>,
    history: History,
}

/// What the particles did in the last step.
#[derive(Clone, Debug, Default)]
struct History {
    /// x₀ − x₋₁ and v₀ − v₋₁ as the step left them.
    moved: Vec<Vector>,
    sped: Vec<Vector>,
    /// v₀ as the step left it.
    velocities: Vec<Vector>,
    time_step_s: f64,
}

impl History {
    /// Notes a step from here to there.
    fn note(&mut self, from: (&[Point], &[Vector]), to: (&[Point], &[Vector]), time_step_s: f64) {
        self.moved.clear();
        self.moved
            .extend(to.0.iter().zip(from.0).map(|(x, old)| x - old));
        self.sped.clear();
        self.sped
            .extend(to.1.iter().zip(from.1).map(|(v, old)| v - old));
        self.velocities.clear();
        self.velocities.extend_from_slice(to.1);
        self.time_step_s = time_step_s;
    }

    /// x₀ − x₋₁ and v₀ − v₋₁ for a particle whose velocity is now `v`.
    fn of(&self, i: usize, v: Vector) -> [Vector; 2] {
        let pushed = v - self.velocities[i];
        [self.moved[i] + pushed * self.time_step_s, self.sped[i]]
    }
}

/// The equation of a step: its length h, and the method.
#[derive(Clone, Copy)]
struct Stage {
    method: Method,
    time_step_s: f64,
    h: f64,
    /// 1 + h c.
    dragged: f64,
    /// The weight of M in the matrix, (1 + h c)/h².
    inertia: f64,
    /// The rms acceleration of the residual that the tolerance allows.
    residual_max: f64,
}

impl Stage {
    /// What an rms acceleration of the residual means for the velocity.
    fn velocity_error(&self, acceleration: f64) -> f64 {
        acceleration * self.h / self.dragged
    }
}

impl Implicit {
    /// A solver for this model.
    ///
    /// # Errors
    ///
    /// Where the model cannot be used: [`Model::check`].
    pub fn new(model: &Model<'_>) -> Result<Implicit, ModelError> {
        model.check()?;
        let mut solver = Implicit::default();
        solver.layout.follow(model);
        Ok(solver)
    }

    /// The layout of the matrix.
    #[must_use]
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// All work since the solver was made.
    #[must_use]
    pub fn work(&self) -> Work {
        self.work
    }

    /// Forgets the previous step, after particles were renumbered: BDF2 starts anew with a step of
    /// order one. Positions and velocities may be changed without it; the acceleration of the last
    /// step is what BDF2 then goes on with.
    pub fn forget(&mut self) {
        self.history.time_step_s = 0.0;
    }

    /// Says that the last particle was added as a copy of `old`, as a vertex split does: it has
    /// the history of `old` too, so that BDF2 goes on. To be called once for each split,
    /// in their order. (Where this is left out BDF2 starts anew.)
    ///
    /// Neither is free. History carries the acceleration before the tear: where a tear changes
    /// that by a, the copy's and the original's velocities are off by a Δt/3 once. A new start
    /// is off by ½ Δt² times the rate of acceleration once, everywhere. Where tears are
    /// few and violent, [`Implicit::forget`] is the better choice.
    ///
    /// # Panics
    ///
    /// If there was a step, but no such particle.
    pub fn split(&mut self, old: usize) {
        if self.history.time_step_s > 0.0 {
            let History {
                moved,
                sped,
                velocities,
                ..
            } = &mut self.history;
            for known in [moved, sped, velocities] {
                known.push(known[old]);
            }
        }
    }

    /// Brings the layout in step and checks what a solve takes for granted.
    pub(super) fn prepare(
        &mut self,
        model: &Model<'_>,
        x: &[Point],
        v: &[Vector],
    ) -> Result<(), ModelError> {
        let n = model.masses.len();
        model.check_lengths(n)?;
        for (part, given) in [(Part::Position, x.len()), (Part::Velocity, v.len())] {
            if given != n {
                return Err(ModelError::Length {
                    part,
                    given,
                    particles: n,
                });
            }
        }
        if let Some(index) = first_bad(x, &[]) {
            return Err(ModelError::Unusable {
                part: Part::Position,
                index,
            });
        }
        if let Some(index) = first_bad(&[], v) {
            return Err(ModelError::Unusable {
                part: Part::Velocity,
                index,
            });
        }
        model.check()?;
        self.layout.follow(model);
        Ok(())
    }

    /// Takes one step of `time_step_s`, in place.
    ///
    /// A particle keeps its velocity in the directions in which it is held: zero for a pin, the
    /// pin's own for one that is moved.
    ///
    /// Cost: one evaluation of forces and second derivatives, and a product with the matrix an
    /// iteration of conjugate gradients; the same again for each of Newton's iterations.
    ///
    /// # Errors
    ///
    /// See [`StepError`]. Nothing is changed then.
    pub fn step(
        &mut self,
        model: &Model<'_>,
        positions: &mut [Point],
        velocities: &mut [Vector],
        time_step_s: f64,
        settings: &Settings,
    ) -> Result<StepReport, StepError> {
        if !(time_step_s > 0.0 && time_step_s.is_finite()) {
            return Err(StepError::TimeStep { given: time_step_s });
        }
        self.prepare(model, positions, velocities)?;
        let before = self.work;
        let stage = self.begin(model, positions, velocities, time_step_s, settings);
        let mut report = StepReport {
            method: stage.method,
            indefinite: 0,
            clamped: 0,
            newton_iterations: 1,
            overshot: false,
            halvings: 0,
            residual: 0.0,
            limit: stage.velocity_error(stage.residual_max),
            work: Work::default(),
        };
        let mut came_down = false;
        if settings.newton_iterations_max <= 1 {
            let level = self.level(model, positions, velocities, stage);
            self.linearised(model, positions, velocities, stage, settings, &mut report)?;
            self.place(stage);
            let reached = self.potential(model, stage);
            // Written so that a NaN counts as above.
            let is_below = reached.value <= level.value + level.rounding;
            if !is_below {
                self.stay(model, positions, velocities, stage);
                came_down = self.come_down(model, stage, level, settings, &mut report)?;
            }
        } else {
            self.newton(model, stage, settings, &mut report)?;
        }
        let is_solved = report.residual <= report.limit;
        if !is_solved && !came_down {
            return Err(StepError::NotConverged {
                residual: report.residual,
                limit: report.limit,
                newton_iterations: report.newton_iterations,
                solver_iterations: self.work.since(&before).solver_iterations,
            });
        }
        self.keep_momentum(model, stage);
        self.place(stage);
        if let Some(particle) = first_bad(&self.trial, &self.velocities) {
            return Err(StepError::NotFinite { particle });
        }
        let reached = (&self.trial[..], &self.velocities[..]);
        self.history
            .note((positions, velocities), reached, time_step_s);
        positions.copy_from_slice(&self.trial);
        velocities.copy_from_slice(&self.velocities);
        report.work = self.work.since(&before);
        Ok(report)
    }

    /// x*, v*, h; and the velocities now as the first guess.
    fn begin(
        &mut self,
        model: &Model<'_>,
        x: &[Point],
        v: &[Vector],
        time_step_s: f64,
        settings: &Settings,
    ) -> Stage {
        self.start.clear();
        self.start.extend_from_slice(x);
        self.start_velocities.clear();
        self.start_velocities.extend_from_slice(v);
        self.velocities.clear();
        self.velocities.extend_from_slice(v);
        let history = &self.history;
        let known = history.time_step_s > 0.0 && history.moved.len() == x.len();
        let (mut method, mut h) = (Method::BackwardEuler, time_step_s);
        if settings.method == Method::Bdf2 && known {
            let ratio = time_step_s / history.time_step_s;
            let weight = ratio * ratio / (1.0 + 2.0 * ratio);
            (method, h) = (
                Method::Bdf2,
                time_step_s * (1.0 + ratio) / (1.0 + 2.0 * ratio),
            );
            for (i, &v) in v.iter().enumerate() {
                let filter = model.filter(i);
                // What is held has no history: it goes on by its velocity, for all of Δt.
                let held = v - filter.apply(v);
                let [moved, sped] = history.of(i, v);
                self.start[i] += filter.apply(moved) * weight + held * (time_step_s - h);
                self.start_velocities[i] += filter.apply(sped) * weight;
            }
        }
        let dragged = 1.0 + h * model.drag_per_s;
        // The tolerance is that of the method asked for, also where it starts.
        let limit = match (settings.tolerance, settings.method) {
            (Tolerance::Fixed(limit), _) => limit,
            (Tolerance::Tied(t), Method::BackwardEuler) => t * time_step_s * time_step_s,
            (Tolerance::Tied(t), Method::Bdf2) => t * time_step_s * time_step_s * time_step_s,
        };
        Stage {
            method,
            time_step_s,
            h,
            dragged,
            inertia: dragged / (h * h),
            residual_max: limit * dragged / h,
        }
    }

    /// One step of Newton's method, with forces linearised at `x`, where the step started.
    fn linearised(
        &mut self,
        model: &Model<'_>,
        x: &[Point],
        v: &[Vector],
        stage: Stage,
        settings: &Settings,
        report: &mut StepReport,
    ) -> Result<(), StepError> {
        model.forces(x, &mut self.forces);
        self.work.force_evaluations += 1;
        self.shift.clear();
        let guess = self.start.iter().zip(v).map(|(s, v)| s + v * stage.h);
        self.shift.extend(guess.zip(x).map(|(y, x)| y - x));
        let mut solver = Solver {
            stage,
            settings,
            report,
        };
        let solved = solver.solve(model, x, self, |own| {
            own.hessian
                .product(own.layout.pairs(), &own.shift, &mut own.product);
            own.work.matrix_products += 1;
            own.imbalance(model, stage);
            for (b, p) in own.pcg.b.iter_mut().zip(&own.product) {
                *b -= p;
            }
        })?;
        report.residual = stage.velocity_error(solved.residual);
        if solved.end == End::Converged {
            // It may have ended at rounding, above what was asked for.
            report.limit = report.limit.max(report.residual);
        }
        for (v, d) in self.velocities.iter_mut().zip(&self.pcg.delta) {
            *v += d / stage.h;
        }
        Ok(())
    }

    /// f − M ((1 + h c) v − v*)/h for the present velocities and forces, into `pcg.b`.
    fn imbalance(&mut self, model: &Model<'_>, stage: Stage) {
        self.pcg.b.clear();
        for (i, (&f, &v)) in self.forces.iter().zip(&self.velocities).enumerate() {
            let change = v * stage.dragged - self.start_velocities[i];
            let b = f - change * (model.masses[i] / stage.h);
            self.pcg.b.push(model.filter(i).apply(b));
        }
    }

    /// Φ at the trial positions.
    fn potential(&mut self, model: &Model<'_>, stage: Stage) -> Potential {
        self.work.energy_evaluations += 1;
        let mut inertia = 0.0;
        let moving = self.velocities.iter().zip(&self.start_velocities);
        for ((v, s), m) in moving.zip(model.masses) {
            let change = v - s / stage.dragged;
            inertia += 0.5 * stage.dragged * m * dot(change, change);
        }
        Potential::of(model, &self.trial, inertia)
    }

    /// x* + h v, into `trial`.
    fn place(&mut self, stage: Stage) {
        self.trial.clear();
        let ends = self.start.iter().zip(&self.velocities);
        self.trial.extend(ends.map(|(x, v)| x + v * stage.h));
    }

    /// Gives each piece that nothing holds the momentum that the exact answer has.
    fn keep_momentum(&mut self, model: &Model<'_>, stage: Stage) {
        let pieces = self.layout.pieces();
        // By lowest particle: the momentum that is missing; the mass, or NaN where something is
        // held.
        let missing = &mut self.shift;
        missing.clear();
        missing.resize(pieces.len(), Vector::zeros());
        self.piece_masses.clear();
        self.piece_masses.resize(pieces.len(), 0.0);
        for (i, &piece) in pieces.iter().enumerate() {
            let (piece, m) = (piece as usize, model.masses[i]);
            let target = self.start_velocities[i] + model.acceleration(i) * stage.h;
            missing[piece] += (target - self.velocities[i] * stage.dragged) * m;
            let free = model.filter(i) == Filter::Free;
            self.piece_masses[piece] += if free { m } else { f64::NAN };
        }
        for (v, &piece) in self.velocities.iter_mut().zip(pieces) {
            let mass = self.piece_masses[piece as usize];
            if mass > 0.0 {
                *v += missing[piece as usize] / (mass * stage.dragged);
            }
        }
    }
}

/// The value of a potential and how much of it is rounding.
#[derive(Clone, Copy)]
pub(super) struct Potential {
    pub(super) value: f64,
    pub(super) rounding: f64,
}

impl Potential {
    pub(super) fn of(model: &Model<'_>, x: &[Point], inertia: f64) -> Potential {
        let (inside, outside) = (model.energy(x), model.outside_energy(x));
        Potential {
            value: inside + outside + inertia,
            rounding: 64.0 * f64::EPSILON * (inside + outside.abs() + inertia),
        }
    }
}

/// The linear solves of a step, with the fallback where a matrix is indefinite.
struct Solver<'a> {
    stage: Stage,
    settings: &'a Settings,
    report: &'a mut StepReport,
}

impl Solver<'_> {
    /// Solves with second derivatives at `x`; `load` fills the right-hand side.
    fn solve(
        &mut self,
        model: &Model<'_>,
        x: &[Point],
        own: &mut Implicit,
        load: impl Fn(&mut Implicit),
    ) -> Result<Solved, StepError> {
        let mut clamp = self.settings.jacobian == Jacobian::Clamped;
        loop {
            let clamped = model.hessian(x, &own.layout, clamp, &mut own.hessian);
            own.work.hessian_evaluations += 1;
            load(own);
            let newton = self.settings.newton_iterations_max > 1;
            let stop = Stop {
                residual: self.stage.residual_max * if newton { 0.25 } else { 1.0 },
                // No residual can be smaller than the rounding of the right-hand side.
                relative: 1e-14,
                iterations: self.settings.solver_iterations_max,
            };
            let pairs = own.layout.pairs();
            let inertia = self.stage.inertia;
            let solved = own
                .pcg
                .solve(model, &own.hessian, pairs, inertia, stop, &mut own.work);
            if solved.end != End::Indefinite || clamp {
                self.report.clamped += clamped;
                return Ok(solved);
            }
            self.report.indefinite += 1;
            if self.settings.jacobian == Jacobian::Exact {
                let time_step_s = self.stage.time_step_s;
                return Err(StepError::Indefinite { time_step_s });
            }
            clamp = true;
        }
    }
}

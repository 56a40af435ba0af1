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
//! Where a particle is held its velocity is given, and it goes on by Δt v: x* = x₀ + (Δt − h) v and
//! v* = v, whatever it did before. Where x₀ or v₀ is not what the last
//! step left, because contact or a user changed it, x₋₁ and v₋₁ change with it: what is
//! remembered is acceleration, so that what lands does not bounce.
//!
//! **Wind** depends on velocities and areas, and its derivatives are in no matrix. BDF2 takes it at
//! x₀ + ω (x₀ − x₋₁) and v₀ + ω (v₀ − v₋₁), which err by O(Δt²); taken where the step begins it
//! would make the method one of order one. In still air alone steps of one length obey
//! 3z² − 4z + 1 + 2μ (2z − 1) = 0 with μ = λΔt, which has the root −1 at μ = 4/3; one that is ω times
//! as long as the last has its limit at μ = 2 (1 + ω)/(1 + 2ω). Springs only raise it.
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
//! ([`Tolerance::Tied`]). And the forces that it leaves unanswered are no more than a tenth of all
//! that act: where T Δt^p is above g, what hangs would hover.
//!
//! **Momentum.** Internal forces sum to zero, so the exact answer has a known momentum for each
//! piece that nothing holds. What the solver's residual misses of it is added as one
//! velocity of the whole piece: momentum is kept to rounding, at any tolerance. Angular
//! momentum is not kept by these methods.

use tearmesh::geometry::{Point, Vector, check_point};

use super::Layout;
use super::equation::{Equation, Stage};
use super::history::History;
use super::newton;
use super::pcg::End;
use super::problem::Problem;
use super::settings::{Method, Settings, StepError, StepReport, Tolerance, Work};
use crate::moment::{Identity, Moment, Note};
use crate::solver::{Abilities, Failure, SettingError, Solver};
use crate::system::System;

/// Implicit steps of a system: backward Euler or BDF2. They are stable at any step for springs,
/// triangles, bends and drag. Backward Euler evaluates wind where a step begins, and is stable up
/// to λ Δt = 2 ([`wind_rate`](crate::air::wind_rate)). BDF2 extrapolates positions and velocities
/// for wind from the last step, which keeps its order, and is stable up to λ Δt = 4/3.
///
/// One solver may step many systems: BDF2 remembers the last step of each. It begins again with a
/// step of order one if that last step did not lead to the present state, because another solver
/// has stepped the system since, a step was undone, the system is a clone, or particles were added
/// or removed.
///
/// ```
/// use tearmesh_cloth::implicit::{self, Settings, Tolerance};
/// use tearmesh_cloth::{Implicit, Loads, StepError, System};
/// use tearmesh::{Point, Vector};
///
/// let mut spring = System::new([Point::origin(), Point::new(0.0, 0.0, -1.0)], vec![0.1; 2])?;
/// spring.stretch([0, 1], 1.0, 50.0)?;
/// spring.hold(0);
/// let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -9.81));
/// spring.set_loads(Loads { gravity_m_per_s2, ..Loads::default() })?;
/// let tolerance = Tolerance::Fixed(1e-10);
/// let mut solver = Implicit::new(Settings { tolerance, ..Settings::default() });
/// for _ in 0..200 {
///     spring.step(&mut solver, 0.5)?; // Far beyond the limit of an explicit method.
/// }
/// assert!((spring.positions()[1].z + 1.0 + 0.1 * 9.81 / 50.0).abs() < 1e-8);
///
/// // A step that misses its tolerance is not taken, and says by how much it misses.
/// let (x, _) = spring.state_mut();
/// x[1] = Point::new(0.3, 0.0, -1.0);
/// let settings = Settings { tolerance, newton_iterations_max: 2, ..Settings::default() };
/// let error = spring.step(&mut Implicit::new(settings), 0.5).unwrap_err();
/// let StepError::Implicit { error, .. } = error else { unreachable!() };
/// let implicit::StepError::NotConverged { residual, limit, .. } = error else { unreachable!() };
/// assert!(residual > limit && limit == 1e-10);
/// assert_eq!(spring.positions()[1], Point::new(0.3, 0.0, -1.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Implicit {
    /// The settings of this method.
    pub settings: Settings,
    equation: Equation,
    outside: Vec<Vector>,
    shift: Vec<Vector>,
    piece_masses: Vec<f64>,
    history: History,
    /// The system that the history, and the layout of the equation, are of.
    system: Note,
    others: Vec<Aside>,
    report: Option<StepReport>,
}

/// What is kept of a system while others are stepped. The layout too: its order depends on what was
/// torn, and with it the rounding of sums.
#[derive(Clone, Debug)]
struct Aside {
    system: Note,
    history: History,
    layout: Layout,
}

/// The part of all forces that a tied tolerance leaves unanswered, at most.
const UNANSWERED: f64 = 0.1;

impl Implicit {
    /// Returns an implicit method with these settings.
    #[must_use]
    pub fn new(settings: Settings) -> Implicit {
        Implicit {
            settings,
            ..Implicit::default()
        }
    }

    /// Returns the report of the last step that was taken; `None` before the first one.
    #[must_use]
    pub fn report(&self) -> Option<StepReport> {
        self.report
    }

    /// Forgets the last step of every system, so that BDF2 starts again with a step of order one.
    /// This is not needed after positions or velocities were changed: BDF2 then continues with the
    /// acceleration of the last step.
    pub fn forget(&mut self) {
        self.history.forget();
        let others = self.others.iter_mut();
        others.for_each(|aside| aside.history.forget());
    }

    /// Takes up what is known of a system, and puts what is known of another aside.
    fn turn_to(&mut self, system: &Identity) {
        if self.system.is_of(system) {
            return;
        }
        self.others.retain(|aside| aside.system.is_alive());
        let known = self.others.iter().position(|a| a.system.is_of(system));
        let next = match known {
            Some(place) => self.others.swap_remove(place),
            None => Aside {
                system: system.note(),
                history: History::default(),
                layout: Layout::default(),
            },
        };
        let last = Aside {
            system: std::mem::replace(&mut self.system, next.system),
            history: std::mem::replace(&mut self.history, next.history),
            layout: std::mem::replace(&mut self.equation.layout, next.layout),
        };
        if last.system.is_alive() {
            self.others.push(last);
        }
    }

    /// Takes one step, in place. A particle that is held keeps its velocity. Nothing is changed where
    /// the step fails.
    ///
    /// Cost: one evaluation of forces and second derivatives, and a product with the matrix an
    /// iteration of conjugate gradients; the same again for each of Newton's iterations.
    fn step(
        &mut self,
        problem: Problem<'_>,
        x: &mut [Point],
        v: &mut [Vector],
        time_step_s: f64,
    ) -> Result<StepReport, StepError> {
        self.equation.work = Work::default();
        self.equation.layout.follow_model(problem.model);
        let is_linearised = self.settings.newton_iterations_max <= 1;
        if is_linearised || matches!(self.settings.tolerance, Tolerance::Tied(_)) {
            self.equation.pull(problem, x);
        }
        let stage = self.begin(problem, x, v, time_step_s);
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
        let settings = self.settings;
        let mut came_down = false;
        if is_linearised {
            let level = newton::level(&mut self.equation, problem, x, v, stage);
            self.linearised(problem, x, v, stage, &mut report)?;
            let equation = &mut self.equation;
            equation.place(stage);
            let reached = equation.potential(problem, stage);
            // Written so that a NaN counts as above.
            let is_below = reached.value <= level.value + level.rounding;
            if !is_below {
                let start = (&*x, &*v, level);
                came_down =
                    newton::come_down(equation, problem, start, stage, &settings, &mut report)?;
            }
        } else {
            newton::iterate(&mut self.equation, problem, stage, &settings, &mut report)?;
        }
        report.work = self.equation.work;
        let is_solved = report.residual <= report.limit;
        if !is_solved && !came_down {
            return Err(StepError::NotConverged {
                residual: report.residual,
                limit: report.limit,
                newton_iterations: report.newton_iterations,
                solver_iterations: report.work.solver_iterations,
            });
        }
        self.keep_momentum(problem, stage);
        self.equation.place(stage);
        let reached = (&self.equation.trial[..], &self.equation.velocities[..]);
        if let Some(particle) = first_bad(reached.0, reached.1) {
            return Err(StepError::NotFinite { particle });
        }
        self.history.note((x, v), reached, time_step_s);
        x.copy_from_slice(reached.0);
        v.copy_from_slice(reached.1);
        Ok(report)
    }

    /// x*, v*, h; and the velocities now as the first guess. The forces at `x` are known where the
    /// tolerance depends on them.
    fn begin(
        &mut self,
        problem: Problem<'_>,
        x: &[Point],
        v: &[Vector],
        time_step_s: f64,
    ) -> Stage {
        let (settings, equation) = (self.settings, &mut self.equation);
        equation.start.clear();
        equation.start.extend_from_slice(x);
        equation.start_velocities.clear();
        equation.start_velocities.extend_from_slice(v);
        equation.velocities.clear();
        equation.velocities.extend_from_slice(v);
        let history = &self.history;
        let (mut method, mut h) = (Method::BackwardEuler, time_step_s);
        if settings.method == Method::Bdf2 && history.is_known() {
            let ratio = history.ratio(time_step_s);
            let weight = ratio * ratio / (1.0 + 2.0 * ratio);
            (method, h) = (
                Method::Bdf2,
                time_step_s * (1.0 + ratio) / (1.0 + 2.0 * ratio),
            );
            for (i, &v) in v.iter().enumerate() {
                let [moved, sped] = history.of(i, v);
                if problem.is_free(i) {
                    equation.start[i] += moved * weight;
                    equation.start_velocities[i] += sped * weight;
                } else {
                    // What is held has no history: it goes on by its velocity, for all of Δt.
                    equation.start[i] += v * (time_step_s - h);
                }
            }
        }
        let dragged = 1.0 + h * problem.model.drag_per_s();
        let residual = |limit: f64| limit * dragged / h;
        let residual_max = match settings.tolerance {
            Tolerance::Fixed(limit) => residual(limit),
            Tolerance::Tied(t) => {
                // The order is that of the method asked for, also where it starts.
                let by_order = match settings.method {
                    Method::BackwardEuler => t * time_step_s * time_step_s,
                    Method::Bdf2 => t * time_step_s * time_step_s * time_step_s,
                };
                residual(by_order).min(UNANSWERED * equation.load(problem, v))
            }
        };
        Stage {
            method,
            time_step_s,
            h,
            dragged,
            inertia: dragged / (h * h),
            residual_max,
        }
    }

    /// One step of Newton's method, with the forces at `x`, where the step started, and linearised
    /// there.
    fn linearised(
        &mut self,
        problem: Problem<'_>,
        x: &[Point],
        v: &[Vector],
        stage: Stage,
        report: &mut StepReport,
    ) -> Result<(), StepError> {
        let equation = &mut self.equation;
        self.shift.clear();
        let guess = equation.start.iter().zip(v).map(|(s, v)| s + v * stage.h);
        self.shift.extend(guess.zip(x).map(|(y, x)| y - x));
        let shift = Some(&self.shift[..]);
        let solved = equation.solve(problem, stage, x, shift, &self.settings, report)?;
        report.residual = stage.velocity_error(solved.residual);
        if solved.end == End::Converged {
            // It may have ended at rounding, above what was asked for.
            report.limit = report.limit.max(report.residual);
        }
        for (v, d) in equation.velocities.iter_mut().zip(&equation.pcg.delta) {
            *v += d / stage.h;
        }
        Ok(())
    }

    /// Gives each piece that nothing holds the momentum that the exact answer has.
    fn keep_momentum(&mut self, problem: Problem<'_>, stage: Stage) {
        let Equation {
            layout,
            start_velocities,
            velocities,
            ..
        } = &mut self.equation;
        let pieces = layout.pieces();
        // By lowest particle: the momentum that is missing; the mass, or NaN where something is
        // held.
        let missing = &mut self.shift;
        missing.clear();
        missing.resize(pieces.len(), Vector::zeros());
        self.piece_masses.clear();
        self.piece_masses.resize(pieces.len(), 0.0);
        for (i, &piece) in pieces.iter().enumerate() {
            let (piece, m) = (piece as usize, problem.masses()[i]);
            let target = start_velocities[i] + problem.outside[i] * stage.h;
            missing[piece] += (target - velocities[i] * stage.dragged) * m;
            self.piece_masses[piece] += if problem.is_free(i) { m } else { f64::NAN };
        }
        for (v, &piece) in velocities.iter_mut().zip(pieces) {
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
        let (Tolerance::Tied(given) | Tolerance::Fixed(given)) = self.settings.tolerance;
        let holds = given > 0.0 && given.is_finite();
        SettingError::unless(holds, "tolerance", given, "any above 0")
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        self.turn_to(&system.identity);
        if !self.history.leads_to(system.moment) {
            self.history.forget();
        }
        let System {
            positions,
            velocities,
            model,
            scratch,
            counters,
            ..
        } = system;
        scratch.is_fresh = false;
        // A state that is too far away or too fast already is no matter of the method.
        Failure::unless(first_bad(positions, velocities).is_none())?;
        let mut outside = std::mem::take(&mut self.outside);
        outside.clear();
        outside.resize(positions.len(), Vector::zeros());
        let is_foreseen = self.settings.method == Method::Bdf2 && self.history.is_known();
        if is_foreseen && model.loads.wind.is_some() {
            let Equation {
                trial,
                velocities: later,
                ..
            } = &mut self.equation;
            let now = (&positions[..], &velocities[..]);
            let free = &model.inverse_masses;
            self.history.foresee(now, free, dt_s, (trial, later));
            model.external(trial, later, &mut outside, counters);
        } else {
            model.external(positions, velocities, &mut outside, counters);
        }
        let problem = Problem {
            model,
            outside: &outside,
        };
        let step = self.step(problem, positions, velocities, dt_s);
        self.outside = outside;
        // What a step cost, whether it is taken or not.
        let work = self.equation.work;
        counters.force_evaluations += work.force_evaluations;
        counters.matrix_products += work.matrix_products;
        let sums = work.force_evaluations
            + work.matrix_products
            + work.hessian_evaluations
            + work.energy_evaluations;
        // And one to see that nothing has blown up.
        model.count_visits(sums + 1, counters);
        if !model.triangles.as_slice().is_empty() {
            counters.triangle_evaluations +=
                work.force_evaluations + work.hessian_evaluations + work.energy_evaluations;
        }
        let report = step.map_err(Failure::Implicit)?;
        Failure::unless(model.is_within_limit(positions))?;
        self.history.leave(Moment::After(counters.substeps));
        self.report = Some(report);
        counters.overshoots += u64::from(report.overshot);
        Ok(())
    }
}

/// The first particle whose position or velocity is unusable.
fn first_bad(x: &[Point], v: &[Vector]) -> Option<usize> {
    let bad = x.iter().position(|&p| check_point(p).is_err());
    let fast = v.iter().position(|v| check_point(Point::from(*v)).is_err());
    bad.or(fast)
}

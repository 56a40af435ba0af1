//! Newton's method with a line search, for steps that ask for it and for those that overshot.
//!
//! Iterated from x* + h v₀ until the residual is small; the line search is on
//! Φ = E − Σ m g·x + ½ (1 + h c) Σ m |v − v*/(1 + h c)|², of which the equation is the gradient.
//!
//! **Overshoot.** A linearised step trusts its matrix however far it goes. A piece of one or two
//! triangles that spins by ω Δt > 1 flies apart along the tangent, to √(1 + (ω Δt)²) times its size;
//! where something is pushed together the matrix may be all but singular, and the step as
//! long as one likes. Both end above the Φ of where they started, which no solution near by
//! does. Such a step is taken back, and Newton's method goes down from there instead
//! ([`StepReport::overshot`]); so the stretch of what is thrown about is bounded by its energy.

use tearmesh::geometry::{Point, Vector, dot};

use super::equation::{Equation, Stage};
use super::problem::{Potential, Problem};
use super::settings::{Settings, StepError, StepReport};

/// Newton's iterations for a step whose linearised answer was taken back.
const RESCUE_ITERATIONS: u32 = 50;

/// Newton's method from the present velocities.
pub(super) fn iterate(
    equation: &mut Equation,
    problem: Problem<'_>,
    stage: Stage,
    settings: &Settings,
    report: &mut StepReport,
) -> Result<(), StepError> {
    report.newton_iterations = 0;
    equation.place(stage);
    let mut phi = equation.potential(problem, stage);
    // The velocities that a line search starts from.
    let mut from = std::mem::take(&mut equation.room);
    let ended = loop {
        equation.pull_at_trial(problem);
        equation.imbalance(problem, stage);
        let left = problem.residual(&equation.pcg.b);
        report.residual = stage.velocity_error(left);
        let spent = report.newton_iterations >= settings.newton_iterations_max;
        if left <= stage.residual_max || spent || !left.is_finite() {
            break Ok(());
        }
        report.newton_iterations += 1;
        let at = std::mem::take(&mut equation.trial);
        let solved = equation.solve(problem, stage, &at, None, settings, report);
        equation.trial = at;
        if let Err(error) = solved {
            break Err(error);
        }
        if left <= equation.rounding {
            report.limit = report.limit.max(report.residual);
            break Ok(());
        }
        match search(equation, problem, stage, phi, left, &mut from, report) {
            Search::Taken(next) => phi = next,
            Search::Rounding => {
                report.limit = report.limit.max(report.residual);
                break Ok(());
            }
            Search::Failed => break Ok(()),
        }
    };
    equation.room = from;
    ended
}

/// Halves the step until Φ falls by a small part of what its slope promises (Armijo's rule); then
/// takes it.
///
/// Near the solution Φ no longer tells, because it is flat to its rounding; there a step is taken if
/// it makes the residual smaller.
fn search(
    equation: &mut Equation,
    problem: Problem<'_>,
    stage: Stage,
    phi: Potential,
    left: f64,
    from: &mut Vec<Vector>,
    report: &mut StepReport,
) -> Search {
    equation.imbalance(problem, stage);
    let slope = equation.pcg.b.iter().zip(&equation.pcg.delta);
    let slope: f64 = slope.fold(0.0, |sum, (b, d)| sum + dot(*b, *d));
    std::mem::swap(from, &mut equation.velocities);
    let mut part = 1.0;
    for _ in 0..40 {
        equation.velocities.clear();
        let moved = from.iter().zip(&equation.pcg.delta);
        let moved = moved.map(|(v, d)| v + d * (part / stage.h));
        equation.velocities.extend(moved);
        equation.place(stage);
        let next = equation.potential(problem, stage);
        if next.value <= phi.value - 1e-4 * part * slope {
            return Search::Taken(next);
        }
        if next.value <= phi.value + phi.rounding {
            equation.pull_at_trial(problem);
            equation.imbalance(problem, stage);
            if problem.residual(&equation.pcg.b) < left {
                return Search::Taken(next);
            }
        }
        part *= 0.5;
        report.halvings += 1;
    }
    std::mem::swap(&mut equation.velocities, from);
    equation.place(stage);
    if slope <= phi.rounding {
        Search::Rounding
    } else {
        Search::Failed
    }
}

/// Φ where the step started, with these positions and velocities: a step that ends above it has
/// overshot.
pub(super) fn level(
    equation: &mut Equation,
    problem: Problem<'_>,
    x: &[Point],
    v: &[Vector],
    stage: Stage,
) -> Potential {
    stay(equation, problem, x, v, stage);
    equation.place(stage);
    let level = equation.potential(problem, stage);
    equation.velocities.clear();
    equation.velocities.extend_from_slice(v);
    level
}

/// Velocities that leave the free particles at `x`, where the step started.
fn stay(equation: &mut Equation, problem: Problem<'_>, x: &[Point], v: &[Vector], stage: Stage) {
    equation.velocities.clear();
    for (i, &v) in v.iter().enumerate() {
        let back = (x[i] - equation.start[i]) / stage.h - v;
        equation.velocities.push(v + problem.filter(i, back));
    }
}

/// Newton's method from where the step started, at `level`, after the linearised step has overshot.
/// True where it came down from there, if not all the way: that is as good as a linearised step can
/// be, whose residual nobody asks for, and its stretch is bounded.
pub(super) fn come_down(
    equation: &mut Equation,
    problem: Problem<'_>,
    (x, v, level): (&[Point], &[Vector], Potential),
    stage: Stage,
    settings: &Settings,
    report: &mut StepReport,
) -> Result<bool, StepError> {
    stay(equation, problem, x, v, stage);
    report.overshot = true;
    let settings = Settings {
        newton_iterations_max: RESCUE_ITERATIONS,
        ..*settings
    };
    iterate(equation, problem, stage, &settings, report)?;
    Ok(equation.potential(problem, stage).value < level.value)
}

/// How a line search ended.
enum Search {
    Taken(Potential),
    /// What could be gained is below the rounding of the potential.
    Rounding,
    Failed,
}

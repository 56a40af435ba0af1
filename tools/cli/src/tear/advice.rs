//! What a user is told of a simulation beside what was asked for: before its first step, when it has ended,
//! and where it failed.

use tearmesh_cloth::scene::{Frame, Run};
use tearmesh_cloth::{Collider, StepError};

use super::words::two_digits;
use super::{check, words};
use crate::say::{Fault, count, short};

/// What is known before the first step. `number` is that of a vertex in its file.
pub(crate) fn before(run: &Run, frame: &Frame, number: &dyn Fn(usize) -> usize) -> Vec<Fault> {
    let warnings = check::warnings(run, frame, number).into_iter();
    warnings.chain(too_coarse(run)).collect()
}

/// What showed in the steps that were taken.
pub(crate) fn after(run: &Run) -> Vec<Fault> {
    let fell_short = words::infeasible(run).into_iter();
    let energy = words::gain(run).into_iter().chain(words::damped(run));
    fell_short.chain(passed(run)).chain(energy).collect()
}

/// Why the simulation failed, with vertices counted as in OBJ, and what would help.
pub(crate) fn failure(error: &StepError, run: &Run) -> Fault {
    words::failure(error, run)
}

/// The code of a step that was not taken.
pub(crate) fn code(error: &StepError) -> &'static str {
    words::code(error)
}

/// What the mesh is too coarse for: balls that slip between vertices, and strengths that leave nothing to
/// tear.
fn too_coarse(run: &Run) -> Vec<Fault> {
    let edges = run.cloth().system().stretches();
    let lengths = edges.iter().map(|id| edges.get(id).rest_length_m);
    let longest_m = lengths.fold(0.0, f64::max);
    let slips = |(number, radius_m): (usize, f64)| {
        let message = format!(
            "collider {number} is a ball {} m across, and edges are up to {} m long: only vertices are \
             pushed out, and it may pass between them",
            short(2.0 * radius_m),
            two_digits(longest_m),
        );
        Fault::warning("W-SIM-COLLIDER", message).help("a finer mesh, or a larger ball")
    };
    let small = balls(run).filter(|(_, radius_m)| 2.0 * radius_m < longest_m);
    small.map(slips).chain(strong(run)).collect()
}

/// The balls that steps were too long for.
fn passed(run: &Run) -> Vec<Fault> {
    let farthest_m = run.tally().farthest_m;
    let passes = |(number, radius_m): (usize, f64)| {
        let message = format!(
            "a vertex moved {} m in a step, and collider {number} is a ball of radius {} m: it may have \
             been passed without a touch",
            two_digits(farthest_m),
            short(radius_m),
        );
        let slower_s = run.step_s() * radius_m / farthest_m / 2.0;
        let help = format!("--dt {}", two_digits(slower_s));
        Fault::warning("W-SIM-COLLIDER", message).help(help)
    };
    let passed = balls(run).filter(|&(_, radius_m)| farthest_m > radius_m);
    passed.map(passes).collect()
}

/// The balls of a scene, by the numbers of colliders from 1, and their radii in metres.
fn balls(run: &Run) -> impl Iterator<Item = (usize, f64)> + '_ {
    let numbered = (1..).zip(&run.scene().colliders);
    numbered.filter_map(|(number, collider)| match *collider {
        Collider::Sphere { radius_m, .. } => Some((number, radius_m)),
        Collider::Plane(_) => None,
    })
}

/// Strengths are those of vertices, and on a coarse mesh a small region may hold all that could
/// tear.
fn strong(run: &Run) -> Option<Fault> {
    let tear = run.tear()?;
    let mesh = run.mesh();
    let strengths = mesh.vertices().map(|v| tear.strength(v));
    let least = strengths.fold(f64::INFINITY, f64::min);
    if !(least > 1.0 && least.is_finite()) {
        return None;
    }
    let message = format!(
        "all {} are stronger than the cloth: nothing tears below {} times the threshold",
        count(mesh.vertex_count(), "vertex", "vertices"),
        short(least),
    );
    let help = "a finer mesh, or smaller regions of strength";
    Some(Fault::note("W-SIM-STRONG", message).help(help))
}

//! What a user is told of a simulation beside what was asked for: before its first step, when it has ended,
//! and where it failed.

use tearmesh_cloth::StepError;
use tearmesh_cloth::scene::{Frame, Run};

use super::{check, reach, words};
use crate::say::Fault;

/// What is known before the first step. `number` is that of a vertex in its file.
pub(crate) fn before(run: &Run, frame: &Frame, number: &dyn Fn(usize) -> usize) -> Vec<Fault> {
    let warnings = check::warnings(run, frame, number).into_iter();
    warnings.chain(reach::before(run)).collect()
}

/// What showed in the steps that were taken.
pub(crate) fn after(run: &Run) -> Vec<Fault> {
    let fell_short = words::infeasible(run).into_iter();
    let passed = reach::after(run);
    let energy = words::gain(run).into_iter().chain(words::damped(run));
    fell_short.chain(passed).chain(energy).collect()
}

/// Why the simulation failed, with vertices counted as in OBJ, and what would help.
pub(crate) fn failure(error: &StepError, run: &Run) -> Fault {
    words::failure(error, run)
}

/// The code of a step that was not taken.
pub(crate) fn code(error: &StepError) -> &'static str {
    words::code(error)
}

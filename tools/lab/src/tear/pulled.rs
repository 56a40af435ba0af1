//! A strip in its clamps.

use tearmesh::Vector;
use tearmesh_cloth::scene::{Run, RunError};
use tearmesh_cloth::{StepError, force};

/// A strip whose legs are pulled apart.
pub(super) struct Pulled {
    pub(super) run: Run,
    /// Across the strip, where its legs go.
    pub(super) depth: Vector,
}

impl Pulled {
    /// Takes a step; the force between the clamps then, in newtons.
    pub(super) fn step(&mut self) -> Result<f64, StudyError> {
        self.run.step().map_err(StudyError::Step)?;
        // Half the difference: what both clamps agree on.
        let [left, right] = [0, 1].map(|leg| {
            let system = self.run.cloth().system();
            let held = self.run.held(leg).iter();
            held.map(|v| force::reaction_n(system, v.index()).dot(&self.depth))
                .sum::<f64>()
        });
        Ok((left - right) / 2.0)
    }

    /// How far the clamps are apart, in metres.
    pub(super) fn apart_m(&self) -> f64 {
        let [left, right] = [0, 1].map(|leg| {
            let first = self.run.held(leg)[0];
            let at = self.run.cloth().positions()[first.index()];
            at.coords.dot(&self.depth)
        });
        left - right
    }
}

/// The mean of some forces; 0 of none.
pub(super) fn mean(forces: &[f64]) -> f64 {
    forces.iter().sum::<f64>() / forces.len().max(1) as f64
}

/// An error of the experiment. Since its inputs are fixed, it is a bug.
#[derive(Debug)]
#[non_exhaustive]
pub enum StudyError {
    /// The scene was refused.
    Run(RunError),
    /// A step failed.
    Step(StepError),
    /// The strip is not a mesh.
    Strip,
    /// The experiment was stopped. [`study`](super::study) returns `None` instead of this error.
    Stopped,
}

impl std::fmt::Display for StudyError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            StudyError::Run(error) => error.fmt(f),
            StudyError::Step(error) => error.fmt(f),
            StudyError::Strip => f.write_str("the strip is no mesh"),
            StudyError::Stopped => f.write_str("the experiment was stopped"),
        }
    }
}

impl std::error::Error for StudyError {}

//! The first tear of a strip: by two methods that share no force code, with two steps each.
//!
//! What a chart of forces shows is worth as much as the method that it was made by. Up to the first tear
//! a test has an answer, and after it a tear takes a way of its own; so up to there it is done again.
//! Verlet sums up the forces of springs by their lengths. XPBD, with two sweeps at the same step,
//! projects positions and reads forces off its multipliers.

use serde::{Deserialize, Serialize};
use tearmesh_cloth::Xpbd;
use tearmesh_cloth::scene::{Method, Scene};

use super::pulled::{Pulled, StudyError, mean};

/// The first tear of a strip by one method at one step.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FirstTear {
    /// The method: `verlet` or `xpbd`.
    pub method: String,
    /// The step, in seconds.
    pub dt_s: f64,
    /// The distance between the clamps, in metres.
    pub displacement_m: f64,
    /// The force between the clamps in newtons, as a mean over the last 1/60 s before the tear.
    pub force_n: f64,
}

/// One leaves edges several per cent too soft at Verlet's step, and with four a chart takes half as long
/// again.
const SWEEPS: u32 = 2;

/// The seconds of a mean.
const MEAN_S: f64 = 1.0 / 60.0;

/// The first tear of a scene by both methods, with the step that suits Verlet and with half of it.
/// Those that do not tear are left out.
pub(super) fn first_tears(
    pulled: impl Fn(&Scene) -> Result<Pulled, StudyError>,
    scene: &Scene,
    stop: &dyn Fn() -> bool,
) -> Result<Vec<FirstTear>, StudyError> {
    let suited_s = pulled(scene)?.run.step_s();
    let methods = [
        ("verlet", Method::Verlet),
        ("xpbd", Method::Xpbd(Xpbd::new(1, SWEEPS))),
    ];
    let mut tears = Vec::new();
    for (method, solver) in methods {
        for dt_s in [suited_s, suited_s / 2.0] {
            let scene = Scene {
                solver: solver.clone(),
                step_s: Some(dt_s),
                ..scene.clone()
            };
            let mut pulled = pulled(&scene)?;
            let mut forces = Vec::new();
            while !pulled.run.is_over() {
                if stop() {
                    return Err(StudyError::Stopped);
                }
                let force_n = pulled.step()?;
                if pulled.run.tally().splits > 0 {
                    let count = (MEAN_S / dt_s) as usize;
                    let recent = &forces[forces.len().saturating_sub(count)..];
                    tears.push(FirstTear {
                        method: method.to_owned(),
                        dt_s,
                        displacement_m: pulled.apart_m(),
                        force_n: mean(recent),
                    });
                    break;
                }
                forces.push(force_n);
            }
        }
    }
    Ok(tears)
}

/// Returns the relative spread of the forces of first tears, largest/smallest − 1; 0 if `tears` is empty.
#[must_use]
pub fn spread(tears: &[FirstTear]) -> f64 {
    let forces = || tears.iter().map(|tear| tear.force_n);
    let least = forces().fold(f64::INFINITY, f64::min);
    let most = forces().fold(0.0, f64::max);
    if tears.is_empty() {
        0.0
    } else {
        most / least - 1.0
    }
}

//! How fast air slows particles, and the limit that this sets on the step of a method that
//! evaluates drag or wind at the velocities before the step.
//!
//! Wind presses on a face by the mean velocity of its corners, and a third of that acts at each
//! ([`Wind`](crate::Wind)). So between any two corners of a face of area A and normal n there is
//! the damping c A n nᵀ/9, and the rates at which wind slows a system are the eigenvalues of M⁻¹ D
//! with D the sum of these. By Gershgorin's rows, three blocks a face, none is beyond
//!
//! ```text
//! λ = w Σ c A / 3
//! ```
//!
//! of some particle, with w its inverse mass and the sum over its faces. A flat sheet whose masses
//! are those of its areas has just this rate, c over its density, when it moves across. Held
//! particles have w = 0. Drag adds its own rate where a method takes that by the velocities before.
//!
//! To see why the limits combine, let u be a mode of springs and air together. M, K and D are
//! symmetric, so by u*Mu = 1 the mode is one of a single oscillator with ω² = u*Ku and λ = u*Du,
//! neither beyond its bound; a step is stable in every mode where it is for each such oscillator.
//! For symplectic Euler and for velocity Verlet that is so where (ωΔt/2)² + λΔt/l < 1, with l the
//! limit of λΔt without springs. From ωΔt/2 + λΔt/l ≤ 1 that follows, and it can be solved for the
//! step: the reciprocals of the two limits add up. For Runge and Kutta's method (`tools/lab`) the
//! sum was looked at on a grid of ω and λ. A method that takes springs implicitly has the limit of
//! its air alone, as a spring only shortens what it does in a step.
//!
//! Areas grow with the cloth, so they are computed once per step if there is wind.

use tearmesh::geometry::{cross, dot};

use crate::system::System;

/// A bound on the rate at which air slows a system, and the particle that sets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirRate {
    /// The rate λ, in 1/s.
    pub rate_per_s: f64,
    /// The index of the particle that sets the bound.
    pub particle: usize,
}

/// Returns a bound on the rate at which wind slows the system with its present areas; `None` if
/// there is no wind. Costs a pass over all faces.
pub fn wind_rate(system: &mut System) -> Option<AirRate> {
    let wind = system.model.loads.wind?;
    let faces = &system.model.faces;
    if faces.is_empty() {
        return None;
    }
    system.counters.features.wind += faces.len() as u64 / 3;
    let areas = &mut system.scratch.areas;
    areas.clear();
    areas.resize(system.positions.len(), 0.0);
    for face in faces.as_chunks::<3>().0 {
        let [a, b, c] = face.map(|corner| corner as usize);
        let x = &system.positions;
        let normal = cross(x[b] - x[a], x[c] - x[a]);
        let area = dot(normal, normal).sqrt() / 2.0;
        for corner in [a, b, c] {
            areas[corner] += area;
        }
    }
    let rates = areas.iter().zip(&system.model.inverse_masses);
    let rates = rates.map(|(area, w)| w * wind.coefficient * area / 3.0);
    // A state that is not finite is for the step to find.
    let finite = rates
        .enumerate()
        .filter(|(_, rate)| *rate > 0.0 && rate.is_finite());
    let most = finite.reduce(|most, one| if one.1 > most.1 { one } else { most });
    most.map(|(particle, rate_per_s)| AirRate {
        rate_per_s,
        particle,
    })
}

/// The rate of drag, and the first particle that feels it.
pub(crate) fn drag_rate(system: &System) -> Option<AirRate> {
    let rate_per_s = system.model.loads.drag_per_s.filter(|drag| *drag > 0.0)?;
    let particle = system.model.inverse_masses.iter().position(|w| *w > 0.0)?;
    Some(AirRate {
        rate_per_s,
        particle,
    })
}

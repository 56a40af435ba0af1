//! The rate at which air slows particles, and the limit that this sets on the step of a method that
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

/// Returns a bound on the rate λ at which wind slows the system with its present areas, and drag if it is to
/// count, in 1/s, with the index of the particle that sets the bound; `None` if nothing slows it. Costs a pass
/// over all faces if there is wind.
pub fn air_rate(system: &mut System, counts_drag: bool) -> Option<(f64, usize)> {
    let (loads, areas) = (&system.model.loads, &mut system.scratch.areas);
    let coefficient = loads.wind.map_or(0.0, |wind| wind.coefficient);
    let drag_per_s = loads.drag_per_s.filter(|_| counts_drag).unwrap_or(0.0);
    if coefficient + drag_per_s <= 0.0 {
        return None;
    }
    areas.clear();
    areas.resize(system.positions.len(), 0.0);
    let faces = loads.wind.map_or(&[][..], |_| &system.model.faces);
    system.counters.features.wind += faces.len() as u64 / 3;
    for face in faces.as_chunks::<3>().0 {
        let [a, b, c] = face.map(|corner| corner as usize);
        let x = &system.positions;
        let normal = cross(x[b] - x[a], x[c] - x[a]);
        let area = dot(normal, normal).sqrt() / 2.0;
        for corner in [a, b, c] {
            areas[corner] += area;
        }
    }
    let particles = areas.iter().zip(&system.model.inverse_masses).enumerate();
    let free = particles.filter(|(_, (_, w))| **w > 0.0);
    let rates = free.map(|(particle, (area, w))| {
        let rate_per_s = w * coefficient * area / 3.0 + drag_per_s;
        (rate_per_s, particle)
    });
    // A state that is not finite is for the step to find.
    let finite = rates.filter(|&(per_s, _)| per_s > 0.0 && per_s.is_finite());
    finite.reduce(|most, one| if one.0 > most.0 { one } else { most })
}

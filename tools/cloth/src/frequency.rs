//! The largest frequency of a system, which limits the step of explicit methods.

use crate::spectrum::Frequency;
use crate::system::System;

/// Returns an upper bound on ω, in rad/s. It holds in every configuration; for a system with
/// triangles that resist shear, it holds as long as no triangle is stretched more than now. The
/// first call takes linear time, and later ones use the stored value, except that the stretch of
/// triangles is checked each time.
pub fn bound(system: &mut System) -> f64 {
    let (model, counters) = (&system.model, &mut system.counters);
    system.spectrum.bound(model, &system.positions, counters)
}

/// Returns the largest frequency in the present configuration, to 1 % of ω². The value is kept
/// until topology, a mass or a stiffness changes, the state is set ([`System::state_mut`]), a step
/// is undone, or triangles that resist shear are stretched further. Steps change the configuration
/// a little each; [`measure`] computes the frequency anew.
pub fn largest(system: &mut System) -> Frequency {
    let (model, counters) = (&system.model, &mut system.counters);
    system
        .spectrum
        .frequency(model, &system.positions, counters)
}

/// The largest frequency for a step to be admitted by, not measured anew in each.
pub(crate) fn recent(system: &mut System) -> Frequency {
    let (model, counters) = (&system.model, &mut system.counters);
    let spectrum = &mut system.spectrum;
    spectrum.recent_frequency(model, &system.positions, counters)
}

/// Measures the largest frequency in the present configuration by power iteration, until the
/// residual is at most `tolerance`, or for at most `products` matrix products. It is approached
/// from below: the true frequency is larger by about the residual. In a state that is not finite
/// the result is the bound.
pub fn measure(system: &mut System, tolerance: f64, products: u32) -> Frequency {
    let (model, counters) = (&system.model, &mut system.counters);
    let (x, spectrum) = (&system.positions, &mut system.spectrum);
    spectrum.measure(model, x, counters, tolerance, products)
}

//! The largest frequency of a system, which limits the step of explicit methods.

use crate::spectrum::Frequency;
use crate::system::System;

/// An upper bound on ω, in rad/s. It holds in every configuration; for a system with triangles that
/// resist shear, it holds as long as no triangle is stretched more than now. The first call is
/// linear, and later ones use the stored value, except that the stretch of triangles is checked
/// each time.
pub fn bound(system: &mut System) -> f64 {
    let (model, counters) = (&system.model, &mut system.counters);
    system.spectrum.bound(model, &system.positions, counters)
}

/// The largest frequency in the present configuration, to 1 % of ω², kept until topology, a mass or
/// a stiffness change, the state is set ([`System::state_mut`]), a step is taken back, or triangles
/// that shear are stretched by more than then. Steps change the configuration a little each:
/// [`measure`] looks anew.
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

/// The largest frequency in the present configuration, found by power iteration until the residual
/// is at most `tolerance`, or for at most `products` matrix products. It is approached from below:
/// the true frequency is larger by about the residual. In a state that is not finite this is the
/// bound.
pub fn measure(system: &mut System, tolerance: f64, products: u32) -> Frequency {
    let (model, counters) = (&system.model, &mut system.counters);
    let (x, spectrum) = (&system.positions, &mut system.spectrum);
    spectrum.measure(model, x, counters, tolerance, products)
}

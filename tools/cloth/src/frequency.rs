//! The largest frequency of a system.

use crate::spectrum::Frequency;
use crate::system::System;

/// A bound of ω, in rad/s, that holds in every configuration, or with triangles that shear in the
/// present one and all that are stretched no more. Linear the first time, then known; with triangles
/// their stretch is looked at each time.
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

/// The largest frequency in the present configuration, by power iteration until the residual is at
/// most `tolerance`, or so many products. From below: the true one is larger by about the residual.
/// In a state that is not finite it is the bound.
pub fn measure(system: &mut System, tolerance: f64, products: u32) -> Frequency {
    let (model, counters) = (&system.model, &mut system.counters);
    let (x, spectrum) = (&system.positions, &mut system.spectrum);
    spectrum.measure(model, x, counters, tolerance, products)
}

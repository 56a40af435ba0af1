//! Material damping: what a fabric itself takes from the rate at which its edges change length.
//!
//! Without damping the energy that a tear sets free has nowhere to go: it stays in vibrations of the
//! highest frequencies of the mesh, which shatter what they reach. A spring of stiffness k between
//! particles of reduced mass μ is damped along itself by
//!
//! ```text
//! f = c dl/dt,    c = min(τ k, ζ 2 √(k μ)),    ζ = 1/10
//! ```
//!
//! with τ a time that belongs to the fabric ([`Fabric::damping_s`](crate::Fabric)). The loss factor of
//! a real fabric, .05 at 5 Hz, would be a damping ratio of about 15 at the highest frequencies of a sheet
//! of 64 × 64 cells, and cut an explicit step some thirty times. So the ratio ζ of a single spring is capped;
//! on fine meshes most springs are at the cap.
//!
//! **Why it is stable.** It acts by the velocities of the middle of the step before. With A = Δt² M⁻¹ K
//! and B = Δt M⁻¹ C, the energy of that scheme ([`crush`](crate::system::crush)) never grows, and is positive where
//! A (1 + 2θ) + 2 B ≤ 4. So c counts as a spring of the stiffness 2 c / (Δt (1 + 2θ)) wherever steps and
//! masses are chosen ([`guard`](crate::system::guard)).
//!
//! A triangle is damped as three springs are: along warp, along weft and in shear
//! ([`triangle`](crate::system::triangle)), each with the reduced mass of its corners in that mode.
//!
//! Thresholds of force do not see this force; a hand that holds or leads a particle does.

use crate::system::crush::Crush;

/// ζ.
const RATIO_MAX: f64 = 0.1;

/// Returns c for a spring of stiffness `k`, in N s/m, by the sum of the inverse masses of its ends. Zero
/// between two that are held.
pub(crate) fn coefficient(time_s: f64, stiffness: f64, inverse_masses: f64) -> f64 {
    if inverse_masses > 0.0 {
        let cap = 2.0 * RATIO_MAX * (stiffness / inverse_masses).sqrt();
        (time_s * stiffness).min(cap)
    } else {
        0.0
    }
}

/// The stiffness that a damper of 1 N s/m counts as in a step of this length.
pub(crate) fn stiffness_in(dt_s: f64) -> f64 {
    2.0 / (dt_s * (1.0 + 2.0 * Crush::SHARE))
}

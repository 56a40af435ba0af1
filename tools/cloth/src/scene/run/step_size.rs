//! Which step suits a scene.

use super::engine::Engine;
use crate::scene::{Method, Scene};
use crate::sheet::Cloth;
use crate::stability;

/// Frames of films and screens are whole parts of this, in seconds.
const FRAME_S: f64 = 1.0 / 60.0;

/// The longest step in seconds that is chosen for any scene.
const LONGEST_S: f64 = FRAME_S / 2.0;

/// A step in seconds that suits the method, the fabric and the mesh: a whole part of 1/60 s.
pub(super) fn suggested_s(scene: &Scene, engine: &Engine, cloth: &mut Cloth) -> f64 {
    let stable_s = stability::whole_step_s(cloth.system_mut(), engine);
    let stable_s = stable_s.map_or(LONGEST_S, |limit_s| 0.7 * limit_s);
    let limit_s = match scene.solver {
        Method::Provot(_) | Method::Verlet => stable_s,
        Method::Implicit(_) => FRAME_S / 4.0,
        Method::Pbd(_) | Method::Xpbd(_) => wanted_s(scene, cloth).unwrap_or(LONGEST_S),
    };
    FRAME_S
        / (FRAME_S / limit_s.min(stable_s).min(LONGEST_S))
            .ceil()
            .max(1.0)
}

/// The longest step at which a method that sweeps is about as stiff as the fabric. In a
/// sweep a pull travels an edge or two of length h, and in the fabric it travels at the speed
/// c = √(k/ρ); so the time for a sweep must not be much longer than h/c.
pub(super) fn wanted_s(scene: &Scene, cloth: &Cloth) -> Option<f64> {
    let sweeps = match scene.solver {
        Method::Xpbd(xpbd) => f64::from(xpbd.substeps.max(1)) * reach(xpbd.sweeps, 1.0),
        Method::Pbd(pbd) => reach(pbd.sweeps, pbd.fractions()[0]),
        Method::Provot(_) | Method::Verlet | Method::Implicit(_) => return None,
    };
    let stretches = cloth.system().stretches();
    if stretches.is_empty() {
        return None;
    }
    let lengths = stretches.iter().map(|id| stretches.get(id).rest_length_m);
    let edge_m = lengths.sum::<f64>() / stretches.len() as f64;
    let speed_m_per_s = (scene.fabric.stretch_n_per_m / scene.areal_density_kg_per_m2).sqrt();
    Some(SWEEP * sweeps * edge_m / speed_m_per_s)
}

/// How far a pull gets in so many sweeps without a step in between, as a multiple of one that
/// corrects all: each makes good but a part of what the one before left, as in diffusion.
fn reach(sweeps: u32, fraction: f64) -> f64 {
    (f64::from(sweeps.max(1)) * fraction).sqrt()
}

/// The time for a sweep as a multiple of h/c.
const SWEEP: f64 = 1.0;

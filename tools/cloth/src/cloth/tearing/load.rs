//! The load of an edge or a link: its strain or force as a multiple of what it bears.

use tearmesh::geometry::{Vector, cross, dot};
use tearmesh::{HalfEdgeId, Mesh};

use super::Threshold;
use crate::cloth::Cloth;
use crate::cloth::fabric::Orthotropic;
use crate::system::System;
use crate::system::constraint::ConstraintId;
use crate::system::force;
use crate::system::model::Recorded;

impl Threshold {
    /// Returns the load of a link in a system without a mesh. The link tears at 1 or more. The load
    /// is negative under compression, and `None` for thresholds that need a mesh.
    ///
    /// # Panics
    ///
    /// If there is no such constraint.
    #[must_use]
    pub fn load(&self, system: &System, id: ConstraintId) -> Option<f64> {
        let stiffness = system.stretches().get(id).stiffness_n_per_m;
        self.load_of(system, id, stiffness, 1.0)
    }

    /// The load of a link of this modulus that bears such a share of a threshold in newtons.
    fn load_of(&self, system: &System, id: ConstraintId, modulus: f64, share: f64) -> Option<f64> {
        match *self {
            Threshold::Stretch(ratio) => Some(strain(system, id) / (ratio - 1.0)),
            Threshold::Toughness(g) => {
                let length = system.stretches().get(id).rest_length_m;
                Some(strain(system, id) / strain_borne(g, modulus, length))
            }
            Threshold::Force(newtons) => Some(force::force_n(system, id) / (newtons * share)),
            Threshold::WarpWeft { .. } | Threshold::PrincipalStretch(_) => None,
        }
    }

    /// Returns the load of an edge of a cloth. The edge tears at 1 or more, if both its ends have
    /// the strength 1. The load is negative under compression, and `None` for an edge that never
    /// tears by itself.
    ///
    /// # Panics
    ///
    /// If there is no such half-edge, or the cloth is not in step with the mesh.
    #[must_use]
    pub fn edge_load(&self, mesh: &Mesh, cloth: &Cloth, h: HalfEdgeId) -> Option<f64> {
        let (system, id) = (cloth.system(), cloth.stretch(h));
        match *self {
            Threshold::WarpWeft { warp, weft, axis } => {
                let ratio = if runs_along(cloth, h, axis)? {
                    warp
                } else {
                    weft
                };
                Some(strain(system, id) / (ratio - 1.0))
            }
            Threshold::PrincipalStretch(ratio) => {
                let sides = [Some(h), mesh.pair(h)].into_iter().flatten();
                let torn_first = sides.filter(|&side| is_most_stretched(cloth, side));
                let stretch = torn_first.map(|side| cloth.principal_stretch(side.face()));
                let most = stretch.max_by(f64::total_cmp)?;
                Some((most - 1.0) / (ratio - 1.0))
            }
            Threshold::Stretch(_) | Threshold::Toughness(_) | Threshold::Force(_) => {
                let share = cloth.fabric.share(mesh, h);
                self.load_of(system, id, modulus(cloth), share)
            }
        }
    }

    /// How many times as long as at rest any edge is at least that has this load, by the strain that
    /// [`strain`] says; `None` where faces decide, or forces that no strain tells.
    pub(super) fn ratio_from(&self, cloth: &Cloth, load: f64) -> Option<f64> {
        let [longest_m, strongest_n] = cloth.system().model.stretch.most;
        let recorded = cloth.system().model.recorded;
        let has_strains = !matches!(recorded, Recorded::RigidForces | Recorded::Limiter);
        let strain = match *self {
            Threshold::Stretch(ratio) => ratio - 1.0,
            Threshold::WarpWeft { warp, weft, .. } => warp.min(weft) - 1.0,
            Threshold::Toughness(g) => strain_borne(g, modulus(cloth), longest_m),
            Threshold::Force(newtons) if has_strains => 0.5 * newtons / strongest_n,
            Threshold::Force(_) | Threshold::PrincipalStretch(_) => return None,
        };
        // The load is computed by another way, which may round down.
        let ratio = (1.0 + load * strain) * (1.0 - 16.0 * f64::EPSILON);
        Some(ratio.min(f64::MAX))
    }
}

/// Whether no other edge of a face is stretched more; the one with the lowest id, of equals.
fn is_most_stretched(cloth: &Cloth, h: HalfEdgeId) -> bool {
    let ratio = |h: HalfEdgeId| cloth.system().stretch_ratio(cloth.stretch(h));
    [h.next(), h.prev()].into_iter().all(|other| {
        let (own, others) = (ratio(h), ratio(other));
        own > others || (own == others && h < other)
    })
}

/// l / L − 1, before a limiter; and of a method that keeps the forces of springs as multipliers, that
/// of a spring with this force. The lengths that sweeps leave depend on their number and order, but at
/// rest forces balance whatever they are.
pub(super) fn strain(system: &System, id: ConstraintId) -> f64 {
    let spring = system.stretches().get(id);
    if system.model.recorded == Recorded::SpringForces && spring.stiffness_n_per_m > 0.0 {
        return force::force_n(system, id) / (spring.stiffness_n_per_m * spring.rest_length_m);
    }
    system.unlimited_ratio(id) - 1.0
}

/// Finds the stretch constraints that are at least `ratio` times as long as at rest by [`strain`], and
/// some that rounding brings there. Takes one pass, without a root.
pub(super) fn find_stretched(system: &System, ratio: f64, mut found: impl FnMut(ConstraintId)) {
    let (strain, square, x) = (ratio - 1.0, ratio * ratio, system.unlimited());
    // What is not a number is found as well.
    let mut look = |id: u32, is_short: bool| {
        if !is_short {
            found(ConstraintId(id));
        }
    };
    for colour in &system.model.stretch.colours {
        let constraints = colour.ids.iter().zip(colour.springs());
        match system.model.recorded {
            Recorded::Nothing | Recorded::RigidForces | Recorded::Limiter => {
                for (&id, ([a, b], rest, _)) in constraints {
                    let d = x[b] - x[a];
                    look(id, dot(d, d) < square * (rest * rest));
                }
            }
            Recorded::SpringForces => {
                let forces = colour.multipliers.iter().zip(&colour.compliance);
                for ((&id, (_, rest, _)), (multiplier, compliance)) in constraints.zip(forces) {
                    look(id, -multiplier * compliance < strain * rest);
                }
            }
        }
    }
}

/// What a cloth's strain is multiplied by for its tension, in N/m: of springs and, the mean of
/// warp and weft, of triangles.
fn modulus(cloth: &Cloth) -> f64 {
    let fabric = &cloth.fabric;
    let mean = |moduli: Orthotropic| (moduli.warp_n_per_m + moduli.weft_n_per_m) / 2.0;
    fabric.stretch_n_per_m() + fabric.orthotropic.map_or(0.0, mean)
}

/// √(2 G / (E h)).
fn strain_borne(toughness: f64, modulus: f64, length: f64) -> f64 {
    (2.0 * toughness / (modulus * length)).sqrt()
}

/// Whether an edge runs along the warp at rest, or else along the weft, within 22.5°; `None` for a diagonal.
///
/// The warp is the axis as seen in the plane of the edge's face: on a curved cloth it
/// follows the surface.
fn runs_along(cloth: &Cloth, h: HalfEdgeId, axis: Vector) -> Option<bool> {
    let corners = [h, h.next(), h.prev()].map(|h| cloth.rest_corners()[h.index()]);
    let edge = corners[1] - corners[0];
    let normal = cross(edge, corners[2] - corners[0]);
    let weft = cross(normal, axis);
    let warp = cross(weft, normal);
    // The squares of the edge's parts along both, times the same number.
    let along = dot(edge, warp) * dot(edge, warp) * dot(weft, weft);
    let across = dot(edge, weft) * dot(edge, weft) * dot(warp, warp);
    let bound = (along + across) / std::f64::consts::SQRT_2;
    // cos 2θ ≥ cos 45°
    if along - across >= bound && along > 0.0 {
        Some(true)
    } else if across - along >= bound && across > 0.0 {
        Some(false)
    } else {
        None
    }
}

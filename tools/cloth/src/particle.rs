//! Particles of a system that come, go and meet while a cloth follows the log.

use tearmesh::geometry::{Vector, between};
use tearmesh::{Blend, Mix, VertexId};

use crate::system::System;

/// Appends a particle that is where others are, or between them, and as fast; a copy is also held and
/// led like the one that it is of.
pub(super) fn push(system: &mut System, from: Mix<VertexId>) {
    let new = system.positions.len() as u32;
    let x = Blend::blend(from.map(|v| &system.positions[v.index()]));
    let v = Blend::blend(from.map(|v| &system.velocities[v.index()]));
    let like = match from {
        Mix::Copy(v) => Some(v.index()),
        Mix::Between { .. } | Mix::Weighted { .. } => None,
    };
    system.positions.push(x);
    system.velocities.push(v);
    let model = &mut system.model;
    model.push_particle(like.is_some_and(|particle| model.held[particle]));
    let led = |&&(particle, _): &&(u32, u32)| Some(particle as usize) == like;
    if let Some(&(_, path)) = model.grabbed.iter().find(led) {
        model.grabbed.push((new, path));
    }
}

/// Makes two particles one, where the held one is if only one is held; `gone` has no
/// constraints any more, and the last particle takes its index.
pub(super) fn join(system: &mut System, kept: usize, gone: usize, share: f64) {
    let model = &mut system.model;
    let (x, v) = (&mut system.positions, &mut system.velocities);
    x[kept] = match (model.held[kept], model.held[gone]) {
        (true, false) => x[kept],
        (false, true) => x[gone],
        _ => between(x[kept], x[gone], 1.0 - share),
    };
    model.held[kept] |= model.held[gone];
    let (mass, more) = (model.masses[kept], model.masses[gone]);
    if model.held[kept] {
        v[kept] = Vector::zeros();
    } else if v[kept] != v[gone] {
        v[kept] = (v[kept] * mass + v[gone] * more) / (mass + more);
    }
    x.swap_remove(gone);
    v.swap_remove(gone);
    model.swap_remove_particle(gone);
    let led = |&(led, _): &(u32, u32)| led as usize == kept;
    if system.model.grabbed.iter().any(led) {
        system.model.unlead(gone);
    }
    let last = system.positions.len() as u32;
    for (particle, _) in &mut system.model.grabbed {
        if *particle as usize == gone {
            *particle = kept as u32;
        } else if *particle == last {
            *particle = gone as u32;
        }
    }
}

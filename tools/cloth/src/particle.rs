//! Particles of a system that come, go and meet while a cloth follows the log.

use tearmesh::geometry::{Point, Vector, between};
use tearmesh::{Blend, Location, Mix};

use crate::system::System;

/// Appends a particle, held and led like another one.
pub(super) fn push(system: &mut System, x: Point, v: Vector, like: Option<usize>) {
    let new = system.positions.len() as u32;
    system.positions.push(x);
    system.velocities.push(v);
    let model = &mut system.model;
    model.push_particle(like.is_some_and(|particle| model.held[particle]));
    let led = |&&(particle, _): &&(u32, u32)| Some(particle as usize) == like;
    if let Some(&(_, path)) = model.grabbed.iter().find(led) {
        model.grabbed.push((new, path));
    }
    system.spectrum.push_particle(like);
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
    system.spectrum.swap_remove_particle(gone);
}

/// Where an inserted point comes to lie, and how fast.
pub(super) fn inserted(system: &System, at: Location) -> (Point, Vector) {
    let mix = Mix::from(at);
    let x = Blend::blend(mix.map(|v| &system.positions[v.index()]));
    let v = Blend::blend(mix.map(|v| &system.velocities[v.index()]));
    (x, v)
}

//! F5: what Provot's limiter does to stability: nothing, since velocities are rewritten to what was
//! really moved.
//!
//! Protocol: no drag; Δt as a part of 2/ω of the springs alone; passes 1, 2, 5 and 20.
//!
//! * *Shaken*: nets without weight that start within the limit of 1.1, at speeds up to a tenth of
//!   the shortest rest length times ω; 2000 steps; stable where energy stays below four times what it
//!   was. The limiter shortens the stable step of none, whatever the passes; where the springs alone
//!   fail, just below 2/ω, it holds them together.
//! * *Loaded*: a chain too heavy for the limit comes to rest at every step. (Where positions are held
//!   while velocities go on to grow, no step is stable under such a load, however short.)

use tearmesh::Vector;
use tearmesh_cloth::{Limiter, Provot, System, Unstable, energy};

use crate::parts::nets::{pushed, row};
use crate::parts::vibration::largest_frequency;
use crate::parts::{gravity, limited, mechanical_j, run_with, shake};
use crate::random::Random;

const PASSES: [u32; 4] = [1, 2, 5, 20];

/// The limiter with a number of passes; zero for springs alone.
fn with_passes(passes_max: u32) -> Provot {
    if passes_max == 0 {
        return Provot::unlimited();
    }
    Provot::new(Limiter {
        passes_max,
        ..Limiter::default()
    })
}

/// Nets without weight, kicked.
fn kicked(name: &str, seed: u64) -> System {
    let mut system = pushed(name, 1000.0);
    system.when_unstable(Unstable::Allow);
    let springs = system.stretches();
    let rests = springs.iter().map(|id| springs.get(id).rest_length_m);
    let speed = 0.1 * rests.fold(f64::INFINITY, f64::min) * largest_frequency(&system);
    shake(&mut system, 0.0, speed, &mut Random(seed));
    for i in 0..system.positions().len() {
        if system.is_held(i) {
            system.state_mut().1[i].fill(0.0);
        }
    }
    system
}

/// Whether energy stays below four times what it was; in nets that are shaken the limiter has work to do.
fn survives(mut system: System, passes: u32, part: f64) -> bool {
    let mut provot = with_passes(passes);
    let dt = part * 2.0 / largest_frequency(&system);
    let start = mechanical_j(&system);
    let is_calm = (0..2000)
        .all(|_| system.step(&mut provot, dt).is_ok() && mechanical_j(&system) <= 4.0 * start);
    let [_, worked] = limited(&provot, &system);
    assert!(passes != 1 || part != 0.5 || worked > 10, "{worked}");
    is_calm
}

#[test]
fn the_limiter_keeps_shaken_nets_together_at_any_step() {
    for name in ["chain", "string", "frame"] {
        for passes in [0].into_iter().chain(PASSES) {
            for part in [0.2, 0.5, 0.8, 0.999] {
                let survives = survives(kicked(name, u64::from(passes)), passes, part);
                assert_eq!(survives, part < 0.9 || passes > 0, "{name} {passes}");
            }
        }
    }
}

/// It could fall by a tenth of a metre: 0.2 J at most.
#[test]
fn a_chain_too_heavy_for_the_limit_comes_to_rest() {
    let cases = [0.05, 0.2, 0.5, 0.9].map(|part| PASSES.map(|passes| (part, passes)));
    for &(part, passes) in cases.as_flattened() {
        let mut chain = row(10, 0.02, 50.0, 0.1, Vector::z() * -0.1);
        chain.set_loads(gravity(0.0)).expect("loads");
        let dt = part * 2.0 / largest_frequency(&chain);
        let mut provot = with_passes(passes);
        run_with(&mut chain, &mut provot, dt, (20.0 / dt) as usize);
        let [passes_made, worked] = limited(&provot, &chain);
        assert!(passes_made >= worked && worked > 0);
        let kinetic = energy::kinetic_j(&chain);
        assert!(kinetic < 0.2, "{part}, {passes}: {kinetic}");
    }
}

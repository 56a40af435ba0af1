//! Wind that is set before every step: it moves cloth as wind does, and costs what wind costs.

use std::sync::Arc;

use tearmesh::{Point, Vector};
use tearmesh_cloth::{Body, Collider, Fabric, Method, Simulation, SimulationDef, Unstable, Wind};

use crate::parts::scenes::{methods, square};
use crate::parts::{gravity, onto, state};
use crate::support::fixtures::block;

const CELLS: u32 = 12;

/// The wind before a step: it turns, fades and comes back.
fn wind(step: u32) -> Wind {
    let turns = f64::from(step) / 40.0;
    let (sine, cosine) = (turns * std::f64::consts::TAU).sin_cos();
    Wind {
        velocity_m_per_s: Vector::new(3.0 * cosine, 0.5, -4.0 - 4.0 * sine),
        coefficient: 1.0 + 0.5 * cosine,
    }
}

/// A sheet that lies a centimetre above a block, or a metre.
fn above(height_m: f64, fabric: Fabric, method: &Method) -> Simulation {
    let (mesh, positions) = square(CELLS);
    let (points, faces) = block([0.2, 0.3, -1.0], [0.7, 0.8, -0.01]);
    let points: Vec<Point> = points
        .into_iter()
        .map(|p| p + Vector::z() * (0.01 - height_m))
        .collect();
    let body = Arc::new(Body::new(&points, &faces, Some(0.02)).expect("a body"));
    let loads = onto(Collider::body(body).with_friction(0.3), &gravity(0.5));
    let def = SimulationDef {
        fabric,
        method: method.clone(),
        tearing: None,
        ripple_m: Some(0.0),
        when_unstable: Unstable::Substep,
        ..SimulationDef::default()
    };
    Simulation::new(mesh, &positions, def.with_loads(loads)).expect("a simulation")
}

/// By every method, with damping and without, also where cloth lies on a body: to the bit.
#[test]
fn wind_that_is_set_to_what_it_is_changes_nothing() {
    for (name, method) in methods() {
        for fabric in [Fabric::default(), Fabric::new(1000.0)] {
            let [mut steady, mut set] = [(); 2].map(|()| above(0.01, fabric, &method));
            let mut touched = 0;
            let steps = if name == "implicit" { 25 } else { 250 };
            for step in 0..steps {
                let now = Some(wind(step / 10));
                for (sim, sets) in [(&mut steady, step % 10 == 0), (&mut set, true)] {
                    if sets {
                        sim.set_wind(now).expect("usable");
                    }
                    sim.advance(sim.step_s(), 1).expect("a step");
                }
                let states = [&steady, &set].map(|sim| state(sim.cloth().system()));
                assert_eq!(states[0], states[1], "{name} {step}");
                let thickness_m = 0.004;
                let positions = set.cloth().positions();
                touched += u32::from(positions.iter().any(|x| x.z < thickness_m - 0.01));
            }
            assert!(touched > 0, "{name}: nothing came to the body");
        }
    }
}

/// A wind that sways costs what one that blows on costs: forces are evaluated once a step, and no body is looked at.
#[test]
fn wind_that_sways_costs_what_wind_costs() {
    let cost = |sways: bool| {
        let mut sim = above(1.0, Fabric::default(), &Method::Verlet);
        for step in 0..100 {
            let step = if sways { step } else { 0 };
            sim.set_wind(Some(wind(step))).expect("usable");
            sim.advance(sim.step_s(), 1).expect("a step");
        }
        sim.cloth().system().counters()
    };
    let (blows_on, sways) = (cost(false), cost(true));
    assert_eq!(sways.force_evaluations, 101);
    assert_eq!(sways.wind_evaluations, blows_on.wind_evaluations);
    let all = u64::from((CELLS + 1).pow(2) + 2 * CELLS * CELLS);
    let looks = [blows_on, sways].map(|of| of.features.collider);
    assert_eq!(looks, [all, all], "looks for {all} particles and faces");
}

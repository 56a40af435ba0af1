//! Wind that is set before every step: it moves cloth as loads that are set do, and costs no look at bodies.

use std::sync::Arc;

use tearmesh::{Point, Vector};
use tearmesh_cloth::{
    Body, Collider, Fabric, Loads, Method, Simulation, SimulationDef, Unstable, Wind,
};

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

/// To the bit, by every method, with damping and without.
#[test]
fn wind_that_is_set_moves_cloth_as_loads_that_are_set() {
    for (name, method) in methods() {
        for fabric in [Fabric::default(), Fabric::new(1000.0)] {
            let mut sim = above(0.01, fabric, &method);
            let (mut twin, mut solver) = (sim.cloth().clone(), method.solver());
            let (step_s, mut touched) = (sim.step_s(), 0);
            let steps = if name == "implicit" { 25 } else { 250 };
            for step in 0..steps {
                let wind = Some(wind(step));
                sim.set_wind(wind).expect("usable");
                sim.advance(step_s, 1).expect("a step");
                let system = twin.system_mut();
                let loads = system.loads().clone();
                system.set_loads(Loads { wind, ..loads }).expect("usable");
                twin.step(&mut *solver, step_s).expect("a step");
                assert_eq!(
                    state(sim.cloth().system()),
                    state(twin.system()),
                    "{name} {step}"
                );
                let thickness_m = 0.004;
                let mut low = twin.positions().iter().filter(|x| x.z < thickness_m - 0.01);
                touched += u32::from(low.next().is_some());
            }
            assert!(touched > 0, "{name}: nothing came to the body");
        }
    }
}

/// A wind that is set looks at bodies no oftener than one that blows on, and evaluates forces once more a step.
#[test]
fn wind_that_is_set_looks_at_no_body_again() {
    let looks = |sets_wind: bool| {
        let mut sim = above(1.0, Fabric::default(), &Method::Verlet);
        sim.set_wind(Some(wind(0))).expect("usable");
        for step in 0..100 {
            if sets_wind {
                sim.set_wind(Some(wind(step))).expect("usable");
            }
            sim.advance(sim.step_s(), 1).expect("a step");
        }
        sim.cloth().system().counters().features.collider
    };
    let [blows_on, is_set] = [false, true].map(looks);
    let all = u64::from((CELLS + 1).pow(2) + 2 * CELLS * CELLS);
    assert!(
        blows_on == all && is_set == all,
        "{blows_on} and {is_set} looks for {all} particles and faces"
    );
}

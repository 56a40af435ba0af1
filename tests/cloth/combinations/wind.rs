//! The oracle of wind: by how much it speeds each vertex up, whatever the method and the fabric, and whoever holds the
//! other corners of a face.
//!
//! The cloth of a moment takes the same short steps with its wind and without it. They are so short that nothing else
//! makes a difference: what springs, triangles and hands answer to it is of second order. (Over a whole step the
//! momentum of a piece hides a wind that is wrong behind gravity, and behind whatever holds it.)

use tearmesh::Vector;
use tearmesh_cloth::{Cloth, Limiter, Loads, Method, Pbd, System, Unstable};

use super::factors::Case;
use super::formulas::wind_n;
use super::judge::{Fault, fault};

/// The time of a step, in seconds: with less, methods that take velocities from positions show rounding.
const INSTANT_S: f64 = 1e-7;

/// The steps: a method of two steps feels what was.
const STEPS: u32 = 2;

/// By how much the force on a vertex may be off, as a part of what its faces give, or of what such a wind gives the area
/// of the vertex, since what two faces give may cancel.
const PART: f64 = 0.02;
const LEAST_M_PER_S: f64 = 1.0;

/// Vertices below this part of the mean mass are of slivers, whose springs answer even in so short a time.
const LIGHT: f64 = 1e-3;

/// Compares what the wind of a time does to free vertices with its formula; gives how many it pushes.
pub(super) fn pushes(
    case: &Case,
    cloth: &Cloth,
    method: &Method,
    time_s: f64,
) -> Result<usize, Fault> {
    let system = cloth.system();
    let Some(wind) = system.loads().wind else {
        return Ok(0);
    };
    let loads = Loads {
        colliders: Vec::new(),
        ..system.loads().clone()
    };
    let calm = Loads {
        wind: None,
        ..loads.clone()
    };
    let refused = |why: String| fault("wind", format!("after {time_s} s: {why}"));
    let [blown, calm] = [loads, calm].map(|loads| stepped(system, method, loads));
    let (blown, calm) = (blown.map_err(refused)?, calm.map_err(refused)?);
    // What is led has the velocity of its way by then.
    let own_n = wind_n(case, &calm, cloth.indices(), time_s);
    let (masses, [blown, calm]) = (system.masses(), [&blown, &calm].map(System::velocities));
    let mean_kg = masses.iter().sum::<f64>() / masses.len() as f64;
    let is_judged = |v: &usize| !system.is_held(*v) && masses[*v] > LIGHT * mean_kg;
    let mut pushed = 0;
    for v in (0..masses.len()).filter(is_judged) {
        let found = (blown[v] - calm[v]) * (masses[v] / (f64::from(STEPS) * INSTANT_S));
        let off = (found - own_n[v]).norm();
        if off > PART * (own_n[v].norm() + wind.coefficient * LEAST_M_PER_S * masses[v] / 0.2) {
            let text = format!(
                "after {time_s} s wind pushes vertex {v} by {:?} N, not by {:?} N",
                found.as_slice(),
                own_n[v].as_slice()
            );
            return Err(fault("wind", text));
        }
        pushed += usize::from(own_n[v] != Vector::zeros());
    }
    Ok(pushed)
}

/// A system after a moment under other loads.
fn stepped(system: &System, method: &Method, loads: Loads) -> Result<System, String> {
    let mut system = system.clone();
    system.set_loads(loads).map_err(|error| error.to_string())?;
    system.when_unstable(Unstable::Allow);
    let mut solver = forces_alone(method).solver();
    for _ in 0..STEPS {
        let taken = system.step(&mut *solver, INSTANT_S);
        taken.map_err(|error| error.to_string())?;
    }
    Ok(system)
}

/// The method without what moves edges however short a step is.
fn forces_alone(method: &Method) -> Method {
    match method {
        Method::Provot(limiter) => Method::Provot(Limiter {
            stretch_ratio_max: 1e9,
            ..*limiter
        }),
        Method::Pbd(pbd) => Method::Pbd(Pbd {
            stiffness: 0.0,
            bend_stiffness: 0.0,
            ..*pbd
        }),
        other => other.clone(),
    }
}

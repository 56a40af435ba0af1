//! Orders of convergence: the error in the state of an oscillator after a quarter of a second.

use tearmesh::Vector;

use super::{Links, METHODS};
use crate::parts::{method, near, order, run_with};

/// The relative error in x and v/ω after 0.25 s.
fn error(links: Links, name: &str, dt: f64) -> f64 {
    let omega = 4000.0_f64.sqrt();
    let mut system = links.row(1, 0.01, 40.0, 1.0, Vector::x());
    links.change(&mut system, 1, |p, _| p.x = 1.1);
    let steps = (0.25 / dt).round() as usize;
    run_with(&mut system, &mut *method(name, 1), dt, steps);
    let x = links.point(&system, 1).x - 1.0 - 0.1 * (omega * 0.25).cos();
    let v = system.velocities()[links.at(1).start].x / omega + 0.1 * (omega * 0.25).sin();
    (x * x + v * v).sqrt() / 0.1
}

/// PBD has none: as Δt → 0 it converges to no solution (F7).
#[test]
fn table_of_orders() {
    for links in [Links::Springs, Links::Triangles] {
        for &name in METHODS {
            let (dt, expected) = match name {
                "Verlet" | "guarded" => (1.0 / 4096.0, 2.0),
                "BDF2" => (1.0 / 8192.0, 2.0),
                "RK4" => (1.0 / 1024.0, 4.0),
                "PBD" => continue,
                "XPBD" if links == Links::Triangles => continue,
                _ => (1.0 / 32_768.0, 1.0),
            };
            let errors = [dt, dt / 2.0].map(|dt| error(links, name, dt));
            near(order(errors), expected, 0.05);
        }
    }
}

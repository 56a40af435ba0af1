//! The script of `tools/python/tests/test_digest.py`: a cut, and a simulation that is held, cut, grabbed and torn,
//! give the digests that the Python module has to give.

use tearmesh::{CutMethod, Mesh, Plane, Point, Scissor, Sheet, Vector, VertexId, shapes};
use tearmesh_cloth::{Simulation, SimulationDef};

use crate::digest;

const EXPECTED: &str = include_str!("../data/wheel.txt");

fn line(name: &str, mesh: &Mesh, points: &[Point]) -> String {
    let numbers = points.iter().flat_map(|p| [p.x, p.y, p.z]);
    let ids = mesh.indices().iter().copied().chain(mesh.roots());
    let bytes = numbers.flat_map(f64::to_le_bytes);
    let bytes = bytes.chain(ids.flat_map(u32::to_le_bytes));
    format!("{name} {:016x}\n", digest::after(digest::EMPTY, bytes))
}

#[test]
fn the_script_of_the_python_module_has_its_digests() -> Result<(), Box<dyn std::error::Error>> {
    let plane = Plane::new(Point::new(0.31, 0.4, 0.0), Vector::new(1.0, 0.3, 0.0))?;
    let (mesh, positions) = shapes::grid(16, 16);
    let mut sheet = Sheet::new(mesh.clone(), positions.clone());
    sheet.cut(CutMethod::Exact, &Scissor::by_plane(plane))?;
    let cut = line("cut", sheet.mesh(), sheet.positions().as_slice());

    let mut sim = Simulation::new(mesh, &positions, SimulationDef::default())?;
    sim.hold((272..289).filter_map(VertexId::new))?;
    sim.cut(&Scissor::by_plane(plane))?;
    sim.advance(0.1, u64::MAX)?;
    let grabbed = VertexId::new(152).ok_or("small")?;
    let hand = sim.grab(grabbed, Simulation::GRIP_RADIUS_M)?;
    sim.lead(hand, Point::new(0.5, -1.5, 0.5))?;
    sim.advance(0.5, u64::MAX)?;
    assert!(sim.events().len() > 10, "it tears");
    let simulation = line("simulation", sim.mesh(), sim.cloth().positions());
    assert_eq!(format!("{cut}{simulation}"), EXPECTED);
    Ok(())
}

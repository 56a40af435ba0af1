//! The points of a simulation, for whoever writes them: the mesh in the end, and the frames.

use tearmesh::Positions;
use tearmesh_cloth::scene::Run;

use crate::exit::{Exit, Stop};
use crate::say::Fault;

/// Where the vertices of a run are; refused if one of them is nowhere.
pub(super) fn places(run: &Run) -> Result<Positions, Stop> {
    let points = run.cloth().positions().iter().copied();
    Positions::new(points).map_err(|error| {
        let fault = Fault::error("E-SIM-BLOWUP", error.to_string());
        Stop::new(Exit::Simulation, fault)
    })
}

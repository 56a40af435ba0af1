//! The beginning of a scene, for a simulation in which a person or a program decides what happens later.

use tearmesh::geometry::Point;
use tearmesh::{Mesh, Scissor, VertexId};

use super::frame::Frame;
use super::run::error::RunError;
use super::run::held::vertices_in;
use super::{Scene, SwayingWind};
use crate::simulation::definition::SimulationDef;

/// What a [`Simulation`](crate::Simulation) begins with, to begin as a scene does.
///
/// ```
/// use tearmesh::shapes;
/// use tearmesh_cloth::Simulation;
/// use tearmesh_cloth::scene::{Axis, Frame, Scene};
///
/// let (mesh, positions) = shapes::grid(8, 8);
/// let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
/// let opening = Scene::hang(&frame).opening(&mesh, positions.as_slice(), &frame)?;
/// let mut cloth = Simulation::new(mesh, &positions, opening.def)?;
/// cloth.hold(opening.held)?;
/// cloth.advance(0.1, u64::MAX)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Opening {
    /// The definition of the simulation. Its loads have the wind as it begins to blow, since the step has to suit it:
    /// one that begins later is to be [set](crate::Simulation::set_wind) as it is at 0.
    pub def: SimulationDef,
    /// The vertices that are held, ascending: those of all holds that begin at 0 and lead nowhere, or of the first
    /// that leads if there are none.
    pub held: Vec<VertexId>,
    /// The cuts at 0, in order.
    pub cuts: Vec<Scissor>,
    /// The wind, which may sway.
    pub wind: Option<SwayingWind>,
}

impl Scene {
    /// Returns how this scene begins on a mesh. `points` are the positions of its vertices.
    ///
    /// # Errors
    ///
    /// [`RunError`] if a region contains no vertex, or names one that the mesh does not have, and for a wind, a hold
    /// or a cut that cannot be.
    pub fn opening(
        &self,
        mesh: &Mesh,
        points: &[Point],
        frame: &Frame,
    ) -> Result<Opening, RunError> {
        self.check()?;
        let holds = self.holds.iter().enumerate();
        let first = || holds.clone().filter(|(_, hold)| hold.from_s == 0.0);
        let mut still: Vec<_> = first().filter(|(_, hold)| !hold.leads()).collect();
        if still.is_empty() {
            still.extend(first().next());
        }
        let mut held = Vec::new();
        for (number, hold) in still {
            held.extend(vertices_in(
                &hold.region,
                ("hold", number),
                mesh,
                points,
                frame,
            )?);
        }
        held.sort_unstable();
        held.dedup();
        let cuts = self.cuts.iter().filter(|cut| cut.at_s == 0.0);
        Ok(Opening {
            def: self.def(mesh, points, frame)?,
            held,
            cuts: cuts.filter_map(|cut| cut.scissor().ok()).collect(),
            wind: self.wind,
        })
    }

    /// The definition of a simulation with the fabric, the method and the loads of the scene.
    pub(super) fn def(
        &self,
        mesh: &Mesh,
        points: &[Point],
        frame: &Frame,
    ) -> Result<SimulationDef, RunError> {
        Ok(SimulationDef {
            density_kg_per_m2: self.areal_density_kg_per_m2,
            fabric: self.fabric,
            method: self.solver.clone(),
            tearing: self.tearing,
            strengths: self.vertex_strengths(mesh, points, frame)?,
            rest: self.rest.clone(),
            ripple_m: self.ripple_m,
            seams: self.seams.clone(),
            loads: self.loads(),
            step_s: self.step_s,
            ..SimulationDef::default()
        })
    }
}

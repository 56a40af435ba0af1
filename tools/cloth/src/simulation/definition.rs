//! The definition of a simulation: its material, method, loads and rules.

use tearmesh::{Point, Vector};

use crate::cloth::fabric::Fabric;
use crate::cloth::seam::Seam;
use crate::cloth::tearing::Tearing;
use crate::method::Method;
use crate::system::Unstable;
use crate::system::load::Loads;

/// The definition of a simulation beside its mesh.
#[derive(Clone, Debug)]
pub struct SimulationDef {
    /// The mass of the cloth per area, in kg/m²: 0.15 by default, as of shirt cotton.
    pub density_kg_per_m2: f64,
    /// The material: by default a membrane of 1000 N/m with 1.6 ms of damping ([`Fabric::default`]).
    pub fabric: Fabric,
    /// The method: by default [`Method::Verlet`].
    pub method: Method,
    /// The rule by which edges tear, by default at one and a half times their rest length; `None`
    /// for never.
    pub tearing: Option<Tearing>,
    /// The strength of each vertex, as a multiple of the threshold; empty, as by default, for 1
    /// everywhere.
    pub strengths: Vec<f64>,
    /// The rest shape of faces: a place in metres for each corner, face by face. Empty for where they are.
    pub rest: Vec<Point>,
    /// The texture coordinates for [drawing](super::Simulation::draw_buffers): those of each corner, face by face.
    /// Empty, as by default, for zero everywhere.
    pub texture: Vec<[f32; 2]>,
    /// The seams of a garment, whose panels are the mesh; none by default.
    pub seams: Vec<Seam>,
    /// The loads: by default gravity along −y, and the drag of still air.
    pub loads: Loads,
    /// The length of a step, in seconds; `None`, as by default, for one that suits the method, the
    /// fabric and the mesh.
    pub step_s: Option<f64>,
    /// Whether a step beyond the stability limit is divided, as by default, or refused.
    pub when_unstable: Unstable,
    /// Whether inputs are [logged](super::Simulation::log): by default not.
    pub is_recorded: bool,
}

impl Default for SimulationDef {
    fn default() -> SimulationDef {
        SimulationDef {
            density_kg_per_m2: 0.15,
            fabric: Fabric::default(),
            method: Method::Verlet,
            tearing: Some(Tearing::default()),
            strengths: Vec::new(),
            rest: Vec::new(),
            texture: Vec::new(),
            seams: Vec::new(),
            loads: Loads {
                gravity_m_per_s2: Some(Vector::new(0.0, -9.81, 0.0)),
                drag_per_s: Some(0.5),
                ..Loads::default()
            },
            step_s: None,
            when_unstable: Unstable::Substep,
            is_recorded: false,
        }
    }
}

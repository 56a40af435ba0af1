//! The definition of a simulation: its material, method, loads and rules.

use tearmesh::{Point, Vector};

use crate::cloth::fabric::Fabric;
use crate::cloth::seam::Seam;
use crate::cloth::tearing::Tearing;
use crate::method::Method;
use crate::system::Unstable;
use crate::system::load::{Loads, Wind};

/// The definition of a simulation beside its mesh.
///
/// ```
/// use tearmesh_cloth::{Fabric, Method, SimulationDef};
///
/// let def = SimulationDef::default()
///     .with_fabric(Fabric::new(200.0))
///     .with_method(Method::xpbd())
///     .with_recording();
/// assert_eq!(def.density_kg_per_m2, 0.15);
/// ```
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
    /// The amplitude in metres of the ripple of a flat cloth; 0 for none, and `None`, as by default, for a millionth of
    /// its size. Where all vertices of a component of the mesh lie within a thousand-millionth of its size of one
    /// plane, those that are not held are displaced along its normal, by four sines of their place, at the beginning
    /// of the first step in which a vertex of the cloth is held, a wind blows or there is a collider. Without, what
    /// is pulled in its plane could never buckle, and would tear too late.
    pub ripple_m: Option<f64>,
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
            ripple_m: None,
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

impl SimulationDef {
    /// Sets the mass of the cloth per area, in kg/m².
    #[must_use]
    pub fn with_density(self, density_kg_per_m2: f64) -> SimulationDef {
        SimulationDef {
            density_kg_per_m2,
            ..self
        }
    }

    /// Sets the material.
    #[must_use]
    pub fn with_fabric(self, fabric: Fabric) -> SimulationDef {
        SimulationDef { fabric, ..self }
    }

    /// Sets the method.
    #[must_use]
    pub fn with_method(self, method: Method) -> SimulationDef {
        SimulationDef { method, ..self }
    }

    /// Sets the rule by which edges tear; `None` for never.
    #[must_use]
    pub fn with_tearing(self, tearing: impl Into<Option<Tearing>>) -> SimulationDef {
        let tearing = tearing.into();
        SimulationDef { tearing, ..self }
    }

    /// Sets the strength of each vertex, as a multiple of the threshold.
    #[must_use]
    pub fn with_strengths(self, strengths: Vec<f64>) -> SimulationDef {
        SimulationDef { strengths, ..self }
    }

    /// Sets the rest shape: a place in metres for each corner, face by face.
    #[must_use]
    pub fn with_rest(self, rest: Vec<Point>) -> SimulationDef {
        SimulationDef { rest, ..self }
    }

    /// Sets the texture coordinates of each corner, face by face.
    #[must_use]
    pub fn with_texture(self, texture: Vec<[f32; 2]>) -> SimulationDef {
        SimulationDef { texture, ..self }
    }

    /// Sets the amplitude in metres of the ripple of a flat cloth; 0 for none.
    #[must_use]
    pub fn with_ripple(self, ripple_m: f64) -> SimulationDef {
        let ripple_m = Some(ripple_m);
        SimulationDef { ripple_m, ..self }
    }

    /// Sets the seams of a garment.
    #[must_use]
    pub fn with_seams(self, seams: Vec<Seam>) -> SimulationDef {
        SimulationDef { seams, ..self }
    }

    /// Sets the loads, all of them.
    #[must_use]
    pub fn with_loads(self, loads: Loads) -> SimulationDef {
        SimulationDef { loads, ..self }
    }

    /// Sets the wind among the loads.
    #[must_use]
    pub fn with_wind(self, wind: Wind) -> SimulationDef {
        let wind = Some(wind);
        let loads = Loads { wind, ..self.loads };
        SimulationDef { loads, ..self }
    }

    /// Sets the length of a step, in seconds.
    #[must_use]
    pub fn with_step(self, step_s: f64) -> SimulationDef {
        let step_s = Some(step_s);
        SimulationDef { step_s, ..self }
    }

    /// Sets whether a step beyond the stability limit is divided or refused.
    #[must_use]
    pub fn with_unstable(self, when_unstable: Unstable) -> SimulationDef {
        SimulationDef {
            when_unstable,
            ..self
        }
    }

    /// Has inputs [logged](super::Simulation::log).
    #[must_use]
    pub fn with_recording(self) -> SimulationDef {
        let is_recorded = true;
        SimulationDef {
            is_recorded,
            ..self
        }
    }
}

//! A cloth in motion, with the verbs of the library.

use std::collections::BTreeSet;
use std::path::PathBuf;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tearmesh_cloth::{
    Collider, CutId, Event, Fabric, HandId, InputError, Loads, Method, Picked, SimulationDef,
    StepError, Tearing, Threshold, Wind, Wounds, force,
};
use tearmesh_core::{Mesh, Plane, Positions, Ray, Vector, VertexId};

use crate::arguments::{Triple, parts_of, scissor_of};
use crate::arrays::{self, Array, Made, array, floats, indices, rows};
use crate::errors::{nothing_tears, value_error};
use crate::numbers;
use crate::scene;
use crate::torn::{Log, pieces_of};
use crate::waiting::{Listener, heard};

/// A cloth in motion. It is at rest where it is given. Lengths are in metres, masses in kilograms, times in seconds,
/// and forces in newtons.
///
/// points, faces, roots: as for `cut`. density: in kg/m². modulus: the resistance to stretch, in N/m. damping: a time
/// in s, with verlet only. method: "verlet", "implicit", "xpbd", "pbd" or "provot". stretch: an edge tears at this
/// multiple of its rest length; None for never. toughness: instead, the energy per metre of tear, in J/m. weakening:
/// the strength of the tips of a tear, as a part of that of whole cloth. strengths: (n,) floats, the strength of
/// each vertex as a multiple of the threshold; both are refused where nothing tears. gravity: in m/s², by default (0, -9.81, 0). drag: in 1/s. colliders: a
/// list of planes (point, normal) and balls (centre, radius). friction: Coulomb's coefficient of them all. ripple: how
/// far in m a flat cloth begins out of its plane with the first step in which something holds or touches it, so that it
/// can buckle; by default a millionth of its size, and 0 for not. step: its length in s, by default one that suits.
///
/// Splits append vertices. Sewing takes vertices away, and the last vertex gets the number that becomes free. Holds and
/// hands follow; arrays of your own follow by `map`.
///
/// The attributes points, velocities (n, 3), faces (m, 3), roots (n,) and pieces (m,) are new arrays each time: the cloth
/// moves on, and they do not. time and step_length are in s; open_pairs is the number of pairs that still heal.
///
/// Whatever takes long releases the GIL. A simulation that another thread changes meanwhile raises RuntimeError.
#[pyclass(module = "tearmesh")]
pub(crate) struct Simulation {
    sim: tearmesh_cloth::Simulation,
    /// Of the mesh before the last call that may have changed it.
    before: Log,
    hands: Vec<HandId>,
    cuts: Vec<CutId>,
}

impl Simulation {
    fn of(
        py: Python<'_>,
        mesh: Mesh,
        positions: Positions,
        def: SimulationDef,
    ) -> PyResult<Simulation> {
        let made = move || tearmesh_cloth::Simulation::new(mesh, &positions, def);
        let sim = heard(py, made)?.map_err(value_error)?;
        Ok(Simulation {
            before: Log::new(sim.mesh(), sim.edits().cursor()),
            hands: Vec::new(),
            cuts: Vec::new(),
            sim,
        })
    }

    fn advanced(&mut self, py: Python<'_>, seconds: f64, steps_max: u64) -> PyResult<u64> {
        self.begin();
        let (sim, mut listener) = (&mut self.sim, Listener::new());
        let reached = py.detach(|| sim.advance_while(seconds, steps_max, || listener.goes_on()));
        if let Some(raised) = listener.raised {
            return Err(raised);
        }
        let failed = |error: StepError| PyRuntimeError::new_err(error.to_string());
        Ok(reached.map_err(failed)?.steps)
    }

    /// From here on, changes are mapped.
    fn begin(&mut self) {
        self.before = Log::new(self.sim.mesh(), self.sim.edits().cursor());
    }

    fn event<'py>(&self, py: Python<'py>, event: Event) -> PyResult<Bound<'py, PyTuple>> {
        match event {
            Event::Tore {
                edge,
                vertex,
                time_s,
                force_n,
            } => {
                let (vertex, face) = (vertex.index(), edge.face().index());
                ("tore", time_s, vertex, face, force_n).into_pyobject(py)
            }
            Event::Cut {
                cut,
                splits,
                time_s,
            } => {
                let cut = self.cuts.iter().position(|&known| known == cut);
                ("cut", time_s, cut, splits).into_pyobject(py)
            }
            Event::Healed {
                sewn,
                left,
                ended,
                time_s,
            } => ("healed", time_s, sewn, left, ended).into_pyobject(py),
            other => (format!("{other:?}"), self.sim.time_s()).into_pyobject(py),
        }
    }
}

/// A plane or a ball, from its two parts.
fn collider((place, second): (Triple, Array<'_>), friction: f64) -> PyResult<Collider> {
    if let Ok(radius_m) = second.extract::<f64>() {
        return Ok(Collider::sphere(place.into(), radius_m).with_friction(friction));
    }
    let plane = Plane::new(place.into(), second.extract::<Triple>()?.into());
    Ok(Collider::plane(plane.map_err(value_error)?).with_friction(friction))
}

/// The rule for tearing, if anything tears.
fn tearing(
    stretch: Option<f64>,
    toughness: Option<f64>,
    weakening: Option<f64>,
) -> PyResult<Option<Tearing>> {
    // A toughness stands instead of a stretch, which has to be a number nevertheless.
    if let Some(stretch) = stretch {
        numbers::not_negative("stretch", "a number", stretch)?;
    }
    let stretch = stretch.map(Threshold::Stretch);
    let threshold = toughness.map(Threshold::Toughness).or(stretch);
    if threshold.is_none() && weakening.is_some() {
        return Err(nothing_tears("weakening"));
    }
    let tearing = |threshold| Tearing {
        weakening,
        ..Tearing::new(threshold)
    };
    Ok(threshold.map(tearing))
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (points, faces, *, roots=None, density=0.15, modulus=1000.0, damping=1.6e-3, method="verlet", stretch=1.5, toughness=None, weakening=None, strengths=None, gravity=None, drag=0.5, colliders=None, friction=0.0, ripple=None, step=None))]
    #[expect(clippy::too_many_arguments, reason = "in Python they have names")]
    fn new(
        points: &Array<'_>,
        faces: &Array<'_>,
        roots: Option<&Array<'_>>,
        density: f64,
        modulus: f64,
        damping: f64,
        method: &str,
        stretch: Option<f64>,
        toughness: Option<f64>,
        weakening: Option<f64>,
        strengths: Option<&Array<'_>>,
        gravity: Option<Triple>,
        drag: f64,
        colliders: Option<Vec<(Triple, Array<'_>)>>,
        friction: f64,
        ripple: Option<f64>,
        step: Option<f64>,
    ) -> PyResult<Simulation> {
        let (mesh, positions) = parts_of(points, faces, roots)?;
        let named = Method::named(method);
        let unknown = || format!("method is one of {:?}, not {method:?}", Method::NAMES);
        let tearing = tearing(stretch, toughness, weakening)?;
        if tearing.is_none() && strengths.is_some() {
            return Err(nothing_tears("strengths"));
        }
        numbers::not_negative("friction", "a number", friction)?;
        let strengths = strengths.map(|given| floats("strengths", given, &[arrays::ANY]));
        let colliders = colliders
            .into_iter()
            .flatten()
            .map(|it| collider(it, friction));
        let def = SimulationDef {
            density_kg_per_m2: density,
            fabric: Fabric {
                damping_s: damping,
                ..Fabric::new(modulus)
            },
            method: named.ok_or_else(|| value_error(unknown()))?,
            tearing,
            strengths: strengths.transpose()?.unwrap_or_default(),
            loads: Loads {
                gravity_m_per_s2: Some(gravity.unwrap_or([0.0, -9.81, 0.0]).into()),
                drag_per_s: Some(drag),
                wind: None,
                colliders: colliders.collect::<PyResult<_>>()?,
            },
            ripple_m: ripple,
            step_s: step,
            ..SimulationDef::default()
        };
        Simulation::of(points.py(), mesh, positions, def)
    }

    /// Returns a cloth in motion that begins as a scene file (TOML) of the command `tearmesh tear` says: with its fabric,
    /// method, wind, colliders, seams and rule for tearing, and with what it holds and cuts at 0 s.
    ///
    /// points, faces, roots, uv: as for `cut`; uv is per corner, and is the shape at rest in a scene whose fabric has vt_m: no
    /// face may be flipped there, or without area. path: of the file. Bodies are read
    /// from files beside it, and its vertices count from 1. What leads, begins or ends later is left to you; if nothing is
    /// held still at 0 s, the first that is led is held. Raises OSError, or ValueError with all that is wrong.
    #[staticmethod]
    #[pyo3(signature = (points, faces, path, *, roots=None, uv=None))]
    fn of_scene(
        points: &Array<'_>,
        faces: &Array<'_>,
        path: PathBuf,
        roots: Option<&Array<'_>>,
        uv: Option<&Array<'_>>,
    ) -> PyResult<Simulation> {
        let (mesh, positions) = parts_of(points, faces, roots)?;
        let uv = uv.map(|uv| floats("uv", uv, &[mesh.face_count(), 3, 2]));
        let (py, uv) = (points.py(), uv.transpose()?);
        let opening = py.detach(|| scene::opening(&path, &mesh, &positions, uv.as_deref()))?;
        let mut made = Simulation::of(py, mesh, positions, opening.def)?;
        py.detach(|| {
            if let Some(wind) = opening.wind.filter(|wind| wind.from_s > 0.0) {
                made.sim.set_wind(Some(wind.at(0.0)))?;
            }
            made.sim.hold(opening.held)?;
            for scissor in &opening.cuts {
                made.cuts.push(made.sim.cut(scissor)?);
            }
            Ok(made)
        })
        .map_err(|error: InputError| value_error(error))
    }

    /// Lets this many seconds pass, in whole steps and at most steps_max of them, and returns the number of steps.
    ///
    /// What is less than half a step is made up for by the next call. Raises RuntimeError if a step fails, as when the
    /// cloth blows up; the cloth is then as it was after the last good step. Ctrl-C is heard between steps.
    #[pyo3(signature = (seconds, steps_max=None))]
    fn advance(
        &mut self,
        py: Python<'_>,
        seconds: f64,
        steps_max: Option<&Array<'_>>,
    ) -> PyResult<u64> {
        let steps_max = steps_max.map(numbers::steps_max).transpose()?;
        numbers::not_negative("seconds", "a time", seconds)?;
        self.advanced(py, seconds, steps_max.unwrap_or(u64::MAX))
    }

    /// Takes count steps, and returns their number. Raises RuntimeError as `advance` does.
    #[pyo3(signature = (count=1))]
    fn step(
        &mut self,
        py: Python<'_>,
        #[pyo3(from_py_with = numbers::count)] count: u64,
    ) -> PyResult<u64> {
        self.advanced(py, count as f64 * self.sim.step_s(), count)
    }

    /// Holds vertices (integers) where they are, until they are freed. Raises ValueError if one is in a hand or is no vertex.
    fn hold(&mut self, vertices: &Array<'_>) -> PyResult<()> {
        let (py, vertices) = (vertices.py(), arrays::vertices("vertices", vertices)?);
        py.detach(|| self.sim.hold(vertices)).map_err(value_error)
    }

    /// Lets held vertices (integers) go.
    fn free(&mut self, vertices: &Array<'_>) -> PyResult<()> {
        let (py, vertices) = (vertices.py(), arrays::vertices("vertices", vertices)?);
        py.detach(|| self.sim.free(vertices)).map_err(value_error)
    }

    /// Returns what a ray meets first: the nearest vertex, the face, and the three weights of its corners; or None.
    fn pick(
        &self,
        py: Python<'_>,
        origin: Triple,
        direction: Triple,
    ) -> PyResult<Option<(usize, usize, Triple)>> {
        let ray = Ray::new(origin.into(), direction.into()).map_err(value_error)?;
        let picked = py.detach(|| self.sim.pick(&ray));
        let parts = |p: Picked| (p.vertex.index(), p.hit.face.index(), p.hit.weights);
        Ok(picked.map(parts))
    }

    /// Grabs a vertex, and returns the number of the hand. Within radius (in m, at rest) the cloth around is stronger, so
    /// that the hand tears out more than the vertex; 0 for no such grip.
    #[pyo3(signature = (vertex, radius=0.12))]
    fn grab(&mut self, vertex: &Array<'_>, radius: f64) -> PyResult<usize> {
        let (py, vertex) = (vertex.py(), numbers::vertex(vertex)?);
        let hand = py.detach(|| self.sim.grab(vertex, radius));
        self.hands.push(hand.map_err(value_error)?);
        Ok(self.hands.len() - 1)
    }

    /// Leads a hand straight to a point (x, y, z): within 1/60 s, or at 3 m/s if that is too far.
    fn lead(&mut self, hand: &Array<'_>, to: Triple) -> PyResult<()> {
        let hand = numbers::numbered("hand", hand, &self.hands)?;
        self.sim.lead(hand, to.into()).map_err(value_error)
    }

    /// Lets go of what a hand holds.
    fn release(&mut self, hand: &Array<'_>) -> PyResult<()> {
        let (py, hand) = (hand.py(), numbers::numbered("hand", hand, &self.hands)?);
        py.detach(|| self.sim.release(hand)).map_err(value_error)
    }

    /// Cuts the cloth where it is now, and returns the number of the cut. Arguments as for the function `cut`.
    #[pyo3(signature = (plane=None, rays=None, *, layers="all", snap=0.05))]
    fn cut(
        &mut self,
        py: Python<'_>,
        plane: Option<[Triple; 2]>,
        rays: Option<[[Triple; 2]; 2]>,
        layers: &str,
        snap: f64,
    ) -> PyResult<usize> {
        let scissor = scissor_of(plane, rays, layers, snap)?;
        self.begin();
        let cut = py.detach(|| self.sim.cut(&scissor));
        self.cuts.push(cut.map_err(value_error)?);
        Ok(self.cuts.len() - 1)
    }

    /// Begins to heal a cut, or with None everything that is torn, and returns the number of pairs of vertices that are
    /// drawn together from now on.
    #[pyo3(signature = (cut=None))]
    fn heal(&mut self, py: Python<'_>, cut: Option<&Array<'_>>) -> PyResult<usize> {
        let cut = cut.map(|cut| numbers::numbered("cut", cut, &self.cuts));
        let wounds = cut.transpose()?.map_or(Wounds::All, Wounds::Cut);
        py.detach(|| self.sim.heal(wounds)).map_err(value_error)
    }

    /// Has a wind of this velocity (in m/s) blow from now on, or with None no wind. coefficient: of its force on faces, in
    /// kg/(m² s).
    #[pyo3(signature = (velocity, coefficient=1.0))]
    fn set_wind(
        &mut self,
        py: Python<'_>,
        velocity: Option<Triple>,
        coefficient: f64,
    ) -> PyResult<()> {
        let wind = velocity.map(|velocity| Wind {
            velocity_m_per_s: velocity.into(),
            coefficient,
        });
        numbers::not_negative("coefficient", "a number", coefficient)?;
        py.detach(|| self.sim.set_wind(wind)).map_err(value_error)
    }

    /// Returns what happened since the previous call, in order: ("tore", time, vertex, face, force or None), ("cut", time,
    /// cut, splits), ("healed", time, sewn, left, ended). Vertices and faces are those of that time.
    fn events<'py>(&mut self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyTuple>>> {
        let events: Vec<Event> = self.sim.events().collect();
        let events = events.into_iter().map(|event| self.event(py, event));
        events.collect()
    }

    /// Returns the force (3,) in N that it takes to hold or lead these vertices together, each of which counts once. Raises
    /// ValueError for no vertex.
    fn reaction<'py>(&self, vertices: &Array<'py>) -> Made<'py> {
        let (py, vertices) = (vertices.py(), arrays::vertices("vertices", vertices)?);
        let sum = py.detach(|| {
            let once: BTreeSet<VertexId> = vertices.into_iter().collect();
            let (count, system) = (self.sim.mesh().vertex_count(), self.sim.cloth().system());
            let force = |v: &VertexId| match v.index() < count {
                true => Ok(force::reaction_n(system, v.index())),
                false => Err(InputError::NoVertex(*v)),
            };
            once.iter().map(force).sum::<Result<Vector, InputError>>()
        });
        let sum = sum.map_err(value_error)?;
        array(py, sum.as_slice().to_vec(), &[3])
    }

    /// Carries an array over the last call of `step`, `advance` or `cut`: as TornMesh.map does.
    #[pyo3(signature = (values, per="vertex", how=None))]
    fn map<'py>(&self, values: &Array<'py>, per: &str, how: Option<&str>) -> Made<'py> {
        self.before.map(self.sim.edits(), values, per, how)
    }

    fn __repr__(&self) -> String {
        let mesh = self.sim.mesh();
        let (vertices, faces) = (mesh.vertex_count(), mesh.face_count());
        let time_s = self.sim.time_s();
        format!("<tearmesh.Simulation: {vertices} points, {faces} faces, at {time_s:.6} s>")
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Made<'py> {
        rows(py, self.sim.cloth().positions().iter().map(|&p| p.into()))
    }

    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> Made<'py> {
        let velocities = self.sim.cloth().system().velocities();
        rows(py, velocities.iter().map(|&v| v.into()))
    }

    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> Made<'py> {
        let mesh = self.sim.mesh();
        indices(py, mesh.indices(), &[mesh.face_count(), 3])
    }

    #[getter]
    fn roots<'py>(&self, py: Python<'py>) -> Made<'py> {
        let roots = py.detach(|| self.sim.mesh().roots());
        indices(py, &roots, &[roots.len()])
    }

    #[getter]
    fn pieces<'py>(&self, py: Python<'py>) -> Made<'py> {
        pieces_of(py, self.sim.mesh())
    }

    #[getter]
    fn time(&self) -> f64 {
        self.sim.time_s()
    }

    #[getter]
    fn step_length(&self) -> f64 {
        self.sim.step_s()
    }

    #[getter]
    fn open_pairs(&self) -> usize {
        self.sim.open_pairs()
    }
}

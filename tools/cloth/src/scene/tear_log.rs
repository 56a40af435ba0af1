//! Records what tore in a run, when and where, and how hard its holds pulled.

use std::collections::VecDeque;

use tearmesh::geometry::{Vector, between, length};
use tearmesh::{HalfEdgeId, Point, VertexId};

use super::HeldVertices;
use super::run::Run;
use crate::cloth::tearing::apply::TearReport;
use crate::method::{FRAME_S, Method};
use crate::system::balance::AIR_S;
use crate::system::force;

/// A step in which something tore.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct TearEvent {
    /// The time at which the load of the edge at `place` reached its strength, in seconds, by the velocities of its
    /// ends: within the step, or at its end if the load was as large before.
    pub time_s: f64,
    /// The number of vertices that were split.
    pub splits: usize,
    /// The total rest length of the edges that came apart, in metres.
    pub torn_m: f64,
    /// The midpoint of the edge with the largest load divided by strength, at the end of the step.
    pub place: Point,
    /// The midpoint of that edge at rest.
    pub place_at_rest: Point,
    /// The largest load divided by strength: 1 or more.
    pub load: f64,
}

/// The forces at all holds of a scene, as means over a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct HoldForces {
    /// The time at the end of the frame, in seconds.
    pub end_s: f64,
    /// For each hold of the scene, in order, the force in newtons that it takes to hold or lead its
    /// vertices, including their weight. It is zero before the hold begins and after it has ended.
    pub forces_n: Vec<Vector>,
}

/// A record of a run: its tears, and the forces at its holds. Call [`TearLog::note`] after each
/// step.
///
/// Forces are means over a [`FRAME_S`], since those of single steps depend on the method as much as
/// on the cloth. They are the forces that the method exerts: force times displacement is the work
/// of the hands that lead vertices. With Provot's method no forces are known, since its limiter
/// moves particles without a force.
///
/// A step costs the valence of the held vertices. With wind, forces are sampled at most once a
/// millisecond, and a sample costs a pass over all faces for each held vertex.
///
/// ```
/// use tearmesh_cloth::scene::{Axis, TearLog, Frame, Run, Scene};
/// use tearmesh::shapes;
///
/// let (mesh, positions) = shapes::grid(6, 6);
/// let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
/// let mut run = Run::new(mesh, &positions, Scene::rip(&frame), &frame)?;
/// let mut log = TearLog::new(&run);
/// while !run.is_over() {
///     let tear = run.step()?;
///     log.note(&run, &tear);
/// }
/// let first = log.events().first().ok_or("it rips")?;
/// assert!(first.time_s > 0.5); // It is grabbed then.
/// let force_n = log.first_force_n().ok_or("Verlet knows forces")?;
/// assert!(force_n > 0.0 && Some(force_n) <= log.largest_force_n());
/// let splits: usize = log.events().iter().map(|event| event.splits).sum();
/// assert_eq!(splits as u64, run.tally().splits);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct TearLog {
    events: Vec<TearEvent>,
    /// The largest force at the first tear; `None` if the method does not know its forces.
    first_n: Option<f64>,
    /// The largest force of a single step.
    peak_n: f64,
    frames: Vec<HoldForces>,
    /// Whether each hold is led, or all count since none is.
    counts: Vec<bool>,
    /// The forces of the last frame's time: how long each lasted, and at what holds.
    recent: VecDeque<(f64, Vec<Vector>)>,
    /// The sum of forces times seconds since the last frame ended, and those seconds.
    sum: Vec<Vector>,
    sum_s: f64,
    /// The time since forces were taken last.
    waited_s: f64,
}

impl TearLog {
    /// Creates the log of a run that has not begun.
    #[must_use]
    pub fn new(run: &Run) -> TearLog {
        let holds = &run.scene().holds;
        let has_led = holds.iter().any(HeldVertices::leads);
        TearLog {
            events: Vec::new(),
            first_n: (!matches!(run.scene().solver, Method::Provot(_))).then_some(0.0),
            peak_n: 0.0,
            frames: Vec::new(),
            counts: holds.iter().map(|hold| !has_led || hold.leads()).collect(),
            recent: VecDeque::new(),
            sum: vec![Vector::zeros(); holds.len()],
            sum_s: 0.0,
            waited_s: 0.0,
        }
    }

    /// Records a step that the run has just taken.
    pub fn note(&mut self, run: &Run, tear: &TearReport) {
        if self.first_n.is_some() {
            self.weigh(run);
        }
        let Some((edge, load)) = tear.worst.filter(|_| tear.splits > 0) else {
            return;
        };
        let (mesh, cloth) = (run.mesh(), run.cloth());
        let middle = |x: &[Point], ends: [usize; 2]| between(x[ends[0]], x[ends[1]], 0.5);
        let ends = [mesh.origin(edge), mesh.target(edge)].map(VertexId::index);
        let corners = [edge, edge.next()].map(HalfEdgeId::index);
        let ago_s = ago_s(run, edge, load);
        if self.events.is_empty() && self.first_n.is_some() {
            self.first_n = Some(self.largest(|hold| self.mean_n(hold, ago_s)));
        }
        self.events.push(TearEvent {
            time_s: run.elapsed_s() - ago_s,
            splits: tear.splits,
            torn_m: tear.tear_length_m,
            place: middle(cloth.positions(), ends),
            place_at_rest: middle(cloth.rest_corners(), corners),
            load,
        });
    }

    /// Takes the forces at all holds.
    fn weigh(&mut self, run: &Run) {
        self.waited_s += run.step_s();
        let system = run.cloth().system();
        let is_due = system.loads().wind.is_none() || self.waited_s >= AIR_S;
        if !is_due && !run.is_over() {
            return;
        }
        let seconds = std::mem::take(&mut self.waited_s);
        let at = |hold: usize| {
            let held = run.held(hold).iter();
            held.map(|v| force::reaction_n(system, v.index())).sum()
        };
        let forces: Vec<Vector> = (0..self.sum.len()).map(at).collect();
        self.peak_n = self.peak_n.max(self.largest(|hold| forces[hold]));
        for (sum, force) in self.sum.iter_mut().zip(&forces) {
            *sum += *force * seconds;
        }
        self.sum_s += seconds;
        self.recent.push_back((seconds, forces));
        let mut kept_s: f64 = self.recent.iter().map(|(seconds, _)| seconds).sum();
        while let Some((oldest_s, _)) = self.recent.front()
            && kept_s - oldest_s >= FRAME_S + run.step_s()
        {
            kept_s -= oldest_s;
            self.recent.pop_front();
        }
        if self.sum_s >= FRAME_S * (1.0 - 1e-9) || run.is_over() {
            let per_s = 1.0 / std::mem::take(&mut self.sum_s);
            let sums = self.sum.iter_mut();
            let forces_n = sums.map(|sum| std::mem::take(sum) * per_s).collect();
            self.frames.push(HoldForces {
                end_s: run.elapsed_s(),
                forces_n,
            });
        }
    }

    /// The mean force of a hold over the frame that ended so many seconds before the last step did.
    fn mean_n(&self, hold: usize, ago_s: f64) -> Vector {
        let (mut began_s, mut sum, mut sum_s) = (0.0_f64, Vector::zeros(), 0.0);
        for (seconds, forces) in self.recent.iter().rev() {
            let ended_s = began_s + seconds;
            let within_s = ended_s.min(ago_s + FRAME_S) - began_s.max(ago_s);
            sum += forces[hold] * within_s.max(0.0);
            sum_s += within_s.max(0.0);
            began_s = ended_s;
        }
        sum / sum_s
    }

    /// Returns the steps in which something tore, in ascending order of time.
    #[must_use]
    pub fn events(&self) -> &[TearEvent] {
        &self.events
    }

    /// Returns the largest force at a hold in newtons, as a mean over the [`FRAME_S`] before the first
    /// tear, by the rule of [`TearLog::largest_force_n`]. `None` if nothing tore, or if the method does
    /// not know its forces.
    #[must_use]
    pub fn first_force_n(&self) -> Option<f64> {
        self.first_n.filter(|_| !self.events.is_empty())
    }

    /// Returns the forces at all holds, frame by frame. The last frame may be shorter than
    /// [`FRAME_S`]. The slice is empty if the method does not know its forces.
    #[must_use]
    pub fn hold_forces(&self) -> &[HoldForces] {
        &self.frames
    }

    /// Returns the largest force at a single hold in newtons, as a mean over a frame. If any holds
    /// are led, only those count. `None` if the method does not know its forces.
    #[must_use]
    pub fn largest_force_n(&self) -> Option<f64> {
        let frames = self.frames.iter();
        let largest = frames.map(|frame| self.largest(|hold| frame.forces_n[hold]));
        Some(largest.fold(self.first_n?, f64::max))
    }

    /// Returns the largest force at a single hold in any step, in newtons, by the rule of
    /// [`TearLog::largest_force_n`]. It depends on the step, and on vibrations that a frame averages out.
    #[must_use]
    pub fn peak_force_n(&self) -> Option<f64> {
        self.first_n.map(|_| self.peak_n)
    }

    fn largest(&self, of: impl Fn(usize) -> Vector) -> f64 {
        let counted = (0..self.counts.len()).filter(|&hold| self.counts[hold]);
        counted.map(|hold| length(of(hold))).fold(0.0, f64::max)
    }
}

/// The time since an edge that tears had the load 1, at the end of a step: loads are in proportion to strains.
fn ago_s(run: &Run, edge: HalfEdgeId, load: f64) -> f64 {
    let (mesh, system, step_s) = (run.mesh(), run.cloth().system(), run.step_s());
    let [a, b] = [mesh.origin(edge), mesh.target(edge)].map(VertexId::index);
    let rest_m = system
        .stretches()
        .get(run.cloth().stretch(edge))
        .rest_length_m;
    let way = system.positions()[b] - system.positions()[a];
    let before = way - (system.velocities()[b] - system.velocities()[a]) * step_s;
    let [strain, strain_before] = [way, before].map(|way| length(way) / rest_m - 1.0);
    let load_before = load * strain_before / strain;
    let is_new = load_before < 1.0 && load > load_before;
    if is_new {
        step_s * (load - 1.0) / (load - load_before)
    } else {
        0.0
    }
}

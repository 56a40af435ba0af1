//! A scene in progress: step by step, with everything that happens in it at its time.
//!
//! A [`Run`] owns a mesh and the cloth that follows it. Each [`Run::step`] takes and lets go what is
//! held, cuts what is to be cut, lets the wind turn, advances the cloth, and tears what is stretched
//! too far; whoever else follows the mesh replays [`Run::edits`] after it. Times of a scene are
//! rounded to whole steps. Nothing here reads a clock, so the same scene gives the same bytes.

pub(super) mod error;
pub(super) mod gain;
pub(super) mod held;

use std::num::NonZero;

use tearmesh::geometry::{Point, Vector, check_point, dot, length};
use tearmesh::{Cursor, CutReport, Edits, Mesh, PositionError, Positions, VertexId};

use self::error::RunError;
use self::gain::{EnergyGain, Watch};
use self::held::{Held, path_of};
use super::frame::Frame;
use super::{Scene, SwayingWind};
use crate::cloth::Cloth;
use crate::cloth::tearing::apply::TearReport;
use crate::method::solver::{Quality, Solver, StepError};
use crate::simulation::Simulation;
use crate::simulation::definition::SimulationDef;
use crate::simulation::error::{InputError, SimulationError};
use crate::simulation::hand::gripped;
use crate::simulation::report::PairTally;
use crate::system::Unstable;
use crate::system::balance::{Balance, EnergyBalance};
use crate::system::blow_up::BlowUpSite;
use crate::system::energy::{elastic_j, kinetic_j, potential_j};
use crate::system::error::SettingError;

/// A scene in progress, with its mesh and its cloth.
///
/// ```
/// use tearmesh_cloth::scene::{Axis, Frame, Run, Scene};
/// use tearmesh::shapes;
///
/// let (mesh, positions) = shapes::grid(12, 12);
/// let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
/// let mut run = Run::new(mesh, &positions, Scene { duration_s: 0.1, ..Scene::hang(&frame) }, &frame)?;
/// while !run.is_over() {
///     run.step()?;
/// }
/// assert_eq!(run.tally().splits, 0); // What merely hangs does not tear.
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
#[derive(Debug)]
pub struct Run {
    scene: Scene,
    pub(super) sim: Simulation,
    pub(super) held: Vec<Held>,
    /// The edits that holds have followed.
    seen: Cursor,
    next_cut: usize,
    cuts_made: Vec<CutReport>,
    steps_planned: u64,
    tally: RunTally,
    balance: Balance,
    watch: Watch,
}

/// Totals and extremes of a run so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunTally {
    /// The number of steps taken.
    pub steps: u64,
    /// The number of vertices that tearing has split.
    pub splits: u64,
    /// The number of steps in which the cap on splits left an edge that would have torn.
    pub steps_at_cap: u64,
    /// The elastic energy of the edges that tore, in joules, which turned into motion.
    pub edge_energy_j: f64,
    /// The largest ratio of an edge's length to its rest length, before Provot's limiter: in each frame
    /// of 1/60 s, at the end, and in each step in which an edge was overstretched.
    pub stretch_ratio_max: f64,
    /// The farthest that a vertex moved in one substep, in metres. It is measured only if the scene
    /// has a ball, since a fast vertex may pass through one; otherwise it is 0.
    pub(crate) farthest_m: f64,
    /// The largest change of momentum by a cut or by the tears of a step, as a fraction of Σ |m v|
    /// before it.
    pub momentum_drift: f64,
}

impl Run {
    /// Creates a run of a scene, with this mesh at rest. `frame` must be the frame for which the
    /// scene was created.
    ///
    /// # Errors
    ///
    /// [`RunError`] if the scene is not valid, or does not fit the mesh.
    pub fn new(
        mesh: Mesh,
        positions: &Positions,
        scene: Scene,
        frame: &Frame,
    ) -> Result<Run, RunError> {
        scene.check()?;
        let points = positions.as_slice();
        let held = scene.holds.iter().enumerate();
        let held = held.map(|(number, hold)| Held::new(number, hold, &mesh, points, frame));
        let held = held.collect::<Result<Vec<_>, _>>()?;
        let is_seam = |name: &String| scene.seams.iter().any(|seam| seam.name == *name);
        let is_usable =
            |(at_s, name): &(f64, String)| *at_s >= 0.0 && at_s.is_finite() && is_seam(name);
        if let Some(number) = scene.unpicks.iter().position(|unpick| !is_usable(unpick)) {
            return Err(RunError::Unpick { number });
        }
        let def = SimulationDef {
            // A step of our own choice is not refused because of what tore since.
            when_unstable: match scene.step_s {
                Some(_) => Unstable::Refuse,
                None => Unstable::Substep,
            },
            ..scene.def(&mesh, points, frame)?
        };
        let duration_s = scene.duration_s;
        let sim = Simulation::new(mesh, positions, def);
        let mut sim = sim.map_err(|error| match error {
            SimulationError::Step(step_s) => RunError::Times { step_s, duration_s },
            error => RunError::Simulation(error),
        })?;
        let step_s = sim.step_s();
        let steps_planned = (duration_s / step_s).round();
        let is_countable = (0.0..=Run::STEPS_MAX as f64).contains(&steps_planned);
        if !(duration_s >= 0.0 && is_countable) {
            return Err(RunError::Times { step_s, duration_s });
        }
        let last_s = Run::STEPS_MAX as f64 * step_s;
        if let Some(SwayingWind { period_s, .. }) = scene.wind {
            let is_counted = (last_s / period_s).is_finite();
            SettingError::unless(is_counted, "wind.period_s", period_s, "longer")
                .map_err(RunError::Wind)?;
        }
        Ok(Run {
            watch: Watch::new(sim.cloth.system(), step_s),
            balance: Balance::new(sim.cloth.system_mut()),
            seen: sim.edits.cursor(),
            sim,
            held,
            next_cut: 0,
            cuts_made: Vec::new(),
            steps_planned: steps_planned as u64,
            tally: RunTally {
                stretch_ratio_max: 1.0,
                ..RunTally::default()
            },
            scene,
        })
    }

    /// The largest number of steps in a run.
    pub(crate) const STEPS_MAX: u64 = 1 << 40;

    /// Divides the step of a run that has not begun by `parts`, to show which results depend on the
    /// step. A step that the run chose itself is divided further if stability needs it.
    ///
    /// ```
    /// use std::num::NonZero;
    /// use tearmesh_cloth::scene::{Axis, Frame, Run, Scene};
    /// use tearmesh::shapes;
    ///
    /// let (mesh, positions) = shapes::grid(4, 4);
    /// let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    /// let run = Run::new(mesh, &positions, Scene::hang(&frame), &frame)?;
    /// let (step_s, steps) = (run.step_s(), run.steps_planned());
    /// let finer = run.in_smaller_steps(NonZero::new(2).unwrap());
    /// assert_eq!((finer.step_s(), finer.steps_planned()), (step_s / 2.0, 2 * steps));
    /// # Ok::<(), tearmesh_cloth::scene::RunError>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If a step was taken already, or the run would need more than 2⁴⁰ steps.
    pub fn in_smaller_steps(mut self, parts: NonZero<u32>) -> Run {
        assert_eq!(self.tally.steps, 0, "the run has not begun");
        self.sim.step_s /= f64::from(parts.get());
        self.steps_planned = self.steps_planned.saturating_mul(parts.get().into());
        assert!(self.steps_planned <= Run::STEPS_MAX, "steps can be counted");
        self.watch = Watch::new(self.cloth().system(), self.step_s());
        self
    }

    /// Has a solver of the caller's take the steps of a run that has not begun, in place of the
    /// method of the scene. The step is still the scene's: [`Scene::step_s`], or one that suits its
    /// method.
    ///
    /// ```
    /// use tearmesh_cloth::Verlet;
    /// use tearmesh_cloth::scene::{Axis, Frame, Run, Scene};
    /// use tearmesh::shapes;
    ///
    /// let (mesh, positions) = shapes::grid(4, 4);
    /// let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    /// let run = || Run::new(mesh.clone(), &positions, Scene::hang(&frame), &frame);
    /// let (mut one, mut other) = (run()?, run()?.with_solver(Verlet));
    /// for _ in 0..100 {
    ///     one.step()?;
    ///     other.step()?;
    /// }
    /// assert_eq!(one.cloth().positions(), other.cloth().positions());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If a step was taken already.
    pub fn with_solver(mut self, solver: impl Solver + Send + Sync + 'static) -> Run {
        assert_eq!(self.tally.steps, 0, "the run has not begun");
        self.sim.solver = Box::new(solver);
        self
    }

    /// Displaces the vertices of a run that has not begun, each by its offset in metres. The rest
    /// state does not change, and holds take the vertices where they then are. A cloth that was flat
    /// without this still gets its ripple.
    ///
    /// # Errors
    ///
    /// [`PositionError`] if the new position of a vertex is not finite or too large.
    ///
    /// # Panics
    ///
    /// If a step was taken already.
    pub fn displaced(
        mut self,
        mut by_m: impl FnMut(VertexId) -> Vector,
    ) -> Result<Run, PositionError> {
        assert_eq!(self.tally.steps, 0, "the run has not begun");
        let points = self.cloth().positions().iter();
        let moved = self.mesh().vertices().zip(points);
        let moved = Positions::new(moved.map(|(v, &x)| x + by_m(v)))?;
        let system = self.sim.cloth.system_mut();
        self.balance.displace(system, |system| {
            system.state_mut().0.copy_from_slice(moved.as_slice());
        });
        Ok(self)
    }

    /// Advances the scene by one step, and returns the report of tearing in it.
    ///
    /// # Errors
    ///
    /// [`StepError`]; the cloth is then as it was at the end of the last good step, except for cuts
    /// made at the beginning of this one ([`Run::cuts_made`]).
    pub fn step(&mut self) -> Result<TearReport, StepError> {
        self.sim.edits.clear();
        self.sim.events.clear();
        self.cuts_made.clear();
        let done = self.advance(self.tally.steps);
        // A step that fails has been cut as well.
        self.follow();
        done
    }

    /// Has the holds follow the mesh.
    fn follow(&mut self) {
        for edit in self.sim.edits.since(self.seen) {
            self.held.iter_mut().for_each(|held| held.follow(&edit));
        }
        self.seen = self.sim.edits.cursor();
    }

    fn advance(&mut self, now: u64) -> Result<TearReport, StepError> {
        let step_s = self.step_s();
        let (system, balance) = (self.sim.cloth.system_mut(), &mut self.balance);
        held::take_and_release(&mut self.held, now, step_s, system, balance);
        self.unpick(now);
        self.cut(now)?;
        self.blow(now);
        let substeps = self.sim.step_observed(Some(&mut self.balance))?;
        self.tally.steps += 1;
        self.measure_moves(step_s / f64::from(substeps));
        let is_frame = self.tally.steps.is_multiple_of(self.watch.every);
        let tear = self.tear_overstretched();
        self.sew();
        if is_frame || tear.overstretched > 0 || self.is_over() {
            // Splits move nothing: edges are as long as they were before.
            let system = self.sim.cloth.system();
            let edges = system.stretches().iter();
            let ratios = edges.map(|id| system.unlimited_ratio(id));
            self.tally.stretch_ratio_max = ratios.fold(self.tally.stretch_ratio_max, f64::max);
        }
        if is_frame {
            let elapsed_s = self.elapsed_s();
            self.watch.judge(elapsed_s, &self.energy_balance());
        }
        Ok(tear)
    }

    /// Notes how far vertices move in a substep, where there is something to get past.
    fn measure_moves(&mut self, substep_s: f64) {
        if self.scene.colliders.is_empty() {
            return;
        }
        let velocities = self.cloth().system().velocities().iter();
        let fastest = velocities.map(|v| dot(*v, *v)).fold(0.0, f64::max).sqrt();
        self.tally.farthest_m = self.tally.farthest_m.max(fastest * substep_s);
    }

    /// Unpicks the seams whose time has come.
    fn unpick(&mut self, now: u64) {
        let (unpicks, step_s) = (self.scene.unpicks.iter(), self.step_s());
        let due = unpicks.filter(|(at_s, _)| held::step_at(*at_s, step_s) == now);
        let due: Vec<String> = due.map(|(_, name)| name.clone()).collect();
        for name in due {
            let before = Measured::of(self.cloth());
            let done = self.sim.unpick_more(&name);
            done.expect("seams that are unpicked have their names");
            self.compare(&before);
        }
    }

    /// Makes the cuts whose time has come.
    fn cut(&mut self, now: u64) -> Result<(), StepError> {
        while let Some(cut) = self.scene.cuts.get(self.next_cut)
            && held::step_at(cut.at_s, self.step_s()) <= now
        {
            let before = Measured::of(self.cloth());
            let scissor = cut.scissor().expect("the rays of cuts span planes");
            let made = self.sim.cut_measured(&scissor, cut.method);
            let elapsed_s = self.elapsed_s();
            let (_, report) = made.map_err(|error| match error {
                InputError::Cut(error) => StepError::Cut { elapsed_s, error },
                InputError::Positions(error) => StepError::BlowUp {
                    elapsed_s,
                    at: BlowUpSite::Particle(error.unusable()[0].0.index()),
                },
                _ => unreachable!("a cut is refused for its rays or its positions"),
            })?;
            self.compare(&before);
            self.follow();
            let (system, balance) = (self.sim.cloth.system_mut(), &mut self.balance);
            held::bind(&self.held, system, balance);
            self.cuts_made.push(report);
            self.next_cut += 1;
        }
        Ok(())
    }

    fn blow(&mut self, now: u64) {
        let Some(wind) = self.scene.wind.filter(|wind| !wind.is_constant()) else {
            return;
        };
        // It begins with the step that its time is rounded to, though that may begin a rounding error earlier.
        let mut time_s = now as f64 * self.step_s();
        if held::step_at(wind.from_s, self.step_s()) <= now {
            time_s = time_s.max(wind.from_s);
        }
        let wind = wind.at(time_s);
        let set = self.sim.set_wind(Some(wind));
        set.expect("wind between two usable winds is usable");
    }

    fn tear_overstretched(&mut self) -> TearReport {
        let mut before = None;
        let look = |cloth: &Cloth| before = Some(Measured::of(cloth));
        let report = self.sim.tear_observed(look);
        self.tally.splits += report.splits as u64;
        self.tally.edge_energy_j += report.edge_energy_j;
        self.tally.steps_at_cap += u64::from(report.cap_hit);
        if let Some(before) = before.filter(|_| report.splits > 0) {
            self.compare(&before);
        }
        report
    }

    /// Draws seams together, and sews them where they meet. Held sides give momentum, as hands do.
    fn sew(&mut self) {
        if self.sim.open_pairs() > 0 {
            let before_j = Measured::of(self.cloth()).energy_j;
            self.sim.heal_step();
            let made_j = Measured::of(self.cloth()).energy_j - before_j;
            self.balance.add_edits(made_j);
        }
    }

    /// Notes what edits made of momentum and energy.
    fn compare(&mut self, before: &Measured) {
        let after = Measured::of(self.cloth());
        self.balance.add_edits(after.energy_j - before.energy_j);
        if before.size > 0.0 {
            let drift = length(after.momentum - before.momentum) / before.size;
            self.tally.momentum_drift = self.tally.momentum_drift.max(drift);
        }
    }

    /// Returns whether all steps of the scene were taken.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.tally.steps >= self.steps_planned
    }

    /// Returns whether an event at this time, in seconds, takes place. Times are rounded to steps,
    /// and an event at the end of the last step never happens.
    pub(crate) fn reaches(&self, time_s: f64) -> bool {
        held::step_at(time_s, self.step_s()) < self.steps_planned
    }

    /// Returns the number of steps of the whole scene.
    #[must_use]
    pub fn steps_planned(&self) -> u64 {
        self.steps_planned
    }

    /// Returns the step in seconds. A scene without a step of its own gets 1/60 s divided by a
    /// whole number:
    ///
    /// * Verlet: at most the step that suits nine tenths of the vertices
    ///   ([`recommended_step_s`](crate::recommended_step_s)); the others are carried by their neighbours, and
    ///   so are vertices that become light by a tear or a cut.
    /// * Provot: at most 0.925 of the longest step that is admitted at rest. If a tear or a cut lowers
    ///   the limit, each step is divided ([`Unstable::Substep`]).
    /// * PBD, XPBD: at most a step at which it is about as stiff as the fabric, since a pull travels only
    ///   an edge or two in each sweep.
    /// * Implicit: 1/240 s.
    ///
    /// A chosen step is also at most 0.7 of the limit set by wind
    /// ([`air_rate`](crate::air::air_rate)).
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.sim.step_s()
    }

    /// Returns an estimate, from the masses, of how much softer XPBD leaves the cloth than its
    /// fabric at the step of this scene: the mean excess stretch of the edges of a cloth that hangs
    /// at rest, as a fraction of the stretch that the fabric's stiffness gives; `None` for other
    /// methods. Takes linear time.
    #[must_use]
    pub fn softness(&self) -> Option<f64> {
        let system = self.cloth().system();
        let softness = self.scene.solver.softness(system, self.step_s());
        softness.map(|softness| softness.extra)
    }

    /// Returns the amplitude of the [ripple](crate::SimulationDef::ripple_m) that was made, in metres; 0 if none was yet.
    #[must_use]
    pub fn ripple_m(&self) -> f64 {
        self.sim.ripple_m()
    }

    /// Returns the time simulated so far, in seconds.
    #[must_use]
    pub fn elapsed_s(&self) -> f64 {
        self.tally.steps as f64 * self.step_s()
    }

    /// Returns totals and extremes of the run so far.
    #[must_use]
    pub fn tally(&self) -> RunTally {
        self.tally
    }

    /// Returns the report of the method about its steps so far. Costs up to a force evaluation.
    #[must_use]
    pub fn quality(&self) -> Quality {
        self.sim.solver.quality(self.cloth().system())
    }

    /// Returns the energy balance of the scene so far. Costs a pass over all constraints.
    #[must_use]
    pub fn energy_balance(&self) -> EnergyBalance {
        self.balance.now(self.cloth().system())
    }

    /// Returns the energy that the method made out of nothing; `None` unless it exceeded a hundredth
    /// of the energy that was put in. The cloth then tears more than it should, and its pieces fly
    /// about. This is checked every 1/60 s. A shorter step helps, as does drag or a method that
    /// damps.
    pub(super) fn energy_gain(&self) -> Option<EnergyGain> {
        self.watch.is_beyond.then_some(self.watch.gain)
    }

    /// Returns the scene that this run carries out.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the mesh in its present state, with all cuts and tears.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.sim.mesh
    }

    /// Returns the cloth in its present state.
    #[must_use]
    pub fn cloth(&self) -> &Cloth {
        &self.sim.cloth
    }

    /// Returns the edits of the mesh in the last step, for followers to replay.
    #[must_use]
    pub fn edits(&self) -> &Edits {
        self.sim.edits()
    }

    /// Returns the reports of the cuts made at the beginning of the last step, even if that step failed
    /// later. The cuts of a scene are made in order, each once.
    #[must_use]
    pub fn cuts_made(&self) -> &[CutReport] {
        &self.cuts_made
    }

    /// Returns the vertices that a hold of the scene holds or leads now, in ascending order: with copies, and with
    /// what cuts inserted between them. Holds are numbered from 0. The slice is empty before the hold begins and
    /// after it ends.
    ///
    /// # Panics
    ///
    /// If the scene has no hold of this number.
    #[must_use]
    pub fn held(&self, hold: usize) -> &[VertexId] {
        self.held[hold].now().vertices()
    }

    /// Returns what became of the pairs of vertices of the seams.
    #[must_use]
    pub fn pairs(&self) -> PairTally {
        self.sim.pairs()
    }

    /// Returns the length at rest of all torn edges, each counted once, in metres; without those of seams that are not
    /// sewn yet, or unpicked.
    #[must_use]
    pub fn torn_length_m(&self) -> f64 {
        let torn = |h: &_| self.mesh().ghost_pair(*h).is_some() && !self.sim.is_open_seam(*h);
        let torn = self.mesh().half_edges().filter(torn);
        torn.map(|h| self.cloth().side_length(h)).sum::<f64>() / 2.0
    }
}

impl Scene {
    /// Returns the strength of each vertex by the regions and the grips of the scene; nothing for 1 everywhere.
    ///
    /// # Errors
    ///
    /// [`RunError`] if a region contains no vertex, or names one that the mesh does not have.
    pub fn vertex_strengths(
        &self,
        mesh: &Mesh,
        points: &[Point],
        frame: &Frame,
    ) -> Result<Vec<f64>, RunError> {
        let holds = self.holds.iter().enumerate();
        let grips = holds.filter_map(|(number, hold)| Some((number, &hold.region, hold.grip_m?)));
        let mut grips = grips.peekable();
        if self.tearing.is_none() || (self.strengths.is_empty() && grips.peek().is_none()) {
            return Ok(Vec::new());
        }
        let mut strengths = vec![1.0; mesh.vertex_count()];
        for (number, (region, strength)) in self.strengths.iter().enumerate() {
            let name = ("strength", number);
            for v in held::vertices_in(region, name, mesh, points, frame)? {
                strengths[v.index()] = *strength;
            }
        }
        for (number, region, radius_m) in grips {
            let held = held::vertices_in(region, ("hold", number), mesh, points, frame)?;
            let length_m =
                |h| length(points[mesh.target(h).index()] - points[mesh.origin(h).index()]);
            for (v, grip) in gripped(mesh, length_m, &held, radius_m) {
                let strength = &mut strengths[v.index()];
                *strength = strength.max(grip);
            }
        }
        Ok(strengths)
    }

    /// Refuses wind, holds and cuts with which no mesh could be played.
    pub(crate) fn check(&self) -> Result<(), RunError> {
        let wind = self.wind.as_ref().map_or(Ok(()), SwayingWind::check);
        wind.map_err(RunError::Wind)?;
        for (number, hold) in self.holds.iter().enumerate() {
            let later = |until_s: f64| until_s > hold.from_s;
            let finite = hold.from_s >= 0.0 && hold.from_s.is_finite();
            let ways = [&hold.moves, &hold.turns];
            let leads = |way: &&Vec<_>| way.is_empty() || path_of(way).is_some();
            let turns = check_point(hold.about).is_ok() && ways.iter().all(leads);
            if !finite || !hold.until_s.is_none_or(later) || !turns {
                return Err(RunError::Moves { number });
            }
        }
        let mut last_s = 0.0;
        for (number, cut) in self.cuts.iter().enumerate() {
            let given_s = cut.at_s;
            if !(given_s >= last_s && given_s.is_finite()) {
                return Err(RunError::CutTime { number, given_s });
            }
            last_s = given_s;
            let scissor = cut.scissor();
            scissor.map_err(|error| RunError::Cut { number, error })?;
        }
        Ok(())
    }
}

/// What edits are to keep.
struct Measured {
    /// In kg m/s.
    momentum: Vector,
    /// The sum of the sizes of its parts.
    size: f64,
    energy_j: f64,
}

impl Measured {
    fn of(cloth: &Cloth) -> Measured {
        let system = cloth.system();
        let particles = system.velocities().iter().zip(system.masses());
        Measured {
            momentum: particles.clone().map(|(v, m)| v * *m).sum(),
            size: particles.map(|(v, m)| length(*v) * m).sum(),
            energy_j: kinetic_j(system) + elastic_j(system) + potential_j(system),
        }
    }
}

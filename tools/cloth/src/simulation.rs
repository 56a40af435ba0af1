//! A cloth in the hand: hold it, grab it, lead it, cut it, let it tear and heal while time passes.
//!
//! A [`Simulation`] owns everything that has to follow when a mesh changes (positions, masses,
//! particles, strengths, draw buffers, hands), so that a game, a page or a script calls verbs and
//! looks at events. Those who want the parts use [`Cloth`] and [`Tear`] themselves.
//!
//! Nothing here reads a clock. Time passes in whole steps of one length, whatever the caller's
//! frames are; a budget counts steps. So the inputs and the numbers of the steps before which they
//! came decide every byte of the result.

mod buffers;
pub(crate) mod definition;
#[cfg(test)]
mod edited;
pub(crate) mod error;
pub(crate) mod hand;
mod heal;
mod log;
pub(crate) mod report;
mod ripple;
mod seams;

pub use buffers::{BufferChanges, ClothBuffers};
pub use definition::SimulationDef;
pub use error::{InputError, ReplayError, SimulationError};
pub use hand::HandId;
pub use heal::Wounds;
pub use log::{InputLog, LogError};
pub use report::{CutId, Event, PairTally, Picked, Reached};

use tearmesh::geometry::{Point, Ray, check_point, cross, length};
use tearmesh::{
    Cursor, CutMethod, CutReport, Edits, FaceId, Follower as _, HalfEdgeId, Masses, Mesh, Mix,
    PerVertex, Positions, Scissor, VertexId, engine::pick, mend, unshare,
};

use self::hand::Hands;
use self::heal::{Ends, Healing};
use self::log::Record;
use self::ripple::Ripple;
use self::seams::Seams;
use crate::cloth::held_set::HeldSet;
use crate::cloth::tearing::apply::{Tear, TearReport};
use crate::cloth::{Cloth, ClothError};
use crate::method::solver::{Solver, StepError};
use crate::system::System;
use crate::system::balance::Balance;
use crate::system::load::Wind;

/// A cloth with its mesh, in motion.
///
/// ```
/// use tearmesh_cloth::{Event, Simulation, SimulationDef, Wounds};
/// use tearmesh::{Point, Ray, Scissor, Vector, VertexId, shapes};
///
/// let (mesh, positions) = shapes::grid(16, 16);
/// let mut sim = Simulation::new(mesh, &positions, SimulationDef::default())?;
/// sim.hold((272..289).filter_map(VertexId::new))?; // Its upper edge.
/// sim.advance(0.1, 1000)?;
///
/// // Pull at what the pointer is on.
/// let ray = |x, y| Ray::new(Point::new(x, y, 5.0), Vector::new(0.0, 0.0, -1.0));
/// let picked = sim.pick(&ray(0.5, 0.5)?).ok_or("the pointer is on the cloth")?;
/// let hand = sim.grab(picked.vertex, Simulation::GRIP_RADIUS_M)?;
/// sim.lead(hand, Point::new(0.5, 0.5, 0.1))?;
/// sim.release(hand)?;
///
/// // Slit it, and let it heal.
/// let cut = sim.cut(&Scissor::new(ray(0.3, 0.7)?, ray(0.7, 0.7)?)?)?;
/// assert!(sim.heal(Wounds::Cut(cut))? > 0);
/// sim.advance(0.5, 10_000)?;
/// let healed = |event: Event| matches!(event, Event::Healed { left: 0, .. });
/// assert!(sim.events().any(healed));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Simulation {
    pub(crate) mesh: Mesh,
    pub(crate) edits: Edits,
    pub(crate) cloth: Cloth,
    pub(crate) tear: Option<Tear>,
    pub(crate) solver: Box<dyn Solver + Send + Sync>,
    pub(crate) step_s: f64,
    /// The time that was asked for and is not simulated, up to half a step either way.
    owed_s: f64,
    /// The strengths of vertices without grips and guards.
    strengths: PerVertex<f64>,
    /// What each call of [`Simulation::hold`] holds.
    holds: Vec<HeldSet>,
    hands: Hands,
    seams: Seams,
    healing: Healing,
    /// The ripple of a flat cloth, until something acts on it.
    ripple: Option<Ripple>,
    /// The amplitude of the ripple that was made, in metres.
    rippled_m: f64,
    /// The edits that holds, hands, seams and healing have followed.
    seen: Cursor,
    buffers: ClothBuffers,
    pub(crate) events: Vec<Event>,
    /// The steps, and the inputs if they are recorded.
    log: InputLog,
    is_recorded: bool,
}

impl Simulation {
    /// Creates the simulation of a cloth, which is at rest where it is unless the definition has a rest shape.
    /// Takes linear time. A flat cloth gets a [ripple](SimulationDef::ripple_m) with the first step in which something
    /// acts on it. If the cloth may
    /// tear, room is reserved for all that can: three vertices per face, some kilobytes each. The panels of a
    /// garment begin to be sewn as [`heal`](Simulation::heal) sews.
    ///
    /// # Errors
    ///
    /// [`SimulationError`] if the definition is not valid, or does not fit the mesh.
    pub fn new(
        mesh: Mesh,
        positions: &Positions,
        mut def: SimulationDef,
    ) -> Result<Simulation, SimulationError> {
        let is_recorded = std::mem::take(&mut def.is_recorded);
        // What a cloth looks like is not part of what its log repeats.
        let mut texture = std::mem::take(&mut def.texture);
        let digest = is_recorded.then(|| log::digest(&mesh, positions, &def));
        let (mut mesh, seams) = Seams::open(mesh, def.seams)?;
        let seen = positions.seen();
        let ripple = Ripple::of(&mesh, positions, def.ripple_m)?;
        let mut edits = Edits::starting_at(seen);
        let mut rest = def.rest;
        if rest.is_empty() {
            rest.extend(mesh.half_edges().map(|h| positions.at(mesh.origin(h))));
        }
        let (given, corners) = (rest.len(), mesh.half_edge_count());
        if given != corners {
            return Err(SimulationError::Rest { given, corners });
        }
        if texture.is_empty() {
            texture.resize(corners, [0.0; 2]);
        }
        let given = texture.len();
        if given != corners {
            return Err(SimulationError::Texture { given, corners });
        }
        let area = |f: FaceId| {
            let [a, b, c] = f.half_edges().map(|h| rest[h.index()]);
            0.5 * length(cross(b - a, c - a))
        };
        let masses = Masses::by_areas(&mesh, area, def.density_kg_per_m2);
        let masses = masses.map_err(|error| SimulationError::Cloth(ClothError::Mass(error)))?;
        let cloth = Cloth::with_rest(&mesh, positions, rest, masses, def.fabric);
        let mut cloth = cloth.map_err(SimulationError::Cloth)?;
        let solver = def.method.solver();
        let mut strengths = def.strengths;
        if strengths.is_empty() {
            strengths.resize(mesh.vertex_count(), 1.0);
        }
        let tear = |tearing| Tear::new(&cloth, tearing)?.with_strengths(strengths.clone());
        let tear = def.tearing.map(tear).transpose();
        let mut tear = tear.map_err(SimulationError::Tearing)?;
        let system = cloth.system_mut();
        let set = system.set_loads(def.loads);
        set.map_err(SimulationError::Loads)?;
        system.when_unstable(def.when_unstable);
        let speed_m_per_s = def.fabric.speed_m_per_s(def.density_kg_per_m2);
        let step_s = def.step_s;
        let step_s = step_s.unwrap_or_else(|| def.method.default_step_s(system, speed_m_per_s));
        if !(step_s > 0.0 && step_s.is_finite()) {
            return Err(SimulationError::Step(step_s));
        }
        let mut buffers = ClothBuffers::new(&mesh, cloth.positions(), texture, seen);
        let mut strengths = PerVertex::new(strengths).starting_at(seen);
        let mut events = Vec::new();
        if let Some(tear) = &mut tear {
            // Each split leaves every vertex a face, so V ≤ 3F.
            let corners = mesh.half_edge_count();
            let splits = corners.saturating_sub(mesh.vertex_count());
            tear.reserve(splits, corners);
            cloth.reserve(splits, corners);
            mesh.reserve(splits);
            edits.reserve(splits, 2 * corners, corners);
            strengths.reserve(splits);
            buffers.draw.reserve(splits);
            events.reserve(splits);
        }
        let mut sim = Simulation {
            mesh,
            edits,
            cloth,
            tear,
            solver,
            step_s,
            owed_s: 0.0,
            strengths,
            holds: Vec::new(),
            hands: Hands::default(),
            seams,
            healing: Healing::default(),
            ripple,
            rippled_m: 0.0,
            seen,
            buffers,
            events,
            log: InputLog::new(digest.unwrap_or_default()),
            is_recorded,
        };
        let (links, system) = (sim.seams.links(|label| label.seam > 0), sim.cloth.system());
        sim.healing.begin(&links, &sim.mesh, system);
        sim.settle();
        Ok(sim)
    }

    /// Repeats what a log says, with the mesh and the definition of the simulation that was
    /// recorded. Every number is the same to the bit. (A fraction of a step that was left to the
    /// next call of [`advance`](Simulation::advance) is not in the log.)
    ///
    /// For followers of its edits, `follow` is given the edits of the steps before each input, and then those of
    /// the input and whether it is a cut.
    ///
    /// # Errors
    ///
    /// [`ReplayError`] if the log is that of another mesh or definition, or not of a simulation.
    pub fn replayed(
        mesh: Mesh,
        positions: &Positions,
        mut def: SimulationDef,
        log: &InputLog,
        mut follow: impl FnMut(&Edits, bool),
    ) -> Result<Simulation, ReplayError> {
        def.is_recorded = true;
        let sim = Simulation::new(mesh, positions, def);
        let mut sim = sim.map_err(ReplayError::Definition)?;
        if sim.log.digest != log.digest {
            return Err(ReplayError::Digest);
        }
        for (number, record) in log.records.iter().enumerate() {
            sim.reach(record.step)?;
            follow(sim.edits(), false);
            if record.verb == "failed" {
                let failed = sim.step().is_err();
                failed.then_some(()).ok_or(ReplayError::Step(None))?;
                sim.note("failed", []);
            } else {
                let done = sim.repeat(record);
                done.map_err(|error| ReplayError::Input(number, error))?;
                follow(sim.edits(), record.verb == "cut");
            }
        }
        sim.reach(log.steps)?;
        follow(sim.edits(), false);
        Ok(sim)
    }

    /// Takes the steps of a log up to a number.
    fn reach(&mut self, steps: u64) -> Result<(), ReplayError> {
        self.edits.clear();
        while self.log.steps < steps {
            let step = self.step();
            step.map_err(|error| ReplayError::Step(Some(error)))?;
        }
        Ok(())
    }

    /// Repeats an input. The error is none where its numbers are not those of its verb.
    fn repeat(&mut self, record: &Record) -> Result<(), Option<InputError>> {
        let number = |word: u64| u32::try_from(word).map_err(|_| None);
        let id = |word: u64| VertexId::new(number(word)? as usize).ok_or(None);
        let ids = || record.words.iter().map(|&word| id(word));
        let floats = |words: [u64; 3]| words.map(f64::from_bits);
        match (record.verb, &record.words[..]) {
            ("hold", _) => self.hold(ids().collect::<Result<Vec<_>, _>>()?)?,
            ("free", _) => self.free(ids().collect::<Result<Vec<_>, _>>()?)?,
            ("grab", &[v, radius_m]) => drop(self.grab(id(v)?, f64::from_bits(radius_m))?),
            ("lead", &[hand, x, y, z]) => {
                self.lead(HandId(number(hand)?), floats([x, y, z]).into())?;
            }
            ("release", &[hand]) => self.release(HandId(number(hand)?))?,
            ("cut", words) => drop(self.cut(&Scissor::from_words(words).ok_or(None)?)?),
            ("heal" | "let_go", words) => {
                let name;
                let wounds = match *words {
                    [] => Wounds::All,
                    [cut] => Wounds::Cut(CutId(number(cut)?)),
                    [seam, 1] => {
                        name = self.seams.name(seam).ok_or(None)?;
                        Wounds::Seam(&name)
                    }
                    _ => return Err(None),
                };
                match record.verb {
                    "heal" => self.heal(wounds)?,
                    _ => self.let_go(wounds)?,
                };
            }
            ("unpick", &[seam]) => drop(self.unpick(&self.seams.name(seam).ok_or(None)?)?),
            ("wind", &[]) => self.set_wind(None)?,
            ("wind", &[x, y, z, coefficient]) => self.set_wind(Some(Wind {
                velocity_m_per_s: floats([x, y, z]).into(),
                coefficient: f64::from_bits(coefficient),
            }))?,
            _ => return Err(None),
        }
        Ok(())
    }

    fn note(&mut self, verb: &'static str, words: impl IntoIterator<Item = u64>) {
        if self.is_recorded {
            self.log.note(verb, words.into_iter().collect());
        }
    }

    /// The radius within which a hand strengthens the cloth around it, in metres, that was found to
    /// work for a sheet of a metre.
    pub const GRIP_RADIUS_M: f64 = 0.12;

    /// Lets `dt_s` seconds pass, in whole steps, and at most this many. What is less than half a
    /// step is made up for by the next call; what the budget leaves out is not, so that a slow
    /// machine shows slow motion and never falls behind for good.
    ///
    /// Allocates nothing while nothing is sewn, whatever tears, once the method has taken a step; but for
    /// [`Method::Implicit`](crate::Method::Implicit), whose matrix grows when something tears.
    ///
    /// # Errors
    ///
    /// [`StepError`] if the time is negative or not finite, or a step failed. The cloth is then as
    /// it was at the end of the last good step.
    pub fn advance(&mut self, dt_s: f64, steps_max: u64) -> Result<Reached, StepError> {
        self.advance_while(dt_s, steps_max, || true)
    }

    /// Lets `dt_s` seconds pass as [`advance`](Simulation::advance) does, as long as `goes_on` says so, which is
    /// called before each step. What is left out then is dropped too.
    ///
    /// # Errors
    ///
    /// As for [`advance`](Simulation::advance).
    pub fn advance_while(
        &mut self,
        dt_s: f64,
        steps_max: u64,
        mut goes_on: impl FnMut() -> bool,
    ) -> Result<Reached, StepError> {
        if !(dt_s >= 0.0 && dt_s.is_finite()) {
            return Err(StepError::Step { given_s: dt_s });
        }
        self.edits.clear();
        let owed_s = self.owed_s + dt_s;
        let wanted = (owed_s / self.step_s).round().max(0.0);
        let left_s = owed_s - wanted * self.step_s;
        // A time of more steps than an f64 counts leaves only rounding errors, which would stop time for good.
        self.owed_s = if left_s.abs() <= self.step_s {
            left_s
        } else {
            0.0
        };
        let mut steps = 0;
        while steps < steps_max.min(wanted as u64) && goes_on() {
            if let Err(error) = self.step() {
                self.owed_s = 0.0;
                self.note("failed", []);
                return Err(error);
            }
            steps += 1;
        }
        let dropped_s = (wanted - steps as f64) * self.step_s;
        Ok(Reached { steps, dropped_s })
    }

    fn step(&mut self) -> Result<(), StepError> {
        self.step_observed(None)?;
        self.tear_observed(|_| {});
        self.heal_step();
        Ok(())
    }

    /// Takes a step, which a balance of energy sees, and tears nothing.
    pub(crate) fn step_observed(
        &mut self,
        mut balance: Option<&mut Balance>,
    ) -> Result<u32, StepError> {
        let system = self.cloth.system_mut();
        if let Some(ripple) = self.ripple.take_if(|_| system.is_acted_on()) {
            let mut displace = |system: &mut System| self.rippled_m = ripple.displace(system);
            match &mut balance {
                Some(balance) => balance.displace(system, displace),
                None => displace(system),
            }
        }
        loop {
            let system = self.cloth.system_mut();
            self.healing.draw(system);
            let balance = balance.as_deref_mut();
            let taken = system.step_observed(&mut *self.solver, self.step_s, balance);
            system.model.drawn.clear();
            match taken.map_err(|error| (self.leaves(&error), error)) {
                Err((true, _)) => {}
                Err((false, error)) => return Err(error),
                Ok(substeps) => {
                    self.log.steps += 1;
                    return Ok(substeps);
                }
            }
        }
    }

    /// Leaves the open pairs at the place where a step failed, or all if there are none; whether there were any.
    fn leaves(&mut self, error: &StepError) -> bool {
        let Some(failed) = error.failed_at() else {
            return false;
        };
        let failed: Vec<VertexId> = failed.into_iter().filter_map(VertexId::new).collect();
        let mut left = self.healing.leave_at(&self.mesh, &failed);
        if left == 0 {
            left = self.healing.leave_at(&self.mesh, &[]);
        }
        self.settle();
        left > 0
    }

    /// Tears what is overstretched, if anything is, once somebody has looked at the cloth.
    pub(crate) fn tear_observed(&mut self, look: impl FnOnce(&Cloth)) -> TearReport {
        let Some(tear) = &mut self.tear else {
            return TearReport::default();
        };
        let found = tear.find(&self.mesh, &mut self.cloth);
        if found.overstretched == 0 {
            return found;
        }
        look(&self.cloth);
        let (mesh, edits) = (&mut self.mesh, &mut self.edits);
        let report = tear.tear(mesh, &mut self.cloth, edits, found);
        let time_s = self.cloth.system().elapsed_s();
        let torn = tear.torn.iter().map(|torn| Event::Tore {
            edge: torn.edge,
            vertex: torn.vertex,
            time_s,
            force_n: torn.force_n,
        });
        self.events.extend(torn);
        self.follow();
        report
    }

    /// Draws the open pairs together, leaves those whose time is over, and sews those that met.
    pub(crate) fn heal_step(&mut self) {
        if self.healing.open() == 0 {
            return;
        }
        let tearing = self.tear.as_ref().map(|tear| *tear.tearing());
        let threshold = tearing.unwrap_or_default().threshold;
        let (mesh, cloth) = (&self.mesh, &self.cloth);
        let abilities = self.solver.abilities();
        self.healing
            .look((mesh, cloth), threshold, self.step_s, abilities);
        self.healing.leave(mesh, cloth.system().elapsed_s());
        while let Some(ends) = self.healing.met(self.cloth.system(), &self.hands) {
            let [one, other] = ends;
            let weights = ends.map(|v| self.cloth.masses().at(v));
            let merged = mend::merge(&mut self.mesh, one, other, weights, &mut self.edits);
            merged.expect("I8: both sides of a torn link have one root, and masses are weights");
            self.follow();
        }
        self.settle();
    }

    /// Has strengths, holds and events follow what became of open pairs.
    fn settle(&mut self) {
        if !std::mem::take(&mut self.healing.has_changed) {
            return;
        }
        self.release_healed();
        self.strengthen();
        if self.healing.open() == 0 {
            let Ends { sewn, left, ended } = self.healing.over();
            self.events.push(Event::Healed {
                sewn,
                left,
                ended,
                time_s: self.time_s(),
            });
        }
    }

    /// Has everything follow the mesh.
    fn follow(&mut self) {
        for edit in self.edits.since(self.seen) {
            let holds = self.holds.iter_mut();
            holds.for_each(|hold| hold.follow(&edit, true));
            self.hands.follow(&edit);
            self.healing.follow(&edit);
            self.seams.follow(&edit);
        }
        self.seen = self.edits.cursor();
        let others = (&mut self.strengths, &mut self.buffers.draw);
        self.edits.replay(&mut (&mut self.cloth, others));
        self.healing.renew(&self.mesh, self.cloth.system());
        if let Some(tear) = &mut self.tear {
            self.edits.replay(tear);
        }
        if let Some(ripple) = &mut self.ripple {
            self.edits.replay(&mut ripple.by_m);
        }
    }

    /// Releases what cuts inserted within holds, where they are healed.
    fn release_healed(&mut self) {
        for number in 0..self.holds.len() {
            for &v in self.holds[number].take_healed(&self.mesh).vertices() {
                if !self.holds.iter().any(|hold| hold.contains(v)) {
                    self.cloth.system_mut().release(v.index());
                }
            }
        }
    }

    /// Gives vertices the strengths that they have by themselves, by grips, and by open wounds
    /// nearby.
    fn strengthen(&mut self) {
        let Some(tear) = &mut self.tear else {
            return;
        };
        let mut strengths = self.strengths.as_slice().to_vec();
        for (v, grip) in self.hands.grips(&self.mesh, self.cloth.rest_corners()) {
            let strength = &mut strengths[v.index()];
            *strength = (*strength * grip).min(UNTEARABLE);
        }
        for v in self.healing.guarded(&self.mesh) {
            strengths[v.index()] = UNTEARABLE;
        }
        tear.set_strengths(strengths);
    }

    /// Holds vertices where they are, for good or until they are [freed](Simulation::free). Copies
    /// that a cut makes of them are held as well, and so are vertices that a cut inserts between vertices of one
    /// call, as on an edge with both ends in it. What was inserted is free again once the cut is healed there.
    ///
    /// # Errors
    ///
    /// [`InputError`] if one is no vertex of the mesh, or is in a hand.
    pub fn hold(&mut self, vertices: impl IntoIterator<Item = VertexId>) -> Result<(), InputError> {
        let vertices = self.not_in_hands(vertices)?;
        let system = self.cloth.system_mut();
        vertices.iter().for_each(|v| system.hold(v.index()));
        self.note("hold", vertices.iter().copied().map(word));
        let hold = HeldSet::new(vertices);
        // A hold of some of them says nothing that this one does not.
        self.holds.retain(|other| !other.is_within(&hold));
        self.holds.push(hold);
        Ok(())
    }

    /// Lets held vertices go. Nothing happens to those that are not held.
    ///
    /// # Errors
    ///
    /// [`InputError`] if one is no vertex of the mesh, or is in a hand.
    pub fn free(&mut self, vertices: impl IntoIterator<Item = VertexId>) -> Result<(), InputError> {
        let vertices = self.not_in_hands(vertices)?;
        let system = self.cloth.system_mut();
        vertices.iter().for_each(|v| system.release(v.index()));
        self.note("free", vertices.iter().copied().map(word));
        let free = HeldSet::new(vertices);
        self.holds.iter_mut().for_each(|hold| hold.remove(&free));
        self.holds.retain(|hold| !hold.vertices().is_empty());
        Ok(())
    }

    /// Returns what a ray meets first; `None` if it misses the cloth. Linear.
    #[must_use]
    pub fn pick(&self, ray: &Ray) -> Option<Picked> {
        let hit = pick::first_hit(&self.mesh, self.cloth.positions(), ray)?;
        let (of, weights) = (self.mesh.face_vertices(hit.face), hit.weights);
        let vertex = Mix::Weighted { of, weights }.nearest();
        Some(Picked { vertex, hit })
    }

    /// Grabs a vertex, which stays where it is until it is led. The hand grips the cloth around it:
    /// within this radius, measured over the cloth at rest, it is eight times as strong as by itself, and twice
    /// that at half the distance. Without, a pull would tear out no more than the vertex. A radius
    /// of 0 is no grip. Linear.
    ///
    /// # Errors
    ///
    /// [`InputError`] if there is no such vertex, it is held or in a hand, or the radius is negative
    /// or not finite.
    pub fn grab(&mut self, vertex: VertexId, radius_m: f64) -> Result<HandId, InputError> {
        self.not_in_hands([vertex])?;
        if self.cloth.system().is_held(vertex.index()) {
            return Err(InputError::Held(vertex));
        }
        if !(radius_m >= 0.0 && radius_m.is_finite()) {
            return Err(InputError::Number("radius_m", radius_m));
        }
        let hand = self.hands.grab(vertex, radius_m);
        self.cloth.system_mut().hold(vertex.index());
        self.strengthen();
        self.note("grab", [word(vertex), radius_m.to_bits()]);
        Ok(hand)
    }

    /// Leads a hand straight to a point, from where it is: within a frame of 1/60 s, or at 3 m/s if it is
    /// too far for that.
    ///
    /// # Errors
    ///
    /// [`InputError`] if there is no such hand, or a coordinate cannot be used.
    pub fn lead(&mut self, hand: HandId, to: Point) -> Result<(), InputError> {
        let held = self.hands.get(hand).ok_or(InputError::NoHand(hand))?;
        check_point(to).map_err(|given| InputError::Number("to", given))?;
        let system = self.cloth.system_mut();
        for v in held.set.vertices().iter().map(|v| v.index()) {
            let path = hand::path(system.positions()[v], to, system.elapsed_s());
            system.grab(v, path);
        }
        let [x, y, z] = [to.x, to.y, to.z].map(f64::to_bits);
        self.note("lead", [hand.0.into(), x, y, z]);
        Ok(())
    }

    /// Lets go of what a hand holds, and undoes its grip.
    ///
    /// # Errors
    ///
    /// [`InputError`] if there is no such hand.
    pub fn release(&mut self, hand: HandId) -> Result<(), InputError> {
        let gone = self.hands.remove(hand).ok_or(InputError::NoHand(hand))?;
        let system = self.cloth.system_mut();
        let vertices = gone.set.vertices().iter();
        vertices.for_each(|v| system.release(v.index()));
        self.strengthen();
        self.note("release", [hand.0.into()]);
        Ok(())
    }

    /// Cuts the cloth where it is now, by [`CutMethod::Exact`](tearmesh::CutMethod). Both halves of
    /// a vertex that is held or in a hand are so afterwards, and vertices that are inserted within a
    /// [hold](Simulation::hold) are held. An [`Event::Cut`] tells how much was
    /// cut.
    ///
    /// # Errors
    ///
    /// [`InputError`] if the scissor continues another cut, if its rays cross within the cloth, or if the
    /// cloth is too far away.
    pub fn cut(&mut self, scissor: &Scissor) -> Result<CutId, InputError> {
        let words = scissor.to_words().ok_or(InputError::Continued)?;
        self.edits.clear();
        let (cut, report) = self.cut_measured(scissor, CutMethod::Exact)?;
        self.note("cut", words);
        self.events.push(Event::Cut {
            cut,
            splits: report.splits,
            time_s: self.time_s(),
        });
        Ok(cut)
    }

    /// Cuts the cloth where it is now, and measures the cut.
    pub(crate) fn cut_measured(
        &mut self,
        scissor: &Scissor,
        method: CutMethod,
    ) -> Result<(CutId, CutReport), InputError> {
        let positions = Positions::new(self.cloth.positions().iter().copied());
        let positions = positions.map_err(InputError::Positions)?;
        let mut positions = positions.starting_at(self.edits.cursor());
        let (mesh, edits) = (&mut self.mesh, &mut self.edits);
        let made = scissor.cut_measured(method, mesh, &mut positions, edits);
        let (cut, report) = made.map_err(InputError::Cut)?;
        self.follow();
        let inserted = self.holds.iter().flat_map(HeldSet::inserted);
        let system = self.cloth.system_mut();
        inserted.for_each(|(v, _)| system.hold(v.index()));
        Ok((self.seams.add(&cut), report))
    }

    /// Begins to heal wounds, together with those that heal already, and returns the number of
    /// pairs of copies that were added. From now on the two copies of each pair move toward each
    /// other while time passes, and become one where they meet; edges within two rings of an open
    /// pair do not tear. Vertices that a cut inserted stay.
    ///
    /// Once no pair is open, an [`Event::Healed`] says how many were sewn. A pair that loads, holds or a body
    /// keep apart for 5 s more than its way takes is left, and so is one at which a step fails, which is then
    /// taken without it. Linear.
    ///
    /// # Errors
    ///
    /// [`InputError::NoCut`] or [`InputError::NoSeam`] if there was no such cut, or is no such seam.
    pub fn heal(&mut self, wounds: Wounds<'_>) -> Result<usize, InputError> {
        let (links, words) = self.links(wounds)?;
        let (mesh, system) = (&self.mesh, self.cloth.system());
        let opened = self.healing.begin(&links, mesh, system);
        self.settle();
        self.note("heal", words);
        Ok(opened)
    }

    /// Ends the healing of wounds: their pairs are drawn no more, and stay apart. Returns the number of pairs that were
    /// open. Linear.
    ///
    /// # Errors
    ///
    /// The errors of [`heal`](Simulation::heal).
    pub fn let_go(&mut self, wounds: Wounds<'_>) -> Result<usize, InputError> {
        let (links, words) = self.links(wounds)?;
        let (mesh, system) = (&self.mesh, self.cloth.system());
        let ended = self.healing.end(&links, mesh, system);
        self.settle();
        self.note("let_go", words);
        Ok(ended)
    }

    /// The half-edges of wounds, and what names these in a log.
    fn links(&self, wounds: Wounds<'_>) -> Result<(Vec<HalfEdgeId>, Vec<u64>), InputError> {
        Ok(match wounds {
            Wounds::All => (self.mesh.half_edges().collect(), Vec::new()),
            Wounds::Cut(cut) => (self.seams.of_cut(cut)?, vec![cut.0.into()]),
            Wounds::Seam(name) => {
                let (number, links) = self.seams.named(name)?;
                (links, vec![number, 1])
            }
        })
    }

    /// Unpicks the seams of this name: tears the cloth along them, as far as they are sewn, and ends their sewing.
    /// Returns the number of vertices that were split. What tore or was cut otherwise stays so. A vertex that other
    /// seams or the cloth beyond the end of a seam hold together stays one.
    ///
    /// # Errors
    ///
    /// [`InputError::NoSeam`] if no seam has this name.
    pub fn unpick(&mut self, name: &str) -> Result<usize, InputError> {
        self.edits.clear();
        self.unpick_more(name)
    }

    /// Unpicks seams, and adds the edits to those that there are.
    pub(crate) fn unpick_more(&mut self, name: &str) -> Result<usize, InputError> {
        let (number, links) = self.seams.named(name)?;
        let before = self.edits.iter().count();
        self.healing.end(&links, &self.mesh, self.cloth.system());
        let ends = |&h: &_| [self.mesh.origin(h), self.mesh.target(h)];
        let ends: Vec<VertexId> = links.iter().flat_map(ends).collect();
        let is_cut = |h| links.binary_search(&h).is_ok();
        unshare::by_fan(&mut self.mesh, &ends, is_cut, &mut self.edits);
        self.seams.unpick(&links);
        self.follow();
        self.settle();
        self.note("unpick", [number]);
        let splits = self.edits.iter().count() - before;
        self.healing.unpicked += splits;
        Ok(splits)
    }

    /// Has another wind blow from now on, or none. Other loads stay.
    ///
    /// # Errors
    ///
    /// [`InputError::Number`] if a number of the wind cannot be used.
    pub fn set_wind(&mut self, wind: Option<Wind>) -> Result<(), InputError> {
        let set = self.cloth.system_mut().set_wind(wind);
        set.map_err(|error| InputError::Number(error.setting, error.given))?;
        let numbers = wind.map(|wind| {
            let velocity: [f64; 3] = wind.velocity_m_per_s.into();
            velocity.into_iter().chain([wind.coefficient])
        });
        self.note("wind", numbers.into_iter().flatten().map(f64::to_bits));
        Ok(())
    }

    /// Vertices that hands do not have.
    fn not_in_hands(
        &self,
        vertices: impl IntoIterator<Item = VertexId>,
    ) -> Result<Vec<VertexId>, InputError> {
        let count = self.mesh.vertex_count();
        let free = |v: VertexId| match self.hands.of(v) {
            _ if v.index() >= count => Err(InputError::NoVertex(v)),
            Some(hand) => Err(InputError::InHand(v, hand)),
            None => Ok(v),
        };
        vertices.into_iter().map(free).collect()
    }

    /// Returns what happened since the previous call, and forgets it.
    pub fn events(&mut self) -> impl ExactSizeIterator<Item = Event> + '_ {
        self.events.drain(..)
    }

    /// Returns the draw buffers, up to date with the cloth. Linear.
    pub fn draw_buffers(&mut self) -> &mut ClothBuffers {
        self.buffers.update(&self.mesh, self.cloth.positions());
        &mut self.buffers
    }

    /// Returns the mesh.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Returns the cloth: positions, velocities, masses, and which vertices are held.
    #[must_use]
    pub fn cloth(&self) -> &Cloth {
        &self.cloth
    }

    /// Returns the edits that the last call of [`advance`](Simulation::advance), [`cut`](Simulation::cut) or
    /// [`unpick`](Simulation::unpick) made. A follower of the caller's replays them after each.
    #[must_use]
    pub fn edits(&self) -> &Edits {
        &self.edits
    }

    /// Returns the vertices in a hand: the one that it grabbed, and its copies since.
    ///
    /// # Errors
    ///
    /// [`InputError::NoHand`] if there is no such hand.
    pub fn in_hand(&self, hand: HandId) -> Result<&[VertexId], InputError> {
        let held = self.hands.get(hand).ok_or(InputError::NoHand(hand))?;
        Ok(held.set.vertices())
    }

    /// Returns the number of pairs of copies that are still drawn together.
    #[must_use]
    pub fn open_pairs(&self) -> usize {
        self.healing.open()
    }

    /// What became of all pairs that were ever open.
    pub(crate) fn pairs(&self) -> PairTally {
        self.healing.tally()
    }

    /// Whether a link is that of a seam which is open, and which nothing else tore.
    pub(crate) fn is_open_seam(&self, h: HalfEdgeId) -> bool {
        self.seams.is_open_seam(h)
    }

    /// Returns the log of the inputs so far; `None` unless the definition
    /// [has them recorded](SimulationDef::is_recorded).
    #[must_use]
    pub fn log(&self) -> Option<&InputLog> {
        self.is_recorded.then_some(&self.log)
    }

    /// Returns the time simulated so far, in seconds.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.cloth.system().elapsed_s()
    }

    /// Returns the amplitude of the [ripple](SimulationDef::ripple_m) that was made, in metres; 0 if none was yet.
    #[must_use]
    pub fn ripple_m(&self) -> f64 {
        self.rippled_m
    }

    /// Returns the number of steps taken so far.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.log.steps
    }

    /// Returns the length of a step, in seconds.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.step_s
    }
}

/// The strength of what does not tear, as a multiple of the threshold: finite, so that means of it
/// are.
const UNTEARABLE: f64 = 1e12;

fn word(v: VertexId) -> u64 {
    u32::from(v).into()
}

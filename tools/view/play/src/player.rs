//! A simulation together with the file of its cloth, and everything that a page does with both.

use tearmesh::geometry::{Plane, Point, Ray};
use tearmesh::{CutLayers, Edits, Mesh, Positions, Scissor, VertexId};
use tearmesh_cloth::scene::{Frame, Opening, Scene, SwayingWind};
use tearmesh_cloth::{
    ClothBuffers, Collider, Event, HandId, InputError, InputLog, Simulation, StepError, Wind,
    Wounds, digest,
};
use tearmesh_obj::{Document, TornDocument};

use crate::settings::{Settings, words};

/// A cloth in the hands of a person.
///
/// ```
/// use tearmesh_play::{Player, Settings};
///
/// let settings: Settings =
///     "cloth sheet 8\nscene rip\nup y\nmethod xpbd\nthreshold 1.5\n".parse()?;
/// let document = settings.document(&[])?;
/// let mut player = Player::new(&document, settings.clone())?;
/// player.advance(0.1, 1000)?;
///
/// let again = Player::replayed(&document, settings, &player.log())?;
/// assert_eq!(again.digest(), player.digest());
/// # Ok::<(), String>(())
/// ```
#[derive(Debug)]
pub struct Player<'d> {
    settings: Settings,
    sim: Simulation,
    torn: TornDocument<'d>,
    wind: Option<SwayingWind>,
    /// Whether the wind of the scene blows, and no other.
    is_wind_of_scene: bool,
    grip_radius_m: f64,
    /// The number of hands of earlier players of the page.
    hands_before: usize,
    /// By the number that the page knows, less that of the earlier ones.
    hands: Vec<HandId>,
    /// Of all events so far.
    events_hash: u64,
    facts: Facts,
}

/// What a page says of a cloth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Facts {
    /// The number of vertices that are held from the beginning.
    pub held_first: usize,
    /// The number of vertices that tearing has split.
    pub tears: usize,
    /// The number of vertices that the last cut split.
    pub cut_splits: usize,
    /// The number of times that healing came to its end.
    pub heals: usize,
    /// The number of pairs that the last healing sewed, and that it left.
    pub sewn: usize,
    /// See [`Facts::sewn`].
    pub left: usize,
    /// Where the vertex was that a hand grabbed last.
    pub grabbed_at: [f64; 3],
}

/// How often a second a wind that sways changes. Each change is an input, and takes a line of the log.
const SWAYS_PER_S: f64 = 20.0;

/// Why a hand that was never one, or is one of an earlier player, does nothing.
pub(crate) const NO_HAND: &str = "there is no such hand";

const HEAD: &str = "tearmesh play 1\n";

impl<'d> Player<'d> {
    /// Lets the cloth of a document go, in a scene that stands ready or in that of a file.
    ///
    /// What the scene holds from the beginning without moving it is held; if nothing is, the first that it moves.
    /// Seams are sewn, and a cut at the very beginning is made. Everything later is left to the person. A cloth
    /// that nothing holds falls onto a floor, unless it can fall onto something else.
    ///
    /// # Errors
    ///
    /// Why it cannot be simulated, in words.
    pub fn new(document: &'d Document, settings: Settings) -> Result<Player<'d>, String> {
        let start = Start::new(document, &settings)?;
        let sim = words(Simulation::new(
            start.mesh,
            &start.positions,
            start.opening.def,
        ))?;
        let mut player = Player::of(sim, document, settings, start.opening.wind, start.size_m);
        words(player.sim.hold(start.opening.held.iter().copied()))?;
        for scissor in &start.opening.cuts {
            player.cut_by(scissor)?;
        }
        player.facts.held_first = start.opening.held.len();
        Ok(player)
    }

    /// Repeats a [log](Player::log) with the document that it was made with and [its
    /// settings](Player::settings_of).
    ///
    /// # Errors
    ///
    /// Why it cannot be repeated, in words.
    pub fn replayed(
        document: &'d Document,
        settings: Settings,
        log: &str,
    ) -> Result<Player<'d>, String> {
        let (_, inputs) = split_log(log).ok_or("the log has no inputs")?;
        let inputs = words(inputs.parse::<InputLog>())?;
        let start = Start::new(document, &settings)?;
        let mut torn = TornDocument::new(document);
        let follow = |edits: &Edits, is_cut: bool| {
            if is_cut {
                torn.next_cut();
            }
            edits.replay(&mut torn);
            if is_cut {
                torn.next_cut();
            }
        };
        let sim = Simulation::replayed(
            start.mesh,
            &start.positions,
            start.opening.def,
            &inputs,
            follow,
        );
        let sim = words(sim)?;
        let mut player = Player::of(sim, document, settings, start.opening.wind, start.size_m);
        player.torn = torn;
        player.facts.held_first = start.opening.held.len();
        player.note_events();
        Ok(player)
    }

    /// Returns the settings that a log begins with.
    ///
    /// # Errors
    ///
    /// Why it is no log, in words.
    pub fn settings_of(log: &str) -> Result<Settings, String> {
        let (settings, _) = split_log(log).ok_or("the file is no log of `tearmesh play`")?;
        settings.parse()
    }

    fn of(
        sim: Simulation,
        document: &'d Document,
        settings: Settings,
        wind: Option<SwayingWind>,
        size_m: f64,
    ) -> Player<'d> {
        Player {
            settings,
            torn: TornDocument::new(document),
            wind,
            is_wind_of_scene: true,
            grip_radius_m: Simulation::GRIP_RADIUS_M * size_m,
            hands_before: 0,
            hands: Vec::new(),
            events_hash: digest::EMPTY,
            facts: Facts::default(),
            sim,
        }
    }

    /// Lets time pass: see [`Simulation::advance`]. Returns the number of steps.
    ///
    /// # Errors
    ///
    /// Why a step failed, in words. The cloth is then as it was after the last good one.
    pub fn advance(&mut self, dt_s: f64, steps_max: u64) -> Result<u64, String> {
        // Before the wind changes.
        if !(dt_s >= 0.0 && dt_s.is_finite()) {
            return words(Err(StepError::Step { given_s: dt_s }));
        }
        if self.is_wind_of_scene {
            let part = (self.sim.time_s() * SWAYS_PER_S).floor() / SWAYS_PER_S;
            let wind = self.wind.map(|wind| wind.at(part));
            if self.sim.cloth().system().loads().wind != wind {
                words(self.sim.set_wind(wind))?;
            }
        }
        let reached = self.sim.advance(dt_s, steps_max);
        self.follow();
        Ok(words(reached)?.steps)
    }

    /// Brings the document up to date with what was torn or sewn.
    fn follow(&mut self) {
        self.sim.edits().replay(&mut self.torn);
        self.note_events();
    }

    fn note_events(&mut self) {
        for event in self.sim.events() {
            self.events_hash = digest::after(self.events_hash, format!("{event:?}").into_bytes());
            match event {
                Event::Tore { .. } => self.facts.tears += 1,
                Event::Cut { splits, .. } => self.facts.cut_splits = splits,
                Event::Healed { sewn, left, .. } => {
                    self.facts.heals += 1;
                    (self.facts.sewn, self.facts.left) = (sewn, left);
                }
                _ => {}
            }
        }
    }

    /// Grabs the vertex that a ray hits. Returns the number of the hand; `None` if the ray misses.
    ///
    /// # Errors
    ///
    /// Why it cannot be grabbed, in words.
    pub fn grab(&mut self, ray: &Ray) -> Result<Option<usize>, String> {
        let Some(picked) = self.sim.pick(ray) else {
            return Ok(None);
        };
        let hand = match self.sim.grab(picked.vertex, self.grip_radius_m) {
            // Someone held on while the log was saved that was repeated here, and is taken over.
            Err(InputError::InHand(_, hand)) if !self.hands.contains(&hand) => hand,
            grabbed => words(grabbed)?,
        };
        self.hands.push(hand);
        let number = self.hands_before + self.hands.len() - 1;
        let at = self.sim.cloth().positions()[picked.vertex.index()];
        self.facts.grabbed_at = at.into();
        Ok(Some(number))
    }

    /// Leads a hand to a point: see [`Simulation::lead`].
    ///
    /// # Errors
    ///
    /// Why it cannot be led there, in words.
    pub fn lead(&mut self, hand: usize, to: Point) -> Result<(), String> {
        let hand = self.hand(hand)?;
        words(self.sim.lead(hand, to))
    }

    /// Releases a hand.
    ///
    /// # Errors
    ///
    /// That it was released before, or never was, in words.
    pub fn release(&mut self, hand: usize) -> Result<(), String> {
        let hand = self.hand(hand)?;
        words(self.sim.release(hand))
    }

    /// Has hands numbered from here on, so that none has the number of one of an earlier player.
    pub fn number_hands_from(&mut self, first: usize) {
        self.hands_before = first;
    }

    /// Returns the number that the next hand has.
    #[must_use]
    pub fn next_hand(&self) -> usize {
        self.hands_before + self.hands.len()
    }

    fn hand(&self, number: usize) -> Result<HandId, String> {
        let own = number.checked_sub(self.hands_before);
        let hand = own.and_then(|own| self.hands.get(own).copied());
        hand.ok_or_else(|| NO_HAND.to_owned())
    }

    /// Pins the vertex that a ray hits, or unpins it. Returns whether it is pinned now; `None` if the ray misses.
    ///
    /// # Errors
    ///
    /// Why it cannot be pinned, in words.
    pub fn pin(&mut self, ray: &Ray) -> Result<Option<bool>, String> {
        let Some(picked) = self.sim.pick(ray) else {
            return Ok(None);
        };
        let is_held = self.is_held(picked.vertex);
        words(match is_held {
            true => self.sim.free([picked.vertex]),
            false => self.sim.hold([picked.vertex]),
        })?;
        Ok(Some(!is_held))
    }

    /// Returns whether a vertex is held, by a pin or a hand.
    #[must_use]
    pub fn is_held(&self, v: VertexId) -> bool {
        self.sim.cloth().system().is_held(v.index())
    }

    /// Cuts between two rays, through all layers or only the front one. Returns the number of vertices that were
    /// split.
    ///
    /// # Errors
    ///
    /// Why there is no such cut, in words.
    pub fn cut(&mut self, rays: [Ray; 2], is_first_layer: bool) -> Result<usize, String> {
        let [a, b] = rays;
        let layers = match is_first_layer {
            true => CutLayers::First,
            false => CutLayers::All,
        };
        let scissor = words(Scissor::new(a, b))?;
        self.cut_by(&scissor.with_layers(layers))
    }

    fn cut_by(&mut self, scissor: &Scissor) -> Result<usize, String> {
        // Tears before the cut are undone by themselves.
        self.torn.next_cut();
        words(self.sim.cut(scissor))?;
        self.follow();
        self.torn.next_cut();
        Ok(self.facts.cut_splits)
    }

    /// Begins to mend all tears and cuts. Returns the number of pairs of vertices that are drawn together.
    pub fn heal(&mut self) -> usize {
        let drawn = self.sim.heal(Wounds::All);
        drawn.expect("all is no cut of its own")
    }

    /// Has the wind of the scene blow again.
    pub fn set_wind_of_scene(&mut self) {
        self.is_wind_of_scene = true;
    }

    /// Has another wind blow than that of the scene, or none.
    ///
    /// # Errors
    ///
    /// Which number cannot be used, in words.
    pub fn set_wind(&mut self, wind: Option<Wind>) -> Result<(), String> {
        words(self.sim.set_wind(wind))?;
        self.is_wind_of_scene = false;
        Ok(())
    }

    /// Returns the OBJ file of the cloth as it is now, with the record of its tears and cuts.
    ///
    /// # Errors
    ///
    /// Which vertex is nowhere, in words.
    pub fn obj(&self) -> Result<Vec<u8>, String> {
        let points = self.sim.cloth().positions().iter().copied();
        let positions = words(Positions::new(points))?;
        let mut out = Vec::new();
        words(self.torn.write(self.sim.mesh(), &positions, &mut out))?;
        Ok(out)
    }

    /// Returns the settings and all inputs so far, as text.
    #[must_use]
    pub fn log(&self) -> String {
        let inputs = self.sim.log().expect("every player is recorded");
        format!("{HEAD}{}{inputs}", self.settings.text)
    }

    /// Returns a digest of the bits of all positions, the faces, the roots of vertices, and all events.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let (mesh, points) = (self.sim.mesh(), self.sim.cloth().positions());
        let numbers = points.iter().flat_map(|p| [p.x, p.y, p.z]);
        let ids = mesh.indices().iter().copied().chain(mesh.roots());
        let bytes = numbers.flat_map(f64::to_le_bytes);
        let bytes = bytes.chain(ids.flat_map(u32::to_le_bytes));
        digest::after(self.events_hash, bytes)
    }

    /// Returns what the cloth is drawn from: see [`Simulation::draw_buffers`].
    pub fn draw_buffers(&mut self) -> &ClothBuffers {
        self.sim.draw_buffers()
    }

    /// Returns the bodies and balls that the cloth lies on, where they are now: points and faces.
    #[must_use]
    pub fn solids(&self) -> (Vec<Point>, Vec<[u32; 3]>) {
        let colliders = &self.sim.cloth().system().loads().colliders;
        Collider::skins(colliders, self.sim.time_s())
    }

    /// Returns what happened so far.
    #[must_use]
    pub fn facts(&self) -> Facts {
        self.facts
    }

    /// Returns the simulation.
    #[must_use]
    pub fn simulation(&self) -> &Simulation {
        &self.sim
    }
}

/// What a simulation begins with.
struct Start {
    mesh: Mesh,
    positions: Positions,
    opening: Opening,
    size_m: f64,
}

impl Start {
    fn new(document: &Document, settings: &Settings) -> Result<Start, String> {
        let mesh = words(document.mesh())?;
        let points = document.positions();
        let positions = words(Positions::new(points.iter().copied()))?;
        let frame = Frame::new(&mesh, points, settings.up);
        let scene = settings.scene(&frame)?;
        let mut opening = words(scene.opening(&mesh, points, &frame))?;
        let colliders = &mut opening.def.loads.colliders;
        if opening.held.is_empty() && colliders.is_empty() {
            let up = frame.up.vector();
            let below = frame.point([0.0; 3]) - up * (0.5 * frame.size_m());
            let floor = Plane::new(below, up).map(Collider::plane);
            colliders.extend(floor.map(|floor| floor.with_friction(Scene::FRICTION)));
        }
        opening.def.is_recorded = true;
        Ok(Start {
            mesh,
            positions,
            opening,
            size_m: frame.size_m(),
        })
    }
}

/// The settings of a log, and its inputs.
fn split_log(log: &str) -> Option<(&str, &str)> {
    let rest = log.strip_prefix(HEAD)?;
    // A file may have that name too, but on a line that begins with another word.
    Some(rest.split_at(rest.find("\ntearmesh inputs")? + 1))
}

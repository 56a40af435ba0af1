//! What the module exports. A verb takes numbers; texts and files lie in a block of memory, as do its results.
//! A verb that was refused says why in the block [`TEXT`], and changes nothing else.
//!
//! Every parameter is an `f64`, also where a whole number is meant: WebAssembly takes NaN, 2^32 and what was left out
//! for 0 where a parameter is an integer, so that the module would never see what a page got wrong.

use std::cell::RefCell;

use tearmesh::{Point, Ray, Vector};
use tearmesh_cloth::Wind;
use tearmesh_obj::Document;

use crate::player::{NO_HAND, Player};
use crate::settings::{ClothSource, Plan, Settings, document};

#[derive(Default)]
struct Module {
    input: Vec<u8>,
    text: Vec<u8>,
    /// The file that was dropped on the page last. Documents are leaked, since players borrow them; a page that
    /// shows twenty files has twenty of them.
    file: Option<&'static Document>,
    /// The scene of the file.
    plan: Option<Plan>,
    /// The sheet that was begun last, and its document.
    sheet: Option<(ClothSource, &'static Document)>,
    player: Option<Player<'static>>,
    /// Of each half-edge: 0 if the faces on both sides are joined, 1 if there never was another, 2 if they are torn.
    edges: Vec<u8>,
    /// Whether each vertex is held.
    held: Vec<u8>,
    facts: Vec<f64>,
    /// Of what the cloth lies on: positions and indices.
    solids: (Vec<f32>, Vec<u32>),
    /// Of each block but the text, where it is, and how many bytes it has.
    drawn: Vec<(usize, usize)>,
}

thread_local! {
    static MODULE: RefCell<Module> = RefCell::default();
}

/// The number of the block of memory with a text or a file. Those before it, from 0 on, are what [`draw`] brings
/// up to date: positions, indices, pieces, edges, held vertices, facts, and positions and indices of solids.
const TEXT: u32 = 8;

const NO_CLOTH: &str = "there is no cloth";

/// Makes room for a text or a file; where, or 0 if there is none for so many bytes.
#[unsafe(no_mangle)]
extern "C" fn room(length: f64) -> usize {
    MODULE.with_borrow_mut(|module| {
        module.input.clear();
        let bytes = whole(length).map(|bytes| bytes as usize);
        let bytes = bytes.filter(|&bytes| module.input.try_reserve(bytes).is_ok());
        let Some(bytes) = bytes else {
            module.text = format!("there is no room for {length} bytes").into_bytes();
            return 0;
        };
        module.input.resize(bytes, 0);
        module.input.as_ptr() as usize
    })
}

/// Where a block is, or 0 if there is none.
#[unsafe(no_mangle)]
extern "C" fn address(block: f64) -> usize {
    MODULE.with_borrow_mut(|module| module.block(block).0)
}

/// How many bytes a block has.
#[unsafe(no_mangle)]
extern "C" fn length(block: f64) -> usize {
    MODULE.with_borrow_mut(|module| module.block(block).1)
}

/// Takes the OBJ file in the room, for a cloth of a file; whether it could.
#[unsafe(no_mangle)]
extern "C" fn take_file() -> bool {
    MODULE.with_borrow_mut(|module| {
        let obj = std::mem::take(&mut module.input);
        let read = document(&obj).map_err(|why| module.text = why.into_bytes());
        let Ok(read) = read else { return false };
        module.file = Some(Box::leak(Box::new(read)));
        true
    })
}

/// Takes the packed scene of a file in the room, as JSON; whether it could.
#[unsafe(no_mangle)]
extern "C" fn take_scene() -> bool {
    MODULE.with_borrow_mut(|module| {
        let read = Plan::read(&module.input);
        let read = read.map_err(|why| module.text = why.into_bytes());
        let Ok(read) = read else { return false };
        module.plan = Some(read);
        true
    })
}

/// Lets a cloth go, by the settings in the room; whether it could.
#[unsafe(no_mangle)]
extern "C" fn start() -> bool {
    MODULE.with_borrow_mut(|module| {
        let settings = module.input_text().and_then(|text| text.parse());
        module.replace(settings, Player::new)
    })
}

/// Repeats the log in the room; whether it could.
#[unsafe(no_mangle)]
extern "C" fn replay() -> bool {
    MODULE.with_borrow_mut(|module| {
        let text = module.input_text();
        let settings = text.as_deref().map_err(Clone::clone);
        let settings = settings.and_then(Player::settings_of);
        let text = text.unwrap_or_default();
        let again = |document, settings| Player::replayed(document, settings, &text);
        module.replace(settings, again)
    })
}

/// Lets time pass: the number of steps, or −1.
#[unsafe(no_mangle)]
extern "C" fn advance(dt_s: f64, steps_max: f64) -> i32 {
    verb(-1, |player| {
        let most = whole(steps_max).ok_or_else(|| format!("steps_max cannot be {steps_max}"))?;
        let steps = player.advance(dt_s, most.into())?;
        Ok(i32::try_from(steps).unwrap_or(i32::MAX))
    })
}

/// Brings all blocks but the text up to date, until the next verb; whether there is a cloth.
#[unsafe(no_mangle)]
extern "C" fn draw() -> bool {
    let is_there = verb(false, |_| Ok(true));
    MODULE.with_borrow_mut(Module::draw);
    is_there
}

/// The number of a hand that grabs what a ray hits; −1 if there is none. Its place is in the facts.
#[unsafe(no_mangle)]
extern "C" fn grab(x: f64, y: f64, z: f64, dx: f64, dy: f64, dz: f64) -> i32 {
    verb(-1, |player| {
        let grabbed = player.grab(&ray([x, y, z], [dx, dy, dz])?)?;
        Ok(grabbed.ok_or_else(missed)? as i32)
    })
}

/// Leads a hand to a point.
#[unsafe(no_mangle)]
extern "C" fn lead(hand: f64, x: f64, y: f64, z: f64) -> bool {
    let to = Point::new(x, y, z);
    verb(false, |player| {
        player.lead(number(hand)?, to).map(|()| true)
    })
}

/// Releases a hand; whether there was one.
#[unsafe(no_mangle)]
extern "C" fn release(hand: f64) -> bool {
    verb(false, |player| player.release(number(hand)?).map(|()| true))
}

/// Pins what a ray hits, or unpins it: 1 and 0, and −1 if it hits nothing.
#[unsafe(no_mangle)]
extern "C" fn pin(x: f64, y: f64, z: f64, dx: f64, dy: f64, dz: f64) -> i32 {
    verb(-1, |player| {
        let pinned = player.pin(&ray([x, y, z], [dx, dy, dz])?)?;
        Ok(pinned.ok_or_else(missed)?.into())
    })
}

/// Cuts between two rays from one point, through all layers or, if the last number is 1, only the front one: the
/// number of vertices that were split, or −1.
#[unsafe(no_mangle)]
extern "C" fn cut(
    x: f64,
    y: f64,
    z: f64,
    ax: f64,
    ay: f64,
    az: f64,
    bx: f64,
    by: f64,
    bz: f64,
    is_first_layer: f64,
) -> i32 {
    verb(-1, |player| {
        let is_first_layer = match whole(is_first_layer) {
            Some(0) => false,
            Some(1) => true,
            _ => return Err(format!("is_first_layer is {is_first_layer}, not 0 or 1")),
        };
        let rays = [ray([x, y, z], [ax, ay, az])?, ray([x, y, z], [bx, by, bz])?];
        Ok(player.cut(rays, is_first_layer)? as i32)
    })
}

/// Begins to mend everything: the number of pairs, or −1.
#[unsafe(no_mangle)]
extern "C" fn heal() -> i32 {
    verb(-1, |player| Ok(player.heal() as i32))
}

/// Has another wind blow; none if its coefficient is 0.
#[unsafe(no_mangle)]
extern "C" fn wind(x: f64, y: f64, z: f64, coefficient: f64) -> bool {
    let wind = Wind {
        velocity_m_per_s: Vector::new(x, y, z),
        coefficient,
    };
    verb(false, |player| {
        // Also of a wind that has no force.
        if let Some(bad) = [x, y, z].into_iter().find(|speed| !speed.is_finite()) {
            return Err(format!("wind.velocity_m_per_s cannot be {bad}"));
        }
        let wind = Some(wind).filter(|wind| wind.coefficient != 0.0);
        player.set_wind(wind).map(|()| true)
    })
}

/// Has the wind of the scene blow again.
#[unsafe(no_mangle)]
extern "C" fn wind_of_scene() -> bool {
    verb(false, |player| {
        player.set_wind_of_scene();
        Ok(true)
    })
}

/// Writes the OBJ file of the cloth into the block [`TEXT`].
#[unsafe(no_mangle)]
extern "C" fn write_obj() -> bool {
    tell(|player| player.obj())
}

/// Writes the log into the block [`TEXT`].
#[unsafe(no_mangle)]
extern "C" fn write_log() -> bool {
    tell(|player| Ok(player.log().into_bytes()))
}

/// The digest of everything that the cloth has become.
#[unsafe(no_mangle)]
extern "C" fn digest() -> u64 {
    verb(0, |player| Ok(player.digest()))
}

fn ray(origin: [f64; 3], direction: [f64; 3]) -> Result<Ray, String> {
    let ray = Ray::new(Point::from(origin), Vector::from(direction));
    ray.map_err(|error| error.to_string())
}

/// The whole number that was handed over, if it is one.
fn whole(given: f64) -> Option<u32> {
    let nearest = given as u32;
    (f64::from(nearest) == given).then_some(nearest)
}

/// The number of a hand.
fn number(hand: f64) -> Result<usize, String> {
    let number = whole(hand).map(|number| number as usize);
    number.ok_or_else(|| NO_HAND.to_owned())
}

fn missed() -> String {
    "there is no cloth there".to_owned()
}

/// Does something with the player; `refused` if it was refused, or there is no player.
fn verb<T>(refused: T, act: impl FnOnce(&mut Player<'static>) -> Result<T, String>) -> T {
    MODULE.with_borrow_mut(|module| {
        let player = module.player.as_mut().ok_or(NO_CLOTH);
        let done = player.map_err(str::to_owned).and_then(act);
        done.unwrap_or_else(|why| {
            module.text = why.into_bytes();
            refused
        })
    })
}

fn tell(text: impl FnOnce(&Player<'static>) -> Result<Vec<u8>, String>) -> bool {
    let told = verb(None, |player| text(player).map(Some));
    let told = told.map(|text| MODULE.with_borrow_mut(|module| module.text = text));
    told.is_some()
}

/// Puts other elements in the place of those of a block.
fn refill<T>(block: &mut Vec<T>, elements: impl IntoIterator<Item = T>) {
    block.clear();
    block.extend(elements);
}

impl Module {
    fn document(&mut self, settings: &Settings) -> Result<&'static Document, String> {
        if let ClothSource::File(name) = &settings.cloth {
            return self.file.ok_or_else(|| format!("`{name}` is not here"));
        }
        let known = self.sheet.as_ref();
        if let Some((_, document)) = known.filter(|(cloth, _)| *cloth == settings.cloth) {
            return Ok(document);
        }
        let document: &'static Document = Box::leak(Box::new(settings.document(&[])?));
        self.sheet = Some((settings.cloth.clone(), document));
        Ok(document)
    }

    fn input_text(&self) -> Result<String, String> {
        let text = std::str::from_utf8(&self.input);
        text.map(str::to_owned)
            .map_err(|_| "the text is not UTF-8".to_owned())
    }

    /// Puts a player in the place of the one before; whether there is one for these settings.
    fn replace(
        &mut self,
        settings: Result<Settings, String>,
        player: impl FnOnce(&'static Document, Settings) -> Result<Player<'static>, String>,
    ) -> bool {
        let made = settings.and_then(|mut settings| {
            settings.plan = self.plan.clone();
            player(self.document(&settings)?, settings)
        });
        let made = made.map_err(|why| self.text = why.into_bytes()).ok();
        let is_there = made.is_some();
        if is_there {
            let next_hand = self.player.as_ref().map_or(0, Player::next_hand);
            self.player = made;
            if let Some(player) = &mut self.player {
                player.number_hands_from(next_hand);
            }
            self.draw();
        }
        is_there
    }

    fn draw(&mut self) {
        let Some(player) = &mut self.player else {
            return;
        };
        let buffers = player.draw_buffers();
        let pieces = buffers.pieces().iter().max().map_or(0, |&last| last + 1);
        let (positions, indices) = (buffers.positions(), buffers.indices());
        let origin = buffers.origin();
        refill(
            &mut self.drawn,
            [of(positions), of(indices), of(buffers.pieces())],
        );
        let (sim, facts) = (player.simulation(), player.facts());
        let mesh = sim.mesh();
        let edge = |h| u8::from(mesh.pair(h).is_none()) + u8::from(mesh.ghost_pair(h).is_some());
        refill(&mut self.edges, mesh.half_edges().map(edge));
        let held = mesh.vertices().map(|v| u8::from(player.is_held(v)));
        refill(&mut self.held, held);
        let counts = [
            mesh.vertex_count(),
            mesh.face_count(),
            pieces as usize,
            facts.held_first,
            facts.tears,
            facts.heals,
            facts.sewn,
            facts.left,
            sim.open_pairs(),
        ];
        refill(&mut self.facts, counts.map(|count| count as f64));
        self.facts.extend([sim.time_s(), sim.step_s()]);
        self.facts.extend(facts.grabbed_at);
        self.facts.extend(<[f64; 3]>::from(origin));
        let (points, faces) = player.solids();
        let (places, corners) = &mut self.solids;
        let drawn = points.iter().map(|p| p - origin);
        let numbers = drawn.flat_map(|p| [p.x, p.y, p.z]);
        refill(places, numbers.map(|x| x as f32));
        refill(corners, faces.into_flattened());
        let cloth = [of(&self.edges), of(&self.held), of(&self.facts)];
        self.drawn.extend(cloth);
        self.drawn.extend([of(places), of(corners)]);
    }

    /// Where a block is, and how many bytes it has.
    fn block(&mut self, block: f64) -> (usize, usize) {
        let why = match whole(block) {
            Some(TEXT) => return of(&self.text),
            Some(number) if number < TEXT => match self.drawn.get(number as usize) {
                Some(&drawn) => return drawn,
                None => NO_CLOTH.to_owned(),
            },
            _ => format!("there is no block {block}"),
        };
        self.text = why.into_bytes();
        (0, 0)
    }
}

/// Where a slice is, and how many bytes it has.
fn of<T>(slice: &[T]) -> (usize, usize) {
    (slice.as_ptr() as usize, size_of_val(slice))
}

//! A row of the table as a sequence of verbs on files, and what is judged of them beside each cut.

use tearmesh::{CutLayers, CutMethod, CutTips};
use tearmesh_cli::Exit;

use crate::aims::{along, moved, plane, slit};
use crate::counts::Counts;
use crate::in_process::{Ran, in_memory};
use crate::judge::{Case, straight, sums};
use crate::library::{Made, State, Step, cut, cut_surface};
use crate::meshes::Start;
use crate::oracle::aim::{Line, aimed, distance};
use crate::oracle::by_place::{by_place, has_layers, open_edges};
use crate::oracle::straight::{Surface, cross, minus};
use crate::random::Random;
use crate::table::Levels;
use crate::verb::{Along, CutVerb, Verb};

type Point = [f64; 3];

/// How often another way is drawn where a cut is refused or tears nothing.
const DRAWS: usize = 8;

/// A sequence that is drawn while it runs.
pub(crate) struct Sequence {
    pub(crate) levels: Levels,
    pub(crate) start: Start,
    /// What was done so far.
    pub(crate) verbs: Vec<Verb>,
    pub(crate) random: Random,
    /// What is turned and renumbered.
    pub(crate) has_torn: bool,
}

/// The state of a sequence.
struct World<'w> {
    levels: &'w Levels,
    start: &'w Start,
    /// The file as it was first, and is now.
    first: String,
    file: String,
    counts: &'w mut Counts,
    random: Random,
    /// Whether something may be left that nothing needs: what was mended, or inserted and not torn.
    has_loose: bool,
}

impl Sequence {
    pub(crate) fn new(levels: Levels, seed: u64) -> Sequence {
        let mut random = Random(seed);
        Sequence {
            start: Start::of(&levels, &mut random),
            levels,
            verbs: Vec::new(),
            random,
            has_torn: false,
        }
    }

    /// Draws verbs, and runs and judges each.
    pub(crate) fn run(&mut self, counts: &mut Counts) {
        let mut world = World::new(&self.levels, &self.start, Random(self.random.0 ^ 1), counts);
        let mut add = |verbs: &mut Vec<Verb>, verb: Verb| {
            verbs.push(verb.clone());
            let is_done = world.run(&verb);
            if !is_done {
                verbs.pop();
            }
            is_done
        };
        let (start, levels, random) = (&self.start, &self.levels, &mut self.random);
        let of_row = |along| cut_of(levels, along, start);
        let before = match levels.of("history") {
            "cut" => 1 + random.below(2),
            "mended" => 1,
            _ => 0,
        };
        for _ in 0..before {
            add(&mut self.verbs, slit_of(start, random));
        }
        if levels.of("history") == "mended" {
            add(&mut self.verbs, Verb::Mend(near(start, random)));
        }
        let total = 2 + random.below(5);
        for _ in 0..DRAWS {
            let mut verb = of_row(along(levels, &start.surface, start.size, random));
            verb.welds = levels.of("history") == "welded";
            if add(&mut self.verbs, Verb::Cut(verb)) {
                self.has_torn = true;
                break;
            }
        }
        for _ in 0..DRAWS {
            if self.verbs.len() >= total {
                break;
            }
            let verb = match random.below(6) {
                0 | 1 => Verb::Cut(of_row(along(levels, &start.surface, start.size, random))),
                2 => slit_of(start, random),
                3 => Verb::Mend(near(start, random)),
                4 => Verb::Mend(near(start, random) + " --simplify"),
                _ => Verb::Mend(["--last 1", "--last 1 --simplify"][random.below(2)].to_owned()),
            };
            add(&mut self.verbs, verb);
        }
        world.end();
    }

    /// Runs these verbs alone, and judges them.
    pub(crate) fn run_again(&self, verbs: &[Verb]) {
        let mut counts = Counts::default();
        let random = Random(self.random.0 ^ 1);
        let mut world = World::new(&self.levels, &self.start, random, &mut counts);
        for verb in verbs {
            world.run(verb);
        }
        world.end();
    }
}

/// A cut by the options of a row.
fn cut_of(levels: &Levels, along: Along, start: &Start) -> CutVerb {
    CutVerb {
        along,
        method: match levels.of("method") {
            "exact" => CutMethod::Exact,
            "partition" => CutMethod::Partition,
            "uniform" => CutMethod::Uniform,
            _ => CutMethod::Alternating,
        },
        snap: levels.of("snap").parse().expect("a number"),
        moves: levels.of("snap-move") == "yes",
        layers: match levels.of("layers") {
            "first" => CutLayers::First,
            _ => CutLayers::All,
        },
        through: levels.of("through") == "yes",
        tips: match levels.of("tips") {
            "midpoint" => CutTips::Midpoint,
            _ => CutTips::Vertex,
        },
        halves: levels.of("mass") == "half",
        gap: (levels.of("gap") == "tenth").then(|| 0.1 * start.surface.mean_edge()),
        welds: false,
    }
}

/// A cut by default.
fn slit_of(start: &Start, random: &mut Random) -> Verb {
    let along = match random.below(3) {
        0 => plane(&start.surface, false, random),
        _ => slit(&start.surface, start.size, random),
    };
    Verb::Cut(CutVerb {
        along,
        method: CutMethod::Exact,
        snap: 0.05,
        moves: false,
        layers: CutLayers::All,
        through: false,
        tips: CutTips::Vertex,
        halves: false,
        gap: None,
        welds: false,
    })
}

/// Mends a ball of the mesh.
fn near(start: &Start, random: &mut Random) -> String {
    let points = &start.surface.points;
    let [x, y, z] = points[random.below(points.len())];
    let radius = start.size * [0.1, 0.25, 0.5][random.below(3)];
    format!("--near {x},{y},{z} --radius {radius}")
}

impl<'w> World<'w> {
    fn new(
        levels: &'w Levels,
        start: &'w Start,
        random: Random,
        counts: &'w mut Counts,
    ) -> World<'w> {
        // As the command writes it.
        let file = typed(&nowhere(""), &start.file);
        assert_eq!(file.exit, Exit::Done, "{}", file.error);
        let first = String::from_utf8(file.output).expect("text");
        World {
            levels,
            start,
            file: first.clone(),
            first,
            counts,
            random,
            has_loose: false,
        }
    }

    /// Runs a verb by the command, and judges it; whether it changed anything.
    fn run(&mut self, verb: &Verb) -> bool {
        match verb {
            Verb::Cut(cut) => self.cut(cut),
            Verb::Mend(words) => self.mend(words),
        }
    }

    fn cut(&mut self, verb: &CutVerb) -> bool {
        let line = Verb::Cut(verb.clone()).typed();
        let ran = typed(&line, &self.file);
        if verb.welds && self.first == self.file {
            // From here on, the mesh is the welded one.
            let welded = typed(&nowhere(" --weld"), &self.file);
            assert_eq!(welded.exit, Exit::Done, "{}", welded.error);
            self.file = String::from_utf8(welded.output).expect("text");
            self.first = self.file.clone();
        }
        let made = match cut(&self.file, verb) {
            Ok(made) => made,
            Err(refused) => {
                let error = refused.to_string();
                assert!(ran.exit != Exit::Done && ran.output.is_empty(), "{error}");
                self.counts.add("file");
                return false;
            }
        };
        assert_eq!(ran.exit, Exit::Done, "{line}: {}", ran.error);
        let written = String::from_utf8(ran.output).expect("text");
        assert!(
            written == made.file,
            "the command writes what the library does not"
        );
        self.counts.add("file");
        // Of a row of pieces, each is as far from the next.
        let most = verb.gap.unwrap_or(0.0) * made.last().surface.pieces().1 as f64;
        assert!(made.apart <= most, "{} apart", made.apart);
        let (levels, start, counts) = (self.levels, self.start, &mut *self.counts);
        let made = &made;
        Case {
            start,
            levels,
            verb,
            made,
            counts,
            rounding: 0.0,
        }
        .judge();
        self.beside(verb, made);
        let before = std::mem::replace(&mut self.file, written);
        if verb.gap.is_none() && self.levels.of("gap") == "none" {
            self.undone(&before, made);
        }
        self.has_loose |= made.torn() < made.steps.len();
        made.torn() > 0
    }

    /// The file as it is without what nothing needs.
    fn simplified(&self, mend: &str, file: &str) -> String {
        let ran = typed(&format!("mend - {mend} --simplify"), file);
        match ran.exit {
            Exit::Done => String::from_utf8(ran.output).expect("text"),
            Exit::NothingCut => file.to_owned(),
            _ => panic!("{}", ran.error),
        }
    }

    /// Undone, a cut leaves what was there before, to the byte.
    fn undone(&mut self, before: &str, made: &Made) {
        const NOTHING: &str = "--near 1e9,1e9,1e9 --radius 0";
        let torn = made.torn();
        let simple = self.simplified(NOTHING, before);
        let is_same = self.has_loose || simple == before;
        assert!(
            is_same,
            "where nothing was mended, there is less:\n{before}is\n{simple}"
        );
        let before = simple;
        let undone = match torn {
            0 => self.simplified(NOTHING, &self.file),
            _ => self.simplified(&format!("--last {torn}"), &self.file),
        };
        assert!(
            undone == before,
            "undone, a cut leaves another file:\n{before}is\n{undone}"
        );
        self.counts.add("undo");
    }

    fn mend(&mut self, words: &str) -> bool {
        let ran = typed(&format!("mend - {words}"), &self.file);
        match ran.exit {
            Exit::Done => {}
            Exit::NothingCut => return false,
            _ => panic!("{}", ran.error),
        }
        let written = String::from_utf8(ran.output).expect("text");
        let [before, after] = [&self.file, &written].map(|file| State::read(file));
        let pieces = |state: &State| state.surface.pieces().1;
        assert!(
            pieces(&after) <= pieces(&before),
            "mended, there are more pieces"
        );
        self.file = written;
        self.has_loose = true;
        true
    }

    /// At the end: all is mended, and nothing is left.
    fn end(&mut self) {
        let whole = self.simplified("", &self.file);
        let first = self.simplified("", &self.first);
        assert!(
            whole == first,
            "mended, the file is another:\n{first}is\n{whole}"
        );
        self.counts.add("record");
        self.counts.end_sequence();
    }

    /// The same cut in other ways, of which the library makes the same.
    fn beside(&mut self, verb: &CutVerb, made: &Made) {
        let state = made.first();
        let surface = &state.surface;
        let is_whole = (0..surface.points.len()).all(|v| state.roots[v] == v as u32);
        let is_exact = verb.method == CutMethod::Exact;
        if is_exact && self.start.is_flat && !verb.pairs().is_empty() && !verb.through {
            self.through_other_layers(verb, made);
        }
        if !is_exact || !is_whole {
            return;
        }
        self.exactly(verb, surface);
        if has_layers(surface) && verb.layers == CutLayers::First {
            return; // Which of two layers at one place is the first, their numbers may decide.
        }
        self.renumbered(verb, surface, made);
        if !has_layers(surface) && !self.levels.is("mesh", "far tiny") {
            self.turned(verb, surface, made);
        }
    }

    /// Of one layer, the first is all, where each ray meets it or not whatever rounding does. (A cut that ends where it
    /// began is missed by one and refused by the other.)
    fn through_other_layers(&mut self, verb: &CutVerb, made: &Made) {
        let surface = &made.first().surface;
        let mut lines = verb.pairs().into_iter().flatten();
        if lines.any(|line| meets_border(line, surface)) {
            return;
        }
        let layers = match verb.layers {
            CutLayers::All => CutLayers::First,
            _ => CutLayers::All,
        };
        let verb = CutVerb {
            layers,
            ..verb.clone()
        };
        match cut(&self.file, &verb) {
            Ok(other) => is_the_same(&made.steps, &other.steps, "through the first layer alone"),
            Err(_) if made.torn() == 0 => {}
            Err(error) => panic!("the first layer of one: {error}"),
        }
        self.counts.add("layers");
    }

    /// The same rays or plane without a snap, through all layers, is what the oracle of straight cuts foresees.
    fn exactly(&mut self, verb: &CutVerb, surface: &Surface) {
        let verb = CutVerb {
            snap: 0.0,
            moves: false,
            layers: CutLayers::All,
            ..verb.clone()
        };
        let is_foreseen = !self.levels.is("rays", "skew nearly-one-eye converging");
        if !is_foreseen || self.levels.is("mesh", "far") || has_layers(surface) {
            return; // The oracle turns sides by origins, and rounds by edges.
        }
        let Ok(steps) = cut_surface(surface, &verb) else {
            return;
        };
        if straight(surface, &verb, &steps, self.start.is_flat) {
            self.counts.add("exactly");
        }
    }

    fn renumbered(&mut self, verb: &CutVerb, surface: &Surface, made: &Made) {
        let mut order: Vec<u32> = (0..surface.points.len() as u32).collect();
        self.random.shuffle(&mut order);
        let mut points = surface.points.clone();
        for (&p, &to) in surface.points.iter().zip(&order) {
            points[to as usize] = p;
        }
        let mut faces: Vec<[u32; 3]> = surface.faces.clone();
        self.random.shuffle(&mut faces);
        for face in &mut faces {
            *face = face.map(|v| order[v as usize]);
            face.rotate_left(self.random.below(3));
        }
        let other = cut_surface(&Surface { points, faces }, verb);
        let other = other.expect("it is not refused with other numbers");
        // A cut goes on from the nearest of the vertices that the last one ended at, and of two at one place from the one
        // that comes first.
        if verb.pairs().len() > 1 && has_layers(surface) {
            return;
        }
        is_the_same(&made.steps, &other, "renumbered");
        // A slide, and a tip within its face, are computed from the corner that comes first.
        if !made.has_slid() && verb.pairs().is_empty() {
            let last = &other[other.len() - 1].after.surface;
            let is_same = by_place(last) == by_place(&made.last().surface);
            assert!(is_same, "renumbered, a cut along a plane is another");
        }
        self.counts.add("renumbered");
    }

    fn turned(&mut self, verb: &CutVerb, surface: &Surface, made: &Made) {
        let mirrors = self.random.below(2) == 0;
        let turn = |[x, y, z]: Point| {
            if mirrors {
                [-y, x, -z].map(|c| -c)
            } else {
                [z, x, y]
            }
        };
        let is_mirrored = is_mirror(turn);
        let mut other = surface.clone();
        other.points.iter_mut().for_each(|p| *p = turn(*p));
        if is_mirrored {
            other.faces.iter_mut().for_each(|face| face.reverse());
        }
        let along = moved(&verb.along, turn);
        let other = cut_surface(
            &other,
            &CutVerb {
                along,
                ..verb.clone()
            },
        );
        let other = other.expect("it is not refused where it is turned");
        is_the_same(&made.steps, &other, "turned");
        self.counts.add("turned");
    }
}

/// Cuts made the same, up to rounding.
fn is_the_same(one: &[Step], other: &[Step], how: &str) {
    let (one, other) = (sums(one), sums(other));
    assert_eq!(one.0, other.0, "{how}, a cut is another");
    for (a, b) in one.1.iter().zip(&other.1) {
        let is_near = (a - b).abs() <= 1e-7 * (a.abs() + 1e-9);
        assert!(is_near, "{how}, {a} is {b}");
    }
}

/// Whether a ray passes so near the border that rounding decides whether it meets the mesh.
fn meets_border(line: Line, surface: &Surface) -> bool {
    let Some(at) = aimed(line, surface, -1e-6) else {
        return false;
    };
    let most = 1e-5 * surface.mean_edge();
    let border = open_edges(surface);
    border.into_iter().any(|edge| distance(edge, at) <= most)
}

/// Whether a map turns the space inside out.
fn is_mirror(map: impl Fn(Point) -> Point) -> bool {
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(map);
    minus(cross(x, y), z) != [0.0; 3]
}

/// A line that changes nothing but what an option says.
fn nowhere(option: &str) -> String {
    format!("cut - --plane 1e9,0,0:1,0,0 --allow-miss{option}")
}

/// Runs a line of the command on a file.
fn typed(line: &str, file: &str) -> Ran {
    let line = format!("tearmesh {} -q -o -", line.trim_end());
    let words = line.split(' ').filter(|word| !word.is_empty());
    in_memory(words, file.as_bytes(), false)
}

//! The pairs of the solver layer through the command and the page: each scene of their table is a file, which `tear`
//! and the page play as the library does, to the bit, and whose energy adds up as it is printed.

#[path = "../cloth/combinations/factors.rs"]
#[allow(dead_code, reason = "the tests of cloth use the rest")]
mod factors;
#[path = "../cloth/combinations/shapes.rs"]
#[allow(dead_code, reason = "the tests of cloth use the rest")]
mod shapes;
#[path = "../cloth/combinations/text.rs"]
#[allow(dead_code, reason = "the tests of cloth use the rest")]
mod text;

use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};

use serde_json::Value;
use tearmesh::{CutLayers, Mesh, Point, Positions, Scissor, Vector, VertexId};
use tearmesh_cloth::scene::file::SceneFile;
use tearmesh_cloth::scene::{Axis, Frame, Run, Scene, Warning};
use tearmesh_cloth::{EnergyBalance, HandId, Simulation, StepError, Wounds};
use tearmesh_obj::Document;
use tearmesh_play::{Plan, Player, Settings};
use tempfile::TempDir;

use self::factors::{Case, EXCLUSIONS, FACTORS};
use self::shapes::{Shape, TORN};
use self::text::{BOX, CUT, FRAMES, GRABBED, HEALED, LED_M, RELEASED, Text, at_s};
use crate::array::Table;
use crate::in_process::{Ran, in_memory};
use crate::random::Random;
use crate::read_back::{added_up, content};
use crate::support::cases::{cases, planted};
use crate::support::fixtures::{block, ray};

/// What of a case is in files, and what the library reads in them.
struct Files {
    folder: TempDir,
    shape: Shape,
    text: Text,
    document: Document,
    mesh: Mesh,
    positions: Positions,
}

impl Files {
    fn of(case: &Case) -> Files {
        let folder = tempfile::tempdir().expect("a folder");
        let shape = Shape::of(case.get("mesh"));
        let text = Text::of(case, &shape);
        let body = block(BOX[0], BOX[1]);
        let path = |name: &str| folder.path().join(name);
        fs::write(path("block.obj"), obj(&body)).expect("a file");
        fs::write(path("scene.toml"), text.toml()).expect("a file");
        if case.is("mesh", "torn") {
            let flat = Shape::of("flat").obj();
            let rays = TORN.map(|[x, y]| format!("{x},{y},5:0,0,-1"));
            let typed = [
                "tearmesh", "cut", "-", "-o", "-", "--rays", &rays[0], &rays[1],
            ];
            let torn = in_memory(typed, flat.as_bytes(), false);
            fs::write(path("mesh.obj"), torn.output).expect("a file");
        } else {
            fs::write(path("mesh.obj"), shape.obj()).expect("a file");
        }
        let bytes = fs::read(path("mesh.obj")).expect("it was written");
        let document = Document::read(&bytes[..]).expect("a file of ours");
        let mesh = document.mesh().expect("a mesh of ours");
        let points = document.positions().iter().copied();
        Files {
            positions: Positions::new(points).expect("finite"),
            folder,
            shape,
            text,
            document,
            mesh,
        }
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.folder.path().join(name)).unwrap_or_default()
    }

    /// Has the command do something with the scene, and write it to these files.
    fn command(&self, verb: &str, written: &[&str]) -> Ran {
        let path = |name: &str| self.folder.path().join(name).display().to_string();
        let files = ["mesh.obj", "scene.toml"]
            .into_iter()
            .chain(written.iter().copied());
        let files: Vec<String> = files.map(path).collect();
        let options = ["", "--scene", "-o", "--report"].into_iter().zip(&files);
        let typed = options.flat_map(|(option, file)| [option, file]);
        let typed = typed.filter(|word| !word.is_empty());
        in_memory(["tearmesh", verb].into_iter().chain(typed), b"", false)
    }

    /// The scene as a program reads it. The ids of vertices are those of the mesh.
    fn scene(&self) -> (Scene, Frame) {
        let file = serde_json::from_str::<SceneFile>(&self.text.json());
        let file = file.expect("keys of scene files");
        let frame = Frame::new(&self.mesh, self.positions.as_slice(), Axis::Y);
        let scene = file.on(&frame, None, &mut |_, _| Ok(block(BOX[0], BOX[1])));
        let mut scene = scene.unwrap_or_else(|faults| panic!("{}", faults[0]));
        let ids: BTreeMap<_, _> = self.renumbered().into_iter().collect();
        scene.rename_vertices(|named| *ids.get(&named).unwrap_or(&named));
        (scene, frame)
    }

    /// The vertices that have another id than their number in the file says, with that id second.
    fn renumbered(&self) -> Vec<(VertexId, VertexId)> {
        let number = |v: VertexId| self.document.number_of_vertex(v.index()) - 1;
        let named = self
            .mesh
            .vertices()
            .map(|v| (VertexId::new(number(v)).expect("an id"), v));
        named.filter(|(named, v)| named != v).collect()
    }
}

fn obj((points, faces): &(Vec<Point>, Vec<[u32; 3]>)) -> String {
    let points = points.iter();
    let points = points.map(|p| format!("v {:?} {:?} {:?}\n", p.x, p.y, p.z));
    let faces = faces.iter().map(|face| {
        let [a, b, c] = face.map(|v| v + 1);
        format!("f {a} {b} {c}\n")
    });
    points.chain(faces).collect()
}

/// A run of the library, as far as it goes.
fn run(files: &Files) -> (Run, Option<StepError>) {
    let (scene, frame) = files.scene();
    let run = Run::new(files.mesh.clone(), &files.positions, scene, &frame);
    let mut run = run.unwrap_or_else(|error| panic!("no run: {error}"));
    while !run.is_over() && !Warning::has_exploded(&run) {
        if let Err(error) = run.step() {
            return (run, Some(error));
        }
    }
    (run, None)
}

/// The corners of all faces by their bits, each from its least on, in order.
fn faces(points: &[Point], faces: &[[u32; 3]]) -> Vec<[[u64; 3]; 3]> {
    let bits = |v: u32| [0, 1, 2].map(|axis| (points[v as usize][axis] + 0.0).to_bits());
    let mut all: Vec<_> = faces
        .iter()
        .map(|face| {
            let corners = face.map(bits);
            let turns = [0, 1, 2].map(|by| [0, 1, 2].map(|i| corners[(i + by) % 3]));
            turns.into_iter().min().expect("three turns")
        })
        .collect();
    all.sort_unstable();
    all
}

/// The energies of a report are those of the library, and add up.
fn reported(energy: &Value, balance: &EnergyBalance, is_limited: bool) {
    let given = |key: &str| energy[key].as_f64();
    let own = [
        ("began", balance.began_j),
        ("kinetic", balance.kinetic_j),
        ("elastic", balance.elastic_j),
        ("gravity", balance.gravity_j),
        ("wind", balance.wind_j),
        ("drag", balance.drag_j),
        ("damping", balance.damping_j),
        ("colliders", balance.colliders_j),
        ("edits", balance.edits_j),
    ];
    for (key, joules) in own {
        assert_eq!(given(key), Some(joules), "{key} of the report");
    }
    let left = ["held", "numerical_dissipation"].map(given);
    assert_eq!(left.map(|one| one.is_some()), [!is_limited; 2], "{energy}");
    if let [Some(held), Some(lost)] = left {
        let works = [
            "began",
            "gravity",
            "wind",
            "drag",
            "damping",
            "colliders",
            "edits",
        ];
        let works = works.map(|key| given(key).expect("a number"));
        let there = balance.kinetic_j + balance.elastic_j + lost;
        let size: f64 = works.iter().map(|joules| joules.abs()).sum();
        let off = there - held - works.iter().sum::<f64>();
        assert!(
            off.abs() <= 1e-9 * (size + there.abs()),
            "{off} J: {energy}"
        );
    }
}

/// The command plays the scene as the library does, and what it says of energy adds up. Gives whether it printed joules
/// that do.
fn command_is_library(files: &Files) -> bool {
    let ran = files.command("tear", &["out.obj", "r.json"]);
    let said = format!("{}{}", String::from_utf8_lossy(&ran.output), ran.error);
    let report = serde_json::from_slice::<Value>(&files.read("r.json"));
    let report = report.unwrap_or_else(|error| panic!("{error}:\n{said}"));
    let (run, refused) = run(files);
    if let Some(error) = refused {
        let code = format!("error[{}]", error.code());
        assert!(said.contains(&code), "{error}:\n{said}");
    }
    assert_eq!(report["steps"], run.tally().steps, "{said}");
    let is_limited = run.quality().has_limited();
    reported(&report["energy_j"], &run.energy_balance(), is_limited);
    if run.tally().steps > 0 {
        let written = Document::read(&files.read("out.obj")[..]).expect("a file");
        let found = faces(written.positions(), written.triangles());
        let own = run.mesh().indices().as_chunks::<3>().0;
        let own = faces(run.cloth().positions(), own);
        assert!(found == own, "another cloth:\n{said}");
    }
    let added_up = added_up(&said);
    let has_begun = run.tally().steps > 0;
    assert_eq!(added_up.is_some(), has_begun && !is_limited, "{said}");
    let missing_j = added_up.as_ref().map_or(0.0, |(_, missing_j)| *missing_j);
    assert_eq!(missing_j, 0.0, "joules are missing:\n{said}");
    added_up.is_some()
}

/// Whether the command refuses the scene of a case, which the library plays as one that never tears.
fn is_refused(case: &Case) -> bool {
    case.is("fabric", "woven") && case.is("threshold", "force")
}

/// The command refuses the scene, and writes nothing.
fn command_refuses(files: &Files) {
    for (verb, written) in [
        ("tear", &["out.obj", "r.json"][..]),
        ("play", &["page.html"]),
    ] {
        let ran = files.command(verb, written);
        let said = "error[E-SCENE-CLASH]: `threshold_n` is the pull of springs";
        assert!(ran.error.contains(said), "{}", ran.error);
        let is_there = |name: &&str| files.folder.path().join(name).exists();
        assert!(!written.iter().any(is_there), "{verb} wrote files");
    }
}

/// The simulation of a program beside that of a page: the same verbs, the same bits.
struct Twins<'d> {
    page: Player<'d>,
    own: Simulation,
    hand: Option<(usize, HandId, Point)>,
    grip_m: f64,
}

impl Twins<'_> {
    fn perform(&mut self, case: &Case, files: &Files, frame: u64) {
        let (page, own) = (&mut self.page, &mut self.own);
        if frame == CUT && !case.is("cut", "none") {
            let [a, b] = files.shape.slit.map(|[x, y]| ray(x, y));
            let is_first = case.is("cut", "snap0");
            let layers = if is_first {
                CutLayers::First
            } else {
                CutLayers::All
            };
            let scissor = Scissor::new(a, b).expect("a plane").with_layers(layers);
            let [one, other] = [
                page.cut([a, b], is_first).is_ok(),
                own.cut(&scissor).is_ok(),
            ];
            assert_eq!(one, other, "a cut");
        }
        if frame == HEALED && !case.is("heal", "none") {
            assert_eq!(Ok(page.heal()), own.heal(Wounds::All), "pairs to be healed");
        }
        if case.is("hand", "none") {
            return;
        }
        match (frame, self.hand) {
            (GRABBED, _) => {
                let at = own.cloth().positions()[files.shape.hand];
                let down = ray(at.x, at.y);
                let picked = own.pick(&down).map(|picked| picked.vertex);
                let grabbed = page.grab(&down).expect("a hand");
                assert_eq!(grabbed.is_some(), picked.is_some(), "a hand");
                self.hand = picked.zip(grabbed).map(|(v, number)| {
                    let from = own.cloth().positions()[v.index()];
                    let hand = own.grab(v, self.grip_m).expect("a hand");
                    (number, hand, from)
                });
            }
            (RELEASED, Some((number, hand, _))) => {
                page.release(number).expect("a hand");
                own.release(hand).expect("a hand");
            }
            (_, Some((number, hand, from))) if frame < RELEASED => {
                let part = (frame - GRABBED) as f64 / 8.0;
                let to = from + Vector::from(LED_M) * part.min(1.0);
                page.lead(number, to).expect("a hand");
                own.lead(hand, to).expect("a hand");
            }
            _ => {}
        }
    }
}

/// The page plays what a scene begins with as a program does that begins with it. None if it lays a floor under it.
fn page_is_library(case: &Case, files: &Files) -> Option<()> {
    let (scene, frame) = files.scene();
    let points = files.positions.as_slice();
    let opening = scene.opening(&files.mesh, points, &frame);
    let opening = opening.unwrap_or_else(|error| panic!("no beginning: {error}"));
    if opening.held.is_empty() && opening.def.loads.colliders.is_empty() {
        return None;
    }
    let made = files.command("play", &["page.html"]);
    let html = String::from_utf8(files.read("page.html")).expect("a page is text");
    assert!(!html.is_empty(), "{}", made.error);
    let (text, obj) = content(&html);
    let settings =
        "cloth file mesh.obj\nscene file scene.toml\nup y\nmethod scene\nthreshold scene\n";
    let mut settings: Settings = settings.parse().expect("settings");
    let plan = text["plan"].as_str().expect("a plan");
    settings.plan = Some(Plan::read(plan.as_bytes()).expect("a scene"));
    let document = settings.document(&obj).expect("a document");
    let page = Player::new(&document, settings).expect("a player");
    let own = Simulation::new(files.mesh.clone(), &files.positions, opening.def);
    let mut own = own.expect("a simulation");
    own.hold(opening.held.iter().copied()).expect("vertices");
    let mut twins = Twins {
        page,
        own,
        hand: None,
        grip_m: Simulation::GRIP_RADIUS_M * frame.size_m(),
    };
    for frame in 0..FRAMES {
        twins.perform(case, files, frame);
        // A page has a wind that sways change twenty times a second.
        let changed_s = (twins.own.time_s() * 20.0).floor() / 20.0;
        let wind = opening.wind.map(|wind| wind.at(changed_s));
        if twins.own.cloth().system().loads().wind != wind {
            twins.own.set_wind(wind).expect("a wind");
        }
        let one = twins.page.advance(at_s(1), u64::MAX);
        let other = twins.own.advance(at_s(1), u64::MAX);
        let other = other.map(|reached| reached.steps);
        assert_eq!(
            one,
            other.map_err(|error| error.to_string()),
            "frame {frame}"
        );
        let [one, other] = [twins.page.simulation(), &twins.own].map(|sim| {
            let triangles = sim.mesh().indices().as_chunks::<3>().0;
            faces(sim.cloth().positions(), triangles)
        });
        assert!(one == other, "another cloth after frame {frame}");
    }
    Some(())
}

#[test]
fn every_pair_of_the_solver_layer_is_played_alike_by_command_page_and_library() {
    let table = Table::new(FACTORS, EXCLUSIONS);
    let first = std::env::var("TEARMESH_SEED").map_or(1, |seed| seed.parse().expect("a number"));
    let seeds = first..first + if cases() > 1_500 { 3 } else { 1 };
    for seed in seeds {
        let cover = table.rows(2, &mut Random(seed));
        let (mut printed, mut pages, mut failed) = (0, 0, 0);
        for row in &cover.rows {
            let case = Case::of_row(&table, row);
            let judged = catch_unwind(AssertUnwindSafe(|| {
                let files = Files::of(&case);
                if is_refused(&case) {
                    return command_refuses(&files);
                }
                printed += usize::from(command_is_library(&files));
                pages += usize::from(page_is_library(&case, &files).is_some());
            }));
            if let Err(panic) = judged {
                let text = Text::of(&case, &Shape::of(case.get("mesh")));
                println!("{case}: {}\n{}", crate::message(&*panic), text.toml());
                failed += 1;
                if planted() == Some(true) {
                    break;
                }
            }
        }
        let rows = cover.rows.len();
        println!(
            "seed {seed}: {rows} scenes by the command, {printed} with joules that add up; {pages} by the page"
        );
        assert_eq!(failed, 0, "of {rows} scenes");
        assert!(printed >= 20 && pages >= 20, "{printed} {pages}");
    }
}

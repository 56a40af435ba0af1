//! Scenes that play on a square metre.

use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock};

use tearmesh::{Mesh, Positions, shapes};
use tearmesh_cloth::Method;
use tearmesh_cloth::implicit::Settings;
use tearmesh_cloth::scene::{Axis, Frame, Run, Scene, TearLog};

/// A square of one metre with `cells` cells per side and alternating diagonals.
pub(crate) fn square(cells: u32) -> (Mesh, Positions) {
    shapes::grid_with_diagonals(cells, cells, |i, j| (i + j) % 2 == 0)
}

/// A scene on a [`square`], about to begin.
pub(crate) fn staged(cells: u32, scene: impl Fn(&Frame) -> Scene) -> Run {
    let (mesh, positions) = square(cells);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    Run::new(mesh, &positions, scene(&frame), &frame).expect("a scene")
}

/// Plays a run to its end.
///
/// # Panics
///
/// If a step fails.
pub(crate) fn play(mut run: Run) -> Run {
    while !run.is_over() {
        run.step().expect("a step");
    }
    run
}

/// Plays a run to its end, and notes what tore.
pub(crate) fn noted(mut run: Run) -> (Run, TearLog) {
    let mut log = TearLog::new(&run);
    while !run.is_over() {
        let step = run.step().expect("a step");
        log.note(&run, &step);
    }
    (run, log)
}

/// The scene of this name that stands ready.
fn ready(name: &str, frame: &Frame) -> Scene {
    match name {
        "fall" => Scene::fall(frame.up),
        "hang" => Scene::hang(frame),
        "flag" => Scene::flag(frame),
        "rip" => Scene::rip(frame),
        "trouser" => Scene::trouser(frame),
        _ => panic!("{name} does not stand ready"),
    }
}

/// What was played of those, by cells, scene and method.
type Played = BTreeMap<(u32, &'static str, &'static str), &'static OnceLock<Run>>;

/// A ready scene on a [`square`] after its end, by one of [`methods`]. It is played once, whoever reads
/// it.
pub(crate) fn played(cells: u32, scene: &'static str, method: &'static str) -> &'static Run {
    static PLAYED: Mutex<Played> = Mutex::new(BTreeMap::new());
    let run = {
        let mut played = PLAYED.lock().expect("nobody panics while they hold it");
        *played
            .entry((cells, scene, method))
            .or_insert_with(|| Box::leak(Box::default()))
    };
    run.get_or_init(|| {
        let solver = methods().into_iter().find(|(name, _)| *name == method);
        let (_, solver) = solver.expect("a method");
        play(staged(cells, |frame| Scene {
            solver: solver.clone(),
            ..ready(scene, frame)
        }))
    })
}

/// Every method that a scene can name, by its name.
pub(crate) fn methods() -> [(&'static str, Method); 5] {
    [
        ("xpbd", Method::xpbd()),
        ("pbd", Method::pbd()),
        ("verlet", Method::Verlet),
        ("provot", Method::provot()),
        ("implicit", Method::Implicit(Settings::default())),
    ]
}

//! Scenes that play on a square metre.

use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock};

use tearmesh::{HalfEdgeId, Mesh, Positions, Vector, shapes};
use tearmesh_cloth::scene::{
    Axis, Frame, Region, Run, Scene, SwayingWind, TearLog, Warning, Wording,
};
use tearmesh_cloth::{Method, Wind};

/// A square of one metre with `cells` cells per side and alternating diagonals.
pub(crate) fn square(cells: u32) -> (Mesh, Positions) {
    shapes::grid_with_diagonals(cells, cells, |i, j| (i + j) % 2 == 0)
}

/// Its upper edge.
pub(crate) fn top() -> Region {
    Region::Patch {
        across: [0.0, 1.0],
        along: [1.0, 1.0],
    }
}

/// Wind of these speeds along z.
pub(crate) fn swaying(steady: f64, sway: f64, period_s: f64) -> SwayingWind {
    let steady = Wind {
        velocity_m_per_s: Vector::z() * steady,
        coefficient: 1.0,
    };
    SwayingWind {
        sway_m_per_s: Vector::z() * sway,
        period_s,
        ..SwayingWind::steady(steady)
    }
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

/// A run that was played to its end.
pub(crate) struct Played {
    pub(crate) run: Run,
    pub(crate) log: TearLog,
    /// After each step in which something tore: the time in seconds, the splits, and the length of the tears.
    pub(crate) torn: Vec<(f64, u64, f64)>,
    /// After each cut: the time in seconds, its number, and whether it made two pieces of one.
    pub(crate) cuts: Vec<(f64, usize, bool)>,
}

/// Plays a run to its end, and notes what tore.
pub(crate) fn noted(mut run: Run) -> Played {
    let (mut log, mut torn, mut cuts) = (TearLog::new(&run), Vec::new(), Vec::new());
    while !run.is_over() {
        let before = run.tally().splits;
        let step = run.step().expect("a step");
        log.note(&run, &step);
        let made = (cuts.len()..).zip(run.cuts_made());
        cuts.extend(made.map(|(number, cut)| (run.elapsed_s(), number, cut.separated)));
        if run.tally().splits > before {
            torn.push((run.elapsed_s(), run.tally().splits, run.torn_length_m()));
        }
    }
    Played {
        run,
        log,
        torn,
        cuts,
    }
}

/// What a run says of energy that its method made out of nothing, if it made any.
pub(crate) fn energy_warning(run: &Run) -> Option<String> {
    let warnings = Warning::after(run, &Wording::default());
    let found = warnings
        .iter()
        .find(|warning| warning.code() == "W-SIM-ENERGY");
    found.map(ToString::to_string)
}

/// Plays a run until something tears, and returns the edge with the largest load.
pub(crate) fn torn_first(mut run: Run) -> (Run, HalfEdgeId) {
    loop {
        assert!(!run.is_over(), "nothing tore");
        let tear = run.step().expect("a step");
        if let Some((edge, _)) = tear.worst.filter(|_| tear.splits > 0) {
            return (run, edge);
        }
    }
}

/// By cells, scene and method.
type AllPlayed = BTreeMap<(u32, &'static str, &'static str), &'static OnceLock<Played>>;

/// A ready scene on a [`square`] after its end, by one of [`methods`]. It is played once, whoever reads
/// it.
pub(crate) fn played(cells: u32, scene: &'static str, method: &'static str) -> &'static Played {
    static PLAYED: Mutex<AllPlayed> = Mutex::new(BTreeMap::new());
    let once = {
        let mut played = PLAYED.lock().expect("nobody panics while they hold it");
        *played
            .entry((cells, scene, method))
            .or_insert_with(|| Box::leak(Box::default()))
    };
    once.get_or_init(|| {
        let ready = Scene::PRESETS.iter().find(|(name, _)| *name == scene);
        let (_, ready) = ready.expect("a scene");
        noted(staged(cells, |frame| Scene {
            solver: Method::named(method).expect("a method"),
            ..ready(frame)
        }))
    })
}

/// Every method that a scene can name, by its name.
pub(crate) fn methods() -> [(&'static str, Method); 5] {
    Method::NAMES.map(|name| (name, Method::named(name).expect("a method")))
}

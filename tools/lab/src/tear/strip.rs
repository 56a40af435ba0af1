//! Trouser tests of strips: the force that tears a strip, and its first tear by two methods.
//!
//! Up to the first tear a test has an answer, and after it a tear takes a way of its own. So up to there it is
//! done again by a method that shares no force code. Verlet sums up the forces of springs by their lengths. XPBD,
//! with two sweeps at the same step, projects positions and reads forces off its multipliers.

use tearmesh::{Mesh, Point, Positions, Vector};
use tearmesh_cloth::scene::{Axis, FRAME_S, Frame, Method, Run, Scene};
use tearmesh_cloth::{Tearing, Threshold, Xpbd, force};

/// The width and the height of the strip, in metres.
pub const STRIP_M: [f64; 2] = [0.1, 0.2];

/// The factor on the strength of the tips of a tear, as in
/// [`Tearing::weakening`](tearmesh_cloth::Tearing::weakening).
pub const TIP: f64 = 0.5;

/// The number of forces that are recorded in a test of four seconds, each a mean.
const SAMPLES: u64 = 240;

/// The sweeps of XPBD. One leaves edges several per cent too soft at Verlet's step.
const SWEEPS: u32 = 2;

/// What a trouser test measures.
#[derive(Clone, Debug)]
pub struct StripTest {
    /// The largest force between the clamps in newtons, as a mean over 1/60 s.
    pub(super) force_largest_n: f64,
    /// The mean force between the clamps from the first tear to the last, in newtons; 0 if nothing tore.
    pub(super) force_mean_n: f64,
    /// The first tears by two methods with two steps each. Runs that did not tear are left out.
    pub(super) first: Vec<FirstTear>,
    /// The distances between the clamps in metres and the forces in newtons, in the order of time.
    pub(super) curve: Vec<[f64; 2]>,
}

/// The first tear of a strip by one method at one step.
#[derive(Clone, Debug)]
pub(super) struct FirstTear {
    pub(super) method: &'static str,
    pub(super) dt_s: f64,
    /// The distance between the clamps, in metres.
    pub(super) displacement_m: f64,
    /// The force between the clamps in newtons, as a mean over the last 1/60 s before the tear.
    pub(super) force_n: f64,
}

/// Tears a strip of so many cells across. Returns `None` if it was interrupted.
pub(super) fn test(
    cells: u32,
    threshold: Threshold,
    stop: &dyn Fn() -> bool,
) -> Option<Result<StripTest, String>> {
    let (mesh, positions) = strip(cells);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let scene = Scene {
        tearing: Some(Tearing {
            weakening: Some(TIP),
            ..Tearing::new(threshold)
        }),
        ..Scene::trouser(&frame)
    };
    let pulled = |scene: &Scene| {
        let run = Run::new(mesh.clone(), &positions, scene.clone(), &frame);
        Pulled {
            run: run.expect("the trouser scene fits a strip"),
            depth: frame.depth.vector(),
        }
    };
    let mut first = Vec::new();
    let step_s = pulled(&scene).run.step_s();
    for (method, solver) in [
        ("verlet", Method::Verlet),
        ("xpbd", Method::Xpbd(Xpbd::new(1, SWEEPS))),
    ] {
        for dt_s in [step_s, step_s / 2.0] {
            let scene = Scene {
                solver: solver.clone(),
                step_s: Some(dt_s),
                ..scene.clone()
            };
            match first_tear(pulled(&scene), method, dt_s, stop)? {
                Ok(tear) => first.extend(tear),
                Err(why) => return Some(Err(why)),
            }
        }
    }
    let mut pulled = pulled(&scene);
    let every = (pulled.run.steps_planned() / SAMPLES).max(1);
    let (mut curve, mut forces) = (Vec::new(), Vec::new());
    // The steps of the first tear and of the last.
    let mut torn: Option<[usize; 2]> = None;
    while !pulled.run.is_over() {
        if stop() {
            return None;
        }
        let splits = pulled.run.tally().splits;
        match pulled.step() {
            Ok(force_n) => forces.push(force_n),
            Err(why) => return Some(Err(why)),
        }
        if pulled.run.tally().splits > splits {
            let last = forces.len();
            torn = Some([torn.map_or(last - 1, |[first, _]| first), last]);
        }
        if pulled.run.tally().steps.is_multiple_of(every) {
            let recent = &forces[forces.len() - every as usize..];
            curve.push([pulled.apart_m(), mean(recent)]);
        }
    }
    let tearing = torn.map_or(&forces[..0], |[first, last]| &forces[first..last]);
    Some(Ok(StripTest {
        force_largest_n: curve.iter().map(|[_, force]| *force).fold(0.0, f64::max),
        force_mean_n: mean(tearing),
        first,
        curve,
    }))
}

/// The first tear of a run; the inner `None` if nothing tears, and the outer one if it was interrupted.
fn first_tear(
    mut pulled: Pulled,
    method: &'static str,
    dt_s: f64,
    stop: &dyn Fn() -> bool,
) -> Option<Result<Option<FirstTear>, String>> {
    let mut forces = Vec::new();
    while !pulled.run.is_over() {
        if stop() {
            return None;
        }
        let force_n = match pulled.step() {
            Ok(force_n) => force_n,
            Err(why) => return Some(Err(why)),
        };
        if pulled.run.tally().splits > 0 {
            let count = (FRAME_S / dt_s) as usize;
            let recent = &forces[forces.len().saturating_sub(count)..];
            return Some(Ok(Some(FirstTear {
                method,
                dt_s,
                displacement_m: pulled.apart_m(),
                force_n: mean(recent),
            })));
        }
        forces.push(force_n);
    }
    Some(Ok(None))
}

/// A strip whose legs are pulled apart.
struct Pulled {
    run: Run,
    /// The direction in which the legs are pulled.
    depth: Vector,
}

impl Pulled {
    /// Takes a step, and returns the force between the clamps in newtons.
    fn step(&mut self) -> Result<f64, String> {
        self.run.step().map_err(|error| error.to_string())?;
        // Half the difference: the part that both clamps agree on.
        let [left, right] = [0, 1].map(|leg| {
            let system = self.run.cloth().system();
            let held = self.run.held(leg).iter();
            held.map(|v| force::reaction_n(system, v.index()).dot(&self.depth))
                .sum::<f64>()
        });
        Ok((left - right) / 2.0)
    }

    /// The distance between the clamps, in metres.
    fn apart_m(&self) -> f64 {
        let [left, right] = [0, 1].map(|leg| {
            let first = self.run.held(leg)[0];
            let at = self.run.cloth().positions()[first.index()];
            at.coords.dot(&self.depth)
        });
        left - right
    }
}

/// The mean of some forces; 0 of none.
fn mean(forces: &[f64]) -> f64 {
    forces.iter().sum::<f64>() / forces.len().max(1) as f64
}

/// A strip of square cells with alternating diagonals.
pub(super) fn strip(cells: u32) -> (Mesh, Positions) {
    let [width, height] = STRIP_M;
    let rows = (f64::from(cells) * height / width).round() as u32;
    let n = cells + 1;
    let points = (0..n * (rows + 1)).map(|i| {
        let x = f64::from(i % n) / f64::from(cells) * width;
        let y = f64::from(i / n) / f64::from(rows) * height;
        Point::new(x, y, 0.0)
    });
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..cells {
            let a = j * n + i;
            let (b, c, d) = (a + 1, a + n + 1, a + n);
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    let mesh = Mesh::build((n * (rows + 1)) as usize, &triangles);
    let positions = Positions::new(points);
    (
        mesh.expect("a strip is a manifold"),
        positions.expect("a strip's coordinates are finite"),
    )
}

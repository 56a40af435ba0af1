//! A step with a hundred splits in it beside one with none: of ours alone.

use tearmesh::{Edits, Mesh, VertexId, split};
use tearmesh_cloth::{Cloth, Method, Solver, frequency_bound};

use super::sheet::{STEP_S, hanging, methods};
use crate::measure::{median_of, timed_on_cpu};
use crate::options::Options;
use crate::table::{line, table};

const SPLITS: usize = 100;

/// What was measured in a round, in µs.
#[derive(Clone, Copy)]
struct Times {
    /// A step.
    none: f64,
    /// A hundred splits of the mesh.
    splits: f64,
    /// The cloth follows them.
    follow: f64,
    /// The step after.
    after: f64,
}

/// One line a method and size.
pub(super) fn run(options: &Options) -> String {
    let methods = methods(options);
    let mut lines = vec![line([
        "",
        "sheet",
        "none",
        "with splits",
        "ratio",
        "mesh",
        "cloth",
        "step after",
        "us a split",
    ])];
    for n in [64, 256] {
        let (mesh, cloth) = hanging(n);
        let all = rounds(&methods, &mesh, &cloth, options);
        for (method, times) in methods.iter().zip(all) {
            let of = |part: fn(&Times) -> f64| median_of(&times, part);
            let with = of(|times| times.splits + times.follow + times.after);
            let micros = |us: f64| format!("{us:.0}");
            lines.push(line([
                method.name(),
                &format!("{n} x {n}"),
                &micros(of(|times| times.none)),
                &micros(with),
                &format!("{:.2}", with / of(|times| times.none)),
                &micros(of(|times| times.splits)),
                &micros(of(|times| times.follow)),
                &micros(of(|times| times.after)),
                &format!(
                    "{:.2}",
                    of(|times| times.splits + times.follow) / SPLITS as f64
                ),
            ]));
        }
    }
    format!(
        "a step with {SPLITS} splits in it, us; CPU time of {} rounds\n{}",
        options.rounds,
        table(&lines)
    )
}

fn rounds(methods: &[Method], mesh: &Mesh, cloth: &Cloth, options: &Options) -> Vec<Vec<Times>> {
    let mut all = vec![Vec::new(); methods.len()];
    for _ in 0..options.rounds {
        for (method, times) in methods.iter().zip(&mut all) {
            let mut solver = method.solver();
            times.push(measured(&mut *solver, mesh.clone(), cloth.clone()));
        }
    }
    all
}

fn measured(solver: &mut dyn Solver, mut mesh: Mesh, mut cloth: Cloth) -> Times {
    let step_s = match solver.abilities().frequency_limit {
        // Splits may raise the bound.
        Some(limit) => 0.5 * limit / frequency_bound(cloth.system_mut()).omega_rad_per_s,
        None => STEP_S,
    };
    let inner = mesh.vertices().filter(|&v| {
        let is_held = cloth.system().is_held(v.index());
        !is_held && mesh.faces_of(v).count() == 6
    });
    let inner: Vec<VertexId> = inner.collect();
    // Two hundred, even over the sheet; every second of them is split before the clock runs, so
    // that arrays have grown.
    let stride = inner.len() / (2 * SPLITS);
    let chosen = inner.into_iter().step_by(stride).take(2 * SPLITS);
    let (before, later): (Vec<_>, Vec<_>) = chosen.enumerate().partition(|(i, _)| i % 2 == 0);
    let mut edits = Edits::new();
    split_all(&before, &mut mesh, &mut edits);
    edits.replay(&mut cloth);
    for _ in 0..5 {
        cloth.step(solver, step_s).expect("a step");
    }
    let (step, none) = timed_on_cpu(|| cloth.step(solver, step_s));
    step.expect("a step");
    edits.clear();
    let ((), splits) = timed_on_cpu(|| split_all(&later, &mut mesh, &mut edits));
    assert_eq!(edits.len(), SPLITS, "every vertex is split");
    let ((), follow) = timed_on_cpu(|| edits.replay(&mut cloth));
    let (step, after) = timed_on_cpu(|| cloth.step(solver, step_s));
    step.expect("a step");
    assert_eq!(cloth.indices(), mesh.indices(), "the cloth is in step");
    let [none, splits, follow, after] = [none, splits, follow, after].map(|seconds| seconds * 1e6);
    Times {
        none,
        splits,
        follow,
        after,
    }
}

/// Gives one face of each vertex to a copy of it.
fn split_all(vertices: &[(usize, VertexId)], mesh: &mut Mesh, edits: &mut Edits) {
    for &(_, v) in vertices {
        let face = mesh.faces_of(v).next().expect("it has faces");
        split::vertex(mesh, v, &[face], edits).expect("one of six faces");
    }
}

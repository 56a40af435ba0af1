//! The share of a step that looking for tears, the meter of energy and the statistics take, and that of
//! real time which the paper's rip takes: of ours alone.

use tearmesh::{Edits, Mesh, shapes};
use tearmesh_cloth::scene::{Axis, Frame, Run, Scene};
use tearmesh_cloth::{Cloth, Method, Solver, Tear, Tearing};

use super::sheet::methods;
use crate::measure::{median_of, timed_on_cpu};
use crate::options::Options;
use crate::table::{line, table};

/// Steps of one measurement.
const STEPS: u32 = 50;

/// A table of ratios, and one of real time.
pub(super) fn run(options: &Options) -> String {
    let methods = methods(options);
    let head = ["", "sheet", "step, us", "bare", "tearing", "never", "run"];
    let mut lines = vec![line(head)];
    for n in [64, 128] {
        lines.extend(methods.iter().map(|method| shares(method, n, options)));
    }
    let mut rips = vec![line(["", "sheet", "CPU s a second", ""])];
    rips.extend(methods.iter().map(|method| rip(method, options)));
    format!(
        "hang with nothing torn, times a bare step: with a look for tears, a run that never tears, one \
         that does; CPU time of {rounds} rounds\n{}\nrip (figure 6 of the paper), 3 s\n{}",
        table(&lines),
        table(&rips),
        rounds = options.rounds,
    )
}

/// What a method's step costs bare, and how many times that with what a run adds.
fn shares(method: &Method, n: u32, options: &Options) -> Vec<String> {
    let (mut tears, mut never) = (hang(method, n, true), hang(method, n, false));
    for run in [&mut tears, &mut never] {
        steps(run, 20);
    }
    let step_s = tears.step_s();
    let mut solver = method.solver();
    let times: Vec<[f64; 4]> = (0..options.rounds)
        .map(|_| {
            let mut cloth = tears.cloth().clone();
            let bare = timed(|| {
                for _ in 0..STEPS {
                    cloth.step(&mut *solver, step_s).expect("a step");
                }
            });
            let (cloth, mesh) = (tears.cloth().clone(), tears.mesh().clone());
            let mut torn = Torn::new(cloth, mesh);
            let tearing = timed(|| torn.steps(&mut *solver, step_s));
            [
                bare,
                tearing,
                timed(|| steps(&mut never, STEPS)),
                timed(|| steps(&mut tears, STEPS)),
            ]
        })
        .collect();
    assert_eq!(tears.tally().splits, 0, "nothing tears");
    let of = |part: usize| median_of(&times, |all| all[part]);
    let ratio = |part| format!("{:.2}", of(part) / of(0));
    line([
        method.name(),
        &format!("{n} x {n}"),
        &format!("{:.0}", step_s * 1e6),
        &format!("{:.0} us", of(0) / f64::from(STEPS) * 1e6),
        &ratio(1),
        &ratio(2),
        &ratio(3),
    ])
}

/// A cloth that is looked over for tears, without a run round it.
struct Torn {
    cloth: Cloth,
    mesh: Mesh,
    tear: Tear,
    edits: Edits,
}

impl Torn {
    fn new(cloth: Cloth, mesh: Mesh) -> Torn {
        let edits = Edits::starting_at(cloth.seen());
        let tear = Tear::new(&cloth, Tearing::default()).expect("the defaults tear");
        Torn {
            cloth,
            mesh,
            tear,
            edits,
        }
    }

    fn steps(&mut self, solver: &mut dyn Solver, step_s: f64) {
        for _ in 0..STEPS {
            self.cloth.step(solver, step_s).expect("a step");
            let (mesh, cloth) = (&mut self.mesh, &mut self.cloth);
            let report = self.tear.apply(mesh, cloth, &mut self.edits);
            assert_eq!(report.splits, 0, "nothing tears");
        }
    }
}

/// How long a rip takes by a method, for each second of it.
fn rip(method: &Method, options: &Options) -> Vec<String> {
    let n = 64;
    let times: Vec<f64> = (0..options.rounds.min(3))
        .map(|_| {
            let mut run = on_a_sheet(n, |frame| Scene {
                solver: method.clone(),
                ..Scene::rip(frame)
            });
            let taken = timed(|| {
                while !run.is_over() {
                    run.step().expect("a step");
                }
            });
            taken / run.elapsed_s()
        })
        .collect();
    let a_second = median_of(&times, |seconds| *seconds);
    line([
        method.name(),
        &format!("{n} x {n}"),
        &format!("{a_second:.2}"),
        "at most 1 is real time",
    ])
}

fn hang(method: &Method, n: u32, tears: bool) -> Run {
    on_a_sheet(n, |frame| Scene {
        solver: method.clone(),
        tearing: tears.then(Tearing::default),
        drag_per_s: 1.0,
        duration_s: 1e3,
        ..Scene::hang(frame)
    })
}

fn on_a_sheet(n: u32, scene: impl FnOnce(&Frame) -> Scene) -> Run {
    let (mesh, positions) = shapes::grid(n, n);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    Run::new(mesh, &positions, scene(&frame), &frame).expect("a scene of a sheet")
}

fn steps(run: &mut Run, count: u32) {
    for _ in 0..count {
        run.step().expect("a step");
    }
}

fn timed(job: impl FnOnce()) -> f64 {
    timed_on_cpu(job).1
}

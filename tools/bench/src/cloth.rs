//! `cloth`: a sheet that hangs by its upper edge, stepped beside Bullet's soft body; then what a
//! step costs as sheets grow, with splits in it, and with what a run adds to it.
//!
//! Both have the same net (the edges of the mesh), the same masses and held particles, gravity, and
//! steps of 1/60 s; neither has bending, drag or collisions. Bullet's body is stepped without a
//! world and without faces, so without normals: only what a hanging net needs.

mod bullet;
mod growth;
mod shares;
mod sheet;
mod splits;

use tearmesh_cloth::{Cloth, Pbd, Solver, Xpbd};
use tearmesh_lab::statistics::median;

use crate::measure::timed_on_cpu;
use crate::options::Options;
use crate::process::Program;
use crate::table::{line, table};
use bullet::{Bullet, Order};
use sheet::{Net, Run, STEP_S, hanging};

/// The contest on sheets of three sizes, and the tables of ours alone.
pub(crate) fn run(options: &Options) -> String {
    let program = bullet::compile();
    let mut parts: Vec<String> = [32, 64, 128]
        .into_iter()
        .map(|n| contest(n, &program, options))
        .collect();
    parts.extend([
        growth::run(&program, options),
        splits::run(options),
        shares::run(options),
    ]);
    parts.join("\n")
}

/// How many steps a run has: two seconds.
const STEPS: u32 = 120;

/// How many times the iterations a long run has, in fewer steps; from the difference comes the time
/// of a projection alone.
const LONGER: u32 = 11;

/// Who steps the sheet.
struct Contestant<'c> {
    name: &'static str,
    note: String,
    /// A run of ten iterations a step, times the first number, and of so many steps; `None` if it
    /// cannot be had.
    run: Option<Box<dyn Fn(u32, u32) -> Run + 'c>>,
}

/// What was measured of one.
#[derive(Default)]
struct Times {
    step_s: Vec<f64>,
    projection_s: Vec<f64>,
    strain: (f64, f64),
}

const BULLETS: [(&str, Order, &str); 3] = [
    (
        "bullet",
        Order::Mesh,
        "ten iterations, f32; links in the order of the mesh",
    ),
    (
        "bullet, reoptimised",
        Order::Reoptimised,
        "after its ReoptimizeLinkOrder",
    ),
    (
        "bullet, colours",
        Order::Colours,
        "links in the order of our colours",
    ),
];

/// What Bullet took elsewhere, in ms a step of 32², 64² and 128² particles.
const QUOTED_MS: [(u32, f64); 3] = [(32, 0.37), (64, 1.63), (128, 7.23)];

fn contest(n: u32, program: &Result<Program, String>, options: &Options) -> String {
    let (_, cloth) = hanging(n);
    let system = cloth.system();
    let net = Net::new(system);
    let ours = [
        ours("xpbd", "ten substeps of one sweep, f64", &cloth, |longer| {
            Xpbd::new(10, longer)
        }),
        ours("pbd", "ten sweeps, f64", &cloth, |longer| {
            Pbd::new(10 * longer)
        }),
    ];
    let theirs = BULLETS.map(|(name, order, note)| {
        let started = match program {
            Ok(program) => Bullet::start(program, system, order).map_err(|e| e.to_string()),
            Err(why) => Err(why.clone()),
        };
        match started {
            Ok(bullet) => Contestant {
                name,
                note: format!("{}: {note}", bullet.version()),
                run: Some(Box::new(move |longer, steps| {
                    bullet.run(10 * longer, steps)
                })),
            },
            Err(why) => Contestant {
                name,
                note: missing(&why, n),
                run: None,
            },
        }
    });
    let contestants: Vec<Contestant<'_>> = ours.into_iter().chain(theirs).collect();
    let times = rounds(&contestants, &net, options);
    format!(
        "{n} x {n} particles, {} constraints, {STEPS} steps of 1/60 s from rest; CPU time of {} rounds\n{}",
        net.len(),
        options.rounds,
        tabulated(&contestants, &times)
    )
}

fn ours<'c, S: Solver>(
    name: &'static str,
    note: &str,
    cloth: &'c Cloth,
    solver: impl Fn(u32) -> S + 'c,
) -> Contestant<'c> {
    let run = move |longer, steps| {
        let (mut cloth, mut solver) = (cloth.clone(), solver(longer));
        let before = cloth.system().counters().visits.project;
        let ((), seconds) = timed_on_cpu(|| {
            for _ in 0..steps {
                cloth.step(&mut solver, STEP_S).expect("a step");
            }
        });
        Run {
            seconds,
            projections: cloth.system().counters().visits.project - before,
            positions: cloth.positions().to_vec(),
        }
    };
    Contestant {
        name,
        note: note.to_owned(),
        run: Some(Box::new(run)),
    }
}

fn missing(why: &str, n: u32) -> String {
    let quoted = QUOTED_MS.iter().find(|&&(size, _)| size == n);
    let quoted = quoted.map(|(_, ms)| format!("; {ms} ms on another machine"));
    format!("{why}{}", quoted.unwrap_or_default())
}

/// Lets all who are picked step the sheet, each once a round: a run, and one of more iterations.
fn rounds(contestants: &[Contestant<'_>], net: &Net, options: &Options) -> Vec<Times> {
    let names: Vec<&str> = contestants.iter().map(|c| c.name).collect();
    let mut all: Vec<Times> = contestants.iter().map(|_| Times::default()).collect();
    for _ in 0..options.rounds {
        for (contestant, times) in contestants.iter().zip(&mut all) {
            let Some(run) = &contestant.run else { continue };
            if !options.picks(contestant.name, &names) {
                continue;
            }
            let steps = STEPS / LONGER;
            let (short, long) = (run(1, STEPS), run(LONGER, steps));
            let step_s = short.seconds / f64::from(STEPS);
            let a_step = |run: &Run, steps: u32| run.projections as f64 / f64::from(steps);
            let more = a_step(&long, steps) - a_step(&short, STEPS);
            times.step_s.push(step_s);
            let longer_s = long.seconds / f64::from(steps) - step_s;
            times.projection_s.push(longer_s / more);
            times.strain = net.strain(&short.positions);
        }
    }
    all
}

fn tabulated(contestants: &[Contestant<'_>], all: &[Times]) -> String {
    let bullet = contestants.iter().position(|c| c.name == BULLETS[0].0);
    let bullet = &all[bullet.expect("it is named")];
    let part = |s: Option<f64>, of: Option<f64>| {
        let part = s.zip(of).map(|(s, of)| format!("{:.2}", s / of));
        part.unwrap_or_default()
    };
    let mut lines = vec![line([
        "",
        "step ms",
        "of bullet",
        "projection ns",
        "of bullet",
        "rms strain",
        "longest",
        "",
    ])];
    for (contestant, times) in contestants.iter().zip(all) {
        let name = contestant.name;
        let [step, projection] = [&times.step_s, &times.projection_s].map(|s| median(s.clone()));
        let Some((step_s, projection_s)) = step.zip(projection) else {
            if contestant.run.is_none() {
                lines.push(line([name, "", "", "", "", "", "", &contestant.note]));
            }
            continue;
        };
        let (rms, longest) = times.strain;
        lines.push(line([
            name,
            &format!("{:.3}", step_s * 1e3),
            &part(step, median(bullet.step_s.clone())),
            &format!("{:.2}", projection_s * 1e9),
            &part(projection, median(bullet.projection_s.clone())),
            &format!("{rms:.4}"),
            &format!("{longest:.3}"),
            &contestant.note,
        ]));
    }
    table(&lines)
}

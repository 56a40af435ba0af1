//! The cost of a step for each edge of the mesh, as sheets grow: of springs along edges, each a constraint,
//! and of triangles in their place.

use tearmesh_cloth::implicit::Settings;
use tearmesh_cloth::{Cloth, Implicit, Pbd, Solver, Verlet, Xpbd, frequency_bound};

use super::bullet::{Bullet, Order};
use super::sheet::{STEP_S, hanging, woven};
use crate::measure::{median_of, timed_on_cpu};
use crate::options::Options;
use crate::process::Program;
use crate::table::{line, table};

/// Vertices a side: about a thousand constraints, ten thousand, a hundred thousand and a million.
const SIDES: [u32; 4] = [19, 59, 183, 579];

/// About how many projections (or what takes as long) a measurement has, at least one step.
const PROJECTIONS: usize = 30_000_000;

/// How long a step is.
#[derive(Clone, Copy)]
enum Step {
    /// 1/60 s.
    Frame,
    /// So many times the largest step at which an explicit method is surely stable.
    Bound(f64),
}

/// What resists stretch.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Elements {
    Springs,
    Triangles,
}

struct Method {
    name: &'static str,
    elements: Elements,
    solver: fn() -> Box<dyn Solver>,
    step: Step,
    /// About how many projections a step takes as long as.
    weight: usize,
    note: &'static str,
}

const METHODS: [Method; 6] = [
    Method {
        name: "verlet",
        elements: Elements::Springs,
        solver: || Box::new(Verlet),
        step: Step::Bound(0.9),
        weight: 2,
        note: "a step of 0.9 of the bound of stability",
    },
    Method {
        name: "xpbd",
        elements: Elements::Springs,
        solver: || Box::new(Xpbd::new(10, 1)),
        step: Step::Frame,
        weight: 10,
        note: "ten substeps of one sweep, 1/60 s",
    },
    Method {
        name: "pbd",
        elements: Elements::Springs,
        solver: || Box::new(Pbd::new(10)),
        step: Step::Frame,
        weight: 10,
        note: "ten sweeps, 1/60 s",
    },
    Method {
        name: "implicit",
        elements: Elements::Springs,
        solver: || Box::new(Implicit::new(Settings::default())),
        step: Step::Bound(10.0),
        weight: 200,
        note: "backward Euler, ten times the bound",
    },
    Method {
        name: "verlet, triangles",
        elements: Elements::Triangles,
        solver: || Box::new(Verlet),
        step: Step::Bound(0.9),
        weight: 6,
        note: "a step of 0.9 of the bound of stability",
    },
    Method {
        name: "implicit, triangles",
        elements: Elements::Triangles,
        solver: || Box::new(Implicit::new(Settings::default())),
        step: Step::Bound(10.0),
        weight: 400,
        note: "backward Euler, ten times the bound",
    },
];

/// One line a method: nanoseconds an edge and step.
pub(super) fn run(program: &Result<Program, String>, options: &Options) -> String {
    let cloths = SIDES.map(|n| hanging(n).1);
    let counts = cloths.each_ref().map(constraints);
    let woven = SIDES.map(|n| woven(n).1);
    let mut head = vec![String::new()];
    head.extend(counts.map(|count| count.to_string()));
    head.extend(line(["last / first", ""]));
    let mut lines = vec![head];

    let names: Vec<&str> = METHODS.iter().map(|method| method.name).collect();
    let names = [names, vec!["bullet"]].concat();
    for method in &METHODS {
        if options.picks(method.name, &names) {
            let measured = SIDES.map(|_| Vec::new());
            let cloths = match method.elements {
                Elements::Springs => &cloths,
                Elements::Triangles => &woven,
            };
            let measured = rounds(measured, options, |i| {
                nanoseconds(method, &cloths[i], counts[i])
            });
            lines.push(row(method.name, measured.map(|all| all.0), method.note));
            if method.name.starts_with("implicit") {
                let products = measured.map(|all| all.1);
                lines.push(row("", products, "the same a matrix product"));
            }
        }
    }
    if let Ok(program) = program
        && options.picks("bullet", &names)
    {
        let start = |cloth| Bullet::start(program, cloth, Order::Mesh).expect("it did before");
        let bullets = cloths.each_ref().map(|cloth| start(cloth.system()));
        let measured = SIDES.map(|_| Vec::new());
        let measured = rounds(measured, options, |i| {
            let steps = steps(counts[i], 10);
            let seconds = bullets[i].run(10, steps as u32).seconds;
            (seconds * 1e9 / (counts[i] * steps) as f64, 0.0)
        });
        let note = "ten iterations, 1/60 s, in the order of the mesh";
        lines.push(row("bullet", measured.map(|all| all.0), note));
    }
    format!(
        "ns an edge and step, as sheets grow; CPU time of {} rounds\n{}",
        options.rounds,
        table(&lines)
    )
}

/// The medians of two numbers that are measured of every sheet.
fn rounds(
    mut all: [Vec<(f64, f64)>; SIDES.len()],
    options: &Options,
    measure: impl Fn(usize) -> (f64, f64),
) -> [(f64, f64); SIDES.len()] {
    for _ in 0..options.rounds {
        for (i, measured) in all.iter_mut().enumerate() {
            measured.push(measure(i));
        }
    }
    all.map(|measured| {
        let of = |part: fn(&(f64, f64)) -> f64| median_of(&measured, part);
        (of(|both| both.0), of(|both| both.1))
    })
}

fn row(name: &str, medians: [f64; SIDES.len()], note: &str) -> Vec<String> {
    let [first, .., last] = medians;
    let mut cells = line([name]);
    cells.extend(medians.map(|ns| format!("{ns:.1}")));
    cells.push(format!("{:.2}", last / first));
    cells.push(note.to_owned());
    cells
}

fn constraints(cloth: &Cloth) -> usize {
    cloth.system().stretches().len()
}

fn steps(edges: usize, weight: usize) -> usize {
    (PROJECTIONS / (edges * weight)).max(1)
}

/// How long a step takes for each edge of the mesh, and each of its matrix products.
fn nanoseconds(method: &Method, cloth: &Cloth, edges: usize) -> (f64, f64) {
    let (mut cloth, mut solver) = (cloth.clone(), (method.solver)());
    let step_s = match method.step {
        Step::Frame => STEP_S,
        Step::Bound(times) => times * 2.0 / frequency_bound(cloth.system_mut()).omega_rad_per_s,
    };
    // The first steps make room.
    for _ in 0..2 {
        cloth.step(&mut *solver, step_s).expect("a step");
    }
    let steps = steps(edges, method.weight);
    let before = cloth.system().counters().matrix_products;
    let ((), seconds) = timed_on_cpu(|| {
        for _ in 0..steps {
            cloth.step(&mut *solver, step_s).expect("a step");
        }
    });
    let products = cloth.system().counters().matrix_products - before;
    let an_edge = seconds * 1e9 / edges as f64;
    (an_edge / steps as f64, an_edge / products as f64)
}

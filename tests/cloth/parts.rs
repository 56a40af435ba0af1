//! The parts of the tests of cloth: systems, cloths and scenes, loads, and comparisons. There is
//! no test here, and no test takes its parts from another one's file, but for what must hold of a cloth
//! after any edit (`follow::check`).

pub(crate) mod cloths;
pub(crate) mod nets;
pub(crate) mod scenes;
pub(crate) mod vibration;
pub(crate) mod woven;

use tearmesh::geometry::length;
use tearmesh::{Plane, Point, Vector, VertexId};
use tearmesh_cloth::implicit::{Method, Settings, Stats};
use tearmesh_cloth::{
    Balance, Collider, ConstraintId, Implicit, Loads, Path, Pbd, Provot, Quality, Solver, System,
    Unstable, Verlet, Wind, Xpbd, energy,
};

use crate::plain_verlet::PlainVerlet;
use crate::random::Random;
use crate::rk4::Rk4;
pub(crate) use crate::support::fixtures::ray;

/// The acceleration of gravity, in m/s².
pub(crate) const G: f64 = 9.81;

/// A value is an answer to within an absolute tolerance, all in one unit.
///
/// # Panics
///
/// If it is not, or is no number; in the place of the caller.
#[track_caller]
pub(crate) fn near(value: f64, answer: f64, tolerance: f64) {
    assert!(
        (value - answer).abs() <= tolerance,
        "{value} is not {answer}, off by {:e}",
        value - answer
    );
}

/// Gravity down the z axis, and drag in 1/s; none at all if that is 0.
pub(crate) fn gravity(drag_per_s: f64) -> Loads {
    pulled(Vector::new(0.0, 0.0, -G), drag_per_s)
}

/// Gravity down the y axis, as for a sheet that hangs in its own plane, and drag in 1/s; none at all
/// if that is 0.
pub(crate) fn gravity_along_y(drag_per_s: f64) -> Loads {
    pulled(Vector::y() * -G, drag_per_s)
}

/// These loads, and wind.
pub(crate) fn blown(velocity_m_per_s: Vector, coefficient: f64, loads: Loads) -> Loads {
    let wind = Some(Wind {
        velocity_m_per_s,
        coefficient,
    });
    Loads { wind, ..loads }
}

/// These loads, and a body in the way.
pub(crate) fn onto(collider: Collider, loads: &Loads) -> Loads {
    let colliders = vec![collider];
    Loads {
        colliders,
        ..*loads
    }
}

/// This gravity, and drag in 1/s; none at all if that is 0.
pub(crate) fn pulled(gravity_m_per_s2: Vector, drag_per_s: f64) -> Loads {
    Loads {
        gravity_m_per_s2: Some(gravity_m_per_s2),
        drag_per_s: (drag_per_s > 0.0).then_some(drag_per_s),
        ..Loads::default()
    }
}

/// Takes `steps` steps, also beyond the bound that the guard of explicit methods goes by.
///
/// # Panics
///
/// If a step fails.
pub(crate) fn run(system: &mut System, mut solver: impl Solver, dt_s: f64, steps: usize) {
    run_with(system, &mut solver, dt_s, steps);
}

/// Takes them by a solver that goes on to be used.
///
/// # Panics
///
/// If a step fails.
pub(crate) fn run_with(system: &mut System, solver: &mut dyn Solver, dt_s: f64, steps: usize) {
    system.when_unstable(Unstable::Allow);
    take(system, solver, dt_s, steps);
}

/// Takes them as they are divided or refused.
///
/// # Panics
///
/// If a step fails.
pub(crate) fn take(system: &mut System, solver: &mut dyn Solver, dt_s: f64, steps: usize) {
    for _ in 0..steps {
        system.step(solver, dt_s).expect("a stable step");
    }
}

/// Takes steps that a balance observes.
///
/// # Panics
///
/// If a step fails.
pub(crate) fn take_observed(
    (system, balance): (&mut System, &mut Balance),
    solver: &mut dyn Solver,
    dt_s: f64,
    steps: usize,
) {
    for _ in 0..steps {
        let taken = system.step_observed(solver, dt_s, Some(&mut *balance));
        taken.expect("a stable step");
    }
}

/// Moves all particles by up to half of `by_m` along each axis, and pushes them by up to half of
/// `by_m_per_s`.
pub(crate) fn shake(system: &mut System, by_m: f64, by_m_per_s: f64, random: &mut Random) {
    let mut any = || Vector::from_fn(|_, _| random.next() - 0.5);
    let (points, velocities) = system.state_mut();
    for (x, v) in points.iter_mut().zip(velocities) {
        *x += any() * by_m;
        *v += any() * by_m_per_s;
    }
}

/// The largest ratio of a length to its rest length.
pub(crate) fn longest(system: &System) -> f64 {
    let ids = system.stretches().iter();
    ids.map(|id| system.stretch_ratio(id)).fold(0.0, f64::max)
}

/// The largest speed of a particle, in m/s.
pub(crate) fn fastest(system: &System) -> f64 {
    let speeds = system.velocities().iter().map(|v| v.norm());
    speeds.fold(0.0, f64::max)
}

/// The root of a growing function between two numbers.
pub(crate) fn bisect(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// In which order the constraints are added, and so stored and swept.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Order {
    Mesh,
    Reversed,
    Shuffled,
}

pub(crate) const ORDERS: [Order; 3] = [Order::Mesh, Order::Reversed, Order::Shuffled];

impl Order {
    pub(crate) fn apply<T>(self, list: &mut [T]) {
        match self {
            Order::Mesh => {}
            Order::Reversed => list.reverse(),
            Order::Shuffled => Random(5).shuffle(list),
        }
    }
}

/// The order at which errors fall where a step is halved.
pub(crate) fn order([coarse, fine]: [f64; 2]) -> f64 {
    (coarse / fine).log2()
}

/// The passes of Provot's limiter in all steps so far, and the steps in which it shortened an edge.
pub(crate) fn limited(provot: &Provot, system: &System) -> [u64; 2] {
    match provot.quality(system) {
        Quality::Limiter {
            passes,
            steps_limited,
            ..
        } => [passes, steps_limited],
        _ => unreachable!("Provot's model tells what its limiter did"),
    }
}

/// What an implicit method did in all steps so far.
pub(crate) fn solved(solver: &Implicit, system: &System) -> Stats {
    match solver.quality(system) {
        Quality::Implicit(stats) => stats,
        _ => unreachable!("an implicit method tells what it did"),
    }
}

/// The force of a spring by its length, in newtons.
pub(crate) fn tension_n(system: &System, id: ConstraintId) -> f64 {
    let spring = system.stretches().get(id);
    let [a, b] = spring.ends.map(|end| system.positions()[end]);
    spring.stiffness_n_per_m * (length(b - a) - spring.rest_length_m)
}

/// Positions and velocities.
pub(crate) fn state(system: &System) -> (Vec<Point>, Vec<Vector>) {
    (system.positions().to_vec(), system.velocities().to_vec())
}

/// Particles of one mass.
pub(crate) fn particles<const N: usize>(points: [[f64; 3]; N], mass_kg: f64) -> System {
    System::new(points.map(Point::from), vec![mass_kg; N]).expect("particles")
}

/// Particles along x at these places, of one mass.
pub(crate) fn on_a_line<const N: usize>(places: [f64; N], mass_kg: f64) -> System {
    particles(places.map(|x| [x, 0.0, 0.0]), mass_kg)
}

/// A straight way between points at times in seconds.
pub(crate) fn path<const N: usize>(points: [(f64, [f64; 3]); N]) -> Path {
    Path::new(points.map(|(t_s, at)| (t_s, Point::from(at)))).expect("a path")
}

/// The vertex of this number.
pub(crate) fn v(index: usize) -> VertexId {
    VertexId::new(index).expect("an id")
}

/// The plane through a point, with a normal.
pub(crate) fn plane(at: impl Into<Point>, normal: Vector) -> Plane {
    Plane::new(at.into(), normal).expect("a plane")
}

/// The elastic and the kinetic energy, in joules.
pub(crate) fn mechanical_j(system: &System) -> f64 {
    energy::elastic_j(system) + energy::kinetic_j(system)
}

/// The implicit solver, with each linear equation solved to about rounding.
pub(crate) fn implicit(method: Method) -> Implicit {
    implicit_to(method, 1e-9)
}

/// The implicit solver, with each linear equation solved to so many m/s per s³.
pub(crate) fn implicit_to(method: Method, tolerance: f64) -> Implicit {
    Implicit::new(Settings {
        method,
        tolerance,
        ..Settings::default()
    })
}

/// The implicit solver, with the tolerance that users have unless they choose another.
pub(crate) fn implicit_by_default(method: Method) -> Implicit {
    implicit_to(method, Settings::default().tolerance)
}

/// Every method by its name, and Provot's with its limiter at last.
pub(crate) const METHODS: [&str; 9] = [
    "guarded", "Provot", "Verlet", "RK4", "Euler", "BDF2", "XPBD", "PBD", "limited",
];

/// A method by its name: Verlet with its guards and without, sweeps for those that sweep, equations solved
/// to rounding for those that are implicit.
pub(crate) fn method(name: &str, sweeps: u32) -> Box<dyn Solver> {
    match name {
        "guarded" => Box::new(Verlet),
        "Provot" => Box::new(Provot::unlimited()),
        "limited" => Box::new(Provot::default()),
        "Verlet" => Box::new(PlainVerlet::new()),
        "RK4" => Box::new(Rk4::new()),
        "Euler" => Box::new(implicit(Method::BackwardEuler)),
        "BDF2" => Box::new(implicit(Method::Bdf2)),
        "XPBD" => Box::new(Xpbd::new(1, sweeps)),
        "PBD" => Box::new(Pbd::new(sweeps)),
        other => panic!("no method is called {other}"),
    }
}

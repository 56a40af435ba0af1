//! What the tests of cloth are made of: systems, cloths and scenes, loads, and comparisons. There is
//! no test here, and no test takes its parts from another one's file.

pub(crate) mod cloths;
pub(crate) mod nets;
pub(crate) mod scenes;
pub(crate) mod vibration;
pub(crate) mod woven;

use tearmesh::geometry::length;
use tearmesh::{Plane, Point, Ray, Vector, VertexId};
use tearmesh_cloth::implicit::{Method, Settings, Stats};
use tearmesh_cloth::{
    ConstraintId, Implicit, LimiterStats, Loads, Path, Pbd, Provot, Quality, Solver, System,
    Unstable, Verlet, Xpbd, energy,
};

use crate::plain_verlet::PlainVerlet;
use crate::rk4::Rk4;

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
    pulled(Vector::new(0.0, -G, 0.0), drag_per_s)
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
    system.when_unstable(Unstable::Allow);
    for _ in 0..steps {
        system.step(&mut solver, dt_s).expect("a stable step");
    }
}

/// What Provot's limiter did in all steps so far.
pub(crate) fn limited(provot: &Provot, system: &System) -> LimiterStats {
    match provot.quality(system) {
        Quality::Limiter(stats) => stats,
        _ => LimiterStats::default(),
    }
}

/// What an implicit method did in all steps so far.
pub(crate) fn solved(solver: &Implicit, system: &System) -> Stats {
    match solver.quality(system) {
        Quality::Implicit(stats) => stats,
        _ => unreachable!("an implicit method tells what it did"),
    }
}

/// How far the forces that XPBD used are from those that the springs have now, in newtons.
pub(crate) fn residual_n(xpbd: Xpbd, system: &System) -> f64 {
    match xpbd.quality(system) {
        Quality::Residual(newtons) => newtons,
        _ => unreachable!("XPBD tells its residual"),
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

/// Looks down at a place of a sheet in the plane z = 0.
pub(crate) fn ray(x: f64, y: f64) -> Ray {
    Ray::new(Point::new(x, y, 5.0), -Vector::z()).expect("a ray")
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

/// A method by name.
pub(crate) type NamedMethod = (&'static str, fn() -> Box<dyn Solver>);

/// Every method.
pub(crate) const METHODS: [NamedMethod; 8] = [
    ("Verlet", || Box::new(Verlet::new())),
    ("plain Verlet", || Box::new(PlainVerlet::new())),
    ("RK4", || Box::new(Rk4::new())),
    ("Provot", || Box::new(Provot::default())),
    ("Provot without a limiter", || Box::new(Provot::unlimited())),
    ("PBD", || Box::new(Pbd::default())),
    ("XPBD", || Box::new(Xpbd::default())),
    ("implicit", || Box::new(Implicit::default())),
];

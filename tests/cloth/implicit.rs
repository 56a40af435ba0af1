//! The implicit solver against closed forms, finite differences and naive dense code.

mod dense;
mod history;
mod kernels;
mod matrix;
mod reports;
mod tolerance;

use tearmesh::{Point, Vector, VertexId, shapes};
use tearmesh_cloth::implicit::{self, Stats};
use tearmesh_cloth::{Buckling, Implicit, StepError, System, force};

use crate::parts::{G, pulled, solved};

/// The ends of a spring, or of a bend, its rest length, and its stiffness, of a bend against compression.
pub(crate) type Spring = ([usize; 2], f64, f64);

/// The corners of a triangle, their places in the material, and its stiffness.
pub(crate) type Triangle = ([usize; 3], [[f64; 2]; 3], [f64; 3]);

/// Everything that a system is made of.
#[derive(Clone, Default)]
pub(crate) struct Scene {
    pub(crate) x: Vec<Point>,
    pub(crate) v: Vec<Vector>,
    pub(crate) masses: Vec<f64>,
    pub(crate) held: Vec<bool>,
    pub(crate) gravity: Vector,
    pub(crate) springs: Vec<Spring>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) bends: Vec<Spring>,
    pub(crate) law: Option<Buckling>,
    pub(crate) drag: f64,
}

impl Scene {
    pub(crate) fn system(&self) -> System {
        let points = self.x.iter().copied();
        let mut system = System::new(points, self.masses.clone()).expect("particles");
        for &(ends, rest_m, stiffness) in &self.springs {
            system.stretch(ends, rest_m, stiffness).expect("a spring");
        }
        for &(ends, rest_m, stiffness) in &self.bends {
            system.bend(ends, rest_m, stiffness).expect("a bend");
        }
        system.set_buckling(self.law);
        for &(corners, material, stiffness) in &self.triangles {
            system.triangle(corners, material, stiffness).expect("area");
        }
        let held = (0..self.held.len()).filter(|&i| self.held[i]);
        held.for_each(|i| system.hold(i));
        system.state_mut().1.copy_from_slice(&self.v);
        system
            .set_loads(pulled(self.gravity, self.drag))
            .expect("loads");
        system
    }

    /// Free particles at rest, without gravity.
    pub(crate) fn particles(points: impl IntoIterator<Item = [f64; 3]>, mass: f64) -> Scene {
        let x: Vec<Point> = points.into_iter().map(Point::from).collect();
        let n = x.len();
        Scene {
            x,
            v: vec![Vector::zeros(); n],
            masses: vec![mass; n],
            held: vec![false; n],
            ..Scene::default()
        }
    }

    /// The unit square in n × n cells of two triangles, whose diagonals rise; the triangles
    /// resist stretch and shear, nothing is held.
    pub(crate) fn sheet(n: u32, mass: f64, stiffness: [f64; 3]) -> Scene {
        let (mesh, positions) = shapes::grid(n, n);
        let points = positions.as_slice();
        let mut scene = Scene::particles(points.iter().map(|&p| p.into()), mass);
        for f in mesh.faces() {
            let corners = mesh.face_vertices(f).map(VertexId::index);
            let material = corners.map(|v| [points[v].x, points[v].y]);
            scene.triangles.push((corners, material, stiffness));
        }
        scene
    }
}

/// Takes a step, and says what the method did in it.
pub(crate) fn step(
    system: &mut System,
    solver: &mut Implicit,
    dt_s: f64,
) -> Result<Stats, implicit::StepError> {
    let before = solved(solver, system);
    match system.step(solver, dt_s) {
        Ok(_) => Ok(since(solved(solver, system), before)),
        Err(StepError::Implicit { error, .. }) => Err(error),
        Err(other) => panic!("{other}"),
    }
}

/// What was counted since.
fn since(now: Stats, before: Stats) -> Stats {
    Stats {
        parts: now.parts - before.parts,
        first_order_parts: now.first_order_parts - before.first_order_parts,
        indefinite: now.indefinite - before.indefinite,
        clamped: now.clamped - before.clamped,
        solver_iterations: now.solver_iterations - before.solver_iterations,
        ..now
    }
}

/// The forces on all particles that are not held, in newtons; without drag.
pub(crate) fn forces(system: &mut System) -> Vec<Vector> {
    let mut forces = Vec::new();
    force::accelerations(system, &mut forces);
    let forces = forces.iter().zip(system.masses());
    forces.map(|(a, m)| a * *m).collect()
}

/// The 2-norm of all components.
pub(crate) fn norm(v: &[Vector]) -> f64 {
    v.iter().map(|v| v.dot(v)).sum::<f64>().sqrt()
}

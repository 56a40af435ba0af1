//! The implicit solver against closed forms, finite differences and naive dense code.

mod dense;
mod history;
mod kernels;
mod matrix;
mod orders;
mod reports;
mod tolerance;

use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit::{self, Stats};
use tearmesh_cloth::{Buckling, Implicit, Loads, StepError, System, force};

use crate::parts::{G, solved};

/// A spring, or a bend with its stiffness against compression.
#[derive(Clone, Copy)]
pub(crate) struct Spring {
    pub(crate) ends: [usize; 2],
    pub(crate) rest_length: f64,
    pub(crate) stiffness: f64,
}

pub(crate) fn spring(a: usize, b: usize, rest_length: f64, stiffness: f64) -> Spring {
    Spring {
        ends: [a, b],
        rest_length,
        stiffness,
    }
}

/// A triangle with its corners' places in the material.
#[derive(Clone, Copy)]
pub(crate) struct Triangle {
    pub(crate) corners: [usize; 3],
    pub(crate) material: [[f64; 2]; 3],
    pub(crate) stiffness: [f64; 3],
}

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
        for s in &self.springs {
            let added = system.stretch(s.ends, s.rest_length, s.stiffness);
            added.expect("a spring");
        }
        for b in &self.bends {
            let added = system.bend(b.ends, b.rest_length, b.stiffness);
            added.expect("a bend");
        }
        system.set_buckling(self.law);
        for t in &self.triangles {
            let added = system.triangle(t.corners, t.material, t.stiffness);
            added.expect("it has area");
        }
        let held = (0..self.held.len()).filter(|&i| self.held[i]);
        held.for_each(|i| system.hold(i));
        system.state_mut().1.copy_from_slice(&self.v);
        let loads = Loads {
            gravity_m_per_s2: Some(self.gravity),
            drag_per_s: Some(self.drag),
            ..Loads::default()
        };
        system.set_loads(loads).expect("loads");
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

    /// A row of particles along z, downwards, joined by springs; the first is held.
    pub(crate) fn chain(links: usize, mass: f64, stiffness: f64, rest_length: f64) -> Scene {
        let points = (0..=links).map(|i| [0.0, 0.0, -rest_length * i as f64]);
        let mut scene = Scene::particles(points, mass);
        scene.held[0] = true;
        scene.springs = (0..links)
            .map(|i| spring(i, i + 1, rest_length, stiffness))
            .collect();
        scene.gravity = Vector::new(0.0, 0.0, -G);
        scene
    }

    /// The unit square in n × n cells of two triangles, whose diagonals rise; the triangles
    /// resist stretch and shear, nothing is held.
    pub(crate) fn sheet(n: u32, mass: f64, stiffness: [f64; 3]) -> Scene {
        let size = f64::from(n);
        let points: Vec<[f64; 3]> = (0..(n + 1) * (n + 1))
            .map(|i| {
                [
                    f64::from(i % (n + 1)) / size,
                    f64::from(i / (n + 1)) / size,
                    0.0,
                ]
            })
            .collect();
        let mut scene = Scene::particles(points.iter().copied(), mass);
        for cell in 0..n * n {
            let a = (cell / n * (n + 1) + cell % n) as usize;
            let (b, c, d) = (a + 1, a + n as usize + 1, a + n as usize + 2);
            for corners in [[a, b, d], [a, d, c]] {
                scene.triangles.push(Triangle {
                    corners,
                    material: corners.map(|v| [points[v][0], points[v][1]]),
                    stiffness,
                });
            }
        }
        scene
    }

    /// Indices of the rim of a sheet.
    pub(crate) fn rim(n: u32) -> impl Iterator<Item = usize> {
        (0..(n + 1) * (n + 1))
            .filter(move |i| (i % (n + 1)).is_multiple_of(n) || (i / (n + 1)).is_multiple_of(n))
            .map(|i| i as usize)
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

//! The implicit solver against closed forms, finite differences and naive dense code.

mod dense;
mod kernels;
mod matrix;
mod orders;
mod references;
mod reports;
mod rest;

use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit::{Filter, Spring, Triangle};

pub(crate) const G: f64 = 9.81;

pub(crate) fn spring(a: u32, b: u32, rest_length: f64, stiffness: f64) -> Spring {
    Spring {
        ends: [a, b],
        rest_length,
        stiffness,
        tension_only: false,
    }
}

/// Everything a model borrows.
#[derive(Clone, Default)]
pub(crate) struct Scene {
    pub(crate) x: Vec<Point>,
    pub(crate) v: Vec<Vector>,
    pub(crate) masses: Vec<f64>,
    pub(crate) filters: Vec<Filter>,
    pub(crate) accelerations: Vec<Vector>,
    pub(crate) springs: Vec<Spring>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) bends: Vec<tearmesh_cloth::implicit::Bend>,
    pub(crate) drag: f64,
}

impl Scene {
    pub(crate) fn model(&self) -> tearmesh_cloth::implicit::Model<'_> {
        tearmesh_cloth::implicit::Model {
            masses: &self.masses,
            filters: &self.filters,
            accelerations: &self.accelerations,
            springs: &self.springs,
            triangles: &self.triangles,
            bends: &self.bends,
            drag_per_s: self.drag,
        }
    }

    /// Free particles at rest, without gravity.
    pub(crate) fn particles(points: impl IntoIterator<Item = [f64; 3]>, mass: f64) -> Scene {
        let x: Vec<Point> = points.into_iter().map(Point::from).collect();
        let n = x.len();
        Scene {
            x,
            v: vec![Vector::zeros(); n],
            masses: vec![mass; n],
            filters: vec![Filter::Free; n],
            accelerations: vec![Vector::zeros(); n],
            ..Scene::default()
        }
    }

    /// A row of particles along z, downwards, joined by springs; the first is held.
    pub(crate) fn chain(links: u32, mass: f64, stiffness: f64, rest_length: f64) -> Scene {
        let points = (0..=links).map(|i| [0.0, 0.0, -rest_length * f64::from(i)]);
        let mut scene = Scene::particles(points, mass);
        scene.filters[0] = Filter::Fixed;
        scene.springs = (0..links)
            .map(|i| spring(i, i + 1, rest_length, stiffness))
            .collect();
        scene.accelerations.fill(Vector::new(0.0, 0.0, -G));
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
            let a = cell / n * (n + 1) + cell % n;
            let (b, c, d) = (a + 1, a + n + 1, a + n + 2);
            for t in [[a, b, d], [a, d, c]] {
                let material = t.map(|v| [points[v as usize][0], points[v as usize][1]]);
                let triangle = Triangle::new(t, material, stiffness);
                scene.triangles.push(triangle.expect("it has area"));
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

/// The 2-norm of all components.
pub(crate) fn norm(v: &[Vector]) -> f64 {
    v.iter().map(|v| v.dot(v)).sum::<f64>().sqrt()
}

/// The order that two errors at Δt and Δt/2 show.
pub(crate) fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

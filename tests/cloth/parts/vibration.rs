//! Stiffness and frequencies of a system in its present configuration, from differences of its forces.

use nalgebra::DMatrix;
use tearmesh::Vector;
use tearmesh_cloth::{System, force};

/// How far particles are moved for a difference, in metres.
const SHIFT_M: f64 = 1e-7;

/// K u: minus the change of forces per unit of the displacements `u`, in N/m times the unit of `u`. It
/// is right to about 1e-8 of the stiffest spring.
pub(crate) fn stiffness_times(system: &System, u: &[Vector]) -> Vec<Vector> {
    let most = u.iter().map(Vector::amax).fold(0.0, f64::max);
    let scale = SHIFT_M / most;
    let forces = |sign: f64| -> Vec<Vector> {
        let mut moved = system.clone();
        let x = moved.state_mut().0.iter_mut();
        x.zip(u).for_each(|(x, u)| *x += u * (sign * scale));
        let particles = 0..u.len();
        particles.map(|i| -force::reaction_n(&moved, i)).collect()
    };
    let [back, ahead] = [-1.0, 1.0].map(forces);
    let changes = back.iter().zip(&ahead);
    changes.map(|(b, a)| (b - a) / (2.0 * scale)).collect()
}

/// uᵀ K u / uᵀ M u over the particles that are not held: a square of frequencies below the largest.
pub(crate) fn rayleigh_quotient(system: &System, u: &[Vector]) -> f64 {
    let free = u.iter().zip(system.inverse_masses());
    let free = free.map(|(u, w)| if *w > 0.0 { *u } else { Vector::zeros() });
    let u: Vec<Vector> = free.collect();
    let product = stiffness_times(system, &u);
    let energy: f64 = u.iter().zip(&product).map(|(u, p)| u.dot(p)).sum();
    let mass = u.iter().zip(system.masses());
    energy / mass.map(|(u, m)| m * u.dot(u)).sum::<f64>()
}

/// The largest frequency, in rad/s, from a dense matrix.
pub(crate) fn largest_frequency(system: &System) -> f64 {
    let n = system.positions().len();
    let weights: Vec<f64> = system.inverse_masses().iter().map(|w| w.sqrt()).collect();
    let mut matrix = DMatrix::zeros(3 * n, 3 * n);
    for column in 0..3 * n {
        let mut unit = vec![Vector::zeros(); n];
        unit[column / 3][column % 3] = 1.0;
        let product = stiffness_times(system, &unit);
        for row in 0..3 * n {
            let entry = product[row / 3][row % 3];
            matrix[(row, column)] = entry * weights[row / 3] * weights[column / 3];
        }
    }
    matrix.symmetric_eigenvalues().max().max(0.0).sqrt()
}

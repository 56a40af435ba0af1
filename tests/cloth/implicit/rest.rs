//! R11: a static drape agrees with a method that shares nothing with the solver: an energy
//! written here, its gradient by differences, a dense Newton iteration.

use super::dense::solve;
use super::{Scene, forces, rest, spring, step};
use crate::parts::{G, implicit};
use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{Buckling, System, energy};

type P = [f64; 3];

fn sub(a: P, b: P) -> P {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: P, b: P) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The energy of a few particles.
type Energy = Box<dyn Fn(&[P]) -> f64>;

/// A naive energy: a list of terms, each of a few particles.
struct Naive {
    terms: Vec<(Vec<usize>, Energy)>,
    /// Gravity on each coordinate: the energy is linear.
    weight: f64,
    free: Vec<usize>,
}

impl Naive {
    fn spring(&mut self, a: usize, b: usize, rest: f64, k: f64) {
        let energy = move |x: &[P]| {
            let d = sub(x[1], x[0]);
            0.5 * k * (dot(d, d).sqrt() - rest).powi(2)
        };
        self.terms.push((vec![a, b], Box::new(energy)));
    }

    /// Material coordinates, and stiffness along u and v and in shear.
    fn triangle(&mut self, t: [usize; 3], uv: [[f64; 2]; 3], k: [f64; 3]) {
        let energy = move |x: &[P]| {
            // w_u solves u-edges · w = x-edges, by Cramer's rule.
            let [(u1, v1), (u2, v2)] = [1, 2].map(|i| (uv[i][0] - uv[0][0], uv[i][1] - uv[0][1]));
            let (a, b) = (sub(x[1], x[0]), sub(x[2], x[0]));
            let det = u1 * v2 - u2 * v1;
            let w_u: P = [0, 1, 2].map(|c| (v2 * a[c] - v1 * b[c]) / det);
            let w_v: P = [0, 1, 2].map(|c| (u1 * b[c] - u2 * a[c]) / det);
            let strain = [
                dot(w_u, w_u).sqrt() - 1.0,
                dot(w_v, w_v).sqrt() - 1.0,
                dot(w_u, w_v),
            ];
            let sum: f64 = (0..3).map(|i| k[i] * strain[i] * strain[i]).sum();
            0.25 * det.abs() * sum
        };
        self.terms.push((t.to_vec(), Box::new(energy)));
    }

    /// The gradient at the free coordinates, by differences with Richardson's extrapolation.
    fn gradient(&self, x: &[P]) -> Vec<f64> {
        let mut gradient = vec![0.0; 3 * x.len()];
        for (particles, energy) in &self.terms {
            let mut at: Vec<P> = particles.iter().map(|&i| x[i]).collect();
            for (slot, &i) in particles.iter().enumerate() {
                for c in 0..3 {
                    let here = at[slot][c];
                    let mut slope = |h: f64| {
                        at[slot][c] = here + h;
                        let plus = energy(&at);
                        at[slot][c] = here - h;
                        let minus = energy(&at);
                        at[slot][c] = here;
                        (plus - minus) / (2.0 * h)
                    };
                    let [a, b, d] = [4e-3, 2e-3, 1e-3].map(|h| slope(h * 0.5));
                    let (ab, bd) = ((4.0 * b - a) / 3.0, (4.0 * d - b) / 3.0);
                    gradient[3 * i + c] += (16.0 * bd - ab) / 15.0;
                }
            }
        }
        self.free
            .iter()
            .map(|&i| gradient[i] + if i % 3 == 2 { self.weight } else { 0.0 })
            .collect()
    }

    /// Newton's method with a dense matrix from differences of the gradient.
    fn rest(&self, x: &mut [P]) -> f64 {
        let most = |g: &[f64]| g.iter().fold(0.0f64, |m, g| m.max(g.abs()));
        let mut left = f64::INFINITY;
        for _ in 0..12 {
            let g = self.gradient(x);
            left = most(&g);
            if left < 1e-12 {
                break;
            }
            let mut columns = Vec::new();
            for &i in &self.free {
                let here = x[i / 3][i % 3];
                x[i / 3][i % 3] = here + 1e-5;
                let plus = self.gradient(x);
                x[i / 3][i % 3] = here - 1e-5;
                let minus = self.gradient(x);
                x[i / 3][i % 3] = here;
                let column = plus.iter().zip(&minus).map(|(p, m)| (p - m) / 2e-5);
                columns.push(column.collect::<Vec<f64>>());
            }
            // Symmetric, so columns serve as rows.
            let step = solve(columns, g);
            for (&i, step) in self.free.iter().zip(step) {
                x[i / 3][i % 3] -= step;
            }
        }
        left
    }
}

/// One scene for both implementations: a sheet of 4 × 4 cells, held at the rim with 2 % pretension,
/// with springs if asked for.
fn drape(with_springs: bool) -> (Scene, Naive) {
    let (n, k) = (4u32, [60.0, 40.0, 8.0]);
    let mut scene = Scene::sheet(n, 0.02, k);
    let mut naive = Naive {
        terms: Vec::new(),
        weight: 0.02 * G,
        free: Vec::new(),
    };
    let flat: Vec<[f64; 2]> = scene.x.iter().map(|p| [p.x, p.y]).collect();
    for t in &scene.triangles {
        naive.triangle(t.corners, t.corners.map(|v| flat[v]), k);
    }
    if with_springs {
        for a in (0..20).filter(|a| a % 5 < 4) {
            scene.springs.push(spring(a, a + 6, 0.3, 25.0));
            naive.spring(a, a + 6, 0.3, 25.0);
        }
    }
    for p in &mut scene.x {
        *p = Point::new(1.02 * p.x, 1.02 * p.y, 0.0);
    }
    for i in Scene::rim(n) {
        scene.held[i] = true;
    }
    scene.gravity = Vector::new(0.0, 0.0, -G);
    let free = (0..scene.x.len()).filter(|&i| !scene.held[i]);
    naive.free = free.flat_map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    (scene, naive)
}

#[test]
fn r11_a_drape_agrees_with_an_independent_method() {
    for with_springs in [false, true] {
        let (scene, naive) = drape(with_springs);
        let mut system = scene.system();
        rest(&mut system, 1e-11);
        let x = system.positions().to_vec();
        // From another start: a bowl.
        let mut other: Vec<P> = scene.x.iter().map(|p| [p.x, p.y, p.z]).collect();
        for &i in &naive.free {
            if i % 3 == 2 {
                let [u, v, _] = other[i / 3];
                other[i / 3][2] = -2.0 * u * (1.02 - u) * v * (1.02 - v);
            }
        }
        let left = naive.rest(&mut other);
        assert!(left < 1e-10, "the naive method left a force of {left} N");
        let apart = |x: &[Point]| {
            let pairs = x.iter().zip(&other);
            pairs.fold(0.0f64, |most, (x, o)| {
                most.max((x - Point::from(*o)).norm())
            })
        };
        println!("R11: sag {}, apart {:.1e}", x[12].z, apart(&x));
        assert!(x[12].z < -0.03 && apart(&x) < 1e-9, "{}", apart(&x));
        // And steps in time end there as well.
        let mut settled = Scene {
            drag: 8.0,
            ..scene.clone()
        }
        .system();
        let mut solver = implicit(Method::Bdf2);
        for _ in 0..1200 {
            step(&mut settled, &mut solver, 0.02).expect("a step");
        }
        let apart = apart(settled.positions());
        assert!(apart < 1e-9, "{apart}");
    }
}

#[test]
fn a_hinge_of_springs_and_arcs_comes_to_rest_where_forces_balance() {
    // A strip of springs and bends, pushed together at its ends.
    let points = (0..9).map(|i| [0.085 * f64::from(i), 0.0, 0.002 * f64::from(i % 3)]);
    let mut scene = Scene::particles(points, 0.001);
    let law = Buckling::new(0.995).expect("a law");
    scene.law = Some(law);
    for i in 0..8 {
        scene.springs.push(spring(i, i + 1, 0.1, 200.0));
        if i < 7 {
            let stiffness = law.compression_n_per_m(1e-4, 0.2);
            scene.bends.push(spring(i, i + 2, 0.2, stiffness));
        }
    }
    scene.held[0] = true;
    scene.held[8] = true;
    scene.gravity = Vector::new(0.0, 0.0, -G);
    let mut system = scene.system();
    rest(&mut system, 1e-10);
    assert!(forces(&mut system)[1..8].iter().all(|f| f.norm() < 2e-10));
    let x = system.positions().to_vec();
    let part = |i: usize| (x[i + 2] - x[i]).norm() / 0.2;
    assert!((0..7).any(|i| part(i) < 0.995), "some bend is an arc");
    // A minimum, and not a saddle: it is lower than all near it.
    let energy = |system: &System| {
        let weights = system.masses().iter().zip(system.positions());
        energy::elastic_j(system) + weights.map(|(m, x)| m * G * x.z).sum::<f64>()
    };
    let lowest = energy(&system);
    for i in 3..24 {
        for by in [-1e-3, 1e-3] {
            let mut moved = system.clone();
            moved.state_mut().0[i / 3][i % 3] += by;
            assert!(energy(&moved) > lowest, "{i}");
        }
    }
}

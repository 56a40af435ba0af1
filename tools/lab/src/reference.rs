//! The second reference: BDF2 with each step solved to convergence, in code of its own.
//!
//! A floor of errors is the distance between two references. It says something only if they share no mistake,
//! so this one has its own springs, damping, loads and solver, and takes from a system no more than its numbers:
//! of stretch and bend constraints, masses, weight, drag, holds and wind. Bends that buckle, triangles and
//! colliders are not supported.
//!
//! Newton's method with conjugate gradients solves M (v − v*) = h [f(x* + h v, v) − c M v] for the new velocity
//! v, where h, x* and v* are those of BDF2 with steps of one length. The first step, those for states of rest,
//! and steps after a tear are of backward Euler. Wind is taken at the end of the step.

use tearmesh::{Point, Vector};
use tearmesh_cloth::{Abilities, Failure, Solver, System};

/// A solver of second order for motions, or of first order for states of rest.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reference {
    faces: Vec<u32>,
    is_to_rest: bool,
    last: Option<Last>,
}

/// The last step: positions and velocities where it began, positions where it ended, and its length.
#[derive(Clone, Debug)]
struct Last {
    began: (Vec<Point>, Vec<Vector>),
    ended: Vec<Point>,
    dt_s: f64,
}

/// The largest number of iterations of Newton's method in a step.
const ITERATIONS: usize = 100;

/// The rms error of the velocity at which a step is solved, in m/s.
const SOLVED: f64 = 1e-12;

/// The largest rms error of the velocity that a step may leave, in m/s, if rounding ends the iterations.
const LEFT: f64 = 1e-8;

impl Reference {
    /// Returns the method for motions. Wind blows on these faces, of three particles each.
    #[must_use]
    pub(crate) fn new(faces: &[u32]) -> Reference {
        Reference {
            faces: faces.to_vec(),
            ..Reference::default()
        }
    }

    /// Returns the method for states of rest: backward Euler, which comes to rest.
    #[must_use]
    pub(crate) fn to_rest() -> Reference {
        Reference {
            is_to_rest: true,
            ..Reference::default()
        }
    }
}

impl Solver for Reference {
    fn abilities(&self) -> Abilities {
        Abilities {
            damps: true,
            ..Abilities::default()
        }
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        let (x, v) = (system.positions().to_vec(), system.velocities().to_vec());
        let goes_on = |last: &Last| !self.is_to_rest && last.ended == x && last.dt_s == dt_s;
        let last = self.last.take().filter(goes_on);
        let h = if last.is_some() { dt_s / 1.5 } else { dt_s };
        let mut step = Step::new(system, &self.faces, h);
        let mut velocities = v.clone();
        for i in 0..x.len() {
            if system.is_held(i) {
                step.start[i] += v[i] * (dt_s - h);
            } else if let Some(Last { began, .. }) = &last {
                step.start[i] += (x[i] - began.0[i]) / 3.0;
                step.start_velocities[i] += (v[i] - began.1[i]) / 3.0;
                velocities[i] += v[i] - began.1[i];
            }
        }
        if step.solve(&mut velocities) > LEFT {
            return Err(Failure::BlowUp);
        }
        let ended = step.reached(&velocities);
        let (positions, speeds) = system.state_mut();
        positions.copy_from_slice(&ended);
        speeds.copy_from_slice(&velocities);
        self.last = Some(Last {
            began: (x, v),
            ended,
            dt_s,
        });
        Ok(())
    }
}

/// The equation of a step.
struct Step<'a> {
    system: &'a System,
    /// Edges, and pairs across an edge.
    springs: Vec<Spring>,
    faces: &'a [u32],
    h: f64,
    start: Vec<Point>,
    start_velocities: Vec<Vector>,
}

impl<'a> Step<'a> {
    /// A step of backward Euler.
    fn new(system: &'a System, faces: &'a [u32], h: f64) -> Step<'a> {
        let damping_s = system.damping_s();
        let families = [(system.stretches(), damping_s), (system.bends(), 0.0)];
        let springs = families.into_iter().flat_map(|(family, damping_s)| {
            family.iter().map(move |id| {
                let constraint = family.get(id);
                let [w, other_w] = constraint.ends.map(|end| system.inverse_masses()[end]);
                let n_per_m = constraint.stiffness_n_per_m;
                // A tenth of the critical damping of this spring alone.
                let most = 0.2 * (n_per_m / (w + other_w)).sqrt();
                Spring {
                    ends: constraint.ends,
                    rest_m: constraint.rest_length_m,
                    n_per_m,
                    n_s_per_m: most.min(damping_s * n_per_m),
                }
            })
        });
        Step {
            springs: springs.collect(),
            system,
            faces,
            h,
            start: system.positions().to_vec(),
            start_velocities: system.velocities().to_vec(),
        }
    }

    fn reached(&self, v: &[Vector]) -> Vec<Point> {
        let particles = self.start.iter().zip(v);
        particles.map(|(x, v)| x + v * self.h).collect()
    }

    /// The indices and masses of free particles.
    fn free(&self) -> impl Iterator<Item = (usize, f64)> {
        let masses = self.system.masses().iter().copied().enumerate();
        masses.filter(|(i, _)| !self.system.is_held(*i))
    }

    /// Newton's method from these velocities, to convergence. Returns the rms error of them that is left.
    fn solve(&self, v: &mut Vec<Vector>) -> f64 {
        let mut residual = self.residual(v);
        let mut error = self.error(&residual);
        for _ in 0..ITERATIONS {
            if error <= SOLVED {
                break;
            }
            let moved = self.direction(&self.reached(v), &residual);
            let along = |part: f64| {
                let pairs = v.iter().zip(&moved);
                let next: Vec<Vector> = pairs.map(|(v, d)| v + d * (part / self.h)).collect();
                let residual = self.residual(&next);
                let left = self.error(&residual);
                (next, residual, left)
            };
            // A full step, or the first part of it that leaves less. None does where rounding is left.
            let mut parts = (0..20).map(|halvings| along(0.5_f64.powi(halvings)));
            let Some(next) = parts.find(|(_, _, left)| *left < error) else {
                break;
            };
            (*v, residual, error) = next;
        }
        error
    }

    /// f − M ((1 + hc) v − v*)/h, of free particles.
    fn residual(&self, v: &[Vector]) -> Vec<Vector> {
        let forces = self.forces(&self.reached(v), v);
        let mut residual = vec![Vector::zeros(); v.len()];
        for (i, m) in self.free() {
            residual[i] = forces[i] - (v[i] - self.start_velocities[i]) * (m / self.h);
        }
        residual
    }

    /// The rms error of the velocity that a residual is.
    fn error(&self, residual: &[Vector]) -> f64 {
        let squares = self.free().map(|(i, m)| residual[i].norm_squared() / m);
        let mass: f64 = self.free().map(|(_, m)| m).sum();
        self.h * (squares.sum::<f64>() / mass.max(f64::MIN_POSITIVE)).sqrt()
    }

    /// The change of positions that answers a residual, by conjugate gradients. Where the matrix shows that it is
    /// not definite they end, as what they found so far leads downhill too.
    fn direction(&self, x: &[Point], residual: &[Vector]) -> Vec<Vector> {
        let springs = self.springs.iter().map(|spring| {
            let [a, b] = spring.ends;
            (spring.ends, spring.stiffness(x[b] - x[a], self.h))
        });
        let springs: Vec<_> = springs.collect();
        let mut solution = vec![Vector::zeros(); x.len()];
        let mut left = residual.to_vec();
        let mut direction = left.clone();
        let mut square = dot(&left, &left);
        // Much smaller than what Newton's method gains in an iteration.
        let enough = 1e-14 * square;
        for i in 0..20 * x.len() {
            let product = self.product(&springs, &direction);
            let curvature = dot(&direction, &product);
            if square <= enough || (curvature <= 0.0 && i > 0) {
                break;
            }
            let far = square / curvature.abs();
            let before = square;
            for i in 0..x.len() {
                solution[i] += direction[i] * far;
                left[i] -= product[i] * far;
            }
            square = dot(&left, &left);
            for (p, r) in direction.iter_mut().zip(&left) {
                *p = r + *p * (square / before);
            }
        }
        solution
    }

    /// (M (1 + hc)/h² + K) u, of free particles.
    fn product(&self, springs: &[Stiff<impl Fn(Vector) -> Vector>], u: &[Vector]) -> Vec<Vector> {
        let drag = self.system.loads().drag_per_s.unwrap_or(0.0);
        let inertia = (1.0 + self.h * drag) / (self.h * self.h);
        let mut stiff = vec![Vector::zeros(); u.len()];
        for ([a, b], stiffness) in springs {
            let pull = stiffness(u[*b] - u[*a]);
            stiff[*a] -= pull;
            stiff[*b] += pull;
        }
        let mut product = vec![Vector::zeros(); u.len()];
        for (i, m) in self.free() {
            product[i] = stiff[i] + u[i] * (m * inertia);
        }
        product
    }

    /// All forces, with drag.
    fn forces(&self, x: &[Point], v: &[Vector]) -> Vec<Vector> {
        let loads = self.system.loads();
        let gravity = loads.gravity_m_per_s2.unwrap_or_default();
        let drag = loads.drag_per_s.unwrap_or(0.0);
        let particles = self.system.masses().iter().zip(v);
        let forces = particles.map(|(m, v)| (gravity - v * drag) * *m);
        let mut forces: Vec<Vector> = forces.collect();
        for spring in &self.springs {
            let [a, b] = spring.ends;
            let pull = spring.pull(x[b] - x[a], v[b] - v[a]);
            forces[a] += pull;
            forces[b] -= pull;
        }
        let Some(wind) = loads.wind else {
            return forces;
        };
        for face in self.faces.as_chunks().0 {
            let corners = face.map(|corner| corner as usize);
            let [a, b, c] = corners;
            let normal = (x[b] - x[a]).cross(&(x[c] - x[a]));
            let area = 0.5 * normal.norm();
            if area > 0.0 {
                let unit = normal / (2.0 * area);
                let speed = unit.dot(&(wind.velocity_m_per_s - (v[a] + v[b] + v[c]) / 3.0));
                let third = unit * (wind.coefficient * area * speed / 3.0);
                corners.iter().for_each(|&corner| forces[corner] += third);
            }
        }
        forces
    }
}

fn dot(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

/// The ends and the stiffness of a spring.
type Stiff<F> = ([usize; 2], F);

/// A spring along an edge, or one that resists bending.
#[derive(Clone, Copy)]
struct Spring {
    ends: [usize; 2],
    rest_m: f64,
    n_per_m: f64,
    n_s_per_m: f64,
}

impl Spring {
    /// The force on the first end, with the second at the difference `d` from it and as much faster as `v`.
    fn pull(self, d: Vector, v: Vector) -> Vector {
        let length = d.norm();
        let damped_n = self.n_s_per_m * d.dot(&v) / length;
        d * ((self.n_per_m * (length - self.rest_m) + damped_n) / length)
    }

    /// The change of the force on the first end if the difference to the second, which is `d`, changes by a vector
    /// within `h` seconds: stiffness and damping along the spring, and across it a part of the stiffness.
    fn stiffness(self, d: Vector, h: f64) -> impl Fn(Vector) -> Vector {
        let length = d.norm();
        let (direction, across) = (d / length, (length - self.rest_m) / length);
        move |u| {
            let along = direction * direction.dot(&u);
            (along + (u - along) * across) * self.n_per_m + along * (self.n_s_per_m / h)
        }
    }
}

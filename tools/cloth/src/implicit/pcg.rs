//! Conjugate gradients where some particles are held: Baraff and Witkin 1998 §5.2–5.3, in the
//! corrected form of Ascher and Boxerman 2003.
//!
//! Solves S (s M + H) S δ = S b for δ = S δ, where S takes away the particles that are held. The
//! preconditioner is the inverse of each block on the diagonal. Vectors start and stay in the range
//! of S, so what is held is held exactly.
//!
//! The matrix has to be positive definite. Where it shows that it is not – a block on the
//! diagonal without a Cholesky factor, or a direction p with pᵀAp ≤ 0 – the solve stops and
//! says so. (A matrix can be indefinite and not show it in the directions visited; then the
//! answer still solves the equation.)
//!
//! The residual r is measured as an acceleration, √(rᵀ M⁻¹ r / Σm). Since A − s M is positive
//! semidefinite for every A that passes as a stable system, that divided by s bounds the rms
//! error of δ.

use tearmesh::geometry::{Vector, dot};

use super::Work;
use super::problem::{Problem, square_per_mass};
use crate::matrix::{Block, Hessian};

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// The residual is small enough.
    Converged,
    /// The matrix is not positive definite.
    Indefinite,
    /// It took as many iterations as it may.
    Stopped,
}

/// What a solve did.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinearSolution {
    pub(super) end: End,
    /// The rms acceleration that is left, in m/s².
    pub(super) residual: f64,
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    /// The rms acceleration that may be left, in m/s².
    pub(super) residual: f64,
    /// The part of the residual at the start that may be left, if that is more.
    pub(super) relative: f64,
    pub(super) iterations: u32,
}

/// The vectors of a solve, kept between solves.
#[derive(Clone, Debug, Default)]
pub(super) struct Pcg {
    /// The right-hand side; on return the residual.
    pub(super) b: Vec<Vector>,
    /// The solution.
    pub(super) delta: Vec<Vector>,
    preconditioned: Vec<Vector>,
    direction: Vec<Vector>,
    product: Vec<Vector>,
    inverses: Vec<Block>,
}

impl Pcg {
    /// Solves from the right-hand side in `b`, from δ = 0.
    pub(super) fn solve(
        &mut self,
        problem: Problem<'_>,
        hessian: &Hessian,
        pairs: &[[u32; 2]],
        inertia: f64,
        stop: Stop,
        work: &mut Work,
    ) -> LinearSolution {
        let n = problem.masses().len();
        self.delta.clear();
        self.delta.resize(n, Vector::zeros());
        for (i, b) in self.b.iter_mut().enumerate() {
            *b = problem.filter(i, *b);
        }
        let start = problem.residual(&self.b);
        let limit = stop.residual.max(stop.relative * start);
        let ended = |end, residual| LinearSolution { end, residual };
        if !self.precondition_by(problem, hessian, inertia) {
            return ended(End::Indefinite, start);
        }
        if start <= limit {
            return ended(End::Converged, start);
        }
        for vectors in [
            &mut self.direction,
            &mut self.product,
            &mut self.preconditioned,
        ] {
            vectors.clear();
            vectors.resize(n, Vector::zeros());
        }
        let (mut left, mut rz) = self.advance(problem, 0.0);
        self.direction.clone_from(&self.preconditioned);
        for _ in 0..stop.iterations {
            hessian.product(pairs, &self.direction, &mut self.product);
            work.matrix_products += 1;
            work.solver_iterations += 1;
            let mut curvature = 0.0;
            for i in 0..n {
                let p = self.direction[i];
                let q = self.product[i] + p * (inertia * problem.masses()[i]);
                let q = problem.filter(i, q);
                self.product[i] = q;
                curvature += dot(p, q);
            }
            if curvature.is_nan() || curvature <= 0.0 {
                return ended(End::Indefinite, left);
            }
            let before = rz;
            (left, rz) = self.advance(problem, rz / curvature);
            if left <= limit {
                return ended(End::Converged, left);
            }
            let turn = rz / before;
            for (p, z) in self.direction.iter_mut().zip(&self.preconditioned) {
                *p = z + *p * turn;
            }
        }
        ended(End::Stopped, left)
    }

    /// Goes `step` along the direction: new δ and r, and z = P⁻¹ r. Returns the residual as an
    /// acceleration, and r · z.
    fn advance(&mut self, problem: Problem<'_>, step: f64) -> (f64, f64) {
        let (mut size, mut total, mut rz) = (0.0, 0.0, 0.0);
        for (i, &m) in problem.masses().iter().enumerate() {
            self.delta[i] += self.direction[i] * step;
            let r = self.b[i] - self.product[i] * step;
            self.b[i] = r;
            size += square_per_mass(r, m);
            total += m;
            let z = self.inverses[i].times(r);
            rz += dot(r, z);
            self.preconditioned[i] = z;
        }
        ((size / total).sqrt(), rz)
    }

    /// Inverts the blocks on the diagonal; false if one is not definite.
    fn precondition_by(&mut self, problem: Problem<'_>, hessian: &Hessian, inertia: f64) -> bool {
        self.inverses.clear();
        for (i, block) in hessian.diagonal.iter().enumerate() {
            let mass = Block::identity_times(inertia * problem.masses()[i]);
            let inverse = if problem.is_free(i) {
                block.plus(1.0, &mass).inverse_if_definite()
            } else {
                Some(Block::ZERO)
            };
            let Some(inverse) = inverse else {
                return false;
            };
            self.inverses.push(inverse);
        }
        true
    }
}

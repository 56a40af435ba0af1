//! Stretch and shear of a triangle: Baraff and Witkin 1998 §4.
//!
//! The map from the material plane (u, v) into space has the constant derivatives
//!
//! ```text
//! (w_u  w_v) = (x₁ − x₀   x₂ − x₀) D,     D = inverse of [ u₁−u₀  u₂−u₀ ; v₁−v₀  v₂−v₀ ]
//! ```
//!
//! and the energy, A the area at rest, is
//!
//! ```text
//! E = A [ ½ k_u (|w_u| − 1)² + ½ k_v (|w_v| − 1)² + ½ k_s (w_u · w_v)² ]
//! ```
//!
//! **Where we differ.** The paper scales its conditions by the area, so its energy goes with
//! A² and the same cloth gets softer as its triangles get smaller. With A the stiffnesses are
//! moduli in N/m that do not depend on the mesh: `E_u` = `k_u` and `E_v` = `k_v` at any strain,
//! Poisson's ratio zero, and the shear modulus `k_s` at rest.
//!
//! **What is indefinite.** The term (1 − 1/|w|)(I − ŵ ŵᵀ) of a compressed direction, and the term
//! `k_s` s of the shear s = `w_u` · `w_v`, which has the eigenvalues ±`k_s` |s|. Clamped, the first
//! is dropped (as the paper does) and of the second the negative half.

use tearmesh::geometry::{Point, Vector, dot, length};

use super::matrix::Block;

/// A triangle that resists stretch and shear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// The three particles.
    pub vertices: [u32; 3],
    /// The inverse of the material matrix: rows by edge (x₁ − x₀, x₂ − x₀), columns u and v;
    /// in 1/m.
    pub rest_inverse: [[f64; 2]; 2],
    /// The area at rest, in m².
    pub area: f64,
    /// Stiffness along u, across v, and in shear, in N/m.
    pub stiffness: [f64; 3],
}

impl Triangle {
    /// The triangle whose corners have these places in the material, (u, v) in m.
    ///
    /// `None` where they span no area, or a number is not finite.
    ///
    /// ```
    /// use tearmesh_cloth::implicit::Triangle;
    ///
    /// let triangle = Triangle::new([0, 1, 2], [[0., 0.], [2., 0.], [0., 1.]], [10., 10., 1.]);
    /// assert_eq!(triangle.unwrap().area, 1.0);
    /// assert_eq!(Triangle::new([0, 1, 2], [[0., 0.], [1., 1.], [2., 2.]], [1.; 3]), None);
    /// ```
    #[must_use]
    pub fn new(
        vertices: [u32; 3],
        material: [[f64; 2]; 3],
        stiffness: [f64; 3],
    ) -> Option<Triangle> {
        let [a, b, c] = material;
        let (u1, v1) = (b[0] - a[0], b[1] - a[1]);
        let (u2, v2) = (c[0] - a[0], c[1] - a[1]);
        let twice = u1 * v2 - u2 * v1;
        let triangle = Triangle {
            vertices,
            rest_inverse: [[v2 / twice, -u2 / twice], [-v1 / twice, u1 / twice]],
            area: 0.5 * twice.abs(),
            stiffness,
        };
        triangle.fault().is_none().then_some(triangle)
    }

    /// The first number that makes the triangle unusable.
    pub(super) fn fault(&self) -> Option<f64> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let usable = |x: f64| x >= 0.0 && x.is_finite();
        let inverse = self.rest_inverse.as_flattened();
        let bad = inverse.iter().find(|x| !x.is_finite());
        let bad = bad.or_else(|| Some(&self.area).filter(|&&x| !positive(x)));
        let bad = bad.or_else(|| self.stiffness.iter().find(|&&x| !usable(x)));
        bad.copied()
    }

    /// How `w_u` and `w_v` change with each corner.
    pub(crate) fn weights(&self) -> [[f64; 3]; 2] {
        let d = &self.rest_inverse;
        [0, 1].map(|c| [-(d[0][c] + d[1][c]), d[0][c], d[1][c]])
    }

    /// `w_u` and `w_v` with the corners at these points.
    #[inline]
    #[must_use]
    pub fn derivatives(&self, [x0, x1, x2]: [Point; 3]) -> [Vector; 2] {
        let (a, b) = (x1 - x0, x2 - x0);
        let d = &self.rest_inverse;
        [0, 1].map(|c| a * d[0][c] + b * d[1][c])
    }
}

/// The energy, in J, with the corners at these points.
#[inline]
#[must_use]
pub fn energy(triangle: &Triangle, corners: [Point; 3]) -> f64 {
    let [w_u, w_v] = triangle.derivatives(corners);
    let [k_u, k_v, k_s] = triangle.stiffness;
    let (e_u, e_v, shear) = (length(w_u) - 1.0, length(w_v) - 1.0, dot(w_u, w_v));
    triangle.area * 0.5 * (k_u * (e_u * e_u) + k_v * (e_v * e_v) + k_s * (shear * shear))
}

/// The forces on the corners, in N. The first is made from the other two, so that their sum is
/// zero to one rounding.
#[inline]
#[must_use]
pub fn forces(triangle: &Triangle, corners: [Point; 3]) -> [Vector; 3] {
    let [w_u, w_v] = triangle.derivatives(corners);
    let [k_u, k_v, k_s] = triangle.stiffness;
    let shear = k_s * dot(w_u, w_v);
    let p_u = w_u * (k_u * stretch(w_u)) + w_v * shear;
    let p_v = w_v * (k_v * stretch(w_v)) + w_u * shear;
    let d = &triangle.rest_inverse;
    let [f1, f2] = [0, 1].map(|e| (p_u * d[e][0] + p_v * d[e][1]) * -triangle.area);
    [-(f1 + f2), f1, f2]
}

/// The change of the forces on the corners when these move by `u`, negated, to first order: what
/// [`hessian`] with `clamp` gives, without the matrix.
#[inline]
#[must_use]
pub fn stiffness_times(triangle: &Triangle, corners: [Point; 3], u: [Vector; 3]) -> [Vector; 3] {
    let [w_u, w_v] = triangle.derivatives(corners);
    let [k_u, k_v, k_s] = triangle.stiffness;
    let (a, b) = (u[1] - u[0], u[2] - u[0]);
    let d = &triangle.rest_inverse;
    let [d_u, d_v] = [0, 1].map(|c| a * d[0][c] + b * d[1][c]);
    let along = |w: Vector, k: f64, change: Vector| {
        let square = dot(w, w);
        if square == 0.0 {
            return Vector::zeros();
        }
        let across = stretch(w).max(0.0);
        let part = w * (dot(w, change) / square);
        (part + (change - part) * across) * k
    };
    let shear = dot(w_u, w_v);
    let sheared = dot(w_v, d_u) + dot(w_u, d_v);
    let both = d_u * shear.abs() + d_v * shear;
    let sign = if shear < 0.0 { -1.0 } else { 1.0 };
    let p_u = along(w_u, k_u, d_u) + (w_v * sheared + both * 0.5) * k_s;
    let p_v = along(w_v, k_v, d_v) + (w_u * sheared + both * (0.5 * sign)) * k_s;
    let [f1, f2] = [0, 1].map(|e| (p_u * d[e][0] + p_v * d[e][1]) * triangle.area);
    [-(f1 + f2), f1, f2]
}

/// 1 − 1/|w|, which is zero for a w of zero, since that has no direction.
fn stretch(w: Vector) -> f64 {
    let l = length(w);
    if l > 0.0 { (l - 1.0) / l } else { 0.0 }
}

/// The second derivatives of the energy: `[i][j]` is the block of corners i and j, in N/m; and
/// how many of the three terms (u, v, shear) had a part dropped.
#[inline]
#[must_use]
pub fn hessian(triangle: &Triangle, corners: [Point; 3], clamp: bool) -> ([[Block; 3]; 3], u32) {
    let [w_u, w_v] = triangle.derivatives(corners);
    let [k_u, k_v, k_s] = triangle.stiffness;
    let shear = dot(w_u, w_v);
    let mut clamped = 0;
    let mut along = |w: Vector, k: f64, other: Vector| {
        let mut across = stretch(w);
        if clamp && across < 0.0 {
            across = 0.0;
            clamped += u32::from(k > 0.0);
        }
        let l = length(w);
        let direction = if l > 0.0 { w / l } else { w };
        Block::identity_times(k * across)
            .plus(k * (1.0 - across), &Block::outer(direction, direction))
            .plus(k_s, &Block::outer(other, other))
    };
    let mut uu = along(w_u, k_u, w_v);
    let mut vv = along(w_v, k_v, w_u);
    let mut uv = Block::outer(w_v, w_u);
    // s [0 I; I 0] is half |s| [I ±I; ±I I] less half |s| [I ∓I; ∓I I].
    if clamp {
        let half = Block::identity_times(0.5 * k_s * shear.abs());
        uu = uu.plus(1.0, &half);
        vv = vv.plus(1.0, &half);
        uv = uv.plus(0.5 * shear, &Block::identity_times(1.0));
        clamped += u32::from(k_s * shear != 0.0);
    } else {
        uv = uv.plus(shear, &Block::identity_times(1.0));
    }
    let uv = Block::ZERO.plus(k_s, &uv);
    let vu = uv.transposed();
    let [g_u, g_v] = triangle.weights();
    let a = triangle.area;
    let block = |i: usize, j: usize| {
        Block::ZERO
            .plus(a * (g_u[i] * g_u[j]), &uu)
            .plus(a * (g_v[i] * g_v[j]), &vv)
            .plus(a * (g_u[i] * g_v[j]), &uv)
            .plus(a * (g_v[i] * g_u[j]), &vu)
    };
    // Moving the whole triangle changes no force: rows sum to zero, and the first corner's
    // blocks follow from the others'.
    let (b11, b12, b22) = (block(1, 1), block(1, 2), block(2, 2));
    let b21 = b12.transposed();
    let zero = Block::ZERO;
    let b10 = zero.plus(-1.0, &b11).plus(-1.0, &b12);
    let b20 = zero.plus(-1.0, &b21).plus(-1.0, &b22);
    let b00 = zero.plus(-1.0, &b10).plus(-1.0, &b20);
    let (b01, b02) = (b10.transposed(), b20.transposed());
    ([[b00, b01, b02], [b10, b11, b12], [b20, b21, b22]], clamped)
}

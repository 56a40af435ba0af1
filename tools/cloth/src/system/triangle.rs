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
//!
//! **Frequencies.** A triangle counts as two springs with three ends, along warp and along weft. Its
//! shear gets stiffer as it is stretched, so the bound of that holds as long as |`w_u`|² + |`w_v`|² +
//! |`w_u` · `w_v`| is within a *reach*.

use tearmesh::geometry::{Point, Vector, dot, length};

use crate::system::crush::Crush;
use crate::system::damping;
use crate::system::incidence::{Dirty, Incidence};
use crate::system::matrix::{Block, Hessian, outer};
use crate::system::pull::Pull;

/// A triangle that resists stretch and shear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// The indices of the three particles, one for each corner.
    pub vertices: [u32; 3],
    /// The inverse of the matrix of the triangle's edges in the material, in 1/m. Rows belong to
    /// the edges x₁ − x₀ and x₂ − x₀, and columns to u and v.
    pub(crate) rest_inverse: [[f64; 2]; 2],
    /// The area at rest, in m².
    pub area: f64,
    /// The stiffness along u, along v, and in shear, in N/m.
    pub(crate) stiffness: [f64; 3],
    /// The material damping along u, along v, and in shear, in N s/m: that of the last
    /// [`Triangles::damp`].
    damping: [f64; 3],
}

impl Triangle {
    /// Creates a triangle with these particles at its corners, with the coordinates (u, v) of the
    /// corners in the material in metres, and with the stiffness along u, along v and in shear in
    /// N/m.
    ///
    /// Returns `None` if the corners span no area, a stiffness is negative, or a number is not
    /// finite.
    pub(crate) fn new(
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
            damping: [0.0; 3],
        };
        let inverse = triangle.rest_inverse.as_flattened();
        let is_usable = inverse.iter().all(|x| x.is_finite())
            && triangle.area > 0.0
            && triangle.area.is_finite()
            && stiffness.iter().all(|k| *k >= 0.0 && k.is_finite());
        is_usable.then_some(triangle)
    }

    /// One that resists nothing, in the place of one without area.
    pub(crate) fn slack(vertices: [u32; 3]) -> Triangle {
        Triangle {
            vertices,
            rest_inverse: [[0.0; 2]; 2],
            area: f64::MIN_POSITIVE,
            stiffness: [0.0; 3],
            damping: [0.0; 3],
        }
    }

    /// How `w_u` and `w_v` change with each corner.
    fn weights(&self) -> [[f64; 3]; 2] {
        let d = &self.rest_inverse;
        [0, 1].map(|c| [-(d[0][c] + d[1][c]), d[0][c], d[1][c]])
    }

    /// Returns the derivatives `w_u` and `w_v` of the positions by the material coordinates u and
    /// v, with the corners at these points. At rest their lengths are 1.
    #[inline]
    #[must_use]
    pub fn derivatives(&self, [x0, x1, x2]: [Point; 3]) -> [Vector; 2] {
        let (a, b) = (x1 - x0, x2 - x0);
        let d = &self.rest_inverse;
        [0, 1].map(|c| a * d[0][c] + b * d[1][c])
    }

    /// Those with its particles where they are.
    #[inline]
    pub(crate) fn derivatives_at(&self, x: &[Point]) -> [Vector; 2] {
        self.derivatives(self.vertices.map(|v| x[v as usize]))
    }

    /// The energy, in J, by these derivatives.
    #[inline]
    fn energy(&self, [w_u, w_v]: [Vector; 2]) -> f64 {
        let [k_u, k_v, k_s] = self.stiffness;
        let (e_u, e_v, shear) = (length(w_u) - 1.0, length(w_v) - 1.0, dot(w_u, w_v));
        self.area * 0.5 * (k_u * (e_u * e_u) + k_v * (e_v * e_v) + k_s * (shear * shear))
    }

    /// The forces on the corners, in N. The first is made from the other two, so that their sum is
    /// zero to one rounding.
    #[inline]
    fn forces(&self, [w_u, w_v]: [Vector; 2]) -> [Vector; 3] {
        let [k_u, k_v, k_s] = self.stiffness;
        let shear = k_s * dot(w_u, w_v);
        let p_u = w_u * (k_u * stretch(w_u)) + w_v * shear;
        let p_v = w_v * (k_v * stretch(w_v)) + w_u * shear;
        let d = &self.rest_inverse;
        let [f1, f2] = [0, 1].map(|e| (p_u * d[e][0] + p_v * d[e][1]) * -self.area);
        [-(f1 + f2), f1, f2]
    }

    /// The forces of damping, in N: of the material, and along warp and weft as far as they are crushed. And
    /// the power that the material takes, in W.
    #[inline]
    fn damping(&self, w: [Vector; 2], crush: Crush<'_>) -> ([Vector; 3], f64) {
        let [v0, v1, v2] = self.vertices.map(|v| crush.velocities[v as usize]);
        let (a, b) = (v1 - v0, v2 - v0);
        let (d, [_, _, c_s]) = (&self.rest_inverse, self.damping);
        let rates = [0, 1].map(|c| a * d[0][c] + b * d[1][c]);
        let shear = dot(w[0], rates[1]) + dot(w[1], rates[0]);
        let mut damped_w = c_s * (shear * shear);
        let [p_u, p_v] = [0, 1].map(|c| {
            let mut p = w[1 - c] * (self.area * c_s * shear);
            let ratio = length(w[c]);
            if ratio > 0.0 {
                let direction = w[c] / ratio;
                let speed = dot(direction, rates[c]);
                damped_w += self.damping[c] * (speed * speed);
                let crushed = crush.pull(self.area * self.stiffness[c], ratio, speed);
                p += direction * (self.area * self.damping[c] * speed + crushed);
            }
            p
        });
        let [f1, f2] = [0, 1].map(|e| -(p_u * d[e][0] + p_v * d[e][1]));
        ([-(f1 + f2), f1, f2], self.area * damped_w)
    }

    /// The second derivatives of the energy, in N/m, for each corner: the blocks of it with itself and with the
    /// next; and how many of the three terms (u, v, shear) had a part dropped.
    fn hessian(&self, [w_u, w_v]: [Vector; 2], clamp: bool) -> ([[Block; 2]; 3], u32) {
        let [k_u, k_v, k_s] = self.stiffness;
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
            Block::from_diagonal_element(k * across)
                + outer(direction, direction) * (k * (1.0 - across))
                + outer(other, other) * k_s
        };
        let mut uu = along(w_u, k_u, w_v);
        let mut vv = along(w_v, k_v, w_u);
        let mut uv = outer(w_v, w_u);
        // s [0 I; I 0] is half |s| [I ±I; ±I I] less half |s| [I ∓I; ∓I I].
        if clamp {
            let half = Block::from_diagonal_element(0.5 * k_s * shear.abs());
            uu += half;
            vv += half;
            uv += Block::from_diagonal_element(0.5 * shear);
            clamped += u32::from(k_s * shear != 0.0);
        } else {
            uv += Block::from_diagonal_element(shear);
        }
        let uv = uv * k_s;
        let vu = uv.transpose();
        let [g_u, g_v] = self.weights();
        let a = self.area;
        let block = |i: usize, j: usize| {
            uu * (a * (g_u[i] * g_u[j]))
                + vv * (a * (g_v[i] * g_v[j]))
                + uv * (a * (g_u[i] * g_v[j]))
                + vu * (a * (g_v[i] * g_u[j]))
        };
        // Moving the whole triangle changes no force: rows sum to zero, and the first corner's
        // blocks follow from the others'.
        let (b11, b12, b22) = (block(1, 1), block(1, 2), block(2, 2));
        let (b10, b20) = (-b11 - b12, -b12.transpose() - b22);
        let b00 = -b10 - b20;
        ([[b00, b10.transpose()], [b11, b12], [b22, b20]], clamped)
    }

    /// Springs between its corners that together are as stiff and as damped as warp, weft and shear: since the
    /// weights g of either have no sum, |Σ gᵢuᵢ|² is −Σ gᵢgⱼ|uᵢ − uⱼ|² over pairs, and those with a
    /// negative factor are left out.
    fn springs(&self, reach: f64) -> [[f64; 2]; 3] {
        let weights = self.weights();
        // What √k is of a spring.
        let roots = [self.stiffness, self.damping].map(|[along_u, along_v, shear]| {
            [along_u, along_v].map(|k| (self.area * (k + shear * reach)).sqrt())
        });
        [[0, 1], [1, 2], [2, 0]].map(|[i, j]| {
            roots.map(|roots| {
                let part = |c: usize| match weights[c][i] * weights[c][j] < 0.0 {
                    true => (roots[c] * weights[c][i].abs()) * (roots[c] * weights[c][j].abs()),
                    false => 0.0,
                };
                part(0) + part(1)
            })
        })
    }
}

/// 1 − 1/|w|, which is zero for a w of zero, since that has no direction.
fn stretch(w: Vector) -> f64 {
    let l = length(w);
    if l > 0.0 { (l - 1.0) / l } else { 0.0 }
}

/// The triangles 0, 1, 2, … of particles, and which particle has which.
#[derive(Clone, Debug, Default)]
pub(crate) struct Triangles {
    pub(crate) list: Vec<Triangle>,
    lists: Incidence<3>,
}

impl Triangles {
    /// Makes room for so many particles in all.
    pub(crate) fn reserve(&mut self, particles: usize) {
        self.lists.reserve(particles, self.list.len());
    }

    /// The triangles of a particle, and which corner of them it is.
    pub(crate) fn of(&self, particle: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.lists.of(particle)
    }

    /// How far those that shear are stretched at most: what a reach is held against, |`w_u`|² + |`w_v`|² +
    /// |`w_u` · `w_v`|. `k_s` times this bounds the second derivative of the shear term by `w_u` and `w_v`.
    /// Zero without any, 2 at rest.
    pub(crate) fn shear_growth(&self, x: &[Point]) -> f64 {
        let sheared = self.list.iter().filter(|t| t.stiffness[2] > 0.0);
        let growths = sheared.map(|t| {
            let [w_u, w_v] = t.derivatives_at(x);
            dot(w_u, w_u) + dot(w_v, w_v) + dot(w_u, w_v).abs()
        });
        growths.fold(0.0, f64::max)
    }

    /// Puts a triangle in the place of number `t`, or appends it.
    pub(crate) fn put(&mut self, t: usize, triangle: Triangle) {
        assert!(t <= self.list.len(), "triangles are in step with faces");
        let is_new = t == self.list.len();
        if is_new {
            self.list.push(triangle);
            self.lists.push();
        }
        for (corner, v) in triangle.vertices.into_iter().enumerate() {
            if is_new {
                self.lists.attach(t, corner, v as usize);
            } else {
                self.repoint(t, corner, v as usize);
                self.lists.changed.mark(v as usize);
            }
        }
        self.list[t] = triangle;
    }

    /// Gives a corner to another particle.
    pub(crate) fn repoint(&mut self, t: usize, corner: usize, to: usize) {
        let from = self.list[t].vertices[corner] as usize;
        if from != to {
            self.lists.detach(t, corner, from);
            self.list[t].vertices[corner] = to as u32;
            self.lists.attach(t, corner, to);
        }
    }

    pub(crate) fn push_particle(&mut self) {
        self.lists.push_particle();
    }

    /// Forgets a particle without triangles; the last one takes its index.
    pub(crate) fn swap_remove_particle(&mut self, particle: usize) {
        for (t, corner) in self.lists.of(self.lists.last_particle()) {
            self.list[t].vertices[corner] = particle as u32;
        }
        self.lists.swap_remove_particle(particle);
    }

    /// The elastic energy in joules, added to a sum one after the other.
    pub(crate) fn energy(&self, x: &[Point], sum: f64) -> f64 {
        let triangles = self.list.iter();
        triangles.fold(sum, |sum, t| sum + t.energy(t.derivatives_at(x)))
    }

    /// That of the triangles of a particle.
    pub(crate) fn energy_at(&self, x: &[Point], particle: usize) -> f64 {
        let triangles = self.of(particle).map(|(t, _)| &self.list[t]);
        triangles.fold(0.0, |sum, t| sum + t.energy(t.derivatives_at(x)))
    }

    /// Computes the damping of the triangles of a particle by the present masses. Warp, weft and shear are each
    /// damped as a spring is.
    pub(crate) fn damp(&mut self, particle: usize, time_s: f64, inverse_masses: &[f64]) {
        for (t, _) in self.lists.of(particle) {
            let t = &mut self.list[t];
            let w = t.vertices.map(|v| inverse_masses[v as usize]);
            let along = |g: [f64; 3]| (0..3).map(|i| w[i] * (g[i] * g[i])).sum::<f64>();
            let [u, v] = t.weights().map(along);
            let sums = [u, v, u + v];
            let coefficient =
                |c: usize| damping::coefficient(time_s, t.area * t.stiffness[c], sums[c]) / t.area;
            t.damping = [0, 1, 2].map(coefficient);
        }
    }

    /// Adds the forces, in newtons, to those of the particles, in a guarded step with those of damping. Not
    /// sane where one is longer along warp or weft than `ratio_max` times its rest length, or not a number.
    pub(crate) fn add_forces(
        &self,
        x: &[Point],
        ratio_max: f64,
        crush: Option<Crush<'_>>,
        forces: &mut [Vector],
    ) -> Pull {
        let (mut is_sane, mut damped_w, most) = (true, 0.0, ratio_max * ratio_max);
        for t in &self.list {
            let w = t.derivatives_at(x);
            let squares = w.map(|w| dot(w, w));
            is_sane &= squares.iter().all(|square| *square <= most);
            for (v, pull) in t.vertices.into_iter().zip(t.forces(w)) {
                forces[v as usize] += pull;
            }
            if let Some(crush) = crush {
                let (pulls, power_w) = t.damping(w, crush);
                damped_w += power_w;
                for (v, pull) in t.vertices.into_iter().zip(pulls) {
                    forces[v as usize] += pull;
                }
            }
        }
        Pull {
            is_sane,
            damped_w,
            ..Pull::NOTHING
        }
    }

    /// Adds the forces on one particle, and those of damping, if the method damps.
    pub(crate) fn add_force_at(
        &self,
        x: &[Point],
        crush: Option<Crush<'_>>,
        particle: usize,
        sum: &mut Vector,
    ) {
        for (t, corner) in self.of(particle) {
            let t = &self.list[t];
            let w = t.derivatives_at(x);
            *sum += t.forces(w)[corner];
            if let Some(crush) = crush {
                let (pulls, _) = t.damping(w, crush);
                *sum += pulls[corner];
            }
        }
    }

    /// The one that is longest along warp or weft for its length at rest: its corners, and that ratio.
    pub(crate) fn longest(&self, x: &[Point]) -> Option<([usize; 3], f64)> {
        let ratios = self.list.iter().map(|t| {
            let ratios = t.derivatives_at(x).map(length);
            let corners = t.vertices.map(|v| v as usize);
            (corners, ratios.into_iter().fold(0.0, f64::max))
        });
        ratios.reduce(|most, one| if one.1 > most.1 { one } else { most })
    }

    /// Visits springs that together are as stiff and as damped as these triangles or more, in any state within
    /// `reach`: their particles, their stiffness in N/m, and their damping in N s/m.
    pub(crate) fn each_spring(&self, reach: f64, mut visit: impl FnMut([usize; 2], [f64; 2])) {
        for t in &self.list {
            let [a, b, c] = t.vertices.map(|v| v as usize);
            for (ends, numbers) in [[a, b], [b, c], [c, a]].into_iter().zip(t.springs(reach)) {
                visit(ends, numbers);
            }
        }
    }

    /// The particles whose triangles changed since they were taken over.
    pub(crate) fn changed(&mut self) -> &mut Dirty {
        &mut self.lists.changed
    }

    /// Visits those springs of a particle, those without stiffness too: their place among those of
    /// [`each_spring`](Triangles::each_spring), the other particle, and the numbers.
    pub(crate) fn springs_at(
        &self,
        particle: usize,
        reach: f64,
        mut visit: impl FnMut(usize, usize, [f64; 2]),
    ) {
        for (index, corner) in self.of(particle) {
            let t = &self.list[index];
            let springs = t.springs(reach);
            let (next, last) = ((corner + 1) % 3, (corner + 2) % 3);
            for (other, side) in [(next, corner), (last, last)] {
                let place = 3 * index + side;
                visit(place, t.vertices[other] as usize, springs[side]);
            }
        }
    }

    /// Adds the second derivatives of the energy. With `clamp` every term is positive semidefinite;
    /// returns how many had a part dropped for it.
    pub(crate) fn add_hessian(&self, x: &[Point], clamp: bool, to: &mut Hessian) -> u64 {
        let mut clamped = 0;
        for t in &self.list {
            let (blocks, dropped) = t.hessian(t.derivatives_at(x), clamp);
            clamped += u64::from(dropped);
            for (i, [own, next]) in blocks.iter().enumerate() {
                let (a, b) = (t.vertices[i], t.vertices[(i + 1) % 3]);
                to.add([a, a], own);
                to.add([a, b], next);
            }
        }
        clamped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_of_another_stiffness_changes_its_particles() {
        let material = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let of = |stiffness| Triangle::new([2, 0, 1], material, stiffness).expect("a triangle");
        let mut triangles = Triangles::default();
        (0..4).for_each(|_| triangles.push_particle());
        for stiffness in [[1.0; 3], [2.0; 3]] {
            triangles.put(0, of(stiffness));
            assert_eq!(triangles.changed().list(), [2, 0, 1]);
            triangles.changed().clear();
        }
    }
}

//! The triangles of a system that resist stretch and shear, and which particle has which.
//!
//! A plain list of [`Triangle`], as [`implicit`](crate::implicit) takes it. Each particle has a
//! list of its corners, threaded through them as that of [`Constraints`](crate::Constraints) is,
//! so an edit costs the valence of what it touches. A system without triangles keeps no list.

use crate::implicit::Triangle;

/// No corner, in the lists of particles.
const NONE: u32 = u32::MAX;

/// Triangles 0, 1, 2, … over particles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Triangles {
    list: Vec<Triangle>,
    /// By particle: 3 t + corner of the first of its list. Empty where there is no triangle.
    first: Vec<u32>,
    /// By triangle and corner: the next of the list.
    next: Vec<[u32; 3]>,
}

impl Triangles {
    pub(crate) fn as_slice(&self) -> &[Triangle] {
        &self.list
    }

    /// The triangles of a particle, and which corner of them it is.
    pub(crate) fn of(&self, particle: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let mut at = self.first.get(particle).copied().unwrap_or(NONE);
        std::iter::from_fn(move || {
            let here = (at != NONE).then_some(at as usize)?;
            at = self.next[here / 3][here % 3];
            Some((here / 3, here % 3))
        })
    }

    /// Appends a triangle to those of so many particles.
    pub(crate) fn push(&mut self, particles: usize, triangle: Triangle) {
        self.first.resize(particles, NONE);
        let t = self.list.len();
        self.list.push(triangle);
        self.next.push([NONE; 3]);
        (0..3).for_each(|corner| self.attach(t, corner));
    }

    /// Puts another triangle in the place of one.
    pub(crate) fn set(&mut self, t: usize, triangle: Triangle) {
        for (corner, to) in triangle.vertices.into_iter().enumerate() {
            self.repoint(t, corner, to as usize);
        }
        self.list[t] = triangle;
    }

    /// Gives a corner to another particle.
    pub(crate) fn repoint(&mut self, t: usize, corner: usize, to: usize) {
        if self.list[t].vertices[corner] as usize != to {
            self.detach(t, corner);
            self.list[t].vertices[corner] = to as u32;
            self.attach(t, corner);
        }
    }

    pub(crate) fn push_particle(&mut self) {
        if !self.list.is_empty() {
            self.first.push(NONE);
        }
    }

    /// Forgets a particle without triangles; the last one takes its index.
    pub(crate) fn swap_remove_particle(&mut self, particle: usize) {
        if self.list.is_empty() {
            return;
        }
        debug_assert_eq!(self.first[particle], NONE, "a removed particle is free");
        let mut at = self.first[self.first.len() - 1];
        while at != NONE {
            let (t, corner) = (at as usize / 3, at as usize % 3);
            self.list[t].vertices[corner] = particle as u32;
            at = self.next[t][corner];
        }
        self.first.swap_remove(particle);
    }

    fn attach(&mut self, t: usize, corner: usize) {
        let first = &mut self.first[self.list[t].vertices[corner] as usize];
        self.next[t][corner] = *first;
        *first = (3 * t + corner) as u32;
    }

    fn detach(&mut self, t: usize, corner: usize) {
        let (gone, after) = ((3 * t + corner) as u32, self.next[t][corner]);
        let particle = self.list[t].vertices[corner] as usize;
        if self.first[particle] == gone {
            self.first[particle] = after;
            return;
        }
        let mut at = self.first[particle] as usize;
        while self.next[at / 3][at % 3] != gone {
            at = self.next[at / 3][at % 3] as usize;
        }
        self.next[at / 3][at % 3] = after;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(vertices: [u32; 3]) -> Triangle {
        let material = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        Triangle::new(vertices, material, [1.0; 3]).expect("it has area")
    }

    /// The lists hold each corner once, at its particle.
    fn check(triangles: &Triangles, particles: usize) {
        let mut listed = 0;
        for particle in 0..particles {
            for (t, corner) in triangles.of(particle) {
                assert_eq!(triangles.list[t].vertices[corner] as usize, particle);
                listed += 1;
            }
        }
        assert_eq!(listed, 3 * triangles.list.len());
    }

    #[test]
    fn corners_come_and_go_and_lists_stay_right() {
        let mut triangles = Triangles::default();
        triangles.push_particle();
        assert_eq!(triangles.of(0).count(), 0);
        triangles.swap_remove_particle(0);
        for vertices in [[0, 1, 2], [2, 1, 3], [3, 0, 2], [4, 2, 1]] {
            triangles.push(5, triangle(vertices));
            check(&triangles, 5);
        }
        assert_eq!(triangles.of(2).count(), 4);
        triangles.push_particle();
        triangles.repoint(1, 0, 5);
        triangles.repoint(3, 1, 5);
        check(&triangles, 6);
        triangles.set(2, triangle([1, 3, 5]));
        check(&triangles, 6);
        // Particle 0 has one triangle left; it goes to 4, and 5 becomes 0.
        triangles.repoint(0, 0, 4);
        check(&triangles, 6);
        triangles.swap_remove_particle(0);
        check(&triangles, 5);
        let vertices: Vec<_> = triangles.list.iter().map(|t| t.vertices).collect();
        assert_eq!(vertices, [[4, 1, 2], [0, 1, 3], [1, 3, 0], [4, 0, 1]]);
    }
}

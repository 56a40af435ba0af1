//! The energy of a model, its forces, and the matrix of its second derivatives: sums over springs,
//! bends and triangles.

use tearmesh::geometry::{Point, Vector, dot};

use super::{Hessian, Layout, Model, bend, spring, triangle};

impl Model<'_> {
    /// The energy stored in springs, triangles and bends, in J.
    ///
    /// # Panics
    ///
    /// If an index is beyond the positions.
    #[must_use]
    pub fn energy(&self, x: &[Point]) -> f64 {
        let mut sum = 0.0;
        for s in self.springs {
            let [p, q] = at(x, s.ends);
            sum += spring::energy(s, p, q);
        }
        for t in self.triangles {
            sum += triangle::energy(t, at(x, t.vertices));
        }
        for b in self.bends {
            let [p, q] = at(x, b.ends());
            sum += bend::energy(b, p, q);
        }
        sum
    }

    /// The energy of the accelerations from outside, −Σ m g · x, in J, zero at the origin.
    #[must_use]
    pub fn outside_energy(&self, x: &[Point]) -> f64 {
        let mut sum = 0.0;
        for ((g, m), x) in self.accelerations.iter().zip(self.masses).zip(x) {
            sum -= m * dot(*g, x.coords);
        }
        sum
    }

    /// The force on each particle, in N: of springs, triangles and bends, each of which sums to
    /// zero, and m g. Without drag, and also on held particles.
    ///
    /// # Panics
    ///
    /// If an index is beyond the positions.
    pub fn forces(&self, x: &[Point], out: &mut Vec<Vector>) {
        out.clear();
        out.extend((0..x.len()).map(|i| self.acceleration(i) * self.masses[i]));
        let mut pull = |[i, j]: [u32; 2], force: Vector| {
            out[i as usize] += force;
            out[j as usize] -= force;
        };
        for s in self.springs {
            let [p, q] = at(x, s.ends);
            pull(s.ends, spring::force(s, p, q));
        }
        for b in self.bends {
            let [p, q] = at(x, b.ends());
            pull(b.ends(), bend::force(b, p, q));
        }
        for t in self.triangles {
            let forces = triangle::forces(t, at(x, t.vertices));
            for (v, f) in t.vertices.into_iter().zip(forces) {
                out[v as usize] += f;
            }
        }
    }

    /// The second derivatives of [`Model::energy`], into `out`, and how many terms had a part
    /// dropped. With `clamp` every term is positive semidefinite; without it derivatives are
    /// exact.
    ///
    /// # Panics
    ///
    /// If the layout does not belong to this model (see [`Layout::follow`]).
    pub fn hessian(&self, x: &[Point], layout: &Layout, clamp: bool, out: &mut Hessian) -> u64 {
        assert!(
            (self.springs.len(), self.triangles.len(), self.bends.len())
                == (
                    layout.springs().len(),
                    layout.triangles().len(),
                    layout.bends().len()
                ),
            "the layout has a slot for each constraint"
        );
        out.clear(x.len(), layout.pairs().len());
        let mut clamped = 0;
        for (s, &slot) in self.springs.iter().zip(layout.springs()) {
            let [p, q] = at(x, s.ends);
            let (k, dropped) = spring::hessian(s, p, q, clamp);
            clamped += u64::from(dropped);
            out.add_pair(slot, s.ends, &k);
        }
        for (b, &slot) in self.bends.iter().zip(layout.bends()) {
            let [p, q] = at(x, b.ends());
            let (k, dropped) = bend::hessian(b, p, q, clamp);
            clamped += u64::from(dropped);
            out.add_pair(slot, b.ends(), &k);
        }
        for (t, slots) in self.triangles.iter().zip(layout.triangles()) {
            let (blocks, dropped) = triangle::hessian(t, at(x, t.vertices), clamp);
            clamped += u64::from(dropped);
            for (i, slot) in slots.iter().enumerate() {
                let j = (i + 1) % 3;
                let (a, b) = (t.vertices[i], t.vertices[j]);
                out.add(*slot, [a, a], &blocks[i][i]);
                out.add(*slot, [a, b], &blocks[i][j]);
            }
        }
        clamped
    }
}

#[inline]
fn at<const N: usize>(x: &[Point], particles: [u32; N]) -> [Point; N] {
    particles.map(|i| x[i as usize])
}

//! The ripple of a flat cloth, without which it could not leave its plane.
//!
//! Particles that lie exactly in a plane, and are loaded in it, stay in it for ever, since no force has a part across.
//! That state is not stable where the cloth is crushed: a nanometre of noise in one vertex takes it to another shape,
//! in which a sheet that is ripped tears by 10 to 14 % less force. Real cloth is never flat, so a flat cloth is
//! displaced along its normal by [`RIPPLE`] of its size when something begins to act on it. The amplitude hardly
//! matters from 1e-9 to 1e-3 m: what buckles grows exponentially, and what does not returns.
//!
//! The displacement is a smooth function of the place in the sheet. Noise by vertex would depend on how vertices are
//! numbered, and would be another one on a finer mesh.

use tearmesh::geometry::{Point, Vector, check_point, cross, dot, length, sine_and_cosine};
use tearmesh::{Follower as _, Mesh, PerVertex, Positions, VertexId};

use super::error::SimulationError;
use crate::system::System;

/// The amplitude of the ripple, as a fraction of the size of a sheet.
const RIPPLE: f64 = 1e-6;

/// The distance from its plane up to which a vertex is in it, as a fraction of the size of a sheet.
const FLAT: f64 = 1e-9;

/// Four waves: how often each repeats over the size of a sheet along both directions of its plane, and its phase as a
/// fraction of a turn. They are 0.90, 0.62, 0.40 and 0.30 of the size long, have no common period, and no turn or
/// reflection of a square maps them to each other.
const WAVES: [([f64; 2], f64); 4] = [
    ([1.03, 0.41], 0.13),
    ([-0.57, 1.51], 0.58),
    ([2.13, 1.27], 0.91),
    ([-2.71, 1.93], 0.37),
];

/// The displacements of a cloth on which nothing acted yet.
#[derive(Clone, Debug)]
pub(super) struct Ripple {
    pub(super) by_m: PerVertex<Vector>,
    /// The largest amplitude of a sheet.
    amplitude_m: f64,
}

impl Ripple {
    /// The ripple of the sheets of a mesh that are flat, with this amplitude in metres if it is given; `None` if no
    /// sheet is flat or the amplitude is 0.
    ///
    /// # Errors
    ///
    /// [`SimulationError::Ripple`] if the amplitude is negative or not finite, or moves a vertex too far away.
    pub(super) fn of(
        mesh: &Mesh,
        positions: &Positions,
        amplitude_m: Option<f64>,
    ) -> Result<Option<Ripple>, SimulationError> {
        let refused = || SimulationError::Ripple(amplitude_m.unwrap_or(RIPPLE));
        if amplitude_m.is_some_and(|given| !(given >= 0.0 && given.is_finite())) {
            return Err(refused());
        }
        let components = mesh.components();
        let mut sheets = vec![Sheet::empty(); components.count()];
        let place = |v: VertexId| positions.at(v);
        for f in mesh.faces() {
            sheets[components.of(f)].add(mesh.face_vertices(f).map(place));
        }
        sheets.iter_mut().for_each(Sheet::orient);
        for f in mesh.faces() {
            sheets[components.of(f)].measure(mesh.face_vertices(f).map(place));
        }
        let mut ripple_m = 0.0;
        let offset = |v: VertexId| {
            let face = mesh.half_edge_of(v).map(|h| h.face());
            let sheet = face.map(|f| &sheets[components.of(f)]);
            sheet
                .filter(|sheet| sheet.is_flat())
                .map_or(Vector::zeros(), |sheet| {
                    let sheet_m = amplitude_m.unwrap_or(RIPPLE * sheet.size_m());
                    ripple_m = f64::max(ripple_m, sheet_m);
                    sheet.normal * (sheet_m * sheet.wave(place(v)))
                })
        };
        let by_m: Vec<Vector> = mesh.vertices().map(offset).collect();
        let mut moved = mesh.vertices().map(|v| place(v) + by_m[v.index()]);
        if moved.any(|point| check_point(point).is_err()) {
            return Err(refused());
        }
        Ok((ripple_m > 0.0).then(|| Ripple {
            by_m: PerVertex::new(by_m).starting_at(positions.seen()),
            amplitude_m: ripple_m,
        }))
    }

    /// Displaces the particles that are not held, and returns the amplitude in metres.
    pub(super) fn displace(&self, system: &mut System) -> f64 {
        let is_free: Vec<bool> = (0..system.masses().len())
            .map(|particle| !system.is_held(particle))
            .collect();
        let points = system.state_mut().0.iter_mut();
        let moves = points.zip(self.by_m.as_slice()).zip(is_free);
        moves
            .filter(|(_, is_free)| *is_free)
            .for_each(|((point, by_m), _)| *point += by_m);
        self.amplitude_m
    }
}

/// A component of a mesh, as its faces are gone through: first for its bounds and its normal, and then for its
/// thickness.
#[derive(Clone, Debug)]
struct Sheet {
    low: Point,
    high: Point,
    /// The sum of the area vectors of faces, each turned to the side of the sum; and then a unit vector.
    normal: Vector,
    /// The smallest and the largest height along the normal.
    heights: [f64; 2],
}

impl Sheet {
    fn empty() -> Sheet {
        let [low, high] = [f64::INFINITY, f64::NEG_INFINITY];
        Sheet {
            low: Point::from([low; 3]),
            high: Point::from([high; 3]),
            normal: Vector::zeros(),
            heights: [low, high],
        }
    }

    fn add(&mut self, corners: [Point; 3]) {
        let [a, b, c] = corners;
        for corner in corners {
            self.low = self.low.inf(&corner);
            self.high = self.high.sup(&corner);
        }
        // A sheet that is folded flat has faces of both orientations.
        let area = cross(b - a, c - a);
        let side = if dot(area, self.normal) < 0.0 {
            -1.0
        } else {
            1.0
        };
        self.normal += area * side;
    }

    /// Makes the normal a unit vector whose first large coordinate is positive, so that it does not depend on how faces
    /// are numbered.
    fn orient(&mut self) {
        let size = length(self.normal);
        if size > 0.0 {
            self.normal /= size;
        }
        let large = self.normal.iter().find(|x| x.abs() > 0.5);
        if large.is_some_and(|x| *x < 0.0) {
            self.normal = -self.normal;
        }
    }

    fn measure(&mut self, corners: [Point; 3]) {
        let [low, high] = &mut self.heights;
        for corner in corners {
            let height = dot(self.normal, corner - self.low);
            (*low, *high) = (low.min(height), high.max(height));
        }
    }

    fn size_m(&self) -> f64 {
        (self.high - self.low).max()
    }

    fn is_flat(&self) -> bool {
        let [low, high] = self.heights;
        self.normal != Vector::zeros() && high - low <= 2.0 * FLAT * self.size_m()
    }

    /// The ripple at a place, from −1 to 1.
    fn wave(&self, at: Point) -> f64 {
        // An axis that is never close to the normal.
        let axis = if self.normal.x.abs() > 0.8 {
            Vector::y()
        } else {
            Vector::x()
        };
        let along = axis - self.normal * dot(axis, self.normal);
        let along = along / length(along);
        let across = cross(self.normal, along);
        let [a, b] = [along, across].map(|axis| dot(axis, at - self.low) / self.size_m());
        let sines = WAVES.map(|([k, l], phase)| {
            let turns = k * a + l * b + phase;
            sine_and_cosine((turns - turns.floor()) * std::f64::consts::TAU).0
        });
        sines.iter().sum::<f64>() / WAVES.len() as f64
    }
}

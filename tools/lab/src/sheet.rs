//! Sheets: a grid whose diagonals lie at random, and Delaunay triangles of as many random points; and wavy sheets of
//! irregular triangles, which are cut through.

use serde::{Deserialize, Serialize};
use tearmesh::{Masses, Mesh, Point, Positions, Ray, Scissor, Vector, shapes};
use tearmesh_cloth::System;

use crate::statistics::Random;

/// The mass of a square metre of a sheet, in kg.
pub(crate) const DENSITY_KG_PER_M2: f64 = 0.15;

/// The seed of the meshes and of all other random numbers of the experiments.
pub(crate) const SEED: u64 = 1;

/// The kinds of meshes of a sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MeshKind {
    /// Square cells with diagonals in random directions.
    #[default]
    Grid,
    /// Delaunay triangles of random points that keep a minimum distance from each other.
    Delaunay,
}

impl MeshKind {
    /// All kinds of meshes.
    pub const ALL: [MeshKind; 2] = [MeshKind::Grid, MeshKind::Delaunay];

    /// Returns the name of the kind, as part of the names of cases.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            MeshKind::Grid => "grid",
            MeshKind::Delaunay => "delaunay",
        }
    }
}

/// The particles and edges of a flat square sheet, in the order of its mesh.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    /// The positions of the particles at rest, in metres: x to the right, y up, from a corner at the origin.
    pub(crate) points: Vec<Point>,
    /// The masses of the particles, in kg.
    pub(crate) masses: Vec<f64>,
    /// The two ends of each edge, as indices into `points`.
    pub(crate) edges: Vec<[usize; 2]>,
    /// The length of a side, in metres.
    pub(crate) side_m: f64,
}

impl Sheet {
    /// Creates a sheet of (`cells` + 1)² particles with sides of `side_m` metres.
    ///
    /// # Panics
    ///
    /// If `cells` is 0 or more than a mesh can have, or if `side_m` is 0 or not finite.
    #[must_use]
    pub(crate) fn new(kind: MeshKind, cells: u32, side_m: f64) -> Sheet {
        let mut random = Random::new(SEED);
        let (mesh, positions) = match kind {
            MeshKind::Grid => grid([cells; 2], [side_m; 2], |_, _| random.next() < 0.5),
            MeshKind::Delaunay => scattered(cells, side_m, &mut random),
        };
        let masses = Masses::area(&mesh, &positions, DENSITY_KG_PER_M2);
        let masses = masses.expect("each face of a sheet has an area");
        let ends = |h| [mesh.origin(h), mesh.target(h)].map(|v| v.index());
        Sheet {
            points: positions.as_slice().to_vec(),
            masses: mesh.vertices().map(|v| masses.at(v)).collect(),
            edges: mesh.edges().map(ends).collect(),
            side_m,
        }
    }

    /// Returns the rest length of an edge in metres, given its two ends as indices into `points`.
    #[must_use]
    pub(crate) fn length_m(&self, [a, b]: [usize; 2]) -> f64 {
        (self.points[b] - self.points[a]).norm()
    }

    /// Returns the mean rest length of the edges, in metres.
    #[must_use]
    pub(crate) fn edge_m(&self) -> f64 {
        let lengths = self.edges.iter().map(|&ends| self.length_m(ends));
        lengths.sum::<f64>() / self.edges.len() as f64
    }
}

/// A grid of square cells, whose diagonals rise where `rising(column, row)` returns true.
pub(crate) fn grid(
    cells: [u32; 2],
    [width_m, height_m]: [f64; 2],
    rising: impl FnMut(u32, u32) -> bool,
) -> (Mesh, Positions) {
    let (mesh, unit) = shapes::grid_with_diagonals(cells[0], cells[1], rising);
    let points = unit.as_slice().iter();
    let points = points.map(|p| Point::new(width_m * p.x, height_m * p.y, 0.0));
    let positions = Positions::new(points).expect("a sheet's coordinates are finite");
    (mesh, positions)
}

/// The Delaunay triangles of as many points as a grid has: evenly along the border, and elsewhere at random
/// places that are no nearer to each other than seven tenths of a cell.
fn scattered(cells: u32, side_m: f64, random: &mut Random) -> (Mesh, Positions) {
    let h = 1.0 / f64::from(cells);
    let mut points: Vec<[f64; 2]> = Vec::new();
    for i in 0..cells {
        let along = f64::from(i) * h;
        let back = 1.0 - along;
        points.extend([[along, 0.0], [1.0, along], [back, 1.0], [0.0, back]]);
    }
    let count = (cells as usize + 1) * (cells as usize + 1);
    let near = (0.7 * h) * (0.7 * h);
    while points.len() < count {
        // A point close to the border would make a needle there.
        let mut along = || 0.4 * h + (1.0 - 0.8 * h) * random.next();
        let p = [along(), along()];
        let square = |q: &[f64; 2]| {
            let (x, y) = (q[0] - p[0], q[1] - p[1]);
            x * x + y * y
        };
        if points.iter().all(|q| square(q) > near) {
            points.push(p);
        }
    }
    let mesh = delaunay(&points, 1e-9 * h * h);
    let points = points.iter();
    let points = points.map(|&[x, y]| Point::new(x * side_m, y * side_m, 0.0));
    let positions = Positions::new(points).expect("a sheet's coordinates are finite");
    (mesh, positions)
}

/// Returns a wavy sheet over the unit square: the Delaunay triangles of a grid of `cells` × `cells` cells, whose inner
/// points are moved at random by up to 0.4 cells along each axis.
///
/// # Panics
///
/// If `cells` is 0 or more than a mesh can have.
#[must_use]
pub fn wavy(cells: u32) -> (Mesh, Positions) {
    let mut random = Random::new(SEED);
    let width = cells + 1;
    let points = (0..width * width).map(|i| {
        let place = [i % width, i / width];
        let is_inner = place.iter().all(|i| ![0, cells].contains(i));
        let mut moved = || match is_inner {
            true => 0.8 * random.next() - 0.4,
            false => 0.0,
        };
        place.map(|i| (f64::from(i) + moved()) / f64::from(cells))
    });
    let points: Vec<[f64; 2]> = points.collect();
    let cell = 1.0 / f64::from(cells);
    let mesh = delaunay(&points, 1e-9 * cell * cell);
    let wave = points.iter();
    let wave = wave.map(|&[x, y]| Point::new(x, y, 0.1 * (9.0 * x + 4.0 * y).sin()));
    let positions = Positions::new(wave).expect("a sheet's coordinates are finite");
    (mesh, positions)
}

/// Returns the scissor that cuts a [`wavy`] sheet through from above, along the line through a point of the unit
/// square at this angle in radians.
///
/// # Panics
///
/// If a coordinate or the angle is not finite.
#[must_use]
pub fn through([x, y]: [f64; 2], angle_rad: f64) -> Scissor {
    let (sin, cos) = angle_rad.sin_cos();
    let ray = |along: f64| {
        let origin = Point::new(x + along * cos, y + along * sin, 5.0);
        Ray::new(origin, -Vector::z()).expect("the z axis is a direction")
    };
    let scissor = Scissor::new(ray(-2.0), ray(2.0)).expect("the rays are on two lines");
    scissor.with_through(true)
}

/// A system at rest of points with masses, tied by springs: their two ends and their rest length in metres.
pub(crate) fn system(
    points: &[Point],
    masses: Vec<f64>,
    springs: impl Iterator<Item = ([usize; 2], f64)>,
    stiffness_n_per_m: f64,
) -> System {
    let system = System::new(points.iter().copied(), masses);
    let mut system = system.expect("the points and masses are usable");
    for (ends, rest_m) in springs {
        let made = system.stretch(ends, rest_m, stiffness_n_per_m);
        made.expect("a spring has a length");
    }
    system
}

/// The indices of the free particles of a system, each with a random vector of at most `most` along each axis.
pub(crate) fn random_vectors(system: &System, most: f64) -> Vec<(usize, Vector)> {
    let mut random = Random::new(SEED);
    let mut along = || most * (2.0 * random.next() - 1.0);
    let free = (0..system.positions().len()).filter(|&i| !system.is_held(i));
    let vectors = free.map(|i| (i, Vector::new(along(), along(), along())));
    vectors.collect()
}

/// The Delaunay triangles of some points, without those of which twice the area is at most `area_min`, as
/// points in a row on the border may leave.
pub(crate) fn delaunay(points: &[[f64; 2]], area_min: f64) -> Mesh {
    let named: Vec<delaunator::Point> = points.iter().map(|&p| p.into()).collect();
    let triangles = delaunator::triangulate(&named).triangles;
    // They come clockwise, seen with y up.
    let triangles = triangles.chunks_exact(3).map(|t| [t[0], t[2], t[1]]);
    let triangles = triangles.filter(|t| {
        let [a, b, c] = t.map(|v| points[v]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > area_min
    });
    let triangles: Vec<[u32; 3]> = triangles.map(|t| t.map(|v| v as u32)).collect();
    Mesh::build(points.len(), &triangles).expect("Delaunay triangles are a manifold")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_have_the_mass_of_their_area_and_no_needles() {
        for kind in MeshKind::ALL {
            for cells in [4, 8, 16] {
                let sheet = Sheet::new(kind, cells, 2.0);
                let count = (cells as usize + 1) * (cells as usize + 1);
                assert_eq!(sheet.points.len(), count);
                let mass = sheet.masses.iter().sum::<f64>();
                assert!((mass - 4.0 * DENSITY_KG_PER_M2).abs() < 1e-12, "{mass}");
                // Euler: V − E + F = 1, and 3F = 2E − B with 4n edges on the border.
                let edges = 3 * count - 3 - 4 * cells as usize;
                assert_eq!(sheet.edges.len(), edges, "{kind:?} {cells}");
                let shortest = sheet.edges.iter().map(|&ends| sheet.length_m(ends));
                let shortest = shortest.fold(f64::INFINITY, f64::min);
                assert!(shortest > 0.39 * 2.0 / f64::from(cells), "{kind:?} {cells}");
            }
        }
    }
}

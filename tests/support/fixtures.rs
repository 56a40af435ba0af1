//! A ray and a box, for scenes that are played by the library and by the command.

use tearmesh::{Point, Ray, Vector};

/// A ray down at a place of a sheet in the plane z = 0.
pub(crate) fn ray(x: f64, y: f64) -> Ray {
    Ray::new(Point::new(x, y, 5.0), -Vector::z()).expect("a ray")
}

/// The points and the triangles of a box.
pub(crate) fn block(low: [f64; 3], high: [f64; 3]) -> (Vec<Point>, Vec<[u32; 3]>) {
    let corner = |i: usize| Point::from([0, 1, 2].map(|axis| [low, high][i >> axis & 1][axis]));
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = sides.into_iter();
    let halves = halves.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    ((0..8).map(corner).collect(), halves.collect())
}

//! The strip that is torn.

use tearmesh::{Mesh, Point, Positions};

/// The width and the height of the strip, in metres.
pub const STRIP_M: [f64; 2] = [0.1, 0.2];

/// The factor on the strength of the tips of a tear, as in
/// [`Tearing::weakening`](tearmesh_cloth::Tearing::weakening).
pub const TIP: f64 = 0.5;

/// A strip whose diagonals lie in turn; cells are square.
pub(super) fn strip(cells: u32) -> Option<(Mesh, Positions)> {
    let [width, height] = STRIP_M;
    let rows = (f64::from(cells) * height / width).round() as u32;
    let n = cells + 1;
    let points = (0..n * (rows + 1)).map(|i| {
        let x = f64::from(i % n) / f64::from(cells) * width;
        let y = f64::from(i / n) / f64::from(rows) * height;
        Point::new(x, y, 0.0)
    });
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..cells {
            let a = j * n + i;
            let (b, c, d) = (a + 1, a + n + 1, a + n);
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    let mesh = Mesh::build((n * (rows + 1)) as usize, &triangles).ok()?;
    Some((mesh, Positions::new(points).ok()?))
}

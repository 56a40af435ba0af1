//! The meshes of combinations: about a metre wide, with 30 to 100 faces, above the colliders.

use tearmesh::{CutMethod, Edits, Mesh, Positions, Scissor};

use crate::random::Random;
use crate::support::fixtures::ray;

/// A mesh, and where things are done to it.
#[derive(Clone)]
pub(super) struct Shape {
    pub(super) mesh: Mesh,
    pub(super) positions: Positions,
    /// The height of its upper edge, in metres.
    pub(super) top_m: f64,
    /// The ends of a cut along z, as x and y. It leads through the upper edge, and so through what is held there.
    pub(super) slit: [[f64; 2]; 2],
    /// The vertex that a hand takes, which nothing holds.
    pub(super) hand: usize,
    /// The two sides of each seam.
    pub(super) sides: Vec<[Vec<usize>; 2]>,
}

/// The ends of the cut in a mesh that is torn, along z, as x and y.
pub(super) const TORN: [[f64; 2]; 2] = [[0.31, 0.72], [0.77, 0.81]];

/// Points and triangles.
type Triangles = (Vec<[f64; 3]>, Vec<[u32; 3]>);

impl Shape {
    /// The shape of a level of the factor `mesh`.
    pub(super) fn of(level: &str) -> Shape {
        let (points, faces) = match level {
            "flat" | "torn" => grid(&EVEN, &EVEN, 0.0, |i, j| (i + j) % 2 == 0),
            "folded" => folded(),
            "uneven" => uneven(),
            "soup" => soup(),
            "panels" => panels(),
            other => panic!("no mesh is called {other}"),
        };
        let mut mesh = Mesh::build(points.len(), &faces).expect("a mesh");
        let mut positions = Positions::new(points.iter().copied()).expect("finite");
        if level == "torn" {
            let [a, b] = TORN.map(|[x, y]| ray(x, y));
            let scissor = Scissor::new(a, b).expect("a plane");
            let mut edits = Edits::new();
            let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
            cut.expect("a cut");
        }
        let is_garment = level == "panels";
        let middle = if is_garment { [0.5, 0.1] } else { [0.5, 0.3] };
        let away = |p: &[f64; 3]| (p[0] - middle[0]).hypot(p[1] - middle[1]);
        let near = (0..points.len()).min_by(|&a, &b| away(&points[a]).total_cmp(&away(&points[b])));
        let side = |first: usize, by: usize| (first..).step_by(by).take(4).collect::<Vec<_>>();
        Shape {
            mesh,
            positions,
            top_m: if is_garment { 0.4 } else { 1.0 },
            slit: match is_garment {
                true => [[0.47, 0.15], [0.53, 0.46]],
                false => [[0.41, 0.32], [0.57, 1.08]],
            },
            hand: near.expect("a vertex"),
            sides: match is_garment {
                true => vec![[side(0, 4), side(16, 4)], [side(3, 4), side(19, 4)]],
                false => Vec::new(),
            },
        }
    }
}

impl Shape {
    /// The mesh as an OBJ file.
    pub(super) fn obj(&self) -> String {
        let points = self.positions.as_slice().iter();
        let vertices = points.map(|p| format!("v {:?} {:?} {:?}\n", p.x, p.y, p.z));
        let faces = self.mesh.indices().as_chunks::<3>().0.iter();
        let faces = faces.map(|face| {
            let [a, b, c] = face.map(|v| v + 1);
            format!("f {a} {b} {c}\n")
        });
        vertices.chain(faces).collect()
    }
}

/// Six cells of a metre.
const EVEN: [f64; 7] = [0.0, 0.16, 0.34, 0.5, 0.67, 0.84, 1.0];

/// A sheet with these columns and rows, upright.
fn grid(columns: &[f64], rows: &[f64], z: f64, rising: impl Fn(usize, usize) -> bool) -> Triangles {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for &y in rows {
        points.extend(columns.iter().map(|&x| [x, y, z]));
    }
    let width = columns.len() as u32;
    for j in 0..rows.len() - 1 {
        for i in 0..columns.len() - 1 {
            let a = j as u32 * width + i as u32;
            let [b, c, d] = [a + 1, a + width, a + width + 1];
            faces.extend(match rising(i, j) {
                true => [[a, b, d], [a, d, c]],
                false => [[a, b, c], [c, b, d]],
            });
        }
    }
    (points, faces)
}

/// A sheet whose lower half is folded forward by a right angle.
fn folded() -> Triangles {
    let (points, faces) = grid(&EVEN, &EVEN, 0.0, |i, j| (i + j) % 2 == 0);
    let fold = |[x, y, z]: [f64; 3]| match y < 0.5 {
        true => [x, 0.5, 0.5 - y],
        false => [x, y, z],
    };
    (points.into_iter().map(fold).collect(), faces)
}

/// A sheet with narrow and wide cells, off the grid and out of the plane, with random diagonals.
fn uneven() -> Triangles {
    let columns = [0.0, 0.08, 0.25, 0.5, 0.6, 0.85, 1.0];
    let rows = [0.0, 0.2, 0.3, 0.55, 0.8, 1.0];
    let mut random = Random(7);
    let rising: Vec<bool> = (0..64).map(|_| random.below(2) == 0).collect();
    let (mut points, faces) = grid(&columns, &rows, 0.0, |i, j| rising[8 * j + i]);
    for [x, y, z] in &mut points {
        let mut off = || random.next() - 0.5;
        if *x > 0.0 && *x < 1.0 && *y > 0.0 && *y < 1.0 {
            (*x, *y) = (*x + 0.05 * off(), *y + 0.05 * off());
        }
        *z += 0.03 * off();
    }
    (points, faces)
}

/// Triangles that share no vertex.
fn soup() -> Triangles {
    let (points, faces) = grid(
        &[0.0, 0.26, 0.5, 0.74, 1.0],
        &[0.0, 0.3, 0.6, 1.0],
        0.0,
        |i, j| (i + j) % 2 == 0,
    );
    let apart = faces.as_flattened().iter().map(|&v| points[v as usize]);
    let numbers = (0..3 * faces.len() as u32).collect::<Vec<_>>();
    (apart.collect(), numbers.as_chunks().0.to_vec())
}

/// A front and a back of four columns and rows; the sides of the back are longer.
fn panels() -> Triangles {
    let columns = [0.35, 0.45, 0.55, 0.65];
    let (mut points, mut faces) = grid(&columns, &[0.0, 0.13, 0.27, 0.4], 0.03, |_, _| false);
    let (back, others) = grid(&columns, &[-0.02, 0.12, 0.26, 0.4], -0.03, |_, _| false);
    let first = points.len() as u32;
    points.extend(back);
    // The back shows its other side.
    faces.extend(
        others
            .iter()
            .map(|&[a, b, c]| [first + a, first + c, first + b]),
    );
    (points, faces)
}

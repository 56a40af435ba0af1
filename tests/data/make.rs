//! Makes the meshes of this folder: `cargo run --example make_test_data` from the root.
//!
//! Each stands for a kind of file that users have. Coordinates are rounded to six decimals, so
//! that the files do not depend on the last bit of anybody's sine.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

fn main() -> io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for (name, text) in [
        ("flag", flag()),
        ("sheet", sheet()),
        ("sleeve", sleeve()),
        ("quilt", quilt()),
    ] {
        fs::write(folder.join(name).with_extension("obj"), text)?;
    }
    Ok(())
}

/// A waving flag, two by two, in 32 × 32 cells with texture coordinates; the pole is at x = −1.
fn flag() -> String {
    let mut obj = String::from("# a waving flag\no flag\n");
    let cells = 32;
    let step = |i: usize| i as f64 / cells as f64;
    grid(cells, |i, j| {
        let (u, v) = (step(i), step(j));
        let z = 0.25 * u * (1.5 * TAU * u - 0.4 * PI * v).sin();
        vertex(&mut obj, [2.0 * u - 1.0, 2.0 * v - 1.0, z]);
    });
    grid(cells, |i, j| {
        writeln!(obj, "vt {} {}", step(i), step(j)).expect("a string grows");
    });
    obj.push_str("usemtl cloth\n");
    let number = |i: usize, j: usize| j * (cells + 1) + i + 1;
    grid(cells - 1, |i, j| {
        let (a, b) = (number(i, j), number(i + 1, j));
        let (c, d) = (number(i + 1, j + 1), number(i, j + 1));
        for [a, b, c] in [[a, b, c], [a, c, d]] {
            writeln!(obj, "f {a}/{a} {b}/{b} {c}/{c}").expect("a string grows");
        }
    });
    obj
}

/// A flat sheet of random points in the unit square, triangulated by Delaunay.
fn sheet() -> String {
    let mut random = Random(2014);
    let mut points: Vec<[f64; 2]> = Vec::new();
    for i in 0..20 {
        let along = f64::from(i) / 20.0;
        points.extend([
            [along, 0.0],
            [1.0, along],
            [1.0 - along, 1.0],
            [0.0, 1.0 - along],
        ]);
    }
    while points.len() < 600 {
        let point = [0.01 + 0.98 * random.next(), 0.01 + 0.98 * random.next()];
        // Not as even as a mesher would do it, but without needles.
        if points
            .iter()
            .all(|p| (p[0] - point[0]).hypot(p[1] - point[1]) > 0.015)
        {
            points.push(point);
        }
    }
    let mut obj = String::from("# an irregular sheet\n");
    for [x, y] in &points {
        vertex(&mut obj, [*x, *y, 0.0]);
    }
    for [a, b, c] in delaunay(&points) {
        writeln!(obj, "f {} {} {}", a + 1, b + 1, c + 1).expect("a string grows");
    }
    obj
}

/// A sleeve: a bent tube with two boundary loops, whose texture has a seam.
fn sleeve() -> String {
    let (around, along) = (24, 30);
    let mut obj = String::from("# a sleeve, open at both ends\no sleeve\n");
    for ring in 0..=along {
        let t = ring as f64 / along as f64;
        for i in 0..around {
            let (y, x) = (TAU * i as f64 / around as f64).sin_cos();
            let radius = 0.16 - 0.05 * t;
            let bend = 0.15 * (PI * t).sin();
            vertex(&mut obj, [radius * x + bend, radius * y, t]);
        }
    }
    for ring in 0..=along {
        for i in 0..=around {
            let (u, v) = (i as f64 / around as f64, ring as f64 / along as f64);
            writeln!(obj, "vt {u:.6} {v:.6}").expect("a string grows");
        }
    }
    obj.push_str("s 1\n");
    for ring in 0..along {
        for i in 0..around {
            let corner = |i: usize, ring: usize| {
                format!(
                    "{}/{}",
                    ring * around + i % around + 1,
                    ring * (around + 1) + i + 1
                )
            };
            let (a, b) = (corner(i, ring), corner(i + 1, ring));
            let (c, d) = (corner(i + 1, ring + 1), corner(i, ring + 1));
            writeln!(obj, "f {a} {b} {c}\nf {a} {c} {d}").expect("a string grows");
        }
    }
    obj
}

/// Two objects of quads and a hexagon, with normals, groups, materials and comments.
fn quilt() -> String {
    let mut obj = String::from("# a quilt of two objects\nmtllib quilt.mtl\nvn 0 0 1\n");
    let cells = 6;
    for (patch, shift) in [("left", -1.0), ("right", 0.5)] {
        writeln!(obj, "o {patch}").expect("a string grows");
        grid(cells, |i, j| {
            let (x, y) = (i as f64 / cells as f64, j as f64 / cells as f64);
            vertex(&mut obj, [x + shift, y, 0.1 * (PI * x).sin()]);
        });
        let first = if patch == "left" {
            1
        } else {
            (cells + 1) * (cells + 1) + 1
        };
        let number = |i: usize, j: usize| first + j * (cells + 1) + i;
        grid(cells - 1, |i, j| {
            if i == 0 {
                let material = if j % 2 == 0 { "red cloth" } else { "blue" };
                writeln!(obj, "g row{j} {patch}\nusemtl {material}").expect("a string grows");
            }
            // The first two cells of the top row make one hexagon.
            let polygon = match (i, j == cells - 1) {
                (0, true) => vec![(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)],
                (1, true) => return,
                _ => vec![(0, 0), (1, 0), (1, 1), (0, 1)],
            };
            obj.push('f');
            for (right, up) in polygon {
                write!(obj, " {}//1", number(i + right, j + up)).expect("a string grows");
            }
            obj.push('\n');
        });
    }
    obj
}

/// Visits (i, j) for 0 <= i, j <= last, row by row.
fn grid(last: usize, mut visit: impl FnMut(usize, usize)) {
    for j in 0..=last {
        for i in 0..=last {
            visit(i, j);
        }
    }
}

fn vertex(obj: &mut String, position: [f64; 3]) {
    // Adding zero turns −0 into 0.
    let [x, y, z] = position.map(|x| (x * 1e6).round() / 1e6 + 0.0);
    writeln!(obj, "v {x} {y} {z}").expect("a string grows");
}

/// Delaunay triangles by Bowyer and Watson's insertion, counter-clockwise; O(n²).
fn delaunay(points: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let n = points.len();
    let mut all = points.to_vec();
    all.extend([[-50.0, -40.0], [50.0, -40.0], [0.5, 60.0]]);
    let mut triangles = vec![[n, n + 1, n + 2]];
    for p in 0..n {
        let (hit, kept): (Vec<_>, Vec<_>) = triangles
            .into_iter()
            .partition(|&t| in_circle(t.map(|i| all[i]), all[p]));
        triangles = kept;
        let edges: Vec<[usize; 2]> = hit
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .collect();
        for &[a, b] in edges.iter().filter(|&&[a, b]| !edges.contains(&[b, a])) {
            triangles.push([a, b, p]);
        }
    }
    // Points in a row on the border leave triangles without area; those go too.
    triangles.retain(|t| t.iter().all(|&i| i < n) && double_area(t.map(|i| all[i])) > 1e-9);
    triangles
}

fn double_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn in_circle(triangle: [[f64; 2]; 3], p: [f64; 2]) -> bool {
    let [a, b, c] = triangle.map(|q| [q[0] - p[0], q[1] - p[1]]);
    let square = |q: [f64; 2]| q[0] * q[0] + q[1] * q[1];
    let minor = |q: [f64; 2], r: [f64; 2]| q[0] * r[1] - q[1] * r[0];
    square(a) * minor(b, c) + square(b) * minor(c, a) + square(c) * minor(a, b) > 0.0
}

/// A small generator (splitmix64), so that the sheet is the same for ever.
struct Random(u64);

impl Random {
    /// A number from 0 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

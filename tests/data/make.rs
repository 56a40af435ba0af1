//! Makes the meshes of this folder: `cargo run --example make_test_data` from the root.
//!
//! Each stands for a kind of file that users have. Coordinates are rounded to six decimals, so
//! that the files do not depend on the last bit of anybody's sine.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

#[path = "../support/delaunay.rs"]
mod delaunay;
#[path = "../support/random.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod random;

use random::Random;

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
    let points = delaunay::points(600, 20, 0.015, &mut Random(2014));
    let mut obj = String::from("# an irregular sheet\n");
    for [x, y] in &points {
        vertex(&mut obj, [*x, *y, 0.0]);
    }
    for [a, b, c] in delaunay::triangles(&points) {
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

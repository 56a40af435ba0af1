//! Generated OBJ files: a waving sheet of a grid, in the dialects that programs write.

use std::fmt::Write as _;

/// A dialect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dialect {
    /// `v` with six decimals, `f 1 2 3`.
    Plain,
    /// `v` with all digits of an `f64`, `f 1 2 3`.
    FullDigits,
    /// `v` and `vt` with six decimals, `f 1/1 2/2 3/3`.
    Texture,
    /// `v`, `vt` and `vn` with six decimals, `f 1/1/1 2/2/2 3/3/3`.
    TextureAndNormals,
    /// `v` with six decimals, `f 1 2 3 4`.
    Quads,
}

impl Dialect {
    pub(crate) const ALL: [Dialect; 4] = [
        Dialect::Plain,
        Dialect::FullDigits,
        Dialect::TextureAndNormals,
        Dialect::Quads,
    ];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Dialect::Plain => "v f, triangles, six decimals",
            Dialect::FullDigits => "v f, triangles, all 17 digits",
            Dialect::Texture => "v/vt, triangles, six decimals",
            Dialect::TextureAndNormals => "v/vt/vn, triangles, six decimals",
            Dialect::Quads => "v f, quads, six decimals",
        }
    }
}

/// How many cells a side has of a square sheet of about so many faces.
pub(crate) fn cells(faces: usize, per_cell: usize) -> usize {
    ((faces as f64 / per_cell as f64).sqrt().round() as usize).max(1)
}

/// A generated file.
pub(crate) struct Sheet {
    pub(crate) dialect: Dialect,
    pub(crate) text: String,
    pub(crate) vertices: usize,
    /// The number of `f` statements.
    pub(crate) faces: usize,
}

impl Sheet {
    /// A square sheet of about so many faces.
    pub(crate) fn new(dialect: Dialect, faces: usize) -> Sheet {
        let per_cell = if dialect == Dialect::Quads { 1 } else { 2 };
        let cells = cells(faces, per_cell);
        let mut text = String::from("o sheet\n");
        let points =
            || (0..=cells).flat_map(move |row| (0..=cells).map(move |column| (row, column)));
        let share = |i: usize| i as f64 / cells as f64;
        let mut line = |arguments: std::fmt::Arguments<'_>| {
            text.write_fmt(arguments).expect("a string takes all");
            text.push('\n');
        };
        for (row, column) in points() {
            let (x, y) = (1.7 * share(column) - 0.85, 1.3 * share(row) - 0.65);
            let z = 0.1 * (9.0 * x + 4.0 * y).sin();
            match dialect {
                Dialect::FullDigits => line(format_args!("v {x} {y} {z}")),
                _ => line(format_args!("v {x:.6} {y:.6} {z:.6}")),
            }
        }
        if matches!(dialect, Dialect::Texture | Dialect::TextureAndNormals) {
            for (row, column) in points() {
                line(format_args!("vt {:.6} {:.6}", share(column), share(row)));
            }
        }
        if dialect == Dialect::TextureAndNormals {
            for (row, column) in points() {
                let slope = 0.9 * (9.0 * share(column) + 4.0 * share(row)).cos();
                let length = (1.0 + slope * slope).sqrt();
                line(format_args!(
                    "vn {:.6} 0.000000 {:.6}",
                    -slope / length,
                    1.0 / length
                ));
            }
        }
        for (row, column) in points().filter(|&(row, column)| row < cells && column < cells) {
            let a = row * (cells + 1) + column + 1;
            let (b, c, d) = (a + 1, a + cells + 2, a + cells + 1);
            match dialect {
                Dialect::Plain | Dialect::FullDigits => {
                    line(format_args!("f {a} {b} {c}"));
                    line(format_args!("f {a} {c} {d}"));
                }
                Dialect::Texture => {
                    line(format_args!("f {a}/{a} {b}/{b} {c}/{c}"));
                    line(format_args!("f {a}/{a} {c}/{c} {d}/{d}"));
                }
                Dialect::TextureAndNormals => {
                    line(format_args!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}"));
                    line(format_args!("f {a}/{a}/{a} {c}/{c}/{c} {d}/{d}/{d}"));
                }
                Dialect::Quads => line(format_args!("f {a} {b} {c} {d}")),
            }
        }
        Sheet {
            dialect,
            text,
            vertices: (cells + 1) * (cells + 1),
            faces: per_cell * cells * cells,
        }
    }
}

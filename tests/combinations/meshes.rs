//! The meshes of a row, as files: of some 50 to 250 faces, with values at their corners that are a function of
//! the place.

use std::fmt::Write as _;

use tearmesh::{Edits, shapes, tear};
use tearmesh_obj::{Document, TornDocument};

use crate::oracle::straight::Surface;
use crate::random::Random;
use crate::surfaces::{delaunay, doubled, sphere, surface, unsewn};
use crate::table::Levels;

type Point = [f64; 3];

/// A mesh to be cut, and what is known of it.
pub(crate) struct Start {
    pub(crate) file: String,
    pub(crate) surface: Surface,
    /// Whether it lies in one plane, in one layer.
    pub(crate) is_flat: bool,
    /// Its longest extent.
    pub(crate) size: f64,
}

impl Start {
    pub(crate) fn of(levels: &Levels, random: &mut Random) -> Start {
        let mesh = levels.of("mesh");
        let mut surface = shape(mesh, random);
        let is_flat = !["closed", "tube", "parts", "double-sided"].contains(&mesh);
        let size = match mesh {
            "tiny" => 1e-6,
            _ => 1.0,
        };
        let offset = match mesh {
            "far" => [1e5, -2e5, 3e5],
            _ => [0.0; 3],
        };
        for p in &mut surface.points {
            *p = [0, 1, 2].map(|i| size * p[i] + offset[i]);
        }
        let mut file = file(&surface, levels, offset, size);
        if levels.of("history") == "torn" {
            file = torn(&file, random);
        }
        Start {
            file,
            surface,
            is_flat,
            size,
        }
    }
}

fn shape(mesh: &str, random: &mut Random) -> Surface {
    let irregular = |random: &mut Random| delaunay(70, 6, random);
    match mesh {
        "grid" => surface(&shapes::grid(8, 8)),
        "closed" => sphere(2),
        "tube" => surface(&shapes::tube(11, 6)),
        "parts" => {
            let mut both = surface(&shapes::grid(6, 6));
            let mut behind = irregular(random);
            behind.points.iter_mut().for_each(|p| p[2] -= 0.3);
            let first = both.points.len() as u32;
            both.points.append(&mut behind.points);
            let faces = behind.faces.iter().map(|face| face.map(|v| v + first));
            both.faces.extend(faces);
            both
        }
        "soup" => unsewn(&irregular(random), 1.0, random),
        "seam" => unsewn(&irregular(random), 0.0, random),
        "double-sided" => doubled(&surface(&shapes::grid(6, 6))),
        "hub" => surface(&shapes::fan(60, true)),
        "slivers" => {
            let mut grid = surface(&shapes::grid(10, 6));
            for [x, ..] in &mut grid.points {
                // Every second column is a hundredth as wide as the one beside it.
                let column = (10.0 * *x).round();
                *x = (column / 2.0).floor() / 5.0 + if column % 2.0 == 1.0 { 0.198 } else { 0.0 };
            }
            grid
        }
        "irregular" | "far" | "tiny" => irregular(random),
        _ => unreachable!("{mesh} is no mesh"),
    }
}

/// The texture coordinates of a place on one side of the seam of textures.
pub(crate) fn uv(p: Point, is_beyond: bool) -> [f64; 2] {
    let island = if is_beyond { 10.0 } else { 0.0 };
    [
        0.3 * p[0] + 0.1 * p[1] - 0.2 * p[2] + island,
        0.2 * p[0] - 0.4 * p[1] + 0.1 * p[2],
    ]
}

/// The normals on both sides of the seam of textures.
pub(crate) const NORMALS: [Point; 2] = [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]];

/// Whether texture coordinates and normals jump along a line.
pub(crate) fn has_seam(levels: &Levels) -> bool {
    levels.is("mesh", "seam closed double-sided far")
}

/// A file with the values of the row at the corners of its faces.
fn file(surface: &Surface, levels: &Levels, offset: Point, size: f64) -> String {
    let attributes = levels.of("attributes");
    let has_uv = ["uv", "both"].contains(&attributes);
    let has_normals = ["normals", "both"].contains(&attributes);
    let has_seam = has_seam(levels);
    let mut text = String::new();
    for [x, y, z] in &surface.points {
        writeln!(text, "v {x} {y} {z}").expect("text");
    }
    if has_uv {
        for is_beyond in [false, true] {
            for &p in &surface.points {
                let [u, v] = uv(p, is_beyond);
                writeln!(text, "vt {u} {v}").expect("text");
            }
        }
    }
    if has_normals {
        for [x, y, z] in NORMALS {
            writeln!(text, "vn {x} {y} {z}").expect("text");
        }
    }
    for face in &surface.faces {
        let middle = face.iter().map(|&v| surface.points[v as usize][0] / 3.0);
        let is_beyond = has_seam && middle.sum::<f64>() - offset[0] > 0.45 * size;
        text += "f";
        for &v in face {
            let place = v as usize + 1;
            let texture = place + if is_beyond { surface.points.len() } else { 0 };
            let normal = 1 + usize::from(is_beyond);
            match (has_uv, has_normals) {
                (false, false) => write!(text, " {place}"),
                (true, false) => write!(text, " {place}/{texture}"),
                (false, true) => write!(text, " {place}//{normal}"),
                (true, true) => write!(text, " {place}/{texture}/{normal}"),
            }
            .expect("text");
        }
        text += "\n";
    }
    text
}

/// The file of a mesh that cloth tore: some edges, and those beside their ends.
fn torn(file: &str, random: &mut Random) -> String {
    let document = Document::read(file.as_bytes()).expect("a file of ours");
    let mut mesh = document.mesh().expect("a mesh");
    let points = document.positions().iter().copied();
    let mut positions = tearmesh::Positions::new(points).expect("finite");
    let mut torn = TornDocument::new(&document);
    let mut edits = Edits::new();
    for _ in 0..200 {
        let h = mesh.half_edge(random.below(mesh.half_edge_count()));
        if mesh.pair(h).is_some() {
            let _ = tear::edge(&mut mesh, h, &positions, |_| Some(1.0), &mut edits);
            edits.replay(&mut (&mut positions, &mut torn));
            edits.clear();
        }
        if mesh
            .half_edges()
            .filter(|&h| mesh.ghost_pair(h).is_some())
            .count()
            >= 8
        {
            break;
        }
    }
    let mut out = Vec::new();
    let written = torn.write(&mesh, &positions, &mut out);
    written.expect("memory takes all that is written");
    String::from_utf8(out).expect("text")
}

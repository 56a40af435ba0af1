//! The seam of a cut as lines of OBJ.

use std::io::{self, Write};

use tearmesh::{Cut, Mesh, Point, Positions, VertexId};

/// A line of a cut, as it was when the cut was made: later cuts divide its faces.
pub(super) struct Line {
    points: Vec<Point>,
    /// Whether it goes on from its last point to its first.
    is_closed: bool,
}

/// The lines of a cut.
pub(super) fn lines(cut: &Cut, mesh: &Mesh, positions: &Positions) -> Vec<Line> {
    let lines = cut.seam().map(|line| {
        let fronts = line.lips.iter().map(|&[front, _]| front);
        let mut vertices: Vec<VertexId> = fronts.clone().map(|h| mesh.origin(h)).collect();
        let end = fronts.map(|h| mesh.target(h)).next_back();
        let root = |v: Option<VertexId>| v.map(|v| mesh.root(v));
        let is_closed = root(vertices.first().copied()) == root(end);
        vertices.extend(end.filter(|_| !is_closed));
        let points = vertices.into_iter().map(|v| positions.at(v)).collect();
        Line { points, is_closed }
    });
    lines.collect()
}

/// Writes an object for each cut that tore something.
pub(super) fn write(seams: &[Vec<Line>], out: &mut dyn Write) -> io::Result<()> {
    let mut before = 0;
    let some = seams.iter().zip(1..);
    for (seam, number) in some.filter(|(seam, _)| !seam.is_empty()) {
        writeln!(out, "o seam_{number}")?;
        for line in seam {
            for p in &line.points {
                writeln!(out, "v {} {} {}", p.x, p.y, p.z)?;
            }
            let first = before + 1;
            before += line.points.len();
            let back = line.is_closed.then_some(first);
            write!(out, "l")?;
            for point in (first..=before).chain(back) {
                write!(out, " {point}")?;
            }
            writeln!(out)?;
        }
    }
    Ok(())
}

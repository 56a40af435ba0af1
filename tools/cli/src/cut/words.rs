//! What is said of a cut.

use tearmesh::{CutReport, Ledger, Mesh};

use super::files::Destination;
use crate::say::{Fault, count};

/// The line of the summary on a cut; cuts have numbers where there are several.
pub(super) fn cut(number: Option<usize>, cut: &CutReport) -> String {
    let name = number.map_or_else(|| "cut".to_owned(), |number| format!("cut {number}"));
    format!(
        "{name}: {} crossed, {} split ({} refused), {} -> {}",
        count(cut.faces_crossed, "face", "faces"),
        count(cut.splits, "vertex", "vertices"),
        cut.refused,
        count(cut.pieces_before, "piece", "pieces"),
        count(cut.pieces, "piece", "pieces"),
    )
}

/// What a cut fell short of.
pub(super) fn warnings(number: Option<usize>, through: bool, cut: &CutReport) -> Vec<Fault> {
    let mut warnings = Vec::new();
    let mut warn = |code, message: String| {
        let of = number
            .map(|number| format!("cut {number}: "))
            .unwrap_or_default();
        warnings.push(Fault::warning(code, format!("{of}{message}")));
    };
    if cut.missed {
        let place = if through {
            "on the plane"
        } else {
            "between the rays"
        };
        let away = short(cut.nearest_vertex);
        warn(
            "W-CUT-MISS",
            format!("no face lies {place}; the nearest vertex is {away} away"),
        );
    } else if cut.splits == 0 {
        let faces = count(cut.faces_crossed, "face", "faces");
        warn(
            "W-CUT-NONE",
            format!("the cut crosses {faces}, but no vertex could be split"),
        );
    } else {
        if cut.crumbs > 0 {
            let crumbs = count(cut.crumbs, "piece", "pieces");
            warn(
                "W-CUT-CRUMBS",
                format!("{crumbs} came loose beside the cut"),
            );
        }
        if cut.lost > 0 {
            let lost = count(cut.lost, "piece", "pieces");
            let message =
                format!("{lost} stayed joined: the mesh has no edges for the cut to follow");
            warn("W-CUT-LOST", message);
        }
        if !cut.separated {
            warn(
                "W-CUT-JOINED",
                "the sides still share a vertex between the rays".to_owned(),
            );
        }
    }
    warnings
}

/// The last line of the summary.
pub(super) fn ending(
    vertices_before: usize,
    mesh: &Mesh,
    ledger: &Ledger,
    destination: &Destination,
) -> String {
    let ending = match destination {
        Destination::Nowhere { why } => (*why).to_owned(),
        Destination::Output => "wrote standard output".to_owned(),
        Destination::File(path) => format!("wrote {}", path.display()),
    };
    format!(
        "mass {} -> {} · vertices {vertices_before} -> {} · faces {} · invariants hold · {ending}",
        short(ledger.before.to_f64()),
        short(ledger.after.to_f64()),
        mesh.vertex_count(),
        mesh.face_count(),
    )
}

/// A number for people: six digits.
pub(super) fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}")
        .parse()
        .expect("a number that was just printed");
    if rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_for_people_have_six_digits() {
        for (x, text) in [
            (1.0, "1"),
            (0.0, "0"),
            (4.123_456_789, "4.12346"),
            (0.1 + 0.2, "0.3"),
            (1e-12, "1e-12"),
            (123_456_789.0, "123457000"),
            (1e300, "1e300"),
        ] {
            assert_eq!(short(x), text);
        }
    }
}

//! What is said of a cut.

use tearmesh::{Cut, CutReport};

use super::gap::Gapped;
use super::nothing::Obstacle;
use crate::say::{Fault, count, place, short};

/// The line of the summary on a cut; cuts have numbers where there are several.
pub(crate) fn cut(number: Option<usize>, cut: &CutReport) -> String {
    let name = number.map_or_else(|| "cut".to_owned(), |number| format!("cut {number}"));
    let inserted = match cut.vertices_inserted {
        0 => String::new(),
        inserted => count(inserted, "vertex", "vertices") + " inserted, ",
    };
    format!(
        "{name}: {} crossed, {inserted}{} split ({} refused), {} -> {}",
        count(cut.faces_crossed, "face", "faces"),
        count(cut.splits, "vertex", "vertices"),
        cut.refused,
        count(cut.pieces_before, "piece", "pieces"),
        count(cut.pieces, "piece", "pieces"),
    )
}

/// The line of the summary on a gap.
pub(crate) fn gap(gap: f64, gapped: &Gapped) -> String {
    let pieces = count(gapped.pieces, "piece", "pieces");
    let vertices = count(gapped.lips, "vertex", "vertices") + " along the cut";
    let what = match (gapped.pieces, gapped.lips) {
        (0, _) => vertices,
        (_, 0) => pieces,
        _ => format!("{pieces} and {vertices}"),
    };
    let up_to = if gapped.clamped > 0 { "up to " } else { "" };
    format!("gap: {what} moved apart by {up_to}{}", short(gap))
}

/// That the gap is narrower somewhere than was asked for.
pub(crate) fn of_gap(gapped: &Gapped) -> Option<Fault> {
    let vertices = count(gapped.clamped, "vertex", "vertices");
    let message = format!("{vertices} moved less than half the gap, to keep faces from flipping");
    (gapped.clamped > 0).then(|| Fault::warning("W-CUT-GAP", message))
}

/// That a cut through the first layers went through two, if it did.
pub(crate) fn of_layers(number: Option<usize>, cut: &Cut) -> Option<Fault> {
    let [one, other] = cut.layers().map(|hit| hit.map(|hit| hit.chain));
    let of = number.map_or_else(String::new, |number| format!("cut {number}: "));
    let message = format!("{of}the rays hit different layers of the mesh: both are cut");
    (one != other).then(|| Fault::warning("W-CUT-LAYERS", message))
}

/// What a cut fell short of; where it split nothing, `obstacle` says why.
pub(crate) fn warnings(
    number: Option<usize>,
    (through, is_exact): (bool, bool),
    cut: &CutReport,
    obstacle: Obstacle,
) -> Vec<Fault> {
    let mut warnings = Vec::new();
    let mut warn = |code, message: String| {
        let of = number
            .map(|number| format!("cut {number}: "))
            .unwrap_or_default();
        warnings.push(Fault::warning(code, format!("{of}{message}")));
    };
    if cut.missed {
        let where_to = if through {
            "on the plane"
        } else {
            "between the rays"
        };
        let why = match obstacle {
            Obstacle::Seam => ": it is already cut there".to_owned(),
            Obstacle::Touch => ": the cut only touches the mesh".to_owned(),
            _ if cut.nearest_vertex == 0.0 => ": the cut only touches the mesh".to_owned(),
            _ => format!("; the nearest vertex is {} away", short(cut.nearest_vertex)),
        };
        warn("W-CUT-MISS", format!("no face lies {where_to}{why}"));
    } else if cut.splits == 0 {
        let why = match obstacle {
            Obstacle::Seam => "but it is already cut there",
            Obstacle::Touch => "it only touches the mesh",
            Obstacle::Snap => "but is shorter than the snap: use --snap 0",
            Obstacle::Elsewhere { .. } | Obstacle::Unknown => "but no vertex could be split",
        };
        let faces = count(cut.faces_crossed, "face", "faces");
        warn("W-CUT-NONE", format!("the cut crosses {faces}, {why}"));
    } else {
        for neck in &cut.necks {
            let at = place(neck.at.into());
            let faces = count(neck.faces, "face", "faces");
            let width = short(neck.width);
            warn(
                "W-CUT-NECK",
                format!(
                    "a piece of {faces} came off at {at}: it hung on a neck {width} wide, which \
                     is narrower than the snap"
                ),
            );
        }
        let crumbs = cut.crumbs.saturating_sub(cut.necks.len());
        if crumbs > 0 {
            let crumbs = count(crumbs, "piece", "pieces");
            warn(
                "W-CUT-CRUMBS",
                format!("{crumbs} came loose beside the cut"),
            );
        }
        if cut.lost > 0 {
            let lost = count(cut.lost, "piece", "pieces");
            let why = if is_exact {
                "the part to cut off is smaller than the snap"
            } else {
                "the mesh has no edges for the cut to follow"
            };
            warn("W-CUT-LOST", format!("{lost} stayed joined: {why}"));
        }
        if !cut.separated {
            warn(
                "W-CUT-JOINED",
                "the two sides still share a vertex between the rays".to_owned(),
            );
        }
    }
    warnings
}

//! Closed polylines: what they go round comes out.

use tearmesh::{CutEnd, CutMethod, Edits, Scissor};

use crate::cases::cases_of;
use crate::exact::ray;
use crate::oracle::straight::Surface;
use crate::random::Random;
use crate::straight::{built, down};
use crate::straight_polylines::sheets;

/// The corners of a polygon about a point, in order round it, well inside the unit square.
fn polygon(random: &mut Random) -> Vec<[f64; 2]> {
    let count = 3 + random.below(4);
    let centre = [0.0; 2].map(|_: f64| 0.45 + 0.1 * random.next());
    let turn = random.next();
    let corner = |i: usize| {
        let part = (i as f64 + 0.7 * random.next()) / count as f64;
        let (sin, cos) = (std::f64::consts::TAU * (turn + part)).sin_cos();
        let far = 0.15 + 0.25 * random.next();
        [centre[0] + far * cos, centre[1] + far * sin]
    };
    (0..count).map(corner).collect()
}

/// The pieces that are there after a cut along a closed polyline.
fn pieces(sheet: &Surface, corners: &[[f64; 2]], snap: f64) -> usize {
    let (mut mesh, mut positions) = built(sheet);
    let mut edits = Edits::new();
    let rays: Vec<_> = corners.iter().map(|&corner| ray(down(corner))).collect();
    let mut ends: Option<[CutEnd; 2]> = None;
    for i in 0..rays.len() {
        let to = rays[(i + 1) % rays.len()];
        let scissor = match &mut ends {
            Some([first, last]) if i + 1 == rays.len() => {
                edits.replay(first);
                Scissor::closed(last, first, &positions)
            }
            Some([_, last]) => Scissor::continued(last, to, &positions),
            None => Scissor::new(rays[i], to),
        };
        let scissor = scissor.expect("a plane").snap(snap);
        let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
        let made = cut.expect("positions are in step").ends().cloned();
        let [begin, end] = made.expect("there are rays");
        ends = Some([ends.map_or(begin, |[first, _]| first), end]);
    }
    assert_eq!(mesh.check(), []);
    mesh.components().count()
}

/// Fails if more than `most` of a number of polygons, or as many as `TEARMESH_CASES` asks for if
/// those are fewer, stay open.
fn open_at_most(most: usize, snap: f64, count: u64) {
    let sheets = sheets();
    let mut random = Random(97);
    let mut open = 0;
    for i in 0..cases_of(count) {
        let corners = polygon(&mut random);
        let pieces = pieces(&sheets[i as usize % sheets.len()], &corners, snap);
        open += usize::from(pieces != 2);
        assert!(
            open <= most,
            "snap {snap}, {i}: {pieces} pieces by {corners:?}"
        );
    }
    println!("snap {snap}: {open} of {count} polygons stay open");
}

#[test]
fn every_closed_polyline_cuts_a_piece_out() {
    open_at_most(0, Scissor::SNAP, 5635);
}

#[test]
fn every_closed_polyline_cuts_a_piece_out_without_a_snap() {
    open_at_most(0, 0.0, 1000);
}

/// With a snap of a fifth of an edge a short side may be no more than a vertex.
#[test]
fn nearly_every_closed_polyline_cuts_a_piece_out_by_a_coarse_snap() {
    open_at_most(2, 0.2, 1000);
}

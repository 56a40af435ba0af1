//! Closed polylines: what they go round comes out.

use tearmesh::{CutEnd, CutLayers, CutMethod, Mesh, Scissor};

use crate::cases::cases;
use crate::oracle::straight::Surface;
use crate::random::Random;
use crate::surfaces::{doubled, sheets};
use crate::work::{Work, down, ray};

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

/// A sheet after a cut along a closed polyline.
fn cut_out(sheet: &Surface, corners: &[[f64; 2]], snap: f64, layers: CutLayers) -> Mesh {
    let mut work = Work::of(sheet);
    let rays: Vec<_> = corners.iter().map(|&corner| ray(down(corner))).collect();
    let mut ends: Option<[CutEnd; 2]> = None;
    for i in 0..rays.len() {
        let to = rays[(i + 1) % rays.len()];
        let scissor = match &mut ends {
            Some([first, last]) if i + 1 == rays.len() => {
                work.edits.replay(first);
                Scissor::closed(last, first, &work.positions)
            }
            Some([_, last]) => Scissor::continued(last, to, &work.positions),
            None => Scissor::new(rays[i], to),
        };
        let scissor = scissor
            .expect("a plane")
            .with_snap(snap)
            .with_layers(layers);
        let (mesh, positions) = (&mut work.mesh, &mut work.positions);
        let cut = scissor.cut(CutMethod::Exact, mesh, positions, &mut work.edits);
        let made = cut.expect("positions are in step").ends().cloned();
        let [begin, end] = made.expect("there are rays");
        ends = Some([ends.map_or(begin, |[first, _]| first), end]);
    }
    assert_eq!(work.mesh.check(), []);
    work.mesh
}

/// With a snap of a fifth of an edge a short side may be no more than a vertex. A flat sheet is a single layer, which
/// the rays meet first.
#[test]
fn closed_polylines_cut_a_piece_out() {
    let sheets = sheets();
    for (snap, count, most) in [(Scissor::SNAP, 5635, 0), (0.0, 1000, 0), (0.2, 1000, 2)] {
        let (mut random, mut open) = (Random(97), Vec::new());
        for i in 0..count {
            let corners = polygon(&mut random);
            // The last of all was a find.
            let is_tried = i < cases() || i + 1 == count;
            if !is_tried {
                continue;
            }
            let [all, first] = [CutLayers::All, CutLayers::First]
                .map(|layers| cut_out(&sheets[i as usize % 3], &corners, snap, layers));
            assert!(all == first, "snap {snap}: {corners:?}");
            if all.components().count() != 2 {
                open.push(corners);
            }
        }
        assert!(open.len() <= most, "snap {snap}: {open:?}");
    }
}

/// Of two sheets at one place, all cuts of a polyline are in the same one, also where it comes back.
#[test]
fn closed_polylines_stay_in_one_of_two_layers() {
    let sheets = sheets();
    let mut random = Random(113);
    for i in 0..cases() {
        let corners = polygon(&mut random);
        let snap = [Scissor::SNAP, 0.0, 0.01][i as usize % 3];
        let sheet = &sheets[i as usize % 3];
        let [one, two] = [sheet, &doubled(sheet)].map(|sheet| {
            let cut = cut_out(sheet, &corners, snap, CutLayers::First);
            cut.components().count()
        });
        assert_eq!(one + 1, two, "case {i}, snap {snap}: {corners:?}");
    }
}

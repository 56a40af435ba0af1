//! Where cuts end that do not go through everything: thin faces at tips, vertices that slide, and
//! rays exactly on the boundary.

use std::collections::BTreeSet;

use tearmesh::{CutMethod, CutReport, Edit, Scissor, VertexId, shapes};

use crate::cases::cases;
use crate::oracle::straight::Surface;
use crate::random::Random;
use crate::surfaces::{sheets, surface};
use crate::work::{Work, between};

/// A sheet that was cut once from a point to another, the report, and the smallest part of the
/// smallest altitude of its face that a new face keeps.
fn slit(sheet: &Surface, ends: [[f64; 2]; 2], snap: f64, moves: bool) -> (Work, CutReport, f64) {
    let mut work = Work::of(sheet);
    let before = work.altitudes();
    let scissor = between(ends[0], ends[1])
        .with_snap(snap)
        .with_snap_move(moves);
    let (_, report) = work.cut(CutMethod::Exact, &scissor);
    let least = work.kept(&before).into_iter().fold(f64::INFINITY, f64::min);
    (work, report, least)
}

/// The vertices that slid, and those at the ends of the edges that were torn, by their roots.
fn slid_and_torn(work: &Work) -> [BTreeSet<VertexId>; 2] {
    let mut sets = [BTreeSet::new(), BTreeSet::new()];
    let root = |v| work.mesh.root(v);
    for edit in &work.edits {
        match edit {
            Edit::Slide(slide) => {
                sets[0].insert(root(slide.vertex));
            }
            Edit::Split(split) => {
                let stayed = split.torn.iter().map(|link| link.stayed);
                let ends = stayed.flat_map(|h| [work.mesh.origin(h), work.mesh.target(h)]);
                sets[1].extend(ends.map(root));
            }
            Edit::Insert(_) | Edit::Merge(_) => {}
            _ => unreachable!("there is no other edit"),
        }
    }
    sets
}

/// Two triangles on a common edge.
fn two_triangles(mut corner: impl FnMut(f64, f64) -> [f64; 3]) -> Surface {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    Surface {
        points: corners.map(|[x, y]| corner(x, y)).to_vec(),
        faces: vec![[0, 1, 2], [1, 3, 2]],
    }
}

/// A point of a face, by chance; near its outline as often as not.
fn in_face(sheet: &Surface, face: usize, random: &mut Random) -> [f64; 2] {
    let mut weights = [0.0; 3].map(|_: f64| random.next());
    if random.next() < 0.5 {
        weights[random.below(3)] *= 0.1;
    }
    let sum: f64 = weights.iter().sum();
    let corners = sheet.faces[face].map(|v| sheet.points[v as usize]);
    [0, 1].map(|axis| (0..3).map(|i| weights[i] / sum * corners[i][axis]).sum())
}

/// Slits with two tips in one face, with one in each of two, and as long as a few edges.
fn for_slits(count: usize, mut visit: impl FnMut(&Surface, [[f64; 2]; 2])) {
    let mut random = Random(83);
    let sheets = sheets();
    for i in 0..count {
        // Neither of the triangles is very thin.
        let mut by = || 0.6 * (random.next() - 0.5);
        let pair = two_triangles(|x, y| [x + by(), y + by(), 0.0]);
        let sheet = if i % 4 == 3 {
            &sheets[i / 4 % 3]
        } else {
            &pair
        };
        let one = random.below(sheet.faces.len());
        let other = [one, random.below(sheet.faces.len())][i % 2];
        let ends = [one, other].map(|face| in_face(sheet, face, &mut random));
        visit(sheet, ends);
    }
}

#[test]
fn regression_a_tip_near_an_edge_leaves_no_thin_face() {
    let square = two_triangles(|x, y| [x, y, 0.0]);
    let (.., least) = slit(&square, [[0.04, 0.22], [0.01, 0.8]], Scissor::SNAP, false);
    assert!(least >= 0.0475 * (1.0 - 1e-9), "{least}");
}

#[test]
fn tips_keep_faces_from_getting_thin() {
    for snap in [0.02, Scissor::SNAP, 0.2] {
        let bound = snap * (1.0 - snap) * (1.0 - 1e-9);
        for_slits(4451, |sheet, ends| {
            let (_, report, least) = slit(sheet, ends, snap, false);
            assert!(report.separated || report.splits == 0, "{ends:?}");
            assert!(
                least >= bound,
                "snap {snap}: {least} by {ends:?} in {sheet:?}"
            );
        });
    }
}

/// The middle vertex is .03 from a slit that is shorter than the snap.
#[test]
fn regression_a_slit_that_splits_nothing_moves_nothing() {
    let mut sheet = surface(&shapes::grid(2, 2));
    sheet.points[4][1] = 0.505;
    let ends = [[0.4875, 0.485], [0.5125, 0.485]];
    assert!(slit(&sheet, ends, Scissor::SNAP, true).0.edits.is_empty());
}

#[test]
fn vertices_that_slide_are_on_the_seam() {
    let (mut slid, mut nothing) = (0, 0);
    for_slits(4000, |sheet, ends| {
        let (work, report, _) = slit(sheet, ends, Scissor::SNAP, true);
        if report.splits == 0 {
            nothing += 1;
            assert!(
                work.edits.is_empty(),
                "{ends:?}: a slit that splits nothing"
            );
        }
        let [moved, torn] = slid_and_torn(&work);
        slid += moved.len();
        assert!(moved.is_subset(&torn), "{ends:?}: {moved:?} {torn:?}");
    });
    assert!(slid > 100 && nothing > 20, "{slid} {nothing}");
}

/// Asserts that a cut of a square by a method leaves two pieces.
fn is_divided(n: u32, ends: [[f64; 2]; 2], method: CutMethod, snap: f64) {
    let mut work = Work::of(&surface(&shapes::grid(n, n)));
    let scissor = between(ends[0], ends[1]).with_snap(snap);
    let (_, report) = work.cut(method, &scissor);
    let counts = (report.pieces_expected, report.pieces, report.crumbs);
    // The seam of `partition` may end at a vertex beside the strip; then it says so.
    let is_right = match method {
        CutMethod::Exact => counts == (2, 2, 0) && report.lost == 0,
        _ => counts.0 == 2 && counts.2 == 0,
    };
    assert!(
        is_right,
        "{method:?}, snap {snap}, {n}: {ends:?}, {counts:?}"
    );
}

/// Rays through two points of the outline of a square, on different sides: two pieces, whatever
/// rounding makes of where the outline is met.
#[test]
fn rays_exactly_on_the_boundary_cut_off_a_piece() {
    let mut random = Random(89);
    for _ in 0..400 {
        let n = 2 + random.below(7) as u32;
        let mut hundredth = || (1.0 + (99.0 * random.next()).floor()) / 100.0;
        let ends = [[hundredth(), 1.0], [hundredth(), 0.0]];
        for method in [CutMethod::Exact, CutMethod::Partition] {
            is_divided(n, ends, method, Scissor::SNAP);
        }
    }
}

/// Cuts from one side of a square to the next, whose rays are barely beyond the outline: a vertex of
/// the outline that is taken for the crossing beside it may lie outside the strip, and the cut goes
/// through all the same.
#[test]
fn rays_barely_beyond_the_boundary_cut_off_a_piece() {
    let mut random = Random(107);
    for snap in [0.0, 0.02, Scissor::SNAP, 0.2] {
        for _ in 0..600 {
            let n = 3 + random.below(6) as u32;
            // More than an edge from the corner, and near a vertex as often as not.
            let mut along = || {
                let vertex = 1.0 + (f64::from(n - 2) * random.next()).floor();
                let off = random.next() * [0.05, 1.0][random.below(2)];
                (vertex + off) / f64::from(n)
            };
            let (p, q) = ([along(), 1.0], [1.0, along()]);
            let beyond = [1e-3, 1e-5][random.below(2)];
            let [dx, dy] = [q[0] - p[0], q[1] - p[1]].map(|d| beyond * d);
            let ends = [[p[0] - dx, p[1] - dy], [q[0] + dx, q[1] + dy]];
            is_divided(n, ends, CutMethod::Exact, snap);
        }
    }
}

/// What [`Scissor::with_snap`] says of slits with both ends inside sheets of a few hundred triangles.
#[test]
fn tips_are_as_far_from_where_they_should_be_as_the_documentation_says() {
    let (mut random, mut off, mut told) = (Random(7), Vec::new(), 0);
    let count = 4 * cases();
    let sheets = sheets();
    for i in 0..count {
        let sheet = &sheets[i as usize % 3];
        let ends =
            [0; 2].map(|_: usize| in_face(sheet, random.below(sheet.faces.len()), &mut random));
        let (work, report, _) = slit(sheet, ends, Scissor::SNAP, false);
        if work.edits.is_empty() {
            continue;
        }
        let edge = sheet.mean_edge();
        off.extend(report.tip_overshoots.iter().map(|off| off.abs() / edge));
        let aims = report.aims.into_iter().flatten().flatten();
        told += aims.filter(tearmesh::CutAim::is_missed).count();
    }
    off.sort_by(f64::total_cmp);
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    let most = off[off.len() * 99 / 100];
    let told = told as f64 / off.len() as f64;
    println!("mean {mean}, 99 % within {most}, told {told}");
    assert!(
        mean < 0.005 && most < 0.05 && told < 0.01,
        "{mean}, {most}, {told}"
    );
}

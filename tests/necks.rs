//! Pieces that hang on a neck narrower than the snap: a cut says that they come off.

use tearmesh::{CutMethod, CutReport, Scissor, shapes};

use crate::oracle::naive_cut;
use crate::oracle::straight::{Surface, is_generic};
use crate::random::Random;
use crate::straight::random_generic_cut;
use crate::surfaces::{delaunay, jittered, surface};
use crate::work::{Work, between};

/// A sheet with a notch from above, whose tip is `width` above the line y = 0.
///
/// ```text
///   2-------.     .-------4
///   |     '  \   /  '     |
///   |   '     \ /     '   |
///   |  '       0       '  |      y = width
///   | '     '     '     ' |
///   1 ------------------- 3
/// ```
fn notched(width: f64) -> Surface {
    let points = [
        [0.0, width],
        [-1.0, width - 1.0],
        [-1.0, 1.0],
        [1.0, width - 1.0],
        [1.0, 1.0],
        [-0.5, 1.0],
        [0.5, 1.0],
    ];
    Surface {
        points: points.map(|[x, y]| [x, y, 0.0]).to_vec(),
        faces: vec![[0, 2, 1], [0, 1, 3], [0, 3, 4], [0, 5, 2], [0, 4, 6]],
    }
}

fn cut_along(surface: &Surface, scissor: &Scissor) -> CutReport {
    Work::of(surface).cut(CutMethod::Exact, scissor).1
}

#[test]
fn a_neck_narrower_than_the_snap_is_reported() {
    let across = between([-2.0, 0.0], [2.0, 0.0]).with_through(true);
    for (width, snap, moves, expected) in [
        (0.02, Scissor::SNAP, false, [3, 2, 1, 1]),
        (0.02, Scissor::SNAP, true, [3, 2, 1, 1]),
        (0.02, 0.0, false, [2, 2, 0, 0]),
        (0.02, 0.01, false, [2, 2, 0, 0]),
        (0.1, Scissor::SNAP, false, [2, 2, 0, 0]),
    ] {
        let scissor = across.clone().with_snap(snap).with_snap_move(moves);
        let report = cut_along(&notched(width), &scissor);
        let pieces = [report.pieces, report.pieces_expected, report.crumbs];
        assert_eq!(pieces[..], expected[..3], "{report:?}");
        assert_eq!(report.necks.len(), expected[3]);
        for neck in &report.necks {
            assert_eq!((neck.vertex.index(), neck.faces), (0, 2), "{report:?}");
            assert!((neck.width - width).abs() < 1e-15, "{report:?}");
        }
    }
}

/// Two notches side by side: what is between them comes off, and then what is on one side.
#[test]
fn two_necks_side_by_side_are_two_pieces() {
    let x = [-1.0, 1.0, -2.0, -2.0, 2.0, 2.0, 0.0, 0.0, -1.5, 1.5];
    let y = [0.02, 0.02, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, 1.0, 1.0];
    let [left, below] = [[0, 3, 2, 0, 8, 3], [0, 2, 6, 0, 6, 1]];
    let [right, between_both] = [[1, 4, 5, 1, 5, 9], [1, 6, 4, 0, 1, 7]];
    let faces = [left, below, right, between_both];
    let sheet = Surface {
        points: (0..10).map(|i| [x[i], y[i], 0.0]).collect(),
        faces: faces.as_flattened().as_chunks().0.to_vec(),
    };
    let report = cut_along(&sheet, &between([-3.0, 0.0], [3.0, 0.0]).with_through(true));
    let sizes: Vec<usize> = report.necks.iter().map(|neck| neck.faces).collect();
    assert_eq!((report.pieces, sizes), (4, vec![1, 2]), "{report:?}");
}

/// What an ideal cut leaves is counted by the naive implementation.
#[test]
fn through_cuts_leave_ideal_pieces_and_those_on_necks() {
    let mut random = Random(71);
    let mut sheets = vec![surface(&shapes::tube(12, 6)), surface(&shapes::grid(9, 9))];
    sheets.extend([jittered(10, &mut random), delaunay(150, 9, &mut random)]);
    let (mut cuts, mut necks) = (0, 0);
    for case in 0..1200 {
        let mut sheet = sheets[case % sheets.len()].clone();
        for _ in 0..3 {
            let (_, slit) = random_generic_cut(&sheet, &mut random);
            if !slit.sides.is_empty() {
                sheet = naive_cut::cut(&sheet, &slit);
            }
        }
        let (scissor, cut) = random_generic_cut(&sheet, &mut random);
        let (scissor, cut) = (scissor.with_through(true), cut.through());
        if !is_generic(&sheet, &cut) {
            continue;
        }
        cuts += 1;
        let ideal = naive_cut::cut(&sheet, &cut).pieces().1;
        for snap in [0.0, Scissor::SNAP, 0.2] {
            let report = cut_along(&sheet, &scissor.clone().with_snap(snap));
            let said = format!("case {case}, snap {snap}: {report:?}");
            assert_eq!(report.pieces_expected, ideal, "{said}");
            assert!(report.crumbs <= report.necks.len(), "{said}");
            assert!(ideal + report.necks.len() >= report.pieces, "{said}");
            let faces = sheet.faces.len() + 2 * report.vertices_inserted;
            for neck in &report.necks {
                assert!(neck.width < snap * sheet.longest_edge(), "{said}");
                assert!(2 * neck.faces <= faces, "{said}");
            }
            necks += report.necks.len();
            assert!(snap > 0.0 || (report.pieces, report.crumbs) == (ideal, 0));
        }
    }
    assert!(cuts > 1000 && necks > 20, "{cuts} cuts, {necks} necks");
}

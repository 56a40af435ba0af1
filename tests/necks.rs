//! Pieces that hang on a neck narrower than the snap: a cut says that they come off.

use tearmesh::{CutMethod, CutReport, Edits, Positions, Scissor, shapes};

use crate::exact::scissor;
use crate::oracle::naive_cut;
use crate::oracle::straight::{Cut, Surface, is_generic};
use crate::random::Random;
use crate::straight::{built, delaunay, down, jittered, random_generic_rays, surface};

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
    Surface {
        points: vec![
            [0.0, width, 0.0],
            [-1.0, width - 1.0, 0.0],
            [-1.0, 1.0, 0.0],
            [1.0, width - 1.0, 0.0],
            [1.0, 1.0, 0.0],
            [-0.5, 1.0, 0.0],
            [0.5, 1.0, 0.0],
        ],
        faces: vec![[0, 2, 1], [0, 1, 3], [0, 3, 4], [0, 5, 2], [0, 4, 6]],
    }
}

fn cut_along(surface: &Surface, scissor: &Scissor) -> CutReport {
    let (mut mesh, mut positions) = built(surface);
    let mut edits = Edits::new();
    let done = scissor.cut_measured(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
    let (_, report) = done.expect("positions are in step");
    assert_eq!(report.pieces, mesh.components().count());
    report
}

#[test]
fn a_neck_narrower_than_the_snap_is_reported() {
    let across = scissor([[-2.0, 0.0], [2.0, 0.0]].map(down)).through(true);
    for snap_move in [false, true] {
        let report = cut_along(&notched(0.02), &across.clone().snap_move(snap_move));
        let counts = (report.pieces, report.pieces_expected, report.crumbs);
        assert_eq!(counts, (3, 2, 1), "{report:?}");
        let [neck] = &report.necks[..] else {
            panic!("{report:?}");
        };
        assert_eq!((neck.vertex.index(), neck.faces), (0, 2), "{report:?}");
        assert!((neck.width - 0.02).abs() < 1e-15, "{report:?}");
    }
    for (width, snap) in [(0.02, 0.0), (0.02, 0.01), (0.1, Scissor::SNAP)] {
        let report = cut_along(&notched(width), &across.clone().snap(snap));
        let counts = (report.pieces, report.pieces_expected, report.crumbs);
        assert_eq!(counts, (2, 2, 0), "{report:?}");
        assert_eq!(report.necks, []);
    }
}

/// Sheets with slits are cut through. What an ideal cut leaves is counted by the naive
/// implementation.
#[test]
fn through_cuts_of_slit_sheets_leave_the_pieces_of_an_ideal_cut_and_those_on_necks() {
    let mut random = Random(71);
    let mut sheets = vec![surface(&shapes::tube(12, 6)), surface(&shapes::grid(9, 9))];
    sheets.extend([jittered(10, &mut random), delaunay(150, 9, &mut random)]);
    let (mut cuts, mut first_found, mut necks) = (0, None, 0);
    for case in 0..1200 {
        let mut sheet = sheets[case % sheets.len()].clone();
        for _ in 0..3 {
            let (_, slit) = random_generic_rays(&sheet, &mut random);
            if !slit.sides.is_empty() {
                sheet = naive_cut::cut(&sheet, &slit);
            }
        }
        let (rays, cut) = random_generic_rays(&sheet, &mut random);
        let cut: Cut = cut.through();
        if !is_generic(&sheet, &cut) {
            continue;
        }
        cuts += 1;
        let ideal = naive_cut::cut(&sheet, &cut).pieces().1;
        for snap in [Scissor::SNAP, 0.2] {
            let report = cut_along(&sheet, &scissor(rays).through(true).snap(snap));
            let said = format!("case {case}, snap {snap}: {report:?}");
            assert_eq!(report.pieces_expected, ideal, "{said}");
            assert!(report.crumbs <= report.necks.len(), "{said}");
            assert!(ideal + report.necks.len() >= report.pieces, "{said}");
            let longest = longest_edge(&sheet);
            for neck in &report.necks {
                assert!(neck.width < snap * longest, "{said}");
                assert!(2 * neck.faces <= sheet.faces.len() + 2 * report.vertices_inserted);
            }
            if !report.necks.is_empty() {
                first_found.get_or_insert(cuts);
                necks += report.necks.len();
            }
        }
        let report = cut_along(&sheet, &scissor(rays).through(true).snap(0.0));
        assert_eq!(
            (report.pieces, report.necks.len()),
            (ideal, 0),
            "{report:?}"
        );
    }
    println!("{cuts} cuts, {necks} necks, the first in cut {first_found:?}");
    assert!(cuts > 1000 && necks > 20, "{cuts} cuts, {necks} necks");
}

fn longest_edge(surface: &Surface) -> f64 {
    let (mesh, positions): (_, Positions) = built(surface);
    let lengths = mesh
        .half_edges()
        .map(|h| (positions.at(mesh.target(h)) - positions.at(mesh.origin(h))).norm());
    lengths.fold(0.0, f64::max)
}

//! Where cuts end that do not go through everything: thin faces at tips, vertices that slide, and
//! rays exactly on the boundary.

use std::collections::BTreeSet;

use tearmesh::{CutMethod, Edit, Edits, Mesh, Point, Positions, Scissor, VertexId, shapes};

use crate::exact::{altitudes, parents, scissor};
use crate::oracle::straight::Surface;
use crate::random::Random;
use crate::straight::{built, down};
use crate::straight_polylines::sheets;

/// A sheet that is cut once, and the log of that.
struct Cut {
    before: Vec<f64>,
    mesh: Mesh,
    positions: Positions,
    edits: Edits,
    report: tearmesh::CutReport,
}

fn cut(sheet: &Surface, scissor: &Scissor) -> Cut {
    let (mut mesh, mut positions) = built(sheet);
    let before = altitudes(&mesh, &positions);
    let mut edits = Edits::new();
    let (_, report) = scissor
        .cut_measured(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)
        .expect("positions are in step");
    assert_eq!(mesh.check(), []);
    Cut {
        before,
        mesh,
        positions,
        edits,
        report,
    }
}

impl Cut {
    /// The smallest part of the smallest altitude of its face that a new face keeps, and that face.
    fn thinnest(&self) -> (f64, usize) {
        let parents = parents(&self.edits, self.before.len());
        let after = altitudes(&self.mesh, &self.positions);
        let kept = after.iter().enumerate();
        let kept = kept.map(|(f, altitude)| (altitude / self.before[parents[f]], f));
        kept.fold((f64::INFINITY, 0), |least, one| {
            if one.0 < least.0 { one } else { least }
        })
    }

    fn splits(&self) -> usize {
        let is_split = |edit: &Edit<'_>| matches!(edit, Edit::Split(_));
        self.edits.iter().filter(is_split).count()
    }

    /// The vertices that slid, and those at the ends of the edges that were torn, by their roots.
    fn slid_and_torn(&self) -> [BTreeSet<VertexId>; 2] {
        let mut sets = [BTreeSet::new(), BTreeSet::new()];
        for edit in self.edits.iter() {
            match edit {
                Edit::Slide(slide) => {
                    sets[0].insert(self.mesh.root(slide.vertex));
                }
                Edit::Split(split) => {
                    for link in split.torn {
                        let ends = [self.mesh.origin(link.stayed), self.mesh.target(link.stayed)];
                        sets[1].extend(ends.map(|v| self.mesh.root(v)));
                    }
                }
                Edit::Insert(_) | Edit::Merge(_) => {}
            }
        }
        sets
    }
}

fn flat(points: &[[f64; 2]], faces: &[[u32; 3]]) -> Surface {
    Surface {
        points: points.iter().map(|&[x, y]| [x, y, 0.0]).collect(),
        faces: faces.to_vec(),
    }
}

/// Two triangles with a common edge, neither of them very thin.
fn two_triangles(random: &mut Random) -> Surface {
    let mut near = |x: f64, y: f64| {
        let mut by = || 0.6 * (random.next() - 0.5);
        [x + by(), y + by()]
    };
    let points = [
        near(0.0, 0.0),
        near(1.0, 0.0),
        near(0.0, 1.0),
        near(1.0, 1.0),
    ];
    flat(&points, &[[0, 1, 2], [1, 3, 2]])
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
        let pair;
        let sheet = if i % 4 == 3 {
            &sheets[i / 4 % sheets.len()]
        } else {
            pair = two_triangles(&mut random);
            &pair
        };
        let one = random.below(sheet.faces.len());
        let other = if i % 2 == 0 {
            one
        } else {
            random.below(sheet.faces.len())
        };
        let ends = [one, other].map(|face| in_face(sheet, face, &mut random));
        if ends[0] != ends[1] {
            visit(sheet, ends);
        }
    }
}

#[test]
fn regression_a_tip_near_an_edge_leaves_no_thin_face() {
    let sheet = flat(
        &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]],
        &[[0, 1, 2], [1, 3, 2]],
    );
    let cut = cut(&sheet, &scissor([[0.04, 0.22], [0.01, 0.8]].map(down)));
    let (least, face) = cut.thinnest();
    assert!(least >= 0.0475 * (1.0 - 1e-9), "{least} in face {face}");
}

#[test]
fn tips_keep_faces_from_getting_thin() {
    for snap in [0.02, Scissor::SNAP, 0.2] {
        let bound = snap * (1.0 - snap);
        let mut overshoots = Vec::new();
        let (mut thin, mut worst, mut slits) = (0, (f64::INFINITY, [[0.0; 2]; 2]), 0);
        for_slits(4451, |sheet, ends| {
            let cut = cut(sheet, &scissor(ends.map(down)).snap(snap));
            let (least, _) = cut.thinnest();
            slits += 1;
            assert!(cut.report.separated || cut.splits() == 0, "{ends:?}");
            overshoots.extend(
                cut.report
                    .tip_overshoots
                    .iter()
                    .map(|over| over.abs() / sheet.mean_edge()),
            );
            thin += usize::from(least < bound * (1.0 - 1e-9));
            if least < worst.0 {
                worst = (least, ends);
            }
        });
        println!(
            "snap {snap}: {thin} of {slits} slits leave a face below {bound:.4} of its parent's \
             altitude, the worst {:.1e}",
            worst.0
        );
        overshoots.sort_by(f64::total_cmp);
        let at = |part: f64| overshoots[(part * (overshoots.len() - 1) as f64) as usize];
        println!(
            "    {} tips, off by {:.1e} of an edge in the median, {:.3} at nine tenths, {:.3} at most",
            overshoots.len(),
            at(0.5),
            at(0.9),
            at(1.0)
        );
        assert_eq!(thin, 0, "snap {snap}: {worst:?}");
    }
}

#[test]
fn regression_a_slit_that_splits_nothing_moves_nothing() {
    // The middle vertex is .03 from a slit that is shorter than the snap.
    let (mesh, positions) = shapes::grid(2, 2);
    let mut points: Vec<Point> = positions.as_slice().to_vec();
    points[4].y = 0.505;
    let sheet = crate::straight::surface(&(mesh, Positions::new(points).expect("finite")));
    let rays = [[0.4875, 0.485], [0.5125, 0.485]].map(down);
    let cut = cut(&sheet, &scissor(rays).snap_move(true));
    assert_eq!((cut.splits(), cut.edits.len()), (0, 0));
}

#[test]
fn what_slides_is_on_the_seam() {
    let (mut slid, mut nothing) = (0, 0);
    for_slits(4000, |sheet, ends| {
        let cut = cut(sheet, &scissor(ends.map(down)).snap_move(true));
        if cut.splits() == 0 {
            nothing += 1;
            assert_eq!(cut.edits.len(), 0, "{ends:?}: a slit that splits nothing");
        }
        let [moved, torn] = cut.slid_and_torn();
        slid += moved.len();
        assert!(
            moved.is_subset(&torn),
            "{ends:?}: {moved:?} slid, {torn:?} torn"
        );
    });
    println!("{slid} vertices slid, {nothing} slits split nothing");
    assert!(slid > 100 && nothing > 20);
}

/// Rays through two points of the outline of a square, on different sides: two pieces, whatever
/// rounding makes of where the outline is met.
#[test]
fn rays_exactly_on_the_boundary_cut_off_a_piece() {
    let mut random = Random(89);
    let mut wrong = Vec::new();
    for _ in 0..400 {
        let n = 2 + random.below(7) as u32;
        let sheet = crate::straight::surface(&shapes::grid(n, n));
        let mut hundredth = || (1.0 + (99.0 * random.next()).floor()) / 100.0;
        let ends = [[hundredth(), 1.0], [hundredth(), 0.0]];
        for method in [CutMethod::Exact, CutMethod::Partition] {
            let (mut mesh, mut positions) = built(&sheet);
            let done = scissor(ends.map(down)).cut_measured(
                method,
                &mut mesh,
                &mut positions,
                &mut Edits::new(),
            );
            let (_, report) = done.expect("positions are in step");
            let counts = (
                report.pieces_expected,
                report.pieces,
                report.crumbs,
                report.lost,
            );
            // The seam of `partition` may end at a vertex beside the strip; then it says so.
            let is_right = match method {
                CutMethod::Exact => counts == (2, 2, 0, 0),
                _ => report.pieces_expected == 2 && report.crumbs == 0,
            };
            if !is_right {
                wrong.push((method, n, ends, counts));
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "{} of 800: {:?}",
        wrong.len(),
        &wrong[..wrong.len().min(5)]
    );
}

/// Cuts from one side of a square to the next, whose rays are barely beyond the outline: a vertex of
/// the outline that is taken for the crossing beside it may lie outside the strip, and the cut goes
/// through all the same.
#[test]
fn rays_barely_beyond_the_boundary_cut_off_a_piece() {
    let mut random = Random(107);
    for snap in [0.0, 0.02, Scissor::SNAP, 0.2] {
        let mut wrong = Vec::new();
        for _ in 0..600 {
            let n = 3 + random.below(6) as u32;
            let sheet = crate::straight::surface(&shapes::grid(n, n));
            // More than an edge from the corner, and near a vertex as often as not.
            let mut along = || {
                let vertex = 1.0 + (f64::from(n - 2) * random.next()).floor();
                let off = random.next() * [0.05, 1.0][usize::from(random.next() < 0.5)];
                (vertex + off) / f64::from(n)
            };
            let (p, q) = ([along(), 1.0], [1.0, along()]);
            let beyond = [1e-3, 1e-5][usize::from(random.next() < 0.5)];
            let [dx, dy] = [q[0] - p[0], q[1] - p[1]].map(|d| beyond * d);
            let ends = [[p[0] - dx, p[1] - dy], [q[0] + dx, q[1] + dy]];
            let cut = cut(&sheet, &scissor(ends.map(down)).snap(snap));
            let report = &cut.report;
            let counts = (report.pieces, report.crumbs, report.lost);
            if counts != (2, 0, 0) {
                wrong.push((n, ends, counts));
            }
        }
        let first = wrong.first();
        assert!(
            wrong.is_empty(),
            "snap {snap}: {} of 600: {first:?}",
            wrong.len()
        );
    }
}

//! The paper's two methods beside `partition`, on the meshes for which the paper gives no figures.
//!
//! "In practice, with irregular meshes, this produce the undesirable result of the mesh not being
//! completely divided. A better result is achieved by alternating the normal vector" (Souza et
//! al. 2014 §V). Both sentences are held here as measurements, so that nobody makes the
//! paper's methods kinder than they are.

use tearmesh::{CutReport, shapes};

use crate::oracle::straight::Surface;
use crate::random::Random;
use crate::surfaces::{delaunay, jittered, pieces_by_vertices, surface};
use crate::work::{ALONG_EDGES, Work, between, triangles};

/// How many random cuts each mesh gets.
const CUTS: usize = 40;

/// The reports of random through cuts of the unit square by each method, and how often each left two
/// pieces that share no vertex. (Pieces that share only a vertex are apart for the report, which
/// counts by edges: those are crumbs.)
fn reports(sheet: &Surface) -> [(Vec<CutReport>, usize); 3] {
    let mut reports = [const { (Vec::new(), 0) }; 3];
    let mut random = Random(7);
    for _ in 0..CUTS {
        let (sin, cos) = (std::f64::consts::PI * random.next()).sin_cos();
        let (x, y) = (0.3 + 0.4 * random.next(), 0.3 + 0.4 * random.next());
        let end = |t: f64| [x + t * cos, y + t * sin];
        let scissor = between(end(-5.0), end(5.0));
        for (method, (reports, divided)) in ALONG_EDGES.into_iter().zip(&mut reports) {
            let mut work = Work::of(sheet);
            reports.push(work.cut(method, &scissor).1);
            let mut pieces = pieces_by_vertices(triangles(&work.mesh));
            pieces.sort_unstable();
            pieces.dedup();
            *divided += usize::from(pieces.len() == 2);
        }
    }
    reports
}

#[test]
fn methods_of_the_paper_leave_what_it_says() {
    let mut random = Random(5);
    for (name, sheet, alternating_divides) in [
        ("grid", surface(&shapes::grid(30, 30)), 38..=CUTS),
        ("jittered", jittered(30, &mut random), 30..=CUTS),
        ("random", delaunay(900, 30, &mut random), 20..=36),
    ] {
        let [partition, uniform, alternating] = reports(&sheet);
        let sum = |(reports, _): &(Vec<CutReport>, usize), of: fn(&CutReport) -> usize| {
            reports.iter().map(of).sum::<usize>()
        };
        let most = |(reports, _): &(Vec<CutReport>, usize), of: fn(&CutReport) -> f64| {
            reports.iter().map(of).fold(0.0, f64::max)
        };
        let separated = |report: &CutReport| usize::from(report.separated);
        let [is_divided, _, by_alternating] = [&partition, &uniform, &alternating].map(|one| one.1);
        // "The mesh not being completely divided."
        assert!(uniform.1 <= 2 && sum(&uniform, separated) == 0, "{name}");
        let splits = sum(&uniform, |report| report.splits);
        assert!(sum(&uniform, |report| report.refused) > splits);
        // "A better result", but with crumbs and a long seam.
        assert!(alternating_divides.contains(&by_alternating), "{name}");
        assert_eq!(sum(&alternating, separated), CUTS);
        assert_eq!(sum(&alternating, |report| report.lost), 0);
        assert!(sum(&alternating, |report| report.crumbs) > CUTS, "{name}");
        assert!(most(&alternating, |report| report.seam_length_ratio) > 2.0);
        assert!(sum(&alternating, |report| report.splits) > 3 * splits / 2);
        assert_eq!((is_divided, sum(&partition, separated)), (CUTS, CUTS));
        let bad = |report: &CutReport| report.crumbs + report.lost + report.refused;
        assert_eq!(sum(&partition, bad), 0, "{name}");
        assert!(most(&partition, |report| report.seam_length_ratio) < 1.5);
        assert!(most(&partition, |report| report.seam_deviation_max_edges) < 1.2);
    }
}

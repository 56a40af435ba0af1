//! The paper's two methods beside `partition`, on the meshes for which the paper gives no figures.
//!
//! "In practice, with irregular meshes, this produce the undesirable result of the mesh not being
//! completely divided. A better result is achieved by alternating the normal vector" (Souza et
//! al. 2014 §V). Both sentences are held here as measurements, so that nobody makes the
//! paper's methods kinder than they are.

use tearmesh::{CutMethod, CutReport, Edits, Mesh, Point, Positions, Ray, Scissor, Vector, shapes};

use crate::cuts::ALONG_EDGES;
use crate::pieces::pieces_by_vertices;
use crate::random::Random;
use crate::straight::{built, delaunay};

/// How many random cuts each mesh gets.
const CUTS: usize = 40;

/// What came of the cuts of one method.
#[derive(Debug, Default)]
struct Counts {
    /// How often two pieces were left that share no vertex. (Pieces that share only a
    /// vertex are apart for the report, which counts by edges: those are crumbs.)
    divided: usize,
    separated: usize,
    with_crumbs: usize,
    crumbs: usize,
    lost: usize,
    splits: usize,
    refused: usize,
    ratio_sum: f64,
    ratio_max: f64,
    deviation_max_edges: f64,
}

impl Counts {
    fn count(&mut self, report: &CutReport) {
        self.separated += usize::from(report.separated);
        self.with_crumbs += usize::from(report.crumbs > 0);
        self.crumbs += report.crumbs;
        self.lost += report.lost;
        self.splits += report.splits;
        self.refused += report.refused;
        self.ratio_sum += report.seam_length_ratio;
        self.ratio_max = self.ratio_max.max(report.seam_length_ratio);
        self.deviation_max_edges = self
            .deviation_max_edges
            .max(report.seam_deviation_max_edges);
    }
}

/// Random through cuts of the unit square by each method, in the order of [`ALONG_EDGES`].
fn tallies(name: &str, sheet: &(Mesh, Positions)) -> [Counts; 3] {
    let mut tallies = [Counts::default(), Counts::default(), Counts::default()];
    let mut random = Random(7);
    for _ in 0..CUTS {
        let (sin, cos) = (std::f64::consts::PI * random.next()).sin_cos();
        let (x, y) = (0.3 + 0.4 * random.next(), 0.3 + 0.4 * random.next());
        let ray = |t: f64| {
            let down = Vector::new(0.0, 0.0, -1.0);
            Ray::new(Point::new(x + t * cos, y + t * sin, 5.0), down).expect("a ray")
        };
        let scissor = Scissor::new(ray(-5.0), ray(5.0)).expect("a plane");
        for (method, tally) in ALONG_EDGES.into_iter().zip(&mut tallies) {
            let (mut mesh, mut positions) = sheet.clone();
            let report = scissor.cut_measured(method, &mut mesh, &mut positions, &mut Edits::new());
            assert_eq!(mesh.check(), []);
            tally.count(&report.expect("in step").1);
            let mut pieces = pieces_by_vertices(&mesh);
            pieces.sort_unstable();
            pieces.dedup();
            tally.divided += usize::from(pieces.len() == 2);
        }
    }
    for (method, tally) in ALONG_EDGES.into_iter().zip(&tallies) {
        let mean = |sum: usize| sum as f64 / CUTS as f64;
        println!(
            "{name:9} {:11} divided in two {:2}/{CUTS}, separated {:2}, crumbs in {:2} ({}), lost {:2}, \
             splits {:.0} (refused {:.0}), seam {:.2} (largest {:.2}), deviation up to {:.2} edges",
            format!("{method:?}"),
            tally.divided,
            tally.separated,
            tally.with_crumbs,
            tally.crumbs,
            tally.lost,
            mean(tally.splits),
            mean(tally.refused),
            tally.ratio_sum / CUTS as f64,
            tally.ratio_max,
            tally.deviation_max_edges,
        );
    }
    tallies
}

fn jittered(n: u32, seed: u64) -> (Mesh, Positions) {
    let mut random = Random(seed);
    let (mesh, flat) = shapes::grid(n, n);
    let inner = |x: f64| x > 0.0 && x < 1.0;
    let cell = 1.0 / f64::from(n);
    let mut moved = |p: &Point| {
        let by = if inner(p.x) && inner(p.y) {
            0.6 * cell
        } else {
            0.0
        };
        [
            p.x + by * (random.next() - 0.5),
            p.y + by * (random.next() - 0.5),
            0.0,
        ]
    };
    let points: Vec<_> = flat.as_slice().iter().map(&mut moved).collect();
    (mesh, Positions::new(points).expect("finite"))
}

#[test]
fn the_papers_methods_are_no_kinder_than_the_paper_says() {
    for (name, sheet, alternating_divides) in [
        ("grid", shapes::grid(30, 30), 38..=CUTS),
        ("jittered", jittered(30, 3), 34..=CUTS),
        ("random", built(&delaunay(900, 30, &mut Random(5))), 20..=36),
    ] {
        let [partition, uniform, alternating] = tallies(name, &sheet);
        // "The mesh not being completely divided."
        assert!(
            uniform.divided <= 2 && uniform.separated == 0,
            "{name}: {uniform:?}"
        );
        assert!(uniform.refused > uniform.splits);
        // "A better result", but with crumbs and a long seam.
        assert!(
            alternating_divides.contains(&alternating.divided),
            "{name}: {alternating:?}"
        );
        assert_eq!((alternating.separated, alternating.lost), (CUTS, 0));
        assert!(alternating.crumbs > CUTS, "{name}: {alternating:?}");
        assert!(alternating.ratio_max > 2.0, "{name}: {alternating:?}");
        assert!(alternating.splits > 3 * uniform.splits / 2);
        assert_eq!((partition.divided, partition.separated), (CUTS, CUTS));
        assert_eq!(
            (partition.crumbs, partition.lost, partition.refused),
            (0, 0, 0)
        );
        assert!(partition.ratio_max < 1.5 && partition.deviation_max_edges < 1.2);
    }
}

/// "User picks two points on the screen to define the line segment in red. It is used to
/// cut the waving flag" (Fig. 4). The eye looks at the flag from the side.
#[test]
fn figure_4_a_waving_flag_is_cut_between_two_picked_points() {
    let (mesh, flat) = shapes::grid(32, 32);
    let wave = |p: &Point| [p.x, p.y, 0.1 * p.x * (9.0 * p.x - p.y).sin()];
    let points: Vec<_> = flat.as_slice().iter().map(wave).collect();
    let eye = Point::new(0.2, -0.3, 3.0);
    let pick = |x: f64, y: f64| Ray::new(eye, Point::new(x, y, 0.0) - eye).expect("a ray");
    let segment = Scissor::new(pick(0.31, 0.2), pick(0.36, 0.8)).expect("one eye");
    for method in ALONG_EDGES {
        let (mut mesh, mut positions) = (
            mesh.clone(),
            Positions::new(points.clone()).expect("finite"),
        );
        let vertices = mesh.vertex_count();
        let (_, report) = segment
            .cut_measured(method, &mut mesh, &mut positions, &mut Edits::new())
            .expect("in step");
        assert_eq!(mesh.check(), []);
        // A slit: one piece still, with a hole, unless the method leaves crumbs.
        assert_eq!((report.pieces_expected, report.lost), (1, 0));
        assert!(
            method == CutMethod::Alternating || report.crumbs == 0,
            "{report:?}"
        );
        assert!(
            report.separated == (method != CutMethod::Uniform),
            "{method:?}: {report:?}"
        );
        assert!(report.splits > 10);
        // Only what the segment covers on the screen was split.
        for v in mesh.vertices().skip(vertices) {
            let on_screen = eye + (positions.at(v) - eye) * (eye.z / (eye.z - positions.at(v).z));
            assert!(
                (0.19..0.81).contains(&on_screen.y),
                "{method:?}: {on_screen}"
            );
            assert!((on_screen.x - 0.335).abs() < 0.1, "{method:?}: {on_screen}");
        }
    }
}

#[test]
fn the_report_knows_the_worst_face_and_the_mean_edge() {
    let (mut mesh, mut positions) = built(&delaunay(300, 30, &mut Random(9)));
    let down = Vector::new(0.0, 0.0, -1.0);
    let ray = |x: f64, y: f64| Ray::new(Point::new(x, y, 5.0), down).expect("a ray");
    let scissor = Scissor::new(ray(0.3, -1.0), ray(0.6, 2.0)).expect("a plane");
    let (mut angle, mut altitude) = (f64::INFINITY, f64::INFINITY);
    let mut edges = std::collections::BTreeMap::new();
    for face in mesh.indices().chunks(3) {
        let [a, b, c] = [0, 1, 2].map(|i| positions.as_slice()[face[i] as usize]);
        let sides = [(b - c).norm(), (c - a).norm(), (a - b).norm()];
        let half = sides.iter().sum::<f64>() / 2.0;
        let area = sides
            .iter()
            .fold(half, |product, side| product * (half - side))
            .sqrt();
        for i in 0..3 {
            let [x, y, z] = [sides[i], sides[(i + 1) % 3], sides[(i + 2) % 3]];
            angle = angle.min(
                ((y * y + z * z - x * x) / (2.0 * y * z))
                    .acos()
                    .to_degrees(),
            );
            altitude = altitude.min(2.0 * area / x);
            let (v, w) = (face[(i + 1) % 3], face[(i + 2) % 3]);
            edges.insert((v.min(w), v.max(w)), x);
        }
    }
    let mean_edge = edges.values().sum::<f64>() / edges.len() as f64;
    let (_, report) = scissor
        .cut_measured(
            CutMethod::Partition,
            &mut mesh,
            &mut positions,
            &mut Edits::new(),
        )
        .expect("in step");
    assert!(
        (report.angle_min_deg - angle).abs() < 1e-9,
        "{angle} {report:?}"
    );
    assert!(
        (report.altitude_min - altitude).abs() < 1e-12,
        "{altitude} {report:?}"
    );
    let ratio = report.seam_deviation_max / report.seam_deviation_max_edges;
    assert!((ratio - mean_edge).abs() < 1e-12, "{mean_edge} {report:?}");
}

//! Reports of cuts against what can be read off the mesh.

use std::collections::{BTreeMap, BTreeSet};

use tearmesh::{
    Cut, CutEnd, CutError, CutMethod, CutReport, Edits, FaceId, HalfEdgeId, Mesh, Plane, Point,
    Positions, Scissor, Side, Vector, VertexId, shapes, split,
};

use crate::random::Random;
use crate::straight::{Case, cases, judged};
use crate::work::{ALONG_EDGES, METHODS, Work, between, down, is_measured, ray};

/// A mesh that was whole, after a cut.
struct Made {
    name: String,
    work: Work,
    cut: Cut,
    report: CutReport,
}

impl Made {
    fn new(case: &Case, scissor: &Scissor, method: CutMethod) -> Made {
        let mut work = Work::of(&case.before);
        let (cut, report) = work.cut(method, scissor);
        Made {
            name: format!("{} by {method:?}", case.name),
            work,
            cut,
            report,
        }
    }

    /// The vertices at the ends of a half-edge, as they were before the cut split any.
    fn roots(&self, h: HalfEdgeId) -> [VertexId; 2] {
        let mesh = &self.work.mesh;
        [mesh.origin(h), mesh.target(h)].map(|v| mesh.root(v))
    }

    fn lips(&self) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let lines = self.cut.seam();
        lines.flat_map(|line| line.lips.as_flattened().iter().copied())
    }

    /// How far the centre of a face is in front of a plane.
    fn height(&self, plane: &Plane, f: FaceId) -> f64 {
        let corners = self.work.mesh.face_vertices(f);
        let heights = corners.map(|v| plane.distance(self.work.positions.at(v)));
        heights.iter().sum::<f64>() / 3.0
    }

    /// In lines that are as long as they can be.
    fn the_seam_is_all_that_was_torn(&self, method: CutMethod) {
        let (mesh, what) = (&self.work.mesh, &self.name);
        let lips: Vec<HalfEdgeId> = self.lips().collect();
        let told: BTreeSet<HalfEdgeId> = lips.iter().copied().collect();
        let is_torn = |h: &HalfEdgeId| mesh.ghost_pair(*h).is_some();
        let torn: BTreeSet<HalfEdgeId> = mesh.half_edges().filter(is_torn).collect();
        assert_eq!((told.len(), &told), (lips.len(), &torn), "{what}");
        // How many edges of the seam end at each vertex.
        let mut ends: BTreeMap<VertexId, usize> = BTreeMap::new();
        for &h in &torn {
            *ends.entry(self.roots(h)[0]).or_default() += 1;
        }
        for line in self.cut.seam() {
            for &[front, back] in &line.lips {
                assert_eq!(mesh.ghost_pair(front), Some(back), "{what}");
            }
            for two in line.lips.windows(2) {
                let [[one, across_one], [other, across_other]] = [two[0], two[1]];
                let joint = self.roots(other)[0];
                assert_eq!(self.roots(one)[1], joint, "{what}");
                assert_eq!(self.roots(across_other)[1], self.roots(across_one)[0]);
                assert_eq!(ends[&joint], 2, "{what}: lines end at branches");
            }
            let [first, last] = [line.lips[0][0], line.lips[line.lips.len() - 1][0]];
            let at = [self.roots(first)[0], self.roots(last)[1]];
            for (v, tip) in at.into_iter().zip(line.tips) {
                let copies = mesh.vertices().filter(|&w| mesh.root(w) == v);
                let is_whole = copies.count() == 1;
                let ours = METHODS[..2].contains(&method);
                // The paper's may leave the lips of one line joined where others part.
                let is_tip = tip == is_whole.then_some(v);
                assert!(is_tip || (!ours && !is_whole), "{what}");
            }
        }
    }

    /// How many there are in front, behind, and of neither or both.
    fn pieces_lie_where_their_seams_do(&self) -> [usize; 3] {
        let mut counts = [0; 3];
        let pieces = self.cut.pieces(&self.work.mesh);
        assert_eq!(pieces.components, self.work.mesh.components());
        for (i, &side) in pieces.sides.iter().enumerate() {
            let own = self.lips().map(HalfEdgeId::face);
            let own = own.filter(|&f| pieces.components.of(f) == i);
            let sides: BTreeSet<Side> = own.filter_map(|f| self.cut.side(f)).collect();
            let only = sides.first().copied().filter(|_| sides.len() == 1);
            assert_eq!(side, only, "{}", self.name);
            counts[side.map_or(2, |side| side as usize)] += 1;
        }
        counts
    }

    /// All that is told, as text.
    fn told(&self, cut: &Cut) -> String {
        let lines = cut.seam().map(|line| format!("{line:?}"));
        let lines: Vec<String> = lines.collect();
        format!("{lines:?} {:?} {:?}", cut.sides(), cut.ends())
    }

    fn measuring_changes_nothing(&self, case: &Case, scissor: &Scissor, method: CutMethod) {
        let mut work = Work::of(&case.before);
        let (mesh, positions) = (&mut work.mesh, &mut work.positions);
        let made = scissor.cut(method, mesh, positions, &mut work.edits);
        assert_eq!(self.told(&made.expect("in step")), self.told(&self.cut));
        assert_eq!(work.mesh, self.work.mesh);
    }

    fn a_plane_cuts_as_two_rays_through_everything_do(&self, case: &Case, method: CutMethod) {
        let through = case.scissor().with_through(true);
        let by_rays = Made::new(case, &through, method);
        let before = Work::of(&case.before);
        let aimed = through.aimed_at(&before.mesh, &before.positions);
        let alone = Scissor::by_plane(aimed.expect("no side planes").plane());
        assert_eq!(alone.sides(), None);
        let by_plane = Made::new(case, &alone.with_through(false), method);
        assert_eq!(by_plane.work.mesh, by_rays.work.mesh, "{}", self.name);
        let [bits, others] = [&by_plane, &by_rays].map(|made| made.work.positions.as_slice());
        assert_eq!(bits, others);
        assert_eq!(by_plane.cut.sides(), by_rays.cut.sides());
        assert!(by_plane.cut.seam().eq(by_rays.cut.seam()));
        assert_eq!(by_plane.cut.ends(), None);
    }

    fn the_nearest_vertex_is_that_of_a_plain_loop(&self, case: &Case, scissor: &Scissor) {
        let sides = scissor.sides().filter(|_| !case.cut.sides.is_empty());
        let off = |&p: &[f64; 3]| {
            let p = Point::from(p);
            let sides = sides.as_slice().as_flattened().iter();
            let outside = sides.map(|side| -side.distance(p)).fold(0.0, f64::max);
            scissor.plane().distance(p).hypot(outside)
        };
        let nearest = case.before.points.iter().map(off);
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        let off = (self.report.nearest_vertex - nearest).abs();
        assert!(off < 1e-12, "{}: {nearest}", self.name);
    }

    /// The methods that add no face leave all corners where they are.
    fn no_corner_moves(&self, case: &Case) {
        let was = case.before.faces.as_flattened().iter();
        let was = was.map(|&v| Point::from(case.before.points[v as usize]));
        let mesh = &self.work.mesh;
        let is = mesh
            .half_edges()
            .map(|h| self.work.positions.at(mesh.origin(h)));
        assert!(is.eq(was), "{}", self.name);
    }
}

#[test]
fn a_cut_tells_what_the_mesh_shows() {
    let (mut lines, mut pieces) = ([0; 4], [0; 3]);
    for case in cases() {
        for (method, count) in METHODS.into_iter().zip(&mut lines) {
            let scissor = case.scissor();
            let made = Made::new(case, &scissor, method);
            made.the_seam_is_all_that_was_torn(method);
            if method == CutMethod::Exact {
                let sides = made.pieces_lie_where_their_seams_do();
                pieces = [0, 1, 2].map(|i| pieces[i] + sides[i]);
            }
            made.measuring_changes_nothing(case, &scissor, method);
            made.a_plane_cuts_as_two_rays_through_everything_do(case, method);
            made.the_nearest_vertex_is_that_of_a_plain_loop(case, &scissor);
            is_measured(
                &made.report,
                &made.work,
                case.before.mean_edge(),
                &made.name,
            );
            if ALONG_EDGES.contains(&method) {
                made.no_corner_moves(case);
            }
            *count += made.cut.seam().len();
        }
    }
    assert!(lines.into_iter().all(|count| count > 100), "{lines:?}");
    assert!(pieces.into_iter().all(|count| count > 20), "{pieces:?}");
}

#[test]
fn straight_cuts_satisfy_the_oracle_and_tell_what_it_sees() {
    let (mut tips_of_all, mut faces, mut sideless) = (0, 0, 0);
    for case in cases() {
        let scissor = case.scissor().with_snap(0.0);
        let made = Made::new(case, &scissor, CutMethod::Exact);
        let facts = judged(&case.before, &case.cut, &made.work.surface(), case.name);
        let report = &made.report;
        let counts = [report.pieces, report.lost, report.crumbs];
        assert_eq!(counts, [facts.pieces, 0, 0], "{}: {report:?}", case.name);
        assert!(report.separated, "{report:?}");
        let straight = (report.seam_length_ratio - 1.0).abs() < 1e-9;
        assert!(straight || report.missed, "{report:?}");
        let over = report.tip_overshoots.iter().any(|over| over.abs() > 1e-12);
        assert!(!over && report.seam_deviation_max < 1e-12, "{report:?}");
        let tips: Vec<VertexId> = made.cut.tips().collect();
        assert_eq!(tips.len(), facts.tips, "{}", case.name);
        // The oracle sees lines that meet at one place as one.
        if case.name != "torn" {
            assert_eq!(made.cut.seam().len(), facts.chains, "{}", case.name);
        }
        tips_of_all += facts.tips;

        let mesh = &made.work.mesh;
        let on_seam: BTreeSet<VertexId> = made.lips().flat_map(|h| made.roots(h)).collect();
        let is_on_seam = |v: &VertexId| on_seam.contains(&mesh.root(*v));
        let touches = |f: &FaceId| mesh.face_vertices(*f).iter().any(is_on_seam);
        let sides = made.cut.sides().iter().map(|&(f, _)| f);
        assert!(sides.eq(mesh.faces().filter(touches)), "{}", case.name);
        for &(f, side) in made.cut.sides() {
            let height = made.height(&scissor.plane(), f);
            let is_at_tip = mesh.face_vertices(f).iter().any(|v| tips.contains(v));
            assert!(side.is_some() || is_at_tip, "{}: {f} has none", case.name);
            let is_right = side.is_none_or(|side| side == Side::of(height));
            assert!(is_right, "{f} at {height}");
            faces += 1;
            sideless += usize::from(side.is_none());
        }
        for [front, back] in made.cut.seam().flat_map(|line| &line.lips) {
            let heights = [front, back].map(|h| made.height(&scissor.plane(), h.face()));
            assert!(heights[0] > 0.0 && heights[1] < 0.0, "{heights:?}");
        }
    }
    assert!(cases().len() >= 400, "only {} cuts", cases().len());
    assert!(tips_of_all > 100 && faces > 5000 && sideless < tips_of_all * 2);
}

#[test]
fn ends_of_cuts_follow_splits_and_renumbering() {
    let mut work = Work::new(shapes::grid(8, 8));
    let (cut, _) = work.cut(CutMethod::Exact, &between([0.21, 0.33], [0.58, 0.41]));
    let seen = work.edits.cursor();
    let [_, mut end] = cut.ends().cloned().expect("there are rays");
    let &[tip] = end.vertices() else {
        panic!("one sheet has one tip: {:?}", end.vertices())
    };
    assert!(cut.tips().any(|v| v == tip));
    let place = work.positions.at(tip);
    // Split as a tear would split it, so that there are two of it.
    let face = work.mesh.faces_of(tip).next().expect("a tip has faces");
    split::vertex(&mut work.mesh, tip, &[face], &mut work.edits).expect("it has others");
    work.follow();
    let goes_on = |end: &CutEnd, work: &mut Work| {
        let to = ray(down([0.8, 0.7]));
        let scissor = Scissor::continued(end, to, &work.positions).expect("a plane");
        let (mesh, positions) = (&mut work.mesh, &mut work.positions);
        scissor.cut(CutMethod::Exact, mesh, positions, &mut work.edits)
    };
    let made = work.edits.cursor();
    let stale = goes_on(&end, &mut work).err();
    assert_eq!(stale, Some(CutError::End { seen, made }));
    work.edits.replay(&mut end);
    assert_eq!(end.vertices().len(), 2);
    // Sew the slit up to the tip, which frees ids, so that the last vertices take them.
    let positions = work.positions.clone();
    work.sew(|v| positions.at(v) != place);
    work.edits.replay(&mut end);
    let there = end.vertices().iter().map(|&v| work.positions.at(v));
    assert_eq!(there.collect::<Vec<_>>(), [place; 2]);
    let loops = work.mesh.boundary_loops().len();
    let cut = goes_on(&end, &mut work).expect("in step");
    assert!(cut.seam().len() > 0);
    // One slit with that of the tip.
    assert_eq!(work.mesh.boundary_loops().len(), loops);
    assert_eq!(work.mesh.check(), []);
}

#[test]
fn a_slit_led_by_a_hundred_places_is_one_slit() {
    let mut random = Random(101);
    for round in 0..20 {
        // A mouse that goes round a circle and out of it, in steps from tiny to some edges.
        let (mut mesh, mut positions) = shapes::grid(20, 20);
        let mut place = |i: usize| {
            let turn = 0.045 * i as f64 + 0.02 * random.next();
            let far = 0.2 + 0.002 * i as f64;
            ray(down([0.5 + far * turn.cos(), 0.5 + far * turn.sin()]))
        };
        let (mut edits, mut splits) = (Edits::new(), 0);
        let mut scissor = Scissor::new(place(0), place(1)).expect("a plane");
        for i in 2..=101 {
            let (mesh, positions) = (&mut mesh, &mut positions);
            let made = scissor.cut(CutMethod::Exact, mesh, positions, &mut edits);
            let cut = made.expect("in step");
            splits += edits.len();
            edits.clear();
            let [_, end] = cut.ends().expect("there are rays");
            scissor = Scissor::continued(end, place(i), positions).expect("a plane");
        }
        assert_eq!(mesh.check(), []);
        assert!(splits > 100, "{splits}");
        assert_eq!(mesh.boundary_loops().len(), 2, "round {round}");
    }
}

#[test]
fn a_face_on_the_plane_has_the_side_of_those_round_it() {
    // A step: a tread on the plane between two risers, one below and one above.
    let points = [0.0, 1.0].map(|y| [[0., y, -1.], [0., y, 0.], [1., y, 0.], [1., y, 1.]]);
    let faces = [0u32, 1, 2].map(|i| [[i, i + 1, i + 5], [i, i + 5, i + 4]]);
    let positions = Positions::new(points.concat()).expect("finite");
    let mesh = Mesh::build(8, faces.concat()).expect("a strip");
    let level = Plane::new(Point::origin(), Vector::z()).expect("a normal");
    let mut work = Work::new((mesh, positions));
    let (cut, _) = work.cut(CutMethod::Exact, &Scissor::by_plane(level));
    let side = |f: usize| cut.side(FaceId::new(f).expect("an id"));
    assert_eq!([0, 1].map(side), [Some(Side::Back); 2]);
    // Where what is round disagrees, zero is in front.
    assert_eq!([2, 3].map(side), [Some(Side::Front); 2]);
    let sides = cut.pieces(&work.mesh).sides;
    assert_eq!(sides, [Some(Side::Back), Some(Side::Front)]);
}

/// A crossing on one side of a tear inserts on the other side too, in faces that are nowhere near the plane
/// once the sides have moved apart.
#[test]
fn a_report_counts_faces_that_a_cut_divides_far_from_its_plane() {
    let along = |point: [f64; 3], normal: [f64; 3]| {
        let plane = Plane::new(Point::from(point), Vector::from(normal));
        Scissor::by_plane(plane.expect("a normal"))
    };
    for (shift, pieces) in [(0.3, 4), (1.7, 3)] {
        let (mut mesh, mut positions) = shapes::grid(8, 8);
        let (apart, mut edits) = (along([0.52, 0.0, 0.0], [1.0, 0.0, 0.0]), Edits::new());
        let cut = apart.cut(CutMethod::Partition, &mut mesh, &mut positions, &mut edits);
        cut.expect("positions are in step");
        let sides = mesh.components();
        let moved = mesh.vertices().map(|v| {
            let f = mesh.faces_of(v).next().expect("a vertex has a face");
            positions.at(v) + Vector::y() * (shift * sides.of(f) as f64)
        });
        let moved = Positions::new(moved).expect("coordinates are finite");
        let mut work = Work::new((mesh, moved));
        let (_, report) = work.cut(CutMethod::Exact, &along([0.0, 0.43, 0.0], [0.0, 1.0, 0.0]));
        assert_eq!((report.pieces_before, report.pieces), (2, pieces));
    }
}

//! What a cut tells of itself, against what can be read off the mesh.

use std::collections::{BTreeMap, BTreeSet};

use tearmesh::{
    Cut, CutEnd, CutError, CutMethod, Edits, FaceId, HalfEdgeId, Mesh, Plane, Point, Positions,
    Scissor, Side, Vector, VertexId, mend, shapes, split,
};

use crate::exact::{ray, scissor};
use crate::oracle::straight::judge;
use crate::random::Random;
use crate::straight::{built, cases, down, is_worst_of_faces, surface};

/// All ways to cut, first the one that adds faces.
pub(crate) const METHODS: [CutMethod; 4] = [
    CutMethod::Exact,
    CutMethod::Partition,
    CutMethod::Uniform,
    CutMethod::Alternating,
];

/// The ways to cut along edges, that add no face.
pub(crate) const ALONG_EDGES: [CutMethod; 3] = [METHODS[1], METHODS[2], METHODS[3]];

/// A mesh that was whole, after a cut.
struct Made {
    mesh: Mesh,
    positions: Positions,
    cut: Cut,
}

impl Made {
    fn new(before: &(Mesh, Positions), scissor: &Scissor, method: CutMethod) -> Made {
        let (mut mesh, mut positions) = before.clone();
        let cut = scissor.cut(method, &mut mesh, &mut positions, &mut Edits::new());
        let cut = cut.expect("positions are in step");
        Made {
            mesh,
            positions,
            cut,
        }
    }

    /// The vertices at the ends of a half-edge, as they were before the cut split any.
    fn roots(&self, h: HalfEdgeId) -> [VertexId; 2] {
        [self.mesh.origin(h), self.mesh.target(h)].map(|v| self.mesh.root(v))
    }

    /// How far the centre of a face is in front of a plane.
    fn height(&self, plane: &Plane, f: FaceId) -> f64 {
        let corners = self.mesh.face_vertices(f).map(|v| self.positions.at(v));
        let [a, b, c] = corners.map(|p| plane.distance(p));
        (a + b + c) / 3.0
    }

    /// The seam is all that is torn, in lines that are as long as they can be.
    fn check_seam(&self, method: CutMethod, what: &str) {
        let lips = self.cut.seam().flat_map(|line| line.lips.iter().flatten());
        let lips: Vec<HalfEdgeId> = lips.copied().collect();
        let told: BTreeSet<HalfEdgeId> = lips.iter().copied().collect();
        let is_torn = |h: &HalfEdgeId| self.mesh.ghost_pair(*h).is_some();
        let torn: BTreeSet<HalfEdgeId> = self.mesh.half_edges().filter(is_torn).collect();
        assert_eq!((told.len(), &told), (lips.len(), &torn), "{what}");
        // How many edges of the seam end at each vertex.
        let mut ends: BTreeMap<VertexId, usize> = BTreeMap::new();
        for &h in &torn {
            let [from, _] = self.roots(h);
            *ends.entry(from).or_default() += 1;
        }
        for line in self.cut.seam() {
            for &[front, back] in line.lips {
                assert_eq!(self.mesh.ghost_pair(front), Some(back), "{what}");
            }
            for two in line.lips.windows(2) {
                let [[one, across_one], [other, across_other]] = [two[0], two[1]];
                assert_eq!(self.roots(one)[1], self.roots(other)[0], "{what}");
                assert_eq!(self.roots(across_other)[1], self.roots(across_one)[0]);
                assert_eq!(
                    ends[&self.roots(other)[0]],
                    2,
                    "{what}: lines end at branches"
                );
            }
            let [first, last] = [line.lips[0][0], line.lips[line.lips.len() - 1][0]];
            let at = [self.roots(first)[0], self.roots(last)[1]];
            for (v, tip) in at.into_iter().zip(line.tips) {
                let copies = self.mesh.vertices().filter(|&w| self.mesh.root(w) == v);
                let is_whole = copies.count() == 1;
                let ours = matches!(method, CutMethod::Exact | CutMethod::Partition);
                // The paper's may leave the lips of one line joined where others part.
                assert!(
                    tip == is_whole.then_some(v) || (!ours && !is_whole),
                    "{what}"
                );
            }
        }
    }

    /// The faces with a vertex on the seam.
    fn faces_at_the_seam(&self) -> BTreeSet<FaceId> {
        let lips = self.cut.seam().flat_map(|line| line.lips.iter().flatten());
        let on_seam: BTreeSet<VertexId> = lips.flat_map(|&h| self.roots(h)).collect();
        let touches = |f: &FaceId| {
            let corners = self.mesh.face_vertices(*f);
            corners
                .iter()
                .any(|&v| on_seam.contains(&self.mesh.root(v)))
        };
        self.mesh.faces().filter(touches).collect()
    }
}

#[test]
fn the_seam_is_all_that_was_torn_in_order() {
    let (mut lines, mut edges) = ([0; 4], 0);
    for case in cases(52) {
        for (method, count) in METHODS.into_iter().zip(&mut lines) {
            let made = Made::new(&built(&case.before), &case.scissor(), method);
            made.check_seam(method, &format!("{} by {method:?}", case.name));
            *count += made.cut.seam().len();
            edges += made.cut.seam().map(|line| line.lips.len()).sum::<usize>();
        }
    }
    println!("{edges} edges; numbers of lines by method: {lines:?}");
    assert!(lines.into_iter().all(|count| count > 100) && edges > 10_000);
}

#[test]
fn a_straight_seam_has_the_lines_tips_and_sides_that_the_oracle_sees() {
    let (mut tips, mut faces, mut sideless) = (0, 0, 0);
    for case in cases(57) {
        let scissor = case.scissor().snap(0.0);
        let made = Made::new(&built(&case.before), &scissor, CutMethod::Exact);
        let after = surface(&(made.mesh.clone(), made.positions.clone()));
        let facts = judge(&case.before, &case.cut, &after).expect("a straight cut");
        assert_eq!(made.cut.tips().count(), facts.tips, "{}", case.name);
        // The oracle sees lines that meet at one place as one.
        if case.name != "torn" {
            assert_eq!(made.cut.seam().len(), facts.chains, "{}", case.name);
        }
        tips += facts.tips;

        let sides: BTreeSet<FaceId> = made.cut.sides().iter().map(|&(f, _)| f).collect();
        assert_eq!(sides, made.faces_at_the_seam(), "{}", case.name);
        let tips: Vec<VertexId> = made.cut.tips().collect();
        for &(f, side) in made.cut.sides() {
            let height = made.height(&scissor.plane(), f);
            let is_at_tip = made.mesh.face_vertices(f).iter().any(|v| tips.contains(v));
            assert!(
                side.is_some() || is_at_tip,
                "{}: {f} has no side",
                case.name
            );
            assert!(
                side.is_none_or(|side| side == Side::of(height)),
                "{f} at {height}"
            );
            faces += 1;
            sideless += usize::from(side.is_none());
        }
        for [front, back] in made.cut.seam().flat_map(|line| line.lips) {
            let heights = [front, back].map(|h| made.height(&scissor.plane(), h.face()));
            assert!(heights[0] > 0.0 && heights[1] < 0.0, "{heights:?}");
        }
    }
    println!("{faces} faces, {sideless} on both sides of a tip; {tips} tips");
    assert!(tips > 100 && faces > 5000 && sideless < tips * 2);
}

#[test]
fn pieces_lie_where_their_seams_do() {
    let mut counts = [0; 3];
    for case in cases(59) {
        let made = Made::new(&built(&case.before), &case.scissor(), CutMethod::Exact);
        let pieces = made.cut.pieces(&made.mesh);
        assert_eq!(pieces.components, made.mesh.components());
        for (i, &side) in pieces.sides.iter().enumerate() {
            let of_piece = made.cut.seam().flat_map(|line| line.lips).flatten();
            let of_piece = of_piece.filter(|h| pieces.components.of(h.face()) == i);
            let sides: BTreeSet<Side> = of_piece.filter_map(|h| made.cut.side(h.face())).collect();
            let only = sides.first().copied().filter(|_| sides.len() == 1);
            assert_eq!(side, only, "{}", case.name);
            counts[side.map_or(2, |side| side as usize)] += 1;
        }
    }
    println!("{counts:?} pieces in front, behind, and of neither or both");
    assert!(counts.into_iter().all(|count| count > 20), "{counts:?}");
}

#[test]
fn a_plane_cuts_as_two_rays_through_everything_do() {
    for case in cases(61) {
        for method in METHODS {
            let through = case.scissor().through(true);
            let by_rays = Made::new(&built(&case.before), &through, method);
            let alone = Scissor::by_plane(through.plane());
            assert_eq!(alone.sides(), None);
            let by_plane = Made::new(&built(&case.before), &alone.through(false), method);
            assert_eq!(by_plane.mesh, by_rays.mesh, "{} by {method:?}", case.name);
            let [bits, others] = [&by_plane, &by_rays].map(|made| made.positions.as_slice());
            assert_eq!(bits, others);
            assert_eq!(by_plane.cut.sides(), by_rays.cut.sides());
            assert!(by_plane.cut.seam().eq(by_rays.cut.seam()));
            assert_eq!(by_plane.cut.ends(), None);
        }
    }
}

#[test]
fn lent_memory_and_measuring_change_nothing() {
    let mut lent = Cut::default();
    for (i, case) in cases(63).into_iter().enumerate() {
        let (before, method) = (built(&case.before), METHODS[i % 4]);
        let made = Made::new(&before, &case.scissor(), method);
        let told = |cut: &Cut| {
            let lines = cut.seam().map(|line| format!("{line:?}"));
            let lines: Vec<String> = lines.collect();
            (lines, cut.sides().to_vec(), format!("{:?}", cut.ends()))
        };
        let (mut mesh, mut positions, mut edits) =
            (before.0.clone(), before.1.clone(), Edits::new());
        let scissor = case.scissor();
        scissor
            .cut_into(method, &mut mesh, &mut positions, &mut edits, &mut lent)
            .expect("in step");
        assert_eq!((told(&lent), &mesh), (told(&made.cut), &made.mesh));
        let (mut mesh, mut positions, mut edits) = (before.0, before.1, Edits::new());
        let measured = scissor.cut_measured(method, &mut mesh, &mut positions, &mut edits);
        let (cut, report) = measured.expect("in step");
        assert_eq!((told(&cut), &mesh), (told(&made.cut), &made.mesh));
        assert_eq!(
            report.ghost_pairs,
            cut.seam().map(|line| 2 * line.lips.len()).sum()
        );
    }
}

#[test]
fn what_is_measured_of_all_faces_and_vertices_is_so() {
    for (i, case) in cases(67).into_iter().enumerate() {
        let ((mut mesh, mut positions), scissor) = (built(&case.before), case.scissor());
        let plane = scissor.plane();
        let sides = scissor.sides().filter(|_| !case.cut.sides.is_empty());
        let off = |&p: &Point| {
            let sides = sides.as_slice().as_flattened();
            let outside = sides
                .iter()
                .map(|side| -side.distance(p))
                .fold(0.0, f64::max);
            plane.distance(p).hypot(outside)
        };
        let nearest = positions
            .as_slice()
            .iter()
            .map(off)
            .fold(f64::INFINITY, f64::min);
        let method = METHODS[i % 4];
        let made = scissor.cut_measured(method, &mut mesh, &mut positions, &mut Edits::new());
        let (_, report) = made.expect("in step");
        assert!(
            (report.nearest_vertex - nearest).abs() < 1e-12,
            "{}",
            case.name
        );
        is_worst_of_faces(&report, &mesh, &positions, case.name);
    }
}

/// A sheet with a slit in it, and the log so far.
fn slit_sheet() -> (Mesh, Positions, Edits, Cut) {
    let (mut mesh, mut positions) = shapes::grid(8, 8);
    let mut edits = Edits::new();
    let slit = scissor([down([0.21, 0.33]), down([0.58, 0.41])]);
    let cut = slit.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
    (mesh, positions, edits, cut.expect("in step"))
}

#[test]
fn an_end_is_its_vertex_whatever_is_done_to_the_mesh_since() {
    let (mut mesh, mut positions, mut edits, cut) = slit_sheet();
    let seen = edits.cursor();
    let [_, mut end] = cut.ends().cloned().expect("there are rays");
    let &[tip] = end.vertices() else {
        panic!("one sheet has one tip: {:?}", end.vertices())
    };
    assert!(cut.tips().any(|v| v == tip));
    let place = positions.at(tip);
    let there = |end: &CutEnd, positions: &Positions| {
        let mut at = end.vertices().iter().map(|&v| positions.at(v));
        at.all(|at| at == place)
    };
    // Split as a tear would split it, so that there are two of it.
    let face = mesh.faces_of(tip).next().expect("a tip has faces");
    split::vertex(&mut mesh, tip, &[face], &mut edits).expect("it has others");
    edits.replay(&mut positions);
    let goes_on = |end: &CutEnd, positions: &Positions| {
        Scissor::continued(end, ray(down([0.8, 0.7])), positions).expect("a plane")
    };
    let stale = goes_on(&end, &positions);
    let refused = stale.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
    let made = edits.cursor();
    assert_eq!(refused.err(), Some(CutError::End { seen, made }));
    edits.replay(&mut end);
    assert_eq!(end.vertices().len(), 2);
    // Sew the slit up to the tip, which frees ids, so that the last vertices take them.
    let sewn = mend::stitches(&mesh, |v| positions.at(v) != place);
    mend::sew(&mut mesh, &positions, &sewn, |_| 1.0, 0.0, &mut edits).expect("untouched since");
    edits.replay(&mut (&mut positions, &mut end));
    assert!(there(&end, &positions) && end.vertices().len() == 2);
    let loops = mesh.boundary_loops().len();
    let cut =
        goes_on(&end, &positions).cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
    assert!(cut.expect("in step").seam().len() > 0);
    assert_eq!(
        mesh.boundary_loops().len(),
        loops,
        "one slit with that of the tip"
    );
    assert_eq!(mesh.check(), []);
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
        let (mut edits, mut cut) = (Edits::new(), Cut::default());
        let mut scissor = Scissor::new(place(0), place(1)).expect("a plane");
        let mut splits = 0;
        for i in 2..=101 {
            let made = scissor.cut_into(
                CutMethod::Exact,
                &mut mesh,
                &mut positions,
                &mut edits,
                &mut cut,
            );
            made.expect("in step");
            splits += edits.len();
            edits.clear();
            let [_, end] = cut.ends().expect("there are rays");
            scissor = Scissor::continued(end, place(i), &positions).expect("a plane");
        }
        assert_eq!(mesh.check(), []);
        assert!(splits > 100, "{splits}");
        assert_eq!(mesh.boundary_loops().len(), 2, "round {round}");
    }
}

#[test]
fn what_lies_on_the_plane_has_the_side_of_what_is_round_it() {
    // A step: a tread on the plane between two risers, one below and one above.
    let points = [0.0, 1.0].map(|y| [[0., y, -1.], [0., y, 0.], [1., y, 0.], [1., y, 1.]]);
    let triangles = [0u32, 1, 2].map(|i| [[i, i + 1, i + 5], [i, i + 5, i + 4]]);
    let mut positions = Positions::new(points.concat()).expect("finite");
    let mut mesh = Mesh::build(8, &triangles.concat()).expect("a strip");
    let level = Plane::new(Point::origin(), Vector::z()).expect("a normal");
    let cut = Scissor::by_plane(level);
    let cut = cut.cut(
        CutMethod::Exact,
        &mut mesh,
        &mut positions,
        &mut Edits::new(),
    );
    let cut = cut.expect("in step");
    let side = |f: usize| cut.side(FaceId::new(f).expect("an id"));
    assert_eq!([0, 1].map(side), [Some(Side::Back); 2]);
    // Where what is round disagrees, zero is in front.
    assert_eq!([2, 3].map(side), [Some(Side::Front); 2]);
    assert_eq!(
        cut.pieces(&mesh).sides,
        [Some(Side::Back), Some(Side::Front)]
    );
}

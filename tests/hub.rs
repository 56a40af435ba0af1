//! Vertices with very many faces: whatever touches one takes time linear in its faces, not in their
//! square.

use tearmesh::{
    CutMethod, FaceId, Mesh, Plane, Point, Positions, Scissor, Vector, VertexId, shapes, split,
};

use crate::random::Random;
use crate::work::{METHODS, Work, between, triangles};

/// With a square in it, cutting a fan of so many faces takes minutes.
const FACES: u32 = 50_000;

fn hub() -> VertexId {
    VertexId::new(0).expect("an id")
}

/// A fan whose rim has heights.
fn crown(faces: u32, closed: bool, mut height: impl FnMut() -> f64) -> (Mesh, Positions) {
    let (mesh, flat) = shapes::fan(faces, closed);
    let mut points = flat.as_slice().to_vec();
    points[1..].iter_mut().for_each(|p| p.z = height());
    (mesh, Positions::new(points).expect("they are finite"))
}

/// A flat fan is cut across, and crowns whose rims are before and behind the plane by turns into many fans.
#[test]
fn large_hubs_are_cut_by_all_methods_and_mended() {
    let level = Scissor::by_plane(Plane::new(Point::origin(), Vector::z()).expect("a plane"));
    let mut cuts = Vec::new();
    for closed in [true, false] {
        let mut i = 0;
        let crown = crown(FACES, closed, || {
            i += 1;
            if i % 8 < 4 { 0.5 } else { -0.5 }
        });
        cuts.push((Work::new(crown), level.clone(), FACES / 5));
    }
    let flat = Work::new(shapes::fan(FACES, true));
    for (y, x, through) in [(0.0, 0.5, false), (0.001, 2.0, true), (0.1, 0.5, false)] {
        let across = between([-x, y - 0.3 * x], [x, y + 0.3 * x]).with_through(through);
        cuts.push((flat.clone(), across, 0));
    }
    for (whole, scissor, least) in cuts {
        for method in METHODS {
            let mut work = whole.clone();
            let (_, report) = work.cut(method, &scissor);
            let is_apart = report.splits as u32 >= least && report.faces_crossed > 0;
            assert!(is_apart || method == CutMethod::Uniform, "{report:?}");
            work.sew_all();
            let is_whole = work.mesh == whole.mesh;
            assert!(method == CutMethod::Exact || is_whole, "{method:?}");
        }
    }
}

/// Face by face, until each has a vertex of its own.
#[test]
fn a_large_hub_is_torn_in_any_order_built_again_and_mended() {
    let mut random = Random(7);
    for order in ["ascending", "descending", "shuffled"] {
        let mut work = Work::new(shapes::fan(FACES, order == "shuffled"));
        let whole = work.mesh.clone();
        let mut all: Vec<FaceId> = whole.faces().collect();
        match order {
            "descending" => all.reverse(),
            "shuffled" => random.shuffle(&mut all),
            _ => {}
        }
        let last = all.pop().expect("a face");
        for &face in &all {
            split::vertex(&mut work.mesh, hub(), &[face], &mut work.edits).expect("one stays");
        }
        let refused = split::vertex(&mut work.mesh, hub(), &[last], &mut work.edits);
        assert!(matches!(
            refused,
            Err(split::SplitRefusal::Everything { .. })
        ));
        assert_eq!(work.mesh.half_edge_of(hub()).map(|h| h.face()), Some(last));
        work.follow();
        work.is_sound();
        for y in [0.001, 0.1] {
            let through = between([-2.0, y], [2.0, 1.1 * y]).with_through(true);
            let (_, report) = work.clone().cut(CutMethod::Exact, &through);
            assert!(report.faces_crossed > 0);
        }
        work.sew_all();
        assert_eq!(work.mesh, whole, "{order}");
    }
}

/// The paper's methods by [`split::by_plane`] alone, which looks at all faces of a vertex each time.
fn cut_by_paper(
    (point, normal): (Point, Vector),
    is_alternating: bool,
    work: &mut Work,
) -> [usize; 2] {
    let plane = Plane::new(point, normal).expect("a plane");
    let is_positive = |at: Point| plane.offset(at) >= 0.0;
    let count = |work: &Work, f| {
        let corners = work.mesh.face_vertices(f).map(|v| work.positions.at(v));
        corners.into_iter().filter(|&at| is_positive(at)).count()
    };
    let crossed = work
        .mesh
        .faces()
        .filter(|&f| [1, 2].contains(&count(work, f)));
    let crossed: Vec<FaceId> = crossed.collect();
    let [mut splits, mut refused] = [0; 2];
    for f in crossed {
        let corners = work.mesh.face_vertices(f).map(|v| work.positions.at(v));
        let negative = (0..3).find(|&i| !is_positive(corners[i]));
        let along_edge = (is_alternating && count(work, f) == 2).then(|| {
            let [c, d, e] = [1, 2, 3].map(|i| corners[(negative.expect("one") + i) % 3]);
            (d - c).cross(&(e - c)).cross(&(d - c))
        });
        for h in f.half_edges() {
            let v = work.mesh.origin(h);
            let at = work.positions.at(v);
            if !is_positive(at) {
                continue;
            }
            let plane = Plane::new(at, along_edge.unwrap_or(normal)).expect("it has an area");
            let (mesh, positions) = (&mut work.mesh, &work.positions);
            match split::by_plane(mesh, v, &plane, positions, &mut work.edits) {
                Some(_) => splits += 1,
                None => refused += 1,
            }
            work.edits.replay(&mut work.positions);
        }
    }
    [splits, refused]
}

/// Fans of any number of faces with rims of any height, flat on the plane here and there, and torn
/// before or not.
#[test]
fn the_papers_methods_at_a_hub_are_those_of_by_plane() {
    let mut random = Random(31);
    let mut splits_of_all = 0;
    for case in 0..600 {
        let faces = [12, 64, 65, 66, 150, 400][case % 6];
        let steps = [0.0, 2.0, 1000.0][case / 6 % 3];
        let mut height = || (steps * (random.next() - 0.5)).round() / f64::max(steps, 1.0);
        let (mesh, positions) = crown(faces, case % 4 < 2, &mut height);
        // In any order, so that a walk round the hub begins anywhere.
        let mut shuffled = triangles(&mesh).to_vec();
        random.shuffle(&mut shuffled);
        let mesh = Mesh::build(mesh.vertex_count(), &shuffled).expect("a fan");
        let mut work = Work::new((mesh, positions));
        for _ in 0..if case % 5 == 0 { 10 } else { 0 } {
            let f = FaceId::new(random.below(faces as usize)).expect("a face");
            let _refused = split::vertex(&mut work.mesh, hub(), &[f], &mut work.edits);
        }
        work.follow();
        let mut part = |scale: f64| scale * (random.next() - 0.5);
        let point = Point::new(0.0, [0.0, part(0.4)][case / 18 % 2], 0.0);
        let normal = match case / 36 % 3 {
            0 => Vector::z(),
            1 => Vector::new(part(1.0), part(1.0), part(1.0)),
            _ => Vector::new(part(1.0), part(1.0), 0.0),
        };
        for method in [CutMethod::Uniform, CutMethod::Alternating] {
            let (mut one, mut other) = (work.clone(), work.clone());
            let counts = cut_by_paper((point, normal), method == CutMethod::Alternating, &mut one);
            let scissor = Scissor::by_plane(Plane::new(point, normal).expect("a plane"));
            let (_, report) = other.cut(method, &scissor);
            let what = format!("case {case}, {method:?}");
            assert_eq!([report.splits, report.refused], counts, "{what}");
            assert!(one.mesh == other.mesh, "{what}");
            let [is, told] = [&one.edits, &other.edits];
            assert!(is.iter().eq(told.iter()), "{what}");
            splits_of_all += report.splits;
        }
    }
    assert!(splits_of_all > 5000, "{splits_of_all}");
}

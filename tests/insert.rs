//! Insertions and merges at the ends of what numbers and ids allow. (All else of them is in lock step.)

use tearmesh::insert::{ChordEnd, InsertRefusal, Plan};
use tearmesh::mend::{Stitch, StitchError};
use tearmesh::{Edits, HalfEdgeId, Mesh, VertexId, mend, shapes, split};

use crate::random::Random;

fn half_edge(index: usize) -> HalfEdgeId {
    HalfEdgeId::new(index).expect("a small number")
}

fn vertex(index: usize) -> VertexId {
    VertexId::new(index).expect("a small number")
}

#[test]
fn an_insertion_with_room_leaves_the_index_buffer_in_place() {
    let (built, _) = shapes::grid(4, 4);
    let mut mesh = built.clone();
    mesh.reserve_faces(2);
    assert_eq!(mesh, built);
    let diagonal = mesh.half_edges().find(|&h| mesh.pair(h).is_some());
    let mut plan = Plan::new();
    plan.on_edge(diagonal.expect("a grid has inner edges"), 0.5);
    let place = mesh.indices().as_ptr();
    plan.apply(&mut mesh, &mut Edits::new()).expect("a point");
    assert_eq!(mesh.face_count(), built.face_count() + 2);
    assert_eq!(mesh.indices().as_ptr(), place);
}

/// Inserts what makes no child without area, or refuses and changes nothing; why it was refused.
fn refused(whole: &Mesh, plan: &Plan) -> Option<InsertRefusal> {
    let (mut mesh, mut edits) = (whole.clone(), Edits::new());
    let refusal = match plan.apply(&mut mesh, &mut edits) {
        Ok(insert) => {
            let is_something = insert.children.iter().all(|child| child.share > 0.0);
            assert!(is_something, "{insert:?}");
            None
        }
        Err(refusal) => Some(refusal),
    };
    assert_eq!(mesh.check(), []);
    assert!(refusal.is_none() || mesh == *whole && edits.is_empty());
    refusal
}

/// Of all that cross a face with three points on its edges, no two are in one triangulation.
#[test]
fn chords_count_in_whatever_order_they_are_given() {
    let (square, _) = shapes::grid(1, 1);
    let mut shared = square.half_edges().filter(|&h| square.pair(h).is_some());
    let sides = [(); 2].map(|()| shared.next().expect("an edge with two faces"));
    for which in 0..16 {
        let made = [false, true].map(|is_backward| {
            let (mut mesh, mut plan) = (square.clone(), Plan::new());
            let on_shared = [0.25, 0.75].map(|t| plan.on_edge(sides[0], t));
            let mut chords = [0, 1].map(|side| {
                let (h, which) = (sides[side], which >> (2 * side));
                let beside = ChordEnd::Point(plan.on_edge(h.next(), 0.5));
                let one = [beside, ChordEnd::Corner(h.prev())][which & 1];
                (h.face(), [one, ChordEnd::Point(on_shared[which >> 1 & 1])])
            });
            if is_backward {
                chords.reverse();
            }
            chords.into_iter().for_each(|(f, ends)| plan.chord(f, ends));
            plan.apply(&mut mesh, &mut Edits::new()).expect("chords");
            mesh
        });
        assert_eq!(made[0], made[1], "chords {which}");
    }
}

/// The third point is on an edge from the first point, to the second or to a corner.
#[test]
fn a_point_on_an_edge_of_the_star_divides_it() {
    let (square, _) = shapes::grid(1, 1);
    let face = square.faces().next().expect("a face");
    let [first, second] = [[0.25, 0.25, 0.5], [0.375, 0.375, 0.25]];
    for third in [[0.3125, 0.3125, 0.375], [0.125, 0.625, 0.25]] {
        let mut plan = Plan::new();
        let points = [first, second, third].into_iter();
        points.for_each(|weights| _ = plan.in_face(face, weights));
        assert_eq!(refused(&square, &plan), None, "{third:?}");
    }
}

#[test]
fn a_second_chord_in_a_face_is_refused() {
    let (square, mut plan) = (shapes::grid(1, 1).0, Plan::new());
    let points = [0, 1, 2].map(|h| ChordEnd::Point(plan.on_edge(half_edge(h), 0.5)));
    let face = half_edge(0).face();
    plan.chord(face, [points[0], points[1]]);
    plan.chord(face, [points[1], points[2]]);
    assert_eq!(refused(&square, &plan), Some(InsertRefusal::Chord { face }));
}

/// Two points that rounding alone tells apart, given from either side of an edge: they are
/// refused, or every child still covers something.
#[test]
fn points_that_nearly_coincide_make_no_empty_child() {
    let mut random = Random(7);
    let mut count = 0;
    let (square, _) = shapes::grid(1, 1);
    let mut shared = square.half_edges().filter(|&h| square.pair(h).is_some());
    let [h, g] = [(); 2].map(|()| shared.next().expect("an edge with two faces"));
    for _ in 0..20_000 {
        let t = random.next().max(1e-9);
        let steps = random.below(5) as i64 - 2;
        let nearly = f64::from_bits((1.0 - t).to_bits().wrapping_add_signed(steps));
        let mut plan = Plan::new();
        plan.on_edge(h, t);
        plan.on_edge(g, nearly);
        match refused(&square, &plan) {
            None => {}
            Some(InsertRefusal::Repeated { .. } | InsertRefusal::Share { .. }) => count += 1,
            Some(other) => panic!("{other}"),
        }
    }
    assert!((1_000..19_000).contains(&count), "{count} were refused");
}

/// Between a corner and two points at the part t of its edges there is a child that covers t² of the
/// face, which may be no `f64`.
#[test]
fn regression_a_child_whose_share_would_be_zero_is_refused() {
    let whole = Mesh::build(3, &[[0, 1, 2]]).expect("a triangle");
    let halved = (2..1023).map(|k| 2f64.powi(-k));
    for t in halved.chain([5e-324]) {
        let mut plan = Plan::new();
        plan.on_edge(half_edge(0), t);
        plan.on_edge_backward(half_edge(2), t);
        let told = refused(&whole, &plan).map(|refusal| refusal.to_string());
        let known = "nothing was inserted: a child of f0 would cover only the fraction 0 of it";
        assert_eq!(told.as_deref(), (t * t == 0.0).then_some(known), "{t:e}");
    }
}

fn stitches<const N: usize>(pairs: [(usize, usize); N]) -> [Stitch; N] {
    pairs.map(|(one, other)| Stitch::new(vertex(one), vertex(other)).expect("two vertices"))
}

#[test]
fn sewing_lists_all_stitches_refused_and_changes_nothing() {
    let (mut mesh, _) = shapes::grid(2, 2);
    let mut edits = Edits::new();
    for old in [3, 4, 5].map(vertex) {
        let face = mesh.faces_of(old).next().expect("a face");
        split::vertex(&mut mesh, old, &[face], &mut edits).expect("others stay");
    }
    let place: Vec<[f64; 3]> = (0..12).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let wanted = stitches([(3, 9), (11, 5), (4, 10), (0, 1)]);
    let weight = |of: VertexId| if of == vertex(5) { f64::NAN } else { 1.0 };
    let before = (mesh.clone(), edits.cursor());
    let error = mend::sew(&mut mesh, &place[..], &wanted, weight, 5.9, &mut edits);
    let error = error.expect_err("all of these");
    let reasons: Vec<StitchError> = error.refused().iter().map(|(_, why)| *why).collect();
    let far = StitchError::Distance { distance: 6.0 };
    assert_eq!(
        reasons,
        [far, StitchError::Weights, far, StitchError::Roots]
    );
    assert_eq!(
        error.to_string(),
        "v3 and v9 cannot be sewn: they are 6 apart (and 3 more)"
    );
    assert_eq!((mesh, edits.cursor()), before);
}

/// A vertex in several stitches, a stitch twice, and a chain from the lowest to the highest.
#[test]
fn stitches_that_say_nothing_new_are_sewn_once() {
    let (mut mesh, _) = shapes::fan(6, true);
    let (uncut, mut edits) = (mesh.clone(), Edits::new());
    for face in 1..6 {
        let face = mesh.face(face);
        split::vertex(&mut mesh, vertex(0), &[face], &mut edits).expect("one stays");
    }
    let place = vec![[0.0; 3]; mesh.vertex_count()];
    let chain = stitches([(7, 8), (8, 9), (0, 11), (11, 9), (7, 9), (10, 11), (8, 7)]);
    let merges = mend::sew(&mut mesh, &place[..], &chain, |_| 0.0, 0.0, &mut edits);
    assert_eq!((merges, mesh), (Ok(5), uncut));
}

/// A torn mesh from a file may end with a vertex without a face; it can be renumbered too.
#[test]
fn a_vertex_without_a_face_takes_the_id_that_a_merge_frees() {
    let torn = Mesh::build_torn(&[[0, 1, 2], [2, 4, 3]], &[0, 1, 2, 3, 1, 5]);
    let mut mesh = torn.expect("v4 was split from v1");
    let mut edits = Edits::new();
    let merge = mend::merge(&mut mesh, vertex(4), vertex(1), [1.0, 1.0], &mut edits);
    let renumbered = merge.expect("copies").renumbered.expect("v4 is free");
    let told = (renumbered.from, renumbered.to, renumbered.corners);
    assert_eq!(told, (vertex(5), vertex(4), &[][..]));
    assert_eq!(mesh.check(), []);
    assert_eq!(Mesh::build(5, &[[0, 1, 2], [2, 1, 3]]), Ok(mesh));
}

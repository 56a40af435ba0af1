//! Insertions and merges: what they must leave as it was.

use tearmesh::insert::{InsertRefusal, Plan};
use tearmesh::mend::{Stitch, StitchError};
use tearmesh::{
    Edit, Edits, FaceId, HalfEdgeId, Masses, Mesh, PerCorner, Point, Positions, VertexId, mend,
    shapes, split,
};

use crate::random::Random;

/// Meshes of all kinds: with and without boundary, with hubs and handles.
fn meshes() -> Vec<(&'static str, Mesh, Positions)> {
    let named = |name, (mesh, positions)| (name, mesh, positions);
    vec![
        named("grid", shapes::grid(4, 3)),
        named("open fan", shapes::fan(5, false)),
        named("closed fan", shapes::fan(7, true)),
        named("tube", shapes::tube(5, 3)),
        named("torus", shapes::torus(4, 5)),
        named("octahedron", shapes::octahedron()),
    ]
}

fn area(mesh: &Mesh, place: &Positions) -> f64 {
    let of = |f: FaceId| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| place.at(v));
        (b - a).cross(&(c - a)).norm() / 2.0
    };
    mesh.faces().map(of).sum()
}

/// A number from 0 to `bound` - 1.
/// Some points at random: on edges, often several on one, and in faces.
fn random_plan(mesh: &Mesh, random: &mut Random) -> Plan {
    let mut plan = Plan::new();
    for _ in 0..=random.below(6) {
        if random.below(3) == 0 {
            let f = FaceId::new(random.below(mesh.face_count())).expect("a face");
            for _ in 0..=random.below(3) {
                let weights = [(); 3].map(|()| 0.05 + random.next());
                plan.in_face(f, weights);
            }
        } else {
            let h = HalfEdgeId::new(random.below(mesh.half_edge_count())).expect("a half-edge");
            for _ in 0..=random.below(3) {
                plan.on_edge(h, 0.02 + 0.96 * random.next());
            }
            if random.below(4) == 0 {
                // Near a corner, on both of its edges: a child there may be next to nothing.
                let mut near = || 2f64.powi(-2 - random.below(1000) as i32);
                plan.on_edge(h, near());
                plan.on_edge_backward(h.prev(), near());
            }
        }
    }
    plan
}

#[test]
fn random_edits_keep_every_invariant_and_the_surface() {
    let (mut insertions, mut merges, mut splits) = (0, 0, 0);
    for seed in 0..60 {
        for (name, mut mesh, mut positions) in meshes() {
            let mut random = Random(seed);
            let surface = area(&mesh, &positions);
            let mut masses = Masses::area(&mesh, &positions, 1.0).expect("it has an area");
            let place = |mesh: &Mesh, positions: &Positions| -> Vec<[f64; 3]> {
                let at = |h| positions.at(mesh.origin(h)).coords.into();
                mesh.half_edges().map(at).collect()
            };
            let mut corners = PerCorner::new(place(&mesh, &positions));
            let mut edits = Edits::new();
            for _ in 0..12 {
                match random.below(4) {
                    0 => {
                        let plan = random_plan(&mesh, &mut random);
                        let before = mesh.clone();
                        match plan.apply(&mut mesh, &mut edits) {
                            Ok(insert) => {
                                insertions += 1;
                                for child in insert.children {
                                    assert!(child.share > 0.0, "{name}, seed {seed}: {child:?}");
                                }
                            }
                            Err(refusal) => {
                                let known = match refusal {
                                    InsertRefusal::Share { share, .. } => share <= 0.0,
                                    InsertRefusal::Crowded { .. }
                                    | InsertRefusal::Repeated { .. } => true,
                                    _ => false,
                                };
                                assert!(known, "{refusal}");
                                assert_eq!(mesh, before, "refused is untouched");
                            }
                        }
                    }
                    1 => {
                        let root = VertexId::new(random.below(mesh.vertex_count())).expect("one");
                        let root = mesh.root(root);
                        let copies: Vec<_> =
                            mesh.vertices().filter(|&v| mesh.root(v) == root).collect();
                        if let [.., one, other] = copies[..] {
                            mend::merge(&mut mesh, one, other, [1.0, 2.0], &mut edits)
                                .expect("both have one root");
                            merges += 1;
                        }
                    }
                    _ => {
                        let v = VertexId::new(random.below(mesh.vertex_count())).expect("one");
                        let all: Vec<FaceId> = mesh.faces_of(v).collect();
                        let some: Vec<_> = all
                            .iter()
                            .copied()
                            .filter(|_| random.below(2) == 0)
                            .collect();
                        if split::vertex(&mut mesh, v, &some, &mut edits).is_ok() {
                            splits += 1;
                        }
                    }
                }
                edits.replay(&mut (&mut positions, &mut masses, &mut corners));
                let broken = mesh.check();
                assert!(broken.is_empty(), "{name}, seed {seed}: {broken:?}");
                assert!(masses.ledger().is_balanced(), "{name}, seed {seed}");
                let now = area(&mesh, &positions);
                assert!(
                    (now - surface).abs() <= 1e-12 * surface,
                    "{name}, seed {seed}: {now} of {surface}"
                );
                for (value, truth) in corners.as_slice().iter().zip(place(&mesh, &positions)) {
                    let apart = (Point::from(*value) - Point::from(truth)).norm();
                    assert!(
                        apart < 1e-12,
                        "{name}, seed {seed}: a corner is {apart} off"
                    );
                }
                let triangles: Vec<[u32; 3]> = mesh
                    .faces()
                    .map(|f| mesh.face_vertices(f).map(u32::from))
                    .collect();
                assert_eq!(
                    Mesh::build_torn(&triangles, &mesh.roots()).as_ref(),
                    Ok(&mesh),
                    "{name}, seed {seed}"
                );
            }
            let inserted: usize = edits
                .iter()
                .map(|edit| match edit {
                    Edit::Insert(insert) => insert.points.len(),
                    _ => 0,
                })
                .sum();
            let stitches = mend::stitches(&mesh, |_| true);
            mend::sew(
                &mut mesh,
                &positions,
                &stitches,
                |v| masses.at(v),
                1e-9,
                &mut edits,
            )
            .expect("nothing moved apart");
            edits.replay(&mut (&mut positions, &mut masses));
            assert!(mesh.check().is_empty() && masses.ledger().is_balanced());
            assert!(
                mesh.half_edges().all(|h| mesh.ghost_pair(h).is_none()),
                "{name}, seed {seed}: all is sewn"
            );
            assert!(inserted == 0 || mesh.face_count() > 0);
        }
    }
    assert!(
        insertions > 800 && merges > 150 && splits > 1200,
        "{insertions} {merges} {splits}"
    );
}

#[test]
fn with_room_for_faces_an_insertion_leaves_the_index_buffer_in_place() {
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

/// The half-edges of the one edge that two triangles share.
fn shared_edge(mesh: &Mesh) -> [HalfEdgeId; 2] {
    let mut shared = mesh
        .half_edges()
        .filter_map(|h| mesh.pair(h).map(|g| [h, g]));
    shared.next().expect("an edge with two faces")
}

/// Two points that rounding alone tells apart, given from either side of an edge: they are
/// refused, or every child still covers something.
#[test]
fn points_that_nearly_coincide_make_no_child_without_area() {
    let mut random = Random(7);
    let mut refused = 0;
    for _ in 0..20_000 {
        let (mut mesh, _) = shapes::grid(1, 1);
        let before = mesh.clone();
        let [h, g] = shared_edge(&mesh);
        let t = random.next().max(1e-9);
        let steps = random.below(5) as i64 - 2;
        let nearly = f64::from_bits((1.0 - t).to_bits().wrapping_add_signed(steps));
        let mut plan = Plan::new();
        plan.on_edge(h, t);
        plan.on_edge(g, nearly);
        let mut edits = Edits::new();
        match plan.apply(&mut mesh, &mut edits) {
            Ok(insert) => {
                for child in insert.children {
                    assert!(child.share > 0.0, "{t:e} and {nearly:e}: {child:?}");
                }
                assert_eq!(mesh.check(), []);
            }
            Err(refusal) => {
                let known = matches!(
                    refusal,
                    InsertRefusal::Repeated { .. } | InsertRefusal::Crowded { .. }
                );
                assert!(known && mesh == before && edits.is_empty(), "{refusal}");
                refused += 1;
            }
        }
    }
    assert!((1_000..19_000).contains(&refused), "{refused} were refused");
}

/// Between a corner and two points 1e-300 from it there is a child that covers 1e-600 of the
/// face, which is no `f64`.
#[test]
fn regression_a_child_whose_share_would_be_zero() {
    let divided = |t: f64| {
        let mut mesh = Mesh::build(3, &[[0, 1, 2]]).expect("a triangle");
        let mut plan = Plan::new();
        plan.on_edge(half_edge(0), t);
        plan.on_edge_backward(half_edge(2), t);
        let mut edits = Edits::new();
        let before = mesh.clone();
        let shares = plan.apply(&mut mesh, &mut edits);
        let shares = shares.map(|insert| insert.children.iter().map(|child| child.share).collect());
        assert!(shares.is_ok() || (mesh == before && edits.is_empty()));
        shares
    };
    for t in [1e-300, 1e-170, 5e-324] {
        let refusal: Result<Vec<f64>, InsertRefusal> = divided(t);
        let told = refusal.map_err(|refusal| refusal.to_string());
        let expected = "nothing was inserted: a child of f0 would cover only the fraction 0 of it";
        assert_eq!(told, Err(expected.to_string()), "{t}");
    }
    let shares = divided(1e-150).expect("small, and not zero");
    assert!(shares.iter().all(|&share| share > 0.0), "{shares:?}");
}

/// Where p on one edge and q on another are equally far along, the quad between them is divided
/// from p to the end of the edge of q.
#[test]
fn of_two_diagonals_that_are_equally_good_one_is_always_taken() {
    for corner in 0..3 {
        for order in [[0, 1], [1, 0]] {
            let mut mesh = Mesh::build(3, &[[0, 1, 2]]).expect("a triangle");
            let [ab, _, ca] = [0, 1, 2].map(|i| half_edge((corner + i) % 3));
            let mut plan = Plan::new();
            for which in order {
                plan.on_edge([ab, ca][which], 0.5);
            }
            plan.apply(&mut mesh, &mut Edits::new()).expect("two edges");
            let p = VertexId::new(3 + order[0]).expect("a small number");
            let c = VertexId::new((corner + 2) % 3).expect("a small number");
            let joined = mesh
                .half_edges()
                .any(|h| (mesh.origin(h), mesh.target(h)) == (p, c));
            assert!(joined, "{p} and {c}, corner {corner}: {mesh:?}");
        }
    }
}

fn half_edge(index: usize) -> HalfEdgeId {
    HalfEdgeId::new(index).expect("a small number")
}

#[test]
fn sewing_lists_every_stitch_that_it_refuses_and_changes_nothing() {
    let v = |index| VertexId::new(index).expect("a small number");
    let (mut mesh, _) = shapes::grid(2, 2);
    let mut edits = Edits::new();
    for old in [3, 4, 5] {
        let face = mesh.faces_of(v(old)).next().expect("a face");
        split::vertex(&mut mesh, v(old), &[face], &mut edits).expect("others stay");
    }
    let place: Vec<[f64; 3]> = (0..12).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let stitches: Vec<Stitch> = [(3, 9), (11, 5), (4, 10), (0, 1)]
        .map(|(one, other)| Stitch::new(v(one), v(other)).expect("two vertices"))
        .to_vec();
    let weight = |of: VertexId| if of == v(5) { f64::NAN } else { 1.0 };
    let before = (mesh.clone(), edits.cursor());
    let error = mend::sew(&mut mesh, &place[..], &stitches, weight, 5.9, &mut edits)
        .expect_err("all of these");
    let reasons: Vec<StitchError> = error.refused().iter().map(|(_, why)| *why).collect();
    assert_eq!(
        reasons,
        [
            StitchError::Distance { distance: 6.0 },
            StitchError::Weights,
            StitchError::Distance { distance: 6.0 },
            StitchError::Roots,
        ]
    );
    assert_eq!(
        error.to_string(),
        "v3 and v9 cannot be sewn: they are 6 apart (and 3 more)"
    );
    assert_eq!((mesh.clone(), edits.cursor()), before);
    // A vertex in several stitches, a stitch twice, and a chain from the lowest to the highest.
    let (mut mesh, positions) = shapes::fan(6, true);
    let uncut = mesh.clone();
    for face in 1..6 {
        let face = FaceId::new(face).expect("a small number");
        split::vertex(&mut mesh, v(0), &[face], &mut edits).expect("one stays");
    }
    edits.replay(&mut positions.clone().starting_at(before.1));
    let place = vec![[0.0; 3]; mesh.vertex_count()];
    let chain: Vec<Stitch> = [(7, 8), (8, 9), (0, 11), (11, 9), (7, 9), (10, 11), (8, 7)]
        .map(|(one, other)| Stitch::new(v(one), v(other)).expect("two vertices"))
        .to_vec();
    let merges = mend::sew(&mut mesh, &place[..], &chain, |_| 0.0, 0.0, &mut edits);
    assert_eq!(
        merges,
        Ok(5),
        "seven stitches, of which two say nothing new"
    );
    assert_eq!(mesh, uncut);
}

/// A torn mesh from a file may end with a vertex without a face; it can be renumbered too.
#[test]
fn a_vertex_without_a_face_takes_the_id_that_a_merge_frees() {
    let mut mesh = Mesh::build_torn(&[[0, 1, 2], [2, 4, 3]], &[0, 1, 2, 3, 1, 5])
        .expect("v4 was split from v1");
    let v = |index| VertexId::new(index).expect("a small number");
    let mut edits = Edits::new();
    let merge = mend::merge(&mut mesh, v(4), v(1), [1.0, 1.0], &mut edits).expect("copies");
    let renumbered = merge.renumbered.expect("v4 is free");
    assert_eq!(
        (renumbered.from, renumbered.to, renumbered.corners),
        (v(5), v(4), &[][..])
    );
    assert_eq!(mesh.check(), []);
    assert_eq!(
        mesh,
        Mesh::build(5, &[[0, 1, 2], [2, 1, 3]]).expect("two triangles")
    );
}

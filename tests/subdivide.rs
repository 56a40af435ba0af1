//! Insertions and merges: what they must leave as it was.

use tearmesh::subdivide::{Plan, Refusal};
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
        let [a, b, c] = mesh.corners(f).map(|v| place.at(v));
        (b - a).cross(&(c - a)).norm() / 2.0
    };
    mesh.faces().map(of).sum()
}

/// A number from 0 to `bound` - 1.
fn below(random: &mut Random, bound: usize) -> usize {
    (random.next() * bound as f64) as usize
}

/// Some points at random: on edges, often several on one, and in faces.
fn random_plan(mesh: &Mesh, random: &mut Random) -> Plan {
    let mut plan = Plan::new();
    for _ in 0..=below(random, 6) {
        if below(random, 3) == 0 {
            let f = FaceId::new(below(random, mesh.face_count())).expect("a face");
            for _ in 0..=below(random, 3) {
                let weights = [(); 3].map(|()| 0.05 + random.next());
                plan.in_face(f, weights);
            }
        } else {
            let h = HalfEdgeId::new(below(random, mesh.half_edge_count())).expect("a half-edge");
            for _ in 0..=below(random, 3) {
                plan.on_edge(h, 0.02 + 0.96 * random.next());
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
                match below(&mut random, 4) {
                    0 => {
                        let plan = random_plan(&mesh, &mut random);
                        let before = mesh.clone();
                        match plan.apply(&mut mesh, &mut edits) {
                            Ok(_) => insertions += 1,
                            Err(refusal) => {
                                assert!(matches!(refusal, Refusal::Crowded { .. }), "{refusal}");
                                assert_eq!(mesh, before, "refused is untouched");
                            }
                        }
                    }
                    1 => {
                        let root =
                            VertexId::new(below(&mut random, mesh.vertex_count())).expect("one");
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
                        let v =
                            VertexId::new(below(&mut random, mesh.vertex_count())).expect("one");
                        let all: Vec<FaceId> = mesh.faces_of(v).collect();
                        let some: Vec<_> = all
                            .iter()
                            .copied()
                            .filter(|_| below(&mut random, 2) == 0)
                            .collect();
                        if split::faces(&mut mesh, v, &some, &mut edits).is_ok() {
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
                    .map(|f| mesh.corners(f).map(u32::from))
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

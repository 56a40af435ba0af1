//! The figures of the paper, the readings of it that fail, and inputs to refuse.

use tearmesh::script::Script;
use tearmesh::{
    BuildError, Defect, Edits, FaceId, HalfEdgeId, Mesh, Plane, Positions, Vector, VertexId,
    shapes, split,
};

use crate::lockstep;

fn v(index: usize) -> VertexId {
    VertexId::new(index).expect("a small number")
}

fn f(index: usize) -> FaceId {
    FaceId::new(index).expect("a small number")
}

/// The side of a face that starts at its corner `corner`.
fn side(face: usize, corner: usize) -> HalfEdgeId {
    f(face).half_edges()[corner]
}

fn faces_of(mesh: &Mesh, vertex: usize) -> Vec<usize> {
    let mut faces: Vec<usize> = mesh.faces_of(v(vertex)).map(FaceId::index).collect();
    faces.sort();
    faces
}

/// Splits a vertex by faces, all by number.
fn split(mesh: &mut Mesh, vertex: usize, moving: &[usize]) {
    let faces: Vec<FaceId> = moving.iter().map(|&face| f(face)).collect();
    split::vertex(mesh, v(vertex), &faces, &mut Edits::new()).expect("some faces, not all");
    assert_eq!(mesh.check(), []);
}

fn open_fan_of_three() -> Mesh {
    shapes::fan(3, false).0
}

/// Fig. 1a: six faces round a vertex, which is to be split by a horizontal plane. Faces 1 to 6
/// of the figure are f0 to f5; the first three are above the plane, the others behind it.
fn figure_1() -> (Mesh, Positions, Edits) {
    let (mut mesh, positions) = shapes::fan(6, true);
    let mut edits = Edits::new();
    let plane = Plane::new(positions.at(v(0)), Vector::y()).expect("a plane");
    let split = split::by_plane(&mut mesh, v(0), &plane, &positions, &mut edits);
    assert!(split.is_some(), "there are faces on both sides");
    (mesh, positions, edits)
}

#[test]
fn figure_1_the_faces_behind_the_plane_move_to_the_new_vertex() {
    let (mesh, mut positions, edits) = figure_1();
    assert_eq!(faces_of(&mesh, 0), [0, 1, 2]);
    assert_eq!(faces_of(&mesh, 7), [3, 4, 5]);
    edits.replay(&mut positions);
    assert_eq!(positions.at(v(7)), positions.at(v(0)));
    assert_eq!(mesh.check(), []);
}

#[test]
fn figure_1_a_plane_with_all_faces_on_one_side_does_nothing() {
    let (mut mesh, positions) = shapes::fan(6, true);
    let before = mesh.clone();
    let below = positions.at(v(0)) - Vector::y() * 2.0;
    for normal in [Vector::y(), -Vector::y()] {
        let plane = Plane::new(below, normal).expect("a plane");
        let mut edits = Edits::new();
        assert_eq!(
            split::by_plane(&mut mesh, v(0), &plane, &positions, &mut edits),
            None
        );
        assert!(edits.is_empty());
    }
    assert_eq!(mesh, before);
}

/// Fig. 2: two faces share a vertex, and no edge. No input may be like this, but splits get there.
#[test]
fn figure_2_two_faces_that_share_a_vertex_alone() {
    let bow_tie = [[0, 1, 2], [0, 3, 4]];
    refuses(
        5,
        &bow_tie,
        &["v0 joins 2 fans that share no edge: f0 | f1"],
    );

    let mut mesh = open_fan_of_three();
    split(&mut mesh, 0, &[1]);
    let edges: Vec<HalfEdgeId> = mesh.fans(v(0)).collect();
    assert_eq!(edges, [side(0, 0), side(2, 0)], "two fans of one face each");
    assert_eq!(faces_of(&mesh, 0), [0, 2], "both are found");
    split(&mut mesh, 0, &[2]);
    assert_eq!(faces_of(&mesh, 0), [0], "and the vertex can be split");
}

/// Fig. 3: the mesh of Fig. 1 after the split. The two edges between faces above and below the
/// plane have ghost pairs, the other inner edges have pairs.
#[test]
fn figure_3_pairs_and_ghost_pairs_after_the_split() {
    let (mesh, ..) = figure_1();
    for face in 0..6 {
        // Side 2 of each face is side 0 of the next one round the vertex.
        let (h, g) = (side(face, 2), side((face + 1) % 6, 0));
        let torn = face == 2 || face == 5;
        let expected = if torn {
            (None, Some(g))
        } else {
            (Some(g), None)
        };
        assert_eq!((mesh.pair(h), mesh.ghost_pair(h)), expected);
        let expected = if torn {
            (None, Some(h))
        } else {
            (Some(h), None)
        };
        assert_eq!((mesh.pair(g), mesh.ghost_pair(g)), expected);
        assert_eq!(mesh.pair_or_ghost(side(face, 1)), None, "the outline");
    }
}

/// Fig. 3: "the vertex pointed by the black arrow could not be split by a horizontal plane because
/// the standard half-edge data structure would not find faces for both sides".
#[test]
fn figure_3_the_vertex_of_the_arrow_can_still_be_split_by_a_horizontal_plane() {
    let (mut mesh, mut positions, mut edits) = figure_1();
    edits.replay(&mut positions);
    // Vertex 1 lies on the plane, at the end of the edge between f5 and f0.
    assert_eq!(
        mesh.fan(mesh.half_edge_of(v(1)).expect("a face")).count(),
        1,
        "pairs find one"
    );
    assert_eq!(faces_of(&mesh, 1), [0, 5], "ghost pairs find the other");
    let plane = Plane::new(positions.at(v(1)), Vector::y()).expect("a plane");
    let split = split::by_plane(&mut mesh, v(1), &plane, &positions, &mut edits);
    let moved = split.expect("a face on each side").corners.to_vec();
    assert_eq!(moved, [side(5, 2)]);
    assert_eq!(mesh.check(), []);
}

// The readings of the paper that fail, each with its shortest counter-example.

#[test]
fn pairs_alone_do_not_find_all_faces() {
    let (mut mesh, _) = shapes::fan(2, false);
    split(&mut mesh, 0, &[0]);
    // Vertex 2 is the other end of the torn edge, and still has both faces.
    assert_eq!(faces_of(&mesh, 2), [0, 1]);
    assert_eq!(mesh.fan(side(0, 2)).count(), 1);
}

#[test]
fn faces_that_lost_the_vertex_are_not_reported() {
    let (mut mesh, _) = shapes::fan(2, false);
    split(&mut mesh, 0, &[0]);
    assert_eq!(faces_of(&mesh, 0), [1]);
}

#[test]
fn the_walk_does_not_stop_at_a_face_that_lost_the_vertex() {
    let mut mesh = open_fan_of_three();
    split(&mut mesh, 0, &[1]);
    assert_eq!(faces_of(&mesh, 0), [0, 2]);
}

#[test]
fn a_ghost_pair_survives_a_second_separation_of_its_edge() {
    let mut mesh = open_fan_of_three();
    split(&mut mesh, 0, &[1]);
    split(&mut mesh, 2, &[0]);
    assert_eq!(mesh.ghost_pair(side(0, 2)), Some(side(1, 0)));
    assert_eq!(faces_of(&mesh, 0), [0, 2]);
}

#[test]
fn the_walk_goes_both_ways_from_any_start() {
    let (mesh, _) = shapes::fan(4, false);
    assert_eq!(faces_of(&mesh, 0), [0, 1, 2, 3]);
    for face in 0..4 {
        assert_eq!(mesh.fan(side(face, 0)).count(), 4, "from {face}");
    }
    for rim in 1..=5 {
        assert_eq!(
            faces_of(&mesh, rim).len(),
            if rim == 1 || rim == 5 { 1 } else { 2 }
        );
    }
}

/// Between the moved and the other faces lie edges that both ends still share: not those at
/// the vertex. They keep their pairs.
#[test]
fn only_the_edges_at_the_vertex_are_torn() {
    let (mut mesh, _) = shapes::tetrahedron();
    let mut edits = Edits::new();
    let split = split::vertex(&mut mesh, v(0), &[f(0)], &mut edits).expect("one of three");
    assert_eq!(split.torn.len(), 2);
    // f0 is 0, 1, 2; its edge 1-2 is shared with f3, which does not have v0.
    assert_eq!(mesh.pair(side(0, 1)).map(HalfEdgeId::face), Some(f(3)));
}

/// One plane cuts a curved fan into four arcs: both halves become bow-ties in one split.
#[test]
fn a_saddle_becomes_two_bow_ties_in_one_split() {
    let (mut mesh, positions) = shapes::saddle();
    let plane = Plane::new(positions.at(v(0)), Vector::z()).expect("a plane");
    let mut edits = Edits::new();
    let split = split::by_plane(&mut mesh, v(0), &plane, &positions, &mut edits);
    let split = split.expect("two arcs on each side");
    assert_eq!((split.corners.len(), split.torn.len()), (4, 4));
    for vertex in [v(0), split.new] {
        assert_eq!(mesh.corners_of(vertex).count(), 4);
        assert_eq!(mesh.fans(vertex).count(), 2);
    }
    assert_eq!(mesh.check(), []);
}

/// A split of a boundary vertex whose separating edges are all torn already tears none.
#[test]
fn a_split_of_a_bow_tie_tears_nothing() {
    let mut mesh = open_fan_of_three();
    split(&mut mesh, 0, &[1]);
    let mut edits = Edits::new();
    let split = split::vertex(&mut mesh, v(0), &[f(2)], &mut edits).expect("one of two");
    assert!(split.torn.is_empty());
}

// Inputs to refuse.

/// Builds triangles that are wrong; `expected` has a line for each defect.
fn refuses(vertices: usize, triangles: &[[u32; 3]], expected: &[&str]) {
    let error = Mesh::build(vertices, triangles).expect_err("not a manifold");
    let said: Vec<String> = error.defects().iter().map(Defect::to_string).collect();
    assert_eq!(said, expected, "{triangles:?}");
}

#[test]
fn an_index_out_of_range_is_refused() {
    let expected = "f1 names vertex 4 at corner 2, but there are 4 vertices";
    refuses(4, &[[0, 1, 2], [2, 1, 4]], &[expected]);
}

#[test]
fn a_face_with_a_repeated_vertex_is_refused() {
    for triangle in [[3, 3, 1], [3, 1, 3], [1, 3, 3], [3, 3, 3]] {
        refuses(4, &[triangle], &["f0 names v3 more than once"]);
    }
}

#[test]
fn a_face_that_occurs_twice_is_refused() {
    let expected = "the vertices v0, v1, v2 have several faces: f0, f1";
    refuses(3, &[[0, 1, 2], [1, 2, 0]], &[expected]);
}

#[test]
fn two_faces_back_to_back_are_refused() {
    let expected = "two faces lie back to back on v0, v1, v2: f0, f1";
    refuses(3, &[[0, 1, 2], [0, 2, 1]], &[expected]);
}

#[test]
fn a_third_face_on_an_edge_is_refused() {
    let expected = "the edge v0-v1 has 3 faces: f0, f1, f2";
    refuses(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]], &[expected]);
}

/// A tetrahedron with a fin on its edge 0-1. A builder that pairs the fin with one face of the
/// edge and forgets the other one finds every corner all the same: each vertex has one fan.
#[test]
fn a_fin_on_a_tetrahedron_is_refused() {
    let triangles = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [3, 0, 4], [4, 1, 3]];
    let expected = "the edge v0-v1 has 3 faces: f0, f1, f2";
    refuses(5, &triangles, &[expected]);
}

#[test]
fn a_flipped_face_is_refused() {
    let expected = "f0 and f1 both run from v1 to v2: one of them is flipped";
    refuses(4, &[[0, 1, 2], [1, 2, 3]], &[expected]);
}

#[test]
fn a_bow_tie_is_refused_with_all_its_fans() {
    let triangles = [[0, 1, 2], [0, 3, 4], [5, 6, 0], [0, 2, 7]];
    let expected = "v0 joins 3 fans that share no edge: f0, f3 | f1 | f2";
    refuses(8, &triangles, &[expected]);
}

#[test]
fn more_vertices_than_ids_are_refused() {
    let (given, limit) = (Mesh::MAX_VERTICES + 1, Mesh::MAX_VERTICES);
    refuses(
        given,
        &[],
        &[&format!("{given} vertices, the limit is {limit}")],
    );
}

/// Of many defects and faces an error lists the first and counts all; who asks for all gets all.
#[test]
fn long_lists_are_capped_and_counted() {
    let triangles: Vec<[u32; 3]> = (0..100_000u32)
        .map(|i| [0, 1, if i % 1000 == 0 { 2 } else { i + 3 }])
        .collect();
    let error = Mesh::build(100_003, &triangles).expect_err("a crowded edge");
    let list = |defect: &Defect| match defect {
        Defect::DuplicateFaces { faces, .. } | Defect::CrowdedEdge { faces, .. } => {
            assert_eq!(faces.iter().next(), Some(faces.first()));
            let list = faces.iter().map(|face| face.index()).collect();
            (faces.len(), list)
        }
        other => panic!("{other}"),
    };
    let rare: Vec<usize> = (0..100_000).step_by(1000).collect();
    let first: Vec<usize> = (0..99).chain([99_999]).collect();
    let lists: Vec<(usize, Vec<usize>)> = error.defects().iter().map(list).collect();
    assert_eq!(lists, [(100, rare.clone()), (100_000, first)]);
    assert_eq!((error.count(), error.is_capped()), (2, false));
    let mut lists = Vec::new();
    Mesh::diagnose(100_003, &triangles, usize::MAX, |defect| {
        lists.push(list(&defect).1);
    });
    assert_eq!(lists, [rare, (0..100_000).collect()]);

    // Bow-ties come last, and both ends of a pair of triangles are flipped against each other.
    let flipped: Vec<[u32; 3]> = (0..3000u32)
        .flat_map(|i| [[4 * i, 4 * i + 1, 4 * i + 2], [4 * i, 4 * i + 1, 4 * i + 3]])
        .chain([[0, 12_001, 12_002]])
        .collect();
    let error = Mesh::build(12_003, &flipped).expect_err("flipped faces");
    assert_eq!((error.count(), error.is_capped()), (3001, true));
    let (bow_tie, flips) = error.defects().split_last().expect("there are some");
    assert!(matches!(bow_tie, Defect::BowTie { .. }));
    assert_eq!(flips.len(), BuildError::LISTED_MAX);
    for (i, flip) in flips.iter().enumerate() {
        let faces = [2 * i, 2 * i + 1].map(f);
        assert!(
            matches!(flip, Defect::FlippedFace { faces: it, .. } if *it == faces),
            "{flip}"
        );
    }
}

#[test]
fn a_vertex_without_a_face_keeps_its_number_and_cannot_be_split() {
    let mut mesh = Mesh::build(5, &[[0, 1, 3]]).expect("a triangle");
    assert_eq!((mesh.vertex_count(), mesh.half_edge_of(v(2))), (5, None));
    let mut edits = Edits::new();
    let refused = split::vertex(&mut mesh, v(2), &[], &mut edits);
    assert_eq!(refused, Err(split::SplitRefusal::Empty { vertex: v(2) }));
    assert_eq!(mesh.check(), []);
}

#[test]
fn nothing_at_all_is_a_mesh() {
    let mesh = Mesh::build(0, &[]).expect("nothing is wrong");
    assert_eq!((mesh.vertex_count(), mesh.face_count()), (0, 0));
    assert_eq!(mesh.check(), []);
}

/// With room reserved, the lists of the log stay where they are in memory. (An allocator that
/// counts would say more, but needs `unsafe`, which this project forbids.)
#[test]
fn a_log_with_room_does_not_move() {
    let (mut mesh, _) = shapes::grid(4, 4);
    let corners = mesh.half_edge_count();
    let mut edits = Edits::new();
    edits.reserve(corners, corners, corners);
    mesh.reserve(corners);
    let mut at = None;
    for vertex in mesh.vertices() {
        let faces: Vec<FaceId> = mesh.faces_of(vertex).collect();
        for &face in &faces[1..] {
            split::vertex(&mut mesh, vertex, &[face], &mut edits).expect("not the last");
            let first = lockstep::split_of(edits.iter().next().expect("a split"));
            let now = (first.corners.as_ptr(), first.torn.as_ptr());
            assert_eq!(*at.get_or_insert(now), now);
        }
    }
    assert_eq!(
        mesh.vertex_count(),
        corners,
        "every face has its own vertices"
    );
    assert_eq!(mesh.components().count(), mesh.face_count());
}

// What was found, as scripts.

fn regression(script: &str) {
    lockstep::check(&script.parse::<Script>().expect("a script"));
}

/// A cut asked for the positions of vertices that its own splits had just made.
#[test]
fn regression_a_midpoint_cut_reads_only_positions_that_there_are() {
    regression(
        "
        grown 92 238 212 108 101 161 56 61 52 0 0 0 0 0 0
        cut midpoint -39 -128 -50 11 60 -76 0 0 0 0 0 1
        ",
    );
}

/// A chord across a face without a point was passed over in silence.
#[test]
fn regression_a_chord_of_a_face_without_points_is_refused() {
    regression("grid 1 1 0\ninsert 0 chord 0 0\ninsert 0 edge 3 32 face 0 1 1 1 chord 0 3");
    regression("grid 2 2 0\ninsert 0 edge 0 32 edge 9 32 chord 2 4");
}

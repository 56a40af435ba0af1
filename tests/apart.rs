//! Pieces as meshes of their own, against lists of triangles.
//!
//! The oracle knows the triangles of the whole, the root of each vertex, and plain loops: which faces
//! hang together, which links lie inside a piece, and which corners of a vertex still have a way to each
//! other there.

use std::collections::{BTreeMap, BTreeSet};

use tearmesh::{
    DerivedMesh, Edits, ExactSum, FaceId, HalfEdgeId, Mesh, Point, Positions, VertexId, shapes,
    split,
};

use crate::cases::scripts;

/// How much was seen.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    meshes: usize,
    pieces: usize,
    /// Meshes of several pieces.
    apart: usize,
    /// Ghost links inside a piece, and between two.
    kept: usize,
    lost: usize,
    /// Vertices of a mesh with several fans in one piece, and those of which a piece made several.
    bow_ties: usize,
    separated: usize,
}

/// For each half-edge the one that lies across in the mesh before it was torn.
fn twins(triangles: &[[u32; 3]], roots: &[u32]) -> Vec<Option<usize>> {
    let ends =
        |h: usize| [h, h / 3 * 3 + (h + 1) % 3].map(|h| roots[triangles[h / 3][h % 3] as usize]);
    let by_ends: BTreeMap<[u32; 2], usize> =
        (0..3 * triangles.len()).map(|h| (ends(h), h)).collect();
    let across = |h: usize| {
        let [from, to] = ends(h);
        by_ends.get(&[to, from]).copied()
    };
    (0..3 * triangles.len()).map(across).collect()
}

/// Numbers that are made equal along links, until nothing changes.
fn joined(count: usize, links: &[(usize, usize)]) -> Vec<usize> {
    let mut number: Vec<usize> = (0..count).collect();
    let mut changed = true;
    while changed {
        changed = false;
        for &(a, b) in links {
            let least = number[a].min(number[b]);
            changed |= number[a] != least || number[b] != least;
            (number[a], number[b]) = (least, least);
        }
    }
    number
}

fn check(mesh: &Mesh, positions: &Positions, tally: &mut Counts) {
    let components = mesh.components();
    let pieces = mesh.pieces(&components);
    let triangles = mesh.indices().as_chunks::<3>().0;
    let twins = twins(triangles, &mesh.roots());
    let is_torn = |h: usize, g: usize| {
        let at = |h: usize| triangles[h / 3][h % 3];
        let ahead = |h: usize| triangles[h / 3][(h + 1) % 3];
        at(h) != ahead(g) || ahead(h) != at(g)
    };
    let links = twins
        .iter()
        .enumerate()
        .filter_map(|(h, g)| Some((h, (*g)?)));
    let links: Vec<(usize, usize)> = links.collect();
    let pairs = links.iter().filter(|&&(h, g)| !is_torn(h, g));
    let pairs: Vec<(usize, usize)> = pairs.map(|&(h, g)| (h / 3, g / 3)).collect();
    let piece_of = joined(triangles.len(), &pairs);
    // A corner has a way to the next one round its vertex through a link that is still there.
    let stays = |&&(h, g): &&(usize, usize)| piece_of[h / 3] == piece_of[g / 3];
    let turns = links
        .iter()
        .filter(stays)
        .map(|&(h, g)| (h, g / 3 * 3 + (g + 1) % 3));
    let orbit_of = joined(3 * triangles.len(), &turns.collect::<Vec<_>>());

    // Each face is in the piece of those that it hangs together with.
    let leaders: BTreeSet<usize> = piece_of.iter().copied().collect();
    assert_eq!(pieces.len(), leaders.len(), "pieces");
    for (piece, leader) in pieces.iter().zip(leaders) {
        let own: Vec<usize> = (0..triangles.len())
            .filter(|&f| piece_of[f] == leader)
            .collect();
        assert!(piece.faces().iter().map(|f| f.index()).eq(own), "faces");
    }
    let sum_of = |sums: &mut dyn Iterator<Item = f64>| sums.collect::<ExactSum>();
    let area = |[a, b, c]: [Point; 3]| (b - a).cross(&(c - a)).norm() / 2.0;
    let whole = sum_of(
        &mut mesh
            .faces()
            .map(|f| area(mesh.face_vertices(f).map(|v| positions.at(v)))),
    );
    let mut parts = ExactSum::new();
    for piece in &pieces {
        let own = Positions::new(piece.vertices().iter().map(|&v| positions.at(v)));
        let own = own.expect("they were usable");
        let faces = piece.mesh().faces();
        parts.extend(faces.map(|f| area(piece.mesh().face_vertices(f).map(|v| own.at(v)))));
        check_piece(mesh, piece, &twins, &is_torn, &orbit_of, tally);
    }
    assert_eq!(parts, whole, "areas");
    tally.meshes += 1;
    tally.pieces += pieces.len();
    tally.apart += usize::from(pieces.len() > 1);
}

fn check_piece(
    mesh: &Mesh,
    piece: &DerivedMesh,
    twins: &[Option<usize>],
    is_torn: &impl Fn(usize, usize) -> bool,
    orbit_of: &[usize],
    tally: &mut Counts,
) {
    let own = piece.mesh();
    assert_eq!(own.check(), []);
    assert_eq!(own.vertex_count(), piece.vertices().len());
    assert!(piece.vertices().is_sorted(), "vertices ascend");
    let corners = piece.faces().iter().flat_map(|f| f.half_edges());
    assert!(piece.corners().iter().copied().eq(corners), "corners");
    let back = |h: HalfEdgeId| piece.corners()[h.index()];
    assert!(piece.faces().is_sorted_by(|f, g| f < g), "faces ascend");
    let is_here = |f: FaceId| piece.faces().binary_search(&f).is_ok();

    let mut labels: BTreeMap<(VertexId, usize), VertexId> = BTreeMap::new();
    for h in own.half_edges() {
        let source = back(h);
        assert_eq!(
            piece.vertices()[own.origin(h).index()],
            mesh.origin(source),
            "the vertex of {h}"
        );
        assert_eq!(piece.faces()[h.face().index()], source.face());
        // The same links, where both sides are here.
        let twin = twins[source.index()];
        let here = twin.filter(|&g| {
            let g = HalfEdgeId::new(g).expect("known");
            is_here(g.face())
        });
        assert_eq!(
            own.pair_or_ghost(h).map(|g| back(g).index()),
            here,
            "the link of {h}"
        );
        if let Some(g) = twin {
            let torn = is_torn(source.index(), g);
            assert_eq!(
                own.ghost_pair(h).is_some(),
                torn && here.is_some(),
                "the mark of {h}"
            );
            assert!(torn || here.is_some(), "a pair stays in its piece");
            tally.kept += usize::from(torn && here.is_some());
            tally.lost += usize::from(torn && here.is_none());
        }
        // A fan is walked as in the whole.
        assert!(own.fan(h).map(back).eq(mesh.fan(source)), "the fan of {h}");
        // One vertex for each way round a vertex.
        let label = (mesh.origin(source), orbit_of[source.index()]);
        let known = *labels.entry(label).or_insert(own.origin(h));
        assert_eq!(
            known,
            own.origin(h),
            "{h} has a way to the others of its vertex"
        );
    }
    assert_eq!(
        labels.len(),
        own.vertex_count(),
        "a vertex for each way round one"
    );
    for &v in piece.vertices() {
        let copies = copies_of(piece, v);
        tally.separated += usize::from(copies.len() > 1);
        let of_copies: BTreeSet<HalfEdgeId> = copies
            .iter()
            .flat_map(|&w| own.corners_of(w))
            .map(back)
            .collect();
        let inside = |h: &HalfEdgeId| is_here(h.face());
        let expected: BTreeSet<HalfEdgeId> = mesh.corners_of(v).filter(inside).collect();
        assert_eq!(of_copies, expected, "the corners of {v}");
        let fans = mesh.fans(v).filter(inside).count();
        tally.bow_ties += usize::from(fans > 1);
    }
}

#[test]
fn pieces_of_torn_meshes_are_what_the_whole_is_there() {
    let mut tally = Counts::default();
    for script in scripts(5_000) {
        let mut steps = 0;
        let world = script.run(|world, _| {
            steps += 1;
            // Half of a script too, as a rule not torn so much.
            if 2 * steps == script.operations.len() {
                check(&world.mesh, &world.positions, &mut tally);
            }
        });
        check(&world.mesh, &world.positions, &mut tally);
    }
    println!("{tally:?}");
    let least = tally.meshes / 10;
    assert!(
        tally.apart > least && tally.kept > 10 * least && tally.lost > 10 * least,
        "{tally:?}"
    );
    assert!(tally.bow_ties > least && tally.separated > 0, "{tally:?}");
}

/// The fans A and C keep the middle vertex, and hang together elsewhere; B and D are cut off.
#[test]
fn a_vertex_whose_fans_hung_together_through_other_pieces_becomes_several() {
    let (mut mesh, positions) = shapes::grid(4, 4);
    let mut edits = Edits::new();
    let middle = VertexId::new(12).expect("small");
    // The faces round the middle, in order; two that are opposite are cut off altogether.
    let round: Vec<FaceId> = mesh.faces_of(middle).collect();
    let off = [round[0], round[3]];
    for f in off {
        for v in mesh.face_vertices(f) {
            split::vertex(&mut mesh, v, &[f], &mut edits).expect("others stay");
        }
    }
    edits.replay(&mut positions.clone());
    let pieces = mesh.pieces(&mesh.components());
    let sizes: Vec<usize> = pieces.iter().map(|piece| piece.faces().len()).collect();
    assert_eq!(sizes.iter().sum::<usize>(), mesh.face_count());
    let large = pieces
        .iter()
        .find(|piece| piece.faces().len() > 1)
        .expect("the sheet");
    assert_eq!(large.mesh().check(), []);
    let last = VertexId::new(mesh.vertex_count() - 1).expect("small");
    assert_eq!(copies_of(large, last), []);
    let [u, v] = copies_of(large, middle)[..] else {
        panic!("two vertices")
    };
    assert_eq!(
        large.mesh().fans(u).count() + large.mesh().fans(v).count(),
        2
    );
    assert_ne!(large.mesh().root(u), large.mesh().root(v));
}

/// The vertices of a piece that come from one of the whole.
fn copies_of(piece: &DerivedMesh, source: VertexId) -> Vec<VertexId> {
    let vertices = piece.mesh().vertices();
    vertices
        .filter(|v| piece.vertices()[v.index()] == source)
        .collect()
}

/// Values beside the whole come along, each to its place, by the maps.
#[test]
fn the_maps_of_a_piece_lead_to_the_whole() {
    let (mut mesh, _) = shapes::grid(2, 1);
    let mut edits = Edits::new();
    for v in [1, 4].map(|v| VertexId::new(v).expect("small")) {
        let right = mesh.faces_of(v).filter(|f| f.index() >= 2);
        let right: Vec<FaceId> = right.collect();
        split::vertex(&mut mesh, v, &right, &mut edits).expect("others stay");
    }
    let pieces = mesh.pieces(&mesh.components());
    let [_, right] = &pieces[..] else {
        panic!("two pieces")
    };
    let told = |ids: &dyn std::fmt::Debug| format!("{ids:?}");
    assert_eq!(told(&right.vertices()), "[v2, v5, v6, v7]");
    assert_eq!(told(&right.faces()), "[f2, f3]");
    assert_eq!(told(&right.corners()), "[h6, h7, h8, h9, h10, h11]");
}

#[test]
fn the_components_of_another_mesh_are_refused() {
    let whole = shapes::grid(2, 1).0;
    let mut apart = whole.clone();
    let mut edits = Edits::new();
    for (v, f) in [(1, 2), (4, 1), (4, 2)] {
        let moving = FaceId::new(f).expect("small");
        let v = VertexId::new(v).expect("small");
        let _ = split::vertex(&mut apart, v, &[moving], &mut edits);
    }
    assert!(apart.components().count() > 1);
    for (mesh, other) in [(&whole, &apart), (&apart, &whole)] {
        let pieces = std::panic::catch_unwind(|| mesh.pieces(&other.components()));
        assert!(
            pieces.is_err(),
            "as many faces, but not the same components"
        );
    }
}

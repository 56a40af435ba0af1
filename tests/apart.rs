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

use crate::oracle::joined_sets;
use crate::scripts::scripts;
use crate::work::triangles;

/// How much was seen.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    meshes: usize,
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

/// What the oracle knows of the whole.
struct Whole<'m> {
    mesh: &'m Mesh,
    twins: Vec<Option<usize>>,
    piece_of: Vec<usize>,
    /// Corners that have a way to each other round their vertex through links that are still there.
    orbit_of: Vec<usize>,
}

impl Whole<'_> {
    fn new(mesh: &Mesh) -> Whole<'_> {
        let twins = twins(triangles(mesh), &mesh.roots());
        let links = twins.iter().enumerate();
        let links: Vec<(usize, usize)> = links.filter_map(|(h, g)| Some((h, (*g)?))).collect();
        let pairs = links.iter().filter(|&&(h, g)| !is_torn(mesh, h, g));
        let pairs: Vec<[usize; 2]> = pairs.map(|&(h, g)| [h / 3, g / 3]).collect();
        let piece_of = joined_sets(mesh.face_count(), &pairs);
        let stays = links
            .iter()
            .filter(|&&(h, g)| piece_of[h / 3] == piece_of[g / 3]);
        let turns: Vec<_> = stays.map(|&(h, g)| [h, g / 3 * 3 + (g + 1) % 3]).collect();
        Whole {
            mesh,
            piece_of,
            orbit_of: joined_sets(mesh.half_edge_count(), &turns),
            twins,
        }
    }

    /// All pieces are those of the oracle, and weigh what the whole weighs.
    fn check(&self, positions: &Positions, counts: &mut Counts) {
        let pieces = self.mesh.pieces(&self.mesh.components());
        let representatives: BTreeSet<usize> = self.piece_of.iter().copied().collect();
        assert_eq!(pieces.len(), representatives.len(), "pieces");
        let area = |mesh: &Mesh, at: &dyn Fn(VertexId) -> Point, f| {
            let [a, b, c] = mesh.face_vertices(f).map(at);
            (b - a).cross(&(c - a)).norm() / 2.0
        };
        let mut parts = ExactSum::new();
        for (piece, representative) in pieces.iter().zip(representatives) {
            let own = (0..self.piece_of.len()).filter(|&f| self.piece_of[f] == representative);
            assert!(piece.faces.iter().map(|f| f.index()).eq(own), "faces");
            let at = |v: VertexId| positions.at(piece.vertices[v.index()]);
            parts.extend(piece.mesh.faces().map(|f| area(&piece.mesh, &at, f)));
            self.check_piece(piece, counts);
        }
        let at = |v| positions.at(v);
        let whole = self.mesh.faces().map(|f| area(self.mesh, &at, f));
        assert_eq!(parts, whole.collect::<ExactSum>(), "areas");
        counts.meshes += 1;
        counts.apart += usize::from(pieces.len() > 1);
    }

    fn check_piece(&self, piece: &DerivedMesh, counts: &mut Counts) {
        let (own, mesh) = (&piece.mesh, self.mesh);
        assert_eq!(own.check(), []);
        assert_eq!(own.vertex_count(), piece.vertices.len());
        assert!(piece.vertices.is_sorted(), "vertices ascend");
        let corners = piece.faces.iter().flat_map(|f| f.half_edges());
        assert!(piece.corners.iter().copied().eq(corners), "corners");
        let back = |h: HalfEdgeId| piece.corners[h.index()];
        assert!(piece.faces.is_sorted_by(|f, g| f < g), "faces ascend");
        let is_here = |h: &HalfEdgeId| piece.faces.binary_search(&h.face()).is_ok();

        let mut labels: BTreeMap<(VertexId, usize), VertexId> = BTreeMap::new();
        for h in own.half_edges() {
            let source = back(h);
            let vertex = piece.vertices[own.origin(h).index()];
            assert_eq!(vertex, mesh.origin(source), "the vertex of {h}");
            assert_eq!(piece.faces[h.face().index()], source.face());
            // The same links, where both sides are here.
            let twin = self.twins[source.index()].and_then(HalfEdgeId::new);
            let here = twin.filter(is_here);
            assert_eq!(own.pair_or_ghost(h).map(back), here, "the link of {h}");
            if let Some(g) = twin {
                let torn = is_torn(mesh, source.index(), g.index());
                let is_ghost = own.ghost_pair(h).is_some();
                assert_eq!(is_ghost, torn && here.is_some(), "the mark of {h}");
                assert!(torn || here.is_some(), "a pair stays in its piece");
                counts.kept += usize::from(torn && here.is_some());
                counts.lost += usize::from(torn && here.is_none());
            }
            // A fan is walked as in the whole.
            assert!(own.fan(h).map(back).eq(mesh.fan(source)), "the fan of {h}");
            // One vertex for each way round a vertex.
            let label = (mesh.origin(source), self.orbit_of[source.index()]);
            let known = *labels.entry(label).or_insert(own.origin(h));
            assert_eq!(known, own.origin(h), "{h} has a way to the others");
        }
        assert_eq!(labels.len(), own.vertex_count(), "one for each way round");
        for &v in &piece.vertices {
            let is_copy = |w: &VertexId| piece.vertices[w.index()] == v;
            let copies: Vec<VertexId> = own.vertices().filter(is_copy).collect();
            counts.separated += usize::from(copies.len() > 1);
            let of_copies = copies.iter().flat_map(|&w| own.corners_of(w)).map(back);
            let of_copies: BTreeSet<HalfEdgeId> = of_copies.collect();
            let expected: BTreeSet<HalfEdgeId> = mesh.corners_of(v).filter(is_here).collect();
            assert_eq!(of_copies, expected, "the corners of {v}");
            let fans = mesh.fans(v).filter(is_here).count();
            counts.bow_ties += usize::from(fans > 1);
        }
    }
}

/// Whether two sides that were one edge have other ends now.
fn is_torn(mesh: &Mesh, h: usize, g: usize) -> bool {
    let [[a, b], [c, d]] = [h, g].map(|h| [h, h / 3 * 3 + (h + 1) % 3].map(|h| mesh.indices()[h]));
    [a, b] != [d, c]
}

#[test]
fn pieces_of_torn_meshes_match_the_whole() {
    let mut counts = Counts::default();
    for script in scripts() {
        let mut steps = 0;
        let world = script.run(|world, _| {
            steps += 1;
            // Half of a script too, as a rule not torn so much.
            if 2 * steps == script.operations.len() {
                Whole::new(&world.mesh).check(&world.positions, &mut counts);
            }
        });
        Whole::new(&world.mesh).check(&world.positions, &mut counts);
    }
    let least = counts.meshes / 10;
    let is_torn = counts.kept > 10 * least && counts.lost > 10 * least;
    assert!(counts.apart > least && is_torn, "{counts:?}");
    assert!(
        counts.bow_ties > least && counts.separated > 0,
        "{counts:?}"
    );
}

#[test]
fn the_components_of_another_mesh_are_refused() {
    let whole = shapes::grid(2, 1).0;
    let mut apart = whole.clone();
    for v in [1, 4].map(|v| whole.vertex(v)) {
        let moving: Vec<FaceId> = apart.faces_of(v).filter(|f| f.index() > 1).collect();
        split::vertex(&mut apart, v, &moving, &mut Edits::new()).expect("others stay");
    }
    for (mesh, other) in [(&whole, &apart), (&apart, &whole)] {
        let pieces = std::panic::catch_unwind(|| mesh.pieces(&other.components()));
        assert!(pieces.is_err(), "as many faces, but other components");
    }
}

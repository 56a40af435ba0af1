//! A garment as the kernel sees it: panels are a torn mesh that is not yet sewn.

use tearmesh::{Defect, Edits, HalfEdgeId, Mesh, TornError, VertexId, mend, unshare};

/// Two panels apart, of four cells each: vertices 0 to 8 in rows of three, and those 9 behind them, turned over.
fn panels() -> Vec<[u32; 3]> {
    let cells = [0, 1, 3, 4].map(|a| [[a, a + 1, a + 3], [a + 3, a + 1, a + 4]]);
    let front = cells.as_flattened();
    let back = front.iter().map(|[a, b, c]| [a + 9, c + 9, b + 9]);
    front.iter().copied().chain(back).collect()
}

/// The root of each of `count` vertices, where these pairs are sewn.
fn roots(count: u32, pairs: &[[u32; 2]]) -> Vec<u32> {
    let mut roots: Vec<u32> = (0..count).collect();
    for &[one, other] in pairs {
        let [a, b] = [one, other].map(|v| roots[v as usize]);
        let root = |of: u32| if of == a.max(b) { a.min(b) } else { of };
        roots = roots.into_iter().map(root).collect();
    }
    roots
}

fn defects(faces: &[[u32; 3]], roots: &[u32]) -> Vec<Defect> {
    match Mesh::build_torn(faces, roots) {
        Err(TornError::Build(error)) => error.defects().to_vec(),
        other => panic!("it was not refused for its faces: {other:?}"),
    }
}

fn v(index: u32) -> VertexId {
    VertexId::new(index as usize).expect("small")
}

fn pieces(mesh: &Mesh) -> usize {
    mesh.components().count()
}

#[test]
fn a_seam_is_torn_until_it_is_sewn_and_once_unpicked() {
    // A tube: both sides of the front are sewn to both sides of the back.
    let pairs = [0, 2, 3, 5, 6, 8].map(|v| [v, v + 9]);
    let apart = Mesh::build_torn(&panels(), &roots(18, &pairs)).expect("panels");
    assert_eq!(apart.check(), []);
    assert_eq!(
        (pieces(&apart), apart.indices()),
        (2, panels().as_flattened())
    );
    let is_seam = |h: HalfEdgeId| apart.ghost_pair(h).is_some();
    assert_eq!(apart.half_edges().filter(|&h| is_seam(h)).count(), 8);

    let (mut mesh, mut edits) = (apart.clone(), Edits::new());
    // From the middle of the seams, so that vertices pass through bow-ties.
    while let stitches @ [_, ..] = &mend::stitches(&mesh, |_| true)[..] {
        let stitch = stitches[stitches.len() / 2];
        let sewn = mend::merge(
            &mut mesh,
            stitch.kept(),
            stitch.gone(),
            [1.0; 2],
            &mut edits,
        );
        sewn.expect("they have one root");
        assert_eq!(mesh.check(), []);
    }
    let sewn: Vec<[u32; 3]> = mesh.indices().as_chunks().0.to_vec();
    assert_eq!(mesh, Mesh::build(12, &sewn).expect("a tube"));
    assert_eq!((pieces(&mesh), mesh.boundary_loops().len()), (1, 2));
    assert!(mesh.half_edges().all(|h| mesh.ghost_pair(h).is_none()));

    let all: Vec<VertexId> = mesh.vertices().collect();
    unshare::by_fan(&mut mesh, &all, is_seam, &mut edits);
    assert_eq!(mesh.check(), []);
    assert_eq!((pieces(&mesh), mesh.vertex_count()), (2, 18));
    for h in mesh.half_edges() {
        assert_eq!(
            (mesh.pair(h), mesh.ghost_pair(h)),
            (apart.pair(h), apart.ghost_pair(h))
        );
    }
}

#[test]
fn a_dart_closes_on_its_own_panel() {
    // A fan of four faces around 0, open between 1 and 5: the dart, with its tip at 0.
    let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    let mesh = Mesh::build_torn(&fan, &roots(6, &[[1, 5]])).expect("a dart");
    assert_eq!(mesh.check(), []);
    let (mut mesh, mut edits) = (mesh, Edits::new());
    assert_eq!(mesh.fans(v(0)).count(), 1);
    let merge = mend::merge(&mut mesh, v(1), v(5), [1.0, 1.0], &mut edits).expect("one root");
    assert_eq!(merge.sewn.len(), 1);
    assert_eq!((mesh.boundary_loops().len(), mesh.edges().count()), (1, 8));
}

#[test]
fn seams_that_make_no_manifold_are_refused_by_vertices() {
    // A third panel on the seam of two.
    let mut three = panels();
    three.push([18, 19, 20]);
    let pairs = [[0, 9], [3, 12], [0, 18], [3, 19]];
    let found = defects(&three, &roots(21, &pairs));
    let crowded = |defect: &Defect| match defect {
        Defect::CrowdedEdge { ends, faces } => Some((*ends, faces.len())),
        _ => None,
    };
    assert!(
        found.iter().filter_map(crowded).eq([([v(0), v(3)], 3)]),
        "{found:?}"
    );

    // Panels that share one vertex, at the end of no seam.
    let found = defects(&panels(), &roots(18, &[[0, 9]]));
    assert!(
        matches!(found[..], [Defect::BowTie { vertex, .. }] if vertex == v(0)),
        "{found:?}"
    );

    // Both panels lie the same way up: one has to be turned over.
    let mut same = panels();
    same[8..].iter_mut().for_each(|face| face.swap(1, 2));
    let found = defects(&same, &roots(18, &[[0, 9], [3, 12]]));
    let flipped = |defect: &Defect| matches!(defect, Defect::FlippedFace { .. });
    assert!(found.iter().any(flipped), "{found:?}");
}

//! Properties of a mesh on its own.

use tearmesh::{HalfEdgeId, Mesh, TornLink};

use super::history::triangles;
use crate::oracle::Soup;

/// All properties of a mesh on its own.
pub(super) fn agrees(mesh: &Mesh, soup: &Soup) {
    assert_eq!(mesh.check(), [], "no invariant is broken");
    let triangles = soup.faces.as_flattened();
    assert_eq!(
        mesh.indices(),
        triangles,
        "the index buffer is the list of triangles"
    );
    let corners = soup.corners_by_vertex();
    the_walk_lists_exactly_the_corners(mesh, &corners);
    the_fans_are_those_joined_by_edges(mesh, soup);
    the_boundary_loops_run_along_all_that_has_no_pair(mesh);
    the_torn_links_are_those_whose_ends_differ(mesh, soup);
    the_roots_give_the_whole_back(mesh, soup);
    triangles_and_roots_are_all_there_is(mesh);
    assert_eq!(mesh.edges().count(), soup.edge_count(), "edges");
    assert_eq!(mesh.components().count(), soup.piece_count(), "components");
}

/// I10, I9: the walk round a vertex lists the corners that a scan of all faces finds, each once.
fn the_walk_lists_exactly_the_corners(mesh: &Mesh, corners: &[Vec<usize>]) {
    assert_eq!(mesh.vertex_count(), corners.len());
    let mut walked = Vec::new();
    for (v, truth) in mesh.vertices().zip(corners) {
        walked.clear();
        walked.extend(mesh.corners_of(v).map(HalfEdgeId::index));
        walked.sort_unstable();
        assert_eq!(walked, *truth, "the corners of {v}");
        let smallest = mesh.half_edge_of(v).map(HalfEdgeId::index);
        assert_eq!(smallest, truth.first().copied(), "the half-edge of {v}");
    }
}

/// I19: the fans of a vertex are its corners, joined by edges that are not torn, from whichever of them
/// the walk begins.
fn the_fans_are_those_joined_by_edges(mesh: &Mesh, soup: &Soup) {
    let fan = |h: HalfEdgeId| {
        let mut fan: Vec<usize> = mesh.fan(h).map(HalfEdgeId::index).collect();
        fan.sort_unstable();
        fan
    };
    for (v, truth) in mesh.vertices().zip(soup.fans_by_vertex()) {
        let mut fans: Vec<Vec<usize>> = mesh.fans(v).map(fan).collect();
        fans.sort_unstable();
        assert_eq!(fans, truth, "the fans of {v}");
        for h in mesh.corners_of(v) {
            assert!(truth.contains(&fan(h)), "the fan of {h}");
        }
    }
}

/// I18: the boundary loops list each half-edge without a pair once, and each starts where the one before
/// ends.
fn the_boundary_loops_run_along_all_that_has_no_pair(mesh: &Mesh) {
    let mut listed = Vec::new();
    for start in mesh.boundary_loops() {
        let around: Vec<HalfEdgeId> = mesh.boundary_loop(start).collect();
        for (i, &h) in around.iter().enumerate() {
            let next = around[(i + 1) % around.len()];
            assert_eq!(mesh.target(h), mesh.origin(next), "{next} after {h}");
        }
        listed.extend(around);
    }
    listed.sort_unstable();
    let lone = mesh.half_edges().filter(|&h| mesh.pair(h).is_none());
    assert!(lone.eq(listed), "half-edges without a pair");
}

/// I4 to I7, I15: what is joined in the whole is a pair where the ends agree, and else a
/// ghost pair; everything else is boundary.
fn the_torn_links_are_those_whose_ends_differ(mesh: &Mesh, soup: &Soup) {
    for &link in &soup.links {
        let [h, g] = link.map(|(f, i)| mesh.faces().nth(f).expect("a face").half_edges()[i]);
        let expected = if soup.is_torn(link) {
            (None, Some(g))
        } else {
            (Some(g), None)
        };
        assert_eq!(
            (mesh.pair(h), mesh.ghost_pair(h)),
            expected,
            "pair and ghost pair of {h}"
        );
        let back = expected.0.and(Some(h));
        assert_eq!(mesh.pair(g), back, "pair of {g}");
        assert_eq!(mesh.pair_or_ghost(g), Some(h), "pair or ghost pair of {g}");
    }
    let linked = mesh
        .half_edges()
        .filter(|&h| mesh.pair_or_ghost(h).is_some());
    assert_eq!(linked.count(), 2 * soup.links.len(), "links");
}

/// I8, I21: with each vertex replaced by its root, the triangles are those of a mesh of
/// which nothing was ever split.
fn the_roots_give_the_whole_back(mesh: &Mesh, soup: &Soup) {
    assert_eq!(mesh.roots(), soup.roots(), "roots");
    assert!(soup.is_whole_but_for_splits(), "a corner changed its class");
}

/// I9, I15: links, marks and half-edges are functions of the triangles and the roots.
fn triangles_and_roots_are_all_there_is(mesh: &Mesh) {
    let again = Mesh::build_torn(triangles(mesh), &mesh.roots());
    assert_eq!(again.as_ref(), Ok(mesh), "built again");
}

/// V − E + F.
pub(super) fn euler(mesh: &Mesh) -> isize {
    (mesh.vertex_count() + mesh.face_count()) as isize - mesh.edges().count() as isize
}

/// I15: links never change, and are torn exactly where they are to be; a record lists each link that
/// changed its mark once, by its two half-edges.
pub(super) fn only_these_marks_change(
    before: &Mesh,
    after: &Mesh,
    is_torn: impl Fn(HalfEdgeId) -> bool,
    listed: &[TornLink],
) {
    let mut changed = 0;
    for h in before.half_edges() {
        let link = after.pair_or_ghost(h);
        assert_eq!(link, before.pair_or_ghost(h), "links never change");
        let [was, is] = [before, after].map(|mesh| mesh.ghost_pair(h).is_some());
        assert_eq!(is, link.is_some() && is_torn(h), "whether {h} is torn");
        let here = listed
            .iter()
            .filter(|link| [link.stayed, link.moved].contains(&h));
        assert_eq!(here.count(), usize::from(was != is), "{h} among {listed:?}");
        changed += usize::from(was != is);
    }
    assert_eq!(changed, 2 * listed.len(), "two half-edges for each link");
    for link in listed {
        assert_eq!(after.pair_or_ghost(link.stayed), Some(link.moved), "a link");
    }
}

/// Whether the ends of a half-edge are not those of the one across.
pub(super) fn ends_differ(mesh: &Mesh, h: HalfEdgeId) -> bool {
    let ends = |h| [mesh.origin(h), mesh.target(h)];
    let across = mesh.pair_or_ghost(h).map(ends);
    across.is_some_and(|[from, to]| ends(h) != [to, from])
}

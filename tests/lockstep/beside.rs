//! What is kept beside a mesh: positions, masses, data of vertices and corners.

use std::collections::BTreeMap;

use tearmesh::script::World;
use tearmesh::{
    ChildFace, Edit, HalfEdgeId, Insert, InsertLocation, Masses, Mesh, Mix, PerCorner, PerVertex,
    Positions, Slide, VertexId,
};

use crate::oracle::{Soup, WHOLE, between};

/// I20: positions are copied bit for bit, and nothing moves but what slides or is merged.
pub(super) fn every_vertex_is_where_the_soup_has_it(positions: &Positions, soup: &Soup) {
    let bits = |x: [f64; 3]| x.map(f64::to_bits);
    let points = positions.as_slice().iter().map(|p| bits([p.x, p.y, p.z]));
    assert!(points.eq(soup.points.iter().map(|&p| bits(p))), "positions");
}

/// I20 for masses by area.
pub(super) fn every_vertex_weighs_what_its_faces_weigh(masses: &Masses, soup: &Soup, unit: f64) {
    let mut units = vec![0; soup.class.len()];
    for (&v, &mass) in soup
        .faces
        .as_flattened()
        .iter()
        .zip(soup.corner_mass.as_flattened())
    {
        units[v as usize] += mass;
    }
    assert_eq!(masses.len(), units.len());
    for (v, units) in (0..).map_while(VertexId::new).zip(units) {
        assert_eq!(masses.at(v), units as f64 * unit, "the mass of {v}");
    }
    assert!(masses.ledger().is_balanced(), "the total mass");
}

/// I20 for masses by halves.
pub(super) fn halves_add_up(masses: &Masses, soup: &Soup, unit: f64) {
    let halved = soup.halved.as_ref().expect("nothing was inserted");
    assert_eq!(masses.len(), halved.len());
    let roots = soup.roots();
    let mut parts = vec![0; soup.class.len()];
    for (v, &(root, part)) in (0..).map_while(VertexId::new).zip(halved) {
        let exact = root as f64 * unit * (part as f64 / WHOLE as f64);
        let off = (masses.at(v) - exact).abs();
        let rounding = if part.is_power_of_two() {
            0.0
        } else {
            1e-15 * exact
        };
        assert!(
            off <= rounding,
            "the mass of {v} is {}, not {exact}",
            masses.at(v)
        );
        parts[roots[v.index()] as usize] += part;
    }
    assert!(
        parts.iter().all(|&sum| sum == 0 || sum == WHOLE),
        "the oracle loses no mass"
    );
    assert!(masses.ledger().is_balanced(), "the total mass");
}

/// Data of a corner is interpolated in its face, so that which is linear is that at its vertex. A
/// merge moves vertices that are apart, and no corner.
pub(super) fn every_corner_is_where_its_vertex_is(corners: &PerCorner<[f64; 3]>, soup: &Soup) {
    let corners = corners.as_slice();
    assert_eq!(corners.len(), 3 * soup.faces.len());
    if soup.joined_apart {
        return;
    }
    for (h, (at, &v)) in corners.iter().zip(soup.faces.as_flattened()).enumerate() {
        let point = soup.points[v as usize];
        let apart = (0..3).map(|i| (at[i] - point[i]).abs()).fold(0.0, f64::max);
        let large = point.iter().fold(1.0, |large, x| x.abs().max(large));
        assert!(
            apart <= 1e-12 * large,
            "corner {h} is at {at:?}, vertex {v} at {point:?}"
        );
    }
}

/// Numbers that have nothing to do with each other, so that no two places can be mistaken.
fn scattered(i: usize) -> f64 {
    ((i * 7919 + 13) % 1009) as f64 / 16.0
}

/// The places of all vertices, and a number for each.
type Values = Vec<[f64; 4]>;

fn values(positions: &Positions, numbers: &PerVertex<f64>) -> Values {
    let points = positions.as_slice().iter().zip(numbers.as_slice());
    points.map(|(p, &x)| [p.x, p.y, p.z, x]).collect()
}

/// Scattered values of vertices before an edit and after it, and of corners after it.
fn scattered_values(mesh: &Mesh, edit: &Edit<'_>) -> ([Values; 2], Vec<f64>) {
    let seen = edit.before();
    let point = |v: VertexId| [0, 1, 2].map(|i| scattered(3 * v.index() + i));
    let positions = Positions::new(mesh.vertices().map(point)).expect("small numbers");
    let numbers = mesh.vertices().map(|v| scattered(v.index()));
    let corners = mesh.half_edges().map(|h| scattered(h.index()));
    let mut positions = positions.starting_at(seen);
    let mut numbers = PerVertex::new(numbers.collect()).starting_at(seen);
    let mut corners = PerCorner::new(corners.collect()).starting_at(seen);
    let old = values(&positions, &numbers);
    edit.pass_on(&mut positions);
    edit.pass_on(&mut numbers);
    edit.pass_on(&mut corners);
    let new = values(&positions, &numbers);
    ([old, new], corners.as_slice().to_vec())
}

/// Vertices that are new, merged or slid, and new corners, have what the record's weights give,
/// wherever the copies of the ends have moved meanwhile; all others keep what they have.
pub(super) fn new_values_come_from_the_right_places(mesh: &Mesh, edit: &Edit<'_>) {
    let ([old, new], corners) = scattered_values(mesh, edit);
    let mut was: Vec<usize> = (0..old.len()).collect();
    let mut made: BTreeMap<usize, Vec<(VertexId, f64)>> = BTreeMap::new();
    match edit {
        Edit::Split(split) => was.push(split.old.index()),
        Edit::Insert(insert) => {
            for point in insert.points {
                let weights = match point.at {
                    InsertLocation::Edge { ends: [a, b], t } => vec![(a, 1.0 - t), (b, t)],
                    InsertLocation::Face { vertices, weights } => {
                        vertices.into_iter().zip(weights).collect()
                    }
                };
                made.insert(point.vertex.index(), weights);
                was.push(usize::MAX);
            }
            corners_come_from_their_faces(mesh, insert, &corners);
        }
        Edit::Merge(merge) => {
            was.swap_remove(merge.gone.index());
            let weights = vec![(merge.kept, merge.share), (merge.gone, 1.0 - merge.share)];
            made.insert(merge.kept.index(), weights);
        }
        Edit::Slide(slide) => {
            let weights = vec![(slide.vertex, 1.0 - slide.t), (slide.toward, slide.t)];
            made.insert(slide.vertex.index(), weights);
        }
    }
    assert_eq!(new.len(), was.len());
    for (v, (new, was)) in new.iter().zip(was).enumerate() {
        let Some(weights) = made.get(&v) else {
            assert_eq!(*new, old[was], "{v} after {edit:?}");
            continue;
        };
        for (i, x) in new.iter().enumerate() {
            let mean: f64 = weights.iter().map(|&(v, w)| w * old[v.index()][i]).sum();
            assert!((x - mean).abs() < 1e-9, "{v} after {edit:?}");
        }
    }
}

/// Of the children of divided faces; all others keep what they have.
fn corners_come_from_their_faces(mesh: &Mesh, insert: &Insert<'_>, corners: &[f64]) {
    let mut divided = vec![false; corners.len()];
    for child in insert.children {
        for (h, source) in child.face.half_edges().into_iter().zip(child.sources) {
            let weights = weights_in_parent(child, &source);
            let parent = child.parent.half_edges().map(|h| scattered(h.index()));
            let mean: f64 = (0..3).map(|i| weights[i] * parent[i]).sum();
            assert!((corners[h.index()] - mean).abs() < 1e-9, "{h} of {child:?}");
            divided[h.index()] = true;
        }
    }
    for h in mesh
        .half_edges()
        .map(HalfEdgeId::index)
        .filter(|&h| !divided[h])
    {
        assert_eq!(corners[h], scattered(h), "{h} is of no divided face");
    }
}

/// The weights of the corners of the parent in a corner of a child.
pub(super) fn weights_in_parent(child: &ChildFace, source: &Mix<HalfEdgeId>) -> [f64; 3] {
    let mut weights = [0.0; 3];
    let mut add = |h: HalfEdgeId, weight: f64| {
        assert_eq!(h.face(), child.parent, "a source is a corner of the parent");
        weights[h.corner()] += weight;
    };
    match *source {
        Mix::Copy(h) => add(h, 1.0),
        Mix::Between { ends: [a, b], t } => {
            add(a, 1.0 - t);
            add(b, t);
        }
        Mix::Weighted { weights: given, .. } => weights = given,
    }
    weights
}

/// Where a vertex slides, its corners in the faces of the edge have what lies between the two ends in
/// that face, and its other corners with the same value go with them; all others keep theirs.
pub(super) fn corners_go_along(before: &World, after: &World, slide: &Slide<'_>) {
    let [was, is] = [before, after].map(|world| world.corners.as_slice());
    let ends = [slide.vertex, slide.toward].map(u32::from);
    let faces = before.mesh.indices().as_chunks::<3>().0.iter().enumerate();
    let along = faces.filter_map(|(f, face)| {
        let [corner, toward] = ends.map(|end| face.iter().position(|&v| v == end));
        let [corner, toward] = [3 * f + corner?, 3 * f + toward?];
        Some((corner, between(was[corner], was[toward], slide.t)))
    });
    let along: Vec<(usize, [f64; 3])> = along.collect();
    for (h, &v) in before.mesh.indices().iter().enumerate() {
        let own = along.iter().find(|(corner, _)| *corner == h);
        let alike: Vec<_> = along
            .iter()
            .filter(|(corner, _)| v == ends[0] && was[*corner] == was[h])
            .collect();
        let expected = match own {
            Some((_, value)) => is[h] == *value,
            None if alike.is_empty() => is[h] == was[h],
            None => alike.iter().any(|(_, value)| is[h] == *value),
        };
        assert!(expected, "corner {h} went from {:?} to {:?}", was[h], is[h]);
    }
}

//! What is kept beside a mesh: positions, masses, data of vertices and corners.

use tearmesh::script::World;
use tearmesh::{
    ChildFace, CornerSource, Cursor, Edit, HalfEdgeId, InsertLocation, Masses, Mesh, PerCorner,
    PerVertex, Point, Positions, Slide, VertexId,
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

fn scattered_points(mesh: &Mesh, seen: Cursor) -> Positions {
    let point = |v: VertexId| [0, 1, 2].map(|i| scattered(3 * v.index() + i));
    Positions::new(mesh.vertices().map(point))
        .expect("small numbers")
        .starting_at(seen)
}

fn coordinates(point: Point) -> [f64; 3] {
    [point.x, point.y, point.z]
}

/// New vertices and corners have what the record's weights give, wherever the copies of the
/// ends have moved meanwhile; all others keep what they have.
pub(super) fn new_values_come_from_the_right_places(mesh: &Mesh, edit: &Edit<'_>) {
    let Edit::Insert(insert) = edit else {
        panic!("not an insertion: {edit:?}");
    };
    let mut positions = scattered_points(mesh, edit.before());
    let speed = |v: VertexId| scattered(v.index());
    let mut speeds = PerVertex::new(mesh.vertices().map(speed).collect());
    speeds = speeds.starting_at(edit.before());
    let mut values = PerCorner::new(mesh.half_edges().map(|h| scattered(h.index())).collect());
    values = values.starting_at(edit.before());
    let old = positions.clone();
    edit.pass_on(&mut positions);
    edit.pass_on(&mut speeds);
    edit.pass_on(&mut values);

    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} is not {b} after {edit:?}");
    for v in mesh.vertices() {
        assert_eq!((positions.at(v), *speeds.at(v)), (old.at(v), speed(v)));
    }
    for point in insert.points {
        let weights: Vec<(VertexId, f64)> = match point.at {
            InsertLocation::Edge { ends: [a, b], t } => vec![(a, 1.0 - t), (b, t)],
            InsertLocation::Face { vertices, weights } => {
                vertices.into_iter().zip(weights).collect()
            }
        };
        let sum = |of: &dyn Fn(VertexId) -> f64| weights.iter().map(|&(v, w)| w * of(v)).sum();
        close(*speeds.at(point.vertex), sum(&speed));
        for i in 0..3 {
            let mean = sum(&|v| coordinates(old.at(v))[i]);
            close(coordinates(positions.at(point.vertex))[i], mean);
        }
    }
    let mut divided = vec![false; mesh.half_edge_count()];
    for child in insert.children {
        for (h, source) in child.face.half_edges().into_iter().zip(child.sources) {
            let weights = weights_in_parent(child, &source);
            let parent = child.parent.half_edges().map(|h| scattered(h.index()));
            let mean = (0..3).map(|i| weights[i] * parent[i]).sum();
            close(*values.at(h), mean);
            if h.index() < divided.len() {
                divided[h.index()] = true;
            }
        }
    }
    for h in mesh.half_edges().filter(|h| !divided[h.index()]) {
        assert_eq!(
            *values.at(h),
            scattered(h.index()),
            "{h} is of no divided face"
        );
    }
}

/// The weights of the corners of the parent in a corner of a child.
pub(super) fn weights_in_parent(child: &ChildFace, source: &CornerSource) -> [f64; 3] {
    let mut weights = [0.0; 3];
    let mut add = |h: HalfEdgeId, weight: f64| {
        assert_eq!(h.face(), child.parent, "a source is a corner of the parent");
        weights[h.corner()] += weight;
    };
    match *source {
        CornerSource::Corner(h) => add(h, 1.0),
        CornerSource::Edge { ends: [a, b], t } => {
            add(a, 1.0 - t);
            add(b, t);
        }
        CornerSource::Face { weights: given } => weights = given,
    }
    weights
}

/// What moved apart is joined at the weighted mean; all other vertices keep what they have.
pub(super) fn merged_values_are_joined_by_weight(mesh: &Mesh, edit: &Edit<'_>) {
    let Edit::Merge(merge) = edit else {
        panic!("not a merge: {edit:?}");
    };
    let mut positions = scattered_points(mesh, edit.before());
    let speed = |v: VertexId| scattered(v.index());
    let mut speeds = PerVertex::new(mesh.vertices().map(speed).collect());
    speeds = speeds.starting_at(edit.before());
    let old = positions.clone();
    edit.pass_on(&mut positions);
    edit.pass_on(&mut speeds);
    let last = mesh.vertices().next_back().expect("a vertex");
    assert_eq!(positions.len(), last.index());
    for v in mesh.vertices().take(last.index()) {
        if v == merge.kept {
            let mean = |kept: f64, gone: f64| merge.share * kept + (1.0 - merge.share) * gone;
            let [kept, gone] = [v, merge.gone].map(|v| coordinates(old.at(v)));
            for (i, x) in coordinates(positions.at(v)).into_iter().enumerate() {
                assert!(
                    (x - mean(kept[i], gone[i])).abs() < 1e-9,
                    "{v} after {merge:?}"
                );
            }
            assert!((*speeds.at(v) - mean(speed(v), speed(merge.gone))).abs() < 1e-9);
        } else {
            let was = if v == merge.gone { last } else { v };
            assert_eq!(
                (positions.at(v), *speeds.at(v)),
                (old.at(was), speed(was)),
                "{v}"
            );
        }
    }
}

/// A vertex that slides has what lies between it and the other end of the edge; all other vertices
/// keep what they have.
pub(super) fn slid_values_lie_along_the_edge(mesh: &Mesh, edit: &Edit<'_>) {
    let Edit::Slide(slide) = edit else {
        panic!("not a slide: {edit:?}");
    };
    let mut positions = scattered_points(mesh, edit.before());
    let speed = |v: VertexId| scattered(v.index());
    let mut speeds = PerVertex::new(mesh.vertices().map(speed).collect());
    speeds = speeds.starting_at(edit.before());
    let old = positions.clone();
    edit.pass_on(&mut positions);
    edit.pass_on(&mut speeds);
    for v in mesh.vertices() {
        if v == slide.vertex {
            let mean = |v: f64, toward: f64| (1.0 - slide.t) * v + slide.t * toward;
            let [from, toward] = [v, slide.toward].map(|v| coordinates(old.at(v)));
            for (i, x) in coordinates(positions.at(v)).into_iter().enumerate() {
                assert!(
                    (x - mean(from[i], toward[i])).abs() < 1e-9,
                    "{v} after {slide:?}"
                );
            }
            assert!((*speeds.at(v) - mean(speed(v), speed(slide.toward))).abs() < 1e-9);
        } else {
            assert_eq!(
                (positions.at(v), *speeds.at(v)),
                (old.at(v), speed(v)),
                "{v}"
            );
        }
    }
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

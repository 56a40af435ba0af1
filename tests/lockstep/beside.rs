//! The followers beside a mesh: positions, masses, data of vertices and corners.

use tearmesh::{ChildFace, HalfEdgeId, Masses, Mix, PerCorner, Positions, VertexId};

use crate::oracle::{Soup, WHOLE};

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
    assert_eq!(masses.vertex_count(), units.len());
    for (v, units) in (0..).map_while(VertexId::new).zip(units) {
        assert_eq!(masses.at(v), units as f64 * unit, "the mass of {v}");
    }
    assert!(masses.ledger().is_balanced(), "the total mass");
}

/// I20 for masses by halves.
pub(super) fn halves_add_up(masses: &Masses, soup: &Soup, unit: f64) {
    let halved = soup.halved.as_ref().expect("nothing was inserted");
    assert_eq!(masses.vertex_count(), halved.len());
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

/// The weights of the corners of the parent in a corner of a child.
pub(crate) fn weights_in_parent(child: &ChildFace, source: &Mix<HalfEdgeId>) -> [f64; 3] {
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
        _ => unreachable!("there is no other mix"),
    }
    weights
}

//! Polygons with corners on a line, or nearly on one as rounding leaves them, against all
//! triangulations that there are.

use super::random::Random;
use super::triangulate::{polygon, triangles};
use super::vectors::{cross, dot, minus};

type Place = [f64; 3];

/// A face whose altitude is a smaller part of its longest side has no area to speak of.
const THIN: f64 = 1e-3;

/// The least altitude of a triangle, as a part of its longest side; negative if it faces away.
fn altitude([a, b, c]: [Place; 3], normal: Place) -> f64 {
    let doubled = cross(minus(b, a), minus(c, a));
    let sides = [[a, b], [b, c], [c, a]].map(|[p, q]| dot(minus(q, p), minus(q, p)));
    let longest = sides.into_iter().fold(0.0, f64::max);
    dot(doubled, doubled).sqrt() / longest * dot(doubled, normal).signum()
}

/// The largest least altitude that any triangulation has of the corners from `first` to `last`:
/// each of those between is tried as the third corner on the side between these two.
fn best_of_all(polygon: &[Place], normal: Place, [first, last]: [usize; 2]) -> f64 {
    let with = |third: usize| {
        let own = altitude([first, third, last].map(|i| polygon[i]), normal);
        let left = best_of_all(polygon, normal, [first, third]);
        own.min(left)
            .min(best_of_all(polygon, normal, [third, last]))
    };
    if last - first == 1 {
        return f64::INFINITY;
    }
    (first + 1..last)
        .map(with)
        .fold(f64::NEG_INFINITY, f64::max)
}

/// The least altitude of what the reader makes of a polygon, and the best there is.
fn altitudes(polygon: &[Place]) -> [f64; 2] {
    let sides = (1..polygon.len() - 1).map(|i| {
        cross(
            minus(polygon[i], polygon[0]),
            minus(polygon[i + 1], polygon[0]),
        )
    });
    let normal = sides.fold([0.0; 3], |sum, one| [0, 1, 2].map(|i| sum[i] + one[i]));
    let of = |t: &[u32; 3]| altitude(t.map(|i| polygon[i as usize]), normal);
    let least = triangles(polygon)
        .iter()
        .map(of)
        .fold(f64::INFINITY, f64::min);
    [least, best_of_all(polygon, normal, [0, polygon.len() - 1])]
}

#[test]
fn regression_a_quad_is_cut_at_a_corner_near_its_side() {
    let quad = [
        [0.0, 0.0, 0.0],
        [0.314159, -0.271828, 0.141421],
        [0.628319, -0.543656, 0.282843],
        [1.25, 0.75, -0.5],
    ];
    for turn in 0..4 {
        let mut turned = quad;
        turned.rotate_left(turn);
        let [least, best] = altitudes(&turned);
        assert!(best > 0.2 && least > 0.2, "{turn}: {least} of {best}");
    }
}

/// A shape in the plane with more corners on its sides, turned somehow in space, moved, scaled,
/// and rounded to six digits behind the point.
fn shape(random: &mut Random) -> Vec<Place> {
    let shapes = [
        "0 0, 1 0, 0.2 0.9",
        "0 0, 1 0, 1 1, 0 1",
        "0 0, 1 -0.2, 1.3 0.8, 0.1 1.1",
        "0 0, 2 1, 0 2, 0.5 1",
        "0 0, 2 0, 2 1, 1 1, 1 2, 0 2",
    ];
    let mut flat = polygon(shapes[random.below(shapes.len())]);
    for _ in 0..1 + random.below(10 - flat.len()) {
        let side = random.below(flat.len());
        let (a, b) = (flat[side], flat[(side + 1) % flat.len()]);
        let t = [0.5, 1.0 / 3.0, random.next()][random.below(3)];
        flat.insert(side + 1, [0, 1].map(|i| a[i] + t * (b[i] - a[i])));
    }
    let turn = random.below(flat.len());
    flat.rotate_left(turn);
    let axis = [(); 3].map(|()| random.next() - 0.5);
    let other = [(); 3].map(|()| random.next() - 0.5);
    let unit = |v: Place| v.map(|x| x / dot(v, v).sqrt());
    let u = unit(axis);
    let v = unit(cross(u, other));
    let origin = [(); 3].map(|()| 4.0 * random.next());
    let scale = [1.0, 3.0, 0.1][random.below(3)];
    let place = |[x, y]: [f64; 2]| [0, 1, 2].map(|i| origin[i] + scale * (x * u[i] + y * v[i]));
    let rounded = |place: Place| place.map(|x| (x * 1e6).round() / 1e6);
    flat.into_iter().map(place).map(rounded).collect()
}

#[test]
fn triangulation_avoids_thin_faces_where_one_can() {
    let mut possible = 0;
    for seed in 0..3000 {
        let polygon = shape(&mut Random(seed));
        let [least, best] = altitudes(&polygon);
        // What is made largest is the smallest angle, whose sine is between the least altitude and
        // twice that, as parts of the longest side.
        if best > 1.01 * THIN {
            assert!(
                least >= 0.49 * THIN,
                "case {seed}: {least} of {best}: {polygon:?}"
            );
            possible += 1;
        }
    }
    assert!(possible > 2000, "{possible}");
}

//! One polygon to triangles.
//!
//! A polygon is looked at along its Newell normal, more exactly along the axis nearest to
//! it: dropping a coordinate is exact, where a rotation would round. If all triangles of
//! the fan from its first corner face the viewer, that fan is taken: so a convex quad becomes
//! (0, 1, 2), (0, 2, 3), as everywhere. Otherwise ears are cut off: corners whose triangle faces
//! the viewer and holds no other corner.
//!
//! A polygon that crosses itself, or has no area, runs out of ears; then the least bad corner is
//! cut off instead.
//!
//! O(n²): a corner remembers which corner was found in its triangle, and is tested again
//! only when that one is gone, or its triangle has changed, which happens twice for each ear.

use tearmesh::{Point, Vector};

/// A point of a polygon as it is seen.
pub(super) type Flat = [f64; 2];

/// Projects a polygon along an axis so that its area is positive.
pub(super) fn flatten(vertices: &[u32], positions: &[Point], flat: &mut Vec<Flat>) {
    let places = vertices.iter().map(|&vertex| positions[vertex as usize]);
    let axes = axes(places.clone());
    flat.clear();
    flat.extend(places.map(|place| seen(place, axes)));
}

/// The coordinates that are kept of a polygon, in the order in which its area is positive.
#[inline]
fn axes(mut places: impl Iterator<Item = Point>) -> [usize; 2] {
    // Seen from the first corner, large coordinates of a small face do not cancel digits, and the
    // two sides that meet there add nothing.
    let mut corner = || places.next();
    let (Some(origin), Some(second)) = (corner(), corner()) else {
        unreachable!("a polygon has three corners or more");
    };
    let mut normal = [0.0; 3];
    let mut a = second - origin;
    for place in places {
        let b = place - origin;
        let product = cross(a, b);
        normal = [0, 1, 2].map(|axis| normal[axis] + product[axis]);
        a = b;
    }
    let dropped = largest(normal);
    let kept = [[1, 2], [2, 0], [0, 1]][dropped];
    if normal[dropped] < 0.0 {
        [kept[1], kept[0]]
    } else {
        kept
    }
}

/// The cross product.
#[inline]
fn cross(a: Vector, b: Vector) -> [f64; 3] {
    [
        a.y * b.z - a.z * b.y,
        a.z * b.x - a.x * b.z,
        a.x * b.y - a.y * b.x,
    ]
}

/// The axis nearest to a normal.
#[inline]
fn largest(normal: [f64; 3]) -> usize {
    let [x, y, z] = normal.map(f64::abs);
    match () {
        () if z >= x && z >= y => 2,
        () if y >= x => 1,
        () => 0,
    }
}

/// A point without the coordinate that is dropped.
#[inline]
fn seen(place: Point, axes: [usize; 2]) -> Flat {
    let place = [place.x, place.y, place.z];
    axes.map(|axis| place[axis])
}

/// Appends n − 2 triangles of a polygon of n ≥ 3 points.
pub(super) fn cut_into_triangles(flat: &[Flat], triangles: &mut Vec<[u16; 3]>) {
    if is_fan(flat) {
        triangles.extend(fan(flat));
    } else {
        Clipper::new(flat).clip(triangles);
    }
}

/// The triangles of a polygon from its first corner.
#[inline]
fn fan(flat: &[Flat]) -> impl Iterator<Item = [u16; 3]> {
    (1..flat.len() - 1).map(|i| [0, i as u16, i as u16 + 1])
}

/// What [`is_fan`] says of a quad, with no more than its normal takes: along an axis, the doubled
/// area of a triangle is that coordinate of its normal, from the same operations, and turning
/// the view around changes all signs.
#[inline]
pub(super) fn quad_is_fan([a, b, c, d]: [Point; 4]) -> bool {
    let diagonal = c - a;
    let normals = [cross(b - a, diagonal), cross(diagonal, d - a)];
    let axis = largest([0, 1, 2].map(|axis| normals[0][axis] + normals[1][axis]));
    let areas = normals.map(|normal| normal[axis]);
    areas.iter().all(|&area| area > 0.0) || areas.iter().all(|&area| area < 0.0)
}

/// Whether all of these face the viewer.
#[inline]
fn is_fan(flat: &[Flat]) -> bool {
    fan(flat).all(|[a, b, c]| doubled_area(flat, a, b, c) > 0.0)
}

/// Twice the signed area of a triangle of points of the polygon.
#[inline]
pub(super) fn doubled_area(flat: &[Flat], a: u16, b: u16, c: u16) -> f64 {
    let [a, b, c] = [a, b, c].map(|corner| flat[usize::from(corner)]);
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// A polygon from which ears are cut off.
struct Clipper<'p> {
    flat: &'p [Flat],
    /// The corners that are left, as a ring.
    next: Vec<u16>,
    previous: Vec<u16>,
    left: usize,
    /// For each corner, how many of the others, in order, are known not to lie in its
    /// triangle.
    cleared: Vec<u16>,
}

impl<'p> Clipper<'p> {
    fn new(flat: &'p [Flat]) -> Self {
        let count = flat.len() as u16;
        Clipper {
            flat,
            next: (0..count).map(|i| (i + 1) % count).collect(),
            previous: (0..count).map(|i| (i + count - 1) % count).collect(),
            left: flat.len(),
            cleared: vec![0; flat.len()],
        }
    }

    fn clip(mut self, triangles: &mut Vec<[u16; 3]>) {
        let mut corner = 1;
        while self.left > 3 {
            let ear = self.find_ear(corner);
            triangles.push([
                self.previous[usize::from(ear)],
                ear,
                self.next[usize::from(ear)],
            ]);
            corner = self.cut_off(ear);
        }
        triangles.push([
            self.previous[usize::from(corner)],
            corner,
            self.next[usize::from(corner)],
        ]);
    }

    /// The first ear from a corner on; where there is none, the first corner without area,
    /// else the first convex one, else the first.
    fn find_ear(&mut self, from: u16) -> u16 {
        let (mut flat, mut convex) = (None, None);
        let mut corner = from;
        for _ in 0..self.left {
            let area = self.area(corner);
            if area > 0.0 {
                if self.is_empty(corner) {
                    return corner;
                }
                convex = convex.or(Some(corner));
            } else if area == 0.0 {
                flat = flat.or(Some(corner));
            }
            corner = self.next[usize::from(corner)];
        }
        flat.or(convex).unwrap_or(from)
    }

    /// Removes a corner; the one after it.
    fn cut_off(&mut self, corner: u16) -> u16 {
        let (before, after) = (
            self.previous[usize::from(corner)],
            self.next[usize::from(corner)],
        );
        self.next[usize::from(before)] = after;
        self.previous[usize::from(after)] = before;
        // Marks it as gone: no other corner is its own neighbour.
        self.next[usize::from(corner)] = corner;
        self.cleared[usize::from(before)] = 0;
        self.cleared[usize::from(after)] = 0;
        self.left -= 1;
        after
    }

    fn area(&self, corner: u16) -> f64 {
        let (before, after) = (
            self.previous[usize::from(corner)],
            self.next[usize::from(corner)],
        );
        doubled_area(self.flat, before, corner, after)
    }

    /// Whether no other corner that is left lies in the triangle of a convex corner or on its
    /// border. One at the same place as a corner of the triangle does not count: a
    /// polygon with a hole returns to where it was.
    fn is_empty(&mut self, corner: u16) -> bool {
        let (before, after) = (
            self.previous[usize::from(corner)],
            self.next[usize::from(corner)],
        );
        let triangle = [before, corner, after];
        let places = triangle.map(|i| self.flat[usize::from(i)]);
        while let Some(&place) = self
            .flat
            .get(usize::from(self.cleared[usize::from(corner)]))
        {
            let other = self.cleared[usize::from(corner)];
            let gone = self.next[usize::from(other)] == other;
            let inside = || {
                [(before, corner), (corner, after), (after, before)]
                    .into_iter()
                    .all(|(a, b)| doubled_area(self.flat, a, b, other) >= 0.0)
            };
            if !gone && !places.contains(&place) && inside() {
                return false;
            }
            self.cleared[usize::from(corner)] += 1;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(flat: &[Flat]) -> Vec<[u16; 3]> {
        let mut triangles = Vec::new();
        cut_into_triangles(flat, &mut triangles);
        triangles
    }

    fn areas(flat: &[Flat]) -> Vec<f64> {
        triangles(flat)
            .iter()
            .map(|&[a, b, c]| doubled_area(flat, a, b, c))
            .collect()
    }

    #[test]
    fn a_quad_is_cut_along_the_diagonal_that_lies_in_it() {
        let convex = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(triangles(&convex), [[0, 1, 2], [0, 2, 3]]);
        for turn in 0..4 {
            let mut dart = [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]];
            dart.rotate_left(turn);
            assert!(areas(&dart).iter().all(|&area| area > 0.0), "{turn}");
        }
    }

    #[test]
    fn a_quad_is_a_fan_if_it_is_one_as_it_is_seen() {
        // Few coordinates, so that corners fall together, on lines and in planes of all axes.
        let places = [-1.0, 0.0, 1.0, 2.5];
        let mut state = 1_u32;
        let mut place = || {
            let mut coordinate = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                places[(state >> 30) as usize]
            };
            Point::new(coordinate(), coordinate(), coordinate())
        };
        let (mut fans, mut others, mut flat) = (0, 0, Vec::new());
        for _ in 0..100_000 {
            let quad = [place(), place(), place(), place()];
            flatten(&[0, 1, 2, 3], &quad, &mut flat);
            assert_eq!(quad_is_fan(quad), is_fan(&flat), "{quad:?}");
            *(if is_fan(&flat) {
                &mut fans
            } else {
                &mut others
            }) += 1;
        }
        assert!(fans > 10_000 && others > 10_000, "{fans} and {others}");
    }

    #[test]
    fn shapes_without_ears_still_give_two_triangles_less_than_corners() {
        let line: Vec<Flat> = (0..9).map(|i| [f64::from(i), 0.0]).collect();
        let point = vec![[1.0, 1.0]; 7];
        let eight = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let huge = vec![
            [1e75, -1e75],
            [-1e75, 1e75],
            [1e75, 1e75],
            [-1e75, -1e75],
            [0.0, 1e-300],
        ];
        for flat in [line, point, eight, huge] {
            assert_eq!(triangles(&flat).len(), flat.len() - 2);
        }
    }

    #[test]
    fn a_comb_is_cut_without_overlap() {
        // Teeth up and down: every other corner is reflex, and a fan would not do.
        let teeth = 100;
        let mut comb = vec![[0.0, -10.0], [f64::from(teeth), -10.0]];
        for i in (0..=2 * teeth).rev() {
            comb.push([f64::from(i) / 2.0, if i % 2 == 0 { 5.0 } else { 0.0 }]);
        }
        let total: f64 = (0..comb.len())
            .map(|i| {
                let (a, b) = (comb[i], comb[(i + 1) % comb.len()]);
                a[0] * b[1] - a[1] * b[0]
            })
            .sum();
        let areas = areas(&comb);
        assert!(areas.iter().all(|&area| area >= 0.0));
        assert_eq!(areas.iter().sum::<f64>(), total);
    }
}

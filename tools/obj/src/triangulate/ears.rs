//! Ears and diagonals of one polygon.
//!
//! A polygon is looked at along its Newell normal, more exactly along the axis nearest to
//! it: dropping a coordinate is exact, where a rotation would round. Ears are corners whose triangle
//! faces the viewer and holds no other corner; which way a triangle faces is found without rounding
//! (Shewchuk 1997), as one sign that contradicts another would make faces overlap.
//!
//! A polygon that crosses itself, or has no area, runs out of ears; then the least bad corner is
//! cut off instead.
//!
//! O(n²): a corner remembers which corner was found in its triangle, and is tested again
//! only when that one is gone, or its triangle has changed, which happens twice for each ear.

use std::collections::BTreeMap;

use robust::{Coord, orient2d};
use tearmesh::{Point, Vector};

/// A point of a polygon as it is seen.
type Flat = Coord<f64>;

/// Projects a polygon along an axis so that its area is positive.
pub(super) fn flatten(places: &[Point]) -> Vec<Flat> {
    // Seen from the first corner, large coordinates of a small face do not cancel digits.
    let sides = places.windows(2).skip(1);
    let normals = sides.map(|side| (side[0] - places[0]).cross(&(side[1] - places[0])));
    let normal = normals.fold(Vector::zeros(), |sum, normal| sum + normal);
    let axis = largest(normal);
    let [mut x, mut y] = [[1, 2], [2, 0], [0, 1]][axis];
    if normal[axis] < 0.0 {
        (x, y) = (y, x);
    }
    let seen = |place: &Point| Coord {
        x: place[x],
        y: place[y],
    };
    places.iter().map(seen).collect()
}

/// Whether triangles of a polygon face one way, as it is seen. None of them is thin, so that the
/// sign of an area is sure.
#[inline]
pub(super) fn faces_viewer(triangles: impl Iterator<Item = [Point; 3]> + Clone) -> bool {
    let mut normals = triangles.map(|[a, b, c]| (b - a).cross(&(c - a)));
    let axis = largest(
        normals
            .clone()
            .fold(Vector::zeros(), |sum, normal| sum + normal),
    );
    let first = normals.next().map_or(0.0, |normal| normal[axis]);
    normals.all(|normal| normal[axis] * first > 0.0)
}

/// The axis nearest to a normal.
#[inline]
pub(super) fn largest(normal: Vector) -> usize {
    let [x, y, z] = [normal.x.abs(), normal.y.abs(), normal.z.abs()];
    match () {
        () if z >= x && z >= y => 2,
        () if y >= x => 1,
        () => 0,
    }
}

/// Which way a triangle of points of the polygon faces: the sign of its area.
fn area(flat: &[Flat], [a, b, c]: [u16; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|corner| flat[usize::from(corner)]);
    orient2d(a, b, c)
}

/// Whether triangles of a polygon all face the viewer.
pub(super) fn is_simple(places: &[Point], triangles: &[[u16; 3]]) -> bool {
    let flat = flatten(places);
    triangles
        .iter()
        .all(|&triangle| area(&flat, triangle) > 0.0)
}

/// Flips diagonals as long as the smallest angle of their two triangles gets larger.
///
/// It ends: with each flip the angles, sorted, come later in the order of words, and triangulations
/// are finitely many.
pub(super) fn enlarge_angles(
    flat: &[Flat],
    angle: impl Fn([u16; 3]) -> f64,
    triangles: &mut [[u16; 3]],
) {
    let sides = |[a, b, c]: [u16; 3]| [[a, b], [b, c], [c, a]];
    let mut sides_of: BTreeMap<[u16; 2], usize> = BTreeMap::new();
    for (number, &triangle) in triangles.iter().enumerate() {
        sides_of.extend(sides(triangle).map(|side| (side, number)));
    }
    let mut open: Vec<[u16; 2]> = sides_of.keys().copied().collect();
    while let Some([i, j]) = open.pop() {
        let (Some(&one), Some(&other)) = (sides_of.get(&[i, j]), sides_of.get(&[j, i])) else {
            continue;
        };
        let third = |triangle: [u16; 3]| triangle.into_iter().find(|&k| k != i && k != j);
        let (Some(k), Some(l)) = (third(triangles[one]), third(triangles[other])) else {
            continue;
        };
        let flipped = [[l, j, k], [k, i, l]];
        let least = |[one, other]: [[u16; 3]; 2]| angle(one).min(angle(other));
        let are_inside = flipped.iter().all(|&triangle| area(flat, triangle) > 0.0);
        if are_inside && least(flipped) > least([triangles[one], triangles[other]]) {
            for (number, triangle) in [one, other].into_iter().zip(flipped) {
                triangles[number] = triangle;
                sides_of.extend(sides(triangle).map(|side| (side, number)));
                open.extend(sides(triangle));
            }
            sides_of.remove(&[i, j]);
            sides_of.remove(&[j, i]);
        }
    }
}

/// A polygon from which ears are cut off.
pub(super) struct Clipper<'p> {
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
    pub(super) fn new(flat: &'p [Flat]) -> Self {
        let count = flat.len() as u16;
        Clipper {
            flat,
            next: (0..count).map(|i| (i + 1) % count).collect(),
            previous: (0..count).map(|i| (i + count - 1) % count).collect(),
            left: flat.len(),
            cleared: vec![0; flat.len()],
        }
    }

    /// Cuts the polygon of n ≥ 3 points into n − 2 triangles.
    pub(super) fn clip(mut self, triangles: &mut Vec<[u16; 3]>) {
        triangles.clear();
        let mut corner = 1;
        while self.left > 3 {
            let ear = self.find_ear(corner);
            triangles.push(self.triangle(ear));
            corner = self.cut_off(ear);
        }
        triangles.push(self.triangle(corner));
    }

    /// The first ear from a corner on; where there is none, the first corner without area,
    /// else the first convex one, else the first.
    fn find_ear(&mut self, from: u16) -> u16 {
        let (mut flat, mut convex) = (None, None);
        let mut corner = from;
        for _ in 0..self.left {
            let area = area(self.flat, self.triangle(corner));
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
        let [before, _, after] = self.triangle(corner);
        self.next[usize::from(before)] = after;
        self.previous[usize::from(after)] = before;
        // Marks it as gone: no other corner is its own neighbour.
        self.next[usize::from(corner)] = corner;
        self.cleared[usize::from(before)] = 0;
        self.cleared[usize::from(after)] = 0;
        self.left -= 1;
        after
    }

    /// A corner between its neighbours.
    fn triangle(&self, corner: u16) -> [u16; 3] {
        let at = usize::from(corner);
        [self.previous[at], corner, self.next[at]]
    }

    /// Whether no other corner that is left lies in the triangle of a convex corner or on its
    /// border. One at the same place as a corner of the triangle does not count: a
    /// polygon with a hole returns to where it was.
    fn is_empty(&mut self, corner: u16) -> bool {
        let [before, _, after] = self.triangle(corner);
        let places = [before, corner, after].map(|i| self.flat[usize::from(i)]);
        while let Some(&place) = self
            .flat
            .get(usize::from(self.cleared[usize::from(corner)]))
        {
            let other = self.cleared[usize::from(corner)];
            let gone = self.next[usize::from(other)] == other;
            let inside = || {
                [(before, corner), (corner, after), (after, before)]
                    .into_iter()
                    .all(|(a, b)| area(self.flat, [a, b, other]) >= 0.0)
            };
            if !gone && !places.contains(&place) && inside() {
                return false;
            }
            self.cleared[usize::from(corner)] += 1;
        }
        true
    }
}

//! Where the vertices are, moment by moment.
//!
//! Those of the first moment are 32-bit floats, from 0 to 1 along the longest side of the box: all first
//! bytes, then all second ones, and so on, since bytes of one kind are alike and pack well. Those of the
//! moments after it are points of a lattice of 65,536 steps, and only how far each is off from a guess is
//! written: the point before, or that and the last step again; and from either, how far the guess for a
//! neighbour was off may be taken. Each moment is written by the guess that suits it best, which a byte
//! says. What is left is folded as in [`super::codec`], and of all moments the lowest bytes come first, then
//! the middle and the highest.

use tearmesh::Point;
use tearmesh::geometry::max_abs;

use super::codec::folded;
use crate::bounds::Bounds;

/// The steps of the lattice along the longest side of the box.
const STEPS: f64 = 65536.0;

/// The lattice of the places of a page.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    pub(super) origin: Point,
    pub(super) side: f64,
}

impl Lattice {
    /// The lattice of a box.
    pub(super) fn round(bounds: &Bounds) -> Lattice {
        let side = max_abs(bounds.most - bounds.least);
        Lattice {
            origin: bounds.least,
            // What is a point has no side, and any will do.
            side: if side > 0.0 { side } else { 1.0 },
        }
    }

    /// From 0 to 1 in the box.
    fn part(&self, p: Point) -> [f64; 3] {
        let from = (p - self.origin) / self.side;
        [from.x, from.y, from.z]
    }
}

/// The nearest point of the lattice.
fn steps(part: [f64; 3]) -> [i32; 3] {
    part.map(|x| (x * STEPS).round() as i32)
}

/// Whether a guess takes the last step again.
const GOES_ON: u8 = 1;
/// Whether it goes by the neighbour.
const AS_NEIGHBOUR: u8 = 2;

/// Writes moments: the points of all vertices, and the corners of the faces.
pub(super) fn write<'m>(
    moments: impl Iterator<Item = (&'m [Point], &'m [u32])>,
    lattice: &Lattice,
) -> Vec<u8> {
    let mut first = Vec::new();
    let (mut guesses, mut left) = (Vec::new(), Vec::new());
    let mut track = Track::default();
    for (number, (points, corners)) in moments.enumerate() {
        let neighbours = neighbours(corners, points.len());
        let is_shown = shown(corners, points.len());
        // Where a vertex is that no face has is told by nobody, and must not cost anything.
        let places = points.iter().zip(&is_shown);
        let places = places.map(|(&p, &is_shown)| if is_shown { p } else { lattice.origin });
        let parts: Vec<[f64; 3]> = places.map(|p| lattice.part(p)).collect();
        if number == 0 {
            let parts: Vec<[f32; 3]> = parts.iter().map(|part| part.map(|x| x as f32)).collect();
            first = floats(&parts);
            // Whoever reads them begins with what they were rounded to.
            let now = parts.iter().map(|part| steps(part.map(f64::from)));
            track.go_on(now.collect(), &neighbours);
            continue;
        }
        let now: Vec<[i32; 3]> = parts.into_iter().map(steps).collect();
        let tried = [0, GOES_ON, AS_NEIGHBOUR, GOES_ON | AS_NEIGHBOUR];
        let tried = tried.map(|guess| (track.off(guess, &now, &neighbours), guess));
        let [head, rest @ ..] = tried;
        let best =
            rest.into_iter()
                .fold(head, |best, other| match cost(&other.0) < cost(&best.0) {
                    true => other,
                    false => best,
                });
        guesses.push(best.1);
        left.extend(best.0);
        track.go_on(now, &neighbours);
    }
    let planes = [0, 8, 16].map(|shift| left.iter().map(move |&x| (x >> shift) as u8));
    let mut bytes = first;
    bytes.extend(guesses);
    bytes.extend(planes.into_iter().flatten());
    bytes
}

/// Numbers from 0 to 1 as 32-bit floats: their first bytes, each axis by itself, and so on.
fn floats(parts: &[[f32; 3]]) -> Vec<u8> {
    let axes = (0..3).flat_map(|axis| parts.iter().map(move |part| part[axis]));
    let all: Vec<[u8; 4]> = axes.map(f32::to_le_bytes).collect();
    (0..4)
        .flat_map(|byte| all.iter().map(move |float| float[byte]))
        .collect()
}

/// Whether any face has each vertex.
fn shown(corners: &[u32], vertices: usize) -> Vec<bool> {
    let mut shown = vec![false; vertices];
    for &v in corners {
        shown[v as usize] = true;
    }
    shown
}

/// Of each vertex, a vertex with a smaller number that shares an edge with it: the first that the faces
/// name. None has itself.
fn neighbours(corners: &[u32], vertices: usize) -> Vec<u32> {
    let mut neighbours: Vec<u32> = (0..vertices as u32).collect();
    for face in corners.as_chunks::<3>().0 {
        for i in 0..3 {
            for other in [face[(i + 1) % 3], face[(i + 2) % 3]] {
                let v = face[i];
                if other < v && neighbours[v as usize] == v {
                    neighbours[v as usize] = other;
                }
            }
        }
    }
    neighbours
}

/// Where the vertices were, and how far they went to get there.
#[derive(Default)]
struct Track {
    places: Vec<[i32; 3]>,
    steps: Vec<[i32; 3]>,
}

impl Track {
    /// How far a guess is off, folded: of all vertices along one axis, then along the next.
    fn off(&self, guess: u8, now: &[[i32; 3]], neighbours: &[u32]) -> Vec<u32> {
        let mut left = Vec::with_capacity(3 * now.len());
        for axis in 0..3 {
            let plain = |v: usize| {
                let was = self.places.get(v).map(|place| {
                    let step = if guess & GOES_ON != 0 {
                        self.steps[v][axis]
                    } else {
                        0
                    };
                    place[axis] + step
                });
                was.map(|was| now[v][axis] - was)
            };
            for (v, &neighbour) in neighbours.iter().enumerate() {
                let (beside, has_neighbour) = (neighbour as usize, neighbour as usize != v);
                let off = match plain(v) {
                    Some(off) if guess & AS_NEIGHBOUR != 0 && has_neighbour => {
                        off - plain(beside).unwrap_or(0)
                    }
                    Some(off) => off,
                    // Born now, and hardly far from its neighbour.
                    None if has_neighbour => now[v][axis] - now[beside][axis],
                    None => now[v][axis],
                };
                left.push(folded(i64::from(off)) as u32);
            }
        }
        left
    }

    /// Notes where they are; who is new goes as its neighbour does.
    fn go_on(&mut self, now: Vec<[i32; 3]>, neighbours: &[u32]) {
        let mut steps: Vec<[i32; 3]> = Vec::with_capacity(now.len());
        for (v, place) in now.iter().enumerate() {
            steps.push(match self.places.get(v) {
                Some(was) => [0, 1, 2].map(|axis| place[axis] - was[axis]),
                None => steps
                    .get(neighbours[v] as usize)
                    .copied()
                    .unwrap_or_default(),
            });
        }
        (self.places, self.steps) = (now, steps);
    }
}

/// About how many bits numbers take.
fn cost(left: &[u32]) -> u64 {
    let bits = |&x: &u32| u64::from(u32::BITS - x.leading_zeros());
    left.iter().map(bits).sum()
}

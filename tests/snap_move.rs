//! Cuts that slide vertices onto their plane: no face gets thinner than the snap allows, a flat sheet keeps its area,
//! and the vertices end up on the plane.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::sync::LazyLock;

use tearmesh::{CutMethod, Edit, Mesh, Plane, Point, Scissor, Vector, VertexId, shapes};

use crate::cases::cases;
use crate::oracle::straight::Surface;
use crate::random::Random;
use crate::surfaces::{built, jittered, surface, surfaces};
use crate::work::{Work, area, between};

const SNAPS: [f64; 6] = [0.02, Scissor::SNAP, 0.1, 0.2, 0.3, 0.49];

/// A flat sheet, by chance: a square, random triangles, a disk, or a square with holes and notches.
fn flat(random: &mut Random) -> Surface {
    let n = 2 + random.below(5) as u32;
    let square = |random: &mut Random| {
        let rises = |_, _| random.next() < 0.5;
        surface(&shapes::grid_with_diagonals(n, n, rises))
    };
    match random.below(4) {
        0 => square(random),
        1 => {
            let mut sheet = jittered(n, random);
            sheet.points.iter_mut().for_each(|p| p[2] = 0.0);
            sheet
        }
        2 => disk(n, 3 + random.below(12) as u32),
        _ => loop {
            let mut sheet = square(random);
            sheet.faces.retain(|_| random.next() < 0.8);
            if Mesh::build(sheet.points.len(), &sheet.faces).is_ok() && !sheet.faces.is_empty() {
                return sheet;
            }
        },
    }
}

/// Rings of triangles round a point.
fn disk(rings: u32, around: u32) -> Surface {
    let (mut points, mut faces) = (vec![[0.5, 0.5, 0.0]], Vec::new());
    let at = |ring: u32, i: u32| match ring {
        0 => 0,
        _ => 1 + (ring - 1) * around + i % around,
    };
    for ring in 1..=rings {
        for i in 0..around {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(around)).sin_cos();
            let radius = 0.5 * f64::from(ring) / f64::from(rings);
            points.push([0.5 + radius * cos, 0.5 + radius * sin, 0.0]);
            let [a, b] = [0, 1].map(|j| at(ring - 1, i + j));
            let [c, d] = [0, 1].map(|j| at(ring, i + j));
            faces.push([a, c, d]);
            if ring > 1 {
                faces.push([a, d, b]);
            }
        }
    }
    Surface { points, faces }
}

/// Turns a sheet in its plane, and shrinks, stretches and moves it.
fn placed(mut sheet: Surface, random: &mut Random) -> Surface {
    let (sin, cos) = (TAU * random.next()).sin_cos();
    let [wide, high] = [(); 2].map(|()| [1.0, 0.2, 3.0][random.below(3)]);
    let shift = [0.0, 1.0, 1e4][random.below(3)];
    let turned = random.below(2) == 0;
    for [x, y, _] in &mut sheet.points {
        let [a, b] = [wide * *x, high * *y];
        [*x, *y] = if turned {
            [cos * a - sin * b, sin * a + cos * b]
        } else {
            [a, b]
        };
        [*x, *y] = [*x + shift, *y - shift];
    }
    sheet
}

/// A sheet before and after a cut that may slide vertices.
struct Case {
    name: String,
    /// Two points on the line of the cut, seen from above.
    ends: [[f64; 2]; 2],
    snap: f64,
    is_flat: bool,
    before: Work,
    after: Work,
    /// The vertices that slid.
    slid: BTreeSet<VertexId>,
}

impl Case {
    /// A sheet of any kind, one time in three cut before, and a cut between two points of it.
    fn of_seed(seed: u64, all: &[(&'static str, Surface)]) -> Option<Case> {
        let mut random = Random(seed);
        let is_flat = !seed.is_multiple_of(3);
        let sheet = match is_flat {
            true => flat(&mut random),
            false => all[random.below(all.len())].1.clone(),
        };
        let sheet = placed(sheet, &mut random);
        let mut ends = || [(); 2].map(|()| somewhere(&sheet, &mut random));
        let [first, ends] = [(); 2].map(|()| ends());
        if first[0] == first[1] || ends[0] == ends[1] {
            return None;
        }
        let mut before = Work::new(built(&sheet));
        if random.below(3) == 0 {
            before.cut(CutMethod::Exact, &between(first[0], first[1]));
            before.edits.clear();
        }
        let through = random.below(2) == 0;
        let snap = SNAPS[random.below(SNAPS.len())];
        let scissor = between(ends[0], ends[1])
            .with_through(through)
            .with_snap(snap);
        let mut after = before.clone();
        after.cut(CutMethod::Exact, &scissor.with_snap_move(true));
        let slid = after.edits.iter().filter_map(|edit| match edit {
            Edit::Slide(slide) => Some(slide.vertex),
            _ => None,
        });
        Some(Case {
            name: format!("seed {seed}, snap {snap}, {ends:?}, through: {through}"),
            slid: slid.collect(),
            ends,
            snap,
            is_flat,
            before,
            after,
        })
    }
}

/// A point on the way between two vertices of a sheet, seen from above.
fn somewhere(sheet: &Surface, random: &mut Random) -> [f64; 2] {
    let [p, q] = [(); 2].map(|()| sheet.points[random.below(sheet.points.len())]);
    let t = random.next();
    [0, 1].map(|axis| p[axis] + t * (q[axis] - p[axis]))
}

/// The cases in which something slid.
fn slides() -> &'static [Case] {
    static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
        let all = surfaces();
        let made = (0..cases()).filter_map(|seed| Case::of_seed(seed, &all));
        let cases: Vec<Case> = made.filter(|case| !case.slid.is_empty()).collect();
        println!("{} cuts slid vertices", cases.len());
        cases
    });
    &CASES
}

/// All vertices of a face that slide, and the points that are inserted in it, count together. The parent of each
/// face follows from the log, and the altitudes from the positions.
#[test]
fn no_face_gets_thinner_than_the_snap_allows() {
    for case in slides() {
        let kept = case.after.kept(&case.before.altitudes()).into_iter();
        let least = kept.fold(f64::INFINITY, f64::min);
        let bound = case.snap * (1.0 - case.snap);
        assert!(
            least >= bound * (1.0 - 1e-9),
            "{}: {least} of the altitude, and not {bound}",
            case.name
        );
    }
}

#[test]
fn a_flat_sheet_keeps_its_area() {
    let flat = || slides().iter().filter(|case| case.is_flat);
    for case in flat() {
        let [was, is] = [&case.before, &case.after].map(|work| area(&work.mesh, &work.positions));
        let largest = |p: &Point| p.coords.amax();
        let points = case.before.positions.as_slice();
        let largest = points.iter().map(largest).fold(1.0, f64::max);
        let off = (is - was).abs();
        assert!(off <= 1e-12 * largest, "{}: {was} became {is}", case.name);
    }
    // Along straight boundaries vertices do slide.
    let is_on_boundary = |work: &Work, v: VertexId| {
        let mut corners = work.mesh.corners_of(v);
        corners.any(|h| work.mesh.pair(h).is_none() || work.mesh.pair(h.prev()).is_none())
    };
    let of_boundary = |case: &Case| {
        let slid = case.slid.iter();
        slid.filter(|&&v| is_on_boundary(&case.before, v)).count()
    };
    let count: usize = flat().map(of_boundary).sum();
    assert!(count as u64 > cases() / 20, "{count}");
}

#[test]
fn what_slides_comes_onto_the_plane() {
    for case in slides() {
        let [p, q] = case.ends;
        let along = [q[0] - p[0], q[1] - p[1]];
        for &v in &case.slid {
            let at = case.after.positions.at(v);
            let across = (at.x - p[0]) * along[1] - (at.y - p[1]) * along[0];
            let far = across.abs() / along[0].hypot(along[1]);
            let bound = 1e-13 * at.coords.amax().max(1.0);
            assert!(far <= bound, "{}: {v} is {far} off", case.name);
        }
    }
}

/// The line passes near a corner of the sheet, which counts as on the plane.
#[test]
fn regression_a_corner_of_a_sheet_stays() {
    let mut sheet = surface(&shapes::grid(8, 8));
    sheet.points.iter_mut().flatten().for_each(|x| *x *= 8.0);
    let mut work = Work::of(&sheet);
    let plane = Plane::new(
        Point::new(3.663, 2.558, 0.0),
        Vector::new(0.589, 0.398, 0.0),
    );
    let scissor = Scissor::by_plane(plane.expect("a plane")).with_snap_move(true);
    work.cut(CutMethod::Exact, &scissor);
    let area = area(&work.mesh, &work.positions);
    assert!((area - 64.0).abs() < 1e-12, "{area}");
}

//! How much of the sky a surface sees: where folds shade each other, and the shadow below.
//!
//! The sky is seen from some dozens of directions in turn. From each, a map of depths tells what lies
//! behind something else. All is + − × ÷ √, so the shade is the same on every machine.

use tearmesh::geometry::{cross, dot, length};
use tearmesh::{Point, Vector};

use crate::camera::{aside, unit};
use crate::figure::Figure;

/// The side of a map of depths, in texels.
const TEXELS: usize = 256;

/// How far from the surface it is asked what the surface sees, in texels: a point of a slanted face has to
/// be in front of what the face itself has in the texels around it.
const OFFSET: f64 = 1.5;

/// From how many faces on fewer directions have to do.
const MANY_FACES: usize = 1 << 17;

/// The side of the ground for which its shade is known, as a part of the radius of the figure; in cells,
/// and how far the ground is below.
const GROUND: f64 = 5.0;
const CELLS: usize = 128;
const BELOW: f64 = 0.02;

/// How many cells are averaged on each side to blur the shade of the ground, and how often.
const BLUR: usize = 4;
const BLURS: u32 = 3;

/// The parts of the sky that the points of a figure see, from 0 to 1.
#[derive(Clone, Debug)]
pub(crate) struct Sky {
    /// Of each point, on the front and on the back.
    pub(crate) seen: Vec<[f64; 2]>,
    pub(crate) ground: Option<Ground>,
}

/// A level ground below a figure, and how much of the sky it sees.
#[derive(Clone, Debug)]
pub(crate) struct Ground {
    /// The middle of the part whose shade is known, and half of its sides.
    pub(crate) middle: Point,
    pub(crate) sides: [Vector; 2],
    up: Vector,
    /// Row by row.
    cells: Vec<f64>,
}

impl Sky {
    /// What a figure leaves of the sky, with a ground if there is an upward direction.
    pub(crate) fn new(figure: &Figure, up: Option<Vector>) -> Sky {
        let Some((middle, radius)) = sphere(figure) else {
            let seen = vec![[1.0; 2]; figure.points.len()];
            return Sky { seen, ground: None };
        };
        let up = up.and_then(unit);
        let mut ground = up.map(|up| Ground::below(figure, middle, radius, up));
        let points = figure.points.iter().map(|p| (p - middle) / radius);
        let points: Vec<Vector> = points.collect();
        let mut seen = vec![[[0.0; 2]; 2]; points.len()];
        let mut cells = vec![[0.0; 2]; CELLS * CELLS];
        let cell_points = ground.iter().flat_map(|ground| {
            let place = |cell: usize| (ground.cell(cell) - middle) / radius;
            (0..CELLS * CELLS).map(place)
        });
        let cell_points: Vec<Vector> = cell_points.collect();
        let has_many = figure.faces.len() >= MANY_FACES;
        let mut map = DepthMap::default();
        for (towards, weight) in directions(if has_many { 2 } else { 4 }) {
            map.look(&points, &figure.faces, towards);
            for ((&p, &normal), seen) in points.iter().zip(&figure.normals).zip(&mut seen) {
                let cosine = dot(normal, towards);
                let (side, sign) = if cosine < 0.0 { (1, -1.0) } else { (0, 1.0) };
                let part = weight * cosine.abs();
                let from = p + normal * (sign * OFFSET * map.texel());
                let [is, could]: &mut [f64; 2] = &mut seen[side];
                *could += part;
                *is += part * map.free(from);
            }
            if let Some(ground) = ground
                .as_ref()
                .filter(|ground| dot(ground.up, towards) > 0.0)
            {
                // Once for the slope, and once for a sky that is brighter overhead.
                let cosine = dot(ground.up, towards);
                let part = weight * cosine * cosine;
                for (&p, [is, could]) in cell_points.iter().zip(&mut cells) {
                    *could += part;
                    *is += part * map.free(p);
                }
            }
        }
        let part = |[is, could]: [f64; 2]| if could > 0.0 { is / could } else { 1.0 };
        if let Some(ground) = &mut ground {
            ground.cells = cells.into_iter().map(part).collect();
            ground.soften();
        }
        Sky {
            seen: seen.into_iter().map(|sides| sides.map(part)).collect(),
            ground,
        }
    }
}

impl Ground {
    fn below(figure: &Figure, middle: Point, radius: f64, up: Vector) -> Ground {
        let heights = figure.points.iter().map(|p| dot(p - middle, up));
        let lowest = heights.fold(0.0, f64::min) - BELOW * radius;
        let aside = aside(up) - up * dot(aside(up), up);
        let aside = unit(aside).expect("it is not along `up`");
        Ground {
            middle: middle + up * lowest,
            sides: [aside, cross(up, aside)].map(|side| side * (radius * GROUND / 2.0)),
            up,
            cells: Vec::new(),
        }
    }

    /// Blurs away the borders of the shadow that each direction throws, and of the part that is known.
    fn soften(&mut self) {
        for _ in 0..BLURS {
            for axis in [1, CELLS] {
                let before = self.cells.clone();
                let mean = |cell: usize| {
                    let at = cell / axis % CELLS;
                    let near = at.saturating_sub(BLUR)..=(at + BLUR).min(CELLS - 1);
                    let count = near.clone().count() as f64;
                    let near = near.map(|other| before[cell + other * axis - at * axis]);
                    near.sum::<f64>() / count
                };
                self.cells = (0..before.len()).map(mean).collect();
            }
        }
        for cell in 0..self.cells.len() {
            let [x, y] = parts(cell);
            let near = (1.0 - x * x - y * y).max(0.0);
            self.cells[cell] = 1.0 - (1.0 - self.cells[cell]) * near;
        }
    }

    /// The middle of a cell.
    fn cell(&self, cell: usize) -> Point {
        let ([x, y], [across, down]) = (self.sides, parts(cell));
        self.middle + x * across + y * down
    }

    /// How much of the sky the ground sees where a ray from above meets it; none where it does not.
    pub(crate) fn seen(&self, eye: Point, direction: Vector) -> Option<f64> {
        let height = dot(eye - self.middle, self.up);
        let down = -dot(direction, self.up);
        if !(height > 0.0 && down > 0.0) {
            return None;
        }
        let off = eye + direction * (height / down) - self.middle;
        let [x, y] = self.sides.map(|side| {
            let part = dot(off, side) / dot(side, side);
            (part + 1.0) / 2.0 * CELLS as f64 - 0.5
        });
        let is_known = |x: f64| x >= 0.0 && x < (CELLS - 1) as f64;
        (is_known(x) && is_known(y)).then(|| {
            let (i, j) = (x as usize, y as usize);
            let [right, down] = [x - i as f64, y - j as f64];
            let row = |j: usize| {
                let at = j * CELLS + i;
                self.cells[at] + right * (self.cells[at + 1] - self.cells[at])
            };
            row(j) + down * (row(j + 1) - row(j))
        })
    }
}

/// Where the middle of a cell is, from −1 to 1 along both sides.
fn parts(cell: usize) -> [f64; 2] {
    [cell % CELLS, cell / CELLS].map(|i| (2 * i + 1) as f64 / CELLS as f64 - 1.0)
}

/// The middle of the box around all points, and the distance of the farthest point; none if that is no
/// length.
fn sphere(figure: &Figure) -> Option<(Point, f64)> {
    let bounds = crate::bounds::Bounds::around(figure.points.iter().copied())?;
    let middle = bounds.least + (bounds.most - bounds.least) / 2.0;
    let far = figure.points.iter().map(|p| length(p - middle));
    let radius = far.fold(0.0, f64::max);
    (radius > 0.0 && radius.is_finite()).then_some((middle, radius))
}

/// Directions all around, and the part of the sky of each: the points of an octahedron whose edges are
/// divided in n.
fn directions(n: i32) -> impl Iterator<Item = (Vector, f64)> {
    let across = move || -n..=n;
    let all =
        across().flat_map(move |x| across().flat_map(move |y| across().map(move |z| [x, y, z])));
    let on_it = all.filter(move |p| p.iter().map(|x| x.abs()).sum::<i32>() == n);
    on_it.map(|p| {
        let p = Vector::from(p.map(f64::from));
        let far = length(p);
        (p / far, 1.0 / (far * far * far))
    })
}

/// The depths of a figure within the unit sphere, as seen from far away.
#[derive(Default)]
struct DepthMap {
    axes: [Vector; 3],
    /// The largest way towards the eye in each texel, row by row.
    nearest: Vec<f64>,
}

impl DepthMap {
    /// The side of a texel. There are two around the sphere, for what is just outside of it.
    fn texel(&self) -> f64 {
        2.0 / (TEXELS - 4) as f64
    }

    /// Right and down in texels, and towards the eye.
    fn place(&self, p: Vector) -> [f64; 3] {
        let [right, up, towards] = self.axes.map(|axis| dot(axis, p));
        let texels = |x: f64| x / self.texel() + TEXELS as f64 / 2.0;
        [texels(right), texels(up), towards]
    }

    fn look(&mut self, points: &[Vector], faces: &[[u32; 3]], towards: Vector) {
        let right = unit(cross(aside(towards), towards)).expect("it is not along the view");
        self.axes = [right, cross(towards, right), towards];
        self.nearest.clear();
        self.nearest.resize(TEXELS * TEXELS, f64::NEG_INFINITY);
        let places: Vec<[f64; 3]> = points.iter().map(|&p| self.place(p)).collect();
        for corners in faces {
            self.add(corners.map(|at| places[at as usize]));
        }
    }

    /// Draws a face into all texels whose middle it covers.
    fn add(&mut self, [a, b, c]: [[f64; 3]; 3]) {
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
        let area = u[0] * v[1] - u[1] * v[0];
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let [columns, rows] = [0, 1].map(|i| {
            let least = a[i].min(b[i]).min(c[i]) - 0.5;
            let most = a[i].max(b[i]).max(c[i]) + 0.5;
            least.max(0.0) as usize..(most.max(0.0) as usize).min(TEXELS)
        });
        for row in rows {
            let y = row as f64 + 0.5 - a[1];
            for column in columns.clone() {
                let x = column as f64 + 0.5 - a[0];
                let s = (x * v[1] - y * v[0]) / area;
                let t = (u[0] * y - u[1] * x) / area;
                if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
                    let nearest = &mut self.nearest[row * TEXELS + column];
                    *nearest = nearest.max(a[2] + s * u[2] + t * v[2]);
                }
            }
        }
    }

    /// How much of the eye a point sees: the part of the four texels around it that are not in front of it.
    fn free(&self, p: Vector) -> f64 {
        let [x, y, towards] = self.place(p);
        let end = (TEXELS - 1) as f64;
        let is_inside = |x: f64| x >= 0.5 && x - 0.5 < end;
        if !(is_inside(x) && is_inside(y)) {
            return 1.0;
        }
        let [x, y] = [x - 0.5, y - 0.5];
        let (i, j) = (x as usize, y as usize);
        let [right, down] = [x - i as f64, y - j as f64];
        let is_free = |i: usize, j: usize| f64::from(self.nearest[j * TEXELS + i] <= towards);
        let row = |j: usize| is_free(i, j) * (1.0 - right) + is_free(i + 1, j) * right;
        row(j) * (1.0 - down) + row(j + 1) * down
    }
}

#[cfg(test)]
mod tests {
    use tearmesh::{Mesh, shapes};

    use super::*;

    fn figure(points: Vec<[f64; 3]>, faces: &[[u32; 3]]) -> Figure {
        let mesh = Mesh::build(points.len(), faces).expect("a mesh");
        let points: Vec<Point> = points.into_iter().map(Point::from).collect();
        Figure::new(&mesh, &points[..], -2.0, &[], false)
    }

    /// What a point of a floor sees beside an endless wall of height h, d away: all but the half of
    /// 1 − d/√(d² + h²), by the cosine (Hottel's crossed strings).
    #[test]
    fn a_wall_takes_its_part_of_the_sky() {
        for (far, height) in [(0.3, 1.0), (0.5, 0.5), (0.5, 1.0), (0.2, 0.4)] {
            let wall = [
                [far, -4.0, 0.0],
                [far, 4.0, 0.0],
                [far, 4.0, height],
                [far, -4.0, height],
            ];
            // The floor ends at the wall; its point in question is the first.
            let floor = [[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0]];
            let points = floor.into_iter().chain(wall).collect();
            let figure = figure(points, &[[0, 1, 2], [3, 4, 5], [3, 5, 6]]);
            let at = figure
                .normals
                .iter()
                .position(|n| n.z == 1.0)
                .expect("a floor");
            let [front, back] = Sky::new(&figure, None).seen[at];
            let expected = 1.0 - (1.0 - far / (far * far + height * height).sqrt()) / 2.0;
            assert!(
                (front - expected).abs() < 0.1,
                "{far} {height}: {front} {expected}"
            );
            assert!(back > 0.97, "{back}");
        }
    }

    #[test]
    fn a_flat_sheet_sees_all_of_the_sky_and_a_closed_one_none_inside() {
        let (mesh, positions) = shapes::grid(9, 9);
        let flat = Figure::new(&mesh, &positions, -2.0, &[], false);
        for sides in Sky::new(&flat, None).seen {
            assert!(sides.iter().all(|&part| part == 1.0), "{sides:?}");
        }
        let (mesh, positions) = shapes::torus(48, 24);
        let closed = Figure::new(&mesh, &positions, -2.0, &[], false);
        // Its faces show their fronts to the inside.
        for [inside, outside] in Sky::new(&closed, None).seen {
            assert!(outside > 0.4 && inside < 0.1, "{outside} {inside}");
        }
    }

    #[test]
    fn the_ground_is_dark_below_a_sheet_and_bright_far_away() {
        let points = vec![
            [-1.0, 0.0, -1.0],
            [-1.0, 0.0, 1.0],
            [1.0, 0.0, 1.0],
            [1.0, 0.0, -1.0],
        ];
        let figure = figure(points, &[[0, 1, 2], [0, 2, 3]]);
        let ground = Sky::new(&figure, Some(Vector::y() * 3.0))
            .ground
            .expect("a ground");
        let seen = |x: f64| ground.seen(Point::new(x, 5.0, 0.0), -Vector::y());
        assert!(
            seen(0.0) < Some(0.4) && seen(0.0) >= Some(0.0),
            "{:?}",
            seen(0.0)
        );
        assert!(seen(2.0) > Some(0.8), "{:?}", seen(2.0));
        assert_eq!(seen(9.0), None);
        assert_eq!(ground.seen(Point::new(0.0, 5.0, 0.0), Vector::y()), None);
        assert_eq!(ground.seen(Point::new(0.0, -5.0, 0.0), -Vector::y()), None);
    }

    #[test]
    fn places_that_are_no_lengths_have_all_of_the_sky() {
        for x in [0.0, f64::INFINITY, f64::NAN, f64::MAX] {
            let figure = figure(
                vec![[x, 0.0, 0.0], [x, 0.0, 0.0], [x, 0.0, 0.0]],
                &[[0, 1, 2]],
            );
            let sky = Sky::new(&figure, Some(Vector::y()));
            assert!(sky.seen.iter().flatten().all(|&part| part == 1.0), "{x}");
        }
    }
}

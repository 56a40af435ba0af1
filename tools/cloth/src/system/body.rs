//! A body of triangles as an obstacle: a grid of signed distances to its surface.
//!
//! Nodes within [`BAND`] cells of the surface have their exact distance, negative inside; between nodes it is
//! trilinear. All others have the distance of the band, which is a lower bound. A look costs eight numbers,
//! however many faces the body has.
//!
//! Which nodes are inside is decided along lines of nodes: the faces that a line crosses before it comes to the
//! node are counted, those that lead in less those that lead out. Holes are closed by fans before that, as a
//! line that leaves by one counts nothing. A node that differs from a neighbour by more than they are
//! apart is on the wrong side, and would be a pit that swallows cloth: such a body is refused.
//!
//! The grid measures its own error in the middle of each cell at the surface, where it is largest as a rule: a
//! sharp edge or a narrow gap is rounded by a part of a cell. Cloth that is kept farther away than that
//! never reaches the surface.

use std::collections::BTreeMap;
use std::fmt;

use tearmesh::DisjointSets;
use tearmesh::geometry::{Point, Vector, check_point, cross, dot, length};

use crate::digest;

/// The cells within which distances are exact, on both sides of the surface.
const BAND: f64 = 3.0;

/// Up to how far from the surface the error is measured, in cells.
const MEASURED: f64 = 1.5;

/// The largest number of nodes: 64 MB.
const NODES_MAX: f64 = 16_777_216.0;

/// The cells along the longest side of a body, by default.
const CELLS: f64 = 160.0;

/// One edge in so many may be open.
const OPEN_SHARE: usize = 40;

/// Where node 0 lies before the corner of the band, in cells: so that no line of nodes meets the vertices of a
/// body with round coordinates.
const OFFSETS: [f64; 3] = [0.381_966, 0.267_949, 0.414_214];

/// A solid body with a surface of triangles, as the shape of a [`Collider`](crate::Collider).
///
/// ```
/// use std::sync::Arc;
/// use tearmesh::Point;
/// use tearmesh_cloth::{Body, Collider};
///
/// let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from);
/// let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let body = Body::new(&points, &faces, Some(0.05))?;
/// assert!((body.distance_m(Point::new(0.2, 0.2, -0.1)) - 0.1).abs() < 1e-6);
/// assert!((body.distance_m(Point::new(0.2, 0.2, 0.03)) + 0.03).abs() < 1e-6);
/// let surface = Collider::body(Arc::new(body)).with_friction(0.3);
/// # Ok::<(), tearmesh_cloth::BodyError>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct Body {
    name: Option<String>,
    points: Vec<Point>,
    /// Anticlockwise as seen from outside.
    faces: Vec<[u32; 3]>,
    grid: Grid,
    distances: Vec<f32>,
    error_rms_m: f64,
    error_worst_m: f64,
}

impl Body {
    /// Creates a body from its points in metres and its faces, three points each, all of them anticlockwise or
    /// all clockwise as seen from outside. `cell_m` is the distance of nodes; by default the longest side of
    /// the body has 160. Takes a time by the area of the surface in cells, and a pass over all nodes.
    ///
    /// # Errors
    ///
    /// [`BodyError`] if the body has no volume, is open, or does not fit into memory, or a number cannot be used.
    pub fn new(
        points: &[Point],
        faces: &[[u32; 3]],
        cell_m: Option<f64>,
    ) -> Result<Body, BodyError> {
        let is_point = |&v: &u32| {
            points
                .get(v as usize)
                .is_some_and(|&at| check_point(at).is_ok())
        };
        if let Some(face) = faces.iter().position(|face| !face.iter().all(is_point)) {
            return Err(BodyError::Face { face });
        }
        let mut surface = Surface {
            points: points.to_vec(),
            faces: faces.to_vec(),
        };
        surface.close()?;
        surface.turn_outward()?;
        let grid = Grid::around(&surface, cell_m)?;
        let mut distances = grid.distances(&surface, BAND);
        grid.sign(&surface, &mut distances)?;
        let mut body = Body {
            name: None,
            points: points.to_vec(),
            faces: surface.faces[..faces.len()].to_vec(),
            grid,
            distances,
            error_rms_m: 0.0,
            error_worst_m: 0.0,
        };
        body.measure(&surface);
        Ok(body)
    }

    /// Names the body, for warnings.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Body {
        Body {
            name: Some(name.into()),
            ..self
        }
    }

    /// Returns the name of the body, if it has one: in a scene that of its file.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Returns the distance of a point from the surface in metres, as the grid has it: negative inside. Beyond
    /// three cells of the surface it is a bound: the point is at least so far away.
    #[must_use]
    pub fn distance_m(&self, x: Point) -> f64 {
        match self.grid.place(x) {
            Some(Place { node, part }) => between(self.corners(node), part),
            None => BAND * self.grid.cell_m + self.grid.away(x),
        }
    }

    /// Returns the points of the body, as they were given.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Returns the faces of the body, anticlockwise as seen from outside.
    #[must_use]
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Returns the distance of nodes, in metres.
    #[must_use]
    pub fn cell_m(&self) -> f64 {
        self.grid.cell_m
    }

    /// Returns the root mean square of the error of the grid at the surface, in metres.
    #[must_use]
    pub fn error_rms_m(&self) -> f64 {
        self.error_rms_m
    }

    /// Returns the largest error of the grid at the surface, in metres: the least thickness with which cloth stays
    /// outside.
    #[must_use]
    pub fn error_worst_m(&self) -> f64 {
        self.error_worst_m
    }

    /// The corners of a box around the body.
    pub(crate) fn box_corners(&self) -> [Point; 8] {
        let last = self.grid.counts.map(|count| count - 1);
        std::array::from_fn(|i| {
            let end = |axis: usize| last[axis] * (i >> axis & 1);
            self.grid.at([end(0), end(1), end(2)])
        })
    }

    /// The direction in which the distance grows fastest; `None` deep inside, where it is not known.
    pub(crate) fn outward(&self, x: Point) -> Option<Vector> {
        let Place { node, part } = self.grid.place(x)?;
        let corners = self.corners(node);
        // Between nodes the distance is linear along each axis.
        let slope = Vector::from_fn(|axis, _| {
            let at = |end| {
                let mut part = part;
                part[axis] = end;
                between(corners, part)
            };
            at(1.0) - at(0.0)
        });
        let steep = length(slope);
        (steep > 0.0).then(|| slope / steep)
    }

    /// The values at the corners of the cell after a node, x fastest.
    fn corners(&self, node: usize) -> [f64; 8] {
        let [width, height, _] = self.grid.counts;
        let rows = [
            node,
            node + width,
            node + width * height,
            node + width * height + width,
        ];
        let corner = |i: usize| f64::from(self.distances[rows[i / 2] + i % 2]);
        std::array::from_fn(corner)
    }

    /// Measures the error in the middle of the cells at the surface and outside of it.
    fn measure(&mut self, surface: &Surface) {
        let (cell_m, counts) = (self.grid.cell_m, self.grid.counts);
        let middles = Grid {
            origin: self.grid.origin + Vector::repeat(0.5 * cell_m),
            counts: counts.map(|count| count - 1),
            cell_m,
        };
        let exact = middles.distances(surface, MEASURED);
        let (mut squares, mut count) = (0.0, 0.0_f64);
        let measured_m = (MEASURED * cell_m) as f32;
        for (cell, &exact) in exact.iter().enumerate() {
            let [i, j, k] = middles.indices(cell);
            let node = (k * counts[1] + j) * counts[0] + i;
            let corners = self.corners(node);
            if exact < measured_m && corners.iter().any(|&d| d >= 0.0) {
                let error = (between(corners, [0.5; 3]).abs() - f64::from(exact)).abs();
                self.error_worst_m = self.error_worst_m.max(error);
                squares += error * error;
                count += 1.0;
            }
        }
        self.error_rms_m = (squares / count.max(1.0)).sqrt();
    }
}

/// The value between the corners of a cell, x fastest.
fn between(c: [f64; 8], [u, v, w]: [f64; 3]) -> f64 {
    let along = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let [low, high] =
        [0, 4].map(|k| along(along(c[k], c[k + 1], u), along(c[k + 2], c[k + 3], u), v));
    along(low, high, w)
}

/// The numbers of the grid, and a digest of all distances.
impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bits = self.distances.iter().map(|d| d.to_bits());
        let digest = digest::after(digest::EMPTY, bits);
        f.debug_struct("Body")
            .field("grid", &self.grid)
            .field("error_worst_m", &self.error_worst_m)
            .field("digest", &digest)
            .finish_non_exhaustive()
    }
}

/// The triangles of a body.
struct Surface {
    points: Vec<Point>,
    faces: Vec<[u32; 3]>,
}

impl Surface {
    fn triangles(&self) -> impl Iterator<Item = [Point; 3]> + '_ {
        let corners = |face: &[u32; 3]| face.map(|v| self.points[v as usize]);
        self.faces.iter().map(corners)
    }

    /// Closes each hole by a fan round its middle.
    fn close(&mut self) -> Result<(), BodyError> {
        // How often an edge is run along upward, less how often downward, by its lower and its higher end.
        let mut runs = BTreeMap::<(u32, u32), i32>::new();
        for &[a, b, c] in &self.faces {
            for (a, b) in [(a, b), (b, c), (c, a)] {
                *runs.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
            }
        }
        let of = runs.len();
        runs.retain(|_, runs| *runs != 0);
        if runs.len() * OPEN_SHARE > of {
            let edges = runs.len();
            return Err(BodyError::Open { edges, of });
        }
        let mut sets = DisjointSets::default();
        sets.reset(self.points.len() as u32);
        runs.keys().for_each(|&(a, b)| sets.join(a, b));
        // By one of its vertices: the sum of the ends of its edges, and their number.
        let mut holes = BTreeMap::<u32, (Vector, f64)>::new();
        for &(a, b) in runs.keys() {
            let (sum, ends) = holes.entry(sets.representative(a)).or_default();
            *sum += self.points[a as usize].coords + self.points[b as usize].coords;
            *ends += 2.0;
        }
        for (&(a, b), &runs) in &runs {
            let before = holes.range(..sets.representative(a)).count();
            let middle = (self.points.len() + before) as u32;
            let back = if runs > 0 {
                [b, a, middle]
            } else {
                [a, b, middle]
            };
            self.faces.extend((0..runs.abs()).map(|_| back));
        }
        let middles = holes.values().map(|(sum, ends)| Point::from(sum / *ends));
        self.points.extend(middles);
        Ok(())
    }

    /// Turns all faces round if they look inward.
    fn turn_outward(&mut self) -> Result<(), BodyError> {
        let volumes = self.triangles();
        let volumes = volumes.map(|[a, b, c]| dot(a.coords, cross(b.coords, c.coords)));
        let volume: f64 = volumes.sum();
        if volume < 0.0 {
            self.faces.iter_mut().for_each(|face| face.swap(1, 2));
        }
        (volume != 0.0).then_some(()).ok_or(BodyError::Empty)
    }
}

/// Nodes at equal distances.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Grid {
    origin: Point,
    counts: [usize; 3],
    cell_m: f64,
}

/// The first node of a cell, and the part of the cell before a point.
struct Place {
    node: usize,
    part: [f64; 3],
}

impl Grid {
    /// A grid with the band of a surface in it.
    fn around(surface: &Surface, cell_m: Option<f64>) -> Result<Grid, BodyError> {
        let bound = |wins: fn(f64, f64) -> f64| {
            let used = surface.triangles().flatten().map(|x| x.coords);
            let bound = used.reduce(|bound, x| bound.zip_map(&x, wins));
            bound.expect("a body has a face, or no volume")
        };
        let (low, high) = (bound(f64::min), bound(f64::max));
        let sides = high - low;
        let by_default = sides.amax() / CELLS;
        let cell_m = cell_m.unwrap_or(by_default);
        let counts = |cell_m: f64| sides.map(|side| (side / cell_m).ceil() + 2.0 * BAND + 2.0);
        let nodes = |cell_m| counts(cell_m).product();
        if !(cell_m > 0.0 && nodes(cell_m) <= NODES_MAX) {
            let finest = Some(cell_m.max(1e-3 * by_default));
            let mut coarser = std::iter::successors(finest, |cell_m| Some(cell_m * 1.1));
            return Err(BodyError::Cell {
                given_m: cell_m,
                least_m: coarser.find(|&cell_m| nodes(cell_m) <= NODES_MAX),
            });
        }
        let before = Vector::from(OFFSETS.map(|part| (BAND + part) * cell_m));
        Ok(Grid {
            origin: Point::from(low - before),
            counts: std::array::from_fn(|axis| counts(cell_m)[axis] as usize),
            cell_m,
        })
    }

    fn indices(&self, node: usize) -> [usize; 3] {
        let [width, height, _] = self.counts;
        [node % width, node / width % height, node / width / height]
    }

    fn at(&self, [i, j, k]: [usize; 3]) -> Point {
        self.origin + Vector::new(i as f64, j as f64, k as f64) * self.cell_m
    }

    /// The cell that a point is in, if it is in the grid.
    fn place(&self, x: Point) -> Option<Place> {
        let cells = (x - self.origin) / self.cell_m;
        let (mut node, mut part) = (0, [0.0; 3]);
        for axis in [2, 1, 0] {
            let count = self.counts[axis];
            if !(cells[axis] >= 0.0 && cells[axis] < (count - 1) as f64) {
                return None;
            }
            let whole = cells[axis] as usize;
            part[axis] = cells[axis] - whole as f64;
            node = node * count + whole;
        }
        Some(Place { node, part })
    }

    /// How far a point is from the grid, at least.
    fn away(&self, x: Point) -> f64 {
        let last = self.at(self.counts.map(|count| count - 1));
        let beyond = |axis: usize| (self.origin[axis] - x[axis]).max(x[axis] - last[axis]);
        (0..3).fold(0.0, |far, axis| beyond(axis).max(far))
    }

    /// The first and the one after the last node along an axis that are within these bounds.
    fn range(&self, axis: usize, low: f64, high: f64) -> std::ops::Range<usize> {
        let cells = |x: f64| ((x - self.origin[axis]) / self.cell_m).max(0.0);
        let end = (cells(high) as usize + 1).min(self.counts[axis]);
        (cells(low).ceil() as usize).min(end)..end
    }

    /// The distance of each node from the surface, up to so many cells.
    fn distances(&self, surface: &Surface, band: f64) -> Vec<f32> {
        let band_m = band * self.cell_m;
        let [width, height, depth] = self.counts;
        let mut distances = vec![band_m as f32; width * height * depth];
        for corners in surface.triangles() {
            let triangle = Triangle::new(corners);
            let [x, y, z] = [0, 1, 2].map(|axis| {
                let [low, high] = triangle.bounds(axis);
                self.range(axis, low - band_m, high + band_m)
            });
            for k in z {
                for j in y.clone() {
                    let row = (k * height + j) * width;
                    for i in x.clone() {
                        let (near, p) = (&mut distances[row + i], self.at([i, j, k]));
                        if triangle.height(p) < f64::from(*near) {
                            *near = near.min(triangle.distance(p) as f32);
                        }
                    }
                }
            }
        }
        distances
    }

    /// Makes the distances of nodes inside negative.
    fn sign(&self, surface: &Surface, distances: &mut [f32]) -> Result<(), BodyError> {
        let entries = self.crossings(surface);
        let rows = distances.chunks_exact_mut(self.counts[0]);
        for (row, entries) in rows.zip(entries.chunks_exact(self.counts[0])) {
            let mut entered = 0;
            for (distance, more) in row.iter_mut().zip(entries) {
                entered += i32::from(*more);
                *distance = if entered > 0 { -*distance } else { *distance };
            }
        }
        self.check_sides(distances)
    }

    /// How often a line along x enters the body before a node, and after the one before, less how often it
    /// leaves.
    fn crossings(&self, surface: &Surface) -> Vec<i16> {
        let [width, height, depth] = self.counts;
        let mut entries = vec![0; width * height * depth];
        let [b, c] = [1, 2];
        for face in &surface.faces {
            let corners = face.map(|v| surface.points[v as usize]);
            let triangle = Triangle::new(corners);
            let [over_b, over_c] = [b, c].map(|axis| {
                let [low, high] = triangle.bounds(axis);
                self.range(axis, low, high)
            });
            for (j, k) in over_b.flat_map(|j| over_c.clone().map(move |k| (j, k))) {
                let p = self.at([0, j, k]);
                // Twice the area of the corner before the line and an edge. Both faces at an edge compute it
                // from the same end, so that a line passes through one of them.
                let area = |from: usize, to: usize| {
                    let is_upward = face[from] < face[to];
                    let [low, high] = if is_upward { [from, to] } else { [to, from] };
                    let [from, to] = [corners[low], corners[high]];
                    let area =
                        (to[b] - from[b]) * (p[c] - from[c]) - (to[c] - from[c]) * (p[b] - from[b]);
                    let side = if area >= 0.0 { 1 } else { -1 };
                    if is_upward {
                        (area, side)
                    } else {
                        (-area, -side)
                    }
                };
                let parts = [area(1, 2), area(2, 0), area(0, 1)];
                let side = parts[0].1;
                let whole = parts[0].0 + parts[1].0 + parts[2].0;
                if parts.iter().any(|part| part.1 != side) || whole == 0.0 {
                    continue;
                }
                let sum = (0..3).fold(0.0, |sum, i| sum + parts[i].0 * corners[i].x);
                let cells = (sum / whole - self.origin.x) / self.cell_m;
                let i = (cells.max(0.0) as usize + 1).min(width - 1);
                entries[(k * height + j) * width + i] -= side;
            }
        }
        entries
    }

    /// Refuses neighbours that differ by more than they are apart: one of them is on the wrong side.
    fn check_sides(&self, distances: &[f32]) -> Result<(), BodyError> {
        let strides = [1, self.counts[0], self.counts[0] * self.counts[1]];
        // Rounding to single precision makes differences a little larger than they are.
        let apart_m = (self.cell_m * 1.001) as f32;
        let differs = |&node: &usize| {
            let next = |axis: usize| {
                let is_last = self.indices(node)[axis] + 1 == self.counts[axis];
                if is_last { node } else { node + strides[axis] }
            };
            let mut others = (0..3).map(|axis| distances[next(axis)]);
            others.any(|other| (other - distances[node]).abs() > apart_m)
        };
        match (0..distances.len()).find(differs) {
            Some(node) => Err(BodyError::Sides(self.at(self.indices(node)))),
            None => Ok(()),
        }
    }
}

/// A triangle, with its unit normal.
struct Triangle {
    corners: [Point; 3],
    normal: Vector,
}

impl Triangle {
    fn new(corners: [Point; 3]) -> Triangle {
        let [a, b, c] = corners;
        let normal = cross(b - a, c - a);
        let normal = normal / length(normal).max(f64::MIN_POSITIVE);
        Triangle { corners, normal }
    }

    fn bounds(&self, axis: usize) -> [f64; 2] {
        let [a, b, c] = self.corners.map(|corner| corner[axis]);
        [a.min(b).min(c), a.max(b).max(c)]
    }

    /// How far a point is from the plane, and so from the triangle at least.
    fn height(&self, p: Point) -> f64 {
        dot(self.normal, p - self.corners[0]).abs()
    }

    /// How far a point is from the triangle: from its plane if it is above it, else from an edge.
    fn distance(&self, p: Point) -> f64 {
        let [a, b, c] = self.corners;
        let edges = [(a, b), (b, c), (c, a)];
        let is_within =
            |(from, to): (Point, Point)| dot(cross(self.normal, to - from), p - from) >= 0.0;
        let has_area = self.normal != Vector::zeros();
        if has_area && edges.into_iter().all(is_within) {
            return self.height(p);
        }
        edges.into_iter().fold(f64::INFINITY, |least, (from, to)| {
            let (edge, d) = (to - from, p - from);
            let square = dot(edge, edge);
            let t = if square > 0.0 {
                dot(d, edge) / square
            } else {
                0.0
            };
            least.min(length(d - edge * t.clamp(0.0, 1.0)))
        })
    }
}

/// The reason why a body was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BodyError {
    /// The faces enclose nothing.
    Empty,
    /// A point of a face is not there, not finite or too far away.
    Face {
        /// The index of the face.
        face: usize,
    },
    /// More than one edge in forty is open: it has a face on one side alone, or two that turn different ways.
    Open {
        /// The number of such edges.
        edges: usize,
        /// The number of all edges.
        of: usize,
    },
    /// The cell is not positive, or the grid would have more than 16 777 216 nodes.
    Cell {
        /// The cell as given, in metres.
        given_m: f64,
        /// A cell that fits, in metres.
        least_m: Option<f64>,
    },
    /// It is not clear what is inside and what outside near this point.
    Sides(Point),
}

impl fmt::Display for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BodyError::Empty => f.write_str("the body encloses nothing"),
            BodyError::Face { face } => write!(f, "face {face} of the body lacks a usable point"),
            BodyError::Open { edges, of } => {
                write!(f, "the body is open: {edges} of its {of} edges lack a face")
            }
            BodyError::Cell { given_m, least_m } => write!(
                f,
                "a cell of {given_m} m is too small for the body: the least is {:.2e} m",
                least_m.unwrap_or(f64::INFINITY)
            ),
            BodyError::Sides(at) => write!(
                f,
                "it is not clear what is inside of the body near ({:.3}, {:.3}, {:.3})",
                at.x, at.y, at.z
            ),
        }
    }
}

impl std::error::Error for BodyError {}

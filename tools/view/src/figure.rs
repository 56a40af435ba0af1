//! What is drawn of a mesh: points with a normal, faces with a colour, and lines.

use std::collections::HashMap;

use tearmesh::geometry::{cross, dot, length, sine_and_cosine};
use tearmesh::{HalfEdgeId, Mesh, Place, Point, Vector, VertexId, engine};

use crate::camera::unit;
use crate::palette::{self, Color};
use crate::pieces::Pieces;
use crate::strokes::Kind;

/// The cosine of the angle between two faces from which on there is a crease, in degrees. Without an angle
/// there is none.
pub(crate) fn crease_cosine(degrees: Option<f64>) -> f64 {
    // Below all cosines, also those that rounding leaves below −1.
    let cosine = |degrees: f64| sine_and_cosine(degrees.clamp(0.0, 180.0).to_radians()).1;
    degrees.map_or(-2.0, cosine)
}

/// How many threads hang out of each torn edge.
const THREADS: u64 = 4;

/// Three parts of one, scattered by a number (`SplitMix64`; Steele, Lea and Flood, OOPSLA 2014).
fn parts(number: u64) -> [f64; 3] {
    [1, 2, 3].map(|draw| {
        let z = (number * 3 + draw).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 / (1u64 << 53) as f64
    })
}

/// The sides of a torn edge coincide if their ends are this close, as a part of the length of the edge.
const COINCIDENT: f64 = 0.02;

/// A surface that is ready to be drawn. A vertex of the mesh is one point for each normal and each texture
/// coordinate that its corners have.
#[derive(Clone, Debug, Default)]
pub(crate) struct Figure {
    pub(crate) points: Vec<Point>,
    /// The unit normal of each point.
    pub(crate) normals: Vec<Vector>,
    /// The texture coordinates of each point; empty if the mesh has none.
    pub(crate) texture: Vec<[f64; 2]>,
    /// The points of each face.
    pub(crate) faces: Vec<[u32; 3]>,
    /// The colour of each face.
    pub(crate) colors: Vec<Color>,
    /// Edges that are drawn, from point to point.
    pub(crate) lines: Vec<(Kind, [u32; 2])>,
}

impl Figure {
    /// `crease` is that of [`crease_cosine`]; `texture` has the coordinates of each corner, or is empty.
    /// Edges between two faces are lines too if `edges` asks for it.
    pub(crate) fn new(
        mesh: &Mesh,
        place: &(impl Place + ?Sized),
        crease: f64,
        texture: &[[f64; 2]],
        edges: bool,
    ) -> Figure {
        let numbers = Pieces::default().next(mesh);
        let mut figure = Figure {
            faces: vec![[0; 3]; mesh.face_count()],
            colors: numbers.into_iter().map(palette::piece).collect(),
            ..Figure::default()
        };
        let normals = engine::normals(mesh, place, crease);
        let normal = |h: HalfEdgeId| normals[h.index()];
        for v in mesh.vertices() {
            for first in mesh.fans(v) {
                let mut fan: Vec<HalfEdgeId> = mesh.fan(first).collect();
                // A closed fan begins at a crease, if it has one.
                let crease = (1..fan.len()).find(|&i| normal(fan[i - 1]) != normal(fan[i]));
                fan.rotate_left(crease.filter(|_| mesh.pair(first).is_some()).unwrap_or(0));
                for part in fan.chunk_by(|&one, &next| normal(one) == normal(next)) {
                    figure.add_corners(place.at(v), normal(part[0]), part, texture);
                }
            }
        }
        let lines = lines(mesh, place, edges);
        let lines = lines.map(|(kind, h)| (kind, [h, h.next()].map(|h| figure.corner(h))));
        figure.lines = lines.collect();
        figure
    }

    /// The point at the corner of a face where a half-edge begins.
    fn corner(&self, h: HalfEdgeId) -> u32 {
        self.faces[h.face().index()][h.index() % 3]
    }

    /// Adds short threads along the sides of tears that gape. They go on with the thread of the weave that leads
    /// out of the cloth, or with none where there are no texture coordinates. Their places and lengths follow
    /// from the index of the half-edge, so a picture is the same each time, and a film does not flicker.
    pub(crate) fn fringe(&mut self, mesh: &Mesh, place: &(impl Place + ?Sized)) {
        for (_, h) in lines(mesh, place, false).filter(|(kind, _)| *kind == Kind::Seam) {
            let [from, to] = [h, h.next()].map(|h| self.corner(h) as usize);
            let along = self.points[to] - self.points[from];
            let normal = self.normals[from] + self.normals[to];
            let Some(outward) = unit(cross(along, normal)) else {
                continue;
            };
            let outward = self.thread(h.face().index(), outward).unwrap_or(outward);
            for thread in 0..THREADS {
                let [at, long, aside] = parts(h.index() as u64 * THREADS + thread);
                let root = self.points[from] + along * at;
                let reach = outward * (length(along) * (0.1 + 0.3 * long));
                let first = self.points.len() as u32;
                let end = root + reach + along * (0.2 * (aside - 0.5));
                self.points.extend([root, end]);
                self.normals.extend([unit(normal).unwrap_or_default(); 2]);
                if let Some(&texture) = self.texture.get(from) {
                    self.texture.extend([texture; 2]);
                }
                self.lines.push((Kind::Thread, [first, first + 1]));
            }
        }
    }

    /// The direction of the thread, warp or weft, that goes more outward from a face.
    fn thread(&self, face: usize, outward: Vector) -> Option<Vector> {
        let corners = self.faces[face].map(|corner| corner as usize);
        let [a, b, c] = corners.map(|corner| self.texture.get(corner).copied());
        let ([a, b, c], [p, q, r]) = ([a?, b?, c?], corners.map(|corner| self.points[corner]));
        // Along one texture coordinate the other one stays.
        let along = |other: usize| {
            let thread = (q - p) * (c[other] - a[other]) - (r - p) * (b[other] - a[other]);
            let thread = unit(thread)?;
            Some(thread * dot(thread, outward).signum())
        };
        let (warp, weft) = (along(0)?, along(1)?);
        let is_warp = dot(warp, outward) >= dot(weft, outward);
        Some(if is_warp { warp } else { weft })
    }

    /// Adds corners of one vertex that have one normal.
    fn add_corners(
        &mut self,
        point: Point,
        normal: Vector,
        corners: &[HalfEdgeId],
        texture: &[[f64; 2]],
    ) {
        for (i, &h) in corners.iter().enumerate() {
            let texture = texture.get(h.index());
            if i == 0 || self.texture.last() != texture {
                self.points.push(point);
                self.normals.push(normal);
                self.texture.extend(texture);
            }
            self.faces[h.face().index()][h.index() % 3] = self.points.len() as u32 - 1;
        }
    }

    /// Divides each face into n² and bends it between the normals of its corners (Phong tessellation;
    /// Boubekeur and Alexa, SIGGRAPH Asia 2008). A point on an edge belongs to the two points that the edge
    /// joins, so the finer surface is open where this one is.
    pub(crate) fn finer(&self, n: u32) -> Figure {
        let mut finer = Figure {
            points: self.points.clone(),
            normals: self.normals.clone(),
            texture: self.texture.clone(),
            ..Figure::default()
        };
        let mut on_edges = HashMap::new();
        let mut grid = Vec::new();
        for (&corners, &color) in self.faces.iter().zip(&self.colors) {
            grid.clear();
            for i in 0..=n {
                for j in 0..=n - i {
                    let weights = [n - i - j, i, j];
                    grid.push(finer.add(self, corners, weights, &mut on_edges));
                }
            }
            let row = |i: u32| i * (n + 1) - i * i.saturating_sub(1) / 2;
            let at = |i: u32, j: u32| grid[(row(i) + j) as usize];
            for i in 0..n {
                for j in 0..n - i {
                    let (below, beside) = (at(i + 1, j), at(i, j + 1));
                    finer.faces.push([at(i, j), below, beside]);
                    if j + 1 < n - i {
                        finer.faces.push([below, at(i + 1, j + 1), beside]);
                    }
                }
            }
            finer.colors.resize(finer.faces.len(), color);
        }
        for &(kind, [a, b]) in &self.lines {
            let along = (0..=n).map(|i| finer.add(self, [a, b, b], [n - i, i, 0], &mut on_edges));
            let along: Vec<u32> = along.collect();
            let segments = along.windows(2).map(|ends| (kind, [ends[0], ends[1]]));
            finer.lines.extend(segments);
        }
        finer
    }

    /// The point at these weights of three points of a coarser figure: made, or found again.
    fn add(
        &mut self,
        coarse: &Figure,
        corners: [u32; 3],
        weights: [u32; 3],
        on_edges: &mut HashMap<[(u32, u32); 2], u32>,
    ) -> u32 {
        let mut ends = [0, 1, 2].map(|i| (corners[i], weights[i]));
        ends.sort_unstable_by_key(|&(corner, weight)| (weight == 0, corner));
        let [first, second, third] = ends;
        if second.1 == 0 {
            return first.0;
        }
        let number = self.points.len() as u32;
        if third.1 == 0 {
            let known = *on_edges.entry([first, second]).or_insert(number);
            if known != number {
                return known;
            }
        }
        // In one order whichever face asks, so that both have the same point.
        let sum: u32 = weights.iter().sum();
        let part = |weight| f64::from(weight) / f64::from(sum);
        let parts = ends.map(|(corner, weight)| (corner as usize, part(weight)));
        let origin = coarse.points[parts[0].0];
        let (mut flat, mut normal, mut texture) = (Vector::zeros(), Vector::zeros(), [0.0; 2]);
        for (corner, part) in parts {
            flat += (coarse.points[corner] - origin) * part;
            normal += coarse.normals[corner] * part;
            if let Some(at) = coarse.texture.get(corner) {
                texture = [0, 1].map(|i| texture[i] + at[i] * part);
            }
        }
        let bent = parts.iter().fold(Vector::zeros(), |bent, &(corner, part)| {
            let normal = coarse.normals[corner];
            let off = dot(flat - (coarse.points[corner] - origin), normal);
            bent - normal * (off * part * BENT)
        });
        self.points.push(origin + flat + bent);
        self.normals.push(unit(normal).unwrap_or_default());
        if !coarse.texture.is_empty() {
            self.texture.push(texture);
        }
        number
    }
}

/// The part of the way from a flat face to the tangent planes of its corners; 3/4 is Boubekeur's and
/// Alexa's.
const BENT: f64 = 0.75;

/// The edges that are drawn, by a half-edge of each.
fn lines<'m>(
    mesh: &'m Mesh,
    place: &'m (impl Place + ?Sized),
    edges: bool,
) -> impl Iterator<Item = (Kind, HalfEdgeId)> + 'm {
    mesh.half_edges().filter_map(move |h| {
        let kind = match (mesh.pair(h), mesh.ghost_pair(h)) {
            (Some(pair), _) if edges && h < pair => Kind::Edge,
            (Some(_), _) => return None,
            (None, None) => Kind::Boundary,
            (None, Some(ghost)) if are_coincident(mesh, place, [h, ghost]) => Kind::Slit,
            (None, Some(_)) => Kind::Seam,
        };
        Some((kind, h))
    })
}

/// Whether the two sides of a torn edge lie on each other.
fn are_coincident(mesh: &Mesh, place: &(impl Place + ?Sized), [h, ghost]: [HalfEdgeId; 2]) -> bool {
    let at = |v: VertexId| place.at(v);
    let [from, to] = [at(mesh.origin(h)), at(mesh.target(h))];
    let near = length(to - from) * COINCIDENT;
    length(at(mesh.target(ghost)) - from) <= near && length(at(mesh.origin(ghost)) - to) <= near
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use tearmesh::{CutMethod, Edits, PerCorner, Plane, Scissor, shapes};

    use super::*;

    /// How often each edge is an edge of a face, by its points.
    fn edges(figure: &Figure) -> HashMap<[u32; 2], u32> {
        let mut count = HashMap::new();
        for &[a, b, c] in &figure.faces {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *count.entry([from.min(to), from.max(to)]).or_insert(0) += 1;
            }
        }
        count
    }

    #[test]
    fn threads_go_on_with_the_weave_that_leads_out() {
        // Slit across at 30 degrees to the lines of the texture, and opened.
        let (mut mesh, mut positions) = shapes::grid(6, 6);
        let texture = |h| {
            let p = positions.at(mesh.origin(h));
            [p.x, p.y]
        };
        let mut texture = PerCorner::new(mesh.half_edges().map(texture).collect());
        let plane = Plane::new(Point::new(0.5, 0.5, 0.0), Vector::new(0.5, 0.8, 0.0));
        let scissor = Scissor::by_plane(plane.expect("a plane"));
        let edits = &mut Edits::new();
        let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, edits);
        assert!(cut.is_ok());
        edits.replay(&mut texture);
        let (_, at) = tearmesh::gap::gapped(&mesh, &positions, 0.1);
        for (texture, lead) in [(texture.as_slice(), 1.0), (&[], 0.848)] {
            let mut figure = Figure::new(&mesh, &at[..], -1.0, texture, false);
            figure.fringe(&mesh, &at[..]);
            let threads = figure
                .lines
                .iter()
                .filter(|(kind, _)| *kind == Kind::Thread);
            let mut sum = Vector::zeros();
            for (_, [from, to]) in threads {
                let [from, to] = [from, to].map(|&end| figure.points[end as usize]);
                let way = to - from;
                sum += way * way.y.signum();
            }
            let lead_found = sum.y / length(sum);
            assert!((lead_found - lead).abs() < 0.01, "{lead_found} for {lead}");
        }
    }

    #[test]
    fn a_finer_figure_is_open_where_the_mesh_is() {
        let (mut mesh, mut positions) = shapes::grid(5, 4);
        let plane = Plane::new(Point::new(0.43, 0.0, 0.0), Vector::new(1.0, 0.3, 0.0));
        let scissor = Scissor::by_plane(plane.expect("a plane"));
        let edits = &mut Edits::new();
        let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, edits);
        assert!(cut.is_ok());
        let open = mesh
            .half_edges()
            .filter(|&h| mesh.pair(h).is_none())
            .count();
        let figure = Figure::new(&mesh, &positions, -2.0, &[], false);
        for n in [1, 2, 5] {
            let finer = figure.finer(n);
            assert_eq!(finer.faces.len(), mesh.face_count() * (n * n) as usize);
            let once = edges(&finer)
                .into_values()
                .filter(|&count| count == 1)
                .count();
            assert_eq!(once, open * n as usize);
            assert_eq!(finer.lines.len(), open * n as usize);
            // It is flat, and stays so.
            assert!(finer.points.iter().all(|p| p.z == 0.0));
        }
    }

    /// A coarse ball drawn finer comes nearer to the ball.
    #[test]
    fn a_finer_figure_is_bent() {
        let (mesh, positions) = shapes::octahedron();
        let figure = Figure::new(&mesh, &positions, -2.0, &[], false);
        let nearest = |figure: &Figure| {
            let far = figure.points.iter().map(|p| p.coords.norm());
            far.fold(f64::INFINITY, f64::min)
        };
        let radius = nearest(&figure);
        let flat = radius / 3f64.sqrt();
        assert!(nearest(&figure.finer(3)) > (radius + flat) / 2.0);
    }

    #[test]
    fn a_crease_parts_the_points_of_a_vertex() {
        let (mesh, positions) = shapes::octahedron();
        let points = |degrees| {
            let crease = crease_cosine(degrees);
            Figure::new(&mesh, &positions, crease, &[], false)
                .points
                .len()
        };
        // Its faces meet at 70.5 degrees.
        assert_eq!(
            [points(None), points(Some(71.0)), points(Some(70.0))],
            [6, 6, 24]
        );
        assert_eq!(points(Some(0.0)), 24);
    }

    #[test]
    fn a_corner_of_a_texture_seam_has_its_own_point() {
        let (mesh, positions) = shapes::grid(1, 1);
        let same = vec![[0.5, 0.25]; 6];
        let points = |texture: &[[f64; 2]]| {
            Figure::new(&mesh, &positions, -2.0, texture, false)
                .points
                .len()
        };
        assert_eq!(points(&same), 4);
        let apart: Vec<[f64; 2]> = (0..6).map(|i| [f64::from(i / 3), 0.0]).collect();
        assert_eq!(points(&apart), 6);
    }
}

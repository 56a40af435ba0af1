//! The face that a ray meets first, against whole numbers without rounding.
//!
//! All coordinates are whole numbers, so the oracle decides by determinants in `i128`, which are exact,
//! and compares distances as fractions. Rays are aimed at places inside faces, at the middles of edges
//! and at vertices, from near and far, and along the planes of faces.

use tearmesh::engine::pick;
use tearmesh::{Mesh, Point, Positions, Ray, Vector, VertexId, shapes};

use crate::cases::cases;
use crate::random::Random;

type Whole = [i64; 3];

fn minus(a: Whole, b: Whole) -> Whole {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn determinant(a: Whole, b: Whole, c: Whole) -> i128 {
    let [a, b, c] = [a, b, c].map(|v| v.map(i128::from));
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// What the oracle knows of a hit: the face, the determinants of its edges, and the distance in lengths
/// of the direction, as a fraction with a positive denominator.
#[derive(Clone, Copy, Debug)]
struct Truth {
    face: usize,
    parts: [i128; 3],
    distance: [i128; 2],
}

/// The faces that a ray meets, and those that are equally near and nearest.
fn truth(points: &[Whole], triangles: &[[u32; 3]], origin: Whole, along: Whole) -> Vec<Truth> {
    let mut hits: Vec<Truth> = Vec::new();
    for (face, triangle) in triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(|v| minus(points[v as usize], origin));
        let parts = [
            determinant(along, b, c),
            determinant(along, c, a),
            determinant(along, a, b),
        ];
        let whole: i128 = parts.iter().sum();
        let one_sided = parts.iter().all(|&x| x >= 0) || parts.iter().all(|&x| x <= 0);
        if !one_sided || whole == 0 {
            continue;
        }
        // origin + t along lies in the plane of the corners: t = det(a, b, c) / whole.
        let above = determinant(a, b, c) * whole.signum();
        if above >= 0 {
            let distance = [above, whole.abs()];
            hits.push(Truth {
                face,
                parts,
                distance,
            });
        }
    }
    let nearer = |a: &Truth, b: &Truth| {
        (a.distance[0] * b.distance[1]).cmp(&(b.distance[0] * a.distance[1]))
    };
    hits.sort_by(|a, b| nearer(a, b).then(a.face.cmp(&b.face)));
    let first = hits.first().copied();
    hits.retain(|hit| first.is_some_and(|first| nearer(hit, &first).is_eq()));
    hits
}

/// A mesh whose vertices have whole coordinates.
struct Lattice {
    mesh: Mesh,
    points: Vec<Whole>,
    /// The size of its coordinates.
    size: i64,
}

impl Lattice {
    fn of(mesh: Mesh, point: impl FnMut(VertexId) -> Whole) -> Lattice {
        let points: Vec<Whole> = mesh.vertices().map(point).collect();
        let size = points.iter().flatten().map(|x| x.abs()).max().unwrap_or(1);
        Lattice { mesh, points, size }
    }

    /// A shape whose coordinates are multiplied and rounded.
    fn rounded((mesh, positions): (Mesh, Positions), by: f64) -> Lattice {
        Lattice::of(mesh, |v| {
            let p = positions.at(v);
            [p.x, p.y, p.z].map(|x| (by * x).round() as i64)
        })
    }

    fn positions(&self) -> Positions {
        let points = self.points.iter().map(|p| p.map(|x| x as f64));
        Positions::new(points).expect("small numbers")
    }
}

/// What was seen in many rays.
#[derive(Debug, Default)]
struct Counts {
    rays: u64,
    inside: u64,
    on_edges: u64,
    on_vertices: u64,
    missed: u64,
    at_the_origin: u64,
    ties: u64,
}

fn whole_number(random: &mut Random, size: i64) -> i64 {
    ((2.0 * random.next() - 1.0) * size as f64).round() as i64
}

impl Counts {
    fn check(&mut self, lattice: &Lattice, origin: Whole, along: Whole) {
        let points = lattice.positions();
        let triangles = lattice.mesh.indices().as_chunks::<3>().0;
        let told = truth(&lattice.points, triangles, origin, along);
        let [o, d] = [origin, along].map(|p| p.map(|x| x as f64));
        let ray = Ray::new(Point::from(o), Vector::from(d)).expect("a direction");
        let hit = pick::first_hit(&lattice.mesh, &points, &ray);
        let what = || format!("from {origin:?} along {along:?}: {hit:?}, and in truth {told:?}");
        self.rays += 1;
        if told.is_empty() {
            assert!(hit.is_none(), "{}", what());
            self.missed += 1;
            return;
        }
        let hit = hit.unwrap_or_else(|| panic!("{}", what()));
        // Faces that lie on one another are equally near up to rounding alone; those that the ray meets
        // in one vertex, or on one edge, to the bit.
        let place = |hit: &Truth| {
            let corners = triangles[hit.face].iter().zip(hit.parts);
            let met = corners
                .filter(|&(_, part)| part != 0)
                .map(|(&v, _)| lattice.points[v as usize]);
            let mut met: Vec<Whole> = met.collect();
            met.sort_unstable();
            met
        };
        let own = told.iter().find(|truth| truth.face == hit.face.index());
        let own = own.unwrap_or_else(|| panic!("{}", what()));
        let first = told.iter().find(|truth| place(truth) == place(own));
        let first = first.expect("itself, if no other");
        assert_eq!(hit.face.index(), first.face, "{}", what());
        let whole: i128 = first.parts.iter().sum();
        let length = |p: Whole| p.iter().map(|&x| (x as f64).powi(2)).sum::<f64>().sqrt();
        let corners =
            triangles[first.face].map(|v| length(minus(lattice.points[v as usize], origin)));
        let far = corners.into_iter().fold(0.0, f64::max);
        // How much larger the products are than what is left of their sum.
        let cancelled = 1.0 + length(along) * far * far / (whole as f64).abs();
        for (weight, &part) in hit.weights.iter().zip(&first.parts) {
            let exact = part as f64 / whole as f64;
            assert!((weight - exact).abs() < 1e-14 * cancelled, "{}", what());
            assert_eq!(*weight == 0.0, part == 0, "{}", what());
        }
        let exact = first.distance[0] as f64 / first.distance[1] as f64 * length(along);
        let off = (hit.distance - exact).abs();
        assert!(off <= 1e-14 * cancelled * far, "{}", what());
        match first.parts.iter().filter(|&&part| part == 0).count() {
            0 => self.inside += 1,
            1 => self.on_edges += 1,
            _ => self.on_vertices += 1,
        }
        self.ties += u64::from(told.len() > 1);
        self.at_the_origin += u64::from(hit.distance == 0.0);
    }

    /// Rays through all kinds of places.
    fn shoot(&mut self, lattice: &Lattice, random: &mut Random, rays: u64) {
        let faces = lattice.mesh.face_count();
        for _ in 0..rays {
            let face = random.below(faces);
            let [a, b, c] =
                [0, 1, 2].map(|i| lattice.points[lattice.mesh.indices()[3 * face + i] as usize]);
            let mut weights = [0, 1, 2].map(|_| random.below(8) as i64);
            if weights == [0; 3] {
                weights[0] = 1;
            }
            let sum: i64 = weights.iter().sum();
            // The place has the denominator `sum`, so a ray in whole numbers can go through it.
            let far =
                |random: &mut Random| [0, 1, 2].map(|_| whole_number(random, 2 * lattice.size));
            let origin = match random.below(8) {
                0 => a,                                           // On the mesh.
                1 => [0, 1, 2].map(|i| a[i] + 3 * (b[i] - a[i])), // In the plane of the face.
                _ => far(random),
            };
            let at = [0, 1, 2].map(|i| weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i]);
            let along = [0, 1, 2].map(|i| at[i] - sum * origin[i]);
            if along != [0; 3] {
                self.check(lattice, origin, along);
            }
        }
    }
}

#[test]
fn the_first_hit_is_that_of_exact_numbers() {
    let mut random = Random(31);
    let flat = |n: u32| Lattice::rounded(shapes::grid(n, n), f64::from(n));
    let mut lattices = vec![
        flat(4),
        flat(9),
        Lattice::rounded(shapes::octahedron(), 2.0),
        Lattice::rounded(shapes::tube(8, 5), 5.0),
        Lattice::rounded(shapes::torus(12, 8), 9.0),
        Lattice::rounded(shapes::torus(12, 8), 3e4),
    ];
    // A sheet with hills: thousands in each direction, so that determinants have up to 61 bits, and
    // a sheet that is folded onto itself many times.
    for (n, size) in [(6, 1_i64 << 12), (8, 1 << 14), (8, 1 << 16)] {
        let mesh = shapes::grid(n, n).0;
        let hills = Lattice::of(mesh, |_| [0; 3].map(|_| whole_number(&mut random, size)));
        lattices.push(hills);
    }
    let folded = shapes::grid(8, 4).0;
    lattices.push(Lattice::of(folded, |v| {
        let (x, y) = (v.index() as i64 % 9, v.index() as i64 / 9);
        [x % 2, y, 0]
    }));
    let mut tally = Counts::default();
    for lattice in &lattices {
        tally.shoot(lattice, &mut random, 2 * cases());
    }
    let least = tally.rays / 20;
    assert!(tally.inside > least && tally.on_edges > least && tally.on_vertices > least);
    assert!(tally.missed > least / 4 && tally.ties > least && tally.at_the_origin > least / 4);
}

/// A closed surface has no gap: whatever ray starts inside it gets out through a face, although no
/// number here is whole.
#[test]
fn no_ray_leaves_a_closed_surface_between_its_faces() {
    let mut random = Random(5);
    let (mesh, positions) = shapes::octahedron();
    let spoilt = positions.as_slice().iter();
    let spoilt = spoilt.map(|p| p + Vector::new(random.next(), random.next(), random.next()) * 0.1);
    let positions = Positions::new(spoilt.collect::<Vec<Point>>()).expect("finite");
    let (mut near, rays) = ([0; 2], 20 * cases());
    for _ in 0..rays {
        let origin = Point::new(0.05, 0.07, 0.02)
            + Vector::new(random.next(), random.next(), random.next()) * 0.1;
        let h = mesh.half_edges().nth(random.below(24)).expect("one of 24");
        let [p, q] = [mesh.origin(h), mesh.target(h)].map(|v| positions.at(v));
        // Through an edge, or a corner, as nearly as numbers allow.
        let t = [0.0, random.next()][random.below(2)];
        let ray = Ray::new(origin, p + (q - p) * t - origin).expect("a direction");
        let hit = pick::first_hit(&mesh, &positions, &ray).expect("no way out but through a face");
        near[usize::from(t == 0.0)] += 1;
        let at: Vector = (0..3)
            .map(|i| positions.at(mesh.face_vertices(hit.face)[i]).coords * hit.weights[i])
            .sum();
        let off = at - (p + (q - p) * t).coords;
        assert!(off.norm() < 1e-12, "{hit:?} is {off} off");
    }
    assert!(near.iter().all(|&count| count > rays / 4), "{near:?}");
}

#[test]
fn regression_a_ray_that_starts_within_a_face_meets_it() {
    let mesh = Mesh::build(3, &[[0, 1, 2]]).expect("a triangle");
    let lattice = Lattice::of(mesh, |v| [[13, 0, 0], [11, 6, 0], [10, 6, -3]][v.index()]);
    let mut counts = Counts::default();
    counts.check(&lattice, [11, 5, -1], [-62, -62, -38]);
    assert_eq!((counts.inside, counts.at_the_origin), (1, 1));
}

/// So nearly along an edge that the distances of its ends from the ray are rounded to zero.
#[test]
fn regression_a_ray_almost_along_an_edge_has_weights() {
    let n = 1 << 52;
    let mesh = Mesh::build(3, &[[0, 1, 2]]).expect("a triangle");
    let points = [[n + 1, n, 0], [n - 1, n - 2, 0], [0, 0, 1]];
    let mut counts = Counts::default();
    counts.check(
        &Lattice::of(mesh, |v| points[v.index()]),
        [0; 3],
        [n, n - 1, 0],
    );
    assert_eq!(counts.on_edges, 1);
}

#[test]
fn rays_miss_coordinates_that_are_not_finite() {
    let (mesh, positions) = shapes::grid(1, 1);
    let ray = Ray::new(Point::new(0.4, 0.2, 1.0), -Vector::z()).expect("a ray");
    for x in [1.0, f64::NAN, f64::INFINITY] {
        let mut points: Vec<[f64; 3]> = positions.as_slice().iter().map(|&p| p.into()).collect();
        points[2][1] = x;
        let hit = pick::first_hit(&mesh, &points[..], &ray);
        assert!(x != 1.0 || hit.is_some());
        let is_finite = hit.is_none_or(|hit| hit.weights.iter().all(|w| w.is_finite()));
        assert!(is_finite, "{hit:?}");
    }
}

//! Cuts through the layers that the rays meet first, against chains that are found by brute force.
//!
//! The oracle knows triangles and numbers: it cuts each triangle with plane and strip, joins those that
//! share an edge which is crossed between the rays, and asks each triangle where a ray hits it.

mod methods;

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use tearmesh::{
    Cut, CutLayers, CutMethod, Edit, Edits, Mesh, Plane, Point, Positions, Ray, Scissor, Vector,
    shapes,
};

use crate::random::Random;

/// How near a special case a cut may be, in edges, for the oracle to judge it.
const NEAR: f64 = 1e-6;

/// An end of a piece, and the edge (as sorted vertices) on which it is; none at a ray.
type End = (Point, Option<[u32; 2]>);

/// What plane and strip have in common with the triangles of a mesh.
struct Oracle {
    /// For each crossed face the ends of what lies between the rays.
    pieces: BTreeMap<usize, [End; 2]>,
    /// The number of each piece's chain.
    chain: BTreeMap<usize, usize>,
}

/// Whether a cut comes too near to a special case.
struct Special;

impl Oracle {
    fn new(mesh: &Mesh, points: &[Point], scissor: &Scissor, edge: f64) -> Result<Oracle, Special> {
        let (plane, sides) = (scissor.plane(), scissor.sides().expect("there are rays"));
        let far = |p: Point, plane: &Plane| {
            let distance = plane.distance(p);
            if distance.abs() < NEAR * edge {
                return Err(Special);
            }
            Ok(distance)
        };
        let mut pieces = BTreeMap::new();
        let triangles: Vec<&[u32]> = mesh.indices().chunks(3).collect();
        for (f, triangle) in triangles.iter().enumerate() {
            let mut ends = Vec::new();
            for i in 0..3 {
                let edge = [triangle[i], triangle[(i + 1) % 3]];
                let [p, q] = edge.map(|v| points[v as usize]);
                let (d, e) = (far(p, &plane)?, far(q, &plane)?);
                if (d < 0.0) != (e < 0.0) {
                    let mut edge = edge;
                    edge.sort_unstable();
                    ends.push((p + (q - p) * (d / (d - e)), Some(edge)));
                }
            }
            let [mut p, mut q] = match ends[..] {
                [] => continue,
                [p, q] => [p, q],
                _ => panic!("a plane crosses two edges of a triangle or none"),
            };
            let mut is_outside = false;
            for side in &sides {
                let (d, e) = (far(p.0, side)?, far(q.0, side)?);
                is_outside |= d < 0.0 && e < 0.0;
                let tip = p.0 + (q.0 - p.0) * (d / (d - e));
                if d < 0.0 {
                    p = (tip, None);
                } else if e < 0.0 {
                    q = (tip, None);
                }
                if is_outside {
                    break;
                }
                // The next side plane must not take a tip of this one for its own.
                if sides
                    .iter()
                    .any(|other| other != side && other.distance(tip).abs() < NEAR * edge)
                {
                    return Err(Special);
                }
            }
            if !is_outside {
                pieces.insert(f, [p, q]);
            }
        }
        // Two strips of one face may lie outside each other: then the face has no part.
        pieces.retain(|_, [p, q]| {
            let middle = p.0 + (q.0 - p.0) * 0.5;
            sides.iter().all(|side| side.distance(middle) > 0.0)
        });
        let mut chain: BTreeMap<usize, usize> = pieces.keys().map(|&f| (f, f)).collect();
        let mut changed = true;
        while changed {
            changed = false;
            let mut least: BTreeMap<[u32; 2], usize> = BTreeMap::new();
            for (f, ends) in &pieces {
                for edge in ends.iter().filter_map(|end| end.1) {
                    let least = least.entry(edge).or_insert(usize::MAX);
                    *least = chain[f].min(*least);
                }
            }
            for (f, ends) in &pieces {
                let edges = ends.iter().filter_map(|end| end.1);
                let smallest = edges.map(|edge| least[&edge]).min().unwrap_or(chain[f]);
                changed |= smallest < chain[f];
                let of_face = chain.get_mut(f).expect("every piece has a chain");
                *of_face = smallest.min(*of_face);
            }
        }
        Ok(Oracle { pieces, chain })
    }

    /// The face that a ray hits first, and where.
    fn hit(
        &self,
        mesh: &Mesh,
        points: &[Point],
        ray: &Ray,
        edge: f64,
    ) -> Result<Option<(usize, f64)>, Special> {
        let mut hits: Vec<(f64, usize)> = Vec::new();
        for (f, triangle) in mesh.indices().chunks(3).enumerate() {
            let [a, b, c] = [0, 1, 2].map(|i| points[triangle[i] as usize]);
            let normal = (b - a).cross(&(c - a));
            let along = ray.direction().normalize();
            let upright = normal.dot(&along);
            if upright.abs() <= 1e-12 * normal.norm() {
                continue;
            }
            let t = normal.dot(&(a - ray.origin())) / upright;
            let at = ray.origin() + along * t;
            let inside = [(a, b), (b, c), (c, a)].map(|(p, q)| {
                (q - p).cross(&(at - p)).dot(&normal) / (normal.norm() * (q - p).norm())
            });
            if inside.iter().any(|x| x.abs() < NEAR * edge)
                && inside.iter().all(|x| *x > -NEAR * edge)
            {
                return Err(Special);
            }
            if t > 0.0 && inside.iter().all(|x| *x > 0.0) {
                hits.push((t, f));
            }
        }
        hits.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let [one, other, ..] = hits[..]
            && other.0 - one.0 < NEAR * edge
        {
            return Err(Special);
        }
        Ok(hits.first().map(|&(t, f)| (f, t)))
    }

    /// The chains to be cut, for each ray one.
    fn first(
        &self,
        mesh: &Mesh,
        points: &[Point],
        rays: &[Ray; 2],
        edge: f64,
    ) -> Result<[Option<usize>; 2], Special> {
        let mut chains = [None; 2];
        for side in 0..2 {
            if let Some((f, _)) = self.hit(mesh, points, &rays[side], edge)? {
                // A ray through the tip of a piece: the piece is there, or ends at that very place.
                chains[side] = Some(*self.chain.get(&f).ok_or(Special)?);
                continue;
            }
            // The ray of the pencil that comes to it first, by the angle at the eye or the distance.
            let (ray, other) = (rays[side], rays[1 - side]);
            let apart = (ray.origin() - other.origin()).norm();
            let along = ray.direction().normalize();
            let far = |p: Point| {
                let to = p - ray.origin();
                let off = (to - along * to.dot(&along)).norm();
                if apart < 1e-12 {
                    off.atan2(to.dot(&along))
                } else {
                    off
                }
            };
            let ends = self.pieces.iter();
            let ends =
                ends.flat_map(|(f, ends)| ends.iter().map(move |end| (far(end.0), self.chain[f])));
            let mut ends: Vec<(f64, usize)> = ends.collect();
            ends.sort_by(|a, b| a.0.total_cmp(&b.0));
            let next = ends
                .iter()
                .find(|end| Some(end.1) != ends.first().map(|first| first.1));
            if next.is_some_and(|next| next.0 - ends[0].0 < NEAR * edge) {
                return Err(Special);
            }
            chains[side] = ends.first().map(|end| end.1);
        }
        Ok(chains)
    }
}

/// The mean length of an edge.
fn mean_edge(mesh: &Mesh, points: &[Point]) -> f64 {
    let lengths = mesh
        .edges()
        .map(|h| (points[mesh.target(h).index()] - points[mesh.origin(h).index()]).norm());
    lengths.sum::<f64>() / mesh.edges().count() as f64
}

/// What was seen in many cuts.
#[derive(Debug, Default)]
struct Counts {
    cuts: usize,
    /// Of which some of what lies between the rays was left whole.
    chose: usize,
    /// Where the rays hit different chains.
    differed: usize,
    /// Where a ray missed.
    missed: usize,
    /// Where nothing was cut.
    nothing: usize,
    special: usize,
}

impl Counts {
    /// Cuts a mesh by the first layers, and holds it against the oracle.
    fn check(&mut self, mesh: &Mesh, positions: &Positions, rays: [Ray; 2], what: &str) {
        let Ok(scissor) = Scissor::new(rays[0], rays[1]) else {
            return;
        };
        let points = positions.as_slice();
        let edge = mean_edge(mesh, points);
        let judged = Oracle::new(mesh, points, &scissor, edge).and_then(|oracle| {
            let chains = oracle.first(mesh, points, &rays, edge)?;
            let missed = [0, 1].map(|i| {
                oracle
                    .hit(mesh, points, &rays[i], edge)
                    .is_ok_and(|hit| hit.is_none())
            });
            Ok((oracle, chains, missed))
        });
        let Ok((oracle, chains, missed)) = judged else {
            self.special += 1;
            return;
        };
        let kept: BTreeSet<usize> = oracle
            .pieces
            .keys()
            .copied()
            .filter(|f| chains.contains(&Some(oracle.chain[f])))
            .collect();
        let length_of = |f: &usize| (oracle.pieces[f][1].0 - oracle.pieces[f][0].0).norm();
        let length: f64 = kept.iter().map(length_of).sum();

        let scissor = scissor.snap(0.0).layers(CutLayers::First);
        let (mut after, mut at, mut edits) = (mesh.clone(), positions.clone(), Edits::new());
        let made = scissor.cut_measured(CutMethod::Exact, &mut after, &mut at, &mut edits);
        let (cut, report): (Cut, _) = made.expect("in step");
        assert_eq!(after.check(), [], "{what}");
        let mut divided = BTreeSet::new();
        for edit in edits.iter() {
            if let Edit::Insert(insert) = edit {
                divided.extend(insert.children.iter().map(|child| child.parent.index()));
            }
        }
        assert_eq!(divided, kept, "{what}: the faces divided");
        assert!(
            (report.seam_length - length).abs() < 1e-6 * edge,
            "{what}: {length}, {report:?}"
        );
        assert_eq!(report.faces_crossed, kept.len(), "{what}");
        assert!(report.separated, "{what}");
        let names = cut.layers().map(|hit| hit.map(|hit| hit.chain.index()));
        assert_eq!(names, chains, "{what}: the chains named");
        self.cuts += 1;
        self.chose += usize::from(oracle.pieces.len() > kept.len());
        self.differed += usize::from(chains[0] != chains[1]);
        self.missed += usize::from(missed[0] || missed[1]);
        self.nothing += usize::from(kept.is_empty());
    }
}

/// A sheet that is folded, once for each ridge.
fn folded(n: u32, ridges: f64, random: &mut Random) -> (Mesh, Positions) {
    let (mesh, flat) = shapes::grid_with_diagonals(n, n, |x, y| (x * y) % 3 == 1);
    let points = flat.as_slice().iter().map(|p| {
        let jitter = |random: &mut Random| 0.2 / f64::from(n) * (random.next() - 0.5);
        let turn = TAU * ridges * p.x;
        let x = 0.3 * p.x + 0.25 * turn.sin() + jitter(random);
        [x, p.y + jitter(random), 0.3 * turn.cos() + 0.3 * p.x]
    });
    let points: Vec<[f64; 3]> = points.collect();
    (mesh, Positions::new(points).expect("finite"))
}

/// A tube or a ball that is dented a little.
fn dented((mesh, smooth): (Mesh, Positions), random: &mut Random) -> (Mesh, Positions) {
    let points = smooth.as_slice().iter();
    let points =
        points.map(|p| p + Vector::new(random.next(), random.next(), random.next()) * 0.03);
    let points: Vec<Point> = points.collect();
    (mesh, Positions::new(points).expect("finite"))
}

/// Rays past random places of a mesh: parallel ones, or two from one eye.
fn random_rays(positions: &Positions, random: &mut Random) -> Option<[Ray; 2]> {
    let points = positions.as_slice();
    let mut pick = || points[random.below(points.len())];
    let (p, q) = (pick(), pick());
    let size = points
        .iter()
        .map(|r| (r - points[0]).norm())
        .fold(0.0, f64::max);
    let mut somewhere = || {
        Vector::new(
            random.next() - 0.5,
            random.next() - 0.5,
            random.next() - 0.5,
        )
    };
    let [p, q] = [p, q].map(|p| p + somewhere() * 0.3 * size);
    let back = somewhere().normalize() * 3.0 * size;
    let rays = if somewhere().x > 0.0 {
        let eye = p - back;
        [(eye, p - eye), (eye, q - eye)]
    } else {
        [(p - back, back), (q - back, back)]
    };
    let [a, b] = rays.map(|(origin, direction)| Ray::new(origin, direction).ok());
    Some([a?, b?])
}

/// Garments of the corpus, if there is one: `v` and `f` are all that is read of them.
fn garments() -> Vec<(String, (Mesh, Positions))> {
    let Some(folder) = std::env::var_os("TEARMESH_CORPUS") else {
        return Vec::new();
    };
    let names = [
        "tshirt", "dress", "pants", "robe", "sleeve", "karate", "cylinder",
    ];
    let read = |name: &str| {
        let path = std::path::Path::new(&folder).join(format!("arcsim_{name}.obj"));
        let text = std::fs::read_to_string(path).ok()?;
        let (mut points, mut faces) = (Vec::<[f64; 3]>::new(), Vec::<[u32; 3]>::new());
        for line in text.lines() {
            let words: Vec<&str> = line.split_whitespace().collect();
            match words.first() {
                Some(&"v") => points.push([1, 2, 3].map(|i| words[i].parse().expect("a number"))),
                Some(&"f") => {
                    let corner = |word: &&str| word.split('/').next()?.parse::<u32>().ok();
                    let corners: Vec<u32> = words[1..].iter().filter_map(corner).collect();
                    let fan = corners.windows(2).skip(1);
                    faces.extend(fan.map(|two| [corners[0] - 1, two[0] - 1, two[1] - 1]));
                }
                _ => {}
            }
        }
        let mesh = Mesh::build(points.len(), &faces).ok()?;
        Some((name.to_owned(), (mesh, Positions::new(points).ok()?)))
    };
    names.into_iter().filter_map(read).collect()
}

#[test]
fn the_first_layers_are_the_chains_that_brute_force_finds() {
    let mut random = Random(83);
    let mut tally = Counts::default();
    let mut meshes = vec![
        ("folded", folded(14, 2.0, &mut random)),
        ("much folded", folded(24, 4.0, &mut random)),
        ("sleeve", dented(shapes::tube(14, 7), &mut random)),
        ("torus", dented(shapes::torus(16, 10), &mut random)),
    ];
    let own = meshes.len();
    let garments = garments();
    meshes.extend(
        garments
            .iter()
            .map(|(name, garment)| (&**name, garment.clone())),
    );
    for (kind, (name, (mesh, positions))) in meshes.iter().enumerate() {
        for i in 0..if kind < own { 200 } else { 60 } {
            if let Some(rays) = random_rays(positions, &mut random) {
                tally.check(mesh, positions, rays, &format!("{name} {i}: {rays:?}"));
            }
        }
    }
    println!("{tally:?}, on {} garments", garments.len());
    assert!(tally.cuts > 700 && tally.chose > 300, "{tally:?}");
    assert!(tally.differed > 20 && tally.missed > 100, "{tally:?}");
}

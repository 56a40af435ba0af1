//! Cuts through the layers that the rays meet first, against chains that are found by brute force.
//!
//! The oracle knows triangles and numbers: it takes what plane and strip have in common with each triangle from
//! the oracle of straight cuts, joins those that share an edge which is crossed between the rays, and asks each
//! triangle where a ray hits it.

mod methods;

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use tearmesh::{CutLayers, CutMethod, Edit, Mesh, Point, Positions, Ray, Scissor, Vector, shapes};

use crate::oracle::joined_sets;
use crate::oracle::straight::{Cut, End, Surface, is_generic, length, minus, segments};
use crate::random::Random;
use crate::surfaces::{built, corpus, read};
use crate::work::{Work, triangles};

/// How near a special case a cut may be, in edges, for the oracle to judge it.
const NEAR: f64 = 1e-6;

/// What plane and strip have in common with the triangles of a mesh.
struct Oracle {
    surface: Surface,
    near: f64,
    /// For each crossed face the ends of what lies between the rays.
    pieces: BTreeMap<usize, [End; 2]>,
    /// The number of each piece's chain.
    chain: BTreeMap<usize, usize>,
    /// By vertex, the one that it was before any cut.
    roots: Vec<u32>,
}

/// Whether a cut comes too near to a special case.
struct Special;

impl Oracle {
    fn new(work: &Work, cut: &Cut) -> Result<Oracle, Special> {
        let surface = work.surface();
        if !is_generic(&surface, cut) {
            return Err(Special);
        }
        let mut oracle = Oracle {
            near: NEAR * surface.mean_edge(),
            pieces: segments(&surface, cut),
            chain: BTreeMap::new(),
            roots: work.mesh.roots(),
            surface,
        };
        oracle.join();
        Ok(oracle)
    }

    /// Numbers the chains: pieces that share an edge have one number. The two sides of a tear that has
    /// not opened are one edge.
    fn join(&mut self) {
        let mut first = BTreeMap::new();
        let mut joined = Vec::new();
        for (&f, ends) in &self.pieces {
            let place = |v: u32| {
                let at = self.surface.points[v as usize];
                (self.roots[v as usize], at.map(f64::to_bits))
            };
            let edge = |ends: [u32; 2]| {
                let [a, b] = ends.map(place);
                [a.min(b), a.max(b)]
            };
            let edges = ends.iter().filter_map(|end| end.1.map(edge));
            joined.extend(edges.map(|edge| [f, *first.entry(edge).or_insert(f)]));
        }
        let chain = joined_sets(self.surface.faces.len(), &joined);
        self.chain = self.pieces.keys().map(|&f| (f, chain[f])).collect();
    }

    /// The face that a ray hits first.
    fn hit(&self, ray: &Ray) -> Result<Option<usize>, Special> {
        let mut hits: Vec<(f64, usize)> = Vec::new();
        let along = ray.direction().normalize();
        for (f, triangle) in self.surface.faces.iter().enumerate() {
            let [a, b, c] = triangle.map(|v| Point::from(self.surface.points[v as usize]));
            let normal = (b - a).cross(&(c - a));
            let upright = normal.dot(&along);
            if upright.abs() <= 1e-12 * normal.norm() {
                continue;
            }
            let t = normal.dot(&(a - ray.origin())) / upright;
            let at = ray.origin() + along * t;
            let inside = [(a, b), (b, c), (c, a)].map(|(p, q)| {
                (q - p).cross(&(at - p)).dot(&normal) / (normal.norm() * (q - p).norm())
            });
            let least = inside.into_iter().fold(f64::INFINITY, f64::min);
            if least.abs() < self.near {
                return Err(Special);
            }
            if t > 0.0 && least > 0.0 {
                hits.push((t, f));
            }
        }
        hits.sort_by(|a, b| a.0.total_cmp(&b.0));
        match hits[..] {
            [one, other, ..] if other.0 - one.0 < self.near => Err(Special),
            _ => Ok(hits.first().map(|&(_, f)| f)),
        }
    }

    /// The chain to be cut for a ray, and whether the ray hits it.
    fn first(&self, ray: &Ray, other: &Ray) -> Result<(Option<usize>, bool), Special> {
        if let Some(f) = self.hit(ray)? {
            // A ray through the tip of a piece: the piece is there, or ends at that very place.
            let chain = *self.chain.get(&f).ok_or(Special)?;
            return Ok((Some(chain), true));
        }
        // The ray of the pencil that comes to it first, by the angle at the eye or the distance.
        let apart = (ray.origin() - other.origin()).norm();
        let along = ray.direction().normalize();
        let far = |p: Point| {
            let to = p - ray.origin();
            let off = (to - along * to.dot(&along)).norm();
            match apart < 1e-12 {
                true => off.atan2(to.dot(&along)),
                false => off,
            }
        };
        let ends = self.pieces.iter().flat_map(|(f, ends)| {
            let chain = self.chain[f];
            ends.iter().map(move |end| (Point::from(end.0), chain))
        });
        let mut ends: Vec<(f64, usize)> = ends.map(|(p, chain)| (far(p), chain)).collect();
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        let first = ends.first().copied();
        let next = ends
            .iter()
            .find(|end| Some(end.1) != first.map(|end| end.1));
        match (first, next) {
            (Some(first), Some(next)) if next.0 - first.0 < self.near => Err(Special),
            _ => Ok((first.map(|end| end.1), false)),
        }
    }
}

/// The cut of two rays, for the oracle.
fn cut_of(rays: &[Ray; 2]) -> Cut {
    let plain = |ray: &Ray| (ray.origin().into(), ray.direction().into());
    Cut::between(rays.each_ref().map(plain))
}

/// What two rays are to cut of a mesh.
struct Choice {
    scissor: Scissor,
    oracle: Oracle,
    chains: [Option<usize>; 2],
    has_missed: bool,
    /// The faces of these chains.
    kept: BTreeSet<usize>,
}

impl Choice {
    /// None if the rays are one line, or come too near to a special case.
    fn of(work: &Work, rays: [Ray; 2]) -> Option<Choice> {
        let scissor = Scissor::new(rays[0], rays[1]).ok()?;
        let oracle = Oracle::new(work, &cut_of(&rays)).ok()?;
        let [a, b] = rays;
        let [one, other] = [oracle.first(&a, &b).ok()?, oracle.first(&b, &a).ok()?];
        let chains = [one.0, other.0];
        let faces = oracle.pieces.keys().copied();
        let kept = faces.filter(|f| chains.contains(&Some(oracle.chain[f])));
        Some(Choice {
            kept: kept.collect(),
            scissor,
            chains,
            has_missed: !(one.1 && other.1),
            oracle,
        })
    }
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
}

impl Counts {
    /// Cuts a mesh by the first layers, and holds it against the oracle.
    fn check(&mut self, work: &Work, rays: [Ray; 2]) {
        let Some(choice) = Choice::of(work, rays) else {
            return;
        };
        let Choice { oracle, kept, .. } = &choice;
        let length_of = |f: &usize| length(minus(oracle.pieces[f][1].0, oracle.pieces[f][0].0));
        let length: f64 = kept.iter().map(length_of).sum();
        let scissor = choice.scissor.clone().with_snap(0.0);
        let scissor = scissor.with_layers(CutLayers::First);
        let mut after = work.clone();
        let (cut, report) = after.cut(CutMethod::Exact, &scissor);
        let mut divided = BTreeSet::new();
        for edit in &after.edits {
            if let Edit::Insert(insert) = edit {
                divided.extend(insert.children.iter().map(|child| child.parent.index()));
            }
        }
        assert_eq!(divided, *kept, "{rays:?}: the faces divided");
        let off = (report.seam_length - length).abs();
        assert!(off < oracle.near, "{rays:?}: {length}, {report:?}");
        assert_eq!(report.faces_crossed, kept.len(), "{rays:?}");
        assert!(report.separated, "{rays:?}");
        let names = cut.layers().map(|hit| hit.map(|hit| hit.chain.index()));
        assert_eq!(names, choice.chains, "{rays:?}: the chains named");
        self.cuts += 1;
        self.chose += usize::from(oracle.pieces.len() > kept.len());
        self.differed += usize::from(choice.chains[0] != choice.chains[1]);
        self.missed += usize::from(choice.has_missed);
    }
}

/// A sheet that is folded, once for each ridge.
fn folded(n: u32, ridges: f64, random: &mut Random) -> Work {
    let (mesh, flat) = shapes::grid_with_diagonals(n, n, |x, y| (x * y) % 3 == 1);
    let points = flat.as_slice().iter().map(|p| {
        let jitter = |random: &mut Random| 0.2 / f64::from(n) * (random.next() - 0.5);
        let turn = TAU * ridges * p.x;
        let x = 0.3 * p.x + 0.25 * turn.sin() + jitter(random);
        [x, p.y + jitter(random), 0.3 * turn.cos() + 0.3 * p.x]
    });
    let positions = Positions::new(points.collect::<Vec<_>>()).expect("finite");
    Work::new((mesh, positions))
}

/// A tube or a ball that is dented a little.
fn dented((mesh, smooth): (Mesh, Positions), random: &mut Random) -> Work {
    let mut dent = |p: &Point| p + Vector::from([(); 3].map(|()| random.next())) * 0.03;
    let points: Vec<Point> = smooth.as_slice().iter().map(&mut dent).collect();
    Work::new((mesh, Positions::new(points).expect("finite")))
}

/// Rays past random places of a mesh: parallel ones, or two from one eye.
fn random_rays(positions: &Positions, random: &mut Random) -> Option<[Ray; 2]> {
    let points = positions.as_slice();
    let mut pick = || points[random.below(points.len())];
    let (p, q) = (pick(), pick());
    let sizes = points.iter().map(|r| (r - points[0]).norm());
    let size = sizes.fold(0.0, f64::max);
    let mut somewhere = || Vector::from([(); 3].map(|()| random.next() - 0.5));
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

/// Folded sheets, a tube and a torus, and garments of the corpus if there is one, with random rays.
fn for_rays(seed: u64, count: usize, mut visit: impl FnMut(&Work, [Ray; 2])) {
    let mut random = Random(seed);
    let mut all = vec![
        folded(14, 2.0, &mut random),
        folded(24, 4.0, &mut random),
        dented(shapes::tube(14, 7), &mut random),
        dented(shapes::torus(16, 10), &mut random),
    ];
    // The robe of that corpus has vertices where fans only touch, and is no mesh.
    let names = ["tshirt", "dress", "pants", "sleeve", "karate", "cylinder"];
    let names = names.map(|name| format!("arcsim_{name}"));
    let garments = corpus(&names.each_ref().map(|name| &**name)).into_iter();
    all.extend(garments.map(|path| Work::new(built(&read(&path)))));
    for (kind, work) in all.iter().enumerate() {
        for _ in 0..if kind < 4 { count } else { count / 3 } {
            if let Some(rays) = random_rays(&work.positions, &mut random) {
                visit(work, rays);
            }
        }
    }
}

#[test]
fn first_layers_are_the_chains_that_brute_force_finds() {
    let mut counts = Counts::default();
    for_rays(83, 200, |work, rays| counts.check(work, rays));
    assert!(counts.cuts > 700 && counts.chose > 300, "{counts:?}");
    assert!(counts.differed > 20 && counts.missed > 100, "{counts:?}");
}

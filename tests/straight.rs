//! The oracle of the straight cut, put to the test: it accepts what a second, naive
//! implementation makes of every kind of surface, and finds every bug that is put into it.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use tearmesh::{CutReport, Mesh, Point, Positions, Ray, Scissor, Vector, shapes};

use crate::delaunay;
use crate::oracle::naive_cut;
use crate::oracle::spoil::{BUGS, Bug, spoil};
use crate::oracle::straight::{
    Check, Cut, Facts, Fault, Surface, is_generic, judge, least_fraction,
};
use crate::random::Random;

/// Two rays: an origin and a direction each.
pub(crate) type Rays = [([f64; 3], [f64; 3]); 2];

/// Generic cuts that each surface gets.
const CUTS: usize = 24;

/// What the oracle is to see of a mesh.
pub(crate) fn surface((mesh, positions): &(Mesh, Positions)) -> Surface {
    Surface {
        points: positions.as_slice().iter().map(|&p| p.into()).collect(),
        faces: mesh
            .indices()
            .chunks(3)
            .map(|f| [f[0], f[1], f[2]])
            .collect(),
    }
}

/// The mesh of a surface. Edges that were torn are plain boundary in it.
pub(crate) fn built(surface: &Surface) -> (Mesh, Positions) {
    let mesh = Mesh::build(surface.points.len(), &surface.faces).expect("a manifold");
    let positions = Positions::new(surface.points.clone()).expect("finite");
    (mesh, positions)
}

pub(crate) fn jittered(n: u32, random: &mut Random) -> Surface {
    let mut sheet = surface(&shapes::grid_with_diagonals(n, n, |x, y| (x * y) % 3 == 1));
    let by = 0.48 / f64::from(n);
    for [x, y, z] in &mut sheet.points {
        if [*x, *y].iter().all(|c| *c > 0.0 && *c < 1.0) {
            *x += by * (random.next() - 0.5);
            *y += by * (random.next() - 0.5);
        }
        *z = 0.1 * (*x + 2.0 * *y * *x);
    }
    sheet
}

/// Random points in the unit square with so many on each side, and their triangles.
pub(crate) fn delaunay(count: usize, border: u32, random: &mut Random) -> Surface {
    let points = delaunay::points(count, border, 0.6 / (count as f64).sqrt(), random);
    let faces = delaunay::triangles(&points).into_iter();
    Surface {
        faces: faces.map(|t| t.map(|i| i as u32)).collect(),
        points: points.into_iter().map(|[x, y]| [x, y, 0.0]).collect(),
    }
}

/// An octahedron, subdivided and blown up.
fn sphere(times: usize) -> Surface {
    let mut sphere = surface(&shapes::octahedron());
    for _ in 0..times {
        let mut middles = BTreeMap::new();
        let mut faces = Vec::new();
        for [a, b, c] in sphere.faces {
            let [d, e, f] = [(b, c), (c, a), (a, b)].map(|(v, w)| {
                let edge = (v.min(w), v.max(w));
                *middles.entry(edge).or_insert_with(|| {
                    let [p, q] = [v, w].map(|v| sphere.points[v as usize]);
                    let sum = [p[0] + q[0], p[1] + q[1], p[2] + q[2]];
                    let size = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                    sphere.points.push(sum.map(|x| x / size));
                    sphere.points.len() as u32 - 1
                })
            });
            faces.extend([[a, f, e], [b, d, f], [c, e, d], [d, e, f]]);
        }
        sphere.faces = faces;
    }
    sphere
}

/// Surfaces with names. One was cut before, so that some of its edges are torn.
pub(crate) fn surfaces() -> Vec<(&'static str, Surface)> {
    let mut random = Random(11);
    let mut torn = jittered(9, &mut random);
    for (a, b) in [([0.21, 0.13], [0.69, 0.77]), ([-0.5, 0.61], [1.5, 0.43])] {
        torn = naive_cut::cut(&torn, &Cut::between([down(a), down(b)]));
    }
    vec![
        ("triangle", surface(&shapes::triangle())),
        ("grid", surface(&shapes::grid(9, 9))),
        ("jittered", jittered(10, &mut random)),
        ("random", delaunay(150, 9, &mut random)),
        ("torn", torn),
        ("sleeve", surface(&shapes::tube(12, 6))),
        ("sphere", sphere(2)),
        ("torus", surface(&shapes::torus(14, 9))),
    ]
}

/// A ray down on a point of the plane z = 0.
pub(crate) fn down([x, y]: [f64; 2]) -> ([f64; 3], [f64; 3]) {
    ([x, y, 5.0], [0.0, 0.0, -1.0])
}

/// Two rays that pass a random vertex at a random distance: parallel ones, anti-parallel ones,
/// or two from one eye.
fn random_rays(before: &Surface, random: &mut Random) -> Rays {
    let mut random = || random.next();
    let pick = before.points[(random() * before.points.len() as f64) as usize];
    let edge = before.mean_edge();
    let turn = TAU * random();
    let half = edge * [0.1, 0.8, 2.5, 6.0][(4.0 * random()) as usize];
    let (x, y) = (turn.cos(), turn.sin());
    let mut target = |side: f64| {
        let along = side * half * (0.5 + random());
        let [mut a, mut b, mut c] = [0.0; 3].map(|_| 0.1 * edge * (random() - 0.5));
        [a, b, c] = [a + along * x, b + along * y, c + 0.3 * along];
        [pick[0] + a, pick[1] + b, pick[2] + c]
    };
    let (p, q) = (target(-1.0), target(1.0));
    let way = [random() - 0.5, random() - 0.5, -1.0];
    let origin = |p: [f64; 3], far: f64| [0, 1, 2].map(|i| p[i] - far * way[i]);
    match (4.0 * random()) as usize {
        0 => {
            let eye = origin(pick, 3.0);
            [p, q].map(|p| (eye, [0, 1, 2].map(|i| p[i] - eye[i])))
        }
        1 => [
            (origin(p, 4.0), way),
            (origin(q, -3.0), way.map(|x: f64| -x)),
        ],
        _ => [(origin(p, 3.0), way), (origin(q, 4.0), way)],
    }
}

/// A surface before and after a cut.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) before: Surface,
    rays: Rays,
    pub(crate) cut: Cut,
    after: Surface,
}

impl Case {
    pub(crate) fn scissor(&self) -> Scissor {
        let [a, b] = self.rays.map(|(origin, along)| {
            Ray::new(Point::from(origin), Vector::from(along)).expect("a ray")
        });
        let scissor = Scissor::new(a, b).expect("a plane");
        scissor.through(self.cut.sides.is_empty())
    }
}

/// Rays of a generic cut that meets a surface; one in four goes through.
pub(crate) fn random_generic_rays(before: &Surface, random: &mut Random) -> (Rays, Cut) {
    loop {
        let rays = random_rays(before, random);
        let mut cut = Cut::between(rays);
        if random.next() < 0.25 {
            cut = cut.through();
        }
        if is_generic(before, &cut) && naive_cut::cut(before, &cut) != *before {
            return (rays, cut);
        }
    }
}

/// A number of generic cuts of each surface, made by the naive implementation.
pub(crate) fn cases(cuts: usize) -> Vec<Case> {
    let mut random = Random(5);
    let mut cases = Vec::new();
    for (name, before) in surfaces() {
        for _ in 0..cuts {
            let (rays, cut) = random_generic_rays(&before, &mut random);
            cases.push(Case {
                name,
                after: naive_cut::cut(&before, &cut),
                before: before.clone(),
                rays,
                cut,
            });
        }
    }
    cases
}

pub(crate) fn said(faults: &[Fault]) -> String {
    let faults: Vec<_> = faults.iter().take(5).map(Fault::to_string).collect();
    faults.join("; ")
}

#[test]
fn no_straight_cut_is_called_wrong() {
    let mut found = BTreeMap::<_, Vec<Facts>>::new();
    let mut alarms = Vec::new();
    let cases = cases(CUTS);
    for case in &cases {
        match judge(&case.before, &case.cut, &case.after) {
            Ok(facts) => found.entry(case.name).or_default().push(facts),
            Err(faults) => alarms.push(format!("{}: {}", case.name, said(&faults))),
        }
    }
    for (name, facts) in &found {
        let sum = |count: fn(&Facts) -> usize| facts.iter().map(count).sum::<usize>();
        println!(
            "{name:9} {:3} cuts, {:3} tips, {:3} ends on the boundary, {:3} chains, {:3} pieces, \
             seam {:6.2}, off by {:.0e} edges at most",
            facts.len(),
            sum(|facts| facts.tips),
            sum(|facts| facts.boundary_ends),
            sum(|facts| facts.chains),
            sum(|facts| facts.pieces),
            facts.iter().map(|facts| facts.seam_length).sum::<f64>(),
            facts
                .iter()
                .fold(0.0, |most, facts| facts.deviation_max_edges.max(most)),
        );
    }
    assert_eq!(
        alarms,
        Vec::<String>::new(),
        "{} false alarms in {} cuts",
        alarms.len(),
        cases.len()
    );
    assert!(cases.len() >= 80, "only {} cuts", cases.len());
    // There is something of everything.
    let all: Vec<Facts> = found.into_values().flatten().collect();
    let some = |what: fn(&Facts) -> bool| all.iter().any(what);
    assert!(some(|facts| facts.tips == 0 && facts.boundary_ends == 0));
    assert!(some(|facts| facts.tips == 1 && facts.boundary_ends == 1));
    assert!(some(|facts| facts.tips == 2 && facts.boundary_ends == 0));
    assert!(some(|facts| facts.boundary_ends > 2));
    assert!(some(|facts| facts.chains > 1));
    assert!(some(|facts| facts.pieces > 2));
}

#[test]
fn every_bug_of_a_straight_cut_is_found() {
    let mut random = Random(3);
    let mut random = || random.next();
    let mut tries = BTreeMap::<Bug, usize>::new();
    let mut found_by = BTreeMap::<Bug, BTreeMap<Check, usize>>::new();
    let mut missed = Vec::new();
    for case in cases(CUTS) {
        for bug in BUGS {
            let spoilt = spoil(&case.before, &case.cut, &case.after, bug, &mut random);
            let Some(spoilt) = spoilt else { continue };
            *tries.entry(bug).or_default() += 1;
            match judge(&case.before, &case.cut, &spoilt) {
                Ok(facts) => missed.push(format!("{bug:?} in {}: {facts:?}", case.name)),
                Err(faults) => {
                    let checks: BTreeSet<_> = faults.iter().map(|fault| fault.check).collect();
                    for check in checks {
                        *found_by.entry(bug).or_default().entry(check).or_default() += 1;
                    }
                }
            }
        }
    }
    for (bug, checks) in &found_by {
        println!("{bug:?} in {} cuts, found by {checks:?}", tries[bug]);
    }
    let total: usize = tries.values().sum();
    let nine: usize = BUGS[..9].iter().map(|bug| tries[bug]).sum();
    println!("{nine} of the nine bugs, {total} bugs in all");
    assert_eq!(
        missed,
        Vec::<String>::new(),
        "{} of {total} bugs were not found",
        missed.len()
    );
    for bug in BUGS {
        let tried = tries.get(&bug).copied().unwrap_or(0);
        assert!(tried >= 80, "{bug:?} was tried only {tried} times");
    }
    // A check that never fails is none.
    let checks: BTreeSet<Check> = found_by
        .values()
        .flat_map(|by| by.keys().copied())
        .collect();
    assert_eq!(checks.len(), 14, "only {checks:?} found anything");
}

#[test]
fn only_cuts_away_from_every_special_case_are_generic() {
    let grid = surface(&shapes::grid(4, 4));
    let between = |a, b| Cut::between([down(a), down(b)]);
    let generic = between([0.3, 0.2], [0.4, 0.85]);
    assert!(is_generic(&grid, &generic));
    for (why, cut) in [
        ("a vertex on the plane", between([0.25, 0.2], [0.25, 0.9])),
        ("almost", between([0.25, 0.2], [0.25 + 1e-8, 0.9])),
        ("a tip on an edge", between([0.3, 0.25], [0.3, 0.9])),
        (
            "both tips in one place",
            between([0.3, 0.2], [0.3, 0.2 + 1e-8]),
        ),
    ] {
        assert!(!is_generic(&grid, &cut), "{why}");
    }
    // Vertices on the plane that no face joins with the strip are no obstacle.
    let diagonal = between([-0.6, -0.6], [-0.7, -0.7]);
    assert!(is_generic(&grid, &diagonal));
    assert!(!is_generic(&grid, &diagonal.through()));
}

#[test]
fn a_snap_below_the_least_fraction_changes_nothing() {
    let triangle = surface(&shapes::triangle());
    let between = |a, b| Cut::between([down(a), down(b)]);
    let crossing = between([0.3, -1.0], [0.3, 2.0]);
    assert!((least_fraction(&triangle, &crossing) - 0.3).abs() < 1e-15);
    // What plane and face have in common is 0.7 long, and the tip lies at 0.1.
    let begun = between([0.3, 0.1], [0.3, 2.0]);
    assert!((least_fraction(&triangle, &begun) - 0.1 / 0.7).abs() < 1e-15);
    let inside = between([0.3, 0.3], [0.3, 0.35]);
    assert!((least_fraction(&triangle, &inside) - 0.05 / 0.7).abs() < 1e-15);
}

#[test]
fn oracle_and_scissor_read_rays_alike() {
    for case in cases(CUTS) {
        let scissor = case.scissor();
        let cut = Cut::between(case.rays);
        let [one, other] = scissor.sides().expect("there are rays");
        let planes = [scissor.plane(), one, other];
        for (flat, plane) in [cut.plane, cut.sides[0], cut.sides[1]].iter().zip(planes) {
            for p in &case.before.points {
                let apart = flat.distance(*p) - plane.distance(Point::from(*p));
                assert!(apart.abs() < 1e-13, "{:?}: {apart}", case.rays);
            }
        }
    }
}

#[test]
fn what_the_naive_implementation_makes_is_a_mesh() {
    for case in cases(CUTS) {
        let facts = judge(&case.before, &case.cut, &case.after).expect("no false alarm");
        let (mesh, _) = built(&case.after);
        assert_eq!(mesh.check(), []);
        assert_eq!(mesh.components().count(), facts.pieces);
    }
}

/// Asserts that the smallest angle and the smallest altitude reported are those of a plain loop.
pub(crate) fn is_worst_of_faces(
    report: &CutReport,
    mesh: &Mesh,
    positions: &Positions,
    name: &str,
) {
    let (mut angle, mut altitude) = (f64::INFINITY, f64::INFINITY);
    for f in mesh.faces() {
        let corners = mesh.face_vertices(f).map(|v| positions.at(v));
        for i in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
            angle = angle.min((b - a).angle(&(c - a)).to_degrees());
            let (along, across) = ((b - a).normalize(), c - a);
            altitude = altitude.min((across - along * across.dot(&along)).norm());
        }
    }
    let told = [report.angle_min_deg, report.altitude_min];
    assert!((told[0] - angle).abs() < 1e-5, "{name}: {told:?}, {angle}");
    assert!(
        (told[1] - altitude).abs() < 1e-9,
        "{name}: {told:?}, {altitude}"
    );
}

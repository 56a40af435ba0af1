//! Polylines run between their rays, wherever these come from.
//!
//! Rays from one eye, from eyes a rounding error to four units apart, parallel, converging and crossing ones
//! go through the corners of a polyline on flat, folded and closed meshes. What each cut tore is judged
//! by picking and by closest points, in plain formulas: it comes near the two points at which its rays
//! are aimed, and no part of it lies beyond either ray.

use std::f64::consts::TAU;

use tearmesh::{
    CutAim, CutEnd, CutError, CutLayers, CutMethod, CutReport, Edit, Edits, HalfEdgeId, Mesh,
    Positions, Scissor, ScissorError,
};

use crate::cases::cases;
use crate::oracle::aim::{Line, aimed, beyond, distance};
use crate::oracle::straight::{Surface, cross, dot, length, minus, on_the_way};
use crate::random::Random;
use crate::surfaces::{built, delaunay, jittered, sphere, surface};
use crate::work::ray;

type Point = [f64; 3];

/// Where the rays of a polyline come from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Eyes {
    Parallel,
    /// All from points in a ball with this radius, in units of the mesh.
    Ball(f64),
    /// From points as far apart as this many times their targets: they meet beyond the mesh, or, if this
    /// is negative, have crossed before it.
    Spread(f64),
}

const EYES: [Eyes; 13] = [
    Eyes::Parallel,
    Eyes::Ball(0.0),
    Eyes::Ball(1e-15),
    Eyes::Ball(1e-12),
    Eyes::Ball(1e-9),
    Eyes::Ball(1e-6),
    Eyes::Ball(1e-3),
    Eyes::Ball(0.1),
    Eyes::Ball(1.0),
    Eyes::Ball(4.0),
    Eyes::Spread(1.3),
    Eyes::Spread(0.4),
    Eyes::Spread(-0.5),
];

const SNAPS: [f64; 6] = [Scissor::SNAP, 0.0, 0.01, 0.2, 0.35, 0.49];

/// Flat meshes, folded ones, and closed ones.
fn meshes() -> Vec<(&'static str, Surface)> {
    let mut random = Random(41);
    let folded = |by: fn(f64, f64) -> Point| {
        let mut sheet = jittered(12, &mut Random(7));
        for p in &mut sheet.points {
            *p = by(p[0], p[1]);
        }
        sheet
    };
    vec![
        ("grid", surface(&tearmesh::shapes::grid(12, 12))),
        ("jittered", jittered(11, &mut random)),
        ("random", delaunay(200, 10, &mut random)),
        (
            "waves",
            folded(|x, y| [x, y, 0.12 * (9.0 * x).sin() * (5.0 * y).cos()]),
        ),
        ("roof", folded(|x, y| [x, y, -1.5 * (x - 0.5).abs()])),
        (
            "doubled",
            folded(|x, y| {
                let angle = TAU * 0.75 * (x - 0.5);
                [0.3 * angle.sin(), y, 0.3 * angle.cos()]
            }),
        ),
        ("sphere", sphere(3)),
        ("torus", surface(&tearmesh::shapes::torus(18, 10))),
        ("tube", surface(&tearmesh::shapes::tube(14, 8))),
    ]
}

/// A view of a mesh.
struct View {
    eyes: Eyes,
    middle: Point,
    axes: [Point; 3],
}

impl View {
    /// A view from above, tilted by chance.
    fn of(mesh: &Surface, eyes: Eyes, random: &mut Random) -> View {
        let count = mesh.points.len() as f64;
        let sum = |i: usize| mesh.points.iter().map(|p| p[i]).sum::<f64>();
        let [x, y] = [0.0; 2].map(|_: f64| 0.8 * (random.next() - 0.5));
        let ahead = [x, y, -1.0];
        let across = cross(ahead, [0.0, 1.0, 0.0]);
        View {
            eyes,
            middle: [0, 1, 2].map(|i| sum(i) / count),
            axes: [across, cross(across, ahead), ahead].map(|v| v.map(|x| x / length(v))),
        }
    }

    fn place(&self, at: Point) -> Point {
        let along = |i: usize| {
            (0..3)
                .map(|axis| at[axis] * self.axes[axis][i])
                .sum::<f64>()
        };
        [0, 1, 2].map(|i| self.middle[i] + along(i))
    }

    /// A ray through a point of the picture.
    fn ray(&self, [x, y]: [f64; 2], random: &mut Random) -> Line {
        let origin = match self.eyes {
            Eyes::Parallel => self.place([x, y, -3.0]),
            Eyes::Ball(radius) => self
                .place([0.2, -0.1, -3.0])
                .map(|x| x + radius * (random.next() - 0.5)),
            Eyes::Spread(times) => self.place([times * x, times * y, -3.0]),
        };
        (origin, minus(self.place([x, y, 0.0]), origin))
    }
}

/// The rays of a polyline that stays on a mesh: from `count` to twice as many if there is room.
fn polyline(mesh: &Surface, view: &View, count: usize, random: &mut Random) -> Vec<Line> {
    let step = mesh.mean_edge() * [0.6, 1.0, 2.0, 4.0][random.below(4)];
    let (mut lines, mut at, mut heading) = (Vec::new(), [0.0; 2], TAU * random.next());
    for _ in 0..20 * count {
        let next = match lines.is_empty() {
            true => [0.0; 2].map(|_: f64| 0.8 * (random.next() - 0.5)),
            false => {
                let size = step * (0.5 + random.next());
                [at[0] + size * heading.cos(), at[1] + size * heading.sin()]
            }
        };
        heading += 1.6 * (random.next() - 0.5);
        let line = view.ray(next, random);
        if aimed(line, mesh, -1e-9).is_none() {
            heading += 1.0;
            continue;
        }
        at = next;
        lines.push(line);
        if lines.len() > count {
            break;
        }
    }
    lines
}

/// A polyline on a mesh, and how it is cut.
struct Case {
    name: &'static str,
    before: Surface,
    lines: Vec<Line>,
    snap: f64,
    moves: bool,
    layers: CutLayers,
}

/// What became of the cuts.
#[derive(Debug, Default)]
struct Counts {
    cuts: usize,
    uncut: usize,
    refused: usize,
    missed: usize,
    ambiguous: usize,
    /// Cuts of which the middle between the aims was judged.
    middles: usize,
    /// The farthest that a seam went beyond a ray, in longest edges.
    beyond: f64,
}

impl Case {
    fn new(meshes: &[(&'static str, Surface)], eyes: Eyes, snap: f64, random: &mut Random) -> Case {
        // Across a fold the way between rays from so far apart leaves the strip and comes back.
        let first = if eyes == Eyes::Ball(4.0) {
            3
        } else {
            meshes.len()
        };
        let &(name, ref before) = &meshes[random.below(first)];
        let view = View::of(before, eyes, random);
        let count = 3 + random.below(22);
        Case {
            name,
            before: before.clone(),
            lines: polyline(before, &view, count, random),
            snap,
            moves: random.next() < 0.3,
            layers: [CutLayers::All, CutLayers::First][random.below(2)],
        }
    }

    /// Cuts along the polyline as a user would: what is too short to be cut is left out.
    fn cut(&self, counts: &mut Counts) {
        let (mut mesh, mut positions): (Mesh, Positions) = built(&self.before);
        let (mut edits, mut from, mut end) = (Edits::new(), 0, None::<CutEnd>);
        for to in 1..self.lines.len() {
            let pair = [self.lines[from], self.lines[to]];
            let scissor = match &end {
                Some(end) => Scissor::continued(end, ray(pair[1]), &positions),
                None => Scissor::new(ray(pair[0]), ray(pair[1])),
            };
            let Ok(scissor) = scissor else {
                assert_eq!(scissor.err(), Some(ScissorError::NoLength));
                counts.refused += 1;
                continue;
            };
            let scissor = scissor
                .with_snap(self.snap)
                .with_snap_move(self.moves)
                .with_layers(self.layers);
            let before = surface(&(mesh.clone(), positions.clone()));
            let made =
                scissor.cut_measured(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
            let (made, report) = match made {
                Ok(made) => made,
                Err(CutError::TooShort { .. } | CutError::RaysCross { .. }) => {
                    counts.refused += 1;
                    continue;
                }
                Err(error) => panic!("{error}"),
            };
            counts.cuts += 1;
            counts.uncut += usize::from(report.splits == 0);
            self.judge(pair, &before, (&mesh, &positions), &edits, &report, counts);
            end = made.ends().map(|[_, end]| end.clone());
            from = to;
            edits.clear();
        }
    }

    /// No part of what was torn lies beyond a ray, and what does not come near an aim says so.
    fn judge(
        &self,
        pair: [Line; 2],
        before: &Surface,
        (mesh, positions): (&Mesh, &Positions),
        edits: &Edits,
        report: &CutReport,
        counts: &mut Counts,
    ) {
        let longest = before.longest_edge();
        let edge = |h: HalfEdgeId| [h, h.next()].map(|h| positions.at(mesh.origin(h)).into());
        let mut torn: Vec<[Point; 2]> = Vec::new();
        for edit in edits {
            let Edit::Split(split) = edit else { continue };
            torn.extend(split.torn.iter().map(|link| edge(link.stayed)));
        }
        for &p in torn.as_flattened() {
            counts.beyond = counts.beyond.max(beyond(pair, p) / longest);
        }
        if report.splits == 0 {
            return;
        }
        let all = mesh.half_edges().filter(|&h| mesh.ghost_pair(h).is_some());
        let all: Vec<[Point; 2]> = all.map(edge).collect();
        self.judge_middle(pair, before, &all, counts);
        let aims = report.aims.expect("a cut between rays");
        for (line, aim) in pair.into_iter().zip(aims) {
            let rounding = 1e-9;
            let Some(at) = aimed(line, before, -rounding) else {
                continue;
            };
            let is_same = |aim: &CutAim| length(minus(at, aim.at.into())) <= 1e-6;
            let Some(aim) = aim.filter(is_same) else {
                // It passes through a torn vertex or edge, or an edge beyond which no face is seen.
                assert!(aim.is_some() || aimed(line, before, rounding).is_none());
                counts.ambiguous += 1;
                continue;
            };
            let least = |of: &[[Point; 2]]| {
                let far = of.iter().map(|&edge| distance(edge, at));
                far.fold(f64::INFINITY, f64::min)
            };
            // Of what was torn before, only that along the plane counts.
            let [aside, most] = [&all, &torn].map(|of| least(of));
            let counts_aside = aside - 1e-6..most + 1e-6;
            let is_so = counts_aside.contains(&aim.aside);
            assert!(is_so, "{}: {aside} to {most} aside, not {aim:?}", self.name);
            counts.missed += usize::from(aim.is_missed());
            let near = 2.0 * self.snap * longest + 1e-9;
            assert!(
                most <= near || aim.aside <= near || aim.is_missed(),
                "{}: {most}, {aim:?}",
                self.name
            );
        }
    }
}

impl Case {
    /// On a flat sheet the slit passes the middle between its aims, unless that is near the outline, on which
    /// a seam opens nothing.
    fn judge_middle(
        &self,
        pair: [Line; 2],
        before: &Surface,
        torn: &[[Point; 2]],
        counts: &mut Counts,
    ) {
        let is_flat = before.points.iter().all(|p| p[2] == 0.0);
        let [Some(a), Some(b)] = pair.map(|line| aimed(line, before, 0.0)) else {
            return;
        };
        let (middle, longest) = (on_the_way(a, b, 0.5), before.longest_edge());
        let rim = middle[..2].iter().map(|x| x.min(1.0 - x));
        let rim = rim.fold(f64::INFINITY, f64::min);
        if !is_flat || length(minus(a, b)) < 2.0 * longest || rim < longest {
            return;
        }
        let far = torn.iter().map(|&edge| distance(edge, middle));
        let far = far.fold(f64::INFINITY, f64::min);
        assert!(
            far <= longest,
            "{}: {far} from the middle of {a:?} and {b:?}",
            self.name
        );
        counts.middles += 1;
    }
}

#[test]
fn polylines_run_between_their_rays() {
    let meshes = meshes();
    let mut random = Random(3);
    for snap in SNAPS {
        for eyes in EYES {
            let mut counts = Counts::default();
            for _ in 0..cases().div_ceil(288) {
                Case::new(&meshes, eyes, snap, &mut random).cut(&mut counts);
            }
            println!("{eyes:?}, snap {snap}: {counts:?}");
            // A seam that goes the wrong way does not end before a boundary, which is farther than an end
            // is moved: to another vertex of its face, once along the seam and once across it.
            assert!(counts.beyond < 2.0 && counts.ambiguous <= counts.cuts / 50);
        }
    }
}

/// The second slit is cut from the snapped end of the first on, not back from it.
#[test]
fn regression_a_slit_from_one_eye_continues_forward() {
    let sheet = surface(&tearmesh::shapes::grid(24, 24));
    let eye = |x: f64, y: f64| ([0.5, 0.5, 9.0], [x - 0.5, y - 0.5, -9.0]);
    for turn in 0..60 {
        let angle = TAU * f64::from(turn) / 60.0;
        let far = |r: f64, angle: f64| eye(0.5 + r * angle.cos(), 0.5 + r * angle.sin());
        let lines = [eye(0.5, 0.5), far(0.04, angle), far(0.079, angle + 0.1)];
        let (mut mesh, mut positions) = built(&sheet);
        let mut edits = Edits::new();
        let mut lengths = Vec::new();
        let mut scissor = Scissor::new(ray(lines[0]), ray(lines[1])).expect("a plane");
        for to in [2, 2] {
            let (cut, report) = scissor
                .cut_measured(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)
                .expect("in step");
            lengths.push(report.seam_length);
            let [_, end] = cut.ends().expect("rays");
            if lengths.len() == 2 {
                break;
            }
            scissor = Scissor::continued(end, ray(lines[to]), &positions).expect("a plane");
        }
        assert!(lengths.iter().all(|&length| length < 0.06), "{lengths:?}");
    }
}

/// The second ray passes the first before it meets the sheet, on the other side of where it comes nearest to
/// the joint.
#[test]
fn regression_a_slit_continues_to_where_its_ray_meets_the_mesh() {
    let sheet = surface(&tearmesh::shapes::grid(24, 24));
    let to = |eye: Point, at: Point| (eye, minus(at, eye));
    let lines = [
        to([0.26, 0.13, 3.0], [0.26, 0.13, 0.0]),
        to([0.809, 0.624, 1.110], [0.183, 0.190, 0.0]),
        to([-1.117, 0.164, 0.894], [0.848, 0.372, 0.0]),
    ];
    let (mut mesh, mut positions) = built(&sheet);
    let mut edits = Edits::new();
    let mut cut = |scissor: Scissor, positions: &mut Positions| {
        let cut = scissor.cut_measured(CutMethod::Exact, &mut mesh, positions, &mut edits);
        cut.expect("in step")
    };
    let first = Scissor::new(ray(lines[0]), ray(lines[1])).expect("a plane");
    let (made, _) = cut(first, &mut positions);
    let [_, end] = made.ends().expect("rays");
    let second = Scissor::continued(end, ray(lines[2]), &positions).expect("a plane");
    let (_, report) = cut(second, &mut positions);
    let aims = report
        .aims
        .expect("rays")
        .map(|aim| aim.expect("the sheet is met"));
    assert!(aims.iter().all(|aim| !aim.is_missed()), "{aims:?}");
    assert!(
        (report.seam_length - 0.69).abs() < 0.01,
        "{}",
        report.seam_length
    );
}

/// However far apart two eyes are, the slit on a flat sheet is that from one aim to the other.
#[test]
fn skew_rays_cut_between_their_aims() {
    let mut random = Random(29);
    let sheets = [
        surface(&tearmesh::shapes::grid(9, 9)),
        delaunay(120, 8, &mut random),
    ];
    let mut count = 0;
    for case in 0..cases() {
        let sheet = &sheets[case as usize % 2];
        let apart = [0.5, 2.0, 5.0][case as usize % 3];
        let aims = [0, 1].map(|_| [random.next(), random.next(), 0.0]);
        let pair = aims.map(|at: Point| {
            let aside = [0, 1].map(|i| at[i] + apart * (random.next() - 0.5));
            let eye = [aside[0], aside[1], 0.2 + 2.0 * random.next()];
            (eye, minus(at, eye))
        });
        let scissor = Scissor::new(ray(pair[0]), ray(pair[1]))
            .expect("a plane")
            .with_snap(0.0);
        let (mut mesh, mut positions) = built(sheet);
        let mut edits = Edits::new();
        let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
        cut.expect("rays that do not meet do not cross");
        let way = minus(aims[1], aims[0]);
        for h in mesh.half_edges().filter(|&h| mesh.ghost_pair(h).is_some()) {
            let off = minus(positions.at(mesh.origin(h)).into(), aims[0]);
            let along = dot(off, way) / dot(way, way);
            let is_between = (-1e-9..=1.0 + 1e-9).contains(&along);
            let aside = length(cross(off, way));
            assert!(is_between && aside < 1e-9, "{pair:?}: {along}, {aside}");
            count += 1;
        }
    }
    assert!(count > cases(), "{count}");
}

/// Two rays that cross two units above the sheet, and at its height.
#[test]
fn rays_that_cross_cut_the_wedge_in_which_the_mesh_is() {
    let at = |x: f64, z: f64, to: f64| ([x, 0.3, z], [to - x, 0.0, -z]);
    let cut = |pair: [Line; 2], moved: f64| {
        let (mut mesh, positions) = tearmesh::shapes::grid(8, 8);
        let points = positions.as_slice().iter().map(|p| [p.x, p.y, p.z + moved]);
        let mut positions = Positions::new(points).expect("finite");
        let scissor = Scissor::new(ray(pair[0]), ray(pair[1]))
            .expect("a plane")
            .with_snap(0.0);
        let mut edits = Edits::new();
        let made = scissor.cut_measured(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
        made.map(|(_, report)| report.seam_length)
    };
    // They cross at z = 2: at z = 0 they are .6 apart, at z = 3 they are .3.
    let pair = [at(0.2, 4.0, 0.8), at(0.8, 4.0, 0.2)];
    for (z, length) in [(0.0, 0.6), (3.0, 0.3), (1.0, 0.3)] {
        let seam = cut(pair, z).expect("one wedge");
        assert!((seam - length).abs() < 1e-12, "{z}: {seam}");
    }
    // Upright, the sheet is before the crossing and beyond it.
    let (mut mesh, positions) = tearmesh::shapes::grid(8, 8);
    let points = positions.as_slice().iter().map(|p| [0.52, p.x, 4.0 * p.y]);
    let mut positions = Positions::new(points).expect("finite");
    let scissor = Scissor::new(ray(pair[0]), ray(pair[1])).expect("a plane");
    let [far, _] = scissor.sides().expect("rays");
    assert!(far.distance([0.5, 0.3, 0.0].into()) > 0.0, "the far wedge");
    let (uncut, mut edits) = (mesh.clone(), Edits::new());
    let made = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
    let Some(CutError::RaysCross { at }) = made.err() else {
        panic!("the mesh is on both sides of the crossing");
    };
    assert!((at - tearmesh::Point::new(0.5, 0.3, 2.0)).norm() < 1e-12);
    assert!(mesh == uncut && edits.is_empty());
    let through =
        scissor
            .with_through(true)
            .cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
    assert!(through.is_ok(), "a whole plane has no wedges");
}

/// A cut that would end in a face of its joint, within the snap of it, is refused; a bit farther it is made.
#[test]
fn a_cut_shorter_than_the_snap_is_refused() {
    let (mut mesh, mut positions) = tearmesh::shapes::grid(4, 4);
    let down = |x: f64, y: f64| ray(([x, y, 5.0], [0.0, 0.0, -1.0]));
    let mut edits = Edits::new();
    let first = Scissor::new(down(0.3, 0.35), down(0.5, 0.5)).expect("a plane");
    let cut = first.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
    let cut = cut.expect("in step");
    let [_, end] = cut.ends().expect("rays");
    assert_eq!(end.vertices(), [mesh.vertex(12)], "the vertex at 0.5, 0.5");
    let on_joint = Scissor::continued(end, down(0.5, 0.5), &positions);
    assert_eq!(on_joint.err(), Some(ScissorError::NoLength));
    let uncut = (mesh.clone(), edits.cursor());
    for (x, snap, is_cut) in [
        (0.51, 0.05, false),
        (0.52, 0.05, true),
        (0.51, 0.0, true),
        (0.6, 0.49, false),
    ] {
        let (mut mesh, mut positions) = (mesh.clone(), positions.clone());
        let scissor = Scissor::continued(end, down(x, 0.5), &positions).expect("a plane");
        let scissor = scissor.with_snap(snap);
        let mut edits = Edits::starting_at(edits.cursor());
        let made = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
        match made {
            Ok(_) => assert!(is_cut && mesh != uncut.0, "{x}, {snap}"),
            Err(error) => {
                assert_eq!(
                    error,
                    CutError::TooShort {
                        joint: end.vertices()[0]
                    }
                );
                assert!(!is_cut && (mesh, edits.cursor()) == uncut, "{x}, {snap}");
            }
        }
    }
}

//! Properties of the scissor of any two rays, and of any small mesh that it cuts.
//!
//! The fuzz target `scissor_rays` and the replay of its seeds use this. Everything is judged by
//! plain formulas; where rounding has a say, the bound is written out. ε is 2^-53.

use std::ops::Neg as _;

use tearmesh::script::Script;
use tearmesh::{
    COORDINATE_MAX, Cursor, CutError, CutMethod, CutReport, CutTips, Edits, FaceId, Follower as _,
    Masses, Mesh, Point, Positions, Ray, Scissor, ScissorError, Vector, VertexId, shapes, split,
};

use crate::work::Work;

const EPSILON: f64 = f64::EPSILON / 2.0;

/// Two rays as numbers, which need not be usable, and a mesh to cut.
#[derive(Debug)]
pub(crate) struct Case {
    /// Each the origin and the direction.
    rays: [[Vector; 2]; 2],
    through: bool,
    tips: CutTips,
    mesh: Mesh,
    points: Vec<Point>,
}

/// What became of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// A ray was refused.
    NoRay,
    /// The rays span no plane.
    NoPlane,
    /// The rays cross between two parts of the mesh.
    RaysCross,
    /// The mesh was cut, and this many vertices were split.
    Cut(usize),
}

impl Case {
    /// Any bytes are a case: the first ray, how the second one relates to it, how to cut, and
    /// the rest is a mesh, as at the beginning of a script. Missing bytes count as zero.
    pub(crate) fn from_bytes(bytes: &[u8]) -> Case {
        let mut bytes = Bytes(bytes);
        let rays = bytes.rays();
        let flags = bytes.byte();
        // 2^-64 to 2^63, so that the area of no face vanishes.
        let scale = f64::from(bytes.byte().cast_signed() / 2).exp2();
        let (mesh, positions) = Script::from_bytes(bytes.0).shape.make();
        let points = positions.as_slice().iter().map(|p| p * scale).collect();
        Case {
            rays,
            through: flags & 1 == 1,
            tips: if flags & 2 == 2 {
                CutTips::Midpoint
            } else {
                CutTips::Vertex
            },
            mesh,
            points,
        }
    }

    /// Checks every property.
    pub(crate) fn check(&self) -> Outcome {
        let [a, b] = self.rays.map(|[origin, direction]| ray(origin, direction));
        let (Some(a), Some(b)) = (a, b) else {
            return Outcome::NoRay;
        };
        let Some(scissor) = scissor(&a, &b) else {
            return Outcome::NoPlane;
        };
        let report = self.cut(scissor, 1.0);
        self.a_power_of_two_changes_nothing(report.as_ref());
        report.map_or(Outcome::RaysCross, |report| Outcome::Cut(report.splits))
    }

    /// The report of a cut; none if the rays cross between two parts of the mesh.
    fn cut(&self, scissor: Scissor, scale: f64) -> Option<CutReport> {
        let scissor = scissor.with_through(self.through).with_tips(self.tips);
        let points = self.points.iter().map(|p| p * scale);
        let positions = Positions::new(points).expect("the shapes are small");
        a_refused_cut_changes_nothing(&scissor, &self.mesh, &positions);

        let half = Masses::half(&self.mesh, &positions, 1.0);
        let mut half = half.expect("a face has an area");
        let mut work = Work::new((self.mesh.clone(), positions));
        let report = match work.try_cut(CutMethod::Partition, &scissor) {
            Ok((_, report)) => report,
            Err(CutError::RaysCross { at }) => {
                self.is_crossed(at / scale);
                return None;
            }
            Err(error) => panic!("{error}"),
        };
        work.edits.replay(&mut half);
        assert!(half.ledger().is_balanced(), "mass stays");
        let (mesh, vertices) = (&work.mesh, self.mesh.vertex_count());
        assert_eq!(mesh.vertex_count(), vertices + report.splits);
        assert_eq!(mesh.face_count(), self.mesh.face_count());
        for h in mesh.half_edges() {
            let (was, is) = (self.mesh.origin(h), work.positions.at(mesh.origin(h)));
            assert_eq!(is, self.points[was.index()] * scale, "{h} stays");
        }
        let numbers = [
            report.seam_length,
            report.seam_length_ratio,
            report.seam_deviation_max,
            report.seam_deviation_max_edges,
            report.altitude_min,
            report.nearest_vertex,
        ];
        let is_length = |number: &f64| number.is_finite() && *number >= 0.0;
        assert!(numbers.iter().all(is_length), "{report:?}");
        Some(report)
    }

    /// The rays cross in front of their origins, with one part of the mesh before the point and another
    /// one beyond it.
    fn is_crossed(&self, at: Point) {
        let mut along = Vector::zeros();
        for [origin, direction] in self.rays {
            let direction = unit(direction);
            assert!((at - Point::from(origin)).dot(&direction) > 0.0, "behind");
            along += direction;
        }
        let far = self.points.iter().map(|p| (p - at).dot(&along));
        let [before, beyond] = [
            far.clone().any(|far| far < 0.0),
            { far }.any(|far| far > 0.0),
        ];
        assert!(before && beyond, "{before} {beyond}");
    }

    /// Inches or light years: the cut is the same, unless numbers become too large or too small.
    fn a_power_of_two_changes_nothing(&self, report: Option<&CutReport>) {
        let scale = 64.0;
        let is_plain = |x: f64| x == 0.0 || (1e-60..1e60).contains(&x.abs());
        let numbers = self.rays.as_flattened().iter().flat_map(|v| v.iter());
        if !numbers.copied().all(is_plain) {
            return;
        }
        let [a, b] = self
            .rays
            .map(|[origin, direction]| ray(origin * scale, direction).expect("a plain number"));
        let scissor = scissor(&a, &b).expect("larger rays span a plane too");
        let of_larger = self.cut(scissor, scale);
        let counted = |report: &CutReport| (report.splits, report.pieces, report.faces_crossed);
        let larger = of_larger.as_ref().map(counted);
        assert_eq!(larger, report.map(counted), "a larger model");
    }
}

/// The ray, or none; and that it was right to refuse or accept these numbers.
fn ray(origin: Vector, direction: Vector) -> Option<Ray> {
    let ray = Ray::new(origin.into(), direction);
    let usable = origin.iter().all(|x| x.abs() <= COORDINATE_MAX)
        && direction.iter().all(|x| x.is_finite())
        && direction.iter().any(|&x| x != 0.0);
    assert_eq!(ray.is_ok(), usable, "{ray:?}");
    ray.ok()
}

/// The scissor, or none; and everything that can be said of it without a mesh.
fn scissor(a: &Ray, b: &Ray) -> Option<Scissor> {
    let [along_a, along_b] = [a, b].map(|ray| unit(ray.direction()));
    let apart = a.origin() - b.origin();
    let reach = a.origin().coords.amax().max(b.origin().coords.amax());
    let spanned = apart.cross(&along_a);
    let angle = length(along_a.cross(&along_b));
    // Below, products with a distance vanish, and nothing is known of the plane.
    let is_normal = reach == 0.0 || reach > 1e-290;
    let scissor = match Scissor::new(*a, *b) {
        Ok(scissor) => scissor,
        Err(error) => {
            assert_eq!(error, ScissorError::OneLine);
            assert!(
                length(spanned) <= 256.0 * EPSILON * reach || !is_normal,
                "the origins are apart"
            );
            assert!(angle <= 256.0 * EPSILON, "the directions differ");
            return None;
        }
    };
    // Twice what the library asks for: between the two bounds either may hold.
    let by_origins = spanned.amax() > 64.0 * EPSILON * reach;
    let by_eye = spanned.amax() < 8.0 * EPSILON * reach;
    // How well the two vectors that span the plane determine its normal.
    let spread = if by_origins {
        length(spanned) / length(apart)
    } else {
        angle
    };
    let known = (by_origins || by_eye) && is_normal;

    let plane = scissor.plane();
    let normal = plane.normal();
    assert!((normal.norm() - 1.0).abs() <= 8.0 * EPSILON, "a unit");
    assert_eq!(plane.point(), a.origin());
    if known {
        let aside = plane.distance(b.origin()).abs();
        let bound = 16.0 * EPSILON * length(apart) / spread + 64.0 * EPSILON * reach;
        assert!(aside <= bound, "O_B is {aside} off the plane, not {bound}");
        let leaves = normal.dot(&along_a).abs();
        assert!(leaves <= 16.0 * EPSILON / spread, "V_A leaves the plane");
    }
    assert!((0.0..=1.0 + 8.0 * EPSILON).contains(&scissor.skew()));
    // Where the normal is not known to the last digits, neither is the skew, and less than that is none.
    let skew = normal.dot(&along_b).abs();
    let of_normal = if by_origins {
        spanned.amax() / apart.amax()
    } else {
        angle
    };
    let is_vague = scissor.skew() == 0.0 && skew * of_normal <= 256.0 * EPSILON;
    let off = (scissor.skew() - skew).abs();
    assert!(off <= 64.0 * EPSILON || is_vague || !known, "{skew}");

    // Near the smallest numbers a bound that is a part of them vanishes.
    let out = -128.0 * EPSILON * reach - f64::MIN_POSITIVE;
    let origins = [a.origin(), b.origin()];
    for (i, side) in scissor
        .sides()
        .expect("there are rays")
        .into_iter()
        .enumerate()
    {
        assert_eq!(side.point(), origins[i], "a side plane holds its origin");
        assert!(
            (side.normal().norm() - 1.0).abs() <= 8.0 * EPSILON,
            "a unit"
        );
        // Upright on the plane, and along the ray as far as that lies in the plane.
        let along = [along_a, along_b][i];
        let spread = along.cross(&normal).norm();
        if spread > 128.0 * EPSILON && known {
            let bound = 16.0 * EPSILON / spread;
            assert!(side.normal().dot(&normal).abs() <= bound, "upright");
            assert!(side.normal().dot(&along).abs() <= bound, "along the ray");
        }
        // The other ray ends up inside. If it begins there, it is inside as a whole.
        let leaves = side.normal().dot(&[along_b, along_a][i]);
        assert!(leaves >= -256.0 * EPSILON, "outward: {leaves:e}");
        let inward = side.distance(origins[1 - i]);
        let is_parallel = leaves <= 8.0 * EPSILON;
        assert!(inward >= out || !is_parallel, "inward is out: {inward:e}");
    }
    if angle == 0.0 {
        let middle = Point::from((a.origin().coords + b.origin().coords) / 2.0);
        for side in scissor.sides().into_iter().flatten() {
            let inside = side.distance(middle);
            assert!(inside >= out, "the middle is out: {inside:e}");
            if length(spanned) > 1024.0 * EPSILON * reach && reach > 1e-290 {
                assert!(inside > 0.0, "the middle is not inside: {inside}");
            }
        }
    }
    Some(scissor)
}

fn unit(v: Vector) -> Vector {
    // In two steps, because a small number may have no inverse.
    let v = v / v.amax();
    v / v.norm()
}

/// The length. The squares of small numbers are zero, and those of large ones infinite.
fn length(v: Vector) -> f64 {
    let size = v.amax();
    if size == 0.0 {
        return 0.0;
    }
    size * (v / size).norm()
}

fn a_refused_cut_changes_nothing(scissor: &Scissor, mesh: &Mesh, positions: &Positions) {
    let (mut after, mut edits) = (mesh.clone(), Edits::new());
    let (mut fan, mut log) = (shapes::fan(3, true).0, Edits::new());
    let (v, f) = (VertexId::new(0), FaceId::new(0));
    let split = split::vertex(&mut fan, v.expect("an id"), &[f.expect("an id")], &mut log);
    split.expect("two faces stay");
    let fewer = positions.as_slice()[1..].iter().copied();
    for refused in [
        positions.clone().starting_at(log.cursor()),
        Positions::new(fewer).expect("they were usable"),
    ] {
        let mut places = refused.clone();
        let error = scissor.cut(CutMethod::Partition, &mut after, &mut places, &mut edits);
        let is_known = matches!(
            error,
            Err(CutError::Unreplayed { .. } | CutError::Positions { .. })
        );
        assert!(is_known && edits.is_empty() && edits.cursor() == Cursor::START);
        assert_eq!((&after, &places), (mesh, &refused));
    }
}

/// Numbers at the ends of what is accepted, of what `f64` can hold, and of what is one.
const EXTREME: [f64; 12] = [
    0.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN_POSITIVE,
    5e-324,
    COORDINATE_MAX,
    2.0 * COORDINATE_MAX,
    f64::EPSILON,
    1e-160,
    -0.0,
];

/// Bytes to be read, followed by zeros without end.
struct Bytes<'b>(&'b [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let [first, rest @ ..] = self.0 else { return 0 };
        self.0 = rest;
        *first
    }

    fn small(&mut self) -> f64 {
        f64::from(self.byte().cast_signed())
    }

    fn number(&mut self) -> f64 {
        match self.byte() % 8 {
            0..=2 => self.small() / 8.0,
            3 => self.small() * (2.0 * self.small()).exp2(),
            4 => f64::from_le_bytes(std::array::from_fn(|_| self.byte())),
            5 => EXTREME[usize::from(self.byte()) % EXTREME.len()],
            6 => 1.0 + self.small() * f64::EPSILON,
            _ => self.small() / 3.0,
        }
    }

    fn vector(&mut self) -> Vector {
        Vector::from(std::array::from_fn(|_| self.number()))
    }

    /// The vector with each number moved by some of its last digits.
    fn nudged(&mut self, v: Vector) -> Vector {
        v.map(|x| f64::from_bits(x.to_bits().wrapping_add_signed(self.small() as i64)))
    }

    fn rays(&mut self) -> [[Vector; 2]; 2] {
        let [origin, direction] = [self.vector(), self.vector()];
        let second = match self.byte() % 9 {
            0 => [self.vector(), self.vector()],
            1 => [origin, self.vector()],
            2 => [self.vector(), direction],
            3 => [self.vector(), direction.neg()],
            4 => [self.vector(), self.nudged(direction)],
            5 => [self.vector(), self.nudged(direction).neg()],
            6 => [origin + direction * self.number(), self.vector()],
            7 => [self.nudged(origin), self.nudged(direction)],
            _ => [
                origin + direction * self.number(),
                direction * self.number(),
            ],
        };
        [[origin, direction], second]
    }
}

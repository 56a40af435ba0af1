//! Cuts of scripts: where they go, and how they are made.

use crate::geometry::{Plane, Point, Ray, Vector, between, max_abs};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::scissor::{CutEnd, CutLayers, CutMethod, CutTips, Scissor};

/// Where a cut goes.
///
/// The points of all variants but [`CutPath::Rays`] are relative to the box around the mesh, as it is
/// when the cut is made: they are counted from its middle, in units of 1/128 of its longest side. So
/// most rays through small numbers meet the mesh, whatever its size.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CutPath {
    /// Between two rays, each an origin in units of 1/32 and a direction.
    /// Text: `ORIGIN DIRECTION ORIGIN DIRECTION`, three numbers each.
    Rays([[[i8; 3]; 2]; 2]),
    /// Between two rays, each from a point through another one. They may be skew.
    /// Text: `skew ORIGIN TARGET ORIGIN TARGET`.
    Skew([[[i8; 3]; 2]; 2]),
    /// Between two parallel rays. Each begins at its target minus the direction.
    /// Text: `parallel DIRECTION TARGET TARGET`.
    Parallel {
        /// The direction of both rays.
        direction: [i8; 3],
        /// A point on each ray.
        targets: [[i8; 3]; 2],
    },
    /// Between two rays from one point.
    /// Text: `eye EYE TARGET TARGET`.
    Eye {
        /// The origin of both rays.
        eye: [i8; 3],
        /// Another point on each ray.
        targets: [[i8; 3]; 2],
    },
    /// Between two rays that meet at a point.
    /// Text: `converging ORIGIN ORIGIN TARGET`.
    Converging {
        /// The origin of each ray.
        origins: [[i8; 3]; 2],
        /// The point at which they meet.
        target: [i8; 3],
    },
    /// Along a whole plane.
    /// Text: `plane POINT NORMAL`.
    Plane {
        /// A point on the plane.
        point: [i8; 3],
        /// Its normal.
        normal: [i8; 3],
    },
    /// From the end of the previous cut to a ray, which goes from a point through another one.
    /// Text: `continued ORIGIN TARGET`.
    Continued([[i8; 3]; 2]),
    /// From the end of the previous cut to the beginning of the polyline that it is a part of.
    /// Text: `closed`.
    Closed,
}

/// How a cut is made. Where a text names no method, it is `partition`, which is not the default here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CutSettings {
    /// The method.
    pub method: CutMethod,
    /// Whether the cut continues beyond the rays.
    pub through: bool,
    /// The rule for where the cut ends, unless it continues beyond the rays.
    pub tips: CutTips,
    /// The layers of the mesh that are cut.
    pub layers: CutLayers,
    /// The snap, in units of 1/64 of an edge from 0 to 31, or `None` for [`Scissor::SNAP`].
    pub snap: Option<u8>,
    /// Whether a vertex that replaces a crossing is moved onto the plane.
    pub snap_move: bool,
    /// Whether [seams](crate::unsewn::UnsewnSeams) whose two sides coincide are closed while the mesh is cut.
    pub seams: bool,
}

impl CutSettings {
    /// The scissor with these settings.
    pub(super) fn of(self, scissor: Scissor) -> Scissor {
        let snap = self
            .snap
            .map_or(Scissor::SNAP, |snap| f64::from(snap) / 64.0);
        scissor
            .with_through(self.through)
            .with_tips(self.tips)
            .with_layers(self.layers)
            .with_snap(snap)
            .with_snap_move(self.snap_move)
    }
}

impl CutPath {
    /// The scissor along this path; `None` if it has none, such as between two rays that are one line.
    ///
    /// Origins are 2^`far` times as far from the middle of the mesh. `polyline` is the beginning and the end
    /// of the polyline so far.
    pub(super) fn scissor(
        &self,
        far: u8,
        mesh: &Mesh,
        positions: &Positions,
        polyline: Option<&[CutEnd; 2]>,
    ) -> Option<Scissor> {
        let frame = &Frame::of(mesh, positions);
        let scale = (1_u64 << far.min(FAR_MAX)) as f64;
        let between = |origins: [[i8; 3]; 2], targets: [[i8; 3]; 2]| {
            let ray = |i: usize| frame.ray(frame.point(origins[i], scale), targets[i]);
            Scissor::new(ray(0)?, ray(1)?).ok()
        };
        match *self {
            CutPath::Rays(rays) => {
                let [a, b] = rays.map(|[origin, direction]| {
                    let origin = origin.map(|x| f64::from(x) / 32.0 * scale);
                    Ray::new(Point::from(origin), direction.map(f64::from).into()).ok()
                });
                Scissor::new(a?, b?).ok()
            }
            CutPath::Skew([[a, at_a], [b, at_b]]) => between([a, b], [at_a, at_b]),
            CutPath::Parallel { direction, targets } => {
                let along = frame.vector(direction, scale);
                let [a, b] =
                    targets.map(|target| Ray::new(frame.point(target, 1.0) - along, along).ok());
                Scissor::new(a?, b?).ok()
            }
            CutPath::Eye { eye, targets } => between([eye; 2], targets),
            CutPath::Converging { origins, target } => between(origins, [target; 2]),
            CutPath::Plane { point, normal } => {
                let normal = normal.map(f64::from).into();
                let plane = Plane::new(frame.point(point, 1.0), normal).ok()?;
                Some(Scissor::by_plane(plane))
            }
            CutPath::Continued([origin, target]) => {
                let to = frame.ray(frame.point(origin, scale), target)?;
                Scissor::continued(&polyline?[1], to, positions).ok()
            }
            CutPath::Closed => {
                let [begin, end] = polyline?;
                Scissor::closed(end, begin, positions).ok()
            }
        }
    }

    /// Whether the cut goes on from the one before.
    pub(super) fn continues(&self) -> bool {
        matches!(self, CutPath::Continued(_) | CutPath::Closed)
    }
}

/// The largest exponent of a distance that scripts from bytes or text may have.
pub(super) const FAR_MAX: u8 = 40;

/// The coordinates of a path: the middle of the box around a mesh, and the unit.
struct Frame {
    middle: Point,
    unit: f64,
}

impl Frame {
    fn of(mesh: &Mesh, positions: &Positions) -> Frame {
        let mut points = mesh.vertices().map(|v| positions.at(v));
        let first = points.next().expect("the mesh has a vertex");
        let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
        Frame {
            middle: between(low, high, 0.5),
            unit: max_abs(high - low) / 128.0,
        }
    }

    fn vector(&self, numbers: [i8; 3], scale: f64) -> Vector {
        Vector::from(numbers.map(f64::from)) * (self.unit * scale)
    }

    fn point(&self, numbers: [i8; 3], scale: f64) -> Point {
        self.middle + self.vector(numbers, scale)
    }

    /// The ray from a point through another one, if they differ.
    fn ray(&self, origin: Point, target: [i8; 3]) -> Option<Ray> {
        Ray::new(origin, self.point(target, 1.0) - origin).ok()
    }
}

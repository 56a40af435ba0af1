//! The strip that two rays span: the cutting plane, and the two planes that bound it at the sides. A
//! plane alone has no such bounds.
//!
//! The plane holds the origins of both rays and the direction of the first, and two side planes bound
//! the cut (Souza et al. 2014 §V). Two errata of the paper are handled here:
//!
//! 1. **The side planes point outward as printed** (`N_A = V_A × N`, `N_B = N × V_B`): a point
//!    half way between two parallel rays is on the negative side of both, so no vertex would be
//!    split. The normals here are `N × V_A` and `V_B × N`, each turned toward the other ray.
//! 2. **Two rays from one eye give N = 0**, and that is what a perspective camera produces. The
//!    plane is then `V_A × V_B`. Only rays on one line span no plane and are refused.
//!
//! Which way is toward the other ray? Its *origin* does not say: with one eye, or nearly one, that
//! origin lies on the side plane, and rounding would choose the side.
//!
//! ```text
//!       A   B                 A       B              A       B
//!        \ /   near            \     /               |       |
//!         X    crossing         \   /                | strip |     parallel: one strip, which
//!        / \                     \ /                 |       |     extends behind the origins
//!       /far\                    eye
//! ```
//!
//! * **Free rays** are turned by the direction of the other ray, or by its origin if that direction
//!   lies in the side plane (parallel rays). If the rays cross in front of both origins, that is the
//!   wedge beyond the crossing, and there is another one before it: [`Strip::at`] chooses.
//! * **A joint** is a point of the mesh. It turns the side plane through the other ray. The one through the
//!   joint is turned by the point at which the other ray meets the mesh ([`Strip::toward`]), so that the
//!   strip holds the way from the joint to there, wherever the rays cross; or where that ray passes the
//!   mesh by, by its point that is nearest to the joint.

use crate::exact::ROUNDING;
use crate::geometry::{Plane, Point, Ray, Vector, between, cross, dot, length, max_abs, scaled};
use crate::mesh::Mesh;
use crate::place::Place;

/// Where a cut may go.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Strip {
    pub(super) plane: Plane,
    /// What lies in front of both is between the rays; none where a plane was given.
    pub(super) sides: Option<[Plane; 2]>,
    /// How far the second ray leaves the plane for each unit of its length.
    pub(super) skew: f64,
    /// Whether the side planes bound nothing.
    pub(super) through: bool,
    /// Where the rays cross in front of both origins, which leaves two wedges.
    crossing: Option<Crossing>,
}

/// The crossing of two rays, seen along the normal of their strip, in front of both origins.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Crossing {
    at: Point,
    /// The plane through both origins, upright on that of the cut, with the crossing in front.
    origins: Plane,
    /// From the crossing into the middle of the wedge beyond it.
    onward: Vector,
    /// What rounding alone explains of a distance from the crossing.
    rounding: f64,
}

impl Crossing {
    /// None if the rays are parallel, diverge, or come from one eye, up to rounding.
    fn of(rays: [&Ray; 2], normal: Vector, sides: [Plane; 2], reach: f64) -> Option<Crossing> {
        // A part of a subnormal number is nothing.
        let rounding = ROUNDING * reach.max(f64::MIN_POSITIVE);
        let far = |side: usize| {
            let (other, along) = (sides[1 - side], unit_scale(rays[side]));
            let approach = dot(other.scaled_normal(), along);
            let far = -other.offset(rays[side].origin()) / approach;
            (approach.abs() > ROUNDING && far > rounding).then_some((far, along))
        };
        let ((far, along), _) = (far(0)?, far(1)?);
        let [a, b] = rays.map(|ray| ray.origin());
        let upright = scaled(cross(b - a, normal))?;
        let inward = dot(upright, along);
        let upright = if inward < 0.0 { -upright } else { upright };
        let at = a + along * far;
        let [onward_a, onward_b] = rays.map(|ray| unit_scale(ray) / length(unit_scale(ray)));
        Some(Crossing {
            at,
            origins: plane(a, upright),
            onward: onward_a + onward_b,
            rounding: rounding.max(ROUNDING * max_abs(at.coords)),
        })
    }
}

impl Strip {
    /// All of a plane.
    pub(super) fn whole(plane: Plane) -> Strip {
        Strip {
            plane,
            sides: None,
            skew: 0.0,
            through: true,
            crossing: None,
        }
    }

    /// The side planes, as far as they bound the cut.
    pub(super) fn bounds(&self) -> Option<[Plane; 2]> {
        self.sides.filter(|_| !self.through)
    }

    /// The strip, bounded by its side planes.
    pub(super) fn bounded(&self) -> Strip {
        Strip {
            through: false,
            ..self.clone()
        }
    }

    /// The strip between two rays; `None` if both lie on one line, up to rounding.
    pub(super) fn between(a: &Ray, b: &Ray) -> Option<Strip> {
        let [along_a, along_b] = [a, b].map(unit_scale);
        let apart = b.origin() - a.origin();
        let reach = reach([a.origin(), b.origin()]);
        let spanned = cross(-apart, along_a);
        let (normal, of) = if max_abs(spanned) > ROUNDING * reach {
            (spanned, max_abs(apart))
        } else {
            // The origin of B lies on the line of A, or is that of A: one eye.
            let from_eye = cross(along_a, along_b);
            if max_abs(from_eye) <= ROUNDING {
                return None;
            }
            (from_eye, 1.0)
        };
        let vague = ROUNDING * of / max_abs(normal);
        let normal = scaled(normal)?;
        let toward = [[along_b, apart], [along_a, -apart]];
        let mut strip = Strip::spanned([*a, *b], 0, normal, toward, ROUNDING);
        if strip.skew <= vague {
            strip.skew = 0.0; // The nearer to parallel, the less is known of the normal.
        }
        strip.crossing = Crossing::of([a, b], normal, strip.sides?, reach);
        Some(strip)
    }

    /// The strip between two rays, one or both of which pass through a point of the mesh, the joint. The
    /// plane holds the joint and all of the other ray, or of the second if both have a joint. `None` if
    /// a joint lies on the other ray, up to rounding, or if there is no joint.
    pub(super) fn joined(rays: [Ray; 2], joints: [Option<Point>; 2]) -> Option<Strip> {
        let through = |side: usize| match joints[side] {
            Some(joint) => Ray::new(joint, rays[side].direction()).ok(),
            None => Some(rays[side]),
        };
        let rays = [through(0)?, through(1)?];
        // The side whose point spans the plane with the other ray.
        let side = usize::from(joints[0].is_none());
        let (joint, other) = (joints[side]?, rays[1 - side]);
        let along = unit_scale(&other);
        let reach = reach([joint, other.origin()]);
        let spanned = cross(other.origin() - joint, along);
        if max_abs(spanned) <= ROUNDING * reach {
            return None;
        }
        let far = dot(joint - other.origin(), along) / dot(along, along);
        let nearest = joints[1 - side].unwrap_or(other.origin() + along * far);
        let mut toward = [nearest - joint, joint - other.origin()];
        if side == 1 {
            toward.reverse();
        }
        let [a, b] = rays.each_ref().map(unit_scale);
        let toward = [[toward[0], b], [toward[1], a]];
        let (normal, rounding) = (scaled(spanned)?, ROUNDING * reach);
        Some(Strip::spanned(rays, 1 - side, normal, toward, rounding))
    }

    /// The strip with this normal that holds ray number `held`, and whose side planes pass through both.
    /// Each is turned by the first of two vectors, or if that lies in it up to `rounding`, by the second.
    fn spanned(
        rays: [Ray; 2],
        held: usize,
        normal: Vector,
        toward: [[Vector; 2]; 2],
        rounding: f64,
    ) -> Strip {
        let [a, b] = rays.each_ref().map(unit_scale);
        let mut uprights = [cross(normal, a), cross(b, normal)];
        // A ray that stands upright on the plane has a side plane along the other ray.
        for side in 0..2 {
            if max_abs(uprights[side]) <= ROUNDING {
                uprights[side] = -uprights[1 - side];
            }
        }
        let side = |i: usize| {
            let upright = scaled(uprights[i]).expect("a normal beyond rounding is not zero");
            let [first, second] = toward[i].map(|toward| dot(upright, toward));
            let inward = if first.abs() > rounding {
                first
            } else {
                second
            };
            plane(
                rays[i].origin(),
                if inward < 0.0 { -upright } else { upright },
            )
        };
        let plane = plane(rays[held].origin(), normal);
        let leaving = [b, a][held];
        let skew = dot(plane.normal(), leaving / length(leaving)).abs();
        Strip {
            sides: Some([side(0), side(1)]),
            skew: if skew <= ROUNDING { 0.0 } else { skew },
            through: false,
            crossing: None,
            plane,
        }
    }

    /// This strip with the side plane through ray number `side` turned to a point that the cut runs toward.
    /// A point on that plane, up to rounding, does not turn it.
    pub(super) fn toward(mut self, side: usize, aim: Point) -> Strip {
        if let Some(sides) = &mut self.sides
            && sides[side].distance(aim) < -ROUNDING * reach([aim, sides[side].point()])
        {
            sides[side] = flipped(sides[side]);
        }
        self
    }

    /// This strip on a mesh: if its rays cross in front of both origins, the wedge that the mesh meets.
    /// The point of crossing if the mesh meets both.
    pub(super) fn at(&self, mesh: &Mesh, place: &(impl Place + ?Sized)) -> Result<Strip, Point> {
        let (Some(crossing), Some(sides)) = (self.crossing, self.bounds()) else {
            return Ok(self.clone());
        };
        let wedge = |sides: [Plane; 2]| Strip {
            sides: Some(sides),
            crossing: None,
            ..self.clone()
        };
        let (beyond, before) = (wedge(sides), wedge(sides.map(flipped)));
        let (mut meets_beyond, mut meets_before, mut meets_between) = (false, false, false);
        for f in mesh.faces() {
            let corners = mesh.face_vertices(f).map(|v| place.at(v));
            let Some([p, q]) = self.section(corners) else {
                continue;
            };
            // What meets a wedge in the crossing alone meets neither of them.
            let ends = |wedge: &Strip| wedge.part(p, q).into_iter().flatten();
            let far = |end| dot(end - crossing.at, crossing.onward);
            meets_beyond |= ends(&beyond).any(|end| far(end) > crossing.rounding);
            if ends(&before).any(|end| far(end) < -crossing.rounding) {
                meets_before = true;
                meets_between |= ends(&before).any(|end| crossing.origins.offset(end) > 0.0);
            }
        }
        match (meets_before, meets_beyond) {
            (true, false) => Ok(before),
            _ if meets_between => Err(crossing.at),
            _ => Ok(beyond),
        }
    }

    /// Where the plane crosses a triangle. A corner on the plane counts as in front of it.
    pub(super) fn section(&self, corners: [Point; 3]) -> Option<[Point; 2]> {
        let offsets = corners.map(|p| self.plane.offset(p));
        let mut ends = (0..3).filter_map(|i| {
            let [from, to] = [offsets[i], offsets[(i + 1) % 3]];
            let [p, q] = [corners[i], corners[(i + 1) % 3]];
            ((from < 0.0) != (to < 0.0)).then(|| between(p, q, from / (from - to)))
        });
        Some([ends.next()?, ends.next()?])
    }

    /// The ends of the part of a segment between the side planes, unless that is a point or nothing.
    fn part(&self, p: Point, q: Point) -> Option<[Point; 2]> {
        let (from, to) = self.clip(p, q, 0.0).filter(|(from, to)| from < to)?;
        Some([from, to].map(|t| between(p, q, t)))
    }

    /// How far inside each side plane a point lies; negative outside, infinite for a cut through
    /// everything, and zero where rounding cannot vouch for the sign: up to `bound`.
    pub(super) fn depths(&self, p: Point, bound: f64) -> [f64; 2] {
        let Some(sides) = self.bounds() else {
            return [f64::INFINITY; 2];
        };
        sides.map(|side| {
            let depth = side.offset(p);
            if depth.abs() <= bound { 0.0 } else { depth }
        })
    }

    /// The depth inside the nearer side plane.
    pub(super) fn depth(&self, p: Point, bound: f64) -> f64 {
        let [a, b] = self.depths(p, bound);
        a.min(b)
    }

    /// The part of the segment from `p` to `q` that lies between the side planes, as two
    /// parameters from 0 to 1; `None` if there is no such part.
    pub(super) fn clip(&self, p: Point, q: Point, bound: f64) -> Option<(f64, f64)> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        let depths = self.depths(p, bound).into_iter().zip(self.depths(q, bound));
        for (start, end) in depths {
            if start < 0.0 && end < 0.0 {
                return None;
            }
            if start < 0.0 {
                from = from.max(start / (start - end));
            } else if end < 0.0 {
                to = to.min(start / (start - end));
            }
        }
        (from <= to).then_some((from, to))
    }
}

/// The direction of a ray, scaled to about length one.
fn unit_scale(ray: &Ray) -> Vector {
    scaled(ray.direction()).expect("a ray has a direction")
}

fn plane(point: Point, normal: Vector) -> Plane {
    Plane::new(point, normal).expect("a normal beyond rounding is not zero")
}

/// The same plane seen from the other side.
fn flipped(side: Plane) -> Plane {
    plane(side.point(), -side.scaled_normal())
}

/// The largest coordinate of two points.
fn reach([p, q]: [Point; 2]) -> f64 {
    max_abs(p.coords).max(max_abs(q.coords))
}

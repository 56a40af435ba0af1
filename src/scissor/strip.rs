//! The strip that two rays span: the cutting plane, and the two planes that bound it at the sides. A
//! plane alone has no such bounds.
//!
//! The plane holds the origins of both rays and the direction of the first, and two side planes bound
//! the cut (Souza et al. 2014 §V). Two errata of the paper are handled here:
//!
//! 1. **The side planes point outward as printed** (`N_A = V_A × N`, `N_B = N × V_B`): a point
//!    half way between two parallel rays is on the negative side of both, so no vertex would be
//!    split. The normals here are `N × V_A` and `V_B × N`, each turned round where the other
//!    ray would be on its negative side (anti-parallel rays).
//! 2. **Two rays from one eye give N = 0**, and that is what a perspective camera produces. The
//!    plane is then `V_A × V_B`. Only rays on one line span no plane and are refused.
//!
//! Between parallel rays the strip extends behind the origins too; between rays from one eye
//! it is the wedge before the eye.

use crate::exact::ROUNDING;
use crate::geometry::{Plane, Point, Ray, Vector, cross, dot, length, max_abs, scaled};

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
}

impl Strip {
    /// All of a plane.
    pub(super) fn whole(plane: Plane) -> Strip {
        Strip {
            plane,
            sides: None,
            skew: 0.0,
            through: true,
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
        let (along_a, along_b) = (unit_scale(a), unit_scale(b));
        let apart = a.origin() - b.origin();
        let reach = max_abs(a.origin().coords).max(max_abs(b.origin().coords));
        let spanned = cross(apart, along_a);
        let normal = if max_abs(spanned) > ROUNDING * reach {
            spanned
        } else {
            // The origin of B lies on the line of A, or is that of A: one eye.
            let from_eye = cross(along_a, along_b);
            if max_abs(from_eye) <= ROUNDING {
                return None;
            }
            from_eye
        };
        let normal = scaled(normal)?;
        let plane = plane(a.origin(), normal);
        let side_a = cross(normal, along_a);
        let side_b = match cross(along_b, normal) {
            // Ray B stands upright on the plane: its side plane runs along ray A.
            upright if max_abs(upright) <= ROUNDING => -side_a,
            side => side,
        };
        let sides = [
            plane_towards(a.origin(), side_a, -apart, along_b, reach),
            plane_towards(b.origin(), side_b, apart, along_a, reach),
        ];
        let unit_b = along_b / length(along_b);
        let skew = dot(plane.normal(), unit_b).abs();
        let skew = if skew <= ROUNDING { 0.0 } else { skew };
        Some(Strip {
            plane,
            sides: Some(sides),
            skew,
            through: false,
        })
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

/// A side plane, turned so that the other ray is on its positive side: its origin,
/// `towards` away, or if that lies on the plane, its direction.
fn plane_towards(
    point: Point,
    normal: Vector,
    towards: Vector,
    along: Vector,
    reach: f64,
) -> Plane {
    let normal = scaled(normal).expect("a normal beyond rounding is not zero");
    let mut inward = dot(normal, towards);
    if inward.abs() <= ROUNDING * reach {
        inward = dot(normal, along);
    }
    plane(point, if inward < 0.0 { -normal } else { normal })
}

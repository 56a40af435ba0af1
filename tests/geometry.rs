//! Points and planes, and values between values.

use tearmesh::geometry::between;
use tearmesh::{
    Blend, Mesh, Plane, PlaneError, Point, Positions, Ray, RayError, Side, Vector, classify,
};

#[test]
fn between_equal_values_is_that_value_bit_for_bit() {
    for x in [-0.0, 0.0, 0.1, -3e300, 5e-324] {
        let p = Point::new(x, -x, x);
        let is = between(p, p, 0.3);
        let [of_vector] = [p.coords].between(&[p.coords], 0.3);
        for is in [is.coords, of_vector] {
            assert_eq!([is.x, is.y].map(f64::to_bits), [x, -x].map(f64::to_bits));
        }
        assert_eq!(x.between(&x, 0.3).to_bits(), x.to_bits());
    }
    let half = between(Point::new(1.0, 2.0, 3.0), Point::new(2.0, 4.0, 1.0), 0.5);
    assert_eq!(half, Point::new(1.5, 3.0, 2.0));
    assert_eq!(2.0.between(&4.0, 0.25), 2.5);
    assert_eq!(2.0_f32.between(&4.0, 0.25), 2.5);
    assert_eq!(f32::weighted([&1.0, &2.0, &4.0], [0.25, 0.25, 0.5]), 2.75);
    let [one, other] = [2.0, 4.0].map(|x| Vector::x() * x);
    assert_eq!(one.between(&other, 0.25), Vector::x() * 2.5);
}

#[test]
fn a_point_on_an_oblique_plane_has_offset_zero() {
    let plane = Plane::new(Point::new(1.0, 1.0, 1.0), Vector::new(1.0, 2.0, 3.0)).expect("usable");
    for (z, side) in [(-1.0, Side::Front), (-1.5, Side::Back)] {
        let offset = plane.offset(Point::new(3.0, 3.0, z));
        assert_eq!((offset == 0.0, Side::of(offset)), (z == -1.0, side));
    }
}

/// Each order of its corners rounds to another sum of their offsets.
#[test]
fn the_side_of_a_face_does_not_depend_on_its_first_corner() {
    let points = [1e16, -1.0, -1e16].map(|x| [x, 0.0, 0.0]);
    let plane = Plane::new(Point::origin(), Vector::x()).expect("usable");
    let sides = [[0, 1, 2], [1, 2, 0], [2, 0, 1]].map(|face| {
        let mesh = Mesh::build(3, &[face]).expect("a face");
        classify::face(&mesh, mesh.face(0), &plane, &points[..])
    });
    assert!(sides.iter().all(|&side| side == sides[0]), "{sides:?}");
}

#[test]
fn unusable_planes_and_rays_are_refused() {
    let (o, x) = (Point::origin(), Vector::x());
    for (point, normal, is_point) in [
        (o, x * 0.0, false),
        (o, x * f64::NAN, false),
        (o + x * f64::INFINITY, x, true),
        (o + x * 1e76, x, true),
    ] {
        let by = |error| matches!(error, PlaneError::Point { .. }) == is_point;
        assert!(Plane::new(point, normal).is_err_and(by), "{point} {normal}");
        let by = |error| matches!(error, RayError::Origin { .. }) == is_point;
        assert!(Ray::new(point, normal).is_err_and(by), "{point} {normal}");
    }
}

#[test]
fn positions_of_an_engine_keep_their_bits() {
    let one_more = 1.0 + f32::EPSILON;
    let special = [0.0, -0.0, 1e-45, -3.4e38, 0.1, f32::MIN_POSITIVE, one_more];
    let point = |i: usize| [special[i % 7], special[i / 7 % 7], special[i / 49]];
    let mut points: Vec<[f32; 3]> = (0..343).map(point).collect();
    let as_f64 = |p: &[f32; 3]| p.map(f64::from);
    let positions = Positions::new(points.iter().map(as_f64)).expect("finite");
    let bits = |p: &[f32; 3]| p.map(f32::to_bits);
    let own = positions.as_slice().iter();
    let own = own.map(|p| [p.x, p.y, p.z].map(|x| (x as f32).to_bits()));
    assert!(own.eq(points.iter().map(bits)));
    (points[7][1], points[9][2]) = (f32::NAN, f32::NEG_INFINITY);
    let error = Positions::new(points.iter().map(as_f64)).expect_err("two are not finite");
    assert!(error.unusable().iter().map(|(v, _)| v.index()).eq([7, 9]));
}

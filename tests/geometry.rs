//! Points and planes, the sides of faces, and values between values.

use tearmesh::geometry::between;
use tearmesh::{
    Blend, Plane, PlaneError, Point, Positions, Ray, RayError, Side, Vector, VertexId, classify,
    shapes,
};

#[test]
fn between_a_point_and_itself_is_that_point_bit_for_bit() {
    for x in [-0.0, 0.0, 0.1, -3e300, 5e-324] {
        let p = Point::new(x, -x, x);
        let is = between(p, p, 0.3);
        assert_eq!([is.x, is.y].map(f64::to_bits), [x, -x].map(f64::to_bits));
    }
    assert_eq!(
        between(Point::new(1.0, 2.0, 3.0), Point::new(2.0, 4.0, 1.0), 0.5),
        Point::new(1.5, 3.0, 2.0)
    );
}
#[test]
fn a_point_on_an_oblique_plane_has_offset_zero() {
    let plane = Plane::new(Point::new(1.0, 1.0, 1.0), Vector::new(1.0, 2.0, 3.0)).expect("usable");
    assert_eq!(plane.offset(Point::new(3.0, 3.0, -1.0)), 0.0);
    assert_eq!(
        Side::of(plane.offset(Point::new(3.0, 3.0, -1.0))),
        Side::Front
    );
    assert_eq!(
        Side::of(plane.offset(Point::new(3.0, 3.0, -1.5))),
        Side::Back
    );
    assert_eq!(
        plane.flipped().distance(Point::origin()),
        -plane.distance(Point::origin())
    );
}
#[test]
fn unusable_planes_and_rays_are_refused() {
    let o = Point::origin();
    let x = Vector::x();
    assert!(matches!(
        Plane::new(o, Vector::zeros()),
        Err(PlaneError::Normal { .. })
    ));
    assert!(matches!(
        Plane::new(o, x * f64::NAN),
        Err(PlaneError::Normal { .. })
    ));
    assert!(matches!(
        Plane::new(o + x * f64::INFINITY, x),
        Err(PlaneError::Point { .. })
    ));
    assert!(matches!(
        Plane::new(o + x * 1e76, x),
        Err(PlaneError::Point { .. })
    ));
    assert!(matches!(
        Ray::new(o, Vector::zeros()),
        Err(RayError::Direction { .. })
    ));
    assert!(matches!(
        Ray::new(o + x * f64::NAN, x),
        Err(RayError::Origin { .. })
    ));
}
#[test]
fn faces_of_a_vertex_fall_on_both_sides_and_ties_in_front() {
    // A closed fan in the plane z = 0, cut by the plane x = 0 through the hub.
    let (mesh, positions) = shapes::fan(4, true);
    let hub = VertexId::new(0).expect("an id");
    let plane = Plane::new(positions.at(hub), Vector::x()).expect("usable");
    let mut sides: Vec<_> = classify::faces_of(&mesh, hub, &plane, &positions).collect();
    sides.sort();
    let sides: Vec<Side> = sides.into_iter().map(|(_, side)| side).collect();
    assert_eq!(sides, [Side::Front, Side::Back, Side::Back, Side::Front]);

    let flat = Plane::new(positions.at(hub), Vector::z()).expect("usable");
    assert!(classify::faces_of(&mesh, hub, &flat, &positions).all(|(_, side)| side == Side::Front));
    let flat = flat.flipped();
    assert!(classify::faces_of(&mesh, hub, &flat, &positions).all(|(_, side)| side == Side::Front));
}
#[test]
fn equal_values_give_that_value_bit_for_bit() {
    for x in [-0.0, 0.0, 0.1, -3e300] {
        let value = [Vector::new(x, -x, x)];
        let [is] = value.between(&value, 0.3);
        assert_eq!([is.x, is.y].map(f64::to_bits), [x, -x].map(f64::to_bits));
        assert_eq!(x.between(&x, 0.3).to_bits(), x.to_bits());
    }
    assert_eq!(2.0.between(&4.0, 0.25), 2.5);
}

#[test]
fn positions_of_an_engine_keep_their_bits() {
    let special = [
        0.0,
        -0.0,
        1e-45,
        -3.4e38,
        0.1,
        f32::MIN_POSITIVE,
        1.0 + f32::EPSILON,
    ];
    let points: Vec<[f32; 3]> = (0..343)
        .map(|i| [special[i % 7], special[i / 7 % 7], special[i / 49]])
        .collect();
    let bits = |points: &[[f32; 3]]| {
        points
            .iter()
            .map(|p| p.map(f32::to_bits))
            .collect::<Vec<_>>()
    };
    let positions = Positions::from_f32(points.iter().copied()).expect("finite");
    assert_eq!(bits(&positions.tail_f32(0)), bits(&points));
    assert_eq!(bits(&positions.tail_f32(300)), bits(&points[300..]));
    let mut spoilt = points;
    (spoilt[7][1], spoilt[9][2]) = (f32::NAN, f32::NEG_INFINITY);
    let error = Positions::from_f32(spoilt).expect_err("two are not finite");
    assert!(error.unusable().iter().map(|(v, _)| v.index()).eq([7, 9]));
}

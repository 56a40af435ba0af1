//! The stretch of faces, against that of all their directions.

use tearmesh::{Masses, Mesh, Point, Positions, Vector, VertexId, shapes};
use tearmesh_cloth::{Cloth, Fabric};

use crate::parts::cloths::{cloth, deform};
use crate::parts::shake;
use crate::random::Random;

/// No direction in a face is stretched more, and one is as much: by trying them.
#[test]
fn no_direction_is_stretched_more_than_the_principal_one() {
    let (mesh, positions) = shapes::octahedron();
    let mut cloth = cloth(&mesh, &positions, Fabric::new(50.0));
    shake(cloth.system_mut(), 0.6, 0.0, &mut Random(11));
    for f in mesh.faces() {
        let v = mesh.face_vertices(f).map(VertexId::index);
        let [rest, now] = [positions.as_slice(), cloth.positions()]
            .map(|points| [points[v[1]] - points[v[0]], points[v[2]] - points[v[0]]]);
        let tried = (0..20_000).map(|i| {
            let (s, c) = (std::f64::consts::PI * f64::from(i) / 20_000.0).sin_cos();
            let along = |[a, b]: [Vector; 2]| (a * c + b * s).norm();
            along(now) / along(rest)
        });
        let tried = tried.fold(0.0, f64::max);
        let principal = cloth.principal_stretch(f);
        assert!(tried <= principal * (1.0 + 1e-14) && tried > principal * (1.0 - 1e-6));
    }
}

#[test]
fn a_face_without_area_at_rest_is_a_thread() {
    let mesh = Mesh::build(3, &[[0, 1, 2]]).expect("a face");
    let positions = Positions::new([[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]]).expect("points");
    let spread = Positions::new([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]).expect("points");
    let masses = Masses::area(&mesh, &spread, 1.0).expect("masses");
    let mut cloth = Cloth::new(&mesh, &positions, masses, Fabric::new(1.0)).expect("a cloth");
    let f = mesh.face(0);
    assert_eq!(cloth.principal_stretch(f), 1.0);
    deform(&mut cloth, |p| {
        Point::new(0.0, if p.x == 1.0 { 2.0 } else { p.x }, 0.0)
    });
    assert_eq!(cloth.principal_stretch(f), 2.0);
}

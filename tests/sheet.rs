//! A sheet does what its parts do when they are held alone, and keeps them in step.

use tearmesh::{
    CutMethod, Edits, Masses, PerCorner, Plane, Point, Positions, Scissor, Sheet, Vector, VertexId,
    mend, shapes, split, tear,
};

use crate::random::Random;

fn texture(mesh: &tearmesh::Mesh, positions: &Positions) -> PerCorner<[f64; 3]> {
    let place = |h| positions.at(mesh.origin(h)).coords.into();
    PerCorner::new(mesh.half_edges().map(place).collect())
}

#[test]
fn a_sheet_does_what_its_parts_do() {
    let mut random = Random(11);
    let mut done = [0; 4];
    for _ in 0..40 {
        let (mut mesh, mut positions) = shapes::grid(6, 5);
        let mut masses = Masses::area(&mesh, &positions, 0.3).expect("a grid has an area");
        let mut corners = texture(&mesh, &positions);
        let mut edits = Edits::new();
        let sheet = Sheet::new(mesh.clone(), positions.clone());
        let sheet = sheet.with(corners.clone()).with_masses(0.3);
        let mut sheet = sheet.expect("a grid has an area");
        for _ in 0..8 {
            let kind = random.below(4);
            let number = random.below(mesh.vertex_count());
            let v = mesh.vertex(number);
            let first = edits.cursor();
            match kind {
                0 => {
                    let moving: Vec<_> = mesh.faces_of(v).take(2).collect();
                    let split = split::vertex(&mut mesh, v, &moving, &mut edits);
                    let split = split.map(|split| split.new);
                    assert_eq!(sheet.split(v, &moving), split);
                }
                1 => {
                    let edge = mesh.half_edge_of(v).expect("all vertices have faces");
                    let is_free = |v: VertexId| v.index() > 6;
                    let mass = |v| is_free(v).then(|| masses.at(v));
                    let torn = tear::edge(&mut mesh, edge, &positions, mass, &mut edits);
                    let torn = torn.map(|split| split.new);
                    assert_eq!(sheet.tear(edge, is_free), torn);
                }
                2 => {
                    let at = Point::new(random.next(), random.next(), 0.0);
                    let normal = Vector::new(random.next() - 0.5, random.next(), 0.0);
                    let plane = Plane::new(at, normal).expect("not zero");
                    let scissor = Scissor::by_plane(plane);
                    let parts = (&mut mesh, &mut positions, &mut edits);
                    let report = scissor.cut_measured(CutMethod::Exact, parts.0, parts.1, parts.2);
                    let (_, report) = report.expect("positions are in step");
                    let (_, of_sheet) = sheet
                        .cut_measured(CutMethod::Exact, &scissor)
                        .expect("positions are in step");
                    assert_eq!(of_sheet, report);
                }
                _ => {
                    let chosen = |v: VertexId| v.index() > 12;
                    let stitches = mend::stitches(&mesh, chosen);
                    let mass = |v| masses.at(v);
                    let far = f64::INFINITY;
                    let merges = mend::sew(&mut mesh, &positions, &stitches, mass, far, &mut edits);
                    assert_eq!(Ok(sheet.mend(chosen)), merges);
                }
            }
            edits.replay(&mut (&mut positions, &mut masses, &mut corners));
            done[kind] += usize::from(edits.cursor() != first);
            assert_eq!((sheet.mesh(), sheet.positions()), (&mesh, &positions));
            assert_eq!(sheet.values(), &corners);
            assert_eq!(sheet.edits().cursor(), edits.cursor());
            let of_sheet = sheet.masses().expect("it was made with masses");
            assert!(mesh.vertices().all(|v| of_sheet.at(v) == masses.at(v)));
            assert!(of_sheet.ledger().is_balanced() && sheet.check().is_empty());
        }
    }
    assert!(done.iter().all(|&done| done >= 20), "{done:?}");
}

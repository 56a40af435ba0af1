//! A sheet does what its parts do when they are held alone, and keeps them in step.

use std::panic::{AssertUnwindSafe, catch_unwind};

use tearmesh::engine::DrawBuffers;
use tearmesh::{
    CutMethod, Edits, Follower as _, Followers, Masses, PerCorner, PerVertex, Plane, Point,
    Positions, Scissor, Sheet, Vector, VertexId, mend, shapes, split, tear,
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

/// What a sheet says to values that it does not take.
fn refusal<W: Followers>(sheet: &Sheet, values: W) -> String {
    let taken = catch_unwind(AssertUnwindSafe(|| sheet.clone().with(values)));
    let Err(said) = taken else {
        panic!("the values were taken");
    };
    *said.downcast().expect("a text")
}

/// New values of the mesh after an operation would follow that once more; what they lack is in the message.
#[test]
fn values_for_an_edited_sheet_are_refused_with_their_beginning() {
    let (mesh, positions) = shapes::grid(6, 5);
    let mut sheet = Sheet::new(mesh, positions);
    for operations in 1..=2 {
        let plane = Plane::new(
            Point::new(0.43 / f64::from(operations), 0.0, 0.0),
            Vector::x(),
        );
        let scissor = Scissor::by_plane(plane.expect("a plane"));
        sheet.cut(CutMethod::Exact, &scissor).expect("a cut");
        let (mesh, at) = (sheet.mesh(), sheet.positions());
        let of_corners = texture(mesh, at);
        let of_vertices = || PerVertex::new(vec![0.5; mesh.vertex_count()]);
        let buffers = || DrawBuffers::new(mesh, of_corners.as_slice().to_vec());
        let now = sheet.edits().cursor();
        for said in [
            refusal(&sheet, of_corners.clone()),
            refusal(&sheet, of_vertices()),
            refusal(&sheet, buffers()),
            refusal(&sheet, (of_vertices().starting_at(now), buffers())),
        ] {
            assert!(
                said.contains("begin with `starting_at(edits.cursor())`")
                    || said.contains("begins with `starting_at(edits.cursor())`"),
                "{said}"
            );
        }
        let all = (
            of_corners.clone().starting_at(now),
            buffers().starting_at(now),
        );
        let all = (all, of_vertices().starting_at(now));
        let mut taken = sheet.clone().with(all);
        let down = Plane::new(Point::new(0.0, 0.55, 0.0), Vector::y()).expect("a plane");
        let scissor = Scissor::by_plane(down);
        taken.cut(CutMethod::Exact, &scissor).expect("a cut");
        let ((corners, buffers), vertices) = taken.values();
        assert_eq!(
            *corners,
            texture(taken.mesh(), taken.positions()).starting_at(taken.edits().cursor())
        );
        assert_eq!(buffers.indices().len(), taken.mesh().half_edge_count());
        assert_eq!(vertices.as_slice().len(), taken.mesh().vertex_count());
    }
}

//! Vertices with very many faces: whatever touches one takes time linear in its faces, not in their
//! square.
//!
//! The table: `cargo test -p tearmesh --release --test main -- --ignored --nocapture hub`.

use std::time::Instant;

use tearmesh::{
    CutMethod, Edits, FaceId, Masses, Mesh, Plane, Point, Positions, Ray, Scissor, Vector,
    VertexId, mend, shapes, split,
};

use crate::cuts::METHODS;
use crate::random::Random;

/// Steps and the nanoseconds a face that each took.
struct Clock {
    faces: f64,
    steps: Vec<(String, f64)>,
}

impl Clock {
    fn new(faces: u32) -> Clock {
        Clock {
            faces: f64::from(faces),
            steps: Vec::new(),
        }
    }

    fn time<T>(&mut self, step: impl Into<String>, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let done = work();
        let taken = start.elapsed().as_secs_f64() * 1e9 / self.faces;
        self.steps.push((step.into(), taken));
        done
    }
}

/// A mesh with its followers, and the log.
struct Sheet {
    mesh: Mesh,
    positions: Positions,
    masses: Masses,
    edits: Edits,
}

impl Sheet {
    fn new(mesh: &Mesh, positions: &Positions) -> Sheet {
        Sheet {
            masses: Masses::area(mesh, positions, 1.0).expect("it has an area"),
            mesh: mesh.clone(),
            positions: positions.clone(),
            edits: Edits::new(),
        }
    }

    /// Checks the mesh, and sews everything.
    fn check_and_sew(&mut self, what: &str, clock: &mut Clock) {
        let Sheet {
            mesh,
            positions,
            masses,
            edits,
        } = self;
        edits.replay(&mut (&mut *positions, &mut *masses));
        assert!(masses.ledger().is_balanced(), "{what}");
        assert_eq!(clock.time(format!("{what}: check"), || mesh.check()), []);
        clock.time(format!("{what}: sew"), || {
            let stitches = mend::stitches(mesh, |_| true);
            let weight = |v| masses.at(v);
            mend::sew(mesh, &*positions, &stitches, weight, 1e-9, edits).expect("nothing moved");
        });
        edits.replay(&mut (positions, masses));
        assert!(mesh.half_edges().all(|h| mesh.ghost_pair(h).is_none()));
    }
}

/// The scissor with rays straight down at two places of the plane.
fn scissor(a: [f64; 2], b: [f64; 2]) -> Scissor {
    let down = Vector::new(0.0, 0.0, -1.0);
    let ray = |[x, y]: [f64; 2]| Ray::new(Point::new(x, y, 5.0), down).expect("a ray");
    Scissor::new(ray(a), ray(b)).expect("two rays")
}

/// Cuts a fan in all ways, and mends it.
fn cut(faces: u32, closed: bool, clock: &mut Clock) {
    let (mesh, positions) = clock.time("build", || shapes::fan(faces, closed));
    for method in METHODS {
        for (place, y) in [("the hub", 0.0), ("near", 0.001), ("beside", 0.1)] {
            for (extent, x) in [("finite", 0.5), ("through", 2.0)] {
                let what = format!("{method:?}, {place}, {extent}");
                let mut sheet = Sheet::new(&mesh, &positions);
                let Sheet {
                    mesh: cut,
                    positions,
                    edits,
                    ..
                } = &mut sheet;
                let scissor = scissor([-x, y - 0.3 * x], [x, y + 0.3 * x]);
                let scissor = scissor.through(extent == "through");
                let report = clock.time(what.clone(), || {
                    scissor.cut_measured(method, cut, positions, edits)
                });
                let (_, report) = report.expect("all is in step");
                assert!(report.faces_crossed > 0, "{what}");
                sheet.check_and_sew(&what, clock);
                assert!(method == CutMethod::Exact || sheet.mesh == mesh, "{what}");
            }
        }
    }
}

/// Cuts a crown, whose rim is before and behind a plane through the hub by turns, into as many fans.
fn crown(faces: u32, closed: bool, clock: &mut Clock) {
    let (mesh, positions) = shapes::fan(faces, closed);
    let mut up = (0..).map(|i| if i % 8 < 4 { 0.5 } else { -0.5 });
    let mut points = positions.as_slice().to_vec();
    points[1..]
        .iter_mut()
        .for_each(|p| p.z = up.next().expect("without end"));
    let positions = Positions::new(points).expect("they are finite");
    let ray = |y| Ray::new(Point::new(-5.0, y, 0.0), Vector::x()).expect("a ray");
    let scissor = Scissor::new(ray(-3.0), ray(3.0))
        .expect("two rays")
        .through(true);
    for method in METHODS {
        let what = format!("{method:?}, a crown");
        let mut sheet = Sheet::new(&mesh, &positions);
        let Sheet {
            mesh: cut,
            positions,
            edits,
            ..
        } = &mut sheet;
        let report = clock.time(what.clone(), || {
            scissor.cut_measured(method, cut, positions, edits)
        });
        let splits = report.expect("all is in step").1.splits as u32;
        let is_uniform = method == CutMethod::Uniform;
        assert!(splits > faces / 5 || is_uniform, "{what}: {splits}");
        sheet.check_and_sew(&what, clock);
    }
}

/// Tears a fan face by face until each face has a vertex of its own, and mends it.
fn tear(faces: u32, closed: bool, order: &str, clock: &mut Clock) {
    let (mesh, positions) = shapes::fan(faces, closed);
    let mut sheet = Sheet::new(&mesh, &positions);
    let hub = VertexId::new(0).expect("an id");
    let mut all: Vec<FaceId> = mesh.faces().collect();
    match order {
        "descending" => all.reverse(),
        "shuffled" => {
            let mut random = Random(7);
            random.shuffle(&mut all);
        }
        _ => {}
    }
    let last = all.pop().expect("a face");
    clock.time(format!("torn, {order}"), || {
        for &face in &all {
            split::vertex(&mut sheet.mesh, hub, &[face], &mut sheet.edits).expect("one stays");
        }
    });
    let refused = split::vertex(&mut sheet.mesh, hub, &[last], &mut sheet.edits);
    assert!(matches!(
        refused,
        Err(split::SplitRefusal::Everything { .. })
    ));
    assert_eq!(sheet.mesh.half_edge_of(hub).map(|h| h.face()), Some(last));
    let torn = sheet.mesh.clone();
    sheet.edits.replay(&mut sheet.positions);
    let place = Positions::new(sheet.positions.as_slice().to_vec()).expect("they were accepted");
    sheet.check_and_sew(&format!("torn, {order}"), clock);
    assert_eq!(sheet.mesh, mesh, "{order}");
    if order == "shuffled" {
        rebuild_and_cut(&torn, &place, clock);
    }
}

/// Builds a torn mesh again from its triangles and roots, and cuts it beside the hub.
fn rebuild_and_cut(torn: &Mesh, positions: &Positions, clock: &mut Clock) {
    let again = clock.time("torn: roots, build", || {
        let faces = torn.faces();
        let triangles: Vec<[u32; 3]> = faces
            .map(|f| torn.face_vertices(f).map(u32::from))
            .collect();
        Mesh::build_torn(&triangles, &torn.roots())
    });
    assert_eq!(again.as_ref(), Ok(torn));
    for (what, y) in [("near", 0.001), ("beside", 0.1)] {
        let (mut mesh, mut positions) = (torn.clone(), positions.clone());
        let scissor = scissor([-2.0, y], [2.0, 1.1 * y]).through(true);
        let mut edits = Edits::new();
        let report = clock.time(format!("torn: cut {what}"), || {
            scissor.cut_measured(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)
        });
        assert!(report.expect("all is in step").1.faces_crossed > 0);
        assert_eq!(
            clock.time(format!("torn: cut {what}: check"), || mesh.check()),
            []
        );
    }
}

/// The paper's methods by [`split::by_plane`] alone, which looks at all faces of a vertex each time.
fn cut_by_paper(
    (point, normal): (Point, Vector),
    is_alternating: bool,
    sheet: &mut Sheet,
) -> [usize; 2] {
    let Sheet {
        mesh,
        positions,
        edits,
        ..
    } = sheet;
    let plane = Plane::new(point, normal).expect("a plane");
    let is_positive = |at: Point| plane.offset(at) >= 0.0;
    let count = |mesh: &Mesh, positions: &Positions, f| {
        let corners = mesh.face_vertices(f).into_iter();
        corners.filter(|&v| is_positive(positions.at(v))).count()
    };
    let faces = mesh.faces();
    let crossed = faces.filter(|&f| [1, 2].contains(&count(mesh, positions, f)));
    let crossed: Vec<FaceId> = crossed.collect();
    let [mut splits, mut refused] = [0; 2];
    for f in crossed {
        let corners = mesh.face_vertices(f).map(|v| positions.at(v));
        let negative = (0..3).find(|&i| !is_positive(corners[i]));
        let along_edge = (is_alternating && count(mesh, positions, f) == 2).then(|| {
            let [c, d, e] = [1, 2, 3].map(|i| corners[(negative.expect("one") + i) % 3]);
            (d - c).cross(&(e - c)).cross(&(d - c))
        });
        for h in f.half_edges() {
            let v = mesh.origin(h);
            let at = positions.at(v);
            if !is_positive(at) {
                continue;
            }
            let plane = Plane::new(at, along_edge.unwrap_or(normal)).expect("it has an area");
            let split = split::by_plane(mesh, v, &plane, &*positions, edits).is_some();
            if split {
                splits += 1;
                edits.replay(positions);
            } else {
                refused += 1;
            }
        }
    }
    [splits, refused]
}

/// Fans of any number of faces with rims of any height, flat on the plane here and there, and torn
/// before or not.
#[test]
fn the_papers_methods_at_a_hub_are_those_of_by_plane() {
    let mut random = Random(31);
    let mut splits_of_all = 0;
    for case in 0..600 {
        let faces = [12, 64, 65, 66, 150, 400][case % 6];
        let (mesh, flat) = shapes::fan(faces, case % 4 < 2);
        // In any order, so that a walk round the hub begins anywhere.
        let mut triangles: Vec<[u32; 3]> = mesh.indices().as_chunks().0.to_vec();
        random.shuffle(&mut triangles);
        let mesh = Mesh::build(mesh.vertex_count(), &triangles).expect("a fan");
        let mut points = flat.as_slice().to_vec();
        let steps = [0.0, 2.0, 1000.0][case / 6 % 3];
        for p in &mut points[1..] {
            p.z = (steps * (random.next() - 0.5)).round() / f64::max(steps, 1.0);
        }
        let positions = Positions::new(points).expect("they are finite");
        let mut sheet = Sheet::new(&mesh, &positions);
        let hub = VertexId::new(0).expect("an id");
        if case % 5 == 0 {
            for _ in 0..10 {
                let f = mesh
                    .faces()
                    .nth((random.next() * f64::from(faces)) as usize);
                let f = f.expect("a face");
                let _refused = split::vertex(&mut sheet.mesh, hub, &[f], &mut sheet.edits);
            }
            sheet.edits.replay(&mut sheet.positions);
        }
        let mut part = |scale: f64| scale * (random.next() - 0.5);
        let point = Point::new(0.0, [0.0, part(0.4)][case / 18 % 2], 0.0);
        let normal = match case / 36 % 3 {
            0 => Vector::z(),
            1 => Vector::new(part(1.0), part(1.0), part(1.0)),
            _ => Vector::new(part(1.0), part(1.0), 0.0),
        };
        for method in [CutMethod::Uniform, CutMethod::Alternating] {
            let copy = || Sheet {
                mesh: sheet.mesh.clone(),
                positions: sheet.positions.clone(),
                masses: sheet.masses.clone(),
                edits: sheet.edits.clone(),
            };
            let (mut one, mut other) = (copy(), copy());
            let counts = cut_by_paper((point, normal), method == CutMethod::Alternating, &mut one);
            let scissor = Scissor::by_plane(Plane::new(point, normal).expect("a plane"));
            let made = scissor.cut_measured(
                method,
                &mut other.mesh,
                &mut other.positions,
                &mut other.edits,
            );
            let (_, report) = made.expect("all is in step");
            let what = format!("case {case}, {method:?}");
            assert_eq!([report.splits, report.refused], counts, "{what}");
            assert!(one.mesh == other.mesh, "{what}");
            assert!(one.edits.iter().eq(other.edits.iter()), "{what}");
            splits_of_all += report.splits;
        }
    }
    assert!(splits_of_all > 5000, "{splits_of_all}");
}

const ORDERS: [&str; 3] = ["ascending", "descending", "shuffled"];

/// With a square in it this takes minutes; as it is, a few seconds.
#[test]
fn a_large_hub_is_cut_torn_and_mended() {
    let faces = 100_000;
    let mut clock = Clock::new(faces);
    cut(faces, true, &mut clock);
    for closed in [true, false] {
        crown(faces, closed, &mut clock);
    }
    for order in ORDERS {
        tear(faces, order == "shuffled", order, &mut clock);
    }
}

#[test]
#[ignore = "a table of times"]
fn hub_table() {
    let sizes: Vec<u32> = (0..8).map(|i| 10_000 << i).collect();
    for closed in [true, false] {
        let mut clocks: Vec<Clock> = Vec::new();
        for &faces in &sizes {
            let mut clock = Clock::new(faces);
            cut(faces, closed, &mut clock);
            crown(faces, closed, &mut clock);
            for order in ORDERS {
                tear(faces, closed, order, &mut clock);
            }
            clocks.push(clock);
        }
        println!("\nclosed: {closed}; ns a face, by thousands of faces round one vertex");
        print!("{:44}", "");
        sizes.iter().for_each(|faces| print!("{:>7}", faces / 1000));
        println!();
        for (i, (step, _)) in clocks[0].steps.iter().enumerate() {
            print!("{step:44}");
            for clock in &clocks {
                print!("{:7.0}", clock.steps[i].1);
            }
            println!();
        }
    }
}

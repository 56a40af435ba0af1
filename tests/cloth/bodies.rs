//! Contact with friction, and bodies as colliders.

pub(crate) mod moving;
mod oracle;
mod sewn;
mod still;

use std::sync::Arc;

use tearmesh::{Mesh, Point, Positions, Scissor, Vector, shapes};
use tearmesh_cloth::{
    Balance, Body, BodyError, Cloth, Collider, ColliderShape, Fabric, Loads, Method, Simulation,
    SimulationDef, Unstable, Verlet, Wounds, implicit,
};

use self::oracle::Solid;
use crate::parts::cloths::cloth;
use crate::parts::{
    G, METHODS, gravity_along_y, implicit_by_default, method, near, on_a_line, onto, plane, pulled,
    take, take_observed, v,
};
use crate::random::Random;
use crate::support::fixtures::block;

/// The coefficient of friction.
const MU: f64 = 0.4;

/// A particle after two seconds on a level floor, from rest, under gravity that leans so far that its part
/// along the floor is `ratio` times what friction can hold. Gives the way and the speed along the floor.
fn slide(floor: &Collider, height_m: f64, ratio: f64, name: &str, dt_s: f64) -> [f64; 2] {
    let normal = G / (1.0 + MU * MU * ratio * ratio).sqrt();
    let lean = Vector::new(MU * ratio * normal, 0.0, -normal);
    let mut stone = on_a_line([0.0], 0.1);
    stone.state_mut().0[0].z = height_m;
    let loads = onto(floor.clone(), &pulled(lean, 0.0));
    stone.set_loads(loads).expect("loads");
    let mut balance = Balance::new(&stone);
    let (observed, steps) = ((&mut stone, &mut balance), (2.0 / dt_s).round() as usize);
    take_observed(observed, &mut *method(name, 1), dt_s, steps);
    near(balance.now(&stone).made_j(), 0.0, 0.02 * G * 0.1 * 20.0);
    let [way, speed] = [stone.positions()[0].coords, stone.velocities()[0]];
    near(speed.z, 0.0, 1e-12);
    [way.x.hypot(way.y), speed.x.hypot(speed.y)]
}

/// Coulomb's law: what friction can hold does not creep, what it cannot slides by the difference.
fn obeys_coulomb(floor: &Collider, height_m: f64) {
    let floor = floor.clone().with_friction(MU);
    for name in METHODS {
        for dt_s in [0.01, 0.004] {
            let [crept, _] = slide(&floor, height_m, 0.98, name, dt_s);
            assert!(crept < 1e-3, "{name} {dt_s}: crept {crept} m");
            let [slid, _] = slide(&floor, height_m, 1.02, name, dt_s);
            assert!(slid > 0.05, "{name} {dt_s}: slid {slid} m");
            let [way, speed] = slide(&floor, height_m, 2.0, name, dt_s);
            let cosine = 1.0 / (1.0 + 4.0 * MU * MU).sqrt();
            let acceleration = G * MU * cosine;
            near(speed / 2.0 / acceleration, 1.0, 0.02);
            near(way / 2.0 / acceleration, 1.0, 0.02);
        }
    }
}

#[test]
fn friction_of_a_plane_obeys_coulomb_by_every_method() {
    let floor = Collider::plane(plane([0.0, 0.0, 0.25], Vector::z()));
    obeys_coulomb(&floor, 0.25);
}

#[test]
fn friction_of_a_body_obeys_coulomb_by_every_method() {
    let (points, faces) = block([-1.0, -1.0, -0.5], [12.0, 1.0, 0.0]);
    let block = Body::new(&points, &faces, Some(0.1)).expect("a body");
    let height_m = 2.0 * block.error_worst_m();
    obeys_coulomb(&Collider::body(Arc::new(block)), height_m);
}

/// A stone slides on a floor, a tenth of a millimetre from a rougher wall, which it never touches.
#[test]
fn what_presses_a_floor_is_not_rubbed_by_a_wall() {
    for name in METHODS {
        let mut stone = on_a_line([0.0], 0.1);
        let wall = Collider::plane(plane([0.0, -1e-4, 0.0], Vector::y())).with_friction(0.9);
        let floor = Collider::plane(plane([0.0; 3], Vector::z())).with_friction(0.1);
        let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -G));
        let colliders = vec![floor, wall];
        let loads = Loads {
            gravity_m_per_s2,
            colliders,
            ..Loads::default()
        };
        stone.set_loads(loads).expect("loads");
        stone.state_mut().1[0] = Vector::x();
        take(&mut stone, &mut *method(name, 1), 0.01, 50);
        near(stone.velocities()[0].x, 1.0 - 0.1 * G * 0.5, 0.01);
    }
}

/// The tailor's dummy of our own making, and its body.
fn dummy() -> (Solid, Arc<Body>) {
    let solid = Solid::read(include_str!("../data/dummy.obj"), 1.0);
    let body = Arc::new(body(&solid, 0.01));
    (solid, body)
}

/// A body of these triangles.
fn body(solid: &Solid, cell_m: f64) -> Body {
    let points: Vec<Point> = solid.points.iter().copied().map(Point::from).collect();
    Body::new(&points, &solid.faces, Some(cell_m)).expect("a body")
}

/// At random places at the skin and outside of it, up to a cell away.
#[test]
fn a_grid_errs_by_what_it_says_of_itself() {
    let mut solids = vec![("dummy", dummy().0, 0.008)];
    let corpus = std::env::var_os("TEARMESH_CORPUS");
    let person =
        corpus.map(|folder| std::path::Path::new(&folder).join("../bodies/body_proxy741.obj"));
    match person.and_then(|path| std::fs::read_to_string(path).ok()) {
        Some(text) => solids.push(("person", Solid::read(&text, 0.1), 0.012)),
        None => println!("without the person, which is not in this repository"),
    }
    for (name, solid, cell_m) in solids {
        let body = body(&solid, cell_m);
        let mut random = Random(35);
        let (mut worst, mut squares) = (0.0_f64, 0.0);
        for _ in 0..1500 {
            // Beside a face.
            let face = solid.faces[random.below(solid.faces.len())];
            let [a, b, c] = face.map(|v| Point::from(solid.points[v as usize]));
            let (u, v) = (random.next(), random.next());
            let (u, v) = if u + v > 1.0 {
                (1.0 - u, 1.0 - v)
            } else {
                (u, v)
            };
            let outward = (b - a).cross(&(c - a)).normalize();
            let p = a + (b - a) * u + (c - a) * v + outward * (random.next() * cell_m);
            let exact = solid.distance([p.x, p.y, p.z]);
            if (0.0..cell_m).contains(&exact) {
                let error = body.distance_m(p) - exact;
                worst = worst.max(error.abs());
                squares += error * error;
            }
        }
        let rms = (squares / 1500.0).sqrt();
        assert!(worst < 1.25 * body.error_worst_m(), "{name}: {worst}");
        assert!(rms < 1.5 * body.error_rms_m(), "{name}: {rms}");
        // Far away there is a bound.
        let far = body.distance_m(Point::new(0.0, 3.0, 0.0));
        assert!(far > 1.5 && far < 2.3, "{name}: {far}");
    }
}

/// A square sheet of so many cells a side, level at a height.
pub(crate) fn sheet(cells: u32, side_m: f64, height_m: f64) -> (Mesh, Positions) {
    let (mesh, flat) = shapes::grid_with_diagonals(cells, cells, |i, j| (i + j) % 2 == 0);
    let points = flat.as_slice().iter();
    let points = points.map(|p| [(p.x - 0.5) * side_m, height_m, (p.y - 0.5) * side_m]);
    (mesh, Positions::new(points).expect("finite"))
}

/// A sheet above the dummy, with friction.
fn above_dummy(dummy: &Arc<Body>, side_m: f64, height_m: f64, drag_per_s: f64) -> Cloth {
    let (mesh, positions) = sheet(12, side_m, height_m);
    let mut sheet = cloth(&mesh, &positions, Fabric::new(100.0));
    let skin = Collider::body(dummy.clone()).with_friction(MU);
    let system = sheet.system_mut();
    let set = system.set_loads(onto(skin, &gravity_along_y(drag_per_s)));
    set.expect("loads");
    system.when_unstable(Unstable::Substep);
    sheet
}

/// Fails if a vertex is nearer than its thickness less the worst error of the grid, or the middle of a face is
/// under the skin, by more than this.
fn is_outside(name: &str, (solid, body): (&Solid, &Body), cloth: &Cloth, slack_m: f64) {
    let (points, faces) = (cloth.positions(), cloth.indices());
    let vertices = points.iter().map(|p| solid.distance([p.x, p.y, p.z]));
    let vertex = vertices.fold(f64::INFINITY, f64::min);
    let middles = faces.as_chunks::<3>().0.iter().map(|face| {
        let [a, b, c] = face.map(|v| points[v as usize].coords);
        solid.distance(((a + b + c) / 3.0).into())
    });
    let middle = middles.fold(f64::INFINITY, f64::min);
    let kept = body.error_worst_m() - slack_m;
    assert!(
        vertex >= kept,
        "{name}: a vertex is {vertex} m from the skin, not {kept}"
    );
    assert!(
        middle >= -slack_m,
        "{name}: the middle of a face is {middle} m from the skin"
    );
}

#[test]
fn a_sheet_dropped_on_a_dummy_rests_by_every_method() {
    let (solid, dummy) = dummy();
    for (name, dt_s) in [
        ("guarded", 0.001_f64),
        ("limited", 0.001),
        ("Euler", 0.01),
        ("BDF2", 0.01),
        ("XPBD", 0.004),
        ("PBD", 0.004),
    ] {
        let mut sheet = above_dummy(&dummy, 0.4, 0.9, 3.0);
        let steps = (4.0 / dt_s).round() as usize;
        let mut solver = match name {
            "Euler" => Box::new(implicit_by_default(implicit::Method::BackwardEuler)),
            "BDF2" => Box::new(implicit_by_default(implicit::Method::Bdf2)),
            _ => method(name, 2),
        };
        take(sheet.system_mut(), &mut *solver, dt_s, steps);
        is_outside(name, (&solid, &dummy), &sheet, 0.0);
        let speeds = sheet.system().velocities().iter();
        let rms = (speeds.map(|v| v.norm_squared()).sum::<f64>() / 169.0).sqrt();
        assert!(rms < 0.01, "{name}: {rms} m/s");
        let lowest = sheet.positions().iter().map(|p| p.y).fold(9.0, f64::min);
        assert!(lowest > 0.3, "{name}: it slid off");
    }
}

/// Five seconds of pushes in all directions, half a second apart. (One look of thirty finds the middle of a face up to
/// .34 mm inside, where one push is in the way of another.)
#[test]
fn no_push_gets_a_vertex_or_a_face_far_under_the_skin() {
    let (solid, dummy) = dummy();
    let slack_m = 0.15 * dummy.error_worst_m();
    for seed in 0..20 {
        let mut random = Random(seed);
        let mut sheet = above_dummy(&dummy, 0.45, 0.85, 0.5);
        for push in 0..10 {
            let mut any = || Vector::from_fn(|_, _| random.next() - 0.5);
            let all = any() * 2.0;
            for v in sheet.system_mut().state_mut().1 {
                *v += all + any();
            }
            take(sheet.system_mut(), &mut Verlet, 0.0015, 333);
            if push % 2 == 1 {
                is_outside("pushed", (&solid, &dummy), &sheet, slack_m);
            }
        }
    }
}

/// What could come out at the other side is stepped more finely.
#[test]
fn a_drop_at_thirty_metres_a_second_does_not_pass_through() {
    let (solid, dummy) = dummy();
    for name in ["guarded", "Euler", "XPBD"] {
        let mut sheet = above_dummy(&dummy, 0.4, 1.1, 0.5);
        sheet.system_mut().state_mut().1.fill(Vector::y() * -30.0);
        take(sheet.system_mut(), &mut *method(name, 1), 0.001, 30);
        let substeps = sheet.system().counters().substeps;
        assert!(substeps > 30, "{name}: no step was divided");
        is_outside(name, (&solid, &dummy), &sheet, 0.0);
        // Above the neck.
        assert!(sheet.positions()[84].y > 0.82, "{name}");
    }
}

/// Far from a body nothing is looked at, and what hangs beside it is looked at as often as it has to be.
#[test]
fn looks_are_saved_where_nothing_is_near() {
    let (_, dummy) = dummy();
    let looks = |height_m: f64| {
        let mut sheet = above_dummy(&dummy, 0.4, height_m, 0.5);
        sheet.system_mut().hold(0);
        sheet.system_mut().hold(12);
        take(sheet.system_mut(), &mut Verlet, 0.001, 400);
        let counters = sheet.system().counters();
        (counters.features.collider, counters.force_evaluations)
    };
    let all = 169 + 288;
    // One look each, and one force a step.
    assert_eq!(looks(2.0), (all, 401));
    let (near, forces) = looks(0.9);
    assert!(near > all && near < 100 * all, "{near}");
    assert_eq!(forces, 401);
}

/// A sheet that has fallen on the dummy.
fn fallen_on(dummy: &Arc<Body>, method: Method) -> Simulation {
    let (mesh, positions) = sheet(12, 0.4, 0.85);
    let skin = Collider::body(dummy.clone()).with_friction(MU);
    let def = SimulationDef {
        fabric: Fabric::new(100.0),
        loads: onto(skin, &gravity_along_y(0.5)),
        method,
        ..SimulationDef::default()
    };
    let mut sim = Simulation::new(mesh, &positions, def).expect("a simulation");
    sim.advance(0.7, 10_000).expect("it falls");
    sim
}

#[test]
fn cloth_tears_and_heals_on_a_body() {
    let (solid, dummy) = dummy();
    for method in [Method::Verlet, Method::xpbd()] {
        let mut sim = fallen_on(&dummy, method);
        let across = Scissor::by_plane(plane([0.06, 0.0, 0.0], Vector::x()));
        let cut = sim.cut(&across).expect("a cut");
        sim.advance(0.2, 10_000).expect("it parts");
        sim.heal(Wounds::Cut(cut)).expect("it heals");
        sim.advance(0.3, 10_000).expect("it draws together");
        sim.hold([v(168)]).expect("a corner");
        let hand = sim.grab(v(0), 0.0).expect("the other corner");
        let whole = sim.mesh().vertex_count();
        let away = Point::new(-0.7, 0.7, -0.7);
        sim.lead(hand, away).expect("a place");
        sim.advance(0.3, 10_000).expect("it tears");
        assert!(sim.mesh().vertex_count() > whole, "nothing tore");
        is_outside("torn", (&solid, &dummy), sim.cloth(), 0.0);
    }
}

/// At many places; what fails where there were nine while a long way alone was too fast. At four the halves have slid
/// down on both sides: wounds are drawn through the body, which stretches slivers to many times their length. Which
/// places fail is chance: three to six of the twelve, for ripples of the sheet from 1e-9 to 1e-3 m.
#[test]
fn implicit_steps_cut_and_heal_on_a_body_where_halves_stay() {
    let (_, dummy) = dummy();
    let mut failed = Vec::new();
    for place in (0..12).map(f64::from) {
        let mut sim = fallen_on(&dummy, Method::implicit());
        let turn = place * 0.5;
        let normal = Vector::new(turn.cos(), 0.0, turn.sin());
        let across = Scissor::by_plane(plane(normal * (0.01 * place - 0.06), normal));
        let cut = sim.cut(&across).expect("a cut");
        let parted = sim.advance(0.2, 10_000).err();
        sim.heal(Wounds::Cut(cut)).expect("it heals");
        let healed = sim.advance(0.6, 10_000).err();
        let errors = parted.into_iter().chain(healed);
        failed.extend(errors.map(|error| format!("{place}: {error}")));
    }
    assert!(failed.len() <= 6, "{failed:#?}");
}

#[test]
fn what_is_no_body_is_refused_with_the_reason() {
    let (points, faces) = block([0.0; 3], [1.0; 3]);
    let refused = |points: &[Point], faces: &[[u32; 3]], cell_m| {
        Body::new(points, faces, Some(cell_m)).expect_err("no body")
    };
    let open = refused(&points, &faces[2..], 0.1);
    assert_eq!(open, BodyError::Open { edges: 4, of: 17 });
    assert_eq!(
        open.to_string(),
        "the body is open: 4 of its 17 edges lack a face"
    );
    assert_eq!(refused(&points, &[], 0.1), BodyError::Empty);
    assert_eq!(
        refused(&points, &[[0, 1, 8]], 0.1),
        BodyError::Face { face: 0 }
    );
    let mut broken = points.clone();
    broken[3].y = f64::NAN;
    assert_eq!(refused(&broken, &faces, 0.1), BodyError::Face { face: 0 });
    for cell_m in [1e-4, 0.0, f64::NAN] {
        let BodyError::Cell { least_m, .. } = refused(&points, &faces, cell_m) else {
            panic!("{cell_m} is taken");
        };
        let least_m = least_m.expect("a cell");
        assert!(least_m > 3e-3 && least_m < 5e-3, "{least_m}");
    }
    // Turned inside out it is the same, and so are its bits.
    let body = Body::new(&points, &faces, Some(0.1)).expect("a body");
    let turned: Vec<[u32; 3]> = faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert_eq!(Body::new(&points, &turned, Some(0.1)), Ok(body.clone()));
    // A thickness within the error of the grid keeps nothing out.
    let worst_m = body.error_worst_m();
    let mut skin = Collider::body(Arc::new(body));
    if let ColliderShape::Body { thickness_m, .. } = &mut skin.shape {
        *thickness_m = 0.9 * worst_m;
    }
    let mut stone = on_a_line([5.0], 1.0);
    let error = stone.set_loads(onto(skin, &Loads::default()));
    let error = error.expect_err("too thin").to_string();
    assert!(error.starts_with("colliders.thickness_m is "), "{error}");
}

//! Bodies that move: what they touch goes along with them.

use std::sync::Arc;

use tearmesh::{Mesh, Point, Vector};
use tearmesh_cloth::{
    Balance, Body, Cloth, Collider, ColliderShape, Fabric, Path, RigidMotion, StepError, Unstable,
};

use super::oracle::Solid;
use super::{MU, above_dummy, block, dummy, is_outside, sheet};
use crate::parts::cloths::cloth;
use crate::parts::{G, METHODS, gravity_along_y, method, near, onto, plane, take};

/// A body that moves, with friction.
pub(crate) fn moving(body: &Arc<Body>, motion: RigidMotion) -> Collider {
    let mut collider = Collider::body(body.clone()).with_friction(MU);
    if let ColliderShape::Body { motion: still, .. } = &mut collider.shape {
        *still = motion;
    }
    collider
}

/// A path by its places at every hundredth of a second, of so many.
fn path(count: u32, at: impl Fn(f64) -> Vector) -> Option<Path> {
    let times = (0..=count).map(|i| f64::from(i) * 0.01);
    Path::new(times.map(|time_s| (time_s, at(time_s).into())))
}

/// A motion without turns.
pub(crate) fn sliding(moves: Option<Path>) -> RigidMotion {
    RigidMotion {
        moves,
        ..RigidMotion::default()
    }
}

/// A block with its upper side at 0, and a sheet that lies on it.
fn on_a_block(motion: RigidMotion, at: Vector) -> Cloth {
    let (points, faces) = block([-2.0, -0.5, -1.0], [6.0, 0.0, 1.0]);
    let body = Arc::new(Body::new(&points, &faces, Some(0.1)).expect("a body"));
    let (mesh, positions) = sheet(3, 0.2, 2.0 * body.error_worst_m());
    let mut sheet = cloth(&mesh, &positions, Fabric::new(100.0));
    let system = sheet.system_mut();
    system.state_mut().0.iter_mut().for_each(|x| *x += at);
    let loads = onto(moving(&body, motion), &gravity_along_y(0.0));
    system.set_loads(loads).expect("loads");
    system.when_unstable(Unstable::Substep);
    sheet
}

/// The middle of a sheet, and its mean velocity.
fn middle(sheet: &Cloth) -> [Vector; 2] {
    let (x, system) = (sheet.positions(), sheet.system());
    let sum: Vector = x.iter().map(|x| x.coords).sum();
    let momentum: Vector = system.velocities().iter().sum();
    [sum, momentum].map(|sum| sum / x.len() as f64)
}

#[test]
fn a_sliding_block_takes_a_sheet_along_by_friction() {
    for name in METHODS {
        for dt_s in [0.01_f64, 0.004] {
            // It starts at once, and the sheet catches up.
            let motion = sliding(path(100, |time_s| Vector::x() * time_s));
            let mut sheet = on_a_block(motion, Vector::zeros());
            let mut balance = Balance::new(sheet.system_mut());
            let mut solver = method(name, 1);
            for step in 1..=(0.8 / dt_s).round() as u32 {
                let system = sheet.system_mut();
                let taken = system.step_observed(&mut *solver, dt_s, Some(&mut balance));
                taken.expect(name);
                let time_s = f64::from(step) * dt_s;
                let reached = (MU * G * time_s).min(1.0);
                let [_, v] = middle(&sheet);
                assert!((v.x - reached).abs() < 0.05, "{name} {dt_s} {time_s}: {v}");
            }
            let [x, v] = middle(&sheet);
            let behind_m = 0.5 / (MU * G);
            assert!((v.x - 1.0).abs() < 1e-3, "{name} {dt_s}: {v}");
            assert!((x.x - 0.8 + behind_m).abs() < 0.02, "{name} {dt_s}: {x}");
            assert!(x.z.abs() < 1e-3, "{name} {dt_s}: {x}");
            let now = balance.now(sheet.system());
            let mass: f64 = sheet.system().masses().iter().sum();
            // What only lies is let fall and lifted in each step, by up to g² Δt² / 2.
            let lifted = 0.52 * G * G * dt_s * 0.8;
            near(now.colliders_j / mass, 0.5, 0.01 + lifted);
            assert!(
                now.made_j().abs() < (0.01 + lifted) * mass,
                "{name} {dt_s}: {now:?}"
            );
            // What friction can do is not enough for more.
            for (share, is_taken) in [(0.9, true), (1.5, false)] {
                let a = share * MU * G;
                let moves = path(60, |time_s| Vector::x() * (0.5 * a * time_s * time_s));
                let mut sheet = on_a_block(sliding(moves), Vector::zeros());
                let steps = (0.6 / dt_s).round() as usize;
                take(sheet.system_mut(), &mut *method(name, 1), dt_s, steps);
                let [x, v] = middle(&sheet);
                let goes = if is_taken { a } else { MU * G };
                let far_m = 0.5 * goes * 0.36;
                assert!((x.x - far_m).abs() < 0.02, "{name} {dt_s} {share}: {x}");
                assert!((v.x - goes * 0.6).abs() < 0.06, "{name} {dt_s}: {v}");
            }
        }
    }
}

/// The turn of a table about y that gets up to a speed in a second and keeps it.
fn turning(rad_per_s: f64) -> RigidMotion {
    let angle = |time_s: f64| match time_s < 1.0 {
        true => 0.5 * rad_per_s * time_s * time_s,
        false => rad_per_s * (time_s - 0.5),
    };
    RigidMotion {
        turns: path(250, |time_s| Vector::y() * angle(time_s)),
        ..RigidMotion::default()
    }
}

#[test]
fn a_turntable_keeps_a_sheet_until_it_is_too_fast() {
    let at = Vector::new(0.0, 0.0, 0.5);
    for name in METHODS {
        let dt_s = 0.004;
        let end = |motion: RigidMotion| {
            let mut sheet = on_a_block(motion, at);
            take(sheet.system_mut(), &mut *method(name, 1), dt_s, 500);
            middle(&sheet)[0]
        };
        // Twice a radian a second asks for half of what friction can do, four for twice as much.
        let slow = turning(2.0);
        let kept = slow.at(2.0).to_world(at.into());
        let x = end(slow);
        assert!(
            (x.xz() - kept.coords.xz()).norm() < 0.02,
            "{name}: {x} of {kept}"
        );
        let x = end(turning(4.0));
        assert!(x.xz().norm() > 0.7, "{name}: {x}");
    }
}

#[test]
fn a_body_too_fast_is_followed_in_parts_or_refused() {
    for name in ["guarded", "Euler", "XPBD"] {
        for (speed, is_taken) in [(90.0, true), (3e6, false)] {
            let rise = |time_s: f64| Vector::y() * (speed * time_s - 0.3);
            let places = [0.0, 1.0].map(|time_s| (time_s, Point::from(rise(time_s))));
            let mut sheet = on_a_block(sliding(Path::new(places)), Vector::zeros());
            let mut solver = method(name, 1);
            let mut step = |_| sheet.system_mut().step(&mut *solver, 0.01).err();
            match (0..5).find_map(&mut step) {
                None => {
                    let substeps = sheet.system().counters().substeps;
                    assert!(is_taken && substeps > 5, "{name}: {substeps}");
                    let lowest = sheet.positions().iter().map(|x| x.y);
                    let lowest = lowest.fold(f64::INFINITY, f64::min);
                    assert!(lowest > rise(0.05).y, "{name}: {lowest}");
                }
                Some(error) => {
                    assert!(!is_taken, "{name}: {error}");
                    assert!(matches!(error, StepError::TooFar { .. }), "{error}");
                }
            }
        }
    }
}

/// A block that comes down on a sheet on a floor, until there is no room between the two.
#[test]
fn a_sheet_between_two_colliders_is_pressed_by_both() {
    let (points, faces) = block([-0.2, 0.1, -0.2], [0.2, 0.4, 0.2]);
    let body = Arc::new(Body::new(&points, &faces, Some(0.02)).expect("a body"));
    for name in METHODS {
        let down = |time_s: f64| Vector::y() * (-0.3 * time_s);
        let places = [0.0, 1.0].map(|time_s| (time_s, Point::from(down(time_s))));
        let (mesh, positions) = sheet(6, 0.1, 0.001);
        let mut sheet = cloth(&mesh, &positions, Fabric::new(100.0));
        let mut loads = onto(
            Collider::plane(plane([0.0; 3], Vector::y())),
            &gravity_along_y(0.0),
        );
        loads
            .colliders
            .push(moving(&body, sliding(Path::new(places))));
        let system = sheet.system_mut();
        system.set_loads(loads).expect("loads");
        system.when_unstable(Unstable::Substep);
        let mut solver = method(name, 1);
        let mut step = |_| sheet.system_mut().step(&mut *solver, 0.005).err();
        let error = (0..200).find_map(&mut step).expect("there is no room");
        let StepError::Pressed {
            particle,
            colliders,
            elapsed_s,
        } = error
        else {
            panic!("{name}: {error}");
        };
        assert_eq!(colliders, [0, 1], "{name}");
        let x = sheet.positions()[particle];
        assert!(x.x.abs().max(x.z.abs()) < 0.3 && x.y < 0.05, "{name}: {x}");
        assert!(elapsed_s > 0.3, "{name}: {elapsed_s}");
    }
}

/// A dummy that walks and turns with a sheet on its shoulders.
#[test]
fn nothing_gets_under_the_skin_of_a_dummy_that_moves() {
    let (solid, dummy) = dummy();
    let motion = RigidMotion {
        moves: path(200, |time_s| {
            Vector::new(0.3 * time_s, 0.1 * time_s * time_s, 0.0)
        }),
        turns: path(200, |time_s| Vector::new(0.1 * time_s, time_s, 0.0)),
        about: Point::new(0.0, 0.4, 0.1),
    };
    let mut sheet = above_dummy(&dummy, 0.4, 0.85, 0.5);
    let loads = onto(moving(&dummy, motion.clone()), &gravity_along_y(0.5));
    sheet.system_mut().set_loads(loads).expect("loads");
    let mut solver = method("guarded", 1);
    for fifth in 1..=10 {
        take(sheet.system_mut(), &mut *solver, 0.001, 200);
        let pose = motion.at(f64::from(fifth) * 0.2);
        let points = solid.points.iter();
        let moved = Solid {
            points: points.map(|&p| pose.to_world(p.into()).into()).collect(),
            faces: solid.faces.clone(),
        };
        is_outside("moved", (&moved, &dummy), &sheet, 0.0);
    }
    let [x, _] = middle(&sheet);
    let shoulders = motion.at(2.0).to_world(Point::new(0.0, 0.8, 0.0));
    assert!((x - shoulders.coords).norm() < 0.2, "{x} of {shoulders}");
}

#[test]
fn skins_are_drawn_where_colliders_are() {
    let (centre, (solid, dummy)) = (Point::new(3.0, -2.0, 1.0), dummy());
    let motion = RigidMotion {
        moves: path(100, |time_s| Vector::new(time_s, 0.0, -time_s)),
        turns: path(100, |time_s| Vector::new(0.0, 5.0 * time_s, time_s)),
        about: Point::new(0.5, 0.0, 0.0),
    };
    let colliders = [
        Collider::plane(plane(centre, Vector::y())),
        Collider::sphere(centre, 0.7),
        moving(&dummy, motion.clone()),
    ];
    let (skin, sides) = Collider::skins(&colliders, 0.4);
    let (ball, moved) = skin.split_at(skin.len() - solid.points.len());
    let (of_ball, _) = sides.split_at(sides.len() - solid.faces.len());
    // The ball is round and closed, and looks outward.
    let is_round = |p: &Point| ((p - centre).norm() - 0.7).abs() < 1e-12;
    assert!(ball.len() > 400 && ball.iter().all(is_round));
    let mesh = Mesh::build(ball.len(), of_ball).expect("faces join");
    assert!(mesh.half_edges().all(|h| mesh.pair(h).is_some()));
    let volumes = of_ball.iter().map(|side| {
        let [a, b, c] = side.map(|v| ball[v as usize] - centre);
        a.dot(&b.cross(&c)) / 6.0
    });
    let whole = 4.0 / 3.0 * std::f64::consts::PI * 0.343;
    near(volumes.sum::<f64>() / whole, 1.0, 0.03);
    // The body is where its motion says, also as a matrix.
    let pose = motion.at(0.4);
    for (&p, moved) in solid.points.iter().zip(moved) {
        let p = Point::from(p);
        assert_eq!(pose.to_world(p), *moved);
        let by_matrix = pose.matrix() * p.to_homogeneous();
        assert!((by_matrix - moved.coords).norm() < 1e-12);
    }
}

//! The ripple of flat cloths: where there is one, how large it is, and that it is a function of the place.

use tearmesh::nalgebra::{Isometry3, Translation3, UnitQuaternion};
use tearmesh::{Mesh, Point, Positions, Vector};
use tearmesh_cloth::scene::{Axis, Frame, Run, Scene, SwayingWind, TearLog};
use tearmesh_cloth::{
    Loads, Method, Simulation, SimulationDef, SimulationError, Unstable, Wind, implicit,
};

use crate::parts::scenes::{square, staged};
use crate::parts::v;
use crate::random::Random;

/// A step in which nothing moves by as much as a ripple of an attometre.
const INSTANT_S: f64 = 1e-12;

/// What moves a cloth as a whole.
#[derive(Clone, Copy)]
enum Act {
    Hold,
    Wind,
    Nothing,
}

/// Where a cloth that begins at these points is after an instant.
fn after_an_instant(
    mesh: &Mesh,
    points: &[Point],
    act: Act,
    ripple_m: Option<f64>,
) -> Result<Vec<Point>, SimulationError> {
    let wind = Wind {
        velocity_m_per_s: Vector::zeros(),
        coefficient: 1.0,
    };
    let positions = Positions::new(points.iter().copied()).expect("usable places");
    let def = SimulationDef {
        loads: Loads {
            wind: Some(wind).filter(|_| matches!(act, Act::Wind)),
            ..Loads::default()
        },
        ripple_m,
        ..SimulationDef::default().with_step(INSTANT_S)
    };
    let mut sim = Simulation::new(mesh.clone(), &positions, def)?;
    if matches!(act, Act::Hold) {
        sim.hold([v(0)]).expect("a vertex");
    }
    assert_eq!(sim.cloth().positions(), points, "before the first step");
    sim.advance(INSTANT_S, 1).expect("a step");
    Ok(sim.cloth().positions().to_vec())
}

fn offsets(mesh: &Mesh, points: &[Point], ripple_m: Option<f64>) -> Vec<Vector> {
    let after = after_an_instant(mesh, points, Act::Wind, ripple_m).expect("a cloth");
    after.iter().zip(points).map(|(x, at)| x - at).collect()
}

fn largest(offsets: &[Vector]) -> f64 {
    offsets
        .iter()
        .map(|offset| offset.norm())
        .fold(0.0, f64::max)
}

#[test]
fn a_flat_cloth_begins_a_millionth_of_its_size_off_its_plane() {
    for (size_m, ripple_m, amplitude_m) in [
        (1.0, None, 1e-6),
        (40.0, None, 4e-5),
        (0.5, Some(0.01), 0.01),
        (1.0, Some(0.0), 0.0),
    ] {
        let (mesh, positions) = square(12);
        let points: Vec<Point> = positions.as_slice().iter().map(|at| at * size_m).collect();
        let offsets = offsets(&mesh, &points, ripple_m);
        let largest_m = largest(&offsets);
        let is_so = 0.5 * amplitude_m <= largest_m && largest_m <= amplitude_m;
        assert!(is_so, "{largest_m} m for {amplitude_m} m");
        assert!(offsets.iter().all(|offset| offset.xy().norm() < 1e-18));
        // Neither the sheet nor either half of it is moved as a whole.
        let (mut sums, mut sizes) = ([0.0; 2], 0.0);
        for (offset, at) in offsets.iter().zip(&points) {
            sums[usize::from(at.x > 0.5 * size_m)] += offset.z;
            sizes += offset.z.abs();
        }
        assert!(sums.iter().all(|sum| sum.abs() <= 0.5 * sizes), "{sums:?}");
    }
}

/// A finer mesh has the same ripple where it has the same vertices, and so has one that is numbered otherwise.
#[test]
fn a_ripple_depends_on_the_place_alone() {
    let (coarse, at_coarse) = square(8);
    let (fine, at_fine) = square(24);
    let of_fine = offsets(&fine, at_fine.as_slice(), None);
    let of_coarse = offsets(&coarse, at_coarse.as_slice(), None);
    for (number, offset) in of_coarse.iter().enumerate() {
        let (i, j) = (number % 9, number / 9);
        assert!((offset - of_fine[75 * j + 3 * i]).norm() < 1e-18);
    }
    let mut random = Random(7);
    let mut order: Vec<usize> = (0..coarse.vertex_count()).collect();
    random.shuffle(&mut order);
    let mut faces: Vec<[u32; 3]> = coarse.indices().as_chunks().0.to_vec();
    faces.reverse();
    // The sheet is seen from behind as well.
    let faces: Vec<[u32; 3]> = faces
        .iter()
        .map(|[a, b, c]| [*b, *a, *c].map(|corner| order[corner as usize] as u32))
        .collect();
    let mesh = Mesh::build(coarse.vertex_count(), &faces).expect("a sheet");
    let mut points = at_coarse.as_slice().to_vec();
    for (number, at) in at_coarse.as_slice().iter().enumerate() {
        points[order[number]] = *at;
    }
    let renumbered = offsets(&mesh, &points, None);
    for (number, offset) in of_coarse.iter().enumerate() {
        assert!((offset - renumbered[order[number]]).norm() < 1e-18);
    }
}

/// No turn or reflection of a square maps its ripple to itself or to its opposite.
#[test]
fn a_ripple_has_no_symmetry() {
    let (mesh, positions) = square(16);
    let offsets = offsets(&mesh, positions.as_slice(), None);
    let at = |i: usize, j: usize| offsets[17 * j + i].z;
    // Whether both directions change places, and which of them is reversed.
    let maps = (1..8).map(|bits| [1, 2, 4].map(|bit| bits & bit > 0));
    let whole: f64 = offsets.iter().map(|offset| offset.norm_squared()).sum();
    for [swap, reverse_i, reverse_j] in maps {
        let places = || (0..17).flat_map(|j| (0..17).map(move |i| (i, j)));
        let common = places().map(|(i, j)| {
            let (k, l) = if swap { (j, i) } else { (i, j) };
            let [k, l] =
                [(k, reverse_i), (l, reverse_j)].map(|(k, back)| if back { 16 - k } else { k });
            at(i, j) * at(k, l)
        });
        let common: f64 = common.sum();
        let share = common / whole;
        assert!(
            share.abs() < 0.8,
            "{share} with {swap}, {reverse_i}, {reverse_j}"
        );
    }
}

#[test]
fn a_sheet_is_flat_in_whatever_plane_it_lies() {
    let (mesh, positions) = square(10);
    for (roll, pitch, yaw) in [
        (0.3, 1.1, -0.4),
        (std::f64::consts::FRAC_PI_2, 0.0, 0.0),
        (0.0, 1.57, 2.0),
    ] {
        let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let motion = Isometry3::from_parts(Translation3::new(3.0, -2.0, 0.5), turn);
        let points: Vec<Point> = positions.as_slice().iter().map(|at| motion * at).collect();
        let offsets = offsets(&mesh, &points, None);
        let normal = turn * Vector::z();
        let largest_m = largest(&offsets);
        assert!((5e-7..=1.5e-6).contains(&largest_m), "{largest_m} m");
        for offset in &offsets {
            let aside = offset - normal * normal.dot(offset);
            assert!(aside.norm() < 1e-14, "{aside}");
        }
    }
}

#[test]
fn a_sheet_that_is_not_flat_keeps_its_shape() {
    let (mesh, positions) = square(6);
    for (bump_m, is_flat) in [(1e-8, false), (1e-6, false), (1e-10, true), (0.0, true)] {
        let mut points = positions.as_slice().to_vec();
        points[24].z += bump_m;
        let largest_m = largest(&offsets(&mesh, &points, None));
        assert_eq!(largest_m > 0.0, is_flat, "{bump_m} m");
    }
    // One that is folded in its plane is flat.
    let fold = |at: &Point| Point::new(at.x.min(1.0 - at.x), at.y, 0.0);
    let folded: Vec<Point> = positions.as_slice().iter().map(fold).collect();
    let positions = Positions::new(folded).expect("usable places");
    assert!(largest(&offsets(&mesh, positions.as_slice(), None)) > 0.0);
}

/// Two sheets in one file, each in a plane of its own; and one that is bent beside one that is flat.
#[test]
fn each_sheet_has_a_plane_of_its_own() {
    let (one, places) = square(6);
    let count = one.vertex_count() as u32;
    let mut faces: Vec<[u32; 3]> = one.indices().as_chunks().0.to_vec();
    faces.extend(
        faces
            .clone()
            .iter()
            .map(|face| face.map(|corner| corner + count)),
    );
    let mesh = Mesh::build(2 * count as usize, &faces).expect("two sheets");
    let upright = |at: &Point| Point::new(5.0, at.x, at.y);
    let bent = |at: &Point| Point::new(at.x, at.y, 3.0 + at.x * at.y);
    let with = |second: &dyn Fn(&Point) -> Point| {
        let mut points = places.as_slice().to_vec();
        points.extend(places.as_slice().iter().map(second));
        let both = offsets(&mesh, &points, None);
        let (first, second) = both.split_at(count as usize);
        [first.to_vec(), second.to_vec()]
    };
    let [first, second] = with(&upright);
    assert!(first.iter().all(|offset| offset.xy().norm() < 1e-18));
    assert!(second.iter().all(|offset| offset.yz().norm() < 1e-18));
    assert!(largest(&first) > 5e-7 && largest(&second) > 5e-7);
    let [first, second] = with(&bent);
    assert!(largest(&first) > 5e-7 && largest(&second) == 0.0);
}

/// A flat sheet in free fall keeps strain 0 exactly, until a hand takes it. Where it is held it stays.
#[test]
fn a_ripple_waits_for_something_that_acts() {
    let (mesh, positions) = square(8);
    let after = after_an_instant(&mesh, positions.as_slice(), Act::Nothing, None);
    assert_eq!(after.expect("a cloth"), positions.as_slice());
    let held = after_an_instant(&mesh, positions.as_slice(), Act::Hold, None);
    let held = held.expect("a cloth");
    assert_eq!(held[0], positions.as_slice()[0]);
    assert!(held[1..].iter().filter(|at| at.z != 0.0).count() > 70);

    let def = SimulationDef::default().with_unstable(Unstable::Refuse);
    let mut sim = Simulation::new(mesh, &positions, def).expect("a cloth");
    sim.advance(0.1, u64::MAX).expect("steps");
    assert!(sim.cloth().positions().iter().all(|at| at.z == 0.0));
    assert_eq!(sim.ripple_m(), 0.0);
    sim.grab(v(40), 0.0).expect("a hand");
    assert_eq!(sim.ripple_m(), 0.0);
    sim.advance(2.0 * sim.step_s(), 2).expect("steps");
    assert_eq!(sim.ripple_m(), 1e-6);
    assert!(sim.cloth().positions().iter().any(|at| at.z != 0.0));
}

#[test]
fn a_wind_that_has_not_begun_makes_no_ripple() {
    let (mesh, positions) = square(8);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let wind = Wind {
        velocity_m_per_s: Vector::new(0.0, 0.0, 1.0),
        coefficient: 1.0,
    };
    let scene = Scene {
        wind: Some(SwayingWind {
            from_s: 0.05,
            ..SwayingWind::steady(wind)
        }),
        colliders: Vec::new(),
        ..Scene::fall(Axis::Y)
    };
    let mut run = Run::new(mesh, &positions, scene, &frame).expect("a scene");
    while run.elapsed_s() < 0.06 {
        run.step().expect("a step");
        // The step that has just been taken began a step earlier.
        let has_begun = run.elapsed_s() - 0.5 * run.step_s() > 0.05;
        assert_eq!(run.ripple_m() > 0.0, has_begun, "{} s", run.elapsed_s());
    }
}

/// What is cut before the first step is cut as it was given, and its vertices have the ripple of their places.
#[test]
fn cuts_before_the_first_step_are_in_the_plane() {
    let (mesh, positions) = square(7);
    let whole = offsets(&mesh, positions.as_slice(), None);
    let wind = Wind {
        velocity_m_per_s: Vector::zeros(),
        coefficient: 1.0,
    };
    let loads = Loads {
        wind: Some(wind),
        ..Loads::default()
    };
    let def = SimulationDef::default().with_loads(loads);
    let mut sim = Simulation::new(mesh, &positions, def.with_step(INSTANT_S)).expect("a cloth");
    let [a, b] = [crate::parts::ray(0.31, -1.0), crate::parts::ray(0.31, 2.0)];
    let scissor = tearmesh::Scissor::new(a, b).expect("a plane");
    sim.cut(&scissor).expect("a cut");
    let before = sim.cloth().positions().to_vec();
    assert!(before.iter().all(|at| at.z == 0.0));
    sim.advance(INSTANT_S, 1).expect("a step");
    let after = sim.cloth().positions();
    for (number, offset) in whole.iter().enumerate() {
        assert!((after[number] - before[number] - offset).norm() < 1e-18);
    }
    let added = &after[whole.len()..];
    assert!(added.len() > 14, "{} vertices", added.len());
    assert!(added.iter().filter(|at| at.z != 0.0).count() > 14);
    assert!(added.iter().all(|at| at.z.abs() < 1e-6));
}

#[test]
fn a_ripple_that_cannot_be_is_refused() {
    let (mesh, positions) = square(2);
    for given in [-1e-9, f64::NAN, f64::INFINITY, 1e300] {
        let made = after_an_instant(&mesh, positions.as_slice(), Act::Wind, Some(given));
        match made {
            Err(SimulationError::Ripple(refused)) => {
                assert_eq!(refused.to_bits(), given.to_bits());
            }
            other => panic!("{given}: {other:?}"),
        }
    }
}

/// The energy of the ripple was there at the beginning: nothing made it.
#[test]
fn a_ripple_is_no_work_of_the_method() {
    let (mesh, positions) = square(8);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let flat: Vec<Point> = positions
        .as_slice()
        .iter()
        .map(|at| Point::new(at.x, 0.0, at.y))
        .collect();
    let flat = Positions::new(flat).expect("usable places");
    let scene = Scene {
        step_s: Some(1e-5),
        duration_s: 1e-4,
        ripple_m: Some(0.02),
        ..Scene::hang(&frame)
    };
    let frame = Frame::new(&mesh, flat.as_slice(), Axis::Y);
    let mut run = Run::new(mesh, &flat, scene, &frame).expect("a scene");
    assert_eq!(run.energy_balance().began_j, 0.0);
    while !run.is_over() {
        run.step().expect("a step");
    }
    let balance = run.energy_balance();
    assert!(balance.began_j > 1e-4, "{} J", balance.began_j);
    let made_j = balance.made_j();
    assert!(made_j.abs() < 1e-3 * balance.began_j, "{made_j} J");
}

/// The scene at its first tear: the force in newtons, and the largest distance from the plane in metres.
fn torn(scene: &Scene, cells: u32, ripple_m: Option<f64>) -> (f64, f64) {
    let scene = |_: &Frame| Scene {
        ripple_m,
        ..scene.clone()
    };
    let mut run = staged(cells, scene);
    let mut log = TearLog::new(&run);
    while !run.is_over() && log.events().is_empty() {
        let step = run.step().expect("a step");
        log.note(&run, &step);
    }
    let depths = run.cloth().positions().iter().map(|at| at.z.abs());
    (
        log.first_force_n().expect("a tear"),
        depths.fold(0.0, f64::max),
    )
}

/// The amplitude does not matter, and without any the sheet is 5 to 20 % too strong.
#[test]
fn what_is_flat_tears_as_what_is_nearly_so() {
    let (mesh, positions) = square(24);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    for method in [
        Method::Verlet,
        Method::Implicit(implicit::Settings::default()),
    ] {
        let scene = Scene {
            solver: method,
            ..Scene::rip(&frame)
        };
        let (flat_n, flat_m) = torn(&scene, 24, Some(0.0));
        assert_eq!(flat_m, 0.0);
        let (given_n, given_m) = torn(&scene, 24, None);
        assert!(given_m > 0.01, "{given_m} m");
        let excess = flat_n / given_n - 1.0;
        assert!((0.05..0.25).contains(&excess), "{excess}");
        for ripple_m in [1e-7, 1e-5, 1e-4] {
            let (force_n, _) = torn(&scene, 24, Some(ripple_m));
            let apart = (force_n / given_n - 1.0).abs();
            assert!(apart < 0.03, "{force_n} N for {given_n} N");
        }
    }
}

//! What is stored, put in and lost, method by method, against answers on paper.

use tearmesh::{Point, Vector};
use tearmesh_cloth::implicit;
use tearmesh_cloth::scene::Scene;
use tearmesh_cloth::{Balance, Loads, Path, Pbd, Provot, Solver, System, Verlet, Xpbd};

use crate::parts::implicit_to;
use crate::parts::scenes::{play, staged};

/// Methods whose springs have the stiffness that they were given, and PBD, whose have not.
fn methods() -> [(&'static str, Box<dyn Solver>); 6] {
    let by = |method| implicit_to(method, 1e-6);
    [
        ("verlet", Box::new(Verlet::new())),
        ("provot", Box::new(Provot::unlimited())),
        ("xpbd", Box::new(Xpbd::new(1, 1))),
        (
            "backward Euler",
            Box::new(by(implicit::Method::BackwardEuler)),
        ),
        ("bdf2", Box::new(by(implicit::Method::Bdf2))),
        ("pbd", Box::new(Pbd::default())),
    ]
}

/// Links of 100 N/m and a metre in a row, a kilogram at each joint; held at one end, and led away
/// by `by_m` metres at the other within `within_s` seconds.
fn drawn(links: usize, by_m: f64, within_s: f64) -> System {
    let points = (0..=links).map(|i| Point::new(i as f64, 0.0, 0.0));
    let mut chain = System::new(points, vec![1.0; links + 1]).expect("a chain");
    for i in 0..links {
        chain.stretch([i, i + 1], 1.0, 100.0).expect("a link");
    }
    chain.hold(0);
    let end = links as f64;
    let way = [
        (0.0, Point::new(end, 0.0, 0.0)),
        (within_s, Point::new(end + by_m, 0.0, 0.0)),
    ];
    chain.grab(links, Path::new(way).expect("a path"));
    chain
}

/// N springs in a row are one of k/N.
#[test]
fn a_chain_drawn_slowly_stores_half_k_x_squared_over_n() {
    for (name, mut solver) in methods() {
        if name == "pbd" {
            continue; // Its springs have no stiffness of their own.
        }
        let (links, by_m, dt_s) = (10, 1.5, 0.01);
        let mut chain = drawn(links, by_m, 60.0);
        let drag_per_s = Some(0.5);
        let loads = Loads {
            drag_per_s,
            ..Loads::default()
        };
        chain.set_loads(loads).expect("drag");
        let mut kept = Balance::new(&mut chain);
        for _ in 0..9000 {
            chain
                .step_observed(&mut *solver, dt_s, &mut kept)
                .expect("a step");
        }
        let balance = kept.now(&chain);
        let stored_j = 0.5 * 100.0 * by_m * by_m / links as f64;
        println!("{name}: {stored_j} J, {balance:?}");
        // One sweep of XPBD pulls less than the springs are long.
        let margin = if name == "xpbd" { 0.02 } else { 0.005 };
        let part = balance.elastic_j / stored_j;
        assert!((part - 1.0).abs() < margin, "{name}: {part} is stored");
        // The hand gave that, and what drag took.
        let given = (balance.held_j + balance.drag_j) / stored_j;
        assert!((given - 1.0).abs() < margin, "{name}: {given} was given");
    }
}

/// What nobody but hands moves costs them what it stores, by every method; PBD says nothing of what it stores.
#[test]
fn an_edge_between_two_who_are_held_takes_from_the_hand_what_it_stores() {
    for (name, mut solver) in methods() {
        let mut pair = drawn(1, 1.2, 0.5);
        let mut kept = Balance::new(&mut pair);
        for _ in 0..1000 {
            pair.step_observed(&mut *solver, 0.001, &mut kept)
                .expect("a step");
        }
        let balance = kept.now(&pair);
        // Those who move by the force at the end take a step's share more.
        let given = balance.held_j / 72.0;
        assert!((given - 1.0).abs() < 0.005, "{name}: {given} was given");
        if name == "pbd" {
            assert_eq!(balance.elastic_j, 0.0);
            continue;
        }
        assert!(
            (balance.elastic_j - 72.0).abs() < 1e-9,
            "{name}: {balance:?}"
        );
        // And that share is what the method took.
        let made = balance.made_j() / 72.0;
        assert!((-0.005..1e-3).contains(&made), "{name}: {balance:?}");
    }
}

/// What is crushed to half is damped by as much as it had, at the most.
#[test]
fn damping_takes_from_a_crushed_sheet_no_more_than_there_was() {
    for cells in [4, 10] {
        let mut crushed = staged(cells, |frame| Scene {
            gravity_m_per_s2: Vector::zeros(),
            drag_per_s: 0.0,
            duration_s: 0.3,
            tearing: None,
            ..Scene::fall(frame.up)
        });
        let points = crushed.cloth().positions().to_vec();
        crushed = crushed
            .displaced(|v| points[v.index()].coords * -0.5)
            .expect("places that can be used");
        let balance = play(crushed).energy_balance();
        let part = -balance.made_j() / balance.began_j;
        println!("{cells}: {part} of {} J", balance.began_j);
        assert!((0.1..1.0).contains(&part), "{part}: {balance:?}");
    }
}

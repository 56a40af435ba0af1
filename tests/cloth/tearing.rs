//! The loop above the tearing rule: what a threshold means, what goes first, and what holds.

use std::collections::BTreeSet;

use tearmesh::{Point, Vector, VertexId, shapes};
use tearmesh_cloth::{Fabric, Tear, Tearing, Threshold};

use crate::parts::cloths::{Torn, cloth, deform, sheet};
use crate::parts::nets::chain;
use crate::parts::{method, near, v};

fn stretched(ratio: f64) -> impl FnMut(Point) -> Point {
    move |p| Point::new(p.x, p.y * ratio, p.z)
}

#[test]
fn the_worst_goes_first_and_a_cap_takes_the_rest() {
    let tearing = Tearing::new(Threshold::Stretch(1.3));
    let with_cap = |cap: Option<usize>| {
        let tearing = Tearing {
            splits_per_step_max: cap,
            ..tearing
        };
        let mut torn = Torn::new(sheet(8, 8, 3), Fabric::new(50.0), tearing);
        deform(&mut torn.cloth, |p| {
            Point::new(p.x, p.y + 1.2 * p.y * p.y, 0.1 * p.x * p.x)
        });
        let worst = torn.mesh.edges().map(|h| {
            let ratio = torn.cloth.system().stretch_ratio(torn.cloth.stretch(h));
            ((ratio - 1.0) / 0.3, h)
        });
        let worst = worst.max_by(|a, b| a.0.total_cmp(&b.0)).expect("an edge");
        let ends = [torn.mesh.origin(worst.1), torn.mesh.target(worst.1)];
        let report = torn.apply();
        let (edge, load) = report.worst.expect("a stretched edge");
        assert_eq!(edge, worst.1);
        near(load, worst.0, 1e-12);
        (report, torn.split(), ends)
    };
    let (all, order, worst) = with_cap(None);
    assert!(all.splits > 8 && !all.cap_hit, "{all:?}");
    assert!(worst.contains(&order[0]));
    // No vertex is split twice, nor an end of an edge that was relieved.
    let once: BTreeSet<_> = order.iter().collect();
    assert_eq!(once.len(), order.len());
    for cap in 0..=order.len() + 1 {
        let (report, first, _) = with_cap(Some(cap));
        assert_eq!(first, order[..cap.min(order.len())], "cap {cap}");
        assert_eq!(report.cap_hit, cap < order.len(), "cap {cap}");
        assert_eq!(report.overstretched, all.overstretched);
    }
}

#[test]
fn held_vertices_do_not_tear() {
    // With all held there is nothing to split.
    for every in [2, 1] {
        let tearing = Tearing::new(Threshold::Stretch(1.3));
        let mut torn = Torn::new(sheet(5, 5, 1), Fabric::new(50.0), tearing);
        (0..36)
            .step_by(every)
            .for_each(|v| torn.cloth.system_mut().hold(v));
        deform(&mut torn.cloth, stretched(1.4));
        let report = torn.apply();
        assert!(report.overstretched > 0 && (report.splits > 3) == (every > 1));
        let is_held = |v: &VertexId| torn.cloth.system().is_held(v.index());
        assert!(!torn.split().iter().any(is_held));
    }
}

#[test]
fn warp_and_weft_have_thresholds_and_diagonals_none() {
    // The largest loads of edges along x, along y, and of diagonals.
    let loads = |threshold: Threshold, to: fn(Point) -> Point| {
        let (mesh, positions) = shapes::grid(6, 6);
        let mut cloth = cloth(&mesh, &positions, Fabric::new(50.0));
        deform(&mut cloth, to);
        let mut loads = [0.0_f64; 3];
        for h in mesh.edges() {
            let d = positions.at(mesh.target(h)) - positions.at(mesh.origin(h));
            let class = [d.y, d.x].iter().position(|off| off.abs() < 1e-9);
            let class = class.unwrap_or(2);
            let load = threshold.edge_load(&mesh, &cloth, h).unwrap_or(0.0);
            loads[class] = loads[class].max(load);
        }
        loads
    };
    let threads = |axis: Vector| Threshold::WarpWeft {
        warp: 1.2,
        weft: 1.5,
        axis,
    };
    let even = |p: Point| Point::from(p.coords * 1.3);
    // Lengthens one diagonal alone, and no thread.
    let shear = |p: Point| Point::new(p.x + 0.6 * p.y, 0.8 * p.y, 0.0);
    let up = |p: Point| Point::new(p.x, 1.3 * p.y, p.z);
    type Move = fn(Point) -> Point;
    let cases: [(Threshold, Move, [f64; 3]); 5] = [
        (threads(Vector::x() * 3.0), even, [1.5, 0.6, 0.0]),
        (threads(-Vector::y()), even, [0.6, 1.5, 0.0]),
        // Seen in the plane of the face.
        (threads(Vector::new(1.0, 0.1, 5.0)), even, [1.5, 0.6, 0.0]),
        (threads(Vector::x()), shear, [0.0; 3]),
        // Of a face only the most stretched edge tears, and at the stretch of the face.
        (Threshold::PrincipalStretch(1.2), up, [0.0, 1.5, 0.0]),
    ];
    for (threshold, to, expected) in cases {
        let found = loads(threshold, to);
        for (load, expected) in found.into_iter().zip(expected) {
            near(load, expected, 1e-9);
        }
    }
    let false_tear = loads(Threshold::Stretch(1.2), shear);
    assert!(false_tear[2] > 1.0, "{false_tear:?}");
}

#[test]
fn strength_says_where_it_tears_and_tips_are_weak() {
    // A seam of vertices that bear half as much: only they are split.
    let mut torn = Torn::new(sheet(8, 8, 6), Fabric::new(50.0), Tearing::default());
    let seam: Vec<usize> = (4 * 9..5 * 9).collect();
    let strengths = (0..81).map(|v| if seam.contains(&v) { 0.5 } else { 1.0 });
    torn.strengthen(strengths.collect());
    deform(&mut torn.cloth, stretched(1.3));
    let report = torn.apply();
    assert!(report.splits >= 3, "{report:?}");
    let split = torn.split();
    assert!(split.iter().all(|v| seam.contains(&v.index())), "{split:?}");
    for v in split {
        assert_eq!(torn.tear.strength(v), 0.5);
    }
    let news = torn.mesh.vertex_count() - 81;
    assert!((0..news).all(|i| torn.tear.strength(v(81 + i)) == 0.5));

    // One split of a whole vertex has two tips, one on each side, and they run from there.
    let tearing = Tearing {
        weakening: Some(0.5),
        ..Tearing::default()
    };
    let mut torn = Torn::new(sheet(9, 9, 7), Fabric::new(50.0), tearing);
    let mut strengths = vec![1.0; 100];
    strengths[44] = 0.6;
    torn.strengthen(strengths);
    deform(&mut torn.cloth, stretched(1.35));
    assert_eq!((torn.apply().splits, torn.split()[0].index()), (1, 44));
    let places = torn.cloth.positions().to_vec();
    let x = |v: VertexId| places[v.index()];
    let tips = torn.mesh.vertices().filter(|&v| torn.tear.is_tip(v));
    let ways: Vec<Vector> = tips.map(|v| x(v) - places[44]).collect();
    assert!(ways.len() == 2 && ways[0].dot(&ways[1]) < 0.0);
    let mut last = 1;
    while torn.apply().splits > 0 {
        let count = torn.split().len();
        assert!(count <= last + 2, "two tips make at most two splits a step");
        last = count;
    }
    // What a tear has gone through is a tip no more.
    assert!(torn.split().iter().all(|&v| !torn.tear.is_tip(v)));
    let rows: Vec<f64> = torn.split().iter().map(|&v| x(v).y / 1.35).collect();
    assert!(last >= 8, "it ran from side to side: {last}");
    assert!(rows.iter().all(|y| (y - 0.4).abs() < 0.16), "{rows:?}");
    // Without weakening nothing else was overstretched.
    let mut torn = Torn::new(sheet(9, 9, 7), Fabric::new(50.0), Tearing::default());
    deform(&mut torn.cloth, stretched(1.35));
    assert_eq!(torn.apply().overstretched, 0);
}

#[test]
fn provots_limiter_does_not_hide_a_yank() {
    // One row of vertices is thrown: in a step it gets far, and the limiter takes it back.
    let tear = |limited: bool| {
        let mut torn = Torn::new(sheet(4, 8, 8), Fabric::new(50.0), Tearing::default());
        let system = torn.cloth.system_mut();
        (0..20).for_each(|v| system.hold(v));
        (25..45).for_each(|v| system.state_mut().1[v].y = 40.0);
        let mut provot = method(if limited { "limited" } else { "Provot" }, 1);
        torn.cloth.step(&mut *provot, 0.002).expect("a step");
        let system = torn.cloth.system();
        let long = |id: &_| system.stretch_ratio(*id) > 1.5;
        (system.stretches().iter().filter(long).count(), torn.apply())
    };
    let (seen, free) = tear(false);
    let (hidden, limited) = tear(true);
    assert!(seen > 3 && hidden < seen, "{seen} {hidden}");
    assert_eq!(limited.overstretched, free.overstretched);
    assert!(limited.splits > 0);
    assert_eq!(limited.worst, free.worst);
}

#[test]
fn what_cannot_be_is_refused_with_what_was_given() {
    let (mesh, positions) = shapes::grid(2, 2);
    let cloth = cloth(&mesh, &positions, Fabric::new(1.0));
    // Others are in `refused.rs`.
    for (threshold, given, least) in [
        (Threshold::Stretch(f64::NAN), "NaN", 1),
        (Threshold::Toughness(f64::INFINITY), "inf", 0),
    ] {
        let tearing = Tearing::new(threshold);
        let text = format!("threshold is {given}, and has to be finite and above {least}");
        let error = Tear::new(&cloth, tearing).expect_err(given);
        assert_eq!(error.to_string(), text);
        assert_eq!(tearing.check().expect_err(given).to_string(), text);
    }
    let tear = Tear::new(&cloth, Tearing::default()).expect("a tear");
    let mut strengths = vec![1.0; 9];
    strengths[4] = 0.0;
    for (strengths, text) in [
        (vec![1.0; 3], "there are 3 strengths for 9 vertices"),
        (strengths, "the strength 0 of v4 is not positive and finite"),
    ] {
        let error = tear.clone().with_strengths(strengths).expect_err(text);
        assert_eq!(error.to_string(), text);
    }
    // A chain has no faces, so some thresholds mean nothing to it.
    let (threshold, chain) = (Threshold::PrincipalStretch(1.1), chain(0.0));
    let link = chain.stretches().iter().next().expect("a link");
    assert_eq!(threshold.load(&chain, link), None);
}

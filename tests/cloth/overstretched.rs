//! The pass that finds overstretched edges, against the load of every edge, and its cost.

use tearmesh::{Point, Vector, VertexId, mend};
use tearmesh_cloth::{
    Collider, Fabric, System, Tear, Tearing, Threshold, Unstable, Xpbd, recommended_step_s,
};

use crate::parts::cloths::{Torn, sheet};
use crate::parts::{G, METHODS, ORDERS, gravity, method, near, plane, pulled, run, tension_n};
use crate::random::Random;

/// A sheet that hangs by its top and is pulled about, what tears it, and how long a step is.
fn pulled_about(seed: u64) -> (Torn, f64) {
    let mut random = Random(seed);
    let cells = 3 + random.below(6) as u32;
    let shape = sheet(cells, cells, seed);
    let fabric = Fabric::new(20.0 + 200.0 * random.next());
    let mut loads = pulled(Vector::y() * (-150.0 * random.next()), 1.0);
    if seed.is_multiple_of(3) {
        let floor = plane([0.0, -0.02, 0.0], Vector::y());
        loads.colliders.push(Collider::plane(floor));
    }
    let down = Vector::y() * (-2.0 * random.next());
    let row = cells as usize + 1;
    let speeds: Vec<Vector> = (0..row).map(|_| down * random.next()).collect();
    let threshold = match seed % 4 {
        0 => Threshold::Stretch(1.02 + 0.3 * random.next()),
        1 => Threshold::WarpWeft {
            warp: 1.02 + 0.3 * random.next(),
            weft: 1.02 + 0.1 * random.next(),
            axis: Vector::y(),
        },
        2 => Threshold::Toughness(0.002 + 0.1 * random.next()),
        _ => Threshold::Force(0.05 + random.next()),
    };
    let mut torn = Torn::new(shape, fabric, Tearing::new(threshold));
    let strengths = torn.mesh.vertices().map(|_| 0.5 + random.next());
    let strengths = strengths.collect();
    torn.strengthen(strengths);
    let system = torn.cloth.system_mut();
    system.set_loads(loads).expect("loads");
    system.when_unstable(Unstable::Substep);
    (row * (row - 1)..row * row).for_each(|top| system.hold(top));
    system.state_mut().1[..row].copy_from_slice(&speeds);
    let step_s = recommended_step_s(system);
    (torn, step_s)
}

/// How many edges have a load beyond the strength of their weaker end: the definition.
fn overstretched(torn: &Torn) -> usize {
    let over = |&h: &_| {
        let threshold = torn.tear.tearing().threshold;
        let load = threshold.edge_load(&torn.mesh, &torn.cloth, h);
        let [a, b] = [torn.mesh.origin(h), torn.mesh.target(h)].map(|v| torn.tear.strength(v));
        load.is_some_and(|load| load / a.min(b) >= 1.0)
    };
    torn.mesh.edges().filter(over).count()
}

#[test]
fn a_pass_without_a_root_finds_every_overstretched_edge() {
    for name in METHODS {
        let (mut over, mut splits) = (0, 0);
        for seed in 0..48 {
            let ((mut torn, step_s), mut solver) = (pulled_about(seed), method(name, 10));
            for _ in 0..40 {
                let stepped = torn.cloth.step(&mut *solver, step_s);
                stepped.unwrap_or_else(|error| panic!("{name}, sheet {seed}: {error}"));
                let expected = overstretched(&torn);
                let report = torn.apply();
                assert_eq!(report.overstretched, expected, "{name}, sheet {seed}");
                over += expected;
                splits += report.splits;
            }
        }
        assert!(over > 100 && splits > 50, "{name}: {over} {splits}");
    }
}

/// Sews a vertex to one that came of the same, wherever both are now, if any are left that share a torn link.
fn sew(torn: &mut Torn, random: &mut Random) {
    let root = |v| torn.mesh.root(v);
    let vertices: Vec<VertexId> = torn.mesh.vertices().collect();
    let siblings = vertices.iter().flat_map(|&a| {
        let others = vertices
            .iter()
            .filter(move |&&b| a < b && root(a) == root(b));
        others.map(move |&b| [a, b])
    });
    let mut pairs: Vec<_> = siblings.collect();
    random.shuffle(&mut pairs);
    for ends in pairs {
        let weights = ends.map(|v| torn.cloth.masses().at(v));
        let [one, other] = ends;
        if mend::merge(&mut torn.mesh, one, other, weights, &mut torn.edits).is_ok() {
            break;
        }
    }
}

/// Whatever a hand or an edit did since the step, whichever method took it, and whatever the look before was for.
#[test]
fn a_look_finds_what_was_moved_or_sewn_since_the_step() {
    let mut over = 0;
    for seed in 0..150 {
        let mut random = Random(seed);
        let (mut torn, step_s) = pulled_about(seed);
        for _ in 0..20 {
            let name = METHODS[random.below(METHODS.len())];
            let taken = torn.cloth.step(&mut *method(name, 10), step_s);
            if taken.is_err() {
                break;
            }
            match random.below(5) {
                0 => {
                    let (x, _) = torn.cloth.system_mut().state_mut();
                    let moved = random.below(x.len());
                    x[moved] += Vector::new(0.0, 0.04 * random.next(), 0.04 * random.next());
                }
                1 => sew(&mut torn, &mut random),
                2 => {
                    let ratio = Threshold::Stretch(1.02 + 0.3 * random.next());
                    torn.tear = Tear::new(&torn.cloth, Tearing::new(ratio)).expect("a ratio");
                }
                _ => {}
            }
            torn.edits.replay(&mut (&mut torn.cloth, &mut torn.tear));
            let expected = overstretched(&torn);
            let report = torn.apply();
            assert_eq!(report.overstretched, expected, "{name}, sheet {seed}");
            over += expected;
        }
    }
    assert!(over > 100, "{over}");
}

/// At rest the force in each link of a chain is the weight below it, in whatever order links are
/// swept: so is what XPBD holds against a threshold, whose lengths are off.
#[test]
fn xpbd_tears_a_chain_by_the_weight_that_hangs_from_it() {
    let (links, mass, stiffness, rest) = (30, 0.01, 40.0, 0.1);
    for order in ORDERS {
        let points = (0..=links).map(|i| Point::new(0.0, 0.0, -rest * i as f64));
        let mut chain = System::new(points, vec![mass; links + 1]).expect("a chain");
        let mut numbers: Vec<usize> = (0..links).collect();
        order.apply(&mut numbers);
        let ids = numbers.iter().map(|&i| {
            let link = chain.stretch([i, i + 1], rest, stiffness);
            (i, link.expect("a link"))
        });
        let ids: Vec<_> = ids.collect();
        chain.hold(0);
        chain.set_loads(gravity(20.0)).expect("loads");
        run(&mut chain, Xpbd::new(1, 1), 0.01, 4000);
        let mut off: f64 = 0.0;
        for (i, id) in ids {
            let below = (links - i) as f64;
            let strain = below * mass * 9.81 / (stiffness * rest);
            let load = Threshold::Stretch(1.5).load(&chain, id).expect("a load");
            near(load / (strain / 0.5), 1.0, 1e-6);
            off = off.max(((chain.stretch_ratio(id) - 1.0) / strain - 1.0).abs());
        }
        assert!(off > 0.2, "{off}");
    }
}

/// R2's chain at rest under its weight and this force at its end, with these stiffnesses, and the loads of its links
/// from the top.
fn loads(threshold: Threshold, force_n: f64, stiffness: impl Fn(usize) -> f64) -> [f64; 10] {
    let pull_n = |i: usize| force_n + (10 - i) as f64 * 0.01 * G;
    let mut points = vec![Point::origin()];
    for i in 0..10 {
        points.push(points[i] - Vector::z() * (0.1 + pull_n(i) / stiffness(i)));
    }
    let mut chain = System::new(points, vec![0.01; 11]).expect("particles");
    std::array::from_fn(|i| {
        let link = chain.stretch([i, i + 1], 0.1, stiffness(i));
        let link = link.expect("a spring");
        near(tension_n(&chain, link), pull_n(i), 1e-12);
        threshold.load(&chain, link).expect("a load")
    })
}

#[test]
fn r7_a_chain_tears_at_the_load_and_order_of_statics() {
    let strain = Threshold::Stretch(1.5);
    let onset = 50.0 * 0.1 * 0.5 - 10.0 * 0.01 * G;
    near(onset, 1.519, 1e-12);
    // The same strain as an energy per length and as a force.
    let toughness = Threshold::Toughness(0.5 * 50.0 * 0.05 * 0.05 / 0.1);
    let force = Threshold::Force(50.0 * 0.05);
    for threshold in [strain, toughness, force] {
        near(loads(threshold, onset, |_| 50.0)[0], 1.0, 1e-12);
    }
    // Links that are stiffer the lower they are tear one after the other from the top.
    let stiffer = |i: usize| 50.0 * (1.0 + 0.1 * i as f64);
    for (stiffness, torn, onset) in [
        (&(|_| 50.0) as &dyn Fn(usize) -> f64, 1, onset),
        (&stiffer, 1, 1.519),
        (&stiffer, 2, 1.8671),
        (&stiffer, 3, 2.2152),
    ] {
        for (force_n, torn) in [(onset - 1e-9, torn - 1), (onset + 1e-9, torn)] {
            let loads = loads(strain, force_n, stiffness);
            assert!(loads.is_sorted_by(|one, next| one > next), "{loads:?}");
            assert_eq!(loads.iter().filter(|load| **load >= 1.0).count(), torn);
        }
    }
}

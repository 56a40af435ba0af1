//! The pass that finds overstretched edges, against the load of every edge, and its cost.

use tearmesh::{Edits, Mesh, Plane, Point, Vector, VertexId};
use tearmesh_cloth::{
    Cloth, Collider, Fabric, Loads, System, Tear, Tearing, Threshold, Unstable, Xpbd,
    recommended_step_s,
};

use crate::parts::METHODS;
use crate::parts::cloths::{cloth, sheet};
use crate::random::Random;

/// A sheet that hangs by its top and is pulled about; what may tear it, and how it is stepped.
struct Pulled {
    mesh: Mesh,
    cloth: Cloth,
    strengths: Vec<f64>,
    threshold: Threshold,
    step_s: f64,
}

impl Pulled {
    fn new(seed: u64) -> Pulled {
        let mut random = Random(seed);
        let cells = 3 + random.below(6) as u32;
        let (mesh, positions) = sheet(cells, cells, seed);
        let fabric = Fabric::new(20.0 + 200.0 * random.next());
        let mut cloth = cloth(&mesh, &positions, fabric);
        let mut loads = Loads {
            gravity_m_per_s2: Some(Vector::new(0.0, -150.0 * random.next(), 0.0)),
            drag_per_s: Some(1.0),
            ..Loads::default()
        };
        if seed.is_multiple_of(3) {
            let floor = Plane::new(Point::new(0.0, -0.02, 0.0), Vector::y()).expect("a plane");
            loads.colliders.push(Collider::Plane(floor));
        }
        let system = cloth.system_mut();
        system.set_loads(loads).expect("loads");
        system.when_unstable(Unstable::Substep);
        let row = cells as usize + 1;
        (row * (row - 1)..row * row).for_each(|top| system.hold(top));
        let down = Vector::new(0.0, -2.0 * random.next(), 0.0);
        for v in &mut system.state_mut().1[..row] {
            *v = down * random.next();
        }
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
        let strengths = mesh.vertices().map(|_| 0.5 + random.next()).collect();
        let step_s = recommended_step_s(cloth.system_mut());
        Pulled {
            mesh,
            cloth,
            strengths,
            threshold,
            step_s,
        }
    }

    /// How many edges have a load beyond the strength of their weaker end: the definition.
    fn overstretched(&self, tear: &Tear) -> usize {
        let over = |h| {
            let load = self.threshold.edge_load(&self.mesh, &self.cloth, h);
            let ends = [self.mesh.origin(h), self.mesh.target(h)];
            let [a, b] = ends.map(|v: VertexId| tear.strength(v));
            load.is_some_and(|load| load / a.min(b) >= 1.0)
        };
        self.mesh.edges().filter(|&h| over(h)).count()
    }
}

#[test]
fn a_pass_without_a_root_finds_every_overstretched_edge() {
    for (name, method) in METHODS {
        let (mut over, mut steps, mut torn) = (0, 0, 0);
        for seed in 0..48 {
            let mut pulled = Pulled::new(seed);
            let mut solver = method();
            let tearing = Tearing::new(pulled.threshold);
            let tear = Tear::new(&pulled.cloth, tearing).expect("a tear");
            let strengths = pulled.strengths.clone();
            let mut tear = tear.with_strengths(strengths).expect("strengths");
            let mut edits = Edits::new();
            for _ in 0..40 {
                let stepped = pulled.cloth.step(&mut *solver, pulled.step_s);
                stepped.unwrap_or_else(|error| panic!("{name}, sheet {seed}: {error}"));
                let expected = pulled.overstretched(&tear);
                let Pulled { mesh, cloth, .. } = &mut pulled;
                let report = tear.apply(mesh, cloth, &mut edits);
                assert_eq!(report.overstretched, expected, "{name}, sheet {seed}");
                (over, steps) = (over + expected, steps + 1);
                torn += report.splits;
            }
        }
        assert!(over > 100 && torn > 50, "{name}");
    }
}

/// The length from which on an edge may tear follows from the stiffness of edges, and is found anew when that
/// changes.
#[test]
fn a_stiffer_edge_tears_at_a_smaller_strain() {
    let (mut mesh, positions) = sheet(4, 4, 1);
    let mut cloth = cloth(&mesh, &positions, Fabric::new(50.0));
    for x in cloth.system_mut().state_mut().0 {
        *x *= 1.2;
    }
    let longest = mesh.edges().map(|h| {
        let id = cloth.stretch(h);
        (cloth.system().stretches().get(id).rest_length_m, id)
    });
    let (longest_m, id) = longest.max_by(|a, b| a.0.total_cmp(&b.0)).expect("edges");
    let tearing = Tearing::new(Threshold::Force(4.0 * 50.0 * 0.2 * longest_m));
    let mut tear = Tear::new(&cloth, tearing).expect("a tear");
    let mut edits = Edits::new();
    let mut overstretched = |cloth: &mut Cloth| tear.apply(&mut mesh, cloth, &mut edits);
    assert_eq!(overstretched(&mut cloth).overstretched, 0);
    let stiffer = cloth.system_mut().set_stiffness(id, 4.01 * 50.0);
    stiffer.expect("a stiffness");
    assert_eq!(overstretched(&mut cloth).overstretched, 1);
}

/// At rest the force in each link of a chain is the weight below it, in whatever order links are
/// swept: so is what XPBD holds against a threshold, whose lengths are off.
#[test]
fn xpbd_tears_a_chain_by_the_weight_that_hangs_from_it() {
    let (links, mass, stiffness, rest) = (30, 0.01, 40.0, 0.1);
    for order in 0..3 {
        let points = (0..=links).map(|i| Point::new(0.0, 0.0, -rest * f64::from(i)));
        let mut chain = System::new(points, vec![mass; links as usize + 1]).expect("a chain");
        let mut numbers: Vec<usize> = (0..links as usize).collect();
        match order {
            0 => {}
            1 => numbers.reverse(),
            _ => numbers.rotate_left(11),
        }
        let ids = numbers.iter().map(|&i| {
            let link = chain.stretch([i, i + 1], rest, stiffness);
            (i, link.expect("a link"))
        });
        let ids: Vec<_> = ids.collect();
        chain.hold(0);
        let loads = Loads {
            gravity_m_per_s2: Some(Vector::new(0.0, 0.0, -9.81)),
            drag_per_s: Some(20.0),
            ..Loads::default()
        };
        chain.set_loads(loads).expect("loads");
        for _ in 0..4000 {
            chain.step(&mut Xpbd::new(1, 1), 0.01).expect("a step");
        }
        let mut off: f64 = 0.0;
        for (i, id) in ids {
            let below = f64::from(links) - i as f64;
            let strain = below * mass * 9.81 / (stiffness * rest);
            let load = Threshold::Stretch(1.5).load(&chain, id).expect("a load");
            assert!(
                (load / (strain / 0.5) - 1.0).abs() < 1e-6,
                "link {i}: {load}"
            );
            off = off.max(((chain.stretch_ratio(id) - 1.0) / strain - 1.0).abs());
        }
        assert!(off > 0.2, "{off}");
    }
}

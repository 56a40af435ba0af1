//! Links of chains that tear, against statics and dynamics that are known.

use tearmesh::Vector;
use tearmesh_cloth::{Constraint, Loads, Solver, System, Tearing, Threshold, Verlet, energy};

use crate::parts::nets::row;
use crate::parts::{G, near};
use crate::rk4::Rk4;

/// A link that was cut, and its load: at least 1.
#[derive(Debug, PartialEq)]
pub(crate) struct CutLink {
    constraint: Constraint,
    load: f64,
}

/// Cuts the links whose load has reached the threshold, the worst first, up to the cap.
pub(crate) fn cut_links(tearing: &Tearing, system: &mut System) -> Vec<CutLink> {
    let load = |id| Some((tearing.threshold.load(system, id)?, id));
    let loads = system.stretches().iter().filter_map(load);
    let mut torn: Vec<_> = loads.filter(|&(load, _)| load >= 1.0).collect();
    torn.sort_by(|(one, a), (other, b)| other.total_cmp(one).then(a.cmp(b)));
    torn.truncate(tearing.splits_per_step_max.unwrap_or(usize::MAX));
    let cut = |(load, id)| CutLink {
        constraint: system.cut(id),
        load,
    };
    torn.into_iter().map(cut).collect()
}

/// R2's chain at rest under its weight and this force at its end, with these stiffnesses.
fn loaded(force_n: f64, stiffness: impl Fn(usize) -> f64) -> System {
    let mut chain = row(10, 0.01, 50.0, 0.1, Vector::new(0.0, 0.0, -0.1));
    let mut z = 0.0;
    for i in 0..10 {
        let link = chain.stretches().between(i, i + 1).expect("a link");
        chain
            .set_stiffness(link, stiffness(i))
            .expect("a stiffness");
        let tension = force_n + (10 - i) as f64 * 0.01 * G;
        z -= 0.1 + tension / stiffness(i);
        chain.state_mut().0[i + 1].z = z;
    }
    chain
}

#[test]
fn r7_a_chain_tears_at_the_load_and_in_the_order_of_statics() {
    let strain = Tearing::new(Threshold::Stretch(1.5));
    let onset = 50.0 * 0.1 * 0.5 - 10.0 * 0.01 * G;
    near(onset, 1.519, 1e-12);
    // The same strain as an energy per length and as a force.
    let toughness = Tearing::new(Threshold::Toughness(0.5 * 50.0 * 0.05 * 0.05 / 0.1));
    let force = Tearing::new(Threshold::Force(50.0 * 0.05));
    for tearing in [strain, toughness, force] {
        let mut below = loaded(onset - 1e-9, |_| 50.0);
        assert_eq!(cut_links(&tearing, &mut below), []);
        let mut above = loaded(onset + 1e-9, |_| 50.0);
        let held_j = energy::elastic_j(&above);
        let cut = cut_links(&tearing, &mut above);
        assert_eq!(cut.len(), 1, "{tearing:?}");
        assert_eq!(cut[0].constraint.ends, [0, 1], "the top");
        near(held_j - energy::elastic_j(&above), 0.0625, 1e-9);
        near(cut[0].load, 1.0, 1e-8);
        assert_eq!(above.stretches().len(), 9);
        assert_eq!(above.stretches().between(0, 1), None);
    }
    // Links that are stiffer the lower they are tear one after the other from the top.
    let stiffer = |i: usize| 50.0 * (1.0 + 0.1 * i as f64);
    for (count, onset) in [(1, 1.519), (2, 1.8671), (3, 2.2152)] {
        let torn = |force_n: f64| {
            let cut = cut_links(&strain, &mut loaded(force_n, stiffer));
            cut.iter()
                .map(|cut| cut.constraint.ends[0])
                .collect::<Vec<_>>()
        };
        assert_eq!(torn(onset - 1e-9).len(), count - 1);
        assert_eq!(torn(onset + 1e-9), (0..count).collect::<Vec<_>>());
        let one = Tearing {
            splits_per_step_max: Some(1),
            ..strain
        };
        let cut = cut_links(&one, &mut loaded(onset + 1e-9, stiffer));
        assert_eq!(cut.len(), 1, "the cap");
        assert_eq!(cut[0].constraint.ends, [0, 1], "the worst first");
    }
}

/// Steps until a link tears: when, and which.
fn first_tear(
    mut system: System,
    solver: &mut dyn Solver,
    dt: f64,
    end: f64,
) -> Option<(f64, usize)> {
    let tearing = Tearing::new(Threshold::Stretch(1.5));
    while system.elapsed_s() < end {
        system.step(solver, dt).expect("a stable step");
        let cut = cut_links(&tearing, &mut system);
        if let Some(cut) = cut.first() {
            return Some((system.elapsed_s(), cut.constraint.ends[0]));
        }
    }
    None
}

fn pulled(mut system: System, acceleration: f64) -> System {
    let gravity_m_per_s2 = Some(Vector::new(0.0, 0.0, -acceleration));
    let loads = Loads {
        gravity_m_per_s2,
        ..Loads::default()
    };
    system.set_loads(loads).expect("loads");
    system
}

#[test]
fn a_sudden_load_tears_at_half_the_static_one() {
    let down = Vector::new(0.0, 0.0, -0.1);
    // At rest the link bears k L ε = 2.5 N; a sudden load overshoots twofold.
    for (part, tears) in [(0.499, false), (0.501, true)] {
        let link = pulled(row(1, 0.01, 50.0, 0.1, down), part * 2.5 / 0.01);
        let torn = first_tear(link, &mut Verlet::new(), 1e-5, 0.1);
        assert_eq!(torn.is_some(), tears, "{part} {torn:?}");
    }
    // Half a period after the start: π √(m/k).
    let link = pulled(row(1, 0.01, 50.0, 0.1, down), 0.5001 * 2.5 / 0.01);
    let (when, _) = first_tear(link, &mut Verlet::new(), 1e-5, 0.1).expect("a tear");
    near(when, std::f64::consts::PI * (0.01_f64 / 50.0).sqrt(), 1e-3);

    // A chain: which link, and when, against the reference method at a hundredth of the step.
    for load in [20.0, 25.0, 60.0] {
        let chain = || pulled(row(10, 0.01, 50.0, 0.1, down), load);
        let (when, link) = first_tear(chain(), &mut Rk4::new(), 1e-5, 1.0).expect("a tear");
        let (verlet, same) = first_tear(chain(), &mut Verlet::new(), 1e-3, 1.0).expect("a tear");
        assert_eq!(link, same);
        near(verlet, when, 2e-3);
    }
    // Below half the static load, 25 m/s², nothing tears, but for what a wave's front adds.
    let chain = pulled(row(10, 0.01, 50.0, 0.1, down), 11.0);
    assert_eq!(first_tear(chain, &mut Rk4::new(), 1e-4, 1.0), None);
}

//! Links of chains that tear, against statics that is known.

use tearmesh::Vector;
use tearmesh_cloth::{System, Tearing, Threshold, energy};

use crate::parts::nets::{link, row};
use crate::parts::{G, near};

/// Cuts the links whose load has reached the threshold, the worst first: their first ends and loads.
fn cut_links(tearing: &Tearing, system: &mut System) -> Vec<(usize, f64)> {
    let load = |id| Some((tearing.threshold.load(system, id)?, id));
    let loads = system.stretches().iter().filter_map(load);
    let mut torn: Vec<_> = loads.filter(|&(load, _)| load >= 1.0).collect();
    torn.sort_by(|(one, a), (other, b)| other.total_cmp(one).then(a.cmp(b)));
    let cut = |(load, id)| (system.cut(id).ends[0], load);
    torn.into_iter().map(cut).collect()
}

/// R2's chain at rest under its weight and this force at its end, with these stiffnesses.
fn loaded(force_n: f64, stiffness: impl Fn(usize) -> f64) -> System {
    let mut chain = row(10, 0.01, 50.0, 0.1, Vector::z() * -0.1);
    let mut z = 0.0;
    for i in 0..10 {
        let link = link(&chain, i, i + 1).expect("a link");
        let spring = chain.cut(link);
        let link = chain.stretch(spring.ends, spring.rest_length_m, stiffness(i));
        link.expect("a spring");
        let tension = force_n + (10 - i) as f64 * 0.01 * G;
        z -= 0.1 + tension / stiffness(i);
        chain.state_mut().0[i + 1].z = z;
    }
    chain
}

#[test]
fn r7_a_chain_tears_at_the_load_and_order_of_statics() {
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
        let [(0, load)] = cut[..] else {
            panic!("{tearing:?}: {cut:?} is not the top");
        };
        near(load, 1.0, 1e-8);
        near(held_j - energy::elastic_j(&above), 0.0625, 1e-9);
        assert_eq!(above.stretches().len(), 9);
        assert_eq!(link(&above, 0, 1), None);
    }
    // Links that are stiffer the lower they are tear one after the other from the top.
    let stiffer = |i: usize| 50.0 * (1.0 + 0.1 * i as f64);
    for (count, onset) in [(1, 1.519), (2, 1.8671), (3, 2.2152)] {
        for (force_n, count) in [(onset - 1e-9, count - 1), (onset + 1e-9, count)] {
            let cut = cut_links(&strain, &mut loaded(force_n, stiffer));
            assert!(cut.iter().map(|cut| cut.0).eq(0..count), "{cut:?}");
        }
    }
}

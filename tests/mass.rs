//! Masses: what is refused, what they start from, and what is conserved; and the sums that tell.

use tearmesh::insert::Plan;
use tearmesh::{
    Edits, ExactSum, Follower as _, MassError, MassLedger, Masses, Mesh, mend, shapes, split,
};

use crate::foreign::panic_of;

const USUAL: &str = "nothing unusual";

fn power_of_two(exponent: i32) -> f64 {
    2f64.powi(exponent)
}

/// The exponent of the power of two at or below a number.
fn exponent_of(number: f64) -> i32 {
    number.log2().floor() as i32
}

#[test]
fn masses_that_cannot_be_exact_are_refused() {
    let (mesh, positions) = shapes::fan(80, true);
    let points: Vec<[f64; 3]> = positions.as_slice().iter().map(|&p| p.into()).collect();
    let refused = |points: &[[f64; 3]], density| {
        Masses::area(&mesh, points, density).expect_err("it is refused")
    };
    for density in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        let expected = format!("the density {density} is not a positive finite number");
        assert_eq!(refused(&points, density).to_string(), expected);
    }
    for x in [0.0, f64::NAN] {
        let nowhere = vec![[x; 3]; points.len()];
        assert_eq!(refused(&nowhere, 1.0), MassError::NoArea);
    }
    for density in [1e308, 1e-308] {
        let error = refused(&points, density);
        assert!(matches!(error, MassError::OutOfRange { .. }), "{error}");
    }
}

#[test]
fn halving_is_refused_just_where_it_leaves_normal_numbers() {
    // The hub could be halved 79 times, a vertex of the rim once.
    let (mesh, positions) = shapes::fan(80, true);
    let hub = mesh.vertex(0);
    let at_one = Masses::area(&mesh, &positions, 1.0).expect(USUAL).at(hub);
    let lightest = power_of_two(-1022 + 79 - (exponent_of(at_one)));
    let masses = Masses::half(&mesh, &positions, lightest).expect(USUAL);
    assert!(masses.at(hub) * power_of_two(-79) >= f64::MIN_POSITIVE);
    assert_eq!(
        Masses::half(&mesh, &positions, lightest / 2.0).expect_err("it is refused"),
        MassError::TooLight {
            vertices: vec![hub]
        }
    );
    assert!(Masses::area(&mesh, &positions, lightest / 2.0).is_ok());
}

#[test]
fn copies_that_came_with_the_mesh_are_sewn_without_loss() {
    let (mut mesh, mut positions) = shapes::fan(6, true);
    let mut edits = Edits::new();
    let hub = mesh.vertex(0);
    let split = |mesh: &mut Mesh, edits: &mut Edits| {
        let face = mesh.faces_of(hub).next().expect(USUAL);
        split::vertex(mesh, hub, &[face], edits).expect(USUAL).new
    };
    let first = split(&mut mesh, &mut edits);
    edits.replay(&mut positions);
    edits.clear();
    let halves = Masses::half(&mesh, &positions, 1.0).expect(USUAL);
    let mut masses = halves.starting_at(edits.cursor());
    let [of_hub, of_first] = [hub, first].map(|v| masses.at(v));
    let second = split(&mut mesh, &mut edits);
    mend::merge(&mut mesh, first, second, [1.0; 2], &mut edits).expect(USUAL);
    edits.replay(&mut masses);
    assert_eq!(masses.at(hub), of_hub / 2.0);
    assert_eq!(masses.at(first), of_first + of_hub / 2.0);
    mend::merge(&mut mesh, hub, first, [1.0; 2], &mut edits).expect(USUAL);
    edits.replay(&mut masses);
    assert_eq!(masses.at(hub), of_hub + of_first);
    assert!(masses.ledger().is_balanced());
}

#[test]
fn a_ledger_sees_the_smallest_difference() {
    let is_balanced = |before: &[f64], after: &[f64]| {
        let [before, after] = [before, after].map(|x| x.iter().copied().collect());
        MassLedger { before, after }.is_balanced()
    };
    assert!(is_balanced(&[1.0], &[0.25, 0.75]));
    assert!(!is_balanced(&[1.0, 5e-324], &[1.0]));
}

#[test]
fn a_face_without_area_still_weighs_three_units() {
    let mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]]).expect(USUAL);
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.5, 0.5, 0.0],
    ];
    let masses = Masses::area(&mesh, &points[..], 2.0).expect(USUAL);
    let lightest = masses.at(mesh.vertex(3));
    assert_eq!([lightest, masses.unit()], [power_of_two(1 - 52); 2]);
}

/// A face of 3 to 12 units is divided into four.
#[test]
fn children_of_a_face_of_few_units_lose_none() {
    let whole = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]]).expect(USUAL);
    let mut plan = Plan::new();
    for t in [0.25, 0.5, 0.75] {
        plan.on_edge(whole.half_edge(4), t);
    }
    for units in 3..=12 {
        let areas = [1.0, f64::from(units) * power_of_two(-51)];
        let masses = Masses::by_areas(&whole, |f| areas[f.index()], 1.0);
        let (mut mesh, mut edits) = (whole.clone(), Edits::new());
        plan.apply(&mut mesh, &mut edits).expect(USUAL);
        let mut masses = masses.expect(USUAL);
        edits.replay(&mut masses);
        assert!(masses.ledger().is_balanced(), "{units}");
    }
    let (mut mesh, positions) = shapes::grid(1, 1);
    let mut half = Masses::half(&mesh, &positions, 1.0).expect(USUAL);
    let mut edits = Edits::new();
    plan.apply(&mut mesh, &mut edits).expect(USUAL);
    let told = panic_of(|| edits.replay(&mut half)).expect("a panic");
    assert!(told.starts_with("masses by halves cannot follow an insertion"));
}

#[test]
fn sums_are_rounded_once_and_to_even() {
    let (ulp, half) = (power_of_two(-52), power_of_two(-53));
    let (dust, most) = (5e-324, f64::MAX);
    for (numbers, sum) in [
        (&[1.0, half][..], 1.0),
        (&[1.0, half, dust], 1.0 + ulp),
        (&[1.0, ulp, half], 1.0 + 2.0 * ulp),
        (&[1.0, half, -dust], 1.0),
        (&[most, most], f64::INFINITY),
        (&[-most, -most], f64::NEG_INFINITY),
    ] {
        let exact = ExactSum::from_iter(numbers.iter().copied());
        assert_eq!(exact.to_f64(), sum, "{numbers:?}");
    }
    for x in [
        0.0,
        -1.5,
        0.1,
        1e300,
        -1e-300,
        dust,
        most,
        f64::MIN_POSITIVE,
    ] {
        assert_eq!(ExactSum::from_iter([x]).to_f64(), x);
        assert_eq!(ExactSum::from_iter([x, -x]).to_f64(), 0.0);
    }
}

#[test]
fn sums_do_not_depend_on_the_order_of_their_numbers() {
    // Integers below 2^53 scaled apart by powers of two; the oracle is i128.
    let number = |i: i64| ((i * 7_919_993 % 1_000_003) - 500_000, i as i32 % 60);
    let exact: i128 = (0..200)
        .map(number)
        .map(|(n, by)| i128::from(n) << by)
        .sum();
    let float = |i| {
        let (n, by) = number(i);
        n as f64 * power_of_two(by)
    };
    let forward: ExactSum = (0..200).map(float).collect();
    let backward: ExactSum = (0..200).rev().map(float).collect();
    assert_eq!(forward, backward);
    assert_eq!(forward.to_f64(), exact as f64);
}

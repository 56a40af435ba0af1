//! Masses: what is refused, what they start from, and what is conserved; and the sums that tell.

use tearmesh::{
    Edits, ExactSum, Follower as _, MassError, MassLedger, Masses, Mesh, mend, shapes, split,
};

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
    assert_eq!(
        refused(&points, f64::NAN).to_string(),
        "the density NaN is not a positive finite number"
    );
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
    assert_eq!(lightest, power_of_two(1 - 52));
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

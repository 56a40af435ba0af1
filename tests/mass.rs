//! Masses: what is refused, what they start from, and what is conserved; and the sums that tell.

use tearmesh::{
    Cursor, Edits, ExactSum, MassError, MassLedger, Masses, Mesh, VertexId, mend, shapes, split,
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
fn a_flat_unit_square_weighs_its_density() {
    for (columns, rows) in [(1, 1), (3, 5), (32, 32)] {
        let (mesh, positions) = shapes::grid(columns, rows);
        let masses = Masses::area(&mesh, &positions, 2.5).expect(USUAL);
        let total = masses.total().to_f64();
        assert!((total - 2.5).abs() < 1e-13, "{total}");
        let halves = Masses::half(&mesh, &positions, 2.5).expect(USUAL);
        assert_eq!(masses.total(), halves.total());
    }
}
#[test]
fn what_cannot_be_exact_is_refused() {
    let (mesh, positions) = shapes::fan(80, true);
    assert_eq!(
        Masses::area(&mesh, &positions, f64::NAN)
            .expect_err("it is refused")
            .to_string(),
        "the density NaN is not a positive finite number"
    );
    let flat = vec![[0.0; 3]; mesh.vertex_count()];
    assert_eq!(
        Masses::area(&mesh, &flat[..], 1.0).expect_err("it is refused"),
        MassError::NoArea
    );
    let nan = vec![[f64::NAN; 3]; mesh.vertex_count()];
    assert_eq!(
        Masses::area(&mesh, &nan[..], 1.0).expect_err("it is refused"),
        MassError::NoArea
    );
    for density in [1e308, 1e-308] {
        let error = Masses::area(&mesh, &positions, density).expect_err("it is refused");
        assert!(
            matches!(error, MassError::OutOfRange { .. }),
            "{density}: {error}"
        );
    }
}
#[test]
fn halving_is_refused_exactly_where_it_would_leave_the_normal_numbers() {
    // The hub could be halved 79 times, a vertex of the rim once.
    let (mesh, positions) = shapes::fan(80, true);
    let hub = VertexId::new(0).expect(USUAL);
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
    let hub = VertexId::new(0).expect(USUAL);
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
    let sum = |numbers: &[f64]| ExactSum::from_iter(numbers.iter().copied());
    let balanced = MassLedger {
        before: sum(&[1.0]),
        after: sum(&[0.25, 0.75]),
    };
    assert!(balanced.is_balanced());
    let lost = MassLedger {
        before: sum(&[1.0, 5e-324]),
        after: sum(&[1.0]),
    };
    assert!(!lost.is_balanced());
}
#[test]
fn masses_know_how_many_and_which_edit_comes_next() {
    let (mesh, positions) = shapes::triangle();
    for masses in [
        Masses::area(&mesh, &positions, 1.0),
        Masses::half(&mesh, &positions, 1.0),
    ] {
        let masses = masses.expect(USUAL);
        assert_eq!(
            (masses.len(), masses.is_empty(), masses.seen()),
            (3, false, Cursor::START)
        );
        let seen = Cursor::from_bytes([7; 16]);
        assert_eq!(masses.starting_at(seen).seen(), seen);
    }
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
    let lightest = masses.at(VertexId::new(3).expect(USUAL));
    assert_eq!(lightest, power_of_two(1 - 52));
}

#[test]
fn one_number_comes_back_as_it_went_in() {
    for x in [
        0.0,
        1.0,
        -1.5,
        0.1,
        1e300,
        -1e-300,
        5e-324,
        f64::MAX,
        f64::MIN_POSITIVE,
    ] {
        assert_eq!(ExactSum::from_iter([x]).to_f64(), x);
        assert_eq!(ExactSum::from_iter([x, -x]).to_f64(), 0.0);
    }
}
#[test]
fn rounding_happens_once_and_to_even() {
    let ulp = power_of_two(-52);
    let half = power_of_two(-53);
    let dust = 5e-324;
    assert_eq!(ExactSum::from_iter([1.0, half]).to_f64(), 1.0);
    assert_eq!(ExactSum::from_iter([1.0, half, dust]).to_f64(), 1.0 + ulp);
    assert_eq!(
        ExactSum::from_iter([1.0, ulp, half]).to_f64(),
        1.0 + 2.0 * ulp
    );
    assert_eq!(ExactSum::from_iter([1.0, half, -dust]).to_f64(), 1.0);
    assert_eq!(
        ExactSum::from_iter([f64::MAX, f64::MAX]).to_f64(),
        f64::INFINITY
    );
    assert_eq!(
        ExactSum::from_iter([-f64::MAX, -f64::MAX]).to_f64(),
        f64::NEG_INFINITY
    );
}
#[test]
fn the_order_of_the_numbers_does_not_matter() {
    // Integers below 2^53 scaled apart by powers of two; the oracle is i128.
    let numbers: Vec<i64> = (0..200i64)
        .map(|i| (i * 7_919_993 % 1_000_003) - 500_000)
        .collect();
    let exact: i128 = numbers
        .iter()
        .enumerate()
        .map(|(i, &n)| i128::from(n) << (i % 60))
        .sum();
    let float = |i: usize, n: i64| n as f64 * power_of_two(i as i32 % 60);
    let forward: ExactSum = numbers
        .iter()
        .enumerate()
        .map(|(i, &n)| float(i, n))
        .collect();
    let backward: ExactSum = numbers
        .iter()
        .enumerate()
        .rev()
        .map(|(i, &n)| float(i, n))
        .collect();
    assert_eq!(forward, backward);
    assert_eq!(forward.to_f64(), exact as f64);
}

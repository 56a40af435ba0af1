//! Errors against answers worked out by hand.

use super::*;

#[test]
fn error_is_the_largest_of_the_quantities_that_both_know() {
    let run = |answer: &[&[f64]]| Row {
        answer: Some(answer.iter().map(|numbers| numbers.to_vec()).collect()),
        ..Row::default()
    };
    let of = |runs: &[Row], known: &Row| error(&runs.iter().collect::<Vec<_>>(), &[known]);
    let known = run(&[&[3.0, 4.0], &[2.0]]);
    // The means are [3.0, 4.5] and 1.9.
    let runs = [run(&[&[3.0, 4.0], &[1.6]]), run(&[&[3.0, 5.0], &[2.2]])];
    let found = of(&runs, &known).expect("both are known");
    assert!((found - 0.1).abs() < 1e-15, "{found}");
    assert_eq!(of(&[run(&[&[3.0, 4.0]])], &known), Some(0.0));
    assert_eq!(of(&[Row::default()], &known), None);
}

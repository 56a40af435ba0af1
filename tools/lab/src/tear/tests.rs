//! Titles say what is found of strips, and references are found where methods agree.

use super::*;

/// Slopes by hand: forces that are proportional to the length of edges, or to its root, or nearly the same.
#[test]
fn title_says_that_toughness_depends_less_if_it_does() {
    let title = |power: f64| {
        let rules = [(Rule::Stretch, 1.0), (Rule::Toughness, power)];
        let rows = rules.into_iter().flat_map(|(rule, power)| {
            [8, 16].map(|cells| Row {
                cells,
                rule: Some(rule),
                largest_force_n: Some(f64::from(cells).powf(-power)),
                ..Row::default()
            })
        });
        let rows: Vec<Row> = rows.collect();
        chart::title(&rows)
    };
    let [little, much] = [0.25, 0.75].map(title);
    assert!(
        little.contains("(slope +1.00), by toughness much less (+0.25)"),
        "{little}"
    );
    assert!(
        much.contains("+0.75 by toughness)") && !much.contains("less"),
        "{much}"
    );
}

/// Sixteen runs by a method at each step, whose torn lengths are around these medians.
fn torn(method: &str, medians_m: [f64; 3]) -> Vec<Row> {
    let steps = [1, 2, 4].into_iter().zip(medians_m);
    steps
        .flat_map(|(divisor, median_m)| {
            (1..=16).map(move |seed| {
                (
                    divisor,
                    median_m * (0.99 + 0.002 * (seed % 11) as f64),
                    seed,
                )
            })
        })
        .map(|(divisor, torn_m, seed)| Row {
            method: method.to_owned(),
            step_divisor: divisor,
            seed,
            torn_m: Some(torn_m),
            ..Row::default()
        })
        .collect()
}

#[test]
fn reference_is_the_pair_of_converged_methods_that_agree() {
    let reference = |rows: &[Row]| {
        let first = chart::ensembles(rows).swap_remove(0);
        first.reference.map(|(methods, _)| methods)
    };
    let mut rows = torn("verlet", [2.0; 3]);
    rows.extend(torn("pbd", [4.0, 8.0, 16.0]));
    assert_eq!(reference(&rows), None);
    // XPBD agrees at its finest step by chance: it still changes with the step.
    rows.extend(torn("xpbd", [4.0, 3.0, 2.0]));
    assert_eq!(reference(&rows), None);
    rows.extend(torn("implicit", [3.0, 2.2, 2.1]));
    assert_eq!(reference(&rows), Some(["verlet", "implicit"]));
    // If a run failed, those that are left are not a random choice.
    for row in rows.iter_mut().filter(|row| row.seed == 3) {
        row.torn_m = None;
    }
    assert_eq!(reference(&rows), None);
}

//! Fronts of cost against error: which runs are worth their cost.

use super::{FLOORS, Row};

/// The fraction by which a point has to be better in order to dominate.
const MARGIN: f64 = 0.1;

/// Errors below this multiple of the floor are drawn there.
const LEAST: f64 = 0.01;

/// A row with a known error and cost, among all rows of a case by an observable.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ranked<'a> {
    pub(super) row: &'a Row,
    /// Where it is drawn: the visits of edges, and the error.
    pub(super) at: [f64; 2],
    /// The largest error of this and all shorter steps of the method, which is compared with tolerances. So a
    /// lucky zero crossing of the error does not count.
    pub(super) error_converged: f64,
    /// The cost, and the error where it counts. `None` if the error exceeds that of a longer step by more than a
    /// tenth and is above ten times the floor.
    place: Option<[f64; 2]>,
    /// Whether no other run dominates it.
    pub(super) is_on_front: bool,
}

/// Ranks the rows that have an error and a cost, given in descending order of the steps of each method. Compares all
/// pairs.
pub(super) fn ranked<'a>(rows: &[&'a Row]) -> Vec<Ranked<'a>> {
    let known = rows.iter();
    let known = known.filter_map(|row| Some((*row, row.error_total?, row.cost()?)));
    let known: Vec<(&Row, f64, f64)> = known.collect();
    let mut ranked = Vec::new();
    for series in known.chunk_by(|a, b| a.0.method == b.0.method) {
        for (i, &(row, error, cost)) in series.iter().enumerate() {
            let exceeds = |longer: &(&Row, f64, f64)| error > (1.0 + MARGIN) * longer.1;
            let is_rising = series[..i].iter().any(exceeds) && !row.is_at_floor();
            let floor = row.error_floor.unwrap_or(0.0);
            ranked.push(Ranked {
                row,
                at: [cost, error.max(LEAST * floor)],
                error_converged: series[i..].iter().map(|of| of.1).fold(0.0, f64::max),
                // Below the floor no error is better than another.
                place: (!is_rising).then_some([cost, error.max(FLOORS * floor)]),
                is_on_front: false,
            });
        }
    }
    let places: Vec<[f64; 2]> = ranked.iter().filter_map(|one| one.place).collect();
    for one in &mut ranked {
        let is_beaten = |place| places.iter().any(|&other| dominates(other, place));
        one.is_on_front = one.place.is_some_and(|place| !is_beaten(place));
    }
    ranked
}

/// Whether a point is a tenth better than another in cost or in error, and no worse in the other.
///
/// A tenth in both would leave each run on the front whose error equals that of a cheaper one, at whatever cost.
fn dominates(a: [f64; 2], b: [f64; 2]) -> bool {
    let is_better = |i: usize| a[i] < b[i] && a[i] <= (1.0 - MARGIN) * b[i];
    is_better(0) && a[1] <= b[1] || is_better(1) && a[0] <= b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_a_tenth_better_and_nowhere_worse_dominates() {
        for (better, worse, is_dominated) in [
            ([0.95, 0.95], [1.0, 1.0], false),
            ([1.0, 1.0], [5.0, 1.0], true),
            ([1.0, 1.0], [0.99, 5.0], false),
            ([1.0, 1.0], [5.0, 0.99], false),
            ([1.0, 1.0], [1.2, 1.2], true),
            ([1.0, 1.0], [1.0, 1.0], false),
        ] {
            assert_eq!(
                dominates(better, worse),
                is_dominated,
                "{better:?} {worse:?}"
            );
            assert!(!dominates(worse, better));
        }
    }

    #[test]
    fn an_error_counts_from_where_all_shorter_steps_keep_it() {
        let row = |(i, error): (u64, f64)| Row {
            visits: Some(10 + i),
            error_floor: Some(0.0),
            error_total: Some(error),
            ..Row::default()
        };
        let rows: Vec<Row> = (0..).zip([4.0, 1e-9, 2.0, 1.0]).map(row).collect();
        let ranked = ranked(&rows.iter().collect::<Vec<_>>());
        let converged = ranked.iter().map(|one| one.error_converged);
        assert_eq!(converged.collect::<Vec<_>>(), [4.0, 2.0, 2.0, 1.0]);
        let is_placed = ranked.iter().map(|one| one.place.is_some());
        assert_eq!(is_placed.collect::<Vec<_>>(), [true, true, false, false]);
    }
}

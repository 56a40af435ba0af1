//! Fronts of cost against error: which runs are worth their cost.

/// The fraction by which a point has to be better in order to dominate.
const MARGIN: f64 = 0.1;

/// The multiple of the floor below which errors are not distinguished.
pub(crate) const FLOORS: f64 = 10.0;

/// The cost and the error of a run. For both, smaller is better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    /// The cost, in any unit.
    pub(crate) cost: f64,
    /// The error, in any unit.
    pub(crate) error: f64,
}

impl Point {
    /// Returns whether this point is a tenth better than `other` in cost or in error, and no worse in the
    /// other.
    ///
    /// A tenth in both would leave each run on the front whose error equals that of a cheaper one, at whatever
    /// cost.
    #[must_use]
    pub(crate) fn dominates(self, other: Point) -> bool {
        let is_better = |a: f64, b: f64| a < b && a <= (1.0 - MARGIN) * b;
        let is_cheaper = is_better(self.cost, other.cost);
        let is_closer = is_better(self.error, other.error);
        is_cheaper && self.error <= other.error || is_closer && self.cost <= other.cost
    }
}

/// Returns, for each point, whether no other point dominates it. Compares all pairs.
#[must_use]
pub(crate) fn front(points: &[Point]) -> Vec<bool> {
    let is_on = |point: &Point| !points.iter().any(|other| other.dominates(*point));
    points.iter().map(is_on).collect()
}

/// Returns the errors of a series, from its longest step to its shortest, each replaced by the largest of its
/// own and those of all shorter steps. So a lucky zero crossing of the error does not count.
#[must_use]
pub(crate) fn converged(errors: &[f64]) -> Vec<f64> {
    let mut converged = errors.to_vec();
    for i in (1..converged.len()).rev() {
        converged[i - 1] = converged[i - 1].max(converged[i]);
    }
    converged
}

/// Returns which errors of a series, from its longest step to its shortest, exceed that of a longer step by
/// more than a tenth.
#[must_use]
pub(crate) fn rising(errors: &[f64]) -> Vec<bool> {
    let mut least = f64::INFINITY;
    let each = errors.iter().map(|&error| {
        let is_rising = error > (1.0 + MARGIN) * least;
        least = least.min(error);
        is_rising
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_dominates_if_it_is_a_tenth_better_and_nowhere_worse() {
        let point = |cost, error| Point { cost, error };
        for (better, worse, dominates) in [
            (point(0.95, 0.95), point(1.0, 1.0), false),
            (point(1.0, 1.0), point(5.0, 1.0), true),
            (point(1.0, 1.0), point(0.99, 5.0), false),
            (point(1.0, 1.0), point(5.0, 0.99), false),
            (point(1.0, 1.0), point(1.2, 1.2), true),
            (point(1.0, 1.0), point(1.0, 1.0), false),
        ] {
            assert_eq!(better.dominates(worse), dominates, "{better:?} {worse:?}");
            assert_eq!(front(&[better, worse]), [true, !dominates]);
        }
    }

    #[test]
    fn an_error_counts_from_the_step_on_that_all_shorter_ones_keep_it() {
        assert_eq!(converged(&[4.0, 1e-9, 2.0, 1.0]), [4.0, 2.0, 2.0, 1.0]);
        assert_eq!(
            rising(&[4.0, 1.0, 1.05, 2.0, 0.5]),
            [false, false, false, true, false]
        );
    }
}

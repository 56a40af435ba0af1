//! Fronts of work against error, and who is cheapest at a tolerance.

/// By how much a point has to be better, as a part, to dominate.
pub(crate) const MARGIN: f64 = 0.1;

/// The cost and the error of a run. For both, smaller is better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The cost, in any unit.
    pub cost: f64,
    /// The error, in any unit.
    pub error: f64,
}

impl Point {
    /// Returns whether this point is a tenth better than `other` in cost or in error, and no worse in the
    /// other.
    ///
    /// A tenth in both would leave each run on the front whose error equals that of a cheaper one, at whatever
    /// cost.
    #[must_use]
    pub fn dominates(self, other: Point) -> bool {
        let is_cheaper = is_better(self.cost, other.cost);
        let is_nearer = is_better(self.error, other.error);
        is_cheaper && self.error <= other.error || is_nearer && self.cost <= other.cost
    }
}

fn is_better(a: f64, b: f64) -> bool {
    a < b && a <= (1.0 - MARGIN) * b
}

/// Returns, for each point, whether no other point dominates it, in O(n log n).
#[must_use]
pub fn front(points: &[Point]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| points[i].cost.total_cmp(&points[j].cost));
    let mut is_on = vec![true; points.len()];
    let mut cheaper = Least::default();
    let mut no_dearer = Least::default();
    for &i in &order {
        let Point { cost, error } = points[i];
        let least = cheaper.of(points, &order, |other| is_better(other, cost));
        let is_matched = least <= error;
        let least = no_dearer.of(points, &order, |other| other <= cost);
        is_on[i] = !is_matched && !is_better(least, error);
    }
    is_on
}

/// The least error of the points at the head of an order.
#[derive(Clone, Copy, Debug)]
struct Least {
    count: usize,
    error: f64,
}

impl Default for Least {
    fn default() -> Least {
        Least {
            count: 0,
            error: f64::INFINITY,
        }
    }
}

impl Least {
    /// The least error of the points up to the last whose cost is one of those.
    fn of(&mut self, points: &[Point], order: &[usize], is_one: impl Fn(f64) -> bool) -> f64 {
        while let Some(&next) = order.get(self.count)
            && is_one(points[next].cost)
        {
            self.error = self.error.min(points[next].error);
            self.count += 1;
        }
        self.error
    }
}

/// The points of one series, from its longest step to its shortest, by the error that each of them
/// vouches for: the largest of its own and those of all shorter steps. So nobody meets a tolerance by
/// an error that happens to pass zero.
#[must_use]
pub(crate) fn vouched(errors: &[f64]) -> Vec<f64> {
    let mut vouched = errors.to_vec();
    for i in (1..vouched.len()).rev() {
        vouched[i - 1] = vouched[i - 1].max(vouched[i]);
    }
    vouched
}

/// Which errors of one series, from its longest step to its shortest, are more than a tenth larger than
/// one of a longer step.
#[must_use]
pub(super) fn rising(errors: &[f64]) -> Vec<bool> {
    let mut least = f64::INFINITY;
    errors
        .iter()
        .map(|&error| {
            let is_rising = error > (1.0 + MARGIN) * least;
            least = least.min(error);
            is_rising
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use tearmesh_cloth::statistics::Random;

    use super::*;

    #[test]
    fn a_front_is_what_a_comparison_of_all_pairs_leaves() {
        let mut random = Random::new(7);
        for round in 0..400 {
            let count = 1 + round % 40;
            let points: Vec<Point> = (0..count)
                .map(|_| {
                    // On a coarse lattice, so that there are equals and points at the margin.
                    let mut number = || [1.0, 0.9, 0.81, 0.5, 2.0][(random.next() * 5.0) as usize];
                    let (a, b, c, d) = (number(), number(), number(), number());
                    // A coarse clock may find that no run takes any time.
                    let is_timed = round % 4 > 0;
                    Point {
                        cost: if is_timed { a * b } else { 0.0 },
                        error: c * d,
                    }
                })
                .collect();
            let is_on = front(&points);
            for (i, a) in points.iter().enumerate() {
                let beats = |b: &Point| {
                    let is_as_good = b.cost <= a.cost && b.error <= a.error;
                    let is_cheaper = b.cost < a.cost && b.cost <= 0.9 * a.cost;
                    let is_nearer = b.error < a.error && b.error <= 0.9 * a.error;
                    is_as_good && (is_cheaper || is_nearer)
                };
                assert_eq!(is_on[i], !points.iter().any(beats), "{a:?} of {points:?}");
            }
        }
    }

    #[test]
    fn a_point_that_is_better_by_less_than_a_tenth_dominates_nothing() {
        let point = |cost, error| Point { cost, error };
        assert!(!point(0.95, 0.95).dominates(point(1.0, 1.0)));
        assert!(point(1.0, 1.0).dominates(point(5.0, 1.0)));
        assert!(!point(1.0, 1.0).dominates(point(0.99, 5.0)));
        assert!(!point(1.0, 1.0).dominates(point(5.0, 0.99)));
        assert!(point(1.0, 1.0).dominates(point(1.2, 1.2)));
        assert!(!point(1.0, 1.0).dominates(point(1.0, 1.0)));
    }

    #[test]
    fn an_error_counts_from_the_step_on_that_all_shorter_ones_keep_it() {
        assert_eq!(vouched(&[4.0, 1e-9, 2.0, 1.0]), [4.0, 2.0, 2.0, 1.0]);
        assert_eq!(
            rising(&[4.0, 1.0, 1.05, 2.0, 0.5]),
            [false, false, false, true, false]
        );
    }
}

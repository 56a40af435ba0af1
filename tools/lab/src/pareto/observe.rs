//! Records: the numbers that are kept of a run, and the distance between two runs by an observable.
//!
//! A [`Probe`] records numbers while a run goes on. They are not subtracted from anything, so that runs can be
//! extrapolated to Δt → 0 before they are compared. An [`Observable`] is a distance between two such records,
//! relative to a third.

use tearmesh::{Point, Vector};
use tearmesh_cloth::{System, Threshold, force};

use super::observable::{Observable, RECORDS, Record};
use super::scene::{Case, Held, TEAR_RATIO, TOUGHNESS_J_PER_M, Until};

/// The recorded numbers of a run.
#[derive(Clone, Debug, Default)]
pub struct Records {
    /// By [`Record`]: coordinates, strains and forces of edges by checkpoint; the reaction; times and forces of
    /// first tears; energy. Empty if the scene does not have the observable, NaN if the run gave no value.
    of: [Vec<f64>; RECORDS],
}

impl Records {
    /// Returns the linear combination w a + (1 − w) b of the numbers of two runs.
    #[must_use]
    pub fn mixed(weight: f64, a: &Records, b: &Records) -> Records {
        let mix = |i: usize| {
            let pairs = a.of[i].iter().zip(&b.of[i]);
            pairs.map(|(a, b)| b + weight * (a - b)).collect()
        };
        Records {
            of: std::array::from_fn(mix),
        }
    }

    /// Returns the numbers to which three runs converge, each with half the step of the one before. It uses
    /// the ratio of their differences (Aitken), of vectors as a whole and of scalars one by one. The result
    /// is NaN if the differences do not become smaller, since there is no limit then.
    #[must_use]
    pub fn limit([coarse, middle, fine]: [&Records; 3]) -> Records {
        let of = |i: usize| {
            let [x, y, z] = [coarse, middle, fine].map(|records| &records.of[i][..]);
            let is_vector = i <= Record::Forces as usize;
            if !is_vector {
                let each = x.iter().zip(y).zip(z);
                return each
                    .map(|((x, y), z)| z + beyond(&[*x], &[*y], &[*z]) * (z - y))
                    .collect();
            }
            let weight = beyond(x, y, z);
            let each = y.iter().zip(z);
            each.map(|(y, z)| z + weight * (z - y)).collect()
        };
        Records {
            of: std::array::from_fn(of),
        }
    }
}

/// The smallest ratio of differences at which there is a limit; 2 is order one, 4 is order two.
const RATIO_MIN: f64 = 1.3;

/// The distance of the limit from the finest of three, as a multiple of the last difference; NaN for none.
fn beyond(x: &[f64], y: &[f64], z: &[f64]) -> f64 {
    let norm = |a: &[f64], b: &[f64]| {
        let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
        squares.sum::<f64>().sqrt()
    };
    let (first, last) = (norm(x, y), norm(y, z));
    if x.len() != z.len() || y.len() != z.len() {
        return f64::NAN;
    }
    if last == 0.0 {
        return 0.0;
    }
    let ratio = first / last;
    if ratio >= RATIO_MIN {
        1.0 / (ratio - 1.0)
    } else {
        f64::NAN
    }
}

/// The distance between two records by an observable, relative to a reference; `None` if one of them has no
/// value.
pub(super) fn distance(
    case: &Case,
    observable: Observable,
    [a, b]: [&Records; 2],
    reference: &Records,
) -> Option<f64> {
    let (record, place) = observable.record();
    let [a, b, of] = [a, b, reference].map(|records| &records.of[record as usize][..]);
    if a.is_empty() || a.len() != b.len() || (record != Record::Energy && a.len() != of.len()) {
        return None;
    }
    let apart = match record {
        Record::Positions => displaced(case, a, b, of),
        Record::Strains | Record::Forces => {
            let count = case.edges.len();
            let chunks = a.chunks(count).zip(b.chunks(count)).zip(of.chunks(count));
            let each = chunks.map(|((a, b), of)| strained(observable, a, b, of));
            each.fold(0.0, worse)
        }
        Record::Energy => (a[place] - b[place]).abs(),
        Record::Reaction | Record::Tears => (a[place] - b[place]).abs() / of[place].abs(),
    };
    apart.is_finite().then_some(apart)
}

/// The error of a record: [`distance`] from the reference, or from zero for energy.
pub(super) fn error(
    case: &Case,
    observable: Observable,
    records: &Records,
    reference: &Records,
) -> Option<f64> {
    if observable.is_energy() {
        let (record, place) = observable.record();
        let fraction = *records.of[record as usize].get(place)?;
        return fraction.is_finite().then_some(fraction);
    }
    distance(case, observable, [records, reference], reference)
}

/// The larger of two numbers, or NaN if either is.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

fn displaced(case: &Case, a: &[f64], b: &[f64], of: &[f64]) -> f64 {
    let start: Vec<f64> = flat(&case.start).collect();
    let count = start.len();
    let chunks = a.chunks(count).zip(b.chunks(count)).zip(of.chunks(count));
    let norm = |p: &[f64], q: &[f64]| mass_weighted_square(case, p, q).sqrt();
    let each = chunks.map(|((a, b), of)| norm(a, b) / norm(of, &start));
    each.fold(0.0, worse)
}

fn mass_weighted_square(case: &Case, p: &[f64], q: &[f64]) -> f64 {
    let squares = p.iter().zip(q).map(|(p, q)| (p - q) * (p - q));
    let masses = case.sheet.masses.iter().flat_map(|m| [m; 3]);
    squares.zip(masses).map(|(s, m)| s * m).sum()
}

/// The mass-weighted rms distance between the positions of two records in metres, at the worst checkpoint. For
/// a strip that is pulled, the distance that the hand moves between their first tears.
pub(super) fn apart_m(case: &Case, [a, b]: [&Records; 2]) -> f64 {
    if let Held::Pulled(speed) = case.scene.held {
        let [a, b] = [a, b].map(|records| &records.of[Record::Tears as usize][..]);
        let late = |i: usize| (a[i] - b[i]).abs() * speed;
        return worse(late(0), late(2));
    }
    let [a, b] = [a, b].map(|records| &records.of[Record::Positions as usize][..]);
    let count = 3 * case.start.len();
    let chunks = a.chunks(count).zip(b.chunks(count));
    let each = chunks.map(|(a, b)| mass_weighted_square(case, a, b));
    let whole = case.sheet.masses.iter().sum::<f64>();
    (each.fold(0.0, worse) / whole).sqrt()
}

/// The fraction of the largest strain from which on an edge counts as loaded.
const LOADED: f64 = 0.3;

fn strained(observable: Observable, a: &[f64], b: &[f64], of: &[f64]) -> f64 {
    let most = |x: &[f64]| x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let largest = most(of);
    if observable == Observable::StrainLargest {
        return (most(a) - most(b)).abs() / largest;
    }
    let each = a.iter().zip(b).zip(of);
    let loaded = each.filter(|(_, of)| **of > LOADED * largest);
    let off: Vec<f64> = loaded.map(|((a, b), of)| ((a - b) / of).abs()).collect();
    (off.iter().map(|x| x * x).sum::<f64>() / off.len() as f64).sqrt()
}

fn flat(points: &[Point]) -> impl Iterator<Item = f64> + '_ {
    points.iter().flat_map(|p| [p.x, p.y, p.z])
}

/// The time over which forces are averaged, in seconds.
const MEAN_S: f64 = 1.0 / 60.0;

/// A recorder of the observables of a run.
#[derive(Debug)]
pub(super) struct Probe<'a> {
    case: &'a Case,
    records: Records,
    elapsed_s: f64,
    /// The held particles whose force counts.
    held: Vec<usize>,
    /// The force at them over time.
    reaction: Samples,
    /// The time between two samples of the force in seconds; `None` if it is not recorded.
    reaction_every_s: Option<f64>,
    /// The work of the hand that pulls, in joules.
    hand_j: f64,
    /// Whether the work of a step is done by the force at its end, and not by the mean of both ends.
    moves_at_end: bool,
    tears: [Watched; 2],
    /// The time at which edges are checked next, in seconds.
    check_s: f64,
}

/// A threshold, and when an edge first reached it.
#[derive(Clone, Copy, Debug)]
struct Watched {
    threshold: Threshold,
    /// The time and the largest load of the last check.
    last: [f64; 2],
    torn_s: Option<f64>,
}

impl<'a> Probe<'a> {
    /// Creates a probe of a system that has not moved yet. `moves_at_end` is whether the method moves particles
    /// by the forces at the end of a step.
    pub(super) fn new(case: &'a Case, system: &System, moves_at_end: bool) -> Probe<'a> {
        let is_pulled = matches!(case.scene.held, Held::Pulled(_));
        let points = &case.sheet.points;
        let counts = |i: &usize| case.is_held(&points[*i]) && !(is_pulled && points[*i].y == 0.0);
        let is_rest = matches!(case.scene.until, Until::Rest(_));
        let watched = |threshold| Watched {
            threshold,
            last: [0.0; 2],
            torn_s: None,
        };
        let mut probe = Probe {
            case,
            records: Records::default(),
            elapsed_s: 0.0,
            held: (0..points.len()).filter(counts).collect(),
            reaction: Samples::default(),
            reaction_every_s: match records(case, Record::Reaction) && !is_rest {
                true => Some(case.edge_s() / 3.0),
                false => is_pulled.then_some(0.0),
            },
            hand_j: 0.0,
            moves_at_end,
            tears: [
                Threshold::Stretch(TEAR_RATIO),
                Threshold::Toughness(TOUGHNESS_J_PER_M),
            ]
            .map(watched),
            check_s: 0.0,
        };
        if probe.reaction_every_s.is_some() {
            probe.reaction.push(0.0, probe.reaction_n(system));
        }
        probe
    }

    /// Records a step.
    pub(super) fn step(&mut self, system: &System, dt_s: f64) {
        self.elapsed_s = system.elapsed_s();
        if let Some(every_s) = self.reaction_every_s
            && self.elapsed_s >= self.reaction.last_s() + every_s - 0.5 * dt_s
        {
            let before_n = self.reaction.last();
            let now_n = self.reaction_n(system);
            self.reaction.push(self.elapsed_s, now_n);
            if let Held::Pulled(speed) = self.case.scene.held {
                let force_n = match self.moves_at_end {
                    true => now_n,
                    false => 0.5 * (before_n + now_n),
                };
                self.hand_j += force_n * speed * dt_s;
            }
        }
        if matches!(self.case.scene.until, Until::Tears(_)) && self.elapsed_s >= self.check_s {
            self.check(system);
        }
    }

    /// Records positions and strains.
    pub(super) fn checkpoint(&mut self, system: &System) {
        let of = &mut self.records.of;
        if records(self.case, Record::Positions) {
            of[Record::Positions as usize].extend(flat(system.positions()));
        }
        let stretches = system.stretches();
        for (kind, by_force) in [(Record::Strains, false), (Record::Forces, true)] {
            if !records(self.case, kind) {
                continue;
            }
            let strains = &mut of[kind as usize];
            let first = strains.len();
            strains.resize(first + stretches.len(), f64::NAN);
            for id in stretches.iter() {
                let spring = stretches.get(id);
                strains[first + id.index()] = if by_force {
                    let stiffness_n = spring.stiffness_n_per_m * spring.rest_length_m;
                    force::force_n(system, id) / stiffness_n
                } else {
                    system.stretch_ratio(id) - 1.0
                };
            }
        }
    }

    /// Records the energy that was made so far, as a fraction of what was put in.
    pub(super) fn energy(&mut self, made: f64) {
        let energy = &mut self.records.of[Record::Energy as usize];
        energy.resize(2, 0.0);
        energy[0] = worse(energy[0], made);
        energy[1] = worse(energy[1], -made);
    }

    /// The work of the hand that pulls so far, in joules.
    pub(super) fn hand_j(&self) -> f64 {
        self.hand_j
    }

    /// Whether both thresholds were reached.
    pub(super) fn has_torn(&self) -> bool {
        self.tears.iter().all(|watched| watched.torn_s.is_some())
    }

    /// The records of the run.
    pub(super) fn records(mut self, system: &System) -> Records {
        let reaction = match self.case.scene.until {
            Until::Rest(_) => vec![self.reaction_n(system)],
            Until::Time(seconds) if self.reaction_every_s.is_some() => {
                let ends_s = (1..=(seconds / MEAN_S + 1e-9) as u64).map(|i| i as f64 * MEAN_S);
                let means = ends_s.map(|end_s| self.reaction.mean(end_s - MEAN_S, end_s));
                vec![means.fold(f64::NEG_INFINITY, f64::max)]
            }
            _ => Vec::new(),
        };
        let tears = self.tears.iter().flat_map(|watched| {
            let torn_s = watched.torn_s.unwrap_or(f64::NAN);
            [torn_s, self.reaction.mean(torn_s - MEAN_S, torn_s)]
        });
        if matches!(self.case.scene.until, Until::Tears(_)) {
            self.records.of[Record::Tears as usize] = tears.collect();
        }
        self.records.of[Record::Reaction as usize] = reaction;
        self.records
    }

    /// The force at the holds: the sum of the magnitudes of all forces; for a frame, whose sides pull at each
    /// other, the magnitude of their sum; for the strip, the force of the hand.
    fn reaction_n(&self, system: &System) -> f64 {
        let forces = self.held.iter().map(|&i| force::reaction_n(system, i));
        match self.case.scene.held {
            Held::Pulled(_) => forces.map(|force| force.y).sum(),
            Held::Frame => forces.sum::<Vector>().norm(),
            _ => forces.map(|force| force.norm()).sum(),
        }
    }

    /// Checks all edges. The next check is after a thousandth of the scene's time, or after the next step if an
    /// edge is at nine tenths of its threshold.
    fn check(&mut self, system: &System) {
        let now_s = self.elapsed_s;
        let mut most = 0.0_f64;
        for watched in &mut self.tears {
            if watched.torn_s.is_some() {
                continue;
            }
            let stretches = system.stretches();
            let loads = stretches
                .iter()
                .map(|id| watched.threshold.load(system, id));
            let worst = loads.fold(0.0, |worst, load| load.unwrap_or(0.0).max(worst));
            if worst >= 1.0 {
                let [before_s, before] = watched.last;
                let fraction = (1.0 - before) / (worst - before);
                watched.torn_s = Some(before_s + fraction * (now_s - before_s));
            }
            watched.last = [now_s, worst];
            most = most.max(worst);
        }
        self.check_s = if most < 0.9 {
            now_s + self.case.scene.until.seconds() / 1000.0
        } else {
            0.0
        };
    }
}

/// Whether a scene has an observable that is read from this record.
fn records(case: &Case, record: Record) -> bool {
    let mut all = case.scene.observables.iter();
    all.any(|observable| observable.record().0 == record)
}

/// A force over time, linear between samples.
#[derive(Clone, Debug, Default)]
struct Samples {
    /// Seconds, newtons, and the integral until then.
    list: Vec<[f64; 3]>,
}

impl Samples {
    fn push(&mut self, s: f64, n: f64) {
        let sum = self.list.last().map_or(0.0, |[before_s, before_n, sum]| {
            sum + 0.5 * (before_n + n) * (s - before_s)
        });
        self.list.push([s, n, sum]);
    }

    fn last_s(&self) -> f64 {
        self.list.last().map_or(0.0, |last| last[0])
    }

    fn last(&self) -> f64 {
        self.list.last().map_or(0.0, |last| last[1])
    }

    /// The integral up to a time.
    fn sum(&self, s: f64) -> f64 {
        let after = self.list.partition_point(|sample| sample[0] < s);
        let Some(&[t, n, sum]) = self.list.get(after.saturating_sub(1)) else {
            return f64::NAN;
        };
        let slope = match self.list.get(after) {
            Some(next) if next[0] > t => (next[1] - n) / (next[0] - t),
            _ => 0.0,
        };
        sum + (n + 0.5 * slope * (s - t)) * (s - t)
    }

    /// The mean from one time to another.
    fn mean(&self, from_s: f64, to_s: f64) -> f64 {
        if !(from_s >= 0.0 && to_s > from_s) {
            return f64::NAN;
        }
        (self.sum(to_s) - self.sum(from_s)) / (to_s - from_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_samples_is_that_of_the_lines_between_them() {
        let mut samples = Samples::default();
        for (s, n) in [(0.0, 0.0), (1.0, 2.0), (3.0, 2.0), (4.0, 6.0)] {
            samples.push(s, n);
        }
        assert_eq!(samples.mean(0.0, 1.0), 1.0);
        assert_eq!(samples.mean(0.5, 1.0), 1.5);
        assert_eq!(samples.mean(1.0, 3.0), 2.0);
        assert!((samples.mean(2.0, 3.5) - (2.0 + 0.5 * 3.0) / 1.5).abs() < 1e-15);
    }

    #[test]
    fn limit_of_halved_steps_is_found_for_any_order() {
        let at = |x: f64| {
            let mut records = Records::default();
            records.of[Record::Positions as usize] = vec![1.0 + x, 2.0 - 3.0 * x];
            records.of[Record::Reaction as usize] = vec![5.0 + x];
            records
        };
        for order in [2.0, 4.0, 16.0] {
            let runs = [1.0, 1.0 / order, 1.0 / (order * order)].map(at);
            let limit = Records::limit(runs.each_ref());
            let [x, y] = limit.of[Record::Positions as usize][..] else {
                panic!("two numbers");
            };
            assert!(
                (x - 1.0).abs() < 1e-14 && (y - 2.0).abs() < 1e-14,
                "{order}"
            );
            assert!((limit.of[Record::Reaction as usize][0] - 5.0).abs() < 1e-14);
        }
        let runs = [1.0, 2.0, 4.0].map(at);
        let limit = Records::limit(runs.each_ref());
        assert!(limit.of[Record::Positions as usize][0].is_nan());
    }
}

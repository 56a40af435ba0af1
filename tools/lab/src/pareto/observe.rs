//! Observation of a run: how each [`Observable`] is measured, and how two runs are compared by it.
//!
//! A [`Probe`] records numbers while a run goes on. They are not subtracted from anything, so that runs can be
//! extrapolated to Δt → 0 before they are compared.

use std::collections::BTreeMap;

use tearmesh::{Point, Vector};
use tearmesh_cloth::{System, Threshold, energy, force};

use super::scene::{Case, Held, Observable, TEAR_RATIO, TOUGHNESS_J_PER_M, Until};
use crate::method::Family;

/// The numbers of a run by observable and checkpoint: coordinates, strains of edges, and single numbers. NaN
/// where the run gave no value.
pub(super) type Records = BTreeMap<Observable, Vec<Vec<f64>>>;

/// Richardson's extrapolation for order two, from a run and one with half its step.
pub(super) fn extrapolated(coarse: &Records, fine: &Records) -> Records {
    let mut limit = coarse.clone();
    for (coarse, fine) in limit.values_mut().zip(fine.values()) {
        let pairs = coarse.iter_mut().flatten().zip(fine.iter().flatten());
        pairs.for_each(|(coarse, fine)| *coarse += 4.0 / 3.0 * (fine - *coarse));
    }
    limit
}

/// The error of a run by an observable, relative to a known one; `None` if one of them has no value.
pub(super) fn error(case: &Case, by: Observable, run: &Records, known: &Records) -> Option<f64> {
    let run = run.get(&by)?;
    let known = if by.is_energy() { run } else { known.get(&by)? };
    let start: Vec<f64> = flat(&case.start).collect();
    let norm = |p: &[f64], q: &[f64]| mass_weighted_square(case, p, q).sqrt();
    let each = run.iter().zip(known).map(|(run, known)| match by {
        Observable::Displacement => norm(run, known) / norm(known, &start),
        Observable::StrainRms => strain_rms(run, known),
        Observable::EnergyMade | Observable::EnergyLost => run[0],
        _ => (run[0] - known[0]).abs() / known[0].abs(),
    });
    Some(each.fold(0.0, worse)).filter(|error| error.is_finite())
}

/// The mass-weighted rms distance between the positions of two runs in metres, at the worst checkpoint. For a
/// strip that is pulled, the distance that the hand moves between their first tears.
pub(super) fn apart_m(case: &Case, a: &Records, b: &Records) -> f64 {
    if let Held::Pulled(speed) = case.scene.held {
        let late = |time: Observable| (a[&time][0][0] - b[&time][0][0]).abs() * speed;
        return worse(late(Observable::TearTime), late(Observable::ToughnessTime));
    }
    let [a, b] = [a, b].map(|run| run[&Observable::Displacement].iter());
    let squares = a.zip(b).map(|(a, b)| mass_weighted_square(case, a, b));
    let whole = case.sheet.masses.iter().sum::<f64>();
    (squares.fold(0.0, worse) / whole).sqrt()
}

fn mass_weighted_square(case: &Case, p: &[f64], q: &[f64]) -> f64 {
    let squares = p.iter().zip(q).map(|(p, q)| (p - q) * (p - q));
    let masses = case.sheet.masses.iter().flat_map(|m| [m; 3]);
    squares.zip(masses).map(|(s, m)| s * m).sum()
}

/// The fraction of the largest strain from which on an edge counts as loaded.
const LOADED: f64 = 0.3;

fn strain_rms(run: &[f64], reference: &[f64]) -> f64 {
    let largest = reference.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let each = run.iter().zip(reference);
    let loaded = each.filter(|(_, known)| **known > LOADED * largest);
    let squares = loaded.map(|(run, known)| ((run - known) / known).powi(2));
    let squares: Vec<f64> = squares.collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// The larger of two numbers, or NaN if either is.
fn worse(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

fn flat(points: &[Point]) -> impl Iterator<Item = f64> + '_ {
    points.iter().flat_map(|p| [p.x, p.y, p.z])
}

/// The time over which forces are averaged, in seconds.
const MEAN_S: f64 = 1.0 / 60.0;

/// The largest energy that is allowed, as a multiple of the energy put in.
const ENERGY_MAX: f64 = 1.25;

/// A recorder of the observables of a run.
#[derive(Debug)]
pub(super) struct Probe<'a> {
    case: &'a Case,
    records: Records,
    /// The held particles whose force counts.
    held: Vec<usize>,
    /// The force at them over time.
    reaction: Samples,
    /// The time between two samples of the force, in seconds.
    reaction_every_s: f64,
    /// The work of the hand that pulls, in joules.
    hand_j: f64,
    /// The family of methods; `None` for a reference.
    family: Option<Family>,
    /// The energy in springs and of height at the start.
    began_j: [f64; 2],
    /// The most energy that had been put in so far.
    put_in_j: f64,
    thresholds: [FirstTear; 2],
    /// The time at which edges are checked next, in seconds.
    check_s: f64,
}

/// A threshold, and when an edge first reached it.
#[derive(Clone, Copy, Debug)]
struct FirstTear {
    threshold: Threshold,
    /// The time and the largest load of the last check.
    last: [f64; 2],
    /// NaN before the first tear.
    torn_s: f64,
}

impl<'a> Probe<'a> {
    /// Creates a probe of a system that has not moved yet, for a method of this family, or for a reference.
    pub(super) fn new(case: &'a Case, system: &System, family: Option<Family>) -> Probe<'a> {
        let is_pulled = matches!(case.scene.held, Held::Pulled(_));
        let points = &case.sheet.points;
        let counts = |i: &usize| case.is_held(&points[*i]) && !(is_pulled && points[*i].y == 0.0);
        let thresholds = [
            Threshold::Stretch(TEAR_RATIO),
            Threshold::Toughness(TOUGHNESS_J_PER_M),
        ];
        let mut probe = Probe {
            case,
            records: Records::new(),
            held: (0..points.len()).filter(counts).collect(),
            reaction: Samples::default(),
            reaction_every_s: match case.scene.until {
                Until::Time(_) => case.edge_s() / 3.0,
                Until::Rest(_) => f64::INFINITY,
                Until::Tears(_) => 0.0,
            },
            hand_j: 0.0,
            family,
            began_j: [energy::elastic_j(system), height_j(system)],
            put_in_j: 0.0,
            thresholds: thresholds.map(|threshold| FirstTear {
                threshold,
                last: [0.0; 2],
                torn_s: f64::NAN,
            }),
            check_s: 0.0,
        };
        probe.reaction.push(0.0, probe.reaction_n(system));
        probe
    }

    /// Records a step.
    pub(super) fn step(&mut self, system: &System, dt_s: f64) {
        let now_s = system.elapsed_s();
        if now_s >= self.reaction.last()[0] + self.reaction_every_s - 0.5 * dt_s {
            let now_n = self.reaction_n(system);
            if let Held::Pulled(speed) = self.case.scene.held {
                self.hand_j += 0.5 * (self.reaction.last()[1] + now_n) * speed * dt_s;
            }
            self.reaction.push(now_s, now_n);
        }
        if matches!(self.case.scene.until, Until::Tears(_)) && now_s >= self.check_s {
            self.check(system);
        }
    }

    fn record(&mut self, observable: Observable, numbers: Vec<f64>) {
        let checkpoints = self.records.entry(observable).or_default();
        checkpoints.push(numbers);
    }

    /// Records positions and strains.
    pub(super) fn checkpoint(&mut self, system: &System) {
        self.record(Observable::Displacement, flat(system.positions()).collect());
        let stretches = system.stretches();
        let mut strains = vec![f64::NAN; stretches.len()];
        for id in stretches.iter() {
            strains[id.index()] = system.stretch_ratio(id) - 1.0;
        }
        self.record(Observable::StrainRms, strains);
    }

    /// Records the energy beyond what was put in by gravity and by the hand that pulls, as a fraction of that.
    /// Returns the energy that is there as a multiple of it if it is more than is allowed.
    pub(super) fn energy(&mut self, system: &System) -> Option<f64> {
        let [stored_j, height_j] = [stored_j(system, self.family), height_j(system)];
        let now_j = stored_j + energy::kinetic_j(system);
        let fallen_j = self.began_j[1] - height_j;
        let put_in_j = self.began_j[0] + fallen_j.max(0.0) + self.hand_j.max(0.0);
        self.put_in_j = self.put_in_j.max(put_in_j);
        let made = (now_j - (self.began_j[0] + fallen_j + self.hand_j)) / self.put_in_j;
        self.record(Observable::EnergyMade, vec![made]);
        self.record(Observable::EnergyLost, vec![-made]);
        // Written so that a NaN is more.
        let is_allowed = now_j <= ENERGY_MAX * self.put_in_j;
        (!is_allowed).then(|| now_j / self.put_in_j)
    }

    /// Whether both thresholds were reached.
    pub(super) fn has_torn(&self) -> bool {
        !self.thresholds.iter().any(|first| first.torn_s.is_nan())
    }

    /// The records of the run.
    pub(super) fn records(mut self, system: &System) -> Records {
        let mean_n = |end_s: f64| self.reaction.mean(end_s - MEAN_S, end_s);
        let largest = |n: f64| vec![(Observable::ReactionLargest, n)];
        let numbers = match self.case.scene.until {
            Until::Rest(_) => largest(self.reaction_n(system)),
            Until::Time(seconds) => {
                let ends_s = (1..=(seconds / MEAN_S + 1e-9) as u64).map(|i| i as f64 * MEAN_S);
                largest(ends_s.map(mean_n).fold(f64::NEG_INFINITY, f64::max))
            }
            Until::Tears(_) => {
                let [by_stretch_s, by_toughness_s] = self.thresholds.map(|first| first.torn_s);
                vec![
                    (Observable::TearTime, by_stretch_s),
                    (Observable::TearForce, mean_n(by_stretch_s)),
                    (Observable::ToughnessTime, by_toughness_s),
                    (Observable::ToughnessForce, mean_n(by_toughness_s)),
                ]
            }
        };
        for (observable, number) in numbers {
            self.record(observable, vec![number]);
        }
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
        let now_s = system.elapsed_s();
        let mut most = 0.0_f64;
        let thresholds = self.thresholds.iter_mut();
        for first in thresholds.filter(|first| first.torn_s.is_nan()) {
            let stretches = system.stretches();
            let loads = stretches.iter().map(|id| first.threshold.load(system, id));
            let worst = loads.fold(0.0, |worst, load| load.unwrap_or(0.0).max(worst));
            if worst >= 1.0 {
                let [before_s, before] = first.last;
                let fraction = (1.0 - before) / (worst - before);
                first.torn_s = before_s + fraction * (now_s - before_s);
            }
            first.last = [now_s, worst];
            most = most.max(worst);
        }
        if most < 0.9 {
            self.check_s = now_s + self.case.scene.until.seconds() / 1000.0;
        }
    }
}

/// The energy in springs: none in rigid ones. The lengths that the sweeps of XPBD leave belong to no force, so for
/// it that of its forces.
fn stored_j(system: &System, family: Option<Family>) -> f64 {
    let stretches = system.stretches();
    match family {
        Some(Family::Pbd) => 0.0,
        Some(Family::Xpbd) => {
            let each = stretches.iter().map(|id| {
                let force_n = force::force_n(system, id);
                force_n * force_n / (2.0 * stretches.get(id).stiffness_n_per_m)
            });
            each.sum()
        }
        _ => energy::elastic_j(system),
    }
}

fn height_j(system: &System) -> f64 {
    let gravity = system.loads().gravity_m_per_s2.unwrap_or_default();
    let particles = system.positions().iter().zip(system.masses());
    let each = particles.map(|(x, m)| m * gravity.dot(&x.coords));
    -each.sum::<f64>()
}

/// A force over time, linear between samples.
#[derive(Clone, Debug, Default)]
struct Samples {
    /// Seconds, newtons, and the integral until then.
    list: Vec<[f64; 3]>,
}

impl Samples {
    fn push(&mut self, s: f64, n: f64) {
        let [before_s, before_n, sum] = self.last();
        let sum = sum + 0.5 * (before_n + n) * (s - before_s);
        self.list.push([s, n, sum]);
    }

    fn last(&self) -> [f64; 3] {
        self.list.last().copied().unwrap_or_default()
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
}

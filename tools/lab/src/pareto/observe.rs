//! What is observed of a run, and how far two runs are apart by it.
//!
//! A [`Probe`] notes numbers while a run goes on. They stay as they are, unsubtracted, so that runs
//! can be extrapolated to Δt → 0 before they are compared. An [`Observable`] is a distance of two
//! such records, as a part of a third.

use tearmesh::geometry::sine_and_cosine;
use tearmesh::{Point, Vector};
use tearmesh_cloth::{System, Threshold, force};

use super::observable::{Observable, RAWS, Raw};
use super::scene::{Case, Held, TEAR_RATIO, TOUGHNESS_J_PER_M, Until};

/// The numbers that a run leaves behind.
#[derive(Clone, Debug, Default)]
pub struct Records {
    /// By [`Raw`]: coordinates and strains by checkpoint; two means; times and forces; rate and
    /// frequency; energy. Empty where nobody asked, NaN where there was no answer.
    raw: [Vec<f64>; RAWS],
    /// The indices of the edges that tore first, by stretch and by toughness; `None` if none did.
    pub torn: [Option<usize>; 2],
}

impl Records {
    /// The coordinates of all particles at each checkpoint, in metres.
    #[must_use]
    pub(crate) fn coordinates_m(&self) -> &[f64] {
        &self.raw[Raw::Positions as usize]
    }

    /// The number of an observable that has one of its own; `None` where there is no answer.
    #[must_use]
    pub(crate) fn number(&self, observable: Observable) -> Option<f64> {
        let (raw, place) = observable.raw();
        let is_vector = raw as usize <= Raw::Forces as usize;
        let numbers = (!is_vector).then_some(&self.raw[raw as usize])?;
        numbers.get(place).copied().filter(|x| x.is_finite())
    }

    /// Returns the linear combination w a + (1 − w) b of the numbers of two runs.
    #[must_use]
    pub fn mixed(weight: f64, a: &Records, b: &Records) -> Records {
        let mix = |i: usize| {
            let pairs = a.raw[i].iter().zip(&b.raw[i]);
            pairs.map(|(a, b)| b + weight * (a - b)).collect()
        };
        Records {
            raw: std::array::from_fn(mix),
            torn: a.torn,
        }
    }

    /// Returns the numbers to which three runs converge, each with half the step of the one before. It uses
    /// the ratio of their differences (Aitken), of vectors as a whole and of scalars one by one. The result
    /// is NaN if the differences do not become smaller, since there is no limit then.
    #[must_use]
    pub fn limit([coarse, middle, fine]: [&Records; 3]) -> Records {
        let of = |i: usize| {
            let [x, y, z] = [coarse, middle, fine].map(|records| &records.raw[i][..]);
            let is_vector = i <= Raw::Forces as usize;
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
            raw: std::array::from_fn(of),
            torn: fine.torn,
        }
    }
}

/// The ratio of differences from which on there is a limit; 2 is order one, 4 is order two.
const RATIO_MIN: f64 = 1.3;

/// How far beyond the finest of three the limit lies, as a multiple of the last difference, NaN for none.
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

/// How far two records are apart by an observable, as a part of a reference; `None` where one of them
/// has no answer.
#[must_use]
pub(super) fn distance(
    case: &Case,
    observable: Observable,
    [a, b]: [&Records; 2],
    reference: &Records,
) -> Option<f64> {
    let (raw, place) = observable.raw();
    let [a, b, of] = [a, b, reference].map(|records| &records.raw[raw as usize][..]);
    if a.is_empty() || a.len() != b.len() || (raw != Raw::Energy && a.len() != of.len()) {
        return None;
    }
    let apart = match raw {
        Raw::Positions => displaced(case, a, b, of),
        Raw::Strains | Raw::Forces => {
            let count = case.edges.len();
            let chunks = a.chunks(count).zip(b.chunks(count)).zip(of.chunks(count));
            let each = chunks.map(|((a, b), of)| strained(observable, a, b, of));
            each.fold(0.0, worse)
        }
        Raw::Energy => (a[place] - b[place]).abs(),
        Raw::Reaction | Raw::Tears | Raw::Mode => (a[place] - b[place]).abs() / of[place].abs(),
    };
    apart.is_finite().then_some(apart)
}

/// How far a record is from the truth: [`distance`], but energy's truth is zero.
#[must_use]
pub(super) fn error(
    case: &Case,
    observable: Observable,
    records: &Records,
    reference: &Records,
) -> Option<f64> {
    if observable.is_energy() {
        let (raw, place) = observable.raw();
        let part = *records.raw[raw as usize].get(place)?;
        return part.is_finite().then_some(part);
    }
    distance(case, observable, [records, reference], reference)
}

/// The larger, and NaN if either is.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

fn displaced(case: &Case, a: &[f64], b: &[f64], of: &[f64]) -> f64 {
    let start: Vec<f64> = flat(&case.start).collect();
    let weighted = |p: &[f64], q: &[f64]| {
        let squares = p.iter().zip(q).map(|(p, q)| (p - q) * (p - q));
        let masses = case.sheet.masses.iter().flat_map(|m| [m; 3]);
        squares.zip(masses).map(|(s, m)| s * m).sum::<f64>().sqrt()
    };
    let count = start.len();
    let chunks = a.chunks(count).zip(b.chunks(count)).zip(of.chunks(count));
    let each = chunks.map(|((a, b), of)| weighted(a, b) / weighted(of, &start));
    each.fold(0.0, worse)
}

/// How far two records are apart by the rms of positions by mass, in metres, the largest of the
/// checkpoints; where edges tear, by the way of the hand until the later of two tears.
#[must_use]
pub(super) fn apart_m(case: &Case, [a, b]: [&Records; 2]) -> f64 {
    if let Held::Pulled(speed) = case.scene.held {
        let [a, b] = [a, b].map(|records| &records.raw[Raw::Tears as usize][..]);
        let late = |i: usize| (a[i] - b[i]).abs() * speed;
        return worse(late(0), late(2));
    }
    let [a, b] = [a, b].map(|records| &records.raw[Raw::Positions as usize][..]);
    let masses = || case.sheet.masses.iter().flat_map(|m| [m; 3]);
    let count = 3 * case.start.len();
    let each = a.chunks(count).zip(b.chunks(count)).map(|(a, b)| {
        let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
        squares.zip(masses()).map(|(s, m)| s * m).sum::<f64>()
    });
    let whole = case.sheet.masses.iter().sum::<f64>();
    (each.fold(0.0, worse) / whole).sqrt()
}

/// From this part of the largest strain on an edge counts as loaded.
const LOADED: f64 = 0.3;

fn strained(observable: Observable, a: &[f64], b: &[f64], of: &[f64]) -> f64 {
    let most = |x: &[f64]| x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let largest = most(of);
    if matches!(
        observable,
        Observable::StrainLargest | Observable::ForceLargest
    ) {
        return (most(a) - most(b)).abs() / largest;
    }
    let each = a.iter().zip(b).zip(of);
    let loaded = each.filter(|(_, of)| **of > LOADED * largest);
    let mut off: Vec<f64> = loaded.map(|((a, b), of)| ((a - b) / of).abs()).collect();
    match observable {
        Observable::Strain99 | Observable::Force99 => {
            off.sort_by(f64::total_cmp);
            off[(off.len() - 1) * 99 / 100]
        }
        _ => (off.iter().map(|x| x * x).sum::<f64>() / off.len() as f64).sqrt(),
    }
}

fn flat(points: &[Point]) -> impl Iterator<Item = f64> + '_ {
    points.iter().flat_map(|p| [p.x, p.y, p.z])
}

/// The seconds of a mean of forces.
const MEAN_S: f64 = 1.0 / 60.0;

/// Notes what is asked of a run.
#[derive(Debug)]
pub(super) struct Probe<'a> {
    case: &'a Case,
    records: Records,
    elapsed_s: f64,
    /// Who is held, and counts.
    held: Vec<usize>,
    /// Samples of their force.
    reaction: Samples,
    /// The time between two samples, in seconds; none where nobody asks.
    reaction_every_s: Option<f64>,
    /// The work of the hand that pulls, in joules.
    hand_j: f64,
    /// Whether the force at the end of a step has done its work, rather than the mean of two.
    moves_at_end: bool,
    tears: [Watched; 2],
    /// When edges are looked at next, in seconds.
    look_s: f64,
    /// What the slowest mode is read by, and its last amplitude and velocity.
    weights: Vec<f64>,
    mode: [f64; 2],
    /// Where it turned round: seconds and amplitude.
    turns: Vec<[f64; 2]>,
}

/// A threshold that is watched: what the edges' largest load was, and when.
#[derive(Clone, Copy, Debug)]
struct Watched {
    threshold: Threshold,
    last: [f64; 2],
    torn_s: Option<f64>,
}

impl<'a> Probe<'a> {
    /// A probe of a system that has not moved yet, and of a method that moves particles by the forces
    /// at the end of its steps or not.
    #[must_use]
    pub(super) fn new(case: &'a Case, system: &System, moves_at_end: bool) -> Probe<'a> {
        let asks = |raw: Raw| {
            let mut all = case.scene.observables.iter();
            all.any(|observable| observable.raw().0 == raw)
        };
        let is_pulled = matches!(case.scene.held, Held::Pulled(_));
        let points = &case.sheet.points;
        let counts = |i: &usize| case.is_held(&points[*i]) && !(is_pulled && points[*i].y == 0.0);
        let is_rest = matches!(case.scene.until, Until::Rest(_));
        let weights = if asks(Raw::Mode) {
            let side = case.scene.side_m;
            let sine = |x: f64| sine_and_cosine(std::f64::consts::PI * x / side).0;
            let each = points.iter().zip(system.masses());
            each.map(|(p, m)| m * sine(p.x) * sine(p.y)).collect()
        } else {
            Vec::new()
        };
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
            reaction_every_s: match asks(Raw::Reaction) && !is_rest {
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
            look_s: 0.0,
            mode: mode(&weights, system),
            weights,
            turns: Vec::new(),
        };
        if probe.reaction_every_s.is_some() {
            probe.reaction.push(0.0, probe.reaction_n(system));
        }
        if !probe.weights.is_empty() {
            probe.turns.push([0.0, probe.mode[0]]);
        }
        probe
    }

    /// A step of so many seconds was taken.
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
        if matches!(self.case.scene.until, Until::Tears(_)) && self.elapsed_s >= self.look_s {
            self.look(system);
        }
        if !self.weights.is_empty() {
            self.turn(system, dt_s);
        }
    }

    /// Notes positions and strains.
    pub(super) fn checkpoint(&mut self, system: &System) {
        let asks = |raw: Raw| {
            let mut all = self.case.scene.observables.iter();
            all.any(|observable| observable.raw().0 == raw)
        };
        let raw = &mut self.records.raw;
        if asks(Raw::Positions) {
            raw[Raw::Positions as usize].extend(flat(system.positions()));
        }
        let stretches = system.stretches();
        for (kind, by_force) in [(Raw::Strains, false), (Raw::Forces, true)] {
            if !asks(kind) {
                continue;
            }
            let strains = &mut raw[kind as usize];
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

    /// Notes the energy that was made so far, as a part of what was put in.
    pub(super) fn energy(&mut self, made: f64) {
        let energy = &mut self.records.raw[Raw::Energy as usize];
        energy.resize(2, 0.0);
        energy[0] = worse(energy[0], made);
        energy[1] = worse(energy[1], -made);
    }

    /// The work of the hand that pulls so far, in joules.
    #[must_use]
    pub(super) fn hand_j(&self) -> f64 {
        self.hand_j
    }

    /// Whether both thresholds were reached.
    #[must_use]
    pub(super) fn has_torn(&self) -> bool {
        self.tears.iter().all(|watched| watched.torn_s.is_some())
    }

    /// What was noted.
    #[must_use]
    pub(super) fn records(mut self, system: &System) -> Records {
        let reaction = match self.case.scene.until {
            Until::Rest(_) => [self.reaction_n(system); 2].to_vec(),
            Until::Time(seconds) if self.reaction_every_s.is_some() => {
                let ends_s = (1..=(seconds / MEAN_S + 1e-9) as u64).map(|i| i as f64 * MEAN_S);
                let means = ends_s.map(|end_s| self.reaction.mean(end_s - MEAN_S, end_s));
                let largest = means.fold(f64::NEG_INFINITY, f64::max);
                vec![self.reaction.mean(0.0, seconds), largest]
            }
            _ => Vec::new(),
        };
        let tears = self.tears.iter().flat_map(|watched| {
            let torn_s = watched.torn_s.unwrap_or(f64::NAN);
            [torn_s, self.reaction.mean(torn_s - MEAN_S, torn_s)]
        });
        if matches!(self.case.scene.until, Until::Tears(_)) {
            self.records.raw[Raw::Tears as usize] = tears.collect();
        }
        self.records.raw[Raw::Reaction as usize] = reaction;
        if !self.weights.is_empty() {
            self.records.raw[Raw::Mode as usize] = ringing(&self.turns).to_vec();
        }
        self.records
    }

    /// What holds: the sum of the sizes of all forces; of a frame, whose sides pull at each other, the
    /// size of their sum; of the strip, what the hand pulls with.
    fn reaction_n(&self, system: &System) -> f64 {
        let forces = self.held.iter().map(|&i| force::reaction_n(system, i));
        match self.case.scene.held {
            Held::Pulled(_) => forces.map(|force| force.y).sum(),
            Held::Frame => forces.sum::<Vector>().norm(),
            _ => forces.map(|force| force.norm()).sum(),
        }
    }

    /// Looks at all edges, and again after a thousandth of the scene's time, or at once where one has
    /// nine tenths of its threshold.
    fn look(&mut self, system: &System) {
        let now_s = self.elapsed_s;
        let mut most = 0.0_f64;
        for (watched, torn) in self.tears.iter_mut().zip(&mut self.records.torn) {
            if watched.torn_s.is_some() {
                continue;
            }
            let (mut worst, mut edge) = (0.0, 0);
            for id in system.stretches().iter() {
                let load = watched.threshold.load(system, id).unwrap_or(0.0);
                if load > worst {
                    (worst, edge) = (load, id.index());
                }
            }
            if worst >= 1.0 {
                let [before_s, before] = watched.last;
                let part = (1.0 - before) / (worst - before);
                watched.torn_s = Some(before_s + part * (now_s - before_s));
                *torn = Some(edge);
            }
            watched.last = [now_s, worst];
            most = most.max(worst);
        }
        self.look_s = if most < 0.9 {
            now_s + self.case.scene.until.seconds() / 1000.0
        } else {
            0.0
        };
    }

    /// Notes where the slowest mode turns round: its velocity is taken to be straight between steps, and
    /// starts at zero.
    fn turn(&mut self, system: &System, dt_s: f64) {
        let [q, v] = self.mode;
        self.mode = mode(&self.weights, system);
        let next = self.mode[1];
        if v * next < 0.0 {
            let part = v / (v - next);
            let at_s = self.elapsed_s - dt_s + part * dt_s;
            self.turns.push([at_s, q + 0.5 * v * part * dt_s]);
        }
    }
}

/// The amplitude of the slowest mode and its velocity.
fn mode(weights: &[f64], system: &System) -> [f64; 2] {
    let sum = |of: &mut dyn Iterator<Item = f64>| of.zip(weights).map(|(z, w)| z * w).sum::<f64>();
    [
        sum(&mut system.positions().iter().map(|x| x.z)),
        sum(&mut system.velocities().iter().map(|v| v.z)),
    ]
}

/// The rate in 1/s and the frequency in rad/s of what turns round at these seconds and places: half a
/// period apart, and the ways in between become shorter by the rate. NaN from fewer than four.
fn ringing(turns: &[[f64; 2]]) -> [f64; 2] {
    let count = turns.len();
    if count < 4 {
        return [f64::NAN; 2];
    }
    let took_s = turns[count - 1][0] - turns[0][0];
    let frequency = std::f64::consts::PI * (count - 1) as f64 / took_s;
    let ways: Vec<[f64; 2]> = turns
        .windows(2)
        .map(|pair| {
            let [[s, q], [t, p]] = [pair[0], pair[1]];
            [0.5 * (s + t), (p - q).abs().ln()]
        })
        .collect();
    let mean = |i: usize| ways.iter().map(|way| way[i]).sum::<f64>() / ways.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let (mut above, mut below) = (0.0, 0.0);
    for [s, way] in &ways {
        above += (s - x) * (way - y);
        below += (s - x) * (s - x);
    }
    [-above / below, frequency]
}

/// A force over time, straight between samples.
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
    fn a_mean_of_samples_is_that_of_the_straight_lines_between_them() {
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
    fn the_rate_and_the_frequency_of_a_ringing_are_those_that_it_was_made_with() {
        // q = e^(−3t) cos 40t about 7: it turns round every π/40 s.
        let turns: Vec<[f64; 2]> = (0..12)
            .map(|i| {
                let s = f64::from(i) * std::f64::consts::PI / 40.0;
                let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
                [s, 7.0 + sign * (-3.0 * s).exp()]
            })
            .collect();
        let [rate, frequency] = ringing(&turns);
        assert!((rate - 3.0).abs() < 1e-12 && (frequency - 40.0).abs() < 1e-12);
        assert!(ringing(&turns[..3])[0].is_nan());
    }

    #[test]
    fn the_limit_of_halved_steps_is_found_for_any_order_and_none_where_there_is_none() {
        let at = |x: f64| {
            let mut records = Records::default();
            records.raw[Raw::Positions as usize] = vec![1.0 + x, 2.0 - 3.0 * x];
            records.raw[Raw::Mode as usize] = vec![5.0 + x];
            records
        };
        for order in [2.0, 4.0, 16.0] {
            let runs = [1.0, 1.0 / order, 1.0 / (order * order)].map(at);
            let limit = Records::limit(runs.each_ref());
            let [x, y] = limit.raw[Raw::Positions as usize][..] else {
                panic!("two numbers");
            };
            assert!(
                (x - 1.0).abs() < 1e-14 && (y - 2.0).abs() < 1e-14,
                "{order}"
            );
            assert!((limit.raw[Raw::Mode as usize][0] - 5.0).abs() < 1e-14);
        }
        let runs = [1.0, 2.0, 4.0].map(at);
        let limit = Records::limit(runs.each_ref());
        assert!(limit.raw[Raw::Positions as usize][0].is_nan());
    }
}

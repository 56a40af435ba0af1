//! Which stretch constraints are strained beyond a bound, and how far the most strained one is.
//!
//! Who computes all lengths at the end of a step looks out on the way, for forces or for energy: nearly
//! all constraints are below one number, and a comparison with it tells that. Only what is above is
//! looked at, and may raise the number. Where nobody did, or something has changed since, a pass of
//! lengths finds the same ([`Lookout::look`]); where a method left strains behind in constraints, as
//! forces or before a limiter, a pass that fetches no particle ([`Lookout::look_at_multipliers`],
//! [`Lookout::look_at_ratios`]).

use tearmesh::geometry::{Point, dot};

use crate::constraint::{ConstraintId, Constraints, TOGETHER};
use crate::moment::State;

/// What is looked out for, and what was found the last time.
#[derive(Clone, Debug)]
pub(crate) struct Lookout {
    /// From this part of its rest length on a constraint is noted; infinite where nobody asks.
    from: f64,
    /// Whether anybody asks for the most strained one.
    asks_most: bool,
    /// What is looked at next.
    sight: Option<Sight>,
    most: f64,
    /// Which one that was; it often is the next time.
    longest: Option<ConstraintId>,
    /// What the most strained one was looked for in.
    most_in: Option<Sight>,
    found: Vec<ConstraintId>,
    /// What they were looked for in, and from which part of their rest length on.
    found_in: Option<(Sight, f64)>,
}

/// What a look is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sight {
    pub(crate) strains: Strains,
    pub(crate) state: State,
}

/// Where strains are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Strains {
    /// In lengths.
    Lengths,
    /// In lengths as they were before a limiter.
    Ratios,
    /// In what the forces of a method would stretch springs to. Of these, nobody asks for the largest.
    Multipliers,
}

impl Default for Lookout {
    fn default() -> Lookout {
        Lookout {
            from: f64::INFINITY,
            asks_most: false,
            sight: None,
            most: 0.0,
            longest: None,
            most_in: None,
            found: Vec::new(),
            found_in: None,
        }
    }
}

impl Lookout {
    /// Looks out for constraints that are this many times as long as at rest from now on.
    pub(crate) fn ask(&mut self, from: f64) {
        self.from = from;
    }

    /// Looks out for the most strained constraint from now on.
    pub(crate) fn ask_most(&mut self) {
        self.asks_most = true;
    }

    /// All that are as long as this, and maybe some more; `None` where that is not known.
    pub(crate) fn found(&self, sight: Sight, from: f64) -> Option<&[ConstraintId]> {
        let (of, seen_from) = self.found_in?;
        (of == sight && seen_from <= from).then_some(&self.found)
    }

    /// The largest length as a multiple of that at rest, 0 without constraints; `None` where it is
    /// not known.
    pub(crate) fn most(&self, sight: Sight) -> Option<f64> {
        (self.most_in == Some(sight)).then_some(self.most)
    }

    /// Says what is looked at next.
    pub(crate) fn turn_to(&mut self, strains: Strains, state: State) {
        self.sight = Some(Sight { strains, state });
    }

    /// Something but a step has moved the particles.
    pub(crate) fn forget(&mut self) {
        (self.most_in, self.found_in) = (None, None);
    }

    /// Begins to look. Returns the ratio of length to rest length up to which a constraint need not
    /// be noted.
    pub(crate) fn begin(&mut self) -> f64 {
        self.found.clear();
        self.found_in = self.sight.map(|sight| (sight, self.from));
        if self.seeks_most() {
            self.most = 0.0;
            self.most_in = self.sight;
        }
        self.bar()
    }

    /// Begins to look at lengths: first at the one that was the most strained the last time, so that few
    /// are longer than the longest so far.
    pub(crate) fn begin_at(&mut self, constraints: &Constraints, x: &[Point]) -> f64 {
        let bar = self.begin();
        let longest = self.longest.filter(|_| self.seeks_most());
        let Some(constraint) = longest.and_then(|id| constraints.find(id)) else {
            return bar;
        };
        let [a, b] = constraint.ends;
        let d = x[b] - x[a];
        let ratio = dot(d, d).sqrt() / constraint.rest_length_m;
        if ratio > self.most {
            self.most = ratio;
        }
        self.bar()
    }

    /// Notes a constraint that is longer than was asked for; the same is asked of the next.
    #[cold]
    pub(crate) fn note(&mut self, id: u32, ratio: f64) -> f64 {
        if self.seeks_most() && ratio > self.most {
            self.most = ratio;
            self.longest = Some(ConstraintId(id));
        }
        // What is not a number is for the one who asked to judge.
        if ratio >= self.from || ratio.is_nan() {
            self.found.push(ConstraintId(id));
        }
        self.bar()
    }

    fn seeks_most(&self) -> bool {
        let is_of_lengths = |sight: Sight| sight.strains != Strains::Multipliers;
        self.asks_most && self.sight.is_some_and(is_of_lengths)
    }

    fn bar(&self) -> f64 {
        let most = if self.seeks_most() {
            self.most
        } else {
            f64::INFINITY
        };
        // A comparison of a product with the rest length rounds; what is noted is looked at again.
        self.from.min(most) * (1.0 - 4.0 * f64::EPSILON)
    }

    /// Looks at all lengths.
    pub(crate) fn look(&mut self, constraints: &Constraints, x: &[Point]) {
        let bar = self.begin_at(constraints, x);
        let mut square = bar * bar;
        for batch in constraints.batches() {
            for ((&[a, b], &rest), &id) in batch.ends.iter().zip(batch.rest).zip(batch.ids) {
                let d = x[b as usize] - x[a as usize];
                let length_square = dot(d, d);
                let is_short = length_square <= square * (rest * rest);
                if !is_short {
                    let bar = self.note(id, length_square.sqrt() / rest);
                    square = bar * bar;
                }
            }
        }
    }

    /// Looks at what the forces of a method would stretch each constraint to, by multipliers alone.
    pub(crate) fn look_at_multipliers(&mut self, constraints: &Constraints) {
        let mut bar = self.begin() - 1.0;
        // Multipliers are minus forces: so much shorter they would make each.
        let is_short = |[rest, compliance, multiplier]: [f64; 3], bar: f64| {
            multiplier * compliance >= -bar * rest
        };
        let mut judge = |bar: f64, numbers: [f64; 3], id: u32| {
            let [rest, compliance, multiplier] = numbers;
            if is_short(numbers, bar) {
                bar
            } else {
                self.note(id, 1.0 - multiplier * compliance / rest) - 1.0
            }
        };
        for (batch, memories) in constraints.batches_remembered() {
            let (ids, last_ids) = batch.ids.as_chunks::<TOGETHER>();
            let (rest, last_rest) = batch.rest.as_chunks::<TOGETHER>();
            let (compliance, last_compliance) = batch.compliance.as_chunks::<TOGETHER>();
            let (multipliers, last) = memories.multipliers.as_chunks::<TOGETHER>();
            let chunks = rest.iter().zip(compliance).zip(multipliers).zip(ids);
            for (((rest, compliance), multipliers), ids) in chunks {
                // Without a branch for each, a processor compares two at a time.
                let mut longer = 0;
                for i in 0..TOGETHER {
                    let numbers = [rest[i], compliance[i], multipliers[i]];
                    longer |= u64::from(!is_short(numbers, bar));
                }
                if longer != 0 {
                    for i in 0..TOGETHER {
                        bar = judge(bar, [rest[i], compliance[i], multipliers[i]], ids[i]);
                    }
                }
            }
            let numbers = last_rest.iter().zip(last_compliance).zip(last);
            for (((&rest, &compliance), &multiplier), &id) in numbers.zip(last_ids) {
                bar = judge(bar, [rest, compliance, multiplier], id);
            }
        }
    }

    /// Looks at what each constraint was stretched to before a limiter shortened it.
    pub(crate) fn look_at_ratios(&mut self, constraints: &Constraints) {
        let mut bar = self.begin();
        for (batch, memories) in constraints.batches_remembered() {
            for (&ratio, &id) in memories.ratios.iter().zip(batch.ids) {
                let is_short = ratio <= bar;
                if !is_short {
                    bar = self.note(id, ratio);
                }
            }
        }
    }
}

//! Which stretch constraints are strained beyond a bound, and how far the most strained one is.
//!
//! Who computes all lengths at the end of a step looks out on the way: nearly all constraints are
//! below one number, and a comparison with it tells that. Only what is above is looked at, and may
//! raise the number. Where nobody did, or something has changed since, a pass of lengths finds the
//! same ([`Lookout::look`]); where a method left strains behind in constraints, as forces or before a
//! limiter, a pass that fetches no particle ([`Lookout::look_at_multipliers`],
//! [`Lookout::look_at_ratios`]).

use tearmesh::geometry::{Point, dot};

use crate::constraint::{ConstraintId, Constraints};

/// What is looked out for, and what was found the last time.
#[derive(Clone, Debug)]
pub(crate) struct Lookout {
    /// From this part of its rest length on a constraint is noted; infinite where nobody asks.
    from: f64,
    /// Whether anybody asks for the most strained one.
    asks_most: bool,
    /// What the constraints below were looked for by; infinite where none was.
    seen_from: f64,
    has_most: bool,
    most: f64,
    found: Vec<ConstraintId>,
}

impl Default for Lookout {
    fn default() -> Lookout {
        Lookout {
            from: f64::INFINITY,
            asks_most: false,
            seen_from: f64::INFINITY,
            has_most: false,
            most: 0.0,
            found: Vec::new(),
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
    pub(crate) fn found(&self, from: f64) -> Option<&[ConstraintId]> {
        (self.seen_from <= from).then_some(&self.found)
    }

    /// The largest length as a multiple of that at rest, 0 without constraints; `None` where it is
    /// not known.
    pub(crate) fn most(&self) -> Option<f64> {
        self.has_most.then_some(self.most)
    }

    /// Begins to look. What is not longer than so many times its rest length need not be noted.
    pub(crate) fn begin(&mut self) -> f64 {
        self.found.clear();
        self.most = 0.0;
        self.seen_from = self.from;
        self.has_most = self.asks_most;
        self.bar()
    }

    /// Notes a constraint that is longer than was asked for; the same is asked of the next.
    #[cold]
    pub(crate) fn note(&mut self, id: u32, ratio: f64) -> f64 {
        if ratio > self.most {
            self.most = ratio;
        }
        // What is not a number is for the one who asked to judge.
        if ratio >= self.from || ratio.is_nan() {
            self.found.push(ConstraintId(id));
        }
        self.bar()
    }

    fn bar(&self) -> f64 {
        let most = if self.asks_most {
            self.most
        } else {
            f64::INFINITY
        };
        // A comparison of a product with the rest length rounds; what is noted is looked at again.
        self.from.min(most) * (1.0 - 4.0 * f64::EPSILON)
    }

    /// Looks at all lengths.
    pub(crate) fn look(&mut self, constraints: &Constraints, x: &[Point]) {
        let bar = self.begin();
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
        for (batch, memories) in constraints.batches_remembered() {
            let numbers = batch.rest.iter().zip(batch.compliance);
            for (((&rest, &compliance), &multiplier), &id) in
                numbers.zip(memories.multipliers).zip(batch.ids)
            {
                let extension = -multiplier * compliance;
                let is_short = extension <= bar * rest;
                if !is_short {
                    bar = self.note(id, 1.0 + extension / rest) - 1.0;
                }
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

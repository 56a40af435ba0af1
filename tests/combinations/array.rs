//! Covering arrays of named levels: rows of levels, one of each factor, such that every combination of as
//! many levels as asked stands together in some row.
//!
//! The rows are found greedily, in the manner of AETG (Cohen, Dalal, Fredman, Patton 1997): of a few
//! candidates the one with most combinations that are new. Each begins with a combination that no row
//! has yet and takes the other factors in any order, of each the level that adds most among those that a
//! complete search can go on from. That search also finds the combinations that no row can have, with the
//! exclusions that forbid them. The least number of rows is not sought: AETG comes within a fifth of it or so.

use crate::random::Random;

/// How many candidates a row is chosen from.
const CANDIDATES: usize = 3;

/// What can be chosen: its name, and the names of its levels.
pub(crate) type Factor = (&'static str, &'static [&'static str]);

/// Levels that do not go together, and why. Of each factor, its levels with spaces between them, or all but
/// these if the first begins with `!`; a row that has one of them of each of these factors is none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exclusion {
    pub(crate) levels: &'static [(&'static str, &'static str)],
    pub(crate) reason: &'static str,
}

/// A level of each factor, by its number.
pub(crate) type Row = Vec<usize>;

/// Some factors with a level of each, ascending: (factor, level).
pub(crate) type Combination = Vec<(usize, usize)>;

/// Factors, and what of them does not go together.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    factors: Vec<Factor>,
    exclusions: Vec<Rule>,
}

/// An exclusion by numbers: of each factor that it names, whether each level is meant.
#[derive(Clone, Debug)]
struct Rule {
    levels: Vec<(usize, Vec<bool>)>,
    reason: &'static str,
}

/// Rows that have all combinations of so many levels that a row can have.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cover {
    pub(crate) rows: Vec<Row>,
    /// How many different combinations the rows have.
    pub(crate) visited: usize,
    /// The combinations that no row can have, each with the reasons.
    pub(crate) impossible: Vec<(Combination, Vec<&'static str>)>,
}

impl Table {
    /// # Panics
    ///
    /// Panics if a factor has no levels, two names are the same, or an exclusion names what is not there.
    pub(crate) fn new(factors: &[Factor], exclusions: &[Exclusion]) -> Table {
        for (i, (name, levels)) in factors.iter().enumerate() {
            let is_new = |(i, level)| !levels[..i].contains(level) && !level.contains(' ');
            assert!(levels.iter().enumerate().all(is_new), "{name}: {levels:?}");
            assert!(!levels.is_empty(), "{name} has no level");
            assert!(
                factors[..i].iter().all(|other| other.0 != *name),
                "{name} is there twice"
            );
        }
        let mut table = Table {
            factors: factors.to_vec(),
            exclusions: Vec::new(),
        };
        let rules = exclusions.iter().map(|one| table.rule(one)).collect();
        table.exclusions = rules;
        table
    }

    fn rule(&self, exclusion: &Exclusion) -> Rule {
        let levels = exclusion.levels.iter().map(|(name, levels)| {
            let factor = self.factor(name);
            let (levels, negated) = match levels.strip_prefix('!') {
                Some(rest) => (rest, true),
                None => (*levels, false),
            };
            let mut meant = vec![negated; self.factors[factor].1.len()];
            for level in levels.split(' ') {
                meant[self.number(factor, level)] = !negated;
            }
            (factor, meant)
        });
        Rule {
            levels: levels.collect(),
            reason: exclusion.reason,
        }
    }

    /// The number of a factor.
    fn factor(&self, name: &str) -> usize {
        let found = self.factors.iter().position(|factor| factor.0 == name);
        found.unwrap_or_else(|| panic!("no factor is called {name}"))
    }

    /// The number of a level of a factor.
    fn number(&self, factor: usize, level: &str) -> usize {
        let (name, levels) = self.factors[factor];
        let found = levels.iter().position(|one| *one == level);
        found.unwrap_or_else(|| panic!("no level of {name} is called {level}"))
    }

    /// The level of a factor in a row.
    pub(crate) fn level(&self, row: &[usize], factor: &str) -> &'static str {
        let factor = self.factor(factor);
        self.factors[factor].1[row[factor]]
    }

    /// The levels of a row or of a combination, as `factor=level` with spaces between.
    pub(crate) fn words(&self, levels: impl IntoIterator<Item = (usize, usize)>) -> String {
        let words = levels.into_iter().map(|(factor, level)| {
            let (name, levels) = self.factors[factor];
            format!("{name}={}", levels[level])
        });
        words.collect::<Vec<_>>().join(" ")
    }

    /// Rows that have every combination of `strength` levels that a row can have; the same for the same
    /// random numbers.
    pub(crate) fn rows(&self, strength: usize, random: &mut Random) -> Cover {
        let mut search = Search::new(self, strength);
        let mut impossible = Vec::new();
        let mut open = Vec::new();
        for combination in search.combinations() {
            let mut chosen = self.unchosen();
            for &(factor, level) in &combination {
                chosen[factor] = Some(level);
            }
            let all = vec![true; self.exclusions.len()];
            match self.is_possible(&mut chosen, &all) {
                true => open.push(combination),
                false => {
                    search.cover(&combination);
                    impossible.push((combination.clone(), self.reasons(&combination)));
                }
            }
        }
        let visited = open.len();
        let mut rows = Vec::new();
        random.shuffle(&mut open);
        while let Some(start) = open.pop() {
            if !search.is_open(&start) {
                continue;
            }
            let candidates = (0..CANDIDATES).map(|_| search.candidate(&start, random));
            // The first of the best, so that the order decides.
            let best = candidates.reduce(|best, next| if next.0 > best.0 { next } else { best });
            let (_, row) = best.expect("there are candidates");
            search.cover_row(&row);
            rows.push(row);
        }
        Cover {
            rows,
            visited,
            impossible,
        }
    }

    fn unchosen(&self) -> Vec<Option<usize>> {
        vec![None; self.factors.len()]
    }

    /// Whether none of the exclusions that count forbids what is chosen so far, even if all else is free.
    fn is_allowed(&self, chosen: &[Option<usize>], counts: &[bool]) -> bool {
        for (rule, &counts) in self.exclusions.iter().zip(counts) {
            let mut levels = rule.levels.iter();
            let is_met = |(factor, meant): &(usize, Vec<bool>)| {
                chosen[*factor].is_some_and(|level| meant[level])
            };
            if counts && levels.all(is_met) {
                return false;
            }
        }
        true
    }

    /// Whether the other factors have levels that go with those chosen: a complete search.
    fn is_possible(&self, chosen: &mut Vec<Option<usize>>, counts: &[bool]) -> bool {
        if !self.is_allowed(chosen, counts) {
            return false;
        }
        // What no exclusion names is free.
        let rules = self.exclusions.iter().zip(counts);
        let mut named = rules
            .filter(|&(_, &counts)| counts)
            .flat_map(|(rule, _)| &rule.levels);
        let Some(&(factor, _)) = named.find(|(factor, _)| chosen[*factor].is_none()) else {
            return true;
        };
        for level in 0..self.factors[factor].1.len() {
            chosen[factor] = Some(level);
            if self.is_possible(chosen, counts) {
                chosen[factor] = None;
                return true;
            }
        }
        chosen[factor] = None;
        false
    }

    /// The reasons why no row has a combination: without any one of these, some row would.
    fn reasons(&self, combination: &[(usize, usize)]) -> Vec<&'static str> {
        let mut chosen = self.unchosen();
        for &(factor, level) in combination {
            chosen[factor] = Some(level);
        }
        let mut needed = vec![true; self.exclusions.len()];
        for i in 0..needed.len() {
            needed[i] = false;
            needed[i] = self.is_possible(&mut chosen, &needed);
        }
        let rules = self.exclusions.iter().zip(needed);
        let reasons = rules.filter_map(|(rule, needed)| needed.then_some(rule.reason));
        reasons.collect()
    }
}

/// Which combinations no row has yet.
struct Search<'t> {
    table: &'t Table,
    /// The sets of factors of which all combinations are to be had.
    sets: Vec<Vec<usize>>,
    /// For each factor the sets that it is in.
    sets_of: Vec<Vec<usize>>,
    /// For each set its first place in `open`.
    places: Vec<usize>,
    /// For each factor of each set, how far a level is from the next in `open`.
    strides: Vec<Vec<usize>>,
    open: Vec<bool>,
}

impl<'t> Search<'t> {
    fn new(table: &'t Table, strength: usize) -> Search<'t> {
        let count = table.factors.len();
        assert!((1..=count).contains(&strength), "no set of {strength}");
        let sets = subsets(count, strength);
        let (mut places, mut strides, mut end) = (Vec::new(), Vec::new(), 0);
        for set in &sets {
            places.push(end);
            let mut size = 1;
            let of_set = set.iter().map(|&factor| {
                size *= table.factors[factor].1.len();
                size / table.factors[factor].1.len()
            });
            strides.push(of_set.collect());
            end += size;
        }
        let with = |factor: usize| {
            let numbers = 0..sets.len();
            numbers.filter(|&set| sets[set].contains(&factor)).collect()
        };
        Search {
            table,
            sets_of: (0..count).map(with).collect(),
            places,
            strides,
            open: vec![true; end],
            sets,
        }
    }

    /// All combinations, set by set.
    fn combinations(&self) -> Vec<Combination> {
        let mut all = Vec::new();
        for set in &self.sets {
            let mut of_set: Vec<Combination> = vec![Vec::new()];
            for &factor in set {
                let levels = 0..self.table.factors[factor].1.len();
                let longer = of_set.iter().flat_map(|one| {
                    let with = move |level| [&one[..], &[(factor, level)]].concat();
                    levels.clone().map(with)
                });
                of_set = longer.collect();
            }
            all.extend(of_set);
        }
        all
    }

    /// The place of a combination in `open`: that of a set, and of a level of each of its factors.
    fn place(&self, set: usize, level: impl Fn(usize) -> usize) -> usize {
        let mut place = self.places[set];
        for (&factor, &stride) in self.sets[set].iter().zip(&self.strides[set]) {
            place += stride * level(factor);
        }
        place
    }

    fn place_of(&self, combination: &[(usize, usize)]) -> usize {
        let factors = combination.iter().map(|&(factor, _)| factor);
        let set = self.sets.binary_search(&factors.collect());
        let level = |factor| {
            let mut levels = combination.iter();
            let found = levels.find(|&&(one, _)| one == factor);
            found.expect("it is of this set").1
        };
        self.place(set.expect("a set"), level)
    }

    fn is_open(&self, combination: &[(usize, usize)]) -> bool {
        self.open[self.place_of(combination)]
    }

    fn cover(&mut self, combination: &[(usize, usize)]) {
        let place = self.place_of(combination);
        self.open[place] = false;
    }

    fn cover_row(&mut self, row: &[usize]) {
        for set in 0..self.sets.len() {
            let place = self.place(set, |factor| row[factor]);
            self.open[place] = false;
        }
    }

    /// A row with a combination, and how many new ones it has.
    fn candidate(&self, start: &[(usize, usize)], random: &mut Random) -> (usize, Row) {
        let mut chosen = self.table.unchosen();
        for &(factor, level) in start {
            chosen[factor] = Some(level);
        }
        let free = (0..chosen.len()).filter(|&factor| chosen[factor].is_none());
        let mut free: Vec<usize> = free.collect();
        random.shuffle(&mut free);
        for factor in free {
            self.choose(&mut chosen, factor, random);
        }
        let row: Row = chosen.into_iter().flatten().collect();
        let sets = 0..self.sets.len();
        let new = sets.filter(|&set| self.open[self.place(set, |factor| row[factor])]);
        (new.count(), row)
    }

    /// Chooses the level of a factor that makes most new combinations, of those with which a row can be completed.
    fn choose(&self, chosen: &mut Vec<Option<usize>>, factor: usize, random: &mut Random) {
        let mut levels: Vec<usize> = (0..self.table.factors[factor].1.len()).collect();
        random.shuffle(&mut levels);
        let gains = self.gains(chosen, factor);
        levels.sort_by_key(|&level| std::cmp::Reverse(gains[level]));
        let all = vec![true; self.table.exclusions.len()];
        let fits = levels.into_iter().any(|level| {
            chosen[factor] = Some(level);
            self.table.is_possible(chosen, &all)
        });
        assert!(fits, "a row that is possible is found");
    }

    /// For each level of a factor, how many new combinations it makes with what is chosen.
    fn gains(&self, chosen: &[Option<usize>], factor: usize) -> Vec<usize> {
        let mut gains = vec![0; self.table.factors[factor].1.len()];
        'sets: for &set in &self.sets_of[factor] {
            let (mut place, mut step) = (self.places[set], 0);
            for (&other, &stride) in self.sets[set].iter().zip(&self.strides[set]) {
                match chosen[other] {
                    Some(level) => place += stride * level,
                    None if other == factor => step = stride,
                    None => continue 'sets,
                }
            }
            for gain in &mut gains {
                *gain += usize::from(self.open[place]);
                place += step;
            }
        }
        gains
    }
}

/// The sets of `size` numbers below `count`, each ascending, in order.
fn subsets(count: usize, size: usize) -> Vec<Vec<usize>> {
    let mut sets = vec![Vec::new()];
    for _ in 0..size {
        let longer = sets.iter().flat_map(|set: &Vec<usize>| {
            let next = set.last().map_or(0, |last| last + 1);
            (next..count).map(move |one| [&set[..], &[one]].concat())
        });
        sets = longer.collect();
    }
    sets
}

//! Covering arrays of small tables against a naive count: all rows there are, written down one by one.

use std::collections::BTreeSet;

use crate::array::{Combination, Cover, Exclusion, Factor, Row, Table};
use crate::random::Random;

/// All rows of factors with so many levels each.
fn all_rows(factors: &[Factor]) -> Vec<Row> {
    let mut rows: Vec<Row> = vec![Vec::new()];
    for (_, levels) in factors {
        let mut longer = Vec::new();
        for row in &rows {
            for level in 0..levels.len() {
                longer.push([&row[..], &[level]].concat());
            }
        }
        rows = longer;
    }
    rows
}

/// Whether an exclusion forbids a row, by the names of its levels.
fn forbids(factors: &[Factor], exclusion: &Exclusion, row: &[usize]) -> bool {
    exclusion.levels.iter().all(|(name, words)| {
        let at = factors.iter().position(|factor| factor.0 == *name);
        let at = at.expect("a factor");
        let level = factors[at].1[row[at]];
        let listed = words.trim_start_matches('!').split(' ');
        listed.into_iter().any(|word| word == level) != words.starts_with('!')
    })
}

/// The combinations of `strength` levels that some rows have.
fn combinations(rows: &[Row], strength: usize) -> BTreeSet<Combination> {
    let mut found = BTreeSet::new();
    for row in rows {
        for mask in 0..1_usize << row.len() {
            if mask.count_ones() as usize == strength {
                let of_mask = (0..row.len()).filter(|i| mask >> i & 1 == 1);
                found.insert(of_mask.map(|i| (i, row[i])).collect());
            }
        }
    }
    found
}

/// A cover is what it says, by the naive count. Gives it.
fn check(factors: &[Factor], exclusions: &[Exclusion], strength: usize, seed: u64) -> Cover {
    let cover = Table::new(factors, exclusions).rows(strength, &mut Random(seed));
    let all = all_rows(factors);
    let is_allowed = |row: &&Row| !exclusions.iter().any(|one| forbids(factors, one, row));
    let allowed: Vec<Row> = all.iter().filter(is_allowed).cloned().collect();
    for row in &cover.rows {
        assert!(allowed.contains(row), "{row:?} is excluded");
    }
    let possible = combinations(&allowed, strength);
    assert_eq!(combinations(&cover.rows, strength), possible);
    assert_eq!(cover.visited, possible.len());
    let impossible = combinations(&all, strength);
    let impossible: BTreeSet<Combination> = impossible.difference(&possible).cloned().collect();
    let found = cover.impossible.iter().map(|(one, _)| one.clone());
    assert_eq!(found.collect::<BTreeSet<_>>(), impossible);
    assert_eq!(cover.impossible.len(), impossible.len());
    for (combination, reasons) in &cover.impossible {
        are_needed(factors, exclusions, &all, combination, reasons);
    }
    cover
}

/// With all exclusions that are given as reasons no row has a combination, and without any one of them some has.
fn are_needed(
    factors: &[Factor],
    exclusions: &[Exclusion],
    all: &[Row],
    combination: &[(usize, usize)],
    reasons: &[&str],
) {
    let some_row = |left_out: Option<&str>| {
        let count =
            |one: &&Exclusion| reasons.contains(&one.reason) && Some(one.reason) != left_out;
        let rules: Vec<&Exclusion> = exclusions.iter().filter(count).collect();
        all.iter().any(|row| {
            combination
                .iter()
                .all(|&(factor, level)| row[factor] == level)
                && !rules.iter().any(|one| forbids(factors, one, row))
        })
    };
    assert!(!some_row(None), "{combination:?}: {reasons:?}");
    for reason in reasons {
        assert!(some_row(Some(reason)), "{combination:?}: {reason}");
    }
}

const TWO: &[&str] = &["no", "yes"];
const SIX: &[&str] = &["a", "b", "c", "d", "e", "f"];
const NAMES: [&str; 6] = ["one", "two", "three", "four", "five", "six"];

#[test]
fn small_tables_are_covered_with_few_rows() {
    let factors = |levels, count| NAMES[..count].iter().map(|&name| (name, levels)).collect();
    let cases: [(&'static [&'static str], usize, usize, usize); 7] = [
        // The best known arrays have 6, 12, 9, 9, 33, 25 and 125 rows.
        (TWO, 5, 2, 9),
        (TWO, 6, 3, 18),
        (&SIX[..3], 3, 2, 13),
        (&SIX[..3], 4, 2, 14),
        (&SIX[..3], 6, 3, 58),
        (&SIX[..5], 3, 2, 34),
        (&SIX[..5], 4, 3, 190),
    ];
    for (levels, count, strength, most) in cases {
        let factors: Vec<Factor> = factors(levels, count);
        for seed in 0..5 {
            let rows = check(&factors, &[], strength, seed).rows.len();
            assert!(rows <= most, "{rows} rows, {levels:?} {count} {strength}");
        }
    }
}

#[test]
fn what_follows_from_exclusions_is_found_with_its_reasons() {
    let factors: [Factor; 4] = [
        ("aim", &["plane", "rays", "pen"]),
        ("rays", &["none", "parallel", "eye"]),
        ("layers", &["all", "first"]),
        ("snap", &["0", "0.1"]),
    ];
    let exclusions = [
        Exclusion {
            levels: &[("aim", "plane"), ("rays", "!none")],
            reason: "a plane has no rays",
        },
        Exclusion {
            levels: &[("aim", "!plane"), ("rays", "none")],
            reason: "all else has rays",
        },
        Exclusion {
            levels: &[("layers", "first"), ("rays", "none")],
            reason: "a ray hits what is first",
        },
    ];
    for strength in 1..=4 {
        check(&factors, &exclusions, strength, 7);
    }
    let table = Table::new(&factors, &exclusions);
    let cover = table.rows(2, &mut Random(7));
    let told = cover.impossible.iter().map(|(levels, reasons)| {
        format!("{}: {}", table.words(levels.clone()), reasons.join("; "))
    });
    let told: Vec<String> = told.collect();
    // Two exclusions together forbid this one.
    let follows = "aim=plane layers=first: a plane has no rays; a ray hits what is first";
    assert!(told.contains(&follows.to_owned()), "{told:#?}");
    assert_eq!(told.len(), 6, "{told:#?}");
    let planes = cover
        .rows
        .iter()
        .filter(|row| table.level(row, "aim") == "plane");
    let mut layers = planes.map(|row| table.level(row, "layers"));
    assert!(layers.all(|layers| layers == "all"));
}

/// Each factor that is switched on needs the next one: by its last, a row can be spoiled for its first.
#[test]
fn exclusions_that_follow_one_from_another_are_seen_early() {
    const NAMES: [&str; 24] = [
        "a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "o", "p", "q", "r",
        "s", "t", "u", "v", "w", "x",
    ];
    let factors = NAMES.map(|name| (name, ["off", "on"].as_slice()));
    let exclusions = NAMES.windows(2).map(|two| Exclusion {
        levels: Vec::leak(vec![(two[0], "on"), (two[1], "off")]),
        reason: "the next one is needed",
    });
    let exclusions: Vec<Exclusion> = exclusions.collect();
    let cover = Table::new(&factors, &exclusions).rows(2, &mut Random(3));
    // Of two factors, three combinations are left: not the first on with the second off.
    assert_eq!(cover.visited, 3 * 24 * 23 / 2);
    for row in &cover.rows {
        assert!(row.is_sorted(), "{row:?}");
    }
}

/// Tables with exclusions of up to three factors by chance; in some of them, no row is left at all.
#[test]
fn tables_by_chance_are_covered() {
    let mut random = Random(1);
    let (mut impossible, mut empty) = (0, 0);
    for seed in 0..300 {
        let count = 3 + random.below(3);
        let factors: Vec<Factor> = NAMES[..count]
            .iter()
            .map(|&name| (name, &SIX[..1 + random.below(4)]))
            .collect();
        let exclusions: Vec<Exclusion> = NAMES[..random.below(6)]
            .iter()
            .map(|&reason| Exclusion {
                levels: by_chance(&factors, &mut random),
                reason,
            })
            .collect();
        let cover = check(&factors, &exclusions, 1 + random.below(3), seed);
        impossible += cover.impossible.len();
        empty += usize::from(cover.rows.is_empty());
    }
    println!("{impossible} combinations that no row can have; {empty} tables without a row");
    assert!(impossible > 1000 && empty > 3);
}

/// Levels of one to three factors. They live as long as the test.
fn by_chance(factors: &[Factor], random: &mut Random) -> &'static [(&'static str, &'static str)] {
    let mut order: Vec<usize> = (0..factors.len()).collect();
    random.shuffle(&mut order);
    let few = &order[..1 + random.below(3)];
    let levels = few.iter().map(|&factor| {
        let (name, levels) = factors[factor];
        let mut words = vec![levels[random.below(levels.len())]];
        words.push(levels[random.below(levels.len())]);
        words.dedup();
        let negation = ["", "!"][random.below(2)];
        let words: &'static str = (negation.to_owned() + &words.join(" ")).leak();
        (name, words)
    });
    levels.collect::<Vec<_>>().leak()
}

#[test]
fn the_same_seed_makes_the_same_rows() {
    let factors: Vec<Factor> = NAMES.iter().map(|&name| (name, SIX)).collect();
    let table = Table::new(&factors[..4], &[]);
    let of = |seed| table.rows(3, &mut Random(seed)).rows;
    assert_eq!(of(5), of(5));
    assert_ne!(of(5), of(6));
}

#[test]
#[should_panic(expected = "no level of one is called g")]
fn an_exclusion_of_what_is_not_there_panics() {
    let levels: &[_] = &[("one", "a g")];
    let reason = "";
    Table::new(&[("one", SIX)], &[Exclusion { levels, reason }]);
}

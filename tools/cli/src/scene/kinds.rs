//! The kinds of values in a scene file. The error of a wrong value is its code, and the values that
//! its kind admits.

use serde::de::{Deserialize, Deserializer, Error};
use tearmesh::{Point, Vector};
use toml::Spanned;

use crate::choice::Choice;

/// A value of another type, and one out of range.
const TYPE: &str = "E-SCENE-TYPE";
const RANGE: &str = "E-SCENE-RANGE";

/// Reads a value of any kind as a simpler one, which has to be admitted.
fn admit<'de, D: Deserializer<'de>, R: Deserialize<'de>, T>(
    from: D,
    what: &str,
    of: impl FnOnce(R) -> Result<T, &'static str>,
) -> Result<T, D::Error> {
    let raw = R::deserialize(from).map_err(|_| TYPE);
    let admitted = raw.and_then(of);
    admitted.map_err(|code| D::Error::custom(format_args!("{code} {what}")))
}

/// A finite number that follows one of the [`RULES`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Number<const RULE: usize>(f64);

pub(super) type Positive = Number<0>;
pub(super) type NotNegative = Number<1>;
pub(super) type Ratio = Number<2>;
pub(super) type Part = Number<3>;

type Rule = (&'static str, fn(f64) -> bool);

const RULES: [Rule; 4] = [
    ("a number above 0", |x| x > 0.0),
    ("a number from 0 up", |x| x >= 0.0),
    ("a number above 1", |x| x > 1.0),
    ("a number from 0 to 1", |x| (0.0..=1.0).contains(&x)),
];

impl<'de, const RULE: usize> Deserialize<'de> for Number<RULE> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let (what, is_in) = RULES[RULE];
        let in_range = |x: f64| x.is_finite() && is_in(x);
        admit(from, what, |x| {
            in_range(x).then_some(Number(x)).ok_or(RANGE)
        })
    }
}

impl<const RULE: usize> From<Number<RULE>> for f64 {
    fn from(number: Number<RULE>) -> f64 {
        number.0
    }
}

/// A whole number from one up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Count(pub(super) u32);

impl<'de> Deserialize<'de> for Count {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        admit(from, "a whole number from 1 up", |n: i64| {
            count(n).map(Count)
        })
    }
}

fn count(n: i64) -> Result<u32, &'static str> {
    u32::try_from(n).ok().filter(|&n| n > 0).ok_or(RANGE)
}

/// A value that is chosen by a word.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<T>(pub(super) T);

impl<'de, T: Choice> Deserialize<'de> for Word<T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let what = format!("one of {}", T::words());
        admit(from, &what, |word: String| {
            T::of(&word).map(Word).ok_or(RANGE)
        })
    }
}

/// So many finite numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<const N: usize>([f64; N]);

pub(super) type Pair = Row<2>;
pub(super) type Triple = Row<3>;

impl<'de, const N: usize> Deserialize<'de> for Row<N> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let what = match N {
            2 => "two numbers, as in [0.5, 1]",
            _ => "three numbers, as in [0, 1.5, 0]",
        };
        admit(from, what, |row| Ok(Row(finite(row)?)))
    }
}

fn finite<const N: usize>(row: Vec<f64>) -> Result<[f64; N], &'static str> {
    let row = row.try_into().ok();
    let row = row.filter(|row: &[f64; N]| row.iter().all(|x| x.is_finite()));
    row.ok_or(TYPE)
}

impl From<Pair> for [f64; 2] {
    fn from(row: Pair) -> [f64; 2] {
        row.0
    }
}

impl From<Triple> for Vector {
    fn from(row: Triple) -> Vector {
        row.0.into()
    }
}

impl From<Triple> for Point {
    fn from(row: Triple) -> Point {
        row.0.into()
    }
}

/// Two numbers, the first not above the second.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval(pub(super) [f64; 2]);

impl<'de> Deserialize<'de> for Interval {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let what = "two ascending numbers, as in [0, 0.5]";
        admit(from, what, |row| match finite(row)? {
            row if row[0] <= row[1] => Ok(Interval(row)),
            _ => Err(RANGE),
        })
    }
}

/// A number, which means that much downward, or a vector.
#[derive(Clone, Copy, Debug)]
pub(super) enum Gravity {
    Down(f64),
    Vector(Vector),
}

#[derive(serde::Deserialize)]
#[serde(untagged)]
enum NumberOrRow {
    Number(f64),
    Row(Vec<f64>),
}

impl<'de> Deserialize<'de> for Gravity {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let what = "a number from 0 up, or three";
        admit(from, what, |raw| match raw {
            NumberOrRow::Number(x) if x >= 0.0 && x.is_finite() => Ok(Gravity::Down(x)),
            NumberOrRow::Number(_) => Err(RANGE),
            NumberOrRow::Row(row) => Ok(Gravity::Vector(finite::<3>(row)?.into())),
        })
    }
}

/// The texts of two rays as in `--rays`, and where each stands. What is wrong within one is said when it is
/// read.
#[derive(Clone, Debug)]
pub(super) struct Rays(pub(super) Vec<Spanned<String>>);

impl<'de> Deserialize<'de> for Rays {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let what = r#"two rays, as in ["0,2,5:0,0,-1", "0,-2,5:0,0,-1"]"#;
        admit(from, what, |rays| Ok(Rays(rays)))
    }
}

/// Numbers of vertices.
#[derive(Clone, Debug)]
pub(super) struct Numbers(pub(super) Vec<u32>);

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let what = "numbers of vertices from 1 up, as in [1, 33]";
        admit(from, what, |numbers: Vec<i64>| {
            let numbers: Vec<u32> = numbers.into_iter().map(count).collect::<Result<_, _>>()?;
            match numbers.is_empty() {
                true => Err(RANGE),
                false => Ok(Numbers(numbers)),
            }
        })
    }
}

/// Offsets at ascending times.
#[derive(Clone, Debug)]
pub(super) struct Moves(pub(super) Vec<(f64, Vector)>);

impl<'de> Deserialize<'de> for Moves {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let what = "seconds and three metres each, seconds ascending, as in [[0, 0, 0, 0], [1, 0, -0.5, 0]]";
        admit(from, what, |rows: Vec<Vec<f64>>| {
            let rows: Vec<[f64; 4]> = rows.into_iter().map(finite).collect::<Result<_, _>>()?;
            let ascend = rows.windows(2).all(|pair| pair[0][0] < pair[1][0]);
            let moves = rows
                .iter()
                .map(|&[time_s, x, y, z]| (time_s, Vector::new(x, y, z)));
            match ascend && !rows.is_empty() {
                true => Ok(Moves(moves.collect())),
                false => Err(RANGE),
            }
        })
    }
}

/// Puts a value in the place of another, if a file has it.
pub(super) fn set<T>(place: &mut T, value: Option<impl Into<T>>) {
    if let Some(value) = value {
        *place = value.into();
    }
}

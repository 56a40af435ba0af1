//! The kinds of values in a scene file, as the guide names them.

use serde::de::DeserializeOwned;
use toml::Value;

use super::schema::Key;

/// The code of a value of another type, and that of one out of range.
const TYPE: &str = "E-SCENE-TYPE";
const RANGE: &str = "E-SCENE-RANGE";

type Check = fn(&Value) -> Result<(), &'static str>;

/// Each kind, an example where one helps, and what it admits.
const KINDS: [(&str, &str, Check); 15] = [
    ("true or false", "", |value| of::<bool>(value).map(drop)),
    ("a name", "\"left side\"", |value| {
        let name = value.as_str().ok_or(TYPE)?;
        within(!name.is_empty())
    }),
    ("a number above 0", "", |value| number(value, |x| x > 0.0)),
    ("a number from 0 up", "", |value| {
        number(value, |x| x >= 0.0)
    }),
    ("a number above 1", "", |value| number(value, |x| x > 1.0)),
    ("a number from 0 to 1", "", |value| {
        number(value, |x| (0.0..=1.0).contains(&x))
    }),
    ("a number from 0 up, or three", "", |value| {
        match value.is_array() {
            true => row::<3>(value).map(drop),
            false => number(value, |x| x >= 0.0),
        }
    }),
    ("a whole number from 1 up", "", whole),
    ("a file", r#""body.obj""#, |value| {
        of(value).and_then(|name: String| within(!name.is_empty()))
    }),
    ("two numbers", "[0.5, 1]", |value| row::<2>(value).map(drop)),
    ("three numbers", "[0, 1.5, 0]", |value| {
        row::<3>(value).map(drop)
    }),
    ("two ascending numbers", "[0, 0.5]", |value| {
        row(value).and_then(|[from, to]| within(from <= to))
    }),
    (
        "two rays",
        r#"["0,2,5:0,0,-1", "0,-2,5:0,0,-1"]"#,
        |value| of::<Vec<String>>(value).map(drop),
    ),
    ("numbers of vertices from 1 up", "[1, 33]", |value| {
        let numbers: Vec<Value> = of(value)?;
        numbers.iter().try_for_each(whole)?;
        within(!numbers.is_empty())
    }),
    (
        "seconds and three numbers each, seconds ascending",
        "[[0, 0, 0, 0], [1, 0, -0.5, 0]]",
        |value| {
            let rows: Vec<Value> = of(value)?;
            let rows: Vec<[f64; 4]> = rows.iter().map(row).collect::<Result<_, _>>()?;
            let ascend = rows.windows(2).all(|pair| pair[0][0] < pair[1][0]);
            within(ascend && !rows.is_empty())
        },
    ),
];

impl Key {
    /// Refuses a value that is not of the kind, with the code of the error.
    pub(super) fn check(&self, value: &Value) -> Result<(), &'static str> {
        if self.words().next().is_some() {
            let word: String = of(value)?;
            return within(self.words().any(|one| one == word));
        }
        (self.kind().2)(value)
    }

    /// What is admitted.
    pub(super) fn admits(&self) -> String {
        let words: Vec<&str> = self.words().collect();
        if !words.is_empty() {
            return format!("one of {}", words.join(", "));
        }
        match self.kind() {
            (kind, "", _) => (*kind).to_owned(),
            (kind, example, _) => format!("{kind}, as in {example}"),
        }
    }

    /// The words that the value may be; none if it is of another kind.
    fn words(&self) -> impl Iterator<Item = &'static str> {
        self.kind.split('`').skip(1).step_by(2)
    }

    fn kind(&self) -> &'static (&'static str, &'static str, Check) {
        let known = KINDS.iter().find(|(kind, ..)| *kind == self.kind);
        known.expect("the guide names no other kind")
    }
}

fn of<T: DeserializeOwned>(value: &Value) -> Result<T, &'static str> {
    value.clone().try_into().map_err(|_| TYPE)
}

fn within(is_in: bool) -> Result<(), &'static str> {
    is_in.then_some(()).ok_or(RANGE)
}

fn number(value: &Value, is_in: impl Fn(f64) -> bool) -> Result<(), &'static str> {
    of(value).and_then(|x: f64| within(x.is_finite() && is_in(x)))
}

fn whole(value: &Value) -> Result<(), &'static str> {
    of(value).and_then(|n: i64| within(u32::try_from(n).is_ok_and(|n| n > 0)))
}

/// So many finite numbers.
fn row<const N: usize>(value: &Value) -> Result<[f64; N], &'static str> {
    let row: Vec<f64> = of(value)?;
    let row = row.try_into().ok();
    let row = row.filter(|row: &[f64; N]| row.iter().all(|x| x.is_finite()));
    row.ok_or(TYPE)
}

/// Puts a value in the place of another, if a file has it.
pub(super) fn set<T>(place: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *place = value;
    }
}

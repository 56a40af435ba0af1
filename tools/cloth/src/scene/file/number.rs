//! The numbers of scene files: a type for each kind, so that a value out of its range cannot be held.

use std::fmt;
use std::ops::Deref;

use serde::Deserialize;
use serde::de::{Deserializer, Error, IntoDeserializer as _, SeqAccess, Visitor};
use tearmesh::VertexId;
use tearmesh::geometry::{Point, Vector};

/// The error of a value that has the right type and is out of range.
pub const OUT_OF_RANGE: &str = "out of range";

/// The reason why a value that has the right type is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutOfRange;

impl fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(OUT_OF_RANGE)
    }
}

impl std::error::Error for OutOfRange {}

/// A kind of values: those of another type for which something holds.
macro_rules! kind {
    ($(#[$doc:meta])* $name:ident $(<const $n:ident: usize>)?, $inner:ty, $text:literal, $holds:expr) => {
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq, Deserialize)]
        #[serde(try_from = $text)]
        pub struct $name $(<const $n: usize>)? ($inner);

        impl $(<const $n: usize>)? TryFrom<$inner> for $name $(<$n>)? {
            type Error = OutOfRange;

            fn try_from(value: $inner) -> Result<Self, OutOfRange> {
                let holds: fn(&$inner) -> bool = $holds;
                holds(&value).then_some($name(value)).ok_or(OutOfRange)
            }
        }

        impl $(<const $n: usize>)? Deref for $name $(<$n>)? {
            type Target = $inner;

            fn deref(&self) -> &$inner {
                &self.0
            }
        }
    };
}

kind!(
    /// A number above 0.
    Positive, f64, "f64", |x| x.is_finite() && *x > 0.0
);
kind!(
    /// A number from 0 up.
    NotNegative, f64, "f64", |x| x.is_finite() && *x >= 0.0
);
kind!(
    /// A number above 1.
    AboveOne, f64, "f64", |x| x.is_finite() && *x > 1.0
);
kind!(
    /// A number from 0 to 1.
    Fraction, f64, "f64", |x| (0.0..=1.0).contains(x)
);
kind!(
    /// A whole number from 1 up.
    Whole, i64, "i64", |n| u32::try_from(*n).is_ok_and(|n| n > 0)
);
kind!(
    /// A text that is not empty.
    Name, String, "String", |text| !text.is_empty()
);
kind!(
    /// Two ascending numbers.
    Range, Finite<2>, "Finite<2>", |ends| ends[0] <= ends[1]
);
kind!(
    /// Rows of a time in seconds and three numbers, of which the times ascend.
    Rows, Vec<Finite<4>>, "Vec<Finite<4>>",
    |rows| !rows.is_empty() && rows.windows(2).all(|two| two[0][0] < two[1][0])
);
kind!(
    /// Numbers of vertices from 1 up, as in OBJ.
    Vertices, Vec<Whole>, "Vec<Whole>", |numbers| !numbers.is_empty()
);

impl Whole {
    /// Returns the number.
    #[must_use]
    pub fn get(&self) -> u32 {
        self.0 as u32
    }
}

impl Rows {
    /// Returns the times and the vectors beside them.
    #[must_use]
    pub fn paths(&self) -> Vec<(f64, Vector)> {
        let row = |row: &Finite<4>| (row[0], Vector::new(row[1], row[2], row[3]));
        self.iter().map(row).collect()
    }
}

impl Vertices {
    /// Returns the vertices that have these numbers, counted from 1.
    #[must_use]
    pub fn ids(&self) -> Vec<VertexId> {
        let id = |number: &Whole| VertexId::new(number.get() as usize - 1);
        self.iter().filter_map(id).collect()
    }
}

/// The reason why a list is not so many finite numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite<const N: usize>;

impl<const N: usize> fmt::Display for NotFinite<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "not {N} finite numbers")
    }
}

impl<const N: usize> std::error::Error for NotFinite<N> {}

/// So many finite numbers. Others are of the wrong type, not out of range.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub struct Finite<const N: usize>([f64; N]);

impl<const N: usize> TryFrom<Vec<f64>> for Finite<N> {
    type Error = NotFinite<N>;

    fn try_from(numbers: Vec<f64>) -> Result<Self, NotFinite<N>> {
        let numbers = <[f64; N]>::try_from(numbers).ok();
        let finite = numbers.filter(|numbers| numbers.iter().all(|x| x.is_finite()));
        finite.map(Finite).ok_or(NotFinite)
    }
}

impl<const N: usize> Deref for Finite<N> {
    type Target = [f64; N];

    fn deref(&self) -> &[f64; N] {
        &self.0
    }
}

impl Finite<3> {
    /// Returns the numbers as a vector.
    #[must_use]
    pub fn vector(&self) -> Vector {
        self.0.into()
    }

    /// Returns the numbers as a point.
    #[must_use]
    pub fn point(&self) -> Point {
        self.0.into()
    }
}

/// A number, which means that much downward, or a vector.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Gravity {
    /// An acceleration downward, in m/s².
    Down(NotNegative),
    /// An acceleration, in m/s².
    Vector(Finite<3>),
}

impl<'de> Deserialize<'de> for Gravity {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Gravity, D::Error> {
        from.deserialize_any(GravityVisitor)
    }
}

/// A reader of a number or a list. (An untagged enum would say of neither what is wrong with it.)
struct GravityVisitor;

impl<'de> Visitor<'de> for GravityVisitor {
    type Value = Gravity;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or three")
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<Gravity, E> {
        NotNegative::deserialize(x.into_deserializer()).map(Gravity::Down)
    }

    fn visit_i64<E: Error>(self, x: i64) -> Result<Gravity, E> {
        self.visit_f64(x as f64)
    }

    fn visit_u64<E: Error>(self, x: u64) -> Result<Gravity, E> {
        self.visit_f64(x as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Gravity, A::Error> {
        let numbers = serde::de::value::SeqAccessDeserializer::new(seq);
        Finite::deserialize(numbers).map(Gravity::Vector)
    }
}

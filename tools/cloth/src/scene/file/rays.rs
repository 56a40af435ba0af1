//! Rays and planes as people write them, in scene files and on the command line.
//!
//! `ox,oy,oz:dx,dy,dz` is an origin and a direction, `ox,oy,oz@tx,ty,tz` an origin and a target;
//! `->` means the same as `@`. Two rays are separated by blanks or a semicolon; blanks beside a comma, a
//! colon, `@` or `->` separate nothing. A plane is a point and a normal, `px,py,pz:nx,ny,nz`.

use std::fmt;
use std::ops::{Deref, Range};

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use tearmesh::geometry::{Plane, Point, Ray, Vector};
use tearmesh::{PlaneError, RayError};

/// The two rays of a cut, as texts of one or two each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayPair([Ray; 2]);

impl Deref for RayPair {
    type Target = [Ray; 2];

    fn deref(&self) -> &[Ray; 2] {
        &self.0
    }
}

impl<'de> Deserialize<'de> for RayPair {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<RayPair, D::Error> {
        let texts = Vec::<String>::deserialize(from)?;
        let rays = texts
            .iter()
            .flat_map(|text| split_pair(text).map(|part| ray(&text[part])))
            .collect::<Result<Vec<Ray>, Unreadable>>()
            .map_err(D::Error::custom)?;
        <[Ray; 2]>::try_from(rays)
            .map(RayPair)
            .map_err(|found| D::Error::invalid_length(found.len(), &"two rays"))
    }
}

/// Returns the place of each ray in a text.
pub fn split_pair(text: &str) -> impl Iterator<Item = Range<usize>> + '_ {
    let is_separator = |c: char| c == ';' || c.is_whitespace();
    let mut at = 0;
    std::iter::from_fn(move || {
        let start = at + text[at..].find(|c| !is_separator(c))?;
        let mut end = start;
        loop {
            let rest = &text[end..];
            end += rest.find(is_separator).unwrap_or(rest.len());
            // Blanks beside a mark are part of a ray.
            let after = text[end..].trim_start();
            let is_one = goes_on(&text[start..end]) || is_continued(after);
            if after.is_empty() || after.starts_with(';') || !is_one {
                break;
            }
            end = text.len() - after.len();
            end += after.chars().next().map_or(0, char::len_utf8);
        }
        at = end;
        Some(start..end)
    })
}

/// Returns whether the text of a ray ends with a mark, so that it has to go on.
#[must_use]
pub fn goes_on(text: &str) -> bool {
    text.ends_with([',', ':', '@']) || text.ends_with("->")
}

/// Returns whether a text begins with a mark, so that it goes on with what stands before it.
#[must_use]
pub fn is_continued(text: &str) -> bool {
    text.starts_with([',', ':', '@']) || text.starts_with("->")
}

/// Reads one ray.
///
/// ```
/// let ray = tearmesh_cloth::scene::file::rays::ray("0,1,5 @ 0,1,0").unwrap();
/// assert_eq!(ray.direction().z, -5.0);
/// ```
///
/// # Errors
///
/// The first part that cannot be read.
pub fn ray(text: &str) -> Result<Ray, Unreadable> {
    let label = "expected `:` and a direction, or `@` and a target";
    let halves = Halves::read(text, "ray", &["->", "@", ":"], label)?;
    let [origin, second] = halves.numbers;
    let (origin, is_aimed) = (Point::from(origin), halves.mark != ":");
    let direction = match is_aimed {
        true => Point::from(second) - origin,
        false => Vector::from(second),
    };
    Ray::new(origin, direction).map_err(|error| {
        let (half, label) = match error {
            RayError::Origin { .. } => (0, "expected an origin that is less far away"),
            RayError::Direction { .. } if is_aimed => (1, "expected a point other than the origin"),
            _ => (1, "expected a direction"),
        };
        halves.wrong(half, "E-RAY-ZERO", error.to_string(), label)
    })
}

/// Reads a plane.
///
/// # Errors
///
/// The first part that cannot be read.
pub fn plane(text: &str) -> Result<Plane, Unreadable> {
    let halves = Halves::read(text, "plane", &[":"], "expected `:` and a normal")?;
    let [point, normal] = halves.numbers;
    Plane::new(point.into(), normal.into()).map_err(|error| {
        let (half, label) = match error {
            PlaneError::Point { .. } => (0, "expected a point that is less far away"),
            _ => (1, "expected a normal"),
        };
        halves.wrong(half, "E-PLANE-ZERO", error.to_string(), label)
    })
}

/// A text that is no ray or plane.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unreadable {
    /// The code of the error, such as `E-RAY-SYNTAX`.
    pub code: &'static str,
    /// What is wrong.
    pub message: String,
    /// The part of the text that is wrong.
    pub part: Range<usize>,
    /// What is expected there.
    pub label: &'static str,
}

impl fmt::Display for Unreadable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.message, self.label)
    }
}

impl std::error::Error for Unreadable {}

/// Two triples of numbers, and the mark between them.
struct Halves {
    numbers: [[f64; 3]; 2],
    parts: [Range<usize>; 2],
    mark: &'static str,
}

impl Halves {
    /// Why one of both halves cannot be used.
    fn wrong(
        &self,
        half: usize,
        code: &'static str,
        message: String,
        label: &'static str,
    ) -> Unreadable {
        Unreadable {
            code,
            message,
            part: self.parts[half].clone(),
            label,
        }
    }

    /// Reads the text of a ray or a plane. `label` is what to say where it has none of the marks.
    fn read(
        text: &str,
        kind: &str,
        marks: &[&'static str],
        label: &'static str,
    ) -> Result<Halves, Unreadable> {
        let unreadable = |part, label| Unreadable {
            code: match kind {
                "ray" => "E-RAY-SYNTAX",
                _ => "E-PLANE-SYNTAX",
            },
            message: format!("cannot read the {kind} `{text}`"),
            part,
            label,
        };
        let triple = |part: &Range<usize>| {
            let mut numbers = Vec::new();
            let mut at = part.start;
            for word in text[part.clone()].split(',') {
                let start = at + word.len() - word.trim_start().len();
                let span = start..start + word.trim().len();
                at += word.len() + 1;
                let number = word.trim().parse().ok().filter(|x: &f64| x.is_finite());
                match (number, numbers.len()) {
                    (Some(number), 0..3) => numbers.push(number),
                    (None, 0..3) => return Err(unreadable(span, "expected a finite number")),
                    _ => return Err(unreadable(span, "a fourth number")),
                }
            }
            let label = "expected three numbers with commas between them";
            <[f64; 3]>::try_from(numbers).map_err(|_| unreadable(part.clone(), label))
        };
        let mut marks = marks.iter();
        let found = marks.find_map(|&mark| Some((text.find(mark)?, mark)));
        let (at, mark) = found.ok_or_else(|| unreadable(0..text.len(), label))?;
        let parts = [0..at, at + mark.len()..text.len()];
        let numbers = [triple(&parts[0])?, triple(&parts[1])?];
        Ok(Halves {
            numbers,
            parts,
            mark,
        })
    }
}

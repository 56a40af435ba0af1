//! Numbers as people type them.

use std::ops::RangeInclusive;

use tearmesh::Point;
use tearmesh_cloth::scene::Axis;
use tearmesh_view::{PIXELS_MAX, PictureSize};

use crate::choice::Choice as _;

/// Reads a point.
pub(super) fn point(text: &str) -> Result<Point, String> {
    match numbers(text, ',')[..] {
        [x, y, z] => Ok(Point::new(x, y, z)),
        _ => Err("expected three numbers with commas between them, as in 0,1.5,0".to_owned()),
    }
}

/// Reads a direction that is up: an axis, or three numbers.
pub(super) fn up(text: &str) -> Result<Point, String> {
    let axis = Axis::of(text).map(|axis| Point::from(axis.vector()));
    let help = "expected x, y, z, -x, -y or -z, or three numbers as in 0,1,0";
    axis.map_or_else(|| point(text).map_err(|_| help.to_owned()), Ok)
}

/// Reads a direction that is up, of which only the axes will do.
pub(super) fn up_axis(text: &str) -> Result<Axis, String> {
    let up = up(text).unwrap_or_default();
    let mut axes = Axis::NAMED.into_iter().map(|(_, axis)| axis);
    let named = axes.find(|axis| Point::from(axis.vector()) == up);
    named.ok_or_else(|| format!("expected one of {}", Axis::words()))
}

/// Reads an eye and the point that it looks at.
pub(super) fn look(text: &str) -> Result<[Point; 2], String> {
    let (eye, at) = text
        .split_once('@')
        .ok_or("expected `@` between the eye and what it looks at, as in 0,0,5@0,0,0")?;
    Ok([point(eye)?, point(at)?])
}

/// Reads an angle between two faces, in degrees.
pub(super) fn angle(text: &str) -> Result<f64, String> {
    within(text, 0.0..=180.0, "degrees from 0 to 180")
}

/// Reads a duration in seconds.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    number(text, |seconds| seconds >= 0.0, "seconds, as in 2.5")
}

/// Reads a distance.
pub(super) fn distance(text: &str) -> Result<f64, String> {
    number(text, |length| length >= 0.0, "a number from 0 up")
}

/// Reads a number above 0.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    number(text, |x| x > 0.0, "a number above 0")
}

/// Reads a length as a multiple of the length at rest, which it exceeds.
pub(super) fn stretch(text: &str) -> Result<f64, String> {
    number(text, |ratio| ratio > 1.0, "a number above 1, as in 1.5")
}

/// Reads the part of an edge within which a crossing snaps.
pub(super) fn snap(text: &str) -> Result<f64, String> {
    within(text, 0.0..=0.49, "a number from 0 to 0.49, as in 0.05")
}

/// Reads a number in a range.
pub(super) fn within(
    text: &str,
    range: RangeInclusive<f64>,
    expected: &str,
) -> Result<f64, String> {
    number(text, |x| range.contains(&x), expected)
}

fn number(text: &str, is_in: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    match numbers(text, ',')[..] {
        [x] if is_in(x) => Ok(x),
        _ => Err(format!("expected {expected}")),
    }
}

/// Reads the size of a picture.
pub(super) fn size(text: &str) -> Result<PictureSize, String> {
    let (width, height) = text
        .split_once('x')
        .ok_or("expected width and height with an x between them, as in 1920x1080")?;
    let pixels = |text: &str| text.trim().parse().map_err(|_| "expected whole pixels");
    PictureSize::new(pixels(width)?, pixels(height)?)
        .ok_or_else(|| format!("expected from 1 to {PIXELS_MAX} pixels in all"))
}

/// The distance between the sides of a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Gap {
    Length(f64),
    /// A fraction of the mean length of the edges.
    Edges(f64),
}

/// Reads a length, or per cent of the mean edge.
pub(super) fn gap(text: &str) -> Result<Gap, String> {
    let (number, is_part) = match text.strip_suffix('%') {
        Some(number) => (number, true),
        None => (text, false),
    };
    match (&numbers(number, ',')[..], is_part) {
        (&[part], true) if part >= 0.0 => Ok(Gap::Edges(part / 100.0)),
        (&[length], false) if length >= 0.0 => Ok(Gap::Length(length)),
        _ => Err("expected a length as in 0.002, or per cent of the mean edge as in 10%".into()),
    }
}

/// Finite numbers, `separator` between them; none if one cannot be read.
pub(crate) fn numbers(text: &str, separator: char) -> Vec<f64> {
    let numbers = text.split(separator);
    let read = numbers.map(|number| number.trim().parse().ok().filter(|x: &f64| x.is_finite()));
    read.collect::<Option<_>>().unwrap_or_default()
}

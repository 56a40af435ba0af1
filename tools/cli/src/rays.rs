//! Rays and planes as users write them.
//!
//! `ox,oy,oz:dx,dy,dz` is an origin and a direction, `ox,oy,oz@tx,ty,tz` an origin and a target;
//! `->` means the same as `@`. Two rays are separated by blanks or a semicolon; blanks beside a comma, a
//! colon, `@` or `->` separate nothing. A plane is a point and a normal, `px,py,pz:nx,ny,nz`.

use std::ops::Range;

use tearmesh::{Plane, PlaneError, Point, Ray, RayError, Vector};

use crate::say::Fault;

/// The two rays of a cut.
pub(crate) type Pair = [Ray; 2];

/// The texts of the rays in a text, and where each is.
pub(crate) fn split_pair(text: &str) -> impl Iterator<Item = Range<usize>> + '_ {
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

/// Whether the text of a ray ends with a mark, so that it has to go on.
pub(crate) fn goes_on(text: &str) -> bool {
    text.ends_with([',', ':', '@']) || text.ends_with("->")
}

/// Whether a text begins with a mark, so that it goes on with what stands before it.
pub(crate) fn is_continued(text: &str) -> bool {
    text.starts_with([',', ':', '@']) || text.starts_with("->")
}

/// Two rays as they can be typed, to the last digit.
pub(crate) fn typed(pair: &Pair) -> String {
    let [one, other] = pair.each_ref().map(|ray| {
        let (o, d) = (ray.origin(), ray.direction());
        format!("{},{},{}:{},{},{}", o.x, o.y, o.z, d.x, d.y, d.z)
    });
    format!("--rays {one} {other}")
}

/// Reads two rays. `origin` names the place of the text in an error, and `line` its line.
pub(crate) fn pair(text: &str, origin: &str, line: usize) -> Result<Pair, Fault> {
    let at = (origin, line);
    let spans: Vec<_> = split_pair(text).collect();
    let [a, b] = &spans[..] else {
        let (message, label) = miscounted(spans.len());
        let last = spans.last().cloned().unwrap_or(0..text.len());
        let fault = Fault::error("E-RAY-COUNT", message).at(at, text, last, label);
        return Err(fault.help(PAIR_HELP));
    };
    let read = |span: &Range<usize>| {
        ray(&text[span.clone()]).map_err(|wrong| wrong.at(at, text, span.start, RAY_HELP))
    };
    Ok([read(a)?, read(b)?])
}

/// How to write two rays.
pub(crate) const PAIR_HELP: &str = "write both, as in --rays 0,1,5:0,0,-1 0,-1,5:0,0,-1";
/// How to write one.
pub(crate) const RAY_HELP: &str =
    "write origin:direction as in 0,1,5:0,0,-1, or origin@target as in 0,1,5@0,1,0";

/// The message for a wrong number of rays, and the label for the place where they are given.
pub(crate) fn miscounted(count: usize) -> (String, &'static str) {
    let (given, label) = match count {
        0 => ("none was", "two rays missing"),
        1 => ("one was", "a second ray is missing"),
        _ => (&*format!("{count} were"), "one too many"),
    };
    (format!("a cut takes two rays, but {given} given"), label)
}

/// Reads a file of rays: two a line; `#` begins a comment.
pub(crate) fn file(text: &str, path: &str) -> Result<Vec<Pair>, Fault> {
    let mut pairs = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let rays = line.split('#').next().unwrap_or_default();
        if !rays.trim().is_empty() {
            pairs.push(pair(rays.trim_end(), path, i + 1)?);
        }
    }
    Ok(pairs)
}

/// What is wrong with a text, and where.
#[derive(Debug)]
pub(crate) struct Unreadable {
    pub(crate) code: &'static str,
    pub(crate) message: String,
    pub(crate) part: Range<usize>,
    pub(crate) label: &'static str,
}

impl Unreadable {
    /// The fault, where the text begins at a byte of a line.
    fn at(self, place: (&str, usize), line: &str, begin: usize, help: &str) -> Fault {
        let part = begin + self.part.start..begin + self.part.end;
        let fault = Fault::error(self.code, self.message);
        fault.at(place, line, part, self.label).help(help)
    }
}

/// Reads one ray.
pub(crate) fn ray(text: &str) -> Result<Ray, Unreadable> {
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
            RayError::Direction { .. } => (1, "expected a direction"),
        };
        Unreadable {
            code: "E-RAY-ZERO",
            message: error.to_string(),
            part: halves.parts[half].clone(),
            label,
        }
    })
}

/// Reads a plane; its text stood at `origin`.
pub(crate) fn plane(text: &str, origin: &str) -> Result<Plane, Fault> {
    let read = || {
        let halves = Halves::read(text, "plane", &[":"], "expected `:` and a normal")?;
        let [point, normal] = halves.numbers;
        Plane::new(point.into(), normal.into()).map_err(|error| {
            let (half, label) = match error {
                PlaneError::Point { .. } => (0, "expected a point that is less far away"),
                PlaneError::Normal { .. } => (1, "expected a normal"),
            };
            Unreadable {
                code: "E-PLANE-ZERO",
                message: error.to_string(),
                part: halves.parts[half].clone(),
                label,
            }
        })
    };
    let help = "write point:normal, as in --plane 0,0.5,0:0,1,0";
    read().map_err(|wrong: Unreadable| wrong.at((origin, 1), text, 0, help))
}

/// Two triples of numbers, and the mark between them.
struct Halves {
    numbers: [[f64; 3]; 2],
    parts: [Range<usize>; 2],
    mark: &'static str,
}

impl Halves {
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

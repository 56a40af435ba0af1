//! Rays and planes as users write them.
//!
//! `ox,oy,oz:dx,dy,dz` is an origin and a direction, `ox,oy,oz@tx,ty,tz` an origin and a target;
//! `->` means the same as `@`. Two rays are separated by blanks or a semicolon; blanks beside a comma, a
//! colon, `@` or `->` separate nothing. A plane is a point and a normal, `px,py,pz:nx,ny,nz`.

use std::ops::Range;

use tearmesh::{Plane, Ray};
use tearmesh_cloth::scene::file::rays::{self as written, Unreadable};
pub(crate) use tearmesh_cloth::scene::file::rays::{goes_on, is_continued, ray, split_pair};

use crate::say::Fault;

/// The two rays of a cut.
pub(crate) type Pair = [Ray; 2];

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
        ray(&text[span.clone()])
            .map_err(|wrong| unreadable(wrong, at, text, span.start).help(RAY_HELP))
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

/// The fault of a text that began at a byte of a line.
fn unreadable(wrong: Unreadable, place: (&str, usize), line: &str, begin: usize) -> Fault {
    let part = begin + wrong.part.start..begin + wrong.part.end;
    Fault::error(wrong.code, wrong.message).at(place, line, part, wrong.label)
}

/// Reads a plane; its text stood at `origin`.
pub(crate) fn plane(text: &str, origin: &str) -> Result<Plane, Fault> {
    let help = "write point:normal, as in --plane 0,0.5,0:0,1,0";
    written::plane(text).map_err(|wrong| unreadable(wrong, (origin, 1), text, 0).help(help))
}

//! Ensembles as panels: a row for each scene, a panel for each number, and in it three bars for each method.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use tearmesh_cloth::scene::ensemble::Quantity;
use tearmesh_cloth::statistics::Verdict;

use super::words::short;
use super::{Cascade, TOLD};
use crate::draw::{Area, Drawn};
use crate::pareto::Family;

const ROW: i32 = 270;
const PANEL: i32 = 270;
const LEFT: i32 = 46;
const HIGH: i32 = 150;

/// How far apart bars are, and the room of a method.
const BAR: i32 = 11;
const METHOD: i32 = 42;

const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// What the rows of some scenes take, in pixels.
pub(in crate::tear) fn height(cascades: &[Cascade]) -> u32 {
    match meshes(cascades).len() {
        0 => 0,
        rows => (46 + ROW * rows as i32) as u32,
    }
}

/// The cascades of each mesh.
fn meshes(cascades: &[Cascade]) -> Vec<&[Cascade]> {
    let of_mesh = cascades.chunk_by(|one, next| one.mesh() == next.mesh());
    of_mesh.collect()
}

/// Draws them from so far down.
pub(in crate::tear) fn draw(root: &Area<'_>, cascades: &[Cascade], top: i32) -> Drawn {
    let rows = meshes(cascades);
    if rows.is_empty() {
        return Ok(());
    }
    let title = "Cascades: what comes of many seeds";
    root.draw(&Text::new(title, (20, top), ("sans-serif", 20)))?;
    let words = "Medians with 10 to 90 %, for each method at its step, half and a quarter of it. Below, what \
                 halving does to the median: = same, ≠ differ, ? cannot tell. Grey: the reference.";
    let style = ("sans-serif", 12).into_font().color(&GREY);
    root.draw(&Text::new(words, (20, top + 25), style))?;
    for (row, of) in rows.into_iter().enumerate() {
        let of: Vec<&Cascade> = of.iter().collect();
        let y = top + 50 + ROW * row as i32;
        for (column, quantity) in TOLD.into_iter().enumerate() {
            panel(root, (12 + PANEL * column as i32, y), &of, column, quantity)?;
        }
    }
    Ok(())
}

fn panel(
    root: &Area<'_>,
    (left, top): (i32, i32),
    cascades: &[&Cascade],
    place: usize,
    quantity: Quantity,
) -> Drawn {
    let axis = Axis::of(cascades, place);
    let (x0, bottom) = (left + LEFT, top + 40 + HIGH);
    let at = |x: f64| bottom - (axis.part(x) * f64::from(HIGH)) as i32;

    let [name, unit] = quantity.name();
    let unit = match unit {
        "" => String::new(),
        unit => format!(", {unit}"),
    };
    let first = cascades[0];
    let scale = if axis.is_logarithmic() {
        ", logarithmic"
    } else {
        ""
    };
    let (scene, cells) = first.mesh();
    let caption = format!("{scene} of {cells} · {name}{unit}{scale}");
    root.draw(&Text::new(caption, (left + 6, top), ("sans-serif", 14)))?;
    let reference = match &first.numbers[place].reference[..] {
        [] => "no reference: no two that converged agree".to_owned(),
        names => format!("reference: the finest of {}", names.join(" and ")),
    };
    let grey = |size: i32| ("sans-serif", size).into_font().color(&GREY);
    root.draw(&Text::new(reference, (left + 6, top + 17), grey(11)))?;
    let right = x0 + METHOD * cascades.len() as i32;
    for part in [0.0, 0.5, 1.0] {
        let x = axis.at(part);
        let y = at(x);
        root.draw(&PathElement::new(
            [(x0, y), (right, y)],
            RGBColor(0xe0, 0xe0, 0xe0),
        ))?;
        let style = grey(10).pos(Pos::new(HPos::Right, VPos::Center));
        root.draw(&Text::new(short(x), (x0 - 4, y), style))?;
    }
    if let Some([_, middle, _]) = reference_spread(cascades, place) {
        let y = at(middle);
        let line = [(x0, y), (right, y)];
        root.draw(&PathElement::new(
            line,
            RGBColor(0xaa, 0xaa, 0xaa).stroke_width(3),
        ))?;
    }
    for (i, cascade) in cascades.iter().enumerate() {
        let number = &cascade.numbers[place];
        let colour = crate::pareto::colour(family(&cascade.method));
        let middle = x0 + METHOD * i as i32 + METHOD / 2;
        for (j, spread) in number.spreads.iter().enumerate() {
            let x = middle + BAR * (j as i32 - 1);
            if let Some([low, median, high]) = *spread {
                let bar = [(x, at(low)), (x, at(high))];
                root.draw(&PathElement::new(bar, colour.stroke_width(2)))?;
                root.draw(&Circle::new((x, at(median)), 4, colour.filled()))?;
            }
        }
        let centred = |style: TextStyle<'static>| style.pos(Pos::new(HPos::Center, VPos::Top));
        let name = centred(("sans-serif", 11).into_font().color(&BLACK));
        root.draw(&Text::new(
            cascade.method.clone(),
            (middle, bottom + 6),
            name,
        ))?;
        let verdict = match number.verdict() {
            Some(Verdict::Same) => "=",
            Some(Verdict::Differ) => "≠",
            Some(Verdict::CannotTell) => "?",
            None => "not said",
        };
        let size = if verdict.len() > 4 { 10 } else { 15 };
        let style = centred(("sans-serif", size).into_font().color(&BLACK));
        root.draw(&Text::new(verdict, (middle, bottom + 20), style))?;
    }
    Ok(())
}

/// What a panel shows: from nothing up, or from above it where medians are far apart.
struct Axis {
    least: f64,
    most: f64,
}

/// Medians that are so many times as large as others leave those no room.
const FAR: f64 = 12.0;

impl Axis {
    fn of(cascades: &[&Cascade], place: usize) -> Axis {
        let numbers = cascades.iter().map(|cascade| &cascade.numbers[place]);
        let spreads = numbers.flat_map(|number| number.spreads.iter().flatten());
        let spreads: Vec<[f64; 3]> = spreads
            .copied()
            .filter(|spread| spread[2].is_finite())
            .collect();
        let least = |i: usize| spreads.iter().map(|s| s[i]).fold(f64::INFINITY, f64::min);
        let most = |i: usize| {
            spreads
                .iter()
                .map(|s| s[i])
                .fold(f64::MIN_POSITIVE, f64::max)
        };
        let is_far = least(0) > 0.0 && most(1) > FAR * least(1);
        Axis {
            least: if is_far { 0.8 * least(0) } else { 0.0 },
            most: 1.05 * most(2),
        }
    }

    fn is_logarithmic(&self) -> bool {
        self.least > 0.0
    }

    /// How far up a number is, from 0 to 1.
    fn part(&self, x: f64) -> f64 {
        let part = match self.is_logarithmic() {
            true => (x / self.least).ln() / (self.most / self.least).ln(),
            false => x / self.most,
        };
        part.clamp(0.0, 1.0)
    }

    /// The number that is so far up.
    fn at(&self, part: f64) -> f64 {
        match self.is_logarithmic() {
            true => self.least * (self.most / self.least).powf(part),
            false => part * self.most,
        }
    }
}

/// The finest of the first method of the reference.
fn reference_spread(cascades: &[&Cascade], place: usize) -> Option<[f64; 3]> {
    let name = cascades[0].numbers[place].reference.first()?;
    let of = cascades.iter().find(|cascade| cascade.method == *name)?;
    *of.numbers[place].spreads.last()?
}

/// As which a method is drawn.
fn family(method: &str) -> Family {
    match method {
        "xpbd" => Family::Xpbd,
        "implicit" => Family::BackwardEuler,
        "pbd" => Family::Pbd,
        "provot" => Family::Provot,
        _ => Family::Verlet,
    }
}

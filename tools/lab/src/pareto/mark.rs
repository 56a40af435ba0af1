//! The mark of each method: a shape and a colour, so that either alone tells it.

use plotters::prelude::*;

use super::method::Family;
use crate::draw::{Area, Drawn};

/// How a mark is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Look {
    /// What is known.
    Filled,
    /// What is known no better than the floor.
    Hollow,
}

/// The colour of a method: those of Okabe and Ito, which also who sees few colours tells apart, and more.
pub(crate) fn colour(family: Family) -> RGBColor {
    match family {
        Family::Verlet => RGBColor(0x00, 0x72, 0xb2),
        Family::Plain => RGBColor(0x56, 0xb4, 0xe9),
        Family::Rk4 => RGBColor(0x22, 0x22, 0x22),
        Family::Euler => RGBColor(0xc9, 0x8a, 0x00),
        Family::Provot => RGBColor(0x8a, 0x8a, 0x8a),
        Family::Pbd => RGBColor(0xcc, 0x79, 0xa7),
        Family::Xpbd => RGBColor(0xd5, 0x5e, 0x00),
        Family::BackwardEuler => RGBColor(0x00, 0x9e, 0x73),
        Family::Bdf2 => RGBColor(0x7b, 0x3f, 0xa0),
    }
}

/// A shape about the origin, of about the size of 1.
enum Shape {
    Circle,
    /// A closed line.
    Closed(&'static [[f64; 2]]),
    /// Strokes, which are never filled.
    Strokes(&'static [[[f64; 2]; 2]]),
}

fn shape(family: Family) -> Shape {
    match family {
        Family::Verlet => Shape::Circle,
        Family::Plain => Shape::Closed(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]),
        Family::Rk4 => Shape::Closed(&[[0.0, -1.3], [1.1, 0.0], [0.0, 1.3], [-1.1, 0.0]]),
        Family::Euler => Shape::Closed(&[[0.0, -1.2], [1.1, 0.9], [-1.1, 0.9]]),
        Family::Provot => Shape::Closed(&[[0.0, 1.2], [1.1, -0.9], [-1.1, -0.9]]),
        Family::Pbd => Shape::Strokes(&[[[-1.0, -1.0], [1.0, 1.0]], [[-1.0, 1.0], [1.0, -1.0]]]),
        Family::Xpbd => Shape::Strokes(&[[[-1.2, 0.0], [1.2, 0.0]], [[0.0, -1.2], [0.0, 1.2]]]),
        Family::BackwardEuler => Shape::Closed(&[[-1.2, 0.0], [0.9, -1.1], [0.9, 1.1]]),
        Family::Bdf2 => Shape::Closed(&[[1.2, 0.0], [-0.9, -1.1], [-0.9, 1.1]]),
    }
}

/// Draws the mark of a method at a pixel, of a size in pixels.
pub(crate) fn draw(
    area: &Area<'_>,
    family: Family,
    (x, y): (i32, i32),
    size: f64,
    look: Look,
) -> Drawn {
    let colour = colour(family);
    let at = |[dx, dy]: [f64; 2]| {
        let pixel = |d: f64| (d * size).round() as i32;
        (x + pixel(dx), y + pixel(dy))
    };
    let thick = if size > 3.0 { 2 } else { 1 };
    match (shape(family), look) {
        (Shape::Circle, Look::Filled) => {
            area.draw(&Circle::new((x, y), size.round() as i32, colour.filled()))
        }
        (Shape::Circle, Look::Hollow) => area.draw(&Circle::new(
            (x, y),
            size.round() as i32,
            colour.stroke_width(1),
        )),
        (Shape::Closed(corners), look) => {
            let corners: Vec<(i32, i32)> = corners.iter().copied().map(at).collect();
            if look == Look::Filled {
                return area.draw(&Polygon::new(corners, colour.filled()));
            }
            let round = corners.iter().chain(corners.first()).copied();
            area.draw(&PathElement::new(
                round.collect::<Vec<_>>(),
                colour.stroke_width(1),
            ))
        }
        (Shape::Strokes(strokes), look) => {
            let thick = if look == Look::Filled { thick } else { 1 };
            let style = match look {
                Look::Filled => colour.to_rgba(),
                Look::Hollow => colour.mix(0.6),
            };
            strokes.iter().try_for_each(|stroke| {
                let ends = stroke.map(at).to_vec();
                area.draw(&PathElement::new(ends, style.stroke_width(thick)))
            })
        }
    }
}

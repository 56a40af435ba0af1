//! Plots: figures of panels, described as data and drawn as SVG.
//!
//! A [`Figure`] has a title that says the finding, panels side by side, at most one legend, and a footer with
//! the provenance. A [`Panel`] has two [`Axis`]es and [`Layer`]s: lines, marks, bands, rules, cells of a heat
//! map, and labels. Axes are fitted to what is drawn unless they have a range. Labels are moved apart, so that
//! none stands on another. The same figure gives the same bytes.
//!
//! This is our own drawing and not a library's, since with axes, marks and labels described here a library
//! has nothing left to do but to map points to pixels; and the one that served before (plotters) sets text
//! at 1/1.24 of the size that it is asked for, and has no halo for text that crosses a line, no dashes and
//! no words to hover over.

mod axis;
mod canvas;
mod draw;

pub(crate) use self::axis::{Axis, percent, short};
pub(crate) use self::draw::svg;

use std::ops::Range;

/// A colour as `[red, green, blue]`.
pub(crate) type Colour = [u8; 3];

/// The colour of text.
pub(crate) const INK: Colour = [0x22, 0x22, 0x22];
/// The colour of remarks, rules and axes.
pub(crate) const GREY: Colour = [0x60, 0x60, 0x60];
/// The colour of bands.
pub(crate) const PALE: Colour = [0xec, 0xec, 0xe6];
/// The colour of strips in which failures stand.
pub(crate) const PINK: Colour = [0xfb, 0xee, 0xea];
/// Colours that are told apart with most kinds of colour blindness (Okabe and Ito).
pub(crate) const COLOURS: [Colour; 6] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0xc9, 0x8a, 0x00],
    [0x56, 0xb4, 0xe9],
];

/// A figure: panels under one title.
#[derive(Clone, Debug, Default)]
pub(crate) struct Figure {
    /// The title, which says what the data show.
    pub(crate) title: String,
    /// How the figure is to be read.
    pub(crate) about: String,
    /// The entries of the legend; empty where labels stand beside what they name.
    pub(crate) legend: Vec<(Mark, String)>,
    /// The number of panels in a row, and the width and height of each in pixels, with its title and axes.
    pub(crate) layout: (usize, [f64; 2]),
    /// The panels, row by row.
    pub(crate) panels: Vec<Panel>,
    /// The provenance, and what else has to be known; a paragraph each.
    pub(crate) footer: Vec<String>,
}

/// A plot of a figure.
#[derive(Clone, Debug, Default)]
pub(crate) struct Panel {
    /// The title.
    pub(crate) title: String,
    /// A remark under the title.
    pub(crate) about: String,
    /// The horizontal axis.
    pub(crate) x: Axis,
    /// The vertical axis.
    pub(crate) y: Axis,
    /// What is drawn, from back to front.
    pub(crate) layers: Vec<Layer>,
    /// A strip above the vertical axis, as for runs that failed.
    pub(crate) above: Option<Strip>,
    /// Paragraphs under the panel.
    pub(crate) words: Vec<String>,
}

impl Panel {
    /// Returns a panel with its title and the remark under it, its horizontal and its vertical axis, and what is drawn,
    /// from back to front.
    #[must_use]
    pub(crate) fn new(title: &str, about: &str, [x, y]: [Axis; 2], layers: Vec<Layer>) -> Panel {
        Panel {
            title: title.to_owned(),
            about: about.to_owned(),
            x,
            y,
            layers,
            ..Panel::default()
        }
    }
}

/// A strip at the upper end of the vertical axis, whose marks have no place along it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Strip {
    /// The words in the strip.
    pub(crate) label: String,
    /// The marks by their place along the horizontal axis, each with words to hover over.
    pub(crate) marks: Vec<(f64, Mark, String)>,
}

/// What is drawn in a panel.
#[derive(Clone, Debug)]
pub(crate) enum Layer {
    /// A band over the whole width, between these ends along the vertical axis. Ends beyond it are cut off.
    Band(Range<f64>),
    /// A dashed vertical line over the whole height at a place along the horizontal axis, with a label.
    Rule(f64, &'static str),
    /// A line from point to point, with its width in pixels.
    Line(Vec<[f64; 2]>, Colour, f64),
    /// A mark at a point, with words to hover over, or none if they are empty.
    Mark([f64; 2], Mark, String),
    /// A cell of a heat map, one unit wide and high: the place along both axes of its corner with the smaller
    /// numbers, its colour, the lines of text in it, and whether it has a red border.
    Cell([f64; 2], Colour, Vec<String>, bool),
    /// A label beside a point, moved up or down where another would be hit.
    Label([f64; 2], String, Colour),
}

impl Layer {
    /// Returns a line through points in the order of the horizontal axis.
    #[must_use]
    pub(crate) fn curve(
        points: impl Iterator<Item = [f64; 2]>,
        colour: Colour,
        width: f64,
    ) -> Layer {
        let mut points: Vec<[f64; 2]> = points.collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Layer::Line(points, colour, width)
    }

    /// Returns an interval at a place along the horizontal axis: a line from its lower to its upper end, and a mark
    /// at its middle, with words to hover over.
    #[must_use]
    pub(crate) fn interval(x: f64, ends: [f64; 3], mark: Mark, hover: String) -> [Layer; 2] {
        let [low, middle, high] = ends;
        let line = Layer::Line(vec![[x, low], [x, high]], mark.colour, 2.0);
        [line, Layer::Mark([x, middle], mark, hover)]
    }
}

/// A mark at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mark {
    /// The shape.
    pub(crate) shape: Shape,
    /// The colour.
    pub(crate) colour: Colour,
    /// Half of the height, in pixels.
    pub(crate) size: f64,
    /// Whether the mark is an outline.
    pub(crate) is_hollow: bool,
}

impl Mark {
    /// Returns a filled mark of the usual size.
    #[must_use]
    pub(crate) const fn new(shape: Shape, colour: Colour) -> Mark {
        Mark {
            shape,
            colour,
            size: 4.5,
            is_hollow: false,
        }
    }

    /// Returns the mark in another size.
    #[must_use]
    pub(crate) const fn sized(self, size: f64) -> Mark {
        Mark { size, ..self }
    }
}

/// The shape of a mark: its outline around the origin, about as large as a disc of radius 1, and whether it is made
/// of strokes alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shape(&'static str, bool);

impl Shape {
    /// A disc.
    pub(crate) const DISC: Shape = Shape("M-1 0a1 1 0 1 0 2 0a1 1 0 1 0-2 0", false);
    /// A square.
    pub(crate) const SQUARE: Shape = Shape("M-.9-.9H.9V.9H-.9Z", false);
    /// A square on its corner.
    pub(crate) const DIAMOND: Shape = Shape("M0-1.3L1.1 0L0 1.3L-1.1 0Z", false);
    /// A triangle that points up.
    pub(crate) const UP: Shape = Shape("M0-1.2L1.1.9H-1.1Z", false);
    /// A triangle that points down.
    pub(crate) const DOWN: Shape = Shape("M0 1.2L1.1-.9H-1.1Z", false);
    /// A triangle that points to the left.
    pub(crate) const LEFT: Shape = Shape("M-1.2 0L.9-1.1V1.1Z", false);
    /// A triangle that points to the right.
    pub(crate) const RIGHT: Shape = Shape("M1.2 0L-.9-1.1V1.1Z", false);
    /// Two crossed diagonal strokes.
    pub(crate) const CROSS: Shape = Shape("M-1-1L1 1M-1 1L1-1", true);
    /// Two crossed strokes along the axes.
    pub(crate) const PLUS: Shape = Shape("M-1.2 0H1.2M0-1.2V1.2", true);
    /// A circle around another mark.
    pub(crate) const RING: Shape = Shape("M-1 0a1 1 0 1 0 2 0a1 1 0 1 0-2 0", true);
}

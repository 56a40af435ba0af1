//! The elements of an SVG file: texts, lines, rectangles and marks, one per line.

use std::fmt::Write as _;

use super::{Colour, Mark, Shape};

/// The mean width of a letter, as a fraction of the size of its text; wide, as fonts differ.
const LETTER: f64 = 0.56;

/// Attributes of texts: their weight, where they begin, and a white edge for those that cross a line.
pub(super) const BOLD: &str = " font-weight=\"bold\"";
pub(super) const MIDDLE: &str = " text-anchor=\"middle\"";
pub(super) const END: &str = " text-anchor=\"end\"";
pub(super) const HALO: &str = " paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"3\"";

/// The attribute of a text that is read upward, turned about its place.
pub(super) fn upward([x, y]: Place) -> String {
    format!("{MIDDLE} transform=\"rotate(-90 {x:.1} {y:.1})\"")
}

/// A place in pixels: to the right and down.
pub(super) type Place = [f64; 2];

/// The size of a text in pixels, its colour, and its attributes.
pub(super) type Style<'a> = (f64, Colour, &'a str);

/// The text of an SVG file.
#[derive(Default)]
pub(super) struct Canvas {
    text: String,
}

impl Canvas {
    /// The file of a picture of this size in pixels.
    pub(super) fn finish(self, [width, height]: [f64; 2]) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}</svg>\n",
            self.text
        )
    }

    fn element(&mut self, element: std::fmt::Arguments<'_>) {
        writeln!(self.text, "{element}").expect("a string grows");
    }

    pub(super) fn text(&mut self, text: &str, [x, y]: Place, style: Style<'_>) {
        let (size, colour, attributes) = style;
        if !text.is_empty() {
            self.element(format_args!(
                "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"{}\"{attributes}>{}</text>",
                hex(colour),
                escaped(text)
            ));
        }
    }

    /// Writes a paragraph from a first line at this place on; returns where the next line would stand.
    pub(super) fn paragraph(&mut self, text: &str, at: Place, width: f64, style: Style<'_>) -> f64 {
        let [x, mut y] = at;
        for line in wrapped(text, width, style.0) {
            self.text(&line, [x, y], style);
            y += style.0 + 4.0;
        }
        y
    }

    /// Draws a line from point to point, without those that have no place. `stroke` has its width or its dashes.
    pub(super) fn line(&mut self, points: &[[f64; 2]], colour: Colour, stroke: &str) {
        let points = points
            .iter()
            .filter(|[x, y]| x.is_finite() && y.is_finite());
        let points: Vec<String> = points.map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        if points.len() > 1 {
            let (points, colour) = (points.join(" "), hex(colour));
            self.element(format_args!(
                "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" {stroke}/>"
            ));
        }
    }

    /// Draws a rectangle between its upper left and its lower right corner.
    pub(super) fn rectangle(&mut self, [a, b]: [[f64; 2]; 2], fill: Colour, attributes: &str) {
        let (width, height, fill) = (b[0] - a[0], b[1] - a[1], hex(fill));
        self.element(format_args!(
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{fill}\"{attributes}/>",
            a[0], a[1]
        ));
    }

    /// Draws a mark, with words that appear where the pointer rests on it.
    pub(super) fn mark(&mut self, mark: Mark, [x, y]: Place, hover: &str) {
        if !(x.is_finite() && y.is_finite()) {
            return;
        }
        // Outlines are drawn in the size that they have, and scaled with their strokes.
        let Shape(path, is_stroke) = mark.shape;
        let colour = hex(mark.colour);
        let (fill, stroke, width) = match (is_stroke, mark.is_hollow) {
            (true, is_thin) => ("none", &*colour, if is_thin { 1.0 } else { 2.0 }),
            (false, true) => ("#fff", &*colour, 1.3),
            (false, false) => (&*colour, "#fff", 0.6),
        };
        let width = width / mark.size;
        let title = format!("<title>{}</title>", escaped(hover));
        let title = if hover.is_empty() { "" } else { &title };
        self.element(format_args!(
            "<path d=\"{path}\" transform=\"translate({x:.1} {y:.1}) scale({:.1})\" fill=\"{fill}\" \
             stroke=\"{stroke}\" stroke-width=\"{width:.2}\">{title}</path>",
            mark.size
        ));
    }
}

/// How wide a text is about, in pixels.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    LETTER * size * text.chars().count() as f64
}

/// The lines of a text that is no wider than this.
fn wrapped(text: &str, width: f64, size: f64) -> Vec<String> {
    let letters = (width / (LETTER * size)) as usize;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(last) if last.chars().count() + word.chars().count() < letters => {
                last.push(' ');
                last.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

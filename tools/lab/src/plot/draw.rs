//! The drawing of a figure as SVG: where its parts stand, in pixels.

use super::axis::Placed;
use super::canvas::{BOLD, Canvas, END, HALO, MIDDLE, Style, text_width, upward};
use super::{Colour, Figure, GREY, INK, Layer, Mark, PALE, PINK, Panel, Strip};

/// The margin around a figure, in pixels.
const MARGIN: f64 = 16.0;
/// The height of a strip of a panel.
const STRIP: f64 = 26.0;
/// The size of the text in panels, but for the labels of axes.
const SMALL: f64 = 11.0;

const TITLE: Style<'_> = (19.0, INK, BOLD);
const ABOUT: Style<'_> = (12.0, GREY, "");
const HEAD: Style<'_> = (14.0, INK, BOLD);
const REMARK: Style<'_> = (SMALL, GREY, "");
const WORDS: Style<'_> = (12.0, INK, "");

const GRID: Colour = [0xe2; 3];
const THIN: &str = "stroke-width=\"1\"";
const DASHED: &str = "stroke-dasharray=\"5 4\"";
const RED_BORDER: &str = " stroke=\"#cc0000\" stroke-width=\"3\"";

/// Returns a figure as the text of an SVG file.
#[must_use]
pub(crate) fn svg(figure: &Figure) -> String {
    let (columns, size) = figure.layout;
    let (columns, panel_width) = (columns.max(1), size[0]);
    let inner = (panel_width * columns as f64).max(640.0);
    let mut canvas = Canvas::default();
    let mut y = MARGIN + TITLE.0;
    y = canvas.paragraph(&figure.title, [MARGIN, y], inner, TITLE);
    y = canvas.paragraph(&figure.about, [MARGIN, y], inner, ABOUT);
    y = legend(&mut canvas, &figure.legend, y + 4.0, inner);
    for row in figure.panels.chunks(columns) {
        let top = y;
        for (i, panel) in row.iter().enumerate() {
            let corner = [MARGIN + panel_width * i as f64, top];
            y = y.max(draw_panel(&mut canvas, panel, [corner, size]));
        }
    }
    y += 10.0;
    for paragraph in &figure.footer {
        y = canvas.paragraph(paragraph, [MARGIN, y], inner, REMARK);
    }
    canvas.finish([inner + 2.0 * MARGIN, y + MARGIN])
}

/// Draws the entries of a legend in rows, and returns where the next part begins.
fn legend(canvas: &mut Canvas, entries: &[(Mark, String)], top: f64, inner: f64) -> f64 {
    let (mut x, mut y) = (MARGIN + 6.0, top);
    for (mark, text) in entries {
        let width = 30.0 + text_width(text, WORDS.0);
        if x + width > MARGIN + inner {
            (x, y) = (MARGIN + 6.0, y + 18.0);
        }
        canvas.mark(*mark, [x, y], "");
        canvas.text(text, [x + 11.0, y + 4.0], WORDS);
        x += width;
    }
    if entries.is_empty() { top } else { y + 16.0 }
}

/// A panel between its axes, without strips, and the rectangles that marks and labels take up.
struct Frame<'a> {
    x: Placed<'a>,
    y: Placed<'a>,
    taken: Vec<[f64; 4]>,
}

impl Frame<'_> {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.x.at(x), self.y.at(y)]
    }
}

/// Draws a panel with the words under it, and returns where it ends.
fn draw_panel(canvas: &mut Canvas, panel: &Panel, [at, size]: [[f64; 2]; 2]) -> f64 {
    let ([left, top], [width, height]) = (at, size);
    let y = canvas.paragraph(&panel.title, [left, top + HEAD.0], width - 16.0, HEAD);
    let y = canvas.paragraph(&panel.about, [left, y], width - 20.0, REMARK);
    let names = panel.y.names.iter().map(|name| text_width(name, SMALL));
    let across = [
        left + names.fold(40.0, f64::max) + 20.0,
        left + width - 18.0,
    ];
    let strip = if panel.above.is_some() { STRIP } else { 0.0 };
    let upward = [top + height - 44.0, y - 4.0 + strip];
    let marks = panel.above.iter().flat_map(|strip| &strip.marks);
    let marks = marks.map(|(x, ..)| [*x, f64::NAN]);
    let points: Vec<[f64; 2]> = panel.layers.iter().flat_map(points).chain(marks).collect();
    let mut frame = Frame {
        x: panel.x.placed(points.iter().map(|at| at[0]), across),
        y: panel.y.placed(points.iter().map(|at| at[1]), upward),
        taken: Vec::new(),
    };
    axes(canvas, panel, &frame);
    if let Some(strip) = &panel.above {
        draw_strip(canvas, &frame, strip);
    }
    // Labels come last, so that they keep clear of all marks.
    let layers = panel.layers.iter();
    let (labels, others): (Vec<&Layer>, Vec<&Layer>) =
        layers.partition(|layer| matches!(layer, Layer::Label(..)));
    for layer in others.into_iter().chain(labels) {
        draw_layer(canvas, &mut frame, layer);
    }
    let mut y = top + height + 10.0;
    for words in &panel.words {
        y = canvas.paragraph(words, [left, y], width - 30.0, WORDS);
    }
    y + 4.0
}

/// The points that an axis is fitted to.
fn points(layer: &Layer) -> Vec<[f64; 2]> {
    match layer {
        Layer::Line(points, ..) => points.clone(),
        Layer::Mark(at, ..) | Layer::Label(at, ..) => vec![*at],
        Layer::Cell(at, ..) => vec![*at, at.map(|corner| corner + 1.0)],
        Layer::Rule(..) | Layer::Band(_) => Vec::new(),
    }
}

fn axes(canvas: &mut Canvas, panel: &Panel, frame: &Frame<'_>) {
    let ([left, right], [bottom, top]) = (frame.x.pixels, frame.y.pixels);
    for (at, text) in frame.x.ticks() {
        if panel.x.names.is_empty() {
            canvas.line(&[[at, top], [at, bottom]], GRID, THIN);
        }
        canvas.text(&text, [at, bottom + 15.0], (SMALL, INK, MIDDLE));
    }
    for (at, text) in frame.y.ticks() {
        if panel.y.names.is_empty() {
            canvas.line(&[[left, at], [right, at]], GRID, THIN);
        }
        canvas.text(&text, [left - 7.0, at + 4.0], (SMALL, INK, END));
    }
    if panel.y.names.is_empty() {
        let corner = [[left, top], [left, bottom], [right, bottom]];
        canvas.line(&corner, GREY, THIN);
    }
    let at = [0.5 * (left + right), bottom + 33.0];
    canvas.text(&panel.x.label, at, (12.0, GREY, MIDDLE));
    let at = [left - 46.0, 0.5 * (top + bottom)];
    canvas.text(&panel.y.label, at, (12.0, GREY, &upward(at)));
}

/// Draws a strip above a panel.
fn draw_strip(canvas: &mut Canvas, frame: &Frame<'_>, strip: &Strip) {
    let ([left, right], [_, bottom]) = (frame.x.pixels, frame.y.pixels);
    let top = bottom - STRIP;
    canvas.rectangle([[left, top], [right, bottom]], PINK, "");
    canvas.text(&strip.label, [left + 4.0, top + 11.0], REMARK);
    let marks = strip.marks.iter();
    let marks = marks.map(|(x, mark, hover)| (frame.x.at(*x).clamp(left, right), mark, hover));
    let mut marks: Vec<(f64, &Mark, &String)> = marks.collect();
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Marks at one place are moved apart to the right, and back from the end.
    let (mut next, mut limit) = (f64::NEG_INFINITY, right);
    for (at, ..) in &mut marks {
        *at = at.max(next);
        next = *at + 6.0;
    }
    for (at, mark, hover) in marks.iter_mut().rev() {
        *at = at.min(limit);
        limit = *at - 6.0;
        canvas.mark(mark.sized(3.0), [*at, bottom - 7.0], hover);
    }
}

fn draw_layer(canvas: &mut Canvas, frame: &mut Frame<'_>, layer: &Layer) {
    let ([left, right], [bottom, top]) = (frame.x.pixels, frame.y.pixels);
    match layer {
        Layer::Band(y) => {
            // A number without a place, such as 0 on a logarithmic axis, is at the lower end.
            let [upper, lower] = [y.end, y.start].map(|y| frame.y.at(y).min(bottom).max(top));
            if upper < lower {
                canvas.rectangle([[left, upper], [right, lower]], PALE, "");
            }
        }
        Layer::Rule(x, label) => {
            let at = frame.x.at(*x);
            if left <= at && at <= right {
                canvas.line(&[[at, top], [at, bottom]], GREY, DASHED);
                canvas.text(label, [at + 4.0, top + 11.0], (SMALL, GREY, HALO));
            }
        }
        Layer::Line(points, colour, width) => {
            let points: Vec<[f64; 2]> = points.iter().map(|&point| frame.at(point)).collect();
            canvas.line(&points, *colour, &format!("stroke-width=\"{width}\""));
        }
        Layer::Mark(at, mark, hover) => {
            let [x, y] = frame.at(*at);
            let half = mark.size;
            frame.taken.push([x - half, y - half, x + half, y + half]);
            canvas.mark(*mark, [x, y], hover);
        }
        Layer::Cell(at, colour, lines, is_marked) => {
            let [a, b] = [frame.at(*at), frame.at(at.map(|corner| corner + 1.0))];
            let corners = [[a[0] + 1.0, b[1] + 1.0], [b[0] - 1.0, a[1] - 1.0]];
            canvas.rectangle(corners, *colour, if *is_marked { RED_BORDER } else { "" });
            let first = 0.5 * (a[1] + b[1]) + 4.0 - 6.5 * (lines.len() as f64 - 1.0);
            for (i, line) in lines.iter().enumerate() {
                let at = [0.5 * (a[0] + b[0]), first + 13.0 * i as f64];
                canvas.text(line, at, (SMALL, INK, MIDDLE));
            }
        }
        Layer::Label(at, text, colour) => {
            let [x, y] = place_label(frame, *at, text_width(text, SMALL));
            canvas.text(text, [x, y], (SMALL, *colour, HALO));
        }
    }
}

/// The place of a label to the right of a point, or to the left where there is no room, at the nearest height at
/// which it hits no other.
fn place_label(frame: &mut Frame<'_>, at: [f64; 2], width: f64) -> [f64; 2] {
    let ([_, right], [bottom, top]) = (frame.x.pixels, frame.y.pixels);
    let [x, y] = frame.at(at);
    let has_room = x + 8.0 + width <= right + 14.0;
    let left = if has_room { x + 8.0 } else { x - 8.0 - width };
    let around = |y: f64| [left, y - 6.0, left + width, y + 6.0];
    let offsets = (0..40).map(|i| f64::from((i + 1) / 2) * if i % 2 == 0 { 6.0 } else { -6.0 });
    let hits = |a: &[f64; 4], b: &[f64; 4]| {
        a[0] < b[2] && b[0] < a[2] && a[1] < b[3] - 0.1 && b[1] < a[3] - 0.1
    };
    let is_free = |place: &[f64; 4]| {
        let is_inside = top <= place[1] && place[3] <= bottom;
        is_inside && !frame.taken.iter().any(|other| hits(place, other))
    };
    let mut places = offsets.map(|offset| around(y + offset));
    let place = places.find(is_free).unwrap_or(around(y));
    frame.taken.push(place);
    [left, place[3] - 2.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Axis, Shape};

    /// A figure of one panel with these layers.
    fn drawn(x: Axis, layers: Vec<Layer>) -> String {
        let panel = Panel {
            x,
            y: Axis::linear("y"),
            layers,
            ..Panel::default()
        };
        svg(&Figure {
            layout: (1, [400.0, 300.0]),
            panels: vec![panel],
            ..Figure::default()
        })
    }

    /// Axes are fitted to the points: the outer ones stand near the ends, and the others in proportion between.
    #[test]
    fn points_stand_between_the_ends_of_the_axes_in_proportion() {
        let mark = |at| Layer::Mark(at, Mark::new(Shape::DISC, INK), String::new());
        let marks = vec![mark([1.0, 0.0]), mark([100.0, 10.0]), mark([10.0, 5.0])];
        let text = drawn(Axis::log("x"), marks);
        let marks = text.split("translate(").skip(1);
        let at: Vec<[f64; 2]> = marks
            .map(|mark| {
                let (place, _) = mark.split_once(')').expect("its end");
                let (x, y) = place.split_once(' ').expect("two numbers");
                [x, y].map(|number| number.parse().expect("a number"))
            })
            .collect();
        let [low, high, middle] = at[..] else {
            panic!("{text}");
        };
        for i in 0..2 {
            assert!(
                (0.5 * (low[i] + high[i]) - middle[i]).abs() < 0.11,
                "{at:?}"
            );
        }
        assert!(
            high[0] - low[0] > 250.0 && low[1] - high[1] > 180.0,
            "{at:?}"
        );
    }

    #[test]
    fn a_label_keeps_clear_of_marks_that_are_listed_after_it() {
        let mark = |at| Layer::Mark(at, Mark::new(Shape::DISC, INK), String::new());
        let label = Layer::Label([1.0, 1.0], "label".to_owned(), INK);
        let marks = [[1.0, 1.0], [1.1, 1.0], [2.0, 2.0]].map(mark).to_vec();
        let place = |layers: [Vec<Layer>; 2]| {
            let text = drawn(Axis::linear("x"), layers.concat());
            let line = text.lines().find(|line| line.ends_with(">label</text>"));
            line.expect("a label").to_owned()
        };
        let label = vec![label];
        let last = place([marks.clone(), label.clone()]);
        assert_eq!(place([label.clone(), marks]), last);
        assert_ne!(place([label, vec![mark([2.0, 2.0])]]), last);
    }

    #[test]
    fn labels_at_one_point_stand_apart() {
        let label = |text: &str| Layer::Label([1.0, 1.0], text.to_owned(), INK);
        let labels = vec![label("first <&>"), label("second"), label("third")];
        let drawn = drawn(Axis::linear("x"), labels);
        let mut heights = ["first &lt;&amp;&gt;", "second", "third"].map(|text| {
            let (before, _) = drawn.split_once(&format!(">{text}<")).expect("a label");
            let (_, height) = before.rsplit_once(" y=\"").expect("a height");
            let (height, _) = height.split_once('"').expect("its end");
            height.parse::<f64>().expect("a number")
        });
        heights.sort_unstable_by(f64::total_cmp);
        let mut gaps = heights.windows(2).map(|two| two[1] - two[0]);
        assert!(gaps.all(|gap| gap >= 11.0), "{heights:?}");
    }
}

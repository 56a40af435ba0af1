//! The drawing of a figure as SVG: a layout in pixels, and one element of SVG per line.

use std::fmt::Write as _;
use std::ops::Range;

use super::{Axis, Colour, Figure, GREY, INK, Layer, Mark, PINK, Panel, Shape, Strip};

/// The margin around a figure, in pixels.
const MARGIN: f64 = 16.0;
/// The height of a line of text of the usual size.
const LINE: f64 = 16.0;
/// The sizes of text: titles, titles of panels, all else, and numbers along axes.
const TITLE: f64 = 19.0;
const HEAD: f64 = 14.0;
const TEXT: f64 = 12.0;
const SMALL: f64 = 11.0;
/// The mean width of a letter, as a fraction of the size of its text; wide, as fonts differ.
const LETTER: f64 = 0.56;
/// The height of a strip of a panel.
const STRIP: f64 = 26.0;

/// Returns a figure as the text of an SVG file.
#[must_use]
pub fn svg(figure: &Figure) -> String {
    let columns = figure.columns.max(1);
    let [panel_width, _] = figure.panel_size;
    let width = (panel_width * columns as f64).max(640.0) + 2.0 * MARGIN;
    let inner = width - 2.0 * MARGIN;
    let mut canvas = Canvas::default();
    let mut y = MARGIN + TITLE;
    for line in wrapped(&figure.title, letters(inner, TITLE)) {
        canvas.text(&line, [MARGIN, y], Style::new(TITLE, INK).bold());
        y += TITLE + 5.0;
    }
    y = canvas.paragraph(&figure.about, [MARGIN, y], inner, TEXT, GREY);
    y = legend(&mut canvas, figure, y + 4.0, inner);
    for row in figure.panels.chunks(columns) {
        let words = row.iter().map(|panel| words_height(panel, panel_width));
        let height = figure.panel_size[1] + words.fold(0.0, f64::max);
        for (i, panel) in row.iter().enumerate() {
            let corner = [MARGIN + panel_width * i as f64, y];
            draw_panel(&mut canvas, panel, corner, figure.panel_size);
        }
        y += height;
    }
    y += 10.0;
    for paragraph in &figure.footer {
        y = canvas.paragraph(paragraph, [MARGIN, y], inner, SMALL, GREY);
    }
    canvas.finish([width, y + MARGIN])
}

/// How many letters fit into a width.
fn letters(width: f64, size: f64) -> usize {
    (width / (LETTER * size)) as usize
}

fn text_width(text: &str, size: f64) -> f64 {
    LETTER * size * text.chars().count() as f64
}

fn legend(canvas: &mut Canvas, figure: &Figure, top: f64, inner: f64) -> f64 {
    let (mut x, mut y) = (MARGIN + 6.0, top);
    for (mark, text) in &figure.legend {
        let width = 30.0 + text_width(text, TEXT);
        if x + width > MARGIN + inner {
            (x, y) = (MARGIN + 6.0, y + LINE + 2.0);
        }
        canvas.mark(*mark, [x, y], "");
        canvas.text(text, [x + 11.0, y + 4.0], Style::new(TEXT, INK));
        x += width;
    }
    match figure.legend.is_empty() {
        true => top,
        false => y + LINE,
    }
}

fn words_height(panel: &Panel, width: f64) -> f64 {
    let lines = panel.words.iter();
    let lines = lines.map(|words| wrapped(words, letters(width - 30.0, TEXT)).len());
    lines.sum::<usize>() as f64 * LINE + 14.0
}

/// A panel's rectangle between its axes in pixels, and the numbers at the ends of these.
struct Frame<'a> {
    panel: &'a Panel,
    /// Left and right, top and bottom, without strips.
    x: Range<f64>,
    y: Range<f64>,
    of_x: Range<f64>,
    of_y: Range<f64>,
}

impl Frame<'_> {
    fn at_x(&self, number: f64) -> f64 {
        self.x.start + self.panel.x.place(number, &self.of_x) * (self.x.end - self.x.start)
    }

    fn at_y(&self, number: f64) -> f64 {
        self.y.end - self.panel.y.place(number, &self.of_y) * (self.y.end - self.y.start)
    }

    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.at_x(x), self.at_y(y)]
    }
}

fn draw_panel(
    canvas: &mut Canvas,
    panel: &Panel,
    [left, top]: [f64; 2],
    [width, height]: [f64; 2],
) {
    let mut y = top + HEAD;
    for line in wrapped(&panel.title, letters(width - 16.0, HEAD)) {
        canvas.text(&line, [left, y], Style::new(HEAD, INK).bold());
        y += HEAD + 3.0;
    }
    y = canvas.paragraph(&panel.about, [left, y], width - 20.0, SMALL, GREY);
    let names = panel.y.names.iter().map(|name| text_width(name, SMALL));
    let axis = names.fold(40.0, f64::max) + 20.0;
    let strip = |strip: &Option<Strip>| if strip.is_some() { STRIP } else { 0.0 };
    let bottom = top + height - 44.0 - strip(&panel.below);
    let frame = Frame {
        panel,
        x: left + axis..left + width - 18.0,
        y: y - 4.0 + strip(&panel.above)..bottom,
        of_x: panel.x.fitted(numbers(panel, 0)),
        of_y: panel.y.fitted(numbers(panel, 1)),
    };
    axes(canvas, &frame);
    for (strip, y) in [
        (&panel.above, frame.y.start - STRIP),
        (&panel.below, frame.y.end),
    ] {
        if let Some(strip) = strip {
            draw_strip(canvas, &frame, strip, y);
        }
    }
    let mut taken: Vec<[f64; 4]> = Vec::new();
    for layer in &panel.layers {
        draw_layer(canvas, &frame, layer, &mut taken);
    }
    let mut y = top + height + 10.0;
    for words in &panel.words {
        y = canvas.paragraph(words, [left, y], width - 30.0, TEXT, INK);
    }
}

/// The numbers along an axis that a panel draws: 0 is the horizontal one.
fn numbers(panel: &Panel, axis: usize) -> impl Iterator<Item = f64> + '_ {
    let layers = panel.layers.iter().flat_map(move |layer| match layer {
        Layer::Line { points, .. } => points.iter().map(|point| point[axis]).collect(),
        Layer::Mark { at, .. } | Layer::Ring { at, .. } | Layer::Label { at, .. } => {
            vec![at[axis]]
        }
        Layer::Interval { x, y, .. } => match axis {
            0 => vec![*x],
            _ => y.to_vec(),
        },
        Layer::Cell { at, .. } => vec![at[axis], at[axis] + 1.0],
        Layer::Rule { .. } | Layer::Band { .. } => Vec::new(),
    });
    let strips = [&panel.above, &panel.below].into_iter().flatten();
    let strips = strips.flat_map(|strip| strip.marks.iter().map(|(x, ..)| *x));
    layers.chain(strips.filter(move |_| axis == 0))
}

fn axes(canvas: &mut Canvas, frame: &Frame<'_>) {
    let Frame { panel, x, y, .. } = frame;
    let is_map = |axis: &Axis| !axis.names.is_empty();
    let strip = if panel.below.is_some() { STRIP } else { 0.0 };
    let bottom = y.end + strip;
    for (number, text) in panel.x.ticks(&frame.of_x) {
        let at = frame.at_x(number);
        if !is_map(&panel.x) {
            canvas.line(&[[at, y.start], [at, bottom]], [0xe2; 3], 1.0);
        }
        canvas.text(&text, [at, bottom + 15.0], Style::new(SMALL, INK).middle());
    }
    for (number, text) in panel.y.ticks(&frame.of_y) {
        let at = frame.at_y(number);
        if !is_map(&panel.y) {
            canvas.line(&[[x.start, at], [x.end, at]], [0xe2; 3], 1.0);
        }
        canvas.text(
            &text,
            [x.start - 7.0, at + 4.0],
            Style::new(SMALL, INK).end(),
        );
    }
    if !is_map(&panel.y) {
        canvas.line(
            &[[x.start, y.start], [x.start, bottom], [x.end, bottom]],
            GREY,
            1.0,
        );
    }
    let middle = 0.5 * (x.start + x.end);
    let style = Style::new(TEXT, GREY).middle();
    canvas.text(&panel.x.label, [middle, bottom + 33.0], style);
    let middle = 0.5 * (y.start + y.end);
    let left = x.start - 46.0;
    canvas.text(&panel.y.label, [left, middle], style.upward());
}

fn draw_strip(canvas: &mut Canvas, frame: &Frame<'_>, strip: &Strip, top: f64) {
    let corners = [[frame.x.start, top], [frame.x.end, top + STRIP]];
    canvas.rectangle(corners, PINK, None);
    canvas.text(
        &strip.label,
        [frame.x.start + 4.0, top + 11.0],
        Style::new(SMALL, GREY),
    );
    let mut marks: Vec<(f64, Mark, &str)> = strip
        .marks
        .iter()
        .map(|(x, mark, hover)| {
            let at = frame.at_x(*x).clamp(frame.x.start, frame.x.end);
            (at, *mark, hover.as_str())
        })
        .collect();
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Marks at one place are moved apart to the right, and back from the end.
    let (mut next, mut limit) = (f64::NEG_INFINITY, frame.x.end);
    for (at, ..) in &mut marks {
        *at = at.max(next);
        next = *at + 6.0;
    }
    for (at, mark, hover) in marks.iter_mut().rev() {
        *at = at.min(limit);
        limit = *at - 6.0;
        canvas.mark(mark.sized(3.0), [*at, top + STRIP - 7.0], hover);
    }
}

fn draw_layer(canvas: &mut Canvas, frame: &Frame<'_>, layer: &Layer, taken: &mut Vec<[f64; 4]>) {
    match layer {
        Layer::Band { y, colour } => {
            let [top, bottom] = [y.end, y.start].map(|end| {
                let place = frame.panel.y.place(end, &frame.of_y);
                let place = if place.is_nan() {
                    0.0
                } else {
                    place.clamp(0.0, 1.0)
                };
                frame.y.end - place * (frame.y.end - frame.y.start)
            });
            if bottom > top {
                canvas.rectangle([[frame.x.start, top], [frame.x.end, bottom]], *colour, None);
            }
        }
        Layer::Rule { x, label } => {
            let at = frame.at_x(*x);
            if frame.x.start <= at && at <= frame.x.end {
                let ends = [[at, frame.y.start], [at, frame.y.end]];
                canvas.dashed(&ends, GREY);
                let style = Style::new(SMALL, GREY).halo();
                canvas.text(label, [at + 4.0, frame.y.start + 11.0], style);
            }
        }
        Layer::Line {
            points,
            colour,
            width,
        } => {
            let points: Vec<[f64; 2]> = points.iter().map(|&point| frame.at(point)).collect();
            canvas.line(&points, *colour, *width);
        }
        Layer::Mark { at, mark, hover } => {
            let at = frame.at(*at);
            taken.push([at[0] - 4.0, at[1] - 4.0, at[0] + 4.0, at[1] + 4.0]);
            canvas.mark(*mark, at, hover);
        }
        Layer::Ring { at, colour, hover } => {
            let ([x, y], colour) = (frame.at(*at), hex(*colour));
            let title = hovered(hover);
            canvas.element(format_args!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"7.5\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\">{title}</circle>"
            ));
        }
        Layer::Interval { x, y, colour } => {
            let at = frame.at_x(*x);
            let [low, middle, high] = y.map(|number| frame.at_y(number));
            canvas.line(&[[at, low], [at, high]], *colour, 2.0);
            for end in [low, high] {
                canvas.line(&[[at - 3.0, end], [at + 3.0, end]], *colour, 1.0);
            }
            canvas.mark(Mark::new(Shape::Disc, *colour).sized(3.5), [at, middle], "");
        }
        Layer::Cell {
            at,
            colour,
            lines,
            is_marked,
        } => {
            let [a, b] = [frame.at(*at), frame.at([at[0] + 1.0, at[1] + 1.0])];
            let corners = [[a[0] + 1.0, b[1] + 1.0], [b[0] - 1.0, a[1] - 1.0]];
            let border = is_marked.then_some([0xcc, 0, 0]);
            canvas.rectangle(corners, *colour, border);
            let middle = 0.5 * (a[0] + b[0]);
            let first = 0.5 * (a[1] + b[1]) + 4.0 - 6.5 * (lines.len() as f64 - 1.0);
            for (i, line) in lines.iter().enumerate() {
                let style = Style::new(SMALL, INK).middle();
                canvas.text(line, [middle, first + 13.0 * i as f64], style);
            }
        }
        Layer::Label { at, text, colour } => label(canvas, frame, *at, text, *colour, taken),
    }
}

/// Writes a label to the right of a point, or to the left where there is no room, at the nearest height at
/// which it hits no other.
fn label(
    canvas: &mut Canvas,
    frame: &Frame<'_>,
    at: [f64; 2],
    text: &str,
    colour: Colour,
    taken: &mut Vec<[f64; 4]>,
) {
    let [x, y] = frame.at(at);
    let width = text_width(text, SMALL);
    let left = match x + 8.0 + width > frame.x.end + 14.0 {
        true => x - 8.0 - width,
        false => x + 8.0,
    };
    let offsets = (0..40).map(|i| f64::from((i + 1) / 2) * if i % 2 == 0 { 6.0 } else { -6.0 });
    let boxes = offsets.map(|offset| [left, y + offset - 6.0, left + width, y + offset + 6.0]);
    let hits = |a: &[f64; 4], b: &[f64; 4]| {
        a[0] < b[2] && b[0] < a[2] && a[1] < b[3] - 0.1 && b[1] < a[3] - 0.1
    };
    let is_free = |place: &[f64; 4]| {
        let is_inside = frame.y.start <= place[1] && place[3] <= frame.y.end;
        is_inside && !taken.iter().any(|other| hits(place, other))
    };
    let fallback = [left, y - 6.0, left + width, y + 6.0];
    let place = boxes.into_iter().find(is_free).unwrap_or(fallback);
    taken.push(place);
    canvas.text(
        text,
        [left, place[3] - 2.0],
        Style::new(SMALL, colour).halo(),
    );
}

/// How a text is written.
#[derive(Clone, Copy)]
struct Style {
    size: f64,
    colour: Colour,
    attributes: &'static str,
    has_halo: bool,
    is_upward: bool,
}

impl Style {
    fn new(size: f64, colour: Colour) -> Style {
        Style {
            size,
            colour,
            attributes: "",
            has_halo: false,
            is_upward: false,
        }
    }

    fn bold(self) -> Style {
        let attributes = " font-weight=\"bold\"";
        Style { attributes, ..self }
    }

    fn middle(self) -> Style {
        let attributes = " text-anchor=\"middle\"";
        Style { attributes, ..self }
    }

    fn end(self) -> Style {
        let attributes = " text-anchor=\"end\"";
        Style { attributes, ..self }
    }

    fn halo(self) -> Style {
        let has_halo = true;
        Style { has_halo, ..self }
    }

    fn upward(self) -> Style {
        let is_upward = true;
        Style { is_upward, ..self }
    }
}

/// The text of an SVG file, element by element.
#[derive(Default)]
struct Canvas {
    text: String,
}

impl Canvas {
    fn element(&mut self, element: std::fmt::Arguments<'_>) {
        writeln!(self.text, "{element}").expect("a string grows");
    }

    fn finish(self, [width, height]: [f64; 2]) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}</svg>\n",
            self.text
        )
    }

    fn text(&mut self, text: &str, [x, y]: [f64; 2], style: Style) {
        if text.is_empty() {
            return;
        }
        let colour = hex(style.colour);
        let Style {
            size, attributes, ..
        } = style;
        let halo = match style.has_halo {
            true => " paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"3\"",
            false => "",
        };
        let turn = match style.is_upward {
            true => format!(" transform=\"rotate(-90 {x:.1} {y:.1})\""),
            false => String::new(),
        };
        self.element(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"{colour}\"{attributes}{halo}{turn}>{}</text>",
            escaped(text)
        ));
    }

    /// Writes a paragraph from a first line at this place on; returns where the next line would stand.
    fn paragraph(
        &mut self,
        text: &str,
        [x, mut y]: [f64; 2],
        width: f64,
        size: f64,
        colour: Colour,
    ) -> f64 {
        for line in wrapped(text, letters(width, size)) {
            self.text(&line, [x, y], Style::new(size, colour));
            y += size + 4.0;
        }
        y
    }

    fn line(&mut self, points: &[[f64; 2]], colour: Colour, width: f64) {
        self.stroke(points, colour, &format!("stroke-width=\"{width}\""));
    }

    fn dashed(&mut self, points: &[[f64; 2]], colour: Colour) {
        self.stroke(points, colour, "stroke-dasharray=\"5 4\"");
    }

    fn stroke(&mut self, points: &[[f64; 2]], colour: Colour, how: &str) {
        let finite = points
            .iter()
            .filter(|point| point.iter().all(|x| x.is_finite()));
        let points: Vec<String> = finite.map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        if points.len() > 1 {
            let (points, colour) = (points.join(" "), hex(colour));
            self.element(format_args!(
                "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" {how}/>"
            ));
        }
    }

    fn rectangle(&mut self, [a, b]: [[f64; 2]; 2], fill: Colour, border: Option<Colour>) {
        let border = border.map_or(String::new(), |colour| {
            format!(" stroke=\"{}\" stroke-width=\"3\"", hex(colour))
        });
        let (width, height, fill) = (b[0] - a[0], b[1] - a[1], hex(fill));
        self.element(format_args!(
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{fill}\"{border}/>",
            a[0], a[1]
        ));
    }

    fn mark(&mut self, mark: Mark, [x, y]: [f64; 2], hover: &str) {
        if !(x.is_finite() && y.is_finite()) {
            return;
        }
        let colour = hex(mark.colour);
        let paint = match mark.is_hollow {
            true => format!("fill=\"#fff\" stroke=\"{colour}\" stroke-width=\"1.3\""),
            false => format!("fill=\"{colour}\" stroke=\"#fff\" stroke-width=\"0.6\""),
        };
        let title = hovered(hover);
        let size = mark.size;
        match outline(mark.shape) {
            Outline::Disc => self.element(format_args!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{size:.1}\" {paint}>{title}</circle>"
            )),
            Outline::Closed(corners) => {
                let corners = corners.iter();
                let points: Vec<String> = corners
                    .map(|[dx, dy]| format!("{:.1},{:.1}", x + dx * size, y + dy * size))
                    .collect();
                let points = points.join(" ");
                self.element(format_args!(
                    "<polygon points=\"{points}\" {paint}>{title}</polygon>"
                ));
            }
            Outline::Strokes(strokes) => {
                let strokes = strokes.iter().map(|[[ax, ay], [bx, by]]| {
                    let [ax, bx] = [ax, bx].map(|dx| x + dx * size);
                    let [ay, by] = [ay, by].map(|dy| y + dy * size);
                    format!("M{ax:.1} {ay:.1}L{bx:.1} {by:.1}")
                });
                let path = strokes.collect::<String>();
                let width = if mark.is_hollow { 1.0 } else { 2.0 };
                self.element(format_args!(
                    "<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"{width}\">{title}</path>"
                ));
            }
        }
    }
}

/// The outline of a mark around the origin, about as large as a disc of radius 1.
enum Outline {
    Disc,
    Closed(&'static [[f64; 2]]),
    Strokes(&'static [[[f64; 2]; 2]]),
}

fn outline(shape: Shape) -> Outline {
    match shape {
        Shape::Disc => Outline::Disc,
        Shape::Square => Outline::Closed(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]),
        Shape::Diamond => Outline::Closed(&[[0.0, -1.3], [1.1, 0.0], [0.0, 1.3], [-1.1, 0.0]]),
        Shape::Up => Outline::Closed(&[[0.0, -1.2], [1.1, 0.9], [-1.1, 0.9]]),
        Shape::Down => Outline::Closed(&[[0.0, 1.2], [1.1, -0.9], [-1.1, -0.9]]),
        Shape::Left => Outline::Closed(&[[-1.2, 0.0], [0.9, -1.1], [0.9, 1.1]]),
        Shape::Right => Outline::Closed(&[[1.2, 0.0], [-0.9, -1.1], [-0.9, 1.1]]),
        Shape::Cross => Outline::Strokes(&[[[-1.0, -1.0], [1.0, 1.0]], [[-1.0, 1.0], [1.0, -1.0]]]),
        Shape::Plus => Outline::Strokes(&[[[-1.2, 0.0], [1.2, 0.0]], [[0.0, -1.2], [0.0, 1.2]]]),
    }
}

/// The words that appear where the pointer rests on an element.
fn hovered(words: &str) -> String {
    match words.is_empty() {
        true => String::new(),
        false => format!("<title>{}</title>", escaped(words)),
    }
}

fn hex([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

/// Returns lines of at most so many letters.
fn wrapped(text: &str, letters: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(last) if last.is_empty() => last.push_str(word),
            Some(last) if last.chars().count() + word.chars().count() < letters => {
                last.push(' ');
                last.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines.retain(|line| !line.is_empty());
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All places and sizes of a figure of two points are worked out by hand here: 100 × 100 pixels between
    /// the axes would be exact, so points at the ends of a range stand at the ends of the axes.
    #[test]
    fn points_at_the_ends_of_a_range_stand_at_the_ends_of_the_axes() {
        let mark = |at| Layer::Mark {
            at,
            mark: Mark::new(Shape::Disc, INK),
            hover: String::new(),
        };
        let figure = Figure {
            columns: 1,
            panel_size: [400.0, 300.0],
            panels: vec![Panel {
                x: Axis::log("x").from_to(1.0, 100.0),
                y: Axis::linear("y").from_to(0.0, 10.0),
                layers: vec![mark([1.0, 0.0]), mark([100.0, 10.0]), mark([10.0, 5.0])],
                ..Panel::default()
            }],
            ..Figure::default()
        };
        let text = svg(&figure);
        let discs = text.lines().filter(|line| line.starts_with("<circle"));
        let number = |line: &str, name: &str| -> f64 {
            let (_, rest) = line
                .split_once(&format!("{name}=\""))
                .expect("an attribute");
            let (number, _) = rest.split_once('"').expect("its end");
            number.parse().expect("a number")
        };
        let at: Vec<[f64; 2]> = discs
            .map(|line| [number(line, "cx"), number(line, "cy")])
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
    fn labels_at_one_point_stand_apart() {
        let label = |text: &str| Layer::Label {
            at: [1.0, 1.0],
            text: text.to_owned(),
            colour: INK,
        };
        let figure = Figure {
            columns: 1,
            panel_size: [400.0, 300.0],
            panels: vec![Panel {
                x: Axis::linear("x").from_to(0.0, 2.0),
                y: Axis::linear("y").from_to(0.0, 2.0),
                layers: vec![label("first <&>"), label("second"), label("third")],
                ..Panel::default()
            }],
            ..Figure::default()
        };
        let drawn = svg(&figure);
        let heights = ["first &lt;&amp;&gt;", "second", "third"].map(|text| {
            let line = drawn
                .lines()
                .find(|line| line.contains(&format!(">{text}<")));
            let line = line.expect("a label");
            let (_, rest) = line.split_once(" y=\"").expect("a height");
            rest.split('"')
                .next()
                .expect("a number")
                .parse::<f64>()
                .expect("a number")
        });
        for i in 0..3 {
            for j in 0..i {
                assert!((heights[i] - heights[j]).abs() >= 11.0, "{heights:?}");
            }
        }
    }
}

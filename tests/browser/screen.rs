//! What is on the screen: colours of pixels, and how far they are from lines.

use png::{ColorType, Decoder};

/// A picture of the page.
pub(crate) struct Screen {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Screen {
    /// Reads a PNG file.
    pub(crate) fn of(bytes: &[u8]) -> Screen {
        let mut reader = Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .expect("a PNG");
        let mut data = vec![0; reader.output_buffer_size().expect("a small picture")];
        let info = reader.next_frame(&mut data).expect("a picture");
        let channels = match info.color_type {
            ColorType::Rgb => 3,
            ColorType::Rgba => 4,
            other => panic!("pixels are {other:?}"),
        };
        let pixels = data[..info.buffer_size()].chunks_exact(channels);
        Screen {
            width: info.width as usize,
            height: info.height as usize,
            pixels: pixels.map(|p| [p[0], p[1], p[2]]).collect(),
        }
    }

    /// The middles of the pixels of some colour.
    pub(crate) fn places(&self, is_it: impl Fn([u8; 3]) -> bool) -> Vec<[f64; 2]> {
        let all = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        let found = all.filter(|&(x, y)| is_it(self.pixels[y * self.width + x]));
        found
            .map(|(x, y)| [x as f64 + 0.5, y as f64 + 0.5])
            .collect()
    }

    /// How many pixels differ from those of another picture of the same size.
    pub(crate) fn apart_from(&self, other: &Screen) -> usize {
        let pairs = self.pixels.iter().zip(&other.pixels);
        pairs.filter(|(a, b)| a != b).count()
    }

    /// How many colours there are.
    pub(crate) fn colors(&self) -> usize {
        self.pixels
            .iter()
            .collect::<std::collections::BTreeSet<_>>()
            .len()
    }
}

/// The colour of a trace, also where it shines through a blue face. Of the first three colours of pieces none
/// has less green than red and blue, nor has the edge of a red line as much blue as red.
pub(crate) fn is_trace([r, g, b]: [u8; 3]) -> bool {
    r.min(b) >= g.saturating_add(14) && b.saturating_add(20) >= r
}

/// The colour of what is torn.
pub(crate) fn is_seam([r, g, b]: [u8; 3]) -> bool {
    r > 150 && g < 90 && b < 90
}

/// The colour of a body.
pub(crate) fn is_grey([r, g, b]: [u8; 3]) -> bool {
    r.abs_diff(g) < 2 && g.abs_diff(b) < 2 && (60..190).contains(&r)
}

/// How far a place is from a segment.
pub(crate) fn distance(at: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let from = [at[0] - a[0], at[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let part = match square > 0.0 {
        true => ((from[0] * along[0] + from[1] * along[1]) / square).clamp(0.0, 1.0),
        false => 0.0,
    };
    apart(from, along.map(|x| x * part))
}

pub(crate) fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

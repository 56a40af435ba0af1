//! The colours of pictures and pages: each has its one home here.
//!
//! Pieces take turns in hues that people who confuse red and green can tell apart, by brightness if not
//! by hue. None of them is red, which is the colour of what was torn.

/// A colour, as red, green and blue from 0 to 255.
pub type Color = [u8; 3];

/// The surfaces of pieces, one after another; further ones take turns again.
pub const PIECES: [Color; 10] = [
    [111, 157, 205],
    [238, 180, 94],
    [116, 184, 158],
    [190, 160, 208],
    [226, 218, 118],
    [132, 202, 228],
    [208, 160, 128],
    [168, 196, 112],
    [164, 170, 182],
    [232, 170, 196],
];

/// The colours of all but the pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Theme {
    /// Where nothing is.
    pub background: Color,
    /// Torn edges.
    pub seam: Color,
    /// The boundary that a mesh had before anything was torn.
    pub boundary: Color,
    /// Edges between two faces.
    pub edge: Color,
    /// Where a cut would go, and the rays that it goes between.
    pub trace: Color,
    /// The box round all faces.
    pub bounding_box: Color,
}

/// The theme of pictures, and of pages by day.
pub const LIGHT: Theme = Theme {
    background: [250, 250, 247],
    seam: [214, 24, 31],
    boundary: [38, 44, 54],
    edge: [50, 60, 76],
    trace: [148, 0, 148],
    bounding_box: [140, 144, 150],
};

/// The theme of pages by night.
pub const DARK: Theme = Theme {
    background: [24, 26, 31],
    seam: [255, 62, 62],
    boundary: [228, 231, 236],
    edge: [16, 20, 28],
    trace: [255, 92, 255],
    bounding_box: [112, 118, 128],
};

/// The colour of a piece, by its number.
#[must_use]
pub fn piece(number: usize) -> Color {
    PIECES[number % PIECES.len()]
}

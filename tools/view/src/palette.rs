//! The colours of pictures and pages.
//!
//! People who confuse red and green can tell the colours of the pieces apart by hue or by brightness. No
//! piece is red, which is the colour of torn edges.

/// A colour: its red, green and blue parts, each from 0 to 255.
pub type Color = [u8; 3];

/// The surface colours of the pieces, by piece number. Further pieces repeat them: see [`piece`].
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

/// The colours of a picture or page, except those of the pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Theme {
    /// The colour of the background.
    pub background: Color,
    /// The colour of torn edges.
    pub seam: Color,
    /// The colour of boundary edges that are not torn.
    pub boundary: Color,
    /// The colour of edges between two faces.
    pub edge: Color,
    /// The colour of the traces of planned cuts, and of their rays.
    pub trace: Color,
    /// The colour of the box around all faces.
    pub bounding_box: Color,
}

/// The theme of pictures, and of pages in light mode.
pub const LIGHT: Theme = Theme {
    background: [250, 250, 247],
    seam: [214, 24, 31],
    boundary: [38, 44, 54],
    edge: [50, 60, 76],
    trace: [148, 0, 148],
    bounding_box: [140, 144, 150],
};

/// The theme of pages in dark mode.
pub const DARK: Theme = Theme {
    background: [24, 26, 31],
    seam: [255, 62, 62],
    boundary: [228, 231, 236],
    edge: [16, 20, 28],
    trace: [255, 92, 255],
    bounding_box: [112, 118, 128],
};

/// Returns the colour of the piece with a number, counted from 0. Colours repeat after the last of
/// [`PIECES`].
#[must_use]
pub fn piece(number: u32) -> Color {
    PIECES[number as usize % PIECES.len()]
}

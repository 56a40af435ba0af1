//! The colours of pictures and pages: each has its one home here.
//!
//! Pieces take turns in hues that people who confuse red and green can tell apart, by brightness if not
//! by hue. None of them is red, which is the colour of what was torn.

/// A colour, as red, green and blue from 0 to 255.
pub type Color = [u8; 3];

/// Where nothing is.
pub const BACKGROUND: Color = [250, 250, 247];

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

/// Torn edges.
pub const SEAM: Color = [214, 24, 31];

/// The boundary that a mesh had before anything was torn.
pub const BOUNDARY: Color = [38, 44, 54];

/// Edges between two faces.
pub const EDGE: Color = [50, 60, 76];

/// Where a cut would go, and the rays that it goes between.
pub const TRACE: Color = [148, 0, 148];

/// The box round all faces.
pub const BOX: Color = [140, 144, 150];

/// The colour of a piece, by its number.
#[must_use]
pub fn piece(number: usize) -> Color {
    PIECES[number % PIECES.len()]
}

//! The shape at rest of a cloth whose texture coordinates are its flat panels.

use std::error::Error;
use std::fmt;

use tearmesh::geometry::Point;

/// Returns the shape at rest that texture coordinates describe, as [`Scene::rest`](super::Scene::rest) takes it.
///
/// `faces` has the texture coordinates of the corners of each face, `None` for a corner that has none. One unit of
/// them is `unit_m` metres. Panels lie flat, counter-clockwise as the faces do.
///
/// ```
/// use tearmesh_cloth::scene::{TextureFault, rest_from_texture};
///
/// let face = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Some);
/// assert_eq!(rest_from_texture([face], 0.5)?[1].x, 0.5);
/// let [a, b, c] = face;
/// let refused = rest_from_texture([face, [a, c, b]], 0.5).unwrap_err();
/// assert_eq!((refused.face, refused.fault), (1, TextureFault::Flipped));
/// # Ok::<(), tearmesh_cloth::scene::TextureError>(())
/// ```
///
/// # Errors
///
/// [`TextureError`] for the first face that has no place, no area or the wrong orientation there.
pub fn rest_from_texture(
    faces: impl IntoIterator<Item = [Option<[f64; 2]>; 3]>,
    unit_m: f64,
) -> Result<Vec<Point>, TextureError> {
    let place = |[u, v]: [f64; 2]| Point::new(u * unit_m, v * unit_m, 0.0);
    let mut rest = Vec::new();
    for (face, corners) in faces.into_iter().enumerate() {
        let refused = |fault| Err(TextureError { face, fault });
        let [Some(a), Some(b), Some(c)] = corners.map(|corner| corner.map(place)) else {
            return refused(TextureFault::NoPlace);
        };
        match (b - a).cross(&(c - a)).z {
            twice if twice > 0.0 => rest.extend([a, b, c]),
            0.0 => return refused(TextureFault::NoArea),
            _ => return refused(TextureFault::Flipped),
        }
    }
    Ok(rest)
}

/// The reason why texture coordinates are no shape at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureError {
    /// The index of the first face that is refused, from 0.
    pub face: usize,
    /// The reason.
    pub fault: TextureFault,
}

impl fmt::Display for TextureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "f{} {}", self.face, self.fault)
    }
}

impl Error for TextureError {}

/// The reason why a face has no shape in texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TextureFault {
    /// A corner has no texture coordinates.
    NoPlace,
    /// The corners lie on one line.
    NoArea,
    /// The corners run clockwise.
    Flipped,
}

impl fmt::Display for TextureFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let fault = match self {
            TextureFault::NoPlace => "has no place",
            TextureFault::NoArea => "has no area",
            TextureFault::Flipped => "is flipped",
        };
        write!(f, "{fault} in texture coordinates")
    }
}

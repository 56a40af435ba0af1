//! Pictures, and files of them.

use std::io::{self, Write};

use crate::palette::Color;

/// A picture of RGB pixels. Rows are ordered from top to bottom, and pixels in a row from left to right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    size: PictureSize,
    pixels: Vec<u8>,
}

/// The largest number of pixels, width times height, that a picture may have.
pub const PIXELS_MAX: u64 = 1 << 26;

/// The width and height of a picture, in pixels. Each is at least 1, and their product is at most
/// [`PIXELS_MAX`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureSize {
    width: u32,
    height: u32,
}

impl PictureSize {
    /// 960 by 720 pixels.
    pub const USUAL: PictureSize = PictureSize {
        width: 960,
        height: 720,
    };

    /// Creates a size, or returns `None` if width or height is 0 or if their product exceeds
    /// [`PIXELS_MAX`].
    ///
    /// ```
    /// use tearmesh_view::PictureSize;
    ///
    /// assert!(PictureSize::new(1920, 1080).is_some());
    /// assert!(PictureSize::new(0, 1080).is_none() && PictureSize::new(1 << 20, 1 << 20).is_none());
    /// ```
    #[must_use]
    pub fn new(width: u32, height: u32) -> Option<PictureSize> {
        let pixels = u64::from(width) * u64::from(height);
        let is_possible = (1..=PIXELS_MAX).contains(&pixels);
        is_possible.then_some(PictureSize { width, height })
    }

    /// Returns the width, in pixels.
    #[must_use]
    pub fn width(self) -> u32 {
        self.width
    }

    /// Returns the height, in pixels.
    #[must_use]
    pub fn height(self) -> u32 {
        self.height
    }

    /// Returns the width and height, in pixels, as [`Camera::new`](crate::Camera::new) expects them.
    #[must_use]
    pub fn as_f64(self) -> [f64; 2] {
        [f64::from(self.width), f64::from(self.height)]
    }
}

impl Picture {
    /// A picture of these pixels, whose count the caller answers for.
    pub(crate) fn new(size: PictureSize, pixels: Vec<Color>) -> Picture {
        let count = u64::from(size.width) * u64::from(size.height);
        assert_eq!(pixels.len() as u64, count, "a colour for each pixel");
        let pixels = pixels.into_flattened();
        Picture { size, pixels }
    }

    /// Puts pictures of the same height beside each other, from left to right.
    ///
    /// # Panics
    ///
    /// If there is no picture, or if their heights differ.
    #[must_use]
    pub fn beside(pictures: &[Picture]) -> Picture {
        let height = pictures[0].height();
        let is_as_high = |one: &Picture| one.height() == height;
        assert!(pictures.iter().all(is_as_high), "of one height");
        let rows = (0..height as usize).flat_map(|row| {
            pictures.iter().flat_map(move |one| {
                let length = 3 * one.width() as usize;
                &one.pixels[row * length..(row + 1) * length]
            })
        });
        let width = pictures.iter().map(Picture::width).sum();
        Picture {
            size: PictureSize { width, height },
            pixels: rows.copied().collect(),
        }
    }

    /// Returns the width, in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.size.width
    }

    /// Returns the height, in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.size.height
    }

    /// Returns three bytes for each pixel, red, green and blue, row by row from the top left.
    #[must_use]
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// Returns the colour of the pixel in column `x` and row `y`, which count from 0 at the top left.
    ///
    /// # Panics
    ///
    /// If the picture has no such pixel.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> Color {
        let PictureSize { width, height } = self.size;
        assert!(x < width && y < height, "no pixel {x}, {y}");
        let first = 3 * (y as usize * width as usize + x as usize);
        [0, 1, 2].map(|i| self.pixels[first + i])
    }

    /// Writes the picture as a PNG file. The same picture gives the same bytes.
    ///
    /// # Errors
    ///
    /// Any I/O error of `out`.
    pub fn write_png(&self, out: impl Write) -> io::Result<()> {
        let mut encoder = png::Encoder::new(out, self.width(), self.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.pixels)?;
        writer.finish()?;
        Ok(())
    }
}

//! The finished picture.

use std::io::{self, Write};

/// Pixels of 8-bit sRGB, rows from top to bottom.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Image {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Image {
    /// White paper. The caller has capped the size.
    pub(super) fn white(width: usize, height: usize) -> Self {
        Self { width, height, pixels: vec![[255; 3]; width * height] }
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Red, green and blue of the pixel in column `x` and row `y`, or `None` outside of the picture.
    pub fn pixel(&self, x: usize, y: usize) -> Option<[u8; 3]> {
        if x < self.width { self.pixels.get(y * self.width + x).copied() } else { None }
    }

    /// Mixes `colour` into a pixel with weight `coverage` of 255; outside of the picture nothing happens.
    pub(super) fn blend(&mut self, x: i64, y: i64, colour: [u8; 3], coverage: u8) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return };
        if x >= self.width || y >= self.height {
            return;
        }
        let Some(pixel) = self.pixels.get_mut(y * self.width + x) else { return };
        let weight = u32::from(coverage);
        for (old, new) in pixel.iter_mut().zip(colour) {
            *old = ((u32::from(*old) * (255 - weight) + u32::from(new) * weight + 127) / 255) as u8;
        }
    }

    /// Fills a rectangle; parts outside of the picture are left out.
    pub(super) fn fill(&mut self, x: i64, y: i64, width: i64, height: i64, colour: [u8; 3]) {
        for row in y.max(0)..(y + height).min(self.height as i64) {
            for column in x.max(0)..(x + width).min(self.width as i64) {
                self.blend(column, row, colour, 255);
            }
        }
    }

    /// Writes the picture as a PNG file of 8-bit RGB.
    ///
    /// # Errors
    /// What `out` reports.
    pub fn write_png(&self, out: impl Write) -> io::Result<()> {
        let mut encoder = png::Encoder::new(out, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        Ok(writer.finish()?)
    }
}

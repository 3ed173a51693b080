//! Text from a bitmap font that is compiled in.

use super::image::Image;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

const FONT: (FontWeight, RasterHeight) = (FontWeight::Regular, RasterHeight::Size16);
/// Height and width of the font's cells, in pixels.
const CELL: [f64; 2] = [RasterHeight::Size16.val() as f64, get_raster_width(FONT.0, FONT.1) as f64];
/// What stands for a character that the font does not have.
const UNKNOWN: char = '?';

/// Size and colour of text.
#[derive(Clone, Copy)]
pub(super) struct Type {
    /// Height of a line in pixels.
    pub(super) height: f64,
    pub(super) colour: [u8; 3],
}

impl Type {
    fn scale(&self) -> f64 {
        self.height / CELL[0]
    }

    /// Width of one character in pixels.
    fn advance(&self) -> f64 {
        CELL[1] * self.scale()
    }

    /// Width of `text` in pixels.
    pub(super) fn width(&self, text: &str) -> f64 {
        text.chars().count() as f64 * self.advance()
    }

    /// `text` broken at spaces into at most `lines` lines of `width` pixels; what does not fit ends in "...".
    pub(super) fn wrapped(&self, text: &str, width: f64, lines: usize) -> Vec<String> {
        let most = (width / self.advance()).max(0.0) as usize;
        // More than this is cut anyway, however long the text is.
        let text: String = text.chars().take(most.saturating_add(1).saturating_mul(lines + 1)).collect();
        let mut result: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            let full = result.len() == lines;
            match result.last_mut() {
                Some(line) if full || line.chars().count() + 1 + word.chars().count() <= most => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => result.push(word.to_owned()),
            }
        }
        for line in &mut result {
            if line.chars().count() > most {
                *line = line.chars().take(most.saturating_sub(3)).chain("...".chars().take(most)).collect();
            }
        }
        result
    }

    /// Draws one line of text with its top left corner at (`x`, `y`).
    pub(super) fn draw(&self, image: &mut Image, text: &str, x: f64, y: f64) {
        for (i, letter) in text.chars().enumerate() {
            let left = x + i as f64 * self.advance();
            if left > image.width() as f64 {
                break;
            }
            self.letter(image, letter, left, y);
        }
    }

    /// Draws text centred on `x`.
    pub(super) fn draw_centred(&self, image: &mut Image, text: &str, x: f64, y: f64) {
        self.draw(image, text, x - self.width(text) / 2.0, y);
    }

    fn letter(&self, image: &mut Image, letter: char, left: f64, top: f64) {
        let Some(raster) = get_raster(letter, FONT.0, FONT.1).or_else(|| get_raster(UNKNOWN, FONT.0, FONT.1))
        else {
            return;
        };
        let at = |x: i64, y: i64| {
            let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return 0.0 };
            raster.pixel(x, y).map_or(0.0, f64::from)
        };
        for row in top.floor() as i64..(top + self.height).ceil() as i64 {
            for column in left.floor() as i64..(left + self.advance()).ceil() as i64 {
                let x = (column as f64 + 0.5 - left) / self.scale() - 0.5;
                let y = (row as f64 + 0.5 - top) / self.scale() - 0.5;
                let (x0, y0) = (x.floor(), y.floor());
                let (fx, fy) = (x - x0, y - y0);
                let (i, j) = (x0 as i64, y0 as i64);
                let upper = at(i, j) * (1.0 - fx) + at(i + 1, j) * fx;
                let lower = at(i, j + 1) * (1.0 - fx) + at(i + 1, j + 1) * fx;
                let coverage = upper * (1.0 - fy) + lower * fy;
                // Enlarging softens the rims; raising the contrast by as much brings them back.
                let crisp = 127.5 + (coverage - 127.5) * self.scale().max(1.0);
                image.blend(column, row, self.colour, crisp.round() as u8);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Type = Type { height: CELL[0], colour: [0; 3] };

    #[test]
    fn text_breaks_at_spaces_and_is_cut_where_it_does_not_fit() {
        let width = |characters: usize| CELL[1] * characters as f64;
        let text = "asked width 0.020, reached 0.0199";
        assert_eq!(PLAIN.wrapped(text, width(18), 2), ["asked width 0.020,", "reached 0.0199"]);
        assert_eq!(PLAIN.wrapped(text, width(33), 2), [text]);
        assert_eq!(PLAIN.wrapped(text, width(20), 1), ["asked width 0.020..."]);
        assert_eq!(PLAIN.wrapped(text, width(2), 1), [".."]);
        assert!(PLAIN.wrapped(" \n ", width(10), 2).is_empty());
    }

    #[test]
    fn letters_stay_in_their_cells() {
        for scale in [0.6, 1.0, 1.25, 2.5] {
            let text = Type { height: CELL[0] * scale, colour: [0; 3] };
            let mut image = Image::white(200, 100);
            text.draw(&mut image, "H\u{e9}g", 20.0, 30.0);
            let dark = |x: usize, y: usize| image.pixel(x, y).is_some_and(|[r, ..]| r < 128);
            let inked = (0..200).flat_map(|x| (0..100).map(move |y| (x, y))).filter(|&(x, y)| dark(x, y));
            let (mut count, right, bottom) = (0, 20.0 + text.width("Heg"), 30.0 + text.height);
            for (x, y) in inked {
                assert!(x >= 20 && (x as f64) < right && y >= 30 && (y as f64) < bottom, "{x} {y}");
                count += 1;
            }
            assert!(count > 15, "{scale}: {count}");
        }
    }
}

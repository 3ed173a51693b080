//! The layout of a figure: title, pictures side by side, a caption and a legend beneath each.

use super::camera::{Camera, View};
use super::canvas::{Canvas, SUPERSAMPLING};
use super::image::Image;
use super::legend::{self, Swatch};
use super::panel::{self, Content, EdgeKind, Panel};
use super::text::Type;

/// Longest side of a figure, in pixels.
pub const MAX_SIDE: usize = 4096;
/// Most pixels of a figure; the canvas takes up to 64 bytes for each.
pub const MAX_PIXELS: usize = 4_194_304;

/// Width of a picture for which the sizes of text are meant.
const USUAL_PICTURE: f64 = 480.0;
const INK: [u8; 3] = [34, 36, 40];
/// Enough for the dimensions of three features.
const CAPTION_LINES: usize = 5;

/// Pictures of one object side by side.
#[derive(Clone, Debug)]
pub struct Figure<'a> {
    /// A line of plain text above the pictures; may be empty. Characters outside of ASCII show as a question mark.
    pub title: &'a str,
    /// The pictures, from left to right.
    pub panels: Vec<Panel<'a>>,
    /// How all of them are seen.
    pub camera: Camera,
    /// Width in pixels, in [1, [`MAX_SIDE`]]; other numbers are clamped.
    pub width: usize,
    /// Height in pixels, in [1, [`MAX_SIDE`]]; other numbers are clamped, and so that there are no more than
    /// [`MAX_PIXELS`].
    pub height: usize,
}

impl Figure<'_> {
    /// Draws the figure.
    pub fn render(&self) -> Image {
        let width = self.width.clamp(1, MAX_SIDE);
        let height = self.height.clamp(1, MAX_SIDE.min(MAX_PIXELS / width));
        let mut image = Image::white(width, height);
        let layout = Layout::new(self, width, height);

        let title = Type { height: layout.unit * 26.0, colour: INK };
        for line in title.wrapped(self.title, width as f64 - 2.0 * layout.margin, 1) {
            title.draw_centred(&mut image, &line, width as f64 / 2.0, layout.margin);
        }
        for (i, panel) in self.panels.iter().enumerate().take(MAX_SIDE) {
            layout.draw(panel, &self.camera, i, &mut image);
        }
        image
    }
}

/// Sizes in pixels, shared by all panels so that they line up.
struct Layout {
    /// 1 for pictures of the usual size.
    unit: f64,
    margin: f64,
    /// Of one picture.
    picture: [usize; 2],
    picture_top: usize,
    legend_top: f64,
    caption_top: f64,
}

impl Layout {
    fn new(figure: &Figure<'_>, width: usize, height: usize) -> Self {
        let count = figure.panels.len().max(1) as f64;
        let unit = (width as f64 / count / USUAL_PICTURE).clamp(0.6, 2.5);
        let margin = 14.0 * unit;
        let picture_width = (width as f64 - margin) / count - margin;
        let title = if figure.title.is_empty() { 0.0 } else { 36.0 * unit };
        let legend =
            figure.panels.iter().map(|panel| legend_height(&panel.content, unit)).fold(0.0, f64::max);
        let type_height = Self::small(unit).height;
        let lines =
            |panel: &Panel<'_>| Self::small(unit).wrapped(panel.caption, picture_width, CAPTION_LINES).len();
        let caption =
            figure.panels.iter().take(MAX_SIDE).map(lines).max().unwrap_or(0) as f64 * type_height * 1.2;
        let picture_top = margin + title;
        let legend_top = height as f64 - margin - legend;
        let gap = if legend > 0.0 { 0.5 * margin } else { 0.0 };
        let caption_top = legend_top - gap - caption;
        Self {
            unit,
            margin,
            picture: [picture_width, caption_top - picture_top - 0.5 * margin]
                .map(|side| side.max(0.0) as usize),
            picture_top: picture_top as usize,
            legend_top,
            caption_top,
        }
    }

    fn small(unit: f64) -> Type {
        Type { height: 20.0 * unit, colour: INK }
    }

    fn draw(&self, panel: &Panel<'_>, camera: &Camera, column: usize, image: &mut Image) {
        let [width, height] = self.picture;
        let left = self.margin + column as f64 * (width as f64 + self.margin);
        if width > 0 && height > 0 {
            let mut canvas = Canvas::new(width * SUPERSAMPLING, height * SUPERSAMPLING);
            let view = View::new(camera, canvas.width(), canvas.height());
            panel::draw(&panel.content, &view, &mut canvas);
            canvas.resolve(image, left as usize, self.picture_top);
        }
        let middle = left + width as f64 / 2.0;
        let text = Self::small(self.unit);
        match panel.content {
            Content::Scalar { values, range, label, .. } => {
                let range = panel::value_range(values, range);
                legend::bar(image, range, label, middle, self.legend_top, width as f64 * 0.72, text);
            }
            Content::Cage { edges, vertices, label, .. } => {
                let entries = cage_entries(edges, vertices, label);
                legend::swatches(image, &entries, middle, self.legend_top, width as f64, text);
            }
            Content::Surface { .. } => {}
        }
        for (i, line) in text.wrapped(panel.caption, width as f64, CAPTION_LINES).iter().enumerate() {
            let y = self.caption_top + i as f64 * text.height * 1.2;
            text.draw_centred(image, line, middle, y);
        }
    }
}

/// Height of a panel's legend.
fn legend_height(content: &Content<'_>, unit: f64) -> f64 {
    match content {
        Content::Scalar { .. } => 62.0 * unit,
        Content::Cage { edges, vertices, .. } if !edges.is_empty() || !vertices.is_empty() => 50.0 * unit,
        _ => 0.0,
    }
}

/// The entries of a cage's legend: only what occurs.
fn cage_entries<'a>(
    edges: &[(u32, u32, EdgeKind)],
    vertices: &[u32],
    label: &'a str,
) -> Vec<(Swatch, [u8; 3], &'a str)> {
    let mut entries = Vec::new();
    for kind in EdgeKind::ALL {
        if edges.iter().any(|edge| edge.2 == kind) {
            entries.push((Swatch::Line(kind.width()), kind.colour(), kind.name()));
        }
    }
    if !vertices.is_empty() {
        entries.push((Swatch::Disc(panel::DISC_DIAMETER), panel::EMPHASISED, label));
    }
    entries
}

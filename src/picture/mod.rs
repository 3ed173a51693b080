//! Figures as PNG files: control cage, limit surface, deviation map, side by side with captions and legends.
//!
//! Everything is drawn by the processor with parallel projection: no display is needed, and a program gives the same
//! bytes for the same input each time. A [`Figure`] lays out [`Panel`]s, each of which draws one [`Shape`]; the
//! colours are mixed as linear light on a canvas of 2 x 2 samples per pixel, then averaged into the [`Image`].
//! [`rule_svg`] draws a rule as lines and words instead, for documents.
//! Input that cannot be drawn (faces with missing or infinite vertices, empty shapes) leaves white paper.

mod camera;
mod canvas;
mod colour;
mod figure;
mod image;
mod legend;
mod panel;
mod rule;
mod shading;
mod shape;
mod stroke;
mod text;

pub use camera::Camera;
pub use figure::{Figure, MAX_PIXELS, MAX_SIDE};
pub use image::Image;
pub use panel::{Content, EdgeKind, Panel};
pub use rule::rule_svg;
pub use shading::Finish;
pub use shape::Shape;

//! What a picture of a figure shows, and how it is drawn.

use super::camera::View;
use super::canvas::{Canvas, Corner, SUPERSAMPLING};
use super::colour::{DivergingMap, Light, from_srgb};
use super::shading::{self, Finish};
use super::shape::{Shape, area_vector, project, triangulate};
use super::stroke::Pen;
use glam::DVec3;

/// One picture of a figure.
#[derive(Clone, Copy, Debug)]
pub struct Panel<'a> {
    /// What is shown.
    pub content: Content<'a>,
    /// Plain text beneath it, e.g. "asked width 0.020, reached 0.0199".
    pub caption: &'a str,
}

/// What a panel shows. Indices that are out of range are left out.
#[derive(Clone, Copy, Debug)]
pub enum Content<'a> {
    /// A control cage: faces in grey, edges as lines, some of them emphasised.
    Cage {
        /// The cage.
        shape: Shape<'a>,
        /// Edges to emphasise: two vertices and what they are.
        edges: &'a [(u32, u32, EdgeKind)],
        /// Vertices to emphasise.
        vertices: &'a [u32],
        /// What these vertices are, for the legend, e.g. "displaced".
        label: &'a str,
    },
    /// A smooth surface under studio light or with reflection lines.
    Surface {
        /// The surface, cut into small faces.
        shape: Shape<'a>,
        /// One normal per vertex (any length); empty to average those of the faces.
        normals: &'a [DVec3],
        /// How it is shown.
        finish: Finish,
    },
    /// A surface coloured by a value per vertex: blue below zero, light grey at zero, red above.
    Scalar {
        /// The surface, cut into small faces.
        shape: Shape<'a>,
        /// One normal per vertex (any length); empty to average those of the faces.
        normals: &'a [DVec3],
        /// One value per vertex. Vertices without a value, or whose value is not finite, are dark grey.
        values: &'a [f64],
        /// The value at the red end, positive; the blue end is its negative. `None` for a round number that covers all.
        range: Option<f64>,
        /// Name and unit of the values for the legend, e.g. "deviation (mm)".
        label: &'a str,
    },
}

/// Why an edge of a cage is emphasised.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum EdgeKind {
    /// A line of a feature that was built.
    Feature,
    /// The user's mark.
    Marked,
    /// A mark that no rule resolved.
    Unresolved,
}

impl EdgeKind {
    /// All kinds, in the order in which they are drawn: the later ones lie on top.
    pub(super) const ALL: [Self; 3] = [Self::Feature, Self::Marked, Self::Unresolved];

    pub(super) fn colour(self) -> [u8; 3] {
        match self {
            Self::Feature => [24, 52, 140],
            Self::Marked => [206, 30, 38],
            Self::Unresolved => [240, 140, 10],
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Feature => "feature",
            Self::Marked => "mark",
            Self::Unresolved => "unresolved",
        }
    }

    /// Width of its lines in pixels.
    pub(super) fn width(self) -> f64 {
        match self {
            Self::Feature => 2.2,
            Self::Marked => 2.8,
            Self::Unresolved => 4.6,
        }
    }
}

/// Discs of emphasised vertices.
pub(super) const EMPHASISED: [u8; 3] = [22, 150, 62];
/// Diameter of those discs in pixels.
pub(super) const DISC_DIAMETER: f64 = 6.0;

/// Width of the plain edges of a coarse cage, in pixels.
const WIDEST_EDGE: f64 = 1.2;
const CAGE_FACE: [u8; 3] = [226, 227, 230];
const CAGE_EDGE: [u8; 3] = [62, 64, 70];
const SURFACE: [u8; 3] = [214, 217, 223];

/// The largest value of `values` as a round bound, for a legend whose range nobody gave.
pub(super) fn value_range(values: &[f64], range: Option<f64>) -> f64 {
    if let Some(range) = range
        && super::legend::DRAWABLE_RANGES.contains(&range)
    {
        return range;
    }
    let largest = values.iter().filter(|v| v.is_finite()).fold(0.0f64, |largest, v| largest.max(v.abs()));
    super::legend::round_up(largest)
}

/// Draws `content` on `canvas`.
pub(super) fn draw(content: &Content<'_>, view: &View, canvas: &mut Canvas) {
    match *content {
        Content::Cage { shape, edges, vertices, .. } => cage(&shape, edges, vertices, view, canvas),
        Content::Surface { shape, normals, finish } => {
            let albedo = from_srgb(SURFACE);
            match finish {
                Finish::Studio => {
                    smooth(&shape, normals, None, view, canvas, |n, _| shading::studio(n, albedo))
                }
                Finish::ReflectionLines => {
                    smooth(&shape, normals, None, view, canvas, |n, _| shading::reflection_lines(n));
                }
            }
        }
        Content::Scalar { shape, normals, values, range, .. } => {
            let map = DivergingMap::new();
            let scaled = Some((values, value_range(values, range)));
            smooth(&shape, normals, scaled, view, canvas, |n, t| shading::tinted(n, map.colour(t)));
        }
    }
}

/// Fills a surface with interpolated normals; `shade` gets the unit normal that faces the viewer and the value as a share
/// of its range.
fn smooth(
    shape: &Shape<'_>,
    normals: &[DVec3],
    values: Option<(&[f64], f64)>,
    view: &View,
    canvas: &mut Canvas,
    shade: impl Fn([f32; 3], f32) -> Light,
) {
    let averaged = if normals.len() < shape.positions.len() { shape.averaged_normals() } else { Vec::new() };
    let normals = if averaged.is_empty() { normals } else { &averaged };
    let corners: Vec<Corner<4>> = shape
        .positions
        .iter()
        .zip(normals)
        .enumerate()
        .map(|(i, (&p, normal))| {
            let n = shading::unit(view.camera().turned(normal.normalize_or_zero()));
            let value = values.map_or(0.0, |(values, range)| {
                values
                    .get(i)
                    .filter(|v| v.is_finite())
                    .map_or(f32::NAN, |v| (v / range).clamp(-4.0, 4.0) as f32)
            });
            Corner { at: view.project(p), data: [n[0], n[1], n[2], value] }
        })
        .collect();
    for face in shape.faces() {
        triangulate(
            face,
            |v| corners[v as usize],
            |triangle| {
                let towards_viewer = facing(&triangle);
                canvas.triangle(triangle, |[x, y, z, value]| {
                    let n = shading::unit([x * towards_viewer, y * towards_viewer, z * towards_viewer]);
                    shade(n, value)
                });
            },
        );
    }
}

/// The sign that turns a triangle's vertex normals to the side on which the viewer is. The side is judged by the
/// triangle itself: near an outline single normals may point away from the viewer although the triangle does not.
fn facing(triangle: &[Corner<4>; 3]) -> f32 {
    let [a, b, c] = triangle.each_ref().map(|corner| corner.at);
    // Depth grows away from the viewer and y downwards, both against the axes of the normals.
    let cross = (b - a).cross(c - a).as_vec3();
    let plane = if cross.z > 0.0 { [-cross.x, cross.y, cross.z] } else { [cross.x, -cross.y, -cross.z] };
    let sum = [0, 1, 2].map(|i| triangle.iter().map(|corner| corner.data[i]).sum());
    if shading::dot(plane, sum) < 0.0 { -1.0 } else { 1.0 }
}

fn cage(
    shape: &Shape<'_>,
    emphasised: &[(u32, u32, EdgeKind)],
    vertices: &[u32],
    view: &View,
    canvas: &mut Canvas,
) {
    let points = project(shape.positions, view);
    let albedo = from_srgb(CAGE_FACE);
    for face in shape.faces() {
        let normal = area_vector(face.iter().map(|&v| shape.positions[v as usize])).normalize_or_zero();
        let level = 0.80 + 0.20 * view.camera().turned(normal)[2].abs();
        let colour = albedo.map(|part| part * level);
        let corner = |v: u32| Corner { at: points[v as usize], data: [] };
        triangulate(face, corner, |triangle| canvas.triangle(triangle, |[]| colour));
    }

    let per_pixel = SUPERSAMPLING as f64;
    let pen =
        |colour: [u8; 3], width: f64| Pen { colour: from_srgb(colour), half_width: width * per_pixel / 2.0 };
    let segment = |&(a, b): &(u32, u32)| Some((*points.get(a as usize)?, *points.get(b as usize)?));
    let segments: Vec<(DVec3, DVec3)> = shape.edges().iter().filter_map(segment).collect();
    let plain = pen(CAGE_EDGE, plain_width(&segments));
    for &(a, b) in &segments {
        canvas.line(a, b, plain);
    }
    for kind in EdgeKind::ALL {
        let pen = pen(kind.colour(), kind.width());
        for &(a, b, _) in emphasised.iter().filter(|edge| edge.2 == kind) {
            if let Some((a, b)) = segment(&(a, b)) {
                canvas.line(a, b, pen);
            }
        }
    }
    for &at in vertices.iter().filter_map(|&v| points.get(v as usize)) {
        canvas.disc(at, pen([255; 3], DISC_DIAMETER + 1.6));
        canvas.disc(at, pen(EMPHASISED, DISC_DIAMETER));
    }
}

/// Width in pixels of the plain edges: thinner where the cage is dense, or the lines would hide the faces. The upper
/// quartile of lengths speaks for the large faces; small details such as feet do not thin the lines of all others.
fn plain_width(segments: &[(DVec3, DVec3)]) -> f64 {
    let mut lengths: Vec<f64> = segments.iter().map(|(a, b)| a.truncate().distance(b.truncate())).collect();
    let at = lengths.len() * 3 / 4;
    if at >= lengths.len() {
        return WIDEST_EDGE;
    }
    let (_, quartile, _) = lengths.select_nth_unstable_by(at, f64::total_cmp);
    (*quartile / SUPERSAMPLING as f64 * 0.05).clamp(0.5, WIDEST_EDGE)
}

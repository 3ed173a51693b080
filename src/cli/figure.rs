//! The figure of a feature: control mesh, limit surface, deviation map.

use super::error::Failure;
use super::limit::limit_mesh_with_normals;
use glam::DVec3;
use welt::feature::{Report, significant};
use welt::mesh::{Mesh, Polygons};
use welt::picture::{Camera, Content, EdgeKind, Figure, Finish, Image, Panel, Shape};
use welt::subdivision::Refinement;
use welt::surface::LimitSurface;

/// A limit mesh with what is drawn or written about it.
pub struct LimitPicture {
    pub polygons: Polygons,
    pub normals: Vec<DVec3>,
    /// Signed distance to the surface before, along its normal; 0 where the surface cannot have changed.
    pub deviation: Vec<f64>,
}

/// Faces of a limit mesh that is drawn, about.
const DRAWN_FACES: usize = 60_000;

/// Levels of refinement that give a smooth picture of a control mesh with `faces` faces.
pub fn drawing_level(faces: usize) -> usize {
    (1..=4).take_while(|&level| level == 1 || faces << (2 * level) <= DRAWN_FACES).last().unwrap_or(1)
}

/// The limit surface of `after`, compared with that of `before` where `report` says it can have changed.
pub fn limit_picture(before: &Mesh, after: &Mesh, report: &Report) -> Result<LimitPicture, Failure> {
    let level = drawing_level(after.face_bound());
    let refinement = Refinement::new(after, level)?;
    let (polygons, normals) = limit_mesh_with_normals(&refinement, after, level)?;
    let mut near = vec![false; polygons.positions.len()];
    for face in 0..polygons.face_sizes.len() as u32 {
        let ancestor = (1..=level)
            .rev()
            .try_fold(face, |face, level| refinement.face_parent(level, face).map(|(parent, _)| parent));
        if ancestor.is_some_and(|f| report.affected.binary_search(&f).is_ok()) {
            let corners = &refinement.level(level).face_vertices()[4 * face as usize..4 * face as usize + 4];
            corners.iter().for_each(|&v| near[v as usize] = true);
        }
    }
    let surface = LimitSurface::new(before);
    let deviation = polygons
        .positions
        .iter()
        .zip(&normals)
        .zip(near)
        .map(
            |((&point, &normal), near)| {
                if near { surface.signed_distance(point, normal).unwrap_or(0.0) } else { 0.0 }
            },
        )
        .collect();
    Ok(LimitPicture { polygons, normals, deviation })
}

/// Where the viewer stands, and which way is up.
#[derive(Clone, Copy)]
pub struct View {
    pub viewer: DVec3,
    pub up: DVec3,
    /// Frame the feature only, this much wider; the whole model without.
    pub zoom: Option<f64>,
}

const ABOVE_IN_FRONT: DVec3 = DVec3::new(0.5, 0.45, 1.0);

/// Which of y and z is up, by where the model reaches further.
fn up(mesh: &Mesh) -> DVec3 {
    let extent = mesh.positions().iter().fold(DVec3::ZERO, |a, p| a.max(p.abs()));
    if extent.y >= extent.z { DVec3::Y } else { DVec3::Z }
}

impl View {
    /// Looks at the feature against its mean normal.
    pub fn of_feature(after: &Mesh, report: &Report, limit: &LimitPicture) -> Self {
        let sum: DVec3 = report
            .green
            .iter()
            .filter_map(|&v| limit.normals.get(v as usize))
            .fold(DVec3::ZERO, |sum, n| sum + *n);
        // A ring's normals cancel: look at it from above and in front then.
        let viewer = if sum.length() > 0.2 * report.green.len() as f64 { sum } else { ABOVE_IN_FRONT };
        let up = up(after);
        Self { viewer: viewer.normalize_or(DVec3::Z) + 0.35 * up, up, zoom: None }
    }
}

/// Draws the figure.
pub fn draw(title: &str, after: &Mesh, report: &Report, limit: &LimitPicture, view: View) -> Image {
    let cage = after.to_polygons();
    let mut edges: Vec<(u32, u32, EdgeKind)> =
        report.feature_edges.iter().map(|&(a, b)| (a, b, EdgeKind::Feature)).collect();
    for leftover in &report.leftovers {
        let vertices = &leftover.vertices;
        edges.extend(
            (0..vertices.len())
                .map(|i| (vertices[i], vertices[(i + 1) % vertices.len()], EdgeKind::Unresolved)),
        );
    }
    let camera = match view.zoom {
        None => Camera::framing(&cage.positions, view.viewer, view.up),
        Some(factor) => {
            let near: Vec<DVec3> = report
                .feature_edges
                .iter()
                .flat_map(|&(a, b)| [a, b])
                .filter_map(|v| cage.positions.get(v as usize).copied())
                .collect();
            Camera::framing(&near, view.viewer, view.up).widened(factor)
        }
    };
    let shape = Shape {
        positions: &limit.polygons.positions,
        face_sizes: &limit.polygons.face_sizes,
        face_vertices: &limit.polygons.face_vertices,
    };
    let added = report.after.vertices - report.before.vertices;
    let cage_caption = format!("control mesh: {} vertices added to {}", added, report.before.vertices);
    Figure {
        title,
        panels: vec![
            Panel {
                content: Content::Cage {
                    shape: Shape {
                        positions: &cage.positions,
                        face_sizes: &cage.face_sizes,
                        face_vertices: &cage.face_vertices,
                    },
                    edges: &edges,
                    vertices: &report.green,
                    label: "displaced",
                },
                caption: &cage_caption,
            },
            Panel {
                content: Content::Surface { shape, normals: &limit.normals, finish: Finish::Studio },
                caption: &dimensions(report),
            },
            Panel {
                content: Content::Scalar {
                    shape,
                    normals: &limit.normals,
                    values: &limit.deviation,
                    range: None,
                    label: "distance to the surface before (model units)",
                },
                caption: &outside(report),
            },
        ],
        camera,
        width: 1560,
        height: 640,
    }
    .render()
}

/// Looks at all of `points` of the surface of `mesh`, from above and in front.
pub fn framing(mesh: &Mesh, points: &[DVec3]) -> Camera {
    let up = up(mesh);
    Camera::framing(points, ABOVE_IN_FRONT + 0.35 * up, up)
}

/// The limit surface of `mesh` with reflection lines.
pub fn reflection_lines(mesh: &Mesh) -> Result<Image, Failure> {
    let level = drawing_level(mesh.face_bound());
    let (polygons, normals) = limit_mesh_with_normals(&Refinement::new(mesh, level)?, mesh, level)?;
    let shape = Shape {
        positions: &polygons.positions,
        face_sizes: &polygons.face_sizes,
        face_vertices: &polygons.face_vertices,
    };
    let content = Content::Surface { shape, normals: &normals, finish: Finish::ReflectionLines };
    let camera = framing(mesh, &polygons.positions);
    let panels = vec![Panel { content, caption: "limit surface, reflection lines" }];
    Ok(Figure { title: "", panels, camera, width: 1000, height: 1000 }.render())
}

fn dimensions(report: &Report) -> String {
    let several = report.features.len() > 1;
    let parts: Vec<String> = report
        .features
        .iter()
        .filter_map(|feature| {
            let measured = feature.dimensions.iter().filter(|d| d.stations > 0);
            let list: Vec<String> = measured
                .map(|d| {
                    let [reached, asked] = [d.reached_mean, d.asked_mean].map(significant);
                    format!("{} {reached} (asked {asked})", d.name)
                })
                .collect();
            let of = if several { format!("{}: ", feature.kind) } else { String::new() };
            (!list.is_empty()).then(|| of + &list.join(", "))
        })
        .collect();
    if parts.is_empty() { "limit surface".to_owned() } else { parts.join("; ") }
}

fn outside(report: &Report) -> String {
    match (&report.displaced, report.size) {
        (Some(difference), Some(size)) if size > 0.0 => format!(
            "outside of the feature: at most {:.4} % of the size",
            100.0 * difference.outside.max / size
        ),
        _ => "difference to the surface before".to_owned(),
    }
}

//! Curvature of the limit surface at the vertices of its meshes, and pictures of it.

use super::args::CurvatureKind;
use super::error::Failure;
use super::figure::{drawing_level, framing};
use super::limit::{limit_mesh_with_normals, refined_control};
use welt::mesh::{Mesh, Polygons};
use welt::picture::{Content, Figure, Finish, Image, Panel, Shape};
use welt::subdivision::{Curvature, Refinement, evaluate};
use welt::surface::Quality;

/// Curvature at each vertex of level `level` of `mesh`; NaN at extraordinary vertices, and where the surface has no plane.
pub fn at_vertices(
    refinement: &Refinement,
    mesh: &Mesh,
    level: usize,
    value: impl Fn(&Curvature) -> f64,
) -> Result<Vec<f64>, Failure> {
    let control = Mesh::from_polygons(&refined_control(refinement, mesh, level)?)?;
    let mut values = vec![f64::NAN; control.vertex_bound()];
    let mut seen = vec![false; control.vertex_bound()];
    for face in control.faces() {
        let is_quad = control.arity(face) == 4;
        for (i, vertex) in control.face_vertices(face).enumerate() {
            if std::mem::replace(&mut seen[vertex.index()], true) {
                continue;
            }
            let (patch, (u, v)) = match i {
                _ if !is_quad => (i, (0.0, 0.0)),
                0 => (0, (0.0, 0.0)),
                1 => (0, (1.0, 0.0)),
                2 => (0, (1.0, 1.0)),
                _ => (0, (0.0, 1.0)),
            };
            let found = evaluate(&control, face, patch, u, v).and_then(|point| point.curvature());
            values[vertex.index()] = found.map_or(f64::NAN, |found| value(&found));
        }
    }
    Ok(values)
}

/// What `kind` names.
pub fn value(kind: CurvatureKind) -> impl Fn(&Curvature) -> f64 {
    move |found| match kind {
        CurvatureKind::Greatest => found.principal[0],
        CurvatureKind::Least => found.principal[1],
        CurvatureKind::Mean => found.mean,
        CurvatureKind::Gaussian => found.gaussian,
    }
}

/// The value that 95 % of the amounts do not exceed: beside extraordinary vertices and creases curvature has no bound.
fn usual(values: &[f64]) -> Option<f64> {
    let mut amounts: Vec<f64> = values.iter().map(|value| value.abs()).filter(|a| a.is_finite()).collect();
    amounts.sort_unstable_by(f64::total_cmp);
    amounts.get(amounts.len() * 95 / 100).copied().filter(|&most| most > 0.0)
}

/// The control mesh with its extraordinary vertices, the mean curvature, and reflection lines.
pub fn picture(mesh: &Mesh, quality: &Quality) -> Result<Image, Failure> {
    let level = drawing_level(mesh.face_bound());
    let refinement = Refinement::new(mesh, level)?;
    let (polygons, normals) = limit_mesh_with_normals(&refinement, mesh, level)?;
    let values = at_vertices(&refinement, mesh, level, value(CurvatureKind::Mean))?;
    let cage = mesh.to_polygons();
    let extraordinary: Vec<u32> = quality.extraordinary.iter().map(|found| found.vertex).collect();
    let caption = format!("control mesh: {} extraordinary vertices", extraordinary.len());
    let shape = shape(&polygons);
    let panels = vec![
        Panel {
            content: Content::Cage {
                shape: self::shape(&cage),
                edges: &[],
                vertices: &extraordinary,
                label: "extraordinary",
            },
            caption: &caption,
        },
        Panel {
            content: Content::Scalar {
                shape,
                normals: &normals,
                values: &values,
                range: usual(&values),
                label: "mean curvature (1 / model unit)",
            },
            caption: "red: bent towards the normal, as hollows are",
        },
        Panel {
            content: Content::Surface { shape, normals: &normals, finish: Finish::ReflectionLines },
            caption: "reflection lines",
        },
    ];
    let camera = framing(mesh, &polygons.positions);
    Ok(Figure { title: "", panels, camera, width: 1560, height: 640 }.render())
}

fn shape(polygons: &Polygons) -> Shape<'_> {
    Shape {
        positions: &polygons.positions,
        face_sizes: &polygons.face_sizes,
        face_vertices: &polygons.face_vertices,
    }
}

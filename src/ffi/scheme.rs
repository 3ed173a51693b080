//! Sharpness and options of the subdivision scheme.

use super::arguments;
use super::boundary::boundary;
use super::error::WeltError;
use super::failure::{Failure, Place};
use super::mesh::WeltMesh;
use super::status::WELT_ERROR_MESH;
use crate::fault;
use crate::mesh::{BoundaryRule, Creasing, FaceId, HalfEdgeId, Mesh, SubdivisionOptions, VertexId};

/// Faces at a boundary vertex are no part of the surface, unless all boundary edges there are infinitely sharp.
pub const WELT_BOUNDARY_NONE: u32 = 0;
/// The boundary is a cubic B-spline curve. The default.
pub const WELT_BOUNDARY_EDGE_ONLY: u32 = 1;
/// As WELT_BOUNDARY_EDGE_ONLY, but vertices of a single face stay where they are.
pub const WELT_BOUNDARY_EDGE_AND_CORNER: u32 = 2;
/// Sharpness falls by one from level to level. The default.
pub const WELT_CREASING_UNIFORM: u32 = 0;
/// Sharpness falls by one from level to level after it was averaged along the crease (Chaikin).
pub const WELT_CREASING_CHAIKIN: u32 = 1;

/// Sets the options under which a mesh is subdivided.
///
/// mesh: must not be NULL.
/// boundary: one of WELT_BOUNDARY_*.
/// creasing: one of WELT_CREASING_*.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_set_subdivision(
    mesh: *mut WeltMesh,
    boundary: u32,
    creasing: u32,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh that nobody else uses.
        let mesh = unsafe { arguments::handle_mut(mesh, "mesh") }?;
        let boundary = match boundary {
            WELT_BOUNDARY_NONE => BoundaryRule::None,
            WELT_BOUNDARY_EDGE_ONLY => BoundaryRule::EdgeOnly,
            WELT_BOUNDARY_EDGE_AND_CORNER => BoundaryRule::EdgeAndCorner,
            _ => {
                return Err(Failure::argument(format!(
                    "boundary is {boundary}, which is no WELT_BOUNDARY_*"
                )));
            }
        };
        let creasing = match creasing {
            WELT_CREASING_UNIFORM => Creasing::Uniform,
            WELT_CREASING_CHAIKIN => Creasing::Chaikin,
            _ => {
                return Err(Failure::argument(format!(
                    "creasing is {creasing}, which is no WELT_CREASING_*"
                )));
            }
        };
        mesh.change(|mesh| {
            mesh.set_subdivision(SubdivisionOptions { boundary, creasing });
            Ok(())
        })
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { self::boundary(error, body) }
}

/// Sets the sharpness of edges.
///
/// mesh: must not be NULL.
/// vertices: the two vertices of each edge.
/// sharpness: of each edge, 0 (smooth) or more; 10 and more is infinitely sharp.
/// count: number of edges.
///
/// Fails with WELT_ERROR_MESH where two vertices are not joined by an edge; the mesh is as it was then. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_set_edge_sharpness(
    mesh: *mut WeltMesh,
    vertices: *const u32,
    sharpness: *const f32,
    count: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        let entries = count
            .checked_mul(2)
            .ok_or_else(|| Failure::argument(format!("count is {count}, which is too large")))?;
        // SAFETY: the header asks for a living mesh that nobody else uses and for arrays of these counts.
        let (mesh, vertices, sharpness) = unsafe {
            (
                arguments::handle_mut(mesh, "mesh")?,
                arguments::array(vertices, entries, "vertices")?,
                arguments::array(sharpness, count, "sharpness")?,
            )
        };
        check_sharpness(sharpness)?;
        mesh.change(|mesh| {
            let ends: Vec<(u32, u32)> = vertices.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
            let edges = find(mesh, &ends)?;
            for (h, &sharpness) in edges.into_iter().zip(sharpness) {
                mesh.set_edge_sharpness(h, sharpness);
                fault::point("sharpness");
            }
            Ok(())
        })
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

fn find(mesh: &Mesh, ends: &[(u32, u32)]) -> Result<Vec<HalfEdgeId>, Failure> {
    let found = mesh.find_edges(ends);
    let places: Vec<Place> = found
        .iter()
        .zip(ends)
        .filter(|(edge, _)| edge.is_none())
        .map(|(_, &(a, b))| Place::edge((a, b), "there is no such edge"))
        .collect();
    if places.is_empty() {
        return Ok(found.into_iter().flatten().collect());
    }
    let message = format!("{} pairs of vertices are not joined by an edge", places.len());
    Err(Failure { code: WELT_ERROR_MESH, message, places })
}

/// Sets the sharpness of vertices.
///
/// mesh: must not be NULL.
/// vertices: the vertices.
/// sharpness: of each vertex, 0 (smooth) or more; 10 and more is infinitely sharp.
/// count: number of vertices.
///
/// After a failure the mesh is as it was before. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_set_vertex_sharpness(
    mesh: *mut WeltMesh,
    vertices: *const u32,
    sharpness: *const f32,
    count: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh that nobody else uses and for arrays of this count.
        let (mesh, vertices, sharpness) = unsafe {
            (
                arguments::handle_mut(mesh, "mesh")?,
                arguments::array(vertices, count, "vertices")?,
                arguments::array(sharpness, count, "sharpness")?,
            )
        };
        check_sharpness(sharpness)?;
        let exists = mesh.read()?.vertex_bound();
        if let Some(vertex) = vertices.iter().find(|&&vertex| vertex as usize >= exists) {
            return Err(Failure::argument(format!("there is no vertex {vertex}; the mesh has {exists}")));
        }
        mesh.change(|mesh| {
            for (&vertex, &sharpness) in vertices.iter().zip(sharpness) {
                mesh.set_vertex_sharpness(VertexId(vertex), sharpness);
                fault::point("sharpness");
            }
            Ok(())
        })
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

fn check_sharpness(sharpness: &[f32]) -> Result<(), Failure> {
    match sharpness.iter().find(|value| value.is_nan() || **value < 0.0) {
        Some(value) => Err(Failure::argument(format!("a sharpness is {value}; it must be 0 or more"))),
        None => Ok(()),
    }
}

/// Says which faces are holes: faces that are subdivided like others but are no part of the surface.
///
/// mesh: must not be NULL.
/// faces: the holes; all other faces are none.
/// count: number of holes.
///
/// After a failure the mesh is as it was before. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_set_holes(
    mesh: *mut WeltMesh,
    faces: *const u32,
    count: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh that nobody else uses and for an array of this count.
        let (mesh, holes) =
            unsafe { (arguments::handle_mut(mesh, "mesh")?, arguments::array(faces, count, "faces")?) };
        let exists = mesh.read()?.face_bound();
        if let Some(face) = holes.iter().find(|&&face| face as usize >= exists) {
            return Err(Failure::argument(format!("there is no face {face}; the mesh has {exists}")));
        }
        mesh.change(|mesh| {
            let faces: Vec<FaceId> = mesh.faces().collect();
            for face in faces {
                mesh.set_hole(face, false);
            }
            for &face in holes {
                mesh.set_hole(FaceId(face), true);
                fault::point("holes");
            }
            Ok(())
        })
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

//! `welt_mesh`.

use super::arguments::{self, Buffer, Output};
use super::boundary::{Guarded, boundary, boundary_value};
use super::error::WeltError;
use super::failure::{Failure, Place};
use super::status::WELT_ERROR_MESH;
use crate::fault;
use crate::io::Limits;
use crate::memory;
use crate::mesh::{Mesh, Polygons, VertexId, is_place};
use glam::DVec3;

/// A control mesh. Its vertices, edges and faces are numbered from 0 without gaps.
pub struct WeltMesh {
    content: Guarded<Mesh>,
}

impl WeltMesh {
    pub(super) fn new(mesh: Mesh) -> Self {
        Self { content: Guarded::new(mesh) }
    }

    pub(super) fn read(&self) -> Result<&Mesh, Failure> {
        self.content.read()
    }

    pub(super) fn change<R>(
        &mut self,
        work: impl FnOnce(&mut Mesh) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        self.content.change(work)
    }

    /// Changes the mesh; a failure leaves it as it was before.
    pub(super) fn transact<R>(
        &mut self,
        work: impl FnOnce(&mut Mesh) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        self.change(|mesh| {
            let checkpoint = mesh.begin();
            let result = work(mesh);
            match result {
                Ok(_) => mesh.commit(checkpoint),
                Err(_) => mesh.rollback(checkpoint),
            }
            result
        })
    }
}

/// The mesh of a handle that is read.
///
/// # Safety
/// `mesh` is NULL or a living mesh that nobody changes while the reference is used.
pub(super) unsafe fn mesh_of<'a>(mesh: *const WeltMesh) -> Result<&'a Mesh, Failure> {
    // SAFETY: as for this function.
    unsafe { arguments::handle(mesh, "mesh") }?.read()
}

/// Makes a mesh of polygons.
///
/// face_sizes: number of vertices of each face, 3 or more.
/// face_count: number of faces.
/// face_vertices: the vertices of all faces one after the other, counter-clockwise seen from outside, 0-based.
/// face_vertex_count: number of entries of face_vertices, the sum of face_sizes.
/// positions: x, y and z of each vertex, finite numbers.
/// vertex_count: number of vertices; those without a face are kept.
/// stride: bytes from one vertex to the next, a multiple of 8 and at least 24; 0 for 24.
/// mesh: receives the handle; free it with welt_mesh_free.
///
/// The arrays are copied. Fails with WELT_ERROR_MESH where the polygons are no surface (an edge with three faces, fans of
/// faces that meet in a vertex only, neighbours that are inside out to each other, ...): each place of the error is one
/// defect; with WELT_ERROR_TOO_LARGE beyond the default limits of welt_import_options; with WELT_ERROR_MEMORY. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_mesh_create(
    face_sizes: *const u32,
    face_count: usize,
    face_vertices: *const u32,
    face_vertex_count: usize,
    positions: *const f64,
    vertex_count: usize,
    stride: usize,
    mesh: *mut *mut WeltMesh,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for NULL or a place for the handle.
        let output = unsafe { Output::new(mesh, "mesh") }?;
        // SAFETY: the header asks for arrays of these counts.
        let (sizes, vertices, positions) = unsafe {
            (
                arguments::array(face_sizes, face_count, "face_sizes")?,
                arguments::array(face_vertices, face_vertex_count, "face_vertices")?,
                arguments::points(positions, vertex_count, stride, "positions")?,
            )
        };
        let polygons = Polygons {
            positions,
            face_sizes: memory::copied(sizes)?,
            face_vertices: memory::copied(vertices)?,
            ..Polygons::default()
        };
        Limits::default().check(&polygons)?;
        output.handle(WeltMesh::new(Mesh::from_polygons(&polygons)?));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Frees a mesh. NULL is allowed. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_free(mesh: *mut WeltMesh) {
    // SAFETY: the header asks for NULL or a mesh that was not freed.
    unsafe { arguments::free(mesh) };
}

/// Copies a mesh, with all that it holds: options, sharpness, holes, marks, groups and texture coordinates.
///
/// mesh: must not be NULL.
/// copy: receives the handle; free it with welt_mesh_free.
///
/// Selections that were made on the mesh serve the copy too. Fails with WELT_ERROR_MEMORY. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_copy(
    mesh: *const WeltMesh,
    copy: *mut *mut WeltMesh,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for NULL or a place for the handle.
        let output = unsafe { Output::new(copy, "copy") }?;
        // SAFETY: the header asks for a living mesh.
        let mesh = unsafe { mesh_of(mesh) }?;
        output.handle(WeltMesh::new(mesh.try_clone()?));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// A number that a mesh has, 0 where it cannot be read.
///
/// # Safety
/// As for [`mesh_of`].
unsafe fn count(mesh: *const WeltMesh, count: impl FnOnce(&Mesh) -> usize) -> usize {
    // SAFETY: as for this function.
    boundary_value(0, || unsafe { mesh_of(mesh) }.map_or(0, count))
}

/// Number of vertices; 0 where mesh is NULL or poisoned. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_vertex_count(mesh: *const WeltMesh) -> usize {
    // SAFETY: the header asks for NULL or a living mesh.
    unsafe { count(mesh, Mesh::vertex_bound) }
}

/// Number of edges; 0 where mesh is NULL or poisoned. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_edge_count(mesh: *const WeltMesh) -> usize {
    // SAFETY: the header asks for NULL or a living mesh.
    unsafe { count(mesh, |mesh| mesh.half_edge_bound() / 2) }
}

/// Number of faces; 0 where mesh is NULL or poisoned. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_face_count(mesh: *const WeltMesh) -> usize {
    // SAFETY: the header asks for NULL or a living mesh.
    unsafe { count(mesh, Mesh::face_bound) }
}

/// Sum of the numbers of vertices of all faces; 0 where mesh is NULL or poisoned. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_face_vertex_count(mesh: *const WeltMesh) -> usize {
    // SAFETY: the header asks for NULL or a living mesh.
    unsafe { count(mesh, face_vertex_count) }
}

fn face_vertex_count(mesh: &Mesh) -> usize {
    mesh.faces().map(|f| mesh.arity(f)).sum()
}

/// The positions of the vertices as a view.
///
/// mesh: must not be NULL.
/// positions: receives the address of x, y and z of each vertex, 3 * welt_mesh_vertex_count(mesh) doubles that belong to
/// the mesh and are valid until it is changed or freed.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_positions(
    mesh: *const WeltMesh,
    positions: *mut *const f64,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh and a place for the address.
        let (mesh, output) = unsafe { (mesh_of(mesh)?, Output::new(positions, "positions")?) };
        // Three doubles one after the other: `DVec3` is `repr(C)`.
        output.set(mesh.positions().as_ptr().cast());
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Moves all vertices.
///
/// mesh: must not be NULL.
/// positions: x, y and z of each vertex, finite numbers.
/// vertex_count: must be that of the mesh.
/// stride: bytes from one vertex to the next, a multiple of 8 and at least 24; 0 for 24.
///
/// After a failure the mesh is as it was before. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_set_positions(
    mesh: *mut WeltMesh,
    positions: *const f64,
    vertex_count: usize,
    stride: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for an array of this count.
        let positions = unsafe { arguments::points(positions, vertex_count, stride, "positions") }?;
        // SAFETY: the header asks for a living mesh that nobody else uses. The positions, which may have been a view of
        // it, are copied by now.
        let mesh = unsafe { arguments::handle_mut(mesh, "mesh") }?;
        let expected = mesh.read()?.vertex_bound();
        if vertex_count != expected {
            return Err(Failure::argument(format!(
                "vertex_count is {vertex_count}; the mesh has {expected} vertices"
            )));
        }
        check_places(&positions)?;
        mesh.change(|mesh| {
            for (id, &position) in positions.iter().enumerate() {
                mesh.set_position(VertexId(id as u32), position);
                fault::point("positions");
            }
            Ok(())
        })
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

fn check_places(positions: &[DVec3]) -> Result<(), Failure> {
    const MESSAGE: &str = "a coordinate is not a number from -1e50 to 1e50";
    let places: Vec<Place> = positions
        .iter()
        .enumerate()
        .filter(|(_, position)| !is_place(**position))
        .map(|(id, _)| Place::vertex(id as u32, MESSAGE))
        .collect();
    if places.is_empty() {
        return Ok(());
    }
    let message =
        format!("{} vertices have a coordinate that is not a number from -1e50 to 1e50", places.len());
    Err(Failure { code: WELT_ERROR_MESH, message, places })
}

/// Writes the faces, in the form that welt_mesh_create takes.
///
/// mesh: must not be NULL.
/// face_sizes: receives the number of vertices of each face.
/// face_capacity: room in face_sizes, at least welt_mesh_face_count(mesh) elements.
/// face_vertices: receives the vertices of all faces one after the other, counter-clockwise, 0-based.
/// face_vertex_capacity: room in face_vertices, at least welt_mesh_face_vertex_count(mesh) elements.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_faces(
    mesh: *const WeltMesh,
    face_sizes: *mut u32,
    face_capacity: usize,
    face_vertices: *mut u32,
    face_vertex_capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh.
        let mesh = unsafe { mesh_of(mesh) }?;
        let (faces, corners) = (mesh.face_bound(), face_vertex_count(mesh));
        // SAFETY: the header asks for buffers of these capacities.
        let (sizes, vertices) = unsafe {
            (
                Buffer::new(face_sizes, face_capacity, faces, "face_sizes")?,
                Buffer::new(face_vertices, face_vertex_capacity, corners, "face_vertices")?,
            )
        };
        sizes.fill(mesh.faces().map(|f| mesh.arity(f) as u32));
        vertices.fill(mesh.faces().flat_map(|f| mesh.face_vertices(f)).map(|v| v.0));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Writes the two vertices of each edge, in the order in which welt_refinement_vertex_parents numbers the edges of level 0.
///
/// mesh: must not be NULL.
/// vertices: receives two vertices per edge.
/// capacity: room in vertices, at least 2 * welt_mesh_edge_count(mesh) elements.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_edges(
    mesh: *const WeltMesh,
    vertices: *mut u32,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh.
        let mesh = unsafe { mesh_of(mesh) }?;
        // SAFETY: the header asks for a buffer of this capacity.
        let buffer = unsafe { Buffer::new(vertices, capacity, mesh.half_edge_bound(), "vertices") }?;
        buffer.fill(mesh.half_edges().map(|h| mesh.source(h).0));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

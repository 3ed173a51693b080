//! `welt_refinement`.

use super::arguments::{self, Buffer, Output};
use super::boundary::{boundary, boundary_value};
use super::error::WeltError;
use super::failure::Failure;
use super::job::WeltJob;
use super::mesh::{WeltMesh, mesh_of};
use crate::job::Job;
use crate::memory;
use crate::mesh::Mesh;
use crate::subdivision::{Level, Refinement, VertexParent};
use glam::DVec3;

/// The vertex stands for a vertex of the level before.
pub const WELT_PARENT_VERTEX: u32 = 0;
/// The vertex stands for an edge of the level before.
pub const WELT_PARENT_EDGE: u32 = 1;
/// The vertex stands for a face of the level before.
pub const WELT_PARENT_FACE: u32 = 2;

/// The Catmull-Clark refinements of a mesh, level by level. Level 0 is the mesh itself as it was. Never changes, and does
/// not depend on the mesh after it was made.
pub struct WeltRefinement {
    refinement: Refinement,
    /// Of every level.
    positions: Vec<Vec<DVec3>>,
}

impl WeltRefinement {
    fn new(mesh: &Mesh, depth: u32, job: Option<&WeltJob>) -> Result<Self, Failure> {
        let idle = Job::new();
        let job = job.map_or(&idle, |job| &job.job);
        job.step("refine", 0.0)?;
        let refinement = Refinement::new(mesh, depth as usize)?;
        let mut positions = vec![refinement.control_positions(mesh)];
        for level in 0..refinement.depth() {
            job.step("refine", (level + 1) as f64 / (refinement.depth() + 1) as f64)?;
            let mut next = Vec::new();
            refinement.refine_positions(level, &positions[level], &mut next)?;
            positions.push(next);
        }
        job.step("refine", 1.0)?;
        Ok(Self { refinement, positions })
    }

    /// A level, if there is one of this number, and its positions.
    fn level(&self, level: u32) -> Result<(&Level, &[DVec3]), Failure> {
        let depth = self.refinement.depth();
        match self.positions.get(level as usize) {
            Some(positions) => Ok((self.refinement.level(level as usize), positions)),
            None => Err(Failure::argument(format!("there is no level {level}; the last is {depth}"))),
        }
    }
}

/// Refines a mesh.
///
/// mesh: must not be NULL.
/// depth: number of the last level, 0 or more; each level has four times the faces of the one before.
/// job: may be NULL.
/// refinement: receives the handle; free it with welt_refinement_free.
///
/// Fails with WELT_ERROR_TOO_LARGE before anything is computed where a level would have more elements than 31 bits can
/// number, with WELT_ERROR_MEMORY, and with WELT_ERROR_CANCELLED. Memory: about 100 bytes for each face of the last level.
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_create(
    mesh: *const WeltMesh,
    depth: u32,
    job: *const WeltJob,
    refinement: *mut *mut WeltRefinement,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh, NULL or a living job, and a place for the handle.
        let (mesh, job, output) = unsafe {
            (mesh_of(mesh)?, arguments::optional(job, "job")?, Output::new(refinement, "refinement")?)
        };
        output.handle(WeltRefinement::new(mesh, depth, job)?);
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Frees a refinement. NULL is allowed. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_free(refinement: *mut WeltRefinement) {
    // SAFETY: the header asks for NULL or a refinement that was not freed.
    unsafe { arguments::free(refinement) };
}

/// A number that a level has, 0 where there is no such level.
///
/// # Safety
/// `refinement` is NULL or a living refinement.
unsafe fn count(refinement: *const WeltRefinement, level: u32, count: fn(&Level) -> usize) -> usize {
    boundary_value(0, || {
        // SAFETY: as for this function.
        let refinement = unsafe { arguments::handle(refinement, "refinement") };
        refinement.and_then(|r| r.level(level)).map_or(0, |(level, _)| count(level))
    })
}

/// Number of vertices of a level; 0 where refinement is NULL or has no such level. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_vertex_count(
    refinement: *const WeltRefinement,
    level: u32,
) -> usize {
    // SAFETY: the header asks for NULL or a living refinement.
    unsafe { count(refinement, level, Level::vertex_count) }
}

/// Number of edges of a level; 0 where refinement is NULL or has no such level. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_edge_count(refinement: *const WeltRefinement, level: u32) -> usize {
    // SAFETY: the header asks for NULL or a living refinement.
    unsafe { count(refinement, level, Level::edge_count) }
}

/// Number of faces of a level; 0 where refinement is NULL or has no such level. All levels but 0 have quads only.
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_face_count(refinement: *const WeltRefinement, level: u32) -> usize {
    // SAFETY: the header asks for NULL or a living refinement.
    unsafe { count(refinement, level, Level::face_count) }
}

/// Sum of the numbers of vertices of all faces of a level; 0 where refinement is NULL or has no such level. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_face_vertex_count(
    refinement: *const WeltRefinement,
    level: u32,
) -> usize {
    // SAFETY: the header asks for NULL or a living refinement.
    unsafe { count(refinement, level, |level| level.face_vertices().len()) }
}

/// The positions of the vertices of a level as a view.
///
/// refinement: must not be NULL.
/// level: 0 to the depth.
/// positions: receives the address of x, y and z of each vertex, 3 * welt_refinement_vertex_count(refinement, level)
/// doubles that belong to the refinement and are valid until it is freed.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_positions(
    refinement: *const WeltRefinement,
    level: u32,
    positions: *mut *const f64,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living refinement and a place for the address.
        let (refinement, output) =
            unsafe { (arguments::handle(refinement, "refinement")?, Output::new(positions, "positions")?) };
        // Three doubles one after the other: `DVec3` is `repr(C)`.
        output.set(refinement.level(level)?.1.as_ptr().cast());
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// The vertices of the faces of a level as a view.
///
/// refinement: must not be NULL.
/// level: 0 to the depth.
/// vertices: receives the address of the vertices of all faces one after the other, counter-clockwise, 0-based:
/// welt_refinement_face_vertex_count(refinement, level) numbers that belong to the refinement and are valid until it is freed. On level 1 and above there are 4 per face: a face covers one
/// corner of a face of the level before, and has the point of that corner, of the edge that leaves it, of the face, and
/// of the edge that arrives. On level 0 the numbers of vertices are those that welt_mesh_faces gives.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_face_vertices(
    refinement: *const WeltRefinement,
    level: u32,
    vertices: *mut *const u32,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living refinement and a place for the address.
        let (refinement, output) =
            unsafe { (arguments::handle(refinement, "refinement")?, Output::new(vertices, "vertices")?) };
        output.set(refinement.level(level)?.0.face_vertices().as_ptr());
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Gives a level as a mesh: another control mesh of the same surface. It has the sharpness that is left and the options of
/// subdivision; faces without a limit surface are holes.
///
/// refinement: must not be NULL.
/// level: 0 to the depth.
/// mesh: receives the handle; free it with welt_mesh_free.
///
/// Its vertices and faces are numbered as those of the level, so that welt_mesh_limit_positions of it moves the level onto
/// the limit surface. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_mesh(
    refinement: *const WeltRefinement,
    level: u32,
    mesh: *mut *mut WeltMesh,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living refinement and a place for the handle.
        let (refinement, output) =
            unsafe { (arguments::handle(refinement, "refinement")?, Output::new(mesh, "mesh")?) };
        let (_, positions) = refinement.level(level)?;
        let polygons = refinement.refinement.polygons(level as usize, memory::copied(positions)?)?;
        output.handle(WeltMesh::new(Mesh::from_polygons(&polygons)?));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// What the vertices of a level stand for on the level before.
///
/// refinement: must not be NULL.
/// level: 1 to the depth.
/// kinds: receives one of WELT_PARENT_* per vertex.
/// elements: receives the number of that vertex, edge or face.
/// capacity: room in each of both, at least welt_refinement_vertex_count(refinement, level) elements.
///
/// Points of vertices come first, then those of edges, then those of faces, each in the order of the elements.
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_vertex_parents(
    refinement: *const WeltRefinement,
    level: u32,
    kinds: *mut u32,
    elements: *mut u32,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living refinement.
        let refinement = unsafe { arguments::handle(refinement, "refinement") }?;
        let count = child_level(refinement, level)?.vertex_count();
        // SAFETY: the header asks for buffers of this capacity.
        let (kinds, elements) = unsafe {
            (
                Buffer::new(kinds, capacity, count, "kinds")?,
                Buffer::new(elements, capacity, count, "elements")?,
            )
        };
        let parents = || {
            (0..count as u32).filter_map(|v| refinement.refinement.vertex_parent(level as usize, v)).map(
                |parent| match parent {
                    VertexParent::Vertex(id) => (WELT_PARENT_VERTEX, id),
                    VertexParent::Edge(id) => (WELT_PARENT_EDGE, id),
                    VertexParent::Face(id) => (WELT_PARENT_FACE, id),
                },
            )
        };
        kinds.fill(parents().map(|(kind, _)| kind));
        elements.fill(parents().map(|(_, id)| id));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Which faces of the level before the faces of a level cover.
///
/// refinement: must not be NULL.
/// level: 1 to the depth.
/// faces: receives the face of the level before per face.
/// corners: receives the corner of that face, 0-based.
/// capacity: room in each of both, at least welt_refinement_face_count(refinement, level) elements.
///
/// Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_refinement_face_parents(
    refinement: *const WeltRefinement,
    level: u32,
    faces: *mut u32,
    corners: *mut u32,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living refinement.
        let refinement = unsafe { arguments::handle(refinement, "refinement") }?;
        let count = child_level(refinement, level)?.face_count();
        // SAFETY: the header asks for buffers of this capacity.
        let (faces, corners) = unsafe {
            (Buffer::new(faces, capacity, count, "faces")?, Buffer::new(corners, capacity, count, "corners")?)
        };
        let parents =
            || (0..count as u32).filter_map(|f| refinement.refinement.face_parent(level as usize, f));
        faces.fill(parents().map(|(face, _)| face));
        corners.fill(parents().map(|(_, corner)| corner));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// A level that has a level before it.
fn child_level(refinement: &WeltRefinement, level: u32) -> Result<&Level, Failure> {
    if level == 0 {
        return Err(Failure::argument("level is 0, which has no level before it"));
    }
    Ok(refinement.level(level)?.0)
}

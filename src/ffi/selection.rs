//! `welt_selection`.

use super::arguments::{self, Buffer, Output};
use super::boundary::{boundary, boundary_value};
use super::error::WeltError;
use super::failure::{Failure, Location, Place};
use super::mesh::{WeltMesh, mesh_of};
use crate::mark::{self, Selection, Selector};
use crate::mesh::Mesh;
use std::ffi::c_char;

/// Marked edges: which edges of a mesh a feature crosses, and where. Never changes; it belongs to the mesh as it was when the
/// selection was made.
pub struct WeltSelection {
    selection: Selection,
    /// The vertices of each marked edge, by which a mesh that has changed since is told.
    edges: Vec<[u32; 2]>,
}

impl WeltSelection {
    fn new(mesh: &Mesh, selection: Selection) -> Self {
        let edges = selection
            .marks
            .iter()
            .map(|mark| [mesh.source(mark.half_edge).0, mesh.target(mark.half_edge).0])
            .collect();
        Self { selection, edges }
    }

    /// The marks, for the mesh on which they name the edges they were made for.
    pub(super) fn on(&self, mesh: &Mesh) -> Result<&Selection, Failure> {
        for (mark, &[a, b]) in self.selection.marks.iter().zip(&self.edges) {
            let h = mark.half_edge;
            if !mesh.has_half_edge(h) || [mesh.source(h).0, mesh.target(h).0] != [a, b] {
                let message = format!(
                    "the selection marks edge {a},{b} of another mesh, or of this one before it was changed; make it anew"
                );
                let place = Place { location: Location::Edge(a, b), message: message.clone(), text: None };
                return Err(Failure { places: vec![place], ..Failure::argument(message) });
            }
        }
        Ok(&self.selection)
    }
}

/// Finds the edges that selectors name.
///
/// mesh: must not be NULL.
/// selectors: one or more, separated by blanks or newlines, UTF-8: edge:A,B[@t] (crossed at t in (0, 1) from A, 0.5 unless
/// given), ring:A,B (the edges a loop cut from AB crosses), path:A,B:C,D (shortest path of quads between two edges),
/// cut:V,V,... (all edges that leave a set of vertices), polyline:X,Y,Z;X,Y,Z;... and spline:X,Y,Z;... (a curve on or near the
/// surface, model units, with ;closed at the end if it closes; which edges it crosses is found when a feature is applied),
/// select:FILE (JSON). Vertices are 0-based; #kind may follow.
/// length: in bytes, SIZE_MAX for a NUL-terminated text.
/// selection: receives the handle; free it with welt_selection_free.
///
/// Fails with WELT_ERROR_ARGUMENT: what is wrong and what there is; WELT_ERROR_FILE where a mark file cannot be used. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_selection_create(
    mesh: *const WeltMesh,
    selectors: *const c_char,
    length: usize,
    selection: *mut *mut WeltSelection,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh, a string of this length and a place for the handle.
        let (mesh, text, output) = unsafe {
            (
                mesh_of(mesh)?,
                arguments::text(selectors, length, "selectors")?,
                Output::new(selection, "selection")?,
            )
        };
        let selectors: Vec<Selector> =
            text.split_whitespace().map(Selector::parse).collect::<Result<_, _>>()?;
        output.handle(WeltSelection::new(mesh, Selection::resolve(mesh, &selectors)?));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Frees a selection. NULL is allowed. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_selection_free(selection: *mut WeltSelection) {
    // SAFETY: the header asks for NULL or a selection that was not freed.
    unsafe { arguments::free(selection) };
}

/// Number of marked edges, those of curves not counted; 0 where selection is NULL. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_selection_count(selection: *const WeltSelection) -> usize {
    boundary_value(0, || {
        // SAFETY: the header asks for NULL or a living selection.
        let selection = unsafe { arguments::optional(selection, "selection") };
        selection.ok().flatten().map_or(0, |s| s.selection.marks.len())
    })
}

/// Writes the marked edges.
///
/// selection: must not be NULL.
/// mesh: the mesh the selection was made on, unchanged since.
/// edges: receives two vertices per edge.
/// capacity: room in edges, at least 2 * welt_selection_count(selection) elements.
/// places: may be NULL; else receives, per edge, where it is crossed, in (0, 1) from the first vertex.
/// place_capacity: room in places, at least welt_selection_count(selection) doubles.
///
/// Fails with WELT_ERROR_ARGUMENT where the mesh is another or has changed, and WELT_ERROR_BUFFER. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_selection_edges(
    selection: *const WeltSelection,
    mesh: *const WeltMesh,
    edges: *mut u32,
    capacity: usize,
    places: *mut f64,
    place_capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living selection and mesh.
        let (selection, mesh) = unsafe { (arguments::handle(selection, "selection")?, mesh_of(mesh)?) };
        let marks = &selection.on(mesh)?.marks;
        // SAFETY: the header asks for buffers of these capacities.
        let ids = unsafe { Buffer::new(edges, capacity, 2 * marks.len(), "edges") }?;
        if !places.is_null() {
            // SAFETY: as above.
            let places = unsafe { Buffer::new(places, place_capacity, marks.len(), "places") }?;
            places.fill(marks.iter().map(|mark| mark.t));
        }
        ids.fill(selection.edges.as_flattened().iter().copied());
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Stores the marks on the mesh, as the attributes color and t of both half-edges, for rules that look for them.
/// welt_feature_apply and welt_rules_apply do so by themselves.
///
/// mesh: is changed; the mesh the selection was made on, its edges unchanged since.
/// selection: must not be NULL.
///
/// Fails with WELT_ERROR_ARGUMENT where the mesh is another or has changed; nothing is stored then. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_mesh_mark(
    mesh: *mut WeltMesh,
    selection: *const WeltSelection,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living mesh that nobody else uses and a living selection.
        let (mesh, selection) =
            unsafe { (arguments::handle_mut(mesh, "mesh")?, arguments::handle(selection, "selection")?) };
        mesh.change(|mesh| {
            mark::place(mesh, &selection.on(mesh)?.marks);
            Ok(())
        })
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

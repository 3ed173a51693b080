//! Closest points, distances and line hits, many at a time.

use super::arguments::{self, Buffer, Output, RowBuffer, Rows};
use super::boundary::boundary;
use super::error::{WELT_NONE, WeltError};
use super::evaluate::WeltBatchOptions;
use super::failure::Failure;
use super::options;
use super::status::WELT_ERROR_BUFFER;
use super::surface::WeltSurface;
use crate::fault;
use crate::memory;
use crate::mesh::FaceId;
use crate::surface::{ClosestOptions, Foot, Hit, LimitSurface, Parameter};
use crate::threads::in_ranges;
use glam::DVec3;

/// A point of the surface that a query found.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct WeltSurfacePoint {
    /// The face in which it lies; WELT_NONE where nothing was found, the rest is 0 then.
    pub face: u32,
    /// The patch of the face; see welt_surface_evaluate.
    pub corner: u32,
    /// Parameter of the patch.
    pub u: f64,
    /// Parameter of the patch.
    pub v: f64,
    /// x, y and z.
    pub position: [f64; 3],
    /// The unit normal, outwards; (0, 0, 0) where the surface has none.
    pub normal: [f64; 3],
    /// For a closest point the distance; for a hit the parameter s of the line: the hit is origin + s * direction.
    pub distance: f64,
}

/// Where nothing was found.
fn nothing() -> WeltSurfacePoint {
    WeltSurfacePoint {
        face: WELT_NONE,
        corner: 0,
        u: 0.0,
        v: 0.0,
        position: [0.0; 3],
        normal: [0.0; 3],
        distance: 0.0,
    }
}

impl From<Foot> for WeltSurfacePoint {
    fn from(foot: Foot) -> Self {
        let Foot { face, corner, u, v, position, normal, distance, .. } = foot;
        Self {
            face: face.0,
            corner: corner as u32,
            u,
            v,
            position: position.into(),
            normal: normal.into(),
            distance,
        }
    }
}

impl From<Hit> for WeltSurfacePoint {
    fn from(hit: Hit) -> Self {
        let Hit { face, corner, u, v, position, normal, s, .. } = hit;
        Foot { face, corner, u, v, position, normal, distance: s }.into()
    }
}

/// What is asked of a surface: the rows of one array.
struct Batch<'a> {
    surface: &'a LimitSurface,
    rows: Rows<'a>,
    count: usize,
    options: WeltBatchOptions,
}

impl<'a> Batch<'a> {
    /// # Safety
    /// `surface` is NULL or a living one, `options` NULL or initialised, `input` NULL or `count` rows of `width` doubles that
    /// nobody changes during the call.
    unsafe fn new(
        surface: *const WeltSurface,
        options: *const WeltBatchOptions,
        input: *const f64,
        [count, width]: [usize; 2],
        name: &str,
    ) -> Result<Self, Failure> {
        // SAFETY: as for this function.
        unsafe {
            let surface = &arguments::handle(surface, "surface")?.target.surface;
            let options = options::complete(options)?;
            let rows = Rows::new(input, count, width, options.input_stride, name)?;
            Ok(Self { surface, rows, count, options })
        }
    }

    /// The answers for all rows, in order. Nothing is written before they are complete.
    fn answers<T: Send>(
        &self,
        query: impl Fn(&LimitSurface, usize, &[f64]) -> T + Sync,
    ) -> Result<Vec<T>, Failure> {
        self.surface.prepare()?;
        let parts = in_ranges(self.count, self.options.threads as usize, 16, |range| {
            let count = range.len();
            let rows = self.rows.range(range.clone()).zip(range);
            let answer = |(row, i)| {
                fault::point("query");
                query(self.surface, i, row)
            };
            memory::collected(count, rows.map(answer))
        });
        let mut all = memory::room(self.count)?;
        for part in parts {
            all.extend(part?);
        }
        Ok(all)
    }
}

/// Finds the point of the surface that is closest to each of many points, exactly: also beside extraordinary vertices,
/// creases and boundaries.
///
/// surface: must not be NULL.
/// points: x, y and z of each point.
/// count: number of points.
/// radius: points of the surface at this distance and farther are not found; infinity for no limit.
/// starts: per point a place of the surface near which the closest point is thought to be, of which face, corner, u and v are
/// read; the result is the same, sooner where the thought is right. NULL where there are none; one that is no place of the
/// surface is passed over.
/// options: threads and the stride of points; NULL for the defaults.
/// found: receives the closest points. Where nothing lies within the radius, where the surface is empty and where a
/// coordinate is NaN or beyond 1e60 the face is WELT_NONE. Of several points that are equally close one is found.
/// capacity: room in found, at least count elements.
///
/// Fails with WELT_ERROR_ARGUMENT where radius is NaN. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_surface_closest(
    surface: *const WeltSurface,
    points: *const f64,
    count: usize,
    radius: f64,
    starts: *const WeltSurfacePoint,
    options: *const WeltBatchOptions,
    found: *mut WeltSurfacePoint,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        if radius.is_nan() {
            return Err(Failure::argument("radius is NaN"));
        }
        // SAFETY: the header asks for a living surface, initialised options or NULL, and arrays and a buffer of these sizes.
        let (batch, starts, buffer) = unsafe {
            (
                Batch::new(surface, options, points, [count, 3], "points")?,
                if starts.is_null() { &[] } else { arguments::array(starts, count, "starts")? },
                Buffer::new(found, capacity, count, "found")?,
            )
        };
        let wanted = ClosestOptions { radius, facing: None };
        let results = batch.answers(|surface, i, row| {
            let point = DVec3::from_slice(row);
            let foot = match starts.get(i) {
                Some(&WeltSurfacePoint { face, corner, u, v, .. }) => {
                    surface.closest_from(Parameter { face: FaceId(face), corner, u, v }, point, &wanted)
                }
                None => surface.closest(point, &wanted),
            };
            foot.map_or_else(nothing, Into::into)
        })?;
        buffer.fill(results);
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Measures the distance of each of many points to a closed surface, negative inside: where the winding number of the
/// surface is positive. Parts that overlap count as one solid; what lies in a hollow, whose normals point inwards, is outside.
/// The distance is that of the nearest point of the surface, also where this lies inside another part.
///
/// surface: must not be NULL.
/// points: x, y and z of each point.
/// count: number of points.
/// options: threads and strides; NULL for the defaults.
/// distances: receives the distances; NaN where a coordinate is NaN or beyond 1e60.
/// capacity: room in distances, in doubles up to the last distance.
///
/// Fails with WELT_ERROR_ARGUMENT where the surface has a border: not all faces of a closed mesh are frozen, or some have no
/// surface. Since: 0.1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn welt_surface_signed_distances(
    surface: *const WeltSurface,
    points: *const f64,
    count: usize,
    options: *const WeltBatchOptions,
    distances: *mut f64,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        // SAFETY: the header asks for a living surface, initialised options or NULL, and arrays and a buffer of these sizes.
        let (batch, buffer) = unsafe {
            let batch = Batch::new(surface, options, points, [count, 3], "points")?;
            let rows = [count, 1, batch.options.output_stride];
            (batch, RowBuffer::new(distances, capacity, rows, "distances")?)
        };
        if !batch.surface.is_closed() {
            return Err(Failure::argument("the surface has a border, so that it has no inside"));
        }
        let results = batch
            .answers(|surface, _, row| surface.solid_distance(DVec3::from_slice(row)).unwrap_or(f64::NAN))?;
        for (i, distance) in results.iter().enumerate() {
            // SAFETY: there is one thread again.
            unsafe { buffer.write(i, std::slice::from_ref(distance)) };
        }
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Finds the first point in which each of many lines meets the surface, exactly: edges and vertices let nothing through.
///
/// surface: must not be NULL.
/// lines: x, y and z of the origin and of the direction of each line, which need not have length 1.
/// count: number of lines.
/// first: smallest parameter s that counts: 0 for rays, minus infinity for whole lines.
/// last: largest parameter s that counts.
/// options: threads and the stride of lines; NULL for the defaults.
/// found: receives per line the hit with the smallest amount of s. Where there is none, where the direction is 0 and where a
/// coordinate is not finite the face is WELT_NONE.
/// capacity: room in found, at least count elements.
///
/// A line that touches the surface without crossing it hits it there, within the rounding of the coordinates. Fails with
/// WELT_ERROR_ARGUMENT where first or last is NaN. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_surface_first_hits(
    surface: *const WeltSurface,
    lines: *const f64,
    count: usize,
    first: f64,
    last: f64,
    options: *const WeltBatchOptions,
    found: *mut WeltSurfacePoint,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        check_range(first, last)?;
        // SAFETY: the header asks for a living surface, initialised options or NULL, and arrays and a buffer of these sizes.
        let (batch, buffer) = unsafe {
            (
                Batch::new(surface, options, lines, [count, 6], "lines")?,
                Buffer::new(found, capacity, count, "found")?,
            )
        };
        let results = batch.answers(|surface, _, row| {
            let [origin, direction] = line(row);
            surface.first_line_hit(origin, direction, first, last).map_or_else(nothing, Into::into)
        })?;
        buffer.fill(results);
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

/// Finds all points in which each of many lines meets the surface.
///
/// surface, lines, count, first, last, options: as for welt_surface_first_hits.
/// starts: receives count + 1 numbers: the hits of line i are those from starts[i] up to starts[i + 1], exclusive, by s.
/// needed: receives the number of all hits, also where found has no room for them. May be NULL.
/// found: receives the hits. NULL with capacity 0 to ask for their number.
/// capacity: room in found.
///
/// A hit on an edge that faces share, or at a vertex, is given once. A line that lies in the surface gives some of the points
/// that they share. Fails with WELT_ERROR_BUFFER where found is too small: then needed is written, and nothing else; and with
/// WELT_ERROR_ARGUMENT where first or last is NaN. Since: 0.1.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn welt_surface_all_hits(
    surface: *const WeltSurface,
    lines: *const f64,
    count: usize,
    first: f64,
    last: f64,
    options: *const WeltBatchOptions,
    starts: *mut usize,
    needed: *mut usize,
    found: *mut WeltSurfacePoint,
    capacity: usize,
    error: *mut *mut WeltError,
) -> i32 {
    let body = || {
        check_range(first, last)?;
        let rooms = count.checked_add(1).ok_or_else(|| Failure::argument("count is too large"))?;
        // SAFETY: the header asks for a living surface, initialised options or NULL, and arrays and buffers of these sizes.
        let (batch, starts, needed) = unsafe {
            (
                Batch::new(surface, options, lines, [count, 6], "lines")?,
                Buffer::new(starts, rooms, rooms, "starts")?,
                Output::optional(needed, "needed")?,
            )
        };
        let hits = batch.answers(|surface, _, row| {
            let [origin, direction] = line(row);
            surface.line_hits_between(origin, direction, first, last)
        })?;
        let total = hits.iter().map(Vec::len).sum();
        let buffer = if capacity < total {
            Err(Failure::new(
                WELT_ERROR_BUFFER,
                format!("found has room for {capacity} hits; {total} are needed"),
            ))
        } else {
            // SAFETY: the header asks for a buffer of this capacity.
            Ok(unsafe { Buffer::new(found, capacity, total, "found") }?)
        };
        if let Some(needed) = needed {
            needed.set(total);
        }
        let buffer = buffer?;
        let ends = hits.iter().scan(0, |end, hits| {
            *end += hits.len();
            Some(*end)
        });
        starts.fill(std::iter::once(0).chain(ends));
        buffer.fill(hits.iter().flatten().map(|&hit| hit.into()));
        Ok(())
    };
    // SAFETY: the header asks for NULL or a place for an error.
    unsafe { boundary(error, body) }
}

fn check_range(first: f64, last: f64) -> Result<(), Failure> {
    if first.is_nan() || last.is_nan() {
        return Err(Failure::argument("first or last is NaN"));
    }
    Ok(())
}

fn line(row: &[f64]) -> [DVec3; 2] {
    let (origin, direction) = row.split_at(3);
    [DVec3::from_slice(origin), DVec3::from_slice(direction)]
}

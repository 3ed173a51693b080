//! Evaluation of many points at once.

use super::kernel::{self, Derivatives, Four, Plain};
use super::places::{Entry, Located};
use super::{Jet, LimitSurface};
use crate::mesh::FaceId;
use crate::subdivision::SurfacePoint;
use pulp::NullaryFnOnce;
use std::hint::black_box;
use std::ops::Range;

/// Points whose data is fetched before the first of them is evaluated, so that the waits overlap.
const AHEAD: usize = 16;
/// Surfaces of fewer bicubics stay in the caches.
const LARGE: usize = 4096;

/// Where to evaluate.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Parameter {
    /// The face.
    pub face: FaceId,
    /// Its patch; see [`evaluate`](crate::subdivision::evaluate).
    pub corner: u32,
    /// Parameter in [0, 1]; what lies outside is moved to the nearest inside.
    pub u: f64,
    /// As `u`.
    pub v: f64,
}

impl LimitSurface {
    /// Evaluates many points, faster than one by one: per point the position, the derivatives by u and by v, and those by u
    /// twice, by u and v, by v twice, as far as `derivatives` asks for them. `at` tells the place of point `i` of `points`,
    /// `sink` takes its values ([`Derivatives::values`] numbers), in order. Second derivatives at an extraordinary vertex,
    /// and everything where [`evaluate`](Self::evaluate) gives `None`, are NaN.
    ///
    /// Points in any order; those that are sorted by face cost less on large surfaces. The results do not depend on the
    /// instructions that the machine has.
    pub fn evaluate_all(
        &self,
        points: Range<usize>,
        derivatives: Derivatives,
        at: impl Fn(usize) -> Parameter,
        sink: impl FnMut(usize, &[f64]),
    ) {
        match derivatives {
            Derivatives::None => self.run::<0, _, _>(points, at, sink),
            Derivatives::First => self.run::<1, _, _>(points, at, sink),
            Derivatives::Second => self.run::<2, _, _>(points, at, sink),
        }
    }

    fn run<const ORDER: usize, A: Fn(usize) -> Parameter, S: FnMut(usize, &[f64])>(
        &self,
        points: Range<usize>,
        at: A,
        sink: S,
    ) {
        #[cfg(target_arch = "x86_64")]
        if let Some(four) = pulp::x86::V3::try_new() {
            return pulp::Simd::vectorize(
                four,
                Batch::<ORDER, _, _, _> { surface: self, four, points, at, sink },
            );
        }
        Batch::<ORDER, _, _, _> { surface: self, four: Plain, points, at, sink }.call();
    }
}

struct Batch<'a, const ORDER: usize, F, A, S> {
    surface: &'a LimitSurface,
    four: F,
    points: Range<usize>,
    at: A,
    sink: S,
}

impl<const ORDER: usize, F: Four, A: Fn(usize) -> Parameter, S: FnMut(usize, &[f64])> NullaryFnOnce
    for Batch<'_, ORDER, F, A, S>
{
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        let mut places = [None; AHEAD];
        let mut found = Found { face: FaceId(0), corner: 0, entry: None };
        let mut first = self.points.start;
        while first < self.points.end {
            let count = AHEAD.min(self.points.end - first);
            let mut touched = 0.0;
            for (i, place) in places.iter_mut().take(count).enumerate() {
                let at = (self.at)(first + i);
                if !found.is_at(&at) {
                    found = self.surface.find(&at);
                    touched += found.entry.map_or(0.0, |entry| self.surface.touch(entry));
                }
                *place = self.surface.locate(&at, &found);
            }
            black_box(touched);
            for (i, place) in places.iter().take(count).enumerate() {
                let mut values = [0.0; 18];
                match place {
                    Some(place) => self.surface.write::<ORDER, F>(self.four, place, &mut values),
                    None => values.fill(f64::NAN),
                }
                (self.sink)(first + i, &values[..3 * [1, 3, 6][ORDER]]);
            }
            first += count;
        }
    }
}

/// The patch of the point before: sorted points stay in it.
struct Found {
    face: FaceId,
    corner: u32,
    entry: Option<Entry>,
}

impl Found {
    #[inline(always)]
    fn is_at(&self, at: &Parameter) -> bool {
        self.entry.is_some() && self.face == at.face && self.corner == at.corner
    }
}

impl LimitSurface {
    #[inline(always)]
    fn find(&self, at: &Parameter) -> Found {
        let patches = self.faces.patches(at.face);
        let exists = at.corner < patches.end - patches.start;
        let entry = exists.then(|| self.patches.get((patches.start + at.corner) as usize).copied()).flatten();
        Found { face: at.face, corner: at.corner, entry }
    }

    #[inline(always)]
    fn locate(&self, at: &Parameter, found: &Found) -> Option<Located> {
        if at.u.is_nan() || at.v.is_nan() {
            return None;
        }
        Some(Located::new(found.entry?, &self.parts, at.u.clamp(0.0, 1.0), at.v.clamp(0.0, 1.0)))
    }

    /// Reads from each cache line of the bicubic, so that it is there soon.
    #[inline(always)]
    fn touch(&self, entry: Entry) -> f64 {
        match entry {
            Entry::Regular(piece) if self.bicubics.len() > LARGE => {
                let [a, b, c, d] = &self.bicubics[piece as usize].points;
                (a[0].x + a[3].x) + (b[2].x + c[1].x) + (c[3].z + d[3].x)
            }
            _ => 0.0,
        }
    }

    #[inline(always)]
    fn write<const ORDER: usize, F: Four>(&self, four: F, place: &Located, values: &mut [f64; 18]) {
        let jet = match place.entry {
            Entry::Corner { corner, .. } => {
                match self.corners.jet::<ORDER, F>(four, corner, place.u, place.v) {
                    Some(jet) => jet,
                    None => return write_point(self.evaluate_located(place), values),
                }
            }
            Entry::Regular(piece) | Entry::Split(piece) => {
                kernel::jet::<ORDER, F>(four, &self.bicubics[piece as usize], place.u, place.v)
            }
        };
        write_jet(&place.in_patch(jet), values);
    }
}

#[inline(always)]
fn write_jet(jet: &Jet, values: &mut [f64; 18]) {
    let (slots, _) = values.as_chunks_mut::<3>();
    for (slot, vector) in slots.iter_mut().zip([jet.position, jet.du, jet.dv, jet.duu, jet.duv, jet.dvv]) {
        *slot = vector.to_array();
    }
}

#[cold]
fn write_point(point: SurfacePoint, values: &mut [f64; 18]) {
    let nowhere = glam::DVec3::NAN;
    let [duu, duv, dvv] = point.second.map_or([nowhere; 3], |second| [second.uu, second.uv, second.vv]);
    write_jet(&Jet { position: point.position, du: point.du, dv: point.dv, duu, duv, dvv }, values);
}

//! The limit surface as bicubic B-spline patches, for CAD.
//!
//! The surface is cut along the rows of edges that leave its extraordinary vertices, and along creases, into rectangles of
//! faces whose sides meet end to end; long ones are cut again. Each rectangle becomes one B-spline patch: its poles are
//! values of the polar form (Ramshaw 1989) of the bicubic pieces of which the surface consists (Stam 1998), so it is
//! the surface itself. Extraordinary vertices lie at corners of rectangles only. Towards them the surface consists of
//! rings of ever smaller pieces; the patch has knots at the edges of the first few rings (at 1/2, 1/4, 1/8 of a face) and
//! is exact there too. Within the last ring the poles continue the rings round it, except those next to the vertex: that at
//! the corner is the limit of the vertex, those beside it along the sides lie in the tangent plane there, and the next ones on
//! and beside the sides are raised or lowered so that the normals of the patches nearly agree along the sides. So the three
//! innermost spans deviate a little. As many rings are taken as bring the deviation below the tolerance.
//!
//! Both patches at a side have the same knots along it and poles equal in every bit.
//!
//! Where a component of the mesh has other faces than quads, all its faces are cut into quadrants first.

mod blend;
mod cells;
mod corners;
mod frame;
mod knots;
mod lines;
mod measure;
mod pieces;
mod regions;
mod seam;
mod spline;

pub use spline::{SplinePatch, SplinePoint};

use super::{FreezeError, LimitSurface};
use crate::job::{Cancelled, Job};
use crate::mesh::{FaceId, Mesh};
use cells::{Component, Side};
use measure::{Ruler, Spans};
use pieces::Pieces;
use regions::Region;

/// How patches are made.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct PatchOptions {
    /// Faces along a side of a patch at most, 1 or more.
    pub most_faces: usize,
    /// Aim for the deviation beside extraordinary vertices, in parts of the mean length of the edges of the face there.
    pub tolerance: f64,
}

impl Default for PatchOptions {
    fn default() -> Self {
        Self { most_faces: 10, tolerance: 1e-4 }
    }
}

/// What was made.
#[derive(Clone, Copy, PartialEq, Default, Debug, serde::Serialize)]
pub struct PatchReport {
    /// Patches made.
    pub patches: usize,
    /// Patches that are the limit surface itself.
    pub exact: usize,
    /// Patches that deviate from it at a corner.
    pub approximate: usize,
    /// Faces of the control mesh.
    pub faces: usize,
    /// Rings of exact pieces round extraordinary vertices, the most of any component.
    pub rings: u32,
    /// Greatest deviation found, in units of the model.
    pub max_deviation: f64,
    /// The same in parts of the mean length of the edges of the face.
    pub max_relative_deviation: f64,
    /// Root mean square of all distances measured in the three spans beside extraordinary vertices, in parts of the same length.
    pub rms_relative_deviation: f64,
    /// Greatest angle in degrees between the normals of two patches along a shared side that is no crease.
    pub max_normal_jump: f64,
}

/// A surface as patches. See the [module](self).
#[derive(Clone, Debug)]
pub struct Patches {
    /// Component by component of the mesh.
    pub patches: Vec<SplinePatch>,
    /// What was made.
    pub report: PatchReport,
}

/// Rings at first and at most.
const RINGS: std::ops::RangeInclusive<u32> = 3..=16;
/// Aims for the angles between the normals of patches and surface, and of two patches at a side, in degrees, and the most rings
/// that are spent on them: a surface with a fold has no normal to come near to.
const ANGLE: f64 = 1.0;
const JUMP: f64 = 0.5;
const RINGS_FOR_NORMALS: u32 = 8;
/// What one more ring divides the deviation by at best: seen at valence 3.
const PER_RING: f64 = 6.0;

impl Patches {
    /// The limit surface of `faces` as patches; boundary loops and faces that do not exist or have no limit surface are
    /// passed over.
    ///
    /// # Errors
    /// [`FreezeError`].
    pub fn new(
        mesh: &Mesh,
        faces: &[FaceId],
        options: &PatchOptions,
        job: &Job,
    ) -> Result<Self, FreezeError> {
        const STAGE: &str = "patches";
        let surface = LimitSurface::around_with(mesh, faces, job)?;
        let components = cells::components(mesh, &surface);
        let mut pieces = Pieces::new(&surface);
        let mut made = Self { patches: Vec::new(), report: PatchReport::default() };
        made.report.faces = surface.faces().count();
        let (mut squares, mut samples) = (0.0, 0.0);
        for (number, component) in components.iter().enumerate() {
            let step = |within: f64| job.step(STAGE, (number as f64 + within) / components.len() as f64);
            let of_component = made.add(mesh, &surface, &mut pieces, component, options, step)?;
            (squares, samples) = (squares + of_component.0, samples + of_component.1);
        }
        made.report.rms_relative_deviation = if samples > 0.0 { (squares / samples).sqrt() } else { 0.0 };
        made.report.patches = made.patches.len();
        made.report.exact = made.patches.iter().filter(|patch| patch.is_exact()).count();
        made.report.approximate = made.report.patches - made.report.exact;
        job.step(STAGE, 1.0)?;
        Ok(made)
    }

    /// Makes the patches of a component. The sum of squares of relative distances, and how many were measured.
    fn add(
        &mut self,
        mesh: &Mesh,
        surface: &LimitSurface,
        pieces: &mut Pieces,
        component: &Component,
        options: &PatchOptions,
        step: impl Fn(f64) -> Result<(), Cancelled>,
    ) -> Result<(f64, f64), Cancelled> {
        let cells = &component.cells;
        let regions = regions::regions(cells, options.most_faces.max(1).saturating_mul(component.per_side));
        let neighbours = seam::neighbours(cells, &regions);
        let ruler = Ruler { mesh, surface, cells };
        let regular = regions.iter().all(|region| region.irregular == [false; 4]);
        let mut rings = if regular { 0 } else { *RINGS.start() };
        let normals: Vec<_> = regions.iter().map(|region| corners::normals(surface, cells, region)).collect();
        let smooth = |number: usize, side: usize| {
            let Side { cell, side } = regions[number].corner(side);
            !cells[cell].sharp[side]
        };
        let mut patches = loop {
            let inner = knots::inner_knots(cells, rings);
            let mut patches = Vec::with_capacity(regions.len());
            for (number, region) in regions.iter().enumerate() {
                step(number as f64 / regions.len() as f64)?;
                let mut patch = make(cells, region, &inner, pieces);
                corners::flatten(&mut patch, normals[number]);
                patches.push(patch);
            }
            seam::join(&mut patches, &neighbours);
            blend::blend(&mut patches, &normals, &neighbours, smooth);
            let (mut worst, mut angle): (f64, f64) = (0.0, 0.0);
            for (region, patch) in regions.iter().zip(&patches) {
                let found = ruler.distance(pieces, region, patch, Spans::Last);
                (worst, angle) = (worst.max(found.relative), angle.max(found.angle));
            }
            let jump = worst_jump(&patches, &neighbours, smooth);
            let near = worst <= options.tolerance || rings >= *RINGS.end();
            let upright = (angle <= ANGLE && jump <= JUMP) || rings >= RINGS_FOR_NORMALS;
            if near && upright {
                break patches;
            }
            let missing = (worst / options.tolerance).log(PER_RING).floor().clamp(1.0, 4.0);
            rings = (rings + missing as u32).min(*RINGS.end());
        };
        self.report.rings = self.report.rings.max(rings);
        let (mut squares, mut samples) = (0.0, 0.0);
        for (region, patch) in regions.iter().zip(&mut patches) {
            let found = ruler.distance(pieces, region, patch, Spans::All);
            (patch.deviation, patch.relative_deviation) = (found.absolute, found.relative);
            (squares, samples) = (squares + found.squares, samples + found.samples);
        }
        self.report_on(&patches, &neighbours, smooth);
        let first = self.patches.len();
        for (patch, beyond) in patches.iter_mut().zip(neighbours) {
            patch.neighbours = beyond.map(|beyond| beyond.map(|(number, side)| (first + number, side)));
        }
        self.patches.append(&mut patches);
        Ok((squares, samples))
    }

    fn report_on(
        &mut self,
        patches: &[SplinePatch],
        neighbours: &seam::Neighbours,
        smooth: impl Fn(usize, usize) -> bool,
    ) {
        let report = &mut self.report;
        for patch in patches {
            report.max_deviation = report.max_deviation.max(patch.deviation);
            report.max_relative_deviation = report.max_relative_deviation.max(patch.relative_deviation);
        }
        report.max_normal_jump = report.max_normal_jump.max(worst_jump(patches, neighbours, smooth));
    }
}

/// Greatest angle in degrees between the normals of two patches along the sides that are `smooth`.
fn worst_jump(
    patches: &[SplinePatch],
    neighbours: &seam::Neighbours,
    smooth: impl Fn(usize, usize) -> bool,
) -> f64 {
    let mut worst: f64 = 0.0;
    for (number, (patch, sides)) in patches.iter().zip(neighbours).enumerate() {
        for (side, beyond) in sides.iter().enumerate() {
            let Some((other, there)) = beyond.filter(|&beyond| beyond > (number, side)) else { continue };
            if smooth(number, side) {
                worst = worst.max(measure::normal_jump(patch, side, &patches[other], there));
            }
        }
    }
    worst
}

fn make(cells: &[cells::Cell], region: &Region, inner: &knots::Inner, pieces: &mut Pieces) -> SplinePatch {
    let knots = [0, 1].map(|axis| knots::region_knots(region, inner, axis));
    let flat = |knots: &[f64]| {
        let ends = |knot: Option<&f64>| std::iter::repeat_n(knot.copied().unwrap_or(0.0), 3);
        ends(knots.first()).chain(knots.iter().copied()).chain(ends(knots.last())).collect()
    };
    let mut faces: Vec<FaceId> = Vec::with_capacity(region.cells.len());
    for at in &region.cells {
        let face = cells[at.cell].face;
        if !faces.contains(&face) {
            faces.push(face);
        }
    }
    SplinePatch {
        knots_u: flat(&knots[0]),
        knots_v: flat(&knots[1]),
        poles: pieces.poles(cells, region, [&knots[0], &knots[1]]),
        faces,
        neighbours: [None; 4],
        irregular: region.irregular,
        deviation: 0.0,
        relative_deviation: 0.0,
    }
}

//! A quad of the refined mesh that has one extraordinary corner, of any valence, in the interior or on the boundary.
//!
//! Refining it gives three regular patches and a quad of the same kind at half the size (Stam 1998 counts the same
//! 2n + 8 points; here they are refined level by level, in time linear in the valence, so that sharpness rules have
//! their place). All points are kept relative to the limit position of the extraordinary vertex and moved back to
//! it after each step: so lengths keep their relative precision at any depth, and with them the derivatives.

use super::dart::DartMasks;
use super::mask::RingMask;
use super::patch_bicubic::{Bicubic, Grid, Jet};
use crate::mesh::{FaceId, VertexId};
use glam::DVec3;
use smallvec::SmallVec;
use std::f64::consts::PI;

/// Beyond this depth a parameter counts as the vertex itself. The largest subdominant eigenvalue of Catmull-Clark is
/// 0.655 (infinite valence), and 0.655^128 is far below the last bit of any coordinate.
const MAX_DEPTH: u32 = 128;

/// The points round one vertex: spokes to its neighbours, counter-clockwise, and the quads between them.
/// Quad `j` lies between spokes `j` and `j + 1`; a closed fan has as many quads as spokes, an open one (a vertex on
/// the boundary) one less.
pub(crate) type Points = SmallVec<[DVec3; 8]>;

/// What becomes of the vertex of a fan.
#[derive(Clone, Debug)]
pub(crate) enum Tip {
    /// It moves by the smooth rule, or along the ends of an open fan.
    Moving,
    /// It stays: a corner.
    Fixed,
    /// It moves by the smooth rule, but a crease ends there. The fan is closed.
    Dart(Box<Dart>),
}

/// A crease that ends at a vertex.
#[derive(Clone, Debug)]
pub(crate) struct Dart {
    /// The spoke that is the crease.
    spoke: usize,
    masks: DartMasks,
}

impl Tip {
    pub(crate) fn dart(faces: usize, spoke: usize) -> Self {
        Self::Dart(Box::new(Dart { spoke, masks: DartMasks::new(faces) }))
    }
}

/// Names the fan of a vertex inside the surface round which nothing is sharp.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct FanKey {
    pub(crate) centre: Centre,
    /// How often it was refined.
    pub(crate) level: u8,
}

/// Where the vertex of a fan comes from.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Centre {
    /// A vertex of the mesh.
    Vertex(VertexId),
    /// The face point of a face that is no quad.
    Face(FaceId),
}

/// See the [module](self). Spoke `home` runs along u, spoke `home + 1` along v.
#[derive(Clone, Debug)]
pub(crate) struct Corner {
    pub(crate) closed: bool,
    pub(crate) tip: Tip,
    pub(crate) home: usize,
    /// Limit position of the extraordinary vertex; everything below is relative to it.
    pub(crate) origin: DVec3,
    pub(crate) vertex: DVec3,
    pub(crate) spokes: Points,
    /// Per quad the vertex opposite to `vertex`.
    pub(crate) diagonals: Points,
    /// Corners with the same key have the same `closed`, `tip`, `origin`, `vertex`, `spokes` and `diagonals`.
    pub(crate) key: Option<FanKey>,
    /// The points of the 4 x 4 grid that the fan does not hold, at (u, v) =
    /// (2,-1) (2,0) (2,1) (2,2) (1,2) (0,2) (-1,2); the first and last are unused beside the boundary.
    pub(crate) outer: [DVec3; 7],
}

/// The three regular patches that one refinement step yields:
/// `[high u low v, high u high v, low u high v]`, relative to the corner's origin.
pub(crate) type Sides = [Grid; 3];

/// Limit position and tangents of a vertex relative to its corner's origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VertexLimit {
    pub(crate) position: DVec3,
    pub(crate) du: DVec3,
    pub(crate) dv: DVec3,
    /// Direction of the normal, not normalised; zero when the surface has none.
    pub(crate) normal: DVec3,
}

fn refine_curve(p: [DVec3; 4]) -> [DVec3; 5] {
    [
        (p[0] + p[1]) * 0.5,
        (p[0] + 6.0 * p[1] + p[2]) * 0.125,
        (p[1] + p[2]) * 0.5,
        (p[1] + 6.0 * p[2] + p[3]) * 0.125,
        (p[2] + p[3]) * 0.5,
    ]
}

impl Corner {
    /// Moves the points so that the limit position of the vertex is the origin.
    pub(crate) fn recentre(&mut self) {
        let shift = self.limit_position();
        self.origin += shift;
        self.vertex -= shift;
        let rest = self.spokes.iter_mut().chain(&mut self.diagonals).chain(&mut self.outer);
        rest.for_each(|p| *p -= shift);
    }

    /// Spoke `home + offset`, cyclic when the fan is closed; `None` beyond the boundary.
    fn spoke(&self, offset: isize) -> Option<DVec3> {
        pick(&self.spokes, self.home, offset, self.closed)
    }

    fn diagonal(&self, offset: isize) -> Option<DVec3> {
        pick(&self.diagonals, self.home, offset, self.closed)
    }

    /// The crease's spoke at a dart.
    fn dart_spoke(&self) -> Option<usize> {
        match &self.tip {
            Tip::Dart(dart) => Some(dart.spoke),
            _ => None,
        }
    }

    /// True when the edge along u bounds the surface: a boundary or a crease.
    fn boundary_u(&self) -> bool {
        !self.closed && self.home == 0 || self.dart_spoke() == Some(self.home)
    }

    /// True when the edge along v bounds the surface.
    fn boundary_v(&self) -> bool {
        let next = self.home + 1;
        if self.closed {
            self.dart_spoke() == Some(if next == self.spokes.len() { 0 } else { next })
        } else {
            next == self.diagonals.len()
        }
    }

    /// The 4 x 4 grid round the quad. The point diagonally behind the vertex has no meaning.
    /// Beside the boundary the outer row continues the two inside it in a straight line, which gives exactly the
    /// edge-only boundary.
    pub(crate) fn grid(&self) -> Grid {
        let [o0, o1, o2, o3, o4, o5, o6] = self.outer;
        let here = |p: Option<DVec3>| p.unwrap_or(self.vertex);
        let mut grid = [
            [here(self.diagonal(2)), here(self.spoke(-1)), here(self.diagonal(-1)), o0],
            [here(self.spoke(2)), self.vertex, here(self.spoke(0)), o1],
            [here(self.diagonal(1)), here(self.spoke(1)), here(self.diagonal(0)), o2],
            [o6, o5, o4, o3],
        ];
        extend(&mut grid, self.boundary_u(), self.boundary_v());
        grid
    }

    /// The grid of a quad whose vertex is regular and inside the surface, relative to nothing.
    pub(crate) fn regular_grid(&self) -> Option<Grid> {
        let regular = self.closed && self.spokes.len() == 4 && matches!(self.tip, Tip::Moving);
        regular.then(|| self.grid().map(|row| row.map(|p| p + self.origin)))
    }

    /// Replaces the quad by its quarter at the vertex and returns the other three quarters.
    /// `scratch` holds the face points and may be reused from call to call.
    pub(crate) fn refine(&mut self, scratch: &mut Points) -> Sides {
        let count = self.spokes.len();
        let faces = self.diagonals.len();
        let old = self.vertex;
        scratch.clear();
        scratch.extend((0..faces).map(|j| {
            let next = if j + 1 == count { 0 } else { j + 1 };
            (old + self.spokes[j] + self.diagonals[j] + self.spokes[next]) * 0.25
        }));
        let rows: [[DVec3; 5]; 4] = self.grid().map(refine_curve);
        let columns: [[DVec3; 5]; 5] =
            std::array::from_fn(|i| refine_curve(std::array::from_fn(|j| rows[j][i])));
        let mut fine: [[DVec3; 5]; 5] = std::array::from_fn(|j| std::array::from_fn(|i| columns[i][j]));

        if matches!(self.tip, Tip::Fixed) {
            // It stays.
        } else if self.closed {
            let n = count as f64;
            let sum: DVec3 = self.spokes.iter().zip(scratch.iter()).map(|(&s, &f)| s + f).sum();
            self.vertex = old * ((n - 2.0) / n) + sum / (n * n);
        } else {
            self.vertex = (self.spokes[0] + 6.0 * old + self.spokes[count - 1]) * 0.125;
        }
        let crease = self.dart_spoke();
        for j in 0..count {
            let before = if j > 0 { Some(j - 1) } else { self.closed.then(|| faces - 1) };
            let spoke = &mut self.spokes[j];
            *spoke = match (before, j < faces) {
                (Some(before), true) if crease != Some(j) => {
                    (old + *spoke + scratch[before] + scratch[j]) * 0.25
                }
                _ => (old + *spoke) * 0.5,
            };
        }
        self.diagonals.copy_from_slice(scratch);

        // What the tensor product cannot know: the points at the extraordinary vertex itself.
        fine[1][1] = self.vertex;
        fine[1][0] = self.spoke(2).unwrap_or(self.vertex);
        fine[0][1] = self.spoke(-1).unwrap_or(self.vertex);
        extend(&mut fine, self.boundary_u(), self.boundary_v());
        self.outer = [fine[0][3], fine[1][3], fine[2][3], fine[3][3], fine[3][2], fine[3][1], fine[3][0]];
        let window = |i0: usize, j0: usize| -> Grid {
            std::array::from_fn(|j| std::array::from_fn(|i| fine[j + j0][i + i0]))
        };
        let sides = [window(1, 0), window(1, 1), window(0, 1)];
        self.recentre_with(sides)
    }

    /// Moves the origin to the limit position again and takes the regular patches along.
    fn recentre_with(&mut self, sides: Sides) -> Sides {
        let before = self.origin;
        self.recentre();
        let shift = self.origin - before;
        sides.map(|grid| grid.map(|row| row.map(|p| p - shift)))
    }

    /// Limit position of the vertex (Halstead et al. 1993; the boundary is a cubic B-spline curve).
    fn limit_position(&self) -> DVec3 {
        match &self.tip {
            Tip::Moving => {}
            Tip::Fixed => return self.vertex,
            Tip::Dart(dart) => return self.apply(&dart.masks.position, dart.spoke),
        }
        let spokes: DVec3 = self.spokes.iter().sum();
        if self.closed {
            let n = self.spokes.len() as f64;
            let diagonals: DVec3 = self.diagonals.iter().sum();
            (n * n * self.vertex + 4.0 * spokes + diagonals) / (n * (n + 5.0))
        } else {
            let last = self.spokes.len() - 1;
            (self.spokes[0] + 4.0 * self.vertex + self.spokes[last]) / 6.0
        }
    }

    /// A mask of a dart whose crease is spoke `crease`.
    fn apply(&self, mask: &RingMask, crease: usize) -> DVec3 {
        let count = self.spokes.len();
        let at = |i: usize| (crease + i) % count;
        let spokes = mask.edges.iter().enumerate().map(|(i, &w)| w * self.spokes[at(i)]);
        let diagonals = mask.faces.iter().enumerate().map(|(i, &w)| w * self.diagonals[at(i)]);
        mask.vertex * self.vertex + spokes.sum::<DVec3>() + diagonals.sum::<DVec3>()
    }

    /// Limit position and tangents of the vertex. The tangents have the directions of the two edges; their lengths
    /// are the derivatives where the vertex is regular and a convention elsewhere. At a corner of several quads they
    /// are the edges of the present level and the normal, which depends on the way to the corner, is left out.
    pub(crate) fn vertex_limit(&self) -> VertexLimit {
        let position = self.limit_position();
        let count = self.spokes.len();
        match &self.tip {
            Tip::Moving => {}
            Tip::Fixed => {
                let next = if self.home + 1 == count { 0 } else { self.home + 1 };
                let [du, dv] = [self.home, next].map(|j| self.spokes[j] - self.vertex);
                return VertexLimit { position, du, dv, normal: DVec3::ZERO };
            }
            Tip::Dart(dart) => {
                let [along, across] =
                    [&dart.masks.along, &dart.masks.across].map(|mask| self.apply(mask, dart.spoke));
                let direction = |offset: usize| {
                    let place = (self.home + offset + count - dart.spoke) % count;
                    let (sin, cos) = (2.0 * PI * place as f64 / count as f64).sin_cos();
                    along * cos + across * sin
                };
                let (du, dv) = (direction(0), direction(1));
                return VertexLimit { position, du, dv, normal: along.cross(across) };
            }
        }
        if self.closed {
            let (du, dv) = self.interior_tangents();
            return VertexLimit { position, du, dv, normal: du.cross(dv) };
        }
        let (first, last) = (self.spokes[0], self.spokes[self.spokes.len() - 1]);
        let along = (first - last) * 0.5;
        let faces = self.diagonals.len();
        if faces == 1 {
            // Round a single quad the surface is thin beside the boundary: the cross direction shrinks by 1/4 per
            // level, the boundary by 1/2, so both derivatives lie along the boundary.
            let inward = first + last - 2.0 * self.vertex;
            return VertexLimit { position, du: along, dv: -along, normal: along.cross(inward) };
        }
        let across = self.boundary_cross_tangent();
        let theta = PI / faces as f64;
        let direction = |j: usize| {
            let (sin, cos) = (theta * j as f64).sin_cos();
            along * cos + across * sin
        };
        let (du, dv) = (direction(self.home), direction(self.home + 1));
        VertexLimit { position, du, dv, normal: along.cross(across) }
    }

    /// Tangents along spokes `home` and `home + 1`: left eigenvectors of the subdominant eigenvalue.
    fn interior_tangents(&self) -> (DVec3, DVec3) {
        let n = self.spokes.len();
        let theta = 2.0 * PI / n as f64;
        let a = 1.0 + theta.cos() + (0.5 * theta).cos() * (2.0 * (9.0 + theta.cos())).sqrt();
        let (mut du, mut dv) = (DVec3::ZERO, DVec3::ZERO);
        for j in 0..n {
            let cos = |k: isize| (theta * k as f64).cos();
            let offset = j as isize - self.home as isize;
            let (c0, c1, c2) = (cos(offset - 1), cos(offset), cos(offset + 1));
            du += a * c1 * self.spokes[j] + (c1 + c2) * self.diagonals[j];
            dv += a * c0 * self.spokes[j] + (c0 + c1) * self.diagonals[j];
        }
        let scale = 1.0 / (3.0 * n as f64);
        (du * scale, dv * scale)
    }

    /// Tangent into the surface at a boundary vertex of at least two quads (Biermann, Levin, Zorin 2000).
    fn boundary_cross_tangent(&self) -> DVec3 {
        let faces = self.diagonals.len();
        let theta = PI / faces as f64;
        let (sin, cos) = theta.sin_cos();
        let ratio = (1.0 + cos) / sin;
        let mut sum = self.vertex * (4.0 * ratio * (cos - 1.0));
        sum -= (self.spokes[0] + self.spokes[faces]) * (ratio * (1.0 + 2.0 * cos));
        for j in 1..faces {
            sum += self.spokes[j] * (4.0 * (theta * j as f64).sin());
        }
        for j in 0..faces {
            let weight = (theta * j as f64).sin() + (theta * (j + 1) as f64).sin();
            sum += self.diagonals[j] * weight;
        }
        sum / (faces as f64 * (3.0 + cos))
    }

    /// Evaluates at (u, v) in [0, 1]^2 measured from the vertex. The second value is false where the result is the
    /// limit of the vertex itself, which has no second derivatives.
    pub(crate) fn evaluate(&mut self, u: f64, v: f64, scratch: &mut Points) -> (Jet, DVec3, bool) {
        let (mut u, mut v, mut scale) = (u, v, 1.0);
        if u.max(v) > 0.0 {
            for _ in 0..MAX_DEPTH {
                let sides = self.refine(scratch);
                scale *= 2.0;
                (u, v) = (2.0 * u, 2.0 * v);
                let (side, a, b) = match (u >= 1.0, v >= 1.0) {
                    (false, false) => continue,
                    (true, false) => (0, u - 1.0, v),
                    (true, true) => (1, u - 1.0, v - 1.0),
                    (false, true) => (2, u, v - 1.0),
                };
                let mut jet = Bicubic::from_bspline(&sides[side]).jet(a, b).scaled(scale);
                jet.position += self.origin;
                return (jet, jet.du.cross(jet.dv), true);
            }
        }
        let limit = self.vertex_limit();
        let position = self.origin + limit.position;
        (Jet { position, du: limit.du, dv: limit.dv, ..Jet::default() }, limit.normal, false)
    }
}

impl Jet {
    /// The jet over a parameter that runs `scale` times slower.
    pub(crate) fn scaled(self, scale: f64) -> Self {
        let square = scale * scale;
        Self {
            position: self.position,
            du: self.du * scale,
            dv: self.dv * scale,
            duu: self.duu * square,
            duv: self.duv * square,
            dvv: self.dvv * square,
        }
    }
}

fn pick(points: &[DVec3], home: usize, offset: isize, closed: bool) -> Option<DVec3> {
    let index = home as isize + offset;
    let index = if closed { index.rem_euclid(points.len() as isize) } else { index };
    points.get(usize::try_from(index).ok()?).copied()
}

/// Continues the grid in a straight line beyond boundary edges along u (row 0) and along v (column 0).
fn extend<const N: usize>(grid: &mut [[DVec3; N]; N], boundary_u: bool, boundary_v: bool) {
    if boundary_u {
        grid[0] = std::array::from_fn(|i| 2.0 * grid[1][i] - grid[2][i]);
    }
    if boundary_v {
        for row in grid.iter_mut() {
            row[0] = 2.0 * row[1] - row[2];
        }
    }
}

impl Corner {
    /// Control points of the quad and its neighbours, relative to the origin; their hull holds the surface.
    pub(crate) fn control_points(&self) -> impl Iterator<Item = DVec3> {
        let rest = self.spokes.iter().chain(&self.diagonals).chain(&self.outer);
        std::iter::once(self.vertex).chain(rest.copied())
    }

    /// A box round the surface of the quad.
    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        let (low, high) = self
            .control_points()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        (low + self.origin, high + self.origin)
    }
}

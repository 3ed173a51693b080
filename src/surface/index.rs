//! What queries search: pieces with their boxes, in a tree. Made at the first query, for evaluation does without.

use super::disc::Disc;
use super::places::Entry;
use super::tree::Tree;
use super::valence::MOST;
use super::{Bicubic, LimitSurface};
use crate::memory::{self, OutOfMemory};
use crate::subdivision::patch_corner::{Corner, Points};
use glam::DVec3;
use smallvec::SmallVec;

/// Levels of pieces that are held beside an extraordinary vertex; deeper ones are made when a query gets there.
const LEVELS: u32 = 4;
/// The same at a vertex with many edges: there levels shrink less and are dear to make.
const LEVELS_OF_MANY: u32 = 8;
fn levels(edges: usize) -> u32 {
    if edges > MOST { LEVELS_OF_MANY } else { LEVELS }
}

/// Where a piece lies: a square of a patch, turned by quarter turns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Domain {
    pub(super) patch: u32,
    /// Patch parameters of the square's own origin.
    u: f64,
    v: f64,
    /// Quarter turns from the patch's axes to the square's, counter-clockwise.
    turns: u8,
    size: f64,
}

impl Domain {
    fn whole(patch: u32) -> Self {
        Self { patch, u: 0.0, v: 0.0, turns: 0, size: 1.0 }
    }

    /// Patch parameters of the point (s, t) in [0, 1]^2 of the piece.
    pub(super) fn parameters(&self, s: f64, t: f64) -> (f64, f64) {
        let (s, t) = (s * self.size, t * self.size);
        match self.turns {
            0 => (self.u + s, self.v + t),
            1 => (self.u - t, self.v + s),
            2 => (self.u - s, self.v - t),
            _ => (self.u + t, self.v - s),
        }
    }

    /// The same square with its corner `corner` as the origin.
    fn turned(&self, corner: u8) -> Self {
        let (s, t) = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)][usize::from(corner % 4)];
        let (u, v) = self.parameters(s, t);
        Self { u, v, turns: (self.turns + corner) % 4, ..*self }
    }

    /// Domain of side `side` of the extraordinary quad over this square, after one refinement.
    pub(super) fn side(&self, side: usize) -> Self {
        let (s, t) = [(0.5, 0.0), (0.5, 0.5), (0.0, 0.5)][side];
        let (u, v) = self.parameters(s, t);
        Self { u, v, size: 0.5 * self.size, ..*self }
    }

    /// Domain of what remains of the extraordinary quad after one refinement.
    pub(super) fn inner(&self) -> Self {
        Self { size: 0.5 * self.size, ..*self }
    }
}

/// What remains of an extraordinary quad below the pieces.
#[derive(Clone, Debug)]
pub(super) struct Rest {
    corner: u32,
    /// Refinements that lead to it.
    levels: u32,
    /// Of what remains.
    pub(super) domain: Domain,
    /// Unit normal at the vertex, zero where there is none.
    pub(super) normal: DVec3,
}

/// See the [module](self).
#[derive(Clone, Default, Debug)]
pub(super) struct Index {
    pub(super) tree: Tree,
    /// Per node of the tree.
    discs: Vec<Disc>,
    /// Per item of the tree below the rests, which are the bicubics of the surface and then `pieces`.
    domains: Vec<Domain>,
    /// Pieces beside extraordinary vertices.
    pieces: Vec<Bicubic>,
    rests: Vec<Rest>,
}

/// An item of the tree.
pub(super) enum Item<'a> {
    Piece(&'a Bicubic, &'a Domain),
    Rest(&'a Rest),
}

impl Rest {
    /// The quad that remains.
    pub(super) fn corner(&self, surface: &LimitSurface) -> Corner {
        let mut corner = surface.corners.corner(self.corner);
        let mut scratch = Points::new();
        for _ in 0..self.levels {
            corner.refine(&mut scratch);
        }
        corner
    }
}

/// Points whose convex hull holds the quad. Its control points reach round the whole vertex; where many quads do that,
/// those of its pieces are taken for as many levels as are held, or every query there would look at all of them.
fn hull(corner: &mut Corner, scratch: &mut Points) -> SmallVec<[DVec3; 16]> {
    let mut points = SmallVec::new();
    if corner.spokes.len() > MOST {
        for _ in 0..LEVELS_OF_MANY {
            for grid in corner.refine(scratch) {
                let piece = Bicubic::from_bspline(&grid);
                points.extend(piece.points.as_flattened().iter().map(|&p| p + corner.origin));
            }
        }
    }
    points.extend(corner.control_points().map(|p| p + corner.origin));
    points
}

impl Index {
    pub(super) fn new(surface: &LimitSurface) -> Result<Self, OutOfMemory> {
        let (held, rests) = (surface.bicubics.len(), surface.corners.entries.len());
        let pieces: usize = (0..rests as u32).map(|k| 3 * levels(surface.corners.edges(k)) as usize).sum();
        let mut index = Self {
            domains: memory::room(held + pieces)?,
            pieces: memory::room(pieces)?,
            rests: memory::room(rests)?,
            ..Self::default()
        };
        index.domains.resize(held, Domain::whole(0));
        let mut boxes = memory::room(held + pieces + rests)?;
        boxes.extend(surface.bicubics.iter().map(Bicubic::bounds));
        let mut rest_boxes: Vec<(DVec3, DVec3)> = memory::room(rests)?;
        let mut rest_discs: Vec<Disc> = memory::room(rests)?;
        let mut scratch = Points::new();
        let mut open: Vec<(Entry, Domain)> = Vec::new();
        for (&entry, patch) in surface.patches.iter().zip(0..) {
            open.push((entry, Domain::whole(patch)));
            while let Some((entry, domain)) = open.pop() {
                match entry {
                    Entry::Regular(bicubic) => index.domains[bicubic as usize] = domain,
                    Entry::Split(first) => {
                        let quarters = &surface.parts[first as usize..][..4];
                        let places = [0, 1, 2, 3].map(|corner| domain.turned(corner).inner());
                        open.extend(quarters.iter().copied().zip(places));
                    }
                    Entry::Corner { corner: number, turns } => {
                        let mut domain = domain.turned(turns);
                        let mut corner = surface.corners.corner(number);
                        let normal = surface.corners.normal(number);
                        let levels = levels(corner.spokes.len());
                        for _ in 0..levels {
                            for (side, grid) in corner.refine(&mut scratch).iter().enumerate() {
                                let grid = grid.map(|row| row.map(|p| p + corner.origin));
                                let piece = Bicubic::from_bspline(&grid);
                                boxes.push(piece.bounds());
                                index.pieces.push(piece);
                                index.domains.push(domain.side(side));
                            }
                            domain = domain.inner();
                        }
                        let points = hull(&mut corner, &mut scratch);
                        let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                        let wider = |(low, high): (DVec3, DVec3), &p: &DVec3| (low.min(p), high.max(p));
                        rest_boxes.push(points.iter().fold(empty, wider));
                        rest_discs.push(Disc::around(points.iter().copied(), normal));
                        index.rests.push(Rest { corner: number, levels, domain, normal });
                    }
                }
            }
        }
        boxes.append(&mut rest_boxes);
        index.tree = Tree::new(&boxes)?;
        let disc = |item: u32| match index.item(surface, item) {
            Item::Piece(bicubic, _) => {
                let p = &bicubic.points;
                let normal = (p[3][3] - p[0][0]).cross(p[3][0] - p[0][3]);
                Disc::around(p.as_flattened().iter().copied(), normal)
            }
            Item::Rest(_) => rest_discs[item as usize - index.domains.len()],
        };
        index.discs = index.tree.gather(disc, |a, b| a.join(&b))?;
        Ok(index)
    }

    /// No point of what the node holds is closer to `point`.
    pub(super) fn at_least(&self, node: u32, point: DVec3, tolerance: f64) -> f64 {
        // What is lost to rounding, in proportion to the sizes and to the distance.
        (1.0 - 1e-14) * self.discs[node as usize].distance(point) - tolerance
    }

    pub(super) fn item<'a>(&'a self, surface: &'a LimitSurface, item: u32) -> Item<'a> {
        let item = item as usize;
        match self.domains.get(item) {
            None => Item::Rest(&self.rests[item - self.domains.len()]),
            Some(domain) => {
                let held = surface.bicubics.len();
                let bicubic = if item < held { &surface.bicubics[item] } else { &self.pieces[item - held] };
                Item::Piece(bicubic, domain)
            }
        }
    }
}

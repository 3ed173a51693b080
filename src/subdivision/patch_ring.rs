//! The neighbourhood of one face, and its refinement: what the limit surface of a face depends on.
//!
//! A ring is the face and, round each of its corners, the fan of faces there. One refinement step gives the rings of
//! the child faces. The masks of Catmull-Clark stand here once, in [`Fan::vertex_point`] and [`Fan::edge_point`].
//! Where nothing is semi-sharp any longer, infinitely sharp edges bound the surface of a face like the boundary: then
//! fans are cut down to the sector between them that holds the face.

use super::patch_bicubic::Grid;
use super::patch_corner::{Centre, Corner, FanKey, Points, Tip};
use super::patch_direct::place_round;
use super::sharpness::{Around, Values};
use crate::mesh::{Creasing, FaceId, HalfEdgeId, Mesh, VertexId};
use glam::DVec3;
use smallvec::{SmallVec, smallvec};
use std::borrow::Cow;

/// A face of a fan, seen from the fan's vertex.
#[derive(Clone, Copy, Debug)]
struct FanFace {
    /// Average of the vertices: the face point.
    point: DVec3,
    /// For quads the opposite vertex.
    diagonal: DVec3,
    quad: bool,
}

/// The faces and edges round one corner of the ring's face, counter-clockwise. Face `j` lies between spokes `j` and
/// `j + 1`; face `home` is the ring's own. A closed fan has as many faces as spokes, an open one has one less.
#[derive(Clone, Debug)]
struct Fan {
    vertex: DVec3,
    spokes: Points,
    faces: SmallVec<[FanFace; 6]>,
    home: usize,
    closed: bool,
    /// What is sharp; `None` where nothing is but the boundary.
    around: Option<Box<Around>>,
    /// What becomes of the vertex where nothing is semi-sharp.
    tip: Tip,
    /// The same for all faces of a closed fan.
    key: Option<FanKey>,
}

/// See the [module](self).
#[derive(Clone, Debug)]
pub(crate) struct Ring {
    fans: SmallVec<[Fan; 4]>,
    /// The ring's own face, on the first level.
    face: Option<FaceId>,
    /// Face point of the ring's own face.
    centre: DVec3,
    creasing: Creasing,
}

/// The points that refinement makes of the vertices and edges of the ring's own face.
pub(crate) struct RefinedFace {
    vertices: Points,
    /// Edge `i` runs from corner `i` to corner `i + 1`.
    edges: Points,
}

fn face_point(mesh: &Mesh, face: FaceId, position: &impl Fn(VertexId) -> DVec3) -> (DVec3, usize) {
    let (mut sum, mut count) = (DVec3::ZERO, 0);
    for v in mesh.face_vertices(face) {
        sum += position(v);
        count += 1;
    }
    (sum / count as f64, count)
}

impl Fan {
    /// The fan at the source of `corner`, a half-edge of the ring's face.
    fn new(mesh: &Mesh, corner: HalfEdgeId, position: &impl Fn(VertexId) -> DVec3) -> Self {
        let vertex = mesh.source(corner);
        let mut first = corner;
        let mut home = 0;
        let mut closed = false;
        while !mesh.face(first.mate()).is_boundary() {
            first = mesh.vertex_cw(first);
            home += 1;
            if first == corner {
                closed = true;
                break;
            }
        }
        if closed {
            // All faces round the vertex begin at the same edge, so that they agree to the last bit.
            first = mesh.vertex_half_edge(vertex).unwrap_or(corner);
            home = place_round(mesh, corner);
        }
        let mut fan = Self {
            vertex: position(vertex),
            spokes: Points::new(),
            faces: SmallVec::new(),
            home,
            closed,
            around: None,
            tip: Tip::Moving,
            key: closed.then_some(FanKey { centre: Centre::Vertex(vertex), level: 0 }),
        };
        let mut spoke = first;
        let mut edges: SmallVec<[HalfEdgeId; 8]> = SmallVec::new();
        loop {
            edges.push(spoke);
            fan.spokes.push(position(mesh.target(spoke)));
            let face = mesh.face(spoke);
            if face.is_boundary() {
                break;
            }
            let (point, arity) = face_point(mesh, face, position);
            let diagonal = position(mesh.target(mesh.next(spoke)));
            fan.faces.push(FanFace { point, diagonal, quad: arity == 4 });
            spoke = mesh.vertex_ccw(spoke);
            if spoke == first {
                break;
            }
        }
        fan.around = Around::of(mesh, vertex, &edges).map(Box::new);
        fan
    }

    /// A fan of quads; `diagonals` per face.
    fn of_quads(vertex: DVec3, spokes: Points, diagonals: &[DVec3], home: usize, closed: bool) -> Self {
        let count = spokes.len();
        let faces = diagonals.iter().enumerate().map(|(j, &diagonal)| {
            let next = if j + 1 == count { 0 } else { j + 1 };
            FanFace { point: (vertex + spokes[j] + diagonal + spokes[next]) * 0.25, diagonal, quad: true }
        });
        let faces = faces.collect();
        Self { vertex, spokes, faces, home, closed, around: None, tip: Tip::Moving, key: None }
    }

    fn at(&self, offset: isize, count: usize) -> Option<usize> {
        let index = self.home as isize + offset;
        let index = if self.closed { index.rem_euclid(count as isize) } else { index };
        usize::try_from(index).ok().filter(|&i| i < count)
    }

    /// Index of spoke `home + offset`; `None` beyond the boundary.
    fn spoke_at(&self, offset: isize) -> Option<usize> {
        self.at(offset, self.spokes.len())
    }

    fn spoke(&self, offset: isize) -> Option<DVec3> {
        self.spoke_at(offset).map(|j| self.spokes[j])
    }

    fn face(&self, offset: isize) -> Option<FanFace> {
        self.at(offset, self.faces.len()).map(|j| self.faces[j])
    }

    fn diagonal(&self, offset: isize) -> Option<DVec3> {
        self.face(offset).map(|face| face.diagonal)
    }

    /// True for the sectors of which regular patches consist.
    fn is_regular(&self) -> bool {
        let faces = self.faces.len();
        let usual = match self.tip {
            Tip::Moving => faces == if self.closed { 4 } else { 2 },
            Tip::Fixed => !self.closed && faces == 1,
            Tip::Dart(_) => false,
        };
        usual && self.faces.iter().all(|face| face.quad)
    }

    fn vertex_point(&self, creasing: Creasing) -> DVec3 {
        let smooth = || {
            let n = self.spokes.len() as f64;
            let sum: DVec3 = self.spokes.iter().zip(&self.faces).map(|(&s, f)| s + f.point).sum();
            self.vertex * ((n - 2.0) / n) + sum / (n * n)
        };
        let crease = |a: usize, b: usize| (self.spokes[a] + 6.0 * self.vertex + self.spokes[b]) * 0.125;
        match &self.around {
            Some(around) => {
                let blend = around.blend(creasing);
                let mut point = blend.corner * self.vertex;
                if blend.crease > 0.0 {
                    let [a, b] = blend.crease_edges;
                    point += blend.crease * crease(a, b);
                }
                if self.closed && blend.smooth() > 0.0 {
                    point += blend.smooth() * smooth();
                }
                point
            }
            None if self.closed => smooth(),
            None => crease(0, self.spokes.len() - 1),
        }
    }

    /// Edge point of spoke `j`.
    fn edge_point(&self, creasing: Creasing, j: usize) -> DVec3 {
        let middle = (self.vertex + self.spokes[j]) * 0.5;
        let before = if j > 0 { Some(j - 1) } else { self.closed.then(|| self.faces.len() - 1) };
        let Some((a, b)) = before.and_then(|b| self.faces.get(b)).zip(self.faces.get(j)) else {
            return middle;
        };
        let smooth = (self.vertex + self.spokes[j] + a.point + b.point) * 0.25;
        match &self.around {
            Some(around) => {
                let share = around.crease_share(creasing, j);
                share * middle + (1.0 - share) * smooth
            }
            None => smooth,
        }
    }

    /// Edge point of spoke `home + offset`, which the caller knows to exist.
    fn edge_point_at(&self, creasing: Creasing, offset: isize) -> DVec3 {
        self.spoke_at(offset).map_or(self.vertex, |j| self.edge_point(creasing, j))
    }

    /// Sharpness of the half at this vertex of spoke `home + offset`, and of the semi-sharp ones of the others.
    fn half_at(&self, creasing: Creasing, offset: isize) -> (f32, Values) {
        match (&self.around, self.spoke_at(offset)) {
            (Some(around), Some(j)) => around.half_and_others(creasing, j),
            _ => (0.0, Values::new()),
        }
    }

    /// The fan of the same vertex after one step.
    fn refined(&self, creasing: Creasing) -> Self {
        let spokes = (0..self.spokes.len()).map(|j| self.edge_point(creasing, j)).collect();
        let diagonals: Points = self.faces.iter().map(|face| face.point).collect();
        let mut fan = Self::of_quads(self.vertex_point(creasing), spokes, &diagonals, self.home, self.closed);
        fan.around = self.around.as_ref().map(|around| Box::new(around.refined(creasing)));
        fan.key = self.key.map(|key| FanKey { level: key.level + 1, ..key });
        fan
    }

    /// Makes this fan, that of an edge point, know the two halves of its edge at spokes `places`: the sharpness of
    /// each, and of the semi-sharp edges at its far end.
    fn set_edge(&mut self, creasing: Creasing, places: [usize; 2], halves: [(f32, Values); 2]) {
        // Open fans are sharp at the boundary only.
        if self.closed {
            self.around = Around::of_edge(creasing, self.spokes.len(), places, halves).map(Box::new);
        }
    }

    fn is_semi_sharp(&self) -> bool {
        self.around.as_ref().is_some_and(|around| around.is_semi_sharp())
    }

    /// The part of the fan, in which nothing is semi-sharp, between the infinitely sharp edges on both sides of the
    /// home face.
    fn sector(&self) -> Self {
        let mut sector = self.clone();
        let Some(around) = sector.around.take() else { return sector };
        let fixed = around.is_fixed();
        if fixed {
            sector.tip = Tip::Fixed;
        }
        let count = self.spokes.len();
        let Some((first, faces)) = around.sector(self.home) else {
            if let ([crease], false) = (&around.infinite_spokes()[..], fixed) {
                sector.tip = Tip::dart(self.faces.len(), *crease);
            }
            return sector;
        };
        let at = |i: usize| (first + i) % count;
        sector.home = (self.home + count - first) % count;
        sector.spokes = (0..=faces).map(|i| self.spokes[at(i)]).collect();
        sector.faces = (0..faces).map(|i| self.faces[at(i)]).collect();
        sector.closed = false;
        sector
    }
}

impl Ring {
    /// The ring of a real face; `None` when the face has fewer than three edges.
    pub(crate) fn new(mesh: &Mesh, face: FaceId) -> Option<Self> {
        Self::with_positions(mesh, face, &|v| mesh.position(v))
    }

    /// The same with other positions than those of the mesh.
    pub(crate) fn with_positions(
        mesh: &Mesh,
        face: FaceId,
        position: &impl Fn(VertexId) -> DVec3,
    ) -> Option<Self> {
        if face.is_boundary() || !mesh.has_face(face) {
            return None;
        }
        let fans: SmallVec<[Fan; 4]> =
            mesh.face_half_edges(face).map(|h| Fan::new(mesh, h, position)).collect();
        (fans.len() >= 3).then(|| Self {
            fans,
            face: Some(face),
            centre: face_point(mesh, face, position).0,
            creasing: mesh.subdivision().creasing,
        })
    }

    /// Number of corners.
    pub(crate) fn arity(&self) -> usize {
        self.fans.len()
    }

    /// True while sharpness falls from level to level somewhere round the face.
    pub(crate) fn is_semi_sharp(&self) -> bool {
        self.fans.iter().any(Fan::is_semi_sharp)
    }

    /// The ring cut down to what the surface of the face depends on. Nothing may be semi-sharp.
    pub(crate) fn sectors(&self) -> Cow<'_, Self> {
        if self.fans.iter().all(|fan| fan.around.is_none()) {
            return Cow::Borrowed(self);
        }
        let fans = self.fans.iter().map(Fan::sector).collect();
        Cow::Owned(Self { fans, ..*self })
    }

    /// The control grid of a face whose limit is a single bicubic patch: a quad with only regular corners and
    /// quads around. `None` when the face needs local refinement. The ring must be one of sectors.
    pub(crate) fn regular_grid(&self) -> Option<Grid> {
        if self.arity() != 4 || !self.fans.iter().all(Fan::is_regular) {
            return None;
        }
        let mut grid = [[DVec3::ZERO; 4]; 4];
        // Each corner with its directions towards the next and the previous one, as (column, row).
        const CORNERS: [[(usize, usize); 3]; 4] = [
            [(1, 1), (2, 1), (1, 2)],
            [(2, 1), (2, 2), (1, 1)],
            [(2, 2), (1, 2), (2, 1)],
            [(1, 2), (1, 1), (2, 2)],
        ];
        for (fan, [v, next, prev]) in self.fans.iter().zip(CORNERS) {
            let behind = |a: usize, b: usize| 2 * a - b;
            grid[v.1][v.0] = fan.vertex;
            let (bu, bv) =
                ((behind(v.0, next.0), behind(v.1, next.1)), (behind(v.0, prev.0), behind(v.1, prev.1)));
            let sum = |a: (usize, usize), b: (usize, usize)| (a.0 + b.0 - v.0, a.1 + b.1 - v.1);
            let entries = [
                (bu, fan.spoke(2)),
                (bv, fan.spoke(-1)),
                (sum(prev, bu), fan.diagonal(1)),
                (sum(bu, bv), fan.diagonal(2)),
                (sum(next, bv), fan.diagonal(-1)),
            ];
            for ((i, j), point) in entries {
                if let Some(point) = point {
                    grid[j][i] = point;
                }
            }
        }
        // A boundary row continues the two inside it in a straight line: exactly the edge-only boundary.
        let boundary = |i: usize| !self.fans[i].closed && self.fans[i].home == 0;
        if boundary(0) {
            grid[0] = std::array::from_fn(|i| 2.0 * grid[1][i] - grid[2][i]);
        }
        if boundary(2) {
            grid[3] = std::array::from_fn(|i| 2.0 * grid[2][i] - grid[1][i]);
        }
        for row in &mut grid {
            if boundary(1) {
                row[3] = 2.0 * row[2] - row[1];
            }
            if boundary(3) {
                row[0] = 2.0 * row[1] - row[2];
            }
        }
        Some(grid)
    }

    /// Refines the vertices and edges of the face.
    pub(crate) fn refine(&self) -> RefinedFace {
        RefinedFace {
            vertices: self.fans.iter().map(|fan| fan.vertex_point(self.creasing)).collect(),
            edges: self.fans.iter().map(|fan| fan.edge_point_at(self.creasing, 0)).collect(),
        }
    }

    /// The ring of the child quad at `corner`: its corners are the vertex point, the edge point towards the next
    /// corner, the face point and the edge point towards the previous corner.
    pub(crate) fn child(&self, refined: &RefinedFace, corner: usize) -> Self {
        let k = self.arity();
        let wrap = |i: usize| if i >= k { i - k } else { i };
        let (next, prev) = (wrap(corner + 1), wrap(corner + k - 1));
        let (before, after) = (wrap(prev + k - 1), next);
        let vertex = |i: usize| refined.vertices[i];
        let edge = |i: usize| refined.edges[i];
        let (fan, fan_next, fan_prev) = (&self.fans[corner], &self.fans[next], &self.fans[prev]);

        let creasing = self.creasing;
        let mut at_next_edge = match fan.face(-1) {
            Some(mate) => Fan::of_quads(
                edge(corner),
                smallvec![self.centre, vertex(corner), mate.point, vertex(next)],
                &[
                    edge(prev),
                    fan.edge_point_at(creasing, -1),
                    fan_next.edge_point_at(creasing, 2),
                    edge(after),
                ],
                0,
                true,
            ),
            None => Fan::of_quads(
                edge(corner),
                smallvec![vertex(next), self.centre, vertex(corner)],
                &[edge(after), edge(prev)],
                1,
                false,
            ),
        };
        let mut at_prev_edge = match fan.face(1) {
            Some(mate) => Fan::of_quads(
                edge(prev),
                smallvec![vertex(corner), self.centre, vertex(prev), mate.point],
                &[
                    edge(corner),
                    edge(before),
                    fan_prev.edge_point_at(creasing, -1),
                    fan.edge_point_at(creasing, 2),
                ],
                0,
                true,
            ),
            None => Fan::of_quads(
                edge(prev),
                smallvec![vertex(corner), self.centre, vertex(prev)],
                &[edge(corner), edge(before)],
                0,
                false,
            ),
        };
        if fan.around.is_some() || fan_next.around.is_some() || fan_prev.around.is_some() {
            let next_halves = [fan.half_at(creasing, 0), fan_next.half_at(creasing, 1)];
            at_next_edge.set_edge(creasing, [1, 3], next_halves);
            let prev_halves = [fan.half_at(creasing, 1), fan_prev.half_at(creasing, 0)];
            at_prev_edge.set_edge(creasing, [0, 2], prev_halves);
        }
        let spokes = (0..k).map(edge).collect();
        let diagonals: Points = (0..k).map(|j| vertex(wrap(j + 1))).collect();
        let mut at_centre = Fan::of_quads(self.centre, spokes, &diagonals, prev, true);
        at_centre.key = self.face.map(|face| FanKey { centre: Centre::Face(face), level: 0 });
        let fans: SmallVec<[Fan; 4]> =
            smallvec![fan.refined(creasing), at_next_edge, at_centre, at_prev_edge];
        let centre = fans[0].face(0).map_or(fans[0].vertex, |face| face.point);
        Self { fans, face: None, centre, creasing }
    }

    /// The four quarters of a quad inside the surface round which nothing is sharp, as corners whose vertex may be regular.
    /// `None` for others.
    pub(crate) fn smooth_quarters(&self) -> Option<[Corner; 4]> {
        let fans: [&Fan; 4] = match &self.fans[..] {
            [a, b, c, d] => [a, b, c, d],
            _ => return None,
        };
        if !fans.iter().all(|fan| fan.closed && fan.around.is_none()) {
            return None;
        }
        let vertices = fans.map(|fan| fan.vertex_point(self.creasing));
        let edges = fans.map(|fan| fan.edge_point_at(self.creasing, 0));
        Some(std::array::from_fn(|i| {
            let [next, far, prev] = [1, 2, 3].map(|offset| (i + offset) % 4);
            let fan = fans[i];
            let mut corner = Corner {
                closed: true,
                tip: Tip::Moving,
                home: fan.home,
                key: fan.key.map(|key| FanKey { level: key.level + 1, ..key }),
                origin: DVec3::ZERO,
                vertex: vertices[i],
                spokes: (0..fan.spokes.len()).map(|j| fan.edge_point(self.creasing, j)).collect(),
                diagonals: fan.faces.iter().map(|face| face.point).collect(),
                outer: [
                    fans[next].edge_point_at(self.creasing, 2),
                    vertices[next],
                    edges[next],
                    vertices[far],
                    edges[far],
                    vertices[prev],
                    fans[prev].edge_point_at(self.creasing, -1),
                ],
            };
            // The grid of a regular one is taken as it is.
            if corner.spokes.len() != 4 {
                corner.recentre();
            }
            corner
        }))
    }

    /// A child quad, a ring of sectors, as a [`Corner`] at its corner 0. The other corners must be regular, which holds
    /// for the children of a quad. `None` when the face is no quad.
    pub(crate) fn corner(&self) -> Option<Corner> {
        let [fan, right, far, left] = &self.fans[..] else {
            return None;
        };
        let here = |p: Option<DVec3>| p.unwrap_or(fan.vertex);
        let mut corner = Corner {
            closed: fan.closed,
            tip: fan.tip.clone(),
            home: fan.home,
            key: fan.key.filter(|_| fan.closed && matches!(fan.tip, Tip::Moving)),
            origin: DVec3::ZERO,
            vertex: fan.vertex,
            spokes: fan.spokes.clone(),
            diagonals: fan.faces.iter().map(|face| face.diagonal).collect(),
            outer: [
                here(right.diagonal(2)),
                here(right.spoke(-1)),
                here(right.diagonal(-1)),
                here(far.diagonal(2)),
                here(far.spoke(3)),
                here(left.spoke(2)),
                here(left.diagonal(2)),
            ],
        };
        corner.recentre();
        Some(corner)
    }
}

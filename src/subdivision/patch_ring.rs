//! The neighbourhood of one face, and its refinement: what the limit surface of a face depends on.
//!
//! A ring is the face and, round each of its corners, the fan of faces there. One refinement step gives the rings of
//! the child faces. The masks of Catmull-Clark stand here once, in [`Fan::vertex_point`] and [`Fan::edge_point`].

use super::patch_bicubic::Grid;
use super::patch_corner::{Corner, Points};
use crate::mesh::{FaceId, HalfEdgeId, Mesh};
use glam::DVec3;
use smallvec::{SmallVec, smallvec};

/// A face of a fan, seen from the fan's vertex.
#[derive(Clone, Copy, Debug)]
struct FanFace {
    /// Average of the vertices: the face point.
    point: DVec3,
    /// For quads the opposite vertex.
    diagonal: DVec3,
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
    /// All faces are quads.
    quads: bool,
}

/// See the [module](self).
#[derive(Clone, Debug)]
pub(crate) struct Ring {
    fans: SmallVec<[Fan; 4]>,
    /// Face point of the ring's own face.
    centre: DVec3,
}

/// The points that refinement makes of the vertices and edges of the ring's own face.
pub(crate) struct RefinedFace {
    vertices: Points,
    /// Edge `i` runs from corner `i` to corner `i + 1`.
    edges: Points,
}

fn face_point(mesh: &Mesh, face: FaceId) -> (DVec3, usize) {
    let (mut sum, mut count) = (DVec3::ZERO, 0);
    for v in mesh.face_vertices(face) {
        sum += mesh.position(v);
        count += 1;
    }
    (sum / count as f64, count)
}

impl Fan {
    /// The fan at the source of `corner`, a half-edge of the ring's face.
    fn new(mesh: &Mesh, corner: HalfEdgeId) -> Self {
        let mut first = corner;
        let mut home = 0;
        let mut closed = false;
        while !mesh.face(first.mate()).is_boundary() {
            first = mesh.vertex_cw(first);
            home += 1;
            if first == corner {
                (closed, home) = (true, 0);
                break;
            }
        }
        let mut fan = Self {
            vertex: mesh.position(mesh.source(corner)),
            spokes: Points::new(),
            faces: SmallVec::new(),
            home,
            closed,
            quads: true,
        };
        let mut spoke = first;
        loop {
            fan.spokes.push(mesh.position(mesh.target(spoke)));
            let face = mesh.face(spoke);
            if face.is_boundary() {
                break;
            }
            let (point, arity) = face_point(mesh, face);
            fan.quads &= arity == 4;
            let diagonal = mesh.position(mesh.target(mesh.next(spoke)));
            fan.faces.push(FanFace { point, diagonal });
            spoke = mesh.vertex_ccw(spoke);
            if spoke == first {
                break;
            }
        }
        fan
    }

    /// A fan of quads; `diagonals` per face.
    fn of_quads(vertex: DVec3, spokes: Points, diagonals: &[DVec3], home: usize, closed: bool) -> Self {
        let count = spokes.len();
        let faces = diagonals.iter().enumerate().map(|(j, &diagonal)| {
            let next = if j + 1 == count { 0 } else { j + 1 };
            FanFace { point: (vertex + spokes[j] + diagonal + spokes[next]) * 0.25, diagonal }
        });
        let faces = faces.collect();
        Self { vertex, spokes, faces, home, closed, quads: true }
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

    /// True for the fans of which regular patches consist.
    fn is_regular(&self) -> bool {
        self.quads && self.faces.len() == if self.closed { 4 } else { 2 }
    }

    fn vertex_point(&self) -> DVec3 {
        if self.closed {
            let n = self.spokes.len() as f64;
            let sum: DVec3 = self.spokes.iter().zip(&self.faces).map(|(&s, f)| s + f.point).sum();
            self.vertex * ((n - 2.0) / n) + sum / (n * n)
        } else {
            (self.spokes[0] + 6.0 * self.vertex + self.spokes[self.spokes.len() - 1]) * 0.125
        }
    }

    /// Edge point of spoke `j`.
    fn edge_point(&self, j: usize) -> DVec3 {
        let before = if j > 0 { Some(j - 1) } else { self.closed.then(|| self.faces.len() - 1) };
        let faces = before.and_then(|b| self.faces.get(b)).zip(self.faces.get(j));
        match faces {
            Some((a, b)) => (self.vertex + self.spokes[j] + a.point + b.point) * 0.25,
            None => (self.vertex + self.spokes[j]) * 0.5,
        }
    }

    /// Edge point of spoke `home + offset`, which the caller knows to exist.
    fn edge_point_at(&self, offset: isize) -> DVec3 {
        self.spoke_at(offset).map_or(self.vertex, |j| self.edge_point(j))
    }

    /// The fan of the same vertex after one step.
    fn refined(&self) -> Self {
        let spokes = (0..self.spokes.len()).map(|j| self.edge_point(j)).collect();
        let diagonals: Points = self.faces.iter().map(|face| face.point).collect();
        Self::of_quads(self.vertex_point(), spokes, &diagonals, self.home, self.closed)
    }
}

impl Ring {
    /// The ring of a real face; `None` when the face has fewer than three edges.
    pub(crate) fn new(mesh: &Mesh, face: FaceId) -> Option<Self> {
        if face.is_boundary() || !mesh.has_face(face) {
            return None;
        }
        let fans: SmallVec<[Fan; 4]> = mesh.face_half_edges(face).map(|h| Fan::new(mesh, h)).collect();
        (fans.len() >= 3).then(|| Self { fans, centre: face_point(mesh, face).0 })
    }

    /// Number of corners.
    pub(crate) fn arity(&self) -> usize {
        self.fans.len()
    }

    /// The control grid of a face whose limit is a single bicubic patch: a quad with only regular corners and
    /// quads around. `None` when the face needs local refinement.
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
            vertices: self.fans.iter().map(Fan::vertex_point).collect(),
            edges: self.fans.iter().map(|fan| fan.edge_point_at(0)).collect(),
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

        let at_next_edge = match fan.face(-1) {
            Some(mate) => Fan::of_quads(
                edge(corner),
                smallvec![self.centre, vertex(corner), mate.point, vertex(next)],
                &[edge(prev), fan.edge_point_at(-1), fan_next.edge_point_at(2), edge(after)],
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
        let at_prev_edge = match fan.face(1) {
            Some(mate) => Fan::of_quads(
                edge(prev),
                smallvec![vertex(corner), self.centre, vertex(prev), mate.point],
                &[edge(corner), edge(before), fan_prev.edge_point_at(-1), fan.edge_point_at(2)],
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
        let spokes = (0..k).map(|j| edge(wrap(prev + j))).collect();
        let diagonals: Points = (0..k).map(|j| vertex(wrap(corner + j))).collect();
        let at_centre = Fan::of_quads(self.centre, spokes, &diagonals, 0, true);
        let fans: SmallVec<[Fan; 4]> = smallvec![fan.refined(), at_next_edge, at_centre, at_prev_edge];
        let centre = fans[0].face(0).map_or(fans[0].vertex, |face| face.point);
        Self { fans, centre }
    }

    /// A child quad as a [`Corner`] at its corner 0. The other corners must be regular, which holds for the
    /// children of a quad. `None` when the face is no quad.
    pub(crate) fn corner(&self) -> Option<Corner> {
        let [fan, right, far, left] = &self.fans[..] else {
            return None;
        };
        let here = |p: Option<DVec3>| p.unwrap_or(fan.vertex);
        let mut corner = Corner {
            closed: fan.closed,
            home: fan.home,
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

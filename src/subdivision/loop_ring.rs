//! The triangles round one triangle of a Loop surface, and their refinement: what the limit surface of the triangle depends
//! on.

use super::loop_box_spline::Net;
use super::loop_limit::edge_weight;
use super::patch_corner::Points;
use super::ring;
use super::sharpness::{Around, Values};
use crate::mesh::{Creasing, FaceId, HalfEdgeId, Mesh};
use glam::DVec3;
use smallvec::smallvec;

/// The triangles round a corner of the ring's own: the ends of the edges, counter-clockwise, of which `home` and the next
/// one belong to the ring's triangle. A closed fan has as many triangles as spokes, an open one has one less.
#[derive(Clone, Debug)]
struct Fan {
    vertex: DVec3,
    spokes: Points,
    home: usize,
    closed: bool,
    /// What is sharp; `None` where nothing is but the boundary.
    around: Option<Around>,
}

/// See the [module](self).
#[derive(Clone, Debug)]
pub(super) struct LoopRing {
    fans: [Fan; 3],
    creasing: Creasing,
}

impl Fan {
    fn new(mesh: &Mesh, corner: HalfEdgeId, origin: DVec3) -> Option<Self> {
        let ring = ring::Ring::new(mesh, mesh.source(corner))?;
        Some(Self {
            vertex: mesh.position(ring.center) - origin,
            spokes: ring.edges.iter().map(|&h| mesh.position(mesh.target(h)) - origin).collect(),
            home: ring.edges.iter().position(|&h| h == corner)?,
            closed: !ring.on_boundary,
            around: Around::of(mesh, ring.center, &ring.edges),
        })
    }

    /// Index of spoke `home + offset`, cyclic where the fan is closed.
    fn at(&self, offset: usize) -> usize {
        (self.home + offset) % self.spokes.len()
    }

    fn vertex_point(&self, creasing: Creasing) -> DVec3 {
        let crease = |a: usize, b: usize| 0.75 * self.vertex + 0.125 * (self.spokes[a] + self.spokes[b]);
        let smooth = || {
            let weight = edge_weight(self.spokes.len());
            let sum: DVec3 = self.spokes.iter().sum();
            (1.0 - weight * self.spokes.len() as f64) * self.vertex + weight * sum
        };
        let Some(around) = &self.around else {
            return if self.closed { smooth() } else { crease(0, self.spokes.len() - 1) };
        };
        let blend = around.blend(creasing);
        let mut point = blend.corner * self.vertex;
        if blend.crease > 0.0 {
            point += blend.crease * crease(blend.crease_edges[0], blend.crease_edges[1]);
        }
        if blend.smooth() > 0.0 {
            point += blend.smooth() * smooth();
        }
        point
    }

    fn edge_point(&self, creasing: Creasing, j: usize) -> DVec3 {
        let count = self.spokes.len();
        let middle = 0.5 * (self.vertex + self.spokes[j]);
        if !self.closed && (j == 0 || j + 1 == count) {
            return middle;
        }
        let beside = self.spokes[(j + count - 1) % count] + self.spokes[(j + 1) % count];
        let smooth = 0.375 * (self.vertex + self.spokes[j]) + 0.125 * beside;
        match &self.around {
            Some(around) => {
                let share = around.crease_share(creasing, j);
                share * middle + (1.0 - share) * smooth
            }
            None => smooth,
        }
    }

    fn refined(&self, creasing: Creasing) -> Self {
        Self {
            vertex: self.vertex_point(creasing),
            spokes: (0..self.spokes.len()).map(|j| self.edge_point(creasing, j)).collect(),
            around: self.around.as_ref().map(|around| around.refined(creasing)),
            ..*self
        }
    }

    fn half(&self, creasing: Creasing, j: usize) -> (f32, Values) {
        self.around.as_ref().map_or((0.0, Values::new()), |around| around.half_and_others(creasing, j))
    }

    /// All six directions of the lattice, from spoke `home` on, of a regular vertex or a regular sector between sharp edges;
    /// beyond a border the net continues so that parallelograms close. `None` for others.
    fn lattice(&self) -> Option<[DVec3; 6]> {
        let (first, faces) = match &self.around {
            None => (0, if self.closed { 6 } else { 3 }),
            Some(around) if around.is_fixed() || around.infinite_spokes().len() == 1 => return None,
            Some(around) => around.sector(self.home).unwrap_or((0, 6)),
        };
        let count = self.spokes.len();
        let spoke = |i: usize| self.spokes[(first + i) % count];
        let home = (self.home + count - first) % count;
        let around = match faces {
            6 if count == 6 => std::array::from_fn(spoke),
            3 if self.around.is_some() || count == 4 => {
                let [a, b, c, d] = [0, 1, 2, 3].map(spoke);
                [a, b, c, d, self.vertex + d - c, self.vertex + a - b]
            }
            _ => return None,
        };
        Some(std::array::from_fn(|i| around[(home + i) % 6]))
    }
}

impl LoopRing {
    /// The ring of a triangle, relative to `origin`.
    pub(super) fn new(mesh: &Mesh, face: FaceId, origin: DVec3) -> Option<Self> {
        let first = mesh.face_half_edge(face);
        let second = mesh.next(first);
        let fans = [
            Fan::new(mesh, first, origin)?,
            Fan::new(mesh, second, origin)?,
            Fan::new(mesh, mesh.next(second), origin)?,
        ];
        Some(Self { fans, creasing: mesh.subdivision().creasing })
    }

    /// The control net where the triangle is a piece of the box spline.
    pub(super) fn net(&self) -> Option<Net> {
        if self.fans.iter().flat_map(|fan| &fan.around).any(Around::is_semi_sharp) {
            return None;
        }
        /// Steps of the lattice, counter-clockwise.
        const STEPS: [[isize; 2]; 6] = [[1, 0], [0, 1], [-1, 1], [-1, 0], [0, -1], [1, -1]];
        /// Place of each corner, and the step to the next one.
        const CORNERS: [([isize; 2], usize); 3] = [([0, 0], 0), ([1, 0], 2), ([0, 1], 4)];
        let mut net = [[DVec3::ZERO; 4]; 4];
        let mut set = |[x, y]: [isize; 2], point: DVec3| net[(y + 1) as usize][(x + 1) as usize] = point;
        for (fan, ([x, y], first)) in self.fans.iter().zip(CORNERS) {
            set([x, y], fan.vertex);
            for (i, point) in fan.lattice()?.into_iter().enumerate() {
                let [dx, dy] = STEPS[(first + i) % 6];
                set([x + dx, y + dy], point);
            }
        }
        Some(net)
    }

    /// The ring of child `child`: 0 to 2 at the corners, each with its vertex point as the first corner, and 3 in the middle,
    /// whose first corner is the point of the edge opposite to corner 0.
    pub(super) fn child(&self, child: usize) -> Self {
        let fans = match child {
            3 => [self.edge_fan(1, 1), self.edge_fan(2, 1), self.edge_fan(0, 1)],
            corner => [
                self.fans[corner].refined(self.creasing),
                self.edge_fan(corner, 2),
                self.edge_fan((corner + 2) % 3, 0),
            ],
        };
        Self { fans, creasing: self.creasing }
    }

    /// The fan of the point of the edge from corner `edge` on. Its triangles of the refined ring's own are those at the far
    /// end, in the middle and at the near end: `home` 0, 1 and 2.
    fn edge_fan(&self, edge: usize, home: usize) -> Fan {
        let creasing = self.creasing;
        let [near, far, top] = [0, 1, 2].map(|offset| &self.fans[(edge + offset) % 3]);
        let mut spokes: Points = smallvec![
            far.vertex_point(creasing),
            far.edge_point(creasing, far.home),
            top.edge_point(creasing, top.home),
            near.vertex_point(creasing),
        ];
        let closed = near.closed || near.home > 0;
        let mut around = None;
        if closed {
            let count = near.spokes.len();
            spokes.push(near.edge_point(creasing, (near.home + count - 1) % count));
            spokes.push(far.edge_point(creasing, far.at(2)));
            let halves = [far.half(creasing, far.at(1)), near.half(creasing, near.home)];
            around = Around::of_edge(creasing, 6, [0, 3], halves);
        }
        let point = near.edge_point(creasing, near.home);
        Fan { vertex: point, spokes, home, closed, around }
    }
}

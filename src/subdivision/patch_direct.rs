//! The patches of most quads straight from the mesh: those with four regular corners, or three, inside the surface and
//! with nothing sharp round them. What is left to do for others stands in [`patch`](super::patch).

use super::patch_bicubic::Grid;
use crate::mesh::{FaceId, HalfEdgeId, Mesh, VertexId};
use glam::DVec3;

/// The patch of a quad.
#[expect(clippy::large_enum_variant, reason = "it lives for one call")]
pub(crate) enum Direct {
    /// Its control grid.
    Regular(Grid),
    /// One corner is extraordinary.
    Corner {
        /// Which one.
        corner: u8,
        /// The half-edge of the face that leaves it.
        half_edge: HalfEdgeId,
        /// As in [`Corner`](super::patch_corner::Corner), in the frame whose origin the corner is.
        outer: [DVec3; 7],
    },
}

/// The other three half-edges of a real face with four.
fn quad_after(mesh: &Mesh, h: HalfEdgeId) -> Option<[HalfEdgeId; 3]> {
    let second = mesh.next(h);
    let third = mesh.next(second);
    let last = mesh.next(third);
    (mesh.next(last) == h && !mesh.face(h).is_boundary()).then_some([second, third, last])
}

/// The two vertices beyond each edge, and the one beyond each regular corner: all but the face's own that its surface
/// depends on.
struct Neighbours {
    half_edges: [HalfEdgeId; 4],
    /// Beyond edge `i`: the neighbour of corner `i`, and that of corner `i + 1`.
    beyond: [[VertexId; 2]; 4],
    diagonal: [Option<VertexId>; 4],
}

impl Neighbours {
    fn new(mesh: &Mesh, face: FaceId) -> Option<Self> {
        let first = mesh.face_half_edge(face);
        let [second, third, last] = quad_after(mesh, first)?;
        let half_edges = [first, second, third, last];
        let mut across = [[first; 3]; 4];
        for (h, slot) in half_edges.iter().zip(&mut across) {
            *slot = quad_after(mesh, h.mate())?;
        }
        let diagonal = std::array::from_fn(|i| {
            // Round a regular corner one more face lies between those across its two edges; at a vertex of two faces it
            // would be the face itself.
            let behind = across[i][0].mate();
            let [second, _, last] = quad_after(mesh, behind)?;
            let before = (i + 3) % 4;
            let regular = second.mate() == across[before][2] && behind != half_edges[before];
            regular.then(|| mesh.source(last))
        });
        let beyond = across.map(|[second, third, _]| [mesh.target(second), mesh.target(third)]);
        Some(Self { half_edges, beyond, diagonal })
    }
}

impl Direct {
    /// The patch of a real face round whose corners nothing is sharp. `None` for other faces than quads, at the boundary
    /// and with more extraordinary corners.
    pub(crate) fn new(mesh: &Mesh, face: FaceId) -> Option<Self> {
        let Neighbours { half_edges, beyond, diagonal } = Neighbours::new(mesh, face)?;
        let at = |v: VertexId| mesh.position(v);
        match diagonal {
            [Some(d0), Some(d1), Some(d2), Some(d3)] => {
                let [v0, v1, v2, v3] = half_edges.map(|h| at(mesh.source(h)));
                let [[a0, b0], [a1, b1], [a2, b2], [a3, b3]] = beyond.map(|pair| pair.map(at));
                Some(Self::Regular([
                    [at(d0), a0, b0, at(d1)],
                    [b3, v0, v1, a1],
                    [a3, v3, v2, b1],
                    [at(d3), b2, a2, at(d2)],
                ]))
            }
            _ => {
                let corner = diagonal.iter().position(Option::is_none)?;
                let place = |offset: usize| (corner + offset) % 4;
                let [d1, d2, d3] = [diagonal[place(1)]?, diagonal[place(2)]?, diagonal[place(3)]?];
                let [[a1, b1], [a2, b2]] = [beyond[place(1)], beyond[place(2)]];
                let outer = [d1, a1, b1, d2, a2, b2, d3].map(at);
                Some(Self::Corner { corner: corner as u8, half_edge: half_edges[corner], outer })
            }
        }
    }
}

/// The points round a vertex inside the surface whose faces are quads: its edges' ends, counter-clockwise from
/// [`Mesh::vertex_half_edge`], and the opposite vertices of the faces between them.
pub(crate) fn quads_round(mesh: &Mesh, v: VertexId) -> Option<(Vec<DVec3>, Vec<DVec3>)> {
    let start = mesh.vertex_half_edge(v)?;
    let (mut spokes, mut diagonals) = (Vec::with_capacity(8), Vec::with_capacity(8));
    let mut h = start;
    loop {
        let [second, third, last] = quad_after(mesh, h)?;
        spokes.push(mesh.position(mesh.source(second)));
        diagonals.push(mesh.position(mesh.source(third)));
        h = last.mate();
        if h == start {
            return Some((spokes, diagonals));
        }
    }
}

/// Place of `h` among the half-edges that leave its source, counter-clockwise from [`Mesh::vertex_half_edge`].
pub(crate) fn place_round(mesh: &Mesh, h: HalfEdgeId) -> usize {
    let start = mesh.vertex_half_edge(mesh.source(h)).unwrap_or(h);
    let mut place = 0;
    let mut at = start;
    while at != h {
        at = mesh.vertex_ccw(at);
        place += 1;
        if at == start {
            return 0;
        }
    }
    place
}

/// True when nothing is sharp round the corners of `face`.
pub(crate) fn is_smooth(mesh: &Mesh, face: FaceId) -> bool {
    !mesh.has_sharpness()
        || mesh.face_vertices(face).all(|v| {
            mesh.vertex_sharpness(v) <= 0.0 && mesh.outgoing(v).all(|h| mesh.edge_sharpness(h) <= 0.0)
        })
}

//! The limit surface of a face as a linear function of its control vertices, at fixed parameters.
//!
//! The weights depend on the topology and the sharpness around the face only, so faces that look alike share a table.
//! Tables are made by evaluating the patches of the face with the unit vectors as control points, three at a time.

use super::patch::Patch;
use super::patch_ring::Ring;
use super::sharpness::{Around, is_semi_sharp};
use crate::mesh::{Creasing, FaceId, HalfEdgeId, Mesh, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;
use smallvec::SmallVec;
use std::rc::Rc;

/// Weights of one control vertex at one sample: position, derivatives by u and v, by u twice, by u and v, by v twice.
pub(crate) type Weights = [f64; 6];

/// A sample of a face.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Place {
    /// Patch of the face.
    pub(crate) patch: usize,
    /// Parameters in (0, 1), where derivatives exist.
    pub(crate) u: f64,
    pub(crate) v: f64,
    /// Share of the patch's parameter square.
    pub(crate) share: f64,
}

/// The weights of all samples of a face.
pub(crate) struct Table {
    /// Sample by sample, each with one entry per control vertex.
    weights: Vec<Weights>,
    vertices: usize,
    places: Vec<Place>,
    is_bicubic: bool,
}

impl Table {
    /// True for a quad that is one bicubic, so that curvature is smooth in it.
    pub(crate) fn is_bicubic(&self) -> bool {
        self.is_bicubic
    }

    /// The samples, each with the weights of the control vertices.
    pub(crate) fn samples(&self) -> impl ExactSizeIterator<Item = (Place, &[Weights])> {
        self.places.iter().copied().zip(self.weights.chunks_exact(self.vertices.max(1)))
    }
}

/// The control vertices of a face, in the order of its table.
pub(crate) type Control = SmallVec<[VertexId; 32]>;

/// Tables of faces, sampled at the points of a Gauss-Legendre rule.
pub(crate) struct Tables {
    /// Points per side at most.
    order: usize,
    known: FxHashMap<Vec<u32>, Rc<Table>>,
}

/// Separates the corners in a key.
const CORNER: u32 = u32::MAX;
/// Separates faces in a key.
const FACE: u32 = u32::MAX - 1;

impl Tables {
    /// Tables with at most `order` x `order` samples per quad, 1 to 3.
    pub(crate) fn new(order: usize) -> Self {
        Self { order, known: FxHashMap::default() }
    }

    /// The table of a real face and its control vertices; `None` for a face of fewer than three edges.
    pub(crate) fn of_face(&mut self, mesh: &Mesh, face: FaceId) -> Option<(Control, Rc<Table>)> {
        let mut control: Control = mesh.face_vertices(face).collect();
        let mut key = vec![control.len() as u32];
        for corner in mesh.face_half_edges(face) {
            describe_corner(mesh, corner, &mut control, &mut key);
        }
        if let Some(table) = self.known.get(&key) {
            return Some((control, Rc::clone(table)));
        }
        let table = Rc::new(make(mesh, face, &control, self.order)?);
        self.known.insert(key, Rc::clone(&table));
        Some((control, table))
    }
}

/// Points and weights of the Gauss-Legendre rules on [0, 1] with 1 to 3 points.
const RULES: [&[(f64, f64)]; 3] = [
    &[(0.5, 1.0)],
    &[(0.211_324_865_405_187_13, 0.5), (0.788_675_134_594_812_9, 0.5)],
    &[(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)],
];

/// The samples of a face: 3 x 3 on a quad, 2 x 2 on each quadrant of another face; fewer where a face has many control
/// vertices, so that each sample is dear and there are many of them.
fn places(arity: usize, control: usize, order: usize) -> Vec<Place> {
    let patches = if arity == 4 { 1 } else { arity };
    let most = match control {
        ..32 if patches == 1 => 3,
        ..64 => 2,
        _ => 1,
    };
    let rule = RULES[order.clamp(1, most) - 1];
    let of_patch = |patch| {
        rule.iter()
            .flat_map(move |&(v, dv)| rule.iter().map(move |&(u, du)| Place { patch, u, v, share: du * dv }))
    };
    (0..patches).flat_map(of_patch).collect()
}

fn make(mesh: &Mesh, face: FaceId, control: &Control, order: usize) -> Option<Table> {
    let places = places(mesh.arity(face), control.len(), order);
    let mut weights = vec![[0.0; 6]; places.len() * control.len()];
    let mut is_bicubic = false;
    for first in (0..control.len()).step_by(3) {
        let unit = |v: VertexId| {
            let at = control.iter().position(|&c| c == v).map_or(usize::MAX, |i| i.wrapping_sub(first));
            [DVec3::X, DVec3::Y, DVec3::Z].get(at).copied().unwrap_or_default()
        };
        let patches = Patch::of_ring(&Ring::with_positions(mesh, face, &unit)?);
        is_bicubic = matches!(patches[..], [Patch::Regular(_)]);
        for (row, place) in weights.chunks_exact_mut(control.len()).zip(&places) {
            let jet = patches.get(place.patch)?.evaluate(place.u, place.v).jet;
            for (axis, entry) in row.iter_mut().skip(first).take(3).enumerate() {
                *entry = [jet.position, jet.du, jet.dv, jet.duu, jet.duv, jet.dvv].map(|vector| vector[axis]);
            }
        }
    }
    Some(Table { weights, vertices: control.len(), places, is_bicubic })
}

/// Adds to `key` the faces round the source of `corner` with their vertices as numbers in `control`, which grows by
/// those that are new, and what is sharp there.
fn describe_corner(mesh: &Mesh, corner: HalfEdgeId, control: &mut Control, key: &mut Vec<u32>) {
    key.push(CORNER);
    let mut number = |v: VertexId, key: &mut Vec<u32>| {
        let known = control.iter().position(|&c| c == v);
        key.push(known.unwrap_or(control.len()) as u32);
        if known.is_none() {
            control.push(v);
        }
    };
    // The home face first, then the others counter-clockwise, then those before it.
    let mut first = corner;
    while !mesh.face(first.mate()).is_boundary() {
        first = mesh.vertex_cw(first);
        if first == corner {
            break;
        }
    }
    let mut spokes: SmallVec<[HalfEdgeId; 8]> = SmallVec::new();
    let mut spoke = first;
    loop {
        if spoke == corner {
            key.push(CORNER);
        }
        spokes.push(spoke);
        let face = mesh.face(spoke);
        if face.is_boundary() {
            number(mesh.target(spoke), key);
            break;
        }
        key.push(FACE);
        let mut h = mesh.next(spoke);
        while h != spoke {
            number(mesh.source(h), key);
            h = mesh.next(h);
        }
        spoke = mesh.vertex_ccw(spoke);
        if spoke == first {
            break;
        }
    }
    if let Some(around) = Around::of(mesh, mesh.source(corner), &spokes) {
        key.push(FACE);
        key.push(around.vertex.to_bits());
        key.extend(around.spokes.iter().map(|sharpness| sharpness.to_bits()));
        if mesh.subdivision().creasing == Creasing::Chaikin && around.spokes.iter().any(|&s| is_semi_sharp(s))
        {
            // Depends on edges further away too: shared with no other face.
            key.push(corner.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Polygons;
    use crate::subdivision::evaluate;

    /// A cube with a cap on top split into triangles: quads and triangles, valences 3 to 5.
    fn capped_cube() -> Mesh {
        let mut positions: Vec<DVec3> =
            (0..8).map(|i| DVec3::new((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into())).collect();
        positions.push(DVec3::new(0.4, 0.6, 1.5));
        let faces: [&[u32]; 9] = [
            &[0, 2, 3, 1],
            &[0, 1, 5, 4],
            &[2, 6, 7, 3],
            &[0, 4, 6, 2],
            &[1, 3, 7, 5],
            &[4, 5, 8],
            &[5, 7, 8],
            &[7, 6, 8],
            &[6, 4, 8],
        ];
        Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a solid")
    }

    #[test]
    fn weights_give_the_evaluated_points() {
        let mut mesh = capped_cube();
        let crease = mesh.half_edges().next().expect("an edge");
        for sharpness in [0.0, 1.5, f32::INFINITY] {
            mesh.set_edge_sharpness(crease, sharpness);
            let mut tables = Tables::new(3);
            for face in mesh.faces() {
                let (control, table) = tables.of_face(&mesh, face).expect("a face");
                for (place, weights) in table.samples() {
                    let expected = evaluate(&mesh, face, place.patch, place.u, place.v).expect("a point");
                    let second = expected.second.expect("inside of a face");
                    let jet = [expected.position, expected.du, expected.dv, second.uu, second.uv, second.vv];
                    for (k, expected) in jet.into_iter().enumerate() {
                        let found: DVec3 =
                            control.iter().zip(weights).map(|(&v, w)| mesh.position(v) * w[k]).sum();
                        assert!(
                            found.distance(expected) < 1e-12,
                            "{face:?} {place:?} {k}: {found} {expected}"
                        );
                    }
                }
            }
        }
    }
}

//! Half-edges from face lists.
//!
//! One pass over the corners: each either completes an edge that an earlier face began or begins a new one, so that
//! edges are numbered by first use. The edges of a vertex form a short list, kept at the smaller vertex of each; where
//! a list would grow long (a pole), a hash table takes over: linear time whatever the faces.

use super::defect::{Defect, Defects};
use super::ids::{FaceId, NONE};
use super::polygons::Polygons;
use super::{HalfEdge, Mesh};
use crate::fault;
use crate::memory::{self, OutOfMemory};
use rustc_hash::FxHashMap;

/// Edges per vertex that are kept in a list: a pole of a million triangles must not cost its square.
const LONGEST_LIST: u32 = 16;

impl Mesh {
    /// Room for a feature beside what was read, so that the first change does not move tables of the mesh's size.
    fn reserve_room(&mut self) -> Result<(), OutOfMemory> {
        let more = self.half_edges.len() / 8;
        memory::reserve(&mut self.half_edges, more)?;
        let more = self.vertices.len() / 8;
        memory::reserve(&mut self.vertices, more)?;
        memory::reserve(&mut self.positions, more)?;
        let more = self.faces.len() / 8;
        memory::reserve(&mut self.faces, more)
    }

    /// Builds the mesh. Vertex and face numbers are those of `polygons`; vertices without a face are kept.
    ///
    /// # Errors
    /// Every [`Defect`] found, each with the numbers of the elements it concerns. Fans that meet in a vertex are looked
    /// for only when edges are in order, and these only when the faces are.
    pub fn from_polygons(polygons: &Polygons) -> Result<Self, Defects> {
        let defects = check_arrays(polygons)?;
        if !defects.is_empty() {
            return Err(Defects(defects));
        }
        fault::point("build");
        let mut edges = EdgeTable::new(polygons)?;
        let mut vertices = memory::filled(polygons.positions.len(), NONE)?;
        let mut faces = memory::room(polygons.face_sizes.len())?;
        for (face, face_vertices) in polygons.faces().enumerate() {
            edges.reserve(face_vertices.len())?;
            let mut first = NONE;
            let mut prev = NONE;
            for (i, &vertex) in face_vertices.iter().enumerate() {
                let target = face_vertices[if i + 1 == face_vertices.len() { 0 } else { i + 1 }];
                let id = edges.half_edge(vertex, target, face as u32);
                if prev == NONE {
                    first = id;
                } else {
                    edges.link(prev, id);
                }
                prev = id;
                if vertices[vertex as usize] == NONE {
                    vertices[vertex as usize] = id;
                }
            }
            edges.link(prev, first);
            faces.push(first);
        }
        let defects = edges.defects();
        if !defects.is_empty() {
            return Err(Defects(defects));
        }

        let mut mesh = Self {
            half_edges: edges.half_edges,
            positions: memory::copied(&polygons.positions)?,
            first_new_vertex: vertices.len() as u32,
            first_new_face: faces.len() as u32,
            vertices,
            faces,
            ..Self::default()
        };
        mesh.reserve_room()?;
        mesh.close_boundaries();
        let fans = mesh.separate_fans();
        if !fans.is_empty() {
            return Err(Defects(fans));
        }
        mesh.carry_data(polygons)?;
        Ok(mesh)
    }

    /// Gives every half-edge without a face its place in a boundary loop.
    fn close_boundaries(&mut self) {
        // The first half-edge of a pair was made for a face: only the second can lie on a boundary.
        for id in (1..self.half_edges.len() as u32).step_by(2) {
            if self.half_edges[id as usize].face != NONE {
                continue;
            }
            let face = FaceId::boundary(self.loops.len() as u32);
            self.loops.push(id);
            let mut current = id;
            loop {
                self.half_edges[current as usize].face = face.0;
                // Turn round the target, inside the surface, until the next half-edge without a face.
                let mut next = current ^ 1;
                loop {
                    next = self.half_edges[next as usize].prev ^ 1;
                    let next_face = self.half_edges[next as usize].face;
                    if next_face == NONE || next_face == face.0 {
                        break;
                    }
                }
                self.half_edges[current as usize].next = next;
                self.half_edges[next as usize].prev = current;
                if next == id {
                    break;
                }
                current = next;
            }
        }
    }

    /// Vertices whose half-edges form several rings.
    /// Vertices whose half-edges form several rings.
    fn separate_fans(&self) -> Vec<Defect> {
        let ring = |start: u32| {
            std::iter::successors(Some(start), move |&h| {
                let next = self.half_edges[(h ^ 1) as usize].next;
                (next != start).then_some(next)
            })
        };
        let on_first_rings: usize =
            self.vertices.iter().filter(|&&h| h != NONE).map(|&h| ring(h).count()).sum();
        if on_first_rings == self.half_edges.len() {
            return Vec::new();
        }
        // Rare: walk the ring of every half-edge that was not met on an earlier one.
        let mut seen = vec![false; self.half_edges.len()];
        let mut fans = vec![0u32; self.vertices.len()];
        for id in 0..self.half_edges.len() as u32 {
            if !seen[id as usize] {
                fans[self.half_edges[id as usize].source as usize] += 1;
                ring(id).for_each(|h| seen[h as usize] = true);
            }
        }
        (0u32..)
            .zip(fans)
            .filter(|&(_, fans)| fans > 1)
            .map(|(vertex, fans)| Defect::SeparateFans { vertex, fans })
            .collect()
    }

    /// Takes over what travels with the faces and corners.
    fn carry_data(&mut self, polygons: &Polygons) -> Result<(), OutOfMemory> {
        if polygons.face_texcoords.len() == polygons.face_vertices.len() && !polygons.texcoords.is_empty() {
            self.texcoords = memory::copied(&polygons.texcoords)?;
            let mut corner_texcoords = memory::filled(self.half_edges.len(), NONE)?;
            let corners = self.faces().flat_map(|f| self.face_half_edges(f));
            for (h, &texcoord) in corners.zip(&polygons.face_texcoords) {
                corner_texcoords[h.index()] = texcoord;
            }
            self.corner_texcoords = corner_texcoords;
        }
        if polygons.face_sets.len() == self.faces.len() {
            self.sets = polygons.sets.clone();
            self.face_sets = memory::copied(&polygons.face_sets)?;
        }
        self.material_libraries = polygons.material_libraries.clone();
        let ends: Vec<(u32, u32)> = polygons.creases.iter().map(|&(a, b, _)| (a, b)).collect();
        for (edge, &(_, _, sharpness)) in self.find_edges(&ends).into_iter().zip(&polygons.creases) {
            if let Some(h) = edge {
                self.set_edge_sharpness(h, sharpness);
            }
        }
        for &(v, sharpness) in &polygons.corners {
            if (v as usize) < self.vertices.len() {
                self.set_vertex_sharpness(super::VertexId(v), sharpness);
            }
        }
        self.subdivision = polygons.subdivision;
        for &face in &polygons.holes {
            if (face as usize) < self.faces.len() {
                self.write_hole(face, true);
            }
        }
        Ok(())
    }
}

/// Everything that can be wrong before two faces are compared.
fn check_arrays(polygons: &Polygons) -> Result<Vec<Defect>, OutOfMemory> {
    let found = polygons.face_vertices.len() as u64;
    let promised: u64 = polygons.face_sizes.iter().map(|&size| u64::from(size)).sum();
    if promised != found {
        return Ok(vec![Defect::SizeMismatch { promised, found }]);
    }
    // Ids have 31 bits (half-edges come in pairs, faces carry a boundary bit).
    let count = (polygons.positions.len() as u64).max(2 * found);
    if count > (1 << 31) - 2 {
        return Ok(vec![Defect::TooLarge { count }]);
    }
    let mut defects = Vec::new();
    for (vertex, position) in polygons.positions.iter().enumerate() {
        if !super::is_place(*position) {
            defects.push(Defect::NotFinite { vertex: vertex as u32 });
        }
    }
    let vertex_count = polygons.positions.len();
    // The last face that named each vertex: finds repetitions in linear time.
    let mut last_face = memory::filled(vertex_count, NONE)?;
    for (face, vertices) in polygons.faces().enumerate() {
        let face = face as u32;
        if vertices.len() < 3 {
            defects.push(Defect::TooFewVertices { face, size: vertices.len() as u32 });
        }
        for &vertex in vertices {
            match last_face.get_mut(vertex as usize) {
                None => defects.push(Defect::VertexOutOfRange { face, vertex }),
                Some(last) if *last == face => {
                    defects.push(Defect::RepeatedVertex { face, vertex });
                }
                Some(last) => *last = face,
            }
        }
    }
    Ok(defects)
}

/// The half-edges that the faces so far have made, and how to find them by their ends.
struct EdgeTable {
    /// `source` and `face` are set; `face` is `NONE` on the side that no face has claimed yet.
    half_edges: Vec<HalfEdge>,
    /// The last edge of which each vertex is the smaller end.
    last_edge: Vec<u32>,
    /// For each edge, the one before it in the list of its smaller end.
    edge_before: Vec<u32>,
    /// Edges whose smaller end has a full list, by (smaller, larger) end.
    crowded: FxHashMap<(u32, u32), u32>,
    /// Faces that found their edge taken: (edge, face).
    conflicts: Vec<(u32, u32)>,
}

impl EdgeTable {
    fn new(polygons: &Polygons) -> Result<Self, OutOfMemory> {
        let corner_count = polygons.face_vertices.len();
        // Enough for a mesh with few boundaries.
        let half_edge_count = corner_count + corner_count / 16;
        Ok(Self {
            half_edges: memory::room(half_edge_count)?,
            last_edge: memory::filled(polygons.positions.len(), NONE)?,
            edge_before: memory::room(half_edge_count / 2)?,
            crowded: FxHashMap::default(),
            conflicts: Vec::new(),
        })
    }

    /// Makes room for the edges of a face with `arity` sides.
    fn reserve(&mut self, arity: usize) -> Result<(), OutOfMemory> {
        memory::reserve(&mut self.half_edges, 2 * arity)?;
        memory::reserve(&mut self.edge_before, arity)
    }

    /// The half-edge from `a` to `b` with `face` on its left.
    fn half_edge(&mut self, a: u32, b: u32, face: u32) -> u32 {
        let (low, high) = (a.min(b), a.max(b));
        let mut length = 0;
        let mut edge = self.last_edge[low as usize];
        while edge != NONE {
            // All edges of the list have `low` as one end.
            let pair = &self.half_edges[2 * edge as usize..2 * edge as usize + 2];
            if pair[0].source ^ pair[1].source == low ^ high {
                return self.claim(edge, a, face);
            }
            length += 1;
            edge = self.edge_before[edge as usize];
        }
        let new = (self.half_edges.len() / 2) as u32;
        if length < LONGEST_LIST {
            self.edge_before.push(std::mem::replace(&mut self.last_edge[low as usize], new));
        } else if let Some(&known) = self.crowded.get(&(low, high)) {
            return self.claim(known, a, face);
        } else {
            self.crowded.insert((low, high), new);
            self.edge_before.push(NONE);
        }
        self.half_edges.push(HalfEdge { source: a, face, ..HalfEdge::UNSET });
        self.half_edges.push(HalfEdge { source: b, ..HalfEdge::UNSET });
        2 * new
    }

    /// Gives `face` the second side of an edge, which must be free and start at `a`.
    fn claim(&mut self, edge: u32, a: u32, face: u32) -> u32 {
        let second = &mut self.half_edges[2 * edge as usize + 1];
        if second.face == NONE && second.source == a {
            second.face = face;
        } else {
            // The tables are of no use from here on, but the other conflicts are to be found too.
            self.conflicts.push((edge, face));
        }
        2 * edge + 1
    }

    fn link(&mut self, prev: u32, next: u32) {
        self.half_edges[prev as usize].next = next;
        self.half_edges[next as usize].prev = prev;
    }

    /// The edges that more than two faces claim, or two in the same direction; sorted.
    fn defects(&mut self) -> Vec<Defect> {
        self.conflicts.sort_unstable();
        let mut defects: Vec<Defect> = self
            .conflicts
            .chunk_by(|x, y| x.0 == y.0)
            .map(|group| {
                let pair = [0, 1].map(|side| self.half_edges[2 * group[0].0 as usize + side]);
                let [a, b] = pair.map(|half_edge| half_edge.source);
                let edge = (a.min(b), a.max(b));
                let owners = pair.into_iter().map(|half_edge| half_edge.face).filter(|&face| face != NONE);
                let mut faces: Vec<u32> = owners.chain(group.iter().map(|conflict| conflict.1)).collect();
                faces.sort_unstable();
                if faces.len() == 2 {
                    Defect::InconsistentOrientation { edge, faces }
                } else {
                    Defect::EdgeWithManyFaces { edge, faces }
                }
            })
            .collect();
        defects.sort();
        defects
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// A closed double pyramid over `count` vertices, with its poles before or after them.
    fn double_pyramid(count: u32, poles: [u32; 2], first: u32) -> Polygons {
        let mut polygons = Polygons::new(vec![DVec3::ZERO; count as usize + 2], &[]);
        for i in 0..count {
            let (a, b) = (first + i, first + (i + 1) % count);
            polygons.face_sizes.extend([3, 3]);
            polygons.face_vertices.extend([poles[0], a, b, poles[1], b, a]);
        }
        polygons
    }

    #[test]
    fn poles_of_any_valence_close() {
        for count in [3, 15, 16, 17, 1000] {
            for (poles, first) in [([0, 1], 2), ([count, count + 1], 0)] {
                let mesh = Mesh::from_polygons(&double_pyramid(count, poles, first)).expect("a closed mesh");
                mesh.validate().expect("valid");
                assert_eq!(mesh.boundary_loops().count(), 0);
                assert_eq!(mesh.edges().count(), 3 * count as usize);
                assert_eq!(poles.map(|pole| mesh.valence(crate::mesh::VertexId(pole))), [count as usize; 2]);
            }
        }
    }

    #[test]
    fn a_third_face_is_found_at_a_crowded_pole() {
        let mut polygons = double_pyramid(1000, [0, 1], 2);
        polygons.face_sizes.extend([3, 3]);
        polygons.face_vertices.extend([0, 2, 500, 900, 0, 2]);
        let found = Mesh::from_polygons(&polygons).expect_err("an edge with four faces");
        let edge = Defect::EdgeWithManyFaces { edge: (0, 2), faces: vec![0, 1998, 2000, 2001] };
        assert!(found.0.contains(&edge), "{found}");
        for edge in [(0, 500), (0, 900)] {
            let is_it = |d: &Defect| matches!(d, Defect::EdgeWithManyFaces { edge: e, .. } if *e == edge);
            assert!(found.0.iter().any(is_it), "{found}");
        }
    }

    #[test]
    fn fans_are_counted_at_each_vertex() {
        // Three triangles at vertex 0 and two at vertex 1, none of which share an edge.
        let faces: [&[u32]; 4] = [&[0, 1, 2], &[0, 3, 4], &[0, 5, 6], &[1, 7, 8]];
        let found = Mesh::from_polygons(&Polygons::new(vec![DVec3::ZERO; 9], &faces)).expect_err("fans");
        let expected =
            [Defect::SeparateFans { vertex: 0, fans: 3 }, Defect::SeparateFans { vertex: 1, fans: 2 }];
        assert_eq!(found.0, expected);
    }
}

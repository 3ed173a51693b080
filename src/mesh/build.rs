//! Half-edges from face lists.
//!
//! Corners are bucketed by the smaller vertex of the edge that starts there, so that the two sides of an edge meet in
//! a short bucket: linear time, no hashing, and edges are numbered by first use.

use super::defect::{Defect, Defects};
use super::ids::{FaceId, NONE};
use super::polygons::Polygons;
use super::{HalfEdge, Mesh};

/// Buckets longer than this are sorted before they are paired: a pole of a million triangles must not cost its square.
const LONG_BUCKET: usize = 24;

impl Mesh {
    /// Builds the mesh. Vertex and face numbers are those of `polygons`; vertices without a face are kept.
    ///
    /// # Errors
    /// Every [`Defect`] found, each with the numbers of the elements it concerns.
    pub fn from_polygons(polygons: &Polygons) -> Result<Self, Defects> {
        let mut defects = check_arrays(polygons);
        if !defects.is_empty() {
            return Err(Defects(defects));
        }
        let corner_count = polygons.face_vertices.len();
        let mut mesh = Self {
            positions: polygons.positions.clone(),
            vertices: vec![NONE; polygons.positions.len()],
            ..Self::default()
        };
        let corner_face = corner_faces(polygons);
        let partner = pair_corners(polygons, &corner_face, &mut defects);
        if !defects.is_empty() {
            defects.sort();
            return Err(Defects(defects));
        }

        // Number the edges by first use and fill in everything but the boundary loops.
        let mut half_edge_of = vec![NONE; corner_count];
        mesh.half_edges.reserve(corner_count + corner_count / 16);
        for corner in 0..corner_count {
            if half_edge_of[corner] != NONE {
                continue;
            }
            let id = mesh.half_edges.len() as u32;
            half_edge_of[corner] = id;
            if partner[corner] != NONE {
                half_edge_of[partner[corner] as usize] = id + 1;
            }
            mesh.half_edges.extend([HalfEdge::UNSET; 2]);
        }
        mesh.faces.reserve(polygons.face_sizes.len());
        let mut start = 0;
        for (face, vertices) in polygons.faces().enumerate() {
            let size = vertices.len();
            for (i, &vertex) in vertices.iter().enumerate() {
                let id = half_edge_of[start + i];
                mesh.half_edges[id as usize] = HalfEdge {
                    next: half_edge_of[start + if i + 1 == size { 0 } else { i + 1 }],
                    prev: half_edge_of[start + if i == 0 { size - 1 } else { i - 1 }],
                    source: vertex,
                    face: face as u32,
                };
                if mesh.vertices[vertex as usize] == NONE {
                    mesh.vertices[vertex as usize] = id;
                }
            }
            mesh.faces.push(half_edge_of[start]);
            start += size;
        }
        mesh.first_new_face = mesh.faces.len() as u32;
        mesh.close_boundaries();

        let fans = mesh.separate_fans();
        if !fans.is_empty() {
            return Err(Defects(fans));
        }
        mesh.carry_data(polygons, &half_edge_of);
        Ok(mesh)
    }

    /// Gives every half-edge without a face its place in a boundary loop.
    fn close_boundaries(&mut self) {
        for id in 0..self.half_edges.len() as u32 {
            if self.half_edges[id as usize].source == NONE {
                let mate = self.half_edges[(id ^ 1) as usize];
                self.half_edges[id as usize].source = self.half_edges[mate.next as usize].source;
            }
        }
        for id in 0..self.half_edges.len() as u32 {
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
    fn carry_data(&mut self, polygons: &Polygons, half_edge_of: &[u32]) {
        if polygons.face_texcoords.len() == half_edge_of.len() && !polygons.texcoords.is_empty() {
            self.texcoords = polygons.texcoords.clone();
            self.corner_texcoords = vec![NONE; self.half_edges.len()];
            for (corner, &id) in half_edge_of.iter().enumerate() {
                self.corner_texcoords[id as usize] = polygons.face_texcoords[corner];
            }
        }
        if polygons.face_sets.len() == self.faces.len() {
            self.sets = polygons.sets.clone();
            self.face_sets = polygons.face_sets.clone();
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
    }
}

/// Everything that can be wrong before two faces are compared.
fn check_arrays(polygons: &Polygons) -> Vec<Defect> {
    let found = polygons.face_vertices.len() as u64;
    let promised: u64 = polygons.face_sizes.iter().map(|&size| u64::from(size)).sum();
    if promised != found {
        return vec![Defect::SizeMismatch { promised, found }];
    }
    // Ids have 31 bits (half-edges come in pairs, faces carry a boundary bit).
    let count = (polygons.positions.len() as u64).max(2 * found);
    if count > (1 << 31) - 2 {
        return vec![Defect::TooLarge { count }];
    }
    let mut defects = Vec::new();
    for (vertex, position) in polygons.positions.iter().enumerate() {
        if !position.is_finite() {
            defects.push(Defect::NotFinite { vertex: vertex as u32 });
        }
    }
    let vertex_count = polygons.positions.len();
    // The last face that named each vertex: finds repetitions in linear time.
    let mut last_face = vec![NONE; vertex_count];
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
    defects
}

fn corner_faces(polygons: &Polygons) -> Vec<u32> {
    let mut faces = Vec::with_capacity(polygons.face_vertices.len());
    for (face, &size) in polygons.face_sizes.iter().enumerate() {
        faces.resize(faces.len() + size as usize, face as u32);
    }
    faces
}

/// For each corner the corner on the other side of the edge that starts there, or `NONE` at a boundary.
fn pair_corners(polygons: &Polygons, corner_face: &[u32], defects: &mut Vec<Defect>) -> Vec<u32> {
    let corner_count = polygons.face_vertices.len();
    // The edge at each corner: (smaller vertex, larger vertex), and whether the corner runs from the smaller one.
    let mut ends = Vec::with_capacity(corner_count);
    for vertices in polygons.faces() {
        for (i, &a) in vertices.iter().enumerate() {
            let b = vertices[if i + 1 == vertices.len() { 0 } else { i + 1 }];
            ends.push((a, b));
        }
    }
    let mut starts = vec![0u32; polygons.positions.len() + 1];
    for &(a, b) in &ends {
        starts[a.min(b) as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut fill = starts.clone();
    let mut entries = vec![(0u32, 0u32); corner_count];
    for (corner, &(a, b)) in ends.iter().enumerate() {
        let slot = &mut fill[a.min(b) as usize];
        entries[*slot as usize] = (a.max(b), corner as u32);
        *slot += 1;
    }
    let mut partner = vec![NONE; corner_count];
    for bucket in starts.windows(2) {
        let bucket = &mut entries[bucket[0] as usize..bucket[1] as usize];
        if bucket.len() > LONG_BUCKET {
            bucket.sort_unstable();
        }
        pair_bucket(bucket, &ends, corner_face, &mut partner, defects);
    }
    partner
}

/// Pairs the corners of one bucket; entries of one edge are adjacent when the bucket is long (it is sorted then).
fn pair_bucket(
    bucket: &mut [(u32, u32)],
    ends: &[(u32, u32)],
    corner_face: &[u32],
    partner: &mut [u32],
    defects: &mut Vec<Defect>,
) {
    let sorted = bucket.len() > LONG_BUCKET;
    for i in 0..bucket.len() {
        let (large, corner) = bucket[i];
        if large == NONE {
            continue;
        }
        let same: smallvec::SmallVec<[u32; 4]> = if sorted {
            bucket[i + 1..].iter().take_while(|entry| entry.0 == large).map(|entry| entry.1).collect()
        } else {
            bucket[i + 1..].iter().filter(|entry| entry.0 == large).map(|entry| entry.1).collect()
        };
        if same.is_empty() {
            continue;
        }
        let opposite = ends[corner as usize].0 == ends[same[0] as usize].1;
        if same.len() == 1 && opposite {
            partner[corner as usize] = same[0];
            partner[same[0] as usize] = corner;
        } else {
            let (a, b) = ends[corner as usize];
            let edge = (a.min(b), large);
            let mut faces: Vec<u32> = std::iter::once(corner)
                .chain(same.iter().copied())
                .map(|c| corner_face[c as usize])
                .collect();
            faces.sort_unstable();
            defects.push(if same.len() == 1 {
                Defect::InconsistentOrientation { edge, faces }
            } else {
                Defect::EdgeWithManyFaces { edge, faces }
            });
        }
        for entry in &mut bucket[i + 1..] {
            if entry.0 == large {
                entry.0 = NONE;
            } else if sorted {
                break;
            }
        }
    }
}

//! Edges, fans and orientation of polygons that need not be a manifold.

use crate::mesh::Polygons;

/// Stands for "none".
pub(super) const NONE: u32 = u32::MAX;

/// How the faces of some polygons hang together. Faces with fewer than three vertices, with a repeated vertex or with
/// one that does not exist are left out ("unsound").
pub(super) struct Topology<'a> {
    polygons: &'a Polygons,
    /// Index of the first corner of each face, and the number of corners at the end.
    pub(super) face_start: Vec<u32>,
    pub(super) corner_face: Vec<u32>,
    pub(super) sound: Vec<bool>,
    /// The corners of the sound faces, sorted by the edge that starts there.
    uses: Vec<EdgeUse>,
    /// For each corner, the corner of the other face where its edge has exactly two faces; `NONE` elsewhere.
    pub(super) partner: Vec<u32>,
}

/// A corner, under the edge that starts there.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct EdgeUse {
    pub(super) low: u32,
    pub(super) high: u32,
    pub(super) corner: u32,
}

/// Which faces to turn round so that neighbours agree.
pub(super) struct Orientation {
    pub(super) flip: Vec<bool>,
    /// Pairs of corners across whose edge no choice agrees: the surface has one side only.
    pub(super) conflicts: Vec<(u32, u32)>,
}

impl<'a> Topology<'a> {
    /// Looks at all faces; `n log n` in the number of corners, which must be below 2^32 - 1.
    pub(super) fn new(polygons: &'a Polygons) -> Self {
        let corner_count = polygons.face_vertices.len();
        let mut topology = Self {
            polygons,
            face_start: Vec::with_capacity(polygons.face_sizes.len() + 1),
            corner_face: Vec::with_capacity(corner_count),
            sound: sound_faces(polygons),
            uses: Vec::with_capacity(corner_count),
            partner: vec![NONE; corner_count],
        };
        let mut start = 0;
        for (face, vertices) in polygons.faces().enumerate() {
            topology.face_start.push(start);
            topology.corner_face.resize(topology.corner_face.len() + vertices.len(), face as u32);
            if topology.sound[face] {
                for (i, &a) in vertices.iter().enumerate() {
                    let b = vertices[if i + 1 == vertices.len() { 0 } else { i + 1 }];
                    topology.uses.push(EdgeUse { low: a.min(b), high: a.max(b), corner: start + i as u32 });
                }
            }
            start += vertices.len() as u32;
        }
        topology.face_start.push(start);
        topology.uses.sort_unstable();
        for edge in topology.uses.chunk_by(EdgeUse::same_edge) {
            if let [one, other] = edge {
                topology.partner[one.corner as usize] = other.corner;
                topology.partner[other.corner as usize] = one.corner;
            }
        }
        topology
    }

    /// The edges, ascending by their vertices: for each, the corners that run along it.
    pub(super) fn edges(&self) -> impl Iterator<Item = &[EdgeUse]> {
        self.uses.chunk_by(EdgeUse::same_edge)
    }

    /// The vertex at a corner.
    pub(super) fn vertex(&self, corner: u32) -> u32 {
        self.polygons.face_vertices[corner as usize]
    }

    /// The face of a corner.
    pub(super) fn face(&self, corner: u32) -> u32 {
        self.corner_face[corner as usize]
    }

    /// The corners of a face.
    pub(super) fn corners(&self, face: u32) -> std::ops::Range<u32> {
        self.face_start[face as usize]..self.face_start[face as usize + 1]
    }

    /// The next corner of the same face.
    pub(super) fn next(&self, corner: u32) -> u32 {
        let corners = self.corners(self.face(corner));
        if corner + 1 == corners.end { corners.start } else { corner + 1 }
    }

    /// True when two corners run along their edge in the same direction.
    fn same_direction(&self, a: u32, b: u32) -> bool {
        self.vertex(a) == self.vertex(b)
    }

    /// Finds an orientation of the faces in which neighbours across edges with two faces agree. In each part that
    /// such edges connect, the fewer faces are flipped; with a tie the lowest face stays.
    pub(super) fn orientation(&self) -> Orientation {
        let mut flip = vec![false; self.sound.len()];
        let mut seen = vec![false; self.sound.len()];
        let mut conflicts = Vec::new();
        let mut part = Vec::new();
        for first in 0..self.sound.len() as u32 {
            if seen[first as usize] || !self.sound[first as usize] {
                continue;
            }
            part.clear();
            part.push(first);
            seen[first as usize] = true;
            let mut visited = 0;
            while let Some(&face) = part.get(visited) {
                visited += 1;
                for corner in self.corners(face) {
                    let other = self.partner[corner as usize];
                    if other == NONE {
                        continue;
                    }
                    let neighbour = self.face(other);
                    let wanted = flip[face as usize] ^ self.same_direction(corner, other);
                    if !seen[neighbour as usize] {
                        seen[neighbour as usize] = true;
                        flip[neighbour as usize] = wanted;
                        part.push(neighbour);
                    } else if flip[neighbour as usize] != wanted && corner < other {
                        conflicts.push((corner, other));
                    }
                }
            }
            let flipped = part.iter().filter(|&&face| flip[face as usize]).count();
            if 2 * flipped > part.len() {
                part.iter().for_each(|&face| flip[face as usize] ^= true);
            }
        }
        conflicts.sort_unstable();
        conflicts.dedup();
        Orientation { flip, conflicts }
    }

    /// The fan each corner belongs to, named by the fan's lowest corner. A fan is a set of faces at one vertex that
    /// edges with two faces connect; the edges of `cut` (pairs of corners, sorted) do not.
    pub(super) fn fans(&self, cut: &[(u32, u32)]) -> Vec<u32> {
        let mut fans = Partition::new(self.partner.len());
        for corner in 0..self.partner.len() as u32 {
            let other = self.partner[corner as usize];
            if other == NONE || other < corner || cut.binary_search(&(corner, other)).is_ok() {
                continue;
            }
            let (next, other_next) = (self.next(corner), self.next(other));
            if self.same_direction(corner, other) {
                fans.unite(corner, other);
                fans.unite(next, other_next);
            } else {
                fans.unite(corner, other_next);
                fans.unite(next, other);
            }
        }
        (0..self.partner.len() as u32).map(|corner| fans.find(corner)).collect()
    }
}

impl EdgeUse {
    fn same_edge(&self, other: &Self) -> bool {
        (self.low, self.high) == (other.low, other.high)
    }
}

/// Which faces have at least three vertices, all different, all existing.
fn sound_faces(polygons: &Polygons) -> Vec<bool> {
    let mut last_face = vec![NONE; polygons.positions.len()];
    let sound = |(face, vertices): (usize, &[u32])| {
        vertices.len() >= 3
            && vertices.iter().all(|&vertex| match last_face.get_mut(vertex as usize) {
                Some(last) => std::mem::replace(last, face as u32) != face as u32,
                None => false,
            })
    };
    polygons.faces().enumerate().map(sound).collect()
}

/// A partition of numbers, each part named by its lowest member.
pub(super) struct Partition(Vec<u32>);

impl Partition {
    /// Every number below `count` by itself.
    pub(super) fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// The lowest member of the part of `x`.
    pub(super) fn find(&mut self, mut x: u32) -> u32 {
        while self.0[x as usize] != x {
            let parent = self.0[x as usize];
            self.0[x as usize] = self.0[parent as usize];
            x = parent;
        }
        x
    }

    /// Joins the parts of `a` and `b`.
    pub(super) fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

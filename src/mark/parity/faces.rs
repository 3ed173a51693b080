//! Which faces are odd, and where parity lines may go.
//!
//! The rules know these ways: through an unmarked quad from any side to any other; straight across a band, between the
//! two unmarked sides of a quad whose other sides have the same number of lines; into a dead end from the front, and
//! into a T from the side opposite of its stem; into other faces with marks by any unmarked side. A line ends at the
//! border, and, where asked for, in unmarked faces that have an odd number of sides.

use crate::mesh::{FaceId, HalfEdgeId, Mesh};
use rustc_hash::FxHashMap;
use smallvec::{SmallVec, smallvec};

/// What a line finds behind the side by which it enters a face.
pub(super) enum Passage {
    /// The mesh ends: so does the line.
    Border,
    /// The line may end here.
    End(FaceId),
    /// An unmarked quad.
    Free,
    /// A band that the line crosses to the side named, and the number of its lines.
    Across(HalfEdgeId, usize),
    /// There is no way.
    Closed,
}

/// Where a face with marked sides is open.
enum Gate {
    /// To one line, by any of these sides: the face is odd.
    Exits(SmallVec<[HalfEdgeId; 2]>),
    /// Across a straight band with so many lines.
    Across([HalfEdgeId; 2], usize),
    Closed,
}

pub(super) struct Faces<'m> {
    mesh: &'m Mesh,
    marked: FxHashMap<FaceId, Gate>,
    /// Faces that had an even number of sides and are left with an odd one; ascending.
    odd: Vec<FaceId>,
    /// Lines may end in unmarked faces with an odd number of sides.
    irregular_ends: bool,
}

impl<'m> Faces<'m> {
    pub(super) fn new(mesh: &'m Mesh, marks: &[(HalfEdgeId, usize)], irregular_ends: bool) -> Self {
        let lines: FxHashMap<u32, usize> = marks.iter().map(|&(h, lines)| (h.edge(), lines)).collect();
        let mut faces: Vec<FaceId> = marks
            .iter()
            .flat_map(|&(h, _)| [h, h.mate()])
            .map(|h| mesh.face(h))
            .filter(|f| !f.is_boundary())
            .collect();
        faces.sort_unstable();
        faces.dedup();
        let (mut marked, mut odd) = (FxHashMap::default(), Vec::new());
        for face in faces {
            let sides: Vec<(HalfEdgeId, usize)> = mesh
                .face_half_edges(face)
                .map(|h| (h, lines.get(&h.edge()).copied().unwrap_or_default()))
                .collect();
            let inserted: usize = sides.iter().map(|side| side.1).sum();
            if sides.len().is_multiple_of(2) && !inserted.is_multiple_of(2) {
                odd.push(face);
            }
            marked.insert(face, gate(&sides));
        }
        Self { mesh, marked, odd, irregular_ends }
    }

    /// The faces that the marks leave odd, ascending.
    pub(super) fn odd(&self) -> &[FaceId] {
        &self.odd
    }

    /// The sides by which a line may leave an odd face.
    pub(super) fn exits(&self, face: FaceId) -> impl Iterator<Item = HalfEdgeId> {
        let exits = match self.marked.get(&face) {
            Some(Gate::Exits(exits)) => exits.as_slice(),
            _ => &[],
        };
        exits.iter().copied().filter(|&h| !self.is_glued(h))
    }

    /// True for a face without marked sides.
    pub(super) fn is_unmarked(&self, face: FaceId) -> bool {
        !self.marked.contains_key(&face)
    }

    /// What a line finds that crosses `h` into the face on its left.
    pub(super) fn passage(&self, h: HalfEdgeId) -> Passage {
        let face = self.mesh.face(h);
        if face.is_boundary() {
            return Passage::Border;
        }
        if self.is_glued(h) {
            return Passage::Closed;
        }
        match self.marked.get(&face) {
            Some(Gate::Exits(exits)) if exits.contains(&h) => Passage::End(face),
            Some(&Gate::Across([a, b], lines)) if a == h => Passage::Across(b, lines),
            Some(&Gate::Across([a, b], lines)) if b == h => Passage::Across(a, lines),
            Some(_) => Passage::Closed,
            None => match self.mesh.arity(face) {
                4 => Passage::Free,
                arity if self.irregular_ends && arity % 2 == 1 => Passage::End(face),
                _ => Passage::Closed,
            },
        }
    }

    /// A face that meets itself at this edge.
    fn is_glued(&self, h: HalfEdgeId) -> bool {
        self.mesh.face(h) == self.mesh.face(h.mate())
    }
}

/// Where a face is open whose `sides` have so many lines each.
fn gate(sides: &[(HalfEdgeId, usize)]) -> Gate {
    let is_odd = sides.iter().map(|side| side.1).sum::<usize>() % 2 == 1 && sides.len().is_multiple_of(2);
    let [a, b, c, d] = *sides else { return if is_odd { by_any_side(sides) } else { Gate::Closed } };
    for [front, left, back, right] in [[a, b, c, d], [b, c, d, a], [c, d, a, b], [d, a, b, c]] {
        match [front, left, back, right].map(|side| side.1) {
            [0, 0, _, 0] if is_odd => return Gate::Exits(smallvec![front.0]),
            [0, x, y, z] if is_odd && x > 0 && y > 0 && z > 0 => return Gate::Exits(smallvec![front.0]),
            [0, x, 0, y] if x > 0 && x == y => return Gate::Across([front.0, back.0], x),
            _ => {}
        }
    }
    Gate::Closed
}

/// The unmarked sides of a face with six sides or more, without those beside a marked one where there are others.
fn by_any_side(sides: &[(HalfEdgeId, usize)]) -> Gate {
    let n = sides.len();
    let free = |i: &usize| sides[*i % n].1 == 0;
    let apart: SmallVec<[HalfEdgeId; 2]> =
        (0..n).filter(|i| free(i) && free(&(i + 1)) && free(&(i + n - 1))).map(|i| sides[i].0).collect();
    let exits = if apart.is_empty() { (0..n).filter(free).map(|i| sides[i].0).collect() } else { apart };
    if exits.is_empty() { Gate::Closed } else { Gate::Exits(exits) }
}

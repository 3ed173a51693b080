//! Tiling of a face: its inside is replaced by faces that are given as lists of corners.
//!
//! Made of Euler operators, so that it is logged and undone like them: one face after the other is cut off from what
//! is left of the old face, which stays a disk. A disk of faces can always be taken apart in this way.

use super::Mesh;
use super::euler::EulerError;
use super::ids::{HalfEdgeId, VertexId};
use glam::DVec3;

/// A corner of a face in a tiling.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Corner {
    /// A vertex of the old face.
    Vertex(VertexId),
    /// A new vertex, by its number.
    Inner(usize),
}

/// Why a face cannot be tiled. Nothing is promised about the mesh then: roll it back.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
pub enum TileError {
    /// The faces do not fit together.
    #[error(
        "face {face} of the tiling, counted from 0, does not fit to the rest; the faces must cover the old face once, counter-clockwise, and use every point"
    )]
    Misfit {
        /// The first face that was left.
        face: usize,
    },
    /// An operator refused.
    #[error(transparent)]
    Euler(#[from] EulerError),
}

impl Mesh {
    /// Replaces the face of `e` by `faces`, whose new vertices stand at `points`. Returns the new vertices.
    ///
    /// The faces run counter-clockwise like the old one and cover it: together with it they make a closed surface.
    /// The last one keeps the old face's id.
    ///
    /// # Errors
    /// [`TileError`]
    pub fn tile_face(
        &mut self,
        e: HalfEdgeId,
        points: &[DVec3],
        faces: &[Vec<Corner>],
    ) -> Result<Vec<VertexId>, TileError> {
        let mut inner: Vec<Option<VertexId>> = vec![None; points.len()];
        let mut left: Vec<usize> = (0..faces.len()).collect();
        // A half-edge of what is left of the old face.
        let mut rest = e;
        while let [first, ..] = left[..] {
            let polygon: Vec<HalfEdgeId> = self.face_half_edges(self.face(rest)).collect();
            let found = left.iter().enumerate().find_map(|(place, &face)| {
                let cut = self.cut(&polygon, &faces[face], &inner)?;
                // The last face is what is left of the old one.
                (cut.closes == (left.len() == 1)).then_some((place, cut))
            });
            let Some((place, cut)) = found else { return Err(TileError::Misfit { face: first }) };
            left.remove(place);
            if cut.closes {
                break;
            }
            // Antennas from the end of the run through the new vertices, then an edge back to its start.
            let mut end = cut.end;
            for number in cut.path {
                let point = points.get(number).ok_or(TileError::Misfit { face: first })?;
                end = self.make_ev_one(end, *point)?;
                inner[number] = Some(self.source(end));
            }
            rest = self.make_ef(cut.start, end)?.mate();
        }
        match (left[..].first(), inner.into_iter().collect::<Option<Vec<_>>>()) {
            (None, Some(inner)) => Ok(inner),
            (face, _) => Err(TileError::Misfit { face: face.copied().unwrap_or(0) }),
        }
    }

    /// How `face` can be cut off from `polygon`: its sides on the polygon make one run, and its other corners are new.
    fn cut(&self, polygon: &[HalfEdgeId], face: &[Corner], inner: &[Option<VertexId>]) -> Option<Cut> {
        let count = face.len();
        let place = |corner: &Corner| -> Option<usize> {
            let v = match corner {
                Corner::Vertex(v) => *v,
                Corner::Inner(number) => (*inner.get(*number)?)?,
            };
            polygon.iter().position(|&h| self.source(h) == v)
        };
        let places: Vec<Option<usize>> = face.iter().map(place).collect();
        let on_polygon = |i: usize| {
            let (a, b) = (places[i % count], places[(i + 1) % count]);
            a.zip(b).is_some_and(|(a, b)| (a + 1) % polygon.len() == b)
        };
        if count == polygon.len() && (0..count).all(on_polygon) {
            return Some(Cut { start: polygon[0], end: polygon[0], path: Vec::new(), closes: true });
        }
        let first = (0..count).find(|&i| on_polygon(i) && !on_polygon(i + count - 1))?;
        let length = (0..count).take_while(|&i| on_polygon(first + i)).count();
        // Corners beyond the run's end, back to its start.
        let mut path = Vec::with_capacity(count);
        for i in first + length + 1..first + count {
            match face[i % count] {
                Corner::Inner(number) if inner.get(number)?.is_none() && !path.contains(&number) => {
                    path.push(number);
                }
                _ => return None,
            }
        }
        let [start, end] = [first, first + length].map(|i| places[i % count]);
        Some(Cut { start: polygon[start?], end: polygon[end?], path, closes: false })
    }
}

/// One face of a tiling that can be cut off.
struct Cut {
    /// Half-edges of what is left that start where the face's run of sides starts, and where it ends.
    start: HalfEdgeId,
    end: HalfEdgeId,
    /// Numbers of the new vertices from the run's end back to its start.
    path: Vec<usize>,
    /// The face is all that is left.
    closes: bool,
}

//! Shapes to draw, given as flat arrays, and their triangles.

use super::camera::View;
use super::canvas::Corner;
use glam::DVec3;

/// A polygon mesh in the caller's arrays: a control cage, or a limit surface cut into small faces.
///
/// Face `f` has the `face_sizes[f]` vertices that follow those of face `f - 1` in `face_vertices`. Faces with fewer than
/// three vertices, with an index out of range or a position that is not finite are not drawn.
#[derive(Clone, Copy, Default, Debug)]
pub struct Shape<'a> {
    /// Vertex positions, in the caller's unit.
    pub positions: &'a [DVec3],
    /// Number of vertices of each face.
    pub face_sizes: &'a [u32],
    /// Vertex indices (0-based) of all faces, counter-clockwise seen from outside.
    pub face_vertices: &'a [u32],
}

impl<'a> Shape<'a> {
    /// The vertices of each face that can be drawn.
    pub(super) fn faces(&self) -> impl Iterator<Item = &'a [u32]> + use<'a> {
        let positions = self.positions;
        let mut rest = self.face_vertices;
        let all = self.face_sizes.iter().map_while(move |&size| {
            let (face, tail) = rest.split_at_checked(size as usize)?;
            rest = tail;
            Some(face)
        });
        all.filter(move |face| {
            face.len() > 2 && face.iter().all(|&v| positions.get(v as usize).is_some_and(|p| p.is_finite()))
        })
    }

    /// Edges of all faces, each once, ascending.
    pub(super) fn edges(&self) -> Vec<(u32, u32)> {
        let mut edges: Vec<(u32, u32)> =
            self.faces().flat_map(|face| sides(face).map(|(a, b)| (a.min(b), a.max(b)))).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Vertex normals as the mean of the adjacent faces' normals, weighted by area; not of unit length.
    pub(super) fn averaged_normals(&self) -> Vec<DVec3> {
        let mut normals = vec![DVec3::ZERO; self.positions.len()];
        for face in self.faces() {
            let normal = area_vector(face.iter().map(|&v| self.positions[v as usize]));
            for &v in face {
                normals[v as usize] += normal;
            }
        }
        normals
    }
}

/// The directed edges of a face.
fn sides(face: &[u32]) -> impl Iterator<Item = (u32, u32)> {
    face.iter().copied().zip(face.iter().copied().cycle().skip(1))
}

/// The area vector of a closed polygon: its normal, as long as twice its area (Newell).
pub(super) fn area_vector(points: impl Iterator<Item = DVec3> + Clone) -> DVec3 {
    let Some(first) = points.clone().next() else { return DVec3::ZERO };
    let next = points.clone().skip(1).chain(std::iter::once(first));
    // Relative to one corner, so that far from the origin no digits are lost.
    points.zip(next).map(|(p, q)| (p - first).cross(q - first)).sum()
}

/// Cuts a face into triangles: a quad along the diagonal that keeps both halves on one side, a larger face into a fan
/// around its centroid. `corner` gives the corner of a vertex.
pub(super) fn triangulate<const N: usize>(
    face: &[u32],
    corner: impl Fn(u32) -> Corner<N>,
    mut emit: impl FnMut([Corner<N>; 3]),
) {
    match *face {
        [a, b, c] => emit([a, b, c].map(corner)),
        [a, b, c, d] => {
            let [a, b, c, d] = [a, b, c, d].map(corner);
            let turn = |p: &Corner<N>, q: &Corner<N>, r: &Corner<N>| {
                let (u, v) = (q.at - p.at, r.at - p.at);
                u.x * v.y - u.y * v.x
            };
            if turn(&a, &b, &c) * turn(&a, &c, &d) >= 0.0 {
                emit([a, b, c]);
                emit([a, c, d]);
            } else {
                emit([b, c, d]);
                emit([b, d, a]);
            }
        }
        _ => {
            let share = 1.0 / face.len() as f64;
            let mut hub = Corner { at: DVec3::ZERO, data: [0.0; N] };
            for &v in face {
                let rim = corner(v);
                hub.at += rim.at * share;
                for (sum, part) in hub.data.iter_mut().zip(rim.data) {
                    *sum += part * share as f32;
                }
            }
            for (p, q) in sides(face) {
                emit([hub, corner(p), corner(q)]);
            }
        }
    }
}

/// Projections of all positions.
pub(super) fn project(positions: &[DVec3], view: &View) -> Vec<DVec3> {
    positions.iter().map(|&p| view.project(p)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area covered by the triangles of a face, seen from above: overlaps count twice.
    fn covered(points: &[(f64, f64)]) -> f64 {
        let face: Vec<u32> = (0..points.len() as u32).collect();
        let at = |v: u32| DVec3::new(points[v as usize].0, points[v as usize].1, 0.0);
        let mut sum = 0.0;
        triangulate(
            &face,
            |v| Corner { at: at(v), data: [] },
            |t| {
                sum += area_vector(t.iter().map(|corner| corner.at)).length() / 2.0;
            },
        );
        sum
    }

    #[test]
    fn triangles_cover_their_face_once() {
        assert_eq!(covered(&[(0.0, 0.0), (4.0, 0.0), (0.0, 2.0)]), 4.0);
        let arrow = [(0.0, 0.0), (4.0, 0.0), (1.0, 1.0), (0.0, 4.0)];
        for turn in 0..4 {
            let mut turned = arrow;
            turned.rotate_left(turn);
            assert_eq!(covered(&turned), 4.0, "the reflex corner is number {}", (6 - turn) % 4);
        }
        let hexagon = [(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (2.0, 2.0), (0.0, 2.0), (-1.0, 1.0)];
        assert!((covered(&hexagon) - 6.0).abs() < 1e-12);
    }

    #[test]
    fn faces_that_cannot_be_drawn_are_left_out() {
        let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::NAN];
        let shape = Shape {
            positions: &positions,
            face_sizes: &[3, 2, 0, 3, 3, 3, 9],
            face_vertices: &[0, 1, 2, 0, 1, 0, 1, 3, 0, 1, 4, 2, 1, 0],
        };
        let faces: Vec<&[u32]> = shape.faces().collect();
        assert_eq!(faces, [[0, 1, 2], [2, 1, 0]]);
        assert_eq!(shape.edges(), [(0, 1), (0, 2), (1, 2)]);
    }
}

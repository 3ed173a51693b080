//! Positions of the next level, and limit positions of a level, by one pass over the faces.
//!
//! Each face adds its share to the points of its corners and edges; the boundary, where the shares are not the whole,
//! is overwritten afterwards. The order of the additions is that of the faces, so results do not vary.

use super::refinement::Refinement;
use super::topology::Level;
use crate::fault;
use crate::memory::{self, OutOfMemory};
use glam::DVec3;

impl Refinement {
    /// Writes the positions of level `level + 1` to `next`, whose memory is reused.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    ///
    /// # Panics
    /// When `level` is the last one, or `positions` has not one entry per vertex of `level`.
    pub fn refine_positions(
        &self,
        level: usize,
        positions: &[DVec3],
        next: &mut Vec<DVec3>,
    ) -> Result<(), OutOfMemory> {
        assert!(level < self.depth(), "level {level} is the last one");
        fault::point("refine");
        let exceptions = self.exceptions(level);
        let level = self.level(level);
        assert_eq!(positions.len(), level.vertex_count(), "one position per vertex");
        let [vertex_count, ..] = level.child_counts();
        next.clear();
        if next.capacity() < vertex_count as usize {
            // Growing would copy what is to be overwritten.
            *next = memory::room(vertex_count as usize)?;
        }
        next.resize(vertex_count as usize, DVec3::ZERO);
        let (vertex_points, rest) = next.split_at_mut(level.vertex_count());
        let (edge_points, face_points) = rest.split_at_mut(level.edge_count());
        if level.quads().is_some() {
            add_quads(level, positions, vertex_points, edge_points, face_points);
        } else {
            add_polygons(level, positions, vertex_points, edge_points, face_points);
        }
        let known = self.valences().len().min(positions.len());
        let (irregular, regular) = vertex_points.split_at_mut(known);
        for ((point, &position), &valence) in irregular.iter_mut().zip(positions).zip(self.valences()) {
            let n = f64::from(valence);
            *point = if valence == 0 { position } else { *point / (n * n) + position * ((n - 2.0) / n) };
        }
        for (point, &position) in regular.iter_mut().zip(&positions[known..]) {
            *point = *point * (1.0 / 16.0) + position * 0.5;
        }
        for edge in &level.boundary {
            let (a, b) = (positions[edge.source as usize], positions[edge.target as usize]);
            let before = positions[edge.previous_source as usize];
            edge_points[(edge.half_edge >> 1) as usize] = (a + b) * 0.5;
            vertex_points[edge.source as usize] = a * 0.75 + (before + b) * 0.125;
        }
        exceptions.apply(positions, vertex_points, edge_points);
        Ok(())
    }

    /// The positions of level `level`, refined from those of the control mesh.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    ///
    /// # Panics
    /// When there is no such level, or `control` has not one entry per vertex of level 0.
    pub fn positions(&self, level: usize, control: &[DVec3]) -> Result<Vec<DVec3>, OutOfMemory> {
        let mut current = memory::copied(control)?;
        let mut next = Vec::new();
        for level in 0..level {
            self.refine_positions(level, &current, &mut next)?;
            std::mem::swap(&mut current, &mut next);
        }
        Ok(current)
    }

    /// The points of the limit surface at the vertices of `level`, which must have quads only (every level but 0 has).
    /// Isolated vertices stay where they are. `None` where level 0 has other faces: refine once, and take the first
    /// points of level 1.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    ///
    /// # Panics
    /// When there is no such level, or `positions` has not one entry per vertex of `level`.
    pub fn limit_positions(
        &self,
        level: usize,
        positions: &[DVec3],
    ) -> Result<Option<Vec<DVec3>>, OutOfMemory> {
        let sharpness = self.sharpness(level);
        let level = self.level(level);
        assert_eq!(positions.len(), level.vertex_count(), "one position per vertex");
        let Some(quads) = level.quads() else { return Ok(None) };
        let mut limit = memory::filled(positions.len(), DVec3::ZERO)?;
        for quad in quads {
            let corner = quad.map(|v| positions[v as usize]);
            for i in 0..4 {
                limit[quad[i] as usize] += 4.0 * corner[(i + 1) % 4] + corner[(i + 2) % 4];
            }
        }
        for (v, (point, &position)) in limit.iter_mut().zip(positions).enumerate() {
            let valence = self.valences().get(v).copied().unwrap_or(4);
            let n = f64::from(valence);
            *point = if valence == 0 { position } else { (n * n * position + *point) / (n * (n + 5.0)) };
        }
        for edge in &level.boundary {
            let neighbours = positions[edge.previous_source as usize] + positions[edge.target as usize];
            limit[edge.source as usize] = (4.0 * positions[edge.source as usize] + neighbours) / 6.0;
        }
        for (vertex, point) in sharpness.limits(level, self.creasing(), positions) {
            limit[vertex as usize] = point;
        }
        Ok(Some(limit))
    }
}

fn add_quads(
    level: &Level,
    positions: &[DVec3],
    vertex_points: &mut [DVec3],
    edge_points: &mut [DVec3],
    face_points: &mut [DVec3],
) {
    let quads = level.corner_vertices.as_chunks::<4>().0;
    let half_edges = level.corner_half_edges.as_chunks::<4>().0;
    for ((v, h), point) in quads.iter().zip(half_edges).zip(face_points) {
        let corner = v.map(|v| positions[v as usize]);
        let middle = (corner[0] + corner[1] + corner[2] + corner[3]) * 0.25;
        *point = middle;
        for i in 0..4 {
            vertex_points[v[i] as usize] += corner[(i + 1) % 4] + middle;
            edge_points[(h[i] >> 1) as usize] += (corner[i] + middle) * 0.25;
        }
    }
}

fn add_polygons(
    level: &Level,
    positions: &[DVec3],
    vertex_points: &mut [DVec3],
    edge_points: &mut [DVec3],
    face_points: &mut [DVec3],
) {
    for (face, point) in face_points.iter_mut().enumerate() {
        let corners = level.corners(face);
        let (vertices, half_edges) =
            (&level.corner_vertices[corners.clone()], &level.corner_half_edges[corners]);
        let sum: DVec3 = vertices.iter().map(|&v| positions[v as usize]).sum();
        let middle = sum / vertices.len() as f64;
        *point = middle;
        let following = vertices.iter().cycle().skip(1);
        for ((&v, &h), &next) in vertices.iter().zip(half_edges).zip(following) {
            vertex_points[v as usize] += positions[next as usize] + middle;
            edge_points[(h >> 1) as usize] += (positions[v as usize] + middle) * 0.25;
        }
    }
}

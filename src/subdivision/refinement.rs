//! Uniform refinement: connectivity once, positions as often as they change.

use super::exceptions::{Exceptions, LevelSharpness};
use super::sharpness::has_limit;
use super::topology::{BoundaryEdge, Level};
use crate::fault;
use crate::memory::{self, OutOfMemory};
use crate::mesh::{BoundaryRule, Creasing, FaceId, HalfEdgeId, Mesh, Polygons, SubdivisionOptions, VertexId};
use glam::DVec3;

/// Refinement cannot be done.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum RefineError {
    /// The level would have more elements than 31-bit ids can number.
    #[error("level {level} would have {elements} elements, more than 2^31 - 1; ask for a lower level")]
    TooLarge {
        /// The level that cannot be made.
        level: usize,
        /// Half-edges it would have.
        elements: u64,
    },
    /// More levels than even one triangle could be refined to.
    #[error("level {depth} is too deep; the deepest is {DEEPEST}")]
    TooDeep {
        /// The level asked for.
        depth: usize,
    },
    /// There is no memory for a level.
    #[error("{0}; a lower level needs less")]
    Memory(#[from] OutOfMemory),
}

/// At this level the children of a single triangle outnumber 31-bit ids.
pub(super) const DEEPEST: usize = 16;

/// Elements of the mesh in the order in which level 0 numbers them: ascending ids, removed elements left out. On a
/// compact mesh element `i` is therefore the one with id `i`.
#[derive(Clone, Debug)]
pub struct ControlIds {
    /// Vertices of level 0.
    pub vertices: Vec<VertexId>,
    /// Edges of level 0, by their even half-edges.
    pub edges: Vec<HalfEdgeId>,
    /// Faces of level 0.
    pub faces: Vec<FaceId>,
}

/// What a vertex of the next level stands for; numbers are those of the level before.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum VertexParent {
    /// It is the vertex point of this vertex.
    Vertex(u32),
    /// It is the edge point of this edge.
    Edge(u32),
    /// It is the face point of this face.
    Face(u32),
}

/// The connectivity of a control mesh and of its Catmull-Clark refinements up to a level.
#[derive(Clone, Debug)]
pub struct Refinement {
    levels: Vec<Level>,
    /// Valences of the vertices of level 1 (of which those of level 0 are the first); later ones have valence 4
    /// wherever a valence is asked for, which is not on the boundary.
    valences: Vec<u32>,
    /// Per level but the last, the points of the next level that are not smooth.
    exceptions: Vec<Exceptions>,
    /// What is sharp on each level.
    sharpness: Vec<LevelSharpness>,
    subdivision: SubdivisionOptions,
    /// Faces of level 0 without a limit surface, ascending.
    left_out: Vec<u32>,
    ids: ControlIds,
}

impl Refinement {
    /// Levels 0 to `depth` of `mesh`. Memory: about 45 bytes per face of every level, 30 on the last.
    ///
    /// # Errors
    /// [`RefineError`]: sizes and depths that cannot be are found before any level is made.
    pub fn new(mesh: &Mesh, depth: usize) -> Result<Self, RefineError> {
        let ids = ControlIds {
            vertices: memory::collected(mesh.vertex_bound(), mesh.vertices())?,
            edges: memory::collected(mesh.half_edge_bound() / 2, mesh.edges())?,
            faces: memory::collected(mesh.face_bound(), mesh.faces())?,
        };
        let control = control_level(mesh, &ids)?;
        let mut valences =
            memory::filled(control.vertex_count() + control.edge_count() + control.face_count(), 0)?;
        valences.truncate(control.vertex_count() + control.edge_count());
        for &v in &control.corner_vertices {
            valences[v as usize] += 1;
        }
        valences[control.vertex_count()..].fill(4);
        valences.extend(control.face_sizes());
        check_size(&control, depth)?;
        let mut levels = vec![control];
        let subdivision = mesh.subdivision();
        let left_out = ids.faces.iter().zip(0..).filter(|&(&f, _)| !has_limit(mesh, f)).map(|(_, face)| face);
        let left_out: Vec<u32> = left_out.collect();
        let mut sharpness = vec![LevelSharpness::of(mesh, &ids)];
        let mut exceptions = Vec::with_capacity(depth);
        for level in 1..=depth {
            fault::point("refine");
            let parent = &levels[level - 1];
            let (found, next) = sharpness[level - 1].refined(parent, subdivision.creasing);
            exceptions.push(found);
            sharpness.push(next);
            let child = parent.child(level == depth)?;
            levels.push(child);
        }
        Ok(Self { levels, valences, exceptions, sharpness, subdivision, left_out, ids })
    }

    /// Number of the last level.
    pub fn depth(&self) -> usize {
        self.levels.len() - 1
    }

    /// A level, 0 being the control mesh.
    ///
    /// # Panics
    /// When `level` exceeds [`depth`](Self::depth).
    pub fn level(&self, level: usize) -> &Level {
        &self.levels[level]
    }

    /// How level 0 numbers the elements of the mesh.
    pub fn control_ids(&self) -> &ControlIds {
        &self.ids
    }

    /// Positions of the vertices of level 0.
    pub fn control_positions(&self, mesh: &Mesh) -> Vec<DVec3> {
        self.ids.vertices.iter().map(|&v| mesh.position(v)).collect()
    }

    /// What vertex `vertex` of `level` stands for on the level before; `None` on level 0 or where there is no such
    /// vertex.
    pub fn vertex_parent(&self, level: usize, vertex: u32) -> Option<VertexParent> {
        let parent = self.levels.get(level.checked_sub(1)?)?;
        if vertex >= self.levels.get(level)?.vertex_count {
            return None;
        }
        Some(if vertex < parent.vertex_count {
            VertexParent::Vertex(vertex)
        } else if vertex < parent.vertex_count + parent.edge_count {
            VertexParent::Edge(vertex - parent.vertex_count)
        } else {
            VertexParent::Face(vertex - parent.vertex_count - parent.edge_count)
        })
    }

    /// The face of the level before, and its corner, that face `face` of `level` covers; `None` on level 0 or where
    /// there is no such face.
    pub fn face_parent(&self, level: usize, face: u32) -> Option<(u32, u32)> {
        let parent = self.levels.get(level.checked_sub(1)?)?;
        ((face as usize) < parent.corner_vertices.len()).then(|| parent.corner_place(face))
    }

    /// Level `level` with the given positions as polygons, which have the sharpness that is left, so that they are
    /// another control mesh of the same surface. Faces without a limit surface are holes.
    ///
    /// # Errors
    /// [`OutOfMemory`].
    ///
    /// # Panics
    /// When there is no such level.
    pub fn polygons(&self, level: usize, positions: Vec<DVec3>) -> Result<Polygons, OutOfMemory> {
        let sharpness = self.sharpness(level);
        let mut subdivision = self.subdivision;
        if subdivision.boundary == BoundaryRule::None {
            // The faces that it leaves out are holes already.
            subdivision.boundary = BoundaryRule::EdgeOnly;
        }
        let (number, level) = (level, self.level(level));
        Ok(Polygons {
            positions,
            face_sizes: memory::collected(level.face_count(), level.face_sizes())?,
            face_vertices: memory::copied(level.face_vertices())?,
            creases: sharpness.creases().collect(),
            corners: sharpness.corners().collect(),
            holes: self.holes(number),
            subdivision,
            ..Polygons::default()
        })
    }

    /// Faces of `level` that are no part of the surface, ascending.
    fn holes(&self, level: usize) -> Vec<u32> {
        let mut holes = self.left_out.clone();
        for parent in &self.levels[..level] {
            holes = holes.iter().flat_map(|&face| parent.corners(face as usize)).map(|c| c as u32).collect();
        }
        holes
    }

    pub(super) fn exceptions(&self, level: usize) -> &Exceptions {
        &self.exceptions[level]
    }

    pub(super) fn sharpness(&self, level: usize) -> &LevelSharpness {
        &self.sharpness[level]
    }

    pub(super) fn creasing(&self) -> Creasing {
        self.subdivision.creasing
    }

    pub(super) fn valences(&self) -> &[u32] {
        &self.valences
    }
}

/// A refined mesh.
#[derive(Clone, Debug)]
pub struct Refined {
    /// Connectivity of all levels.
    pub refinement: Refinement,
    /// Positions of the vertices of the last level.
    pub positions: Vec<DVec3>,
}

impl Refined {
    /// Connectivity of the last level.
    pub fn level(&self) -> &Level {
        self.refinement.level(self.refinement.depth())
    }

    /// The last level as polygons.
    pub fn into_polygons(self) -> Polygons {
        let polygons = self.refinement.polygons(self.refinement.depth(), self.positions);
        polygons.unwrap_or_else(|error| memory::give_up(error))
    }
}

/// Refines `mesh` `levels` times.
///
/// # Errors
/// See [`Refinement::new`].
pub fn refine(mesh: &Mesh, levels: usize) -> Result<Refined, RefineError> {
    let refinement = Refinement::new(mesh, levels)?;
    let positions = refinement.positions(levels, &refinement.control_positions(mesh))?;
    Ok(Refined { refinement, positions })
}

/// Half-edges are the most numerous elements; a level has twice those of the last and two for each of its corners.
fn check_size(control: &Level, depth: usize) -> Result<(), RefineError> {
    if depth > DEEPEST {
        return Err(RefineError::TooDeep { depth });
    }
    let mut corners = control.corner_vertices.len() as u64;
    let mut edges = u64::from(control.edge_count);
    for level in 1..=depth {
        edges = 2 * edges + corners;
        corners *= 4;
        if 2 * edges > u64::from(u32::MAX >> 1) {
            return Err(RefineError::TooLarge { level, elements: 2 * edges });
        }
    }
    Ok(())
}

fn control_level(mesh: &Mesh, ids: &ControlIds) -> Result<Level, OutOfMemory> {
    let mut vertex_rank = memory::filled(mesh.vertex_bound(), u32::MAX)?;
    for (rank, v) in ids.vertices.iter().enumerate() {
        vertex_rank[v.index()] = rank as u32;
    }
    let mut edge_rank = memory::filled(mesh.half_edge_bound() / 2, u32::MAX)?;
    for (rank, h) in ids.edges.iter().enumerate() {
        edge_rank[h.edge() as usize] = rank as u32;
    }
    let vertex = |v: VertexId| vertex_rank[v.index()];
    let half_edge = |h: HalfEdgeId| 2 * edge_rank[h.edge() as usize] + (h.0 & 1);

    let mut starts = memory::room(ids.faces.len() + 1)?;
    starts.push(0);
    // Each edge has a half-edge at two corners at most.
    let corners = mesh.half_edge_bound().min(2 * ids.edges.len());
    let mut corner_vertices = memory::room(corners)?;
    let mut corner_half_edges = memory::room(corners)?;
    for &f in &ids.faces {
        for h in mesh.face_half_edges(f) {
            corner_vertices.push(vertex(mesh.source(h)));
            corner_half_edges.push(half_edge(h));
        }
        starts.push(corner_vertices.len() as u32);
    }
    let all_quads = starts.windows(2).all(|face| face[1] - face[0] == 4);
    let boundary = mesh
        .boundary_loops()
        .flat_map(|f| mesh.face_half_edges(f))
        .map(|h| BoundaryEdge {
            half_edge: half_edge(h),
            source: vertex(mesh.source(h)),
            target: vertex(mesh.target(h)),
            previous: half_edge(mesh.prev(h)),
            previous_source: vertex(mesh.source(mesh.prev(h))),
        })
        .collect();
    Ok(Level {
        vertex_count: ids.vertices.len() as u32,
        edge_count: ids.edges.len() as u32,
        starts: (!all_quads).then_some(starts),
        corner_vertices,
        corner_half_edges,
        boundary,
    })
}

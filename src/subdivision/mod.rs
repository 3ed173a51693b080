//! Catmull-Clark and Loop subdivision: refinement, limit masks, evaluation.
//!
//! The boundary follows the cubic B-spline of its control points ("edge only" in OpenSubdiv's terms): a boundary
//! vertex moves to (1, 6, 1)/8 of itself and its boundary neighbours, a boundary edge is halved, and a corner of a
//! single face is rounded like any other boundary vertex, unless the mesh asks otherwise
//! ([`Mesh::subdivision`](crate::mesh::Mesh::subdivision)). Creases, corners and darts are those of OpenSubdiv
//! (DeRose, Kass, Truong 1998; Hoppe et al. 1994), semi-sharp or infinitely sharp.

pub(crate) mod basis;
mod curvature;
mod dart;
mod evaluate;
mod exceptions;
mod limit;
mod loop_box_spline;
mod loop_evaluate;
mod loop_limit;
mod loop_refine;
mod loop_ring;
mod mask;
mod mask_sharp;
mod mask_step;
mod normal;
pub(crate) mod patch;
pub(crate) mod patch_bicubic;
pub(crate) mod patch_corner;
pub(crate) mod patch_direct;
pub(crate) mod patch_ring;
mod positions;
mod refinement;
mod ring;
pub(crate) mod sharpness;
mod sharpness_fan;
#[cfg(test)]
mod tests;
mod topology;

pub use curvature::Curvature;
pub use evaluate::{SecondDerivatives, SurfacePoint, evaluate};
pub use limit::{LimitPoint, limit_normal, limit_point, limit_points, limit_position, limit_positions};
pub(crate) use limit::{each_limit_point, each_limit_position};
pub use loop_refine::{LoopSurface, NotTriangles};
pub(crate) use mask::eigenvalue;
pub use mask::{LimitMask, limit_mask, limit_tangent_masks};
pub use normal::{face_normal, vertex_normal};
pub use refinement::{ControlIds, RefineError, Refined, Refinement, VertexParent, refine};
pub use sharpness::has_limit;
pub use topology::Level;

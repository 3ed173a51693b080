//! `welt` adds procedural features to Catmull-Clark control meshes and gives back a sparse control mesh.
//!
//! Data flows one way:
//!
//! 1. [`io`] reads polygons and builds the half-edge [`mesh`];
//! 2. [`mark`] turns selectors into marks on the edges that a feature crosses;
//! 3. [`grammar`] rewrites the mesh by rules, whose actions are scripts of [`gml`];
//! 4. [`optimise`] fits the changed mesh to the limit [`surface`] that was frozen before, by means of [`subdivision`];
//! 5. [`feature`] runs these stages, displaces the surface and reports what was reached.
//!
//! [`picture`] and [`ffi`] (the C ABI) stand on top; nothing imports them.

#![deny(unsafe_code)]

mod fault;
pub mod feature;
#[allow(unsafe_code, reason = "pointers of callers in C")]
pub mod ffi;
pub mod gml;
pub mod grammar;
pub mod io;
pub mod job;
pub mod mark;
pub mod memory;
pub mod mesh;
pub mod optimise;
pub mod picture;
pub mod subdivision;
pub mod surface;
mod threads;

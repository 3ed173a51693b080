//! What users call: features on control meshes.

//! Fits the changed mesh to the frozen surface.

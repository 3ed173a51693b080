//! Catmull-Clark subdivision: refinement, limit masks, evaluation.

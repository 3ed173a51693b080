//! Figures: cage, limit surface, deviation map.

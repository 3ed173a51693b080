//! Selectors: which edges a feature crosses, and where.

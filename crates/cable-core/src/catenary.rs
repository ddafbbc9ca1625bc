//! Rung 0: the elastic catenary (placeholder).

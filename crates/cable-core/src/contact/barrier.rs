//! Log barrier (placeholder).

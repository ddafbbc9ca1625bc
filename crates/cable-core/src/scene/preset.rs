//! Presets of cables, robots and maps from assets/ (placeholder).

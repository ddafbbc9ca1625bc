//! History in memory and CSV (placeholder).
